//! Search for the nearest point of a mesh, by parry's tree of boxes. Without the feature `dim3` neither the tree nor a
//! mesh exists.

#[cfg(feature = "dim3")]
pub(crate) use with_parry::FacetTree;
#[cfg(not(feature = "dim3"))]
pub(crate) use without::FacetTree;

#[cfg(feature = "dim3")]
mod with_parry {
    use parry3d::{
        bounding_volume::BoundingVolume,
        math::Vector as Point,
        query::PointQueryWithLocation,
        shape::{TriMesh, TriMeshFlags, TrianglePointLocation},
    };
    use rayon::prelude::*;

    use super::super::{
        Mesh,
        crossings::{Crossings, crossing},
    };
    use crate::{
        error::{Error, Result},
        math::Vector,
    };

    /// Largest number of nearby facets that the code compares with a facet.
    const MOST_NEAR: usize = 2000;

    /// The facets in a tree of bounding boxes, with the normals of facets, edges and corners.
    #[derive(Clone)]
    pub(crate) struct FacetTree(TriMesh);

    impl FacetTree {
        pub(crate) fn new(points: &[Vector<3>], facets: &[[u32; 3]]) -> Result<Self> {
            let points = points.iter().map(|p| Point::from_array((*p).into())).collect();
            TriMesh::with_flags(points, facets.to_vec(), TriMeshFlags::ORIENTED)
                .map(Self)
                .map_err(|why| Error::scene(format!("the mesh is no surface: {why}")))
        }

        /// Returns the same as [`Mesh::distance_and_normal`].
        pub(crate) fn distance_and_normal(&self, x: &Vector<3>) -> (f64, Vector<3>) {
            let at = Point::from_array((*x).into());
            let (foot, (facet, location)) = self.0.project_local_point_and_get_location(at, false);
            let way = x - Vector::from(foot.point.to_array());
            let distance = way.norm();
            let (sign, turn) = if foot.is_inside { (-1.0, -1.0 / distance) } else { (1.0, 1.0 / distance) };
            // On the surface the vector to the nearest point vanishes, so the code uses the normal at that point.
            let size = self.0.bvh().root_aabb().extents().length();
            let normal = if distance > 1e-12 * size { way * turn } else { self.normal(facet, location) };
            (sign * distance, normal)
        }

        fn normal(&self, facet: u32, location: TrianglePointLocation) -> Vector<3> {
            let normal = match (location, self.0.pseudo_normals_if_oriented()) {
                (TrianglePointLocation::OnVertex(i), Some(normals)) => {
                    normals.vertices_pseudo_normal[self.0.indices()[facet as usize][i as usize] as usize]
                }
                (TrianglePointLocation::OnEdge(i, _), Some(normals)) => {
                    normals.edges_pseudo_normal[facet as usize][i as usize]
                }
                _ => self.0.triangle(facet).normal().unwrap_or(Point::ZERO),
            };
            Vector::from(normal.to_array()).try_normalize(1e-12).unwrap_or_else(Vector::zeros)
        }

        /// Returns the places where the mesh passes through itself.
        pub(crate) fn find_crossings(&self, mesh: &Mesh) -> Crossings {
            let size = mesh.bounds.size().max();
            let of_facet = |found: Crossings, a: usize| {
                let around = self.0.triangle(a as u32).local_aabb();
                let near = self.0.bvh().leaves(|node| node.aabb().intersects(&around)).take(MOST_NEAR);
                let later = near.map(|b| b as usize).filter(|b| *b > a);
                later
                    .filter_map(|b| crossing(mesh, size, a, b).map(|crossing| (b, crossing)))
                    .fold(found, |found, (b, crossing)| found.add(a, b, crossing))
            };
            (0..mesh.facets.len())
                .into_par_iter()
                .fold(Crossings::default, of_facet)
                .reduce(Crossings::default, Crossings::and)
        }
    }
}

#[cfg(not(feature = "dim3"))]
mod without {
    use crate::{
        error::{Error, Result},
        math::Vector,
    };

    /// A type without values: without the feature `dim3` no mesh exists.
    #[derive(Clone)]
    pub(crate) enum FacetTree {}

    impl FacetTree {
        pub(crate) fn new(_: &[Vector<3>], _: &[[u32; 3]]) -> Result<Self> {
            Err(Error::scene("a mesh needs three dimensions, which this program was built without")
                .help("build it with the feature dim3"))
        }

        pub(crate) fn distance_and_normal(&self, _: &Vector<3>) -> (f64, Vector<3>) {
            match *self {}
        }
    }
}
