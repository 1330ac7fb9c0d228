//! The exceptions, and which error of the Rust crates becomes which: its kind says it.
//!
//! `Error` is a `ValueError`; there is one subclass of it for each thing that a caller would handle differently. Message, argument, value and bound are those of
//! the Rust error. What is not an array-like of numbers, no `Body` or no string where one is due, stays Python's own `TypeError`.

use std::ffi::CString;

use andoyer_propagate::Error as Propagation;
use andoyer_series::Error as Algebra;
use andoyer_series::error::{Kind, Value};
use pyo3::create_exception;
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

create_exception!(
    andoyer,
    Error,
    PyValueError,
    "The base of every error of this package.\n\nAttributes\n----------\nargument : str or None\n    Name of the argument.\nvalue\n    The value given, or the number computed from it.\nbound\n    What the value must be: a number, (lower, upper) or words.\nindex : int\n    Place of the member, in an error of a member of an ensemble alone."
);
create_exception!(andoyer, InputError, Error, "An argument that is wrong.");
create_exception!(andoyer, FileError, Error, "A scene file or a JSON text that cannot be read.");
create_exception!(
    andoyer,
    RepresentationError,
    Error,
    "Units, times or orders that doubles, exact rationals or memory cannot hold."
);
create_exception!(
    andoyer,
    TheoryError,
    Error,
    "No theory holds: the series near the separatrix, a spin resonance, a torque too strong, a motion without averaging, a small divisor or a Hamiltonian that cannot be diagonalized."
);
create_exception!(andoyer, InternalError, Error, "A fault of this package: no input should lead to it.");

create_exception!(
    andoyer,
    ToleranceWarning,
    PyUserWarning,
    "A motion, or members of an ensemble, whose error bound exceeds the tolerance over the span."
);

/// Warns with a sentence, if there is one, at the line that called.
pub(crate) fn warn_of_tolerance(py: Python<'_>, said: Option<String>) -> PyResult<()> {
    let Some(said) = said else { return Ok(()) };
    let said = CString::new(said)?;
    PyErr::warn(py, &py.get_type::<ToleranceWarning>(), &said, 1)
}

/// Gives every error the attributes, None where an instance does not say otherwise.
pub(crate) fn with_attributes(py: Python<'_>) -> PyResult<()> {
    let class = py.get_type::<Error>();
    ["argument", "value", "bound"].into_iter().try_for_each(|name| class.setattr(name, py.None()))
}

/// The exception of an error in propagation: of a member of an ensemble that of a single body, with the attribute `index`.
pub(crate) fn propagation(error: Propagation) -> PyErr {
    let (value, bound) = (error.value(), error.bound());
    let exception = exception(error.kind(), error.argument(), value, bound, error.to_string());
    match error {
        Propagation::Member { index, .. } => with_attribute(exception, "index", index),
        _ => exception,
    }
}

/// The exception of an error in the exact algebra.
pub(crate) fn algebra(error: Algebra) -> PyErr {
    exception(error.kind(), error.argument(), error.value(), error.bound(), error.to_string())
}

/// The same where the error is that of one argument and does not name it.
pub(crate) fn algebra_of(argument: &str, error: Algebra) -> PyErr {
    let message = format!("{argument}: {error}");
    exception(error.kind(), Some(argument), error.value(), error.bound(), message)
}

/// The same, under the name that the argument has in Python.
pub(crate) fn algebra_as(argument: &str) -> impl Fn(Algebra) -> PyErr {
    move |error| exception(error.kind(), Some(argument), error.value(), error.bound(), error.to_string())
}

/// An argument that is wrong before a Rust crate sees it.
pub(crate) fn input(argument: &str, value: impl Into<Value>, bound: impl Into<Value>, message: String) -> PyErr {
    exception(Kind::Input, Some(argument), Some(value.into()), Some(bound.into()), message)
}

/// An array of a wrong shape.
pub(crate) fn shape(argument: &str, shape: &[usize], bound: &str) -> PyErr {
    let message = format!("{argument} has shape {}: it must be {bound}", shape_text(shape));
    let lengths: Vec<i64> = shape.iter().filter_map(|&length| length.try_into().ok()).collect();
    input(argument, lengths.as_slice(), bound, message)
}

/// A shape as Python prints it.
pub(crate) fn shape_text(shape: &[usize]) -> String {
    match shape {
        [n] => format!("({n},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// The exception of a kind, with its attributes.
pub(crate) fn exception(
    kind: Kind,
    argument: Option<&str>,
    value: Option<Value>,
    bound: Option<Value>,
    message: String,
) -> PyErr {
    let exception = match kind {
        Kind::Input => InputError::new_err(message),
        Kind::File => FileError::new_err(message),
        Kind::Representation => RepresentationError::new_err(message),
        Kind::Theory => TheoryError::new_err(message),
        _ => InternalError::new_err(message),
    };
    let exception = with_attribute(exception, "argument", argument);
    let exception = with_attribute(exception, "value", value.map(Fact));
    with_attribute(exception, "bound", bound.map(Fact))
}

/// The exception with one more attribute, or that of setting it.
pub(crate) fn with_attribute<T: for<'py> IntoPyObject<'py>>(exception: PyErr, name: &str, value: T) -> PyErr {
    Python::attach(|py| match exception.value(py).setattr(name, value) {
        Ok(()) => exception,
        Err(failure) => failure,
    })
}

/// A value as a number, a text or a tuple of Python.
struct Fact(Value);

impl<'py> IntoPyObject<'py> for Fact {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        match self.0 {
            Value::Integer(value) => Ok(value.into_pyobject(py)?.into_any()),
            Value::Number(value) => Ok(value.into_pyobject(py)?.into_any()),
            Value::Text(value) => Ok(value.into_pyobject(py)?.into_any()),
            Value::Integers(values) => Ok(PyTuple::new(py, values)?.into_any()),
            Value::Numbers(values) => Ok(PyTuple::new(py, values)?.into_any()),
            _ => Ok(py.None().into_bound(py)),
        }
    }
}
