//! A scene of a body that is locked to an orbit: relaxed, or with free librations ([`crate::libration::relaxed`]).

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use super::scene_about_principal_axes;
use crate::error::Error;
use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::libration::lock::{Lock, MOST_IN_TWO};
use crate::libration::relaxed;
use crate::orbit::elements::Orbit;

/// Which state of a locked body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockedState {
    /// Rotations an orbit: ½, 1, 3/2, … 4.
    pub resonance: f64,
    /// The largest angle of each proper mode \[rad\], longitude first and then the two of the pole, as of [`Libration::amplitudes`](crate::libration_terms::Libration::amplitudes).
    pub amplitudes: [f64; 3],
    /// The phase of that angle at the epoch \[rad\], as of [`Libration::phases`](crate::libration_terms::Libration::phases).
    pub phases: [f64; 3],
    /// Time of the state.
    pub epoch: f64,
}

impl Default for LockedState {
    /// The relaxed state of synchronous rotation at time 0.
    fn default() -> Self {
        Self { resonance: 1.0, amplitudes: [0.0; 3], phases: [0.0; 3], epoch: 0.0 }
    }
}

impl LockedState {
    fn validate(&self) -> Result<(), Error> {
        let refused = |argument, index, value, bound| Err(Error::Number { argument, index, value, bound });
        let twice = 2.0 * self.resonance;
        if twice != twice.round() || !(1.0..=f64::from(MOST_IN_TWO)).contains(&twice) {
            return refused("resonance", None, self.resonance, "1/2, 1, 3/2, 2, 5/2, 3, 7/2 or 4 rotations an orbit");
        }
        for (index, &value) in self.amplitudes.iter().enumerate() {
            if !(value >= 0.0 && value.is_finite()) {
                return refused("amplitudes", Some(index), value, "0 or more, and finite");
            }
        }
        match self.phases.iter().position(|phase| !phase.is_finite()) {
            Some(index) => refused("phases", Some(index), self.phases[index], "finite"),
            None if !self.epoch.is_finite() => Err(Error::Epoch { value: self.epoch }),
            None => Ok(()),
        }
    }
}

impl Scene {
    /// Creates the scene of a body that is locked to an orbit: relaxed, or with free librations. Its axis of least inertia follows the disturbing body, its axis of greatest inertia is
    /// near the normal of the orbit, or near the stable Cassini state that is nearest to it if the node moves.
    ///
    /// # Errors
    /// - [`Error::Number`] for a resonance that is not ½, 1, … 4, an amplitude below 0, a number that is not finite.
    /// - [`Error::NoLibration`] for a resonance without a torque or a stable motion, and for amplitudes beyond the range of the series.
    /// - [`Error::Epoch`] for an epoch that is not finite; [`Error::Stopped`] when the flag is set.
    ///
    /// ```
    /// use std::sync::atomic::AtomicBool;
    /// use andoyer_propagate::{Body, Method, Orbit, Scene};
    /// use andoyer_propagate::libration_terms::LockedState;
    /// let orbit = Orbit::new(1.0, 0.02)?;
    /// let scene = Scene::locked(Body::new([0.3, 0.35, 0.4])?, &orbit, &LockedState::default(), &AtomicBool::new(false))?;
    /// let motion = scene.tolerance(1e-9).method(Method::Libration).solve()?;
    /// assert!(motion.libration().is_some_and(|libration| libration.amplitudes()[0] < 1e-9));
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn locked(body: Body, orbit: &Orbit, state: &LockedState, stop: &AtomicBool) -> Result<Self, Error> {
        state.validate()?;
        let no = |reason| Error::NoLibration { reason };
        let twice = (2.0 * state.resonance) as i32;
        let lock = Lock::at_rest(&Body::new(body.moments())?, orbit, twice, state.epoch).map_err(no)?;
        // An amplitude below the rounding of the attitude is none.
        let amplitudes = state.amplitudes.map(|amplitude| if amplitude < f64::EPSILON { 0.0 } else { amplitude });
        let phases = state.phases.map(|phase| phase.rem_euclid(TAU));
        let variables = relaxed::state(&lock, amplitudes, phases, stop)?.map_err(no)?;
        let (attitude, rates) = lock.attitude_and_rates(variables);
        Ok(scene_about_principal_axes(body, state.epoch, attitude, rates).disturbing([*orbit]))
    }
}
