//! `andoyer.Ensemble`.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::ensemble::{MAX_THREADS, OnError, Outcome};
use andoyer_propagate::error::Kind;
use numpy::PyArrayDyn;
use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice, PyTuple};

use crate::array::{MemberRows, Times, chunks, constant, constant_rows, number, numbers_of, span as span_of, write};
use crate::computing::{detached, interruptible};
use crate::error;
use crate::foreign::{self, Calendar};
use crate::members::Members;
use crate::motion::Motion;
use crate::orbit::Orbit;
use crate::order::whole_number;
use crate::plan::Plan;
use crate::samples::Samples;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Number of members above which the construction of an ensemble, which checks each member, counts as a long call.
const LONG: usize = 1 << 16;

/// Many bodies with their states. They are solved and evaluated member by member on all cores, in memory proportional to the result.
///
/// The result of a member is equal to that of `Scene` and `Motion`, to the last bit and for any number of threads. ``ensemble[i]`` is the motion
/// of member i, and ``ensemble[i:j]`` is the ensemble of the members i to j − 1.
///
/// Parameters
/// ----------
/// moments : array_like, shape (m, 3) or (3,)
///     Moments about body axes 1, 2, 3, as for `Body`. In this and the next two arguments a single row is used for all members; at least one argument
///     has m rows.
/// attitudes : array_like, shape (m, 4) or (4,), or scipy.spatial.transform.Rotation
///     Unit quaternions [x, y, z, w] at the epoch, as for `Scene`.
/// angular_velocities : array_like, shape (m, 3) or (3,)
///     Body components at the epoch, in rad per unit of time.
/// epochs : float or array_like, shape (m,), or astropy.time.Time of these shapes, optional
///     Times of the states: one for all members, or one for each; by default 0.
/// orbits : Orbit or sequence of m Orbit or None, optional
///     The orbit of a body whose gravity gradient acts on all members, or a sequence with an orbit or None for each member. Solving a member with an orbit takes
///     0.2 to 0.3 ms, other members about 5 µs.
/// tolerance : float, optional
///     Requested attitude error within `span`, in rad.
/// span : (float, float), optional
///     The times over which `tolerance` is requested and error bounds hold; by default 1e9 rotations. Give a span if there is an orbit, since its error bound grows with
///     time.
/// threads : int, optional
///     Number of threads, 1 to 1024; by default one for each core.
/// errors : {"raise", "nan"}, optional
///     With "raise", a member that is not a valid body or state, or cannot be solved, raises an error that names it. With "nan", its rows are NaN, its plan is None, and the error is in
///     `Ensemble.errors` and `Samples.errors`.
/// scalar_first : bool, optional
///     If True, the argument `attitudes` has [w, x, y, z]. The property `attitudes` always has [x, y, z, w].
///
/// Raises
/// ------
/// InputError
///     A member that is not a valid body or state. The message and the attribute ``index`` of the exception state the number of the
///     member; the message also states how many other members are invalid.
///     An epoch, a tolerance or a span that is not finite; a tolerance that is not positive; the span ``(1, 0)``; an unknown `errors`.
///     A number of threads outside 1 to 1024 or not whole; on evaluation, more threads than the system provides.
///     Arrays with different numbers of rows, or three arrays without an axis of members.
///
/// Examples
/// --------
/// >>> moments = [[1.0, 1.5, 2.0], [1.0, 2.0, 2.5]]
/// >>> ensemble = Ensemble(moments, [0, 0, 0, 1], [[0.1, 0.2, 1.0], [1.0, 0.2, 0.1]])
/// >>> ensemble.at([0.0, 10.0, 20.0]).attitude.shape
/// (2, 3, 4)
/// >>> [plan.mode for plan in ensemble.plans]
/// ['short-axis', 'long-axis']
/// >>> sun = Orbit(2e-3, 0.1)
/// >>> under_the_sun = Ensemble([1, 1.02, 1.05], [0, 0, 0, 1], [[0, 0, 1], [0, 0.1, 1]], orbits=[sun, None], tolerance=1e-6, span=(0, 1e5))
/// >>> [plan.torque > 0 for plan in under_the_sun.plans]
/// [True, False]
/// >>> Ensemble([[1.0, 1.5, 2.0], [1.0, 1.0, 2.5]], [0, 0, 0, 1], [0, 0, 1])
/// Traceback (most recent call last):
///     ...
/// andoyer.InputError: member 1: moments = [1.0, 1.0, 2.5]: the largest must not exceed the sum of the other two (it is 1.25 times that sum)
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Ensemble(andoyer_propagate::Ensemble, Vec<Calendar>);

#[pymethods]
impl Ensemble {
    #[new]
    #[pyo3(signature = (moments, attitudes, angular_velocities, *, epochs=None, orbits=None, tolerance=1e-12, span=None, threads=None, errors="raise", scalar_first=false))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn new(
        py: Python<'_>,
        moments: &Bound<'_, PyAny>,
        attitudes: &Bound<'_, PyAny>,
        angular_velocities: &Bound<'_, PyAny>,
        epochs: Option<&Bound<'_, PyAny>>,
        orbits: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = tolerance)] tolerance: f64,
        span: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
        errors: &str,
        scalar_first: bool,
    ) -> PyResult<Self> {
        let moments = MemberRows::new("moments", moments)?;
        let scalar_first = scalar_first && !foreign::is_rotation(attitudes)?;
        let mut attitudes = MemberRows::new("attitudes", attitudes)?;
        attitudes.each(|quaternion| foreign::scalar_last(quaternion, scalar_first));
        let rates = MemberRows::new("angular_velocities", angular_velocities)?;
        let threads = threads.map(|value| whole_number("threads", value, 1, MAX_THREADS, Kind::Input)).transpose()?;
        let orbits = orbits.map(orbits_of).transpose()?;
        let on_error: OnError = errors.parse().map_err(error::propagation)?;
        let (epochs, calendar) = epochs.map(epochs_of).transpose()?.unwrap_or_default();
        let first = epochs.first().copied().unwrap_or(0.0);
        let span = span.map(|value| span_of(value, first, calendar.first().copied())).transpose()?;
        let Some(members) = moments.members().or(attitudes.members()).or(rates.members()) else {
            let text =
                "moments, attitudes and angular_velocities are one row each: one of them must have an axis of members";
            return Err(error::input("moments", "one row", "(m, 3)", text.to_owned()));
        };
        let new = |stop: &AtomicBool| {
            let [moments, rates] = [moments, rates].map(|rows| rows.repeated(members));
            let attitudes = attitudes.repeated(members);
            let ensemble = andoyer_propagate::Ensemble::new_or(moments, attitudes, rates, on_error, stop)?;
            let ensemble = if epochs.is_empty() { ensemble } else { ensemble.epochs(epochs)? };
            let span = span.map(|[start, stop]: [f64; 2]| (start, stop));
            let ensemble = asked(ensemble.tolerance(tolerance), orbits, span, threads)?;
            ensemble.validate().map(|()| ensemble)
        };
        interruptible(py, members >= LONG, error::propagation, new).map(|ensemble| Self(ensemble, calendar))
    }

    /// Evaluates attitudes and angular velocities of all members in one pass.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///     Times for all members, or a row of times for each member.
    /// scalar_first : bool, optional
    ///     If True, quaternions are [w, x, y, z]; by default [x, y, z, w].
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
    #[pyo3(signature = (times, *, scalar_first=false))]
    fn at(&self, py: Python<'_>, times: &Bound<'_, PyAny>, scalar_first: bool) -> PyResult<Samples> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let [copy, attitude, rates] = times.samples()?;
        let outcome = {
            let (mut attitude, mut rates) = (write(&attitude)?, write(&rates)?);
            let (values, attitude, rates) = (times.values()?, chunks(&mut attitude)?, chunks(&mut rates)?);
            let evaluate = |stop: &AtomicBool| {
                let outcome = self.run(since_epoch, stop).samples_into(values, attitude, rates)?;
                foreign::scalar_first(attitude, scalar_first, stop);
                Ok(outcome)
            };
            interruptible(py, times.long(), error::propagation, evaluate)?
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
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let evaluate = |values: &[f64], rows: &mut [[f64; 4]], stop: &AtomicBool| {
            let outcome = self.run(since_epoch, stop).attitudes_into(values, rows)?;
            foreign::scalar_first(rows, scalar_first, stop);
            Ok(outcome)
        };
        let (rows, outcome) = times.evaluate(out, evaluate)?;
        error::warn_of_tolerance(rows.py(), outcome.missed_tolerance())?;
        Ok(rows)
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

    /// The moments about body axes 1, 2, 3: a read-only array, shape (m, 3).
    #[getter]
    fn moments<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant_rows(py, self.0.moments())
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

    /// The requested attitude error, in rad.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.0.asked_tolerance()
    }

    /// The orbits: an Orbit for all members, a list of one or None for each, or None.
    #[getter]
    fn orbits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let orbits: Vec<_> = self.0.asked_orbits().iter().map(|orbit| orbit.map(Orbit)).collect();
        match self.0.asked_orbits() {
            [] => Ok(py.None().into_bound(py)),
            [Some(orbit)] => Ok(Bound::new(py, Orbit(*orbit))?.into_any()),
            _ => Ok(orbits.into_pyobject(py)?.into_any()),
        }
    }

    /// The span, the times over which `tolerance` is requested, or None.
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
        if let Ok(slice) = index.cast::<PySlice>() {
            return Ok(Bound::new(py, self.part(slice)?)?.into_any());
        }
        let index: isize = index.extract()?;
        let members = self.0.len();
        let counted = if index < 0 { index.checked_add_unsigned(members) } else { Some(index) };
        match counted.and_then(|index| usize::try_from(index).ok()).filter(|&index| index < members) {
            Some(index) => {
                let motion = detached(py, error::propagation, || self.0.motion(index))?;
                error::warn_of_tolerance(py, motion.plan().missed_tolerance())?;
                Ok(Bound::new(py, Motion(motion, self.calendar(index)))?.into_any())
            }
            None => Err(PyIndexError::new_err(format!("member {index} of an ensemble of {members}"))),
        }
    }

    fn __repr__(&self) -> String {
        let bodies = if self.0.len() == 1 { "body" } else { "bodies" };
        let threads = self.0.asked_threads().map_or_else(String::new, |threads| format!(", threads={threads}"));
        let disturbed = (0..self.0.len()).filter(|&member| self.0.orbit(member).is_some()).count();
        let orbits = if disturbed > 0 { format!(", {disturbed} under an orbit") } else { String::new() };
        let span =
            self.0.asked_span().map_or_else(String::new, |(start, stop)| format!(", span=({start:?}, {stop:?})"));
        let tolerance = self.0.asked_tolerance();
        format!("<Ensemble of {} {bodies}{orbits}, tolerance={tolerance:?}{span}{threads}>", self.0.len())
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let arrays = (self.moments(py)?, self.attitudes(py)?, self.angular_velocities(py)?);
        let keywords = PyDict::new(py);
        match &self.1[..] {
            [] => keywords.set_item("epochs", self.epochs(py)?)?,
            [of_all] => keywords.set_item("epochs", foreign::calendar(py, &[*of_all])?.get_item(0)?)?,
            each => keywords.set_item("epochs", foreign::calendar(py, each)?)?,
        }
        keywords.set_item("errors", self.0.asked_on_error().to_string())?;
        keywords.set_item("orbits", self.orbits(py)?)?;
        keywords.set_item("tolerance", self.tolerance())?;
        keywords.set_item("span", self.span())?;
        keywords.set_item("threads", self.threads())?;
        (arrays, keywords).into_pyobject(py)
    }
}

impl Ensemble {
    /// The members of a slice.
    fn part(&self, slice: &Bound<'_, PySlice>) -> PyResult<Self> {
        let range = slice.indices(self.0.len() as isize)?;
        let chosen: Vec<usize> =
            (0..range.slicelength as isize).map(|k| (range.start + k * range.step) as usize).collect();
        let moments = chosen.iter().map(|&member| self.0.moments()[member]).collect();
        let attitudes = chosen.iter().map(|&member| self.0.attitudes()[member]).collect();
        let rates = chosen.iter().map(|&member| self.0.angular_velocities()[member]).collect();
        let (on_error, going) = (self.0.asked_on_error(), AtomicBool::new(false));
        let part = andoyer_propagate::Ensemble::new_or(moments, attitudes, rates, on_error, &going)
            .map_err(error::propagation)?
            .tolerance(self.0.asked_tolerance());
        let part = match self.0.asked_epochs() {
            [] => Ok(part),
            [of_all] => part.epochs(vec![*of_all]),
            each => part.epochs(chosen.iter().map(|&member| each[member]).collect()),
        }
        .map_err(error::propagation)?;
        let calendar = match &self.1[..] {
            [] | [_] => self.1.clone(),
            each => chosen.iter().map(|&member| each[member]).collect(),
        };
        let orbits = match self.0.asked_orbits() {
            [] => None,
            [of_all] => Some(vec![*of_all]),
            each => Some(chosen.iter().map(|&member| each[member]).collect()),
        };
        asked(part, orbits, self.0.asked_span(), self.0.asked_threads())
            .map(|part| Self(part, calendar))
            .map_err(error::propagation)
    }

    fn times<'py>(&self, value: &Bound<'py, PyAny>) -> PyResult<Times<'py>> {
        Times::of_members(value, self.0.len(), &self.1, !self.0.asked_orbits().is_empty())
    }

    /// How the members are evaluated at these times.
    fn run<'a>(&'a self, since_epoch: bool, stop: &'a AtomicBool) -> andoyer_propagate::ensemble::Run<'a> {
        let run = self.0.run().until(stop);
        if since_epoch { run.since_epoch() } else { run }
    }

    /// The plan of every member, or its error.
    fn solved(&self, py: Python<'_>) -> PyResult<Vec<Result<andoyer_propagate::Plan, andoyer_propagate::Error>>> {
        let long = self.0.len() >= if self.0.asked_orbits().is_empty() { LONG } else { 32 };
        interruptible(py, long, error::propagation, |stop| self.0.run().until(stop).plans())
    }

    /// The calendar epoch of a member.
    fn calendar(&self, index: usize) -> Option<Calendar> {
        self.1.get(if self.1.len() == 1 { 0 } else { index }).copied()
    }
}

/// The errors of refused members, as Python exceptions.
fn refused(py: Python<'_>, outcome: Outcome) -> Vec<(usize, Py<PyAny>)> {
    let value = |problem| error::propagation(problem).into_value(py).into_any();
    outcome.into_errors().into_iter().map(|(index, problem)| (index, value(problem))).collect()
}

/// Epochs as numbers, one or one for each member, and as calendar times if they are Time objects.
fn epochs_of(value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<Calendar>)> {
    let (seconds, calendar) = foreign::epochs("epochs", value)?;
    Ok((numbers_of("epochs", &seconds)?, calendar))
}

/// The ensemble with its options.
fn asked(
    ensemble: andoyer_propagate::Ensemble,
    orbits: Option<Vec<Option<andoyer_propagate::Orbit>>>,
    span: Option<(f64, f64)>,
    threads: Option<usize>,
) -> Result<andoyer_propagate::Ensemble, andoyer_propagate::Error> {
    let ensemble = match orbits {
        Some(orbits) => ensemble.orbits(orbits)?,
        None => ensemble,
    };
    let ensemble = span.into_iter().fold(ensemble, |ensemble, (start, stop)| ensemble.span(start, stop));
    Ok(threads.into_iter().fold(ensemble, andoyer_propagate::Ensemble::threads))
}

/// One orbit for all members, or an orbit or None for each.
fn orbits_of(value: &Bound<'_, PyAny>) -> PyResult<Vec<Option<andoyer_propagate::Orbit>>> {
    let kind = |name: &str, value: &Bound<'_, PyAny>, or: &str| -> PyErr {
        let found = value.get_type().name().map_or_else(|_| "something else".to_owned(), |name| name.to_string());
        PyTypeError::new_err(format!("{name} must be an Orbit or {or}, not {found}"))
    };
    if let Ok(orbit) = value.cast::<Orbit>() {
        return Ok(vec![Some(orbit.get().0)]);
    }
    let members = value.try_iter().map_err(|_| kind("orbits", value, "a sequence of one or None for each member"))?;
    let orbit = |(index, member): (usize, PyResult<Bound<'_, PyAny>>)| {
        let member = member?;
        match member.cast::<Orbit>() {
            Ok(orbit) => Ok(Some(orbit.get().0)),
            Err(_) if member.is_none() => Ok(None),
            Err(_) => Err(kind(&format!("orbits[{index}]"), &member, "None")),
        }
    };
    members.enumerate().map(orbit).collect()
}

fn tolerance(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    number("tolerance", value)
}
