//! Shapes of solids and of bodies of water, and their places.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    meshed_shape::{
        ConeConfig, EllipsoidConfig, FrustumConfig, MeshedShape, PrismConfig, TorusConfig, WedgeConfig, fill_axis,
    },
    outline::{polygon_points, verify_drawing, verify_line, wall_points},
};
use crate::{
    error::Result,
    geometry::{ContactGeometry, Shape, mesh::Completion, world_bounds},
    math::{Pose, Vector},
    scene::{
        context::{Context, Defaults, quoted_list, set_keys},
        files,
        mesh::{self, MeshOptions},
        untagged::{AxesConfig, DraftChoice, LengthUnit, PolylineConfig},
    },
};

/// Largest angle of a turn, degrees: beyond, its sine has less than ten digits.
const MOST_TURN: f64 = 1e6;

/// A shape in its own frame; lengths in m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum ShapeConfig {
    /// A box around its centre.
    Box {
        /// Edge lengths.
        size: Vec<f64>,
    },
    /// A ball (disc in 2-D) around its centre.
    Ball {
        /// Radius.
        radius: f64,
    },
    /// A rod with round ends, around its centre.
    Capsule {
        /// Length of the straight part.
        length: f64,
        /// Radius.
        radius: f64,
        /// Direction of the straight part; by default upright.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<AxisName>,
    },
    /// A circular cylinder around its centre; 3-D only.
    Cylinder {
        /// Length.
        length: f64,
        /// Radius.
        radius: f64,
        /// Direction of its axis; by default upright.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<AxisName>,
    },
    /// An ellipsoid around its centre; in 2-D an ellipse.
    Ellipsoid(EllipsoidConfig),
    /// A circular cone; 3-D only.
    Cone(ConeConfig),
    /// The frustum of a circular cone; 3-D only.
    Frustum(FrustumConfig),
    /// A ramp: half of a box; in 2-D a triangle.
    Wedge(WedgeConfig),
    /// A prism over an outline; 3-D only.
    Prism(PrismConfig),
    /// A torus around its centre; 3-D only.
    Torus(TorusConfig),
    /// A polygon, counter-clockwise; 2-D only.
    Polygon(PolylineConfig),
    /// A wall along an open line, the water on its left; 2-D only.
    Polyline(PolylineConfig),
    /// An open-topped tank: bottom and walls around the inner box that begins at the frame's origin.
    Tank {
        /// Inner edge lengths.
        size: Vec<f64>,
        /// Thickness of bottom and walls; by default as many dp as the kernel reaches.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        thickness: Option<f64>,
    },
    /// A solid by its surface, from a file; 3-D only.
    Mesh(MeshConfig),
    /// Several shapes as one solid.
    Compound(Vec<CompoundPartConfig>),
}

/// A surface in a file beside the scene: STL or OBJ. It must be closed, or become closed by `mirror`, `cap` or `thickness`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct MeshConfig {
    /// Name of the file.
    pub file: String,
    /// Factor on its lengths, –; by default 1.
    pub scale: Option<f64>,
    /// Unit of its lengths; by default m.
    pub unit: Option<LengthUnit>,
    /// `true`: reverses the facets.
    pub flip: Option<bool>,
    /// Adds the mirror image across the plane through the origin normal to this axis, for half a hull; across several
    /// planes one after the other, for a quarter.
    pub mirror: Option<AxesConfig>,
    /// Closes open edges that lie in planes normal to this axis, as of panels that end at the waterline.
    pub cap: Option<AxisName>,
    /// Makes a plate of this thickness (m) around the surface, half of it on each side.
    pub thickness: Option<f64>,
    /// The geometry that other bodies touch; by default the fitting one.
    pub contact: Option<ContactGeometry>,
}

/// A coordinate direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AxisName {
    /// First.
    X,
    /// Second: up in 2-D.
    Y,
    /// Third: up in 3-D.
    Z,
}

/// A part of a compound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct CompoundPartConfig {
    /// Its shape.
    pub shape: ShapeConfig,
    /// Its place in the compound's frame.
    pub at: Option<PlacementConfig>,
}

impl CompoundPartConfig {
    /// A part at a place of the compound's frame.
    pub fn new(shape: ShapeConfig, at: PlacementConfig) -> Self {
        Self { shape, at: Some(at) }
    }
}

/// A position and a rotation. The lowest point or the draft may give the height instead.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct PlacementConfig {
    /// m.
    pub x: Option<f64>,
    /// m; the height in 2-D.
    pub y: Option<f64>,
    /// m; the height in 3-D.
    pub z: Option<f64>,
    /// Height of the shape's lowest point, m.
    pub bottom: Option<f64>,
    /// Depth of the shape's lowest point below the highest still level.
    pub draft: Option<DraftChoice>,
    /// Counter-clockwise turn, degrees; 2-D.
    pub angle_deg: Option<f64>,
    /// Turn about the axis along this vector by its length in degrees; 3-D.
    pub turn_deg: Option<Vec<f64>>,
}

impl ShapeConfig {
    /// A box of edge lengths `size` (m).
    pub fn cuboid(size: impl Into<Vec<f64>>) -> Self {
        Self::Box { size: size.into() }
    }

    /// A ball of `radius` (m).
    pub fn ball(radius: f64) -> Self {
        Self::Ball { radius }
    }

    /// A tank of inner edge lengths `size` (m).
    pub fn tank(size: impl Into<Vec<f64>>) -> Self {
        Self::Tank { size: size.into(), thickness: None }
    }

    /// The solid in the mesh `file` (STL or OBJ, in m), beside the scene.
    pub fn mesh(file: impl Into<String>) -> Self {
        Self::Mesh(MeshConfig { file: file.into(), ..MeshConfig::default() })
    }

    /// A polygon through `points` (m), counter-clockwise.
    pub fn polygon<const N: usize>(points: [[f64; 2]; N]) -> Self {
        Self::Polygon(PolylineConfig::through(points))
    }

    /// Refuses a shape that has no meaning in the scene's dimension, or whose lengths are not lengths.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        let sizes = |key: &str, size: &[f64]| {
            ctx.require_dimension(&format!("{key}.size"), size)?;
            size.iter().try_for_each(|x| ctx.require_positive(&format!("{key}.size"), Some(*x)))
        };
        let only = |dimension: usize, word: &str, instead: &str| match ctx.dimension == dimension {
            true => Ok(()),
            false => {
                let what = format!("a {word} needs a {dimension}-D scene, and this one is {}-D", ctx.dimension);
                Err(ctx.error_with_help(key, what, instead))
            }
        };
        let axis = |key: &str, axis: Option<AxisName>| match axis {
            Some(AxisName::Z) if ctx.dimension == 2 => {
                Err(ctx.error_with_help(&format!("{key}.axis"), "a 2-D scene has no z axis", "write  axis = \"x\""))
            }
            _ => Ok(()),
        };
        match self {
            ShapeConfig::Box { size } => sizes(&format!("{key}.box"), size),
            ShapeConfig::Ball { radius } => ctx.require_positive(&format!("{key}.ball.radius"), Some(*radius)),
            ShapeConfig::Capsule { length, radius, axis: a } => {
                let key = format!("{key}.capsule");
                ctx.require_positive(&format!("{key}.length"), Some(*length))?;
                ctx.require_positive(&format!("{key}.radius"), Some(*radius))?;
                axis(&key, *a)
            }
            ShapeConfig::Cylinder { length, radius, .. } => {
                only(3, "cylinder", "in 2-D a ball is a disc:  shape = { ball = { radius = 0.1 } }")?;
                ctx.require_positive(&format!("{key}.cylinder.length"), Some(*length))?;
                ctx.require_positive(&format!("{key}.cylinder.radius"), Some(*radius))
            }
            ShapeConfig::Polygon(config) => {
                only(2, "polygon", "in 3-D, boxes, balls, cylinders and capsules can be put together as a compound")?;
                verify_line(ctx, &format!("{key}.polygon"), config)?;
                verify_drawing(ctx, &format!("{key}.polygon"), config)?;
                match (config.thickness, config.closed) {
                    (Some(_), _) => {
                        Err(ctx.error_at(&format!("{key}.polygon"), "a polygon is solid: it has no thickness"))
                    }
                    (_, Some(_)) => Err(ctx.error_with_help(
                        &format!("{key}.polygon.closed"),
                        "a polygon is closed without a word",
                        "leave it out; a wall around a space is a closed polyline",
                    )),
                    _ => Ok(()),
                }
            }
            ShapeConfig::Polyline(config) => {
                only(2, "polyline", "in 3-D, walls are boxes or a tank")?;
                verify_line(ctx, &format!("{key}.polyline"), config)?;
                match config.is_drawing() {
                    true => {
                        Err(ctx.error_at(&format!("{key}.polyline.file"), "a drawing is a closed outline: a polygon"))
                    }
                    false => verify_drawing(ctx, &format!("{key}.polyline"), config),
                }
            }
            ShapeConfig::Tank { size, thickness } => {
                ctx.require_positive(&format!("{key}.tank.thickness"), *thickness)?;
                sizes(&format!("{key}.tank"), size)
            }
            ShapeConfig::Mesh(config) => {
                only(3, "mesh", "in 2-D an outline is a polygon:  shape = { polygon = { file = \"hull.svg\" } }")?;
                ctx.require_positive(&format!("{key}.mesh.scale"), config.scale)?;
                ctx.require_positive(&format!("{key}.mesh.thickness"), config.thickness)
            }
            ShapeConfig::Compound(parts) => {
                let key = format!("{key}.compound");
                if parts.is_empty() {
                    return Err(ctx.error_at(&key, "a compound has one part or more"));
                }
                parts.iter().enumerate().try_for_each(|(i, part)| {
                    part.shape.verify(ctx, &format!("{key}.{i}.shape"))?;
                    part.at.as_ref().map_or(Ok(()), |at| at.verify(ctx, &format!("{key}.{i}.at"), false))
                })
            }
            ShapeConfig::Ellipsoid(own) => MeshedShape::Ellipsoid(own).verify(ctx, key),
            ShapeConfig::Cone(own) => MeshedShape::Cone(own).verify(ctx, key),
            ShapeConfig::Frustum(own) => MeshedShape::Frustum(own).verify(ctx, key),
            ShapeConfig::Wedge(own) => MeshedShape::Wedge(own).verify(ctx, key),
            ShapeConfig::Prism(own) => MeshedShape::Prism(own).verify(ctx, key),
            ShapeConfig::Torus(own) => MeshedShape::Torus(own).verify(ctx, key),
        }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, ctx: &Context, defaults: &mut Defaults, key: &str) {
        let thick = "as many dp as the kernel reaches";
        let upright = [AxisName::Y, AxisName::Z][ctx.dimension - 2];
        match self {
            ShapeConfig::Capsule { axis, .. } => {
                defaults.fill(format!("{key}.capsule.axis"), axis, upright, "upright");
            }
            ShapeConfig::Cylinder { axis, .. } => {
                defaults.fill(format!("{key}.cylinder.axis"), axis, upright, "upright");
            }
            ShapeConfig::Polyline(PolylineConfig { thickness, .. }) => {
                defaults.fill(format!("{key}.polyline.thickness"), thickness, ctx.layers() as f64 * ctx.dp, thick);
            }
            ShapeConfig::Tank { thickness, .. } => {
                defaults.fill(format!("{key}.tank.thickness"), thickness, ctx.layers() as f64 * ctx.dp, thick);
            }
            ShapeConfig::Mesh(config) => {
                let key = format!("{key}.mesh");
                defaults.fill(format!("{key}.scale"), &mut config.scale, 1.0, "the file's own size");
                defaults.fill(
                    format!("{key}.unit"),
                    &mut config.unit,
                    LengthUnit::M,
                    "neither STL nor OBJ tells its unit",
                );
                let why = "the surface if fixed, else the hull if that is nearly all solid, else convex parts";
                defaults.fill(format!("{key}.contact"), &mut config.contact, ContactGeometry::Fitting, why);
            }
            ShapeConfig::Polygon(config) if config.is_drawing() => {
                let key = format!("{key}.polygon.scale");
                defaults.fill(key, &mut config.scale, 1.0, "the drawing's own size");
            }
            ShapeConfig::Compound(parts) => {
                for (i, part) in parts.iter_mut().enumerate() {
                    part.shape.fill(ctx, defaults, &format!("{key}.compound.{i}.shape"));
                }
            }
            ShapeConfig::Cone(ConeConfig { axis, .. }) => fill_axis(defaults, &format!("{key}.cone"), axis),
            ShapeConfig::Frustum(FrustumConfig { axis, .. }) => fill_axis(defaults, &format!("{key}.frustum"), axis),
            ShapeConfig::Prism(PrismConfig { axis, .. }) => fill_axis(defaults, &format!("{key}.prism"), axis),
            ShapeConfig::Torus(TorusConfig { axis, .. }) => fill_axis(defaults, &format!("{key}.torus"), axis),
            _ => {}
        }
    }

    /// The shape; opens the files that it names.
    pub(crate) fn build<const D: usize>(&self, ctx: &Context) -> Result<Shape<D>> {
        let thickness = |given: Option<f64>| given.unwrap_or(ctx.layers() as f64 * ctx.dp);
        let number = |axis: Option<AxisName>| axis.map_or(D - 1, |axis| axis as usize);
        let shape = match self {
            ShapeConfig::Box { size } => Shape::Box { size: vector(size) },
            ShapeConfig::Ball { radius } => Shape::Ball { radius: *radius },
            ShapeConfig::Capsule { length, radius, axis } => {
                Shape::Capsule { length: *length, radius: *radius, axis: number(*axis) }
            }
            ShapeConfig::Cylinder { length, radius, axis } => {
                Shape::Cylinder { length: *length, radius: *radius, axis: number(*axis) }
            }
            ShapeConfig::Polygon(config) => {
                Shape::Polygon { points: polygon_points(ctx, config).map_err(|e| e.in_part("polygon"))? }
            }
            ShapeConfig::Polyline(config) => {
                let points = wall_points(ctx, config).map_err(|e| e.in_part("polyline"))?;
                Shape::Polyline { points, thickness: thickness(config.thickness) }
            }
            ShapeConfig::Tank { size, thickness: given } => {
                Shape::Tank { size: vector(size), thickness: thickness(*given) }
            }
            ShapeConfig::Mesh(config) => mesh_shape(ctx, config).map_err(|e| e.in_part("mesh.file"))?,
            ShapeConfig::Compound(parts) => {
                let part = |(i, part): (usize, &CompoundPartConfig)| {
                    let inner = part.shape.build(ctx).map_err(|e| e.in_part(format!("compound.{i}.shape")))?;
                    let pose = part.at.as_ref().map_or_else(Pose::identity, |at| at.build(&inner, 0.0));
                    Ok((pose, inner))
                };
                Shape::Compound(parts.iter().enumerate().map(part).collect::<Result<_>>()?)
            }
            ShapeConfig::Ellipsoid(own) => MeshedShape::Ellipsoid(own).build(ctx)?,
            ShapeConfig::Cone(own) => MeshedShape::Cone(own).build(ctx)?,
            ShapeConfig::Frustum(own) => MeshedShape::Frustum(own).build(ctx)?,
            ShapeConfig::Wedge(own) => MeshedShape::Wedge(own).build(ctx)?,
            ShapeConfig::Prism(own) => MeshedShape::Prism(own).build(ctx)?,
            ShapeConfig::Torus(own) => MeshedShape::Torus(own).build(ctx)?,
        };
        shape.check()?;
        Ok(shape)
    }
}

fn mesh_shape<const D: usize>(ctx: &Context, config: &MeshConfig) -> Result<Shape<D>> {
    let path = files::path_beside(ctx.folder(), &config.file)?;
    let unit = config.scale.unwrap_or(1.0) * config.unit.unwrap_or_default().metres();
    let mut mirror = [false; 3];
    config.mirror.iter().flat_map(|axes| &axes.0).for_each(|axis| mirror[*axis as usize] = true);
    let completion = Completion {
        mirror,
        cap: config.cap.map(|axis| axis as usize),
        thickness: config.thickness,
        ..Completion::default()
    };
    let options = MeshOptions { unit, flip: config.flip.unwrap_or(false), completion, dp: ctx.dp };
    let (mesh, notes) = mesh::read(&path, &options)?;
    ctx.add_file_notes(notes);
    Ok(Shape::Mesh { mesh: Arc::new(mesh), contact: config.contact.unwrap_or_default() })
}

impl PlacementConfig {
    /// The place with these coordinates (m), as many as the scene has dimensions.
    pub fn point(x: &[f64]) -> Self {
        Self { x: x.first().copied(), y: x.get(1).copied(), z: x.get(2).copied(), ..Self::default() }
    }

    /// Afloat at rest at the horizontal coordinates `x` (m).
    pub fn afloat(x: &[f64]) -> Self {
        Self { draft: Some(DraftChoice::Equilibrium), ..Self::point(x) }
    }

    /// Returns the same place with the lowest point of the shape at this height (m).
    pub fn bottom(self, bottom: f64) -> Self {
        Self { bottom: Some(bottom), ..self }
    }

    /// Refuses a place that has no meaning in the scene's dimension, or gives the height twice.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, may_float: bool) -> Result<()> {
        let three = ctx.dimension == 3;
        let refuse =
            |word: &str, what: &str, help: &str| Err(ctx.error_with_help(&format!("{key}.{word}"), what, help));
        // A list may be shorter than it must be, a table may leave out coordinates.
        let listed: Vec<f64> = [self.x, self.y, self.z].into_iter().flatten().collect();
        if ctx.is_written(&format!("{key}.0")) {
            ctx.require_dimension(key, &listed)?;
        }
        if self.z.is_some() && !three {
            return refuse("z", "a 2-D scene has no z", "in 2-D x is horizontal and y is up");
        }
        if self.angle_deg.is_some() && three {
            return refuse("angle_deg", "a turn in 3-D has an axis", "write  turn_deg = [0.0, 30.0, 0.0]");
        }
        match &self.turn_deg {
            Some(_) if !three => return refuse("turn_deg", "a turn in 2-D is one angle", "write  angle_deg = 30.0"),
            Some(turn) => ctx.require_dimension(&format!("{key}.turn_deg"), turn)?,
            None => {}
        }
        let turns = self.turn_deg.iter().flatten().map(|turn| ("turn_deg", turn));
        if let Some((word, turn)) =
            turns.chain(self.angle_deg.iter().map(|turn| ("angle_deg", turn))).find(|(_, turn)| turn.abs() > MOST_TURN)
        {
            let what = format!("{word} has {turn:?}: an angle beyond {MOST_TURN}° is not exact");
            return refuse(word, &what, "give an angle from -180 to 180 degrees");
        }
        let up = if three { ("z", self.z.is_some()) } else { ("y", self.y.is_some()) };
        let heights = [up, ("bottom", self.bottom.is_some()), ("draft", self.draft.is_some())];
        let heights = set_keys(heights);
        if heights.len() > 1 {
            let help = "give one: the height of the frame, of the lowest point, or the draft";
            return refuse(heights[1], &format!("{} say the height twice", quoted_list(&heights)), help);
        }
        if !may_float && self.draft.is_some() {
            return refuse("draft", "only a solid has a draft", "give the height");
        }
        Ok(())
    }

    /// The pose of `shape` in this place. A draft in metres is measured below `level`; a draft of equilibrium starts at zero.
    pub(crate) fn build<const D: usize>(&self, shape: &Shape<D>, level: f64) -> Pose<D> {
        let position = vector(&[self.x.unwrap_or(0.0), self.y.unwrap_or(0.0), self.z.unwrap_or(0.0)]);
        let turn: Vec<f64> = match (&self.angle_deg, &self.turn_deg) {
            (Some(angle), _) => vec![angle.to_radians()],
            (None, Some(turn)) => turn.iter().map(|x| x.to_radians()).collect(),
            (None, None) => vec![0.0; 3],
        };
        let mut pose = Pose::rotated(position, &turn);
        let bottom = match self.draft {
            Some(DraftChoice::Metres(draft)) => Some(level - draft),
            Some(DraftChoice::Equilibrium) => Some(level),
            None => self.bottom,
        };
        if let Some(bottom) = bottom {
            pose.position[D - 1] = 0.0;
            pose.position[D - 1] = bottom - world_bounds(shape, &pose).min[D - 1];
        }
        pose
    }
}

/// The vector of the numbers `x`; missing ones are 0.
pub(crate) fn vector<const D: usize>(x: &[f64]) -> Vector<D> {
    Vector::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0))
}
