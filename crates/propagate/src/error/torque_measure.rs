//! What an error about the strength of a torque measures.

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
