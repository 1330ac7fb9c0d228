//! The scene of a later state of a motion.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::State;
use pyo3::prelude::*;

use super::Motion;
use crate::computing::interruptible;
use crate::foreign;
use crate::scene_class::Scene;
use crate::{array, error};

#[pymethods]
impl Motion {
    /// The scene of the state at a time: the same body, disturbing bodies and options, with this time as the epoch.
    ///
    /// After a torque, the motion of this scene has the periods of that time. The span stays.
    ///
    /// Parameters
    /// ----------
    /// time : float, Time or TimeDelta
    ///     The time, in the unit of time of the scene.
    ///
    /// Returns
    /// -------
    /// Scene
    ///     If the epoch of this scene is a Time, so is that of the result.
    ///
    /// Raises
    /// ------
    /// RepresentationError, InputError
    ///     A time that the motion does not reach, as for the other methods.
    /// TypeError
    ///     An array of times.
    ///
    /// Examples
    /// --------
    /// >>> sun = Orbit(2e-3, 0.1, inclination=0.4)
    /// >>> scene = Scene(Body([1, 1.02, 1.05]), [0, 0, 0, 1], [0, 0.1, 1], orbit=sun, tolerance=1e-5, span=(0, 1e4))
    /// >>> later = scene.solve().scene_at(1e4)
    /// >>> later.epoch, later.orbit == sun
    /// (10000.0, True)
    /// >>> free = Scene(later.body, later.attitude, later.angular_velocity, epoch=later.epoch)
    /// >>> free.solve().periods["short-axis"] == scene.solve().periods["short-axis"]
    /// False
    fn scene_at(&self, py: Python<'_>, time: &Bound<'_, PyAny>) -> PyResult<Scene> {
        let times = self.times(time)?;
        let since_epoch = times.since_epoch();
        let &[time] = times.values()? else { return Err(times.scalar("time")) };
        let (mut attitude, mut rates) = ([[0.0; 4]], [[0.0; 3]]);
        let evaluate =
            |stop: &AtomicBool| self.batch(since_epoch, stop).samples_into(&[time], &mut attitude, &mut rates);
        interruptible(py, times.long(), error::propagation, evaluate)?;
        let scene = self.0.scene();
        let (epoch, calendar) = match self.1 {
            None if since_epoch => (scene.state().epoch + time, None),
            None => (time, None),
            Some(epoch) => {
                let (seconds, calendar) = foreign::later(py, epoch, since_epoch, time)?;
                (array::number("epoch", &seconds)?, calendar.first().copied())
            }
        };
        let state = State::new(epoch, attitude[0], rates[0]).map_err(error::propagation)?;
        Ok(Scene { calendar, ..scene.with_state(state).into() })
    }
}
