//! What the benchmarks share. Ids are `task/size/engine`; each closure asserts its answer.

use std::f64::consts::FRAC_PI_2;

use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3};
use andoyer_propagate::{Body, Method, Orbit, Scene, State};
use andoyer_series::periodic::{DrivenHamiltonian, SampledHamiltonian};
use andoyer_series::{Error, Monomial};

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
    Scene::new(body, state).orbit(orbit).span(0.0, 1000.0 * std::f64::consts::TAU).method(Method::Closed)
}

/// A body that keeps its face over 1,000 orbits, with amplitudes of `degrees` in longitude and 0.6 and 0.5 of that of its pole: a triaxial body (moments 0.55, 0.8, 1) on a
/// circle, the Moon's moments on an ellipse.
///
/// # Panics
/// For an eccentricity below 0, or of 1 and more.
pub fn locked(eccentricity: f64, degrees: f64) -> Scene {
    let moments = if eccentricity > 0.0 { [0.99948, 0.999772, 1.0] } else { [0.55, 0.8, 1.0] };
    let [psi, theta, phi] = [1.0, 0.6, 0.5].map(|share| share * degrees.to_radians());
    let attitude = UnitQuaternion::from_euler_angles(phi, theta, psi);
    let rates = attitude.inverse() * Vector3::z();
    let state = State::new(0.0, attitude.coords.into(), rates.into()).expect("a state");
    let orbit = Orbit::new(1.0, eccentricity).expect("an ellipse");
    let scene = Scene::new(Body::new(moments).expect("a body"), state).orbit(orbit);
    scene.span(0.0, 1000.0 * std::f64::consts::TAU).tolerance(1e-9).method(Method::Libration)
}

/// Bodies of many shapes: 1/16 ≤ β ≤ 15/16, C/A up to 3.
///
/// # Panics
/// Never: all of them satisfy the triangle inequality.
pub fn bodies() -> Vec<Body> {
    let shape = |k: usize| {
        let (flat, middle) = ((k % 8) as f64 / 8.0, (1 + k / 8) as f64 / 9.0);
        let least = 0.36 + 0.6 * flat;
        let between = 1.0 - least;
        // Between 1 − A, the triangle inequality, and C.
        let lowest = between.max(least);
        [least, lowest + (1.0 - lowest) * middle, 1.0]
    };
    (0..64).map(|k| Body::new(shape(k)).expect("a body")).collect()
}

/// A motion of a body with σ/σ_sep somewhat below `ratio`, at most 1.
///
/// # Panics
/// Never: the numbers are those of a scene.
pub fn wobbling(body: &Body, ratio: f64) -> Scene {
    let [least, middle, greatest] = body.moments();
    let (first, second) = ((greatest - least) / least, (greatest - middle) / middle);
    // γE = (C/A−1) g1² + (C/B−1) g2² as a share of its value on the separatrix, C/B−1 (theory §5, §7). It is concave in σ, and so σ/σ_sep is below the share.
    let (g1, g2) = ((0.5 * ratio * second / first).sqrt(), (0.5 * ratio).sqrt());
    let rates = [g1 / least, g2 / middle, (1.0 - g1 * g1 - g2 * g2).sqrt() / greatest];
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], rates).expect("a state");
    Scene::new(body.clone(), state)
}

/// (B − A)/C of the body whose planar libration [`planar`] is.
pub const SHAPE: f64 = 0.02;

/// p²/2 − (3/4) s (a/ρ)³ cos 2(ψ + M − f) about ψ = 0, p = 1, to a degree in ψ.
///
/// # Panics
/// For an eccentricity below 0, or of 1 and more.
pub fn planar(eccentricity: f64, degree: u32) -> impl DrivenHamiltonian {
    let orbit = Orbit::new(1.0, eccentricity).and_then(|orbit| orbit.semi_major_axis(1.0)).expect("an ellipse");
    SampledHamiltonian::new(1, move |phases: &[f64]| {
        let [x, y, _] = orbit.position(phases[0]).expect("a time");
        let (cube, angle) = (x.hypot(y).powi(-3), 2.0 * (phases[0] - y.atan2(x)));
        let mut factor = 1.0;
        let slopes = (1..=degree).map(|k| {
            factor *= 2.0 / f64::from(k);
            // The k-th derivative of the cosine.
            let slope = (angle + f64::from(k) * FRAC_PI_2).cos();
            Ok((Monomial::new(&[k, 0])?, -0.75 * SHAPE * cube * factor * slope))
        });
        std::iter::once(Ok((Monomial::new(&[0, 2])?, 0.5))).chain(slopes).collect::<Result<Vec<_>, Error>>()
    })
}
