//! How numbers and columns are said: units by the ends of names, sizes, times. For pages, tables and terminals alike.

/// Ends of the names of columns, and the units that they mean.
const UNITS: [(&str, &str); 20] = [
    ("_Nm_per_m", "N m/m"),
    ("_N_per_m", "N/m"),
    ("_J_per_m", "J/m"),
    ("_W_per_m", "W/m"),
    ("_m3ps", "m³/s"),
    ("_m2ps", "m²/s"),
    ("_radps", "rad/s"),
    ("_mps", "m/s"),
    ("_deg", "°"),
    ("_rad", "rad"),
    ("_kg", "kg"),
    ("_Pa", "Pa"),
    ("_Nm", "N m"),
    ("_N", "N"),
    ("_J", "J"),
    ("_W", "W"),
    ("_m3", "m³"),
    ("_m2", "m²"),
    ("_m", "m"),
    ("_s", "s"),
];

/// The unit of a column by the end of its name, as in `fx_N_per_m`; what follows a comma or a space is no part of it.
pub fn unit(column: &str) -> &'static str {
    let column = column.split([',', ' ']).next().unwrap_or(column);
    UNITS.iter().find(|(end, _)| column.ends_with(end)).map_or("–", |(_, unit)| unit)
}

/// The name of a column without its unit, in words: `water_kinetic_J` is "water kinetic", `vx_at_1_0.2_mps` of a row of
/// gauges "vx at 1, 0.2 m".
pub fn column_label(column: &str) -> String {
    let end = UNITS.iter().find(|(end, _)| column.ends_with(end)).map_or("", |(end, _)| end);
    let name = &column[..column.len() - end.len()];
    match name.split_once("_at_") {
        Some((what, place)) => format!("{} at {} m", what.replace('_', " "), place.replace('_', ", ")),
        None => name.replace('_', " "),
    }
}

/// A number of bytes as a user says it.
pub fn bytes(count: f64) -> String {
    match count {
        n if n >= 1e9 => format!("{:.1} GB", n / 1e9),
        n if n >= 1e6 => format!("{:.1} MB", n / 1e6),
        n if n >= 1e3 => format!("{:.0} kB", n / 1e3),
        n => format!("{n:.0} B"),
    }
}

/// A wall time (s) as a user says it.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0..=59 => format!("{seconds:.1} s"),
        60..=3599 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

#[cfg(test)]
#[path = "../../tests/unit/math/format.rs"]
mod tests;
