//! Where the formulas are weakest: inputs that were once wrong, each with what broke.

use andoyer_propagate::{Body, Error, Method, Mode, Motion, Orbit, Scene, State};
use andoyer_tests::{attitude_error, difference};

const LEVEL: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

fn scene(moments: [f64; 3], rates: [f64; 3]) -> Scene {
    Scene::new(Body::new(moments).expect("a body"), State::new(0.0, LEVEL, rates).expect("a state"))
}

fn start(motion: &Motion) -> ([f64; 4], [f64; 3]) {
    let epoch = motion.scene().state().epoch;
    let sample = motion.at(epoch).expect("finite");
    (sample.attitude.coords.into(), sample.angular_velocity.into())
}

#[test]
fn the_flip_of_the_middle_axis_happens_however_small_its_start() {
    // The series has none: a quadrature with too few nodes once gave σ/σ_sep = 6e-6 and an attitude off by 1.6 rad.
    for exponent in [3, 6, 9, 12, 20, 50, 100, 140] {
        let tilt = 10.0_f64.powi(-exponent);
        let scene = scene([1.0, 2.0, 3.0], [0.0, 1.0, tilt]);
        let refused = scene.clone().method(Method::Series).tolerance(1e-3).solve();
        assert!(matches!(refused, Err(Error::NearSeparatrix { ratio, .. }) if (0.9..=1.0).contains(&ratio)), "{tilt}");
        let motion = scene.solve().expect("closed form");
        let half_turn = std::f64::consts::PI / motion.frequencies().anomaly;
        // dℓ′/dt = (Mγ/C) agm: the time goes with the logarithm of the tilt, 1/√3 of it for these moments (M = 2, C = 3, γ = 1).
        let expected = 3.0_f64.sqrt() * 2.0 * (4.0 / (tilt * 3.0_f64.sqrt())).ln();
        assert!((half_turn / expected - 1.0).abs() < 2e-6, "{tilt}: {half_turn} for {expected}");
        // Halfway axis 3 has what axis 2 had (both energy and momentum tell how much), then axis 2 points the other way. The time itself is rounded.
        let rounding = 1e-14 + f64::EPSILON * half_turn;
        let rates: [f64; 3] = motion.at(0.5 * half_turn).expect("finite").angular_velocity.into();
        let energy = |w: [f64; 3]| w[0] * w[0] + 2.0 * w[1] * w[1] + 3.0 * w[2] * w[2];
        assert!((energy(rates) - 2.0).abs() < 1e-5 && rates[1].abs() < rounding, "{tilt}: {rates:?}");
        let rates: [f64; 3] = motion.at(half_turn).expect("finite").angular_velocity.into();
        assert!(difference(rates, [0.0, -1.0, tilt]) < rounding, "{tilt}: {rates:?}");
    }
}

#[test]
fn on_the_separatrix_the_middle_axis_is_approached_for_ever() {
    // C ω3² (C − B) = A ω1² (B − A), exactly; then g = (g1 sech λt, tanh λt, g3 sech λt) with λ = G1 G3 (1/A − 1/C)/M.
    for (sense, turned) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let rates = [0.75 * sense, 0.0, turned];
        let scene = scene([1.0, 2.0, 2.25], rates);
        let motion = scene.solve().expect("closed form");
        assert_eq!(
            (motion.plan().mode(), motion.plan().separatrix_ratio()),
            (Mode::Separatrix, 1.0),
            "{}",
            motion.plan()
        );
        let momentum = 5.625_f64.sqrt();
        let lambda = 0.75 * 2.25 / momentum * (1.0 - 1.0 / 2.25) * sense * turned;
        for time in [-1e9, -40.0, -3.0, 0.0, 0.1, 5.0, 1e3, 1e12] {
            let (sech, tanh) = ((lambda * time).cosh().recip(), (lambda * time).tanh());
            let found: [f64; 3] = motion.at(time).expect("finite").angular_velocity.into();
            let expected = [rates[0] * sech, 0.5 * momentum * tanh, rates[2] * sech];
            assert!(difference(found, expected) < 1e-14, "{time}: {found:?} for {expected:?}");
        }
        // It ends as rotation about axis 2, with M/B.
        let [early, late] = [1000.0, 1001.0].map(|time| motion.at(time).expect("finite").attitude);
        let turn = (early.inverse() * late).angle();
        assert!((turn - 0.5 * momentum).abs() < 1e-14, "{turn}");
        assert!(matches!(scene.method(Method::Series).solve(), Err(Error::Separatrix)));
    }
}

#[test]
fn sigma_next_to_the_separatrix_grows_to_that_of_the_separatrix() {
    let rest = |tilt: f64| {
        let motion = scene([1.0, 2.0, 3.0], [0.0, 1.0, tilt]).solve().expect("closed form");
        1.0 - motion.plan().separatrix_ratio()
    };
    // 1 − σ/σ_sep goes as (1−m) ln(1/(1−m)): four orders for each two of the tilt, and a little less.
    for tilt in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        let fall = rest(tilt) / rest(0.1 * tilt);
        assert!((50.0..100.0).contains(&fall), "{tilt}: {fall}");
    }
}

#[test]
fn a_wobble_whose_square_has_no_double_is_no_nan() {
    for moments in [[0.5, 0.75, 1.0], [0.8, 0.8, 1.0]] {
        for tilt in [1e-140, 1e-155, 1e-162, 1e-200, 1e-300, 5e-324] {
            let motion = scene(moments, [tilt, 0.5 * tilt, 1.0]).solve().expect("short-axis");
            let (attitude, rates) = start(&motion);
            assert!(attitude_error(attitude, LEVEL) < 1e-15, "{tilt}: {attitude:?}");
            assert!(difference(rates, [tilt, 0.5 * tilt, 1.0]) < 1e-15, "{tilt}: {rates:?}");
        }
    }
}

#[test]
fn the_initial_state_is_kept_as_beta_approaches_one() {
    // The short axis of the ellipse as a difference lost ε/√(1−β): 5e-10 at 1−β = 8e-16.
    for gap in [1e-3, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 4e-16] {
        for fraction in [0.01, 0.1, 0.3] {
            // G1 a share of its value on the separatrix, (a − b) g1² = b g3².
            let (first, second): (f64, f64) = (1.0, gap / (1.0 - gap));
            let g1 = fraction * (second / (first - second)).sqrt();
            let rates = [g1 / 0.5, 0.3 * g1, 1.0];
            let motion = scene([0.5, 1.0 - gap, 1.0], rates).solve().expect("short-axis");
            let (attitude, found) = start(&motion);
            let bound = motion.plan().error_bound();
            let error = attitude_error(attitude, LEVEL);
            assert!(error <= bound && bound <= 1e-12 + 2e-14, "1−β ≈ {gap}: {error}, bound {bound}");
            assert!(difference(found, rates) <= 2.0 * bound, "1−β ≈ {gap}: {found:?} for {rates:?}");
        }
    }
}

#[test]
fn a_time_since_the_epoch_that_no_double_holds_is_carried_in_two() {
    let body = Body::new([0.5, 0.75, 1.0]).expect("a body");
    let epoch = 2_451_545.1_f64;
    let (later, early) = (epoch + 1e9, epoch);
    let motion = |epoch| {
        let state = State::new(epoch, LEVEL, [0.1, 0.2, 1.0]).expect("a state");
        Scene::new(body.clone(), state).solve().expect("short-axis")
    };
    // The exact difference of the two doubles, which the plain subtraction rounds by up to 6e-8.
    let (whole, rest) = ((later - early).floor(), (later - (later - early).floor()) - early);
    let direct = motion(early).at(later).expect("finite");
    let first = motion(0.0).at(whole).expect("finite");
    let state = State { epoch: 0.0, attitude: first.attitude, angular_velocity: first.angular_velocity };
    let second = Scene::new(body, state).solve().expect("short-axis").at(rest).expect("finite");
    let error = attitude_error(direct.attitude.coords.into(), second.attitude.coords.into());
    assert!(error < 1e-12, "{error}");
}

#[test]
fn a_fixed_order_is_as_good_as_its_bound_says_and_the_bound_knows_the_span() {
    let fixed =
        |stop: f64| scene([0.5, 0.75, 1.0], [0.2, 0.3, 1.0]).order(2).span(0.0, stop).solve().expect("short-axis");
    let [near, far] = [fixed(1e2), fixed(1e4)].map(|motion| motion.plan().error_bound());
    assert!(far > 10.0 * near, "{near} {far}");
    let best = scene([0.5, 0.75, 1.0], [0.2, 0.3, 1.0]).solve().expect("short-axis");
    let error = |time: f64| {
        let [a, b] = [&fixed(1e2), &best].map(|motion| motion.at(time).expect("finite").attitude.coords.into());
        attitude_error(a, b)
    };
    assert!(error(1e2) <= near && error(1e4) <= far);
    assert!(fixed(1e2).plan().to_string().contains("is not met"));
    assert!(!best.plan().to_string().contains("is not met"));
}

#[test]
fn the_bound_of_a_fixed_order_over_a_long_span_adds_the_drifts_of_both_frequencies() {
    // With their difference instead of their sum it is below the error.
    let scenes = [
        ([0.692, 0.703, 1.0], [-0.097, 0.485, 0.252], 4),
        ([0.666, 0.718, 1.0], [0.526, 0.154, -0.095], 4),
        ([0.601, 0.623, 1.0], [0.359, 0.024, -0.292], 3),
    ];
    for (moments, rates, order) in scenes {
        let scene = scene(moments, rates).span(0.0, 1e5);
        let [fixed, best] = [scene.clone().order(order), scene].map(|scene| scene.solve().expect("short-axis"));
        let attitude = |motion: &Motion, time| motion.at(time).expect("finite").attitude.coords.into();
        let times = (0..200).map(|k| 9.9e4 + 5.0 * f64::from(k));
        let error = times.map(|time| attitude_error(attitude(&fixed, time), attitude(&best, time))).fold(0.0, f64::max);
        let bound = fixed.plan().error_bound();
        assert!((error..=2.5 * error).contains(&bound), "{moments:?}: {bound} for {error}");
    }
}

#[test]
fn next_to_the_separatrix_a_state_without_a_middle_rate_is_kept() {
    // For these moments axis 1 has √3 times the rate of axis 3 on the separatrix. The phase at the epoch is then 0.
    for excess in [1e-6, 1e-9, 1e-13, -1e-6, -1e-9, -1e-13] {
        let rates = [3.0_f64.sqrt() * (1.0 + excess), 0.0, 1.0];
        let (attitude, kept) = start(&scene([1.0, 2.0, 3.0], rates).solve().expect("closed form"));
        assert!(difference(kept, rates) < 1e-14 && attitude_error(attitude, LEVEL) < 1e-14, "{excess}: {kept:?}");
    }
}

#[test]
fn the_tolerance_that_a_refusal_of_the_series_quotes_is_accepted() {
    for rates in [[0.9, 0.0, 0.75], [0.95, 0.0, 0.72], [0.4, 0.9, 0.45], [0.97, 0.1, 0.7]] {
        let near = scene([0.5, 0.75, 1.0], rates).method(Method::Series);
        let Err(error) = near.clone().tolerance(1e-15).solve() else { panic!("{rates:?} is not refused") };
        let Error::NearSeparatrix { attainable, .. } = error else { panic!("{error}") };
        let text = error.to_string();
        let quoted = text.split("is good to ").nth(1).and_then(|rest| rest.split(" rad").next()).expect("a figure");
        let quoted: f64 = quoted.parse().expect("a number");
        assert!(quoted >= attainable);
        let motion = near.tolerance(quoted).solve().unwrap_or_else(|error| panic!("{quoted}: {error}"));
        assert!(motion.plan().error_bound() <= quoted, "{quoted}");
    }
}

#[test]
fn truncated_motions_still_have_unit_quaternions() {
    for order in [0, 1, 2, 3] {
        let motion = scene([0.5, 0.75, 1.0], [0.5, 0.6, 0.8]).tolerance(1e-2).order(order).solve().expect("short-axis");
        for time in [0.0, 1.0, 2.5, 7.0] {
            let norm = motion.at(time).expect("finite").attitude.coords.norm();
            assert!((norm - 1.0).abs() < 1e-15, "order {order} at {time}: {norm}");
        }
    }
    // A state put together by hand, off by as much as is accepted.
    let mut state = *scene([0.5, 0.75, 1.0], [0.1, 0.2, 1.0]).state();
    state.attitude = nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1.0 + 9e-7, 0.0, 0.0, 0.0));
    let motion = Scene::new(Body::new([0.5, 0.75, 1.0]).expect("a body"), state).solve().expect("short-axis");
    assert!((motion.at(3.0).expect("finite").attitude.coords.norm() - 1.0).abs() < 1e-15);
}

#[test]
fn quantities_that_have_no_double_are_an_error_and_large_ones_are_not_squared() {
    assert!(matches!(scene([0.5e200, 0.75e200, 1e200], [0.0, 0.0, 1e119]).solve(), Err(Error::Units { .. })));
    assert!(matches!(scene([0.5e-165, 0.75e-165, 1e-165], [0.0, 0.0, 1e-165]).solve(), Err(Error::Units { .. })));
    let motion = scene([0.5e160, 0.75e160, 1e160], [0.1, 0.2, 1.0]).solve().expect("short-axis");
    let [.., momentum, n] = motion.andoyer(0.0).expect("finite");
    assert!((n / momentum - 1.0 / (0.05_f64.powi(2) + 0.15_f64.powi(2) + 1.0).sqrt()).abs() < 1e-15, "{momentum} {n}");
    let small = scene([0.5e-165, 0.75e-165, 1e-165], [0.1, 0.2, 1.0]).solve().expect("short-axis");
    assert!(small.andoyer(0.0).expect("finite")[4] > 0.0);
    assert!(matches!(Body::new([1e-310, 1.0, 1.0]), Err(Error::MomentsRatio { .. })));
}

#[test]
fn a_spin_about_equal_greatest_moments_is_steady() {
    let motion = scene([0.5, 1.0, 1.0], [0.0, 0.3, 1.0]).solve().expect("steady");
    assert_eq!(motion.plan().mode(), Mode::PrincipalAxis);
    assert!(motion.plan().skipped()[0].contains("B = C"), "{:?}", motion.plan().skipped());
    assert_eq!(start(&motion).1, [0.0, 0.3, 1.0]);
    let tilted = scene([0.5, 0.75, 1.0], [0.0, 0.0, 1.0]).order(7).solve().expect("steady");
    assert!(tilted.plan().skipped()[1].contains("order 7"), "{:?}", tilted.plan().skipped());
    // The frequency of a wobble that is not there: γ M/C.
    let gamma = tilted.scene().body().gamma();
    assert!((tilted.frequencies().anomaly - gamma).abs() < 1e-15 && (gamma - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    assert!((tilted.scene().body().omega() - 3.0_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn andoyer_variables_keep_the_short_axis_for_any_order_of_the_moments() {
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    for axes in orders {
        let (moments, spin) = ([0.23, 0.96, 1.0], [0.05, 0.04, 1.2]);
        let mut placed = ([0.0; 3], [0.0; 3]);
        for (i, &axis) in axes.iter().enumerate() {
            placed.0[axis] = moments[i];
            placed.1[axis] = spin[i];
        }
        let [.., n] = scene(placed.0, placed.1).solve().expect("short-axis").andoyer(0.0).expect("finite");
        assert!((n - 1.2).abs() < 1e-14, "{axes:?}: N = {n}");
        let [.., n] = scene(placed.0, placed.1.map(|w| -w)).solve().expect("short-axis").andoyer(0.0).expect("finite");
        assert!((n + 1.2).abs() < 1e-14, "{axes:?}: N = {n}");
    }
}

#[test]
fn rates_as_large_as_doubles_go_give_numbers_or_an_error_next_to_the_separatrix() {
    // A time at a time, this mode has phases without a fused multiply-add, whose split products once overflowed above 2^996.
    for rate in [1e290, 1e299, 1e301, 1e302, 1e305] {
        let body = Body::new([1.0, 0.873_29, 0.898_4]).expect("a body");
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, rate * 1e-20, -rate]).expect("a state");
        let motion = match Scene::new(body, state).solve() {
            Ok(motion) => motion,
            Err(error) => {
                assert!(rate >= 1e305 && matches!(error, Error::Units { .. }), "{rate:e}: {error}");
                continue;
            }
        };
        for time in [0.0, 1.0 / rate, -3.0 / rate] {
            let sample = motion.at(time).expect("a phase");
            let mut numbers = sample.attitude.coords.iter().chain(&sample.angular_velocity);
            assert!(numbers.all(|number| number.is_finite()), "{rate:e} at {time:e}: {sample:?}");
        }
    }
}

#[test]
fn a_torque_in_a_unit_of_time_of_which_the_square_is_no_double_is_the_same() {
    // 2^-600 of the usual rates: n² is 0 in doubles.
    let at = |unit: f64, time: f64| {
        let body = Body::new([0.6, 0.8, 1.0]).expect("a body");
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0].map(|rate| rate * unit)).expect("a state");
        let orbit = Orbit::new(0.02 * unit, 0.1).and_then(|orbit| orbit.mass_fraction(0.5)).expect("an orbit");
        let scene = Scene::new(body, state).orbit(orbit).span(0.0, 300.0 / unit).method(Method::Closed);
        scene.solve().expect("solved").at(time / unit).expect("in the span").attitude
    };
    let small = 2.0_f64.powi(-600);
    for time in [10.0, 300.0] {
        let angle = at(1.0, time).angle_to(&at(small, time));
        assert!(angle <= 1e-14, "{angle:e}");
    }
}
