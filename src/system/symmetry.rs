//! Symmetry planes: the program computes the water on one side of each plane, and its mirror image stands for the other side.
//!
//! Water near a plane has images, as at periodic sides ([`super::periodic`]): mirrored position, velocity, acceleration and
//! tensors, equal density. A particle that has crossed a plane changes places with its image when the lists are rebuilt.
//!
//! The boundary particles of a solid on the computed side come first in the arrays, then their mirror images, which take density
//! and velocity from them. If a plane cuts the solid, the images are its other part, so that its particles lie symmetrically. A
//! particle within [`ON_PLANE`] of the plane is set on it and is its own image: half of its force counts. The load is that of the
//! whole solid: the load of the computed part and its reflection. The images of any other solid are another solid.

use crate::{
    interaction::PairSums,
    math::{Bivector, Matrix, Vector},
    solid::{Role, SolidSpec},
    sph::AuxiliarySums,
};

/// Distance from a plane within which a boundary particle of a solid that the plane cuts is set on the plane, dp. Rows of symmetric
/// solids lie at 0 or at 0.35 dp and more. As many particles are set on the plane from both sides as their images would be.
pub(super) const ON_PLANE: f64 = 0.34;

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

    /// The place `x` (m) and its mirror images.
    pub(crate) fn images(&self, x: &Vector<D>) -> impl Iterator<Item = Vector<D>> {
        let (planes, x, all) = (*self, *x, self.each().fold(0, |set, (axis, _)| set | 1 << axis));
        (0..=all).filter(move |axes| axes & !all == 0).map(move |axes| planes.mirrored(axes, &x))
    }

    /// The image of `x` (m) on the computed side.
    pub(crate) fn folded(&self, x: &Vector<D>) -> Vector<D> {
        self.mirrored(self.axes_beyond(x), x)
    }

    /// Number of images of an object, itself included, if the planes normal to the axes `cut` pass through it.
    pub(crate) fn multiplicity(&self, cut: AxisSet) -> f64 {
        self.each().filter(|(axis, _)| cut >> axis & 1 == 0).fold(1.0, |count, _| 2.0 * count)
    }

    /// The share of the particle at `r` (m) that belongs to the computed side of the planes normal to the axes `cut`: half if it
    /// lies on a plane.
    pub(super) fn share(&self, cut: AxisSet, r: &Vector<D>, dp: f64) -> f64 {
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
        let own = || all().filter_map(|(i, r)| Some((i, self.on_computed_side(cut, r, dp)?)));
        let is_beyond =
            |i: u32| self.each().any(|(axis, plane)| plane.depth(points[i as usize][axis]) < -TOLERANCE * dp);
        division.own = own().filter(|(i, _)| !is_beyond(*i)).collect();
        // Of a symmetric pair beside the plane one particle remains.
        for (i, r) in own().filter(|(i, _)| is_beyond(*i)) {
            if division.own.iter().all(|(_, other)| (other - r).norm() > 0.5 * dp) {
                division.own.push((i, r));
            }
        }
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
    pub(super) fn axes(&self) -> AxisSet {
        self.each().fold(0, |set, (axis, _)| set | 1 << axis)
    }

    /// The place `r` (m), set on the planes that it is near to; `None` beyond a plane.
    fn on_computed_side(&self, cut: AxisSet, mut r: Vector<D>, dp: f64) -> Option<Vector<D>> {
        for (axis, plane) in self.each().filter(|(axis, _)| cut >> axis & 1 == 1) {
            let depth = plane.depth(r[axis]);
            if depth < -ON_PLANE * dp {
                return None;
            }
            if depth < ON_PLANE * dp {
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
pub(crate) fn reflected_tensor<const D: usize>(axes: AxisSet, m: &Matrix<D>) -> Matrix<D> {
    Matrix::from_fn(|i, j| if changes_sign(axes, i, j) { -m[(i, j)] } else { m[(i, j)] })
}

/// The sums of a particle, reflected along `axes`.
pub(super) fn reflected_sums<const D: usize>(axes: AxisSet, sums: PairSums<D>) -> PairSums<D> {
    PairSums { acceleration: reflected(axes, sums.acceleration), ..sums }
}

/// Reflects the auxiliary sums of a particle along `axes`.
pub(super) fn reflect_auxiliary<const D: usize>(axes: AxisSet, sums: &mut AuxiliarySums<f64, D>) {
    sums.concentration_gradient = reflected(axes, Vector::from(sums.concentration_gradient)).into();
    for rows in [&mut sums.strain, &mut sums.renormalization] {
        for (i, row) in rows.iter_mut().enumerate() {
            row.iter_mut().enumerate().filter(|(j, _)| changes_sign(axes, i, *j)).for_each(|(_, x)| *x = -*x);
        }
    }
}

/// The torque or spin `turn`, reflected along `axes`.
pub(super) fn reflected_turn<const D: usize>(axes: AxisSet, turn: &Bivector<D>) -> Bivector<D> {
    Bivector(reflected_tensor(axes, &turn.0))
}
