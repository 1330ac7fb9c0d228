//! The motion by numerical integration.

use std::sync::Arc;

use super::free::{self, Preparation};
use crate::error::Error;
use crate::input::options::Method;
use crate::input::scene::Scene;
use crate::input::torque::rotors;
use crate::integration::integrated::Integrated;
use crate::integration::prospect::verification_cost;
use crate::motion::plan::Plan;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::torque_free::polhode::Polhode;

/// The motion by integration over the span; mode and frequencies are those of the free motion at the epoch.
///
/// # Errors
/// Those of the integration.
pub(super) fn motion(scene: Scene, reason: String, found: Result<Integrated, Error>) -> Result<Motion, Error> {
    let unforced = Scene::new(scene.body().clone(), *scene.state());
    let polhode = Polhode::new(unforced.body(), unforced.state());
    let free = free::motion(unforced, polhode.as_ref(), Preparation::default())?;
    let motion = found.map_err(|error| match error {
        Error::TooManySteps { steps, bound, .. } => Error::TooManySteps { steps, bound, reason: reason.clone() },
        error => error,
    })?;
    let mut plan = Plan::new(&scene, free.plan.mode, free.plan.separatrix_ratio, motion.error);
    plan.verification = verification_cost(&scene);
    plan.method = Method::Integrated;
    plan.order = motion.order();
    plan.fastest = plan.fastest.max(motion.fastest());
    plan.integration = Some(motion.plan(scene.state().epoch));
    plan.skipped.extend(Some(reason).filter(|reason| !reason.is_empty()));
    if let Some(order) = scene.asked_order() {
        plan.skipped.push(format!("order {order}, which was asked for: it is one of the series"));
    }
    let angular_momentum = free.angular_momentum + scene.state().attitude * rotors(scene.asked_torques());
    Ok(Motion { scene, plan, angular_momentum, trajectory: Trajectory::Forced(Arc::new(motion)), ..free })
}
