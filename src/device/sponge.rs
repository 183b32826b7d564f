//! The sponge layers, as a device damps the water in them.

use super::{layout::Layout, refused};
use crate::{error::Result, sph::Units, system::System};

/// Statements that add the rates of the sponge layers at `place` to `rate`.
pub(super) fn sponge_statements<const D: usize>(system: &System<D>, layout: &Layout, units: &Units) -> Result<String> {
    // Water beyond a symmetry plane is in the layers at its image on the computed side.
    let place = if system.symmetry_planes().any() { "away(place, way_in(place))" } else { "place" };
    let mut text = String::new();
    for layer in system.sponge_layers() {
        if !layout.reaches(&layer.from) {
            return Err(refused("a sponge layer a million kernel supports from the origin"));
        }
        let from = layout.place(&layer.from, 0, 0);
        let words =
            |part: &[u32], cast: fn(u32) -> String| part.iter().map(|x| cast(*x)).collect::<Vec<_>>().join(", ");
        let (hi, lo) = (words(&from[..4], |x| format!("{}", x as i32)), words(&from[4..], |x| format!("{x}u")));
        let way = layer.to - layer.from;
        let way = way * (units.length / way.norm_squared());
        let way: Vec<String> = (0..3).map(|k| format!("{:?}f", if k < D { way[k] as f32 } else { 0.0 })).collect();
        let (strength, power) = ((layer.strength * units.time) as f32, layer.power as f32);
        text += &format!(
            "    rate += {strength:?}f * pow(clamp(dot(between({place}, Place(vec4<i32>({hi}), vec4<u32>({lo}))), \
             vec3<f32>({})), 0.0f, 1.0f), {power:?}f);\n",
            way.join(", ")
        );
    }
    Ok(text)
}
