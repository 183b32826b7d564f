//! Terms as traces: what a pair adds to the sums of its first particle, and a water particle to an extrapolation.
//!
//! Inputs of a pair: `r0`… and `v0`… (r_ab, v_ab), `difference` (x_b − x_a), `a_compression`, `a_pressure`, `a_volume` and the same of
//! b, `slope0`… (g/c₀²), `a_row0`… (the rows of additional inputs), and `sum0`…, the sums so far. Results: `sum0`…, and `approach`, the larger of the
//! input of that name and |v_ab·r_ab|/(r² + η²).

use super::{
    accumulators::{Accumulators, RequiredSums, for_each_auxiliary, for_each_symmetric_entry},
    boundary_sums,
    compiled::CompiledTerms,
    pair_contribution::PairContribution,
};
use crate::sph::{
    Num, PairGeometry, PairSide, Term,
    boundary::WallExtrapolation,
    kernel::Kernel,
    trace::{Recorder, Trace, Traced},
};

/// The traces of a pair loop.
#[derive(Clone, Debug)]
pub struct PairTraces {
    /// A pair of water particles.
    pub fluid: Trace,
    /// A pair of water and a boundary particle, the same for both.
    pub wall: Trace,
    /// What a water particle adds to the extrapolation to a boundary particle, with its velocity. Inputs: `r0`… (r_wf), `b_pressure`,
    /// `b_volume`, `v0`… (v_f), `sum0`…; results: `sum0`….
    pub extrapolation: Trace,
    /// V₀ ∂W: input `r2`, result `slope`.
    pub slope: Trace,
    /// The moments of the neighbours, if gradients are corrected: inputs and results as of a pair.
    pub moments: Option<[Trace; 2]>,
    /// Rows of additional inputs, and of sums.
    pub rows: [usize; 2],
    /// Where they lie.
    pub layout: RowLayout,
    /// Square of the kernel's support.
    pub reach2: f64,
}

/// The first rows of the additional inputs and of the sums that only some terms have.
#[derive(Clone, Copy, Debug)]
pub struct RowLayout {
    /// Input: marks of boundary particles.
    pub mark: Option<usize>,
    /// Input: tensile repulsion.
    pub repulsion: Option<usize>,
    /// Input: stress.
    pub stress: Option<usize>,
    /// Input: B − 1 of the corrected gradients.
    pub correction: Option<usize>,
    /// Sums: concentration gradient, then ∇·r.
    pub shift: Option<usize>,
    /// Sum: marks within the support.
    pub suppression: Option<usize>,
    /// Sums: strain rate.
    pub strain: Option<usize>,
}

impl RowLayout {
    /// The rows of terms with those `needs`.
    pub(super) fn new<const D: usize>(needs: RequiredSums) -> Self {
        let some = |has: bool, row: usize| has.then_some(row);
        Self {
            mark: some(needs.suppression, 0),
            repulsion: some(needs.repulsion, needs.repulsion_row()),
            stress: some(needs.stress, needs.stress_row()),
            correction: some(needs.gradient_correction, needs.gradient_correction_row(D)),
            shift: some(needs.shift, D + 1),
            suppression: some(needs.suppression, needs.held_at(D)),
            strain: some(needs.stress, needs.strain_at(D)),
        }
    }
}

/// A side of a pair, read as terms with needs `own` read it from the rows of terms with needs `all`.
fn side<'a, const D: usize>(
    recorder: &'a Recorder,
    who: &str,
    own: RequiredSums,
    all: RequiredSums,
) -> PairSide<Traced<'a>, D> {
    let input = |name: &str| recorder.input(&format!("{who}_{name}"));
    let (zero, none) = (recorder.constant(0.0), [[recorder.constant(0.0); D]; D]);
    let mut side = PairSide {
        compression: input("compression"),
        p: input("pressure"),
        specific_volume: input("volume"),
        repulsion: zero,
        shifting_suppressed: zero,
        stress: none,
        gradient_correction: none,
    };
    let mut row = |k: usize, x: &mut Traced<'a>| *x = input(&format!("row{k}"));
    if own.suppression {
        row(0, &mut side.shifting_suppressed);
    }
    if own.repulsion {
        row(all.repulsion_row(), &mut side.repulsion);
    }
    if own.stress {
        for_each_symmetric_entry(&mut side.stress, all.stress_row(), &mut row);
    }
    if own.gradient_correction {
        for_each_symmetric_entry(&mut side.gradient_correction, all.gradient_correction_row(D), &mut row);
    }
    side
}

/// The inputs of a pair.
struct PairInputs<'a, const D: usize> {
    geometry: PairGeometry<Traced<'a>, D>,
    sides: [PairSide<Traced<'a>, D>; 2],
    eta2: Traced<'a>,
    reach2: Traced<'a>,
    sums: Accumulators<Traced<'a>, D>,
    others: Accumulators<Traced<'a>, D>,
}

/// The inputs of terms with needs `own` among terms with needs `all`.
#[inline(never)]
fn inputs<const D: usize>(
    recorder: &Recorder,
    [own, all]: [RequiredSums; 2],
    [eta2, reach2]: [f64; 2],
) -> PairInputs<'_, D> {
    let input = |name: &str, k: usize| recorder.input(&format!("{name}{k}"));
    let r: [Traced; D] = std::array::from_fn(|k| input("r", k));
    let v: [Traced; D] = std::array::from_fn(|k| input("v", k));
    let geometry = (r, v, square(&r), recorder.input("difference"));
    let sides = [side(recorder, "a", own, all), side(recorder, "b", own, all)];
    let mut sums = Accumulators::filled_with(recorder.constant(0.0));
    let others = sums;
    sums.for_each_rate(|row, sum| *sum = input("sum", row));
    for_each_auxiliary(&mut sums.auxiliary, own, all, |row, sum| *sum = input("sum", row));
    let [eta2, reach2] = [eta2, reach2].map(|x| recorder.constant(x));
    PairInputs { geometry, sides, eta2, reach2, sums, others }
}

/// Makes the sums and the rate of approach the results.
#[inline(never)]
fn results<const D: usize>(
    recorder: &Recorder,
    [own, all]: [RequiredSums; 2],
    sums: &mut Accumulators<Traced, D>,
    approach: Traced,
) {
    recorder.result("approach", Num::max(recorder.input("approach"), approach));
    let mut result = |row: usize, sum: &mut Traced| recorder.result(&format!("sum{row}"), *sum);
    sums.for_each_rate(&mut result);
    for_each_auxiliary(&mut sums.auxiliary, own, all, &mut result);
}

/// The trace of a pair under the law `law`.
pub(super) fn pair<K: Kernel, T, W, L: Term<D>, const D: usize>(
    terms: &CompiledTerms<K, T, W>,
    law: &L,
    all: RequiredSums,
) -> Trace {
    let needs = [RequiredSums::of_terms::<L, D>(), all];
    Trace::record(&mut |recorder| {
        let PairInputs { geometry, sides, eta2, reach2, mut sums, mut others } =
            inputs(recorder, needs, [terms.eta2, terms.reach2]);
        let pair = PairContribution::new::<K, L, true>((&terms.kernel, law), geometry, eta2, sides[0], sides[1]);
        let approach = pair.approach_rate(reach2);
        pair.add_rates(&mut sums, &mut others);
        pair.add_auxiliary(law, &mut sums, &mut others);
        results(recorder, needs, &mut sums, approach);
    })
}

/// The trace of V₀ ∂W.
pub(super) fn slope<K: Kernel>(kernel: &K) -> Trace {
    Trace::record(&mut |recorder| recorder.result("slope", kernel.slope(recorder.input("r2"))))
}

/// The trace of an extrapolation.
pub(super) fn extrapolation<K: Kernel, const D: usize>(kernel: &K) -> Trace {
    Trace::record(&mut |recorder| {
        let input = |name: &str, k: usize| recorder.input(&format!("{name}{k}"));
        let r: [Traced; D] = std::array::from_fn(|k| input("r", k));
        let w = kernel.w(square(&r));
        let mut sums = WallExtrapolation::<Traced, D>::filled_with(recorder.constant(0.0));
        boundary_sums::for_each_row(&mut sums, true, |row, sum| *sum = input("sum", row));
        let volume = recorder.input("b_volume");
        sums.add(w, recorder.input("b_pressure"), volume, r);
        sums.add_velocity(w, volume, std::array::from_fn(|k| input("v", k)));
        boundary_sums::for_each_row(&mut sums, true, |row, sum| recorder.result(&format!("sum{row}"), *sum));
    })
}

fn square<'a, const D: usize>(r: &[Traced<'a>; D]) -> Traced<'a> {
    r[1..].iter().fold(r[0] * r[0], |sum, x| x.fma(*x, sum))
}
