//! `andoyer.TabulatedOrbit`.

use std::ffi::CString;
use std::sync::Arc;

use numpy::{PyArray1, PyArrayDyn};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::array::{constant, constant_rows, number, numbers_of, vectors};
use crate::error;
use crate::foreign;
use crate::values::immutable;

/// A table of the position of a disturbing body relative to the rotating body. Only the integrated method uses it.
///
/// Between two times the position is the polynomial of degree seven through the eight nearest positions, or that of degree eleven through the six nearest positions and velocities.
/// `Plan.error_bound` includes the error of the interpolation, which is estimated with the two neighbouring polynomials of each interval. The span and the epoch of a scene must be within
/// the times. A satellite's own ephemeris is the table of its primary with the signs reversed: the primary as seen from the satellite.
///
/// Parameters
/// ----------
/// times : array_like, shape (n,), or astropy.time.Time
///     At least eight increasing times. A Time is converted to TDB seconds since J2000. With velocities two times suffice, and a time that stands twice is the edge of two segments, each
///     of two times or more: no polynomial passes it, so the orbit may change there.
/// positions : array_like, shape (n, 3)
///     Positions of the disturbing body relative to the rotating body, in inertial components and any unit of length.
/// gm : float
///     G × mass of the disturbing body, in length³/time².
/// velocities : array_like, shape (n, 3), optional
///     Velocities of the disturbing body relative to the rotating body, in inertial components. Rows of 240 s of a low orbit give the attitude of a satellite over a day to 1e-12 rad with them, to 1e-7 without.
///
/// Warns
/// -----
/// UserWarning
///     Positions, times and `gm` that seem to have different units: r² × acceleration is some 1e9 times `gm`, or 1e-9 of it.
///
/// Raises
/// ------
/// InputError
///     Fewer than eight times, or two in a segment with velocities; times that do not increase; another number of positions or velocities; a position at the origin; a gm that is not positive;
///     a value that is not finite.
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

impl TabulatedOrbit {
    /// A table, with a warning if its units seem to differ.
    pub(crate) fn warned(py: Python<'_>, table: andoyer_propagate::TabulatedOrbit) -> PyResult<Self> {
        if let Some(said) = table.doubtful_units() {
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(said)?, 1)?;
        }
        Ok(Self(Arc::new(table)))
    }
}

#[pymethods]
impl TabulatedOrbit {
    #[new]
    #[pyo3(signature = (times, positions, gm, *, velocities=None))]
    fn new(
        py: Python<'_>,
        times: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        gm: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (seconds, _) = foreign::epochs("times", times)?;
        let (times, positions) = (numbers_of("times", &seconds)?, vectors("positions", positions)?);
        let gm = number("gm", gm)?;
        let table = match velocities {
            Some(velocities) => {
                let velocities = vectors("velocities", velocities)?;
                andoyer_propagate::TabulatedOrbit::with_velocities(times, positions, velocities, gm)
            }
            None => andoyer_propagate::TabulatedOrbit::new(times, positions, gm),
        };
        Self::warned(py, table.map_err(error::propagation)?)
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

    /// The velocities, a read-only array of shape (n, 3), or None.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<f64>>>> {
        self.0.velocities().map(|velocities| constant_rows(py, velocities)).transpose()
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

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let named = PyDict::new(py);
        named.set_item("velocities", self.velocities(py)?)?;
        Ok(((self.times(py), self.positions(py)?, self.gm()).into_pyobject(py)?, named))
    }
}
