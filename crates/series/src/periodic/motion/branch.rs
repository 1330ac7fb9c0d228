//! The order of modes, and the branch of their frequencies.
//!
//! Φ gives a frequency ω up to a multiple of the rate n. The branch is that of the rotation number: the mean rate at which the real solution Re U e^{iωt} of a mode turns in the plane
//! of its pair. In a plane with the complex vectors u and ū the solution has the parts a(M) e^{iωt} and b(M) e^{−iωt}. Where |a| > |b| at all phases it turns as a e^{iωt} does, so the
//! rotation number is ω if a does not wind about 0. |a|² − |b|² is the area of the mode in the plane: the areas in all planes have the sum 1, so with one pair |a| > |b| always holds.
//! With several pairs the planes are those of the mean of S, or those of the modes at the phase 0 where these are clearer. If a mode has no plane where |a| > |b| at all phases, the sum
//! over the modes decides: it belongs to det a, which is never 0 (D. Salamon and E. Zehnder, Commun. Pure Appl. Math. 45 (1992) 1303).

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_complex::Complex;

use crate::birkhoff::matrix::{Matrix, pairing};
use crate::birkhoff::mode::Mode;
use crate::periodic::rows::grid::Grid;
use crate::periodic::rows::row::Periodic;

/// The functions are followed at so many times the times of the grid.
const FINER: usize = 4;

/// A complex vector.
type Vector = Vec<Complex<f64>>;

/// The modes in the order of the planes, whose vectors q₁, p₁, q₂, … are the columns of `planes`, with the frequencies on the branch of the rotation number.
pub(super) fn continued(
    grid: &Grid,
    columns: Vec<Vec<Periodic>>,
    modes: Vec<Mode<f64>>,
    planes: &Matrix<f64>,
) -> (Vec<Vec<Periodic>>, Vec<Mode<f64>>) {
    let first: Vec<i64> =
        modes.iter().enumerate().map(|(mode, kind)| largest(grid, kind, &columns[2 * mode + 1])).collect();
    let (columns, modes): (Vec<_>, Vec<_>) = columns
        .chunks(2)
        .zip(modes)
        .zip(&first)
        .map(|((pair, mode), &j)| turned(grid, [&pair[0], &pair[1]], mode, j))
        .unzip();
    let solutions = solutions(grid, &columns, &modes);
    let column = |slot: usize| planes.iter().map(|row| row[slot]).collect::<Vec<_>>();
    let mean: Vec<Vector> = (0..modes.len()).map(|place| complex(&column(2 * place), &column(2 * place + 1))).collect();
    let order = assigned(areas(&solutions, &mean), modes.len());
    let mean = order.iter().map(|&place| mean[place].clone()).collect();
    let own =
        solutions.iter().map(|values| values[0].iter().map(|c| Complex::new(0.0, -2.0) * c.conj()).collect()).collect();
    let [mean, own] = [mean, own].map(|planes: Vec<Vector>| windings(&solutions, &planes, &modes));
    let chosen = if own.1 > mean.1 && mean.1 <= 0.0 { own.0 } else { mean.0 };
    let mut placed: Vec<_> = columns
        .into_iter()
        .zip(modes)
        .zip(chosen)
        .map(|((pair, mode), j)| turned(grid, [&pair[0], &pair[1]], mode, j))
        .zip(order)
        .collect();
    placed.sort_by_key(|&(_, place)| place);
    let (pairs, modes): (Vec<_>, Vec<_>) = placed.into_iter().map(|(mode, _)| mode).unzip();
    (pairs.into_iter().flatten().collect(), modes)
}

/// The multiple of the largest harmonic of U of a centre; 0 for a saddle.
fn largest(grid: &Grid, kind: &Mode<f64>, column: &[Periodic]) -> i64 {
    if !kind.is_elliptic() {
        return 0;
    }
    let rows: Vec<_> = column.iter().map(|entry| grid.harmonics(entry)).collect();
    let size = |at: usize| rows.iter().map(|row| row[at].norm_sqr()).sum::<f64>();
    let most = (0..grid.times()).fold(0, |most, at| if size(at) > size(most) { at } else { most });
    grid.multiples(most)[0]
}

/// The columns u e^{ijM} and U e^{−ijM} of a centre, whose frequency is larger by j n; a saddle as it is.
fn turned(grid: &Grid, pair: [&Vec<Periodic>; 2], mode: Mode<f64>, j: i64) -> ([Vec<Periodic>; 2], Mode<f64>) {
    let Mode::Elliptic { frequency, ratio } = mode else { return (pair.map(Clone::clone), mode) };
    let by = |column: &Vec<Periodic>, j: f64| -> Vec<Periodic> {
        let turn = grid.sampled(|phases| Complex::cis(j * phases[0]));
        column.iter().map(|entry| entry.clone() * turn.clone()).collect()
    };
    let frequency = frequency + j as f64 * grid.rates()[0];
    ([by(pair[0], j as f64), by(pair[1], -j as f64)], Mode::Elliptic { frequency, ratio })
}

/// u = q − ip of a plane.
fn complex(q: &[f64], p: &[f64]) -> Vector {
    q.iter().zip(p).map(|(&q, &p)| Complex::new(q, -p)).collect()
}

/// U of each mode at the times of a finer grid; U = (p − iq)/2 of a saddle with the columns q and p.
fn solutions(grid: &Grid, columns: &[[Vec<Periodic>; 2]], modes: &[Mode<f64>]) -> Vec<Vec<Vector>> {
    let times = FINER * grid.times();
    let weights: Vec<_> = (0..times).map(|at| grid.weights(&[TAU * at as f64 / times as f64])).collect();
    let value = |column: &[Periodic], weights: &[f64]| column.iter().map(|c| c.weighted(weights)).collect::<Vector>();
    let at = |([u, momentum], mode): (&[Vec<Periodic>; 2], &Mode<f64>), weights: &Vec<f64>| match mode {
        Mode::Elliptic { .. } => value(momentum, weights),
        _ => {
            let (q, p) = (value(u, weights), value(momentum, weights));
            q.iter().zip(&p).map(|(q, p)| (p - Complex::<f64>::i() * q) * 0.5).collect()
        }
    };
    columns.iter().zip(modes).map(|one| weights.iter().map(|weights| at(one, weights)).collect()).collect()
}

/// a and b of a vector U in the plane of u.
fn parts(plane: &Vector, solution: &Vector) -> [Complex<f64>; 2] {
    let opposite: Vector = plane.iter().map(Complex::conj).collect();
    [pairing(plane, solution), pairing(&opposite, solution)]
}

/// |a|² − |b|².
fn area(plane: &Vector, solution: &Vector) -> f64 {
    let [a, b] = parts(plane, solution);
    a.norm_sqr() - b.norm_sqr()
}

/// The mean area of each mode in each plane, with the numbers of both.
fn areas(solutions: &[Vec<Vector>], planes: &[Vector]) -> Vec<(f64, usize, usize)> {
    let mean =
        |values: &Vec<Vector>, plane| values.iter().map(|value| area(plane, value)).sum::<f64>() / values.len() as f64;
    let of = |(mode, values)| planes.iter().enumerate().map(move |(place, plane)| (mean(values, plane), mode, place));
    solutions.iter().enumerate().flat_map(of).collect()
}

/// The plane of each mode, from areas with mode and plane: the largest area first.
fn assigned(mut areas: Vec<(f64, usize, usize)>, count: usize) -> Vec<usize> {
    areas.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut places = vec![None; count];
    for (_, mode, place) in areas {
        if places[mode].is_none() && !places.contains(&Some(place)) {
            places[mode] = Some(place);
        }
    }
    places.into_iter().flatten().collect()
}

/// How often a of each mode winds about 0 in its plane while the phase makes a turn, and the smallest area of a centre in its plane.
fn windings(solutions: &[Vec<Vector>], planes: &[Vector], modes: &[Mode<f64>]) -> (Vec<i64>, f64) {
    let own = |(values, plane): (&Vec<Vector>, &Vector)| winding(values.iter().map(|value| parts(plane, value)[0]));
    let mut turns: Vec<i64> = solutions.iter().zip(planes).map(own).collect();
    let smallest =
        |mode: usize| solutions[mode].iter().map(|value| area(&planes[mode], value)).fold(f64::INFINITY, f64::min);
    let centres = (0..modes.len()).filter(|&mode| modes[mode].is_elliptic()).map(|mode| (smallest(mode), mode));
    let Some((clear, worst)) = centres.min_by(|a, b| a.0.total_cmp(&b.0)) else { return (turns, f64::INFINITY) };
    if clear <= 0.0 {
        let all =
            |at: usize| DMatrix::from_fn(planes.len(), planes.len(), |i, j| parts(&planes[i], &solutions[j][at])[0]);
        turns[worst] +=
            winding((0..solutions[worst].len()).map(|at| all(at).determinant())) - turns.iter().sum::<i64>();
    }
    (turns, clear)
}

/// How often a closed curve winds about 0.
fn winding(values: impl Iterator<Item = Complex<f64>>) -> i64 {
    let values: Vector = values.collect();
    let steps = values.iter().zip(values.iter().cycle().skip(1));
    (steps.map(|(one, next)| (next * one.conj()).arg()).sum::<f64>() / TAU).round() as i64
}
