//! Products against the schoolbook's: arrays and tables, one word and two, machine words and big integers, truncations, threads.

use std::collections::HashMap;

use crate::strategies::schoolbook;
use andoyer_double::DoubleDouble;
use andoyer_series::lie::Poisson;
use andoyer_series::num_complex::Complex;
use andoyer_series::num_rational::BigRational;
use andoyer_series::{Coefficient, Error, MAX_EXPONENT, Monomial, Polynomial, Truncation};
use num_bigint::BigInt;
use proptest::collection::vec;
use proptest::prelude::*;

/// Up to 60 terms whose exponents are below `bound` in each of the eight slots.
fn monomials(bound: u32) -> impl Strategy<Value = Vec<Monomial>> {
    vec(prop::array::uniform8(0..bound), 0..60)
        .prop_map(|exponents| exponents.iter().map(|e| Monomial::new(e).expect("small exponents")).collect())
}

/// Exponents that fill a box, that leave most codes unused, and that need codes of two words.
fn any_monomials() -> impl Strategy<Value = Vec<Monomial>> {
    prop_oneof![monomials(2), monomials(9), monomials(MAX_EXPONENT / 2)]
}

/// A polynomial with integers of up to `bits` bits and denominators up to 12.
fn exact(monomials: Vec<Monomial>, bits: u64, seed: i64) -> Polynomial<BigRational> {
    let mut state = seed;
    let terms = monomials.into_iter().map(|monomial| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let numerator = (BigInt::from(state) << bits >> 63) + 1;
        (monomial, BigRational::new(numerator, (1 + state.rem_euclid(12)).into()))
    });
    Polynomial::from_terms(terms)
}

/// The least common multiple of the denominators of [`exact`].
const DENOMINATOR: i64 = 27_720;

/// The numerators over [`DENOMINATOR`].
fn integers(polynomial: &Polynomial<BigRational>) -> HashMap<Monomial, BigInt> {
    polynomial.terms().map(|(monomial, c)| (monomial, (c * BigInt::from(DENOMINATOR)).to_integer())).collect()
}

/// The schoolbook's product of integers: a sum of fractions is reduced at every term.
fn product(a: &HashMap<Monomial, BigInt>, b: &HashMap<Monomial, BigInt>) -> Result<HashMap<Monomial, BigInt>, Error> {
    let mut sum = HashMap::new();
    for (m, x) in a {
        for (n, y) in b {
            *sum.entry(m.checked_mul(*n)?).or_default() += x * y;
        }
    }
    Ok(sum)
}

/// The polynomial of a product of so many factors.
fn rational(product: HashMap<Monomial, BigInt>, factors: u32) -> Polynomial<BigRational> {
    let denominator = BigInt::from(DENOMINATOR).pow(factors);
    let terms = product.into_iter().map(|(monomial, c)| (monomial, BigRational::new(c, denominator.clone())));
    Polynomial::from_terms(terms)
}

fn gaussian(re: &Polynomial<BigRational>, im: &Polynomial<BigRational>) -> Polynomial<Complex<BigRational>> {
    let zero = || BigRational::integer(0);
    &re.map(|c| Complex::new(c.clone(), zero())) + &im.map(|c| Complex::new(zero(), c.clone()))
}

proptest! {
    #[test]
    fn the_product_is_the_schoolbook_s_whatever_the_exponents_and_the_size_of_the_coefficients(
        a in any_monomials(), b in any_monomials(), bits in prop::sample::select(vec![3_u64, 40, 62, 63, 64, 100, 200]), seed in any::<i64>(),
    ) {
        let (a, b) = (exact(a, bits, seed), exact(b, 62, !seed));
        let [i, j] = [&a, &b].map(integers);
        prop_assert_eq!(a.multiply(&b)?, rational(product(&i, &j)?, 2));
        // (a + ib)(b + 2ia) = −ab + i(2a² + b²)
        let (c, d) = (gaussian(&a, &b), gaussian(&b, &a.scale(&BigRational::integer(2))));
        let [re, first, second] = [product(&i, &j)?, product(&i, &i)?, product(&j, &j)?].map(|p| rational(p, 2));
        let im = &first.scale(&BigRational::integer(2)) + &second;
        prop_assert_eq!(c.multiply(&d)?, gaussian(&-&re, &im));
    }

    #[test]
    fn products_of_products_keep_their_value_in_machine_words(a in monomials(3), b in monomials(4), seed in any::<i64>()) {
        let (a, b) = (exact(a, 9, seed), exact(b, 9, !seed));
        let words = a.multiply(&b)?.multiply(&a)?;
        let [i, j] = [&a, &b].map(integers);
        let looked_at = rational(product(&product(&i, &j)?, &i)?, 3);
        prop_assert_eq!(&words, &looked_at);
        prop_assert_eq!(&words - &looked_at, Polynomial::zero());
    }

    #[test]
    fn a_truncated_product_is_the_truncation_of_the_product(
        a in any_monomials(), b in any_monomials(), degree in 0_u32..60, slots in vec(0_usize..8, 0..5), seed in any::<i64>(),
    ) {
        let (a, b) = (exact(a, 20, seed), exact(b, 20, !seed));
        let whole = a.multiply(&b)?;
        for truncation in [Truncation::total(degree), Truncation::partial(&slots, degree)?] {
            prop_assert_eq!(a.multiply_truncated(&b, &truncation)?, whole.truncate(&truncation));
        }
    }

    #[test]
    fn a_truncated_bracket_is_the_truncation_of_the_bracket(
        a in monomials(4), b in monomials(4), degree in 0_u32..30, slots in vec(0_usize..8, 0..5), seed in any::<i64>(),
    ) {
        let poisson = Poisson::new(&[(0, 1), (5, 2)])?.with_reciprocal(4, 3)?;
        let (a, b) = (exact(a, 20, seed), exact(b, 20, !seed));
        let whole = poisson.bracket(&a, &b)?;
        for truncation in [Truncation::total(degree), Truncation::partial(&slots, degree)?] {
            prop_assert_eq!(poisson.bracket_truncated(&a, &b, &truncation)?, whole.truncate(&truncation));
        }
    }

    #[test]
    fn floats_are_added_in_the_order_of_the_factor_with_fewer_terms(a in any_monomials(), b in any_monomials(), seed in any::<i64>()) {
        let (a, b) = (exact(a, 53, seed), exact(b, 53, !seed));
        let float = |p: &Polynomial<BigRational>| p.map(|c| andoyer_series::real_field::RealField::to_float(c) * 1e-9);
        let (a, b) = (float(&a), float(&b));
        let (few, many) = if a.len() <= b.len() { (&a, &b) } else { (&b, &a) };
        let expected = schoolbook(few, many)?;
        let product = a.multiply(&b)?;
        let bits = |p: &Polynomial<f64>| p.terms().map(|(m, c)| (m, c.to_bits())).collect::<Vec<_>>();
        prop_assert_eq!(bits(&product), bits(&expected));
    }
}

/// (1 + x + … )ⁿ with every variable to powers of its own, and the same reversed: a table's product, or an array's.
fn factors<C: Coefficient>(sparse: bool, n: u32) -> Result<[Polynomial<C>; 2], Error> {
    let texts = if sparse {
        ["1 + x + y + 2*z^2 + 3*t^3 + 5*u^5", "1 + u + t + 2*z^2 + 3*y^3 + 5*x^5"]
    } else {
        ["1 + x + y + z + t", "2 - x + 3*y + z - t"]
    };
    let powers = texts.map(|text| Polynomial::<C>::parse(text, &["x", "y", "z", "t", "u"])?.power(n));
    let [f, g] = powers;
    Ok([f?, g?])
}

/// A hash of the terms, to the bit.
fn fingerprint(polynomial: &Polynomial<f64>) -> u64 {
    polynomial.terms().fold(polynomial.len() as u64, |hash, (monomial, c)| {
        let exponents = monomial.exponents().iter().fold(0_u64, |sum, &e| 67 * sum + u64::from(e));
        (hash.rotate_left(5) ^ c.to_bits() ^ exponents).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    })
}

#[test]
fn the_number_of_threads_leaves_no_trace() -> Result<(), Box<dyn std::error::Error>> {
    for sparse in [true, false] {
        // Over 2¹⁸ products, so that threads are used, and coefficients that are not integers.
        let [f, g] = factors::<f64>(sparse, if sparse { 8 } else { 10 })?;
        let (f, g) = (f.scale(&0.1), g.scale(&0.7));
        assert!(f.len() * g.len() > 1 << 19);
        let mut fingerprints = Vec::new();
        for threads in [1, 2, 3, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            fingerprints.push(pool.install(|| f.multiply(&g).map(|product| fingerprint(&product)))?);
        }
        assert!(fingerprints.iter().all(|&one| one == fingerprints[0]), "{fingerprints:x?}");
    }
    Ok(())
}

#[test]
fn threads_give_the_exact_product_too() -> Result<(), Box<dyn std::error::Error>> {
    let [f, g] = factors::<BigRational>(true, 7)?;
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let [one, two] = [pool(1)?.install(|| f.multiply(&g))?, pool(2)?.install(|| f.multiply(&g))?];
    assert_eq!(one, two);
    // The sum of all coefficients is the product of those of the factors: 13¹⁴.
    let value = one.evaluate(&[1, 1, 1, 1, 1].map(BigRational::integer))?;
    assert_eq!(value, BigRational::from_integer(BigInt::from(13).pow(14)));
    // u and v of the highest degree: 5⁷ u³⁵ · u⁷.
    assert_eq!(one.coefficient(&Monomial::new(&[0, 0, 0, 0, 42])?), Some(&BigRational::integer(78_125)));
    Ok(())
}

#[test]
fn sums_beyond_128_bits_are_promoted_to_big_integers() -> Result<(), Error> {
    let of = |values: &[BigInt]| {
        let terms = (0..).zip(values).map(|(e, c)| Ok((Monomial::new(&[e])?, BigRational::from_integer(c.clone()))));
        Ok::<_, Error>(Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?))
    };
    for bits in [61_u32, 62, 63, 64, 126, 127, 128] {
        for nudge in [-1_i32, 0, 1] {
            for sign in [-1_i32, 1] {
                let border: BigInt = (BigInt::from(1) << bits) + nudge;
                let (a, b) = (
                    of(&[border.clone(), &border * sign, border.clone()])?,
                    of(&[border.clone(), border.clone(), border.clone()])?,
                );
                let product = a.multiply(&b)?;
                let square = &border * &border;
                let expected = [1, 1 + sign, 2 + sign, 1 + sign, 1].map(|count: i32| &square * count);
                assert_eq!(product, of(&expected)?, "2^{bits} {nudge:+} times {sign}");
                // And once more, from words or from big integers.
                assert_eq!(product.multiply(&a)?, schoolbook(&product, &a)?);
            }
        }
    }
    Ok(())
}

#[test]
fn denominators_that_do_not_fit_are_big_integers() -> Result<(), Error> {
    let prime = |power: u32| BigRational::new(1.into(), BigInt::from(1_000_003).pow(power));
    let a = Polynomial::from_terms([(Monomial::ONE, prime(3)), (Monomial::new(&[1])?, prime(5))]);
    for b in [&a, &a.scale(&prime(6))] {
        let product = a.multiply(b)?;
        assert_eq!(product, schoolbook(&a, b)?);
        assert_eq!(product.multiply(b)?, schoolbook(&product, b)?);
    }
    Ok(())
}

#[test]
fn every_kind_of_coefficient_has_fateman_s_number() -> Result<(), Error> {
    // (1+x+y+z+t)²⁰: the coefficient of (xyzt)⁴ is 20!/4!⁵ = 305540235000, exact in a float.
    fn check<C: Coefficient>() -> Result<(), Error> {
        let f = Polynomial::<C>::parse("1 + x + y + z + t", &["x", "y", "z", "t"])?.power(10)?;
        let middle = f.multiply(&f)?.coefficient(&Monomial::new(&[4, 4, 4, 4])?).cloned();
        assert_eq!(middle, Some(C::integer(305_540_235_000)));
        Ok(())
    }
    check::<f64>()?;
    check::<DoubleDouble>()?;
    check::<Complex<f64>>()?;
    check::<BigRational>()?;
    check::<Complex<BigRational>>()
}

#[test]
fn an_overflow_is_named_although_the_term_would_be_dropped() -> Result<(), Error> {
    let large = Polynomial::from_terms([(Monomial::new(&[0, 20_000])?, 1.0), (Monomial::ONE, 1.0)]);
    let dropped = large.multiply_truncated(&large, &Truncation::total(3));
    assert!(matches!(dropped, Err(Error::ExponentOverflow { slot: 1, exponent: 40_000, .. })));
    let high = Polynomial::from_terms([(Monomial::new(&[MAX_EXPONENT; 8])?, 2.0)]);
    assert_eq!(high.multiply(&Polynomial::constant(3.0))?, high.scale(&3.0));
    Ok(())
}

#[test]
fn terms_that_are_added_out_of_order_are_found_and_cancel() -> Result<(), Error> {
    let mut p = Polynomial::<f64>::zero();
    let monomial = |k: u32| Monomial::new(&[k * 7 % 31, k * 5 % 31]);
    for k in 0..31 {
        p.add_term(monomial(k)?, &f64::from(k + 1));
    }
    assert_eq!(p.len(), 31);
    for k in (0..31).step_by(2) {
        p.add_term(monomial(k)?, &-f64::from(k + 1));
    }
    assert_eq!(p.len(), 15);
    assert_eq!((p.coefficient(&monomial(3)?), p.coefficient(&monomial(4)?)), (Some(&4.0), None));
    assert!(p.terms().map(|(monomial, _)| monomial).is_sorted());
    assert_eq!(p.multiply(&p)?, schoolbook(&p, &p)?);
    let mut q = p.clone();
    q += &p;
    assert_eq!(q, p.scale(&2.0));
    q -= &p;
    q -= &p;
    assert!(q.is_zero());
    Ok(())
}
