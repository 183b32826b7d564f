//! Unit tests of `src/study/stress/criteria.rs`.

use super::*;

fn at(kinetic: f64, potential: f64) -> Energies {
    Energies { kinetic, potential, compression: 0.0 }
}

#[test]
fn energy_that_only_falls_or_turns_is_none_made() {
    let mut books = EnergyBalance::new(at(2.0, 0.0), 1.0);
    [at(1.0, 1.0), at(1.5, 0.2), at(0.0, 0.1)].into_iter().for_each(|now| books.update(now));
    assert_eq!(books.relative_excess(), 0.0);
}

#[test]
fn energy_made_is_told_as_a_share_of_what_there_was() {
    let mut books = EnergyBalance::new(at(2.0, 0.0), 1.0);
    books.update(at(2.5, 0.0));
    books.update(at(1.0, 0.0));
    assert_eq!(books.relative_excess(), 0.25, "the most, not the last");
    // Eight more from a fall of ten: the scale is the fall.
    books.update(at(18.0, -10.0));
    assert_eq!(books.relative_excess(), 0.6);
}

#[test]
fn work_of_driven_solids_is_no_energy_made() {
    let mut books = EnergyBalance::new(at(0.0, 0.0), 1.0);
    books.add_work(4.0);
    books.update(at(3.0, 1.0));
    assert_eq!(books.relative_excess(), 0.0);
    books.add_work(-2.0);
    books.update(at(3.0, 1.0));
    assert_eq!(books.relative_excess(), 0.5, "what was given back is no longer there: 2 of 4");
}

#[test]
fn what_lifts_a_tenth_of_a_particle_is_the_least_scale() {
    let mut books = EnergyBalance::new(at(0.0, 0.0), 100.0);
    books.update(at(0.1, 0.0));
    assert!((books.relative_excess() - 0.01).abs() < 1e-15);
    books.update(at(f64::NAN, 0.0));
    assert!(books.relative_excess() > 1e300, "what is no number is the worst");
    let mut weightless = EnergyBalance::new(at(0.0, 0.0), 0.0);
    weightless.update(at(1e-9, 0.0));
    assert!(weightless.relative_excess() > 1e300, "where there was nothing, anything is too much");
}

#[test]
fn a_figure_misses_its_bound_above_it_and_where_it_is_not() {
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
    assert_eq!(judge.missed_bounds(&figures(f64::NAN, 0.0)).len(), 1, "what is no number misses any bound");
    let mut without = figures(0.0, 0.0);
    without.remove("draft of box");
    assert_eq!(judge.missed_bounds(&without), ["draft of box not measured"]);
}

#[test]
fn another_bound_asks_for_no_other_run() {
    let judge = |within| Criteria { energy: Some(Bound { within, why: String::new() }), ..Criteria::default() };
    assert_eq!(judge(0.1).required_figures(), judge(0.2).required_figures());
    assert_ne!(judge(0.1).required_figures(), Criteria::default().required_figures());
}
