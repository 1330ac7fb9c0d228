//! Series as LaTeX: one writer for all forms.
//!
//! The text is a fragment for a document with `\usepackage{amsmath}`: a head, then one `align*` for each series, in canonical order. Lines are broken at the text
//! width of the class article at 10 pt, by an estimate of the width of the letters. Displays may break across pages. A single term longer than a line has a line
//! of its own. [`rigid_body`] writes the normal form of the rigid body, `birkhoff/latex.rs` any other.

mod rigid_body;

use crate::error::Error;
use crate::real_field::RealField;
use std::str::FromStr;

/// Width available for the terms of a line, in points at 10 pt: the 345 of the class article minus the left side and the indent.
const LINE: usize = 285;
/// Widths in points, rounded up: a digit, a letter or digit in an exponent or an index, a letter, a sign with the space around it.
const DIGIT: usize = 5;
const SMALL: usize = 4;
const LETTER: usize = 7;
const SIGN: usize = 13;

/// A part of the normal form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// K, and the triaxiality polynomials P_n of the rigid body.
    Hamiltonian,
    /// The generating functions S_m.
    Generator,
    /// The old variables in the new ones.
    Direct,
    /// The new variables in the old ones.
    Inverse,
}

impl FromStr for Part {
    type Err = Error;

    /// Reads "hamiltonian", "generator", "direct" or "inverse".
    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "hamiltonian" => Ok(Part::Hamiltonian),
            "generator" => Ok(Part::Generator),
            "direct" => Ok(Part::Direct),
            "inverse" => Ok(Part::Inverse),
            _ => Err(Error::NameUnknown {
                what: "part",
                name: name.to_owned(),
                known: "\"hamiltonian\", \"generator\", \"direct\", \"inverse\"",
            }),
        }
    }
}

/// `name` = Σ coefficient · variables, with the names as LaTeX.
pub(crate) struct Series<R: RealField> {
    pub(crate) name: String,
    pub(crate) terms: Vec<(R::Complex, String)>,
}

/// A head and series as a fragment of a document.
pub(crate) fn fragment<R: RealField>(head: &str, series: &[Series<R>]) -> String {
    let mut text = format!("\\begingroup\\allowdisplaybreaks\n{head}");
    series.iter().for_each(|series| align(&mut text, series));
    text + "\\endgroup\n"
}

/// Writes one series in its own `align*`.
fn align<R: RealField>(text: &mut String, Series { name, terms }: &Series<R>) {
    *text += &format!("\\begin{{align*}}\n{name} &=");
    let mut taken = 0;
    for (position, (c, factors)) in terms.iter().enumerate() {
        let (negative, magnitude) = coefficient::<R>(c);
        let magnitude = if magnitude == "1" && !factors.is_empty() { "" } else { &magnitude };
        let width = SIGN + width(magnitude) + width(factors);
        if position > 0 && taken + width > LINE {
            text.push_str(" \\\\\n&\\quad {}");
            taken = 0;
        }
        taken += width;
        text.push_str(match (position, negative) {
            (0, false) => " ",
            (0, true) => " -",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        text.push_str(magnitude);
        text.push_str(factors);
    }
    text.push_str(if terms.is_empty() { " 0\n\\end{align*}\n" } else { "\n\\end{align*}\n" });
}

/// Estimated width of a product, in points. A command is a letter, but for fractions and for `\mathrm`, `\cos` and `\sin`, whose letters count.
fn width(text: &str) -> usize {
    if let Some((before, rest)) = text.split_once("\\frac{")
        && let Some((above, rest)) = rest.split_once("}{")
        && let Some((below, rest)) = rest.split_once('}')
    {
        return width(before) + SMALL + DIGIT * above.len().max(below.len()) + width(rest);
    }
    let plain = text.replace("\\mathrm", "").replace("\\cos", "cos").replace("\\sin", "sin");
    let (mut sum, mut raised, mut last) = (0, 0_usize, ' ');
    for (position, part) in plain.split('\\').enumerate() {
        let named = |letter: char| position > 0 && letter.is_ascii_alphabetic();
        let rest = part.trim_start_matches(named);
        let command = (rest.len() < part.len()).then_some('x');
        for letter in command.into_iter().chain(rest.chars()) {
            sum += match letter {
                '{' | '}' | '^' | '_' | ' ' => 0,
                _ if raised > 0 || letter == '\'' => SMALL,
                '+' | '-' => SIGN,
                _ if letter.is_ascii_alphabetic() => LETTER,
                _ => DIGIT,
            };
            match letter {
                '{' => raised += usize::from(raised > 0 || matches!(last, '^' | '_')),
                '}' => raised = raised.saturating_sub(1),
                _ => {}
            }
            last = letter;
        }
    }
    sum
}

/// A name as a LaTeX symbol. Greek letters are recognized by name. The text after an underscore, or the digits at the end, become an index.
pub(crate) fn symbol(name: &str, prime: &str) -> String {
    const GREEK: [&str; 24] = [
        "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu", "nu",
        "xi", "pi", "rho", "sigma", "tau", "phi", "chi", "psi", "omega", "Gamma", "Omega",
    ];
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let (stem, index) = match name.split_once('_') {
        Some((stem, index)) if !stem.is_empty() => (stem, index),
        _ => (stem, &name[stem.len()..]),
    };
    let stem = match stem {
        greek if GREEK.contains(&greek) => format!("\\{greek}{{}}"),
        single if single.chars().count() == 1 => single.to_owned(),
        word => format!("\\mathrm{{{}}}", word.replace('_', "\\_")),
    };
    let index = if index.is_empty() { String::new() } else { format!("_{{{}}}", index.replace('_', "\\_")) };
    format!("{stem}{index}{prime}")
}

/// Sign and magnitude of a complex number.
fn coefficient<R: RealField>(c: &R::Complex) -> (bool, String) {
    let (re, im) = R::parts(c);
    let imaginary = || {
        let size = number(&im);
        if size == "1" { "\\mathrm{i}\\,".to_owned() } else { format!("{size}\\mathrm{{i}}\\,") }
    };
    if im.is_zero() {
        (re.sign() < 0, number(&re))
    } else if re.is_zero() {
        (im.sign() < 0, imaginary())
    } else {
        let (sign, join) = (if re.sign() < 0 { "-" } else { "" }, if im.sign() < 0 { "-" } else { "+" });
        (false, format!("\\bigl({sign}{} {join} {}\\bigr)", number(&re), imaginary()))
    }
}

/// The magnitude of a number: a fraction, or a float with a power of ten.
fn number<R: RealField>(value: &R) -> String {
    let (_, text) = value.literal();
    if let Some((above, below)) = text.split_once('/') {
        return format!("\\frac{{{above}}}{{{below}}}");
    }
    let size = value.to_float().abs();
    if R::EPSILON == 0.0 || size == 0.0 || (1e-3..1e6).contains(&size) {
        return text;
    }
    let text = format!("{size:e}");
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{digits}\\cdot 10^{{{power}}}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex;
    use num_rational::BigRational;

    #[test]
    fn a_coefficient_has_its_sign_and_both_of_its_parts() {
        let rational = |numerator: i64, denominator: i64| BigRational::new(numerator.into(), denominator.into());
        let written = |re, im| coefficient::<BigRational>(&Complex::new(re, im));
        assert_eq!(written(rational(-1, 2), rational(0, 1)), (true, "\\frac{1}{2}".to_owned()));
        assert_eq!(written(rational(0, 1), rational(-1, 1)), (true, "\\mathrm{i}\\,".to_owned()));
        let both = |sign: &str, join: &str| format!("\\bigl({sign}\\frac{{1}}{{2}} {join} 3\\mathrm{{i}}\\,\\bigr)");
        assert_eq!(written(rational(1, 2), rational(3, 1)), (false, both("", "+")));
        assert_eq!(written(rational(-1, 2), rational(-3, 1)), (false, both("-", "-")));
    }

    #[test]
    fn a_width_counts_letters_exponents_and_the_longer_half_of_a_fraction() {
        assert_eq!(width("\\frac{15}{128}\\beta^{12}u'"), SMALL + 3 * DIGIT + LETTER + 2 * SMALL + LETTER + SMALL);
        assert_eq!(width("\\cos(2\\theta{})"), 3 * LETTER + 3 * DIGIT + LETTER);
        assert_eq!(width("\\mathrm{e}^{-2\\mathrm{i}M}"), LETTER + 4 * SMALL);
    }
}
