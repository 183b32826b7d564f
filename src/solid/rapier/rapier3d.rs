//! The engine in three dimensions, rapier3d; and the conversion of bodies of your own world for co-simulation.
//!
//! ```no_run
//! # use pontoon::{solid::rapier3d::{self, rapier::prelude::*}, simulation::Simulation};
//! # fn afloat(mut world: PhysicsWorld, hull: RigidBodyHandle, mut water: Simulation<3>) -> pontoon::Result<()> {
//! water.step_with(1.0, |step| {
//!     rapier3d::apply_load(&mut world.bodies[hull], &step.loads()[1]);
//!     world.integration_parameters.dt = step.dt();
//!     world.step();
//!     step.solids[1] = rapier3d::kinematics(&world.bodies[hull]);
//!     Ok(())
//! })
//! # }
//! ```
//!
//! `examples/own_world.rs` is a whole program.

/// The crate of the engine, in the version that this crate uses.
pub use rapier3d as rapier;

#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "external.rs"]
mod external;
#[path = "translation_locks.rs"]
mod translation_locks;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "world.rs"]
mod world;

pub use external::{apply_load, kinematics, set_kinematic, solid_from_body};
pub(super) use world::RapierWorld;

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::Arc,
};

use nalgebra::SymmetricEigen;
use rapier::{
    dynamics::{FrictionModel, IntegrationParameters, LockedAxes, RigidBody, RigidBodyBuilder, RigidBodyHandle},
    geometry::{ContactData, SharedShape, TriMeshFlags, TypedShape},
    math::{AngularInertia, Matrix as Square, Pose as Frame, Rotation, Vector as Point},
    parry::{
        mass_properties::MassProperties,
        shape::ShapeType,
        transformation::vhacd::{VHACD, VHACDParameters},
    },
    pipeline::{ActiveHooks, ContactModificationContext, PhysicsWorld},
    utils::OrthonormalBasis,
};

use crate::{
    error::{Error, Result},
    geometry::{ContactGeometry, Mesh, Shape},
    math::{Bivector, Matrix, Vector, format::coordinates, rotated_tensor},
    solid::FreeBody,
};

const D: usize = 3;

/// The engine's type of a spin.
type Angular = Point;

/// Name and version of the engine that wrote a state.
const ENGINE: &str = "rapier3d-f64 0.36.1";

/// Largest ratio of the hull's volume to the mesh's volume at which the hull replaces the mesh in contacts, –.
const NEARLY_CONVEX: f64 = 1.01;

fn to_angular(wedge: &Bivector<D>) -> Point {
    Point::new(wedge.0[(2, 1)], wedge.0[(0, 2)], wedge.0[(1, 0)])
}

fn from_angular(angular: Point) -> Bivector<D> {
    Bivector::from_axial(&angular.to_array())
}

fn to_rotation(matrix: &Matrix<D>) -> Rotation {
    Rotation::from_mat3(&square(matrix)).normalize()
}

/// Returns that of both quaternions of `rotation`, q and −q, which is nearer to `before`. From the other one the engine would take
/// a step of nearly a whole turn, and a velocity to match.
fn nearest_form(rotation: Rotation, before: &Rotation) -> Rotation {
    if rotation.dot(*before) < 0.0 { -rotation } else { rotation }
}

fn from_rotation(rotation: &Rotation) -> Matrix<D> {
    Matrix::from_column_slice(&Square::from_quat(*rotation).to_cols_array())
}

/// Returns the same matrix in rapier's type; both types store columns.
fn square(matrix: &Matrix<D>) -> Square {
    Square::from_cols_array(&std::array::from_fn(|i| matrix.as_slice()[i]))
}

/// Returns an inverse inertia as a matrix.
fn inverse_inertia(inverse: &AngularInertia) -> Matrix<3> {
    let AngularInertia { m11, m12, m13, m22, m23, m33 } = *inverse;
    Matrix::from_row_slice(&[m11, m12, m13, m12, m22, m23, m13, m23, m33])
}

/// Returns the mass properties in the solid's frame. If a rotation is locked, the function drops the products of
/// inertia about the world's axes at the start: rapier would turn them into spurious rates of the free axes.
///
/// The principal axes are nalgebra's. Those of the engine are wrong where the two smaller moments are equal, as of a disc.
fn mass_properties(body: &FreeBody<D>, start: &Matrix<D>) -> MassProperties {
    let inertia = if body.locked_rotations.contains(&true) {
        let world = rotated_tensor(start, &body.inertia);
        rotated_tensor(&start.transpose(), &Matrix::from_diagonal(&world.diagonal()))
    } else {
        body.inertia
    };
    let principal = SymmetricEigen::new(inertia);
    let mut axes = principal.eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(0).neg_mut();
    }
    let moments = Point::from_array(principal.eigenvalues.map(|moment| moment.max(0.0)).into());
    let centre = world::to_point(&body.centre);
    MassProperties::with_principal_inertia_frame(centre, body.mass, moments, to_rotation(&axes))
}

/// Applies the locks of a body. This crate computes the gyroscopic torque, not rapier.
fn lock(builder: RigidBodyBuilder, body: &FreeBody<D>) -> RigidBodyBuilder {
    let ([x, y, z], [about_x, about_y, about_z]) = (body.locked_translations, body.locked_rotations);
    builder
        .enabled_translations(!x, !y, !z)
        .enabled_rotations(!about_x, !about_y, !about_z)
        .gyroscopic_forces_enabled(false)
}

/// Returns the friction impulse (N s) of a contact on its first solid, on which the normal impulse acts along
/// `direction`.
fn friction(direction: Point, data: &ContactData) -> Point {
    let tangent = direction.orthonormal_vector();
    tangent * data.tangent_impulse[0] + direction.cross(tangent) * data.tangent_impulse[1]
}

/// Shapes whose faces are curved along the line on which they roll, besides balls.
const ROUND: &[ShapeType] = &[ShapeType::Capsule, ShapeType::Cylinder];

/// Contact hooks that every collider has by default: this module corrects the direction of friction.
const HOOKS: ActiveHooks = ActiveHooks::MODIFY_SOLVER_CONTACTS;

/// Makes the friction of a contact act against the sliding velocity v. The engine subtracts K⁻¹ v from the impulse and
/// limits the result to μ N. The matrix K maps impulses in the contact plane to velocities there. Friction then acts
/// along K⁻¹ v instead of v where K is not isotropic, as at the corner of a box. With a belt velocity of K v/k̄ − v,
/// where k̄ is the mean of K, the engine subtracts v/k̄. v is the velocity after the last step; it is zero at a
/// sticking contact, so that the belt moves no body there.
fn align(context: &mut ContactModificationContext) {
    let bodies = context.bodies;
    let pair = [context.rigid_body1, context.rigid_body2].map(|body| body.and_then(|body| bodies.get(body)));
    let ([Some(first), Some(second)], Some(contact)) = (pair, context.rigid_mut()) else { return };
    let normal = *contact.normal;
    let tangent = normal.orthonormal_vector();
    let within = |x: Point| x - normal * normal.dot(x);
    for point in contact.solver_contacts.iter_mut() {
        let data = &contact.manifold.points[point.contact_indices()[0] as usize].data;
        let arms = [data.solver_dp1, data.solver_dp2];
        let gives = |impulse| within(gained(first, arms[0], impulse) + gained(second, arms[1], impulse));
        let mean = 0.5 * (tangent.dot(gives(tangent)) + normal.cross(tangent).dot(gives(normal.cross(tangent))));
        // Friction may stop a point that has only now come into contact at once.
        if data.warmstart_impulse > 0.0 && mean > 0.0 {
            let velocity = |body: &RigidBody, arm| body.linvel() + body.angvel().cross(arm);
            let sliding = within(velocity(first, arms[0]) - velocity(second, arms[1]));
            point.tangent_velocity = gives(sliding) / mean - sliding;
        }
    }
}

/// Returns the velocity (m/s) that an impulse (N s) on a body causes at its point of action, at `arm` (m) from the
/// centre.
fn gained(body: &RigidBody, arm: Point, impulse: Point) -> Point {
    let mass = body.mass_properties();
    mass.effective_inv_mass * impulse + (mass.effective_world_inv_inertia * arm.cross(impulse)).cross(arm)
}

/// The way in which a free body turns in a step.
enum Turning {
    /// By its angular momentum, kg m²/s. `spin` is that of the rotation, `axes` the principal axes before the step.
    Loose { momentum: Point, spin: Point, axes: Rotation },
    /// By its spin. `inertia` (kg m²) is along the world's axes before the step, and zero about locked axes. `torque` is
    /// gyroscopic, N m.
    Bound { inertia: Matrix<D>, torque: Point },
}

/// Prepares the rotation of each body for the step. A body that turns freely gets its spin in the middle of the step
/// from Euler's equations, I ω̇ = −ω ∧ I ω. A body in a joint or with a lock, whose spin the engine constrains, gets
/// its gyroscopic torque over the step.
fn wind(world: &mut PhysicsWorld, bodies: &[RigidBodyHandle], dt: f64) -> Vec<Option<Turning>> {
    let PhysicsWorld { bodies: all, impulse_joints, .. } = world;
    let one = |&handle: &RigidBodyHandle| {
        let body = all.get_mut(handle).filter(|body| body.is_dynamic() && body.is_enabled())?;
        let is_joined = impulse_joints.attached_joints(handle).any(|(.., joint)| joint.data.is_enabled());
        if !body.locked_axes().is_empty() || is_joined {
            let inertia = about_unlocked(&inverse_inertia(&body.mass_properties().effective_world_inv_inertia));
            let torque = gyroscopic(body, dt);
            body.add_torque(torque, false);
            return Some(Turning::Bound { inertia, torque });
        }
        let own = &body.mass_properties().local_mprops;
        let (axes, inertia) = (*body.rotation() * own.principal_inertia_local_frame, own.principal_inertia());
        let spin = axes.inverse() * body.angvel();
        let momentum = inertia * spin;
        let middle = axes * (spin - 0.5 * dt * (spin.cross(momentum) / inertia));
        body.set_angvel(middle, false);
        Some(Turning::Loose { momentum: axes * momentum, spin: middle, axes })
    };
    bodies.iter().map(one).collect()
}

/// Returns the inertia from its inverse; components about locked axes are 0 in both.
fn about_unlocked(inverse: &Matrix<D>) -> Matrix<D> {
    let locked = Matrix::from_diagonal(&inverse.diagonal().map(|x| if x == 0.0 { 1.0 } else { 0.0 }));
    (inverse + locked).try_inverse().map_or_else(Matrix::zeros, |inertia| inertia - locked)
}

/// Returns the gyroscopic torque (N m) on a body in a step: −ω ∧ I ω at the spin after the loads of the step, limited
/// so that the magnitude of I ω stays constant. rapier uses the same formula, but applies the torque in each iteration
/// and does not report it. Returns zero if a rotation is locked.
fn gyroscopic(body: &RigidBody, dt: f64) -> Point {
    let (all, own) = (body.mass_properties(), &body.mass_properties().local_mprops);
    let axes = *body.rotation() * own.principal_inertia_local_frame;
    let loaded = body.angvel() + dt * (all.effective_world_inv_inertia * body.user_torque());
    let spin = axes.inverse() * loaded;
    let momentum = own.principal_inertia() * spin;
    let turned = momentum - dt * spin.cross(momentum);
    if turned == Point::ZERO || body.locked_axes().intersects(LockedAxes::ROTATION_LOCKED) {
        return Point::ZERO;
    }
    axes * ((turned * (momentum.length() / turned.length()) - momentum) / dt)
}

/// Adds the angular impulse of each freely turning body in the step to its angular momentum, and sets the spin that
/// results. Returns I(R₀) ΔΩ/Δt less the gyroscopic torque (N m) of the constrained bodies, whose spins before the step
/// are `spins`.
fn unwind(
    world: &mut PhysicsWorld,
    bodies: &[RigidBodyHandle],
    turnings: Vec<Option<Turning>>,
    spins: &[Angular],
    dt: f64,
) -> Vec<Option<Bivector<D>>> {
    let one = |((&handle, turning), before): ((&RigidBodyHandle, Option<Turning>), &Angular)| {
        let body = world.bodies.get_mut(handle)?;
        match turning? {
            Turning::Loose { momentum, spin, axes } => {
                let own = &body.mass_properties().local_mprops;
                let (now, inertia) = (*body.rotation() * own.principal_inertia_local_frame, own.principal_inertia());
                let impulse = axes * (inertia * (axes.inverse() * (body.angvel() - spin)));
                let spin = now * ((now.inverse() * (momentum + impulse)) / inertia);
                body.set_angvel(spin, false);
                None
            }
            Turning::Bound { inertia, torque } => {
                let turned = inertia * world::from_point(body.angvel() - *before) / dt - world::from_point(torque);
                Some(Bivector::from_axial(turned.as_slice()))
            }
        }
    };
    bodies.iter().zip(turnings).zip(spins).map(one).collect()
}

/// Sets the parameters that exist in 3-D only: Coulomb's law at every contact point.
fn tune(parameters: &mut IntegrationParameters) {
    parameters.friction_model = FrictionModel::Coulomb;
}

/// Returns the rotation that turns the first axis into the direction of a vector.
fn arc(along: &Vector<D>) -> Matrix<D> {
    from_rotation(&Rotation::from_rotation_arc(Point::X, world::to_point(&along.normalize())))
}

/// Returns the inertia of mass properties, in the form that a free body stores.
fn inertia(own: &MassProperties) -> Matrix<D> {
    Matrix::from_column_slice(&own.reconstruct_inertia_matrix().to_cols_array())
}

/// Returns the shape of a collider of a type that exists in 3-D only.
fn of_this_dimension(geometry: &TypedShape) -> Result<Shape<D>> {
    let mesh = |points: &[Point], facets: &[[u32; 3]]| {
        let points: Vec<Vector<D>> = points.iter().copied().map(world::from_point).collect();
        Ok(Shape::Mesh { mesh: Arc::new(Mesh::new(&points, facets)?), contact: ContactGeometry::None })
    };
    match geometry {
        TypedShape::Cylinder(c) => Ok(Shape::Cylinder { length: 2.0 * c.half_height, radius: c.radius, axis: 1 }),
        TypedShape::TriMesh(surface) => mesh(surface.vertices(), surface.indices()),
        TypedShape::ConvexPolyhedron(hull) => {
            let (points, facets) = hull.to_trimesh();
            mesh(&points, &facets)
        }
        other => Err(external::unsupported_shape(other)),
    }
}

/// Returns the parts of the shapes that exist in 3-D only, in the frame of the shape.
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

/// Returns the parts of a mesh that other bodies touch.
fn mesh_parts(mesh: &Mesh, contact: ContactGeometry, fixed: bool) -> Result<Vec<(Frame, SharedShape)>> {
    let points: Vec<Point> = mesh.points().iter().map(world::to_point).collect();
    let solid = mesh.volume_properties().volume;
    let hull = || SharedShape::convex_hull(&points).map(|part| vec![(Frame::IDENTITY, part)]);
    let convex = |hull: &[(Frame, SharedShape)]| {
        hull.iter().map(|(_, part)| part.mass_properties(1.0).mass()).sum::<f64>() <= NEARLY_CONVEX * solid
    };
    let make = || match contact {
        ContactGeometry::None => Some(Vec::new()),
        ContactGeometry::Surface => surface(&points, mesh),
        ContactGeometry::Fitting if fixed => surface(&points, mesh),
        ContactGeometry::Hull => hull(),
        ContactGeometry::Fitting => hull().filter(|hull| convex(hull)).or_else(|| cut(&points, mesh)),
        ContactGeometry::Decomposition => cut(&points, mesh),
    };
    // parry panics if the points lie nearly in a plane.
    catch_unwind(AssertUnwindSafe(make)).ok().flatten().ok_or_else(|| {
        let size = coordinates(mesh.bounds().size().as_slice());
        Error::scene(format!("contacts need convex parts of the mesh, and parry finds none: its size is {size} m"))
            .help(
                "make it less slender, or correct its size; for a mesh from a file that nothing is to touch, write  \
                 contact = \"none\"  beside the file's name",
            )
    })
}

/// Returns every facet of the mesh, with smooth contact normals across their edges.
fn surface(points: &[Point], mesh: &Mesh) -> Option<Vec<(Frame, SharedShape)>> {
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    let all = SharedShape::trimesh_with_flags(points.to_vec(), mesh.facets().to_vec(), flags).ok()?;
    Some(vec![(Frame::IDENTITY, all)])
}

/// Returns convex parts (V-HACD), each the hull of the surface inside it.
fn cut(points: &[Point], mesh: &Mesh) -> Option<Vec<(Frame, SharedShape)>> {
    let parts = VHACD::decompose(&VHACDParameters::default(), points, mesh.facets(), true);
    let corners = parts.voxel_parts().iter().map(|part| part.compute_primitive_intersections(points, mesh.facets()));
    let hulls: Vec<_> = corners.filter_map(|part| SharedShape::convex_hull(&part)).collect();
    (!hulls.is_empty()).then(|| hulls.into_iter().map(|part| (Frame::IDENTITY, part)).collect())
}
