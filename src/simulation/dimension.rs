//! The large functions of a simulation, which this library compiles for each dimension.
//!
//! A program that calls a generic function compiles this function and all functions that it calls anew, which takes a minute for
//! a simulation. The methods of a [`Simulation`] therefore call these functions by pointers. `inline(never)` keeps the table of
//! pointers out of other crates.

use super::{AddedSolid, Setup, Simulation, change_by_hand};
use crate::{
    coupling::Hook,
    error::Result,
    interaction::PairLoop,
    math::{Bivector, Vector},
    model::HasPairLoop,
    ranks::WaterShare,
    solid::{Dim, SolidSpec},
};

/// Dimensions for which this library is compiled.
pub trait Dimension<const D: usize>: HasPairLoop<D> {
    /// The compiled functions.
    #[doc(hidden)]
    fn compiled() -> &'static Compiled<D>;
}

#[cfg(feature = "dim2")]
impl Dimension<2> for Dim<2> {
    #[inline(never)]
    fn compiled() -> &'static Compiled<2> {
        &Compiled::<2>::ALL
    }
}

#[cfg(feature = "dim3")]
impl Dimension<3> for Dim<3> {
    #[inline(never)]
    fn compiled() -> &'static Compiled<3> {
        &Compiled::<3>::ALL
    }
}

/// A field: its value at a place, m.
pub(super) type Field<'a, const D: usize, T> = &'a (dyn Fn(&Vector<D>) -> T + Sync);

/// A pair loop of a program's own terms; `None` for that of the model.
pub(super) type OwnPairLoop<const D: usize> = Option<Box<dyn PairLoop<D>>>;

/// Functions of a [`Simulation`], by the names of the methods that call them.
#[doc(hidden)]
#[derive(Debug)]
pub struct Compiled<const D: usize> {
    pub(super) set_up: fn(Setup<D>, OwnPairLoop<D>, bool, WaterShare<'_>) -> Result<Simulation<D>>,
    pub(super) step_to: fn(&mut Simulation<D>, f64) -> Result<()>,
    pub(super) step_with: fn(&mut Simulation<D>, f64, &mut Hook<D>) -> Result<()>,
    pub(super) gather_water: fn(&mut Simulation<D>, bool),
    pub(super) update_rates: fn(&mut Simulation<D>),
    pub(super) set_velocity: fn(&mut Simulation<D>, usize, &Vector<D>, &Bivector<D>),
    pub(super) set_water_velocity: fn(&mut Simulation<D>, Field<D, Vector<D>>),
    pub(super) set_water_density: fn(&mut Simulation<D>, Field<D, f64>),
    pub(super) account: fn(&mut Simulation<D>, bool, Option<u32>),
    pub(super) add_solid: fn(&mut Simulation<D>, SolidSpec<D>) -> Result<AddedSolid>,
    pub(super) remove_solid: fn(&mut Simulation<D>, usize) -> Result<()>,
    pub(super) save: fn(&Simulation<D>) -> Result<Vec<u8>>,
    pub(super) restore: fn(&mut Simulation<D>, &[u8]) -> Result<()>,
    pub(super) restore_with_added_solids: fn(&mut Simulation<D>, &[u8], Vec<SolidSpec<D>>) -> Result<()>,
}

impl<const D: usize> Compiled<D>
where
    Dim<D>: Dimension<D>,
{
    const ALL: Self = Self {
        set_up: Simulation::with_bodies,
        step_to: Simulation::make_step_to,
        step_with: Simulation::make_step_with,
        gather_water: Simulation::complete_water,
        update_rates: Simulation::compute_rates,
        set_velocity: change_by_hand::set_velocity,
        set_water_velocity: change_by_hand::set_water_velocity,
        set_water_density: change_by_hand::set_water_density,
        account: Simulation::begin_accounting,
        add_solid: Simulation::put_in_solid,
        remove_solid: Simulation::take_out_solid,
        save: Simulation::state_bytes,
        restore: Simulation::restore_state,
        restore_with_added_solids: Simulation::restore_state_with_added_solids,
    };
}
