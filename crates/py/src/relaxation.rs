//! `andoyer.Relaxation`.

use andoyer_propagate::Mode;
use andoyer_propagate::dissipation::{self, RelaxedState};
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;

use crate::array::{number, shaped};
use crate::error;
use crate::material::Material;
use crate::values::immutable;

/// The relaxation of a free body at constant angular momentum, from `Dissipation.relax`.
///
/// A body passes from rotation about its long axis through the long-axis mode, the separatrix and the short-axis mode to rotation about its short axis. Both ends are
/// exponential in time; the separatrix is passed in finite time. Phases are not known, and near the separatrix the time depends on them: the averages are wrong there by some turns
/// of the polhode.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> body = Body.ellipsoid(1.0, 0.7, 0.5)
/// >>> dissipation = Dissipation(body, (1.0, 0.7, 0.5), Material(density=1.0, rigidity=1.0, quality=1.0))
/// >>> x, (A, B, C) = 0.01, body.moments                                # M/C = 1, sin² of the largest angle 0.01
/// >>> scene = Scene(body, [0, 0, 0, 1], [C / A * (1 - x) ** 0.5, C / B * x**0.5, 0])
/// >>> relaxation = dissipation.relax(scene)
/// >>> round(relaxation.time_to(np.pi / 2), 6), round(relaxation.time_to(0.1), 3)      # to the separatrix, and to 0.1 rad from the short axis
/// (15.283881, 51.524)
/// >>> relaxation.at([0.0, 20.0, 40.0]).mode
/// array(['long-axis', 'short-axis', 'short-axis'], dtype='<U10')
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Relaxation {
    pub(crate) inner: dissipation::Relaxation,
    pub(crate) material: Py<Material>,
    /// The `Dissipation` and the scene or motion from which it is.
    pub(crate) dissipation: Py<PyAny>,
    pub(crate) scene: Py<PyAny>,
}

immutable!(Relaxation);

/// A mode by its name.
pub(crate) fn mode_of(mode: &str) -> PyResult<Mode> {
    mode.parse().map_err(error::propagation)
}

#[pymethods]
impl Relaxation {
    /// The states at times after that of the scene.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times since the epoch of the scene, in its unit of time; negative ones are in the past.
    ///
    /// Returns
    /// -------
    /// RelaxedStates
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A time that is not finite; with A = B a time before the body rotated about an axis of least inertia.
    fn at(&self, py: Python<'_>, times: &Bound<'_, PyAny>) -> PyResult<RelaxedStates> {
        let (times, shape) = shaped("times", times)?;
        let compute = || times.iter().map(|time| self.inner.at(*time)).collect();
        Ok(RelaxedStates { states: self.material.get().detached(py, compute)?, shape })
    }

    /// The time after the state of the scene at which the largest angle between the angular momentum and the axis of a mode is `angle`.
    ///
    /// Parameters
    /// ----------
    /// angle : float
    ///     In rad, above 0 and at most π/2, which is the separatrix.
    /// mode : {"short-axis", "long-axis"}, optional
    ///     The short axis is that of greatest inertia. In the long-axis mode the angle from the long axis grows.
    ///
    /// Returns
    /// -------
    /// float
    ///     In units of time; negative if it was before the state.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An angle outside its bounds; a mode that the body does not have, since two moments are equal.
    #[pyo3(signature = (angle, mode="short-axis"))]
    fn time_to(&self, py: Python<'_>, angle: &Bound<'_, PyAny>, mode: &str) -> PyResult<f64> {
        let (angle, mode) = (number("angle", angle)?, mode_of(mode)?);
        self.material.get().detached(py, || self.inner.time_to(angle, mode))
    }

    /// The dissipation.
    #[getter]
    fn dissipation(&self, py: Python<'_>) -> Py<PyAny> {
        self.dissipation.clone_ref(py)
    }

    /// The scene or the motion whose state relaxes.
    #[getter]
    fn scene(&self, py: Python<'_>) -> Py<PyAny> {
        self.scene.clone_ref(py)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Py<PyAny>,))> {
        Ok((self.dissipation.bind(py).getattr("relax")?, (self.scene.clone_ref(py),)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let state = self.material.get().detached(py, || self.inner.at(0.0))?;
        Ok(format!("<Relaxation from {:.6} rad in the {} mode>", state.angle, state.mode))
    }
}

/// States of a relaxation at given times, from `Relaxation.at`. For a scalar time the arrays have no axis.
///
/// Examples
/// --------
/// >>> body = Body.ellipsoid(1.0, 0.7, 0.5)
/// >>> dissipation = Dissipation(body, (1.0, 0.7, 0.5), Material(density=1.0, rigidity=1.0, quality=1.0))
/// >>> states = dissipation.relax(Scene(body, [0, 0, 0, 1], [0, 0.5, 1.0])).at([0.0, 10.0])
/// >>> bool(states.angle[1] < states.angle[0]), bool(states.energy_ratio[1] < states.energy_ratio[0])
/// (True, True)
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct RelaxedStates {
    states: Vec<RelaxedState>,
    shape: Vec<usize>,
}

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

impl RelaxedStates {
    fn each<'py>(&self, py: Python<'py>, value: impl Fn(&RelaxedState) -> f64) -> PyResult<Array<'py>> {
        self.states.iter().map(value).collect::<Vec<_>>().into_pyarray(py).reshape(self.shape.clone())
    }
}

#[pymethods]
impl RelaxedStates {
    /// The times after the state of the scene, shape (n,).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.each(py, |state| state.time)
    }

    /// The modes, "long-axis" or "short-axis": an array of texts, shape (n,).
    #[getter]
    fn mode<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let modes: Vec<String> = self.states.iter().map(|state| state.mode.to_string()).collect();
        let array = py.import("numpy")?.getattr("array")?.call1((modes, "U10"))?;
        array.call_method1("reshape", (self.shape.clone(),))
    }

    /// The largest angle between the angular momentum and the axis of the mode on the polhode, in rad, shape (n,).
    #[getter]
    fn angle<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.each(py, |state| state.angle)
    }

    /// E/E0, the rotational energy over that of rotation about the axis of greatest inertia with the same angular momentum, shape (n,).
    #[getter]
    fn energy_ratio<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.each(py, |state| state.energy_ratio)
    }

    /// The loss of energy in the unit of time, shape (n,).
    #[getter]
    fn power<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.each(py, |state| state.power)
    }

    fn __len__(&self) -> PyResult<usize> {
        let none = || pyo3::exceptions::PyTypeError::new_err("states at a scalar time have no len()");
        self.shape.first().copied().ok_or_else(none)
    }

    fn __repr__(&self) -> String {
        format!("<RelaxedStates at {}>", crate::samples::counted(self.states.len(), "time"))
    }
}
