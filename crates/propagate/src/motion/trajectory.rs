//! Arrays of attitudes and rates from a solved motion, with the best instruction set available, on several threads; of most motions several times at once.
//!
//! Kernels are written once over [`crate::simd::lanes`] and compiled for each instruction set ([`crate::simd::instruction_set`]). One time of a wobble takes two phases in
//! double-double, two sines and cosines ([`crate::simd::sincos`]), the sums of theory §8 ([`crate::torque_free::sums`]) and a constant map
//! ([`crate::torque_free::wobble`]). On a uniform grid one product with a table gives the sines ([`crate::simd::grid`]). Only the requested outputs are
//! computed. All sets with a fused multiply-add give the same bits, with any number of threads.
//!
//! Speed: benches/README.md has the time of a sample, under `evaluate`. AVX-512 is the fastest set, then AVX2, then the portable kernel. Uniform times take less
//! than others. Plain arrays in functions with target features, vectorized by the compiler, took two to three times as long with AVX2 and AVX-512. The crate
//! `wide` fixes its instructions at compile time, so it cannot select them at run time.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use andoyer_series::threads::{join, shared};
use pulp::Arch;

use super::forced::Forced;
use crate::numerics::phase::Phase;
use crate::simd::grid::{GROUP, Grid};
use crate::simd::halt::Halt;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::outputs::Outputs;
use crate::simd::run::Run;
use crate::torque_free::separatrix::Passage;
use crate::torque_free::steady::Steady;
use crate::torque_free::wobble::WobbleEvaluator;

#[cfg(test)]
#[path = "tests.rs"]
mod tests;

/// Smallest number of samples for each thread. With fewer samples another thread costs more than it saves: a join takes about a fifth of the time of so many.
const SAMPLES_PER_THREAD: usize = 16_384;

/// The formulas that evaluate a motion.
#[derive(Clone, Debug)]
pub(crate) enum Trajectory {
    /// Rotation about an axis fixed in the body.
    Steady(Box<Steady>),
    /// A wobble along a polhode.
    Wobble(Box<WobbleEvaluator>),
    /// A motion near the separatrix or on it.
    Passage(Box<Passage>),
    /// A motion under a torque.
    Forced(Arc<dyn Forced>),
}

impl Trajectory {
    /// The phases ℓ′ and y′/2, if the motion depends on time only through their sines and cosines.
    fn phases(&self) -> Option<[&Phase; 2]> {
        match self {
            Self::Steady(steady) => Some(steady.phases()),
            Self::Wobble(tables) => Some(tables.phases()),
            Self::Passage(_) | Self::Forced(_) => None,
        }
    }
}

impl Trajectory {
    /// Its memory without that of the variant itself, in bytes.
    pub(crate) fn memory(&self) -> usize {
        match self {
            Self::Steady(steady) => size_of_val(&**steady),
            Self::Wobble(wobble) => size_of_val(&**wobble),
            Self::Passage(passage) => size_of_val(&**passage),
            Self::Forced(motion) => motion.memory(),
        }
    }
}

/// A trajectory with the bounds of its times and the instruction set.
#[derive(Clone, Copy)]
pub(crate) struct Evaluation<'a> {
    pub(crate) trajectory: &'a Trajectory,
    pub(crate) epoch: f64,
    /// Largest times before and after the epoch; the first is negative.
    pub(crate) reach: [f64; 2],
    pub(crate) arch: Arch,
    /// A flag that another thread sets to end the evaluation.
    pub(crate) stop: &'a AtomicBool,
}

impl Evaluation<'_> {
    /// Evaluates all times on at most `threads` threads, or returns the reason why it ended. The outputs must be as long as the times.
    pub(crate) fn fill(&self, times: &[f64], outputs: Outputs<'_>, threads: usize) -> Result<(), Halt> {
        let grid = self.trajectory.phases().and_then(|phases| Grid::new(self.arch, phases, times));
        let enough = times.len() / SAMPLES_PER_THREAD;
        shared(enough.min(threads), |threads| self.spread(times, outputs, grid.as_ref(), threads))
    }

    /// Gives each half to a thread. A half begins where a group begins, so that each sample is computed as with one thread.
    fn spread(&self, times: &[f64], outputs: Outputs<'_>, grid: Option<&Grid>, threads: usize) -> Result<(), Halt> {
        if threads <= 1 {
            let Self { trajectory, epoch, reach, arch, stop } = *self;
            let run = Run { epoch, reach, times, outputs, grid, stop };
            return match trajectory {
                Trajectory::Forced(motion) => motion.fill(arch, run),
                Trajectory::Steady(steady) => run.in_lanes(arch, &**steady),
                Trajectory::Wobble(wobble) => run.in_lanes(arch, &**wobble),
                Trajectory::Passage(passage) => dispatch(arch, ByPassage { passage, run }),
            };
        }
        let half = threads / 2;
        let place = (times.len() / threads * half).next_multiple_of(GROUP).min(times.len());
        let (left, right) = times.split_at(place);
        let (left_outputs, right_outputs) = outputs.split_at(place);
        let (first, second) = join(
            || self.spread(left, left_outputs, grid, half),
            || self.spread(right, right_outputs, grid, threads - half),
        );
        first.and(second.map_err(|halt| halt.later(place)))
    }
}

/// The times of one thread, for a motion along the separatrix.
struct ByPassage<'a> {
    passage: &'a Passage,
    run: Run<'a>,
}

impl Task for ByPassage<'_> {
    type Output = Result<(), Halt>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, _: S) -> Self::Output {
        self.run.one_by_one(|elapsed| self.passage.evaluate(elapsed))
    }
}
