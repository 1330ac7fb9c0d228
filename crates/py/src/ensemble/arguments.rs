//! Arguments of `andoyer.Ensemble`.

use andoyer_propagate::disturbers::DisturbingBody;
use andoyer_propagate::ensemble::{MAX_THREADS, OnError, Outcome};
use andoyer_propagate::error::Kind;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::array::{number, numbers_of, span as span_of};
use crate::error;
use crate::foreign::{self, Calendar};
use crate::orbit::Orbit;
use crate::order::whole_number;
use crate::scene::arguments::{disturbing_bodies, kind};
use crate::scene_class::Scene;
use crate::tabulated::TabulatedOrbit;
use crate::torque;

/// Epochs as numbers, one or one for each member, and as calendar times if they are Time objects.
pub(super) fn epochs_of(value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<Calendar>)> {
    let (seconds, calendar) = foreign::epochs("epochs", value)?;
    Ok((numbers_of("epochs", &seconds)?, calendar))
}

/// The ensemble with its options.
pub(super) fn asked(
    ensemble: andoyer_propagate::Ensemble,
    orbits: Option<Vec<Vec<DisturbingBody>>>,
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

/// The bodies that act on all members, of the argument `orbit`, or on each, of `orbits`.
pub(super) fn orbits_given(
    orbit: Option<&Bound<'_, PyAny>>,
    orbits: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<Vec<Vec<DisturbingBody>>>> {
    match (orbit, orbits) {
        (Some(of_all), None) => Ok(Some(vec![disturbing_bodies(of_all)?])),
        (None, Some(orbits)) => orbits_of(orbits).map(Some),
        (None, None) => Ok(None),
        (Some(_), Some(_)) => Err(PyTypeError::new_err("orbit is that of all members: orbits must be None beside it")),
    }
}

/// The bodies of one orbit for all members, or those of an orbit, several or None for each.
fn orbits_of(value: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<DisturbingBody>>> {
    let is_one = |value: &Bound<'_, PyAny>| value.is_instance_of::<Orbit>() || value.is_instance_of::<TabulatedOrbit>();
    if is_one(value) {
        return Ok(vec![disturbing_bodies(value)?]);
    }
    let or = "a sequence with one, several or None for each member";
    let members = value.try_iter().map_err(|_| not_an_orbit("orbits", value, or))?;
    let bodies = |(index, member): (usize, PyResult<Bound<'_, PyAny>>)| {
        let member = member?;
        if member.is_none() {
            return Ok(Vec::new());
        }
        let several = member.is_instance_of::<PyList>() || member.is_instance_of::<PyTuple>();
        let named = |problem| match several {
            true => problem,
            false => not_an_orbit(&format!("orbits[{index}]"), &member, "None"),
        };
        disturbing_bodies(&member).map_err(named)
    };
    members.enumerate().map(bodies).collect()
}

fn not_an_orbit(name: &str, value: &Bound<'_, PyAny>, or: &str) -> PyErr {
    PyTypeError::new_err(format!("{name} must be an Orbit or {or}, not {}", kind(value)))
}

type SceneOrError = Result<andoyer_propagate::Scene, andoyer_propagate::Error>;

/// The scenes of `Ensemble.from_scenes` or the errors in their places, and the calendar epochs: none, one of all, or one of each.
pub(super) fn scenes_of(value: &Bound<'_, PyAny>) -> PyResult<(Vec<SceneOrError>, Vec<Calendar>)> {
    let refused = |name: &str, value: &Bound<'_, PyAny>| {
        PyTypeError::new_err(format!("{name} must be an andoyer.Scene, not {}", kind(value)))
    };
    let (mut scenes, mut calendar, mut first) = (Vec::new(), Vec::new(), None);
    for (index, member) in value.try_iter().map_err(|_| refused("scenes", value))?.enumerate() {
        let member = member?;
        if member.is_instance_of::<error::Error>() {
            scenes.push(Err(error::stated(&member)?));
            calendar.push(None);
            continue;
        }
        let scene = member.cast::<Scene>().map_err(|_| refused(&format!("scenes[{index}]"), &member))?.get();
        if first.get_or_insert(scene.calendar).is_some() != scene.calendar.is_some() {
            let text = format!("scenes[{index}] and another one: one has a calendar epoch, the other a number");
            return Err(error::input("scenes", index, "epochs of one kind", text));
        }
        scenes.push(Ok(scene.scene.clone()));
        calendar.push(scene.calendar);
    }
    let Some(first) = first.flatten() else { return Ok((scenes, Vec::new())) };
    // A member without a scene has the epoch of the first that has one.
    let mut calendar: Vec<Calendar> = calendar.into_iter().map(|epoch| epoch.unwrap_or(first)).collect();
    if calendar.iter().all(|epoch| *epoch == first) {
        calendar.truncate(1);
    }
    Ok((scenes, calendar))
}

/// The options of all scenes.
const OPTIONS: [&str; 6] = ["orbit", "torques", "tolerance", "method", "level", "span"];

/// The ensemble of scenes or their errors, with options of all of them; `maker` is named where there is no such option.
pub(super) fn of_scenes(
    scenes: Vec<SceneOrError>,
    (time, calendar): (f64, Option<Calendar>),
    (threads, on_error): (Option<&Bound<'_, PyAny>>, OnError),
    options: Option<&Bound<'_, PyDict>>,
    maker: &str,
) -> PyResult<andoyer_propagate::Ensemble> {
    let threads = threads.map(|value| whole_number("threads", value, 1, MAX_THREADS, Kind::Input)).transpose()?;
    let mut ensemble = andoyer_propagate::Ensemble::from_scenes(scenes, on_error).map_err(error::propagation)?;
    let mut orbits = None;
    for (name, value) in options.into_iter().flat_map(|options| options.iter()) {
        let name: String = name.extract()?;
        if value.is_none() && OPTIONS.contains(&&name[..]) {
            continue;
        }
        ensemble = match &name[..] {
            "tolerance" => ensemble.tolerance(tolerance(&value)?),
            "method" => ensemble.method(value.extract::<String>()?.parse().map_err(error::propagation)?),
            "level" => ensemble.level(value.extract::<String>()?.parse().map_err(error::propagation)?),
            "torques" => ensemble.torques(torque::torques(&value)?),
            "span" => {
                let [start, stop] = span_of(&value, time, calendar)?;
                ensemble.span(start, stop)
            }
            "orbit" => {
                orbits = orbits_given(Some(&value), None)?;
                ensemble
            }
            _ => {
                let text = format!("{name} is not an option of {maker}: {} are", OPTIONS.join(", "));
                return Err(PyTypeError::new_err(text));
            }
        };
    }
    let ensemble = asked(ensemble, orbits, None, threads).map_err(error::propagation)?;
    ensemble.validate().map_err(error::propagation)?;
    Ok(ensemble)
}

pub(super) fn tolerance(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    number("tolerance", value)
}

/// The errors of refused members, as Python exceptions.
pub(super) fn refused(py: Python<'_>, outcome: Outcome) -> Vec<(usize, Py<PyAny>)> {
    let value = |problem| error::propagation(problem).into_value(py).into_any();
    outcome.into_errors().into_iter().map(|(index, problem)| (index, value(problem))).collect()
}
