//! Mooring lines in the water: what is around their nodes, and the loads on the solids at their ends.
//!
//! A node takes the mean velocity of the water around it, Σ V_b v_b W/Σ V_b W. Its wet share follows from the share of the kernel's
//! weight that water fills, Σ V_b W, over the share that fixed solids leave free; it grows from 0 to 1 over about a smoothing
//! length at the surface. The water and the surfaces of the solids hold for a whole step.

use crate::{
    error::{Error, Result},
    math::{Bounds, Vector},
    solid::{
        Kinematics, Load, Mobility, MooringReading, Role,
        mooring::{BedPlane, LineState, Mooring, NodeSurroundings},
    },
    system::System,
};

/// Largest force that may remain on a node at the start over its weight, –.
const LARGEST_REST: f64 = 1e-3;

/// All mooring lines of a run.
pub(crate) struct Moorings<const D: usize> {
    lines: Vec<Mooring<D>>,
    /// Fixed solids with the boxes (m) in which they are near.
    fixed: Vec<(usize, Bounds<D>)>,
    /// Load on each solid in the last step; empty without lines.
    loads: Vec<Load<D>>,
}

/// A break of a line: its name and its tension, N.
pub(crate) type Break = (String, f64);

impl<const D: usize> Moorings<D> {
    /// The lines of `system` at rest between their ends, on solids that start as `start`.
    ///
    /// # Errors
    /// `Scene` if a line finds no rest.
    pub(crate) fn new(system: &System<D>, start: &[Kinematics<D>]) -> Result<Self> {
        let specs = &system.constraints().moorings;
        let mut made = Self { lines: Vec::new(), fixed: Vec::new(), loads: Vec::new() };
        if specs.is_empty() {
            return Ok(made);
        }
        let reach = system.model().support_radius();
        let near = |(i, solid): (usize, &crate::solid::Solid<D>)| {
            let bounds = solid.spec.shape.bounds_at(&solid.kinematics.pose);
            matches!(solid.spec.role, Role::Fixed).then(|| (i, bounds.grown(reach)))
        };
        made.fixed = system.solids().iter().enumerate().filter_map(near).collect();
        for spec in specs {
            let mut mooring = Mooring::new(spec, start, system.properties().rho0);
            let left = mooring.line.find_rest(&|x| made.surroundings(system, x), &system.gravity());
            if left.is_nan() || left > LARGEST_REST {
                let what =
                    format!("mooring \"{}\" finds no rest: {left:.1e} of the weight of a node remains", spec.name);
                return Err(Error::scene(what).help("start its ends nearer, make it longer, or give it fewer segments"));
            }
            made.lines.push(mooring);
        }
        Ok(made)
    }

    /// Shape and tension of line number `i`.
    pub(crate) fn reading(&self, system: &System<D>, i: usize) -> MooringReading<D> {
        let mooring = &self.lines[i];
        let around: Vec<_> = mooring.line.state.x.iter().map(|x| self.surroundings(system, x)).collect();
        mooring.reading(&around)
    }

    /// Whether there is none.
    pub(crate) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Stiffness (N/m) of the lines on solid number `solid` against a displacement along the x axis, at rest where it is.
    /// The lines find their rest again with their ends displaced.
    pub(crate) fn surge_stiffness(&self, system: &System<D>, solid: usize) -> f64 {
        let of_line = |mooring: &Mooring<D>| {
            let line = &mooring.line;
            let last = line.segments();
            let nodes = [0, last];
            let way = 1e-3 * line.length();
            let force = |way: f64| {
                let mut moved = line.clone();
                let own = (0..2).filter(|k| mooring.solids()[*k] == Some(solid));
                own.clone().for_each(|k| moved.state.x[nodes[k]][0] += way);
                moved.find_rest(&|x| self.surroundings(system, x), &system.gravity());
                own.map(|k| moved.state.end_forces[k][0]).sum::<f64>()
            };
            (force(-way) - force(way)) / (2.0 * way)
        };
        let on_solid = |mooring: &&Mooring<D>| mooring.solids().contains(&Some(solid));
        self.lines.iter().filter(on_solid).map(of_line).sum()
    }

    /// Longest inner step of line number `i`, s.
    pub(crate) fn line_step(&self, i: usize) -> f64 {
        self.lines[i].line.step_limit()
    }

    /// Load on solid number `i` in the last step.
    pub(super) fn load_on(&self, i: usize) -> Load<D> {
        self.loads.get(i).copied().unwrap_or_else(Load::zero)
    }

    /// Advances all lines by `dt` (s), while the solids go from `now` on; `next` is where driven solids go. Returns the lines that break.
    pub(super) fn advance(
        &mut self,
        system: &System<D>,
        now: &[Kinematics<D>],
        next: &[Option<Kinematics<D>>],
        dt: f64,
    ) -> Vec<Break> {
        let mut lines = std::mem::take(&mut self.lines);
        let (mut breaks, mut loads) = (Vec::new(), vec![Load::zero(); now.len()]);
        for mooring in &mut lines {
            let around: Vec<_> = mooring.line.state.x.iter().map(|x| self.surroundings(system, x)).collect();
            let (ends, broken) = mooring.advance(now, next, dt, &around, &system.gravity());
            for (solid, load) in ends {
                if let Some(solid) = solid {
                    loads[solid] += load;
                }
            }
            breaks.extend(broken.map(|tension| (mooring.name.clone(), tension)));
        }
        (self.lines, self.loads) = (lines, loads);
        breaks
    }

    /// The longest step (s) with which the coupling to the solids is stable.
    pub(super) fn step_limit(&self, mobility: &dyn Fn(usize) -> Mobility<D>, solids: &[Kinematics<D>]) -> f64 {
        // Rates of several lines on one solid add up.
        let mut rates = vec![0.0; solids.len()];
        for mooring in &self.lines {
            for (k, end) in mooring.solids().into_iter().enumerate() {
                if let Some(solid) = end {
                    rates[solid] += mooring.step_limit(k, &mobility(solid), solids).powi(-2);
                }
            }
        }
        rates.into_iter().fold(0.0, f64::max).sqrt().recip()
    }

    /// What is around the world position `x` (m).
    pub(crate) fn surroundings(&self, system: &System<D>, x: &Vector<D>) -> NodeSurroundings<D> {
        let (at, reach) = (system.wrapped(x), system.model().support_radius());
        let solids = system.solids();
        let distance = |(i, bounds): &(usize, Bounds<D>)| {
            let solid = &solids[*i];
            let there = bounds.contains(&at) && !solid.boundary.is_empty();
            there.then(|| (*i, solid.spec.shape.signed_distance(&solid.kinematics.pose.local(&at))))
        };
        let nearest = self.fixed.iter().filter_map(distance).min_by(|a, b| a.1.total_cmp(&b.1));
        let bed = nearest.filter(|(_, distance)| *distance < reach).map(|(i, distance)| {
            let (solid, step) = (&solids[i], 1e-3 * system.model().dp);
            let pose = &solid.kinematics.pose;
            let normal = pose.rotation * solid.spec.shape.outward_normal(&pose.local(&at), step);
            (BedPlane { point: x - normal * distance, normal }, distance)
        });
        let (mass, fluid) = (system.particle_mass(), system.fluid());
        let (mut weight, mut flow) = (0.0, Vector::zeros());
        system.visit_fluid_near(&at, &mut |b, _, w| {
            let share = mass / fluid.rho[b] * w;
            weight += share;
            flow += fluid.v[b] * share;
        });
        let free = 1.0 - bed.map_or(0.0, |(_, distance)| share_behind(distance / reach));
        let wet = (2.0 * weight / free.max(weight).max(0.05) - 0.5).clamp(0.0, 1.0);
        let water_velocity = if wet > 0.0 { flow / weight } else { Vector::zeros() };
        NodeSurroundings { water_velocity, wet, bed: bed.map(|(plane, _)| plane) }
    }

    /// The states of all lines in a checkpoint.
    pub(crate) fn states(&self) -> Vec<LineState<D>> {
        self.lines.iter().map(|mooring| mooring.state().clone()).collect()
    }

    /// Returns to saved states; whether they belong to these lines.
    pub(crate) fn restore(&mut self, states: Vec<LineState<D>>) -> bool {
        let fits = |(mooring, state): (&Mooring<D>, &LineState<D>)| state.x.len() == mooring.line.segments() + 1;
        let same = states.len() == self.lines.len() && self.lines.iter().zip(&states).all(fits);
        if same {
            self.lines.iter_mut().zip(states).for_each(|(mooring, state)| mooring.line.state = state);
        }
        same
    }
}

/// The share of a kernel's weight behind a plane at the distance `t` of its centre over its radius, –: ∫ (1 − s²)³ ds from `t` to 1,
/// over that from −1 to 1.
fn share_behind(t: f64) -> f64 {
    let t = t.clamp(-1.0, 1.0);
    let t2 = t * t;
    0.5 - 35.0 / 32.0 * t * (1.0 - t2 * (1.0 - t2 * (0.6 - t2 / 7.0)))
}

#[cfg(test)]
#[path = "../../tests/unit/coupling/moorings.rs"]
mod tests;
