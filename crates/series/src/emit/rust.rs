//! Prints the function in Rust with its standard library only.

use super::Source;
use super::program::{Function, Statement};
use super::text::expression;

pub(super) fn print(source: &Source) -> String {
    let mut text = String::new();
    // There is no inner doc comment, so that the file can be a module or be included in one.
    for line in &source.header {
        text += format!("// {line}").trim_end();
        text.push('\n');
    }
    text += "\n/// What [`short_axis_rotation`] returns.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct ShortAxisRotation {\n";
    for (name, meaning) in source.results.iter().zip(source.meanings) {
        text += &format!("    /// {meaning}\n    pub {name}: f64,\n");
    }
    let arguments: Vec<String> = source.arguments.iter().map(|name| format!("{name}: f64")).collect();
    text +=
        "}\n\n/// The direct transformation and the frequencies; the head of this file says the rest.\n#[must_use]\n";
    text += &format!("pub fn short_axis_rotation({}) -> ShortAxisRotation {{\n", arguments.join(", "));
    for statement in &source.program.statements {
        text += &match statement {
            Statement::Comment(comment) => format!("    // {comment}\n"),
            Statement::Assignment(name, value) => format!("    let {name} = {};\n", expression(value, call)),
        };
    }
    text += &format!("    ShortAxisRotation {{\n        {},\n    }}\n}}\n", source.results.join(",\n        "));
    text
}

fn call(function: Function, argument: &str) -> String {
    let receiver = if argument.contains(' ') { format!("({argument})") } else { argument.to_owned() };
    match function {
        Function::Sine => format!("{receiver}.sin()"),
        Function::Cosine => format!("{receiver}.cos()"),
        Function::SquareRoot => format!("{receiver}.sqrt()"),
    }
}
