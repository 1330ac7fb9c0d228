//! What the benchmarks share. Ids are `task/order-N/engine`; each closure asserts its answer.

use andoyer_propagate::{Body, Scene, State};

/// A triaxial body (β = ½) at σ/σ_sep = 0.34, where a tolerance of 1e-12 takes order 25.
///
/// # Panics
/// Never: the numbers are those of a scene.
pub fn triaxial() -> Scene {
    let body = Body::new([0.5, 0.75, 1.0]).expect("a body");
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.4, 0.6, 0.9]).expect("a state");
    Scene::new(body, state)
}
