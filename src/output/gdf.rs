//! Panels in WAMIT's format `.gdf`, which Capytaine, HAMS and other panel methods read.

use std::fmt::Write as _;

/// Returns the text of a file with these triangles (m), each as a quadrilateral whose last two corners coincide. The first line
/// is `title`; `gravity` is in m/s². There are no planes of symmetry.
pub(crate) fn gdf_text(title: &str, gravity: f64, panels: &[[[f64; 3]; 3]]) -> String {
    let title = title.replace(['\n', '\r'], " ");
    let mut text = format!("{title}\n1.0 {gravity:?}\n0 0\n{}\n", panels.len());
    for [a, b, c] in panels {
        for [x, y, z] in [a, b, c, c] {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{x:.9e} {y:.9e} {z:.9e}");
        }
    }
    text
}
