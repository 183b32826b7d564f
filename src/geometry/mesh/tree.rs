//! Search for the nearest point of a mesh, by parry's tree of boxes. Without the feature `dim3` neither the tree nor a
//! mesh exists.

#[cfg(feature = "dim3")]
pub(crate) use with_parry::FacetTree;
#[cfg(not(feature = "dim3"))]
pub(crate) use without::FacetTree;

#[cfg(feature = "dim3")]
mod with_parry {
    use std::f64::consts::{PI, TAU};

    use parry3d::{
        bounding_volume::{Aabb, BoundingVolume},
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
    pub(crate) struct FacetTree {
        facets: TriMesh,
        /// Distance (m) within which the edges of facets meet, if neighbours do not share their corners.
        reach: Option<f64>,
    }

    impl FacetTree {
        pub(crate) fn new(points: &[Vector<3>], facets: &[[u32; 3]]) -> Result<Self> {
            let points = points.iter().map(|p| Point::from_array((*p).into())).collect();
            TriMesh::with_flags(points, facets.to_vec(), TriMeshFlags::ORIENTED)
                .map(|facets| Self { facets, reach: None })
                .map_err(|why| Error::scene(format!("the mesh is no surface: {why}")))
        }

        /// Returns a tree of triangles whose edges meet within `reach` (m), without common corners.
        pub(crate) fn of_triangles(triangles: &[[Vector<3>; 3]], reach: f64) -> Result<Self> {
            let points: Vec<Vector<3>> = triangles.concat();
            let facets: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            Ok(Self { reach: Some(reach), ..Self::new(&points, &facets)? })
        }

        /// Returns the facets whose bounding boxes come within `margin` (m) of that of a facet, no more than a fixed number.
        pub(crate) fn near(&self, facet: u32, margin: f64) -> impl Iterator<Item = usize> {
            let around = self.facets.triangle(facet).local_aabb().loosened(margin);
            self.facets.bvh().leaves(move |node| node.aabb().intersects(&around)).take(MOST_NEAR).map(|b| b as usize)
        }

        /// Returns the same as [`Mesh::distance_and_normal`].
        pub(crate) fn distance_and_normal(&self, x: &Vector<3>) -> (f64, Vector<3>) {
            let at = Point::from_array((*x).into());
            let (foot, (facet, location)) = self.facets.project_local_point_and_get_location(at, false);
            let way = x - Vector::from(foot.point.to_array());
            let distance = way.norm();
            if let Some(reach) = self.reach {
                let normal = self.normal_around(foot.point, reach);
                let (sign, least) = (if way.dot(&normal) < 0.0 { -1.0 } else { 1.0 }, 1e-12 * self.extent());
                return (sign * distance, if distance > least { way * (sign / distance) } else { normal });
            }
            let (sign, turn) = if foot.is_inside { (-1.0, -1.0 / distance) } else { (1.0, 1.0 / distance) };
            // On the surface the vector to the nearest point vanishes, so the code uses the normal at that point.
            let normal = if distance > 1e-12 * self.extent() { way * turn } else { self.normal(facet, location) };
            (sign * distance, normal)
        }

        /// Returns the length of the diagonal of the smallest box around the facets, m.
        fn extent(&self) -> f64 {
            self.facets.bvh().root_aabb().extents().length()
        }

        /// Returns the sum of the normals of all facets within `reach` (m) of a point of the surface, weighted by their angles
        /// there.
        fn normal_around(&self, x: Point, reach: f64) -> Vector<3> {
            let around = Aabb::new(x, x).loosened(reach);
            let near = self.facets.bvh().leaves(|node| node.aabb().intersects(&around));
            let weighted = near.filter_map(|i| {
                let facet = self.facets.triangle(i);
                let angle = angle_at(&[facet.a, facet.b, facet.c], x, reach);
                facet.normal().map(|normal| normal * angle)
            });
            let sum = weighted.fold(Point::ZERO, |sum, normal| sum + normal);
            Vector::from(sum.to_array()).try_normalize(1e-12).unwrap_or_else(Vector::zeros)
        }

        fn normal(&self, facet: u32, location: TrianglePointLocation) -> Vector<3> {
            let normal = match (location, self.facets.pseudo_normals_if_oriented()) {
                (TrianglePointLocation::OnVertex(i), Some(normals)) => {
                    normals.vertices_pseudo_normal[self.facets.indices()[facet as usize][i as usize] as usize]
                }
                (TrianglePointLocation::OnEdge(i, _), Some(normals)) => {
                    normals.edges_pseudo_normal[facet as usize][i as usize]
                }
                _ => self.facets.triangle(facet).normal().unwrap_or(Point::ZERO),
            };
            Vector::from(normal.to_array()).try_normalize(1e-12).unwrap_or_else(Vector::zeros)
        }

        /// Returns the places where the mesh passes through itself.
        pub(crate) fn find_crossings(&self, mesh: &Mesh) -> Crossings {
            let size = mesh.bounds.size().max();
            let of_facet = |found: Crossings, a: usize| {
                let later = self.near(a as u32, 0.0).filter(|b| *b > a);
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

    /// Returns the angle (rad) that a facet takes at `x`, within `reach` (m) of its corners and edges; zero apart from the facet.
    fn angle_at(corners: &[Point; 3], x: Point, reach: f64) -> f64 {
        let [a, b, c] = corners.map(|p| Vector::<3>::from((p - x).to_array()));
        let Some(normal) = (b - a).cross(&(c - a)).try_normalize(0.0) else { return 0.0 };
        if normal.dot(&a).abs() > reach {
            return 0.0;
        }
        let sides = [(a, b, c), (b, c, a), (c, a, b)];
        if let Some((at, next, last)) = sides.iter().find(|(at, ..)| at.norm() <= reach) {
            return (next - at).angle(&(last - at));
        }
        // Distance from each side, positive towards the facet.
        let inside = sides.map(|(p, q, _)| normal.cross(&(q - p)).normalize().dot(&-p));
        match inside.iter().copied().fold(f64::INFINITY, f64::min) {
            least if least > reach => TAU,
            least if least >= -reach => PI,
            _ => 0.0,
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
