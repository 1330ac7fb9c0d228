//! Copies and pickles of a motion.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Ensemble;
use andoyer_propagate::ensemble::OnError;
use pyo3::prelude::*;

use super::Motion;
use crate::computing::interruptible;
use crate::error;
use crate::scene_class::Scene;
use crate::values::immutable;

immutable!(Motion);

#[pymethods]
impl Motion {
    /// A motion is pickled as its scene and solved again on loading, without a `ToleranceWarning`. That of a member that is not served over its whole span is solved as a member.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Scene, bool))> {
        Ok((py.get_type::<Self>().getattr("_restored")?, (self.scene(), self.0.plan().known().is_some())))
    }

    #[staticmethod]
    #[pyo3(signature = (scene, while_known=false))]
    fn _restored(py: Python<'_>, scene: PyRef<'_, Scene>, while_known: bool) -> PyResult<Self> {
        if !while_known {
            return scene.solved(py).map(|motion| Self(motion, scene.calendar));
        }
        let (given, calendar) = (scene.scene.clone(), scene.calendar);
        let alone = |_: &AtomicBool| Ensemble::from_scenes(vec![Ok(given)], OnError::Nan)?.motion(0);
        interruptible(py, true, error::propagation, alone).map(|motion| Self(motion, calendar))
    }
}
