//! Solutions of the averaged equations as Chebyshev polynomials on an interval, by Picard's iteration.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::Quaternion;

use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// Chebyshev points in an interval. With degree 17 the interpolation error of cos 3f in a quarter of the orbit is 1e-15 of κ.
pub(super) const POINTS: usize = 18;
/// Largest number of Picard iterations. Each one multiplies the error by κ, which [`super::super::mean_motion::STRONGEST`] bounds, so a dozen are enough.
const MOST_ITERATIONS: usize = 40;
/// Smaller coefficients are dropped.
const NEGLIGIBLE: f64 = 1e-17;

/// Frame (quaternion x, y, z, w), and what the drifts of ℓ′ and y′ are multiples of: J twice, or the drifts themselves.
pub(super) type Column = [f64; COLUMNS];
/// Components of a column.
pub(super) const COLUMNS: usize = 6;
/// Those of the frame.
const FRAME: usize = 4;

/// The Chebyshev points, from −1 to 1.
pub(super) static NODES: LazyLock<[f64; POINTS]> =
    LazyLock::new(|| std::array::from_fn(|i| (PI * (i as f64 + 0.5) / POINTS as f64).cos()));
/// The coefficients of a primitive for a function that is 1 at one of the points and 0 at the others, by the point.
static PRIMITIVES: LazyLock<[[f64; POINTS]; POINTS]> = LazyLock::new(|| std::array::from_fn(primitive));
/// The values of these primitives at the points, by the point of the value.
static VALUES: LazyLock<[[f64; POINTS]; POINTS]> =
    LazyLock::new(|| std::array::from_fn(|i| PRIMITIVES.each_ref().map(|primitive| sum(primitive, NODES[i]))));
/// The same at the ends of the interval, −1 and 1.
static ENDS: LazyLock<[[f64; POINTS]; 2]> =
    LazyLock::new(|| [-1.0, 1.0].map(|end| PRIMITIVES.each_ref().map(|primitive| sum(primitive, end))));

/// The Chebyshev coefficients of the primitive for one point, without the constant.
fn primitive(point: usize) -> [f64; POINTS] {
    let count = POINTS as f64;
    let series: [f64; POINTS + 1] = std::array::from_fn(|k| {
        let scale = match k {
            0 => 1.0 / count,
            POINTS => 0.0,
            _ => 2.0 / count,
        };
        scale * (PI * k as f64 * (point as f64 + 0.5) / count).cos()
    });
    std::array::from_fn(|k| match k {
        0 => 0.0,
        1 => series[0] - 0.5 * series[2],
        _ => (series[k - 1] - series[k + 1]) / (2.0 * k as f64),
    })
}

/// A Chebyshev series by Clenshaw's rule.
fn sum(coefficients: &[f64; POINTS], x: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for coefficient in coefficients[1..].iter().rev() {
        (next, after) = (2.0 * x * next + coefficient - after, next);
    }
    x * next + coefficients[0] - after
}

/// Σ weight × slope.
fn weighted(weights: &[f64; POINTS], slopes: &[Column; POINTS]) -> Column {
    let mut sum = [0.0; COLUMNS];
    for (weight, slope) in weights.iter().zip(slopes) {
        for c in 0..COLUMNS {
            sum[c] += weight * slope[c];
        }
    }
    sum
}

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
        let (nodes, at_nodes) = (&*PRIMITIVES, &*VALUES);
        let at_place = match place {
            -1.0 => ENDS[0],
            1.0 => ENDS[1],
            place => nodes.each_ref().map(|primitive| sum(primitive, place)),
        };
        let mut values = [*start; POINTS];
        let mut constant = *start;
        let mut slopes = [[0.0; COLUMNS]; POINTS];
        for _ in 0..MOST_ITERATIONS {
            for (i, (value, found)) in values.iter().zip(&mut slopes).enumerate() {
                let [x, y, z, w, ..] = *value;
                *found = slope(i, &Quaternion::new(w, x, y, z)).map(|slope| half * slope);
            }
            let offset = weighted(&at_place, &slopes);
            constant = std::array::from_fn(|c| start[c] - offset[c]);
            let mut change = 0.0_f64;
            for (value, weights) in values.iter_mut().zip(at_nodes) {
                let integral = weighted(weights, &slopes);
                for c in 0..COLUMNS {
                    let next = constant[c] + integral[c];
                    if c < FRAME {
                        change = change.max((next - value[c]).abs());
                    }
                    value[c] = next;
                }
            }
            if change <= 4.0 * f64::EPSILON {
                break;
            }
        }
        let mut coefficients = [[0.0; COLUMNS]; POINTS];
        for (primitive, slope) in nodes.iter().zip(&slopes) {
            for (column, factor) in coefficients.iter_mut().zip(primitive) {
                for c in 0..COLUMNS {
                    column[c] += factor * slope[c];
                }
            }
        }
        for c in 0..COLUMNS {
            coefficients[0][c] += constant[c];
        }
        Self { coefficients, terms: POINTS }.trimmed()
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
