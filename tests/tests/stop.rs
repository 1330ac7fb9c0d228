//! A flag ends an evaluation; times since the epoch keep the digits that a large epoch loses; outcomes of ensembles.

use std::sync::atomic::{AtomicBool, Ordering};

use andoyer_propagate::ensemble::OnError;
use andoyer_propagate::torques::Torque;
use andoyer_propagate::{Body, Ensemble, Error, Method, Motion, Orbit, Scene, State, TabulatedOrbit};

fn scene(epoch: f64) -> Scene {
    let state = State::new(epoch, [0.0, 0.0, 0.0, 1.0], [0.0, 0.01, 1.0]).expect("a state");
    Scene::new(Body::new([1.0, 1.02, 1.05]).expect("a body"), state)
}

fn motions() -> [Motion; 3] {
    let orbit = Orbit::new(2e-3, 0.1).expect("an orbit");
    let middle = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 1e-30]).expect("a state");
    let flip = Scene::new(Body::new([1.0, 1.5, 2.0]).expect("a body"), middle);
    [scene(0.0), scene(0.0).orbit(orbit).span(0.0, 1e4), flip].map(|scene| scene.solve().expect("a motion"))
}

#[test]
fn flag_ends_every_evaluation_of_a_motion() {
    let times: Vec<f64> = (0..5000).map(f64::from).collect();
    for motion in motions() {
        let stop = AtomicBool::new(true);
        let (mut four, mut three, mut six) = (vec![[0.0; 4]; 5000], vec![[0.0; 3]; 5000], vec![[0.0; 6]; 5000]);
        for going in [false, true] {
            stop.store(!going, Ordering::Relaxed);
            let batch = motion.batch().until(&stop);
            for ended in [
                batch.attitudes_into(&times, &mut four),
                batch.angular_velocities_into(&times, &mut three),
                batch.samples_into(&times, &mut four, &mut three),
                batch.angular_momenta_into(&times, &mut three),
                batch.andoyer_into(&times, &mut six),
            ] {
                assert_eq!(ended.is_ok(), going);
                assert!(going || matches!(ended, Err(Error::Stopped)));
            }
        }
    }
}

#[test]
fn integrations_of_milliseconds_are_brief() {
    let orbit = Orbit::new(0.4, 0.1).expect("an orbit");
    let integrated = |span: f64| scene(0.0).orbit(orbit).span(0.0, span).method(Method::Integrated);
    let torque = Torque::constant([1e-3, 0.0, 0.0]).expect("a torque");
    let needle = Orbit::new(0.4, 0.999).expect("an orbit");
    assert!(integrated(50.0).is_brief());
    for long in [
        integrated(1e4),                                    // by its rotation
        integrated(50.0).orbit(needle),                     // passages may spin the body up
        integrated(50.0).torques([torque]),                 // so may a torque
        scene(0.0).orbit(orbit).span(0.0, 50.0),            // theory and librations are tried first
        scene(0.0).orbit(orbit).method(Method::Integrated), // no span: refused
    ] {
        assert!(!long.is_brief(), "{long:?}");
    }
}

#[test]
fn flag_that_is_set_from_the_start_ends_integrations_alone() {
    let orbit = |motion: f64| Orbit::new(motion, 0.1).expect("an orbit");
    let stop = AtomicBool::new(true);
    let solved = |scene: &Scene| scene.solve_until(&stop);
    let by_theory = scene(0.0).orbit(orbit(2e-3)).tolerance(1e-6).span(0.0, 1e3);
    for scene in [scene(0.0), by_theory.clone()] {
        let (early, usual) = (solved(&scene).expect("theory"), scene.solve().expect("a motion"));
        assert_eq!(early.at(3.0).expect("a time").attitude, usual.at(3.0).expect("a time").attitude);
        assert_eq!(early.plan().to_string(), usual.plan().to_string());
    }
    // By request; since the theory does not hold; and since the theory misses the tolerance.
    let integrated = [
        by_theory.clone().method(Method::Integrated),
        scene(0.0).orbit(orbit(0.4)).span(0.0, 50.0),
        scene(0.0).orbit(orbit(2e-2)).tolerance(1e-10).span(0.0, 50.0),
    ];
    assert_eq!(integrated.each_ref().map(Scene::needs_integration), [true, false, false]);
    assert!(!by_theory.needs_integration());
    let times: Vec<f64> = (0..60).map(f64::from).collect();
    let positions = times.iter().map(|time| [100.0 + time, 0.0, 0.0]).collect();
    let table = TabulatedOrbit::new(times, positions, 1.0).expect("a table");
    let by_table = scene(0.0).disturbing([table.clone()]).span(0.0, 50.0);
    let sphere =
        Scene::new(Body::new([1.0; 3]).expect("a body"), *by_table.state()).disturbing([table]).span(0.0, 50.0);
    assert!(matches!(solved(&by_table), Err(Error::Stopped)));
    assert!(solved(&sphere).is_ok());
    let closed = by_table.clone().method(Method::Closed);
    assert_eq!([&by_table, &sphere, &closed].map(Scene::needs_integration), [true, false, false]);
    for scene in integrated {
        assert_eq!(scene.solve().expect("an integration").plan().method(), Method::Integrated);
        assert!(matches!(solved(&scene), Err(Error::Stopped)));
    }
    let nothing = scene(0.0).orbit(orbit(0.4)).method(Method::Integrated).span(0.0, 0.0);
    assert_eq!(solved(&nothing).expect("no step").plan().method(), Method::Integrated);
}

#[test]
fn flag_ends_an_ensemble_with_its_own_error_and_not_that_of_a_member() {
    let (moments, rates) = (vec![[1.0, 1.02, 1.05]; 300], vec![[0.0, 0.01, 1.0]; 300]);
    let level = vec![[0.0, 0.0, 0.0, 1.0]; 300];
    let stop = AtomicBool::new(true);
    for on_error in [OnError::Raise, OnError::Nan] {
        let going = AtomicBool::new(false);
        let ensemble = Ensemble::new_or(moments.clone(), level.clone(), rates.clone(), on_error, &going);
        let ensemble = ensemble.expect("bodies");
        let ended = ensemble.run().until(&stop).attitudes_into(&[0.0], &mut vec![[0.0; 4]; 300]);
        assert!(matches!(ended, Err(Error::Stopped)));
        assert!(matches!(ensemble.run().until(&stop).plans(), Err(Error::Stopped)));
    }
    let checked = Ensemble::new_or(moments, level, rates, OnError::Raise, &stop);
    assert!(matches!(checked, Err(Error::Stopped)));
}

#[test]
fn times_since_the_epoch_have_the_bits_of_an_epoch_of_zero() {
    let times = [1e-9, 0.123_456_789, 1234.5];
    let (mut late, mut early) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
    let motion = scene(8.25e8).solve().expect("a motion");
    motion.batch().since_epoch().attitudes_into(&times, &mut late).expect("finite times");
    scene(0.0).solve().expect("a motion").attitudes_into(&times, &mut early).expect("finite times");
    assert_eq!(late, early);
}

#[test]
fn outcome_counts_members_that_miss_the_tolerance_and_names_the_worst() {
    let rates = vec![[0.0, 0.01, 1.0], [0.0, 0.3, 1.0], [0.0, 0.0, 1.0]];
    let (moments, level) = (vec![[1.0, 1.02, 1.05]; 3], vec![[0.0, 0.0, 0.0, 1.0]; 3]);
    let orbit = Orbit::new(2e-3, 0.1).expect("an orbit");
    let ensemble = Ensemble::new(moments, level, rates).expect("bodies");
    let ensemble = ensemble.orbits(vec![Some(orbit), Some(orbit), None]).expect("three").span(0.0, 1e5);
    let bounds: Vec<f64> = ensemble.plans().expect("motions").iter().map(|plan| plan.error_bound()).collect();
    let worst = usize::from(bounds[1] > bounds[0]);
    for threads in [1, 3] {
        let ensemble = ensemble.clone().threads(threads);
        let outcome = ensemble.attitudes_into(&[0.0], &mut [[0.0; 4]; 3]).expect("motions");
        assert_eq!((outcome.missing(), outcome.worst()), (2, Some((worst, bounds[worst]))));
    }
}
