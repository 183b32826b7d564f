//! From words to solids: shape, pose, role; floats are put at their draft.

use super::{
    DraftChoice, FreeBodyConfig, NumberOrArray, Scene, SolidConfig, TimeFunctionConfig,
    build_waves::StillWater,
    geometry::{pose, shape, vector},
    table,
};
use crate::{
    error::{Error, Result},
    geometry::Shape,
    math::{Bivector, Matrix, Pose, Vector, expression::Formula, time_series::TimeSeries},
    solid::{FreeBody, Role, SolidSpec, TimeFunction, hydrostatics::equilibrium_height},
};

/// Largest extent, dp, of bodies that must weigh half a water particle.
const SMALL: f64 = 7.9;

/// Thickness, dp, below which one row of boundary particles stands for both faces of a body.
const THIN: f64 = 1.5;

/// Least density over the water's of so thin a body, –.
const THIN_DENSITY: f64 = 0.2;

impl Scene {
    /// The solids of the scene; drafts are below the level of `pool`.
    pub(super) fn solids<const D: usize>(&self, pool: &StillWater<D>) -> Result<Vec<SolidSpec<D>>> {
        self.solid.iter().enumerate().map(|(i, words)| self.solid_spec(&format!("solid.{i}"), words, pool)).collect()
    }

    fn solid_spec<const D: usize>(&self, key: &str, words: &SolidConfig, pool: &StillWater<D>) -> Result<SolidSpec<D>> {
        let level = pool.level.level;
        let place = |part: &str| {
            let key = format!("{key}.{part}");
            move |e: Error| self.origin.with_location(e, &key)
        };
        let shape: Shape<D> = shape(self, &words.shape).map_err(place("shape"))?;
        let (name, at) = (&words.name, words.at.clone().unwrap_or_default());
        let mut pose = pose(&at, &shape, level);
        let role = match (&words.driven, &words.free) {
            (Some(words), _) => {
                let key = format!("{key}.driven");
                match self.paddle_motion(&key, words, (&shape, &pose), pool)? {
                    Some(motion) => Role::Driven(motion),
                    None => Role::Driven(self.motion(&key, words)?),
                }
            }
            (None, Some(words)) => {
                let body = free_body(words, &shape);
                let part = if words.inertia.is_some() { "free.inertia" } else { "free" };
                body.check()
                    .map_err(|e| Error { message: format!("solid \"{}\": {}", name, e.message), ..e })
                    .map_err(place(part))?;
                Role::Free(body)
            }
            (None, None) => Role::Fixed,
        };
        if at.draft == Some(DraftChoice::Equilibrium) {
            let Role::Free(body) = &role else {
                let key = format!("{key}.at.draft");
                return Err(self.error_with_help(
                    &key,
                    "only a free body finds its own draft",
                    "give the height or a draft in metres",
                ));
            };
            let rho0 = self.model.rho0.unwrap_or_default();
            let rise = equilibrium_height(&shape, &pose, body.mass, rho0, level).map_err(place("at.draft"))?;
            pose.position[D - 1] += rise;
        }
        let spec = SolidSpec {
            name: words.name.clone(),
            shape,
            pose,
            role,
            friction: words.friction.unwrap_or_default(),
            restitution: words.restitution.unwrap_or_default(),
            contact_skin: words.skin.unwrap_or_default(),
        };
        let blamed = if spec.has_valid_contact_skin() { key.to_string() } else { format!("{key}.skin") };
        spec.check().map_err(|e| self.origin.with_location(e, &blamed))?;
        self.require_mass(key, &spec)?;
        self.require_thickness(key, &spec)?;
        Ok(spec)
    }

    /// Refuses a free body under gravity that is small and weighs less than half a water particle: it would ride on single ones.
    fn require_mass<const D: usize>(&self, key: &str, spec: &SolidSpec<D>) -> Result<()> {
        let (rho0, heavy) = (self.model.rho0.unwrap_or_default(), self.gravity.iter().flatten().any(|g| *g != 0.0));
        let Role::Free(body) = &spec.role else { return Ok(()) };
        let least = 0.5 * rho0 * self.dp.powi(D as i32);
        let small = spec.shape.bounds_at(&Pose::identity()).size().max() < SMALL * self.dp;
        if !heavy || !small || body.mass >= least {
            return Ok(());
        }
        let part = 0.5 * body.mass / least;
        let what =
            format!("\"{}\" is small and weighs {part:.2} of a water particle: no draft could come of that", spec.name);
        let dp = 0.99 * self.dp * (body.mass / least).powf(1.0 / D as f64);
        Err(self.error_with_help(
            &format!("{key}.free"),
            what,
            format!("half of one is the least: write  dp = {dp:.2e}  or less"),
        ))
    }

    /// Refuses a light free plate of a single row of boundary particles, which cannot press on both sides as they should.
    fn require_thickness<const D: usize>(&self, key: &str, spec: &SolidSpec<D>) -> Result<()> {
        let (rho0, heavy) = (self.model.rho0.unwrap_or_default(), self.gravity.iter().flatten().any(|g| *g != 0.0));
        let Role::Free(body) = &spec.role else { return Ok(()) };
        let thickness = spec.shape.bounds_at(&Pose::identity()).size().min();
        let density = body.mass / (rho0 * spec.shape.volume_properties().volume);
        if !heavy || thickness >= THIN * self.dp || density >= THIN_DENSITY {
            return Ok(());
        }
        let what = format!(
            "\"{}\" is {:.2} dp thick and has {density:.2} of the water's density: one row of boundary particles stands for \
             both its faces",
            spec.name,
            thickness / self.dp
        );
        let help = format!(
            "two rows bear it: write  dp = {:.2e}  or less, or make it as heavy as {THIN_DENSITY}",
            0.5 * thickness
        );
        Err(self.error_with_help(&format!("{key}.free"), what, help))
    }

    /// The law that `words` say in this unit.
    pub(super) fn time_function(
        &self,
        key: &str,
        words: &TimeFunctionConfig,
        unit: CoordinateUnit,
    ) -> Result<TimeFunction> {
        let place = |word: &str, e: Error| self.origin.with_location(e, &format!("{key}.{word}"));
        if let Some(text) = &words.formula {
            let formula = Formula::parse(text).map_err(|e| place("formula", e))?;
            return Ok(TimeFunction::Formula(match unit {
                CoordinateUnit::Degrees => {
                    Formula::parse(&format!("({text})*(pi/180)")).map_err(|e| place("formula", e))?
                }
                CoordinateUnit::Metres | CoordinateUnit::Radians => formula,
            }));
        }
        let file = words.file.as_deref().unwrap_or("");
        let path = table::path_beside(&self.origin.folder, file).map_err(|e| place("file", e))?;
        let column = words.column.as_deref().unwrap_or("");
        let time = words.time.as_deref().unwrap_or("");
        let series = table::read_series(&path, time, column).map_err(|e| place("column", e))?;
        let degrees = unit == CoordinateUnit::Degrees || (unit == CoordinateUnit::Radians && column.ends_with("_deg"));
        let factor = words.scale.unwrap_or(1.0) * if degrees { 1f64.to_radians() } else { 1.0 };
        let values: Vec<f64> = series.values().iter().map(|x| x * factor).collect();
        TimeSeries::new(series.times(), values).map(TimeFunction::Table).map_err(|e| place("scale", e))
    }
}

/// The unit in which a law is written.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum CoordinateUnit {
    Metres,
    Radians,
    Degrees,
}

fn free_body<const D: usize>(words: &FreeBodyConfig, shape: &Shape<D>) -> FreeBody<D> {
    let mut body = match (words.density, words.mass) {
        (Some(density), _) => FreeBody::from_density(shape, density),
        (None, mass) => FreeBody::from_mass(shape, mass.unwrap_or_default()),
    };
    match &words.inertia {
        Some(NumberOrArray::One(x)) => {
            body.inertia = Matrix::zeros();
            body.inertia[(0, 0)] = *x;
        }
        Some(NumberOrArray::List(list)) => body.inertia = Matrix::from_diagonal(&vector(list)),
        Some(NumberOrArray::Rows(rows)) => body.inertia = Matrix::from_fn(|i, j| rows[i][j]),
        None => {}
    }
    let given = |x: &Option<Vec<f64>>| x.as_ref().map_or_else(Vector::zeros, |x| vector(x));
    body.centre += given(&words.centre_offset);
    body.velocity = given(&words.velocity);
    body.spin = match &words.spin {
        Some(NumberOrArray::One(x)) => Bivector::from_axial(&[*x]),
        Some(NumberOrArray::List(list)) => Bivector::from_axial(list),
        _ => Bivector::zero(),
    };
    for mode in words.locked.iter().filter_map(|mode| mode.index(D)) {
        match mode.checked_sub(D) {
            None => body.locked_translations[mode] = true,
            Some(axis) => body.locked_rotations[axis] = true,
        }
    }
    body
}
