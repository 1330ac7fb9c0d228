//! Evaluation at many times at once.

use std::sync::atomic::AtomicBool;

use nalgebra::{UnitQuaternion, Vector3};
use pulp::Arch;

use super::solved::{Motion, length};
use super::trajectory::{Evaluation, Trajectory};
use crate::error::Error;
use crate::input::torque::rotors;
use crate::simd::grid::GROUP;
use crate::simd::halt::{GOING, Halt, going};
use crate::simd::outputs::Outputs;

/// The options of an evaluation at many times. The number of threads does not change any bit of the result.
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

    /// Counts times from the epoch of the scene. A duration keeps digits that its sum with a large epoch would lose.
    #[must_use]
    pub fn since_epoch(self) -> Self {
        Self { since_epoch: true, ..self }
    }

    /// Ends the evaluation with [`Error::Stopped`] when another thread sets this flag, within about a millisecond. Results computed before remain in the
    /// output.
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

    /// The flag that ends the evaluation.
    pub(crate) fn stop(&self) -> &AtomicBool {
        self.stop
    }

    /// Writes the attitudes [x, y, z, w] at `times` to `out`.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        self.fill(times, Outputs::Attitudes(out))?;
        self.turn(out, &mut [])
    }

    /// Writes the angular velocities at `times` to `out`: body components [rad per unit of time].
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn angular_velocities_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        self.fill(times, Outputs::Rates(out))?;
        self.turn(&mut [], out)
    }

    /// Writes the attitudes [x, y, z, w] and the angular velocities, in body components [rad per unit of time], at `times`.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn samples_into(&self, times: &[f64], attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        length("attitudes", attitudes.len(), times.len())?;
        length("rates", rates.len(), times.len())?;
        self.about_principal_axes(times, attitudes, rates)?;
        self.turn(attitudes, rates)
    }

    /// Attitudes and rates about the principal axes.
    pub(crate) fn about_principal_axes(
        &self,
        times: &[f64],
        attitudes: &mut [[f64; 4]],
        rates: &mut [[f64; 3]],
    ) -> Result<(), Error> {
        self.fill(times, Outputs::Both(attitudes, rates))
    }

    /// Writes the angular momenta at `times` to `out`, in inertial components.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn angular_momenta_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        let (motion, epoch) = (self.motion, self.epoch());
        motion.valid(times, epoch)?;
        for (part, out) in times.chunks(GROUP).zip(out.chunks_mut(GROUP)) {
            going(self.stop).map_err(|halt| self.halted(halt, times))?;
            match &motion.trajectory {
                Trajectory::Forced(motion) if motion.angular_momenta(part, epoch, out) => {}
                Trajectory::Forced(_) => self.momenta_of_samples(part, out)?,
                _ => out.fill(motion.angular_momentum.into()),
            }
        }
        Ok(())
    }

    /// The angular momenta R (Iω + h), with that of rotors, from attitudes and rates.
    fn momenta_of_samples(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        let mut attitudes = vec![[0.0; 4]; times.len()];
        self.about_principal_axes(times, &mut attitudes, out)?;
        let moments = self.motion.scene.body().moments();
        let rotors = rotors(self.motion.scene.asked_torques());
        for (momentum, attitude) in out.iter_mut().zip(attitudes) {
            let about_axes = rotors + Vector3::from_fn(|i, _| moments[i] * momentum[i]);
            *momentum = (UnitQuaternion::new_unchecked(attitude.into()) * about_axes).into();
        }
        Ok(())
    }

    /// Transforms attitudes and rates from the principal axes to the user's axes.
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
        let (epoch, arch) = (self.epoch(), Arch::new());
        let reach = motion.reach_from(epoch);
        let evaluation = Evaluation { trajectory: &motion.trajectory, epoch, reach, arch, stop };
        evaluation.fill(times, outputs, threads).map_err(|halt| self.halted(halt, times))
    }

    /// The epoch in the scale of the times.
    pub(crate) fn epoch(&self) -> f64 {
        if self.since_epoch { 0.0 } else { self.motion.scene.state().epoch }
    }

    fn halted(&self, halt: Halt, times: &[f64]) -> Error {
        match halt {
            Halt::Time(index) => self.motion.no_phase(index, times, self.epoch()),
            Halt::Stopped => Error::Stopped,
        }
    }

    /// # Errors
    /// - [`Error::Stopped`] if the flag is set.
    pub(crate) fn going(&self) -> Result<(), Error> {
        going(self.stop).map_err(|_| Error::Stopped)
    }

    pub(crate) fn motion(&self) -> &'a Motion {
        self.motion
    }
}

impl Motion {
    /// An evaluation at many times. The default number of threads is the fastest one.
    pub fn batch(&self) -> Batch<'_> {
        Batch::new(self)
    }
}
