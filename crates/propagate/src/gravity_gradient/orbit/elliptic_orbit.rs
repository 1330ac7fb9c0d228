//! The orbit of one disturbing body over the span of a motion.

use nalgebra::Vector3;

use super::elliptic_motion::{Course, When};
use super::hansen::OrbitSeries;
use super::span::{Envelope, Reach};
use crate::error::Error;
use crate::gravity_gradient::request::Ledger;
use crate::gravity_gradient::request::Request;
use crate::input::options::Level;
use crate::input::orbit::Orbit;
use crate::numerics::scaling::scaled;
use crate::simd::lanes::Lanes;

/// The orbit of one disturbing body from the epoch, in the units of the tables. The rotation does not enter it.
pub(crate) struct EllipticOrbit<'a> {
    pub(crate) orbit: &'a Orbit,
    mean_motion: f64,
    /// Of node and pericentre.
    rates: [f64; 2],
    pub(crate) course: Course,
    /// The position at the epoch.
    pub(crate) start: When<pulp::Scalar>,
    envelope: Envelope,
    /// The orbit's harmonics, where divisors are to be exact in them.
    series: Option<OrbitSeries>,
}

impl<'a> EllipticOrbit<'a> {
    pub(crate) fn new(orbit: &'a Orbit, request: &Request<'_>, exponent: i32) -> Self {
        let course = Course::new(orbit, request.epoch);
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let start = course.at((none, none));
        let (mean_motion, eccentricity) = (scaled(orbit.mean_motion(), -exponent), orbit.eccentricity());
        let anomaly = start.place.angle.values()[0] - start.place.centre.values()[0];
        let sides = request.sides.map(|time| mean_motion * scaled(time, exponent));
        let reach = Reach { eccentricity, anomaly, sides };
        let rates = orbit.rates().map(|rate| scaled(rate, -exponent));
        let envelope = Envelope::new(eccentricity, mean_motion, rates, &reach);
        let series = if request.is_refined() { OrbitSeries::new(&reach) } else { None };
        Self { orbit, mean_motion, rates, course, start, envelope, series }
    }

    /// What the corrections for this orbit are to be, with the direction of the angular momentum at the epoch.
    pub(crate) fn demand(
        &'a self,
        request: &Request<'_>,
        exponent: i32,
        pole: Vector3<f64>,
    ) -> Result<Demand<'a>, Error> {
        let Request { level, tolerance, epoch, .. } = *request;
        self.orbit.within_reach(epoch)?;
        Ok(Demand {
            orbit: self.orbit,
            mean_motion: self.mean_motion,
            rates: self.rates,
            axes: self.orbit.axes_at(epoch),
            level: if level == Level::Auto { Level::Full } else { level },
            duration: scaled(request.duration(), exponent),
            ledger: Ledger::new(tolerance, request.is_refined()),
            series: self.series.as_ref(),
            envelope: &self.envelope,
            pole,
        })
    }
}

/// The requirements on the corrections.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand<'a> {
    pub(crate) orbit: &'a Orbit,
    /// Mean motion of the orbit, in the units of the tables.
    pub(crate) mean_motion: f64,
    /// Rates of node and pericentre, in the units of the tables.
    pub(crate) rates: [f64; 2],
    /// The axes of the orbit at the epoch.
    pub(crate) axes: [Vector3<f64>; 3],
    pub(crate) level: Level,
    /// Longest time from the epoch, in the units of the tables.
    pub(crate) duration: f64,
    /// The parts of the tolerance.
    pub(crate) ledger: Ledger,
    /// The orbit's harmonics, where divisors are to be exact in them.
    pub(crate) series: Option<&'a OrbitSeries>,
    /// The time derivatives of (a/r)³ r̂r̂, with their sizes at the epoch, within the span and at any time.
    pub(crate) envelope: &'a Envelope,
    /// The direction of the angular momentum at the epoch.
    pub(crate) pole: Vector3<f64>,
}

impl Demand<'_> {
    /// q = 3φn²/2, with the disturbing mass fraction φ.
    pub(crate) fn strength(&self) -> f64 {
        1.5 * self.mean_motion * self.mean_motion * self.orbit.disturbing_fraction()
    }

    /// (a/r)³ r̂r̂ contains only multiples of this frequency: of n, or of 2n on a circle.
    pub(crate) fn orbital_step(&self) -> f64 {
        self.mean_motion * if self.orbit.eccentricity() == 0.0 { 2.0 } else { 1.0 }
    }
}
