//! A motion at one level, before its constants are found: the mean motion, the averaged torques, and the error estimate. What the levels share is computed once.

use nalgebra::{UnitQuaternion, Vector3};

use crate::error::{Error, TorqueMeasure};
use crate::gravity_gradient::averaged::averages::Averages;
use crate::gravity_gradient::averaged::equations::AveragedTorque;
use crate::gravity_gradient::constants::FASTEST_PRECESSION;
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::estimate::{by_orbit, errors};
use crate::gravity_gradient::first_order::mean_motion::{MeanMotion, first_order, weak_enough};
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::request::Request;
use crate::gravity_gradient::second_order::k2_remainder::SteadyRates;
use crate::gravity_gradient::second_order::mean_elements::SecondOrderData;
use crate::input::options::Level;
use crate::numerics::C64;
use crate::orbit::elements::Orbit;
use crate::torque_free::polhode::Polhode;

/// What the levels of a motion share.
pub(crate) struct Outset<'a> {
    pub(crate) polhode: &'a Polhode,
    pub(crate) attitude: UnitQuaternion<f64>,
    pub(crate) request: Request<'a>,
    /// The orbits of all disturbing bodies.
    pub(crate) orbits: Vec<Disturbance<'a>>,
    first: MeanMotion,
    refinements: Option<SecondOrderData>,
}

/// A motion at one level.
pub(crate) struct Draft {
    pub(crate) level: Level,
    pub(crate) motion: MeanMotion,
    pub(crate) averages: Averages,
    /// Whether the equations are averaged over the orbit as well.
    pub(crate) by_orbit: bool,
    /// The estimate of the error \[rad\].
    pub(crate) error: f64,
}

impl<'a> Outset<'a> {
    /// The mean motion of first order from a polhode, the attitude at the epoch, and the place of the state on the polhode: σ, ℓ′ and y′ − y.
    ///
    /// # Errors
    /// - [`Error::OneFixedOrbit`] for the second order under several bodies.
    /// - [`Error::TorqueTooStrong`] and [`Error::Resonance`] if there is no such motion, and the error of an orbit that is out of reach at the epoch.
    pub(crate) fn new(
        polhode: &'a Polhode,
        attitude: UnitQuaternion<f64>,
        (sigma, [anomaly, longitude]): (f64, [f64; 2]),
        request: &Request<'a>,
    ) -> Result<Self, Error> {
        let level = request.level;
        if level == Level::SecondOrder && !request.is_fixed() {
            return Err(Error::OneFixedOrbit { argument: "level", value: level.to_string() });
        }
        let frame = polhode.invariable_frame(attitude);
        let orbit = |orbit: &'a Orbit| Disturbance::new(orbit, request, polhode.scales.1, frame * Vector3::z());
        let orbits = request.orbits.iter().map(orbit).collect::<Result<Vec<_>, _>>()?;
        weak_enough(polhode, sigma, &orbits)?;
        let p = C64::from_polar(sigma.sqrt(), anomaly);
        let state = Mean { p, longitude, momentum: polhode.invariants.momentum.to_f64(), frame };
        let first = first_order(polhode, &state, &orbits)?;
        let refinements =
            request.is_refined().then(|| SecondOrderData::new(&first, &state, &orbits[0].start, &orbits[0]));
        Ok(Self { polhode, attitude, request: *request, orbits, first, refinements })
    }

    /// The motion at a level.
    ///
    /// # Errors
    /// As [`Outset::new`], those of the average over the orbit, and [`Error::TorqueTooStrong`] if the angular momentum precesses faster than the disturbing bodies move.
    pub(crate) fn draft(&self, level: Level) -> Result<Draft, Error> {
        let Self { polhode, orbits, first, .. } = self;
        let (motion, steady, left) = match &self.refinements {
            Some(refinements) => refinements.motion(polhode, first, &orbits[0], level)?,
            None => (first.clone(), SteadyRates::default(), [0.0; 2]),
        };
        let averages = Averages::new(polhode, (&motion, steady), orbits, level);
        slow_enough(&averages, orbits)?;
        let request = Request { level, ..self.request };
        let [error, further] = errors(&motion, &averages, orbits, (level, left));
        let by_orbit = by_orbit(&request, &orbits[0], further)?;
        let error = if by_orbit { error + further } else { error };
        Ok(Draft { level, motion, averages, by_orbit, error })
    }
}

/// Checks that the averaged equations can be solved: their solution on a quarter of the orbit is a polynomial, which cannot follow a faster precession.
fn slow_enough(averages: &Averages, orbits: &[Disturbance<'_>]) -> Result<(), Error> {
    let fastest = orbits.iter().fold(0.0_f64, |most, orbit| most.max(orbit.mean_motion));
    let turn = |(torque, orbit): (&AveragedTorque, &Disturbance<'_>)| {
        // The largest rate of the true anomaly within the span is half of that of twice the anomaly.
        let share = (0.5 * orbit.envelope.fastest / fastest).min(1.0);
        torque.precession.abs() * (1.0 + torque.eccentricity) * share
    };
    let size = averages.torques.iter().zip(orbits).map(turn).sum::<f64>();
    if size <= FASTEST_PRECESSION {
        return Ok(());
    }
    Err(Error::TorqueTooStrong { measure: TorqueMeasure::Precession, size, bound: FASTEST_PRECESSION })
}
