//! A Birkhoff normal form as JSON. Exact numbers are written as "p/q", floats as numbers with all their digits.
//!
//! ```text
//! { "format": "andoyer-birkhoff-exact" or "andoyer-birkhoff-float", "version": 1, "order": N,
//!   "variables": [["q", "p"], …], "parameters": [["d", degree], …],
//!   "driven": [["M", n, M₀], …],                               only with driven phases
//!   "resonances": [[k₁, …], …], "smallest_divisor": 1e-6, "centre": false,
//!   "modes": [["elliptic", ω, r] or ["hyperbolic", λ] or ["complex", σ, ν, partner], …],
//!   "linear_change": [[…], …],                                 M by rows
//!   "offset": [[[exponents], c], …],                           the constant term
//!   "original": [[[exponents], c], …],                         the normalized Hamiltonian
//!   "hamiltonian": [ [[[exponents], re, im], …], … ],          K_n/n! in u₁, U₁, …, parameters, n = 0 … N
//!   "generators":  [ [[[exponents], re, im], …], … ] }         S_m/(m−1)!, m = 1 … N
//! ```
//!
//! With driven phases the exponents are followed by their integers j of either sign: cos jM for j ≥ 0 and sin |j|M for j < 0 in the real polynomials, e^{ijM} in the
//! complex ones.
//!
//! Reading verifies format, version, names, counts and degrees, that numbers are finite, that M is symplectic, that K has only terms that are kept, and that S
//! has none of these terms. Then it computes the normal form of the original Hamiltonian again and compares every coefficient.

use super::diagonal::Diagonal;
use super::matrix::{Matrix, form_entry, pairing, transposed};
use super::mode::Mode;
use super::phases::Phases;
use super::resonances::Spectrum;
use super::verify::verified;
use super::{BirkhoffNormalForm, PhaseSpace, Resonances, check_driven, prepared};
use crate::coefficient::Coefficient;
use crate::document::{count, document};
use crate::error::Error;
use crate::error::TermProblem;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use crate::triangle::{LieTransform, Normalization, Progress, quiet};
use serde::{Deserialize, Serialize};
use serde_json::Value;

const VERSION: u64 = 1;

type Term = (Vec<i64>, Value, Value);

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u64,
    order: usize,
    variables: Vec<(String, String)>,
    parameters: Vec<(String, u32)>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    driven: Vec<(String, Value, f64)>,
    resonances: Vec<Vec<i64>>,
    smallest_divisor: f64,
    centre: bool,
    modes: Vec<Vec<Value>>,
    linear_change: Vec<Vec<Value>>,
    offset: Vec<(Vec<i64>, Value)>,
    original: Vec<(Vec<i64>, Value)>,
    hamiltonian: Vec<Vec<Term>>,
    generators: Vec<Vec<Term>>,
}

fn format<R: RealField>() -> &'static str {
    if R::EPSILON == 0.0 { "andoyer-birkhoff-exact" } else { "andoyer-birkhoff-float" }
}

impl<R: RealField> BirkhoffNormalForm<R> {
    /// This normal form as JSON text.
    ///
    /// # Errors
    /// - None for an existing normal form; writing JSON fails only if memory runs out.
    pub fn to_json(&self) -> Result<String, Error> {
        let space = self.space();
        let names = space.names();
        let (pairs, parameters) = names.split_at(2 * space.degrees_of_freedom());
        let exponents = |monomial: Monomial| {
            let powers = monomial.exponents().into_iter().take(names.len()).map(i64::from);
            powers.chain(space.harmonics(monomial)).collect::<Vec<_>>()
        };
        let terms = |(order, f): (usize, &Polynomial<R::Complex>)| {
            let term = |(monomial, c): (Monomial, &R::Complex)| {
                let (re, im) = R::parts(c);
                (exponents(monomial), value(&re), value(&im))
            };
            self.phases.lowered(f, space, order).terms().map(term).collect::<Vec<_>>()
        };
        let reals = |f: &Polynomial<R>| f.terms().map(|(m, c)| (exponents(m), value(c))).collect();
        let generators = (1..=self.order()).filter_map(|m| Some((m, self.transform().scaled_generator(m)?)));
        let driven = space.driven().into_iter().zip(self.driven());
        let degrees = space.parameter_degrees().iter().map(|degree| degree.unwrap_or(0));
        let document = Document {
            format: format::<R>().to_owned(),
            version: VERSION,
            order: self.order(),
            variables: pairs.chunks(2).map(|pair| (pair[0].to_owned(), pair[1].to_owned())).collect(),
            parameters: parameters.iter().map(|&name| name.to_owned()).zip(degrees).collect(),
            driven: driven.map(|(name, (n, phase))| (name.to_owned(), value(n), *phase)).collect(),
            resonances: self.resonances.vectors().to_vec(),
            smallest_divisor: self.resonances.smallest_divisor(),
            centre: self.resonances.keeps_centre(),
            modes: self.modes().iter().map(mode_values).collect(),
            linear_change: self.linear_change().iter().map(|row| row.iter().map(value).collect()).collect(),
            offset: reals(&self.offset),
            original: reals(&self.hamiltonian),
            hamiltonian: self.normalization.hamiltonian.iter().enumerate().map(terms).collect(),
            generators: generators.map(terms).collect(),
        };
        serde_json::to_string(&document).map_err(Error::json)
    }

    /// Reads the text that [`to_json`](Self::to_json) wrote from a normal form in the same kind of numbers. The normal form is computed again and every
    /// coefficient is compared.
    ///
    /// ```
    /// use andoyer_series::{BirkhoffNormalForm, PhaseSpace, normalize};
    /// use andoyer_series::num_rational::BigRational;
    /// let space = PhaseSpace::new(&[("q", "p")])?;
    /// let form = normalize(&space.parse::<BigRational>("(p^2 + q^2)/2 + q^4/4")?, 4, &space)?;
    /// assert_eq!(BirkhoffNormalForm::<BigRational>::from_json(&form.to_json()?)?, form);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `"[]"`, a missing field, a number of the other kind: [`Error::Json`] or [`Error::RationalMalformed`];
    /// - another format (for example exact instead of float) or version: [`Error::FormatUnknown`];
    /// - lists of the wrong length: [`Error::CountMismatch`]; terms that such a normal form cannot have: [`Error::TermInconsistent`];
    /// - M not symplectic: [`Error::NotSymplectic`]; names and resonances: the errors of their constructors;
    /// - a coefficient of K, S or M that differs from the normal form of the Hamiltonian in the text (for floats: by more than 1e-8 of the largest coefficient
    ///   of its order): [`Error::CoefficientWrong`].
    pub fn from_json(text: &str) -> Result<Self, Error> {
        Self::from_json_with(text, &mut quiet)
    }

    /// The same as [`from_json`](Self::from_json), with a callback as in [`normalize_with`](crate::normalize_with), which takes most of the time.
    ///
    /// # Errors
    /// - The errors of [`from_json`](Self::from_json); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn from_json_with(text: &str, progress: &mut Progress<'_>) -> Result<Self, Error> {
        let form = Self::from_json_unverified(text)?;
        verified(&form, progress)?;
        Ok(form)
    }

    /// The same as [`from_json`](Self::from_json) without the computation, for a text that this program wrote. Malformed text is refused, but a changed
    /// coefficient is not found.
    ///
    /// # Errors
    /// - The errors of [`from_json`](Self::from_json), except [`Error::CoefficientWrong`].
    pub fn from_json_unverified(text: &str) -> Result<Self, Error> {
        let document: Document = document(text, format::<R>(), VERSION)?;
        if document.order > R::MAX_ORDER {
            return Err(Error::OrderTooLarge { order: document.order, bound: R::MAX_ORDER });
        }
        let space = space(&document)?;
        let vectors: Vec<&[i64]> = document.resonances.iter().map(Vec::as_slice).collect();
        let mut resonances = Resonances::new(&vectors)?.with_smallest_divisor(document.smallest_divisor)?;
        if document.centre {
            resonances = resonances.with_centre();
        }
        let diagonal = diagonal::<R>(&document, space.degrees_of_freedom())?;
        let driven = document.driven.iter().map(|(_, n, phase)| Ok((number(n)?, *phase)));
        let driven: Vec<(R, f64)> = driven.collect::<Result<_, Error>>()?;
        check_driven(&driven, &space)?;
        let spectrum = Spectrum::new(&diagonal.modes, &driven, document.smallest_divisor);
        resonances.check(&spectrum)?;
        let constant = |m: Monomial| m.degree_in(&space.phase_slots()) == 0 && !space.is_driven(m);
        let offset = reals("constant term", &document.offset, &space, constant)?;
        let most = document.order as u32 + 2;
        let within = |m: Monomial| m.degree_in(&space.phase_slots()) > 0 && space.weight(m) <= most;
        let hamiltonian = reals("original hamiltonian", &document.original, &space, within)?;
        let phases = if driven.is_empty() {
            Phases::of(&driven, &space, &spectrum, Vec::new())?.0
        } else {
            prepared(&hamiltonian, document.order, &space, &diagonal, &spectrum, &driven)?.0
        };
        let mut form = BirkhoffNormalForm {
            space,
            diagonal,
            resonances,
            phases,
            offset,
            hamiltonian,
            normalization: Normalization {
                hamiltonian: Vec::new(),
                transform: LieTransform::new(crate::bracket::Poisson::new(&[])?, Vec::new()),
            },
        };
        count("hamiltonian", document.hamiltonian.len(), document.order + 1)?;
        count("generators", document.generators.len(), document.order)?;
        let series = |what, first, lists: &[Vec<Term>], kept| {
            let lists = (first..).zip(lists).map(|(n, terms)| form.series(what, n, terms, kept));
            lists.collect::<Result<Vec<_>, Error>>()
        };
        let hamiltonian = series("hamiltonian", 0, &document.hamiltonian, true)?;
        let generators = series("generating function", 1, &document.generators, false)?;
        let transform = LieTransform::new(form.space.poisson()?, generators);
        form.normalization = Normalization { hamiltonian, transform };
        Ok(form)
    }

    /// A polynomial of order n, checked term by term.
    fn series(
        &self,
        what: &'static str,
        n: usize,
        terms: &[Term],
        kept: bool,
    ) -> Result<Polynomial<R::Complex>, Error> {
        let mut polynomial = Polynomial::zero();
        for (exponents, re, im) in terms {
            let fail = |problem| inconsistent(what, n, exponents, problem);
            let monomial = monomial(&self.space, exponents)?.ok_or_else(|| fail(TermProblem::Degree))?;
            let (degree, driven) = (self.space.degree(monomial) as usize, !self.phases.given.is_empty());
            // A shift lowers the degree.
            if degree > n + 2 || (degree < n + 2 && !driven) {
                return Err(fail(TermProblem::Degree));
            }
            if self.resonances.keeps_of(&self.space.turns(monomial), self.modes()) != kept {
                return Err(fail(TermProblem::Kernel));
            }
            if polynomial.coefficient(&monomial).is_some() {
                return Err(fail(TermProblem::Repeated));
            }
            polynomial.add_term(monomial, &R::complex(number(re)?, number(im)?));
        }
        self.phases.lifted(&polynomial, &self.space, n as u32)
    }
}

/// Exponents and harmonics as a monomial; `None` for another number of them or a negative exponent.
pub(crate) fn monomial(space: &PhaseSpace, exponents: &[i64]) -> Result<Option<Monomial>, Error> {
    let Some((powers, harmonics)) = exponents.split_at_checked(space.names().len()) else { return Ok(None) };
    let powers: Option<Vec<u32>> = powers.iter().map(|&power| u32::try_from(power).ok()).collect();
    let powers = powers.filter(|_| harmonics.len() == space.driven().len());
    powers.map(|powers| space.monomial(&powers, harmonics)).transpose()
}

fn inconsistent(what: &'static str, order: usize, exponents: &[i64], problem: TermProblem) -> Error {
    let exponents = exponents.iter().map(|&exponent| exponent.try_into().unwrap_or(0)).collect();
    Error::TermInconsistent { what, order, exponents, problem }
}

fn value<R: RealField>(c: &R) -> Value {
    if R::EPSILON == 0.0 { super::quadratic::literal(c).into() } else { c.to_float().into() }
}

/// A polynomial in real variables, whose terms all have to fit.
pub(crate) fn reals<R: RealField>(
    what: &'static str,
    terms: &[(Vec<i64>, Value)],
    space: &PhaseSpace,
    fits: impl Fn(Monomial) -> bool,
) -> Result<Polynomial<R>, Error> {
    let mut polynomial = Polynomial::zero();
    for (exponents, c) in terms {
        let fail = |problem| inconsistent(what, 0, exponents, problem);
        let monomial = monomial(space, exponents)?.filter(|&m| fits(m)).ok_or_else(|| fail(TermProblem::Degree))?;
        if polynomial.coefficient(&monomial).is_some() {
            return Err(fail(TermProblem::Repeated));
        }
        polynomial.add_term(monomial, &number(c)?);
    }
    Ok(polynomial)
}

/// A number in the notation of its kind.
fn number<R: RealField>(value: &Value) -> Result<R, Error> {
    let malformed = || Error::RationalMalformed { text: value.to_string() };
    if R::EPSILON > 0.0 {
        let float = value.as_f64().filter(|float| float.is_finite()).ok_or_else(malformed)?;
        return R::from_float(float).ok_or_else(malformed);
    }
    let text = value.as_str().ok_or_else(malformed)?;
    let constant = Polynomial::<R>::parse(text, &[]).ok().and_then(|constant| constant.as_constant());
    constant.filter(|c| super::quadratic::literal(c) == text).ok_or_else(malformed)
}

fn mode_values<R: RealField>(mode: &Mode<R>) -> Vec<Value> {
    match mode {
        Mode::Elliptic { frequency, ratio } => vec!["elliptic".into(), value(frequency), value(ratio)],
        Mode::Hyperbolic { rate } => vec!["hyperbolic".into(), value(rate)],
        Mode::Complex { rate, frequency, partner } => {
            vec!["complex".into(), value(rate), value(frequency), (*partner).into()]
        }
    }
}

fn space(document: &Document) -> Result<PhaseSpace, Error> {
    let pairs: Vec<(&str, &str)> = document.variables.iter().map(|(q, p)| (q.as_str(), p.as_str())).collect();
    let names: Vec<&str> = document.parameters.iter().map(|(name, _)| name.as_str()).collect();
    let driven: Vec<&str> = document.driven.iter().map(|(name, ..)| name.as_str()).collect();
    let space = PhaseSpace::new(&pairs)?.with_parameters(&names)?.with_driven(&driven)?;
    document.parameters.iter().try_fold(space, |space, (name, degree)| space.with_degree(name, *degree))
}

fn diagonal<R: RealField>(document: &Document, pairs: usize) -> Result<Diagonal<R>, Error> {
    count("modes", document.modes.len(), pairs)?;
    count("linear_change", document.linear_change.len(), 2 * pairs)?;
    let mut modes: Vec<Mode<R>> = Vec::new();
    for values in &document.modes {
        let malformed = || Error::NameUnknown {
            what: "mode",
            name: values.iter().map(Value::to_string).collect::<Vec<_>>().join(", "),
            known: "[\"elliptic\", ω, r], [\"hyperbolic\", λ], [\"complex\", σ, ν, partner]",
        };
        modes.push(match &values[..] {
            [kind, frequency, ratio] if kind == "elliptic" => {
                Mode::Elliptic { frequency: number(frequency)?, ratio: number(ratio)? }
            }
            [kind, rate] if kind == "hyperbolic" => Mode::Hyperbolic { rate: number(rate)? },
            [kind, rate, frequency, partner] if kind == "complex" => {
                let partner = partner.as_u64().map(|partner| partner as usize).filter(|&partner| partner < pairs);
                Mode::Complex {
                    rate: number(rate)?,
                    frequency: number(frequency)?,
                    partner: partner.ok_or_else(malformed)?,
                }
            }
            _ => return Err(malformed()),
        });
        if let Some(Mode::Elliptic { ratio, .. }) = modes.last()
            && ratio.sign() <= 0
        {
            return Err(malformed());
        }
    }
    let mutual = |(mode, kind): (usize, &Mode<R>)| match kind {
        Mode::Complex { partner, frequency, .. } => {
            matches!(&modes[*partner], Mode::Complex { partner: back, frequency: other, .. } if *back == mode && frequency.sign() * other.sign() < 0)
        }
        _ => true,
    };
    if !modes.iter().enumerate().all(mutual) {
        return Err(Error::NameUnknown {
            what: "mode",
            name: "complex".to_owned(),
            known: "two modes that name each other",
        });
    }
    let mut matrix: Matrix<R> = Vec::new();
    for row in &document.linear_change {
        count("linear_change", row.len(), 2 * pairs)?;
        matrix.push(row.iter().map(number).collect::<Result<_, _>>()?);
    }
    symplectic(&matrix)?;
    Ok(Diagonal { modes, matrix })
}

/// Refuses a matrix that is not symplectic (for floats: beyond rounding error).
fn symplectic<R: RealField>(matrix: &Matrix<R>) -> Result<(), Error> {
    let columns = transposed(matrix);
    let largest = matrix.iter().flatten().map(|entry| entry.to_float().abs()).fold(1.0, f64::max);
    for (i, j) in (0..columns.len()).flat_map(|i| (0..columns.len()).map(move |j| (i, j))) {
        let mut error = pairing(&columns[i], &columns[j]);
        error -= &R::integer(form_entry(i, j));
        if error.to_float().abs() > 1e4 * R::EPSILON * largest * largest || (R::EPSILON == 0.0 && !error.is_zero()) {
            return Err(Error::NotSymplectic { row: i, column: j, error: error.to_float() });
        }
    }
    Ok(())
}
