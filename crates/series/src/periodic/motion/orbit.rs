//! The solution from a state over a period of a driven phase, to begin the search for a periodic motion.

use std::f64::consts::TAU;

use super::work::{Going, of_values};
use crate::error::Error;
use crate::monomial::MAX_EXPONENT;
use crate::periodic::hamiltonian::DrivenHamiltonian;
use crate::periodic::rows::grid::Grid;
use crate::periodic::rows::row::Periodic;
use crate::polynomial::Polynomial;

/// Steps of the method of Runge and Kutta over a period, at least: Newton's iteration takes their error away.
const STEPS: usize = 400;

/// The solution from `start` at the phase 0, at the times of a grid of one phase. What it misses after the period is taken away in proportion to the time.
///
/// # Errors
/// - several phases, or another number of variables: [`Error::StartUnsupported`]; a solution that is not finite: [`Error::NoPeriodicMotion`]; those of `going`.
pub(super) fn orbit(
    system: &dyn DrivenHamiltonian,
    grid: &Grid,
    start: &[f64],
    going: &mut Going<'_>,
) -> Result<Vec<Periodic>, Error> {
    let n = 2 * system.pairs();
    if grid.phases() != 1 || start.len() != n || !start.iter().all(|x| x.is_finite()) {
        return Err(Error::StartUnsupported { start: start.to_vec(), variables: n, phases: grid.phases() });
    }
    let variables: Vec<_> = (0..n).map(Polynomial::variable).collect::<Result<_, _>>()?;
    let energy = system.expanded(grid, &variables, MAX_EXPONENT)?;
    let slopes: Vec<_> = (0..n).map(|slot| energy.derivative(slot)).collect::<Result<_, _>>()?;
    let (times, rate) = (grid.times(), grid.rates()[0]);
    let parts = STEPS.div_ceil(times);
    let terms: usize = slopes.iter().map(Polynomial::len).sum();
    going(of_values(4 * parts * times * terms, times))?;
    let gap = TAU / (parts * times) as f64;
    let slope = |phase: f64, state: &[f64]| -> Result<Vec<f64>, Error> {
        let weights = grid.weights(&[phase]);
        let value = |slope: &Polynomial<Periodic>| slope.map(|c| c.weighted(&weights).re).evaluate(state);
        let values: Vec<f64> = slopes.iter().map(value).collect::<Result<_, _>>()?;
        Ok((0..n).map(|slot| if slot % 2 == 0 { values[slot + 1] } else { -values[slot - 1] } / rate).collect())
    };
    let moved = |state: &[f64], by: &[f64], step: f64| -> Vec<f64> {
        state.iter().zip(by).map(|(x, slope)| x + step * slope).collect()
    };
    let mut states = vec![start.to_vec()];
    for number in 0..parts * times {
        let (phase, state) = (number as f64 * gap, &states[number]);
        let first = slope(phase, state)?;
        let second = slope(phase + gap / 2.0, &moved(state, &first, gap / 2.0))?;
        let third = slope(phase + gap / 2.0, &moved(state, &second, gap / 2.0))?;
        let last = slope(phase + gap, &moved(state, &third, gap))?;
        let sum: Vec<f64> = (0..n).map(|k| first[k] + 2.0 * second[k] + 2.0 * third[k] + last[k]).collect();
        states.push(moved(state, &sum, gap / 6.0));
    }
    let end = &states[parts * times];
    if !end.iter().all(|x| x.is_finite()) {
        return Err(Error::NoPeriodicMotion { miss: f64::MAX, steps: 0 });
    }
    let value =
        |slot: usize, at: usize| states[parts * at][slot] - (end[slot] - start[slot]) * at as f64 / times as f64;
    let row = |slot: usize| Periodic::of(&(0..times).map(|at| value(slot, at).into()).collect::<Vec<_>>());
    Ok((0..n).map(row).collect())
}
