//! Evaluation of the members of an ensemble: the members are shared among the threads, and the times of one member where there are few.
//!
//! A member's motion lives while its rows are written; those under a torque are kept ([`super::kept`]).

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use andoyer_series::threads::map;

use crate::error::Error;
use crate::input::options::Convention;
use crate::motion::batch::Batch;
use crate::motion::plan::Plan;
use crate::motion::solved::{Motion, Periods, length};
use crate::orbital::{OrbitalFrame, OrbitalSample};
use crate::outcome::Outcome;
use crate::partials::{Derivatives, INERTIA_PARAMETERS};
use crate::simd::halt::GOING;

use super::members::Ensemble;
use super::on_error::OnError;

impl Ensemble {
    /// How its members are evaluated.
    pub fn run(&self) -> MembersRun<'_> {
        MembersRun { ensemble: self, since_epoch: false, stop: &GOING, done: None }
    }

    /// The plan of every member.
    ///
    /// # Errors
    /// - The error of the first member that has no motion, as of [`Ensemble::motion`].
    pub fn plans(&self) -> Result<Vec<Plan>, Error> {
        self.run().plans()?.into_iter().collect()
    }

    /// Attitudes [x, y, z, w] of all members, the times of a member next to each other.
    ///
    /// `times` is one list for all, or the lists of all members one after the other.
    ///
    /// # Errors
    /// - [`Error::Length`] where neither fits `out`.
    /// - [`Error::Member`] with what [`crate::Scene::solve`] or [`Motion::at`] says of it, unless such members are to be NaN.
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<Outcome, Error> {
        self.run().attitudes_into(times, out)
    }

    /// Attitudes and angular velocities, ordered as by [`Ensemble::attitudes_into`].
    ///
    /// # Errors
    /// As [`Ensemble::attitudes_into`].
    pub fn samples_into(
        &self,
        times: &[f64],
        attitudes: &mut [[f64; 4]],
        rates: &mut [[f64; 3]],
    ) -> Result<Outcome, Error> {
        self.run().samples_into(times, attitudes, rates)
    }
}

/// How the members of an ensemble are evaluated.
#[derive(Clone, Copy, Debug)]
pub struct MembersRun<'a> {
    pub(super) ensemble: &'a Ensemble,
    since_epoch: bool,
    stop: &'a AtomicBool,
    done: Option<&'a AtomicUsize>,
}

impl<'a> MembersRun<'a> {
    /// Times are counted from the epoch of each member, as by [`crate::batch::Batch::since_epoch`].
    #[must_use]
    pub fn since_epoch(self) -> Self {
        Self { since_epoch: true, ..self }
    }

    /// Ends early, with [`Error::Stopped`], once another thread has set this flag: integrations end too, other members that are being solved are finished.
    #[must_use]
    pub fn until(self, stop: &'a AtomicBool) -> Self {
        Self { stop, ..self }
    }

    /// Counts in `done` the members that are evaluated, for another thread that shows the progress.
    #[must_use]
    pub fn counting(self, done: &'a AtomicUsize) -> Self {
        Self { done: Some(done), ..self }
    }

    /// The plan of every member, or why it has none.
    ///
    /// # Errors
    /// - [`Error::Threads`] for threads that the system does not give.
    /// - [`Error::Stopped`] where the flag is set.
    pub fn plans(&self) -> Result<Vec<Result<Plan, Error>>, Error> {
        let Self { ensemble, .. } = *self;
        let size = ensemble.group();
        let plans = |group: usize| {
            let members = group * size..ensemble.len().min((group + 1) * size);
            if let Err(stopped) = self.going() {
                return members.map(|_| Err(stopped.clone())).collect();
            }
            if !members.clone().any(|member| ensemble.is_kept(member)) {
                return members.map(|index| ensemble.motion(index).map(|motion| motion.plan().clone())).collect();
            }
            let (mut plans, mut index) = (Vec::with_capacity(size), members.start);
            ensemble.each_motion(members, self.stop, |motion| {
                let plan = motion.as_ref().map(|motion| motion.plan().clone());
                plans.push(plan.map_err(|error| Error::of_member(index, error.clone())));
                index += 1;
            });
            plans
        };
        let groups = (0..ensemble.len().div_ceil(size)).collect();
        let plans: Vec<Vec<_>> = ensemble.on_threads(|| map(groups, plans))?;
        self.going().map(|()| plans.into_iter().flatten().collect())
    }

    /// As [`Ensemble::attitudes_into`].
    ///
    /// # Errors
    /// As [`Ensemble::attitudes_into`]; [`Error::Stopped`] where the flag is set.
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<Outcome, Error> {
        self.rows_into(times, out, |batch, times, rows| batch.attitudes_into(times, rows))
    }

    /// Angular momenta in inertial components, ordered as by [`Ensemble::attitudes_into`].
    ///
    /// # Errors
    /// As [`MembersRun::attitudes_into`].
    pub fn angular_momenta_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<Outcome, Error> {
        self.rows_into(times, out, |batch, times, rows| batch.angular_momenta_into(times, rows))
    }

    /// Andoyer variables [λ, μ, ν, Λ, M, N] as of [`Motion::andoyer_into`], ordered as by [`Ensemble::attitudes_into`].
    ///
    /// # Errors
    /// As [`MembersRun::attitudes_into`].
    pub fn andoyer_into(&self, times: &[f64], out: &mut [[f64; 6]]) -> Result<Outcome, Error> {
        self.rows_into(times, out, |batch, times, rows| batch.andoyer_into(times, rows))
    }

    /// Attitudes and angular velocities against the orbital frame as of [`Motion::orbital`], ordered as by [`Ensemble::attitudes_into`].
    ///
    /// # Errors
    /// As [`MembersRun::attitudes_into`], and those of [`OrbitalFrame::at`] of a member.
    pub fn orbital_into(
        &self,
        times: &[f64],
        frame: &OrbitalFrame,
        out: &mut [OrbitalSample],
    ) -> Result<Outcome, Error> {
        let evaluate = |batch: &Batch<'_>, times: &[f64], rows: &mut [OrbitalSample]| {
            rows.copy_from_slice(&batch.orbital(times, frame)?);
            Ok(())
        };
        self.items_into(times, out, OrbitalSample::NAN, evaluate)
    }

    /// N numbers for each time of each member.
    fn rows_into<const N: usize>(
        &self,
        times: &[f64],
        out: &mut [[f64; N]],
        evaluate: impl Fn(&Batch<'_>, &[f64], &mut [[f64; N]]) -> Result<(), Error> + Sync,
    ) -> Result<Outcome, Error> {
        self.items_into(times, out, [f64::NAN; N], evaluate)
    }

    /// An item for each time of each member.
    fn items_into<T: Copy + Send + Sync>(
        &self,
        times: &[f64],
        out: &mut [T],
        none: T,
        evaluate: impl Fn(&Batch<'_>, &[f64], &mut [T]) -> Result<(), Error> + Sync,
    ) -> Result<Outcome, Error> {
        let each = self.ensemble.times_of_each("out", times, out.len())?;
        let fill = |motion: &Motion, index: usize, rows: &mut &mut [T], part: Range<usize>| {
            evaluate(&self.batch(motion), &of_member(times, index, each)[part.clone()], &mut rows[part])
        };
        self.each_time(each, out.chunks_mut(each.max(1)), fill, |rows, part| rows[part].fill(none))
    }

    /// As [`Ensemble::samples_into`].
    ///
    /// # Errors
    /// As [`Ensemble::attitudes_into`]; [`Error::Stopped`] where the flag is set.
    pub fn samples_into(
        &self,
        times: &[f64],
        attitudes: &mut [[f64; 4]],
        rates: &mut [[f64; 3]],
    ) -> Result<Outcome, Error> {
        length("rates", rates.len(), attitudes.len())?;
        let each = self.ensemble.times_of_each("attitudes", times, attitudes.len())?;
        let rows = attitudes.chunks_mut(each.max(1)).zip(rates.chunks_mut(each.max(1)));
        let fill =
            |motion: &Motion, index: usize, rows: &mut (&mut [[f64; 4]], &mut [[f64; 3]]), part: Range<usize>| {
                let times = &of_member(times, index, each)[part.clone()];
                self.batch(motion).samples_into(times, &mut rows.0[part.clone()], &mut rows.1[part])
            };
        self.each_time(each, rows, fill, |rows, part| {
            rows.0[part.clone()].fill([f64::NAN; 4]);
            rows.1[part].fill([f64::NAN; 3]);
        })
    }

    /// Derivatives of attitudes and angular velocities as of [`Motion::partials_into`], ordered as by [`Ensemble::attitudes_into`].
    ///
    /// ```
    /// use andoyer_propagate::Ensemble;
    /// use andoyer_propagate::partials::PARAMETERS;
    /// let rates = vec![[0.0, 0.0, 2.0], [0.0, 0.0, 3.0]];
    /// let ensemble = Ensemble::new(vec![[1.0, 1.5, 2.0]; 2], vec![[0.0, 0.0, 0.0, 1.0]; 2], rates)?;
    /// let (mut attitudes, mut rates) = ([[[0.0; PARAMETERS]; 3]; 2], [[[0.0; PARAMETERS]; 3]; 2]);
    /// ensemble.run().partials_into(&[10.0], &mut attitudes, &mut rates)?;
    /// // Rotation about axis 3: the angle grows by the time for each unit of its rate.
    /// assert!((attitudes[1][2][5] - 10.0).abs() < 1e-14);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`MembersRun::attitudes_into`]; [`Error::SeparatrixPartials`] of a member on the separatrix.
    pub fn partials_into(
        &self,
        times: &[f64],
        attitudes: &mut [Derivatives],
        rates: &mut [Derivatives],
    ) -> Result<Outcome, Error> {
        self.matrices_into((times, attitudes, rates), |batch, times, one, other| batch.partials_into(times, one, other))
    }

    /// Derivatives with respect to the elements of the inertia tensors as of [`Motion::inertia_partials`], ordered as by [`Ensemble::attitudes_into`].
    ///
    /// # Errors
    /// As [`MembersRun::partials_into`].
    pub fn inertia_partials_into(
        &self,
        times: &[f64],
        attitudes: &mut [Derivatives<INERTIA_PARAMETERS>],
        rates: &mut [Derivatives<INERTIA_PARAMETERS>],
    ) -> Result<Outcome, Error> {
        self.matrices_into((times, attitudes, rates), |batch, times, one, other| {
            batch.inertia_partials_into(times, one, other)
        })
    }

    /// Two matrices of N columns for each time of each member.
    fn matrices_into<const N: usize>(
        &self,
        (times, attitudes, rates): (&[f64], &mut [Derivatives<N>], &mut [Derivatives<N>]),
        fill: impl Fn(&Batch<'_>, &[f64], &mut [Derivatives<N>], &mut [Derivatives<N>]) -> Result<(), Error> + Sync,
    ) -> Result<Outcome, Error> {
        length("rates", rates.len(), attitudes.len())?;
        let each = self.ensemble.times_of_each("attitudes", times, attitudes.len())?;
        let rows = attitudes.chunks_mut(each.max(1)).zip(rates.chunks_mut(each.max(1)));
        type Rows<'r, const N: usize> = (&'r mut [Derivatives<N>], &'r mut [Derivatives<N>]);
        let fill = |motion: &Motion, index: usize, rows: &mut Rows<'_, N>, part: Range<usize>| {
            let times = &of_member(times, index, each)[part.clone()];
            fill(&self.batch(motion), times, &mut rows.0[part.clone()], &mut rows.1[part])
        };
        self.each_time(each, rows, fill, |rows, part| {
            rows.0[part.clone()].fill([[f64::NAN; N]; 3]);
            rows.1[part].fill([[f64::NAN; N]; 3]);
        })
    }

    /// Mean periods of each member, in the conventions of [`Convention::ALL`].
    ///
    /// # Errors
    /// - [`Error::Length`] for an `out` shorter or longer than the members.
    /// - Else as [`MembersRun::attitudes_into`].
    pub fn periods_into(&self, out: &mut [[Periods; 3]]) -> Result<Outcome, Error> {
        let none = Periods { precession: f64::NAN, rotation: f64::NAN };
        self.values_into(out, [none; 3], |motion| Ok(Convention::ALL.map(|convention| motion.periods_of(convention))))
    }

    /// E/E0 of each member, as [`Motion::energy_ratio`].
    ///
    /// # Errors
    /// As [`MembersRun::periods_into`].
    pub fn energy_ratios_into(&self, out: &mut [f64]) -> Result<Outcome, Error> {
        self.values_into(out, f64::NAN, |motion| Ok(motion.energy_ratio()))
    }

    /// One value for each member, or `none` for one that has no motion.
    pub(super) fn values_into<T: Copy + Send + Sync>(
        &self,
        out: &mut [T],
        none: T,
        value: impl Fn(&Motion) -> Result<T, Error> + Sync,
    ) -> Result<Outcome, Error> {
        length("out", out.len(), self.ensemble.len())?;
        let evaluate = |motion: &Motion, _: usize, slot: &mut &mut T| {
            **slot = value(motion)?;
            Ok(())
        };
        self.each_member(out.iter_mut(), evaluate, |slot| **slot = none)
    }

    pub(super) fn batch<'m>(&'m self, motion: &'m Motion) -> Batch<'m> {
        let batch = motion.batch().until(self.stop);
        if self.since_epoch { batch.since_epoch() } else { batch }
    }

    fn going(&self) -> Result<(), Error> {
        if self.stop.load(Ordering::Relaxed) { Err(Error::Stopped) } else { Ok(()) }
    }

    /// Evaluates each member at `count` times. If refused members are to be NaN, a time that a motion does not serve is NaN by itself; the outcome has the error of the
    /// first such time.
    fn each_time<Rows: Send>(
        &self,
        count: usize,
        rows: impl Iterator<Item = Rows>,
        fill: impl Fn(&Motion, usize, &mut Rows, Range<usize>) -> Result<(), Error> + Sync,
        blank: impl Fn(&mut Rows, Range<usize>) + Sync,
    ) -> Result<Outcome, Error> {
        let alone = self.ensemble.asked_on_error() == OnError::Nan;
        let evaluate = |motion: &Motion, index: usize, rows: &mut Rows| {
            let fill = |rows: &mut Rows, part: Range<usize>| fill(motion, index, rows, part);
            if alone { by_halves(rows, 0..count, &fill, &blank) } else { fill(rows, 0..count) }
        };
        self.each_member(rows, evaluate, |rows| blank(rows, 0..count))
    }

    /// Evaluates each member. The rows of members that fail are filled by `blank`, unless the failure is that of a time. With [`OnError::Raise`] the error is that of the first such member, for any
    /// number of threads.
    fn each_member<Rows: Send>(
        &self,
        rows: impl Iterator<Item = Rows>,
        evaluate: impl Fn(&Motion, usize, &mut Rows) -> Result<(), Error> + Sync,
        blank: impl Fn(&mut Rows) + Sync,
    ) -> Result<Outcome, Error> {
        let Self { ensemble, .. } = *self;
        let told = |outcome: Outcome, (index, rows): (usize, &mut Rows), motion: &Result<Motion, Error>| {
            let (outcome, refused) = match motion {
                Ok(motion) => match evaluate(motion, index, rows) {
                    Ok(()) => return outcome.solved(index, motion.plan()),
                    // The other times have their values.
                    Err(error @ Error::Time { .. }) => (outcome.solved(index, motion.plan()), error),
                    Err(error) => {
                        blank(rows);
                        (outcome, error)
                    }
                },
                Err(error) => {
                    blank(rows);
                    (outcome, error.clone())
                }
            };
            outcome.refused(index, Error::of_member(index, refused))
        };
        let size = ensemble.group();
        let all_told = |outcome: Outcome, first: usize, rows: &mut [Rows]| {
            if let Err(stopped) = self.going() {
                return outcome.refused(0, stopped);
            }
            let members = first..first + rows.len();
            let count = rows.len();
            let (mut all, mut rows) = (outcome, members.clone().zip(rows.iter_mut()));
            ensemble.each_motion(members, self.stop, |motion| {
                if let Some(member) = rows.next() {
                    all = told(std::mem::take(&mut all), member, motion);
                }
            });
            if let Some(done) = self.done {
                done.fetch_add(count, Ordering::Relaxed);
            }
            all
        };
        let mut rows: Vec<Rows> = rows.collect();
        let block = ensemble.block();
        let of_block = |(index, rows): (usize, &mut [Rows])| {
            let groups = rows.chunks_mut(size).enumerate();
            groups.fold(Outcome::default(), |told, (group, rows)| all_told(told, index * block + group * size, rows))
        };
        let outcomes = ensemble.on_threads(|| map(rows.chunks_mut(block).enumerate().collect(), of_block))?;
        let outcome = outcomes.into_iter().fold(Outcome::default(), Outcome::and);
        self.going()?;
        match ensemble.asked_on_error() {
            OnError::Nan => Ok(outcome),
            OnError::Raise => outcome.or_first_error(),
        }
    }
}

/// Fills the rows of a part of the times, and where a time of it is refused, those of each half. A refused time alone is filled by `blank`.
///
/// # Errors
/// - The error of the first refused time, counted among all times; any other error at once.
fn by_halves<Rows>(
    rows: &mut Rows,
    part: Range<usize>,
    fill: &impl Fn(&mut Rows, Range<usize>) -> Result<(), Error>,
    blank: &impl Fn(&mut Rows, Range<usize>),
) -> Result<(), Error> {
    match fill(rows, part.clone()) {
        Err(Error::Time { index, value, epoch, span, bound, reason }) => {
            let error = Error::Time { index: part.start + index, value, epoch, span, bound, reason };
            if part.len() < 2 {
                blank(rows, part);
                return Err(error);
            }
            let middle = part.start + part.len() / 2;
            let halves = [part.start..middle, middle..part.end].map(|half| by_halves(rows, half, fill, blank));
            match halves.into_iter().find(|found| !matches!(found, Ok(()) | Err(Error::Time { .. }))) {
                Some(other) => other,
                None => Err(error),
            }
        }
        found => found,
    }
}

fn of_member(times: &[f64], index: usize, each: usize) -> &[f64] {
    if times.len() == each { times } else { &times[index * each..(index + 1) * each] }
}
