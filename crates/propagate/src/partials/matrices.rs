//! The matrices of derivatives of some times, with a parameter in each lane (theory §12).
//!
//! Eight lanes have the last eight columns of a row: two of the initial attitude, then those of the six parameters that change the polhode. Sixteen lanes have
//! them for two times. A row of a matrix is then a vector, which is stored where it belongs. With a time in each lane, as attitudes and rates are computed, the
//! matrices had to be transposed through the memory: calls with 2,000 times took half as long again.

use super::constants::{Change, Setting};
use super::derivatives::{Derivatives, PARAMETERS};
use super::sources::{COLUMNS, Constant, NUMBERS, PartialsPlace, PartialsSource, UNCHANGING, at_once, direction};
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::{Lanes, WIDEST};

/// Numbers of a matrix.
const ROW: usize = 3 * PARAMETERS;
/// Numbers of the matrices of two times.
const WINDOW: usize = 2 * ROW;
/// Numbers of the matrices of as many times as the widest vectors have lanes, and of one more, because a window begins at each of them.
const LENGTH: usize = (WIDEST + 1) * ROW;
/// Parts into which the narrowest vectors, two lanes, divide the columns.
const MOST_PARTS: usize = (COLUMNS - UNCHANGING).div_ceil(2);

/// The first column in lanes: 0, or with two lanes the first of a parameter that changes the polhode.
const fn first_column<S: InstructionSet>() -> usize {
    UNCHANGING / Lanes::<S>::WIDTH * Lanes::<S>::WIDTH
}

/// Parts into which the columns are divided: one if they fit into the lanes.
const fn parts_of<S: InstructionSet>() -> usize {
    (COLUMNS - first_column::<S>()).div_ceil(Lanes::<S>::WIDTH)
}

/// The constants of some columns, one a lane.
pub(super) struct Part<S: InstructionSet, T: PartialsSource> {
    source: T::Columns<S>,
    /// For each axis, δg at the epoch along it.
    lever: [Constant<S>; 3],
    /// For each axis, −1 over its moment where the parameter is this moment.
    inverse_moment: [Constant<S>; 3],
    /// ν_i of each of the user's axes.
    rates: [Constant<S>; 3],
}

impl<S: InstructionSet, T: PartialsSource> Clone for Part<S, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: InstructionSet, T: PartialsSource> Copy for Part<S, T> {}

impl<S: InstructionSet, T: PartialsSource> Part<S, T> {
    /// All parts; only as many as the instruction set needs are different.
    #[inline(always)]
    pub(super) fn all(simd: S, source: &T, setting: &Setting) -> [Self; MOST_PARTS] {
        let mut parts = [Self::new(simd, source, setting, first_column::<S>()); MOST_PARTS];
        for (index, part) in parts.iter_mut().enumerate().take(parts_of::<S>()).skip(1) {
            *part = Self::new(simd, source, setting, first_column::<S>() + index * Lanes::<S>::WIDTH);
        }
        parts
    }

    #[inline(always)]
    fn new(simd: S, source: &T, setting: &Setting, first: usize) -> Self {
        let zero = Constant::new(simd, first, |_| 0.0);
        let mut part =
            Self { source: source.columns(simd, first), lever: [zero; 3], inverse_moment: [zero; 3], rates: [zero; 3] };
        for axis in 0..3 {
            let on = |change: &Change, value: f64| if change.axis == axis { value } else { 0.0 };
            let changes = &setting.changes;
            part.rates[axis] = Constant::new(simd, first, |_| setting.user_rates[axis]);
            part.lever[axis] = Constant::new(simd, first, |index| on(&changes[index], changes[index].lever));
            part.inverse_moment[axis] =
                Constant::new(simd, first, |index| on(&changes[index], changes[index].inverse_moment));
        }
        part
    }

    /// Writes these columns, from `first` on, at one moment.
    #[inline(always)]
    fn write(&self, first: usize, moment: &Moment<S>, attitudes: &mut [f64; WINDOW], rates: &mut [f64; WINDOW]) {
        let Self { source, lever, inverse_moment, rates: nu } = self;
        let Moment { carried, direction, rates: rate, numbers } = moment;
        let (change, along) = T::change(source, *direction, *numbers);
        let zero = along.all(0.0);
        let mut moved = change;
        for row in 0..3 {
            // One of the three levers is not 0.
            let ([a, b, c], [p, q, r]) = (carried[row], *lever);
            moved[row] = r.lanes().mul_add(c, q.lanes().mul_add(b, p.lanes().mul_add(a, -change[row])));
        }
        let ([a, b, c], [g, h, k]) = (moved, *direction);
        let turned = [
            along.mul_add(g, k.negate_mul_add(b, h * c)),
            along.mul_add(h, g.negate_mul_add(c, k * a)),
            along.mul_add(k, h.negate_mul_add(a, g * b)),
        ];
        for row in 0..3 {
            store(turned[row], attitudes, row, first);
            // Rates do not depend on the initial attitude. The sum with 0 makes −0 in these columns 0.
            let faster = change[row].mul_add(nu[row].lanes(), zero);
            store(rate[row].mul_add(inverse_moment[row].lanes(), faster), rates, row, first);
        }
    }
}

/// The quantities of one time in all lanes, or of two times in half of the lanes each.
struct Moment<S: InstructionSet> {
    carried: [[Lanes<S>; 3]; 3],
    direction: [Lanes<S>; 3],
    rates: [Lanes<S>; 3],
    numbers: [Lanes<S>; NUMBERS],
}

/// Quantities with a time in each lane, and the matrices of these times.
///
/// The matrices of 16 times are collected here, in the nearest cache, and copied in one piece. The alternatives were not faster with 2,001 times and with
/// 20,001 times, where the caches keep no output: collecting the matrices of 32, 64 and 128 times, copying two matrices while the next ones are computed, and
/// writing them where they belong.
#[repr(C, align(64))]
pub(super) struct Block {
    /// Rᵀ R0.
    carried: [[[f64; WIDEST]; 3]; 3],
    /// g.
    direction: [[f64; WIDEST]; 3],
    rates: [[f64; WIDEST]; 3],
    /// The numbers of the source.
    numbers: [[f64; WIDEST]; NUMBERS],
    attitude_rows: [f64; LENGTH],
    rate_rows: [f64; LENGTH],
}

impl Block {
    pub(super) fn new() -> Self {
        Self {
            carried: [[[0.0; WIDEST]; 3]; 3],
            direction: [[0.0; WIDEST]; 3],
            rates: [[0.0; WIDEST]; 3],
            numbers: [[0.0; WIDEST]; NUMBERS],
            attitude_rows: [0.0; LENGTH],
            rate_rows: [0.0; LENGTH],
        }
    }

    /// Stores the quantities, with a time in each lane.
    #[inline(always)]
    pub(super) fn gather<S: InstructionSet>(
        &mut self,
        setting: &Setting,
        initial: QuaternionLanes<S>,
        place: &PartialsPlace<S>,
    ) {
        let PartialsPlace { attitude: [x, y, z, w], rates, numbers } = place;
        let carried = (QuaternionLanes([-*x, -*y, -*z, *w]) * initial).rows();
        let direction = direction(setting, *rates);
        for row in 0..3 {
            for (element, values) in carried[row].iter().zip(&mut self.carried[row]) {
                element.store(values);
            }
            direction[row].store(&mut self.direction[row]);
            rates[row].store(&mut self.rates[row]);
        }
        for (number, values) in numbers.iter().zip(&mut self.numbers) {
            number.store(values);
        }
    }

    /// The quantities of one time, or of two.
    #[inline(always)]
    fn moment<S: InstructionSet>(&self, simd: S, place: usize) -> Moment<S> {
        let zero = Lanes::splat(simd, 0.0);
        let mut moment =
            Moment { carried: [[zero; 3]; 3], direction: [zero; 3], rates: [zero; 3], numbers: [zero; NUMBERS] };
        for row in 0..3 {
            for axis in 0..3 {
                moment.carried[row][axis] = at(simd, &self.carried[row][axis], place);
            }
            moment.direction[row] = at(simd, &self.direction[row], place);
            moment.rates[row] = at(simd, &self.rates[row], place);
        }
        for (lanes, values) in moment.numbers.iter_mut().zip(&self.numbers) {
            *lanes = at(simd, values, place);
        }
        moment
    }

    /// Computes the matrices of the first `count` times.
    #[inline(always)]
    pub(super) fn fill<S: InstructionSet, T: PartialsSource>(
        &mut self,
        simd: S,
        parts: &[Part<S, T>; MOST_PARTS],
        count: usize,
    ) {
        for place in (0..count).step_by(at_once::<S>()) {
            let moment = self.moment(simd, place);
            let first = place * ROW;
            let (Some(attitudes), Some(rates)) = (
                self.attitude_rows[first..].first_chunk_mut::<WINDOW>(),
                self.rate_rows[first..].first_chunk_mut::<WINDOW>(),
            ) else {
                return;
            };
            let mut index = 0;
            while index < parts_of::<S>() {
                parts[index].write(first_column::<S>() + index * Lanes::<S>::WIDTH, &moment, attitudes, rates);
                index += 1;
            }
            // The columns of the initial attitude; in the matrices of the rates they stay 0.
            for time in 0..at_once::<S>() {
                for row in 0..3 {
                    for axis in 0..3 {
                        let entry = time * ROW + PARAMETERS * row + axis;
                        attitudes[entry] = self.carried[row][axis][(place + time) % WIDEST];
                    }
                }
            }
        }
    }

    /// Copies as many matrices as there are places.
    #[inline(always)]
    pub(super) fn copy_to(&self, attitudes: &mut [Derivatives], rates: &mut [Derivatives]) {
        for (rows, out) in [(&self.attitude_rows, attitudes), (&self.rate_rows, rates)] {
            let out = out.as_flattened_mut().as_flattened_mut();
            let length = out.len();
            out.copy_from_slice(&rows[..length]);
        }
    }
}

/// A number at the time `place` of a block, or at this and the next one if vectors have lanes for the parameters of both.
#[inline(always)]
fn at<S: InstructionSet>(simd: S, number: &[f64; WIDEST], place: usize) -> Lanes<S> {
    match at_once::<S>() {
        2 => Lanes::of_two(simd, number[place % WIDEST], number[(place + 1) % WIDEST]),
        _ => Lanes::splat(simd, number[place % WIDEST]),
    }
}

/// Writes the columns from `first` on in one row of the matrices of one time, or of two. The first column of a row is not in lanes.
#[inline(always)]
fn store<S: InstructionSet>(columns: Lanes<S>, window: &mut [f64; WINDOW], row: usize, first: usize) {
    let mut strand = 0;
    while strand < S::STRANDS {
        let column = first + strand * S::F64_LANES;
        let place = column / COLUMNS * ROW + PARAMETERS * row + 1 + column % COLUMNS;
        columns.store_strand(strand, &mut window[place..place + S::F64_LANES]);
        strand += 1;
    }
}
