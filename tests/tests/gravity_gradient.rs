//! Rotation under the gravity gradient against a numerical integration of the full equations in 80-bit reals (tests/data/README.md).

use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::{Body, Error, Motion, Orbit, Scene, State};
use andoyer_tests::{Case, attitude_error, cases, difference, orbits};

const REFERENCE: &str = include_str!("../data/gravity_gradient.json");

fn free(case: &Case) -> Scene {
    let body = Body::new(case.moments).expect("a body");
    Scene::new(body, State::new(0.0, case.attitude, case.angular_velocity).expect("a state"))
}

fn attitude(motion: &Motion, time: f64) -> [f64; 4] {
    motion.at(time).expect("a finite time").attitude.coords.into()
}

fn worst(motion: &Motion, case: &Case) -> f64 {
    let errors = case.states.iter().map(|&(time, reference, _)| attitude_error(attitude(motion, time), reference));
    errors.fold(0.0, f64::max)
}

/// Largest distance to the truth over that of the free solution.
fn share(case: &Case, orbit: &Orbit, level: Level, averaging: Averaging) -> f64 {
    let motion = free(case).orbit(*orbit).level(level).averaging(averaging).solve().expect("solved");
    worst(&motion, case) / worst(&free(case).solve().expect("solved"), case)
}

#[test]
fn the_full_level_explains_all_but_a_ten_thousandth_of_the_torques_effect() {
    for (case, orbit) in cases(REFERENCE).iter().zip(orbits(REFERENCE)) {
        let [paper, moving, full] =
            [Level::Paper, Level::Moving, Level::Full].map(|level| share(case, &orbit, level, Averaging::Spin));
        let shares = format!("{}: paper {paper:.1e}, moving {moving:.1e}, full {full:.1e}", case.name);
        let bound = if case.name == "fast-orbit" { 1e-4 } else { 1e-6 };
        assert!(full <= bound, "{shares}");
        assert!(moving <= 1.01 * paper && full <= 1.01 * moving, "{shares}");
    }
}

#[test]
fn rates_are_those_of_the_integration_and_of_the_angular_momentum() {
    for (case, orbit) in cases(REFERENCE).iter().zip(orbits(REFERENCE)) {
        let motion = free(case).orbit(orbit).solve().expect("solved");
        let free_motion = free(case).solve().expect("solved");
        // A phase that is late by an angle changes rates of size 1 by as much.
        let effect = worst(&free_motion, case);
        let mut error = 0.0_f64;
        for &(time, _, rates) in &case.states {
            let sample = motion.at(time).expect("finite");
            error = error.max(difference(sample.angular_velocity.into(), rates));
            let mut momentum = [[0.0; 3]];
            motion.angular_momenta_into(&[time], &mut momentum).expect("finite");
            let body: [f64; 3] = std::array::from_fn(|i| case.moments[i] * sample.angular_velocity[i]);
            let turned: [f64; 3] = (sample.attitude * andoyer_propagate::nalgebra::Vector3::from(body)).into();
            assert!(difference(turned, momentum[0]) < 1e-14);
        }
        assert!(error <= 1e-4 * effect, "{}: {error:e} of {effect:e}", case.name);
    }
}

#[test]
fn a_synchronous_body_is_in_resonance_and_the_error_names_it() {
    let scene = free(&cases(REFERENCE)[0]);
    let error = scene.orbit(Orbit::new(1.0, 0.0).expect("an orbit")).solve().expect_err("synchronous");
    assert!(matches!(error, Error::Resonance { .. }), "{error}");
}
