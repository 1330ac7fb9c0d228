//! Many times at once.

use pulp::Arch;

use super::solved::{Motion, length};
use super::trajectory::Evaluation;
use crate::error::Error;
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
}

impl<'a> Batch<'a> {
    pub(crate) fn new(motion: &'a Motion) -> Self {
        Self { motion, threads: usize::MAX }
    }

    /// On at most so many threads of rayon's pool; few times take one in any case. 0 is taken as 1.
    #[must_use]
    pub fn threads(self, most: usize) -> Self {
        Self { threads: most, ..self }
    }

    /// Attitudes [x, y, z, w].
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn attitudes_into(&self, times: &[f64], out: &mut [[f64; 4]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        self.fill(times, Outputs::Attitudes(out))?;
        self.turn(out, &mut []);
        Ok(())
    }

    /// Angular velocities, body components [rad per unit of time].
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn angular_velocities_into(&self, times: &[f64], out: &mut [[f64; 3]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        self.fill(times, Outputs::Rates(out))?;
        self.turn(&mut [], out);
        Ok(())
    }

    /// Both.
    ///
    /// # Errors
    /// As [`Motion::attitudes_into`].
    pub fn samples_into(&self, times: &[f64], attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) -> Result<(), Error> {
        length("attitudes", attitudes.len(), times.len())?;
        length("rates", rates.len(), times.len())?;
        self.about_principal_axes(times, attitudes, rates)?;
        self.turn(attitudes, rates);
        Ok(())
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

    /// To the user's axes.
    fn turn(&self, attitudes: &mut [[f64; 4]], rates: &mut [[f64; 3]]) {
        if let Some(given) = &self.motion.given {
            given.turn(attitudes, rates);
        }
    }

    fn fill(&self, times: &[f64], outputs: Outputs<'_>) -> Result<(), Error> {
        let Self { motion, threads } = *self;
        let epoch = motion.scene.state().epoch;
        let evaluation = Evaluation { trajectory: &motion.trajectory, epoch, bound: motion.bound(), arch: Arch::new() };
        evaluation.fill(times, outputs, threads).map_err(|index| motion.no_phase(index, times))
    }
}

impl Motion {
    /// How many times at once are evaluated: on as many threads as pay, unless told otherwise.
    pub fn batch(&self) -> Batch<'_> {
        Batch::new(self)
    }
}
