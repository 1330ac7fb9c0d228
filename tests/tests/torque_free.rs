//! Torque-free motion against solutions in multiple precision (tests/data/README.md).

use andoyer_propagate::{Body, Error, Mode, Motion, Scene, State};
use andoyer_tests::{Case, attitude_error, cases, difference};

const REFERENCE: &str = include_str!("../data/torque_free.json");
/// What the series don't serve: long-axis modes and motions too near the separatrix.
const REFUSED: [&str; 6] =
    ["near-separatrix-1e-2", "near-separatrix-1e-6", "near-separatrix-1e-10", "long-axis", "prolate", "axis-2"];

fn scene(case: &Case) -> Scene {
    let body = Body::new(case.moments).expect("moments of a body");
    let state = State::new(0.0, case.attitude, case.angular_velocity).expect("a state");
    Scene::new(body, state)
}

fn solve(case: &Case) -> Result<Motion, Error> {
    scene(case).tolerance(1e-12).solve()
}

#[test]
fn short_axis_motions_hold_the_reference_over_ten_thousand_rotations() {
    let mut served = 0;
    for case in cases(REFERENCE).iter().filter(|case| !REFUSED.contains(&case.name.as_str())) {
        let motion = solve(case).unwrap_or_else(|error| panic!("{}: {error}", case.name));
        for &(time, attitude, rates) in case.states.iter().filter(|state| state.0 <= 62831.9) {
            let sample = motion.at(time).expect("a finite time");
            let bound = 1e-11 + 1e-15 * time;
            let error = attitude_error(sample.attitude.coords.into(), attitude);
            assert!(error <= bound, "{} at {time}: attitude off by {error}", case.name);
            let error = difference(sample.angular_velocity.into(), rates);
            assert!(error <= bound, "{} at {time}: rates off by {error}", case.name);
        }
        served += 1;
    }
    assert_eq!(served, 10);
}

#[test]
fn phases_last_for_a_thousand_million_rotations() {
    // Budget: tolerance 1e-12 for the series; frequencies and phases in double-double add 1e-22 a rotation.
    for case in cases(REFERENCE).iter().filter(|case| !REFUSED.contains(&case.name.as_str())) {
        let motion = solve(case).expect("served");
        for &(time, attitude, _) in &case.states {
            let error = attitude_error(motion.at(time).expect("finite").attitude.coords.into(), attitude);
            assert!(error <= 1e-12, "{} at {time}: attitude off by {error}", case.name);
        }
    }
}

#[test]
fn error_bound_covers_the_error_of_every_reference_state() {
    for case in cases(REFERENCE).iter().filter(|case| !REFUSED.contains(&case.name.as_str())) {
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
            let Ok(motion) = scene(case).tolerance(tolerance).solve() else { continue };
            for &(time, attitude, _) in &case.states {
                let error = attitude_error(motion.at(time).expect("finite").attitude.coords.into(), attitude);
                let bound = motion.plan().error_bound();
                assert!(error <= bound, "{} to {tolerance} at {time}: {error} above the bound {bound}", case.name);
                // Rounding: 2.5e-15 and an eighth of it for each harmonic, which are 33 at most here.
                assert!(bound <= tolerance + 1.3e-14, "{} to {tolerance}: bound {bound}", case.name);
            }
        }
    }
}

#[test]
fn what_the_series_do_not_serve_is_a_typed_error_with_its_numbers() {
    let all = cases(REFERENCE);
    let error = |name: &str| {
        let case = all.iter().find(|case| case.name == name).expect("in the file");
        solve(case).expect_err(name)
    };
    for name in ["near-separatrix-1e-2", "near-separatrix-1e-6", "near-separatrix-1e-10"] {
        let Error::NearSeparatrix { ratio, tolerance, attainable } = error(name) else { panic!("{name}") };
        assert!(
            (0.98..1.0).contains(&ratio) && tolerance == 1e-12 && attainable > 1e-2,
            "{name}: {ratio} {attainable}"
        );
    }
    assert!(matches!(error("axis-2"), Error::Separatrix));
    for (name, expected) in [("long-axis", 2.0741), ("prolate", f64::INFINITY)] {
        let Error::LongAxisMode { energy_ratio } = error(name) else { panic!("{name}") };
        assert!(energy_ratio == expected || (energy_ratio - expected).abs() < 1e-4, "{name}: {energy_ratio}");
    }
}

#[test]
fn plans_name_the_kind_of_motion() {
    let all = cases(REFERENCE);
    let mode = |name: &str| {
        let case = all.iter().find(|case| case.name == name).expect("in the file");
        solve(case).expect("served").plan().mode()
    };
    assert_eq!(mode("eros"), Mode::ShortAxis);
    assert_eq!(mode("retrograde"), Mode::ShortAxis);
    assert_eq!(mode("oblate"), Mode::Axisymmetric);
    assert_eq!(mode("sphere"), Mode::Spherical);
    assert_eq!(mode("axis-3"), Mode::PrincipalAxis);
}
