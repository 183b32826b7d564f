//! Bodies lighter than the water that goes with them: foam, shells, plates.

use pontoon::{
    geometry::Shape,
    math::{Pose, Vector},
    model::{Model, PairLoopKind, Slip, Walls},
    simulation::Simulation,
    solid::{FreeBody, Role},
};

use crate::common;

const G: f64 = 9.81;

/// A body of `shape`, `ratio` as dense as water, in the middle of still water 0.8 m × 0.6 m, dp 10 mm.
fn submerged(shape: Shape<2>, ratio: f64) -> Simulation<2> {
    let dp = 0.01;
    let model = Model::water(2, dp, 0.6);
    let mut water = common::lattice([0.0, 0.0], [0.8, 0.6], dp);
    let middle = Vector::from([0.4, 0.3]);
    water.retain(|r| shape.signed_distance(&(r - middle)) > 0.0);
    let body = common::float(shape, [0.4, 0.3], 1000.0 * ratio);
    common::simulation(model, water, 0.6, vec![common::tank([0.8, 0.8], dp), body])
}

/// Rise (m) of the body in `time` (s).
fn rise(mut sim: Simulation<2>, time: f64) -> f64 {
    while sim.time() < time {
        sim.step_to(time).unwrap();
    }
    sim.system().solids()[1].kinematics.centre[1] - 0.3
}

#[test]
fn a_body_lighter_than_water_starts_upwards_with_its_added_mass() {
    // A box B = 16 dp broad drags κ ¼π B² of water, κ = 1.16 if it is an eighth as thick and 1.41 if 0.6 as thick, between
    // the 1 of a plate and the 1.51 of a square (Brennen 1982): a = (1 − ratio) g A/(κ ¼π B² + ratio A). In 80 ms it goes a
    // tenth of its depth at most. The surface above, the bed below and a face at half a dp: 15 %. An explicit exchange, at
    // half the step that just does not blow up, is four times too fast for the box and twenty for the plate at ratio 0.01.
    let time = 0.08;
    for (size, of_plate) in [([0.16, 0.02], 1.16), ([0.16, 0.1], 1.41)] {
        for ratio in [0.01, 0.05, 0.2] {
            let area = size[0] * size[1];
            let added = of_plate * 0.25 * std::f64::consts::PI * size[0] * size[0];
            let exact = 0.5 * (1.0 - ratio) * G * area / (added + ratio * area) * time * time;
            let found = rise(submerged(Shape::Box { size: Vector::from(size) }, ratio), time);
            assert!((found / exact - 1.0).abs() < 0.15, "{size:?}, ratio {ratio}: {found} m, exact {exact} m");
        }
    }
}

#[test]
fn a_body_heavier_than_a_kernel_of_water_is_left_as_it_is() {
    // A box ten dp high has (ω_b h/c₀)² = 0.52 over its density ratio, wet all around: from 0.41 on nothing is ever withheld, to
    // the last bit; at half of that something is.
    let most = |ratio: f64| {
        let mut sim = submerged(Shape::Box { size: Vector::from([0.1, 0.1]) }, ratio);
        let mut most = 0.0_f64;
        for _ in 0..20 {
            sim.step().unwrap();
            most = most.max(sim.pending_impulse(1).norm());
        }
        most
    };
    assert_eq!(most(0.6), 0.0);
    assert!(most(0.25) > 0.0);
}

#[test]
fn a_sheet_of_foam_comes_to_rest_on_the_water() {
    // Let fall 1 dp on water it is at rest after a second: 5 mm/s, a third of a per cent of √(g depth). It should not hop at
    // all, and hops by a dp (docs/explanation/stability.md): 2 dp. A tenth of a dp of draft cannot be seen by particles: within 1.5 dp of it.
    let (dp, thick) = (0.01, 0.02);
    let water = common::lattice([0.0, 0.0], [0.8, 0.3], dp);
    let float = common::float(Shape::Box { size: Vector::from([0.16, thick]) }, [0.4, 0.3 + dp + 0.5 * thick], 10.0);
    let mut sim = common::simulation(Model::water(2, dp, 0.3), water, 0.3, vec![common::tank([0.8, 0.5], dp), float]);
    let (mut highest, mut fastest) = (0.0_f64, 0.0_f64);
    while sim.time() < 1.5 {
        sim.step().unwrap();
        let now = sim.system().solids()[1].kinematics;
        highest = highest.max(now.centre[1]);
        if sim.time() > 1.0 {
            fastest = fastest.max(now.velocity.norm());
        }
    }
    let rests = sim.system().solids()[1].kinematics.centre[1] - 0.5 * thick - 0.3;
    assert!(highest < 0.3 + 3.0 * dp + 0.5 * thick, "it hopped to {highest} m");
    assert!(fastest < 5e-3, "{fastest} m/s");
    assert!(rests.abs() < 1.5 * dp, "its lower face rests {rests} m above the water");
}

#[test]
fn what_the_water_loses_a_light_body_has_or_will_have() {
    for (sweep, rounding) in [(PairLoopKind::Reference, 1e-12), (PairLoopKind::Fast, 1e-8)] {
        let dp = 0.02;
        let mut model = Model::water(2, dp, 0.3);
        (model.gravity, model.pair_loop, model.c0, model.walls) = (vec![0.0, 0.0], sweep, 34.0, Walls::Dynamic);
        let mut water = common::lattice([-0.2, -0.2], [0.4, 0.4], dp);
        water.retain(|r| r[0].abs() > 0.06 || r[1].abs() > 0.04);
        let shape = Shape::Box { size: Vector::from([0.12, 0.08]) };
        let mut sim = common::simulation(model, water, -1.0, vec![common::float(shape, [0.0, 0.0], 20.0)]);
        sim.set_water_velocity(|r| Vector::from([0.5 - 2.0 * r[0] + r[1], 0.3 + 2.0 * r[1] - r[0]]));
        let whole = |sim: &Simulation<2>| {
            let solid = &sim.system().solids()[0];
            let Role::Free(body) = &solid.spec.role else { panic!("a free body") };
            common::water_momentum(sim) + solid.kinematics.velocity * body.mass + sim.pending_impulse(0)
        };
        let (start, scale) = (whole(&sim), 1000.0 * 0.15 * 0.5);
        let mut most = 0.0_f64;
        for _ in 0..500 {
            sim.step().unwrap();
            most = most.max(sim.pending_impulse(0).norm());
        }
        // Rounding, as for heavy bodies; and what is withheld is not nothing.
        assert!((whole(&sim) - start).norm() < rounding * scale, "{:e}", (whole(&sim) - start).norm() / scale);
        assert!(most > 1e-6 * scale, "this body is not light: {most} N s");
    }
}

#[test]
fn a_light_body_held_down_weighs_what_archimedes_says() {
    // A lid holds a foam box under water: what presses on the lid is the buoyancy less the weight, 2 %, though neither is
    // known to the exchange. Friction is none and the water at rest.
    let (dp, ratio) = (0.01, 0.02);
    let model = Model::water(2, dp, 0.3);
    let mut water = common::lattice([0.0, 0.0], [0.6, 0.3], dp);
    let shape = Shape::Box { size: Vector::from([0.16, 0.1]) };
    let lid = Shape::Box { size: Vector::from([0.04, 0.2]) };
    water.retain(|r| shape.signed_distance(&(r - Vector::from([0.3, 0.15]))) > 0.0);
    water.retain(|r| lid.signed_distance(&(r - Vector::from([0.3, 0.3]))) > 0.0);
    let solids = vec![
        common::tank([0.6, 0.5], dp),
        common::float(shape, [0.3, 0.15], 1000.0 * ratio),
        common::solid("lid", lid, Pose::at(Vector::from([0.3, 0.3])), Role::Fixed),
    ];
    let mut sim = common::simulation(model, water, 0.3, solids);
    let (mut sum, mut count) = (0.0, 0);
    while sim.time() < 1.5 {
        sim.step().unwrap();
        if sim.time() > 0.5 {
            sum += sim.contacts().iter().map(|contact| contact.normal_force).sum::<f64>();
            count += 1;
        }
    }
    // Beneath the lid no water presses from above: as much more as the lid is broad and the box's top deep, 0.1 m.
    let exact = 1000.0 * G * ((1.0 - ratio) * 0.16 * 0.1 + 0.04 * 0.1);
    let found = sum / f64::from(count);
    assert!((found / exact - 1.0).abs() < 0.02, "{found} N/m for {exact} N/m");
}

/// Length of the column, m, and speed of sound in it, m/s.
const COLUMN: (f64, f64) = (0.4, 20.0);

/// A column of water 0.8 m broad between two walls, without gravity, its lower end free; on the upper one lies a piston 4 dp thick and
/// `ratio` as dense as water.
fn column(ratio: f64) -> Simulation<2> {
    let (dp, broad, (long, c0)) = (0.01, 0.8, COLUMN);
    let mut model = Model::water(2, dp, long);
    (model.c0, model.gravity, model.slip) = (c0, vec![0.0, 0.0], Slip::Free);
    let wall = |name: &str, x: f64| {
        let shape = Shape::Box { size: Vector::from([5.0 * dp, 2.0 * long]) };
        common::solid(name, shape, Pose::at(Vector::from([x, 0.5 * long])), Role::Fixed)
    };
    let shape = Shape::Box { size: Vector::from([broad - 0.5 * dp, 4.0 * dp]) };
    let mut body = FreeBody::from_density(&shape, 1000.0 * ratio);
    (body.locked_translations[0], body.locked_rotations[0]) = (true, true);
    let piston =
        common::solid("piston", shape, Pose::at(Vector::from([0.5 * broad, long + 2.0 * dp])), Role::Free(body));
    let solids = vec![wall("left", -2.5 * dp), wall("right", broad + 2.5 * dp), piston];
    common::simulation(model, common::lattice([0.0, 0.0], [broad, long], dp), long, solids)
}

/// Velocity and way of a piston of `mass` (kg/m²) that `pressure` (Pa) drives into the column, in units of P/ρ₀c₀ and of that times L/c₀,
/// `n` of them in each L/c₀ up to `last` of them: m v' = P − ρ₀c₀ (v − 2 e), e what comes back from the free end, v − e a while 2L/c₀ ago.
fn exact(mass: f64, n: usize, last: usize) -> Vec<[f64; 2]> {
    let (m, dt) = (mass / (1000.0 * COLUMN.0), 1.0 / n as f64);
    let (mut out, mut all) = (vec![0.0], vec![[0.0, 0.0]]);
    for i in 1..=n * last {
        let echo = if i > 2 * n { out[i - 2 * n] } else { 0.0 };
        let [v, x] = all[i - 1];
        let v = (m * v + dt * (1.0 + 2.0 * echo)) / (m + dt);
        out.push(v - echo);
        all.push([v, x + dt * v]);
    }
    all
}

#[test]
fn a_piston_of_any_weight_drives_a_column_of_water_as_sound_and_then_as_its_mass_says() {
    // Sound: m v' = P − ρ₀c₀ v until its echo is back, then in steps, one every 2L/c₀, whose mean is (m + ρ₀L) v' = P. The heavier
    // two need no help; the lighter two are a hundredth and a tenth of 0.3 h of water. Within 7 % of P/ρ₀c₀ in the mean from one
    // L/c₀ to the echo (beside a side wall water is as soft as if it were half a dp further away: 3 % of this breadth, and
    // 12 % of a quarter of it); no ringing: a root mean square of a tenth about that; and the way after ten L/c₀ within 5 %.
    let (pressure, n, (long, c0)) = (2000.0, 1000, COLUMN);
    let unit = pressure / (1000.0 * c0);
    for ratio in [0.01, 0.1, 1.0, 5.0] {
        let exact = exact(1000.0 * ratio * 0.04, n, 10);
        let mut sim = column(ratio);
        let (mut sum, mut squares, mut count, mut way) = (0.0, 0.0, 0.0, 0.0);
        while sim.time() * c0 / long < 10.0 {
            let centre = sim.system().solids()[2].kinematics.centre;
            sim.push(2, &Vector::from([0.0, -pressure * 0.8]), &centre);
            sim.step().unwrap();
            let (t, now) = (sim.time() * c0 / long, sim.system().solids()[2].kinematics);
            let [v, x] = exact[((t * n as f64) as usize).min(10 * n)];
            if (1.0..1.9).contains(&t) {
                let off = -now.velocity[1] / unit - v;
                (sum, squares, count) = (sum + off, squares + off * off, count + 1.0);
            }
            way = (long + 0.02 - now.centre[1]) / (unit * long / c0 * x);
        }
        let (mean, ringing) = (sum / count, (squares / count).sqrt());
        assert!(mean.abs() < 0.07, "ratio {ratio}: it is off by {mean} of P/ρ₀c₀");
        assert!(ringing < 0.1, "ratio {ratio}: it rings with {ringing} of P/ρ₀c₀");
        assert!((way - 1.0).abs() < 0.05, "ratio {ratio}: {way} of the way that m + ρ₀L goes");
    }
}
