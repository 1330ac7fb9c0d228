//! Rotation under the gravity gradient of one or more bodies on Keplerian orbits (theory §9).
//!
//! The mean motion is the free motion at the mean σ and M, in an invariable frame that the averaged torque moves ([`super::averaged`]). Short-period
//! [`super::corrections`] of first order lead from it to the motion. To first order the torques of several bodies, and their corrections, add up. Both are regular at J = 0 and at any inclination. Validity: the rotation is much faster
//! than the orbit, and the torque is weak. A divisor that is too small is [`Error::Resonance`]. The error is of second order in the torque and grows with time.

#[cfg(test)]
#[path = "tests.rs"]
mod tests;

use std::f64::consts::TAU;

use andoyer_double::DoubleDouble;
use nalgebra::{UnitQuaternion, Vector3};
use num_complex::Complex;

use super::averaged::{AveragedOrbit, Bodies, MOST_QUARTERS, Precession, Pull, Slow, Spin};
use super::budget::{Budget, Further, MOST_ORBITS, Subject};
use super::corrections::{Change, Corrections, Demand, Mean, SECOND_SHARE, SHARE, Terms};
use super::course::{Course, When};
use super::envelope::{Envelope, Reach};
use super::inertia::Inertia;
use super::offset::Offset;
use super::powers::Powers;
use super::request::Request;
use super::response::Response;
use super::second_order::drift::Drift;
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

/// A disturbing body and its corrections.
#[derive(Clone, Debug)]
pub(super) struct DisturbedBy {
    pub(super) course: Course,
    pub(super) corrections: Corrections,
}

/// A motion under the gravity gradient.
#[derive(Clone, Debug)]
pub(crate) struct Gradient {
    pub(super) inertia: Inertia,
    pub(super) pair: [Powers; 2],
    /// At least one.
    pub(super) bodies: Vec<DisturbedBy>,
    pub(super) slow: Slow,
    /// Constants that correct the error of first order at the epoch.
    pub(super) offset: Offset,
    pub(super) anomaly: Phase,
    pub(super) half_longitude: Phase,
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
        let Request { orbits, level, .. } = *request;
        if level == Level::SecondOrder && !request.is_fixed() {
            return Err(Error::OneFixedOrbit { argument: "level", value: level.to_string() });
        }
        let momentum = polhode.invariants.momentum.to_f64();
        let duration = scaled(request.duration, exponent);
        let share = if level == Level::SecondOrder { SECOND_SHARE } else { SHARE };
        let courses: Vec<Course> = orbits.iter().map(|orbit| Course::new(orbit, request.epoch)).collect();
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let starts: Vec<_> = courses.iter().map(|course| course.at((none, none))).collect();
        let reaches: Vec<Reach> = orbits
            .iter()
            .zip(&starts)
            .map(|(orbit, start)| Reach {
                eccentricity: orbit.eccentricity(),
                anomaly: start.place.angle.values()[0] - start.place.centre.values()[0],
                orbital: scaled(orbit.mean_motion(), -exponent) * duration,
            })
            .collect();
        let envelopes: Vec<Envelope> = orbits
            .iter()
            .zip(&reaches)
            .map(|(orbit, reach)| Envelope::new(orbit.eccentricity(), scaled(orbit.mean_motion(), -exponent), reach))
            .collect();
        let demands = orbits
            .iter()
            .zip(&envelopes)
            .map(|(orbit, envelope)| {
                orbit.within_reach(request.epoch)?;
                let [mean_motion, node, pericentre] =
                    [orbit.mean_motion(), orbit.rates()[0], orbit.rates()[1]].map(|rate| scaled(rate, -exponent));
                let (axes, rates, tolerance) = (orbit.axes_at(request.epoch), [node, pericentre], request.tolerance);
                Ok(Demand { orbit, mean_motion, rates, axes, level, tolerance, duration, share, envelope })
            })
            .collect::<Result<Vec<_>, Error>>()?;
        let size = demands.iter().map(|demand| {
            let share = demand.envelope.span[0] / demand.envelope.most[0];
            share * strongest_torque(polhode, demand.orbit, demand.mean_motion / momentum)
        });
        let size = size.sum::<f64>();
        if size > STRONGEST {
            // If there is a resonance, report that instead, because it explains more.
            all_corrections(&Inertia::new(polhode, osculating.0, momentum), &demands)?;
            return Err(Error::TorqueTooStrong { size, bound: STRONGEST });
        }
        let (sigma, [anomaly, longitude]) = osculating;
        let p = C64::from_polar(sigma.sqrt(), anomaly);
        let state = Mean { p, longitude, momentum, frame: polhode.invariable_frame(attitude) };
        let first = mean_motion_of(polhode, &state, &starts, &demands)?;
        let refines = request.is_fixed() && matches!(level, Level::Full | Level::SecondOrder);
        let (MeanMotion { mean, change, inertia, corrections }, refinement) = if refines {
            let (motion, refinement) = refined_of(polhode, first, &state, &starts[0], &demands[0])?;
            (motion, Some(refinement))
        } else {
            (first, None)
        };
        let (axial, axial_slope) = level.axial(&inertia);
        let delta = (1.5 * axial - 0.5 * polhode.moments.iter().sum::<f64>()) / mean.momentum;
        let ellipses: Vec<_> = demands
            .iter()
            .map(|demand| {
                let ellipse = AveragedOrbit::new(demand, delta);
                match level {
                    Level::SecondOrder => {
                        ellipse.with_second(second_order::epoch::hamiltonian(&inertia, demand, polhode.moments))
                    }
                    _ => ellipse,
                }
            })
            .collect();
        // Rates are proportional to M. M rounded to a double would cause an error of 1e-16 of the phases.
        let precise = (polhode.invariants.momentum - change.momentum.into()) / mean.momentum.into();
        let rates = inertia.rates.map(|rate| rate * precise);
        // ⟨D⟩ = −½ (dJ/dt) Δ. Its derivatives with respect to L, and to M at fixed L, give the slopes.
        let slope = -0.5 * 1.5 * axial_slope / mean.momentum;
        let response = Response::new(&inertia);
        let further = refinement.map(|Refinement { left, apart }| {
            let hamiltonian = second_order::epoch::hamiltonian(&inertia, &demands[0], polhode.moments);
            let drift = Drift {
                hamiltonian: &hamiltonian.without_first(),
                demand: &demands[0],
                reach: &reaches[0],
                axis: mean.frame * Vector3::z(),
                rates: apart,
                visible: response.visible,
            };
            let apart = if level == Level::SecondOrder { 0.0 } else { drift.largest() };
            Further { left, cut: second_order::cut(&inertia, &demands[0]), apart }
        });
        let subject = |i: usize| Subject {
            mean: &mean,
            inertia: &inertia,
            corrections: &corrections[i],
            response: &response,
            ellipse: &ellipses[i],
            anomaly: reaches[i].anomaly,
            drift: slope * demands[i].orbit.disturbing_fraction(),
            further,
        };
        let (by_orbit, error) = if request.is_fixed() {
            let budget = Budget::new(&subject(0), demands[0].mean_motion, duration);
            let by_orbit = budget.by_orbit(request)?;
            (by_orbit, budget.error(by_orbit))
        } else {
            within_arcs(&courses, request)?;
            let subjects: Vec<_> = (0..courses.len()).map(subject).collect();
            (false, Budget::of_bodies(&subjects, &demands, duration).error(false))
        };
        let unit = scaled(1.0, exponent);
        let axis = mean.frame * Vector3::z();
        // J of a single fixed orbit is per mass fraction, which is in its slope.
        let secular = ellipses.iter().map(|ellipse| ellipse.secular(&axis) * ellipse.fraction()).sum::<f64>() * unit;
        let drifts_by = if request.is_fixed() { slope * ellipses[0].fraction() } else { slope };
        let pulls = || {
            courses
                .iter()
                .zip(&ellipses)
                .map(|(course, ellipse)| Pull { course: course.clone(), attraction: ellipse.attraction() * unit })
        };
        let slow = |frame: UnitQuaternion<f64>| match (request.is_fixed(), by_orbit) {
            (false, _) => Slow::Bodies(Box::new(Bodies::new(pulls().collect(), delta, frame))),
            (true, true) => Slow::Orbit(Box::new(Precession::new(ellipses[0].clone(), frame, &starts[0].place, unit))),
            (true, false) => Slow::Spin(Box::new(Spin::new(ellipses[0].clone(), frame, &starts[0]))),
        };
        let [anomaly_rate, longitude_rate] =
            rates.map(|rate| DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) });
        let ratios = [1.0, -inertia.sigma];
        let drifts = if level == Level::SecondOrder { [1.0; 2] } else { ratios.map(|ratio| ratio * drifts_by) };
        let mut gradient = Self {
            anomaly: Phase::new(anomaly_rate, mean.p.arg()),
            half_longitude: Phase::new(longitude_rate * 0.5.into(), 0.5 * mean.longitude),
            root: mean.p.norm(),
            drifts,
            secular: ratios.map(|ratio| ratio * slope * secular),
            pair: inertia.pair.each_ref().map(|series| Powers::new(series, inertia.sigma.sqrt())),
            inertia,
            slow: slow(mean.frame),
            bodies: courses
                .iter()
                .zip(corrections)
                .map(|(course, corrections)| DisturbedBy { course: course.clone(), corrections })
                .collect(),
            offset: Offset::default(),
            frame: polhode.frame.clone(),
            moments: polhode.moments,
            level,
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

    /// Whether there is one body, on an orbit that does not precess.
    pub(crate) fn is_fixed(&self) -> bool {
        !matches!(self.slow, Slow::Bodies(_))
    }

    /// The longest time from the epoch for which quarters are kept, in the user's unit.
    pub(crate) fn bound(&self) -> f64 {
        match &self.slow {
            Slow::Spin(_) => MOST_ORBITS / self.bodies[0].course.mean_anomaly.frequency(),
            Slow::Orbit(_) => f64::INFINITY,
            Slow::Bodies(_) => longest(self.bodies.iter().map(|body| &body.course)),
        }
    }

    /// The entries of the plan.
    pub(crate) fn plan(&self) -> GradientPlan {
        let size = self.bodies.iter().map(|body| body.corrections.size).sum::<f64>();
        let neglected = self.bodies.iter().map(|body| body.corrections.neglected);
        GradientPlan {
            averaging: match self.slow {
                Slow::Spin(_) | Slow::Bodies(_) => Averaging::Spin,
                Slow::Orbit(_) => Averaging::Orbit,
            },
            level: self.level,
            terms: self.bodies.iter().map(|body| body.corrections.count).sum(),
            size,
            neglected: neglected.fold(size * size, f64::max),
        }
    }

    /// The parts of the theory that this scene did not need.
    pub(crate) fn skipped(&self) -> Vec<String> {
        let mut skipped = Vec::new();
        let dropped = self.bodies.iter().map(|body| body.corrections.dropped).sum::<f64>();
        if dropped > 0.0 {
            skipped.push(format!("short-period terms: the dropped terms sum to {dropped:.1e} rad"));
        }
        if self.bodies.iter().all(|body| body.course.eccentricity == 0.0) {
            let orbits = if self.bodies.len() == 1 { "the orbit is a circle" } else { "the orbits are circles" };
            skipped.push(format!("Kepler's equation: {orbits}"));
        }
        skipped
    }
}

/// A mean state, its change to the osculating state, and its tables.
struct MeanMotion {
    mean: Mean,
    change: Change,
    inertia: Inertia,
    /// Of each body.
    corrections: Vec<Corrections>,
}

/// What the second order in the torque says of a mean motion.
struct Refinement {
    /// What is left of the mean M and L, over M.
    left: [f64; 2],
    /// Rates of ℓ′ and y′ at the mean M and σ of second order, less those of first order.
    apart: [f64; 2],
}

/// The largest time from the epoch over which the averaged equations are solved, in the user's unit.
fn longest<'a>(courses: impl Iterator<Item = &'a Course>) -> f64 {
    // In a unit of time there are no more arcs than in all orbits together.
    MOST_QUARTERS as f64 / courses.map(Course::arcs).sum::<f64>()
}

/// Checks that the averaged equations can be solved over the span.
fn within_arcs(courses: &[Course], request: &Request<'_>) -> Result<(), Error> {
    let bound = longest(courses.iter());
    if request.averaging == Averaging::Orbit {
        return Err(Error::OneFixedOrbit { argument: "averaging", value: Averaging::Orbit.to_string() });
    }
    if request.spanned && request.duration > bound {
        return Err(Error::SpanOfBodies { value: request.duration, bound });
    }
    Ok(())
}

/// The corrections for each body at a mean motion.
fn all_corrections(inertia: &Inertia, demands: &[Demand<'_>]) -> Result<Vec<Corrections>, Error> {
    let all: Vec<_> = demands.iter().map(|demand| Terms::new(inertia, demand)).collect();
    let whole = all.iter().map(|terms| terms.size).sum();
    all.into_iter().zip(demands).map(|(terms, demand)| Corrections::of(terms, inertia, demand, whole)).collect()
}

/// The mean motion with the mean M and L of all terms, to second order if the level is, and how far the rates of second order are from those of first.
fn refined_of(
    polhode: &Polhode,
    first: MeanMotion,
    state: &Mean,
    start: &When<pulp::Scalar>,
    demand: &Demand<'_>,
) -> Result<(MeanMotion, Refinement), Error> {
    let (both, [by_momentum, by_sigma]) = second_order::epoch::refined(
        (&first.mean, &first.change, first.corrections[0].size),
        state,
        &first.inertia,
        &start.place,
        (demand, polhode.moments),
    );
    let Refined { mean, momentum, left } = both[usize::from(demand.level == Level::SecondOrder)];
    let inertia = Inertia::new(polhode, mean.p.norm_sqr(), mean.momentum);
    let apart = [0, 1].map(|i| inertia.rates[i].to_f64() * by_momentum + inertia.rate_slopes[i] * by_sigma);
    let corrections = vec![Corrections::new(&inertia, demand)?];
    let change = Change { momentum, ..first.change };
    // The iteration leaves M and L its own threshold, which the rates multiply by the time.
    let left = left.map(|part| part + CONVERGED);
    Ok((MeanMotion { mean, change, inertia, corrections }, Refinement { left, apart }))
}

/// The mean variables whose corrections give a state, by fixed-point iteration.
fn mean_motion_of(
    polhode: &Polhode,
    state: &Mean,
    starts: &[When<pulp::Scalar>],
    demands: &[Demand<'_>],
) -> Result<MeanMotion, Error> {
    let (mut mean, mut change) = (*state, Change::default());
    let (mut step, mut first) = (0, 0.0_f64);
    // Each iteration reduces the error by the relative size of the corrections, which is below a fiftieth.
    loop {
        let inertia = Inertia::new(polhode, mean.p.norm_sqr(), mean.momentum);
        let corrections = all_corrections(&inertia, demands)?;
        let changes = corrections.iter().zip(starts).map(|(corrections, start)| corrections.at(&mean, &start.place));
        let next_change = changes.reduce(|sum, change| sum.plus(&change)).unwrap_or_default();
        let next = state.changed(&next_change, -1.0);
        let moved = (next.p - mean.p).norm()
            + (next.longitude - mean.longitude).abs()
            + (next.momentum / mean.momentum - 1.0).abs()
            + next.frame.angle_to(&mean.frame);
        if moved <= CONVERGED {
            return Ok(MeanMotion { mean, change, inertia, corrections });
        }
        first = first.max(moved);
        if step == MOST_STEPS {
            // Rounding of large corrections may prevent full convergence. A motion without contraction has no mean motion.
            let contraction = (moved / first).powf(1.0 / MOST_STEPS as f64);
            return if contraction <= CONTRACTION {
                Ok(MeanMotion { mean, change, inertia, corrections })
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
