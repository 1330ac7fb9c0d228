//! The normal form in `f64` against the exact one: two recursions, two representations of a polynomial, two kinds of number.

use andoyer_double::DoubleDouble;
use andoyer_series::forms::Form;
use andoyer_series::rigid_body::{PublicForm, Variable, separatrix_action};
use andoyer_series::{NormalForm, NumericNormalForm};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};

const ORDER: usize = 16;
/// Budget: the sums of order n have n terms of size radius^(−n)/n, each rounded: n·2^−53/n, a third of it seen.
const BUDGET: f64 = 5e-17;

/// Coefficients of w^k w̄^(d−k) at β from a form in u = i w̄, U = w: each is i^j times that of u^j U^k.
fn at_beta(form: &PublicForm, degree: usize, beta: &BigRational) -> Vec<Complex<f64>> {
    let mut exact = vec![Complex::new(BigRational::zero(), BigRational::zero()); degree + 1];
    for (&(j, k, l), c) in form {
        assert_eq!((j + k) as usize, degree);
        let power = (0..l).fold(BigRational::from_integer(1.into()), |product, _| product * beta);
        let turned = (0..j).fold(c * Complex::new(power, BigRational::zero()), |c, _| Complex::new(-c.im, c.re));
        exact[k as usize] += turned;
    }
    exact.iter().map(|c| Complex::new(c.re.to_f64().expect("finite"), c.im.to_f64().expect("finite"))).collect()
}

#[test]
fn direct_transformation_in_doubles_is_the_exact_one_to_rounding_at_the_separatrix() {
    let normal_form = NormalForm::new(ORDER).expect("within the bounds");
    for (p, q) in [(0, 1), (1, 16), (1, 2), (15, 16)] {
        // Dyadic: the double is the rational.
        let (beta, rational) = (f64::from(p) / f64::from(q), BigRational::new(p.into(), q.into()));
        let numeric = NumericNormalForm::new(beta, ORDER).expect("0 ≤ β ≤ 1");
        // The radius of convergence in s = κσ.
        let radius = separatrix_action(beta).expect("0 ≤ β ≤ 1") / (1.0 - beta * beta).sqrt();
        let (anomaly, longitude) = (numeric.direct(), numeric.direct_longitude());
        for n in 1..=ORDER {
            let weight = radius.powi(n as i32);
            let exact = at_beta(&normal_form.direct(Variable::Momentum, n).expect("n ≤ order"), 2 * n + 1, &rational);
            for (found, exact) in anomaly[n].coefficients().iter().zip(exact) {
                assert_eq!(exact.im, 0.0);
                assert!((found - exact.re).abs() * weight <= BUDGET, "w, β = {beta}, order {n}: {found} for {exact}");
            }
            // y − y′ = iŷ: another factor of −i.
            let exact = at_beta(&normal_form.direct(Variable::Angle, n).expect("n ≤ order"), 2 * n + 2, &rational);
            for (found, exact) in longitude[n - 1].coefficients().iter().zip(exact) {
                assert_eq!(exact.re, 0.0);
                assert!((found - exact.im).abs() * weight <= BUDGET, "y, β = {beta}, order {n}: {found} for {exact}");
            }
        }
    }
}

#[test]
fn a_beta_that_no_body_has_is_refused() {
    for beta in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        assert!(NumericNormalForm::new(beta, 2).is_err(), "{beta}");
    }
    assert!(NumericNormalForm::new(0.5, 201).is_err());
    assert!(NumericNormalForm::new(0.5, usize::MAX).is_err());
}

/// Largest error of the coefficients of one order, over the size radius^(−n) that the order has at the separatrix.
fn error_of_order(found: &Form, exact: &Form<DoubleDouble>, weight: f64) -> f64 {
    let pairs = found.coefficients().iter().zip(exact.coefficients());
    pairs.map(|(&f, &e)| (DoubleDouble::from(f) - e).to_f64().abs() * weight).fold(0.0, f64::max)
}

#[test]
fn polynomials_in_doubles_and_in_double_double_are_the_exact_ones_to_order_sixty() {
    let exact = NormalForm::new(60).expect("within the bounds");
    for (p, q) in [(1, 16), (1, 2), (15, 16), (1023, 1024)] {
        let (beta, rational) = (f64::from(p) / f64::from(q), BigRational::new(p.into(), q.into()));
        let doubles = NumericNormalForm::new(beta, 60).expect("0 ≤ β ≤ 1").triaxiality_polynomials();
        let doubled = NumericNormalForm::new(DoubleDouble::from(beta), 60).expect("0 ≤ β ≤ 1");
        let radius = separatrix_action(beta).expect("0 ≤ β ≤ 1") / (1.0 - beta * beta).sqrt();
        for (n, (&single, double)) in doubles.iter().zip(doubled.triaxiality_polynomials()).enumerate() {
            let polynomial = exact.triaxiality_polynomial(n).expect("n ≤ order");
            let value: BigRational = polynomial.iter().map(|(&k, c)| c * rational.pow(k as i32)).sum();
            let high = value.to_f64().expect("finite");
            let low = (&value - BigRational::from_float(high).expect("finite")).to_f64().expect("finite");
            let rest = (double - DoubleDouble::sum(high, low)).to_f64().abs();
            // Budget: 2n roundings, of both factors of every product, each of two units at most; and in double-double of 2^−104 against a P_n of radius^(−n)/n².
            let relative = (single - high).abs() / high.abs();
            assert!(relative <= 5e-16 * (n + 1) as f64, "β = {beta}, P_{n}: {single} for {high}");
            assert!(rest * radius.powi(n as i32) <= 5e-34, "β = {beta}, P_{n} in double-double: off by {rest:e}");
        }
    }
}

#[test]
fn the_direct_transformation_in_doubles_loses_nothing_to_order_sixty() {
    for beta in [0.0, 0.0625, 0.5, 0.9375, 0.9990234375] {
        let doubles = NumericNormalForm::new(beta, 60).expect("0 ≤ β ≤ 1");
        let exact = NumericNormalForm::new(DoubleDouble::from(beta), 60).expect("0 ≤ β ≤ 1");
        let radius = separatrix_action(beta).expect("0 ≤ β ≤ 1") / (1.0 - beta * beta).sqrt();
        for (n, (found, exact)) in doubles.direct().iter().zip(&exact.direct()).enumerate() {
            let error = error_of_order(found, exact, radius.powi(n as i32));
            assert!(error <= BUDGET, "w, β = {beta}, order {n}: {error:e}");
        }
        for (n, (found, exact)) in (1..).zip(doubles.direct_longitude().iter().zip(&exact.direct_longitude())) {
            let error = error_of_order(found, exact, radius.powi(n));
            assert!(error <= BUDGET, "y, β = {beta}, order {n}: {error:e}");
        }
    }
}
