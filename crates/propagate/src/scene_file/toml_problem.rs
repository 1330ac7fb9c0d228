//! Errors of a scene file, with file, key, value and bound.

use serde_path_to_error::Segment;
use toml::{Table, Value};

use super::refusal::Refusal;
use crate::error::{Error, Value as Fact};

/// The keys of times, which a file gives as numbers and not as dates.
const TIMES: [&str; 6] =
    ["epoch", "span", "periods.precession", "periods.rotation", "orbit.time_of_pericentre", "orbit.times"];

/// The error of a value that a scene cannot have.
pub(super) fn of_refusal(refusal: Refusal, file: &str, document: &Table) -> Error {
    let value = refusal.value.or_else(|| at(document, refusal.key.split('.')).map(fact));
    in_file(file, &refusal.key, refusal.problem, value, refusal.bound)
}

/// What serde refuses: an unknown or missing key, or a value of the wrong type.
pub(super) fn located(file: &str, document: &Table, error: &serde_path_to_error::Error<toml::de::Error>) -> Error {
    let message = error.inner().message();
    let mut keys: Vec<String> = Vec::new();
    for segment in error.path() {
        match segment {
            Segment::Map { key } => keys.push(key.clone()),
            // An element of a list is told by the list, but for the tables of orbits.
            Segment::Seq { .. } | Segment::Enum { .. } | Segment::Unknown => {}
        }
    }
    let quoted = |start: &str| message.strip_prefix(start).and_then(|rest| rest.split('`').next());
    let named = quoted("missing field `").or_else(|| quoted("unknown field `"));
    if let Some(key) = named.filter(|key| keys.last().is_none_or(|last| last != key)) {
        keys.push(key.to_owned());
    }
    let key = keys.join(".");
    if quoted("missing field `").is_some() {
        return of_refusal(Refusal::missing(&key), file, document);
    }
    let found = at(document, keys.iter().map(String::as_str));
    // toml tells a date as a string.
    let date = found.and_then(first_date).map(ToString::to_string);
    let value = found.map(fact);
    let (problem, bound) = message.split_once(", expected ").unwrap_or((message, "a value that a scene has"));
    let number = match bound {
        "f64" if TIMES.contains(&key.as_str()) => Some("a number of time units"),
        "f64" => Some("a number"),
        "usize" => Some("a whole number, 0 or more"),
        _ => None,
    };
    if let Some(number) = number {
        let problem = match date {
            Some(date) => problem.replace(&format!("string \"{date}\""), &format!("date {date}")),
            None => problem.to_owned(),
        };
        return in_file(file, &key, format!("must be {number}: {problem}"), value, Some(number.into()));
    }
    let problem = if problem == message { message.to_owned() } else { format!("{problem}, expected {bound}") };
    in_file(file, &key, problem, value, Some(bound.replace('`', "").into()))
}

/// A date, or the first one in a list.
fn first_date(value: &Value) -> Option<&Value> {
    match value {
        Value::Datetime(_) => Some(value),
        Value::Array(values) => values.iter().find(|value| value.is_datetime()),
        _ => None,
    }
}

/// The value of a key in nested tables.
fn at<'a, 'k>(document: &'a Table, mut keys: impl Iterator<Item = &'k str>) -> Option<&'a Value> {
    let first = document.get(keys.next()?)?;
    keys.try_fold(first, |value, key| value.get(key))
}

pub(super) fn in_file(file: &str, key: &str, problem: String, value: Option<Fact>, bound: Option<Fact>) -> Error {
    let (value, bound) = (value.map(Box::new), bound.map(Box::new));
    Error::SceneFile { file: file.to_owned(), key: key.to_owned(), problem, value, bound }
}

/// A value of the file as an error states it.
fn fact(value: &Value) -> Fact {
    let number = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    let list = || value.as_array()?.iter().map(number).collect::<Option<Vec<f64>>>();
    match value {
        Value::String(text) => text.into(),
        Value::Integer(whole) => Fact::Integer(*whole),
        Value::Float(number) => Fact::Number(*number),
        _ => list().map_or_else(|| value.to_string().into(), Fact::Numbers),
    }
}
