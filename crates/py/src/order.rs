//! Whole numbers from Python: any object with `__index__` except a boolean, of any size and sign.

use andoyer_series::error::{Kind, Value};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyInt};

use crate::error;

/// `value` as an order.
pub(crate) fn order(argument: &str, value: &Bound<'_, PyAny>, minimum: usize, maximum: usize) -> PyResult<usize> {
    let above = if argument == "order" { Kind::Representation } else { Kind::Input };
    whole_number(argument, value, minimum, maximum, above)
}

/// `value` as a number. The Rust crates check that it is within `minimum..=maximum`. This function refuses only a value that does not fit a `usize`, with an
/// error of the kind `above` if it is too large.
pub(crate) fn whole_number(
    argument: &str,
    value: &Bound<'_, PyAny>,
    minimum: usize,
    maximum: usize,
    above: Kind,
) -> PyResult<usize> {
    if value.is_instance_of::<PyBool>() {
        return Err(PyTypeError::new_err(format!("{argument} must be a whole number, not bool")));
    }
    value.extract().map_err(|_| {
        // Python refuses to print integers of thousands of digits.
        let shown = value.repr().map_or_else(|_| "(too long to print)".to_owned(), |text| text.to_string());
        let message = format!("{argument} = {shown}: it must be a whole number from {minimum} to {maximum}");
        let whole = value.is_instance_of::<PyInt>() && value.gt(maximum).unwrap_or(false);
        let bound = Value::Integers(vec![minimum as i64, maximum as i64]);
        let exception =
            error::exception(if whole { above } else { Kind::Input }, Some(argument), None, Some(bound), message);
        error::with_attribute(exception, "value", value.clone().unbind())
    })
}
