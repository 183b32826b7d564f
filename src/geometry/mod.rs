//! Geometry of solids and water: shapes, volumes, distances, boundary points and filling. The module handles neither motion
//! nor mass, and reads no files.
//!
//! A [`Shape`] computes its exact volume properties, its signed distance, its submerged part and its boundary
//! particles. [`fill()`] places water on a lattice and fits the water to the solids.

mod boundary_points;
pub(crate) mod cells;
mod check;
mod distance;
mod exposed;
pub mod fill;
mod fit;
pub(crate) mod hollow;
mod hollow_surface;
pub(crate) mod mesh;
mod moments;
mod offset;
pub(crate) mod overlap;
mod packing;
pub(crate) mod panels;
mod projected_area;
mod shell;
pub(crate) mod solids_of_revolution;
mod submerged_volume;
mod support;
pub(crate) mod thin;
pub(crate) mod triangulation;
pub(crate) mod wall;

use std::sync::Arc;

use crate::math::{Matrix, Pose, Vector};

pub(crate) use fill::fill_around;
pub use fill::{FilledWater, WaterRegion, fill};
pub use mesh::{ContactGeometry, Mesh};
pub(crate) use projected_area::Silhouette;
pub(crate) use support::{farthest_along, greatest_length, world_bounds};

/// A shape in its own frame, m. The last axis is vertical if the shape is not rotated.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, reason = "the sentence of each variant names its fields")]
#[non_exhaustive]
pub enum Shape<const D: usize> {
    /// A box of edge lengths `size`, centred on the origin.
    Box { size: Vector<D> },
    /// A ball of `radius` around the origin: a disc in 2-D.
    Ball { radius: f64 },
    /// A straight part of `length` along `axis` (0, 1, 2), centred on the origin, with round ends.
    Capsule { length: f64, radius: f64, axis: usize },
    /// A circular cylinder of `length` along `axis`, centred on the origin; 3-D only.
    Cylinder { length: f64, radius: f64, axis: usize },
    /// A simple polygon, counter-clockwise; 2-D only.
    Polygon { points: Vec<Vector<D>> },
    /// A wall along a line, 2-D only. Seen from the first point towards the last, the line is the left face of the
    /// solid, which is `thickness` thick on the right. If the last point equals the first, the wall is a closed ring:
    /// outside a line that runs counter-clockwise, inside a line that runs clockwise. An open line that runs towards +x
    /// is a bed: the filling places no water below a bed of a solid that is not free, even if the bed is thin.
    Polyline { points: Vec<Vector<D>>, thickness: f64 },
    /// An open-topped tank: bottom and side walls `thickness` thick around the inner box from the
    /// origin to `size`.
    Tank { size: Vector<D>, thickness: f64 },
    /// A solid with the facets of its surface, and the geometry that other bodies contact; 3-D only.
    Mesh { mesh: Arc<Mesh>, contact: ContactGeometry },
    /// Several shapes as a single solid, each at its pose. The shapes must not overlap, unless the solid is fixed or
    /// driven.
    Compound(Vec<(Pose<D>, Shape<D>)>),
}

/// Volume properties of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeProperties<const D: usize> {
    /// Volume, m³ (area, m², in 2-D).
    pub volume: f64,
    /// Centroid in the shape's frame, m.
    pub centroid: Vector<D>,
    /// J = ∫ (x − centroid)(x − centroid)ᵀ dV, m⁵ (m⁴ in 2-D). A body of density ρ has the inertia ρ tr J in 2-D
    /// and ρ (tr J · 1 − J) in 3-D about its centroid.
    pub second_moment: Matrix<D>,
}

/// A boundary particle, in the shape's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryPoint<const D: usize> {
    /// Position, m.
    pub r: Vector<D>,
    /// Layer number, counted from the nearest face. Layer 0 lies half a dp inside the true face.
    pub layer: u8,
}
