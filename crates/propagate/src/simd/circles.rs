//! The traits of a kernel: one has some times with sines and cosines of phases, the other computes attitude and rates at them.

use super::instruction_set::InstructionSet;
use super::lanes::Lanes;
use crate::numerics::phase::Phase;

/// Sine and cosine.
pub(crate) type Circle<S> = (Lanes<S>, Lanes<S>);

/// Some times after the epoch.
pub(crate) trait Instants<S: InstructionSet>: Copy {
    /// The times, in double-double.
    fn elapsed(self) -> (Lanes<S>, Lanes<S>);

    /// Sine and cosine of a phase of the motion, ℓ′ as number 0 or y′/2 as number 1.
    fn circle(self, number: usize, phase: &Phase) -> Circle<S>;
}

/// Times in double-double, whose sines and cosines are computed.
impl<S: InstructionSet> Instants<S> for (Lanes<S>, Lanes<S>) {
    #[inline(always)]
    fn elapsed(self) -> (Lanes<S>, Lanes<S>) {
        self
    }

    #[inline(always)]
    fn circle(self, _: usize, phase: &Phase) -> Circle<S> {
        phase.sin_cos(self)
    }
}

/// A motion that is evaluated at several times at once.
pub(crate) trait Evaluate: Sync {
    /// Whether it depends on time by the sines and cosines of ℓ′ and y′/2 alone, for which a uniform grid has a table.
    const BY_CIRCLES: bool;

    /// Attitude and rates, each only if requested.
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        simd: S,
        at: impl Instants<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]);
}
