//! Derivatives under torques: against variational equations in 80-bit reals (tests/reference/variation.py), and against differences of motions.

use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3};
use andoyer_propagate::partials::Parameter;
use andoyer_propagate::torques::{SourcePath, Torque, TorqueSource};
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State, TabulatedOrbit};
use serde_json::Value;

const REFERENCE: &str = include_str!("../data/variation.json");
/// Largest error of a column over its largest derivative, beside what rounding to doubles does to the true column (tests/data/README.md). Of 300 scenes the median error is 1e-14.
const ERROR: f64 = 1e-11;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("numbers").iter().map(|entry| entry.as_f64().expect("a number")).collect()
}

fn three(value: &[f64]) -> [f64; 3] {
    value.try_into().expect("three numbers")
}

/// The columns of the derivatives of attitude and rates: six rows of each.
fn columns(motion: &Motion, parameters: &[Parameter], time: f64) -> Vec<[f64; 6]> {
    let count = motion.parameter_names(parameters).expect("names").len();
    let [mut attitude, mut rates] = [0, 1].map(|_| vec![0.0; 3 * count]);
    motion.batch().partials_with_respect_to(parameters, &[time], &mut attitude, &mut rates).expect("derivatives");
    let row = |k: usize| if k < 3 { &attitude[k * count..] } else { &rates[(k - 3) * count..] };
    (0..count).map(|column| std::array::from_fn(|k| row(k)[column])).collect()
}

/// The error of attitude and of rates in a column, each over its largest derivative.
fn errors(found: &[f64; 6], expected: &[f64; 6]) -> [f64; 2] {
    let part = |first: usize| {
        let range = first..first + 3;
        let most = range.clone().map(|k| expected[k].abs()).fold(f64::MIN_POSITIVE, f64::max);
        range.map(|k| (found[k] - expected[k]).abs() / most).fold(0.0, |most: f64, x| if x <= most { most } else { x })
    };
    [part(0), part(3)]
}

/// The larger of both errors.
fn error(found: &[f64; 6], expected: &[f64; 6]) -> f64 {
    let [attitude, rates] = errors(found, expected);
    attitude.max(rates)
}

fn orbit(elements: &[f64]) -> Orbit {
    let [n, e, passage, tilt, node, argument, attraction] = elements else { panic!("{elements:?}") };
    let orbit = Orbit::new(*n, *e).and_then(|orbit| orbit.time_of_pericentre(*passage));
    orbit.and_then(|orbit| orbit.plane(*tilt, *node, *argument)?.attraction(*attraction)).expect("an orbit")
}

#[test]
fn derivatives_under_a_gravity_gradient_are_those_of_variational_equations_in_80_bits() {
    let scenes: Value = serde_json::from_str(REFERENCE).expect("JSON");
    let scenes = scenes.as_array().expect("scenes");
    assert_eq!(scenes.len(), 18);
    for value in scenes {
        let list = |name: &str| numbers(&value[name]);
        let [epoch, time] = ["epoch", "time"].map(|name| value[name].as_f64().expect("a time"));
        let attitude = list("attitude").try_into().expect("a quaternion");
        let state = State::new(epoch, attitude, three(&list("angular_velocity"))).expect("a state");
        let orbits: Vec<_> =
            value["orbits"].as_array().expect("orbits").iter().map(|elements| orbit(&numbers(elements))).collect();
        let mut parameters = Parameter::STATE_AND_BODY.to_vec();
        for body in 0..orbits.len() {
            parameters.extend([Parameter::Orbit(body), Parameter::Attraction(body)]);
        }
        let scene = Scene::new(Body::new(three(&list("moments"))).expect("a body"), state)
            .disturbing(orbits)
            .span(epoch.min(time), epoch.max(time))
            .method(Method::Integrated)
            .tolerance(1e-6);
        let found = columns(&scene.solve().expect("solved"), &parameters, time);
        let [rows, by_rounding] = ["derivatives", "by_rounding"]
            .map(|name| value[name].as_array().expect("rows").iter().map(numbers).collect::<Vec<_>>());
        for (column, found) in found.iter().enumerate() {
            let expected = std::array::from_fn(|k| rows[k][column]);
            for (part, error) in errors(found, &expected).into_iter().enumerate() {
                let allowed = ERROR + by_rounding[part][column];
                assert!(error <= allowed, "{}, column {column}: {error:e} of {allowed:e}", value["kind"]);
            }
        }
    }
}

const ATTITUDE: [f64; 4] = [0.1, 0.3, -0.2, 0.9];
const RATES: [f64; 3] = [0.3, 0.2, 0.5];

fn state(turn: Vector3<f64>, faster: Vector3<f64>) -> State {
    let attitude = UnitQuaternion::new_normalize(ATTITUDE.into()) * UnitQuaternion::from_scaled_axis(turn);
    State::new(0.5, attitude.coords.into(), (Vector3::from(RATES) + faster).into()).expect("a state")
}

/// The column of one parameter by a difference of sixth order of solved motions.
fn difference(step: f64, time: f64, scene: impl Fn(f64) -> Scene) -> [f64; 6] {
    let at = |step: f64| scene(step).tolerance(1e-14).solve().expect("solved").at(time).expect("a time");
    let origin = at(0.0).attitude;
    let mut sum = [0.0; 6];
    for (multiple, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
        for sign in [1.0, -1.0] {
            let sample = at(sign * multiple * step);
            let turned = (origin.inverse() * sample.attitude).scaled_axis();
            for k in 0..3 {
                sum[k] += sign * weight * turned[k] / (60.0 * step);
                sum[3 + k] += sign * weight * sample.angular_velocity[k] / (60.0 * step);
            }
        }
    }
    sum
}

fn integrated(body: [f64; 3], state: State) -> Scene {
    Scene::new(Body::new(body).expect("a body"), state).method(Method::Integrated).span(-10.0, 30.0)
}

#[test]
fn derivatives_by_the_elements_of_hyperbolas_circles_and_precessing_orbits_are_differences_of_motions() {
    // A hyperbola, an ellipse whose attraction is its mean motion's, and one with secular rates; each given with what is held.
    type Path = (&'static str, [f64; 6], [f64; 2], Option<f64>);
    let paths: [Path; 4] = [
        ("hyperbola", [0.2, 1.7, 3.0, 0.5, 0.4, 1.1], [0.0, 0.0], None),
        ("fraction", [0.2, 0.3, 3.0, 0.5, 0.4, 1.1], [0.0, 0.0], None),
        ("precessing", [0.2, 0.3, 3.0, 0.5, 0.4, 1.1], [0.01, -0.02], Some(0.03)),
        ("near a circle", [0.2, 0.02, 3.0, 0.5, 0.4, 1.1], [0.0, 0.0], Some(0.03)),
    ];
    for (name, elements, rates, attraction) in paths {
        let made = |[n, e, passage, tilt, node, argument]: [f64; 6]| {
            let orbit = Orbit::new(n, e)?.time_of_pericentre(passage)?.plane(tilt, node, argument)?;
            let orbit = orbit.secular_rates(rates[0], rates[1])?;
            attraction.map_or_else(|| orbit.mass_fraction(0.8), |attraction| orbit.attraction(attraction))
        };
        let scene = |elements: [f64; 6]| {
            integrated([0.5, 0.8, 1.0], state(Vector3::zeros(), Vector3::zeros()))
                .orbit(made(elements).expect("an orbit"))
        };
        let motion = scene(elements).tolerance(1e-6).solve().expect("solved");
        for time in [-9.0, 0.5, 28.0] {
            let found = columns(&motion, &[Parameter::Orbit(0)], time);
            for (element, found) in found.iter().enumerate() {
                let expected = difference(1e-3, time, |step| {
                    let mut changed = elements;
                    changed[element] += step * if element == 0 { 0.1 } else { 1.0 };
                    scene(changed)
                });
                let unit = if element == 0 { 10.0 } else { 1.0 };
                let expected = expected.map(|value| unit * value);
                let lost = if time == 0.5 { 0.0 } else { error(found, &expected) };
                assert!(lost <= 2e-8, "{name}, element {element} at {time}: {lost:e}");
                assert!(time != 0.5 || found.iter().all(|value| *value == 0.0), "{name}: {found:?} at the epoch");
            }
        }
    }
}

#[test]
fn derivatives_under_every_kind_of_torque_are_differences_of_motions() {
    let orbit = Orbit::new(0.3, 0.2).and_then(|orbit| orbit.plane(0.4, 0.1, 0.2)?.semi_major_axis(2.0));
    let source = TorqueSource::new("u", SourcePath::Orbit(orbit.expect("an orbit"))).falling(3.0, 1.5);
    let texts = ["0.1*u1*u2 + 0.02*w2", "0.05*u3^2*w1 - 0.01*w3^3", "0.03*u1"];
    let torques = [
        Torque::constant([0.01, -0.02, 0.015]),
        Torque::damping([[0.05, 0.01, 0.0], [0.0, 0.03, 0.0], [0.0, 0.0, 0.02]]),
        Torque::rotor([0.1, 0.05, -0.2]),
        Torque::polynomial(texts, vec![source]),
    ];
    let torques: Vec<_> = torques.into_iter().map(|torque| torque.expect("a torque")).collect();
    let moments = [0.5, 0.8, 1.0];
    let scene = |moments: [f64; 3], state: State| integrated(moments, state).torques(torques.clone());
    let still = Vector3::zeros();
    let motion = scene(moments, state(still, still)).tolerance(1e-6).solve().expect("solved");
    let found = columns(&motion, &Parameter::STATE_AND_BODY, 12.0);
    for (column, found) in found.iter().enumerate() {
        let axis = Vector3::ith(column % 3, 1.0);
        let expected = difference(1e-3, 12.0, |step| match column {
            0..3 => scene(moments, state(step * axis, still)),
            3..6 => scene(moments, state(still, step * axis)),
            _ => {
                let mut changed = moments;
                changed[column - 6] += step;
                scene(changed, state(still, still))
            }
        });
        let lost = error(found, &expected);
        assert!(lost <= 2e-8, "column {column}: {lost:e}");
    }
}

#[test]
fn far_from_the_epoch_of_an_averaged_motion_differences_are_near_the_variational_equations() {
    let orbit = Orbit::new(1e-3, 0.2).and_then(|orbit| orbit.plane(0.4, 0.1, 0.2)).expect("an orbit");
    let attitude = UnitQuaternion::new_normalize(ATTITUDE.into());
    let at = State::new(0.0, attitude.coords.into(), [0.01, 0.02, 1.0]).expect("a state");
    let time = 30_000.0;
    let scene =
        Scene::new(Body::new([1.0, 1.02, 1.05]).expect("a body"), at).orbit(orbit).span(0.0, time).tolerance(1e-3);
    let parameters = [&Parameter::STATE_AND_BODY[..], &[Parameter::Orbit(0), Parameter::Attraction(0)]].concat();
    let [averaged, integrated] =
        [Method::Closed, Method::Integrated].map(|method| scene.clone().method(method).solve().expect("solved"));
    let [found, expected] = [&averaged, &integrated].map(|motion| columns(motion, &parameters, time));
    for (column, (found, expected)) in found.iter().zip(&expected).enumerate() {
        let lost = error(found, expected);
        assert!(lost <= 1e-4 && (column >= 9 || lost <= 1e-5), "column {column}: {lost:e}");
    }
}

#[test]
fn parameters_that_a_scene_lacks_are_errors_that_name_them() {
    let free = Scene::new(Body::new([0.5, 0.8, 1.0]).expect("a body"), state(Vector3::zeros(), Vector3::zeros()));
    let refused = |scene: &Scene, parameter: Parameter| {
        let motion = scene.clone().tolerance(1e-6).solve().expect("solved");
        match motion.parameter_names(&[parameter]) {
            Err(Error::Parameter { value, bound }) => format!("{value}: {bound}"),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(&free, Parameter::Orbit(0)), "(\"orbit\", 0): absent in a scene without a disturbing body");
    let times: Vec<_> = (0..12).map(|k| f64::from(k) * 0.5).collect();
    let places: Vec<_> = times.iter().map(|t| [3.0 + 0.1 * t, 0.2 * t, 1.0]).collect();
    let table = TabulatedOrbit::new(times, places, 0.1).expect("a table");
    let tabulated = free.clone().disturbing([table]).span(0.5, 5.0);
    assert!(refused(&tabulated, Parameter::Attraction(0)).contains("not of a table"));
    let orbit = Orbit::new(1e-3, 0.1).expect("an orbit");
    let two = free.clone().disturbing([orbit, orbit]).span(0.0, 10.0);
    assert!(refused(&two, Parameter::Orbit(2)).contains("from 0 to 1"));
    let motion = two.tolerance(1e-6).solve().expect("solved");
    assert_eq!(motion.parameter_names(&[Parameter::Attraction(1)]).expect("a name"), ["attraction[1]"]);
    for (name, index) in [("orbit", None), ("mass", None), ("moments", Some(0))] {
        assert!(matches!(motion.parameter(name, index), Err(Error::Parameter { .. })), "{name} {index:?}");
    }
    assert_eq!(motion.parameter("attraction", Some(1)).expect("a parameter"), Parameter::Attraction(1));
}
