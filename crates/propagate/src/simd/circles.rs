//! The traits of a kernel: one gives sines and cosines of the phases, the other computes attitude and rates from them.

use super::instruction_set::InstructionSet;
use super::lanes::Lanes;
use crate::numerics::phase::Phase;

/// Sine and cosine.
pub(crate) type Circle<S> = (Lanes<S>, Lanes<S>);

/// Sines and cosines of ℓ′ and y′/2 at some times.
pub(crate) trait Circles<S: InstructionSet>: Copy {
    /// Sine and cosine of ℓ′.
    fn anomaly(self) -> Circle<S>;
    /// Sine and cosine of y′/2.
    fn half_longitude(self) -> Circle<S>;
}

/// Gives attitude and rates at some times, each only if requested.
pub(crate) trait Source<S: InstructionSet> {
    /// Attitude and rates at `times`, which begin at the index `place`.
    fn at<const ATTITUDE: bool, const RATES: bool>(
        &self,
        place: usize,
        times: Lanes<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]);
}

/// Computes attitude and rates from sines and cosines of the phases.
pub(crate) trait Evaluate {
    /// The phases ℓ′ and y′/2.
    fn phases(&self) -> [&Phase; 2];

    /// Attitude and rates, each only if requested.
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        simd: S,
        circles: impl Circles<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]);
}
