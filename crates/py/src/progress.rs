//! Progress callbacks: the callback is called once for each order, and Ctrl-C is checked while the series are computed.

use std::ops::ControlFlow;

use andoyer_series::Error as Algebra;
use andoyer_series::progress::Progress;
use pyo3::prelude::*;

use crate::computing::detached;
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
