//! `andoyer.Ensemble`.

use std::sync::atomic::{AtomicBool, AtomicUsize};

use andoyer_propagate::ensemble::{MAX_THREADS, OnError};
use andoyer_propagate::error::Kind;
use andoyer_propagate::options::{Level, Method};
use andoyer_propagate::periods::Periods;
use andoyer_series::threads::alone;
use numpy::{IntoPyArray, PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::array::{MemberRows, chunks, constant, constant_rows, span as span_of, write};
use crate::computing::interruptible;
use crate::error;
use crate::foreign::{self, Calendar};
use crate::mean;
use crate::members::Members;
use crate::order::whole_number;
use crate::partials::Partials;
use crate::plan::Plan;
use crate::progress::counted;
use crate::samples::Samples;
use crate::scene_class::Scene;
use crate::torque;
use crate::values::immutable;

mod arguments;
mod bodies;
mod copies;
mod distribution;
mod evaluate;
mod from_periods;
mod orbital;
use arguments::{asked, epochs_of, orbits_given, refused, scenes_of, tolerance};
use bodies::Bodies;
use from_periods::Clones;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
/// Number of members above which the construction of an ensemble, which checks each member, counts as a long call.
const LONG: usize = 1 << 16;

#[doc = include_str!("ensemble.md")]
#[expect(clippy::doc_lazy_continuation, reason = "lines after >>> are what Python prints")]
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Ensemble(andoyer_propagate::Ensemble, Vec<Calendar>);

immutable!(Ensemble);

#[pymethods]
impl Ensemble {
    #[new]
    #[pyo3(signature = (moments, attitudes, angular_velocities, *, bodies=None, epochs=None, orbit=None, orbits=None, torques=None, tolerance=1e-12, method="auto", level="auto", span=None, threads=None, errors="raise", scalar_first=false))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn new(
        py: Python<'_>,
        moments: Option<&Bound<'_, PyAny>>,
        attitudes: &Bound<'_, PyAny>,
        angular_velocities: &Bound<'_, PyAny>,
        bodies: Option<&Bound<'_, PyAny>>,
        epochs: Option<&Bound<'_, PyAny>>,
        orbit: Option<&Bound<'_, PyAny>>,
        orbits: Option<&Bound<'_, PyAny>>,
        torques: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = tolerance)] tolerance: f64,
        method: &str,
        level: &str,
        span: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
        errors: &str,
        scalar_first: bool,
    ) -> PyResult<Self> {
        let bodies = Bodies::given(moments, bodies)?;
        let (attitudes, scalar_first) = foreign::attitudes("attitudes", attitudes, scalar_first)?;
        let mut attitudes = MemberRows::new("attitudes", &attitudes)?;
        attitudes.each(|quaternion| foreign::scalar_last(quaternion, scalar_first));
        let rates = MemberRows::new("angular_velocities", angular_velocities)?;
        let threads = threads.map(|value| whole_number("threads", value, 1, MAX_THREADS, Kind::Input)).transpose()?;
        let orbits = orbits_given(orbit, orbits)?;
        let torques = torques.map(torque::torques).transpose()?.unwrap_or_default();
        let on_error: OnError = errors.parse().map_err(error::propagation)?;
        let method: Method = method.parse().map_err(error::propagation)?;
        let level: Level = level.parse().map_err(error::propagation)?;
        let (epochs, calendar) = epochs.map(epochs_of).transpose()?.unwrap_or_default();
        let first = epochs.first().copied().unwrap_or(0.0);
        let span = span.map(|value| span_of(value, first, calendar.first().copied())).transpose()?;
        let members = bodies.members(&attitudes, &rates)?;
        let new = |stop: &AtomicBool| {
            let states = (attitudes.repeated(members), rates.repeated(members));
            let checked = || bodies.ensemble(members, states, on_error, stop);
            let ensemble = if threads == Some(1) { alone(checked) } else { checked() }?;
            let ensemble = if epochs.is_empty() { ensemble } else { ensemble.epochs(epochs)? };
            let span = span.map(|[start, stop]: [f64; 2]| (start, stop));
            let ensemble = ensemble.tolerance(tolerance).method(method).level(level).torques(torques);
            let ensemble = asked(ensemble, orbits, span, threads)?;
            ensemble.validate().map(|()| ensemble)
        };
        interruptible(py, members >= LONG, error::propagation, new).map(|ensemble| Self(ensemble, calendar))
    }

    /// An ensemble of scenes of any kind: free bodies, one or several orbits, tables, torques, locked rotation, each with its own options.
    ///
    /// Parameters
    /// ----------
    /// scenes : sequence of Scene
    ///     The epochs must be all numbers or all calendar times. An `Error` in the place of a scene is that of a member without one.
    /// threads : int, optional
    ///     Number of threads, 1 to 1024; by default one for each core.
    /// errors : {"raise", "nan"}, optional
    ///     What becomes of members that cannot be solved, as for `Ensemble`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     Calendar epochs beside numbers; an unknown `errors`; threads outside 1 to 1024.
    /// TypeError
    ///     A member that is not a `Scene` or an `Error`.
    ///
    /// Examples
    /// --------
    /// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], span=(0, 10), tolerance=1e-9)
    /// >>> braked = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], span=(0, 10), torques=Torque.damping(1e-3))
    /// >>> ensemble = Ensemble.from_scenes([scene, braked])
    /// >>> ensemble.attitude(5.0).shape, [plan.method for plan in ensemble.plans]
    /// ((2, 4), ['closed', 'integrated'])
    #[staticmethod]
    #[pyo3(signature = (scenes, *, threads=None, errors="raise"))]
    fn from_scenes(scenes: &Bound<'_, PyAny>, threads: Option<&Bound<'_, PyAny>>, errors: &str) -> PyResult<Self> {
        let threads = threads.map(|value| whole_number("threads", value, 1, MAX_THREADS, Kind::Input)).transpose()?;
        let on_error: OnError = errors.parse().map_err(error::propagation)?;
        let (scenes, calendar) = scenes_of(scenes)?;
        let ensemble = andoyer_propagate::Ensemble::from_scenes(scenes, on_error);
        let ensemble = ensemble.and_then(|ensemble| asked(ensemble, None, None, threads));
        ensemble.map(|ensemble| Self(ensemble, calendar)).map_err(error::propagation)
    }

    /// An ensemble of torque-free bodies that tumble with these periods, each as `Scene.from_periods` has it: clones of a tumbler whose periods, pole and phases are uncertain.
    ///
    /// Parameters
    /// ----------
    /// bodies : Body or sequence of m Body, or array_like, shape (3,) or (m, 3)
    ///     Bodies, or principal moments.
    /// precession, rotation : float or array_like, shape (m,)
    ///     P_φ and P_ψ, in units of time.
    /// mode : {"short-axis", "long-axis"}, or a sequence of m of them, optional
    /// directions : array_like, shape (3,), (2,), (m, 3) or (m, 2), optional
    ///     Directions of the angular momentum: inertial components of any length, or (longitude, latitude) in rad; by default inertial axis 3. Of two members (2, 2) are two pairs.
    /// phases : array_like, shape (2,) or (m, 2), optional
    ///     Phases of P_ψ and P_φ at the epoch, in turns; by default 0.
    /// convention : {"extremal-axis", "long-axis", "short-axis"}, optional
    ///     The axis of the periods.
    /// epoch : float or Time, optional
    ///     Time of all states.
    /// orbit, torques, tolerance, method, level, span : optional
    ///     Those of all scenes, as for `Scene`.
    /// threads, errors : optional
    ///     As for `Ensemble`. With ``errors="nan"`` members that no body can have are NaN, and `Ensemble.errors` counts them.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A member that no body can have, with its number; arguments with different numbers of rows, or none with an axis of members.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> body = Body([1, 3.0836, 3.235])
    /// >>> clones = Ensemble.from_periods(body, 27.38 + 0.1 * np.arange(3), 263.0, "short-axis", (4.8, -1.48), phases=(0.2, 0.3))
    /// >>> clones.periods["extremal-axis"].precession.round(9)
    /// array([27.38, 27.48, 27.58])
    #[staticmethod]
    #[pyo3(signature = (bodies, precession, rotation, mode=None, directions=None, *, phases=None, convention="extremal-axis", epoch=None, threads=None, errors="raise", **options))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn from_periods(
        bodies: &Bound<'_, PyAny>,
        precession: &Bound<'_, PyAny>,
        rotation: &Bound<'_, PyAny>,
        mode: Option<&Bound<'_, PyAny>>,
        directions: Option<&Bound<'_, PyAny>>,
        phases: Option<&Bound<'_, PyAny>>,
        convention: &str,
        epoch: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
        errors: &str,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let clones = Clones::new(bodies, [precession, rotation], mode, directions, phases)?;
        let (ensemble, calendar) = clones.ensemble((convention, epoch), (threads, errors), options)?;
        Ok(Self(ensemble, calendar.into_iter().collect()))
    }

    /// How all members tumble at a time: the free motions from their states then.
    ///
    /// Parameters
    /// ----------
    /// time : float, or a Time where the epochs are Time objects
    ///
    /// Returns
    /// -------
    /// Distribution
    ///     Modes, periods, E/E0, angular momenta, and which members have changed their mode; quantiles and shares; `andoyer.plot.distribution` draws it.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     Several times.
    ///
    /// Examples
    /// --------
    /// >>> ensemble = Ensemble([1, 1.5, 2], [0, 0, 0, 1], [[0.1, 0.2, 1], [1, 0.2, 0.1]], torques=Torque.damping(0.02), span=(0, 40), tolerance=1e-9)
    /// >>> ensemble.after(40.0).share()
    /// {'long-axis': 0.5, 'short-axis': 0.5}
    fn after<'py>(&self, py: Python<'py>, time: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.distribution(py, time)
    }

    /// The scene of every member, a list. With ``errors="nan"`` the scene of a member that is not a valid body or state is None.
    ///
    /// Examples
    /// --------
    /// >>> ensemble = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [0.1, 0.2, 1.0], tolerance=1e-9)
    /// >>> ensemble.scenes[1].body.moments, ensemble.scenes[1].tolerance
    /// (array([1. , 2. , 2.5]), 1e-09)
    #[getter]
    fn scenes(&self, py: Python<'_>) -> PyResult<Vec<Option<Scene>>> {
        let scene = |index: usize| match self.0.scene(index) {
            Ok(scene) => Ok(Some(Scene { calendar: self.calendar(index), ..scene.into() })),
            Err(_) if self.0.asked_on_error() == OnError::Nan => Ok(None),
            Err(problem) => Err(error::propagation(problem)),
        };
        py.check_signals()?;
        (0..self.0.len()).map(scene).collect()
    }

    /// The torques beside the gravity gradient on all members, a tuple; None where members of `from_scenes` differ.
    #[getter]
    fn torques<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyTuple>>> {
        let same = self.0.has_in_common(|scene| scene.asked_torques().to_vec());
        same.then(|| torque::tuple(py, self.0.asked_torques())).transpose()
    }

    /// The level asked for: "auto", "full", "second-order", "moving" or "paper"; None where members of `from_scenes` differ.
    #[getter]
    fn level(&self) -> Option<String> {
        self.0.has_in_common(andoyer_propagate::Scene::asked_level).then(|| self.0.asked_level().to_string())
    }

    /// The moments about body axes 1, 2, 3: a read-only array, shape (m, 3). If tensors were given, they are the principal moments, as `Body.moments`.
    #[getter]
    fn moments<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant_rows(py, self.0.moments())
    }

    /// The inertia tensors as given, diagonal if moments were given: a read-only array, shape (m, 3, 3).
    ///
    /// Examples
    /// --------
    /// >>> tensors = [[[1.5, 0.5, 0], [0.5, 1.5, 0], [0, 0, 2]]] * 2
    /// >>> ensemble = Ensemble(tensors, [0, 0, 0, 1], [[0, 0, 1], [0.1, 0.2, 1]])
    /// >>> ensemble.inertia[1, 0], ensemble.moments[1].round(12)
    /// (array([1.5, 0.5, 0. ]), array([1., 2., 2.]))
    #[getter]
    fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let tensors: Vec<f64> = (0..self.0.len()).flat_map(|k| self.0.inertia(k)).flatten().collect();
        let array = tensors.into_pyarray(py).reshape(vec![self.0.len(), 3, 3])?;
        array.readwrite().make_nonwriteable();
        Ok(array)
    }

    /// Evaluates attitudes and angular velocities of all members in one pass.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///     Times for all members, or a row of times for each member.
    /// scalar_first : bool, optional
    ///     If True, quaternions are [w, x, y, z]; by default [x, y, z, w].
    /// progress : callable, optional
    ///     Called as ``progress(done, members)`` while members are solved and evaluated, some times a second. An exception in it stops the evaluation and is raised to the caller.
    ///
    /// Returns
    /// -------
    /// Samples
    ///     With a leading axis of members: attitudes (m, n, 4), angular velocities (m, n, 3); for a scalar time (m, 4) and (m, 3).
    ///
    /// Warns
    /// -----
    /// ToleranceWarning
    ///     Some members miss the tolerance; the warning states their number and the worst member.
    ///
    /// Raises
    /// ------
    /// RepresentationError
    ///     Errors of times as for a motion and of units as for a scene; the attribute ``index`` is the first member with the error.
    /// InputError
    ///     Another number of rows than members.
    #[pyo3(signature = (times, *, scalar_first=false, progress=None))]
    fn at(
        &self,
        py: Python<'_>,
        times: &Bound<'_, PyAny>,
        scalar_first: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Samples> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let [copy, attitude, rates] = times.samples()?;
        let outcome = {
            let (mut attitude, mut rates) = (write(&attitude)?, write(&rates)?);
            let (values, attitude, rates) = (times.values()?, chunks(&mut attitude)?, chunks(&mut rates)?);
            let done = AtomicUsize::new(0);
            let evaluate = |stop: &AtomicBool| {
                let outcome = self.run(since_epoch, stop).counting(&done).samples_into(values, attitude, rates)?;
                foreign::scalar_first(attitude, scalar_first, stop);
                Ok(outcome)
            };
            match progress {
                Some(progress) => counted(progress, (&done, self.0.len()), evaluate)?,
                None => interruptible(py, times.long(), error::propagation, evaluate)?,
            }
        };
        error::warn_of_tolerance(py, outcome.missed_tolerance())?;
        let samples = Samples::new(copy.unbind(), attitude.unbind(), rates.unbind(), scalar_first);
        Ok(samples.given(times.given()).refused(refused(py, outcome)))
    }

    /// Evaluates attitudes of all members: unit quaternions [x, y, z, w] that rotate body components into inertial ones.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    /// out : ndarray, float64, C-contiguous, shape (m, n, 4), optional
    ///     Array for the result. After an error it contains the values computed so far.
    /// scalar_first : bool, optional
    ///     If True, quaternions are [w, x, y, z].
    ///
    /// Returns
    /// -------
    /// ndarray, shape (m, n, 4)
    ///     Unit quaternions; this is `out` if `out` was given.
    #[pyo3(signature = (times, out=None, *, scalar_first=false))]
    fn attitude<'py>(
        &self,
        times: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        scalar_first: bool,
    ) -> PyResult<Array<'py>> {
        self.rows(times, out, |run, values, rows, stop| {
            let outcome = run.attitudes_into(values, rows)?;
            foreign::scalar_first(rows, scalar_first, stop);
            Ok(outcome)
        })
    }

    /// Evaluates the angular momenta of all members in inertial components, in the unit of moment × rate. They are constant unless a member has an orbit.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///
    /// Returns
    /// -------
    /// ndarray, shape (m, n, 3)
    ///
    /// Examples
    /// --------
    /// >>> ensemble = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [0.1, 0.2, 1.0])
    /// >>> ensemble.angular_momentum(10.0)
    /// array([[0.1, 0.3, 2. ],
    ///        [0.1, 0.4, 2.5]])
    fn angular_momentum<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        self.rows(times, None, |run, values, rows, _| run.angular_momenta_into(values, rows))
    }

    /// Evaluates the Andoyer variables (λ, μ, ν, Λ, M, N) of all members, as defined in `Motion.andoyer` (theory §1).
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///
    /// Returns
    /// -------
    /// ndarray, shape (m, n, 6)
    ///     Angles in rad, momenta in the unit of moment × rate.
    ///
    /// Examples
    /// --------
    /// The last variable, N, is the component of the angular momentum on axis 3.
    ///
    /// >>> ensemble = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [0.1, 0.2, 1.0])
    /// >>> ensemble.andoyer(0.0)[:, 5].round(12)
    /// array([2. , 2.5])
    fn andoyer<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        self.rows(times, None, |run, values, rows, _| run.andoyer_into(values, rows))
    }

    /// Evaluates attitudes of all members as a `scipy.spatial.transform.Rotation`, body to inertial. This method imports SciPy.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///
    /// Returns
    /// -------
    /// scipy.spatial.transform.Rotation
    ///     Of shape (m, n); for a scalar time (m,).
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     SciPy is not installed; ``pip install scipy`` installs it.
    /// ValueError
    ///     Several times with SciPy before 1.17, whose rotations have only one axis.
    ///
    /// Examples
    /// --------
    /// >>> ensemble = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [[0, 0, 0.5], [0, 0, 1]])
    /// >>> ensemble.rotation(1.0).magnitude().round(12)
    /// array([0.5, 1. ])
    fn rotation<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        foreign::rotation(&self.attitude(times, None, false)?)
    }

    /// Evaluates the derivatives of attitude and angular velocity of all members, as defined in `Motion.partials` (theory §12).
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///
    /// Returns
    /// -------
    /// Partials
    ///     With a leading axis of members: arrays of shape (m, n, 3, 9), for a scalar time (m, 3, 9); of inertia tensors (m, n, 3, 12) and (m, 3, 12). With
    ///     ``errors="nan"`` they are NaN for a member without derivatives.
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     A member on the separatrix, whose frequencies have no derivatives.
    ///
    /// Examples
    /// --------
    /// After 10 units of time, the angle of rotation about axis 3 grows by 10 for each unit of the rate.
    ///
    /// >>> ensemble = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [0, 0, 2.0])
    /// >>> ensemble.partials(10.0).attitude[:, 2, 5]
    /// array([10., 10.])
    fn partials(&self, times: &Bound<'_, PyAny>) -> PyResult<Partials> {
        if self.0.asked_tensors().is_empty() {
            self.derivatives(times, |run, times, attitudes, rates| run.partials_into(times, attitudes, rates))
        } else {
            self.derivatives(times, |run, times, attitudes, rates| run.inertia_partials_into(times, attitudes, rates))
        }
    }

    /// Mean periods (P_φ, P_ψ) of all members in three conventions, as defined in `Motion.periods`.
    ///
    /// A dict with the keys "long-axis", "short-axis" and "extremal-axis"; values are named tuples (precession, rotation) of arrays, shape (m,), infinite if a
    /// member has no such period.
    ///
    /// Examples
    /// --------
    /// >>> ensemble = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [[0.1, 0.2, 1.0], [1.0, 0.2, 0.1]])
    /// >>> [periods.precession.round(3).tolist() for periods in ensemble.periods.values()]
    /// [[6.176, 12.558], [3.936, 5.984], [3.936, 12.558]]
    #[getter]
    fn periods<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut rows = vec![[Periods { precession: 0.0, rotation: 0.0 }; 3]; self.0.len()];
        self.values(py, |run| run.periods_into(&mut rows))?;
        mean::of_members(py, rows.iter())
    }

    /// E/E0 of all members, shape (m,): the rotational energy divided by the energy of rotation about the axis of greatest inertia with the same angular momentum (theory §5).
    ///
    /// Examples
    /// --------
    /// >>> Ensemble([1, 1.5, 2], [0, 0, 0, 1], [[1, 0, 0], [0, 0, 1]]).energy_ratio
    /// array([2., 1.])
    #[getter]
    fn energy_ratio<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut ratios = vec![0.0; self.0.len()];
        self.values(py, |run| run.energy_ratios_into(&mut ratios))?;
        Ok(ratios.into_pyarray(py))
    }

    /// The plan of every member: a list of `Plan`. With ``errors="nan"`` the plan of an invalid member is None.
    #[getter]
    fn plans(&self, py: Python<'_>) -> PyResult<Vec<Option<Plan>>> {
        let plans = self.solved(py)?.into_iter();
        match self.0.asked_on_error() {
            OnError::Nan => Ok(plans.map(|plan| plan.ok().map(Plan)).collect()),
            _ => plans.map(|plan| plan.map(|plan| Some(Plan(plan))).map_err(error::propagation)).collect(),
        }
    }

    /// The errors of members that have no motion, by index. This property solves all members; it is empty if every member has a motion.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let errors = PyDict::new(py);
        for (index, plan) in self.solved(py)?.into_iter().enumerate() {
            if let Err(problem) = plan {
                errors.set_item(index, error::propagation(problem).into_value(py))?;
            }
        }
        Ok(errors)
    }

    /// The times of the states: a float for all members, or a read-only array, shape (m,).
    #[getter]
    fn epochs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self.0.asked_epochs() {
            [] => Ok(0.0_f64.into_pyobject(py)?.into_any()),
            [of_all] => Ok(of_all.into_pyobject(py)?.into_any()),
            each => Ok(constant(py, each).into_any()),
        }
    }

    /// The attitudes at the epoch as given: unit quaternions [x, y, z, w], a read-only array, shape (m, 4).
    #[getter]
    fn attitudes<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant_rows(py, self.0.attitudes())
    }

    /// The angular velocities at the epoch in body components, in rad per unit of time: a read-only array, shape (m, 3).
    #[getter]
    fn angular_velocities<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant_rows(py, self.0.angular_velocities())
    }

    /// The requested attitude error, in rad; None where members of `from_scenes` differ.
    #[getter]
    fn tolerance(&self) -> Option<f64> {
        self.0.has_in_common(andoyer_propagate::Scene::asked_tolerance).then(|| self.0.asked_tolerance())
    }

    /// The method asked for: "auto", "series", "closed", "integrated" or "libration"; None where members of `from_scenes` differ.
    #[getter]
    fn method(&self) -> Option<String> {
        self.0.has_in_common(andoyer_propagate::Scene::asked_method).then(|| self.0.asked_method().to_string())
    }

    /// The orbits: an Orbit for all members, a list of one or None for each, or None.
    #[getter]
    fn orbits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.orbits_as_given(py)
    }

    /// The span, the times over which `tolerance` is requested, or None; None too where members of `from_scenes` differ.
    #[getter]
    fn span(&self) -> Option<(f64, f64)> {
        self.0.asked_span()
    }

    /// The requested number of threads, or None.
    #[getter]
    fn threads(&self) -> Option<usize> {
        self.0.asked_threads()
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __iter__(slf: Py<Self>) -> Members {
        Members::of(slf.into_any())
    }

    fn __getitem__<'py>(&self, py: Python<'py>, index: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.member_or_part(py, index)
    }

    fn __repr__(&self) -> String {
        self.text()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        self.reduced(py)
    }
}
