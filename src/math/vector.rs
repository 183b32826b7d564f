//! Space: vectors, turns, poses and boxes in two or three dimensions from one source.
//!
//! Spins and torques are [`Bivector`]s, antisymmetric D×D matrices, so that no formula needs a cross product: a spin Ω gives the
//! velocity u = V + Ω r, and a force f at r about the centre gives the torque T = f rᵀ − r fᵀ. The power of the two is ½ T:Ω.

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

/// A point or a vector of `D` components (m, m/s, N, …).
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;

/// A D×D matrix.
pub type Matrix<const D: usize> = SMatrix<f64, D, D>;

/// A spin (rad/s) or a torque (N m; N m/m in 2-D), as an antisymmetric matrix.
///
/// In 2-D the one number is `m[(1, 0)]`, positive counter-clockwise; in 3-D the axial vector is
/// (m₂₁, m₀₂, m₁₀).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bivector<const D: usize>(pub Matrix<D>);

impl<const D: usize> Bivector<D> {
    /// Number of independent components: 1 in 2-D, 3 in 3-D.
    pub const COMPONENTS: usize = D * (D - 1) / 2;

    /// No turning.
    pub fn zero() -> Self {
        Self(Matrix::zeros())
    }

    /// The torque of a force `f` (N) acting at the arm `r` (m): f rᵀ − r fᵀ.
    pub fn torque(r: &Vector<D>, f: &Vector<D>) -> Self {
        Self(f * r.transpose() - r * f.transpose())
    }

    /// The velocity that this spin gives at the arm `r` (m): Ω r.
    pub(crate) fn velocity_at(&self, r: &Vector<D>) -> Vector<D> {
        self.0 * r
    }

    /// The axial components: `[m₁₀]` in 2-D, `[m₂₁, m₀₂, m₁₀]` in 3-D.
    pub fn axial(&self) -> Vec<f64> {
        match D {
            2 => vec![self.0[(1, 0)]],
            _ => vec![self.0[(2, 1)], self.0[(0, 2)], self.0[(1, 0)]],
        }
    }

    /// The inverse of [`Bivector::axial`]; missing components count as zero.
    pub fn from_axial(components: &[f64]) -> Self {
        let mut m = Matrix::zeros();
        let places: &[(usize, usize)] = if D == 2 { &[(1, 0)] } else { &[(2, 1), (0, 2), (1, 0)] };
        for (&(i, j), &w) in places.iter().zip(components) {
            m[(i, j)] = w;
            m[(j, i)] = -w;
        }
        Self(m)
    }

    /// The power of this torque on a body of spin `spin` (W): ½ T:Ω.
    pub(crate) fn power(&self, spin: &Self) -> f64 {
        0.5 * self.0.component_mul(&spin.0).sum()
    }

    /// The same spin or torque, turned by `rotation`: R Ω Rᵀ.
    pub(crate) fn rotated(&self, rotation: &Matrix<D>) -> Self {
        match D {
            2 => *self,
            _ => Self::from_axial((rotation * Vector::<D>::from_iterator(self.axial())).as_slice()),
        }
    }

    /// The rotation matrix of turning with this spin for a unit of time, exp Ω (Rodrigues).
    #[inline(never)] // the tests see the only instance: see `rotated_tensor`
    pub fn exp(&self) -> Matrix<D> {
        let angle = (0.5 * self.0.norm_squared()).sqrt();
        let (a, b) =
            if angle < 1e-8 { (1.0, 0.5) } else { (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle)) };
        // Column by column: rustc 1.95 gets an entry of the sum of 3×3 products wrong, see decision 0130.
        let mut turned = Matrix::<D>::identity();
        for mut column in turned.column_iter_mut() {
            let once = self.0 * column.clone_owned();
            column += once * a + self.0 * once * b;
        }
        turned
    }
}

/// A tensor in the axes of a frame that `rotation` turns into the world's, in the world's axes: R T Rᵀ.
///
/// rustc 1.95 can get sums of 3×3 products wrong, depending on the code around them (decision 0130). A function that is
/// never inlined is compiled once, so that its test holds for every use.
#[inline(never)]
pub(crate) fn rotated_tensor<const D: usize>(rotation: &Matrix<D>, tensor: &Matrix<D>) -> Matrix<D> {
    rotation * tensor * rotation.transpose()
}

impl<const D: usize> std::ops::Add for Bivector<D> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl<const D: usize> std::ops::Mul<f64> for Bivector<D> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

/// Position and rotation of a body's frame: a local point x lies at `position + rotation · x` in the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose<const D: usize> {
    /// World position of the frame's origin, m.
    pub position: Vector<D>,
    /// Orthogonal matrix that turns local into world directions, –.
    pub rotation: Matrix<D>,
}

/// A pose without rotation.
impl<const D: usize> From<Vector<D>> for Pose<D> {
    fn from(position: Vector<D>) -> Self {
        Self::at(position)
    }
}

/// A pose without rotation.
impl<const D: usize> From<[f64; D]> for Pose<D> {
    fn from(position: [f64; D]) -> Self {
        Self::at(position.into())
    }
}

impl<const D: usize> Pose<D> {
    /// The world frame itself.
    pub fn identity() -> Self {
        Self::at(Vector::zeros())
    }

    /// Unturned, at `position` (m).
    pub fn at(position: Vector<D>) -> Self {
        Self { position, rotation: Matrix::identity() }
    }

    /// Turned by the axial angles `turn` (rad; one in 2-D, a rotation vector in 3-D), at `position`.
    pub fn rotated(position: Vector<D>, turn: &[f64]) -> Self {
        Self { position, rotation: Bivector::from_axial(turn).exp() }
    }

    /// World position of the local point `x` (m).
    pub fn point(&self, x: &Vector<D>) -> Vector<D> {
        self.position + self.rotation * x
    }

    /// Local coordinates of the world point `x` (m).
    pub fn local(&self, x: &Vector<D>) -> Vector<D> {
        self.rotation.transpose() * (x - self.position)
    }

    /// This pose after another: the pose of a frame that sits at `inner` inside this one.
    pub fn then(&self, inner: &Self) -> Self {
        Self { position: self.point(&inner.position), rotation: self.rotation * inner.rotation }
    }

    /// The axial angle of the rotation (rad): one component in 2-D, a rotation vector in 3-D.
    pub fn rotation_vector(&self) -> Vec<f64> {
        let m = &self.rotation;
        if D == 2 {
            return vec![m[(1, 0)].atan2(m[(0, 0)])];
        }
        let twice_sine = [m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]];
        let norm = twice_sine.iter().map(|x| x * x).sum::<f64>().sqrt();
        let angle = norm.atan2(m.trace() - 1.0);
        let scale = if norm < 1e-12 { 0.5 } else { angle / norm };
        twice_sine.iter().map(|x| x * scale).collect()
    }
}

/// An axis-aligned box (m).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds<const D: usize> {
    /// Lowest corner, m.
    pub min: Vector<D>,
    /// Highest corner, m.
    pub max: Vector<D>,
}

impl<const D: usize> Bounds<D> {
    /// The box that holds nothing: every union with it gives the other box.
    pub(crate) fn empty() -> Self {
        Self { min: Vector::repeat(f64::INFINITY), max: Vector::repeat(f64::NEG_INFINITY) }
    }

    /// The smallest box around `points` (m).
    pub(crate) fn around<'a>(points: impl IntoIterator<Item = &'a Vector<D>>) -> Self {
        points.into_iter().fold(Self::empty(), |b, x| Self { min: b.min.inf(x), max: b.max.sup(x) })
    }

    /// The smallest box around both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// The box grown by `margin` (m) on every side.
    pub(crate) fn grown(&self, margin: f64) -> Self {
        Self { min: self.min.add_scalar(-margin), max: self.max.add_scalar(margin) }
    }

    /// Whether `x` lies inside (faces included). False for a non-finite point.
    pub(crate) fn contains(&self, x: &Vector<D>) -> bool {
        (0..D).all(|i| x[i] >= self.min[i] && x[i] <= self.max[i])
    }

    /// Whether a point lies inside both.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        (0..D).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// The corners.
    pub(crate) fn corners(&self) -> impl Iterator<Item = Vector<D>> + use<D> {
        let Self { min, max } = *self;
        (0..1usize << D).map(move |c| Vector::from_fn(|i, _| if c >> i & 1 == 1 { max[i] } else { min[i] }))
    }

    /// Edge lengths, m.
    pub fn size(&self) -> Vector<D> {
        self.max - self.min
    }
}

#[cfg(test)]
#[path = "../../tests/unit/math/vector.rs"]
mod tests;
