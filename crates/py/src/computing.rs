//! Computation without the interpreter lock. Only here a panic, which is a fault of this package, becomes an `InternalError`.
//!
//! PyO3 would raise a `PanicException`, which is not an `Exception` and therefore ends programs that handle their errors.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

use pyo3::prelude::*;

use crate::error::InternalError;

/// Runs `compute` without the interpreter lock and returns its result. `exception` converts its error.
pub(crate) fn detached<T: Send, E: Send>(
    py: Python<'_>,
    exception: impl FnOnce(E) -> PyErr,
    compute: impl FnOnce() -> Result<T, E> + Send,
) -> PyResult<T> {
    // Incomplete results of a panic are dropped, except those in the output array of the caller.
    #[expect(clippy::disallowed_methods, reason = "this is where panics are caught")]
    let outcome = py.detach(|| catch_unwind(AssertUnwindSafe(compute)));
    outcome.map_err(|panic| internal(&*panic))?.map_err(exception)
}

/// Time between two checks of the main thread for Ctrl-C while another thread computes.
const LOOK: Duration = Duration::from_millis(50);

/// As [`detached`]. A `long` call is computed by its own thread. Meanwhile this thread checks for signals, because Python runs signal handlers only in the main
/// thread. If a handler raises, this thread sets the stop flag of `compute`. Starting the thread takes longer than a short call.
pub(crate) fn interruptible<T: Send, E: Send>(
    py: Python<'_>,
    long: bool,
    exception: impl FnOnce(E) -> PyErr,
    compute: impl FnOnce(&AtomicBool) -> Result<T, E> + Send,
) -> PyResult<T> {
    if !long {
        return detached(py, exception, || compute(&AtomicBool::new(false)));
    }
    interruptible_with(py, &mut |py| py.check_signals(), exception, compute)
}

/// As a `long` [`interruptible`] call. An exception of `look` in the main thread stops it, too.
pub(crate) fn interruptible_with<T: Send, E: Send>(
    py: Python<'_>,
    look: &mut (impl FnMut(Python<'_>) -> PyResult<()> + Send),
    exception: impl FnOnce(E) -> PyErr,
    compute: impl FnOnce(&AtomicBool) -> Result<T, E> + Send,
) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    let mut work = Some(compute);
    let mut raised = None;
    #[expect(clippy::disallowed_methods, reason = "this is where panics are caught")]
    let outcome = py.detach(|| {
        scope(|scope| {
            let (sender, receiver) = channel::<()>();
            let (stop, slot) = (&stop, &mut work);
            let thread = Builder::new().name("andoyer".to_owned()).spawn_scoped(scope, move || {
                let _ends = sender; // dropped when the work has ended
                slot.take().map(|compute| catch_unwind(AssertUnwindSafe(|| compute(stop))))
            });
            let Ok(thread) = thread else { return None };
            while receiver.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if raised.is_none() {
                    raised = Python::attach(&mut *look).err();
                    stop.store(raised.is_some(), Ordering::Relaxed);
                }
            }
            thread.join().ok().flatten()
        })
    });
    match (raised, outcome, work) {
        (Some(raised), ..) => Err(raised),
        (None, Some(outcome), _) => outcome.map_err(|panic| internal(&*panic))?.map_err(exception),
        // The system could not start a thread.
        (None, None, Some(compute)) => detached(py, exception, || compute(&stop)),
        (None, None, None) => Err(InternalError::new_err("a fault of this package, please report it: no result")),
    }
}

fn internal(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
    InternalError::new_err(format!("a fault of this package, please report it: {text}"))
}

/// Panics like a fault of this package, for a test.
#[pyfunction]
pub(crate) fn _panic(py: Python<'_>, text: &str) -> PyResult<()> {
    #[expect(clippy::panic, reason = "this is what it is for")]
    detached(py, crate::error::algebra, || panic!("{text}"))
}
