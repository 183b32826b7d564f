//! The loads on each free body in the last step, by their origin.

use serde::{Deserialize, Serialize};

use crate::{
    math::{Bivector, Matrix, Vector, rotated_tensor},
    solid::{ContactForce, FreeBody, Kinematics, Load, constraint::assembly::ConstraintLoads},
    system::System,
};

/// The loads on a free body in the last step, about its centre of mass, by their origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadBreakdown<const D: usize> {
    /// Pressure of the water.
    pub pressure: Load<D>,
    /// Viscosity of the water.
    pub viscous: Load<D>,
    /// Deferred impulse, due to the acoustic added mass and the two-step interval of the Verlet scheme.
    pub delayed: Load<D>,
    /// Weight.
    pub weight: Load<D>,
    /// Contacts, friction included.
    pub contacts: Load<D>,
    /// Locks and end stops of joints.
    pub joints: Load<D>,
    /// Ropes.
    pub ropes: Load<D>,
    /// Springs, and mooring lines without mass.
    pub springs: Load<D>,
    /// Mooring lines with mass.
    pub moorings: Load<D>,
    /// Motors of joints.
    pub motors: Load<D>,
    /// The scene's forces.
    pub forces: Load<D>,
    /// Loads that a program adds with `push`.
    pub pushes: Load<D>,
    /// Momentum that ballast brought at the end of the step, divided by the step; negative where ballast left.
    pub ballast: Load<D>,
    /// Reaction of locked motions: by definition the negative sum of the other loads along these motions.
    pub locks: Load<D>,
    /// Rate of change of momentum and angular momentum, including that of ballast. For a 3-D body in a joint, on a rope or partly
    /// locked, the rate of angular momentum is the expression that the engine integrates, I(R₀) ΔΩ/Δt + Ω ∧ I Ω.
    pub change: Load<D>,
}

impl<const D: usize> LoadBreakdown<D> {
    /// Returns a breakdown in which every load is zero.
    pub(crate) fn zero() -> Self {
        let none = Load::zero();
        Self {
            pressure: none,
            viscous: none,
            delayed: none,
            weight: none,
            contacts: none,
            joints: none,
            ropes: none,
            springs: none,
            moorings: none,
            motors: none,
            forces: none,
            pushes: none,
            ballast: none,
            locks: none,
            change: none,
        }
    }

    /// Returns all loads with their names, without the change of momentum.
    pub fn kinds(&self) -> [(&'static str, Load<D>); 14] {
        [
            ("pressure", self.pressure),
            ("viscous", self.viscous),
            ("delayed", self.delayed),
            ("weight", self.weight),
            ("contacts", self.contacts),
            ("joints", self.joints),
            ("ropes", self.ropes),
            ("springs", self.springs),
            ("moorings", self.moorings),
            ("motors", self.motors),
            ("forces", self.forces),
            ("pushes", self.pushes),
            ("locks", self.locks),
            ("ballast", self.ballast),
        ]
    }

    /// Returns the sum of all loads.
    pub(crate) fn sum(&self) -> Load<D> {
        self.kinds().into_iter().map(|(_, load)| load).sum()
    }

    /// Returns the change of momentum less the sum of all loads.
    pub fn residual(&self) -> Load<D> {
        self.change - self.sum()
    }

    /// Assigns the residual to the joints or the ropes, whichever have the larger force. Joints and ropes rotate within a step, but the
    /// directions of their reported forces do not.
    pub(super) fn assign_residual_to_constraints(&mut self) {
        let rest = self.residual();
        let constraints =
            if self.joints.force.norm() >= self.ropes.force.norm() { &mut self.joints } else { &mut self.ropes };
        if *constraints != Load::zero() {
            *constraints += rest;
        }
    }

    /// Returns the loads on solid number `i` in a step, without joints, ropes and locks. The whole load of the water
    /// counts as pressure. All loads are zero unless the solid is free.
    pub(super) fn of(system: &System<D>, i: usize, loads: &BodyLoads<'_, D>) -> Self {
        let solid = &system.solids()[i];
        let Some(body) = &solid.body else { return Self::zero() };
        let BodyLoads { water, pushes, contacts, constraints, moorings, before, after, gyroscopic, dt, .. } = *loads;
        let change = (momentum(body, after) - momentum(body, before)) * (1.0 / dt);
        Self {
            pressure: solid.load,
            delayed: water - solid.load,
            weight: Load { force: system.gravity() * body.mass, torque: Bivector::zero() },
            contacts,
            springs: constraints.springs,
            moorings,
            motors: constraints.motors,
            forces: constraints.forces,
            pushes,
            change: Load { torque: gyroscopic.unwrap_or(change.torque), ..change },
            ..Self::zero()
        }
    }
}

/// The loads on a free body in a step, and its motion.
pub(super) struct BodyLoads<'a, const D: usize> {
    /// Load of the water that the step applied.
    pub(super) water: Load<D>,
    pub(super) pushes: Load<D>,
    pub(super) contacts: Load<D>,
    pub(super) constraints: ConstraintLoads<D>,
    /// Load of the mooring lines with mass.
    pub(super) moorings: Load<D>,
    pub(super) before: &'a Kinematics<D>,
    pub(super) after: &'a Kinematics<D>,
    /// I₀ΔΩ/Δt minus the gyroscopic torque, if the engine integrates the angular velocity.
    pub(super) gyroscopic: Option<Bivector<D>>,
    pub(super) dt: f64,
}

/// Returns the sum of all `contacts` on each of `solids` solids.
pub(super) fn contact_sums<const D: usize>(contacts: &[ContactForce<D>], solids: usize) -> Vec<Load<D>> {
    let mut sums = vec![Load::zero(); solids];
    for (solid, load) in contacts.iter().flat_map(|contact| contact.between.into_iter().zip(contact.loads)) {
        sums[solid] += load;
    }
    sums
}

/// Returns the momentum, kg m/s, and the angular momentum about the centre of mass, kg m²/s.
pub(super) fn momentum<const D: usize>(body: &FreeBody<D>, motion: &Kinematics<D>) -> Load<D> {
    Load {
        force: motion.velocity * body.mass,
        torque: angular_momentum(&body.inertia, &motion.pose.rotation, &motion.spin),
    }
}

/// Returns the angular momentum I Ω in the world axes. The inertia is in the axes of the body.
fn angular_momentum<const D: usize>(inertia: &Matrix<D>, rotation: &Matrix<D>, spin: &Bivector<D>) -> Bivector<D> {
    if D == 2 {
        return *spin * inertia[(0, 0)];
    }
    let world = rotated_tensor(rotation, inertia) * Vector::<D>::from_iterator(spin.axial());
    Bivector::from_axial(world.as_slice())
}

/// Returns the part of `load` along the locked motions of `body`, or the whole load if the body is `held`.
pub(super) fn locked<const D: usize>(body: &FreeBody<D>, held: bool, load: &Load<D>) -> Load<D> {
    let force = Vector::from_fn(|i, _| if held || body.locked_translations[i] { load.force[i] } else { 0.0 });
    let turns = load.torque.axial().into_iter().enumerate();
    let torque: Vec<f64> = turns.map(|(i, t)| if held || body.locked_rotations[i] { t } else { 0.0 }).collect();
    Load { force, torque: Bivector::from_axial(&torque) }
}
