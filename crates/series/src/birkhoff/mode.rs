//! The modes of a diagonalized quadratic part, and the complex variables in which it is Σ −i ω u U.
//!
//! Every pair (q, p) of the normalized real variables has complex canonical variables (u, U), {u; U} = 1:
//!
//! ```text
//! elliptic    (a p² + b q²)/2, ab > 0    ω = ±√(ab), r = √(a/b):     q = r u − (i/2) U,  p = U/(2r) − i u;   uU = iI
//! hyperbolic  λ q p, λ > 0               ω = iλ:                     q = u,  p = U;                          uU = I = q p
//! complex     σ (q p + Q P) − ν (q P − Q p), the modes (q, p) and (Q, P) together:  ω = −ν + iσ and ν + iσ:
//!             u = (q − iQ)/2,  U = p + iP and their conjugates;      uU = (I + i I′)/2, I = q p + Q P, I′ = q P − Q p
//! ```
//!
//! An elliptic mode has q = √(2rI) sin φ, p = √(2I/r) cos φ, dφ/dt = ω. A hyperbolic mode has q ~ e^{λt}, p ~ e^{−λt}, so q is the unstable direction. The real
//! scales r avoid square roots, so everything is rational if the frequencies are.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;

/// One mode of the quadratic part.
///
/// ```
/// use andoyer_series::{PhaseSpace, normalize};
/// use andoyer_series::birkhoff::Mode;
/// let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?;
/// let saddle_and_centre = normalize(&space.parse::<f64>("(X^2 - 4*x^2)/2 + (Y^2 + y^2)/2")?, 0, &space)?;
/// let [Mode::Hyperbolic { rate }, centre] = saddle_and_centre.modes() else { panic!("{saddle_and_centre}") };
/// assert!((rate - 2.0).abs() < 1e-15 && *centre == Mode::Elliptic { frequency: 1.0, ratio: 1.0 });
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Mode<R> {
    /// A centre, (a p² + b q²)/2 with ab > 0.
    Elliptic {
        /// ω = ±√(ab), with the sign of a and b.
        frequency: R,
        /// r = √(a/b).
        ratio: R,
    },
    /// A saddle, λ q p.
    Hyperbolic {
        /// λ > 0.
        rate: R,
    },
    /// One of the two modes of a quartet of eigenvalues ±σ ± iν.
    Complex {
        /// σ > 0.
        rate: R,
        /// ν > 0 in the first mode of the two, −ν in the second.
        frequency: R,
        /// The number of the other mode.
        partner: usize,
    },
}

impl<R> Mode<R> {
    /// This mode with `function` applied to its numbers, for example to convert them to floats.
    pub(crate) fn map<S>(&self, function: impl Fn(&R) -> S) -> Mode<S> {
        match self {
            Mode::Elliptic { frequency, ratio } => {
                Mode::Elliptic { frequency: function(frequency), ratio: function(ratio) }
            }
            Mode::Hyperbolic { rate } => Mode::Hyperbolic { rate: function(rate) },
            Mode::Complex { rate, frequency, partner } => {
                Mode::Complex { rate: function(rate), frequency: function(frequency), partner: *partner }
            }
        }
    }
}

/// A complex number as (re, im).
type Parts<R> = (R, R);

impl<R: RealField> Mode<R> {
    /// ω: real for a centre, iλ for a saddle, iσ ∓ ν for the modes of a quartet.
    pub fn frequency(&self) -> R::Complex {
        match self {
            Mode::Elliptic { frequency, .. } => R::complex(frequency.clone(), R::zero()),
            Mode::Hyperbolic { rate } => R::complex(R::zero(), rate.clone()),
            Mode::Complex { rate, frequency, .. } => R::complex(-frequency.clone(), rate.clone()),
        }
    }

    /// The name of the kind: "elliptic", "hyperbolic" or "complex".
    pub fn kind(&self) -> &'static str {
        match self {
            Mode::Elliptic { .. } => "elliptic",
            Mode::Hyperbolic { .. } => "hyperbolic",
            Mode::Complex { .. } => "complex",
        }
    }

    /// r = √(a/b) of a centre; `None` for other modes.
    pub fn ratio(&self) -> Option<&R> {
        if let Mode::Elliptic { ratio, .. } = self { Some(ratio) } else { None }
    }

    /// Whether this is a centre.
    pub fn is_elliptic(&self) -> bool {
        matches!(self, Mode::Elliptic { .. })
    }
}

/// The modulus √(re² + im²) of a number, in floats.
pub(crate) fn modulus<R: RealField>(value: &R::Complex) -> f64 {
    let (re, im) = R::parts(value);
    re.to_float().hypot(im.to_float())
}

/// The real variables q₁, p₁, q₂, … as linear forms in u₁, U₁, u₂, …
pub(crate) fn real_in_complex<R: RealField>(modes: &[Mode<R>]) -> Result<Vec<Polynomial<R::Complex>>, Error> {
    let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
    let (zero, one) = (R::zero, R::one);
    let mut forms = Vec::new();
    for (mode, kind) in modes.iter().enumerate() {
        let (u, momentum) = (2 * mode, 2 * mode + 1);
        let pair: [Vec<(usize, Parts<R>)>; 2] = match kind {
            Mode::Elliptic { ratio, .. } => {
                let inverse = half.divide(ratio).ok_or(Error::DivisionByZero)?;
                [
                    vec![(u, (ratio.clone(), zero())), (momentum, (zero(), -half.clone()))],
                    vec![(u, (zero(), -one())), (momentum, (inverse, zero()))],
                ]
            }
            Mode::Hyperbolic { .. } => [vec![(u, (one(), zero()))], vec![(momentum, (one(), zero()))]],
            Mode::Complex { partner, frequency, .. } => {
                let (other, other_momentum) = (2 * partner, 2 * partner + 1);
                if frequency.sign() > 0 {
                    [
                        vec![(u, (one(), zero())), (other, (one(), zero()))],
                        vec![(momentum, (half.clone(), zero())), (other_momentum, (half.clone(), zero()))],
                    ]
                } else {
                    [
                        vec![(other, (zero(), one())), (u, (zero(), -one()))],
                        vec![(other_momentum, (zero(), -half.clone())), (momentum, (zero(), half.clone()))],
                    ]
                }
            }
        };
        for terms in pair {
            forms.push(form::<R>(terms)?);
        }
    }
    Ok(forms)
}

/// The complex variables u₁, U₁, u₂, … as linear forms in q₁, p₁, q₂, …
pub(crate) fn complex_in_real<R: RealField>(modes: &[Mode<R>]) -> Result<Vec<Polynomial<R::Complex>>, Error> {
    let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
    let (zero, one) = (R::zero, R::one);
    let mut forms = Vec::new();
    for (mode, kind) in modes.iter().enumerate() {
        let (q, p) = (2 * mode, 2 * mode + 1);
        let pair: [Vec<(usize, Parts<R>)>; 2] = match kind {
            Mode::Elliptic { ratio, .. } => {
                let inverse = half.divide(ratio).ok_or(Error::DivisionByZero)?;
                [
                    vec![(q, (inverse, zero())), (p, (zero(), half.clone()))],
                    vec![(q, (zero(), one())), (p, (ratio.clone(), zero()))],
                ]
            }
            Mode::Hyperbolic { .. } => [vec![(q, (one(), zero()))], vec![(p, (one(), zero()))]],
            Mode::Complex { partner, frequency, .. } => {
                let first = frequency.sign() > 0;
                let [(a, b), (c, d)] = if first {
                    [(q, p), (2 * partner, 2 * partner + 1)]
                } else {
                    [(2 * partner, 2 * partner + 1), (q, p)]
                };
                let sign = if first { one() } else { -one() };
                let mut turned = -half.clone();
                turned *= &sign;
                [
                    vec![(a, (half.clone(), zero())), (c, (zero(), turned))],
                    vec![(b, (one(), zero())), (d, (zero(), sign))],
                ]
            }
        };
        for terms in pair {
            forms.push(form::<R>(terms)?);
        }
    }
    Ok(forms)
}

fn form<R: RealField>(terms: Vec<(usize, Parts<R>)>) -> Result<Polynomial<R::Complex>, Error> {
    let terms = terms.into_iter().map(|(slot, (re, im))| Ok((Monomial::ONE.with(slot, 1)?, R::complex(re, im))));
    Ok(Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?))
}

/// Substitutes the linear form number i for the variable of slot i in `f`, by Horner's rule in one variable after the other.
pub(crate) fn substitute<C: Coefficient>(f: &Polynomial<C>, forms: &[Polynomial<C>]) -> Result<Polynomial<C>, Error> {
    replace(f.terms().map(|(monomial, c)| (monomial, c.clone())).collect(), forms, 0)
}

fn replace<C: Coefficient>(
    terms: Vec<(Monomial, C)>,
    forms: &[Polynomial<C>],
    slot: usize,
) -> Result<Polynomial<C>, Error> {
    let Some(form) = forms.get(slot) else { return Ok(Polynomial::from_terms(terms)) };
    let mut by_power: std::collections::BTreeMap<u32, Vec<(Monomial, C)>> = std::collections::BTreeMap::new();
    for (monomial, c) in terms {
        by_power.entry(monomial.exponent(slot)).or_default().push((monomial.with(slot, 0)?, c));
    }
    let Some(&highest) = by_power.keys().next_back() else { return Ok(Polynomial::zero()) };
    let mut sum = Polynomial::zero();
    for power in (0..=highest).rev() {
        if !sum.is_zero() {
            sum = sum.multiply(form)?;
        }
        if let Some(part) = by_power.remove(&power) {
            sum += &replace(part, forms, slot + 1)?;
        }
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bracket::Poisson;
    use num_complex::Complex;
    use num_rational::BigRational;

    #[test]
    fn complex_variables_are_canonical_and_give_the_quadratic_part() -> Result<(), Error> {
        let ratio = |p, q| BigRational::new(i64::into(p), i64::into(q));
        let modes = [
            Mode::Complex { rate: ratio(3, 1), frequency: ratio(2, 1), partner: 2 },
            Mode::Elliptic { frequency: ratio(-5, 1), ratio: ratio(2, 3) },
            Mode::Complex { rate: ratio(3, 1), frequency: ratio(-2, 1), partner: 0 },
            Mode::Hyperbolic { rate: ratio(7, 1) },
        ];
        let (real, complex) = (real_in_complex(&modes)?, complex_in_real(&modes)?);
        let poisson = Poisson::new(&[(0, 1), (2, 3), (4, 5), (6, 7)])?;
        for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
            let expected = Complex::integer(i64::from(i % 2 == 0 && j == i + 1) - i64::from(j % 2 == 0 && i == j + 1));
            assert_eq!(poisson.bracket(&complex[i], &complex[j])?, Polynomial::constant(expected), "{i}, {j}");
            assert_eq!(substitute(&real[i], &complex)?, Polynomial::variable(i)?);
        }
        let quadratic = Polynomial::parse(
            "3*(a*A + c*C) - 2*(a*C - c*A) - 5*(2/3*B^2 + 3/2*b^2)/2 + 7*d*D",
            &["a", "A", "b", "B", "c", "C", "d", "D"],
        )?;
        let mut expected = Polynomial::zero();
        for (mode, kind) in modes.iter().enumerate() {
            let uu = Monomial::ONE.with(2 * mode, 1)?.with(2 * mode + 1, 1)?;
            expected.add_term(uu, &(Complex::new(ratio(0, 1), ratio(-1, 1)) * kind.frequency()));
        }
        assert_eq!(substitute(&quadratic, &real)?, expected);
        Ok(())
    }
}
