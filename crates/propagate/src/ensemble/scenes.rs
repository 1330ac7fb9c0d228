//! Ensembles of scenes of any kind.

use crate::error::Error;
use crate::input::scene::Scene;
use crate::input::state::State;
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
    /// let scenes = vec![Ok(scene.clone()), Ok(scene.orbit(Orbit::new(0.1, 0.2)?)), Ok(braked)];
    /// let ensemble = Ensemble::from_scenes(scenes, OnError::Raise)?;
    /// let mut attitudes = [[0.0; 4]; 6];
    /// ensemble.attitudes_into(&[0.0, 10.0], &mut attitudes)?;
    /// assert!(attitudes[1] != attitudes[3] && attitudes[3] != attitudes[5]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Member`] with the error in the place of a scene, or with what [`Scene::validate`] says of it, unless such members are to be NaN.
    pub fn from_scenes(scenes: Vec<Result<Scene, Error>>, on_error: OnError) -> Result<Self, Error> {
        let state = |scene: &Result<Scene, Error>| scene.as_ref().ok().map(|scene| *scene.state());
        let attitude = |state: State| state.attitude.coords.into();
        let attitudes = scenes.iter().map(|scene| state(scene).map_or([f64::NAN; 4], attitude)).collect();
        let rates = |state: State| state.angular_velocity.into();
        let rates = scenes.iter().map(|scene| state(scene).map_or([f64::NAN; 3], rates)).collect();
        let valid = || scenes.iter().flatten();
        let columns = if valid().any(|scene| scene.body().has_tensor()) {
            let none = [[f64::NAN; 3]; 3];
            let tensors = scenes.iter().map(|scene| scene.as_ref().map_or(none, |scene| scene.body().inertia()));
            Self::from_inertia_or(tensors.collect(), attitudes, rates, OnError::Nan, &GOING)?
        } else {
            let none = [f64::NAN; 3];
            let moments = scenes.iter().map(|scene| scene.as_ref().map_or(none, |scene| scene.body().moments()));
            Self::new_or(moments.collect(), attitudes, rates, OnError::Nan, &GOING)?
        };
        // A member without a scene has the epoch and the orbits of the first that has one: what all have in common is kept once.
        let first = valid().next();
        let epoch = |scene| state(scene).or(first.map(|scene| *scene.state())).map_or(0.0, |state| state.epoch);
        let epochs: Vec<f64> = scenes.iter().map(epoch).collect();
        let columns = if scenes.is_empty() { columns } else { columns.epochs(epochs)? };
        #[cfg(feature = "torques")]
        let of_scene = |scene: &Scene| scene.asked_disturbing().to_vec();
        #[cfg(feature = "torques")]
        let orbits = scenes.iter().map(|scene| scene.as_ref().ok().or(first).map_or(Vec::new(), of_scene));
        #[cfg(feature = "torques")]
        let columns = if scenes.is_empty() { columns } else { columns.orbits(orbits.collect())? };
        let mut ensemble = columns.in_common(&valid().collect::<Vec<_>>());
        (ensemble.scenes, ensemble.on_error) = (scenes, on_error);
        ensemble.raise_bad_members(&GOING)?;
        Ok(ensemble)
    }

    /// With the options that all scenes have.
    fn in_common(mut self, scenes: &[&Scene]) -> Self {
        let Some((first, others)) = scenes.split_first() else { return self };
        if others.iter().all(|scene| scene.asked_tolerance() == first.asked_tolerance()) {
            self = self.tolerance(first.asked_tolerance());
        }
        if others.iter().all(|scene| scene.asked_method() == first.asked_method()) {
            self = self.method(first.asked_method());
        }
        #[cfg(feature = "torques")]
        {
            if others.iter().all(|scene| scene.asked_level() == first.asked_level()) {
                self = self.level(first.asked_level());
            }
            if others.iter().all(|scene| scene.asked_torques() == first.asked_torques()) {
                self = self.torques(first.asked_torques().to_vec());
            }
        }
        match first.asked_span() {
            Some((start, stop)) if others.iter().all(|scene| scene.asked_span() == first.asked_span()) => {
                self.span(start, stop)
            }
            _ => self,
        }
    }

    /// Whether all members have the same of an option; members of columns have.
    pub fn has_in_common<T: PartialEq>(&self, of: impl Fn(&Scene) -> T) -> bool {
        let mut values = self.scenes.iter().flatten().map(of);
        let first = values.next();
        values.all(|value| Some(value) == first)
    }

    /// The scenes of [`Ensemble::from_scenes`]; none for an ensemble from columns.
    pub fn asked_scenes(&self) -> &[Result<Scene, Error>] {
        &self.scenes
    }

    /// The scene of a member.
    ///
    /// # Errors
    /// What [`Body::new`](crate::Body::new), [`State::new`](crate::State::new) and [`Scene::validate`] say of it.
    pub fn scene(&self, index: usize) -> Result<Scene, Error> {
        match self.scenes.get(index) {
            Some(scene) => scene.as_ref().map_err(Error::clone)?.validated(),
            None => self.scene_of_columns(index),
        }
    }
}

/// Whether two members have the same scene, or were refused with the same sentence: a value in an error need not be a number.
fn same_member(one: &Result<Scene, Error>, other: &Result<Scene, Error>) -> bool {
    match (one, other) {
        (Ok(one), Ok(other)) => one == other,
        (Err(one), Err(other)) => (one.kind(), one.to_string()) == (other.kind(), other.to_string()),
        _ => false,
    }
}

/// Ensembles of scenes are equal if these are: columns of members that were refused are not numbers.
impl PartialEq for Ensemble {
    fn eq(&self, other: &Self) -> bool {
        let same_columns = || {
            self.moments() == other.moments()
                && self.asked_tensors() == other.asked_tensors()
                && self.attitudes() == other.attitudes()
                && self.angular_velocities() == other.angular_velocities()
        };
        self.on_error == other.on_error
            && self.options == other.options
            && self.scenes.len() == other.scenes.len()
            && self.scenes.iter().zip(&other.scenes).all(|(one, other)| same_member(one, other))
            && (!self.scenes.is_empty() || same_columns())
    }
}
