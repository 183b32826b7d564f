//! Loads that free bodies carry at rest through their ties, for placing them at their equilibrium: bodies that are joined
//! to them or hang on them, springs as they are at the start, and steady forces.

use super::{
    Constraints, Role, SolidSpec,
    constraint::lines::{LineEnd, start_length},
    joint_groups::JointGroups,
};
use crate::error::Error;

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
    /// Load (kg) of the mooring lines with mass on each solid, downward.
    pub(crate) moored: &'a dyn Fn(usize) -> f64,
    /// Gravity, m/s².
    pub(crate) g: f64,
}

/// A rope or a spring on which a body can hang.
struct Hanger {
    upper: Option<usize>,
    lower: usize,
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
        for force in &constraints.forces {
            if let Some((steady, _)) = force.steady_load() {
                made.add(state, force.solid, -steady[D - 1] / state.g);
            }
        }
        (0..n).for_each(|i| made.add(state, i, (state.moored)(i)));
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
            let rise = (spring.ends[1].at[D - 1] - spring.ends[0].at[D - 1]) / length;
            let load = spring.stiffness * stretch * rise / state.g;
            for (end, sign) in spring.ends.iter().zip([-1.0, 1.0]) {
                end.solid.into_iter().for_each(|i| made.add(state, i, sign * load));
            }
        }
        // From below: each hanging body after those that hang on it.
        while let Some(next) = hangers.iter().position(|own| !made.carries(&hangers, own.lower)) {
            let group = made.groups.rising[hangers[next].lower];
            let (own, rest): (Vec<Hanger>, Vec<Hanger>) =
                hangers.into_iter().partition(|hanger| made.groups.rising[hanger.lower] == group);
            hangers = rest;
            let load = made.of_group[group];
            let share = load / own.len() as f64;
            let hangs = |hanger: &Hanger| (state.above_bottom)(hanger.lower) > (hanger.way)(share);
            if load > 0.0 && own.iter().all(hangs) {
                own.iter().filter_map(|hanger| hanger.upper).for_each(|upper| made.add(state, upper, share));
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

    /// Returns whether a body, with those that rise with it, can hang: no joint holds it and none of them floats.
    fn can_hang<const D: usize>(&self, state: &StartState<D>, solid: usize) -> bool {
        let floats = |j: usize| state.afloat[j] && self.groups.rising[j] == self.groups.rising[solid];
        self.free[solid] && !self.groups.held[solid] && !(0..self.free.len()).any(floats)
    }

    /// Returns whether a body, or one that rises with it, is the upper end of a line.
    fn carries(&self, hangers: &[Hanger], solid: usize) -> bool {
        let group = self.groups.rising[solid];
        hangers.iter().any(|own| own.upper.is_some_and(|upper| self.groups.rising[upper] == group))
    }

    /// Returns the lines on which bodies can hang.
    fn hangers<const D: usize>(&self, state: &StartState<D>, constraints: &Constraints<D>) -> Vec<Hanger> {
        let mut all = Vec::new();
        for rope in &constraints.ropes {
            let length = start_length(&rope.ends);
            let way = rope.max_length.map_or(0.0, |longest| longest - length);
            if let Some((upper, lower)) = hanging_ends(&rope.ends) {
                all.push(Hanger { upper, lower, way: Box::new(move |_| way) });
            }
        }
        for spring in constraints.springs.iter().filter(|spring| spring.stiffness > 0.0) {
            let length = start_length(&spring.ends);
            let (slack, give) = (spring.rest_length.unwrap_or(length) - length, state.g / spring.stiffness);
            if let Some((upper, lower)) = hanging_ends(&spring.ends) {
                all.push(Hanger { upper, lower, way: Box::new(move |mass| slack + mass * give) });
            }
        }
        let same =
            |own: &Hanger| own.upper.is_some_and(|upper| self.groups.rising[upper] == self.groups.rising[own.lower]);
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
        let more = format!("; of that, {load:.4} are the load of its joints, ropes, springs and forces");
        Error { message: error.message + &more, ..error }
    }
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
