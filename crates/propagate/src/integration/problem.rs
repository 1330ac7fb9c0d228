//! What is integrated: the equations with the state, the times and their unit, and what is known of it before a step.

use andoyer_double::two_sum;

use super::expansion::Equations;
use super::paths::path_series::PathSeries;
use super::rates::{covered, of_interpolation, rates_of_orbit, rates_of_sources, rates_of_table};
use super::series::{Row, largest};
use super::torques::Torques;
use crate::error::Error;
use crate::input::scene::Scene;
use crate::numerics::scaling::{exponent, scaled};
use crate::orbit::disturbing_body::DisturbingBody;

/// Relative truncation error of a step. The sum of such errors over all steps is below the rounding error.
pub(super) const FINEST: f64 = 1e-19;
/// The largest relative truncation error that a step is given.
const COARSEST: f64 = 1e-6;
/// Truncation error of the first integration, over tolerance/(10 + phase²). A third of it costs 8 % more time, but fewer motions are integrated a second time.
const CAREFUL: f64 = 0.06;

/// The equations with the state and the times.
pub(super) struct Problem {
    pub(super) equations: Equations<4>,
    pub(super) attitude: Row,
    pub(super) rates: Row,
    pub(super) exponent: i32,
    pub(super) tolerance: f64,
    /// The largest of all rates, that at the pericentre among them.
    pub(super) fastest: f64,
    /// The largest of the secular rates.
    pub(super) secular: f64,
    /// From the epoch, in double-double and the unit of the integration.
    pub(super) ends: [(f64, f64); 2],
    pub(super) reach: [f64; 2],
    /// Number of torques beside the gravity gradient.
    pub(super) torques: usize,
    pub(super) of_interpolation: f64,
}

impl Problem {
    pub(super) fn new(scene: &Scene, reason: &str) -> Result<Self, Error> {
        let (start, stop) = scene.asked_span().ok_or_else(|| Error::NoSpan { reason: reason.to_owned() })?;
        let epoch = scene.state().epoch;
        let (start, stop) = (start.min(epoch), stop.max(epoch));
        let spin = scene.state().angular_velocity.norm();
        let (mut fastest, mut lasting, mut secular, mut square) = (spin, spin, 0.0_f64, 0.0_f64);
        for body in scene.asked_disturbing() {
            let (rate, least) = match body {
                DisturbingBody::Orbit(orbit) => {
                    orbit.within_reach(epoch)?;
                    lasting = lasting.max(orbit.mean_motion());
                    secular = orbit.rates().iter().fold(secular, |most, rate| most.max(rate.abs()));
                    rates_of_orbit(orbit, [start, stop])
                }
                DisturbingBody::Tabulated(table) => {
                    covered(table, (start, stop))?;
                    rates_of_table(table)
                }
            };
            fastest = fastest.max(rate);
            lasting = lasting.max(least);
            square += least * least;
        }
        let sources = rates_of_sources(scene, (start, stop))?;
        let of_interpolation = of_interpolation(scene, (start, stop))?;
        (fastest, lasting, secular) = (fastest.max(sources[0]), lasting.max(sources[1]), secular.max(sources[2]));
        if let Some(torques) = Torques::new(scene, 0, false) {
            let [rate, least] = torques.rates();
            fastest = fastest.max(rate);
            lasting = lasting.max(least);
            square += least * least;
        }
        // A coefficient of order k is a rate to the power k: the unit is the mean of a pericentre and the rest, so that neither leaves the range of a double. At
        // rest it is the longer side, for the powers of a step.
        let longest = (epoch - start).max(stop - epoch);
        let exponent = if fastest > 0.0 { (exponent(fastest) + exponent(lasting)) / 2 } else { -exponent(longest) };
        let scale = scaled(square.sqrt(), -exponent).max(f64::MIN_POSITIVE);
        let rates = scene.state().angular_velocity.map(|rate| scaled(rate, -exponent));
        let end = |time: f64| {
            let (high, low) = two_sum(time, -epoch);
            (scaled(high, exponent), scaled(low, exponent))
        };
        Ok(Self {
            equations: Equations::new(scene, exponent, scale),
            attitude: scene.state().attitude.coords.into(),
            rates: [rates.x, rates.y, rates.z, 0.0],
            exponent,
            tolerance: scene.asked_tolerance(),
            fastest: scaled(fastest, -exponent),
            secular: scaled(secular, -exponent),
            ends: [end(start), end(stop)],
            reach: [start - epoch, stop - epoch],
            torques: scene.acting_torques().len(),
            of_interpolation,
        })
    }

    /// Whether a disturbing body has a table.
    pub(super) fn tabulated(&self) -> bool {
        self.equations.paths().any(|body| matches!(body, PathSeries::Tabulated(_)))
    }

    /// Radians of the fastest rate over the longer side.
    pub(super) fn phase(&self) -> f64 {
        let longest = self.ends[0].0.abs().max(self.ends[1].0.abs());
        let [x, y, z, _] = self.rates;
        longest * x.hypot(y).hypot(z).max(self.equations.scale)
    }

    /// An estimate of the number of steps: two a radian of the fastest of the rates that last, and eight a passage of a pericentre, where a step is e^−2 of the radius
    /// of convergence or more.
    pub(super) fn most_steps(&self) -> f64 {
        let longest = self.ends[0].0.abs().max(self.ends[1].0.abs());
        let passages: f64 = self.equations.paths().flat_map(|body| self.ends.map(|end| body.passed(end))).sum();
        10.0 + 2.0 * self.phase().max(self.secular * longest) + 8.0 * passages
    }

    /// ω × Iω in Euler's equations at the epoch, relative to the square of the rates.
    pub(super) fn gyration(&self) -> f64 {
        let [x, y, z, _] = self.rates;
        let square = x * x + y * y + z * z;
        let products = [y * z, z * x, x * y, 0.0];
        if square > 0.0 { largest(&self.equations.factors) * largest(&products) / square } else { 0.0 }
    }

    /// The relative truncation error of the first integration: those of the rates add up over the steps, and their effect on the angle over time.
    pub(super) fn first_error(&self) -> f64 {
        let phase = self.phase();
        (CAREFUL * self.tolerance / (10.0 + phase * phase)).clamp(FINEST, COARSEST)
    }
}
