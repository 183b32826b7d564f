use super::*;

/// The chain of the 50 m case of the OrcaFlex tables of MoorDyn's tests (BSD-3-Clause): 390 kg/m of 0.252 m in sea water.
fn chain(x: f64, z: f64, length: f64) -> CatenarySpan {
    let weight = (390.0 - 1025.0 * 0.25 * std::f64::consts::PI * 0.252 * 0.252) * 9.81;
    CatenarySpan { x, z, length, weight, stiffness: 1.674e9, bed: Some(0.0) }
}

/// The ends of the position along the line are those of the span, and the derivative of the position has the direction of the tension.
fn check(span: CatenarySpan) -> Catenary {
    let found = span.solve();
    let [x, z] = found.position(span.length);
    let slip = (x - span.x).hypot(z - span.z);
    assert!(slip < 1e-9 * span.length, "{span:?}: the end is {slip} m off");
    found
}

#[test]
fn the_distance_of_the_ends_is_met_hanging_lying_slack_and_taut() {
    let plain = CatenarySpan { x: 1.0, z: 0.5, length: 1.3, weight: 2.0, stiffness: 500.0, bed: None };
    for x in [1e-6, 0.1, 0.8, 1.19, 1.3, 2.0] {
        for z in [0.0, 0.3, 1.0] {
            for stiffness in [50.0, 1e7] {
                check(CatenarySpan { x, z, stiffness, ..plain });
                if x * x + z * z > 1e-3 && (z > 0.0 || x > 1.3) {
                    for friction in [0.0, 0.4] {
                        let found = check(CatenarySpan { x, z, stiffness, bed: Some(friction), ..plain });
                        assert!(found.lying() >= 0.0);
                    }
                }
            }
        }
    }
}

#[test]
fn a_slack_line_has_no_horizontal_tension_and_bears_what_hangs() {
    let span = CatenarySpan { x: 0.5, z: 1.0, length: 2.0, weight: 3.0, stiffness: 1e9, bed: Some(0.0) };
    let found = check(span);
    assert_eq!(found.horizontal, 0.0);
    assert!((found.vertical - 3.0).abs() < 1e-6, "1 m hangs; got {} N", found.vertical);
    assert!((found.tension(1.5) - 1.5).abs() < 1e-6 && found.tension(0.5) == 0.0);
}

/// An inextensible catenary with V = w L, just off the bed: x/a = asinh(L/a), z/a = √(1 + (L/a)²) − 1.
#[test]
fn a_stiff_line_is_the_inextensible_catenary() {
    let (a, length, w) = (1.7, 2.3, 5.0);
    let (x, z) = (a * f64::asinh(length / a), a * (1f64.hypot(length / a) - 1.0));
    let found = CatenarySpan { x, z, length, weight: w, stiffness: 1e12, bed: None }.solve();
    assert!((found.horizontal / (w * a) - 1.0).abs() < 1e-8, "H is {} N, not {} N", found.horizontal, w * a);
    assert!((found.vertical / (w * length) - 1.0).abs() < 1e-8);
}

/// Quasi-static codes give 991.6 kN and 826.2 kN in 50 m, 2065.4 kN and 1402.2 kN in 200 m, 5232.6 kN and 3244.2 kN in 600 m
/// (MoorDyn's tests, `quasi_static_chain`). Their fairlead and anchor differ by w z to 0.1 %, as an elastic catenary's.
#[test]
fn chains_agree_with_quasi_static_codes() {
    let cases = [
        (400.0, 50.0, 410.0, 991.6, 826.2),
        (700.0, 200.0, 760.0, 2065.4, 1402.2),
        (1500.0, 600.0, 1700.0, 5232.6, 3244.2),
    ];
    for (x, z, length, fairlead, anchor) in cases {
        let found = check(chain(x, z, length));
        for (kind, s, expected) in [("fairlead", length, fairlead), ("anchor", 0.0, anchor)] {
            let kilonewtons = found.tension(s) / 1e3;
            assert!((kilonewtons / expected - 1.0).abs() < 0.03, "{z} m: {kind} {kilonewtons} kN, not {expected} kN");
        }
    }
}

/// On a bed with friction the tension falls by C_B w a metre from the touchdown point.
#[test]
fn friction_takes_tension_along_the_bed() {
    let span = CatenarySpan { bed: Some(0.5), ..chain(400.0, 50.0, 410.0) };
    let found = check(span);
    let lying = found.lying();
    assert!(lying > 10.0, "{lying} m lie on the bed");
    let fall = found.tension(lying) - found.tension(lying - 10.0);
    assert!((fall / (5.0 * span.weight) - 1.0).abs() < 1e-9, "10 m of bed take {fall} N");
}
