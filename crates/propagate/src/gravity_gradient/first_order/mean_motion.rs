//! The mean motion from which the corrections lead to a state: its mean variables, tables, and corrections.

use super::corrections::Corrections;
use super::mean_variables::{Mean, PeriodicChange};
use crate::error::{Error, TorqueMeasure};
use crate::gravity_gradient::constants::{CONVERGED, LARGEST_CONTRACTION, STRONGEST};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::regime::Terms;
use crate::gravity_gradient::terms::term::Sensitivity;
use crate::orbit::elements::Orbit;
use crate::torque::strength_for;
use crate::torque_free::polhode::Polhode;

/// Largest number of iterations for the mean variables.
const MOST_STEPS: usize = 24;

/// A mean state, its change to the osculating state, and its tables.
#[derive(Clone)]
pub(crate) struct MeanMotion {
    pub(crate) mean: Mean,
    pub(crate) change: PeriodicChange,
    pub(crate) inertia: Inertia,
    /// Of each body.
    pub(crate) corrections: Vec<Corrections>,
}

impl MeanMotion {
    /// Upper estimate of |p| over the motion: √σ, and the changes of p by all terms. Where the mean wobble is 0, the torque still forces one.
    pub(crate) fn largest_wobble(&self) -> f64 {
        let turned: f64 = self.corrections.iter().map(|corrections| corrections.size + corrections.rms).sum();
        self.inertia.sigma.sqrt() + turned / Sensitivity::new(&self.inertia).gain
    }
}

/// The corrections for each body at a mean motion.
fn corrections_of(inertia: &Inertia, orbits: &[Disturbance<'_>]) -> Result<Vec<Corrections>, Error> {
    let all: Vec<_> = orbits.iter().map(|disturbance| Terms::new(inertia, disturbance)).collect();
    let whole = all.iter().map(|terms| terms.size).sum();
    all.iter().zip(orbits).map(|(terms, disturbance)| Corrections::of(terms, inertia, disturbance, whole)).collect()
}

/// The mean variables whose corrections give a state, by fixed-point iteration.
pub(crate) fn first_order(polhode: &Polhode, state: &Mean, orbits: &[Disturbance<'_>]) -> Result<MeanMotion, Error> {
    let (mut mean, mut change) = (*state, PeriodicChange::default());
    let (mut step, mut first) = (0, 0.0_f64);
    let mut inertia = Inertia::new(polhode, mean.p.norm_sqr(), mean.momentum);
    // Each iteration multiplies the error by the size of the corrections, which is at most a twentieth (`LARGEST_SIZE`) for the terms that are not slow.
    loop {
        let corrections = corrections_of(&inertia, orbits)?;
        let changes =
            corrections.iter().zip(orbits).map(|(corrections, orbit)| corrections.at(&mean, &orbit.start.place));
        let next_change = changes.reduce(|sum, change| sum.plus(&change)).unwrap_or_default();
        let next = state.changed(&next_change, -1.0);
        let moved = (next.p - mean.p).norm()
            + (next.longitude - mean.longitude).abs()
            + (next.momentum / mean.momentum - 1.0).abs()
            + next.frame.angle_to(&mean.frame);
        if moved <= CONVERGED {
            return Ok(MeanMotion { mean, change, inertia, corrections });
        }
        first = first.max(moved);
        if step == MOST_STEPS {
            // Rounding of large corrections may prevent full convergence. A motion without contraction has no mean motion.
            let contraction = (moved / first).powf(1.0 / MOST_STEPS as f64);
            return if contraction <= LARGEST_CONTRACTION {
                Ok(MeanMotion { mean, change, inertia, corrections })
            } else {
                Err(Error::TorqueTooStrong {
                    measure: TorqueMeasure::Contraction,
                    size: contraction,
                    bound: LARGEST_CONTRACTION,
                })
            };
        }
        (mean, change) = (next, next_change);
        inertia = inertia.moved(polhode, mean.p.norm_sqr(), mean.momentum);
        step += 1;
    }
}

/// The largest torque over M²/C: 3n²C(C − A)/2M² at the pericentre times the mass fraction, where C is the largest and A the smallest moment; `rate` is n/M.
pub(crate) fn strongest_torque(polhode: &Polhode, orbit: &Orbit, rate: f64) -> f64 {
    let [first, _, third] = polhode.moments;
    let product = first.max(third) * (first - third).abs();
    strength_for(orbit, rate) * product / (1.0 - orbit.eccentricity()).powi(3)
}

/// Checks that the torques are weak enough for first order.
pub(crate) fn weak_enough(polhode: &Polhode, sigma: f64, orbits: &[Disturbance<'_>]) -> Result<(), Error> {
    let momentum = polhode.invariants.momentum.to_f64();
    let size = |disturbance: &Disturbance<'_>| {
        let share = disturbance.envelope.span[0] / disturbance.envelope.most[0];
        share * strongest_torque(polhode, disturbance.orbit, disturbance.mean_motion / momentum)
    };
    let size = orbits.iter().map(size).sum::<f64>();
    if size <= STRONGEST {
        return Ok(());
    }
    // If there is a resonance, report that instead, because it explains more.
    corrections_of(&Inertia::new(polhode, sigma, momentum), orbits)?;
    Err(Error::TorqueTooStrong { measure: TorqueMeasure::Strength, size, bound: STRONGEST })
}
