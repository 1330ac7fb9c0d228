//! The orbit of one disturbing body over the span of a motion.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::error::Error;
use crate::gravity_gradient::constants::{FEWEST_ORBITS, LOG_CUTOFF, MOST_HARMONICS};
use crate::gravity_gradient::request::{Ledger, Request};
use crate::input::options::Level;
use crate::numerics::scaling::scaled;
use crate::orbit::elements::Orbit;
use crate::orbit::hansen::OrbitSeries;
use crate::orbit::position::{Path, Position, singularity};
use crate::orbit::span::{Envelope, Reach};
use crate::simd::lanes::Lanes;
use crate::torque::strength_for;

/// The orbit of one disturbing body from the epoch, in the units of the tables, and what is required of the corrections for it.
pub(crate) struct Disturbance<'a> {
    pub(crate) orbit: &'a Orbit,
    pub(crate) mean_motion: f64,
    /// Rates of node and pericentre.
    pub(crate) rates: [f64; 2],
    pub(crate) path: Path,
    /// The position at the epoch.
    pub(crate) start: Position<pulp::Scalar>,
    /// The time derivatives of (a/r)³ r̂r̂, with their sizes at the epoch, within the span and at any time.
    pub(crate) envelope: Envelope,
    /// The orbit's harmonics, where divisors are to be exact in them.
    pub(crate) series: Option<OrbitSeries>,
    pub(crate) level: Level,
    /// Longest time from the epoch.
    pub(crate) duration: f64,
    /// The parts of the tolerance.
    pub(crate) ledger: Ledger,
    /// The direction of the angular momentum at the epoch.
    pub(crate) pole: Vector3<f64>,
}

impl<'a> Disturbance<'a> {
    /// The orbit of a request. `exponent` is the binary exponent of the unit of time of the tables, `pole` the direction of the angular momentum at the epoch.
    ///
    /// # Errors
    /// The error of an orbit that is out of reach at the epoch.
    pub(crate) fn new(
        orbit: &'a Orbit,
        request: &Request<'_>,
        exponent: i32,
        pole: Vector3<f64>,
    ) -> Result<Self, Error> {
        orbit.within_reach(request.epoch)?;
        let path = Path::new(orbit, request.epoch);
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let start = path.at((none, none));
        let (mean_motion, eccentricity) = (scaled(orbit.mean_motion(), -exponent), orbit.eccentricity());
        let anomaly = start.place.angle.values()[0] - start.place.centre.values()[0];
        let sides = request.sides.map(|time| mean_motion * scaled(time, exponent));
        let reach = Reach { eccentricity, anomaly, sides };
        let rates = orbit.rates().map(|rate| scaled(rate, -exponent));
        Ok(Self {
            orbit,
            mean_motion,
            rates,
            path,
            start,
            envelope: Envelope::new(mean_motion, rates, &reach),
            series: if request.is_refined() { series(&reach) } else { None },
            level: if request.level == Level::Auto { Level::Full } else { request.level },
            duration: scaled(request.duration(), exponent),
            ledger: Ledger::new(request.tolerance, request.is_refined()),
            pole,
        })
    }

    /// The unit of rates of the tables, in the user's.
    pub(crate) fn unit(&self) -> f64 {
        self.orbit.mean_motion() / self.mean_motion
    }

    /// The strength of the torque Γ.
    pub(crate) fn strength(&self) -> f64 {
        strength_for(self.orbit, self.mean_motion)
    }

    /// Largest change of the frequencies of the torque by the rates of node and pericentre.
    pub(crate) fn turning(&self) -> f64 {
        2.0 * (self.rates[0].abs() + self.rates[1].abs())
    }

    /// (a/r)³ r̂r̂ contains only multiples of this frequency: of n, or of 2n on a circle.
    pub(crate) fn orbital_step(&self) -> f64 {
        self.mean_motion * if self.orbit.eccentricity() == 0.0 { 2.0 } else { 1.0 }
    }
}

/// The harmonics of an orbit, or `None` if it needs too many or the longer side of the span is shorter than [`FEWEST_ORBITS`]. Far from the pericentre the sums over
/// time derivatives are better until the next passage, because the series takes the mean over all passages.
pub(crate) fn series(reach: &Reach) -> Option<OrbitSeries> {
    let fewest = FEWEST_ORBITS[usize::from(reach.eccentricity == 0.0 || reach.passes())];
    // They fall like e^(−|j|(arcosh 1/e − η)), as Hansen's coefficients do.
    let count = if reach.eccentricity == 0.0 { 2.0 } else { 6.0 + LOG_CUTOFF / singularity(reach.eccentricity) };
    let few = count <= MOST_HARMONICS && reach.longest() >= fewest * TAU;
    few.then(|| OrbitSeries::new(reach.eccentricity, count as usize))
}

/// An orbit over whole revolutions from the pericentre on, without any tolerance.
#[cfg(test)]
pub(crate) fn whole(orbit: &Orbit, pole: Vector3<f64>) -> Disturbance<'_> {
    let request = Request {
        orbits: std::slice::from_ref(orbit),
        averaging: crate::input::options::Averaging::Auto,
        level: Level::Full,
        tolerance: 1e-30,
        epoch: 0.0,
        sides: [std::f64::consts::TAU / orbit.mean_motion(); 2],
        spanned: true,
    };
    let whole = Disturbance::new(orbit, &request, 0, pole).expect("within reach");
    Disturbance { ledger: Ledger { of_second_order: 0.0, ..whole.ledger }, duration: 0.0, ..whole }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn orbits_with_too_many_harmonics_and_spans_without_a_pericentre_are_left_to_the_sums() {
        let serves = |eccentricity: f64, anomaly: f64, orbits: f64| {
            series(&Reach { eccentricity, anomaly, sides: [TAU * orbits, 0.0] }).is_some()
        };
        assert!(serves(0.0, 1.0, 3.0) && serves(0.8, 1.0, 3.0) && !serves(0.82, 1.0, 3.0));
        assert!(serves(0.3, 1.0, 0.4) && !serves(0.3, PI, 0.4) && serves(0.0, PI, 0.4) && !serves(0.3, 1.0, 0.2));
    }
}
