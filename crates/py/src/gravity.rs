//! `andoyer.Gravity`.

use std::ffi::CString;

use andoyer_propagate::torques;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::array::number;
use crate::error;
use crate::values::immutable;

/// The gravity field of a rotating body of degree 3 and 4, for `Body(..., gravity=...)`. Disturbing bodies exert torques on it beside the gravity gradient; a scene with them is integrated.
///
/// The potential is G M/r Σ (R/r)^n (C_nm cos mλ + S_nm sin mλ) P_nm(sin φ), with unnormalized coefficients about body axes 1, 2, 3. Tables of fully normalized ones are multiplied by √((2 − δ_0m)(2n + 1)(n − m)!/(n + m)!).
///
/// Parameters
/// ----------
/// coefficients : dict of str to float
///     "C30", "C31", "S31", … "S44"; those that are missing are 0. Those of degree 2, "C20", "C21", "S21", "C22", "S22", are compared with the moments of the body: a warning names both.
/// radius : float
///     R, the reference radius, in the unit of `semi_major_axis` of the orbits or of the table.
/// inertia_factor : float, optional
///     C/(M R²) with the largest moment C. By default C20 and the moments give it.
///
/// Raises
/// ------
/// InputError
///     An unknown name, a coefficient that is not finite, a radius or an inertia factor that is not positive and finite.
///
/// Examples
/// --------
/// >>> field = Gravity({"C30": -8.5e-6, "C31": 3.05e-5, "S31": 4.1e-6}, 1738.0, inertia_factor=0.393)
/// >>> moon = Body([0.99937, 0.9996, 1.0], gravity=field)
/// >>> moon.gravity.coefficients["C31"]
/// 3.05e-05
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Gravity(pub(crate) torques::Gravity);

immutable!(Gravity);

#[pymethods]
impl Gravity {
    #[new]
    #[pyo3(signature = (coefficients, radius, *, inertia_factor=None))]
    fn new(
        coefficients: &Bound<'_, PyDict>,
        radius: &Bound<'_, PyAny>,
        inertia_factor: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let mut given: Vec<(String, f64)> = Vec::new();
        for (name, value) in coefficients {
            given.push((name.extract()?, number("coefficients", &value)?));
        }
        let named: Vec<(&str, f64)> = given.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let mut field = torques::Gravity::new(&named, number("radius", radius)?).map_err(error::propagation)?;
        if let Some(factor) = inertia_factor {
            field = field.inertia_factor(number("inertia_factor", factor)?).map_err(error::propagation)?;
        }
        Ok(Self(field))
    }

    /// The field of a body by its name.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     "moon": the coefficients of JPL's ephemeris DE421 about the principal axes, with a radius of 1738 km. C20 and the moments give the inertia factor. "eros": the solution NEAR15A (Miller et al. 2002) about
    ///     the axes of the prime meridian, with a radius of 16 km; these are not principal, so the body needs a tensor.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     Another name.
    ///
    /// Examples
    /// --------
    /// >>> Gravity.named("moon").coefficients["C31"]
    /// 2.8452435e-05
    #[classmethod]
    fn named(_class: &Bound<'_, PyType>, name: &str) -> PyResult<Self> {
        torques::Gravity::named(name).map(Self).map_err(error::propagation)
    }

    /// The field of degree 4 of a homogeneous ellipsoid with semi-axes a, b, c along body axes 1, 2, 3 (G. Balmino 1994). That of degree 3 is 0.
    ///
    /// Parameters
    /// ----------
    /// a, b, c : float
    ///     Positive lengths, in the unit of `radius`.
    /// radius : float, optional
    ///     The reference radius; by default (abc)^(1/3).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A length that is not positive and finite.
    ///
    /// Examples
    /// --------
    /// >>> body = Body.ellipsoid(3, 2, 1)
    /// >>> lumpy = Body(body.moments, gravity=Gravity.ellipsoid(3, 2, 1))
    #[classmethod]
    #[pyo3(signature = (a, b, c, *, radius=None))]
    fn ellipsoid(_class: &Bound<'_, PyType>, a: f64, b: f64, c: f64, radius: Option<f64>) -> PyResult<Self> {
        let radius = radius.unwrap_or_else(|| (a * b * c).cbrt());
        torques::Gravity::ellipsoid([a, b, c], radius).map(Self).map_err(error::propagation)
    }

    /// The coefficients by their names, as they were given.
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        for (name, value) in self.0.coefficients() {
            named.set_item(name, value)?;
        }
        Ok(named)
    }

    /// The reference radius.
    #[getter]
    fn radius(&self) -> f64 {
        self.0.radius()
    }

    /// C/(M R²) as it was given, or None.
    #[getter]
    fn inertia_factor(&self) -> Option<f64> {
        self.0.asked_inertia_factor()
    }

    pub(crate) fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let factor =
            self.0.asked_inertia_factor().map_or_else(String::new, |factor| format!(", inertia_factor={factor:?}"));
        Ok(format!("Gravity({}, {:?}{factor})", self.coefficients(py)?.repr()?, self.0.radius()))
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        self.__repr__(py)?.into_pyobject(py)?.hash()
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let named = PyDict::new(py);
        named.set_item("inertia_factor", self.inertia_factor())?;
        Ok(((self.coefficients(py)?, self.radius()).into_pyobject(py)?, named))
    }
}

/// A body with a gravity field; a warning for coefficients of degree 2 that are not those of its moments.
pub(crate) fn with_gravity(
    py: Python<'_>,
    body: andoyer_propagate::Body,
    gravity: Option<&Gravity>,
) -> PyResult<andoyer_propagate::Body> {
    let Some(gravity) = gravity else { return Ok(body) };
    let body = body.with_gravity(gravity.0.clone()).map_err(error::propagation)?;
    for (name, given, of_moments) in body.gravity_differences() {
        let said =
            format!("gravity: {name} = {given:.5e}, but the moments and the inertia factor give {of_moments:.5e}");
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(said)?, 1)?;
    }
    Ok(body)
}
