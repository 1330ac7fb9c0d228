//! The error bound under several disturbing bodies, or on orbits that precess.
//!
//! The second-order error is a quadratic form of the first-order changes that the bodies cause. It is estimated from the sum of their largest changes, so
//! that the terms which two bodies cause together are included. The largest change is sampled over the orientations that the angular momentum takes relative
//! to the orbits: it precesses about each orbit's normal, and the orbits turn about inertial axis 3.

use std::f64::consts::{PI, TAU};

use nalgebra::{Unit, UnitQuaternion, Vector3};

use super::{Budget, SAMPLES, SECOND_ORDER_MARGIN, SLOPE_SHARE, Sample, Subject, kronecker};
use crate::gravity_gradient::corrections::Demand;

/// Samples of one body over those of a fixed orbit: the orientations are more.
const MORE: usize = 2;
/// Irrational number for the angle of the node, apart from those of the other angles.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl Budget {
    /// The parts of the error for all bodies together.
    pub(in crate::gravity_gradient) fn of_bodies(
        subjects: &[Subject<'_>],
        demands: &[Demand<'_>],
        duration: f64,
    ) -> Self {
        let Subject { inertia, response, .. } = subjects[0];
        // Largest angle by which the angular momentum turns about any axis.
        let precession = subjects
            .iter()
            .zip(demands)
            .map(|(subject, demand)| 0.5 * subject.ellipse.strength().abs() * demand.mean_motion * duration);
        let precession = precession.sum::<f64>().min(PI);
        let normals: Vec<_> = subjects.iter().map(|subject| subject.ellipse.normal()).collect();
        let (mut size, mut p, mut sum, mut dropped, mut omitted) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (subject, demand) in subjects.iter().zip(demands) {
            let [largest, largest_p] = subject.largest_change_on(&normals, precession, demand);
            (size, p) = (size + largest, p + largest_p);
            let corrections = subject.corrections;
            sum += corrections.size;
            dropped += corrections.dropped + 2.0 * corrections.rest;
            omitted +=
                corrections.omitted + subject.omitted(demand.mean_motion) * (1.0 + demand.mean_motion * duration);
        }
        let [anomaly, longitude] = inertia.rate_slopes;
        let slope = f64::max(size, SLOPE_SHARE * sum);
        Self {
            spin: SECOND_ORDER_MARGIN * response.second_order([size, slope], p, duration),
            orbit: f64::INFINITY,
            dropped,
            omitted,
            rounding: 4.0 * f64::EPSILON * inertia.sigma * (anomaly.abs() + longitude.abs()) * duration,
            orbits: demands.iter().map(|demand| demand.mean_motion * duration / TAU).fold(0.0, f64::max),
        }
    }
}

impl Subject<'_> {
    /// The largest first-order change of the attitude by one body, and the largest change of p.
    fn largest_change_on(&self, normals: &[Unit<Vector3<f64>>], precession: f64, demand: &Demand<'_>) -> [f64; 2] {
        let duration = demand.duration;
        let [node, pericentre] = demand.rates.map(|rate| (rate.abs() * duration).min(PI));
        let about = |axis: &Unit<Vector3<f64>>, angle: f64, part: f64| {
            UnitQuaternion::from_axis_angle(axis, angle * (2.0 * part - 1.0))
        };
        let sample = |k: usize| {
            let [first, second, third, fourth] = kronecker(k);
            let fifth = (GOLDEN * (k as f64 + 0.5)).fract();
            let orbital = self.place(k, third);
            // A turn of the orbit in its plane is one of the body about its normal.
            let turn = about(&self.ellipse.normal(), pericentre, (fifth + 0.5 * fourth).fract())
                * about(&Vector3::z_axis(), node, fifth)
                * about(&normals[k % normals.len()], precession, fourth);
            Sample { angles: [first, second], orbital, turn }
        };
        self.largest_among(&(0..MORE * SAMPLES).map(sample).collect::<Vec<_>>())
    }
}
