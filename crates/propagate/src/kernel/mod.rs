//! From a solved motion to arrays of attitudes and rates: several times at once, with the best instructions of the machine, on several threads.
//!
//! Kernels are written once over [`lanes::Lanes`] and compiled for each instruction set ([`level`]). A time takes two phases in double-double, two
//! sines and cosines ([`sincos`]), the sums of theory §8 ([`sums`]) and a constant map ([`wobble`]); on a uniform grid the sines come from one
//! product with a table ([`grid`]). Only what is asked for is computed. All sets with a fused multiply-add give the same bits, and so does any
//! number of threads. 100,000 samples of attitude and rates with seven harmonics on one core of a Zen 5 take 36 ns each with the portable kernel, 7.3
//! with AVX2, 3.9 with AVX-512; 18, 4.8 and 2.4 at uniform times; storing alone 0.8. In its first form this took 42, 8.0 and 4.2; lanes as plain arrays
//! in functions with target features, which the compiler is to make vectors of, 31, 15 and 11.7; `wide` takes its instructions when it is compiled,
//! and cannot be dispatched.

pub(crate) mod grid;
pub(crate) mod lanes;
pub(crate) mod level;
pub(crate) mod plane;
pub(crate) mod run;
pub(crate) mod sincos;
pub(crate) mod steady;
mod sums;
#[cfg(test)]
mod tests;
pub(crate) mod wobble;

use std::sync::atomic::{AtomicBool, Ordering};

use pulp::Arch;

use crate::motion::Course;
use grid::{GROUP, Grid};
use run::Run;

/// Samples for each thread below which one more thread costs more than it saves: a join takes 11 μs, this many samples 40 to 65.
const SAMPLES_PER_THREAD: usize = 16_384;

/// What is computed, one row for each time.
pub(crate) enum Outputs<'a> {
    Attitudes(&'a mut [[f64; 4]]),
    Rates(&'a mut [[f64; 3]]),
    Both(&'a mut [[f64; 4]], &'a mut [[f64; 3]]),
}

impl<'a> Outputs<'a> {
    fn split_at(self, place: usize) -> (Self, Self) {
        match self {
            Self::Attitudes(attitudes) => {
                let (left, right) = attitudes.split_at_mut(place);
                (Self::Attitudes(left), Self::Attitudes(right))
            }
            Self::Rates(rates) => {
                let (left, right) = rates.split_at_mut(place);
                (Self::Rates(left), Self::Rates(right))
            }
            Self::Both(attitudes, rates) => {
                let (left, right) = attitudes.split_at_mut(place);
                let (left_rates, right_rates) = rates.split_at_mut(place);
                (Self::Both(left, left_rates), Self::Both(right, right_rates))
            }
        }
    }
}

/// Why an evaluation ends before its last time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Halt {
    /// The index of a time at which the motion has no phase.
    Time(usize),
    /// The flag was set.
    Stopped,
}

impl Halt {
    /// The same of times that begin later.
    fn later(self, place: usize) -> Self {
        match self {
            Self::Time(index) => Self::Time(place + index),
            Self::Stopped => Self::Stopped,
        }
    }
}

/// Whether to go on. Asked once for each group of times, which takes a microsecond or more.
pub(crate) fn going(stop: &AtomicBool) -> Result<(), Halt> {
    if stop.load(Ordering::Relaxed) { Err(Halt::Stopped) } else { Ok(()) }
}

/// A motion, the times that it has a phase at, and how to compute.
#[derive(Clone, Copy)]
pub(crate) struct Evaluation<'a> {
    pub(crate) course: &'a Course,
    pub(crate) epoch: f64,
    /// Largest distance from the epoch.
    pub(crate) bound: f64,
    pub(crate) arch: Arch,
    /// Set by another thread to end the evaluation.
    pub(crate) stop: &'a AtomicBool,
}

impl Evaluation<'_> {
    /// All times, on at most so many threads; or why not. Outputs are as long as the times.
    pub(crate) fn fill(&self, times: &[f64], outputs: Outputs<'_>, threads: usize) -> Result<(), Halt> {
        let grid = Grid::new(self, times);
        let enough = times.len() / SAMPLES_PER_THREAD;
        // Asking for the pool's size starts it: not for a few samples.
        let threads = if enough.min(threads) <= 1 { 1 } else { enough.min(threads).min(rayon::current_num_threads()) };
        self.spread(times, outputs, grid.as_ref(), threads)
    }

    /// Halves go to threads. They begin where a group does, so that each sample is computed as it would be by one thread.
    fn spread(&self, times: &[f64], outputs: Outputs<'_>, grid: Option<&Grid>, threads: usize) -> Result<(), Halt> {
        if threads <= 1 {
            return level::dispatch(self.arch, Run { evaluation: self, times, outputs, grid });
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
