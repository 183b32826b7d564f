//! Constraint rows between two solids: directions of relative motion, and the loads along them.
//!
//! A row J maps the velocities of two solids to a rate, ẋ = J v. An impulse λ along the row acts on the second solid with λ Jᵀ,
//! and on the first with the opposite. With M⁻¹ of both solids, J M⁻¹ Jᵀ is the inverse effective mass, 1/kg or 1/(kg m²).

use nalgebra::SMatrix;

use crate::{
    math::{Bivector, Pose, Vector},
    solid::{Kinematics, Load},
};

/// Inverse mass and inertia of a solid: zero where it is not free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mobility<const D: usize> {
    /// One over the mass, along each axis, 1/kg.
    pub linear: Vector<D>,
    /// Inverse of the inertia about the centre of mass in the world's axes, 1/(kg m²); in 2-D the number stands in `[(0, 0)]`.
    pub angular: SMatrix<f64, 3, 3>,
}

impl<const D: usize> Mobility<D> {
    /// The mobility of a solid that is not free.
    pub(crate) fn none() -> Self {
        Self { linear: Vector::zeros(), angular: SMatrix::zeros() }
    }

    /// The spin (rad/s) that the angular impulse `torque` (N m s) gives.
    pub(in crate::solid) fn spin_change(&self, torque: &Bivector<D>) -> Bivector<D> {
        let torque = torque.axial();
        let mut spin = [0.0; 3];
        for (i, spin) in spin.iter_mut().enumerate() {
            *spin = torque.iter().enumerate().map(|(j, t)| self.angular[(i, j)] * t).sum();
        }
        Bivector::from_axial(&spin)
    }
}

/// A row of two solids.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct ConstraintJacobian<const D: usize> {
    along: Vector<D>,
    about: [Bivector<D>; 2],
}

impl<const D: usize> ConstraintJacobian<D> {
    /// Along the unit vector `n`, at the world point `x` (m) of both.
    pub(in crate::solid) fn at_point(n: Vector<D>, x: &Vector<D>, ends: &[Kinematics<D>; 2]) -> Self {
        Self::between_points(n, &[*x, *x], ends)
    }

    /// Along the unit vector `n`, at a world point (m) of each.
    pub(in crate::solid) fn between_points(n: Vector<D>, places: &[Vector<D>; 2], ends: &[Kinematics<D>; 2]) -> Self {
        Self { along: n, about: [0, 1].map(|k| Bivector::torque(&(places[k] - ends[k].centre), &n)) }
    }

    /// About the axis `a`.
    pub(in crate::solid) fn about_axis(a: Bivector<D>) -> Self {
        Self { along: Vector::zeros(), about: [a, a] }
    }

    /// Rate of the second solid relative to the first along it, m/s or rad/s.
    pub(in crate::solid) fn rate(&self, ends: &[Kinematics<D>; 2]) -> f64 {
        let [first, second] = ends;
        self.along.dot(&(second.velocity - first.velocity)) + self.about[1].power(&second.spin)
            - self.about[0].power(&first.spin)
    }

    /// Acceleration along it under a load on each solid, m/s² or rad/s².
    pub(in crate::solid) fn acceleration(&self, loads: &[Load<D>; 2], mobility: &[Mobility<D>; 2]) -> f64 {
        let [first, second] = [0, 1].map(|k| {
            let velocity = mobility[k].linear.component_mul(&loads[k].force);
            self.along.dot(&velocity) + self.about[k].power(&mobility[k].spin_change(&loads[k].torque))
        });
        second - first
    }

    /// The loads of a `force` (N or N m) along the row on the first and on the second solid, about their centres.
    pub(in crate::solid) fn loads(&self, force: f64) -> [Load<D>; 2] {
        let load = |k: usize, f: f64| Load { force: self.along * f, torque: self.about[k] * f };
        [load(0, -force), load(1, force)]
    }

    /// J M⁻¹ J'ᵀ with another row.
    pub(in crate::solid) fn inverse_effective_mass(&self, other: &Self, mobility: &[Mobility<D>; 2]) -> f64 {
        let each = mobility.iter().zip(self.about.iter().zip(&other.about));
        each.map(|(m, (a, b))| self.along.dot(&m.linear.component_mul(&other.along)) + a.power(&m.spin_change(b))).sum()
    }

    /// Inverse effective mass of each end alone.
    pub(in crate::solid) fn inverse_effective_mass_of_ends(&self, mobility: &[Mobility<D>; 2]) -> [f64; 2] {
        let still = Mobility::none();
        [[mobility[0], still], [still, mobility[1]]].map(|one| self.inverse_effective_mass(self, &one))
    }

    fn less(&self, other: &Self, part: f64) -> Self {
        let about = [0, 1].map(|k| self.about[k] + other.about[k] * -part);
        Self { along: self.along - other.along * part, about }
    }
}

/// Kinematics of the solid at an end; the world is at rest.
pub(in crate::solid) fn kinematics_of_end<const D: usize>(
    end: Option<usize>,
    solids: &[Kinematics<D>],
) -> Kinematics<D> {
    let world = Kinematics {
        pose: Pose::identity(),
        centre: Vector::zeros(),
        velocity: Vector::zeros(),
        spin: Bivector::zero(),
    };
    end.and_then(|solid| solids.get(solid)).copied().unwrap_or(world)
}

/// Orthogonalises each row against those before it among the first `locks` (Gram–Schmidt): the rows along which the
/// engine reports its impulses.
pub(in crate::solid) fn orthogonalize<const D: usize>(
    rows: &mut [ConstraintJacobian<D>],
    locks: usize,
    mobility: &[Mobility<D>; 2],
) {
    for j in 0..locks {
        let done = rows[j];
        let own = done.inverse_effective_mass(&done, mobility);
        if own > 0.0 {
            for row in &mut rows[j + 1..] {
                *row = row.less(&done, row.inverse_effective_mass(&done, mobility) / own);
            }
        }
    }
}
