//! The words of solids: shape, place, and what moves them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    flexible::{Draft, LineWords, Numbers, Unit},
    waves::WaveWords,
};
use crate::geometry::Touchable;

/// One `[[solid]]`: a name, a shape, a place, and exactly one of `fixed`, `driven`, `free`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidWords {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The group that it belongs to, one word, of which `[[contact]]` speaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Geometry in the solid's own frame.
    pub shape: ShapeWords,
    /// Where that frame is at the start; the origin if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<AtWords>,
    /// `true`: nothing moves it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("const" = true))]
    pub fixed: Option<bool>,
    /// A prescribed motion moves it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub driven: Option<DrivenWords>,
    /// Water, weight and contacts move it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free: Option<FreeWords>,
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
pub enum ShapeWords {
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
        axis: Option<Axis>,
    },
    /// A circular cylinder around its centre; 3-D only.
    Cylinder {
        /// Length.
        length: f64,
        /// Radius.
        radius: f64,
        /// Direction of its axis; upright if not said.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<Axis>,
    },
    /// A polygon, counter-clockwise; 2-D only.
    Polygon(LineWords),
    /// A wall along an open line, the water on its left; 2-D only.
    Polyline(LineWords),
    /// An open-topped tank: bottom and walls around the inner box that begins at the frame's origin.
    Tank {
        /// Inner edge lengths.
        size: Vec<f64>,
        /// Thickness of bottom and walls; as many dp as the kernel reaches if not said.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        thickness: Option<f64>,
    },
    /// A solid by its surface, from a file; 3-D only.
    Mesh(MeshWords),
    /// Several shapes as one solid.
    Compound(Vec<PartWords>),
}

/// A closed surface in a file beside the scene: STL or OBJ.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshWords {
    /// Name of the file.
    pub file: String,
    /// Factor on its lengths, –; 1 if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Unit of its lengths; m if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
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
pub enum Axis {
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
pub struct PartWords {
    /// Its shape.
    pub shape: ShapeWords,
    /// Its place in the compound's frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<AtWords>,
}

/// A place and a turn. The height may instead be given by the lowest point or by the draft.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AtWords {
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
    pub draft: Option<Draft>,
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
pub struct DrivenWords {
    /// Direction of a translation (its length does not matter).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub along: Option<Vec<f64>>,
    /// Distance along it, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<LawWords>,
    /// World point of a hinge, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hinge: Option<Vec<f64>>,
    /// Direction of its axis; 3-D only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
    /// Angle about it, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<LawWords>,
    /// Angle about it, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<LawWords>,
    /// The wave that it is to make.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave: Option<WaveWords>,
    /// Several motions at once, in place of all of these, each in the frame that those before it have moved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motions: Option<Vec<DrivenWords>>,
}

/// How a driven coordinate moves: `formula`, or `file` with `column`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LawWords {
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
pub struct FreeWords {
    /// Density, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Mass, kg (kg per metre of width in 2-D), in place of a density.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Inertia about the centre of mass, kg m² (kg m²/m in 2-D): a number in 2-D; in 3-D the three
    /// about the solid's own axes, or the 3×3 tensor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia: Option<Numbers>,
    /// From the centroid to the centre of mass, in the solid's frame, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre_offset: Option<Vec<f64>>,
    /// Velocity of the centre of mass at the start, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<f64>>,
    /// Spin at the start, rad/s: a number in 2-D, a vector in 3-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin: Option<Numbers>,
    /// When it is let go, s: until then it is held still.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub release: Option<f64>,
    /// Motions that are locked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<Mode>,
}

/// A mode of motion, which can be locked or left free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
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

impl Mode {
    /// Its number among those of this dimension: translations, then turns; none if there is no such motion.
    pub(super) fn number(self, dimension: usize) -> Option<usize> {
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

impl SolidWords {
    fn new(name: impl Into<String>, shape: ShapeWords) -> Self {
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
    pub fn fixed(name: impl Into<String>, shape: ShapeWords) -> Self {
        Self { fixed: Some(true), ..Self::new(name, shape) }
    }

    /// A homogeneous free body of `density` (kg/m³).
    pub fn free(name: impl Into<String>, shape: ShapeWords, density: f64) -> Self {
        let free = FreeWords { density: Some(density), ..FreeWords::default() };
        Self { free: Some(free), ..Self::new(name, shape) }
    }

    /// A solid with a prescribed motion.
    pub fn driven(name: impl Into<String>, shape: ShapeWords, motion: DrivenWords) -> Self {
        Self { driven: Some(motion), ..Self::new(name, shape) }
    }

    /// The same solid at a place.
    pub fn at(mut self, at: AtWords) -> Self {
        self.at = Some(at);
        self
    }
}

impl ShapeWords {
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
        Self::Mesh(MeshWords { file: file.into(), ..MeshWords::default() })
    }

    /// A polygon through `points` (m), counter-clockwise.
    pub fn polygon<const N: usize>(points: [[f64; 2]; N]) -> Self {
        Self::Polygon(LineWords::through(points))
    }
}

impl AtWords {
    /// The place with these coordinates (m), as many as the scene has dimensions.
    pub fn point(x: &[f64]) -> Self {
        Self { x: x.first().copied(), y: x.get(1).copied(), z: x.get(2).copied(), ..Self::default() }
    }

    /// Afloat at rest at the horizontal coordinates `x` (m).
    pub fn afloat(x: &[f64]) -> Self {
        Self { draft: Some(Draft::Equilibrium), ..Self::point(x) }
    }
}

impl DrivenWords {
    /// A translation by `formula` (m, of t in s) in the direction `along`.
    pub fn slide(along: impl Into<Vec<f64>>, formula: impl Into<String>) -> Self {
        let distance = LawWords { formula: Some(formula.into()), ..LawWords::default() };
        Self { along: Some(along.into()), distance: Some(distance), ..Self::default() }
    }
}
