//! The specification of mooring lines, with the conventions of MoorDyn (Hall and Goupee 2015).

use super::forces::{LineMaterial, NodeBody};
use crate::{
    error::{Error, ErrorCode, Result},
    solid::{LineEnd, Role, SolidSpec},
};

/// Stiffness of a bed unless it is given, Pa/m.
pub(crate) const DEFAULT_BED_STIFFNESS: f64 = 3e6;

/// Damping of a bed unless it is given, Pa s/m.
pub(crate) const DEFAULT_BED_DAMPING: f64 = 3e5;

/// Axial damping of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineDamping {
    /// BA, N s.
    Given(f64),
    /// Share ζ of the critical damping of the shortest wave on the line, –: BA = ζ l₀ √(EA m) with segments of length l₀.
    OfCritical(f64),
}

/// A kind of mooring line: material, drag, and bed.
///
/// ```
/// use pontoon::solid::LineType;
///
/// // A studless chain of 0.25 m volume-equivalent diameter, 390 kg/m.
/// let chain = LineType::new(0.252, 390.0, 1.674e9);
/// assert_eq!((chain.drag, chain.added_mass), ([1.2, 0.0], [1.0, 0.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineType {
    /// Volume-equivalent diameter d, m.
    pub diameter: f64,
    /// Mass of a metre in air, kg/m.
    pub mass_per_length: f64,
    /// Axial stiffness EA, N.
    pub stiffness: f64,
    /// Axial damping.
    pub damping: LineDamping,
    /// Bending stiffness EI, N m²; 0 for chain.
    pub bending_stiffness: f64,
    /// Added-mass coefficients across and along the line, –.
    pub added_mass: [f64; 2],
    /// Drag coefficients across the line (of the area d l) and along it (of the area π d l), –.
    pub drag: [f64; 2],
    /// Diameter with which the line touches fixed solids, m. `None`, as in MoorDyn: its axis touches them, with the width d. The links of
    /// a studless chain are 3.35 bars wide, 1.86 d.
    pub contact_diameter: Option<f64>,
    /// Stiffness of fixed solids against the line, Pa/m: force for each metre of depth and each square metre of contact.
    pub bed_stiffness: f64,
    /// Damping of fixed solids against the line, Pa s/m.
    pub bed_damping: f64,
    /// Coulomb friction coefficient of fixed solids, –.
    pub bed_friction: f64,
}

impl LineType {
    /// A line of this volume-equivalent diameter (m), mass (kg/m) and axial stiffness EA (N), with critical axial damping, C_d = 1.2
    /// and C_a = 1 across it, no drag or added mass along it, and a smooth bed.
    pub fn new(diameter: f64, mass_per_length: f64, stiffness: f64) -> Self {
        Self {
            diameter,
            mass_per_length,
            stiffness,
            damping: LineDamping::OfCritical(1.0),
            bending_stiffness: 0.0,
            added_mass: [1.0, 0.0],
            drag: [1.2, 0.0],
            contact_diameter: None,
            bed_stiffness: DEFAULT_BED_STIFFNESS,
            bed_damping: DEFAULT_BED_DAMPING,
            bed_friction: 0.0,
        }
    }

    /// The material of segments of length `segment` (m) in water of the density `water_density` (kg/m³).
    pub(super) fn material(&self, segment: f64, water_density: f64) -> LineMaterial {
        LineMaterial {
            diameter: self.diameter,
            mass: self.mass_per_length,
            stiffness: self.stiffness,
            damping: match self.damping {
                LineDamping::Given(damping) => damping,
                LineDamping::OfCritical(share) => share * segment * (self.stiffness * self.mass_per_length).sqrt(),
            },
            bending: self.bending_stiffness,
            added_mass: self.added_mass,
            drag: self.drag,
            water_density,
            contact_width: self.contact_diameter.unwrap_or(self.diameter),
            contact_radius: 0.5 * self.contact_diameter.unwrap_or_default(),
            bed_stiffness: self.bed_stiffness,
            bed_damping: self.bed_damping,
            bed_friction: self.bed_friction,
        }
    }
}

/// A clump weight or a float: a point mass on a line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClumpSpec {
    /// Length of the line from its first end to the point, without tension, m. The nearest node carries the mass.
    pub at: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Volume, m³.
    pub volume: f64,
    /// Drag coefficient times area, m².
    pub drag_area: f64,
}

/// The specification of a mooring line with mass.
///
/// ```
/// use pontoon::solid::{LineEnd, LineType, MooringSpec};
///
/// // 8 m of chain from solid number 1 to the bottom.
/// let ends = [LineEnd::on(1, [2.0, 0.4]), LineEnd::ground([8.0, 0.0])];
/// let line = MooringSpec::<2>::new("west", ends, 8.0, LineType::new(0.0037, 0.0607, 3e4)).segments(30);
/// assert_eq!(line.segments, 30);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MooringSpec<const D: usize> {
    /// Its name.
    pub name: String,
    /// Its two ends.
    pub ends: [LineEnd<D>; 2],
    /// Length without tension, m.
    pub length: f64,
    /// Number of segments.
    pub segments: usize,
    /// Its material; in 2-D that of the lines of a metre of width.
    pub line: LineType,
    /// Tension under which a segment breaks, N; infinite if none does.
    pub strength: f64,
    /// Clump weights and floats.
    pub clumps: Vec<ClumpSpec>,
}

impl<const D: usize> MooringSpec<D> {
    /// A line of this length (m) without tension, in 20 segments.
    pub fn new(name: impl Into<String>, ends: [LineEnd<D>; 2], length: f64, line: LineType) -> Self {
        Self { name: name.into(), ends, length, segments: 20, line, strength: f64::INFINITY, clumps: Vec::new() }
    }

    /// The same line in this number of segments.
    pub fn segments(self, segments: usize) -> Self {
        Self { segments, ..self }
    }

    /// The same line with one more clump weight or float.
    pub fn clump(mut self, clump: ClumpSpec) -> Self {
        self.clumps.push(clump);
        self
    }

    /// The same line, a segment of which breaks under this tension (N).
    pub fn strength(self, strength: f64) -> Self {
        Self { strength, ..self }
    }

    /// The point mass on each node.
    pub(super) fn node_bodies(&self) -> Vec<NodeBody> {
        let mut bodies = vec![NodeBody::default(); self.segments + 1];
        for clump in &self.clumps {
            let node = (clump.at / self.length * self.segments as f64).round() as usize;
            let body = &mut bodies[node.min(self.segments)];
            body.mass += clump.mass;
            body.volume += clump.volume;
            body.drag_area += clump.drag_area;
        }
        bodies
    }
}

/// Checks a mooring line between these solids.
///
/// # Errors
/// `Scene`: names the line, what is wrong with it, and what would be right.
pub(crate) fn check_mooring<const D: usize>(mooring: &MooringSpec<D>, solids: &[SolidSpec<D>]) -> Result<()> {
    let who = format!("mooring \"{}\"", mooring.name);
    let refuse = |what: String, help: &str| Err(Error::scene(format!("{who} {what}")).help(help));
    let ends = mooring.ends.map(|end| end.solid);
    if ends.iter().flatten().any(|&i| i >= solids.len()) {
        return refuse("names a solid that is not there".into(), "its ends are numbers of solids, or the ground");
    }
    if !mooring.ends.iter().all(|end| end.at.norm().is_finite()) {
        return refuse("has an end that is nowhere".into(), "its ends are points, m");
    }
    let moves = |&i: &usize| !matches!(solids[i].role, Role::Fixed);
    if ends[0] == ends[1] || !ends.iter().flatten().any(moves) {
        return refuse("holds nothing that moves".into(), "one of its ends is on a free or a driven solid");
    }
    let line = &mooring.line;
    let damping = match line.damping {
        LineDamping::Given(x) | LineDamping::OfCritical(x) => x,
    };
    let positive =
        [("diameter", line.diameter), ("mass_per_length", line.mass_per_length), ("stiffness", line.stiffness)];
    let others = [
        ("damping", damping),
        ("bending_stiffness", line.bending_stiffness),
        ("added_mass", line.added_mass[0]),
        ("added_mass_axial", line.added_mass[1]),
        ("drag", line.drag[0]),
        ("drag_axial", line.drag[1]),
        ("contact_diameter", line.contact_diameter.unwrap_or_default()),
        ("bed_stiffness", line.bed_stiffness),
        ("bed_damping", line.bed_damping),
        ("bed_friction", line.bed_friction),
    ];
    let wrong = positive.iter().find(|(_, x)| !(*x > 0.0 && x.is_finite()));
    if let Some((word, x)) = wrong.or_else(|| others.iter().find(|(_, x)| !(*x >= 0.0 && x.is_finite()))) {
        let what = format!("has a line whose {word} is {x}");
        return refuse(what, "diameter, mass and stiffness are above 0, the other numbers 0 or more");
    }
    if !(1..=MOST_SEGMENTS).contains(&mooring.segments) {
        let error = Error::scene(format!("{who} has {} segments", mooring.segments)).with_code(ErrorCode::OutOfRange);
        return Err(error.help(format!("1 to {MOST_SEGMENTS}; 20 to 40 resolve a catenary")));
    }
    let length = mooring.length;
    if !(length > 0.0 && length.is_finite()) {
        return refuse(format!("is {length} m long"), "give it a length above 0, m");
    }
    let inside = |clump: &ClumpSpec| {
        let least = clump.mass.min(clump.volume).min(clump.drag_area);
        (0.0..=length).contains(&clump.at) && least >= 0.0 && (clump.mass + clump.volume + clump.drag_area).is_finite()
    };
    if !mooring.clumps.iter().all(inside) {
        return refuse(
            "has a clump that is not on it, or has no valid mass".into(),
            "at is a length along the line, m",
        );
    }
    let nodes = mooring.node_bodies();
    for (k, end) in mooring.ends.iter().enumerate() {
        let Some(body) = end.solid.and_then(|solid| solids[solid].initial_body()) else { continue };
        let own = nodes[k * mooring.segments].mass + 0.5 * line.mass_per_length * length / mooring.segments as f64;
        if own > MOST_END_MASS * body.mass {
            let what = format!("moves half a segment of {own:.3} kg with a body of {:.3} kg", body.mass);
            return refuse(
                what,
                "more segments make the part of the line that goes with the body lighter: a tenth of it at most",
            );
        }
    }
    let distance = (mooring.ends[1].at - mooring.ends[0].at).norm();
    let strain = distance / length - 1.0;
    if strain > MOST_STRAIN {
        let tension = strain * line.stiffness;
        let error = Error::scene(format!(
            "{who} is {length} m long, and its ends start {distance:.6} m apart: its tension would be {tension:.3e} N"
        ));
        return Err(error.help(format!("write  length = {distance:.4}  or more, or start nearer")));
    }
    Ok(())
}

/// Most segments of a line.
const MOST_SEGMENTS: usize = 1000;

/// Largest mass of an end of a line over that of its body, –: the body carries it a step late, which is stable up to a third.
const MOST_END_MASS: f64 = 0.1;

/// Largest strain at the start, –: that of nylon at its strength is about 0.3.
const MOST_STRAIN: f64 = 0.3;
