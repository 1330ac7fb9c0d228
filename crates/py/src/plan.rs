//! `andoyer.Plan`.

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

use crate::values::record;

/// The method, order, error bound and other facts about a motion, from `Motion.plan`. ``str(plan)`` is a table.
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

record!(Plan, "plan");

#[pymethods]
impl Plan {
    /// The kind of motion: "short-axis", "long-axis", "separatrix", "axisymmetric", "spherical", "principal-axis" or "at-rest".
    #[getter]
    fn mode(&self) -> String {
        self.0.mode().to_string()
    }

    /// The method of evaluation: "series", "closed" for theta functions and elementary formulas, "integrated" or "libration".
    #[getter]
    fn method(&self) -> String {
        self.0.method().to_string()
    }

    /// Order N of the series, or of the steps of an integration. It is 0 if there is no series, or if the harmonic oscillator alone meets the tolerance.
    #[getter]
    fn order(&self) -> usize {
        self.0.order()
    }

    /// The resonance of a libration, in rotations an orbit: a Fraction; None for the other methods.
    #[getter]
    fn resonance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        static FRACTION: PyOnceLock<Py<PyType>> = PyOnceLock::new();
        let Some([rotations, orbits]) = self.0.resonance() else { return Ok(None) };
        FRACTION.import(py, "fractions", "Fraction")?.call1((rotations, orbits)).map(Some)
    }

    /// Number of steps of the integration; 0 for the other methods.
    #[getter]
    fn steps(&self) -> usize {
        self.0.steps()
    }

    /// The first and the last time at which the error bound is below half a turn, of a member of an ensemble with ``errors="nan"`` that is not served over its whole span; otherwise None.
    #[getter]
    fn known(&self) -> Option<(f64, f64)> {
        self.0.known().map(Into::into)
    }

    /// The number of harmonics of a libration; otherwise the highest multiple of the anomaly ℓ′ in the evaluation, or 0 if the method has no harmonics.
    #[getter]
    fn harmonics(&self) -> usize {
        self.0.harmonics()
    }

    /// Estimated bound of the attitude error over the span, in rad; it is not proved. It includes truncation, dropped harmonics and rounding.
    #[getter]
    fn error_bound(&self) -> f64 {
        self.0.error_bound()
    }

    /// Estimated bound of the error of the angular velocity over the span, in body components, in rad per unit of time: twice the largest rate times the error bound of the attitude.
    ///
    /// A motion that starts from a sample, as that of `Motion.scene_at`, departs by this times the time.
    #[getter]
    fn rate_error_bound(&self) -> f64 {
        self.0.rate_error_bound()
    }

    /// The requested attitude error over the span, in rad.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.0.tolerance()
    }

    /// True if the error bound is at most the tolerance. If the tolerance is below the rounding error of doubles, the bound must be at most 2e-14 rad.
    #[getter]
    fn meets_tolerance(&self) -> bool {
        self.0.meets_tolerance()
    }

    /// The text of the `ToleranceWarning` if the tolerance is not met, otherwise None.
    #[getter]
    fn missed_tolerance(&self) -> Option<String> {
        self.0.missed_tolerance()
    }

    /// σ/σ_sep (theory §5): 0 for rotation about the axis of the mode, 1 on the separatrix.
    #[getter]
    fn separatrix_ratio(&self) -> f64 {
        self.0.separatrix_ratio()
    }

    /// The averaging of a scene with an orbit: "orbit" or "spin" (theory §9); None without an orbit and for an integrated motion.
    #[getter]
    fn averaging(&self) -> Option<String> {
        self.0.averaging().map(|averaging| averaging.to_string())
    }

    /// The level of the gravity-gradient theory: "full", "second-order", "moving" or "paper" (theory §9); None without an orbit and for an integrated motion.
    #[getter]
    fn level(&self) -> Option<String> {
        self.0.level().map(|level| level.to_string())
    }

    /// The size of the torque: the sum of the short-period corrections of the averaged theory, in rad; 0 without an orbit, and for an integrated or a locked motion, which has none.
    #[getter]
    fn torque(&self) -> f64 {
        self.0.torque()
    }

    /// The first neglected term of the gravity gradient, in rad: a short-period term of second order in the torque, which no level has, or one of first order that was dropped; 0 without an orbit.
    #[getter]
    fn first_neglected(&self) -> f64 {
        self.0.first_neglected()
    }

    /// The method of `Motion.partials`: "closed" (theory §12); "series", power series in time where the closed form cancels: next to a sphere, to the separatrix and to the middle axis, and for a body from a tensor also with nearly equal moments; "variational" equations, integrated from the epoch, for a scene with a torque (farther from the epoch of an averaged motion than 2,500 steps, some 200 rotations, differences of fourth order of motions by the same theory, with an error of some 1e-9 of the largest derivative; with respect to an element of an orbit the error of the theory counts, up to 3e-5); or None on the separatrix, where the derivatives do not exist.
    #[getter]
    fn partials(&self) -> Option<&'static str> {
        self.0.partials()
    }

    /// The steps that this scene did not need, with the reasons: a list of str.
    #[getter]
    fn skipped(&self) -> Vec<String> {
        self.0.skipped().to_vec()
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
