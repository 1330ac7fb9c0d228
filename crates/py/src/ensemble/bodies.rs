//! The bodies of the members: principal moments, or inertia tensors.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Error as Propagation;
use andoyer_propagate::ensemble::OnError;
use pyo3::prelude::*;

use crate::array::{MemberRows, tensors};
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
