//! Arguments of `andoyer.Ensemble`.

use andoyer_propagate::ensemble::Outcome;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::array::{number, numbers_of};
use crate::error;
use crate::foreign::{self, Calendar};
use crate::orbit::Orbit;

/// Epochs as numbers, one or one for each member, and as calendar times if they are Time objects.
pub(super) fn epochs_of(value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<Calendar>)> {
    let (seconds, calendar) = foreign::epochs("epochs", value)?;
    Ok((numbers_of("epochs", &seconds)?, calendar))
}

/// The ensemble with its options.
pub(super) fn asked(
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

/// One orbit for all members, or an orbit or None for each.
pub(super) fn orbits_of(value: &Bound<'_, PyAny>) -> PyResult<Vec<Option<andoyer_propagate::Orbit>>> {
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

pub(super) fn tolerance(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    number("tolerance", value)
}

/// The errors of refused members, as Python exceptions.
pub(super) fn refused(py: Python<'_>, outcome: Outcome) -> Vec<(usize, Py<PyAny>)> {
    let value = |problem| error::propagation(problem).into_value(py).into_any();
    outcome.into_errors().into_iter().map(|(index, problem)| (index, value(problem))).collect()
}
