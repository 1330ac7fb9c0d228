//! Source text in C, Rust, Python and JavaScript: one printer a language.
//!
//! A [`Printer`] writes the head of a file and its constants. Inside the crate, the printers of C, Rust and Python also write functions whose body is a list
//! of assignments (`RoutinePrinter`, `routine`, `program`). The text is the same in every run and contains no date. Numbers are written with the fewest digits
//! that are read back to the same bits.
//!
//! ```
//! use andoyer_series::print::{C, Constant, Numbers, Printer, Python};
//! let rates = Constant { name: "RATES", comment: "Both rates.", value: Numbers::List(vec![0.5, 2.0]) };
//! assert_eq!(C.constant(&rates), "/* Both rates. */\nstatic const double RATES[2] = {0.5, 2.0};\n");
//! assert_eq!(Python.constant(&rates), "# Both rates.\nRATES = (0.5, 2.0)\n");
//! ```

mod c;
mod constant;
mod expression;
mod javascript;
pub(crate) mod program;
mod python;
pub(crate) mod routine;
mod rust;

use crate::Error;
pub use c::C;
pub use constant::{Constant, Numbers};
pub use javascript::JavaScript;
use program::Statement;
pub use python::Python;
use routine::Routine;
pub use rust::Rust;
use std::collections::BTreeSet;
use std::str::FromStr;

/// A language of the functions that [`NormalForm::to_code`](crate::NormalForm::to_code) and
/// [`BirkhoffNormalForm::to_code`](crate::BirkhoffNormalForm::to_code) write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Language {
    /// C99 with `math.h`.
    C,
    /// Rust with its standard library only.
    Rust,
    /// Python 3.9 or later with its module `math` only.
    Python,
}

impl Language {
    pub(crate) fn printer(self) -> &'static dyn RoutinePrinter {
        match self {
            Language::C => &C,
            Language::Rust => &Rust,
            Language::Python => &Python,
        }
    }
}

impl FromStr for Language {
    type Err = Error;

    /// Reads "c", "rust" or "python".
    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "c" => Ok(Language::C),
            "rust" => Ok(Language::Rust),
            "python" => Ok(Language::Python),
            _ => Err(Error::NameUnknown {
                what: "language",
                name: name.to_owned(),
                known: "\"c\", \"rust\", \"python\"",
            }),
        }
    }
}

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

    /// A function as text, with an empty line before it.
    fn routine(&self, routine: &Routine) -> String {
        let mut text = self.opening(routine);
        let mut known = BTreeSet::new();
        for statement in &routine.program.statements {
            let line = match statement {
                Statement::Comment(comment) => self.comment(comment),
                Statement::Assignment(target, value) => {
                    let value = expression::expression(value, &|function, argument| self.call(function, argument));
                    self.assignment(target, &value, known.insert(target))
                }
            };
            text += &format!("    {line}\n");
        }
        text + &self.closing(routine)
    }
}

/// The lines of a head with `mark` before each.
fn marked(lines: &[String], mark: &str) -> String {
    lines.iter().map(|line| format!("{mark}{line}").trim_end().to_owned() + "\n").collect()
}
