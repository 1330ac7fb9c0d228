//! Prints the function in Python with its module `math` only.

use super::Source;
use super::program::{Function, Statement};
use super::text::expression;

pub(super) fn print(source: &Source) -> String {
    let (first, rest) = source.header.split_first().map_or(("", &[][..]), |(first, rest)| (first.as_str(), rest));
    let mut text = format!("\"\"\"{first}\n");
    for line in rest {
        text += line;
        text.push('\n');
    }
    let arguments: Vec<String> = source.arguments.iter().map(|name| format!("{name}: float")).collect();
    text += &format!(
        "\"\"\"\n\nimport math\n\n\ndef short_axis_rotation({}) -> tuple[float, float, float, float, float]:\n",
        arguments.join(", ")
    );
    text += &format!("    \"\"\"Return ({}).\"\"\"\n", source.results.join(", "));
    for statement in &source.program.statements {
        text += &match statement {
            Statement::Comment(comment) => format!("    # {comment}\n"),
            Statement::Assignment(name, value) => format!("    {name} = {}\n", expression(value, call)),
        };
    }
    text + &format!("    return {}\n", source.results.join(", "))
}

fn call(function: Function, argument: &str) -> String {
    match function {
        Function::Sine => format!("math.sin({argument})"),
        Function::Cosine => format!("math.cos({argument})"),
        Function::SquareRoot => format!("math.sqrt({argument})"),
    }
}
