//! The arithmetic-geometric mean and Carlson's R_F in lanes, by the steps of `andoyer-double`.
//!
//! A lane that has converged keeps its numbers while the others go on, so that no lane depends on its neighbours.

use super::double_double_lanes::DoubleDoubleLanes;
use super::instruction_set::InstructionSet;
use super::lanes::Lanes;

/// Most steps of a mean: 1e-300 takes 15.
const MOST_STEPS: usize = 24;
/// Relative difference below which the two means of doubles, and of double-doubles, agree to rounding error.
const EQUAL_MEANS: [f64; 2] = [1e-8, 1e-17];
/// Relative spread of the arguments of R_F below which the series is summed.
const SPREAD: f64 = 3e-3;
/// Most steps of R_F.
const MOST_DUPLICATIONS: usize = 600;

/// The arithmetic-geometric means of two pairs a > 0 and b ≥ 0; 0 if b is 0. Each pair waits for the divisions and roots of the other.
#[inline(always)]
pub(crate) fn means<S: InstructionSet>(mut a: [Lanes<S>; 2], mut b: [Lanes<S>; 2]) -> [Lanes<S>; 2] {
    let (half, close) = (a[0].all(0.5), a[0].all(EQUAL_MEANS[0]));
    let mut found = b;
    let mut apart = a;
    for _ in 0..MOST_STEPS {
        for i in 0..2 {
            apart[i] = (a[i] - b[i]).magnitude() - a[i] * close;
        }
        if !(apart[0].any_above_zero() || apart[1].any_above_zero()) {
            break;
        }
        for i in 0..2 {
            let (arithmetic, geometric) = ((a[i] + b[i]) * half, (a[i] * b[i]).root());
            (a[i], b[i]) = (apart[i].up_to(0.0, a[i], arithmetic), apart[i].up_to(0.0, b[i], geometric));
        }
    }
    for i in 0..2 {
        found[i] = found[i].up_to(0.0, found[i], (a[i] + b[i]) * half);
    }
    found
}

/// The arithmetic-geometric mean of two positive double-doubles.
#[inline(always)]
pub(crate) fn precise_mean<S: InstructionSet>(
    mut a: DoubleDoubleLanes<S>,
    mut b: DoubleDoubleLanes<S>,
) -> DoubleDoubleLanes<S> {
    let half = a.high.all(0.5);
    for _ in 0..MOST_STEPS {
        let first = a.nearest();
        let apart = (first - b.nearest()).magnitude() - first * half.all(EQUAL_MEANS[1]);
        if !apart.any_above_zero() {
            break;
        }
        let (arithmetic, geometric) = ((a + b).times(half), (a * b).root());
        a = DoubleDoubleLanes::up_to_zero(apart, a, arithmetic);
        b = DoubleDoubleLanes::up_to_zero(apart, b, geometric);
    }
    (a + b).times(half)
}

/// R_F(x, y, z) for two triples of arguments ≥ 0, of which at most one is 0. Each triple waits for the roots of the other.
#[inline(always)]
pub(crate) fn carlson_rf<S: InstructionSet>(mut triples: [[Lanes<S>; 3]; 2]) -> [Lanes<S>; 2] {
    let [x, _, _] = triples[0];
    let (third, quarter, spread) = (x.all(1.0 / 3.0), x.all(0.25), x.all(SPREAD));
    let mut mean = [x; 2];
    let mut apart = mean;
    for (mean, [x, y, z]) in mean.iter_mut().zip(triples) {
        *mean = (x + y + z) * third;
    }
    for _ in 0..MOST_DUPLICATIONS {
        for i in 0..2 {
            let ([x, y, z], mean) = (triples[i], mean[i]);
            let most = (x - mean).magnitude().largest(y - mean).largest(z - mean);
            apart[i] = most - mean * spread;
        }
        if !(apart[0].any_above_zero() || apart[1].any_above_zero()) {
            break;
        }
        for i in 0..2 {
            let ([x, y, z], apart) = (triples[i], apart[i]);
            let (rx, ry, rz) = (x.root(), y.root(), z.root());
            let lambda = rx * (ry + rz) + ry * rz;
            let [x, y, z] = [
                apart.up_to(0.0, x, (x + lambda) * quarter),
                apart.up_to(0.0, y, (y + lambda) * quarter),
                apart.up_to(0.0, z, (z + lambda) * quarter),
            ];
            triples[i] = [x, y, z];
            mean[i] = (x + y + z) * third;
        }
    }
    let mut found = mean;
    for (found, [x, y, _]) in found.iter_mut().zip(triples) {
        let mean = *found;
        let inverse = mean.reciprocal();
        let (u, v) = ((mean - x) * inverse, (mean - y) * inverse);
        *found = (x.all(1.0) + beyond_one(u, v)) / mean.root();
    }
    found
}

/// Carlson's series for R_F times the square root of the mean, minus 1, through order 7 in the spread.
#[inline(always)]
fn beyond_one<S: InstructionSet>(u: Lanes<S>, v: Lanes<S>) -> Lanes<S> {
    let w = -(u + v);
    let (e2, e3) = (u * v - w * w, u * v * w);
    let by = |divisor: f64| u.all(1.0 / divisor);
    e3 * by(14.0) - e2 * by(10.0) + e2 * e2 * by(24.0) - e2 * e3 * by(44.0 / 3.0) - e2 * e2 * e2 * by(208.0 / 5.0)
        + e3 * e3 * by(104.0 / 3.0)
        + e2 * e2 * e3 * by(16.0)
}

#[cfg(test)]
mod tests {
    use andoyer_double::{DoubleDouble, arithmetic_geometric_mean};
    use pulp::Arch;

    use super::*;
    use crate::simd::instruction_set::{Task, dispatch};
    use crate::simd::lanes::WIDEST;

    /// Mean of 1 and a number, the same in double-double, and R_F(x, ½ + x, 1), from numbers in lanes.
    struct Functions([f64; WIDEST]);

    impl Task for Functions {
        type Output = Vec<(f64, DoubleDouble, f64)>;

        #[inline(always)]
        fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
            let mut found = Vec::new();
            for start in (0..WIDEST).step_by(Lanes::<S>::WIDTH) {
                let x = Lanes::load(simd, &self.0[start..]);
                let one = x.all(1.0);
                // The other one of each pair converges at once.
                let [means, _] = means([one; 2], [x, one]);
                let exact = |high: Lanes<S>| DoubleDoubleLanes { high, low: high.all(0.0) };
                let precise = precise_mean(exact(one), exact(x));
                let [_, integrals] = carlson_rf([[one; 3], [x, x + x.all(0.5), one]]);
                for lane in 0..Lanes::<S>::WIDTH {
                    found.push((means.values()[lane], precise.lane(lane), integrals.values()[lane]));
                }
            }
            found
        }
    }

    const NUMBERS: [f64; WIDEST] =
        [1.0, 0.999, 0.5, 0.3, 0.1, 1e-2, 1e-3, 1e-5, 1e-8, 1e-12, 1e-20, 1e-50, 1e-100, 1e-150, 0.7, 0.9];

    #[test]
    fn lanes_have_the_means_and_integrals_of_single_numbers() {
        for (x, (mean, precise, integral)) in NUMBERS.into_iter().zip(dispatch(Arch::new(), Functions(NUMBERS))) {
            assert!((mean / arithmetic_geometric_mean(1.0, x) - 1.0).abs() <= 4.0 * f64::EPSILON, "{x}");
            let exact = arithmetic_geometric_mean(DoubleDouble::ONE, DoubleDouble::from(x));
            assert!(((precise - exact) / exact).to_f64().abs() <= 1e-30, "{x}");
            let exact = andoyer_double::carlson_rf(x, x + 0.5, 1.0);
            assert!((integral / exact - 1.0).abs() <= 4.0 * f64::EPSILON, "{x}");
        }
    }

    #[test]
    fn a_lane_does_not_depend_on_its_neighbours() {
        let together = dispatch(Arch::new(), Functions(NUMBERS));
        for (x, expected) in NUMBERS.into_iter().zip(together) {
            assert!(dispatch(Arch::new(), Functions([x; WIDEST])).into_iter().all(|found| found == expected), "{x}");
        }
    }
}
