//! Many times at once.

use std::sync::atomic::AtomicBool;

use pulp::Arch;

use super::solved::{Motion, length};
use super::trajectory::{Evaluation, Trajectory};
use crate::error::Error;
use crate::simd::grid::GROUP;
use crate::simd::halt::{GOING, Halt, going};
use crate::simd::outputs::Outputs;

/// How a motion is evaluated at many times: the number of threads changes no bit of the result.
///
/// ```
/// use andoyer_propagate::{Body, Scene, State};
/// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
/// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
/// let times: Vec<f64> = (0..40_000).map(f64::from).collect();
/// let (mut one, mut many) = (vec![[0.0; 4]; times.len()], vec![[0.0; 4]; times.len()]);
/// motion.batch().threads(1).attitudes_into(&times, &mut one)?;
/// motion.attitudes_into(&times, &mut many)?;
/// assert_eq!(one, many);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a> {
    motion: &'a Motion,
    threads: usize,
    since_epoch: bool,
    stop: &'a AtomicBool,
}

impl<'a> Batch<'a> {
    pub(crate) fn new(motion: &'a Motion) -> Self {
        Self { motion, threads: usize::MAX, since_epoch: false, stop: &GOING }
    }

    /// Sets the largest number of threads of rayon's pool; 0 counts as 1. A few times are always evaluated by one thread.
    #[must_use]
    pub fn threads(self, most: usize) -> Self {
        Self { threads: most, ..self }
    }

    /// Times are counted from the epoch of the scene: a duration keeps digits that its sum with a large epoch loses.
    #[must_use]
    pub fn since_epoch(self) -> Self {
        Self { since_epoch: true, ..self }
    }

    /// Ends early, with [`Error::Stopped`], once another thread has set this flag: within a millisecond or so. What had been computed stays in the output.
    ///
    /// ```
    /// use std::sync::atomic::AtomicBool;
    /// use andoyer_propagate::{Body, Error, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// let stop = AtomicBool::new(true); // another thread would set it
    /// let stopped = motion.batch().until(&stop).attitudes_into(&[1.0], &mut [[0.0; 4]]);
    /// assert!(matches!(stopped, Err(Error::Stopped)));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn until(self, stop: &'a AtomicBool) -> Self {
        Self { stop, ..self }
    }

    /// Attitudes [x, y, z, w].
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        self.fill(times, Outputs::Attitudes(out))?;
        self.turn(out, &mut [])
    }

    /// Angular velocities, body components [rad per unit of time].
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn angular_velocities_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        self.fill(times, Outputs::Rates(out))?;
        self.turn(&mut [], out)
    }

    /// Attitudes [x, y, z, w] and angular velocities, body components [rad per unit of time].
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn samples_into(&self, times: &[f64], attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        length("attitudes", attitudes.len(), times.len())?;
        length("rates", rates.len(), times.len())?;
        self.about_principal_axes(times, attitudes, rates)?;
        self.turn(attitudes, rates)
    }

    /// Both about the principal axes.
    pub(crate) fn about_principal_axes(
        &self,
        times: &[f64],
        attitudes: &mut [[f64; 4]],
        rates: &mut [[f64; 3]],
    ) -> Result<(), Error> {
        self.fill(times, Outputs::Both(attitudes, rates))
    }

    /// Angular momenta, inertial components.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn angular_momenta_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        let (motion, epoch) = (self.motion, self.epoch());
        motion.valid(times, epoch)?;
        for (part, out) in times.chunks(GROUP).zip(out.chunks_mut(GROUP)) {
            going(self.stop).map_err(|halt| self.halted(halt, times))?;
            match &motion.trajectory {
                Trajectory::Gradient(gradient) => gradient.angular_momenta(part, epoch, out),
                _ => out.fill(motion.angular_momentum.into()),
            }
        }
        Ok(())
    }

    /// To the user's axes.
    fn turn(&self, attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        let Some(given) = &self.motion.given else { return Ok(()) };
        for part in attitudes.chunks_mut(GROUP) {
            self.going()?;
            given.turn(part, &mut []);
        }
        for part in rates.chunks_mut(GROUP) {
            self.going()?;
            given.turn(&mut [], part);
        }
        Ok(())
    }

    fn fill(&self, times: &[f64], outputs: Outputs<'_>) -> Result<(), Error> {
        let Self { motion, threads, stop, .. } = *self;
        let (epoch, bound, arch) = (self.epoch(), motion.bound(), Arch::new());
        let evaluation = Evaluation { trajectory: &motion.trajectory, epoch, bound, arch, stop };
        evaluation.fill(times, outputs, threads).map_err(|halt| self.halted(halt, times))
    }

    /// The epoch as the times count it.
    pub(crate) fn epoch(&self) -> f64 {
        if self.since_epoch { 0.0 } else { self.motion.scene.state().epoch }
    }

    fn halted(&self, halt: Halt, times: &[f64]) -> Error {
        match halt {
            Halt::Time(index) => self.motion.no_phase(index, times),
            Halt::Stopped => Error::Stopped,
        }
    }

    /// # Errors
    /// - [`Error::Stopped`] where the flag is set.
    pub(crate) fn going(&self) -> Result<(), Error> {
        going(self.stop).map_err(|_| Error::Stopped)
    }

    pub(crate) fn motion(&self) -> &'a Motion {
        self.motion
    }
}

impl Motion {
    /// How many times at once are evaluated: on as many threads as pay, unless told otherwise.
    pub fn batch(&self) -> Batch<'_> {
        Batch::new(self)
    }
}
