//! `andoyer.Orbit`.

use std::ffi::CString;

use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::{array, error};

/// The names of the elements after the mean motion and the eccentricity, in the order of the core's.
const KEYWORDS: [&str; 5] = ["time_of_pericentre", "inclination", "node", "argument_of_pericentre", "mass_fraction"];

/// The relative Keplerian orbit of a body whose gravity gradient acts on the rotating body (theory §9).
///
/// The elements refer to the inertial frame of the attitudes. With the mean motion alone, the orbit is a circle in the x, y plane with the disturbing body on
/// the x axis at time 0.
///
/// Parameters
/// ----------
/// mean_motion : float
///     Mean motion n, in rad per unit of time; n²a³ is G times the sum of both masses.
/// eccentricity : float, optional
///     Eccentricity e, 0 ≤ e < 1.
/// time_of_pericentre : float, optional
///     A time of passage through the pericentre.
/// inclination, node, argument_of_pericentre : float, optional
///     Inclination of the orbit plane, longitude of the ascending node, and argument of the pericentre from the node, in rad.
/// mass_fraction : float, optional
///     Disturbing mass divided by the sum of both masses: 1 for the Sun on an asteroid, 1/82.3 for the Moon on the Earth.
///
/// Warns
/// -----
/// UserWarning
///     An inclination, node or argument beyond 2π, which is probably in degrees.
///
/// Raises
/// ------
/// InputError
///     A mean motion that is not positive; an eccentricity outside 0 ≤ e < 1; a mass fraction that is not positive or is above 1; a value that is not finite.
/// TypeError
///     A text.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> sun = Orbit(2e-3, 0.1, inclination=0.4)
/// >>> scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0, 0, 1], orbit=sun, tolerance=1e-5, span=(0, 1e6))
/// >>> motion = scene.solve()
/// >>> motion.plan.averaging, motion.plan.torque < 1e-5
/// ('spin', True)
/// >>> pole = motion.angular_momentum([0, 1e6])
/// >>> bool(np.abs(pole[1] - pole[0]).max() > 0.01)  # the pole precesses
/// True
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Orbit(pub(crate) andoyer_propagate::Orbit);

#[pymethods]
impl Orbit {
    #[new]
    #[pyo3(signature = (
        mean_motion, eccentricity=0.0, *, time_of_pericentre=0.0, inclination=0.0, node=0.0, argument_of_pericentre=0.0, mass_fraction=1.0
    ))]
    #[expect(clippy::too_many_arguments, reason = "the elements, by keyword")]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = mean_motion)] mean_motion: f64,
        #[pyo3(from_py_with = eccentricity)] eccentricity: f64,
        #[pyo3(from_py_with = time_of_pericentre)] time_of_pericentre: f64,
        #[pyo3(from_py_with = inclination)] inclination: f64,
        #[pyo3(from_py_with = node)] node: f64,
        #[pyo3(from_py_with = argument_of_pericentre)] argument_of_pericentre: f64,
        #[pyo3(from_py_with = mass_fraction)] mass_fraction: f64,
    ) -> PyResult<Self> {
        let orbit = andoyer_propagate::Orbit::new(mean_motion, eccentricity)
            .and_then(|orbit| orbit.time_of_pericentre(time_of_pericentre))
            .and_then(|orbit| orbit.plane(inclination, node, argument_of_pericentre))
            .and_then(|orbit| orbit.mass_fraction(mass_fraction))
            .map_err(error::propagation)?;
        doubt(py, &orbit)?;
        Ok(Self(orbit))
    }

    /// Mean motion n, in rad per unit of time.
    #[getter]
    fn mean_motion(&self) -> f64 {
        self.0.elements()[0]
    }

    /// Eccentricity, 0 or more and less than 1.
    #[getter]
    fn eccentricity(&self) -> f64 {
        self.0.elements()[1]
    }

    /// A time of passage through the pericentre.
    #[getter]
    fn time_of_pericentre(&self) -> f64 {
        self.0.elements()[2]
    }

    /// Inclination of the orbit plane, in rad.
    #[getter]
    fn inclination(&self) -> f64 {
        self.0.elements()[3]
    }

    /// Longitude of the ascending node, in rad.
    #[getter]
    fn node(&self) -> f64 {
        self.0.elements()[4]
    }

    /// Argument of the pericentre, from the node, in rad.
    #[getter]
    fn argument_of_pericentre(&self) -> f64 {
        self.0.elements()[5]
    }

    /// Disturbing mass divided by the sum of both masses.
    #[getter]
    fn mass_fraction(&self) -> f64 {
        self.0.elements()[6]
    }

    pub(crate) fn __repr__(&self) -> String {
        let [mean_motion, eccentricity, rest @ ..] = self.0.elements();
        let keywords: Vec<_> = KEYWORDS.iter().zip(rest).map(|(key, value)| format!(", {key}={value:?}")).collect();
        format!("Orbit({mean_motion:?}, {eccentricity:?}{})", keywords.concat())
    }

    pub(crate) fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        PyTuple::new(py, self.0.elements())?.hash()
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let [mean_motion, eccentricity, rest @ ..] = self.0.elements();
        let keywords = PyDict::new(py);
        for (key, value) in KEYWORDS.iter().zip(rest) {
            keywords.set_item(key, value)?;
        }
        ((mean_motion, eccentricity), keywords).into_pyobject(py)
    }
}

/// Warns of angles beyond a whole turn, which are probably in degrees.
pub(crate) fn doubt(py: Python<'_>, orbit: &andoyer_propagate::Orbit) -> PyResult<()> {
    for (argument, angle) in orbit.beyond_a_turn() {
        let said =
            format!("orbit.{argument} = {angle:?} is more than a whole turn: angles are in radians, not in degrees");
        let said = CString::new(said)?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &said, 1)?;
    }
    Ok(())
}

// PyO3 leaves the name of an argument out of the message of its own `TypeError`.
macro_rules! number {
    ($($argument:ident),*) => {
        $(fn $argument(value: &Bound<'_, PyAny>) -> PyResult<f64> {
            array::number(stringify!($argument), value)
        })*
    };
}

number!(mean_motion, eccentricity, time_of_pericentre, inclination, node, argument_of_pericentre, mass_fraction);
