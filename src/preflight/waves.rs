//! Waves that driven solids make, by the linear theory of wavemakers, against dp.
//!
//!   piston  H/S = 2 (cosh 2kd − 1)/(sinh 2kd + 2kd)
//!   flap    H/S = 4 (sinh kd/kd) (kd sinh kd − cosh kd + 1)/(sinh 2kd + 2kd)      hinged at the bed
//!
//! with ω² = g k tanh kd: S the stroke at the still level, d the depth. [@dean1991], ch. 6.

use std::f64::consts::TAU;

use serde::Serialize;

use super::{
    Finding, Look,
    thickness::layered,
    words::{down, three},
};
use crate::{
    scene::world_bounds,
    solid::{Motion, Role, Solid},
    space::Vector,
};

/// Wave height over dp below which waves lose much of it on their way.
const LEAST: f64 = 5.0;

/// Times at which a driven solid is looked at.
const TIMES_SEEN: usize = 2000;

/// Share of a motion's whole range that a turn back must have to be one.
const TURN: f64 = 0.05;

/// The highest wave of a driven solid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Wave {
    /// Name of the solid.
    pub solid: String,
    /// The largest swing from one turn to the next, at the still level, m.
    pub stroke_m: f64,
    /// Twice the time that it takes, s.
    pub period_s: f64,
    /// Height of the wave by linear theory, m.
    pub height_m: f64,
    /// The same over dp.
    pub height_dp: f64,
}

impl<const D: usize> Look<'_, D> {
    /// The waves of the solids that are driven to and fro through the surface.
    pub(super) fn waves(&self, findings: &mut Vec<Finding>) -> Vec<Wave> {
        let mut waves = Vec::new();
        let depth = self.still.depth;
        if self.g > 0.0 && depth < 10.0 * self.dp() * (1.0 - 1e-9) {
            let what = format!(
                "the water is {} m deep, {} dp: too few for waves and floats, which take 10",
                three(depth),
                three(depth / self.dp())
            );
            findings.push(Finding::warning("shallow", what, format!("dp = {}", down(0.1 * depth))));
        }
        for solid in self.solids() {
            let Role::Driven(motion) = &solid.spec.role else { continue };
            let Some(wave) = self.wave(solid, motion) else { continue };
            if wave.height_dp < LEAST {
                let what = format!(
                    "\"{}\" makes waves about {} m high, {} dp; with less than {LEAST} dp they lose height",
                    wave.solid,
                    three(wave.height_m),
                    three(wave.height_dp)
                );
                findings.push(Finding::warning("low_waves", what, format!("dp = {}", down(wave.height_m / LEAST))));
            }
            waves.push(wave);
        }
        waves
    }

    fn wave(&self, solid: &Solid<D>, motion: &Motion<D>) -> Option<Wave> {
        let level = self.still.level;
        let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        // A tank that is shaken holds the water rather than pushing it.
        if layered(&solid.spec.shape) || self.g == 0.0 || bounds.min[D - 1] >= level || bounds.max[D - 1] <= level {
            return None;
        }
        // The material point in the still level, and how it goes sideways.
        let mut mark = 0.5 * (bounds.min + bounds.max);
        mark[D - 1] = level;
        let local = solid.kinematics.pose.local(&mark);
        let step = self.until() / TIMES_SEEN as f64;
        let sideways: Vec<Vector<D>> = (0..=TIMES_SEEN)
            .map(|k| {
                let mut way = motion.kinematics(&solid.spec.pose, k as f64 * step).pose.point(&local) - mark;
                way[D - 1] = 0.0;
                way
            })
            .collect();
        let furthest =
            sideways.iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?.try_normalize(0.0)?;
        let way: Vec<f64> = sideways.iter().map(|x| x.dot(&furthest)).collect();
        let (stroke, steps) = swing(&way)?;
        let period = 2.0 * steps as f64 * step;
        let kd = self.still.depth * wave_number(TAU / period, self.still.depth, self.g)?;
        // A flap turns, a piston slides.
        let turned = (0..=TIMES_SEEN / 20)
            .map(|k| motion.kinematics(&solid.spec.pose, 20.0 * k as f64 * step).spin.0.norm())
            .fold(0.0, f64::max);
        let height = stroke * if turned > 0.0 { flap(kd) } else { piston(kd) };
        (height.is_finite() && stroke > 1e-3 * self.dp()).then(|| Wave {
            solid: solid.spec.name.clone(),
            stroke_m: stroke,
            period_s: period,
            height_m: height,
            height_dp: height / self.dp(),
        })
    }
}

/// The largest swing of `way` from one turn to the next, and how many samples it takes; `None` if it never turns.
fn swing(way: &[f64]) -> Option<(f64, usize)> {
    let range = way.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)) - way.iter().fold(f64::INFINITY, |m, x| m.min(*x));
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

/// k (1/m) of a wave of angular frequency `omega` (1/s) in water `depth` (m) deep: ω² = g k tanh kd, by Newton.
fn wave_number(omega: f64, depth: f64, g: f64) -> Option<f64> {
    let deep = omega * omega * depth / g;
    let mut kd = deep.max(deep.sqrt());
    for _ in 0..50 {
        let tanh = kd.tanh();
        kd -= (kd * tanh - deep) / (tanh + kd * (1.0 - tanh * tanh));
    }
    (kd.is_finite() && kd > 0.0).then(|| kd / depth)
}

/// Wave height over stroke of a piston.
fn piston(kd: f64) -> f64 {
    if kd > 300.0 { 2.0 } else { 2.0 * ((2.0 * kd).cosh() - 1.0) / ((2.0 * kd).sinh() + 2.0 * kd) }
}

/// Wave height over stroke of a flap hinged at the bed.
fn flap(kd: f64) -> f64 {
    let top = kd * kd.sinh() - kd.cosh() + 1.0;
    if kd > 300.0 { 2.0 } else { 4.0 * kd.sinh() / kd * top / ((2.0 * kd).sinh() + 2.0 * kd) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piston_in_shallow_water_makes_waves_of_kd_strokes_and_a_flap_of_half() {
        // The limits of small kd; the next term is (kd)², relative.
        assert!((piston(0.01) / 0.01 - 1.0).abs() < 1e-3 && (flap(0.01) / 0.005 - 1.0).abs() < 1e-3);
        let k = wave_number(2.0, 0.4, 9.81).unwrap_or(f64::NAN);
        assert!((9.81 * k * (0.4 * k).tanh() - 4.0).abs() < 1e-9, "{k}");
    }

    #[test]
    fn the_largest_swing_is_found_under_a_ramp_and_past_noise() {
        let way = |t: f64| 0.1 * (t / 4.0).min(1.0) * (TAU * t).sin() + 1e-3 * (57.0 * t).sin();
        let samples: Vec<f64> = (0..=1000).map(|i| way(0.01 * i as f64)).collect();
        let (stroke, steps) = swing(&samples).unwrap_or((0.0, 0));
        // Noise moves the turns by a few samples and the stroke by its own 2 per cent.
        assert!((stroke - 0.2).abs() < 0.005 && (45..=55).contains(&steps), "{stroke} {steps}");
        assert_eq!(swing(&[0.0, 0.1, 0.3, 0.4]), None, "it never turns");
    }
}
