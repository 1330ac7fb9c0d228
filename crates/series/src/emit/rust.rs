//! Prints Rust.

use super::constant::Numbers;
use super::printer::{Printer, RoutinePrinter, marked};
use super::routine::{Argument, Results, Routine};

/// Rust with its standard library only.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Rust;

impl Printer for Rust {
    /// There is no inner doc comment, so that the file can be a module or be included in one.
    fn head(&self, lines: &[String]) -> String {
        marked(lines, "// ")
    }

    fn comment(&self, text: &str) -> String {
        format!("// {text}")
    }

    fn declaration(&self, name: &str, value: &Numbers) -> String {
        let array = |entry: String, length: &usize| format!("[{entry}; {length}]");
        let own = value.lengths().iter().rev().fold("f64".to_owned(), array);
        format!("const {name}: {own} = {};", value.text(['[', ']'], ""))
    }
}

impl RoutinePrinter for Rust {
    fn mathematics(&self) -> &'static str {
        ""
    }

    fn call(&self, function: &str, argument: &str) -> String {
        if argument.contains(' ') { format!("({argument}).{function}()") } else { format!("{argument}.{function}()") }
    }

    fn assignment(&self, target: &str, value: &str, _: bool) -> String {
        format!("let {target} = {value};")
    }

    fn unneeded(&self, argument: &str) -> Option<String> {
        Some(format!("let _ = {argument};"))
    }

    fn opening(&self, routine: &Routine) -> String {
        let name = routine.name;
        let arguments = routine.arguments(|argument| match argument {
            Argument::Number(name) => format!("{name}: f64"),
            Argument::Array(name, length) => format!("{name}: &[f64; {length}]"),
        });
        let (record, result) = match &routine.results {
            Results::Record(fields) => {
                let field = |(field, meaning): &(&str, &str)| format!("    /// {meaning}\n    pub {field}: f64,\n");
                let (own, fields) = (type_name(name), fields.iter().map(field).collect::<String>());
                let derived = "#[derive(Clone, Copy, Debug, PartialEq)]";
                (format!("\n/// What [`{name}`] returns.\n{derived}\npub struct {own} {{\n{fields}}}\n"), own)
            }
            Results::Array(_, length) => (String::new(), format!("[f64; {length}]")),
        };
        format!("{record}\n/// {}\n#[must_use]\npub fn {name}({arguments}) -> {result} {{\n", routine.meaning)
    }

    fn closing(&self, routine: &Routine) -> String {
        let names = routine.results.names();
        match &routine.results {
            Results::Record(_) => {
                format!("    {} {{\n        {},\n    }}\n}}\n", type_name(routine.name), names.join(",\n        "))
            }
            Results::Array(..) => format!("    [{}]\n}}\n", names.join(", ")),
        }
    }
}

/// The name of a function as that of a type: `two_words` becomes `TwoWords`.
fn type_name(name: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    name.split('_').map(capital).collect()
}
