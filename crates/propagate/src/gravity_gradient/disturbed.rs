//! Rotation under the gravity gradient of one or more bodies on Keplerian orbits (theory §9).
//!
//! The mean motion is the free motion at the mean σ and M, in an invariable frame that the averaged torque moves ([`super::averaged`]). Short-period
//! [`super::corrections`] of first order lead from it to the motion. To first order the torques of several bodies, and their corrections, add up. Both are
//! regular at J = 0 and at any inclination. Validity: the rotation is much faster than the orbit, and the torque is weak. A divisor that is too small is
//! [`Error::Resonance`]. The error is of second order in the torque and grows with time.

#[cfg(test)]
#[path = "tests.rs"]
mod tests;

use std::f64::consts::TAU;

use andoyer_double::DoubleDouble;
use nalgebra::{UnitQuaternion, Vector3};
use num_complex::Complex;

use super::averaged::{AveragedOrbit, Bodies, MOST_QUARTERS, Precession, Pull, Slow, Spin};
use super::budget::{Budget, Further, MOST_ORBITS, Subject};
use super::corrections::{Corrections, Demand, Mean, SECOND_SHARE, SHARE};
use super::course::{Course, When};
use super::envelope::{Envelope, Reach};
use super::inertia::Inertia;
use super::mean_motion::{MeanMotion, Refinement, STRONGEST, corrections_of, first_order, refined, strongest_torque};
use super::offset::Offset;
use super::orbit_series::OrbitSeries;
use super::powers::Powers;
use super::request::Request;
use super::response::Response;
use super::second_order;
use super::second_order::drift::Drift;
use crate::error::Error;
use crate::input::options::{Averaging, Level};
use crate::input::orbit::Orbit;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::{Frame, Polhode};

type C64 = Complex<f64>;

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
        let level = request.level;
        if level == Level::SecondOrder && !request.is_fixed() {
            return Err(Error::OneFixedOrbit { argument: "level", value: level.to_string() });
        }
        let momentum = polhode.invariants.momentum.to_f64();
        let paths = Paths::new(request, exponent);
        let demands = paths.demands(request, exponent)?;
        weak_enough(polhode, osculating.0, &demands)?;
        let (sigma, [anomaly, longitude]) = osculating;
        let p = C64::from_polar(sigma.sqrt(), anomaly);
        let state = Mean { p, longitude, momentum, frame: polhode.invariable_frame(attitude) };
        let first = first_order(polhode, &state, &paths.starts, &demands)?;
        let (motion, refinement) = if refines(request) {
            let (motion, refinement) = refined(polhode, first, &state, &paths.starts[0], &demands[0])?;
            (motion, Some(refinement))
        } else {
            (first, None)
        };
        let averages = Averages::new(polhode, &motion, &demands);
        let (by_orbit, error) = error_bound(request, &motion, refinement, &averages, (&paths, &demands))?;
        let MeanMotion { mean, change, inertia, corrections } = motion;
        // Rates are proportional to M. M rounded to a double would cause an error of 1e-16 of the phases.
        let precise = (polhode.invariants.momentum - change.momentum.into()) / mean.momentum.into();
        let [anomaly_rate, longitude_rate] = inertia.rates.map(|rate| {
            let rate = rate * precise;
            DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) }
        });
        let unit = scaled(1.0, exponent);
        let factors = averages.per_phase(&inertia, request);
        let slow = |frame| averages.slow(frame, (request, by_orbit), &paths, (unit, factors));
        let mut gradient = Self {
            anomaly: Phase::new(anomaly_rate, mean.p.arg()),
            half_longitude: Phase::new(longitude_rate * 0.5.into(), 0.5 * mean.longitude),
            root: mean.p.norm(),
            drifts: if level == Level::SecondOrder { [1.0; 2] } else { factors },
            secular: averages.secular(&inertia, &mean).map(|rate| rate * unit),
            pair: inertia.pair.each_ref().map(|series| Powers::new(series, inertia.sigma.sqrt())),
            inertia,
            slow: slow(mean.frame),
            bodies: paths
                .courses
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
        let bound = gradient.bound();
        if request.spanned && request.duration > bound {
            return Err(Error::SpanOfBodies { value: request.duration, bound });
        }
        Ok(gradient)
    }

    /// Mean rates of ℓ′ and y′ in the user's unit. y′ is counted from an axis that turns with the angular momentum and not about it.
    pub(crate) fn frequencies(&self) -> [f64; 2] {
        let [anomaly, longitude] = self.secular;
        [self.anomaly.frequency() * TAU + anomaly, 2.0 * self.half_longitude.frequency() * TAU + longitude]
    }

    /// Whether the averaged equations are solved for each quarter of an orbit.
    pub(crate) fn is_by_quarters(&self) -> bool {
        matches!(self.slow, Slow::Spin(_))
    }

    /// The longest time from the epoch for which the averaged equations are solved, in the user's unit.
    pub(crate) fn bound(&self) -> f64 {
        match &self.slow {
            Slow::Spin(_) => MOST_ORBITS / self.bodies[0].course.mean_anomaly.frequency(),
            Slow::Orbit(precession) => precession.bound(MOST_QUARTERS),
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
        if self.bodies.iter().all(|body| body.course.ellipse.eccentricity == 0.0) {
            let orbits = if self.bodies.len() == 1 { "the orbit is a circle" } else { "the orbits are circles" };
            skipped.push(format!("Kepler's equation: {orbits}"));
        }
        skipped
    }
}

/// Whether the mean M and L at the epoch are those of all terms.
fn refines(request: &Request<'_>) -> bool {
    request.is_fixed() && matches!(request.level, Level::Full | Level::SecondOrder)
}

/// The orbits of the disturbing bodies from the epoch.
struct Paths {
    courses: Vec<Course>,
    /// Positions at the epoch.
    starts: Vec<When<pulp::Scalar>>,
    reaches: Vec<Reach>,
    envelopes: Vec<Envelope>,
    /// The orbits' harmonics, where divisors are to be exact in them.
    series: Vec<Option<OrbitSeries>>,
    /// Longest time from the epoch, in the units of the tables.
    duration: f64,
}

impl Paths {
    fn new(request: &Request<'_>, exponent: i32) -> Self {
        let duration = scaled(request.duration, exponent);
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let mut paths =
            Self { courses: vec![], starts: vec![], reaches: vec![], envelopes: vec![], series: vec![], duration };
        for orbit in request.orbits {
            let course = Course::new(orbit, request.epoch);
            let start = course.at((none, none));
            let (mean_motion, eccentricity) = (scaled(orbit.mean_motion(), -exponent), orbit.eccentricity());
            let anomaly = start.place.angle.values()[0] - start.place.centre.values()[0];
            let reach = Reach { eccentricity, anomaly, orbital: mean_motion * duration };
            let rates = orbit.rates().map(|rate| scaled(rate, -exponent));
            paths.envelopes.push(Envelope::new(eccentricity, mean_motion, rates, &reach));
            paths.series.push(if refines(request) { OrbitSeries::new(&reach) } else { None });
            paths.reaches.push(reach);
            paths.starts.push(start);
            paths.courses.push(course);
        }
        paths
    }

    /// What the corrections for each body are to be.
    fn demands<'a>(&'a self, request: &Request<'a>, exponent: i32) -> Result<Vec<Demand<'a>>, Error> {
        let Request { level, tolerance, epoch, .. } = *request;
        let share = if level == Level::SecondOrder { SECOND_SHARE } else { SHARE };
        let demand = |((orbit, envelope), series): ((&'a Orbit, &'a Envelope), &'a Option<OrbitSeries>)| {
            orbit.within_reach(epoch)?;
            let [node, pericentre] = orbit.rates();
            let [mean_motion, node, pericentre] =
                [orbit.mean_motion(), node, pericentre].map(|rate| scaled(rate, -exponent));
            let (axes, rates, duration) = (orbit.axes_at(epoch), [node, pericentre], self.duration);
            let (refined, series) = (refines(request), series.as_ref());
            Ok(Demand { orbit, mean_motion, rates, axes, level, tolerance, duration, share, refined, series, envelope })
        };
        request.orbits.iter().zip(&self.envelopes).zip(&self.series).map(demand).collect()
    }
}

/// Checks that the torques are weak enough for first order.
fn weak_enough(polhode: &Polhode, sigma: f64, demands: &[Demand<'_>]) -> Result<(), Error> {
    let momentum = polhode.invariants.momentum.to_f64();
    let size = |demand: &Demand<'_>| {
        let share = demand.envelope.span[0] / demand.envelope.most[0];
        share * strongest_torque(polhode, demand.orbit, demand.mean_motion / momentum)
    };
    let size = demands.iter().map(size).sum::<f64>();
    if size <= STRONGEST {
        return Ok(());
    }
    // If there is a resonance, report that instead, because it explains more.
    corrections_of(&Inertia::new(polhode, sigma, momentum), demands)?;
    Err(Error::TorqueTooStrong { size, bound: STRONGEST })
}

/// The averaged torques.
struct Averages {
    ellipses: Vec<AveragedOrbit>,
    /// Δ over M.
    delta: f64,
    /// ⟨D⟩ = −½ (dJ/dt) Δ: dΔ/dσ times −½ over M. The derivatives of ⟨D⟩ with respect to L, and to M at fixed L, follow from it.
    slope: f64,
}

impl Averages {
    fn new(polhode: &Polhode, motion: &MeanMotion, demands: &[Demand<'_>]) -> Self {
        let MeanMotion { mean, inertia, .. } = motion;
        let level = demands[0].level;
        let (axial, axial_slope) = level.axial(inertia);
        let delta = (1.5 * axial - 0.5 * polhode.moments.iter().sum::<f64>()) / mean.momentum;
        let ellipses = demands.iter().map(|demand| {
            let ellipse = AveragedOrbit::new(demand, delta);
            match level {
                Level::SecondOrder => {
                    ellipse.with_second(second_order::epoch::hamiltonian(inertia, demand, polhode.moments))
                }
                _ => ellipse,
            }
        });
        Self { ellipses: ellipses.collect(), delta, slope: -0.5 * 1.5 * axial_slope / mean.momentum }
    }

    /// The drifts of ℓ′ and y′ over J.
    fn per_phase(&self, inertia: &Inertia, request: &Request<'_>) -> [f64; 2] {
        // J of a single fixed orbit is per mass fraction, which is in its slope.
        let slope = if request.is_fixed() { self.slope * self.ellipses[0].fraction() } else { self.slope };
        [slope, -inertia.sigma * slope]
    }

    /// The rates of ℓ′ and y′ in the orbit average.
    fn secular(&self, inertia: &Inertia, mean: &Mean) -> [f64; 2] {
        let axis = mean.frame * Vector3::z();
        if let Some(average) = self.ellipses[0].over_orbit() {
            return average.slopes(&axis).phases;
        }
        let rate = self.ellipses.iter().map(|ellipse| ellipse.secular(&axis) * ellipse.fraction()).sum::<f64>();
        [self.slope * rate, -inertia.sigma * self.slope * rate]
    }

    /// The averaged motion from a frame at the epoch.
    fn slow(
        &self,
        frame: UnitQuaternion<f64>,
        (request, by_orbit): (&Request<'_>, bool),
        paths: &Paths,
        (unit, factors): (f64, [f64; 2]),
    ) -> Slow {
        let ellipse = &self.ellipses[0];
        match (request.is_fixed(), by_orbit) {
            (false, _) => {
                let bodies = paths.courses.iter().zip(&self.ellipses);
                let pulls = bodies
                    .map(|(course, ellipse)| Pull { course: course.clone(), attraction: ellipse.attraction() * unit });
                Slow::Bodies(Box::new(Bodies::new(pulls.collect(), self.delta, frame)))
            }
            (true, true) => {
                let place = &paths.starts[0].place;
                Slow::Orbit(Box::new(Precession::new(ellipse.clone(), frame, place, (unit, factors))))
            }
            (true, false) => Slow::Spin(Box::new(Spin::new(ellipse.clone(), frame, &paths.starts[0]))),
        }
    }
}

/// Whether the equations are averaged over the orbit as well, and the error bound.
fn error_bound(
    request: &Request<'_>,
    motion: &MeanMotion,
    refinement: Option<Refinement>,
    averages: &Averages,
    (paths, demands): (&Paths, &[Demand<'_>]),
) -> Result<(bool, f64), Error> {
    let MeanMotion { mean, inertia, corrections, .. } = motion;
    let response = Response::new(inertia);
    let further = refinement.map(|Refinement { left, apart, hamiltonian }| {
        let drift = Drift {
            hamiltonian: &hamiltonian.without_first(),
            demand: &demands[0],
            reach: &paths.reaches[0],
            axis: mean.frame * Vector3::z(),
            rates: apart,
            visible: response.visible,
        };
        let apart = if request.level == Level::SecondOrder { 0.0 } else { drift.largest() };
        let envelope = &paths.envelopes[0];
        let cut = second_order::cut(inertia, &demands[0]) * envelope.share.truncation;
        Further { left, cut, acting: envelope.share.third, apart }
    });
    let subject = |i: usize| Subject {
        mean,
        inertia,
        corrections: &corrections[i],
        response: &response,
        ellipse: &averages.ellipses[i],
        anomaly: paths.reaches[i].anomaly,
        drift: averages.slope * demands[i].orbit.disturbing_fraction(),
        further,
    };
    if request.is_fixed() {
        let budget = Budget::new(&subject(0), demands[0].mean_motion, paths.duration);
        let by_orbit = budget.by_orbit(request)?;
        return Ok((by_orbit, budget.error(by_orbit)));
    }
    if request.averaging == Averaging::Orbit {
        return Err(Error::OneFixedOrbit { argument: "averaging", value: Averaging::Orbit.to_string() });
    }
    let subjects: Vec<_> = (0..demands.len()).map(subject).collect();
    Ok((false, Budget::of_bodies(&subjects, demands, paths.duration).error(false)))
}

/// The largest time from the epoch over which the averaged equations are solved, in the user's unit.
fn longest<'a>(courses: impl Iterator<Item = &'a Course>) -> f64 {
    // In a unit of time there are no more arcs than in all orbits together.
    MOST_QUARTERS as f64 / courses.map(Course::arcs).sum::<f64>()
}
