//! The members of an ensemble: what the user states of them, the check of it, and the motion of one.

use std::sync::atomic::{AtomicBool, Ordering};

use andoyer_series::threads::shared;
use rayon::prelude::*;

use crate::error::Error;
use crate::input::body::Body;
use crate::input::options::Method;
use crate::motion::solved::length;
use crate::orbit::elements::Orbit;
use crate::simd::halt::GOING;

use super::kept::Kept;
use super::on_error::OnError;
use super::pool::MAX_THREADS;

/// Members that a thread takes at least. The time of so many is long beside that of starting a task.
pub(super) const BLOCK: usize = 64;

/// Bodies with their states, at one epoch or each at its own.
///
/// ```
/// use andoyer_propagate::Ensemble;
/// let ensemble = Ensemble::new(
///     vec![[1.0, 1.5, 2.0], [1.0, 2.0, 2.5]],
///     vec![[0.0, 0.0, 0.0, 1.0]; 2],
///     vec![[0.1, 0.2, 1.0], [1.0, 0.2, 0.1]],
/// )?;
/// let mut attitudes = [[0.0; 4]; 6];
/// ensemble.attitudes_into(&[0.0, 10.0, 20.0], &mut attitudes)?; // the three times of member 0, then those of member 1
/// assert!((attitudes[3][3] - 1.0).abs() < 1e-15);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Ensemble {
    /// Principal moments; NaN for a tensor that has none.
    moments: Vec<[f64; 3]>,
    /// None, or one for each.
    tensors: Vec<[[f64; 3]; 3]>,
    attitudes: Vec<[f64; 4]>,
    angular_velocities: Vec<[f64; 3]>,
    /// None for 0, one for all, or one for each.
    epochs: Vec<f64>,
    on_error: OnError,
    /// None, one for all, or one for each.
    orbits: Vec<Option<Orbit>>,
    tolerance: f64,
    method: Method,
    span: Option<(f64, f64)>,
    threads: Option<usize>,
    pub(super) kept: Kept,
}

impl Ensemble {
    /// An ensemble from moments, attitudes [x, y, z, w] and body rates of its members, each as a [`Body`] and a [`State`](crate::State) take them, with a tolerance of 1e-12
    /// rad.
    ///
    /// # Errors
    /// - [`Error::Length`] for slices of unequal lengths.
    /// - [`Error::Member`] for a member that is no body or no state, such as moments `[1.0, 1.0, 2.1]`.
    pub fn new(
        moments: Vec<[f64; 3]>,
        attitudes: Vec<[f64; 4]>,
        angular_velocities: Vec<[f64; 3]>,
    ) -> Result<Self, Error> {
        Self::new_or(moments, attitudes, angular_velocities, OnError::Raise, &GOING)
    }

    /// As [`Ensemble::new`], with a choice of what becomes of bad members, and a flag that ends the check of them early.
    ///
    /// ```
    /// use std::sync::atomic::AtomicBool;
    /// use andoyer_propagate::Ensemble;
    /// use andoyer_propagate::ensemble::OnError;
    /// let moments = vec![[1.0, 1.5, 2.0], [1.0, 1.0, 2.5]]; // the second is no body
    /// let (level, rates) = (vec![[0.0, 0.0, 0.0, 1.0]; 2], vec![[0.1, 0.2, 1.0]; 2]);
    /// let ensemble = Ensemble::new_or(moments, level, rates, OnError::Nan, &AtomicBool::new(false))?;
    /// let mut attitudes = [[0.0; 4]; 2];
    /// let outcome = ensemble.attitudes_into(&[10.0], &mut attitudes)?;
    /// assert!(attitudes[0][3].is_finite() && attitudes[1][3].is_nan());
    /// assert_eq!(outcome.errors()[0].0, 1);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - Those of [`Ensemble::new`]; with [`OnError::Nan`] only [`Error::Length`].
    /// - [`Error::Stopped`] where the flag is set.
    pub fn new_or(
        moments: Vec<[f64; 3]>,
        attitudes: Vec<[f64; 4]>,
        angular_velocities: Vec<[f64; 3]>,
        on_error: OnError,
        stop: &AtomicBool,
    ) -> Result<Self, Error> {
        Self::checked((moments, Vec::new()), attitudes, angular_velocities, on_error, stop)
    }

    /// An ensemble from inertia tensors about axes that the user chose, each as [`Body::from_inertia`] takes it; else as [`Ensemble::new_or`]. Attitudes, rates
    /// and momenta are about these axes.
    ///
    /// ```
    /// use std::sync::atomic::AtomicBool;
    /// use andoyer_propagate::Ensemble;
    /// use andoyer_propagate::ensemble::OnError;
    /// let tensors = vec![[[1.5, 0.5, 0.0], [0.5, 1.5, 0.0], [0.0, 0.0, 2.0]]; 2];
    /// let (level, rates) = (vec![[0.0, 0.0, 0.0, 1.0]; 2], vec![[0.0, 0.0, 1.0], [0.1, 0.2, 1.0]]);
    /// let ensemble = Ensemble::from_inertia_or(tensors, level, rates, OnError::Raise, &AtomicBool::new(false))?;
    /// assert!((ensemble.moments()[1][0] - 1.0).abs() < 1e-15 && ensemble.inertia(1)[0] == [1.5, 0.5, 0.0]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - Those of [`Ensemble::new_or`]; [`Error::Member`] also with what [`Body::from_inertia`] says.
    pub fn from_inertia_or(
        tensors: Vec<[[f64; 3]; 3]>,
        attitudes: Vec<[f64; 4]>,
        angular_velocities: Vec<[f64; 3]>,
        on_error: OnError,
        stop: &AtomicBool,
    ) -> Result<Self, Error> {
        let principal = |tensor: &[[f64; 3]; 3]| match stop.load(Ordering::Relaxed) {
            true => [f64::NAN; 3],
            false => Body::from_inertia(*tensor).map_or([f64::NAN; 3], |body| body.moments()),
        };
        let moments = tensors.iter().map(principal).collect();
        Self::checked((moments, tensors), attitudes, angular_velocities, on_error, stop)
    }

    fn checked(
        (moments, tensors): (Vec<[f64; 3]>, Vec<[[f64; 3]; 3]>),
        attitudes: Vec<[f64; 4]>,
        angular_velocities: Vec<[f64; 3]>,
        on_error: OnError,
        stop: &AtomicBool,
    ) -> Result<Self, Error> {
        length("attitudes", attitudes.len(), moments.len())?;
        length("angular_velocities", angular_velocities.len(), moments.len())?;
        let ensemble = Self {
            moments,
            tensors,
            attitudes,
            angular_velocities,
            epochs: Vec::new(),
            on_error,
            orbits: Vec::new(),
            tolerance: 1e-12,
            method: Method::Auto,
            span: None,
            threads: None,
            kept: Kept::default(),
        };
        ensemble.raise_bad_members(stop)?;
        Ok(ensemble)
    }

    /// The first member that is no body or no state, as an error, unless they are to be NaN.
    fn raise_bad_members(&self, stop: &AtomicBool) -> Result<(), Error> {
        if self.on_error == OnError::Nan && !stop.load(Ordering::Relaxed) {
            return Ok(());
        }
        let problems = |index: usize| match stop.load(Ordering::Relaxed) {
            true => Some((index, Error::Stopped)),
            false => self.scene(index).err().map(|problem| (index, problem)),
        };
        let members = 0..self.len();
        let bad: Vec<(usize, Error)> = shared(self.len() / BLOCK, |threads| match threads {
            1 => members.filter_map(problems).collect(),
            _ => members.into_par_iter().with_min_len(BLOCK).filter_map(problems).collect(),
        });
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Stopped);
        }
        let others = bad.len().saturating_sub(1);
        match bad.into_iter().next() {
            Some((index, problem)) => Err(Error::Member { index, others, problem: Box::new(problem) }),
            None => Ok(()),
        }
    }

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
        self.epochs = epochs;
        // What is the same for all is kept once, and 0 not at all: equal ensembles are equal.
        if self.epochs.windows(2).all(|pair| pair[0] == pair[1]) {
            self.epochs.truncate(usize::from(self.epochs.first().is_some_and(|&epoch| epoch != 0.0)));
        }
        Ok(self.changed())
    }

    /// The attitude error asked for \[rad\], as for [`Scene::tolerance`](crate::Scene::tolerance).
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self.changed()
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
        self.method = method;
        self.changed()
    }

    /// Orbits of bodies whose gravity gradient acts on the members: one for all, or one or none for each, as for [`Scene::orbit`](crate::Scene::orbit).
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
    /// - [`Error::Length`] for three orbits of five members.
    pub fn orbits(mut self, mut orbits: Vec<Option<Orbit>>) -> Result<Self, Error> {
        if orbits.len() != 1 {
            length("orbits", orbits.len(), self.len())?;
        }
        // What is the same for all is kept once, and no orbit not at all: equal ensembles are equal.
        if orbits.windows(2).all(|pair| pair[0] == pair[1]) {
            orbits.truncate(usize::from(orbits.first().is_some_and(Option::is_some)));
        }
        self.orbits = orbits;
        Ok(self.changed())
    }

    /// The times over which the tolerance is asked for and error bounds hold, as for [`Scene::span`](crate::Scene::span).
    #[must_use]
    pub fn span(mut self, start: f64, stop: f64) -> Self {
        self.span = Some((start, stop));
        self.changed()
    }

    /// Without the motions that were kept: they are those of other options.
    fn changed(self) -> Self {
        Self { kept: Kept::default(), ..self }
    }

    /// The number of threads, instead of one for each core.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = Some(threads);
        self
    }

    /// The number of members.
    pub fn len(&self) -> usize {
        self.moments.len()
    }

    /// Whether it has no member.
    pub fn is_empty(&self) -> bool {
        self.moments.is_empty()
    }

    /// The moments about body axes 1, 2, 3 of each member, as [`Body::moments`]; NaN for a tensor that is not valid.
    pub fn moments(&self) -> &[[f64; 3]] {
        &self.moments
    }

    /// The inertia tensors: none, or one for each member.
    pub fn asked_tensors(&self) -> &[[[f64; 3]; 3]] {
        &self.tensors
    }

    /// The inertia tensor of a member as given, diagonal if moments were given.
    pub fn inertia(&self, index: usize) -> [[f64; 3]; 3] {
        let [a, b, c] = self.moments[index];
        self.tensors.get(index).copied().unwrap_or([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]])
    }

    /// The attitude of each member at the epoch, as given.
    pub fn attitudes(&self) -> &[[f64; 4]] {
        &self.attitudes
    }

    /// The angular velocity of each member at the epoch.
    pub fn angular_velocities(&self) -> &[[f64; 3]] {
        &self.angular_velocities
    }

    /// The orbits: none, one for all, or one or none for each member.
    pub fn asked_orbits(&self) -> &[Option<Orbit>] {
        &self.orbits
    }

    /// The orbit of a member, if it has one.
    pub fn orbit(&self, index: usize) -> Option<&Orbit> {
        match &self.orbits[..] {
            [of_all] => of_all.as_ref(),
            each => each.get(index)?.as_ref(),
        }
    }

    /// How the motions are evaluated.
    pub fn asked_method(&self) -> Method {
        self.method
    }

    /// The time of the state of a member.
    pub fn epoch(&self, index: usize) -> f64 {
        match &self.epochs[..] {
            [] => 0.0,
            [of_all] => *of_all,
            each => each[index],
        }
    }

    /// The times of the states: none for 0, one for all, or one for each member.
    pub fn asked_epochs(&self) -> &[f64] {
        &self.epochs
    }

    /// What becomes of members that have no motion.
    pub fn asked_on_error(&self) -> OnError {
        self.on_error
    }

    /// The span, if one was given.
    pub fn asked_span(&self) -> Option<(f64, f64)> {
        self.span
    }

    /// The tolerance \[rad\].
    pub fn asked_tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The number of threads, if one was asked for.
    pub fn asked_threads(&self) -> Option<usize> {
        self.threads
    }

    /// Whether what was asked for of all members can be done.
    ///
    /// # Errors
    /// - [`Error::Tolerance`] for `0.0`.
    /// - [`Error::Span`] for `(1.0, 0.0)`.
    /// - [`Error::Threads`] for `0` and above [`MAX_THREADS`].
    pub fn validate(&self) -> Result<(), Error> {
        self.validate_threads()?;
        if let Some((start, stop)) = self.span
            && !(start.is_finite() && stop.is_finite() && start <= stop)
        {
            return Err(Error::Span { start, stop });
        }
        match self.tolerance {
            value if value.is_finite() && value > 0.0 => Ok(()),
            value => Err(Error::Tolerance { value }),
        }
    }

    pub(super) fn validate_threads(&self) -> Result<(), Error> {
        match self.threads {
            None | Some(1..=MAX_THREADS) => Ok(()),
            Some(value) => Err(Error::Threads { value, problem: format!("it must be from 1 to {MAX_THREADS}") }),
        }
    }

    /// The number of times of a member, if that many rows belong to `times`.
    pub(super) fn times_of_each(&self, argument: &'static str, times: &[f64], rows: usize) -> Result<usize, Error> {
        if rows == times.len() * self.len() {
            return Ok(times.len());
        }
        length(argument, rows, times.len())?;
        if self.is_empty() {
            return Ok(0);
        }
        let each = rows / self.len();
        length("times", times.len(), each * self.len())?;
        Ok(each)
    }
}
