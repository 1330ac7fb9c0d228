//! A motion at one level, before its constants are found: the mean motion, the averaged torques, and the error estimate. What the levels share is computed once.

use nalgebra::{UnitQuaternion, Vector3};

use crate::error::{Error, TorqueMeasure};
use crate::gravity_gradient::averaged::averaged_orbit::AveragedOrbit;
use crate::gravity_gradient::averaged::torque::Averages;
use crate::gravity_gradient::estimate::Estimate;
use crate::gravity_gradient::first_order::mean_motion::{MeanMotion, first_order, weak_enough};
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::orbit::elliptic_orbit::{Demand, EllipticOrbit};
use crate::gravity_gradient::request::Request;
use crate::gravity_gradient::second_order::k2_remainder::SteadyRates;
use crate::gravity_gradient::second_order::mean_elements::SecondOrderData;
use crate::input::options::Level;
use crate::numerics::C64;
use crate::torque_free::polhode::Polhode;

/// Largest precession of the angular momentum in one radian of the true anomaly, or of the fastest orbit if that is shorter \[rad\]. At this limit polynomials
/// of degree 15 follow the frame to 1e-10 rad.
const FASTEST_PRECESSION: f64 = 0.3;

/// What the levels of a motion share.
pub(crate) struct Outset<'a> {
    pub(crate) polhode: &'a Polhode,
    pub(crate) attitude: UnitQuaternion<f64>,
    pub(crate) request: Request<'a>,
    pub(crate) orbits: &'a [EllipticOrbit<'a>],
    demands: Vec<Demand<'a>>,
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
        osculating: (f64, [f64; 2]),
        (request, orbits): (&Request<'a>, &'a [EllipticOrbit<'a>]),
    ) -> Result<Self, Error> {
        let level = request.level;
        if level == Level::SecondOrder && !request.is_fixed() {
            return Err(Error::OneFixedOrbit { argument: "level", value: level.to_string() });
        }
        let pole = polhode.invariable_frame(attitude) * Vector3::z();
        let demand = |orbit: &'a EllipticOrbit<'a>| orbit.demand(request, polhode.scales.1, pole);
        let demands = orbits.iter().map(demand).collect::<Result<Vec<_>, _>>()?;
        weak_enough(polhode, osculating.0, &demands)?;
        let (sigma, [anomaly, longitude]) = osculating;
        let p = C64::from_polar(sigma.sqrt(), anomaly);
        let momentum = polhode.invariants.momentum.to_f64();
        let state = Mean { p, longitude, momentum, frame: polhode.invariable_frame(attitude) };
        let first = first_order(polhode, &state, orbits, &demands)?;
        let refinements =
            request.is_refined().then(|| SecondOrderData::new(&first, &state, &orbits[0].start, &demands[0]));
        Ok(Self { polhode, attitude, request: *request, orbits, demands, first, refinements })
    }

    /// The motion at a level.
    ///
    /// # Errors
    /// As [`Outset::new`], those of the average over the orbit, and [`Error::TorqueTooStrong`] if the angular momentum precesses faster than the disturbing bodies move.
    pub(crate) fn draft(&self, level: Level) -> Result<Draft, Error> {
        let Self { polhode, demands, first, .. } = self;
        let (motion, steady, left) = match &self.refinements {
            Some(refinements) => refinements.motion(polhode, first, &demands[0], level)?,
            None => (first.clone(), SteadyRates::default(), [0.0; 2]),
        };
        let averages = Averages::new(polhode, (&motion, steady), demands, level);
        slow_enough(&averages, demands)?;
        let request = Request { level, ..self.request };
        let estimate = Estimate::new(&motion.inertia, &motion.corrections, &averages, demands, (level, left));
        let by_orbit = estimate.by_orbit(&request)?;
        Ok(Draft { level, motion, averages, by_orbit, error: estimate.error(by_orbit) })
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
