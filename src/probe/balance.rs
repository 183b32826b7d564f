//! All loads on a free body in the last step, by what they come from, and how well they add up to what it did.

use super::{Probe, axes, find_solid};
use crate::{
    coupling::LoadBreakdown,
    error::{Error, Result},
    simulation::Simulation,
    solid::{Load, Role},
    system::System,
};

/// Watches the loads on a free body: force (N) and torque about its centre of mass (N m) of pressure, viscosity, weight, contacts
/// and ties, each kind that the scene has; their sum; the change of its momentum and angular momentum; and what is between
/// the two. Nothing but NaN unless loads are kept ([`Simulation::enable_load_breakdown`]).
pub struct LoadBalanceProbe {
    solid: usize,
    kinds: Vec<&'static str>,
}

impl LoadBalanceProbe {
    /// The probe of the free solid called `solid`.
    ///
    /// # Errors
    /// `Scene` if there is no such solid or if it is not free.
    pub fn new<const D: usize>(system: &System<D>, solid: &str) -> Result<Self> {
        let index = find_solid(system, solid)?;
        let Role::Free(body) = &system.solids()[index].spec.role else {
            return Err(Error::scene(format!("\"{solid}\" is not free: what it weighs and carries is not known"))
                .help("the water's load on any solid is  force = \"...\""));
        };
        let links = system.constraints();
        let held = links.holds.iter().any(|hold| hold.solid == index);
        let locked = body.locked_translations.iter().chain(&body.locked_rotations).any(|locked| *locked);
        let absent = [
            ("joints", links.joints.is_empty()),
            ("motors", links.joints.is_empty()),
            ("ropes", links.ropes.is_empty()),
            ("springs", links.springs.is_empty()),
            ("forces", links.forces.is_empty()),
            ("locks", !(held || locked)),
        ];
        let all = LoadBreakdown::<D>::zero().kinds().map(|(kind, _)| kind);
        let kinds = all.into_iter().filter(|kind| !absent.contains(&(kind, true))).collect();
        Ok(Self { solid: index, kinds })
    }
}

/// The numbers of a load: forces, then torques.
fn load_components<const D: usize>(load: &Load<D>) -> Vec<f64> {
    load.force.iter().copied().chain(load.torque.axial()).collect()
}

impl<const D: usize> Probe<D> for LoadBalanceProbe {
    fn columns(&self) -> Vec<String> {
        let own: Vec<String> = match D {
            2 => ["fx_N_per_m", "fy_N_per_m", "torque_Nm_per_m"].map(String::from).to_vec(),
            _ => {
                let forces = axes::<D>().iter().map(|a| format!("f{a}_N"));
                forces.chain(axes::<D>().iter().map(|a| format!("t{a}_Nm"))).collect()
            }
        };
        let groups = self.kinds.iter().copied().chain(["sum", "change", "residual"]);
        groups.flat_map(|group| own.iter().map(move |name| format!("{group}_{name}"))).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let Some(shares) = sim.load_breakdown(self.solid) else {
            return vec![f64::NAN; Probe::<D>::columns(self).len()];
        };
        let kinds = shares.kinds().into_iter().filter(|(kind, _)| self.kinds.contains(kind)).map(|(_, load)| load);
        kinds.chain([shares.sum(), shares.change, shares.residual()]).flat_map(|load| load_components(&load)).collect()
    }
}
