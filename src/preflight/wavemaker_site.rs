//! The site of a paddle: the solids in the way of its waves, and the damping zones that absorb them.

use super::{Finding, GeneratedWave, PreflightContext};
use crate::{
    geometry::{Shape, farthest_along, world_bounds},
    math::{
        Bounds, Vector,
        format::{coordinates, three_digits, two_digits_up},
    },
    solid::Solid,
    system::SpongeLayer,
};

/// Least component of a reflecting face's unit normal against the waves: gentler slopes than 1:20 are beaches, on which the water
/// ends.
const FACING: f64 = 0.05;

/// Largest share of its height that a wave may lose on its first length to a damping zone at its paddle.
const LARGEST_LOSS: f64 = 0.02;

/// A paddle at rest, and the direction of its waves.
pub(super) struct WavemakerSite<const D: usize> {
    /// Thickness from its back to its face, m.
    pub(super) thickness: f64,
    /// The level direction across that of its waves, and how far it reaches from the middle of its face this way and against it, m.
    across: (Vector<D>, [f64; 2]),
    /// Direction of its waves: a horizontal unit vector.
    pub(super) direction: Vector<D>,
    /// The middle of its face in the still level, m.
    pub(super) face: Vector<D>,
}

/// Whether the shape is a tank or a wall, which holds water and is no paddle.
pub(super) fn is_wall<const D: usize>(shape: &Shape<D>) -> bool {
    match shape {
        Shape::Tank { .. } | Shape::Polyline { .. } => true,
        Shape::Compound(parts) => parts.iter().all(|(_, part)| is_wall(part)),
        _ => false,
    }
}

impl<const D: usize> WavemakerSite<D> {
    /// The site of a `paddle`, whose waves go along `way`, in water with the still level `level` (m).
    pub(super) fn new(paddle: &Solid<D>, way: Vector<D>, level: f64) -> Self {
        let (shape, pose) = (&paddle.spec.shape, &paddle.kinematics.pose);
        let bounds = world_bounds(shape, pose);
        let reach = |way: &Vector<D>| farthest_along(shape, pose, way);
        let middle = 0.5 * (bounds.min + bounds.max);
        let mut face = middle + way * (reach(&way) - middle.dot(&way));
        face[D - 1] = level;
        // In 2-D there is none.
        let mut aside = Vector::zeros();
        if D == 3 {
            (aside[0], aside[1]) = (-way[1], way[0]);
        }
        let breadth = [aside, -aside].map(|side| reach(&side) - side.dot(&face));
        Self { thickness: reach(&way) + reach(&-way), across: (aside, breadth), direction: way, face }
    }

    /// Distance (m) of `x` (m) before the face; `None` if the waves pass beside it.
    pub(super) fn distance_ahead(&self, x: &Vector<D>) -> Option<f64> {
        let (off, (aside, [breadth, back])) = (x - self.face, &self.across);
        let beside = off.dot(aside);
        (D == 2 || beside < *breadth && -beside < *back).then(|| off.dot(&self.direction))
    }

    /// Distance (m) from the face to the beginning of a zone; `None` unless the waves run into it.
    fn zone_start(&self, zone: &SpongeLayer<D>) -> Option<f64> {
        let way = zone.to - zone.from;
        let along = way.dot(&self.direction);
        (along > 0.0).then(|| ((zone.from - self.face).dot(&way) / along).max(0.0))
    }
}

/// The largest x·`way` in a box.
pub(super) fn support<const D: usize>(bounds: &Bounds<D>, way: &Vector<D>) -> f64 {
    (0..D).map(|i| (way[i] * bounds.min[i]).max(way[i] * bounds.max[i])).sum()
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Distance from the face to the end of the water, m.
    pub(super) fn water_end(&self, stand: &WavemakerSite<D>) -> f64 {
        let water = Bounds::around(self.system.fluid().r);
        (support(&water, &stand.direction) - stand.face.dot(&stand.direction)).max(0.0)
    }

    /// Distance (m) from `paddle` to the first reflector of its waves, and the name of this solid. Without a name, the reflector
    /// is the end of the water, or the solid that contains the water.
    pub(super) fn first_reflector(&self, paddle: &Solid<D>, stand: &WavemakerSite<D>) -> (f64, Option<String>) {
        let end = self.water_end(stand);
        let others = self.solids().iter().enumerate().filter(|(_, other)| {
            let bounds = world_bounds(&other.spec.shape, &other.kinematics.pose);
            let through = bounds.min[D - 1] < stand.face[D - 1] && bounds.max[D - 1] > stand.face[D - 1];
            through && !std::ptr::eq(*other, paddle) && !is_wall(&other.spec.shape)
        });
        let near = others.filter_map(|(i, other)| Some((self.reflector_distance(i, stand)?, other.spec.name.clone())));
        let nearest = near.filter(|(ahead, _)| *ahead < end).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map_or((end, None), |(ahead, name)| (ahead, Some(name)))
    }

    /// Distance (m) in the still level from a paddle's face to the face of solid `i` that reflects its waves.
    fn reflector_distance(&self, i: usize, stand: &WavemakerSite<D>) -> Option<f64> {
        let pose = &self.solids()[i].kinematics.pose;
        let ahead = self.surface_samples[i].iter().filter_map(|face| {
            let (x, n) = (pose.point(&face.x), pose.rotation * face.n);
            let (high, facing) = (x[D - 1] - stand.face[D - 1], n.dot(&stand.direction));
            let looks = high.abs() <= self.dp() && facing < -FACING;
            // From its place to the still level along the face.
            let ahead = stand.distance_ahead(&x).filter(|_| looks)? + high * n[D - 1] / facing;
            (ahead > 0.0).then_some(ahead)
        });
        ahead.min_by(f64::total_cmp)
    }

    /// Distance (m) from the face to the beginning of the first damping zone in the way of the waves.
    pub(super) fn damping_start(&self, stand: &WavemakerSite<D>) -> Option<f64> {
        self.system.sponge_layers().iter().filter_map(|zone| stand.zone_start(zone)).min_by(f64::total_cmp)
    }

    /// Depth (m) of the water before a paddle; `None` if it is dry there. Steps of the bed below one dp do not count.
    pub(super) fn depth_at(&self, stand: &WavemakerSite<D>) -> Option<f64> {
        let (dp, reach) = (self.dp(), self.system.model().support_radius());
        let water = self.system.fluid().r;
        let beside = |r: &&Vector<D>| stand.distance_ahead(r).is_some_and(|ahead| (-dp..reach).contains(&ahead));
        let lowest = |least: f64, r: &Vector<D>| least.min(r[D - 1]);
        let bottom = water.iter().fold(f64::INFINITY, lowest);
        let rise = water.iter().filter(beside).fold(f64::INFINITY, lowest) - bottom;
        // A solid may fill the lowest part of the region of the water.
        let filled = bottom - 0.5 * dp - (self.still_water.level - self.still_water.depth);
        let lower = self.still_water.level - stand.face[D - 1];
        let least = |rise: f64| if rise > dp { rise } else { 0.0 };
        rise.is_finite().then_some(self.still_water.depth - lower - least(rise) - least(filled))
    }

    /// Adds findings about damping zones without water.
    pub(super) fn dry_zones(&self, findings: &mut Vec<Finding>) {
        let water = self.system.fluid().r;
        let idle = |zone: &&SpongeLayer<D>| water.iter().all(|r| zone.rate(r) == 0.0);
        for zone in self.system.sponge_layers().iter().filter(idle) {
            let what = format!("{} lies outside of the water: it takes no waves", zone_extent(zone));
            let all = Bounds::around(water);
            let mend = format!("the water is between {} and {}", coordinates(&all.min), coordinates(&all.max));
            findings.push(Finding::warning("idle_damping", what, mend));
        }
    }

    /// Adds findings about damping zones that are shorter than half a wavelength, or damp waves at the paddle.
    pub(super) fn misplaced_zones(&self, wave: &GeneratedWave, stand: &WavemakerSite<D>, findings: &mut Vec<Finding>) {
        let (zones, least) = (self.system.sponge_layers(), 0.5 * wave.length_m);
        if let Some(zone) = zones.iter().find(|zone| zone.length() < least * (1.0 - 1e-9)) {
            let what = format!(
                "a damping zone is {} m long, and the waves of \"{}\" are {} m: much of them will come back",
                three_digits(zone.length()),
                wave.solid,
                three_digits(wave.length_m)
            );
            let mend = format!("half a wave length, {} m, is the least, a whole one is better", two_digits_up(least));
            findings.push(Finding::warning("short_damping", what, mend));
        }
        // The waves lose this share of their height, or more, on their first length.
        let takes = |zone: &SpongeLayer<D>| 1.0 - (-zone.rate(&stand.face) * wave.length_m / wave.celerity_mps).exp();
        for zone in zones.iter().filter(|zone| takes(zone) > LARGEST_LOSS) {
            let share = zone.rate(&stand.face) / zone.strength;
            let ends = [&zone.to, &zone.from].map(coordinates);
            let (strength, mend) = match share > 1.0 - 1e-9 {
                true => (
                    "its full".into(),
                    format!("`from` is where waves come from: from = {}, to = {}", ends[0], ends[1]),
                ),
                false => (
                    format!("{} of its", three_digits(share)),
                    "let it begin ahead of the paddle, beyond the place that the waves are to reach".into(),
                ),
            };
            let (zone_m, name) = (zone_extent(zone), &wave.solid);
            let what = format!("{zone_m} is at {strength} strength at \"{name}\", which makes waves");
            findings.push(Finding::warning("reversed_damping", what, mend));
        }
    }
}

/// The name of a damping zone.
pub(super) fn zone_extent<const D: usize>(zone: &SpongeLayer<D>) -> String {
    format!("the damping zone from {} to {}", coordinates(&zone.from), coordinates(&zone.to))
}
