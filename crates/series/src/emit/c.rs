//! Prints C99.

use super::constant::Numbers;
use super::printer::{Printer, RoutinePrinter, marked};
use super::routine::{Argument, Results, Routine};

/// C99 with `math.h`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct C;

impl Printer for C {
    fn head(&self, lines: &[String]) -> String {
        format!("/*\n{} */\n", marked(lines, " * "))
    }

    fn comment(&self, text: &str) -> String {
        format!("/* {text} */")
    }

    fn declaration(&self, name: &str, value: &Numbers) -> String {
        let lengths: String = value.lengths().iter().map(|length| format!("[{length}]")).collect();
        format!("static const double {name}{lengths} = {};", value.text(['{', '}'], ""))
    }
}

impl RoutinePrinter for C {
    fn mathematics(&self) -> &'static str {
        "\n#include <math.h>\n"
    }

    fn call(&self, function: &str, argument: &str) -> String {
        format!("{function}({argument})")
    }

    fn assignment(&self, target: &str, value: &str, first: bool) -> String {
        format!("{}{target} = {value};", if first { "double " } else { "" })
    }

    fn unneeded(&self, argument: &str) -> Option<String> {
        Some(format!("(void){argument};"))
    }

    fn opening(&self, routine: &Routine) -> String {
        let name = routine.name;
        let arguments = routine.arguments(|argument| match argument {
            Argument::Number(name) => format!("double {name}"),
            Argument::Array(name, length) => format!("const double {name}[{length}]"),
        });
        let (record, signature) = match &routine.results {
            Results::Record(fields) => {
                let fields: String = fields.iter().map(|(field, _)| format!("    double {field};\n")).collect();
                (format!("\nstruct {name} {{\n{fields}}};\n"), format!("struct {name} {name}({arguments})"))
            }
            Results::Array(results, length) => {
                (String::new(), format!("void {name}({arguments}, double {results}[{length}])"))
            }
        };
        format!("{record}\n/* {} */\n{signature};\n{signature}\n{{\n", routine.meaning)
    }

    fn closing(&self, routine: &Routine) -> String {
        let names = routine.results.names();
        match &routine.results {
            Results::Record(_) => {
                let fields: String = names.iter().map(|name| format!("    result.{name} = {name};\n")).collect();
                format!("    struct {} result;\n{fields}    return result;\n}}\n", routine.name)
            }
            Results::Array(results, _) => {
                let entry = |(i, name): (usize, &String)| format!("    {results}[{i}] = {name};\n");
                names.iter().enumerate().map(entry).collect::<String>() + "}\n"
            }
        }
    }
}
