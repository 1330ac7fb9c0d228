//! The part of ⟨K2⟩ by two terms whose angle (h_a − h_b) ℓ′ does not return within the span.
//!
//! Next to a sphere ℓ′ hardly turns. Pairs of terms with the same m and different h are then as steady as the pairs of equal terms in equation (8) of
//! docs/theory-second-order.md. With F = f σ^(|h|/2), G = 1/(Ω + jn) and n·∂ = ((h − mσ)/M) ∂_σ + m ∂_M, each ordered pair adds to ⟨K2⟩
//!
//! ```text
//! Γ² cos((h_a − h_b) ℓ′) e^(−ω² span²/4) {α_mj [F_a (n_a·∂)(F_b G_b) + F_b G_b (n_b·∂) F_a] + (β_mj/M) F_a F_b G_b}
//! ```
//!
//! with h_b > 0 and any h_a for m = 0. ℓ′ is that of the epoch, ω is the rate of the angle, and the exponential is the complement of the factor of χ₂ in equation (7). A pair of
//! ⟨D⟩ with W_b counts twice, because its source is {⟨D⟩, W}. These pairs alone contain ℓ′: they also change the mean L, at the rate −∂K2/∂ℓ′.

use crate::gravity_gradient::constants::{LOG_CUTOFF, NEAREST_IN_K2};
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::divisors::Divisors;
use crate::gravity_gradient::terms::term::Term;

/// h, and F with its first two derivatives with respect to σ.
type PairedAmplitude = (f64, [f64; 3]);

/// A term of the torque and one of W.
pub(crate) struct SlowPair<'a> {
    torque: PairedAmplitude,
    wave: PairedAmplitude,
    /// The term of W and its exact divisors, if it has these.
    pub(crate) term: (&'a Term, Option<&'a Divisors>),
    /// 2 for a pair of ⟨D⟩, otherwise 1.
    weight: f64,
    /// |h_a − h_b|.
    pub(crate) apart: i32,
}

/// What the angle (h_a − h_b) ℓ′ does to a pair within the span.
pub(crate) struct SlowAngle {
    /// cos((h_a − h_b) ℓ′) e^(−ω² span²/4), and its derivative with respect to −ℓ′.
    pub(crate) factors: [f64; 2],
    /// Largest error of the constant rates, over the change by the largest rate within the span: u e^(−u²) because the angle turns, and (1 − e^(−u²))/u by
    /// χ₂, where u is half the turn of the angle within the span.
    pub(crate) unsteady: f64,
}

impl SlowAngle {
    /// From |h_a − h_b|, ℓ′ at the epoch and the span.
    pub(crate) fn new(apart: i32, angle: f64, inertia: &Inertia, duration: f64) -> Self {
        let apart = f64::from(apart);
        let (sine, cosine) = (apart * angle).sin_cos();
        let turn = (apart * half_turn(inertia, duration)).max(f64::MIN_POSITIVE);
        let stays = (-turn * turn).exp();
        let unsteady = turn * stays - (-turn * turn).exp_m1() / turn;
        Self { factors: [cosine * stays, apart * sine * stays], unsteady }
    }
}

/// Half the turn of ℓ′ within the span.
fn half_turn(inertia: &Inertia, duration: f64) -> f64 {
    0.5 * inertia.rates[0].to_f64().abs() * duration
}

/// The pairs among terms with one m.
pub(crate) fn slow_pairs<'a>(
    terms: &'a [(Term, Option<&'a Divisors>)],
    multiple: i32,
    inertia: &Inertia,
    duration: f64,
) -> Vec<SlowPair<'a>> {
    // Two h differ by 2 at least.
    if (2.0 * half_turn(inertia, duration)).powi(2) > LOG_CUTOFF {
        return Vec::new();
    }
    let sigma = inertia.root().powi(2);
    let amplitude = |term: &Term| (f64::from(term.harmonic), of_degree(term.harmonic.abs(), term.weighted(), sigma));
    let waves: Vec<_> = terms.iter().filter(|(term, _)| term.multiple == multiple).collect();
    let mut torques: Vec<(PairedAmplitude, f64)> = waves.iter().map(|(term, _)| (amplitude(term), 1.0)).collect();
    if multiple == 0 {
        let opposite: Vec<_> = torques.iter().map(|((h, function), weight)| ((-h, *function), *weight)).collect();
        torques.extend(opposite);
        torques.push(((0.0, Term::average(inertia)), 2.0));
    }
    let mut pairs = Vec::new();
    for (term, divisors) in waves {
        let wave = amplitude(term);
        for (torque, weight) in torques.iter().filter(|((h, _), _)| *h != wave.0) {
            let apart = (torque.0 - wave.0).abs() as i32; // two harmonics
            pairs.push(SlowPair { torque: *torque, wave, term: (term, *divisors), weight: *weight, apart });
        }
    }
    pairs
}

impl SlowPair<'_> {
    /// The factors of α and of β for one harmonic of the orbit, without those of the angle, and their derivatives with respect to σ and M; `None` where the corrections do not contain the harmonic, or
    /// where its solution vanishes at the epoch.
    pub(crate) fn shape(&self, inertia: &Inertia, (j, mean_motion): (i32, f64)) -> Option<[[f64; 2]; 3]> {
        let (term, divisors) = self.term;
        let divisor = match divisors {
            Some(divisors) if divisors.resonant == Some(j) => return None,
            Some(divisors) => divisors.at(j, 2 * j.signum()),
            None => term.frequency + f64::from(j) * mean_motion,
        };
        if divisors.is_none() && j != 0 && divisor.abs() <= NEAREST_IN_K2 * mean_motion {
            return None;
        }
        let [g, g1, g2] = reciprocal(divisor).map(|part| self.weight * part);
        let Inertia { sigma, momentum, .. } = *inertia;
        let m = f64::from(term.multiple);
        let ((a, [f, f1, f2]), (b, [w, w1, w2]), [nu, nu1, nu2]) = (self.torque, self.wave, term.per_momentum);
        let [a, b] = [a, b].map(|h| h - m * sigma);
        let (product, slope, along) = (f * w, f1 * w + f * w1, a * nu1 + m * nu);
        let crossed = (a * f * w1 + b * f1 * w) / momentum;
        let bent = (a * (f1 * w1 + f * w2) + b * (f1 * w1 + f2 * w) - m * slope) / momentum;
        // M times the derivative of G/M with respect to M.
        let by_momentum = g1 * nu - g / momentum;
        Some([
            [crossed * g + product * along * g1, product * g / momentum],
            [
                bent * g
                    + (crossed * momentum * nu1 + slope * along + product * a * nu2) * g1
                    + product * along * momentum * nu1 * g2,
                slope * g / momentum + product * g1 * nu1,
            ],
            [crossed * by_momentum + product * along * nu * g2, product / momentum * by_momentum],
        ])
    }
}

/// f σ^(d/2) and its first two derivatives with respect to σ > 0.
fn of_degree(degree: i32, [f, slope, curvature]: [f64; 3], sigma: f64) -> [f64; 3] {
    let (d, power) = (0.5 * f64::from(degree), sigma.sqrt().powi(degree));
    let falling = d / sigma;
    [
        f * power,
        (slope + falling * f) * power,
        (curvature + 2.0 * falling * slope + falling * (d - 1.0) / sigma * f) * power,
    ]
}

/// 1/(Ω + jn) and its derivatives with respect to Ω.
pub(super) fn reciprocal(divisor: f64) -> [f64; 3] {
    let inverse = divisor.recip();
    [inverse, -inverse * inverse, 2.0 * inverse.powi(3)]
}
