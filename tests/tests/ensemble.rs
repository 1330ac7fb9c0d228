//! Many bodies at once: the same bits as one by one, for any number of threads; bad members are named.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::ensemble::{MAX_THREADS, OnError};
use andoyer_propagate::verification::VerifyOptions;
use andoyer_propagate::{Body, Ensemble, Error, Method, Orbit, Scene, State};

const MEMBERS: usize = 500;
const LEVEL: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// Bodies and rates spread over all modes.
fn ensemble() -> Ensemble {
    let part = |k: usize, step: f64| (k as f64 * step).fract();
    let moments = (0..MEMBERS).map(|k| [0.55 + 0.4 * part(k, 0.618), 0.55 + 0.4 * part(k, 0.414), 1.0]).collect();
    let rates = (0..MEMBERS).map(|k| [part(k, 0.732) - 0.5, part(k, 0.236) - 0.5, part(k, 0.141)]).collect();
    Ensemble::new(moments, vec![LEVEL; MEMBERS], rates).expect("bodies and states")
}

fn motion(ensemble: &Ensemble, k: usize) -> andoyer_propagate::Motion {
    let state = State::new(0.0, ensemble.attitudes()[k], ensemble.angular_velocities()[k]).expect("a state");
    Scene::new(Body::new(ensemble.moments()[k]).expect("a body"), state).solve().expect("solved")
}

#[test]
fn members_are_what_they_are_alone_to_the_bit_for_any_number_of_threads() {
    let times = [-10.0, 0.0, 3.0, 1e6];
    let rows = MEMBERS * times.len();
    for threads in [1, 2, 3, 8] {
        let ensemble = ensemble().threads(threads);
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; rows], vec![[0.0; 3]; rows]);
        ensemble.samples_into(&times, &mut attitudes, &mut rates).expect("solved");
        let mut alone = vec![[0.0; 4]; rows];
        ensemble.attitudes_into(&times, &mut alone).expect("solved");
        assert_eq!(alone, attitudes);
        let (mut of_one, mut rates_of_one) = ([[0.0; 4]; 4], [[0.0; 3]; 4]);
        for k in 0..MEMBERS {
            motion(&ensemble, k).samples_into(&times, &mut of_one, &mut rates_of_one).expect("finite times");
            assert_eq!(of_one, attitudes[4 * k..4 * k + 4]);
            assert_eq!(rates_of_one, rates[4 * k..4 * k + 4]);
        }
    }
}

/// Bodies of every mode and of none, in an order that mixes them: a sphere, A = B, B = C, principal axes, at rest, on the separatrix and beside it.
fn mixed() -> Ensemble {
    const KINDS: [([f64; 3], [f64; 3]); 11] = [
        ([0.5, 0.75, 1.0], [0.1, 0.2, 1.0]),
        ([1.0, 1.0, 1.0], [0.1, 0.2, 1.0]),
        ([0.75, 0.75, 1.0], [0.3, 0.2, 1.0]),
        ([0.6, 1.0, 1.0], [0.7, 0.3, -0.2]),
        ([0.5, 0.75, 1.0], [0.0, 0.0, 1.0]),
        ([0.5, 0.75, 1.0], [0.0, 1.0, 0.0]),
        ([0.5, 0.75, 1.0], [0.0, 0.0, 0.0]),
        ([3.0, 4.0, 6.0], [2.0, 0.5, 1.0]),
        ([3.0, 4.0, 6.0], [2.0, 0.5, 1.000_000_000_1]),
        ([3.235, 3.0836, 1.0], [0.3, 0.2, -1.3]),
        ([0.5, 0.75, 1.0], [1e-160, 0.0, 1.0]),
    ];
    let kind = |k: usize| KINDS[(5 * k + k / 11) % 11];
    let (moments, rates) = (0..60).map(kind).unzip();
    Ensemble::new(moments, vec![LEVEL; 60], rates).expect("bodies and states")
}

#[test]
fn members_of_every_kind_side_by_side_are_what_they_are_alone_to_the_bit() {
    let ensemble = mixed();
    let times = [-10.0, 0.0, 3.0, 1e3];
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; 240], vec![[0.0; 3]; 240]);
    ensemble.samples_into(&times, &mut attitudes, &mut rates).expect("solved");
    let (mut of_one, mut rates_of_one) = ([[0.0; 4]; 4], [[0.0; 3]; 4]);
    for k in 0..60 {
        motion(&ensemble, k).samples_into(&times, &mut of_one, &mut rates_of_one).expect("finite times");
        assert_eq!((&of_one[..], &rates_of_one[..]), (&attitudes[4 * k..4 * k + 4], &rates[4 * k..4 * k + 4]), "{k}");
    }
}

#[test]
fn every_member_may_have_its_own_times() {
    let ensemble = ensemble();
    let times: Vec<f64> = (0..2 * MEMBERS).map(|k| 0.37 * k as f64).collect();
    let mut attitudes = vec![[0.0; 4]; 2 * MEMBERS];
    ensemble.attitudes_into(&times, &mut attitudes).expect("solved");
    let last: [f64; 4] =
        motion(&ensemble, MEMBERS - 1).at(times[2 * MEMBERS - 1]).expect("finite").attitude.coords.into();
    assert!((0..4).all(|i| (attitudes[2 * MEMBERS - 1][i] - last[i]).abs() < 1e-15));
    assert_eq!(ensemble.plans().expect("solved").len(), MEMBERS);
}

#[test]
fn bad_members_are_named_with_their_index_and_counted() {
    let mut moments = vec![[0.5, 0.75, 1.0]; 9];
    (moments[4], moments[7]) = ([0.1, 0.1, 1.0], [f64::NAN, 1.0, 1.0]);
    let error = Ensemble::new(moments, vec![LEVEL; 9], vec![[0.0, 0.1, 1.0]; 9]).expect_err("two bad members");
    let Error::Member { index: 4, others: 1, problem } = &error else { panic!("{error}") };
    assert!(matches!(**problem, Error::MomentsTriangle { .. }));
    assert!(error.to_string().starts_with("member 4: moments = "), "{error}");
    let short = Ensemble::new(vec![[1.0; 3]; 2], vec![LEVEL], vec![[0.0; 3]; 2]);
    assert!(matches!(short, Err(Error::Length { argument: "attitudes", found: 1, expected: 2 })));
}

#[test]
fn rows_that_fit_no_times_and_times_that_are_none_are_refused() {
    let ensemble = ensemble();
    let mut rows = vec![[0.0; 4]; 2 * MEMBERS];
    assert!(matches!(ensemble.attitudes_into(&[0.0; 3], &mut rows), Err(Error::Length { .. })));
    let error = ensemble.attitudes_into(&[0.0, f64::NAN], &mut rows).expect_err("no time");
    assert!(
        matches!(&error, Error::Member { index: 0, problem, .. } if matches!(**problem, Error::Time { index: 1, .. }))
    );
    let all_bad = ensemble.tolerance(0.0).plans();
    assert!(matches!(all_bad, Err(Error::Member { index: 0, .. })));
    let none = Ensemble::new(Vec::new(), Vec::new(), Vec::new()).expect("empty");
    assert!(none.is_empty() && none.attitudes_into(&[1.0], &mut []).is_ok());
}

#[test]
fn a_tolerance_and_a_number_of_threads_are_no_fault_of_a_member() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(ensemble().tolerance(value).validate(), Err(Error::Tolerance { .. })), "{value}");
    }
    for value in [0, MAX_THREADS + 1, usize::MAX] {
        let ensemble = ensemble().threads(value);
        assert!(matches!(ensemble.validate(), Err(Error::Threads { .. })));
        assert!(matches!(ensemble.plans(), Err(Error::Threads { value: found, .. }) if found == value));
    }
    assert!(ensemble().threads(MAX_THREADS).validate().is_ok());
}

/// Nine bodies that turn fast about their shortest axis, every third without an orbit.
fn disturbed() -> (Ensemble, Vec<Option<Orbit>>) {
    let orbit =
        |k: usize| Orbit::new(1e-3 * (1.0 + k as f64), 0.05).and_then(|orbit| orbit.plane(0.1 * k as f64, 0.2, 0.3));
    let orbits: Vec<_> = (0..9).map(|k| (k % 3 != 2).then(|| orbit(k).expect("an orbit"))).collect();
    let moments = (0..9).map(|k| [1.0, 1.02 + 0.001 * k as f64, 1.05]).collect();
    let ensemble = Ensemble::new(moments, vec![LEVEL; 9], vec![[0.01, 0.02, 1.0]; 9]).expect("bodies and states");
    (ensemble, orbits)
}

#[test]
fn members_under_orbits_have_the_bits_and_the_plan_of_their_scenes() {
    let (ensemble, orbits) = disturbed();
    let times = [-1e3, 0.0, 5e4];
    for given in [orbits.clone(), vec![orbits[0]], vec![None; 9], vec![None]] {
        let ensemble = ensemble.clone().orbits(given.clone()).expect("one each").span(-1e3, 1e5).threads(3);
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; 27], vec![[0.0; 3]; 27]);
        ensemble.samples_into(&times, &mut attitudes, &mut rates).expect("solved");
        for k in 0..9 {
            let state = State::new(0.0, LEVEL, ensemble.angular_velocities()[k]).expect("a state");
            let mut scene = Scene::new(Body::new(ensemble.moments()[k]).expect("a body"), state).span(-1e3, 1e5);
            if let Some(orbit) = given[k % given.len()] {
                scene = scene.orbit(orbit);
            }
            let motion = scene.solve().expect("solved");
            let (mut of_one, mut rates_of_one) = ([[0.0; 4]; 3], [[0.0; 3]; 3]);
            motion.samples_into(&times, &mut of_one, &mut rates_of_one).expect("finite times");
            assert_eq!((&of_one[..], &rates_of_one[..]), (&attitudes[3 * k..3 * k + 3], &rates[3 * k..3 * k + 3]));
            assert_eq!(ensemble.plans().expect("solved")[k], *motion.plan());
            assert_eq!(ensemble.motion(k).expect("solved").scene(), motion.scene());
        }
    }
}

#[test]
fn orbits_are_one_for_all_or_one_for_each_and_what_they_cannot_disturb_is_named() {
    let (ensemble, orbits) = disturbed();
    let wrong = ensemble.clone().orbits(orbits[..4].to_vec());
    assert!(matches!(wrong, Err(Error::Length { argument: "orbits", found: 4, expected: 9 })));
    let one = ensemble.clone().orbits(vec![orbits[0]]).expect("one for all");
    assert_eq!(one, ensemble.clone().orbits(vec![orbits[0]; 9]).expect("nine equal ones"));
    assert_eq!(ensemble, ensemble.clone().orbits(vec![None::<Orbit>; 9]).expect("none"));
    assert_ne!(one, ensemble);
    let mut strong = orbits;
    strong[4] = Some(Orbit::new(0.9, 0.0).expect("an orbit"));
    let problem = ensemble.orbits(strong).expect("nine").plans().expect_err("too fast an orbit");
    assert!(matches!(problem, Error::Member { index: 4, .. }), "{problem}");
}

#[test]
fn motions_under_a_torque_are_kept_and_not_those_of_other_options() {
    let rates = vec![[0.0, 0.01, 1.0], [0.0, 0.02, 1.0], [0.0, 1.0, 0.001]];
    let sun = Orbit::new(2e-3, 0.1).expect("an orbit");
    let ensemble = Ensemble::new(vec![[1.0, 1.02, 1.05]; 3], vec![[0.0, 0.0, 0.0, 1.0]; 3], rates).expect("members");
    let ensemble = ensemble.orbits(vec![Some(sun), None, Some(sun)]).expect("orbits").span(0.0, 1e3).tolerance(1e-6);
    let plans = |ensemble: &Ensemble| ensemble.plans().expect("plans");
    let keeps = |ensemble: &Ensemble, count: usize| {
        format!("{ensemble:?}").contains(&format!("kept: KeptMotions({count} results"))
    };
    let first = plans(&ensemble);
    // Those under a torque, once for all copies.
    assert!(keeps(&ensemble, 2) && keeps(&ensemble.clone().threads(1), 2), "{ensemble:?}");
    assert_eq!(plans(&ensemble.clone()), first);
    assert_eq!(ensemble.motion(2).expect("a motion").plan(), &first[2]);
    let shorter = ensemble.clone().span(0.0, 10.0);
    assert!(keeps(&shorter, 0), "{shorter:?}");
    assert_ne!(plans(&shorter)[0].error_bound(), first[0].error_bound());
    assert_eq!(plans(&ensemble.clone().tolerance(1e-7))[0].tolerance(), 1e-7);
    assert_eq!(plans(&ensemble), first);
}

/// Eleven bodies that theory does not serve: near a resonance with orbits of several eccentricities, one that hardly turns, a sphere, and one without an orbit.
fn integrated() -> Ensemble {
    let orbit = |e: f64| Orbit::new(0.5, e).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
    let orbits = (0..11).map(|k| (k != 4).then(|| orbit([0.0, 0.1, 0.6, 0.93][k % 4])));
    let moments = (0..11).map(|k| if k == 6 { [1.0; 3] } else { [0.5, 0.8 + 0.01 * k as f64, 1.0] });
    let rates = (0..11).map(|k| if k == 7 { [1e-6, 0.0, 0.0] } else { [0.1, 0.02 * k as f64, 0.6 + 0.3 * k as f64] });
    let ensemble = Ensemble::new(moments.collect(), vec![[0.1, -0.2, 0.3, 0.86_f64.sqrt()]; 11], rates.collect());
    let ensemble = ensemble.expect("members").epochs(vec![1.0]).expect("an epoch").tolerance(1e-10).span(-5.0, 30.0);
    ensemble.orbits(orbits.collect()).expect("orbits")
}

#[test]
fn integrated_members_have_the_bits_of_their_scenes() {
    let times = [-5.0, 0.0, 1.0, 17.0, 30.0];
    let sampled = |ensemble: &Ensemble| {
        let mut attitudes = vec![[0.0; 4]; 55];
        ensemble.attitudes_into(&times, &mut attitudes).expect("solved");
        attitudes
    };
    let ensemble = integrated();
    let rows = sampled(&ensemble.clone().threads(1));
    assert_eq!(rows, sampled(&ensemble.clone().threads(3)));
    for k in 0..11 {
        let motion = integrated().motion(k).expect("a motion");
        let alone = motion.scene().solve().expect("a motion");
        assert_eq!([alone.plan(), ensemble.motion(k).expect("a motion").plan()], [motion.plan(); 2]);
        assert_eq!(motion.plan().method() == Method::Integrated, k != 4 && k != 6, "{k}");
        // The fourth and the eighth pass a pericentre at 1/14 of the mean distance.
        assert!(motion.plan().error_bound() < if k % 4 == 3 { 1e-7 } else { 1e-10 }, "{k}: {}", motion.plan());
        for (time, row) in times.iter().zip(&rows[5 * k..]) {
            assert_eq!(motion.at(*time).expect("a time").attitude.coords.as_slice(), row, "{k} {time}");
            assert_eq!(alone.at(*time).expect("a time").attitude.coords.as_slice(), row, "{k} {time}");
        }
    }
}

#[test]
fn members_with_an_unknown_attitude_at_the_end_are_served_up_to_there() {
    // Tumbling in a plane that is chaotic: a Lyapunov time is about an orbit, 2π.
    let (moments, level) = (vec![[0.5, 0.8, 1.0]; 2], vec![LEVEL; 2]);
    let rates = vec![[0.01, 0.02, 1.0], [0.05, -0.03, 1.1]];
    let ensemble = Ensemble::new_or(moments, level, rates, OnError::Nan, &AtomicBool::new(false)).expect("members");
    let ensemble = ensemble.method(Method::Integrated).orbits(vec![Some(Orbit::new(1.0, 0.1).expect("an orbit"))]);
    let chaotic = ensemble.expect("an orbit for all").tolerance(1e-8).span(-20.0, 2000.0);
    let plans = chaotic.plans().expect("plans");
    let known = plans.iter().map(|plan| plan.known().expect("less than the span")).collect::<Vec<_>>();
    assert!(known.iter().all(|[first, last]| *first == -20.0 && 50.0 < *last && *last < 1000.0), "{known:?}");
    assert!(
        plans[0].error_bound() > 3.0
            && !plans[0].meets_tolerance()
            && plans[0].to_string().contains("beyond, nearby states have separated"),
        "{}",
        plans[0]
    );

    let times = [-20.0, 10.0, 50.0, known[0][1], known[0][1] + 1e-6, 2000.0];
    let mut attitudes = [[0.0; 4]; 12];
    let outcome = chaotic.attitudes_into(&times, &mut attitudes).expect("NaN where the attitude is unknown");
    assert_eq!(outcome.errors().iter().map(|(index, _)| *index).collect::<Vec<_>>(), [0, 1]);
    assert!(outcome.errors()[0].1.to_string().contains("nearby states separate"), "{}", outcome.errors()[0].1);
    let said = outcome.missed_tolerance().expect("all miss the tolerance");
    assert!(said.contains("; the attitudes of 2 members are unknown at the ends of their spans"), "{said}");
    assert!(attitudes[..4].iter().all(|row| row[3].is_finite()) && attitudes[4..6].iter().all(|row| row[3].is_nan()));
    let tolerant = chaotic.clone().tolerance(10.0).attitudes_into(&times, &mut [[0.0; 4]; 12]).expect("NaN");
    assert!(tolerant.missed_tolerance().is_some_and(|said| said.starts_with("2 of 2 members")));
    let verified = chaotic.motion(0).expect("a motion").verify(VerifyOptions::default()).expect("over what is known");
    assert_eq!((verified.times()[0], verified.times()[63]), (-20.0, known[0][1]));
    // The motion before is that of a shorter span.
    let shorter = chaotic.clone().span(-20.0, 50.0);
    let mut of_shorter = [[0.0; 4]; 6];
    shorter.attitudes_into(&times[..3], &mut of_shorter).expect("known");
    let apart = |one: &[f64; 4], other: &[f64; 4]| (0..4).map(|k| (one[k] - other[k]).abs()).fold(0.0, f64::max);
    assert!(attitudes[..3].iter().zip(&of_shorter).all(|(one, other)| apart(one, other) < 1e-8));

    let raised = Ensemble::from_scenes(vec![chaotic.scene(0)], OnError::Raise).expect("a scene");
    let error = raised.attitudes_into(&[10.0], &mut [[0.0; 4]]).expect_err("not the whole span");
    let Error::Member { problem, .. } = &error else { panic!("{error}") };
    assert!(matches!(**problem, Error::Unpredictable { known: [-20.0, last], .. } if last > 50.0), "{error}");
}
