//! A solved motion. It is immutable, can be shared between threads, and can be evaluated at any time.
//!
//! An evaluation of a wobble takes two sines and cosines (of ℓ′ and y′/2), the sums of theory §8, a normalization and a constant map: see [`super::trajectory`].

use std::sync::Arc;

use nalgebra::{UnitQuaternion, Vector3};

use super::forced::End;
use super::plan::Plan;
use super::trajectory::Trajectory;
use crate::error::Error;
use crate::input::options::Convention;
use crate::input::scene::Scene;
use crate::input::state::State;

/// Largest number of rotations from the epoch, within which phases are accurate to 1e-14 rad. Not far beyond, a double no longer distinguishes one turn from
/// the next.
const MOST_ROTATIONS: f64 = 1e15;

/// Largest time. The sum of two such times does not overflow.
const LONGEST: f64 = 1e300;

/// Attitude and angular velocity at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The time.
    pub time: f64,
    /// Rotation from body components to inertial components.
    pub attitude: UnitQuaternion<f64>,
    /// Angular velocity, body components [rad per unit of time].
    pub angular_velocity: Vector3<f64>,
}

/// Mean frequencies of a motion [rad per unit of time].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Frequencies {
    /// dℓ′/dt, the motion along the polhode in the body. It is negative in the long-axis mode and 0 on the separatrix.
    pub anomaly: f64,
    /// dy′/dt, the rotation: y = μ + ν, or y = μ − ν for N < 0, where axis 3 of the theory is opposite to the body's.
    pub longitude: f64,
}

/// A pair of mean periods [unit of time]: of the precession about the angular momentum, and of the rotation or oscillation about the body's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Periods {
    /// P_φ, the period of the precession of the axis.
    pub precession: f64,
    /// P_ψ, the period of the rotation about the axis or of its oscillation.
    pub rotation: f64,
}

/// A scene about axes that are not the principal axes of its body.
#[derive(Clone, Debug)]
pub(crate) struct Given {
    pub(crate) scene: Scene,
    /// Rotation from components about principal axes to components about the user's axes.
    pub(crate) turn: UnitQuaternion<f64>,
}

impl Given {
    /// Transforms attitudes and rates from the principal axes to the user's axes.
    pub(crate) fn turn(&self, attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) {
        let back = self.turn.inverse();
        for attitude in attitudes {
            *attitude = (UnitQuaternion::new_unchecked((*attitude).into()) * back).coords.into();
        }
        let matrix = self.turn.to_rotation_matrix();
        for rate in rates {
            *rate = (matrix * Vector3::from(*rate)).into();
        }
    }
}

/// A solved motion.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The scene about principal axes.
    pub(crate) scene: Scene,
    /// The scene as given, if its axes are not the principal axes.
    pub(crate) given: Option<Box<Given>>,
    pub(crate) plan: Plan,
    pub(crate) trajectory: Trajectory,
    pub(crate) frequencies: Frequencies,
    /// dy′/dt + dℓ′/dt, added before rounding: for a thin needle the two nearly cancel.
    pub(crate) precession: f64,
    /// Whether axis 3 of the theory is the axis of least inertia.
    pub(crate) long_axis: bool,
    /// The angular momentum at the epoch, in inertial components.
    pub(crate) angular_momentum: Vector3<f64>,
}

impl Motion {
    /// The scene that was solved.
    pub fn scene(&self) -> &Scene {
        self.given.as_ref().map_or(&self.scene, |given| &given.scene)
    }

    /// The evaluation plan: the formulas that are used, and the reasons.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Its memory in bytes, to some kilobytes; that of a motion under a torque grows while times are evaluated.
    pub(crate) fn memory(&self) -> usize {
        size_of::<Self>() + self.trajectory.memory()
    }

    /// The same motion in less memory, if nobody else has it. Its evaluation may take longer.
    pub(crate) fn compact(mut self) -> Self {
        if let Trajectory::Forced(motion) = &mut self.trajectory
            && let Some(motion) = Arc::get_mut(motion)
        {
            motion.compact();
        }
        self
    }

    /// The motion before it was made compact, to the bit.
    pub(crate) fn whole(mut self) -> Self {
        if let Trajectory::Forced(motion) = &mut self.trajectory
            && let Some(whole) = motion.whole()
        {
            *motion = whole;
        }
        self
    }

    /// The mean frequencies [rad per unit of time]; 0 if the motion has none.
    pub fn frequencies(&self) -> Frequencies {
        self.frequencies
    }

    /// Mean periods in the long-axis convention of radar papers: P_φ of the precession of the long axis, and P_ψ of the rotation about it or, in the short-axis
    /// mode, of its oscillation. A period that does not exist is infinite.
    pub fn long_axis_periods(&self) -> Periods {
        self.periods(self.long_axis)
    }

    /// Mean periods in the short-axis convention, which is that of Andoyer variables: P_φ of the precession of the short axis, and P_ψ of the rotation about it
    /// or, in the long-axis mode, of its oscillation. In the short-axis mode μ turns with dy′/dt + dℓ′/dt, and ν with −dℓ′/dt (for N < 0 with +dℓ′/dt).
    pub fn short_axis_periods(&self) -> Periods {
        self.periods(!self.long_axis)
    }

    /// Mean periods in the extremal-axis convention of light-curve papers (Pravec et al. 2014): those of the short axis in the short-axis mode, and of the long
    /// axis in the long-axis mode. The body makes complete turns about this axis.
    pub fn extremal_axis_periods(&self) -> Periods {
        self.periods(true)
    }

    /// Mean periods in one of the three conventions.
    pub fn periods_of(&self, convention: Convention) -> Periods {
        match convention {
            Convention::ExtremalAxis => self.extremal_axis_periods(),
            Convention::LongAxis => self.long_axis_periods(),
            Convention::ShortAxis => self.short_axis_periods(),
        }
    }

    /// The periods of axis 3 of the theory if `own`, otherwise those of axis 1, whose precession is y′.
    fn periods(&self, own: bool) -> Periods {
        let Frequencies { anomaly, longitude } = self.frequencies;
        let precession = if own { self.precession } else { longitude };
        Periods { precession: std::f64::consts::TAU / precession, rotation: std::f64::consts::TAU / anomaly.abs() }
    }

    /// The angular momentum at the epoch in inertial components, with that of rotors. It is constant without an orbit and other torques.
    pub fn angular_momentum(&self) -> Vector3<f64> {
        self.angular_momentum
    }

    /// Attitude and rates at a time.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// // Rotation about axis 3 with 2 rad per unit of time.
    /// assert!((motion.at(0.5)?.attitude.angle() - 1.0).abs() < 1e-14);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Time`] for a time that is NaN, infinite, or more than 1e15 rotations from the epoch. For a scene averaged over the spin, also for a time more
    ///   than 65,534 orbits from the epoch, or than 262,144 arcs with several bodies or an orbit that precesses; for an integrated motion, also for a time
    ///   outside the span.
    pub fn at(&self, time: f64) -> Result<Sample, Error> {
        let (mut attitude, mut rates) = ([[0.0; 4]], [[0.0; 3]]);
        self.batch().samples_into(&[time], &mut attitude, &mut rates)?;
        let attitude = UnitQuaternion::new_unchecked(attitude[0].into());
        Ok(Sample { time, attitude, angular_velocity: rates[0].into() })
    }

    /// The scene of the state at a time, with that time as its epoch: the same body, disturbing bodies and options.
    ///
    /// Its motion starts with the errors of attitude and rates at that time: after a time t it may differ by t times [`Plan::rate_error_bound`].
    ///
    /// After a torque its motion has the periods of that time. The frequencies of an integrated motion are those of the free motion at the epoch.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// let later = motion.scene_at(100.0)?;
    /// assert!(later.state().epoch == 100.0 && later.solve()?.at(150.0)?.attitude.angle_to(&motion.at(150.0)?.attitude) < 1e-13);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Motion::at`].
    pub fn scene_at(&self, time: f64) -> Result<Scene, Error> {
        let Sample { time: epoch, attitude, angular_velocity } = self.at(time)?;
        self.scene().with_state(State { epoch, attitude, angular_velocity }).into_validated()
    }

    /// The attitudes [x, y, z, w] at many times. [`Motion::attitudes_into`] writes them to a slice.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// let [_, half] = motion.attitudes(&[0.0, std::f64::consts::PI])?[..] else { unreachable!() };
    /// assert!((half[2] - 1.0).abs() < 1e-15); // half a turn about axis 3
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Time`] as for [`Motion::at`], with the index of the time.
    pub fn attitudes(&self, times: &[f64]) -> Result<Vec<[f64; 4]>, Error> {
        let mut attitudes = vec![[0.0; 4]; times.len()];
        self.attitudes_into(times, &mut attitudes).map(|()| attitudes)
    }

    /// Writes the attitudes [x, y, z, w] at many times to `out`, without an allocation.
    ///
    /// # Errors
    /// - [`Error::Length`] if `out` and `times` have different lengths.
    /// - [`Error::Time`] as for [`Motion::at`], with the index of the time.
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<(), Error> {
        self.batch().attitudes_into(times, out)
    }

    /// Writes the angular velocities in body components [rad per unit of time] at many times to `out`, without an allocation.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn angular_velocities_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        self.batch().angular_velocities_into(times, out)
    }

    /// Writes the angular momenta in inertial components at many times to `out`, without an allocation.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn angular_momenta_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        self.batch().angular_momenta_into(times, out)
    }

    /// Writes the attitudes and the angular velocities at many times, without an allocation.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn samples_into(&self, times: &[f64], attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        self.batch().samples_into(times, attitudes, rates)
    }

    /// The largest times before (negative) and after the epoch that can be evaluated.
    pub(crate) fn reach(&self) -> [f64; 2] {
        let [(before, _), (after, _)] = self.ends();
        [-before, after]
    }

    /// The reach for times in the scale of `epoch`, which is that of the scene or 0. Times that count from the epoch have more digits than the ends of the span,
    /// which were rounded as sums with the epoch: an end may be later by this rounding.
    pub(crate) fn reach_from(&self, epoch: f64) -> [f64; 2] {
        let [least, most] = self.reach();
        let of_scene = self.scene.state().epoch;
        match &self.trajectory {
            Trajectory::Forced(_) if epoch != of_scene => {
                let rounding = f64::EPSILON * (of_scene.abs() + least.abs().max(most));
                [least - rounding, most + rounding]
            }
            _ => [least, most],
        }
    }

    /// The largest times before and after the epoch that can be evaluated, and the reasons for the bounds.
    fn ends(&self) -> [End; 2] {
        // The time is also bounded for a body at rest, or for one that turns once in 1e285 units, so that no sum of two times overflows.
        let phases = MOST_ROTATIONS * std::f64::consts::TAU / self.frequencies.longitude;
        let phases = if phases < LONGEST { (phases, ": farther away the motion has no phase") } else { (LONGEST, "") };
        match &self.trajectory {
            Trajectory::Forced(motion) => motion.ends(phases),
            _ => [phases; 2],
        }
    }

    /// Checks that all times have a phase; `epoch` is in the same scale as the times.
    pub(crate) fn valid(&self, times: &[f64], epoch: f64) -> Result<(), Error> {
        let [least, most] = self.reach_from(epoch);
        // This condition is false for NaN.
        let valid = |time: &f64| least <= time - epoch && time - epoch <= most;
        match times.iter().position(|time| !valid(time)) {
            Some(index) => Err(self.no_phase(index, times, epoch)),
            None => Ok(()),
        }
    }

    pub(crate) fn no_phase(&self, index: usize, times: &[f64], epoch: f64) -> Error {
        // Of a time that is NaN the end after the epoch.
        let [before, after] = self.ends();
        let (bound, reason) = if times[index] < epoch { before } else { after };
        self.too_far((index, times[index]), epoch, bound, reason)
    }

    /// The error of a time that is more than `bound` from the epoch; `epoch` is in the scale of the time.
    pub(crate) fn too_far(&self, (index, value): (usize, f64), epoch: f64, bound: f64, reason: &'static str) -> Error {
        let shift = epoch - self.scene.state().epoch;
        let span = self.scene.asked_span().map(|(start, stop)| [start + shift, stop + shift]);
        Error::Time { index, value, epoch, span, bound, reason }
    }
}

pub(crate) fn length(argument: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Length { argument, found, expected }) }
}
