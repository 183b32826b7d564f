//! The solids as a device has them, and the chunks of their boundary particles in which their loads are added up.

use super::{layout::Layout, shaders::GROUP};
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
            for (i, r) in system.solids()[solid].boundary.clone().zip(device_state::local_boundary(system, solid)) {
                (0..D).for_each(|k| local[i][k] = (r[k] / unit) as f32);
            }
        }
        Self { members, owners, moving: chunks_of_moving, local }
    }

    /// The words of all solids.
    pub(super) fn solids<const D: usize>(
        &self,
        system: &System<D>,
        layout: &Layout,
        units: &Units,
    ) -> Vec<[u32; SOLID_WORDS]> {
        let (rate, speed) = (units.time, units.time / units.length);
        let one = |i: usize| {
            let (solid, mut words) = (&system.solids()[i], [0; SOLID_WORDS]);
            let kinematics = &solid.kinematics;
            words[..8].copy_from_slice(&layout.place(&kinematics.pose.position, 0, 0));
            words[3] = u32::from(device_state::suppresses_shifting(system, i));
            words[8..16].copy_from_slice(&layout.place(&kinematics.centre, 0, 0));
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
        (0..system.solids().len()).map(one).collect()
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
