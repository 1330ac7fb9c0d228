//! A solved motion: immutable, shared between threads, evaluated at any time.
//!
//! Evaluation is two sines and cosines (of ℓ′ and y′/2), the sums of theory §8, a normalization and two quaternion products. The rates come from
//! the same a and b: g = (−2 Im b ā, 2 Re b ā, |a|² − |b|²).

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::error::Error;
use crate::fourier::QuaternionSeries;
use crate::phase::{Phase, elapsed};
use crate::plan::Plan;
use crate::polhode::Frame;
use crate::scene::Scene;
use crate::separatrix::Passage;

/// Rotations from the epoch within which phases are good to 1e-14 rad; not far beyond, a double no longer tells one turn from the next.
const MOST_ROTATIONS: f64 = 1e15;

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
    /// Rotation about an axis fixed in the body, whose half angle grows.
    Steady { axis: Vector3<f64>, half_angle: Phase },
    /// A polhode: `inertial` and `frame` lead from the series' quaternion to that of the body.
    Polhode(Box<Wobble>),
}

/// a e^(−iy′/2) and b e^(−iy′/2) of theory §8, up to their norm, as functions of time.
#[derive(Clone, Debug)]
pub(crate) enum Pair {
    /// ℓ′ and the harmonics of it.
    Fourier(Phase, QuaternionSeries),
    /// Near the separatrix and on it.
    Passage(Passage),
}

/// What a wobbling motion is evaluated from.
#[derive(Clone, Debug)]
pub(crate) struct Wobble {
    pub(crate) pair: Pair,
    pub(crate) half_longitude: Phase,
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
        let precession = if own { longitude + anomaly } else { longitude };
        Periods { precession: std::f64::consts::TAU / precession, rotation: std::f64::consts::TAU / anomaly.abs() }
    }

    /// The angular momentum, inertial components: a constant.
    pub fn angular_momentum(&self) -> Vector3<f64> {
        self.angular_momentum
    }

    /// Attitude and rates at a time.
    ///
    /// # Errors
    /// - [`Error::Time`] for NaN, infinite, or more than 1e15 rotations from the epoch.
    pub fn at(&self, time: f64) -> Result<Sample, Error> {
        let elapsed = self.elapsed(0, time)?;
        let (attitude, angular_velocity) = self.evaluate(elapsed);
        Ok(Sample { time, attitude: UnitQuaternion::new_unchecked(attitude), angular_velocity })
    }

    /// Attitudes [x, y, z, w] at many times, without an allocation.
    ///
    /// # Errors
    /// - [`Error::Length`] for `out` shorter or longer than `times`.
    /// - [`Error::Time`] as for [`Motion::at`], with the index.
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        for ((index, &time), slot) in times.iter().enumerate().zip(out) {
            *slot = self.evaluate(self.elapsed(index, time)?).0.coords.into();
        }
        Ok(())
    }

    /// Angular velocities, body components, at many times, without an allocation.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn angular_velocities_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        for ((index, &time), slot) in times.iter().enumerate().zip(out) {
            *slot = self.evaluate(self.elapsed(index, time)?).1.into();
        }
        Ok(())
    }

    /// Angular momenta, inertial components, at many times, without an allocation.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn angular_momenta_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        for ((index, &time), slot) in times.iter().enumerate().zip(out) {
            self.elapsed(index, time)?;
            *slot = self.angular_momentum.into();
        }
        Ok(())
    }

    /// Attitudes and angular velocities at many times, without an allocation.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn samples_into(&self, times: &[f64], attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        length("attitudes", attitudes.len(), times.len())?;
        length("rates", rates.len(), times.len())?;
        for (index, &time) in times.iter().enumerate() {
            let (attitude, rate) = self.evaluate(self.elapsed(index, time)?);
            attitudes[index] = attitude.coords.into();
            rates[index] = rate.into();
        }
        Ok(())
    }

    pub(crate) fn elapsed(&self, index: usize, time: f64) -> Result<(f64, f64), Error> {
        // A body at rest, or one that turns once in 1e285 units, is still bounded: no sum of two times overflows.
        let bound = (MOST_ROTATIONS * std::f64::consts::TAU / self.frequencies.longitude).min(1e300);
        // Written so that NaN fails it.
        if (time - self.scene.state().epoch).abs() <= bound {
            Ok(elapsed(time, self.scene.state().epoch))
        } else {
            Err(Error::Time { index, value: time, bound })
        }
    }

    pub(crate) fn evaluate(&self, elapsed: (f64, f64)) -> (Quaternion<f64>, Vector3<f64>) {
        match &self.course {
            Course::Steady { axis, half_angle } => {
                let (sine, cosine) = half_angle.angle(elapsed).sin_cos();
                let turn = Quaternion::from_parts(cosine, axis * sine);
                let state = self.scene.state();
                (state.attitude.into_inner() * turn, state.angular_velocity)
            }
            Course::Polhode(wobble) => wobble.evaluate(elapsed),
        }
    }
}

impl Wobble {
    fn evaluate(&self, elapsed: (f64, f64)) -> (Quaternion<f64>, Vector3<f64>) {
        let (a, b, lead) = match &self.pair {
            Pair::Fourier(anomaly, series) => {
                let (a, b) = series.evaluate(anomaly.angle(elapsed));
                (a, b, 0.0)
            }
            Pair::Passage(passage) => passage.evaluate(elapsed),
        };
        let scale = 1.0 / (a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]).sqrt();
        let (a, b) = (a.map(|c| c * scale), b.map(|c| c * scale));
        // g is free of y: it cancels in b ā.
        let direction = [
            2.0 * (b[0] * a[1] - b[1] * a[0]),
            2.0 * (b[0] * a[0] + b[1] * a[1]),
            a[0] * a[0] + a[1] * a[1] - b[0] * b[0] - b[1] * b[1],
        ];
        let rates = self.frame.user(std::array::from_fn(|i| self.rates[i] * direction[i]));
        let (sine, cosine) = (self.half_longitude.angle(elapsed) + lead).sin_cos();
        let relative = Quaternion::new(
            a[0] * cosine - a[1] * sine,
            b[0] * cosine - b[1] * sine,
            b[0] * sine + b[1] * cosine,
            a[0] * sine + a[1] * cosine,
        );
        let attitude = self.inertial.into_inner() * relative * self.frame.quaternion.into_inner();
        (attitude, Vector3::from(rates))
    }
}

pub(crate) fn length(argument: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Length { argument, found, expected }) }
}
