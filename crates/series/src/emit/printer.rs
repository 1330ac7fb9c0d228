//! What a language must be able to write: heads, constants and functions.

use std::collections::BTreeSet;

use super::constant::{Constant, Numbers};
use super::expression::expression;
use super::program::Statement;
use super::routine::Routine;

/// How a language writes the head and the constants of a file.
pub trait Printer {
    /// The comment at the head of a file.
    fn head(&self, lines: &[String]) -> String;

    /// A comment of one line, without the line end.
    fn comment(&self, text: &str) -> String;

    /// The declaration of a constant, without its comment.
    fn declaration(&self, name: &str, value: &Numbers) -> String;

    /// A constant with its comment.
    fn constant(&self, constant: &Constant) -> String {
        let comment = if constant.comment.is_empty() { String::new() } else { self.comment(constant.comment) + "\n" };
        format!("{comment}{}\n", self.declaration(constant.name, &constant.value))
    }
}

/// How a language writes a function.
pub(crate) trait RoutinePrinter: Printer {
    /// The text after the head that makes sine, cosine and square root available.
    fn mathematics(&self) -> &'static str;

    /// A call of `sin`, `cos` or `sqrt`.
    fn call(&self, function: &str, argument: &str) -> String;

    /// An assignment; `first` if the name had no value before.
    fn assignment(&self, target: &str, value: &str, first: bool) -> String;

    /// All that stands before the first statement: the type of the results, documentation and signature.
    fn opening(&self, routine: &Routine) -> String;

    /// All that stands after the last statement.
    fn closing(&self, routine: &Routine) -> String;

    /// The statement without which a compiler would warn about an argument that nothing needs.
    fn unneeded(&self, argument: &str) -> Option<String>;

    /// A function as text, with an empty line before it.
    fn routine(&self, routine: &Routine) -> String {
        let mut text = self.opening(routine);
        for line in routine.unneeded().into_iter().filter_map(|argument| self.unneeded(argument)) {
            text += &format!("    {line}\n");
        }
        let mut known = BTreeSet::new();
        for statement in &routine.program.statements {
            let line = match statement {
                Statement::Comment(comment) => self.comment(comment),
                Statement::Assignment(target, value) => {
                    let value = expression(value, &|function, argument| self.call(function, argument));
                    self.assignment(target, &value, known.insert(target))
                }
            };
            text += &format!("    {line}\n");
        }
        text + &self.closing(routine)
    }
}

/// The lines of a head with `mark` before each.
pub(super) fn marked(lines: &[String], mark: &str) -> String {
    lines.iter().map(|line| format!("{mark}{line}").trim_end().to_owned() + "\n").collect()
}
