//! Bodies and their rotations in lanes: what the constants of a polhode are computed from.

use andoyer_double::DoubleDouble;

use crate::simd::double_double_lanes::DoubleDoubleLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::{Lanes, WIDEST};

/// A body and its rotation, on the sorted axes and in scaled units.
#[derive(Clone, Copy, Debug)]
pub(super) struct SortedState {
    pub(super) moments: [DoubleDouble; 3],
    /// The parts of G, products of a moment and a rate; or g, with M = 1.
    pub(super) rotation: Rotation,
    pub(super) long_axis: bool,
}

/// The rotation of a body.
#[derive(Clone, Copy, Debug)]
pub(super) enum Rotation {
    /// Its rates.
    Rates([DoubleDouble; 3]),
    /// The squares of g, and M.
    Squares([DoubleDouble; 3], DoubleDouble),
}

/// The bodies in lanes.
pub(super) struct Columns<S: InstructionSet> {
    pub(super) moments: [DoubleDoubleLanes<S>; 3],
    pub(super) rates: [DoubleDoubleLanes<S>; 3],
    /// Squares of g and M.
    pub(super) squares: [DoubleDoubleLanes<S>; 4],
    /// 0 where the rates are given, 1 where the squares are.
    pub(super) by_squares: Lanes<S>,
    /// −1 for the long-axis mode, otherwise 1.
    pub(super) sign: Lanes<S>,
}

/// −1 for the long-axis mode, otherwise 1.
fn sign(body: &SortedState) -> f64 {
    if body.long_axis { -1.0 } else { 1.0 }
}

impl<S: InstructionSet> Columns<S> {
    /// One body in all lanes.
    #[inline(always)]
    pub(super) fn all(simd: S, body: &SortedState) -> Self {
        let (rates, squares, momentum, by_squares) = match body.rotation {
            Rotation::Rates(rates) => (rates, [DoubleDouble::ONE; 3], DoubleDouble::ONE, 0.0),
            Rotation::Squares(squares, momentum) => ([DoubleDouble::ONE; 3], squares, momentum, 1.0),
        };
        let [x, y, z] = squares;
        let mut columns = [DoubleDoubleLanes::splat(simd, momentum); 4];
        for (column, square) in columns.iter_mut().zip([x, y, z]) {
            *column = DoubleDoubleLanes::splat(simd, square);
        }
        let [mut by_axis, mut by_rate] = [[columns[0]; 3]; 2];
        for axis in 0..3 {
            by_axis[axis] = DoubleDoubleLanes::splat(simd, body.moments[axis]);
            by_rate[axis] = DoubleDoubleLanes::splat(simd, rates[axis]);
        }
        Self {
            moments: by_axis,
            rates: by_rate,
            squares: columns,
            by_squares: Lanes::splat(simd, by_squares),
            sign: Lanes::splat(simd, sign(body)),
        }
    }

    /// A body in each lane. A lane without a body has the first one.
    #[inline(always)]
    pub(super) fn load(simd: S, given: &[SortedState]) -> Self {
        let [mut moments, mut rates] = [[[[1.0; WIDEST], [0.0; WIDEST]]; 3]; 2];
        let mut squares = [[[1.0; WIDEST]; 2]; 4];
        let (mut by_squares, mut signs) = ([0.0; WIDEST], [1.0; WIDEST]);
        for lane in 0..Lanes::<S>::WIDTH {
            let Some(body) = given.get(lane).or(given.first()) else { break };
            signs[lane] = sign(body);
            for (column, moment) in moments.iter_mut().zip(body.moments) {
                (column[0][lane], column[1][lane]) = (moment.high, moment.low);
            }
            match body.rotation {
                Rotation::Rates(given) => {
                    for (column, rate) in rates.iter_mut().zip(given) {
                        (column[0][lane], column[1][lane]) = (rate.high, rate.low);
                    }
                }
                Rotation::Squares([x, y, z], momentum) => {
                    by_squares[lane] = 1.0;
                    for (column, value) in squares.iter_mut().zip([x, y, z, momentum]) {
                        (column[0][lane], column[1][lane]) = (value.high, value.low);
                    }
                }
            }
        }
        let mut columns = [DoubleDoubleLanes::splat(simd, DoubleDouble::ONE); 4];
        for (column, [high, low]) in columns.iter_mut().zip(&squares) {
            *column = DoubleDoubleLanes::load(simd, high, low);
        }
        let [mut by_axis, mut by_rate] = [[columns[0]; 3]; 2];
        for axis in 0..3 {
            by_axis[axis] = DoubleDoubleLanes::load(simd, &moments[axis][0], &moments[axis][1]);
            by_rate[axis] = DoubleDoubleLanes::load(simd, &rates[axis][0], &rates[axis][1]);
        }
        Self {
            moments: by_axis,
            rates: by_rate,
            squares: columns,
            by_squares: Lanes::load(simd, &by_squares),
            sign: Lanes::load(simd, &signs),
        }
    }
}
