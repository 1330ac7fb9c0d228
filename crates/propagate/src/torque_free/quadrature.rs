//! The two means of theory §5 by the trapezoidal rule, several nodes at once.
//!
//! With tan ℓ = c tan φ and c² = √(Q1/Q2) the integrands are analytic in |Im φ| < atanh c, and n nodes in half a turn leave an error of e^(−2n atanh c). Unstretched the strip is
//! atanh c², and the nodes are many more. Sines and cosines of the nodes belong to their number alone and are computed once. Nodes that lie as many apart as the widest vectors have lanes
//! are summed together, so that all instruction sets with a fused multiply-add give the same bits.

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

/// ⟨1/(1+√Q)⟩_ℓ and ⟨1/(√Q(1+√Q))⟩_ℓ for 0 < Q1 ≤ Q2 and `stretch` = √(Q1/Q2); `count`, a multiple of the widest vectors, is half the number of nodes, and symmetry leaves that
/// many to compute.
pub(super) fn trapezoidal(
    [q1, q2]: [DoubleDouble; 2],
    stretch: DoubleDouble,
    count: usize,
) -> (DoubleDouble, DoubleDouble) {
    static TABLES: [OnceLock<Nodes>; KEPT] = [const { OnceLock::new() }; KEPT];
    let nodes = TABLES[count / WIDEST - 1].get_or_init(|| Nodes::new(count));
    let sums = dispatch(Arch::new(), Sums { nodes, values: [q1, q2 * stretch, stretch] });
    // cos2 and sin2 are twice the squares, so the weight carries ½ and the mean 2c/n.
    let factor = stretch.sqrt().over(0.5 * count as f64);
    (sums[0] * factor, sums[1] * factor)
}

/// Σ w/(1+√Q) and Σ w/(√Q(1+√Q)) over the nodes, with Q1, Q2 c² and c².
struct Sums<'a> {
    nodes: &'a Nodes,
    values: [DoubleDouble; 3],
}

impl Task for Sums<'_> {
    type Output = [DoubleDouble; 2];

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> [DoubleDouble; 2] {
        let Self { nodes: Nodes { cosines, sines }, values } = self;
        let width = Lanes::<S>::WIDTH;
        let [one, q1, q2, stretch] =
            [DoubleDouble::ONE, values[0], values[1], values[2]].map(|value| DoubleDoubleLanes::splat(simd, value));
        let mut totals = [DoubleDouble::ZERO; 2];
        let mut offset = 0;
        // Nodes that lie WIDEST apart are summed in lanes, then the lanes in their order: the same for vectors of any width.
        while offset < WIDEST {
            let zero = DoubleDoubleLanes::splat(simd, DoubleDouble::ZERO);
            let (mut by_anomaly, mut by_time) = (zero, zero);
            let mut start = offset;
            while start < cosines[0].len() {
                let range = start..start + width;
                let cosine = DoubleDoubleLanes::load(simd, &cosines[0][range.clone()], &cosines[1][range.clone()]);
                let sine = DoubleDoubleLanes::load(simd, &sines[0][range.clone()], &sines[1][range]);
                let weight = one / (cosine + stretch * sine);
                let root = ((q1 * cosine + q2 * sine) * weight).root();
                let term = weight / (one + root);
                by_anomaly = by_anomaly + term;
                by_time = by_time + term / root;
                start += WIDEST;
            }
            for lane in 0..width {
                totals[0] = totals[0] + by_anomaly.lane(lane);
                totals[1] = totals[1] + by_time.lane(lane);
            }
            offset += width;
        }
        totals
    }
}
