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
mod printer;
pub(crate) mod program;
mod python;
pub(crate) mod routine;
mod rust;

use crate::error::Error;
pub use c::C;
pub use constant::{Constant, Numbers};
pub use javascript::JavaScript;
pub use printer::Printer;
use printer::RoutinePrinter;
pub use python::Python;
use routine::Routine;
pub use rust::Rust;
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
    /// A file: its head, with what is said of rights, and functions. `mathematical` if one of them calls sine, cosine or the square root.
    pub(crate) fn file(self, mut head: Vec<String>, mathematical: bool, routines: &[Routine]) -> String {
        let printer: &dyn RoutinePrinter = match self {
            Language::C => &C,
            Language::Rust => &Rust,
            Language::Python => &Python,
        };
        head.push("No rights are claimed in this file: do with it what you like.".to_owned());
        let mathematics = if mathematical { printer.mathematics() } else { "" };
        let routines: String = routines.iter().map(|routine| printer.routine(routine)).collect();
        printer.head(&head) + mathematics + &routines
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
