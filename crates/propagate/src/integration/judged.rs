//! An integration that ends where nothing is known any more.
//!
//! After a number of steps the error bound so far is measured as that of a whole span. If it is half a turn, that over the span is too: there the displacements have the errors of more steps,
//! and grow for a longer time. The next judgement is due where the growth so far leads to half a turn. The last one is after 1/16 of the steps at most, so that all of them together take
//! less than a fifth of the time of the error bound. Judgements change no bit of a motion that reaches its end.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use super::bound::Profile;
use super::integrator::{Precision, Side};
use super::problem::Problem;
use super::step_errors::StepErrors;
use crate::error::Error;

/// Steps before the first judgement, some milliseconds.
const FIRST: usize = 1 << 11;
/// The whole number of steps exceeds those so far by this factor, or there is no judgement.
const WORTHWHILE: f64 = 16.0;
/// The next judgement is due after this many times the number of steps that is predicted,
const LATER: f64 = 1.2;
/// and between these many times those so far.
const NEXT: [f64; 2] = [1.5, 8.0];

/// The steps in one direction with their errors, and the profile of the error bound if this has reached half a turn.
type Known = ((Side, StepErrors), Option<Profile>);

impl Problem {
    /// The steps before the epoch, 0, or after it, 1, and the errors that they leave. They end at the end of the span, or where the error bound has reached half a turn.
    pub(super) fn while_known(&self, side: usize, precision: Precision, stop: &AtomicBool) -> Result<Known, Error> {
        let mut pause = if self.equations.is_free() { usize::MAX } else { FIRST };
        let mut progress = self.beginning(side);
        loop {
            progress = self.advanced(progress, side, (precision, pause), stop)?;
            if progress.runner.time == self.ends[side] {
                return Ok((progress.ended(), None));
            }
            let short = progress.expected(&self.equations, self.ends[side]) < WORTHWHILE * pause as f64;
            if short || progress.is_spun_up(self.ends[side]) {
                pause = pause.saturating_mul(2);
                continue;
            }
            let errors = progress.runner.errors;
            let profile = progress.with_last(|steps| self.measured(steps, (precision, &errors), side == 0, stop))?;
            if profile.last().is_some_and(|(_, bound)| *bound >= PI) {
                return Ok((progress.ended(), Some(profile)));
            }
            pause = (pause as f64 * next(&profile)) as usize;
        }
    }
}

/// The number of steps before the next judgement relative to those so far, from the growth of the error bound in the second half.
fn next(profile: &Profile) -> f64 {
    let (Some((time, bound)), Some((half, smaller))) = (profile.last(), profile.get(profile.len() / 2)) else {
        return NEXT[1];
    };
    let growth = (bound / smaller).ln() / (time - half);
    // Without growth it is infinite, and with a single comparison no number.
    let lost = 1.0 + (PI / bound).ln() / (growth * time);
    if lost.is_nan() { NEXT[1] } else { (LATER * lost).clamp(NEXT[0], NEXT[1]) }
}
