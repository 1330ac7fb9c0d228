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
use super::sources::{Amplitudes, Passing, Place, Source, Wobbling};
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
        // Rates do not depend on the initial attitude, so these entries remain 0.
        let mut entries = [[Lanes::splat(simd, 0.0); ROW]; 2];
        let mut rows = [[0.0; ROW]; WIDEST];
        let mut start = 0;
        while start < times.len() {
            let stop = times.len().min(start + width);
            let mut block = [times[start]; WIDEST];
            block[..stop - start].copy_from_slice(&times[start..stop]);
            let elapsed = elapsed(Lanes::load(simd, &block), origin);
            let place = source.place(simd, setting, elapsed);
            columns(&place, source, setting, initial, &mut entries);
            store(&entries[0], &mut rows, &mut attitudes[start..stop]);
            store(&entries[1], &mut rows, &mut rates[start..stop]);
            start = stop;
        }
    }
}

/// The derivatives of one vector in lanes, row by row as in memory.
type Entries<S> = [Lanes<S>; ROW];

/// Derivatives of attitude and rates at some times.
#[inline(always)]
fn columns<S: InstructionSet, T: Source>(
    place: &Place<S, T::Rest<S>>,
    source: &T,
    setting: &Setting,
    initial: QuaternionLanes<S>,
    [attitudes, rates]: &mut [Entries<S>; 2],
) {
    let Place { attitude: [x, y, z, w], rates: rate, rest } = place;
    let one = x.all(1.0);
    let carried = (QuaternionLanes([-*x, -*y, -*z, *w]) * initial).rows();
    let nu = setting.user_rates;
    let [g, h, k] = [rate[0] * one.all(1.0 / nu[0]), rate[1] * one.all(1.0 / nu[1]), rate[2] * one.all(1.0 / nu[2])];
    for row in 0..3 {
        for axis in 0..3 {
            attitudes[PARAMETERS * row + axis] = carried[row][axis];
        }
    }
    for parameter in 0..CHANGES {
        let Change { axis, lever, inverse_moment, .. } = setting.changes[parameter];
        let (change, along) = source.change(rest, parameter);
        let lever = one.all(lever);
        let [a, b, c] = [
            lever.mul_add(carried[0][axis], -change[0]),
            lever.mul_add(carried[1][axis], -change[1]),
            lever.mul_add(carried[2][axis], -change[2]),
        ];
        let turned = [
            along.mul_add(g, k.negate_mul_add(b, h * c)),
            along.mul_add(h, g.negate_mul_add(c, k * a)),
            along.mul_add(k, h.negate_mul_add(a, g * b)),
        ];
        for row in 0..3 {
            attitudes[PARAMETERS * row + 3 + parameter] = turned[row];
            rates[PARAMETERS * row + 3 + parameter] = change[row] * one.all(nu[row]);
        }
        let entry = PARAMETERS * axis + 3 + parameter;
        rates[entry] = rate[axis].mul_add(one.all(inverse_moment), rates[entry]);
    }
}

/// The matrices of some times in memory order, one row of `ROW` numbers for each lane.
///
/// They are collected here, in the nearest cache, and copied in one piece. Writing four numbers of each matrix in turn to the outputs themselves, which are beyond
/// the second cache for 20,000 times, took 29 ns a sample for the stores alone instead of 17.
type Rows = [[f64; ROW]; WIDEST];

/// Numbers of a matrix.
const ROW: usize = 3 * PARAMETERS;

/// Transposes the entries and copies the matrices to the output.
#[inline(always)]
fn store<S: InstructionSet>(entries: &Entries<S>, rows: &mut Rows, matrices: &mut [Derivatives]) {
    four::<S, 0>(entries, rows);
    four::<S, 4>(entries, rows);
    four::<S, 8>(entries, rows);
    four::<S, 12>(entries, rows);
    four::<S, 16>(entries, rows);
    four::<S, 20>(entries, rows);
    // They overlap those before them.
    four::<S, 23>(entries, rows);
    let out = matrices.as_flattened_mut().as_flattened_mut();
    let length = out.len();
    out.copy_from_slice(&rows.as_flattened()[..length]);
}

/// Four entries of each matrix. The place is a constant, so that every store has a constant address.
#[inline(always)]
fn four<S: InstructionSet, const FIRST: usize>(entries: &Entries<S>, rows: &mut Rows) {
    let columns = [entries[FIRST], entries[FIRST + 1], entries[FIRST + 2], entries[FIRST + 3]];
    Lanes::store_fours_at::<ROW, FIRST>(columns, rows);
}
