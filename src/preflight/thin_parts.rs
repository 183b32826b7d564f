//! Parts of solids that the particles represent only roughly or not at all, and walls that nearly close.

use super::{Finding, PreflightContext, surface_samples::SurfaceSample};
use crate::{
    geometry::{
        Shape,
        cells::PointCells,
        thin::{face_cells, thin_place},
        wall::is_closed,
    },
    math::{
        Vector,
        format::{coordinates, three_digits, two_digits_down},
    },
    model::Walls,
    solid::Solid,
};

/// The water sees a place of the face if a boundary particle lies within this distance of it, dp. In a wedge of 20 degrees, the
/// sharpest without a layer in its middle, the first particle lies 2.9 dp from the tip.
const WITHIN: f64 = 3.0;

/// Thickness of a part of a compound, dp, from which on its rows hardly depend on its being a part.
const STACKED: f64 = 3.0;

/// Adds findings about thin parts, parts without particles, and nearly closed walls of every solid.
pub(super) fn check_parts<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (dp, reach) = (context.dp(), context.system.model().support_radius());
    for (solid, faces) in context.solids().iter().zip(&context.surface_samples) {
        findings.extend(thin_part(context, solid, faces));
        findings.extend(unseen_part(solid, faces, dp));
        findings.extend(stacked_parts(solid, dp));
        findings.extend(nearly_closed(solid, reach));
    }
}

/// The parts thinner than dp: a single layer of particles stands for them, as if they were dp thick.
fn thin_part<const D: usize>(
    context: &PreflightContext<D>,
    solid: &Solid<D>,
    samples: &[SurfaceSample<D>],
) -> Option<Finding> {
    let dp = context.dp();
    let limit = dp * (1.0 - 1e-6);
    let thin = |face: &SurfaceSample<D>| thin_place(&solid.spec.shape, &face.x, limit, 1e-3 * dp);
    let found: Vec<_> = samples.iter().filter_map(thin).collect();
    let thinnest = found.iter().min_by(|a, b| a.thickness.total_cmp(&b.thickness))?;
    // Each place is seen from both of its faces.
    let area = 0.5 * found.len() as f64 * dp.powi(D as i32 - 1);
    let excess: f64 = found.iter().map(|place| 0.5 * (dp - place.thickness)).sum::<f64>() * dp.powi(D as i32 - 1);
    let (space, extent) = units::<D>();
    let corrected = match context.system.model().walls {
        Walls::RelaxedAdami => ", whose buoyancy is taken off",
        _ => "",
    };
    let what = format!(
        "\"{}\" is thinner than dp over {} {extent}, {} dp at {}: one layer of boundary particles stands for it, and \
             the water makes way for {} {space} more than its volume{corrected}",
        solid.spec.name,
        three_digits(area),
        three_digits(thinnest.thickness / dp),
        coordinates(&solid.kinematics.pose.point(&thinnest.middle)),
        three_digits(excess),
    );
    let mend = format!("make it dp thick, or dp = {}", two_digits_down(thinnest.thickness));
    Some(Finding::note("thin_part", what, mend))
}

/// The parts of outlines and meshes without boundary particles.
fn unseen_part<const D: usize>(solid: &Solid<D>, faces: &[SurfaceSample<D>], dp: f64) -> Option<Finding> {
    let shape = &solid.spec.shape;
    if !matches!(shape, Shape::Polygon { .. } | Shape::Mesh { .. }) {
        return None;
    }
    let places: Vec<Vector<D>> = faces.iter().map(|face| face.x).collect();
    let near = PointCells::new(&places, WITHIN * dp);
    let is_unseen = |x: &Vector<D>| {
        let mut unseen = shape.signed_distance(x).abs() < 0.5 * dp;
        near.visit_near(x, WITHIN * dp, |_, y| unseen &= (x - y).norm() > WITHIN * dp);
        unseen
    };
    let unseen: Vec<Vector<D>> = face_cells(shape, dp).into_iter().filter(is_unseen).collect();
    let middle = unseen.get(unseen.len() / 2)?;
    let (_, extent) = units::<D>();
    let what = format!(
        "the water does not see some {} {extent} of the face of \"{}\" around {}: it is too thin for boundary \
             particles, but counts in mass and buoyancy",
        three_digits(unseen.len() as f64 * dp.powi(D as i32 - 1)),
        solid.spec.name,
        coordinates(&solid.kinematics.pose.point(middle)),
    );
    Some(Finding::warning("unseen_part", what, "make it dp thick, or dp smaller".to_string()))
}

/// Parts of a compound that are thin, no whole number of dp thick, and lie with a face against another part. Each part has its own rows of
/// boundary particles: a box of 9 dp as ten slabs of 0.9 dp has 0.93 of its buoyancy, one of 3 dp as six slabs 0.84 (2-D, dp 20 mm).
fn stacked_parts<const D: usize>(solid: &Solid<D>, dp: f64) -> Option<Finding> {
    let Shape::Compound(parts) = &solid.spec.shape else { return None };
    let boxes: Vec<_> = parts.iter().map(|(pose, part)| part.bounds_at(pose)).collect();
    let is_stacked = |i: usize| {
        let (own, size) = (&boxes[i], boxes[i].size());
        let (across, thickness) = (size.imin(), size.min() / dp);
        let is_rough = thickness < STACKED && (thickness - thickness.round()).abs() > 0.05;
        is_rough
            && boxes.iter().enumerate().any(|(j, other)| {
                let gap = (other.min[across] - own.max[across]).max(own.min[across] - other.max[across]);
                let shared = |axis: usize| other.max[axis].min(own.max[axis]) - other.min[axis].max(own.min[axis]);
                let beside = (0..D).filter(|&axis| axis != across).all(|axis| shared(axis) > 0.5 * size[axis]);
                i != j && gap.abs() < 0.1 * dp && beside
            })
    };
    let count = (0..parts.len()).filter(|&i| is_stacked(i)).count();
    (count > 0).then(|| {
        let what = format!(
            "{count} parts of \"{}\" lie flat against others and are no whole number of dp thick: each has its own rows of boundary \
             particles, and the buoyancy errs by up to 16 %",
            solid.spec.name
        );
        Finding::note("stacked_parts", what, "draw them as one shape".to_string())
    })
}

/// An open polyline whose ends leave a gap that the kernel spans.
fn nearly_closed<const D: usize>(solid: &Solid<D>, reach: f64) -> Option<Finding> {
    let Shape::Polyline { points, .. } = &solid.spec.shape else { return None };
    let (first, last) = (points.first()?, points.last()?);
    let length: f64 = points.windows(2).map(|ab| (ab[1] - ab[0]).norm()).sum();
    let gap = (last - first).norm();
    let longest = points.windows(2).map(|ab| (ab[1] - ab[0]).norm()).fold(reach, f64::max);
    if is_closed(points) || points.len() < 4 || gap > longest || gap > 0.1 * length {
        return None;
    }
    let what = format!(
        "the ends of \"{}\" lie {} m apart at {}: water passes between them",
        solid.spec.name,
        three_digits(gap),
        coordinates(&solid.kinematics.pose.point(first)),
    );
    Some(Finding::warning("open_ring", what, "closed = true  makes it a wall all round".to_string()))
}

/// The units of a volume and of a face.
fn units<const D: usize>() -> (&'static str, &'static str) {
    if D == 3 { ("m³", "m²") } else { ("m²", "m") }
}
