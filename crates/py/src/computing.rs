//! Computing without the interpreter lock: the one place where a panic, which is a fault of this package, becomes an `InternalError`.
//!
//! PyO3 would make a `PanicException` of it, which is no `Exception` and ends programs that handle their errors.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use pyo3::prelude::*;

use crate::error::InternalError;

/// What `compute` returns, without the interpreter lock; an error of it as `exception` says.
pub(crate) fn detached<T: Send, E: Send>(
    py: Python<'_>,
    exception: impl FnOnce(E) -> PyErr,
    compute: impl FnOnce() -> Result<T, E> + Send,
) -> PyResult<T> {
    // What a panic leaves half done is dropped with it, or is the caller's output array.
    let outcome = py.detach(|| catch_unwind(AssertUnwindSafe(compute)));
    outcome.map_err(|panic| internal(&*panic))?.map_err(exception)
}

fn internal(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
    InternalError::new_err(format!("a fault of this package, please report it: {text}"))
}

/// Fails as a fault of this package would, for the test of that.
#[pyfunction]
pub(crate) fn _panic(py: Python<'_>, text: &str) -> PyResult<()> {
    #[expect(clippy::panic, reason = "this is what it is for")]
    detached(py, crate::error::algebra, || panic!("{text}"))
}
