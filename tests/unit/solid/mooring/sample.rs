use super::forces::{LineMaterial, NodeSurroundings};
use crate::math::Vector;

/// Acceleration of gravity, m/s².
pub(super) const GRAVITY: f64 = 9.81;

/// The vector of gravity, m/s².
pub(super) fn down<const D: usize>() -> Vector<D> {
    Vector::from_fn(|i, _| if i == D - 1 { -GRAVITY } else { 0.0 })
}

/// A light chain without losses, of 0.1 kg/m and 500 N.
pub(super) fn material() -> LineMaterial {
    LineMaterial {
        diameter: 0.004,
        mass: 0.1,
        stiffness: 500.0,
        table: None,
        damping: 0.0,
        bending: 0.0,
        added_mass: [1.0, 0.2],
        drag: [1.2, 0.1],
        water_density: 1000.0,
        contact_width: 0.004,
        contact_radius: 0.0,
        bed_stiffness: 0.0,
        bed_damping: 0.0,
        bed_friction: 0.0,
    }
}

/// What is around a place in air.
pub(super) fn air<const D: usize>(_: &Vector<D>) -> NodeSurroundings<D> {
    NodeSurroundings::air()
}
