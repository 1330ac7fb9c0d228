//! Harmonics of driven phases in the exponents of a monomial, outside the triangle.
//!
//! The slot of a phase M holds one integer j of either sign, as the exponent 2j for j ≥ 0 and 2|j| − 1 for j < 0. A polynomial with real coefficients is in
//! cos jM for j ≥ 0 and sin |j|M for j < 0. A polynomial in complex variables is in e^{ijM}. Exponents of such slots do not add in a product:
//! cosines and sines have the rule of [`product`]. Inside the triangle j + s n is stored instead (`driven`), for which they add.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::{MAX_EXPONENT, Monomial};

/// The exponent that stores j.
pub(crate) fn folded(j: i64) -> u64 {
    2 * j.unsigned_abs() - u64::from(j < 0)
}

/// The j that an exponent stores.
pub(crate) const fn signed(exponent: u32) -> i64 {
    let half = exponent.div_ceil(2) as i64;
    if exponent.is_multiple_of(2) { half } else { -half }
}

/// `monomial` with the harmonic j in `slot`.
pub(crate) fn with(monomial: Monomial, slot: usize, j: i64) -> Result<Monomial, Error> {
    let exponent = folded(j);
    match u32::try_from(exponent) {
        Ok(exponent) => monomial.with(slot, exponent),
        Err(_) => Err(Error::ExponentOverflow { slot, exponent, bound: MAX_EXPONENT }),
    }
}

/// The product of two terms whose slots from `first` on hold cosines and sines: the monomials and their coefficients.
pub(crate) fn multiplied<C: Coefficient>(
    (m, a): (Monomial, &C),
    (n, b): (Monomial, &C),
    slots: std::ops::Range<usize>,
) -> Result<Vec<(Monomial, C)>, Error> {
    let mut c = a.clone();
    c *= b;
    let mut terms = vec![(m.without(slots.clone()).checked_mul(n.without(slots.clone()))?, c)];
    for slot in slots {
        let (harmonics, half) = product(signed(m.exponent(slot)), signed(n.exponent(slot)));
        let mut next = Vec::new();
        for (monomial, c) in terms {
            for &(j, sign) in &harmonics {
                let c = if half { c.times(sign).over(2).ok_or(Error::DivisionByZero)? } else { c.times(sign) };
                next.push((with(monomial, slot, j)?, c));
            }
        }
        terms = next;
    }
    Ok(terms)
}

/// The product of two harmonics as harmonics with signs, and whether their sum has the factor ½.
fn product(a: i64, b: i64) -> (Vec<(i64, i64)>, bool) {
    let (sum, difference) = (a.abs() + b.abs(), a.abs() - b.abs());
    match (a, b) {
        (0, other) | (other, 0) => (vec![(other, 1)], false),
        (1.., 1..) => (vec![(difference.abs(), 1), (sum, 1)], true),
        (..0, ..0) => (vec![(difference.abs(), 1), (sum, -1)], true),
        _ => {
            // sin s cos c = ½ sin(s + c) + ½ sin(s − c)
            let difference = if a < 0 { difference } else { -difference };
            let mut harmonics = vec![(-sum, 1)];
            if difference != 0 {
                harmonics.push((-difference.abs(), difference.signum()));
            }
            (harmonics, true)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_store_every_sign() {
        for j in -20..20 {
            assert_eq!(signed(folded(j) as u32), j);
        }
    }

    #[test]
    fn products_are_those_of_cosines_and_sines() -> Result<(), Error> {
        let value = |j: i64, angle: f64| if j < 0 { (-j as f64 * angle).sin() } else { (j as f64 * angle).cos() };
        for (a, b) in (-3..=3).flat_map(|a| (-3..=3).map(move |b| (a, b))) {
            let [left, right] = [a, b].map(|j| with(Monomial::ONE, 2, j));
            let terms = multiplied((left?, &1.0), (right?, &1.0), 2..3)?;
            let sum: f64 = terms.iter().map(|(m, c)| c * value(signed(m.exponent(2)), 0.7)).sum();
            assert!((sum - value(a, 0.7) * value(b, 0.7)).abs() < 1e-15, "{a}, {b}: {terms:?}");
        }
        Ok(())
    }
}
