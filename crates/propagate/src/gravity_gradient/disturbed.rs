//! Rotation under the gravity gradient of one or more bodies on Keplerian orbits (theory §9).
//!
//! The mean motion is the free motion at the mean σ and M, in an invariable frame that the averaged torque moves ([`crate::gravity_gradient::averaged`]). Short-period
//! [`crate::gravity_gradient::first_order::corrections`] of first order lead from it to the motion. To first order the torques of several bodies, and their corrections, add up. Both are
//! regular at J = 0 and at any inclination. Validity: the rotation is much faster than the orbit, and the torque is weak. A divisor that is too small is
//! [`Error::Resonance`]. The error is of second order in the torque and grows with time.

use std::f64::consts::{PI, TAU};

use nalgebra::UnitQuaternion;

use andoyer_double::DoubleDouble;

use crate::error::Error;
use crate::gravity_gradient::averaged::averages::AveragedMotion;
use crate::gravity_gradient::averaged::bodies::most_arcs;
use crate::gravity_gradient::averaged::spin::MOST_QUARTERS;
use crate::gravity_gradient::draft::{Draft, Outset};
use crate::gravity_gradient::estimate::MOST_ORBITS;
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::mean_motion::MeanMotion;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::inertia::WobbleSeries;
use crate::gravity_gradient::request::Request;
use crate::input::options::{Averaging, Level};
use crate::motion::plan::GradientPlan;
use crate::numerics::C64;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::orbit::position::Path;
use crate::torque_free::polhode::{Frame, Polhode};

/// A motion under the gravity gradient.
#[derive(Clone, Debug)]
pub(crate) struct DisturbedMotion {
    pub(crate) inertia: Inertia,
    pub(crate) pair: [WobbleSeries; 2],
    /// The path of each disturbing body, and its corrections. There is at least one.
    pub(crate) bodies: Vec<(Path, Corrections)>,
    pub(crate) slow: AveragedMotion,
    /// The constant part of p e^(−iℓ′): √σ, and what corrects the error of first order at the epoch.
    pub(crate) circle: C64,
    /// Rate of √σ, the real part of p e^(−iℓ′), by K2, in the user's unit.
    pub(crate) widening: f64,
    /// The constant part of M: the mean M, and what corrects the error of first order at the epoch.
    pub(crate) momentum: f64,
    pub(crate) anomaly: Phase,
    pub(crate) half_longitude: Phase,
    /// First order: change of ℓ′ and y′ for each unit of the phase integral Ψ. Second order: 1 and 1; the drifts are changes themselves.
    pub(crate) drifts: [f64; 2],
    /// The rates that they add to ℓ′ and y′ in the orbit average, in the user's unit.
    secular: [f64; 2],
    pub(crate) frame: Frame,
    pub(crate) moments: [f64; 3],
    level: Level,
    /// The motion's units of rate and of angular momentum, in the user's units.
    pub(crate) units: [f64; 2],
    pub(crate) error: f64,
}

impl DisturbedMotion {
    /// The motion of a draft: the constants for which it passes through the state are found here.
    ///
    /// # Errors
    /// [`Error::SpanOfBodies`] if the averaged equations are not solved over all of the span.
    pub(crate) fn new(outset: &Outset<'_>, draft: Draft) -> Result<Self, Error> {
        let Outset { polhode, attitude, request, orbits, .. } = outset;
        let Draft { level, motion, averages, by_orbit, error } = draft;
        let wobble = motion.largest_wobble();
        let MeanMotion { mean, change, inertia, corrections, .. } = motion;
        let exponent = polhode.scales.1;
        let momentum = polhode.invariants.momentum.to_f64();
        // Rates are proportional to M. M rounded to a double would cause an error of 1e-16 of the phases.
        let precise = (polhode.invariants.momentum - change.momentum.into()) / mean.momentum.into();
        let [anomaly_rate, longitude_rate] = inertia.rates.map(|rate| {
            let rate = rate * precise;
            DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) }
        });
        let unit = scaled(1.0, exponent);
        let factors = averages.per_phase(&inertia);
        let slow = |frame| averages.slow(frame, (request, by_orbit), orbits, (unit, factors));
        let mut gradient = Self {
            anomaly: Phase::new(anomaly_rate, mean.p.arg()),
            half_longitude: Phase::new(longitude_rate * 0.5.into(), 0.5 * mean.longitude),
            circle: mean.p.norm().into(),
            widening: averages.steady().action / (2.0 * inertia.root() * inertia.momentum) * unit,
            momentum: inertia.momentum,
            drifts: if level == Level::SecondOrder { [1.0; 2] } else { factors },
            secular: averages.secular(&inertia, &mean).map(|rate| rate * unit),
            pair: inertia.pair.each_ref().map(|series| WobbleSeries::new(series, wobble)),
            inertia,
            slow: slow(mean.frame),
            bodies: orbits.iter().map(|orbit| orbit.path.clone()).zip(corrections).collect(),
            frame: polhode.frame.clone(),
            moments: polhode.moments,
            level,
            units: [unit, polhode.user_momentum() / momentum],
            error,
        };
        gradient.start_at(polhode, *attitude, mean.frame, slow);
        let bound = gradient.bound();
        if request.spanned && request.duration() > bound {
            return Err(Error::SpanOfBodies { value: request.duration(), bound });
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
        matches!(self.slow, AveragedMotion::Spin(_))
    }

    /// The longest time from the epoch for which the averaged equations are solved, in the user's unit.
    pub(crate) fn bound(&self) -> f64 {
        match &self.slow {
            AveragedMotion::Spin(_) => MOST_ORBITS as f64 / self.bodies[0].0.mean_anomaly.frequency(),
            AveragedMotion::Orbit(precession) => precession.bound(MOST_QUARTERS),
            // In a unit of time there are no more arcs than in all orbits together.
            AveragedMotion::Bodies(_) => {
                MOST_QUARTERS as f64 / self.bodies.iter().map(|(path, _)| most_arcs(path)).sum::<f64>()
            }
        }
    }

    /// The entries of the plan.
    pub(crate) fn plan(&self) -> GradientPlan {
        let size = self.bodies.iter().map(|(_, corrections)| corrections.size).sum::<f64>();
        let neglected = self.bodies.iter().map(|(_, corrections)| corrections.neglected);
        GradientPlan {
            averaging: match self.slow {
                AveragedMotion::Spin(_) | AveragedMotion::Bodies(_) => Averaging::Spin,
                AveragedMotion::Orbit(_) => Averaging::Orbit,
            },
            level: self.level,
            terms: self.bodies.iter().map(|(_, corrections)| corrections.count).sum(),
            size,
            neglected: neglected.fold(size * size, f64::max),
        }
    }

    /// The parts of the theory that this scene did not need.
    pub(crate) fn skipped(&self) -> Vec<String> {
        let mut skipped = Vec::new();
        let dropped = self.bodies.iter().map(|(_, corrections)| corrections.dropped).sum::<f64>();
        if dropped > 0.0 {
            skipped.push(format!("short-period terms: the dropped terms sum to {dropped:.1e} rad"));
        }
        if self.bodies.iter().all(|(path, _)| path.ellipse.eccentricity == 0.0) {
            let orbits = if self.bodies.len() == 1 { "the orbit is a circle" } else { "the orbits are circles" };
            skipped.push(format!("Kepler's equation: {orbits}"));
        }
        skipped
    }
}

/// The motion under a gravity gradient at the level that is asked for, and why it is not of second order if that was left open.
///
/// # Errors
/// Errors of [`Outset::new`], [`Outset::draft`] and [`DisturbedMotion::new`]. With [`Level::Auto`] only those of the first-order draft; an error of second order is
/// returned as the reason.
pub(crate) fn chosen(
    polhode: &Polhode,
    attitude: UnitQuaternion<f64>,
    osculating: (f64, [f64; 2]),
    request: &Request<'_>,
) -> Result<(DisturbedMotion, Option<String>), Error> {
    let outset = Outset::new(polhode, attitude, osculating, request)?;
    if request.level != Level::Auto {
        return Ok((DisturbedMotion::new(&outset, outset.draft(request.level)?)?, None));
    }
    let first = outset.draft(Level::Full)?;
    let reason = if first.error <= request.tolerance {
        "first order meets the tolerance".to_owned()
    } else if !request.is_fixed() {
        "several disturbing bodies, and orbits that precess, are of first order".to_owned()
    } else {
        match outset.draft(Level::SecondOrder) {
            Ok(second) if second.error < first.error => match DisturbedMotion::new(&outset, second) {
                Ok(second) => return Ok((second, None)),
                Err(error) => error.to_string(),
            },
            Ok(second) if second.error >= PI => "its error bound is half a turn or more".to_owned(),
            Ok(second) => format!("its error bound, {:.1e} rad, is no smaller", second.error),
            Err(error) => error.to_string(),
        }
    };
    Ok((DisturbedMotion::new(&outset, first)?, Some(format!("second order: {reason}"))))
}
