//! Polynomials in one unknown over the rationals: square-free parts, real roots by Sturm's theorem, sums of pairs of roots.
//!
//! Every step is exact. A monic polynomial with integer coefficients has only integers among its rational roots, so that an interval of length 1 holds one
//! candidate. Sources: D. Y. Y. Yun, *On square-free decomposition algorithms* (SYMSAC 1976); H. Cohen, *A Course in Computational Algebraic Number Theory*
//! (1993), §§ 3.6 and 4.1.

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Bisections of an interval of length 1 around an irrational root: its figure is right to a double's precision.
const BISECTIONS: usize = 80;

/// A real root of a monic polynomial with integer coefficients.
pub(super) enum RealRoot {
    Integer(BigInt),
    Irrational(f64),
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

    /// x − root.
    pub(super) fn factor(root: &BigInt) -> Self {
        Univariate(vec![BigRational::from_integer(-root), BigRational::one()])
    }

    pub(super) fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    pub(super) fn coefficients(&self) -> &[BigRational] {
        &self.0
    }

    fn value(&self, x: &BigRational) -> BigRational {
        self.0.iter().rev().fold(BigRational::zero(), |sum, c| sum * x + c)
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

    pub(super) fn quotient(&self, divisor: &Self) -> Self {
        self.divided(divisor).0
    }

    /// The monic greatest common divisor.
    pub(super) fn gcd(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.clone(), other.clone());
        while !b.0.is_empty() {
            (a, b) = (b.clone(), a.divided(&b).1);
        }
        let last = a.0.last().cloned().unwrap_or_else(BigRational::one);
        Univariate(a.0.iter().map(|c| c / &last).collect())
    }

    /// Square-free factors of a monic polynomial, each with the multiplicity of its roots (Yun).
    pub(super) fn square_free(&self) -> Vec<(Self, usize)> {
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
                parts.push((part, multiplicity));
            }
        }
        parts
    }

    /// The real roots of a monic square-free polynomial with integer coefficients, in ascending order.
    pub(super) fn real_roots(&self) -> Vec<RealRoot> {
        let mut chain = vec![self.clone(), self.derivative()];
        while let [.., a, b] = chain.as_slice()
            && b.degree() > 0
        {
            let rest = a.divided(b).1;
            chain.push(Univariate(rest.0.iter().map(|c| -c).collect()));
        }
        // Cauchy: |x| ≤ 1 + max |c|.
        let largest = self.0.iter().map(|c| c.abs().ceil().to_integer()).max().unwrap_or_default() + BigInt::one();
        let mut roots = Vec::new();
        isolate(&chain, -&largest, largest, &mut roots);
        roots
    }

    /// The monic polynomial whose roots are the sums xᵢ + xⱼ, i < j, of the roots of this monic polynomial, from its power sums by Newton's identities.
    pub(super) fn sums_of_pairs(&self) -> Self {
        let pairs = self.degree() * (self.degree() - 1) / 2;
        let own = self.power_sums(pairs);
        let integer = |n: BigInt| BigRational::from_integer(n);
        let power = |k: usize| {
            let mut sum = -&own[k] * integer(BigInt::one() << k);
            let mut binomial = BigInt::one();
            for j in 0..=k {
                sum += &own[j] * &own[k - j] * integer(binomial.clone());
                binomial = binomial * BigInt::from(k - j) / BigInt::from(j + 1);
            }
            sum / integer(2.into())
        };
        let powers: Vec<BigRational> = (0..=pairs).map(power).collect();
        // k e_k = −Σ p_j e_{k−j}, where e_k is the coefficient of x^(pairs − k).
        let mut descending = vec![BigRational::one()];
        for k in 1..=pairs {
            let sum = (1..=k).fold(BigRational::zero(), |sum, j| sum + &powers[j] * &descending[k - j]);
            descending.push(-sum / integer(k.into()));
        }
        descending.reverse();
        Univariate::new(descending)
    }

    /// Σ xᵢᵏ for k = 0 … `highest`, by Newton's identities.
    fn power_sums(&self, highest: usize) -> Vec<BigRational> {
        let degree = self.degree();
        let mut sums = vec![BigRational::from_integer(degree.into())];
        for k in 1..=highest {
            let mut sum = BigRational::zero();
            for j in 1..=k.min(degree) {
                let factor = if j == k { BigRational::from_integer(k.into()) } else { sums[k - j].clone() };
                sum -= &self.0[degree - j] * factor;
            }
            sums.push(sum);
        }
        sums
    }

    /// (E, O) of p(shift + x) = E(x²) + x O(x²).
    pub(super) fn even_and_odd(&self, shift: &BigInt) -> (Self, Self) {
        let shift = BigRational::from_integer(shift.clone());
        let mut c = self.0.clone();
        for first in 0..c.len() {
            for k in (first..c.len() - 1).rev() {
                let above = &c[k + 1] * &shift;
                c[k] += above;
            }
        }
        let every_second = |first: usize| Univariate::new(c.iter().skip(first).step_by(2).cloned().collect());
        (every_second(0), every_second(1))
    }
}

/// The number of sign changes of Sturm's chain at x.
fn changes(chain: &[Univariate], x: &BigRational) -> usize {
    let signs = chain.iter().map(|p| p.value(x)).filter(|value| !value.is_zero()).map(|value| value.is_negative());
    let signs: Vec<bool> = signs.collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// The number of roots in (low, high].
fn count(chain: &[Univariate], low: &BigRational, high: &BigRational) -> usize {
    changes(chain, low).saturating_sub(changes(chain, high))
}

/// Adds the roots in (low, high].
fn isolate(chain: &[Univariate], low: BigInt, high: BigInt, roots: &mut Vec<RealRoot>) {
    let [from, to] = [&low, &high].map(|end| BigRational::from_integer(end.clone()));
    let number = count(chain, &from, &to);
    if number == 0 {
        return;
    }
    if &high - &low > BigInt::one() {
        let middle: BigInt = (&low + &high).div_floor(&2.into());
        isolate(chain, low, middle.clone(), roots);
        isolate(chain, middle, high, roots);
        return;
    }
    let at_end = chain[0].value(&to).is_zero();
    if number > usize::from(at_end) {
        roots.push(RealRoot::Irrational(figure(chain, from, to)));
    }
    if at_end {
        roots.push(RealRoot::Integer(high));
    }
}

/// The smallest root in (low, high], as a float.
fn figure(chain: &[Univariate], mut low: BigRational, mut high: BigRational) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = (&low + &high) / BigInt::from(2);
        if count(chain, &low, &middle) > 0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    high.to_f64().unwrap_or(f64::INFINITY)
}
