//! Unit tests of `src/report/colour.rs`.

use super::*;

#[test]
fn the_ends_and_the_middle_of_viridis_have_the_published_colours() {
    assert_eq!([colour_at(VIRIDIS, -1.0), colour_at(VIRIDIS, 1.0)], [[0x44, 0x01, 0x54], [0xfd, 0xe7, 0x25]]);
    assert_eq!(colour_at(VIRIDIS, 0.5), [0x21, 0x91, 0x8c]);
}

#[test]
fn lightness_increases_along_each_colour_map() {
    let light = |c: [u8; 3]| 0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2]);
    for map in [VIRIDIS, CIVIDIS] {
        let lights: Vec<f64> = (0..33).map(|i| light(colour_at(map, f64::from(i) / 32.0))).collect();
        assert!(lights.windows(2).all(|w| w[1] > w[0]), "{lights:?}");
    }
}
