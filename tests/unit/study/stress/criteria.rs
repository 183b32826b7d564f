//! Unit tests of `src/study/stress/criteria.rs`.

use super::*;

fn at(kinetic: f64, potential: f64) -> Energies {
    Energies { kinetic, potential, compression: 0.0 }
}

#[test]
fn falling_or_converted_energy_has_no_excess() {
    let mut balance = EnergyBalance::new(at(2.0, 0.0), 1.0);
    [at(1.0, 1.0), at(1.5, 0.2), at(0.0, 0.1)].into_iter().for_each(|now| balance.update(now));
    assert_eq!(balance.relative_excess(), 0.0);
}

#[test]
fn excess_energy_is_relative_to_the_initial_energy() {
    let mut balance = EnergyBalance::new(at(2.0, 0.0), 1.0);
    balance.update(at(2.5, 0.0));
    balance.update(at(1.0, 0.0));
    assert_eq!(balance.relative_excess(), 0.25, "the maximum, not the last value");
    // A gain of six after a fall of ten: the scale is the fall.
    balance.update(at(18.0, -10.0));
    assert_eq!(balance.relative_excess(), 0.6);
}

#[test]
fn work_of_driven_solids_is_not_excess_energy() {
    let mut balance = EnergyBalance::new(at(0.0, 0.0), 1.0);
    balance.add_work(4.0);
    balance.update(at(3.0, 1.0));
    assert_eq!(balance.relative_excess(), 0.0);
    balance.add_work(-2.0);
    balance.update(at(3.0, 1.0));
    assert_eq!(balance.relative_excess(), 0.5, "after negative work the excess is 2 of 4");
}

#[test]
fn the_scale_of_excess_energy_has_a_lower_limit() {
    let mut balance = EnergyBalance::new(at(0.0, 0.0), 100.0);
    balance.update(at(0.1, 0.0));
    assert!((balance.relative_excess() - 0.01).abs() < 1e-15);
    balance.update(at(f64::NAN, 0.0));
    assert!(balance.relative_excess() > 1e300, "a value that is not a number is the largest excess");
    let mut weightless = EnergyBalance::new(at(0.0, 0.0), 0.0);
    weightless.update(at(1e-9, 0.0));
    assert!(weightless.relative_excess() > 1e300, "without a scale any energy is an excess");
}

#[test]
fn a_figure_above_its_bound_or_without_a_measurement_misses_it() {
    let bound = |within| Some(Bound { within, why: String::new() });
    let of = SolidBound { solid: "box".into(), within: 0.5, why: String::new() };
    let judge = Criteria { energy: bound(0.1), walls: bound(0.5), draft: vec![of], ..Criteria::default() };
    let figures = |energy: f64, outside: f64| {
        let all = [("energy", energy), ("walls", 0.5), ("bodies", 0.0), ("outside", outside), ("draft of box", 0.4)];
        MeasuredFigures::from(all.map(|(name, x)| (name.to_string(), x)))
    };
    assert!(judge.missed_bounds(&figures(0.1, 0.0)).is_empty());
    assert_eq!(judge.missed_bounds(&figures(0.2, 0.0)), ["energy 0.200 > 0.1"]);
    assert_eq!(judge.missed_bounds(&figures(0.0, 1.0)), ["outside 1.000 > 0"]);
    assert_eq!(
        judge.missed_bounds(&figures(f64::NAN, 0.0)).len(),
        1,
        "a value that is not a number misses every bound"
    );
    let mut without = figures(0.0, 0.0);
    without.remove("draft of box");
    assert_eq!(judge.missed_bounds(&without), ["draft of box not measured"]);
}

#[test]
fn the_required_figures_do_not_depend_on_the_bounds() {
    let judge = |within| Criteria { energy: Some(Bound { within, why: String::new() }), ..Criteria::default() };
    assert_eq!(judge(0.1).required_figures(), judge(0.2).required_figures());
    assert_ne!(judge(0.1).required_figures(), Criteria::default().required_figures());
}
