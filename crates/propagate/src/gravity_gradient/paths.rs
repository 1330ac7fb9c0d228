//! The orbits of the disturbing bodies over the span of a motion, and what the corrections for each are to be.

use nalgebra::Vector3;

use super::corrections::{Demand, GROWING_SHARE, REFINED_SHARE};
use super::course::{Course, When};
use super::envelope::{Envelope, Reach};
use super::orbit_series::OrbitSeries;
use super::request::Request;
use crate::error::Error;
use crate::input::options::Level;
use crate::input::orbit::Orbit;
use crate::numerics::scaling::scaled;
use crate::simd::lanes::Lanes;

/// The orbits of the disturbing bodies from the epoch.
pub(super) struct Paths {
    pub(super) courses: Vec<Course>,
    /// Positions at the epoch.
    pub(super) starts: Vec<When<pulp::Scalar>>,
    pub(super) reaches: Vec<Reach>,
    pub(super) envelopes: Vec<Envelope>,
    /// The orbits' harmonics, where divisors are to be exact in them.
    series: Vec<Option<OrbitSeries>>,
    /// Longest time from the epoch, in the units of the tables.
    pub(super) duration: f64,
}

impl Paths {
    pub(super) fn new(request: &Request<'_>, exponent: i32) -> Self {
        let duration = scaled(request.duration(), exponent);
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let mut paths =
            Self { courses: vec![], starts: vec![], reaches: vec![], envelopes: vec![], series: vec![], duration };
        for orbit in request.orbits {
            let course = Course::new(orbit, request.epoch);
            let start = course.at((none, none));
            let (mean_motion, eccentricity) = (scaled(orbit.mean_motion(), -exponent), orbit.eccentricity());
            let anomaly = start.place.angle.values()[0] - start.place.centre.values()[0];
            let sides = request.sides.map(|time| mean_motion * scaled(time, exponent));
            let reach = Reach { eccentricity, anomaly, sides };
            let rates = orbit.rates().map(|rate| scaled(rate, -exponent));
            paths.envelopes.push(Envelope::new(eccentricity, mean_motion, rates, &reach));
            paths.series.push(if request.is_refined() { OrbitSeries::new(&reach) } else { None });
            paths.reaches.push(reach);
            paths.starts.push(start);
            paths.courses.push(course);
        }
        paths
    }

    /// What the corrections for each body are to be, with the direction of the angular momentum at the epoch.
    pub(super) fn demands<'a>(
        &'a self,
        request: &Request<'a>,
        exponent: i32,
        pole: Vector3<f64>,
    ) -> Result<Vec<Demand<'a>>, Error> {
        let Request { level, tolerance, epoch, .. } = *request;
        let share = if request.is_refined() { REFINED_SHARE } else { GROWING_SHARE };
        let level = if level == Level::Auto { Level::Full } else { level };
        let demand = |((orbit, envelope), series): ((&'a Orbit, &'a Envelope), &'a Option<OrbitSeries>)| {
            orbit.within_reach(epoch)?;
            let [node, pericentre] = orbit.rates();
            let [mean_motion, node, pericentre] =
                [orbit.mean_motion(), node, pericentre].map(|rate| scaled(rate, -exponent));
            let (axes, rates, duration) = (orbit.axes_at(epoch), [node, pericentre], self.duration);
            let (refined, series) = (request.is_refined(), series.as_ref());
            Ok(Demand {
                orbit,
                mean_motion,
                rates,
                axes,
                level,
                tolerance,
                duration,
                share,
                refined,
                series,
                envelope,
                pole,
            })
        };
        request.orbits.iter().zip(&self.envelopes).zip(&self.series).map(demand).collect()
    }
}
