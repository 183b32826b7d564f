//! Open boundaries of a scene, and the note on water that a towed frame meets.

use crate::{
    error::Result,
    math::{Vector, format::three_digits},
    model::Model,
    scene::{
        OpenBoundaryConfig, Scene,
        context::{Context, FileNote},
        section::{open_boundary::FaceFlow, water::WaterBody},
    },
    simulation::{OpenBoundary, TowedFrame},
    system::buffer_length,
};

/// Returns the key, the configuration and the sense of the flow of each open boundary.
pub(super) fn open_faces(scene: &Scene) -> impl Iterator<Item = (String, &OpenBoundaryConfig, FaceFlow)> {
    let sections = [(&scene.inflow, FaceFlow::In), (&scene.outflow, FaceFlow::Out)];
    sections.into_iter().flat_map(|(faces, flow)| {
        faces.iter().enumerate().map(move |(i, face)| (format!("{}.{i}", flow.section()), face, flow))
    })
}

/// Returns the open boundaries beside `water`, and the water of their buffers.
pub(super) fn open_boundaries<const D: usize>(
    scene: &Scene,
    ctx: &Context,
    water: &[WaterBody<D>],
    model: &Model,
) -> Result<(Vec<OpenBoundary<D>>, Vec<WaterBody<D>>)> {
    let length = buffer_length(model);
    let build = |(key, face, flow): (String, &OpenBoundaryConfig, FaceFlow)| {
        face.build(ctx, (&key, flow), water, (length, scene.until), None)
    };
    Ok(open_faces(scene).map(build).collect::<Result<Vec<_>>>()?.into_iter().unzip())
}

/// Gives those of the open `boundaries` beside which a solid fills the lowest part of the region of the `water` the depth above this
/// solid. `filled` are the places (m) of the water, and those of the buffers.
pub(super) fn set_depths_at_faces<const D: usize>(
    scene: &Scene,
    ctx: &Context,
    boundaries: &mut [OpenBoundary<D>],
    (water, buffers, filled): (&[WaterBody<D>], &[WaterBody<D>], &[Vector<D>]),
    model: &Model,
) -> Result<()> {
    for (((key, config, flow), face), buffer) in open_faces(scene).zip(boundaries).zip(buffers) {
        let heights = filled.iter().filter(|r| face.beyond(r) > 0.0).map(|r| r[D - 1]);
        let bed = heights.fold(f64::INFINITY, f64::min) - 0.5 * model.dp;
        if bed.is_finite() && bed > buffer.bottom + model.dp {
            let size = (buffer_length(model), scene.until);
            *face = config.build(ctx, (&key, flow), water, size, Some(bed))?.0;
        }
    }
    Ok(())
}

/// Adds a note if the water, with this `velocity` in the frame of the carriage, moves over the ground at the start.
pub(super) fn note_start_of_tow<'a, const D: usize>(
    ctx: &Context,
    towed: &TowedFrame,
    velocity: impl Iterator<Item = &'a Vector<D>>,
) {
    let speed = towed.velocity.value_and_rate(0.0).0;
    let (sum, count) = velocity.fold((0.0, 0.0), |(sum, count), v| (sum + v[towed.axis], count + 1.0));
    let mean = sum / f64::max(count, 1.0);
    if (mean + speed).abs() > 0.01 * speed.abs() {
        // Without the sign of a zero.
        let [carriage, water, ground, still] = [speed, mean, mean + speed, 0.0 - speed].map(three_digits);
        let what = format!(
            "the carriage starts at {carriage} m/s and the water at {water} m/s in its frame, which is {ground} m/s over the ground"
        );
        let mend = format!(
            "water at rest over the ground has a [[water]] velocity of {still} along the way, or let the carriage start from rest"
        );
        ctx.add_note(FileNote::note("towed_start", what, mend));
    }
}
