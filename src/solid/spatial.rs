//! The engine in three dimensions, rapier3d; what of it is yours: bodies of a world of your own, in a hosted simulation.
//!
//! ```no_run
//! # use pontoon::{solid::spatial::{self, rapier::prelude::*}, simulation::Simulation};
//! # fn afloat(mut world: PhysicsWorld, hull: RigidBodyHandle, mut water: Simulation<3>) -> pontoon::Result<()> {
//! water.step_with(1.0, |handover| {
//!     spatial::give(&mut world.bodies[hull], &handover.loads()[1]);
//!     world.integration_parameters.dt = handover.dt();
//!     world.step();
//!     handover.solids[1] = spatial::kinematics(&world.bodies[hull]);
//!     Ok(())
//! })
//! # }
//! ```
//!
//! `examples/own_world.rs` is a whole program.

/// The engine itself, in the version that this crate is made with.
pub use rapier3d as rapier;

#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "own.rs"]
mod own;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "world.rs"]
mod world;

pub use own::{follow, give, kinematics, solid};
pub(super) use world::World;

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::Arc,
};

use rapier::{
    dynamics::{FrictionModel, IntegrationParameters, RigidBodyBuilder, RigidBodyHandle},
    geometry::{ContactData, SharedShape, TriMeshFlags, TypedShape},
    math::{AngularInertia, Matrix as Square, Pose as Frame, Rotation, Vector as Point},
    parry::{
        mass_properties::MassProperties,
        transformation::vhacd::{VHACD, VHACDParameters},
    },
    pipeline::PhysicsWorld,
    utils::OrthonormalBasis,
};

use crate::{
    error::{Error, Result},
    shape::{Mesh, Shape, Touchable},
    solid::FreeBody,
    space::{Matrix, Vector, Wedge},
};

const D: usize = 3;

/// A spin in the engine's terms.
type Angular = Point;

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

/// An inverse inertia as a matrix.
fn inverse_inertia(inverse: &AngularInertia) -> Matrix<3> {
    let AngularInertia { m11, m12, m13, m22, m23, m33 } = *inverse;
    Matrix::from_row_slice(&[m11, m12, m13, m12, m22, m23, m13, m23, m33])
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

/// Friction impulse (N s) of a contact on its first solid, which is pushed along `direction`.
fn friction(direction: Point, data: &ContactData) -> Point {
    let tangent = direction.orthonormal_vector();
    tangent * data.tangent_impulse[0] + direction.cross(tangent) * data.tangent_impulse[1]
}

/// A body that turns about three axes: its angular momentum (kg m²/s) and spin (rad/s) before a step, and its principal axes then.
struct Tumbling {
    body: RigidBodyHandle,
    momentum: Point,
    spin: Point,
    axes: Rotation,
}

/// Gives each body that turns as it likes the spin that it has in the middle of the step by Euler's equations, I ω̇ = −ω ∧ I ω, to turn
/// by: rapier's own gyroscopic torque acts once a step and loses energy with Δt. Bodies in joints keep that.
fn wind(world: &mut PhysicsWorld, dt: f64) -> Vec<Tumbling> {
    let mut all = Vec::new();
    for (handle, body) in world.bodies.iter_mut() {
        let tied = world.impulse_joints.attached_joints(handle).next().is_some();
        if !(body.is_dynamic() && body.is_enabled() && body.locked_axes().is_empty()) || tied {
            continue;
        }
        body.enable_gyroscopic_forces(false);
        let own = &body.mass_properties().local_mprops;
        let (axes, inertia) = (*body.rotation() * own.principal_inertia_local_frame, own.principal_inertia());
        let spin = axes.inverse() * body.angvel();
        let momentum = inertia * spin;
        let middle = axes * (spin - 0.5 * dt * (spin.cross(momentum) / inertia));
        all.push(Tumbling { body: handle, momentum: axes * momentum, spin: middle, axes });
        body.set_angvel(middle, false);
    }
    all
}

/// Adds the angular impulse that each of them got in the step to its angular momentum, and gives it the spin that this is now.
fn unwind(world: &mut PhysicsWorld, tumbling: Vec<Tumbling>) {
    for Tumbling { body, momentum, spin, axes } in tumbling {
        let Some(body) = world.bodies.get_mut(body) else { continue };
        let own = &body.mass_properties().local_mprops;
        let (now, inertia) = (*body.rotation() * own.principal_inertia_local_frame, own.principal_inertia());
        let impulse = axes * (inertia * (axes.inverse() * (body.angvel() - spin)));
        let spin = now * ((now.inverse() * (momentum + impulse)) / inertia);
        body.set_angvel(spin, false);
    }
}

/// Settings that only this dimension has: Coulomb's law at every contact point.
fn tune(parameters: &mut IntegrationParameters) {
    parameters.friction_model = FrictionModel::Coulomb;
}

/// The turn that takes the first axis along a vector.
fn arc(along: &Vector<D>) -> Matrix<D> {
    from_rotation(&Rotation::from_rotation_arc(Point::X, world::to_point(&along.normalize())))
}

/// The inertia of mass properties, as a free body has it.
fn inertia(own: &MassProperties) -> Matrix<D> {
    Matrix::from_column_slice(&own.reconstruct_inertia_matrix().to_cols_array())
}

/// The shape of a collider that only space has.
fn of_this_dimension(geometry: &TypedShape) -> Result<Shape<D>> {
    let mesh = |points: &[Point], facets: &[[u32; 3]]| {
        let points: Vec<Vector<D>> = points.iter().copied().map(world::from_point).collect();
        Ok(Shape::Mesh { mesh: Arc::new(Mesh::new(&points, facets)?), contact: Touchable::None })
    };
    match geometry {
        TypedShape::Cylinder(c) => Ok(Shape::Cylinder { length: 2.0 * c.half_height, radius: c.radius, axis: 1 }),
        TypedShape::TriMesh(surface) => mesh(surface.vertices(), surface.indices()),
        TypedShape::ConvexPolyhedron(hull) => {
            let (points, facets) = hull.to_trimesh();
            mesh(&points, &facets)
        }
        other => Err(own::unfelt(other)),
    }
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
fn mesh_parts(mesh: &Mesh, contact: Touchable, fixed: bool) -> Result<Vec<(Frame, SharedShape)>> {
    let points: Vec<Point> = mesh.points().iter().map(world::to_point).collect();
    let solid = mesh.volume().volume;
    let hull = || SharedShape::convex_hull(&points).map(|part| vec![(Frame::IDENTITY, part)]);
    let convex = |hull: &[(Frame, SharedShape)]| {
        hull.iter().map(|(_, part)| part.mass_properties(1.0).mass()).sum::<f64>() <= NEARLY_CONVEX * solid
    };
    let make = || match contact {
        Touchable::None => Some(Vec::new()),
        Touchable::Surface => surface(&points, mesh),
        Touchable::Fitting if fixed => surface(&points, mesh),
        Touchable::Hull => hull(),
        Touchable::Fitting => hull().filter(|hull| convex(hull)).or_else(|| cut(&points, mesh)),
        Touchable::Decomposition => cut(&points, mesh),
    };
    // parry asserts what it hopes of points that lie nearly in a plane.
    catch_unwind(AssertUnwindSafe(make)).ok().flatten().ok_or_else(|| {
        Error::scene("the mesh cannot be made touchable: parry finds no hull or parts of it")
            .help("write  contact = \"none\"  beside the file's name if nothing is to touch it, or thin the mesh out")
    })
}

/// Every facet, smooth across their edges.
fn surface(points: &[Point], mesh: &Mesh) -> Option<Vec<(Frame, SharedShape)>> {
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    let all = SharedShape::trimesh_with_flags(points.to_vec(), mesh.facets().to_vec(), flags).ok()?;
    Some(vec![(Frame::IDENTITY, all)])
}

/// Convex parts (V-HACD), each the hull of the surface that it holds.
fn cut(points: &[Point], mesh: &Mesh) -> Option<Vec<(Frame, SharedShape)>> {
    let parts = VHACD::decompose(&VHACDParameters::default(), points, mesh.facets(), true);
    let corners = parts.voxel_parts().iter().map(|part| part.compute_primitive_intersections(points, mesh.facets()));
    let hulls: Vec<_> = corners.filter_map(|part| SharedShape::convex_hull(&part)).collect();
    (!hulls.is_empty()).then(|| hulls.into_iter().map(|part| (Frame::IDENTITY, part)).collect())
}
