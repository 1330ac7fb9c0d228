//! The effect of errors of the mean variables on the attitude: directly, and through the rates.

use super::inertia::{HIGHEST, Inertia};

/// The factors of one mean motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response {
    /// Largest turn of the attitude for a unit change of p \[rad\]: √2 for an axisymmetric body at J = 0, and √(2ω) near B = C.
    pub(super) gain: f64,
    /// Turn of the attitude for a unit change of ℓ′.
    pub(super) visible: f64,
    /// Rate of the turn for a unit change of σ.
    pub(super) by_sigma: f64,
    /// Rate of the turn for a unit relative change of M.
    pub(super) by_momentum: f64,
    /// σ; `distance` is its distance from σ of the separatrix.
    pub(super) sigma: f64,
    distance: f64,
}

impl Response {
    /// The factors from the series of a and b.
    pub(super) fn new(inertia: &Inertia) -> Self {
        let Inertia { sigma, separatrix, .. } = *inertia;
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
            distance: (separatrix - sigma).max(0.1 * separatrix),
        }
    }

    /// The change of σ that a change of p causes.
    pub(super) fn of_sigma(&self, p: f64) -> f64 {
        p * (2.0 * self.sigma.sqrt() + p)
    }

    /// Second-order attitude error over a time \[rad\], for first-order changes of this size and with derivatives of size `slope`. `p` is the change of p
    /// \[1\].
    pub(super) fn second_order(&self, [size, slope]: [f64; 2], p: f64, duration: f64) -> f64 {
        let of_sigma = self.of_sigma(p);
        // The bracket of two changes of p, and the curvature of the functions of σ. The distance from the separatrix bounds the curvature.
        let sigma = of_sigma * (slope + p / self.distance.sqrt() + of_sigma / self.distance);
        size * slope * (1.0 + self.by_momentum * duration) + self.by_sigma * sigma * duration
    }

    /// The growing attitude error of an averaged motion of second order \[rad\]. `parts`: the share of the span in which the drift of third order acts, and the
    /// part of the second-order drifts that K2 lacks.
    pub(super) fn growing(&self, [size, slope]: [f64; 2], p: f64, duration: f64, parts: [f64; 2]) -> f64 {
        let of_sigma = self.of_sigma(p);
        let further = slope + p / self.distance.sqrt() + of_sigma / self.distance;
        let growing = (size * slope * self.by_momentum + self.by_sigma * of_sigma * further) * duration;
        let [acting, cut] = parts;
        growing * (acting * further + cut)
    }

    /// The attitude error over a time that errors of the mean M and L make, over M \[rad\].
    pub(super) fn of_actions(&self, [momentum, action]: [f64; 2], duration: f64) -> f64 {
        (momentum * self.by_momentum + (action + self.sigma * momentum) * self.by_sigma) * duration
    }

    /// The factor by which the effect of a term on the attitude grows over a time: through σ, and through M for m ≠ 0.
    pub(super) fn growth(&self, multiple: i32, duration: f64) -> f64 {
        let by_momentum = if multiple == 0 { 0.0 } else { self.by_momentum };
        let by_sigma = 2.0 * self.sigma.sqrt() / self.gain * self.by_sigma;
        1.0 + duration * (by_sigma + by_momentum)
    }
}
