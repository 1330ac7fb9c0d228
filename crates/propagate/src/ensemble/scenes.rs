//! Ensembles of scenes of any kind.

use crate::error::Error;
use crate::input::scene::Scene;
use crate::simd::halt::GOING;

use super::members::Ensemble;
use super::on_error::OnError;

impl Ensemble {
    /// An ensemble of scenes, of one kind or several: each has its own orbits, torques, tolerance, span and method.
    ///
    /// [`Ensemble::asked_tolerance`] and the like say what the scenes have in common, and the default where they differ: [`Ensemble::asked_scenes`] has it.
    ///
    /// ```
    /// use andoyer_propagate::ensemble::OnError;
    /// use andoyer_propagate::torques::Torque;
    /// use andoyer_propagate::{Body, Ensemble, Orbit, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// let scene = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).span(0.0, 10.0).tolerance(1e-9);
    /// let braked = scene.clone().torques([Torque::constant([0.0, 0.0, -1e-3])?]);
    /// let ensemble = Ensemble::from_scenes(vec![scene.clone(), scene.orbit(Orbit::new(0.1, 0.2)?), braked], OnError::Raise)?;
    /// let mut attitudes = [[0.0; 4]; 6];
    /// ensemble.attitudes_into(&[0.0, 10.0], &mut attitudes)?;
    /// assert!(attitudes[1] != attitudes[3] && attitudes[3] != attitudes[5]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Member`] with what [`Scene::validate`] says of a scene, unless such members are to be NaN.
    pub fn from_scenes(scenes: Vec<Scene>, on_error: OnError) -> Result<Self, Error> {
        let attitudes = scenes.iter().map(|scene| scene.state().attitude.coords.into()).collect();
        let rates = scenes.iter().map(|scene| scene.state().angular_velocity.into()).collect();
        let mut columns = if scenes.iter().any(|scene| scene.body().has_tensor()) {
            let tensors = scenes.iter().map(|scene| scene.body().inertia()).collect();
            Self::from_inertia_or(tensors, attitudes, rates, OnError::Nan, &GOING)?
        } else {
            let moments = scenes.iter().map(|scene| scene.body().moments()).collect();
            Self::new_or(moments, attitudes, rates, OnError::Nan, &GOING)?
        };
        if !scenes.is_empty() {
            columns = columns.epochs(scenes.iter().map(|scene| scene.state().epoch).collect())?;
            columns = columns.orbits(scenes.iter().map(|scene| scene.asked_disturbing().to_vec()).collect())?;
        }
        let mut ensemble = columns.in_common(&scenes);
        (ensemble.scenes, ensemble.on_error) = (scenes, on_error);
        ensemble.raise_bad_members(&GOING)?;
        Ok(ensemble)
    }

    /// With the options that all scenes have.
    fn in_common(mut self, scenes: &[Scene]) -> Self {
        let Some((first, others)) = scenes.split_first() else { return self };
        if others.iter().all(|scene| scene.asked_tolerance() == first.asked_tolerance()) {
            self = self.tolerance(first.asked_tolerance());
        }
        if others.iter().all(|scene| scene.asked_method() == first.asked_method()) {
            self = self.method(first.asked_method());
        }
        if others.iter().all(|scene| scene.asked_level() == first.asked_level()) {
            self = self.level(first.asked_level());
        }
        if others.iter().all(|scene| scene.asked_torques() == first.asked_torques()) {
            self = self.torques(first.asked_torques().to_vec());
        }
        match first.asked_span() {
            Some((start, stop)) if others.iter().all(|scene| scene.asked_span() == first.asked_span()) => {
                self.span(start, stop)
            }
            _ => self,
        }
    }

    /// The scenes of [`Ensemble::from_scenes`]; none for an ensemble from columns.
    pub fn asked_scenes(&self) -> &[Scene] {
        &self.scenes
    }

    /// The scene of a member.
    ///
    /// # Errors
    /// What [`Body::new`](crate::Body::new), [`State::new`](crate::State::new) and [`Scene::validate`] say of it.
    pub fn scene(&self, index: usize) -> Result<Scene, Error> {
        match self.scenes.get(index) {
            Some(scene) => scene.validated(),
            None => self.scene_of_columns(index),
        }
    }
}
