//! A function to be printed: its arguments, its results and its program.

use std::collections::BTreeSet;

use super::program::{Expression, Program, Statement};

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

impl Argument {
    fn name(&self) -> &'static str {
        match self {
            Self::Number(name) | Self::Array(name, _) => name,
        }
    }
}

impl Routine {
    /// The arguments that neither a statement nor a result needs.
    pub(super) fn unneeded(&self) -> Vec<&'static str> {
        let mut needed: BTreeSet<String> = self.results.names().into_iter().collect();
        for statement in &self.program.statements {
            if let Statement::Assignment(_, value) = statement {
                value.walk(&mut |part| {
                    if let Expression::Name(name) = part {
                        // An entry of an array needs the array.
                        needed.insert(name.split('[').next().unwrap_or(name).to_owned());
                    }
                });
            }
        }
        self.arguments.iter().map(Argument::name).filter(|name| !needed.contains(*name)).collect()
    }

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
