//! Loads that constraints put on free bodies at rest, from which the equilibrium of the bodies follows: joined and hanging
//! bodies, springs and motors of sliders in their initial state, and steady forces.
//!
//! A body that hangs on several lines divides its load among them by the balance of forces and moments, with the lines as they
//! are at the start. If several sets of tensions balance the body, the smallest counts. If none does, each line gets an equal
//! part.

use nalgebra::{DMatrix, DVector};

use super::{
    Constraints, Role, SolidSpec,
    constraint::lines::{LineEnd, start_length},
    joint_groups::{JointGroups, rise_directions},
};
use crate::{
    error::Error,
    math::{Bivector, Vector, format::four_digits},
};

/// Largest part of the load that tensions may leave unbalanced, –.
const UNBALANCED: f64 = 1e-6;

/// The loads on bodies that start at their equilibrium, kg; positive downward.
pub(crate) struct TieLoads {
    groups: JointGroups,
    free: Vec<bool>,
    /// Load on each of these bodies itself.
    on: Vec<f64>,
    /// Load of the other bodies of each group that rises together, by the number of the group.
    of_group: Vec<f64>,
}

/// The surroundings of bodies at the start.
pub(crate) struct StartState<'a, const D: usize> {
    pub(crate) specs: &'a [&'a SolidSpec<D>],
    /// Whether each solid starts at its equilibrium.
    pub(crate) afloat: &'a [bool],
    /// Mass (kg) of the water that each solid displaces where it is.
    pub(crate) displaced: &'a dyn Fn(usize) -> f64,
    /// Height (m) of each solid's lowest point above the bottom of the water.
    pub(crate) above_bottom: &'a dyn Fn(usize) -> f64,
    /// Load (kg) of the mooring lines with mass on each solid, opposite to their pull.
    pub(crate) moored: &'a dyn Fn(usize) -> Vector<D>,
    /// Gravity, m/s².
    pub(crate) g: f64,
}

/// A rope or a spring on which a body can hang.
struct Hanger<const D: usize> {
    upper: Option<usize>,
    lower: usize,
    /// Its ends at the start, the upper one first, m.
    ends: [Vector<D>; 2],
    /// Way (m) of the lower end until the line bears the weight (kg) of the body.
    way: Box<dyn Fn(f64) -> f64>,
}

impl TieLoads {
    /// The loads of these constraints at the start.
    pub(crate) fn at_start<const D: usize>(state: &StartState<D>, constraints: &Constraints<D>) -> Self {
        let (specs, n) = (state.specs, state.specs.len());
        let groups = JointGroups::of(specs, constraints);
        let free: Vec<bool> = specs.iter().map(|spec| matches!(spec.role, Role::Free(_))).collect();
        let mut made = Self { groups, free, on: vec![0.0; n], of_group: vec![0.0; n] };
        let tied = !(constraints.joints.is_empty()
            && constraints.springs.is_empty()
            && constraints.ropes.is_empty()
            && constraints.moorings.is_empty()
            && constraints.forces.is_empty());
        if !tied || state.g <= 0.0 {
            return made;
        }
        let ways = rise_directions(specs, constraints, &made.groups);
        for force in &constraints.forces {
            if let Some((steady, _)) = force.steady_load(&specs[force.solid].pose.rotation) {
                made.add(state, force.solid, -steady.dot(&ways[force.solid]) / state.g);
            }
        }
        for joint in &constraints.joints {
            let Some((along, force, _, largest)) = joint.steady_drive() else { continue };
            let lift = |i: usize| force.clamp(-largest, largest) * along.dot(&ways[i]) / state.g;
            for (end, sign) in joint.between.iter().zip([1.0, -1.0]) {
                end.iter().for_each(|i| made.add(state, *i, sign * lift(*i)));
            }
        }
        (0..n).for_each(|i| made.add(state, i, (state.moored)(i).dot(&ways[i])));
        for i in (0..n).filter(|i| !state.afloat[*i]) {
            if let Some(body) = specs[i].initial_body() {
                made.add(state, i, body.mass - (state.displaced)(i));
            }
        }
        let mut hangers = made.hangers(state, constraints);
        for spring in &constraints.springs {
            let length = start_length(&spring.ends);
            let stretch = length - spring.rest_length.unwrap_or(length);
            let hangs = hanging_ends(&spring.ends).is_some_and(|(_, lower)| made.can_hang(state, lower));
            if hangs || length == 0.0 || (spring.tension_only && stretch < 0.0) {
                continue;
            }
            let along = (spring.ends[1].at - spring.ends[0].at) / length;
            let load = |i: usize| spring.stiffness * stretch * along.dot(&ways[i]) / state.g;
            for (end, sign) in spring.ends.iter().zip([-1.0, 1.0]) {
                end.solid.into_iter().for_each(|i| made.add(state, i, sign * load(i)));
            }
        }
        // The loads (kg) that hanging bodies carry in their turn, with their places (m).
        let mut borne: Vec<(usize, f64, Vector<D>)> = Vec::new();
        // From below: each hanging body after those that hang on it.
        while let Some(next) = hangers.iter().position(|own| !made.carries(&hangers, own.lower)) {
            let group = made.groups.rising[hangers[next].lower];
            let (own, rest): (Vec<Hanger<D>>, Vec<Hanger<D>>) =
                hangers.into_iter().partition(|hanger| made.groups.rising[hanger.lower] == group);
            hangers = rest;
            let load = made.of_group[group];
            let members = made.groups.rising.iter().filter(|other| **other == group).count();
            let centre = (members == 1).then(|| made.load_centre(state, own[0].lower, &borne)).flatten();
            let shares = shares(&own, load, centre);
            let hangs = |(hanger, share): (&Hanger<D>, &f64)| (state.above_bottom)(hanger.lower) > (hanger.way)(*share);
            if load > 0.0 && own.iter().zip(&shares).all(hangs) {
                for (hanger, share) in own.iter().zip(shares) {
                    if let Some(upper) = hanger.upper {
                        made.add(state, upper, share);
                        borne.push((upper, share, hanger.ends[0]));
                    }
                }
            }
        }
        made
    }

    /// Adds a load (kg) on a solid.
    fn add<const D: usize>(&mut self, state: &StartState<D>, solid: usize, load: f64) {
        let group = self.groups.rising[solid];
        match self.free[solid] && !self.groups.held[solid] {
            true if state.afloat[solid] => self.on[solid] += load,
            true => self.of_group[group] += load,
            false => (),
        }
    }

    /// Returns whether a body can hang: no joint holds it, and neither it nor a body that rises with it floats.
    fn can_hang<const D: usize>(&self, state: &StartState<D>, solid: usize) -> bool {
        let floats = |j: usize| state.afloat[j] && self.groups.rising[j] == self.groups.rising[solid];
        self.free[solid] && !self.groups.held[solid] && !(0..self.free.len()).any(floats)
    }

    /// Returns the position (m) at which the weight of free solid `i` less its buoyancy acts, together with the loads that hang
    /// on the solid; `None` if it has other loads.
    fn load_centre<const D: usize>(
        &self,
        state: &StartState<D>,
        i: usize,
        borne: &[(usize, f64, Vector<D>)],
    ) -> Option<Vector<D>> {
        let spec = state.specs[i];
        let (body, displaced, pose) = (spec.initial_body()?, (state.displaced)(i), spec.initial_kinematics().pose);
        let (mass_at, centroid) = (pose.point(&body.centre), pose.point(&spec.shape.volume_properties().centroid));
        let (mut load, mut moment) = (body.mass - displaced, mass_at * body.mass - centroid * displaced);
        for (_, more, at) in borne.iter().filter(|(upper, ..)| *upper == i) {
            (load, moment) = (load + more, moment + at * *more);
        }
        let is_all = (load - self.of_group[self.groups.rising[i]]).abs() <= UNBALANCED * load.abs();
        (is_all && load > 0.0).then(|| moment / load)
    }

    /// Returns whether a body, or one that rises with it, is the upper end of a line.
    fn carries<const D: usize>(&self, hangers: &[Hanger<D>], solid: usize) -> bool {
        let group = self.groups.rising[solid];
        hangers.iter().any(|own| own.upper.is_some_and(|upper| self.groups.rising[upper] == group))
    }

    /// Returns the lines on which bodies can hang.
    fn hangers<const D: usize>(&self, state: &StartState<D>, constraints: &Constraints<D>) -> Vec<Hanger<D>> {
        let mut all = Vec::new();
        for rope in &constraints.ropes {
            let length = start_length(&rope.ends);
            let way = rope.max_length.map_or(0.0, |longest| longest - length);
            if let Some((upper, lower)) = hanging_ends(&rope.ends) {
                all.push(Hanger { upper, lower, ends: upper_first(&rope.ends), way: Box::new(move |_| way) });
            }
        }
        for spring in constraints.springs.iter().filter(|spring| spring.stiffness > 0.0) {
            let length = start_length(&spring.ends);
            let (slack, give) = (spring.rest_length.unwrap_or(length) - length, state.g / spring.stiffness);
            if let Some((upper, lower)) = hanging_ends(&spring.ends) {
                let ends = upper_first(&spring.ends);
                all.push(Hanger { upper, lower, ends, way: Box::new(move |mass| slack + mass * give) });
            }
        }
        let same =
            |own: &Hanger<D>| own.upper.is_some_and(|upper| self.groups.rising[upper] == self.groups.rising[own.lower]);
        all.retain(|own| self.can_hang(state, own.lower) && !same(own));
        all
    }

    /// Returns the groups of free bodies that rise together and are not held.
    pub(crate) fn groups(&self) -> Vec<Vec<usize>> {
        let members =
            |group: usize| (0..self.free.len()).filter(|i| self.free[*i] && self.groups.rising[*i] == group).collect();
        (0..self.free.len()).map(members).filter(|own: &Vec<usize>| !own.is_empty()).collect()
    }

    /// Returns the load (kg) on solid `i` itself.
    pub(crate) fn on(&self, i: usize) -> f64 {
        self.on[i]
    }

    /// Returns the load (kg) of the bodies at given heights that rise with solid `i`, and of what hangs on them.
    pub(crate) fn of_group(&self, i: usize) -> f64 {
        self.of_group[self.groups.rising[i]]
    }

    /// Returns the error that solid `i` finds no equilibrium, with the load that it carries.
    pub(crate) fn explain(&self, i: usize, error: Error) -> Error {
        let load = self.on(i) + self.of_group(i);
        if load == 0.0 {
            return error;
        }
        let more = format!("; of that, {} are the load of its joints, lines, springs and forces", four_digits(load));
        Error { message: error.message + &more, ..error }
    }
}

/// Returns the parts (kg) of `load` (kg) at `centre` (m) that the lines of a hanging body bear.
fn shares<const D: usize>(lines: &[Hanger<D>], load: f64, centre: Option<Vector<D>>) -> Vec<f64> {
    let even = vec![load / lines.len() as f64; lines.len()];
    let is_long = |line: &Hanger<D>| line.ends[0] != line.ends[1];
    let Some(centre) = centre.filter(|_| lines.len() > 1 && lines.iter().all(is_long)) else { return even };
    let longest = lines.iter().map(|line| (line.ends[1] - centre).norm()).fold(0.0, f64::max);
    let column = |line: &Hanger<D>| {
        let along = (line.ends[0] - line.ends[1]).normalize();
        let moment = Bivector::torque(&(line.ends[1] - centre), &along).axial();
        let moment = moment.into_iter().map(move |x| if longest > 0.0 { x / longest } else { 0.0 });
        along.iter().copied().chain(moment).collect::<Vec<f64>>()
    };
    let columns: Vec<Vec<f64>> = lines.iter().map(column).collect();
    let rows = columns[0].len();
    let balance = DMatrix::from_fn(rows, lines.len(), |i, j| columns[j][i]);
    let wanted = DVector::from_fn(rows, |i, _| if i == D - 1 { load } else { 0.0 });
    let Ok(tensions) = balance.clone().svd(true, true).solve(&wanted, 1e-9) else { return even };
    let is_balanced = (&balance * &tensions - &wanted).norm() <= UNBALANCED * load;
    if !is_balanced || tensions.iter().any(|tension| *tension < -UNBALANCED * load) {
        return even;
    }
    tensions.iter().zip(&columns).map(|(tension, column)| tension * column[D - 1]).collect()
}

/// Returns the places (m) of the ends of a line, the upper one first.
fn upper_first<const D: usize>([a, b]: &[LineEnd<D>; 2]) -> [Vector<D>; 2] {
    if a.at[D - 1] > b.at[D - 1] { [a.at, b.at] } else { [b.at, a.at] }
}

/// Returns the solids at the upper and the lower end of a line, if there is one at the lower end.
fn hanging_ends<const D: usize>(ends: &[LineEnd<D>; 2]) -> Option<(Option<usize>, usize)> {
    let [a, b] = ends;
    let (upper, lower) = if a.at[D - 1] > b.at[D - 1] { (a, b) } else { (b, a) };
    Some((upper.solid, lower.solid?))
}

#[cfg(test)]
#[path = "../../tests/unit/solid/tie_loads.rs"]
mod tests;
