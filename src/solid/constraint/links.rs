//! The constraints of a simulation: joints, springs, ropes, prescribed forces, and contact pairs.

use std::collections::BTreeMap;

use super::{
    joint::{JointKind, JointSpec, mode_count},
    lifetime::Lifetime,
    lines::{LineEnd, RopeSpec, SpringSpec, start_length},
};
use crate::{
    error::{Error, Result},
    solid::{
        ForceSpec, MooringPointSpec, MooringSpec, Role, SolidSpec, WindSpec,
        mooring::{check_mooring, check_mooring_points},
    },
};

/// All constraints of a simulation. Solids are numbered as in its list of solids.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Constraints<const D: usize> {
    /// Joints.
    pub joints: Vec<JointSpec<D>>,
    /// Springs and mooring lines without mass.
    pub springs: Vec<SpringSpec<D>>,
    /// Ropes.
    pub ropes: Vec<RopeSpec<D>>,
    /// Mooring lines with mass.
    pub moorings: Vec<MooringSpec<D>>,
    /// Points in which mooring lines meet.
    pub mooring_points: Vec<MooringPointSpec<D>>,
    /// Prescribed forces and torques.
    pub forces: Vec<ForceSpec<D>>,
    /// Winds.
    pub winds: Vec<WindSpec<D>>,
    /// Free solids that are held at rest at first.
    pub holds: Vec<InitialHold>,
    /// Solids that are removed during the run.
    pub removals: Vec<TimedRemoval>,
    /// Pairs of solids with their own friction and restitution, or without contact.
    pub contacts: ContactPairs,
}

impl<const D: usize> Constraints<D> {
    /// The constraints that act at the start, without springs that break then.
    pub(crate) fn at_start(&self) -> Self {
        let mut made = self.clone();
        made.joints.retain(|joint| joint.lifetime.contains(0.0));
        made.springs.retain(|spring| spring.lifetime.contains(0.0) && !spring.breaks_at_start());
        made.ropes.retain(|rope| rope.lifetime.contains(0.0));
        made.moorings.retain(|mooring| mooring.lifetime.contains(0.0));
        made.forces.retain(|force| force.lifetime.contains(0.0));
        made
    }
}

/// A solid that is removed during the run, such as a gate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedRemoval {
    /// Number of the solid.
    pub solid: usize,
    /// Time of the removal, s.
    pub at: f64,
}

/// A free solid that is held at rest until it is released.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialHold {
    /// Number of the solid.
    pub solid: usize,
    /// Time of release, s.
    pub until: f64,
}

impl InitialHold {
    /// Whether it is still held at time `t` (s), with room for round-off.
    pub(in crate::solid) fn is_active(&self, t: f64) -> bool {
        t < self.until * (1.0 - 1e-12)
    }
}

/// Contact properties of a pair of solids.
///
/// ```
/// use pontoon::solid::ContactSpec;
///
/// let slippery = ContactSpec::new([0, 1]).friction(0.05);
/// let apart = ContactSpec::new([1, 2]).without_contact();
/// assert!(slippery.can_touch && !apart.can_touch);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactSpec {
    /// Numbers of the two.
    pub between: [usize; 2],
    /// Whether they have contact, or pass through one another.
    pub can_touch: bool,
    /// Coulomb friction coefficient, –; by default the mean of both solids'.
    pub friction: Option<f64>,
    /// Restitution coefficient, –; by default the mean of both solids'.
    pub restitution: Option<f64>,
}

impl ContactSpec {
    /// The contact of the solids with these numbers, with the means of their friction and restitution.
    pub fn new(between: [usize; 2]) -> Self {
        Self { between, can_touch: true, friction: None, restitution: None }
    }

    /// The same contact with its own Coulomb friction coefficient (–).
    pub fn friction(self, friction: f64) -> Self {
        Self { friction: Some(friction), ..self }
    }

    /// The same contact with its own restitution coefficient (–).
    pub fn restitution(self, restitution: f64) -> Self {
        Self { restitution: Some(restitution), ..self }
    }

    /// The same pair without contact: its solids pass through one another.
    pub fn without_contact(self) -> Self {
        Self { can_touch: false, ..self }
    }
}

/// Contact properties of pairs, found by the numbers of both solids in either order. If a pair has several entries, the last one
/// counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactPairs(BTreeMap<[usize; 2], ContactSpec>);

impl ContactPairs {
    /// How many pairs there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// That of solids `a` and `b`.
    pub fn find(&self, a: usize, b: usize) -> Option<&ContactSpec> {
        self.0.get(&[a.min(b), a.max(b)])
    }
}

impl Extend<ContactSpec> for ContactPairs {
    fn extend<T: IntoIterator<Item = ContactSpec>>(&mut self, specs: T) {
        let keyed = |spec: ContactSpec| {
            let [a, b] = spec.between;
            ([a.min(b), a.max(b)], spec)
        };
        self.0.extend(specs.into_iter().map(keyed));
    }
}

impl FromIterator<ContactSpec> for ContactPairs {
    fn from_iter<T: IntoIterator<Item = ContactSpec>>(specs: T) -> Self {
        let mut contacts = Self::default();
        contacts.extend(specs);
        contacts
    }
}

impl<const D: usize> Constraints<D> {
    /// Whether there is nothing.
    pub(crate) fn is_empty(&self) -> bool {
        self.joints.is_empty()
            && self.springs.is_empty()
            && self.ropes.is_empty()
            && self.moorings.is_empty()
            && self.forces.is_empty()
            && self.winds.is_empty()
            && self.holds.is_empty()
            && self.removals.is_empty()
            && self.contacts.is_empty()
    }

    /// Whether solids `a` and `b` may have contact: false if a joint between them or a [`ContactSpec`] excludes it.
    pub fn can_touch(&self, a: usize, b: usize) -> bool {
        let jointed = |joint: &JointSpec<D>| same(joint.between, [Some(a), Some(b)]) && !joint.contacts_enabled;
        self.contacts.find(a, b).is_none_or(|pair| pair.can_touch) && !self.joints.iter().any(jointed)
    }

    /// The ends and the lifetime of each spring, rope and mooring line.
    pub(crate) fn lines(&self) -> impl Iterator<Item = (&[LineEnd<D>; 2], &Lifetime)> {
        let springs = self.springs.iter().map(|spring| (&spring.ends, &spring.lifetime));
        let ropes = self.ropes.iter().map(|rope| (&rope.ends, &rope.lifetime));
        springs.chain(ropes).chain(self.moorings.iter().map(|line| (&line.ends, &line.lifetime)))
    }

    /// The kind and the name of a constraint of solid number `solid` that has not ended at time `t` (s), if there is one.
    pub(crate) fn constraint_on(&self, solid: usize, t: f64) -> Option<String> {
        let joints = self.joints.iter().map(|joint| ("joint", &joint.name, joint.between, &joint.lifetime));
        let ends = |ends: &[LineEnd<D>; 2]| ends.map(|end| end.solid);
        let springs = self.springs.iter().map(|spring| ("spring", &spring.name, ends(&spring.ends), &spring.lifetime));
        let ropes = self.ropes.iter().map(|rope| ("rope", &rope.name, ends(&rope.ends), &rope.lifetime));
        let forces = self.forces.iter().map(|force| ("force", &force.name, [Some(force.solid), None], &force.lifetime));
        let moorings = self.moorings.iter();
        let moorings = moorings.map(|line| ("mooring", &line.name, ends(&line.ends), &line.lifetime));
        let in_wind =
            |wind: &WindSpec<D>| wind.targets.iter().any(|target| target.solid == solid && !target.lifetime.is_over(t));
        let mut named = joints.chain(springs).chain(ropes).chain(moorings).chain(forces);
        let held = self.holds.iter().any(|hold| hold.solid == solid && hold.is_active(t));
        let first = named.find(|(_, _, ends, lifetime)| ends.contains(&Some(solid)) && !lifetime.is_over(t));
        let blown = self.winds.iter().any(in_wind);
        let first = first.map(|(kind, name, ..)| format!("{kind} {name:?}"));
        first.or_else(|| held.then(|| "its release".into())).or_else(|| blown.then(|| "a wind".into()))
    }

    /// Checks all constraints between these solids.
    ///
    /// # Errors
    /// `Scene`: names the constraint, what is wrong with it, and what would be right.
    pub(crate) fn check(&self, solids: &[SolidSpec<D>]) -> Result<()> {
        (0..self.joints.len()).try_for_each(|i| self.check_joint(i, solids))?;
        self.springs.iter().try_for_each(|spring| check_spring(spring, solids))?;
        self.ropes.iter().try_for_each(|rope| check_rope(rope, solids).and_then(|()| check_rope_reach(rope)))?;
        self.moorings.iter().try_for_each(|mooring| check_mooring(mooring, solids))?;
        check_mooring_points(&self.mooring_points, &self.moorings)?;
        self.forces.iter().try_for_each(|force| check_force(force, solids))?;
        self.winds.iter().try_for_each(|wind| check_wind(wind, solids))?;
        self.holds.iter().try_for_each(|hold| check_hold(hold, solids))?;
        self.removals.iter().try_for_each(|removal| self.check_removal(removal, solids))?;
        self.contacts.0.values().try_for_each(|pair| check_contact(pair, solids))
    }

    /// Checks joint number `i`.
    ///
    /// # Errors
    /// `Scene`, as [`Constraints::check`].
    pub(crate) fn check_joint(&self, i: usize, solids: &[SolidSpec<D>]) -> Result<()> {
        let joint = &self.joints[i];
        let who = format!("joint \"{}\"", joint.name);
        check_ends(&who, joint.between, solids)?;
        joint.lifetime.check(&who)?;
        let refuse = |what: &str, help: &str| Err(Error::scene(format!("{who} {what}")).help(help));
        if !joint.at.norm().is_finite() {
            return refuse("has no finite place", "its place is a point of the world at the start, m");
        }
        let axis = joint.axis.norm();
        let needed =
            matches!(joint.kind, JointKind::Slider | JointKind::Tow) || (joint.kind == JointKind::Hinge && D == 3);
        if needed && !(axis > 1e-12 && axis.is_finite()) {
            return refuse(
                "has no axis",
                "a slider moves and a tow holds along a direction, a hinge in 3-D turns about an axis",
            );
        }
        if D == 2 && joint.kind == JointKind::Ball {
            return refuse("is a ball joint, and a plane has none", "in 2-D a hinge turns freely about its point");
        }
        if joint.coordinate_mode().is_none() && (joint.limits.is_some() || joint.motor.is_some()) {
            return refuse("has no coordinate to limit or to drive", "only a hinge or a slider has limits and a motor");
        }
        let generic = joint.kind == JointKind::Generic;
        let known = |mode: usize| {
            mode < mode_count::<D>() && joint.free_modes.iter().filter(|free| free.mode == mode).count() == 1
        };
        if generic == joint.free_modes.is_empty() || !joint.free_modes.iter().all(|free| known(free.mode)) {
            let help = "a generic joint leaves some modes free, each named once; no other joint has a list of them";
            return refuse("has modes that cannot be left free", help);
        }
        if let Some((_, [min, max])) = joint.end_stops().into_iter().find(|(mode, stop)| !reaches(stop, *mode >= D)) {
            let help = "from 0 or less to 0 or more: 0 is where it starts; a turn less than a whole one";
            return refuse(&format!("has limits {min} to {max}"), help);
        }
        let at_once = |other: &JointSpec<D>| other.lifetime.overlaps(&joint.lifetime);
        let twin = |other: &&JointSpec<D>| {
            same(other.between, joint.between) && (other.at - joint.at).norm() < 1e-9 && at_once(other)
        };
        if let Some(other) = self.joints[..i].iter().find(twin) {
            let what = format!("sits where joint \"{}\" of the same two solids does", other.name);
            return refuse(&what, "one joint holds them there: remove the other, or make it one of another kind");
        }
        Ok(())
    }

    /// Refuses the removal of a solid to which something is still tied.
    ///
    /// # Errors
    /// `Scene`, as [`Constraints::check`].
    pub(crate) fn check_removal(&self, removal: &TimedRemoval, solids: &[SolidSpec<D>]) -> Result<()> {
        let Some(solid) = solids.get(removal.solid) else {
            return Err(Error::scene("a solid that is not there is to be removed"));
        };
        if !(removal.at > 0.0 && removal.at.is_finite()) {
            let what = format!("solid \"{}\" is to be removed at {} s", solid.name, removal.at);
            return Err(Error::scene(what).help("a solid is removed at a time above 0, s"));
        }
        match self.constraint_on(removal.solid, removal.at) {
            Some(tie) => {
                let (name, at) = (&solid.name, removal.at);
                let what = format!("{tie} is tied to solid \"{name}\", which is removed at {at} s");
                Err(Error::scene(what).help(format!("end the tie at the same time or before:  until = {at}")))
            }
            None => Ok(()),
        }
    }
}

/// Whether end stops (m, or rad of a turn) have the start between them.
fn reaches(&[min, max]: &[f64; 2], turn: bool) -> bool {
    let wide = turn && max - min >= std::f64::consts::TAU;
    min <= 0.0 && 0.0 <= max && min < max && max.is_finite() && min.is_finite() && !wide
}

/// Checks a spring.
///
/// # Errors
/// `Scene`, as [`Constraints::check`].
pub(crate) fn check_spring<const D: usize>(spring: &SpringSpec<D>, solids: &[SolidSpec<D>]) -> Result<()> {
    let who = format!("spring \"{}\"", spring.name);
    check_line(&who, &spring.ends, solids)?;
    spring.lifetime.check(&who)?;
    let numbers = [("stiffness", spring.stiffness, 0.0), ("damping", spring.damping, 0.0)];
    for (word, x, least) in numbers.into_iter().chain(spring.rest_length.map(|l| ("length", l, 0.0))) {
        if !(x >= least && x.is_finite()) {
            let error = Error::scene(format!("{who} has a {word} of {x}"));
            return Err(error.help(format!("its {word} is 0 or more")).at("", None, word));
        }
    }
    if spring.stiffness == 0.0 && spring.damping == 0.0 {
        let help = "give a stiffness, N/m, or a damping, N s/m, above 0";
        return Err(Error::scene(format!("{who} is neither stiff nor damped")).help(help));
    }
    Ok(())
}

/// Checks a rope.
///
/// # Errors
/// `Scene`, as [`Constraints::check`].
pub(crate) fn check_rope<const D: usize>(rope: &RopeSpec<D>, solids: &[SolidSpec<D>]) -> Result<()> {
    let who = format!("rope \"{}\"", rope.name);
    check_line(&who, &rope.ends, solids)?;
    rope.lifetime.check(&who)?;
    let length = rope.max_length.unwrap_or_else(|| start_length(&rope.ends));
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::scene(format!("{who} is {length} m long")).help("give it a length above 0, m"));
    }
    Ok(())
}

/// Refuses a rope that is shorter than the distance of its ends at the start.
///
/// # Errors
/// `Scene`, as [`Constraints::check`].
pub(crate) fn check_rope_reach<const D: usize>(rope: &RopeSpec<D>) -> Result<()> {
    let start = start_length(&rope.ends);
    let length = rope.max_length.unwrap_or(start);
    // Room for the round-off of places written in decimals.
    if rope.lifetime.has_begun(0.0) && start > length * (1.0 + 1e-9) {
        let what = format!("rope \"{}\" is {length} m long, and its ends start {start} m apart", rope.name);
        return Err(Error::scene(what).help(format!("write  length = {start:.6}  or more, or start nearer")));
    }
    Ok(())
}

/// Checks a force.
///
/// # Errors
/// `Scene`, as [`Constraints::check`].
pub(crate) fn check_force<const D: usize>(force: &ForceSpec<D>, solids: &[SolidSpec<D>]) -> Result<()> {
    let who = format!("force \"{}\"", force.name);
    check_ends(&who, [Some(force.solid), None], solids)?;
    force.lifetime.check(&who)?;
    let finite = |laws: &[crate::solid::TimeFunction]| laws.iter().all(|law| law.value_and_rate(0.0).0.is_finite());
    if !finite(&force.force) || !finite(&force.torque) {
        return Err(Error::scene(format!("{who} is not finite at t = 0")).help("check its formula or table"));
    }
    Ok(())
}

/// Checks a wind.
fn check_wind<const D: usize>(wind: &WindSpec<D>, solids: &[SolidSpec<D>]) -> Result<()> {
    let free = |i: usize| matches!(solids.get(i), Some(SolidSpec { role: Role::Free(_), .. }));
    if !wind.targets.iter().all(|target| free(target.solid)) {
        return Err(Error::scene("a wind acts on a solid that is not free").help("name free solids"));
    }
    if wind.level.is_nan() || wind.level == f64::INFINITY {
        let help = "give the height of the still water, m, or −∞ without water";
        return Err(Error::scene(format!("a wind is over water at the level {} m", wind.level)).help(help));
    }
    let finite = wind.velocity.iter().all(|law| law.value_and_rate(0.0).0.is_finite());
    if !(finite && wind.drag >= 0.0 && wind.density >= 0.0 && (wind.drag * wind.density).is_finite()) {
        return Err(Error::scene("a wind is not finite at t = 0").help("check its velocity, drag and density"));
    }
    Ok(())
}

fn check_hold<const D: usize>(hold: &InitialHold, solids: &[SolidSpec<D>]) -> Result<()> {
    check_ends("a hold", [Some(hold.solid), None], solids)?;
    let still = |body: &crate::solid::FreeBody<D>| body.velocity.norm() == 0.0 && body.spin.0.norm() == 0.0;
    let fine = matches!(&solids[hold.solid].role, Role::Free(body) if still(body));
    if fine && hold.until.is_finite() {
        return Ok(());
    }
    Err(Error::scene(format!("\"{}\" cannot be held until {} s", solids[hold.solid].name, hold.until))
        .help("what is held at first starts at rest, without velocity or spin, and is let go at a time, s"))
}

fn check_contact<const D: usize>(pair: &ContactSpec, solids: &[SolidSpec<D>]) -> Result<()> {
    let [a, b] = pair.between;
    if a == b || a.max(b) >= solids.len() {
        return Err(Error::scene("a contact is not between two solids that are there").help("give the numbers of two"));
    }
    let friction = pair.friction.is_none_or(|x| x >= 0.0 && x.is_finite());
    if !friction || !pair.restitution.is_none_or(|x| (0.0..=1.0).contains(&x)) {
        let help = "friction is 0 or more, restitution 0 to 1";
        return Err(
            Error::scene(format!("the contact of \"{}\" and \"{}\"", solids[a].name, solids[b].name)).help(help)
        );
    }
    Ok(())
}

fn check_line<const D: usize>(who: &str, ends: &[LineEnd<D>; 2], solids: &[SolidSpec<D>]) -> Result<()> {
    check_ends(who, ends.map(|end| end.solid), solids)?;
    match ends.iter().all(|end| end.at.norm().is_finite()) {
        true => Ok(()),
        false => Err(Error::scene(format!("{who} has an end that is nowhere")).help("its ends are points, m")),
    }
}

/// Refuses an end on an unknown solid, two ends on one solid, and ends of which none is on a free solid.
fn check_ends<const D: usize>(who: &str, ends: [Option<usize>; 2], solids: &[SolidSpec<D>]) -> Result<()> {
    if ends.iter().flatten().any(|&i| i >= solids.len()) {
        return Err(Error::scene(format!("{who} names a solid that is not there")));
    }
    if ends[0] == ends[1] {
        return Err(Error::scene(format!("{who} ties a solid to itself")).help("name two solids, or one and the world"));
    }
    let free = |&i: &usize| matches!(solids[i].role, Role::Free(_));
    if ends.iter().flatten().any(free) {
        return Ok(());
    }
    let names: Vec<&str> = ends.iter().flatten().map(|&i| solids[i].name.as_str()).collect();
    let verb = if names.len() == 2 { "are" } else { "is" };
    Err(Error::scene(format!("{who} has nothing to act on: \"{}\" {verb} not free", names.join("\" and \"")))
        .help("one of its ends at least must be a free solid: free = { density = 500.0 }"))
}

/// Whether two pairs are the same in either order.
fn same<T: PartialEq + Copy>(a: [T; 2], b: [T; 2]) -> bool {
    a == b || a == [b[1], b[0]]
}
