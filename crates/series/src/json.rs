//! The exact normal form as JSON.
//!
//! ```text
//! { "format": "andoyer-normal-form", "version": 1, "order": N,
//!   "triaxiality": [ [[power of β, "p/q"], …], … ],                 P_0 … P_N
//!   "generators":  [ [[j, k, l, "re", "im"], …], … ] }              S_1 … S_N, as `NormalForm::generator` gives them
//! ```
//!
//! Rationals are written as `p` or reduced `p/q`. Reading verifies the format, the version and the bound of the order first. It then verifies the number of
//! series, the degrees, that no exponents repeat, that S has no kernel part, that each harmonic has its powers of β, and that K and S are real on real motions.
//! Finally it computes each order and compares every coefficient; the first difference is an error. The computation takes about as long as parsing the text.

use crate::document::{count, document};
use crate::energy::{EnergyNormalization, tell};
use crate::error::Error;
use crate::error::TermProblem;
use crate::normal_form::NormalForm;
use crate::normal_form::check_order;
use crate::rigid_body::{self, PublicForm};
use crate::triangle::{Progress, quiet};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::Zero;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Display;

const FORMAT: &str = "andoyer-normal-form";
const VERSION: u64 = 1;
/// Longest rational that is accepted, in bytes. The time to read a number is quadratic in its digits.
const LONGEST_RATIONAL: usize = 1 << 16;

/// j, k, l, real part, imaginary part.
type GeneratorEntry = (u32, u32, u32, String, String);

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
    /// - None for an existing normal form; writing JSON fails only if memory runs out.
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
        serde_json::to_string(&document).map_err(Error::json)
    }

    /// Reads the text that [`to_json`](Self::to_json) writes.
    ///
    /// It verifies format, version, order and the number of series. Degrees must be right, exponents must not repeat, and coefficients must not be 0. S must
    /// have no kernel part, a harmonic must have its powers of β, and K and S must be real on real motions. Every coefficient must be that of the rigid body.
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
    /// - u³U² in S_1, uU in P_1: [`Error::TermInconsistent`];
    /// - P_2 = −¾β²: [`Error::CoefficientWrong`], with the order.
    pub fn from_json(text: &str) -> Result<Self, Error> {
        Self::from_json_with(text, &mut quiet)
    }

    /// The same as [`from_json`](Self::from_json), with a callback that receives (orders verified, order) and may stop the reading.
    ///
    /// # Errors
    /// - The errors of [`from_json`](Self::from_json); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn from_json_with(text: &str, progress: &mut Progress<'_>) -> Result<Self, Error> {
        let document: Document = document(text, FORMAT, VERSION)?;
        check_order(document.order)?;
        count("triaxiality", document.triaxiality.len(), document.order + 1)?;
        count("generators", document.generators.len(), document.order)?;
        let polynomials = document.triaxiality.iter().enumerate().map(|(n, entries)| triaxiality(n, entries));
        let polynomials = polynomials.collect::<Result<Vec<_>, _>>()?;
        let faces = (1..).zip(&document.generators).map(|(m, entries)| generator(m, entries));
        let faces = faces.collect::<Result<Vec<_>, _>>()?;
        verified(&polynomials, &faces, progress).map(Self::computed)
    }
}

/// The normal form of the rigid body, if P_0 … P_N and S_1 … S_N equal its polynomials and generating functions. It is computed order by order, so that a wrong
/// file is refused early.
fn verified(
    polynomials: &[BTreeMap<u32, BigRational>],
    faces: &[PublicForm],
    progress: &mut Progress<'_>,
) -> Result<EnergyNormalization, Error> {
    let order = faces.len();
    let mut computed = EnergyNormalization::starting(order);
    let mut factorial = BigRational::from_integer(1.into()); // (m−1)!
    for (n, polynomial) in polynomials.iter().enumerate() {
        tell(progress, n, order)?;
        if n > 0 {
            computed.extend();
        }
        let expected = rigid_body::triaxiality(n, &computed.kernel()[n]);
        same("triaxiality polynomial", n, polynomial, &expected, |&power| vec![power])?;
        if let (Some(face), Some(table)) = (faces.get(n.wrapping_sub(1)), computed.generators().last()) {
            let expected = rigid_body::public_face(&rigid_body::scaled_generator(n, table)?.scale(&factorial));
            same("generating function", n, face, &expected, |&(j, k, l)| vec![j, k, l])?;
            factorial *= BigRational::from_integer(n.into());
        }
    }
    Ok(computed)
}

/// Refuses two forms that differ, and names the first coefficient that does.
fn same<K: Ord, C: PartialEq + Display>(
    what: &'static str,
    order: usize,
    found: &BTreeMap<K, C>,
    expected: &BTreeMap<K, C>,
    exponents: impl Fn(&K) -> Vec<u32>,
) -> Result<(), Error> {
    let Some(at) = found.keys().chain(expected.keys()).find(|&at| found.get(at) != expected.get(at)) else {
        return Ok(());
    };
    let said = |form: &BTreeMap<K, C>| form.get(at).map_or_else(|| "0".to_owned(), C::to_string);
    let (found, expected) = (said(found), said(expected));
    Err(Error::CoefficientWrong { what, order, exponents: exponents(at), found, expected })
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

/// The generating function of order m in the paper's variables u, U, checked term by term.
fn generator(m: usize, entries: &[GeneratorEntry]) -> Result<PublicForm, Error> {
    let order = m as u32; // m ≤ MAX_ORDER
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
    rigid_body::check_real(m, &face)?;
    Ok(face)
}
