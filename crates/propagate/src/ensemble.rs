//! Many bodies at a few epochs each: solved and evaluated member by member, in memory proportional to the result.
//!
//! A member's motion lives while its rows are written; nothing of it is kept. Each member is computed by one thread alone, so that the bits
//! do not depend on how many threads there are. A member costs its set-up, 4 to 6 µs, some 200 µs under the gravity gradient of an orbit, and its epochs.
//! Every bad member is found before any is computed, and the error names the first with its index.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::Error;
use crate::input::body::Body;
use crate::input::orbit::Orbit;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::plan::Plan;
use crate::motion::solved::{Motion, length};

/// Members that a thread takes at least: 64 of them are some 300 µs.
const BLOCK: usize = 64;
/// The same under a gravity gradient, at 200 µs each.
const DISTURBED_BLOCK: usize = 2;

/// The largest number of threads that can be asked for.
pub const MAX_THREADS: usize = 1024;

/// Bodies with their states, all at the same epoch.
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
    moments: Vec<[f64; 3]>,
    attitudes: Vec<[f64; 4]>,
    angular_velocities: Vec<[f64; 3]>,
    /// None, one for all, or one for each.
    orbits: Vec<Option<Orbit>>,
    tolerance: f64,
    span: Option<(f64, f64)>,
    threads: Option<usize>,
}

impl Ensemble {
    /// An ensemble from moments, attitudes [x, y, z, w] and body rates of its members, each as a [`Body`] and a [`State`] take them, with a tolerance of 1e-12 rad.
    ///
    /// # Errors
    /// - [`Error::Length`] for slices of unequal lengths.
    /// - [`Error::Member`] for a member that is no body or no state, such as moments `[1.0, 1.0, 2.1]`.
    pub fn new(
        moments: Vec<[f64; 3]>,
        attitudes: Vec<[f64; 4]>,
        angular_velocities: Vec<[f64; 3]>,
    ) -> Result<Self, Error> {
        length("attitudes", attitudes.len(), moments.len())?;
        length("angular_velocities", angular_velocities.len(), moments.len())?;
        let (orbits, tolerance) = (Vec::new(), 1e-12);
        let ensemble = Self { moments, attitudes, angular_velocities, orbits, tolerance, span: None, threads: None };
        let problems = |index: usize| ensemble.scene(index).err().map(|problem| (index, problem));
        let bad: Vec<(usize, Error)> =
            (0..ensemble.len()).into_par_iter().with_min_len(BLOCK).filter_map(problems).collect();
        let others = bad.len().saturating_sub(1);
        match bad.into_iter().next() {
            Some((index, problem)) => Err(Error::Member { index, others, problem: Box::new(problem) }),
            None => Ok(ensemble),
        }
    }

    /// The attitude error asked for \[rad\], as for [`Scene::tolerance`].
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Orbits of bodies whose gravity gradient acts on the members: one for all, or one or none for each, as for [`Scene::orbit`].
    ///
    /// What averaging leaves grows with time: without [`Ensemble::span`] the error bounds are those after 1e9 rotations. Which motions are served is known only when they are
    /// solved.
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
        Ok(self)
    }

    /// The times over which the tolerance is asked for and error bounds hold, as for [`Scene::span`].
    #[must_use]
    pub fn span(mut self, start: f64, stop: f64) -> Self {
        self.span = Some((start, stop));
        self
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

    /// The moments about body axes 1, 2, 3 of each member.
    pub fn moments(&self) -> &[[f64; 3]] {
        &self.moments
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

    fn validate_threads(&self) -> Result<(), Error> {
        match self.threads {
            None | Some(1..=MAX_THREADS) => Ok(()),
            Some(value) => Err(Error::Threads { value, problem: format!("it must be from 1 to {MAX_THREADS}") }),
        }
    }

    fn scene(&self, index: usize) -> Result<Scene, Error> {
        let state = State::new(0.0, self.attitudes[index], self.angular_velocities[index])?;
        let mut scene = Scene::new(Body::new(self.moments[index])?, state).tolerance(self.tolerance);
        if let Some(&orbit) = self.orbit(index) {
            scene = scene.orbit(orbit);
        }
        if let Some((start, stop)) = self.span {
            scene = scene.span(start, stop);
        }
        scene.validate()?;
        Ok(scene)
    }

    /// The motion of one member.
    ///
    /// # Errors
    /// - [`Error::Index`] for an index that no member has.
    /// - [`Error::Member`] with what [`Scene::solve`] says of it.
    pub fn motion(&self, index: usize) -> Result<Motion, Error> {
        if index >= self.len() {
            return Err(Error::Index { index, members: self.len() });
        }
        let motion = self.scene(index).and_then(|scene| scene.solve());
        motion.map_err(|problem| Error::Member { index, others: 0, problem: Box::new(problem) })
    }

    /// The plan of every member.
    ///
    /// # Errors
    /// - As [`Ensemble::motion`], of the first that has one.
    pub fn plans(&self) -> Result<Vec<Plan>, Error> {
        let plan = |index: usize| self.motion(index).map(|motion| motion.plan().clone());
        self.pool()?.install(|| (0..self.len()).into_par_iter().with_min_len(self.block()).map(plan).collect())
    }

    /// Attitudes [x, y, z, w] of all members, the times of a member next to each other.
    ///
    /// `times` is one list for all, or the lists of all members one after the other.
    ///
    /// # Errors
    /// - [`Error::Length`] where neither fits `out`.
    /// - [`Error::Member`] with what [`Scene::solve`] or [`Motion::at`] says of it.
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<(), Error> {
        let each = self.times_of_each("out", times, out.len())?;
        self.each_member(out.par_chunks_mut(each.max(1)), |motion, index, rows| {
            motion.attitudes_into(of_member(times, index, each), rows)
        })
    }

    /// Attitudes and angular velocities, ordered as by [`Ensemble::attitudes_into`].
    ///
    /// # Errors
    /// As [`Ensemble::attitudes_into`].
    pub fn samples_into(&self, times: &[f64], attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        length("rates", rates.len(), attitudes.len())?;
        let each = self.times_of_each("attitudes", times, attitudes.len())?;
        let rows = attitudes.par_chunks_mut(each.max(1)).zip(rates.par_chunks_mut(each.max(1)));
        self.each_member(rows, |motion, index, (attitudes, rates)| {
            motion.samples_into(of_member(times, index, each), attitudes, rates)
        })
    }

    /// The number of times of a member, if that many rows belong to `times`.
    fn times_of_each(&self, argument: &'static str, times: &[f64], rows: usize) -> Result<usize, Error> {
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

    /// Of several members that cannot be evaluated the first is told, whatever the threads were.
    fn each_member<Rows: Send>(
        &self,
        rows: impl IndexedParallelIterator<Item = Rows>,
        evaluate: impl Fn(&Motion, usize, Rows) -> Result<(), Error> + Sync,
    ) -> Result<(), Error> {
        let of_member = |(index, rows): (usize, Rows)| {
            let motion = match self.motion(index) {
                Ok(motion) => motion,
                Err(error) => return Some((index, error)),
            };
            let problem = evaluate(&motion, index, rows).err()?;
            Some((index, Error::Member { index, others: 0, problem: Box::new(problem) }))
        };
        let members = rows.enumerate().with_min_len(self.block()).filter_map(of_member);
        let first = self.pool()?.install(|| members.min_by_key(|&(index, _)| index));
        first.map_or(Ok(()), |(_, error)| Err(error))
    }

    /// Members that a thread takes at least.
    fn block(&self) -> usize {
        if self.orbits.is_empty() { BLOCK } else { DISTURBED_BLOCK }
    }

    fn pool(&self) -> Result<Pool, Error> {
        self.validate_threads()?;
        match self.threads {
            None => Ok(Pool::Global),
            Some(threads) => {
                let pool = ThreadPoolBuilder::new().num_threads(threads).build();
                pool.map(Pool::Own).map_err(|problem| Error::Threads { value: threads, problem: problem.to_string() })
            }
        }
    }
}

fn of_member(times: &[f64], index: usize, each: usize) -> &[f64] {
    if times.len() == each { times } else { &times[index * each..(index + 1) * each] }
}

/// Threads to work on.
enum Pool {
    Global,
    Own(ThreadPool),
}

impl Pool {
    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self {
            Pool::Global => work(),
            Pool::Own(pool) => pool.install(work),
        }
    }
}
