//! The facts of an error as data: its kind, the argument, the given value and the bound that it breaks.

use std::fmt;

use super::{Error, ParseProblem};

/// What a caller can do about an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// An argument is wrong; give another one.
    Input,
    /// A file, or a JSON text, cannot be read; correct it.
    File,
    /// Doubles, exact rationals or the memory cannot hold the problem. Choose other units, nearer times, a lower order or floats.
    Representation,
    /// No theory holds for the problem; choose another method.
    Theory,
    /// A defect of this library, or a computation that was stopped.
    Internal,
}

/// A given value, or a bound.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// A whole number.
    Integer(i64),
    /// A real number.
    Number(f64),
    /// A name, a term, or a bound in words.
    Text(String),
    /// A vector of whole numbers.
    Integers(Vec<i64>),
    /// A vector of real numbers. As a bound: the lower and the upper end of an interval.
    Numbers(Vec<f64>),
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<u64> for Value {
    fn from(value: u64) -> Self {
        i64::try_from(value).map_or_else(|_| Self::Text(value.to_string()), Self::Integer)
    }
}

impl From<usize> for Value {
    fn from(value: usize) -> Self {
        Self::from(value as u64)
    }
}

impl From<u32> for Value {
    fn from(value: u32) -> Self {
        Self::Integer(value.into())
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

impl From<&String> for Value {
    fn from(value: &String) -> Self {
        Self::Text(value.clone())
    }
}

impl From<String> for Value {
    fn from(value: String) -> Self {
        Self::Text(value)
    }
}

impl<const N: usize> From<[f64; N]> for Value {
    fn from(value: [f64; N]) -> Self {
        Self::Numbers(value.to_vec())
    }
}

impl From<&[i64]> for Value {
    fn from(value: &[i64]) -> Self {
        Self::Integers(value.to_vec())
    }
}

impl From<&[u32]> for Value {
    fn from(value: &[u32]) -> Self {
        Self::Integers(value.iter().map(|&entry| entry.into()).collect())
    }
}

/// The argument, the value and the bound of an error.
type Facts<'a> = (Option<&'a str>, Option<Value>, Option<Value>);

/// A number in a message: with an exponent if it is 1e16 or more or below 1e-5, so that no message has three hundred digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Short(pub f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e16).contains(&size) || !size.is_finite() {
            self.0.fmt(f)
        } else {
            fmt::LowerExp::fmt(&self.0, f)
        }
    }
}

fn facts<'a>(argument: &'a str, value: impl Into<Value>, bound: impl Into<Value>) -> Facts<'a> {
    (Some(argument), Some(value.into()), Some(bound.into()))
}

/// The facts of an error that concerns no single argument.
fn nameless<'a>(value: impl Into<Value>, bound: impl Into<Value>) -> Facts<'a> {
    (None, Some(value.into()), Some(bound.into()))
}

/// The argument that a message calls `what`. It is `None` for a part of a file or of a result.
fn argument_of(what: &str) -> Option<&str> {
    match what {
        "Hamiltonian" | "quadratic part" => Some("hamiltonian"),
        "state" | "actions" | "parameters" | "times" => Some(what),
        _ => None,
    }
}

impl Error {
    /// What a caller can do about this error.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Json { .. }
            | Self::FormatUnknown { .. }
            | Self::RationalMalformed { .. }
            | Self::NotSymplectic { .. }
            | Self::TermInconsistent { .. }
            | Self::CoefficientWrong { .. }
            | Self::NameUnknown { what: "mode", .. } => Kind::File,
            Self::ExponentOverflow { .. }
            | Self::OrderTooLarge { .. }
            | Self::MemoryTooLarge { .. }
            | Self::SpectrumIrrational { .. }
            | Self::FrequencyIrrational { .. }
            | Self::Parse { problem: ParseProblem::ExponentTooLarge { .. } | ParseProblem::TooLarge, .. } => {
                Kind::Representation
            }
            Self::Resonant { .. }
            | Self::ZeroFrequency { .. }
            | Self::Defective { .. }
            | Self::SmallDivisor { .. }
            | Self::ResonantTerm { .. } => Kind::Theory,
            Self::Interrupted { .. } => Kind::Internal,
            Self::CountMismatch { what, .. } if argument_of(what).is_none() => Kind::File,
            Self::SlotOutOfRange { .. }
            | Self::SlotRepeated { .. }
            | Self::DivisionByZero
            | Self::ValueMissing { .. }
            | Self::UnperturbedMismatch { .. }
            | Self::PhaseSpaceSize { .. }
            | Self::LinearTerm { .. }
            | Self::ParameterDegree { .. }
            | Self::ParameterUnknown { .. }
            | Self::FrequencyParameter { .. }
            | Self::FrequencyLetter { .. }
            | Self::CountMismatch { .. }
            | Self::NotFinite { .. }
            | Self::NotResonant { .. }
            | Self::ResonanceMalformed { .. }
            | Self::OrderOutOfRange { .. }
            | Self::NameUnknown { .. }
            | Self::OutsideInterval { .. }
            | Self::Parse { .. } => Kind::Input,
        }
    }

    /// The argument that is wrong. It is `None` if only the caller knows its name, for example for the text of a polynomial.
    #[must_use]
    pub fn argument(&self) -> Option<&str> {
        self.facts().0
    }

    /// The given value, or the number computed from it that breaks the bound.
    #[must_use]
    pub fn value(&self) -> Option<Value> {
        self.facts().1
    }

    /// The requirement on the value: a number, an interval or words.
    #[must_use]
    pub fn bound(&self) -> Option<Value> {
        self.facts().2
    }

    fn facts(&self) -> Facts<'_> {
        match self {
            Self::ExponentOverflow { exponent, bound, .. } => nameless(*exponent, *bound),
            Self::SlotOutOfRange { slot, count } => facts("slot", *slot, count.saturating_sub(1)),
            Self::SlotRepeated { slot } => facts("slot", *slot, "once"),
            Self::DivisionByZero => nameless(0.0, "not 0"),
            Self::ValueMissing { slot, given } => facts("values", *given, slot + 1),
            Self::Resonant { exponents } => nameless(exponents.as_slice(), "outside the kernel"),
            Self::UnperturbedMismatch { terms } => facts("hamiltonian", *terms, "the sum of eigenvalue * q * p"),
            Self::PhaseSpaceSize { degrees_of_freedom, parameters, slots } => {
                facts("variables", 2 * degrees_of_freedom + parameters, *slots)
            }
            Self::ParameterDegree { term, bound } => facts("degrees", term, *bound),
            Self::ParameterUnknown { name, known } => facts("degrees", name, known),
            Self::NotFinite { what, term } => (argument_of(what), Some(term.into()), Some("finite".into())),
            Self::SmallDivisor { divisor, bound, .. } => facts("resonances", *divisor, *bound),
            Self::NotResonant { vector, bound, .. } => facts("resonances", vector.as_slice(), *bound),
            Self::ResonanceMalformed { vector, bound } => facts("resonances", vector.as_slice(), *bound),
            Self::ResonantTerm { term } => nameless(term, "a function of the actions alone"),
            Self::Interrupted { done, of } => facts("progress", *done, *of),
            Self::OrderTooLarge { order, bound } => facts("order", *order, *bound),
            Self::MemoryTooLarge { order, bound_gib, .. } => {
                facts("order", *order, format!("{bound_gib} GiB of memory"))
            }
            Self::OrderOutOfRange { what, order, minimum, maximum } => {
                let argument = if *what == "generating function" { "m" } else { "n" };
                facts(argument, *order, Value::Integers(vec![*minimum as i64, *maximum as i64]))
            }
            Self::NameUnknown { what, name, known } => facts(what, name, *known),
            Self::OutsideInterval { argument, value, lower, upper } => facts(argument, *value, [*lower, *upper]),
            Self::Parse { position, problem } => problem.facts(*position),
            other => other.facts_of_hamiltonian().unwrap_or_else(|| other.facts_of_text()),
        }
    }

    /// The facts of a Hamiltonian that has no normal form of this kind.
    fn facts_of_hamiltonian(&self) -> Option<Facts<'_>> {
        let (value, bound) = match self {
            Self::LinearTerm { term, .. } => (term, "no linear term"),
            Self::ZeroFrequency { pairs, .. } => (pairs, "no frequency 0"),
            Self::FrequencyLetter { term, .. } => {
                (term, "1/sqrt(w) to the power 0 in the quadratic part, not negative elsewhere")
            }
            Self::FrequencyParameter { term, .. } => (term, "a number for the frequency"),
            Self::Defective { eigenvalue, .. } => (eigenvalue, "no Jordan block"),
            Self::SpectrumIrrational { eigenvalue, .. } => (eigenvalue, "rational eigenvalues, or floats"),
            Self::FrequencyIrrational { square, .. } => (square, "the square of a rational number, or floats"),
            _ => return None,
        };
        Some(facts("hamiltonian", value, bound))
    }

    /// The facts of a text that is not the JSON of a normal form.
    fn facts_of_text(&self) -> Facts<'_> {
        match self {
            Self::Json { line, column, message } => facts("text", format!("line {line} column {column}"), message),
            Self::FormatUnknown { format, version, known_format, known_version } => {
                facts("text", format!("{format} version {version}"), format!("{known_format} version {known_version}"))
            }
            Self::RationalMalformed { text } => facts("text", text, "a reduced rational \"p/q\""),
            Self::CountMismatch { what, found, expected } => {
                facts(argument_of(what).unwrap_or("text"), *found, *expected)
            }
            Self::NotSymplectic { error, .. } => facts("text", *error, 0.0),
            Self::TermInconsistent { exponents, problem, .. } => {
                facts("text", exponents.as_slice(), problem.to_string())
            }
            Self::CoefficientWrong { found, expected, .. } => facts("text", found, expected),
            _ => (None, None, None),
        }
    }
}

impl ParseProblem {
    /// The facts of this problem. The value is the offset of the byte if there is no better one.
    fn facts<'a>(&self, position: usize) -> Facts<'a> {
        match self {
            Self::UnexpectedCharacter(found) => nameless(found.to_string(), "a polynomial"),
            Self::UnknownName(name) => nameless(name, "a variable or parameter"),
            Self::Function(name) => nameless(name, "a polynomial"),
            Self::SquareRoot => nameless("sqrt", "a polynomial"),
            Self::UnusableName(name) => nameless(name, "an identifier, once"),
            Self::ExponentTooLarge { bound } | Self::TooDeep { bound } => nameless(position, *bound),
            _ => nameless(position, "a polynomial"),
        }
    }
}
