//! Prescribed forces and torques on a free solid, such as wind or a thruster.

use serde::{Deserialize, Serialize};

use crate::{
    math::{Bivector, Matrix, Vector, rotated_tensor},
    solid::{Kinematics, Lifetime, Load, TimeFunction},
};

/// A force and a torque on a solid, as functions of time.
///
/// ```
/// use pontoon::solid::ForceSpec;
///
/// // 20 N on the centre of mass of solid number 1.
/// let thrust = ForceSpec::<2>::new("thrust", 1).force([20.0, 0.0]).rotating_with_solid();
/// assert!(thrust.torque.is_empty());
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
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
    /// Whether the axes are the solid's own, and turn with it; else they are the world's.
    pub rotates_with_solid: bool,
    /// When it acts; it does not break.
    pub lifetime: Lifetime,
}

/// The components of a force and a torque at an instant; the fields are those of [`ForceSpec`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceCommand {
    /// Components of the force, N (N/m in 2-D).
    pub force: Vec<f64>,
    /// Axial components of the torque, N m (N m/m in 2-D).
    pub torque: Vec<f64>,
}

impl<const D: usize> ForceSpec<D> {
    /// A load without force and torque, on the centre of mass of solid number `solid`, along the axes of the world.
    pub fn new(name: impl Into<String>, solid: usize) -> Self {
        Self {
            name: name.into(),
            solid,
            at: None,
            force: Vec::new(),
            torque: Vec::new(),
            rotates_with_solid: false,
            lifetime: Lifetime::default(),
        }
    }

    /// The same load with a force, one component along each axis, N (N/m in 2-D).
    pub fn force<F: Into<TimeFunction>>(mut self, force: impl IntoIterator<Item = F>) -> Self {
        self.force = force.into_iter().map(Into::into).collect();
        self
    }

    /// The same load with a torque, N m (N m/m in 2-D): one axial component in 2-D, three in 3-D.
    pub fn torque<F: Into<TimeFunction>>(mut self, torque: impl IntoIterator<Item = F>) -> Self {
        self.torque = torque.into_iter().map(Into::into).collect();
        self
    }

    /// The same load on the point of the solid that is at this world point (m) at the start.
    pub fn at(self, at: impl Into<Vector<D>>) -> Self {
        Self { at: Some(at.into()), ..self }
    }

    /// The same load along the axes of the solid, which turn with it.
    pub fn rotating_with_solid(self) -> Self {
        Self { rotates_with_solid: true, ..self }
    }

    /// Its force (N) and torque (N m) on the solid turned by `rotation`, if its components do not change with time.
    pub(crate) fn steady_load(&self, rotation: &Matrix<D>) -> Option<(Vector<D>, Bivector<D>)> {
        let steady = |laws: &[TimeFunction]| laws.iter().map(TimeFunction::steady_value).collect::<Option<Vec<f64>>>();
        let (force, turns) = (steady(&self.force)?, steady(&self.torque)?);
        let force = Vector::from_fn(|i, _| force.get(i).copied().unwrap_or(0.0));
        Some(self.in_world((force, Bivector::from_axial(&turns)), rotation))
    }

    /// A force and a torque along its axes, in the world's axes with the solid turned by `rotation`.
    fn in_world(&self, (force, torque): (Vector<D>, Bivector<D>), rotation: &Matrix<D>) -> (Vector<D>, Bivector<D>) {
        if !self.rotates_with_solid {
            return (force, torque);
        }
        (rotation * force, Bivector(rotated_tensor(rotation, &torque.0)))
    }

    /// The same load with this lifetime.
    pub fn lifetime(self, lifetime: Lifetime) -> Self {
        Self { lifetime, ..self }
    }

    /// Its components at time `t` (s).
    pub fn command_at(&self, t: f64) -> ForceCommand {
        let values = |laws: &[TimeFunction]| laws.iter().map(|law| law.value_and_rate(t).0).collect();
        ForceCommand { force: values(&self.force), torque: values(&self.torque) }
    }

    /// The load about the centre of the solid at time `t` (s), with the components `set` by a program, or else its own. `start`
    /// and `now` are the kinematics of the solid at the start and at present.
    pub(super) fn load_at(
        &self,
        start: &Kinematics<D>,
        now: &Kinematics<D>,
        set: Option<&ForceCommand>,
        t: f64,
    ) -> Load<D> {
        if !self.lifetime.contains(t) {
            return Load::zero();
        }
        let ForceCommand { force, torque } = set.cloned().unwrap_or_else(|| self.command_at(t));
        let force = Vector::from_fn(|i, _| force.get(i).copied().unwrap_or(0.0));
        let (force, torque) = self.in_world((force, Bivector::from_axial(&torque)), &now.pose.rotation);
        let at = self.at.map_or(now.centre, |at| now.pose.point(&start.pose.local(&at)));
        Load { force, torque: torque + Bivector::torque(&(at - now.centre), &force) }
    }
}
