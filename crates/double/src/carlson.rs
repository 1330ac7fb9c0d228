//! Carlson's symmetric elliptic integral of the first kind (Numer. Algorithms 10 (1995) 13).

use crate::real::Real;

/// Relative spread of the arguments, max |argument − mean|/mean, below which the series is summed.
const SPREAD: f64 = 3e-3;

/// R_F(x, y, z) = ½ ∫₀^∞ dt/√((t+x)(t+y)(t+z)) for arguments ≥ 0, of which at most one is 0.
///
/// The duplication theorem makes the arguments nearly equal. A series in their spread then gives the value. The relative error is below 6·2^−53 in `f64`. In
/// double-double it is below 2e-20, because the series is summed in doubles and truncated at 3e-3^8.
///
/// ```
/// use andoyer_double::carlson_rf;
/// assert!((carlson_rf(0.0, 1.0, 2.0) - 1.311_028_777_146_06).abs() < 4e-16); // half the lemniscate constant
/// ```
#[must_use]
pub fn carlson_rf<R: Real>(mut x: R, mut y: R, mut z: R) -> R {
    let mut mean = (x + y + z).over(3.0);
    // Each step divides the spread by 4. From a ratio of 1e300 about twenty steps come before that.
    for _ in 0..600 {
        let middle = mean.to_f64();
        let [u, v, w] = [x, y, z].map(|value| (value.to_f64() - middle).abs());
        if u.max(v).max(w) <= SPREAD * middle {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        [x, y, z] = [x, y, z].map(|value| (value + lambda).times_double(0.25));
        mean = (x + y + z).over(3.0);
    }
    let [u, v] = [x, y].map(|value| ((mean - value) / mean).to_f64());
    (R::from(1.0) + R::from(beyond_one(u, v))) / mean.sqrt()
}

/// Carlson's series for R_F times the square root of the mean, minus 1, through order 7 in the spread.
fn beyond_one(u: f64, v: f64) -> f64 {
    let w = -(u + v);
    let (e2, e3) = (u * v - w * w, u * v * w);
    -e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0 - 5.0 * e2 * e2 * e2 / 208.0
        + 3.0 * e3 * e3 / 104.0
        + e2 * e2 * e3 / 16.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::double_double::DoubleDouble;

    #[test]
    fn carlson_is_the_lemniscate_constant_and_the_elementary_integrals() {
        // R_F(0, 1, 2) = 1.31102877714605990523…, R_F(x, x, x) = 1/√x, R_F(0, 1, 1) = π/2; the last case is a logarithm at a very large spread.
        assert!((carlson_rf(0.0, 1.0, 2.0) - 1.311_028_777_146_06).abs() < 4e-16);
        assert!((carlson_rf(4.0, 4.0, 4.0) - 0.5).abs() < 1e-16);
        assert!((carlson_rf(0.0, 1.0, 1.0) - FRAC_PI_2).abs() < 4e-16);
        // R_F(x, x, 1) = ln((1 + √(1−x))/√x)/√(1−x).
        let tiny = 1e-200;
        assert!((carlson_rf(tiny, tiny, 1.0) / (2.0 / tiny.sqrt()).ln() - 1.0).abs() < 4e-16);
    }

    #[test]
    fn twenty_digits_of_carlson_are_the_logarithm_and_those_of_the_duplication_theorem() {
        // R_F(x, x, 1) = artanh √(1−x)/√(1−x): 1.31695789692481670862… = arcosh 2 at x = ¼, times 2/√3.
        let [quarter, one] = [0.25, 1.0].map(DoubleDouble::from);
        let exact = DoubleDouble { high: 1.316_957_896_924_816_7, low: 0.0 } * DoubleDouble::from(2.0)
            / DoubleDouble::from(3.0).sqrt();
        assert!((carlson_rf(quarter, quarter, one) - exact).to_f64().abs() < 2e-16);
        for arguments in [[0.3, 0.7, 1.9], [1e-9, 0.2, 1.0], [1e-280, 1e-100, 1.0]] {
            let [x, y, z] = arguments.map(DoubleDouble::from);
            let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
            let lambda = rx * ry + ry * rz + rz * rx;
            let value = carlson_rf(x, y, z);
            let doubled = carlson_rf(x + lambda, y + lambda, z + lambda).times_double(2.0);
            assert!(((value - doubled) / value).to_f64().abs() < 2e-20, "{arguments:?}");
            let [x, y, z] = arguments;
            assert!((carlson_rf(x, y, z) / value.to_f64() - 1.0).abs() < 1e-15, "{arguments:?}");
        }
    }

    #[test]
    fn carlson_doubles_its_argument_by_the_duplication_theorem() {
        for (x, y, z) in [(0.3_f64, 0.7_f64, 1.9_f64), (1e-9, 0.2, 1.0), (1e-30, 1e-10, 1.0)] {
            let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
            let doubled = 2.0 * carlson_rf(x + lambda, y + lambda, z + lambda);
            assert!((carlson_rf(x, y, z) / doubled - 1.0).abs() < 6e-16);
        }
    }
}
