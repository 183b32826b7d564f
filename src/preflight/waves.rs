//! Waves that driven solids make: those that were asked for by name as they are, those of another motion by the linear
//! theory of wavemakers for its largest swing; against dp, the paddle and the tank.

use serde::Serialize;

use super::{
    Finding, Look,
    format::{down, three},
    stands::Stand,
    thickness::layered,
};
use crate::{
    scene::world_bounds,
    solid::{Motion, Role, Solid},
    wavemaker::{Paddle, Regime, Region, Train},
};

/// Wave height over dp below which waves lose much of it on their way.
pub(super) const LEAST: f64 = 5.0;

/// Wave length over dp below which a wave is not resolved: two supports of the kernel to a crest.
const SHORTEST: f64 = 15.0;

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
    /// From the paddle to the first thing that answers, m.
    pub reach_m: f64,
    /// The solid that answers; absent of the end of the water.
    pub answers: Option<String>,
    /// Where a damping zone begins before that, m from the paddle.
    pub damping_m: Option<f64>,
    /// When the front is where something answers, s.
    pub far_s: f64,
    /// When what comes back from there is at the paddle, s.
    pub back_s: f64,
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
            if let Some(law) = motion.wave() {
                self.placed(solid, motion, law, findings);
            }
            let Some((wave, stand)) = self.wave(solid, motion) else { continue };
            self.low(&wave, findings);
            self.zones(&wave, &stand, findings);
            if let Some(law) = motion.wave() {
                self.named(&wave, solid, law, findings);
                self.quick(&wave, law, findings);
                self.focus(&wave, &stand, law, findings);
            }
            waves.push(wave);
        }
        self.idle(findings);
        self.stale(&waves, findings);
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

    fn wave(&self, solid: &Solid<D>, motion: &Motion<D>) -> Option<(Wave, Stand<D>)> {
        let level = self.still.level;
        let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        // A tank that is shaken holds the water rather than pushing it.
        if layered(&solid.spec.shape) || self.g == 0.0 || bounds.min[D - 1] >= level || bounds.max[D - 1] <= level {
            return None;
        }
        let swing = self.swing(solid, motion, &bounds)?;
        let named = motion.wave();
        let [stand, behind] = [swing.way, -swing.way].map(|way| Stand::of(&bounds, way, level));
        // A given motion makes waves to both sides: those count that go the longer way.
        let stand = if named.is_none() && self.end(&behind) > self.end(&stand) { behind } else { stand };
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
        (wave.stroke_m, wave.paddle_mps) = (swing.stroke, swing.speed);
        (wave.height_dp, wave.length_dp) = (wave.height_m / self.dp(), wave.length_m / self.dp());
        (wave.reach_m, wave.answers) = self.answer(solid, &stand);
        wave.damping_m = self.damped(&stand).filter(|begins| *begins < wave.reach_m);
        (wave.far_s, wave.back_s) = (wave.reach_m / wave.group_mps, 2.0 * wave.reach_m / wave.group_mps);
        (wave.height_m.is_finite() && swing.stroke > 1e-3 * self.dp()).then_some((wave, stand))
    }

    /// The motion as a paddle's.
    fn paddle(&self, motion: &Motion<D>) -> Paddle {
        match motion.hinge_height() {
            Some(height) if height < self.still.level => Paddle::Flap { arm: self.still.level - height },
            _ => Paddle::Piston,
        }
    }
}

impl Wave {
    /// When the first answer is back at the paddle, and from where, in one line.
    pub fn first_answer(&self) -> String {
        let (reach, far, back) = (three(self.reach_m), three(self.far_s), three(self.back_s));
        let what = self.answers.as_ref().map_or("the far end".into(), |name| format!("\"{name}\""));
        let zone = self.damping_m.map(|begins| format!("; a damping zone begins at {} m", three(begins)));
        format!("{reach} m to {what}: there after {far} s, back after {back} s{}", zone.unwrap_or_default())
    }

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
            answers: None,
            damping_m: None,
            far_s: 0.0,
            back_s: 0.0,
        }
    }
}
