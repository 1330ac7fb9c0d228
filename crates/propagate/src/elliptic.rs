//! What the closed form needs of elliptic integrals, in `f64`: the theta quantities of one polhode.
//!
//! With m = k² = 1 − Q1/Q2 and 1 − m = k′² = Q1/Q2 of the polhode module, both without cancellation,
//!
//! ```text
//! K = π/(2 agm(1, k′))     K′ = π/(2 agm(1, k))     η = F(φ, k′),  tan φ = √(b/(a−b)),  a = C/A − 1,  b = C/B − 1
//! ```
//!
//! iη is where |cos J| = 1: there the elliptic function of 1 ± cos J that a and b are made of has its zeros (theory §10; Piña, arXiv:1505.06186). F is Carlson's
//! R_F (Numer. Algorithms 10 (1995) 13), whose arguments are all positive. Relative accuracy: a few 2^−53, at any k′ > 0.

use std::f64::consts::FRAC_PI_2;

use andoyer_series::{DoubleDouble, arithmetic_geometric_mean as double_mean};

use crate::polhode::Polhode;

/// The arithmetic-geometric mean of two numbers that are not negative, 0 if one is.
fn arithmetic_geometric_mean(mut a: f64, mut b: f64) -> f64 {
    if b == 0.0 {
        return 0.0;
    }
    // As for double-double: 15 steps at 1e-300.
    for _ in 0..24 {
        if (a - b).abs() <= 1e-8 * a {
            break; // the next mean is the limit to rounding
        }
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * (a + b)
}

/// Carlson's R_F(x, y, z) of numbers that are not negative, of which one at most is 0.
pub(crate) fn carlson(x: f64, y: f64, z: f64) -> f64 {
    let (mut x, mut y, mut z) = (x, y, z);
    // The spread falls by 4 a step, and from 1e300 it takes some twenty steps before that.
    for _ in 0..600 {
        let mean = (x + y + z) / 3.0;
        let spread = (x - mean).abs().max((y - mean).abs()).max((z - mean).abs());
        if spread <= 3e-3 * mean {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
    let mean = (x + y + z) / 3.0;
    (1.0 + beyond_one(1.0 - x / mean, 1.0 - y / mean)) / mean.sqrt()
}

/// Carlson's series for R_F times the root of the mean, less 1, through order 7 of the spread: what is left is below 3e-3^8.
fn beyond_one(u: f64, v: f64) -> f64 {
    let w = -(u + v);
    let (e2, e3) = (u * v - w * w, u * v * w);
    -e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0 - 5.0 * e2 * e2 * e2 / 208.0
        + 3.0 * e3 * e3 / 104.0
        + e2 * e2 * e3 / 16.0
}

/// R_F to 1e-20 of itself, for a distance along the polhode that is many times a radian.
fn carlson_to_twenty_digits(mut x: DoubleDouble, mut y: DoubleDouble, mut z: DoubleDouble) -> DoubleDouble {
    let mut mean = (x + y + z).over(3.0);
    for _ in 0..600 {
        let spread = [x, y, z].map(|value| (value.high - mean.high).abs()).into_iter().fold(0.0, f64::max);
        if spread <= 3e-3 * mean.high {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        [x, y, z] = [x, y, z].map(|value| (value + lambda).times_double(0.25));
        mean = (x + y + z).over(3.0);
    }
    let [u, v] = [x, y].map(|value| ((mean - value) / mean).to_f64());
    DoubleDouble::sum(1.0, beyond_one(u, v)) / mean.sqrt()
}

/// K of one polhode with 0 < Q1, and u of a state from where cos J is greatest, 0 ≤ u ≤ K, to 1e-20 of K.
///
/// Both are as in [`Theta::argument`]. A double u of forty radians beside the middle axis would be wrong by 1e-14, and so would the time of the passage.
pub(crate) fn precise_argument(polhode: &Polhode, [cosine, sine]: [f64; 2]) -> (DoubleDouble, DoubleDouble) {
    let [least, greatest] = polhode.cosine_squares().map(DoubleDouble::sqrt);
    let [cosine, sine] = [cosine, sine].map(DoubleDouble::from);
    let length = (cosine * cosine + sine * sine).sqrt();
    let (cosine, sine) = (cosine / length, sine / length);
    let (x, y) = (least * cosine, greatest * sine);
    let q = x * x + y * y;
    // Without end, where it is not that of a number.
    let quarter = if least == DoubleDouble::ZERO {
        DoubleDouble::from(f64::INFINITY)
    } else {
        DoubleDouble::PI.times_double(0.5) / double_mean(DoubleDouble::ONE, least / greatest)
    };
    if y.high > x.high {
        (quarter, greatest * cosine * carlson_to_twenty_digits(y * y, q, greatest * greatest))
    } else {
        (quarter, quarter - greatest * sine * carlson_to_twenty_digits(x * x, q, least * least))
    }
}

/// Periods and arguments of the theta functions of one polhode with 0 < Q1 ≤ Q2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Theta {
    /// √Q1 and √Q2: cos J where it is least and where it is greatest.
    pub(crate) cosines: [f64; 2],
    /// tan(J/2) at the same two places.
    pub(crate) half_tangents: [f64; 2],
    /// K, a quarter of the real period; infinite on the separatrix.
    pub(crate) quarter: f64,
    /// K′; infinite for A = B.
    pub(crate) conjugate: f64,
    /// η, 0 ≤ η ≤ K′.
    pub(crate) eta: f64,
    /// k′² = Q1/Q2.
    pub(crate) complement: f64,
}

impl Theta {
    pub(crate) fn new(polhode: &Polhode) -> Self {
        let [first, second] = polhode.excesses;
        let cosine_squares = polhode.cosine_squares();
        let roots = cosine_squares.map(|q| q.to_f64().max(0.0).sqrt());
        let sines = polhode.sine_squares().map(|s| s.to_f64().sqrt());
        let modulus = polhode.parameter();
        let conjugate = FRAC_PI_2 / arithmetic_geometric_mean(1.0, modulus.sqrt().min(1.0));
        let sine = (second / first).to_f64();
        let cosine = (polhode.difference / first).to_f64();
        let eta = if cosine == 0.0 { conjugate } else { sine.sqrt() * carlson(cosine, cosine + modulus * sine, 1.0) };
        // A round body may turn about an axis across its own: Q1 = Q2 = 0.
        let round = polhode.difference == DoubleDouble::ZERO;
        let ratio = if round { 1.0 } else { (roots[0] / roots[1]).min(1.0) };
        Self {
            cosines: roots,
            half_tangents: [sines[0] / (1.0 + roots[0]), sines[1] / (1.0 + roots[1])],
            quarter: FRAC_PI_2 / arithmetic_geometric_mean(1.0, ratio),
            conjugate,
            eta,
            complement: if round { 1.0 } else { (cosine_squares[0] / cosine_squares[1]).to_f64() },
        }
    }

    /// u of a state along the polhode, from the nearer of the two places where cos J is extremal: whether that is where it is greatest, and the distance.
    ///
    /// u = √Q2 ∫ dℓ/√Q from ℓ = 0, or from ℓ = π/2 back, for ℓ in the first quadrant.
    pub(crate) fn argument(&self, [cosine, sine]: [f64; 2]) -> (bool, f64) {
        let [least, greatest] = self.cosines;
        let (x, y) = (least * cosine, greatest * sine);
        let q = x * x + y * y;
        // Both degenerate only where Q1 = 0, at ℓ = 0.
        if y > x {
            (true, greatest * cosine * carlson(y * y, q, greatest * greatest))
        } else {
            (false, greatest * sine * carlson(x * x, q, least * least))
        }
    }
}

/// (cos ℓ, sin ℓ) of a state, in the first quadrant, and the signs that were taken out (theory §1: G2 ~ cos ℓ, −G1 ~ sin ℓ).
pub(crate) fn quadrant(polhode: &Polhode) -> ([f64; 2], [f64; 2]) {
    let [g1, g2, _] = polhode.direction;
    let [first, second]: [DoubleDouble; 2] = polhode.excesses;
    let (cosine, sine) = (g2, -g1 * (first / second).to_f64().sqrt());
    // Scaled first: squares of a small wobble have no double.
    let largest = cosine.abs().max(sine.abs());
    let (x, y) = (cosine.abs() / largest, sine.abs() / largest);
    let length = x.hypot(y);
    ([x / length, y / length], [1.0_f64.copysign(cosine), 1.0_f64.copysign(sine)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carlson_is_the_lemniscate_constant_and_the_elementary_integrals() {
        // R_F(0, 1, 2) = 1.31102877714605990523…, R_F(x, x, x) = 1/√x, R_F(0, 1, 1) = π/2; and a logarithm at a vast spread.
        assert!((carlson(0.0, 1.0, 2.0) - 1.311_028_777_146_06).abs() < 4e-16);
        assert!((carlson(4.0, 4.0, 4.0) - 0.5).abs() < 1e-16);
        assert!((carlson(0.0, 1.0, 1.0) - FRAC_PI_2).abs() < 4e-16);
        // R_F(x, x, 1) = ln((1 + √(1−x))/√x)/√(1−x).
        let tiny = 1e-200;
        assert!((carlson(tiny, tiny, 1.0) / (2.0 / tiny.sqrt()).ln() - 1.0).abs() < 4e-16);
    }

    #[test]
    fn twenty_digits_of_carlson_are_the_logarithm_and_those_of_the_duplication_theorem() {
        // R_F(x, x, 1) = artanh √(1−x)/√(1−x): 1.31695789692481670862… = arcosh 2 at x = ¼, times 2/√3.
        let [quarter, one] = [0.25, 1.0].map(DoubleDouble::from);
        let exact = DoubleDouble { high: 1.316_957_896_924_816_7, low: 0.0 } * DoubleDouble::from(2.0)
            / DoubleDouble::from(3.0).sqrt();
        assert!((carlson_to_twenty_digits(quarter, quarter, one) - exact).to_f64().abs() < 2e-16);
        for arguments in [[0.3, 0.7, 1.9], [1e-9, 0.2, 1.0], [1e-280, 1e-100, 1.0]] {
            let [x, y, z] = arguments.map(DoubleDouble::from);
            let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
            let lambda = rx * ry + ry * rz + rz * rx;
            let value = carlson_to_twenty_digits(x, y, z);
            let doubled = carlson_to_twenty_digits(x + lambda, y + lambda, z + lambda).times_double(2.0);
            assert!(((value - doubled) / value).to_f64().abs() < 2e-20, "{arguments:?}");
            let [x, y, z] = arguments;
            assert!((carlson(x, y, z) / value.to_f64() - 1.0).abs() < 1e-15, "{arguments:?}");
        }
    }

    #[test]
    fn carlson_doubles_its_argument_by_the_duplication_theorem() {
        for (x, y, z) in [(0.3_f64, 0.7_f64, 1.9_f64), (1e-9, 0.2, 1.0), (1e-30, 1e-10, 1.0)] {
            let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
            let doubled = 2.0 * carlson(x + lambda, y + lambda, z + lambda);
            assert!((carlson(x, y, z) / doubled - 1.0).abs() < 6e-16);
        }
    }
}
