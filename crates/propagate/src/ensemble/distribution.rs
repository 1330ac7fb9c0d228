//! What the members of an ensemble are at one time: how they would tumble on without a torque.

use crate::error::Error;
use crate::input::options::Convention;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::solved::{Motion, Periods};
use crate::outcome::Outcome;
use crate::torque_free::mode::Mode;

use super::run::MembersRun;

/// The free motion from the state of a member at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TumblingMember {
    /// None for a member that has no motion at the time.
    pub mode: Option<Mode>,
    /// Whether the mode is another one than that of the state at the epoch.
    pub has_changed: bool,
    /// Mean periods in the conventions of [`Convention::ALL`] \[unit of time\].
    pub periods: [Periods; 3],
    /// E/E0, as [`Motion::energy_ratio`].
    pub energy_ratio: f64,
    /// The angular momentum in inertial components \[unit of moment × rate\].
    pub angular_momentum: [f64; 3],
}

impl TumblingMember {
    /// Of a member without a motion.
    const NONE: Self = Self {
        mode: None,
        has_changed: false,
        periods: [Periods { precession: f64::NAN, rotation: f64::NAN }; 3],
        energy_ratio: f64::NAN,
        angular_momentum: [f64::NAN; 3],
    };
}

impl MembersRun<'_> {
    /// How every member tumbles at a time: the free motion from its state then.
    ///
    /// ```
    /// use andoyer_propagate::{Ensemble, Mode};
    /// use andoyer_propagate::torques::Torque;
    /// let (moments, level) = (vec![[1.0, 1.5, 2.0]; 2], vec![[0.0, 0.0, 0.0, 1.0]; 2]);
    /// let ensemble = Ensemble::new(moments, level, vec![[0.1, 0.2, 1.0], [1.0, 0.2, 0.1]])?.span(0.0, 100.0);
    /// let (braked, _) = ensemble.torques([Torque::damping([[0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]])?]).run().after(100.0)?;
    /// assert_eq!(braked.iter().map(|member| member.mode).collect::<Vec<_>>(), [Some(Mode::ShortAxis), Some(Mode::LongAxis)]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`MembersRun::attitudes_into`].
    pub fn after(&self, time: f64) -> Result<(Vec<TumblingMember>, Outcome), Error> {
        let mut members = vec![TumblingMember::NONE; self.ensemble.len()];
        let outcome = self.values_into(&mut members, TumblingMember::NONE, |motion| self.tumbling(motion, time))?;
        Ok((members, outcome))
    }

    fn tumbling(&self, motion: &Motion, time: f64) -> Result<TumblingMember, Error> {
        let (mut attitude, mut rates) = ([[0.0; 4]], [[0.0; 3]]);
        self.batch(motion).samples_into(&[time], &mut attitude, &mut rates)?;
        let state = State::new(0.0, attitude[0], rates[0])?;
        let free = Scene::new(motion.scene().body().clone(), state).solve()?;
        Ok(TumblingMember {
            mode: Some(free.plan().mode()),
            has_changed: free.plan().mode() != motion.plan().mode(),
            periods: Convention::ALL.map(|convention| free.periods_of(convention)),
            energy_ratio: free.energy_ratio(),
            angular_momentum: free.angular_momentum().into(),
        })
    }
}
