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
        let harmonics: Vec<[f64; 4]> = series.terms().iter().map(|(a, b)| [a[0], a[1], b[0], b[1]]).collect();
        match powers(&harmonics) {
            Some(powers) => Self::Powers(powers),
            None => Self::Harmonics(harmonics),
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

/// The coefficients of the powers of c = cos 2ℓ′, or `None` if they are too large.
fn powers(harmonics: &[[f64; 4]]) -> Option<Vec<[f64; 4]>> {
    let terms = harmonics.len();
    if terms > MOST_POWERS {
        return None;
    }
    // The current and the previous polynomials T_k, U_{k−1}, V_k and W_k, as coefficients of powers.
    let mut current = [[0.0; MOST_POWERS]; 4];
    let mut before = [[0.0; MOST_POWERS]; 4];
    let mut powers = vec![[0.0; 4]; terms];
    for (k, coefficients) in harmonics.iter().enumerate() {
        match k {
            0 => (current[0][0], current[2][0], current[3][0]) = (1.0, 1.0, 1.0),
            1 => {
                before = current;
                current = [[0.0; MOST_POWERS]; 4];
                (current[0][1], current[1][0]) = (1.0, 1.0);
                (current[2][0], current[2][1], current[3][0], current[3][1]) = (-1.0, 2.0, 1.0, 2.0);
            }
            _ => {
                for family in 0..4 {
                    let mut next = before[family].map(|p| -p);
                    for power in 1..terms {
                        next[power] += 2.0 * current[family][power - 1];
                    }
                    (before[family], current[family]) = (current[family], next);
                }
            }
        }
        for (power, sums) in powers.iter_mut().enumerate() {
            for family in 0..4 {
                sums[family] += coefficients[family] * current[family][power];
            }
        }
    }
    let square: f64 = (0..4).step_by(2).map(|f| harmonics.iter().map(|c| c[f]).sum::<f64>().powi(2)).sum();
    let weight: f64 = powers.iter().enumerate().map(|(k, c)| k as f64 * c.iter().map(|c| c.abs()).sum::<f64>()).sum();
    (weight <= LARGEST_POWERS * square.sqrt()).then_some(powers)
}
