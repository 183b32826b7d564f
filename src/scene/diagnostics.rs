//! Translates errors of the parser for users: the fault, the nearest valid name, an example.

use crate::{
    error::{Error, ErrorCode, nearest_name, suggestion},
    probe,
};

/// Examples by key. A message shows the entry with the longest match at the end of the key.
const EXAMPLES: &[(&str, &str)] = &[
    ("title", "title = \"Box in a wave train\""),
    ("dimension", "dimension = 2"),
    ("dp", "dp = 0.01          # particle spacing, m"),
    ("until", "until = 10.0       # s"),
    ("gravity", "gravity = [0.0, -9.81]        # or  gravity = 9.81, downwards"),
    ("jitter", "jitter = 1e-7      # of dp"),
    ("domain", "domain = { min = [0.0, 0.0], max = [2.0, 1.0] }"),
    ("periodic", "periodic = { x = [0.0, 1.0] }        # m"),
    ("symmetry", "symmetry = { x = 0.5 }        # m"),
    ("symmetry.x", "symmetry = { x = 0.5 }        # m"),
    ("symmetry.y", "symmetry = { y = 0.5 }        # m"),
    ("symmetry.z", "symmetry = { z = 0.5 }        # m"),
    ("periodic.x", "periodic = { x = [0.0, 1.0] }        # m"),
    ("periodic.y", "periodic = { y = [0.0, 1.0] }        # m"),
    ("periodic.z", "periodic = { z = [0.0, 1.0] }        # m"),
    ("guard", "[guard]\nescape = \"remove\""),
    ("guard.speed", "speed = 0.5          # of c0"),
    ("guard.density", "density = [0.5, 1.5] # of rho0"),
    ("escape", "escape = \"remove\"    # or \"stop\""),
    ("water.velocity", "velocity = [\"0.1*sin(2*pi*x)\", 0.0]        # m/s, one entry an axis"),
    ("water.pressure", "pressure = \"20*cos(2*pi*x)\"        # Pa, beyond that of water at rest"),
    ("water", "[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }"),
    ("fill", "fill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }"),
    ("level", "level = 0.4        # height of the surface, m"),
    (
        "inflow",
        "[[inflow]]\nx        = 0.0        # m, where the water begins\nvelocity = 0.5        # m/s, into the water",
    ),
    ("inflow.velocity", "velocity = 0.5        # m/s, into the water; or a formula, \"0.6*y*(2-y)\""),
    ("outflow", "[[outflow]]\nx        = 6.0        # m, where the water ends\nvelocity = 0.5        # m/s, out of it"),
    ("outflow.velocity", "velocity = 0.5        # m/s, out of the water; or a formula, \"0.6*y*(2-y)\""),
    ("inflow.x", "x = 0.0        # m, where the water begins"),
    ("outflow.x", "x = 6.0        # m, where the water ends"),
    ("factor", "factor = \"min(t/2, 1)\""),
    ("absorb", "absorb = true"),
    ("current", "current = { along = \"x\", discharge = 0.25 }        # m²/s; m³/s in 3-D"),
    ("discharge", "discharge = 0.25        # m²/s; m³/s in 3-D"),
    ("current.along", "along = \"x\""),
    ("towed", "towed = { along = \"x\", velocity = \"0.5*min(t, 2)\" }        # m/s"),
    ("towed.along", "along = \"x\""),
    ("towed.velocity", "velocity = \"0.5*min(t, 2)\"        # m/s"),
    ("damping", "[[damping]]\nfrom = [6.0, 0.0]\nto   = [8.0, 0.0]"),
    ("damping.from", "from = [6.0, 0.0]        # m, where the zone begins"),
    ("damping.to", "to = [8.0, 0.0]          # m, where it is full"),
    ("strength", "strength = 5.0        # 1/s"),
    ("damping.power", "power = 2.0           # even: 1, gentler at first: more"),
    ("solid", "[[solid]]\nname  = \"box\"\nshape = { box = { size = [0.1, 0.05] } }\nfree  = { density = 500.0 }"),
    ("name", "name = \"box\""),
    ("shape", "shape = { box = { size = [0.1, 0.05] } }"),
    ("shape.box", "shape = { box = { size = [0.1, 0.05] } }"),
    ("shape.ball", "shape = { ball = { radius = 0.1 } }"),
    ("shape.capsule", "shape = { capsule = { length = 0.2, radius = 0.05, axis = \"x\" } }"),
    ("shape.cylinder", "shape = { cylinder = { length = 0.2, radius = 0.05, axis = \"z\" } }"),
    ("shape.ellipsoid", "shape = { ellipsoid = { radii = [0.3, 0.1, 0.1] } }"),
    ("shape.cone", "shape = { cone = { radius = 0.1, length = 0.2 } }"),
    ("shape.frustum", "shape = { frustum = { radius_bottom = 0.2, radius_top = 0.1, length = 0.2 } }"),
    ("shape.wedge", "shape = { wedge = { size = [1.0, 0.5, 0.2] } }"),
    ("shape.prism", "shape = { prism = { points = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]], length = 0.5 } }"),
    ("shape.torus", "shape = { torus = { radius = 0.2, tube_radius = 0.05 } }"),
    ("shape.polygon", "shape = { polygon = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]] }"),
    ("shape.polyline", "shape = { polyline = [[0.0, 0.0], [4.0, 0.0], [10.0, 0.6]] }"),
    ("shape.tank", "shape = { tank = { size = [1.0, 0.5] } }"),
    ("shape.compound", "shape = { compound = [{ shape = { ball = { radius = 0.1 } }, at = { x = 0.1 } }] }"),
    ("at", "at = { x = 2.0, draft = \"equilibrium\" }"),
    ("draft", "at = { x = 2.0, draft = \"equilibrium\" }"),
    ("fixed", "fixed = true"),
    ("driven", "driven = { along = [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } }"),
    (
        "motions",
        "motions = [\n  { along = [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } },\n  { hinge = [0.5, 0.0], angle_deg = { formula = \"2*sin(2*pi*t)\" } },\n]",
    ),
    ("driven.wave", "wave = { regular = { height = 0.1, period = 1.2 } }"),
    ("wave.regular", "wave = { regular = { height = 0.1, period = 1.2 } }"),
    ("wave.jonswap", "wave = { jonswap = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    ("wave.bretschneider", "wave = { bretschneider = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    ("wave.pierson_moskowitz", "wave = { pierson_moskowitz = { height = 0.1, seed = 1 } }"),
    ("wave.focused", "wave = { focused = { crest = 0.08, peak_period = 1.4, distance = 4.0, time = 10.0 } }"),
    ("wave.solitary", "wave = { solitary = { height = 0.1 } }"),
    ("wave.components", "wave = { components = { file = \"components.csv\" } }"),
    ("wave.elevation", "wave = { elevation = { file = \"gauge.csv\", column = \"eta_m\", distance = 2.0 } }"),
    ("jonswap.peak_period", "wave = { jonswap = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    ("bretschneider.peak_period", "wave = { bretschneider = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    ("wave.absorb", "absorb = true, or  absorb = { period = 1.2, stroke = 0.4, speed = 1.0 }        # s, m, m/s"),
    ("wave.ramp", "ramp = 2.4        # s"),
    ("wave.depth", "depth = 0.4       # of the still water at the paddle, m"),
    ("along", "driven = { along = [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } }"),
    ("distance", "distance = { formula = \"0.05*sin(2*pi*t)\" }"),
    ("hinge", "driven = { hinge = [0.0, 0.0], angle = { file = \"flap.csv\", column = \"angle_deg\" } }"),
    ("angle", "angle = { file = \"flap.csv\", column = \"angle_deg\" }"),
    ("angle_deg", "angle_deg = { formula = \"5*sin(2*pi*t)\" }"),
    ("formula", "formula = \"0.05*sin(2*pi*t)\""),
    ("free", "free = { density = 500.0 }"),
    ("joint.free", "free = [\"y\", \"turn\"]"),
    ("density", "free = { density = 500.0 }        # kg/m³"),
    ("inertia", "free = { density = 500.0, inertia = 0.005 }        # kg m²/m; three numbers in 3-D"),
    ("release", "free = { density = 500.0, release = 1.0 }        # s"),
    ("ballast", "free = { density = 500.0, ballast = [{ at = [0.1, 0.0], mass = \"0.5*t\" }] }"),
    ("locked", "free = { density = 500.0, locked = [\"x\", \"turn\"] }"),
    ("contact_skin", "contact_skin = 0.005        # m"),
    (
        "joint",
        "[[joint]]\nname    = \"hinge\"\nkind    = \"hinge\"\nbetween = [\"fore\", \"aft\"]\nat      = [2.0, 0.5]",
    ),
    ("kind", "kind = \"hinge\"      # or \"slider\", \"fixed\", \"ball\", \"tow\", \"generic\""),
    ("between", "between = [\"fore\", \"aft\"]        # two solids; or one, and the world"),
    ("regular.height", "regular = { height = 0.1, period = 1.2 }        # m, s"),
    ("regular.period", "regular = { height = 0.1, period = 1.2 }        # m, s"),
    ("axis", "axis = [0.0, 1.0, 0.0]"),
    ("joint.along", "along = [0.0, 1.0]"),
    ("joint.at", "at = [2.0, 0.5]        # m, in the world, at the start"),
    ("limits", "limits = [-0.1, 0.1]        # m or rad, from the start"),
    ("limits_deg", "limits_deg = [-30.0, 30.0]"),
    ("motor", "motor = { damping = 20.0 }        # a power take-off"),
    ("motor.damping", "motor = { damping = 20.0 }"),
    ("motor.stiffness", "motor = { position = 0.0, stiffness = 500.0, damping = 20.0 }"),
    ("motor.velocity", "motor = { velocity = 0.5, damping = 20.0 }"),
    ("motor.force", "motor = { force = \"5*sin(2*pi*t)\" }"),
    ("motor.torque", "motor = { torque = \"5*sin(2*pi*t)\" }"),
    (
        "spring",
        "[[spring]]\nname      = \"line\"\nbetween   = [\"buoy\"]\nfrom      = [1.0, 0.4]\nto        = [1.0, 0.0]\n\
         stiffness = 500.0",
    ),
    ("rope", "[[rope]]\nname    = \"rope\"\nbetween = [\"buoy\"]\nfrom    = [1.0, 0.4]\nto      = [1.0, 0.0]"),
    (
        "line_type",
        "[[line_type]]\nname            = \"chain\"\ndiameter        = 0.0037      # m\nmass_per_length = 0.0607      # kg/m\n\
         stiffness       = 3e4         # EA, N",
    ),
    ("line_type.diameter", "diameter = 0.0037        # of the volume of a metre, m"),
    ("mass_per_length", "mass_per_length = 0.0607        # in air, kg/m"),
    ("line_type.stiffness", "stiffness = 3e4        # EA, N"),
    ("line_type.damping_ratio", "damping_ratio = 1.0        # of the critical damping of a segment"),
    (
        "mooring",
        "[[mooring]]\nname    = \"west\"\nbetween = [\"box\"]\nfrom    = [2.9, 0.4]\nto      = [1.0, 0.0]\n\
         length  = 2.1\nline    = \"chain\"",
    ),
    ("mooring.length", "length = 2.1        # without tension, m"),
    ("mooring.between", "between = [\"box\"]        # the other end is on the ground"),
    ("mooring.from", "from = [2.9, 0.4]        # m, on the solid"),
    ("mooring.to", "to = [1.0, 0.0]        # m, on the ground"),
    ("paid_out", "paid_out = { formula = \"0.05*t\" }        # m"),
    ("mooring_point", "[[mooring_point]]\nname   = \"bridle\"\nat     = [2.0, 0.3]\nmass   = 0.1\nvolume = 3e-4"),
    ("line", "line = \"chain\"        # the name of a [[line_type]]"),
    ("segments", "segments = 20"),
    ("clumps", "clumps = [{ at = 1.0, mass = 0.2 }]        # m, kg"),
    ("force", "[[force]]\nname  = \"wind\"\non    = \"box\"\nforce = [\"20*sin(t)\", 0.0]"),
    ("on", "on = \"box\""),
    ("force.force", "force = [\"20*sin(t)\", 0.0]        # N, one entry an axis"),
    ("force.torque", "torque = \"2*sin(t)\"        # N m; three of them in 3-D"),
    ("since", "since = 1.0        # s"),
    ("spring.until", "until = 4.0        # s"),
    ("rope.until", "until = 4.0        # s"),
    ("joint.until", "until = 4.0        # s"),
    ("force.until", "until = 4.0        # s"),
    ("solid.until", "until = 4.0        # s, when it is removed"),
    ("breaks", "breaks = { tension = 300.0 }        # N"),
    ("joint.breaks", "breaks = { force = 300.0 }        # N, or  { torque = 20.0 }, N m"),
    ("wind", "[[wind]]\nvelocity = [10.0, 0.0]\non       = [\"box\"]"),
    ("wind.velocity", "velocity = [10.0, 0.0]        # m/s, one entry an axis"),
    ("wind.on", "on = [\"box\"]"),
    ("wind.drag", "drag = 1.0"),
    ("wind.density", "density = 1.225        # kg/m³, of the air"),
    ("contact", "[[contact]]\nbetween  = [\"box\", \"tank\"]\nfriction = 0.1"),
    ("contact.touch", "touch = false"),
    ("control", "[[control]]\nkey = \"joint.hinge.motor.velocity\"\nmin = -2.0\nmax = 2.0"),
    ("control.key", "key = \"joint.hinge.motor.velocity\""),
    ("control.min", "min = -2.0        # in the unit of the key"),
    ("control.max", "max = 2.0        # in the unit of the key"),
    ("model", "[model]\nviscosity = { riemann = { eta = 3.0 } }"),
    ("kernel", "kernel = \"wendland\""),
    ("viscosity", "viscosity = { riemann = { eta = 3.0 } }"),
    ("viscosity.artificial", "viscosity = { artificial = { alpha = 0.02 } }"),
    ("viscosity.riemann", "viscosity = { riemann = { eta = 3.0 } }"),
    ("viscosity.laminar", "viscosity = { laminar = { nu0 = 1e-6 } }"),
    ("viscosity.sps", "viscosity = { sps = { nu0 = 1e-6 } }"),
    ("diffusion", "diffusion = { fourtakas = { delta = 0.1 } }"),
    ("shifting", "shifting = { everywhere = { a = 2.0 } }"),
    ("walls", "walls = \"relaxed_adami\" # or \"dbc\""),
    ("gradient", "gradient = \"near_surface\" # or \"plain\", \"corrected\""),
    ("slip", "slip = \"none\"         # or \"free\", \"partial\""),
    ("sweep", "sweep = \"fast\""),
    ("device", "device = \"gpu\"        # or the number of a device as a text, \"0\"; \"cpu\" is the processor"),
    ("time", "[time]\nscheme = \"symplectic\""),
    ("scheme", "scheme = { verlet = { euler_every = 50 } }"),
    ("probe", "[[probe]]\nmotion = \"box\""),
    ("motion", "motion = \"box\""),
    ("elevation", "elevation = { x = 1.16 }, or a row:  elevation = { from = 1.0, to = 3.0, count = 5 }"),
    ("surface", "surface = \"highest\"      # or \"lowest\", \"all\""),
    ("count", "count = 5"),
    ("spacing", "spacing = 0.1        # m"),
    ("flow", "flow = { from = [1.0, 0.3], to = [1.0, 0.6] }        # positive to the right: along x, if upwards"),
    ("average", "average = true"),
    ("velocity", "velocity = [0.75, 0.03]"),
    ("pressure", "pressure = [0.75, 0.03]"),
    ("frames", "frames = { every = 0.05, fields = [\"velocity\", \"pressure\"] }"),
    ("fields", "fields = [\"velocity\", \"density\", \"pressure\", \"id\"]"),
    ("checkpoint", "checkpoint = { wall = 600.0 }"),
    ("check", "[[check]]\nseries = \"box.heave_m\"\nreference = \"body.csv\"\ncolumn = \"heave_m\""),
    ("statistic", "[[statistic]]\nreflection = [\"g1\", \"g2\", \"g3\"]"),
    ("waves", "waves = \"gauge.eta_m\""),
    ("reflection", "reflection = [\"g1\", \"g2\", \"g3\"]"),
    ("rao", "rao = { motion = \"buoy\", wave = \"gauge\" }"),
    ("period", "period = 1.2       # s"),
    ("depth", "depth = 0.4        # m"),
    ("series", "series = \"box.heave_m\""),
    ("reference", "reference = \"body.csv\""),
    ("column", "column = \"x_m\", or  column = 2        # counted from 1"),
    ("check.column", "column = \"heave_m\""),
    ("time_factor", "time_factor = 0.001        # milliseconds to s"),
    ("offset", "offset = -12.5        # s, added to the times of the table"),
    ("check.formula", "formula = \"0.05*cos(2*pi*t/1.2)\""),
    ("response", "response = { to = \"gauge.eta_m\", period = 1.2, ratio = 1.1 }"),
    ("response.to", "to = \"gauge.eta_m\""),
    ("response.period", "period = 1.2        # s"),
    ("response.ratio", "ratio = 1.1        # amplitude over that of the other series"),
    ("response.lag", "lag = 0.25        # periods behind the other series"),
    ("check.from", "from = 1.0         # s, of the run"),
    ("check.until", "until = 2.0        # s, of the run"),
    ("check.zero", "zero = 6.32        # s, of the run"),
    ("check.mean", "mean = 0.005       # s"),
    ("align", "align = \"best\", or  align = { crossing = 5.0 }"),
    ("align.crossing", "align = { crossing = 5.0 }        # in the unit of the series"),
    ("align.start", "align = { start = 5.0 }        # in the unit of the series"),
    ("bound", "bound = { N = 0.3, M = 0.2, peak = 0.2, off = 0.01, aligned_N = 0.2, delay = 0.05, period = 0.05 }"),
    ("paper", "paper = { N = 0.355, M = 1.115 }"),
];

/// Returns an example for `key` that the user can copy.
pub(super) fn example(key: &str) -> Option<String> {
    let parts: Vec<&str> = key.split('.').filter(|part| part.parse::<usize>().is_err()).collect();
    let tail = |from: usize| parts[from..].join(".");
    let own = parts.len().checked_sub(2).map(tail).into_iter().chain(parts.len().checked_sub(1).map(tail));
    let of_probe = |tail: &str| tail.strip_prefix("probe.").and_then(probe::example);
    let listed = |tail: &str| EXAMPLES.iter().find(|(key, _)| *key == tail).map(|(_, example)| *example);
    own.filter_map(|tail| listed(&tail).or_else(|| of_probe(&tail))).next().map(example_help)
}

fn example_help(example: &str) -> String {
    format!("write  {}", example.replace('\n', "\n       "))
}

/// Returns the advice to write the line of `key` in `example`, without the lines that the scene has; `None` if no line is its own.
fn line_of(key: &str, example: &str) -> Option<String> {
    let mut lines = example.lines().map(|line| line.trim_start_matches("write").trim());
    lines.find(|line| line.split('=').next().is_some_and(|k| k.trim() == key)).map(example_help)
}

/// Returns the names in backticks in the `message` of the parser.
fn quoted(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

fn list(words: &[&str]) -> String {
    words.join(", ")
}

/// Returns the noun for the value of `key` in a sentence: the last part of the key that is not a number.
fn key_noun(key: &str) -> &str {
    key.rsplit('.').find(|part| part.parse::<usize>().is_err()).unwrap_or(key)
}

/// Returns the error for the parser's `message` about `key`, and the key that the error concerns.
pub(super) fn explain(message: &str, key: &str) -> (Error, String) {
    let words = quoted(message);
    let with = |error: Error, lines: Vec<String>| match lines.is_empty() {
        true => error,
        false => error.help(lines.join("\n")),
    };
    if let (true, [word, known @ ..]) = (message.starts_with("unknown field"), &words[..]) {
        // `key` is the unknown key or, for an untagged type, the key above it.
        let above = if key == *word { Some("") } else { key.strip_suffix(&format!(".{word}")) };
        let parent = above.unwrap_or(key);
        let error = Error::scene(format!("unknown key \"{word}\"{}", suggestion(word, known.iter().copied())))
            .with_code(ErrorCode::UnknownKey);
        let shown = if parent.is_empty() { word.to_string() } else { format!("{parent}.{word}") };
        // The example must have the same parent: the velocity of water differs from the velocity key of a probe.
        let near = nearest_name(word, known.iter().copied()).and_then(|near| example(&format!("{parent}.{near}")));
        // The example of the section would repeat the lines that the scene has.
        let other = || match nearest_name(word, known.iter().copied()) {
            Some(near) => format!("write  {near}  in place of  {word}"),
            None => format!("remove  {word}: a scene has no such key here"),
        };
        let guess = Some(near.unwrap_or_else(other));
        let known = format!("known here: {}", list(known));
        return (with(error, [known].into_iter().chain(guess).collect()), shown);
    }
    if let (true, [word, known @ ..]) = (message.starts_with("unknown variant"), &words[..]) {
        let key = key.strip_suffix(&format!(".{word}")).unwrap_or(key);
        let error =
            Error::scene(format!("unknown {} \"{word}\"{}", key_noun(key), suggestion(word, known.iter().copied())))
                .with_code(ErrorCode::UnknownName);
        let known_names = known.iter().copied();
        let known = format!("known: {}", list(known));
        let near = nearest_name(word, known_names).and_then(|near| example(&format!("{key}.{near}")));
        return (with(error, [known].into_iter().chain(near.or_else(|| example(key))).collect()), key.to_string());
    }
    if let (true, [word]) = (message.starts_with("missing field"), &words[..]) {
        let error = Error::scene(format!("\"{word}\" is missing")).with_code(ErrorCode::MissingKey);
        let full = if key.is_empty() { word.to_string() } else { format!("{key}.{word}") };
        let own = example(&full).or_else(|| example(key).map(|example| line_of(word, &example).unwrap_or(example)));
        return (with(error, own.into_iter().collect()), full);
    }
    if let Some((found, wanted)) = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid value: "))
        .and_then(|rest| rest.split_once(", expected "))
    {
        let found = translated_found(found);
        let error = Error::scene(format!("{} must be {}, not {found}", key_noun(key), translated_type(wanted)))
            .with_code(ErrorCode::WrongType);
        return (with(error, example(key).into_iter().collect()), key.to_string());
    }
    if message.contains("exactly 1 element") {
        let error = Error::scene(format!("{} takes one choice: a word, or a table with one key", key_noun(key)))
            .with_code(ErrorCode::WrongType);
        return (with(error, example(key).into_iter().collect()), key.to_string());
    }
    let error = Error::scene(format!("{}: {message}", key_noun(key)).trim_start_matches(": ").to_string());
    (with(error, example(key).into_iter().collect()), key.to_string())
}

/// Returns a plain description of the value that the parser found.
fn translated_found(found: &str) -> String {
    let (kind, rest) = found.split_once(' ').unwrap_or((found, ""));
    let rest = rest.trim_start_matches("point ").replace('`', "");
    match kind {
        "string" => format!("the text {rest}"),
        "sequence" => "a list".into(),
        "map" => "a table".into(),
        "integer" | "floating" | "boolean" => rest,
        _ => found.replace('`', ""),
    }
}

/// Returns a plain description of the type that the parser expects.
fn translated_type(wanted: &str) -> &str {
    match wanted {
        "f64" => "a number",
        "usize" | "u32" | "u64" => "a whole number, not negative",
        "a boolean" => "true or false",
        "a sequence" => "a list",
        other if other.starts_with("struct") || other.starts_with("internally") => "a table",
        other if other.contains("enum") || other.contains("string only") => "a word, or a table with one key",
        other => other,
    }
}

/// Returns advice on TOML syntax for `message`.
pub(super) fn toml_help(message: &str) -> &'static str {
    if message.contains("duplicate") {
        "each key once; several solids are several [[solid]] sections, with two brackets"
    } else {
        "words need quotes, decimals a digit on both sides of the point: fixed = true, dp = 0.01, name = \"box\""
    }
}
