//! Probes: they look at a simulation and never touch it.
//!
//! A [`Probe`] names its columns, units included, and gives a number for each whenever it is asked. Sums
//! over the water are interpolations with the kernel W and the volumes V_b = m/ρ_b.

mod balance;
mod budget;
mod elevation;
mod energy;
mod flow;
mod force;
mod front;
mod joint;
mod line;
mod motion;
mod patch;
mod contact_force;
mod pressure;
mod probe_row;
mod runup;
mod velocity;

pub use balance::LoadBalanceProbe;
pub use budget::{EnergyBudgetProbe, relative_residual};
pub use contact_force::{ContactForceProbe, ContactList};
pub use elevation::ElevationProbe;
pub use energy::EnergyProbe;
pub use flow::FlowProbe;
pub use force::ForceProbe;
pub use front::FrontProbe;
pub use joint::JointProbe;
pub use line::LineProbe;
pub use motion::MotionProbe;
pub use patch::PatchProbe;
pub use pressure::PressureProbe;
pub use probe_row::{ProbeRow, column_at_place};
pub use runup::RunupProbe;
pub use velocity::VelocityProbe;

use crate::{
    error::{Error, ErrorKind, Result},
    math::Vector,
    simulation::{Simulation, find_by_name},
    system::System,
};

/// Something that watches a simulation.
pub trait Probe<const D: usize>: Send {
    /// A name for each number, ending in its unit, as in `fx_N`.
    fn columns(&self) -> Vec<String>;

    /// A number for each column, now. NaN where there is nothing to measure, as in a dry place.
    fn sample(&self, sim: &Simulation<D>) -> Vec<f64>;

    /// Makes the reading `now` continue the reading `before` it, for quantities that wind round, such as
    /// an angle past 180°, or add up, such as a volume; `dt` (s) lies between them. By default leaves it as it is.
    fn continue_from(&self, before: &[f64], now: &mut [f64], dt: f64) {
        let _ = (before, now, dt);
    }

    /// How many of the last columns are sums since the start, of which no mean over time is taken.
    fn cumulative_columns(&self) -> usize {
        0
    }
}

/// Names of the axes: the last is up.
const fn axes<const D: usize>() -> &'static [&'static str] {
    match D {
        2 => &["x", "y"],
        _ => &["x", "y", "z"],
    }
}

/// The number of the solid called `name`.
///
/// # Errors
/// `Scene` if there is none: says the nearest name, or all of them.
pub fn find_solid<const D: usize>(system: &System<D>, name: &str) -> Result<usize> {
    find_by_name("solid", name, system.solids().iter().map(|s| s.spec.name.as_str()))
}

/// A point of `D` components from as many numbers.
///
/// # Errors
/// `Usage` if their count is another or one of them is not finite.
fn point<const D: usize>(at: &[f64], count: usize) -> Result<Vector<D>> {
    if at.len() != count || at.iter().any(|x| !x.is_finite()) {
        let what = format!("a probe's place needs {count} finite coordinates (m); got {at:?}");
        return Err(Error::new(ErrorKind::Usage, what));
    }
    let mut x = Vector::<D>::zeros();
    for (xi, &a) in x.iter_mut().zip(at) {
        *xi = a;
    }
    Ok(x)
}

/// Mean of a quantity of the water at the point `x` (m), weighed by V_b W and normalised (Shepard):
/// exact for a constant, second order inside the water. `None` where the water fills less than a quarter of
/// the kernel's weight, as in air.
fn interpolate<const D: usize, const C: usize>(
    system: &System<D>,
    x: &Vector<D>,
    quantity: impl Fn(usize, &Vector<D>) -> [f64; C],
) -> Option<[f64; C]> {
    let (mass, rho) = (system.particle_mass(), system.fluid().rho);
    let (mut sum, mut weight) = ([0.0; C], 0.0);
    system.visit_fluid_near(x, &mut |b, r, w| {
        let share = mass / rho[b] * w;
        weight += share;
        for (s, q) in sum.iter_mut().zip(quantity(b, r)) {
            *s += share * q;
        }
    });
    (weight >= 0.25).then(|| sum.map(|s| s / weight))
}
