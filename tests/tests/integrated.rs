//! Motions by integration: against the closed form, and when they are chosen or refused.

use andoyer_propagate::{Body, Error, Method, Orbit, Scene, State};

fn scene(moments: [f64; 3], rates: [f64; 3]) -> Scene {
    let state = State::new(3.0, [0.1, -0.2, 0.3, 0.86_f64.sqrt()], rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state)
}

#[test]
fn free_motion_is_that_of_the_closed_form_in_both_directions() {
    for (moments, rates) in [
        ([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]),
        ([1.0, 1.5, 2.0], [1.0, 0.2, 0.1]),
        ([2.0, 1.0, 1.5], [0.3, -0.2, 0.7]),
        ([1.0, 1.0, 2.0], [0.1, 0.2, -1.0]),
        ([0.1, 1.0, 1.05], [0.3, 0.2, 1e-3]),
    ] {
        let free = scene(moments, rates).span(-97.0, 203.0);
        let closed = free.clone().solve().expect("a motion");
        let motion = free.method(Method::Integrated).solve().expect("a motion");
        let bound = motion.plan().error_bound();
        assert!(bound < 1e-11, "{moments:?}: {bound:e}");
        for k in 0..=300 {
            let time = -97.0 + f64::from(k);
            let [found, exact] = [&motion, &closed].map(|motion| motion.at(time).expect("a time"));
            let error = found.attitude.angle_to(&exact.attitude);
            assert!(error <= bound, "{moments:?} at {time}: {error:e} and {bound:e}");
            assert!((found.angular_velocity - exact.angular_velocity).norm() < 1e-13);
        }
    }
}

#[test]
fn a_span_is_needed_and_one_of_too_many_rotations_is_refused() {
    let scene = scene([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]).method(Method::Integrated);
    assert!(matches!(scene.solve(), Err(Error::NoSpan { .. })));
    let error = scene.span(0.0, 6.3e9).solve().expect_err("too long");
    assert!(matches!(error, Error::TooManySteps { steps, .. } if steps > 1e9), "{error}");
}

#[test]
fn a_span_of_too_many_steps_says_why_theory_does_not_serve() {
    // The polhode turns with 0.03834862, as the orbit does.
    let orbit = Orbit::new(0.038_348_62, 0.0).and_then(|orbit| orbit.mass_fraction(1e-4)).expect("an orbit");
    let solved = scene([1.0, 1.02, 1.05], [0.0, 0.01, 1.0]).orbit(orbit).span(0.0, 1e9).solve();
    let error = solved.map(|motion| motion.plan().error_bound()).expect_err("too long");
    assert!(matches!(&error, Error::TooManySteps { reason, .. } if reason.contains("resonance")), "{error}");
    assert!(error.to_string().contains("The scene is integrated because of the theory: "), "{error}");
}

#[test]
fn a_scene_of_a_hundred_rotations_whose_theory_misses_a_tolerance_of_1e_12_is_integrated_and_meets_it() {
    let orbit = Orbit::new(0.01, 0.1).expect("an orbit");
    let scene = scene([0.5, 0.8, 1.0], [0.05, 0.05, 1.0]).orbit(orbit).span(0.0, 700.0).tolerance(1e-12);
    let theory = scene.clone().method(Method::Closed).solve().expect("a motion");
    assert!(!theory.plan().meets_tolerance(), "{}", theory.plan());
    let plan = scene.solve().expect("a motion").plan().clone();
    assert!(plan.method() == Method::Integrated && plan.meets_tolerance(), "{plan}");
}

#[test]
fn a_plan_by_theory_that_misses_the_tolerance_says_what_bound_the_integration_would_have() {
    let orbit = Orbit::new(0.01, 0.1).expect("an orbit");
    let scene = scene([0.5, 0.8, 1.0], [0.05, 0.05, 1.0]).orbit(orbit).tolerance(1e-12);
    let long = scene.clone().span(0.0, 7e4).solve().expect("a motion");
    assert_eq!(long.plan().method(), Method::Closed);
    let said = long.plan().skipped().last().expect("a reason");
    let guess = said
        .strip_prefix("integration: its error bound would be about ")
        .and_then(|rest| rest.split_once(" rad (method \"integrated\" has it)"));
    let guess: f64 = guess.and_then(|(number, rest)| rest.is_empty().then(|| number.parse().ok())?).expect(said);
    let bound = scene.clone().span(0.0, 7e4).method(Method::Integrated).solve().expect("a motion").plan().error_bound();
    assert!(guess > 0.1 * bound && guess < 3.0 * bound, "{guess:e} {bound:e}");
    let longest = scene.span(0.0, 7e7).solve().expect("a motion");
    let said = longest.plan().skipped().last().expect("a reason");
    assert_eq!(said, "integration: it would take about 1.4e8 steps, and at most 8388608 are kept");
}
