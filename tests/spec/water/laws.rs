//! Equations of SPH: pair terms are antisymmetric bit for bit, viscosity only dissipates, diffusion flattens density,
//! and the pair loop agrees with an independent loop over all pairs.

use pontoon::{
    math::Vector,
    model::{Diffusion, KernelKind, Model, PairLoopKind, Viscosity},
    sph::{
        AuxiliarySums, FluidProperties, Pair, PairSide, Term, Units,
        boundary::{Repulsion, SupportCoverage, WallExtrapolation, no_slip_velocity, relaxation},
        continuity::Continuity,
        density_diffusion::{Fourtakas, Molteni},
        gradient_correction::{CorrectedGradientTerm, RenormalizationTerm},
        kernel::{Kernel as _, Wendland},
        particle_shifting::{Shift, ShiftTerm, ShiftingSuppressionTerm},
        pressure::{Pressure, Tensile},
        viscosity::{Artificial, Laminar, Sps, SpsTerm},
    },
};

use crate::common::{self, Random};

fn properties() -> FluidProperties<3> {
    FluidProperties {
        h: 0.017,
        dp: 0.01,
        rho0: 1000.0,
        c0: 20.0,
        gamma: 7.0,
        gravity: Vector::from([0.3, -1.0, -9.81]),
    }
}

/// A random pair closer than the support radius, and the same pair with a and b swapped.
fn pair(random: &mut Random) -> [Pair<f64, 3>; 2] {
    let mut side = || {
        let x = 0.02 * (random.number() - 0.5);
        let mut tensor = || {
            let [xx, yy, zz, xy, xz, yz]: [f64; 6] = std::array::from_fn(|_| random.number() - 0.5);
            [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        };
        let (stress, form) = (tensor(), tensor());
        PairSide {
            compression: x,
            p: 400.0 * x,
            specific_volume: 1.0 / (1.0 + x),
            repulsion: 4.0 * x.abs(),
            shifting_suppressed: 1.0,
            stress,
            gradient_correction: form,
        }
    };
    let (a, b) = (side(), side());
    let r: [f64; 3] = std::array::from_fn(|_| 0.02 * (random.number() - 0.5));
    let v: [f64; 3] = std::array::from_fn(|_| random.number() - 0.5);
    let r2 = r.iter().map(|x| x * x).sum();
    let kernel = Wendland::new(0.017, 3);
    let make = |r, v, a: PairSide<f64, 3>, b: PairSide<f64, 3>| {
        Pair::new((r, v, r2, b.compression - a.compression), kernel.w(r2), properties().eta2(), a, b)
    };
    [make(r, v, a, b), make(r.map(|x: f64| -x), v.map(|x: f64| -x), b, a)]
}

fn assert_antisymmetric(name: &str, term: impl Term<3>) {
    let mut random = Random(7);
    for _ in 0..200 {
        let [ab, ba] = pair(&mut random);
        assert_eq!(term.along_r(&ab, 0.0), term.along_r(&ba, 0.0), "{name}: along r");
        assert_eq!(term.along_v(&ab, 0.0), term.along_v(&ba, 0.0), "{name}: along v");
        assert_eq!(term.vector(&ab, [0.0; 3]), term.vector(&ba, [0.0; 3]).map(|x| -x), "{name}: vector");
        let (there, back) = (term.rate(&ab, (0.0, 0.0)), term.rate(&ba, (0.0, 0.0)));
        assert_eq!((there.0, there.1), (back.1, back.0), "{name}: rates");
        let (mut a, mut b, mut c, mut d) = (
            AuxiliarySums::filled_with(0.0),
            AuxiliarySums::filled_with(0.0),
            AuxiliarySums::filled_with(0.0),
            AuxiliarySums::filled_with(0.0),
        );
        term.auxiliary(&ab, -2.0, &mut a, &mut b);
        term.auxiliary(&ba, -2.0, &mut c, &mut d);
        assert_eq!((a, b), (d, c), "{name}: auxiliary sums");
    }
}

#[test]
fn swapping_the_particles_of_a_pair_changes_the_sign_of_each_term_and_no_other_bit() {
    let m = properties();
    assert_antisymmetric("pressure", Pressure);
    assert_antisymmetric("tensile", Tensile { inv_w_dp: 1e-6 });
    assert_antisymmetric("continuity", Continuity);
    assert_antisymmetric("artificial", Artificial::default().term(&m));
    assert_antisymmetric("laminar", Laminar::default().term(&Units::SI, 1.0));
    assert_antisymmetric("sps", SpsTerm);
    assert_antisymmetric("molteni", Molteni::default().term(&m));
    assert_antisymmetric("fourtakas", Fourtakas::default().term(&m));
    assert_antisymmetric("shifting", ShiftTerm);
    assert_antisymmetric("shifting suppression", ShiftingSuppressionTerm);
    assert_antisymmetric("corrected gradient", CorrectedGradientTerm);
    assert_antisymmetric("renormalization", RenormalizationTerm);
}

#[test]
fn viscosity_never_adds_energy_to_a_pair() {
    let (artificial, laminar) =
        (Artificial { alpha: 0.3 }.term(&properties()), Laminar { nu0: 0.1 }.term(&Units::SI, 1.0));
    let mut random = Random(3);
    for _ in 0..1000 {
        let [ab, _] = pair(&mut random);
        let v2: f64 = ab.v_ab.iter().map(|x| x * x).sum();
        // The power of a pair is ∂W (along_r v·r + along_v v²) and ∂W < 0.
        assert!(artificial.along_r(&ab, 0.0) * ab.velocity_along_r >= 0.0);
        assert!(laminar.along_v(&ab, 0.0) * v2 >= 0.0);
    }
}

#[test]
fn sps_stress_opposes_shear_with_the_magnitude_of_smagorinsky() {
    // Simple shear S_xy = ½ γ̇: τ_xy has its sign and its size is ρ (C_s Δ)² γ̇².
    let (m, rate) = (properties(), 3.0);
    let mut strain = [[0.0; 3]; 3];
    (strain[0][1], strain[1][0]) = (0.5 * rate, 0.5 * rate);
    let stress = Sps::default().stress(&strain, 1.0, &m);
    let expected = 0.12f64.powi(2) * m.dp * m.dp / 3.0 * rate * rate;
    assert!((stress[0][1] / expected - 1.0).abs() < 1e-12);
    assert!(stress[0][0] < 0.0, "the isotropic part is a pressure");
}

#[test]
fn fourtakas_diffusion_vanishes_in_hydrostatic_water() {
    // x of a column at rest: dx = (1 + x)^(2 − γ) g dz/c₀², integrated: (1 + x)^(γ−1) = 1 + (γ−1) g z/c₀².
    let m = properties();
    let term = Fourtakas::default().term(&m);
    let plain = Molteni::default().term(&m);
    let still = |r: Vector<3>| (6.0f64 / 400.0 * m.gravity.dot(&r)).ln_1p() / 6.0;
    let none = [[0.0; 3]; 3];
    let side = |x: f64| {
        let s = 1.0 / (1.0 + x);
        PairSide {
            compression: x,
            p: 0.0,
            specific_volume: s,
            repulsion: 0.0,
            shifting_suppressed: 1.0,
            stress: none,
            gradient_correction: none,
        }
    };
    let mut random = Random(11);
    for _ in 0..100 {
        // Ten metres down (in the units of this c₀: x up to 1 %), at any angle to g.
        let place = Vector::from([0.0, 0.0, -0.4]) + random.point::<3>() * 0.1;
        let d = (random.point::<3>() - Vector::repeat(0.5)) * 0.02;
        let (a, b) = (side(still(place).exp_m1()), side(still(place - d).exp_m1()));
        let ab = Pair::new((d.into(), [0.0; 3], d.norm_squared(), b.compression - a.compression), 0.0, m.eta2(), a, b);
        // The term omits second order in x̄, (γ−2)(γ−1)/2·x̄² ≈ 15·1e-4 of the hydrostatic difference. With ρ₀ in
        // place of ρ̄, as the term is usually written, the remainder is 5 %.
        let rest = term.rate(&ab, (0.0, 0.0)).0.abs();
        assert!(rest <= 2e-3 * plain.rate(&ab, (0.0, 0.0)).0.abs() + 1e-18, "{rest}");
    }
}

#[test]
fn shifting_vanishes_at_the_free_surface_and_is_limited_to_a_tenth_of_dp() {
    let m = properties();
    let sums = |div_r| AuxiliarySums {
        concentration_gradient: [1e6, -1e6, 0.0],
        position_divergence: div_r,
        ..AuxiliarySums::filled_with(0.0)
    };
    let shift = Shift::default();
    assert_eq!(shift.displacement(&sums(2.7), 1.0, 1e-4, &m), [0.0; 3]);
    let inside = shift.displacement(&sums(3.0), 1.0, 1e-4, &m);
    assert_eq!(inside, [-0.001, 0.001, 0.0]);
}

/// Compares accelerations and density rates of the pair loop with a loop over all pairs that uses the formulas of the
/// papers, with densities, pressures and masses.
#[test]
fn the_reference_pair_loop_agrees_with_a_loop_over_all_pairs() {
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.3);
    model.viscosity = Viscosity::Artificial(Artificial { alpha: 0.1 });
    model.diffusion = Diffusion::Molteni(Molteni::default());
    model.kernel = KernelKind::Wendland;
    model.pair_loop = PairLoopKind::Reference;
    let mut random = Random(5);
    let water: Vec<Vector<2>> = common::lattice([0.0, 0.0], [0.4, 0.3], dp)
        .into_iter()
        .map(|r| r + (random.point::<2>() - Vector::repeat(0.5)) * 0.4 * dp)
        .collect();
    let (h, c0, rho0) = (model.h, model.c0, model.rho0);
    let mut sim = common::simulation(model, water, 0.3, vec![]);
    sim.set_water_velocity(|r| Vector::from([(20.0 * r[1]).sin(), (30.0 * r[0]).cos()]));
    sim.update_rates();

    let (fluid, mass) = (sim.system().fluid(), rho0 * dp * dp);
    let slope = |q: f64| 7.0 / (4.0 * std::f64::consts::PI * h * h) / (h * h) * -5.0 * (1.0 - q / 2.0).powi(3);
    // The kernel is normalised so that the gradient of x is 1 on the lattice.
    let row = |j: i32| (-4..=4).map(move |i| (f64::from(i) * dp, f64::from(j) * dp));
    let on_lattice: f64 = (-4..=4)
        .flat_map(row)
        .map(|(x, y)| (x, x.hypot(y) / h))
        .filter(|(_, q)| *q < 2.0)
        .map(|(x, q)| -x * x * slope(q) * dp * dp)
        .sum();
    let pressure = |rho: f64| c0 * c0 * rho0 / 7.0 * ((rho / rho0).powi(7) - 1.0);
    let mut scale: (f64, f64) = (0.0, 0.0);
    let mut worst: (f64, f64) = (0.0, 0.0);
    for a in 0..fluid.len() {
        let (mut dv, mut drho) = (Vector::from([0.0, -9.81]), 0.0);
        for b in (0..fluid.len()).filter(|&b| b != a) {
            let (r, v) = (fluid.r[a] - fluid.r[b], fluid.v[a] - fluid.v[b]);
            let q = r.norm() / h;
            if q >= 2.0 {
                continue;
            }
            let grad_w = r * (slope(q) / on_lattice);
            let (rho_a, rho_b) = (fluid.rho[a], fluid.rho[b]);
            let mu = h * v.dot(&r) / (r.norm_squared() + 0.01 * h * h);
            let pi = if mu < 0.0 { -0.1 * c0 * mu / (0.5 * (rho_a + rho_b)) } else { 0.0 };
            dv -= grad_w * mass * ((pressure(rho_a) + pressure(rho_b)) / (rho_a * rho_b) + pi);
            drho += rho_a * mass / rho_b * v.dot(&grad_w);
            let d = 2.0 * 0.1 * h * c0 * (rho_b - rho_a) * (-r).dot(&grad_w) / r.norm_squared();
            drho += d * mass / rho_b;
        }
        scale = (scale.0.max(dv.norm()), scale.1.max(drho.abs()));
        worst.0 = worst.0.max((dv - sim.system().fluid_acceleration(a)).norm());
        worst.1 = worst.1.max((drho - sim.system().fluid_density_rate(a)).abs());
    }
    // About 30 terms of mixed sign are added, and (ρ/ρ₀)⁷ − 1 loses digits by cancellation: 1e-11 of the largest value.
    assert!(worst.0 < 1e-11 * scale.0 && worst.1 < 1e-11 * scale.1, "{worst:?} of {scale:?}");
}

#[test]
fn density_diffusion_lowers_a_density_peak_and_conserves_the_sum() {
    for diffusion in
        [Diffusion::Molteni(Molteni::default()), Diffusion::Fourtakas(Fourtakas::default()), Diffusion::None]
    {
        let dp = 0.02;
        let mut model = Model::water(2, dp, 0.3);
        model.pair_loop = PairLoopKind::Reference;
        (model.diffusion, model.gravity) = (diffusion, vec![0.0, 0.0]);
        let mut sim = common::simulation(model, common::lattice([0.0, 0.0], [0.6, 0.6], dp), 0.0, vec![]);
        let bump = |r: &Vector<2>| 1000.0 + 0.5 * (-(r - Vector::from([0.3, 0.3])).norm_squared() / 0.002).exp();
        sim.set_water_density(bump);
        sim.update_rates();
        let fluid = sim.system().fluid();
        let top = (0..fluid.len()).max_by(|&a, &b| fluid.rho[a].total_cmp(&fluid.rho[b])).unwrap();
        let sum: f64 = (0..fluid.len()).map(|i| sim.system().fluid_density_rate(i)).sum();
        let size: f64 = (0..fluid.len()).map(|i| sim.system().fluid_density_rate(i).abs()).sum();
        if diffusion == Diffusion::None {
            assert_eq!(size, 0.0, "water at rest without diffusion has no density rate");
        } else {
            assert!(sim.system().fluid_density_rate(top) < 0.0, "the density at the peak decreases");
            // V_a V_b is symmetric and the rate is per ρ, so the rates of a pair cancel to within Δρ/ρ = 5e-4.
            assert!(sum.abs() < 1e-3 * size, "diffusion conserves density: sum {sum}, sum of sizes {size}");
        }
    }
}

/// Extrapolation sums of a boundary particle at the origin over fluid at random positions with pressure `p` (P/ρ₀).
fn fit(p: impl Fn(&Vector<3>) -> f64) -> WallExtrapolation<f64, 3> {
    let (mut random, mut fit) = (Random(5), WallExtrapolation::filled_with(0.0));
    for _ in 0..40 {
        let r = (random.point::<3>() - Vector::repeat(0.5)) * 0.02;
        fit.add(random.number(), p(&r), 1.0, (-r).into());
    }
    fit
}

#[test]
fn a_linear_pressure_is_extrapolated_to_the_wall_exactly() {
    let pull = Vector::from([1.0, -2.0, -9.81]);
    // ∇P = ρ₀ (g − a): linear.
    let p = fit(|r| 7.0 + pull.dot(r)).pressure(&pull.into(), &pull.into(), 0.01);
    assert!((p - 7.0).abs() < 1e-12, "{p}");
    assert_eq!(
        WallExtrapolation::<f64, 3>::filled_with(0.0).pressure(&pull.into(), &pull.into(), 0.01),
        0.0,
        "without fluid neighbours the pressure is zero"
    );
}

#[test]
fn the_extrapolated_pressure_at_a_wall_face_is_never_negative() {
    let (g, deep) = (Vector::from([0.0, 0.0, -9.81]), 0.004);
    let at = |below: f64, p: f64| {
        let mut fit = WallExtrapolation::filled_with(0.0);
        fit.add(0.3, p, 1.0, [0.0, 0.0, below]);
        fit.pressure(&g.into(), &g.into(), deep)
    };
    // Fluid at zero pressure 6 mm below the particle: the face, 4 mm below it, would have negative pressure, so it has zero.
    assert!((at(0.006, 0.0) + 9.81 * deep).abs() < 1e-15);
    // With 0.03 m²/s² in the fluid the face has 0.03 − g · 2 mm, which is positive.
    assert!((at(0.006, 0.03) - (0.03 - 9.81 * 0.006)).abs() < 1e-15);
    // The limit depends on gravity and not on the acceleration of the body.
    let mut fit = WallExtrapolation::filled_with(0.0);
    fit.add(0.3, 0.0, 1.0, [0.0, 0.0, 0.006]);
    assert!((fit.pressure(&(g * 1e6).into(), &g.into(), deep) + 9.81 * deep).abs() < 1e-15);
    // Below the fluid, at a bed, the pressure of the boundary particle itself is at least zero.
    assert_eq!(at(-0.006, -1.0), 0.0);
}

#[test]
fn the_coverage_fraction_is_one_beside_bulk_water_small_beside_a_film_and_zero_beside_spray() {
    let (dp, h) = (0.01, 0.017);
    let kernel = Wendland::new(h, 2);
    let coverage = SupportCoverage::new(|r2: f64| kernel.w(r2) * dp * dp, dp, 2.0 * h, 2);
    for depth in [0.5 * dp, 1.5 * dp] {
        let rows = |n: i32| -> f64 {
            let row = |j: i32| depth + (f64::from(j) + 0.5) * dp;
            (0..n)
                .flat_map(|j| (-4..=4).map(move |i| (i, j)))
                .fold(0.0, |sum, (i, j)| sum + kernel.w((f64::from(i) * dp).powi(2) + row(j).powi(2)) * dp * dp)
        };
        // The table of coverage interpolates linearly between 64 depths.
        assert!((coverage.cover(rows(4), depth).fraction() - 1.0).abs() < 1e-3, "a half space of fluid");
        if depth < dp {
            // The first row of fluid is 0.86 of the kernel sum of the first layer of boundary particles.
            let film = coverage.cover(rows(1), depth).fraction();
            assert!((0.15..0.3).contains(&film), "a film of one row: {film}");
        }
        assert_eq!(
            coverage.cover(kernel.w((depth + 0.5 * dp).powi(2)) * dp * dp, depth).fraction(),
            0.0,
            "a particle of spray"
        );
    }
}

#[test]
fn repulsion_acts_only_on_particles_closer_than_three_quarters_of_dp() {
    let (properties, mut random) = (properties(), Random(7));
    let repulsion = Repulsion::new(Wendland::new(properties.h, 3), &properties);
    for _ in 0..200 {
        let [ab, _] = pair(&mut random);
        let near = ab.r2.sqrt() < 0.75 * properties.dp;
        let push = repulsion.along_r(&ab, 0.0);
        // A negative factor of ∂W, which is negative, separates the pair.
        assert!(if near { push < 0.0 } else { push == 0.0 }, "{push} at {} dp", ab.r2.sqrt() / properties.dp);
    }
}

#[test]
fn no_slip_extrapolates_a_linear_shear_behind_the_face_exactly() {
    let mut random = Random(5);
    // The wall moves; its face is 0.004 m above the boundary particle at the origin. The fluid shears and approaches the wall.
    let (wall, depth, normal) = (Vector::from([0.3, 0.1, 0.2]), 0.004, Vector::<3>::z());
    let moves = |r: &Vector<3>| wall + Vector::from([5.0, -3.0, 2.0]) * (r[2] - depth);
    let mut fit = WallExtrapolation::filled_with(0.0);
    for _ in 0..40 {
        let r = (random.point::<3>() - Vector::from([0.5, 0.5, -0.4])).component_mul(&Vector::from([0.02, 0.02, 0.01]));
        let w = random.number();
        fit.add(w, 0.0, 1.0, (-r).into());
        fit.add_velocity(w, 1.0, moves(&r).into());
    }
    let continued = wall + Vector::from([5.0, -3.0, 0.0]) * -depth;
    let extrapolated = no_slip_velocity(&fit, wall, &normal, depth);
    assert!((extrapolated - continued).norm() < 1e-14, "{extrapolated}");
    assert_eq!(
        no_slip_velocity(&WallExtrapolation::<f64, 3>::filled_with(0.0), wall, &normal, depth),
        wall,
        "without fluid neighbours the velocity is that of the wall"
    );
}

#[test]
fn the_relaxation_of_a_wall_does_not_depend_on_the_step_size() {
    let many = (0..10).fold(1.0, |left, _| left * (1.0 - relaxation(1e-4, 0.02, 20.0)));
    assert!((many - (1.0 - relaxation(1e-3, 0.02, 20.0))).abs() < 1e-15);
    // After ten h/c₀ the remaining difference is 1/e.
    assert!((relaxation(0.01, 0.02, 20.0) - (1.0 - (-1.0f64).exp())).abs() < 1e-15);
}
