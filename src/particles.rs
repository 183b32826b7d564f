//! The parallel arrays of particle quantities, of the water and of the boundary particles. No laws.

use std::ops::Range;

use bytemuck::Zeroable;
use serde::{Deserialize, Serialize};

use crate::math::Vector;

/// Particles that a thread takes at a time where each costs little.
pub(crate) const PARTICLES_PER_TASK: usize = 4096;

/// Particles of one kind: index `i` of every array is the same particle. All carry the mass ρ₀ dpᴰ.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Particles<const D: usize> {
    /// Position, m.
    pub r: Vec<Vector<D>>,
    /// Velocity, m/s.
    pub v: Vec<Vector<D>>,
    /// Density, kg/m³.
    pub rho: Vec<f64>,
    /// Name of the particle for life, from 0; sorting moves it with the rest. Empty for boundary particles, whose names are their
    /// numbers.
    pub id: Vec<u32>,
}

/// An array of `n` zeros. Those that nothing writes take no memory.
pub(crate) fn zeros<T: Zeroable>(n: usize) -> Vec<T> {
    bytemuck::zeroed_vec(n)
}

/// Memory of an array that some models do not have, B.
pub(crate) fn optional_bytes<T>(array: &Option<Vec<T>>) -> usize {
    array.as_ref().map_or(0, |array| size_of_val(&array[..]))
}

impl<const D: usize> Particles<D> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.r.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.r.is_empty()
    }

    /// The first `n` of them.
    pub(crate) fn first_n(&self, n: usize) -> ParticlesView<'_, D> {
        ParticlesView {
            r: &self.r[..n],
            v: &self.v[..n],
            rho: &self.rho[..n],
            id: self.id.get(..n).unwrap_or_default(),
        }
    }

    /// Those in `range`.
    pub(crate) fn slice(&self, range: Range<usize>) -> Self {
        let Self { r, v, rho, id } = self;
        Self {
            r: r[range.clone()].to_vec(),
            v: v[range.clone()].to_vec(),
            rho: rho[range.clone()].to_vec(),
            id: id[range].to_vec(),
        }
    }

    /// Appends the particle that [`Particles::give`] appended to `numbers`.
    pub(crate) fn push_given(&mut self, numbers: &[f64]) {
        self.r.push(Vector::from_column_slice(&numbers[..D]));
        self.v.push(Vector::from_column_slice(&numbers[D..2 * D]));
        self.rho.push(numbers[2 * D]);
        self.id.push(numbers[2 * D + 1] as u32);
    }

    /// Memory of the arrays, B.
    pub(crate) fn memory_bytes(&self) -> usize {
        size_of_val(&self.r[..]) + size_of_val(&self.v[..]) + size_of_val(&self.rho[..]) + size_of_val(&self.id[..])
    }

    /// How many numbers [`Particles::give`] appends.
    pub(crate) const NUMBERS: usize = 2 * D + 2;

    /// Appends position, velocity, density and name of particle `i`.
    pub(crate) fn give(&self, i: usize, numbers: &mut Vec<f64>) {
        numbers.extend(self.r[i].iter().chain(self.v[i].iter()).chain([&self.rho[i], &f64::from(self.id[i])]));
    }

    /// Sets particle `i` to what [`Particles::give`] appended.
    pub(crate) fn take(&mut self, i: usize, numbers: &[f64]) {
        self.r[i] = Vector::from_column_slice(&numbers[..D]);
        self.v[i] = Vector::from_column_slice(&numbers[D..2 * D]);
        self.rho[i] = numbers[2 * D];
        self.id[i] = numbers[2 * D + 1] as u32;
    }

    /// As [`Particles::take`]; a zero is not written where one is, so that zeros that nothing has written still take no memory.
    pub(crate) fn take_changed(&mut self, i: usize, numbers: &[f64]) {
        self.take_motion(i, &numbers[..2 * D]);
        self.rho[i] = numbers[2 * D];
        self.id[i] = numbers[2 * D + 1] as u32;
    }

    /// Sets position and velocity of particle `i` to the first numbers that [`Particles::give`] appended, as
    /// [`Particles::take_changed`].
    pub(crate) fn take_motion(&mut self, i: usize, numbers: &[f64]) {
        for (place, x) in self.r[i].iter_mut().chain(self.v[i].iter_mut()).zip(numbers) {
            if place.to_bits() != x.to_bits() {
                *place = *x;
            }
        }
    }

    /// Arrays of `n` particles, whose places take no memory until they are written.
    pub(crate) fn unwritten(n: usize) -> Self {
        Self { r: zeros(n), v: zeros(n), rho: zeros(n), id: zeros(n) }
    }

    /// Makes room for `more` particles without names, and no more than that.
    pub(crate) fn reserve_exact(&mut self, more: usize) {
        self.r.reserve_exact(more);
        self.v.reserve_exact(more);
        self.rho.reserve_exact(more);
    }

    /// Adds a boundary particle at rest at `r` (m) of density `rho` (kg/m³).
    pub fn push(&mut self, r: Vector<D>, rho: f64) {
        self.r.push(r);
        self.v.push(Vector::zeros());
        self.rho.push(rho);
    }
}

/// Some of the particles of one kind, to look at: as [`Particles`].
#[derive(Clone, Copy, Debug)]
pub struct ParticlesView<'a, const D: usize> {
    /// Position, m.
    pub r: &'a [Vector<D>],
    /// Velocity, m/s.
    pub v: &'a [Vector<D>],
    /// Density, kg/m³.
    pub rho: &'a [f64],
    /// Name of the particle for life; empty for boundary particles, whose names are their numbers.
    pub id: &'a [u32],
}

impl<const D: usize> ParticlesView<'_, D> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.r.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.r.is_empty()
    }

    /// Those of these numbers, in this order.
    pub(crate) fn select(&self, numbers: impl IntoIterator<Item = usize>) -> Particles<D> {
        let mut chosen = Particles::default();
        for i in numbers {
            chosen.r.push(self.r[i]);
            chosen.v.push(self.v[i]);
            chosen.rho.push(self.rho[i]);
            chosen.id.push(self.id[i]);
        }
        chosen
    }
}
