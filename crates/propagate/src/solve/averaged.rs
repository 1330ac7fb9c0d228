//! The motion under a gravity gradient by the averaged theory (theory §9).

use std::f64::consts::TAU;
use std::sync::Arc;

use super::free::{self, Preparation, representable, unused_order};
use crate::error::{Error, TorqueMeasure};
use crate::gravity_gradient::constants::LARGEST_SEPARATRIX_RATIO;
use crate::gravity_gradient::disturbed::chosen;
use crate::gravity_gradient::request::Request;
use crate::gravity_gradient::request::osculating;
use crate::input::options::{Level, Method};
use crate::input::scene::Scene;
use crate::integration::prospect::verification_cost;
use crate::motion::plan::{Plan, in_ascii};
use crate::motion::solved::{Frequencies, Motion};
use crate::motion::trajectory::Trajectory;
use crate::numerics::scaling::scaled;
use crate::orbit::elements::Orbit;
use crate::torque_free::error_budget::{DEFAULT_ROTATIONS, ROUNDING, sides};
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

/// An error bound below this is not compared with the effect of the torque \[rad\].
const LEAST_CHECKED_BOUND: f64 = 1e-3;
/// Intervals of the span at whose ends the effect of the torque is sampled.
const EFFECT_SAMPLES: u32 = 16;

/// The motion under the gravity gradients of bodies on these orbits; the polhode of a body at rest is `None`.
///
/// # Errors
/// [`Error::Unaveraged`], [`Error::Units`], those of [`chosen`], and [`Error::TorqueTooStrong`] for an error bound above the effect of the torque.
pub(crate) fn motion(scene: Scene, polhode: Option<&Polhode>, orbits: &[Orbit]) -> Result<Motion, Error> {
    let Some(polhode) = polhode else {
        return Err(Error::Unaveraged { mode: Mode::AtRest.to_string(), ratio: 0.0, bound: LARGEST_SEPARATRIX_RATIO });
    };
    representable(polhode)?;
    let (ratio, osculating) = osculating(polhode)?;
    let exponent = polhode.scales.1;
    let rotation = polhode.invariants.mean_rate;
    let request = Request {
        orbits,
        averaging: scene.asked_averaging(),
        level: scene.asked_level(),
        tolerance: scene.asked_tolerance(),
        epoch: scene.state().epoch,
        sides: sides(&scene, rotation, exponent).map(|time| scaled(time, -exponent)),
        spanned: scene.asked_span().is_some(),
    };
    let (gradient, unused) = chosen(polhode, scene.state().attitude, osculating, &request)?;
    let [anomaly, longitude] = gradient.frequencies();
    let mut skipped: Vec<String> = unused_order(&scene).into_iter().collect();
    if scene.asked_method() == Method::Series {
        skipped.push("series: a scene with an orbit is solved about the closed form".to_owned());
    }
    skipped.extend(unused.as_deref().map(in_ascii));
    skipped.extend(gradient.skipped());
    let mut plan = Plan::new(&scene, Mode::of(polhode), ratio, gradient.error + 4.0 * ROUNDING);
    plan.verification = verification_cost(&scene);
    (plan.gradient, plan.skipped) = (Some(gradient.plan()), skipped);
    let reach = gradient.bound() * longitude / TAU;
    plan.reach = Some(reach).filter(|reach| *reach < DEFAULT_ROTATIONS);
    let error = gradient.error;
    let motion = Motion {
        plan,
        frequencies: Frequencies { anomaly, longitude },
        given: None,
        precession: longitude + anomaly,
        angular_momentum: polhode.angular_momentum(scene.state().attitude),
        long_axis: polhode.long_axis,
        trajectory: Trajectory::Forced(Arc::new(gradient)),
        scene,
    };
    let fastest = orbits.iter().map(Orbit::mean_motion).fold(0.0, f64::max);
    let turns = request.duration() * fastest / TAU;
    if !matches!(request.level, Level::Paper | Level::Moving)
        && turns < 1.0
        && error > LEAST_CHECKED_BOUND.max(request.tolerance)
    {
        let effect = effect(&motion)?;
        if error > effect {
            return Err(Error::TorqueTooStrong { measure: TorqueMeasure::ErrorBound, size: error, bound: effect });
        }
    }
    Ok(motion)
}

/// Largest turn between a motion under a torque and the free one over the span.
fn effect(motion: &Motion) -> Result<f64, Error> {
    let scene = &motion.scene;
    let (start, stop) = scene.asked_span().unwrap_or((scene.state().epoch, scene.state().epoch));
    let unforced = Scene::new(scene.body().clone(), *scene.state()).span(start, stop);
    let polhode = Polhode::new(unforced.body(), unforced.state());
    let free = free::motion(unforced, polhode.as_ref(), Preparation::default())?;
    (0..=EFFECT_SAMPLES).try_fold(0.0_f64, |largest, k| {
        let time = start + (stop - start) * f64::from(k) / f64::from(EFFECT_SAMPLES);
        Ok(largest.max(free.at(time)?.attitude.angle_to(&motion.at(time)?.attitude)))
    })
}
