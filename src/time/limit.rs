//! How long a step may be:  Δt = CFL·min( √(h/|f|), h/(c₀ + h max|v_ab·r_ab|/(r² + η²)) ),  and with a viscosity ν₀
//! Δt ≤ h²/(8 ν₀).
//!
//! f is the whole acceleration, gravity too; √(h/|f|) is what eq. (14) of the paper means by h/√|f|. Free bodies do not
//! shorten it: see `time/light.rs`.

use crate::{
    law::Medium,
    model::{Model, Viscosity},
    shape::Shape,
    solid::FreeBody,
    space::{Vector, Wedge},
    system::Peaks,
};

/// The longest step (s) that the water allows; eq. (14) of [@pirkhalili2023], [@monaghan1992].
pub fn water<const D: usize>(peaks: &Peaks, medium: &Medium<D>, cfl: f64) -> f64 {
    let by_force = (medium.h / peaks.acceleration).sqrt();
    let by_sound = medium.h / (medium.c0 + medium.h * peaks.closing);
    cfl * by_force.min(by_sound)
}

/// The longest step (s) that the model's viscosity allows; [@morris1997].
pub fn viscous(model: &Model) -> f64 {
    let nu0 = match model.viscosity {
        Viscosity::Laminar(v) => v.nu0,
        Viscosity::Sps(v) => v.nu0,
        Viscosity::None | Viscosity::Artificial(_) => 0.0,
    };
    model.h * model.h / (8.0 * nu0)
}

/// ω_b (1/s), the highest frequency of a body on the compressibility of water all around: the larger of the largest
/// translational and the largest rotational one. Every boundary particle of the outer layer is a spring of stiffness
/// ρ₀ c₀² dpᴰ⁻² (a column of water dp long on a face dpᴰ⁻¹), acting along the normal.
pub fn stiffest<const D: usize>(shape: &Shape<D>, body: &FreeBody<D>, medium: &Medium<D>) -> f64 {
    let spring = medium.rho0 * medium.c0 * medium.c0 * medium.dp.powi(D as i32 - 2);
    let (mut along, mut about) = (Vector::<D>::zeros(), [0.0; 3]);
    for point in shape.skin(medium.dp, 1) {
        let normal = shape.outward(&point.r, 0.05 * medium.dp);
        along += normal.component_mul(&normal) * spring;
        for (sum, arm) in about.iter_mut().zip(Wedge::torque(&(point.r - body.centre), &normal).axial()) {
            *sum += arm * arm * spring;
        }
    }
    let inertia = |i: usize| if D == 2 { body.inertia[(0, 0)] } else { body.inertia[(i, i)] };
    let turning = (0..Wedge::<D>::COMPONENTS).map(|i| about[i] / inertia(i));
    turning.fold(along.max() / body.mass, f64::max).sqrt()
}
