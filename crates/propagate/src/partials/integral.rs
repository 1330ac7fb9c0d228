//! The only integral that the closed form needs: ∫g2² dt, an elliptic integral of the second kind (theory §12).
//!
//! g2² is proportional to sn² v with v = (2K/π)(ℓ′ − π/2). Its mean is (1 − E/K)/m. The integral of the remaining periodic part is Jacobi's zeta function:
//!
//! ```text
//! (1 − E/K)/m = Σ 2^(n−1) c_n²/m       Z(v)/m = −(π/2K) Σ 4n (q^(n²)/m) sin 2nℓ′ / (1 + 2 Σ q^(n²) cos 2nℓ′)
//! ```
//!
//! Here c_n is from the arithmetic-geometric mean. Both are divided by m before any subtraction, so they are valid at m = 0. Near the separatrix Z is a sum of
//! hyperbolic tangents, one for each passage.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::numerics::theta::Theta;

/// Smaller q^(n²) are negligible relative to 1.
const NEGLIGIBLE: f64 = 1e-18;
/// Below this m, q/m is computed from its power series.
const SMALL_PARAMETER: f64 = 1e-6;
/// Number of passages on each side that are summed. The next one is e^(−8πK/K′), 1e-80 at k′ = 1e-5.
const PASSAGES: i32 = 3;

/// The mean of sn², and the zeta function over m.
#[derive(Clone, Debug)]
pub(super) struct Integral {
    /// ⟨sn²⟩.
    pub(super) mean_square: f64,
    /// m.
    parameter: f64,
    quarter: f64,
    conjugate: f64,
    /// For n = 1, 2, …: the factor of sin 2nℓ′ in the numerator of Z/m, and the factor of cos 2nℓ′ in the denominator.
    pub(super) terms: Vec<[f64; 2]>,
}

impl Integral {
    /// The integral for a polhode with m = 1 − Q1/Q2.
    pub(super) fn new(theta: &Theta) -> Self {
        let parameter = theta.parameter;
        let logarithm = -PI * theta.conjugate / theta.quarter;
        let nome = logarithm.exp();
        let ratio = if parameter < SMALL_PARAMETER {
            (1.0 + parameter * (0.5 + parameter * (21.0 / 64.0 + parameter * (31.0 / 128.0)))) / 16.0
        } else {
            nome / parameter
        };
        let mut terms = Vec::new();
        for n in 1_i32.. {
            let power = nome.powi(n * n);
            if n > 1 && power < NEGLIGIBLE {
                break;
            }
            let factor = -2.0 * PI / theta.quarter * f64::from(n) * ratio * nome.powi(n * n - 1);
            terms.push([factor, 2.0 * power]);
        }
        Self {
            mean_square: mean_square(theta.complement, parameter),
            parameter,
            quarter: theta.quarter,
            conjugate: theta.conjugate,
            terms,
        }
    }

    /// Z/m at the ℓ′ with this (sine, cosine) of 2ℓ′.
    pub(super) fn zeta(&self, (sine, cosine): (f64, f64)) -> f64 {
        let (mut numerator, mut denominator, mut c, mut s) = (0.0, 1.0, cosine, sine);
        for [odd, even] in &self.terms {
            numerator += odd * s;
            denominator += even * c;
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        }
        numerator / denominator
    }

    /// Z/m near the separatrix, where `angle` = 2ℓ″ = 2ℓ′ − π is between −π and π.
    pub(super) fn zeta_of_passages(&self, angle: f64) -> f64 {
        let u = self.quarter * angle / PI;
        let rate = FRAC_PI_2 / self.conjugate;
        let beside = |n: i32| {
            let away = 4.0 * rate * f64::from(n) * self.quarter;
            // tanh(x − a) + tanh(x + a) = 2 sinh 2x/(cosh 2x + cosh 2a), scaled by e^(−2a).
            let (rising, falling) = ((2.0 * rate * u - away).exp(), (-2.0 * rate * u - away).exp());
            2.0 * (rising - falling) / (rising + falling + 1.0 + (-2.0 * away).exp())
        };
        let sum: f64 = (1..=PASSAGES).rev().map(beside).sum::<f64>() + (rate * u).tanh();
        (rate * sum - rate * u / self.quarter) / self.parameter
    }
}

/// (1 − E/K)/m, by the arithmetic-geometric mean.
fn mean_square(complement: f64, parameter: f64) -> f64 {
    let (mut a, mut b) = (1.0, complement.sqrt());
    // c_1²/m = m/(4(1 + k′)²), and c_{n+1} = c_n²/(4 a_{n+1}).
    let mut c = 0.5 * parameter / (1.0 + b);
    let (mut sum, mut weight) = (0.5, 1.0);
    let mut ratio = 0.25 * parameter / ((1.0 + b) * (1.0 + b));
    for _ in 0..24 {
        sum += weight * ratio;
        if c <= f64::EPSILON * a {
            break;
        }
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        let next = 0.25 * c * c / (0.5 * (a + b));
        ratio *= next / c * (next / c);
        c = next;
        weight *= 2.0;
    }
    sum
}
