//! `andoyer.Samples`.

use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyType;

type Array = Py<PyArrayDyn<f64>>;

/// Attitudes and angular velocities of a motion at some times: what `Motion.at` returns.
///
/// The arrays belong to the samples alone. For a scalar time they lack the leading axis, and there is no `len`.
///
/// Examples
/// --------
/// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
/// >>> samples = motion.at([0.0, 10.0, 20.0])
/// >>> len(samples), samples.attitude.shape, samples.angular_velocity.shape
/// (3, (3, 4), (3, 3))
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Samples {
    /// The times, float64, shape (n,).
    #[pyo3(get)]
    times: Array,
    /// Unit quaternions [x, y, z, w] that rotate body components into inertial ones, shape (n, 4).
    #[pyo3(get)]
    attitude: Array,
    /// Angular velocities in body components, in rad per unit of time, shape (n, 3).
    #[pyo3(get)]
    angular_velocity: Array,
}

impl Samples {
    pub(crate) fn new(times: Array, attitude: Array, angular_velocity: Array) -> Self {
        Self { times, attitude, angular_velocity }
    }
}

#[pymethods]
impl Samples {
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        match self.times.bind(py).shape() {
            [n] => Ok(*n),
            _ => Err(PyTypeError::new_err("samples at a scalar time have no len()")),
        }
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        match self.times.bind(py).shape() {
            [1] => "<Samples at 1 time>".to_owned(),
            [n] => format!("<Samples at {n} times>"),
            _ => "<Samples at a scalar time>".to_owned(),
        }
    }

    /// Puts together what `pickle` took apart.
    #[classmethod]
    fn _restored(_class: &Bound<'_, PyType>, times: Array, attitude: Array, angular_velocity: Array) -> Self {
        Self::new(times, attitude, angular_velocity)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Array, Array, Array))> {
        let (py, samples) = (slf.py(), slf.get());
        let [times, attitude, rates] =
            [&samples.times, &samples.attitude, &samples.angular_velocity].map(|array| array.clone_ref(py));
        Ok((slf.get_type().getattr("_restored")?, (times, attitude, rates)))
    }
}
