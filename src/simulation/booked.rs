//! The books of a running simulation: loads by kind, and where energy goes. Nobody who does not ask for them pays.

use super::Simulation;
use crate::{
    law::wall::Slip,
    model::{Dimension, Viscosity},
    solid::Dim,
    time::{Books, Ledger, Shares},
};

/// Steps from one telling apart of the water's laws to the next, where only energy is asked for: one pass in sixteen more.
const TOLD_EVERY: u32 = 8;

impl<const D: usize> Simulation<D> {
    /// Keeps books of the loads on free bodies by their kind from now on: [`Simulation::shares`]. Where water sticks to solids
    /// every step takes another force pass, which tells the viscous load; else they cost nothing.
    pub fn keep_loads(&mut self)
    where
        Dim<D>: Dimension<D>,
    {
        let model = self.system.model();
        let drags = model.viscosity != Viscosity::None && model.slip != Slip::Free;
        let (energy, now) = self.kept();
        self.keep(energy, if drags { Some(1) } else { now });
    }

    /// Keeps books of energy from now on: [`Simulation::ledger`]. Every eighth step takes another force pass.
    pub fn keep_energy(&mut self)
    where
        Dim<D>: Dimension<D>,
    {
        let (_, now) = self.kept();
        self.keep(true, Some(now.unwrap_or(TOLD_EVERY)));
    }

    /// Whether energy is booked already, and how often laws are told apart.
    fn kept(&self) -> (bool, Option<u32>) {
        self.bodies.books.as_ref().map_or((false, None), |books| (books.energy, books.every))
    }

    fn keep(&mut self, energy: bool, every: Option<u32>)
    where
        Dim<D>: Dimension<D>,
    {
        if every.is_some() {
            self.system.meter();
        }
        self.bodies.books = Some(Books::new(self.system.solids().len(), energy, every));
    }

    /// The loads on free solid number `solid` in the last step by their kind, if books are kept.
    pub fn shares(&self, solid: usize) -> Option<&Shares<D>> {
        self.bodies.books.as_ref().map(|books| &books.shares[solid])
    }

    /// Where energy went since books are kept, if they are.
    pub fn ledger(&self) -> Option<&Ledger> {
        self.bodies.books.as_ref().filter(|books| books.energy).map(|books| &books.ledger)
    }
}
