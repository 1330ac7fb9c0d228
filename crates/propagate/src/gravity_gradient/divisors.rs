//! The divisors of a term in the orbit's harmonics.
//!
//! On an ellipse (a/r)³ r̂r̂ = Σ U_ja e^(ijl) with a = 0, ±2 for its parts with 1 and e^(±2if). A term of frequency Ω has the divisor Ω + jn there. Near a
//! resonance it matters that the average torque changes Ω. From its mean over the orbit, K̄ = C η^(−3) (½ρ − ⅓) with ρ = 1 − k_N², follow
//!
//! ```text
//! dℓ′/dt: ∂K̄/∂L = (C′/M) η^(−3) (½ρ − ⅓)    dy′/dt: −σ ∂K̄/∂L    dk/dt = ω N × k,  ω = −C η^(−3) k_N/M
//! Ω + jn + (h − mσ) ∂K̄/∂L − ω (m k_N + a)
//! ```
//!
//! The second line is the divisor: in axes that precess with k, the frame turns about k and the disturbing body about N. On the average k_N is constant, and so
//! is this divisor. Within an orbit the phases and k swing about their mean motion ([`ranges`]). In harmonics that are not near resonance, and for j = 0, the bracket with the average torque has the same effect.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use nalgebra::Vector3;

use super::inertia::Inertia;

/// A harmonic with |Ω + jn| below this times n is a separate term in the sum over pairs.
const SINGLE_BELOW: f64 = 2.5;
/// If |Ω + jn| is below this times n, the divisor contains the shift by the average torque. Above it the shift is no larger than other effects of second order.
const RESONANT: f64 = 1.0;
/// A shift of this times n or more is not applied.
const MOST_SHIFT: f64 = 0.3;

/// The shift of the frequencies by the average torque.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Secular {
    /// Of ℓ′ and y′.
    phases: [f64; 2],
    /// ω and ω k_N.
    precession: [f64; 2],
    /// C′η^(−3)/M and Cη^(−3)/M.
    torque: [f64; 2],
    sigma: f64,
}

impl Secular {
    /// For an orbit of this eccentricity and normal, with q = 3φn²/2, and an angular momentum along a unit vector.
    pub(super) fn new(inertia: &Inertia, strength: f64, eccentricity: f64, [normal, pole]: [&Vector3<f64>; 2]) -> Self {
        let Inertia { sigma, momentum, .. } = *inertia;
        let scale = strength * ((1.0 - eccentricity) * (1.0 + eccentricity)).powf(-1.5) / momentum;
        let [torque, slope] = inertia.average_torque().map(|part| scale * part);
        let (along, across) = (pole.dot(normal), pole.cross(normal).norm_squared());
        let by_action = slope * (0.5 * across - 1.0 / 3.0);
        let precession = -torque * along;
        Self {
            phases: [by_action, -sigma * by_action],
            precession: [precession, precession * along],
            torque: [slope, torque],
            sigma,
        }
    }

    /// The ranges of the swings within an orbit, of ℓ′ and of k \[rad\]. That of y′ is σ times that of ℓ′.
    pub(super) fn swings(
        &self,
        [eccentricity, mean_motion]: [f64; 2],
        (axes, pole): (&[Vector3<f64>; 3], &Vector3<f64>),
    ) -> [f64; 2] {
        let [slope, torque] = self.torque.map(|part| part.abs() / mean_motion);
        let [by_phase, by_axis] = ranges(eccentricity, axes, pole);
        [by_phase * slope, 2.0 * by_axis * torque]
    }

    /// Upper estimate of the swing, within an orbit, of the phase and factors of a term with these h and m \[rad\], from [`Secular::swings`].
    pub(super) fn swing(&self, (harmonic, multiple): (i32, i32), [phase, axis]: [f64; 2]) -> f64 {
        let (h, m) = (f64::from(harmonic), f64::from(multiple));
        (h - m * self.sigma).abs() * phase + (m + 2.0) * axis
    }

    /// The angle by which k precesses in a time, at most 1.
    pub(super) fn precessed(&self, duration: f64) -> f64 {
        (self.precession[0].abs() * duration).min(1.0)
    }
}

/// The multiple of the mean motion nearest to a frequency. Harmonics beyond 1e9 have no strength.
pub(crate) fn multiple_of(mean_motion: f64, frequency: f64) -> i32 {
    (frequency / mean_motion).round().clamp(-1e9, 1e9) as i32
}

/// Points of the orbit at which the average torque is taken.
const PLACES: usize = 32;

/// Sines and cosines of equal steps of the true anomaly.
static CIRCLE: LazyLock<[(f64, f64); PLACES]> =
    LazyLock::new(|| std::array::from_fn(|i| (TAU * i as f64 / PLACES as f64).sin_cos()));

/// The ranges over an orbit of ∫ w ((k·r̂)² − ⅓) df and ∫ w (k·r̂)(r̂×k) df, w = 1 + e cos f, without the parts that grow with the mean anomaly, for a fixed k.
/// The averaged equations have them with the factors C′η^(−3)/(Mn) and 2Cη^(−3)/(Mn).
fn ranges(eccentricity: f64, axes: &[Vector3<f64>; 3], pole: &Vector3<f64>) -> [f64; 2] {
    let eta_cubed = ((1.0 - eccentricity) * (1.0 + eccentricity)).powf(1.5);
    // The slopes of the mean anomaly, of the first integral and of the components of the second one.
    let slopes = |(sine, cosine): (f64, f64)| {
        let direction = axes[0] * cosine + axes[1] * sine;
        let weight = 1.0 + eccentricity * cosine;
        let along = pole.dot(&direction);
        let turning = direction.cross(pole) * (weight * along);
        let [x, y, z] = axes.each_ref().map(|axis| turning.dot(axis));
        [eta_cubed / (weight * weight), weight * (along * along - 1.0 / 3.0), x, y, z]
    };
    let all = CIRCLE.map(slopes);
    let means: [f64; 5] = std::array::from_fn(|c| all.iter().map(|slopes| slopes[c]).sum::<f64>());
    let half_step = PI / PLACES as f64;
    let (mut sums, mut extremes) = ([0.0; 5], [[0.0_f64; 2]; 5]);
    for (i, slopes) in all.iter().enumerate() {
        let next = &all[(i + 1) % PLACES];
        for c in 0..5 {
            sums[c] += half_step * (slopes[c] + next[c]);
        }
        for c in 1..5 {
            let swing = sums[c] - means[c] / means[0] * sums[0];
            extremes[c] = [extremes[c][0].min(swing), extremes[c][1].max(swing)];
        }
    }
    let [_, phase, x, y, z] = extremes.map(|[least, most]| most - least);
    [phase, Vector3::new(x, y, z).norm()]
}

/// The divisors of one term.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divisors {
    /// Ω.
    pub(crate) frequency: f64,
    pub(crate) mean_motion: f64,
    /// Whether the term is too slow for a sum over time derivatives.
    pub(crate) slow: bool,
    /// The harmonic that is left out.
    pub(crate) excluded: Option<i32>,
    /// The shift by the average torque for a = 0, and for each unit of a.
    shift: [f64; 2],
    /// Upper estimate of the constant shift of a harmonic, for |a| up to 2.
    pub(crate) steady_shift: f64,
}

impl Divisors {
    pub(super) fn new(
        (harmonic, multiple): (i32, i32),
        [frequency, mean_motion]: [f64; 2],
        slow: bool,
        secular: &Secular,
    ) -> Self {
        let Secular { phases: [anomaly, longitude], precession: [precession, along], .. } = *secular;
        let (h, m) = (f64::from(harmonic), f64::from(multiple));
        let shift = [h * anomaly + m * (longitude - along), -precession];
        let steady_shift = shift[0].abs() + 2.0 * precession.abs();
        Self { frequency, mean_motion, slow, excluded: None, shift, steady_shift }
    }

    /// Without one harmonic, or with all.
    pub(super) fn without(self, excluded: Option<i32>) -> Self {
        Self { excluded, ..self }
    }

    /// Whether a harmonic is a term of its own in the sum over pairs: all those of a slow term are.
    pub(crate) fn is_single(&self, harmonic: i32) -> bool {
        self.slow || self.unshifted(harmonic).abs() < SINGLE_BELOW * self.mean_motion
    }

    /// Whether a harmonic is so near resonance that its divisor has the shift by the average torque.
    pub(crate) fn is_shifted(&self, harmonic: i32) -> bool {
        harmonic != 0
            && self.steady_shift < MOST_SHIFT * self.mean_motion
            && self.unshifted(harmonic).abs() < RESONANT * self.mean_motion
    }

    /// Ω + jn.
    pub(crate) fn unshifted(&self, harmonic: i32) -> f64 {
        self.frequency + f64::from(harmonic) * self.mean_motion
    }

    /// The divisor of U_ja.
    pub(crate) fn at(&self, harmonic: i32, turns: i32) -> f64 {
        let [shift, precession] = if self.is_shifted(harmonic) { self.shift } else { [0.0; 2] };
        self.unshifted(harmonic) + shift + f64::from(turns) * precession
    }

    /// The divisor of the harmonic's part that is nearest to resonance: of those with 1 and with the e^(±2if) that turns with it.
    pub(crate) fn smallest(&self, harmonic: i32) -> f64 {
        self.nearest(harmonic, &[0, 2])
    }

    /// The same for the parts with e^(iaf) that turn with the harmonic, for these |a|.
    pub(crate) fn nearest(&self, harmonic: i32, turns: &[i32]) -> f64 {
        let parts = turns.iter().map(|turns| self.at(harmonic, turns * harmonic.signum()));
        parts.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or_else(|| self.unshifted(harmonic))
    }

    /// 1 over the divisor of U_ja, or 0 for the harmonic that is left out.
    pub(crate) fn reciprocal(&self, harmonic: i32, turns: i32) -> f64 {
        if self.excluded == Some(harmonic) { 0.0 } else { 1.0 / self.at(harmonic, turns) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_swings_on_a_circle_are_those_of_twice_the_anomaly() {
        // ρ/4 sin 2g of the phase; of k the parts sin I/4 (cos I cos 2g, cos I sin 2g, sin I cos 2g).
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        for inclination in [0.0, 0.3, 1.2, 2.5_f64] {
            let (sine, cosine) = inclination.sin_cos();
            let pole = Vector3::new(0.6 * sine, -0.8 * sine, cosine);
            let expected = [0.5 * sine * sine, 0.5 * sine * (1.0 + cosine * cosine).sqrt()];
            for (found, expected) in ranges(0.0, &axes, &pole).into_iter().zip(expected) {
                assert!((found - expected).abs() <= 0.03 * expected + 1e-14, "{inclination}: {found} {expected}");
            }
        }
    }

    #[test]
    fn the_swing_of_an_axis_that_is_normal_to_the_orbit_is_the_equation_of_the_centre() {
        // −⅓ of f + e sin f − l. Its extremes are at r = aη.
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let eccentricity = 0.4_f64;
        let swing = |eccentric: f64| {
            let (sine, cosine) = eccentric.sin_cos();
            let f = ((1.0 - eccentricity * eccentricity).sqrt() * sine).atan2(cosine - eccentricity);
            (f + eccentricity * f.sin() - (eccentric - eccentricity * sine)) / 3.0
        };
        let most = (0..1000).map(|k| swing(PI * f64::from(k) / 1000.0)).fold(0.0, f64::max);
        let [phase, axis] = ranges(eccentricity, &axes, &Vector3::z());
        assert!((phase - 2.0 * most).abs() <= 0.03 * most && axis == 0.0, "{phase} {axis} {most}");
    }
}
