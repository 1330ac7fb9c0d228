//! The writers of SPICE kernels, which `andoyer.output` calls.

use std::io;
use std::ops::ControlFlow;
use std::path::PathBuf;

use andoyer_propagate::spice::{AttitudeTable, Kernel, KernelOptions, WriteError, Written, write_samples};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

use crate::array::{MemberRows, numbers_of};
use crate::computing::detached;
use crate::error::{self, input};
use crate::motion::Motion;

/// Names and codes: body_frame, frame, instrument or body, segment, center, clock, whether the clock is the user's.
type Names = (String, String, Option<i32>, String, Option<i32>, Option<i32>, bool);
/// Options: time 0, interpolation error, whether files are replaced, comments, the ticks of the user's clock, the progress callback.
type Options = (f64, f64, bool, Vec<String>, Option<Py<PyAny>>, Py<PyAny>);

/// The code of a frame that has no other: computed from its name.
#[pyfunction]
pub(crate) fn _frame_code(body_frame: &str) -> i32 {
    Kernel::code_of(body_frame)
}

/// The code of the clock of a frame, if none is given; `users`: of a clock that the user has.
#[pyfunction]
pub(crate) fn _clock_code(instrument: i32, users: bool) -> i32 {
    Kernel::clock_of(instrument, users)
}

/// Writes a motion as a C-kernel, or as a binary PCK; type, number of records and error.
#[pyfunction]
pub(crate) fn _write_motion(
    py: Python<'_>,
    path: PathBuf,
    motion: &Motion,
    interval: [f64; 2],
    pck: bool,
    names: Names,
    options: Options,
) -> PyResult<(u8, usize, f64)> {
    written(py, &path, names, options, |kernel, request| {
        if pck {
            motion.0.write_pck(&path, interval, kernel, request)
        } else {
            motion.0.write_ck(&path, interval, kernel, request)
        }
    })
}

/// Writes attitudes at given times as a C-kernel.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "called by one Python function")]
pub(crate) fn _write_samples(
    py: Python<'_>,
    path: PathBuf,
    times: &Bound<'_, PyAny>,
    attitudes: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
    longest_step: f64,
    names: Names,
    options: Options,
) -> PyResult<(u8, usize, f64)> {
    let times = numbers_of("times", times)?;
    let attitudes = MemberRows::<4>::new("attitude", attitudes)?.repeated(1);
    let rates =
        rates.map(|rates| MemberRows::<3>::new("angular_velocity", rates)).transpose()?.map(|rates| rates.repeated(1));
    written(py, &path, names, options, |kernel, request| {
        write_samples(
            &path,
            AttitudeTable { times: &times, attitudes: &attitudes, rates: rates.as_deref() },
            longest_step,
            kernel,
            request,
        )
    })
}

/// Runs a writer without the interpreter lock. An exception of a callback ends it and is raised here.
fn written(
    py: Python<'_>,
    path: &std::path::Path,
    (body_frame, frame, code, segment, center, clock, users): Names,
    (zero, interpolation_error, force, comments, ticks, progress): Options,
    write: impl FnOnce(&Kernel, KernelOptions<'_>) -> Result<Written, WriteError> + Send,
) -> PyResult<(u8, usize, f64)> {
    let kernel = (|| {
        let kernel =
            Kernel::new(&body_frame, &frame)?.with_segment(&segment)?.with_clock(clock, users)?.with_center(center);
        code.map_or(Ok(kernel.clone()), |code| kernel.with_code(code))
    })();
    let kernel = kernel.map_err(|refused| raised(WriteError::Refused(refused), path))?;
    let failure = std::sync::Mutex::new(None);
    let keep = |problem: PyErr| *failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(problem);
    let tell = |done: usize, of: usize| {
        let told = Python::attach(|py| py.check_signals().and_then(|()| progress.call1(py, (done, of)).map(drop)));
        told.map_or_else(
            |problem| {
                keep(problem);
                ControlFlow::Break(())
            },
            ControlFlow::Continue,
        )
    };
    let convert = ticks.map(|ticks| {
        move |times: &[f64]| {
            Python::attach(|py| ticks.call1(py, (times.to_vec(),))?.extract::<Vec<f64>>(py)).map_err(|problem| {
                keep(problem);
                io::Error::from(io::ErrorKind::Other)
            })
        }
    });
    let ticks = convert.map(|convert| Box::new(convert) as Box<_>);
    let request = KernelOptions { zero, interpolation_error, force, comments, ticks, progress: Box::new(tell) };
    let result = detached(py, |problem| raised(problem, path), || write(&kernel, request));
    match failure.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        Some(problem) => Err(problem),
        None => result.map(|Written { kind, records, error }| (kind, records, error)),
    }
}

/// The exception for an error of a writer.
fn raised(problem: WriteError, path: &std::path::Path) -> PyErr {
    match problem {
        WriteError::Motion(problem) => error::propagation(problem),
        WriteError::Refused(refused) => {
            let message = refused.to_string();
            input(refused.argument, refused.value, refused.allowed, message)
        }
        WriteError::System(problem, failed) => {
            let failed = if failed.as_os_str().is_empty() { path } else { &failed };
            let number = problem.raw_os_error().or(match problem.kind() {
                io::ErrorKind::AlreadyExists => Some(17),
                io::ErrorKind::IsADirectory => Some(21),
                io::ErrorKind::FileTooLarge => Some(27),
                io::ErrorKind::NotSeekable => Some(29),
                _ => None,
            });
            let Some(number) = number else { return PyOSError::new_err(problem.to_string()) };
            let said = Python::attach(|py| py.import("os")?.call_method1("strerror", (number,))?.extract::<String>());
            // Python selects the class by the number.
            PyOSError::new_err((number, said.unwrap_or_else(|_| problem.to_string()), failed.display().to_string()))
        }
        problem => PyOSError::new_err(problem.to_string()),
    }
}
