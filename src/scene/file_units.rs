//! The size of solids from files compared with the water and dp: an implausible size indicates another unit.

use super::{
    context::Context,
    section::{
        shape::{AxisName, ShapeConfig},
        solid::SolidConfig,
        water::WaterBody,
    },
    untagged::LengthUnit,
};
use crate::{
    error::Result,
    geometry::world_bounds,
    math::Bounds,
    solid::{Role, SolidSpec},
};

/// Largest plausible size of a fixed solid over the size of the water, –: a bed can be larger than the water.
const LARGEST_FIXED: f64 = 20.0;

/// The same of a moving solid.
const LARGEST_MOVING: f64 = 3.0;

/// Penalty of a size that does not fit into the water, above the logarithm of any ratio of sizes.
const FAR: f64 = 1e3;

/// The units that files have other than metres, with their names, the most frequent first.
const UNITS: [(LengthUnit, &str); 4] =
    [(LengthUnit::Mm, "mm"), (LengthUnit::Cm, "cm"), (LengthUnit::In, "in"), (LengthUnit::Ft, "ft")];

/// The unit of a file, as a scene gives it.
struct FileUnit<'a> {
    file: &'a str,
    unit: Option<LengthUnit>,
    /// The axis along which the scene gives the size of the shape.
    length_axis: Option<AxisName>,
}

/// Returns the unit of the first file that gives a shape, or `None` if none does.
fn file_unit(shape: &ShapeConfig) -> Option<FileUnit<'_>> {
    match shape {
        ShapeConfig::Mesh(config) => Some(FileUnit { file: &config.file, unit: config.unit, length_axis: None }),
        ShapeConfig::Polygon(config) if config.is_drawing() => {
            Some(FileUnit { file: config.file.as_deref()?, unit: config.unit, length_axis: None })
        }
        ShapeConfig::Prism(config) if config.outline().is_drawing() => Some(FileUnit {
            file: config.file.as_deref()?,
            unit: config.unit,
            length_axis: Some(config.axis.unwrap_or(AxisName::Z)),
        }),
        // The axes of a part are not those of the compound.
        ShapeConfig::Compound(parts) => {
            parts.iter().find_map(|part| file_unit(&part.shape)).map(|unit| FileUnit { length_axis: None, ..unit })
        }
        _ => None,
    }
}

/// Returns whether a file describes the shape, or a part of it.
pub(super) fn is_from_file(shape: &ShapeConfig) -> bool {
    file_unit(shape).is_some()
}

/// Refuses a solid from a file that is far larger than the water although the scene does not give the unit, or smaller
/// than dp. `configs` describe the `solids`.
pub(super) fn require_plausible_units<const D: usize>(
    ctx: &Context,
    configs: &[SolidConfig],
    water: &[WaterBody<D>],
    solids: &[SolidSpec<D>],
) -> Result<()> {
    let boxes = water.iter().map(|body| world_bounds(&body.region.shape, &body.region.pose));
    let room = boxes.fold(Bounds::empty(), |a, b| a.union(&b)).size().max();
    for (i, (config, solid)) in configs.iter().zip(solids).enumerate() {
        let Some(FileUnit { file, unit, length_axis }) = file_unit(&config.shape) else { continue };
        let size = solid.shape.bounds().size();
        let of_file = (0..D).filter(|&axis| length_axis.is_none_or(|length| length as usize != axis));
        let size = of_file.map(|axis| size[axis]).fold(0.0, f64::max);
        let key = format!("solid.{i}.shape");
        let largest = if matches!(solid.role, Role::Fixed) { LARGEST_FIXED } else { LARGEST_MOVING };
        if unit.is_none() && size > largest * room {
            // The unit whose size is nearest to that of the water, if possible among those that fit into the water.
            let sizes = UNITS.map(|(unit, name)| (name, size * unit.metres()));
            let off = |(_, size): &(&str, f64)| (size / room).ln().abs() + if *size < room { 0.0 } else { FAR };
            let nearest = sizes.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)));
            let (name, probable) = nearest.unwrap_or(sizes[0]);
            let what = format!(
                "{file} makes solid \"{}\" {size:.4} m large, in water {room:.4} m large: its unit is probably {name}, and \
                 its size {probable:.4} m",
                solid.name
            );
            let others = sizes.map(|(name, size)| format!("{name} {size:.4} m")).join(", ");
            let help = format!(
                "write  unit = \"{name}\"  beside the file's name, or  unit = \"m\"  if the size is right. By unit: {others}"
            );
            return Err(ctx.error_with_help(&key, what, help));
        }
        if size < ctx.dp {
            let metres = unit.unwrap_or_default().metres();
            let what = format!(
                "{file} makes solid \"{}\" {size:.3e} m large, less than dp = {} m: no particle resolves it",
                solid.name, ctx.dp
            );
            let help = match metres < 1.0 {
                true => format!("its unit is perhaps m, and its size {:.4} m: leave unit out", size / metres),
                false => "check unit and scale beside the file's name".into(),
            };
            return Err(ctx.error_with_help(&key, what, help));
        }
    }
    Ok(())
}
