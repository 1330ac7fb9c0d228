//! A term of the generating function that may be kept or dropped.

use crate::gravity_gradient::body::inertia::{HIGHEST, Inertia};
use crate::gravity_gradient::orbit::elliptic_orbit::Demand;

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

/// Lower limit of √σ in the size of a term. The wobble that the torque forces is larger.
pub(crate) const ROOT_FLOOR: f64 = 1e-9;

/// A term f σ^(|h|/2) e^(i(hℓ′+my′)) of the disturbing function over q = 3φn²/2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mode {
    /// h.
    pub(crate) harmonic: i32,
    /// m, 0 to 2.
    pub(crate) multiple: i32,
    /// f, df/dσ and d²f/dσ²; for m = 1 without the factor −i.
    pub(crate) function: [f64; 3],
    /// ν = Ω/M and its first two derivatives with respect to σ.
    pub(crate) frequency: [f64; 3],
}

impl Mode {
    pub(crate) fn new(inertia: &Inertia, harmonic: i32, multiple: i32) -> Self {
        let factor = if multiple == 0 { 1.5 } else { 1.0 };
        let function = inertia.tensor[multiple as usize].jet(harmonic).map(|part| factor * part); // 0 ≤ m ≤ 2
        let rates = [inertia.rates.map(|rate| rate.to_f64()), inertia.rate_slopes, inertia.rate_curvatures];
        let combined = |[anomaly, longitude]: [f64; 2]| {
            (f64::from(harmonic) * anomaly + f64::from(multiple) * longitude) / inertia.momentum
        };
        Self { harmonic, multiple, function, frequency: rates.map(combined) }
    }

    /// Whether both are the same term.
    pub(crate) fn is(&self, other: &Self) -> bool {
        (self.harmonic, self.multiple) == (other.harmonic, other.multiple)
    }

    /// ⟨D⟩.
    pub(crate) fn average(inertia: &Inertia) -> Self {
        let mut average = Self::new(inertia, 0, 0);
        average.function[0] -= 0.5 * inertia.trace;
        average
    }

    /// f² σ^|h| and its first two derivatives: regular at σ = 0.
    pub(crate) fn square(&self, sigma: f64) -> [f64; 3] {
        let [f, slope, curvature] = self.function;
        let degree = self.harmonic.abs();
        let d = f64::from(degree);
        let falling = |lower: i32| if degree >= lower { sigma.powi(degree - lower) } else { 0.0 };
        let [s0, s1, s2] = [falling(0), d * falling(1), d * (d - 1.0) * falling(2)];
        [
            f * f * s0,
            2.0 * f * slope * s0 + f * f * s1,
            2.0 * (slope * slope + f * curvature) * s0 + 4.0 * f * slope * s1 + f * f * s2,
        ]
    }

    /// Relative size of the change of the mean variables by the term.
    pub(crate) fn size(&self, root: f64) -> f64 {
        self.strength(root) / self.frequency[0].abs()
    }

    /// The same times ν.
    pub(crate) fn strength(&self, root: f64) -> f64 {
        let degree = self.harmonic.abs();
        let [value, slope, _] = self.function.map(f64::abs);
        (value + root * root * slope) * root.powi((degree - 1).max(0)) * f64::from(degree + 1)
    }
}

/// The largest rate of twice the true anomaly within the span, times the ratio below which sums over time derivatives do not converge.
pub(crate) fn slowest(demand: &Demand<'_>) -> f64 {
    SLOW_RATIO * demand.envelope.fastest
}

/// The modes with m > 0, and those with m = 0 and h > 0, that are larger than `share` of the largest and faster than `slowest`, a frequency.
pub(crate) fn modes(inertia: &Inertia, share: f64, slowest: f64) -> Vec<Mode> {
    let root = inertia.sigma.sqrt().max(ROOT_FLOOR);
    let mut modes = all(inertia);
    modes.retain(|mode| mode.frequency[0].abs() * inertia.momentum > slowest && mode.size(root) > 0.0);
    let largest = modes.iter().map(|mode| mode.size(root)).fold(0.0, f64::max);
    modes.retain(|mode| mode.size(root) >= share * largest);
    modes
}

/// The modes that are not faster than `slowest`, of any size.
pub(crate) fn slow_modes(inertia: &Inertia, slowest: f64) -> Vec<Mode> {
    let mut modes = all(inertia);
    modes.retain(|mode| mode.frequency[0].abs() * inertia.momentum <= slowest);
    modes
}

fn all(inertia: &Inertia) -> Vec<Mode> {
    let highest = HIGHEST as i32;
    let mut modes = Vec::new();
    for multiple in 0..=2_i32 {
        let lowest = if multiple == 0 { 1 } else { -highest };
        let harmonics = (lowest..=highest).filter(|h| (h + multiple) % 2 == 0);
        modes.extend(harmonics.map(|harmonic| Mode::new(inertia, harmonic, multiple)));
    }
    modes
}
