//! The variables of a Hamiltonian: conjugate pairs (q, p), then parameters, then driven phases.
//!
//! Convention: pair number i has q in slot 2i and p in slot 2i + 1, with {q; p} = 1. The parameters follow and commute with everything. Polynomials, exponents
//! and states therefore list the variables as q₁, p₁, q₂, p₂, …. A monomial has eight slots, enough for four degrees of freedom, or for three with two
//! parameters or two driven phases. A driven phase M moves with a given frequency and has no momentum. Its slot holds a harmonic (`harmonics`): cos jM or sin jM in
//! real polynomials, e^{ijM} in complex ones. The same slots hold the complex variables (u, U) of a normal form, which are printed as `u_q`, `U_q` for the pair (q, p).

use crate::bracket::Poisson;
use crate::coefficient::Coefficient;
use crate::display::Harmonics;
use crate::error::Error;
use crate::harmonics;
use crate::monomial::{Monomial, SLOTS};
use crate::parse::check_names;
use crate::polynomial::Polynomial;
use std::ops::Range;

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
    /// The given degrees of the parameters; `None` if no degree was given.
    degrees: Vec<Option<u32>>,
    /// The driven phases.
    driven: Vec<String>,
}

impl PhaseSpace {
    /// The space of the pairs (q, p), without parameters.
    ///
    /// # Errors
    /// - no pair, or five: [`Error::PhaseSpaceSize`];
    /// - ("x", "x"), ("x", "2y"): [`Error::Parse`], because the name is taken or is not an identifier.
    pub fn new(pairs: &[(&str, &str)]) -> Result<Self, Error> {
        let names = pairs.iter().flat_map(|&(q, p)| [q.to_owned(), p.to_owned()]).collect();
        PhaseSpace { names, degrees_of_freedom: pairs.len(), degrees: Vec::new(), driven: Vec::new() }.checked()
    }

    /// This space with additional parameters, which are symbols in the coefficients.
    ///
    /// A parameter that occurs in the quadratic part has degree 2 (a detuning, like d in d y²). Any other parameter has degree 0.
    /// [`with_degree`](Self::with_degree) sets another degree.
    ///
    /// # Errors
    /// - three parameters with three pairs: [`Error::PhaseSpaceSize`];
    /// - a name that is taken or is not an identifier: [`Error::Parse`].
    pub fn with_parameters(mut self, names: &[&str]) -> Result<Self, Error> {
        self.names.extend(names.iter().map(|&name| name.to_owned()));
        self.degrees.extend(names.iter().map(|_| None));
        self.checked()
    }

    /// This space with driven phases: angles that move with given frequencies, and that no momentum belongs to.
    ///
    /// A Hamiltonian contains them as cos(j*M) and sin(j*M) with integers j. [`normalize_driven`](crate::normalize_driven) has their frequencies.
    /// Their slots follow those of the parameters and do not count in a degree. [`harmonics`](Self::harmonics) reads them.
    ///
    /// ```
    /// use andoyer_series::PhaseSpace;
    /// let space = PhaseSpace::new(&[("q", "p")])?.with_driven(&["M"])?;
    /// let product = space.parse::<f64>("2*q*cos(M)*sin(-2*M)")?;
    /// assert_eq!(product, space.parse("-q*sin(M) - q*sin(3*M)")?);
    /// assert_eq!(product.terms().map(|(monomial, _)| space.harmonics(monomial)).collect::<Vec<_>>(), [[-1], [-3]]);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - three phases with three pairs: [`Error::PhaseSpaceSize`];
    /// - a name that is taken or is not an identifier: [`Error::Parse`].
    pub fn with_driven(mut self, names: &[&str]) -> Result<Self, Error> {
        self.driven.extend(names.iter().map(|&name| name.to_owned()));
        self.checked()
    }

    /// This space with a degree for a parameter. The degree states how small the parameter is compared with the variables, and so decides the order in which
    /// terms are removed.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize_with};
    /// use andoyer_series::birkhoff::Resonances;
    /// use andoyer_series::progress::quiet;
    /// use num_rational::BigRational;
    /// // Near the 1:1 resonance: frequencies 1 and 1 + d, the detuning d of degree 1.
    /// let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?.with_parameters(&["d"])?.with_degree("d", 1)?;
    /// let h = space.parse::<BigRational>("(x^2 + X^2)/2 + (1 + d)*(y^2 + Y^2)/2 + x^2*y^2")?;
    /// let resonant = normalize_with(&h, 2, &space, &Resonances::new(&[&[1, -1]])?, &mut quiet)?;
    /// let detuning = resonant.in_real()?.filter(|monomial, _| monomial.exponent(4) > 0);
    /// assert_eq!(detuning, space.parse("d*(y^2 + Y^2)/2")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - a name that is not a parameter: [`Error::ParameterUnknown`].
    pub fn with_degree(mut self, parameter: &str, degree: u32) -> Result<Self, Error> {
        let first = 2 * self.degrees_of_freedom;
        match self.names[first..].iter().position(|name| name == parameter) {
            Some(at) => self.degrees[at] = Some(degree),
            None => {
                let known = self.names[first..].join(", ");
                return Err(Error::ParameterUnknown { name: parameter.to_owned(), known });
            }
        }
        Ok(self)
    }

    /// This space without its driven phases.
    #[must_use]
    pub fn still(&self) -> Self {
        PhaseSpace { driven: Vec::new(), ..self.clone() }
    }

    /// This space with a new name for a parameter.
    pub(super) fn with_renamed(&self, parameter: &str, name: &str) -> Result<Self, Error> {
        let mut renamed = self.clone().with_degree(parameter, 0)?;
        for known in &mut renamed.names[2 * self.degrees_of_freedom..] {
            if known == parameter {
                name.clone_into(known);
            }
        }
        renamed.checked()
    }

    /// This space without some of its parameters.
    pub(super) fn without(&self, parameters: &[&str]) -> Result<Self, Error> {
        let mut rest = self.clone();
        for &parameter in parameters {
            // Refuses a name that is not a parameter.
            rest = rest.with_degree(parameter, 0)?;
            let first = 2 * rest.degrees_of_freedom;
            if let Some(at) = rest.names[first..].iter().position(|name| name == parameter) {
                rest.names.remove(first + at);
                rest.degrees.remove(at);
            }
        }
        Ok(rest)
    }

    /// The names as `String`s.
    pub(crate) fn owned_names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// This space with degrees for all parameters. A missing degree follows from the quadratic part of `hamiltonian`: 2 if the parameter occurs in it,
    /// otherwise 0.
    pub(crate) fn settled<C: Coefficient>(&self, hamiltonian: &Polynomial<C>) -> Self {
        let phase = self.phase_slots();
        let constant = |m: Monomial| m.degree_in(&phase) == 2 && !self.is_driven(m);
        let detunes = |slot| hamiltonian.terms().any(|(m, _)| constant(m) && m.exponent(slot) > 0);
        let mut settled = self.clone();
        for (slot, degree) in (2 * self.degrees_of_freedom..).zip(&mut settled.degrees) {
            degree.get_or_insert_with(|| if detunes(slot) { 2 } else { 0 });
        }
        settled
    }

    /// The degree of a monomial: its degree in the pairs plus the degrees of its parameters.
    pub(crate) fn degree(&self, monomial: Monomial) -> u32 {
        let parameters = (2 * self.degrees_of_freedom..).zip(&self.degrees);
        let parameters = parameters.map(|(slot, degree)| monomial.exponent(slot).saturating_mul(degree.unwrap_or(0)));
        parameters.fold(monomial.degree_in(&self.phase_slots()), u32::saturating_add)
    }

    /// The weight of a monomial: its degree, plus 1 if it contains a driven phase. A term of order n has the weight n + 2.
    pub(crate) fn weight(&self, monomial: Monomial) -> u32 {
        self.degree(monomial).saturating_add(self.is_driven(monomial).into())
    }

    /// The slots of the driven phases.
    pub(crate) fn driven_slots(&self) -> Range<usize> {
        self.names.len()..self.names.len() + self.driven.len()
    }

    /// Whether a monomial contains a driven phase.
    pub(crate) fn is_driven(&self, monomial: Monomial) -> bool {
        self.driven_slots().any(|slot| monomial.exponent(slot) > 0)
    }

    /// The names of the driven phases.
    #[must_use]
    pub fn driven(&self) -> Vec<&str> {
        self.driven.iter().map(String::as_str).collect()
    }

    /// The integer j of each driven phase in a monomial. In a real polynomial it means cos jM for j ≥ 0 and sin |j|M for j < 0; in a complex one e^{ijM}.
    #[must_use]
    pub fn harmonics(&self, monomial: Monomial) -> Vec<i64> {
        self.driven_slots().map(|slot| harmonics::signed(monomial.exponent(slot))).collect()
    }

    /// The monomial with these exponents of the variables and parameters and these integers j of the driven phases.
    ///
    /// # Errors
    /// - an exponent 32768, |j| = 16384: [`Error::ExponentOverflow`]; other numbers of exponents or of j: [`Error::CountMismatch`].
    pub fn monomial(&self, exponents: &[u32], harmonics: &[i64]) -> Result<Monomial, Error> {
        let lengths =
            [("exponents", exponents.len(), self.names.len()), ("harmonics", harmonics.len(), self.driven.len())];
        if let Some(&(what, found, expected)) = lengths.iter().find(|(_, found, expected)| found != expected) {
            return Err(Error::CountMismatch { what, found, expected });
        }
        let slots = self.driven_slots().zip(harmonics);
        slots.fold(Monomial::new(exponents), |monomial, (slot, &j)| harmonics::with(monomial?, slot, j))
    }

    /// k and j of a monomial in the complex variables, which is proportional to e^{i(k·φ + j·M)}: the exponents of U minus the exponents of u, then j.
    pub(crate) fn turns(&self, monomial: Monomial) -> Vec<i64> {
        let exponent = |slot| i64::from(monomial.exponent(slot));
        let mut turns: Vec<i64> =
            (0..self.degrees_of_freedom).map(|mode| exponent(2 * mode + 1) - exponent(2 * mode)).collect();
        turns.extend(self.driven_slots().map(|slot| harmonics::signed(monomial.exponent(slot))));
        turns
    }

    /// Degrees of the parameters; `None` if a degree was not given.
    #[must_use]
    pub fn parameter_degrees(&self) -> &[Option<u32>] {
        &self.degrees
    }

    fn checked(self) -> Result<Self, Error> {
        if self.degrees_of_freedom == 0 || self.driven_slots().end > SLOTS {
            return Err(Error::PhaseSpaceSize {
                degrees_of_freedom: self.degrees_of_freedom,
                parameters: self.driven_slots().end.saturating_sub(2 * self.degrees_of_freedom),
                slots: SLOTS,
            });
        }
        check_names(&self.all_names())?;
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

    /// Reads a polynomial in these variables, as [`Polynomial::parse`] does, with cosines and sines of the driven phases.
    ///
    /// # Errors
    /// - The errors of [`Polynomial::parse`].
    pub fn parse<C: Coefficient>(&self, text: &str) -> Result<Polynomial<C>, Error> {
        Polynomial::parse_driven(text, &self.all_names(), self.driven.len())
    }

    /// The names of all slots.
    fn all_names(&self) -> Vec<&str> {
        self.names.iter().chain(&self.driven).map(String::as_str).collect()
    }

    /// The Poisson bracket of the pairs.
    ///
    /// # Errors
    /// - None, since the slots differ.
    pub fn poisson(&self) -> Result<Poisson, Error> {
        Poisson::new(&(0..self.degrees_of_freedom).map(|mode| (2 * mode, 2 * mode + 1)).collect::<Vec<_>>())
    }

    /// The slots of the pairs.
    pub(crate) fn phase_slots(&self) -> Vec<usize> {
        (0..2 * self.degrees_of_freedom).collect()
    }

    /// A real polynomial as text. The slots have the names `names`, then the driven phases.
    pub(crate) fn text<C: Coefficient>(&self, polynomial: &Polynomial<C>, names: &[String]) -> String {
        self.text_with(polynomial, names, Harmonics::Real)
    }

    /// A polynomial in the complex variables as text.
    pub(crate) fn complex_text<C: Coefficient>(&self, polynomial: &Polynomial<C>) -> String {
        self.text_with(polynomial, &self.complex_names(), Harmonics::Complex)
    }

    fn text_with<C: Coefficient>(&self, polynomial: &Polynomial<C>, names: &[String], harmonics: Harmonics) -> String {
        let names: Vec<&str> = names.iter().chain(&self.driven).map(String::as_str).collect();
        polynomial.display(&names).with_driven(self.driven.len(), harmonics).to_string()
    }
}
