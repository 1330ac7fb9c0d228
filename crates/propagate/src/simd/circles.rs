//! What a kernel is generic over: where sines and cosines come from, and what is computed from them.

use super::instruction_set::InstructionSet;
use super::lanes::Lanes;
use crate::numerics::phase::Phase;

/// Sine and cosine.
pub(crate) type Circle<S> = (Lanes<S>, Lanes<S>);

/// Sines and cosines of ℓ′ and y′/2 at some times.
pub(crate) trait Circles<S: InstructionSet>: Copy {
    /// That of ℓ′.
    fn anomaly(self) -> Circle<S>;
    /// That of y′/2.
    fn half_longitude(self) -> Circle<S>;
}

/// What gives attitude and rates at some times, as far as they are asked for.
pub(crate) trait Source<S: InstructionSet> {
    /// At the times from a place on.
    fn at<const ATTITUDE: bool, const RATES: bool>(
        &self,
        place: usize,
        times: Lanes<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]);
}

/// How attitude and rates come from the circles.
pub(crate) trait Evaluate {
    /// ℓ′ and y′/2.
    fn phases(&self) -> [&Phase; 2];

    /// Attitude and rates, as far as they are asked for.
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        simd: S,
        circles: impl Circles<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]);
}
