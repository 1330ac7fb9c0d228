//! The Poisson bracket: its sign, and the laws of a Lie algebra of derivations.

use crate::strategies::{gaussian_polynomial, rational_polynomial};
use andoyer_series::lie::Poisson;
use andoyer_series::{Coefficient, Error, Monomial, Polynomial};
use num_rational::BigRational;
use proptest::prelude::*;

fn laws<C: Coefficient>(poisson: &Poisson, [f, g, h]: [&Polynomial<C>; 3]) -> Result<(), TestCaseError> {
    let bracket = |a: &Polynomial<C>, b: &Polynomial<C>| poisson.bracket(a, b);
    prop_assert_eq!(bracket(f, g)?, -&bracket(g, f)?);
    prop_assert!(bracket(f, f)?.is_zero());
    let leibniz = &f.multiply(&bracket(g, h)?)? + &bracket(f, h)?.multiply(g)?;
    prop_assert_eq!(bracket(&f.multiply(g)?, h)?, leibniz);
    let jacobi = &(&bracket(f, &bracket(g, h)?)? + &bracket(g, &bracket(h, f)?)?) + &bracket(h, &bracket(f, g)?)?;
    prop_assert!(jacobi.is_zero());
    prop_assert_eq!(poisson.lie_derivative(h, f)?, bracket(f, h)?);
    Ok(())
}

/// {f; g} by its definition.
fn by_derivatives<C: Coefficient>(
    f: &Polynomial<C>,
    g: &Polynomial<C>,
    pairs: &[(usize, usize)],
) -> Result<Polynomial<C>, Error> {
    let mut sum = Polynomial::zero();
    for &(q, p) in pairs {
        sum += &f.derivative(q)?.multiply(&g.derivative(p)?)?;
        sum -= &f.derivative(p)?.multiply(&g.derivative(q)?)?;
    }
    Ok(sum)
}

proptest! {
    #[test]
    fn a_bracket_of_long_integers_is_that_of_short_ones_times_the_factor(f in rational_polynomial(), g in rational_polynomial()) {
        let poisson = Poisson::new(&[(0, 1), (2, 3)])?;
        let factor = BigRational::from_integer(num_bigint::BigInt::from(1) << 200);
        let long = |polynomial: &Polynomial<BigRational>| polynomial.map(|c| c * &factor);
        prop_assert_eq!(poisson.bracket(&long(&f), &g)?, long(&poisson.bracket(&f, &g)?));
    }

    #[test]
    fn two_canonical_pairs_make_a_lie_algebra(f in rational_polynomial(), g in rational_polynomial(), h in rational_polynomial()) {
        let poisson = Poisson::new(&[(0, 1), (2, 3)])?;
        laws(&poisson, [&f, &g, &h])?;
        prop_assert_eq!(poisson.bracket(&f, &g)?, by_derivatives(&f, &g, &[(0, 1), (2, 3)])?);
    }

    #[test]
    fn so_they_do_over_the_gaussian_rationals(f in gaussian_polynomial(), g in gaussian_polynomial(), h in gaussian_polynomial()) {
        let poisson = Poisson::new(&[(3, 0), (1, 2)])?;
        laws(&poisson, [&f, &g, &h])?;
        prop_assert_eq!(poisson.bracket(&f, &g)?, by_derivatives(&f, &g, &[(3, 0), (1, 2)])?);
    }

    #[test]
    fn a_reciprocal_pair_makes_one_too(f in rational_polynomial(), g in rational_polynomial(), h in rational_polynomial()) {
        let poisson = Poisson::new(&[(0, 1)])?.with_reciprocal(2, 3)?;
        laws(&poisson, [&f, &g, &h])?;
        // ∂/∂P = −r² ∂/∂r on the pair (2, P = 1/r), r in slot 3.
        let minus_square = Polynomial::from_terms([(Monomial::new(&[0, 0, 0, 2])?, BigRational::integer(-1))]);
        let reciprocal = minus_square.multiply(&by_derivatives(&f, &g, &[(2, 3)])?)?;
        prop_assert_eq!(poisson.bracket(&f, &g)?, &by_derivatives(&f, &g, &[(0, 1)])? + &reciprocal);
    }
}

#[test]
fn the_sign_is_that_of_q_with_p() -> Result<(), Error> {
    let parse = |text| Polynomial::<BigRational>::parse(text, &["q", "p", "y", "r"]);
    let poisson = Poisson::new(&[(0, 1)])?.with_reciprocal(2, 3)?;
    assert_eq!(poisson.bracket(&parse("q")?, &parse("p")?)?, parse("1")?);
    assert_eq!(poisson.bracket(&parse("y")?, &parse("r^3")?)?, parse("-3*r^4")?); // ∂M⁻³/∂M = −3 M⁻⁴
    // dq/dt = {q; h} = ∂h/∂p.
    assert_eq!(poisson.lie_derivative(&parse("p^2/2")?, &parse("q")?)?, parse("p")?);
    Ok(())
}

#[test]
fn exponents_at_the_bound_are_handled_without_a_wrap() -> Result<(), Error> {
    let poisson = Poisson::new(&[(0, 1)])?.with_reciprocal(2, 3)?;
    let term = |exponents: &[u32]| Ok::<_, Error>(Polynomial::from_terms([(Monomial::new(exponents)?, 1.0)]));
    // q^32767 p^0 with q p: the product has q^32768, the bracket q^32767.
    let bracket = poisson.bracket(&term(&[32_767])?, &term(&[1, 1])?)?;
    assert_eq!(bracket, term(&[32_767])?.scale(&32_767.0));
    let overflow = poisson.bracket(&term(&[20_000, 1])?, &term(&[20_000, 2])?);
    assert!(matches!(overflow, Err(Error::ExponentOverflow { slot: 0, exponent: 39_999, .. })));
    // y r^32767 with y^2 r^32767: r^(65534+1) still fits its field, and is reported.
    let overflow = poisson.bracket(&term(&[0, 0, 1, 32_767])?, &term(&[0, 0, 2, 32_767])?);
    assert!(matches!(overflow, Err(Error::ExponentOverflow { slot: 3, exponent: 65_535, .. })));
    Ok(())
}

#[test]
fn pairs_must_be_disjoint_and_exist() {
    assert!(matches!(Poisson::new(&[(0, 1), (1, 2)]), Err(Error::SlotRepeated { slot: 1 })));
    assert!(matches!(Poisson::new(&[(3, 3)]), Err(Error::SlotRepeated { slot: 3 })));
    assert!(matches!(Poisson::new(&[(0, 8)]), Err(Error::SlotOutOfRange { slot: 8, .. })));
    let reciprocal = Poisson::new(&[(0, 1)]).and_then(|poisson| poisson.with_reciprocal(2, 0));
    assert!(matches!(reciprocal, Err(Error::SlotRepeated { slot: 0 })));
}
