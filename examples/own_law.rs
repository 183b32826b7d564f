//! A pair term of your own: a drag between neighbouring water particles, proportional to their relative velocity, beside the
//! terms of the program. A standing wave in a tank must lose energy faster with it than without.
//!
//! The term is written once, generic over its number, and serves the f64 reference and the SIMD lanes.
//!
//! `cargo run --release --example own_law`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use std::f64::consts::PI;

use pontoon::{
    Result,
    geometry::Shape,
    math::Vector,
    model::Model,
    simulation::{Setup, Simulation},
    solid::SolidSpec,
    sph::{
        Num, Pair, Term, boundary::Repulsion, continuity::Continuity, density_diffusion::Fourtakas, kernel::Wendland,
        pressure::Pressure,
    },
};

/// Length and depth of the water, m.
const SIZE: [f64; 2] = [1.0, 0.4];

/// Particle spacing, m.
const DP: f64 = 0.02;

/// dv_a/dt = −κ Σ V_b v_ab |∂W| r_ab: a drag of strength κ (m/s), along v_ab and symmetric in a and b.
#[derive(Clone, Copy)]
struct RelativeDrag {
    /// κ in the units of the pair loop.
    strength: f64,
}

impl<const D: usize> Term<D> for RelativeDrag {
    const ALONG_V: bool = true;

    #[inline(always)]
    fn along_v<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        ab.constant(self.strength).fma(ab.r2.sqrt(), sum)
    }
}

/// Energy of motion (J/m) that the wave has left after 1.5 s, with a drag of `strength` (m/s).
fn energy_left(strength: f64) -> Result<f64> {
    let setup = setup()?;
    let pair_loop = setup.model.custom_pair_loop(|water, units| {
        let drag = RelativeDrag { strength: strength * units.time / units.length };
        let kernel = Wendland::new(water.h, 2);
        let diffusion = Fourtakas::default().term(water);
        let fluid = (((Pressure, Continuity), drag), diffusion);
        (fluid, ((Pressure, Continuity), Repulsion::new(kernel, water)))
    });
    let mut sim = Simulation::<2>::with_pair_loop(setup, pair_loop)?;
    let k = PI / SIZE[0];
    sim.set_water_velocity(|r| {
        let (up, along) = ((k * r[1]).sinh(), (k * r[1]).cosh());
        Vector::from([-(k * r[0]).sin() * along, (k * r[0]).cos() * up]) * (0.05 / (k * SIZE[1]).sinh())
    });
    sim.update_rates();
    let mut energy = 0.0;
    // The mean over a period is half the energy of the wave.
    while sim.time() < 2.5 {
        sim.step()?;
        if sim.time() > 1.5 {
            energy += sim.system().kinetic_energy() * sim.dt();
        }
    }
    Ok(energy)
}

/// Still water in a tank.
fn setup() -> Result<Setup<2>> {
    let tank = Shape::Tank { size: Vector::from([SIZE[0], 0.6]), thickness: 4.0 * DP };
    Setup::new(Model::water(2, DP, SIZE[1])).solid(SolidSpec::fixed("tank", tank)).fill_box([0.0, 0.0], SIZE)
}

fn main() -> Result<()> {
    let (without, with) = (energy_left(0.0)?, energy_left(0.05)?);
    println!("energy of motion, mean of 1.5–2.5 s, without drag   {without:.4} J/m");
    println!("the same with the drag                              {with:.4} J/m");
    assert!(with < 0.9 * without, "the drag takes a tenth of the energy at least");
    Ok(())
}
