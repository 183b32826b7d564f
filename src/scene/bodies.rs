//! The words of solids: shape, place, and what moves them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    NumberOrArray,
    flexible::{DraftChoice, LengthUnit, PolylineConfig},
    waves::WaveConfig,
};
use crate::geometry::Touchable;

/// One `[[solid]]`: a name, a shape, a place, and exactly one of `fixed`, `driven`, `free`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The group that it belongs to, one word, of which `[[contact]]` speaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Geometry in the solid's own frame.
    pub shape: ShapeConfig,
    /// Where that frame is at the start; the origin if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<PlacementConfig>,
    /// `true`: nothing moves it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("const" = true))]
    pub fixed: Option<bool>,
    /// A prescribed motion moves it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub driven: Option<DrivenConfig>,
    /// Water, weight and contacts move it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free: Option<FreeBodyConfig>,
    /// Coulomb friction coefficient, –.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Restitution coefficient, –.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// How far outside its faces others begin to touch it, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skin: Option<f64>,
}

/// A shape in its own frame; lengths in m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
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
        /// Direction of the straight part; upright if not said.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<AxisName>,
    },
    /// A circular cylinder around its centre; 3-D only.
    Cylinder {
        /// Length.
        length: f64,
        /// Radius.
        radius: f64,
        /// Direction of its axis; upright if not said.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<AxisName>,
    },
    /// A polygon, counter-clockwise; 2-D only.
    Polygon(PolylineConfig),
    /// A wall along an open line, the water on its left; 2-D only.
    Polyline(PolylineConfig),
    /// An open-topped tank: bottom and walls around the inner box that begins at the frame's origin.
    Tank {
        /// Inner edge lengths.
        size: Vec<f64>,
        /// Thickness of bottom and walls; as many dp as the kernel reaches if not said.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        thickness: Option<f64>,
    },
    /// A solid by its surface, from a file; 3-D only.
    Mesh(MeshConfig),
    /// Several shapes as one solid.
    Compound(Vec<CompoundPartConfig>),
}

/// A closed surface in a file beside the scene: STL or OBJ.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshConfig {
    /// Name of the file.
    pub file: String,
    /// Factor on its lengths, –; 1 if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Unit of its lengths; m if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<LengthUnit>,
    /// `true`: its facets are turned round, for a surface that is inside out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flip: Option<bool>,
    /// What other bodies touch; fitting if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<Touchable>,
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
pub struct CompoundPartConfig {
    /// Its shape.
    pub shape: ShapeConfig,
    /// Its place in the compound's frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<PlacementConfig>,
}

/// A place and a turn. The height may instead be given by the lowest point or by the draft.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlacementConfig {
    /// m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// m; the height in 2-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<f64>,
    /// m; the height in 3-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<f64>,
    /// Height of the shape's lowest point, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bottom: Option<f64>,
    /// Depth of the shape's lowest point below the highest still level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub draft: Option<DraftChoice>,
    /// Counter-clockwise turn, degrees; 2-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    /// Turn about the axis along this vector by its length in degrees; 3-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_deg: Option<Vec<f64>>,
}

/// A prescribed motion: `along` with `distance`, or `hinge` with `angle` or `angle_deg`; either with a `wave` instead; or `motions`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DrivenConfig {
    /// Direction of a translation (its length does not matter).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub along: Option<Vec<f64>>,
    /// Distance along it, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<TimeFunctionConfig>,
    /// World point of a hinge, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hinge: Option<Vec<f64>>,
    /// Direction of its axis; 3-D only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
    /// Angle about it, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<TimeFunctionConfig>,
    /// Angle about it, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<TimeFunctionConfig>,
    /// The wave that it is to make.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave: Option<WaveConfig>,
    /// Several motions at once, in place of all of these, each in the frame that those before it have moved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motions: Option<Vec<DrivenConfig>>,
}

/// How a driven coordinate moves: `formula`, or `file` with `column`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TimeFunctionConfig {
    /// A formula in t (s), with sin, cos, exp, …, and pi.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// A table, beside the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Its column of values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// Its column of times, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// Factor on the values of the table, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
}

/// A body that water, weight and contacts move.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FreeBodyConfig {
    /// Density, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Mass, kg (kg per metre of width in 2-D), in place of a density.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Inertia about the centre of mass, kg m² (kg m²/m in 2-D): a number in 2-D; in 3-D the three
    /// about the solid's own axes, or the 3×3 tensor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia: Option<NumberOrArray>,
    /// From the centroid to the centre of mass, in the solid's frame, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre_offset: Option<Vec<f64>>,
    /// Velocity of the centre of mass at the start, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<f64>>,
    /// Spin at the start, rad/s: a number in 2-D, a vector in 3-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin: Option<NumberOrArray>,
    /// When it is let go, s: until then it is held still.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub release: Option<f64>,
    /// Motions that are locked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<MotionMode>,
}

/// A mode of motion, which can be locked or left free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MotionMode {
    /// Translation along x.
    X,
    /// Translation along y.
    Y,
    /// Translation along z; 3-D.
    Z,
    /// Turning; 2-D.
    Turn,
    /// Turning about x; 3-D.
    TurnX,
    /// Turning about y; 3-D.
    TurnY,
    /// Turning about z; 3-D.
    TurnZ,
}

impl MotionMode {
    /// Its number among those of this dimension: translations, then turns; none if there is no such motion.
    pub(super) fn index(self, dimension: usize) -> Option<usize> {
        match (self, dimension == 3) {
            (Self::X, _) => Some(0),
            (Self::Y, _) => Some(1),
            (Self::Z, true) | (Self::Turn, false) => Some(2),
            (Self::TurnX, true) => Some(3),
            (Self::TurnY, true) => Some(4),
            (Self::TurnZ, true) => Some(5),
            _ => None,
        }
    }
}

impl SolidConfig {
    fn new(name: impl Into<String>, shape: ShapeConfig) -> Self {
        Self {
            name: name.into(),
            group: None,
            shape,
            at: None,
            fixed: None,
            driven: None,
            free: None,
            friction: None,
            restitution: None,
            skin: None,
        }
    }

    /// A solid that nothing moves.
    pub fn fixed(name: impl Into<String>, shape: ShapeConfig) -> Self {
        Self { fixed: Some(true), ..Self::new(name, shape) }
    }

    /// A homogeneous free body of `density` (kg/m³).
    pub fn free(name: impl Into<String>, shape: ShapeConfig, density: f64) -> Self {
        let free = FreeBodyConfig { density: Some(density), ..FreeBodyConfig::default() };
        Self { free: Some(free), ..Self::new(name, shape) }
    }

    /// A solid with a prescribed motion.
    pub fn driven(name: impl Into<String>, shape: ShapeConfig, motion: DrivenConfig) -> Self {
        Self { driven: Some(motion), ..Self::new(name, shape) }
    }

    /// The same solid at a place.
    pub fn at(mut self, at: PlacementConfig) -> Self {
        self.at = Some(at);
        self
    }
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
}

impl DrivenConfig {
    /// A translation by `formula` (m, of t in s) in the direction `along`.
    pub fn slide(along: impl Into<Vec<f64>>, formula: impl Into<String>) -> Self {
        let distance = TimeFunctionConfig { formula: Some(formula.into()), ..TimeFunctionConfig::default() };
        Self { along: Some(along.into()), distance: Some(distance), ..Self::default() }
    }
}
