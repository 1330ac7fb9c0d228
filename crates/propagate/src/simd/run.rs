//! The loop over blocks of times, compiled for each instruction set and each set of outputs.

use std::sync::atomic::AtomicBool;

use andoyer_double::two_sum;

use super::circles::{Circle, Circles, Evaluate, Source};
use super::grid::{BLOCK, GROUP, Grid, Tabled};
use super::halt::{Halt, going};
use super::instruction_set::InstructionSet;
use super::lanes::{Lanes, WIDEST};
use super::outputs::Outputs;
use super::phase::elapsed;
use crate::numerics::phase::Phase;

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

    /// Evaluates a source that has neither circles nor a grid.
    #[inline(always)]
    pub(crate) fn by_source<S: InstructionSet>(self, simd: S, source: impl Source<S> + Copy) -> Result<(), Halt> {
        let Self { epoch, reach, times, outputs, stop, .. } = self;
        all_within(times, epoch, reach)?;
        match outputs {
            Outputs::Attitudes(attitudes) => groups::<S, true, false>(simd, times, (attitudes, &mut []), source, stop),
            Outputs::Rates(rates) => groups::<S, false, true>(simd, times, (&mut [], rates), source, stop),
            Outputs::Both(attitudes, rates) => groups::<S, true, true>(simd, times, (attitudes, rates), source, stop),
        }
    }

    /// Evaluates a motion by sines and cosines of its phases.
    #[inline(always)]
    pub(crate) fn by_circles<S: InstructionSet, C: Evaluate>(self, simd: S, course: &C) -> Result<(), Halt> {
        let Self { epoch, reach, times, outputs, grid, stop } = self;
        let stretch = Stretch { simd, epoch, reach, course, grid, stop };
        match outputs {
            Outputs::Attitudes(attitudes) => stretch.fill::<true, false>(times, (attitudes, &mut [])),
            Outputs::Rates(rates) => stretch.fill::<false, true>(times, (&mut [], rates)),
            Outputs::Both(attitudes, rates) => stretch.fill::<true, true>(times, (attitudes, rates)),
        }
    }
}

/// Attitudes and rates; an output that was not requested is empty.
type Rows<'a> = (&'a mut [[f64; 4]], &'a mut [[f64; 3]]);

struct Stretch<'a, S, C> {
    simd: S,
    epoch: f64,
    reach: [f64; 2],
    course: &'a C,
    grid: Option<&'a Grid>,
    stop: &'a AtomicBool,
}

impl<S: InstructionSet, C: Evaluate> Stretch<'_, S, C> {
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
    ///
    /// Each of the two is inlined only once, because it is compiled for each instruction set and each set of outputs.
    #[inline(always)]
    fn group<const ATTITUDE: bool, const RATES: bool>(&self, times: &[f64], mut rows: Rows<'_>) {
        let simd = self.simd;
        let seeds = self.grid.map(|grid| (grid, grid.seeds(simd, self.course.phases(), times, self.epoch)));
        let length = if seeds.is_some() { BLOCK } else { GROUP };
        for (index, block) in times.chunks(length).enumerate() {
            let rows = part::<ATTITUDE, RATES>(&mut rows, index * length, block.len());
            match &seeds {
                Some((grid, seeds)) if grid.holds(simd, block) => {
                    let tabled = grid.tabled(simd, block[0], &seeds[index]);
                    each::<S, ATTITUDE, RATES>(simd, block, rows, Blocks { course: self.course, simd, tabled });
                }
                _ => {
                    let direct = Direct { course: self.course, simd, epoch: Lanes::splat(simd, self.epoch) };
                    each::<S, ATTITUDE, RATES>(simd, block, rows, direct);
                }
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

/// Evaluates group by group while the flag is not set.
#[inline(always)]
fn groups<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
    simd: S,
    times: &[f64],
    mut rows: Rows<'_>,
    source: impl Source<S> + Copy,
    stop: &AtomicBool,
) -> Result<(), Halt> {
    for (index, group) in times.chunks(GROUP).enumerate() {
        going(stop)?;
        let rows = part::<ATTITUDE, RATES>(&mut rows, index * GROUP, group.len());
        each::<S, ATTITUDE, RATES>(simd, group, rows, source);
    }
    Ok(())
}

/// Evaluates all lanes at once. If fewer times than lanes remain, they are read from a copy that is filled up, and the results go to copies of the rows.
#[inline(always)]
fn each<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
    simd: S,
    times: &[f64],
    (attitudes, rates): Rows<'_>,
    source: impl Source<S>,
) {
    let width = Lanes::<S>::WIDTH;
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
        let (attitude, rate) = source.at::<ATTITUDE, RATES>(place, lanes);
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

/// The rows of a part of the times, if the output is requested.
#[inline(always)]
fn part<'a, const ATTITUDE: bool, const RATES: bool>(rows: &'a mut Rows<'_>, start: usize, length: usize) -> Rows<'a> {
    (
        if ATTITUDE { &mut rows.0[start..start + length] } else { &mut [] },
        if RATES { &mut rows.1[start..start + length] } else { &mut [] },
    )
}

/// Evaluates times with their own phases.
struct Direct<'a, S: InstructionSet, C> {
    course: &'a C,
    simd: S,
    epoch: Lanes<S>,
}

#[derive(Clone, Copy)]
struct DirectCircles<'a, S: InstructionSet> {
    phases: [&'a Phase; 2],
    elapsed: (Lanes<S>, Lanes<S>),
}

impl<S: InstructionSet, C: Evaluate> Source<S> for Direct<'_, S, C> {
    #[inline(always)]
    fn at<const ATTITUDE: bool, const RATES: bool>(
        &self,
        _place: usize,
        times: Lanes<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        let circles = DirectCircles { phases: self.course.phases(), elapsed: elapsed(times, self.epoch) };
        self.course.evaluate::<S, ATTITUDE, RATES>(self.simd, circles)
    }
}

impl<S: InstructionSet> Circles<S> for DirectCircles<'_, S> {
    #[inline(always)]
    fn anomaly(self) -> Circle<S> {
        self.phases[0].sin_cos(self.elapsed)
    }

    #[inline(always)]
    fn half_longitude(self) -> Circle<S> {
        self.phases[1].sin_cos(self.elapsed)
    }
}

/// Evaluates times with the table of a grid.
struct Blocks<'a, S: InstructionSet, C> {
    course: &'a C,
    simd: S,
    tabled: Tabled<'a, S>,
}

impl<S: InstructionSet, C: Evaluate> Source<S> for Blocks<'_, S, C> {
    #[inline(always)]
    fn at<const ATTITUDE: bool, const RATES: bool>(
        &self,
        place: usize,
        times: Lanes<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        self.course.evaluate::<S, ATTITUDE, RATES>(self.simd, self.tabled.at(place, times))
    }
}
