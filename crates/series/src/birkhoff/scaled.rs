//! Parameters that are replaced: by numbers, or by a scaling with a parameter to which all frequencies are proportional. The quadratic part then has numbers
//! as coefficients.

use super::PhaseSpace;
use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

impl PhaseSpace {
    /// Returns H with numbers in place of some parameters, and the space without these parameters.
    ///
    /// ```
    /// use andoyer_series::PhaseSpace;
    /// let space = PhaseSpace::new(&[("q", "p")])?.with_parameters(&["c", "d"])?;
    /// let (h, rest) = space.with_values(&space.parse("p^2/2 + q^2/2 + c^2*d*q^4")?, &[("c", 0.5)])?;
    /// assert_eq!((h, rest.names()), (rest.parse::<f64>("p^2/2 + q^2/2 + 0.25*d*q^4")?, vec!["q", "p", "d"]));
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - a name that is not a parameter: [`Error::ParameterUnknown`].
    pub fn with_values<C: Coefficient>(
        &self,
        hamiltonian: &Polynomial<C>,
        values: &[(&str, C)],
    ) -> Result<(Polynomial<C>, Self), Error> {
        let value = |slot: usize| values.iter().find(|(name, _)| self.names().get(slot) == Some(name)).map(|(_, c)| c);
        let space = self.without(&values.iter().map(|(name, _)| *name).collect::<Vec<_>>())?;
        let mut replaced = Polynomial::zero();
        for (monomial, c) in hamiltonian.terms() {
            let (mut c, mut exponents) = (c.clone(), Vec::new());
            for slot in 0..self.driven_slots().end {
                match value(slot) {
                    Some(value) => (0..monomial.exponent(slot)).for_each(|_| c *= value),
                    None => exponents.push(monomial.exponent(slot)),
                }
            }
            replaced.add_term(Monomial::new(&exponents)?, &c);
        }
        Ok((replaced, space))
    }

    /// Returns H/w in the variables x = q√w, y = p/√w, with the parameter s = 1/√w in place of the parameter w, and the space of these variables.
    ///
    /// `letter` is the name of w, `root` the name of s. Divisors k·ω with the parameter w are not polynomials; after the scaling the frequencies are numbers. A
    /// term c qᵃ pᵇ wᵐ becomes c xᵃ yᵇ s^(a−b−2m+2). The motion is that of H in the time wt, and K of H is w times K of H/w. Terms without variables do not
    /// change the motion, and are dropped.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize};
    /// use andoyer_series::num_rational::BigRational;
    /// let space = PhaseSpace::new(&[("q", "p")])?.with_parameters(&["w"])?;
    /// let (scaled, space) = space.scaled(&space.parse::<BigRational>("p^2/2 + w^2*q^2/2 + q^4/4")?, "w", "s")?;
    /// assert_eq!(scaled, space.parse("(p^2 + q^2)/2 + s^6*q^4/4")?);
    /// assert_eq!(normalize(&scaled, 2, &space)?.to_string(), "I_q + 3/8*I_q^2*s^6"); // K = w I + 3 I²/(8 w²)
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `letter` is not a parameter: [`Error::ParameterUnknown`]; `root` is taken or is not an identifier: [`Error::Parse`];
    /// - a space with driven phases: [`Error::DrivenUnsupported`];
    /// - p²/2 + q²/2 + w² y²/2 …, whose other frequencies are not proportional to w, and w² p⁴, which has s^(−6): [`Error::FrequencyLetter`].
    pub fn scaled<C: Coefficient>(
        &self,
        hamiltonian: &Polynomial<C>,
        letter: &str,
        root: &str,
    ) -> Result<(Polynomial<C>, Self), Error> {
        if !self.driven().is_empty() {
            let problem = "has frequencies that are not proportional to a parameter: no parameter can be scaled away";
            return Err(Error::DrivenUnsupported { problem });
        }
        let space = self.with_renamed(letter, root)?.with_degree(root, 0)?;
        let (names, pairs) = (space.names(), 2 * self.degrees_of_freedom());
        let slot = names.iter().position(|name| *name == root).unwrap_or(pairs);
        let mut scaled = Polynomial::zero();
        for (monomial, c) in hamiltonian.terms().filter(|(monomial, _)| monomial.degree_in(&self.phase_slots()) > 0) {
            let mut exponents = monomial.exponents()[..names.len()].to_vec();
            let sum = |first: usize| exponents[first..pairs].iter().step_by(2).map(|&e| i64::from(e)).sum::<i64>();
            let power = sum(0) - sum(1) - 2 * i64::from(exponents[slot]) + 2;
            let quadratic = monomial.degree_in(&self.phase_slots()) == 2;
            let valid = u32::try_from(power).ok().filter(|power| !quadratic || *power == 0);
            exponents[slot] = valid.ok_or_else(|| Error::FrequencyLetter {
                letter: letter.to_owned(),
                term: self.text(&Polynomial::from_terms([(monomial, c.clone())]), &self.owned_names()),
                power,
            })?;
            scaled.add_term(Monomial::new(&exponents)?, c);
        }
        Ok((scaled, space))
    }
}
