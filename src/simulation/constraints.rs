//! Joints, springs and ropes of a running simulation: to be found by name, read, and driven by a program.

use super::Simulation;
use crate::{
    error::{Error, ErrorCode, Result, nearest_name},
    math::Matrix,
    solid::{
        ConstraintEvent, ForceCommand, JointReading, JointSpec, LineReading, MooringReading, MotorCommand,
        SpringParameters,
    },
};

impl<const D: usize> Simulation<D> {
    /// Number of the joint called `name`.
    ///
    /// # Errors
    /// `Scene` if there is none: says the nearest name, or all of them.
    pub fn find_joint(&self, name: &str) -> Result<usize> {
        find_by_name("joint", name, self.system.constraints().joints.iter().map(|joint| joint.name.as_str()))
    }

    /// Number of the spring called `name`.
    ///
    /// # Errors
    /// As [`Simulation::find_joint`].
    pub fn find_spring(&self, name: &str) -> Result<usize> {
        find_by_name("spring", name, self.system.constraints().springs.iter().map(|spring| spring.name.as_str()))
    }

    /// Number of the force called `name`.
    ///
    /// # Errors
    /// As [`Simulation::find_joint`].
    pub fn find_force(&self, name: &str) -> Result<usize> {
        find_by_name("force", name, self.system.constraints().forces.iter().map(|force| force.name.as_str()))
    }

    /// Beginnings and ends of joints, springs, ropes and solids so far, in their order.
    pub fn events(&self) -> &[ConstraintEvent] {
        self.bodies.constraints().events()
    }

    /// The longest step (s) that springs and the stiffness of motors allow now; infinite if there are none.
    pub(crate) fn spring_step_limit(&self) -> f64 {
        self.bodies.step_limit(&self.system, self.clock.time)
    }

    /// The readings of joint number `joint` in the last step.
    pub fn joint_reading(&self, joint: usize) -> JointReading<D> {
        self.bodies.constraints().joint_reading(joint)
    }

    /// Whether joint number `joint` acted in the last step.
    pub(crate) fn joint_acts(&self, joint: usize) -> bool {
        self.bodies.constraints().joint_acts(joint)
    }

    /// A message for each joint that is violated now: its ends are more than 0.1 dp or one degree apart.
    pub fn violated_joints(&self) -> Vec<String> {
        let solids: Vec<_> = self.system.solids().iter().map(|solid| solid.kinematics).collect();
        let said = |(i, joint): (usize, &JointSpec<D>)| {
            let [apart, turned] = self.bodies.constraints().joint_gap(i, &solids);
            (apart > 0.1 * self.system.model().dp || turned.to_degrees() > 1.0).then(|| {
                format!(
                    "joint \"{}\" is torn by {apart:.4} m and {:.2} degrees: what else holds its solids (another joint, \
                     `locked`, a wall) contradicts it, so that what it carries says nothing",
                    joint.name,
                    turned.to_degrees()
                )
            })
        };
        self.system.constraints().joints.iter().enumerate().filter_map(said).collect()
    }

    /// Where generic joint number `joint` is: the coordinates of the modes in its list, m or rad (−π to π) from the start.
    pub(crate) fn joint_coordinates(&self, joint: usize) -> Vec<f64> {
        let solids: Vec<_> = self.system.solids().iter().map(|solid| solid.kinematics).collect();
        self.bodies.constraints().joint_coordinates(joint, &solids)
    }

    /// The present readings of spring number `spring`.
    pub fn spring_reading(&self, spring: usize) -> LineReading {
        self.bodies.constraints().spring_reading(spring)
    }

    /// Number of the mooring line called `name`.
    ///
    /// # Errors
    /// As [`Simulation::find_joint`].
    pub fn find_mooring(&self, name: &str) -> Result<usize> {
        find_by_name("mooring", name, self.system.constraints().moorings.iter().map(|mooring| mooring.name.as_str()))
    }

    /// Shape and tension of mooring line number `mooring` now.
    pub fn mooring_reading(&self, mooring: usize) -> MooringReading<D> {
        self.bodies.moorings.reading(&self.system, mooring)
    }

    /// Stiffness (N/m; N/m² in 2-D) of the mooring lines on solid number `solid` against surge.
    pub(crate) fn mooring_surge_stiffness(&self, solid: usize) -> f64 {
        self.bodies.moorings.surge_stiffness(&self.system, solid)
    }

    /// Stiffness (N/m; N/m² in 2-D) of mooring line number `mooring` against displacements of its end `end`, 0 or 1.
    pub(crate) fn mooring_end_stiffness(&self, mooring: usize, end: usize) -> Matrix<D> {
        self.bodies.moorings.end_stiffness(&self.system, mooring, end)
    }

    /// Nodes of mooring line number `mooring` that lie on fixed solids, from the first end on.
    pub(crate) fn mooring_lying_nodes(&self, mooring: usize) -> Vec<usize> {
        self.bodies.moorings.lying_nodes(&self.system, mooring)
    }

    /// Whether mooring line number `mooring` acts.
    pub(crate) fn mooring_acts(&self, mooring: usize) -> bool {
        self.bodies.moorings.acts(mooring)
    }

    /// Longest inner step of mooring line number `mooring`, s.
    pub(crate) fn mooring_step(&self, mooring: usize) -> f64 {
        self.bodies.moorings.line_step(mooring)
    }

    /// Shapes and tensions of all mooring lines now, in the order of the setup.
    pub fn mooring_readings(&self) -> Vec<MooringReading<D>> {
        (0..self.system.constraints().moorings.len()).map(|i| self.mooring_reading(i)).collect()
    }

    /// Whether rope number `rope` acted in the last step.
    pub(crate) fn rope_acts(&self, rope: usize) -> bool {
        self.bodies.constraints().rope_acts(rope)
    }

    /// The readings of rope number `rope` in the last step.
    pub fn rope_reading(&self, rope: usize) -> LineReading {
        self.bodies.constraints().rope_reading(rope)
    }

    /// Drives joint number `joint`, a hinge or a slider, with this command from now on, in place of its own motor; `None`
    /// restores its own motor. A checkpoint stores the command.
    pub fn set_motor(&mut self, joint: usize, drive: Option<MotorCommand>) {
        self.bodies.constraints_mut().set_motor(joint, drive);
    }

    /// The command of the motor of joint number `joint` now: that set by a program, or that of its own motor; `None` if it has
    /// neither.
    pub fn motor_command(&self, joint: usize) -> Option<MotorCommand> {
        self.bodies.constraints().motor_command(joint, self.clock.time)
    }

    /// Gives force number `force` these components from now on, in place of its own; `None` restores its own components. A
    /// checkpoint stores the command.
    pub fn set_force(&mut self, force: usize, command: Option<ForceCommand>) {
        self.bodies.constraints_mut().set_force(force, command);
    }

    /// The components of force number `force` now: those set by a program, or its own.
    pub fn force_command(&self, force: usize) -> ForceCommand {
        self.bodies.constraints().force_command(force, self.clock.time)
    }

    /// Stiffness, damping and rest length of spring number `spring`. A program may read and change them; a checkpoint stores
    /// them.
    pub fn spring_parameters(&mut self, spring: usize) -> &mut SpringParameters {
        self.bodies.constraints_mut().spring_parameters(spring)
    }
}

/// The number of `name` among `names` of a `kind` of things.
pub(crate) fn find_by_name<'a>(kind: &str, name: &str, names: impl Iterator<Item = &'a str> + Clone) -> Result<usize> {
    names.clone().position(|known| known == name).ok_or_else(|| {
        let help = match nearest_name(name, names.clone()) {
            Some(near) => format!("did you mean {near:?}?"),
            None => format!("the {kind}s are: {}", names.collect::<Vec<_>>().join(", ")),
        };
        Error::scene(format!("there is no {kind} called {name:?}")).with_code(ErrorCode::UnknownName).help(help)
    })
}
