//! Solutions of the averaged equations as polynomials on an interval, by Picard's iteration on Chebyshev points.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::Quaternion;

use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::{Lanes, WIDEST};

/// Chebyshev points in an interval: whole vectors of every width. With degree 15 the interpolation error in a quarter of the orbit is 1e-15 κ_o for cos 2f, and
/// 7e-13 e κ_o for cos 3f, and about 3e-9 (κ_o(1 + e))⁴ for the powers of κ_o.
pub(crate) const POINTS: usize = WIDEST;
/// Largest number of Picard iterations. Each one multiplies the error by about κ_o, which `draft::FASTEST_PRECESSION` bounds; 16 is the most seen.
const MOST_ITERATIONS: usize = 40;
/// Smaller coefficients are dropped.
const NEGLIGIBLE: f64 = 1e-17;

/// Frame (quaternion x, y, z, w), and two numbers: the phase integral Ψ twice, or the drifts of ℓ′ and y′.
pub(crate) type Column = [f64; COLUMNS];
/// Components of a column.
pub(crate) const COLUMNS: usize = 6;
/// Those of the frame.
const FRAME: usize = 4;

/// The Chebyshev points, from −1 to 1.
pub(crate) static NODES: LazyLock<[f64; POINTS]> =
    LazyLock::new(|| std::array::from_fn(|i| (PI * (i as f64 + 0.5) / POINTS as f64).cos()));
/// The coefficients of a primitive for a function that is 1 at one of the points and 0 at the others, by the point.
static PRIMITIVES: LazyLock<[[f64; POINTS]; POINTS]> = LazyLock::new(|| std::array::from_fn(primitive));
/// The values of these primitives at the points, by the point of the value.
static VALUES: LazyLock<[[f64; POINTS]; POINTS]> =
    LazyLock::new(|| std::array::from_fn(|i| PRIMITIVES.each_ref().map(|primitive| sum(primitive, NODES[i]))));
/// The values of the primitives at the ends of the interval, −1 and 1.
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

/// A Chebyshev series by Clenshaw's rule.
fn sum(coefficients: &[f64; POINTS], x: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for coefficient in coefficients[1..].iter().rev() {
        (next, after) = (2.0 * x * next + coefficient - after, next);
    }
    x * next + coefficients[0] - after
}

/// A number for each point.
pub(crate) type AtPoints = [f64; POINTS];

/// [`PRIMITIVES`] and the transposed [`VALUES`] in rows, by the point of the function.
static ROWS: LazyLock<[[AtPoints; POINTS]; 2]> = LazyLock::new(|| {
    let values = |k: usize| VALUES.each_ref().map(|at| at[k]);
    [*PRIMITIVES, std::array::from_fn(values)]
});

/// Averaged equations on an interval.
pub(crate) trait AveragedEquations {
    /// The derivatives at the points from `first` on, for the frames there.
    fn at<S: InstructionSet>(&self, first: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS];
}

/// Equations that are computed point by point, from the number of the point and the frame there.
pub(crate) struct PointByPoint<F>(pub(crate) F);

impl<F: Fn(usize, &Quaternion<f64>) -> Column> AveragedEquations for PointByPoint<F> {
    #[inline(always)]
    fn at<S: InstructionSet>(&self, first: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS] {
        let like = frame.0[0];
        let mut columns = [[0.0; WIDEST]; COLUMNS];
        for lane in 0..Lanes::<S>::WIDTH {
            let [x, y, z, w] = &frame.0;
            let [x, y, z, w] = [x.values()[lane], y.values()[lane], z.values()[lane], w.values()[lane]];
            let slopes = self.0(first + lane, &Quaternion::new(w, x, y, z));
            for (column, slope) in columns.iter_mut().zip(slopes) {
                column[lane] = slope;
            }
        }
        let mut slopes = [like; COLUMNS];
        for (slope, column) in slopes.iter_mut().zip(&columns) {
            *slope = like.like(column);
        }
        slopes
    }
}

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
        let [nodes, at_nodes] = &*ROWS;
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
        coefficients(simd, nodes, &slopes, &constant)
    }
}

/// The primitives of the points' functions at a place of the interval.
fn primitives_at(place: f64) -> AtPoints {
    if place == -1.0 {
        ENDS[0]
    } else if place == 1.0 {
        ENDS[1]
    } else {
        PRIMITIVES.each_ref().map(|primitive| sum(primitive, place))
    }
}

/// The Chebyshev coefficients of a constant plus the primitive of the slopes, by column.
#[inline(always)]
fn coefficients<S: InstructionSet>(
    simd: S,
    nodes: &[AtPoints; POINTS],
    slopes: &[AtPoints; COLUMNS],
    constant: &Column,
) -> [AtPoints; COLUMNS] {
    let mut coefficients = [[0.0; POINTS]; COLUMNS];
    for first in (0..POINTS).step_by(Lanes::<S>::WIDTH) {
        let found = combined(simd, nodes, slopes, &[0.0; COLUMNS], first);
        for (column, found) in coefficients.iter_mut().zip(found) {
            found.store(&mut column[first..]);
        }
    }
    for (column, constant) in coefficients.iter_mut().zip(constant) {
        column[0] += constant;
    }
    coefficients
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

impl PiecePolynomial {
    /// The solution that passes through a column at a place of the interval, from −1 to 1. `half` is half the length of the interval.
    pub(crate) fn solved(half: f64, (place, start): (f64, &Column), equations: &impl AveragedEquations) -> Self {
        let columns = dispatch(pulp::Arch::new(), Solve { half, place, start, equations });
        Self::new(std::array::from_fn(|k| columns.each_ref().map(|column| column[k])))
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

    /// From the coefficients of a Chebyshev series. Its last terms are dropped if they are negligible, and it becomes a polynomial in x. The magnitudes of the
    /// new coefficients sum to at most six times the change in the interval (for e = 0.95), so that no digit is lost.
    fn new(series: [Column; POINTS]) -> Self {
        let something = |column: &Column| column.iter().any(|c| c.abs() > NEGLIGIBLE);
        let terms = series.iter().rposition(something).map_or(1, |last| last + 1);
        let mut coefficients = [[0.0; COLUMNS]; POINTS];
        for (k, (column, chebyshev)) in series[..terms].iter().zip(CHEBYSHEV.iter()).enumerate() {
            for power in (k % 2..=k).step_by(2) {
                for (sum, c) in coefficients[power].iter_mut().zip(column) {
                    *sum += chebyshev[power] * c;
                }
            }
        }
        Self { coefficients, terms }
    }
}
