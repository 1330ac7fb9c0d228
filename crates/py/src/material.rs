//! `andoyer.Material`.

use std::cell::Cell;
use std::sync::Arc;

use andoyer_propagate::dissipation::{Loss, Material as Inner};
use andoyer_propagate::{Error, dissipation::LossFunction};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyTuple};

use crate::array::number;
use crate::computing::detached;
use crate::error;
use crate::values::immutable;

/// A homogeneous, slightly inelastic material, for `Dissipation`.
///
/// Units are consistent with the lengths of the body and the time of its scenes: kg/m³, Pa, Pa s with metres and seconds. A Quantity is converted to SI units. At most one of
/// `quality`, `viscosity` and `loss` is given. Without one the material serves `Dissipation.quality_from_age`, `viscosity_from_age` and `inertia_response`.
///
/// Parameters
/// ----------
/// density : float
///     ϱ, in mass/length³.
/// rigidity : float
///     S, the shear modulus, in mass/(length time²). Papers write μ.
/// poisson : float, optional
///     Poisson's ratio ν, from 0 to 0.5 (incompressible).
/// quality : float, optional
///     The quality factor Q, the same at each frequency. A cycle loses 2π/Q of the **peak** energy of a standing oscillation, which is twice its mean energy: an author who
///     divides by the mean energy has a Q twice as large for the same loss, or twice our times for the same Q.
/// viscosity : float, optional
///     The viscosity η of a Maxwell body, in mass/(length time): χ = S/(ηf). It needs frequencies f with fη far above the stiffness of self-gravity, 2ϱgR/19 for a sphere.
/// loss : callable, optional
///     χ(f) = −Im S/S*(f), which is 1/Q for a quality factor, as a function of the angular frequency f [rad/time]: a positive float. A smooth function is integrated to
///     1e-12; a jump costs digits.
/// shear_only : bool, optional
///     If True, compression has no loss. By default it has that of shear.
///
/// Raises
/// ------
/// InputError
///     A density, rigidity, quality factor or viscosity that is not positive and finite; a Poisson's ratio outside 0 to 0.5; two of `quality`, `viscosity` and `loss`.
/// TypeError
///     A loss that cannot be called.
///
/// Examples
/// --------
/// >>> Material(density=2000.0, rigidity=5e9, quality=100.0)
/// Material(density=2000.0, rigidity=5000000000.0, poisson=0.25, quality=100.0)
/// >>> kelvin_voigt = Material(density=2000.0, rigidity=5e9, loss=lambda f: 10 * f / (1 + (10 * f) ** 2))
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Material {
    pub(crate) inner: Inner,
    loss: Option<Arc<Py<PyAny>>>,
}

immutable!(Material);

thread_local! {
    /// The exception of a loss function in the computation of this thread.
    static FAILURE: Cell<Option<PyErr>> = const { Cell::new(None) };
}

/// An error of a computation, or the exception of a function of Python in it.
pub(crate) enum Failed {
    Computation(Error),
    Function(PyErr),
}

/// Computes in this thread, where functions of Python are called.
pub(crate) fn calling<T>(compute: impl FnOnce() -> Result<T, Error>) -> Result<T, Failed> {
    FAILURE.take();
    compute().map_err(|error| FAILURE.take().map_or(Failed::Computation(error), Failed::Function))
}

/// The exception of a computation that failed.
pub(crate) fn exception(failed: Failed) -> PyErr {
    match failed {
        Failed::Computation(error) => error::propagation(error),
        Failed::Function(exception) => exception,
    }
}

/// The value of a function of Python; NaN if it fails.
pub(crate) fn value(function: &Py<PyAny>, argument: f64) -> f64 {
    let called = Python::attach(|py| {
        let value = function.bind(py).call1((argument,))?;
        // A relaxation calls the function some 5e4 times, and `number` takes longer than many functions.
        if value.is_exact_instance_of::<PyFloat>() { value.extract() } else { number("loss", &value) }
    });
    called.unwrap_or_else(|problem| {
        FAILURE.set(Some(problem));
        f64::NAN
    })
}

impl Material {
    /// Computes without the interpreter lock. An exception of the loss function is raised as it is.
    pub(crate) fn detached<T: Send>(
        &self,
        py: Python<'_>,
        compute: impl FnOnce() -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        detached(py, exception, || calling(compute))
    }
}

#[pymethods]
impl Material {
    #[new]
    #[pyo3(
        signature = (*, density, rigidity, poisson=None, quality=None, viscosity=None, loss=None, shear_only=false),
        text_signature = "(*, density, rigidity, poisson=0.25, quality=None, viscosity=None, loss=None, shear_only=False)"
    )]
    fn new(
        density: &Bound<'_, PyAny>,
        rigidity: &Bound<'_, PyAny>,
        poisson: Option<&Bound<'_, PyAny>>,
        quality: Option<&Bound<'_, PyAny>>,
        viscosity: Option<&Bound<'_, PyAny>>,
        loss: Option<&Bound<'_, PyAny>>,
        shear_only: bool,
    ) -> PyResult<Self> {
        let made = Inner::new(number("density", density)?, number("rigidity", rigidity)?);
        let mut inner = made.map_err(error::propagation)?.shear_only(shear_only);
        if let Some(poisson) = poisson {
            inner = inner.poisson(number("poisson", poisson)?).map_err(error::propagation)?;
        }
        let (given, called) = match (quality, viscosity, loss) {
            (None, None, None) => return Ok(Self { inner, loss: None }),
            (Some(quality), None, None) => (Loss::Quality(number("quality", quality)?), None),
            (None, Some(viscosity), None) => (Loss::Viscosity(number("viscosity", viscosity)?), None),
            (None, None, Some(loss)) => {
                if !loss.is_callable() {
                    return Err(PyTypeError::new_err(format!(
                        "loss must be a callable, not {}",
                        loss.get_type().name()?
                    )));
                }
                let called = Arc::new(loss.clone().unbind());
                let shared = Arc::clone(&called);
                let function: LossFunction = Arc::new(move |frequency| value(&shared, frequency));
                (Loss::Function(function), Some(called))
            }
            _ => {
                let (argument, bound) = ("quality, viscosity, loss", "at most one");
                let message = format!("{argument}: {bound} of them is given");
                return Err(error::input(argument, "several", bound, message));
            }
        };
        Ok(Self { inner: inner.loss(given).map_err(error::propagation)?, loss: called })
    }

    /// The density ϱ, in mass/length³.
    #[getter]
    fn density(&self) -> f64 {
        self.inner.density()
    }

    /// The rigidity S, in mass/(length time²).
    #[getter]
    fn rigidity(&self) -> f64 {
        self.inner.rigidity()
    }

    /// Poisson's ratio ν.
    #[getter]
    fn poisson(&self) -> f64 {
        self.inner.poisson_ratio()
    }

    /// The quality factor Q, or None.
    #[getter]
    fn quality(&self) -> Option<f64> {
        match self.inner.given_loss() {
            Some(Loss::Quality(value)) => Some(*value),
            _ => None,
        }
    }

    /// The viscosity η, in mass/(length time), or None.
    #[getter]
    fn viscosity(&self) -> Option<f64> {
        match self.inner.given_loss() {
            Some(Loss::Viscosity(value)) => Some(*value),
            _ => None,
        }
    }

    /// The loss function χ(f), or None.
    #[getter]
    fn loss(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.loss.as_ref().map(|function| function.clone_ref(py))
    }

    /// True if compression has no loss.
    #[getter]
    fn shear_only(&self) -> bool {
        self.inner.is_shear_only()
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let given = PyDict::new(py);
        given.set_item("density", self.density())?;
        given.set_item("rigidity", self.rigidity())?;
        given.set_item("poisson", self.poisson())?;
        given.set_item("quality", self.quality())?;
        given.set_item("viscosity", self.viscosity())?;
        given.set_item("loss", self.loss(py))?;
        given.set_item("shear_only", self.shear_only())?;
        Ok((PyTuple::empty(py), given))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let number = |value: f64| value.into_pyobject(py)?.repr().map(|text| text.to_string());
        let mut parts = Vec::new();
        let numbers = [
            ("density", Some(self.density())),
            ("rigidity", Some(self.rigidity())),
            ("poisson", Some(self.poisson())),
            ("quality", self.quality()),
            ("viscosity", self.viscosity()),
        ];
        for (name, value) in numbers {
            if let Some(value) = value {
                parts.push(format!("{name}={}", number(value)?));
            }
        }
        if let Some(loss) = self.loss(py) {
            parts.push(format!("loss={}", loss.bind(py).repr()?));
        }
        if self.shear_only() {
            parts.push("shear_only=True".to_owned());
        }
        Ok(format!("Material({})", parts.join(", ")))
    }
}
