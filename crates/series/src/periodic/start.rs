//! A first frame, before Newton's iteration.
//!
//! The matrix Φ of solutions over the period of the first phase, with the mean of S over the other phases, has the Cayley transform (Φ − 1)(Φ + 1)⁻¹, which is
//! diagonalized as the matrix of a quadratic form. The exponents ω are known up to multiples of n: each mode takes the multiple, and the place, where it has the most in common
//! with a mode of the mean of S, which is that of the Hamiltonian without its drive.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use num_complex::Complex;
use num_traits::Zero;

use super::grid::Grid;
use super::monodromy::monodromy;
use super::row::Periodic;
use crate::birkhoff::PhaseSpace;
use crate::birkhoff::diagonal::Diagonal;
use crate::birkhoff::matrix::{Matrix, pairing, transposed, turned_rows};
use crate::birkhoff::mode::Mode;
use crate::birkhoff::schur::eigenvalues as spectrum;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

/// A mean below this part of the largest value is rounding.
const ROUNDING: f64 = 1e-14;
/// A frame: P, whose centres have the ratio 1, and the modes.
pub(super) type Frame = (Matrix<Periodic>, Vec<Mode<f64>>);

const QUARTET: &str = "include a quartet off the unit circle: the motion is unstable";

/// A first frame: that of the mean over all phases but the first.
pub(super) fn start(
    grid: &Grid,
    second: &Matrix<Periodic>,
    of_one: impl Fn(&Grid, &Matrix<Periodic>) -> Result<Frame, Error>,
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
pub(super) fn start_of_one(grid: &Grid, second: &Matrix<Periodic>) -> Result<Frame, Error> {
    let n = second.len();
    if grid.phases() == 0 {
        return still(second);
    }
    let (rate, course) = (grid.rates()[0], monodromy(grid, second)?);
    let period = 2.0 * PI / rate;
    let last = &course[grid.times()];
    let one = DMatrix::<f64>::identity(n, n);
    let unsupported = |problem| {
        let multipliers = spectrum(last).unwrap_or_default().iter().map(|c| [c.re, c.im]).collect();
        Error::MultiplierUnsupported { multipliers, problem }
    };
    let inverse =
        (last + &one).try_inverse().ok_or_else(|| unsupported("are −1, and no frame of this period exists"))?;
    let cayley = (last - &one) * inverse;
    // A = −J C, without what rounding leaves of its antisymmetric part.
    let rows: Matrix<f64> = (0..n).map(|i| (0..n).map(|j| cayley[(i, j)]).collect()).collect();
    let turned: Matrix<f64> = turned_rows(&rows).into_iter().map(|row| row.iter().map(|c| -c).collect()).collect();
    let form = (0..n).map(|i| (0..n).map(|j| 0.5 * (turned[i][j] + turned[j][i])).collect()).collect::<Vec<_>>();
    let found = diagonal(&form).map_err(|_| unsupported("include a pair of 1 without two directions"))?;
    if found.modes.iter().any(|mode| matches!(mode, Mode::Complex { .. })) {
        return Err(unsupported(QUARTET));
    }
    let (mut columns, mut modes) = columns(&found)?;
    if !from_tangents(&mut columns, &mut modes, period) {
        return Err(unsupported("are negative: the motion is unstable, and no real frame of this period exists"));
    }
    // Φ(M) c e^{−λ t} is periodic.
    let eigenvalues: Vec<_> = modes.iter().flat_map(eigenvalues).collect();
    let carried = |column: &Vec<Complex<f64>>, lambda: Complex<f64>| -> Vec<Periodic> {
        let values = |row: usize| -> Vec<Complex<f64>> {
            (0..grid.times())
                .map(|at| {
                    let time = at as f64 * period / grid.times() as f64;
                    let sum: Complex<f64> = (0..n).map(|k| column[k] * course[at][(row, k)]).sum();
                    sum * (-lambda * time).exp()
                })
                .collect()
        };
        (0..n).map(|row| Periodic::of(&values(row))).collect()
    };
    let columns = columns.iter().zip(&eigenvalues).map(|(column, &lambda)| carried(column, lambda)).collect();
    let (columns, modes) = continued(grid, columns, modes, undriven(second).ok().as_ref());
    Ok((transposed(&columns), modes))
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
pub(super) fn eigenvalues(mode: &Mode<f64>) -> [Complex<f64>; 2] {
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

/// The modes in the order, and the frequencies on the branch, of the modes without drive.
fn continued(
    grid: &Grid,
    columns: Vec<Vec<Periodic>>,
    modes: Vec<Mode<f64>>,
    undriven: Option<&Diagonal<f64>>,
) -> (Vec<Vec<Periodic>>, Vec<Mode<f64>>) {
    let count = modes.len();
    let known = undriven.and_then(|undriven| self::columns(undriven).ok());
    let mut overlaps = Vec::new();
    for mode in 0..count {
        let harmonics: Vec<_> = columns[2 * mode + 1].iter().map(|entry| grid.harmonics(entry)).collect();
        for at in 0..grid.times() {
            let vector: Vec<_> = harmonics.iter().map(|row| row[at]).collect();
            let places = known.iter().flat_map(|(columns, kinds)| columns.iter().step_by(2).zip(kinds).enumerate());
            let alike = places.filter(|(_, (_, kind))| kind.is_elliptic() == modes[mode].is_elliptic());
            let before = overlaps.len();
            overlaps.extend(alike.map(|(place, (known, _))| (pairing(known, &vector).norm(), mode, place, at)));
            // A mode of a kind that none has without drive: its largest harmonic.
            if overlaps.len() == before {
                overlaps.push((vector.iter().map(Complex::norm_sqr).sum::<f64>(), mode, mode, at));
            }
        }
    }
    let (mut ordered, mut kinds) = (Vec::new(), Vec::new());
    for (mode, at) in assigned(overlaps, count) {
        match &modes[mode] {
            Mode::Elliptic { frequency, ratio } => {
                let j = grid.multiples(at)[0];
                let turn = |sign: f64| grid.sampled(|phases| Complex::cis(sign * j as f64 * phases[0]));
                let turned = |column: &[Periodic], by: &Periodic| -> Vec<Periodic> {
                    column.iter().map(|entry| entry.clone() * by.clone()).collect()
                };
                ordered.push(turned(&columns[2 * mode], &turn(1.0)));
                ordered.push(turned(&columns[2 * mode + 1], &turn(-1.0)));
                kinds.push(Mode::Elliptic { frequency: frequency + grid.rate(at), ratio: *ratio });
            }
            saddle => {
                ordered.extend([columns[2 * mode].clone(), columns[2 * mode + 1].clone()]);
                kinds.push(saddle.clone());
            }
        }
    }
    (ordered, kinds)
}

/// The mode and the harmonic of each place, from overlaps with mode, place and harmonic. Modes that are left take the places that are left.
fn assigned(mut overlaps: Vec<(f64, usize, usize, usize)>, count: usize) -> Vec<(usize, usize)> {
    overlaps.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut taken: Vec<Option<(usize, usize)>> = vec![None; count];
    for (_, mode, place, at) in overlaps {
        if taken[place].is_none() && taken.iter().flatten().all(|&(other, _)| other != mode) {
            taken[place] = Some((mode, at));
        }
    }
    for mode in 0..count {
        if taken.iter().flatten().all(|&(other, _)| other != mode)
            && let Some(free) = taken.iter_mut().find(|place| place.is_none())
        {
            *free = Some((mode, 0));
        }
    }
    taken.into_iter().flatten().collect()
}
