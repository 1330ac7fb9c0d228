//! The periodic motion of a driven Hamiltonian.
//!
//! ẋ = J ∇H(x, M) has a solution x̄(M). One Newton step for it solves n∂δ − J S δ = r with the residual r and the matrix S of second derivatives along x̄. In the variables w of
//! Floquet's frame, δ = P w, the harmonics of w are those of P⁻¹ r over i j·n minus an eigenvalue. The method holds for any number of phases; with two or more x̄ and P are
//! quasi-periodic (À. Haro and R. de la Llave, Discrete Contin. Dyn. Syst. B 6 (2006) 1261).

use num_traits::Zero;

use super::frame::{REACHED, SLOWEST, SMALL, frame, solved};
use super::grid::Grid;
use super::hamiltonian::DrivenHamiltonian;
use super::row::{Periodic, product};
use super::start::eigenvalues;
use crate::birkhoff::matrix::{Matrix, symplectic_inverse, turned, unit};
use crate::birkhoff::mode::Mode;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

/// Most Newton steps.
const STEPS: usize = 40;
/// A Newton step beyond this has left the range.
const FAR: f64 = 1e3;

/// A periodic motion and the frame of Floquet about it.
#[derive(Clone, Debug)]
pub struct PeriodicMotion {
    pub(super) grid: Grid,
    /// x̄: q₁, p₁, q₂, …
    pub(super) origin: Vec<Periodic>,
    /// P: rows q₁, p₁, …, columns u₁, U₁, …; for a centre u = (q + ip)/2 and U = 2iū of the real normal variables.
    pub(super) change: Matrix<Periodic>,
    pub(super) modes: Vec<Mode<f64>>,
    /// For each phase the largest of the last harmonics of x̄, P and the derivatives of H.
    pub(super) tails: Vec<f64>,
}

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
            kept = Some((change, known.modes.clone()));
        }
        for _ in 0..STEPS {
            let (slopes, second) = quadratic(system, &grid, &origin)?;
            let (change, modes) = frame(&grid, &second, kept.take())?;
            let mut left = turned(&slopes);
            for (left, x) in left.iter_mut().zip(&origin) {
                *left -= &grid.derivative(x);
            }
            let left: Matrix<Periodic> = left.into_iter().map(|row| vec![row]).collect();
            let inner = product(&symplectic_inverse(&change), &left);
            let eigenvalues = modes.iter().flat_map(eigenvalues);
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
                let (change, modes) = frame(&grid, &second, Some((change, modes)))?;
                let functions = origin.iter().chain(&slopes).chain(change.iter().flatten());
                let tails = tails(&grid, functions.chain(second.iter().flatten()));
                return Ok(Self { grid, origin, change, modes, tails });
            }
            before = size;
            kept = Some((change, modes));
        }
        Err(Error::NoPeriodicMotion { miss: before, steps: STEPS })
    }

    /// The variables q₁, p₁, … as x̄ + P w, in the slots u₁, U₁, ….
    pub(super) fn variables(&self) -> Result<Vec<Polynomial<Periodic>>, Error> {
        self.origin.iter().zip(&self.change).map(|(origin, row)| form(origin, row)).collect()
    }

    /// w = P⁻¹ (x − x̄) as forms in the variables q₁, p₁, ….
    pub(super) fn deviations(&self) -> Result<Vec<Polynomial<Periodic>>, Error> {
        let deviation = |row: &Vec<Periodic>| {
            let products = row.iter().zip(&self.origin).map(|(c, x)| c.clone() * x.clone());
            form(&-products.fold(Periodic::zero(), |sum, product| sum + product), row)
        };
        symplectic_inverse(&self.change).iter().map(deviation).collect()
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
