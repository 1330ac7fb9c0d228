//! Jacobi's functions at given mean phases, by the descending arithmetic-geometric mean.
//!
//! The argument is 2Kℓ/π. The mean multiplies it by π/2K, so sines and cosines of ℓ itself start the ascent: no sine is computed when the modulus changes.

use std::f64::consts::PI;

/// The arithmetic-geometric mean of 1 and k′.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    /// Arithmetic and geometric mean of each level.
    levels: [(f64, f64); LEVELS],
    used: usize,
    /// π/2K.
    pub(super) mean: f64,
    /// E/K.
    pub(super) ratio: f64,
}

/// Convergence is quadratic: k′ = 1e-16 takes seven levels.
const LEVELS: usize = 12;

impl Scale {
    /// For the parameter k² and its complement k′² > 0.
    pub(super) fn new(parameter: f64, complement: f64) -> Self {
        let mut scale = Self { levels: [(0.0, 0.0); LEVELS], used: 0, mean: 1.0, ratio: 1.0 };
        let (mut a, mut b, mut twice) = (1.0, complement.sqrt(), 0.5);
        // E/K = 1 − Σ 2^(n−1) c_n², c_0² = k²
        let mut square = parameter;
        while scale.used < LEVELS {
            scale.ratio -= twice * square;
            scale.levels[scale.used] = (a, b);
            scale.used += 1;
            let half = 0.5 * (a - b);
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
            (square, twice) = (half * half, 2.0 * twice);
            if half <= 1e-9 * a {
                scale.ratio -= twice * square;
                break;
            }
        }
        scale.mean = a;
        scale
    }

    /// The phase ℓ of an amplitude: πF/2K.
    pub(super) fn mean_phase(&self, amplitude: f64) -> f64 {
        let mut angle = amplitude;
        for (arithmetic, geometric) in &self.levels[..self.used] {
            // tan(φ_(n+1) − φ_n) = (b_n/a_n) tan φ_n, on the branch of φ_n
            let turns = (angle / PI).round();
            angle += (geometric / arithmetic * (angle - PI * turns).tan()).atan() + PI * turns;
        }
        angle / f64::from(1_u32 << self.used)
    }

    /// sn, cn and dn at the phase ℓ ≠ 0 with this sine and cosine (Bulirsch's form of Landen's transformation).
    pub(super) fn functions(&self, (sine, cosine): (f64, f64)) -> [f64; 3] {
        let mut a = cosine / sine;
        let (mut c, mut dn) = (self.mean * a, 1.0);
        for (arithmetic, geometric) in self.levels[..self.used].iter().rev() {
            a *= c;
            c *= dn;
            dn = (geometric + a) / (arithmetic + a);
            a = c / arithmetic;
        }
        let sn = (1.0 / (c * c + 1.0).sqrt()).copysign(sine);
        [sn, c * sn, dn]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn phase_of_an_amplitude_inverts_the_functions() {
        let scale = Scale::new(0.9, 0.1);
        for phase in [-3.0_f64, -2.0, -1.0, 0.3, 1.5, 1.7, 3.1] {
            let [sn, cn, _] = scale.functions(phase.sin_cos());
            assert!((scale.mean_phase(sn.atan2(cn)) - phase).abs() < 1e-14);
        }
    }

    /// mpmath, 30 digits: ellipfun of 2K·0.3/π, and E/K, for k² = 0.6 and 0.999.
    #[test]
    fn functions_and_ratio_are_those_of_forty_digits() {
        for (m, expected) in MPMATH {
            let scale = Scale::new(m, 1.0 - m);
            let found = scale.functions(0.3_f64.sin_cos());
            for (found, expected) in found.into_iter().chain([scale.ratio, FRAC_PI_2 / scale.mean]).zip(expected) {
                assert!((found - expected).abs() < 2e-15 * expected.abs(), "{found} {expected}");
            }
        }
    }

    const MPMATH: [(f64, [f64; 5]); 2] = [
        (0.6, [0.3591320316761662, 0.9332867639820834, 0.9605282454433547, 0.6660081626689308, 1.9495677498060258]),
        (0.999, [0.7281341439179151, 0.6854346565945764, 0.6858212943562367, 0.20701164000362085, 4.841132560550297]),
    ];
}
