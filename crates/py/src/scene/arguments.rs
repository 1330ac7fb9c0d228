//! Arguments of a scene.

use std::ffi::CString;

use andoyer_propagate::disturbers::DisturbingBody;
use andoyer_propagate::nalgebra::UnitQuaternion;
use andoyer_propagate::periods::ObservedPeriods;
use andoyer_propagate::{Error, State};
use pyo3::exceptions::{PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use crate::array;
use crate::error::{self, InternalError};
use crate::foreign::{self, Calendar};
use crate::orbit::Orbit;
use crate::tabulated::TabulatedOrbit;

// PyO3 leaves the name of an argument out of the message of its own `TypeError`.
pub(crate) fn epoch(value: Option<&Bound<'_, PyAny>>) -> PyResult<(f64, Option<Calendar>)> {
    let Some(value) = value else { return Ok((0.0, None)) };
    let (numbers, calendar) = foreign::epochs("epoch", value)?;
    Ok((array::number("epoch", &numbers)?, calendar.first().copied()))
}

pub(super) fn tolerance(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    array::number("tolerance", value)
}

pub(super) fn precession(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    array::number("precession", value)
}

pub(super) fn rotation(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    array::number("rotation", value)
}

pub(super) fn sense(value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if value.is_none() { Ok(None) } else { array::number("sense", value).map(Some) }
}

/// The attitude of `Scene.from_periods`, which takes the place of phases. Its order of components, `scalar_first`, is taken out of the options.
pub(super) fn near(
    attitude: Option<&Bound<'_, PyAny>>,
    phases: Option<&Bound<'_, PyAny>>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Option<UnitQuaternion<f64>>> {
    let Some(attitude) = attitude else { return Ok(None) };
    if let Some(phases) = phases {
        let value = array::fixed("phases", phases)?;
        return Err(error::propagation(Error::PhasesAndAttitude { value }));
    }
    let mut scalar_first = false;
    if let Some(options) = options
        && let Some(given) = options.get_item("scalar_first")?
    {
        scalar_first = given.extract()?;
        options.del_item("scalar_first")?;
    }
    let (attitude, scalar_first) = foreign::attitudes("attitude", attitude, scalar_first)?;
    let mut quaternion = array::fixed("attitude", &attitude)?;
    foreign::scalar_last(&mut quaternion, scalar_first);
    let state = State::new(0.0, quaternion, [0.0; 3]).map_err(error::propagation)?;
    Ok(Some(state.attitude))
}

/// Warns of phases beyond a whole turn, which are probably in degrees.
pub(super) fn doubt(py: Python<'_>, periods: &ObservedPeriods) -> PyResult<()> {
    for (index, phase) in periods.beyond_a_turn() {
        let said = format!(
            "phases[{index}] = {phase:?} is more than a whole turn: phases are in turns, not in degrees or radians"
        );
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(said)?, 1)?;
    }
    Ok(())
}

/// The scene of this state, at the epoch as it was given, with the keyword arguments of `Scene`.
pub(crate) fn with_options<'py>(
    class: &Bound<'py, PyType>,
    body: &Bound<'py, PyAny>,
    (scene, epoch): (&andoyer_propagate::Scene, Option<&Bound<'py, PyAny>>),
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let keywords = options.unwrap_or_else(|| PyDict::new(class.py()));
    if keywords.contains("scalar_first")? {
        return Err(PyTypeError::new_err("scalar_first says how an attitude is given, and none is given here"));
    }
    let State { attitude, angular_velocity, .. } = scene.state();
    if let Some(epoch) = epoch {
        keywords.set_item("epoch", epoch)?;
    }
    let (attitude, rates): ([f64; 4], [f64; 3]) = (attitude.coords.into(), (*angular_velocity).into());
    class.call((body, attitude, rates), Some(&keywords))
}

/// The message for an argument that is not a `Body`.
pub(crate) fn not_a_body(value: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("body must be an andoyer.Body: got {}; use Body([A, B, C])", kind(value)))
}

/// One disturbing body, or a sequence of them.
pub(crate) fn disturbing_bodies(value: &Bound<'_, PyAny>) -> PyResult<Vec<DisturbingBody>> {
    let one = |value: &Bound<'_, PyAny>| -> Option<DisturbingBody> {
        let orbit = value.cast::<Orbit>().map(|orbit| orbit.get().0.into());
        orbit
            .or_else(|_| value.cast::<TabulatedOrbit>().map(|table| DisturbingBody::Tabulated(table.get().0.clone())))
            .ok()
    };
    if let Some(body) = one(value) {
        return Ok(vec![body]);
    }
    if value.is_instance_of::<PyDict>() {
        return Err(not_an_orbit(value));
    }
    let members = value.try_iter().map_err(|_| not_an_orbit(value))?;
    members.map(|member| member.and_then(|member| one(&member).ok_or_else(|| not_an_orbit(&member)))).collect()
}

pub(crate) fn disturbing_body<'py>(py: Python<'py>, body: &DisturbingBody) -> PyResult<Bound<'py, PyAny>> {
    match body {
        DisturbingBody::Orbit(orbit) => Ok(Bound::new(py, Orbit(*orbit))?.into_any()),
        DisturbingBody::Tabulated(table) => Ok(Bound::new(py, TabulatedOrbit(table.clone()))?.into_any()),
        _ => Err(InternalError::new_err("a fault of this package, please report it: an unknown disturbing body")),
    }
}

/// The message for an argument that is not an `Orbit`.
pub(super) fn not_an_orbit(value: &Bound<'_, PyAny>) -> PyErr {
    let said = "orbit must be an andoyer.Orbit, a TabulatedOrbit, a sequence of them or None: got";
    PyTypeError::new_err(format!("{said} {}; use Orbit(mean_motion)", kind(value)))
}

/// The message for an argument that is not one `Orbit`.
pub(super) fn not_one_orbit(value: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("orbit must be an andoyer.Orbit: got {}; a body is locked to one orbit", kind(value)))
}

/// The name of the type of a value.
pub(crate) fn kind(value: &Bound<'_, PyAny>) -> String {
    value.get_type().name().map_or_else(|_| "something else".to_owned(), |name| name.to_string())
}
