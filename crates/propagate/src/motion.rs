//! A solved motion: immutable, shared between threads, evaluated at any time.
//!
//! Evaluation is two sines and cosines (of ℓ′ and y′/2), the sums of theory §8, a normalization and a constant map: see [`crate::kernel`].

use nalgebra::{UnitQuaternion, Vector3};

use crate::batch::Batch;
use crate::error::Error;
use crate::fourier::QuaternionSeries;
use crate::gradient::Gradient;
use crate::kernel::steady::Steady;
use crate::kernel::wobble::Tables;
use crate::phase::Phase;
use crate::plan::Plan;
use crate::polhode::Frame;
use crate::scene::Scene;
use crate::separatrix::Flip;
use crate::state::State;

/// Rotations from the epoch within which phases are good to 1e-14 rad; not far beyond, a double no longer tells one turn from the next.
const MOST_ROTATIONS: f64 = 1e15;

/// No sum of two times this long overflows.
pub(crate) const LONGEST: f64 = 1e300;
/// Why a time has a bound.
const NO_PHASE: &str = ": farther away the motion has no phase";
const TOO_MANY_ORBITS: &str = ": averaged over the spin, the motion is solved for 65,534 orbits on either side; averaged over the orbit, for any number";

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

/// How a motion goes on from its epoch.
#[derive(Clone, Debug)]
pub(crate) enum Course {
    /// Rotation about an axis fixed in the body.
    Steady(Box<Steady>),
    /// A polhode.
    Polhode(Box<Tables>),
    /// A polhode next to the separatrix or on it.
    Flip(Box<Flip>),
    /// Any of them under a gravity gradient.
    Gradient(Box<Gradient>),
}

impl Course {
    /// Rotation about a unit axis of the body, or the zero vector for none, with the phase of half the angle.
    pub(crate) fn steady(state: &State, axis: Vector3<f64>, half_angle: Phase) -> Self {
        Self::Steady(Box::new(Steady::new(axis, half_angle, state.attitude, state.angular_velocity)))
    }

    /// A wobble, with what its evaluation takes from it.
    pub(crate) fn polhode(wobble: &Wobble) -> Self {
        Self::Polhode(Box::new(Tables::new(wobble)))
    }
}

/// A wobble.
#[derive(Clone, Debug)]
pub(crate) struct Wobble {
    pub(crate) anomaly: Phase,
    pub(crate) series: QuaternionSeries,
    pub(crate) half_longitude: Phase,
    pub(crate) place: Place,
}

/// What leads from the pair (a, b) to the body: the attitude is inertial · (a, b) · frame.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub(crate) inertial: UnitQuaternion<f64>,
    pub(crate) frame: Frame,
    /// M over each moment, on the sorted axes.
    pub(crate) rates: Vector3<f64>,
}

/// A solved motion.
#[derive(Clone, Debug)]
pub struct Motion {
    pub(crate) scene: Scene,
    pub(crate) plan: Plan,
    pub(crate) course: Course,
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
        &self.scene
    }

    /// What is evaluated, and why.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The mean frequencies; 0 where the motion has none.
    pub fn frequencies(&self) -> Frequencies {
        self.frequencies
    }

    /// Mean periods in the long-axis convention, that of light curves: P_φ of the precession of the long axis, P_ψ of the rotation about it or, in the
    /// short-axis mode, of its oscillation (Kaasalainen 2001); infinite where there is none.
    pub fn long_axis_periods(&self) -> Periods {
        self.periods(self.long_axis)
    }

    /// Mean periods in the short-axis convention, that of Andoyer variables: P_φ of the precession of the short axis, P_ψ of the rotation about it or, in the
    /// long-axis mode, of its oscillation; in the short-axis mode μ turns with dy′/dt + dℓ′/dt and ν with −dℓ′/dt (for N < 0 with +dℓ′/dt).
    pub fn short_axis_periods(&self) -> Periods {
        self.periods(!self.long_axis)
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
    /// - [`Error::Time`] for NaN, infinite, or more than 1e15 rotations from the epoch.
    pub fn at(&self, time: f64) -> Result<Sample, Error> {
        let (mut attitude, mut rates) = ([[0.0; 4]], [[0.0; 3]]);
        self.batch().samples_into(&[time], &mut attitude, &mut rates)?;
        let attitude = UnitQuaternion::new_unchecked(attitude[0].into());
        Ok(Sample { time, attitude, angular_velocity: rates[0].into() })
    }

    /// How many times at once are evaluated: on as many threads as pay, unless told otherwise.
    pub fn batch(&self) -> Batch<'_> {
        Batch::new(self)
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
        length("out", out.len(), times.len())?;
        self.valid(times)?;
        if let Course::Gradient(gradient) = &self.course {
            gradient.angular_momenta(times, self.scene.state().epoch, out);
        } else {
            out.fill(self.angular_momentum.into());
        }
        Ok(())
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
        self.bound_and_reason().0
    }

    /// That distance, and why it is one.
    fn bound_and_reason(&self) -> (f64, &'static str) {
        // A body at rest, or one that turns once in 1e285 units, is still bounded.
        let phases = (MOST_ROTATIONS * std::f64::consts::TAU / self.frequencies.longitude).min(LONGEST);
        match &self.course {
            Course::Gradient(gradient) if gradient.bound() < phases => (gradient.bound(), TOO_MANY_ORBITS),
            _ if phases < LONGEST => (phases, NO_PHASE),
            _ => (phases, ""),
        }
    }

    fn valid(&self, times: &[f64]) -> Result<(), Error> {
        let (epoch, bound) = (self.scene.state().epoch, self.bound());
        // Written so that NaN fails it.
        let valid = |time: &f64| (time - epoch).abs() <= bound;
        match times.iter().position(|time| !valid(time)) {
            Some(index) => Err(self.no_phase(index, times)),
            None => Ok(()),
        }
    }

    pub(crate) fn no_phase(&self, index: usize, times: &[f64]) -> Error {
        let (bound, reason) = self.bound_and_reason();
        Error::Time { index, value: times[index], bound, reason }
    }
}

pub(crate) fn length(argument: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Length { argument, found, expected }) }
}
