//! A solid defined by the triangles of its surface. The module validates the surface and computes its exact properties.

mod completion;
#[cfg(feature = "dim3")]
mod crossings;
#[cfg(feature = "dim3")]
mod exposed;
mod shells;
mod surface;
mod tree;
mod welding;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{VolumeProperties, submerged_volume::Facet};
use crate::{
    error::{Error, Result},
    math::{Bounds, Matrix, Vector},
};
pub(crate) use surface::{Completion, Surface};
use tree::FacetTree;

/// Largest number of facets of a mesh: far more detail than SPH particles resolve.
pub(crate) const MAX_FACETS: usize = 500_000;

/// Longest permitted mesh, m: a longer mesh indicates another unit of length.
const LARGEST: f64 = 1e6;

/// The closed surface of a 3-D solid, as triangles that are counter-clockwise seen from outside.
#[derive(Clone)]
pub struct Mesh {
    points: Vec<Vector<3>>,
    facets: Vec<[u32; 3]>,
    bounds: Bounds<3>,
    /// The facets that bound the solid.
    tree: FacetTree,
    /// Triangles of the surface, if facets lie back to back, as where parts touch; their common area is no surface.
    exposed: Option<Vec<[Vector<3>; 3]>>,
}

/// The geometry of a mesh that other bodies contact. The water always interacts with the mesh itself. Scene key
/// `mesh.contact`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ContactGeometry {
    /// The surface, if the solid is fixed. For a moving solid, the hull if its volume exceeds the solid's by at most a
    /// hundredth, otherwise the decomposition: contact between two bare surfaces cannot keep the solids apart.
    #[default]
    Fitting,
    /// Every facet, for fixed and moving solids: exact and slow, and not robust between two such solids.
    Surface,
    /// The convex hull.
    Hull,
    /// Convex parts that approximate the solid to about a sixtieth of its size.
    Decomposition,
    /// No contact: other bodies pass through the mesh.
    None,
}

impl Mesh {
    /// Returns the solid with these corners (m) and facets. Each facet has three indices of corners, counter-clockwise
    /// seen from outside. The function merges corners at the same position, and omits facets with two corners at the
    /// same position.
    ///
    /// # Errors
    /// `Scene` if a corner is not finite or does not exist, there are too many facets, the surface is open, inside out
    /// or partly inverted, or intersects itself, or a shell lies within a shell of the same orientation. The error
    /// contains the position (m), the number of occurrences and a remedy.
    pub fn new(points: &[Vector<3>], facets: &[[u32; 3]]) -> Result<Self> {
        surface::check_input(points, facets)?;
        let (points, facets) = surface::joined(points, facets);
        welding::check_closed(&points, &facets)?;
        Ok(Self::checked(points, facets, 0.0)?.0)
    }

    /// Returns the solid inside a closed surface, and sentences about crossings of a depth of at most `tolerance` (m) and facets
    /// back to back.
    fn checked(points: Vec<Vector<3>>, facets: Vec<[u32; 3]>, tolerance: f64) -> Result<(Self, Vec<String>)> {
        let volume = moments(&points, &facets).volume;
        let bounds = Bounds::around(&points);
        if volume <= 1e-12 * bounds.size().product() {
            return Err(match volume < 0.0 {
                true => Error::scene("the mesh is inside out: its facets run clockwise, seen from outside")
                    .help("turn them round in the program that made it, or write  flip = true  beside the file's name"),
                false => {
                    Error::scene("the mesh has no volume").help("a solid has an inside: close its surface round it")
                }
            });
        }
        let tree = FacetTree::new(&points, &facets)?;
        let mesh = Self { points, facets, bounds, tree, exposed: None };
        #[cfg(feature = "dim3")]
        let crossings = crossings::check(&mesh, tolerance)?;
        #[cfg(not(feature = "dim3"))]
        let crossings = (tolerance < 0.0).then(String::new);
        shells::check_orientation(&mesh.points, &mesh.facets)?;
        let sentences: Vec<String> = crossings.into_iter().collect();
        #[cfg(feature = "dim3")]
        let (mesh, sentences) = mesh.without_hidden_areas(tolerance, sentences)?;
        Ok((mesh, sentences))
    }

    /// Takes the areas where facets lie back to back out of the surface, and adds a sentence about them.
    #[cfg(feature = "dim3")]
    fn without_hidden_areas(mut self, overlap: f64, mut sentences: Vec<String>) -> Result<(Self, Vec<String>)> {
        if let Some(exposed) = exposed::exposed(&self, overlap) {
            let number = exposed.hidden;
            sentences
                .push(format!("{number} facets of parts that touch lie back to back; their common area is no surface"));
            self.tree = FacetTree::of_triangles(&exposed.triangles, exposed.reach)?;
            self.exposed = Some(exposed.triangles);
        }
        Ok((self, sentences))
    }

    /// Returns the corners, m.
    pub fn points(&self) -> &[Vector<3>] {
        &self.points
    }

    /// Returns the facets: three indices of corners each, counter-clockwise seen from outside.
    pub fn facets(&self) -> &[[u32; 3]] {
        &self.facets
    }

    /// Returns the smallest axis-aligned box around the mesh, m.
    pub(crate) fn bounds(&self) -> Bounds<3> {
        self.bounds
    }

    /// Returns the exact volume, centroid and second moment of the polyhedron.
    pub fn volume_properties(&self) -> VolumeProperties<3> {
        moments(&self.points, &self.facets)
    }

    /// Returns the area of the surface, m².
    pub(crate) fn surface_area(&self) -> f64 {
        self.exposed_triangles::<3>().into_iter().map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm()).sum()
    }

    /// Returns the signed distance (m) of `x` (m) from the surface, negative inside, and the unit vector in which the
    /// distance grows.
    ///
    /// The distance is exact to round-off. Its sign follows from the angle-weighted normal at the nearest point of the
    /// surface. @baerentzen2005
    pub(crate) fn distance_and_normal(&self, x: &Vector<3>) -> (f64, Vector<3>) {
        self.tree.distance_and_normal(x)
    }

    /// Returns the facets with their corners, for sums over the surface; an empty list in 2-D.
    pub(super) fn triangles<const D: usize>(&self) -> Vec<Facet<D>> {
        let corner = |p: &Vector<3>| Vector::from_fn(|i, _| p[i]);
        let all = (0..if D == 3 { self.facets.len() } else { 0 }).map(|i| self.facet_corners(i));
        all.map(|corners| std::array::from_fn(|i| corner(&corners[i]))).collect()
    }

    /// Returns the triangles of the surface without areas back to back; an empty list in 2-D.
    pub(super) fn exposed_triangles<const D: usize>(&self) -> Vec<Facet<D>> {
        let Some(exposed) = self.exposed.as_ref().filter(|_| D == 3) else { return self.triangles() };
        let corner = |p: &Vector<3>| Vector::from_fn(|i, _| p[i]);
        exposed.iter().map(|corners| std::array::from_fn(|i| corner(&corners[i]))).collect()
    }

    fn facet_corners(&self, facet: usize) -> [Vector<3>; 3] {
        self.facets[facet].map(|p| self.points[p as usize])
    }
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points && self.facets == other.facets
    }
}

impl std::fmt::Debug for Mesh {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "Mesh of {} facets", self.facets.len())
    }
}

/// Returns the unit normal of a facet, or `None` if the facet has no area.
#[cfg(feature = "dim3")]
fn facet_normal([a, b, c]: &[Vector<3>; 3]) -> Option<Vector<3>> {
    (b - a).cross(&(c - a)).try_normalize(0.0)
}

/// Returns the signed sum of the tetrahedra between the facets and the mean of all corners.
fn moments(points: &[Vector<3>], facets: &[[u32; 3]]) -> VolumeProperties<3> {
    let bounds = Bounds::around(points);
    let origin = (bounds.min + bounds.max) * 0.5;
    let (mut volume, mut first, mut second) = (0.0, Vector::<3>::zeros(), Matrix::<3>::zeros());
    for facet in facets {
        let [a, b, c] = facet.map(|p| points[p as usize] - origin);
        let part = a.dot(&b.cross(&c)) / 6.0;
        let s = a + b + c;
        volume += part;
        first += s * (0.25 * part);
        second += (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose()) * (0.05 * part);
    }
    let centroid = first / volume;
    VolumeProperties {
        volume,
        centroid: origin + centroid,
        second_moment: second - centroid * centroid.transpose() * volume,
    }
}

#[cfg(all(test, feature = "dim3"))]
#[path = "../../tests/unit/geometry/mesh.rs"]
mod tests;
