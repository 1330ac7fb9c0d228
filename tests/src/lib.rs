//! What the whole-project tests share: reference solutions and the distance between attitudes.

pub mod climb;
pub mod disturbed;
pub mod integration;
pub mod mean_wobble;
mod tuned;

use andoyer_propagate::Orbit;
use serde_json::Value;

/// A reference solution: a body, its state at t = 0, and what multiple precision says of later times.
#[derive(Debug)]
pub struct Case {
    /// Its name in the file.
    pub name: String,
    /// Moments about body axes 1, 2, 3.
    pub moments: [f64; 3],
    /// Attitude at t = 0, [x, y, z, w].
    pub attitude: [f64; 4],
    /// Angular velocity at t = 0, body components.
    pub angular_velocity: [f64; 3],
    /// Time, attitude and angular velocity, rounded to double.
    pub states: Vec<(f64, [f64; 4], [f64; 3])>,
}

/// The cases of a reference file's text.
///
/// # Panics
/// When the file is not what it should be: a test can't go on without it.
pub fn cases(text: &str) -> Vec<Case> {
    let file: Value = serde_json::from_str(text).expect("the reference file is JSON");
    file.as_array().expect("a list of cases").iter().map(case).collect()
}

/// The orbits of the cases of a gravity-gradient reference.
///
/// # Panics
/// For a text that is no such file.
pub fn orbits(reference: &str) -> Vec<Orbit> {
    let file: Value = serde_json::from_str(reference).expect("JSON");
    let orbit = |case: &Value| {
        let number = |key: &str| case["orbit"][key].as_f64().expect("a number");
        Orbit::new(number("mean_motion"), number("eccentricity"))
            .and_then(|orbit| orbit.plane(0.0, 0.0, number("pericentre_longitude")))
            .and_then(|orbit| orbit.time_of_pericentre(number("time_of_pericentre")))
            .expect("an orbit")
    };
    file.as_array().expect("cases").iter().map(orbit).collect()
}

fn case(value: &Value) -> Case {
    let states = value["states"].as_array().expect("states").iter();
    Case {
        name: value["name"].as_str().expect("a name").to_owned(),
        moments: numbers(&value["moments"]),
        attitude: numbers(&value["attitude0_xyzw"]),
        angular_velocity: numbers(&value["angular_velocity0"]),
        states: states
            .map(|s| (s["t"].as_f64().expect("t"), numbers(&s["attitude_xyzw"]), numbers(&s["angular_velocity"])))
            .collect(),
    }
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let number = |v: &Value| match v {
        Value::String(text) => text.parse().expect("a decimal"),
        other => other.as_f64().expect("a number"),
    };
    let list: Vec<f64> = value.as_array().expect("a list").iter().map(number).collect();
    list.try_into().expect("the right length")
}

/// Angle of the rotation from one attitude to another, in rad, without cancellation.
pub fn attitude_error(q: [f64; 4], reference: [f64; 4]) -> f64 {
    let dot: f64 = q.iter().zip(reference).map(|(a, b)| a * b).sum();
    let sign = dot.signum();
    let square: f64 = q.iter().zip(reference).map(|(a, b)| (a - sign * b).powi(2)).sum();
    4.0 * (0.5 * square.sqrt()).min(1.0).asin()
}

/// Largest difference of two vectors' components.
pub fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The equations of a document: the lines `name = expression` of its fenced blocks marked `equation`.
pub fn equations(document: &str) -> Vec<(String, String)> {
    let mut inside = false;
    let mut found = Vec::new();
    for line in document.lines() {
        if line.starts_with("```") {
            inside = line == "```equation";
        } else if inside && let Some((name, expression)) = line.split_once(" = ") {
            found.push((name.to_owned(), expression.to_owned()));
        }
    }
    found
}

/// The one equation of that name.
///
/// # Panics
/// When the document has none, or two.
pub fn equation(document: &str, name: &str) -> String {
    let mut found = equations(document).into_iter().filter(|(candidate, _)| candidate == name);
    let (_, expression) = found.next().unwrap_or_else(|| panic!("no equation {name}"));
    assert!(found.next().is_none(), "two equations {name}");
    expression
}

/// The Rust example of the project's README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// The example of the README of `andoyer-propagate`, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../crates/propagate/README.md")]
pub struct ReadmeOfPropagate;
