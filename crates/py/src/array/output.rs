//! Arrays of the caller for results.

use numpy::{
    Element, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadwriteArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::error;

/// The error of an array that cannot be borrowed.
pub(super) fn in_use(argument: &str) -> PyErr {
    let message = format!("{argument} shares memory with an array that is in use");
    error::input(argument, "an array in use", "an array that is not in use", message)
}

/// `out`, checked to be an array for results of this shape.
pub(super) fn output<'py>(out: &Bound<'py, PyAny>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let Ok(array) = out.cast::<PyUntypedArray>() else {
        return Err(PyTypeError::new_err(format!("out must be a NumPy array, not {}", out.get_type().name()?)));
    };
    // The class of another package may hold quaternions with the scalar first.
    let module = out.get_type().module()?.to_string();
    if !(out.is_exact_instance_of::<PyUntypedArray>() || module == "numpy" || module.starts_with("numpy.")) {
        let kind = out.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "out must be an array of NumPy's own classes, not a {kind} of {module}"
        )));
    }
    if !array.dtype().is_equiv_to(&f64::get_dtype(out.py())) {
        return Err(PyTypeError::new_err(format!("out has dtype {}: it must be float64", array.dtype())));
    }
    if array.shape() != shape {
        return Err(error::shape("out", array.shape(), &error::shape_text(shape)));
    }
    if !array.is_c_contiguous() {
        let message = "out is strided: it must be C-contiguous".to_owned();
        return Err(error::input("out", "strided", "C-contiguous", message));
    }
    Ok(out.cast::<PyArrayDyn<f64>>()?.clone())
}

/// Borrows an array for writing.
pub(crate) fn write<'py>(array: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<PyReadwriteArrayDyn<'py, f64>> {
    array.try_readwrite().map_err(|problem| match problem {
        numpy::BorrowError::NotWriteable => PyTypeError::new_err("out is read-only: it must be writeable"),
        _ => in_use("out"),
    })
}

/// Matrices of three rows of N numbers.
pub(crate) fn matrices<'a, const N: usize>(
    array: &'a mut PyReadwriteArrayDyn<'_, f64>,
) -> PyResult<&'a mut [[[f64; N]; 3]]> {
    Ok(chunks(array)?.as_chunks_mut().0)
}

/// Rows of N numbers.
pub(crate) fn chunks<'a, const N: usize>(array: &'a mut PyReadwriteArrayDyn<'_, f64>) -> PyResult<&'a mut [[f64; N]]> {
    Ok(array.as_slice_mut()?.as_chunks_mut().0)
}
