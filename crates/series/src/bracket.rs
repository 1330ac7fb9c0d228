//! The Poisson bracket.
//!
//! Convention: {f; g} = Σ ∂f/∂q ∂g/∂p − ∂f/∂p ∂g/∂q over the pairs (q, p), so that {q; p} = 1 (theory §1). A *canonical* pair is a pair of variable slots (q,
//! p). A *reciprocal* pair (q, r) represents a canonical pair (q, P) whose momentum P occurs only as r = 1/P. Then ∂/∂P = −r² ∂/∂r, hence {q; r} = −r².
//! Reciprocal pairs let polynomials contain a momentum in denominators.
//!
//! The bracket is computed without derivatives. Two terms with the exponents (j₁, k₁) and (j₂, k₂) of a pair contribute the product of their coefficients times
//! the integer weight j₁ k₂ − k₁ j₂. Cost: one coefficient product for each pair of terms whose weight is not 0.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::{check_slot, unit};
use crate::polynomial::{Polynomial, Truncation};
use crate::product::{Accumulator, Rule};

/// A Poisson structure on the variable slots.
///
/// ```
/// use andoyer_series::Polynomial;
/// use andoyer_series::lie::Poisson;
/// let poisson = Poisson::new(&[(0, 1)])?;
/// let [q, p] = ["q", "p"].map(|name| Polynomial::<f64>::parse(name, &["q", "p"]));
/// assert_eq!(poisson.bracket(&q?, &p?)?, Polynomial::constant(1.0));
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Poisson {
    rules: Vec<Rule>,
}

impl Poisson {
    /// The structure with the canonical pairs (q, p).
    ///
    /// # Errors
    /// - (0, 8): [`Error::SlotOutOfRange`];
    /// - (0, 1) and (1, 2): [`Error::SlotRepeated`].
    pub fn new(pairs: &[(usize, usize)]) -> Result<Self, Error> {
        let mut poisson = Poisson { rules: Vec::new() };
        for &(q, p) in pairs {
            check_slot(q).and(check_slot(p))?;
            poisson.push(Rule { first: q, second: p, sign: 1, raised: 0, lowered: unit(q) + unit(p) })?;
        }
        Ok(poisson)
    }

    /// This structure with an additional reciprocal pair (q, r): r = 1/P with P conjugate to q, and {q; r} = −r².
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// use andoyer_series::lie::Poisson;
    /// let poisson = Poisson::new(&[])?.with_reciprocal(0, 1)?;
    /// let parse = |text| Polynomial::<f64>::parse(text, &["q", "r"]);
    /// assert_eq!(poisson.bracket(&parse("q")?, &parse("r")?)?, parse("-r^2")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - (0, 8): [`Error::SlotOutOfRange`];
    /// - a slot that another pair already contains: [`Error::SlotRepeated`].
    pub fn with_reciprocal(mut self, q: usize, r: usize) -> Result<Self, Error> {
        check_slot(q).and(check_slot(r))?;
        self.push(Rule { first: q, second: r, sign: -1, raised: unit(r), lowered: unit(q) })?;
        Ok(self)
    }

    fn push(&mut self, rule: Rule) -> Result<(), Error> {
        let taken = |slot| self.rules.iter().any(|held| held.first == slot || held.second == slot);
        let repeated = [rule.first, rule.second].into_iter().find(|&slot| taken(slot));
        if let Some(slot) = repeated.or((rule.first == rule.second).then_some(rule.first)) {
            return Err(Error::SlotRepeated { slot });
        }
        self.rules.push(rule);
        Ok(())
    }

    /// The bracket {f; g}.
    ///
    /// # Errors
    /// - {q^20000 p; q^20000 p^2}: [`Error::ExponentOverflow`].
    pub fn bracket<C: Coefficient>(&self, f: &Polynomial<C>, g: &Polynomial<C>) -> Result<Polynomial<C>, Error> {
        self.bracket_within(f, g, None)
    }

    /// The bracket without the terms that `truncation` drops.
    ///
    /// ```
    /// use andoyer_series::{Polynomial, Truncation};
    /// use andoyer_series::lie::Poisson;
    /// let poisson = Poisson::new(&[(0, 1)])?;
    /// let parse = |text| Polynomial::<f64>::parse(text, &["q", "p"]);
    /// let bracket = poisson.bracket_truncated(&parse("q^2 + q^3")?, &parse("p^2")?, &Truncation::total(2))?;
    /// assert_eq!(bracket, parse("4*q*p")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - The errors of [`bracket`](Self::bracket), which dropped terms can cause as well.
    pub fn bracket_truncated<C: Coefficient>(
        &self,
        f: &Polynomial<C>,
        g: &Polynomial<C>,
        truncation: &Truncation,
    ) -> Result<Polynomial<C>, Error> {
        self.bracket_within(f, g, Some(truncation))
    }

    fn bracket_within<C: Coefficient>(
        &self,
        f: &Polynomial<C>,
        g: &Polynomial<C>,
        truncation: Option<&Truncation>,
    ) -> Result<Polynomial<C>, Error> {
        let mut sum = Accumulator::new(&[f], &[g]).within(truncation);
        sum.add_bracket((0, 0), &self.rules);
        sum.finish(&mut || Ok(()))
    }

    /// The Lie derivative of `f` along the flow of `hamiltonian`: L_h f = {f; h}, so that df/dt = L_h f (theory §3).
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// use andoyer_series::lie::Poisson;
    /// let parse = |text| Polynomial::<f64>::parse(text, &["q", "p"]);
    /// let poisson = Poisson::new(&[(0, 1)])?;
    /// assert_eq!(poisson.lie_derivative(&parse("q*p")?, &parse("p")?)?, parse("-p")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - The errors of [`bracket`](Self::bracket).
    pub fn lie_derivative<C: Coefficient>(
        &self,
        hamiltonian: &Polynomial<C>,
        f: &Polynomial<C>,
    ) -> Result<Polynomial<C>, Error> {
        self.bracket(f, hamiltonian)
    }

    /// Adds the bracket of a left and a right polynomial of `sum`; `pair` holds their positions.
    pub(crate) fn accumulate<C: Coefficient>(&self, sum: &mut Accumulator<'_, C>, pair: (usize, usize)) {
        sum.add_bracket(pair, &self.rules);
    }
}
