//! How deep do bodies float? Boxes and balls of several densities and resolutions at rest in a closed tank,
//! against Archimedes: `cargo run --release --example draft_study -- --quick`.
//!
//! Each body starts at its draft of equilibrium, is left alone for some heave periods, and its draft is
//! averaged over the last of them. The water level is that of the tank's volume: water (Σ m/ρ) and
//! displaced volume over the tank's area. Prints a table in markdown.

use std::f64::consts::TAU;

use pontoon::{
    error::Result,
    law::{diffusion::Fourtakas, viscosity::Artificial},
    model::{Diffusion, Kernel, Model, Scheme, Shifting, Viscosity, Walls},
    probe::{Elevation, Probe},
    shape::{Region, Shape, fill},
    simulation::{Setup, Simulation},
    solid::{Dim, FreeBody, HasEngine, Role, SolidSpec, hydrostatics::equilibrium_height},
    space::{Pose, Vector},
};

const RHO0: f64 = 1000.0;
const G: f64 = 9.81;
/// Height of every body, m.
const HEIGHT: f64 = 0.2;

/// A body afloat.
struct Case<const D: usize> {
    name: &'static str,
    shape: Shape<D>,
    /// Density over the water's, –.
    ratio: f64,
    /// Sideways shift off the lattice, dp.
    shift: f64,
    dp: f64,
    periods: f64,
}

/// What came out, dp: draft by Archimedes, and the error of the measured one by the level of the volume
/// and by that of a gauge.
struct Drafts {
    true_draft: f64,
    by_volume: f64,
    by_gauge: f64,
}

impl<const D: usize> Case<D>
where
    Dim<D>: HasEngine<D>,
{
    fn tank(&self) -> Vector<D> {
        let breadth = self.shape.bounds().size()[0];
        let wide = if D == 2 { 3.0 } else { 2.4 };
        let even = |x: f64| (x / self.dp).round() * self.dp;
        Vector::from_fn(|i, _| if i == D - 1 { 2.0 * HEIGHT } else { even(wide * breadth) })
    }

    fn simulation(&self) -> Result<Simulation<D>> {
        let (dp, size) = (self.dp, self.tank());
        let depth = 1.5 * HEIGHT;
        let body = FreeBody::from_density(&self.shape, self.ratio * RHO0);
        let mut pose = Pose::at(Vector::from_fn(|i, _| if i == D - 1 { 0.0 } else { 0.5 * size[i] + self.shift * dp }));
        pose.position[D - 1] = equilibrium_height(&self.shape, &pose, body.mass, RHO0, depth)?;
        let tank = Shape::Tank { size, thickness: 4.0 * dp };
        let mut pool = size;
        pool[D - 1] = depth;
        let region = Region { shape: Shape::Box { size: pool }, pose: Pose::at(pool * 0.5) };
        let water = fill(&[region], &[(&tank, &Pose::identity()), (&self.shape, &pose)], dp)?.r;
        let solid = |name: &str, shape, pose, role| SolidSpec {
            name: name.into(),
            shape,
            pose,
            role,
            friction: 0.0,
            restitution: 0.0,
        };
        let solids = vec![
            solid("tank", tank, Pose::identity(), Role::Fixed),
            solid("float", self.shape.clone(), pose, Role::Free(body)),
        ];
        let levels = vec![depth; water.len()];
        Simulation::new(Setup { model: model(D, dp, depth), water, levels, solids, domain: None })
    }

    /// The water level (m) that the tank's volume gives.
    fn level(&self, sim: &Simulation<D>) -> f64 {
        let (system, size) = (sim.system(), self.tank());
        let area: f64 = (0..D - 1).map(|i| size[i]).product();
        let water: f64 = system.fluid().rho.iter().map(|rho| system.particle_mass() / rho).sum();
        let pose = &system.solids()[1].kinematics.pose;
        // The body covers less than half of the tank: each round halves the error at least.
        (0..40).fold(water / area, |level, _| (water + self.shape.submerged(pose, level).0) / area)
    }

    /// Settles the body and measures its draft over the last period.
    fn run(&self) -> Result<Drafts> {
        let mut sim = self.simulation()?;
        let (pose, up) = (sim.system().solids()[1].spec.pose, D - 1);
        let lowest = |pose: &Pose<D>| self.shape.bounds_at(pose).min[up];
        let true_draft = 1.5 * HEIGHT - lowest(&pose);
        let period = TAU * (self.ratio * HEIGHT / G).sqrt();
        let gauge = Elevation::new(sim.system(), &[0.1 * self.tank()[0], 0.5 * self.tank()[0]][..up])?;
        let (mut volume, mut far, mut n) = (0.0, 0.0, 0.0);
        let (first, samples) = ((self.periods - 1.0) * period, 40);
        let mut acc = [0.0; 7];
        let tell = |sim: &Simulation<D>| -> [f64; 7] {
            let (system, size) = (sim.system(), self.tank());
            let area: f64 = (0..D - 1).map(|i| size[i]).product();
            let pose = &system.solids()[1].kinematics.pose;
            let count = system.fluid().len() as f64 * self.dp.powi(D as i32);
            let by_count = (0..40).fold(count / area, |l, _| (count + self.shape.submerged(pose, l).0) / area);
            let b = self.shape.bounds().size()[0];
            let x1 = 0.5 * (size[0] - b);
            let mut g = 0.0;
            for k in 1..10 {
                let x = x1 * (0.2 + 0.6 * k as f64 / 10.0);
                for xx in [x, size[0] - x] {
                    g += Elevation::new(system, &[xx, 0.5 * size[0]][..up]).unwrap().look(sim)[0] / 18.0;
                }
            }
            let e = |x: f64| (x - 1.5 * HEIGHT) / self.dp;
            let n = system.fluid().len() as f64;
            let ymean: f64 = system.fluid().r.iter().map(|r| r[up]).sum::<f64>() / n;
            let vr = (system.fluid().v.iter().map(|v| v.norm_squared()).sum::<f64>() / n).sqrt();
            let inner = pose;
            [
                (lowest(pose) - lowest(&system.solids()[1].spec.pose)) / self.dp,
                inner.turn()[0].to_degrees(),
                e(self.level(sim)),
                e(by_count),
                e(g),
                ymean / self.dp,
                vr,
            ]
        };
        let begin = tell(&sim);
        let profile = |sim: &Simulation<D>| {
            for k in 0..(self.tank()[0] / self.dp) as usize {
                let x = self.dp * (0.5 + k as f64);
                eprint!(
                    "{:.1}:{:+.2} ",
                    x / self.dp,
                    (Elevation::new(sim.system(), &[x, 0.5 * self.tank()[0]][..up]).unwrap().look(&sim)[0]
                        - 1.5 * HEIGHT)
                        / self.dp
                );
            }
            eprintln!();
        };

        if let Ok(f) = std::env::var("DUMP") {
            use std::io::Write;
            let mut w = std::fs::File::create(f).unwrap();
            for r in &sim.system().fluid().r {
                writeln!(w, "f {} {}", r[0] / self.dp, r[1] / self.dp).unwrap();
            }
            for r in &sim.system().skin().r {
                writeln!(w, "s {} {}", r[0] / self.dp, r[1] / self.dp).unwrap();
            }
        }
        for i in 1..=samples {
            let until = first + period * i as f64 / samples as f64;
            while sim.time() < until {
                sim.step_to(until)?;
            }
            acc.iter_mut().zip(tell(&sim)).for_each(|(a, b)| *a += b);
            let bottom = lowest(&sim.system().solids()[1].kinematics.pose);
            volume += self.level(&sim) - bottom;
            far += gauge.look(&sim)[0] - bottom;
            n += 1.0;
        }

        if let Ok(f) = std::env::var("DUMP") {
            use std::io::Write;
            let mut w = std::fs::File::create(f + "e").unwrap();
            for r in &sim.system().fluid().r {
                writeln!(w, "f {} {}", r[0] / self.dp, r[1] / self.dp).unwrap();
            }
            for r in &sim.system().skin().r {
                writeln!(w, "s {} {}", r[0] / self.dp, r[1] / self.dp).unwrap();
            }
        }
        eprintln!("start {begin:.3?}\nend   {:.3?}", acc.map(|x| x / n));
        let error = |sum: f64| (sum / n - true_draft) / self.dp;
        Ok(Drafts { true_draft: true_draft / self.dp, by_volume: error(volume), by_gauge: error(far) })
    }

    fn row(&self) -> Result<()> {
        let d = self.run()?;
        println!(
            "| {} | {D}-D | {:.2} | {:.0} | {:.2} | {:+.3} | {:+.2} | {:+.3} |",
            self.name,
            self.ratio,
            HEIGHT / self.dp,
            d.true_draft,
            d.by_volume,
            100.0 * d.by_volume / d.true_draft,
            d.by_gauge
        );
        Ok(())
    }
}

fn model(dimension: usize, dp: f64, depth: f64) -> Model {
    let mut gravity = vec![0.0; dimension];
    gravity[dimension - 1] = -G;
    Model {
        kernel: Kernel::Wendland,
        h: if dimension == 2 { 1.7 * dp } else { 3f64.sqrt() * dp },
        dp,
        rho0: RHO0,
        c0: std::env::var("C").ok().and_then(|c| c.parse().ok()).unwrap_or(10.0) * (G * depth).sqrt(),
        gamma: 7.0,
        gravity,
        viscosity: Viscosity::Artificial(Artificial::default()),
        diffusion: Diffusion::Fourtakas(Fourtakas::default()),
        shifting: Shifting::None,
        walls: Walls::Dbc,
        scheme: Scheme::Symplectic,
        cfl: 0.4,
        dt_max: f64::INFINITY,
    }
}

fn flat(ratio: f64, n: f64) -> Result<()> {
    let (dp, periods) = (HEIGHT / n, 3.0);
    let block = Shape::Box { size: Vector::from([1.5 * HEIGHT, HEIGHT]) };
    let only = std::env::var("ONLY").unwrap_or_default();
    if only.is_empty() || only == "on" {
        Case { name: "box on the lattice", shape: block.clone(), ratio, shift: 0.0, dp, periods }.row()?;
    }
    let sv: f64 = std::env::var("SV").ok().and_then(|c| c.parse().ok()).unwrap_or(0.3);
    let sh: f64 = std::env::var("SH").ok().and_then(|c| c.parse().ok()).unwrap_or(0.3);
    let lower = ratio + sv / n;
    if only.is_empty() || only == "off" {
        Case { name: "box off the lattice", shape: block, ratio: lower, shift: sh, dp, periods }.row()?;
    }
    let disc = Shape::<2>::Ball { radius: 0.5 * HEIGHT };
    if only.is_empty() || only == "ball" {
        Case { name: "ball", shape: disc, ratio, shift: 0.0, dp, periods }.row()?;
    }
    Ok(())
}

fn solid(ratio: f64) -> Result<()> {
    let (dp, periods) = (HEIGHT / 10.0, 2.0);
    let block = Shape::Box { size: Vector::from([HEIGHT; 3]) };
    Case { name: "box on the lattice", shape: block, ratio, shift: 0.0, dp, periods }.row()?;
    let ball = Shape::<3>::Ball { radius: 0.5 * HEIGHT };
    Case { name: "ball", shape: ball, ratio, shift: 0.0, dp, periods }.row()
}

fn main() -> Result<()> {
    let quick = std::env::args().any(|a| a == "--quick");
    println!("| body | | ratio | dp per height | draft, dp | error, dp | error, % | error by a gauge, dp |");
    println!("|---|---|---|---|---|---|---|---|");
    for n in if let Ok(n) = std::env::var("N") {
        vec![n.parse().unwrap()]
    } else if quick {
        vec![10.0]
    } else {
        vec![10.0, 20.0]
    } {
        for ratio in std::env::var("R").map(|r| vec![r.parse().unwrap()]).unwrap_or(vec![0.3, 0.5, 0.7, 0.9]) {
            flat(ratio, n)?;
        }
    }
    if std::env::args().any(|a| a == "--solid") {
        for ratio in [0.3, 0.5, 0.7, 0.9] {
            solid(ratio)?;
        }
    }
    Ok(())
}
