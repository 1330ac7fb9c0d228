//! Evaluation at any time by the series of the step that contains it.
//!
//! If the coefficients of an integration are not kept, a step is expanded again when a time falls into it. The expansion takes the time of the step and gives
//! the same bits. Times in order share an expansion.

use pulp::Arch;

use super::expansion::{StepExpansion, Workspace};
use super::integrated::Integrated;
use super::integrator::{Side, Step};
use crate::numerics::scaling::scaled;
use crate::simd::instruction_set::dispatch_few;

/// The step of the last evaluated time.
pub(crate) struct Cursor<'a> {
    motion: &'a Integrated,
    workspace: Box<Workspace<4>>,
    /// Side and step that are expanded.
    expanded: Option<(usize, usize)>,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(motion: &'a Integrated) -> Self {
        Self { motion, workspace: Workspace::new(motion.equations.bodies.len()), expanded: None }
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
        let norm = attitude.iter().map(|x| x * x).sum::<f64>().sqrt();
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
