//! The solids as a device has them, and the chunks of their boundary particles in which their loads are added up.

use super::{layout::Layout, periodic::Sides, shaders::GROUP};
use crate::{
    math::{Bivector, Matrix, Vector},
    solid::{Load, Role},
    sph::Units,
    system::{System, device_state},
};

/// Words of a solid.
pub(super) const SOLID_WORDS: usize = 60;

/// No boundary particle.
const NONE: u32 = u32::MAX;

/// The boundary particles of the solids in chunks, those of moving solids first.
pub(super) struct SolidChunks {
    /// Boundary particles of each chunk.
    pub(super) members: Vec<u32>,
    /// Number of the solid of each chunk.
    pub(super) owners: Vec<usize>,
    /// Chunks of moving solids.
    pub(super) moving: usize,
    /// Number of the solid and of the copy of each set of boundary particles: those of a solid, or of one of its copies beside periodic
    /// sides. For the device, each set has a solid of its own.
    pub(super) copies: Vec<[usize; 2]>,
    /// Index of each boundary particle of a first copy that has others, particles of a copy, and copies.
    pub(super) copied: Vec<[u32; 4]>,
    /// Positions of the boundary particles in the frames of their solids, in the units of the pair loop.
    pub(super) local: Vec<[f32; 4]>,
}

impl SolidChunks {
    pub(super) fn new<const D: usize>(system: &System<D>) -> Self {
        let moves = |i: usize| !matches!(system.solids()[i].spec.role, Role::Fixed);
        let (moving, fixed): (Vec<usize>, Vec<usize>) = (0..system.solids().len()).partition(|&i| moves(i));
        let (mut members, mut owners, mut chunks_of_moving) = (Vec::new(), Vec::new(), 0);
        for (number, solid) in moving.iter().chain(&fixed).enumerate() {
            let own: Vec<u32> = system.solids()[*solid].boundary.clone().map(|i| i as u32).collect();
            for chunk in own.chunks(GROUP) {
                members.extend_from_slice(chunk);
                members.resize(members.len().next_multiple_of(GROUP), NONE);
                owners.push(*solid);
            }
            if number + 1 == moving.len() {
                chunks_of_moving = owners.len();
            }
        }
        let unit = system.model().single_precision_units::<D>().length;
        let mut local = vec![[0.0; 4]; system.boundary().len()];
        for &solid in &moving {
            let own = device_state::local_boundary(system, solid);
            for (i, r) in system.solids()[solid].boundary.clone().zip(own.iter().cycle()) {
                (0..D).for_each(|k| local[i][k] = (r[k] / unit) as f32);
            }
        }
        let (mut copies, mut copied) = (Vec::new(), Vec::new());
        for (number, solid) in system.solids().iter().enumerate() {
            let (count, first) = (solid.copies(), solid.boundary_of_copy(0));
            copies.extend((0..count).map(|copy| [number, copy]));
            let length = first.len();
            copied.extend(first.filter(|_| count > 1).map(|i| [i as u32, length as u32, count as u32, 0]));
        }
        Self { members, owners, moving: chunks_of_moving, copies, copied, local }
    }

    /// Number of the set of each boundary particle.
    pub(super) fn set_of_each<'a, const D: usize>(&'a self, system: &'a System<D>) -> impl Iterator<Item = u32> + 'a {
        let length = |&[solid, copy]: &[usize; 2]| system.solids()[solid].boundary_of_copy(copy).len();
        (0u32..).zip(&self.copies).flat_map(move |(set, of)| std::iter::repeat_n(set, length(of)))
    }

    /// The words of all sets of boundary particles.
    pub(super) fn solids<const D: usize>(
        &self,
        system: &System<D>,
        (layout, sides): (&Layout, &Sides<D>),
        units: &Units,
    ) -> Vec<[u32; SOLID_WORDS]> {
        let (rate, speed) = (units.time, units.time / units.length);
        let one = |&[i, copy]: &[usize; 2]| {
            let (solid, mut words) = (&system.solids()[i], [0; SOLID_WORDS]);
            let kinematics = &solid.kinematics;
            let away = device_state::periods_to_copy(system, i, copy);
            let place = |r: &Vector<D>| layout.place_away(r, sides.periods(), away);
            words[..8].copy_from_slice(&place(&kinematics.pose.position));
            words[3] = u32::from(device_state::suppresses_shifting(system, i));
            words[8..16].copy_from_slice(&place(&kinematics.centre));
            let mut matrix = |at: usize, m: &Matrix<D>, scale: f64| {
                for column in 0..D {
                    for row in 0..D {
                        words[at + 4 * column + row] = ((m[(row, column)] * scale) as f32).to_bits();
                    }
                }
            };
            matrix(16, &kinematics.pose.rotation, 1.0);
            matrix(28, &kinematics.spin.0, rate);
            matrix(40, &device_state::arm_acceleration(system, i), rate * rate);
            let mut vector = |at: usize, v: &Vector<D>, scale: f64| {
                (0..D).for_each(|k| words[at + k] = ((v[k] * scale) as f32).to_bits());
            };
            vector(52, &kinematics.velocity, speed);
            vector(56, &solid.acceleration, speed * rate);
            words[55] = f32::from(u8::from(matches!(solid.spec.role, Role::Free(_)))).to_bits();
            words[59] = (system.wall_promptness(solid) as f32).to_bits();
            words
        };
        self.copies.iter().map(one).collect()
    }

    /// The loads on all solids from the sums of the chunks, added up in double precision and in order.
    pub(super) fn loads<const D: usize>(&self, words: &[u32], system: &System<D>, units: &Units) -> Vec<Load<D>> {
        let force_unit = system.particle_mass() * units.length / units.time.powi(2);
        let mut loads = vec![Load::zero(); system.solids().len()];
        for (sums, &solid) in words.chunks_exact(8).zip(&self.owners) {
            let of = |k: usize| f64::from(f32::from_bits(sums[k])) * force_unit;
            let axial: Vec<f64> = if D == 2 { vec![of(6)] } else { vec![of(4), of(5), of(6)] };
            let axial: Vec<f64> = axial.into_iter().map(|x| x * units.length).collect();
            let load = Load { force: Vector::from_fn(|k, _| of(k)), torque: Bivector::from_axial(&axial) };
            loads[solid] += load;
        }
        loads
    }
}
