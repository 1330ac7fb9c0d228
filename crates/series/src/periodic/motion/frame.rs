//! Floquet's frame: the periodic change of variables that makes the motion about a periodic motion a constant one.
//!
//! ż = J S(M) z becomes ẇ = Λ w by z = P(M) w, symplectic and periodic, with a constant diagonal Λ: −iω for u and iω for U of a centre, ±λ for a saddle. A Newton step
//! P e^X solves n∂X − [Λ, X] = R with the part R of P⁻¹(J S P − n∂P) that is not Λ; in harmonics it is a division by i j·n minus a difference of eigenvalues.

use std::f64::consts::PI;

use num_complex::Complex;
use num_traits::Zero;

use super::start::{Frame, eigenvalues, start, start_of_one, still};
use super::work::{Going, ends, of_frame};
use crate::birkhoff::matrix::{Matrix, symplectic_inverse, turned_rows, unit};
use crate::birkhoff::mode::Mode;
use crate::error::Error;
use crate::periodic::rows::grid::Grid;
use crate::periodic::rows::row::{Periodic, product};

/// A step below this is rounding.
pub(super) const REACHED: f64 = 1e-14;
/// The iteration ends if step > `SLOWEST` · last step and both are below `SMALL`.
pub(super) const SLOWEST: f64 = 0.5;
pub(super) const SMALL: f64 = 1e-9;
/// A divisor below this part of the eigenvalue is a resonance, unless the harmonic is rounding: below the second number, in units of the largest frequency.
const RESONANT: f64 = 1e-10;
pub(super) const NOISE: f64 = 1e-12;
/// Most steps towards P, and their largest size.
const FRAMES: usize = 25;
const LARGEST: f64 = 0.3;
/// A step stalls below so many rounding errors of the frame: a division by a divisor below the rates of S enlarges them. Above the second number the frame is not found.
const STALLED: f64 = 1000.0;
const MOST_STALLED: f64 = 1e-4;

const UNREACHED: &str = "have no real frame that Newton's iteration reaches: two nearly coincide, or their exponents are in resonance with the phases";
const HIDDEN: &str =
    "belong to solutions that grow and fall again within a period so much that rounding errors hide their frame";

/// The frame of ż = J S z, from a frame of a similar motion or anew. `going` is told the work of each step.
///
/// # Errors
/// - a first frame with harmonics that the grid does not hold: [`Error::GridTooFine`]; growth, or multipliers without a real frame: [`Error::GrowthTooLarge`], [`Error::MultiplierUnsupported`]; those of `going`.
pub(super) fn frame(
    grid: &Grid,
    second: &Matrix<Periodic>,
    known: Option<Frame>,
    going: &mut Going<'_>,
) -> Result<Frame, Error> {
    if let Some(known) = known
        && let Some(frame) = refined(grid, second, known, going)?
    {
        return Ok(frame);
    }
    let problem = match start(grid, second, |grid, second| start_of_one(grid, second, going)) {
        Ok(first) => match refined(grid, second, first.clone(), going)? {
            Some(frame) => return Ok(frame),
            None => unreached(grid, &first),
        },
        Err(error) if ends(&error) => return Err(error),
        Err(error) => error,
    };
    // Multipliers that coincide without a drive that couples them have the frame of the mean.
    if let Ok(mean) = start(grid, second, |_, mean| still(mean))
        && let Some(frame) = refined(grid, second, mean, going)?
    {
        return Ok(frame);
    }
    Err(problem)
}

/// Why no frame is reached from a first one, which is exact at the times of the grid if the phase is one: the grid does not hold it, or there is none.
fn unreached(grid: &Grid, (change, modes): &Frame) -> Error {
    let tail = |entry: &Periodic| grid.tails(entry).into_iter().fold(0.0, f64::max) / entry.size().max(1.0);
    let rest = change.iter().flatten().map(tail).fold(0.0, f64::max);
    if rest > SMALL.max(STALLED * rounding(change)) {
        let harmonics = (0..grid.phases()).map(|phase| grid.count(phase) / 2).max().unwrap_or(0);
        return Error::GridTooFine { harmonics, rest, tolerance: SMALL };
    }
    let problem = if STALLED * rounding(change) > SMALL { HIDDEN } else { UNREACHED };
    Error::MultiplierUnsupported { multipliers: multipliers(grid, modes), problem }
}

/// Newton steps to a frame; none if they do not converge.
fn refined(
    grid: &Grid,
    second: &Matrix<Periodic>,
    (mut change, mut modes): Frame,
    going: &mut Going<'_>,
) -> Result<Option<Frame>, Error> {
    let moved = turned_rows(second);
    let mut before = f64::INFINITY;
    for _ in 0..FRAMES {
        going(of_frame(grid, second.len()))?;
        change = product(&change, &correction(&change));
        let rates = rates(grid, &moved, &change);
        measure(&mut modes, &rates);
        let eigenvalues: Vec<_> = modes.iter().flat_map(eigenvalues).collect();
        let noise = NOISE * fastest(&modes);
        let step: Matrix<Periodic> = rates
            .iter()
            .enumerate()
            .map(|(a, row)| {
                let one = |(b, entry): (usize, &Periodic)| {
                    solved(grid, entry, (eigenvalues[a] - eigenvalues[b], noise), a == b)
                };
                row.iter().enumerate().map(one).collect()
            })
            .collect();
        let step = hamiltonian_part(step);
        let size = step.iter().flatten().map(Periodic::size).fold(0.0, f64::max);
        // A step that rounding makes is not taken.
        if size > before * SLOWEST && (size < SMALL || size < (STALLED * rounding(&change)).min(MOST_STALLED)) {
            return Ok(Some((change, modes)));
        }
        if !size.is_finite() {
            break;
        }
        let step = if size > LARGEST { scaled(step, LARGEST / size) } else { step };
        change = product(&change, &exponential(&step));
        if size <= REACHED {
            return Ok(Some((change, modes)));
        }
        before = size;
    }
    Ok(None)
}

/// P⁻¹ (J S P − n∂P).
fn rates(grid: &Grid, moved: &Matrix<Periodic>, change: &Matrix<Periodic>) -> Matrix<Periodic> {
    let mut rates = product(moved, change);
    for (row, old) in rates.iter_mut().zip(change) {
        row.iter_mut().zip(old).for_each(|(entry, old)| *entry -= &grid.derivative(old));
    }
    product(&symplectic_inverse(change), &rates)
}

/// Takes the frequencies and rates of the modes from the means on the diagonal.
fn measure(modes: &mut [Mode<f64>], rates: &Matrix<Periodic>) {
    for (number, mode) in modes.iter_mut().enumerate() {
        let [u, momentum] = [2 * number, 2 * number + 1].map(|slot| rates[slot][slot].mean());
        let half = (momentum - u) / 2.0;
        match mode {
            Mode::Elliptic { frequency, .. } => *frequency = half.im,
            Mode::Hyperbolic { rate } | Mode::Complex { rate, .. } => *rate = -half.re,
        }
    }
}

/// The rounding error of P⁻¹ P: that of one product in each pair, in any units of the variables. It is large where solutions grow and fall again within a period.
pub(super) fn rounding(change: &Matrix<Periodic>) -> f64 {
    let largest = |row: &Vec<Periodic>| row.iter().map(Periodic::size).fold(0.0, f64::max);
    let pairs = change.chunks(2).map(|pair| pair.iter().map(largest).product::<f64>());
    f64::EPSILON * pairs.fold(0.0, f64::max)
}

/// The largest modulus of the frequencies and rates of modes.
pub(crate) fn fastest(modes: &[Mode<f64>]) -> f64 {
    modes.iter().map(|one| one.frequency().norm()).fold(0.0, f64::max)
}

/// The solution f of n∂f − λ f = `function`, in the harmonics that the grid solves for, and without the mean if it is `kept`. Harmonics up to `noise` are no resonances.
pub(super) fn solved(grid: &Grid, function: &Periodic, (lambda, noise): (Complex<f64>, f64), kept: bool) -> Periodic {
    grid.filtered(function, |at, c| {
        if (at == 0 && kept) || !grid.is_solved(at) || c.is_zero() {
            return Complex::zero();
        }
        let divisor = Complex::new(0.0, grid.rate(at)) - lambda;
        if divisor.norm() <= RESONANT * lambda.norm() && c.norm() <= noise { Complex::zero() } else { c / divisor }
    })
}

fn scaled(mut matrix: Matrix<Periodic>, factor: f64) -> Matrix<Periodic> {
    matrix.iter_mut().flatten().for_each(|entry| *entry *= &Periodic::real(factor));
    matrix
}

/// 1 − E/2 for a P with P⁻¹ P = 1 + E, E from rounding, where P⁻¹ is that of a symplectic matrix.
fn correction(change: &Matrix<Periodic>) -> Matrix<Periodic> {
    let mut factor = product(&symplectic_inverse(change), change);
    for (row, unit) in factor.iter_mut().zip(unit::<Periodic>(change.len())) {
        for (entry, unit) in row.iter_mut().zip(unit) {
            *entry = Periodic::combined(&[((-0.5).into(), entry), (1.5.into(), &unit)]);
        }
    }
    factor
}

/// The part (X + J Xᵀ J)/2 of a matrix whose flow is symplectic. Rounding alone makes the rest, but a small divisor enlarges it.
fn hamiltonian_part(mut matrix: Matrix<Periodic>) -> Matrix<Periodic> {
    let inverse = symplectic_inverse(&matrix);
    matrix.iter_mut().flatten().zip(inverse.iter().flatten()).for_each(|(entry, other)| *entry -= other);
    scaled(matrix, 0.5)
}

/// e^X of a small matrix.
fn exponential(step: &Matrix<Periodic>) -> Matrix<Periodic> {
    let n = step.len();
    let (mut sum, mut power) = (unit::<Periodic>(n), unit::<Periodic>(n));
    for k in 1..=16 {
        power = product(&power, step);
        power = scaled(power, 1.0 / f64::from(k));
        let mut most = 0.0_f64;
        for (sum, power) in sum.iter_mut().flatten().zip(power.iter().flatten()) {
            *sum += power;
            most = most.max(power.size());
        }
        if most < 1e-18 {
            break;
        }
    }
    sum
}

/// e^{λT} of the modes over the period of the first phase.
fn multipliers(grid: &Grid, modes: &[Mode<f64>]) -> Vec<[f64; 2]> {
    let period = grid.rates().first().map_or(0.0, |rate| 2.0 * PI / rate.abs());
    modes.iter().map(|mode| (eigenvalues(mode)[1] * period).exp()).map(|c| [c.re, c.im]).collect()
}
