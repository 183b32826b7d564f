//! Parts thinner than dp beside hollows, and the faces of parts that keep water out in 3-D: the host computes their loads and their push
//! from what it reads of the water near them.

use pontoon::{
    geometry::Shape,
    math::Vector,
    model::{Model, TimeScheme},
    simulation::{Setup, Simulation},
    solid::{Role, SolidSpec},
};

use super::{
    beside,
    coupled::{assert_repeats_and_resumes, setup_of, solids_apart},
    device, distances,
    films::loads_agree,
};

/// Water 0.5 m deep in a tank of 0.6 m; dp = 50 mm.
fn tank(thickness: f64, scheme: TimeScheme) -> Setup<3> {
    let cfl = if scheme == TimeScheme::Symplectic { 0.4 } else { 0.2 };
    let model = Model::water(3, 0.05, 0.5).scheme(scheme).cfl(cfl);
    let walls = SolidSpec::fixed("tank", Shape::Tank { size: [0.6, 0.6, 0.6].into(), thickness });
    Setup::new(model).solid(walls).fill_box([0.0; 3], [0.6, 0.6, 0.5]).expect("water")
}

/// Depth (dp) in a wall of the particle that is deepest there; less than 0 if none is.
fn deepest(sim: &Simulation<3>) -> f64 {
    let depth = |r: &Vector<3>| [r[0], 0.6 - r[0], r[1], 0.6 - r[1], r[2]].into_iter().fold(1.0, f64::min);
    -sim.system().fluid().r.iter().map(depth).fold(1.0, f64::min) / 0.05
}

#[test]
fn thin_walls_push_water_as_the_reference_does() {
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    for (name, thickness, scheme) in [
        ("symplectic", 0.07, TimeScheme::Symplectic),
        ("Verlet", 0.07, verlet),
        ("a tenth of dp", 0.005, TimeScheme::Symplectic),
    ] {
        let setup = tank(thickness, scheme);
        let [mut on_device, mut reference] = beside(&setup, 0.0, 0);
        // Walls push water nearer than a quarter of dp. Some ten steps after the first push both drift apart: water at such walls forgets its
        // state fast, with the pair loop of the processor, too.
        let mut pushes = 0;
        while pushes < 6 {
            on_device.step().unwrap();
            reference.step().unwrap();
            pushes += usize::from(deepest(&reference) > -0.25);
            assert!(reference.time() < 0.5, "{name}: no push: {} dp", deepest(&reference));
        }
        let [r, v] = distances(&on_device, &reference);
        let [here, there] = [&on_device, &reference].map(|sim| sim.system().solids()[0].load.force);
        let off = (here - there).norm() / there.norm();
        println!("{name}, {} steps: water {r:.1e} dp, {v:.1e} c0; loads {off:.1e} apart", reference.steps());
        // The bounds of whole steps in space, and of loads on driven solids.
        assert!(r < 1e-5, "{name}: water {r} dp off");
        assert!(off < 1e-3, "{name}: loads {here} and {there}");
    }
    assert_repeats_and_resumes("thin walls", &tank(0.07, TimeScheme::Symplectic), 44, 1e-4);
}

#[test]
fn thin_walls_keep_water_in() {
    // By boundary particles alone 392 of 1440 particles leave this tank in a second. Bound: half a dp, as on the processor.
    for thickness in [0.005, 0.07] {
        let setup = tank(thickness, TimeScheme::Symplectic);
        let mut sim = Simulation::new(setup).unwrap().on_device(&device()).unwrap();
        while sim.time() < 0.6 {
            sim.step_to(0.6).unwrap();
        }
        let (count, depth) = (sim.system().fluid().len(), deepest(&sim));
        println!("{thickness} m: {count} particles, the deepest {depth} dp in a wall");
        assert!(count == 1440 && depth < 0.5, "{thickness} m: {count} particles, one {depth} dp in a wall");
    }
}

#[test]
fn a_thin_plate_pushes_water_as_the_reference_does() {
    // A heavy plate of 0.2 dp moves broadside on through the water.
    let model = Model::water(3, 0.05, 0.5).for_free_bodies();
    let walls = SolidSpec::fixed("tank", Shape::Tank { size: [0.6, 0.6, 0.6].into(), thickness: 0.2 });
    let plate = SolidSpec::free("plate", Shape::Box { size: [0.01, 0.3, 0.2].into() }, 5e4).at([0.31, 0.3, 0.25]);
    let mut setup = Setup::new(model).solid(walls).solid(plate).fill_box([0.0; 3], [0.6, 0.6, 0.5]).expect("water");
    let Role::Free(body) = &mut setup.solids[1].role else { panic!("a free body") };
    body.velocity = Vector::from([4.0, 0.0, 0.0]);
    let [mut on_device, mut reference] = beside(&setup, 0.0, 0);
    let nearest = |sim: &Simulation<3>| {
        let centre = sim.system().solids()[1].kinematics.centre;
        let beside = sim.system().fluid().r.iter().map(|r| r - centre);
        let beside = beside.filter(|x| x[1].abs() < 0.14 && x[2].abs() < 0.09).map(|x| (x[0].abs() - 0.005) / 0.05);
        beside.fold(f64::INFINITY, f64::min)
    };
    let mut pushes = 0;
    while pushes < 4 {
        on_device.step().unwrap();
        reference.step().unwrap();
        pushes += usize::from(nearest(&reference) < 0.25);
        assert!(reference.time() < 0.1, "no push: {} dp", nearest(&reference));
    }
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("plate, {} steps: water {r:.1e} dp, {v:.1e} c0, plate {body:.1e} dp", reference.steps());
    // The bound of a body in space.
    assert!(r < 1e-4 && body < 1e-4, "water {r} dp, plate {body} dp off");
}

/// Water 0.3 m deep in a tank, or in `vessel` alone; a vessel of 0.3 m with walls of 0.4 dp; dp = 20 mm.
fn vessel(water: &str, dry: &str) -> Setup<2> {
    setup_of(&format!(
        r#"dimension = 2
dp = 0.02
until = 1.0
[[water]]
fill = {{ box = {water} }}
[[solid]]
name = "sea"
fixed = true
shape = {{ tank = {{ size = [0.8, 0.6] }} }}
[[solid]]
name = "vessel"
shape = {{ tank = {{ size = [0.3, 0.26], thickness = 0.008 }} }}
{dry}
at = {{ x = 0.25, y = 0.15 }}
free = {{ mass = 7.0, locked = ["x", "y", "turn"] }}
"#
    ))
}

#[test]
fn a_thin_vessel_has_the_load_of_the_reference() {
    // Water in its hollow does not count for the correction of (dp − t) dp ρ₀ g a particle, 2.4 N/m; water outside does.
    let afloat = vessel("{ min = [0.0, 0.0], max = [0.8, 0.3] }", "dry = true");
    let lift = loads_agree("afloat", &afloat, 9810.0 * 0.3 * 0.15);
    assert!(lift > 0.0, "it is lifted: {lift} N/m");
    let full = vessel("{ min = [0.25, 0.15], max = [0.55, 0.35] }", "");
    let weight = loads_agree("full", &full, 9810.0 * 0.3 * 0.2);
    assert!(weight < 0.0, "it carries its water: {weight} N/m");
}
