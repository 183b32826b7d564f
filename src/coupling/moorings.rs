//! Mooring lines in the water: the surroundings of their nodes, and the loads on the solids at their ends.
//!
//! A node takes the mean velocity of the water around it, Σ V_b v_b W/Σ V_b W. The wet share of the node follows from Σ V_b W,
//! the share of the kernel support that water fills, over the share that fixed solids leave free. At the surface the wet share
//! grows from 0 to 1 over about a smoothing length. The water and the surfaces of the solids are constant during a step.

use rayon::prelude::*;

use super::Interval;
use crate::{
    error::{Error, Result},
    math::{Bounds, Matrix, Pose, Vector},
    solid::{
        ConstraintChange, Kinematics, Load, Mobility, MooringReading, Role, Solid,
        mooring::{BedPlane, Junctions, LineState, LineStep, Mooring, MooringLine, NodeSurroundings, junctions},
    },
    system::{System, known_water},
};

/// Largest force that may remain on a node at the start over its weight, –: on a line that sinks, and on one that may float, whose
/// slack part has many shapes nearly at rest.
const LARGEST_REST: [f64; 2] = [1e-3, 2.0];

/// All mooring lines of a run.
pub(crate) struct Moorings<const D: usize> {
    lines: Vec<Mooring<D>>,
    /// The points in which lines meet.
    junctions: Junctions,
    /// Fixed solids with the boxes (m) in which they are near.
    fixed: Vec<(usize, Bounds<D>)>,
    /// Driven and free solids with the boxes (m), in their frames, in which they take room from the water around a node.
    moving: Vec<(usize, Bounds<D>)>,
    /// Distance (m) within which a node finds a fixed solid. It is at least the length of the longest segment, so that both ends
    /// of a segment that leaves a bed find this bed.
    bed_reach: f64,
    /// Load on each solid in the last step; empty without lines.
    loads: Vec<Load<D>>,
    /// Impulses (N s) that lines gave to the water in the last step, and their positions (m).
    on_water: Vec<(Vector<D>, Vector<D>)>,
}

/// The name of a line, and its change.
pub(crate) type Change = (String, ConstraintChange);

impl<const D: usize> Moorings<D> {
    /// Makes the lines of `system`, at rest between their ends, with the solids at `start`. Where ranks share the water, all ranks
    /// must call this.
    ///
    /// # Errors
    /// `Scene` if no equilibrium of a line is found.
    pub(crate) fn new(system: &mut System<D>, start: &[Kinematics<D>]) -> Result<Self> {
        let specs = &system.constraints().moorings;
        let (junctions, bodies) = junctions(&system.constraints().mooring_points, specs);
        let mut made = Self {
            lines: Vec::new(),
            junctions,
            fixed: Vec::new(),
            moving: Vec::new(),
            bed_reach: system.model().support_radius(),
            loads: Vec::new(),
            on_water: Vec::new(),
        };
        if specs.is_empty() {
            return Ok(made);
        }
        let mut lines: Vec<_> = specs.iter().map(|spec| Mooring::new(spec, start, system.properties().rho0)).collect();
        let reach = lines.iter().map(|mooring| mooring.line.state.segment).fold(made.bed_reach, f64::max);
        made.bed_reach = reach;
        let near = |(i, solid): (usize, &Solid<D>)| {
            let bounds = solid.spec.shape.bounds_at(&solid.kinematics.pose);
            matches!(solid.spec.role, Role::Fixed).then(|| (i, bounds.grown(reach)))
        };
        made.fixed = system.solids().iter().enumerate().filter_map(near).collect();
        let takes_room = |(i, solid): (usize, &Solid<D>)| {
            let bounds = solid.spec.shape.bounds_at(&Pose::identity());
            let reach = system.model().support_radius();
            (!matches!(solid.spec.role, Role::Fixed)).then(|| (i, bounds.grown(reach)))
        };
        made.moving = system.solids().iter().enumerate().filter_map(takes_room).collect();
        let mut all: Vec<_> = lines.iter_mut().map(|mooring| &mut mooring.line).collect();
        made.junctions.attach(&mut all, &bodies);
        known_water::know_within(system, &all.iter().map(|line| range_around(line)).collect::<Vec<_>>());
        let rests = made.find_rest(system, &mut all);
        for ((spec, left), line) in system.constraints().moorings.iter().zip(rests).zip(&all) {
            if left.is_nan() || left > LARGEST_REST[usize::from(line.may_float())] {
                let what =
                    format!("mooring \"{}\" finds no rest: {left:.1e} of the weight of a node remains", spec.name);
                return Err(Error::scene(what).help("start its ends nearer, make it longer, or give it fewer segments"));
            }
        }
        made.lines = lines;
        Ok(made)
    }

    /// Finds the equilibrium of all active `lines`. Returns for each line the largest residual force on a node over the weight of
    /// a node.
    fn find_rest(&self, system: &System<D>, lines: &mut [&mut MooringLine<D>]) -> Vec<f64> {
        self.junctions.bring_to_rest(lines, &|x| self.surroundings(system, x), &system.gravity())
    }

    /// Shape and tension of line number `i`.
    pub(crate) fn reading(&self, system: &System<D>, i: usize) -> MooringReading<D> {
        self.lines[i].reading(&self.beds(system, i))
    }

    /// The bed near each node of line number `i`.
    fn beds(&self, system: &System<D>, i: usize) -> Vec<Option<BedPlane<D>>> {
        let bed = |x: &Vector<D>| self.bed_near(system, x).map(|(bed, _)| bed);
        self.lines[i].line.state.x.iter().map(bed).collect()
    }

    /// Whether there are no lines.
    pub(crate) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Stiffness (N/m) of the lines against a displacement of solid number `solid` along the x axis from its present position.
    /// The lines are in equilibrium at each displacement.
    pub(crate) fn surge_stiffness(&self, system: &System<D>, solid: usize) -> f64 {
        let ends = self.lines.iter().enumerate().flat_map(|(i, line)| [0, 1].map(|k| (i, k, line.solids()[k])));
        let own: Vec<_> = ends.filter(|(.., at)| *at == Some(solid)).map(|(i, k, _)| (i, k)).collect();
        self.stiffness_of(system, &own, 0)[0]
    }

    /// Stiffness (N/m) of line number `i` against displacements of its end `k`. The lines are in equilibrium at each displacement.
    pub(crate) fn end_stiffness(&self, system: &System<D>, i: usize, k: usize) -> Matrix<D> {
        let columns: Vec<_> = (0..D).map(|axis| self.stiffness_of(system, &[(i, k)], axis)).collect();
        Matrix::from_columns(&columns)
    }

    /// Sum of the forces against a common displacement of `ends`, given as (line, end), along the `axis`, over the displacement,
    /// N/m.
    fn stiffness_of(&self, system: &System<D>, ends: &[(usize, usize)], axis: usize) -> Vector<D> {
        let way = ends.iter().map(|(i, _)| 1e-3 * self.lines[*i].line.length()).fold(f64::INFINITY, f64::min);
        let force = |way: f64| {
            let mut moved: Vec<_> = self.lines.iter().map(|mooring| mooring.line.clone()).collect();
            for &(i, k) in ends {
                let node = moved[i].end_node(k);
                moved[i].state.x[node][axis] += way;
            }
            if ends.iter().any(|(i, _)| self.junctions.joins(*i)) {
                self.find_rest(system, &mut moved.iter_mut().collect::<Vec<_>>());
            } else {
                // The other lines stay as they are.
                for (i, _) in ends.iter().filter(|(i, _)| self.acts(*i)) {
                    moved[*i].find_rest(&|x| self.surroundings(system, x), &system.gravity());
                }
            }
            ends.iter().map(|&(i, k)| moved[i].state.end_forces[k]).sum::<Vector<D>>()
        };
        (force(-way) - force(way)) / (2.0 * way)
    }

    /// Nodes of line number `i` that lie on fixed solids, in order.
    pub(crate) fn lying_nodes(&self, system: &System<D>, i: usize) -> Vec<usize> {
        self.lines[i].lying_nodes(&self.beds(system, i))
    }

    /// Whether line number `i` acts.
    pub(crate) fn acts(&self, i: usize) -> bool {
        self.lines[i].line.state.acts
    }

    /// Longest inner step of line number `i`, s.
    pub(crate) fn line_step(&self, i: usize) -> f64 {
        self.lines[i].line.step_limit()
    }

    /// Load on solid number `i` in the last step.
    pub(super) fn load_on(&self, i: usize) -> Load<D> {
        self.loads.get(i).copied().unwrap_or_else(Load::zero)
    }

    /// Impulses (N s; N s/m in 2-D) of drag and added mass on the water in the last step, and their positions (m): the nodes of
    /// the lines that act on the water.
    pub(crate) fn impulses_on_water(&self) -> &[(Vector<D>, Vector<D>)] {
        &self.on_water
    }

    /// The boxes (m) in which the lines read the water in a step from time `t` (s) on.
    pub(super) fn water_ranges(&self, system: &System<D>, t: f64) -> Vec<Bounds<D>> {
        let of_line = |mooring: &Mooring<D>| match !mooring.line.state.acts && mooring.lifetime().contains(t) {
            true => vec![range_around(&mooring.line)],
            false => reading_ranges(system, &mooring.line).collect(),
        };
        self.lines.iter().flat_map(of_line).collect()
    }

    /// Time (s) from `t` (s) to the next begin or end of a line; infinite if there is none.
    pub(crate) fn next_event(&self, t: f64) -> f64 {
        self.lines.iter().map(|mooring| mooring.lifetime().next_limit(t)).fold(f64::INFINITY, f64::min)
    }

    /// Advances all lines over a step. `now` has the solids at the start, `next` the driven solids at the end. Returns the lines
    /// that began, ended or broke.
    pub(super) fn advance(
        &mut self,
        system: &System<D>,
        now: &[Kinematics<D>],
        next: &[Option<Kinematics<D>>],
        Interval { t, dt }: Interval,
    ) -> Vec<Change> {
        let mut lines = std::mem::take(&mut self.lines);
        let mut changes = Vec::new();
        for mooring in &mut lines {
            let change = self.update_lifetime(system, mooring, now, t);
            changes.extend(change.map(|change| (mooring.name.clone(), change)));
            mooring.pay_out(t, dt);
        }
        let gravity = system.gravity();
        let step = |mooring: &Mooring<D>| LineStep {
            ends: mooring.ends_after(now, next, dt),
            around: mooring.line.state.x.iter().map(|x| self.surroundings(system, x)).collect(),
        };
        let steps: Vec<_> = lines.par_iter().map(step).collect();
        let acting = lines.iter().filter(|mooring| mooring.water_impulses().is_some());
        let places: Vec<_> = acting.flat_map(|mooring| mooring.line.state.x.iter().copied()).collect();
        let mut all: Vec<_> = lines.iter_mut().map(|mooring| &mut mooring.line).collect();
        if !self.junctions.is_empty() {
            self.junctions.advance(&mut all, &steps, dt, &gravity);
        }
        let alone = all.par_iter_mut().zip(&steps).enumerate();
        alone.filter(|(i, (line, _))| line.state.acts && !self.junctions.joins(*i)).for_each(|(_, (line, step))| {
            line.advance(step.ends, dt, &step.around, &gravity);
        });
        let from_water = lines.iter().filter_map(Mooring::water_impulses).flatten();
        self.on_water = places.into_iter().zip(from_water.map(|impulse| -impulse)).collect();
        let mut loads = vec![Load::zero(); now.len()];
        for mooring in lines.iter_mut().filter(|mooring| mooring.line.state.acts) {
            for (solid, load) in mooring.loads(now) {
                if let Some(solid) = solid {
                    loads[solid] += load;
                }
            }
            let broken = mooring.break_overloaded();
            changes.extend(broken.map(|tension| (mooring.name.clone(), ConstraintChange::Broken(tension))));
        }
        (self.lines, self.loads) = (lines, loads);
        changes
    }

    /// Begins a line, in equilibrium, or ends it, if its lifetime requires this at time `t` (s). Returns this change.
    fn update_lifetime(
        &self,
        system: &System<D>,
        mooring: &mut Mooring<D>,
        now: &[Kinematics<D>],
        t: f64,
    ) -> Option<ConstraintChange> {
        match (mooring.line.state.acts, mooring.lifetime().contains(t)) {
            (false, true) => {
                mooring.pay_out(t, 0.0);
                mooring.begin(now);
                mooring.line.place_at_rest(&|x| self.surroundings(system, x), &system.gravity());
                Some(ConstraintChange::Connected)
            }
            (true, false) => {
                mooring.end_lifetime();
                Some(ConstraintChange::Released)
            }
            _ => None,
        }
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

    /// The fixed solid near the world position `x` (m), and the distance (m) from it.
    fn bed_near(&self, system: &System<D>, x: &Vector<D>) -> Option<(BedPlane<D>, f64)> {
        let (at, solids) = (system.wrapped(x), system.solids());
        let distance = |(i, bounds): &(usize, Bounds<D>)| {
            let solid = &solids[*i];
            let there = bounds.contains(&at) && !solid.boundary.is_empty();
            there.then(|| (*i, solid.distance(&at)))
        };
        let nearest = self.fixed.iter().filter_map(distance).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.filter(|(_, distance)| *distance < self.bed_reach).map(|(i, distance)| {
            let (solid, step) = (&solids[i], 1e-3 * system.model().dp);
            let pose = &solid.kinematics.pose;
            let normal = pose.rotation * solid.spec.shape.outward_normal(&pose.local(&at), step);
            (BedPlane { point: x - normal * distance, normal }, distance)
        })
    }

    /// What is around the world position `x` (m).
    pub(crate) fn surroundings(&self, system: &System<D>, x: &Vector<D>) -> NodeSurroundings<D> {
        let (at, reach) = (system.wrapped(x), system.model().support_radius());
        let bed = self.bed_near(system, x);
        let (mass, fluid) = (system.particle_mass(), system.fluid());
        let (mut weight, mut flow) = (0.0, Vector::zeros());
        system.visit_fluid_near(&at, &mut |b, _, w| {
            let share = mass / fluid.rho[b] * w;
            weight += share;
            flow += fluid.v[b] * share;
        });
        let nearest = bed.map(|(_, distance)| distance).into_iter().chain(self.moving_solid_near(system, &at));
        let free = 1.0 - nearest.reduce(f64::min).map_or(0.0, |distance| share_behind(distance / reach));
        let wet = (2.0 * weight / free.max(weight).max(0.05) - 0.5).clamp(0.0, 1.0);
        let water_velocity = if wet > 0.0 { flow / weight } else { Vector::zeros() };
        NodeSurroundings { water_velocity, wet, bed: bed.map(|(plane, _)| plane) }
    }

    /// The distance (m) from the world position `at` (m), between periodic sides, to the nearest driven or free solid within the
    /// kernel's reach. A solid that `at` is inside of takes no room: its own water may be there. The rows of water end half a dp before a
    /// face, so that less is no depth.
    fn moving_solid_near(&self, system: &System<D>, at: &Vector<D>) -> Option<f64> {
        let distance = |(i, bounds): &(usize, Bounds<D>)| {
            let local = system.home_pose(*i).local(at);
            let solid = &system.solids()[*i];
            let is_near = bounds.contains(&local) && !solid.is_removed();
            is_near.then(|| solid.spec.shape.signed_distance(&local)).filter(|d| *d > -0.5 * system.model().dp)
        };
        self.moving.iter().filter_map(distance).reduce(f64::min)
    }

    /// The states of all lines in a checkpoint.
    pub(crate) fn states(&self) -> Vec<LineState<D>> {
        self.lines.iter().map(|mooring| mooring.state().clone()).collect()
    }

    /// Whether saved states belong to these lines.
    pub(super) fn matches(&self, states: &[LineState<D>]) -> bool {
        let fits = |(mooring, state): (&Mooring<D>, &LineState<D>)| state.x.len() == mooring.line.segments() + 1;
        states.len() == self.lines.len() && self.lines.iter().zip(states).all(fits)
    }

    /// Restores saved states that [`Moorings::matches`] has accepted.
    pub(super) fn restore(&mut self, states: Vec<LineState<D>>) {
        self.lines.iter_mut().zip(states).for_each(|(mooring, state)| mooring.line.state = state);
    }
}

/// The boxes (m) of the water around the nodes of `line`.
fn reading_ranges<const D: usize>(system: &System<D>, line: &MooringLine<D>) -> impl Iterator<Item = Bounds<D>> {
    line.state.x.iter().map(|x| system.reading_range(&system.wrapped(x)))
}

/// A box (m) that contains the shapes that `line` may have between its present ends, and all water around them.
fn range_around<const D: usize>(line: &MooringLine<D>) -> Bounds<D> {
    Bounds::around(&line.state.x).grown(2.0 * line.length())
}

/// Returns the share (–) of a kernel's weight behind a plane: ∫ (1 − s²)³ ds from `t` to 1 over the same integral from −1 to 1.
/// `t` is the distance of the kernel's centre from the plane over the kernel's radius.
fn share_behind(t: f64) -> f64 {
    let t = t.clamp(-1.0, 1.0);
    let t2 = t * t;
    0.5 - 35.0 / 32.0 * t * (1.0 - t2 * (1.0 - t2 * (0.6 - t2 / 7.0)))
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../tests/unit/coupling/moorings.rs"]
mod tests;
