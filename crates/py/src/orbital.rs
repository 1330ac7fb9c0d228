//! `Scene.from_orbital`, `Motion.orbital` and `andoyer.Orbital`.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::nalgebra::UnitQuaternion;
use andoyer_propagate::orbital::{EulerSequence, OrbitalFrame, OrbitalSample};
use andoyer_propagate::{Error, State};
use andoyer_series::error::Kind;
use numpy::{PyArray, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use crate::array::{self, Times, chunks, write};
use crate::body::Body;
use crate::computing::interruptible;
use crate::error;
use crate::foreign;
use crate::motion::Motion;
use crate::order::whole_number;
use crate::scene::arguments::{disturbing_bodies, epoch as given_epoch, not_a_body, with_options};
use crate::scene_class::Scene;

type Array = Py<PyArrayDyn<f64>>;
type Parts = (Py<PyAny>, Array, Array, Array);

#[pymethods]
impl Scene {
    /// The scene of a state that is given against the orbital frame. It is the inverse of `Motion.orbital`.
    ///
    /// Parameters
    /// ----------
    /// body : Body
    /// attitude : array_like, shape (4,) or (3,)
    ///     The quaternion that rotates body components into components of the orbital frame, or three angles [rad] of `sequence`: yaw, pitch, roll for "ZYX".
    /// angular_velocity : array_like, shape (3,)
    ///     In body components, in rad per unit of time: relative to the turning frame, or inertial with ``relative=False``.
    /// orbit : Orbit, TabulatedOrbit or sequence of them
    ///     The disturbing bodies.
    /// elements_of : {"rotating", "disturbing"}
    ///     Whose orbit it is: a satellite's own about its primary, or that of the disturbing body as seen from the rotating one. A wrong choice turns the frame by half a turn.
    /// frame : {"rtn", "lvlh"}, optional
    ///     "rtn": axis 1 radially outward from the primary, 2 transverse, 3 along the normal of the orbit's plane. "lvlh": axis 3 to the primary, 2 against the normal, 1
    ///     completes, forward.
    /// relative : bool, optional
    /// sequence : str, optional
    ///     Three of X, Y, Z: the intrinsic sequence of the angles.
    /// epoch : float, optional
    ///     Time of the state.
    /// of : int, optional
    ///     Which of several disturbing bodies has the frame, from 0.
    /// **options
    ///     The other keyword arguments of `Scene`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown `elements_of`, `frame` or `sequence`; an `of` without a body; an epoch outside the table of the body.
    ///
    /// Examples
    /// --------
    /// >>> satellite = Scene.from_orbital(Body([1.5, 2, 1]), [0, 0, 0], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", frame="lvlh")
    /// >>> satellite.angular_velocity
    /// array([ 0.   , -0.001,  0.   ])
    #[classmethod]
    #[pyo3(
        signature = (body, attitude, angular_velocity, *, orbit, elements_of, frame="rtn", relative=true, sequence="ZYX", epoch=None, of=None, **options),
        text_signature = "(body, attitude, angular_velocity, *, orbit, elements_of, frame='rtn', relative=True, sequence='ZYX', epoch=0.0, of=0, **options)"
    )]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn from_orbital<'py>(
        class: &Bound<'py, PyType>,
        body: &Bound<'py, PyAny>,
        attitude: &Bound<'py, PyAny>,
        angular_velocity: &Bound<'py, PyAny>,
        orbit: &Bound<'py, PyAny>,
        elements_of: &str,
        frame: &str,
        relative: bool,
        sequence: &str,
        epoch: Option<&Bound<'py, PyAny>>,
        of: Option<&Bound<'py, PyAny>>,
        options: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let of_body = body.cast::<Body>().map_err(|_| not_a_body(body))?.get().body.clone();
        let asked = Asked::new(elements_of, frame, sequence, of)?;
        let (time, _) = given_epoch(epoch)?;
        let keywords = options.unwrap_or_else(|| PyDict::new(class.py()));
        let scalar_first = keywords.get_item("scalar_first")?.is_some_and(|value| value.is_truthy().unwrap_or(false));
        if keywords.contains("scalar_first")? {
            keywords.del_item("scalar_first")?;
        }
        let rates = array::fixed("angular_velocity", angular_velocity)?;
        // A quaternion has no unit; three angles may have one.
        let argument = if foreign::holds_units(attitude)? { "angles" } else { "attitude" };
        let (attitude, scalar_first) = foreign::attitudes("attitude", attitude, scalar_first)?;
        let mut numbers = array::numbers_of(argument, &attitude)?;
        if let [_, _, _, _] = numbers[..]
            && scalar_first
        {
            numbers.rotate_left(1);
        }
        if !matches!(numbers.len(), 3 | 4) {
            return Err(error::shape("attitude", &[numbers.len()], "(4,) or (3,)"));
        }
        let turn = asked.turned(&numbers).map_err(error::propagation)?;
        if numbers.len() == 3 {
            error::warn_of_degrees(class.py(), error::each("attitude", &numbers))?;
        }
        State::new(time, [0.0, 0.0, 0.0, 1.0], rates).map_err(error::propagation)?;
        let bodies = disturbing_bodies(orbit)?;
        let scene =
            andoyer_propagate::Scene::from_orbital(of_body, bodies, &asked.frame, turn, rates.into(), relative, time);
        keywords.set_item("orbit", orbit)?;
        with_options(class, body, (&scene.map_err(error::propagation)?, epoch), Some(keywords))
    }
}

#[pymethods]
impl Motion {
    /// Attitudes and angular velocities against the orbital frame.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    /// elements_of, frame, sequence, of
    ///     As in `Scene.from_orbital`.
    ///
    /// Returns
    /// -------
    /// Orbital
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown `elements_of`, `frame` or `sequence`; an `of` without a body, or a scene without a disturbing body; a time outside the table of the body.
    ///
    /// Examples
    /// --------
    /// >>> scene = Scene.from_orbital(Body([1.5, 2, 1]), [0, 0.01, 0], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", frame="lvlh", span=(0, 6e3), method="integrated")
    /// >>> bool(abs(scene.solve().orbital([0, 6e3], elements_of="rotating", frame="lvlh").angles[:, 1]).max() < 0.0101)
    /// True
    #[pyo3(
        signature = (times, *, elements_of, frame="rtn", sequence="ZYX", of=None),
        text_signature = "($self, times, *, elements_of, frame='rtn', sequence='ZYX', of=0)"
    )]
    fn orbital<'py>(
        &self,
        py: Python<'py>,
        times: &Bound<'py, PyAny>,
        elements_of: &str,
        frame: &str,
        sequence: &str,
        of: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Orbital> {
        let asked = Asked::new(elements_of, frame, sequence, of)?;
        asked.orbital(py, &self.times(times)?, |since_epoch, values, out, stop| {
            out.fill(&asked, self.batch(since_epoch, stop).orbital(values, &asked.frame)?);
            Ok(())
        })
    }
}

/// The frame and the sequence of angles that are asked for.
pub(crate) struct Asked {
    pub(crate) frame: OrbitalFrame,
    pub(crate) sequence: EulerSequence,
}

/// Where samples are written, a row for each time.
pub(crate) struct Rows<'a> {
    pub(crate) attitude: &'a mut [[f64; 4]],
    pub(crate) angles: &'a mut [[f64; 3]],
    pub(crate) rates: &'a mut [[f64; 3]],
}

impl Rows<'_> {
    pub(crate) fn fill(self, asked: &Asked, samples: Vec<OrbitalSample>) {
        for (row, OrbitalSample { attitude: turn, angular_velocity }) in samples.into_iter().enumerate() {
            self.attitude[row] = turn.coords.into();
            self.angles[row] = asked.sequence.angles(&turn);
            self.rates[row] = angular_velocity.into();
        }
    }
}

impl Asked {
    pub(crate) fn new(elements_of: &str, frame: &str, sequence: &str, of: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let of = of.map_or(Ok(0), |of| whole_number("of", of, 0, usize::from(u16::MAX), Kind::Input))?;
        let elements_of = elements_of.parse().map_err(error::propagation)?;
        let frame = OrbitalFrame { elements_of, axes: frame.parse().map_err(error::propagation)?, of };
        Ok(Self { frame, sequence: sequence.parse().map_err(error::propagation)? })
    }

    /// The rotation from body components to those of the frame of a quaternion, or of three angles.
    pub(crate) fn turned(&self, numbers: &[f64]) -> Result<UnitQuaternion<f64>, Error> {
        match numbers {
            &[first, second, third] => {
                let angles = [first, second, third];
                match angles.iter().position(|angle| !angle.is_finite()) {
                    None => Ok(self.sequence.attitude(angles)),
                    Some(index) => {
                        let (argument, value, bound) = ("attitude", angles[index], "finite");
                        Err(Error::Number { argument, index: Some(index), value, bound })
                    }
                }
            }
            &[x, y, z, w] => Ok(State::new(0.0, [x, y, z, w], [0.0; 3])?.attitude),
            other => Err(Error::Length { argument: "attitude", found: other.len(), expected: 4 }),
        }
    }

    /// Arrays at times, which `evaluate` fills.
    pub(crate) fn orbital<'py>(
        &self,
        py: Python<'py>,
        times: &Times<'py>,
        evaluate: impl FnOnce(bool, &[f64], Rows<'_>, &AtomicBool) -> Result<(), Error> + Send,
    ) -> PyResult<Orbital> {
        let since_epoch = times.since_epoch();
        let [copy, attitude, rates] = times.samples()?;
        let angles = PyArray::zeros(py, rates.dims(), false);
        {
            let (mut attitude, mut angle, mut rate) = (write(&attitude)?, write(&angles)?, write(&rates)?);
            let (attitude, angles, rates) = (chunks(&mut attitude)?, chunks(&mut angle)?, chunks(&mut rate)?);
            let values = times.values()?;
            let into = |stop: &_| evaluate(since_epoch, values, Rows { attitude, angles, rates }, stop);
            interruptible(py, times.long(), error::propagation, into)?;
        }
        let given = times.given().unwrap_or_else(|| copy.into_any().unbind());
        Ok(Orbital {
            times: given,
            attitude: attitude.unbind(),
            angles: angles.unbind(),
            angular_velocity: rates.unbind(),
        })
    }
}

/// Attitudes and angular velocities against the orbital frame, from `Motion.orbital`, or of all members with a leading axis from `Ensemble.orbital`. For a scalar time there is no axis of times.
///
/// Examples
/// --------
/// >>> scene = Scene.from_orbital(Body([1.5, 2, 1]), [0, 0, 0], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", span=(0, 10), method="integrated")
/// >>> scene.solve().orbital([0.0, 10.0], elements_of="rotating")
/// <Orbital at 2 times>
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Orbital {
    /// The times, float64, shape (n,). Times of astropy are returned as given.
    #[pyo3(get)]
    times: Py<PyAny>,
    /// Unit quaternions [x, y, z, w] that rotate body components into components of the orbital frame, shape (n, 4).
    #[pyo3(get)]
    attitude: Array,
    /// Angles of the intrinsic sequence, in rad, shape (n, 3): yaw, pitch, roll for "ZYX". Where only the sum or the difference of the first and the third is determined, the third is 0.
    #[pyo3(get)]
    angles: Array,
    /// Angular velocities relative to the turning frame, in body components, in rad per unit of time, shape (n, 3).
    #[pyo3(get)]
    angular_velocity: Array,
}

#[pymethods]
impl Orbital {
    /// Rebuilds the samples for `pickle`.
    #[classmethod]
    fn _restored(
        _class: &Bound<'_, PyType>,
        times: Py<PyAny>,
        attitude: Array,
        angles: Array,
        angular_velocity: Array,
    ) -> Self {
        Self { times, attitude, angles, angular_velocity }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Parts)> {
        let (py, own) = (slf.py(), slf.get());
        let [attitude, angles, rates] =
            [&own.attitude, &own.angles, &own.angular_velocity].map(|array| array.clone_ref(py));
        Ok((slf.get_type().getattr("_restored")?, (own.times.clone_ref(py), attitude, angles, rates)))
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        match self.attitude.bind(py).shape() {
            [first, _, ..] => Ok(*first),
            _ => Err(pyo3::exceptions::PyTypeError::new_err("samples at a scalar time have no len()")),
        }
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        match self.attitude.bind(py).shape() {
            [members, count, _] => {
                let counted = crate::samples::counted;
                format!("<Orbital of {} at {} each>", counted(*members, "member"), counted(*count, "time"))
            }
            [count, _] if self.times.bind(py).len().is_ok() => {
                format!("<Orbital at {}>", crate::samples::counted(*count, "time"))
            }
            [count, _] => format!("<Orbital of {} at a scalar time>", crate::samples::counted(*count, "member")),
            _ => "<Orbital at a scalar time>".to_owned(),
        }
    }
}
