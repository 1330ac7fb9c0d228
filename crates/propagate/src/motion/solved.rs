//! A solved motion: immutable, shared between threads, evaluated at any time.
//!
//! Evaluation is two sines and cosines (of ℓ′ and y′/2), the sums of theory §8, a normalization and a constant map: see [`super::trajectory`].

use nalgebra::{UnitQuaternion, Vector3};

use super::plan::Plan;
use super::trajectory::Trajectory;
use crate::error::Error;
use crate::input::options::Convention;
use crate::input::scene::Scene;

/// Rotations from the epoch within which phases are good to 1e-14 rad; not far beyond, a double no longer tells one turn from the next.
const MOST_ROTATIONS: f64 = 1e15;

/// No sum of two times this long overflows.
const LONGEST: f64 = 1e300;

/// Why a motion averaged over the spin ends.
const SOLVED: &str =
    ": averaging = spin solves the averaged equations no farther; averaging over the orbit has no such bound";

/// Attitude and angular velocity at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The time.
    pub time: f64,
    /// Rotation of body components into inertial ones.
    pub attitude: UnitQuaternion<f64>,
    /// Angular velocity, body components [rad per unit of time].
    pub angular_velocity: Vector3<f64>,
}

/// Mean frequencies of a motion [rad per unit of time].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// dℓ′/dt: the polhode, in the body; negative in the long-axis mode, 0 on the separatrix.
    pub anomaly: f64,
    /// dy′/dt: the rotation, y = μ + ν (y = μ − ν for N < 0, where the theory's axis 3 is the body's turned over).
    pub longitude: f64,
}

/// A pair of mean periods: of the precession about the angular momentum and of the rotation or oscillation about the body's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periods {
    /// P_φ, of the precession of the axis.
    pub precession: f64,
    /// P_ψ, about the axis.
    pub rotation: f64,
}

/// A scene about axes that are not the principal ones of its body.
#[derive(Clone, Debug)]
pub(crate) struct Given {
    pub(crate) scene: Scene,
    /// Rotation of components about principal axes into the user's.
    pub(crate) turn: UnitQuaternion<f64>,
}

impl Given {
    /// Brings attitudes and rates about principal axes to the user's.
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
    /// The scene as given, where its axes are others.
    pub(crate) given: Option<Box<Given>>,
    pub(crate) plan: Plan,
    pub(crate) trajectory: Trajectory,
    pub(crate) frequencies: Frequencies,
    /// dy′/dt + dℓ′/dt, summed before it is rounded: for a needle the two nearly cancel.
    pub(crate) precession: f64,
    /// Whether the theory's axis 3 is that of least inertia.
    pub(crate) long_axis: bool,
    /// Inertial components.
    pub(crate) angular_momentum: Vector3<f64>,
}

impl Motion {
    /// The scene that was solved.
    pub fn scene(&self) -> &Scene {
        self.given.as_ref().map_or(&self.scene, |given| &given.scene)
    }

    /// What is evaluated, and why.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The mean frequencies; 0 where the motion has none.
    pub fn frequencies(&self) -> Frequencies {
        self.frequencies
    }

    /// Mean periods in the long-axis convention: P_φ of the precession of the long axis, P_ψ of the rotation about it or, in the short-axis mode, of its
    /// oscillation; infinite where there is none. Radar papers use it.
    pub fn long_axis_periods(&self) -> Periods {
        self.periods(self.long_axis)
    }

    /// Mean periods in the short-axis convention, that of Andoyer variables: P_φ of the precession of the short axis, P_ψ of the rotation about it or, in the
    /// long-axis mode, of its oscillation; in the short-axis mode μ turns with dy′/dt + dℓ′/dt and ν with −dℓ′/dt (for N < 0 with +dℓ′/dt).
    pub fn short_axis_periods(&self) -> Periods {
        self.periods(!self.long_axis)
    }

    /// Mean periods in the extremal-axis convention, that of light-curve papers (Pravec et al. 2014): those of the short axis in the short-axis mode, of the
    /// long axis in the long-axis mode. The body turns all the way round this axis.
    pub fn extremal_axis_periods(&self) -> Periods {
        self.periods(true)
    }

    /// Mean periods in a convention.
    pub fn periods_of(&self, convention: Convention) -> Periods {
        match convention {
            Convention::ExtremalAxis => self.extremal_axis_periods(),
            Convention::LongAxis => self.long_axis_periods(),
            Convention::ShortAxis => self.short_axis_periods(),
        }
    }

    /// Periods of the theory's axis 3, or of its axis 1, which is carried around by y′.
    fn periods(&self, own: bool) -> Periods {
        let Frequencies { anomaly, longitude } = self.frequencies;
        let precession = if own { self.precession } else { longitude };
        Periods { precession: std::f64::consts::TAU / precession, rotation: std::f64::consts::TAU / anomaly.abs() }
    }

    /// The angular momentum at the epoch, inertial components: a constant unless there is an orbit.
    pub fn angular_momentum(&self) -> Vector3<f64> {
        self.angular_momentum
    }

    /// Attitude and rates at a time.
    ///
    /// # Errors
    /// - [`Error::Time`] for NaN, infinite, more than 1e15 rotations from the epoch, or where the scene is averaged over the spin more than 65,534 orbits from it.
    pub fn at(&self, time: f64) -> Result<Sample, Error> {
        let (mut attitude, mut rates) = ([[0.0; 4]], [[0.0; 3]]);
        self.batch().samples_into(&[time], &mut attitude, &mut rates)?;
        let attitude = UnitQuaternion::new_unchecked(attitude[0].into());
        Ok(Sample { time, attitude, angular_velocity: rates[0].into() })
    }

    /// Attitudes [x, y, z, w] at many times, without an allocation.
    ///
    /// # Errors
    /// - [`Error::Length`] for `out` shorter or longer than `times`.
    /// - [`Error::Time`] as for [`Motion::at`], with the index.
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<(), Error> {
        self.batch().attitudes_into(times, out)
    }

    /// Angular velocities, body components, at many times, without an allocation.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn angular_velocities_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        self.batch().angular_velocities_into(times, out)
    }

    /// Angular momenta, inertial components, at many times, without an allocation.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn angular_momenta_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        self.batch().angular_momenta_into(times, out)
    }

    /// Attitudes and angular velocities at many times, without an allocation.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn samples_into(&self, times: &[f64], attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        self.batch().samples_into(times, attitudes, rates)
    }

    /// The largest distance from the epoch that is evaluated.
    pub(crate) fn bound(&self) -> f64 {
        self.reach().0
    }

    /// The largest distance from the epoch that is evaluated, and why there is one.
    fn reach(&self) -> (f64, &'static str) {
        // A body at rest, or one that turns once in 1e285 units, is still bounded, so that no sum of two times overflows.
        let phases = MOST_ROTATIONS * std::f64::consts::TAU / self.frequencies.longitude;
        let phases = if phases < LONGEST { (phases, ": farther away the motion has no phase") } else { (LONGEST, "") };
        match &self.trajectory {
            Trajectory::Gradient(gradient) if gradient.bound() < phases.0 => (gradient.bound(), SOLVED),
            _ => phases,
        }
    }

    /// Whether all times, counted as this epoch is, have a phase.
    pub(crate) fn valid(&self, times: &[f64], epoch: f64) -> Result<(), Error> {
        let bound = self.bound();
        // Written so that NaN fails it.
        let valid = |time: &f64| (time - epoch).abs() <= bound;
        match times.iter().position(|time| !valid(time)) {
            Some(index) => Err(self.no_phase(index, times)),
            None => Ok(()),
        }
    }

    pub(crate) fn no_phase(&self, index: usize, times: &[f64]) -> Error {
        let (bound, reason) = self.reach();
        Error::Time { index, value: times[index], bound, reason }
    }
}

pub(crate) fn length(argument: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Length { argument, found, expected }) }
}
