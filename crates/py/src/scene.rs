//! `andoyer.Scene`.

use std::path::PathBuf;

use andoyer_propagate::{MAX_ORDER, State};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::body::Body;
use crate::computing::detached;
use crate::motion::Motion;
use crate::orbit::Orbit;
use crate::{array, error, foreign};

/// A body, its state at an epoch, and the accuracy asked of the solution.
///
/// No unit is built in: time, moments and angular velocity in any consistent set, angles in rad.
///
/// Parameters
/// ----------
/// body : Body
/// attitude : array_like, shape (4,), or scipy.spatial.transform.Rotation
///     Unit quaternion [x, y, z, w], scalar last (Hamilton product), that rotates body components into inertial ones; a norm within 1e-6
///     of 1 is normalized.
/// angular_velocity : array_like, shape (3,)
///     Body components, in rad per unit of time; zero is a body at rest. A Quantity of astropy is taken in SI units, here and wherever
///     numbers are taken; a Time in TDB seconds since J2000.
/// scalar_first : bool, optional
///     Whether `attitude` is [w, x, y, z]. The property `attitude` has the scalar last all the same.
/// epoch : float, optional
///     Time of the state.
/// orbit : Orbit, optional
///     Relative orbit of a body whose gravity gradient acts (theory §9); by default none, and the motion is free.
/// tolerance : float, optional
///     Attitude error asked for over the span, in rad. Below about 1e-14 it means the best that double precision holds
///     (`Plan.error_bound` says what that is).
/// method : {"auto", "series", "closed"}, optional
///     Perturbation series or closed form; "auto" is the closed form, or the series if an order is fixed.
/// order : int, optional
///     Fixed order of the series, of the secular part too (theory §7), 0 to 60; by default, with ``method="series"``, the one that the tolerance needs (theory §5).
///     A fixed order is not raised for the tolerance: where it is too low, `Plan.error_bound` exceeds the tolerance and ``str(plan)``
///     says that it "is not met", and over what.
/// span : (float, float), optional
///     Times over which the tolerance is asked for; by default any within 1e9 rotations. A motion can be evaluated outside it, up to
///     1e15 rotations from the epoch, or 65,534 orbits of ``averaging="spin"``; farther away is a `TimesError` of the motion.
/// averaging : {"auto", "orbit", "spin"}, optional
///     How far the equations of a scene with an orbit are averaged: over rotation and orbit, which leaves formulas; over the rotation alone; by
///     default the first where it meets the tolerance.
/// level : {"full", "moving", "paper"}, optional
///     Terms of the short-period corrections: to all orders in J; at J = 0 alone; those with the disturbing body held fixed, as in the paper.
/// name, source : str, optional
///     What the scene is and where its figures come from: kept, printed, and nothing else.
///
/// Raises
/// ------
/// AttitudeError
///     ``[0, 0, 0, 0]``, ``[0, 0, 0, 1.1]``, or not finite.
/// AngularVelocityError, EpochError
///     Not finite.
/// ToleranceError
///     ``0``, ``-1``, not finite.
/// MethodError
///     ``"taylor"``.
/// OrderError
///     ``-1``, ``61``, ``2.5``.
/// SpanError
///     ``(1, 0)``, or not finite.
/// AveragingError, LevelError
///     ``"moon"``.
/// ShapeError
///     An attitude of 3 numbers, an angular velocity of 4.
/// TypeError
///     A body that is a list, an orbit that is a number, a tolerance or an epoch that is a text, an order that is a boolean.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
/// >>> motion = scene.solve()
/// >>> bool(abs(np.linalg.norm(motion.attitude(100.0)) - 1) < 1e-14)
/// True
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Scene(pub(crate) andoyer_propagate::Scene);

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (
        body, attitude, angular_velocity, *, epoch=0.0, orbit=None, tolerance=1e-12, method="auto", order=None, span=None,
        averaging="auto", level="full", name=None, source=None, scalar_first=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn new(
        body: &Bound<'_, PyAny>,
        attitude: &Bound<'_, PyAny>,
        angular_velocity: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = epoch)] epoch: f64,
        orbit: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = tolerance)] tolerance: f64,
        method: &str,
        order: Option<&Bound<'_, PyAny>>,
        span: Option<&Bound<'_, PyAny>>,
        averaging: &str,
        level: &str,
        name: Option<&str>,
        source: Option<&str>,
        scalar_first: bool,
    ) -> PyResult<Self> {
        let body = body.cast::<Body>().map_err(|_| not_a_body(body))?.get();
        let scalar_first = scalar_first && !foreign::is_rotation(attitude)?;
        let mut attitude = array::fixed("attitude", attitude)?;
        foreign::scalar_last(&mut attitude, scalar_first);
        let angular_velocity = array::fixed("angular_velocity", angular_velocity)?;
        let state = State::new(epoch, attitude, angular_velocity).map_err(error::propagation)?;
        let method = method.parse().map_err(error::propagation)?;
        let mut scene = andoyer_propagate::Scene::new(body.0.clone(), state)
            .tolerance(tolerance)
            .method(method)
            .averaging(averaging.parse().map_err(error::propagation)?)
            .level(level.parse().map_err(error::propagation)?);
        if let Some(orbit) = orbit {
            scene = scene.orbit(orbit.cast::<Orbit>().map_err(|_| not_an_orbit(orbit))?.get().0);
        }
        if let Some(value) = order {
            scene = scene.order(crate::order::order("order", value, 0, MAX_ORDER)?);
        }
        if let Some(value) = span {
            let [start, stop] = array::fixed("span", value)?;
            scene = scene.span(start, stop);
        }
        if let Some(name) = name {
            scene = scene.name(name);
        }
        if let Some(source) = source {
            scene = scene.source(source);
        }
        scene.validate().map_err(error::propagation)?;
        Ok(Self(scene))
    }

    /// The scene of a TOML file.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///
    /// Raises
    /// ------
    /// SceneFileError
    ///     No such file, no TOML, an unknown or missing key, a value that no scene has; the message names file, key and bound.
    #[classmethod]
    fn from_toml(_class: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        andoyer_propagate::Scene::from_toml(path).map(Self).map_err(error::propagation)
    }

    /// The scene as TOML text, which `from_toml` reads back from a file to an equal scene.
    fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    /// The motion: everything that does not depend on time is done here, once.
    ///
    /// Raises
    /// ------
    /// SeparatrixError
    ///     ``method="series"`` where the tolerance needs an order above 60, so near is the separatrix, or on it.
    /// SpinResonanceError
    ///     An orbit that is in resonance with the rotation, or not much slower: the Moon, Dimorphos. The message names the pair (k−j, m).
    /// TorqueError
    ///     An orbit whose torque is too strong for an expansion in it.
    /// AveragingError
    ///     An orbit, and a motion too near the separatrix, a body at rest or on its middle axis, or a round one that turns about an axis across; or more orbits
    ///     than `averaging="spin"` solves.
    /// UnitsError
    ///     The angular momentum, moment × rate, is no normal double: ``1e-200 * 1e-200``.
    fn solve(&self, py: Python<'_>) -> PyResult<Motion> {
        detached(py, error::propagation, || self.0.solve()).map(Motion)
    }

    /// The body.
    #[getter]
    fn body(&self) -> Body {
        Body(self.0.body().clone())
    }

    /// The attitude at the epoch: unit quaternion [x, y, z, w], normalized, a read-only array of shape (4,).
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        array::constant(py, self.0.state().attitude.coords.as_slice()).into_any()
    }

    /// The angular velocity at the epoch, in body components, in rad per unit of time: a read-only array of shape (3,).
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        array::constant(py, self.0.state().angular_velocity.as_slice()).into_any()
    }

    /// The time of the state.
    #[getter]
    fn epoch(&self) -> f64 {
        self.0.state().epoch
    }

    /// The attitude error asked for, in rad.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.0.asked_tolerance()
    }

    /// The method: "auto", "series" or "closed".
    #[getter]
    fn method(&self) -> String {
        self.0.asked_method().to_string()
    }

    /// The fixed order of the series, or None.
    #[getter]
    fn order(&self) -> Option<usize> {
        self.0.asked_order()
    }

    /// The times over which the tolerance is asked for: (start, stop), or None.
    #[getter]
    fn span(&self) -> Option<(f64, f64)> {
        self.0.asked_span()
    }

    /// The orbit of the disturbing body, or None.
    #[getter]
    fn orbit(&self) -> Option<Orbit> {
        self.0.asked_orbit().copied().map(Orbit)
    }

    /// The averaging: "auto", "orbit" or "spin".
    #[getter]
    fn averaging(&self) -> String {
        self.0.asked_averaging().to_string()
    }

    /// The level: "full", "moving" or "paper".
    #[getter]
    fn level(&self) -> String {
        self.0.asked_level().to_string()
    }

    /// The name, or None.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.0.asked_name()
    }

    /// Where the figures come from, or None.
    #[getter]
    fn source(&self) -> Option<&str> {
        self.0.asked_source()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut keywords = String::new();
        for (key, value) in self.keywords(py)?.iter() {
            keywords += &format!(", {key}={}", value.repr()?);
        }
        let state = self.0.state();
        let [attitude, rates] = [state.attitude.coords.as_slice(), state.angular_velocity.as_slice()];
        Ok(format!("Scene({}, {attitude:?}, {rates:?}{keywords})", self.body().__repr__(py)?))
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let state = self.0.state();
        let numbers: ([f64; 4], [f64; 3]) = (state.attitude.coords.into(), state.angular_velocity.into());
        let keywords = PyTuple::new(py, self.keywords(py)?.values())?;
        let [attitude, rates] = [PyTuple::new(py, numbers.0)?, PyTuple::new(py, numbers.1)?];
        (self.body().__hash__(py)?, attitude, rates, keywords).into_pyobject(py)?.hash()
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let state = self.0.state();
        let [attitude, rates] = [state.attitude.coords.as_slice(), state.angular_velocity.as_slice()];
        ((self.body(), attitude, rates), self.keywords(py)?).into_pyobject(py)
    }
}

// PyO3 leaves the name of an argument out of the message of its own `TypeError`.
fn epoch(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    array::number("epoch", value)
}

fn tolerance(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    array::number("tolerance", value)
}

/// What is said of a body that is none.
fn not_a_body(value: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("body must be an andoyer.Body: got {}; use Body([A, B, C])", kind(value)))
}

/// What is said of an orbit that is none.
fn not_an_orbit(value: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("orbit must be an andoyer.Orbit or None: got {}; use Orbit(mean_motion)", kind(value)))
}

/// The name of the type of a value.
fn kind(value: &Bound<'_, PyAny>) -> String {
    value.get_type().name().map_or_else(|_| "something else".to_owned(), |name| name.to_string())
}

impl Scene {
    /// The keyword arguments that make this scene.
    fn keywords<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let keywords = PyDict::new(py);
        keywords.set_item("epoch", self.epoch())?;
        keywords.set_item("orbit", self.orbit())?;
        keywords.set_item("tolerance", self.tolerance())?;
        keywords.set_item("method", self.method())?;
        keywords.set_item("order", self.order())?;
        keywords.set_item("span", self.span())?;
        keywords.set_item("averaging", self.averaging())?;
        keywords.set_item("level", self.level())?;
        keywords.set_item("name", self.name())?;
        keywords.set_item("source", self.source())?;
        Ok(keywords)
    }
}
