//! Rotation under the gravity gradient of a body on a Keplerian orbit (theory §9).
//!
//! The mean motion is the free motion at the mean σ and M, in an invariable frame that the averaged torque moves ([`super::averaged`]). Short-period
//! [`super::corrections`] of first order lead from it to the motion. Both are regular at J = 0 and at any inclination. Validity: the rotation is much faster
//! than the orbit, and the torque is weak. A divisor that is too small is [`Error::Resonance`]. The error is of second order in the torque and grows with time.

#[cfg(test)]
#[path = "tests.rs"]
mod tests;

use std::f64::consts::TAU;

use andoyer_double::DoubleDouble;
use nalgebra::{UnitQuaternion, Vector3};
use num_complex::Complex;

use super::averaged::{AveragedOrbit, Precession, Slow, Spin, When, when};
use super::budget::{Budget, MOST_ORBITS, Subject};
use super::corrections::{Change, Corrections, Demand, Mean, SECOND_SHARE, SHARE};
use super::inertia::Inertia;
use super::offset::Offset;
use super::powers::Powers;
use super::request::Request;
use super::response::Response;
use super::second_order::{self, epoch::Refined};
use crate::error::Error;
use crate::input::options::{Averaging, Level};
use crate::input::orbit::Orbit;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::{Frame, Polhode};

type C64 = Complex<f64>;

/// The iteration has converged if the mean variables change by less than this.
const CONVERGED: f64 = 1e-15;
/// Largest number of iterations for the mean variables.
const MOST_STEPS: usize = 24;
/// Largest mean ratio of the changes of successive iterations. With a larger ratio there is no mean motion.
const CONTRACTION: f64 = 0.5;
/// Largest torque over M²/C for which first order in the torque is accepted.
pub(crate) const STRONGEST: f64 = 0.02;

/// The entries of a plan that concern the gravity gradient.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct GradientPlan {
    pub(crate) averaging: Averaging,
    pub(crate) level: Level,
    /// Number of terms in the short-period corrections.
    pub(crate) terms: usize,
    /// Sum of the sizes of these terms \[rad\].
    pub(crate) size: f64,
    /// The first neglected term \[rad\].
    pub(crate) neglected: f64,
}

/// A motion under the gravity gradient.
#[derive(Clone, Debug)]
pub(crate) struct Gradient {
    pub(super) inertia: Inertia,
    pub(super) pair: [Powers; 2],
    pub(super) corrections: Corrections,
    pub(super) slow: Slow,
    /// Constants that correct the error of first order at the epoch.
    pub(super) offset: Offset,
    pub(super) anomaly: Phase,
    pub(super) half_longitude: Phase,
    pub(super) mean_anomaly: Phase,
    pub(super) eccentricity: f64,
    pub(super) root: f64,
    /// These times J, or in second order times the drifts, are added to ℓ′ and y′.
    pub(super) drifts: [f64; 2],
    /// The rates that they add to ℓ′ and y′ in the orbit average, in the user's unit.
    secular: [f64; 2],
    pub(super) frame: Frame,
    pub(super) moments: [f64; 3],
    level: Level,
    /// The motion's units of rate and of angular momentum, in the user's units.
    pub(super) units: [f64; 2],
    pub(crate) error: f64,
}

impl Gradient {
    /// The motion from a polhode, the attitude at the epoch, and the place of the state on the polhode: σ, ℓ′ and y′ − y.
    pub(crate) fn new(
        polhode: &Polhode,
        attitude: UnitQuaternion<f64>,
        osculating: (f64, [f64; 2]),
        request: &Request<'_>,
    ) -> Result<Self, Error> {
        let exponent = polhode.scales.1;
        let orbit = request.orbit;
        orbit.within_reach(request.epoch)?;
        let mean_motion = scaled(orbit.mean_motion(), -exponent);
        let momentum = polhode.invariants.momentum.to_f64();
        let duration = scaled(request.duration, exponent);
        let share = if request.level == Level::SecondOrder { SECOND_SHARE } else { SHARE };
        let demand = Demand { orbit, mean_motion, level: request.level, tolerance: request.tolerance, duration, share };
        let size = strongest_torque(polhode, orbit, mean_motion / momentum);
        if size > STRONGEST {
            // If there is a resonance, report that instead, because it explains more.
            Corrections::new(&Inertia::new(polhode, osculating.0, momentum), &demand)?;
            return Err(Error::TorqueTooStrong { size, bound: STRONGEST });
        }
        let mean_anomaly = orbit.mean_anomaly(request.epoch);
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let start = when(&mean_anomaly, (none, none), orbit.eccentricity());
        let (sigma, [anomaly, longitude]) = osculating;
        let p = C64::from_polar(sigma.sqrt(), anomaly);
        let state = Mean { p, longitude, momentum, frame: polhode.invariable_frame(attitude) };
        let first = mean_motion_of(polhode, &state, &start, &demand)?;
        let MeanMotion { mean, change, inertia, corrections, left } = if request.level == Level::SecondOrder {
            second_order_of(polhode, first, &state, &start, &demand)?
        } else {
            first
        };
        let (axial, axial_slope) = request.level.axial(&inertia);
        let fraction = orbit.disturbing_fraction();
        let delta = (1.5 * axial - 0.5 * polhode.moments.iter().sum::<f64>()) * fraction;
        let mut ellipse = AveragedOrbit::new(orbit, mean_motion, delta / mean.momentum);
        if request.level == Level::SecondOrder {
            ellipse = ellipse.with_second(second_order::epoch::hamiltonian(&inertia, &demand, polhode.moments));
        }
        // Rates are proportional to M. M rounded to a double would cause an error of 1e-16 of the phases.
        let precise = (polhode.invariants.momentum - change.momentum.into()) / mean.momentum.into();
        let rates = inertia.rates.map(|rate| rate * precise);
        // ⟨D⟩ = −½ (dJ/dt) Δ. Its derivatives with respect to L, and to M at fixed L, give the slopes.
        let slope = -0.5 * 1.5 * axial_slope * fraction / mean.momentum;
        let response = Response::new(&inertia);
        let anomaly = start.place.angle.values()[0] - start.place.centre.values()[0];
        let subject = Subject {
            mean: &mean,
            inertia: &inertia,
            corrections: &corrections,
            response: &response,
            ellipse: &ellipse,
            anomaly,
            drift: slope,
            left,
            cut: left.map_or(0.0, |_| second_order::cut(&inertia, &demand)),
        };
        let budget = Budget::new(&subject, mean_motion, duration);
        let by_orbit = budget.by_orbit(request)?;
        let error = budget.error(by_orbit);
        let unit = scaled(1.0, exponent);
        let secular = ellipse.secular(&(mean.frame * Vector3::z())) * unit;
        let slow = |frame: UnitQuaternion<f64>| {
            if by_orbit {
                Slow::Orbit(Box::new(Precession::new(ellipse.clone(), frame, &start.place, unit)))
            } else {
                Slow::Spin(Box::new(Spin::new(ellipse.clone(), frame, &start)))
            }
        };
        let [anomaly_rate, longitude_rate] =
            rates.map(|rate| DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) });
        let secular_drifts = [slope, -slope * inertia.sigma];
        let drifts = if request.level == Level::SecondOrder { [1.0; 2] } else { secular_drifts };
        let mut gradient = Self {
            anomaly: Phase::new(anomaly_rate, mean.p.arg()),
            half_longitude: Phase::new(longitude_rate * 0.5.into(), 0.5 * mean.longitude),
            mean_anomaly,
            eccentricity: orbit.eccentricity(),
            root: mean.p.norm(),
            drifts,
            secular: secular_drifts.map(|drift| drift * secular),
            pair: inertia.pair.each_ref().map(|series| Powers::new(series, inertia.sigma.sqrt())),
            inertia,
            corrections,
            slow: slow(mean.frame),
            offset: Offset::default(),
            frame: polhode.frame.clone(),
            moments: polhode.moments,
            level: request.level,
            units: [unit, polhode.user_momentum() / momentum],
            error,
        };
        gradient.start_at(polhode, attitude, mean.frame, slow);
        Ok(gradient)
    }

    /// Mean rates of ℓ′ and y′ in the user's unit. y′ is counted from an axis that turns with the angular momentum and not about it.
    pub(crate) fn frequencies(&self) -> [f64; 2] {
        let [anomaly, longitude] = self.secular;
        [self.anomaly.frequency() * TAU + anomaly, 2.0 * self.half_longitude.frequency() * TAU + longitude]
    }

    /// The longest time from the epoch for which quarters are kept, in the user's unit.
    pub(crate) fn bound(&self) -> f64 {
        match self.slow {
            Slow::Spin(_) => MOST_ORBITS / self.mean_anomaly.frequency(),
            Slow::Orbit(_) => f64::INFINITY,
        }
    }

    /// The entries of the plan.
    pub(crate) fn plan(&self) -> GradientPlan {
        GradientPlan {
            averaging: match self.slow {
                Slow::Spin(_) => Averaging::Spin,
                Slow::Orbit(_) => Averaging::Orbit,
            },
            level: self.level,
            terms: self.corrections.count,
            size: self.corrections.size,
            neglected: self.corrections.neglected.max(self.corrections.size * self.corrections.size),
        }
    }

    /// The parts of the theory that this scene did not need.
    pub(crate) fn skipped(&self) -> Vec<String> {
        let mut skipped = Vec::new();
        if self.corrections.dropped > 0.0 {
            skipped.push(format!("short-period terms: the dropped terms sum to {:.1e} rad", self.corrections.dropped));
        }
        if self.eccentricity == 0.0 {
            skipped.push("Kepler's equation: the orbit is a circle".to_owned());
        }
        skipped
    }
}

/// A mean state, its change to the osculating state, and its tables.
struct MeanMotion {
    mean: Mean,
    change: Change,
    inertia: Inertia,
    corrections: Corrections,
    /// What is left of the mean M and L over M, if they are of second order.
    left: Option<[f64; 2]>,
}

/// The mean motion of second order from that of first order of a state.
fn second_order_of(
    polhode: &Polhode,
    first: MeanMotion,
    state: &Mean,
    start: &When<pulp::Scalar>,
    demand: &Demand<'_>,
) -> Result<MeanMotion, Error> {
    let Refined { mean, momentum, left } = second_order::epoch::refined(
        (&first.mean, &first.change, first.corrections.size),
        state,
        &first.inertia,
        &start.place,
        (demand, polhode.moments),
    );
    let inertia = Inertia::new(polhode, mean.p.norm_sqr(), mean.momentum);
    let corrections = Corrections::new(&inertia, demand)?;
    let change = Change { momentum, ..first.change };
    // The iteration leaves M and L its own threshold, which the rates multiply by the time.
    let left = left.map(|part| part + CONVERGED);
    Ok(MeanMotion { mean, change, inertia, corrections, left: Some(left) })
}

/// The mean variables whose corrections give a state, by fixed-point iteration.
fn mean_motion_of(
    polhode: &Polhode,
    state: &Mean,
    start: &When<pulp::Scalar>,
    demand: &Demand<'_>,
) -> Result<MeanMotion, Error> {
    let (mut mean, mut change) = (*state, Change::default());
    let (mut step, mut first) = (0, 0.0_f64);
    // Each iteration reduces the error by the relative size of the corrections, which is below a fiftieth.
    loop {
        let inertia = Inertia::new(polhode, mean.p.norm_sqr(), mean.momentum);
        let corrections = Corrections::new(&inertia, demand)?;
        let next_change = corrections.at(&mean, &start.place);
        let next = state.changed(&next_change, -1.0);
        let moved = (next.p - mean.p).norm()
            + (next.longitude - mean.longitude).abs()
            + (next.momentum / mean.momentum - 1.0).abs()
            + next.frame.angle_to(&mean.frame);
        if moved <= CONVERGED {
            return Ok(MeanMotion { mean, change, inertia, corrections, left: None });
        }
        first = first.max(moved);
        if step == MOST_STEPS {
            // Rounding of large corrections may prevent full convergence. A motion without contraction has no mean motion.
            let contraction = (moved / first).powf(1.0 / MOST_STEPS as f64);
            return if contraction <= CONTRACTION {
                Ok(MeanMotion { mean, change, inertia, corrections, left: None })
            } else {
                Err(Error::TorqueTooStrong { size: contraction, bound: CONTRACTION })
            };
        }
        (mean, change) = (next, next_change);
        step += 1;
    }
}

/// The largest torque over M²/C: 3n²C(C − A)/2M² at the pericentre times the mass fraction, where C is the largest and A the smallest moment; `rate` is n/M.
fn strongest_torque(polhode: &Polhode, orbit: &Orbit, rate: f64) -> f64 {
    let [first, _, third] = polhode.moments;
    let product = first.max(third) * (first - third).abs();
    1.5 * rate * rate * product * orbit.disturbing_fraction() / (1.0 - orbit.eccentricity()).powi(3)
}
