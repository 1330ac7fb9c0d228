//! A normal form in the actions and, with resonant terms, in the resonant angles k·φ of the centres.
//!
//! A centre has U = √(2rI) e^{iφ} and u = i √(I/(2r)) e^{−iφ}, so uU = iI. A term with u^j U^l of each mode and k = l − j is uU to the power min(j, l), times
//! (2r)^{k/2} I^{|k|/2} e^{ikφ}, times i^{|k|} if k < 0. The terms of k and of −k are complex conjugates. Together they are a cosine and a sine of k·φ.

use super::BirkhoffNormalForm;
use super::mode::{Mode, substitute};
use super::phase_space::PhaseSpace;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use std::collections::BTreeMap;

/// Largest integer under a square root that is searched.
const LARGEST_ROOT: i64 = 1000;

/// The terms of a normal form with one angle k·φ: √radicand Π Iᵢ^{|kᵢ|/2} (cosine · cos k·φ + sine · sin k·φ).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AnglePart<R: RealField> {
    /// k, then the integers j of the driven phases: the angle is k·φ + j·M. The first entry other than 0 is positive.
    pub multiples: Vec<i64>,
    /// A positive number whose square root is a factor of all terms; 1 if the root belongs to the numbers R.
    pub radicand: R,
    /// The factor of cos k·φ, a polynomial in the actions and the parameters.
    pub cosine: Polynomial<R>,
    /// The factor of sin k·φ, a polynomial in the actions and the parameters.
    pub sine: Polynomial<R>,
}

/// A k and the terms with the angle k·φ: exponents and the factors of cosine and sine.
pub type AngleTerms = (Vec<i64>, Vec<(Vec<u32>, [f64; 2])>);

impl<R: RealField> BirkhoffNormalForm<R> {
    /// The normal form in the actions, including the offset: Iᵢ is in slot i, and the parameters follow.
    ///
    /// I is (q²/r + r p²)/2 for a centre and q p for a saddle. For the two modes (q, p), (Q, P) of a quartet the actions are q p + Q P and q P − Q p.
    ///
    /// # Errors
    /// - resonant terms: [`Error::ResonantTerm`].
    pub fn in_actions(&self) -> Result<Polynomial<R>, Error> {
        let (mean, parts) = self.by_angles(&self.in_complex(), |_| false)?;
        debug_assert!(parts.is_empty(), "every other term is refused");
        Ok(mean)
    }

    /// The normal form in the actions and the resonant angles, including the offset: the part without angles as in [`in_actions`](Self::in_actions), and a
    /// part for each angle k·φ. Centres have q = √(2rI) sin φ, p = √(2I/r) cos φ.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize_with};
    /// use andoyer_series::birkhoff::Resonances;
    /// use andoyer_series::progress::quiet;
    /// use num_rational::BigRational;
    /// let space = PhaseSpace::new(&[("x", "p"), ("y", "P")])?;
    /// let spring = space.parse::<BigRational>("(p^2 + x^2)/2 + (P^2 + 4*y^2)/2 + x^2*y")?;
    /// let form = normalize_with(&spring, 1, &space, &Resonances::new(&[&[2, -1]])?, &mut quiet)?;
    /// let (mean, parts) = form.in_angles()?;
    /// assert_eq!(mean.display(&["I", "J"]).to_string(), "I + 2*J");
    /// // I √J sin(2φ − ψ)/2
    /// assert_eq!((&parts[0].multiples[..], parts[0].sine.display(&["I"]).to_string()), (&[2, -1][..], "1/2".to_owned()));
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - resonant terms of a saddle or a quartet, which have no angle: [`Error::ResonantTerm`].
    pub fn in_angles(&self) -> Result<(Polynomial<R>, Vec<AnglePart<R>>), Error> {
        self.angles_of(&self.in_complex())
    }

    /// The terms of [`in_angles`](Self::in_angles) in floats: for each k, with 0 first, the factors of cos k·φ and sin k·φ by exponents of √I₁, √I₂, …,
    /// parameters.
    ///
    /// # Errors
    /// - The errors of [`in_angles`](Self::in_angles).
    pub fn angle_terms(&self) -> Result<Vec<AngleTerms>, Error> {
        let (mean, parts) = self.in_angles()?;
        let modes = self.modes().len();
        let none = AnglePart {
            multiples: vec![0; modes + self.space.driven().len()],
            radicand: R::one(),
            cosine: mean,
            sine: Polynomial::zero(),
        };
        let terms = |part: &AnglePart<R>| {
            let root = part.radicand.to_float().sqrt();
            let mut sum = part.cosine.map(|c| R::complex(c.clone(), R::zero()));
            sum += &part.sine.map(|c| R::complex(R::zero(), c.clone()));
            let term = |(monomial, c): (Monomial, &R::Complex)| {
                let power = |slot: usize| monomial.exponent(slot);
                let actions = (0..modes).map(|mode| 2 * power(mode) + part.multiples[mode].unsigned_abs() as u32);
                let parameters = (0..self.space.parameters()).map(|j| power(modes + j));
                let (cosine, sine) = R::parts(c);
                (actions.chain(parameters).collect(), [root * cosine.to_float(), root * sine.to_float()])
            };
            sum.terms().map(term).collect()
        };
        Ok(std::iter::once(&none).chain(&parts).map(|part| (part.multiples.clone(), terms(part))).collect())
    }

    /// A polynomial in the complex variables of this form in actions and angles.
    pub(super) fn angles_of(
        &self,
        polynomial: &Polynomial<R::Complex>,
    ) -> Result<(Polynomial<R>, Vec<AnglePart<R>>), Error> {
        self.by_angles(polynomial, |k| k.iter().zip(self.modes()).all(|(&k, mode)| k == 0 || mode.is_elliptic()))
    }

    /// The terms without angles and those with angles k·φ, for the k that `allowed` accepts.
    fn by_angles(
        &self,
        polynomial: &Polynomial<R::Complex>,
        allowed: impl Fn(&[i64]) -> bool,
    ) -> Result<(Polynomial<R>, Vec<AnglePart<R>>), Error> {
        let modes = self.modes().len();
        let mut products = BTreeMap::<Vec<i64>, Polynomial<R::Complex>>::new();
        for (monomial, c) in polynomial.terms() {
            let k = self.space.turns(monomial);
            let turning = k.iter().find(|&&k| k != 0);
            if turning.is_some() && !allowed(&k) {
                let term = Polynomial::from_terms([(monomial, 1.0)]);
                return Err(Error::ResonantTerm { term: self.space.complex_text(&term) });
            }
            // The terms of −k are the complex conjugates.
            if turning.is_some_and(|&first| first < 0) {
                continue;
            }
            let powers = (0..modes).map(|mode| monomial.exponent(2 * mode).min(monomial.exponent(2 * mode + 1)));
            let parameters = (0..self.space.parameters()).map(|j| monomial.exponent(2 * modes + j));
            let target = Monomial::new(&powers.chain(parameters).collect::<Vec<_>>())?;
            products.entry(k).or_default().add_term(target, c);
        }
        let images = self.modes().iter().enumerate().map(|(mode, kind)| self.action_form(mode, kind));
        let images = images.collect::<Result<Vec<_>, Error>>()?;
        let (mut mean, mut parts) = (Polynomial::zero(), Vec::new());
        for (k, products) in products {
            let polynomial = substitute(&products, &images)?;
            if k.iter().all(|&k| k == 0) {
                mean = polynomial.map(|c| R::parts(c).0);
            } else {
                parts.push(self.angle_part(k, &polynomial)?);
            }
        }
        parts.sort_by_key(|part| part.multiples.iter().map(|k| k.unsigned_abs()).sum::<u64>());
        Ok((mean, parts))
    }

    /// 2 Re (polynomial · Π (2r)^{k/2} i^{|k|, k < 0} e^{ik·φ}).
    fn angle_part(&self, k: Vec<i64>, polynomial: &Polynomial<R::Complex>) -> Result<AnglePart<R>, Error> {
        let (mut size, mut radicand) = (R::integer(2), R::one());
        for (&k, mode) in k.iter().zip(self.modes()) {
            let Some(double) = mode.ratio().map(|ratio| ratio.times(2)) else { continue };
            let inverse = double.invert().ok_or(Error::DivisionByZero)?;
            for _ in 0..k.div_euclid(2).unsigned_abs() {
                size *= if k > 0 { &double } else { &inverse };
            }
            if k.rem_euclid(2) == 1 {
                radicand *= &double;
            }
        }
        // √radicand = √(radicand · s)/s · √s, with the smallest integer s that makes the first root rational.
        let rational = |s: i64| Some((R::integer(s), radicand.geometric_mean(&R::integer(s))?));
        if let Some((small, root)) = (1..=LARGEST_ROOT).find_map(rational) {
            size *= &root;
            size = size.divide(&small).ok_or(Error::DivisionByZero)?;
            radicand = small;
        }
        let quarters = k.iter().take(self.modes().len()).filter(|&&k| k < 0).map(|k| k.unsigned_abs()).sum::<u64>();
        let factor = match quarters % 4 {
            0 => R::complex(size, R::zero()),
            1 => R::complex(R::zero(), size),
            2 => R::complex(-size, R::zero()),
            _ => R::complex(R::zero(), -size),
        };
        let scaled = polynomial.map(|c| {
            let mut product = c.clone();
            product *= &factor;
            product
        });
        let (cosine, sine) = (scaled.map(|c| R::parts(c).0), scaled.map(|c| -R::parts(c).1));
        Ok(AnglePart { multiples: k, radicand, cosine, sine })
    }

    /// The product u U of a mode as a function of the actions.
    fn action_form(&self, mode: usize, kind: &Mode<R>) -> Result<Polynomial<R::Complex>, Error> {
        let action = |mode: usize, re, im| Ok::<_, Error>((Monomial::ONE.with(mode, 1)?, R::complex(re, im)));
        let terms = match kind {
            Mode::Elliptic { .. } => vec![action(mode, R::zero(), R::one())?],
            Mode::Hyperbolic { .. } => vec![action(mode, R::one(), R::zero())?],
            Mode::Complex { frequency, partner, .. } => {
                let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
                if frequency.sign() > 0 {
                    vec![action(mode, half.clone(), R::zero())?, action(*partner, R::zero(), half)?]
                } else {
                    vec![action(*partner, half.clone(), R::zero())?, action(mode, R::zero(), -half)?]
                }
            }
        };
        Ok(Polynomial::from_terms(terms))
    }

    /// The actions by name, as in [`action_texts`].
    pub(super) fn action_texts(&self) -> Vec<String> {
        action_texts(self.modes(), self.space())
    }
}

/// The actions by name: `I_q` for a centre, (q*p) for a saddle, (q*p + Q*P) and (q*P - Q*p) for the modes of a quartet; then the parameters.
pub(crate) fn action_texts<R: RealField>(modes: &[Mode<R>], space: &PhaseSpace) -> Vec<String> {
    let (names, actions) = (space.names(), space.action_names());
    let mut texts = actions.clone();
    for (mode, kind) in modes.iter().enumerate() {
        let [q, p] = [names[2 * mode], names[2 * mode + 1]];
        match kind {
            Mode::Elliptic { .. } => {}
            Mode::Hyperbolic { .. } => texts[mode] = format!("({q}*{p})"),
            Mode::Complex { frequency, partner, .. } => {
                let [other, momentum] = [names[2 * partner], names[2 * partner + 1]];
                texts[mode] = if frequency.sign() > 0 {
                    format!("({q}*{p} + {other}*{momentum})")
                } else {
                    format!("({other}*{p} - {q}*{momentum})")
                };
            }
        }
    }
    texts
}
