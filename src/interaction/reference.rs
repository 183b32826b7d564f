//! The f64 oracle: each particle gathers its own neighbours in stored order, so that the bits depend on
//! neither threads nor chunks.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::{
    Input, Output, Peaks, Sums, Sweep,
    accumulators::{Needs, Running},
    boundary_sums::Fits,
    compiled::{Compiled, Laws},
};
use crate::{
    math::{Matrix, Vector},
    neighbours::{CHUNK, Chunk, Pairs},
    particles::{PER_TASK, Particles},
    sph::{Extra, Pair, Side, Term, boundary::Fit, kernel::Kernel, pressure::repulsion},
};

/// The oracle with its laws.
pub(super) struct Gather<const D: usize> {
    laws: Box<dyn Laws<D>>,
    fits: Box<dyn Fits<D>>,
    nodes: [Vec<Node<D>>; 2],
    spent: Duration,
}

/// A particle as a pair needs it, packed together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<const D: usize> {
    pub(super) r: [f64; D],
    pub(super) v: [f64; D],
    pub(super) side: Side<f64, D>,
}

impl<const D: usize> Gather<D> {
    /// The oracle of those laws, made in SI.
    pub(super) fn new(laws: Box<dyn Laws<D>>, fits: Box<dyn Fits<D>>) -> Self {
        Self { laws, fits, nodes: [Vec::new(), Vec::new()], spent: Duration::ZERO }
    }
}

/// Adds the share of neighbour `b` to `sum` by the law `law`; gives |v_ab·r_ab|/(r² + η²).
#[inline(always)]
fn add<K: Kernel, T, W, L: Term<D>, const D: usize>(
    laws: &Compiled<K, T, W>,
    law: &L,
    a: &Node<D>,
    b: &Node<D>,
    sum: &mut Running<f64, D>,
) -> f64 {
    let r_ab: [f64; D] = std::array::from_fn(|i| a.r[i] - b.r[i]);
    let v_ab: [f64; D] = std::array::from_fn(|i| a.v[i] - b.v[i]);
    let r2: f64 = r_ab.iter().map(|x| x * x).sum();
    // The lists look further than the kernel: a quarter of their entries end here.
    if r2 >= laws.reach2 {
        return 0.0;
    }
    let factor = laws.kernel.slope(r2);
    let ab = Pair::new(r_ab, v_ab, r2, laws.kernel.w(r2), laws.eta2, a.side, b.side);
    let along_r = law.along_r(&ab, 0.0);
    let along_v = if L::DRAG { law.along_v(&ab, 0.0) } else { 0.0 };
    for i in 0..D {
        sum.dv[i] += factor * if L::DRAG { along_r * r_ab[i] + along_v * v_ab[i] } else { along_r * r_ab[i] };
    }
    if L::VECTOR {
        for (dv, vector) in sum.dv.iter_mut().zip(law.vector(&ab, [0.0; D])) {
            *dv += factor * vector;
        }
    }
    sum.dx += factor * law.rate(&ab, (0.0, 0.0)).0;
    if L::EXTRA {
        law.extra(&ab, factor, &mut sum.extra, &mut Extra::all(0.0));
    }
    ab.vr.abs() * ab.inv_r2
}

pub(super) fn water<K: Kernel, T: Term<D>, W: Term<D>, const D: usize>(
    laws: &Compiled<K, T, W>,
    [water, skin]: [&[Node<D>]; 2],
    first: usize,
    lists: &Chunk,
    sums: &mut [Sums<D>],
    extra: &mut [Extra<f64, D>],
) -> f64 {
    let mut closing = 0.0f64;
    for (k, out) in sums.iter_mut().enumerate() {
        let (a, (among, beside)) = (&water[first + k], lists.of(k));
        let mut sum = Running::all(0.0);
        for &j in among {
            closing = closing.max(add(laws, &laws.inner, a, &water[j as usize], &mut sum));
        }
        for &j in beside {
            closing = closing.max(add(laws, &laws.wall, a, &skin[j as usize], &mut sum));
        }
        *out = Sums { dv: Vector::from(sum.dv), dx: sum.dx };
        if let Some(extra) = extra.get_mut(k) {
            *extra = sum.extra;
        }
    }
    closing
}

pub(super) fn skin<K: Kernel, T: Term<D>, W: Term<D>, const D: usize>(
    laws: &Compiled<K, T, W>,
    [water, skin]: [&[Node<D>]; 2],
    wet: &[u32],
    lists: &Chunk,
    sums: &mut [Sums<D>],
) {
    for (k, (out, &i)) in sums.iter_mut().zip(wet).enumerate() {
        let mut sum = Running::all(0.0);
        for &j in lists.of(k).0 {
            add(laws, &laws.wall, &skin[i as usize], &water[j as usize], &mut sum);
        }
        *out = Sums { dv: Vector::from(sum.dv), dx: sum.dx };
    }
}

fn rows<const D: usize>(m: &Matrix<D>) -> [[f64; D]; D] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

/// The particles as nodes.
fn nodes<const D: usize>(
    input: &Input<'_, D>,
    particles: &Particles<D>,
    v: &[Vector<D>],
    tensors: [&[Matrix<D>]; 2],
    marks: &[bool],
    needs: Needs,
    nodes: &mut Vec<Node<D>>,
) {
    let (rho0, [stress, forms]) = (input.medium.rho0, tensors);
    let tensor = |of: &[Matrix<D>], i: usize| of.get(i).map_or([[0.0; D]; D], rows);
    (0..particles.len())
        .into_par_iter()
        .with_min_len(PER_TASK)
        .map(|i| {
            let x = (particles.rho[i] - rho0) / rho0;
            let (p, s) = (input.state.pressure(x), 1.0 / (1.0 + x));
            let side = Side {
                x,
                low: 0.0,
                p,
                s,
                repulsion: if needs.repulsion { repulsion(p, s) } else { 0.0 },
                mark: marks.get(i).map_or(0.0, |&m| f64::from(u8::from(m))),
                stress: tensor(stress, i),
                form: tensor(forms, i),
            };
            Node { r: particles.r[i].into(), v: v[i].into(), side }
        })
        .collect_into_vec(nodes);
}

impl<const D: usize> Sweep<D> for Gather<D> {
    fn extra(&self) -> bool {
        self.laws.needs().any()
    }

    fn spent(&self) -> Duration {
        self.spent
    }

    fn fits(&mut self, input: &Input<'_, D>, flow: bool, fits: &mut [Fit<f64, D>]) {
        let Pairs::Lists(lists) = input.near.pairs() else { unreachable!("the oracle has lists of particles") };
        let needs = self.laws.needs();
        nodes(input, input.water, &input.water.v, [input.stress, input.forms], &[], needs, &mut self.nodes[0]);
        nodes(input, input.skin, input.shown, [&[], &[]], input.marks, needs, &mut self.nodes[1]);
        let start = Instant::now();
        let (sums, nodes) = (&self.fits, [&self.nodes[0][..], &self.nodes[1][..]]);
        let chunks = fits.par_chunks_mut(CHUNK).zip(input.near.wet().par_chunks(CHUNK)).zip(&lists.skin);
        chunks.for_each(|((fits, wet), chunk)| sums.skin(nodes, wet, chunk, flow, fits));
        self.spent += start.elapsed();
    }

    fn rates(&mut self, input: &Input<'_, D>, output: &mut Output<'_, D>) -> Peaks {
        let Pairs::Lists(lists) = input.near.pairs() else { unreachable!("the oracle has lists of particles") };
        let needs = self.laws.needs();
        nodes(input, input.water, &input.water.v, [input.stress, input.forms], &[], needs, &mut self.nodes[0]);
        nodes(input, input.skin, input.shown, [&[], &[]], input.marks, needs, &mut self.nodes[1]);
        let start = Instant::now();
        let (laws, nodes) = (&self.laws, [&self.nodes[0][..], &self.nodes[1][..]]);
        let g = input.medium.gravity;
        let one = |c: usize, sums: &mut [Sums<D>], extra: &mut [Extra<f64, D>]| {
            let closing = laws.water(nodes, c * CHUNK, &lists.water[c], sums, extra);
            let a2 = sums.iter_mut().map(|s| {
                s.dv += g;
                s.dv.norm_squared()
            });
            (a2.fold(0.0, f64::max), closing)
        };
        let larger = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.max(b.1));
        let chunks = output.water.par_chunks_mut(CHUNK).enumerate();
        let (a2, closing) = if output.extra.is_empty() {
            chunks.map(|(c, sums)| one(c, sums, &mut [])).reduce(|| (0.0, 0.0), larger)
        } else {
            let both = chunks.zip(output.extra.par_chunks_mut(CHUNK));
            both.map(|((c, sums), extra)| one(c, sums, extra)).reduce(|| (0.0, 0.0), larger)
        };
        let wet = input.near.wet().par_chunks(CHUNK);
        output
            .skin
            .par_chunks_mut(CHUNK)
            .zip(wet)
            .zip(&lists.skin)
            .for_each(|((sums, wet), chunk)| laws.skin(nodes, wet, chunk, sums));
        self.spent += start.elapsed();
        Peaks { acceleration: a2.sqrt(), closing }
    }
}
