//! The bodies of a scene for solvers of linear potential flow: panels below the still water, mass, inertia and hydrostatic
//! stiffness.

use std::{
    fs,
    path::{Path, PathBuf},
};

use serde::Serialize;

use super::{
    Scene,
    build::SceneParts,
    section::water::{StillWaterLevel, basin, open_boxes},
};
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result, nearest_name},
    geometry::{
        hollow::{Hollow, Place},
        panels::{panel_area, panel_volume, wetted_panels},
        world_bounds,
    },
    math::Vector,
    output::{gdf::gdf_text, write_atomically},
    solid::{FreeBody, Role, SolidSpec},
};

/// Size of the panels that measure the wetted area, over the largest size of a solid.
const COARSE: f64 = 0.1;

/// Round-off of levels and depths of the same water, over the depth, –.
const SAME: f64 = 1e-9;

/// A scene as a solver of potential flow needs it. The origin of its frame is that of the scene, at the still water; the last
/// axis is vertical.
#[derive(Clone, Debug, Serialize)]
pub struct PanelledScene {
    /// Caption of the scene.
    pub title: String,
    /// The water.
    pub water: WaterForPanels,
    /// The bodies.
    pub bodies: Vec<PanelledBody>,
}

impl PanelledScene {
    /// Returns the solids of `scene` called `names`, or all free solids that reach into the water if no name is given, with
    /// about `panel_count` panels each. No particles are created.
    ///
    /// # Errors
    /// `Usage` if the scene is 2-D, gravity is not constant downwards, a solid does not exist or does not reach into the
    /// water, or the solids are in water of different levels or depths; those of [`Scene::build`].
    pub fn new(scene: &Scene, names: &[String], panel_count: usize) -> Result<Self> {
        if scene.dimension != 3 {
            let what = "the scene is 2-D, and a panel method computes 3-D bodies";
            let help = "write the body in a 3-D scene; a cylinder or prism that is long against the waves has the coefficients of its \
                        cross-section, over its length";
            return Err(usage(what.into(), help.into()));
        }
        if panel_count == 0 {
            return Err(usage("a body needs one panel or more".into(), "name a number, as  --panels 800".into()));
        }
        let parts = scene.parts::<3>(1)?;
        let gravity = parts.gravity()?;
        let chosen = chosen_solids(&parts, names)?;
        let (density_kg_m3, still) = (parts.model.rho0, parts.still_water_of(&chosen)?);
        let bodies = chosen.into_iter().map(|i| parts.panelled_body(i, gravity, panel_count)).collect();
        let water = WaterForPanels { density_kg_m3, depth_m: still.depth, gravity_m_s2: gravity, level_m: still.level };
        Ok(Self { title: parts.scene.title.clone().unwrap_or_default(), water, bodies })
    }

    /// Writes `bodies.json` and a mesh of each body into the folder `out`, which it creates if necessary. Replaces files of the
    /// same names. Returns the path of `bodies.json`.
    ///
    /// # Errors
    /// `File` if a file cannot be written.
    pub fn write(&self, out: &Path) -> Result<PathBuf> {
        fs::create_dir_all(out).map_err(|why| Error::write(out, "made", &why))?;
        for body in &self.bodies {
            let title = format!("{} of {}", body.name, self.title);
            write_atomically(
                &out.join(&body.mesh),
                gdf_text(&title, self.water.gravity_m_s2, &body.panels).as_bytes(),
            )?;
        }
        let path = out.join("bodies.json");
        let json = serde_json::to_string_pretty(self).map_err(|why| Error::file(&path, why))?;
        write_atomically(&path, (json + "\n").as_bytes())?;
        Ok(path)
    }
}

/// The water of a [`PanelledScene`].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct WaterForPanels {
    /// Density, kg/m³.
    pub density_kg_m3: f64,
    /// Depth of the still water, m.
    pub depth_m: f64,
    /// Gravity, m/s².
    pub gravity_m_s2: f64,
    /// Height of the still water in the frame of the scene, m.
    pub level_m: f64,
}

/// A body of a [`PanelledScene`].
#[derive(Clone, Debug, Serialize)]
pub struct PanelledBody {
    /// Name of the solid.
    pub name: String,
    /// `free`, `driven` or `fixed`.
    pub role: &'static str,
    /// Name of the file of its panels.
    pub mesh: String,
    /// Number of its panels.
    pub panel_count: usize,
    /// Area of the panels, m².
    pub wetted_area_m2: f64,
    /// Volume below the still water within the panels, m³.
    pub panel_volume_m3: f64,
    /// Exact volume of the displaced outside water, m³. It carries the body and the enclosed water.
    pub displaced_volume_m3: f64,
    /// Centre of buoyancy, m.
    pub centre_of_buoyancy_m: [f64; 3],
    /// The point of reference of rotations and moments: the centre of mass of a free solid, or else the origin of its frame, m.
    pub reference_point_m: [f64; 3],
    /// Mass of a free solid, kg.
    pub mass_kg: Option<f64>,
    /// Mass of the water enclosed in hollows, which moves with the body and is not part of `mass_kg`, kg; absent without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub enclosed_water_kg: Option<f64>,
    /// Inertia of a free solid about its centre of mass along the axes of the scene, kg m².
    pub inertia_kg_m2: Option<[[f64; 3]; 3]>,
    /// Hydrostatic stiffness about the reference point: N/m, N and N m. Rows are loads and columns motions, in the order surge,
    /// sway, heave, roll, pitch, yaw. It excludes the weight, which contributes nothing about the centre of mass.
    pub hydrostatic_stiffness: [[f64; 6]; 6],
    /// The panels: triangles, counter-clockwise seen from the water, m.
    #[serde(skip)]
    pub panels: Vec<[[f64; 3]; 3]>,
}

fn usage(what: String, help: String) -> Error {
    Error::new(ErrorKind::Usage, what).help(help)
}

/// Returns the numbers of the solids that are exported.
fn chosen_solids(parts: &SceneParts<3>, names: &[String]) -> Result<Vec<usize>> {
    let specs = &parts.placed.specs;
    let all = || specs.iter().map(|spec| spec.name.as_str());
    let is_wet = |i: &usize| parts.displaced(*i).0 > 0.0;
    if names.is_empty() {
        let free = (0..specs.len()).filter(|i| matches!(specs[*i].role, Role::Free(_)));
        let chosen: Vec<usize> = free.filter(is_wet).collect();
        if chosen.is_empty() {
            let help = format!(
                "name a driven or fixed solid with  --solid NAME;  the solids are: {}",
                all().collect::<Vec<_>>().join(", ")
            );
            return Err(usage("no free solid reaches into the water".into(), help));
        }
        return Ok(chosen);
    }
    let mut chosen = Vec::new();
    for name in names {
        let Some(i) = all().position(|known| known == name) else {
            let help = match nearest_name(name, all()) {
                Some(near) => format!("did you mean {near:?}?"),
                None => format!("the solids are: {}", all().collect::<Vec<_>>().join(", ")),
            };
            let what = format!("there is no solid called {name:?}");
            return Err(usage(what, help).with_code(ErrorCode::UnknownName));
        };
        if !is_wet(&i) {
            let what = format!("{name:?} does not reach into the water: it has no panels");
            return Err(usage(what, "place it lower, or name another solid".into()));
        }
        if !chosen.contains(&i) {
            chosen.push(i);
        }
    }
    Ok(chosen)
}

impl SceneParts<3> {
    /// Returns the gravity, m/s².
    fn gravity(&self) -> Result<f64> {
        let context = self.scene.context();
        match &context.gravity {
            Some(gravity) if !gravity.varies => match gravity.initial[..] {
                [x, y, z] if x == 0.0 && y == 0.0 && z < 0.0 => Ok(-z),
                _ => Err(usage(
                    "gravity is not downwards: there is no still water".into(),
                    "write  gravity = 9.81".into(),
                )),
            },
            _ => Err(usage("gravity changes: there is no still water".into(), "write  gravity = 9.81".into())),
        }
    }

    /// Returns the still water of the basin of solid number `i`.
    fn still_water_around(&self, i: usize) -> StillWaterLevel {
        let spec = &self.placed.specs[i];
        basin(&open_boxes(&self.water), &world_bounds(&spec.shape, &spec.pose)).unwrap_or(self.still)
    }

    /// Returns the still water of the basin of all these solids, at least one.
    fn still_water_of(&self, chosen: &[usize]) -> Result<StillWaterLevel> {
        let first = self.still_water_around(chosen[0]);
        let is_other = |i: &usize| {
            let own = self.still_water_around(*i);
            (own.level - first.level).abs().max((own.depth - first.depth).abs()) > SAME * first.depth
        };
        let Some(other) = chosen.iter().copied().find(is_other) else { return Ok(first) };
        let [first, other] = [chosen[0], other].map(|i| &self.placed.specs[i].name);
        let what = format!("{first:?} and {other:?} are in water of different levels or depths");
        Err(usage(what, format!("name the solids of one basin, as  --solid {first}")))
    }

    /// Returns the volume (m³) of the outside water that solid number `i` displaces, and its centroid.
    fn displaced(&self, i: usize) -> (f64, Vector<3>) {
        let (pose, level) = (&self.placed.specs[i].pose, self.still_water_around(i).level);
        self.placed.hull_at(i, pose, level, &self.water).emptied().submerged_volume(pose, level)
    }

    fn panelled_body(&self, i: usize, gravity: f64, panel_count: usize) -> PanelledBody {
        let (spec, level): (&SolidSpec<3>, f64) = (&self.placed.specs[i], self.still_water_around(i).level);
        let (shape, pose) = (&spec.shape, &spec.pose);
        let hull = self.placed.hull_at(i, pose, level, &self.water).with_own_water_at(pose);
        let enclosed = self.model.rho0 * hull.enclosed_volume(pose);
        let (displaced, buoyancy) = self.displaced(i);
        let is_wet = |x: &Vector<3>| match &self.placed.enclosures[i] {
            Some(enclosure) => match enclosure.place(shape, x) {
                Place::Hollow(number) => {
                    let own: &Hollow<3> = &enclosure.hollows[number];
                    let mut without = hull.dry.iter().copied().chain(hull.filled.iter().map(|(hollow, _)| *hollow));
                    !without.any(|hollow| std::ptr::eq(hollow, own))
                }
                _ => true,
            },
            None => true,
        };
        let of_size = |size: f64| wetted_panels(shape, pose, level, size, is_wet);
        let coarse = of_size(COARSE * shape.bounds().size().max());
        let size = (2.0 * panel_area(&coarse) / panel_count as f64).sqrt();
        // Rows of a round shape have as many panels at its ends as in its middle.
        let panels = of_size(size * (of_size(size).len() as f64 / panel_count as f64).sqrt());
        let body: Option<FreeBody<3>> = spec.initial_body();
        let reference = body.as_ref().map_or(pose.position, |body| pose.point(&body.centre));
        let weight = self.model.rho0 * gravity;
        let from_level = |x: &Vector<3>| [x[0], x[1], x[2] - level];
        let rotation = &pose.rotation;
        PanelledBody {
            name: spec.name.clone(),
            role: match spec.role {
                Role::Free(_) => "free",
                Role::Driven(_) => "driven",
                _ => "fixed",
            },
            mesh: format!("{}.gdf", spec.name),
            panel_count: panels.len(),
            wetted_area_m2: panel_area(&panels),
            panel_volume_m3: panel_volume(&panels, level),
            displaced_volume_m3: displaced,
            centre_of_buoyancy_m: from_level(&buoyancy),
            reference_point_m: from_level(&reference),
            mass_kg: body.as_ref().map(|body| body.mass),
            enclosed_water_kg: (enclosed > 0.0).then_some(enclosed),
            inertia_kg_m2: body.as_ref().map(|body| {
                let inertia = rotation * body.inertia * rotation.transpose();
                std::array::from_fn(|i| std::array::from_fn(|j| inertia[(i, j)]))
            }),
            hydrostatic_stiffness: hull.stiffness(pose, &reference, level).map(|row| row.map(|entry| weight * entry)),
            panels: panels.iter().map(|panel| [0, 1, 2].map(|corner| from_level(&panel[corner]))).collect(),
        }
    }
}

#[cfg(all(test, feature = "dim3"))]
#[path = "../../tests/unit/scene/potential_flow.rs"]
mod tests;
