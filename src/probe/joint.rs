//! Reaction and motion of a joint, and the power of its motor. The mean power of a power take-off is the mean of
//! `power`, or the increase of `absorbed` divided by the time.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeReads, ProbeScope, axes};
use crate::{
    error::Result,
    simulation::{Simulation, find_by_name},
    solid::JointKind,
    system::System,
};

/// Plan of a probe of the reaction and motion of a joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JointPlan {
    /// The joint's name.
    pub joint: String,
}

impl ProbeDefinition for JointPlan {
    type Config = String;
    const LABEL: &'static str = "joint";
    const EXAMPLE: &'static str = "joint = \"hinge\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_constraint(key, "joint", config)
    }

    fn from_config(config: &String) -> Self {
        Self { joint: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(config.clone())
    }

    fn is_cumulative(&self, column: &str) -> bool {
        column.starts_with("absorbed_")
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(JointProbe::new(system, &self.joint)?))
    }
}

/// Measures the force (N) and torque (N m) that a joint exerts on its second solid by its locks and end stops. For a hinge or a
/// slider it also measures the angle (deg) or position (m), its rate, the force of the motor, the power absorbed (W)
/// and the energy absorbed (J). For a generic joint it also measures the positions (m) and rotations (deg) in the free
/// modes. Angles, positions and rates are NaN while the joint does not act. Loads and power of a joint that acts are NaN before
/// the first step.
pub struct JointProbe {
    joint: usize,
    kind: JointKind,
    /// Free modes of a generic joint.
    free: Vec<usize>,
}

impl JointProbe {
    /// Creates the probe of the joint called `joint`.
    ///
    /// # Errors
    /// `Scene` if there is no such joint.
    pub fn new<const D: usize>(system: &System<D>, joint: &str) -> Result<Self> {
        let joints = &system.constraints().joints;
        let joint = find_by_name("joint", joint, joints.iter().map(|joint| joint.name.as_str()))?;
        let free = joints[joint].free_modes.iter().map(|free| free.mode).collect();
        Ok(Self { joint, kind: joints[joint].kind, free })
    }
}

/// Returns the number of columns of force and torque.
const fn load_columns<const D: usize>() -> usize {
    D + D * (D - 1) / 2
}

/// Returns the name of the column with the coordinate of `mode`.
fn coordinate_column<const D: usize>(mode: usize) -> String {
    match mode.checked_sub(D) {
        None => format!("{}_m", axes::<D>()[mode]),
        Some(_) if D == 2 => "turn_deg".into(),
        Some(axis) => format!("turn_{}_deg", axes::<D>()[axis]),
    }
}

impl<const D: usize> Probe<D> for JointProbe {
    fn reads(&self) -> ProbeReads {
        ProbeReads::Solids
    }

    fn columns(&self) -> Vec<String> {
        let wide = if D == 2 { "_per_m" } else { "" };
        let mut columns: Vec<String> = axes::<D>().iter().map(|a| format!("f{a}_N{wide}")).collect();
        match D {
            2 => columns.push("torque_Nm_per_m".into()),
            _ => columns.extend(axes::<D>().iter().map(|a| format!("t{a}_Nm"))),
        }
        let own = match self.kind {
            JointKind::Hinge => ["angle_deg", "rate_radps", "motor_Nm"],
            JointKind::Slider => ["position_m", "rate_mps", "motor_N"],
            JointKind::Generic => {
                columns.extend(self.free.iter().map(|&mode| coordinate_column::<D>(mode)));
                return columns;
            }
            JointKind::Fixed | JointKind::Ball | JointKind::Tow => return columns,
        };
        let [position, rate, motor] = own.map(String::from);
        let motor = [motor, "power_W".into(), "absorbed_J".into()].map(|name| name + wide);
        columns.extend([position, rate].into_iter().chain(motor));
        columns
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let now = sim.joint_reading(self.joint);
        let acts = sim.joint_acts(self.joint);
        let if_known = |load: f64| if acts && sim.steps() == 0 { f64::NAN } else { load };
        let mut row: Vec<f64> = now.force.iter().copied().chain(now.torque.axial()).map(if_known).collect();
        // While the joint does not act, its solids are not in its frame.
        let if_acting = |x: f64| if acts { x } else { f64::NAN };
        let position = match self.kind {
            JointKind::Hinge => now.position.to_degrees(),
            JointKind::Slider => now.position,
            JointKind::Generic => {
                let turned = |(x, &mode): (f64, &usize)| if_acting(if mode < D { x } else { x.to_degrees() });
                row.extend(sim.joint_coordinates(self.joint).into_iter().zip(&self.free).map(turned));
                return row;
            }
            JointKind::Fixed | JointKind::Ball | JointKind::Tow => return row,
        };
        row.extend([
            if_acting(position),
            if_acting(now.rate),
            if_known(now.motor_force),
            if_known(now.absorbed_power()),
            now.absorbed_energy,
        ]);
        row
    }

    fn follows_angles(&self) -> bool {
        self.free.iter().any(|&mode| mode >= D)
    }

    fn continue_from(&self, before: &[f64], now: &mut [f64], _: f64) {
        // The angle of a hinge counts its turns itself.
        let turns = (0..self.free.len()).filter(|&i| self.free[i] >= D);
        for angle in turns.map(|i| load_columns::<D>() + i) {
            now[angle] = super::motion::unwrapped(before[angle], now[angle]);
        }
    }
}
