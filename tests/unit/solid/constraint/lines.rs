//! Springs and ropes without water: periods, damping, length and tension.

use std::f64::consts::TAU;

use crate::{
    math::{Bivector, Vector},
    solid::{
        Constraints, Dim, HasEngine, Lifetime, LineEnd, Role, RopeSpec, SolidSpec, SpringParameters, SpringSpec,
        constraint::assembly::tests::{DrySystem, G, bar, body, point},
    },
};

fn springs<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar("a", 0.2, point(0.0, 0.0), true), bar("b", 0.2, point::<D>(1.0, 0.0), true)];
    let ends = [(Some(0), 0.1), (Some(1), 0.9)].map(|(solid, x)| LineEnd { solid, at: point(x, 0.0) });
    let spec = SpringSpec {
        name: "spring".into(),
        ends,
        stiffness: 400.0,
        damping: 0.0,
        rest_length: Some(0.7),
        tension_only: false,
        lifetime: Lifetime::default(),
    };
    let m = body(&solids[0]).mass;
    let links = Constraints { springs: vec![spec.clone()], ..Constraints::default() };
    let mut air = DrySystem::new(solids.clone(), links, 0.0);
    // Two equal masses: ω² = 2 k/m.
    let omega = (800.0 / m).sqrt();
    let limit = air.assembly.step_limit(&*air.engine, &air.now(), air.t);
    assert!((limit * omega - 0.2).abs() < 1e-9, "the bound is exact for a pair: {limit}");
    let period = air.period(0.5 * limit, 5, |air| air.assembly.spring_reading(0).length - 0.7);
    // The frequency is too high by (0.1)²/24 at half of the longest step.
    assert!((period * omega / TAU - 1.0).abs() < 6e-4, "{D}-D: {period}");
    let most = (0..2000).fold(0.0, |most: f64, _| {
        air.step(1e-3);
        most.max(air.assembly.spring_reading(0).tension)
    });
    // The spring loses no energy. The position of the turning points within a step changes the amplitude by (Δt ω)²/8, twice.
    assert!((most / 40.0 - 1.0).abs() < 2.6e-3, "{most}");

    // A tension-only line exerts no force while the ends approach, and pulls while they separate.
    let slack = SpringSpec { tension_only: true, rest_length: None, ..spec };
    let mut air = DrySystem::new(solids, Constraints { springs: vec![slack], ..Constraints::default() }, 0.0);
    air.engine.set_velocity(1, &point(-0.1, 0.0), &Bivector::zero());
    air.run(1e-3, 1.0);
    assert_eq!((air.now()[1].velocity[0], air.assembly.spring_reading(0).tension), (-0.1, 0.0));
    air.engine.set_velocity(1, &point(0.5, 0.0), &Bivector::zero());
    air.run(1e-3, 2.0);
    assert!(air.now()[0].velocity[0] > 0.1, "{:?}", air.now());
}

#[test]
fn springs_oscillate_with_their_natural_period_and_mooring_lines_never_push() {
    springs::<2>();
    springs::<3>();
}

#[test]
fn a_damped_spring_reaches_its_static_deflection_for_any_damping() {
    for damping in [200.0, 600.0, 2000.0, 1e7] {
        let solids = vec![bar::<2>("box", 0.2, point(0.0, 0.0), true)];
        let weight = body(&solids[0]).mass * G;
        let ends = [LineEnd { solid: Some(0), at: point(0.0, 0.05) }, LineEnd { solid: None, at: point(0.0, 1.0) }];
        let spec = SpringSpec {
            name: "line".into(),
            ends,
            stiffness: 2000.0,
            damping,
            rest_length: None,
            tension_only: true,
            lifetime: Lifetime::default(),
        };
        let mut air = DrySystem::new(solids, Constraints { springs: vec![spec], ..Constraints::default() }, G);
        let limit = air.assembly.step_limit(&*air.engine, &air.now(), air.t);
        assert!((limit - 0.2 / 10.0).abs() < 1e-12, "damping does not shorten the step: {limit}");
        air.run(1e-3, 20.0);
        let reading = air.assembly.spring_reading(0);
        let sag = (reading.length - 0.95) / (weight / 2000.0);
        if damping == 1e7 {
            // The damping is far too stiff for the step: the body creeps down, at most with the speed gained from gravity in a step.
            assert!(0.0 < sag && sag < 1.0 && air.now()[0].velocity[1].abs() < 1.01 * G * 1e-3, "{reading:?}");
            continue;
        }
        assert!((sag - 1.0).abs() < 1e-6 && (reading.tension / weight - 1.0).abs() < 1e-6, "{damping}: {reading:?}");
    }
}

/// The tension of a spring belongs to its length at every time, the start included: k (l − l₀) + c l̇.
#[test]
fn the_tension_of_a_spring_belongs_to_its_length() {
    for (damping, tension_only) in [(0.0, false), (0.0, true), (20.0, false)] {
        let solids = vec![bar::<2>("box", 0.2, point(0.0, 0.0), true)];
        let ends = [LineEnd { solid: Some(0), at: point(0.0, 0.0) }, LineEnd { solid: None, at: point(0.0, 1.0) }];
        let spec = SpringSpec {
            name: "line".into(),
            ends,
            stiffness: 2000.0,
            damping,
            rest_length: Some(0.6),
            tension_only,
            lifetime: Lifetime::default(),
        };
        let mut air = DrySystem::new(solids, Constraints { springs: vec![spec], ..Constraints::default() }, G);
        let law = |air: &DrySystem<2>| {
            let [length, rate] = [1.0 - air.now()[0].centre[1], -air.now()[0].velocity[1]];
            let stretch = length - 0.6;
            (length, if tension_only && stretch < 0.0 { 0.0 } else { 2000.0 * stretch + damping * rate })
        };
        let (mut least, mut most, mut off) = (f64::INFINITY, 0.0_f64, 0.0_f64);
        assert!((air.assembly.spring_reading(0).tension - 800.0).abs() < 1e-9, "{:?}", air.assembly.spring_reading(0));
        for step in 0..600 {
            air.step(1e-3);
            // The first step knows no reactions, and its damping is that at the start.
            if step == 0 && damping > 0.0 {
                continue;
            }
            let ((length, tension), now) = (law(&air), air.assembly.spring_reading(0));
            assert!((now.length - length).abs() < 1e-12, "{now:?}, {length}");
            (least, most, off) = (least.min(tension), most.max(tension), off.max((now.tension - tension).abs()));
        }
        // The box of 20 kg swings by 0.3 m about the sag. Of one step earlier, the tension would be k l̇ Δt off, up to 6 N.
        assert!(most > 750.0 && least < if tension_only { 1.0 } else { -250.0 }, "{least} to {most} N");
        let bound = if damping == 0.0 { 1e-9 } else { 0.05 };
        assert!(off < bound, "c = {damping}: the tension is {off} N off");
    }
}

/// A box of 20 kg on a vertical damper of `damping` (N s/m) without stiffness, and its weight (N).
fn damper(damping: f64, more: Constraints<2>, solids: Vec<SolidSpec<2>>) -> (DrySystem<2>, f64) {
    let solids: Vec<_> = std::iter::once(bar::<2>("box", 0.2, point(0.0, 0.0), true)).chain(solids).collect();
    let weight = body(&solids[0]).mass * G;
    let ends = [LineEnd { solid: Some(0), at: point(0.0, 0.05) }, LineEnd { solid: None, at: point(0.0, 1.0) }];
    let spring = SpringSpec::new("damper", ends, 0.0).damping(damping);
    (DrySystem::new(solids, Constraints { springs: vec![spring], ..more }, G), weight)
}

#[test]
fn a_load_on_a_damper_moves_at_load_over_damping_for_any_damping() {
    // Δt c/m is 0.0075 to 75. The damping acts at the end of the step, so that the steady speed has no error of the step.
    for damping in [100.0, 1e3, 3e3, 1e4, 1e6] {
        let (mut air, weight) = damper(damping, Constraints::default(), Vec::new());
        air.run(1.5e-3, 4.0);
        let fall = -air.now()[0].velocity[1] / (weight / damping);
        assert!((fall - 1.0).abs() < 1e-8, "{damping} N s/m: {fall} of the speed");
    }
}

#[test]
fn a_damper_bears_nothing_of_a_box_at_rest_on_a_rope_or_on_a_floor() {
    let ends = [LineEnd { solid: Some(0), at: point(0.0, 0.05) }, LineEnd { solid: None, at: point(0.0, 1.0) }];
    let rope = Constraints { ropes: vec![RopeSpec::new("rope", ends)], ..Constraints::default() };
    let mut floor = bar::<2>("floor", 1.0, point(0.0, -0.1), true);
    floor.role = Role::Fixed;
    for (more, solids) in [(rope, Vec::new()), (Constraints::default(), vec![floor])] {
        let on_rope = solids.is_empty();
        let (mut air, weight) = damper(1e4, more, solids);
        let mut most = 0.0f64;
        while air.t < 0.5 {
            air.step(1.5e-3);
            let borne = air.assembly.spring_reading(0).tension.abs() / weight;
            most = most.max(if on_rope || air.t > 0.4 { borne } else { 0.0 });
        }
        // The rope holds the box from the first step. The contact of the floor is a spring, which the damper slows down first.
        assert!(most < 1e-6, "rope {on_rope}: {most} of the weight");
    }
}

fn ropes<const D: usize>(dt: f64, speed: f64)
where
    Dim<D>: HasEngine<D>,
{
    // A stone with an eccentric attachment is thrown sideways: the rope becomes taut, turns the stone, and the stone swings.
    let solids = vec![bar("stone", 0.2, point::<D>(0.2, -0.5), true)];
    let ends = [LineEnd { solid: None, at: Vector::zeros() }, LineEnd { solid: Some(0), at: point(0.25, -0.45) }];
    let rope = RopeSpec { name: "rope".into(), ends, max_length: Some(0.8), lifetime: Lifetime::default() };
    let mut air = DrySystem::new(solids, Constraints { ropes: vec![rope], ..Constraints::default() }, G);
    air.engine.set_velocity(0, &point(speed, 0.2), &Bivector::zero());
    let (mut longest, mut taut): (f64, f64) = (0.0, 0.0);
    while air.t < 2.0 {
        air.step(dt);
        longest = longest.max(air.assembly.rope_reading(0).length);
        taut = taut.max(air.assembly.rope_reading(0).tension);
    }
    assert!(taut > 0.0 && longest > 0.8 * (1.0 - 1e-3), "the rope becomes taut: {longest}");
    assert!(longest < 0.8 * (1.0 + 1e-6), "{D}-D, {speed} m/s, {dt} s: {:e} too long", longest / 0.8 - 1.0);
}

#[test]
fn a_rope_is_never_longer_than_its_length() {
    for speed in [0.0, 1.0, 3.0] {
        ropes::<2>(2e-4, speed);
        ropes::<3>(2e-4, speed);
    }
}

#[test]
fn a_rope_at_rest_carries_the_weight() {
    let solids = vec![bar::<2>("stone", 0.2, point(0.0, -0.5), true)];
    let weight = body(&solids[0]).mass * G;
    let ends = [LineEnd { solid: None, at: Vector::zeros() }, LineEnd { solid: Some(0), at: point(0.0, -0.45) }];
    let rope = RopeSpec { name: "rope".into(), ends, max_length: None, lifetime: Lifetime::default() };
    let mut air = DrySystem::new(solids, Constraints { ropes: vec![rope], ..Constraints::default() }, G);
    air.run(1e-3, 1.0);
    assert!((air.assembly.rope_reading(0).tension / weight - 1.0).abs() < 1e-6, "{:?}", air.assembly.rope_reading(0));
}

#[test]
fn a_spring_mode_in_water_faster_than_the_sound_crossing_has_at_least_three_hundredths_of_critical_damping() {
    let (crossing, mass) = (1e-3, 4.0);
    let of = |omega: f64, damping: f64| {
        let elastic = SpringParameters { stiffness: omega * omega * mass, damping, rest_length: 1.0 };
        elastic.damped_in_water(crossing, 1.0 / mass).damping / (2.0 * omega * mass)
    };
    assert_eq!(of(1999.0, 0.0), 0.0, "a slower mode keeps its damping");
    assert!((of(2001.0, 0.0) - 0.03).abs() < 1e-12 && (of(1e6, 0.0) - 0.03).abs() < 1e-12);
    assert!((of(1e4, 8e5) - 10.0).abs() < 1e-12, "a larger damping of its own is kept");
}
