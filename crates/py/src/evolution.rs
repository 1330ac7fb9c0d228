//! `Scene.drift`, `Scene.evolve`, `andoyer.Drift`, `andoyer.Evolution` and what it returns.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use andoyer_propagate::evolutions::{self, EvolveOptions, Evolved};
use andoyer_propagate::options::Averaging;
use andoyer_series::error::Kind;
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::array::{self, Times};
use crate::computing::{detached, interruptible, interruptible_with};
use crate::error;
use crate::foreign::{self, Calendar};
use crate::material::{calling, exception};
use crate::order::whole_number;
use crate::scene_class::Scene;
use crate::values::immutable;

#[pymethods]
impl Scene {
    /// The mean rates of angular momentum, excess of energy, spin period and obliquity at the epoch: torques averaged over the rotation (weak torques, section 1).
    ///
    /// Parameters
    /// ----------
    /// average : {"auto", "orbit", "spin"}, optional
    ///     As of `Scene.evolve`.
    ///
    /// Raises
    /// ------
    /// TheoryError, InputError
    ///     As `Scene.evolve`.
    ///
    /// Examples
    /// --------
    /// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 1], torques=[Torque.damping([1e-9, 2e-9, 2e-9])])
    /// >>> drift = scene.drift()
    /// >>> drift.momentum.round(12), drift.wobble_rate > 0
    /// (array([ 0.e+00,  0.e+00, -2.e-09]), False)
    #[pyo3(signature = (*, average="auto"))]
    fn drift(&self, py: Python<'_>, average: &str) -> PyResult<Drift> {
        let average = averaging(average)?;
        detached(py, exception, || calling(|| self.scene.drift(average))).map(Drift)
    }

    /// The motion averaged over the rotation, over years to millions of years: angular momentum and excess of energy, without attitude and phases.
    ///
    /// Torques must be weak: the rotation and the wobble turn many times before a torque changes them. The phases are unknown after times in which the rotation changes by itself, so there is no attitude.
    ///
    /// Parameters
    /// ----------
    /// span : (float, float), optional
    ///     First and last time; by default the span of the scene. The way from the epoch to a span beside it belongs to the evolution.
    /// average : {"auto", "orbit", "spin"}, optional
    ///     "orbit" averages torques of sources on ellipses over their orbits, too: exact in one term if they fall with the square of the distance. Sources on hyperbolas and in tables are followed; the field of a dipole is averaged over its orbit and over the turn of its moment. "spin" averages over the rotation alone and
    ///     follows all sources. "auto" averages over orbits if an orbit changes direction and excess by less than 0.01.
    /// tolerance : float, optional
    ///     Largest relative error of a step of the integration. The averages themselves leave out terms of the second order in the torque.
    /// members : int, optional
    ///     Number of members with other phases at the epoch that are followed, too, for `Evolution.members` and `end.spread`; at most 10,000.
    /// progress : callable, optional
    ///     Called as ``progress(done, of)`` with hundredths of the work.
    ///
    /// Returns
    /// -------
    /// Evolution
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     A torque that is not weak against the rotation or the wobble, a source that moves too fast, a state on the separatrix, a sphere, a body at rest. The message has the ratio and its limit.
    /// InputError
    ///     No span; rotors; a polynomial with the directions or distances of two sources in one term; a table that does not reach the span.
    ///
    /// Warns
    /// -----
    /// ToleranceWarning
    ///     The polynomials of shapes leave out so much of the torque that the angular momentum may be wrong by a tenth of its size. `Evolution.plan` warns of its whole error bound.
    ///
    /// Examples
    /// --------
    /// A damping in proportion to the inertia: the momentum decays and the wobble stays.
    ///
    /// >>> body = Body([1, 1.5, 2])
    /// >>> scene = Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0], torques=[Torque.damping([1e-9, 1.5e-9, 2e-9])])
    /// >>> evolution = scene.evolve((0, 1e9))
    /// >>> evolution.end.reason, (evolution.at(1e9).spin_period / evolution.at(0).spin_period).round(6)
    /// ('span', np.float64(2.718282))
    #[pyo3(
        signature = (span=None, *, average="auto", tolerance=None, members=None, progress=None),
        text_signature = "($self, span=None, *, average='auto', tolerance=1e-06, members=None, progress=None)"
    )]
    fn evolve(
        &self,
        py: Python<'_>,
        span: Option<&Bound<'_, PyAny>>,
        average: &str,
        tolerance: Option<&Bound<'_, PyAny>>,
        members: Option<&Bound<'_, PyAny>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Evolution> {
        let mut options = EvolveOptions::default().average(averaging(average)?);
        if let Some(span) = span {
            let [start, stop] = array::span(span, self.scene.state().epoch, self.calendar)?;
            options = options.span(start, stop);
        }
        if let Some(tolerance) = tolerance {
            options = options.tolerance(array::number("tolerance", tolerance)?);
        }
        if let Some(members) = members {
            options = options.members(whole_number("members", members, 0, usize::MAX >> 1, Kind::Input)?);
        }
        let done = AtomicU32::new(0);
        let mut told = 0;
        let mut look = |py: Python<'_>| {
            py.check_signals()?;
            let share = done.load(Ordering::Relaxed) / 10;
            match &progress {
                Some(progress) if share != told => {
                    told = share;
                    progress.call1(py, (share, 100)).map(drop)
                }
                _ => Ok(()),
            }
        };
        let evolve = |stop: &AtomicBool| calling(|| self.scene.evolve(options.reporting(&done).until(stop)));
        let evolution = interruptible_with(py, &mut look, exception, evolve)?;
        if let Some(progress) = progress {
            progress.call1(py, (100, 100))?;
        }
        error::warn_of_tolerance(py, evolution.large_error())?;
        Ok(Evolution { evolution, calendar: self.calendar })
    }
}

fn averaging(average: &str) -> PyResult<Averaging> {
    average.parse().map_err(|_| {
        let message = format!("average = {average:?}: it must be \"auto\", \"orbit\" or \"spin\"");
        error::input("average", average, "auto, orbit, spin", message)
    })
}

/// Mean rates of a scene, from `Scene.drift`.
///
/// Examples
/// --------
/// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 1], torques=[Torque.constant([0, 0, 1e-9])])
/// >>> drift = scene.drift()
/// >>> drift.momentum, drift.obliquity is None
/// (array([0.e+00, 0.e+00, 1.e-09]), True)
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct Drift(evolutions::Drift);

immutable!(Drift);

#[pymethods]
impl Drift {
    /// Rate of the angular momentum, inertial, in moment × rate²: a read-only array of shape (3,).
    #[getter]
    fn momentum<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        array::constant(py, &self.0.momentum).into_any()
    }

    /// Rate of the excess of energy ξ (`Evolution`), in 1/time.
    #[getter]
    fn excess(&self) -> f64 {
        self.0.excess
    }

    /// Rate of the spin period, a plain number.
    #[getter]
    fn spin_period(&self) -> f64 {
        self.0.spin_period
    }

    /// Rate of the obliquity, in rad/time; None without an orbit.
    #[getter]
    fn obliquity(&self) -> Option<f64> {
        self.0.obliquity
    }

    /// Rates of momentum and excess by the harmonics of each degree, from 0: tuples (momentum (3,), excess).
    #[getter]
    fn by_degree<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, self.0.by_degree.iter().map(|(momentum, excess)| (array::constant(py, momentum), *excess)))
    }

    /// Growth rate of a small excess of energy, in 1/time: uniform rotation about the axis of the mode is unstable if it is positive.
    #[getter]
    fn wobble_rate(&self) -> f64 {
        self.0.wobble_rate
    }

    fn __repr__(&self) -> String {
        format!(
            "<Drift: momentum {:?}, excess {:.3e}, spin period {:.3e}>",
            self.0.momentum, self.0.excess, self.0.spin_period
        )
    }
}

/// The motion averaged over the rotation, from `Scene.evolve`. It has no attitude and no phases.
///
/// Its variables are the angular momentum and the excess of energy ξ: 2CE/M² − 1 in the short-axis mode, 1 − 2AE/M² in the long-axis mode; 0 is uniform rotation.
///
/// Examples
/// --------
/// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 1], torques=[Torque.constant([0, 0, 1e-9])])
/// >>> evolution = scene.evolve((0, 1e8))
/// >>> evolution.at([0, 1e8]).momentum.round(9)
/// array([[0. , 0. , 2. ],
///        [0. , 0. , 2.1]])
/// >>> evolution
/// <Evolution from 0.0 to 100000000.0: span>
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Evolution {
    evolution: evolutions::Evolution,
    calendar: Option<Calendar>,
}

immutable!(Evolution);

#[pymethods]
impl Evolution {
    /// The averaged state at times of the span, up to the end of the evolution.
    ///
    /// Parameters
    /// ----------
    /// times : array_like, shape () or (n,)
    ///     Times of astropy as in `Scene`.
    ///
    /// Raises
    /// ------
    /// RepresentationError, InputError
    ///     A time outside, or that is not finite.
    fn at(slf: &Bound<'_, Self>, times: &Bound<'_, PyAny>) -> PyResult<EvolvedStates> {
        let own = slf.get();
        let (values, leading) = own.times(times)?;
        let states = detached(slf.py(), exception, || calling(|| own.evolution.at(&values)))?;
        Ok(EvolvedStates { evolution: slf.clone().unbind(), states, leading })
    }

    /// A scene at a time whose averaged motion this is: torques, orbits and options are those of `scene`, without a span. The averages do not contain the phases, so they are given; what the averages leave out at these phases is added to them.
    ///
    /// Parameters
    /// ----------
    /// time : float or Time
    /// phases : (float, float)
    ///     Phases of P_ψ and P_φ in turns, as of `Scene.from_periods`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A time outside; phases that are not finite; a state so near the separatrix that a double does not hold it.
    ///
    /// Examples
    /// --------
    /// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], torques=[Torque.damping([1e-9, 1.5e-9, 2e-9])])
    /// >>> later = scene.evolve((0, 1e9)).motion_at(1e9, (0.25, 0.0))
    /// >>> later.epoch, later.span is None
    /// (1000000000.0, True)
    fn motion_at(&self, py: Python<'_>, time: &Bound<'_, PyAny>, phases: &Bound<'_, PyAny>) -> PyResult<Scene> {
        let (values, leading) = self.times(time)?;
        let &[time] = &values[..] else {
            return Err(error::input("time", values.len(), 1_usize, "time must be one time".to_owned()));
        };
        if !leading.is_empty() {
            return Err(error::input(
                "time",
                values.len(),
                1_usize,
                "time must be one time, without an axis".to_owned(),
            ));
        }
        let phases = array::fixed("phases", phases)?;
        let scene = detached(py, exception, || calling(|| self.evolution.motion_at(time, phases)))?;
        Ok(Scene { calendar: self.calendar_at(py, time)?, ..scene.into() })
    }

    /// What becomes of it beyond the separatrix, where the mode depends on phases that the averages have lost: members with evenly spread phases pass it by the full equations, and each outcome goes on in averages.
    ///
    /// Parameters
    /// ----------
    /// members : int, optional
    ///     Number of members: a probability p has the standard deviation √(p(1 − p)/members) at most.
    /// seed : int, optional
    ///     Another seed shifts the phases.
    ///
    /// Returns
    /// -------
    /// list of (float, Evolution)
    ///     The probability of each mode and sense that is reached, the most likely first, and the averaged motion of one of its members up to the end of the span. An evolution that ends
    ///     otherwise is its own, with the probability 1.
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     A member that stays at the separatrix; what `Scene.evolve` raises beyond it.
    #[pyo3(signature = (members=None, seed=None), text_signature = "($self, members=64, seed=0)")]
    fn through(
        &self,
        py: Python<'_>,
        members: Option<&Bound<'_, PyAny>>,
        seed: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<(f64, Self)>> {
        let number = |name, value: Option<&Bound<'_, PyAny>>, least, default| {
            value.map_or(Ok(default), |value| whole_number(name, value, least, usize::MAX >> 1, Kind::Input))
        };
        let (members, seed) = (number("members", members, 1, 64)?, number("seed", seed, 0, 0)?);
        let pass = |stop: &AtomicBool| calling(|| self.evolution.through(members, seed as u64, stop));
        let passages = interruptible(py, true, exception, pass)?;
        let of = |(share, evolution): (f64, evolutions::Evolution)| {
            let calendar = self.calendar_at(py, evolution.scene().state().epoch)?;
            Ok((share, Self { evolution, calendar }))
        };
        passages.into_iter().map(of).collect()
    }

    /// Why and when it ends.
    #[getter]
    fn end(&self) -> PyResult<EvolutionEnd> {
        Ok(EvolutionEnd(self.evolution.end(), self.evolution.spread().map_err(error::propagation)?))
    }

    /// What is known of its error; each call integrates the full equations over thirty rotations. A `ToleranceWarning` names an error bound above a tenth of the angular momentum.
    #[getter]
    fn plan(&self, py: Python<'_>) -> PyResult<EvolutionPlan> {
        let plan = detached(py, exception, || calling(|| self.evolution.plan()))?;
        error::warn_of_tolerance(py, plan.large_error())?;
        Ok(EvolutionPlan(plan))
    }

    /// The ends of the members that `evolve` was asked for: the same momentum and energy at the epoch with evenly spread phases.
    #[getter]
    fn members(&self) -> Vec<EvolutionEnd> {
        self.evolution.members().iter().map(|end| EvolutionEnd(*end, None)).collect()
    }

    /// The first and the last time that it reaches.
    #[getter]
    fn reached(&self) -> (f64, f64) {
        self.evolution.reached().into()
    }

    /// The averaging: "orbit" or "spin".
    #[getter]
    fn average(&self) -> String {
        self.evolution.average().to_string()
    }

    /// The scene.
    #[getter]
    fn scene(&self) -> Scene {
        Scene { calendar: self.calendar, ..Scene::from(self.evolution.scene().clone()) }
    }

    fn __repr__(&self) -> String {
        let [first, last] = self.evolution.reached();
        format!("<Evolution from {first:?} to {last:?}: {}>", self.evolution.end().reason)
    }
}

impl Evolution {
    /// A time as a calendar time, if the epoch of the scene is one.
    fn calendar_at(&self, py: Python<'_>, time: f64) -> PyResult<Option<Calendar>> {
        let Some(epoch) = self.calendar else { return Ok(None) };
        Ok(foreign::later(py, epoch, false, time)?.1.first().copied())
    }

    /// Times on the scale of the scene, and the shape of what is computed at them.
    fn times(&self, times: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<usize>)> {
        let times = Times::new(times, self.calendar, true)?;
        let epoch = if times.since_epoch() { self.evolution.scene().state().epoch } else { 0.0 };
        let shape = times.rows(1)?.shape().to_vec();
        Ok((times.values()?.iter().map(|time| time + epoch).collect(), shape[..shape.len() - 1].to_vec()))
    }
}

/// The end of an evolution, from `Evolution.end`.
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct EvolutionEnd(evolutions::EvolutionEnd, Option<f64>);

immutable!(EvolutionEnd);

#[pymethods]
impl EvolutionEnd {
    /// Why it ends: "span"; "separatrix", after which the mode depends on lost phases; "slow rotation" or "near sphere", where rotation or wobble is no longer fast against the torque.
    #[getter]
    fn reason(&self) -> String {
        self.0.reason.to_string()
    }

    /// When it ends.
    #[getter]
    fn time(&self) -> f64 {
        self.0.time
    }

    /// How much earlier or later it may end. With ``members=`` of `Scene.evolve` the standard deviation of the members that end for the same reason. Otherwise, at the separatrix, the time in which the averages pass what they leave out; None for other reasons.
    #[getter]
    fn spread(&self) -> Option<f64> {
        self.1
    }

    fn __repr__(&self) -> String {
        format!("<EvolutionEnd: {} at {:?}>", self.0.reason, self.0.time)
    }
}

/// What is known of the error of an evolution, from `Evolution.plan`.
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct EvolutionPlan(evolutions::EvolutionPlan);

immutable!(EvolutionPlan);

#[pymethods]
impl EvolutionPlan {
    /// Estimated error of the angular momentum at the farther end, over its size at the epoch: the rate of second order times the time, the truncation times the change, and the jumps of `resonances`.
    #[getter]
    fn error_bound(&self) -> f64 {
        self.0.error_bound
    }

    /// The text of the `ToleranceWarning` if the error bound is above a tenth, otherwise None.
    #[getter]
    fn large_error(&self) -> Option<String> {
        self.0.large_error()
    }

    /// What the polynomials of shapes leave out, relative to the torque.
    #[getter]
    fn truncation(&self) -> f64 {
        self.0.truncation
    }

    /// Rates at which averages and full equations separate, in 1/time: of the angular momentum over its size, and of the excess of energy.
    #[getter]
    fn second_order(&self) -> (f64, f64) {
        self.0.second_order.into()
    }

    /// Resonances h dℓ′/dt + m dy′/dt = 0 between wobble and rotation that are passed: tuples (h, m, time, jump, capture).
    ///
    /// `jump` is the largest change of the angular momentum by the passage, over its size; it depends on lost phases. It is listed if it is above the tolerance of `evolve`. If `capture` is true, the motion may stay in resonance from there on: the evolution is one of several.
    #[getter]
    fn resonances(&self) -> Vec<(i32, i32, f64, f64, bool)> {
        let of = |one: &evolutions::PassedResonance| (one.wobble, one.turn, one.time, one.jump, one.may_capture());
        self.0.resonances.iter().map(of).collect()
    }

    fn __repr__(&self) -> String {
        format!("<EvolutionPlan: error bound {:.1e}, truncation {:.1e}>", self.0.error_bound, self.0.truncation)
    }
}

/// Averaged states at times, from `Evolution.at`: arrays whose first axis is that of the times.
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct EvolvedStates {
    evolution: Py<Evolution>,
    states: Vec<Evolved>,
    leading: Vec<usize>,
}

immutable!(EvolvedStates);

impl EvolvedStates {
    fn numbers<'py>(&self, py: Python<'py>, of: impl Fn(&Evolved) -> f64) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let values: Vec<f64> = self.states.iter().map(of).collect();
        values.into_pyarray(py).reshape(self.leading.clone())
    }

    fn vectors<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Evolved) -> [f64; 3],
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let values: Vec<f64> = self.states.iter().flat_map(of).collect();
        values.into_pyarray(py).reshape([&self.leading[..], &[3]].concat())
    }
}

#[pymethods]
impl EvolvedStates {
    /// The times, shape (n,).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.numbers(py, |state| state.time)
    }

    /// Angular momentum, inertial, in moment × rate, shape (n, 3).
    #[getter]
    fn momentum<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.vectors(py, |state| state.momentum)
    }

    /// Its direction: unit vectors, shape (n, 3).
    #[getter]
    fn direction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.vectors(py, |state| state.direction())
    }

    /// ξ, the excess of energy, shape (n,): 2CE/M² − 1 in the short-axis mode, 1 − 2AE/M² in the long-axis mode.
    #[getter]
    fn excess<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.numbers(py, |state| state.excess)
    }

    /// What the averages leave out, shape (n, 2): root mean square over the phases of the short-period parts of the angular momentum, over its size, and of the excess of energy. It is computed when it is asked for.
    #[getter]
    fn band<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let times: Vec<f64> = self.states.iter().map(|state| state.time).collect();
        let evolution = &self.evolution.get().evolution;
        let bands = detached(py, exception, || calling(|| evolution.band(&times)))?;
        bands.as_flattened().to_vec().into_pyarray(py).reshape([&self.leading[..], &[2]].concat())
    }

    /// 2π M/2E, the spin period, of a tumbler an effective one, shape (n,).
    #[getter]
    fn spin_period<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.numbers(py, |state| state.spin_period)
    }

    /// Angle between the angular momentum and the normal of the first orbit, in rad, shape (n,); None without an orbit.
    #[getter]
    fn obliquity<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<f64>>>> {
        if self.states.iter().any(|state| state.obliquity.is_none()) {
            return Ok(None);
        }
        self.numbers(py, |state| state.obliquity.unwrap_or_default()).map(Some)
    }

    /// The mode: "short-axis" or "long-axis"; an evolution stays in its mode.
    #[getter]
    fn mode(&self) -> Option<String> {
        self.states.first().map(|state| state.mode.to_string())
    }

    /// Mean periods of the precession of the axis and of the motion about it, by convention as `Motion.periods`, arrays of shape (n,).
    #[getter]
    fn periods<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let of = |convention| {
            let precession = self.numbers(py, |state| state.periods(convention).precession);
            let rotation = self.numbers(py, |state| state.periods(convention).rotation);
            Ok((convention, (precession?, rotation?)))
        };
        let pairs = andoyer_propagate::options::Convention::ALL.into_iter().map(of).collect::<PyResult<Vec<_>>>()?;
        crate::mean::periods(py, "PeriodsOfMembers", pairs)
    }

    fn __len__(&self) -> PyResult<usize> {
        let refused = || pyo3::exceptions::PyTypeError::new_err("states at a scalar time have no len()");
        self.leading.first().copied().ok_or_else(refused)
    }

    fn __repr__(&self) -> String {
        format!("<EvolvedStates at {} times>", self.states.len())
    }
}
