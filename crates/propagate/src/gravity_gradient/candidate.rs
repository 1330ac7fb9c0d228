//! A term of the generating function that may be kept or dropped.

/// Smallest |Ω| over the largest rate of twice the true anomaly for which the sum for G is used. Below this ratio the sum does not converge. Above it the
/// truncation error of the sum is part of the error bound.
pub(super) const SMALLEST_RATIO: f64 = 1.5;

/// The term (h, m), which may be kept or dropped.
pub(super) struct Candidate {
    pub(super) harmonic: i32,
    pub(super) multiple: i32,
    /// The real f_h and df_h/dσ; for m = 1 those of i t1.
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) frequency: f64,
    /// Rate of change of the attitude by the term [rad per unit of time].
    pub(super) rate: f64,
    /// Rate of change of M or L by the term, over M and over m or h.
    pub(super) action: f64,
    /// The part of the change that comes from the slope of Ω, times Ω.
    pub(super) shift: f64,
}
