//! The engine in three dimensions: rapier3d, and what only space has.

use rapier3d as rapier;

#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "world.rs"]
mod world;

pub(super) use world::World;

use rapier::{
    dynamics::{FrictionModel, IntegrationParameters, RigidBodyBuilder},
    geometry::SharedShape,
    math::{AngularInertia, Matrix as Square, Pose as Frame, Rotation, Vector as Point},
    parry::mass_properties::MassProperties,
};

use crate::{
    error::{Error, Result},
    shape::Shape,
    solid::FreeBody,
    space::{Matrix, Wedge},
};

const D: usize = 3;

/// Names the engine that wrote a state.
const ENGINE: &str = "rapier3d-f64 0.36.1";

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

/// Settings that only this dimension has: Coulomb's law at every contact point.
fn tune(parameters: &mut IntegrationParameters) {
    parameters.friction_model = FrictionModel::Coulomb;
}

/// Parts of the shapes that only space has, in the shape's frame.
fn parts(shape: &Shape<D>) -> Result<Vec<(Frame, SharedShape)>> {
    match shape {
        Shape::Cylinder { length, radius, axis } => {
            let turn = Rotation::from_rotation_arc(Point::Y, Point::AXES[*axis]);
            Ok(vec![(Frame::from_rotation(turn), SharedShape::cylinder(0.5 * length, *radius))])
        }
        _ => Err(Error::scene("polygons and polylines are shapes of the plane")
            .help("use a box, ball, capsule, cylinder, tank or a compound of these in 3-D")),
    }
}
