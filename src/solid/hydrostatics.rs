//! Hydrostatics: the height at which a body floats, and its metacentric height.

use crate::{
    error::{Error, Result},
    geometry::{Shape, hollow::Hollow},
    math::{Bivector, Bounds, Pose, Vector, format::four_digits},
    solid::FreeBody,
};

/// The water in a hollow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum HollowWater {
    /// Of this volume, m³ (m² in 2-D), at any pose.
    Volume(f64),
    /// Up to this height, m.
    Level(f64),
}

impl HollowWater {
    /// Volume (m³; m² in 2-D) of the water in `hollow` at `pose`.
    fn volume<const D: usize>(self, hollow: &Hollow<D>, pose: &Pose<D>) -> f64 {
        match self {
            Self::Volume(volume) => volume,
            Self::Level(level) => hollow.volume_and_moment_below(pose, level).0,
        }
    }

    /// Volume (m³; m² in 2-D) of the water in `hollow` at `pose`, and its first moment.
    fn volume_and_moment<const D: usize>(self, hollow: &Hollow<D>, pose: &Pose<D>) -> (f64, Vector<D>) {
        match self {
            Self::Volume(volume) => (volume, hollow.volume_and_moment_below(pose, hollow.level_of(pose, volume)).1),
            Self::Level(level) => hollow.volume_and_moment_below(pose, level),
        }
    }
}

/// The volume of water that a solid displaces: that of its material and of its hollows that outside water does not fill, less
/// that of the water in these hollows.
pub(crate) struct Hull<'a, const D: usize> {
    pub(crate) shape: &'a Shape<D>,
    /// The hollows without water.
    pub(crate) dry: Vec<&'a Hollow<D>>,
    /// The hollows with enclosed water, which moves with the hull.
    pub(crate) filled: Vec<(&'a Hollow<D>, HollowWater)>,
}

impl<'a, const D: usize> Hull<'a, D> {
    /// A solid without such hollows.
    pub(crate) fn new(shape: &'a Shape<D>) -> Self {
        Self { shape, dry: Vec::new(), filled: Vec::new() }
    }

    /// Volume (m³; m² in 2-D) and centroid of the displaced water less the water in hollows, at `pose` with the still water at
    /// `level` (m). A hollow whose rim lies below the level is full of water of that level.
    pub(crate) fn submerged_volume(&self, pose: &Pose<D>, level: f64) -> (f64, Vector<D>) {
        let (volume, centroid) = self.shape.submerged_volume(pose, level);
        // The level stands at the rim up to round-off where the search for an equilibrium begins.
        let slack = 1e-9 * (level.abs() + self.shape.bounds().size().max());
        let (mut all, mut first) = (volume, centroid * volume);
        let mut any = false;
        for hollow in self.hollows().filter(|hollow| hollow.rim_height(pose) >= level - slack) {
            let (volume, moment) = hollow.volume_and_moment_below(pose, level);
            (all, first, any) = (all + volume, first + moment, true);
        }
        for (hollow, water) in self.filled.iter().filter(|(hollow, _)| hollow.rim_height(pose) >= level - slack) {
            let (volume, moment) = water.volume_and_moment(hollow, pose);
            (all, first) = (all - volume, first - moment);
        }
        if any && all != 0.0 { (all, first / all) } else { (all, centroid) }
    }

    /// The same hull without enclosed water, which displaces the water around it alike.
    pub(crate) fn emptied(self) -> Self {
        Self { dry: self.hollows().collect(), filled: Vec::new(), ..self }
    }

    /// Volume (m³; m² in 2-D) of the enclosed water at `pose`.
    pub(crate) fn enclosed_volume(&self, pose: &Pose<D>) -> f64 {
        self.filled.iter().map(|(hollow, water)| water.volume(hollow, pose)).sum()
    }

    /// The same hull with fixed volumes of enclosed water: those at `pose`.
    pub(crate) fn with_own_water_at(mut self, pose: &Pose<D>) -> Self {
        self.filled.iter_mut().for_each(|(hollow, water)| *water = HollowWater::Volume(water.volume(hollow, pose)));
        self
    }

    /// The hollows in which water does not stand as high as outside.
    fn hollows(&self) -> impl Iterator<Item = &'a Hollow<D>> {
        self.dry.iter().copied().chain(self.filled.iter().map(|(hollow, _)| *hollow))
    }

    /// Volume (m³; m² in 2-D) of the displaced water, with hollows dry even if their rim lies below the level.
    pub(crate) fn volume_if_dry(&self, pose: &Pose<D>, level: f64) -> f64 {
        let hollows: f64 = self.hollows().map(|hollow| hollow.volume_and_moment_below(pose, level).0).sum();
        self.shape.submerged_volume(pose, level).0 + hollows - self.enclosed_volume(pose)
    }

    /// Lowest and highest height (m) of the box around the hull at `pose`.
    pub(crate) fn extent(&self, pose: &Pose<D>) -> [f64; 2] {
        let (low, high) = vertical_extent(self.shape, pose);
        [low, high]
    }

    /// Height (m) of the lowest rim of these hollows at `pose`; infinity if none is open.
    pub(crate) fn rim_height(&self, pose: &Pose<D>) -> f64 {
        self.hollows().map(|hollow| hollow.rim_height(pose)).fold(f64::INFINITY, f64::min)
    }

    /// Lowest height (m) of the hull at `pose`, and the height that water reaches before it floods or covers the hull.
    fn floating_extent(&self, pose: &Pose<D>) -> [f64; 2] {
        let (low, high) = vertical_extent(self.shape, pose);
        [low, high.min(self.rim_height(pose))]
    }

    /// The same as [`equilibrium_height`]. With the level above the rim the hull counts as sunk.
    pub(crate) fn equilibrium_height(&self, pose: &Pose<D>, mass: f64, rho0: f64, level: f64) -> Result<f64> {
        let lifted = |height: f64| {
            let mut pose = *pose;
            pose.position[D - 1] += height;
            pose
        };
        // From just submerged, or about to flood, to just out of the water.
        let [low, high] = self.floating_extent(pose);
        let (mut under, mut over) = (level - high, level - low);
        let whole = self.submerged_volume(&lifted(under), level).0;
        if !(mass > 0.0 && mass < rho0 * whole) {
            return Err(self.sinking_error(pose, mass, rho0 * whole));
        }
        while over - under > 1e-14 * (high - low + level.abs()) {
            let middle = 0.5 * (under + over);
            if middle <= under || middle >= over {
                break;
            }
            if rho0 * self.submerged_volume(&lifted(middle), level).0 > mass {
                under = middle;
            } else {
                over = middle;
            }
        }
        Ok(0.5 * (under + over))
    }

    /// The same as [`Hull::equilibrium_height`] for the displaced `volume` (m³; m² in 2-D), with a fifth of the evaluations, but
    /// with a relative error of the volume of 1e-12. `None` if the hull sinks or floods.
    pub(crate) fn rise_afloat(&self, pose: &Pose<D>, volume: f64, level: f64) -> Option<f64> {
        let more = |rise: f64| {
            let mut pose = *pose;
            pose.position[D - 1] += rise;
            self.submerged_volume(&pose, level).0 - volume
        };
        let [low, high] = self.floating_extent(pose);
        let (mut under, mut over) = (level - high, level - low);
        let (mut most, mut least) = (more(under), -volume);
        if !(most > 0.0 && volume > 0.0) {
            return None;
        }
        let (mut middle, mut sank) = (under, None);
        for _ in 0..100 {
            middle = (most * over - least * under) / (most - least);
            let found = more(middle);
            if found.abs() < 1e-12 * volume || over - under < 1e-14 * (high - low + level.abs()) {
                break;
            }
            // The value of an end that stays twice is halved, to speed up the interpolation (Illinois).
            let again = sank == Some(found > 0.0);
            if found > 0.0 {
                (under, most, least) = (middle, found, if again { 0.5 * least } else { least });
            } else {
                (over, least, most) = (middle, found, if again { 0.5 * most } else { most });
            }
            sank = Some(found > 0.0);
        }
        Some(middle)
    }

    fn sinking_error(&self, pose: &Pose<D>, mass: f64, whole: f64) -> Error {
        let (part, lifted, [mass, whole]) = (mass / whole, mass <= 0.0, [mass, whole].map(four_digits));
        if lifted {
            let what = format!("the body leaves the water: with its loads its mass is {mass}");
            return Error::scene(what).help("make it heavier, or what lifts it weaker");
        }
        if self.rim_height(pose).is_finite() {
            let what = format!(
                "the hull floods: its mass {mass} is {part:.3} of the {whole} of water that it displaces with the water at \
                 its rim"
            );
            return Error::scene(what).help("make it lighter, or its sides higher");
        }
        Error::scene(format!(
            "the body sinks: its mass {mass} is {part:.3} of the {whole} of water that it can displace"
        ))
        .help("a floating body needs a density between 0 and the water's; place a heavier one by its position")
    }
}

impl Hull<'_, 3> {
    /// Hydrostatic stiffness over ρ g about the point `reference` (m) of the body, without the weight, which contributes nothing
    /// about the centre of mass. The entry of row i and column j is the loss of buoyancy i (vertical force; moments about x and
    /// y) over a small motion j (heave; turns about x, y and z). Its unit is m² for a force over a displacement, m³ for a moment
    /// over a displacement, and m⁴ for a moment over a turn. Rows and columns: surge, sway, heave, roll, pitch, yaw.
    ///
    /// The derivatives are central differences over ±1e-4 of the size of the hull and ±1e-4 rad.
    pub(crate) fn stiffness(&self, pose: &Pose<3>, reference: &Vector<3>, level: f64) -> [[f64; 6]; 6] {
        let step = 1e-4;
        let length = self.shape.bounds().size().max();
        let buoyancy = |motion: usize, sign: f64| {
            let mut moved = *pose;
            if motion == 2 {
                moved.position[2] += sign * step * length;
            } else {
                let axis: [f64; 3] = std::array::from_fn(|i| if i + 3 == motion { sign * step } else { 0.0 });
                let turn = Bivector::from_axial(&axis).exp();
                moved.rotation = turn * pose.rotation;
                moved.position = reference + turn * (pose.position - reference);
            }
            let (volume, centroid) = self.submerged_volume(&moved, level);
            let arm = centroid - reference;
            [0.0, 0.0, volume, volume * arm[1], -volume * arm[0], 0.0]
        };
        let loads: [[f64; 6]; 6] = std::array::from_fn(|motion| {
            if motion < 2 {
                return [0.0; 6];
            }
            let (more, less) = (buoyancy(motion, 1.0), buoyancy(motion, -1.0));
            let span = 2.0 * step * if motion == 2 { length } else { 1.0 };
            std::array::from_fn(|load| (less[load] - more[load]) / span)
        });
        std::array::from_fn(|load| loads.map(|of_motion| of_motion[load]))
    }
}

/// Change of the pose's last coordinate (m) at which the body floats in this orientation: ρ₀ V_submerged = m.
///
/// `mass`: kg (kg/m in 2-D); `rho0`: density of the water, kg/m³; `level`: height of the still water, m.
/// The pose is only lifted or lowered, not turned. Hollows of the shape count as full of water.
///
/// # Errors
/// `Scene` if the body sinks: the message says how many times too dense it is.
///
/// Source: Archimedes; V is monotone in the height, so bisection finds the only solution.
pub fn equilibrium_height<const D: usize>(
    shape: &Shape<D>,
    pose: &Pose<D>,
    mass: f64,
    rho0: f64,
    level: f64,
) -> Result<f64> {
    Hull::new(shape).equilibrium_height(pose, mass, rho0, level)
}

/// Metacentric height GM (m) of a floating body as posed, for tilts about the horizontal `axis`.
///
///   GM = −dT/dφ / (m g),   T the torque about the centre of mass of the buoyancy of the re-floated body
///
/// The body rights itself if GM > 0. For a wall-sided body GM = I/V + KB − KG, with I the second moment of the waterplane.
/// `axis`: axial components, `[1.0]` in 2-D, `[1.0, 0.0, 0.0]` for x in 3-D. The other arguments as in [`equilibrium_height`];
/// the derivative is a central difference over ±1e-4 rad.
///
/// # Errors
/// As [`equilibrium_height`].
pub fn metacentric_height<const D: usize>(
    shape: &Shape<D>,
    pose: &Pose<D>,
    body: &FreeBody<D>,
    rho0: f64,
    level: f64,
    axis: &[f64],
) -> Result<f64> {
    let hull = Hull::new(shape);
    let tilt = 1e-4;
    let righting = |angle: f64| -> Result<f64> {
        let mut tilted = *pose;
        tilted.rotation = (Bivector::from_axial(axis) * angle).exp() * pose.rotation;
        tilted.position[D - 1] += hull.equilibrium_height(&tilted, body.mass, rho0, level)?;
        let buoyancy = hull.submerged_volume(&tilted, level).1;
        let mut up = Vector::zeros();
        up[D - 1] = 1.0;
        let lever = Bivector::torque(&(buoyancy - tilted.point(&body.centre)), &up);
        Ok(-lever.axial().iter().zip(axis).map(|(t, a)| t * a).sum::<f64>())
    };
    Ok((righting(tilt)? - righting(-tilt)?) / (2.0 * tilt))
}

/// Lowest and highest height (m) that the shape's box reaches in the world.
fn vertical_extent<const D: usize>(shape: &Shape<D>, pose: &Pose<D>) -> (f64, f64) {
    let local = shape.bounds();
    let corners: Vec<Vector<D>> = (0..1usize << D)
        .map(|corner| {
            pose.point(&Vector::from_fn(|i, _| if corner >> i & 1 == 1 { local.max[i] } else { local.min[i] }))
        })
        .collect();
    let world = Bounds::around(&corners);
    (world.min[D - 1], world.max[D - 1])
}

#[cfg(test)]
#[path = "../../tests/unit/solid/hydrostatics.rs"]
mod tests;
