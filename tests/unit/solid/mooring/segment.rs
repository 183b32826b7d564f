use std::sync::Arc;

use super::*;
use crate::solid::mooring::sample::material;

/// The chord of the tension found has the strain it was found for, taut and slack, and the slope is the derivative.
#[test]
fn the_tension_belongs_to_the_strain() {
    let table =
        LineMaterial { table: Some(Arc::from([[0.0, 0.0], [0.02, 4.0], [0.1, 36.0]])), stiffness: 400.0, ..material() };
    for line in [material(), table] {
        for strain in [-0.3, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 0.019, 0.05, 0.3] {
            for sag in [1e-12, 1e-4, 1e-2, 1.0] {
                let chord = |tension: f64| {
                    let elastic = match &line.table {
                        None => tension / line.stiffness,
                        Some(_) if tension < 4.0 => tension / 200.0,
                        Some(_) => 0.02 + (tension - 4.0) / 400.0,
                    };
                    elastic - sag / (24.0 * tension * tension)
                };
                let [tension, slope] = catenary_law(&line, strain, sag, (0.0, 0.0));
                let error = (chord(tension) - strain).abs();
                assert!(error < 1e-12 * (1.0 + sag / (tension * tension)), "{strain}, {sag}: {error}");
                let way = 1e-5 * tension;
                let difference = 2.0 * way / (chord(tension + way) - chord(tension - way));
                let kink = line.table.is_some() && (tension - 4.0).abs() < way;
                assert!(kink || (difference / slope - 1.0).abs() < 1e-6, "{strain}, {sag}: {slope}, {difference}");
            }
        }
    }
}

/// Without weight across it a slack segment carries nothing.
#[test]
fn without_sag_the_law_is_elastic() {
    assert_eq!(catenary_law(&material(), -0.1, 0.0, (0.0, 0.0)), [0.0, 0.0]);
    assert_eq!(catenary_law(&material(), 0.1, 0.0, (0.0, 0.0)), [50.0, 500.0]);
}

/// A stiff beam does not sag between its nodes, and does not push when its chord is short.
#[test]
fn bending_holds_the_sag_back() {
    let [tension, ..] = catenary_law(&material(), 0.01, 1.0, (1e4, 0.0));
    assert!((tension - 5.0).abs() < 1e-3, "{tension} N");
    assert_eq!(catenary_law(&material(), -0.01, 1.0, (1e4, 0.0)), [0.0, 0.0]);
}
