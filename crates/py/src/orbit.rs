//! `andoyer.Orbit`.

use std::sync::atomic::{AtomicBool, Ordering};

use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::array::Times;
use crate::values::immutable;
use crate::{array, error, foreign};

/// The names of the elements after the mean motion and the eccentricity, in the order of the core's.
const KEYWORDS: [&str; 5] = ["time_of_pericentre", "inclination", "node", "argument_of_pericentre", "mass_fraction"];

/// The relative Keplerian orbit of a body whose gravity gradient acts on the rotating body (theory §9).
///
/// The elements refer to the inertial frame of the attitudes. With the mean motion alone, the orbit is a circle in the x, y plane with the disturbing body on
/// the x axis at time 0 (J2000 if the epoch is a `Time`: give `time_of_pericentre`).
///
/// Parameters
/// ----------
/// mean_motion : float
///     Mean motion n = √(GM/abs(a)³), in rad per unit of time, with the sum M of both masses. With quantities of astropy: ``np.sqrt(GM / a**3) * u.rad``.
/// eccentricity : float, optional
///     Eccentricity e: 0 ≤ e < 1 for an ellipse, e > 1 for a hyperbola, under which scenes are integrated. On a hyperbola M = n (t − time_of_pericentre).
/// time_of_pericentre : float, optional
///     A time of passage through the pericentre, a number or a `Time`; by default 0, which is J2000 if the epoch is a `Time`.
/// inclination, node, argument_of_pericentre : float, optional
///     Inclination of the orbit plane, longitude of the ascending node, and argument of the pericentre from the node, in rad.
/// mass_fraction : float, optional
///     Disturbing mass divided by the sum of both masses: 1 for the Sun on an asteroid, 1/82.3 for the Moon on the Earth.
/// node_rate, pericentre_rate : float, optional
///     Secular rates of the node (about inertial axis 3) and of the argument of the pericentre, in rad per unit of time. `node` and `argument_of_pericentre` are then
///     the values at `time_of_pericentre`, and `mean_motion` is the rate of the mean anomaly.
/// attraction : float, optional
///     G × disturbing mass / abs(a)³, in 1/time², instead of mean_motion² × mass_fraction. `mass_fraction` is then 1, its default.
/// semi_major_axis : float, optional
///     Semi-major axis abs(a), positive, in any unit of length. `position` needs it; the torque of the gravity gradient does not depend on it.
///
/// Warns
/// -----
/// UserWarning
///     An inclination, node or argument beyond 2π, which is probably in degrees.
///
/// Raises
/// ------
/// InputError
///     A mean motion, an attraction or a semi-major axis that is not positive; an eccentricity that is negative, 1 or above 1e50; a mass fraction that is not positive or is above 1; a mass fraction beside an attraction; a value
///     that is not finite.
/// TypeError
///     A text.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> sun = Orbit(2e-3, 0.1, inclination=0.4)
/// >>> scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0, 0, 1], orbit=sun, tolerance=1e-5, span=(0, 1e6))
/// >>> motion = scene.solve()
/// >>> motion.plan.averaging, motion.plan.torque < 1e-5
/// ('spin', True)
/// >>> pole = motion.angular_momentum([0, 1e6])
/// >>> bool(np.abs(pole[1] - pole[0]).max() > 0.01)  # the pole precesses
/// True
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Orbit(pub(crate) andoyer_propagate::Orbit);

immutable!(Orbit);

#[pymethods]
impl Orbit {
    #[new]
    #[pyo3(signature = (
        mean_motion, eccentricity=0.0, *, time_of_pericentre=0.0, inclination=0.0, node=0.0, argument_of_pericentre=0.0, mass_fraction=1.0,
        node_rate=0.0, pericentre_rate=0.0, attraction=None, semi_major_axis=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "the elements, by keyword")]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = mean_motion)] mean_motion: f64,
        #[pyo3(from_py_with = eccentricity)] eccentricity: f64,
        #[pyo3(from_py_with = time_of_pericentre)] time_of_pericentre: f64,
        #[pyo3(from_py_with = inclination)] inclination: f64,
        #[pyo3(from_py_with = node)] node: f64,
        #[pyo3(from_py_with = argument_of_pericentre)] argument_of_pericentre: f64,
        #[pyo3(from_py_with = mass_fraction)] mass_fraction: f64,
        #[pyo3(from_py_with = node_rate)] node_rate: f64,
        #[pyo3(from_py_with = pericentre_rate)] pericentre_rate: f64,
        attraction: Option<&Bound<'_, PyAny>>,
        semi_major_axis: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let attraction = attraction.map(|value| array::number("attraction", value)).transpose()?;
        let semi_major_axis = semi_major_axis.map(self::semi_major_axis).transpose()?;
        let orbit = andoyer_propagate::Orbit::new(mean_motion, eccentricity)
            .and_then(|orbit| orbit.time_of_pericentre(time_of_pericentre))
            .and_then(|orbit| orbit.plane(inclination, node, argument_of_pericentre))
            .and_then(|orbit| orbit.mass_fraction(mass_fraction))
            .and_then(|orbit| orbit.secular_rates(node_rate, pericentre_rate))
            .and_then(|orbit| attraction.map_or(Ok(orbit), |attraction| orbit.attraction(attraction)))
            .and_then(|orbit| semi_major_axis.map_or(Ok(orbit), |length| orbit.semi_major_axis(length)))
            .map_err(error::propagation)?;
        doubt(py, &orbit)?;
        Ok(Self(orbit))
    }

    /// The orbit of a satellite about an oblate primary from its mean elements, with its secular rates of first order in J2 (Kaula, Theory of Satellite Geodesy, 1966, chapter 3).
    ///
    /// All elements are mean ones. Osculating elements, such as those of a position and a velocity, differ from them by the periodic terms. Given instead of the mean
    /// ones they change the mean motion: on circles 500 km above the Earth the satellite is then 9 to 80 km off after an hour.
    ///
    /// Let n0² = GM/a³, p = a (1 − e²) and k = (3/2) n0 J2 (R/p)². The rate of the node is −k cos i, the rate of the argument of the pericentre is k (2 − (5/2)
    /// sin² i), and the rate of the mean anomaly is n0 + k √(1 − e²) (1 − (3/2) sin² i), which is `mean_motion`. Periodic terms of relative size J2 (R/p)² are
    /// omitted. A pericentre below `radius` is refused: there the expansion in R/r does not hold, and mixed units of length are seen.
    ///
    /// Parameters
    /// ----------
    /// gm : float
    ///     G × mass of the primary, in length³/time².
    /// semi_major_axis : float
    ///     Mean semi-major axis a, in units of length.
    /// eccentricity : float
    ///     Mean eccentricity, 0 or more and less than 1.
    /// inclination : float
    ///     Mean inclination i to the equator of the primary, which is the inertial x, y plane, in rad.
    /// j2 : float
    ///     J2 of the primary.
    /// radius : float
    ///     The reference radius of J2, in units of length.
    /// node, argument_of_pericentre : float, optional
    ///     Mean longitude of the node and mean argument of the pericentre at `time_of_pericentre`, in rad.
    /// time_of_pericentre : float, optional
    ///     A time at which the pericentre is passed.
    ///
    /// Returns
    /// -------
    /// Orbit
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A gm, a semi-major axis or a radius that is not positive; an eccentricity outside 0 ≤ e < 1; a pericentre a (1 − e) below `radius`; a value that is not finite;
    ///     a J2 for which the mean motion is not positive.
    ///
    /// Examples
    /// --------
    /// At a height of 500 km and an inclination of 51.6° the rate of the node is −4.75° a day:
    ///
    /// >>> import math
    /// >>> orbit = Orbit.around_oblate(3.986004415e14, 6878136.3, 0.001, math.radians(51.6), j2=1.08262668e-3, radius=6378136.3)
    /// >>> round(math.degrees(orbit.node_rate) * 86400, 2)
    /// -4.75
    #[staticmethod]
    #[pyo3(signature = (
        gm, semi_major_axis, eccentricity, inclination, *, j2, radius, node=0.0, argument_of_pericentre=0.0, time_of_pericentre=0.0
    ))]
    #[expect(clippy::too_many_arguments, reason = "the elements, by keyword")]
    fn around_oblate(
        py: Python<'_>,
        #[pyo3(from_py_with = gm)] gm: f64,
        #[pyo3(from_py_with = semi_major_axis)] semi_major_axis: f64,
        #[pyo3(from_py_with = eccentricity)] eccentricity: f64,
        #[pyo3(from_py_with = inclination)] inclination: f64,
        #[pyo3(from_py_with = j2)] j2: f64,
        #[pyo3(from_py_with = radius)] radius: f64,
        #[pyo3(from_py_with = node)] node: f64,
        #[pyo3(from_py_with = argument_of_pericentre)] argument_of_pericentre: f64,
        #[pyo3(from_py_with = time_of_pericentre)] time_of_pericentre: f64,
    ) -> PyResult<Self> {
        let primary = andoyer_propagate::disturbers::Oblateness { gm, j2, radius };
        let orbit = andoyer_propagate::Orbit::around_oblate(&primary, semi_major_axis, eccentricity, inclination)
            .and_then(|orbit| orbit.node_and_pericentre(node, argument_of_pericentre))
            .and_then(|orbit| orbit.time_of_pericentre(time_of_pericentre))
            .map_err(error::propagation)?;
        doubt(py, &orbit)?;
        Ok(Self(orbit))
    }

    /// The Keplerian orbit through a position with a velocity at a time: an ellipse or a hyperbola.
    ///
    /// The semi-major axis follows from 1/a = 2/r − v²/GM, and the mean motion is √(GM/abs(a)³). Node and argument of the pericentre are in [0, 2π), and the time of
    /// pericentre is the one nearest to `time`. If the inclination is 0 or π, the node is on the inertial x axis. If the eccentricity is 0, the pericentre is
    /// the given position.
    ///
    /// Parameters
    /// ----------
    /// position : array_like, shape (3,)
    ///     Position of the disturbing body relative to the rotating one, or of a satellite relative to its primary, in inertial components.
    /// velocity : array_like, shape (3,)
    ///     Velocity, in inertial components.
    /// gm : float
    ///     G × the sum of both masses, in length³/time².
    /// time : float or Time
    ///     The time of position and velocity.
    /// mass_fraction : float, optional
    ///     As for `Orbit`.
    ///
    /// Returns
    /// -------
    /// Orbit
    ///     With its `semi_major_axis`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A position of 0; a gm that is not positive; an eccentricity of 1 (parabola, straight fall); a value that is not finite.
    ///
    /// Examples
    /// --------
    /// >>> orbit = Orbit.from_state([7e6, 0, 0], [0, 0, 7.5e3], 3.986004415e14, 60.0)
    /// >>> round(orbit.semi_major_axis), round(orbit.eccentricity, 6)
    /// (6915843, 0.012169)
    /// >>> bool(abs(orbit.position(60.0) - [7e6, 0, 0]).max() < 1e-7)
    /// True
    #[staticmethod]
    #[pyo3(signature = (position, velocity, gm, time, *, mass_fraction=1.0))]
    fn from_state(
        position: &Bound<'_, PyAny>,
        velocity: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = gm)] gm: f64,
        #[pyo3(from_py_with = time)] time: f64,
        #[pyo3(from_py_with = mass_fraction)] mass_fraction: f64,
    ) -> PyResult<Self> {
        let [position, velocity] = [array::fixed("position", position)?, array::fixed("velocity", velocity)?];
        let orbit = andoyer_propagate::Orbit::from_state(position, velocity, gm, time);
        orbit.and_then(|orbit| orbit.mass_fraction(mass_fraction)).map(Self).map_err(error::propagation)
    }

    /// The positions at some times, in inertial components and in the unit of the semi-major axis.
    ///
    /// They are what the elements describe: the positions of the disturbing body relative to the rotating one. Elements of a satellite about its primary, as
    /// of `around_oblate`, give the positions of the satellite relative to the primary. With secular rates, node and pericentre are those of each time.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,), or Time
    ///
    /// Returns
    /// -------
    /// ndarray, shape (3,) or (n, 3)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An orbit without a `semi_major_axis`; a time that is not finite, or more than 1e15 periods from the pericentre.
    ///
    /// Examples
    /// --------
    /// >>> Orbit(1.0, 0.5, semi_major_axis=2.0).position([0.0, 3.141592653589793]).round(12) + 0.0
    /// array([[ 1.,  0.,  0.],
    ///        [-3.,  0.,  0.]])
    fn position<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let times = Times::new(&foreign::plain("times", times)?, None, false)?;
        let evaluate = |times: &[f64], rows: &mut [[f64; 3]], stop: &AtomicBool| {
            for (time, row) in times.iter().zip(rows) {
                if stop.load(Ordering::Relaxed) {
                    return Err(andoyer_propagate::Error::Stopped);
                }
                *row = self.0.position(*time)?;
            }
            Ok(())
        };
        times.evaluate(None, evaluate).map(|(rows, ())| rows)
    }

    /// Mean motion n, in rad per unit of time.
    #[getter]
    fn mean_motion(&self) -> f64 {
        self.0.elements()[0]
    }

    /// Eccentricity: less than 1 for an ellipse, above 1 for a hyperbola.
    #[getter]
    fn eccentricity(&self) -> f64 {
        self.0.elements()[1]
    }

    /// A time of passage through the pericentre.
    #[getter]
    fn time_of_pericentre(&self) -> f64 {
        self.0.elements()[2]
    }

    /// Inclination of the orbit plane, in rad.
    #[getter]
    fn inclination(&self) -> f64 {
        self.0.elements()[3]
    }

    /// Longitude of the ascending node, in rad.
    #[getter]
    fn node(&self) -> f64 {
        self.0.elements()[4]
    }

    /// Argument of the pericentre, from the node, in rad.
    #[getter]
    fn argument_of_pericentre(&self) -> f64 {
        self.0.elements()[5]
    }

    /// Disturbing mass divided by the sum of both masses.
    #[getter]
    fn mass_fraction(&self) -> f64 {
        self.0.elements()[6]
    }

    /// Secular rate of the node, in rad per unit of time.
    #[getter]
    fn node_rate(&self) -> f64 {
        self.0.rates()[0]
    }

    /// Secular rate of the argument of the pericentre, in rad per unit of time.
    #[getter]
    fn pericentre_rate(&self) -> f64 {
        self.0.rates()[1]
    }

    /// G × disturbing mass / a³, in 1/time²: by default mean_motion² × mass_fraction.
    #[getter]
    fn attraction(&self) -> f64 {
        self.0.strength()
    }

    /// Semi-major axis a, in units of length, or None.
    #[getter]
    fn semi_major_axis(&self) -> Option<f64> {
        self.0.asked_semi_major_axis()
    }

    pub(crate) fn __repr__(&self) -> String {
        let [mean_motion, eccentricity, ..] = self.0.elements();
        let keywords: Vec<_> = self.keywords().iter().map(|(key, value)| format!(", {key}={value:?}")).collect();
        format!("Orbit({mean_motion:?}, {eccentricity:?}{})", keywords.concat())
    }

    pub(crate) fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let [node_rate, pericentre_rate] = self.0.rates();
        let [attraction, length] = [self.0.asked_attraction(), self.0.asked_semi_major_axis()];
        let rest = [node_rate, pericentre_rate, attraction.unwrap_or(0.0), length.unwrap_or(0.0)];
        PyTuple::new(py, self.0.elements().into_iter().chain(rest).collect::<Vec<_>>())?.hash()
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let [mean_motion, eccentricity, ..] = self.0.elements();
        let keywords = PyDict::new(py);
        for (key, value) in self.keywords() {
            keywords.set_item(key, value)?;
        }
        ((mean_motion, eccentricity), keywords).into_pyobject(py)
    }
}

impl Orbit {
    /// The keyword arguments of this orbit; rates, attraction and semi-major axis only if they were given.
    fn keywords(&self) -> Vec<(&'static str, f64)> {
        let [_, _, rest @ ..] = self.0.elements();
        let [node_rate, pericentre_rate] = self.0.rates();
        let rates = [("node_rate", node_rate), ("pericentre_rate", pericentre_rate)];
        let attraction = self.0.asked_attraction().map(|attraction| ("attraction", attraction));
        let length = self.0.asked_semi_major_axis().map(|length| ("semi_major_axis", length));
        let more = rates.into_iter().filter(|(_, rate)| *rate != 0.0).chain(attraction).chain(length);
        KEYWORDS.into_iter().zip(rest).chain(more).collect()
    }
}

/// Warns of angles beyond a whole turn, which are probably in degrees.
pub(crate) fn doubt(py: Python<'_>, orbit: &andoyer_propagate::Orbit) -> PyResult<()> {
    error::warn_of_degrees(py, orbit.beyond_a_turn().map(|(argument, angle)| (format!("orbit.{argument}"), angle)))
}

// PyO3 leaves the name of an argument out of the message of its own `TypeError`.
macro_rules! number {
    ($($argument:ident),*) => {
        $(fn $argument(value: &Bound<'_, PyAny>) -> PyResult<f64> {
            array::number(stringify!($argument), value)
        })*
    };
}

number!(mean_motion, eccentricity, time_of_pericentre, inclination, node, argument_of_pericentre, mass_fraction);
number!(node_rate, pericentre_rate, gm, semi_major_axis, j2, radius, time);
