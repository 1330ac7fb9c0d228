//! The secular part of a motion: σ and the mean rates of ℓ′ and y′ (theory §5, §7).
//!
//! Two routes. `exact` is the quadrature that theory §5 states, in the variable in which it has no singularity but the
//! separatrix: with Q(ℓ) = cos²J of the polhode module,
//!
//! ```text
//! κσ = κE ⟨1/(1+√Q)⟩_ℓ,   dℓ′/dt = (Mγ/C) agm(√Q1, √Q2),   dy′/dt = (M/C) [1 + γE ⟨1/(1+√Q)⟩_t]
//! ```
//!
//! where ⟨⟩_ℓ is the mean over ℓ and ⟨⟩_t that with the weight 1/√Q (dt is proportional to dℓ/√Q). The last follows from
//! dy/dt = ∂H/∂M = (M/C)[1 + α(1−cosJ)(1−β cos 2ν)] at fixed (x, X). Every term is positive, and all of it is in double-double.
//! `truncated` is the series of theory §7 at a stated order, for who asks for that order.

use crate::double_double::{DoubleDouble, arithmetic_geometric_mean};
use crate::polhode::Polhode;

/// Largest number of quadrature nodes in a quarter period: full accuracy to 1 − m = 1e-12, far past what the series serve. On the
/// separatrix itself the sums converge no more, but there σ = σ_sep is known.
const MAX_NODES: usize = 16384;

/// σ and the mean rates, in the scaled units of the polhode.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Secular {
    /// κσ, the variable of the series.
    pub(crate) kappa_sigma: f64,
    /// dℓ′/dt.
    pub(crate) anomaly_rate: DoubleDouble,
    /// dy′/dt.
    pub(crate) longitude_rate: DoubleDouble,
}

impl Secular {
    /// By quadrature, for 0 < Q1 or A = B.
    pub(crate) fn exact(polhode: &Polhode) -> Self {
        let mean_rate = polhode.mean_rate();
        let [q1, q2] = polhode.cosine_squares();
        let (anomaly_mean, time_mean, agm) = if polhode.difference == DoubleDouble::ZERO {
            let cosine = q2.sqrt();
            let mean = DoubleDouble::ONE / (DoubleDouble::ONE + cosine);
            (mean, mean, cosine)
        } else {
            means(q1, q2)
        };
        Self {
            kappa_sigma: (polhode.kappa_energy() * anomaly_mean).to_f64(),
            anomaly_rate: mean_rate * polhode.gamma() * agm,
            longitude_rate: mean_rate * (DoubleDouble::ONE + polhode.gamma_energy() * time_mean),
        }
    }

    /// By the series truncated after P_N, `polynomials` = P_0 … P_N (theory §7).
    pub(crate) fn truncated(polhode: &Polhode, polynomials: &[f64]) -> Self {
        let s = invert_energy(polynomials, polhode.kappa_energy().to_f64());
        let (mut slope, mut rest) = (0.0, 0.0);
        for (n, &p) in polynomials.iter().enumerate().rev() {
            slope = slope * s + (n as f64 + 1.0) * p;
            rest = rest * s + (1.0 - n as f64) * p;
        }
        let half = 0.5 * polhode.gamma().to_f64();
        let mean_rate = polhode.mean_rate();
        Self {
            kappa_sigma: s,
            anomaly_rate: mean_rate * (half * slope).into(),
            longitude_rate: mean_rate * (1.0 + half / polhode.kappa() * rest * s).into(),
        }
    }
}

/// κσ from Σ P_n (κσ)^(n+1) = κE by Newton's method.
///
/// P_0 = 2 and P_n ≤ 0: the sum is concave and at most 2κσ, so from κE/2 the iteration rises to the root without passing it.
fn invert_energy(polynomials: &[f64], kappa_energy: f64) -> f64 {
    let mut s = 0.5 * kappa_energy;
    // Quadratic from below; the bound is for the slow first steps next to the separatrix.
    for _ in 0..100 {
        let (mut value, mut slope) = (0.0, 0.0);
        for (n, &p) in polynomials.iter().enumerate().rev() {
            value = value * s + p;
            slope = slope * s + (n as f64 + 1.0) * p;
        }
        if slope <= 0.0 {
            break;
        }
        let step = (kappa_energy - value * s) / slope;
        s += step;
        if step.abs() <= f64::EPSILON * s {
            break;
        }
    }
    s
}

/// ⟨1/(1+√Q)⟩_ℓ, ⟨1/(1+√Q)⟩_t and agm(√Q1, √Q2).
///
/// Trapezoidal sums in φ with tan ℓ = c tan φ, c² = √(Q1/Q2) = ρ: the integrands are analytic in |Im φ| < atanh √ρ, and n nodes in
/// half a turn leave an error of e^(−2n atanh √ρ). Unstretched (c = 1) the strip is atanh ρ: ten times the nodes at σ/σ_sep = 0.98.
fn means(q1: DoubleDouble, q2: DoubleDouble) -> (DoubleDouble, DoubleDouble, DoubleDouble) {
    let (root1, root2) = (q1.sqrt(), q2.sqrt());
    let stretch = root1 / root2;
    let strip = stretch.to_f64().sqrt().atanh();
    // e^(−2n·strip) = 1e-33 for n nodes in half a turn, of which symmetry leaves one half.
    let quarter = ((76.0 / (4.0 * strip)).ceil() as usize).clamp(2, MAX_NODES);
    let (sine, cosine) = (DoubleDouble::PI / DoubleDouble::from(4.0 * quarter as f64)).sin_cos();
    // Nodes at φ = (j + ½)π/2n, in 2φ: start at one step of π/2n, go on by two.
    let (mut c2, mut s2) = (cosine * cosine - sine * sine, DoubleDouble::from(2.0) * sine * cosine);
    let step = (c2 * c2 - s2 * s2, DoubleDouble::from(2.0) * s2 * c2);
    let (mut by_anomaly, mut by_time) = (DoubleDouble::ZERO, DoubleDouble::ZERO);
    for _ in 0..quarter {
        let (cos2, sin2) = (DoubleDouble::ONE + c2, DoubleDouble::ONE - c2);
        let weight = DoubleDouble::ONE / (cos2 + stretch * sin2);
        let root = ((q1 * cos2 + q2 * stretch * sin2) * weight).sqrt();
        let term = weight / (DoubleDouble::ONE + root);
        by_anomaly = by_anomaly + term;
        by_time = by_time + term / root;
        (c2, s2) = (c2 * step.0 - s2 * step.1, s2 * step.0 + c2 * step.1);
    }
    // cos2 and sin2 are twice the squares, so weight carries ½ and the mean 2c/n.
    let factor = DoubleDouble::from(2.0) / DoubleDouble::from(quarter as f64) * stretch.sqrt();
    let agm = arithmetic_geometric_mean(root1, root2);
    (by_anomaly * factor, by_time * factor * agm, agm)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_one_over_the_cosine_is_one_over_the_agm_to_thirty_digits() {
        // By construction ⟨1/√Q⟩_ℓ = 1/agm, and 1/(√Q(1+√Q)) + 1/(1+√Q) = 1/√Q ties the two sums to it.
        for (q1, q2) in [(0.9, 0.95), (0.3, 0.8), (0.01, 0.7), (1e-4, 0.5)] {
            let (by_anomaly, by_time, agm) = means(q1.into(), q2.into());
            let whole = by_time + by_anomaly * agm;
            assert!((whole - DoubleDouble::ONE).to_f64().abs() < 1e-28, "{q1} {q2}: {whole:?}");
        }
    }
}
