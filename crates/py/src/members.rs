//! The iterator over an ensemble, whose members are solved when they are reached.

use pyo3::prelude::*;

use crate::computing::detached;
use crate::ensemble::Ensemble;
use crate::error;
use crate::motion::Motion;

/// The motions of an ensemble, in order: what ``iter(ensemble)`` gives.
#[pyclass(module = "andoyer._core")]
pub(crate) struct Members {
    ensemble: Py<Ensemble>,
    next: usize,
}

impl Members {
    pub(crate) fn of(ensemble: Py<Ensemble>) -> Self {
        Self { ensemble, next: 0 }
    }
}

#[pymethods]
impl Members {
    fn __iter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<Motion>> {
        let ensemble = &self.ensemble.get().0;
        if self.next >= ensemble.len() {
            return Ok(None);
        }
        let motion = detached(py, error::propagation, || ensemble.motion(self.next))?;
        self.next += 1;
        Ok(Some(Motion(motion)))
    }
}
