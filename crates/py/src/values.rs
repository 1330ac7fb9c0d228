//! What immutable classes have in common.

/// A copy of an immutable value is the value.
macro_rules! immutable {
    ($class:ty) => {
        #[pyo3::pymethods]
        impl $class {
            fn __copy__(slf: pyo3::Py<Self>) -> pyo3::Py<Self> {
                slf
            }

            fn __deepcopy__(slf: pyo3::Py<Self>, _memo: &pyo3::Bound<'_, pyo3::PyAny>) -> pyo3::Py<Self> {
                slf
            }
        }
    };
}

/// A record of numbers and words is printed by its `Display`, and pickled as TOML.
macro_rules! record {
    ($class:ty, $name:literal) => {
        $crate::values::immutable!($class);

        #[pyo3::pymethods]
        impl $class {
            /// Reads the text that `pickle` writes.
            #[staticmethod]
            fn _restored(text: &str) -> pyo3::PyResult<Self> {
                let read = toml::from_str(text).map(Self);
                let message = |error| format!(concat!("not the text of a ", $name, ": {}"), error);
                read.map_err(|error| pyo3::exceptions::PyValueError::new_err(message(error)))
            }

            fn __reduce__<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<(pyo3::Bound<'py, pyo3::PyAny>, (String,))> {
                let text = toml::to_string(&self.0);
                let text = text.map_err(|error| $crate::error::InternalError::new_err(error.to_string()))?;
                Ok((py.get_type::<Self>().getattr("_restored")?, (text,)))
            }

            fn __str__(&self) -> String {
                self.0.to_string()
            }
        }
    };
}

pub(crate) use {immutable, record};
