//! Derivative, substitution and evaluation agree with one another.

use crate::strategies::{gaussian_polynomial, rational_polynomial};
use andoyer_series::{Coefficient, Error, Polynomial, Truncation};
use num_rational::BigRational;
use proptest::prelude::*;

fn laws<C: Coefficient>(
    a: &Polynomial<C>,
    b: &Polynomial<C>,
    c: &Polynomial<C>,
    point: [i64; 4],
) -> Result<(), TestCaseError> {
    let product = &a.derivative(0)?.multiply(b)? + &a.multiply(&b.derivative(0)?)?;
    prop_assert_eq!(a.multiply(b)?.derivative(0)?, product);
    prop_assert_eq!(a.derivative(0)?.derivative(1)?, a.derivative(1)?.derivative(0)?);

    let values = point.map(C::integer);
    let at = |p: &Polynomial<C>| p.evaluate(&values);
    prop_assert_eq!(at(&(a + b))?, at(a)? + at(b)?);
    prop_assert_eq!(at(&a.multiply(b)?)?, at(a)? * at(b)?);

    // Substituting b for variable 0 and evaluating is evaluating with b's value for variable 0; so for two variables at
    // once.
    let [_, y, z, w] = values.clone();
    prop_assert_eq!(at(&a.substitute(0, b)?)?, a.evaluate(&[at(b)?, y.clone(), z, w])?);
    let [_, _, z, w] = values.clone();
    let composed = a.compose(&[(0, b), (1, c)], None)?;
    prop_assert_eq!(at(&composed)?, a.evaluate(&[at(b)?, at(c)?, z, w])?);
    let kept = Truncation::total(5);
    prop_assert_eq!(a.compose(&[(0, b), (1, c)], Some(&kept))?, composed.truncate(&kept));

    let partial = a.evaluate_partial(1, &y)?;
    prop_assert!(partial.part(1, 0)? == partial);
    prop_assert_eq!(at(&partial)?, at(a)?);
    prop_assert_eq!(&a.exchange(0, 1)?.exchange(0, 1)?, a);
    Ok(())
}

proptest! {
    #[test]
    fn rational_calculus_closes(
        a in rational_polynomial(), b in rational_polynomial(), c in rational_polynomial(), point in [-3_i64..4, -3..4, -3..4, -3..4],
    ) {
        laws(&a, &b, &c, point)?;
    }

    #[test]
    fn gaussian_calculus_closes(
        a in gaussian_polynomial(), b in gaussian_polynomial(), c in gaussian_polynomial(), point in [-3_i64..4, -3..4, -3..4, -3..4],
    ) {
        laws(&a, &b, &c, point)?;
    }
}

#[test]
fn substitution_is_simultaneous() -> Result<(), Error> {
    let parse = |text| Polynomial::<BigRational>::parse(text, &["x", "y", "z"]);
    let composed = parse("x^2*y + z")?.compose(&[(0, &parse("y")?), (1, &parse("x")?)], None)?;
    assert_eq!(composed, parse("y^2*x + z")?);
    Ok(())
}

#[test]
fn a_variable_without_a_value_is_an_error() -> Result<(), Error> {
    let p = Polynomial::<f64>::parse("x + z", &["x", "y", "z"])?;
    assert!(matches!(p.evaluate(&[1.0, 2.0]), Err(Error::ValueMissing { slot: 2, given: 2 })));
    assert_eq!(p.evaluate(&[1.0, f64::NAN, 2.0])?, 3.0); // y does not occur
    Ok(())
}
