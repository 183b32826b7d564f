//! The engine in two dimensions, rapier2d; and the conversion of bodies of your own world for co-simulation.
//!
//! ```no_run
//! # use pontoon::{solid::rapier2d::{self, rapier::prelude::*}, simulation::Simulation};
//! # fn afloat(mut world: PhysicsWorld, hull: RigidBodyHandle, mut water: Simulation<2>) -> pontoon::Result<()> {
//! water.step_with(1.0, |step| {
//!     rapier2d::apply_load(&mut world.bodies[hull], &step.loads()[1]);
//!     world.integration_parameters.dt = step.dt();
//!     world.step();
//!     step.solids[1] = rapier2d::kinematics(&world.bodies[hull]);
//!     Ok(())
//! })
//! # }
//! ```
//!
//! `examples/own_world.rs` is a whole program.

/// The crate of the engine, in the version that this crate uses.
pub use rapier2d as rapier;

#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "external.rs"]
mod external;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "world.rs"]
mod world;

pub use external::{apply_load, kinematics, solid_from_body};
pub(super) use world::RapierWorld;

pub use external::set_kinematic;
use nalgebra::SMatrix;
use rapier::{
    dynamics::{IntegrationParameters, RigidBodyBuilder, RigidBodyHandle},
    geometry::{ContactData, SharedShape, TriMesh, TypedShape},
    math::{Pose as Frame, Rotation, Vector as Point},
    parry::{mass_properties::MassProperties, shape::ShapeType, transformation::hertel_mehlhorn},
    pipeline::{ActiveHooks, ContactModificationContext, PhysicsWorld},
    utils::OrthonormalBasis,
};

use crate::{
    error::{Error, Result},
    geometry::{Shape, wall::wall_parts},
    math::{Bivector, Matrix, Vector},
    solid::FreeBody,
};

const D: usize = 2;

/// The engine's type of a spin.
type Angular = f64;

/// Name and version of the engine that wrote a state.
const ENGINE: &str = "rapier2d-f64 0.36.1";

fn to_angular(wedge: &Bivector<D>) -> f64 {
    wedge.0[(1, 0)]
}

fn from_angular(angular: f64) -> Bivector<D> {
    Bivector::from_axial(&[angular])
}

fn to_rotation(matrix: &Matrix<D>) -> Rotation {
    Rotation { re: matrix[(0, 0)], im: matrix[(1, 0)] }
}

/// Returns `rotation`: in 2-D a rotation has a single form.
fn nearest_form(rotation: Rotation, _before: &Rotation) -> Rotation {
    rotation
}

fn from_rotation(rotation: &Rotation) -> Matrix<D> {
    Matrix::from_row_slice(&[rotation.re, -rotation.im, rotation.im, rotation.re])
}

/// Returns an inverse inertia as a matrix: its only component is in the first row and column.
fn inverse_inertia(inverse: &f64) -> SMatrix<f64, 3, 3> {
    SMatrix::from_fn(|i, j| if (i, j) == (0, 0) { *inverse } else { 0.0 })
}

/// Returns the mass properties in the solid's frame; in 2-D there is one moment of inertia, regardless of locks.
fn mass_properties(body: &FreeBody<D>, _start: &Matrix<D>) -> MassProperties {
    MassProperties::new(world::to_point(&body.centre), body.mass, body.inertia[(0, 0)])
}

fn lock(builder: RigidBodyBuilder, body: &FreeBody<D>) -> RigidBodyBuilder {
    let [x, y] = body.locked_translations;
    let builder = builder.enabled_translations(!x, !y);
    if body.locked_rotations[0] { builder.lock_rotations() } else { builder }
}

/// Returns the friction impulse (N s) of a contact on its first solid, on which the normal impulse acts along
/// `direction`.
fn friction(direction: Point, data: &ContactData) -> Point {
    direction.orthonormal_vector() * data.tangent_impulse[0]
}

/// Shapes whose faces are curved along the line on which they roll, besides balls.
const ROUND: &[ShapeType] = &[ShapeType::Capsule];

/// Contact hooks of every collider by default: 2-D needs no hooks.
const HOOKS: ActiveHooks = ActiveHooks::empty();

/// Does nothing: friction in 2-D has a single direction.
fn align(_context: &mut ContactModificationContext) {}

/// State of a body that turns by its angular momentum: empty, because 2-D bodies have no gyroscopic torque.
struct Turning;

fn wind(_world: &mut PhysicsWorld, _bodies: &[RigidBodyHandle], _dt: f64) -> Turning {
    Turning
}

fn unwind(
    _world: &mut PhysicsWorld,
    _bodies: &[RigidBodyHandle],
    _turning: Turning,
    _spins: &[Angular],
    _dt: f64,
) -> Vec<Option<Bivector<D>>> {
    Vec::new()
}

/// Locked translations: friction in 2-D does not depend on them.
mod translation_locks {
    use super::rapier::{
        dynamics::{LockedAxes, RigidBodyHandle, SpringCoefficients},
        pipeline::PhysicsWorld,
    };

    pub(super) fn add_joint(_world: &mut PhysicsWorld, _handle: RigidBodyHandle, _lock: SpringCoefficients<f64>) {}

    /// Bodies without their locks: none.
    pub(super) struct Freed;

    pub(super) fn free(_world: &mut PhysicsWorld, _bodies: &[RigidBodyHandle], _locks: &[LockedAxes]) -> Freed {
        Freed
    }

    pub(super) fn lock(_world: &mut PhysicsWorld, _freed: &Freed) {}
}

/// Does nothing: no parameter exists in 2-D only.
fn tune(_parameters: &mut IntegrationParameters) {}

/// Returns the rotation that turns the first axis into the direction of a vector.
fn arc(along: &Vector<D>) -> Matrix<D> {
    let [x, y] = along.normalize().into();
    Matrix::from_row_slice(&[x, -y, y, x])
}

/// Returns the inertia of mass properties, in the form that a free body stores.
fn inertia(own: &MassProperties) -> Matrix<D> {
    Matrix::from_row_slice(&[own.principal_inertia(), 0.0, 0.0, 0.0])
}

/// Returns the shape of a collider of a type that exists in 2-D only.
fn of_this_dimension(geometry: &TypedShape) -> Result<Shape<D>> {
    let points = |points: &[Point]| Shape::Polygon { points: points.iter().copied().map(world::from_point).collect() };
    match geometry {
        TypedShape::ConvexPolygon(polygon) => Ok(points(polygon.points())),
        TypedShape::Triangle(triangle) => Ok(points(&[triangle.a, triangle.b, triangle.c])),
        other => Err(external::unsupported_shape(other)),
    }
}

/// Returns the convex parts of the shapes that exist in 2-D only, in the frame of the shape.
fn parts(shape: &Shape<D>, _fixed: bool) -> Result<Vec<(Frame, SharedShape)>> {
    let convex = match shape {
        Shape::Polygon { points } => convex_parts(points),
        Shape::Polyline { points, thickness } => strip(points, *thickness),
        Shape::Cylinder { .. } => {
            return Err(Error::scene("a cylinder has no plane counterpart").help("use a box or a ball"));
        }
        _ => return Err(Error::scene("this shape has no collider in 2-D")),
    };
    let convex = convex.ok_or_else(|| {
        Error::scene("the polygon or line cannot be cut into convex parts")
            .help("its points must be distinct, and its sides must not cross")
    })?;
    Ok(convex.into_iter().map(|part| (Frame::IDENTITY, part)).collect())
}

/// Divides a simple polygon into convex polygons (ear clipping, then Hertel & Mehlhorn), which serve for contacts only.
fn convex_parts(points: &[Vector<D>]) -> Option<Vec<SharedShape>> {
    let points: Vec<Point> = points.iter().map(world::to_point).collect();
    let mesh = TriMesh::from_polygon(points)?;
    hertel_mehlhorn(mesh.vertices(), mesh.indices()).iter().map(|part| SharedShape::convex_hull(part)).collect()
}

/// Returns the convex parts of a wall.
fn strip(points: &[Vector<D>], thickness: f64) -> Option<Vec<SharedShape>> {
    let part = |corners: Vec<Vector<D>>| {
        let corners: Vec<Point> = corners.iter().map(world::to_point).collect();
        SharedShape::convex_hull(&corners)
    };
    wall_parts(points, thickness).into_iter().map(part).collect()
}
