//! `andoyer.Torque`.

use std::collections::HashMap;
use std::sync::Arc;

use andoyer_propagate::torques::{DistanceLaw, EnergyLoss, SourcePath, Torque as Inner, TorqueSource};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::array::{fixed, is_matrix, matrix, number};
use crate::dissipation::Dissipation;
use crate::error::{self, InternalError};
use crate::field::{Field, FieldPath};
use crate::material::value;
use crate::orbit::Orbit;
use crate::scene::arguments::kind;
use crate::tabulated::TabulatedOrbit;
use crate::values::immutable;

/// The longest torque that is printed as code \[characters\].
const MOST_WRITTEN: usize = 1000;

/// A torque beside the gravity gradient, in body axes. It is made by one of the class methods below. A scene with torques is integrated: it needs a span.
///
/// Torques are in moment × rate²; a Quantity is converted to SI units, with rates in rad/s. `Motion.angular_momentum` and `Motion.andoyer` include the angular momentum of rotors.
///
/// Examples
/// --------
/// >>> body = Body([1, 1.5, 2])
/// >>> scene = Scene(body, [0, 0, 0, 1], [0, 0.1, 1], span=(0, 100), tolerance=1e-9, torques=[Torque.damping(0.01), Torque.rotor([0, 0, 0.5])])
/// >>> motion = scene.solve()
/// >>> motion.plan.method, bool(motion.angular_velocity(100)[2] < 0.7)
/// ('integrated', True)
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Torque(pub(crate) Inner);

immutable!(Torque);

#[pymethods]
impl Torque {
    /// A constant torque.
    ///
    /// Parameters
    /// ----------
    /// torque : array_like, shape (3,)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value that is not finite; an array of another shape.
    #[classmethod]
    fn constant(_class: &Bound<'_, PyType>, torque: &Bound<'_, PyAny>) -> PyResult<Self> {
        made(Inner::constant(fixed("torque", torque)?))
    }

    /// The torque −Dω, with the angular velocity relative to inertial space.
    ///
    /// It takes angular momentum from the body. Internal friction does not: see `Dissipation`.
    ///
    /// Parameters
    /// ----------
    /// damping : float, or array_like of shape (3,) or (3, 3)
    ///     D, in moment × rate: a number times the unit matrix, the diagonal, or the matrix, which need not be symmetric.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value that is not finite; an array of another shape.
    #[classmethod]
    fn damping(_class: &Bound<'_, PyType>, damping: &Bound<'_, PyAny>) -> PyResult<Self> {
        let diagonal = |d: [f64; 3]| std::array::from_fn(|i| std::array::from_fn(|k| if i == k { d[i] } else { 0.0 }));
        made(Inner::damping(if is_matrix("damping", damping) {
            matrix("damping", damping)?
        } else if damping.len().is_ok() {
            diagonal(fixed("damping", damping)?)
        } else {
            diagonal([number("damping", damping)?; 3])
        }))
    }

    /// Rotors with a constant angular momentum relative to the body: a gyrostat. The torque is −ω × h.
    ///
    /// Parameters
    /// ----------
    /// momentum : array_like, shape (3,)
    ///     h, in moment × rate.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value that is not finite; an array of another shape.
    #[classmethod]
    fn rotor(_class: &Bound<'_, PyType>, momentum: &Bound<'_, PyAny>) -> PyResult<Self> {
        made(Inner::rotor(fixed("momentum", momentum)?))
    }

    /// Internal friction, which takes energy at constant angular momentum: a term of `Scene.evolve` and `Scene.drift` alone. A scene with it is not solved.
    ///
    /// Parameters
    /// ----------
    /// loss : Dissipation or callable
    ///     A callable takes the excess of energy ξ (`Evolution`) and returns the power that is lost, in moment × rate³: at least 0, and 0 for ξ = 0.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     Neither of both.
    ///
    /// Examples
    /// --------
    /// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], torques=[Torque.dissipation(lambda excess: 1e-9 * excess)])
    /// >>> evolution = scene.evolve((0, 1e9))
    /// >>> bool(evolution.at(1e9).excess < evolution.at(0).excess)
    /// True
    #[classmethod]
    fn dissipation(_class: &Bound<'_, PyType>, loss: &Bound<'_, PyAny>) -> PyResult<Self> {
        let origin = Arc::new(loss.clone().unbind());
        let made = if let Ok(dissipation) = loss.cast::<Dissipation>() {
            EnergyLoss::from(dissipation.get().inner.clone())
        } else if loss.is_callable() {
            let called = Arc::clone(&origin);
            EnergyLoss::of_excess(move |excess| Ok(value(&called, excess)))
        } else {
            let said = format!("loss must be a Dissipation or a callable of the excess of energy, not {}", kind(loss));
            return Err(PyTypeError::new_err(said));
        };
        Ok(Self(Inner::Dissipation(made.with_origin(origin))))
    }

    /// Three polynomials in directions and rates, times powers of distances.
    ///
    /// Parameters
    /// ----------
    /// texts : sequence of three str
    ///     Polynomials of degree 8 or less, of at most eight variables each: ``name1``, ``name2``, ``name3`` are the body components of the unit vector to the source
    ///     ``name``, and ``w1``, ``w2``, ``w3`` those of the angular velocity.
    /// sources : dict of str to Orbit, TabulatedOrbit, Field or array_like of shape (3,), optional
    ///     The sources by their names; an array is a fixed inertial direction. The vector of an orbit goes from the body to the source. With the elements of the body
    ///     about the source (a satellite's own elements) it is the opposite one: change the sign of terms of odd degree in it.
    /// distance_powers : dict of str to float, optional
    ///     The torque is multiplied by (r0/r)^p for each source with a power p.
    /// reference_distances : dict of str to float, optional
    ///     r0. For an `Orbit` without `semi_major_axis` it is in semi-major axes, by default 1. Any other source with a power needs it, in its unit of length.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A text that is no polynomial in these variables, a degree above 8, a name that is not made of letters and digits, a power for a direction,
    ///     a power without a reference distance for an `Orbit` with `semi_major_axis` or a `TabulatedOrbit`.
    /// TypeError
    ///     Texts that are not three; a power or a distance for a name that is no source.
    ///
    /// Examples
    /// --------
    /// A dipole along body axis 1 in the field of a dipole far away, which falls with the third power of the distance:
    ///
    /// >>> planet = Orbit(1e-3, 0.1)
    /// >>> Torque.polynomial(["0", "-2e-3*b3", "2e-3*b2"], sources={"b": planet}, distance_powers={"b": 3}).kind
    /// 'polynomial'
    #[classmethod]
    #[pyo3(signature = (texts, *, sources=None, distance_powers=None, reference_distances=None))]
    fn polynomial(
        class: &Bound<'_, PyType>,
        texts: &Bound<'_, PyAny>,
        sources: Option<Bound<'_, PyDict>>,
        distance_powers: Option<Bound<'_, PyDict>>,
        reference_distances: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let py = class.py();
        let [sources, powers, distances] =
            [sources, distance_powers, reference_distances].map(|given| given.unwrap_or_else(|| PyDict::new(py)));
        Self::_polynomial(class, texts, &sources, &powers, &distances, 0.0, HashMap::new())
    }

    #[classmethod]
    #[pyo3(signature = (texts, sources, distance_powers, reference_distances, truncation=0.0, laws=HashMap::new()))]
    fn _polynomial(
        _class: &Bound<'_, PyType>,
        texts: &Bound<'_, PyAny>,
        sources: &Bound<'_, PyDict>,
        distance_powers: &Bound<'_, PyDict>,
        reference_distances: &Bound<'_, PyDict>,
        truncation: f64,
        mut laws: HashMap<String, (Vec<f64>, [f64; 2])>,
    ) -> PyResult<Self> {
        let three = || PyTypeError::new_err("texts must be three texts, one for each body axis");
        let texts: Vec<String> = texts.extract().map_err(|_| three())?;
        let [first, second, third] = &texts[..] else { return Err(three()) };
        for (argument, given) in [("distance_powers", distance_powers), ("reference_distances", reference_distances)] {
            for name in given.keys() {
                if !sources.contains(&name)? {
                    let said = format!("{argument} has {}, which is no source", name.repr()?);
                    return Err(PyTypeError::new_err(said));
                }
            }
        }
        let mut source = |(name, path): (Bound<'_, PyAny>, Bound<'_, PyAny>)| -> PyResult<TorqueSource> {
            let value = |given: &Bound<'_, PyDict>, argument: &str| {
                given.get_item(&name)?.map(|value| number(argument, &value)).transpose()
            };
            let power = value(distance_powers, "distance_powers")?.unwrap_or(0.0);
            let distance = value(reference_distances, "reference_distances")?;
            let name: String = name.extract()?;
            let source = TorqueSource::new(&name, source_path(&path)?).falling(power, distance);
            let Some((coefficients, between)) = laws.remove(&name) else { return Ok(source) };
            let law = DistanceLaw::new(coefficients, between).map_err(error::propagation)?;
            Ok(source.following(Arc::new(law)))
        };
        let sources = sources.iter().map(&mut source).collect::<PyResult<Vec<_>>>()?;
        let torque = Inner::polynomial([first, second, third], sources);
        made(torque.and_then(|torque| torque.truncated(truncation)))
    }

    /// The kind: "constant", "damping", "rotor", "polynomial" or "dissipation".
    #[getter]
    fn kind(&self) -> &'static str {
        self.0.kind()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (written, law) = (self.written(py)?, self.laws().next().is_some());
        if !law && written.chars().count() <= MOST_WRITTEN {
            return Ok(written);
        }
        let left_out =
            if self.0.truncation() > 0.0 { format!(", truncation {:.2e}", self.0.truncation()) } else { String::new() };
        let law = if law { ", a law of the distance" } else { "" };
        Ok(format!("<Torque, polynomials of degree {}{law}{left_out}>", self.0.degree()))
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        PyTuple::new(py, [self.kind().to_owned(), self.written(py)?])?.hash()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (method, arguments) = slf.get().parts(slf.py())?;
        Ok((slf.get_type().getattr(method)?, arguments))
    }
}

impl Torque {
    /// The laws of the distances to sources, by their names.
    fn laws(&self) -> impl Iterator<Item = (String, &DistanceLaw)> {
        let sources = if let Inner::Polynomial(torque) = &self.0 { torque.sources() } else { &[] };
        sources.iter().filter_map(|source| Some((source.name().to_owned(), &**source.law()?)))
    }

    /// As Python code, without the truncation and laws of distances.
    fn written(&self, py: Python<'_>) -> PyResult<String> {
        let Inner::Polynomial(torque) = &self.0 else {
            let (method, arguments) = self.parts(py)?;
            return Ok(format!("Torque.{method}({})", arguments.get_item(0)?.repr()?));
        };
        let mut keywords = String::new();
        let [_, sources, powers, distances] = self.of_polynomial(py)?;
        for (key, given) in [("sources", sources), ("distance_powers", powers), ("reference_distances", distances)] {
            if given.len()? > 0 {
                keywords += &format!(", {key}={}", given.repr()?);
            }
        }
        Ok(format!("Torque.polynomial({:?}{keywords})", torque.texts()))
    }

    /// The class method that makes this torque, and its arguments.
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<(&'static str, Bound<'py, PyTuple>)> {
        Ok(match &self.0 {
            Inner::Constant(torque) => ("constant", PyTuple::new(py, [torque.to_vec()])?),
            Inner::Rotor(momentum) => ("rotor", PyTuple::new(py, [momentum.to_vec()])?),
            Inner::Damping(rows) => ("damping", PyTuple::new(py, [rows.map(|row| row.to_vec()).to_vec()])?),
            Inner::Polynomial(torque) => {
                let [texts, sources, powers, distances] = self.of_polynomial(py)?;
                let laws = self.laws().map(|(name, law)| (name, (law.coefficients().to_vec(), law.between())));
                let laws: HashMap<_, _> = laws.collect();
                ("_polynomial", (texts, sources, powers, distances, torque.truncation(), laws).into_pyobject(py)?)
            }
            Inner::Dissipation(loss) => {
                let origin = loss.origin().and_then(|origin| origin.downcast_ref::<Py<PyAny>>());
                ("dissipation", PyTuple::new(py, [origin.map(|origin| origin.clone_ref(py))])?)
            }
            _ => return Err(InternalError::new_err("a fault of this package, please report it: an unknown torque")),
        })
    }

    /// Texts, sources, powers and distances of a polynomial.
    fn of_polynomial<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyAny>; 4]> {
        let [sources, powers, distances] = [(); 3].map(|()| PyDict::new(py));
        let Inner::Polynomial(torque) = &self.0 else {
            return Ok([PyTuple::empty(py).into_any(), sources.into_any(), powers.into_any(), distances.into_any()]);
        };
        for source in torque.sources() {
            let (name, (power, distance)) = (source.name(), source.distance_power());
            match source.path() {
                SourcePath::Orbit(orbit) => sources.set_item(name, Bound::new(py, Orbit(*orbit))?)?,
                SourcePath::Tabulated(table) => {
                    sources.set_item(name, Bound::new(py, TabulatedOrbit(table.clone()))?)?
                }
                SourcePath::Field(field) => {
                    sources.set_item(name, Bound::new(py, Field(FieldPath::Dipole(field.clone())))?)?
                }
                SourcePath::Direction(vector) => sources.set_item(name, vector.to_vec())?,
                _ => {
                    return Err(InternalError::new_err("a fault of this package, please report it: an unknown source"));
                }
            }
            if power != 0.0 {
                powers.set_item(name, power)?;
                distances.set_item(name, distance)?;
            }
        }
        let texts = PyTuple::new(py, torque.texts())?;
        Ok([texts.into_any(), sources.into_any(), powers.into_any(), distances.into_any()])
    }
}

fn made(torque: Result<Inner, andoyer_propagate::Error>) -> PyResult<Torque> {
    torque.map(Torque).map_err(error::propagation)
}

pub(crate) fn source_path(value: &Bound<'_, PyAny>) -> PyResult<SourcePath> {
    if let Ok(orbit) = value.cast::<Orbit>() {
        return Ok(SourcePath::Orbit(orbit.get().0));
    }
    if let Ok(table) = value.cast::<TabulatedOrbit>() {
        return Ok(SourcePath::Tabulated(table.get().0.clone()));
    }
    if let Ok(field) = value.cast::<Field>() {
        return Ok(field.get().0.source());
    }
    Ok(SourcePath::Direction(fixed("sources", value)?))
}

/// One torque, or a sequence of them.
pub(crate) fn torques(value: &Bound<'_, PyAny>) -> PyResult<Vec<Inner>> {
    let one = |value: &Bound<'_, PyAny>| -> Option<Inner> {
        value.cast::<Torque>().ok().map(|torque| torque.get().0.clone())
    };
    let refused = |value: &Bound<'_, PyAny>| {
        let said = format!("torques must be an andoyer.Torque or a sequence of them: got {}", kind(value));
        PyTypeError::new_err(said)
    };
    if let Some(torque) = one(value) {
        return Ok(vec![torque]);
    }
    let members = value.try_iter().map_err(|_| refused(value))?;
    members.map(|member| member.and_then(|member| one(&member).ok_or_else(|| refused(&member)))).collect()
}

/// Torques as Python has them.
pub(crate) fn tuple<'py>(py: Python<'py>, torques: &[Inner]) -> PyResult<Bound<'py, PyTuple>> {
    let torques = torques.iter().map(|torque| Bound::new(py, Torque(torque.clone())));
    PyTuple::new(py, torques.collect::<PyResult<Vec<_>>>()?)
}
