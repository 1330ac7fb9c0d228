//! Derivatives at many times, several of them at once (theory §12).
//!
//! Conservation of the angular momentum, δL = R0 δG0, gives the derivatives of the attitude from those of g, except for the component along g, which grows with
//! twice the change of the energy:
//!
//! ```text
//! δθ = g × (RᵀR0 δg0 − δg) + g (g·δθ)
//! ```
//!
//! All quantities are in units of M = 1 and of the scaled time.

use nalgebra::UnitQuaternion;
use pulp::Arch;

use crate::error::Error;
use crate::input::options::Method;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::numerics::scaling::scaled;
use crate::simd::circles::Evaluate;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::{Lanes, WIDEST};
use crate::simd::phase::elapsed;
use crate::solve::untruncated;
use crate::torque_free::closed_form::ClosedForm;
use crate::torque_free::polhode::Polhode;

use super::constants::{CHANGES, Change, Constants, Setting};
use super::integral::Integral;
use super::sources::{Amplitudes, COLUMNS, NUMBERS, Passing, Place, Source, Wobbling, direction, parameters};
use super::{Derivatives, PARAMETERS};

/// Smallest number of samples for each thread. With fewer samples another thread costs more than it saves.
const SAMPLES_PER_THREAD: usize = 1024;

/// The times of the derivatives, and the state at the epoch.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    pub(super) times: &'a [f64],
    pub(super) epoch: f64,
    /// Attitude at the epoch.
    pub(super) initial: UnitQuaternion<f64>,
    pub(super) setting: &'a Setting,
}

impl Target<'_> {
    /// Fills the outputs with the best instruction set available, on as many threads as are faster. Parts begin where lanes begin, so that no bit depends on
    /// the number of threads.
    pub(super) fn fill<T: Source + Sync>(self, source: &T, attitudes: &mut [Derivatives], rates: &mut [Derivatives]) {
        let length = self.times.len();
        if length < 2 * SAMPLES_PER_THREAD || rayon::current_num_threads() == 1 {
            dispatch(Arch::new(), Run { target: self, source, attitudes, rates });
            return;
        }
        let threads = (length / SAMPLES_PER_THREAD).min(rayon::current_num_threads());
        let part = length.div_ceil(threads).next_multiple_of(WIDEST);
        rayon::scope(|scope| {
            let outputs = attitudes.chunks_mut(part).zip(rates.chunks_mut(part));
            for (times, (attitudes, rates)) in self.times.chunks(part).zip(outputs) {
                let target = Target { times, ..self };
                scope.spawn(move |_| dispatch(Arch::new(), Run { target, source, attitudes, rates }));
            }
        });
    }

    /// Derivatives on a polhode, with every harmonic of the closed form.
    pub(super) fn wobbling(
        self,
        motion: &Motion,
        polhode: &Polhode,
        outputs: (&mut [Derivatives], &mut [Derivatives]),
    ) -> Result<(), Error> {
        if motion.plan.method != Method::Closed {
            let exact = untruncated(&motion.scene, polhode, motion.plan.mode)?;
            return self.wobbling(&exact, polhode, outputs);
        }
        let (attitudes, rates) = outputs;
        let theta = polhode.invariants.theta;
        let integral = Integral::new(&theta);
        let constants = Constants::all(self.setting, &theta, &integral);
        let anomaly_rate = scaled(motion.frequencies.anomaly, -polhode.scales.1);
        let amplitudes = |start| Amplitudes::new(self.setting, constants, anomaly_rate, theta.quarter, start);
        match &motion.trajectory {
            Trajectory::Wobble(truncated) => {
                let closed = ClosedForm::new(polhode, &theta);
                let tables = &truncated.with_series(&closed.series, closed.anomaly);
                let (sine, cosine) = (2.0 * tables.phases()[0].angle((0.0, 0.0))).sin_cos();
                let amplitudes = &amplitudes(integral.zeta((sine, cosine)));
                self.fill(&Wobbling { tables, integral: &integral, amplitudes }, attitudes, rates);
            }
            Trajectory::Passage(flip) => {
                let start = integral.zeta_of_passages(flip.passage.angle((0.0, 0.0)));
                let amplitudes = &amplitudes(start);
                self.fill(&Passing { flip, integral: &integral, amplitudes }, attitudes, rates);
            }
            Trajectory::Steady(_) | Trajectory::Gradient(_) | Trajectory::Integrated(_) => {}
        }
        Ok(())
    }
}

/// The loop over times, compiled for each instruction set.
struct Run<'a, T> {
    target: Target<'a>,
    source: &'a T,
    attitudes: &'a mut [Derivatives],
    rates: &'a mut [Derivatives],
}

impl<T: Source> Task for Run<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) {
        let Self { target: Target { times, epoch, initial, setting }, source, attitudes, rates } = self;
        let width = if T::VECTORS { Lanes::<S>::WIDTH } else { 1 };
        let origin = Lanes::splat(simd, epoch);
        let initial = QuaternionLanes::all(origin, &initial);
        let mut parts = [Part::<S, T>::new(simd, source, setting, 0); MOST_PARTS];
        for (index, part) in parts.iter_mut().enumerate().take(parts_of::<S>()).skip(1) {
            *part = Part::new(simd, source, setting, index * Lanes::<S>::WIDTH);
        }
        let mut numbers = [[0.0; WIDEST]; TOGETHER];
        let mut rows = [[0.0; LENGTH]; 2];
        let mut start = 0;
        while start < times.len() {
            let stop = times.len().min(start + width);
            let mut block = [times[start]; WIDEST];
            block[..stop - start].copy_from_slice(&times[start..stop]);
            let elapsed = elapsed(Lanes::load(simd, &block), origin);
            gather(setting, initial, &source.place(simd, setting, elapsed), &mut numbers);
            for place in (0..stop - start).step_by(at_once::<S>()) {
                matrices(simd, setting.user_rates, &parts, (&numbers, place), &mut rows);
            }
            for (rows, out) in rows.iter().zip([&mut attitudes[start..stop], &mut rates[start..stop]]) {
                let out = out.as_flattened_mut().as_flattened_mut();
                out.copy_from_slice(&rows[..out.len()]);
            }
            start = stop;
        }
    }
}

/// Numbers of a matrix.
const ROW: usize = 3 * PARAMETERS;
/// Numbers of the matrices of two times, and two more that a vector writes beyond the last one.
const WINDOW: usize = 2 * ROW + COLUMNS - CHANGES;
/// The matrices of as many times as the widest vectors have lanes, and the window of the last.
///
/// They are collected here, in the nearest cache, and copied in one piece.
const LENGTH: usize = (WIDEST - 1) * ROW + WINDOW;
/// Parts into which the narrowest vectors, two lanes, divide the parameters.
const MOST_PARTS: usize = CHANGES.div_ceil(2);

/// Parts into which the parameters are divided: one if they fit into the lanes.
const fn parts_of<S: InstructionSet>() -> usize {
    CHANGES.div_ceil(Lanes::<S>::WIDTH)
}

/// Times whose parameters are computed at once.
const fn at_once<S: InstructionSet>() -> usize {
    if Lanes::<S>::WIDTH > COLUMNS { 2 } else { 1 }
}

/// The elements of Rᵀ R0, g, the rates, and the numbers of the source: for each the times of a block.
type Numbers = [[f64; WIDEST]; TOGETHER];
const DIRECTION: usize = 9;
const RATES: usize = 12;
const REST: usize = 15;
const TOGETHER: usize = REST + NUMBERS;

/// Writes the numbers of the times of a block, a time a lane.
#[inline(always)]
fn gather<S: InstructionSet>(
    setting: &Setting,
    initial: QuaternionLanes<S>,
    place: &Place<S>,
    numbers: &mut Numbers,
) {
    let Place { attitude: [x, y, z, w], rates, numbers: rest } = place;
    let carried = (QuaternionLanes([-*x, -*y, -*z, *w]) * initial).rows();
    for row in 0..3 {
        for axis in 0..3 {
            carried[row][axis].store(&mut numbers[3 * row + axis]);
        }
    }
    let direction = direction(setting, *rates);
    for axis in 0..3 {
        direction[axis].store(&mut numbers[DIRECTION + axis]);
        rates[axis].store(&mut numbers[RATES + axis]);
    }
    for index in 0..NUMBERS {
        rest[index].store(&mut numbers[REST + index]);
    }
}

/// The constants of some parameters, one a lane.
struct Part<S: InstructionSet, T: Source> {
    first: usize,
    source: T::Columns<S>,
    /// For each axis, δg at the epoch along it.
    lever: [Lanes<S>; 3],
    /// For each axis, −1 over its moment where the parameter is this moment.
    inverse_moment: [Lanes<S>; 3],
}

impl<S: InstructionSet, T: Source> Clone for Part<S, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: InstructionSet, T: Source> Copy for Part<S, T> {}

impl<S: InstructionSet, T: Source> Part<S, T> {
    #[inline(always)]
    fn new(simd: S, source: &T, setting: &Setting, first: usize) -> Self {
        let on = |axis: usize, value: fn(&Change) -> f64| {
            move |parameter: usize| {
                let change = &setting.changes[parameter];
                if change.axis == axis { value(change) } else { 0.0 }
            }
        };
        let (lever, inverse): (fn(&Change) -> f64, fn(&Change) -> f64) = (|c| c.lever, |c| c.inverse_moment);
        let mut part = Self {
            first,
            source: source.columns(simd, first),
            lever: [Lanes::splat(simd, 0.0); 3],
            inverse_moment: [Lanes::splat(simd, 0.0); 3],
        };
        for axis in 0..3 {
            part.lever[axis] = parameters(simd, first, on(axis, lever));
            part.inverse_moment[axis] = parameters(simd, first, on(axis, inverse));
        }
        part
    }
}

/// A number at the time `place` of a block, or at this and the next one if vectors have lanes for the parameters of both.
#[inline(always)]
fn at<S: InstructionSet>(simd: S, number: &[f64; WIDEST], place: usize) -> Lanes<S> {
    match at_once::<S>() {
        2 => Lanes::of_two(simd, number[place], number[(place + 1) % WIDEST]),
        _ => Lanes::splat(simd, number[place]),
    }
}

/// Writes the matrices of one time, or of two.
#[inline(always)]
fn matrices<S: InstructionSet, T: Source>(
    simd: S,
    nu: [f64; 3],
    parts: &[Part<S, T>; MOST_PARTS],
    (numbers, place): (&Numbers, usize),
    [attitudes, rates]: &mut [[f64; LENGTH]; 2],
) {
    let first = place * ROW;
    let (Some(attitudes), Some(rates)) =
        (attitudes[first..].first_chunk_mut::<WINDOW>(), rates[first..].first_chunk_mut::<WINDOW>())
    else {
        return;
    };
    let mut carried = [[Lanes::splat(simd, 0.0); 3]; 3];
    let mut direction = [Lanes::splat(simd, 0.0); 3];
    let mut rate = direction;
    let mut rest = [direction[0]; NUMBERS];
    for row in 0..3 {
        for axis in 0..3 {
            carried[row][axis] = at(simd, &numbers[3 * row + axis], place);
        }
        direction[row] = at(simd, &numbers[DIRECTION + row], place);
        rate[row] = at(simd, &numbers[RATES + row], place);
    }
    for index in 0..NUMBERS {
        rest[index] = at(simd, &numbers[REST + index], place);
    }
    let [g, h, k] = direction;
    let mut index = 0;
    while index < parts_of::<S>() {
        let Part { first, source, lever, inverse_moment } = &parts[index];
        let (change, along) = T::change(source, direction, rest);
        let mut moved = change;
        for row in 0..3 {
            // One of the three levers is not 0.
            let [a, b, c] = carried[row];
            moved[row] = lever[2].mul_add(c, lever[1].mul_add(b, lever[0].mul_add(a, -change[row])));
        }
        let [a, b, c] = moved;
        let turned = [
            along.mul_add(g, k.negate_mul_add(b, h * c)),
            along.mul_add(h, g.negate_mul_add(c, k * a)),
            along.mul_add(k, h.negate_mul_add(a, g * b)),
        ];
        for row in 0..3 {
            store(turned[row], attitudes, row, *first);
            let by_moment = rate[row].mul_add(inverse_moment[row], change[row] * rate[row].all(nu[row]));
            store(by_moment, rates, row, *first);
        }
        index += 1;
    }
    // The columns of the initial attitude come last: vectors have written beyond the rows before them.
    for time in 0..at_once::<S>() {
        for row in 0..3 {
            for axis in 0..3 {
                let entry = time * ROW + PARAMETERS * row + axis;
                attitudes[entry] = numbers[3 * row + axis][(place + time) % WIDEST];
                // Rates do not depend on the initial attitude.
                rates[entry] = 0.0;
            }
        }
    }
}

/// Writes the parameters from `first` on in one row of the matrices of one time, or of two.
#[inline(always)]
fn store<S: InstructionSet>(parameters: Lanes<S>, window: &mut [f64; WINDOW], row: usize, first: usize) {
    let mut strand = 0;
    while strand < S::STRANDS {
        let column = first + strand * S::F64_LANES;
        let place = column / COLUMNS * ROW + PARAMETERS * row + 3 + column % COLUMNS;
        parameters.store_strand(strand, &mut window[place..place + S::F64_LANES]);
        strand += 1;
    }
}
