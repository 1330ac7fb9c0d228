//! `andoyer.cassini_states`.

use andoyer_propagate::disturbers;
use andoyer_series::error::Short;
use pyo3::prelude::*;

use crate::array::number;
use crate::body::Body;
use crate::error;
use crate::orbit::Orbit;

/// A Cassini state, from `cassini_states`.
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct CassiniState(disturbers::CassiniState);

#[pymethods]
impl CassiniState {
    /// θ, the angle from the normal of the orbit to the pole of the body [rad], in (−π, π]: positive away from inertial axis 3, in the plane of both.
    #[getter]
    fn obliquity(&self) -> f64 {
        self.0.obliquity
    }

    /// Whether nearby poles stay near.
    #[getter]
    fn stable(&self) -> bool {
        self.0.stable
    }

    /// Frequency of small librations about a stable state, or the rate at which poles leave an unstable one [rad/time].
    #[getter]
    fn rate(&self) -> f64 {
        self.0.rate
    }

    /// p, the number of rotations an orbit if the body is in a spin–orbit resonance, otherwise None.
    #[getter]
    fn resonance(&self) -> Option<f64> {
        self.0.resonance
    }

    fn __repr__(&self) -> String {
        let kind = if self.0.stable { "stable" } else { "unstable" };
        let locked = self.0.resonance.map(|p| format!(", resonance {p}")).unwrap_or_default();
        format!(
            "<CassiniState, {kind}{locked}, obliquity {} rad, rate {:.3e}>",
            Short::rounded(self.0.obliquity, 6),
            self.0.rate
        )
    }
}

/// The Cassini states of a body: places of its pole that turn with the node of a precessing orbit (theory, section 9).
///
/// The body rotates about its axis of greatest inertia, either much faster than its orbit or in a spin–orbit resonance, with p rotations an orbit, where 2p is
/// a whole number up to 4096. It is taken to be in resonance if its spin rate differs from the resonant one by less than the largest rate of a libration in
/// longitude at the obliquity 0; the states then say so. At the obliquity θ the resonance is narrower by (1 + cos θ)/2. Four states exist if the node is slow
/// compared with the precession of the pole, otherwise two.
///
/// Parameters
/// ----------
/// body : Body
/// orbit : Orbit
///     With a `node_rate`; its inclination is the angle between the normal of the orbit and inertial axis 3.
/// spin_rate : float
///     Rate of rotation of the body [rad/time].
///
/// Returns
/// -------
/// list of CassiniState
///     In the order of the obliquities.
///
/// Raises
/// ------
/// InputError
///     An orbit with a node rate of 0, or a spin rate that is not positive and finite.
///
/// Examples
/// --------
/// >>> orbit = Orbit(0.02, inclination=0.2, node_rate=-1e-5)
/// >>> states = cassini_states(Body([0.9, 0.9, 1.0]), orbit, 1.0)
/// >>> [state.stable for state in states], round(states[1].obliquity, 6)
/// ([True, True, False, True], 0.039592)
#[pyfunction]
pub(crate) fn cassini_states(
    body: &Bound<'_, Body>,
    orbit: &Bound<'_, Orbit>,
    spin_rate: &Bound<'_, PyAny>,
) -> PyResult<Vec<CassiniState>> {
    let spin_rate = number("spin_rate", spin_rate)?;
    let states = disturbers::cassini_states(&body.get().body, &orbit.get().0, spin_rate).map_err(error::propagation)?;
    Ok(states.into_iter().map(CassiniState).collect())
}
