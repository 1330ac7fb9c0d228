//! The choice between theory and integration.

use std::sync::atomic::AtomicBool;

use super::free::{self, Preparation};
use super::{averaged, integrated, libration};
use crate::error::{Error, Kind, torque_refused};
use crate::input::gravity::Gravity;
use crate::input::options::{Averaging, Level, Method, Served};
use crate::input::scene::Scene;
use crate::input::torque::Torque;
use crate::integration::integrated::Integrated;
use crate::integration::integrator::MOST_STEPS;
use crate::integration::prospect::{is_brief, prospect};
use crate::motion::plan::{ROUNDED_TOLERANCE, bound_in_words, in_ascii};
use crate::motion::solved::Motion;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::torque_free::polhode::Polhode;

/// The steps of an integration that cost as many operations as a normal form about a resonance: a step of order 20 takes some 1e4, a form of order 6 to 10 some
/// 1e9.
const STEPS_OF_A_FORM: f64 = 1e5;

impl Scene {
    /// Whether the scene is integrated without an attempt by theory: on request, under a body with a table of positions, or under one on a hyperbola.
    #[must_use]
    pub fn needs_integration(&self) -> bool {
        match self.asked_method() {
            Method::Integrated => true,
            Method::Libration => false,
            Method::Auto => beyond_theory(self).is_some(),
            Method::Series | Method::Closed => false,
        }
    }

    /// Whether the scene needs an integration ([`Scene::needs_integration`]) of a few milliseconds, which nobody waits for or stops.
    #[must_use]
    pub fn is_brief(&self) -> bool {
        self.needs_integration() && is_brief(self)
    }
}

/// A scene is solved by a theory, or it is to be integrated.
enum Choice {
    Solved(Box<Motion>),
    Integrate(Box<Integration>),
}

impl From<Motion> for Choice {
    fn from(motion: Motion) -> Self {
        Self::Solved(Box::new(motion))
    }
}

/// A scene that is integrated.
struct Integration {
    scene: Scene,
    /// Why it is.
    reason: String,
    /// The motion by theory, which does not meet the tolerance.
    by_theory: Option<Motion>,
    /// Why it is no libration.
    locked: Option<String>,
}

/// The motion of a scene about principal axes, by the method that it asks for or that serves it.
///
/// # Errors
/// As [`Scene::solve_until`].
pub(super) fn motion(scene: Scene, (served, stop): (Served, &AtomicBool)) -> Result<Motion, Error> {
    let by_theory_alone = !matches!(scene.asked_method(), Method::Integrated | Method::Libration);
    if by_theory_alone && scene.asked_disturbing().is_empty() && scene.asked_torques().is_empty() {
        return by_theory(scene);
    }
    match choice(scene, stop)? {
        Choice::Solved(motion) => Ok(*motion),
        Choice::Integrate(chosen) => {
            let found = Integrated::new(&chosen.scene, &chosen.reason, (served, stop));
            chosen.finished(found)
        }
    }
}

/// The motion by a theory, or the integration that the scene needs.
fn choice(scene: Scene, stop: &AtomicBool) -> Result<Choice, Error> {
    if scene.asked_torques().iter().any(|torque| matches!(torque, Torque::Dissipation(_))) {
        let bound = "absent: inner friction is averaged, by `evolve` and `drift`; a rigid body that is integrated has no such torque";
        return Err(torque_refused("torques", "dissipation", bound));
    }
    let integration = |scene: Scene, reason: String| {
        Ok(Choice::Integrate(Box::new(Integration { scene, reason, by_theory: None, locked: None })))
    };
    match (scene.asked_method(), beyond_theory(&scene)) {
        (Method::Libration, Some(reason)) if !scene.acting_torques().is_empty() => Err(Error::NoLibration { reason }),
        (Method::Libration, _) => libration::motion(scene, stop).map(Choice::from),
        (Method::Integrated, _) => integration(scene, String::new()),
        (Method::Auto, Some(reason)) => integration(scene, format!("theory: {reason}")),
        (method, Some(reason)) => Err(Error::OnlyIntegrated { method: method.to_string(), reason }),
        (_, None) if may_be_integrated(&scene) => cheapest(scene, stop),
        (method, None) => without_integration(scene, method, stop).map(Choice::from),
    }
}

/// The theory, or a libration that serves a scene better.
fn without_integration(scene: Scene, method: Method, stop: &AtomicBool) -> Result<Motion, Error> {
    let solved = by_theory(scene.clone());
    let failed = solved.as_ref().map_or(true, |motion| !motion.plan.meets_tolerance());
    if method == Method::Auto
        && failed
        && let Ok(motion) = libration::serving(&scene, stop)?
    {
        return Ok(motion);
    }
    let bodies = without_span(&scene);
    solved.map_err(|error| match bodies {
        Some(bodies) if error.kind() == Kind::Theory => {
            Error::NoSpan { reason: format!("theory for {bodies}: {}", in_ascii(&error.to_string())) }
        }
        _ => error,
    })
}

impl Integration {
    /// The motion by the integration, or by theory where that has the smaller bound.
    fn finished(self, found: Result<Integrated, Error>) -> Result<Motion, Error> {
        let Self { scene, reason, by_theory, locked } = self;
        let integrated = integrated::motion(scene, reason, found);
        let mut motion = match (by_theory, integrated) {
            (None, integrated) => integrated?,
            (Some(by_theory), Ok(motion)) if motion.plan.error_bound < by_theory.plan.error_bound => motion,
            (_, Err(Error::Stopped)) => return Err(Error::Stopped),
            (Some(by_theory), integrated) => without(
                by_theory,
                match integrated {
                    Ok(motion) => format!("its error bound is {}", bound_in_words(motion.plan.error_bound)),
                    Err(error) => in_ascii(&error.to_string()),
                },
            ),
        };
        motion.plan.skipped.extend(locked);
        Ok(motion)
    }
}

/// A motion by theory, with the reason why it is not integrated.
fn without(mut by_theory: Motion, unused: String) -> Motion {
    by_theory.plan.skipped.push(format!("integration: {unused}"));
    by_theory
}

/// The motion by theory: averaged if a torque acts, else free.
fn by_theory(scene: Scene) -> Result<Motion, Error> {
    let polhode = Polhode::of(&scene);
    match scene.asked_orbits().filter(|_| !scene.body().is_sphere()) {
        Some(orbits) => averaged::motion(scene, polhode.as_ref(), &orbits),
        None => free::motion(scene, polhode.as_ref(), Preparation::default()),
    }
}

/// Why no theory covers the scene, or `None`.
fn beyond_theory(scene: &Scene) -> Option<String> {
    match scene.asked_disturbing() {
        _ if !scene.asked_torques().is_empty() => Some("a torque beside the gravity gradient is integrated".to_owned()),
        [_, ..] if scene.body().gravity().is_some_and(Gravity::acts) => {
            Some("a gravity field of degree 3 or 4 is integrated".to_owned())
        }
        _ if scene.body().is_sphere() => None,
        bodies if bodies.iter().any(|body| matches!(body, DisturbingBody::Tabulated(_))) => {
            Some("a table of positions is integrated".to_owned())
        }
        bodies if bodies.iter().any(|body| matches!(body, DisturbingBody::Orbit(orbit) if orbit.is_hyperbola())) => {
            Some("a hyperbola is integrated".to_owned())
        }
        _ => None,
    }
}

/// The reason why a scene without a span would need an integration if theory does not serve it: several bodies, or an orbit that precesses.
fn without_span(scene: &Scene) -> Option<String> {
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
fn may_be_integrated(scene: &Scene) -> bool {
    scene.asked_method() == Method::Auto
        && scene.asked_span().is_some()
        && !scene.asked_disturbing().is_empty()
        && scene.asked_order().is_none()
        && scene.asked_averaging() == Averaging::default()
        && scene.asked_level() == Level::default()
}

/// The theory where it meets the tolerance, else the integration where that does, else the theory: it costs less, and the plan says how near the integration
/// would come. For several bodies and for orbits that precess the smaller error bound decides instead.
fn cheapest(scene: Scene, stop: &AtomicBool) -> Result<Choice, Error> {
    let by_theory = match by_theory(scene.clone()) {
        Ok(motion) if motion.plan.meets_tolerance() => return Ok(motion.into()),
        Err(error) if error.kind() != Kind::Theory => return Err(error),
        by_theory => by_theory,
    };
    let prospect = prospect(&scene);
    let mut locked = None;
    if prospect.is_none_or(|(_, steps)| steps > STEPS_OF_A_FORM) {
        match libration::serving(&scene, stop)? {
            Ok(motion) => return Ok(motion.into()),
            Err(reason) => locked = reason.map(|reason| format!("libration: {reason}")),
        }
    }
    let (by_theory, reason) = match by_theory {
        Ok(motion) => match not_integrated(&scene, &motion, prospect) {
            Some(unused) => {
                let mut motion = without(motion, unused);
                motion.plan.skipped.extend(locked);
                return Ok(motion.into());
            }
            None => {
                let reason = format!("theory: its error bound is {}", bound_in_words(motion.plan.error_bound));
                (Some(motion), reason)
            }
        },
        Err(error) => (None, format!("theory: {}", in_ascii(&error.to_string()))),
    };
    Ok(Choice::Integrate(Box::new(Integration { scene, reason, by_theory, locked })))
}

/// Why a scene is not integrated although the theory does not meet the tolerance, or `None`.
fn not_integrated(scene: &Scene, by_theory: &Motion, prospect: Option<(f64, f64)>) -> Option<String> {
    // For several bodies and for orbits that precess the integration also counts where it only comes nearer to the tolerance.
    let fixed = scene.asked_orbit().is_some_and(Orbit::is_fixed);
    let tolerance = scene.asked_tolerance().max(ROUNDED_TOLERANCE);
    let enough = if fixed { tolerance } else { tolerance.max(by_theory.plan.error_bound) };
    match prospect {
        Some((_, steps)) if steps > MOST_STEPS as f64 => {
            Some(format!("it would take about {steps:.1e} steps, and at most {MOST_STEPS} are kept"))
        }
        Some((bound, _)) if bound > enough => {
            Some(format!("its error bound would be about {} (method \"integrated\" has it)", bound_in_words(bound)))
        }
        _ => None,
    }
}
