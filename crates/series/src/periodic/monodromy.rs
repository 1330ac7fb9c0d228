//! The matrix of solutions of ż = J S(M) z over one period, by Taylor series.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_complex::Complex;

use super::grid::Grid;
use super::row::Periodic;
use crate::birkhoff::matrix::{Matrix, turned_rows};

/// The order of the series; a step times the rates of S and of its harmonics is at most `REACH`, so that the first neglected term is below 1e-17.
const ORDER: usize = 28;
const REACH: f64 = 3.0;

/// Φ at the times of a grid of one phase and after the period, 1 at the phase 0. If the rate is negative, the solution runs backwards in time.
pub(super) fn monodromy(grid: &Grid, second: &Matrix<Periodic>) -> Vec<DMatrix<f64>> {
    let (n, times, rate) = (second.len(), grid.times(), grid.rates()[0]);
    let moved = turned_rows(second);
    let harmonics: Vec<Vec<Complex<f64>>> = moved.iter().flatten().map(|entry| grid.harmonics(entry)).collect();
    let half = (times / 2) as i64;
    let largest: f64 = moved.iter().flatten().map(Periodic::size).fold(0.0, f64::max) * n as f64 / rate.abs();
    let gap = TAU / times as f64;
    let parts = (gap * largest.max(half as f64) / REACH).ceil().max(1.0) as usize;
    let step = gap / parts as f64;
    let mut course = vec![DMatrix::identity(n, n)];
    let mut last = DMatrix::identity(n, n);
    for place in 0..times {
        for part in 0..parts {
            let start = place as f64 * gap + part as f64 * step;
            let matrices = taylor(&harmonics, (n, half), start, (step, step / rate));
            last = advanced(&matrices, &last);
        }
        course.push(last.clone());
    }
    course
}

/// The Taylor coefficients of J S about a phase in powers of a step of the phase, times the step of the time. `steps` are those of the phase and of the time.
fn taylor(
    harmonics: &[Vec<Complex<f64>>],
    (n, half): (usize, i64),
    start: f64,
    steps: (f64, f64),
) -> Vec<DMatrix<f64>> {
    let times = 2 * half as usize + 1;
    let mut matrices = vec![DMatrix::zeros(n, n); ORDER];
    for (entry, all) in harmonics.iter().enumerate() {
        if all.iter().all(|c| *c == Complex::default()) {
            continue;
        }
        for (at, &c) in all.iter().enumerate() {
            let j = if at as i64 <= half { at as i64 } else { at as i64 - times as i64 } as f64;
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
