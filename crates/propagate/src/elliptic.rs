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

use andoyer_series::DoubleDouble;

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
    let (u, v) = (1.0 - x / mean, 1.0 - y / mean);
    let w = -(u + v);
    let (e2, e3) = (u * v - w * w, u * v * w);
    // Carlson's series through order 7 of the spread: what is left is below 3e-3^8.
    let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0 - 5.0 * e2 * e2 * e2 / 208.0
        + 3.0 * e3 * e3 / 104.0
        + e2 * e2 * e3 / 16.0;
    series / mean.sqrt()
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
        let modulus = if polhode.difference == DoubleDouble::ZERO {
            0.0
        } else {
            (polhode.spread() / cosine_squares[1]).to_f64()
        };
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
    fn carlson_doubles_its_argument_by_the_duplication_theorem() {
        for (x, y, z) in [(0.3_f64, 0.7_f64, 1.9_f64), (1e-9, 0.2, 1.0), (1e-30, 1e-10, 1.0)] {
            let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
            let doubled = 2.0 * carlson(x + lambda, y + lambda, z + lambda);
            assert!((carlson(x, y, z) / doubled - 1.0).abs() < 6e-16);
        }
    }
}
