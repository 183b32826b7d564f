//! Kernels: unit integral, consistent derivative, compact support and stability of the initial lattice.

use std::f64::consts::PI;

use pontoon::{
    math::Vector,
    sph::{
        FluidProperties,
        kernel::{Cubic, Kernel, Wendland, lattice},
    },
};

const H: f64 = 0.037;

/// ∫ W dV by the midpoint rule in the radius, whose error on 2e5 points is below 1e-9 for these kernels.
fn weight(kernel: impl Kernel, dimension: usize) -> f64 {
    let n = 200_000;
    let step = 2.0 * H / n as f64;
    (0..n)
        .map(|i| {
            let r = (i as f64 + 0.5) * step;
            let shell = if dimension == 2 { 2.0 * PI * r } else { 4.0 * PI * r * r };
            kernel.w(r * r) * shell * step
        })
        .sum()
}

fn for_each_kernel(check: impl Fn(&str, usize, &dyn Fn(f64) -> f64, &dyn Fn(f64) -> f64)) {
    for dimension in [2, 3] {
        let (c, w) = (Cubic::new(H, dimension), Wendland::new(H, dimension));
        check("cubic", dimension, &|r2| c.w(r2), &|r2| c.slope(r2));
        check("wendland", dimension, &|r2| w.w(r2), &|r2| w.slope(r2));
    }
}

#[test]
fn the_integral_of_a_kernel_is_one() {
    for dimension in [2, 3] {
        assert!((weight(Cubic::new(H, dimension), dimension) - 1.0).abs() < 1e-6);
        assert!((weight(Wendland::new(H, dimension), dimension) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn the_normalised_kernel_has_the_exact_gradient_of_a_linear_field_on_a_lattice() {
    for h_over_dp in [1.3, 1.5, 1.7, 1.732, 3.0] {
        exact_on_the_lattice::<2>(H / h_over_dp);
        exact_on_the_lattice::<3>(H / h_over_dp);
    }
}

fn exact_on_the_lattice<const D: usize>(dp: f64) {
    let properties = properties::<D>(H, dp);
    let cubic = first_moment(Cubic::new(H, D).normalised_on_lattice(&properties), dp, D);
    let wendland = first_moment(Wendland::new(H, D).normalised_on_lattice(&properties), dp, D);
    // Rounding of up to some thousand terms; without normalisation the error is up to 3 %.
    assert!((cubic - 1.0).abs() < 1e-13 && (wendland - 1.0).abs() < 1e-13, "{dp}: {cubic}, {wendland}");
}

fn properties<const D: usize>(h: f64, dp: f64) -> FluidProperties<D> {
    FluidProperties { h, dp, rho0: 1000.0, c0: 20.0, gamma: 7.0, gravity: Vector::zeros() }
}

/// −Σ y ∂_y W over a lattice around the origin, with a kernel multiplied by the particle volume.
fn first_moment(kernel: impl Kernel, dp: f64, dimension: usize) -> f64 {
    let n = (2.0 * H / dp) as i32 + 1;
    let mut sum = 0.0;
    for i in -n..=n {
        for j in -n..=n {
            for k in if dimension == 2 { 0..=0 } else { -n..=n } {
                let [x, y, z] = [i, j, k].map(|c| f64::from(c) * dp);
                sum -= y * y * kernel.slope(x * x + y * y + z * z);
            }
        }
    }
    sum
}

#[test]
fn the_shear_stiffness_of_the_initial_lattice_agrees_with_independent_values() {
    // Least stiffness of a square lattice, computed independently with closed second derivatives and a finer grid of wave
    // numbers. The code under test samples wave numbers at steps of π/12, hence three decimals.
    let square = [("cubic", 1.2, 0.0), ("cubic", 1.5, -0.089), ("cubic", 1.7, -0.040), ("cubic", 1.0, -0.096)];
    for (name, h, exact) in square.into_iter().chain([("wendland", 1.2, -0.104), ("wendland", 1.7, -0.014)]) {
        let found = match name {
            "cubic" => lattice::lattice_stiffness(Cubic::new(h, 2), &properties::<2>(h, 1.0)),
            _ => lattice::lattice_stiffness(Wendland::new(h, 2), &properties::<2>(h, 1.0)),
        };
        assert!((found - exact).abs() < 2e-3, "{name} at h = {h} dp: {found}");
    }
    for (h, exact) in [(1.2, -0.131), (1.5, -0.004)] {
        let found = lattice::lattice_stiffness(Wendland::new(h, 3), &properties::<3>(h, 1.0));
        assert!((found - exact).abs() < 2e-3, "a cubic lattice at h = {h} dp: {found}");
    }
}

#[test]
fn the_kernel_slope_is_the_derivative_of_the_kernel() {
    for_each_kernel(|name, dimension, w, slope| {
        let largest = (1..200).map(|i| slope((i as f64 * 0.01 * H).powi(2)).abs()).fold(0.0, f64::max);
        for i in 1..200 {
            let (r, e) = (i as f64 * 0.01 * H, 1e-5 * H);
            let difference = (w((r + e).powi(2)) - w((r - e).powi(2))) / (2.0 * e) / r;
            // Central differences: e² W‴/6r and rounding ε W/(e r) are both below 1e-6 of the largest slope
            // for r above 0.01 h.
            assert!((slope(r * r) - difference).abs() < 2e-6 * largest, "{name} in {dimension}-D at q = {}", r / H);
        }
    });
}

#[test]
fn a_kernel_decreases_monotonically_to_zero_at_its_support_radius() {
    for_each_kernel(|name, dimension, w, slope| {
        for q in [2.0, 2.0001, 3.0, 100.0] {
            let r2 = (q * H).powi(2);
            // At q = 2 exactly, rounding of the square root may leave (1e-16)³.
            assert!(w(r2).abs() < 1e-30 * w(0.0) && slope(r2).abs() < 1e-30 * w(0.0) / (H * H), "{name} {dimension}");
        }
        for i in 0..200 {
            let q = i as f64 * 0.01;
            assert!(w((q * H).powi(2)) > w(((q + 0.01) * H).powi(2)), "{name} in {dimension}-D at q = {q}");
        }
        assert!(slope(1e-300).is_finite(), "{name}: two particles at one position");
    });
}
