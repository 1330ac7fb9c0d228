//! Values of other packages: quantities and times of astropy, rotations of SciPy.
//!
//! None of those packages is imported here: a value that has the look of one is handed to `andoyer._foreign`. Lists, tuples, floats and plain arrays,
//! which most calls pass, are told by their type alone.

use numpy::PyUntypedArray;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyList, PyTuple};

/// `value`, or the numbers in it.
pub(crate) fn plain<'py>(argument: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let usual = value.is_exact_instance_of::<PyFloat>()
        || value.is_exact_instance_of::<PyInt>()
        || value.is_exact_instance_of::<PyList>()
        || value.is_exact_instance_of::<PyTuple>()
        || (value.is_instance_of::<PyUntypedArray>() && !value.hasattr(intern!(py, "unit"))?);
    if usual || !looks_foreign(value)? {
        return Ok(value.clone());
    }
    py.import(intern!(py, "andoyer._foreign"))?.getattr(intern!(py, "plain"))?.call1((argument, value))
}

fn looks_foreign(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let py = value.py();
    Ok(value.hasattr(intern!(py, "unit"))? || value.hasattr(intern!(py, "tdb"))? || is_rotation(value)?)
}

/// Whether `value` is a rotation, whose quaternion has no order of its own.
pub(crate) fn is_rotation(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    value.hasattr(intern!(value.py(), "as_quat"))
}

/// [x, y, z, w] from [w, x, y, z], if so asked.
pub(crate) fn scalar_last(quaternion: &mut [f64; 4], scalar_first: bool) {
    if scalar_first {
        quaternion.rotate_left(1);
    }
}

/// [w, x, y, z] from [x, y, z, w], if so asked.
pub(crate) fn scalar_first(quaternions: &mut [[f64; 4]], asked: bool) {
    if asked {
        quaternions.iter_mut().for_each(|quaternion| quaternion.rotate_right(1));
    }
}
