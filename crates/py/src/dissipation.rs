//! `andoyer.Dissipation`.

use andoyer_propagate::dissipation::{self, Size};
use numpy::PyArrayDyn;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::array::{self, fixed, number};
use crate::body::Body;
use crate::error;
use crate::material::Material;
use crate::motion::Motion;
use crate::relaxation::{Relaxation, mode_of};
use crate::scene_class::Scene;
use crate::values::immutable;

/// The inner dissipation of a homogeneous ellipsoid that rotates freely: it loses energy at constant angular momentum, and ends in rotation about its short axis.
///
/// The loss is averaged over the polhode (docs/relaxation.md). It holds for small deformations (see `compliance`) and a constant angular momentum. The moments of the body count up
/// to a factor; density and size give those of the ellipsoid. Scenes have the unit of time of the material.
///
/// Parameters
/// ----------
/// body : Body
///     Not a sphere.
/// radius : float, or array_like of shape (3,)
///     The radius of the sphere of the same volume, (R1 R2 R3)^(1/3); three numbers are the semi-axes.
/// material : Material
/// semi_axes : array_like, shape (3,), optional
///     Instead of `radius`: the semi-axes along body axes 1, 2, 3, which the moments of the body must have. For a body from a tensor they are along its principal axes.
///
/// Raises
/// ------
/// InputError
///     A radius or a semi-axis that is not positive and finite; semi-axes whose ratios are not those of the homogeneous ellipsoid with the moments, to 1e-6; a sphere; a body
///     flatter than 1 : 1000.
/// TypeError
///     A body that is not a `Body`, a material that is not a `Material`; no size, or two.
///
/// Examples
/// --------
/// From a state to its relaxation time:
///
/// >>> body = Body.ellipsoid(100, 60, 50)
/// >>> rock = Material(density=2000.0, rigidity=5e9, quality=100.0)      # kg/m³, Pa
/// >>> scene = Scene(body, [0, 0, 0, 1], [2e-5, 1e-4, 2e-4])             # rad/s
/// >>> relaxation = Dissipation(body, 67, rock).relax(scene)
/// >>> relaxation.time_to(0.1) > 1e8 * 3.156e7                           # 1e8 years
/// True
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Dissipation {
    pub(crate) inner: dissipation::Dissipation,
    body: Py<Body>,
    pub(crate) material: Py<Material>,
    /// Whether the size was given by semi-axes.
    by_axes: bool,
}

immutable!(Dissipation);

/// The scene of a `Scene` or a `Motion`.
fn scene_of(given: &Bound<'_, PyAny>) -> PyResult<andoyer_propagate::Scene> {
    if let Ok(scene) = given.cast::<Scene>() {
        return Ok(scene.get().scene.clone());
    }
    match given.cast::<Motion>() {
        Ok(motion) => Ok(motion.get().0.scene().clone()),
        Err(_) => {
            Err(PyTypeError::new_err(format!("scene must be a Scene or a Motion, not {}", given.get_type().name()?)))
        }
    }
}

fn size(radius: Option<&Bound<'_, PyAny>>, semi_axes: Option<&Bound<'_, PyAny>>) -> PyResult<Size> {
    match (radius, semi_axes) {
        (None, Some(axes)) => Ok(Size::SemiAxes(fixed("semi_axes", axes)?)),
        (Some(axes), None) if axes.len().is_ok() => Ok(Size::SemiAxes(fixed("radius", axes)?)),
        (Some(radius), None) => Ok(Size::Radius(number("radius", radius)?)),
        _ => Err(PyTypeError::new_err("one of radius and semi_axes must be given")),
    }
}

#[pymethods]
impl Dissipation {
    #[new]
    #[pyo3(signature = (body, radius=None, material=None, *, semi_axes=None))]
    fn new(
        body: &Bound<'_, PyAny>,
        radius: Option<&Bound<'_, PyAny>>,
        material: Option<&Bound<'_, PyAny>>,
        semi_axes: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let wrong = |argument: &str, class: &str| PyTypeError::new_err(format!("{argument} must be a {class}"));
        let body = body.cast::<Body>().map_err(|_| wrong("body", "Body"))?;
        let material = material.and_then(|material| material.cast::<Material>().ok());
        let material = material.ok_or_else(|| wrong("material", "Material"))?;
        let size = size(radius, semi_axes)?;
        let made = dissipation::Dissipation::new(&body.get().body, size, material.get().inner.clone());
        Ok(Self {
            inner: made.map_err(error::propagation)?,
            body: body.clone().unbind(),
            material: material.clone().unbind(),
            by_axes: matches!(size, Size::SemiAxes(_)),
        })
    }

    /// The body.
    #[getter]
    fn body(&self, py: Python<'_>) -> Py<Body> {
        self.body.clone_ref(py)
    }

    /// The material.
    #[getter]
    fn material(&self, py: Python<'_>) -> Py<Material> {
        self.material.clone_ref(py)
    }

    /// The radius of the sphere of the same volume, (R1 R2 R3)^(1/3).
    #[getter]
    fn radius(&self) -> f64 {
        self.inner.radius()
    }

    /// The semi-axes along body axes 1, 2, 3: a read-only array, shape (3,).
    #[getter]
    fn semi_axes<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<f64>> {
        array::constant(py, &self.inner.semi_axes())
    }

    /// The moments of the homogeneous ellipsoid about body axes 1, 2, 3, in density × length⁵: a read-only array, shape (3,).
    #[getter]
    fn moments<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<f64>> {
        array::constant(py, &self.inner.moments())
    }

    /// The change of the inertia tensor in elastic equilibrium, by products of rates: a read-only array, shape (6, 6).
    ///
    /// Rows are δI11, δI22, δI33, δI23, δI31, δI12, in density × length⁵; columns are ω1², ω2², ω3², ω2ω3, ω3ω1, ω1ω2. The strain energy is ¼ Σ δI_ij ω_i ω_j.
    #[getter]
    fn inertia_response<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let response = self.inner.inertia_response();
        let rows: [[f64; 6]; 6] = std::array::from_fn(|row| std::array::from_fn(|column| response[(row, column)]));
        array::constant_rows(py, &rows)
    }

    /// ϱ (M/C)² R1²/S, with the longest semi-axis R1: the relative error of the power by theory of first order in the deformation is of this size.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///
    /// Returns
    /// -------
    /// float
    fn compliance(&self, scene: &Bound<'_, PyAny>) -> PyResult<f64> {
        self.inner.compliance(&scene_of(scene)?).map_err(error::propagation)
    }

    /// The loss of energy in the unit of time, averaged over the polhode of the state. It is 0 at rest, in rotation about a principal axis, and on the separatrix.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///     Its state at the epoch counts; its orbits and torques do not.
    ///
    /// Returns
    /// -------
    /// float
    ///     In mass × length²/time³: W with kg, m and s.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A scene of another body; a material without a loss; a loss function with a value that is not positive and finite.
    /// TypeError
    ///     Neither a `Scene` nor a `Motion`.
    ///
    /// Examples
    /// --------
    /// >>> body = Body.ellipsoid(1.0, 0.7, 0.5)
    /// >>> dissipation = Dissipation(body, (1.0, 0.7, 0.5), Material(density=1.0, rigidity=1.0, quality=1.0))
    /// >>> x, (A, B, C) = 0.3, body.moments                              # M/C = 1, sin² of the largest angle 0.3
    /// >>> round(dissipation.power(Scene(body, [0, 0, 0, 1], [0, C / B * x**0.5, (1 - x) ** 0.5])), 12)
    /// 0.001731138418
    fn power(&self, py: Python<'_>, scene: &Bound<'_, PyAny>) -> PyResult<f64> {
        let scene = scene_of(scene)?;
        self.material.get().detached(py, || self.inner.power(&scene))
    }

    /// dx/dt of x = sin² θ, with θ the largest angle between the angular momentum and the axis of the mode: negative in the short-axis mode, positive in the long-axis mode.
    ///
    /// The rate of the angle is dθ/dt = (dx/dt)/sin 2θ; for a small wobble it is −θ/(2τ) with dx/dt = −x/τ.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///     As in `power`.
    ///
    /// Returns
    /// -------
    /// float
    ///     In 1/time.
    fn rate(&self, py: Python<'_>, scene: &Bound<'_, PyAny>) -> PyResult<f64> {
        let scene = scene_of(scene)?;
        self.material.get().detached(py, || self.inner.rate(&scene))
    }

    /// The harmonics of the load along the polhode, from the first, with their shares of the power, down to 1e-17 of the largest.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///     As in `power`.
    ///
    /// Returns
    /// -------
    /// list of LoadHarmonic
    fn harmonics(&self, py: Python<'_>, scene: &Bound<'_, PyAny>) -> PyResult<Vec<LoadHarmonic>> {
        let scene = scene_of(scene)?;
        let found = self.material.get().detached(py, || self.inner.harmonics(&scene))?;
        Ok(found.into_iter().map(LoadHarmonic).collect())
    }

    /// The relaxation of the free body of a scene: the angle and the energy at any time, before and after.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///     A body that tumbles, without orbits and torques.
    ///
    /// Returns
    /// -------
    /// Relaxation
    ///
    /// Raises
    /// ------
    /// InputError
    ///     As `power`; a scene with orbits or torques; a body at rest or in rotation about a principal axis.
    fn relax(slf: &Bound<'_, Self>, scene: &Bound<'_, PyAny>) -> PyResult<Relaxation> {
        let (own, inner) = (slf.get(), scene_of(scene)?);
        let found = own.material.get().detached(slf.py(), || own.inner.relax(&inner))?;
        let material = own.material.clone_ref(slf.py());
        Ok(Relaxation {
            inner: found,
            material,
            dissipation: slf.clone().into_any().unbind(),
            scene: scene.clone().unbind(),
        })
    }

    /// The age of the state of a scene: the time since the largest angle between the angular momentum and the axis of a mode was `start_angle`.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///     As in `relax`.
    /// start_angle : float
    ///     In rad, above 0 and at most π/2, which is the separatrix.
    /// mode : {"short-axis", "long-axis"}, optional
    ///     The mode of the start; by default that of the state. A body in the short-axis mode may have begun in the long-axis mode.
    ///
    /// Returns
    /// -------
    /// float
    ///     In units of time.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     As `relax`; a start that is not before the state: in the short-axis mode a smaller angle, in the long-axis mode a larger one.
    #[pyo3(signature = (scene, start_angle, mode=None))]
    fn age(
        &self,
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        start_angle: &Bound<'_, PyAny>,
        mode: Option<&str>,
    ) -> PyResult<f64> {
        let (scene, start, mode) =
            (scene_of(scene)?, number("start_angle", start_angle)?, mode.map(mode_of).transpose()?);
        self.material.get().detached(py, || self.inner.age(&scene, start, mode))
    }

    /// The quality factor with which the state of a scene has this age. Ages are proportional to the product of rigidity and quality factor.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///     As in `relax`.
    /// age : float
    ///     In units of time.
    /// start_angle : float
    ///     As in `age`.
    /// mode : {"short-axis", "long-axis"}, optional
    ///     As in `age`.
    ///
    /// Returns
    /// -------
    /// float
    ///     Q for the rigidity of the material; its loss is not used.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     As `age`; an age that is not positive and finite.
    #[pyo3(signature = (scene, age, start_angle, mode=None))]
    fn quality_from_age(
        &self,
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        age: &Bound<'_, PyAny>,
        start_angle: &Bound<'_, PyAny>,
        mode: Option<&str>,
    ) -> PyResult<f64> {
        let (scene, age, mode) = (scene_of(scene)?, number("age", age)?, mode.map(mode_of).transpose()?);
        let start = number("start_angle", start_angle)?;
        self.material.get().detached(py, || self.inner.quality_from_age(&scene, age, start, mode))
    }

    /// The viscosity of a Maxwell body with which the state of a scene has this age, in mass/(length time). Ages are proportional to it.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene or Motion
    ///     As in `relax`.
    /// age : float
    ///     In units of time.
    /// start_angle : float
    ///     As in `age`.
    /// mode : {"short-axis", "long-axis"}, optional
    ///     As in `age`.
    ///
    /// Returns
    /// -------
    /// float
    ///     η. The loss of the material is not used.
    #[pyo3(signature = (scene, age, start_angle, mode=None))]
    fn viscosity_from_age(
        &self,
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        age: &Bound<'_, PyAny>,
        start_angle: &Bound<'_, PyAny>,
        mode: Option<&str>,
    ) -> PyResult<f64> {
        let (scene, age, mode) = (scene_of(scene)?, number("age", age)?, mode.map(mode_of).transpose()?);
        let start = number("start_angle", start_angle)?;
        self.material.get().detached(py, || self.inner.viscosity_from_age(&scene, age, start, mode))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let (given, size) = (PyDict::new(py), (self.body.clone_ref(py), self.radius()));
        given.set_item("material", &self.material)?;
        if !self.by_axes {
            return Ok((size.into_pyobject(py)?, given));
        }
        given.set_item("semi_axes", self.semi_axes(py))?;
        Ok(((self.body.clone_ref(py),).into_pyobject(py)?, given))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [first, second, third] = self.inner.semi_axes();
        let material = self.material.bind(py).repr()?;
        Ok(format!("<Dissipation, semi-axes {first:.6}, {second:.6}, {third:.6}, {material}>"))
    }
}

/// A harmonic of the load along a polhode, from `Dissipation.harmonics`.
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct LoadHarmonic(dissipation::LoadHarmonic);

#[pymethods]
impl LoadHarmonic {
    /// m, the multiple of the rate dℓ′/dt of the polhode. Odd ones load shear with axis 3, even ones the other strains.
    #[getter]
    fn multiple(&self) -> u32 {
        self.0.multiple
    }

    /// m dℓ′/dt, in rad per unit of time.
    #[getter]
    fn frequency(&self) -> f64 {
        self.0.frequency
    }

    /// W_m, the sum over the components of the load of the peak strain energies. The mean energy is half of it.
    #[getter]
    fn energy(&self) -> f64 {
        self.0.energy
    }

    /// f χ(f) W_m at the frequency f, the loss of energy in the unit of time.
    #[getter]
    fn power(&self) -> f64 {
        self.0.power
    }

    fn __repr__(&self) -> String {
        let dissipation::LoadHarmonic { multiple, frequency, energy, power } = self.0;
        format!("<LoadHarmonic {multiple}: frequency {frequency:.6e}, energy {energy:.6e}, power {power:.6e}>")
    }
}
