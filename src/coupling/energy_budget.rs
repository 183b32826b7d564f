//! The energy budget of water and bodies since the start.
//!
//! A load that acts over a step does work at the mean of the velocities at its two ends, ½ (V₀ + V₁), so that the works of all
//! loads add up to the change of kinetic energy. The work of the water uses the velocity of the force pass. The entry
//! `coupling` has two parts: the energy that a body received less the energy that the water lost, and a correction to
//! the work of weight. The correction is needed because the engine moves the body by V₁ Δt.

use serde::{Deserialize, Serialize};

#[cfg(feature = "gpu")]
use super::power_breakdown::{PressurePass, breakdown};
use super::{
    load_breakdown::{BodyLoads, LoadBreakdown, locked},
    power_breakdown::{PowerBreakdown, PowerMeter, gains_of_last_pass, total_power},
};
use crate::{
    math::{Bivector, Vector},
    model::HasPairLoop,
    solid::{Dim, FreeBody, Kinematics, Load, Role, Solid},
    system::{RemovedParticle, System},
};

/// Energies since the start, J (J/m in 2-D). An entry is positive if water and bodies have gained energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBudget {
    /// Work of driven solids on the water, of gravity along periodic sides, of gravity that changes, of a current and of a towed
    /// frame.
    pub driven: f64,
    /// Work of motors.
    pub motors: f64,
    /// Work of springs and mooring lines. Energy that they store or dissipate counts negative.
    pub springs: f64,
    /// Work of the forces of the scene and of the loads that a program adds with `push`.
    pub forces: f64,
    /// Work of contacts, including contacts with driven solids.
    pub contacts: f64,
    /// Work of joints, end stops and ropes.
    pub joints: f64,
    /// Work of viscosity: negative.
    pub viscous: f64,
    /// Work of density diffusion.
    pub diffusion: f64,
    /// Work of the gradient correction.
    pub gradient: f64,
    /// Work of particle shifting.
    pub shifting: f64,
    /// Work of sponge layers: negative.
    pub damping: f64,
    /// Work of the boundary particles.
    pub walls: f64,
    /// Energy that the bodies received less the energy that the water lost.
    pub coupling: f64,
    /// Energy of removed particles, negative.
    pub removed: f64,
    /// Energy of added free solids and ballast less the energy of removed ones.
    pub solids: f64,
}

impl EnergyBudget {
    /// Returns all entries with their names.
    pub fn entries(&self) -> [(&'static str, f64); 15] {
        [
            ("driven", self.driven),
            ("motors", self.motors),
            ("springs", self.springs),
            ("forces", self.forces),
            ("contacts", self.contacts),
            ("joints", self.joints),
            ("viscous", self.viscous),
            ("diffusion", self.diffusion),
            ("gradient", self.gradient),
            ("shifting", self.shifting),
            ("damping", self.damping),
            ("walls", self.walls),
            ("coupling", self.coupling),
            ("removed", self.removed),
            ("solids", self.solids),
        ]
    }
}

/// Records the load breakdown of each body and, on request, the energy budget.
#[derive(Serialize, Deserialize)]
pub(crate) struct Accounting<const D: usize> {
    /// Number of steps from one power breakdown to the next; `None` if no power breakdown is needed.
    interval: Option<u32>,
    /// Number of steps since the last power breakdown.
    since: u32,
    /// Whether the energy budget is recorded.
    energy: bool,
    powers: PowerBreakdown,
    /// Viscous loads on the solids at the last power breakdown.
    viscous: Vec<Load<D>>,
    /// Work (J) of the water on each solid in the present step.
    work: Vec<f64>,
    breakdown: Vec<LoadBreakdown<D>>,
    budget: EnergyBudget,
    #[serde(skip)]
    meter: Option<PowerMeter<D>>,
}

/// The powers that a device measures in a force pass, and what it adds up over the water in the step that follows.
#[cfg(feature = "gpu")]
pub(crate) struct DevicePass<const D: usize> {
    /// Powers on the motion, without weight, and on the compression of the water, W.
    pub(crate) gains: [f64; 2],
    /// The pass with the pressure alone, if there is a power breakdown.
    pub(crate) pressure: Option<PressurePass<D>>,
    /// The same with uncorrected gradients, if the model corrects them.
    pub(crate) plain: Option<PressurePass<D>>,
    /// Sum of the velocities of the water, m/s.
    pub(crate) velocity_sum: Vector<D>,
    /// Sum of the displacements by shifting, m.
    pub(crate) shift_sum: Vector<D>,
    /// Energy that sponge layers absorb, J.
    pub(crate) absorbed: f64,
}

#[cfg(feature = "gpu")]
impl<const D: usize> DevicePass<D> {
    /// A pass without measured powers.
    pub(crate) fn unmeasured() -> Self {
        let [velocity_sum, shift_sum] = [Vector::zeros(); 2];
        Self { gains: [0.0; 2], pressure: None, plain: None, velocity_sum, shift_sum, absorbed: 0.0 }
    }
}

/// The state of an [`Accounting`] in a checkpoint.
pub(crate) type AccountingState<const D: usize> = Accounting<D>;

impl<const D: usize> Accounting<D> {
    /// Creates the accounting for the solids of `system`, with the energy budget if `energy` is true, and a power breakdown every
    /// `interval` steps, or none if `interval` is `None`.
    pub(crate) fn new(system: &System<D>, energy: bool, interval: Option<u32>) -> Self
    where
        Dim<D>: HasPairLoop<D>,
    {
        let solids = system.solids().len();
        Self {
            interval,
            since: 0,
            energy,
            powers: PowerBreakdown::default(),
            viscous: vec![Load::zero(); solids],
            work: vec![0.0; solids],
            breakdown: vec![LoadBreakdown::zero(); solids],
            budget: EnergyBudget::default(),
            meter: interval.map(|_| PowerMeter::new(system.model())),
        }
    }

    /// Whether it reads the water: for the energy budget or for power breakdowns.
    pub(crate) fn reads_water(&self) -> bool {
        self.energy || self.interval.is_some()
    }

    /// Whether the energy budget is recorded.
    pub(crate) fn has_energy_budget(&self) -> bool {
        self.energy
    }

    /// Returns the number of steps from one power breakdown to the next, or `None` without power breakdowns.
    pub(crate) fn power_interval(&self) -> Option<u32> {
        self.interval
    }

    /// Returns the loads on solid number `solid` in the last step, by their origin.
    pub(crate) fn breakdown(&self, solid: usize) -> &LoadBreakdown<D> {
        &self.breakdown[solid]
    }

    /// Returns the energy budget, or `None` if it is not recorded.
    pub(crate) fn budget(&self) -> Option<&EnergyBudget> {
        self.energy.then_some(&self.budget)
    }

    /// Returns the state for a checkpoint.
    pub(crate) fn state(&self) -> AccountingState<D> {
        Self {
            viscous: self.viscous.clone(),
            work: self.work.clone(),
            breakdown: self.breakdown.clone(),
            meter: None,
            ..*self
        }
    }

    /// Continues from `state`, which must have the same number of solids and the same entries.
    pub(crate) fn restore(&mut self, state: AccountingState<D>) {
        *self = Self { meter: self.meter.take(), ..state };
    }

    /// Whether `state` has the same number of solids and the same entries.
    pub(crate) fn matches(&self, state: &AccountingState<D>) -> bool {
        self.interval == state.interval && self.energy == state.energy && self.breakdown.len() == state.breakdown.len()
    }

    /// Adds a solid.
    pub(super) fn add_body(&mut self) {
        self.viscous.push(Load::zero());
        self.work.push(0.0);
        self.breakdown.push(LoadBreakdown::zero());
    }

    /// Whether the next force pass is to have a power breakdown.
    pub(crate) fn needs_breakdown(&self) -> bool {
        self.interval.is_some() && self.since == 0
    }

    /// Adds the work of a force pass whose rates apply for `dt` (s).
    pub(crate) fn add_force_pass(&mut self, system: &System<D>, dt: f64) {
        let due = self.needs_breakdown();
        let breakdown = self.meter.as_mut().filter(|_| due).map(|meter| meter.decompose(system));
        let of_energy = || [total_power(system, gains_of_last_pass(system)), system.periodic_gravity_power()];
        let powers = if self.energy { of_energy() } else { [0.0; 2] };
        self.add_powers(system, dt, breakdown, powers);
    }

    /// Adds the work of a force pass of a device whose rates apply for `dt` (s), and of the step that follows from it.
    #[cfg(feature = "gpu")]
    pub(crate) fn add_device_pass(&mut self, system: &System<D>, dt: f64, pass: DevicePass<D>) {
        let DevicePass { gains, pressure, plain, velocity_sum, shift_sum, absorbed } = pass;
        let breakdown = pressure.map(|pressure| breakdown(system, gains, pressure, plain));
        let mass = system.particle_mass() * system.water_multiplicity();
        let along_sides = system.gravity() - system.non_periodic_gravity();
        let powers = [total_power(system, gains), mass * along_sides.dot(&velocity_sum)];
        self.add_powers(system, dt, breakdown, powers);
        self.budget.shifting -= mass * system.potential_gravity().dot(&shift_sum);
        self.budget.damping -= absorbed;
    }

    /// Adds the work of a force pass whose rates apply for `dt` (s): with its power breakdown, if there is one, with its power on the
    /// water without the work of the solids, and with that of gravity along periodic sides (W).
    fn add_powers(
        &mut self,
        system: &System<D>,
        dt: f64,
        breakdown: Option<(PowerBreakdown, Vec<Load<D>>)>,
        [total, along_sides]: [f64; 2],
    ) {
        if let Some((powers, pressure)) = breakdown {
            self.powers = powers;
            let solids = system.solids().iter().zip(pressure);
            self.viscous = solids.map(|(solid, pressure)| solid.load - pressure).collect();
        }
        if let Some(interval) = self.interval {
            self.since = (self.since + 1) % interval;
        }
        if self.energy {
            let PowerBreakdown { viscous, diffusion, gradient } = self.powers;
            self.budget.viscous += viscous * dt;
            self.budget.diffusion += diffusion * dt;
            self.budget.gradient += gradient * dt;
            self.budget.walls += (total - viscous - diffusion - gradient) * dt;
            self.budget.driven += along_sides * dt;
        }
        self.work.fill(0.0);
        for (i, solid) in system.solids().iter().enumerate() {
            self.add_work_on(system, i, solid.load.power(&solid.kinematics) * dt);
        }
    }

    /// Adds the `work` (J) of the water on solid number `i` in the present step.
    fn add_work_on(&mut self, system: &System<D>, i: usize, work: f64) {
        self.work[i] += work;
        if let Role::Driven(_) = system.solids()[i].spec.role {
            self.budget.driven -= work * system.solid_multiplicity(i);
        }
    }

    /// Adds the change of potential energy by a `change` of gravity (m/s²) where water and bodies are; `water` computes the sum of
    /// its products with the places of the water, along the axes that are not periodic (m²/s²).
    pub(crate) fn add_gravity_change(&mut self, system: &System<D>, change: &Vector<D>, water: impl FnOnce() -> f64) {
        if self.energy {
            let water = water();
            let body = |(i, solid): (usize, &Solid<D>)| -solid.potential_energy(change) * system.solid_multiplicity(i);
            let bodies: f64 = system.solids().iter().enumerate().map(body).sum();
            self.budget.driven -= system.particle_mass() * system.water_multiplicity() * water + bodies;
        }
    }

    /// Adds the work of moving the water by `shifts` (m).
    pub(crate) fn add_shifting(&mut self, system: &System<D>, shifts: &[Vector<D>]) {
        let own = shifts.iter().take(system.fluid().len());
        let mass = system.particle_mass() * system.water_multiplicity();
        self.budget.shifting -= mass * own.map(|s| system.potential_gravity().dot(s)).sum::<f64>();
    }

    /// Subtracts the energy of removed particles.
    pub(crate) fn add_removed(&mut self, system: &System<D>, lost: &[RemovedParticle<D>]) {
        self.add_displaced(lost.iter().map(|p| system.particle_energy(&p.r, &p.v, p.rho)).sum());
    }

    /// Subtracts the energy (J) of displaced water.
    pub(crate) fn add_displaced(&mut self, energy: f64) {
        self.budget.removed -= energy;
    }

    /// Adds the energy (J) of an added solid or of added ballast; the energy is negative for a removed solid or removed ballast.
    pub(crate) fn add_solid_energy(&mut self, energy: f64) {
        self.budget.solids += energy;
    }

    /// Subtracts the energy (J) that sponge layers absorbed.
    pub(crate) fn add_absorbed(&mut self, energy: f64) {
        self.budget.damping -= energy;
    }

    /// Adds the work of the faces of thin parts: `energy` (J) on the water, and that of the `impulses` (N s, N m s) on the
    /// solids.
    pub(crate) fn add_repelled(&mut self, system: &System<D>, energy: f64, impulses: &[Load<D>]) {
        self.budget.walls += energy;
        for (i, (solid, impulse)) in system.solids().iter().zip(impulses).enumerate() {
            let work = impulse.power(&solid.kinematics);
            self.budget.walls += work * system.solid_multiplicity(i);
            self.add_work_on(system, i, work);
        }
    }

    /// Adds the energy (J) of an impulse that was returned to the water.
    pub(crate) fn add_returned(&mut self, energy: f64) {
        self.budget.coupling += energy;
    }

    /// Adds the load of the `ballast` that solid number `i` took on, and the resulting `change` of momentum, to the
    /// breakdown of the solid. `body` is its mass after the change. Locks bear the remainder along locked motions.
    pub(super) fn add_ballast(&mut self, i: usize, body: &FreeBody<D>, ballast: Load<D>, change: Load<D>) {
        let breakdown = &mut self.breakdown[i];
        breakdown.ballast += ballast;
        breakdown.change += change;
        breakdown.locks += locked(body, false, &(change - ballast));
    }

    /// Adds the work of one step on solid number `i` of `system` under the loads of `breakdown`, if the solid is free.
    /// Adds the loads of joints, ropes and locks to `breakdown`.
    pub(super) fn add_body_step(
        &mut self,
        system: &System<D>,
        i: usize,
        mut breakdown: LoadBreakdown<D>,
        loads: &BodyLoads<'_, D>,
    ) {
        let Some(body) = &system.solids()[i].body else { return };
        let BodyLoads { water, constraints, before, after, dt, .. } = *loads;
        (breakdown.viscous, breakdown.pressure) = (self.viscous[i], breakdown.pressure - self.viscous[i]);
        (breakdown.joints, breakdown.ropes) = (constraints.joints, constraints.ropes);
        breakdown.locks = locked(body, constraints.is_held, &breakdown.residual());
        breakdown.assign_residual_to_constraints();
        let mean = Kinematics {
            velocity: 0.5 * (before.velocity + after.velocity),
            spin: (before.spin + after.spin) * 0.5,
            ..*after
        };
        let images = system.solid_multiplicity(i);
        let work = |load: Load<D>| load.power(&mean) * dt * images;
        let budget = &mut self.budget;
        budget.motors += work(breakdown.motors);
        budget.springs += work(breakdown.springs + breakdown.moorings);
        budget.forces += work(breakdown.forces + breakdown.pushes);
        budget.contacts += work(breakdown.contacts);
        budget.joints += work(breakdown.joints + breakdown.ropes);
        let potential_weight = system.potential_gravity() * body.mass;
        let driving = Load { force: breakdown.weight.force - potential_weight, torque: Bivector::zero() };
        budget.driven += work(driving);
        let sunk = potential_weight.dot(&(after.centre - before.centre));
        budget.coupling += work(water + breakdown.weight) - work(driving) - (sunk + self.work[i]) * images;
        self.breakdown[i] = breakdown;
    }
}
