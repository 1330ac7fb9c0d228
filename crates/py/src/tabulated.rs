//! `andoyer.TabulatedOrbit`.

use std::sync::Arc;

use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::array::{constant, constant_rows, number, numbers_of, vectors};
use crate::error;
use crate::foreign;
use crate::values::immutable;

/// A table of the position of a disturbing body relative to the rotating body. Only the integrated method uses it.
///
/// Between two times the position is the polynomial of degree seven through the eight nearest positions. `Plan.error_bound` includes the error of the
/// interpolation, which is estimated with the two neighbouring polynomials of each interval. The span and the epoch of a scene must be within the times.
///
/// Parameters
/// ----------
/// times : array_like, shape (n,), or astropy.time.Time
///     At least eight increasing times. A Time is converted to TDB seconds since J2000.
/// positions : array_like, shape (n, 3)
///     Positions of the disturbing body relative to the rotating body, in inertial components and any unit of length.
/// gm : float
///     G × mass of the disturbing body, in length³/time².
///
/// Raises
/// ------
/// InputError
///     Fewer than eight times; times that do not increase; another number of positions; a position at the origin; a gm that is not positive; a value that is not finite.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> times = np.linspace(0, 10, 101)
/// >>> circle = TabulatedOrbit(times, np.stack([np.cos(times), np.sin(times), 0 * times], axis=1), 1.0)
/// >>> bool(abs(circle.position(3.14)[1] - np.sin(3.14)) < 1e-10)
/// True
/// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0.1, 1], orbit=circle, span=(0, 10), tolerance=1e-7)
/// >>> scene.solve().plan.method
/// 'integrated'
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct TabulatedOrbit(pub(crate) Arc<andoyer_propagate::TabulatedOrbit>);

immutable!(TabulatedOrbit);

#[pymethods]
impl TabulatedOrbit {
    #[new]
    fn new(times: &Bound<'_, PyAny>, positions: &Bound<'_, PyAny>, gm: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (seconds, _) = foreign::epochs("times", times)?;
        let (times, positions) = (numbers_of("times", &seconds)?, vectors("positions", positions)?);
        let table = andoyer_propagate::TabulatedOrbit::new(times, positions, number("gm", gm)?);
        Ok(Self(Arc::new(table.map_err(error::propagation)?)))
    }

    /// The times, a read-only array of shape (n,).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        constant(py, self.0.times())
    }

    /// The positions, a read-only array of shape (n, 3).
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        constant_rows(py, self.0.positions())
    }

    /// G × mass of the disturbing body.
    #[getter]
    fn gm(&self) -> f64 {
        self.0.gm()
    }

    /// The position at a time within the table: an array of shape (3,).
    ///
    /// Parameters
    /// ----------
    /// time : float
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A time outside the table.
    fn position<'py>(&self, py: Python<'py>, time: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let position = self.0.position(number("time", time)?).map_err(error::propagation)?;
        Ok(PyArray1::from_slice(py, &position))
    }

    pub(crate) fn __repr__(&self) -> String {
        let times = self.0.times();
        format!(
            "<TabulatedOrbit: {} times from {:?} to {:?}, gm={:?}>",
            times.len(),
            times[0],
            times[times.len() - 1],
            self.0.gm()
        )
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let times = self.0.times();
        let numbers = [times.len() as f64, times[0], times[times.len() - 1], self.0.gm()];
        PyTuple::new(py, numbers.into_iter().chain(self.0.positions()[0]).collect::<Vec<_>>())?.hash()
    }

    fn __getnewargs__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (self.times(py), self.positions(py)?, self.gm()).into_pyobject(py)
    }
}
