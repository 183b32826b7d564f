//! Position, angles and velocity of a solid.
//!
//! Surge, sway and heave are displacements of the solid's centre from the start along x, y (3-D) and up. In a solid with ballast
//! the centre of mass moves; the centre is then the point of the solid at which the centre of mass is at the start. In 2-D pitch
//! is the angle of the solid's frame, counter-clockwise. In 3-D the frame is turned by roll about x, then pitch about y, then yaw
//! about z (right-handed, world axes): R = R_z R_y R_x. Two triples of angles belong to a rotation, of which one has its pitch beyond
//! 90°; a reading continues the one before.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeReads, ProbeScope, axes, empty_row, find_solid};
use crate::{
    error::Result,
    math::{Matrix, Vector},
    simulation::Simulation,
    system::System,
};

/// Plan of a probe of the motion of a solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct MotionPlan {
    /// The solid's name.
    pub solid: String,
}

impl ProbeDefinition for MotionPlan {
    type Config = String;
    const LABEL: &'static str = "motion";
    const EXAMPLE: &'static str = "motion = \"box\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_solid(key, config)
    }

    fn from_config(config: &String) -> Self {
        Self { solid: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(config.clone())
    }

    fn series(&self, dimension: usize) -> Vec<(String, Option<Vec<f64>>)> {
        displacements(dimension).iter().map(|column| (column.to_string(), None)).collect()
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(MotionProbe::new(system, &self.solid)?))
    }
}

/// Measures position and displacement (m), angles (deg, continuous past a turn), velocity (m/s) of the centre and spin (rad/s)
/// of a solid.
pub struct MotionProbe<const D: usize> {
    solid: usize,
    start: Vector<D>,
    /// The centre in the frame of a solid with ballast, m.
    point: Option<Vector<D>>,
}

impl<const D: usize> MotionProbe<D> {
    /// Creates the probe of the solid called `solid`. Displacements count from its present position.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub fn new(system: &System<D>, solid: &str) -> Result<Self> {
        let index = find_solid(system, solid)?;
        let solid = &system.solids()[index];
        let start = solid.kinematics.centre;
        let point = (!solid.spec.ballast.is_empty()).then(|| solid.kinematics.pose.local(&start));
        Ok(Self { solid: index, start, point })
    }
}

/// Returns the columns of the displacements and angles.
const fn displacements(dimension: usize) -> &'static [&'static str] {
    match dimension {
        2 => &["surge_m", "heave_m", "pitch_deg"],
        _ => &["surge_m", "sway_m", "heave_m", "roll_deg", "pitch_deg", "yaw_deg"],
    }
}

/// Returns the index of the first angle among the columns.
const fn first_angle<const D: usize>() -> usize {
    2 * D
}

/// Returns the number of angles.
const fn angles<const D: usize>() -> usize {
    D * (D - 1) / 2
}

impl<const D: usize> Probe<D> for MotionProbe<D> {
    fn reads(&self) -> ProbeReads {
        ProbeReads::Solids
    }

    fn columns(&self) -> Vec<String> {
        let spins: &[&str] = if D == 2 { &["spin_radps"] } else { &["spin_x_radps", "spin_y_radps", "spin_z_radps"] };
        let positions = axes::<D>().iter().map(|a| format!("{a}_m"));
        let velocities = axes::<D>().iter().map(|a| format!("v{a}_mps"));
        let named = |names: &'static [&'static str]| names.iter().map(|n| n.to_string());
        positions.chain(named(displacements(D))).chain(velocities).chain(named(spins)).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let solid = &sim.system().solids()[self.solid];
        if solid.is_removed() {
            return empty_row(self);
        }
        let now = &solid.kinematics;
        let (centre, velocity) = match &self.point {
            Some(point) => {
                let centre = now.pose.point(point);
                (centre, now.velocity + now.spin.velocity_at(&(centre - now.centre)))
            }
            None => (now.centre, now.velocity),
        };
        let moved = centre - self.start;
        let mut row: Vec<f64> = centre.iter().chain(moved.iter()).copied().collect();
        row.extend(euler_angles(&now.pose.rotation).into_iter().map(f64::to_degrees));
        row.extend(velocity.iter());
        row.extend(now.spin.axial());
        row
    }

    fn follows_angles(&self) -> bool {
        true
    }

    fn continue_from(&self, before: &[f64], now: &mut [f64], _: f64) {
        let range = first_angle::<D>()..first_angle::<D>() + angles::<D>();
        let (before, now) = (&before[range.clone()], &mut now[range]);
        let continued = |angles: &[f64]| -> Vec<f64> {
            before.iter().zip(angles).map(|(before, now)| unwrapped(*before, *now)).collect()
        };
        let mut angles = continued(now);
        if let [roll, pitch, yaw] = *now {
            let other = continued(&[roll + 180.0, 180.0 - pitch, yaw + 180.0]);
            let way = |to: &[f64]| before.iter().zip(to).map(|(from, to)| (to - from).abs()).sum::<f64>();
            if way(&other) < way(&angles) {
                angles = other;
            }
        }
        now.copy_from_slice(&angles);
    }
}

/// Returns the angle (deg) nearest to `before` that differs from `now` by whole turns; `now` if `before` is NaN.
pub(super) fn unwrapped(before: f64, now: f64) -> f64 {
    if before.is_nan() { now } else { now - 360.0 * ((now - before) / 360.0).round() }
}

/// Returns the angles (rad) of a rotation: one angle in 2-D; roll, pitch and yaw in 3-D.
fn euler_angles<const D: usize>(m: &Matrix<D>) -> Vec<f64> {
    if D == 2 {
        return vec![m[(1, 0)].atan2(m[(0, 0)])];
    }
    let pitch = (-m[(2, 0)]).clamp(-1.0, 1.0).asin();
    vec![m[(2, 1)].atan2(m[(2, 2)]), pitch, m[(1, 0)].atan2(m[(0, 0)])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Pose;

    #[test]
    fn angles_are_those_turned_about_each_axis() {
        for (axis, angle) in [(0, 0.3), (1, -0.4), (2, 2.0)] {
            let mut turn = [0.0; 3];
            turn[axis] = angle;
            let found = euler_angles(&Pose::<3>::rotated(Vector::zeros(), &turn).rotation);
            for i in 0..3 {
                assert!((found[i] - turn[i]).abs() < 1e-14, "round-off of sin and asin; got {found:?}");
            }
        }
        assert!((euler_angles(&Pose::<2>::rotated(Vector::zeros(), &[-1.2]).rotation)[0] + 1.2).abs() < 1e-14);
    }

    #[test]
    fn angles_about_every_axis_go_on_past_a_turn() {
        // A pitch of 90° is among the readings: there roll and yaw are about the same axis.
        let probe = MotionProbe::<3> { solid: 0, start: Vector::zeros(), point: None };
        for axis in 0..3 {
            let mut last = vec![0.0; 9];
            for step in 1..=40 {
                let mut turn = [0.0; 3];
                turn[axis] = (f64::from(step) * 22.5).to_radians();
                let mut row = vec![0.0; 6];
                row.extend(
                    euler_angles(&Pose::<3>::rotated(Vector::zeros(), &turn).rotation).iter().map(|x| x.to_degrees()),
                );
                probe.continue_from(&last, &mut row, 0.1);
                let expected = f64::from(step) * 22.5;
                // The rotation is known to round-off, and near a pitch of 90° the angles to its square root.
                assert!((row[6 + axis] - expected).abs() < 1e-5, "about axis {axis}: {expected}°, got {:?}", &row[6..]);
                last = row;
            }
        }
    }

    #[test]
    fn an_angle_goes_on_past_half_a_turn() {
        assert_eq!(unwrapped(179.0, -179.0), 181.0);
        assert_eq!(unwrapped(-725.0, -10.0), -730.0);
        assert_eq!(unwrapped(f64::NAN, -10.0), -10.0, "the first angle of a joint that begins during the run");
    }
}
