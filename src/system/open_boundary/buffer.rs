//! The buffers: which particles lie beyond which face, and their exchange with the water when the lists are rebuilt.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{
    OpenBoundary, buffer_length,
    rows::{self, Created},
};
use crate::{
    math::Vector,
    particles::Particles,
    system::{
        Fluid, System,
        symmetry::{AxisSet, reflected},
    },
};

/// What has passed through a face since the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FaceExchange<const D: usize> {
    /// Number of particles that have entered.
    pub entered: u64,
    /// Number of particles that have left.
    pub left: u64,
    /// Momentum of the water that has entered less that of the water that has left, kg m/s (kg/s in 2-D).
    pub momentum: Vector<D>,
    /// Energy of the water that has entered less that of the water that has left, J (J/m in 2-D).
    pub energy: f64,
}

impl<const D: usize> FaceExchange<D> {
    /// Nothing yet.
    fn zero() -> Self {
        Self { entered: 0, left: 0, momentum: Vector::zeros(), energy: 0.0 }
    }

    /// Counts a particle that enters (`sense` 1) or leaves (−1), with its mirror images by the planes normal to `axes`.
    fn count(&mut self, sense: f64, (mass, axes): (f64, AxisSet), v: &Vector<D>, energy: f64) {
        if sense > 0.0 {
            self.entered += 1;
        } else {
            self.left += 1;
        }
        self.momentum += (v + reflected(axes, *v)) * (0.5 * sense * mass);
        self.energy += sense * energy;
    }
}

/// Most open boundaries of a run.
pub(crate) const MOST_FACES: usize = 128;

/// The number of the face of a buffer particle, and whether it has been water since it was placed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(in crate::system) struct BufferTag(u8);

impl BufferTag {
    const FROM_WATER: u8 = 1 << 7;

    /// Of a particle that was placed in the buffer of face number `face`, below [`MOST_FACES`].
    pub(super) fn placed(face: usize) -> Self {
        Self(face as u8)
    }

    /// Of a particle that has left the water through face number `face`, below [`MOST_FACES`].
    pub(super) fn from_water(face: usize) -> Self {
        Self(face as u8 | Self::FROM_WATER)
    }

    /// Number of the face.
    pub(in crate::system) fn face(self) -> usize {
        usize::from(self.0 & !Self::FROM_WATER)
    }

    pub(super) fn is_from_water(self) -> bool {
        self.0 & Self::FROM_WATER != 0
    }
}

/// The particles beyond the faces.
#[derive(Default)]
pub(in crate::system) struct Buffer<const D: usize> {
    /// The tag of each of them; they follow the water in this order.
    pub(in crate::system) tags: Vec<BufferTag>,
    /// Of each face that keeps rows, a place (m) in each of them at the start.
    pub(in crate::system) rows: Vec<Vec<Vector<D>>>,
    /// Name of the next particle.
    pub(in crate::system) next_id: u32,
    /// Time of the next rebuild of the lists, s.
    pub(in crate::system) time: f64,
    /// What has passed through each face.
    pub(in crate::system) exchange: Vec<FaceExchange<D>>,
}

/// What a particle is after the lists were rebuilt.
enum Place {
    Water,
    Buffer(BufferTag),
    Gone,
}

/// Puts the water beyond the faces into the buffers, before the first lists are made.
pub(in crate::system) fn start_buffers<const D: usize>(system: &mut System<D>) {
    let faces = &system.fluid_domain.open_boundaries;
    if faces.is_empty() {
        return;
    }
    let beyond = |r: &Vector<D>| faces.iter().position(|face| face.beyond(r) > 0.0);
    let r = &system.fluid.particles.r;
    let (buffer, water): (Vec<u32>, Vec<u32>) = (0..r.len() as u32).partition(|&i| beyond(&r[i as usize]).is_some());
    let tags: Vec<_> = buffer.iter().filter_map(|&i| beyond(&r[i as usize])).map(BufferTag::placed).collect();
    let of_face = |number: usize, face: &OpenBoundary<D>| {
        let own = buffer.iter().zip(&tags).filter(|(_, tag)| tag.face() == number).map(|(&i, _)| &r[i as usize]);
        if face.keeps_rows() { rows::places(face, system.model.dp, own) } else { Vec::new() }
    };
    let rows = faces.iter().enumerate().map(|(number, face)| of_face(number, face)).collect();
    let exchange = vec![FaceExchange::zero(); faces.len()];
    let order: Vec<u32> = water.into_iter().chain(buffer).collect();
    system.fluid.buffer = Buffer { tags, rows, next_id: order.len() as u32, exchange, time: 0.0 };
    system.fluid.permute(&order);
}

/// Whether a particle has passed a face by more than it may move between two rebuilds of the lists. A rebuild within a step keeps
/// the order of the water; if all rebuilds were within steps, no water would enter.
pub(in crate::system) fn needs_exchange<const D: usize>(system: &System<D>) -> bool {
    let (faces, r) = (&system.fluid_domain.open_boundaries, &system.fluid.particles.r);
    let (water, far) = (system.particle_count(), system.neighbours.margin());
    let buffer = system.fluid.buffer.tags.iter().zip(&r[water..]);
    faces.iter().any(|face| r[..water].par_iter().any(|r| face.beyond(r) > far))
        || buffer.into_iter().any(|(tag, r)| faces[tag.face()].beyond(r) < -far)
}

/// Sorts the particles of `order` into water and buffers by their places, and appends the sources of new buffer particles.
/// Returns these.
pub(in crate::system) fn exchange_at_faces<const D: usize>(
    system: &mut System<D>,
    order: &mut Vec<u32>,
) -> Vec<Created<D>> {
    if system.fluid_domain.open_boundaries.is_empty() {
        return Vec::new();
    }
    let (water, length, mass) = (system.particle_count(), buffer_length(&system.model), system.particle_mass());
    let mass = (mass * system.water_multiplicity(), system.symmetry_planes().axes());
    let is_kept = |i: usize| system.fluid_domain.open_boundaries[i].keeps_rows();
    let kept: Vec<usize> = (0..system.fluid_domain.open_boundaries.len()).filter(|&i| is_kept(i)).collect();
    let moved: Vec<(usize, Vector<D>)> = kept.iter().flat_map(|&face| rows::spread(system, face)).collect();
    for (i, place) in moved {
        system.fluid.particles.r[i] = place;
    }
    let mut exchange = std::mem::take(&mut system.fluid.buffer.exchange);
    let time = system.fluid.buffer.time;
    let (faces, before) = (&system.fluid_domain.open_boundaries, &system.fluid.buffer.tags);
    let replaces: Vec<bool> = (0..faces.len()).map(|face| rows::replaces_water(system, face)).collect();
    let Particles { r, v, rho, .. } = &system.fluid.particles;
    let (mut inside, mut buffer, mut created) = (Vec::new(), Vec::new(), Vec::new());
    for &i in order.iter() {
        let old = i as usize;
        let was = old.checked_sub(water).map(|k| before[k]);
        let place = match was {
            Some(tag) => {
                let face = &faces[tag.face()];
                if face.beyond(&r[old]) <= 0.0 {
                    Place::Water
                } else if face.is_beyond_buffer(&r[old], length, time) {
                    Place::Gone
                } else {
                    Place::Buffer(tag)
                }
            }
            None => match faces.iter().position(|face| face.beyond(&r[old]) > 0.0) {
                Some(face) if faces[face].beyond(&r[old]) > length => {
                    exchange[face].count(-1.0, mass, &v[old], system.particle_energy(&r[old], &v[old], rho[old]));
                    Place::Gone
                }
                Some(face) => Place::Buffer(BufferTag::from_water(face)),
                None => Place::Water,
            },
        };
        match (was, &place) {
            (Some(tag), Place::Water) => {
                let energy = system.particle_energy(&r[old], &v[old], rho[old]);
                exchange[tag.face()].count(1.0, mass, &v[old], energy);
                if replaces[tag.face()] || !tag.is_from_water() {
                    let (way, velocity_change) = faces[tag.face()].way_out(&r[old], length, time);
                    let (r, v) = (r[old] + way, v[old] + velocity_change);
                    created.push(Created { source: i, face: tag.face(), r, v });
                }
            }
            (None, Place::Buffer(tag)) => {
                let energy = system.particle_energy(&r[old], &v[old], rho[old]);
                exchange[tag.face()].count(-1.0, mass, &v[old], energy);
            }
            _ => {}
        }
        match place {
            Place::Water => inside.push(i),
            Place::Buffer(tag) => buffer.push((i, tag)),
            Place::Gone => {}
        }
    }
    for face in kept {
        rows::keep(system, face, &inside, (&mut buffer, &mut created));
    }
    inside.extend(buffer.iter().map(|(i, _)| i));
    inside.extend(created.iter().map(|new| new.source));
    let tags = buffer.iter().map(|(_, tag)| *tag).chain(created.iter().map(|new| BufferTag::placed(new.face)));
    system.fluid.buffer.tags = tags.collect();
    *order = inside;
    system.fluid.buffer.exchange = exchange;
    created
}

/// Sets the time `t` (s) of the next rebuild of the lists, at which waves place new particles.
pub(crate) fn set_buffer_time<const D: usize>(system: &mut System<D>, t: f64) {
    system.fluid.buffer.time = t;
}

/// Names the last `created` particles before the images.
pub(in crate::system) fn name_created<const D: usize>(system: &mut System<D>, created: usize) {
    let own = system.own_count();
    let Fluid { particles, buffer, .. } = &mut system.fluid;
    for id in &mut particles.id[own - created..own] {
        *id = buffer.next_id;
        buffer.next_id = buffer.next_id.wrapping_add(1);
    }
}
