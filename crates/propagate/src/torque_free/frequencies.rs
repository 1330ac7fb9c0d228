//! The secular part of a motion: σ and the mean rates of ℓ′ and y′ (theory §5, §7).
//!
//! There are two methods. `exact` is the quadrature of theory §5, in a variable in which only the separatrix is singular. With Q(ℓ) = cos²J of the polhode
//! module,
//!
//! ```text
//! κσ = κE ⟨1/(1+√Q)⟩_ℓ,   dℓ′/dt = (Mγ/C) agm(√Q1, √Q2),   dy′/dt = (M/C) [1 + γE ⟨1/(1+√Q)⟩_t]
//! ```
//!
//! Here ⟨⟩_ℓ is the mean over ℓ, and ⟨⟩_t the mean with the weight 1/√Q (dt is proportional to dℓ/√Q). The last equation follows from dy/dt = ∂H/∂M = (M/C)[1 +
//! α(1−cosJ)(1−β cos 2ν)] at fixed (x, X). Every term is positive, and all terms are in double-double. `truncated` is the series of theory §7 at a fixed order.

use andoyer_double::DoubleDouble;

use super::invariants::Invariants;
use super::polhode::Polhode;
use super::quadrature::{Means, nodes, trapezoidal};

/// Step of the logarithmic sum: its error is e^(−π²/step), 1e-33.
const LOGARITHMIC_STEP: f64 = 0.125;

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
    /// The frequencies by quadrature, for 0 < Q1 or A = B.
    pub(crate) fn exact(polhode: &Polhode) -> Self {
        let invariants = &polhode.invariants;
        let mut found = [[DoubleDouble::ZERO; 2]];
        let asked = asked(invariants);
        if let Some(asked) = asked {
            trapezoidal(&[asked], &mut found);
        }
        Self::from_means(invariants, means(invariants, asked.map(|_| found[0])))
    }

    /// The frequencies of at most as many polhodes as the widest vectors have lanes, each to the bits of [`Secular::exact`].
    pub(crate) fn several(polhodes: &[&Polhode]) -> Vec<Self> {
        let all: Vec<Option<Means>> = polhodes.iter().map(|polhode| asked(&polhode.invariants)).collect();
        let together: Vec<Means> = all.iter().copied().flatten().collect();
        let mut found = vec![[DoubleDouble::ZERO; 2]; together.len()];
        trapezoidal(&together, &mut found);
        let mut found = found.into_iter();
        let mut each = |(polhode, asked): (&&Polhode, Option<Means>)| {
            let sums = asked.and_then(|_| found.next());
            Self::from_means(&polhode.invariants, means(&polhode.invariants, sums))
        };
        polhodes.iter().zip(all).map(&mut each).collect()
    }

    fn from_means(invariants: &Invariants, [by_anomaly, by_time]: [DoubleDouble; 2]) -> Self {
        let Invariants { mean_rate, gamma, gamma_energy, kappa_energy, .. } = *invariants;
        Self {
            kappa_sigma: (kappa_energy * by_anomaly).to_f64(),
            anomaly_rate: mean_rate * gamma * agm(invariants),
            longitude_rate: mean_rate * (DoubleDouble::ONE + gamma_energy * by_time),
        }
    }

    /// The frequencies by the series truncated after P_N, with `polynomials` = P_0 … P_N (theory §7), in double-double. In `f64` the phase would be wrong by
    /// 1e-13 rad after 100 rotations.
    pub(crate) fn truncated(polhode: &Polhode, polynomials: &[DoubleDouble]) -> Self {
        let s = invert_energy(polynomials, polhode.invariants.kappa_energy);
        let (mut slope, mut rest) = (DoubleDouble::ZERO, DoubleDouble::ZERO);
        for (n, &p) in polynomials.iter().enumerate().rev() {
            slope = slope * s + p.times_double(n as f64 + 1.0);
            rest = rest * s + p.times_double(1.0 - n as f64);
        }
        let half = polhode.invariants.gamma.times_double(0.5);
        let kappa = polhode.alpha() / polhode.invariants.gamma;
        let mean_rate = polhode.invariants.mean_rate;
        Self {
            kappa_sigma: s.to_f64(),
            anomaly_rate: mean_rate * half * slope,
            longitude_rate: mean_rate * (DoubleDouble::ONE + half / kappa * rest * s),
        }
    }
}

/// κσ from Σ P_n (κσ)^(n+1) = κE by Newton's method: first in `f64`, then two steps in double-double.
///
/// P_0 = 2 and P_n ≤ 0, so the sum is concave and at most 2κσ. From κE/2 the iteration therefore rises to the root and does not pass it.
fn invert_energy(polynomials: &[DoubleDouble], kappa_energy: DoubleDouble) -> DoubleDouble {
    let target = kappa_energy.to_f64();
    let mut s = 0.5 * target;
    // Convergence is quadratic from below. The bound allows for the slow first steps near the separatrix.
    for _ in 0..100 {
        let (value, slope) = value_and_slope(polynomials, s);
        if slope <= 0.0 {
            return s.into(); // a truncated sum has no root beyond its maximum
        }
        let step = (target - value * s) / slope;
        s += step;
        if step.abs() <= f64::EPSILON * s {
            break;
        }
    }
    let mut root = DoubleDouble::from(s);
    for _ in 0..2 {
        let (_, slope) = value_and_slope(polynomials, root.to_f64());
        if slope > 0.0 {
            let value = polynomials.iter().rev().fold(DoubleDouble::ZERO, |value, &p| value * root + p);
            root = root + (kappa_energy - value * root).over(slope);
        }
    }
    root
}

/// Σ P_n s^n, and the derivative of s Σ P_n s^n.
fn value_and_slope(polynomials: &[DoubleDouble], s: f64) -> (f64, f64) {
    let terms = polynomials.iter().enumerate().rev();
    terms.fold((0.0, 0.0), |(value, slope), (n, &p)| (value * s + p.high, slope * s + (n as f64 + 1.0) * p.high))
}

/// agm(√Q1, √Q2).
fn agm(invariants: &Invariants) -> DoubleDouble {
    // For A = B, Q1 is not computed as a difference.
    if invariants.difference == DoubleDouble::ZERO { invariants.cosine_squares[1].sqrt() } else { invariants.agm }
}

/// The means of a polhode that the trapezoidal rule over the nodes has to sum, if it has to sum any.
fn asked(invariants: &Invariants) -> Option<Means> {
    let Invariants { cosine_squares: squares, stretch, difference, .. } = *invariants;
    let count = if difference == DoubleDouble::ZERO { None } else { nodes(stretch.to_f64()) };
    count.map(|count| Means { squares, stretch, count })
}

/// ⟨1/(1+√Q)⟩_ℓ and ⟨1/(1+√Q)⟩_t of a polhode with 0 < Q1 ≤ Q2 or A = B, from the sums over the nodes if they were asked for.
fn means(invariants: &Invariants, sums: Option<[DoubleDouble; 2]>) -> [DoubleDouble; 2] {
    let agm = agm(invariants);
    if invariants.difference == DoubleDouble::ZERO {
        return [DoubleDouble::ONE / (DoubleDouble::ONE + agm); 2];
    }
    let [by_anomaly, by_time] = sums.unwrap_or_else(|| logarithmic(invariants.cosine_squares));
    [by_anomaly, by_time * agm]
}

/// ⟨1/(1+√Q)⟩_ℓ and ⟨1/(√Q(1+√Q))⟩_ℓ next to the separatrix, by the trapezoidal rule in t = ln tan ℓ.
///
/// dℓ = dt/(2 cosh t) and Q = (Q1 + Q2 e^2t)/(1 + e^2t). The integrands are analytic in |Im t| < π/2 for any Q1, and fall as e^(−|t|) outside the interval
/// between 0 and ln √(Q1/Q2). The nodes e^t = e^(first) e^(jh) are products, so only two exponentials are computed.
fn logarithmic([q1, q2]: [DoubleDouble; 2]) -> [DoubleDouble; 2] {
    let tail = 76.0;
    let first = 0.5 * (q1.to_f64() / q2.to_f64()).ln() - tail;
    let count = ((tail - first) / LOGARITHMIC_STEP).ceil() as usize;
    let growth = exponential_of_the_step();
    let mut tangent = DoubleDouble::from(first.exp());
    let (mut by_anomaly, mut by_time) = (DoubleDouble::ZERO, DoubleDouble::ZERO);
    for _ in 0..=count {
        let square = tangent * tangent;
        let weight = tangent / (DoubleDouble::ONE + square);
        let root = ((q1 + q2 * square) / (DoubleDouble::ONE + square)).sqrt();
        let term = weight / (DoubleDouble::ONE + root);
        by_anomaly = by_anomaly + term;
        by_time = by_time + term / root;
        tangent = tangent * growth;
    }
    // (2/π) ∫ dt h w with w = dℓ/dt = tan ℓ/(1 + tan² ℓ).
    let factor = DoubleDouble::from(2.0 * LOGARITHMIC_STEP) / DoubleDouble::PI;
    [by_anomaly * factor, by_time * factor]
}

/// e^(1/8) by its Taylor series.
fn exponential_of_the_step() -> DoubleDouble {
    let step = DoubleDouble::from(LOGARITHMIC_STEP);
    (1..=20_i32)
        .rev()
        .fold(DoubleDouble::ONE, |sum, k| DoubleDouble::ONE + sum * step / DoubleDouble::from(f64::from(k)))
}

#[cfg(test)]
mod tests {
    use andoyer_double::arithmetic_geometric_mean;
    use andoyer_series::NumericNormalForm;

    use super::*;
    use crate::{Body, State};

    /// ⟨1/(1+√Q)⟩_ℓ and ⟨1/(√Q(1+√Q))⟩_ℓ by either sum, and agm(√Q1, √Q2).
    fn sums([q1, q2]: [f64; 2], by_nodes: bool) -> ([DoubleDouble; 2], DoubleDouble) {
        let squares = [q1, q2].map(DoubleDouble::from);
        let [least, greatest] = squares.map(DoubleDouble::sqrt);
        let stretch = least / greatest;
        let found = if by_nodes {
            // 1e-6 takes more nodes than are kept in a table.
            let count = nodes(stretch.to_f64()).expect("few enough");
            let mut found = [[DoubleDouble::ZERO; 2]];
            trapezoidal(&[Means { squares, stretch, count }], &mut found);
            found[0]
        } else {
            logarithmic(squares)
        };
        (found, arithmetic_geometric_mean(least, greatest))
    }

    #[test]
    fn the_mean_of_one_over_the_cosine_is_one_over_the_agm_to_thirty_digits() {
        // ⟨1/√Q⟩_ℓ = 1/agm (Gauss). The identity 1/(√Q(1+√Q)) + 1/(1+√Q) = 1/√Q connects the two sums with it.
        for squares in [[0.9, 0.95], [0.3, 0.8], [0.01, 0.7], [1e-4, 0.5]] {
            let ([by_anomaly, by_time], agm) = sums(squares, true);
            let whole = (by_time + by_anomaly) * agm;
            assert!((whole - DoubleDouble::ONE).to_f64().abs() < 1e-28, "{squares:?}: {whole:?}");
        }
    }

    #[test]
    fn the_series_has_the_frequencies_of_the_quadrature_to_twenty_eight_digits_where_it_converges() {
        // σ/σ_sep is about 1e-2, so the truncation error at order 20 is 1e-40. In `f64` both rates were wrong by 1e-16, and phases by 1e-13 after 100
        // rotations.
        let body = Body::new([1.0, 1.5, 2.1]).expect("a body");
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.02, 0.01, 1.0]).expect("a state");
        let polhode = Polhode::new(&body, &state).expect("it turns");
        let beta = polhode.precise_beta();
        let polynomials = NumericNormalForm::new(beta, 20).expect("a β").triaxiality_polynomials();
        let (exact, series) = (Secular::exact(&polhode), Secular::truncated(&polhode, &polynomials));
        for (one, two) in [(exact.anomaly_rate, series.anomaly_rate), (exact.longitude_rate, series.longitude_rate)] {
            assert!(((one - two) / one).to_f64().abs() < 1e-28, "{one:?} {two:?}");
        }
    }

    #[test]
    fn both_sums_agree_to_twenty_eight_digits_where_both_converge() {
        for squares in [[0.9, 0.95], [0.3, 0.8], [1e-3, 0.7], [1e-6, 0.5]] {
            let ((a, _), (b, _)) = (sums(squares, true), sums(squares, false));
            assert!((a[0] - b[0]).to_f64().abs() < 1e-28 * a[0].high, "{squares:?}: {:?} {:?}", a[0], b[0]);
            assert!((a[1] - b[1]).to_f64().abs() < 1e-28 * a[1].high, "{squares:?}: {:?} {:?}", a[1], b[1]);
        }
    }

    #[test]
    fn the_sums_hold_down_to_the_separatrix() {
        // ⟨1/√Q⟩ = 1/agm again, now for Q1 → 0 where only the logarithmic sum converges.
        for q1 in [1e-8, 1e-16, 1e-100, 1e-280] {
            let ([by_anomaly, by_time], agm) = sums([q1, 0.5], false);
            let whole = (by_time + by_anomaly) * agm;
            assert!((whole - DoubleDouble::ONE).to_f64().abs() < 1e-28, "{q1}: {whole:?}");
        }
    }
}
