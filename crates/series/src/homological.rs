//! The homological equation of a diagonal quadratic part.
//!
//! Convention: h₀ = Σ λᵢ qᵢ pᵢ with the bracket of [`Poisson`](crate::bracket::Poisson), {q; p} = 1. Then S = q^j p^k is an eigenvector of S → {h₀; S} with the
//! eigenvalue Σ λᵢ (kᵢ − jᵢ). The kernel holds the terms with eigenvalue 0, and the image holds all other terms. The test for 0 is exact: with floating-point
//! λ, a resonance counts only if the sum is exactly 0. [`solve`](Homological::solve) returns the S with {h₀; S} = −image that Deprit's triangle needs: K_n =
//! H̃_n + {h₀; S_n} is the kernel part of H̃_n, or L_h₀(S_n) = {S_n; h₀} = H̃_n − K_n (theory §3, §4). Cost: one division for each term.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::monomial::check_slot;
use crate::polynomial::Polynomial;

/// The eigenvalues λᵢ of the unperturbed motion and their slots (qᵢ, pᵢ).
///
/// ```
/// use andoyer_series::Polynomial;
/// use andoyer_series::lie::{Homological, Poisson};
/// let parse = |text| Polynomial::<f64>::parse(text, &["q", "p"]);
/// let (homological, poisson) = (Homological::new(&[(0, 1, 2.0)])?, Poisson::new(&[(0, 1)])?);
/// let (kernel, image) = homological.split(&parse("q^2*p^2 + q^3*p")?);
/// assert_eq!(kernel, parse("q^2*p^2")?);
/// let generator = homological.solve(&image)?;
/// assert_eq!(poisson.bracket(&homological.unperturbed()?, &generator)?, -&image);
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Homological<C> {
    modes: Vec<(usize, usize, C)>,
}

impl<C: Coefficient> Homological<C> {
    /// The equation with the modes (slot of q, slot of p, λ).
    ///
    /// # Errors
    /// - (0, 8, λ): [`Error::SlotOutOfRange`];
    /// - (0, 1, λ) and (1, 2, λ): [`Error::SlotRepeated`].
    pub fn new(modes: &[(usize, usize, C)]) -> Result<Self, Error> {
        let mut seen = Vec::new();
        for slot in modes.iter().flat_map(|&(q, p, _)| [q, p]) {
            check_slot(slot)?;
            if seen.contains(&slot) {
                return Err(Error::SlotRepeated { slot });
            }
            seen.push(slot);
        }
        Ok(Homological { modes: modes.to_vec() })
    }

    /// The quadratic part h₀ = Σ λᵢ qᵢ pᵢ.
    ///
    /// # Errors
    /// - None for the modes that [`new`](Self::new) accepts.
    pub fn unperturbed(&self) -> Result<Polynomial<C>, Error> {
        let terms =
            self.modes.iter().map(|(q, p, lambda)| Ok((Monomial::ONE.with(*q, 1)?.with(*p, 1)?, lambda.clone())));
        Ok(Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?))
    }

    /// The eigenvalue Σ λᵢ (kᵢ − jᵢ) of S → {h₀; S} for a monomial.
    #[must_use]
    pub fn eigenvalue(&self, monomial: Monomial) -> C {
        let mut sum = C::zero();
        for (q, p, lambda) in &self.modes {
            let difference = i64::from(monomial.exponent(*p)) - i64::from(monomial.exponent(*q));
            sum += &lambda.times(difference);
        }
        sum
    }

    /// The kernel part and the image part of a polynomial.
    #[must_use]
    pub fn split(&self, polynomial: &Polynomial<C>) -> (Polynomial<C>, Polynomial<C>) {
        let in_kernel = |monomial: Monomial, _: &C| self.eigenvalue(monomial).is_zero();
        (polynomial.filter(in_kernel), polynomial.filter(|monomial, c| !in_kernel(monomial, c)))
    }

    /// The S without a kernel part that solves {h₀; S} = −`image`.
    ///
    /// # Errors
    /// - `image` = q p: [`Error::Resonant`].
    pub fn solve(&self, image: &Polynomial<C>) -> Result<Polynomial<C>, Error> {
        let solved = image.terms().map(|(monomial, c)| {
            let divisor = -self.eigenvalue(monomial);
            let quotient = c.divide(&divisor).ok_or(Error::Resonant { exponents: monomial.exponents() })?;
            Ok((monomial, quotient))
        });
        Ok(Polynomial::from_terms(solved.collect::<Result<Vec<_>, Error>>()?))
    }
}
