//! A computation as a list of assignments. The printers print it, and its cost is counted.
//!
//! There are no loops, branches or tables: a value is a number, a name, an operation on two values or a call. A name may receive a new value (in Horner's rule
//! it does). Assignments that no result needs are removed, so that no compiler warns about them.

use std::collections::BTreeSet;
use std::ops::{Add, Div, Mul, Sub};

/// Number of coefficients in one statement of Horner's rule. With 17 digits each, the line has fewer than 120 characters.
const COEFFICIENTS_PER_STATEMENT: usize = 3;

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Sine,
    Cosine,
    SquareRoot,
}

impl Function {
    /// Its name, the same in every language.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Sine => "sin",
            Self::Cosine => "cos",
            Self::SquareRoot => "sqrt",
        }
    }
}

/// An operation on two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operator {
    Sum,
    Difference,
    Product,
    Quotient,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expression {
    Number(f64),
    Name(String),
    Operation(Operator, Box<Expression>, Box<Expression>),
    Call(Function, Box<Expression>),
}

/// The value of a name.
pub(crate) fn name(name: &str) -> Expression {
    Expression::Name(name.to_owned())
}

/// A function applied to a value.
pub(crate) fn call(function: Function, argument: Expression) -> Expression {
    Expression::Call(function, Box::new(argument))
}

macro_rules! operation {
    ($trait:ident, $method:ident, $operator:ident) => {
        impl<Other: Into<Expression>> $trait<Other> for Expression {
            type Output = Expression;

            fn $method(self, other: Other) -> Expression {
                Expression::Operation(Operator::$operator, Box::new(self), Box::new(other.into()))
            }
        }
    };
}

operation!(Add, add, Sum);
operation!(Sub, sub, Difference);
operation!(Mul, mul, Product);
operation!(Div, div, Quotient);

impl From<f64> for Expression {
    fn from(value: f64) -> Self {
        Expression::Number(value)
    }
}

impl Expression {
    /// Calls `visit` for this value and for every value inside it.
    pub(crate) fn walk(&self, visit: &mut dyn FnMut(&Expression)) {
        visit(self);
        match self {
            Expression::Number(_) | Expression::Name(_) => {}
            Expression::Operation(_, left, right) => {
                left.walk(visit);
                right.walk(visit);
            }
            Expression::Call(_, argument) => argument.walk(visit),
        }
    }
}

/// One line of a program.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Statement {
    Comment(String),
    Assignment(String, Expression),
}

/// How many operations of each kind a program has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cost {
    /// Additions and subtractions.
    pub(crate) additions: usize,
    pub(crate) multiplications: usize,
    pub(crate) divisions: usize,
    pub(crate) square_roots: usize,
    /// Sines and cosines.
    pub(crate) trigonometric: usize,
}

/// A list of statements.
#[derive(Clone, Debug, Default)]
pub(crate) struct Program {
    pub(crate) statements: Vec<Statement>,
}

impl Program {
    /// Adds a comment.
    pub(crate) fn comment(&mut self, text: &str) {
        self.statements.push(Statement::Comment(text.to_owned()));
    }

    /// Adds the assignment of a value to `target`.
    pub(crate) fn assign(&mut self, target: &str, value: Expression) {
        self.statements.push(Statement::Assignment(target.to_owned(), value));
    }

    /// Assigns Σ cᵢ `variable`ⁱ to `target`, lowest power first, where each cᵢ is a polynomial in `inner`. Returns false if there is no term.
    pub(crate) fn horner(&mut self, target: &str, variable: &str, inner: &str, coefficients: &[Vec<f64>]) -> bool {
        let mut pending: Option<Expression> = None;
        let mut length = 0;
        for (power, coefficient) in coefficients.iter().enumerate().rev() {
            let value = match coefficient[..] {
                [] => None,
                [number] => Some(Expression::Number(number)),
                _ => {
                    let rows: Vec<Vec<f64>> = coefficient.iter().map(|&c| vec![c]).collect();
                    self.horner("inner", inner, inner, &rows).then(|| name("inner"))
                }
            };
            let ends = matches!(value, Some(Expression::Name(_))); // "inner" is about to change
            let scaled = pending.map(|sum| sum * name(variable));
            pending = match (scaled, value) {
                (Some(scaled), Some(Expression::Number(0.0))) => Some(scaled),
                (Some(scaled), Some(value)) => Some(scaled + value),
                (scaled, value) => scaled.or(value),
            };
            length += 1;
            if (ends || length >= COEFFICIENTS_PER_STATEMENT || power == 0)
                && let Some(value) = pending
            {
                self.assign(target, value);
                (pending, length) = (Some(name(target)), 0);
            }
        }
        pending.is_some()
    }

    /// Removes the assignments that no result needs.
    pub(crate) fn keep_what_gives(&mut self, results: &[&str]) {
        let mut needed: BTreeSet<String> = results.iter().map(|&name| name.to_owned()).collect();
        let mut kept = Vec::new();
        for statement in self.statements.drain(..).rev() {
            if let Statement::Assignment(target, value) = &statement {
                if !needed.remove(target) {
                    continue;
                }
                value.walk(&mut |part| {
                    if let Expression::Name(name) = part {
                        needed.insert(name.clone());
                    }
                });
            }
            kept.push(statement);
        }
        kept.reverse();
        self.statements = kept;
    }

    /// Counts the operations.
    pub(crate) fn cost(&self) -> Cost {
        let mut cost = Cost::default();
        for statement in &self.statements {
            if let Statement::Assignment(_, value) = statement {
                value.walk(&mut |part| match part {
                    Expression::Operation(Operator::Sum | Operator::Difference, ..) => cost.additions += 1,
                    Expression::Operation(Operator::Product, ..) => cost.multiplications += 1,
                    Expression::Operation(Operator::Quotient, ..) => cost.divisions += 1,
                    Expression::Call(Function::SquareRoot, _) => cost.square_roots += 1,
                    Expression::Call(..) => cost.trigonometric += 1,
                    Expression::Number(_) | Expression::Name(_) => {}
                });
            }
        }
        cost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn horner_counts_one_multiplication_and_one_addition_a_power_and_skips_zeros() {
        let mut program = Program::default();
        assert!(program.horner("p", "s", "b", &[vec![1.0], vec![0.0], vec![3.0], vec![4.0], vec![5.0]]));
        let expected = Cost { additions: 3, multiplications: 4, ..Cost::default() };
        assert_eq!(program.cost(), expected);
        assert!(!program.horner("p", "s", "b", &[]));
    }

    #[test]
    fn what_no_result_needs_is_taken_out() {
        let mut program = Program::default();
        program.assign("idle", name("x") * 2.0);
        program.assign("p", name("x") + 1.0);
        program.assign("p", name("p") * name("p"));
        program.keep_what_gives(&["p"]);
        assert_eq!(program.statements.len(), 2);
        assert_eq!(program.cost(), Cost { additions: 1, multiplications: 1, ..Cost::default() });
    }
}
