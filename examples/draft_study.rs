//! How deep do bodies float? Boxes and balls of several densities and resolutions at rest in a closed tank,
//! against Archimedes: `cargo run --release --example draft_study -- --quick` (six minutes of one core; without
//! `--quick` fourteen). Prints a table in markdown.
//!
//! Each body starts at its draft of equilibrium, is left alone for a few heave periods, and the error of its
//! draft is averaged over the last of them. The water level is sounded by volume: (particles × dpᴰ + displaced
//! volume) ÷ area of the tank; beside it, by a gauge halfway between body and wall.

use std::f64::consts::TAU;

use pontoon::{
    error::Result,
    model::{Dimension, Model},
    probe::{Elevation, Probe},
    shape::{Region, Shape, fill},
    simulation::{Setup, Simulation},
    solid::{Dim, FreeBody, Role, SolidSpec, hydrostatics::equilibrium_height},
    space::{Pose, Vector},
};

const RHO0: f64 = 1000.0;
const G: f64 = 9.81;
/// Height of every body, m.
const HEIGHT: f64 = 0.2;
/// Readings in the last period.
const READINGS: usize = 50;

/// A body afloat in the middle of a tank.
struct Case<const D: usize> {
    name: &'static str,
    shape: Shape<D>,
    /// Density over the water's, –.
    ratio: f64,
    /// Sideways shift off the lattice, dp.
    shift: f64,
    /// Particles per body height.
    n: f64,
    /// Inner size of the tank and, last, depth of the water, m.
    pool: Vector<D>,
    /// Heave periods to run.
    periods: f64,
}

impl<const D: usize> Case<D>
where
    Dim<D>: Dimension<D>,
{
    fn dp(&self) -> f64 {
        HEIGHT / self.n
    }

    fn body(&self) -> FreeBody<D> {
        // A cube would turn over at most of these densities: it may not. In 2-D everything may.
        let locked_rotations = [D == 3; 3];
        FreeBody { locked_rotations, ..FreeBody::from_density(&self.shape, self.ratio * RHO0) }
    }

    fn simulation(&self) -> Result<Simulation<D>> {
        let (dp, depth, body) = (self.dp(), self.pool[D - 1], self.body());
        let mut pose = Pose::at(self.pool * 0.5 + Vector::repeat(self.shift * dp));
        pose.position[D - 1] += equilibrium_height(&self.shape, &pose, body.mass, RHO0, depth)?;
        let mut size = self.pool;
        size[D - 1] += 0.5 * HEIGHT;
        let tank = Shape::Tank { size, thickness: 4.0 * dp };
        let region = Region { shape: Shape::Box { size: self.pool }, pose: Pose::at(self.pool * 0.5) };
        let water = fill(&[region], &[(&tank, &Pose::identity()), (&self.shape, &pose)], dp)?.r;
        let solid = |name: &str, shape, pose, role| {
            let name = name.into();
            SolidSpec { name, shape, pose, role, friction: 0.0, restitution: 0.0 }
        };
        let tank = solid("tank", tank, Pose::identity(), Role::Fixed);
        let float = solid("float", self.shape.clone(), pose, Role::Free(body));
        let levels = vec![depth; water.len()];
        let model = model(D, dp, depth);
        Simulation::new(Setup { model, water, levels, solids: vec![tank, float], domain: None })
    }

    /// The water level (m) that the tank's volume gives.
    fn level(&self, sim: &Simulation<D>) -> f64 {
        let area = self.pool.product() / self.pool[D - 1];
        let water = sim.system().fluid().len() as f64 * self.dp().powi(D as i32);
        let pose = &sim.system().solids()[1].kinematics.pose;
        // The body covers less than half of the tank: each round halves the error at least.
        (0..40).fold(water / area, |level, _| (water + self.shape.submerged(pose, level).0) / area)
    }

    /// By how much (dp) the body lies too deep on the mean of the last period, by volume and by gauge.
    fn run(&self) -> Result<(f64, f64)> {
        let mut sim = self.simulation()?;
        let beside = 0.25 * (self.pool[0] - HEIGHT);
        let gauge = Elevation::new(sim.system(), &[beside, 0.5 * self.pool[0]][..D - 1])?;
        let period = TAU * (self.ratio * HEIGHT / G).sqrt();
        let mut mean = (0.0, 0.0);
        for i in 1..=READINGS {
            let until = period * (self.periods - 1.0 + i as f64 / READINGS as f64);
            while sim.time() < until {
                sim.step_to(until)?;
            }
            let pose = sim.system().solids()[1].kinematics.pose;
            // The lift that would float it as it is turned.
            let too_deep = |level| -> Result<f64> {
                Ok(equilibrium_height(&self.shape, &pose, self.body().mass, RHO0, level)? / self.dp())
            };
            mean.0 += too_deep(self.level(&sim))? / READINGS as f64;
            mean.1 += too_deep(gauge.look(&sim)[0])? / READINGS as f64;
        }
        Ok(mean)
    }

    fn row(&self) -> Result<()> {
        let (by_volume, by_gauge) = self.run()?;
        let pose = Pose::identity();
        let draft = equilibrium_height(&self.shape, &pose, self.body().mass, RHO0, 0.0)?;
        let draft = (0.5 * HEIGHT - draft) / self.dp();
        let percent = 100.0 * by_volume / draft;
        let Self { name, ratio, n, .. } = self;
        println!("| {name} | {ratio:.3} | {n} | {draft:.2} | {by_volume:+.2} | {percent:+.1} | {by_gauge:+.2} |");
        Ok(())
    }
}

/// Half the usual speed of sound: nothing here moves fast.
fn model(dimension: usize, dp: f64, depth: f64) -> Model {
    let usual = Model::water(dimension, dp, depth);
    Model { c0: 0.5 * usual.c0, ..usual }
}

/// Bodies in 2-D, `n` particles high. A box off the lattice lies 0.3 dp aside and draws 0.3 dp more.
fn flat(n: f64, ratio: f64) -> Result<()> {
    let block = Shape::Box { size: Vector::from([1.5 * HEIGHT, HEIGHT]) };
    let case = |name, shape, ratio, shift, wide: f64| Case {
        name,
        shape,
        ratio,
        shift,
        n,
        pool: Vector::from([wide, 1.5]) * HEIGHT,
        periods: 3.0,
    };
    case("2-D box on the lattice", block.clone(), ratio, 0.0, 4.5).row()?;
    case("2-D box off the lattice", block, ratio + 0.3 / n, 0.3, 4.5).row()?;
    case("2-D ball", Shape::Ball { radius: 0.5 * HEIGHT }, ratio, 0.0, 3.0).row()
}

/// Bodies in 3-D, `n` particles high.
fn spatial(n: f64, ratio: f64) -> Result<()> {
    let case = |name, shape| Case {
        name,
        shape,
        ratio,
        shift: 0.0,
        n,
        pool: Vector::from([2.2, 2.2, 1.3]) * HEIGHT,
        periods: 1.3,
    };
    case("3-D cube on the lattice", Shape::Box { size: Vector::repeat(HEIGHT) }).row()?;
    case("3-D ball", Shape::Ball { radius: 0.5 * HEIGHT }).row()
}

fn main() -> Result<()> {
    let quick = std::env::args().any(|a| a == "--quick");
    println!("| body | ratio | dp a height | draft, dp | error, dp | error, % of the draft | by a gauge, dp |");
    println!("|---|---|---|---|---|---|---|");
    for n in if quick { vec![10.0] } else { vec![10.0, 20.0] } {
        for ratio in [0.3, 0.5, 0.7, 0.9] {
            flat(n, ratio)?;
        }
    }
    for ratio in [0.3, 0.5, 0.7, 0.9] {
        spatial(10.0, ratio)?;
    }
    if quick { Ok(()) } else { flat(40.0, 0.5) }
}
