//! Prints the function in C99 with `math.h`.

use super::Source;
use super::program::{Function, Statement};
use super::text::expression;
use std::collections::BTreeSet;

pub(super) fn print(source: &Source) -> String {
    let mut text = String::from("/*\n");
    for line in &source.header {
        text += format!(" * {line}").trim_end();
        text.push('\n');
    }
    text += " */\n\n#include <math.h>\n\nstruct short_axis_rotation {\n";
    for name in source.results {
        text += &format!("    double {name};\n");
    }
    let arguments: Vec<String> = source.arguments.iter().map(|name| format!("double {name}")).collect();
    text += "};\n\nstruct short_axis_rotation short_axis_rotation(";
    text += &format!("{});\n\nstruct short_axis_rotation short_axis_rotation(", arguments.join(", "));
    text += &format!("{})\n{{\n", arguments.join(", "));
    let mut known = BTreeSet::new();
    for statement in &source.program.statements {
        text += &match statement {
            Statement::Comment(comment) => format!("    /* {comment} */\n"),
            Statement::Assignment(name, value) => {
                let declaration = if known.insert(name) { "double " } else { "" };
                format!("    {declaration}{name} = {};\n", expression(value, call))
            }
        };
    }
    text += "    struct short_axis_rotation result;\n";
    for name in source.results {
        text += &format!("    result.{name} = {name};\n");
    }
    text + "    return result;\n}\n"
}

fn call(function: Function, argument: &str) -> String {
    match function {
        Function::Sine => format!("sin({argument})"),
        Function::Cosine => format!("cos({argument})"),
        Function::SquareRoot => format!("sqrt({argument})"),
    }
}
