//! The two means of theory §5 by the trapezoidal rule, several nodes at once.
//!
//! With tan ℓ = c tan φ and c² = √(Q1/Q2) the integrands are analytic in |Im φ| < atanh c, and n nodes in half a turn leave an error of e^(−2n atanh c).
//! Unstretched the strip is atanh c², and the nodes are many more. Sines and cosines of the nodes belong to their number alone and are computed once. Nodes
//! that lie as many apart as the widest vectors have lanes are summed together, so that all instruction sets with a fused multiply-add give the same bits.

use std::sync::OnceLock;

use andoyer_double::DoubleDouble;
use pulp::Arch;

use crate::simd::double_double_lanes::DoubleDoubleLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::{Lanes, WIDEST};

/// Above this number of nodes in a quarter period the logarithmic sum is shorter.
const MOST_NODES: usize = 1000;
/// Numbers of nodes, as multiples of the widest vectors: the sines and cosines of all of them take 1 MB.
const KEPT: usize = MOST_NODES.div_ceil(WIDEST);

/// 2cos²φ and 2sin²φ at the nodes of a quarter period.
struct Nodes {
    cosines: [Vec<f64>; 2],
    sines: [Vec<f64>; 2],
}

impl Nodes {
    /// `count` nodes, an even number, at φ = (j + ½)π/2n: below π/4 by Taylor's series, above by symmetry.
    fn new(count: usize) -> Self {
        let mut nodes =
            Self { cosines: [vec![0.0; count], vec![0.0; count]], sines: [vec![0.0; count], vec![0.0; count]] };
        for place in 0..count / 2 {
            let (sine, cosine) = DoubleDouble::PI.times_double(place as f64 + 0.5).over(2.0 * count as f64).sin_cos();
            let [sine, cosine] = [sine, cosine].map(|value| (value * value).times_double(2.0));
            for (parts, below, above) in [(&mut nodes.cosines, cosine, sine), (&mut nodes.sines, sine, cosine)] {
                (parts[0][place], parts[1][place]) = (below.high, below.low);
                (parts[0][count - 1 - place], parts[1][count - 1 - place]) = (above.high, above.low);
            }
        }
        nodes
    }
}

/// The number of nodes that leaves 1e-33, a multiple of the widest vectors, if the rule is shorter than another.
pub(super) fn nodes(stretch: f64) -> Option<usize> {
    // Infinite for a circle, where two nodes are exact.
    let nodes = (76.0 / (4.0 * stretch.min(1.0).sqrt().atanh())).ceil().max(2.0);
    (nodes <= MOST_NODES as f64).then(|| (nodes as usize).next_multiple_of(WIDEST))
}

/// The means that are asked for: Q1, Q2 and √(Q1/Q2), 0 < Q1 ≤ Q2, and half the number of nodes, of which symmetry leaves as many to compute.
#[derive(Clone, Copy)]
pub(super) struct Means {
    pub(super) squares: [DoubleDouble; 2],
    pub(super) stretch: DoubleDouble,
    /// A multiple of the widest vectors, from [`nodes`].
    pub(super) count: usize,
}

/// ⟨1/(1+√Q)⟩_ℓ and ⟨1/(√Q(1+√Q))⟩_ℓ of at most as many as the widest vectors have lanes, written to as many places.
pub(super) fn trapezoidal(asked: &[Means], found: &mut [[DoubleDouble; 2]]) {
    static TABLES: [OnceLock<Nodes>; KEPT] = [const { OnceLock::new() }; KEPT];
    let table = |count: usize| TABLES[count / WIDEST - 1].get_or_init(|| Nodes::new(count));
    dispatch(Arch::new(), NodeSums { asked, table, found });
}

/// Sums over the nodes.
struct NodeSums<'a, T> {
    asked: &'a [Means],
    table: T,
    found: &'a mut [[DoubleDouble; 2]],
}

/// Partial sums of two means: high and low parts of each, by the lane of the widest vectors.
type Partial = [[[f64; WIDEST]; 2]; 2];

impl<T: Fn(usize) -> &'static Nodes> Task for NodeSums<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) {
        let Self { asked, table, found } = self;
        let alone = asked.len() == 1;
        let mut partial: Vec<Partial> = Vec::with_capacity(if alone { 0 } else { WIDEST });
        for means in asked {
            let sums = each_node(simd, means, table(means.count));
            if alone {
                found[0] = [folded(sums[0]), folded(sums[1])];
            } else {
                partial.push(sums);
            }
        }
        for start in (0..partial.len()).step_by(Lanes::<S>::WIDTH) {
            for which in 0..2 {
                let sum = total(simd, &partial[start..], which);
                for (lane, found) in found[start..].iter_mut().enumerate().take(Lanes::<S>::WIDTH) {
                    found[which] = sum.lane(lane);
                }
            }
        }
        for (found, means) in found.iter_mut().zip(asked) {
            // cos2 and sin2 are twice the squares, so the weight carries ½ and the mean 2c/n.
            let factor = means.stretch.sqrt().over(0.5 * means.count as f64);
            *found = [found[0] * factor, found[1] * factor];
        }
    }
}

/// The sums of one pair of means, of the nodes that lie as many apart as the widest vectors have lanes.
///
/// With s = cos² φ + c² sin² φ and r = s√Q the integrands are 1/(s + r) and s/(r(s + r)): one quotient gives both.
#[inline(always)]
fn each_node<S: InstructionSet>(simd: S, means: &Means, nodes: &Nodes) -> Partial {
    let Nodes { cosines, sines } = nodes;
    let [q1, q2] = means.squares;
    let (q1, q2) = (DoubleDoubleLanes::splat(simd, q1), DoubleDoubleLanes::splat(simd, q2 * means.stretch));
    let stretch = DoubleDoubleLanes::splat(simd, means.stretch);
    let width = Lanes::<S>::WIDTH;
    let mut partial = [[[0.0; WIDEST]; 2]; 2];
    let mut offset = 0;
    // The same for vectors of any width.
    while offset < WIDEST {
        let zero = DoubleDoubleLanes::splat(simd, DoubleDouble::ZERO);
        let (mut by_anomaly, mut by_time) = (zero, zero);
        let mut start = offset;
        while start < cosines[0].len() {
            let range = start..start + width;
            let cosine = DoubleDoubleLanes::load(simd, &cosines[0][range.clone()], &cosines[1][range.clone()]);
            let sine = DoubleDoubleLanes::load(simd, &sines[0][range.clone()], &sines[1][range]);
            // All terms are positive.
            let scale = cosine.plus_alike(stretch * sine);
            let root = ((q1 * cosine).plus_alike(q2 * sine) * scale).root();
            let quotient = (root * scale.plus_alike(root)).reciprocal();
            by_anomaly = by_anomaly.plus_alike(root * quotient);
            by_time = by_time.plus_alike(scale * quotient);
            start += WIDEST;
        }
        for (sums, sum) in partial.iter_mut().zip([by_anomaly, by_time]) {
            sums[0][offset..offset + width].copy_from_slice(sum.high.values());
            sums[1][offset..offset + width].copy_from_slice(sum.low.values());
        }
        offset += width;
    }
    partial
}

/// The sum of the partial sums of one mean, in pairs of lanes that lie half, a quarter, and so on, of the widest vectors apart.
#[inline(always)]
fn folded([high, low]: [[f64; WIDEST]; 2]) -> DoubleDouble {
    let mut sums = [DoubleDouble::ZERO; WIDEST];
    for (lane, sum) in sums.iter_mut().enumerate() {
        *sum = DoubleDouble { high: high[lane], low: low[lane] };
    }
    let mut half = WIDEST / 2;
    while half > 0 {
        for lane in 0..half {
            sums[lane] = sums[lane] + sums[lane + half];
        }
        half /= 2;
    }
    sums[0]
}

/// The same of as many means as there are lanes, to the same bits.
#[inline(always)]
fn total<S: InstructionSet>(simd: S, partial: &[Partial], which: usize) -> DoubleDoubleLanes<S> {
    let mut sums = [DoubleDoubleLanes::splat(simd, DoubleDouble::ZERO); WIDEST];
    for (lane, sum) in sums.iter_mut().enumerate() {
        let [mut high, mut low] = [[0.0; WIDEST]; 2];
        for (index, sums) in partial.iter().enumerate().take(Lanes::<S>::WIDTH) {
            (high[index], low[index]) = (sums[which][0][lane], sums[which][1][lane]);
        }
        *sum = DoubleDoubleLanes::load(simd, &high, &low);
    }
    let mut half = WIDEST / 2;
    while half > 0 {
        for lane in 0..half {
            sums[lane] = sums[lane] + sums[lane + half];
        }
        half /= 2;
    }
    sums[0]
}
