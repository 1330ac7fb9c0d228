//! `andoyer.Ensemble`.

use andoyer_propagate::MAX_THREADS;
use numpy::PyArrayDyn;
use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice, PyTuple};

use crate::array::{MemberRows, Times, chunks, constant_rows, fixed, number, write};
use crate::computing::detached;
use crate::error::{self, ShapeError, ThreadsError};
use crate::foreign;
use crate::members::Members;
use crate::motion::Motion;
use crate::orbit::Orbit;
use crate::order::whole_number;
use crate::plan::Plan;
use crate::samples::Samples;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Many bodies with their states at time 0, solved and evaluated member by member on all cores, in memory proportional to the result.
///
/// Each member gives the bits that `Scene` and `Motion` give for it alone, whatever the number of threads. ``ensemble[i]`` is the motion
/// of member i, ``ensemble[i:j]`` the ensemble of some members.
///
/// Parameters
/// ----------
/// moments : array_like, shape (m, 3) or (3,)
///     Moments about body axes 1, 2, 3, as `Body` takes them. Of this and the next two, one row stands for m equal ones; one at least
///     has m rows.
/// attitudes : array_like, shape (m, 4) or (4,), or scipy.spatial.transform.Rotation
///     Unit quaternions [x, y, z, w] at time 0, as `Scene` takes them.
/// angular_velocities : array_like, shape (m, 3) or (3,)
///     Body components at time 0, in rad per unit of time.
/// orbits : Orbit or sequence of m Orbit or None, optional
///     The orbit of a body whose gravity gradient acts on all members, or one or None for each. A member under an orbit takes some 200 µs to
///     solve, others 5.
/// tolerance : float, optional
///     Attitude error asked for within `span`, in rad.
/// span : (float, float), optional
///     The times over which `tolerance` is asked for and error bounds hold; by default 1e9 rotations, over which little is known of a motion under an
///     orbit.
/// threads : int, optional
///     How many threads work, 1 to 1024; by default one for each core.
/// scalar_first : bool, optional
///     Whether `attitudes` are [w, x, y, z]. The property `attitudes` has the scalar last all the same.
///
/// Raises
/// ------
/// MomentsError, AttitudeError, AngularVelocityError
///     A member that is no body or no state: the error of a single one, with its place among the members in the message and as the
///     attribute ``index`` of the exception; the message also says how many other members are bad.
/// ToleranceError
///     ``0``, ``-1``, not finite.
/// SpanError
///     ``(1, 0)``, not finite.
/// ThreadsError
///     ``0``, ``-1``, ``2.5``; or, when it evaluates, a number that the system does not give.
/// ShapeError
///     Two moments, five attitudes, three orbits; or one row of each.
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
/// >>> under_the_sun = Ensemble([1, 1.02, 1.05], [0, 0, 0, 1], [[0, 0, 1], [0, 0.1, 1]], orbits=[sun, None], span=(0, 1e5))
/// >>> [plan.torque > 0 for plan in under_the_sun.plans]
/// [True, False]
/// >>> Ensemble([[1.0, 1.5, 2.0], [1.0, 1.0, 2.5]], [0, 0, 0, 1], [0, 0, 1])
/// Traceback (most recent call last):
///     ...
/// andoyer.MomentsError: member 1: moments = [1.0, 1.0, 2.5]: the largest must not exceed the sum of the other two (it is 1.25 times that sum)
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Ensemble(andoyer_propagate::Ensemble);

#[pymethods]
impl Ensemble {
    #[new]
    #[pyo3(signature = (moments, attitudes, angular_velocities, *, orbits=None, tolerance=1e-12, span=None, threads=None, scalar_first=false))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn new(
        py: Python<'_>,
        moments: &Bound<'_, PyAny>,
        attitudes: &Bound<'_, PyAny>,
        angular_velocities: &Bound<'_, PyAny>,
        orbits: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = tolerance)] tolerance: f64,
        span: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
        scalar_first: bool,
    ) -> PyResult<Self> {
        let moments = MemberRows::new("moments", moments)?;
        let scalar_first = scalar_first && !foreign::is_rotation(attitudes)?;
        let mut attitudes = MemberRows::new("attitudes", attitudes)?;
        attitudes.each(|quaternion| foreign::scalar_last(quaternion, scalar_first));
        let rates = MemberRows::new("angular_velocities", angular_velocities)?;
        let threads =
            threads.map(|value| whole_number::<ThreadsError>("threads", value, 1, MAX_THREADS)).transpose()?;
        let orbits = orbits.map(orbits_of).transpose()?;
        let span = span.map(|value| fixed("span", value)).transpose()?.map(|[start, stop]: [f64; 2]| (start, stop));
        let Some(members) = moments.members().or(attitudes.members()).or(rates.members()) else {
            let text =
                "moments, attitudes and angular_velocities are one row each: one of them must have an axis of members";
            return Err(ShapeError::new_err(text));
        };
        let new = || {
            let [moments, rates] = [moments, rates].map(|rows| rows.repeated(members));
            let ensemble = andoyer_propagate::Ensemble::new(moments, attitudes.repeated(members), rates)?;
            let ensemble = asked(ensemble.tolerance(tolerance), orbits, span, threads)?;
            ensemble.validate().map(|()| ensemble)
        };
        detached(py, error::propagation, new).map(Self)
    }

    /// Attitudes and angular velocities of all members, in one pass.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///     The times of all members, or a row for each.
    /// scalar_first : bool, optional
    ///     Attitudes as [w, x, y, z].
    ///
    /// Returns
    /// -------
    /// Samples
    ///     With a leading axis of members: attitudes (m, n, 4), angular velocities (m, n, 3); for a scalar time (m, 4) and (m, 3).
    ///
    /// Raises
    /// ------
    /// TimesError
    ///     As of a motion, with the attribute ``index`` of the first member that has it.
    /// UnitsError
    ///     As of a scene, with the same attribute.
    /// ShapeError
    ///     Rows for another number of members.
    #[pyo3(signature = (times, *, scalar_first=false))]
    fn at(&self, py: Python<'_>, times: &Bound<'_, PyAny>, scalar_first: bool) -> PyResult<Samples> {
        let times = Times::of_members(times, self.0.len())?;
        let [copy, attitude, rates] = times.samples()?;
        {
            let (mut attitude, mut rates) = (write(&attitude)?, write(&rates)?);
            let (values, attitude, rates) = (times.values()?, chunks(&mut attitude)?, chunks(&mut rates)?);
            let evaluate = || {
                self.0.samples_into(values, attitude, rates)?;
                foreign::scalar_first(attitude, scalar_first);
                Ok(())
            };
            detached(py, error::propagation, evaluate)?;
        }
        Ok(Samples::new(copy.unbind(), attitude.unbind(), rates.unbind(), scalar_first))
    }

    /// Attitudes of all members: unit quaternions [x, y, z, w] that rotate body components into inertial ones.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    /// out : ndarray, float64, C-contiguous, shape (m, n, 4), optional
    ///     Where the result is written. After an error it holds what had been computed.
    /// scalar_first : bool, optional
    ///     [w, x, y, z] instead.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (m, n, 4)
    ///     `out`, if given.
    #[pyo3(signature = (times, out=None, *, scalar_first=false))]
    fn attitude<'py>(
        &self,
        times: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        scalar_first: bool,
    ) -> PyResult<Array<'py>> {
        Times::of_members(times, self.0.len())?.evaluate(out, |times, rows| {
            self.0.attitudes_into(times, rows)?;
            foreign::scalar_first(rows, scalar_first);
            Ok(())
        })
    }

    /// The plan of every member: a list of `Plan`.
    #[getter]
    fn plans(&self, py: Python<'_>) -> PyResult<Vec<Plan>> {
        let plans = detached(py, error::propagation, || self.0.plans())?;
        Ok(plans.into_iter().map(Plan).collect())
    }

    /// The moments about body axes 1, 2, 3: a read-only array, shape (m, 3).
    #[getter]
    fn moments<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant_rows(py, self.0.moments())
    }

    /// The attitudes at time 0 as given: unit quaternions [x, y, z, w], a read-only array, shape (m, 4).
    #[getter]
    fn attitudes<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant_rows(py, self.0.attitudes())
    }

    /// The angular velocities at time 0, in body components, in rad per unit of time: a read-only array, shape (m, 3).
    #[getter]
    fn angular_velocities<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        constant_rows(py, self.0.angular_velocities())
    }

    /// The attitude error asked for, in rad.
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

    /// The times over which `tolerance` is asked for, or None.
    #[getter]
    fn span(&self) -> Option<(f64, f64)> {
        self.0.asked_span()
    }

    /// The number of threads asked for, or None.
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
                Ok(Bound::new(py, Motion(motion))?.into_any())
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
        let part = andoyer_propagate::Ensemble::new(moments, attitudes, rates)
            .map_err(error::propagation)?
            .tolerance(self.0.asked_tolerance());
        let orbits = match self.0.asked_orbits() {
            [] => None,
            [of_all] => Some(vec![*of_all]),
            each => Some(chosen.iter().map(|&member| each[member]).collect()),
        };
        asked(part, orbits, self.0.asked_span(), self.0.asked_threads()).map(Self).map_err(error::propagation)
    }
}

/// The ensemble with what was asked for besides.
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

/// One orbit for all, or one or None for each.
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
