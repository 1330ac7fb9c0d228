//! The effect of errors of the mean variables on the attitude: directly, and through the rates.

use crate::gravity_gradient::body::inertia::{HIGHEST, Inertia};

/// The factors of one mean motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Response {
    /// Largest turn of the attitude for a unit change of p \[rad\]: √2 for an axisymmetric body at J = 0, and √(2ω) near B = C.
    pub(crate) gain: f64,
    /// Turn of the attitude for a unit change of ℓ′.
    pub(crate) visible: f64,
    /// Rate of the turn for a unit change of σ.
    pub(crate) by_sigma: f64,
    /// Rate of the turn for a unit relative change of M.
    pub(crate) by_momentum: f64,
    pub(crate) sigma: f64,
}

impl Response {
    /// The factors from the series of a and b.
    pub(crate) fn new(inertia: &Inertia) -> Self {
        let sigma = inertia.sigma;
        let root = sigma.sqrt();
        let highest = HIGHEST as i32;
        let mut slope = 0.0;
        for series in &inertia.pair {
            for harmonic in -highest..=highest {
                let (value, by_sigma) = series.at(harmonic);
                let degree = harmonic.abs();
                let falling = if degree == 0 { 0.0 } else { f64::from(degree) * root.powi(degree - 1) * value.abs() };
                slope += falling + 2.0 * root.powi(degree + 1) * by_sigma.abs();
            }
        }
        let gain = 2.0 * slope / inertia.pair[0].at(0).0.abs();
        let visible = gain * root;
        let [anomaly, longitude] = inertia.rates.map(|rate| rate.to_f64().abs());
        let [anomaly_slope, longitude_slope] = inertia.rate_slopes.map(f64::abs);
        Self {
            gain,
            visible,
            by_sigma: visible * anomaly_slope + longitude_slope,
            by_momentum: visible * anomaly + longitude,
            sigma,
        }
    }

    /// Rate of the turn of the attitude for a relative change of this size of the mean variables.
    pub(crate) fn drift(&self, change: f64) -> f64 {
        let p = change / self.gain;
        change * self.by_momentum + p * (2.0 * self.sigma.sqrt() + p) * self.by_sigma
    }

    /// The attitude error over a time that errors of the mean M and L make, over M \[rad\].
    pub(crate) fn of_actions(&self, [momentum, action]: [f64; 2], duration: f64) -> f64 {
        (momentum * self.by_momentum + (action + self.sigma * momentum) * self.by_sigma) * duration
    }

    /// The factor by which the effect of a term on the attitude grows over a time: through σ, and through M for m ≠ 0.
    pub(crate) fn growth(&self, multiple: i32, duration: f64) -> f64 {
        let by_momentum = if multiple == 0 { 0.0 } else { self.by_momentum };
        let by_sigma = 2.0 * self.sigma.sqrt() / self.gain * self.by_sigma;
        1.0 + duration * (by_sigma + by_momentum)
    }
}
