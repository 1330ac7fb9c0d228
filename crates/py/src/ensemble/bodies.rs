//! The bodies of the members: principal moments, inertia tensors, or `Body` objects.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Error as Propagation;
use andoyer_propagate::ensemble::OnError;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::array::{MemberRows, tensors};
use crate::body::Body;
use crate::error;
use crate::scene::arguments::kind;

/// The shapes of the argument.
const SHAPES: &str = "(m, 3) or (3,) for principal moments, or (m, 3, 3) for tensors as of Body.from_inertia";

/// The argument `moments`.
pub(super) enum Bodies {
    Moments(MemberRows<3>),
    Tensors(MemberRows<3, [f64; 3]>),
}

impl Bodies {
    /// The arguments `moments` and `bodies`, of which one is given.
    pub(super) fn given(moments: Option<&Bound<'_, PyAny>>, bodies: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        match (moments.filter(|moments| !moments.is_none()), bodies) {
            (Some(moments), None) => Self::new(moments),
            (None, Some(bodies)) => Self::of_classes(bodies),
            (None, None) => Err(PyTypeError::new_err("moments or bodies must be given")),
            (Some(_), Some(_)) => Err(PyTypeError::new_err("moments must be None where bodies are given")),
        }
    }

    /// Bodies, or principal moments.
    pub(super) fn any(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let is_body = |value: &Bound<'_, PyAny>| value.is_instance_of::<Body>();
        let first = value.get_item(0);
        if is_body(value) || first.is_ok_and(|first| is_body(&first)) {
            Self::of_classes(value)
        } else {
            Self::new(value)
        }
    }

    /// Each body, or the one of all.
    pub(super) fn each(self) -> Vec<Result<andoyer_propagate::Body, Propagation>> {
        match self {
            Self::Moments(rows) => rows.rows().into_iter().map(andoyer_propagate::Body::new).collect(),
            Self::Tensors(rows) => rows.rows().into_iter().map(andoyer_propagate::Body::from_inertia).collect(),
        }
    }

    /// A `Body` for all members, or one for each.
    fn of_classes(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let one = |value: &Bound<'_, PyAny>| value.cast::<Body>().ok().map(|body| body.get().body.clone());
        let refused = |name: &str, value: &Bound<'_, PyAny>| {
            PyTypeError::new_err(format!("{name} must be an andoyer.Body, not {}", kind(value)))
        };
        if let Some(body) = one(value) {
            without_gravity("bodies", &body)?;
            return Ok(match body.has_tensor() {
                true => Self::Tensors(MemberRows::One(body.inertia())),
                false => Self::Moments(MemberRows::One(body.moments())),
            });
        }
        let member = |(index, member): (usize, PyResult<Bound<'_, PyAny>>)| {
            let member = member?;
            let name = format!("bodies[{index}]");
            let body = one(&member).ok_or_else(|| refused(&name, &member))?;
            without_gravity(&name, &body)?;
            Ok(body)
        };
        let members = value.try_iter().map_err(|_| refused("bodies", value))?;
        let bodies: Vec<_> = members.enumerate().map(member).collect::<PyResult<_>>()?;
        Ok(match bodies.iter().any(andoyer_propagate::Body::has_tensor) {
            true => Self::Tensors(MemberRows::Many(bodies.iter().map(andoyer_propagate::Body::inertia).collect())),
            false => Self::Moments(MemberRows::Many(bodies.iter().map(andoyer_propagate::Body::moments).collect())),
        })
    }

    fn new(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        match tensors("moments", value)? {
            Some(tensors) => Ok(Self::Tensors(MemberRows::Many(tensors))),
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

    pub(super) fn rows(&self) -> Option<usize> {
        match self {
            Self::Moments(rows) => rows.members(),
            Self::Tensors(tensors) => tensors.members(),
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
                let tensors = tensors.repeated(members);
                andoyer_propagate::Ensemble::from_inertia_or(tensors, attitudes, rates, on_error, stop)
            }
        }
    }
}

/// Columns hold moments or tensors alone.
fn without_gravity(name: &str, body: &andoyer_propagate::Body) -> PyResult<()> {
    if body.gravity().is_none() {
        return Ok(());
    }
    let text = format!(
        "{name} has a gravity field, which columns of members do not hold: make scenes, and Ensemble.from_scenes of them"
    );
    Err(error::input(name, "gravity", "no gravity field", text))
}
