//! Faces whose inflow and outflow differ or do not fit the water at the start, and currents too slow to take the surface under a body.

use super::{Finding, PreflightContext, wavemaker_site::zone_extent};
use crate::{
    geometry::world_bounds,
    math::{
        Vector,
        format::{three_digits, two_digits_down},
    },
    solid::Solid,
    system::{OpenBoundary, passing_speeds, prescribed_discharge},
};

/// Difference between inflow and outflow, over the larger of the two, above which a warning is given, –.
const UNEQUAL: f64 = 0.02;

/// Times after the start at which the flow through a face is compared, over the length of the run, –.
const SAMPLE_TIMES: [f64; 3] = [0.37, 0.71, 1.0];

/// Adds findings about the discharges and about slow currents.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    check_discharges(context, findings);
    check_start(context, findings);
    check_surface(context, findings);
    check_damping(context, findings);
}

/// Adds a warning for each damping zone in a current that is held, in water that passes a towed frame, or at a face with a velocity. A
/// zone brings water to rest over the ground of the scene.
fn check_damping<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (system, dp) = (context.system, context.dp());
    let times = || [0.0].into_iter().chain(SAMPLE_TIMES).map(|part| part * context.end_time());
    let driven = times().flat_map(|t| passing_speeds(system, t)).fold(0.0, f64::max);
    for zone in system.sponge_layers() {
        let damped = || system.fluid().r.iter().filter(|x| zone.rate(x) > 0.0);
        let speed_at = |face: &OpenBoundary<D>, x: &Vector<D>| {
            times().filter_map(|t| face.outward_velocity(x, t)).map(f64::abs).fold(0.0, f64::max)
        };
        let at_faces = system.open_boundaries().iter().flat_map(|face| {
            damped().filter(|x| face.beyond(x) > -dp).map(move |x| speed_at(face, x)).collect::<Vec<_>>()
        });
        let passing = damped().next().map_or(0.0, |_| driven);
        let fastest = at_faces.fold(passing, f64::max);
        if fastest > 0.0 {
            let what = format!(
                "{} takes the current of {} m/s as it takes waves: it brings all water to rest",
                zone_extent(zone),
                three_digits(fastest)
            );
            let mend = "leave it out; a face with  absorb = true  lets waves leave with the current".into();
            findings.push(Finding::warning("damped_current", what, mend));
        }
    }
}

/// Adds a note if, in 2-D, a current with U² < g dp meets a body in the surface. The stagnation head U²/(2 g) then does not take
/// the uppermost row of particles under the body: the row comes to rest before the body and slows the rows below. In a test, the
/// row a metre before a block had a share of its speed left after 6 s: 0.15 with U²/(g dp) = 0.16, 0.41 with 0.5, and 0.70 with
/// 1.0.
fn check_surface<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    // In 3-D the surface goes round a body.
    if D != 2 {
        return;
    }
    let (level, dp) = (context.still_water.level, context.dp());
    let speed = |face: &OpenBoundary<D>| {
        let mut at = Vector::zeros();
        (at[face.axis], at[D - 1]) = (face.at, level - 0.5 * dp);
        let inward = |part: f64| Some(-face.outward_velocity(&at, part * context.end_time())?);
        [0.0].into_iter().chain(SAMPLE_TIMES).filter_map(inward).fold(0.0, f64::max)
    };
    let faces = context.system.open_boundaries();
    // Walls along the channel go on beyond the faces.
    let ends_inside = |x: &Vector<D>| faces.iter().all(|face| face.beyond(x) <= 0.0);
    let pierces = |solid: &&Solid<D>| {
        let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        bounds.min[D - 1] < level - dp
            && bounds.max[D - 1] > level
            && ends_inside(&bounds.min)
            && ends_inside(&bounds.max)
    };
    let driven = SAMPLE_TIMES.iter().flat_map(|part| passing_speeds(context.system, part * context.end_time()));
    let fastest = faces.iter().map(speed).chain(driven).fold(0.0, f64::max);
    let Some(body) = context.solids().iter().find(pierces) else { return };
    if fastest > 0.0 && fastest * fastest < context.g * dp {
        let what = format!(
            "the current of {} m/s is slower than √(g dp), {} m/s: the surface comes to rest before \"{}\" and slows the water below",
            three_digits(fastest),
            three_digits((context.g * dp).sqrt()),
            body.spec.name
        );
        let mend = format!(
            "dp = {} or less; or measure waves and loads before that, some seconds after the start",
            two_digits_down(fastest * fastest / context.g)
        );
        findings.push(Finding::note("slow_current", what, mend));
    }
}

/// Adds a finding about the face whose velocity at the start differs most from that of the water beside it, if the bore that the
/// difference ΔU makes, ΔU √(d/g) high, is higher than dp. A closed tank that is filled or drained gets a note.
fn check_start<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (system, reach) = (context.system, context.system.model().support_radius());
    let (faces, water) = (system.open_boundaries(), system.fluid());
    let speeds = |face: &OpenBoundary<D>| {
        let beside = || water.r.iter().zip(water.v).filter(|(x, _)| face.beyond(x) > -reach);
        let wanted: Vec<f64> = beside().filter_map(|(x, _)| face.outward_velocity(x, 0.0)).collect();
        let now = beside().map(|(_, v)| v[face.axis] * face.outward()).sum::<f64>();
        let count = wanted.len().max(1) as f64;
        (!wanted.is_empty()).then(|| [wanted.iter().sum::<f64>() / count, now / count])
    };
    let found = faces.iter().filter_map(|face| Some((face, speeds(face)?)));
    let Some((face, [wanted, now])) =
        found.max_by(|(_, a), (_, b)| (a[0] - a[1]).abs().total_cmp(&(b[0] - b[1]).abs()))
    else {
        return;
    };
    let bore = (wanted - now).abs() * (context.still_water.depth / context.g).sqrt();
    if context.g == 0.0 || bore <= context.dp() {
        return;
    }
    let [inward, water] = [wanted, now].map(|speed| three_digits(if face.is_inflow { -speed } else { speed }));
    let what = format!(
        "the flow through \"{}\" is {inward} m/s at the start, and that of the water beside it {water} m/s: a bore {} m high begins",
        face.name,
        three_digits(bore)
    );
    let along = |axis: usize| if axis == face.axis { three_digits(wanted * face.outward()) } else { "0.0".into() };
    let velocity = (0..D).map(along).collect::<Vec<_>>().join(", ");
    let mend = format!("give the [[water]]  velocity = [{velocity}],  or the face a factor that rises from 0");
    let passes = faces.iter().any(|face| face.is_inflow) && faces.iter().any(|face| !face.is_inflow);
    let finding = if passes { Finding::warning } else { Finding::note };
    findings.push(finding("resting_water", what, mend));
}

/// Adds a finding if all faces have a velocity that does not change in time, and the discharges do not cancel.
fn check_discharges<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (system, until) = (context.system, context.end_time());
    let faces = system.open_boundaries();
    let at = |i: usize, t: f64| prescribed_discharge(system, i, t);
    let mut outward = Vec::new();
    for i in 0..faces.len() {
        let Some(now) = at(i, 0.0) else { return };
        if SAMPLE_TIMES.iter().any(|part| at(i, part * until).is_none_or(|q| (q - now).abs() > 1e-9 * now.abs())) {
            return;
        }
        outward.push(now);
    }
    let [enters, leaves] = [-1.0, 1.0].map(|sense| outward.iter().map(|q| (sense * q).max(0.0)).sum::<f64>());
    if (enters - leaves).abs() <= UNEQUAL * enters.max(leaves) {
        return;
    }
    let unit = if D == 2 { "m²/s" } else { "m³/s" };
    let flows = [enters, leaves].map(three_digits);
    // A face that absorbs gives way to the level, so that the discharges come to agree.
    let absorbing = faces.iter().position(|face| face.absorbed_speed.is_some());
    let outflow = faces.iter().position(|face| !face.is_inflow);
    let factor = outflow.filter(|&i| outward[i] > 0.0 && outward[i] + enters > leaves).map(|i| {
        let factor = three_digits(1.0 + (enters - leaves) / outward[i]);
        format!("give \"{}\" {factor} times its velocity, or a level without a velocity", faces[i].name)
    });
    let sign = "a velocity is positive in the sense of the flow";
    let (what, mend) = match absorbing.map(|i| &faces[i].name) {
        Some(name) => (
            format!(
                "{} {unit} of water are to enter through the faces, and {} {unit} to leave; \"{name}\" absorbs, and its \
                 discharge gives way to the level until they agree",
                flows[0], flows[1]
            ),
            format!(
                "absorb = false  keeps the discharge of \"{name}\", and the level changes; {}",
                factor.map_or_else(|| sign.into(), |factor| format!("or {factor}"))
            ),
        ),
        None => (
            format!("{} {unit} of water enter through the faces, and {} {unit} leave", flows[0], flows[1]),
            factor.unwrap_or_else(|| format!("{sign}; give an outflow a level without a velocity")),
        ),
    };
    findings.push(Finding::warning("unequal_discharges", what, mend));
}
