//! Evaluation at any time by the series of the step that contains it.
//!
//! A long integration keeps no coefficients, nor does a motion that an ensemble keeps: a step is then expanded again when a time falls into it. The expansion takes the time of the step and gives
//! the same bits. Times in order share an expansion.

use std::any::Any;
use std::sync::Arc;

use pulp::Arch;

use super::expansion::{StepExpansion, Workspace};
use super::integrated::Integrated;
use super::integrator::{Side, Step};
use super::series::{Coefficients, norm};
use crate::motion::forced::{End, Forced};
use crate::numerics::scaling::scaled;
use crate::simd::halt::Halt;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch, dispatch_few};
use crate::simd::run::Run;

/// The reasons why the times of an integrated motion are bounded.
const BEFORE: &str = ": the motion is integrated over its span, and this is the part before the epoch";
const AFTER: &str = ": the motion is integrated over its span, and this is the part after the epoch";
const UNKNOWN: &str = ": nearby states separate so fast that the attitude is unknown beyond it";

/// The step of the last evaluated time.
pub(crate) struct Cursor<'a> {
    motion: &'a Integrated,
    workspace: Box<Workspace<4>>,
    /// Side and step that are expanded.
    expanded: Option<(usize, usize)>,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(motion: &'a Integrated) -> Self {
        Self { motion, workspace: Workspace::new(&motion.equations), expanded: None }
    }

    /// Attitude and rates a time after the epoch, in the user's unit.
    #[inline(always)]
    pub(crate) fn at(&mut self, (high, low): (f64, f64)) -> ([f64; 4], [f64; 3]) {
        let Integrated { equations, order, sides, exponent, .. } = self.motion;
        let time = (scaled(high, *exponent), scaled(low, *exponent));
        let side = usize::from(time.0 >= 0.0);
        let Side { steps, coefficients } = &sides[side];
        // The end of the last step begins none.
        let last = steps.len().saturating_sub(2);
        let place = match self.expanded {
            Some((expanded, place)) if expanded == side && within(time, side == 0, &steps[place..]) => place,
            _ => steps.partition_point(|step| reached(time, side == 0, step)).saturating_sub(1).min(last),
        };
        let start = &steps[place];
        if self.expanded != Some((side, place)) {
            let rows = *order + 1;
            match coefficients.get(place * rows..(place + 1) * rows) {
                Some(kept) => self.workspace.restore(kept),
                None => {
                    let (workspace, start) = (&mut *self.workspace, start.start(side == 0));
                    dispatch_few(Arch::new(), StepExpansion { workspace, equations, start, order: *order });
                }
            }
            self.expanded = Some((side, place));
        }
        let since = (time.0 - start.time.0) + (time.1 - start.time.1);
        let (attitude, rates) = self.workspace.at(since, *order);
        let norm = norm(&attitude);
        let [first, second, third, _] = rates.map(|rate| scaled(rate, *exponent));
        (attitude.map(|x| x / norm), [first, second, third])
    }
}

/// Whether a time is not before the start of a step, in its direction: in double-double, since a step at a pericentre may be shorter than the spacing of doubles.
fn reached(time: (f64, f64), backward: bool, step: &Step) -> bool {
    if backward { time <= step.time } else { step.time <= time }
}

/// Whether a time lies in the first of some steps.
fn within(time: (f64, f64), backward: bool, steps: &[Step]) -> bool {
    match steps {
        [start, end, ..] => reached(time, backward, start) && !reached(time, backward, end),
        _ => false,
    }
}

impl Forced for Integrated {
    fn name(&self) -> &'static str {
        "an integrated motion"
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn memory(&self) -> usize {
        let side = |Side { steps, coefficients }: &Side| {
            steps.capacity() * size_of::<Step>() + coefficients.capacity() * size_of::<Coefficients>()
        };
        size_of::<Self>() + self.sides.iter().map(side).sum::<usize>()
    }

    fn compact(&mut self) {
        self.sides.iter_mut().for_each(Side::compact);
    }

    fn whole(&self) -> Option<Arc<dyn Forced>> {
        let Self { equations, order, sides, .. } = self;
        if !sides.iter().any(|side| side.is_compact(*order)) {
            return None;
        }
        let (mut whole, mut workspace) = (self.clone(), Workspace::new(equations));
        for (index, side) in whole.sides.iter_mut().enumerate().filter(|(_, side)| side.is_compact(*order)) {
            for step in &side.steps[..side.steps.len() - 1] {
                let (workspace, start) = (&mut *workspace, step.start(index == 0));
                dispatch_few(Arch::new(), StepExpansion { workspace, equations, start, order: *order });
                side.coefficients.extend(workspace.coefficients(*order));
            }
        }
        Some(Arc::new(whole))
    }

    fn fill(&self, arch: Arch, run: Run<'_>) -> Result<(), Halt> {
        dispatch(arch, ByCursor { motion: self, run })
    }

    fn ends(&self, _: End) -> [End; 2] {
        let reason = |side: usize| if self.lost[side] { UNKNOWN } else { [BEFORE, AFTER][side] };
        [0, 1].map(|side| (self.reach[side].abs(), reason(side)))
    }
}

/// The times of one thread.
struct ByCursor<'a> {
    motion: &'a Integrated,
    run: Run<'a>,
}

impl Task for ByCursor<'_> {
    type Output = Result<(), Halt>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, _: S) -> Self::Output {
        let mut cursor = Cursor::new(self.motion);
        self.run.one_by_one(|elapsed| cursor.at(elapsed))
    }
}
