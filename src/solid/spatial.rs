//! The engine in three dimensions: rapier3d, and what only space has.

use rapier3d as rapier;

#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "world.rs"]
mod world;

pub(super) use world::World;

use rapier::{
    dynamics::{FrictionModel, IntegrationParameters, RigidBodyBuilder},
    geometry::{SharedShape, TriMeshFlags},
    math::{Matrix as Square, Pose as Frame, Rotation, Vector as Point},
    parry::{mass_properties::MassProperties, transformation::vhacd::VHACDParameters},
};

use crate::{
    error::{Error, Result},
    shape::{Contact, Mesh, Shape},
    solid::FreeBody,
    space::{Matrix, Wedge},
};

const D: usize = 3;

/// Names the engine that wrote a state.
const ENGINE: &str = "rapier3d-f64 0.36.1";

/// Up to so much of a mesh's volume its hull stands for it in contacts, –.
const NEARLY_CONVEX: f64 = 1.01;

fn to_angular(wedge: &Wedge<D>) -> Point {
    Point::new(wedge.0[(2, 1)], wedge.0[(0, 2)], wedge.0[(1, 0)])
}

fn from_angular(angular: Point) -> Wedge<D> {
    Wedge::from_axial(&angular.to_array())
}

fn to_rotation(matrix: &Matrix<D>) -> Rotation {
    Rotation::from_mat3(&square(matrix)).normalize()
}

fn from_rotation(rotation: &Rotation) -> Matrix<D> {
    Matrix::from_column_slice(&Square::from_quat(*rotation).to_cols_array())
}

/// The same matrix in rapier's type; both store columns.
fn square(matrix: &Matrix<D>) -> Square {
    Square::from_cols_array(&std::array::from_fn(|i| matrix.as_slice()[i]))
}

/// Mass properties in the solid's frame. With a rotation locked, the products of inertia about the world's
/// axes at the start are dropped: rapier would turn them into spurious rates of the free axes.
fn mass_properties(body: &FreeBody<D>, start: &Matrix<D>) -> MassProperties {
    let inertia = if body.locked_rotations.contains(&true) {
        let world = start * body.inertia * start.transpose();
        start.transpose() * Matrix::from_diagonal(&world.diagonal()) * start
    } else {
        body.inertia
    };
    MassProperties::with_inertia_matrix(world::to_point(&body.centre), body.mass, square(&inertia))
}

/// Locks what is locked; a body that may turn any way gets its gyroscopic torque.
fn lock(builder: RigidBodyBuilder, body: &FreeBody<D>) -> RigidBodyBuilder {
    let ([x, y, z], [about_x, about_y, about_z]) = (body.locked_translations, body.locked_rotations);
    builder
        .enabled_translations(!x, !y, !z)
        .enabled_rotations(!about_x, !about_y, !about_z)
        .gyroscopic_forces_enabled(!(about_x || about_y || about_z))
}

/// Settings that only this dimension has: Coulomb's law at every contact point.
fn tune(parameters: &mut IntegrationParameters) {
    parameters.friction_model = FrictionModel::Coulomb;
}

/// Parts of the shapes that only space has, in the shape's frame.
fn parts(shape: &Shape<D>, fixed: bool) -> Result<Vec<(Frame, SharedShape)>> {
    match shape {
        Shape::Cylinder { length, radius, axis } => {
            let turn = Rotation::from_rotation_arc(Point::Y, Point::AXES[*axis]);
            Ok(vec![(Frame::from_rotation(turn), SharedShape::cylinder(0.5 * length, *radius))])
        }
        Shape::Mesh { mesh, contact } => mesh_parts(mesh, *contact, fixed),
        _ => Err(Error::scene("polygons and polylines are shapes of the plane")
            .help("use a box, ball, capsule, cylinder, tank, mesh or a compound of these in 3-D")),
    }
}

/// What other bodies touch of a mesh.
fn mesh_parts(mesh: &Mesh, contact: Contact, fixed: bool) -> Result<Vec<(Frame, SharedShape)>> {
    let points: Vec<Point> = mesh.points().iter().map(world::to_point).collect();
    let facets = mesh.facets();
    let no_parts = |why: &dyn std::fmt::Display| {
        Error::scene(format!("the mesh cannot be made touchable: {why}"))
            .help("write  contact = \"none\"  beside the file's name if nothing is to touch it, or thin the mesh out")
    };
    let hull = || SharedShape::convex_hull(&points).ok_or_else(|| no_parts(&"it has no convex hull"));
    let alone = |part: SharedShape| vec![(Frame::IDENTITY, part)];
    match contact {
        Contact::None => Ok(Vec::new()),
        Contact::Surface | Contact::Fitting if fixed || contact == Contact::Surface => {
            SharedShape::trimesh_with_flags(points, facets.to_vec(), TriMeshFlags::FIX_INTERNAL_EDGES)
                .map(alone)
                .map_err(|why| no_parts(&why))
        }
        Contact::Hull => hull().map(alone),
        Contact::Fitting if hull()?.mass_properties(1.0).mass() <= NEARLY_CONVEX * mesh.volume().volume => {
            hull().map(alone)
        }
        Contact::Surface | Contact::Fitting | Contact::Decomposition => {
            let parts = SharedShape::convex_decomposition_with_params(&points, facets, &VHACDParameters::default());
            let parts: Vec<_> = parts.as_compound().map_or_else(Vec::new, |all| all.shapes().to_vec());
            if parts.is_empty() { Err(no_parts(&"no convex part was found")) } else { Ok(parts) }
        }
    }
}
