//! Tests of the averaged theory with several bodies and with precessing orbits, against the numerical integration.

use andoyer_propagate::disturbers::DisturbingBody;
use andoyer_propagate::error::TorqueMeasure;
use andoyer_propagate::options::Level;
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};

/// A tumbling body under these orbits.
fn scene(orbits: &[Orbit], duration: f64) -> Scene {
    let state = State::new(1.0, [0.1, -0.2, 0.3, 0.927_361_849_549_570_4], [0.12, -0.05, 1.0]).expect("a state");
    Scene::new(Body::new([0.85, 0.9, 1.0]).expect("a body"), state)
        .disturbing(orbits.iter().copied().map(DisturbingBody::from))
        .span(1.0 - duration, 1.0 + duration)
}

fn precessing() -> Orbit {
    Orbit::new(4e-3, 0.2)
        .and_then(|orbit| orbit.plane(0.4, 0.7, 1.1)?.secular_rates(-1e-3, 5e-4)?.time_of_pericentre(-300.0))
        .expect("an orbit")
}

fn fixed() -> Orbit {
    Orbit::new(1e-3, 0.5).and_then(|orbit| orbit.plane(1.2, 0.3, 2.0)?.attraction(4e-6)).expect("an orbit")
}

/// Largest angle between two motions.
fn apart(one: &Motion, other: &Motion, duration: f64) -> f64 {
    let angle = |k: i32| {
        let time = 1.0 + duration * f64::from(k) / 100.0;
        let [one, other] = [one, other].map(|motion| motion.at(time).expect("within the span").attitude);
        one.angle_to(&other)
    };
    (-100..=100).map(angle).fold(0.0, f64::max)
}

/// Error over bound, and the torque's effect over the error, by integration.
fn judged(orbits: &[Orbit], duration: f64) -> [f64; 2] {
    let scene = scene(orbits, duration);
    let by_theory = scene.clone().method(Method::Closed).solve().expect("averaged");
    let exact = scene.clone().method(Method::Integrated).solve().expect("integrated");
    let free = scene.disturbing([Orbit::new(1e-9, 0.0).expect("an orbit")]).solve().expect("nearly free");
    assert_eq!(by_theory.plan().method(), Method::Closed);
    let error = apart(&by_theory, &exact, duration);
    [error / by_theory.plan().error_bound(), apart(&free, &exact, duration) / error]
}

#[test]
fn two_bodies_leave_an_error_of_second_order_within_the_bound() {
    let [share, gain] = judged(&[Orbit::new(4e-3, 0.2).expect("an orbit"), fixed()], 3000.0);
    assert!(share < 1.0 && gain > 1e4, "{share} {gain}");
}

#[test]
fn a_precessing_orbit_leaves_an_error_of_second_order_within_the_bound() {
    let [share, gain] = judged(&[precessing()], 3000.0);
    assert!(share < 1.0 && gain > 1e4, "{share} {gain}");
}

#[test]
fn two_bodies_of_which_one_precesses_leave_an_error_of_second_order_within_the_bound() {
    let [share, gain] = judged(&[precessing(), fixed()], 3000.0);
    assert!(share < 1.0 && gain > 1e4, "{share} {gain}");
}

#[test]
fn two_halves_of_a_body_act_as_the_whole() {
    let half = fixed().attraction(2e-6).expect("an orbit");
    let [whole, halves] = [&[fixed()][..], &[half, half]]
        .map(|orbits| scene(orbits, 3000.0).method(Method::Closed).level(Level::Moving).solve().expect("averaged"));
    // The mean variables and the corrections are the same sums, so only rounding is left.
    let error = apart(&whole, &halves, 3000.0);
    assert!(error < 2e-13, "{error:e}");
}

#[test]
fn a_precession_faster_than_the_orbit_is_refused_by_the_theory_and_integrated() {
    // The polynomials on quarters of the orbit did not converge: every attitude was NaN.
    let rate = 2.3e-5;
    let orbit = |factor: f64| {
        let orbit = Orbit::new(rate, 0.026).and_then(|orbit| orbit.plane(0.5, 0.0, 0.0));
        orbit.and_then(|orbit| orbit.attraction(factor * rate * rate)).expect("an orbit")
    };
    let scene = |orbits: &[Orbit]| {
        let attitude = [0.1, -0.2, 0.3, 0.927_361_849_549_570_4];
        let state = State::new(0.0, attitude, [-0.0876, 0.0, -0.571]).expect("a state");
        let body = Body::new([0.5157, 0.9732, 1.0]).expect("a body");
        Scene::new(body, state)
            .disturbing(orbits.iter().copied().map(DisturbingBody::from))
            .span(0.0, 2000.0)
            .tolerance(1e-6)
    };
    for orbits in [&[orbit(3e5)][..], &[orbit(1.5e5), orbit(1.5e5)]] {
        let by_theory = scene(orbits).method(Method::Closed).solve();
        assert!(
            matches!(by_theory, Err(Error::TorqueTooStrong { measure: TorqueMeasure::Precession, size, bound: 0.3 }) if size > 5.0),
            "{by_theory:?}"
        );
        let motion = scene(orbits).solve().expect("integrated");
        assert_eq!(motion.plan().method(), Method::Integrated);
        assert!(motion.at(2000.0).expect("within the span").attitude.coords.iter().all(|part| part.is_finite()));
    }
    // At the pericentre of a slow orbit beside a fast one too.
    let slow = Orbit::new(6.8825e-7, 0.9).and_then(|orbit| orbit.plane(0.5, 0.0, 0.0)?.attraction(4.56e-6));
    let slow = slow.and_then(|orbit| orbit.time_of_pericentre(1e5)).expect("an orbit");
    let fast = Orbit::new(1e-4, 0.0).and_then(|orbit| orbit.attraction(1e-14)).expect("an orbit");
    let by_theory = scene(&[slow, fast]).span(0.0, 6e4).method(Method::Closed).solve();
    assert!(
        matches!(by_theory, Err(Error::TorqueTooStrong { measure: TorqueMeasure::Precession, .. })),
        "{by_theory:?}"
    );
    // Below the limit the theory serves the scene, to its bound.
    let slower = &[orbit(5e3)];
    let [by_theory, exact] =
        [Method::Closed, Method::Integrated].map(|method| scene(slower).method(method).solve().expect("a motion"));
    let [one, other] = [&by_theory, &exact].map(|motion| motion.at(2000.0).expect("within the span").attitude);
    assert!(one.angle_to(&other) <= by_theory.plan().error_bound(), "{:e}", one.angle_to(&other));
}

#[test]
fn an_orbit_whose_node_turns_much_faster_than_it_is_solved_in_finite_time() {
    // Its arcs were counted one by one around an orbit.
    let orbit = Orbit::new(1e-20, 0.2).and_then(|orbit| orbit.plane(0.3, 0.0, 0.0)?.secular_rates(9.7e-6, 0.0));
    let motion = scene(&[orbit.expect("an orbit")], 100.0).method(Method::Closed).solve().expect("a motion");
    assert!(motion.at(100.0).expect("within the span").attitude.coords.iter().all(|part| part.is_finite()));
}

#[test]
fn arcs_next_to_the_pericentre_of_a_nearly_parabolic_orbit_advance() {
    // An arc shorter than the spacing of the times ended where it began.
    let near = Orbit::new(2e-4, 1.0 - 1e-12).and_then(|orbit| orbit.mass_fraction(1e-200)).expect("an orbit");
    let near = near.time_of_pericentre(29_165.123).expect("an orbit");
    let body = Body::new([0.85, 0.9, 1.0]).expect("a body");
    let state = State::new(0.0, [0.1, -0.2, 0.3, 0.927_361_849_549_570_4], [0.12, -0.05, 1.0]).expect("a state");
    let orbits = [Orbit::new(5.5e-5, 0.3).expect("an orbit"), near];
    let scene = Scene::new(body, state).disturbing(orbits.map(DisturbingBody::from)).span(0.0, 33_000.0);
    let motion = scene.method(Method::Closed).solve().expect("a motion");
    assert!(motion.at(32_081.0).expect("within the span").attitude.coords.iter().all(|part| part.is_finite()));
}
