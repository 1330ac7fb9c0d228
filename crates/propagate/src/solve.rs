//! From a scene to its motion (theory §5 to §10, theory-locked): `choose` asks which method serves and integrates; `free`, `averaged`, `libration` and `integrated` make the motion, `several`
//! those of free bodies together.

use std::sync::atomic::AtomicBool;

use crate::error::Error;
use crate::input::options::Served;
use crate::input::scene::Scene;
use crate::motion::solved::{Given, Motion};
use crate::simd::halt::GOING;

#[cfg(feature = "torques")]
mod averaged;
#[cfg(feature = "torques")]
mod choose;
#[cfg(not(feature = "torques"))]
#[path = "solve/choose_free.rs"]
mod choose;
mod free;
#[cfg(feature = "torques")]
mod integrated;
#[cfg(feature = "torques")]
mod libration;
mod several;

#[cfg(all(test, feature = "torques"))]
pub(crate) use averaged::motion as averaged;
#[cfg(test)]
pub(crate) use free::solved;
pub(crate) use free::untruncated;
pub(crate) use several::several;

impl Scene {
    /// The motion: everything that does not depend on time is done here, once.
    ///
    /// # Errors
    /// - Those of [`Scene::validate`].
    /// - [`Error::Units`] where the angular momentum over- or underflows, or a rate that belongs to it does.
    /// - [`Error::NearSeparatrix`] where the series is asked for and the tolerance needs an order above [`MAX_ORDER`](crate::options::MAX_ORDER).
    /// - [`Error::Separatrix`] where the series is asked for on the separatrix itself.
    /// - [`Error::Resonance`], [`Error::TorqueTooStrong`], [`Error::Unaveraged`] for an orbit whose gravity gradient cannot be averaged, without a span or with
    ///   a method other than [`Method::Auto`](crate::Method::Auto) and [`Method::Integrated`](crate::Method::Integrated).
    /// - [`Error::NoSpan`] where the motion is integrated and no span is given; [`Error::OnlyIntegrated`] for a table of positions, a hyperbola or a torque
    ///   beside the gravity gradient with another method.
    /// - [`Error::TooManySteps`], [`Error::Unpredictable`] where the integration takes too many steps, or the attitude is unknown at its end; [`Error::TableSpan`].
    pub fn solve(&self) -> Result<Motion, Error> {
        self.solve_until(&GOING)
    }

    /// As [`Scene::solve`], and ends early, with [`Error::Stopped`], once another thread has set the flag: an integration may take seconds. A flag that is
    /// set from the start ends an integration before its first step; a motion that needs none is returned.
    ///
    /// # Errors
    /// As [`Scene::solve`], and [`Error::Stopped`].
    pub fn solve_until(&self, stop: &AtomicBool) -> Result<Motion, Error> {
        self.served(Served::WholeSpan, stop)
    }

    /// As [`Scene::solve_until`], for a use of the motion.
    pub(crate) fn served(&self, served: Served, stop: &AtomicBool) -> Result<Motion, Error> {
        let scene = self.validated()?;
        let Some(turn) = scene.body().turn() else { return choose::motion(scene, (served, stop)) };
        let mut motion = choose::motion(scene.about_principal_axes(turn), (served, stop))?;
        motion.given = Some(Box::new(Given { scene, turn }));
        Ok(motion)
    }
}
