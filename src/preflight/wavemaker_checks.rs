//! Checks of paddles that make named waves: waves outside the validity of the theory, and paddles that differ from the paddle of
//! the theory.

use super::{
    Finding, GeneratedWave, PreflightContext,
    driven_motion::wave_direction,
    generated_waves::LEAST,
    wavemaker_site::{WavemakerSite, is_wall},
};
use crate::{
    geometry::world_bounds,
    math::{
        Vector,
        format::{coordinates, three_digits, two_digits_down, two_digits_up},
    },
    plan::StatisticKind,
    probe::ProbePlan,
    solid::{PrescribedMotion, Solid},
    wavemaker::{self, LINEAR_SPEED_RATIO_MAX, LinearWave, Paddle, TheoryRegion, WaveProperties},
};

/// Largest angle (rad) of a flap for which the theory of small angles is accurate: 30°.
const STEEP: f64 = std::f64::consts::FRAC_PI_6;

/// The highest of a thousand waves over the significant height (Rayleigh).
const HIGHEST: f64 = 1.86;

/// Share of the run that a ramp may take.
const RAMP: f64 = 0.5;

/// Largest horizontal distance of a hinge from the box around its flap, over the depth of the hinge, for which the flap's heave
/// is small, –.
const ASIDE: f64 = 0.1;

/// Largest accepted excess of the depth for which a wave is made over the depth of the water, relative to the latter, –.
const DEEPER: f64 = 0.01;
/// Largest accepted shortfall of this depth, besides one dp: the bed before a paddle may be uneven. Then the largest accepted
/// difference between the period of a statistic and that of the paddle, relative to the latter, –.
const SHALLOWER: f64 = 0.05;
const BESIDE: f64 = 0.05;

/// Returns the approximate height (m) of the crests of a wave at the paddle in water with the still `level` (m).
fn crest(facts: &WaveProperties, level: f64) -> f64 {
    level + if facts.solitary.is_some() { 1.0 } else { 0.75 } * facts.height
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Adds findings about a paddle with named waves whose position differs from that of the paddle in the theory.
    pub(super) fn check_site(
        &self,
        solid: &Solid<D>,
        motion: &PrescribedMotion<D>,
        law: &wavemaker::PaddleMotion,
        findings: &mut Vec<Finding>,
    ) {
        let name = &solid.spec.name;
        if is_wall(&solid.spec.shape) {
            return;
        }
        let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        let level = self.basin(&bounds).level;
        let (bottom, top) = (bounds.min[D - 1], bounds.max[D - 1]);
        if top <= level {
            let (top_m, level_m) = (three_digits(top), three_digits(level));
            let what = format!(
                "\"{name}\" ends at {top_m} m, and the water stands at {level_m} m: it makes no wave of theory"
            );
            let higher = two_digits_up(crest(law.properties(), level).max(level + self.dp()) - top);
            findings.push(Finding::warning(
                "drowned_paddle",
                what,
                format!("{higher} m more of height hold its crests"),
            ));
        }
        let Some(way) = wave_direction(motion, &(0.5 * (bounds.min + bounds.max))) else { return };
        let site = WavemakerSite::new(solid, way, level);
        findings.extend(self.dry_gap(solid, &site));
        let Some(depth) = self.depth_at(&site) else { return };
        let under = bottom - (level - depth);
        if law.paddle() == Paddle::Piston && under > self.dp() * (1.0 + 1e-6) {
            let what = format!(
                "the piston \"{name}\" ends {} m above the lowest water before it: water goes under it, and theory is \
                 for one that reaches the bed",
                three_digits(under)
            );
            // The height of a bed at zero has round-off.
            let bed = 1e-6 * (1e6 * (level - depth)).round();
            findings.push(Finding::warning("lifted_paddle", what, format!("bottom = {}", three_digits(bed))));
        }
        if let Paddle::Flap { arm } = law.paddle() {
            findings.extend(self.open_below(solid, &site, under));
            let hinge = motion.hinge_height().unwrap_or(f64::NEG_INFINITY);
            findings.extend(self.reaches_below_hinge(name, hinge - bottom.max(level - depth), hinge));
            findings.extend(hinge_aside(name, motion, &site, arm));
        }
        if law.depth() > depth * (1.0 + DEEPER) || law.depth() < depth * (1.0 - SHALLOWER) - self.dp() {
            let what = format!(
                "the wave of \"{name}\" is made for {} m of water, and there are {} m before it",
                three_digits(law.depth()),
                three_digits(depth)
            );
            findings.push(Finding::warning("wrong_depth", what, format!("wave.depth = {}", three_digits(depth))));
        }
    }

    /// A finding about a flap that reaches by `below` (m), more than a dp, below its hinge at the height `hinge` (m): that part moves
    /// against the upper one, and takes from its waves.
    fn reaches_below_hinge(&self, name: &str, below: f64, hinge: f64) -> Option<Finding> {
        (below > self.dp() * (1.0 + 1e-6)).then(|| {
            let what = format!(
                "the flap \"{name}\" reaches {} m below its hinge: that part moves back, the waves become lower, and theory is for a \
                 fixed wall there",
                three_digits(below)
            );
            let mend = format!("bottom = {}, with a fixed solid of its thickness below", three_digits(hinge));
            Finding::warning("lifted_paddle", what, mend)
        })
    }

    /// A finding about a flap whose lower edge is `under` (m) above the bed, if more than a dp of this height is open: no solid
    /// is there.
    fn open_below(&self, flap: &Solid<D>, site: &WavemakerSite<D>, under: f64) -> Option<Finding> {
        if under <= self.dp() {
            return None;
        }
        let (dp, others) = (self.dp(), || self.solids().iter().filter(|other| !std::ptr::eq(*other, flap)));
        let bottom = world_bounds(&flap.spec.shape, &flap.kinematics.pose).min[D - 1];
        let deep = site.thickness;
        let heights = (under / (0.25 * dp)).round() as usize;
        let across = (deep / (0.25 * dp)).ceil() as usize;
        let is_wall = |x: &Vector<D>| others().any(|other| other.distance(x) < 1e-6 * dp);
        let is_open = |k: &usize| {
            let mut x = site.face;
            x[D - 1] = bottom - (*k as f64 + 0.5) * under / heights as f64;
            !(0..=across).any(|i| is_wall(&(x - site.direction * (deep * i as f64 / across as f64))))
        };
        let open = under / heights as f64 * (0..heights).filter(is_open).count() as f64;
        (open > dp * (1.0 + 1e-6)).then(|| {
            let what = format!(
                "below the flap \"{}\" {} m are open to the bed: water goes under it, and theory is for a flap on a wall",
                flap.spec.name,
                three_digits(open)
            );
            let mend = "let it reach the bed, or put a fixed solid of its thickness below its hinge".into();
            Finding::warning("lifted_paddle", what, mend)
        })
    }

    /// A finding about a paddle whose face is farther from the water than half a dp, and one dp more for a face between two rows.
    fn dry_gap(&self, paddle: &Solid<D>, site: &WavemakerSite<D>) -> Option<Finding> {
        let (dp, r) = (self.dp(), self.system.fluid().r);
        let ahead = |x: &Vector<D>| site.distance_ahead(x).filter(|ahead| *ahead > 0.0);
        let nearest = r.iter().filter_map(ahead).fold(f64::INFINITY, f64::min);
        let off = |x: &Vector<D>| paddle.distance(x);
        let near = r.iter().filter(|x| ahead(x).is_some_and(|ahead| ahead < 4.0 * dp));
        let nearest = near.map(off).reduce(f64::min).unwrap_or(nearest);
        let gap = nearest - 0.5 * dp;
        (nearest.is_finite() && gap > 0.99 * dp).then(|| {
            let what = format!(
                "the water begins {} m, {} dp, before the face of \"{}\": the paddle has to cross the gap before it makes waves",
                three_digits(gap),
                three_digits(gap / dp),
                paddle.spec.name
            );
            let mend = format!("let the water begin at its face, or move the paddle by {} m", three_digits(gap));
            Finding::warning("dry_paddle", what, mend)
        })
    }

    /// Adds findings about a paddle that moves too fast for the theory, or whose ramp is too long.
    pub(super) fn check_speed(&self, wave: &GeneratedWave, law: &wavemaker::PaddleMotion, findings: &mut Vec<Finding>) {
        let (name, most) = (&wave.solid, LINEAR_SPEED_RATIO_MAX * wave.celerity_mps);
        if wave.paddle_mps > most * (1.0 + 1e-9) {
            let what = format!(
                "\"{name}\" goes at up to {} m/s, more than half as fast as its crests, {} m/s: theory, by which the \
                 paddle moves, is for small motions",
                three_digits(wave.paddle_mps),
                three_digits(wave.celerity_mps)
            );
            let share = most / wave.paddle_mps;
            let mend = match law.properties().kind {
                "regular" => format!("height = {}", two_digits_down(share * wave.height_m)),
                _ => format!("{} of the height does not", two_digits_down(share)),
            };
            findings.push(Finding::warning("fast_paddle", what, mend));
        }
        let (ramp, most) = (law.ramp_time(), RAMP * self.end_time());
        if ramp > most * (1.0 + 1e-9) {
            let (ramp_s, run) = (three_digits(ramp), three_digits(self.end_time()));
            let what = format!("\"{name}\" takes {ramp_s} s to its full motion, and the run is {run} s long");
            let mend = format!("until = {}, or wave.ramp = {}", two_digits_up(ramp / RAMP), two_digits_down(most));
            findings.push(Finding::warning("long_ramp", what, mend));
        }
    }

    /// Adds a finding about a focused group whose crest is specified beyond the water, or before its energy can arrive.
    pub(super) fn check_focus(
        &self,
        wave: &GeneratedWave,
        stand: &WavemakerSite<D>,
        law: &wavemaker::PaddleMotion,
        findings: &mut Vec<Finding>,
    ) {
        let Some((distance, time)) = law.properties().focus else { return };
        let (name, end) = (&wave.solid, self.water_end(stand));
        let least = distance / wave.group_mps + wave.ramp_s;
        if distance > end {
            let (distance, end_m) = (three_digits(distance), three_digits(end));
            let what = format!("the group of \"{name}\" is to stand {distance} m off, and the water ends at {end_m} m");
            findings.push(Finding::warning("far_focus", what, format!("distance = {}", two_digits_down(end))));
        } else if time < least * (1.0 - 1e-9) {
            let what = format!(
                "the group of \"{name}\" is to stand at {} s, and its energy takes {} s to get there at {} m/s, after \
                 a ramp of {} s",
                three_digits(time),
                three_digits(distance / wave.group_mps),
                three_digits(wave.group_mps),
                three_digits(wave.ramp_s)
            );
            findings.push(Finding::warning("early_focus", what, format!("time = {}", two_digits_up(least))));
        }
    }

    /// Adds findings about statistics at another period than that of the only regular wave.
    pub(super) fn check_statistic_periods(&self, waves: &[GeneratedWave], findings: &mut Vec<Finding>) {
        let [GeneratedWave { kind: Some("regular"), period_s: Some(own), solid, .. }] = waves else { return };
        for words in &self.plan.statistics {
            let (StatisticKind::Reflection { period, .. } | StatisticKind::Rao { period, .. }) = &words.what else {
                continue;
            };
            let Some(period) = period.filter(|period| (period / own - 1.0).abs() > BESIDE) else { continue };
            let what = format!(
                "the statistic \"{}\" is of waves of {} s, and \"{solid}\" makes waves of {} s",
                words.name,
                three_digits(period),
                three_digits(*own)
            );
            findings.push(Finding::warning("stale_period", what, format!("period = {own:.4}")));
        }
    }

    /// Adds a note for each gauge, and each probe of a motion, that reads less often than twice in the shortest period of a paddle: its
    /// waves are then those of another period.
    pub(super) fn check_reading_intervals(&self, waves: &[GeneratedWave], findings: &mut Vec<Finding>) {
        let periods = waves.iter().filter_map(|wave| Some((wave.period_s?, &wave.solid)));
        let Some((period, solid)) = periods.min_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        let swings = |probe: &&ProbePlan| matches!(probe.kind.key(), "elevation" | "motion");
        for probe in self.plan.probes.iter().filter(swings).filter(|probe| probe.every > 0.5 * period) {
            let what = format!(
                "probe \"{}\" reads every {} s, and the waves of \"{solid}\" have {} s",
                probe.name,
                three_digits(probe.every),
                three_digits(period)
            );
            let mend = format!("every = {} or less", two_digits_down(0.05 * period));
            findings.push(Finding::note("slow_probe", what, mend));
        }
    }

    /// Describes the changes with which the second order of Stokes is valid for a regular wave.
    fn stokes_validity(&self, train: &LinearWave, height: f64) -> String {
        let lower = train.stokes_height_max();
        let shorter = train.stokes_period_max(height).filter(|_| lower < LEAST * self.dp());
        let shorter = shorter.map(|period| {
            format!(
                "the period is long for waves of that height in this depth: period = {}, or ",
                two_digits_down(period)
            )
        });
        format!("{}height = {}", shorter.unwrap_or_default(), two_digits_down(lower))
    }

    /// Adds findings about a wave that breaks, is outside the validity of the theory, or overtops the paddle.
    pub(super) fn check_wave(
        &self,
        wave: &GeneratedWave,
        solid: &Solid<D>,
        law: &wavemaker::PaddleMotion,
        findings: &mut Vec<Finding>,
    ) {
        let (name, facts) = (&wave.solid, law.properties());
        let sea = !matches!(facts.kind, "regular" | "solitary");
        if let Some(train) = facts.linear_wave.filter(|_| sea) {
            let (most, high) =
                (train.breaking_height(), if facts.kind == "focused" { 0.8 } else { HIGHEST } * wave.height_m);
            if high > most {
                let what = format!(
                    "the highest waves of \"{name}\", about {} m, will break: {} m is the most at their period",
                    three_digits(high),
                    three_digits(most)
                );
                let mend = format!("{} of the height stays whole", two_digits_down(most / high));
                findings.push(Finding::note("breaking_waves", what, mend));
            }
        }
        if let Some(train) = facts.linear_wave.filter(|_| wave.region == TheoryRegion::Cnoidal && !sea) {
            let what = format!(
                "the wave of \"{name}\" is cnoidal, H L²/d³ = {}: Stokes' theory, by which the paddle moves, holds to 26",
                three_digits(train.ursell(wave.height_m))
            );
            findings.push(Finding::warning("beyond_stokes", what, self.stokes_validity(&train, wave.height_m)));
        }
        if let Paddle::Flap { arm } = law.paddle()
            && (0.5 * wave.stroke_m / arm).atan() > STEEP
        {
            let degrees = (0.5 * wave.stroke_m / arm).atan().to_degrees();
            let what = format!(
                "the flap \"{name}\" swings by {} degrees to each side, beyond what theory is for",
                three_digits(degrees)
            );
            let arm = two_digits_up(0.5 * wave.stroke_m / STEEP.tan());
            findings.push(Finding::warning(
                "steep_flap",
                what,
                format!("a hinge {arm} m below the still level swings by 30"),
            ));
        }
        let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        let (top, crest) = (bounds.max[D - 1], crest(facts, self.basin(&bounds).level));
        if top < crest {
            let what = format!(
                "the crests at \"{name}\" reach about {} m, and it ends at {} m: water goes over it",
                three_digits(crest),
                three_digits(top)
            );
            findings.push(Finding::warning(
                "overtopped_paddle",
                what,
                format!("{} m more of height hold it", two_digits_up(crest - top)),
            ));
        }
    }
}

/// A finding about a flap with its hinge before or behind it, `arm` (m) below the still level: such a flap also moves up and
/// down.
fn hinge_aside<const D: usize>(
    name: &str,
    motion: &PrescribedMotion<D>,
    site: &WavemakerSite<D>,
    arm: f64,
) -> Option<Finding> {
    let hinge = motion.hinged()?;
    let ahead = (hinge - site.face).dot(&site.direction);
    let aside = ahead.max(-ahead - site.thickness);
    (aside > ASIDE * arm).then(|| {
        let mut foot = site.face;
        foot[D - 1] = hinge[D - 1];
        let what = format!(
            "the hinge of the flap \"{name}\" is {} m {} it: the flap goes up and down as it swings, and theory is for a hinge \
             below its face",
            three_digits(aside),
            if ahead > 0.0 { "before" } else { "behind" }
        );
        Finding::warning("hinge_aside", what, format!("hinge = {}", coordinates(&foot)))
    })
}
