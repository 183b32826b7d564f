//! Flows between faces against theory, and the same flow between periodic sides: what is due to the faces, and what to the particles.

use pontoon::{
    probe::{PressureProbe, Probe},
    simulation::Simulation,
};

use crate::common;

/// Largest velocity of the flow between plates, m/s: u = 4 U y (1 − y) over a height of 1 m.
const LARGEST: f64 = 0.75;

/// Gradient of the pressure in it, Pa/m: 8 ρ ν U with ν = 0.1 m²/s.
const GRADIENT: f64 = 600.0;

/// The scene of the flow between plates, 20 dp apart, over 2 m, driven as `drive` says. Shifting keeps the particles in order: a disturbed
/// flow between periodic sides without it has 8 % more drag.
fn plates(drive: &str) -> String {
    format!(
        r#"
        dimension = 2
        dp = 0.05
        until = 8.0
        {drive}
        [[water]]
        fill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 1.0] }} }}
        velocity = ["3*y*(1-y)+0.1*sin(4*pi*x)*sin(3*pi*y)", "0.1*sin(6*pi*x+1)*sin(pi*y)"]
        [[solid]]
        name = "bottom"
        fixed = true
        shape = {{ box = {{ size = [8.0, 0.2] }} }}
        at = {{ x = 1.0, y = -0.1 }}
        [[solid]]
        name = "top"
        fixed = true
        shape = {{ box = {{ size = [8.0, 0.2] }} }}
        at = {{ x = 1.0, y = 1.1 }}
        [model]
        rho0 = 1000.0
        c0 = 20.0
        slip = "none"
        diffusion = {{ molteni = {{ delta = 0.1 }} }}
        viscosity = {{ laminar = {{ nu0 = 0.1 }} }}
        shifting = {{ everywhere = {{ }} }}
        "#
    )
}

/// Of the flow between 4 and 8 s the mean deviation from the profile over the largest velocity, the drop of pressure over the middle
/// metre, Pa, and the number of particles beside the inflow over that at the start.
fn flow_between_plates(drive: &str) -> [f64; 3] {
    let mut sim = common::scene_simulation::<2>(&plates(drive)).expect("a sound scene");
    let probes = [0.5, 1.5].map(|x| PressureProbe::<2>::new(&[x, 0.5]).expect("a place in the water"));
    let now = |sim: &Simulation<2>| {
        let fluid = sim.system().fluid();
        let middle = || fluid.r.iter().zip(fluid.v).filter(|(r, _)| (0.6..1.4).contains(&r[0]));
        let off = middle().map(|(r, v)| (v[0] - 4.0 * LARGEST * r[1] * (1.0 - r[1])).abs()).sum::<f64>();
        let [first, last] = [0, 1].map(|i| probes[i].sample(sim)[0]);
        let beside = fluid.r.iter().filter(|r| r[0] < 0.4).count() as f64 / 160.0;
        [off / middle().count() as f64 / LARGEST, first - last, beside]
    };
    common::time_mean(&mut sim, 4.0, 8.0, now).expect("a sound run")
}

/// The control: between periodic sides, driven by the gradient as a body force, the same particles keep the profile within 2 %.
#[test]
fn poiseuille_flow_between_periodic_sides_keeps_its_profile_at_its_gradient() {
    let drive = "gravity = [0.6, 0.0]\nperiodic = { x = [0.0, 2.0] }";
    let [off, ..] = flow_between_plates(drive);
    assert!(off < 0.02, "the velocity is off by {off} of the largest");
}

/// Between faces the profile is right within 2 % and the gradient of the pressure within 3 %, whether the outflow has a velocity or
/// a pressure only. Water enters all the time, though with shifting all lists are rebuilt within steps: no more than a row of the
/// eight beside the inflow is missing in the mean.
#[test]
fn poiseuille_flow_has_its_profile_and_gradient_with_a_prescribed_and_a_free_outflow() {
    for outflow in ["velocity = \"3*y*(1-y)\"", "level = 1.0"] {
        let faces = format!(
            "gravity = [0.0, 0.0]\ninflow = [{{ x = 0.0, velocity = \"3*y*(1-y)\" }}]\noutflow = [{{ x = 2.0, {outflow} }}]"
        );
        let [off, drop, beside] = flow_between_plates(&faces);
        assert!(off < 0.02, "{outflow}: the velocity is off by {off} of the largest");
        assert!((drop / GRADIENT - 1.0).abs() < 0.03, "{outflow}: {drop} Pa over 1 m, in theory {GRADIENT} Pa");
        assert!((beside - 1.0).abs() < 0.125, "{outflow}: {beside} of the water beside the inflow");
    }
}

/// Faces are vertical: there is no key for one normal to z.
#[test]
fn a_horizontal_face_is_refused_with_the_keys_that_exist() {
    let text = "dimension = 3\ndp = 0.1\nuntil = 1.0\ninflow = [{ z = 0.0, velocity = 0.5 }]\n\
                water = [{ fill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 1.2, 0.4] } } }]\n";
    let error = common::scene_simulation::<3>(text).err().expect("no such face");
    assert_eq!(error.location.as_ref().map(|place| place.key.as_str()), Some("inflow.0.z"), "{error}");
    assert!(error.to_string().contains("name, x, y, velocity"), "{error}");
}
