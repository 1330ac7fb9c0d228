//! Copies and pickles of a motion.

use pyo3::prelude::*;

use super::Motion;
use crate::scene_class::Scene;
use crate::values::immutable;

immutable!(Motion);

#[pymethods]
impl Motion {
    /// A motion is pickled as its scene and solved again on loading, without a `ToleranceWarning`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Scene,))> {
        Ok((py.get_type::<Self>().getattr("_restored")?, (self.scene(),)))
    }

    #[staticmethod]
    fn _restored(py: Python<'_>, scene: PyRef<'_, Scene>) -> PyResult<Self> {
        scene.solved(py).map(|motion| Self(motion, scene.calendar))
    }
}
