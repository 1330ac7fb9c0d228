//! Many bodies at once: the same bits as one by one, for any number of threads; bad members are named.

use andoyer_propagate::{Body, Ensemble, Error, MAX_THREADS, Scene, State};

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
