//! Mean periods as named tuples of `andoyer.mean`.

use andoyer_propagate::options::Convention;
use andoyer_propagate::periods::Periods;
use numpy::PyArray1;
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

/// The periods of the members of an ensemble, arrays by convention.
pub(crate) fn of_members<'py, 'a>(
    py: Python<'py>,
    rows: impl Iterator<Item = &'a [Periods; 3]> + Clone,
) -> PyResult<Bound<'py, PyDict>> {
    let pairs = Convention::ALL.iter().enumerate().map(|(place, convention)| {
        let column = |of: fn(&Periods) -> f64| PyArray1::from_iter(py, rows.clone().map(move |row| of(&row[place])));
        (*convention, (column(|pair| pair.precession), column(|pair| pair.rotation)))
    });
    periods(py, "PeriodsOfMembers", pairs)
}
