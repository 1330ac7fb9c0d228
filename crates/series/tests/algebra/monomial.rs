//! Packed monomials: products add exponents, and what does not fit is an error.

use andoyer_series::{Error, MAX_EXPONENT, Monomial, Polynomial, SLOTS};
use proptest::prelude::*;

proptest! {
    #[test]
    fn a_product_adds_exponents_or_reports_the_slot_that_overflows(
        a in prop::array::uniform8(0..=MAX_EXPONENT),
        b in prop::array::uniform8(0..=MAX_EXPONENT),
    ) {
        let sums: Vec<u32> = a.iter().zip(&b).map(|(x, y)| x + y).collect();
        match Monomial::new(&a)?.checked_mul(Monomial::new(&b)?) {
            Ok(product) => prop_assert_eq!(product.exponents().to_vec(), sums),
            Err(Error::ExponentOverflow { slot, exponent, .. }) => {
                prop_assert!(sums[slot] > MAX_EXPONENT);
                prop_assert_eq!(exponent, u64::from(sums[slot]));
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    #[test]
    fn the_order_is_graded_then_lexicographic(a in prop::array::uniform8(0_u32..3), b in prop::array::uniform8(0_u32..3)) {
        let expected = a.iter().sum::<u32>().cmp(&b.iter().sum()).then_with(|| b.cmp(&a));
        prop_assert_eq!(Monomial::new(&a)?.cmp(&Monomial::new(&b)?), expected);
    }
}

#[test]
fn the_largest_exponent_fits_every_slot_and_the_next_does_not() -> Result<(), Error> {
    for slot in 0..SLOTS {
        let largest = Monomial::ONE.with(slot, MAX_EXPONENT)?;
        assert_eq!((largest.exponent(slot), largest.total_degree()), (MAX_EXPONENT, MAX_EXPONENT));
        assert!(
            matches!(Monomial::ONE.with(slot, MAX_EXPONENT + 1), Err(Error::ExponentOverflow { slot: s, .. }) if s == slot)
        );
        let over = largest.checked_mul(Monomial::ONE.with(slot, 1)?);
        assert!(matches!(over, Err(Error::ExponentOverflow { slot: s, exponent: 32768, bound: 32767 }) if s == slot));
    }
    Ok(())
}

#[test]
fn polynomials_report_the_overflow_too() -> Result<(), Error> {
    let large = Polynomial::from_terms([(Monomial::new(&[20_000])?, 1.0)]);
    assert!(matches!(large.multiply(&large), Err(Error::ExponentOverflow { slot: 0, exponent: 40_000, .. })));
    assert!(matches!(Polynomial::<f64>::variable(0)?.power(32_768), Err(Error::ExponentOverflow { .. })));
    assert_eq!(Polynomial::<f64>::variable(7)?.power(32_767)?.degree(), Some(32_767));
    Ok(())
}

#[test]
fn degrees_and_slots_are_those_given() -> Result<(), Error> {
    let monomial = Monomial::new(&[1, 2, 3])?;
    assert_eq!((monomial.total_degree(), monomial.degree_in(&[0, 2]), monomial.exponent(99)), (6, 4, 0));
    assert!(matches!(Monomial::new(&[0; 9]), Err(Error::SlotOutOfRange { slot: 8, count: 8 })));
    Ok(())
}
