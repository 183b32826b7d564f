//! Colour maps that remain distinct for colour-blind readers, with lightness that varies uniformly or diverges from a
//! pale middle.

use serde::Serialize;

/// A colour map: evenly spaced colours, each as 0xRRGGBB.
pub(crate) type ColourMap = &'static [u32];

/// Dark violet to yellow (van der Walt & Smith 2015, CC0), at every eighth of the 256 steps.
pub(crate) const VIRIDIS: ColourMap = &[
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453781, 0x424086, 0x3e4989, 0x3b528b, 0x375b8d, 0x33638d,
    0x2f6b8e, 0x2c728e, 0x297a8e, 0x26828e, 0x23898e, 0x21918c, 0x1f988b, 0x1fa088, 0x22a785, 0x28ae80, 0x32b67a,
    0x3fbc73, 0x4ec36b, 0x5ec962, 0x70cf57, 0x84d44b, 0x98d83e, 0xaddc30, 0xc2df23, 0xd8e219, 0xece51b, 0xfde725,
];

/// Dark blue to yellow, for readers with red or green colour blindness (Nuñez, Anderton & Renslow 2018, CC0).
pub(crate) const CIVIDIS: ColourMap = &[
    0x00224e, 0x00285b, 0x002e6a, 0x053371, 0x1a386f, 0x273e6e, 0x32436d, 0x3b496c, 0x434e6c, 0x4b546c, 0x535a6d,
    0x5a5f6e, 0x61656f, 0x686a71, 0x6f7073, 0x767676, 0x7d7c78, 0x848279, 0x8c8878, 0x938e78, 0x9b9476, 0xa39a74,
    0xaba072, 0xb4a76f, 0xbcae6c, 0xc4b468, 0xcdbb63, 0xd5c25e, 0xdec958, 0xe7d150, 0xf0d846, 0xf9e03a, 0xfee838,
];

/// Blue through grey to red, for signed quantities (Moreland 2009).
pub(crate) const DIVERGING: ColourMap = &[
    0x3b4cc0, 0x445acc, 0x4e68d8, 0x5875e1, 0x6282ea, 0x6c8ff1, 0x779af7, 0x82a6fb, 0x8db0fe, 0x98b9ff, 0xa3c2fe,
    0xaec9fc, 0xb9d0f9, 0xc3d5f4, 0xccd9ed, 0xd5dbe5, 0xdddcdc, 0xe5d8d1, 0xecd3c5, 0xf1ccb8, 0xf5c4ac, 0xf7ba9f,
    0xf7b093, 0xf6a586, 0xf4987a, 0xf08b6e, 0xeb7d62, 0xe46e56, 0xdd5f4b, 0xd44e41, 0xca3b37, 0xbe242e, 0xb40426,
];

/// The colour maps in the data of the page.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct FieldColourMaps {
    /// The colour map of pressures.
    pub pressure: ColourMap,
    /// The colour map of excess pressures, which are signed.
    pub excess: ColourMap,
    /// The colour map of speeds.
    pub speed: ColourMap,
}

/// The colour map of each field.
pub(crate) const FIELD_COLOUR_MAPS: FieldColourMaps =
    FieldColourMaps { pressure: VIRIDIS, excess: DIVERGING, speed: CIVIDIS };

/// Returns the red, green and blue of `map` at the fraction `s` (0 … 1); values beyond this range have the end colours.
pub(crate) fn colour_at(map: ColourMap, s: f64) -> [u8; 3] {
    let place = s.clamp(0.0, 1.0) * (map.len() - 1) as f64;
    let i = (place as usize).min(map.len() - 2);
    let part = |k: usize, byte: u32| f64::from(map[k] >> (8 * byte) & 255);
    let mix = |byte: u32| part(i, byte) + (place - i as f64) * (part(i + 1, byte) - part(i, byte));
    [2, 1, 0].map(|byte| mix(byte).round() as u8)
}

#[cfg(test)]
#[path = "../../tests/unit/report/colour.rs"]
mod tests;
