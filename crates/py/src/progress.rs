//! Progress callbacks: the callback is called once for each order, and Ctrl-C is checked while the series are computed.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use andoyer_propagate::Error as Propagation;
use andoyer_series::Error as Algebra;
use andoyer_series::progress::Progress;
use pyo3::prelude::*;

use crate::computing::{detached, interruptible_with};
use crate::error;

/// Runs `compute` without the interpreter lock and returns its result. An exception in `progress` stops the computation and is raised here.
pub(crate) fn reported<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    compute: impl FnOnce(&mut Progress<'_>) -> Result<T, Algebra> + Send,
) -> PyResult<T> {
    let mut told = None;
    let mut failure = None;
    // Called before every cell of the triangle.
    let mut tell = |done: usize, of: usize| {
        let result = Python::attach(|py| {
            py.check_signals()?;
            match &progress {
                Some(progress) if told != Some(done) => progress.call1(py, (done, of)).map(drop),
                _ => Ok(()),
            }
        });
        told = Some(done);
        match result {
            Ok(()) => ControlFlow::Continue(()),
            Err(problem) => {
                failure = Some(problem);
                ControlFlow::Break(())
            }
        }
    };
    let result = detached(py, error::algebra, || compute(&mut tell));
    match failure {
        Some(problem) => Err(problem),
        None => result,
    }
}

/// Runs `compute` in another thread, which counts what is done. `progress` is called with the count and `of` while it changes, and at the end.
pub(crate) fn counted<T: Send>(
    progress: &Bound<'_, PyAny>,
    (done, of): (&AtomicUsize, usize),
    compute: impl FnOnce(&AtomicBool) -> Result<T, Propagation> + Send,
) -> PyResult<T> {
    let (py, callable) = (progress.py(), progress.clone().unbind());
    let mut told = None;
    let mut tell = |py: Python<'_>| {
        py.check_signals()?;
        let count = done.load(Ordering::Relaxed);
        if told != Some(count) {
            told = Some(count);
            callable.call1(py, (count, of))?;
        }
        Ok(())
    };
    let result = interruptible_with(py, &mut tell, error::propagation, compute)?;
    tell(py)?;
    Ok(result)
}
