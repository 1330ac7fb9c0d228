//! The normal form as JSON, exact.
//!
//! ```text
//! { "format": "andoyer-normal-form", "version": 1, "order": N,
//!   "triaxiality": [ [[power of β, "p/q"], …], … ],                 P_0 … P_N
//!   "generators":  [ [[j, k, l, "re", "im"], …], … ] }              S_1 … S_N, as `NormalForm::generator` gives them
//! ```
//!
//! Rationals are reduced, `p` or `p/q`. Reading verifies format, version, the bound of the order before anything is
//! built, the number of series, the degrees, that no exponents repeat, that S has no kernel part and each harmonic its powers
//! of β, and that K and S are real on real motions. It does *not* verify that the coefficients are those of the rigid body: that would be
//! computing them again.

use crate::normal_form::check_order;
use crate::rigid_body::{self, PublicForm};
use crate::{Error, LieTransform, NormalForm, Polynomial, TermProblem};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::Zero;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

const FORMAT: &str = "andoyer-normal-form";
const VERSION: u64 = 1;
/// Longest rational that is read, in bytes: reading a number takes time quadratic in its digits.
const LONGEST_RATIONAL: usize = 1 << 16;

/// j, k, l, real part, imaginary part.
type GeneratorEntry = (u32, u32, u32, String, String);

#[derive(Deserialize)]
struct Header {
    format: String,
    version: u64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u64,
    order: usize,
    triaxiality: Vec<Vec<(u32, String)>>,
    generators: Vec<Vec<GeneratorEntry>>,
}

impl NormalForm {
    /// This normal form as JSON text.
    ///
    /// # Errors
    /// - none for a normal form that exists; JSON itself could not be written only if memory ran out.
    pub fn to_json(&self) -> Result<String, Error> {
        let mut document = Document {
            format: FORMAT.to_owned(),
            version: VERSION,
            order: self.order(),
            triaxiality: Vec::new(),
            generators: Vec::new(),
        };
        for n in 0..=self.order() {
            let entries = self.triaxiality_polynomial(n)?.iter().map(|(&power, c)| (power, c.to_string()));
            document.triaxiality.push(entries.collect());
        }
        for m in 1..=self.order() {
            let entries = self.generator(m)?.into_iter();
            let entries = entries.map(|((j, k, l), c)| (j, k, l, c.re.to_string(), c.im.to_string()));
            document.generators.push(entries.collect());
        }
        Ok(serde_json::to_string(&document)?)
    }

    /// Reads what [`to_json`](Self::to_json) wrote.
    ///
    /// Verified: format, version, order, number of series, degrees, no exponents twice, no zero, no kernel part in S, the powers
    /// of β that a harmonic can have, K and S real on real motions. *Not* verified: that the coefficients are those of the rigid body.
    ///
    /// ```
    /// use andoyer_series::NormalForm;
    /// let normal_form = NormalForm::new(4)?;
    /// assert_eq!(NormalForm::from_json(&normal_form.to_json()?)?, normal_form);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `"[]"`, or a missing field: [`Error::Json`];
    /// - version 2: [`Error::FormatUnknown`];
    /// - order 16382: [`Error::OrderTooLarge`]; order 3 with two generators: [`Error::CountMismatch`];
    /// - `"2/4"`, `"1/0"`, `"0.5"`: [`Error::RationalMalformed`];
    /// - u³U² in S_1, uU in P_1: [`Error::TermInconsistent`].
    pub fn from_json(text: &str) -> Result<Self, Error> {
        let header: Header = serde_json::from_str(text)?;
        if header.format != FORMAT || header.version != VERSION {
            let (format, version) = (header.format, header.version);
            return Err(Error::FormatUnknown { format, version, known_format: FORMAT, known_version: VERSION });
        }
        let document: Document = serde_json::from_str(text)?;
        check_order(document.order)?;
        count("triaxiality", document.triaxiality.len(), document.order + 1)?;
        count("generators", document.generators.len(), document.order)?;
        let triaxiality = document.triaxiality.iter().enumerate().map(|(n, entries)| triaxiality(n, entries));
        let triaxiality = triaxiality.collect::<Result<_, _>>()?;
        let mut scaled = Vec::new();
        let mut factorial = BigRational::from_integer(1.into()); // (m−1)!
        for (m, entries) in (1..).zip(&document.generators) {
            scaled.push(generator(m, entries)?.scale(&factorial.recip()));
            factorial *= BigRational::from_integer(m.into());
        }
        Ok(Self::from_parts(triaxiality, LieTransform::new(rigid_body::poisson()?, scaled)))
    }
}

fn count(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::CountMismatch { what, found, expected }) }
}

fn rational(text: &str) -> Result<BigRational, Error> {
    let value = if text.len() > LONGEST_RATIONAL { None } else { text.parse::<BigRational>().ok() };
    let canonical = value.filter(|value| value.to_string() == text);
    canonical.ok_or_else(|| Error::RationalMalformed { text: text.to_owned() })
}

fn triaxiality(n: usize, entries: &[(u32, String)]) -> Result<BTreeMap<u32, BigRational>, Error> {
    let mut polynomial = BTreeMap::new();
    for (power, text) in entries {
        let fail = |problem| Error::TermInconsistent {
            what: "triaxiality polynomial",
            order: n,
            exponents: vec![*power],
            problem,
        };
        // P_n is even in β: β → −β exchanges the axes 1 and 2.
        if *power as usize > n || power % 2 == 1 {
            return Err(fail(TermProblem::Degree));
        }
        let c = rational(text)?;
        if c.is_zero() {
            return Err(fail(TermProblem::Zero));
        }
        if polynomial.insert(*power, c).is_some() {
            return Err(fail(TermProblem::Repeated));
        }
    }
    Ok(polynomial)
}

/// The form s of order m from its public face, checked term by term.
fn generator(m: usize, entries: &[GeneratorEntry]) -> Result<Polynomial<BigRational>, Error> {
    let order = m as u32; // m ≤ MAXIMUM_ORDER
    let fail = |(j, k, l), problem| Error::TermInconsistent {
        what: "generating function",
        order: m,
        exponents: vec![j, k, l],
        problem,
    };
    let mut face = PublicForm::new();
    for (j, k, l, re, im) in entries {
        let exponents = (*j, *k, *l);
        if u64::from(*j) + u64::from(*k) != 2 * m as u64 + 2 || *l > order {
            return Err(fail(exponents, TermProblem::Degree));
        }
        if j == k {
            return Err(fail(exponents, TermProblem::Kernel));
        }
        // β → −β turns ℓ by a quarter: the harmonic k − j has β^|(k−j)/2| times a polynomial in β².
        let half = j.abs_diff(*k) / 2;
        if *l < half || (l - half) % 2 == 1 {
            return Err(fail(exponents, TermProblem::Harmonic));
        }
        let c = Complex::new(rational(re)?, rational(im)?);
        if c.is_zero() {
            return Err(fail(exponents, TermProblem::Zero));
        }
        if face.insert(exponents, c).is_some() {
            return Err(fail(exponents, TermProblem::Repeated));
        }
    }
    rigid_body::private_form(order, &face)
}
