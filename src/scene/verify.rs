//! Holds the words of a scene against one another, before any file is opened: what cannot be meant is
//! refused with its place.

use super::{
    BoxConfig, FramesChoice, Scene, WaterConfig,
    flexible::FramesConfig,
    solids::{verify_placement, verify_shape},
    wording,
};
use crate::error::{Error, Result, nearest_name};

/// Largest Courant number: still water round a float stays still at 0.8, and boils at 1.0 without another sign.
const CFL_MAX: f64 = 0.8;

/// Fields that a frame can hold.
pub(super) const FIELDS: [&str; 4] = ["velocity", "density", "pressure", "id"];

impl Scene {
    /// The error that `what` is wrong at `key`, with its place and an example.
    pub(super) fn error_at(&self, key: &str, what: impl Into<String>) -> Error {
        let error = Error::scene(what);
        let error = match wording::example(key) {
            Some(example) => error.help(example),
            None => error,
        };
        self.origin.with_location(error, key)
    }

    /// As [`Scene::wrong`], with this help in place of the example.
    pub(super) fn error_with_help(&self, key: &str, what: impl Into<String>, help: impl Into<String>) -> Error {
        self.origin.with_location(Error::scene(what).help(help), key)
    }

    /// Refuses a number that is given and not positive.
    pub(super) fn require_positive(&self, key: &str, x: Option<f64>) -> Result<()> {
        match x {
            Some(x) if !(x > 0.0 && x.is_finite()) => {
                Err(self.error_at(key, format!("{} must be a positive number, not {x}", last_part(key))))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a vector that has not as many numbers as the scene has dimensions.
    pub(super) fn require_dimension(&self, key: &str, x: &[f64]) -> Result<()> {
        let (d, n) = (self.dimension, x.len());
        if n != d {
            let help = format!("a {d}-D scene has vectors of {d} numbers, as in [{}]", vec!["0.0"; d].join(", "));
            return Err(self.error_with_help(key, format!("{} has {n} numbers, not {d}", last_part(key)), help));
        }
        match x.iter().find(|x| !x.is_finite()) {
            Some(x) => Err(self.error_at(key, format!("{x} is not a finite number"))),
            None => Ok(()),
        }
    }

    /// Everything that can be judged without opening a file.
    pub(super) fn verify(&self) -> Result<()> {
        if !(2..=3).contains(&self.dimension) {
            return Err(self.error_at("dimension", format!("dimension is 2 or 3, not {}", self.dimension)));
        }
        self.require_positive("dp", Some(self.dp))?;
        self.require_positive("until", Some(self.until))?;
        if let Some(gravity) = &self.gravity {
            self.require_dimension("gravity", gravity)?;
        }
        if let Some(scatter) = self.scatter.filter(|s| !(0.0..=0.1).contains(s)) {
            return Err(
                self.error_at("scatter", format!("particles start 0 to 0.1 dp off their places, not {scatter}"))
            );
        }
        if let Some(domain) = &self.domain {
            self.verify_box("domain", domain)?;
        }
        self.verify_periodic()?;
        self.verify_guard()?;
        if self.water.is_empty() {
            return Err(self.error_at("water", "the scene has no water"));
        }
        self.water.iter().enumerate().try_for_each(|(i, water)| self.verify_water(&format!("water.{i}"), water))?;
        self.verify_damping()?;
        self.verify_solids()?;
        self.verify_links()?;
        self.verify_laws()?;
        self.verify_probes()?;
        self.verify_records()
    }

    pub(super) fn verify_box(&self, key: &str, corners: &BoxConfig) -> Result<()> {
        self.require_dimension(&format!("{key}.min"), &corners.min)?;
        self.require_dimension(&format!("{key}.max"), &corners.max)?;
        match (0..self.dimension).find(|&i| corners.min[i] >= corners.max[i]) {
            Some(i) => {
                let (min, max) = (corners.min[i], corners.max[i]);
                let axis = ["x", "y", "z"][i];
                let what = format!("{axis} goes from {min} to {max}: nothing lies between");
                Err(self.error_with_help(&format!("{key}.max"), what, "max is the corner with the greater coordinates"))
            }
            None => Ok(()),
        }
    }

    fn verify_water(&self, key: &str, water: &WaterConfig) -> Result<()> {
        self.verify_flow(key, water)?;
        let fill = &water.fill;
        let key = format!("{key}.fill");
        match (&fill.corners, &fill.shape) {
            (Some(corners), None) if fill.at.is_none() => self.verify_box(&format!("{key}.box"), corners),
            (Some(_), None) => Err(self.error_at(&format!("{key}.at"), "a box by its corners needs no place")),
            (None, Some(words)) => {
                verify_shape(self, &format!("{key}.shape"), words)?;
                fill.at.as_ref().map_or(Ok(()), |words| verify_placement(self, &format!("{key}.at"), words, false))
            }
            _ => Err(self.error_at(&key, "fill takes either a box or a shape")),
        }
    }

    fn verify_laws(&self) -> Result<()> {
        let (model, time) = (&self.model, &self.time);
        let numbers = [
            ("model.h_over_dp", model.h_over_dp),
            ("model.c_h", model.c_h),
            ("model.c0", model.c0),
            ("model.c0_factor", model.c0_factor),
            ("model.rho0", model.rho0),
            ("model.gamma", model.gamma),
            ("time.cfl", time.cfl),
            ("time.dt_max", time.dt_max),
        ];
        numbers.into_iter().try_for_each(|(key, x)| self.require_positive(key, x))?;
        let both = |a: &str, b: &str, help: &str| {
            Err(self.error_with_help(&format!("model.{b}"), format!("{a} and {b} say the same thing twice"), help))
        };
        if model.h_over_dp.is_some() && model.c_h.is_some() {
            return both("h_over_dp", "c_h", "give one: h = h_over_dp · dp = c_h · √dimension · dp");
        }
        if model.c0.is_some() && model.c0_factor.is_some() {
            return both("c0", "c0_factor", "give one: c0 = c0_factor · √(g · depth)");
        }
        let reach = 2.0 * self.smoothing_length() / self.dp;
        if !(1.9..=12.0).contains(&reach) {
            let key = if model.c_h.is_some() { "model.c_h" } else { "model.h_over_dp" };
            let what = format!("the kernel would reach {reach:.2} dp; sums over neighbours need 1.9 to 12");
            return Err(self.error_with_help(key, what, "write  h_over_dp = 1.7"));
        }
        match time.cfl {
            Some(cfl) if cfl > CFL_MAX => {
                let what =
                    format!("a Courant number of {cfl}: above {CFL_MAX} water boils, often without another sign");
                Err(self.error_with_help("time.cfl", what, "write  cfl = 0.4; with Verlet  cfl = 0.2"))
            }
            _ => Ok(()),
        }
    }

    /// Smoothing length h, m.
    pub(super) fn smoothing_length(&self) -> f64 {
        match (self.model.h_over_dp, self.model.c_h) {
            (Some(ratio), _) => ratio * self.dp,
            (None, Some(c_h)) => c_h * (self.dimension as f64).sqrt() * self.dp,
            (None, None) => self.default_h_over_dp().0 * self.dp,
        }
    }

    pub(super) fn require_solid(&self, key: &str, name: &str) -> Result<()> {
        if self.solid.iter().any(|solid| solid.name == name) {
            return Ok(());
        }
        let members = self.solid.iter().filter(|solid| solid.group.as_deref() == Some(name));
        let members: Vec<&str> = members.map(|solid| solid.name.as_str()).collect();
        if !members.is_empty() {
            let what = format!("\"{name}\" is a group, and here a single solid is meant");
            let help = "ties, forces and probes are of single solids, and only  [[contact]] between  takes groups; of this one";
            return Err(self.error_with_help(key, what, format!("{help}: {}", members.join(", "))));
        }
        let names: Vec<&str> = self.solid.iter().map(|solid| solid.name.as_str()).collect();
        let known =
            if names.is_empty() { "the scene has no solids".into() } else { format!("known: {}", names.join(", ")) };
        Err(self.error_with_help(key, format!("no solid is called \"{name}\"{}", suggestion(name, &names)), known))
    }

    /// Refuses a name that could not be a file's.
    pub(super) fn require_file_name(&self, key: &str, name: &str) -> Result<()> {
        let good = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || name.len() > 64 || !name.chars().all(good) {
            let help = "a name has letters, digits, _ and -, as in \"box_1\"; files are called after it";
            return Err(self.error_with_help(key, format!("\"{name}\" cannot be a name"), help));
        }
        Ok(())
    }

    fn verify_records(&self) -> Result<()> {
        if let Some(FramesChoice::On(FramesConfig { every, fields, corners })) = &self.frames {
            self.require_positive("frames.every", *every)?;
            if let Some(field) = fields.iter().flatten().find(|field| !FIELDS.contains(&field.as_str())) {
                let what = format!("no field is called \"{field}\"{}", suggestion(field, &FIELDS));
                return Err(self.error_with_help("frames.fields", what, format!("known: {}", FIELDS.join(", "))));
            }
            if let Some(corners) = corners {
                self.verify_box("frames.box", corners)?;
            }
        }
        if let Some(checkpoint) = &self.checkpoint {
            self.require_positive("checkpoint.every", checkpoint.every)?;
            self.require_positive("checkpoint.wall", checkpoint.wall)?;
        }
        self.verify_checks()?;
        self.verify_statistics()
    }
}

/// A list of words for a sentence.
pub(super) fn quoted_list(words: &[&str]) -> String {
    if words.is_empty() { "nothing".into() } else { words.join(" and ") }
}

/// Advice on the nearest of `known`, to end a sentence.
pub(super) fn suggestion(word: &str, known: &[&str]) -> String {
    nearest_name(word, known.iter().copied()).map_or(String::new(), |n| format!("; did you mean \"{n}\"?"))
}

/// The last part of a key.
pub(super) fn last_part(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}
