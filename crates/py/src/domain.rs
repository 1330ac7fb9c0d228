//! `andoyer.Domain`.

use andoyer_series::birkhoff::Domain as Inner;
use pyo3::prelude::*;

use crate::error;

/// An estimate of the range of validity of a normal form by the sizes of its orders, from `BirkhoffNormalForm.domain`.
///
/// The series diverge. At a given amplitude a = √(2|I|) of all modes the sizes of the orders first fall and then rise. The best order is the one with the least
/// size. This is an estimate, not a bound; `BirkhoffNormalForm.actions` along an integrated orbit shows the true accuracy.
///
/// Examples
/// --------
/// >>> domain = normalize("(x**2 + X**2)/2 - x**3/3", 6, [("x", "X")]).domain()
/// >>> len(domain.norms), len(domain.radii), domain.best_order(0.1)
/// (6, 4, 6)
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Domain(pub(crate) Inner);

#[pymethods]
impl Domain {
    /// The norms ‖T_1‖ … ‖T_N‖ of the generating functions T_m = S_m/(m−1)! at the amplitude 1.
    #[getter]
    fn norms(&self) -> Vec<f64> {
        self.0.norms().to_vec()
    }

    /// The radii ρ_m = (‖T_{m−2}‖/‖T_m‖)^½, m = 3 … N. At the amplitude ρ_m order m is as large as order m − 2.
    #[getter]
    fn radii(&self) -> Vec<f64> {
        self.0.radii()
    }

    /// The sizes (m + 2) ‖T_m‖ a^(m+1) of the orders of the transformation at an amplitude.
    ///
    /// Parameters
    /// ----------
    /// amplitude : float
    ///     a = √(2|I|) ≥ 0 of all modes.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An amplitude that is negative or not finite.
    fn sizes(&self, amplitude: f64) -> PyResult<Vec<f64>> {
        self.0.sizes(amplitude).map_err(error::algebra)
    }

    /// The order whose size is least at an amplitude.
    ///
    /// Parameters
    /// ----------
    /// amplitude : float
    ///     a = √(2|I|) ≥ 0 of all modes.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An amplitude that is negative or not finite.
    fn best_order(&self, amplitude: f64) -> PyResult<usize> {
        self.0.best_order(amplitude).map_err(error::algebra)
    }

    fn __repr__(&self) -> String {
        format!("<Domain of order {}>", self.0.norms().len())
    }

    /// A table of orders, norms and radii.
    fn __str__(&self) -> String {
        self.0.to_string()
    }
}
