//! The Python exceptions, and the conversion of the errors of the Rust crates by their kind.
//!
//! `Error` is a `ValueError`. It has one subclass for each kind of error that a caller would handle differently. Message, argument, value and bound are those of
//! the Rust error. An argument of a wrong type (not an array-like of numbers, not a `Body`, not a string) is a `TypeError` of Python.

use std::f64::consts::TAU;
use std::ffi::CString;
use std::fmt::Display;

use andoyer_propagate::Error as Propagation;
use andoyer_series::Error as Algebra;
use andoyer_series::error::{Kind, Value};
use pyo3::create_exception;
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyString, PyTuple};

create_exception!(
    andoyer,
    Error,
    PyValueError,
    "The base of every error of this package.\n\nAttributes\n----------\nargument : str or None\n    Name of the argument.\nvalue\n    The given value, or a number computed from it.\nbound\n    The bound of the value: a number, (lower, upper) or words.\nindex : int\n    Number of the member; only errors of members of an ensemble have it."
);
create_exception!(andoyer, InputError, Error, "An invalid argument.");
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
    "No theory holds: series near the separatrix, a spin resonance, a torque that is too strong, a motion that cannot be averaged, a small divisor, or a Hamiltonian that cannot be diagonalized."
);
create_exception!(andoyer, InternalError, Error, "A fault of this package: no input should lead to it.");

create_exception!(
    andoyer,
    ToleranceWarning,
    PyUserWarning,
    "The error bound of a motion, or of members of an ensemble, exceeds the tolerance over the span, or that of an evolution a tenth of its angular momentum."
);

/// Warns of angles beyond a whole turn, which are probably in degrees.
pub(crate) fn warn_of_degrees<N: Display>(py: Python<'_>, angles: impl IntoIterator<Item = (N, f64)>) -> PyResult<()> {
    for (name, angle) in angles.into_iter().filter(|(_, angle)| angle.abs() > TAU) {
        let said = format!("{name} = {angle:?} is more than a whole turn: angles are in radians, not in degrees");
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(said)?, 1)?;
    }
    Ok(())
}

/// The numbers of an argument with their names.
pub(crate) fn each<'a>(argument: &'a str, numbers: &'a [f64]) -> impl Iterator<Item = (String, f64)> + 'a {
    numbers.iter().enumerate().map(move |(index, number)| (format!("{argument}[{index}]"), *number))
}

/// Issues a `ToleranceWarning` with this text, if there is one, at the line of the caller.
pub(crate) fn warn_of_tolerance(py: Python<'_>, said: Option<String>) -> PyResult<()> {
    let Some(said) = said else { return Ok(()) };
    let said = CString::new(said)?;
    PyErr::warn(py, &py.get_type::<ToleranceWarning>(), &said, 1)
}

/// Gives every error class the attributes, with None as their default.
pub(crate) fn with_attributes(py: Python<'_>) -> PyResult<()> {
    let class = py.get_type::<Error>();
    ["argument", "value", "bound"].into_iter().try_for_each(|name| class.setattr(name, py.None()))
}

/// The exception for an error of propagation. For a member of an ensemble it is that of a single body, with the attribute `index`.
pub(crate) fn propagation(error: Propagation) -> PyErr {
    let (value, bound) = (error.value(), error.bound());
    let exception = exception(error.kind(), error.argument(), value, bound, error.to_string());
    match error {
        Propagation::Member { index, .. } => with_attribute(exception, "index", index),
        _ => exception,
    }
}

/// The error of propagation that an exception states; of a member without the words that name it. Attributes that are not those of an error are left out.
pub(crate) fn stated(exception: &Bound<'_, PyAny>) -> PyResult<Propagation> {
    let kinds = [
        (exception.is_instance_of::<InternalError>(), Kind::Internal),
        (exception.is_instance_of::<FileError>(), Kind::File),
        (exception.is_instance_of::<RepresentationError>(), Kind::Representation),
        (exception.is_instance_of::<TheoryError>(), Kind::Theory),
    ];
    let message = exception.str()?.to_string_lossy().into_owned();
    let index = exception.getattr_opt("index")?.and_then(|index| index.extract::<usize>().ok());
    let message = index.and_then(|index| message.strip_prefix(&format!("member {index}: "))).unwrap_or(&message);
    Ok(Propagation::Stated {
        kind: kinds.into_iter().find(|(is, _)| *is).map_or(Kind::Input, |(_, kind)| kind),
        argument: exception.getattr("argument")?.extract().ok(),
        value: fact(exception, "value")?,
        bound: fact(exception, "bound")?,
        message: message.to_owned(),
    })
}

/// The exception for an error of the exact algebra.
pub(crate) fn algebra(error: Algebra) -> PyErr {
    exception(error.kind(), error.argument(), error.value(), error.bound(), error.to_string())
}

/// The same exception, for an error of one argument that does not name it.
pub(crate) fn algebra_of(argument: &str, error: Algebra) -> PyErr {
    let message = format!("{argument}: {error}");
    exception(error.kind(), Some(argument), error.value(), error.bound(), message)
}

/// The same exception, with the Python name of the argument.
pub(crate) fn algebra_as(argument: &str) -> impl Fn(Algebra) -> PyErr {
    move |error| exception(error.kind(), Some(argument), error.value(), error.bound(), error.to_string())
}

/// The exception for an invalid argument, before it is passed to a Rust crate.
pub(crate) fn input(argument: &str, value: impl Into<Value>, bound: impl Into<Value>, message: String) -> PyErr {
    exception(Kind::Input, Some(argument), Some(value.into()), Some(bound.into()), message)
}

/// The exception for an array of a wrong shape.
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

/// The exception with one more attribute, or the exception raised by setting it.
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

/// The value of an attribute of an exception.
fn fact(exception: &Bound<'_, PyAny>, name: &str) -> PyResult<Option<Box<Value>>> {
    let given = exception.getattr(name)?;
    if given.is_none() {
        return Ok(None);
    }
    let value = if given.is_instance_of::<PyFloat>() {
        given.extract().ok().map(Value::Number)
    } else if given.is_instance_of::<PyInt>() {
        given.extract().ok().map(Value::Integer)
    } else if given.is_instance_of::<PyString>() {
        None
    } else {
        given.extract().map(Value::Integers).or_else(|_| given.extract().map(Value::Numbers)).ok()
    };
    let value = match value {
        Some(value) => value,
        None => Value::Text(given.str()?.to_string_lossy().into_owned()),
    };
    Ok(Some(Box::new(value)))
}
