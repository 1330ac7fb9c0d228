//! What no choice of axes, labels, clock or order of evaluation may change under a gravity gradient, and where the theory says that it does not hold.

use andoyer_propagate::nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};
use andoyer_tests::attitude_error;
use andoyer_tests::integration::Problem;

const MOMENTS: [f64; 3] = [0.9, 0.95, 1.0];
const RATES: [f64; 3] = [0.05, 0.08, 1.0];
const MEAN_MOTION: f64 = 2e-3;
const ECCENTRICITY: f64 = 0.2;
/// Inclination, node, argument of the pericentre.
const PLANE: [f64; 3] = [0.4, 1.1, 2.3];
const TIMES: [f64; 5] = [-3000.0, -1.0, 0.0, 777.0, 9000.0];
const SPAN: f64 = 9000.0;

fn attitude() -> UnitQuaternion<f64> {
    UnitQuaternion::from_euler_angles(0.3, -0.2, 0.5)
}

fn orbit([inclination, node, argument]: [f64; 3], pericentre: f64) -> Orbit {
    Orbit::new(MEAN_MOTION, ECCENTRICITY)
        .and_then(|orbit| orbit.plane(inclination, node, argument))
        .and_then(|orbit| orbit.time_of_pericentre(pericentre))
        .expect("an orbit")
}

fn scene(moments: [f64; 3], epoch: f64, attitude: UnitQuaternion<f64>, rates: [f64; 3]) -> Scene {
    let state = State::new(epoch, attitude.coords.into(), rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state).span(epoch - SPAN, epoch + SPAN).method(Method::Closed)
}

fn standard() -> Scene {
    scene(MOMENTS, 0.0, attitude(), RATES).orbit(orbit(PLANE, 100.0))
}

fn at(motion: &Motion, time: f64) -> UnitQuaternion<f64> {
    motion.at(time).expect("a finite time").attitude
}

/// Largest difference of `other` from `map` of the standard motion, by averaging.
fn differs(other: impl Fn() -> Scene, shift: f64, map: impl Fn(UnitQuaternion<f64>) -> UnitQuaternion<f64>) -> f64 {
    let mut largest = 0.0_f64;
    for averaging in [Averaging::Spin, Averaging::Orbit] {
        let one = standard().averaging(averaging).solve().expect("averaged");
        let two = other().averaging(averaging).solve().expect("averaged");
        for time in TIMES {
            let expected = map(at(&one, time)).coords.into();
            largest = largest.max(attitude_error(at(&two, time + shift).coords.into(), expected));
        }
    }
    largest
}

/// Rounding of 9,000 radians, and of tables that are differences (relative 1e-10 of corrections of 1e-6).
const ROUNDING: f64 = 2e-11;

#[test]
fn another_inertial_frame_gives_the_same_motion_seen_from_it() {
    let turn = UnitQuaternion::from_euler_angles(0.7, 1.1, -2.0);
    let [inclination, node, argument] = PLANE;
    let about = |axis: &Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(axis * angle);
    let plane = about(&Vector3::z(), node) * about(&Vector3::x(), inclination) * about(&Vector3::z(), argument);
    let turned: Matrix3<f64> = turn.to_rotation_matrix().into_inner() * plane.into_inner();
    let elements = [turned[(2, 2)].acos(), turned[(0, 2)].atan2(-turned[(1, 2)]), turned[(2, 0)].atan2(turned[(2, 1)])];
    let other = || scene(MOMENTS, 0.0, turn * attitude(), RATES).orbit(orbit(elements, 100.0));
    assert!(differs(other, 0.0, |attitude| turn * attitude) <= ROUNDING);
}

#[test]
fn another_zero_of_time_gives_the_same_motion_later() {
    let other = || scene(MOMENTS, 4096.0, attitude(), RATES).orbit(orbit(PLANE, 4196.0));
    assert!(differs(other, 4096.0, |attitude| attitude) <= ROUNDING);
    // A later passage of the pericentre names the same orbit.
    let period = std::f64::consts::TAU / MEAN_MOTION;
    assert!(
        differs(|| scene(MOMENTS, 0.0, attitude(), RATES).orbit(orbit(PLANE, 100.0 + 3.0 * period)), 0.0, |a| a)
            <= ROUNDING
    );
}

#[test]
fn other_labels_of_the_body_axes_give_the_same_motion() {
    let [a, b, c] = MOMENTS;
    let [x, y, z] = RATES;
    // New axes 1, 2, 3 along the old 2, −1, 3, and along the old 3, 1, 2.
    let quarter = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
    let cycle = UnitQuaternion::from_matrix(&Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0));
    for (moments, rates, turn) in [([b, a, c], [y, -x, z], quarter), ([c, a, b], [z, x, y], cycle)] {
        let other = || scene(moments, 0.0, attitude() * turn, rates).orbit(orbit(PLANE, 100.0));
        assert!(differs(other, 0.0, |attitude| attitude * turn) <= ROUNDING);
    }
}

/// Largest distance to an integration of the full equations over that of the free motion.
fn share(moments: [f64; 3], rates: [f64; 3], times: &[f64]) -> f64 {
    let disturber = orbit(PLANE, 100.0);
    let truth = Problem { moments, orbit: Some(disturber) }.integrate(0.0, attitude().coords.into(), rates, times);
    let [free, disturbed] = [None, Some(disturber)].map(|disturber| {
        let scene = scene(moments, 0.0, attitude(), rates);
        let motion = disturber.map_or(scene.clone(), |orbit| scene.orbit(orbit)).solve().expect("solved");
        let errors = times.iter().zip(&truth).map(|(&t, &(q, _))| attitude_error(at(&motion, t).coords.into(), q));
        errors.fold(0.0, f64::max)
    });
    disturbed / free
}

#[test]
fn times_before_the_epoch_are_as_good_as_times_after_it() {
    assert!(share(MOMENTS, RATES, &[-10.0, -500.0, -3000.0, -9000.0]) <= 3e-6);
    assert!(share(MOMENTS, RATES, &[10.0, 500.0, 3000.0, 9000.0]) <= 3e-6);
}

#[test]
fn rotation_about_the_long_axis_goes_by_the_same_route() {
    assert!(share([0.5, 0.9, 1.0], [1.0, 0.05, 0.03], &[10.0, 500.0, 3000.0]) <= 1e-4);
}

#[test]
fn a_motion_started_again_from_its_own_state_goes_on_within_both_bounds() {
    // Second order has rates with an error of second order, bounded, which a motion started again turns into a drift.
    let motion = standard().averaging(Averaging::Spin).level(Level::Full).solve().expect("averaged");
    let middle = motion.at(1234.0).expect("finite");
    let again = scene(MOMENTS, 1234.0, middle.attitude, middle.angular_velocity.into())
        .orbit(orbit(PLANE, 100.0))
        .averaging(Averaging::Spin)
        .level(Level::Full)
        .solve()
        .expect("averaged");
    for time in [1234.0, 2000.0, 5000.0] {
        let difference = attitude_error(at(&again, time).coords.into(), at(&motion, time).coords.into());
        assert!(difference <= motion.plan().error_bound() + again.plan().error_bound());
    }
    // At its own state it is exact but for what the inversion of the corrections leaves.
    assert!(attitude_error(at(&again, 1234.0).coords.into(), middle.attitude.coords.into()) <= 1e-14);
}

#[test]
fn eight_threads_that_need_new_quarters_get_the_bits_of_one() {
    let times: Vec<f64> = (0..4000).map(|k| f64::from((k * 2731) % 4000) * 2.25 - 4500.0).collect();
    let states = |motion: &Motion, times: &[f64]| -> Vec<[f64; 4]> {
        times.iter().map(|&time| at(motion, time).coords.into()).collect()
    };
    let alone = states(&standard().averaging(Averaging::Spin).solve().expect("averaged"), &times);
    let shared = standard().averaging(Averaging::Spin).solve().expect("averaged");
    let together: Vec<Vec<[f64; 4]>> = std::thread::scope(|scope| {
        let threads: Vec<_> = times.chunks(500).map(|part| scope.spawn(|| states(&shared, part))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    assert_eq!(alone, together.concat());
    let mut batch = vec![[0.0; 4]; times.len()];
    shared.attitudes_into(&times, &mut batch).expect("finite times");
    assert_eq!(alone, batch);
}

#[test]
fn resonances_are_errors_that_name_the_pair_and_only_where_a_term_is_there() {
    let orbit_of = |n: f64, e: f64, fraction: f64| {
        Orbit::new(n, e).and_then(|orbit| orbit.mass_fraction(fraction)).expect("an orbit")
    };
    let faint = |n: f64, e: f64| orbit_of(n, e, 1e-4);
    let moments = [0.95, 0.98, 1.0];
    let wobbling = [0.02, 0.0, 1.0];
    let wobble = scene(moments, 0.0, attitude(), wobbling).solve().expect("free").frequencies().anomaly;
    // One to one and three to two with the spin.
    let rates = [0.0, 0.0, 1.0];
    for (orbit, pair) in [(faint(1.0, 0.0), (0, 2)), (faint(2.0 / 3.0, 0.2), (0, 2))] {
        match scene(moments, 0.0, attitude(), rates).orbit(orbit).solve() {
            Err(Error::Resonance { harmonic, multiple, divisor, bound, effect, limit }) => {
                assert_eq!((harmonic, multiple), pair, "{rates:?}");
                assert!(divisor < bound && effect > limit);
            }
            other => panic!("{:?}: {}", pair, other.map_or_else(|e| e.to_string(), |m| m.plan().to_string())),
        }
    }
    // One to one of the wobble with the orbit turns the attitude by less, and is served by the solution that vanishes at the epoch.
    for fraction in [1e-4, 1.0] {
        let orbit = orbit_of(wobble, 0.0, fraction);
        within_both_bounds(&scene(moments, 0.0, attitude(), wobbling).orbit(orbit).span(0.0, 2000.0));
    }
    // Without a difference of A and B there is none of (0, 2). The wobble that the torque forces has 1.05 n, and the torque on a circle only 0 and 2n.
    let round = scene([0.95, 0.95, 1.0], 0.0, attitude(), [0.0, 0.0, 1.0]).orbit(faint(1.0, 0.0)).span(0.0, 2000.0);
    within_both_bounds(&round);
}

/// Compares the theory with the integration over (0, 2000).
fn within_both_bounds(scene: &Scene) {
    let theory = scene.clone().method(Method::Closed).solve().expect("served");
    let exact = scene.clone().method(Method::Integrated).solve().expect("integrated");
    let bound = theory.plan().error_bound() + exact.plan().error_bound();
    for k in 1..=50 {
        let [theory, exact] = [&theory, &exact].map(|motion| at(motion, 40.0 * f64::from(k)));
        let error = theory.angle_to(&exact);
        assert!(error <= bound, "{error:e} {bound:e}");
    }
}

#[test]
fn terms_that_a_scene_has_not_are_not_computed() {
    let terms = |moments: [f64; 3], rates: [f64; 3], level: Level| {
        let motion =
            scene(moments, 0.0, attitude(), rates).orbit(orbit(PLANE, 0.0)).level(level).solve().expect("averaged");
        motion.plan().to_string()
    };
    let count = |plan: String| -> usize {
        let before = plan.split(" short-period terms").next().expect("a line").to_owned();
        before.rsplit(' ').next().and_then(|number| number.parse().ok()).expect("a number")
    };
    // A principal axis has the terms of the wobble that the torque forces.
    assert!(count(terms([0.9, 0.9, 1.0], [0.0, 0.0, 1.0], Level::Full)) <= 2);
    assert_eq!(count(terms(MOMENTS, [0.0, 0.0, 1.0], Level::Paper)), 1);
    assert!(count(terms(MOMENTS, [0.0, 0.0, 1.0], Level::Full)) < count(terms(MOMENTS, RATES, Level::Full)));
}
