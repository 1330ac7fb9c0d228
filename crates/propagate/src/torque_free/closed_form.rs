//! The closed form: a and b of theory §8 as theta functions of ℓ′. Their sums converge like q^(n²) (theory §10).
//!
//! 1 ± cos J are elliptic functions of time, and |a|², |b|² are half of them. Each has two zeros in a period cell. The phase e^(iy) turns one of the two into a
//! double zero of a² (or b²) and cancels the other. The quotient is a theta function with one zero over a common denominator. The denominator is not needed,
//! because the norm |a|² + |b|² = 1 is known. With q = e^(−πK′/K) and χ = πη/(2K):
//!
//! ```text
//! a e^(−iy′/2) ∝ θ3(ℓ′ − iχ | q²) = 1 + Σ 2 q^(2n²) cos 2n(ℓ′ − iχ)
//! b e^(−iy′/2) ∝ ρ θ2(ℓ′ − iχ | q²)/(2 q^½ cosh χ) = ρ Σ q^(2n²+2n) cos (2n+1)(ℓ′ − iχ)/cosh χ
//! ```
//!
//! Here ρ follows from tan(J/2) = |b/a| at ℓ′ = 0, where all terms are positive. Since η ≤ K′, e^(2χ) q ≤ 1, and the n-th terms are at most of size q^(2n²−n)
//! and q^(2n²+n). One to eight terms are enough down to k′ = 1e-5, where the terms are 18 times as large as their sum (k′^(−1/4)). Nearer to the separatrix the
//! module `separatrix` is used. No quadrature, no inverse trigonometric function and no difference 2TC − G² is computed. Checked in 40 digits against all
//! reference motions: equal to 1e-31.

use std::f64::consts::{FRAC_PI_2, PI};

use super::harmonics::CayleyKleinSeries;
use super::polhode::Polhode;
use crate::numerics::theta::Theta;

/// k′² below which the nome q is near 1 and the transformed theta functions are used.
pub(crate) const NEAREST_COMPLEMENT: f64 = 0.9e-10;

/// Largest number of terms. It is enough for every k′² above the bound: q^(2n²−n) is 1e-20 at n = 8 for q = 0.68.
const MOST_TERMS: usize = 10;

/// Terms smaller than this are dropped; the first term is 1.
const NEGLIGIBLE: f64 = 1e-18;

/// The theta series of one polhode, and the phase of the state on it.
#[derive(Clone, Debug)]
pub(crate) struct ClosedForm {
    /// The series of a and b, not normalized.
    pub(crate) series: CayleyKleinSeries,
    /// ℓ′ at the epoch \[rad\].
    pub(crate) anomaly: f64,
    /// The smallest √(|a|² + |b|²) of the series.
    pub(crate) least_norm: f64,
}

impl ClosedForm {
    /// The series for k′² ≥ [`NEAREST_COMPLEMENT`].
    pub(crate) fn new(polhode: &Polhode, theta: &Theta) -> Self {
        let logarithm = -PI * theta.conjugate / theta.quarter;
        let q = logarithm.exp();
        let chi = FRAC_PI_2 * theta.eta / theta.quarter;
        // e^(−2χ), and e^(2χ) q ≤ 1. Both are 0 for a circular polhode, where χ = ∞.
        let small = (-2.0 * chi).exp();
        let large = if q == 0.0 { 0.0 } else { (2.0 * chi + logarithm).exp().min(1.0) };
        let mut terms = Vec::with_capacity(MOST_TERMS);
        terms.push(([1.0, 0.0], [1.0, (1.0 - small) / (1.0 + small)]));
        // q^(2n²−n), q^(2n²), q^(2n²+n) and q^(2n²+2n) grow by q^(4n) times q, q², q³ and q⁴; then e^(±2nχ).
        let (mut powers, mut growth) = ([1.0; 4], 1.0);
        let (mut up, mut down) = (1.0, 1.0);
        for _ in 1..MOST_TERMS {
            for power in &mut powers {
                growth *= q;
                *power *= growth;
            }
            (up, down) = (up * large, down * small);
            let (rising, falling) = (up * powers[0], down * powers[1]);
            let even = [rising + falling, rising - falling];
            let (rising, falling) = (up * powers[2], down * small * powers[3]);
            let odd = [(rising + falling) / (1.0 + small), (rising - falling) / (1.0 + small)];
            if even[0].max(odd[0]) < NEGLIGIBLE {
                break;
            }
            terms.push((even, odd));
        }
        let sum = |part: fn(&([f64; 2], [f64; 2])) -> f64| terms.iter().rev().map(part).sum::<f64>();
        let ratio = theta.half_tangents[0] * sum(|t| t.0[0]) / sum(|t| t.1[0]);
        for (_, odd) in &mut terms {
            *odd = odd.map(|c| ratio * c);
        }
        let signed = terms.iter().enumerate().rev().map(|(k, t)| if k % 2 == 0 { t.0[0] } else { -t.0[0] });
        let alternating: f64 = signed.sum();
        let least_norm = alternating / (0.5 * (1.0 + theta.cosines[1])).sqrt();
        Self { series: CayleyKleinSeries::from_terms(terms), anomaly: anomaly(polhode, theta), least_norm }
    }
}

/// ℓ′ of the state, in (−π, π].
pub(crate) fn anomaly(polhode: &Polhode, theta: &Theta) -> f64 {
    let (position, [cosine_sign, sine_sign]) = polhode.quadrant();
    let (from_the_top, distance) = match theta.complement {
        1.0 => (false, theta.quarter * position[1].atan2(position[0]) / FRAC_PI_2), // a circle
        _ => polhode.invariants.argument,
    };
    let distance = FRAC_PI_2 * distance / theta.quarter;
    let angle = if from_the_top { FRAC_PI_2 - distance } else { distance };
    let angle = if cosine_sign < 0.0 { PI - angle } else { angle };
    angle * sine_sign
}
