//! Translates errors of the parser for users: the fault, the nearest valid name, an example.

use crate::{
    error::{Error, ErrorCode, nearest_name},
    probe,
};

/// Examples by the whole key without its numbers; `*.` stands for any beginning. A whole key takes precedence over an entry with
/// `*.`.
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
    ("guard.escape", "escape = \"remove\"    # or \"stop\""),
    ("water.velocity", "velocity = [\"0.1*sin(2*pi*x)\", 0.0]        # m/s, one entry an axis"),
    ("water.pressure", "pressure = \"20*cos(2*pi*x)\"        # Pa, beyond that of water at rest"),
    ("water", "[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }"),
    ("water.fill", "fill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }"),
    ("*.level", "level = 0.4        # height of the surface, m"),
    (
        "inflow",
        "[[inflow]]\nx        = 0.0        # m, where the water begins\nvelocity = 0.5        # m/s, into the water",
    ),
    ("inflow.velocity", "velocity = 0.5        # m/s, into the water; or a formula, \"0.6*y*(2-y)\""),
    ("outflow", "[[outflow]]\nx        = 6.0        # m, where the water ends\nvelocity = 0.5        # m/s, out of it"),
    ("outflow.velocity", "velocity = 0.5        # m/s, out of the water; or a formula, \"0.6*y*(2-y)\""),
    ("inflow.x", "x = 0.0        # m, where the water begins"),
    ("outflow.x", "x = 6.0        # m, where the water ends"),
    ("*.factor", "factor = \"min(t/2, 1)\""),
    ("inflow.absorb", "absorb = true"),
    ("outflow.absorb", "absorb = true"),
    ("current", "current = { along = \"x\", discharge = 0.25 }        # m²/s; m³/s in 3-D"),
    ("current.discharge", "discharge = 0.25        # m²/s; m³/s in 3-D"),
    ("current.response", "response = 2.0        # s, in which the discharge follows"),
    ("current.along", "along = \"x\""),
    ("towed", "towed = { along = \"x\", velocity = \"0.5*min(t, 2)\" }        # m/s"),
    ("towed.along", "along = \"x\""),
    ("towed.velocity", "velocity = \"0.5*min(t, 2)\"        # m/s"),
    ("damping", "[[damping]]\nfrom = [6.0, 0.0]\nto   = [8.0, 0.0]"),
    ("damping.from", "from = [6.0, 0.0]        # m, where the zone begins"),
    ("damping.to", "to = [8.0, 0.0]          # m, where it is full"),
    ("damping.strength", "strength = 5.0        # 1/s"),
    ("damping.power", "power = 2.0           # even: 1, gentler at first: more"),
    ("solid", "[[solid]]\nname  = \"box\"\nshape = { box = { size = [0.1, 0.05] } }\nfree  = { density = 500.0 }"),
    ("*.name", "name = \"box\""),
    ("*.shape", "shape = { box = { size = [0.1, 0.05] } }"),
    ("solid.shape.box", "shape = { box = { size = [0.1, 0.05] } }"),
    ("solid.shape.ball", "shape = { ball = { radius = 0.1 } }"),
    ("solid.shape.capsule", "shape = { capsule = { length = 0.2, radius = 0.05, axis = \"x\" } }"),
    ("solid.shape.cylinder", "shape = { cylinder = { length = 0.2, radius = 0.05, axis = \"z\" } }"),
    ("solid.shape.ellipsoid", "shape = { ellipsoid = { radii = [0.2, 0.1] } }        # m, one number an axis"),
    ("solid.shape.cone", "shape = { cone = { radius = 0.1, length = 0.2 } }"),
    ("solid.shape.frustum", "shape = { frustum = { radius_bottom = 0.2, radius_top = 0.1, length = 0.2 } }"),
    ("solid.shape.wedge", "shape = { wedge = { size = [1.0, 0.5, 0.2] } }"),
    ("solid.shape.prism", "shape = { prism = { points = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]], length = 0.5 } }"),
    ("solid.shape.torus", "shape = { torus = { radius = 0.2, tube_radius = 0.05 } }"),
    ("solid.shape.polygon", "shape = { polygon = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]] }"),
    ("solid.shape.polyline", "shape = { polyline = [[0.0, 0.0], [4.0, 0.0], [10.0, 0.6]] }"),
    ("solid.shape.tank", "shape = { tank = { size = [1.0, 0.5] } }"),
    ("solid.shape.compound", "shape = { compound = [{ shape = { ball = { radius = 0.1 } }, at = { x = 0.1 } }] }"),
    ("solid.at", "at = { x = 2.0, draft = \"equilibrium\" }"),
    ("water.fill.at", "at = { x = 2.0, draft = \"equilibrium\" }"),
    ("solid.at.draft", "at = { x = 2.0, draft = \"equilibrium\" }"),
    ("solid.fixed", "fixed = true"),
    ("solid.driven", "driven = { along = [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } }"),
    (
        "solid.driven.motions",
        "motions = [\n  { along = [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } },\n  { hinge = [0.5, 0.0], angle_deg = { formula = \"2*sin(2*pi*t)\" } },\n]",
    ),
    ("solid.driven.wave", "wave = { regular = { height = 0.1, period = 1.2 } }"),
    ("*.wave.regular", "wave = { regular = { height = 0.1, period = 1.2 } }"),
    ("*.wave.jonswap", "wave = { jonswap = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    ("*.wave.bretschneider", "wave = { bretschneider = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    ("*.wave.pierson_moskowitz", "wave = { pierson_moskowitz = { height = 0.1, seed = 1 } }"),
    (
        "solid.driven.wave.focused",
        "wave = { focused = { crest = 0.08, peak_period = 1.4, distance = 4.0, time = 10.0 } }",
    ),
    ("solid.driven.wave.solitary", "wave = { solitary = { height = 0.1 } }"),
    ("*.wave.components", "wave = { components = { file = \"components.csv\" } }"),
    (
        "solid.driven.wave.elevation",
        "wave = { elevation = { file = \"gauge.csv\", column = \"eta_m\", distance = 2.0 } }",
    ),
    ("*.jonswap.peak_period", "wave = { jonswap = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    ("*.bretschneider.peak_period", "wave = { bretschneider = { height = 0.1, peak_period = 1.4, seed = 1 } }"),
    (
        "solid.driven.wave.absorb",
        "absorb = true, or  absorb = { period = 1.2, stroke = 0.4, speed = 1.0 }        # s, m, m/s",
    ),
    ("*.wave.ramp", "ramp = 2.4        # s"),
    ("solid.driven.along", "driven = { along = [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } }"),
    ("solid.driven.distance", "distance = { formula = \"0.05*sin(2*pi*t)\" }"),
    ("solid.driven.hinge", "driven = { hinge = [0.0, 0.0], angle = { file = \"flap.csv\", column = \"angle_deg\" } }"),
    ("solid.driven.angle", "angle = { file = \"flap.csv\", column = \"angle_deg\" }"),
    ("solid.driven.angle_deg", "angle_deg = { formula = \"5*sin(2*pi*t)\" }"),
    ("*.formula", "formula = \"0.05*sin(2*pi*t)\""),
    ("solid.free", "free = { density = 500.0 }"),
    ("joint.free", "free = [\"y\", \"turn\"]"),
    ("solid.free.density", "free = { density = 500.0 }        # kg/m³"),
    ("solid.free.inertia", "free = { density = 500.0, inertia = 0.005 }        # kg m²/m; three numbers in 3-D"),
    ("solid.free.release", "free = { density = 500.0, release = 1.0 }        # s"),
    ("solid.free.ballast", "free = { density = 500.0, ballast = [{ at = [0.1, 0.0], mass = \"0.5*t\" }] }"),
    ("solid.free.locked", "free = { density = 500.0, locked = [\"x\", \"turn\"] }"),
    ("solid.contact_skin", "contact_skin = 0.005        # m"),
    (
        "joint",
        "[[joint]]\nname    = \"hinge\"\nkind    = \"hinge\"\nbetween = [\"fore\", \"aft\"]\nat      = [2.0, 0.5]",
    ),
    ("joint.kind", "kind = \"hinge\"      # or \"slider\", \"fixed\", \"ball\", \"tow\", \"generic\""),
    ("joint.between", "between = [\"fore\", \"aft\"]        # two solids; or one, and the world"),
    ("spring.between", "between = [\"fore\", \"aft\"]        # two solids; or one, and the world"),
    ("rope.between", "between = [\"fore\", \"aft\"]        # two solids; or one, and the world"),
    ("*.regular.height", "regular = { height = 0.1, period = 1.2 }        # m, s"),
    ("*.regular.period", "regular = { height = 0.1, period = 1.2 }        # m, s"),
    ("joint.axis", "axis = [0.0, 1.0, 0.0]"),
    ("solid.driven.axis", "axis = [0.0, 1.0, 0.0]"),
    ("joint.along", "along = [0.0, 1.0]"),
    ("joint.at", "at = [2.0, 0.5]        # m, in the world, at the start"),
    ("joint.limits", "limits = [-0.1, 0.1]        # m or rad, from the start"),
    ("joint.limits_deg", "limits_deg = [-30.0, 30.0]"),
    ("joint.motor", "motor = { damping = 20.0 }        # a power take-off"),
    ("joint.motor.damping", "motor = { damping = 20.0 }"),
    ("joint.motor.stiffness", "motor = { position = 0.0, stiffness = 500.0, damping = 20.0 }"),
    ("joint.motor.velocity", "motor = { velocity = 0.5, damping = 20.0 }"),
    ("joint.motor.force", "motor = { force = \"5*sin(2*pi*t)\" }"),
    ("joint.motor.torque", "motor = { torque = \"5*sin(2*pi*t)\" }"),
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
    ("line_type.mass_per_length", "mass_per_length = 0.0607        # in air, kg/m"),
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
    ("mooring.paid_out", "paid_out = { formula = \"0.05*t\" }        # m"),
    ("mooring_point", "[[mooring_point]]\nname   = \"bridle\"\nat     = [2.0, 0.3]\nmass   = 0.1\nvolume = 3e-4"),
    ("mooring.line", "line = \"chain\"        # the name of a [[line_type]]"),
    ("mooring.segments", "segments = 20"),
    ("mooring.clumps", "clumps = [{ at = 1.0, mass = 0.2 }]        # m, kg"),
    ("force", "[[force]]\nname  = \"wind\"\non    = \"box\"\nforce = [\"20*sin(t)\", 0.0]"),
    ("force.on", "on = \"box\""),
    ("probe.on", "on = \"box\""),
    ("probe.elevation.on", "on = \"box\""),
    ("force.force", "force = [\"20*sin(t)\", 0.0]        # N, one entry an axis"),
    ("force.torque", "torque = \"2*sin(t)\"        # N m; three of them in 3-D"),
    ("*.since", "since = 1.0        # s"),
    ("spring.until", "until = 4.0        # s"),
    ("rope.until", "until = 4.0        # s"),
    ("joint.until", "until = 4.0        # s"),
    ("force.until", "until = 4.0        # s"),
    ("solid.until", "until = 4.0        # s, when it is removed"),
    ("*.breaks", "breaks = { tension = 300.0 }        # N"),
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
    ("model.kernel", "kernel = \"wendland\""),
    ("model.viscosity", "viscosity = { riemann = { eta = 3.0 } }"),
    ("model.viscosity.artificial", "viscosity = { artificial = { alpha = 0.02 } }"),
    ("model.viscosity.riemann", "viscosity = { riemann = { eta = 3.0 } }"),
    ("model.viscosity.laminar", "viscosity = { laminar = { nu0 = 1e-6 } }"),
    ("model.viscosity.sps", "viscosity = { sps = { nu0 = 1e-6 } }"),
    ("model.diffusion", "diffusion = { fourtakas = { delta = 0.1 } }"),
    ("model.shifting", "shifting = { everywhere = { a = 2.0 } }"),
    ("model.walls", "walls = \"relaxed_adami\" # or \"dbc\""),
    ("model.gradient", "gradient = \"near_surface\" # or \"plain\", \"corrected\""),
    ("model.slip", "slip = \"none\"         # or \"free\", \"partial\""),
    ("model.sweep", "sweep = \"fast\""),
    ("model.device", "device = \"gpu\"        # or the number of a device as a text, \"0\"; \"cpu\" is the processor"),
    ("time", "[time]\nscheme = \"symplectic\""),
    ("time.scheme", "scheme = { verlet = { euler_every = 50 } }"),
    ("probe", "[[probe]]\nmotion = \"box\""),
    ("*.motion", "motion = \"box\""),
    ("probe.elevation", "elevation = { x = 1.16 }, or a row:  elevation = { from = 1.0, to = 3.0, count = 5 }"),
    ("probe.elevation.surface", "surface = \"highest\"      # or \"lowest\", \"all\""),
    ("*.count", "count = 5"),
    ("*.spacing", "spacing = 0.1        # m"),
    ("probe.flow", "flow = { from = [1.0, 0.3], to = [1.0, 0.6] }        # positive to the right: along x, if upwards"),
    ("probe.average", "average = true"),
    ("probe.velocity", "velocity = [0.75, 0.03]"),
    ("probe.pressure", "pressure = [0.75, 0.03]"),
    ("frames", "frames = { every = 0.05, fields = [\"velocity\", \"pressure\"] }"),
    ("frames.fields", "fields = [\"velocity\", \"density\", \"pressure\", \"id\"]"),
    ("checkpoint", "checkpoint = { wall = 600.0 }"),
    ("check", "[[check]]\nseries = \"box.heave_m\"\nreference = \"body.csv\"\ncolumn = \"heave_m\""),
    ("statistic", "[[statistic]]\nreflection = [\"g1\", \"g2\", \"g3\"]"),
    ("statistic.waves", "waves = \"gauge.eta_m\""),
    ("statistic.reflection", "reflection = [\"g1\", \"g2\", \"g3\"]"),
    ("statistic.rao", "rao = { motion = \"buoy\", wave = \"gauge\" }"),
    ("*.period", "period = 1.2       # s"),
    ("*.depth", "depth = 0.4        # m"),
    ("check.series", "series = \"box.heave_m\""),
    ("check.reference", "reference = \"body.csv\""),
    ("*.column", "column = \"x_m\", or  column = 2        # counted from 1"),
    ("check.column", "column = \"heave_m\""),
    ("*.time_factor", "time_factor = 0.001        # milliseconds to s"),
    ("*.offset", "offset = -12.5        # s, added to the times of the table"),
    ("check.formula", "formula = \"0.05*cos(2*pi*t/1.2)\""),
    ("check.response", "response = { to = \"gauge.eta_m\", period = 1.2, ratio = 1.1 }"),
    ("check.response.to", "to = \"gauge.eta_m\""),
    ("check.response.period", "period = 1.2        # s"),
    ("check.response.ratio", "ratio = 1.1        # amplitude over that of the other series"),
    ("check.response.lag", "lag = 0.25        # periods behind the other series"),
    ("check.from", "from = 1.0         # s, of the run"),
    ("check.until", "until = 2.0        # s, of the run"),
    ("check.zero", "zero = 6.32        # s, of the run"),
    ("check.mean", "mean = 0.005       # s"),
    ("check.align", "align = \"best\", or  align = { crossing = 5.0 }"),
    ("check.align.crossing", "align = { crossing = 5.0 }        # in the unit of the series"),
    ("check.align.start", "align = { start = 5.0 }        # in the unit of the series"),
    (
        "check.bound",
        "bound = { N = 0.3, M = 0.2, peak = 0.2, off = 0.01, aligned_N = 0.2, delay = 0.05, period = 0.05 }",
    ),
    ("check.paper", "paper = { N = 0.355, M = 1.115 }"),
    ("force.at", "at = [0.1, 0.0]        # m, on the solid, from its reference point"),
    ("solid.free.ballast.at", "at = [0.1, 0.0]        # m, in the frame of the solid"),
    ("mooring.clumps.at", "at = 1.0        # m along the line, from its first end"),
    ("mooring_point.at", "at = [2.0, 0.3]        # m, at the start"),
    ("*.at.angle_deg", "angle_deg = 5.0        # degrees, counter-clockwise"),
    ("spring.damping", "damping = 20.0        # N s/m"),
    ("*.breaks.force", "force = 300.0        # N"),
    ("*.breaks.torque", "torque = 20.0        # N m"),
    ("*.breaks.tension", "tension = 300.0        # N"),
    ("solid.driven.wave.focused.distance", "distance = 4.0        # m, from the paddle"),
    ("solid.driven.wave.focused.time", "time = 10.0        # s"),
    ("solid.driven.wave.elevation.distance", "distance = 2.0        # m, from the paddle"),
    ("*.time", "time = \"t_s\", or  time = 1        # the column of times"),
    ("*.mesh.contact", "contact = \"hull\""),
    ("contact.between", "between = [\"box\", \"tank\"]"),
    ("*.axis", "axis = \"z\""),
    ("solid.free.velocity", "velocity = [0.5, 0.0]        # m/s, at the start, one entry an axis"),
    ("check.bound.period", "period = 0.05        # of the period of the reference"),
    ("check.paper.period", "period = 0.05        # of the period of the reference"),
];

/// Returns an example for `key` that the user can copy.
pub(super) fn example(key: &str) -> Option<String> {
    let path = without_numbers(key);
    let listed = |path: &str| EXAMPLES.iter().find(|(key, _)| *key == path).map(|(_, example)| *example);
    let is_end = |end: &str| path.strip_suffix(end).is_some_and(|rest| rest.ends_with('.'));
    let ends = EXAMPLES.iter().filter_map(|(key, example)| Some((key.strip_prefix("*.")?, example)));
    let longest = || ends.filter(|(end, _)| is_end(end)).max_by_key(|(end, _)| end.len()).map(|(_, example)| *example);
    let of_probe = || path.strip_prefix("probe.").and_then(probe::example);
    listed(&path).or_else(of_probe).or_else(longest).map(example_help)
}

/// Returns the path of `key` without numbers. A part of a compound counts as a shape, and a motion of several as one.
fn without_numbers(key: &str) -> String {
    let parts: Vec<&str> = key.split('.').filter(|part| !part.is_empty() && part.parse::<usize>().is_err()).collect();
    let whole = parts.join(".");
    whole.replace("compound.shape", "shape").replace("shape.shape", "shape").replace("driven.motions.", "driven.")
}

fn example_help(example: &str) -> String {
    format!("write  {}", example.replace('\n', "\n       "))
}

/// Returns the advice to write only the line of `key` from `example`; `None` if no line of `example` is that of `key`.
fn line_of(key: &str, example: &str) -> Option<String> {
    let mut lines = example.lines().map(|line| line.trim_start_matches("write").trim());
    lines.find(|line| line.split('=').next().is_some_and(|k| k.trim() == key)).map(example_help)
}

/// Words of other programs and of the literature, and the name of each in a scene.
const SYNONYMS: &[(&str, &str)] = &[
    ("sphere", "ball"),
    ("disc", "ball"),
    ("ellipse", "ellipsoid"),
    ("convex", "hull"),
    ("H", "height"),
    ("Hs", "height"),
    ("T", "period"),
    ("T", "peak_period"),
    ("Tp", "peak_period"),
];

/// Returns the name of `known` that means `word`, or the one nearest to it.
fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let meant = SYNONYMS.iter().filter(|(other, _)| *other == word);
    let meant = meant.flat_map(|(_, name)| known.iter().find(|known| *known == name)).next();
    meant.copied().or_else(|| nearest_name(word, known.iter().copied()))
}

/// Returns the end of a message that proposes `name`.
fn proposal(name: Option<&str>) -> String {
    name.map_or(String::new(), |name| format!("; did you mean \"{name}\"?"))
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
        let nearest = nearest(word, known);
        let error =
            Error::scene(format!("unknown key \"{word}\"{}", proposal(nearest))).with_code(ErrorCode::UnknownKey);
        let shown = if parent.is_empty() { word.to_string() } else { format!("{parent}.{word}") };
        // The example must have the same parent: the velocity of water differs from the velocity key of a probe.
        let near = nearest.and_then(|near| example(&format!("{parent}.{near}")));
        // The example of the section would repeat the lines that the scene has.
        let other = || match nearest {
            Some(near) => format!("write  {near}  in place of  {word}"),
            None => format!("remove  {word}: a scene has no such key here"),
        };
        let guess = Some(near.unwrap_or_else(other));
        let known = format!("known here: {}", list(known));
        return (with(error, [known].into_iter().chain(guess).collect()), shown);
    }
    if let (true, [word, known @ ..]) = (message.starts_with("unknown variant"), &words[..]) {
        let (key, is_table) = match key.strip_suffix(&format!(".{word}")) {
            Some(above) => (above, true),
            None => (key, false),
        };
        let nearest = nearest(word, known);
        let error = Error::scene(format!("unknown {} \"{word}\"{}", key_noun(key), proposal(nearest)))
            .with_code(ErrorCode::UnknownName);
        let known = format!("known: {}", list(known));
        let in_list = key.rsplit('.').next().is_some_and(|part| part.parse::<usize>().is_ok());
        let near = nearest.map(|near| {
            example(&format!("{key}.{near}")).unwrap_or_else(|| match is_table || in_list {
                true => format!("write  {near}  in place of  {word}"),
                false => format!("write  {} = \"{near}\"", key_noun(key)),
            })
        });
        return (with(error, [known].into_iter().chain(near.or_else(|| example(key))).collect()), key.to_string());
    }
    if let (true, [word]) = (message.starts_with("missing field"), &words[..]) {
        let error = Error::scene(format!("\"{word}\" is missing")).with_code(ErrorCode::MissingKey);
        let full = if key.is_empty() { word.to_string() } else { format!("{key}.{word}") };
        // The example of the section counts if it has the key.
        let has_word =
            |example: &String| example.split(|c: char| !c.is_alphanumeric() && c != '_').any(|part| part == *word);
        let of_section = || example(key).and_then(|all| line_of(word, &all).or_else(|| Some(all).filter(has_word)));
        let own = example(&full).or_else(of_section);
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
    if let Some((found, wanted)) =
        message.strip_prefix("invalid length ").and_then(|rest| rest.split_once(", expected an array of length "))
    {
        let error = Error::scene(format!("{} must be a list of {wanted}, not of {found}", key_noun(key)))
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

#[cfg(test)]
#[path = "../../tests/unit/scene/diagnostics.rs"]
mod tests;
