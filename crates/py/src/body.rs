//! `andoyer.Body`.

use andoyer_propagate::SeriesTables;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::{array, error};

/// Principal moments of inertia of a rigid body.
///
/// Parameters
/// ----------
/// moments : array_like, shape (3,)
///     Positive moments about body axes 1, 2, 3, in any order and any unit; the largest at most the sum of the others.
/// name : str, optional
///     Printed, and nothing else.
///
/// Raises
/// ------
/// MomentsError
///     ``[0, 1, 1]``, ``[1, -1, 1]``, ``[1, nan, 1]``, ``[1, 1, 2.1]``, which no body has, or ``[1e-101, 1, 1]``.
/// ShapeError
///     ``[1, 2]``.
///
/// Examples
/// --------
/// >>> body = Body([1.0, 1.5, 2.0])
/// >>> body.beta
/// 0.5
/// >>> Body.named("eros").moments
/// array([0.21007832, 0.98310982, 1.        ])
#[pyclass(frozen, eq, module = "andoyer")]
pub(crate) struct Body {
    pub(crate) body: andoyer_propagate::Body,
    /// What its scenes share of the perturbation series.
    pub(crate) tables: SeriesTables,
}

impl From<andoyer_propagate::Body> for Body {
    fn from(body: andoyer_propagate::Body) -> Self {
        Self { body, tables: SeriesTables::default() }
    }
}

impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        self.body == other.body
    }
}

#[pymethods]
impl Body {
    #[new]
    #[pyo3(signature = (moments, *, name=None))]
    fn new(moments: &Bound<'_, PyAny>, name: Option<&str>) -> PyResult<Self> {
        if let Ok(text) = moments.extract::<String>() {
            let hint = format!(
                "moments must hold three numbers: got {text:?}; a body of the catalogue is Body.named({text:?})"
            );
            return Err(PyTypeError::new_err(hint));
        }
        let body = andoyer_propagate::Body::new(array::fixed("moments", moments)?).map_err(error::propagation)?;
        Ok(Self::from(match name {
            Some(name) => body.with_name(name),
            None => body,
        }))
    }

    /// A body of the catalogue, by its name in any case.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of `Body.catalogue()`.
    ///
    /// Raises
    /// ------
    /// UnknownBodyError
    ///     ``"vulcan"``; for ``"ceers"`` the message asks for Ceres.
    #[staticmethod]
    fn named(name: &str) -> PyResult<Self> {
        andoyer_propagate::Body::named(name).map(Self::from).map_err(error::propagation)
    }

    /// The names that `Body.named` knows.
    #[staticmethod]
    fn catalogue() -> Vec<&'static str> {
        andoyer_propagate::Body::catalogue()
    }

    /// Where the figures of a catalogue body come from.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of `Body.catalogue()`.
    ///
    /// Raises
    /// ------
    /// UnknownBodyError
    ///     ``"vulcan"``.
    #[staticmethod]
    fn source(name: &str) -> PyResult<&'static str> {
        andoyer_propagate::Body::source(name).map_err(error::propagation)
    }

    /// The moments about body axes 1, 2, 3 as given: a read-only array, shape (3,).
    #[getter]
    fn moments<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        array::constant(py, &self.body.moments()).into_any()
    }

    /// Oblateness α = [(C/A − 1) + (C/B − 1)]/2 of the sorted moments A ≤ B ≤ C (theory §1); 0 for a sphere.
    #[getter]
    fn alpha(&self) -> f64 {
        self.body.alpha()
    }

    /// Triaxiality β, 0 ≤ β ≤ 1 (theory §1); 0 for A = B and for a sphere, 1 for B = C.
    #[getter]
    fn beta(&self) -> f64 {
        self.body.beta()
    }

    /// γ = √((C/A − 1)(C/B − 1)) (theory §1).
    #[getter]
    fn gamma(&self) -> f64 {
        self.body.gamma()
    }

    /// ω = √((1 + β)/(1 − β)) (theory §1); 1 for a sphere, infinite for B = C.
    #[getter]
    fn omega(&self) -> f64 {
        self.body.omega()
    }

    /// The name, or None.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.body.name()
    }

    pub(crate) fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let name = match self.body.name() {
            Some(name) => format!(", name={}", name.into_pyobject(py)?.repr()?),
            None => String::new(),
        };
        Ok(format!("Body({:?}{name})", self.body.moments()))
    }

    pub(crate) fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        (PyTuple::new(py, self.body.moments())?, self.body.name()).into_pyobject(py)?.hash()
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let keywords = pyo3::types::PyDict::new(py);
        keywords.set_item("name", self.body.name())?;
        ((self.body.moments(),), keywords).into_pyobject(py)
    }
}
