//! A motion by integration over a span, with its error bound.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use pulp::Arch;

use super::bound::{FLOOR, MeasuredSteps, Profile, ReinterpolatedSteps, with_interpolation};
use super::expansion::Equations;
use super::integrator::{KeptSteps, Precision, Runner, Side, Step, StepsSoFar};
use super::problem::{FINEST, Problem};
use super::rates::too_coarse;
use super::step_errors::StepErrors;
use crate::error::Error;
use crate::input::options::Served;
use crate::input::scene::Scene;
use crate::motion::plan::IntegrationPlan;
use crate::numerics::scaling::scaled;
use crate::simd::instruction_set::{dispatch, dispatch_few};

/// Relative error of an enlarged displacement that its steps may leave at the end, before its division by the square of the phase.
const ENLARGED_ERROR: f64 = 1e-3;
/// ε₂ = FINER · ε₁ · tolerance / bound₁, with the truncation errors ε of both integrations and the error bound of the first.
const FINER: f64 = 0.05;
/// A second integration is made if it may meet the tolerance, or if the errors of the first exceed its rounding errors by this factor.
const WORTHWHILE: f64 = 2.0;

/// A motion by integration. Times are those from the epoch in its own unit.
#[derive(Clone, Debug)]
pub(crate) struct Integrated {
    pub(super) equations: Equations<4>,
    pub(super) order: usize,
    /// Before and after the epoch.
    pub(super) sides: [Side; 2],
    pub(super) exponent: i32,
    /// The first and the last time from the epoch, in the user's unit.
    pub(crate) reach: [f64; 2],
    /// Whether the attitude is unknown beyond these times, before and after the epoch: otherwise they are the ends of the span.
    pub(super) lost: [bool; 2],
    pub(crate) error: f64,
    /// The bound without the interpolation of a table, if the interpolation dominates it.
    uninterpolated: Option<f64>,
    torques: usize,
}

impl Integrated {
    /// The motion of a scene about principal axes over its span, or over as much of it as is asked for.
    pub(crate) fn new(scene: &Scene, reason: &str, (served, stop): (Served, &AtomicBool)) -> Result<Self, Error> {
        let problem = Problem::new(scene, reason)?;
        let first = problem.solved(problem.first_error(), stop);
        let measured = first.and_then(|first| problem.repeated(first, stop));
        let known = |measured| Self::known(&problem, scene, measured, (served, stop));
        measured.and_then(known).map_err(|error| match error {
            // In the units of the scene.
            Error::SpunUp { time, rate, steps, bound } => Error::SpunUp {
                time: scene.state().epoch + scaled(time, -problem.exponent),
                rate: scaled(rate, problem.exponent),
                steps,
                bound,
            },
            error => error,
        })
    }

    /// The motion by the steps that the tolerance asks for at first, whose errors are not measured: for comparisons. The error bound is infinite.
    ///
    /// # Errors
    /// [`Error::Stopped`], [`Error::TooManySteps`], and those of a scene that cannot be integrated.
    pub(crate) fn unmeasured(scene: &Scene, stop: &AtomicBool) -> Result<Self, Error> {
        let problem = Problem::new(scene, "")?;
        let precision = Precision::of(problem.first_error());
        let [before, after] = [0, 1].map(|side| problem.steps(side, precision, stop));
        Ok(problem.motion(precision.order, [before?.0, after?.0], (f64::INFINITY, None)))
    }

    /// The motion. If its error bound reaches half a turn, an error, or the part before that if this is asked for.
    fn known(
        problem: &Problem,
        scene: &Scene,
        measured: MeasuredMotion,
        (served, stop): (Served, &AtomicBool),
    ) -> Result<Self, Error> {
        let MeasuredMotion { motion, profiles, .. } = measured;
        if motion.error < PI {
            return Ok(motion);
        }
        let (first, tolerance) = (problem.first_error(), problem.tolerance);
        if let (Some(_), Some(error)) = (motion.uninterpolated, too_coarse(scene, motion.reach)) {
            return Err(error);
        }
        if served == Served::WhileKnown {
            return Ok(motion.while_known(&profiles));
        }
        let mut held = [0.0; 2];
        for (side, profile) in profiles.iter().enumerate() {
            held[side] = match profile.iter().take_while(|(_, error)| *error <= tolerance).last() {
                Some((time, _)) => *time,
                None => problem.held(side, &motion.sides[side].steps, (first, tolerance), stop)?,
            };
        }
        let dated = |time: f64| scene.state().epoch + scaled(time, -problem.exponent);
        let ([start, stop], known) = (held.map(dated), [0, 1].map(|side| dated(last_known(&profiles[side]))));
        let span = scene.asked_span().map_or([start, stop], <[f64; 2]>::from);
        Err(Error::Unpredictable { tolerance, span, start, stop, known })
    }

    /// The motion up to the last times at which its error bound is below half a turn. The error bound is that over the span.
    fn while_known(mut self, profiles: &[Profile; 2]) -> Self {
        for (side, profile) in profiles.iter().enumerate() {
            self.lost[side] = profile.last().is_some_and(|(_, error)| *error >= PI);
            if self.lost[side] {
                let time = last_known(profile);
                self.reach[side] = scaled(time, -self.exponent);
                self.sides[side].end_at(time, self.order);
            }
        }
        self
    }

    /// The entries of the plan, of a scene with this epoch.
    pub(crate) fn plan(&self, epoch: f64) -> IntegrationPlan {
        let steps = self.sides.iter().map(|side| side.steps.len() - 1).sum();
        IntegrationPlan {
            steps,
            bodies: self.equations.bodies.len(),
            torques: self.torques,
            uninterpolated: self.uninterpolated,
            known: self.lost.contains(&true).then(|| self.reach.map(|time| epoch + time)),
        }
    }

    /// The largest |ω| at the start of a step, in the user's unit.
    pub(crate) fn fastest(&self) -> f64 {
        let rate = |step: &Step| step.rates.iter().map(|rate| rate * rate).sum::<f64>();
        let largest = self.sides.iter().flat_map(|side| &side.steps).map(rate).fold(0.0, f64::max);
        scaled(largest.sqrt(), self.exponent)
    }

    /// The order of the series.
    pub(crate) fn order(&self) -> usize {
        self.order
    }
}

/// The last time at which the error bound is below half a turn.
fn last_known(profile: &Profile) -> f64 {
    profile.iter().take_while(|(_, error)| *error < PI).last().map_or(0.0, |(time, _)| *time)
}

/// A motion by steps of a relative error, with its error bounds before and after the epoch, and the errors of all steps relative to those by rounding alone.
pub(super) struct MeasuredMotion {
    relative: f64,
    motion: Integrated,
    profiles: [Profile; 2],
    share: f64,
}

impl MeasuredMotion {
    /// The one with the smaller error bound.
    fn or_better(self, other: Self) -> Self {
        if other.motion.error < self.motion.error { other } else { self }
    }
}

/// The integrations of a problem.
impl Problem {
    /// The steps before the epoch, 0, or after it, 1, and where they end.
    pub(super) fn steps(
        &self,
        side: usize,
        precision: Precision,
        stop: &AtomicBool,
    ) -> Result<(Side, StepErrors), Error> {
        Ok(self.advanced(self.beginning(side), side, (precision, usize::MAX), stop)?.ended())
    }

    /// An integration before the epoch, 0, or after it, 1, that has not begun.
    pub(super) fn beginning(&self, side: usize) -> StepsSoFar {
        let runner = Runner::new(self.attitude, self.rates, side == 0);
        StepsSoFar::new(runner, &self.equations)
    }

    /// An integration that goes on to its end, or to a number of steps.
    pub(super) fn advanced(
        &self,
        progress: StepsSoFar,
        side: usize,
        (precision, pause): (Precision, usize),
        stop: &AtomicBool,
    ) -> Result<StepsSoFar, Error> {
        let (equations, target) = (&self.equations, self.ends[side]);
        dispatch_few(Arch::new(), KeptSteps { equations, precision, progress, target, pause, stop })
    }

    /// The motion by some steps; `bounds` are the error bound, and that without the interpolation of a table where this dominates.
    fn motion(&self, order: usize, sides: [Side; 2], (error, uninterpolated): (f64, Option<f64>)) -> Integrated {
        let Self { exponent, reach, torques, .. } = *self;
        let (equations, lost) = (self.equations.clone(), [false; 2]);
        Integrated { equations, order, sides, exponent, reach, lost, error, uninterpolated, torques }
    }

    /// The first integration, or a second one with shorter steps where this has the smaller error bound.
    fn repeated(&self, first: MeasuredMotion, stop: &AtomicBool) -> Result<MeasuredMotion, Error> {
        match self.second_error(&first) {
            Some(error) => Ok(first.or_better(self.solved(error, stop)?)),
            None => Ok(first),
        }
    }

    /// The relative error of the steps of a second integration, if the first misses the tolerance and it may come nearer.
    fn second_error(&self, first: &MeasuredMotion) -> Option<f64> {
        let MeasuredMotion { relative, motion, share, .. } = first;
        // Shorter steps leave the interpolation of a table as it is, and rounding errors.
        let error = motion.uninterpolated.unwrap_or(motion.error);
        let useful = *share > WORTHWHILE || error < share * self.tolerance;
        let needed = error > self.tolerance && useful && *relative > FINEST;
        needed.then(|| (FINER * relative * self.tolerance / error).clamp(FINEST, *relative))
    }

    /// By steps of this relative error. A side ends early where its attitude is unknown.
    fn solved(&self, error: f64, stop: &AtomicBool) -> Result<MeasuredMotion, Error> {
        let precision = Precision::of(error);
        let [before, after] = [0, 1].map(|side| self.while_known(side, precision, stop));
        let ((before, lost_before), (after, lost_after)) = (before?, after?);
        let kept = [before, after];
        let [before, after] = [(0, lost_before), (1, lost_after)].map(|(side, lost)| {
            let (Side { steps, .. }, errors) = &kept[side];
            match lost {
                Some(profile) => Ok(profile),
                None if steps.len() > 1 => self.measured(steps, (precision, errors), side == 0, stop),
                None => Ok(Profile::new()),
            }
        });
        self.with_bounds((precision, error), kept, [before?, after?], stop)
    }

    /// The motion by steps of this relative error before and after the epoch, with the error bounds that the displaced states give.
    fn with_bounds(
        &self,
        (precision, relative): (Precision, f64),
        kept: [(Side, StepErrors); 2],
        mut profiles: [Profile; 2],
        stop: &AtomicBool,
    ) -> Result<MeasuredMotion, Error> {
        let largest = |profile: &Profile| profile.last().map_or(FLOOR, |(_, error)| *error);
        let (mut bound, mut uninterpolated, mut share) = (FLOOR, FLOOR, 1.0_f64);
        for (side, ((Side { steps, .. }, errors), profile)) in kept.iter().zip(&mut profiles).enumerate() {
            share = errors.systematic_share().into_iter().fold(share, f64::max);
            uninterpolated = uninterpolated.max(largest(profile));
            if self.tabulated() && steps.len() > 1 {
                with_interpolation(
                    profile,
                    &self.departures(steps, precision, side == 0, stop)?,
                    self.of_interpolation,
                );
            }
            bound = bound.max(largest(profile));
        }
        let dominated = bound > self.tolerance && 2.0 * uninterpolated < bound;
        let bounds = (bound, dominated.then_some(uninterpolated));
        Ok(MeasuredMotion {
            relative,
            motion: self.motion(precision.order, kept.map(|(side, _)| side), bounds),
            profiles,
            share,
        })
    }

    /// The latest time at which an integration up to there meets the tolerance. The number of its steps is doubled, and then found to an eighth. The bound of a longer
    /// integration has the errors of all its steps from the epoch on: errors made at a pericentre would hide that nothing is lost before it.
    fn held(
        &self,
        side: usize,
        steps: &[Step],
        (error, tolerance): (f64, f64),
        stop: &AtomicBool,
    ) -> Result<f64, Error> {
        let holds = |count: usize| -> Result<bool, Error> {
            let Some(step) = steps.get(count) else { return Ok(false) };
            let mut ends = [(0.0, 0.0); 2];
            ends[side] = step.time;
            let shorter = Self { equations: self.equations.clone(), ends, ..*self };
            Ok(shorter.solved(error, stop)?.motion.error <= tolerance)
        };
        let (mut held, mut more) = (0, 1);
        while holds(held + more)? {
            held += more;
            more = held;
        }
        for more in [2, 4, 8].map(|part| held / part) {
            if more > 0 && holds(held + more)? {
                held += more;
            }
        }
        Ok(steps[held].time.0)
    }

    /// The error bound of the steps in one direction, without the interpolation of tables.
    pub(super) fn measured(
        &self,
        steps: &[Step],
        (precision, errors): (Precision, &StepErrors),
        backward: bool,
        stop: &AtomicBool,
    ) -> Result<Profile, Error> {
        let enlarged = self.enlarged(steps, errors, backward, stop);
        let exact = MeasuredSteps { precision, enlarged: false, ..enlarged };
        let profile = if enlarged.precision.order < precision.order { dispatch(Arch::new(), enlarged)? } else { None };
        Ok(match profile {
            Some(profile) => profile,
            None => dispatch(Arch::new(), exact)?.unwrap_or_default(),
        })
    }

    /// The steps in one direction, to be measured by enlarged displacements.
    fn enlarged<'a>(
        &'a self,
        steps: &'a [Step],
        errors: &StepErrors,
        backward: bool,
        stop: &'a AtomicBool,
    ) -> MeasuredSteps<'a> {
        let phase = self.phase();
        MeasuredSteps {
            equations: &self.equations,
            precision: Precision::of((ENLARGED_ERROR / (10.0 + phase * phase)).max(FINEST)),
            steps,
            errors: errors.all(),
            noise: errors.systematic_share(),
            backward,
            enlarged: true,
            stop,
        }
    }

    /// The angles between the motion and those with the two neighbouring interpolations.
    fn departures(
        &self,
        steps: &[Step],
        precision: Precision,
        backward: bool,
        stop: &AtomicBool,
    ) -> Result<[Profile; 2], Error> {
        let departure = |earlier: bool| {
            let equations = &self.equations.neighbouring(earlier);
            dispatch_few(Arch::new(), ReinterpolatedSteps { equations, precision, steps, backward, stop })
        };
        Ok([departure(true)?, departure(false)?])
    }
}
