//! The loop over blocks of times, compiled for each instruction set and each set of outputs.

use super::grid::{BLOCK, GROUP, Grid, Tabled, TabledCircles};
use super::lanes::{Lanes, STRANDS};
use super::level::{Level, Task};
use super::{Evaluation, Outputs};
use crate::motion::Course;
use crate::phase::{Phase, elapsed};
use andoyer_series::two_sum;

/// Most lanes of any instruction set.
const WIDEST: usize = 8 * STRANDS;

/// Sine and cosine.
pub(crate) type Circle<S> = (Lanes<S>, Lanes<S>);

/// Sines and cosines of ℓ′ and y′/2 at some times.
pub(crate) trait Circles<S: Level>: Copy {
    /// That of ℓ′.
    fn anomaly(self) -> Circle<S>;
    /// That of y′/2.
    fn half_longitude(self) -> Circle<S>;
}

/// Where the circles at times come from.
trait Source<S: Level> {
    type Circles: Circles<S>;

    /// The circles at the times from a place on.
    fn circles(&self, place: usize, times: Lanes<S>) -> Self::Circles;
}

/// How attitude and rates come from the circles.
pub(crate) trait Evaluate {
    /// ℓ′ and y′/2.
    fn phases(&self) -> [&Phase; 2];

    /// Attitude and rates, as far as they are asked for.
    fn evaluate<S: Level, const ATTITUDE: bool, const RATES: bool>(
        &self,
        simd: S,
        circles: impl Circles<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]);
}

/// A stretch of times for one thread.
pub(super) struct Run<'a> {
    pub(super) evaluation: &'a Evaluation<'a>,
    pub(super) times: &'a [f64],
    pub(super) outputs: Outputs<'a>,
    pub(super) grid: Option<&'a Grid>,
}

impl Task for Run<'_> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn run<S: Level>(self, simd: S) -> Self::Output {
        match self.evaluation.course {
            Course::Steady(steady) => self.select(simd, steady.as_ref()),
            Course::Polhode(tables) => self.select(simd, tables.as_ref()),
            Course::Flip(flip) => self.one_by_one(|elapsed| flip.evaluate(elapsed)),
        }
    }
}

impl Run<'_> {
    /// Each time by itself, without vectors.
    fn one_by_one(self, evaluate: impl Fn((f64, f64)) -> ([f64; 4], [f64; 3])) -> Result<(), usize> {
        let Self { evaluation: &Evaluation { epoch, bound, .. }, times, outputs, .. } = self;
        let (mut attitudes, mut rates) = match outputs {
            Outputs::Attitudes(attitudes) => (Some(attitudes), None),
            Outputs::Rates(rates) => (None, Some(rates)),
            Outputs::Both(attitudes, rates) => (Some(attitudes), Some(rates)),
        };
        for (index, &time) in times.iter().enumerate() {
            let distance = (time - epoch).abs();
            if distance > bound || distance.is_nan() {
                return Err(index);
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

    #[inline(always)]
    fn select<S: Level, C: Evaluate>(self, simd: S, course: &C) -> Result<(), usize> {
        let Self { evaluation: &Evaluation { epoch, bound, .. }, times, outputs, grid } = self;
        let stretch = Stretch { simd, epoch, bound, course, grid };
        match outputs {
            Outputs::Attitudes(attitudes) => stretch.fill::<true, false>(times, (attitudes, &mut [])),
            Outputs::Rates(rates) => stretch.fill::<false, true>(times, (&mut [], rates)),
            Outputs::Both(attitudes, rates) => stretch.fill::<true, true>(times, (attitudes, rates)),
        }
    }
}

/// Attitudes and rates; one that is not asked for is empty.
type Rows<'a> = (&'a mut [[f64; 4]], &'a mut [[f64; 3]]);

struct Stretch<'a, S, C> {
    simd: S,
    epoch: f64,
    bound: f64,
    course: &'a C,
    grid: Option<&'a Grid>,
}

impl<S: Level, C: Evaluate> Stretch<'_, S, C> {
    /// Group by group, each after its times are found to be valid.
    #[inline(always)]
    fn fill<const ATTITUDE: bool, const RATES: bool>(&self, times: &[f64], mut rows: Rows<'_>) -> Result<(), usize> {
        // Written so that NaN fails it.
        let valid = |time: &f64| (time - self.epoch).abs() <= self.bound;
        for (index, group) in times.chunks(GROUP).enumerate() {
            let start = index * GROUP;
            if !group.iter().fold(true, |all, time| all & valid(time)) {
                return Err(start + group.iter().position(|time| !valid(time)).unwrap_or(0));
            }
            let rows = part::<ATTITUDE, RATES>(&mut rows, start, group.len());
            match self.grid {
                Some(grid) => self.uniform::<ATTITUDE, RATES>(grid, group, rows),
                None => self.direct::<ATTITUDE, RATES>(group, rows),
            }
        }
        Ok(())
    }

    /// The blocks of a group that are uniform from the table, the others and what is no whole block directly.
    #[inline(always)]
    fn uniform<const ATTITUDE: bool, const RATES: bool>(&self, grid: &Grid, times: &[f64], mut rows: Rows<'_>) {
        let seeds = grid.seeds(self.simd, self.course.phases(), times, self.epoch);
        for (index, block) in times.chunks(BLOCK).enumerate() {
            let rows = part::<ATTITUDE, RATES>(&mut rows, index * BLOCK, block.len());
            if grid.holds(self.simd, block) {
                self.each::<ATTITUDE, RATES>(block, rows, grid.tabled(self.simd, block[0], &seeds[index]));
            } else {
                self.direct::<ATTITUDE, RATES>(block, rows);
            }
        }
    }

    /// Each time by its own phases.
    #[inline(always)]
    fn direct<const ATTITUDE: bool, const RATES: bool>(&self, times: &[f64], rows: Rows<'_>) {
        let source = Direct { phases: self.course.phases(), epoch: Lanes::splat(self.simd, self.epoch) };
        self.each::<ATTITUDE, RATES>(times, rows, source);
    }

    #[inline(always)]
    fn each<const ATTITUDE: bool, const RATES: bool>(&self, times: &[f64], rows: Rows<'_>, source: impl Source<S>) {
        let width = Lanes::<S>::WIDTH;
        let (attitudes, rates) = rows;
        let whole = times.len() / width * width;
        for place in (0..whole).step_by(width) {
            let circles = source.circles(place, Lanes::load(self.simd, &times[place..]));
            let (attitude, rate) = self.course.evaluate::<S, ATTITUDE, RATES>(self.simd, circles);
            if ATTITUDE {
                Lanes::store_fours(attitude, &mut attitudes[place..place + width]);
            }
            if RATES {
                Lanes::store_threes(rate, &mut rates[place..place + width]);
            }
        }
        if whole < times.len() {
            let rest = times.len() - whole;
            let mut last = [times[whole]; WIDEST];
            last[..rest].copy_from_slice(&times[whole..]);
            let circles = source.circles(whole, Lanes::load(self.simd, &last));
            let (attitude, rate) = self.course.evaluate::<S, ATTITUDE, RATES>(self.simd, circles);
            let (mut last_attitudes, mut last_rates) = ([[0.0; 4]; WIDEST], [[0.0; 3]; WIDEST]);
            Lanes::store_fours(attitude, &mut last_attitudes[..width]);
            Lanes::store_threes(rate, &mut last_rates[..width]);
            if ATTITUDE {
                attitudes[whole..].copy_from_slice(&last_attitudes[..rest]);
            }
            if RATES {
                rates[whole..].copy_from_slice(&last_rates[..rest]);
            }
        }
    }
}

/// Some of the rows, where there are any.
#[inline(always)]
fn part<'a, const ATTITUDE: bool, const RATES: bool>(rows: &'a mut Rows<'_>, start: usize, length: usize) -> Rows<'a> {
    (
        if ATTITUDE { &mut rows.0[start..start + length] } else { &mut [] },
        if RATES { &mut rows.1[start..start + length] } else { &mut [] },
    )
}

/// Circles by the phases of each time.
struct Direct<'a, S: Level> {
    phases: [&'a Phase; 2],
    epoch: Lanes<S>,
}

#[derive(Clone, Copy)]
struct DirectCircles<'a, S: Level> {
    phases: [&'a Phase; 2],
    elapsed: (Lanes<S>, Lanes<S>),
}

impl<'a, S: Level> Source<S> for Direct<'a, S> {
    type Circles = DirectCircles<'a, S>;

    #[inline(always)]
    fn circles(&self, _place: usize, times: Lanes<S>) -> Self::Circles {
        DirectCircles { phases: self.phases, elapsed: elapsed(times, self.epoch) }
    }
}

impl<S: Level> Circles<S> for DirectCircles<'_, S> {
    #[inline(always)]
    fn anomaly(self) -> Circle<S> {
        self.phases[0].sin_cos(self.elapsed)
    }

    #[inline(always)]
    fn half_longitude(self) -> Circle<S> {
        self.phases[1].sin_cos(self.elapsed)
    }
}

impl<'a, S: Level> Source<S> for Tabled<'a, S> {
    type Circles = TabledCircles<'a, S>;

    #[inline(always)]
    fn circles(&self, place: usize, times: Lanes<S>) -> Self::Circles {
        self.at(place, times)
    }
}
