//! The facts of an error as data: its kind, the argument, the given value and the bound that it breaks.

use std::fmt;

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
#[derive(Debug, Clone, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Facts<'a> {
    pub argument: Option<&'a str>,
    pub value: Option<Value>,
    pub bound: Option<Value>,
}

/// The facts of an error that has a value and a bound. The argument is `None` if only the caller knows its name.
pub fn facts<'a>(argument: impl Into<Option<&'a str>>, value: impl Into<Value>, bound: impl Into<Value>) -> Facts<'a> {
    Facts { argument: argument.into(), value: Some(value.into()), bound: Some(bound.into()) }
}

/// A number in a message: with an exponent if it is 1e16 or more or below 1e-5, so that no message has three hundred digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Short(pub f64);

impl Short {
    /// The number rounded to this many significant digits, so that no small number is printed as 0.
    pub fn rounded(value: f64, digits: usize) -> Self {
        Self(format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value))
    }
}

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
