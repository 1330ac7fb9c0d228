//! A Birkhoff normal form as text and as LaTeX. Floats are rounded to their significant digits.
//!
//! The rounding error of a sum is relative to its largest term. Within each degree, coefficients are printed to the twelfth digit of the largest coefficient,
//! and smaller coefficients are omitted. Exact numbers are printed unchanged.

use super::{AnglePart, BirkhoffNormalForm, PhaseSpace};
use crate::display::Harmonics;
use crate::error::Error;
use crate::harmonics;
use crate::latex::Part;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use std::collections::BTreeMap;

/// Number of digits of the largest coefficient of a degree.
const DIGITS: i32 = 12;
/// Number of terms in one line of LaTeX.
const TERMS: usize = 6;

/// Prints the normal form in the actions: `I_q` of a centre (q, p), `(q*p)` of a saddle, `(q*p + Q*P)` and `(q*P - Q*p)` of a quartet.
///
/// If it has resonant terms, the first line is in the complex variables `u_q`, `U_q` of the modes. The second line is in the actions and the resonant angles, with the
/// angle `phi_q` of a centre. If the terms of saddles or all terms of the centres are kept, the second line is in the real variables.
impl<R: RealField> std::fmt::Display for BirkhoffNormalForm<R> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let space = self.space();
        let complex = significant::<R>(&self.in_complex(), space);
        let real = |polynomial: &Polynomial<R>, names: &[String]| {
            let polynomial = significant::<R>(&polynomial.map(|c| R::complex(c.clone(), R::zero())), space);
            space.text::<R::Complex>(&polynomial, names)
        };
        if let Ok(actions) = self.in_actions() {
            return formatter.write_str(&real(&actions, &self.action_texts()));
        }
        formatter.write_str(&space.complex_text(&complex))?;
        match self.angles_of(&complex).ok().filter(|_| !self.resonances().keeps_centre()) {
            Some((mean, parts)) => {
                write!(formatter, "\n= {}", real(&mean, &self.action_texts()))?;
                parts.iter().try_for_each(|part| self.write_part(formatter, part))
            }
            None => {
                let names = space.owned_names();
                self.in_real().map_or(Ok(()), |polynomial| write!(formatter, "\n= {}", real(&polynomial, &names)))
            }
        }
    }
}

impl<R: RealField> BirkhoffNormalForm<R> {
    /// Writes the terms of one resonant angle, each with its sign: ` - 1/2*sqrt(2)*I_x*I_y^(1/2)*sin(2*phi_x - phi_y)`.
    fn write_part(&self, formatter: &mut std::fmt::Formatter<'_>, part: &AnglePart<R>) -> std::fmt::Result {
        let (names, angle) = (self.action_texts(), self.angle_text(&part.multiples));
        for (function, (monomial, c)) in
            part.cosine.terms().map(|term| ("cos", term)).chain(part.sine.terms().map(|term| ("sin", term)))
        {
            let twelve_digits = || R::from_float(rounded(c.to_float(), c.to_float().abs()));
            let (negative, magnitude) =
                if R::EPSILON > 0.0 { twelve_digits() } else { None }.as_ref().unwrap_or(c).literal();
            write!(formatter, " {} ", if negative { '-' } else { '+' })?;
            if magnitude != "1" {
                write!(formatter, "{magnitude}*")?;
            }
            if part.radicand != R::one() {
                write!(formatter, "sqrt({})*", part.radicand.literal().1)?;
            }
            for (slot, name) in names.iter().enumerate() {
                // The power of the square root of an action or, for a parameter, twice its power.
                let k = part.multiples.iter().take(self.modes().len()).nth(slot);
                let halves = 2 * u64::from(monomial.exponent(slot)) + k.map_or(0, |k| k.unsigned_abs());
                match (halves, halves % 2) {
                    (0, _) => {}
                    (2, _) => write!(formatter, "{name}*")?,
                    (_, 0) => write!(formatter, "{name}^{}*", halves / 2)?,
                    _ => write!(formatter, "{name}^({halves}/2)*")?,
                }
            }
            write!(formatter, "{function}({angle})")?;
        }
        Ok(())
    }

    /// k·φ + j·M as text: `2*phi_x - phi_y + M`.
    fn angle_text(&self, multiples: &[i64]) -> String {
        let (space, mut text) = (self.space(), String::new());
        let angles = space.names().into_iter().step_by(2).take(self.modes().len()).map(|name| format!("phi_{name}"));
        let angles: Vec<String> = angles.chain(space.driven().into_iter().map(str::to_owned)).collect();
        for (angle, &k) in multiples.iter().enumerate().filter(|(_, k)| **k != 0) {
            text += match (text.is_empty(), k < 0) {
                (true, _) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            let multiple = if k.abs() == 1 { String::new() } else { format!("{}*", k.abs()) };
            text += &format!("{multiple}{}", angles[angle]);
        }
        text
    }
}

/// Rounds the coefficients of each degree.
pub(crate) fn significant<R: RealField>(
    polynomial: &Polynomial<R::Complex>,
    space: &PhaseSpace,
) -> Polynomial<R::Complex> {
    if R::EPSILON == 0.0 {
        return polynomial.clone();
    }
    let degree = |monomial: Monomial| monomial.without(space.driven_slots()).total_degree();
    let mut largest = BTreeMap::<u32, f64>::new();
    for (monomial, c) in polynomial.terms() {
        let size = largest.entry(degree(monomial)).or_default();
        *size = size.max(super::mode::modulus::<R>(c));
    }
    let terms = polynomial.terms().map(|(monomial, c)| {
        let (re, im) = R::parts(c);
        let size = largest.get(&degree(monomial)).copied().unwrap_or_default();
        let rounded = |part: R| R::from_float(rounded(part.to_float(), size)).unwrap_or(part);
        (monomial, R::complex(rounded(re), rounded(im)))
    });
    Polynomial::from_terms(terms)
}

/// A float rounded to the twelfth digit of `largest`.
fn rounded(value: f64, largest: f64) -> f64 {
    let decimals = DIGITS - 1 - largest.log10().floor() as i32;
    if !value.is_finite() || !(-300..=300).contains(&decimals) {
        return value;
    }
    // Formatting as decimal text rounds correctly, and the nearest float of that text prints as the same decimal.
    let text = if decimals >= 0 {
        format!("{value:.*}", decimals as usize)
    } else {
        let unit = 10.0_f64.powi(-decimals);
        ((value / unit).round() * unit).to_string()
    };
    text.parse::<f64>().map_or(value, |value| if value == 0.0 { 0.0 } else { value })
}

impl<R: RealField> BirkhoffNormalForm<R> {
    /// A part of this normal form as LaTeX, for a document with `\usepackage{amsmath}`.
    ///
    /// The Hamiltonian is K in the actions, or in u and U if it has resonant terms. The generators are the functions S_m. The direct transformation gives the
    /// old variables in the new ones (with a prime), the inverse transformation the new ones in the old ones.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize};
    /// use andoyer_series::print::Part;
    /// use andoyer_series::num_rational::BigRational;
    /// let space = PhaseSpace::new(&[("q", "p")])?;
    /// let form = normalize(&space.parse::<BigRational>("(p^2 + q^2)/2 + q^4/4")?, 2, &space)?;
    /// assert!(form.to_latex(Part::Hamiltonian)?.contains("K &= I_{q} + \\frac{3}{8}I_{q}^{2}"));
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - degrees of a transformation that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn to_latex(&self, what: Part) -> Result<String, Error> {
        let space = self.space();
        let names = space.owned_names();
        let complex = |f: &Polynomial<R>| f.map(|c| R::complex(c.clone(), R::zero()));
        let line = |name: String, series, primed| Line::<R> { name, series, names: names.clone(), primed };
        let mut lines = Vec::new();
        match what {
            Part::Hamiltonian => {
                let (series, names) = match self.in_actions() {
                    Ok(actions) => (complex(&actions), self.action_texts()),
                    Err(Error::ResonantTerm { .. }) => (self.in_complex(), space.complex_names()),
                    Err(other) => return Err(other),
                };
                lines.push(Line { name: "K".to_owned(), series, names, primed: false });
            }
            Part::Generator => {
                for m in 1..=self.order() {
                    lines.push(line(format!("S_{{{m}}}"), complex(&self.generator(m)?), true));
                }
            }
            Part::Direct | Part::Inverse => {
                let direct = what == Part::Direct;
                for (slot, name) in names.iter().enumerate().take(2 * space.degrees_of_freedom()) {
                    let variable = Polynomial::variable(slot)?;
                    let image = if direct { self.direct(&variable) } else { self.inverse(&variable) }?;
                    lines.push(line(symbol(name, if direct { "" } else { "'" }), complex(&image), direct));
                }
            }
        }
        Ok(latex(space, &lines))
    }
}

/// `name` = `series`. If `primed`, its variables are the new ones.
pub(crate) struct Line<R: RealField> {
    pub(crate) name: String,
    pub(crate) series: Polynomial<R::Complex>,
    pub(crate) names: Vec<String>,
    pub(crate) primed: bool,
}

/// Series as LaTeX, for a document with `\usepackage{amsmath}`.
pub(crate) fn latex<R: RealField>(space: &PhaseSpace, lines: &[Line<R>]) -> String {
    let mut text = "\\begingroup\\allowdisplaybreaks\n".to_owned();
    for Line { name, series, names, primed } in lines {
        let harmonics = if *names == space.complex_names() { Harmonics::Complex } else { Harmonics::Real };
        let names = Names { names, driven: &space.driven(), harmonics, primed: *primed };
        align::<R>(&mut text, name, &significant::<R>(series, space), &names);
    }
    text + "\\endgroup\n"
}

/// The names of the variables of a series, the driven phases in the last slots, and whether the variables are the new ones.
struct Names<'a> {
    names: &'a [String],
    driven: &'a [&'a str],
    harmonics: Harmonics,
    primed: bool,
}

impl Names<'_> {
    /// The variables of a monomial.
    fn factors(&self, monomial: Monomial) -> String {
        let mut factors = String::new();
        for slot in (0..SLOTS).filter(|&slot| monomial.exponent(slot) > 0) {
            let Some(name) = self.names.get(slot) else {
                let name = self.driven.get(slot - self.names.len()).copied().unwrap_or_default();
                factors += &self.harmonics.latex(&symbol(name, ""), harmonics::signed(monomial.exponent(slot)));
                continue;
            };
            let base = factor(name, if self.primed { "'" } else { "" });
            factors += &match monomial.exponent(slot) {
                1 => base,
                exponent if self.primed => format!("{{{base}}}^{{{exponent}}}"),
                exponent => format!("{base}^{{{exponent}}}"),
            };
        }
        factors
    }
}

/// Writes one series, `name &= …`, in its own `align*`.
fn align<R: RealField>(text: &mut String, name: &str, polynomial: &Polynomial<R::Complex>, names: &Names) {
    *text += &format!("\\begin{{align*}}\n{name} &=");
    for (position, (monomial, c)) in polynomial.terms().enumerate() {
        if position > 0 && position % TERMS == 0 {
            text.push_str(" \\\\\n&\\quad {}");
        }
        let (negative, magnitude) = coefficient::<R>(c);
        text.push_str(match (position, negative) {
            (0, false) => " ",
            (0, true) => " -",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        let factors = names.factors(monomial);
        text.push_str(if magnitude == "1" && !factors.is_empty() { "" } else { &magnitude });
        text.push_str(&factors);
    }
    text.push_str(if polynomial.is_zero() { " 0\n\\end{align*}\n" } else { "\n\\end{align*}\n" });
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
