//! Reading and printing are inverse; hostile text is refused in bounded time.

use crate::strategies::{gaussian_polynomial, rational_polynomial};
use andoyer_series::error::ParseProblem;
use andoyer_series::{Error, Polynomial};
use num_complex::Complex;
use num_rational::BigRational;
use proptest::prelude::*;

const NAMES: [&str; 4] = ["x", "y_1", "β", "U"];

proptest! {
    #[test]
    fn what_is_printed_is_read_back(a in rational_polynomial(), b in gaussian_polynomial()) {
        prop_assert_eq!(Polynomial::parse(&a.display(&NAMES).to_string(), &NAMES)?, a);
        prop_assert_eq!(Polynomial::parse(&b.display(&NAMES).to_string(), &NAMES)?, b);
    }

    #[test]
    fn no_text_panics(text in "[-+*/^()0-9xi ]{0,40}") {
        let _ = Polynomial::<Complex<BigRational>>::parse(&text, &["x"]);
    }

    #[test]
    fn no_string_of_any_kind_panics(text in "\\PC{0,40}") {
        let _ = Polynomial::<BigRational>::parse(&text, &["x"]);
    }
}

fn canonical(text: &str) -> Result<String, Error> {
    Ok(Polynomial::<Complex<BigRational>>::parse(text, &["x", "y"])?.display(&["x", "y"]).to_string())
}

#[test]
fn precedence_is_that_of_arithmetic() -> Result<(), Error> {
    for (text, expected) in [
        ("1 + 2*x^2", "1 + 2*x^2"),
        ("-x^2", "-x^2"),
        ("(-x)^2", "x^2"),
        ("12/2/3*x", "2*x"),
        ("2 - 3 - 4", "-5"),
        ("--x - -y", "x + y"),
        ("(x + y)^2 - (x - y)^2", "4*x*y"),
        ("i^2", "-1"),
        ("1/(1 + i)", "(1/2 - 1/2*i)"),
        ("x/(2*i)", "-1/2*i*x"),
        ("x^0", "1"),
        ("0*x", "0"),
        ("0.1 + 1.50*x - 2.*y", "1/10 + 3/2*x - 2*y"),
        ("25e-1*x**2 + 1E+2 - 3e1*y", "100 - 30*y + 5/2*x^2"),
        ("123456789012345678901234567890/30", "4115226300411522630041152263"),
    ] {
        assert_eq!(canonical(text)?, expected, "{text}");
    }
    Ok(())
}

#[test]
fn decimals_of_floats_are_rounded_once() -> Result<(), Error> {
    // Digits and powers of ten below 2⁵³ are exact, so one division rounds.
    for (text, value) in
        [("0.1", 0.1), ("0.3", 0.3), (".5", 0.5), ("-.25e1", -2.5), ("6.02e23", 6.02e23), ("1.25e-3", 1.25e-3)]
    {
        assert_eq!(Polynomial::<f64>::parse(text, &[])?, Polynomial::constant(value), "{text}");
    }
    let infinite = Polynomial::<f64>::parse("1e309", &[]);
    assert!(matches!(infinite, Err(Error::Parse { problem: ParseProblem::TooLarge, .. })));
    Ok(())
}

#[track_caller]
fn assert_refused(text: &str, position: usize, problem: &ParseProblem) {
    match Polynomial::<BigRational>::parse(text, &["x", "y"]) {
        Err(Error::Parse { position: at, problem: found }) => {
            assert_eq!((at, &found), (position, problem), "{text:.40}")
        }
        other => panic!("{text:.40}: {other:?}"),
    }
}

#[test]
fn bad_text_is_refused_with_its_position() {
    assert_refused("", 0, &ParseProblem::UnexpectedEnd);
    assert_refused("x + ", 4, &ParseProblem::UnexpectedEnd);
    assert_refused("(x", 2, &ParseProblem::UnexpectedEnd);
    assert_refused("x^", 2, &ParseProblem::UnexpectedEnd);
    assert_refused("x y", 2, &ParseProblem::UnexpectedCharacter('y'));
    assert_refused("(x 1)", 3, &ParseProblem::UnexpectedCharacter('1'));
    assert_refused("x)", 1, &ParseProblem::UnexpectedCharacter(')'));
    assert_refused("x^-1", 2, &ParseProblem::UnexpectedCharacter('-'));
    assert_refused("x + é", 4, &ParseProblem::UnknownName("é".into()));
    assert_refused(".", 0, &ParseProblem::UnexpectedCharacter('.'));
    assert_refused("x*.y", 2, &ParseProblem::UnexpectedCharacter('.'));
    assert_refused("1.2.3", 3, &ParseProblem::UnexpectedCharacter('.'));
    assert_refused("2e+x", 1, &ParseProblem::UnexpectedCharacter('e'));
    assert_refused("x**", 3, &ParseProblem::UnexpectedEnd);
    assert_refused("x***2", 3, &ParseProblem::UnexpectedCharacter('*'));
    assert_refused("1e9999999", 9, &ParseProblem::TooLarge);
    assert_refused("1e-99999999999999999999", 23, &ParseProblem::TooLarge);
    assert_refused("2*z", 2, &ParseProblem::UnknownName("z".into()));
    assert_refused("2*i", 2, &ParseProblem::UnknownName("i".into())); // no imaginary unit among the rationals
    assert_refused("1/x", 2, &ParseProblem::DivisorNotConstant);
    assert_refused("1/(2 - 2)", 2, &ParseProblem::DivisorZero);
    assert_refused("x^1001", 2, &ParseProblem::ExponentTooLarge { bound: 1000 });
    assert_refused("x^99999999999999999999", 2, &ParseProblem::ExponentTooLarge { bound: 1000 });
}

#[test]
fn bad_lists_of_names_are_refused() {
    for names in [&["a", "b", "c", "d", "e", "f", "g", "h", "k"][..], &["x", "x"], &["x y"], &[""], &["2"]] {
        let refused = Polynomial::<f64>::parse("1", names);
        assert!(matches!(refused, Err(Error::Parse { problem: ParseProblem::UnusableName(_), .. })), "{names:?}");
    }
}

#[test]
fn hostile_text_neither_hangs_nor_overflows_the_stack() {
    let nested = "(".repeat(100_000);
    assert_refused(&nested, 100, &ParseProblem::TooDeep { bound: 100 });
    let signs = "-".repeat(100_000) + "x";
    assert!(Polynomial::<BigRational>::parse(&signs, &["x"]).is_ok());
    let names = ["a", "b", "c", "d", "e", "f", "g", "h"];
    let digits = "9".repeat(100_000);
    let tower = "2^1000^2".to_owned();
    let fractions: String = (1..20_000).map(|k| format!("1/{k} + ")).collect::<String>() + "1";
    let growth = "((((1+a)^30+b)^30+c)^30+d)^30".to_owned();
    for text in ["(a+b+c+d+e+f+g+h)^1000", "((2^1000)^1000)^1000", &digits, &growth, &fractions] {
        let refused = Polynomial::<BigRational>::parse(text, &names);
        assert!(
            matches!(refused, Err(Error::Parse { problem: ParseProblem::TooLarge, .. })),
            "{text:.40}: {refused:.40?}"
        );
    }
    assert!(matches!(
        Polynomial::<BigRational>::parse(&tower, &names),
        Err(Error::Parse { problem: ParseProblem::UnexpectedCharacter('^'), .. })
    ));
}

#[test]
fn a_function_and_a_product_without_its_sign_are_named() {
    let problem = |text: &str| match Polynomial::<BigRational>::parse(text, &["x"]) {
        Err(Error::Parse { position, problem }) => Some((position, problem)),
        _ => None,
    };
    let cosine = problem("1 - cos(x)");
    assert!(matches!(&cosine, Some((4, ParseProblem::Function(name))) if name == "cos"), "{cosine:?}");
    let text = cosine.map(|(_, problem)| problem.to_string()).unwrap_or_default();
    assert!(text.contains("expand it as a Taylor polynomial") && text.contains("degree N + 2"), "{text}");
    for text in ["0.5(x + 1)", "(1 + 0.5(x))", "x (x)", "(x)(x)"] {
        assert!(matches!(problem(text), Some((_, ParseProblem::ProductWithoutSign))), "{text}: {:?}", problem(text));
    }
    assert_eq!(ParseProblem::ProductWithoutSign.to_string(), "a factor in brackets needs * before it");
}
