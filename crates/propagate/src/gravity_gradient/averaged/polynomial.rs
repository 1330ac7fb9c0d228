//! Solutions of the averaged equations as Chebyshev polynomials on an interval, by Picard's iteration.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::Quaternion;

use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// Chebyshev points in an interval. With degree 17 the interpolation error of cos 3f in a quarter of the orbit is 1e-15 of κ.
pub(super) const POINTS: usize = 18;
/// Largest number of Picard iterations. Each one multiplies the error by κ, which [`super::super::disturbed::STRONGEST`] bounds, so a dozen are enough.
const MOST_ITERATIONS: usize = 40;
/// Smaller coefficients are dropped.
const NEGLIGIBLE: f64 = 1e-17;

/// Frame (quaternion x, y, z, w), and what the drifts of ℓ′ and y′ are multiples of: J twice, or the drifts themselves.
pub(super) type Column = [f64; COLUMNS];
/// Components of a column.
pub(super) const COLUMNS: usize = 6;

/// The Chebyshev points, from −1 to 1.
pub(super) static NODES: LazyLock<[f64; POINTS]> =
    LazyLock::new(|| std::array::from_fn(|i| (PI * (i as f64 + 0.5) / POINTS as f64).cos()));
/// cos kθ at the points, by k.
static COSINES: LazyLock<[[f64; POINTS]; POINTS]> = LazyLock::new(|| {
    std::array::from_fn(|k| std::array::from_fn(|i| (PI * k as f64 * (i as f64 + 0.5) / POINTS as f64).cos()))
});

/// Chebyshev coefficients in one interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polynomial {
    coefficients: [Column; POINTS],
    terms: usize,
}

impl Polynomial {
    /// The solution that passes through a column at a place of the interval, from −1 to 1. `half` is half the length of the interval, and `slope` the
    /// derivative at one of the points for a frame.
    pub(super) fn solved(
        half: f64,
        (place, start): (f64, &Column),
        slope: impl Fn(usize, &Quaternion<f64>) -> Column,
    ) -> Self {
        let mut values = [*start; POINTS];
        let mut solution = Self { coefficients: [[0.0; COLUMNS]; POINTS], terms: POINTS };
        for _ in 0..MOST_ITERATIONS {
            let slopes: [Column; POINTS] = std::array::from_fn(|i| {
                let [x, y, z, w, ..] = values[i];
                slope(i, &Quaternion::new(w, x, y, z))
            });
            solution = Self::integral(&slopes, half);
            let offset = solution.at(place);
            for c in 0..COLUMNS {
                solution.coefficients[0][c] += start[c] - offset[c];
            }
            let mut change = 0.0_f64;
            for (value, &x) in values.iter_mut().zip(&*NODES) {
                let next = solution.at(x);
                change = (0..4).fold(change, |most, c| most.max((next[c] - value[c]).abs()));
                *value = next;
            }
            if change <= 4.0 * f64::EPSILON {
                break;
            }
        }
        solution.trimmed()
    }

    /// The primitive, up to a constant, of a function with the given values at the points.
    fn integral(slopes: &[Column; POINTS], half: f64) -> Self {
        let count = POINTS as f64;
        let mut series = [[0.0; COLUMNS]; POINTS + 1];
        for ((k, sum), cosines) in series.iter_mut().enumerate().zip(&*COSINES) {
            let scale = if k == 0 { 1.0 } else { 2.0 } / count * half;
            for (cosine, slope) in cosines.iter().zip(slopes) {
                let weight = scale * cosine;
                for c in 0..COLUMNS {
                    sum[c] += weight * slope[c];
                }
            }
        }
        let mut coefficients = [[0.0; COLUMNS]; POINTS];
        for k in 1..POINTS {
            let lower = if k == 1 { 2.0 } else { 1.0 };
            for c in 0..COLUMNS {
                coefficients[k][c] = (lower * series[k - 1][c] - series[k + 1][c]) / (2.0 * k as f64);
            }
        }
        Self { coefficients, terms: POINTS }
    }

    /// The sums of the Chebyshev series, by Clenshaw's rule.
    #[inline(always)]
    pub(super) fn sums<S: InstructionSet>(&self, x: Lanes<S>) -> [Lanes<S>; COLUMNS] {
        let twice = x + x;
        let (mut next, mut after) = ([x.all(0.0); COLUMNS], [x.all(0.0); COLUMNS]);
        for coefficient in self.coefficients[1..self.terms].iter().rev() {
            for c in 0..COLUMNS {
                (next[c], after[c]) = (twice.mul_add(next[c], x.all(coefficient[c]) - after[c]), next[c]);
            }
        }
        for c in 0..COLUMNS {
            next[c] = x.mul_add(next[c], x.all(self.coefficients[0][c]) - after[c]);
        }
        next
    }

    pub(super) fn at(&self, x: f64) -> Column {
        self.sums(Lanes::splat(pulp::Scalar, x)).map(|lanes| lanes.values()[0])
    }

    /// Drops the last terms if they are negligible.
    fn trimmed(mut self) -> Self {
        let something = |column: &Column| column.iter().any(|c| c.abs() > NEGLIGIBLE);
        self.terms = self.coefficients.iter().rposition(something).map_or(1, |last| last + 1);
        self
    }
}
