//! A motion at one level, before its constants are found: the mean motion, the averaged torques, and the error bound. What the levels share is computed once.

use nalgebra::{UnitQuaternion, Vector3};
use num_complex::Complex;

use super::averaged::AveragedOrbit;
use super::averages::Averages;
use super::budget::{Budget, SecondOrderErrors, Subject};
use super::corrections::{Demand, Mean};
use super::mean_motion::{LevelEstimate, MeanMotion, SecondOrderData, first_order, weak_enough};
use super::paths::Paths;
use super::request::Request;
use super::response::Response;
use super::second_order;
use super::second_order::drift::Drift;
use crate::error::{Error, TorqueMeasure};
use crate::input::options::{Averaging, Level};
use crate::torque_free::polhode::Polhode;

type C64 = Complex<f64>;

/// Largest precession of the angular momentum in one radian of the true anomaly, or of the fastest orbit if that is shorter \[rad\]. At this limit polynomials
/// of degree 15 follow the frame to 1e-10 rad.
const FASTEST_PRECESSION: f64 = 0.3;

/// What the levels of a motion share.
pub(super) struct Outset<'a> {
    pub(super) polhode: &'a Polhode,
    pub(super) attitude: UnitQuaternion<f64>,
    pub(super) request: Request<'a>,
    pub(super) paths: &'a Paths,
    demands: Vec<Demand<'a>>,
    first: MeanMotion,
    refinements: Option<SecondOrderData>,
}

/// A motion at one level.
pub(super) struct Draft {
    pub(super) level: Level,
    pub(super) motion: MeanMotion,
    pub(super) averages: Averages,
    /// Whether the equations are averaged over the orbit as well.
    pub(super) by_orbit: bool,
    /// The error bound \[rad\].
    pub(super) error: f64,
}

impl<'a> Outset<'a> {
    /// The mean motion of first order from a polhode, the attitude at the epoch, and the place of the state on the polhode: σ, ℓ′ and y′ − y.
    ///
    /// # Errors
    /// - [`Error::OneFixedOrbit`] for the second order under several bodies.
    /// - [`Error::TorqueTooStrong`] and [`Error::Resonance`] if there is no such motion, and the error of an orbit that is out of reach at the epoch.
    pub(super) fn new(
        polhode: &'a Polhode,
        attitude: UnitQuaternion<f64>,
        osculating: (f64, [f64; 2]),
        (request, paths): (&Request<'a>, &'a Paths),
    ) -> Result<Self, Error> {
        let level = request.level;
        if level == Level::SecondOrder && !request.is_fixed() {
            return Err(Error::OneFixedOrbit { argument: "level", value: level.to_string() });
        }
        let pole = polhode.invariable_frame(attitude) * Vector3::z();
        let demands = paths.demands(request, polhode.scales.1, pole)?;
        weak_enough(polhode, osculating.0, &demands)?;
        let (sigma, [anomaly, longitude]) = osculating;
        let p = C64::from_polar(sigma.sqrt(), anomaly);
        let momentum = polhode.invariants.momentum.to_f64();
        let state = Mean { p, longitude, momentum, frame: polhode.invariable_frame(attitude) };
        let first = first_order(polhode, &state, &paths.starts, &demands)?;
        let refinements = request.is_refined().then(|| {
            let course = (&paths.starts[0], &paths.reaches[0]);
            SecondOrderData::new(&first, &state, course, &demands[0])
        });
        Ok(Self { polhode, attitude, request: *request, paths, demands, first, refinements })
    }

    /// The motion at a level.
    ///
    /// # Errors
    /// As [`Outset::new`], those of the average over the orbit, and [`Error::TorqueTooStrong`] if the angular momentum precesses faster than the disturbing bodies move.
    pub(super) fn draft(&self, level: Level) -> Result<Draft, Error> {
        let Self { polhode, paths, demands, first, .. } = self;
        let (motion, refinement) = match &self.refinements {
            Some(refinements) => {
                let (motion, refinement) = refinements.motion(polhode, first, &demands[0], level)?;
                (motion, Some(refinement))
            }
            None => (first.clone(), None),
        };
        let averages = Averages::new(polhode, &motion, demands, level);
        slow_enough(&averages, demands)?;
        let request = Request { level, ..self.request };
        let (by_orbit, error) = error_bound(&request, &motion, refinement, &averages, (paths, demands))?;
        Ok(Draft { level, motion, averages, by_orbit, error })
    }
}

/// Checks that the averaged equations can be solved: their solution on a quarter of the orbit is a polynomial, which cannot follow a faster precession.
fn slow_enough(averages: &Averages, demands: &[Demand<'_>]) -> Result<(), Error> {
    let fastest = demands.iter().fold(0.0_f64, |most, demand| most.max(demand.mean_motion));
    let turn = |(ellipse, demand): (&AveragedOrbit, &Demand<'_>)| {
        // The largest rate of the true anomaly within the span is half of that of twice the anomaly.
        let share = (0.5 * demand.envelope.fastest / fastest).min(1.0);
        ellipse.strength().abs() * (1.0 + ellipse.eccentricity) * share
    };
    let size = averages.ellipses.iter().zip(demands).map(turn).sum::<f64>();
    if size <= FASTEST_PRECESSION {
        return Ok(());
    }
    Err(Error::TorqueTooStrong { measure: TorqueMeasure::Precession, size, bound: FASTEST_PRECESSION })
}

/// Whether the equations are averaged over the orbit as well, and the error bound.
fn error_bound(
    request: &Request<'_>,
    motion: &MeanMotion,
    refinement: Option<LevelEstimate>,
    averages: &Averages,
    (paths, demands): (&Paths, &[Demand<'_>]),
) -> Result<(bool, f64), Error> {
    let MeanMotion { mean, inertia, corrections, .. } = motion;
    let response = Response::new(inertia);
    let further = refinement.map(|LevelEstimate { left, apart, hamiltonian, short_period }| {
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
        let demand = &demands[0];
        let cut = second_order::cut(inertia, demand) * envelope.share.truncation;
        // With the orbit's harmonics K2 has the average of what its closed form lacks, at the direction of the angular momentum at the epoch.
        let periodic = 2.0 / (demand.mean_motion * demand.duration);
        let precessed = (averages.ellipses[0].strength().abs() * demand.mean_motion * demand.duration).min(1.0);
        let unaveraged = (periodic + demand.orbit.eccentricity() * precessed).min(1.0);
        let cut = if demand.series.is_some() { unaveraged * cut } else { cut };
        SecondOrderErrors { short_period, left, cut, acting: envelope.share.third, apart }
    });
    let subject = |i: usize| Subject {
        mean,
        inertia,
        corrections: &corrections[i],
        response: &response,
        ellipse: &averages.ellipses[i],
        reach: &paths.reaches[i],
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
