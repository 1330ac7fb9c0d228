//! A motion under a torque, as [`Trajectory`](super::trajectory::Trajectory) holds it. The rooms that solve such motions implement this trait, so that a free
//! motion needs none of them.

use std::any::Any;
use std::fmt::Debug;
use std::panic::{RefUnwindSafe, UnwindSafe};
use std::sync::Arc;

use pulp::Arch;

use crate::simd::halt::Halt;
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

    /// Drops what makes an evaluation fast and can be computed again.
    fn compact(&mut self) {}

    /// The motion with what was dropped, to the bit; `None` if nothing was.
    fn whole(&self) -> Option<Arc<dyn Forced>> {
        None
    }

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
