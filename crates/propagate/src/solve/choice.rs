//! The choice between theory and integration.

use std::sync::atomic::AtomicBool;

use crate::error::{Error, Kind};
use crate::input::disturbing_body::DisturbingBody;
use crate::input::options::{Averaging, Level, Method};
use crate::input::orbit::Orbit;
use crate::input::scene::Scene;
use crate::integration::integrated::{Integrated, prospect};
use crate::integration::integrator::MOST_STEPS;
use crate::motion::plan::{Plan, ROUNDED_TOLERANCE, bound_in_words};
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::torque_free::series::tables::SeriesTables;

impl Scene {
    /// Whether the scene is integrated without an attempt by theory: on request, or under a body with a table of positions.
    #[must_use]
    pub fn needs_integration(&self) -> bool {
        match self.asked_method() {
            Method::Integrated => true,
            Method::Auto => beyond_theory(self).is_some(),
            Method::Series | Method::Closed => false,
        }
    }
}

/// Whether all moments are equal: no body exerts a torque on a sphere.
pub(super) fn is_sphere(scene: &Scene) -> bool {
    let [a, b, c] = scene.body().moments();
    a == b && b == c
}

/// Why no theory covers the scene, or `None`.
pub(super) fn beyond_theory(scene: &Scene) -> Option<String> {
    match scene.asked_disturbing() {
        _ if is_sphere(scene) => None,
        bodies if bodies.iter().any(|body| matches!(body, DisturbingBody::Tabulated(_))) => {
            Some("a table of positions is integrated".to_owned())
        }
        _ => None,
    }
}

/// What a scene would need the integration for if theory does not serve it, but gives no span: several bodies, or an orbit that precesses.
pub(super) fn without_span(scene: &Scene) -> Option<String> {
    if scene.asked_method() != Method::Auto || scene.asked_span().is_some() {
        return None;
    }
    match scene.asked_disturbing() {
        [] => None,
        [DisturbingBody::Orbit(orbit)] if orbit.is_fixed() => None,
        [_] => Some("an orbit that precesses".to_owned()),
        bodies => Some(format!("{} disturbing bodies", bodies.len())),
    }
}

/// Whether a scene with disturbing bodies leaves the choice between theory and integration.
pub(super) fn may_be_integrated(scene: &Scene) -> bool {
    scene.asked_method() == Method::Auto
        && scene.asked_span().is_some()
        && !scene.asked_disturbing().is_empty()
        && scene.asked_order().is_none()
        && scene.asked_averaging() == Averaging::default()
        && scene.asked_level() == Level::default()
}

/// The theory where it meets the tolerance, else the integration where that does, else the theory: it costs less, and the plan says how near the integration
/// would come. For several bodies and for orbits that precess the smaller error bound decides instead.
pub(super) fn cheapest(scene: Scene, tables: &SeriesTables, stop: &AtomicBool) -> Result<Motion, Error> {
    let mut by_theory = match scene.clone().solve_by_theory(tables) {
        Ok(motion) if motion.plan.meets_tolerance() => return Ok(motion),
        Ok(motion) => motion,
        Err(error) if error.kind() == Kind::Theory => {
            return integrated(scene, tables, format!("theory: {}", in_ascii(&error.to_string())), stop);
        }
        Err(error) => return Err(error),
    };
    // For several bodies and for orbits that precess the integration also counts where it only comes nearer to the tolerance.
    let fixed = scene.asked_orbit().is_some_and(Orbit::is_fixed);
    let tolerance = scene.asked_tolerance().max(ROUNDED_TOLERANCE);
    let enough = if fixed { tolerance } else { tolerance.max(by_theory.plan.error_bound) };
    let unused = match prospect(&scene) {
        Some((_, steps)) if steps > MOST_STEPS as f64 => {
            format!("it would take about {steps:.1e} steps, and at most {MOST_STEPS} are kept")
        }
        Some((bound, _)) if bound > enough => {
            format!("its error bound would be about {} (method \"integrated\" has it)", bound_in_words(bound))
        }
        _ => {
            let reason = format!("theory: its error bound is {}", bound_in_words(by_theory.plan.error_bound));
            match integrated(scene, tables, reason, stop) {
                Ok(motion) if motion.plan.error_bound < by_theory.plan.error_bound => return Ok(motion),
                Ok(motion) => format!("its error bound is {}", bound_in_words(motion.plan.error_bound)),
                Err(Error::Stopped) => return Err(Error::Stopped),
                Err(error) => in_ascii(&error.to_string()),
            }
        }
    };
    by_theory.plan.skipped.push(format!("integration: {unused}"));
    Ok(by_theory)
}

/// A message without the signs that a plan does not print.
pub(super) fn in_ascii(message: &str) -> String {
    message.replace('σ', "sigma").replace('−', "-").replace('²', "^2")
}

/// The motion by integration over the span; mode and frequencies are those of the free motion at the epoch.
pub(super) fn integrated(
    scene: Scene,
    tables: &SeriesTables,
    reason: String,
    stop: &AtomicBool,
) -> Result<Motion, Error> {
    let free = Scene::new(scene.body().clone(), *scene.state()).solve_by_theory(tables)?;
    let motion = Integrated::new(&scene, &reason, stop).map_err(|error| match error {
        Error::TooManySteps { steps, bound, .. } => Error::TooManySteps { steps, bound, reason: reason.clone() },
        error => error,
    })?;
    let mut plan = Plan::new(&scene, free.plan.mode, free.plan.separatrix_ratio, motion.error);
    plan.method = Method::Integrated;
    plan.order = motion.order();
    plan.integration = Some(motion.plan());
    plan.skipped.extend(Some(reason).filter(|reason| !reason.is_empty()));
    if let Some(order) = scene.asked_order() {
        plan.skipped.push(format!("order {order}, which was asked for: it is one of the series"));
    }
    Ok(Motion { scene, plan, trajectory: Trajectory::Integrated(Box::new(motion)), ..free })
}
