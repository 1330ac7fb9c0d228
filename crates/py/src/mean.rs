//! Mean periods as named tuples of `andoyer.mean`.

use andoyer_propagate::Convention;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyType};

/// A dict of `Periods` (precession, rotation) by convention.
pub(crate) fn periods<'py, T: IntoPyObject<'py>>(
    py: Python<'py>,
    pairs: impl IntoIterator<Item = (Convention, (T, T))>,
) -> PyResult<Bound<'py, PyDict>> {
    static PERIODS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let class = PERIODS.import(py, "andoyer.mean", "Periods")?;
    let periods = PyDict::new(py);
    for (convention, (precession, rotation)) in pairs {
        periods.set_item(convention.to_string(), class.call1((precession, rotation))?)?;
    }
    Ok(periods)
}
