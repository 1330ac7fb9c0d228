//! Series as LaTeX: one writer for all forms.
//!
//! The text is a fragment for a document with `\usepackage{amsmath}`: a head, then one `align*` for each series, in canonical order. Lines are broken at the text
//! width of the class article at 10 pt, by an estimate of the width of the letters. Displays may break across pages. A single term longer than a line has a line
//! of its own. [`rigid_body`] writes the normal form of the rigid body, [`part`] any other.

mod rigid_body;

use crate::birkhoff::PhaseSpace;
use crate::display::{Harmonics, significant};
use crate::error::Error;
use crate::harmonics;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;
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
struct Series<R: RealField> {
    name: String,
    terms: Vec<(R::Complex, String)>,
}

/// A head and series as a fragment of a document.
fn fragment<R: RealField>(head: &str, series: &[Series<R>]) -> String {
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

/// A part of a form with named variables: `kernel` is K with the names of its slots, `generator` one of a number, `image` the variable of a slot in the new
/// variables or, if not direct, in the old ones. New variables have a prime.
pub(crate) fn part<R: RealField>(
    (what, space, order): (Part, &PhaseSpace, usize),
    kernel: impl FnOnce() -> Result<(Polynomial<R::Complex>, Vec<String>), Error>,
    generator: impl Fn(usize) -> Result<Polynomial<R>, Error>,
    image: impl Fn(usize, bool) -> Result<Polynomial<R>, Error>,
) -> Result<String, Error> {
    let names = space.owned_names();
    let series = |name, f: &Polynomial<R::Complex>, names: &[String], primed| {
        let harmonics = if names == space.complex_names() { Harmonics::Complex } else { Harmonics::Real };
        let rounded = significant::<R>(f, space.driven_slots());
        Series::<R> {
            name,
            terms: rounded.terms().map(|(m, c)| (c.clone(), factors(m, space, names, harmonics, primed))).collect(),
        }
    };
    let real =
        |name, f: &Polynomial<R>, primed| series(name, &f.map(|c| R::complex(c.clone(), R::zero())), &names, primed);
    let all: Result<Vec<_>, Error> = match what {
        Part::Hamiltonian => kernel().map(|(k, names)| vec![series("K".to_owned(), &k, &names, false)]),
        Part::Generator => (1..=order).map(|m| Ok(real(format!("S_{{{m}}}"), &generator(m)?, true))).collect(),
        Part::Direct | Part::Inverse => {
            let direct = what == Part::Direct;
            let left = |slot: usize| symbol(&names[slot], if direct { "" } else { "'" });
            let image = |slot| Ok(real(left(slot), &image(slot, direct)?, direct));
            (0..2 * space.degrees_of_freedom()).map(image).collect()
        }
    };
    Ok(fragment("", &all?))
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

/// The variables of a monomial, those of a space or of the modes by `names`.
fn factors(monomial: Monomial, space: &PhaseSpace, names: &[String], harmonics: Harmonics, primed: bool) -> String {
    let power = |slot: usize, exponent: u32| match names.get(slot) {
        None => harmonics.latex(
            &symbol(space.driven().get(slot - names.len()).copied().unwrap_or_default(), ""),
            harmonics::signed(exponent),
        ),
        Some(name) => match (factor(name, if primed { "'" } else { "" }), exponent) {
            (base, 1) => base,
            (base, _) if primed => format!("{{{base}}}^{{{exponent}}}"),
            (base, _) => format!("{base}^{{{exponent}}}"),
        },
    };
    let powers = (0..SLOTS).map(|slot| (slot, monomial.exponent(slot))).filter(|&(_, exponent)| exponent > 0);
    powers.map(|(slot, exponent)| power(slot, exponent)).collect()
}

/// The action of a saddle or of a quartet in brackets, or a name, as LaTeX.
fn factor(name: &str, prime: &str) -> String {
    let Some(inner) = name.strip_prefix('(').and_then(|name| name.strip_suffix(')')) else {
        return symbol(name, prime);
    };
    let word = |word: &str| {
        if matches!(word, "+" | "-") {
            word.to_owned()
        } else {
            word.split('*').map(|name| symbol(name, prime)).collect()
        }
    };
    format!("({})", inner.split(' ').map(word).collect::<Vec<_>>().join(" "))
}

/// A name as a LaTeX symbol. Greek letters are recognized by name. The text after an underscore, or the digits at the end, become an index.
fn symbol(name: &str, prime: &str) -> String {
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
