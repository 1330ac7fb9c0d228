//! `TabulatedOrbit.from_spk`, and the reader of orientations that `andoyer.output.read_pck` calls.

use std::path::PathBuf;

use andoyer_propagate::nalgebra::{Quaternion, UnitQuaternion, Vector3};
use andoyer_propagate::spice::{Ephemeris, EphemerisError, OrbitRequest, Orientations, ReadError, frames};
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::array::{fixed, number, numbers_of};
use crate::computing::detached;
use crate::error::{self, FileError, input};
use crate::foreign;
use crate::tabulated::TabulatedOrbit;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Bodies by their names in SPICE.
const BODIES: [(&str, i32); 22] = [
    ("SOLAR SYSTEM BARYCENTER", 0),
    ("MERCURY BARYCENTER", 1),
    ("VENUS BARYCENTER", 2),
    ("EARTH BARYCENTER", 3),
    ("MARS BARYCENTER", 4),
    ("JUPITER BARYCENTER", 5),
    ("SATURN BARYCENTER", 6),
    ("URANUS BARYCENTER", 7),
    ("NEPTUNE BARYCENTER", 8),
    ("PLUTO BARYCENTER", 9),
    ("SUN", 10),
    ("MERCURY", 199),
    ("VENUS", 299),
    ("MOON", 301),
    ("EARTH", 399),
    ("PHOBOS", 401),
    ("DEIMOS", 402),
    ("MARS", 499),
    ("JUPITER", 599),
    ("SATURN", 699),
    ("URANUS", 799),
    ("NEPTUNE", 899),
];

/// One path or several.
#[derive(FromPyObject)]
pub(crate) enum Paths {
    One(PathBuf),
    Many(Vec<PathBuf>),
}

impl Paths {
    fn all(self) -> Vec<PathBuf> {
        match self {
            Self::One(path) => vec![path],
            Self::Many(paths) => paths,
        }
    }
}

/// A NAIF code, or a name.
#[derive(FromPyObject)]
enum BodyCode {
    Code(i32),
    Name(String),
}

impl BodyCode {
    fn code(self, argument: &str) -> PyResult<i32> {
        let name = match self {
            Self::Code(code) => return Ok(code),
            Self::Name(name) => name,
        };
        let wanted = name.trim().to_uppercase();
        let found = BODIES.iter().find(|(own, _)| *own == wanted).map(|(_, code)| *code);
        found.or_else(|| wanted.parse().ok()).ok_or_else(|| {
            let names = BODIES.map(|(own, _)| own).join(", ");
            input(
                argument,
                &name[..],
                &names[..],
                format!("{argument} = {name:?}: it must be a NAIF code, or one of {names}"),
            )
        })
    }
}

/// The exception of a kernel that cannot be read.
fn read_error(problem: ReadError) -> PyErr {
    let message = problem.to_string();
    match problem {
        ReadError::NotCovered { et, .. } => input("times", et, "covered by the files", message),
        ReadError::Time { et } => input("times", &et[..], "finite", message),
        _ => FileError::new_err(message),
    }
}

fn exception(problem: EphemerisError) -> PyErr {
    match problem {
        EphemerisError::Read(problem @ ReadError::NotCovered { et, .. }) => {
            input("span", et, "covered by the files", problem.to_string())
        }
        EphemerisError::Read(problem) => read_error(problem),
        EphemerisError::Table(problem) => error::propagation(problem),
        other => {
            let message = other.to_string();
            input("error", &message[..], "larger", message.clone())
        }
    }
}

/// Seconds of TDB past J2000, of a number or a Time.
fn seconds(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    number(argument, &foreign::epochs(argument, value)?.0)
}

#[pymethods]
impl TabulatedOrbit {
    /// The orbit of a body from SPICE's ephemerides (SPK of type 2, 3, 9 or 13), read without SpiceyPy. Rows with velocities have the longest step that keeps the error.
    ///
    /// Parameters
    /// ----------
    /// files : path-like or sequence of path-like
    ///     SPK files; where several cover a time, the last counts.
    /// target, observer : int or str
    ///     NAIF codes or names, of the disturbing body and of the rotating one: ``"SUN"``, ``399``.
    /// span : (float, float) or (Time, Time)
    ///     First and last time, in seconds of TDB past J2000.
    /// gm : float
    ///     G × mass of the disturbing body, in km³/s².
    /// frame : str, optional
    ///     Inertial frame: J2000, ICRF, ECLIPJ2000 or another one that SPICE knows.
    /// error : float, optional
    ///     Largest error of a position between two rows, over the distance.
    /// epoch : float or Time, optional
    ///     The seconds of TDB past J2000 that are time 0 of the table; by default 0.
    ///
    /// Returns
    /// -------
    /// TabulatedOrbit
    ///     In km, seconds and km³/s².
    ///
    /// Warns
    /// -----
    /// UserWarning
    ///     A `gm` in other units, as for `TabulatedOrbit`.
    ///
    /// Raises
    /// ------
    /// FileError
    ///     A file that is missing, damaged, no SPK, or of a type that is not read.
    /// InputError
    ///     A body or a time without data, with the covered intervals next to it; an unknown name or frame; a span that is empty or reversed; an error that no table of a million rows reaches.
    #[classmethod]
    #[pyo3(
        signature = (files, target, observer, span, *, gm, frame="J2000", error=None, epoch=None),
        text_signature = "(files, target, observer, span, *, gm, frame='J2000', error=1e-09, epoch=None)"
    )]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn from_spk(
        class: &Bound<'_, PyType>,
        files: Paths,
        target: BodyCode,
        observer: BodyCode,
        span: &Bound<'_, PyAny>,
        gm: &Bound<'_, PyAny>,
        frame: &str,
        error: Option<&Bound<'_, PyAny>>,
        epoch: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let Some((code, _)) = frames::find(&frame.to_uppercase()) else {
            let bound = "an inertial frame of SPICE, such as J2000 or ECLIPJ2000";
            return Err(input("frame", frame, bound, format!("frame = {frame:?}: it must be {bound}")));
        };
        let request = OrbitRequest {
            target: target.code("target")?,
            observer: observer.code("observer")?,
            span: span_of(span)?,
            // A quantity is converted to m³/s².
            gm: number("gm", gm)? * if foreign::holds_units(gm)? { 1e-9 } else { 1.0 },
            frame: code,
            error: error.map_or(Ok(1e-9), |error| number("error", error))?,
            epoch: epoch.map_or(Ok(0.0), |epoch| seconds("epoch", epoch))?,
        };
        let files = files.all();
        let table = detached(class.py(), exception, || {
            let ephemeris = Ephemeris::open(&files)?;
            andoyer_propagate::TabulatedOrbit::from_ephemeris(&ephemeris, &request)
        })?;
        Self::warned(class.py(), table)
    }
}

/// Two times as seconds of TDB past J2000.
fn span_of(span: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    if let Ok((start, stop)) = span.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>() {
        return Ok([seconds("span", &start)?, seconds("span", &stop)?]);
    }
    fixed("span", &foreign::epochs("span", span)?.0)
}

/// Attitudes and angular velocities in body components of a body frame at times, from binary PCK files.
#[pyfunction]
pub(crate) fn _read_pck<'py>(
    py: Python<'py>,
    files: Paths,
    code: i32,
    times: &Bound<'py, PyAny>,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let (files, times) = (files.all(), numbers_of("times", times)?);
    let rows = detached(py, read_error, || {
        let orientations = Orientations::open(&files)?;
        let one = |time: &f64| {
            let (attitude, rates) = orientations.attitude(code, *time)?;
            let [x, y, z, w] = attitude;
            let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
            Ok::<_, ReadError>((attitude, <[f64; 3]>::from(turn.inverse() * Vector3::from(rates))))
        };
        times.iter().map(one).collect::<Result<Vec<_>, _>>()
    })?;
    let attitudes: Vec<f64> = rows.iter().flat_map(|row| row.0).collect();
    let rates: Vec<f64> = rows.iter().flat_map(|row| row.1).collect();
    Ok((attitudes.into_pyarray(py).reshape(vec![rows.len(), 4])?, rates.into_pyarray(py).reshape(vec![rows.len(), 3])?))
}
