//! From words to shapes and poses. Lengths of vectors and defaults have been seen to before.

use std::sync::Arc;

use super::{AxisName, MeshConfig, PlacementConfig, PolylineConfig, Scene, ShapeConfig, drawing, mesh, table};

use crate::{
    error::Result,
    geometry::Shape,
    math::{Bounds, Pose, Vector},
};

/// How far the straight lines in place of a drawing's curves may leave them, dp: a hundredth of what particles see.
const FLAT: f64 = 0.01;

/// The vector of the numbers `x`; as many as there are are taken.
pub(super) fn vector<const D: usize>(x: &[f64]) -> Vector<D> {
    Vector::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0))
}

/// The shape that `words` say.
pub(super) fn shape<const D: usize>(scene: &Scene, words: &ShapeConfig) -> Result<Shape<D>> {
    let thickness = |given: Option<f64>| given.unwrap_or(scene.boundary_layers() as f64 * scene.dp);
    let number = |axis: Option<AxisName>| axis.map_or(D - 1, |axis| axis as usize);
    let shape = match words {
        ShapeConfig::Box { size } => Shape::Box { size: vector(size) },
        ShapeConfig::Ball { radius } => Shape::Ball { radius: *radius },
        ShapeConfig::Capsule { length, radius, axis } => {
            Shape::Capsule { length: *length, radius: *radius, axis: number(*axis) }
        }
        ShapeConfig::Cylinder { length, radius, axis } => {
            Shape::Cylinder { length: *length, radius: *radius, axis: number(*axis) }
        }
        ShapeConfig::Polygon(words) => Shape::Polygon { points: points(scene, words)? },
        ShapeConfig::Polyline(words) => {
            Shape::Polyline { points: points(scene, words)?, thickness: thickness(words.thickness) }
        }
        ShapeConfig::Tank { size, thickness: given } => {
            Shape::Tank { size: vector(size), thickness: thickness(*given) }
        }
        ShapeConfig::Mesh(words) => mesh_shape(scene, words)?,
        ShapeConfig::Compound(parts) => {
            let part = |part: &super::CompoundPartConfig| {
                let inner = self::shape(scene, &part.shape)?;
                let pose = part.at.as_ref().map_or_else(Pose::identity, |at| pose(at, &inner, 0.0));
                Ok((pose, inner))
            };
            Shape::Compound(parts.iter().map(part).collect::<Result<_>>()?)
        }
    };
    shape.check()?;
    Ok(shape)
}

fn mesh_shape<const D: usize>(scene: &Scene, words: &MeshConfig) -> Result<Shape<D>> {
    let path = table::path_beside(&scene.origin.folder, &words.file)?;
    let unit = words.scale.unwrap_or(1.0) * words.unit.unwrap_or_default().metres();
    let mesh = mesh::read(&path, unit, words.flip.unwrap_or(false))?;
    Ok(Shape::Mesh { mesh: Arc::new(mesh), contact: words.contact.unwrap_or_default() })
}

fn points<const D: usize>(scene: &Scene, words: &PolylineConfig) -> Result<Vec<Vector<D>>> {
    if let Some(points) = &words.points {
        return Ok(points.iter().map(|p| vector(p)).collect());
    }
    let path = table::path_beside(&scene.origin.folder, words.file.as_deref().unwrap_or(""))?;
    if words.is_drawing() {
        let unit = words.scale.unwrap_or(1.0) * words.unit.unwrap_or_default().metres();
        let points = drawing::outline(&path, words.id.as_deref(), unit, FLAT * scene.dp)?;
        return Ok(points.iter().map(|p| vector(p)).collect());
    }
    let columns = table::read_columns(&path, &["x_m", "y_m"])?;
    Ok(columns[0].iter().zip(&columns[1]).map(|(&x, &y)| vector(&[x, y])).collect())
}

/// Where `at` puts `shape`; a draft in metres is below `level`, and one of equilibrium is left at zero.
pub(super) fn pose<const D: usize>(at: &PlacementConfig, shape: &Shape<D>, level: f64) -> Pose<D> {
    let position = vector(&[at.x.unwrap_or(0.0), at.y.unwrap_or(0.0), at.z.unwrap_or(0.0)]);
    let turn: Vec<f64> = match (&at.angle_deg, &at.turn_deg) {
        (Some(angle), _) => vec![angle.to_radians()],
        (None, Some(turn)) => turn.iter().map(|x| x.to_radians()).collect(),
        (None, None) => vec![0.0; 3],
    };
    let mut pose = Pose::rotated(position, &turn);
    let bottom = match at.draft {
        Some(super::DraftChoice::Metres(draft)) => Some(level - draft),
        Some(super::DraftChoice::Equilibrium) => Some(level),
        None => at.bottom,
    };
    if let Some(bottom) = bottom {
        pose.position[D - 1] = 0.0;
        pose.position[D - 1] = bottom - world_bounds(shape, &pose).min[D - 1];
    }
    pose
}

/// The smallest box around the posed shape, m.
pub(crate) fn world_bounds<const D: usize>(shape: &Shape<D>, pose: &Pose<D>) -> Bounds<D> {
    let extent = |i: usize, sign: f64| {
        let mut direction = Vector::<D>::zeros();
        direction[i] = sign;
        sign * pose.position[i] + support_function(shape, &(pose.rotation.transpose() * direction))
    };
    Bounds { min: Vector::from_fn(|i, _| -extent(i, -1.0)), max: Vector::from_fn(|i, _| extent(i, 1.0)) }
}

/// The support function: how far the shape reaches in the direction `n`, a unit vector of its own frame, m.
fn support_function<const D: usize>(shape: &Shape<D>, n: &Vector<D>) -> f64 {
    match shape {
        Shape::Box { size } => 0.5 * n.abs().dot(size),
        Shape::Ball { radius } => *radius,
        Shape::Capsule { length, radius, axis } => 0.5 * n[*axis].abs() * length + radius,
        Shape::Cylinder { length, radius, axis } => {
            0.5 * n[*axis].abs() * length + radius * (1.0 - n[*axis] * n[*axis]).max(0.0).sqrt()
        }
        Shape::Polygon { points } => points.iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max),
        Shape::Mesh { mesh, .. } => {
            let along = |p: &Vector<3>| (0..D).map(|i| p[i] * n[i]).sum();
            mesh.points().iter().map(along).fold(f64::NEG_INFINITY, f64::max)
        }
        Shape::Compound(parts) => parts
            .iter()
            .map(|(pose, part)| pose.position.dot(n) + support_function(part, &(pose.rotation.transpose() * n)))
            .fold(f64::NEG_INFINITY, f64::max),
        Shape::Polyline { .. } | Shape::Tank { .. } => {
            let bounds = shape.bounds();
            (0..D).map(|i| (n[i] * bounds.min[i]).max(n[i] * bounds.max[i])).sum()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_box_reaches_as_far_as_its_corner() {
        let shape = Shape::<2>::Box { size: vector(&[0.2, 0.2]) };
        let at = PlacementConfig { bottom: Some(0.5), angle_deg: Some(45.0), ..PlacementConfig::default() };
        let bounds = world_bounds(&shape, &pose(&at, &shape, 0.0));
        let half_diagonal = 0.1 * 2f64.sqrt();
        // round-off of a sine and a product: a few 1e-16
        assert!((bounds.min[1] - 0.5).abs() < 1e-15);
        assert!((bounds.max[1] - 0.5 - 2.0 * half_diagonal).abs() < 1e-15);
    }
}
