//! Mean periods as named tuples of `andoyer.mean`.

use andoyer_propagate::options::Convention;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A dict of pairs (precession, rotation) by convention, of this class of `andoyer.mean`.
pub(crate) fn periods<'py, T: IntoPyObject<'py>>(
    py: Python<'py>,
    class: &str,
    pairs: impl IntoIterator<Item = (Convention, (T, T))>,
) -> PyResult<Bound<'py, PyDict>> {
    let class = py.import("andoyer.mean")?.getattr(class)?;
    let periods = PyDict::new(py);
    for (convention, (precession, rotation)) in pairs {
        periods.set_item(convention.to_string(), class.call1((precession, rotation))?)?;
    }
    Ok(periods)
}
