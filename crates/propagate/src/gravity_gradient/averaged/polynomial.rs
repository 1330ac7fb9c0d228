//! Solutions of the averaged equations as polynomials on an interval, by Picard's iteration on Chebyshev points.

use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::gravity_gradient::constants::SMALLEST_POLYNOMIAL_COEFFICIENT;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::{Lanes, WIDEST};

/// Chebyshev points in an interval: whole vectors of every width. With degree 15 the interpolation error in a quarter of the orbit is 1e-15 κ_o for cos 2f, and
/// 7e-13 e κ_o for cos 3f, and about 3e-9 (κ_o(1 + e))⁴ for the powers of κ_o.
pub(crate) const POINTS: usize = WIDEST;
/// Largest number of Picard iterations. Each one multiplies the error by about κ_o, which `draft::FASTEST_PRECESSION` bounds; 16 is the most seen.
const MOST_ITERATIONS: usize = 40;

/// Frame (quaternion x, y, z, w), and two numbers: the phase integral Ψ twice, or the drifts of ℓ′ and y′.
pub(crate) type Column = [f64; COLUMNS];
/// Components of a column.
pub(crate) const COLUMNS: usize = 6;
/// Those of the frame.
const FRAME: usize = 4;

/// A number for each point.
pub(crate) type AtPoints = [f64; POINTS];

/// The Chebyshev points, from −1 to 1.
pub(crate) static NODES: LazyLock<AtPoints> =
    LazyLock::new(|| std::array::from_fn(|i| (PI * (i as f64 + 0.5) / POINTS as f64).cos()));
/// The Chebyshev coefficients of the primitive of the polynomial that is 1 at one point and 0 at the others, without the constant, by the point.
static PRIMITIVES: LazyLock<[AtPoints; POINTS]> = LazyLock::new(|| std::array::from_fn(primitive));
/// The values of these primitives at the points, by the point of the primitive.
static VALUES: LazyLock<[AtPoints; POINTS]> = LazyLock::new(|| {
    let at_nodes = NODES.map(primitives_at);
    std::array::from_fn(|point| at_nodes.map(|values| values[point]))
});

fn primitive(point: usize) -> AtPoints {
    let part = |k: usize| {
        let wave = (PI * k as f64 * (point as f64 + 0.5) / POINTS as f64).cos();
        if k < POINTS { 2.0 / POINTS as f64 * wave } else { 0.0 }
    };
    std::array::from_fn(|k| if k == 0 { 0.0 } else { (part(k - 1) - part(k + 1)) / (2.0 * k as f64) })
}

/// The values of the primitives at a place of the interval, by point.
fn primitives_at(place: f64) -> AtPoints {
    let mut chebyshev = [1.0, place].repeat(POINTS / 2);
    for k in 2..POINTS {
        chebyshev[k] = 2.0 * place * chebyshev[k - 1] - chebyshev[k - 2];
    }
    PRIMITIVES.each_ref().map(|primitive| primitive.iter().zip(&chebyshev).map(|(c, t)| c * t).sum())
}

/// The coefficients of the Chebyshev polynomials in powers of x.
static CHEBYSHEV: LazyLock<[AtPoints; POINTS]> = LazyLock::new(|| {
    let mut polynomials = [[0.0; POINTS]; POINTS];
    (polynomials[0][0], polynomials[1][1]) = (1.0, 1.0);
    for k in 2..POINTS {
        for power in 0..POINTS {
            let twice = if power > 0 { 2.0 * polynomials[k - 1][power - 1] } else { 0.0 };
            polynomials[k][power] = twice - polynomials[k - 2][power];
        }
    }
    polynomials
});

/// The coefficients of a polynomial in the place in one interval, from −1 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PiecePolynomial {
    coefficients: [Column; POINTS],
    terms: usize,
}

/// The iteration for the solution that passes through a column at a place of the interval.
struct Solve<'a, E> {
    half: f64,
    place: f64,
    start: &'a Column,
    equations: &'a E,
}

impl<E: AveragedEquations> Task for Solve<'_, E> {
    type Output = [AtPoints; COLUMNS];

    /// The Chebyshev coefficients, by column.
    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> [AtPoints; COLUMNS] {
        let Self { half, place, start, equations } = self;
        let (primitives, at_nodes) = (&*PRIMITIVES, &*VALUES);
        let at_place = primitives_at(place);
        let width = Lanes::<S>::WIDTH;
        let none = Lanes::splat(simd, 0.0);
        let mut values = [[0.0; POINTS]; COLUMNS];
        for (value, start) in values.iter_mut().zip(start) {
            *value = [*start; POINTS];
        }
        let mut constant = *start;
        let mut slopes = [[0.0; POINTS]; COLUMNS];
        let mut before = 0.0;
        for _ in 0..MOST_ITERATIONS {
            for first in (0..POINTS).step_by(width) {
                let mut frame = [none; FRAME];
                for (c, component) in frame.iter_mut().enumerate() {
                    *component = Lanes::load(simd, &values[c][first..]);
                }
                let found = equations.at(first, QuaternionLanes(frame));
                for (slope, found) in slopes.iter_mut().zip(found) {
                    (found * none.all(half)).store(&mut slope[first..]);
                }
            }
            for c in 0..COLUMNS {
                let mut offset = 0.0;
                for k in 0..POINTS {
                    offset += at_place[k] * slopes[c][k];
                }
                constant[c] = start[c] - offset;
            }
            let mut change = none;
            for first in (0..POINTS).step_by(width) {
                let next = combined(simd, at_nodes, &slopes, &constant, first);
                for (c, next) in next.into_iter().enumerate() {
                    if c < FRAME {
                        change = change.largest(next - Lanes::load(simd, &values[c][first..]));
                    }
                    next.store(&mut values[c][first..]);
                }
            }
            let change = change.values().iter().fold(0.0_f64, |most, &change| most.max(change));
            // Each iteration changes the frame by a smaller part of the last change. The next one is not computed if it would change the frame by less than rounding.
            if change <= 4.0 * f64::EPSILON || change * change <= f64::EPSILON * before {
                break;
            }
            before = change;
        }
        let mut series = [[0.0; POINTS]; COLUMNS];
        for first in (0..POINTS).step_by(width) {
            let found = combined(simd, primitives, &slopes, &[0.0; COLUMNS], first);
            for (column, found) in series.iter_mut().zip(found) {
                found.store(&mut column[first..]);
            }
        }
        for (column, constant) in series.iter_mut().zip(constant) {
            column[0] += constant;
        }
        series
    }
}

/// A constant plus Σ slope × row over the points, in each column, at the places from `first` on.
#[inline(always)]
fn combined<S: InstructionSet>(
    simd: S,
    rows: &[AtPoints; POINTS],
    slopes: &[AtPoints; COLUMNS],
    constant: &Column,
    first: usize,
) -> [Lanes<S>; COLUMNS] {
    let mut sums = Lanes::splats(simd, *constant);
    for (k, row) in rows.iter().enumerate() {
        let weight = Lanes::load(simd, &row[first..]);
        for (sum, slope) in sums.iter_mut().zip(slopes) {
            *sum = weight.mul_add(weight.all(slope[k]), *sum);
        }
    }
    sums
}

/// Averaged equations on an interval.
pub(crate) trait AveragedEquations {
    /// The derivatives at the points from `first` on, for the frames there.
    fn at<S: InstructionSet>(&self, first: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS];
}

impl PiecePolynomial {
    /// The solution that passes through a column at a place of the interval, from −1 to 1. `half` is half the length of the interval.
    pub(crate) fn solved(half: f64, (place, start): (f64, &Column), equations: &impl AveragedEquations) -> Self {
        let series = dispatch(pulp::Arch::new(), Solve { half, place, start, equations });
        // The last terms are dropped if they are negligible. The magnitudes of the coefficients of the powers of x sum to at most six times the change in the
        // interval (for e = 0.95), so that no digit is lost.
        let counts = |k: &usize| series.iter().any(|column| column[*k].abs() > SMALLEST_POLYNOMIAL_COEFFICIENT);
        let terms = (0..POINTS).rev().find(counts).map_or(1, |last| last + 1);
        let mut coefficients = [[0.0; COLUMNS]; POINTS];
        for (k, chebyshev) in CHEBYSHEV.iter().enumerate().take(terms) {
            for power in (k % 2..=k).step_by(2) {
                for (sum, column) in coefficients[power].iter_mut().zip(&series) {
                    *sum += chebyshev[power] * column[k];
                }
            }
        }
        Self { coefficients, terms }
    }

    /// The values at a place of the interval, by Horner's rule.
    #[inline(always)]
    pub(crate) fn sums<S: InstructionSet>(&self, x: Lanes<S>) -> [Lanes<S>; COLUMNS] {
        let mut sums = [x.all(0.0); COLUMNS];
        for coefficient in self.coefficients[..self.terms].iter().rev() {
            for (sum, coefficient) in sums.iter_mut().zip(coefficient) {
                *sum = sum.mul_add(x, x.all(*coefficient));
            }
        }
        sums
    }

    pub(crate) fn at(&self, x: f64) -> Column {
        self.sums(Lanes::splat(pulp::Scalar, x)).map(|lanes| lanes.values()[0])
    }
}
