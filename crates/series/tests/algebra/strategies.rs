//! Random exact polynomials: few terms, small exponents and small fractions, so that like terms and cancellations are
//! common; and the product by its definition, against which products are tested.

use andoyer_series::{Coefficient, Error, Monomial, Polynomial};
use num_complex::Complex;
use num_rational::BigRational;
use proptest::collection::vec;
use proptest::prelude::*;

fn rational() -> impl Strategy<Value = BigRational> {
    (-9_i64..=9, 1_i64..=6).prop_map(|(p, q)| BigRational::new(p.into(), q.into()))
}

fn monomial() -> impl Strategy<Value = Monomial> {
    [0_u8..4, 0_u8..4, 0_u8..4, 0_u8..4].prop_map(|[a, b, c, d]| Monomial::small([a, b, c, d, 0, 0, 0, 0]))
}

/// A polynomial in four variables over the rationals.
pub(crate) fn rational_polynomial() -> impl Strategy<Value = Polynomial<BigRational>> {
    vec((monomial(), rational()), 0..6).prop_map(Polynomial::from_terms)
}

/// A polynomial in four variables over the Gaussian rationals.
pub(crate) fn gaussian_polynomial() -> impl Strategy<Value = Polynomial<Complex<BigRational>>> {
    let coefficient = (rational(), rational()).prop_map(|(re, im)| Complex::new(re, im));
    vec((monomial(), coefficient), 0..6).prop_map(Polynomial::from_terms)
}

/// The product by its definition, with reduced fractions throughout.
pub(crate) fn schoolbook<C: Coefficient>(a: &Polynomial<C>, b: &Polynomial<C>) -> Result<Polynomial<C>, Error> {
    let mut sum = Polynomial::zero();
    for (m, x) in a.terms() {
        for (n, y) in b.terms() {
            let mut product = x.clone();
            product *= y;
            sum.add_term(m.checked_mul(n)?, &product);
        }
    }
    Ok(sum)
}
