//! A term of the generating function that may be kept or dropped.

/// Smallest |Ω| over the largest rate of twice the true anomaly for which the sum for G is used. Below this ratio the sum does not converge. Above it the
/// truncation error of the sum is part of the error bound.
pub(crate) const SLOW_RATIO: f64 = 1.5;

/// The term (h, m), which may be kept or dropped.
pub(crate) struct Candidate {
    pub(crate) harmonic: i32,
    pub(crate) multiple: i32,
    /// The real f_h and df_h/dσ; for m = 1 those of i t1.
    pub(crate) value: f64,
    pub(crate) slope: f64,
    pub(crate) frequency: f64,
    /// Rate of change of the attitude by the term [rad per unit of time].
    pub(crate) rate: f64,
    /// Rate of change of M or L by the term, over M and over m or h.
    pub(crate) action: f64,
    /// The part of the change that comes from the slope of Ω, times Ω.
    pub(crate) shift: f64,
}

impl Candidate {
    /// Largest change of the attitude by the term \[rad\].
    pub(crate) fn size(&self) -> f64 {
        self.size_at(self.frequency.abs())
    }

    /// The same with another divisor.
    pub(crate) fn size_at(&self, divisor: f64) -> f64 {
        (self.rate + self.shift / divisor) / divisor
    }

    /// With another divisor, the change of M or L over M, and that of y′ by the slope of Ω with respect to M, which is not in the size.
    pub(crate) fn swing_at(&self, divisor: f64) -> [f64; 2] {
        let swing = self.action / divisor;
        [swing, swing * self.frequency.abs() / divisor]
    }
}
