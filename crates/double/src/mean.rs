//! Gauss's arithmetic-geometric mean.

use crate::real::Real;

/// The arithmetic-geometric mean of two numbers a, b ≥ 0 that are not both 0. The result is 0 if `b` is 0.
///
/// Gauss: (1/2π) ∮ dφ/√(a² cos²φ + b² sin²φ) = 1/agm(a, b). The relative error is below 8·2^−53 in `f64` (at most 6.2·2^−53 in eight million random pairs) and
/// 2^−99 in double-double, for b/a down to 1e-300.
///
/// ```
/// use andoyer_double::arithmetic_geometric_mean;
/// assert!((1.0 / arithmetic_geometric_mean(1.0, 2.0_f64.sqrt()) - 0.834_626_841_674_073_2).abs() < 4e-16); // Gauss's constant
/// ```
#[must_use]
pub fn arithmetic_geometric_mean<R: Real>(mut a: R, mut b: R) -> R {
    if b.to_f64() == 0.0 {
        return R::from(0.0);
    }
    // A step halves the logarithm of b/a until b/a is near 1, and then doubles the number of correct digits: 1e-300 takes 15 steps.
    for _ in 0..24 {
        if (a.to_f64() - b.to_f64()).abs() <= R::EQUAL_MEANS * a.to_f64() {
            break;
        }
        (a, b) = ((a + b).times_double(0.5), (a * b).sqrt());
    }
    (a + b).times_double(0.5)
}
