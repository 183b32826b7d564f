//! The horizontal motion of the face of a driven solid at the still level.

use super::PreflightContext;
use crate::{
    math::{Bounds, Vector},
    solid::{PrescribedMotion, Solid},
};

/// Number of intervals of the run at whose ends the motion is sampled.
const TIMES_SEEN: usize = 2000;

/// Least way back after a turning point, over the whole range of the motion, –.
const TURN: f64 = 0.05;

/// The horizontal motion of a solid's face at the still level.
pub(super) struct DrivenStroke<const D: usize> {
    /// Horizontal direction of its largest displacement, or of the waves of its law; a unit vector.
    pub(super) direction: Vector<D>,
    /// The largest stroke, m, and half of its period, s; there is no period if the motion has no turning point.
    pub(super) stroke: f64,
    pub(super) half_period: Option<f64>,
    /// The largest speed, m/s.
    pub(super) speed: f64,
}

impl<const D: usize> PreflightContext<'_, D> {
    /// The horizontal motion of the material point in the still level.
    pub(super) fn driven_stroke(
        &self,
        solid: &Solid<D>,
        motion: &PrescribedMotion<D>,
        bounds: &Bounds<D>,
    ) -> Option<DrivenStroke<D>> {
        let mut mark = 0.5 * (bounds.min + bounds.max);
        mark[D - 1] = self.basin(bounds).level;
        if let Some(law) = motion.wave() {
            let (way, speed): (Vec<f64>, Vec<f64>) = law.sample_motion(self.end_time()).into_iter().unzip();
            let stroke = largest_stroke(&way).map_or_else(|| range(&way), |(stroke, _)| stroke);
            let speed = speed.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
            return Some(DrivenStroke { direction: wave_direction(motion, &mark)?, stroke, half_period: None, speed });
        }
        let local = solid.kinematics.pose.local(&mark);
        let step = self.end_time() / TIMES_SEEN as f64;
        let sideways: Vec<Vector<D>> = (0..=TIMES_SEEN)
            .map(|k| {
                let mut way = motion.kinematics(&solid.spec.pose, k as f64 * step).pose.point(&local) - mark;
                way[D - 1] = 0.0;
                way
            })
            .collect();
        let far = sideways.iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?.try_normalize(0.0)?;
        let way: Vec<f64> = sideways.iter().map(|x| x.dot(&far)).collect();
        let speed = way.windows(2).map(|ab| (ab[1] - ab[0]).abs() / step).fold(0.0, f64::max);
        let (stroke, half) = match largest_stroke(&way) {
            Some((stroke, steps)) => (stroke, Some(steps as f64 * step)),
            None => (range(&way), None),
        };
        Some(DrivenStroke { direction: far, stroke, half_period: half, speed })
    }
}

/// Direction of the named waves of a paddle whose point at `mark` (m) is in the still level: a horizontal unit vector.
pub(super) fn wave_direction<const D: usize>(motion: &PrescribedMotion<D>, mark: &Vector<D>) -> Option<Vector<D>> {
    let mut way = *motion.directions_at(mark).first()?;
    way[D - 1] = 0.0;
    way.try_normalize(0.0)
}

/// The largest value of `way` minus the least.
fn range(way: &[f64]) -> f64 {
    let (least, most) =
        way.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    most - least
}

/// The largest stroke of `way` from one turning point to the next, and its number of samples; `None` without a turning point.
fn largest_stroke(way: &[f64]) -> Option<(f64, usize)> {
    let range = range(way);
    let mut turns = vec![0];
    // The furthest sample since the last turn, in the present sense.
    let (mut furthest, mut sense) = (0, 0.0);
    for (i, x) in way.iter().enumerate() {
        let on = x - way[furthest];
        if sense == 0.0 && on.abs() > TURN * range {
            (furthest, sense) = (i, on.signum());
        } else if on * sense >= 0.0 && sense != 0.0 {
            furthest = i;
        } else if on * sense < -TURN * range {
            turns.push(furthest);
            (furthest, sense) = (i, -sense);
        }
    }
    if turns.len() < 2 {
        return None;
    }
    turns.push(furthest);
    let swings = turns.windows(2).map(|ab| ((way[ab[1]] - way[ab[0]]).abs(), ab[1] - ab[0]));
    swings.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(stroke, steps)| *stroke > 0.0 && *steps > 0)
}

#[cfg(test)]
#[path = "../../tests/unit/preflight/driven_motion.rs"]
mod tests;
