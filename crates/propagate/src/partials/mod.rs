//! Derivatives of attitude and rates with respect to the state at the epoch and the moments, in closed form (theory §12).
//!
//! There are nine parameters: a small rotation of the initial attitude about the three body axes, the initial angular velocity, and the three moments as given.
//! A change of attitude, at the epoch and at the time, is a rotation vector about body axes, R → R exp(\[δθ\]×). With g = G/M, ν_i = M/(A, B, C)_i and the
//! invariants of the polhode, every derivative is an algebraic function of attitude and rates at the time and of one elliptic integral of the second kind, ∫g2²
//! dt. Set-up takes some microseconds. Accuracy: 1e-14 of the largest derivative over the smaller of Q1, the minimum of cos²J, and C/B − 1. Q1 is small next to the
//! separatrix, C/B − 1 next to a sphere. Where one of them is below 1e-4, power series in time replace the closed form (`expansion.rs`).
//!
//! For a body with an inertia tensor there are twelve parameters: the six elements of the tensor replace the moments (`tensor.rs`). Under a torque the derivatives,
//! also with respect to the orbits (`parameters.rs`), come from variational equations, or far from the epoch of an averaged motion from differences (`forced.rs`).

mod constants;
mod derivatives;
#[cfg(feature = "torques")]
mod differences;
mod displacement;
mod evaluate;
mod expansion;
#[cfg(feature = "torques")]
mod forced;
mod integral;
mod matrices;
mod parameters;
mod sources;
mod steady;
mod tensor;

use nalgebra::{Matrix3, SMatrix};

use crate::error::Error;
use crate::motion::batch::Batch;
use crate::motion::solved::{Motion, length};
use crate::motion::trajectory::Trajectory;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

use constants::Setting;
pub use derivatives::{Derivatives, INERTIA_PARAMETERS, PARAMETERS, Partials};
use evaluate::Target;
pub use parameters::Parameter;
use sources::Steadily;
use steady::Varied;

/// Attitudes [x, y, z, w] and angular velocities at several times.
type AttitudesAndRates = (Vec<[f64; 4]>, Vec<[f64; 3]>);

impl Motion {
    /// Derivatives of attitude and angular velocity at a time with respect to the initial attitude, the initial angular velocity and the moments (theory §12).
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// // Rotation about axis 3: the angle grows by the time for each unit of its rate.
    /// assert!((motion.partials(10.0)?.attitude[2][5] - 10.0).abs() < 1e-14);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Motion::partials_into`].
    pub fn partials(&self, time: f64) -> Result<Partials, Error> {
        let (mut attitude, mut rates) = ([[[0.0; PARAMETERS]; 3]], [[[0.0; PARAMETERS]; 3]]);
        self.partials_into(&[time], &mut attitude, &mut rates)?;
        Ok(Partials { time, attitude: attitude[0], angular_velocity: rates[0] })
    }

    /// Writes the derivatives at many times to `attitudes` and `rates`, without an allocation for each time.
    ///
    /// # Errors
    /// - [`Error::Length`] if an output and `times` have different lengths.
    /// - [`Error::Time`] as for [`Motion::at`]; for rotation about the middle axis also for times at which e^(λt) overflows.
    /// - [`Error::SeparatrixPartials`] on the separatrix.
    pub fn partials_into(
        &self,
        times: &[f64],
        attitudes: &mut [Derivatives],
        rates: &mut [Derivatives],
    ) -> Result<(), Error> {
        self.batch().partials_into(times, attitudes, rates)
    }

    /// Derivatives of attitude and angular velocity at a time with respect to the initial attitude, the initial angular velocity and the six elements of the
    /// inertia tensor about the body's axes: I11, I22, I33, I12, I13, I23. A change of I12 is one of I21 too. A body given by moments has a diagonal tensor.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// let body = Body::from_inertia([[1.0, 0.1, 0.0], [0.1, 1.5, 0.0], [0.0, 0.0, 2.0]])?;
    /// let motion = Scene::new(body, state).solve()?;
    /// let partials = motion.inertia_partials(10.0)?;
    /// // A common factor of the tensor has no effect on attitude and rates.
    /// let [i11, i22, i33, i12, ..] = partials.attitude[0][6..] else { unreachable!() };
    /// assert!((i11 + 1.5 * i22 + 2.0 * i33 + 0.1 * i12).abs() < 1e-12);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Motion::partials_into`].
    pub fn inertia_partials(&self, time: f64) -> Result<Partials<INERTIA_PARAMETERS>, Error> {
        let zero = [[0.0; INERTIA_PARAMETERS]; 3];
        let (mut attitude, mut rates) = ([zero], [zero]);
        self.batch().inertia_partials_into(&[time], &mut attitude, &mut rates)?;
        Ok(Partials { time, attitude: attitude[0], angular_velocity: rates[0] })
    }

    /// Computes the derivatives with respect to the tensor for times counted from `epoch`.
    fn inertia_partials_since(
        &self,
        epoch: f64,
        times: &[f64],
        attitudes: &mut [Derivatives<INERTIA_PARAMETERS>],
        rates: &mut [Derivatives<INERTIA_PARAMETERS>],
    ) -> Result<(), Error> {
        self.valid(times, epoch)?;
        tensor::fill(self, epoch, times, (attitudes, rates))
    }

    /// Times counted from `epoch` in the scale of the scene.
    fn in_scene(&self, epoch: f64, times: &[f64]) -> Vec<f64> {
        let start = self.scene.state().epoch - epoch;
        times.iter().map(|time| start + time).collect()
    }

    /// Attitudes and rates about the principal axes at times counted from `epoch`.
    fn samples_about_principal_axes(&self, epoch: f64, times: &[f64]) -> Result<AttitudesAndRates, Error> {
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; times.len()], vec![[0.0; 3]; times.len()]);
        let batch = self.batch();
        let batch = if epoch == batch.epoch() { batch } else { batch.since_epoch() };
        batch.about_principal_axes(times, &mut attitudes, &mut rates)?;
        Ok((attitudes, rates))
    }

    /// Computes the derivatives for times counted from `epoch`.
    fn partials_since(
        &self,
        epoch: f64,
        times: &[f64],
        attitudes: &mut [Derivatives],
        rates: &mut [Derivatives],
    ) -> Result<(), Error> {
        self.valid(times, epoch)?;
        self.partials_about_principal_axes(epoch, times, attitudes, rates)?;
        if let Some(given) = &self.given {
            let axes = given.turn.to_rotation_matrix().into_inner();
            attitudes.iter_mut().chain(rates).for_each(|derivatives| turn(&axes, derivatives));
        }
        Ok(())
    }

    fn partials_about_principal_axes(
        &self,
        epoch: f64,
        times: &[f64],
        attitudes: &mut [Derivatives],
        rates: &mut [Derivatives],
    ) -> Result<(), Error> {
        let Some(polhode) = Polhode::of(&self.scene) else {
            steady::at_rest(times, epoch, attitudes, rates);
            return Ok(());
        };
        let mode = self.plan.mode();
        let setting = Setting::new(&polhode, self.scene.body().moments());
        let target = Target { times, epoch, initial: self.scene.state().attitude, setting: &setting };
        match &self.trajectory {
            _ if mode == Mode::Separatrix => Err(Error::SeparatrixPartials),
            Trajectory::Steady(steady) => {
                let varied = Varied::new(&polhode, &setting, mode);
                varied.valid(self, epoch, times)?;
                target.fill(&Steadily { steady, varied: &varied }, attitudes, rates);
                Ok(())
            }
            _ if polhode.has_small_divisor(false) => expansion::fill(self, &polhode, target, (attitudes, rates)),
            _ => target.wobbling(self, &polhode, (attitudes, rates)),
        }
    }
}

/// Number of times between two checks of the flag that ends a call.
const AT_ONCE: usize = 1 << 13;

impl Batch<'_> {
    /// Writes the derivatives of attitude and angular velocity, as [`Motion::partials_into`] does.
    ///
    /// # Errors
    /// The errors of [`Motion::partials_into`], and [`Error::Stopped`] if the flag is set.
    pub fn partials_into(
        &self,
        times: &[f64],
        attitudes: &mut [Derivatives],
        rates: &mut [Derivatives],
    ) -> Result<(), Error> {
        #[cfg(feature = "torques")]
        if self.motion().varies_under_torques(&Parameter::STATE_AND_BODY) {
            return self.forced_matrices(times, attitudes, rates);
        }
        let part = |times: &[f64], attitudes: &mut [_], rates: &mut [_]| {
            self.motion().partials_since(self.epoch(), times, attitudes, rates)
        };
        self.in_parts(times, attitudes, rates, part)
    }

    /// Writes the derivatives with respect to the elements of the inertia tensor, as [`Motion::inertia_partials`] does.
    ///
    /// # Errors
    /// The errors of [`Batch::partials_into`].
    pub fn inertia_partials_into(
        &self,
        times: &[f64],
        attitudes: &mut [Derivatives<INERTIA_PARAMETERS>],
        rates: &mut [Derivatives<INERTIA_PARAMETERS>],
    ) -> Result<(), Error> {
        #[cfg(feature = "torques")]
        if self.motion().varies_under_torques(&Parameter::STATE_AND_BODY) {
            return self.forced_matrices(times, attitudes, rates);
        }
        let part = |times: &[f64], attitudes: &mut [_], rates: &mut [_]| {
            self.motion().inertia_partials_since(self.epoch(), times, attitudes, rates)
        };
        self.in_parts(times, attitudes, rates, part)
    }

    fn in_parts<const N: usize>(
        &self,
        times: &[f64],
        attitudes: &mut [Derivatives<N>],
        rates: &mut [Derivatives<N>],
        fill: impl Fn(&[f64], &mut [Derivatives<N>], &mut [Derivatives<N>]) -> Result<(), Error>,
    ) -> Result<(), Error> {
        length("attitudes", attitudes.len(), times.len())?;
        length("rates", rates.len(), times.len())?;
        let parts = times.chunks(AT_ONCE).zip(attitudes.chunks_mut(AT_ONCE)).zip(rates.chunks_mut(AT_ONCE));
        for (index, ((times, attitudes), rates)) in parts.enumerate() {
            self.going()?;
            fill(times, attitudes, rates).map_err(|problem| problem.later(index * AT_ONCE))?;
        }
        Ok(())
    }
}

/// Transforms derivatives from the principal axes to the user's: the vector, and the parameters that are vectors.
fn turn(axes: &Matrix3<f64>, derivatives: &mut Derivatives) {
    let matrix = SMatrix::<f64, 3, PARAMETERS>::from_fn(|row, column| derivatives[row][column]);
    let mut turned = axes * matrix;
    for first in [0, 3] {
        let block = turned.fixed_columns::<3>(first) * axes.transpose();
        turned.fixed_columns_mut::<3>(first).copy_from(&block);
    }
    for (row, values) in derivatives.iter_mut().enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            *value = turned[(row, column)];
        }
    }
}
