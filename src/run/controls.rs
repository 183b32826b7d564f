//! The numbers of motors and forces that an observer may change while a run goes on.

use crate::{
    error::Result,
    plan::{ControlChange, ControlPlan, ControlTarget, MotorQuantity},
    simulation::Simulation,
    solid::MotorCommand,
};

/// A number that may be changed while a run goes on.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Its key, unit and range.
    pub plan: ControlPlan,
    /// Its value now.
    pub value: f64,
}

/// The controls of a run.
pub(crate) struct Controls {
    /// Each control with the number of its joint or force.
    all: Vec<(ControlPlan, usize)>,
}

impl Controls {
    /// Finds the joints and forces of `sim` that the `plans` change.
    ///
    /// # Errors
    /// `Scene` if there is no such joint or force.
    pub(crate) fn new<const D: usize>(plans: &[ControlPlan], sim: &Simulation<D>) -> Result<Self> {
        let find = |plan: &ControlPlan| {
            let number = match &plan.target {
                ControlTarget::Motor { joint, .. } => sim.find_joint(joint),
                ControlTarget::Force { force, .. } => sim.find_force(force),
            };
            Ok((plan.clone(), number?))
        };
        Ok(Self { all: plans.iter().map(find).collect::<Result<_>>()? })
    }

    /// Returns the controls with their present values.
    pub(crate) fn readings<const D: usize>(&self, sim: &Simulation<D>) -> Vec<Control> {
        self.all.iter().map(|(plan, number)| Control { plan: plan.clone(), value: read(sim, plan, *number) }).collect()
    }

    /// Sets control number `control` and returns the change, or `None` for a control or a value that is not allowed.
    pub(crate) fn set<const D: usize>(
        &self,
        sim: &mut Simulation<D>,
        control: usize,
        value: f64,
    ) -> Option<ControlChange> {
        let (plan, number) = self.all.get(control).filter(|(plan, _)| (plan.min..=plan.max).contains(&value))?;
        write(sim, plan, *number, value);
        let (time, steps) = (sim.time(), sim.steps());
        Some(ControlChange { control, key: plan.key.clone(), value, unit: plan.unit.clone(), time, steps })
    }

    /// Sets the controls to their values after the `changes` again, in a simulation that has returned to an earlier state.
    pub(crate) fn repeat<const D: usize>(&self, sim: &mut Simulation<D>, changes: &[ControlChange]) {
        for change in changes {
            if let Some((plan, number)) = self.all.get(change.control) {
                write(sim, plan, *number, change.value);
            }
        }
    }
}

fn read<const D: usize>(sim: &Simulation<D>, plan: &ControlPlan, number: usize) -> f64 {
    match plan.target {
        ControlTarget::Motor { quantity, .. } => match sim.motor_command(number) {
            Some(mut command) if quantity == MotorQuantity::Degrees => field(&mut command, quantity).to_degrees(),
            Some(mut command) => *field(&mut command, quantity),
            None => 0.0,
        },
        ControlTarget::Force { torque, component, .. } => {
            let command = sim.force_command(number);
            let components = if torque { command.torque } else { command.force };
            components.get(component).copied().unwrap_or(0.0)
        }
    }
}

fn write<const D: usize>(sim: &mut Simulation<D>, plan: &ControlPlan, number: usize, value: f64) {
    match plan.target {
        ControlTarget::Motor { quantity, .. } => {
            if let Some(mut command) = sim.motor_command(number) {
                let value = if quantity == MotorQuantity::Degrees { value.to_radians() } else { value };
                *field(&mut command, quantity) = value;
                sim.set_motor(number, Some(command));
            }
        }
        ControlTarget::Force { torque, component, .. } => {
            let mut command = sim.force_command(number);
            let components = if torque { &mut command.torque } else { &mut command.force };
            if let Some(old) = components.get_mut(component) {
                *old = value;
                sim.set_force(number, Some(command));
            }
        }
    }
}

fn field(command: &mut MotorCommand, quantity: MotorQuantity) -> &mut f64 {
    match quantity {
        MotorQuantity::Force => &mut command.force,
        MotorQuantity::Position | MotorQuantity::Degrees => &mut command.position,
        MotorQuantity::Velocity => &mut command.velocity,
        MotorQuantity::Stiffness => &mut command.stiffness,
        MotorQuantity::Damping => &mut command.damping,
    }
}
