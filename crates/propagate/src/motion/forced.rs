//! A motion under a torque, as [`Trajectory`](super::trajectory::Trajectory) holds it. The rooms that solve such motions implement these traits, so that a free
//! motion needs none of them.

use std::any::Any;
use std::fmt::Debug;
use std::panic::{RefUnwindSafe, UnwindSafe};

use pulp::Arch;

use crate::simd::circles::Source;
use crate::simd::halt::Halt;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::Lanes;
use crate::simd::phase::elapsed;
use crate::simd::run::Run;

/// The farthest time from the epoch on one side, in the user's unit, and the reason for the bound.
pub(crate) type End = (f64, &'static str);

/// A motion under a torque.
pub(crate) trait Forced: Debug + Send + Sync + UnwindSafe + RefUnwindSafe {
    /// What it is, for messages.
    fn name(&self) -> &'static str;

    /// The type itself, so that its room can downcast it.
    fn as_any(&self) -> &dyn Any;

    /// Its memory, in bytes.
    fn memory(&self) -> usize;

    /// Evaluates the times of a run.
    fn fill(&self, arch: Arch, run: Run<'_>) -> Result<(), Halt>;

    /// The ends before and after the epoch; `phases` is the farthest time at which the phases are accurate.
    fn ends(&self, phases: End) -> [End; 2] {
        [phases; 2]
    }

    /// Writes the angular momenta in inertial components at `times`; `epoch` is in the same scale. Returns false, writing nothing, if the caller must
    /// compute them from attitudes and rates.
    fn angular_momenta(&self, _times: &[f64], _epoch: f64, _out: &mut [[f64; 3]]) -> bool {
        false
    }
}

/// A motion under a torque that is evaluated at several times at once.
pub(crate) trait InLanes: Sync {
    /// Attitude and rates at times after the epoch, each only if requested.
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]);
}

/// Evaluates the times of a run in lanes.
pub(crate) fn fill_in_lanes(motion: &impl InLanes, arch: Arch, run: Run<'_>) -> Result<(), Halt> {
    dispatch(arch, Filling { motion, run })
}

struct Filling<'a, M> {
    motion: &'a M,
    run: Run<'a>,
}

impl<M: InLanes> Task for Filling<'_, M> {
    type Output = Result<(), Halt>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let (motion, epoch) = (self.motion, Lanes::splat(simd, self.run.epoch));
        self.run.by_source(simd, SinceEpoch { motion, epoch })
    }
}

/// A motion with its epoch.
struct SinceEpoch<'a, M, S: InstructionSet> {
    motion: &'a M,
    epoch: Lanes<S>,
}

impl<M, S: InstructionSet> Clone for SinceEpoch<'_, M, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M, S: InstructionSet> Copy for SinceEpoch<'_, M, S> {}

impl<M: InLanes, S: InstructionSet> Source<S> for SinceEpoch<'_, M, S> {
    #[inline(always)]
    fn at<const ATTITUDE: bool, const RATES: bool>(
        &self,
        _place: usize,
        times: Lanes<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        self.motion.evaluate::<S, ATTITUDE, RATES>(elapsed(times, self.epoch))
    }
}
