//! Shapes that become meshes within a hundredth of dp of their surfaces: ellipsoid, cone, frustum, wedge, prism, torus. In 2-D
//! an ellipsoid is an ellipse and a wedge a triangle; both become polygons.

use std::{f64::consts::TAU, sync::Arc};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    outline::{outline_points, verify_outline},
    shape::AxisName,
};
use crate::{
    error::Result,
    geometry::{ContactGeometry, Mesh, Shape, solids_of_revolution as solids},
    math::Vector,
    scene::{
        context::{Context, Defaults},
        untagged::{LengthUnit, PolylineConfig},
    },
};

/// Largest distance of facets and chords from curved surfaces, dp.
const TOLERANCE: f64 = 0.01;

/// An ellipsoid around its centre; in 2-D an ellipse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct EllipsoidConfig {
    /// Half axes, m: one number an axis.
    pub radii: Vec<f64>,
}

/// A circular cone, centred on half its length, with its tip in the positive direction of its axis; 3-D only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ConeConfig {
    /// Radius of the base, m.
    pub radius: f64,
    /// Length from base to tip, m.
    pub length: f64,
    /// Direction of its axis; by default upright.
    pub axis: Option<AxisName>,
}

/// The frustum of a circular cone, centred on half its length; 3-D only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct FrustumConfig {
    /// Radius at the lower end of its axis, m; 0 for a tip.
    pub radius_bottom: f64,
    /// Radius at the upper end of its axis, m; 0 for a tip.
    pub radius_top: f64,
    /// Length, m.
    pub length: f64,
    /// Direction of its axis; by default upright.
    pub axis: Option<AxisName>,
}

/// A ramp: the lower half of a box, cut from the lower edge at −x to the upper edge at +x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct WedgeConfig {
    /// Edge lengths of the box, m; its centre is the origin.
    pub size: Vec<f64>,
}

/// A prism over an outline, centred on half its length; 3-D only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct PrismConfig {
    /// Points of the outline, m, along the two other axes in their order.
    pub points: Option<Vec<Vec<f64>>>,
    /// A table of points, or a drawing (.svg), beside the scene.
    pub file: Option<String>,
    /// The outline's id in the drawing.
    pub id: Option<String>,
    /// Factor on the drawing's lengths, –; by default 1.
    pub scale: Option<f64>,
    /// Unit of the drawing's lengths; by default m.
    pub unit: Option<LengthUnit>,
    /// Length along the axis, m.
    pub length: f64,
    /// Direction of its edges; by default upright.
    pub axis: Option<AxisName>,
}

impl PrismConfig {
    /// Its outline as a polygon.
    pub(crate) fn outline(&self) -> PolylineConfig {
        let Self { points, file, id, scale, unit, .. } = self.clone();
        PolylineConfig { points, file, id, scale, unit, thickness: None, closed: None }
    }
}

/// A torus around its centre; 3-D only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct TorusConfig {
    /// Radius of the centre line of its tube, m.
    pub radius: f64,
    /// Radius of its tube, m; less than `radius`.
    pub tube_radius: f64,
    /// Direction of its axis; by default upright.
    pub axis: Option<AxisName>,
}

/// A shape that becomes a mesh.
pub(super) enum MeshedShape<'a> {
    Ellipsoid(&'a EllipsoidConfig),
    Cone(&'a ConeConfig),
    Frustum(&'a FrustumConfig),
    Wedge(&'a WedgeConfig),
    Prism(&'a PrismConfig),
    Torus(&'a TorusConfig),
}

impl MeshedShape<'_> {
    /// Its name in a scene.
    fn name(&self) -> &'static str {
        match self {
            Self::Ellipsoid(_) => "ellipsoid",
            Self::Cone(_) => "cone",
            Self::Frustum(_) => "frustum",
            Self::Wedge(_) => "wedge",
            Self::Prism(_) => "prism",
            Self::Torus(_) => "torus",
        }
    }

    /// Refuses a shape that has no meaning in the scene's dimension, or whose lengths are not lengths.
    pub(super) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        let name = self.name();
        if ctx.dimension == 2 && !matches!(self, Self::Ellipsoid(_) | Self::Wedge(_)) {
            let what = format!("a {name} needs a 3-D scene, and this one is 2-D");
            let help = "in 2-D an outline is a polygon:  shape = { polygon = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]] }";
            return Err(ctx.error_with_help(key, what, help));
        }
        let key = format!("{key}.{name}");
        let positive = |word: &str, x: f64| ctx.require_positive(&format!("{key}.{word}"), Some(x));
        let list = |word: &str, list: &[f64]| {
            ctx.require_dimension(&format!("{key}.{word}"), list)?;
            list.iter().try_for_each(|x| positive(word, *x))
        };
        match self {
            Self::Ellipsoid(own) => list("radii", &own.radii),
            Self::Wedge(own) => list("size", &own.size),
            Self::Cone(own) => positive("radius", own.radius).and(positive("length", own.length)),
            Self::Frustum(own) => {
                let (bottom, top) = (own.radius_bottom, own.radius_top);
                // One end may be a tip.
                if bottom != 0.0 || top == 0.0 {
                    positive("radius_bottom", bottom)?;
                }
                if top != 0.0 {
                    positive("radius_top", top)?;
                }
                positive("length", own.length)
            }
            Self::Prism(own) => {
                positive("length", own.length)?;
                verify_outline(ctx, &key, &own.outline())
            }
            Self::Torus(own) => {
                positive("radius", own.radius)?;
                positive("tube_radius", own.tube_radius)?;
                if own.tube_radius < own.radius {
                    return Ok(());
                }
                let what = format!(
                    "a tube of radius {} around a circle of radius {} meets itself",
                    own.tube_radius, own.radius
                );
                Err(ctx.error_with_help(&format!("{key}.tube_radius"), what, "make tube_radius less than radius"))
            }
        }
    }

    /// The shape.
    pub(super) fn build<const D: usize>(&self, ctx: &Context) -> Result<Shape<D>> {
        let tolerance = TOLERANCE * ctx.dp;
        let axis = |axis: Option<AxisName>| axis.map_or(2, |axis| axis as usize);
        let mesh = match self {
            Self::Ellipsoid(own) if D == 2 => return Ok(Shape::Polygon { points: ellipse(&own.radii, tolerance) }),
            Self::Wedge(own) if D == 2 => return Ok(Shape::Polygon { points: triangle(&own.size) }),
            Self::Ellipsoid(own) => solids::ellipsoid(Vector::from_fn(|i, _| own.radii[i]), tolerance)?,
            Self::Cone(own) => solids::frustum(own.radius, 0.0, own.length, axis(own.axis), tolerance)?,
            Self::Frustum(own) => {
                solids::frustum(own.radius_bottom, own.radius_top, own.length, axis(own.axis), tolerance)?
            }
            Self::Wedge(own) => {
                let section: Vec<[f64; 2]> =
                    triangle::<2>(&[own.size[0], own.size[2]]).iter().map(|p| [p[0], p[1]]).collect();
                solids::prism(&section, own.size[1], 1)?
            }
            Self::Prism(own) => {
                let points = outline_points::<2>(ctx, &own.outline()).map_err(|e| e.in_part("prism"))?;
                let outline: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
                solids::prism(&outline, own.length, axis(own.axis))?
            }
            Self::Torus(own) => solids::torus(own.radius, own.tube_radius, axis(own.axis), tolerance)?,
        };
        Ok(meshed(mesh))
    }
}

fn meshed<const D: usize>(mesh: Mesh) -> Shape<D> {
    Shape::Mesh { mesh: Arc::new(mesh), contact: ContactGeometry::Fitting }
}

/// The polygon of the ellipse's area, whose sides lie within `tolerance` (m) of it.
fn ellipse<const D: usize>(radii: &[f64], tolerance: f64) -> Vec<Vector<D>> {
    let n = solids::segments(radii[0].max(radii[1]), tolerance);
    let (angle, equal_area) = (TAU / n as f64, solids::equal_area(n));
    let point = |k: usize| {
        let (sin, cos) = (k as f64 * angle).sin_cos();
        Vector::from_fn(|i, _| equal_area * radii[i] * if i == 0 { cos } else { sin })
    };
    (0..n).map(point).collect()
}

/// The lower triangle of the box of edge lengths `size` (m) that rises towards +x.
fn triangle<const D: usize>(size: &[f64]) -> Vec<Vector<D>> {
    [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5]].map(|p| Vector::from_fn(|i, _| p[i] * size[i])).to_vec()
}

/// Fills in the defaults of the shape at `key`.
pub(super) fn fill_axis(defaults: &mut Defaults, key: &str, axis: &mut Option<AxisName>) {
    defaults.fill(format!("{key}.axis"), axis, AxisName::Z, "upright");
}
