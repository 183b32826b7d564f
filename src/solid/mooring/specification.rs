//! The specification of mooring lines, with the conventions of MoorDyn (Hall and Goupee 2015).

use super::{
    forces::{LineMaterial, NodeBody},
    network::Junctions,
    winch::Winch,
};
use crate::{
    error::{Error, ErrorCode, Result},
    math::Vector,
    solid::{Lifetime, LineEnd, Role, SolidSpec, TimeFunction},
};

/// Stiffness of a bed unless it is given, Pa/m.
pub(crate) const DEFAULT_BED_STIFFNESS: f64 = 3e6;

/// Damping of a bed unless it is given, Pa s/m.
pub(crate) const DEFAULT_BED_DAMPING: f64 = 3e5;

/// Least length of a line on a winch over its length at the start, –.
pub(crate) const SHORTEST_SHARE: f64 = 0.01;

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
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineType {
    /// Volume-equivalent diameter d, m.
    pub diameter: f64,
    /// Mass of a metre in air, kg/m.
    pub mass_per_length: f64,
    /// Axial stiffness EA, N; with a table the largest in it.
    pub stiffness: f64,
    /// Tension (N) over strain (–), linear between its rows and on beyond the last; `None`: EA times the strain.
    pub table: Option<Vec<[f64; 2]>>,
    /// Axial damping.
    pub damping: LineDamping,
    /// Bending stiffness EI, N m²; 0 for chain.
    pub bending_stiffness: f64,
    /// Added-mass coefficients across and along the line, –.
    pub added_mass: [f64; 2],
    /// Drag coefficients across the line (of the area d l) and along it (of the area π d l), –.
    pub drag: [f64; 2],
    /// Diameter with which the line touches fixed solids, m. `None`: the axis of the line touches them, with the width d, as in
    /// MoorDyn. The links of a studless chain are 3.35 bars wide, 1.86 d.
    pub contact_diameter: Option<f64>,
    /// Stiffness of fixed solids against the line, Pa/m: force for each metre of depth and each square metre of contact.
    pub bed_stiffness: f64,
    /// Damping of fixed solids against the line, Pa s/m.
    pub bed_damping: f64,
    /// Coulomb friction coefficient of fixed solids, –.
    pub bed_friction: f64,
}

impl LineType {
    /// A line of this volume-equivalent diameter (m), mass (kg/m) and axial stiffness EA (N), with critical axial damping,
    /// C_d = 1.2 and C_a = 1 across it, no drag or added mass along it, and a smooth bed.
    pub fn new(diameter: f64, mass_per_length: f64, stiffness: f64) -> Self {
        Self {
            diameter,
            mass_per_length,
            stiffness,
            table: None,
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

    /// The same line with a tension (N) over the strain (–): rows from no strain and no tension on, both of which increase.
    pub fn table(self, rows: Vec<[f64; 2]>) -> Self {
        let slopes = rows.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]));
        Self { stiffness: slopes.fold(0.0, f64::max), table: Some(rows), ..self }
    }

    /// The material of segments of length `segment` (m) in water of the density `water_density` (kg/m³).
    pub(super) fn material(&self, segment: f64, water_density: f64) -> LineMaterial {
        LineMaterial {
            diameter: self.diameter,
            mass: self.mass_per_length,
            stiffness: self.stiffness,
            table: self.table.as_deref().map(Into::into),
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
#[non_exhaustive]
pub struct ClumpSpec {
    /// Length of the line from its first end to the point, without tension, m. The nearest node carries the mass.
    pub at: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Volume, m³.
    pub volume: f64,
    /// Drag coefficient times area, m².
    pub drag_area: f64,
    /// Added-mass coefficient of the volume, –.
    pub added_mass: f64,
}

impl ClumpSpec {
    /// The point mass on its node.
    pub(super) fn body(&self) -> NodeBody {
        NodeBody { mass: self.mass, volume: self.volume, drag_area: self.drag_area, added_mass: self.added_mass }
    }
}

/// A point in which mooring lines meet, with the mass of a clump weight or a buoy.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MooringPointSpec<const D: usize> {
    /// Its name.
    pub name: String,
    /// Place (m) from which the point finds its rest at the start.
    pub at: Vector<D>,
    /// Its mass, volume, drag and added mass; its `at` is not used.
    pub body: ClumpSpec,
}

impl<const D: usize> MooringPointSpec<D> {
    /// A point without mass near this place (m).
    pub fn new(name: impl Into<String>, at: impl Into<Vector<D>>) -> Self {
        Self { name: name.into(), at: at.into(), body: ClumpSpec::default() }
    }

    /// The same point with this mass, volume, drag and added mass.
    pub fn body(self, body: ClumpSpec) -> Self {
        Self { body, ..self }
    }
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
    /// The number of the mooring point at each end; `None` if the end is on a solid or on the ground.
    pub points: [Option<usize>; 2],
    /// Length without tension, m.
    pub length: f64,
    /// Length (m) that a winch pays out in addition to `length`, as a function of the time of the run (s); all segments grow
    /// alike.
    pub paid_out: Option<TimeFunction>,
    /// Number of segments.
    pub segments: usize,
    /// Its material; in 2-D that of the lines of a metre of width.
    pub line: LineType,
    /// When it acts, and the tension under which a segment breaks.
    pub lifetime: Lifetime,
    /// Clump weights and floats.
    pub clumps: Vec<ClumpSpec>,
    /// A winch with a controller.
    pub winch: Option<Winch>,
    /// Whether the water gets the opposite of the line's drag and added-mass force.
    pub acts_on_water: bool,
}

impl<const D: usize> MooringSpec<D> {
    /// A line of this length (m) without tension, in 20 segments.
    pub fn new(name: impl Into<String>, ends: [LineEnd<D>; 2], length: f64, line: LineType) -> Self {
        Self {
            name: name.into(),
            ends,
            points: [None; 2],
            length,
            paid_out: None,
            segments: 20,
            line,
            lifetime: Lifetime::default(),
            clumps: Vec::new(),
            winch: None,
            acts_on_water: false,
        }
    }

    /// The same line with end number `end`, 0 or 1, in mooring point number `point`, which is near `at` (m).
    pub fn joined(mut self, end: usize, point: usize, at: impl Into<Vector<D>>) -> Self {
        self.points[end] = Some(point);
        self.ends[end] = LineEnd::ground(at);
        self
    }

    /// Whether it has an end in a mooring point.
    pub(crate) fn is_joined(&self) -> bool {
        self.points.iter().any(Option::is_some)
    }

    /// The same line on a winch that pays out this additional length (m) as a function of the time of the run (s).
    pub fn paid_out(self, length: impl Into<TimeFunction>) -> Self {
        Self { paid_out: Some(length.into()), ..self }
    }

    /// The same line on a winch with a controller, in place of one that pays out a given length.
    pub fn winch(self, winch: Winch) -> Self {
        Self { winch: Some(winch), ..self }
    }

    /// The same line, whose drag and added mass act on the water too.
    pub fn acting_on_water(self) -> Self {
        Self { acts_on_water: true, ..self }
    }

    /// Length without tension at time `t` (s), m; at least [`SHORTEST_SHARE`] of the length at the start.
    pub(crate) fn length_at(&self, t: f64) -> f64 {
        let paid_out = self.paid_out.as_ref().map_or(0.0, |law| law.value_and_rate(t).0);
        (self.length + paid_out).max(SHORTEST_SHARE * self.length)
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

    /// The same line with this lifetime. Under its strength (N) a segment breaks.
    pub fn lifetime(self, lifetime: Lifetime) -> Self {
        Self { lifetime, ..self }
    }

    /// The point mass on each node.
    pub(super) fn node_bodies(&self) -> Vec<NodeBody> {
        let mut bodies = vec![NodeBody::default(); self.segments + 1];
        for clump in &self.clumps {
            let node = (clump.at / self.length * self.segments as f64).round() as usize;
            bodies[node.min(self.segments)].add(&clump.body());
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
    if !mooring.is_joined() && (ends[0] == ends[1] || !ends.iter().flatten().any(moves)) {
        let help = "one of its ends is on a free or a driven solid, or in a mooring point";
        return refuse("holds nothing that moves".into(), help);
    }
    if mooring.is_joined() {
        if mooring.points[0] == mooring.points[1] {
            return refuse("has both ends in one mooring point".into(), "its ends are in two places");
        }
        if mooring.segments < 2 {
            return refuse("has one segment and an end in a mooring point".into(), "write  segments = 2  or more");
        }
        if mooring.lifetime.since > 0.0 || mooring.lifetime.until.is_finite() {
            let help = "a line with an end in a mooring point acts in the whole run: leave out since and until, and let its solids \
                        stay; breaks is allowed";
            return refuse("begins or ends in the run, and meets others in a mooring point".into(), help);
        }
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
    if !mooring.clumps.iter().all(|clump| (0.0..=length).contains(&clump.at) && is_body(clump)) {
        return refuse(
            "has a clump that is not on it, or has no valid mass".into(),
            "at is a length along the line, m",
        );
    }
    if let Some(winch) = &mooring.winch {
        if mooring.paid_out.is_some() {
            return refuse(
                "is on two winches".into(),
                "it has a winch that pays out a given length, or one with a controller",
            );
        }
        if let Err(what) = winch.check(length) {
            return refuse(
                format!("has a winch whose {what}"),
                "targets, rates and gains are above 0, and the line starts in its range",
            );
        }
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
    if let Some(rows) = &line.table {
        let rises = |pair: &[[f64; 2]]| pair[1][0] > pair[0][0] && pair[1][1] > pair[0][1] && pair[1][1].is_finite();
        if rows.len() < 2 || rows[0] != [0.0; 2] || !rows.windows(2).all(rises) {
            let help = "it begins with [0, 0], has two rows or more, and strain and tension increase";
            return refuse("has a line whose table of stiffness is not valid".into(), help);
        }
    }
    let distance = (mooring.ends[1].at - mooring.ends[0].at).norm();
    let strain = distance / mooring.length_at(0.0) - 1.0;
    if strain > MOST_STRAIN && !mooring.is_joined() {
        let tension = strain * line.stiffness;
        let error = Error::scene(format!(
            "{who} is {length} m long, and its ends start {distance:.6} m apart: its tension would be {tension:.3e} N"
        ));
        return Err(error.help(format!("write  length = {distance:.4}  or more, or start nearer")));
    }
    Ok(())
}

/// Whether a clump weight, a float or a point has a valid mass, volume and drag.
fn is_body(body: &ClumpSpec) -> bool {
    let numbers = [body.mass, body.volume, body.drag_area, body.added_mass];
    numbers.iter().all(|x| *x >= 0.0 && x.is_finite())
}

/// Checks the points in which these lines meet.
///
/// # Errors
/// `Scene`: names the point, what is wrong with it, and what would be right.
pub(crate) fn check_mooring_points<const D: usize>(
    points: &[MooringPointSpec<D>],
    moorings: &[MooringSpec<D>],
) -> Result<()> {
    let meets = |p: usize| moorings.iter().filter(|line| line.points.contains(&Some(p))).count();
    if let Some(line) = moorings.iter().find(|line| line.points.iter().flatten().any(|p| *p >= points.len())) {
        let error = Error::scene(format!("mooring \"{}\" names a mooring point that is not there", line.name));
        return Err(error.help(format!("there are {} points, numbered from 0", points.len())));
    }
    for (p, point) in points.iter().enumerate() {
        let who = format!("mooring point \"{}\"", point.name);
        if !is_body(&point.body) || !point.at.norm().is_finite() {
            let error = Error::scene(format!("{who} has no valid place, mass, volume or drag"));
            return Err(error.help("they are finite numbers, and all but the place 0 or more"));
        }
        if meets(p) < 2 {
            let error = Error::scene(format!("{who} joins {} lines", meets(p)));
            return Err(error.help("two lines or more end there; a weight on one line is a clump of that line"));
        }
    }
    Ok(())
}

/// The points in which these lines meet, with the body of each.
pub(crate) fn junctions<const D: usize>(
    points: &[MooringPointSpec<D>],
    moorings: &[MooringSpec<D>],
) -> (Junctions, Vec<NodeBody>) {
    (Junctions::new(moorings), points.iter().map(|point| point.body.body()).collect())
}

/// Most segments of a line.
const MOST_SEGMENTS: usize = 1000;

/// Largest mass of an end of a line over the mass of its body, –. The body carries this mass one step late; this is stable up to
/// a third.
const MOST_END_MASS: f64 = 0.1;

/// Largest strain at the start, –: that of nylon at its strength is about 0.3.
const MOST_STRAIN: f64 = 0.3;
