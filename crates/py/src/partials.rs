//! `andoyer.Partials`.

use andoyer_propagate::partials::Parameter;
use andoyer_propagate::{Error, Motion};
use num_bigint::BigInt;
use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

use crate::error;
use crate::samples::counted;

type Array = Py<PyArrayDyn<f64>>;
/// The fields in their order.
type Pickled = (Array, Array, Array, Vec<String>);

/// Derivatives of attitude and angular velocity at given times, from `Motion.partials` and `Ensemble.partials`.
///
/// The last axis has a column for each of `parameters`, by default nine: initial attitude (3), initial angular velocity (3), moments as given (3). For bodies from
/// inertia tensors it has twelve: the elements I11, I22, I33, I12, I13, I23 replace the moments. The object owns its arrays. Those of an ensemble have a leading axis of members, and `len` is the number of members; `len` of a motion's partials is the number of times. For a scalar time there is
/// no axis of times, and a motion's partials have no `len`.
///
/// Examples
/// --------
/// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
/// >>> partials = motion.partials([0.0, 10.0])
/// >>> len(partials), partials.attitude.shape, partials.angular_velocity.shape
/// (2, (2, 3, 9), (2, 3, 9))
/// >>> partials.parameters[3:7]
/// ('angular_velocity_1', 'angular_velocity_2', 'angular_velocity_3', 'moment_1')
/// >>> partials.angular_velocity[0, :, 3:6].round(12) + 0.0
/// array([[1., 0., 0.],
///        [0., 1., 0.],
///        [0., 0., 1.]])
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Partials {
    /// The times, float64, shape (n,); of an ensemble whose members have their own times (m, n).
    #[pyo3(get)]
    times: Array,
    /// Derivatives of the attitude as a rotation vector about body axes, shape (n, 3, k) for k parameters, of an ensemble (m, n, 3, k).
    #[pyo3(get)]
    attitude: Array,
    /// Derivatives of the angular velocity in body components, shape (n, 3, k) for k parameters, of an ensemble (m, n, 3, k).
    #[pyo3(get)]
    angular_velocity: Array,
    names: Vec<String>,
}

/// A parameter as given: its name, or a pair of name and index.
#[derive(FromPyObject)]
enum Given {
    Name(String),
    OfBody(String, BigInt),
}

/// One parameter or several.
#[derive(FromPyObject)]
enum OneOrMany {
    One(Given),
    Many(Vec<Given>),
}

/// The parameters of a motion as given, by default those of state and body.
pub(crate) fn parameters(motion: &Motion, given: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Parameter>> {
    let Some(given) = given else { return Ok(Parameter::STATE_AND_BODY.to_vec()) };
    let Ok(given) = given.extract::<OneOrMany>() else {
        let message = "with_respect_to must be names, such as \"orbit\", and pairs of name and index, such as (\"torque\", 1), not ";
        return Err(PyTypeError::new_err(format!("{message}{}", given.repr()?)));
    };
    let given = match given {
        OneOrMany::One(one) => vec![one],
        OneOrMany::Many(many) => many,
    };
    let found = given.iter().map(|given| match given {
        Given::Name(name) => motion.parameter(name, None),
        Given::OfBody(name, index) => match usize::try_from(index) {
            Ok(index) => motion.parameter(name, Some(index)),
            Err(_) => Err(Error::Parameter {
                value: format!("(\"{name}\", {index})"),
                bound: "a pair of a name and the index of a disturbing body or of a torque, from 0".to_owned(),
            }),
        },
    });
    found.collect::<Result<_, _>>().map_err(error::propagation)
}

impl Partials {
    /// From times, attitudes and rates, and the names of the columns.
    pub(crate) fn new([times, attitude, angular_velocity]: [Array; 3], names: Vec<String>) -> Self {
        Self { times, attitude, angular_velocity, names }
    }
}

#[pymethods]
impl Partials {
    /// The names of the columns, in their order.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.names)
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        match self.attitude.bind(py).shape() {
            [first, _, _, ..] => Ok(*first),
            _ => Err(PyTypeError::new_err("partials of one motion at a scalar time have no len()")),
        }
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (times, rows) = (self.times.bind(py).shape().to_vec(), self.attitude.bind(py).shape());
        let at = match &times[..] {
            [] => "a scalar time".to_owned(),
            [n] => counted(*n, "time"),
            [_, n, ..] => format!("{} each", counted(*n, "time")),
        };
        match rows {
            [members, ..] if rows.len() > times.len() + 2 || times.len() > 1 => {
                format!("<Partials of {} at {at}>", counted(*members, "member"))
            }
            _ => format!("<Partials at {at}>"),
        }
    }

    /// Rebuilds derivatives for `pickle`.
    #[classmethod]
    fn _restored(
        _class: &Bound<'_, PyType>,
        times: Array,
        attitude: Array,
        angular_velocity: Array,
        names: Vec<String>,
    ) -> Self {
        Self::new([times, attitude, angular_velocity], names)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Pickled)> {
        let (py, partials) = (slf.py(), slf.get());
        let [times, attitude, rates] =
            [&partials.times, &partials.attitude, &partials.angular_velocity].map(|array| array.clone_ref(py));
        Ok((slf.get_type().getattr("_restored")?, (times, attitude, rates, partials.names.clone())))
    }
}
