//! Bad input is a typed error that names the argument, its value and the bound: never a panic, never NaN.

use andoyer_propagate::error::{Kind, Value};
use andoyer_propagate::options::MAX_ORDER;
use andoyer_propagate::{Body, Error, Method, Motion, Scene, State};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;
const LEVEL: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

fn scene() -> Scene {
    let state = State::new(0.0, LEVEL, [0.1, 0.2, 1.0]).expect("a state");
    Scene::new(Body::new([0.5, 0.75, 1.0]).expect("a body"), state)
}

fn motion() -> Motion {
    scene().solve().expect("short-axis")
}

#[test]
fn moments_that_are_not_positive_and_finite_name_their_axis() {
    for bad in [0.0, -0.0, -1.0, NAN, INFINITY, -INFINITY] {
        for axis in 0..3 {
            let mut moments = [1.0, 1.0, 1.0];
            moments[axis] = bad;
            let error = Body::new(moments).expect_err("no body");
            assert!(matches!(error, Error::Moment { axis: found, .. } if found == axis), "{error}");
            assert!(error.to_string().starts_with(&format!("moments[{axis}] = {bad}")), "{error}");
        }
    }
}

#[test]
fn moments_against_the_triangle_inequality_are_refused_in_any_order_and_flat_bodies_are_not() {
    for moments in [[1.0, 1.0, 2.001], [2.001, 1.0, 1.0], [1e-30, 1e-30, 1.0], [1e300, 1e299, 1e308]] {
        let error = Body::new(moments).expect_err("no body");
        assert!(matches!(error, Error::MomentsTriangle { .. }), "{error}");
    }
    // 0.1 + 0.7 is below 0.8 in doubles: a disc in rounded decimals.
    for moments in [[0.1, 0.7, 0.8], [1.0, 1.0, 2.0], [1e307, 1e308, 1.05e308], [5e-324, 5e-324, 5e-324]] {
        assert!(Body::new(moments).is_ok(), "{moments:?}");
    }
}

#[test]
fn attitudes_that_are_no_rotation_are_refused_and_nearly_unit_ones_normalized() {
    for bad in
        [[0.0; 4], [NAN, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, INFINITY], [0.0, 0.0, 0.0, 1.000_002], [0.0, 0.0, 0.0, 0.5]]
    {
        let error = State::new(0.0, bad, [0.0; 3]).expect_err("no attitude");
        assert!(matches!(error, Error::Attitude { .. }), "{error}");
    }
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.000_000_9], [0.0; 3]).expect("within 1e-6");
    assert_eq!(state.attitude.coords.norm(), 1.0);
}

#[test]
fn numbers_of_a_scene_that_are_not_finite_are_refused() {
    for bad in [NAN, INFINITY, -INFINITY] {
        let error = State::new(0.0, LEVEL, [0.0, bad, 1.0]).expect_err("no rates");
        assert!(matches!(error, Error::AngularVelocity { axis: 1, .. }), "{error}");
        let error = State::new(bad, LEVEL, [0.0, 0.0, 1.0]).expect_err("no epoch");
        assert!(matches!(error, Error::Epoch { .. }), "{error}");
        let error = scene().span(0.0, bad).solve().expect_err("no span");
        assert!(matches!(error, Error::Span { .. }), "{error}");
        let error = motion().at(bad).expect_err("no time");
        assert!(matches!(error, Error::Time { index: 0, .. }), "{error}");
    }
    // A state put together by hand is checked when it is solved.
    let mut state = *scene().state();
    state.angular_velocity.x = NAN;
    let error = Scene::new(scene().body().clone(), state).solve().expect_err("no rates");
    assert!(matches!(error, Error::AngularVelocity { axis: 0, .. }), "{error}");
}

#[test]
fn tolerance_order_span_and_method_have_bounds() {
    for (bad, text) in
        [(0.0, "0"), (-1e-12, "-1e-12"), (NAN, "NaN"), (INFINITY, "inf"), (-1e300, "-1e300"), (-0.25, "-0.25")]
    {
        let error = scene().tolerance(bad).solve().expect_err("no tolerance");
        assert!(matches!(error, Error::Tolerance { .. }), "{error}");
        assert!(error.to_string().contains(&format!("tolerance = {text}:")), "{error}");
    }
    assert!(matches!(scene().order(MAX_ORDER + 1).solve(), Err(Error::Order { value: 61, bound: MAX_ORDER })));
    assert!(scene().order(MAX_ORDER).solve().is_ok());
    assert!(matches!(scene().span(1.0, 0.0).solve(), Err(Error::Span { .. })));
    assert!(matches!("elliptic".parse::<Method>(), Err(Error::Method { .. })));
    assert!(matches!(Body::named("vulcan"), Err(Error::UnknownBody { .. })));
}

#[test]
fn slices_of_the_wrong_length_are_refused_and_bad_times_name_their_index() {
    let motion = motion();
    let error = motion.attitudes_into(&[0.0, 1.0], &mut [[0.0; 4]]).expect_err("too short");
    assert!(matches!(error, Error::Length { argument: "out", found: 1, expected: 2 }), "{error}");
    let error = motion.samples_into(&[0.0], &mut [[0.0; 4]], &mut []).expect_err("too short");
    assert!(matches!(error, Error::Length { argument: "rates", .. }), "{error}");
    let error = motion.angular_velocities_into(&[0.0, NAN], &mut [[0.0; 3]; 2]).expect_err("NaN");
    assert!(matches!(error, Error::Time { index: 1, .. }), "{error}");
    assert!(motion.attitudes_into(&[], &mut []).is_ok());
}

#[test]
fn extreme_but_finite_times_give_unit_quaternions() {
    let motion = motion();
    for time in [1e15, -1e15, 5e-324, -0.0] {
        let sample = motion.at(time).expect("a finite time");
        assert!((sample.attitude.coords.norm() - 1.0).abs() < 1e-14, "{time}");
        assert!(sample.angular_velocity.iter().all(|w| w.is_finite()), "{time}");
    }
    assert!([1e17, -1e17, 1e300, f64::MAX].iter().all(|&time| matches!(motion.at(time), Err(Error::Time { .. }))));
}

#[test]
fn extreme_bodies_and_rates_solve_or_are_refused_without_nan() {
    let values = [5e-324, 1e-308, 1e-200, 1e-30, 1e-12, 1.0, 1e6, 1e60, 1e154, 1e307];
    for mass in values {
        for rate in values {
            for shape in [[1.0, 1.0, 1.0], [0.8, 0.8, 1.0], [0.5, 0.75, 1.0], [0.5, 1.0, 1.0], [1.0 - 1e-15, 1.0, 1.0]]
            {
                let Ok(body) = Body::new(shape.map(|m| m * mass)) else { continue };
                for direction in [[0.0, 0.0, 1.0], [1e-9, 0.0, 1.0], [0.1, 0.1, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
                {
                    let state = State::new(0.0, LEVEL, direction.map(|w| w * rate)).expect("finite");
                    match Scene::new(body.clone(), state).solve() {
                        Err(Error::NearSeparatrix { .. } | Error::Separatrix | Error::Units { .. }) => {}
                        Err(error) => panic!("{error}"),
                        Ok(motion) => {
                            let sample = motion.at((1.0 / rate).min(1e300)).expect("a finite time");
                            let finite = sample
                                .attitude
                                .coords
                                .iter()
                                .chain(sample.angular_velocity.iter())
                                .all(|c| c.is_finite());
                            assert!(finite, "{shape:?}·{mass} {direction:?}·{rate}: {sample:?} {motion:?}");
                            assert!(motion.plan().error_bound().is_finite());
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn motions_are_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Motion>();
    shared::<Scene>();
    shared::<Error>();
}

#[test]
fn an_error_is_a_value_with_its_kind_argument_value_and_bound() {
    let error = Body::new([1.0, -2.0, 1.0]).expect_err("no body");
    assert_eq!(error.clone(), error);
    assert_eq!((error.kind(), error.argument()), (Kind::Input, Some("moments")));
    assert_eq!(
        (error.value(), error.bound()),
        (Some(Value::Number(-2.0)), Some(Value::Text("positive and finite".into())))
    );

    let error = motion().at(1e18).expect_err("too far");
    assert_eq!((error.kind(), error.argument()), (Kind::Representation, Some("times")));
    assert_eq!(error.value(), Some(Value::Number(1e18)));
    assert_eq!(motion().at(NAN).expect_err("no time").kind(), Kind::Input);

    let error = Scene::parse_toml(
        "[body]\nmoments = [1, 2, 4]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]",
        "f",
    )
    .expect_err("no body");
    assert_eq!((error.kind(), error.argument()), (Kind::File, Some("body.moments")));
    assert_eq!(error.value(), Some(Value::Numbers(vec![1.0, 2.0, 4.0])));

    let error = andoyer_series::NormalForm::from_json("{").expect_err("no JSON");
    assert!(matches!(error, andoyer_series::Error::Json { line: 1, column: 1, .. }), "{error}");
    assert_eq!((error.clone(), error.kind()), (error, Kind::File));
}
