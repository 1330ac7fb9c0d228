//! The loop over blocks of times, compiled for each instruction set and each set of outputs.

use std::sync::atomic::AtomicBool;

use andoyer_double::two_sum;
use pulp::Arch;

use super::circles::Evaluate;
use super::grid::{BLOCK, GROUP, Grid, Tabled};
use super::halt::{Halt, going};
use super::instruction_set::{InstructionSet, Task, dispatch};
use super::lanes::{Lanes, WIDEST};
use super::outputs::Outputs;
use super::phase::elapsed;

/// The times of one thread.
pub(crate) struct Run<'a> {
    pub(crate) epoch: f64,
    /// Largest times before and after the epoch; the first is negative.
    pub(crate) reach: [f64; 2],
    pub(crate) times: &'a [f64],
    pub(crate) outputs: Outputs<'a>,
    pub(crate) grid: Option<&'a Grid>,
    /// A flag that another thread sets to end the evaluation.
    pub(crate) stop: &'a AtomicBool,
}

impl Run<'_> {
    /// Evaluates each time by itself, without vectors.
    #[inline(always)]
    pub(crate) fn one_by_one(self, mut evaluate: impl FnMut((f64, f64)) -> ([f64; 4], [f64; 3])) -> Result<(), Halt> {
        let Self { epoch, reach, times, outputs, stop, .. } = self;
        let (mut attitudes, mut rates) = match outputs {
            Outputs::Attitudes(attitudes) => (Some(attitudes), None),
            Outputs::Rates(rates) => (None, Some(rates)),
            Outputs::Both(attitudes, rates) => (Some(attitudes), Some(rates)),
        };
        all_within(times, epoch, reach)?;
        for (index, &time) in times.iter().enumerate() {
            if index % GROUP == 0 {
                going(stop)?;
            }
            let (attitude, rate) = evaluate(two_sum(time, -epoch));
            if let Some(attitudes) = &mut attitudes {
                attitudes[index] = attitude;
            }
            if let Some(rates) = &mut rates {
                rates[index] = rate;
            }
        }
        Ok(())
    }

    /// Evaluates a motion at several times at once.
    pub(crate) fn in_lanes(self, arch: Arch, motion: &impl Evaluate) -> Result<(), Halt> {
        dispatch(arch, InLanes { motion, run: self })
    }
}

/// The times of one thread, of a motion that is evaluated at several times at once.
struct InLanes<'a, M> {
    motion: &'a M,
    run: Run<'a>,
}

impl<M: Evaluate> Task for InLanes<'_, M> {
    type Output = Result<(), Halt>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let Run { epoch, reach, times, outputs, grid, stop } = self.run;
        // What takes long begins only if all times are served.
        if !M::BY_CIRCLES {
            all_within(times, epoch, reach)?;
        }
        let stretch = Stretch { simd, epoch, reach, motion: self.motion, grid, stop };
        match outputs {
            Outputs::Attitudes(attitudes) => stretch.fill::<true, false>(times, (attitudes, &mut [])),
            Outputs::Rates(rates) => stretch.fill::<false, true>(times, (&mut [], rates)),
            Outputs::Both(attitudes, rates) => stretch.fill::<true, true>(times, (attitudes, rates)),
        }
    }
}

/// Attitudes and rates; an output that was not requested is empty.
type Rows<'a> = (&'a mut [[f64; 4]], &'a mut [[f64; 3]]);

struct Stretch<'a, S, M> {
    simd: S,
    epoch: f64,
    reach: [f64; 2],
    motion: &'a M,
    grid: Option<&'a Grid>,
    stop: &'a AtomicBool,
}

impl<S: InstructionSet, M: Evaluate> Stretch<'_, S, M> {
    /// Evaluates group by group; the times of a group are validated first.
    #[inline(always)]
    fn fill<const ATTITUDE: bool, const RATES: bool>(&self, times: &[f64], mut rows: Rows<'_>) -> Result<(), Halt> {
        for (index, group) in times.chunks(GROUP).enumerate() {
            let start = index * GROUP;
            going(self.stop)?;
            all_within(group, self.epoch, self.reach).map_err(|halt| halt.later(start))?;
            self.group::<ATTITUDE, RATES>(group, part::<ATTITUDE, RATES>(&mut rows, start, group.len()));
        }
        Ok(())
    }

    /// Evaluates the uniform blocks of a group with the table, and the other times with their own phases.
    #[inline(always)]
    fn group<const ATTITUDE: bool, const RATES: bool>(&self, times: &[f64], mut rows: Rows<'_>) {
        let simd = self.simd;
        let grid = self.grid.filter(|_| M::BY_CIRCLES);
        let seeds = grid.map(|grid| (grid, grid.seeds(simd, times, self.epoch)));
        let length = if seeds.is_some() { BLOCK } else { GROUP };
        for (index, block) in times.chunks(length).enumerate() {
            let rows = part::<ATTITUDE, RATES>(&mut rows, index * length, block.len());
            let tabled = match &seeds {
                Some((grid, seeds)) if grid.holds(simd, block) => Some(grid.tabled(simd, block[0], &seeds[index])),
                _ => None,
            };
            self.each::<ATTITUDE, RATES>(block, rows, tabled);
        }
    }

    /// Evaluates all lanes at once. If fewer times than lanes remain, they are read from a copy that is filled up, and the results go to copies of the rows.
    #[inline(always)]
    fn each<const ATTITUDE: bool, const RATES: bool>(
        &self,
        times: &[f64],
        (attitudes, rates): Rows<'_>,
        tabled: Option<Tabled<'_, S>>,
    ) {
        let Self { simd, motion, .. } = *self;
        let (width, epoch) = (Lanes::<S>::WIDTH, Lanes::splat(simd, self.epoch));
        let mut last = [0.0; WIDEST];
        let (mut last_attitudes, mut last_rates) = ([[0.0; 4]; WIDEST], [[0.0; 3]; WIDEST]);
        for place in (0..times.len()).step_by(width) {
            let rest = (times.len() - place).min(width);
            let whole = rest == width;
            if !whole {
                last = [times[place]; WIDEST];
                last[..rest].copy_from_slice(&times[place..]);
            }
            let lanes = Lanes::load(simd, if whole { &times[place..] } else { &last });
            let elapsed = elapsed(lanes, epoch);
            let (attitude, rate) = match &tabled {
                Some(tabled) if M::BY_CIRCLES => {
                    motion.evaluate::<S, ATTITUDE, RATES>(simd, tabled.at(place, lanes, elapsed))
                }
                _ => motion.evaluate::<S, ATTITUDE, RATES>(simd, elapsed),
            };
            if ATTITUDE {
                let rows = if whole { &mut attitudes[place..place + width] } else { &mut last_attitudes[..width] };
                Lanes::store_fours(attitude, rows);
            }
            if RATES {
                let rows = if whole { &mut rates[place..place + width] } else { &mut last_rates[..width] };
                Lanes::store_threes(rate, rows);
            }
            if !whole && ATTITUDE {
                attitudes[place..].copy_from_slice(&last_attitudes[..rest]);
            }
            if !whole && RATES {
                rates[place..].copy_from_slice(&last_rates[..rest]);
            }
        }
    }
}

/// Checks that all times are within the bound; the error names the first time that is not. NaN is outside.
#[inline(always)]
fn all_within(times: &[f64], epoch: f64, [least, most]: [f64; 2]) -> Result<(), Halt> {
    let valid = |time: &f64| (least <= time - epoch) & (time - epoch <= most);
    if times.iter().fold(true, |all, time| all & valid(time)) {
        return Ok(());
    }
    Err(Halt::Time(times.iter().position(|time| !valid(time)).unwrap_or(0)))
}

/// The rows of a part of the times, if the output is requested.
#[inline(always)]
fn part<'a, const ATTITUDE: bool, const RATES: bool>(rows: &'a mut Rows<'_>, start: usize, length: usize) -> Rows<'a> {
    (
        if ATTITUDE { &mut rows.0[start..start + length] } else { &mut [] },
        if RATES { &mut rows.1[start..start + length] } else { &mut [] },
    )
}
