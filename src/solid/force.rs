//! Prescribed forces and torques on a free solid, such as wind or a thruster.

use crate::{
    math::{Bivector, Vector},
    solid::{Kinematics, Load, TimeFunction},
};

/// A force and a torque on a solid, after laws of time.
#[derive(Clone, Debug)]
pub struct ForceSpec<const D: usize> {
    /// Its name.
    pub name: String,
    /// Number of the solid.
    pub solid: usize,
    /// The point of the solid that is here at the start, m; `None`: its centre of mass.
    pub at: Option<Vector<D>>,
    /// Components of the force, N (N/m in 2-D): none, or one along each axis.
    pub force: Vec<TimeFunction>,
    /// Axial components of the torque, N m (N m/m in 2-D): none, one in 2-D, three in 3-D.
    pub torque: Vec<TimeFunction>,
    /// Whether the axes, the world's at the start, turn with the solid.
    pub rotates_with_solid: bool,
}

impl<const D: usize> ForceSpec<D> {
    /// The load about the centre of the solid, which started as `start` and is now as `now`, at time `t` (s).
    pub(super) fn load_at(&self, start: &Kinematics<D>, now: &Kinematics<D>, t: f64) -> Load<D> {
        let value = |laws: &[TimeFunction], i: usize| laws.get(i).map_or(0.0, |law| law.value_and_rate(t).0);
        let mut force = Vector::from_fn(|i, _| value(&self.force, i));
        let turns: Vec<f64> = (0..self.torque.len()).map(|i| value(&self.torque, i)).collect();
        let mut torque = Bivector::from_axial(&turns);
        if self.rotates_with_solid {
            let turn = now.pose.rotation * start.pose.rotation.transpose();
            (force, torque) = (turn * force, Bivector(turn * torque.0 * turn.transpose()));
        }
        let at = self.at.map_or(now.centre, |at| now.pose.point(&start.pose.local(&at)));
        Load { force, torque: torque + Bivector::torque(&(at - now.centre), &force) }
    }
}
