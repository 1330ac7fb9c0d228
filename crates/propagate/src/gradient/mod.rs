//! Rotation under the gravity gradient of a body on a Keplerian orbit (theory §9).
//!
//! The mean motion is the free one at the mean σ and M, in an invariable frame that the averaged torque carries along ([`slow`]); short-period [`corrections`] of
//! first order lead from it to the motion. Each is regular at J = 0 and at any inclination. Validity: rotation much faster than the orbit, torque weak; a divisor that is too
//! small is [`Error::Resonance`]. What is left is of second order in the torque, and grows with time.

mod corrections;
mod inertia;
mod level;
mod slow;

pub use level::Level;

use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

use andoyer_series::DoubleDouble;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use num_complex::Complex;

use crate::error::Error;
use crate::orbit::{Orbit, Place};
use crate::phase::Phase;
use crate::plan::GradientPlan;
use crate::polhode::{Frame, Polhode, scaled};
use corrections::{Change, Corrections, Mean};
use inertia::Inertia;
use slow::{Ellipse, MOST_QUARTERS, Precession, Slow, Spin, When};

type C64 = Complex<f64>;

/// Changes of the mean variables below which they are converged.
const CONVERGED: f64 = 1e-15;
/// Torque over M²/C above which an expansion in it has no first order.
pub(crate) const STRONGEST: f64 = 0.02;

/// How far the equations are averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Averaging {
    /// Whatever meets the tolerance at the lowest cost.
    #[default]
    Auto,
    /// Over rotation and orbit: formulas.
    Orbit,
    /// Over the rotation: the averaged equations are solved quarter by quarter of the orbit.
    Spin,
}

impl FromStr for Averaging {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "auto" => Ok(Self::Auto),
            "orbit" => Ok(Self::Orbit),
            "spin" => Ok(Self::Spin),
            _ => Err(Error::Averaging { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for Averaging {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Orbit => "orbit",
            Self::Spin => "spin",
        })
    }
}

/// A motion under the gravity gradient.
#[derive(Clone, Debug)]
pub(crate) struct Gradient {
    inertia: Inertia,
    corrections: Corrections,
    slow: Slow,
    anomaly: Phase,
    longitude: Phase,
    mean_anomaly: Phase,
    eccentricity: f64,
    root: f64,
    /// J times these is added to ℓ′ and y′.
    drifts: [f64; 2],
    frame: Frame,
    moments: [f64; 3],
    level: Level,
    /// Units of the motion: time, rate and angular momentum over the user's.
    units: [f64; 3],
    pub(crate) error: f64,
}

/// Attitude, body rates and inertial angular momentum.
pub(crate) type Instant = ([f64; 4], [f64; 3], [f64; 3]);

/// What is asked of the perturbed motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    pub(crate) orbit: &'a Orbit,
    pub(crate) averaging: Averaging,
    pub(crate) level: Level,
    pub(crate) tolerance: f64,
    pub(crate) epoch: f64,
    /// Longest time from the epoch, in the user's unit.
    pub(crate) duration: f64,
}

impl Gradient {
    /// From a polhode, the attitude at the epoch and where the state is on the polhode (ℓ′ and y′ − y there).
    pub(crate) fn new(
        polhode: &Polhode,
        attitude: UnitQuaternion<f64>,
        osculating: (f64, [f64; 2]),
        request: &Request<'_>,
    ) -> Result<Self, Error> {
        let exponent = polhode.scales.1;
        let orbit = request.orbit;
        let mean_motion = scaled(orbit.mean_motion(), -exponent);
        let momentum = polhode.momentum.to_f64();
        let [_, _, third] = polhode.moments;
        let size = 1.5 * (mean_motion / (momentum / third)).powi(2) * orbit.disturbing_fraction()
            / (1.0 - orbit.eccentricity()).powi(3);
        if size > STRONGEST {
            return Err(Error::TorqueTooStrong { size, bound: STRONGEST });
        }
        let mean_anomaly = orbit.mean_anomaly(request.epoch);
        let start = when(&mean_anomaly, (0.0, 0.0), orbit.eccentricity());
        let (sigma, [anomaly, longitude]) = osculating;
        let state = Mean {
            p: C64::from_polar(sigma.sqrt(), anomaly),
            longitude,
            momentum,
            frame: invariable_frame(polhode, attitude),
        };
        let (mean, inertia, corrections) = mean_motion_of(polhode, &state, &start, mean_motion, request)?;
        let (axial, axial_slope) = request.level.axial(&inertia);
        let fraction = orbit.disturbing_fraction();
        let delta = (1.5 * axial - 0.5 * polhode.moments.iter().sum::<f64>()) * fraction;
        let ellipse = Ellipse::new(orbit, mean_motion, delta / mean.momentum);
        let [anomaly_rate, longitude_rate] = inertia.rates;
        let spin_rate = longitude_rate.to_f64();
        let duration = scaled(request.duration, exponent);
        let budget =
            Budget { corrections: corrections.size, strength: ellipse.strength(), spin_rate, mean_motion, duration };
        let by_orbit = match request.averaging {
            Averaging::Orbit => true,
            Averaging::Spin => false,
            Averaging::Auto => budget.of_the_orbit() <= request.tolerance,
        };
        let error = budget.of_the_spin()
            + if by_orbit { budget.of_the_orbit() } else { 0.0 }
            + corrections.dropped
            + 2.0 * corrections.rest;
        let slow = if by_orbit {
            Slow::Orbit(Precession::new(ellipse, mean.frame, &start))
        } else {
            Slow::Spin(Box::new(Spin::new(ellipse, mean.frame, &start)))
        };
        // ⟨D⟩ = −½ (dJ/dt) Δ: its derivatives with respect to L and M at fixed L.
        let slope = -0.5 * 1.5 * axial_slope * fraction / mean.momentum;
        let user =
            |rate: DoubleDouble| DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) };
        Ok(Self {
            anomaly: Phase::new(user(anomaly_rate), mean.p.arg()),
            longitude: Phase::new(user(longitude_rate), mean.longitude),
            mean_anomaly,
            eccentricity: orbit.eccentricity(),
            root: mean.p.norm(),
            drifts: [slope, -slope * inertia.sigma],
            inertia,
            corrections,
            slow,
            frame: polhode.frame.clone(),
            moments: polhode.moments,
            level: request.level,
            units: [scaled(1.0, exponent), scaled(1.0, exponent), polhode.user_momentum() / momentum],
            error,
        })
    }

    /// Mean rates of ℓ′ and y′ in the user's unit.
    pub(crate) fn frequencies(&self) -> [f64; 2] {
        [self.anomaly.frequency() * TAU, self.longitude.frequency() * TAU]
    }

    /// The longest time from the epoch that quarters are kept for, in the user's unit.
    pub(crate) fn bound(&self) -> f64 {
        match self.slow {
            Slow::Spin(_) => (MOST_QUARTERS / 4 - 2) as f64 / self.mean_anomaly.frequency(),
            Slow::Orbit(_) => f64::INFINITY,
        }
    }

    /// What the plan says of it.
    pub(crate) fn plan(&self) -> GradientPlan {
        GradientPlan {
            averaging: match self.slow {
                Slow::Spin(_) => Averaging::Spin,
                Slow::Orbit(_) => Averaging::Orbit,
            },
            level: self.level,
            terms: self.corrections.count(),
            size: self.corrections.size,
        }
    }

    /// What this scene did not need.
    pub(crate) fn skipped(&self) -> Vec<String> {
        let mut skipped = Vec::new();
        if self.corrections.dropped > 0.0 {
            skipped
                .push(format!("short-period terms: those dropped are {:.1e} rad together", self.corrections.dropped));
        }
        if self.eccentricity == 0.0 {
            skipped.push("Kepler's equation: the orbit is a circle".to_owned());
        }
        skipped
    }

    /// The mean variables and the changes that lead from them to the motion.
    fn variables(&self, elapsed: (f64, f64)) -> (Mean, Change) {
        let when = when(&self.mean_anomaly, elapsed, self.eccentricity);
        let (frame, phase) = self.slow.at(&when);
        let anomaly = self.anomaly.angle(elapsed) + self.drifts[0] * phase;
        let longitude = self.longitude.angle(elapsed) + self.drifts[1] * phase;
        let mean = Mean { p: C64::from_polar(self.root, anomaly), longitude, momentum: self.inertia.momentum, frame };
        (mean, self.corrections.at(&mean, &when.place))
    }

    /// Attitude and rates a time after the epoch.
    pub(crate) fn attitude_and_rates(&self, elapsed: (f64, f64)) -> ([f64; 4], [f64; 3]) {
        let (attitude, rates, _) = self.at(elapsed);
        (attitude, rates)
    }

    /// The motion at a time after the epoch.
    pub(crate) fn at(&self, elapsed: (f64, f64)) -> Instant {
        let (mean, change) = self.variables(elapsed);
        let state = mean.changed(&change, 1.0);
        let relative = self.relative(&state);
        let sorted = state.frame.into_inner() * relative;
        let attitude = sorted * self.frame.quaternion.into_inner();
        let direction = state.frame * Vector3::z();
        let body = UnitQuaternion::new_normalize(sorted).inverse() * direction;
        let rate = self.units[1] * state.momentum;
        let rates = self.frame.user(std::array::from_fn(|i| rate * body[i] / self.moments[i]));
        let attitude = attitude.coords / attitude.coords.norm();
        (attitude.into(), rates, (direction * (state.momentum * self.units[2])).into())
    }

    /// The quaternion of theory §8 of a state near the mean one.
    fn relative(&self, state: &Mean) -> Quaternion<f64> {
        let beyond = state.p.norm_sqr() - self.inertia.sigma;
        let powers = powers(state.p);
        let [a, b] = self.inertia.pair.each_ref().map(|series| {
            let terms = series.values.iter().zip(&series.slopes).zip(&powers);
            terms.map(|((value, slope), power)| (value + slope * beyond) * power).sum::<C64>()
        });
        let turn = C64::from_polar(1.0, 0.5 * state.longitude);
        let (a, b) = (a * turn, b * turn);
        Quaternion::new(a.re, b.re, b.im, a.im).normalize()
    }
}

/// P_h for all h.
fn powers(p: C64) -> Vec<C64> {
    let highest = inertia::HIGHEST;
    let mut powers = vec![C64::new(1.0, 0.0); 2 * highest + 1];
    for h in 1..=highest {
        powers[highest + h] = powers[highest + h - 1] * p;
        powers[highest - h] = powers[highest + h].conj();
    }
    powers
}

/// Where the disturbing body is a time after the epoch.
fn when(mean_anomaly: &Phase, elapsed: (f64, f64), eccentricity: f64) -> When {
    let (turns, angle) = mean_anomaly.turns_and_angle(elapsed);
    When { turns, place: Place::of(angle, eccentricity), mean_anomaly: angle }
}

/// The frame of theory §8 at a state: axis 3 along the angular momentum, y = 0.
fn invariable_frame(polhode: &Polhode, attitude: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    let zeta = polhode.zeta();
    let half_z = 0.25 * (zeta[0] * zeta[0] + zeta[1] * zeta[1]);
    let relative = Quaternion::new((1.0 - half_z).max(0.0).sqrt(), 0.5 * zeta[0], 0.5 * zeta[1], 0.0);
    attitude * (UnitQuaternion::new_normalize(relative) * polhode.frame.quaternion).inverse()
}

/// The mean variables whose corrections lead to a state, by fixed-point iteration, with the tables of them.
fn mean_motion_of(
    polhode: &Polhode,
    state: &Mean,
    start: &When,
    mean_motion: f64,
    request: &Request<'_>,
) -> Result<(Mean, Inertia, Corrections), Error> {
    let mut mean = *state;
    // Each step gains the relative size of the corrections, which is below a fiftieth.
    for step in 0.. {
        let inertia = Inertia::new(polhode, mean.p.norm_sqr(), mean.momentum);
        let corrections = Corrections::new(&inertia, request.orbit, mean_motion, request.level, request.tolerance)?;
        let next = state.changed(&corrections.at(&mean, &start.place), -1.0);
        let moved = (next.p - mean.p).norm()
            + (next.longitude - mean.longitude).abs()
            + (next.momentum / mean.momentum - 1.0).abs()
            + next.frame.angle_to(&mean.frame);
        if moved <= CONVERGED || step == 12 {
            return Ok((mean, inertia, corrections));
        }
        mean = next;
    }
    Err(Error::TorqueTooStrong { size: f64::NAN, bound: STRONGEST }) // the loop has no end but its return
}

/// What second order leaves.
struct Budget {
    corrections: f64,
    strength: f64,
    spin_rate: f64,
    mean_motion: f64,
    duration: f64,
}

impl Budget {
    /// Of the average over the rotation.
    fn of_the_spin(&self) -> f64 {
        self.corrections.powi(2) * (1.0 + 0.1 * self.spin_rate * self.duration)
    }

    /// Of the average over the orbit.
    fn of_the_orbit(&self) -> f64 {
        self.strength.powi(2) * (1.0 + self.mean_motion * self.duration)
    }
}
