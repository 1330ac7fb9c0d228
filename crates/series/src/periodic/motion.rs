//! The periodic motion of a driven Hamiltonian, and the periodic change of variables that makes the motion about it a constant one.
//!
//! ẋ = J ∇H(x, M) has a solution x̄(M), and the motion near it is ż = J S(M) z with the matrix S of second derivatives along x̄. Floquet's change z = P(M) w, symplectic
//! and periodic, makes it ẇ = Λ w with a constant diagonal Λ: −iω for u and iω for U of a centre, ±λ for a saddle. One Newton step for x̄ solves n∂δ − J S δ = r with the
//! residual r; one for P solves n∂X − [Λ, X] = R with the part R of P⁻¹(J S P − n∂P) that is not Λ. In the harmonics of w and X both are divisions by i j·n minus
//! eigenvalues. The method holds for any number of phases; with two or more x̄ and P are quasi-periodic (À. Haro and R. de la Llave, Discrete Contin. Dyn. Syst. B 6 (2006) 1261).
//!
//! The start of P: the monodromy matrix of the first phase, of which the Cayley transform (Φ − 1)(Φ + 1)⁻¹ is diagonalized as the matrix of a quadratic form, with the mean of S
//! over the other phases. The exponents ω are known up to multiples of n: each mode takes the multiple, and the place, where it has the most in common with a mode of
//! the mean of S, which is that of the Hamiltonian without its drive.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use num_complex::Complex;
use num_traits::Zero;

use super::grid::Grid;
use super::monodromy::monodromy;
use super::row::{Periodic, product};
use crate::birkhoff::PhaseSpace;
use crate::birkhoff::diagonal::Diagonal;
use crate::birkhoff::matrix::{Matrix, pairing, symplectic_inverse, transposed, turned, turned_rows, unit};
use crate::birkhoff::mode::Mode;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

/// A Hamiltonian whose coefficients are periodic functions of driven phases.
pub trait DrivenHamiltonian: Sync {
    /// Number of pairs (q, p).
    fn pairs(&self) -> usize;

    /// H as a polynomial in z, without terms of a degree above `degree`, at the variables q₁, p₁, q₂, … that are `variables`: periodic functions plus linear forms in z.
    ///
    /// # Errors
    /// - Of the algebra, and of a function that is not finite at these variables.
    fn expanded(
        &self,
        grid: &Grid,
        variables: &[Polynomial<Periodic>],
        degree: u32,
    ) -> Result<Polynomial<Periodic>, Error>;
}

/// Most Newton steps.
const STEPS: usize = 40;
/// A step below this is rounding.
const REACHED: f64 = 1e-14;
/// A step that is not smaller than this part of the one before ends the iteration, where both are small.
const SLOWEST: f64 = 0.5;
const SMALL: f64 = 1e-9;
/// A mean below this part of the largest value is rounding.
const ROUNDING: f64 = 1e-14;
/// A divisor below this part of the eigenvalue is a resonance, unless the harmonic is rounding.
const RESONANT: f64 = 1e-10;
const NOISE: f64 = 1e-12;
const QUARTET: &str = "include a quartet off the unit circle: the motion is unstable";
/// A Newton step beyond this has left the range.
const FAR: f64 = 1e3;
/// Most steps towards P, and their largest size.
const FRAMES: usize = 25;
const LARGEST: f64 = 0.3;

/// A kind of mode about the periodic motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exponent {
    /// ω: a centre turns by ω per unit of time.
    Centre(f64),
    /// λ > 0: a saddle grows by e^{λt}.
    Saddle(f64),
}

impl Exponent {
    /// The eigenvalues of u and of U.
    pub(super) fn eigenvalues(self) -> [Complex<f64>; 2] {
        match self {
            Self::Centre(omega) => [Complex::new(0.0, -omega), Complex::new(0.0, omega)],
            Self::Saddle(lambda) => [lambda.into(), (-lambda).into()],
        }
    }

    /// ω, or iλ for a saddle.
    #[must_use]
    pub fn frequency(self) -> Complex<f64> {
        match self {
            Self::Centre(omega) => omega.into(),
            Self::Saddle(lambda) => Complex::new(0.0, lambda),
        }
    }
}

/// A periodic motion and the frame of Floquet about it.
#[derive(Clone, Debug)]
pub struct PeriodicMotion {
    pub(super) grid: Grid,
    /// x̄: q₁, p₁, q₂, …
    pub(super) origin: Vec<Periodic>,
    /// P: rows q₁, p₁, …, columns u₁, U₁, …; for a centre u = (q + ip)/2 and U = 2iū of the real normal variables.
    pub(super) change: Matrix<Periodic>,
    pub(super) exponents: Vec<Exponent>,
    /// For each phase the largest of the last harmonics of x̄, P and the derivatives of H.
    pub(super) tails: Vec<f64>,
}

/// A frame: P and the exponents.
type Frame = (Matrix<Periodic>, Vec<Exponent>);

impl PeriodicMotion {
    /// The periodic motion that continues the equilibrium 0, and its frame; `known` is that on a coarser grid.
    ///
    /// # Errors
    /// - no convergence: [`Error::NoPeriodicMotion`]; multipliers that have no real frame: [`Error::MultiplierUnsupported`]; the errors of a quadratic form.
    pub fn new(system: &dyn DrivenHamiltonian, grid: Grid, known: Option<&Self>) -> Result<Self, Error> {
        let mut origin = vec![Periodic::zero(); 2 * system.pairs()];
        let (mut before, mut kept) = (f64::INFINITY, None);
        if let Some(known) = known {
            let onto = |function: &Periodic| grid.sampled(|phases| function.weighted(&known.grid.weights(phases)));
            origin = known.origin.iter().map(onto).collect();
            let change = known.change.iter().map(|row| row.iter().map(onto).collect()).collect();
            kept = Some((change, known.exponents.clone()));
        }
        for _ in 0..STEPS {
            let (slopes, second) = quadratic(system, &grid, &origin)?;
            let (change, exponents) = frame(&grid, &second, kept.take())?;
            let mut left = turned(&slopes);
            for (left, x) in left.iter_mut().zip(&origin) {
                *left -= &grid.derivative(x);
            }
            let left: Matrix<Periodic> = left.into_iter().map(|row| vec![row]).collect();
            let inner = product(&symplectic_inverse(&change), &left);
            let eigenvalues = exponents.iter().flat_map(|exponent| exponent.eigenvalues());
            let step: Matrix<Periodic> = inner
                .iter()
                .zip(eigenvalues)
                .map(|(row, lambda)| vec![solved(&grid, &row[0], lambda, false)])
                .collect();
            let step: Vec<Periodic> = product(&change, &step).into_iter().map(|row| row[0].real_part()).collect();
            let size = step.iter().map(Periodic::size).fold(0.0, f64::max);
            if !size.is_finite() || size > FAR {
                return Err(Error::NoPeriodicMotion { miss: size, steps: STEPS });
            }
            origin.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
            let scale = origin.iter().map(Periodic::size).fold(1.0, f64::max);
            let slow = size > before * SLOWEST && size < SMALL * scale;
            if size <= REACHED * scale || slow {
                let (slopes, second) = quadratic(system, &grid, &origin)?;
                let (change, exponents) = frame(&grid, &second, Some((change, exponents)))?;
                let functions = origin.iter().chain(&slopes).chain(change.iter().flatten());
                let tails = tails(&grid, functions.chain(second.iter().flatten()));
                return Ok(Self { grid, origin, change, exponents, tails });
            }
            before = size;
            kept = Some((change, exponents));
        }
        Err(Error::NoPeriodicMotion { miss: before, steps: STEPS })
    }

    /// The variables q₁, p₁, … as x̄ + P w, in the slots u₁, U₁, ….
    pub(super) fn variables(&self) -> Result<Vec<Polynomial<Periodic>>, Error> {
        self.origin.iter().zip(&self.change).map(|(origin, row)| form(origin, row)).collect()
    }
}

/// For each phase the largest of the last harmonics of functions, over the size of each function that is above 1.
fn tails<'a>(grid: &Grid, functions: impl Iterator<Item = &'a Periodic>) -> Vec<f64> {
    let mut most = vec![0.0_f64; grid.phases()];
    for function in functions {
        let size = function.size().max(1.0);
        most.iter_mut().zip(grid.tails(function)).for_each(|(most, tail)| *most = most.max(tail / size));
    }
    most
}

/// A constant plus a linear form.
fn form(constant: &Periodic, row: &[Periodic]) -> Result<Polynomial<Periodic>, Error> {
    let mut form = Polynomial::constant(constant.clone());
    for (slot, c) in row.iter().enumerate() {
        form.add_term(Monomial::ONE.with(slot, 1)?, c);
    }
    Ok(form)
}

/// ∇H and the second derivatives along x̄.
fn quadratic(
    system: &dyn DrivenHamiltonian,
    grid: &Grid,
    origin: &[Periodic],
) -> Result<(Vec<Periodic>, Matrix<Periodic>), Error> {
    let n = origin.len();
    let variables: Result<Vec<_>, Error> =
        origin.iter().zip(unit::<Periodic>(n)).map(|(origin, row)| form(origin, &row)).collect();
    let expanded = system.expanded(grid, &variables?, 2)?;
    let of = |slots: &[usize]| {
        let mut monomial = Monomial::ONE;
        for &slot in slots {
            monomial = monomial.with(slot, monomial.exponent(slot) + 1)?;
        }
        Ok::<_, Error>(expanded.coefficient(&monomial).cloned().unwrap_or_else(Periodic::zero))
    };
    let slopes = (0..n).map(|slot| of(&[slot])).collect::<Result<_, _>>()?;
    let entry = |i: usize, j: usize| {
        let c = of(&[i, j])?;
        Ok::<_, Error>(if i == j { c.clone() + c } else { c })
    };
    let second = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect::<Result<_, _>>()?;
    Ok((slopes, second))
}

/// The frame of ż = J S z, from a frame of a similar motion or anew.
fn frame(grid: &Grid, second: &Matrix<Periodic>, known: Option<Frame>) -> Result<Frame, Error> {
    if let Some(Ok(frame)) = known.map(|known| refined(grid, second, known)) {
        return Ok(frame);
    }
    // Multipliers that coincide without a drive that couples them have the frame of the mean.
    let found = start(grid, second, start_of_one).and_then(|frame| refined(grid, second, frame));
    found.or_else(|error| {
        let mean = start(grid, second, |_, mean| still(mean));
        mean.and_then(|frame| refined(grid, second, frame)).map_err(|_| error)
    })
}

/// Newton steps to a frame.
fn refined(grid: &Grid, second: &Matrix<Periodic>, (mut change, mut exponents): Frame) -> Result<Frame, Error> {
    let moved = turned_rows(second);
    let mut before = f64::INFINITY;
    for _ in 0..FRAMES {
        change = product(&change, &correction(&change));
        let mut rates = product(&moved, &change);
        for (row, old) in rates.iter_mut().zip(&change) {
            row.iter_mut().zip(old).for_each(|(entry, old)| *entry -= &grid.derivative(old));
        }
        let rates = product(&symplectic_inverse(&change), &rates);
        for (mode, exponent) in exponents.iter_mut().enumerate() {
            let [u, momentum] = [2 * mode, 2 * mode + 1].map(|slot| rates[slot][slot].mean());
            let half = (momentum - u) / 2.0;
            *exponent = match exponent {
                Exponent::Centre(_) => Exponent::Centre(half.im),
                Exponent::Saddle(_) => Exponent::Saddle(-half.re),
            };
        }
        let eigenvalues: Vec<_> = exponents.iter().flat_map(|exponent| exponent.eigenvalues()).collect();
        let step: Matrix<Periodic> = rates
            .iter()
            .enumerate()
            .map(|(a, row)| {
                let one = |(b, entry): (usize, &Periodic)| solved(grid, entry, eigenvalues[a] - eigenvalues[b], a == b);
                row.iter().enumerate().map(one).collect()
            })
            .collect();
        let step = hamiltonian_part(step);
        let size = step.iter().flatten().map(Periodic::size).fold(0.0, f64::max);
        // A step that rounding makes is not taken.
        if size > before * SLOWEST && size < SMALL {
            return Ok((change, exponents));
        }
        if !size.is_finite() {
            break;
        }
        let step = if size > LARGEST { scaled(step, LARGEST / size) } else { step };
        change = product(&change, &exponential(&step));
        if size <= REACHED {
            return Ok((change, exponents));
        }
        before = size;
    }
    let problem = "nearly coincide, and no periodic frame separates them";
    Err(Error::MultiplierUnsupported { multipliers: multipliers(grid, &exponents), problem })
}

/// The solution f of n∂f − λ f = `function`, in the harmonics that the grid solves for, and without the mean if it is `kept`.
fn solved(grid: &Grid, function: &Periodic, lambda: Complex<f64>, kept: bool) -> Periodic {
    grid.filtered(function, |at, c| {
        if (at == 0 && kept) || !grid.is_solved(at) || c.is_zero() {
            return Complex::zero();
        }
        let divisor = Complex::new(0.0, grid.rate(at)) - lambda;
        // Rounding is no resonance.
        if divisor.norm() <= RESONANT * lambda.norm() && c.norm() <= NOISE { Complex::zero() } else { c / divisor }
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
fn multipliers(grid: &Grid, exponents: &[Exponent]) -> Vec<[f64; 2]> {
    let period = grid.rates().first().map_or(0.0, |rate| 2.0 * PI / rate.abs());
    exponents.iter().map(|exponent| (exponent.eigenvalues()[1] * period).exp()).map(|c| [c.re, c.im]).collect()
}

/// A first frame: that of the mean over all phases but the first.
fn start(
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
    let (change, exponents) = of_one(&grid.first(), &second.iter().map(over).collect())?;
    Ok((change.iter().map(|row| row.iter().map(|c| grid.extended(c)).collect()).collect(), exponents))
}

/// The modes of the mean.
fn undriven(second: &Matrix<Periodic>) -> Result<Diagonal<f64>, Error> {
    let mean = |c: &Periodic| Some(c.mean().re).filter(|mean| mean.abs() > ROUNDING * c.size()).unwrap_or(0.0);
    diagonal(&second.iter().map(|row| row.iter().map(mean).collect()).collect::<Vec<_>>())
}

/// The frame of the mean.
fn still(second: &Matrix<Periodic>) -> Result<Frame, Error> {
    let (columns, exponents) = columns(&undriven(second)?, Ok)?;
    let row = |row: usize| columns.iter().map(|column| Periodic::Constant(column[row])).collect();
    Ok(((0..second.len()).map(row).collect(), exponents))
}

/// A first frame with one phase or none.
fn start_of_one(grid: &Grid, second: &Matrix<Periodic>) -> Result<Frame, Error> {
    let n = second.len();
    if grid.phases() == 0 {
        return still(second);
    }
    let (rate, course) = (grid.rates()[0], monodromy(grid, second));
    let period = 2.0 * PI / rate;
    let last = &course[grid.times()];
    let one = DMatrix::<f64>::identity(n, n);
    let unsupported = |problem| {
        let eigenvalues = last.clone().complex_eigenvalues();
        let multipliers = eigenvalues.iter().map(|c| [c.re, c.im]).collect();
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
    let (columns, exponents) = columns(&found, |exponent| match exponent {
        Exponent::Centre(tangent) => Ok(Exponent::Centre(2.0 * tangent.atan() / period)),
        Exponent::Saddle(tangent) if tangent < 1.0 => Ok(Exponent::Saddle(2.0 * tangent.atanh() / period)),
        Exponent::Saddle(_) => {
            Err(unsupported("are negative: the motion is unstable, and no real frame of this period exists"))
        }
    })?;
    // Φ(M) c e^{−λ t} is periodic.
    let eigenvalues: Vec<_> = exponents.iter().flat_map(|exponent| exponent.eigenvalues()).collect();
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
    let modes = columns.iter().zip(&eigenvalues).map(|(column, &lambda)| carried(column, lambda)).collect();
    let (modes, exponents) = continued(grid, modes, exponents, undriven(second).ok().as_ref())?;
    Ok((transposed(&modes), exponents))
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

/// The columns of u₁, U₁, … of modes, and their exponents.
fn columns(
    diagonal: &Diagonal<f64>,
    mut exponent: impl FnMut(Exponent) -> Result<Exponent, Error>,
) -> Result<(Columns, Vec<Exponent>), Error> {
    let column = |slot: usize| diagonal.matrix.iter().map(|row| row[slot]).collect::<Vec<_>>();
    let (mut all, mut exponents) = (Vec::new(), Vec::new());
    for (mode, kind) in diagonal.modes.iter().enumerate() {
        let (q, p) = (column(2 * mode), column(2 * mode + 1));
        match kind {
            Mode::Elliptic { frequency, ratio } => {
                let root = ratio.sqrt();
                let u: Vec<_> = q.iter().zip(&p).map(|(q, p)| Complex::new(root * q, -p / root)).collect();
                all.push(u.clone());
                all.push(u.iter().map(|c| Complex::new(0.0, -0.5) * c.conj()).collect());
                exponents.push(exponent(Exponent::Centre(*frequency))?);
            }
            Mode::Hyperbolic { rate } => {
                all.push(q.iter().map(|&x| x.into()).collect());
                all.push(p.iter().map(|&x| x.into()).collect());
                exponents.push(exponent(Exponent::Saddle(*rate))?);
            }
            Mode::Complex { rate, frequency, .. } => {
                return Err(Error::MultiplierUnsupported { multipliers: vec![[*rate, *frequency]], problem: QUARTET });
            }
        }
    }
    Ok((all, exponents))
}

/// The modes in the order, and the exponents on the branch, of the modes without drive.
fn continued(
    grid: &Grid,
    columns: Vec<Vec<Periodic>>,
    exponents: Vec<Exponent>,
    undriven: Option<&Diagonal<f64>>,
) -> Result<(Vec<Vec<Periodic>>, Vec<Exponent>), Error> {
    let count = exponents.len();
    let known = undriven.and_then(|undriven| self::columns(undriven, Ok).ok());
    let mut overlaps = Vec::new();
    for mode in 0..count {
        let harmonics: Vec<_> = columns[2 * mode + 1].iter().map(|entry| grid.harmonics(entry)).collect();
        for at in 0..grid.times() {
            let vector: Vec<_> = harmonics.iter().map(|row| row[at]).collect();
            let places = known.iter().flat_map(|(modes, kinds)| modes.iter().step_by(2).zip(kinds).enumerate());
            let alike = places.filter(|(_, (_, kind))| same(**kind, exponents[mode]));
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
        match exponents[mode] {
            Exponent::Saddle(_) => {
                ordered.extend([columns[2 * mode].clone(), columns[2 * mode + 1].clone()]);
                kinds.push(exponents[mode]);
            }
            Exponent::Centre(omega) => {
                let j = grid.multiples(at)[0];
                let turn = |sign: f64| grid.sampled(|phases| Complex::cis(sign * j as f64 * phases[0]));
                let turned = |column: &[Periodic], by: &Periodic| -> Vec<Periodic> {
                    column.iter().map(|entry| entry.clone() * by.clone()).collect()
                };
                ordered.push(turned(&columns[2 * mode], &turn(1.0)));
                ordered.push(turned(&columns[2 * mode + 1], &turn(-1.0)));
                kinds.push(Exponent::Centre(omega + grid.rate(at)));
            }
        }
    }
    Ok((ordered, kinds))
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

fn same(one: Exponent, two: Exponent) -> bool {
    matches!((one, two), (Exponent::Centre(_), Exponent::Centre(_)) | (Exponent::Saddle(_), Exponent::Saddle(_)))
}
