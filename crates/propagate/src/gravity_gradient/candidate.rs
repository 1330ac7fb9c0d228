//! A term of the generating function before it is known whether it is kept.

/// Ω over the fastest angular rate of twice the true anomaly below which the sum for G does not converge; above it what the sum leaves is part of the error.
pub(super) const SMALLEST_RATIO: f64 = 1.5;

/// One (h, m) before it is known whether it is kept.
pub(super) struct Candidate {
    pub(super) harmonic: i32,
    pub(super) multiple: i32,
    /// Real f_h and df_h/dσ, of i t1 for m = 1.
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) frequency: f64,
    /// Rate of the attitude's change \[rad per unit of time\].
    pub(super) rate: f64,
    /// What Ω's slope adds to it, times Ω.
    pub(super) shift: f64,
}
