//! Values of other packages: quantities and times of astropy, rotations of SciPy, quaternions.
//!
//! This module imports none of these packages. It passes a value that looks like one of theirs to `andoyer.interop._foreign`, or an attitude to `andoyer.interop._attitudes`. Lists, tuples, floats and plain arrays,
//! the usual arguments, are recognized by their type.

use std::sync::atomic::{AtomicBool, Ordering};

use numpy::{PyArrayDescrMethods, PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyList, PyTuple};

use crate::error;

/// `value`, or the numbers in a value of another package.
pub(crate) fn plain<'py>(argument: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let usual = value.is_exact_instance_of::<PyFloat>()
        || value.is_exact_instance_of::<PyInt>()
        || value.is_exact_instance_of::<PyList>()
        || value.is_exact_instance_of::<PyTuple>()
        || value.is_exact_instance_of::<PyUntypedArray>()
        || (value.is_instance_of::<PyUntypedArray>() && !has_units(value)?);
    if usual && !masked(value)? && !first_of(value)?.is_some_and(|first| looks_foreign(&first).unwrap_or(false)) {
        return Ok(value.clone());
    }
    if !usual && !looks_foreign(value)? {
        return Ok(value.clone());
    }
    py.import(intern!(py, "andoyer.interop._foreign"))?.getattr(intern!(py, "plain"))?.call1((argument, value))
}

fn looks_foreign(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(has_units(value)? || is_time(value)?)
}

/// True for a quantity of astropy, pint, unyt or another package.
pub(crate) fn has_units(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let py = value.py();
    Ok(value.hasattr(intern!(py, "unit"))? || value.hasattr(intern!(py, "units"))?)
}

/// True for a quantity, and for a list that begins with one.
pub(crate) fn holds_units(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    has_units(&first_of(value)?.unwrap_or_else(|| value.clone()))
}

/// True if `value` is a Time or a TimeDelta of astropy; both consist of two doubles.
fn is_time(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    value.hasattr(intern!(value.py(), "jd1"))
}

/// True if `value` is a value of another package, or a list of such values. Numbers and plain arrays are recognized by their type, because looking up a missing
/// attribute takes as long as the evaluation of one time.
fn holds_times(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    if value.is_exact_instance_of::<PyFloat>()
        || value.is_exact_instance_of::<PyInt>()
        || value.is_exact_instance_of::<PyUntypedArray>()
    {
        return Ok(false);
    }
    if value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>() {
        return first_of(value)?.map_or(Ok(false), |first| is_time(&first));
    }
    is_time(value)
}

/// True if `value` is a NumPy array with a mask.
fn masked(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let py = value.py();
    let array = value.is_instance_of::<PyUntypedArray>() && !value.is_exact_instance_of::<PyUntypedArray>();
    Ok(array && value.hasattr(intern!(py, "mask"))?)
}

/// The first entry of a list or a tuple that is no plain number, through any number of nested lists.
fn first_of<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    if !(value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>()) {
        return Ok(None);
    }
    for entry in value.try_iter()? {
        let entry = entry?;
        // `float64` of NumPy is a float too.
        if entry.is_instance_of::<PyFloat>() || entry.is_exact_instance_of::<PyInt>() {
            continue;
        }
        if entry.is_exact_instance_of::<PyList>() || entry.is_exact_instance_of::<PyTuple>() {
            match first_of(&entry)? {
                None => continue,
                found => return Ok(found),
            }
        }
        return Ok(Some(entry));
    }
    Ok(None)
}

/// A Time of astropy: its Julian date in two doubles, the index of its scale in `andoyer.interop._foreign.SCALES`, and its location \[m\], which TDB depends on.
pub(crate) type Calendar = ([f64; 2], u8, Option<[f64; 3]>);

/// Times relative to epochs: in seconds, as given, and with the given shape.
pub(crate) type Since<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Vec<usize>);

/// Times of astropy as seconds since the epochs of a state or of each member; None for anything else.
pub(crate) fn since<'py>(
    argument: &str,
    value: &Bound<'py, PyAny>,
    epochs: &[Calendar],
) -> PyResult<Option<Since<'py>>> {
    if !holds_times(value)? {
        let first = first_of(value)?.unwrap_or_else(|| value.clone());
        if !epochs.is_empty() && !first.is_exact_instance_of::<PyUntypedArray>() && has_units(&first)? {
            let kind = first.get_type().name()?;
            let text = "and the epoch a calendar time: give a Time, or a TimeDelta from the epoch";
            let advice = if kind == "Quantity" { "" } else { "; Time of astropy takes dates of other packages" };
            let message = format!("{argument} is a {kind}, {text}{advice}");
            return Err(error::input(argument, format!("a {kind}").as_str(), "a Time or a TimeDelta", message));
        }
        return Ok(None);
    }
    let py = value.py();
    let since = py.import(intern!(py, "andoyer.interop._foreign"))?.getattr(intern!(py, "since"))?;
    Ok(Some(since.call1((argument, value, epochs.to_vec()))?.extract()?))
}

/// Times of astropy as TDB seconds since J2000, for a state with a calendar epoch; None for anything else.
pub(crate) fn instants<'py>(
    argument: &str,
    value: &Bound<'py, PyAny>,
    epoch: Option<Calendar>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some(epoch) = epoch else { return Ok(None) };
    if !holds_times(value)? {
        return Ok(None);
    }
    let py = value.py();
    let instants = py.import(intern!(py, "andoyer.interop._foreign"))?.getattr(intern!(py, "instants"))?;
    instants.call1((argument, value, vec![epoch])).map(Some)
}

/// Epochs as numbers, and as calendar times if they are Time objects.
pub(crate) fn epochs<'py>(argument: &str, value: &Bound<'py, PyAny>) -> PyResult<(Bound<'py, PyAny>, Vec<Calendar>)> {
    if !holds_times(value)? {
        return Ok((value.clone(), Vec::new()));
    }
    let py = value.py();
    let epochs = py.import(intern!(py, "andoyer.interop._foreign"))?.getattr(intern!(py, "epochs"))?;
    epochs.call1((argument, value))?.extract()
}

/// A time as seconds since J2000 and as a calendar time: seconds since an epoch or, if not `since_epoch`, since J2000.
pub(crate) fn later<'py>(
    py: Python<'py>,
    epoch: Calendar,
    since_epoch: bool,
    seconds: f64,
) -> PyResult<(Bound<'py, PyAny>, Vec<Calendar>)> {
    let start = since_epoch.then_some(epoch);
    let later = py.import(intern!(py, "andoyer.interop._foreign"))?.getattr(intern!(py, "later"))?;
    epochs("epoch", &later.call1((start, seconds))?)
}

/// Epochs as Times of astropy.
pub(crate) fn calendar<'py>(py: Python<'py>, epochs: &[Calendar]) -> PyResult<Bound<'py, PyAny>> {
    py.import(intern!(py, "andoyer.interop._foreign"))?.getattr(intern!(py, "calendar"))?.call1((epochs.to_vec(),))
}

/// The message for a date of Python or NumPy, which has no time scale; None for any other value.
pub(crate) fn date(argument: &str, value: &Bound<'_, PyAny>) -> Option<PyErr> {
    let (class, first) = (value.get_type(), first_of(value).ok().flatten());
    let name = first.map_or(class, |first| first.get_type());
    let module = name.module().ok()?.to_string();
    let dtype = value
        .getattr(intern!(value.py(), "dtype"))
        .ok()
        .and_then(|dtype| dtype.getattr("kind").ok()?.extract::<String>().ok());
    let kind = name.name().ok()?.to_string();
    let of_numpy =
        dtype.is_some_and(|kind| kind == "M" || kind == "m") || kind == "datetime64" || kind == "timedelta64";
    (of_numpy || module == "datetime" || module.starts_with("pandas._libs.tslibs")).then(|| {
        let text =
            "has no time scale: give a Time or TimeDelta of astropy, such as astropy.time.Time(value, scale=\"utc\")";
        PyTypeError::new_err(format!("{argument}: a {kind} {text}"))
    })
}

/// The numbers of attitudes, and whether they are [w, x, y, z]: as `scalar_first` says for plain numbers, never for rotations of SciPy and for values of other
/// packages that name their components.
pub(crate) fn attitudes<'py>(
    argument: &str,
    value: &Bound<'py, PyAny>,
    scalar_first: bool,
) -> PyResult<(Bound<'py, PyAny>, bool)> {
    let list = value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>();
    let array = value.is_exact_instance_of::<PyUntypedArray>()
        && value.cast::<PyUntypedArray>().is_ok_and(|array| matches!(array.dtype().kind(), b'i' | b'u' | b'f'));
    if array || (list && first_of(value)?.is_none()) {
        return Ok((value.clone(), scalar_first));
    }
    let py = value.py();
    let quaternions = py.import(intern!(py, "andoyer.interop._attitudes"))?.getattr(intern!(py, "quaternions"))?;
    let (numbers, known): (Bound<'py, PyAny>, bool) = quaternions.call1((argument, value))?.extract()?;
    Ok((numbers, scalar_first && !known))
}

/// [x, y, z, w] from [w, x, y, z], if `scalar_first` is set.
pub(crate) fn scalar_last(quaternion: &mut [f64; 4], scalar_first: bool) {
    if scalar_first {
        quaternion.rotate_left(1);
    }
}

/// [w, x, y, z] from [x, y, z, w], if `scalar_first` is set.
pub(crate) fn scalar_first(quaternions: &mut [[f64; 4]], asked: bool, stop: &AtomicBool) {
    for part in quaternions.chunks_mut(if asked { 1 << 20 } else { usize::MAX }) {
        if asked && !stop.load(Ordering::Relaxed) {
            part.iter_mut().for_each(|quaternion| quaternion.rotate_right(1));
        }
    }
}

/// Attitudes as rotations of SciPy. Without SciPy the error names the package and its installation.
pub(crate) fn rotation<'py>(attitudes: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<Bound<'py, PyAny>> {
    let py = attitudes.py();
    let extra = py.import(intern!(py, "andoyer._extra"))?.getattr(intern!(py, "extra"))?;
    let transform = extra.call1((intern!(py, "scipy.spatial.transform"), intern!(py, "rotation")))?;
    let rotation = transform.getattr(intern!(py, "Rotation"))?;
    rotation.call_method1(intern!(py, "from_quat"), (attitudes,))
}
