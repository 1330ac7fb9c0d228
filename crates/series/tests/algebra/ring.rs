//! The ring laws, and identities that a wrong product would break.

use crate::strategies::{gaussian_polynomial, rational_polynomial, schoolbook};
use andoyer_series::{Coefficient, Error, Monomial, Polynomial, Truncation};
use num_rational::BigRational;
use proptest::prelude::*;
use std::hash::{BuildHasher, Hash};

fn laws<C: Coefficient>(a: &Polynomial<C>, b: &Polynomial<C>, c: &Polynomial<C>) -> Result<(), TestCaseError> {
    let one = Polynomial::constant(C::one());
    prop_assert_eq!(a + b, b + a);
    prop_assert_eq!(&(a + b) + c, a + &(b + c));
    prop_assert!((a - &a.clone()).is_zero());
    prop_assert_eq!(a - b, a + &-b);
    prop_assert_eq!(a.multiply(b)?, b.multiply(a)?);
    prop_assert_eq!(a.multiply(&b.multiply(c)?)?, a.multiply(b)?.multiply(c)?);
    prop_assert_eq!(a.multiply(&(b + c))?, &a.multiply(b)? + &a.multiply(c)?);
    prop_assert_eq!(&a.multiply(&one)?, a);
    prop_assert_eq!(a.power(3)?, a.multiply(a)?.multiply(a)?);
    prop_assert_eq!(a.scale(&C::integer(7)).over(7)?, a.clone());
    // A field: no zero divisors, so the largest degrees add.
    prop_assert_eq!(a.multiply(b)?.degree(), a.degree().zip(b.degree()).map(|(m, n)| m + n));
    let kept = Truncation::partial(&[1, 2], 4)?;
    prop_assert_eq!(a.multiply_truncated(b, &kept)?, a.multiply(b)?.truncate(&kept));
    Ok(())
}

proptest! {
    #[test]
    fn rational_polynomials_form_a_ring(a in rational_polynomial(), b in rational_polynomial(), c in rational_polynomial()) {
        laws(&a, &b, &c)?;
        prop_assert_eq!(a.multiply(&b)?, schoolbook(&a, &b)?);
    }

    #[test]
    fn gaussian_polynomials_form_a_ring(a in gaussian_polynomial(), b in gaussian_polynomial(), c in gaussian_polynomial()) {
        laws(&a, &b, &c)?;
        prop_assert_eq!(a.multiply(&b)?, schoolbook(&a, &b)?);
    }

    #[test]
    fn parts_add_up_to_the_whole(a in rational_polynomial(), b in gaussian_polynomial()) {
        let parts = (0..=12).map(|degree| a.homogeneous_part(degree));
        prop_assert_eq!(parts.fold(Polynomial::zero(), |sum, part| &sum + &part), a);
        let parts = (0..4).map(|degree| b.part(2, degree)).collect::<Result<Vec<_>, _>>()?;
        prop_assert_eq!(parts.iter().fold(Polynomial::zero(), |sum, part| &sum + part), b);
    }

    #[test]
    fn the_order_of_insertion_leaves_no_trace(
        coefficients in prop::collection::hash_map(0_u8..200, -1e3_f64..1e3, 2..60),
        seed in any::<u64>(),
    ) {
        let terms: Vec<_> = coefficients.iter().map(|(&e, &c)| (Monomial::small([e % 8, e / 8, 0, 0, 0, 0, 0, 0]), c)).collect();
        let mut shuffled = terms.clone();
        let hasher = seeded_hasher(seed);
        shuffled.sort_by_key(|(monomial, _)| hasher.hash_one(monomial));
        let (a, b) = (Polynomial::from_terms(terms), Polynomial::from_terms(shuffled));
        let text = |p: &Polynomial<f64>| p.display(&["x", "y"]).to_string();
        prop_assert_eq!(text(&a), text(&b));
        let value = |p: &Polynomial<f64>| p.evaluate(&[0.9, 1.1]).map(f64::to_bits);
        prop_assert_eq!(value(&a)?, value(&b)?);
        prop_assert_eq!(text(&a.multiply(&a)?), text(&b.multiply(&b)?));
        let ranks: Vec<_> = a.terms().map(|(monomial, _)| monomial).collect();
        prop_assert!(ranks.is_sorted());
    }
}

/// A family of hash functions: a different order of the terms for each seed.
fn seeded_hasher(seed: u64) -> impl BuildHasher {
    #[derive(Clone)]
    struct Seeded(u64);
    impl BuildHasher for Seeded {
        type Hasher = std::hash::DefaultHasher;
        fn build_hasher(&self) -> Self::Hasher {
            let mut hasher = Self::Hasher::new();
            self.0.hash(&mut hasher);
            hasher
        }
    }
    Seeded(seed)
}

#[test]
fn euler_s_four_squares() -> Result<(), Error> {
    let names = ["a", "b", "c", "d", "x", "y", "z", "w"];
    let parse = |text| Polynomial::<BigRational>::parse(text, &names);
    let left = parse("a^2 + b^2 + c^2 + d^2")?.multiply(&parse("x^2 + y^2 + z^2 + w^2")?)?;
    let squares = ["a*x - b*y - c*z - d*w", "a*y + b*x + c*w - d*z", "a*z - b*w + c*x + d*y", "a*w + b*z - c*y + d*x"];
    let mut right = Polynomial::zero();
    for text in squares {
        right += &parse(text)?.power(2)?;
    }
    assert_eq!(left, right);
    assert_eq!(left.len(), 16);
    Ok(())
}

#[test]
fn powers_of_a_sum_have_multinomial_coefficients() -> Result<(), Error> {
    let power = Polynomial::<BigRational>::parse("x + y + z + 1", &["x", "y", "z"])?.power(12)?;
    assert_eq!(power.len(), 455); // C(15, 3)
    let middle = power.coefficient(&Monomial::new(&[3, 3, 3])?);
    assert_eq!(middle, Some(&BigRational::integer(369_600))); // 12!/(3!)⁴
    Ok(())
}

#[test]
fn fateman_s_product_has_its_number_of_terms_and_its_coefficients() -> Result<(), Error> {
    // R. Fateman, Comparing the speed of programs for sparse polynomial multiplication (2003): f (f + 1), f = (1+x+y+z+t)ⁿ,
    // there with n = 20. Dense of degree 2n: C(2n+4, 4) terms; coefficients are multinomials of 2n, plus those of n.
    let n = 10;
    let power = Polynomial::<BigRational>::parse("1 + x + y + z + t", &["x", "y", "z", "t"])?.power(n)?;
    let product = power.multiply(&(&power + &Polynomial::constant(BigRational::integer(1))))?;
    assert_eq!((power.len(), product.len()), (1001, 10_626));
    let factorial = |n: u32| (1..=n).fold(BigRational::integer(1), |product, factor| product.times(factor.into()));
    let multinomial = |n: u32, exponents: [u32; 4]| {
        let rest = n.checked_sub(exponents.iter().sum())?;
        let divisor = exponents.iter().fold(factorial(rest), |product, &e| product * factorial(e));
        factorial(n).divide(&divisor)
    };
    for exponents in [[2, 2, 2, 2], [4, 4, 4, 4], [5, 0, 3, 2], [0, 0, 0, 20], [0; 4]] {
        let few = multinomial(n, exponents).unwrap_or_default();
        let expected = multinomial(2 * n, exponents).map(|many| many + few);
        assert_eq!(product.coefficient(&Monomial::new(&exponents)?), expected.as_ref(), "{exponents:?}");
    }
    assert_eq!(product.coefficient(&Monomial::new(&[4, 4, 4, 4])?), Some(&BigRational::integer(305_540_235_000)));
    Ok(())
}

#[test]
fn zero_coefficients_are_never_stored() -> Result<(), Error> {
    let p = Polynomial::<BigRational>::parse("x + y", &["x", "y"])?;
    assert_eq!((&p - &p).len(), 0);
    assert_eq!(p.scale(&BigRational::integer(0)).len(), 0);
    let difference = p.multiply(&Polynomial::parse("x - y", &["x", "y"])?)?;
    assert_eq!(difference.len(), 2);
    assert_eq!(p.map(|_| 0.0).len(), 0);
    assert_eq!(Polynomial::from_terms([(Monomial::ONE, 1.0), (Monomial::ONE, -1.0)]).len(), 0);
    assert_eq!(Polynomial::<f64>::zero().power(0)?, Polynomial::constant(1.0));
    Ok(())
}

#[test]
fn equal_polynomials_hash_alike() -> Result<(), Error> {
    let parse = |text| Polynomial::<BigRational>::parse(text, &["x", "y"]);
    let hasher = seeded_hasher(1);
    assert_eq!(hasher.hash_one(parse("x + y + x*y")?), hasher.hash_one(parse("x*y + y + x")?));
    assert_ne!(hasher.hash_one(parse("x")?), hasher.hash_one(parse("y")?));
    Ok(())
}
