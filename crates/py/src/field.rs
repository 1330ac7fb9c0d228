//! `andoyer.Field`.

use std::sync::Arc;

use andoyer_propagate::torques::{DipoleField, SourcePath};
use andoyer_propagate::{Error, TabulatedOrbit as Table};
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::array::{constant, constant_rows, fixed, number, numbers_of, shaped, vectors};
use crate::error;
use crate::foreign;
use crate::orbit::Orbit;
use crate::scene::arguments::kind;
use crate::values::immutable;

/// A magnetic field along an orbit, for `Torque.dipole` and `Torque.eddy`. It is made by one of the class methods below.
///
/// Among the sources of `Torque.polynomial` a field has the direction of the field, and its size in the place of a distance: ``distance_powers={"b": -1}, reference_distances={"b": 1.0}`` multiplies by the size of the field.
///
/// Examples
/// --------
/// >>> orbit = Orbit(1.1e-3, semi_major_axis=6871.0, inclination=1.7)
/// >>> earth = Field.dipole(radius=6371.2, equatorial=2.98e-5, axis=(0.05, 0.16, -0.98), orbit=orbit, rotation_rate=7.292115e-5)
/// >>> earth.at([0.0, 1000.0]).shape
/// (2, 3)
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Field(pub(crate) FieldPath);

/// The dipole or the table of a field.
#[derive(Clone, PartialEq)]
pub(crate) enum FieldPath {
    Dipole(Arc<DipoleField>),
    Table(Arc<Table>),
}

impl FieldPath {
    pub(crate) fn source(&self) -> SourcePath {
        match self {
            Self::Dipole(field) => SourcePath::Field(field.clone()),
            Self::Table(table) => SourcePath::Tabulated(table.clone()),
        }
    }
}

immutable!(Field);

#[pymethods]
impl Field {
    /// The field of a dipole in the centre of a planet, B_e (R/r)³ (3 (m·r) r − m) with the unit vectors m of its moment and r of the position.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     R, in the unit of `semi_major_axis`.
    /// equatorial : float
    ///     B_e, the field on the equator of the dipole at the distance R, in the unit of the field: 2.98e-5 T for the Earth.
    /// axis : array_like, shape (3,), optional
    ///     Direction of the moment at time 0, inertial. That of the Earth points south: (0, 0, -1) without its tilt. By default (0, 0, 1).
    /// orbit : Orbit
    ///     With `semi_major_axis`. The elements of the body about the planet, or those of the planet about the body: the field is the same.
    /// rotation_rate : float, optional
    ///     Rate at which the moment turns with the planet about inertial axis 3, in rad/time.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A radius or a field that is not positive and finite, an axis that is 0, an orbit without `semi_major_axis`.
    #[classmethod]
    #[pyo3(
        signature = (*, radius, equatorial, orbit, axis=None, rotation_rate=None),
        text_signature = "(*, radius, equatorial, orbit, axis=(0, 0, 1), rotation_rate=0.0)"
    )]
    fn dipole(
        _class: &Bound<'_, PyType>,
        radius: &Bound<'_, PyAny>,
        equatorial: &Bound<'_, PyAny>,
        orbit: &Bound<'_, PyAny>,
        axis: Option<&Bound<'_, PyAny>>,
        rotation_rate: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let Ok(given) = orbit.cast::<Orbit>() else {
            return Err(PyTypeError::new_err(format!("orbit must be an Orbit, not {}", kind(orbit))));
        };
        let made = DipoleField::new(given.get().0, number("radius", radius)?, number("equatorial", equatorial)?);
        let mut field = made.map_err(error::propagation)?;
        if let Some(axis) = axis {
            field = field.axis(fixed("axis", axis)?).map_err(error::propagation)?;
        }
        if let Some(rate) = rotation_rate {
            field = field.rotating(number("rotation_rate", rate)?).map_err(error::propagation)?;
        }
        Ok(Self(FieldPath::Dipole(Arc::new(field))))
    }

    /// A table of the field at the body, of any model.
    ///
    /// Parameters
    /// ----------
    /// times : array_like, shape (n,), or astropy.time.Time
    ///     At least eight increasing times, as of `TabulatedOrbit`.
    /// vectors : array_like, shape (n, 3)
    ///     The field in inertial components, nowhere 0. Between two times it is a polynomial of degree seven.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     Fewer than eight times, times that do not increase, another number of vectors, a vector that is 0 or not finite.
    #[classmethod]
    fn table(_class: &Bound<'_, PyType>, times: &Bound<'_, PyAny>, vectors: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (seconds, _) = foreign::epochs("times", times)?;
        let table = Table::new(numbers_of("times", &seconds)?, self::vectors("vectors", vectors)?, 1.0);
        // What a table of places calls positions.
        let table = table.map_err(|problem| match problem {
            Error::Length { found, expected, .. } => Error::Length { argument: "vectors", found, expected },
            Error::Table { argument: "positions", index, value, .. } => {
                Error::Table { argument: "vectors", index, value, bound: "finite and not 0" }
            }
            other => other,
        });
        Ok(Self(FieldPath::Table(Arc::new(table.map_err(error::propagation)?))))
    }

    /// The field at times, in inertial components.
    ///
    /// Parameters
    /// ----------
    /// times : array_like, shape () or (n,)
    ///
    /// Returns
    /// -------
    /// ndarray, shape (3,) or (n, 3)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A time outside a table.
    fn at<'py>(&self, py: Python<'py>, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (values, mut shape) = shaped("times", times)?;
        let one = |time: &f64| match &self.0 {
            FieldPath::Dipole(field) => field.at(0.0, *time),
            FieldPath::Table(table) => table.position(*time),
        };
        let found = values.iter().map(one).collect::<Result<Vec<_>, _>>().map_err(error::propagation)?;
        shape.push(3);
        found.as_flattened().to_vec().into_pyarray(py).reshape(shape)
    }

    fn __repr__(&self) -> String {
        match &self.0 {
            FieldPath::Dipole(field) => format!(
                "<Field of a dipole: radius={:?}, equatorial={:?}, axis={:?}, rotation_rate={:?}>",
                field.radius(),
                field.equatorial(),
                field.moment_axis(),
                field.rotation_rate()
            ),
            FieldPath::Table(table) => {
                let times = table.times();
                format!("<Field: {} times from {:?} to {:?}>", times.len(), times[0], times[times.len() - 1])
            }
        }
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        self.__repr__().into_pyobject(py)?.hash()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let py = slf.py();
        match &slf.get().0 {
            FieldPath::Table(table) => {
                let arguments = (constant(py, table.times()), constant_rows(py, table.positions())?);
                Ok((slf.get_type().getattr("table")?, arguments.into_pyobject(py)?))
            }
            FieldPath::Dipole(field) => {
                let named = PyDict::new(py);
                named.set_item("radius", field.radius())?;
                named.set_item("equatorial", field.equatorial())?;
                named.set_item("axis", field.moment_axis().to_vec())?;
                named.set_item("orbit", Bound::new(py, Orbit(*field.orbit()))?)?;
                named.set_item("rotation_rate", field.rotation_rate())?;
                let partial = py.import("functools")?.getattr("partial")?;
                let made = partial.call((slf.get_type().getattr("dipole")?,), Some(&named))?;
                Ok((made, PyTuple::empty(py)))
            }
        }
    }
}
