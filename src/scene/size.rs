//! What a run of a scene will take, told from its words: no particle is made.

use super::{
    FramesChoice, FramesConfig, Scene, build::WaterBody, build_waves::StillWater, geometry::world_bounds,
    verify::FIELDS,
};
use crate::{error::Result, math::format::bytes, model::TimeScheme, output::frame::particle_bytes};

/// About how large a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeEstimate {
    /// 2 or 3.
    pub dimension: usize,
    /// Particles of water.
    pub fluid: f64,
    /// Particles of all skins.
    pub boundary: f64,
    /// The largest time step that sound and the Courant number allow, s.
    pub dt: f64,
    /// Steps to the end at that step: there will be some more.
    pub steps: f64,
    /// Force passes a step.
    pub passes: f64,
}

impl SizeEstimate {
    /// Water particles × force passes: what a run's time is about proportional to.
    pub fn particle_passes(&self) -> f64 {
        self.fluid * self.steps * self.passes
    }
}

/// How far from the origin water may be, in supports of the kernel: beyond, differences of places are not exact.
const FARTHEST: f64 = 1e8;

/// Disk that frames take at most where nobody says how many there are, B; and how few and how many they are then.
const DISK: f64 = 200e6;
const FRAMES: [f64; 2] = [20.0, 100.0];

impl Scene {
    /// Refuses water so far from the origin that numbers cannot tell its particles' places apart.
    pub(super) fn require_near_origin<const D: usize>(&self, water: &[WaterBody<D>]) -> Result<()> {
        let most = FARTHEST * 2.0 * self.smoothing_length();
        let far = |body: &WaterBody<D>| {
            let bounds = world_bounds(&body.region.shape, &body.region.pose);
            bounds.min.iter().chain(bounds.max.iter()).map(|x| x.abs()).fold(0.0, f64::max)
        };
        match water.iter().map(far).enumerate().find(|(_, far)| *far > most) {
            Some((i, far)) => {
                let what = format!("this water is {far:.1e} m from the origin; places are exact up to {most:.1e} m");
                Err(self.error_with_help(
                    &format!("water.{i}.fill"),
                    what,
                    "move the scene to the origin, or make dp larger",
                ))
            }
            None => Ok(()),
        }
    }

    /// About how large a run of this scene is.
    ///
    /// # Errors
    /// `Scene` if the words contradict one another, a shape is none, or the particles are too many.
    pub fn estimate_size(&self) -> Result<SizeEstimate> {
        let (scene, _) = self.with_defaults()?;
        match scene.dimension {
            2 => scene.sized::<2>(),
            _ => scene.sized::<3>(),
        }
    }

    /// About how many particles of water there are, solids not taken off; none of water that is no shape.
    fn water_particles(&self) -> f64 {
        fn count<const D: usize>(scene: &Scene) -> Result<f64> {
            Ok(scene.estimated_counts::<D>(&scene.water_bodies()?, &[]).0)
        }
        let counted = if self.dimension == 2 { count::<2>(self) } else { count::<3>(self) };
        counted.unwrap_or(0.0)
    }

    /// How many frames a run has where nobody says it, and why.
    pub(super) fn default_frames(&self) -> (f64, String) {
        let fields = match &self.frames {
            Some(FramesChoice::On(FramesConfig { fields: Some(fields), .. })) => fields.clone(),
            _ => FIELDS.map(String::from).to_vec(),
        };
        let frame = particle_bytes(&fields).0 * self.water_particles();
        let count = (DISK / frame).floor().clamp(FRAMES[0], FRAMES[1]);
        match count {
            _ if count == FRAMES[1] => (count, format!("{count} frames a run")),
            _ => (
                count,
                format!("{count} frames a run of about {} each: more would take over {}", bytes(frame), bytes(DISK)),
            ),
        }
    }

    fn sized<const D: usize>(&self) -> Result<SizeEstimate> {
        let water = self.water_bodies::<D>()?;
        let model = self.build_model(&water)?;
        let solids = self.solids::<D>(&StillWater::of(&water))?;
        self.require_affordable(&water, &solids)?;
        let (fluid, boundary) = self.estimated_counts(&water, &solids);
        let dt = (model.cfl * model.h / model.c0).min(model.dt_max);
        let passes = if matches!(model.scheme, TimeScheme::Verlet { .. }) { 1.0 } else { 2.0 };
        Ok(SizeEstimate { dimension: D, fluid, boundary, dt, steps: (self.until / dt).ceil(), passes })
    }
}
