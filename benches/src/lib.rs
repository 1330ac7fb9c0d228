//! What the benchmarks share. Ids are `task/order-N/engine`; each closure asserts its answer.

use andoyer_propagate::{Body, Orbit, Scene, State};

/// A triaxial body (β = ½) at σ/σ_sep = 0.34, where a tolerance of 1e-12 takes order 25.
///
/// # Panics
/// Never: the numbers are those of a scene.
pub fn triaxial() -> Scene {
    let body = Body::new([0.5, 0.75, 1.0]).expect("a body");
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.4, 0.6, 0.9]).expect("a state");
    Scene::new(body, state)
}

/// A body wobbling by 0.02 rad (moments 1, 1.02, 1.05) under the gravity gradient of one that goes around 500 times more slowly, over 1,000 rotations.
///
/// # Panics
/// For an eccentricity below 0, or of 1 and more.
pub fn disturbed(eccentricity: f64) -> Scene {
    let body = Body::new([1.0, 1.02, 1.05]).expect("a body");
    let (half_sine, half_cosine) = (0.2_f64).sin_cos();
    let state = State::new(0.0, [half_sine, 0.0, 0.0, half_cosine], [0.006, 0.02, 1.0]).expect("a state");
    let orbit = Orbit::new(2e-3, eccentricity).expect("an ellipse");
    Scene::new(body, state).orbit(orbit).span(0.0, 1000.0 * std::f64::consts::TAU)
}
