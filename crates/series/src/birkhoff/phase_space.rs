//! The variables of a Hamiltonian: conjugate pairs (q, p), then parameters.
//!
//! Convention: pair number i has q in slot 2i and p in slot 2i + 1, {q; p} = 1; the parameters follow and commute with
//! everything. So polynomials, exponents and states list the variables as q₁, p₁, q₂, p₂, …. The monomials have eight
//! slots: up to four degrees of freedom, or three with two parameters.
//! The same slots hold the complex variables (u, U) of a normal form, printed as `u_q`, `U_q` for the pair (q, p).

use crate::parse::check_names;
use crate::{Coefficient, Error, Poisson, Polynomial, SLOTS};

/// The named variables of a Hamiltonian.
///
/// ```
/// use andoyer_series::PhaseSpace;
/// use num_rational::BigRational;
/// let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?.with_parameters(&["b"])?;
/// let hamiltonian = space.parse::<BigRational>("(x^2 + X^2 + y^2 + Y^2)/2 + b*x^2*y")?;
/// assert_eq!(space.names(), ["x", "X", "y", "Y", "b"]);
/// assert_eq!(space.poisson()?.bracket(&space.parse("x")?, &hamiltonian)?, space.parse("X")?);
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct PhaseSpace {
    names: Vec<String>,
    degrees_of_freedom: usize,
}

impl PhaseSpace {
    /// The space of the pairs (q, p), without parameters.
    ///
    /// # Errors
    /// - no pair, or five: [`Error::PhaseSpaceSize`];
    /// - ("x", "x"), ("x", "2y"): [`Error::Parse`], the name is taken or no identifier.
    pub fn new(pairs: &[(&str, &str)]) -> Result<Self, Error> {
        let names = pairs.iter().flat_map(|&(q, p)| [q.to_owned(), p.to_owned()]).collect();
        PhaseSpace { names, degrees_of_freedom: pairs.len() }.checked()
    }

    /// This space with parameters more: symbols in the coefficients, of degree 0.
    ///
    /// # Errors
    /// - three of them beside three pairs: [`Error::PhaseSpaceSize`];
    /// - a name that is taken or no identifier: [`Error::Parse`].
    pub fn with_parameters(mut self, names: &[&str]) -> Result<Self, Error> {
        self.names.extend(names.iter().map(|&name| name.to_owned()));
        self.checked()
    }

    fn checked(self) -> Result<Self, Error> {
        if self.degrees_of_freedom == 0 || self.names.len() > SLOTS {
            return Err(Error::PhaseSpaceSize {
                degrees_of_freedom: self.degrees_of_freedom,
                parameters: self.names.len().saturating_sub(2 * self.degrees_of_freedom),
                slots: SLOTS,
            });
        }
        check_names(&self.names())?;
        Ok(self)
    }

    /// Number of pairs.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.degrees_of_freedom
    }

    /// Number of parameters.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.names.len() - 2 * self.degrees_of_freedom
    }

    /// The names in the order of the slots: q₁, p₁, q₂, p₂, …, parameters.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.names.iter().map(String::as_str).collect()
    }

    /// Names for a polynomial in the complex variables: `u_q`, `U_q` for the pair (q, p), then the parameters.
    #[must_use]
    pub fn complex_names(&self) -> Vec<String> {
        let pairs = (0..self.degrees_of_freedom).map(|mode| &self.names[2 * mode]);
        let complex = pairs.flat_map(|q| [format!("u_{q}"), format!("U_{q}")]);
        complex.chain(self.names[2 * self.degrees_of_freedom..].iter().cloned()).collect()
    }

    /// Names for a polynomial in the actions: `I_q` for the pair (q, p), then the parameters.
    #[must_use]
    pub fn action_names(&self) -> Vec<String> {
        let actions = (0..self.degrees_of_freedom).map(|mode| format!("I_{}", self.names[2 * mode]));
        actions.chain(self.names[2 * self.degrees_of_freedom..].iter().cloned()).collect()
    }

    /// Reads a polynomial in these variables: [`Polynomial::parse`].
    ///
    /// # Errors
    /// - as [`Polynomial::parse`].
    pub fn parse<C: Coefficient>(&self, text: &str) -> Result<Polynomial<C>, Error> {
        Polynomial::parse(text, &self.names())
    }

    /// The bracket of the pairs.
    ///
    /// # Errors
    /// - none: the slots differ.
    pub fn poisson(&self) -> Result<Poisson, Error> {
        Poisson::new(&(0..self.degrees_of_freedom).map(|mode| (2 * mode, 2 * mode + 1)).collect::<Vec<_>>())
    }

    /// The slots of the pairs.
    pub(crate) fn phase_slots(&self) -> Vec<usize> {
        (0..2 * self.degrees_of_freedom).collect()
    }

    /// A polynomial as text, in names given as `String`.
    pub(crate) fn text<C: Coefficient>(polynomial: &Polynomial<C>, names: &[String]) -> String {
        polynomial.display(&names.iter().map(String::as_str).collect::<Vec<_>>()).to_string()
    }
}
