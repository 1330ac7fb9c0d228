//! `andoyer.Plan`.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::InternalError;

/// What is evaluated for a motion, and why: see `Motion.plan`; ``str(plan)`` is a table of it.
///
/// Examples
/// --------
/// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
/// >>> plan = scene.solve().plan
/// >>> plan.mode, plan.method
/// ('short-axis', 'closed')
/// >>> plan.error_bound < 1e-12
/// True
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Plan(pub(crate) andoyer_propagate::Plan);

#[pymethods]
impl Plan {
    /// The kind of motion: "short-axis", "long-axis", "separatrix", "axisymmetric", "spherical", "principal-axis" or "at-rest".
    #[getter]
    fn mode(&self) -> String {
        self.0.mode().to_string()
    }

    /// How it is evaluated: "series", "closed" for theta functions and the formulas that need no sum at all, or "integrated".
    #[getter]
    fn method(&self) -> String {
        self.0.method().to_string()
    }

    /// Order N of the series; 0 where none is used, or where the harmonic oscillator alone meets the tolerance. Of an integration the order of its steps.
    #[getter]
    fn order(&self) -> usize {
        self.0.order()
    }

    /// Steps of the integration; 0 without one.
    #[getter]
    fn steps(&self) -> usize {
        self.0.steps()
    }

    /// The highest multiple of the anomaly ℓ′ that is evaluated; 0 where none is.
    #[getter]
    fn harmonics(&self) -> usize {
        self.0.harmonics()
    }

    /// Estimate from above of the attitude error over the span, in rad: truncation, dropped harmonics, rounding.
    #[getter]
    fn error_bound(&self) -> f64 {
        self.0.error_bound()
    }

    /// The attitude error asked for over the span, in rad.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.0.tolerance()
    }

    /// Whether the error bound is within the tolerance, or within 2e-14 rad where the tolerance is less than double precision holds.
    #[getter]
    fn meets_tolerance(&self) -> bool {
        self.0.meets_tolerance()
    }

    /// The sentence of the `ToleranceWarning` where the tolerance is not met, or None.
    #[getter]
    fn missed_tolerance(&self) -> Option<String> {
        self.0.missed_tolerance()
    }

    /// σ/σ_sep: 0 on the axis of greatest inertia, 1 on the separatrix (theory §5).
    #[getter]
    fn separatrix_ratio(&self) -> f64 {
        self.0.separatrix_ratio()
    }

    /// How far the equations of a scene with an orbit are averaged: "orbit", "spin", or None without an orbit (theory §9).
    #[getter]
    fn averaging(&self) -> Option<String> {
        self.0.averaging().map(|averaging| averaging.to_string())
    }

    /// Size of the torque: the sum of the short-period corrections by the gravity gradient, in rad; 0 without an orbit.
    #[getter]
    fn torque(&self) -> f64 {
        self.0.torque()
    }

    /// First neglected term under a gravity gradient, in rad: of second order in the torque, or a short-period one that was dropped; 0 without an orbit.
    #[getter]
    fn first_neglected(&self) -> f64 {
        self.0.first_neglected()
    }

    /// How `Motion.partials` computes: "closed" (theory §12); "differences" of fourth order for a scene with an orbit or an integrated motion; None on the separatrix, where there are none.
    #[getter]
    fn partials(&self) -> Option<&'static str> {
        self.0.partials()
    }

    /// What this scene did not need, and why: a list of str.
    #[getter]
    fn skipped(&self) -> Vec<String> {
        self.0.skipped().to_vec()
    }

    /// The plan in the text that pickles hold.
    #[staticmethod]
    fn _restored(text: &str) -> PyResult<Self> {
        toml::from_str(text)
            .map(Self)
            .map_err(|error| PyValueError::new_err(format!("not the text of a plan: {error}")))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let text = toml::to_string(&self.0).map_err(|error| InternalError::new_err(error.to_string()))?;
        Ok((py.get_type::<Self>().getattr("_restored")?, (text,)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        let plan = &self.0;
        format!(
            "Plan(mode='{}', method='{}', order={}, harmonics={}, error_bound={:?}, separatrix_ratio={:?})",
            plan.mode(),
            plan.method(),
            plan.order(),
            plan.harmonics(),
            plan.error_bound(),
            plan.separatrix_ratio()
        )
    }
}
