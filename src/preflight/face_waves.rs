//! Waves that enter through faces, checked against dp and the current.

use std::f64::consts::TAU;

use serde::Serialize;

use super::{Finding, PreflightContext, generated_waves::check_resolution};
use crate::{
    math::format::{three_digits, two_digits_up},
    wavemaker::period_of_length,
};

/// Waves that enter through a face on a current: a regular wave, or the one of the significant height and the peak period of a sea.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaceWave {
    /// Name of the face.
    pub face: String,
    /// Height, m; the significant one of an irregular sea.
    pub height_m: f64,
    /// The same height over dp.
    pub height_dp: f64,
    /// Period at a fixed place, s; that of the peak of an irregular sea.
    pub period_s: f64,
    /// Length on the current, m.
    pub length_m: f64,
    /// The same length over dp.
    pub length_dp: f64,
    /// Depth at the face, m.
    pub depth_m: f64,
    /// Relative depth kd.
    pub kd: f64,
    /// Current along the waves, m/s; negative against them.
    pub current_mps: f64,
    /// Number of components: 1 of a regular wave.
    pub components: usize,
    /// Part of the energy of a spectrum in waves that the current stops, and that therefore do not enter.
    pub left_out: f64,
    /// Greatest velocity of the water by the waves alone, m/s; below the current.
    pub orbital_mps: f64,
    /// Speed of the crests at a fixed place, m/s.
    pub celerity_mps: f64,
    /// Speed of the wave's front and energy at a fixed place, m/s.
    pub group_mps: f64,
    /// Duration of the rise to the full height, s.
    pub ramp_s: f64,
}

/// Returns the waves that enter through faces, and adds findings about those that dp does not resolve.
pub(super) fn face_waves<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) -> Vec<FaceWave> {
    let dp = context.dp();
    let faces = context.system.open_boundaries().iter().filter_map(|face| Some((face, face.waves.as_ref()?)));
    let waves = faces.map(|(face, waves)| {
        let ((height_m, omega, in_water), current_mps) = (waves.main_train(), waves.current());
        FaceWave {
            face: face.name.clone(),
            height_m,
            height_dp: height_m / dp,
            period_s: TAU / omega,
            length_m: in_water.wavelength(),
            length_dp: in_water.wavelength() / dp,
            depth_m: in_water.depth,
            kd: in_water.kd(),
            current_mps,
            components: waves.component_count(),
            left_out: waves.left_out(),
            orbital_mps: waves.orbital_speed(),
            celerity_mps: in_water.celerity() + current_mps,
            group_mps: in_water.group_velocity() + current_mps,
            ramp_s: waves.ramp(),
        }
    });
    let waves: Vec<FaceWave> = waves.collect();
    for wave in &waves {
        let (height, length) = ((wave.height_m, wave.height_dp), (wave.length_m, wave.length_dp));
        let period = |length: f64| period_of_length(length, wave.depth_m, wave.current_mps, context.g);
        check_resolution((&wave.face, "lets in"), height, length, &period, findings);
        if wave.left_out > 0.0 {
            let what = format!(
                "the current of {} m/s stops the shortest waves of the sea that open boundary {:?} lets in, {} % of its energy: the \
                 others are higher instead",
                three_digits(wave.current_mps),
                wave.face,
                two_digits_up(100.0 * wave.left_out)
            );
            let mend = "choose a slower current or a longer peak period for the whole spectrum".into();
            findings.push(Finding::note("waves_left_out", what, mend));
        }
    }
    waves
}
