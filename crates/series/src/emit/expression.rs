//! The printing of expressions, which all languages share: operators, numbers and the order of evaluation.
//!
//! Numbers are printed with the fewest digits that are read back to the same bits. Sums and products associate to the left in all languages. Brackets are
//! printed only where the expression would be read differently without them. Every language therefore does the same operations in the same order.

use super::program::{Expression, Operator};

/// The function that writes a call in one language.
pub(super) type Call<'a> = &'a dyn Fn(&str, &str) -> String;

/// A value as text.
pub(super) fn expression(value: &Expression, call: Call<'_>) -> String {
    match value {
        Expression::Number(number) => format!("{number:?}"),
        Expression::Name(name) => name.clone(),
        Expression::Call(function, argument) => call(function.name(), &expression(argument, call)),
        Expression::Operation(Operator::Sum, left, right) if is_negative(right) => {
            format!("{} - {}", expression(left, call), expression(right, call).trim_start_matches('-'))
        }
        Expression::Operation(operator, left, right) => {
            let (symbol, own) = (symbol(*operator), rank(value));
            let left = bracketed(left, call, rank(left) < own);
            let right = bracketed(right, call, rank(right) <= own);
            format!("{left} {symbol} {right}")
        }
    }
}

fn bracketed(value: &Expression, call: Call<'_>, brackets: bool) -> String {
    let text = expression(value, call);
    if brackets { format!("({text})") } else { text }
}

fn is_negative(value: &Expression) -> bool {
    matches!(value, Expression::Number(number) if number.is_sign_negative())
}

fn symbol(operator: Operator) -> char {
    match operator {
        Operator::Sum => '+',
        Operator::Difference => '-',
        Operator::Product => '*',
        Operator::Quotient => '/',
    }
}

fn rank(value: &Expression) -> u8 {
    match value {
        Expression::Operation(Operator::Sum | Operator::Difference, ..) => 0,
        Expression::Operation(..) => 1,
        Expression::Number(_) | Expression::Name(_) | Expression::Call(..) => 2,
    }
}
