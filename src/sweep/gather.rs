//! The f64 oracle: each particle gathers its own neighbours in stored order, so that the bits depend on
//! neither threads nor chunks.

use super::{Input, Node, Sums, Sweep};
use crate::{
    law::{
        Extra, Medium, Pair, Side, Term,
        kernel::{Kernel, REACH},
    },
    near::CHUNK,
    space::{Matrix, Vector},
};

/// A sweep of the laws `T` among water and `W` between water and solids.
#[derive(Clone, Copy, Debug)]
pub struct Gather<K, T, W> {
    kernel: K,
    inner: T,
    wall: W,
    /// V₀ = m/ρ₀, mᴰ.
    volume: f64,
    eta2: f64,
    /// Square of the kernel's support, m².
    reach2: f64,
}

impl<K, T, W> Gather<K, T, W> {
    /// The sweep in water of the given constants.
    pub fn new<const D: usize>(kernel: K, inner: T, wall: W, medium: &Medium<D>) -> Self {
        Self { kernel, inner, wall, volume: medium.volume0(), eta2: medium.eta2(), reach2: (REACH * medium.h).powi(2) }
    }
}

/// The running sums of one particle.
struct Running<const D: usize> {
    dv: [f64; D],
    dx: f64,
    closing: f64,
    extra: Extra<f64, D>,
}

impl<K: Kernel, T, W> Gather<K, T, W> {
    /// Adds the share of neighbour `b` to `sum` by the laws `term`.
    #[inline(always)]
    fn add<const D: usize, L: Term<f64, D>>(
        &self,
        term: &L,
        a: (&Node<D>, &[[f64; D]; D]),
        b: (&Node<D>, &[[f64; D]; D]),
        sum: &mut Running<D>,
    ) {
        let r_ab: [f64; D] = std::array::from_fn(|i| a.0.r[i] - b.0.r[i]);
        let v_ab: [f64; D] = std::array::from_fn(|i| a.0.v[i] - b.0.v[i]);
        let r2: f64 = r_ab.iter().map(|x| x * x).sum();
        // The lists look further than the kernel: a quarter of their entries end here.
        if r2 >= self.reach2 {
            return;
        }
        let factor = self.volume * self.kernel.slope(r2);
        let side = |(node, stress): (&Node<D>, &[[f64; D]; D])| -> Side<f64, D> { node.side(*stress) };
        let ab = Pair::new(r_ab, v_ab, r2, self.kernel.w(r2), self.eta2, side(a), side(b));
        let along_r = term.along_r(&ab, 0.0);
        let along_v = term.along_v(&ab, 0.0);
        let vector = term.vector(&ab, [0.0; D]);
        for i in 0..D {
            sum.dv[i] += factor * (along_r * r_ab[i] + along_v * v_ab[i] + vector[i]);
        }
        sum.dx += factor * term.rate(&ab, (0.0, 0.0)).0;
        sum.closing = sum.closing.max(ab.vr.abs() * ab.inv_r2);
        if L::EXTRA {
            term.extra(&ab, factor, &mut sum.extra, &mut Extra::zero());
        }
    }
}

impl<const D: usize> Running<D> {
    #[inline(always)]
    fn zero() -> Self {
        Self { dv: [0.0; D], dx: 0.0, closing: 0.0, extra: Extra::zero() }
    }

    #[inline(always)]
    fn sums(&self) -> Sums<D> {
        Sums { dv: Vector::from(self.dv), dx: self.dx, closing: self.closing }
    }
}

fn rows<const D: usize>(m: &Matrix<D>) -> [[f64; D]; D] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

impl<const D: usize, K: Kernel, T: Term<f64, D>, W: Term<f64, D>> Sweep<D> for Gather<K, T, W> {
    fn extra(&self) -> bool {
        T::EXTRA
    }

    fn water(&self, input: &Input<'_, D>, chunk: usize, sums: &mut [Sums<D>], extra: &mut [Extra<f64, D>]) {
        let none = [[0.0; D]; D];
        let stress = |i: usize| if T::STRESS { rows(&input.stress[i]) } else { none };
        let (first, lists) = (chunk * CHUNK, &input.lists.water[chunk]);
        for (i, out) in sums.iter_mut().enumerate() {
            let (water, skin) = lists.of(i);
            let a = &input.water[first + i];
            let stress_a = stress(first + i);
            let mut sum = Running::zero();
            for &j in water {
                let j = j as usize;
                self.add(&self.inner, (a, &stress_a), (&input.water[j], &stress(j)), &mut sum);
            }
            for &j in skin {
                self.add(&self.wall, (a, &stress_a), (&input.skin[j as usize], &none), &mut sum);
            }
            *out = sum.sums();
            if T::EXTRA {
                extra[i] = sum.extra;
            }
        }
    }

    fn skin(&self, input: &Input<'_, D>, chunk: usize, sums: &mut [Sums<D>]) {
        let none = [[0.0; D]; D];
        let (first, lists) = (chunk * CHUNK, &input.lists.skin[chunk]);
        for (i, out) in sums.iter_mut().enumerate() {
            let (water, _) = lists.of(i);
            let a = &input.skin[first + i];
            let mut sum = Running::zero();
            for &j in water {
                let j = j as usize;
                let stress = if W::STRESS { rows(&input.stress[j]) } else { none };
                self.add(&self.wall, (a, &none), (&input.water[j], &stress), &mut sum);
            }
            *out = sum.sums();
        }
    }
}
