//! The quaternion of theory §8 as two real-coefficient Fourier series in ℓ′, and their evaluation.
//!
//! a e^(−iy′/2) = √(1−z/2) e^(iδ/2) and b e^(−iy′/2) = (ζ/2) e^(iδ/2), with ζ = (X + ix)/√M, z = |ζ|²/2 and δ = y − y′.
//! Time reversal (ℓ′ → −ℓ′) conjugates both, so every coefficient is real. ℓ′ → ℓ′ + π keeps a and changes the sign of b, so a has the even harmonics and b the
//! odd ones. A quarter period of samples therefore gives all coefficients by the trapezoidal rule.

use num_complex::Complex;

/// A harmonic that turns the attitude by less than this is a rounding error of the samples \[rad\].
const NOISE: f64 = 6e-16;

/// Cosine and sine coefficient of one harmonic.
type Pair = [f64; 2];

/// a e^(−iy′/2) = Σ c_k cos 2kℓ′ + i d_k sin 2kℓ′, and b e^(−iy′/2) with the harmonics 2k + 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CayleyKleinSeries {
    /// (c_k, d_k) of a and of b.
    terms: Vec<(Pair, Pair)>,
}

impl CayleyKleinSeries {
    /// The series with the terms (c_k, d_k) of a and of b. Evaluation normalizes the result, so the norm of the terms need not be 1.
    pub(crate) fn from_terms(terms: Vec<(Pair, Pair)>) -> Self {
        Self { terms }
    }

    /// Drops the highest harmonics while they turn the attitude by less than `budget` \[rad\] together. Returns the series and the dropped angle.
    ///
    /// The fundamental is always kept, because a small wobble has no other harmonic.
    pub(crate) fn truncated(mut self, budget: f64) -> (Self, f64) {
        let mut dropped = 0.0;
        while let [_, .., (even, odd)] = self.terms[..] {
            // An error of a or b turns the attitude by twice its size.
            let size = 2.0 * (even[0].abs().max(even[1].abs()) + odd[0].abs().max(odd[1].abs()));
            if size <= NOISE {
                dropped = NOISE; // not the sum: these harmonics are noise, and their true sum is smaller than this
            } else if dropped + size <= budget {
                dropped += size;
            } else {
                break;
            }
            self.terms.pop();
        }
        (self, dropped)
    }

    /// (c_k, d_k) of a and of b.
    pub(crate) fn terms(&self) -> &[(Pair, Pair)] {
        &self.terms
    }

    /// a e^(−iy′/2) and b e^(−iy′/2) at ℓ′, normalized.
    pub(crate) fn pair(&self, angle: f64) -> [Complex<f64>; 2] {
        let (mut a, mut b) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
        // e^(iℓ′), and e^(2ikℓ′) by rotation from one harmonic to the next.
        let single = Complex::cis(angle);
        let double = single * single;
        let mut even_turn = Complex::new(1.0, 0.0);
        for (even, odd) in &self.terms {
            let odd_turn = even_turn * single;
            a += Complex::new(even[0] * even_turn.re, even[1] * even_turn.im);
            b += Complex::new(odd[0] * odd_turn.re, odd[1] * odd_turn.im);
            even_turn *= double;
        }
        let scale = (a.norm_sqr() + b.norm_sqr()).sqrt().recip();
        [a * scale, b * scale]
    }

    /// The highest multiple of ℓ′ that is evaluated.
    pub(crate) fn harmonics(&self) -> usize {
        2 * self.terms.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::CayleyKleinSeries;

    #[test]
    fn a_dropped_harmonic_turns_the_attitude_by_twice_the_sizes_of_both_parameters() {
        let terms = vec![([1.0, 0.0], [0.1, 0.0]), ([1e-5, -2e-5], [4e-5, 3e-5])];
        let truncated = |budget: f64| CayleyKleinSeries::from_terms(terms.clone()).truncated(budget);
        let (kept, nothing) = truncated(1.19e-4);
        assert_eq!((kept.terms().len(), nothing), (2, 0.0));
        let (kept, dropped) = truncated(1.21e-4);
        assert_eq!(kept.terms().len(), 1);
        assert!((dropped - 1.2e-4).abs() <= 1e-18, "{dropped:e}");
    }
}
