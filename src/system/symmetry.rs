//! Symmetry planes: the program computes the water on one side of each plane, and its mirror image stands for the other side.
//!
//! Water near a plane has images, as at periodic sides ([`super::periodic`]): mirrored position, velocity, acceleration and
//! tensors, equal density. A particle that has crossed a plane changes places with its image when the lists are rebuilt.
//!
//! The boundary particles of a solid on the computed side come first in the arrays, then their mirror images, which take density
//! and velocity from them. Of a solid that a plane cuts they are its other part, so that its particles lie symmetrically. A
//! particle within [`ON_PLANE`] of the plane is set on it and is its own image: half of its force counts. The load is that of the
//! whole solid: the load of the computed part and its reflection. Of any other solid the images are another solid.

use super::{Fluid, System};
use crate::{
    interaction::PairSums,
    math::{Bivector, Matrix, Pose, Vector},
    solid::{Load, Role, Solid, SolidSpec},
    sph::AuxiliarySums,
};

/// Distance from a plane within which a boundary particle of a solid that the plane cuts is set on the plane, dp. Rows of symmetric
/// solids lie at 0 or at 0.37 dp and more.
pub(super) const ON_PLANE: f64 = 0.35;

/// Distance from a plane at which round-off cannot tell a particle from one on the plane, dp.
pub(super) const TOLERANCE: f64 = 1e-6;

/// A set of axes, bit by bit: those along which a vector is reflected.
pub(crate) type AxisSet = u8;

/// A plane normal to an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SymmetryPlane {
    /// Its coordinate, m.
    pub(crate) at: f64,
    /// Whether the side of greater coordinates is computed.
    pub(crate) is_upper: bool,
}

impl SymmetryPlane {
    /// Distance (m) of the coordinate `x` (m) from the plane, positive on the computed side.
    pub(crate) fn depth(&self, x: f64) -> f64 {
        if self.is_upper { x - self.at } else { self.at - x }
    }
}

/// The symmetry planes of a system, at most one normal to each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SymmetryPlanes<const D: usize>(pub(crate) [Option<SymmetryPlane>; D]);

impl<const D: usize> SymmetryPlanes<D> {
    /// Whether there is a plane.
    pub(crate) fn any(&self) -> bool {
        self.0.iter().any(Option::is_some)
    }

    /// The planes with their axes.
    pub(crate) fn each(&self) -> impl Iterator<Item = (usize, SymmetryPlane)> {
        self.0.into_iter().enumerate().filter_map(|(axis, plane)| Some((axis, plane?)))
    }

    /// The axes along which `x` (m) lies beyond the plane.
    pub(crate) fn axes_beyond(&self, x: &Vector<D>) -> AxisSet {
        self.each().filter(|(axis, plane)| plane.depth(x[*axis]) < 0.0).fold(0, |set, (axis, _)| set | 1 << axis)
    }

    /// The mirror image of the place `x` (m) across the planes normal to `axes`.
    pub(crate) fn mirrored(&self, axes: AxisSet, x: &Vector<D>) -> Vector<D> {
        let mut x = *x;
        for (axis, plane) in self.each().filter(|(axis, _)| axes >> axis & 1 == 1) {
            x[axis] = 2.0 * plane.at - x[axis];
        }
        x
    }

    /// The image of `x` (m) on the computed side.
    pub(crate) fn folded(&self, x: &Vector<D>) -> Vector<D> {
        self.mirrored(self.axes_beyond(x), x)
    }

    /// How many images of a thing there are, itself counted, if the planes normal to the axes `cut` pass through it.
    pub(crate) fn multiplicity(&self, cut: AxisSet) -> f64 {
        self.each().filter(|(axis, _)| cut >> axis & 1 == 0).fold(1.0, |count, _| 2.0 * count)
    }

    /// The share of the particle at `r` (m) that belongs to the computed side of the planes normal to the axes `cut`: half if it
    /// lies on a plane.
    fn share(&self, cut: AxisSet, r: &Vector<D>, dp: f64) -> f64 {
        0.5f64.powi(self.axes_of_planes_at(cut, r, dp).count_ones() as i32)
    }

    /// The axes among `cut` on whose planes the particle at `r` (m) lies.
    pub(super) fn axes_of_planes_at(&self, cut: AxisSet, r: &Vector<D>, dp: f64) -> AxisSet {
        let lies_on = |axis: usize, plane: &SymmetryPlane| plane.depth(r[axis]) < TOLERANCE * dp;
        let each = self.each().filter(|(axis, plane)| cut >> axis & 1 == 1 && lies_on(*axis, plane));
        each.fold(0, |set, (axis, _)| set | 1 << axis)
    }

    /// Divides the boundary particles at `points` (m) of a solid; every plane within [`ON_PLANE`] of them or across them cuts it.
    pub(super) fn divide(&self, spec: &SolidSpec<D>, points: &[Vector<D>], (dp, width): (f64, f64)) -> Division<D> {
        let mut division = Division { cut: 0, own: Vec::new(), mirrored: Vec::new(), whole: points.len() };
        let all = || points.iter().copied().zip(0u32..).map(|(r, i)| (i, r));
        if !self.any() {
            division.own = all().collect();
            return division;
        }
        let lies_near =
            |axis: usize, plane: &SymmetryPlane| points.iter().any(|r| plane.depth(r[axis]) < ON_PLANE * dp);
        for (axis, _) in self.each().filter(|(axis, plane)| lies_near(*axis, plane)) {
            division.cut |= 1 << axis;
        }
        let cut = division.cut;
        division.own = all().filter_map(|(i, r)| Some((i, self.on_computed_side(cut, r, dp)?))).collect();
        // The images of the solid itself come first.
        let mut sets: Vec<AxisSet> = (1..1 << D).filter(|set| self.axes() & set == *set).collect();
        sets.sort_by_key(|set| set & !cut != 0);
        division.whole = division.own.len();
        for set in sets {
            let is_own = set & !cut == 0;
            for (k, (_, r)) in (0u32..).zip(&division.own) {
                let depth = |(axis, plane): (usize, SymmetryPlane)| plane.depth(r[axis]);
                let across = || self.each().filter(|(axis, _)| set >> axis & 1 == 1);
                let is_apart = across().all(|plane| depth(plane) > TOLERANCE * dp);
                let is_seen = is_own || !matches!(spec.role, Role::Fixed) || across().all(|plane| depth(plane) < width);
                if is_apart && is_seen {
                    division.mirrored.push(MirroredParticle { own: k, axes: set });
                }
            }
            if is_own {
                division.whole = division.own.len() + division.mirrored.len();
            }
        }
        division
    }

    /// The axes that have a plane.
    fn axes(&self) -> AxisSet {
        self.each().fold(0, |set, (axis, _)| set | 1 << axis)
    }

    /// The place `r` (m), set on the planes that it is near to; `None` beyond a plane.
    fn on_computed_side(&self, cut: AxisSet, mut r: Vector<D>, dp: f64) -> Option<Vector<D>> {
        for (axis, plane) in self.each().filter(|(axis, _)| cut >> axis & 1 == 1) {
            let depth = plane.depth(r[axis]);
            if depth < -TOLERANCE * dp {
                return None;
            }
            if depth <= ON_PLANE * dp {
                r[axis] = plane.at;
            }
        }
        Some(r)
    }
}

/// The boundary particles of a solid, divided by the planes.
pub(super) struct Division<const D: usize> {
    pub(super) cut: AxisSet,
    /// Those on the computed side: their indices among all, and their places, m.
    pub(super) own: Vec<(u32, Vector<D>)>,
    pub(super) mirrored: Vec<MirroredParticle>,
    /// Number of those of the whole solid: the computed ones and the first of the mirrored ones.
    pub(super) whole: usize,
}

/// The mirror image of a boundary particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MirroredParticle {
    /// Number of the particle that it mirrors among those of its solid.
    pub(super) own: u32,
    pub(super) axes: AxisSet,
}

/// The vector `v`, reflected along `axes`.
#[inline]
pub(crate) fn reflected<const D: usize>(axes: AxisSet, mut v: Vector<D>) -> Vector<D> {
    if axes != 0 {
        v.iter_mut().enumerate().filter(|(axis, _)| axes >> axis & 1 == 1).for_each(|(_, x)| *x = -*x);
    }
    v
}

/// Whether reflection along `axes` changes the sign of component (i, j) of a tensor.
fn changes_sign(axes: AxisSet, i: usize, j: usize) -> bool {
    (axes >> i ^ axes >> j) & 1 == 1
}

/// The tensor `m`, reflected along `axes`.
pub(super) fn reflected_tensor<const D: usize>(axes: AxisSet, m: &Matrix<D>) -> Matrix<D> {
    Matrix::from_fn(|i, j| if changes_sign(axes, i, j) { -m[(i, j)] } else { m[(i, j)] })
}

/// The sums of a particle, reflected along `axes`.
pub(super) fn reflected_sums<const D: usize>(axes: AxisSet, sums: PairSums<D>) -> PairSums<D> {
    PairSums { acceleration: reflected(axes, sums.acceleration), ..sums }
}

/// The auxiliary sums of a particle, reflected along `axes`.
pub(super) fn reflected_auxiliary<const D: usize>(
    axes: AxisSet,
    mut sums: AuxiliarySums<f64, D>,
) -> AuxiliarySums<f64, D> {
    sums.concentration_gradient = reflected(axes, Vector::from(sums.concentration_gradient)).into();
    for rows in [&mut sums.strain, &mut sums.renormalization] {
        for (i, row) in rows.iter_mut().enumerate() {
            row.iter_mut().enumerate().filter(|(j, _)| changes_sign(axes, i, *j)).for_each(|(_, x)| *x = -*x);
        }
    }
    sums
}

/// The torque or spin `turn`, reflected along `axes`.
fn reflected_turn<const D: usize>(axes: AxisSet, turn: &Bivector<D>) -> Bivector<D> {
    Bivector(reflected_tensor(axes, &turn.0))
}

impl<const D: usize> System<D> {
    /// The symmetry planes.
    pub(crate) fn symmetry_planes(&self) -> &SymmetryPlanes<D> {
        &self.fluid.images.planes
    }

    /// Number of images of the computed water, itself counted: its energy times this number is that of all water.
    pub(crate) fn water_multiplicity(&self) -> f64 {
        self.symmetry_planes().multiplicity(0)
    }

    /// Number of images of solid number `i`, itself counted. A plane that cuts the solid gives it no other image.
    pub(crate) fn solid_multiplicity(&self, i: usize) -> f64 {
        self.symmetry_planes().multiplicity(self.solids[i].division.cut)
    }

    /// The share (–) of the boundary particle at `r` (m) of `solid` that the computed side has.
    pub(crate) fn computed_share(&self, solid: &Solid<D>, r: &Vector<D>) -> f64 {
        self.symmetry_planes().share(solid.division.cut, r, self.model.dp)
    }

    /// Whether the moving solid number `i` at `pose`, which no plane cuts, reaches a plane, where it meets its image.
    pub(crate) fn meets_its_image(&self, i: usize, pose: &Pose<D>) -> bool {
        let (planes, cut) = (self.symmetry_planes(), self.solids[i].division.cut);
        let mut apart = planes.each().filter(|(axis, _)| cut >> axis & 1 == 0).peekable();
        if apart.peek().is_none() || matches!(self.solids[i].spec.role, Role::Fixed) {
            return false;
        }
        // The rows of the solid and of its image are a row apart then.
        let near = 0.5 * self.model.dp;
        let corners: Vec<Vector<D>> = self.boundary.local_bounds[i].corners().map(|x| pose.point(&x)).collect();
        apart.any(|(axis, plane)| corners.iter().any(|x| plane.depth(x[axis]) < near))
    }

    /// The load on the whole `solid`, if the computed side gives `load` about its centre.
    pub(super) fn load_on_whole(&self, solid: &Solid<D>, load: Load<D>) -> Load<D> {
        let (planes, cut) = (self.symmetry_planes(), solid.division.cut);
        let cutting = planes.each().filter(|(axis, _)| cut >> axis & 1 == 1);
        cutting.fold(load, |load, (axis, plane)| {
            let axes = 1 << axis;
            let force = reflected(axes, load.force);
            // The reflected torque is one about the reflected centre.
            let mut arm = Vector::zeros();
            arm[axis] = 2.0 * (plane.at - solid.kinematics.centre[axis]);
            load + Load { force, torque: reflected_turn(axes, &load.torque) + Bivector::torque(&arm, &force) }
        })
    }

    /// Force (N; N/m in 2-D) of the computed water and of the computed parts of the solids on the symmetry plane normal to
    /// axis number `axis`, positive outwards, at the last force pass: what the other side of the plane would get. 0 without a plane.
    ///
    /// Along its normal the momentum of the computed side changes by gravity, by this force, and by what holds the solids.
    pub fn symmetry_plane_force(&self, axis: usize) -> f64 {
        let Some(plane) = self.symmetry_planes().0.get(axis).copied().flatten() else { return 0.0 };
        let (mass, g, rates) = (self.particle_mass(), self.properties.gravity[axis], self.fluid_rates());
        let water: f64 = (0..self.particle_count()).map(|i| rates.of(i).acceleration[axis] - g).sum();
        let mut solids = 0.0;
        for (&i, sums) in self.neighbours.boundary_near_fluid().iter().zip(&self.rates.boundary) {
            let (i, solid) = (i as usize, &self.solids[self.owner(i as usize)]);
            if i < solid.boundary.start + solid.division.own {
                solids += sums.acceleration[axis] * self.computed_share(solid, &self.boundary.particles.r[i]);
            }
        }
        mass * (water + solids) * if plane.is_upper { 1.0 } else { -1.0 }
    }

    /// Velocity (m/s) of water particle `i` as seen at `place` (m), which is its own or that of its image.
    pub(crate) fn velocity_seen_at(&self, i: usize, place: &Vector<D>) -> Vector<D> {
        let Fluid { particles, images, .. } = &self.fluid;
        let axes = images.planes.axes_beyond(place) ^ images.planes.axes_beyond(&particles.r[i]);
        reflected(axes, particles.v[i])
    }
}
