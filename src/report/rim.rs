//! The contact skin of a solid as it is drawn: where others touch it.

use std::f64::consts::TAU;

use serde::Serialize;

use super::outline::{Outline, outlines, placed, spread};
use crate::{preflight::faces, shape::Shape, space::Vector};

/// Largest turn from one point of a round corner to the next, rad.
const STEP: f64 = TAU / 48.0;

/// Cosine of half the turn of an inner corner, –, beyond which its parallels meet too far off to be looked for.
const LEAST_COSINE: f64 = 0.25;

/// What is nearer to other faces than this part of the skin lies in theirs, –.
const OUTSIDE: f64 = 0.98;

/// The outer side of a contact skin, in the frame of the solid; nothing if it has none.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Rim {
    /// In 2-D its lines.
    pub lines: Vec<Outline>,
    /// In 3-D places on it, m, about dp apart.
    pub dots: Vec<[f64; 3]>,
}

impl Rim {
    /// That of `shape` with a contact skin so thick (m), in a scene of spacing `dp` (m).
    pub fn of<const D: usize>(shape: &Shape<D>, skin: f64, dp: f64) -> Self {
        if skin == 0.0 {
            return Self::default();
        }
        if D == 2 {
            return Self { lines: lines(shape, skin), dots: Vec::new() };
        }
        let outside = |x: &Vector<D>| shape.signed_distance(x) > OUTSIDE * skin;
        let places = faces::of_shape(shape, dp).into_iter().map(|face| face.x + face.n * skin).filter(outside);
        // Rounded to a thousandth of dp: many of them stand on a page.
        let round = |x: f64| (x / (1e-3 * dp)).round() * 1e-3 * dp;
        Self { lines: Vec::new(), dots: places.map(|x| spread(&x).map(round)).collect() }
    }
}

/// The lines of a contact skin in 2-D: of a compound those of its parts, where they lie in no other's skin.
fn lines<const D: usize>(shape: &Shape<D>, skin: f64) -> Vec<Outline> {
    let Shape::Compound(parts) = shape else {
        let around = |line: Outline| Outline { closed: true, points: parallel(&line.points, skin) };
        return outlines(shape).into_iter().map(around).collect();
    };
    let mut found = Vec::new();
    for (i, (pose, part)) in parts.iter().enumerate() {
        let outside = |x: &[f64; 3]| {
            let x = Vector::from_fn(|k, _| x[k]);
            let mut others = parts.iter().enumerate().filter(|(j, _)| *j != i);
            others.all(|(_, (there, other))| other.signed_distance(&there.local(&x)) > OUTSIDE * skin)
        };
        found.extend(placed(pose, lines(part, skin)).into_iter().flat_map(|line| cut(line, skin, outside)));
    }
    found
}

/// The closed line `by` (m) outside the closed line through `points`, round about its corners.
fn parallel(points: &[[f64; 3]], by: f64) -> Vec<[f64; 3]> {
    let n = points.len();
    let edge = |i: usize| {
        let (a, b) = (points[i % n], points[(i + 1) % n]);
        [b[0] - a[0], b[1] - a[1]]
    };
    let area: f64 = (0..n).map(|i| points[i][0] * points[(i + 1) % n][1] - points[i][1] * points[(i + 1) % n][0]).sum();
    let round = area.signum();
    // From one edge to the next, counter-clockwise as the line goes round.
    let turn = |a: [f64; 2], b: [f64; 2]| (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
    let mut line = Vec::new();
    for i in 0..n {
        let (before, after, corner) = (edge(i), edge(i + 1), points[(i + 1) % n]);
        let (turn, start) = (round * turn(before, after), (-round * before[0]).atan2(round * before[1]));
        // Outer corners are round; at inner ones the parallels of both edges meet.
        let (steps, far) = match turn > 0.0 {
            true => ((turn / STEP).ceil() as usize, by),
            false => (0, by / (0.5 * turn).cos().max(LEAST_COSINE)),
        };
        let first = if turn > 0.0 { start } else { start + 0.5 * round * turn };
        line.extend((0..=steps).map(|k| {
            let angle = first + round * turn * k as f64 / steps.max(1) as f64;
            [corner[0] + far * angle.cos(), corner[1] + far * angle.sin(), 0.0]
        }));
    }
    line
}

/// The parts of a line that are `kept`, to about `step` (m).
fn cut(line: Outline, step: f64, kept: impl Fn(&[f64; 3]) -> bool) -> Vec<Outline> {
    let first = line.points.first().filter(|_| line.closed);
    let sides = line.points.iter().zip(line.points.iter().skip(1).chain(first));
    let fine: Vec<[f64; 3]> = sides.flat_map(|(a, b)| divided(a, b, step)).collect();
    let Some(gap) = fine.iter().position(|x| !kept(x)) else { return vec![line] };
    let from = if line.closed { gap } else { 0 };
    let round: Vec<[f64; 3]> = fine[from..].iter().chain(&fine[..from]).copied().collect();
    let runs = round.split(|x| !kept(x)).filter(|run| run.len() > 1);
    runs.map(|run| Outline { closed: false, points: run.to_vec() }).collect()
}

/// Points from `a` to before `b`, about `step` (m) apart, but not more than a thousand.
fn divided(a: &[f64; 3], b: &[f64; 3], step: f64) -> Vec<[f64; 3]> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let count = (length / step).ceil().clamp(1.0, 1000.0);
    (0..count as usize).map(|k| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * k as f64 / count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Pose;

    fn flat(x: [f64; 2]) -> Vector<2> {
        Vector::from(x)
    }

    /// How far the points of the rim of `shape`, 0.02 m thick, are off it, m.
    fn off<const D: usize>(shape: &Shape<D>) -> Vec<f64> {
        let Rim { lines, dots } = Rim::of(shape, 0.02, 0.05);
        let points = lines.iter().flat_map(|line| &line.points).chain(&dots);
        points.map(|x| shape.signed_distance(&Vector::from_fn(|i, _| x[i])) - 0.02).collect()
    }

    #[test]
    fn every_point_of_a_rim_is_as_far_outside_the_faces_as_the_skin_is_thick() {
        let block = |at: [f64; 2]| (Pose::at(flat(at)), Shape::Box { size: flat([0.2, 0.1]) });
        let flat_ones = [
            Shape::Box { size: flat([0.4, 0.2]) },
            Shape::Ball { radius: 0.1 },
            Shape::Capsule { length: 0.3, radius: 0.1, axis: 0 },
            Shape::Tank { size: flat([1.0, 0.5]), thickness: 0.1 },
            // With a corner that points inwards.
            Shape::Polygon { points: [[0.0, 0.0], [0.5, 0.0], [0.2, 0.2], [0.0, 0.5]].map(flat).to_vec() },
            // Two boxes, one on the other's shoulder: what of each lies in the other's skin is left out.
            Shape::Compound(vec![block([0.0, 0.0]), block([0.15, 0.1])]),
        ];
        for shape in flat_ones {
            let off = off(&shape);
            // Circles are drawn with 48 corners: 0.04 mm. What is cut may lie in the other's skin by 2 % of it, 0.4 mm.
            assert!(off.len() > 8 && off.iter().all(|x| (-5e-4..1e-9).contains(x)), "{shape:?}: {off:?}");
        }
        let deep = [
            Shape::Box { size: Vector::<3>::from([0.4, 0.2, 0.3]) },
            Shape::Ball { radius: 0.2 },
            Shape::Tank { size: Vector::from([0.5, 0.5, 0.4]), thickness: 0.1 },
        ];
        for shape in deep {
            let off = off(&shape);
            // Dots are rounded to a thousandth of dp.
            assert!(off.len() > 50 && off.iter().all(|x| x.abs() < 1e-4), "{shape:?}: {off:?}");
        }
        assert_eq!(Rim::of(&Shape::<2>::Ball { radius: 0.1 }, 0.0, 0.05), Rim::default());
    }

    #[test]
    fn the_rim_of_a_box_is_one_closed_line_and_that_of_a_pile_is_cut_where_its_parts_meet() {
        let block = |at: [f64; 2]| (Pose::at(flat(at)), Shape::Box { size: flat([0.2, 0.1]) });
        let lines = |shape: &Shape<2>| Rim::of(shape, 0.02, 0.05).lines;
        let single = lines(&Shape::Box { size: flat([0.2, 0.1]) });
        assert!(single.len() == 1 && single[0].closed, "{single:?}");
        let pile = lines(&Shape::Compound(vec![block([0.0, 0.0]), block([0.15, 0.1])]));
        assert!(pile.len() == 2 && pile.iter().all(|line| !line.closed), "{pile:?}");
    }
}
