//! `Motion.verify` and `andoyer.Verification`.

use andoyer_propagate::verification::{self, VerifyOptions};
use andoyer_series::error::Kind;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::array;
use crate::computing::interruptible;
use crate::error;
use crate::motion::Motion;
use crate::order::whole_number;
use crate::values::record;

#[pymethods]
impl Motion {
    /// Measures the error of the attitude: integrates the full equations from the epoch and compares the attitudes.
    ///
    /// The integration is that of ``method="integrated"``, about the body axes (2, 3, 1): for an integrated motion it has other steps and other rounding
    /// errors, and a tenth of the tolerance. Its time grows with the distance from the epoch; ``print(motion.plan)`` estimates it. Ctrl-C ends it.
    ///
    /// Parameters
    /// ----------
    /// span : (float, float), optional
    ///     First and last time, within the times for which the error bound holds: those from the epoch to the span of the scene and in it, or 1e9 rotations
    ///     before and after the epoch if the scene has none. By default the span of the scene, or these rotations. Times of astropy as in `Scene`.
    /// samples : int, optional
    ///     Number of times at equal steps, the first and the last one included, from 2 to 1,000,000.
    /// tolerance : float, optional
    ///     Tolerance of the integration, in rad. By default a hundredth of the plan's error bound, or a tenth of the tolerance of an integrated motion.
    ///
    /// Returns
    /// -------
    /// Verification
    ///     The errors, and whether the error bound holds.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A span that runs backwards (``(1, 0)``), is not finite, or goes beyond the times for which the error bound holds; fewer than 2 samples; a tolerance
    ///     that is not positive and finite; no span if the integration would take more than a minute. The message has the time that it would take.
    /// TheoryError
    ///     An integration with more than 8,388,608 steps on one side of the epoch, or one that is so unstable that the final state is unknown.
    ///
    /// Examples
    /// --------
    /// >>> scene = Scene(Body([0.5, 0.75, 1.0]), [0, 0, 0, 1], [0.2, 0.3, 1.1], orbit=Orbit(2e-3, 0.2), span=(0, 1e3), tolerance=1e-8)
    /// >>> motion = scene.solve()
    /// >>> verification = motion.verify()
    /// >>> verification.holds, verification.error < 1e-8
    /// (True, True)
    /// >>> motion.verify((0, 100), samples=5).times
    /// array([  0.,  25.,  50.,  75., 100.])
    #[pyo3(
        signature = (span=None, samples=None, *, tolerance=None),
        text_signature = "($self, span=None, samples=64, *, tolerance=None)"
    )]
    fn verify(
        &self,
        py: Python<'_>,
        span: Option<&Bound<'_, PyAny>>,
        samples: Option<&Bound<'_, PyAny>>,
        tolerance: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Verification> {
        let mut options = VerifyOptions::default();
        if let Some(span) = span {
            let [start, stop] = array::span(span, self.0.scene().state().epoch, self.1)?;
            options = options.span(start, stop);
        }
        if let Some(samples) = samples {
            let [least, most] = verification::SAMPLES;
            options = options.samples(whole_number("samples", samples, least, most, Kind::Input)?);
        }
        if let Some(tolerance) = tolerance {
            options = options.tolerance(array::number("tolerance", tolerance)?);
        }
        interruptible(py, true, error::propagation, |stop| self.0.verify(options.until(stop))).map(Verification)
    }
}

/// The difference between a motion and an integration of the full equations, from `Motion.verify`. ``str(verification)`` is a sentence.
///
/// Examples
/// --------
/// >>> scene = Scene(Body([0.5, 0.75, 1.0]), [0, 0, 0, 1], [0.2, 0.3, 1.1], orbit=Orbit(2e-3, 0.2), span=(0, 1e3), tolerance=1e-8)
/// >>> verification = scene.solve().verify()
/// >>> verification.times.shape, verification.errors.shape
/// ((64,), (64,))
/// >>> verification.error + verification.integration_bound <= verification.error_bound
/// True
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Verification(verification::Verification);

record!(Verification, "verification");

#[pymethods]
impl Verification {
    /// The times at which the attitudes were compared, shape (n,), read-only. If the epoch of the scene is a Time, they are TDB seconds since J2000.
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array::constant(py, self.0.times())
    }

    /// The angle between the two attitudes at each time, in rad, shape (n,), read-only.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array::constant(py, self.0.errors())
    }

    /// The largest of the errors, in rad.
    #[getter]
    fn error(&self) -> f64 {
        self.0.error()
    }

    /// The error bound of the integration, in rad.
    #[getter]
    fn integration_bound(&self) -> f64 {
        self.0.integration_bound()
    }

    /// The error bound of the motion's plan, in rad.
    #[getter]
    fn error_bound(&self) -> f64 {
        self.0.error_bound()
    }

    /// True if error + integration_bound ≤ error_bound.
    #[getter]
    fn holds(&self) -> bool {
        self.0.holds()
    }

    /// True if error − integration_bound > error_bound. If neither this nor `holds` is True, the integration is not accurate enough to decide.
    #[getter]
    fn refuted(&self) -> bool {
        self.0.refuted()
    }

    fn __repr__(&self) -> String {
        let verdict = match (self.0.holds(), self.0.refuted()) {
            (true, _) => "holds",
            (_, true) => "refuted",
            _ => "undecided",
        };
        format!(
            "<Verification at {} times: error {:.1e} rad, integration bound {:.1e}, error bound {:.1e}: {verdict}>",
            self.0.times().len(),
            self.0.error(),
            self.0.integration_bound(),
            self.0.error_bound()
        )
    }
}
