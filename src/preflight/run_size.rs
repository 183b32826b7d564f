//! The size of a run: particles, memory, disk space.

use serde::Serialize;

use super::{Finding, PreflightContext, StepSizeLimits};
use crate::{
    math::format::{bytes, three_digits, two_digits_up},
    model::PressureGradient,
    output::frame::particle_bytes,
};

/// Disk space of frames above which a finding is reported, B.
const BUDGET: f64 = 10e9;

/// Shares of the water lattice covered by solids above which a note and a warning are reported.
const TAKEN: [f64; 2] = [0.25, 0.5];

/// Memory of the program without particles, B.
const PROGRAM: f64 = 14e6;

/// Memory that a frame takes while it is written, B: the compressor with its window and tables, a piece of an array, and a block before
/// and after compression.
const FRAME: f64 = 0.6e6;

/// Round-off of the number of outputs in a run.
const ROUND_OFF: f64 = 1e-9;

/// Length of a number in a table with its comma, B: seventeen digits as a rule.
const NUMBER: f64 = 19.0;

/// The size of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunSize {
    /// Dimension, 2 or 3.
    pub dimension: usize,
    /// Number of water particles.
    pub fluid: usize,
    /// Number of boundary particles of all solids.
    pub boundary: usize,
    /// Number of boundary particles near water; the other boundary particles cost almost nothing.
    pub wet: usize,
    /// Number of layers of boundary particles.
    pub layers: usize,
    /// Depth of the water, m.
    pub depth_m: f64,
    /// The same depth over dp.
    pub depth_dp: f64,
    /// Number of sites of the water lattice that solids cover.
    pub removed: usize,
    /// Approximate memory for arrays, lists and frames during the run, B.
    pub memory_bytes: f64,
    /// The disk space of the outputs.
    pub disk: DiskUse,
}

/// The approximate disk space of the outputs of a run, B.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DiskUse {
    /// Tables of the probes.
    pub tables_bytes: f64,
    /// Number of frames.
    pub frames: usize,
    /// All frames.
    pub frames_bytes: f64,
    /// A checkpoint, before it is packed.
    pub checkpoint_bytes: f64,
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Returns the size of the run; `columns` contains the number of columns that each probe writes, without the time.
    pub(super) fn size(
        &self,
        step: &StepSizeLimits,
        columns: &[usize],
        removed: usize,
        findings: &mut Vec<Finding>,
    ) -> RunSize {
        let (system, model) = (self.system, self.system.model());
        let (fluid, boundary) = (system.fluid().len(), system.boundary().len());
        let disk = self.disk(step, columns);
        let share = removed as f64 / (removed + fluid) as f64;
        if share > TAKEN[0] {
            let what = format!("solids take {} % of what the water was to fill", three_digits(100.0 * share));
            let mend = "if that is not meant, see where they are".to_string();
            findings.push(if share > TAKEN[1] {
                Finding::warning("water_removed", what, mend)
            } else {
                Finding::note("water_removed", what, mend)
            });
        }
        if disk.frames_bytes > BUDGET {
            let what = format!("{} frames will take {}", disk.frames, bytes(disk.frames_bytes));
            let every = self.plan.frames.as_ref().map_or(0.0, |f| f.every).max(step.dt_s);
            let mend =
                format!("frames.every = {} keeps them to 10 GB", two_digits_up(every * disk.frames_bytes / BUDGET));
            findings.push(Finding::warning("large_frames", what, mend));
        }
        RunSize {
            dimension: D,
            fluid,
            boundary,
            wet: system.boundary_near_fluid_count(),
            layers: model.boundary_layers(),
            depth_m: self.still_water.depth,
            depth_dp: self.still_water.depth / model.dp,
            removed,
            memory_bytes: self.memory(),
            disk,
        }
    }

    /// Memory (B) of a run: the program, the arrays of the particles, and the temporary memory of a step or a frame. The states
    /// for a rollback are in files.
    fn memory(&self) -> f64 {
        let system = self.system;
        let boundary = system.boundary().len() as f64;
        // A frame is written a block of an array at a time, with the numbers of each boundary particle and of its solid.
        let frame = self.plan.frames.as_ref().map_or(0.0, |_| FRAME + size_of::<(u32, f32)>() as f64 * boundary);
        let for_a_while = (system.step_memory_bytes() as f64).max(frame);
        PROGRAM + system.memory_bytes() as f64 + for_a_while
    }

    fn disk(&self, step: &StepSizeLimits, columns: &[usize]) -> DiskUse {
        let (fluid, boundary) = (self.system.fluid().len() as f64, self.system.boundary().len() as f64);
        // An output comes at every step at most, at the start and at the end.
        let count = |every: f64| (self.end_time() / every.max(step.dt_s) - ROUND_OFF).ceil() + 1.0;
        let tables = self.plan.probes.iter().zip(columns);
        let tables_bytes =
            tables.map(|(probe, n)| count(probe.every) * (n + 1) as f64 * NUMBER).fold(0.0, |sum, x| sum + x);
        let frames = self.plan.frames.as_ref().map_or(0.0, |f| count(f.every));
        let (water, solids) = self.plan.frames.as_ref().map_or((0.0, 0.0), |frames| particle_bytes(&frames.fields));
        let d = D as f64;
        // Gradient corrections; those far from the surface are zeros.
        let plain = self.system.model().gradient == PressureGradient::Plain;
        let corrections = if plain { 0.0 } else { 4.0 * d * d };
        DiskUse {
            tables_bytes,
            frames: frames as usize,
            frames_bytes: frames * (fluid * water + boundary * solids),
            checkpoint_bytes: fluid * (3.0 * d * 8.0 + 11.0 + corrections)
                + self.system.boundary_near_fluid_count() as f64 * 11.0,
        }
    }
}
