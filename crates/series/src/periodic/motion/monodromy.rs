//! The matrix of solutions of ż = J S(M) z over one period, by Taylor series.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_complex::Complex;

use super::work::{Going, of_taylor_step};
use crate::birkhoff::matrix::{Matrix, turned_rows};
use crate::error::Error;
use crate::periodic::rows::grid::Grid;
use crate::periodic::rows::row::Periodic;

/// The order of the series; a step times the rates of S and of its harmonics is at most `REACH`, so that the first neglected term is below 1e-17.
const ORDER: usize = 28;
const REACH: f64 = 3.0;

/// Harmonics below this part of the largest value are rounding.
const ROUNDING: f64 = 1e-16;

/// Most steps over a period.
const MOST_STEPS: usize = 100_000;

/// The largest entry of Φ: beyond it the multipliers of the other modes are rounding.
const MOST_GROWTH: f64 = 1e14;

/// Φ at the times of a grid of one phase and after the period, 1 at the phase 0. If the rate is negative, the solution runs backwards in time.
///
/// # Errors
/// - more than [`MOST_STEPS`] steps: [`Error::PhaseTooSlow`]; growth beyond [`MOST_GROWTH`]: [`Error::GrowthTooLarge`]; those of `going`, which is told the work.
pub(super) fn monodromy(
    grid: &Grid,
    second: &Matrix<Periodic>,
    going: &mut Going<'_>,
) -> Result<Vec<DMatrix<f64>>, Error> {
    let (n, times, rate) = (second.len(), grid.times(), grid.rates()[0]);
    let moved = turned_rows(second);
    let harmonics: Vec<_> = moved.iter().flatten().map(|entry| harmonics(grid, entry)).collect();
    let half = times / 2;
    let largest = fastest(second) * n as f64 / rate.abs();
    let gap = TAU / times as f64;
    let parts = (gap * largest.max(half as f64) / REACH).ceil().max(1.0);
    if parts * times as f64 > MOST_STEPS as f64 {
        return Err(Error::PhaseTooSlow { rate, steps: parts * times as f64, bound: MOST_STEPS });
    }
    let parts = parts as usize;
    let step = gap / parts as f64;
    let terms = harmonics.iter().map(Vec::len).sum();
    going((parts * times) as f64 * of_taylor_step(n, ORDER, terms))?;
    let mut course = vec![DMatrix::identity(n, n)];
    let mut last = DMatrix::identity(n, n);
    for place in 0..times {
        for part in 0..parts {
            let start = place as f64 * gap + part as f64 * step;
            let matrices = taylor(&harmonics, n, start, (step, step / rate));
            last = advanced(&matrices, &last);
        }
        if !last.iter().all(|entry| entry.abs() <= MOST_GROWTH) {
            return Err(Error::GrowthTooLarge { rate, bound: MOST_GROWTH });
        }
        course.push(last.clone());
    }
    Ok(course)
}

/// The largest entry of J S in units of the variables in which the second derivatives with respect to q and p of each pair have one size.
fn fastest(second: &Matrix<Periodic>) -> f64 {
    let own = |slot: usize| second[slot][slot].size();
    let unit = |slot: usize| {
        let unit = (own(slot ^ 1) / own(slot)).powf(0.25);
        if unit.is_normal() { unit } else { 1.0 }
    };
    let entries = second.iter().enumerate().flat_map(|(i, row)| row.iter().enumerate().map(move |(j, c)| (i, j, c)));
    entries.map(|(i, j, c)| c.size() * unit(i) * unit(j)).fold(0.0, f64::max)
}

/// The harmonics of an entry that are above rounding, with their multiples: Newton's iteration towards the frame takes away what the others do.
fn harmonics(grid: &Grid, entry: &Periodic) -> Vec<(f64, Complex<f64>)> {
    let rounding = ROUNDING * entry.size();
    let all = grid.harmonics(entry).into_iter().enumerate().filter(|(_, c)| c.norm() > rounding);
    all.map(|(at, c)| (grid.multiples(at)[0] as f64, c)).collect()
}

/// The Taylor coefficients of J S about a phase in powers of a step of the phase, times the step of the time. `steps` are those of the phase and of the time.
fn taylor(harmonics: &[Vec<(f64, Complex<f64>)>], n: usize, start: f64, steps: (f64, f64)) -> Vec<DMatrix<f64>> {
    let mut matrices = vec![DMatrix::zeros(n, n); ORDER];
    for (entry, all) in harmonics.iter().enumerate() {
        for &(j, c) in all {
            let mut term = c * Complex::cis(j * start) * steps.1;
            for (k, matrix) in matrices.iter_mut().enumerate() {
                matrix[(entry / n, entry % n)] += term.re;
                term *= Complex::new(0.0, j * steps.0) / (k + 1) as f64;
            }
        }
    }
    matrices
}

fn advanced(matrices: &[DMatrix<f64>], start: &DMatrix<f64>) -> DMatrix<f64> {
    let mut coefficients = vec![start.clone()];
    let mut sum = start.clone();
    for k in 0..ORDER {
        let mut next = DMatrix::zeros(start.nrows(), start.ncols());
        for (l, matrix) in matrices.iter().enumerate().take(k + 1) {
            next.gemm(1.0, matrix, &coefficients[k - l], 1.0);
        }
        next /= (k + 1) as f64;
        sum += &next;
        coefficients.push(next);
    }
    sum
}
