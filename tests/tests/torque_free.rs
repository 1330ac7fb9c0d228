//! Torque-free motion against solutions in multiple precision (tests/data/README.md).

use andoyer_propagate::{Body, Error, Method, Mode, Motion, Scene, State};
use andoyer_tests::{Case, attitude_error, cases, difference};

const REFERENCE: &str = include_str!("../data/torque_free.json");
/// What the series don't serve at 1e-12: the separatrix and its neighbourhood.
const CLOSED_ONLY: [&str; 3] = ["near-separatrix-1e-2", "near-separatrix-1e-6", "near-separatrix-1e-10"];
/// Budget: 2.5e-15 of rounding, and 3e-16 for each harmonic, which are 33 at most here; for the rates, of size 1, likewise.
const ROUNDING: f64 = 1.3e-14;

fn scene(case: &Case) -> Scene {
    let body = Body::new(case.moments).expect("moments of a body");
    let state = State::new(0.0, case.attitude, case.angular_velocity).expect("a state");
    Scene::new(body, state).tolerance(1e-13)
}

/// Largest errors of attitude and rates over the states of a case.
fn errors(motion: &Motion, case: &Case) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    for &(time, attitude, rates) in &case.states {
        let sample = motion.at(time).expect("a finite time");
        worst[0] = worst[0].max(attitude_error(sample.attitude.coords.into(), attitude));
        worst[1] = worst[1].max(difference(sample.angular_velocity.into(), rates));
    }
    worst
}

#[test]
fn every_reference_motion_holds_for_a_thousand_million_rotations() {
    let cases = cases(REFERENCE);
    for case in &cases {
        let motion = scene(case).solve().unwrap_or_else(|error| panic!("{}: {error}", case.name));
        assert_eq!(motion.plan().method(), Method::Closed, "{}", case.name);
        let [attitude, rates] = errors(&motion, case);
        assert!(attitude <= ROUNDING, "{}: attitude off by {attitude}", case.name);
        assert!(rates <= ROUNDING, "{}: rates off by {rates}", case.name);
    }
    assert_eq!(cases.len(), 16);
}

#[test]
fn the_series_holds_every_reference_motion_away_from_the_separatrix() {
    for case in cases(REFERENCE).iter().filter(|case| !CLOSED_ONLY.contains(&case.name.as_str())) {
        let motion = scene(case).method(Method::Series).solve().unwrap_or_else(|e| panic!("{}: {e}", case.name));
        let [attitude, rates] = errors(&motion, case);
        assert!(attitude <= 1e-13 + ROUNDING, "{}: attitude off by {attitude}", case.name);
        assert!(rates <= 1e-13 + ROUNDING, "{}: rates off by {rates}", case.name);
    }
}

#[test]
fn error_bound_covers_the_error_of_every_reference_state() {
    for case in &cases(REFERENCE) {
        for method in [Method::Series, Method::Closed] {
            for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
                let motion = match scene(case).tolerance(tolerance).method(method).solve() {
                    Ok(motion) => motion,
                    Err(Error::NearSeparatrix { .. }) if method == Method::Series => continue,
                    Err(error) => panic!("{} to {tolerance} by {method}: {error}", case.name),
                };
                let ([error, _], bound) = (errors(&motion, case), motion.plan().error_bound());
                assert!(error <= bound, "{} to {tolerance}: {error} above the bound {bound}", case.name);
                // Next to the separatrix the bound has what the error of Q1 makes of the phase over 1e9 rotations.
                let conditioning = if case.name == "near-separatrix-1e-10" { 1e-11 } else { 0.0 };
                let most = tolerance + 2.0 * ROUNDING + conditioning;
                assert!(bound <= most, "{} to {tolerance} by {method}: bound {bound}", case.name);
            }
        }
    }
}

#[test]
fn the_series_too_near_the_separatrix_is_a_typed_error_with_its_numbers() {
    let all = cases(REFERENCE);
    for name in CLOSED_ONLY {
        let case = all.iter().find(|case| case.name == name).expect("in the file");
        let error = scene(case).tolerance(1e-12).method(Method::Series).solve().expect_err(name);
        let Error::NearSeparatrix { ratio, tolerance, attainable, .. } = error else { panic!("{name}") };
        assert!(
            (0.98..1.0).contains(&ratio) && tolerance == 1e-12 && attainable > 1e-2,
            "{name}: {ratio} {attainable}"
        );
    }
}

#[test]
fn plans_name_the_kind_of_motion() {
    let all = cases(REFERENCE);
    let mode = |name: &str| {
        let case = all.iter().find(|case| case.name == name).expect("in the file");
        scene(case).solve().expect("served").plan().mode()
    };
    assert_eq!(mode("eros"), Mode::ShortAxis);
    assert_eq!(mode("retrograde"), Mode::ShortAxis);
    assert_eq!(mode("near-separatrix-1e-10"), Mode::ShortAxis);
    assert_eq!(mode("long-axis"), Mode::LongAxis);
    assert_eq!(mode("oblate"), Mode::Axisymmetric);
    assert_eq!(mode("prolate"), Mode::Axisymmetric);
    assert_eq!(mode("sphere"), Mode::Spherical);
    assert_eq!(mode("axis-3"), Mode::PrincipalAxis);
    assert_eq!(mode("axis-2"), Mode::PrincipalAxis);
}
