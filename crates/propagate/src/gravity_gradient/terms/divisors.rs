//! The divisors of a term in the orbit's harmonics.
//!
//! On an ellipse Θ = Σ Θ_ja e^(ijl) with a = 0, ±2 for its parts with 1 and e^(±2if). A term of frequency Ω has the divisor Ω + jn there. Near a
//! resonance it matters that the average torque changes Ω. From its mean over the orbit, K̄ = ΓΔ η^(−3) (½ρ − ⅓) with ρ = 1 − k_N², follow
//!
//! ```text
//! dℓ′/dt: ∂K̄/∂L = (ΓΔ′/M) η^(−3) (½ρ − ⅓)    dy′/dt: −σ ∂K̄/∂L    dk/dt = ϖ n̂ × k,  ϖ = −ΓΔ η^(−3) k_N/M
//! Ω + jn + (h − mσ) ∂K̄/∂L − ϖ (m k_N + a)
//! ```
//!
//! The second line is the divisor: in axes that precess with k, the frame turns about k and the disturbing body about n̂. The averaged torque keeps k_N constant, so
//! the divisor is constant. Away from resonance, and for j = 0, the bracket {⟨D⟩, W} gives this shift, and it is not applied here.

use super::term::Term;
use crate::gravity_gradient::constants::{MOST_SHIFT, SINGLE_BELOW};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::inertia::Inertia;
use crate::orbit::position::eta;

/// The shift of the frequencies by the average torque.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AverageShift {
    /// Of ℓ′ and y′.
    phases: [f64; 2],
    /// ϖ and ϖ k_N.
    precession: [f64; 2],
}

impl AverageShift {
    pub(crate) fn new(inertia: &Inertia, orbit: &Disturbance<'_>) -> Self {
        let (normal, pole) = (orbit.path.axes[2], orbit.pole);
        let scale = orbit.strength() * eta(orbit.orbit.eccentricity()).powi(-3) / inertia.momentum;
        let [torque, slope, _] = Term::average(inertia).map(|part| scale * part);
        let (along, across) = (pole.dot(&normal), pole.cross(&normal).norm_squared());
        let by_action = slope * (0.5 * across - 1.0 / 3.0);
        let precession = -torque * along;
        Self { phases: [by_action, -inertia.sigma * by_action], precession: [precession, precession * along] }
    }
}

/// The multiple of the mean motion nearest to a frequency. Harmonics beyond 1e9 have no strength.
pub(crate) fn multiple_of(mean_motion: f64, frequency: f64) -> i32 {
    (frequency / mean_motion).round().clamp(-1e9, 1e9) as i32
}

/// The divisors of one term.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divisors {
    /// Ω.
    pub(crate) frequency: f64,
    pub(crate) mean_motion: f64,
    /// Whether the term is too slow for a sum over time derivatives.
    pub(crate) slow: bool,
    /// The harmonic whose solution vanishes at the epoch: it has no part in the mean, and no divisor.
    pub(crate) resonant: Option<i32>,
    /// The shift by the average torque for a = 0, and for each unit of a.
    shift: [f64; 2],
    /// Upper estimate of the constant shift of a harmonic, for |a| up to 2.
    pub(crate) steady_shift: f64,
}

impl Divisors {
    pub(crate) fn new(
        (harmonic, multiple): (i32, i32),
        [frequency, mean_motion]: [f64; 2],
        slow: bool,
        secular: &AverageShift,
    ) -> Self {
        let AverageShift { phases: [anomaly, longitude], precession: [precession, along], .. } = *secular;
        let (h, m) = (f64::from(harmonic), f64::from(multiple));
        let shift = [h * anomaly + m * (longitude - along), -precession];
        let steady_shift = shift[0].abs() + 2.0 * precession.abs();
        Self { frequency, mean_motion, slow, resonant: None, shift, steady_shift }
    }

    /// With a harmonic whose solution vanishes at the epoch.
    pub(crate) fn with_resonant(self, resonant: Option<i32>) -> Self {
        Self { resonant, ..self }
    }

    /// Whether a harmonic is a term of its own in the sum over pairs: all those of a slow term are.
    pub(crate) fn is_single(&self, harmonic: i32) -> bool {
        self.slow || self.unshifted(harmonic).abs() < SINGLE_BELOW * self.mean_motion
    }

    /// Whether |Ω + jn| is below n, so that the divisor has the shift by the average torque. Above n the shift is no larger than other effects of second order.
    pub(crate) fn is_shifted(&self, harmonic: i32) -> bool {
        harmonic != 0
            && self.steady_shift < MOST_SHIFT * self.mean_motion
            && self.unshifted(harmonic).abs() < self.mean_motion
    }

    /// Ω + jn.
    pub(crate) fn unshifted(&self, harmonic: i32) -> f64 {
        self.frequency + f64::from(harmonic) * self.mean_motion
    }

    /// The divisor of Θ_ja.
    pub(crate) fn at(&self, harmonic: i32, turns: i32) -> f64 {
        let [shift, precession] = if self.is_shifted(harmonic) { self.shift } else { [0.0; 2] };
        self.unshifted(harmonic) + shift + f64::from(turns) * precession
    }

    /// The smaller in magnitude of the divisors for a = 0 and for the a = ±2 with the sign of j.
    pub(crate) fn smallest(&self, harmonic: i32) -> f64 {
        let [one, other] = [0, 2 * harmonic.signum()].map(|turns| self.at(harmonic, turns));
        if other.abs() < one.abs() { other } else { one }
    }

    /// 1 over the divisor of Θ_ja, or 0 for the harmonic whose solution vanishes at the epoch.
    pub(crate) fn reciprocal(&self, harmonic: i32, turns: i32) -> f64 {
        if self.resonant == Some(harmonic) { 0.0 } else { 1.0 / self.at(harmonic, turns) }
    }
}

/// The part of a harmonic that does not return within the span: e^(−Ω_j² span²/3) with the divisor Ω_j and the longest time from the epoch.
pub(crate) fn unreturned(divisor: f64, duration: f64) -> f64 {
    (-(divisor * duration).powi(2) / 3.0).exp()
}
