//! Whole numbers from Python: anything with `__index__` but a boolean, of any size and sign.

use pyo3::PyTypeInfo;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::error::OrderError;

/// `value` as an order.
pub(crate) fn order(argument: &str, value: &Bound<'_, PyAny>, minimum: usize, maximum: usize) -> PyResult<usize> {
    whole_number::<OrderError>(argument, value, minimum, maximum)
}

/// `value` as a number. Whether it is within `minimum..=maximum` the Rust side says; here only what no `usize` can hold is refused.
pub(crate) fn whole_number<E: PyTypeInfo>(
    argument: &str,
    value: &Bound<'_, PyAny>,
    minimum: usize,
    maximum: usize,
) -> PyResult<usize> {
    if value.is_instance_of::<PyBool>() {
        return Err(PyTypeError::new_err(format!("{argument} must be a whole number, not bool")));
    }
    value.extract().map_err(|_| {
        // Python refuses to print integers of thousands of digits.
        let shown = value.repr().map_or_else(|_| "(too long to print)".to_owned(), |text| text.to_string());
        PyErr::new::<E, _>(format!("{argument} = {shown}: it must be a whole number from {minimum} to {maximum}"))
    })
}
