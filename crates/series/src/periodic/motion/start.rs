//! A first frame, before Newton's iteration.
//!
//! The matrix Φ of solutions over the period of the first phase, with the mean of S over the other phases, has the Cayley transform (Φ − 1)(Φ + 1)⁻¹, which is
//! diagonalized as the matrix of a quadratic form. The exponents ω are known up to multiples of n; `branch` has the multiple.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use num_complex::Complex;
use num_traits::Zero;

use super::branch::continued;
use super::monodromy::monodromy;
use super::work::Going;
use crate::birkhoff::PhaseSpace;
use crate::birkhoff::diagonal::Diagonal;
use crate::birkhoff::matrix::{Matrix, transposed, turned_rows, unit};
use crate::birkhoff::mode::Mode;
use crate::birkhoff::schur::eigenvalues as spectrum;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::periodic::rows::grid::Grid;
use crate::periodic::rows::row::Periodic;
use crate::polynomial::Polynomial;

/// A double multiplier 1 or −1, to this distance or to the rounding errors of Φ, the second number times its largest entry, has no Cayley transform that floats diagonalize: Φ is turned
/// by the third number \[rad\], which Newton's iteration takes back.
const COINCIDENT: f64 = 1e-6;
const ROUNDED: f64 = 1e-14;
const NUDGE: f64 = 1e-5;
/// A mean below this part of the largest value is rounding.
const ROUNDING: f64 = 1e-14;
/// A frame: P, whose centres have the ratio 1, and the modes.
pub(super) type Frame = (Matrix<Periodic>, Vec<Mode<f64>>);

const WITHOUT_TURN: &str = "include a pair of 1 without two directions, or whose solutions do not turn";
const QUARTET: &str = "include a quartet off the unit circle: the motion is unstable";

/// A first frame: that of the mean over all phases but the first.
pub(super) fn start(
    grid: &Grid,
    second: &Matrix<Periodic>,
    of_one: impl FnOnce(&Grid, &Matrix<Periodic>) -> Result<Frame, Error>,
) -> Result<Frame, Error> {
    // Rounding must not couple pairs: a mean that vanishes is exactly 0.
    let mean = |c: &Periodic| {
        let mean = grid.mean_over_others(c);
        if mean.size() > ROUNDING * c.size() { mean } else { Periodic::zero() }
    };
    let over = |row: &Vec<Periodic>| row.iter().map(mean).collect();
    let (change, modes) = of_one(&grid.first(), &second.iter().map(over).collect())?;
    Ok((change.iter().map(|row| row.iter().map(|c| grid.extended(c)).collect()).collect(), modes))
}

/// The modes of the mean.
fn undriven(second: &Matrix<Periodic>) -> Result<Diagonal<f64>, Error> {
    let mean = |c: &Periodic| Some(c.mean().re).filter(|mean| mean.abs() > ROUNDING * c.size()).unwrap_or(0.0);
    diagonal(&second.iter().map(|row| row.iter().map(mean).collect()).collect::<Vec<_>>())
}

/// The frame of the mean.
pub(super) fn still(second: &Matrix<Periodic>) -> Result<Frame, Error> {
    let (columns, modes) = columns(&undriven(second)?)?;
    let row = |row: usize| columns.iter().map(|column| Periodic::Constant(column[row])).collect();
    Ok(((0..second.len()).map(row).collect(), modes))
}

/// A first frame with one phase or none.
pub(super) fn start_of_one(grid: &Grid, second: &Matrix<Periodic>, going: &mut Going<'_>) -> Result<Frame, Error> {
    let n = second.len();
    if grid.phases() == 0 {
        return still(second);
    }
    let (rate, course) = (grid.rates()[0], monodromy(grid, second, going)?);
    let period = 2.0 * PI / rate;
    let multipliers = multipliers_by_pairs(&course[grid.times()]);
    let unsupported = |problem| {
        let multipliers = multipliers.iter().map(|c| [c.re, c.im]).collect();
        Error::MultiplierUnsupported { multipliers, problem }
    };
    let nudged = coincide(&course[grid.times()]);
    let last = &course[grid.times()] * turn(if nudged { NUDGE } else { 0.0 }, n);
    let one = DMatrix::<f64>::identity(n, n);
    let inverse =
        (&last + &one).try_inverse().ok_or_else(|| unsupported("are −1, and no frame of this period exists"))?;
    let cayley = (&last - &one) * inverse;
    // A = −J C, without what rounding leaves of its antisymmetric part.
    let rows: Matrix<f64> = (0..n).map(|i| (0..n).map(|j| cayley[(i, j)]).collect()).collect();
    let turned: Matrix<f64> = turned_rows(&rows).into_iter().map(|row| row.iter().map(|c| -c).collect()).collect();
    let form = (0..n).map(|i| (0..n).map(|j| 0.5 * (turned[i][j] + turned[j][i])).collect()).collect::<Vec<_>>();
    let found = diagonal(&form).map_err(|_| unsupported(WITHOUT_TURN))?;
    if found.modes.iter().any(|mode| matches!(mode, Mode::Complex { .. })) {
        return Err(unsupported(QUARTET));
    }
    let (mut columns, mut modes) = columns(&found)?;
    if !from_tangents(&mut columns, &mut modes, period) {
        return Err(unsupported("are negative: the motion is unstable, and no real frame of this period exists"));
    }
    let eigenvalues: Vec<_> = modes.iter().flat_map(eigenvalues).collect();
    let along = |(column, &lambda): (&Vec<_>, &Complex<f64>)| carried(grid, &course, column, lambda);
    let columns = columns.iter().zip(&eigenvalues).map(along).collect();
    let planes = undriven(second).map_or_else(|_| unit(n), |mean| mean.matrix);
    let (columns, modes) = continued(grid, columns, modes, &planes);
    if nudged && modes.iter().any(|mode| mode.frequency().norm() * period.abs() < 2.0 * NUDGE) {
        return Err(unsupported(WITHOUT_TURN));
    }
    Ok((transposed(&columns), modes))
}

/// The multipliers; those of a first pair that nothing couples to the others come first.
fn multipliers_by_pairs(last: &DMatrix<f64>) -> Vec<Complex<f64>> {
    let n = last.nrows();
    let apart = (2..n).all(|j| (0..2).all(|i| last[(i, j)] == 0.0 && last[(j, i)] == 0.0));
    if n == 2 || !apart {
        return spectrum(last).unwrap_or_default();
    }
    let blocks = [last.view((0, 0), (2, 2)), last.view((2, 2), (n - 2, n - 2))];
    blocks.iter().flat_map(|block| spectrum(&block.clone_owned()).unwrap_or_default()).collect()
}

/// Φ(M) c e^{−λ t}, which is periodic, for a column c of the exponent λ.
fn carried(grid: &Grid, course: &[DMatrix<f64>], column: &[Complex<f64>], lambda: Complex<f64>) -> Vec<Periodic> {
    let (times, period) = (grid.times(), 2.0 * PI / grid.rates()[0]);
    let value = |row: usize, at: usize| {
        let time = at as f64 * period / times as f64;
        let sum: Complex<f64> = column.iter().enumerate().map(|(k, c)| c * course[at][(row, k)]).sum();
        sum * (-lambda * time).exp()
    };
    let entry = |row: usize| Periodic::of(&(0..times).map(|at| value(row, at)).collect::<Vec<_>>());
    (0..column.len()).map(entry).collect()
}

/// Whether Φ has a double multiplier 1 or −1 with two directions.
fn coincide(last: &DMatrix<f64>) -> bool {
    let n = last.nrows();
    let near = |sign: f64| {
        let values = (last - DMatrix::identity(n, n) * sign).singular_values();
        values.iter().filter(|&&value| value < COINCIDENT.max(ROUNDED * last.amax())).count() > 1
    };
    near(1.0) || near(-1.0)
}

/// A rotation of every pair by a small angle.
fn turn(angle: f64, n: usize) -> DMatrix<f64> {
    let entry = |i: usize, j: usize| match (i == j, i ^ 1 == j) {
        (true, _) => angle.cos(),
        (_, true) => {
            if i < j {
                angle.sin()
            } else {
                -angle.sin()
            }
        }
        _ => 0.0,
    };
    DMatrix::from_fn(n, n, entry)
}

/// Exponents for the frequencies of the form, which are the tangents of half the angles over a period; false for a negative multiplier.
fn from_tangents(columns: &mut [Vec<Complex<f64>>], modes: &mut [Mode<f64>], period: f64) -> bool {
    for (number, mode) in modes.iter_mut().enumerate() {
        match mode {
            Mode::Elliptic { frequency, .. } => *frequency = 2.0 * frequency.atan() / period,
            Mode::Hyperbolic { rate } if *rate < 1.0 => {
                *rate = 2.0 * rate.atanh() / period.abs();
                // With a phase that falls the directions change places: (q, p) becomes (p, −q).
                if period < 0.0 {
                    columns.swap(2 * number, 2 * number + 1);
                    columns[2 * number + 1].iter_mut().for_each(|c| *c = -*c);
                }
            }
            _ => return false,
        }
    }
    true
}

/// The modes of ½ zᵀ A z.
fn diagonal(matrix: &[Vec<f64>]) -> Result<Diagonal<f64>, Error> {
    const NAMES: [(&str, &str); 4] = [("q1", "p1"), ("q2", "p2"), ("q3", "p3"), ("q4", "p4")];
    let space = PhaseSpace::new(&NAMES[..matrix.len() / 2])?;
    let mut form = Polynomial::zero();
    for (i, row) in matrix.iter().enumerate() {
        for (j, c) in row.iter().enumerate().filter(|(_, c)| **c != 0.0) {
            let monomial = Monomial::ONE.with(i, 1)?;
            form.add_term(monomial.with(j, monomial.exponent(j) + 1)?, &(c / 2.0));
        }
    }
    Diagonal::of(&form, &space)
}

/// Columns of P at one time.
type Columns = Vec<Vec<Complex<f64>>>;

/// The eigenvalues of u and of U: −iω and iω.
pub(crate) fn eigenvalues(mode: &Mode<f64>) -> [Complex<f64>; 2] {
    let turned = Complex::<f64>::i() * mode.frequency();
    [-turned, turned]
}

/// The columns of u₁, U₁, … of modes, and the modes, with the ratio 1.
fn columns(diagonal: &Diagonal<f64>) -> Result<(Columns, Vec<Mode<f64>>), Error> {
    let column = |slot: usize| diagonal.matrix.iter().map(|row| row[slot]).collect::<Vec<_>>();
    let (mut all, mut modes) = (Vec::new(), Vec::new());
    for (mode, kind) in diagonal.modes.iter().enumerate() {
        let (q, p) = (column(2 * mode), column(2 * mode + 1));
        match kind {
            Mode::Elliptic { frequency, ratio } => {
                let root = ratio.sqrt();
                let u: Vec<_> = q.iter().zip(&p).map(|(q, p)| Complex::new(root * q, -p / root)).collect();
                all.push(u.clone());
                all.push(u.iter().map(|c| Complex::new(0.0, -0.5) * c.conj()).collect());
                modes.push(Mode::Elliptic { frequency: *frequency, ratio: 1.0 });
            }
            Mode::Hyperbolic { .. } => {
                all.extend([q, p].map(|column| column.iter().map(|&x| x.into()).collect::<Vec<_>>()));
                modes.push(kind.clone());
            }
            Mode::Complex { rate, frequency, .. } => {
                return Err(Error::MultiplierUnsupported { multipliers: vec![[*rate, *frequency]], problem: QUARTET });
            }
        }
    }
    Ok((all, modes))
}
