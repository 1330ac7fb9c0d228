//! What the user asks of an ensemble beside its columns.

use crate::error::Error;
use crate::input::options::{Level, Method};
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::input::torque::Torque;
use crate::motion::solved::length;
use crate::orbit::disturbing_body::DisturbingBody;

use super::kept::KeptMotions;
use super::members::Ensemble;
use super::on_error::OnError;
use super::options::once;

/// Gravity gradients and other torques. They are absent without the feature `torques`.
#[cfg(feature = "torques")]
impl Ensemble {
    /// The bodies whose gravity gradients act on the members: those of all members, or those of each, as for [`Scene::disturbing`]. A member may have several, or none.
    ///
    /// What averaging leaves grows with time: without [`Ensemble::span`] the error bounds are those after 1e9 rotations. Which motions are served is known only
    /// when they are solved.
    ///
    /// ```
    /// use andoyer_propagate::{Ensemble, Orbit};
    /// let (moments, level) = (vec![[1.0, 1.02, 1.05]; 2], vec![[0.0, 0.0, 0.0, 1.0]; 2]);
    /// let ensemble = Ensemble::new(moments, level, vec![[0.0, 0.01, 1.0]; 2])?;
    /// let ensemble = ensemble.orbits(vec![Some(Orbit::new(2e-3, 0.1)?), None])?.span(0.0, 1e5);
    /// let torques: Vec<f64> = ensemble.plans()?.iter().map(|plan| plan.torque()).collect();
    /// assert!(torques[0] > 0.0 && torques[1] == 0.0);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Length`] for three elements and five members.
    pub fn orbits<Bodies>(mut self, orbits: Vec<Bodies>) -> Result<Self, Error>
    where
        Bodies: IntoIterator<Item: Into<DisturbingBody>>,
    {
        if orbits.len() != 1 {
            length("orbits", orbits.len(), self.len())?;
        }
        let listed = |bodies: Bodies| bodies.into_iter().map(Into::into).collect();
        self.options.orbits = once(orbits.into_iter().map(listed).collect(), Vec::is_empty);
        let options = self.options.clone();
        Ok(self.each_member_scene(|index, scene| scene.disturbing(options.orbits(index).iter().cloned())))
    }

    /// Torques beside the gravity gradient on all members, as for [`Scene::torques`]: members with any of them are integrated.
    ///
    /// ```
    /// use andoyer_propagate::torques::Torque;
    /// use andoyer_propagate::{Ensemble, Method};
    /// let (moments, level) = (vec![[1.0, 1.5, 2.0]; 2], vec![[0.0, 0.0, 0.0, 1.0]; 2]);
    /// let ensemble = Ensemble::new(moments, level, vec![[0.1, 0.2, 1.0]; 2])?.span(0.0, 10.0);
    /// let ensemble = ensemble.torques([Torque::constant([1e-3, 0.0, 0.0])?]);
    /// assert_eq!(ensemble.plans()?[1].method(), Method::Integrated);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    #[must_use]
    pub fn torques(mut self, torques: impl IntoIterator<Item = Torque>) -> Self {
        self.options.torques = torques.into_iter().collect();
        let torques = self.options.torques.clone();
        self.each_scene(|scene| scene.torques(torques.clone()))
    }

    /// How much of the theory of the gravity gradient is used, as for [`Scene::level`].
    #[must_use]
    pub fn level(mut self, level: Level) -> Self {
        self.options.level = level;
        self.each_scene(|scene| scene.level(level))
    }
}

impl Ensemble {
    /// The times of the states: one for all members, or one for each; 0 if this is not called.
    ///
    /// ```
    /// use andoyer_propagate::Ensemble;
    /// let (moments, level) = (vec![[1.0, 1.5, 2.0]; 2], vec![[0.0, 0.0, 0.0, 1.0]; 2]);
    /// let ensemble = Ensemble::new(moments, level, vec![[0.1, 0.2, 1.0]; 2])?.epochs(vec![0.0, 5.0])?;
    /// let mut attitudes = [[0.0; 4]; 2];
    /// ensemble.attitudes_into(&[5.0], &mut attitudes)?;
    /// assert!((attitudes[1][3] - 1.0).abs() < 1e-15 && attitudes[0][3] < 0.0);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Length`] for three epochs of five members.
    /// - [`Error::Epoch`] for `vec![f64::NAN]`, and [`Error::Member`] with it for one of many, unless bad members are to be NaN.
    pub fn epochs(mut self, epochs: Vec<f64>) -> Result<Self, Error> {
        if epochs.len() != 1 {
            length("epochs", epochs.len(), self.len())?;
        }
        let bad = epochs.iter().position(|epoch| !epoch.is_finite());
        match bad.map(|index| (index, Error::Epoch { value: epochs[index] })) {
            Some((_, problem)) if epochs.len() == 1 => return Err(problem),
            Some((index, problem)) if self.on_error == OnError::Raise => {
                return Err(Error::Member { index, others: 0, problem: Box::new(problem) });
            }
            _ => {}
        }
        self.options.epochs = once(epochs, |&epoch| epoch == 0.0);
        let options = self.options.clone();
        Ok(self.each_member_scene(|index, scene| {
            let state = State { epoch: options.epoch(index), ..*scene.state() };
            scene.with_state(state)
        }))
    }

    /// The attitude error asked for \[rad\], as for [`Scene::tolerance`](crate::Scene::tolerance).
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.options.tolerance = tolerance;
        self.each_scene(|scene| scene.tolerance(tolerance))
    }

    /// How the motions of all members are evaluated, as for [`Scene::method`](crate::Scene::method).
    ///
    /// ```
    /// use andoyer_propagate::{Ensemble, Method, Orbit};
    /// let (moments, level) = (vec![[1.0, 1.02, 1.05]; 2], vec![[0.0, 0.0, 0.0, 1.0]; 2]);
    /// let ensemble = Ensemble::new(moments, level, vec![[0.0, 0.01, 1.0]; 2])?.method(Method::Integrated);
    /// let ensemble = ensemble.orbits(vec![Some(Orbit::new(2e-3, 0.1)?)])?.span(0.0, 100.0);
    /// assert_eq!(ensemble.plans()?[1].method(), Method::Integrated);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.options.method = method;
        self.each_scene(|scene| scene.method(method))
    }

    /// The times over which the tolerance is asked for and error bounds hold, as for [`Scene::span`](crate::Scene::span).
    #[must_use]
    pub fn span(mut self, start: f64, stop: f64) -> Self {
        self.options.span = Some((start, stop));
        self.each_scene(|scene| scene.span(start, stop))
    }

    /// Other options for all scenes that were given. Motions that were kept are those of the options before.
    fn each_scene(self, change: impl Fn(Scene) -> Scene) -> Self {
        self.each_member_scene(|_, scene| change(scene))
    }

    fn each_member_scene(mut self, change: impl Fn(usize, Scene) -> Scene) -> Self {
        let scenes = std::mem::take(&mut self.scenes).into_iter().enumerate();
        self.scenes = scenes.map(|(index, scene)| scene.map(|scene| change(index, scene))).collect();
        self.kept = KeptMotions::default();
        self
    }

    /// The bodies whose gravity gradients act: none, those of all members, or those of each.
    pub fn asked_orbits(&self) -> &[Vec<DisturbingBody>] {
        &self.options.orbits
    }

    /// The bodies whose gravity gradients act on a member.
    pub fn orbits_of(&self, index: usize) -> &[DisturbingBody] {
        self.options.orbits(index)
    }

    /// The torques beside the gravity gradient.
    pub fn asked_torques(&self) -> &[Torque] {
        &self.options.torques
    }

    /// How much of the theory of the gravity gradient is used.
    pub fn asked_level(&self) -> Level {
        self.options.level
    }

    /// How the motions are evaluated.
    pub fn asked_method(&self) -> Method {
        self.options.method
    }

    /// The time of the state of a member.
    pub fn epoch(&self, index: usize) -> f64 {
        self.options.epoch(index)
    }

    /// The times of the states: none for 0, one for all, or one for each member.
    pub fn asked_epochs(&self) -> &[f64] {
        &self.options.epochs
    }

    /// What becomes of members that have no motion.
    pub fn asked_on_error(&self) -> OnError {
        self.on_error
    }

    /// The span, if one was given.
    pub fn asked_span(&self) -> Option<(f64, f64)> {
        self.options.span
    }

    /// The tolerance \[rad\].
    pub fn asked_tolerance(&self) -> f64 {
        self.options.tolerance
    }

    /// The number of threads, if one was asked for.
    pub fn asked_threads(&self) -> Option<usize> {
        self.options.threads
    }

    /// Whether what was asked for of all members can be done.
    ///
    /// # Errors
    /// - [`Error::Tolerance`] for `0.0`.
    /// - [`Error::Span`] for `(1.0, 0.0)`.
    /// - [`Error::Threads`] for `0` and above 1024.
    pub fn validate(&self) -> Result<(), Error> {
        self.validate_threads()?;
        if let Some((start, stop)) = self.options.span
            && !(start.is_finite() && stop.is_finite() && start <= stop)
        {
            return Err(Error::Span { start, stop });
        }
        match self.options.tolerance {
            value if value.is_finite() && value > 0.0 => Ok(()),
            value => Err(Error::Tolerance { value }),
        }
    }
}
