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

/// Whether a lane is above 0; NaN is not.
#[inline(always)]
fn any_above_zero<S: InstructionSet>(place: Lanes<S>) -> bool {
    place.values().iter().any(|value| *value > 0.0)
}

/// The arithmetic-geometric mean of a > 0 and b ≥ 0; 0 if b is 0.
#[inline(always)]
pub(crate) fn mean<S: InstructionSet>(mut a: Lanes<S>, mut b: Lanes<S>) -> Lanes<S> {
    let half = a.all(0.5);
    let none = b;
    for _ in 0..MOST_STEPS {
        let apart = (a - b).magnitude() - a * a.all(EQUAL_MEANS[0]);
        if !any_above_zero(apart) {
            break;
        }
        let (arithmetic, geometric) = ((a + b) * half, (a * b).root());
        (a, b) = (apart.up_to(0.0, a, arithmetic), apart.up_to(0.0, b, geometric));
    }
    none.up_to(0.0, none, (a + b) * half)
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
        if !any_above_zero(apart) {
            break;
        }
        let (arithmetic, geometric) = ((a + b).times(half), (a * b).root());
        a = DoubleDoubleLanes::up_to_zero(apart, a, arithmetic);
        b = DoubleDoubleLanes::up_to_zero(apart, b, geometric);
    }
    (a + b).times(half)
}

/// R_F(x, y, z) for arguments ≥ 0, of which at most one is 0.
#[inline(always)]
pub(crate) fn carlson_rf<S: InstructionSet>(mut x: Lanes<S>, mut y: Lanes<S>, mut z: Lanes<S>) -> Lanes<S> {
    let (third, quarter) = (x.all(3.0), x.all(0.25));
    let mut mean = (x + y + z) / third;
    for _ in 0..MOST_DUPLICATIONS {
        let most = (x - mean).magnitude().largest(y - mean).largest(z - mean);
        let apart = most - mean * mean.all(SPREAD);
        if !any_above_zero(apart) {
            break;
        }
        let (rx, ry, rz) = (x.root(), y.root(), z.root());
        let lambda = rx * (ry + rz) + ry * rz;
        x = apart.up_to(0.0, x, (x + lambda) * quarter);
        y = apart.up_to(0.0, y, (y + lambda) * quarter);
        z = apart.up_to(0.0, z, (z + lambda) * quarter);
        mean = (x + y + z) / third;
    }
    let (u, v) = ((mean - x) / mean, (mean - y) / mean);
    (x.all(1.0) + beyond_one(u, v)) / mean.root()
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
                let means = mean(one, x);
                let precise = precise_mean(DoubleDoubleLanes::from_lanes(one), DoubleDoubleLanes::from_lanes(x));
                let integrals = carlson_rf(x, x + x.all(0.5), one);
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
