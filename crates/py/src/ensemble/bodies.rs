//! The bodies of the members: principal moments, or inertia tensors.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Error as Propagation;
use andoyer_propagate::ensemble::OnError;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;

use super::{Array, Ensemble};
use crate::array::{MemberRows, constant_rows, tensors};
use crate::error;

/// The shapes of the argument.
const SHAPES: &str = "(m, 3) or (3,) for principal moments, or (m, 3, 3) for tensors as of Body.from_inertia";

/// The argument `moments`.
pub(super) enum Bodies {
    Moments(MemberRows<3>),
    Tensors(Vec<[[f64; 3]; 3]>),
}

impl Bodies {
    pub(super) fn new(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        match tensors("moments", value)? {
            Some(tensors) => Ok(Self::Tensors(tensors)),
            None => MemberRows::of_shape("moments", value, SHAPES).map(Self::Moments),
        }
    }

    /// The number of members: of the arguments that have one row each, one must have more.
    pub(super) fn members(&self, attitudes: &MemberRows<4>, rates: &MemberRows<3>) -> PyResult<usize> {
        let others = attitudes.members().or(rates.members());
        match (self.rows(), others) {
            (Some(3), Some(members)) if members != 3 && matches!(self, Self::Moments(_)) => {
                let text = format!(
                    "moments has shape (3, 3), the principal moments of 3 members, but there are {members} members: inertia tensors, as of Body.from_inertia, have the shape (m, 3, 3)"
                );
                Err(error::input("moments", &[3_i64, 3][..], SHAPES, text))
            }
            (own, others) => own.or(others).ok_or_else(|| {
                let text = "moments, attitudes and angular_velocities are one row each: one of them must have an axis of members";
                error::input("moments", "one row", "(m, 3)", text.to_owned())
            }),
        }
    }

    fn rows(&self) -> Option<usize> {
        match self {
            Self::Moments(rows) => rows.members(),
            Self::Tensors(tensors) => Some(tensors.len()),
        }
    }

    /// The ensemble of as many members with these attitudes and rates.
    pub(super) fn ensemble(
        self,
        members: usize,
        (attitudes, rates): (Vec<[f64; 4]>, Vec<[f64; 3]>),
        on_error: OnError,
        stop: &AtomicBool,
    ) -> Result<andoyer_propagate::Ensemble, Propagation> {
        match self {
            Self::Moments(rows) => {
                andoyer_propagate::Ensemble::new_or(rows.repeated(members), attitudes, rates, on_error, stop)
            }
            Self::Tensors(tensors) => {
                andoyer_propagate::Ensemble::from_inertia_or(tensors, attitudes, rates, on_error, stop)
            }
        }
    }
}

#[pymethods]
impl Ensemble {
    /// The moments about body axes 1, 2, 3: a read-only array, shape (m, 3). If tensors were given, they are the principal moments, as `Body.moments`.
    #[getter]
    pub(super) fn moments<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
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
    pub(super) fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let tensors: Vec<f64> = (0..self.0.len()).flat_map(|k| self.0.inertia(k)).flatten().collect();
        let array = tensors.into_pyarray(py).reshape(vec![self.0.len(), 3, 3])?;
        array.readwrite().make_nonwriteable();
        Ok(array)
    }
}
