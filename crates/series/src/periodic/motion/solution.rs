//! The periodic motion of a driven Hamiltonian.
//!
//! ẋ = J ∇H(x, M) has a solution x̄(M). One Newton step for it solves n∂δ − J S δ = r with the residual r and the matrix S of second derivatives along x̄. In the variables w of
//! Floquet's frame, δ = P w, the harmonics of w are those of P⁻¹ r over i j·n minus an eigenvalue. If the motion of a step has no real frame, this and the later steps solve the equation at all times
//! together; multipliers are then those of the periodic motion. The method holds for any number of phases; with two or more x̄ and P are quasi-periodic (À. Haro and R. de la Llave, Discrete Contin. Dyn. Syst. B 6 (2006) 1261).

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use num_traits::Zero;

use super::frame::{NOISE, REACHED, SLOWEST, SMALL, fastest, frame, rounding, solved};
use super::start::{Frame, eigenvalues};
use super::work::{Going, ends, of_all_times, of_step};
use crate::birkhoff::matrix::{Matrix, symplectic_inverse, turned, turned_rows, unit};
use crate::birkhoff::mode::Mode;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::periodic::hamiltonian::DrivenHamiltonian;
use crate::periodic::rows::grid::Grid;
use crate::periodic::rows::row::{Periodic, product};
use crate::polynomial::Polynomial;

/// Most Newton steps.
const STEPS: usize = 40;
/// The largest linear system of a step without a frame.
const MOST_ROWS: usize = 1000;
/// A step towards a frame takes at most so many eliminations of that system, or so many times the work of the first one.
const ELIMINATIONS: f64 = 100.0;
const FARTHER: f64 = 30.0;
/// A grid holds the turns of a frame if its last harmonics are below this part.
const HELD: f64 = 1e-2;
/// The last harmonics are rounding below so many rounding errors of the frame.
const ROUNDED: f64 = 32.0;

/// A periodic motion and the frame of Floquet about it.
#[derive(Clone, Debug)]
pub struct PeriodicMotion {
    pub(crate) grid: Grid,
    /// x̄: q₁, p₁, q₂, …
    pub(crate) origin: Vec<Periodic>,
    /// P: rows q₁, p₁, …, columns u₁, U₁, …; for a centre u = (q + ip)/2 and U = 2iū of the real normal variables.
    pub(crate) change: Matrix<Periodic>,
    pub(crate) modes: Vec<Mode<f64>>,
    /// For each phase the largest of the last harmonics of x̄, P and the derivatives of H.
    pub(crate) tails: Vec<f64>,
    /// Whether x̄ is opposite to the first step from the equilibrium, the response to a weak drive.
    pub(crate) is_opposite: bool,
}

/// Where Newton's iteration begins.
#[derive(Clone, Debug)]
pub struct Begin {
    grid: Grid,
    origin: Vec<Periodic>,
    frame: Option<Frame>,
    is_opposite: bool,
}

impl Begin {
    /// At a curve on a grid.
    pub(crate) fn at(grid: Grid, origin: Vec<Periodic>) -> Self {
        Self { grid, origin, frame: None, is_opposite: false }
    }

    /// At a curve whose side of the response to a weak drive, if there is one, is known.
    pub(crate) fn beside(self, response: Option<&[Periodic]>) -> Self {
        let is_opposite = response.is_some_and(|response| alike(&self.origin, response) < 0.0);
        Self { is_opposite, ..self }
    }
}

impl PeriodicMotion {
    /// The periodic motion to which Newton's iteration comes from the equilibrium 0 or from where it is told to begin, and its frame.
    ///
    /// # Errors
    /// - no convergence: [`Error::NoPeriodicMotion`]; what `going` returns before a step; multipliers that have no real frame: [`Error::MultiplierUnsupported`], [`Error::GrowthTooLarge`];
    /// - a frame with harmonics that the grid does not hold: [`Error::GridTooFine`]; the errors of a quadratic form.
    pub fn new(
        system: &dyn DrivenHamiltonian,
        grid: Grid,
        begin: Option<&Begin>,
        going: &mut Going<'_>,
    ) -> Result<Self, Error> {
        let mut iteration = Iteration::new(system, grid, begin);
        for _ in 0..STEPS {
            if iteration.step(going)? {
                return iteration.motion(begin, going);
            }
        }
        Err(Error::NoPeriodicMotion { miss: iteration.size, steps: STEPS })
    }

    /// This motion as that to begin with, and its frame if the grid holds it: turns between the times of a coarse grid are counted wrongly.
    pub(crate) fn begin(&self) -> Begin {
        let is_held = self.tails.iter().all(|&tail| tail < HELD);
        let frame = is_held.then(|| (self.change.clone(), self.modes.clone()));
        Begin { grid: self.grid.clone(), origin: self.origin.clone(), frame, is_opposite: self.is_opposite }
    }

    /// The last harmonics of a frame on any grid are at least some rounding errors.
    pub(crate) fn rounding(&self) -> f64 {
        ROUNDED * rounding(&self.change)
    }

    /// The largest variable of x̄.
    pub(crate) fn size(&self) -> f64 {
        size(&self.origin)
    }

    /// The variables q₁, p₁, … as x̄ + P w, in the slots u₁, U₁, ….
    pub(crate) fn variables(&self) -> Result<Vec<Polynomial<Periodic>>, Error> {
        self.origin.iter().zip(&self.change).map(|(origin, row)| form(origin, row)).collect()
    }

    /// w = P⁻¹ (x − x̄) as forms in the variables q₁, p₁, ….
    pub(crate) fn deviations(&self) -> Result<Vec<Polynomial<Periodic>>, Error> {
        let deviation = |row: &Vec<Periodic>| {
            let products = row.iter().zip(&self.origin).map(|(c, x)| c.clone() * x.clone());
            form(&-products.fold(Periodic::zero(), |sum, product| sum + product), row)
        };
        symplectic_inverse(&self.change).iter().map(deviation).collect()
    }
}

/// Newton's iteration for a periodic motion on a grid.
struct Iteration<'a> {
    system: &'a dyn DrivenHamiltonian,
    grid: Grid,
    origin: Vec<Periodic>,
    /// The frame about the curve before the last step, or why there is none.
    kept: Option<Frame>,
    frameless: Option<Error>,
    /// The first step.
    response: Option<Vec<Periodic>>,
    /// The number of steps and the size of the last one.
    number: usize,
    size: f64,
    /// The most work towards a frame.
    most: f64,
}

impl<'a> Iteration<'a> {
    fn new(system: &'a dyn DrivenHamiltonian, grid: Grid, begin: Option<&Begin>) -> Self {
        let (origin, kept) = begun(&grid, 2 * system.pairs(), begin);
        let most = without_frame(&grid, origin.len());
        Self { system, grid, origin, kept, frameless: None, response: None, number: 0, size: f64::INFINITY, most }
    }

    /// A Newton step, and whether it is the last one.
    fn step(&mut self, going: &mut Going<'_>) -> Result<bool, Error> {
        self.number += 1;
        going(of_step(self.system, &self.grid))?;
        let (slopes, second) = quadratic(self.system, &self.grid, &self.origin)?;
        let mut left = turned(&slopes);
        for (left, x) in left.iter_mut().zip(&self.origin) {
            *left -= &self.grid.derivative(x);
        }
        if self.frameless.is_none() {
            match self.frame(&second, going) {
                Ok(found) => self.kept = Some(found),
                Err(error) if ends(&error) => return Err(error),
                // That of a step is not that of the periodic motion.
                Err(error) => self.frameless = Some(error),
            }
        }
        let unsolved = |frameless| unsolved(frameless, &left, &second, (&self.origin, self.number));
        let step = match &self.kept {
            Some(frame) => step_in_frame(&self.grid, frame, &left),
            None => {
                step_at_all_times(&self.grid, &second, &left, going)?.ok_or_else(|| unsolved(self.frameless.clone()))?
            }
        };
        let size = size(&step);
        if !size.is_finite() {
            return Err(unsolved(None));
        }
        self.origin.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
        self.response.get_or_insert(step);
        let scale = self::size(&self.origin).max(1.0);
        let slow = size > self.size * SLOWEST && size < SMALL * scale;
        self.size = size;
        Ok(size <= REACHED * scale || slow)
    }

    /// The frame about the curve, from that before the last step. Far from the equilibrium the rates of S can be so large that the matrix of solutions takes all the work of the search:
    /// there is no motion that a grid of these times holds.
    fn frame(&mut self, second: &Matrix<Periodic>, going: &mut Going<'_>) -> Result<Frame, Error> {
        let mut told = |work: f64| {
            if self.number == 1 {
                self.most = self.most.max(FARTHER * work);
            }
            let far = Error::NoPeriodicMotion { miss: self.size, steps: self.number };
            if work > self.most { Err(far) } else { going(work) }
        };
        frame(&self.grid, second, self.kept.take(), &mut told)
    }

    /// The curve after the last step and its frame.
    fn motion(mut self, begin: Option<&Begin>, going: &mut Going<'_>) -> Result<PeriodicMotion, Error> {
        let (slopes, second) = quadratic(self.system, &self.grid, &self.origin)?;
        let (change, modes) = self.frame(&second, going)?;
        let Self { grid, origin, response, .. } = self;
        let mut tails = vec![0.0; grid.phases()];
        add_tails(&mut tails, &grid, origin.iter().chain(change.iter().flatten()), 1.0);
        add_tails(&mut tails, &grid, slopes.iter().chain(second.iter().flatten()), fastest(&modes));
        let is_opposite = match begin {
            Some(begin) => begin.is_opposite,
            None => response.is_some_and(|response| alike(&origin, &response) < 0.0),
        };
        Ok(PeriodicMotion { grid, origin, change, modes, tails, is_opposite })
    }
}

/// The curve and the frame to begin with, on a grid.
fn begun(grid: &Grid, variables: usize, begin: Option<&Begin>) -> (Vec<Periodic>, Option<Frame>) {
    let Some(begin) = begin else { return (vec![Periodic::zero(); variables], None) };
    let onto = |function: &Periodic| grid.with_harmonics_of(&begin.grid, function);
    let frame = begin
        .frame
        .as_ref()
        .map(|(change, modes)| (change.iter().map(|row| row.iter().map(onto).collect()).collect(), modes.clone()));
    (begin.origin.iter().map(onto).collect(), frame)
}

/// The first step from the equilibrium, the response to a weak drive; none at a resonance or without a frame.
pub(super) fn response(
    system: &dyn DrivenHamiltonian,
    grid: &Grid,
    going: &mut Going<'_>,
) -> Result<Option<Vec<Periodic>>, Error> {
    let (slopes, second) = quadratic(system, grid, &vec![Periodic::zero(); 2 * system.pairs()])?;
    match frame(grid, &second, None, going) {
        Ok(frame) => Ok(Some(step_in_frame(grid, &frame, &turned(&slopes))).filter(|step| size(step).is_finite())),
        Err(error) if ends(&error) => Err(error),
        Err(_) => Ok(None),
    }
}

/// The mean of the product of two curves.
fn alike(one: &[Periodic], other: &[Periodic]) -> f64 {
    one.iter().zip(other).map(|(x, y)| (x.clone() * y.clone()).mean().re).sum()
}

/// The largest value of some functions.
fn size(functions: &[Periodic]) -> f64 {
    functions.iter().map(Periodic::size).fold(0.0, f64::max)
}

/// The error where a step has neither a frame nor a linear system: that of the frame if the motion is periodic already.
fn unsolved(
    frameless: Option<Error>,
    left: &[Periodic],
    second: &Matrix<Periodic>,
    (origin, steps): (&[Periodic], usize),
) -> Error {
    let miss = size(left) / second.iter().map(|row| size(row)).fold(0.0, f64::max);
    let reached = miss <= SMALL * size(origin).max(1.0);
    frameless.filter(|_| reached).unwrap_or(Error::NoPeriodicMotion { miss, steps })
}

/// The Newton step for a residual in the variables of a frame, where it is a division of each harmonic.
fn step_in_frame(grid: &Grid, (change, modes): &Frame, left: &[Periodic]) -> Vec<Periodic> {
    let left: Matrix<Periodic> = left.iter().map(|row| vec![row.clone()]).collect();
    let inner = product(&symplectic_inverse(change), &left);
    let rows = inner.iter().zip(modes.iter().flat_map(eigenvalues));
    let noise = NOISE * fastest(modes);
    let step: Matrix<Periodic> =
        rows.map(|(row, lambda)| vec![solved(grid, &row[0], (lambda, noise), false)]).collect();
    product(change, &step).into_iter().map(|row| row[0].real_part()).collect()
}

/// The work of some eliminations of the system at all times together.
fn without_frame(grid: &Grid, variables: usize) -> f64 {
    let rows = variables * grid.times();
    if rows > MOST_ROWS { f64::INFINITY } else { ELIMINATIONS * of_all_times(rows) }
}

/// The Newton step without a frame, by one linear system for all times; none beyond [`MOST_ROWS`] and where the system is singular.
fn step_at_all_times(
    grid: &Grid,
    second: &Matrix<Periodic>,
    left: &[Periodic],
    going: &mut Going<'_>,
) -> Result<Option<Vec<Periodic>>, Error> {
    let (n, times) = (left.len(), grid.times());
    if n * times > MOST_ROWS {
        return Ok(None);
    }
    going(of_all_times(n * times))?;
    let row = |variable: usize, time: usize| variable * times + time;
    let mut matrix = DMatrix::<f64>::zeros(n * times, n * times);
    for time in 0..times {
        let spike: Vec<Complex<f64>> = (0..times).map(|at| f64::from(at == time).into()).collect();
        let derivative = grid.derivative(&Periodic::of(&spike));
        for variable in 0..n {
            (0..times).for_each(|at| matrix[(row(variable, at), row(variable, time))] = derivative.at(at).re);
        }
    }
    for (i, entries) in turned_rows(second).iter().enumerate() {
        for (j, entry) in entries.iter().enumerate() {
            (0..times).for_each(|time| matrix[(row(i, time), row(j, time))] -= entry.at(time).re);
        }
    }
    let residual = DVector::from_iterator(n * times, left.iter().flat_map(|x| (0..times).map(|time| x.at(time).re)));
    let Some(step) = matrix.lu().solve(&residual) else { return Ok(None) };
    let of = |values: &[f64]| {
        let function = Periodic::of(&values.iter().map(|&x| x.into()).collect::<Vec<_>>());
        grid.filtered(&function, |at, c| if grid.is_solved(at) { c } else { Complex::zero() }).real_part()
    };
    Ok(Some(step.as_slice().chunks(times).map(of).collect()))
}

/// The largest so far of the last harmonics of functions, over the size of each function that is above a unit; one for each phase.
fn add_tails<'a>(tails: &mut [f64], grid: &Grid, functions: impl Iterator<Item = &'a Periodic>, unit: f64) {
    for function in functions {
        let size = function.size().max(unit);
        tails.iter_mut().zip(grid.tails(function)).for_each(|(most, tail)| *most = most.max(tail / size));
    }
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
