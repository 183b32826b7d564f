//! The turn of a floating body from its start to rest.
//!
//! A body that is turned at constant displacement has, together with the still water, the energy
//!
//!   E = m g (z_G − z_B),   dE = −T·dφ
//!
//! G is the body's centre of mass, B the centroid of the displaced water, and T their moment about the horizontal axes. The body
//! turns from its start to the first minimum of E as E falls, by Newton's method with steps of a few degrees at most.
//! Near a maximum of E along an axis, the step has the sign of the moment, and so leads away from the maximum.

use nalgebra::{DMatrix, DVector, Dyn, SymmetricEigen};

use super::{FreeBody, hydrostatics::Hull};
use crate::math::{Bivector, Matrix, Pose, Vector};

/// Largest turn (rad) of a step.
const LONGEST: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// Turn (rad) of a step below which the body is at rest.
const SHORTEST: f64 = 1e-4;
/// Turn (rad) away from an unstable equilibrium.
const NUDGE: f64 = std::f64::consts::PI / 180.0;
/// Half of the angle (rad) of the difference that gives a stiffness.
const TILT: f64 = 1e-4;
/// Most steps to rest.
const STEPS: usize = 1000;

/// The end of a turn, with its angle (rad) from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Turn {
    /// The body is at rest.
    Rests(f64),
    /// The water stands at the rim of its hull.
    Floods(f64),
}

/// A body that floats without ties.
pub(crate) struct Floating<'a, const D: usize> {
    pub(crate) hull: &'a Hull<'a, D>,
    pub(crate) body: &'a FreeBody<D>,
    pub(crate) pose: Pose<D>,
    /// Density of the water, kg/m³.
    pub(crate) rho0: f64,
    /// Height of the still water, m.
    pub(crate) level: f64,
    /// Numbers of the axial components about which it can turn.
    pub(crate) free: Vec<usize>,
    /// Metacentric height (m), and righting lever (m), below which it is neutral.
    pub(crate) neutral: f64,
}

/// A turned body, afloat.
struct Turned {
    /// E/(m g), m.
    energy: f64,
    /// T/(m g) about the free axes, m.
    lever: DVector<f64>,
}

impl<const D: usize> Floating<'_, D> {
    /// Returns the turn from the start to rest; `None` if it does not float at the start.
    pub(crate) fn turn(&self) -> Option<Turn> {
        let (mut turned, mut along) = (Matrix::identity(), 0.0);
        let mut here = self.at(&turned)?;
        if self.free.is_empty() {
            return Some(Turn::Rests(0.0));
        }
        // In 3-D the angle is that of the vertical.
        let angle = |turned: &Matrix<D>, along: f64| match D {
            2 => f64::abs(along),
            _ => turned[(D - 1, D - 1)].clamp(-1.0, 1.0).acos(),
        };
        for _ in 0..STEPS {
            let Some(mut step) = self.step(&turned, &here.lever) else {
                return Some(Turn::Floods(angle(&turned, along)));
            };
            while step.norm() >= SHORTEST {
                let next = self.turn_by(&step) * turned;
                match self.at(&next) {
                    Some(there) if there.energy < here.energy => {
                        (turned, along, here) = (next, along + step[0], there);
                        break;
                    }
                    None if step.norm() < 2.0 * SHORTEST => return Some(Turn::Floods(angle(&turned, along))),
                    _ => step *= 0.5,
                }
            }
            if step.norm() < SHORTEST {
                break;
            }
        }
        Some(Turn::Rests(angle(&turned, along)))
    }

    /// Returns the least metacentric height (m) at the start; `None` if the body cannot turn or does not float.
    pub(crate) fn least_metacentric_height(&self) -> Option<f64> {
        self.stiffness(&Matrix::identity())?.eigenvalues.iter().copied().reduce(f64::min)
    }

    /// Returns the metacentric heights (m) and their axes. `None` if the body cannot turn, or if a slightly different turn floods
    /// the hull.
    fn stiffness(&self, turned: &Matrix<D>) -> Option<SymmetricEigen<f64, Dyn>> {
        let n = self.free.len();
        if n == 0 {
            return None;
        }
        let mut stiffness = DMatrix::zeros(n, n);
        for k in 0..n {
            let tilted = |angle: f64| {
                let mut turn = DVector::zeros(n);
                turn[k] = angle;
                self.at(&(self.turn_by(&turn) * turned))
            };
            let slope = (tilted(-TILT)?.lever - tilted(TILT)?.lever) / (2.0 * TILT);
            stiffness.set_column(k, &slope);
        }
        Some(SymmetricEigen::new((&stiffness + stiffness.transpose()) * 0.5))
    }

    /// Returns the next step (rad, about the free axes); `None` if a slightly different turn floods the hull.
    fn step(&self, turned: &Matrix<D>, lever: &DVector<f64>) -> Option<DVector<f64>> {
        let eigen = self.stiffness(turned)?;
        let mut step = DVector::zeros(self.free.len());
        for (stiff, axis) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            let own = lever.dot(&axis);
            let part = match stiff.abs() < self.neutral {
                true if own.abs() < self.neutral => 0.0,
                _ if *stiff < 0.0 && own.abs() < -stiff * NUDGE => NUDGE.copysign(own),
                _ => own / stiff.abs().max(self.neutral),
            };
            step += axis * part;
        }
        let longest = step.norm();
        Some(if longest > LONGEST { step * (LONGEST / longest) } else { step })
    }

    /// Returns the rotation by this step.
    fn turn_by(&self, step: &DVector<f64>) -> Matrix<D> {
        let mut axial = [0.0; 3];
        self.free.iter().zip(step.iter()).for_each(|(axis, angle)| axial[*axis] = *angle);
        Bivector::from_axial(&axial).exp()
    }

    /// Returns the body turned by `turned`, at its displacement; `None` if it floods.
    fn at(&self, turned: &Matrix<D>) -> Option<Turned> {
        let centre = self.pose.point(&self.body.centre);
        let mut pose =
            Pose { position: centre + turned * (self.pose.position - centre), rotation: turned * self.pose.rotation };
        pose.position[D - 1] += self.hull.rise_afloat(&pose, self.body.mass / self.rho0, self.level)?;
        let arm = self.hull.submerged_volume(&pose, self.level).1 - pose.point(&self.body.centre);
        let mut up = Vector::zeros();
        up[D - 1] = 1.0;
        let torque = Bivector::torque(&arm, &up).axial();
        let lever = DVector::from_iterator(self.free.len(), self.free.iter().map(|axis| torque[*axis]));
        Some(Turned { energy: -arm[D - 1], lever })
    }
}

#[cfg(test)]
#[path = "../../tests/unit/solid/righting.rs"]
mod tests;
