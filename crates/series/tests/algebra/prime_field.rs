//! A prime field as coefficients: what is needed for it from outside, and the exact normal form held against Deprit's triangle modulo
//! 2⁶¹ − 1 at a number for β, to an order that the triangle in rationals does not reach in a test.

use andoyer_series::lie::deprit_triangle;
use andoyer_series::progress::quiet;
use andoyer_series::rigid_body::{BETA, W, W_BAR, hamiltonian, homological, poisson};
use andoyer_series::{Coefficient, Error, Monomial, NormalForm, Polynomial};
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Zero};
use std::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

const ORDER: usize = 60;
const P: u64 = (1 << 61) - 1;

/// An integer modulo P, reduced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Residue(u64);

impl Residue {
    fn power(self, exponent: u64) -> Self {
        let half = if exponent == 0 { return Residue(1) } else { self.power(exponent / 2) };
        if exponent.is_multiple_of(2) { half * half } else { half * half * self }
    }

    fn of(value: &BigRational) -> Option<Self> {
        let part = |part: &BigInt| u64::try_from(part.mod_floor(&P.into())).ok().map(Residue);
        part(value.numer())?.divide(&part(value.denom())?)
    }
}

impl Add for Residue {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Residue((self.0 + other.0) % P)
    }
}

impl Sub for Residue {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Residue {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = u128::from(self.0) * u128::from(other.0) % u128::from(P);
        Residue(product as u64) // below P
    }
}

impl Neg for Residue {
    type Output = Self;
    fn neg(self) -> Self {
        Residue((P - self.0) % P)
    }
}

impl AddAssign<&Residue> for Residue {
    fn add_assign(&mut self, other: &Residue) {
        *self = *self + *other;
    }
}

impl SubAssign<&Residue> for Residue {
    fn sub_assign(&mut self, other: &Residue) {
        *self = *self - *other;
    }
}

impl MulAssign<&Residue> for Residue {
    fn mul_assign(&mut self, other: &Residue) {
        *self = *self * *other;
    }
}

impl Zero for Residue {
    fn zero() -> Self {
        Residue(0)
    }
    fn is_zero(&self) -> bool {
        self.0 == 0
    }
}

impl One for Residue {
    fn one() -> Self {
        Residue(1)
    }
}

impl Coefficient for Residue {
    type Raw = Residue;
    type Scale = ();

    fn integer(value: i64) -> Self {
        let magnitude = Residue(value.unsigned_abs() % P);
        if value < 0 { -magnitude } else { magnitude }
    }

    fn invert(&self) -> Option<Self> {
        (!self.is_zero()).then(|| self.power(P - 2))
    }

    fn literal(&self) -> (bool, String) {
        (false, self.0.to_string())
    }

    fn lift(values: &[&Self]) -> (Vec<Self>, ()) {
        (values.iter().map(|&&value| value).collect(), ())
    }

    fn lower(raw: Self, (): &(), (): &()) -> Self {
        raw
    }

    fn raw_product(first: &Self, second: &Self) -> Self {
        *first * *second
    }

    fn raw_accumulate(sum: &mut Self, product: &Self, weight: i64) {
        *sum += &(*product * Residue::integer(weight));
    }
}

#[test]
fn the_field_has_inverses_and_its_integers_wrap() {
    assert_eq!(Residue::integer(-1), Residue(P - 1));
    assert_eq!(Residue::ratio(1, 3).map(|third| third.times(3)), Some(Residue(1)));
    assert_eq!(Residue(0).invert(), None);
}

/// w̄^j w^k of a polynomial whose β is a number, in residues; the powers of τ follow from the degree.
fn reduced(form: &Polynomial<BigRational>, beta: Residue) -> Result<Polynomial<Residue>, Error> {
    let mut sum = Polynomial::zero();
    for (monomial, c) in form.terms() {
        let c = Residue::of(c).ok_or(Error::DivisionByZero)? * beta.power(monomial.exponent(BETA).into());
        sum.add_term(Monomial::new(&[monomial.exponent(W_BAR), monomial.exponent(W)])?, &c);
    }
    Ok(sum)
}

fn without_tau(form: &Polynomial<Residue>) -> Result<Polynomial<Residue>, Error> {
    let terms = form.terms().map(|(m, &c)| Ok((Monomial::new(&[m.exponent(W_BAR), m.exponent(W)])?, c)));
    Ok(Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?))
}

#[test]
fn the_normal_form_is_that_of_the_triangle_modulo_a_prime_to_order_sixty() -> Result<(), Error> {
    // Both sides are polynomials in β of degree 60 at most over one field: that they differ and agree at this β has a probability of
    // 60/2⁶¹. A quotient of integers that is not exact would show as well. (Order 100 agrees too, in nine seconds.)
    let beta = Residue(0x1234_5678_9abc_def1);
    let parts: Vec<_> =
        hamiltonian::<Residue>()?.iter().map(|part| part.evaluate_partial(BETA, &beta)).collect::<Result<_, _>>()?;
    let triangle = deprit_triangle(&parts, &homological()?, &poisson()?, ORDER, &mut quiet)?;
    let normal_form = NormalForm::new(ORDER)?;
    for n in 0..=ORDER {
        let mut value = Residue(0);
        for (&power, c) in normal_form.triaxiality_polynomial(n)? {
            value += &(Residue::of(c).ok_or(Error::DivisionByZero)? * beta.power(power.into()));
        }
        let action = Monomial::new(&[n as u32 + 1, n as u32 + 1])?;
        let expected = Polynomial::from_terms([(action, value)]);
        assert_eq!(without_tau(&triangle.hamiltonian[n])?.scale(&Residue(2)), expected, "P_{n}");
    }
    for m in 1..=ORDER {
        let forms = (normal_form.transform()?.scaled_generator(m), triangle.transform.scaled_generator(m));
        let (Some(exact), Some(residue)) = forms else { panic!("S_{m} is missing") };
        assert_eq!(reduced(exact, beta)?, without_tau(residue)?, "S_{m}");
        assert!(!residue.is_zero());
    }
    Ok(())
}
