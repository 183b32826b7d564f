//! Energy budgets and load breakdowns of water on a device.

use pontoon::{
    coupling::EnergyBudget,
    model::{Model, PairLoopKind, Shifting, Slip, TimeScheme, Viscosity},
    probe::{EnergyBudgetProbe, Probe as _},
    simulation::{Dimension, Setup, Simulation, TowedFrame},
    solid::{Dim, SolidSpec},
    sph::{particle_shifting::Shift, viscosity::Laminar},
    system::SpongeLayer,
};

use super::{
    Shape, dam, dam_with, device,
    forces::{law, shaken},
    run, under,
};

fn entries<const D: usize>(sim: &Simulation<D>) -> Vec<(&'static str, f64)> {
    sim.energy_budget().map(EnergyBudget::entries).unwrap().to_vec()
}

/// Asserts that after `steps` steps from `start` (s) each entry of the budget on the device is that of the reference within `bound`, as
/// a part of the largest entry, that the entries `acting` are larger than the bound, and that a repetition has the same bits.
pub fn assert_budgets_agree<const D: usize>(
    name: &str,
    setup: &Setup<D>,
    (start, steps): (f64, usize),
    bound: f64,
    acting: &[&str],
) where
    Dim<D>: Dimension<D>,
{
    let state = run(setup, start);
    let mut reference = under(setup, PairLoopKind::Reference, &state);
    let on_device = || {
        let mut sim = under(setup, PairLoopKind::Fast, &state);
        sim.enable_energy_budget();
        sim.on_device(&device()).expect("a device")
    };
    reference.enable_energy_budget();
    let probe = EnergyBudgetProbe::new(reference.system());
    let [mut first, mut again] = [on_device(), on_device()];
    for _ in 0..steps {
        [&mut reference, &mut first, &mut again].into_iter().for_each(|sim| sim.step().expect("a sound run"));
    }
    let [here, there] = [entries(&first), entries(&reference)];
    let most = there.iter().map(|(_, energy)| energy.abs()).fold(0.0, f64::max);
    for ((entry, here), (_, there)) in here.iter().zip(&there) {
        if *there != 0.0 {
            println!(
                "{name}: {entry} {here:.6e} {there:.6e} J, apart by {:.1e} of the largest",
                (here - there).abs() / most
            );
        }
        assert!((here - there).abs() < bound * most, "{name}: {entry} {here} and {there} J, of {most} J");
    }
    for entry in acting {
        let energy = there.iter().find(|(name, _)| name == entry).map_or(0.0, |(_, energy)| energy.abs());
        assert!(energy > 3.0 * bound * most, "{name}: {entry} of {energy} J tells nothing");
    }
    assert_eq!(entries(&first), entries(&again), "{name}: other bits");
    // The difference between the change of the energy of water and bodies and the sum of the entries comes last.
    let [off, off_there] = [&first, &reference].map(|sim| *probe.sample(sim).last().unwrap());
    println!("{name}: residual {off:.2e}, of the reference {off_there:.2e} J");
    assert!((off - off_there).abs() < bound * most, "{name}: residuals of {off} and {off_there} J, of {most} J");
}

fn water() -> Model {
    Model::water(2, 0.02, 0.3)
}

fn laminar(model: Model) -> Model {
    model.viscosity(Viscosity::Laminar(Laminar { nu0: 1e-3 })).slip(Slip::Partial)
}

fn floating(model: Model) -> Setup<2> {
    let hull = Shape::Box { size: [0.2, 0.2].into() };
    dam_with(model.for_free_bodies(), [0.8, 0.3], [SolidSpec::free("box", hull, 500.0).at([0.14, 0.32])])
}

#[test]
fn energy_budgets_agree_with_the_reference() {
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    let layer = SpongeLayer { from: [0.1, 0.0].into(), to: [0.6, 0.0].into(), strength: 5.0, power: 2.0 };
    let with_layer = |mut setup: Setup<2>| {
        setup.sponge_layers.push(layer);
        setup
    };
    let shifting = Shifting::Everywhere(Shift::default());
    let agree = |name, setup: Setup<2>, acting: &[&str]| {
        // The terms differ by the rounding of single precision, and the positions by that of the steps. A sponge layer leaves
        // exp(−x) of a velocity, x = 5e-4 in a step, which is rounded by 6e-8 and by a few times that in the driver.
        let bound = if setup.sponge_layers.is_empty() { 1e-4 } else { 1e-3 };
        assert_budgets_agree(name, &setup, (0.05, 100), bound, acting);
    };
    agree("laminar", dam(laminar(water()), [0.8, 0.3]), &["viscous", "diffusion", "walls"]);
    agree("floating", floating(laminar(water())), &["viscous", "walls"]);
    agree("Verlet", with_layer(dam(water().scheme(verlet).cfl(0.2), [0.8, 0.3])), &["damping"]);
    agree("shifting", with_layer(dam(water().shifting(shifting), [0.8, 0.3])), &["shifting", "damping"]);
    agree("shaken", shaken(floating(water())), &["driven", "walls"]);
    // The frame's acceleration works on water and body.
    let towed = |setup: Setup<2>| setup.towed(TowedFrame::new(0, law("2*t^2")));
    agree("towed", towed(dam(water(), [0.8, 0.3])), &["driven", "walls"]);
    agree("towed, floating", towed(floating(water())), &["driven", "walls"]);
}

#[test]
fn viscous_loads_on_a_body_agree_with_the_reference() {
    let setup = floating(laminar(water()));
    let state = run(&setup, 0.05);
    let mut reference = under(&setup, PairLoopKind::Reference, &state);
    reference.enable_load_breakdown();
    // The breakdown begins on the device, after some steps.
    let mut on_device = under(&setup, PairLoopKind::Fast, &state).on_device(&device()).expect("a device");
    for step in 0..60 {
        if step == 20 {
            on_device.enable_load_breakdown();
        }
        [&mut reference, &mut on_device].into_iter().for_each(|sim| sim.step().expect("a sound run"));
    }
    let [here, there] = [&on_device, &reference].map(|sim| *sim.load_breakdown(1).expect("a breakdown"));
    let size = there.weight.force.norm();
    println!(
        "viscous {:?} and {:?}, pressure {:?} and {:?} N/m",
        here.viscous, there.viscous, here.pressure, there.pressure
    );
    assert!(there.viscous.force.norm() > 1e-3 * size, "{:?}", there.viscous);
    for (name, here, there) in [("viscous", here.viscous, there.viscous), ("pressure", here.pressure, there.pressure)] {
        // The bound of the loads on a driven solid, as a part of the weight.
        assert!((here.force - there.force).norm() < 1e-3 * size, "{name}: {here:?} and {there:?}");
    }
}
