//! Data types as JSON: what is written is read back, and what is read is checked.

use andoyer_propagate::disturbers::DisturbingBody;
use andoyer_propagate::torques::Torque;
use andoyer_propagate::{Body, Method, Mode, Orbit, Plan, Sample, Scene, State};
use serde::Serialize;
use serde::de::DeserializeOwned;

fn back<T: Serialize + DeserializeOwned>(value: &T) -> T {
    let text = serde_json::to_string(value).expect("JSON");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn what_is_written_is_read_back() {
    let body = Body::new([0.5, 0.75, 1.0]).expect("a body").with_name("a box");
    let state = State::new(0.5, [0.1, 0.7, -0.1, 0.7], [0.2, 0.3, 1.1]).expect("a state");
    let orbit = Orbit::new(2e-3, 0.2).expect("an orbit").plane(0.1, 0.2, 0.3).expect("a plane");
    let torque = Torque::damping([[1e-3, 0.0, 0.0], [0.0, 2e-3, 0.0], [0.0, 0.0, 3e-3]]).expect("a torque");
    assert_eq!((back(&body), back(&state), back(&orbit), back(&torque)), (body.clone(), state, orbit, torque.clone()));
    assert_eq!(back(&DisturbingBody::from(orbit)), DisturbingBody::from(orbit));
    let scene = Scene::new(body, state).tolerance(1e-9).span(0.0, 100.0);
    assert_eq!(
        back(&scene.clone().orbit(orbit).torques([torque.clone()])),
        scene.clone().orbit(orbit).torques([torque])
    );
    let motion = scene.solve().expect("a motion");
    let sample = motion.at(7.5).expect("a sample");
    let (plan, again): (Plan, Sample) = (back(motion.plan()), back(&sample));
    assert_eq!((&plan, again), (motion.plan(), sample));
}

#[test]
fn names_are_those_of_texts() {
    for (mode, name) in [(Mode::ShortAxis, "short-axis"), (Mode::AtRest, "at-rest")] {
        assert_eq!((mode.to_string(), serde_json::to_value(mode).expect("a name")), (name.to_owned(), name.into()));
    }
    assert_eq!(serde_json::from_str::<Method>("\"closed\"").expect("a name"), "closed".parse().expect("a name"));
    let error = serde_json::from_str::<Method>("\"open\"").expect_err("no method").to_string();
    assert!(error.starts_with("unknown variant `open`, expected one of `auto`, `series`"), "{error}");
}

#[test]
fn what_no_body_can_have_is_refused() {
    let read = serde_json::from_str::<Body>(r#"{"moments": [1.0, 1.0, 2.5]}"#);
    let error = read.expect_err("no body").to_string();
    assert!(error.contains("the largest must not exceed the sum of the other two"), "{error}");
    let read =
        serde_json::from_str::<State>(r#"{"epoch": 0.0, "attitude": [0, 0, 0, 2], "angular_velocity": [0, 0, 1]}"#);
    assert!(read.expect_err("no state").to_string().starts_with("state.attitude: "));
}

/// What is solved once is shared between threads.
#[test]
fn public_types_are_send_and_sync() {
    fn both<T: Send + Sync>() {}
    both::<andoyer_propagate::Motion>();
    both::<andoyer_propagate::Ensemble>();
    both::<Scene>();
    both::<Plan>();
    both::<andoyer_propagate::Error>();
    both::<andoyer_series::NormalForm>();
    both::<andoyer_series::BirkhoffNormalForm<f64>>();
    both::<andoyer_series::periodic::DrivenNormalForm>();
    both::<andoyer_series::Error>();
    both::<andoyer_double::DoubleDouble>();
}
