//! Waves that driven solids make: those that were asked for by name as they are, those of another motion by the linear
//! theory of wavemakers for its largest swing; against dp, the paddle and the tank.

use serde::Serialize;

use super::{
    Finding, Look,
    thickness::layered,
    words::{down, three, up},
};
use crate::{
    scene::world_bounds,
    solid::{
        Law, Motion, Role, Solid,
        wave::{Paddle, Regime, Region, Train},
    },
    space::{Bounds, Vector},
};

/// Wave height over dp below which waves lose much of it on their way.
const LEAST: f64 = 5.0;

/// Wave length over dp below which a wave is not resolved: two supports of the kernel to a crest.
const SHORTEST: f64 = 15.0;

/// Angle (rad) of a flap beyond which small angles are no good theory: 30°.
const STEEP: f64 = std::f64::consts::FRAC_PI_6;

/// The highest of a thousand waves over the significant height (Rayleigh).
const HIGHEST: f64 = 1.86;

/// Times at which a driven solid is looked at.
const TIMES_SEEN: usize = 2000;

/// Share of a motion's whole range that a turn back must have to be one.
const TURN: f64 = 0.05;

/// The wave of a driven solid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Wave {
    /// Name of the solid.
    pub solid: String,
    /// Its kind, in the words of a scene; absent if the solid's motion was given instead.
    pub kind: Option<&'static str>,
    /// Order of the paddle's theory.
    pub order: usize,
    /// The largest swing from one turn to the next, at the still level, m.
    pub stroke_m: f64,
    /// Period, of a sea that of the peak; of a motion twice the time of its swing; s. Absent of a solitary wave.
    pub period_s: Option<f64>,
    /// Height: as named, of a sea the significant one; else by linear theory from the stroke; m.
    pub height_m: f64,
    /// The same over dp.
    pub height_dp: f64,
    /// Length, of a solitary wave between the points of a hundredth of its height, m.
    pub length_m: f64,
    /// The same over dp.
    pub length_dp: f64,
    /// Depth at the paddle, m.
    pub depth_m: f64,
    /// kd; absent of a solitary wave.
    pub kd: Option<f64>,
    /// How deep the water is for the wave; a solitary one is in shallow water.
    pub regime: Regime,
    /// Which theory holds, after the chart of Le Méhauté.
    pub region: Region,
    /// Speed of the crests, m/s.
    pub celerity_mps: f64,
    /// Speed of the wave's front and energy, m/s.
    pub group_mps: f64,
    /// The paddle's largest speed at the still level, m/s.
    pub paddle_mps: f64,
    /// How long the paddle takes to its full motion, s; 0 if its motion was given.
    pub ramp_s: f64,
    /// From the paddle to the end of the water, m.
    pub reach_m: f64,
    /// When the front is at that end, s.
    pub far_s: f64,
    /// When what comes back from there is at the paddle, s.
    pub back_s: f64,
}

/// How a solid's face goes at the still level.
struct Swing<const D: usize> {
    /// Sideways, where it goes furthest; a unit vector.
    way: Vector<D>,
    /// The largest swing, m, and half its period, s; no period if it does not turn.
    stroke: f64,
    half: Option<f64>,
    speed: f64,
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
            self.low(&wave, findings);
            self.undamped(&wave, findings);
            if let Law::Wave(law) = motion.law() {
                self.named(&wave, solid, law, findings);
            }
            waves.push(wave);
        }
        waves
    }

    /// What is too small for dp.
    fn low(&self, wave: &Wave, findings: &mut Vec<Finding>) {
        let name = &wave.solid;
        if wave.height_dp < LEAST {
            let what = format!(
                "\"{name}\" makes waves about {} m high, {} dp; with less than {LEAST} dp they lose height",
                three(wave.height_m),
                three(wave.height_dp)
            );
            findings.push(Finding::warning("low_waves", what, format!("dp = {}", down(wave.height_m / LEAST))));
        }
        if wave.length_dp < SHORTEST {
            let what = format!(
                "\"{name}\" makes waves {} m long, {} dp; with less than {SHORTEST} dp they die away",
                three(wave.length_m),
                three(wave.length_dp)
            );
            findings.push(Finding::warning("short_waves", what, format!("dp = {}", down(wave.length_m / SHORTEST))));
        }
    }

    /// Damping zones that are over before a wave is.
    fn undamped(&self, wave: &Wave, findings: &mut Vec<Finding>) {
        let least = 0.5 * wave.length_m;
        if let Some(zone) = self.system.damping().iter().find(|zone| zone.length() < least * (1.0 - 1e-9)) {
            let what = format!(
                "a damping zone is {} m long, and the waves of \"{}\" are {} m: much of them will come back",
                three(zone.length()),
                wave.solid,
                three(wave.length_m)
            );
            let mend = format!("half a wave length, {} m, is the least, a whole one is better", up(least));
            findings.push(Finding::warning("short_damping", what, mend));
        }
    }

    /// What a wave that was asked for may not become.
    fn named(&self, wave: &Wave, solid: &Solid<D>, law: &crate::solid::wave::Wave, findings: &mut Vec<Finding>) {
        let (name, facts) = (&wave.solid, law.facts());
        let sea = !matches!(facts.kind, "regular" | "solitary");
        if let Some(train) = facts.train.filter(|_| sea) {
            let (most, high) = (train.highest(), if facts.kind == "focused" { 0.8 } else { HIGHEST } * wave.height_m);
            if high > most {
                let what = format!(
                    "the highest waves of \"{name}\", about {} m, will break: {} m is the most at their period",
                    three(high),
                    three(most)
                );
                let mend = format!("{} of the height stays whole", down(most / high));
                findings.push(Finding::note("breaking_waves", what, mend));
            }
        }
        if let Some(train) = facts.train.filter(|_| wave.region == Region::Cnoidal && !sea) {
            let what = format!(
                "the wave of \"{name}\" is cnoidal, H L²/d³ = {}: Stokes' theory, by which the paddle moves, holds to 26",
                three(train.ursell(wave.height_m))
            );
            findings.push(Finding::warning(
                "beyond_stokes",
                what,
                format!("height = {}", down(train.highest_of_stokes())),
            ));
        }
        if let Paddle::Flap { arm } = law.paddle()
            && (0.5 * wave.stroke_m / arm).atan() > STEEP
        {
            let degrees = (0.5 * wave.stroke_m / arm).atan().to_degrees();
            let what = format!(
                "the flap \"{name}\" swings by {} degrees to each side, beyond what theory is for",
                three(degrees)
            );
            let arm = up(0.5 * wave.stroke_m / STEEP.tan());
            findings.push(Finding::warning(
                "steep_flap",
                what,
                format!("a hinge {arm} m below the still level swings by 30"),
            ));
        }
        let top = world_bounds(&solid.spec.shape, &solid.kinematics.pose).max[D - 1];
        let crest = self.still.level + if facts.solitary.is_some() { 1.0 } else { 0.75 } * wave.height_m;
        if top < crest {
            let what = format!(
                "the crests at \"{name}\" reach about {} m, and it ends at {} m: water goes over it",
                three(crest),
                three(top)
            );
            findings.push(Finding::warning(
                "overtopped_paddle",
                what,
                format!("{} m more of height hold it", up(crest - top)),
            ));
        }
    }

    fn wave(&self, solid: &Solid<D>, motion: &Motion<D>) -> Option<Wave> {
        let level = self.still.level;
        let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        // A tank that is shaken holds the water rather than pushing it.
        if layered(&solid.spec.shape) || self.g == 0.0 || bounds.min[D - 1] >= level || bounds.max[D - 1] <= level {
            return None;
        }
        let mut swing = self.swing(solid, motion, &bounds)?;
        let water = Bounds::around(self.system.fluid().r);
        let ahead = |way: &Vector<D>| furthest(&water, way) - furthest(&bounds, way);
        if ahead(&-swing.way) > ahead(&swing.way) {
            swing.way = -swing.way;
        }
        let reach = ahead(&swing.way).max(0.0);
        let named = match motion.law() {
            Law::Wave(wave) => Some(wave),
            _ => None,
        };
        let depth = named.map_or(self.still.depth, |wave| wave.depth());
        let facts = named.map(|wave| wave.facts());
        let kind = facts.map(|facts| facts.kind);
        let (order, ramp) = (facts.map_or(1, |f| f.order), named.map_or(0.0, |wave| wave.ramp_time()));
        let mut wave = match facts.and_then(|facts| facts.solitary) {
            Some(own) => Wave {
                period_s: None,
                height_m: own.height,
                length_m: own.length(),
                kd: None,
                regime: Regime::Shallow,
                region: Region::Solitary,
                celerity_mps: own.celerity,
                group_mps: own.celerity,
                ..Wave::none(&solid.spec.name)
            },
            None => {
                let train = match facts.and_then(|facts| facts.train) {
                    Some(train) => train,
                    None => Train::of(std::f64::consts::PI / swing.half?, depth, self.g),
                };
                let height = facts.map_or_else(|| swing.stroke * self.paddle(motion).transfer(&train), |f| f.height);
                Wave {
                    period_s: Some(train.period()),
                    height_m: height,
                    length_m: train.length(),
                    kd: Some(train.kd()),
                    regime: train.regime(),
                    region: train.region(height),
                    celerity_mps: train.celerity(),
                    group_mps: train.group(),
                    ..Wave::none(&solid.spec.name)
                }
            }
        };
        (wave.kind, wave.order, wave.depth_m, wave.ramp_s) = (kind, order, depth, ramp);
        (wave.stroke_m, wave.paddle_mps, wave.reach_m) = (swing.stroke, swing.speed, reach);
        (wave.height_dp, wave.length_dp) = (wave.height_m / self.dp(), wave.length_m / self.dp());
        (wave.far_s, wave.back_s) = (reach / wave.group_mps, 2.0 * reach / wave.group_mps);
        (wave.height_m.is_finite() && swing.stroke > 1e-3 * self.dp()).then_some(wave)
    }

    /// The motion as a paddle's.
    fn paddle(&self, motion: &Motion<D>) -> Paddle {
        match motion.hinge_height() {
            Some(height) if height < self.still.level => Paddle::Flap { arm: self.still.level - height },
            _ => Paddle::Piston,
        }
    }

    /// How the material point in the still level goes sideways.
    fn swing(&self, solid: &Solid<D>, motion: &Motion<D>, bounds: &Bounds<D>) -> Option<Swing<D>> {
        let mut mark = 0.5 * (bounds.min + bounds.max);
        mark[D - 1] = self.still.level;
        let local = solid.kinematics.pose.local(&mark);
        let step = self.until() / TIMES_SEEN as f64;
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
        let range = way.iter().fold(0.0f64, |m, x| m.max(*x)) - way.iter().fold(0.0f64, |m, x| m.min(*x));
        let (stroke, half) = match swing(&way) {
            Some((stroke, steps)) => (stroke, Some(steps as f64 * step)),
            None => (range, None),
        };
        Some(Swing { way: far, stroke, half, speed })
    }
}

impl Wave {
    fn none(solid: &str) -> Self {
        Self {
            solid: solid.into(),
            kind: None,
            order: 1,
            stroke_m: 0.0,
            period_s: None,
            height_m: 0.0,
            height_dp: 0.0,
            length_m: 0.0,
            length_dp: 0.0,
            depth_m: 0.0,
            kd: None,
            regime: Regime::Shallow,
            region: Region::Airy,
            celerity_mps: 0.0,
            group_mps: 0.0,
            paddle_mps: 0.0,
            ramp_s: 0.0,
            reach_m: 0.0,
            far_s: 0.0,
            back_s: 0.0,
        }
    }
}

/// The largest x·`way` in a box.
fn furthest<const D: usize>(bounds: &Bounds<D>, way: &Vector<D>) -> f64 {
    (0..D).map(|i| (way[i] * bounds.min[i]).max(way[i] * bounds.max[i])).sum()
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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

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
