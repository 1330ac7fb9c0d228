//! A function to be printed: its arguments, its results and its program.

use super::program::Program;

/// A function to be printed.
pub(crate) struct Routine {
    pub(crate) name: &'static str,
    /// One sentence of documentation.
    pub(crate) meaning: &'static str,
    pub(crate) arguments: Vec<Argument>,
    pub(crate) results: Results,
    pub(crate) program: Program,
}

/// An argument.
pub(crate) enum Argument {
    Number(&'static str),
    /// An array with its length.
    Array(&'static str, usize),
}

/// What a function returns.
pub(crate) enum Results {
    /// Numbers with their meanings: a struct in C and Rust, a tuple in Python.
    Record(Vec<(&'static str, &'static str)>),
    /// An array with its length. Its entries are the names `result_0`, `result_1` and so on of the program.
    Array(&'static str, usize),
}

impl Routine {
    /// The arguments as a list, each as `argument` writes it.
    pub(super) fn arguments(&self, argument: impl Fn(&Argument) -> String) -> String {
        self.arguments.iter().map(argument).collect::<Vec<_>>().join(", ")
    }
}

impl Results {
    /// The names in the program, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        match self {
            Self::Record(fields) => fields.iter().map(|(name, _)| (*name).to_owned()).collect(),
            Self::Array(_, length) => (0..*length).map(|i| format!("result_{i}")).collect(),
        }
    }
}
