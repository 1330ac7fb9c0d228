//! Two ways to sum the Fourier series of theory §8: four polynomials in cos 2ℓ′, or a rotation from one harmonic to the next.
//!
//! a e^(−iy′/2) = P0(cos 2ℓ′) + i sin 2ℓ′ P1(cos 2ℓ′) and b e^(−iy′/2) = cos ℓ′ P2(cos 2ℓ′) + i sin ℓ′ P3(cos 2ℓ′). The bases are T, U and the two half-angle
//! families of Chebyshev polynomials; all obey p_{k+1} = 2c p_k − p_{k−1}. In powers of c = cos 2ℓ′ each coefficient costs one multiplication and one addition.
//! Powers are used if their rounding error is not larger than that of the sum: Σ k|p_k| ≤ 2 for a pair of norm 1. This holds if the harmonics fall by a factor
//! of 0.3 or less. Otherwise e^(2iℓ′) leads from term to term, with ten operations for each.

use super::harmonics::CayleyKleinSeries;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// Largest number of terms for powers. With more terms the powers of 1 + √2 always exceed the bound.
const MOST_POWERS: usize = 16;
/// Largest Σ k|p_k| of a pair of norm 1 for which powers are as accurate as the harmonics.
const LARGEST_POWERS: f64 = 2.0;

/// The coefficients of the pair (a, b) e^(−iy′/2), by index k: real and imaginary part of a, then of b.
#[derive(Clone, Debug)]
pub(crate) enum Sums {
    /// Coefficients of cos^k 2ℓ′.
    Powers(Vec<[f64; 4]>),
    /// Coefficients of the harmonics.
    Harmonics(Vec<[f64; 4]>),
}

impl Sums {
    pub(crate) fn new(series: &CayleyKleinSeries) -> Self {
        match powers(series.terms()) {
            Some(powers) => Self::Powers(powers),
            None => Self::Harmonics(series.terms().iter().map(|(a, b)| [a[0], a[1], b[0], b[1]]).collect()),
        }
    }

    /// (Re a, Im a, Re b, Im b) of the pair at the ℓ′ with this sine and cosine.
    #[inline(always)]
    pub(crate) fn pair<S: InstructionSet>(&self, simd: S, sine: Lanes<S>, cosine: Lanes<S>) -> [Lanes<S>; 4] {
        let twice = sine + sine;
        let double_sine = twice * cosine;
        let double_cosine = twice.negate_mul_add(sine, sine.all(1.0));
        match self {
            Self::Powers(powers) => {
                let mut sums = [sine.all(0.0); 4];
                if let [rest @ .., last] = &powers[..] {
                    sums = Lanes::splats(simd, *last);
                    for coefficients in rest.iter().rev() {
                        for (sum, coefficient) in sums.iter_mut().zip(coefficients) {
                            *sum = sum.mul_add(double_cosine, sine.all(*coefficient));
                        }
                    }
                }
                [sums[0], sums[1] * double_sine, sums[2] * cosine, sums[3] * sine]
            }
            Self::Harmonics(harmonics) => {
                let [mut a, mut b, mut odd] = [[sine.all(0.0); 2]; 3];
                let [mut c, mut s] = [sine.all(1.0), sine.all(0.0)];
                for coefficients in harmonics {
                    let [p, q, u, v] = Lanes::splats(simd, *coefficients);
                    a = [p.mul_add(c, a[0]), q.mul_add(s, a[1])];
                    b = [u.mul_add(c, b[0]), v.mul_add(s, b[1])];
                    odd = [u.mul_add(s, odd[0]), v.mul_add(c, odd[1])];
                    (c, s) =
                        (s.negate_mul_add(double_sine, c * double_cosine), c.mul_add(double_sine, s * double_cosine));
                }
                let real = odd[0].negate_mul_add(sine, b[0] * cosine);
                let imaginary = odd[1].mul_add(sine, b[1] * cosine);
                [a[0], a[1], real, imaginary]
            }
        }
    }
}

/// The coefficients of the powers of c in T_k, U_{k−1}, V_k and W_k, by k, power and family. They are integers below 2^53.
static CHEBYSHEV: [[[f64; 4]; MOST_POWERS]; MOST_POWERS] = {
    let mut table = [[[0.0; 4]; MOST_POWERS]; MOST_POWERS];
    table[0][0] = [1.0, 0.0, 1.0, 1.0];
    table[1][0] = [0.0, 1.0, -1.0, 1.0];
    table[1][1] = [1.0, 0.0, 2.0, 2.0];
    let mut k = 2;
    while k < MOST_POWERS {
        let mut power = 0;
        while power <= k {
            let mut family = 0;
            while family < 4 {
                let raised = if power == 0 { 0.0 } else { 2.0 * table[k - 1][power - 1][family] };
                table[k][power][family] = raised - table[k - 2][power][family];
                family += 1;
            }
            power += 1;
        }
        k += 1;
    }
    table
};

/// The coefficients of the powers of c = cos 2ℓ′, or `None` if they are too large.
fn powers(harmonics: &[([f64; 2], [f64; 2])]) -> Option<Vec<[f64; 4]>> {
    let terms = harmonics.len();
    if terms > MOST_POWERS {
        return None;
    }
    let mut sums = [[0.0; 4]; MOST_POWERS];
    let mut norms = [0.0; 2];
    for (&(a, b), polynomials) in harmonics.iter().zip(&CHEBYSHEV) {
        let coefficients = [a[0], a[1], b[0], b[1]];
        for (sums, polynomial) in sums[..terms].iter_mut().zip(polynomials) {
            for family in 0..4 {
                sums[family] += coefficients[family] * polynomial[family];
            }
        }
        norms = [norms[0] + a[0], norms[1] + b[0]];
    }
    let powers = &sums[..terms];
    let square = norms[0] * norms[0] + norms[1] * norms[1];
    let weight: f64 = powers.iter().enumerate().map(|(k, c)| k as f64 * c.iter().map(|c| c.abs()).sum::<f64>()).sum();
    (weight <= LARGEST_POWERS * square.sqrt()).then(|| powers.to_vec())
}
