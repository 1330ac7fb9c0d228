//! `andoyer.Ensemble`.

use andoyer_propagate::MAX_THREADS;
use numpy::PyArrayDyn;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice, PyTuple};

use crate::array::{MemberRows, Times, chunks, constant_rows, number, write};
use crate::error::{self, ShapeError, ThreadsError};
use crate::foreign;
use crate::motion::Motion;
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
/// tolerance : float, optional
///     Attitude error asked for within 1e9 rotations, in rad.
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
/// ThreadsError
///     ``0``, ``-1``, ``2.5``; or, when it evaluates, a number that the system does not give.
/// ShapeError
///     Two moments, five attitudes; or one row of each.
///
/// Examples
/// --------
/// >>> moments = [[1.0, 1.5, 2.0], [1.0, 2.0, 2.5]]
/// >>> ensemble = Ensemble(moments, [0, 0, 0, 1], [[0.1, 0.2, 1.0], [1.0, 0.2, 0.1]])
/// >>> ensemble.at([0.0, 10.0, 20.0]).attitude.shape
/// (2, 3, 4)
/// >>> [plan.mode for plan in ensemble.plans]
/// ['short-axis', 'long-axis']
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
    #[pyo3(signature = (moments, attitudes, angular_velocities, *, tolerance=1e-12, threads=None, scalar_first=false))]
    fn new(
        py: Python<'_>,
        moments: &Bound<'_, PyAny>,
        attitudes: &Bound<'_, PyAny>,
        angular_velocities: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = tolerance)] tolerance: f64,
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
        let Some(members) = moments.members().or(attitudes.members()).or(rates.members()) else {
            let text =
                "moments, attitudes and angular_velocities are one row each: one of them must have an axis of members";
            return Err(ShapeError::new_err(text));
        };
        let new = || {
            let [moments, rates] = [moments, rates].map(|rows| rows.repeated(members));
            let ensemble = andoyer_propagate::Ensemble::new(moments, attitudes.repeated(members), rates)?;
            let ensemble = ensemble.tolerance(tolerance);
            let ensemble = match threads {
                Some(threads) => ensemble.threads(threads),
                None => ensemble,
            };
            ensemble.validate().map(|()| ensemble)
        };
        py.detach(new).map(Self).map_err(error::propagation)
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
            py.detach(evaluate).map_err(error::propagation)?;
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
        let plans = py.detach(|| self.0.plans()).map_err(error::propagation)?;
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

    /// The number of threads asked for, or None.
    #[getter]
    fn threads(&self) -> Option<usize> {
        self.0.asked_threads()
    }

    fn __len__(&self) -> usize {
        self.0.len()
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
                let motion = py.detach(|| self.0.motion(index)).map_err(error::propagation)?;
                Ok(Bound::new(py, Motion(motion))?.into_any())
            }
            None => Err(PyIndexError::new_err(format!("member {index} of an ensemble of {members}"))),
        }
    }

    fn __repr__(&self) -> String {
        let bodies = if self.0.len() == 1 { "body" } else { "bodies" };
        let threads = self.0.asked_threads().map_or_else(String::new, |threads| format!(", threads={threads}"));
        format!("<Ensemble of {} {bodies}, tolerance={:?}{threads}>", self.0.len(), self.0.asked_tolerance())
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
        keywords.set_item("tolerance", self.tolerance())?;
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
        Ok(Self(match self.0.asked_threads() {
            Some(threads) => part.threads(threads),
            None => part,
        }))
    }
}

fn tolerance(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    number("tolerance", value)
}
