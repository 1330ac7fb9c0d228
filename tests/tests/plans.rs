//! What a plan says, and what errors say, in the words that a user reads.

use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::{Body, Ensemble, Error, Method, Motion, Orbit, Scene, State};

const LEVEL: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

fn scene(moments: [f64; 3], rates: [f64; 3]) -> Scene {
    Scene::new(Body::new(moments).expect("a body"), State::new(0.0, LEVEL, rates).expect("a state"))
}

fn triaxial() -> Scene {
    scene([1.0, 1.5, 2.0], [0.1, 0.2, 1.0])
}

fn skipped(scene: &Scene) -> String {
    scene.solve().expect("served").plan().skipped().join("\n")
}

fn orbit() -> Orbit {
    Orbit::new(1e-3, 0.0).expect("an orbit")
}

#[test]
fn what_the_series_would_need_is_a_condition_and_no_statement() {
    let text = skipped(&triaxial());
    assert!(text.contains("series: it would need order 6 or more, and no fewer harmonics"), "{text}");
}

#[test]
fn what_was_asked_for_and_not_used_is_said() {
    let closed = triaxial().method(Method::Closed);
    assert!(skipped(&closed.clone().order(8)).contains("order 8, which was asked for: the closed form has none"));
    assert!(!skipped(&closed).contains("asked for") && !skipped(&triaxial().order(8)).contains("asked for"));
    let text = skipped(&triaxial().averaging(Averaging::Spin).level(Level::Paper));
    assert!(text.contains("averaging spin, which was asked for: there is no orbit"), "{text}");
    assert!(text.contains("level paper, which was asked for: there is no orbit"), "{text}");
    let at_rest = scene([1.0, 1.5, 2.0], [0.0; 3]).order(3).averaging(Averaging::Orbit);
    assert_eq!(at_rest.solve().expect("rest").plan().skipped().len(), 3);
    let sphere = scene([1.0; 3], [0.0, 0.0, 1.0]).orbit(orbit());
    assert!(skipped(&sphere).contains("gravity gradient: it exerts no torque on a sphere"), "{}", skipped(&sphere));
    // Of a round body and on the separatrix the order is said once.
    for scene in [scene([1.0, 1.0, 2.0], [0.1, 0.0, 1.0]), scene([1.0, 2.0, 2.25], [0.75, 0.0, 1.0])] {
        assert_eq!(skipped(&scene.method(Method::Closed).order(8)).matches("order 8").count(), 1);
    }
}

#[test]
fn the_plan_says_over_what_the_tolerance_is_missed() {
    let plan = |scene: Scene| scene.order(1).solve().expect("served").plan().to_string();
    assert!(plan(triaxial()).contains("is not met over 1e9 rotations (no span given)"), "{}", plan(triaxial()));
    assert!(plan(triaxial().span(0.0, 100.0)).contains("is not met over the span"));
}

#[test]
fn the_plan_of_a_torque_without_a_span_says_how_far_the_average_reaches() {
    // It said 1e9 rotations, and the motion refused times beyond 65,534 orbits.
    let by_spin = triaxial().orbit(orbit()).averaging(Averaging::Spin).tolerance(1e-9);
    let motion = by_spin.clone().solve().expect("averaged");
    let reach = 65_534.0 / 1e-3 * motion.frequencies().longitude;
    let said = format!("over {reach:.1e} rotations (no span given; averaging = spin reaches no farther)");
    let text = motion.plan().to_string();
    assert!(reach < 1e9 && text.contains(&said), "{said}, {text}");
    assert!(motion.plan().missed_tolerance().is_some_and(|text| text.contains(&said)));
    let text = by_spin.span(0.0, 1e4).solve().expect("averaged").plan().to_string();
    assert!(!text.contains("reaches no farther"), "{text}");
    let text = triaxial().orbit(orbit()).averaging(Averaging::Orbit).solve().expect("averaged").plan().to_string();
    assert!(text.contains("is not met over 1e9 rotations (no span given)"), "{text}");
}

#[test]
fn the_plan_says_that_nothing_is_known_instead_of_a_bound_of_half_a_turn() {
    let wobbling =
        scene([1.0, 1.5, 2.0], [0.3, 0.1, 1.0]).orbit(Orbit::new(2e-2, 0.3).expect("an orbit")).level(Level::Paper);
    let plan = wobbling.clone().method(Method::Closed).solve().expect("averaged").plan().clone();
    assert_eq!(plan.error_bound(), std::f64::consts::PI);
    assert!(plan.to_string().contains("\nerror bound   unknown (half a turn or more); give a span\n"), "{plan}");
    let text = plan.missed_tolerance().expect("missed");
    assert!(text.starts_with("the error bound of the attitude, half a turn or more, exceeds"), "{text}");
    assert!(text.ends_with("; give a span"), "{text}");
    let plan = wobbling.method(Method::Closed).span(0.0, 1e9).solve().expect("averaged").plan().clone();
    assert!(plan.to_string().contains("unknown (half a turn or more); give a shorter span"), "{plan}");
}

#[test]
fn the_plan_shows_no_order_where_there_is_none_and_how_near_the_separatrix_is() {
    let line = |scene: &Scene, name: &str| {
        let text = scene.solve().expect("served").plan().to_string();
        text.lines().find(|line| line.starts_with(name)).expect("a line of that name").to_owned()
    };
    let closed = triaxial();
    assert_eq!(line(&closed, "order"), "order         -");
    assert_eq!(line(&closed.clone().method(Method::Series), "order"), "order         6");
    assert!(line(&closed, "harmonics").ends_with(|end: char| end.is_ascii_digit()));
    let near = scene([1.0, 2.0, 3.0], [0.0, 1.0, 1e-3]);
    assert!(line(&near, "separatrix").starts_with("separatrix    1 - "), "{}", line(&near, "separatrix"));
    let steady = scene([1.0, 2.0, 3.0], [0.0, 1.0, 0.0]);
    let expected = ["harmonics     -", "separatrix    1.000e0 (sigma/sigma_sep)"];
    assert_eq!([line(&steady, "harmonics"), line(&steady, "separatrix")], expected);
}

#[test]
fn rates_that_have_no_double_are_an_error_of_units_and_not_nan() {
    // M/C is finite and M/A is not: the rates were NaN.
    let error = scene([1e-6, 1.0 - 5e-7, 1.0], [0.0, 1e301, 1e304]).solve().expect_err("no rates");
    assert!(matches!(error, Error::Units { exponent: 1024.., .. }), "{error:?}");
    assert!(error.to_string().contains("the rate that belongs to the smallest moment, 2^10"), "{error}");
    let motion = scene([1e-6, 1.0 - 5e-7, 1.0], [0.0, 1e297, 1e300]).solve().expect("served");
    let rates = motion.at(1e-300).expect("finite").angular_velocity;
    assert!(rates.iter().all(|rate| rate.is_finite()), "{rates:?}");
}

#[test]
fn an_index_beyond_an_ensemble_is_named_with_the_number_of_members() {
    let ensemble = Ensemble::new(vec![[1.0, 1.5, 2.0]; 2], vec![LEVEL; 2], vec![[0.0, 0.1, 1.0]; 2]).expect("bodies");
    for index in [2, usize::MAX] {
        let error = ensemble.motion(index).expect_err("no member");
        assert!(matches!(error, Error::Index { members: 2, index: found } if found == index), "{error:?}");
    }
    assert_eq!(
        ensemble.motion(2).expect_err("none").to_string(),
        "index = 2: the ensemble has 2 members, counted from 0"
    );
}

#[test]
fn refusals_are_sentences() {
    let error = scene([1.0, 1.5, 2.0], [0.0; 3]).orbit(orbit()).solve().expect_err("at rest");
    // The message gave σ/σ_sep = 0 as what must be at most 0.9.
    assert_eq!(error.to_string(), "orbit: a body at rest has no averaged theory");
    assert_eq!((error.value(), error.bound()), (Some("at-rest".into()), Some("a body that rotates".into())));
    let error = scene([1.0, 1.02, 1.05], [0.0, 1.0, 1e-3]).orbit(orbit()).solve().expect_err("near the separatrix");
    assert!(error.to_string().ends_with("which must be at most 0.9)") && error.bound() == Some(0.9.into()), "{error}");
    let motion = scene([1.0, 1.5, 2.0], [0.0; 3]).solve().expect("rest");
    let text = "times[0] = 2e300: the epoch is 0; a time must be finite and within 1.000e300 of the epoch";
    assert_eq!(motion.at(2e300).expect_err("too far").to_string(), text);
    let error = triaxial().solve().expect("served").at(1e30).expect_err("too far");
    assert!(error.to_string().ends_with("of the epoch: farther away the motion has no phase"), "{error}");
    // Averaged over the spin it has a phase, but its equations are solved for 65,534 orbits only: the message said otherwise.
    let spun = scene([1.0, 1.02, 1.05], [0.0, 0.0, 1.0])
        .orbit(orbit())
        .averaging(Averaging::Spin)
        .span(0.0, 1e4)
        .solve()
        .expect("averaged");
    let text = spun.at(4.2e8).expect_err("too far").to_string();
    let expected = "times[0] = 420000000: the epoch is 0, the span is from 0 to 10000; a time must be finite and within 4.118e8 of the epoch: averaging = spin";
    assert!(text.starts_with(expected), "{text}");
}

#[test]
fn a_resonance_states_the_effect_that_is_too_large() {
    let resonant = |n: f64, e: f64, fraction: f64, rates: [f64; 3]| {
        let orbit =
            Orbit::new(n, e).and_then(|orbit| orbit.plane(0.5, 0.0, 0.0)?.mass_fraction(fraction)).expect("an orbit");
        scene([1.0, 1.02, 1.05], rates).orbit(orbit).method(Method::Closed)
    };
    let error = resonant(0.038_348, 0.0, 3e-2, [0.0, 0.01, 1.0]).solve().expect_err("too slow");
    let Error::Resonance { divisor, bound, effect, limit, .. } = error else { panic!("{error}") };
    assert!(divisor < bound && effect > limit);
    assert_eq!((error.value(), error.bound()), (Some(effect.into()), Some(limit.into())));
    let text = error.to_string();
    assert!(text.starts_with("spin resonance (h, m) = (2, 0): the terms in h times the angle"), "{text}");
    assert!(text.contains("allowed; their frequency is") && text.contains("needs more than 3:"), "{text}");
    // A term faster than the orbit, whose harmonic of the orbit is at resonance: the message said that 5.9 must be more than 3.
    let error = (1..400)
        .filter_map(|k| resonant(0.05 + 5e-4 * f64::from(k), 0.3, 1.0, [0.0, 0.1, 1.0]).span(0.0, 1e4).solve().err())
        .find(|error| matches!(error, Error::Resonance { divisor, bound, .. } if divisor > bound))
        .expect("a resonance of a fast term");
    let Error::Resonance { effect, limit, .. } = error else { panic!("{error}") };
    assert!(effect > limit);
    assert_eq!((error.value(), error.bound()), (Some(effect.into()), Some(limit.into())));
    let text = error.to_string();
    assert!(
        text.contains("rad is allowed: give a shorter span, or integrate") && !text.contains("frequency"),
        "{text}"
    );
}

#[test]
fn a_torque_that_is_too_strong_is_measured_in_words_and_with_its_limit() {
    let error = |scene: Scene| scene.method(Method::Closed).solve().expect_err("too strong").to_string();
    let round = scene([1.0, 1.2, 1.5], [0.0, 0.0, 1.0]).orbit(Orbit::new(0.32, 0.0).expect("an orbit"));
    let text = error(round.span(0.0, 60.0));
    assert!(text.contains("in it: the short-period corrections add up to 0."), "{text}");
    assert!(text.ends_with(" rad, and must add up to at most 0.05 rad"), "{text}");
    let wobbling = scene([1.0, 1.5, 2.0], [0.3, 0.1, 1.0]).orbit(Orbit::new(0.1, 0.3).expect("an orbit"));
    let text = error(wobbling.level(Level::Paper));
    assert!(
        text.contains("in it: its strength 3n²C(C−A)/2M², where the disturbing body is nearest, is 0.02"),
        "{text}"
    );
    assert!(text.ends_with(", and must be at most 0.02"), "{text}");
}

#[test]
fn a_span_that_no_integration_serves_is_the_argument_of_its_error() {
    // A chaotic tumbling: the argument was the tolerance, and the bound a pair of times.
    let chaotic = scene([0.5, 0.8, 1.0], [0.01, 0.02, 1.0]).orbit(Orbit::new(1.0, 0.1).expect("an orbit"));
    let error = chaotic.span(0.0, 2000.0).tolerance(1e-8).method(Method::Integrated).solve().expect_err("chaos");
    let Error::Unpredictable { start, stop, known, .. } = error else { panic!("{error}") };
    assert!(start == 0.0 && stop > 0.0 && stop < known[1] && known[0] == 0.0 && known[1] < 2000.0, "{error}");
    assert_eq!((error.argument(), error.value()), (Some("span"), Some([0.0, 2000.0].into())));
    assert_eq!(error.bound(), Some([start, stop].into()));
    assert!(error.to_string().starts_with("span = [0, 2000]: nearby states separate so fast"), "{error}");
}

#[test]
fn a_plan_is_ascii_whatever_the_motion() {
    let scenes = [
        triaxial(),
        triaxial().method(Method::Series).order(2),
        triaxial().orbit(orbit()).tolerance(1e-9).span(0.0, 1e3),
        triaxial().orbit(Orbit::new(0.4, 0.1).expect("an orbit")).span(0.0, 10.0),
        scene([1.0, 1.02, 1.05], [0.0, 1.0, 1e-3]).orbit(orbit()).span(0.0, 10.0),
        scene([1.0, 2.0, 3.0], [0.0, 1.0, 1e-3]),
        scene([1.0, 2.0, 3.0], [0.0, 1.0, 0.0]),
        scene([1.0, 2.0, 2.25], [0.75, 0.0, 1.0]),
        scene([1.0, 1.0, 2.0], [0.1, 0.0, 1.0]).order(8),
        scene([1.0; 3], [0.0, 0.0, 1.0]).orbit(orbit()),
        scene([1.0, 1.5, 2.0], [0.0; 3]).level(Level::Paper),
    ];
    for scene in scenes {
        let text = scene.solve().expect("served").plan().to_string();
        assert!(text.is_ascii(), "{text}");
    }
}

#[test]
fn the_slow_precession_of_a_needle_keeps_its_digits() {
    // dy′/dt and dℓ′/dt nearly cancel: M/C to 1e-10 of M/A, of which six digits were left in P_φ. A prolate body has them as formulas.
    let (slender, rates) = (1e-10, [1e-3, 0.0, 1.0]);
    let motion = scene([1.0, 1.0, slender], rates).solve().expect("precession");
    // The long axis goes round the angular momentum with M/B.
    let momentum = (1e-6 + slender * slender).sqrt();
    let (found, expected) = (motion.long_axis_periods().precession, std::f64::consts::TAU / momentum);
    assert!((found / expected - 1.0).abs() < 1e-15, "{found} {expected}");
}

#[test]
fn the_level_that_is_chosen_is_the_level_that_is_asked_for() {
    for (mean_motion, tolerance, level) in [(1e-3, 1e-4, Level::Full), (1e-2, 1e-10, Level::SecondOrder)] {
        let body = Body::new([0.7, 0.85, 1.0]).expect("a body");
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.05, 1.0]).expect("a state");
        let orbit = Orbit::new(mean_motion, 0.1).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
        let scene = Scene::new(body, state).orbit(orbit).span(0.0, 1e3).tolerance(tolerance);
        let scene = scene.method(Method::Closed);
        let open = scene.clone().solve().expect("averaged");
        assert!(open.plan().to_string().contains(&format!("{level}, averaged")), "{}", open.plan());
        let asked =
            scene.averaging(open.plan().averaging().expect("an averaging")).level(level).solve().expect("averaged");
        let at = |motion: &Motion| motion.at(777.0).expect("within the span").attitude;
        assert_eq!((at(&open), open.plan().error_bound()), (at(&asked), asked.plan().error_bound()), "{level}");
    }
}
