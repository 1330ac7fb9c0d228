//! `andoyer.Scene`.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use andoyer_propagate::disturbers::DisturbingBody;
use andoyer_propagate::libration_terms::LockedState;
use andoyer_propagate::options::MAX_ORDER;
use andoyer_propagate::periods::ObservedPeriods;
use andoyer_propagate::{Error, State};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::array::TwoOrThree;
use crate::body::Body;
use crate::computing::{detached, interruptible};
use crate::foreign::{self};
use crate::motion::Motion;
use crate::orbit::{self, Orbit};
use crate::scene_class::Scene;
use crate::torque;
use crate::values::immutable;
use crate::{array, error};

pub(crate) mod arguments;

use arguments::{
    disturbing_bodies, disturbing_body, doubt, epoch, near, not_a_body, not_one_orbit, precession, rotation, sense,
    tolerance, with_options,
};

immutable!(Scene);

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(
        signature = (
            body, attitude, angular_velocity, *, epoch=None, orbit=None, tolerance=1e-12, method="auto", order=None, span=None,
            averaging="auto", level="auto", torques=None, name=None, source=None, scalar_first=false
        ),
        text_signature = "(body, attitude, angular_velocity, *, epoch=0.0, orbit=None, tolerance=1e-12, method='auto', order=None, span=None, \
                          averaging='auto', level='auto', torques=None, name=None, source=None, scalar_first=False)"
    )]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn new(
        body: &Bound<'_, PyAny>,
        attitude: &Bound<'_, PyAny>,
        angular_velocity: &Bound<'_, PyAny>,
        epoch: Option<&Bound<'_, PyAny>>,
        orbit: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = tolerance)] tolerance: f64,
        method: &str,
        order: Option<&Bound<'_, PyAny>>,
        span: Option<&Bound<'_, PyAny>>,
        averaging: &str,
        level: &str,
        torques: Option<&Bound<'_, PyAny>>,
        name: Option<&str>,
        source: Option<&str>,
        scalar_first: bool,
    ) -> PyResult<Self> {
        let body = body.cast::<Body>().map_err(|_| not_a_body(body))?.get();
        let (attitude, scalar_first) = foreign::attitudes("attitude", attitude, scalar_first)?;
        let mut attitude = array::fixed("attitude", &attitude)?;
        foreign::scalar_last(&mut attitude, scalar_first);
        let angular_velocity = array::fixed("angular_velocity", angular_velocity)?;
        let (epoch, calendar) = self::epoch(epoch)?;
        let state = State::new(epoch, attitude, angular_velocity).map_err(error::propagation)?;
        let method = method.parse().map_err(error::propagation)?;
        let mut scene = andoyer_propagate::Scene::new(body.body.clone(), state)
            .tolerance(tolerance)
            .method(method)
            .averaging(averaging.parse().map_err(error::propagation)?)
            .level(level.parse().map_err(error::propagation)?);
        if let Some(orbit) = orbit {
            scene = scene.disturbing(disturbing_bodies(orbit)?);
        }
        if let Some(given) = torques {
            scene = scene.torques(torque::torques(given)?);
        }
        if let Some(value) = order {
            scene = scene.order(crate::order::order("order", value, 0, MAX_ORDER)?);
        }
        if let Some(value) = span {
            let [start, stop] = array::span(value, epoch, calendar)?;
            scene = scene.span(start, stop);
        }
        if let Some(name) = name {
            scene = scene.name(name);
        }
        if let Some(source) = source {
            scene = scene.source(source);
        }
        scene.validate().map_err(error::propagation)?;
        Ok(Self { scene, calendar })
    }

    /// The scene of a torque-free body that tumbles with these periods (theory §7). In each mode there is one such motion.
    ///
    /// The scene has these periods to a relative 1e-14, and less near the separatrix, where the rounding of the state counts: 1e-5 for the largest ratio of
    /// `Body.period_ratios`. Larger ratios are refused.
    ///
    /// Parameters
    /// ----------
    /// body : Body
    /// precession : float
    ///     P_φ, the mean period with which an axis precesses about the angular momentum, in units of time.
    /// rotation : float
    ///     P_ψ, the mean period of the rotation about this axis, or of the oscillation about it, in units of time.
    /// mode : {"short-axis", "long-axis"}, optional
    ///     The axis that the angular momentum circles.
    /// convention : {"extremal-axis", "long-axis", "short-axis"}, optional
    ///     The axis of the periods. The default is the axis of the mode, as in light-curve papers; radar papers use the long axis.
    /// momentum_direction : array_like, shape (3,) or (2,), optional
    ///     Direction of the angular momentum: inertial components of any length, or (longitude, latitude) in rad, the latitude from −π/2 to π/2; by default inertial axis 3.
    /// phases : (float, float), optional
    ///     Phases of P_ψ and P_φ at the epoch, in turns. At (0, 0) the axis of the mode is nearest to the angular momentum, tilted towards
    ///     (inertial axis 3) × momentum, or towards inertial axis 1 if the momentum is along axis 3.
    /// epoch : float or Time, optional
    ///     Time of the state. With a `Time` the unit of the periods is the second.
    /// attitude : array_like, shape (4,), or a rotation, optional
    ///     An attitude as of `Scene`. The state is then the nearest one to it of all with these periods and this momentum direction, instead of that at `phases`.
    /// sense : {1, -1}, optional
    ///     1 puts the positive axis of the mode along the angular momentum, -1 the negative one, as of a body that turns the other way about this axis. By default 1, or with an attitude the nearer one.
    /// **options
    ///     The other keyword arguments of `Scene`: orbit, tolerance, method, order, span, averaging, level, torques, name, source; scalar_first for `attitude`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A ratio P_ψ/P_φ that the body cannot have; the message states the interval of `Body.period_ratios`. A mode that an axisymmetric body does not
    ///     have. A period that is not positive, a direction of length 0, a latitude beyond ±π/2, a value that is not finite. A sense other than 1 and -1. Phases beside an attitude.
    ///
    /// Warns
    /// -----
    /// UserWarning
    ///     A phase beyond a whole turn, which is probably in degrees.
    ///
    /// Examples
    /// --------
    /// Apophis, in hours (Pravec et al. 2014). With a `Time` epoch the unit is the second.
    ///
    /// >>> scene = Scene.from_periods(Body([0.61, 0.965, 1.0]), 27.38, 263.0)
    /// >>> motion = scene.solve()
    /// >>> round(motion.energy_ratio, 5), round(motion.periods["long-axis"].precession, 2)
    /// (1.02364, 30.56)
    #[classmethod]
    #[pyo3(signature = (
        body, precession, rotation, *, mode="short-axis", convention="extremal-axis", momentum_direction=None, phases=None, epoch=None,
        attitude=None, sense=None, **options
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn from_periods<'py>(
        class: &Bound<'py, PyType>,
        body: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = precession)] precession: f64,
        #[pyo3(from_py_with = rotation)] rotation: f64,
        mode: &str,
        convention: &str,
        momentum_direction: Option<&Bound<'py, PyAny>>,
        phases: Option<&Bound<'py, PyAny>>,
        epoch: Option<&Bound<'py, PyAny>>,
        attitude: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = sense)] sense: Option<f64>,
        options: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (time, _) = self::epoch(epoch)?;
        let attitude = near(attitude, phases, options.as_ref())?;
        let mut periods =
            ObservedPeriods { epoch: time, attitude, sense, ..ObservedPeriods::new(precession, rotation) };
        periods.mode = mode.parse().map_err(error::propagation)?;
        periods.convention = convention.parse().map_err(error::propagation)?;
        if let Some(phases) = phases {
            periods.phases = array::fixed("phases", phases)?;
        }
        if let Some(direction) = momentum_direction {
            periods = match array::two_or_three("momentum_direction", direction)? {
                TwoOrThree::Two([longitude, latitude]) => {
                    error::warn_of_degrees(class.py(), [("momentum_direction[0]", longitude)])?;
                    periods.towards(longitude, latitude).map_err(error::propagation)?
                }
                TwoOrThree::Three(vector) => ObservedPeriods { momentum_direction: vector.into(), ..periods },
            };
        }
        doubt(class.py(), &periods)?;
        let of_body = body.cast::<Body>().map_err(|_| not_a_body(body))?.get().body.clone();
        let solve = || andoyer_propagate::Scene::from_periods(of_body, &periods);
        let scene = detached(class.py(), error::propagation, solve)?;
        with_options(class, body, (&scene, epoch), options)
    }

    /// The scene with given Andoyer variables at the epoch (theory §1). It is the inverse of `Motion.andoyer`.
    ///
    /// Parameters
    /// ----------
    /// body : Body
    /// andoyer : array_like, shape (6,)
    ///     (λ, μ, ν, Λ, M, N): angles in rad, momenta in the unit of moment × rate, with those of rotors among the torques; M > 0, −M ≤ Λ ≤ M, −M ≤ N ≤ M. Small inclinations I and J, which Λ and N give by
    ///     differences from M, are known to 1e-8 rad.
    /// epoch : float, optional
    ///     Time of the state.
    /// **options
    ///     The other keyword arguments of `Scene`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A variable that is not finite or out of its bounds; the message has its index.
    ///
    /// Examples
    /// --------
    /// >>> scene = Scene.from_andoyer(Body([1, 1.5, 2]), [0.1, 0.2, 0.3, 0.5, 1.0, 0.9])
    /// >>> scene.solve().andoyer(0.0).round(12)
    /// array([0.1, 0.2, 0.3, 0.5, 1. , 0.9])
    #[classmethod]
    #[pyo3(signature = (body, andoyer, *, epoch=None, **options))]
    fn from_andoyer<'py>(
        class: &Bound<'py, PyType>,
        body: &Bound<'py, PyAny>,
        andoyer: &Bound<'py, PyAny>,
        epoch: Option<&Bound<'py, PyAny>>,
        options: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let of_body = body.cast::<Body>().map_err(|_| not_a_body(body))?.get().body.clone();
        let variables: [f64; 6] = array::fixed("andoyer", andoyer)?;
        error::warn_of_degrees(class.py(), error::each("andoyer", &variables[..3]))?;
        let (time, _) = self::epoch(epoch)?;
        let given = options.as_ref().map(|options| options.get_item("torques")).transpose()?.flatten();
        let torques = given.filter(|given| !given.is_none()).map_or(Ok(Vec::new()), |given| torque::torques(&given))?;
        let scene = andoyer_propagate::Scene::from_andoyer_with(of_body, variables, time, torques);
        let scene = scene.map_err(error::propagation)?;
        with_options(class, body, (&scene, epoch), options)
    }

    /// The scene of a body that is locked to an orbit: relaxed, or with free librations (docs: locked rotation).
    ///
    /// The axis of least inertia follows the disturbing body; the axis of greatest inertia is near the normal of the orbit, or near the stable Cassini state that is nearest to it if the
    /// node moves. The relaxed state is on the periodic motion of the resonance: forced librations alone. A natural start, at rest in the frame of the resonance, has free librations
    /// as large as the forced ones.
    ///
    /// Parameters
    /// ----------
    /// body : Body
    /// orbit : Orbit
    ///     The orbit of the disturbing body.
    /// resonance : float or Fraction, optional
    ///     Rotations an orbit: 1/2, 1, 3/2, 2, … 4.
    /// amplitudes : array_like, shape (3,), optional
    ///     The largest angle of each free libration [rad]: in longitude, then the two of the pole, as of `Libration.amplitudes`.
    /// phases : array_like, shape (3,), optional
    ///     The phases of these angles at the epoch [rad], as of `Libration.phases`.
    /// epoch : float or Time, optional
    ///     Time of the state.
    /// **options
    ///     The other keyword arguments of `Scene`: tolerance, method, order, span, averaging, level, torques, name, source.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     Another resonance; an amplitude below 0; a number that is not finite.
    /// TheoryError
    ///     A resonance without a torque on this orbit, as 3/2 on a circle, or without a stable motion: the message says in which direction the body leaves it and how fast. Amplitudes beyond
    ///     the range of the series.
    ///
    /// Examples
    /// --------
    /// >>> options = {"method": "libration", "tolerance": 1e-6, "span": (0, 50)}
    /// >>> scene = Scene.locked(Body([0.3, 0.35, 0.4]), Orbit(1.0, eccentricity=0.02), amplitudes=[0.01, 0, 0], **options)
    /// >>> scene.solve().libration.amplitudes.round(9)
    /// array([0.01, 0.  , 0.  ])
    #[classmethod]
    #[pyo3(
        signature = (body, orbit, *, resonance=None, amplitudes=None, phases=None, epoch=None, **options),
        text_signature = "(body, orbit, *, resonance=1, amplitudes=(0.0, 0.0, 0.0), phases=(0.0, 0.0, 0.0), epoch=0.0, **options)"
    )]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn locked<'py>(
        class: &Bound<'py, PyType>,
        body: &Bound<'py, PyAny>,
        orbit: &Bound<'py, PyAny>,
        resonance: Option<&Bound<'py, PyAny>>,
        amplitudes: Option<&Bound<'py, PyAny>>,
        phases: Option<&Bound<'py, PyAny>>,
        epoch: Option<&Bound<'py, PyAny>>,
        options: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = class.py();
        let mut state = LockedState { epoch: self::epoch(epoch)?.0, ..LockedState::default() };
        if let Some(resonance) = resonance {
            state.resonance = array::number("resonance", resonance)?;
        }
        if let Some(amplitudes) = amplitudes {
            state.amplitudes = array::fixed("amplitudes", amplitudes)?;
            error::warn_of_degrees(py, error::each("amplitudes", &state.amplitudes))?;
        }
        if let Some(phases) = phases {
            // Those of `from_periods` are in turns.
            let argument = if foreign::holds_units(phases)? { "phases of librations" } else { "phases" };
            state.phases = array::fixed(argument, phases)?;
            error::warn_of_degrees(py, error::each("phases", &state.phases))?;
        }
        let of_body = body.cast::<Body>().map_err(|_| not_a_body(body))?.get().body.clone();
        let around = orbit.cast::<Orbit>().map_err(|_| not_one_orbit(orbit))?.get().0;
        let find = |stop: &AtomicBool| andoyer_propagate::Scene::locked(of_body.clone(), &around, &state, stop);
        let scene = interruptible(py, true, error::propagation, find)?;
        let options = options.unwrap_or_else(|| PyDict::new(py));
        options.set_item("orbit", orbit)?;
        with_options(class, body, (&scene, epoch), Some(options))
    }

    /// Reads a scene from a TOML file.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///
    /// Raises
    /// ------
    /// FileError
    ///     A missing file, a file of more than 16 MiB or one that is not TOML, an unknown or missing key, a value outside its bound. The message names file, key and bound.
    #[classmethod]
    fn from_toml(class: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        let scene = andoyer_propagate::Scene::from_toml(path).map_err(error::propagation)?;
        for body in scene.asked_disturbing() {
            if let DisturbingBody::Orbit(orbit) = body {
                orbit::doubt(class.py(), orbit)?;
            }
        }
        Ok(Self::from(scene))
    }

    /// Writes the scene as TOML text. `from_toml` reads this text from a file as an equal scene.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A scene with `Torque.dissipation`: a file holds no function.
    fn to_toml(&self) -> PyResult<String> {
        if self.scene.asked_torques().iter().any(|torque| torque.kind() == "dissipation") {
            let message =
                "torques has a dissipation, a function that a scene file cannot hold: write the scene without it";
            return Err(error::input("torques", "dissipation", "without a dissipation", message.to_owned()));
        }
        Ok(self.scene.to_toml())
    }

    /// Solves the scene: computes everything that does not depend on time, and returns the motion.
    ///
    /// Warns
    /// -----
    /// ToleranceWarning
    ///     The error bound exceeds the tolerance over the span (`Plan.meets_tolerance`); the warning has both numbers.
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     ``method="series"`` if the motion is on the separatrix, or so near it that the tolerance needs an order above 60.
    ///     Without a span, or with a fixed method, averaging or level: an orbit that is in resonance with the rotation or not much slower (the message names the
    ///     pair (h, m) of the term in hℓ′ + my′, theory §9); a torque that is too strong for an expansion; an orbit with a motion too near the separatrix, a body at rest or rotating about its middle axis, or
    ///     an axisymmetric body that rotates about a perpendicular axis; more orbits than ``averaging="spin"`` can solve. With a span ``method="auto"`` integrates these motions.
    ///     ``method="closed"`` or ``"series"`` with a table; a span that is too long for the averaged equations of several orbits, or of an orbit with secular rates.
    ///     An integration with more than 8,388,608 steps on one side of the epoch, or one that is so unstable that the final state is unknown.
    /// InputError
    ///     ``averaging="orbit"`` or ``level="second-order"`` with several orbits or an orbit with secular rates. An integration without a span, or with a span that a `TabulatedOrbit` does not cover.
    /// RepresentationError
    ///     The angular momentum, moment × rate, is not a normal double: ``1e-200 * 1e-200``.
    fn solve(&self, py: Python<'_>) -> PyResult<Motion> {
        let motion = self.solved(py)?;
        error::warn_of_tolerance(py, motion.plan().missed_tolerance())?;
        Ok(Motion(motion, self.calendar))
    }

    /// The body.
    #[getter]
    fn body(&self) -> Body {
        Body { body: self.scene.body().clone() }
    }

    /// The attitude at the epoch: unit quaternion [x, y, z, w], normalized, a read-only array of shape (4,).
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        array::constant(py, self.scene.state().attitude.coords.as_slice()).into_any()
    }

    /// The angular velocity at the epoch, in body components, in rad per unit of time: a read-only array of shape (3,).
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        array::constant(py, self.scene.state().angular_velocity.as_slice()).into_any()
    }

    /// The time of the state.
    #[getter]
    fn epoch(&self) -> f64 {
        self.scene.state().epoch
    }

    /// The requested attitude error, in rad.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.scene.asked_tolerance()
    }

    /// The method: "auto", "series", "closed", "integrated" or "libration".
    #[getter]
    fn method(&self) -> String {
        self.scene.asked_method().to_string()
    }

    /// The fixed order of the series, or None.
    #[getter]
    fn order(&self) -> Option<usize> {
        self.scene.asked_order()
    }

    /// The span, the times over which the tolerance is requested: (start, stop), or None.
    #[getter]
    fn span(&self) -> Option<(f64, f64)> {
        self.scene.asked_span()
    }

    /// The orbit of the disturbing body, an `Orbit` or a `TabulatedOrbit`; of several a tuple of them; or None.
    #[getter]
    fn orbit<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let bodies: Vec<_> =
            self.scene.asked_disturbing().iter().map(|body| disturbing_body(py, body)).collect::<PyResult<_>>()?;
        match bodies.as_slice() {
            [] => Ok(None),
            [body] => Ok(Some(body.clone())),
            bodies => Ok(Some(PyTuple::new(py, bodies)?.into_any())),
        }
    }

    /// The averaging: "auto", "orbit" or "spin".
    #[getter]
    fn averaging(&self) -> String {
        self.scene.asked_averaging().to_string()
    }

    /// The level: "auto", "full", "second-order", "moving" or "paper".
    #[getter]
    fn level(&self) -> String {
        self.scene.asked_level().to_string()
    }

    /// The torques beside the gravity gradient, a tuple.
    #[getter]
    fn torques<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        torque::tuple(py, self.scene.asked_torques())
    }

    /// The name, or None.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.scene.asked_name()
    }

    /// The source of the figures, or None.
    #[getter]
    fn source(&self) -> Option<&str> {
        self.scene.asked_source()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut keywords = String::new();
        for (key, value) in self.keywords(py)?.iter() {
            keywords += &format!(", {key}={}", value.repr()?);
        }
        let state = self.scene.state();
        let [attitude, rates] = [state.attitude.coords.as_slice(), state.angular_velocity.as_slice()];
        Ok(format!("Scene({}, {attitude:?}, {rates:?}{keywords})", self.body().__repr__(py)?))
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let state = self.scene.state();
        let numbers: ([f64; 4], [f64; 3]) = (state.attitude.coords.into(), state.angular_velocity.into());
        let keywords = Self::from(self.scene.clone()).keywords(py)?.values();
        let keywords = PyTuple::new(py, keywords)?;
        let [attitude, rates] = [PyTuple::new(py, numbers.0)?, PyTuple::new(py, numbers.1)?];
        (self.body().__hash__(py)?, attitude, rates, keywords).into_pyobject(py)?.hash()
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let state = self.scene.state();
        let [attitude, rates] = [state.attitude.coords.as_slice(), state.angular_velocity.as_slice()];
        ((self.body(), attitude, rates), self.keywords(py)?).into_pyobject(py)
    }
}

impl Scene {
    /// The motion; an integration can be interrupted.
    pub(crate) fn solved(&self, py: Python<'_>) -> PyResult<andoyer_propagate::Motion> {
        if !self.scene.needs_integration() {
            // Theory takes less time than a thread needs to start. A flag that is set from the start ends an integration before its first step.
            let by_theory = || match self.scene.solve_until(&AtomicBool::new(true)) {
                Err(Error::Stopped) => Ok(None),
                solved => solved.map(Some),
            };
            if let Some(motion) = detached(py, error::propagation, by_theory)? {
                return Ok(motion);
            }
        }
        interruptible(py, !self.scene.is_brief(), error::propagation, |stop| self.scene.solve_until(stop))
    }

    /// The keyword arguments that make this scene.
    fn keywords<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let keywords = PyDict::new(py);
        match self.calendar {
            Some(calendar) => keywords.set_item("epoch", foreign::calendar(py, &[calendar])?.get_item(0)?)?,
            None => keywords.set_item("epoch", self.epoch())?,
        }
        keywords.set_item("orbit", self.orbit(py)?)?;
        keywords.set_item("tolerance", self.tolerance())?;
        keywords.set_item("method", self.method())?;
        keywords.set_item("order", self.order())?;
        keywords.set_item("span", self.span())?;
        keywords.set_item("averaging", self.averaging())?;
        keywords.set_item("level", self.level())?;
        if !self.scene.asked_torques().is_empty() {
            keywords.set_item("torques", self.torques(py)?)?;
        }
        keywords.set_item("name", self.name())?;
        keywords.set_item("source", self.source())?;
        Ok(keywords)
    }
}
