//! What an error about the strength of a torque measures.

use super::sentences::four_digits;

/// What shows that a torque is too strong for an expansion in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TorqueMeasure {
    /// The strength 3n²C(C − A)/2M² times the mass fraction, where the disturbing body is nearest within the span.
    Strength,
    /// The sum of the sizes of the short-period corrections \[rad\].
    Corrections,
    /// The ratio of the changes of successive iterations for the mean variables.
    Contraction,
    /// The precession of the angular momentum in one radian of the true anomaly at the nearest place within the span \[rad\]. Of several bodies the precessions in
    /// the same time are added, and the time is one radian of the fastest mean anomaly if that is shorter.
    Precession,
    /// The error bound of a span of less than one orbit \[rad\]. Its limit is the effect of the torque over the span.
    ErrorBound,
}

impl TorqueMeasure {
    /// What was measured, with its value and its limit.
    pub(super) fn sentence(self, size: f64, bound: f64) -> String {
        let [size, bound] = [size, bound].map(four_digits);
        match self {
            Self::Strength => format!(
                "its strength 3n²C(C−A)/2M², where the disturbing body is nearest, is {size}, and must be at most {bound}"
            ),
            Self::Corrections => {
                format!("the short-period corrections add up to {size} rad, and must add up to at most {bound} rad")
            }
            Self::Contraction => format!(
                "an iteration for the mean variables leaves {size} of the last change, and must leave at most {bound}"
            ),
            Self::Precession => format!(
                "the angular momentum precesses by {size} rad in one radian of the orbit, and must precess by at most {bound} rad"
            ),
            Self::ErrorBound => {
                format!("the error bound over the span, {size} rad, exceeds the effect of the torque, {bound} rad")
            }
        }
    }
}
