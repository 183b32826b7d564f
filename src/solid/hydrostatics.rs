//! Hydrostatics: the height at which a body floats, and its metacentric height.

use crate::{
    error::{Error, Result},
    geometry::Shape,
    math::{Bivector, Bounds, Pose, Vector},
    solid::FreeBody,
};

/// Change of the pose's last coordinate (m) that floats the body as posed: ρ₀ V_submerged = m.
///
/// `mass`: kg (kg/m in 2-D); `rho0`: density of the water, kg/m³; `level`: height of the still water, m.
/// The pose is only lifted or lowered, not turned.
///
/// # Errors
/// `Scene` if the body sinks: says how many times too dense it is.
///
/// Source: Archimedes; V is monotone in the height, so bisection finds the only solution.
pub fn equilibrium_height<const D: usize>(
    shape: &Shape<D>,
    pose: &Pose<D>,
    mass: f64,
    rho0: f64,
    level: f64,
) -> Result<f64> {
    let (low, high) = vertical_extent(shape, pose);
    let lifted = |height: f64| {
        let mut pose = *pose;
        pose.position[D - 1] += height;
        pose
    };
    // From just submerged to just out of the water.
    let (mut under, mut over) = (level - high, level - low);
    let whole = shape.submerged_volume(&lifted(under), level).0;
    if !(mass > 0.0 && mass < rho0 * whole) {
        return Err(Error::scene(format!(
            "the body sinks: its mass {mass} is {:.3} of the {} of water that it can displace",
            mass / (rho0 * whole),
            rho0 * whole
        ))
        .help("a floating body needs a density between 0 and the water's; place a heavier one by its position"));
    }
    while over - under > 1e-14 * (high - low + level.abs()) {
        let middle = 0.5 * (under + over);
        if middle <= under || middle >= over {
            break;
        }
        if rho0 * shape.submerged_volume(&lifted(middle), level).0 > mass {
            under = middle;
        } else {
            over = middle;
        }
    }
    Ok(0.5 * (under + over))
}

/// Metacentric height GM (m) of a floating body as posed, for tilts about the horizontal `axis`.
///
///   GM = −dT/dφ / (m g),   T the torque about the centre of mass of the buoyancy of the re-floated body
///
/// Positive: it rights itself. For a wall-sided body GM = I/V + KB − KG, with I the second moment of the
/// waterplane. `axis`: axial components, `[1.0]` in 2-D, `[1.0, 0.0, 0.0]` for x in 3-D. The other
/// arguments as in [`equilibrium_height`]; the derivative is a central difference over ±1e-4 rad.
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
    let tilt = 1e-4;
    let righting = |angle: f64| -> Result<f64> {
        let mut tilted = *pose;
        tilted.rotation = (Bivector::from_axial(axis) * angle).exp() * pose.rotation;
        tilted.position[D - 1] += equilibrium_height(shape, &tilted, body.mass, rho0, level)?;
        let buoyancy = shape.submerged_volume(&tilted, level).1;
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
