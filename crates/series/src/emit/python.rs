//! Prints Python.

use super::constant::Numbers;
use super::printer::{Printer, RoutinePrinter, marked};
use super::routine::{Argument, Results, Routine};

/// Python 3.9 or later with its module `math` only.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Python;

impl Printer for Python {
    fn head(&self, lines: &[String]) -> String {
        format!("\"\"\"{}\"\"\"\n", marked(lines, ""))
    }

    fn comment(&self, text: &str) -> String {
        format!("# {text}")
    }

    fn declaration(&self, name: &str, value: &Numbers) -> String {
        format!("{name} = {}", value.text(['(', ')'], ","))
    }
}

impl RoutinePrinter for Python {
    fn mathematics(&self) -> &'static str {
        "\nimport math\n"
    }

    fn call(&self, function: &str, argument: &str) -> String {
        format!("math.{function}({argument})")
    }

    fn assignment(&self, target: &str, value: &str, _: bool) -> String {
        format!("{target} = {value}")
    }

    fn unneeded(&self, _: &str) -> Option<String> {
        None
    }

    fn opening(&self, routine: &Routine) -> String {
        let arguments = routine.arguments(|argument| match argument {
            Argument::Number(name) => format!("{name}: float"),
            Argument::Array(name, _) => (*name).to_owned(),
        });
        let (result, meaning) = match &routine.results {
            Results::Record(fields) => (
                format!(" -> tuple[{}]", vec!["float"; fields.len()].join(", ")),
                format!("Return ({}).", routine.results.names().join(", ")),
            ),
            Results::Array(..) => (String::new(), routine.meaning.to_owned()),
        };
        format!("\n\ndef {}({arguments}){result}:\n    \"\"\"{meaning}\"\"\"\n", routine.name)
    }

    fn closing(&self, routine: &Routine) -> String {
        let names = routine.results.names().join(", ");
        match &routine.results {
            Results::Record(_) => format!("    return {names}\n"),
            Results::Array(..) => format!("    return [{names}]\n"),
        }
    }
}
