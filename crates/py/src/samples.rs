//! `andoyer.Samples`.

use std::collections::BTreeMap;

use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

type Array = Py<PyArrayDyn<f64>>;
type Parts = (Array, Array, Array, bool, Option<Py<PyAny>>, Py<PyDict>);

/// Attitudes and angular velocities of a motion or an ensemble at given times, from `Motion.at` or `Ensemble.at`; those of any other origin come from `Samples.from_arrays`.
///
/// The samples own their arrays. For an ensemble the arrays have a leading axis of members, and `len` is the number of members. For a motion `len` is
/// the number of times. For a scalar time there is no axis of times, and the samples of a motion have no `len`.
///
/// Examples
/// --------
/// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
/// >>> samples = motion.at([0.0, 10.0, 20.0])
/// >>> len(samples), samples.attitude.shape, samples.angular_velocity.shape
/// (3, (3, 4), (3, 3))
/// >>> samples = Ensemble([[1, 1.5, 2], [1, 2, 2.5]], [0, 0, 0, 1], [0.1, 0.2, 1.0]).at([0.0, 10.0, 20.0])
/// >>> len(samples), samples.times.shape, samples.attitude.shape, samples.angular_velocity.shape
/// (2, (3,), (2, 3, 4), (2, 3, 3))
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Samples {
    times: Array,
    /// The times as given, if they are times of astropy.
    given: Option<Py<PyAny>>,
    /// The errors of members without samples, by index.
    refused: Vec<(usize, Py<PyAny>)>,
    /// Unit quaternions [x, y, z, w] that rotate body components into inertial ones, shape (n, 4) or (m, n, 4).
    /// They are [w, x, y, z] if the samples were made with `scalar_first`.
    #[pyo3(get)]
    attitude: Array,
    /// Angular velocities in body components, in rad per unit of time, shape (n, 3) or (m, n, 3).
    #[pyo3(get)]
    angular_velocity: Array,
    /// True if the quaternions are [w, x, y, z].
    #[pyo3(get)]
    scalar_first: bool,
}

impl Samples {
    /// The shape of the times as they were given.
    fn given_shape(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        match &self.given {
            Some(given) => given.bind(py).getattr("shape")?.extract(),
            None => Ok(self.times.bind(py).shape().to_vec()),
        }
    }

    pub(crate) fn new(times: Array, attitude: Array, angular_velocity: Array, scalar_first: bool) -> Self {
        Self { times, attitude, angular_velocity, scalar_first, given: None, refused: Vec::new() }
    }

    /// Samples at times of astropy.
    pub(crate) fn given(self, given: Option<Py<PyAny>>) -> Self {
        Self { given, ..self }
    }

    /// Adds the errors of members without samples.
    pub(crate) fn refused(self, refused: Vec<(usize, Py<PyAny>)>) -> Self {
        Self { refused, ..self }
    }
}

#[pymethods]
impl Samples {
    /// Samples from arrays of any origin: a star tracker, another propagator. They go where the samples of a motion go: tables, CK, AEM, pictures, `fit.attitudes`.
    ///
    /// Parameters
    /// ----------
    /// times : array_like, shape (n,), or astropy.time.Time
    ///     Increasing times in any unit; files of SPICE and of the CCSDS take seconds.
    /// attitudes : array_like, shape (n, 4), or scipy.spatial.transform.Rotation
    ///     Unit quaternions [x, y, z, w] that rotate body components into inertial ones.
    /// angular_velocity : array_like, shape (n, 3), optional
    ///     Body components, rad per unit of time. Without it, and where a row is NaN, it is unknown: NaN.
    /// epoch : astropy.time.Time, optional
    ///     The date of time 0, if the times are numbers of seconds: the samples have dates then.
    /// scalar_first : bool, optional
    ///     If True, plain quaternions are [w, x, y, z].
    ///
    /// Raises
    /// ------
    /// InputError
    ///     No time, times that do not increase; another number of rows; a number that is not finite; a norm that differs from 1 by more than 1e-6; an epoch beside dates.
    /// TypeError
    ///     A quantity with a wrong unit; quaternions of a class whose order is not known.
    ///
    /// Examples
    /// --------
    /// >>> samples = Samples.from_arrays([0.0, 1.0], [[0, 0, 0, 1], [0, 0, 0.6, 0.8]])
    /// >>> samples
    /// <Samples at 2 times>
    #[staticmethod]
    #[pyo3(signature = (times, attitudes, angular_velocity=None, *, epoch=None, scalar_first=false))]
    fn from_arrays<'py>(
        times: &Bound<'py, PyAny>,
        attitudes: &Bound<'py, PyAny>,
        angular_velocity: Option<&Bound<'py, PyAny>>,
        epoch: Option<&Bound<'py, PyAny>>,
        scalar_first: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let module = times.py().import("andoyer.interop._samples")?;
        module.call_method1("from_arrays", (times, attitudes, angular_velocity, epoch, scalar_first))
    }

    /// The times, float64, shape (n,), or (m, n) for an ensemble whose members have their own times. Times of astropy are returned as given.
    #[getter]
    fn times(&self, py: Python<'_>) -> Py<PyAny> {
        self.given.as_ref().map_or_else(|| self.times.clone_ref(py).into_any(), |given| given.clone_ref(py))
    }

    /// The errors of members whose samples are NaN, by index, for an ensemble with ``errors="nan"``; otherwise empty.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let errors = PyDict::new(py);
        for (index, error) in &self.refused {
            errors.set_item(index, error)?;
        }
        Ok(errors)
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        match self.attitude.bind(py).shape() {
            [first, _, ..] => Ok(*first),
            _ => Err(PyTypeError::new_err("samples of one motion at a scalar time have no len()")),
        }
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (times, rows) = (self.given_shape(py)?, self.attitude.bind(py).shape());
        let at = match &times[..] {
            [] => "a scalar time".to_owned(),
            [n] => counted(*n, "time"),
            [_, n, ..] => format!("{} each", counted(*n, "time")),
        };
        Ok(match rows {
            [members, ..] if rows.len() > times.len() + 1 || times.len() > 1 => {
                format!("<Samples of {} at {at}>", counted(*members, "member"))
            }
            _ => format!("<Samples at {at}>"),
        })
    }

    /// Rebuilds samples for `pickle`.
    #[classmethod]
    #[pyo3(signature = (times, attitude, angular_velocity, scalar_first=false, given=None, errors=None))]
    fn _restored(
        _class: &Bound<'_, PyType>,
        times: Array,
        attitude: Array,
        angular_velocity: Array,
        scalar_first: bool,
        given: Option<Py<PyAny>>,
        errors: Option<BTreeMap<usize, Py<PyAny>>>,
    ) -> Self {
        let refused = errors.into_iter().flatten().collect();
        Self::new(times, attitude, angular_velocity, scalar_first).given(given).refused(refused)
    }

    /// Converts the samples to a pandas table with the columns qx, qy, qz, qw, wx, wy, wz, indexed by time or by member and time. This method imports pandas.
    ///
    /// Returns
    /// -------
    /// pandas.DataFrame
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     pandas is not installed; ``pip install pandas`` installs it.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("andoyer.interop._frames")?.call_method1("pandas", (slf,))
    }

    /// Converts the samples to an xarray data set: attitude and angular_velocity by (member,) time, and quaternion or axis. This method imports xarray.
    ///
    /// If the members have their own times, these are the coordinate ``t``.
    ///
    /// Returns
    /// -------
    /// xarray.Dataset
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     xarray is not installed; ``pip install xarray`` installs it.
    fn to_xarray<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("andoyer.interop._frames")?.call_method1("xarray", (slf,))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Parts)> {
        let (py, samples) = (slf.py(), slf.get());
        let [times, attitude, rates] =
            [&samples.times, &samples.attitude, &samples.angular_velocity].map(|array| array.clone_ref(py));
        let given = samples.given.as_ref().map(|given| given.clone_ref(py));
        let errors = samples.errors(py)?.unbind();
        Ok((slf.get_type().getattr("_restored")?, (times, attitude, rates, samples.scalar_first, given, errors)))
    }
}

pub(crate) fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}
