//! By what density and velocity the boundary particles show themselves, and beside which of them water is not shifted.

use std::ops::Range;

use rayon::prelude::*;

use super::System;
use crate::{
    law::{
        Medium,
        wall::{Dbc, Fit, Slip, settled, sticking},
    },
    model::{Model, Shifting, Walls},
    particles::PER_TASK,
    solid::{Role, Solid},
    space::Vector,
    sweep::Input,
};

impl<const D: usize> System<D> {
    /// Gives each boundary particle of `whose` beside water the density of still water at its depth.
    pub(super) fn still_skin(&mut self, whose: Range<usize>) {
        let still: Vec<f64> = self
            .near
            .wet()
            .par_iter()
            .map(|&i| {
                let x = &self.skin.r[i as usize];
                let mut nearest = (f64::INFINITY, 0.0);
                self.near.water_around(x, &mut |j| {
                    let d = (self.fluid.r[j] - x).norm_squared();
                    if d < nearest.0 {
                        let head = self.state.pressure(self.fluid.rho[j] / self.medium.rho0 - 1.0);
                        nearest = (d, head + self.medium.gravity.dot(&(x - self.fluid.r[j])));
                    }
                });
                self.medium.rho0 * (1.0 + self.state.excess(nearest.1.max(0.0)))
            })
            .collect();
        self.set_skin_density(0.0, |k, i, rho| if whose.contains(&i) { still[k] } else { rho });
    }

    /// Lets the density (kg/m³) of each wet boundary particle become what `rho` makes of its place among the wet, its
    /// index and its density over `dt` (s), never below what the wall law allows, and settle. The dry ones stay at ρ₀.
    pub(crate) fn set_skin_density(&mut self, dt: f64, mut rho: impl FnMut(usize, usize, f64) -> f64) {
        let Medium { rho0, h, c0, .. } = self.medium;
        let settled = settled(dt, h, c0);
        for (k, &i) in self.near.wet().iter().enumerate() {
            let i = i as usize;
            let bare = rho(k, i, self.skin.rho[i]);
            self.skin.rho[i] = match self.goals.get(i) {
                None => Dbc.close(bare, rho0),
                Some(&(goal, cover)) => {
                    let own = Dbc.close(bare, goal.min(rho0));
                    own + (goal - own) * if goal > own { settled * cover } else { settled }
                }
            };
        }
    }

    /// Looks at the water near each wet boundary particle: finds the density of the pressure that it would have there, if
    /// walls settle to that, and the velocity to show it, if it sticks to the face.
    pub(super) fn aim(&mut self) {
        let (settling, sticks) = (self.model.walls == Walls::Settling, self.model.slip == Slip::None);
        if !settling && !sticks && !self.feels {
            return;
        }
        let Self { sweep, near, fluid, skin, stress, forms, marks, medium, state, .. } = self;
        let input = Input { near, water: fluid, skin, shown: &skin.v, stress, forms, marks, medium, state };
        let mut fits = vec![Fit::all(0.0); input.near.wet().len()];
        sweep.fits(&input, sticks, &mut fits);
        if self.feels {
            self.immersed = fits.iter().map(|fit| fit.weight).collect();
        }
        if settling {
            self.aim_at(&fits);
        }
        if sticks {
            self.show(&fits);
        }
    }

    /// Makes goals of the pressures of `fits`, one for each wet boundary particle.
    fn aim_at(&mut self, fits: &[Fit<f64, D>]) {
        let goal = |(&i, fit): (&u32, &Fit<f64, D>)| {
            let i = i as usize;
            let owner = self.owner(i);
            let pull = self.medium.gravity - owner.acceleration_at(&self.skin.r[i]);
            let depth = self.depths[i];
            let density = self.medium.rho0 * (1.0 + self.state.excess(fit.close(&pull, &self.medium.gravity, depth)));
            (density, self.cover.part(fit.weight, depth))
        };
        let wet = self.near.wet();
        let goals: Vec<(f64, f64)> = wet.par_iter().zip(fits).with_min_len(PER_TASK).map(goal).collect();
        self.goals.resize(self.skin.len(), (self.medium.rho0, 0.0));
        for (&i, goal) in wet.iter().zip(goals) {
            self.goals[i as usize] = goal;
        }
    }

    /// Makes the velocities to show of `fits`, one for each wet boundary particle.
    fn show(&mut self, fits: &[Fit<f64, D>]) {
        let velocity = |(&i, fit): (&u32, &Fit<f64, D>)| {
            let i = i as usize;
            let normal = self.owner(i).kinematics.pose.rotation * self.normals[i];
            sticking(fit, self.skin.v[i], &normal, self.depths[i])
        };
        let wet = self.near.wet();
        let shown: Vec<Vector<D>> = wet.par_iter().zip(fits).with_min_len(PER_TASK).map(velocity).collect();
        self.shown.resize(self.skin.len(), Vector::zeros());
        for (&i, v) in wet.iter().zip(shown) {
            self.shown[i as usize] = v;
        }
    }

    /// The solid of boundary particle `i`.
    fn owner(&self, i: usize) -> &Solid<D> {
        &self.solids[self.solids.partition_point(|solid| solid.skin.end <= i)]
    }
}

/// Whether water is not shifted beside `solid`.
pub(super) fn held<const D: usize>(model: &Model, solid: &Solid<D>) -> bool {
    match model.shifting {
        Shifting::AwayFromSolids(_) => true,
        Shifting::AwayFromFixed(_) => matches!(solid.spec.role, Role::Fixed),
        Shifting::None | Shifting::Everywhere(_) => false,
    }
}
