//! Floating bodies: draft and stability, compared with Archimedes.
//!
//! The water level follows from the volume: (particles × dpᴰ + displaced volume) ÷ area of the tank. At the start
//! each particle fills dpᴰ and has the density of still water at its depth, which includes the compression.
//! A gauge agrees within 0.05 dp, but its reading contains waves and is local.

use std::f64::consts::TAU;

use pontoon::{
    geometry::{Shape, WaterRegion, fill},
    math::{Pose, Vector},
    model::{Model, Viscosity, Walls},
    simulation::{Dimension, Simulation},
    solid::{Dim, FreeBody, Role, hydrostatics},
    sph::viscosity::Artificial,
};

use crate::common;

const DP: f64 = 0.02;
const RHO0: f64 = 1000.0;

/// A floating body in a closed tank; lengths in dp.
struct Case<const D: usize> {
    shape: Shape<D>,
    /// Density over the water's, –.
    ratio: f64,
    /// Inner size of the tank and, last, depth of the water.
    pool: [f64; D],
    /// Offset from the middle of the tank and, last, from the height of equilibrium.
    shift: [f64; D],
    /// Axial angles at the start, rad.
    turn: [f64; 3],
    /// Artificial viscosity, –.
    alpha: f64,
    walls: Walls,
}

impl<const D: usize> Case<D> {
    fn new(shape: Shape<D>, ratio: f64, pool: [f64; D]) -> Self {
        Self { shape, ratio, pool, shift: [0.0; D], turn: [0.0; 3], alpha: 0.02, walls: Walls::Dynamic }
    }
}

fn block<const D: usize>(size: [f64; D]) -> Shape<D> {
    Shape::Box { size: Vector::from(size) * DP }
}

fn ball<const D: usize>(diameter: f64) -> Shape<D> {
    Shape::Ball { radius: 0.5 * diameter * DP }
}

/// The simulation of a floating body.
struct Afloat<const D: usize> {
    sim: Simulation<D>,
    shape: Shape<D>,
    body: FreeBody<D>,
    /// Area of the tank, m² (m in 2-D).
    area: f64,
}

impl<const D: usize> Afloat<D>
where
    Dim<D>: Dimension<D>,
{
    fn new(case: Case<D>) -> Self {
        let Case { shape, ratio, pool, shift, turn, alpha, walls } = case;
        let (up, pool) = (D - 1, Vector::from(pool) * DP);
        let mut float = common::float(shape.clone(), [0.0; D], ratio * RHO0);
        let Role::Free(body) = float.role else { panic!("a free body") };
        float.pose = Pose::rotated(pool * 0.5, &turn);
        float.pose.position[up] +=
            hydrostatics::equilibrium_height(&shape, &float.pose, body.mass, RHO0, pool[up]).unwrap();
        float.pose.position += Vector::from(shift) * DP;
        let mut size = pool;
        size[up] *= 1.5;
        let tank = common::tank(size.into(), DP);
        let region = WaterRegion { shape: Shape::Box { size: pool }, pose: Pose::at(pool * 0.5) };
        let water = fill(&[region], &[(&tank.shape, &tank.pose), (&shape, &float.pose)], DP).unwrap().r;
        let mut model = Model::water(D, DP, pool[up]);
        model.walls = walls;
        model.viscosity = Viscosity::Artificial(Artificial { alpha });
        let sim = common::simulation(model, water, pool[up], vec![tank, float]);
        Self { sim, shape, body, area: pool.product() / pool[up] }
    }

    fn pose(&self) -> &Pose<D> {
        &self.sim.system().solids()[1].kinematics.pose
    }

    /// Height of the water's surface, m.
    fn level(&self) -> f64 {
        let water = self.sim.system().fluid().len() as f64 * DP.powi(D as i32);
        // No body covers more than half of the tank, so each iteration at least halves the error.
        (0..40)
            .fold(water / self.area, |level, _| (water + self.shape.submerged_volume(self.pose(), level).0) / self.area)
    }

    /// Excess draft of the body, dp: its distance below the height of equilibrium at its present tilt.
    fn excess_draft(&self) -> f64 {
        hydrostatics::equilibrium_height(&self.shape, self.pose(), self.body.mass, RHO0, self.level()).unwrap() / DP
    }

    /// Tilt, degrees; 2-D.
    fn tilt(&self) -> f64 {
        self.pose().rotation_vector()[0].to_degrees()
    }

    /// A hundred values of `sample` over the next `seconds`.
    fn record(&mut self, seconds: f64, sample: impl Fn(&Self) -> f64) -> Vec<f64> {
        let start = self.sim.time();
        let reading = |i: usize| {
            let until = start + seconds * i as f64 / 100.0;
            while self.sim.time() < until {
                self.sim.step_to(until).expect("a body at rest");
            }
            sample(self)
        };
        (1..=100).map(reading).collect()
    }

    /// Mean error of the draft (dp) over the last of `periods` of 2π √(draft/g), which is about the heave period.
    fn draft_error(&mut self, periods: f64) -> f64 {
        let volume = self.body.mass / RHO0;
        let draft = volume / (self.shape.volume_properties().volume / self.shape.bounds().size()[D - 1]);
        let period = TAU * (draft / 9.81).sqrt();
        self.record((periods - 1.0) * period, |_| 0.0);
        mean(&self.record(period, Self::excess_draft))
    }
}

fn mean(readings: &[f64]) -> f64 {
    readings.iter().sum::<f64>() / readings.len() as f64
}

#[test]
fn a_box_on_the_lattice_floats_at_the_draft_of_archimedes() {
    for ratio in [0.2, 0.5, 0.9] {
        let error = Afloat::new(Case::new(block([16.0, 10.0]), ratio, [48.0, 16.0])).draft_error(2.0);
        // The bound of the project for a box on the lattice.
        assert!(error.abs() < 0.1, "ratio {ratio}: {error} dp");
    }
}

#[test]
fn a_box_off_the_lattice_floats_at_the_draft_of_archimedes() {
    // Drafts of 4.3, 5.5 and 8.7 dp; the sides are 0.3 or 0.5 dp off the lattice.
    for (ratio, aside) in [(0.43, 0.3), (0.55, 0.5), (0.87, 0.3)] {
        let mut case = Case::new(block([16.0, 10.0]), ratio, [48.0, 16.0]);
        case.shift[0] = aside;
        let error = Afloat::new(case).draft_error(2.0);
        // Half of the bound of the project for any shape and position. An error of half a row of water under the box
        // would be 0.4 dp.
        assert!(error.abs() < 0.25, "ratio {ratio}: {error} dp");
    }
}

#[test]
fn a_disc_floats_at_the_draft_of_archimedes() {
    for (ratio, shift) in [(0.3, [0.0, 0.0]), (0.7, [0.3, 0.3])] {
        let mut case = Case::new(ball(10.0), ratio, [30.0, 15.0]);
        case.shift = shift;
        let error = Afloat::new(case).draft_error(2.0);
        assert!(error.abs() < 0.25, "ratio {ratio}: {error} dp; as for a box off the lattice");
    }
}

#[test]
fn a_box_and_a_ball_in_three_dimensions_float_at_the_draft_of_archimedes() {
    let error = Afloat::new(Case::new(block([10.0, 10.0, 6.0]), 0.5, [22.0, 22.0, 9.0])).draft_error(1.5);
    assert!(error.abs() < 0.1, "box: {error} dp; the bound on the lattice");
    let error = Afloat::new(Case::new(ball::<3>(8.0), 0.8, [18.0, 18.0, 10.0])).draft_error(1.5);
    assert!(error.abs() < 0.25, "ball: {error} dp; half of the bound for any shape");
}

#[test]
fn a_box_released_above_its_draft_returns_to_it() {
    let mut case = Case::new(block([16.0, 10.0]), 0.5, [48.0, 16.0]);
    case.shift[1] = 2.0;
    case.alpha = 0.1; // damps the waves of the tank within the run
    let mut bobber = Afloat::new(case);
    assert!(bobber.excess_draft() < -1.8, "the box starts above its draft");
    let bobbing = bobber.record(2.0, Afloat::excess_draft);
    let deepest = bobbing.iter().copied().fold(0.0, f64::max);
    assert!(deepest > 0.3, "the box overshoots its draft by {deepest} dp");
    let late = bobber.record(2.0, Afloat::excess_draft);
    let left = late.iter().map(|x| (x - mean(&late)).abs()).fold(0.0, f64::max);
    assert!(left < 0.5 * deepest, "the motion decays; {left} dp remain");
    // The bound of the project for any shape and position. About −0.3 dp remains: the gap at dynamic boundary particles
    // after water and body have moved. Without motion it is −0.02.
    assert!(mean(&late).abs() < 0.5, "{} dp", mean(&late));
}

#[test]
fn relaxed_adami_walls_leave_no_gap_at_a_box_that_has_moved() {
    for above in [2.0, -2.0] {
        let mut case = Case::new(block([16.0, 10.0]), 0.5, [48.0, 16.0]);
        (case.shift[1], case.alpha, case.walls) = (above, 0.1, Walls::RelaxedAdami);
        let mut bobber = Afloat::new(case);
        bobber.record(6.0, |_| 0.0);
        let late = mean(&bobber.record(1.0, Afloat::excess_draft));
        // Half of the bound of a box that has not moved; with dynamic boundary particles −0.2 to −0.3 dp remain. The particles under
        // the box need six seconds to rearrange: after three the box floats up to 0.1 dp too high.
        assert!(late.abs() < 0.05, "released {above} dp above its draft: {late} dp");
    }
}

#[test]
fn a_tilted_box_rights_itself_if_its_metacentre_is_above_its_centre_of_mass() {
    let mut case = Case::new(block([20.0, 10.0]), 0.5, [60.0, 16.0]);
    case.turn[0] = 9f64.to_radians();
    let mut broad = Afloat::new(case);
    assert!(metacentre(&broad) > 0.1 * 10.0 * DP, "GM {}", metacentre(&broad));
    let swing = broad.record(2.0, Afloat::tilt);
    let other = swing.iter().copied().fold(0.0, f64::min);
    let late = broad.record(2.0, Afloat::tilt);
    let left = late.iter().map(|x| x.abs()).fold(0.0, f64::max);
    assert!(other < -0.5, "the box swings past upright, to {other}°");
    assert!(left < 4.5, "the tilt decays below half of its start: {left}°");
    assert!(mean(&late).abs() < 1.0, "mean tilt: {}°", mean(&late));
    let error = mean(&broad.record(0.6, Afloat::excess_draft));
    assert!(error.abs() < 0.25, "{error} dp; the bound of a box off the lattice");
}

#[test]
fn a_tilted_box_turns_over_if_its_metacentre_is_below_its_centre_of_mass() {
    let mut case = Case::new(block([8.0, 14.0]), 0.5, [32.0, 20.0]);
    case.turn[0] = 3f64.to_radians();
    let mut tall = Afloat::new(case);
    assert!(metacentre(&tall) < -0.1 * 14.0 * DP, "GM {}", metacentre(&tall));
    let tilt = tall.record(1.2, Afloat::tilt);
    assert!(tilt[99] > 20.0, "the tilt grows: {}°", tilt[99]);
}

/// Metacentric height (m) of the upright body; 2-D.
fn metacentre(afloat: &Afloat<2>) -> f64 {
    let upright = Pose::at(afloat.pose().position);
    hydrostatics::metacentric_height(&afloat.shape, &upright, &afloat.body, RHO0, 0.0, &[1.0]).unwrap()
}
