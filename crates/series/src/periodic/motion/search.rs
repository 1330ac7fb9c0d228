//! The search for a periodic motion: the grid that holds it, and the curve where Newton's iteration begins.
//!
//! The iteration begins at the equilibrium, or at the curve through a state that the user knows. Where it ends nowhere, as at the resonance of the phase with a mode, whose first step is a
//! division by 0, it begins at the periodic motion of a neighbouring rate.

use super::orbit::orbit;
use super::solution::{Begin, PeriodicMotion, response};
use super::work::{Going, ends, of_step, too_large};
use crate::error::Error;
use crate::periodic::hamiltonian::DrivenHamiltonian;
use crate::periodic::rows::grid::Grid;
use crate::triangle::{Progress, stop};

/// Harmonics to begin with. All numbers of them are multiples of four: one time more than a multiple of eight suits vector instructions.
const FEWEST: usize = 4;
/// Coefficients may differ between the times of a grid by so many times the tolerance of its last harmonics.
const BETWEEN: f64 = 100.0;
/// Most times of a grid of several phases.
const MOST_TIMES: usize = 20_000;
/// Grids without a solution after which there is none.
const FAILURES: usize = 4;
/// The neighbouring rates, as parts of a rate that are added and taken away.
const BESIDE: [f64; 3] = [1e-3, 1e-2, 1e-1];

/// What a normal form about a periodic motion is to have.
#[derive(Clone, Copy, Debug)]
pub struct DrivenOptions {
    /// Terms to degree `order` + 2.
    pub order: usize,
    /// Harmonics at the border of the grid are at most this, relative to variables of size 1.
    pub tolerance: f64,
    /// Most harmonics H of one phase, a multiple of four. A coefficient is held at the product over the phases of 2H + 1 times.
    pub harmonics: usize,
    /// A divisor below this, relative to the largest frequency, is refused.
    pub smallest_divisor: f64,
    /// Most work of the search for the periodic motion, in multiplications of two floats: [`MOST_WORK`](crate::periodic::MOST_WORK), or more where somebody asks for it.
    pub work: f64,
}

/// The periodic motion on a grid that is fine enough: it holds the coefficients, and the last harmonics are small. A grid that is too coarse can have no solution; after
/// `FAILURES` of them there is none. With the work of the search.
pub(crate) fn settled(
    system: &dyn DrivenHamiltonian,
    rates: &[f64],
    DrivenOptions { order, tolerance, harmonics, work: most, .. }: DrivenOptions,
    progress: &mut Progress<'_>,
) -> Result<(PeriodicMotion, f64), Error> {
    let mut halves = first(system, rates.len(), harmonics);
    let (mut known, mut failures, mut spent): (Option<Begin>, _, _) = (None, 0, 0.0);
    loop {
        let phases: Vec<_> = rates.iter().copied().zip(halves.iter().copied()).collect();
        let grid = Grid::new(&phases);
        if rates.len() > 1 && grid.times() > MOST_TIMES {
            return Err(Error::GridTooLarge { times: grid.times(), bound: MOST_TIMES });
        }
        let mut going = |work: f64| {
            spent += work;
            if spent > most { Err(too_large(&grid, most)) } else { stop(progress(0, order), 0, order) }
        };
        going(of_step(system, &grid))?;
        let between = system.between_times(&grid)?;
        let resolved = between <= BETWEEN * tolerance;
        let mut found = resolved.then(|| on_grid(system, &grid, known.as_ref(), &mut going));
        // A grid that is too coarse says nothing about the motion.
        failures += usize::from(matches!(&found, Some(Err(error)) if !matches!(error, Error::GridTooFine { .. })));
        if failures == FAILURES && matches!(found, Some(Err(Error::NoPeriodicMotion { .. }))) {
            found = beside(system, &grid, &mut going)?.map(Ok).or(found);
        }
        let tails = tails(found.as_ref(), between, rates.len())?;
        let rounding = || found.as_ref().and_then(|found| found.as_ref().ok()).map_or(0.0, PeriodicMotion::rounding);
        let coarse: Vec<bool> = tails.iter().map(|&tail| tail > tolerance && tail > rounding()).collect();
        let is_last = failures >= FAILURES && matches!(found, Some(Err(_)));
        if let Some(found) = &found
            && (!coarse.contains(&true) || is_last || rates.is_empty())
        {
            return found.clone().map(|motion| (motion, spent));
        }
        if halves.iter().zip(&coarse).any(|(&half, &coarse)| coarse && half == harmonics) {
            let rest = tails.iter().copied().fold(0.0, f64::max);
            let too_fine = Error::GridTooFine { harmonics, rest, tolerance };
            return Err(found.and_then(Result::err).unwrap_or(too_fine));
        }
        known = found.and_then(Result::ok).map(|motion| motion.begin()).or(known);
        for (half, _) in halves.iter_mut().zip(coarse).filter(|(_, coarse)| *coarse) {
            *half = (*half + *half / 4).next_multiple_of(4).min(harmonics);
        }
    }
}

/// The harmonics of each phase on the first grid.
fn first(system: &dyn DrivenHamiltonian, phases: usize, harmonics: usize) -> Vec<usize> {
    let known = system.harmonics().iter().copied().chain(std::iter::repeat(FEWEST));
    known.take(phases).map(|half| half.max(FEWEST).next_multiple_of(4).min(harmonics)).collect()
}

/// The last harmonics of a motion, or of the coefficients where these are not resolved; infinite without a motion.
///
/// # Errors
/// - Those that end the search.
fn tails(found: Option<&Result<PeriodicMotion, Error>>, between: f64, phases: usize) -> Result<Vec<f64>, Error> {
    Ok(match found {
        Some(Ok(motion)) => motion.tails.clone(),
        Some(Err(error)) if ends(error) => return Err(error.clone()),
        Some(Err(_)) => vec![f64::INFINITY; phases],
        // Infinite for a NaN.
        None => vec![if between.is_nan() { f64::INFINITY } else { between }; phases],
    })
}

/// The periodic motion from that of a coarser grid, from the state that the user knows, or from the equilibrium.
fn on_grid(
    system: &dyn DrivenHamiltonian,
    grid: &Grid,
    known: Option<&Begin>,
    going: &mut Going<'_>,
) -> Result<PeriodicMotion, Error> {
    if let (None, Some(start)) = (known, system.start()) {
        let begin = Begin::at(grid.clone(), orbit(system, grid, start, going)?);
        return PeriodicMotion::new(system, grid.clone(), Some(&begin), going);
    }
    PeriodicMotion::new(system, grid.clone(), known, going)
}

/// The smallest of the periodic motions that begin at those of the nearest rates which have one.
fn beside(system: &dyn DrivenHamiltonian, grid: &Grid, going: &mut Going<'_>) -> Result<Option<PeriodicMotion>, Error> {
    let response = response(system, grid, going)?;
    for part in BESIDE {
        let mut found: Option<PeriodicMotion> = None;
        for factor in [1.0 + part, 1.0 - part] {
            let beside = PeriodicMotion::new(system, grid.faster(factor), None, going);
            let here = beside.and_then(|beside| {
                let begin = Begin::at(beside.grid, beside.origin).beside(response.as_deref());
                PeriodicMotion::new(system, grid.clone(), Some(&begin), going)
            });
            match here {
                Ok(here) if found.as_ref().is_none_or(|found| here.size() < found.size()) => found = Some(here),
                Err(error) if ends(&error) => return Err(error),
                _ => {}
            }
        }
        if found.is_some() {
            return Ok(found);
        }
    }
    Ok(None)
}
