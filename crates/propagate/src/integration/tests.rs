use std::sync::atomic::AtomicBool;

use super::dense::Cursor;
use super::expansion::Equations;
use super::integrated::Integrated;
use super::integrator::Step;
use crate::error::STEP_BYTES;
use crate::{Body, Error, Method, Orbit, Scene, State};

fn scene(moments: [f64; 3], rates: [f64; 3]) -> Scene {
    let state = State::new(3.0, [0.1, -0.2, 0.3, 0.86_f64.sqrt()], rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state)
}

#[test]
fn a_step_takes_the_bytes_that_the_error_says() {
    assert_eq!(size_of::<Step>() as f64, STEP_BYTES);
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
fn steps_that_are_expanded_again_give_the_bits_of_those_that_were_kept() {
    let orbit = Orbit::new(0.3, 0.4).expect("an orbit").secular_rates(0.01, -0.02).expect("rates");
    let scene = scene([0.5, 0.8, 1.0], [0.3, 0.5, 1.0]).orbit(orbit).span(-40.0, 60.0);
    let kept = Integrated::new(&scene, "", &AtomicBool::new(false)).expect("a motion");
    let mut dropped = kept.clone();
    dropped.sides.iter_mut().for_each(|side| side.coefficients.clear());
    let (mut one, mut other) = (Cursor::new(&kept), Cursor::new(&dropped));
    for k in 0..=400 {
        let time = -43.0 + 0.25 * f64::from(k);
        assert_eq!(one.at((time, 0.0)), other.at((time, 0.0)));
    }
}

#[test]
fn a_span_of_too_many_steps_says_why_theory_does_not_serve() {
    let orbit = Orbit::new(0.06, 0.0).and_then(|orbit| orbit.mass_fraction(1e-4)).expect("an orbit");
    let error = scene([1.0, 1.02, 1.05], [0.0, 0.01, 1.0]).orbit(orbit).span(0.0, 1e9).solve().expect_err("too long");
    assert!(matches!(&error, Error::TooManySteps { reason, .. } if reason.contains("resonance")), "{error}");
    assert!(error.to_string().contains("The scene is integrated because of the theory: "), "{error}");
}

#[test]
fn the_integrals_of_the_free_motion_drift_by_twice_the_relative_error_of_the_rates() {
    let free = scene([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]).span(0.0, 500.0).method(Method::Integrated);
    let motion = Integrated::new(&free, "", &AtomicBool::new(false)).expect("a motion");
    let [first, last] = [&motion.sides[1].steps[0], &motion.sides[1].steps[motion.sides[1].steps.len() - 1]];
    let equations = Equations::new(&free, 0, 1.0);
    // Along the motion the energy and the angular momentum stay; with rates 1e-9 larger the largest integral, f2 ω1² − f1 ω2² or another, changes by 2e-9 of it.
    assert!(equations.drift(&first.rates, &last.rates) < 1e-14);
    let wrong = last.rates.map(|rate| rate * (1.0 + 1e-9));
    let drift = equations.drift(&first.rates, &wrong);
    assert!(drift > 1e-9 && drift < 2.001e-9, "{drift:e}");
}
