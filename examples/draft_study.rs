//! How deep do bodies float? Boxes, upright and tilted, and balls of several densities and resolutions at rest in a
//! closed tank, against Archimedes: `cargo run --release --example draft_study -- dbc 2d-10 3d-10`. The words
//! are the walls (`settling` or `dbc`), the grids (2d-10, 2d-20, 2d-40, 3d-10, 3d-20, 3d-40: dimension and dp a height)
//! and, if not all are wanted, densities over the water's (`0.5`) and bodies (`on` and `off` the lattice, `tilted`,
//! `ball`); unsaid they are `settling 2d-10 2d-20`. `narrow` makes the tanks in 3-D 1.7 heights wide for 2.2, which
//! halves the water of `3d-40`. Prints a table in markdown.
//!
//! Each body starts at its draft of equilibrium, is left alone for a few heave periods, and the error of its
//! draft is averaged over the last of them. The water level is sounded by volume: (particles × dpᴰ + displaced
//! volume) ÷ area of the tank; beside it, by a gauge halfway between body and wall.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use std::f64::consts::TAU;

use pontoon::{
    error::{Error, Result},
    geometry::{Shape, WaterRegion},
    math::{Pose, Vector},
    model::{Model, Walls},
    probe::{ElevationProbe, Probe},
    simulation::{Dimension, Setup, Simulation},
    solid::{Dim, FreeBody, SolidSpec, hydrostatics::equilibrium_height},
};

const RHO0: f64 = 1000.0;
const G: f64 = 9.81;
/// Height of every body, m.
const HEIGHT: f64 = 0.2;
/// Widths of the tanks in 3-D, m. At 40 dp a height the narrow one leaves 14 dp between body and wall, 8 if tilted.
const WIDE: f64 = 2.2 * HEIGHT;
const NARROW: f64 = 1.7 * HEIGHT;
/// Density over the water's, –.
const RATIOS: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.9, 0.95];
/// Tilt of the boxes that are locked at an angle, rad.
const TILT: f64 = 20.0 * TAU / 360.0;
/// Errors of draft that must and should be kept, dp.
const MUST: f64 = 0.25;
const GOAL: f64 = 0.1;
/// The bodies, each by a word of its name.
const BODIES: [&str; 4] = ["on", "off", "tilted", "ball"];
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
    /// Angle at which it is locked, rad.
    tilt: f64,
    /// Particles per body height.
    n: f64,
    walls: Walls,
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
        // A cube would turn over at most of these densities: it may not. In 2-D everything upright may.
        let mut body = FreeBody::from_density(&self.shape, self.ratio * RHO0);
        body.locked_rotations = [D == 3 || self.tilt != 0.0; 3];
        body
    }

    /// Afloat at `level` (m).
    fn afloat(&self, mut position: Vector<D>, level: f64) -> Result<Pose<D>> {
        position += Vector::repeat(self.shift * self.dp());
        let mut pose = Pose::rotated(position, &[0.0, self.tilt][3 - D..]);
        pose.position[D - 1] += equilibrium_height(&self.shape, &pose, self.body().mass, RHO0, level)?;
        Ok(pose)
    }

    fn simulation(&self) -> Result<Simulation<D>> {
        let (dp, depth, body) = (self.dp(), self.pool[D - 1], self.body());
        let pose = self.afloat(self.pool * 0.5, depth)?;
        let mut size = self.pool;
        size[D - 1] += 0.5 * HEIGHT;
        let tank = Shape::Tank { size, thickness: 4.0 * dp };
        let region = WaterRegion { shape: Shape::Box { size: self.pool }, pose: Pose::at(self.pool * 0.5) };
        let setup = Setup::new(Model::water(D, dp, depth).walls(self.walls))
            .solid(SolidSpec::fixed("tank", tank).friction(0.0))
            .solid(SolidSpec::with_body("float", self.shape.clone(), body).at(pose).friction(0.0))
            .fill(&[region], depth)?;
        Simulation::new(setup)
    }

    /// The water level (m) that the tank's volume gives.
    fn level(&self, sim: &Simulation<D>) -> f64 {
        let area = self.pool.product() / self.pool[D - 1];
        let water = sim.system().fluid().len() as f64 * self.dp().powi(D as i32);
        let pose = &sim.system().solids()[1].kinematics.pose;
        // The body covers less than half of the tank: each round halves the error at least.
        (0..40).fold(water / area, |level, _| (water + self.shape.submerged_volume(pose, level).0) / area)
    }

    /// By how much (dp) the body lies too deep on the mean of the last period, by volume and by gauge.
    fn run(&self) -> Result<(f64, f64)> {
        let mut sim = self.simulation()?;
        let beside = 0.25 * (self.pool[0] - HEIGHT);
        let gauge = ElevationProbe::new(sim.system(), &[beside, 0.5 * self.pool[0]][..D - 1])?;
        let period = TAU * (HEIGHT / G).sqrt();
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
            mean.1 += too_deep(gauge.sample(&sim)[0])? / READINGS as f64;
        }
        Ok(mean)
    }

    fn row(&self) -> Result<()> {
        let (by_volume, by_gauge) = self.run()?;
        let draft = -self.shape.bounds_at(&self.afloat(Vector::zeros(), 0.0)?).min[D - 1] / self.dp();
        let percent = 100.0 * by_volume / draft;
        let kept = match by_volume.abs() {
            e if e <= GOAL => "goal",
            e if e <= MUST => "must",
            _ => "MISSED",
        };
        let Self { name, ratio, n, .. } = self;
        println!(
            "| {name} | {ratio:.3} | {n} | {draft:.2} | {by_volume:+.2} | {percent:+.1} | {by_gauge:+.2} | {kept} |"
        );
        Ok(())
    }
}

/// All bodies, so many particles high, of one density.
type Study = fn(f64, f64, &Asked) -> Result<()>;

/// What is asked for.
struct Asked {
    walls: Walls,
    /// Width of the tanks in 3-D, m.
    wide: f64,
    /// Densities over the water's, –.
    ratios: Vec<f64>,
    bodies: Vec<String>,
}

impl Asked {
    fn wants(&self, name: &str) -> bool {
        name.split(' ').any(|word| self.bodies.iter().any(|body| body == word))
    }
}

/// Bodies of one density in 2-D, `n` particles high. A box off the lattice lies 0.3 dp aside and draws 0.3 dp more.
fn flat(n: f64, ratio: f64, asked: &Asked) -> Result<()> {
    let block = Shape::Box { size: Vector::from([1.5, 1.0]) * HEIGHT };
    let case = |name, shape: &Shape<2>, ratio, (shift, tilt), pool: [f64; 2]| {
        if !asked.wants(name) {
            return Ok(());
        }
        let (walls, shape, pool) = (asked.walls, shape.clone(), Vector::from(pool) * HEIGHT);
        Case { name, shape, ratio, shift, tilt, n, walls, pool, periods: 3.0 }.row()
    };
    case("2-D box on the lattice", &block, ratio, (0.0, 0.0), [4.5, 1.5])?;
    case("2-D box off the lattice", &block, ratio + 0.3 / n, (0.3, 0.0), [4.5, 1.5])?;
    case("2-D box tilted by 20°", &block, ratio, (0.3, TILT), [4.5, 2.0])?;
    case("2-D ball", &Shape::Ball { radius: 0.5 * HEIGHT }, ratio, (0.0, 0.0), [3.0, 1.5])
}

/// Bodies of one density in 3-D, `n` particles high.
fn spatial(n: f64, ratio: f64, asked: &Asked) -> Result<()> {
    let cube = Shape::Box { size: Vector::repeat(HEIGHT) };
    let case = |name, shape: &Shape<3>, ratio, (shift, tilt), deep| {
        if !asked.wants(name) {
            return Ok(());
        }
        let (walls, shape, pool) = (asked.walls, shape.clone(), Vector::from([asked.wide, asked.wide, deep * HEIGHT]));
        Case { name, shape, ratio, shift, tilt, n, walls, pool, periods: 1.3 }.row()
    };
    case("3-D cube on the lattice", &cube, ratio, (0.0, 0.0), 1.3)?;
    case("3-D cube off the lattice", &cube, ratio + 0.3 / n, (0.3, 0.0), 1.3)?;
    case("3-D cube tilted by 20°", &cube, ratio, (0.3, TILT), 1.6)?;
    case("3-D ball", &Shape::Ball { radius: 0.5 * HEIGHT }, ratio, (0.0, 0.0), 1.3)
}

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (mut asked, mut grids) =
        (Asked { walls: Walls::RelaxedAdami, wide: WIDE, ratios: vec![], bodies: vec![] }, Vec::<(Study, f64)>::new());
    for word in &words {
        match (word.as_str(), word.parse()) {
            ("dbc", _) => asked.walls = Walls::Dynamic,
            ("settling", _) => asked.walls = Walls::RelaxedAdami,
            ("narrow", _) => asked.wide = NARROW,
            (_, Ok(ratio)) => asked.ratios.push(ratio),
            (body, _) if BODIES.contains(&body) => asked.bodies.push(body.into()),
            ("2d-10", _) => grids.push((flat, 10.0)),
            ("2d-20", _) => grids.push((flat, 20.0)),
            ("2d-40", _) => grids.push((flat, 40.0)),
            ("3d-10", _) => grids.push((spatial, 10.0)),
            ("3d-20", _) => grids.push((spatial, 20.0)),
            ("3d-40", _) => grids.push((spatial, 40.0)),
            (other, _) => {
                let help = "write dbc or settling, narrow, 2d-10, 2d-20, 2d-40, 3d-10, 3d-20, 3d-40, a density over the water's, on, off, tilted, ball";
                return Err(Error::scene(format!("nothing is called {other:?}")).help(help));
            }
        }
    }
    if grids.is_empty() {
        grids = vec![(flat, 10.0), (flat, 20.0)];
    }
    if asked.ratios.is_empty() {
        asked.ratios = RATIOS.into();
    }
    if asked.bodies.is_empty() {
        asked.bodies = BODIES.map(String::from).into();
    }
    println!("Walls: {:?}. A draft must be right to {MUST} dp and should be to {GOAL} dp.\n", asked.walls);
    println!("| body | ratio | dp a height | draft, dp | error, dp | error, % of the draft | by a gauge, dp | kept |");
    println!("|---|---|---|---|---|---|---|---|");
    for (study, n) in grids {
        for &ratio in &asked.ratios {
            study(n, ratio, &asked)?;
        }
    }
    Ok(())
}
