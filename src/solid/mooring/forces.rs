//! The equations of a lumped-mass line: forces on its nodes, their resistance to motion, and their mass.
//!
//! A line of n segments of length l₀ has n + 1 nodes. A node has the mass and the water of half of each segment beside it. With
//! the unit vector q along a segment of length l, its strain ε = l/l₀ − 1 and the tangent t at a node (Hall and Goupee 2015):
//!
//! - tension EA ε, or that of a table, and BA ε̇ along q, with the sag of the segment between its nodes (`segment.rs`)
//! - bending: the energy EI/l₀ (1 − q₁·q₂) at a node between two segments
//! - weight less buoyancy of the wet share φ: (m − φ ρ A) l₀ g
//! - drag ½ ρ d l₀ φ (C_d |u_n| u_n + π C_dAx |u_t| u_t) of the velocity u of the water relative to the node
//! - added mass φ ρ A l₀ (C_a (1 − t tᵀ) + C_aAx t tᵀ)
//! - a bed with the contact width c: stiffness k c l₀ times the depth of the node in it, and damping b c l₀; along the bed
//!   the same stiffness against displacement from the point of first contact, up to the Coulomb friction, at which it slides
//! - where the line leaves the bed, [`touchdown`]
//!
//! These forces neglect the acceleration of the water: its load is much smaller than the drag if the line is much thinner than
//! the waves are high.

use std::{f64::consts::PI, sync::Arc};

use super::segment::distance_from_touchdown;
use crate::math::{Matrix, Vector};

/// The part of a solid's surface that is nearest to a node, as a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BedPlane<const D: usize> {
    /// A point of the plane, m.
    pub(crate) point: Vector<D>,
    /// Unit vector out of the solid.
    pub(crate) normal: Vector<D>,
}

impl<const D: usize> BedPlane<D> {
    /// Depth (m) of `x` (m) below the plane; negative above.
    pub(crate) fn depth(&self, x: &Vector<D>) -> f64 {
        self.normal.dot(&(self.point - x))
    }
}

/// What is around a node during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NodeSurroundings<const D: usize> {
    /// Velocity of the water, m/s; zero out of the water.
    pub(crate) water_velocity: Vector<D>,
    /// Share of the node that is in the water, 0 to 1.
    pub(crate) wet: f64,
    /// The nearest surface of a fixed solid, if one is near.
    pub(crate) bed: Option<BedPlane<D>>,
}

impl<const D: usize> NodeSurroundings<D> {
    /// Air far from any solid.
    #[cfg(test)]
    pub(crate) fn air() -> Self {
        Self { water_velocity: Vector::zeros(), wet: 0.0, bed: None }
    }
}

/// Material of a line, and the water around it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LineMaterial {
    /// Volume-equivalent diameter d, m.
    pub(crate) diameter: f64,
    /// Mass of a metre, kg/m.
    pub(crate) mass: f64,
    /// Axial stiffness EA, N; the largest of a table.
    pub(crate) stiffness: f64,
    /// Tension (N) over strain (–), linear between its rows; `None`: EA ε.
    pub(crate) table: Option<Arc<[[f64; 2]]>>,
    /// Axial damping BA, N s.
    pub(crate) damping: f64,
    /// Bending stiffness EI, N m².
    pub(crate) bending: f64,
    /// Added-mass coefficients across and along, –.
    pub(crate) added_mass: [f64; 2],
    /// Drag coefficients across and along, –.
    pub(crate) drag: [f64; 2],
    /// Density of the water, kg/m³.
    pub(crate) water_density: f64,
    /// Width with which the line presses on a bed, m.
    pub(crate) contact_width: f64,
    /// Height of its axis above a bed that it touches, m.
    pub(crate) contact_radius: f64,
    /// Stiffness of the bed, Pa/m.
    pub(crate) bed_stiffness: f64,
    /// Damping of the bed, Pa s/m.
    pub(crate) bed_damping: f64,
    /// Friction coefficient of the bed, –.
    pub(crate) bed_friction: f64,
}

impl LineMaterial {
    /// Mass of the water that a metre displaces, kg/m.
    pub(crate) fn displaced(&self) -> f64 {
        self.water_density * 0.25 * PI * self.diameter * self.diameter
    }

    /// Depth (m) to which a node at `x` (m) presses into `bed`; 0 or less above it.
    pub(crate) fn depth<const D: usize>(&self, bed: &BedPlane<D>, x: &Vector<D>) -> f64 {
        bed.depth(x) + self.contact_radius
    }

    /// Largest frequency (rad/s) of a line of segments of length `l` (m), by Gershgorin's bound.
    pub(crate) fn highest_frequency(&self, l: f64) -> f64 {
        let axial = 4.0 * self.stiffness / (self.mass * l * l);
        let bending = 16.0 * self.bending / (self.mass * l.powi(4));
        (axial + bending + self.bed_stiffness * self.contact_width / self.mass).sqrt()
    }

    /// Largest rate of decay (1/s) by the axial damping of a line of segments of length `l` (m), by Gershgorin's bound.
    pub(crate) fn highest_decay(&self, l: f64) -> f64 {
        4.0 * self.damping / (self.mass * l * l)
    }
}

/// The load of weight and water on a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct WaterLoad<const D: usize> {
    /// Force at zero velocity of the node, N.
    pub(super) force: Vector<D>,
    /// Resistance of the water, N s/m: the force is −C v.
    pub(super) drag: Matrix<D>,
    /// Mass with added mass, kg.
    pub(super) mass: Matrix<D>,
}

/// The load of a bed on a node without its friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct BedLoad<const D: usize> {
    /// Unit vector out of the bed.
    pub(super) normal: Vector<D>,
    /// Force along `normal` at zero velocity of the node, N.
    pub(super) reaction: f64,
    /// Resistance to motion along `normal`, N s/m.
    pub(super) damping: f64,
}

/// How a node is held.
#[derive(Clone, Copy, Debug)]
pub(super) enum NodeHold<const D: usize> {
    /// An end that nothing holds, or a node far from any bed.
    Free,
    /// Between two segments, with their mean tension (N) along the line.
    Between(Vector<D>),
    /// An end that something holds, with the pull (N) of its segment on it.
    Held(Vector<D>),
}

/// Height above a bed over which the bed takes up the load of a held end, over the half segment of this end, –.
const TOUCH: f64 = 0.02;

/// A point mass on a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct NodeBody {
    /// kg.
    pub(crate) mass: f64,
    /// Volume, m³.
    pub(crate) volume: f64,
    /// Drag coefficient times area, m².
    pub(crate) drag_area: f64,
    /// Added-mass coefficient, –.
    pub(crate) added_mass: f64,
}

impl NodeBody {
    /// Adds another body in the same place.
    pub(super) fn add(&mut self, other: &Self) {
        let displaced = self.added_mass * self.volume + other.added_mass * other.volume;
        self.mass += other.mass;
        self.volume += other.volume;
        self.drag_area += other.drag_area;
        self.added_mass = if self.volume > 0.0 { displaced / self.volume } else { 0.0 };
    }
}

/// The force (N) with which a bed supports a node at the height `z` (m) above it, and the stiffness of this support, N/m.
///
/// The point at which a line leaves a bed lies between two nodes. At the distance b along the line from the node above it, the
/// bed supports part of the segment of length l₀ between the nodes. The line of weight w (N/m), with the tension H (N) along the
/// bed, rises from that point by z = √(b² + (H/w)²) − H/w. Nodes on this curve are at rest if the bed supports the node
/// above with the force
///
///   R = ½ w l₀ (1 − b/l₀)²,  b = √(z² + 2 z H/w) < l₀
///
/// (own derivation, for a small slope). A bed of the stiffness k (Pa/m) bends the line, of contact width c (m), over the length
/// λ = √(H/(k c)). Where λ exceeds l₀, the nodes resolve this bend. Therefore R is divided by 1 + (λ/l₀)², and b is replaced by
/// √(b² + b₀²) − b₀ with b₀ = λ²/l₀: the stiffness at z = 0 is then no larger than that of the bed.
pub(super) fn touchdown(material: &LineMaterial, segment: f64, weight: f64, pull: f64, z: f64) -> [f64; 2] {
    let stiff = material.bed_stiffness * material.contact_width * segment;
    if weight <= 0.0 || stiff <= 0.0 {
        return [0.0; 2];
    }
    let (z, soft) = (z.max(0.0), pull / stiff);
    let b = distance_from_touchdown(z, pull / weight);
    let way = b.hypot(soft) - soft;
    if way >= segment {
        return [0.0; 2];
    }
    let (left, share) = (1.0 - way / segment, 1.0 / (1.0 + soft / segment));
    let slope = (z * weight + pull) / b.hypot(soft).max(f64::MIN_POSITIVE);
    [0.5 * share * weight * segment * left * left, share * left * slope]
}

/// The load of weight and water on a node with the velocity `v` (m/s), the length `share` (m) of line and a point mass `body`.
/// `t` is the tangent there, and `gravity` is in m/s².
pub(super) fn water_load<const D: usize>(
    material: &LineMaterial,
    (share, body): (f64, &NodeBody),
    (v, t): (&Vector<D>, &Vector<D>),
    around: &NodeSurroundings<D>,
    gravity: &Vector<D>,
) -> WaterLoad<D> {
    let m = material;
    let tangential = t * t.transpose();
    let tensor = |across: f64, along: f64| Matrix::identity() * across + tangential * (along - across);
    let displaced = around.wet * m.displaced() * share;
    let dry = m.mass * share + body.mass;
    let afloat = around.wet * m.water_density * body.volume;
    let all = dry + afloat * body.added_mass;
    let mass = tensor(all + displaced * m.added_mass[0], all + displaced * m.added_mass[1]);
    let relative = around.water_velocity - v;
    let axial = t.dot(&relative);
    let normal = (relative - t * axial).norm();
    let pressure = 0.5 * m.water_density * around.wet;
    let side = pressure * m.diameter * share;
    let ball = pressure * body.drag_area * relative.norm();
    let drag = tensor(ball + side * m.drag[0] * normal, ball + side * PI * m.drag[1] * axial.abs());
    WaterLoad { force: gravity * (dry - displaced - afloat) + drag * around.water_velocity, drag, mass }
}

/// The load of the bed on a node at `x` (m) with the velocity `v` (m/s) and the length `share` (m) of line; `None` without a bed.
/// `gravity` is in m/s², and `hold` says what holds the node.
pub(super) fn bed_load<const D: usize>(
    material: &LineMaterial,
    share: f64,
    (x, v): (&Vector<D>, &Vector<D>),
    around: &NodeSurroundings<D>,
    (gravity, hold): (&Vector<D>, &NodeHold<D>),
) -> Option<BedLoad<D>> {
    let bed = around.bed?;
    let depth = material.depth(&bed, x);
    let [reaction, _] = bed_reaction(material, share, (&bed, depth), around.wet, (gravity, hold));
    let damping = material.bed_damping * material.contact_width * share;
    // The bed does not hold back what leaves it.
    let damps = depth > 0.0 && !matches!(hold, NodeHold::Held(_)) && reaction > damping * v.dot(&bed.normal);
    Some(BedLoad { normal: bed.normal, reaction: reaction.max(0.0), damping: if damps { damping } else { 0.0 } })
}

/// The force (N) with which `bed` supports a node with the length `share` (m) of line, `depth` (m) inside the bed, and the
/// stiffness (N/m) of this support. `wet` is the share of the node in the water. A held end has no such stiffness: the bed bears
/// the weight of the half segment that the pull does not lift.
pub(super) fn bed_reaction<const D: usize>(
    material: &LineMaterial,
    share: f64,
    (bed, depth): (&BedPlane<D>, f64),
    wet: f64,
    (gravity, hold): (&Vector<D>, &NodeHold<D>),
) -> [f64; 2] {
    let stiff = material.bed_stiffness * material.contact_width * share;
    let pressed = if depth > 0.0 { [stiff * depth, stiff] } else { [0.0; 2] };
    let weight = (-gravity.dot(&bed.normal) * (material.mass - wet * material.displaced())).max(0.0);
    match hold {
        NodeHold::Free => pressed,
        NodeHold::Between(pull) => {
            let flat = (pull - bed.normal * bed.normal.dot(pull)).norm();
            let borne = touchdown(material, share, weight, flat, -depth);
            if borne[0] > pressed[0] { borne } else { pressed }
        }
        NodeHold::Held(pull) => {
            let touches = (1.0 + depth / (TOUCH * share)).clamp(0.0, 1.0);
            [touches * (weight * share - pull.dot(&bed.normal)).clamp(0.0, weight * share), 0.0]
        }
    }
}

/// The force (N) along a bed on a node at `x` (m) with the length `share` (m) of line. `grip` is the point (m) from which
/// friction acts: the point of first contact, which a sliding node drags along; `None` off the bed.
pub(super) fn friction<const D: usize>(
    material: &LineMaterial,
    share: f64,
    x: &Vector<D>,
    bed: Option<BedPlane<D>>,
    grip: &mut Option<Vector<D>>,
) -> Vector<D> {
    let Some((bed, depth)) = bed.map(|bed| (bed, material.depth(&bed, x))).filter(|(_, depth)| *depth > 0.0) else {
        *grip = None;
        return Vector::zeros();
    };
    let held = grip.get_or_insert(*x);
    let mut way = x - *held;
    way -= bed.normal * bed.normal.dot(&way);
    // The stiffness is the same along and across the bed. A node therefore slides if its displacement exceeds its depth times
    // the friction coefficient.
    let longest = material.bed_friction * depth;
    let length = way.norm();
    if length > longest {
        way *= longest / length;
        *held = x - way;
    }
    way * (-material.bed_stiffness * material.contact_width * share)
}

/// Tension (N) of a segment without its damping at the strain ε, and its slope dT/dε (N).
pub(super) fn elastic_law(material: &LineMaterial, strain: f64) -> [f64; 2] {
    if strain <= 0.0 {
        return [0.0; 2];
    }
    let Some(table) = &material.table else { return [material.stiffness * strain, material.stiffness] };
    let next = table.partition_point(|row| row[0] <= strain).clamp(1, table.len() - 1);
    let ([e0, t0], [e1, t1]) = (table[next - 1], table[next]);
    let slope = (t1 - t0) / (e1 - e0);
    [t0 + slope * (strain - e0), slope]
}

/// Forces (N) of bending on the three nodes of two segments, with the energy EI/l₀ (1 − q₁·q₂). `energy` is EI/l₀ (J).
pub(super) fn bending_forces<const D: usize>(nodes: [&Vector<D>; 3], energy: f64) -> [Vector<D>; 3] {
    let sides = [nodes[1] - nodes[0], nodes[2] - nodes[1]];
    let [l1, l2] = [sides[0].norm(), sides[1].norm()];
    if l1 == 0.0 || l2 == 0.0 {
        return [Vector::zeros(); 3];
    }
    let (q1, q2) = (sides[0] / l1, sides[1] / l2);
    let cosine = q1.dot(&q2);
    let (first, second) = ((q2 - q1 * cosine) * (energy / l1), (q1 - q2 * cosine) * (energy / l2));
    [-first, first - second, second]
}
