//! The solids as a device has them, and the chunks of their boundary particles in which their loads are added up.

use super::{layout::Layout, periodic::Sides, shaders::GROUP};
use crate::{
    math::{Bivector, Matrix, Vector},
    solid::{Load, Role},
    sph::Units,
    system::{AxisSet, System, device_state, reflected, reflected_tensor},
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
    /// The sets of boundary particles: those of a solid, of one of its copies beside periodic sides, or of its image across symmetry
    /// planes. For the device, each set has a solid of its own.
    pub(super) sets: Vec<SolidSet>,
    /// Index of each boundary particle of a first copy that has others, particles of a copy, and copies; or index of each mirror
    /// image, of its original, the way to it, and 1.
    pub(super) copied: Vec<[u32; 4]>,
    /// Positions of the boundary particles in the frames of their solids, in the units of the pair loop; then the share of the load that
    /// counts beside symmetry planes.
    pub(super) local: Vec<[f32; 4]>,
}

/// A set of boundary particles.
#[derive(Clone, Copy, Debug)]
pub(super) struct SolidSet {
    /// Numbers of its solid and of its copy.
    solid: usize,
    copy: usize,
    /// Axes along which it is reflected.
    axes: AxisSet,
    /// Number of its particles.
    count: usize,
}

/// The matrix `m` of a solid, whose image is reflected along `axes`.
fn reflected_columns<const D: usize>(axes: AxisSet, m: &Matrix<D>) -> Matrix<D> {
    Matrix::from_fn(|i, j| if axes >> i & 1 == 1 { -m[(i, j)] } else { m[(i, j)] })
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
        let mut set = |i: usize, r: &Vector<D>| (0..D).for_each(|k| local[i][k] = (r[k] / unit) as f32);
        let (mut sets, mut copied) = (Vec::new(), Vec::new());
        for (number, solid) in system.solids().iter().enumerate() {
            let (range, mirrored) = device_state::reflected_boundary(system, number);
            let (copies, first) = (solid.copies(), solid.boundary_of_copy(0));
            let count = first.len();
            sets.extend((0..copies).map(|copy| SolidSet { solid: number, copy, axes: 0, count }));
            copied.extend(first.filter(|_| copies > 1).map(|i| [i as u32, count as u32, copies as u32, 0]));
            for part in mirrored.chunk_by(|a, b| a.0 == b.0) {
                sets.push(SolidSet { solid: number, copy: 0, axes: part[0].0, count: part.len() });
            }
            let images = (range.end..).zip(&mirrored);
            copied.extend(images.clone().map(|(i, (axes, own))| [i as u32, *own as u32, Sides::<D>::way(*axes), 1]));
            if moves(number) {
                let own = device_state::local_boundary(system, number);
                range.clone().zip(own.iter().cycle()).for_each(|(i, r)| set(i, r));
                images.for_each(|(i, (_, original))| set(i, &own[original - range.start]));
            }
        }
        if system.symmetry_planes().any() {
            let own = (0..system.solids().len()).flat_map(|number| device_state::reflected_boundary(system, number).0);
            own.for_each(|i| local[i][3] = device_state::share_of_load(system, i) as f32);
        }
        Self { members, owners, moving: chunks_of_moving, sets, copied, local }
    }

    /// Number of the set of each boundary particle.
    pub(super) fn set_of_each(&self) -> impl Iterator<Item = u32> {
        (0u32..).zip(&self.sets).flat_map(|(number, set)| std::iter::repeat_n(number, set.count))
    }

    /// The words of all sets of boundary particles.
    pub(super) fn solids<const D: usize>(
        &self,
        system: &System<D>,
        (layout, sides): (&Layout, &Sides<D>),
        units: &Units,
    ) -> Vec<[u32; SOLID_WORDS]> {
        let (rate, speed) = (units.time, units.time / units.length);
        let planes = system.symmetry_planes();
        let one = |&SolidSet { solid: i, copy, axes, .. }: &SolidSet| {
            let (solid, mut words) = (&system.solids()[i], [0; SOLID_WORDS]);
            let kinematics = &solid.kinematics;
            let away = device_state::periods_to_copy(system, i, copy);
            let place = |r: &Vector<D>| layout.place_away(&planes.mirrored(axes, r), sides.periods(), away);
            words[..8].copy_from_slice(&place(&kinematics.pose.position));
            words[3] = u32::from(device_state::suppresses_shifting(system, i));
            words[8..16].copy_from_slice(&place(&kinematics.centre));
            words[11] = 2 * i as u32 + u32::from(!device_state::is_whole(system, i, axes));
            let mut matrix = |at: usize, m: &Matrix<D>, scale: f64| {
                for column in 0..D {
                    for row in 0..D {
                        words[at + 4 * column + row] = ((m[(row, column)] * scale) as f32).to_bits();
                    }
                }
            };
            matrix(16, &reflected_columns(axes, &kinematics.pose.rotation), 1.0);
            matrix(28, &reflected_tensor(axes, &kinematics.spin.0), rate);
            matrix(40, &reflected_tensor(axes, &device_state::arm_acceleration(system, i)), rate * rate);
            let mut vector = |at: usize, v: &Vector<D>, scale: f64| {
                (0..D).for_each(|k| words[at + k] = ((v[k] * scale) as f32).to_bits());
            };
            vector(52, &reflected(axes, kinematics.velocity), speed);
            vector(56, &reflected(axes, solid.acceleration), speed * rate);
            words[55] = f32::from(u8::from(matches!(solid.spec.role, Role::Free(_)))).to_bits();
            words[59] = (system.wall_promptness(solid) as f32).to_bits();
            words
        };
        self.sets.iter().map(one).collect()
    }

    /// The loads on the computed parts of all solids from the sums of the chunks, added up in double precision and in order.
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
