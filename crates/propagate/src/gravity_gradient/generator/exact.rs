//! Terms whose divisors are exact in the orbit's harmonics.
//!
//! Where the orbit is not much slower than a term, the sum over time derivatives for G ends before it is accurate. With g = Σ g_j e^(ijl) in the mean anomaly l,
//!
//! ```text
//! G = Σ_j g_j e^(ijl)/(i(Ω + jn)) = (E + iO)/(iΩ)          Ω² ∂G/∂Ω = −(E₁ + iO₁)/i
//! ```
//!
//! With r_± = 1/(Ω ± jn), the coefficients of E and E₁ are Ω(r₊ + r₋) and Ω²(r₊² + r₋²), and those of O and O₁ have differences for the sums. For an even g, E is
//! a series in cos jl and O one in sin jl. So E and O take the places of the even and of the odd time derivatives. The harmonic nearest to resonance may
//! be left out (`selection`).

use crate::gravity_gradient::orbit_series::OrbitSeries;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

use super::{ComplexLanes, Harmonic};

/// E, O, E₁ and O₁.
pub(super) const PARTS: usize = 4;
/// From this xT/2 on, a harmonic with the divisor x returns within the time T: e^(−x²T²/4) is below rounding.
const RETURNS: f64 = 6.1;

/// Whether a harmonic with this divisor returns within the span.
pub(crate) fn returns(divisor: f64, duration: f64) -> bool {
    0.5 * (divisor * duration).abs() > RETURNS
}

/// One term.
#[derive(Clone, Debug)]
pub(crate) struct ExactTerm {
    /// h and m.
    pub(crate) numbers: (i32, i32),
    /// The harmonic of the orbit that is left out.
    pub(crate) left_out: Option<i32>,
    /// The factors of its parts.
    pub(super) harmonic: [Harmonic; 1],
    /// The coefficients of (a/r)³ times 1, cos 2f and sin 2f, by j, function and part.
    coefficients: Vec<[[f64; PARTS]; 3]>,
}

impl ExactTerm {
    /// The term with these h and m, its factors, its Ω, the series with n and with the harmonic that is left out. Coefficients below `negligible` are dropped.
    pub(crate) fn new(
        numbers: (i32, i32),
        harmonic: Harmonic,
        frequency: f64,
        (series, mean_motion, left_out): (&OrbitSeries, f64, Option<i32>),
        negligible: f64,
    ) -> Self {
        let reciprocal = |j: i32| {
            if left_out == Some(j) { 0.0 } else { frequency / (frequency + f64::from(j) * mean_motion) }
        };
        let mut coefficients: Vec<_> = (0..)
            .zip(&series.coefficients)
            .map(|(j, [one, cosine, sine])| {
                let (after, before) = (reciprocal(j), reciprocal(-j));
                // For j = 0 both harmonics are one.
                let share = if j == 0 { 0.5 } else { 1.0 };
                let [sum, difference] = [after + before, after - before].map(|part| share * part);
                let [square_sum, square_difference] =
                    [sum * sum + difference * difference, 2.0 * sum * difference].map(|square| 0.5 * square / share);
                let even = |g: f64| [g * sum, g * difference, g * square_sum, g * square_difference];
                let odd = |g: f64| [g * sum, -g * difference, g * square_sum, -g * square_difference];
                [even(*one), even(*cosine), odd(*sine)]
            })
            .collect();
        let something = |terms: &[[f64; PARTS]; 3]| terms.iter().flatten().any(|c| c.abs() > negligible);
        coefficients.truncate(coefficients.iter().rposition(something).map_or(0, |last| last + 1));
        Self { numbers, left_out, harmonic: [harmonic], coefficients }
    }

    /// The parts of the three functions at a mean anomaly, which is given by its cosine and sine.
    #[inline(always)]
    pub(super) fn parts<S: InstructionSet>(&self, anomaly: ComplexLanes<S>) -> [[Lanes<S>; 3]; PARTS] {
        let none = anomaly.re.all(0.0);
        let mut parts = [[none; 3]; PARTS];
        let mut turn = ComplexLanes { re: none.all(1.0), im: none };
        for functions in &self.coefficients {
            for (function, coefficients) in functions.iter().enumerate() {
                for (part, coefficient) in coefficients.iter().enumerate() {
                    let wave = if (part % 2 == 0) == (function < 2) { turn.re } else { turn.im };
                    parts[part][function] = wave.mul_add(none.all(*coefficient), parts[part][function]);
                }
            }
            turn = turn * anomaly;
        }
        parts
    }
}
