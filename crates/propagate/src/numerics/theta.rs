//! The periods and arguments of the theta functions of one polhode. [`crate::torque_free::invariants`] computes them in lanes.
//!
//! With m = k² = 1 − Q1/Q2 and 1 − m = k′² = Q1/Q2 from the polhode module, both computed without cancellation,
//!
//! ```text
//! K = π/(2 agm(1, k′))     K′ = π/(2 agm(1, k))     η = F(φ, k′),  tan φ = √(b/(a−b)),  a = C/A − 1,  b = C/B − 1
//! ```
//!
//! At iη, |cos J| = 1, and the elliptic functions 1 ± cos J have their zeros there (theory §10; Piña, arXiv:1505.06186). F is computed as Carlson's R_F (Numer.
//! Algorithms 10 (1995) 13) with positive arguments. Relative accuracy: a few 2^−53, for any k′ > 0.

use std::f64::consts::FRAC_PI_2;

use andoyer_double::{DoubleDouble, arithmetic_geometric_mean, carlson_rf};

/// K of a polhode with 0 < Q1, and the argument u of a state, counted from the maximum of cos J, 0 ≤ u ≤ K. Both are accurate to 1e-20 of K.
///
/// u = √Q2 ∫ dℓ/√Q for ℓ in the first quadrant. Near the middle axis u is forty radians. Rounded to a double, it would change the time of the passage by 1e-14.
pub(crate) fn precise_argument(
    cosine_squares: [DoubleDouble; 2],
    [cosine, sine]: [f64; 2],
) -> (DoubleDouble, DoubleDouble) {
    let [least, greatest] = cosine_squares.map(DoubleDouble::sqrt);
    let [cosine, sine] = [cosine, sine].map(DoubleDouble::from);
    let length = (cosine * cosine + sine * sine).sqrt();
    let (cosine, sine) = (cosine / length, sine / length);
    let (x, y) = (least * cosine, greatest * sine);
    let q = x * x + y * y;
    // K is infinite on the separatrix.
    let quarter = if least == DoubleDouble::ZERO {
        DoubleDouble::from(f64::INFINITY)
    } else {
        DoubleDouble::PI.times_double(0.5) / arithmetic_geometric_mean(DoubleDouble::ONE, least / greatest)
    };
    if y.high > x.high {
        (quarter, greatest * cosine * carlson_rf(y * y, q, greatest * greatest))
    } else {
        (quarter, quarter - greatest * sine * carlson_rf(x * x, q, least * least))
    }
}

/// Periods and arguments of the theta functions of one polhode with 0 < Q1 ≤ Q2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Theta {
    /// √Q1 and √Q2: the minimum and the maximum of cos J.
    pub(crate) cosines: [f64; 2],
    /// tan(J/2) at the minimum and at the maximum of cos J.
    pub(crate) half_tangents: [f64; 2],
    /// K, a quarter of the real period; infinite on the separatrix.
    pub(crate) quarter: f64,
    /// K′; infinite for A = B.
    pub(crate) conjugate: f64,
    /// η, 0 ≤ η ≤ K′.
    pub(crate) eta: f64,
    /// k′² = Q1/Q2.
    pub(crate) complement: f64,
    /// m = k²; 0 for A = B.
    pub(crate) parameter: f64,
}

impl Theta {
    /// The quantities for A = B, where the polhode is a circle, from the two cosines and half tangents.
    pub(crate) fn round(cosines: [f64; 2], half_tangents: [f64; 2]) -> Self {
        Self {
            cosines,
            half_tangents,
            quarter: FRAC_PI_2,
            conjugate: f64::INFINITY,
            eta: f64::INFINITY,
            complement: 1.0,
            parameter: 0.0,
        }
    }
}
