//! The relaxation of a scene, the age of its state, and the material from an age.

use super::body::{Dissipation, Tumbling};
use super::harmonics::Swing;
use super::material::{Loss, positive, refused};
use super::relaxation::Relaxation;
use crate::error::Error;
use crate::input::scene::Scene;
use crate::torque_free::mode::Mode;

impl Dissipation {
    /// The relaxation of the free body of a scene (equation 17).
    ///
    /// # Errors
    /// - Those of [`Dissipation::power`].
    /// - [`Error::NoDissipation`] for a scene with other bodies or torques, a body at rest, and rotation about a principal axis.
    pub fn relax(&self, scene: &Scene) -> Result<Relaxation, Error> {
        if !(scene.asked_disturbing().is_empty() && scene.asked_torques().is_empty()) {
            let reason =
                "a relaxation keeps the angular momentum; give the scene without orbits and torques".to_owned();
            return Err(Error::NoDissipation { argument: "scene", value: "a scene with torques".to_owned(), reason });
        }
        let Tumbling { mean_rate, swing, separatrix } = self.tumbling(scene)?;
        match swing {
            Some(Swing { long_axis, x, complement }) => {
                Relaxation::new(self.clone(), mean_rate, (long_axis, x.ln() - complement.ln()))
            }
            None if separatrix => Relaxation::new(self.clone(), mean_rate, (false, f64::INFINITY)),
            None => {
                let reason = "only a body that tumbles relaxes, and this one rotates about a principal axis or rests";
                let value = "a steady rotation".to_owned();
                Err(Error::NoDissipation { argument: "scene", value, reason: reason.to_owned() })
            }
        }
    }

    /// The age of the state of a scene: the time since the largest angle between the angular momentum and the axis of a mode was `start_angle`; without a mode it
    /// is that of the state.
    ///
    /// # Errors
    /// Those of [`Dissipation::relax`] and [`Relaxation::time_to`]; [`Error::Dissipation`] for a start that is not before the state.
    pub fn age(&self, scene: &Scene, start_angle: f64, mode: Option<Mode>) -> Result<f64, Error> {
        let relaxation = self.relax(scene)?;
        let now = relaxation.at(0.0)?;
        let age = -relaxation.time_to(start_angle, mode.unwrap_or(now.mode))?;
        if age > 0.0 {
            return Ok(age);
        }
        let bound = format!("that of a state before the present one, {} rad in the {} mode", now.angle, now.mode);
        Err(refused("start_angle", start_angle, &bound))
    }

    /// The quality factor with which the state of a scene has this age: [`Dissipation::age`] is proportional to it. The loss of the material is not used.
    ///
    /// # Errors
    /// Those of [`Dissipation::age`]; [`Error::Positive`] for an age that is not positive and finite.
    pub fn quality_from_age(
        &self,
        scene: &Scene,
        age: f64,
        start_angle: f64,
        mode: Option<Mode>,
    ) -> Result<f64, Error> {
        self.trial_ratio(Loss::Quality(1.0), scene, age, start_angle, mode)
    }

    /// The viscosity of a Maxwell body with which the state of a scene has this age, as [`Dissipation::quality_from_age`].
    ///
    /// # Errors
    /// Those of [`Dissipation::quality_from_age`].
    pub fn viscosity_from_age(
        &self,
        scene: &Scene,
        age: f64,
        start_angle: f64,
        mode: Option<Mode>,
    ) -> Result<f64, Error> {
        self.trial_ratio(Loss::Viscosity(self.material.rigidity()), scene, age, start_angle, mode)
            .map(|ratio| ratio * self.material.rigidity())
    }

    /// The age over that with a trial loss.
    fn trial_ratio(&self, trial: Loss, scene: &Scene, age: f64, start: f64, mode: Option<Mode>) -> Result<f64, Error> {
        positive("age", age)?;
        let mut dissipation = self.clone();
        dissipation.material = self.material.clone().loss(trial)?;
        Ok(age / dissipation.age(scene, start, mode)?)
    }
}
