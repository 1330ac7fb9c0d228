//! Polynomials in one unknown over the rationals, and the Gaussian integers among their roots.
//!
//! Every answer is exact. A rational root of a monic polynomial with integer coefficients is an integer, and a root with rational parts is a Gaussian integer. A
//! linear or quadratic polynomial is solved by its formula, a cubic one by the sign changes around one of its real roots. A quartic one has its roots in floats,
//! from which Newton's iteration over the Gaussian integers ends at a root or at none. Sources: D. Y. Y. Yun, *On square-free decomposition algorithms*
//! (SYMSAC 1976); H. Cohen, *A Course in Computational Algebraic Number Theory* (1993), § 3.6.

use num_bigint::BigInt;
use num_complex::Complex;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::schur::eigenvalues;

/// Most steps of Newton's iteration: the floats are near a root, and each step doubles the digits.
const STEPS: usize = 64;

/// A root of a monic polynomial with integer coefficients; of a complex pair that with Im > 0.
pub(super) enum Root {
    Gaussian(Complex<BigInt>),
    /// An approximation of an irrational root.
    Irrational(Complex<BigRational>),
}

/// The coefficients by ascending powers, without zeros at the end.
#[derive(Clone, PartialEq)]
pub(super) struct Univariate(Vec<BigRational>);

impl Univariate {
    pub(super) fn new(mut coefficients: Vec<BigRational>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Univariate(coefficients)
    }

    fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    fn derivative(&self) -> Self {
        Univariate::new(self.0.iter().enumerate().skip(1).map(|(k, c)| c * BigInt::from(k)).collect())
    }

    fn less(&self, other: &Self) -> Self {
        let part = |p: &Self, k: usize| p.0.get(k).cloned().unwrap_or_else(BigRational::zero);
        Univariate::new((0..self.0.len().max(other.0.len())).map(|k| part(self, k) - part(other, k)).collect())
    }

    /// Quotient and remainder of the division by a polynomial other than 0.
    fn divided(&self, divisor: &Self) -> (Self, Self) {
        let (mut rest, degree) = (self.0.clone(), divisor.degree());
        let mut quotient = vec![BigRational::zero(); (self.0.len() + 1).saturating_sub(divisor.0.len())];
        for k in (0..quotient.len()).rev() {
            quotient[k] = &rest[k + degree] / &divisor.0[degree];
            for (entry, c) in rest[k..].iter_mut().zip(&divisor.0) {
                *entry -= &quotient[k] * c;
            }
        }
        (Univariate::new(quotient), Univariate::new(rest))
    }

    fn quotient(&self, divisor: &Self) -> Self {
        self.divided(divisor).0
    }

    /// The monic greatest common divisor.
    fn gcd(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.clone(), other.clone());
        while !b.0.is_empty() {
            (a, b) = (b.clone(), a.divided(&b).1);
        }
        let last = a.0.last().cloned().unwrap_or_else(BigRational::one);
        Univariate(a.0.iter().map(|c| c / &last).collect())
    }

    /// Square-free factors of a monic polynomial, each with the multiplicity of its roots (Yun). Those of integer coefficients have integer coefficients (Gauss).
    pub(super) fn square_free(&self) -> Vec<(Vec<BigInt>, usize)> {
        let derivative = self.derivative();
        let common = self.gcd(&derivative);
        let (mut rest, mut slope) = (self.quotient(&common), derivative.quotient(&common));
        let mut parts = Vec::new();
        for multiplicity in 1.. {
            if rest.degree() == 0 {
                break;
            }
            let difference = slope.less(&rest.derivative());
            let part = rest.gcd(&difference);
            (rest, slope) = (rest.quotient(&part), difference.quotient(&part));
            if part.degree() > 0 {
                parts.push((part.0.iter().map(BigRational::to_integer).collect(), multiplicity));
            }
        }
        parts
    }
}

/// The roots of a monic square-free polynomial of degree 4 at most, up to the first one that is irrational.
pub(super) fn roots(mut polynomial: Vec<BigInt>) -> Vec<Root> {
    let mut found = Vec::new();
    while polynomial.len() > 1 {
        let root = match &polynomial[..] {
            [c, _] => Root::Gaussian(Complex::new(-c, BigInt::zero())),
            [c, b, _] => of_quadratic(b, c),
            [.., _, _] if polynomial.len() == 4 => of_cubic(&polynomial),
            _ => of_quartic(&polynomial),
        };
        let Root::Gaussian(Complex { re, im }) = &root else {
            found.push(root);
            return found;
        };
        let factor =
            if im.is_zero() { vec![-re, BigInt::one()] } else { vec![re * re + im * im, -2 * re, BigInt::one()] };
        polynomial = deflated(&polynomial, &factor);
        found.push(root);
    }
    found
}

/// The quotient by a monic factor.
fn deflated(polynomial: &[BigInt], factor: &[BigInt]) -> Vec<BigInt> {
    let (mut rest, degree) = (polynomial.to_vec(), factor.len() - 1);
    let mut quotient = vec![BigInt::zero(); polynomial.len() - degree];
    for k in (0..quotient.len()).rev() {
        quotient[k] = rest[k + degree].clone();
        for (entry, c) in rest[k..].iter_mut().zip(factor) {
            *entry -= &quotient[k] * c;
        }
    }
    quotient
}

/// The lower root of x² + b x + c, or the complex one.
fn of_quadratic(b: &BigInt, c: &BigInt) -> Root {
    let discriminant: BigInt = b * b - 4 * c;
    let (root, size) = (discriminant.abs().sqrt(), discriminant.abs());
    let real = !discriminant.is_negative();
    let [twice_re, twice_im] = if real { [-b - &root, BigInt::zero()] } else { [-b, root.clone()] };
    if &root * &root == size && twice_re.is_even() && twice_im.is_even() {
        return Root::Gaussian(Complex::new(twice_re / 2, twice_im / 2));
    }
    // 60 binary digits after the point.
    let root = (size << 120_usize).sqrt();
    let half = |n: BigInt| BigRational::new(n, BigInt::one() << 61_usize);
    let near = -b << 60_usize;
    match real {
        // The other root is the larger one, and their product is c: nothing cancels.
        true if b.is_negative() => Root::Irrational(real_number(BigRational::from(c.clone()) / half(near + root))),
        true => Root::Irrational(real_number(half(near - root))),
        false => Root::Irrational(Complex::new(half(near), half(root))),
    }
}

/// A real root of a cubic polynomial, between integers at which the signs differ.
fn of_cubic(polynomial: &[BigInt]) -> Root {
    // |x| ≤ 1 + max |c| (Cauchy).
    let bits = polynomial.iter().map(BigInt::bits).max().unwrap_or_default() + 1;
    let (mut low, mut high) = (-(BigInt::one() << bits), BigInt::one() << bits);
    while &high - &low > BigInt::one() {
        let middle: BigInt = (&low + &high).div_floor(&2.into());
        let value = value(polynomial, &middle);
        match value.is_negative() {
            _ if value.is_zero() => return Root::Gaussian(Complex::new(middle, BigInt::zero())),
            true => low = middle,
            false => high = middle,
        }
    }
    // 60 binary digits more, by the polynomial of 2⁶⁰ x.
    let shifted: Vec<BigInt> =
        polynomial.iter().enumerate().map(|(k, c)| c << (60 * (polynomial.len() - 1 - k))).collect();
    let (mut low, mut high) = (low << 60_usize, high << 60_usize);
    while &high - &low > BigInt::one() {
        let middle: BigInt = (&low + &high).div_floor(&2.into());
        if value(&shifted, &middle).is_negative() { low = middle } else { high = middle }
    }
    Root::Irrational(real_number(BigRational::new(high, BigInt::one() << 60_usize)))
}

fn value(polynomial: &[BigInt], x: &BigInt) -> BigInt {
    polynomial.iter().rev().fold(BigInt::zero(), |sum, c| sum * x + c)
}

fn real_number(re: BigRational) -> Complex<BigRational> {
    Complex::new(re, BigRational::zero())
}

/// A Gaussian integer among the roots of a quartic polynomial, from its roots in floats; or one of these.
fn of_quartic(polynomial: &[BigInt]) -> Root {
    let floats = in_floats(polynomial);
    let whole = |part: &BigRational| part.round().to_integer();
    let start = |root: &Complex<BigRational>| Complex::new(whole(&root.re), whole(&root.im));
    let exact = floats.iter().find_map(|root| newton(polynomial, start(root)));
    match exact {
        Some(root) => Root::Gaussian(root),
        None => Root::Irrational(floats.into_iter().next().unwrap_or_else(|| real_number(BigRational::zero()))),
    }
}

/// The roots with Im ≥ 0 from the companion matrix of p(s x), where s = 2^k is their size.
fn in_floats(polynomial: &[BigInt]) -> Vec<Complex<BigRational>> {
    let degree = polynomial.len() - 1;
    let bits = |k: usize| polynomial[degree - k].bits().div_ceil(k as u64);
    let size = (1..=degree).map(bits).max().unwrap_or_default() as usize;
    let scaled = |i: usize| {
        let part = BigRational::new(polynomial[i].clone(), BigInt::one() << (size * (degree - i)));
        part.to_f64().unwrap_or_default()
    };
    let companion = nalgebra::DMatrix::from_fn(degree, degree, |i, j| match j + 1 == degree {
        true => -scaled(i),
        false => f64::from(u8::from(i == j + 1)),
    });
    let part = |part: f64| BigRational::from_float(part).map(|part| part * (BigInt::one() << size));
    let found = eigenvalues(&companion).unwrap_or_default().into_iter().filter(|root| root.im >= 0.0);
    found.filter_map(|root| Some(Complex::new(part(root.re)?, part(root.im)?))).collect()
}

/// A root by Newton's iteration over the Gaussian integers; `None` if it ends at none.
fn newton(polynomial: &[BigInt], mut at: Complex<BigInt>) -> Option<Complex<BigInt>> {
    for _ in 0..STEPS {
        let (mut value, mut slope) = (Complex::<BigInt>::zero(), Complex::<BigInt>::zero());
        for c in polynomial.iter().rev() {
            slope = &slope * &at + &value;
            value = &value * &at + Complex::new(c.clone(), BigInt::zero());
        }
        if value.is_zero() {
            let positive = Complex::new(at.re, at.im.abs());
            return Some(positive);
        }
        let size = slope.norm_sqr();
        if size.is_zero() {
            return None;
        }
        let step = value * slope.conj();
        let step = Complex::new(rounded(step.re, &size), rounded(step.im, &size));
        if step.is_zero() {
            return None;
        }
        at -= step;
    }
    None
}

/// n/d to the nearest integer, d > 0.
fn rounded(n: BigInt, d: &BigInt) -> BigInt {
    (n * BigInt::from(2) + d).div_floor(&(d * BigInt::from(2)))
}
