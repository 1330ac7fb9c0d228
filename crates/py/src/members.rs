//! The iterator over an ensemble. It solves each member when it reaches the member.

use pyo3::prelude::*;

/// The iterator over the members of an ensemble, from ``iter(ensemble)``.
#[pyclass(module = "andoyer._core")]
pub(crate) struct Members {
    sequence: Py<PyAny>,
    next: usize,
}

impl Members {
    pub(crate) fn of(sequence: Py<PyAny>) -> Self {
        Self { sequence, next: 0 }
    }
}

#[pymethods]
impl Members {
    fn __iter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __next__<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let sequence = self.sequence.bind(py);
        if self.next >= sequence.len()? {
            return Ok(None);
        }
        let member = sequence.get_item(self.next)?;
        self.next += 1;
        Ok(Some(member))
    }
}
