//! A segment of a line as a piece of catenary.
//!
//! Between two nodes a line sags by its weight less buoyancy: w_n (N/m) across the chord. With the tension T and the length l₀
//! without tension, the strain of the chord is (own derivation: the catenary to second order in w l₀/T, as Ernst 1965 for cables)
//!
//!   ε = ε_e(T) − (w_n l₀)²/(24 T²)
//!
//! with the elastic strain ε_e. The mean pull of the segment is T q + l₀² w_t w_n/(12 T), with the unit vector q along the chord
//! and the parts w_t and w_n of the weight along and across it. Half of the weight at each node and this pull are the forces of
//! the catenary on its ends up to the fourth order in l₀; a straight segment is of second order. A segment whose chord is shorter
//! than l₀ has the tension that follows from its sag, and never pushes.
//!
//! Bending stiffness EI holds the sag back as in a beam with clamped ends: T + 48 EI/l₀² takes the place of T in both terms.
//!
//! A segment that lies on a bed does not sag. If the line leaves the bed within a segment, at the share 1 − β of its length, the
//! shortening is 4β³ − 3β⁴ times that of a segment that hangs completely.

use super::{
    forces::{LineMaterial, NodeSurroundings, elastic_law},
    line::MooringLine,
};
use crate::math::Vector;

/// Rounds in which tension and hanging share of a segment that leaves the bed are found: each divides the error by three or more.
const ROUNDS: usize = 3;

/// Most iterations for a tension.
const ITERATIONS: usize = 100;

/// Change of a tension over itself at which the iteration by a table ends, –.
const TOLERANCE: f64 = 1e-14;

/// Change of a tension over itself at which Newton's method ends, –: the error is then of the order of its square.
const NEWTON_TOLERANCE: f64 = 1e-8;

/// What a segment does to its nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct SegmentPull<const D: usize> {
    /// Unit vector along the chord.
    pub(super) q: Vector<D>,
    /// Length of the chord, m.
    pub(super) length: f64,
    /// Tension along the chord without damping, N.
    pub(super) tension: f64,
    /// dT/dε, N.
    pub(super) slope: f64,
    /// Force on the first node, N; the opposite one acts on the second.
    pub(super) pull: Vector<D>,
    /// (w_n l₀)² of what hangs, N².
    #[cfg(test)]
    pub(super) sag: f64,
}

/// The pull of segment `s` of `line` without damping. `around` are the surroundings of each node, and `gravity` is in m/s². `last`
/// is its last tension (N), which saves iterations if it is near; 0 if it is unknown.
pub(super) fn segment_pull<const D: usize>(
    line: &MooringLine<D>,
    s: usize,
    around: &[NodeSurroundings<D>],
    gravity: &Vector<D>,
    last: f64,
) -> SegmentPull<D> {
    let (material, l0) = (&line.material, line.state.segment);
    let (q, length) = line.direction_and_length(s);
    let whole = line.state.broken != Some(s as u32);
    let wet = 0.5 * (around[s].wet + around[s + 1].wet);
    let weight = if whole { gravity * (material.mass - wet * material.displaced()) } else { Vector::zeros() };
    let along = weight.dot(&q);
    let across = weight - q * along;
    let (strain, full, hold) = (length / l0 - 1.0, across.norm_squared() * l0 * l0, beam_hold(material, l0));
    let rise = if whole { rise_from_bed(line, s, around, &weight) } else { None };
    let mut share = if rise.as_ref().is_some_and(RiseFromBed::lies) { 0.0 } else { 1.0 };
    let mut law = if whole { catenary_law(material, strain, full * share, (hold, last)) } else { [0.0; 2] };
    if let Some(rise) = rise.filter(|rise| !rise.lies()) {
        for _ in 0..ROUNDS {
            let before = std::mem::replace(&mut share, rise.hanging_share(law[0], &q, l0));
            if share == before {
                break;
            }
            law = catenary_law(material, strain, full * share, (hold, law[0]));
        }
    }
    let [tension, slope] = law;
    // The sag of a segment between ends at one place has no direction.
    let turned = if tension > 0.0 && length > 0.0 {
        share * l0.powi(3) * along / (12.0 * length * (tension + hold))
    } else {
        0.0
    };
    let pull = q * tension + across * turned;
    SegmentPull {
        q,
        length,
        tension,
        slope,
        pull,
        #[cfg(test)]
        sag: full * share,
    }
}

/// All pulls of `line`, as [`segment_pull`] has them.
pub(super) fn segment_pulls<const D: usize>(
    line: &MooringLine<D>,
    around: &[NodeSurroundings<D>],
    gravity: &Vector<D>,
) -> Vec<SegmentPull<D>> {
    (0..line.segments()).map(|s| segment_pull(line, s, around, gravity, 0.0)).collect()
}

/// The heights of the ends of segment `s` of `line` above the bed below it; `None` if no bed can bear its `weight` (N/m).
fn rise_from_bed<const D: usize>(
    line: &MooringLine<D>,
    s: usize,
    around: &[NodeSurroundings<D>],
    weight: &Vector<D>,
) -> Option<RiseFromBed<D>> {
    if line.material.bed_stiffness * line.material.contact_width == 0.0 {
        return None;
    }
    let height = |i: usize| {
        let bed = around[i].bed?;
        Some((-line.material.depth(&bed, &line.state.x[i]).min(0.0), bed.normal))
    };
    let heights = [height(s), height(s + 1)];
    let (low, normal) = heights.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let high = heights.into_iter().map(|height| height.map_or(f64::INFINITY, |height| height.0)).fold(low, f64::max);
    let pressed = -weight.dot(&normal);
    (pressed > 0.0).then_some(RiseFromBed { heights: [low, high], normal, weight: pressed })
}

/// How a segment rises from a bed.
struct RiseFromBed<const D: usize> {
    /// Heights of its lower and its upper end above the bed, m.
    heights: [f64; 2],
    /// Unit vector out of the bed.
    normal: Vector<D>,
    /// Weight on the bed, N/m.
    weight: f64,
}

impl<const D: usize> RiseFromBed<D> {
    /// Whether the whole segment lies on the bed.
    fn lies(&self) -> bool {
        self.heights[1] == 0.0
    }

    /// The shortening by sag of a segment along `q` with the length `l0` (m) and this `tension` (N), over the shortening if the
    /// whole segment hung, –.
    fn hanging_share(&self, tension: f64, q: &Vector<D>, l0: f64) -> f64 {
        let flat = tension * (q - self.normal * self.normal.dot(q)).norm();
        let [low, high] = self.heights.map(|z| distance_from_touchdown(z, flat / self.weight) / l0);
        let hangs = (high - low).max(low).min(1.0);
        hangs.powi(3) * (4.0 - 3.0 * hangs)
    }
}

/// Length (m) of the line from the point where it leaves a bed to the height `z` (m). `flat` (m) is the tension along the bed
/// over the weight.
pub(super) fn distance_from_touchdown(z: f64, flat: f64) -> f64 {
    (z * (z + 2.0 * flat)).sqrt()
}

/// The addition to the tension by bending that holds a segment of the length `l0` (m) straight, N.
fn beam_hold(material: &LineMaterial, l0: f64) -> f64 {
    48.0 * material.bending / (l0 * l0)
}

/// Tension (N) at the strain of the chord, and its slope dT/dε (N). `sag` is (w_n l₀)² (N²), `hold` (N) is the addition by
/// bending, and `last` (N) a tension that may be near.
fn catenary_law(material: &LineMaterial, strain: f64, sag: f64, (hold, last): (f64, f64)) -> [f64; 2] {
    if sag == 0.0 {
        return elastic_law(material, strain);
    }
    let linear = held_straight(material.stiffness, strain, sag, (hold, last));
    let (held, modulus) = match &material.table {
        None => (linear, material.stiffness),
        Some(_) => held_straight_by_table(material, strain, (sag, hold), linear),
    };
    if held <= hold {
        return [0.0; 2];
    }
    let softening = modulus * sag / (12.0 * held.powi(3));
    [held - hold, modulus / (1.0 + softening)]
}

/// T + `hold` (N) of ε = T/EA − s/(24 (T + hold)²) with EA = `stiffness` (N) and s = `sag` (N²), by Newton's method: from `last`
/// (N) if it is near the solution, otherwise from above.
fn held_straight(stiffness: f64, strain: f64, sag: f64, (hold, last): (f64, f64)) -> f64 {
    let (taut, cubed) = (stiffness * strain + hold, stiffness * sag / 24.0);
    let (near, third) = (last + hold, taut * taut * taut);
    let there = near * near * (near - taut);
    let mut held = if there > 0.5 * cubed && there < 2.0 * cubed {
        near
    } else if third > cubed {
        taut + cubed / (taut * taut)
    } else if third < -cubed {
        (cubed / -taut).sqrt()
    } else {
        taut.max(0.0) + cubed.cbrt()
    };
    for _ in 0..ITERATIONS {
        let step = (held * held * (held - taut) - cubed) / (held * (3.0 * held - 2.0 * taut));
        held -= step;
        if step.abs() <= NEWTON_TOLERANCE * held {
            break;
        }
    }
    held
}

/// T + `hold` (N) by a table, and the slope of the table there. `most` (N) is an upper bound: the value for the largest slope.
fn held_straight_by_table(material: &LineMaterial, strain: f64, (sag, hold): (f64, f64), most: f64) -> (f64, f64) {
    let law = |held: f64| elastic_law(material, strain + sag / (24.0 * held * held));
    let (mut low, mut high, mut held) = (0.0, most, most);
    for _ in 0..ITERATIONS {
        let [own, slope] = law(held);
        let excess = held - hold - own;
        if excess > 0.0 {
            high = held;
        } else {
            low = held;
        }
        let next = held - excess / (1.0 + slope * sag / (12.0 * held.powi(3)));
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - held).abs() <= TOLERANCE * held {
            break;
        }
        held = next;
    }
    (held, law(held)[1])
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/mooring/segment.rs"]
mod tests;
