//! The members of an ensemble: what the user states of them, the check of it, and the motion of one.

use std::sync::atomic::{AtomicBool, Ordering};

use andoyer_series::threads::map;

use crate::error::Error;
use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::motion::solved::length;
use crate::simd::halt::GOING;

use super::kept::KeptMotions;
use super::on_error::OnError;
use super::options::Options;

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
#[derive(Clone, Debug)]
pub struct Ensemble {
    /// Principal moments; NaN for a tensor that has none.
    moments: Vec<[f64; 3]>,
    /// None, or one for each.
    tensors: Vec<[[f64; 3]; 3]>,
    attitudes: Vec<[f64; 4]>,
    angular_velocities: Vec<[f64; 3]>,
    pub(super) on_error: OnError,
    pub(super) options: Options,
    /// The scenes of [`Ensemble::from_scenes`], one for each member, or none. Where there are scenes, `options` has what they have in common.
    pub(super) scenes: Vec<Result<Scene, Error>>,
    pub(super) kept: KeptMotions,
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
            on_error,
            options: Options::default(),
            scenes: Vec::new(),
            kept: KeptMotions::default(),
        };
        ensemble.raise_bad_members(stop)?;
        Ok(ensemble)
    }

    /// The first member that is no body or no state, as an error, unless they are to be NaN.
    pub(super) fn raise_bad_members(&self, stop: &AtomicBool) -> Result<(), Error> {
        if self.on_error == OnError::Nan && !stop.load(Ordering::Relaxed) {
            return Ok(());
        }
        let problems = |index: usize| match stop.load(Ordering::Relaxed) {
            true => Some((index, Error::Stopped)),
            false => self.scene(index).err().map(|problem| (index, problem)),
        };
        let blocks: Vec<_> = (0..self.len()).step_by(BLOCK).collect();
        let of_block = |first: usize| (first..self.len().min(first + BLOCK)).filter_map(problems).collect();
        let bad: Vec<(usize, Error)> = map(blocks, of_block).into_iter().flat_map(Vec::into_iter).collect();
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Stopped);
        }
        let others = bad.len().saturating_sub(1);
        match bad.into_iter().next() {
            Some((index, problem)) => Err(Error::Member { index, others, problem: Box::new(problem) }),
            None => Ok(()),
        }
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
