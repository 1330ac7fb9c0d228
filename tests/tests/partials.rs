//! Derivatives of attitude and rates against differences of a solution in multiple precision (tests/data/README.md).

use andoyer_propagate::{Body, Derivatives, Motion, Scene, State};
use serde_json::Value;

const REFERENCE: &str = include_str!("../data/partials.json");

struct Case {
    name: String,
    moments: [f64; 3],
    attitude: [f64; 4],
    rates: [f64; 3],
    states: Vec<(f64, [Derivatives; 2])>,
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|i| value[i].as_f64().expect("a number"))
}

fn cases() -> Vec<Case> {
    let file: Value = serde_json::from_str(REFERENCE).expect("JSON");
    let rows = |value: &Value| std::array::from_fn(|row| numbers(&value[row]));
    let state = |value: &Value| {
        (value["t"].as_f64().expect("a time"), [rows(&value["attitude"]), rows(&value["angular_velocity"])])
    };
    let case = |value: &Value| Case {
        name: value["name"].as_str().expect("a name").to_owned(),
        moments: numbers(&value["moments"]),
        attitude: numbers(&value["attitude0_xyzw"]),
        rates: numbers(&value["angular_velocity0"]),
        states: value["states"].as_array().expect("states").iter().map(state).collect(),
    };
    file.as_array().expect("cases").iter().map(case).collect()
}

fn motion(case: &Case) -> Motion {
    let state = State::new(0.0, case.attitude, case.rates).expect("a state");
    Scene::new(Body::new(case.moments).expect("a body"), state).solve().expect("a motion")
}

fn largest(matrix: &Derivatives) -> f64 {
    matrix.iter().flatten().fold(0.0, |most, entry| most.max(entry.abs()))
}

/// Largest difference, over the largest entry.
fn error(found: &Derivatives, expected: &Derivatives) -> f64 {
    let pairs = found.iter().flatten().zip(expected.iter().flatten());
    let most = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(found.iter().flatten().all(|entry| entry.is_finite()));
    most / largest(expected)
}

#[test]
fn derivatives_are_those_of_the_solution_in_multiple_precision() {
    for case in cases() {
        let motion = motion(&case);
        for (time, [attitude, rates]) in &case.states {
            let partials = motion.partials(*time).unwrap_or_else(|problem| panic!("{}: {problem}", case.name));
            let errors = [error(&partials.attitude, attitude), error(&partials.angular_velocity, rates)];
            println!("{:24} {time:12.4e}  {:8.1e} {:8.1e}", case.name, errors[0], errors[1]);
        }
    }
}
