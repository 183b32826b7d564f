//! Bodies that start in deep water under the default laws.

use pontoon::{bench, error::Result};

use crate::common::{self, run_to};

fn scene(depth: f64, density: f64, extra: &str) -> String {
    format!(
        "dimension = 2\ndp = 0.025\nuntil = 0.3\n{extra}\nwater = [{{ fill = {{ box = {{ min = [0, 0], max = [2, {depth}] }} }} }}]\n\
         [[solid]]\nname = \"shaft\"\nfixed = true\nshape = {{ tank = {{ size = [2, {}] }} }}\n\
         [[solid]]\nname = \"disc\"\nshape = {{ ball = {{ radius = 0.125 }} }}\nfree = {{ density = {density} }}\nat = {{ x = 1, y = {} }}",
        depth + 0.5,
        depth - 2.0
    )
}

#[test]
fn a_disc_in_deep_water_starts_with_the_acceleration_of_potential_flow() -> Result<()> {
    for density in [900.0, 1100.0] {
        let mut sim = common::scene_simulation::<2>(&scene(3.0, density, ""))?;
        let start = sim.system().solids()[1].kinematics.pose.position[1];
        run_to(&mut sim, 0.3)?;
        let rise = sim.system().solids()[1].kinematics.pose.position[1] - start;
        let found = 2.0 * rise / (sim.time() * sim.time());
        // Images of the dipole in the walls, 2 m apart: C_a = 2/(1 − π²/3 (0.125/2)²) − 1 (Lamb 1932, §64).
        let added = 2.0 / (1.0 - (std::f64::consts::PI * 0.0625).powi(2) / 3.0) - 1.0;
        let exact = (1.0 - density / 1000.0) * 9.81 / (density / 1000.0 + added);
        // The disc has ten rows; the bound is that of the promise for 0.3 s.
        assert!((found / exact - 1.0).abs() < 0.05, "density {density}: {found} m/s², exact {exact} m/s²");
    }
    Ok(())
}

#[test]
fn the_default_viscosity_does_not_grow_with_the_depth() -> Result<()> {
    let nu = |depth: f64, extra: &str| -> Result<f64> {
        let sim = common::scene_simulation::<2>(&scene(depth, 900.0, extra))?;
        let model = sim.system().model();
        Ok(model.viscosity.effective(model.c0, model.h, 9.81, 2, 1.0))
    };
    let three = nu(3.0, "")?;
    for depth in [6.0, 12.0] {
        // Both go with √depth, up to round-off.
        assert!((nu(depth, "")? / three - 1.0).abs() < 1e-12);
    }
    // A value of the scene is taken as it is: α c₀ h/16.
    let given = nu(3.0, "model.viscosity.artificial.alpha = 0.1\nmodel.h_over_dp = 1.7")?;
    assert!((given / (0.1 * 10.0 * (9.81_f64 * 3.0).sqrt() * 1.7 * 0.025 / 16.0) - 1.0).abs() < 1e-12);
    Ok(())
}

#[test]
fn bench_states_the_effective_viscosity_of_the_shipped_default() -> Result<()> {
    // η × 0.0295 h² (2-D) or 0.0243 h² (3-D) at a shear of 1/s, with η = 3 and h = 1.7 dp in 2-D and 1.5 dp in 3-D.
    for (dimension, h_over_dp, dp, constant) in [(2, 1.7, 1.0 / 323.0, 0.0295), (3, 1.5, 1.0 / 47.0, 0.0243)] {
        let found = bench::default_viscosity(dimension, 50_000)?;
        let exact = 3.0 * constant * f64::powi(h_over_dp * dp, 2);
        assert!((found.viscosity_m2ps / exact - 1.0).abs() < 1e-9, "{found:?}, exactly {exact} m²/s");
    }
    Ok(())
}
