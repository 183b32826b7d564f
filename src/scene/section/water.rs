//! `[[water]]`: bodies of water, their still level and their motion at the start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::shape::{PlacementConfig, ShapeConfig, vector};
use crate::{
    error::{Error, ErrorCode, Result},
    geometry::{Shape, WaterRegion, world_bounds},
    math::{Bounds, BoxConfig, Pose, Vector, expression::ScalarField, format::three_digits},
    scene::{context::Context, untagged::FieldFormulaConfig},
};

/// Largest distance of water from the origin, in supports of the kernel: beyond, differences of coordinates are not exact.
const FARTHEST: f64 = 1e8;

/// Round-off of the sides and levels of bodies of water that join, over their size, –.
const CLOSE: f64 = 1e-9;

/// A body of water.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct WaterConfig {
    /// Its region, minus the solids.
    pub fill: FillConfig,
    /// Height of its surface, m, if that lies below the top of `fill`.
    pub level: Option<f64>,
    /// Name of a solid: this water fills the space that the solid encloses, and nothing else.
    pub inside: Option<String>,
    /// Velocity at the start, m/s: for each axis a formula in the position or a number.
    pub velocity: Option<Vec<FieldFormulaConfig>>,
    /// Pressure at the start beyond the hydrostatic one, Pa: a formula in the position or a number.
    pub pressure: Option<FieldFormulaConfig>,
}

/// The region of a body of water: a box by its corners, or a shape at a place.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct FillConfig {
    /// A box by its corners.
    #[serde(rename = "box")]
    pub corners: Option<BoxConfig>,
    /// Any shape.
    pub shape: Option<ShapeConfig>,
    /// Place of that shape.
    pub at: Option<PlacementConfig>,
}

impl FillConfig {
    /// Refuses a region that is neither a box nor a shape.
    fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        match (&self.corners, &self.shape) {
            (Some(corners), None) if self.at.is_none() => corners.verify(ctx, &format!("{key}.box")),
            (Some(_), None) => Err(ctx.error_at(&format!("{key}.at"), "a box by its corners needs no place")),
            (None, Some(shape)) => {
                shape.verify(ctx, &format!("{key}.shape"))?;
                self.at.as_ref().map_or(Ok(()), |at| at.verify(ctx, &format!("{key}.at"), false))
            }
            _ => Err(ctx.error_at(key, "fill takes either a box or a shape")),
        }
    }
}

impl WaterConfig {
    /// Refuses a body of water without a region or with an initial motion that cannot be read.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        match ctx.dimension {
            2 => self.flow::<2>(ctx, key).map(|_| ())?,
            _ => self.flow::<3>(ctx, key).map(|_| ())?,
        }
        self.fill.verify(ctx, &format!("{key}.fill"))
    }

    /// Its region, its level and its initial motion.
    pub(crate) fn build<const D: usize>(&self, ctx: &Context, key: &str) -> Result<WaterBody<D>> {
        let place = |e: Error| ctx.with_location(e, &format!("{key}.fill.shape"));
        let (shape, pose) = match &self.fill {
            FillConfig { corners: Some(corners), .. } => {
                let (min, mut max): (Vector<D>, Vector<D>) = (vector(&corners.min), vector(&corners.max));
                max[D - 1] = self.level.unwrap_or(f64::INFINITY).min(max[D - 1]).max(min[D - 1]);
                (Shape::Box { size: max - min }, Pose::at(0.5 * (min + max)))
            }
            FillConfig { shape, at, .. } => {
                let Some(shape) = shape else { return Err(ctx.error_at(key, "what does the water fill?")) };
                let shape = shape.build(ctx).map_err(place)?;
                let pose = at.as_ref().map_or_else(Pose::identity, |at| at.build(&shape, 0.0));
                (shape, pose)
            }
        };
        let bounds = world_bounds(&shape, &pose);
        require_near_origin(ctx, &format!("{key}.fill"), &bounds)?;
        let (bottom, top) = (bounds.min[D - 1], bounds.max[D - 1]);
        let level = self.level.unwrap_or(f64::INFINITY).min(top);
        let top = self.fill.corners.as_ref().and_then(|corners| corners.max.last().copied()).unwrap_or(top);
        if let Some(given) = self.level.filter(|level| *level > top + 1e-9 * (top - bottom).abs()) {
            let what = format!("a level of {given} m lies above {top} m, the top of the region that this water fills");
            let help = "level lowers the surface of a region; make the region higher, or remove the level";
            return Err(ctx.error_with_help(&format!("{key}.level"), what, help));
        }
        if level <= bottom {
            let what = format!("the level is not above {bottom} m, the bottom of this water");
            return Err(ctx.error_at(&format!("{key}.level"), what));
        }
        Ok(WaterBody { region: WaterRegion { shape, pose }, bottom, level, flow: self.flow(ctx, key)?, inside: None })
    }

    /// Its motion at the start.
    fn flow<const D: usize>(&self, ctx: &Context, key: &str) -> Result<InitialFlow<D>> {
        let field =
            |key: &str, field: &FieldFormulaConfig| ScalarField::parse(&field.0).map_err(|e| ctx.with_location(e, key));
        let velocity = match &self.velocity {
            Some(components) => {
                let key = format!("{key}.velocity");
                if components.len() != D {
                    return Err(ctx.error_at(&key, format!("velocity has {} entries, not {D}", components.len())));
                }
                Some(components.iter().map(|component| field(&key, component)).collect::<Result<_>>()?)
            }
            None => None,
        };
        let pressure = self.pressure.as_ref().map(|config| field(&format!("{key}.pressure"), config)).transpose()?;
        Ok(InitialFlow { velocity, pressure })
    }
}

/// The motion of a body of water at the start.
pub(crate) struct InitialFlow<const D: usize> {
    velocity: Option<Vec<ScalarField<D>>>,
    pressure: Option<ScalarField<D>>,
}

impl<const D: usize> InitialFlow<D> {
    /// No motion, and the hydrostatic pressure.
    pub(crate) fn at_rest() -> Self {
        Self { velocity: None, pressure: None }
    }

    /// Refuses a velocity (m/s) that is not finite or not below the speed of sound `c0` (m/s), and a pressure (Pa) that is not
    /// finite, at the particle at `r` (m); `key`: of its water.
    pub(crate) fn require_possible(&self, ctx: &Context, key: &str, r: &Vector<D>, c0: f64) -> Result<()> {
        let (velocity, pressure) = self.at(r);
        let place = || r.iter().map(|x| three_digits(*x)).collect::<Vec<_>>().join(", ");
        let speed = velocity.norm();
        if !speed.is_finite() || speed >= c0 {
            let [shown, sound] = [speed, c0].map(three_digits);
            let what = match speed.is_finite() {
                true => format!("the water moves at {shown} m/s at [{}], and sound at {sound} m/s", place()),
                false => format!("the velocity has no finite value at [{}]", place()),
            };
            let help =
                "write a velocity that is finite in all of this water, and far below the speed of sound (model.c0)";
            return Err(ctx.error_with_help(&format!("{key}.velocity"), what, help).with_code(ErrorCode::OutOfRange));
        }
        if !pressure.is_finite() {
            let what = format!("the pressure is {pressure} Pa at [{}]", place());
            let help = "write a pressure that is finite in all of this water";
            return Err(ctx.error_with_help(&format!("{key}.pressure"), what, help).with_code(ErrorCode::OutOfRange));
        }
        Ok(())
    }

    /// Velocity (m/s) and pressure beyond the hydrostatic one (Pa) at `r` (m).
    pub(crate) fn at(&self, r: &Vector<D>) -> (Vector<D>, f64) {
        let velocity = self.velocity.as_ref();
        let velocity = velocity.map_or_else(Vector::zeros, |v| Vector::from_fn(|i, _| v[i].value_at(r)));
        (velocity, self.pressure.as_ref().map_or(0.0, |field| field.value_at(r)))
    }
}

/// A body of water.
pub(crate) struct WaterBody<const D: usize> {
    pub(crate) region: WaterRegion<D>,
    pub(crate) bottom: f64,
    /// Height of the still surface, m.
    pub(crate) level: f64,
    pub(crate) flow: InitialFlow<D>,
    /// Number of the solid whose enclosed space it fills, if it fills nothing else.
    pub(crate) inside: Option<usize>,
}

impl<const D: usize> WaterBody<D> {
    /// Signed distance (m) of the point `x` (m) from this water, negative inside.
    pub(crate) fn distance(&self, x: &Vector<D>) -> f64 {
        self.region.shape.signed_distance(&self.region.pose.local(x))
    }

    /// Whether `x` (m) lies in this water, up to round-off.
    pub(crate) fn contains(&self, x: &Vector<D>) -> bool {
        self.distance(x) < 1e-9
    }

    /// The smallest box around it up to its level, m.
    pub(crate) fn bounds_below_level(&self) -> Bounds<D> {
        let mut own = self.bounds();
        own.max[D - 1] = self.level;
        own
    }

    /// The smallest box around its region, m.
    pub(crate) fn bounds(&self) -> Bounds<D> {
        world_bounds(&self.region.shape, &self.region.pose)
    }
}

/// The water at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StillWaterLevel {
    /// The highest level, m.
    pub level: f64,
    /// From the lowest point of the water to there, m.
    pub depth: f64,
}

impl StillWaterLevel {
    /// Height (m) of the lowest point of the water.
    pub(crate) fn bottom(&self) -> f64 {
        self.level - self.depth
    }

    /// The still water of all bodies of water outside solids, or of all bodies if there are none outside.
    pub(crate) fn of<const D: usize>(water: &[WaterBody<D>]) -> Self {
        let level = outside_solids(water).map(|body| body.level).fold(f64::NEG_INFINITY, f64::max);
        let bottom = outside_solids(water).map(|body| body.bottom).fold(f64::INFINITY, f64::min);
        Self { level, depth: level - bottom }
    }
}

/// The bodies of water that no solid encloses, or all bodies of water if solids enclose all of them.
fn outside_solids<const D: usize>(water: &[WaterBody<D>]) -> impl Iterator<Item = &WaterBody<D>> {
    let all = water.iter().all(|body| body.inside.is_some());
    water.iter().filter(move |body| all || body.inside.is_none())
}

/// Returns the boxes around the bodies of water that no solid encloses, up to their levels.
pub(crate) fn open_boxes<const D: usize>(water: &[WaterBody<D>]) -> Vec<Bounds<D>> {
    water.iter().filter(|body| body.inside.is_none()).map(WaterBody::bounds_below_level).collect()
}

/// Returns the highest level (m) of the water in `boxes` that reaches over or under a solid in the box `own`; `None` if none does.
pub(crate) fn level_at<const D: usize>(boxes: &[Bounds<D>], own: &Bounds<D>) -> Option<f64> {
    let overlaps =
        |water: &&Bounds<D>| (0..D - 1).all(|axis| water.min[axis] < own.max[axis] && water.max[axis] > own.min[axis]);
    boxes.iter().filter(overlaps).map(|water| water.max[D - 1]).reduce(f64::max)
}

/// Returns the still water of the basin nearest to a solid in the box `own`: of the nearest of `boxes`, or the highest of several as
/// near, and of those of its level that join it. `None` without boxes.
pub(crate) fn basin<const D: usize>(boxes: &[Bounds<D>], own: &Bounds<D>) -> Option<StillWaterLevel> {
    let gap = |water: &Bounds<D>, axis: usize| {
        (water.min[axis] - own.max[axis]).max(own.min[axis] - water.max[axis]).max(0.0)
    };
    let away = |water: &Bounds<D>| (0..D - 1).map(|axis| gap(water, axis).powi(2)).sum::<f64>();
    let level = |water: &Bounds<D>| water.max[D - 1];
    let order = |a: &&Bounds<D>, b: &&Bounds<D>| away(a).total_cmp(&away(b)).then(level(b).total_cmp(&level(a)));
    let nearest = boxes.iter().min_by(order)?;
    let close = CLOSE * boxes.iter().map(|water| water.size().max()).fold(0.0, f64::max);
    let meet = |a: &Bounds<D>, b: &Bounds<D>| {
        (level(a) - level(b)).abs() <= close
            && (0..D).all(|axis| a.min[axis] <= b.max[axis] + close && b.min[axis] <= a.max[axis] + close)
    };
    let (mut joined, mut apart): (Vec<&Bounds<D>>, Vec<_>) = (vec![nearest], boxes.iter().collect());
    let mut next = 0;
    while let Some(&last) = joined.get(next) {
        let (more, rest) = apart.into_iter().partition(|water| meet(last, water));
        (joined, apart) = ([joined, more].concat(), rest);
        next += 1;
    }
    let level = level(nearest);
    let bottom = joined.iter().map(|water| water.min[D - 1]).fold(f64::INFINITY, f64::min);
    Some(StillWaterLevel { level, depth: level - bottom })
}

/// The water at rest and the boxes around it.
pub(crate) struct StillWater<const D: usize> {
    pub(crate) still: StillWaterLevel,
    pub(crate) bounds: Bounds<D>,
    boxes: Vec<Bounds<D>>,
}

impl<const D: usize> StillWater<D> {
    /// The still water of the same bodies of water as in [`StillWaterLevel::of`], at least one.
    pub(crate) fn of(water: &[WaterBody<D>]) -> Self {
        let mut bounds: Bounds<D> =
            Bounds { min: Vector::repeat(f64::INFINITY), max: Vector::repeat(f64::NEG_INFINITY) };
        for body in outside_solids(water) {
            let own = body.bounds();
            bounds = Bounds { min: bounds.min.inf(&own.min), max: bounds.max.sup(&own.max) };
        }
        Self { still: StillWaterLevel::of(water), bounds, boxes: open_boxes(water) }
    }

    /// The still water of the basin nearest to a solid in the box `own`.
    pub(crate) fn basin(&self, own: &Bounds<D>) -> StillWaterLevel {
        basin(&self.boxes, own).unwrap_or(self.still)
    }

    /// The level (m) of the open water at the place of a solid in the box `own`; `None` if none is there.
    pub(crate) fn level_at(&self, own: &Bounds<D>) -> Option<f64> {
        // Without open water the highest level is that of all.
        if self.boxes.is_empty() { Some(self.still.level) } else { level_at(&self.boxes, own) }
    }
}

/// Refuses water within `bounds` (m), of the shape at `key`, so far from the origin that its coordinates are not exact enough.
fn require_near_origin<const D: usize>(ctx: &Context, key: &str, bounds: &Bounds<D>) -> Result<()> {
    let most = FARTHEST * 2.0 * ctx.h;
    let far = bounds.min.iter().chain(bounds.max.iter()).map(|x| x.abs()).fold(0.0, f64::max);
    if far <= most {
        return Ok(());
    }
    let what = format!("this water is {far:.1e} m from the origin; places are exact up to {most:.1e} m");
    Err(ctx.error_with_help(key, what, "move the scene to the origin, or make dp larger"))
}

#[cfg(all(test, feature = "dim2"))]
#[path = "../../../tests/unit/scene/water.rs"]
mod tests;
