//! How much of the tolerance each source of error may take.

/// The part of a dropped term, if the mean M and L lack the dropped terms and if they have them. The second is so small that in scenes of weak torques the error
/// stays near rounding; ten times as much makes a sample 3 % faster.
const DROPPED: [f64; 2] = [0.01, 2e-5];
/// A term below this share of the second-order change is dropped too, in the same two cases. A few tens of terms may be dropped. With a third of the second share
/// a sample at n/spin = 0.02 takes 7 % longer.
const DROPPED_OF_SECOND_ORDER: [f64; 2] = [1e-5, 3e-4];
/// The part of the truncation error of a sum over time derivatives; above it exact divisors replace the sum.
const TRUNCATED: f64 = 0.01;
/// The part of a pair that is not summed around the orbit.
const PAIRS: f64 = 0.02;

/// The parts of the tolerance \[rad\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ledger {
    pub(crate) dropped: f64,
    pub(crate) truncated: f64,
    pub(crate) pairs: f64,
    /// All of it: resonances that turn the attitude by much more are refused.
    pub(crate) refused: f64,
    /// Terms below this share of the second-order change are dropped.
    pub(crate) of_second_order: f64,
    /// Whether the mean M and L at the epoch are those of all terms, so that the effect of dropped terms grows in second order only.
    pub(crate) refined: bool,
}

impl Ledger {
    /// The parts of a tolerance.
    pub(crate) fn new(tolerance: f64, refined: bool) -> Self {
        let case = usize::from(refined);
        Self {
            dropped: DROPPED[case] * tolerance,
            truncated: TRUNCATED * tolerance,
            pairs: PAIRS * tolerance,
            refused: tolerance,
            of_second_order: DROPPED_OF_SECOND_ORDER[case],
            refined,
        }
    }
}
