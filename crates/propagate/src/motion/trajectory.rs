//! From a solved motion to arrays of attitudes and rates: several times at once, with the best instructions of the machine, on several threads.
//!
//! Kernels are written once over [`crate::simd::lanes`] and compiled for each instruction set ([`crate::simd::instruction_set`]). A time takes two phases in double-double, two
//! sines and cosines ([`crate::simd::sincos`]), the sums of theory §8 ([`crate::torque_free::sums`]) and a constant map ([`crate::torque_free::wobble`]); on a uniform grid the sines come from one
//! product with a table ([`crate::simd::grid`]). Only what is asked for is computed. All sets with a fused multiply-add give the same bits, and so does any
//! number of threads. 100,000 samples of attitude and rates with seven harmonics on one core of a Zen 5 take 36 ns each with the portable kernel, 7.3
//! with AVX2, 3.9 with AVX-512; 18, 4.8 and 2.4 at uniform times; storing alone 0.8. In its first form this took 42, 8.0 and 4.2; lanes as plain arrays
//! in functions with target features, which the compiler is to make vectors of, 31, 15 and 11.7; `wide` takes its instructions when it is compiled,
//! and cannot be dispatched.

use std::sync::atomic::AtomicBool;

use pulp::Arch;

use crate::gravity_gradient::disturbed::Gradient;
use crate::integration::dense::Cursor;
use crate::integration::integrated::Integrated;
use crate::numerics::phase::Phase;
use crate::simd::circles::{Evaluate, Source};
use crate::simd::grid::{GROUP, Grid};
use crate::simd::halt::Halt;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::Lanes;
use crate::simd::outputs::Outputs;
use crate::simd::phase::elapsed;
use crate::simd::run::Run;
use crate::torque_free::separatrix::Passage;
use crate::torque_free::steady::Steady;
use crate::torque_free::wobble::WobbleEvaluator;

#[cfg(test)]
#[path = "tests.rs"]
mod tests;

/// Samples for each thread below which one more thread costs more than it saves: a join takes 11 μs, this many samples 40 to 65.
const SAMPLES_PER_THREAD: usize = 16_384;

/// The formulas that evaluate a motion.
#[derive(Clone, Debug)]
pub(crate) enum Trajectory {
    /// Rotation about an axis fixed in the body.
    Steady(Box<Steady>),
    /// A polhode.
    Wobble(Box<WobbleEvaluator>),
    /// A polhode next to the separatrix or on it.
    Passage(Box<Passage>),
    /// Rotation under a gravity gradient.
    Gradient(Box<Gradient>),
    /// By numerical integration.
    Integrated(Box<Integrated>),
}

impl Trajectory {
    /// ℓ′ and y′/2, where sines and cosines of them are all that is needed.
    fn phases(&self) -> Option<[&Phase; 2]> {
        match self {
            Self::Steady(steady) => Some(steady.phases()),
            Self::Wobble(tables) => Some(tables.phases()),
            Self::Passage(_) | Self::Gradient(_) | Self::Integrated(_) => None,
        }
    }
}

/// A trajectory with the bounds of its times and the instruction set.
#[derive(Clone, Copy)]
pub(crate) struct Evaluation<'a> {
    pub(crate) trajectory: &'a Trajectory,
    pub(crate) epoch: f64,
    /// Largest distances before and after the epoch, the first negative.
    pub(crate) reach: [f64; 2],
    pub(crate) arch: Arch,
    /// Set by another thread to end the evaluation.
    pub(crate) stop: &'a AtomicBool,
}

impl Evaluation<'_> {
    /// Evaluates all times on at most `threads` threads, or says why it ended. Outputs are as long as the times.
    pub(crate) fn fill(&self, times: &[f64], outputs: Outputs<'_>, threads: usize) -> Result<(), Halt> {
        let grid = self.trajectory.phases().and_then(|phases| Grid::new(self.arch, phases, times));
        let enough = times.len() / SAMPLES_PER_THREAD;
        // A query of the size of the pool starts it, so a few samples do not query it.
        let threads = if enough.min(threads) <= 1 { 1 } else { enough.min(threads).min(rayon::current_num_threads()) };
        self.spread(times, outputs, grid.as_ref(), threads)
    }

    /// Halves go to threads. They begin where a group does, so that each sample is computed as it would be by one thread.
    fn spread(&self, times: &[f64], outputs: Outputs<'_>, grid: Option<&Grid>, threads: usize) -> Result<(), Halt> {
        if threads <= 1 {
            let Self { trajectory, epoch, reach, arch, stop } = *self;
            return dispatch(arch, Dispatch { trajectory, run: Run { epoch, reach, times, outputs, grid, stop } });
        }
        let half = threads / 2;
        let place = (times.len() / threads * half).next_multiple_of(GROUP).min(times.len());
        let (left, right) = times.split_at(place);
        let (left_outputs, right_outputs) = outputs.split_at(place);
        let (first, second) = rayon::join(
            || self.spread(left, left_outputs, grid, half),
            || self.spread(right, right_outputs, grid, threads - half),
        );
        first.and(second.map_err(|halt| halt.later(place)))
    }
}

/// A stretch of times for one thread.
struct Dispatch<'a> {
    trajectory: &'a Trajectory,
    run: Run<'a>,
}

impl Task for Dispatch<'_> {
    type Output = Result<(), Halt>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let Self { trajectory, run } = self;
        match trajectory {
            Trajectory::Steady(steady) => run.by_circles(simd, steady.as_ref()),
            Trajectory::Wobble(tables) => run.by_circles(simd, tables.as_ref()),
            Trajectory::Passage(passage) => run.one_by_one(|elapsed| passage.evaluate(elapsed)),
            Trajectory::Integrated(motion) => {
                let mut cursor = Cursor::new(motion);
                run.one_by_one(|elapsed| cursor.at(elapsed))
            }
            Trajectory::Gradient(gradient) => {
                let epoch = Lanes::splat(simd, run.epoch);
                run.by_source(simd, Disturbed { gradient, epoch })
            }
        }
    }
}

/// Under a gravity gradient.
#[derive(Clone, Copy)]
struct Disturbed<'a, S: InstructionSet> {
    gradient: &'a Gradient,
    epoch: Lanes<S>,
}

impl<S: InstructionSet> Source<S> for Disturbed<'_, S> {
    #[inline(always)]
    fn at<const ATTITUDE: bool, const RATES: bool>(
        &self,
        _place: usize,
        times: Lanes<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        self.gradient.evaluate::<S, ATTITUDE, RATES>(elapsed(times, self.epoch))
    }
}
