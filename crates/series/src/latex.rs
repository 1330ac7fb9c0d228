//! The normal form as LaTeX.
//!
//! The text is a fragment for a document with `\usepackage{amsmath}`: first a display that states what is expanded, then one `align*` for each series, in
//! canonical order. Lines are broken at the text width of the class article at 10 pt, by an estimate of the width of the letters. Displays may break across
//! pages. A single term longer than a line, which occurs above order 30, has a line of its own. Order 20 fills pages; use JSON to exchange normal forms.

use crate::error::Error;
use crate::monomial::Monomial;
use crate::normal_form::NormalForm;
use crate::polynomial::Polynomial;
use crate::rigid_body::{PublicForm, Variable};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use std::str::FromStr;

/// Width available for the terms of a line, in points at 10 pt: the 345 of the class article minus the left side and the indent.
const LINE: usize = 285;
/// Widths in points, rounded up: a digit, a digit in an exponent, a letter, a sign with the space around it.
const DIGIT: usize = 5;
const SMALL_DIGIT: usize = 4;
const LETTER: usize = 7;
const SIGN: usize = 13;

/// A part of the normal form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// K and its triaxiality polynomials P_n.
    Hamiltonian,
    /// The generating functions S_m.
    Generator,
    /// The transformation of u, U and y to the new variables.
    Direct,
    /// The transformation of the new variables to u, U and y.
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

impl NormalForm {
    /// A part of this normal form as LaTeX.
    ///
    /// ```
    /// use andoyer_series::NormalForm;
    /// use andoyer_series::print::Part;
    /// let text = NormalForm::new(3)?.to_latex(Part::Hamiltonian)?;
    /// assert!(text.contains("P_{3} &= -\\frac{5}{8}\\beta^{2}"));
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - degrees of a transformation that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn to_latex(&self, what: Part) -> Result<String, Error> {
        let text = match what {
            Part::Hamiltonian => self.hamiltonian_latex(),
            Part::Generator => self.generator_latex(),
            Part::Direct => self.transformation_latex(what, ["u", "U", "y"], ["u'", "U'", "y'"]),
            Part::Inverse => self.transformation_latex(what, ["u'", "U'", "y'"], ["u", "U", "y"]),
        }?;
        Ok(format!("\\begingroup\\allowdisplaybreaks\n{text}\\endgroup\n"))
    }

    fn hamiltonian_latex(&self) -> Result<String, Error> {
        let order = self.order();
        let mut text = format!(
            "\\[\nK = \\frac{{M^2}}{{2C}}\\Bigl[1 + \\gamma\\sum_{{n=0}}^{{{order}}} P_n(\\beta)\\,\\kappa^n\\sigma^{{n+1}}\\Bigr]\n\\]\n"
        );
        for n in 0..=order {
            let real = self.triaxiality_polynomial(n)?.iter();
            let face = real.map(|(&l, c)| ((0, 0, l), Complex::new(c.clone(), BigRational::zero())));
            align(&mut text, &format!("P_{{{n}}}"), &face.collect(), ["", ""])?;
        }
        Ok(text)
    }

    fn generator_latex(&self) -> Result<String, Error> {
        let mut text = format!(
            "\\[\nS = \\sum_{{m=1}}^{{{}}} \\frac{{\\varepsilon^{{m-1}}}}{{(m-1)!}} S_m, \\qquad \\tau = \\frac{{\\alpha}}{{\\sqrt{{\\gamma}}\\,V}}\n\\]\n",
            self.order()
        );
        for m in 1..=self.order() {
            align(&mut text, &format!("\\tau^{{-{m}}} S_{{{m}}}"), &self.generator(m)?, ["u", "U"])?;
        }
        Ok(text)
    }

    fn transformation_latex(&self, what: Part, left: [&str; 3], right: [&str; 3]) -> Result<String, Error> {
        let order = self.order();
        let mut text = "\\begin{align*}\n".to_owned();
        let variables = [Variable::Coordinate, Variable::Momentum, Variable::Angle];
        for (position, variable) in variables.into_iter().enumerate() {
            let factor = if variable == Variable::Angle { "\\frac{1}{M}" } else { "" };
            let (new, old, name) = (left[position], right[position], variable.name());
            text += &format!("{new} &= {old} + {factor}\\sum_{{n=1}}^{{{order}}} \\tau^n\\,{name}_n, \\\\\n");
        }
        text.push_str("\\tau &= \\frac{\\alpha}{\\sqrt{\\gamma}\\,V}\n\\end{align*}\n");
        for variable in variables {
            for n in 1..=order {
                let direct = what == Part::Direct;
                let face = if direct { self.direct(variable, n) } else { self.inverse(variable, n) }?;
                align(&mut text, &format!("{}_{{{n}}}", variable.name()), &face, [right[0], right[1]])?;
            }
        }
        Ok(text)
    }
}

/// One series, `name &= …`, in its own `align*`.
fn align(text: &mut String, name: &str, face: &PublicForm, [u, momentum]: [&str; 2]) -> Result<(), Error> {
    let terms = face.iter().map(|(&(j, k, l), c)| Ok((Monomial::new(&[j, k, l])?, c.clone())));
    let polynomial = Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?);
    let names = [u, momentum, "\\beta"];
    *text += &format!("\\begin{{align*}}\n{name} &=");
    let mut taken = 0;
    for (position, (monomial, c)) in polynomial.terms().enumerate() {
        let width = width(monomial, c, &names);
        if position > 0 && taken + width > LINE {
            text.push_str(" \\\\\n&\\quad {}");
            taken = 0;
        }
        taken += width;
        let (negative, magnitude) = coefficient(c);
        text.push_str(match (position, negative) {
            (0, false) => " ",
            (0, true) => " -",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        let factors = product(monomial, &names);
        text.push_str(if magnitude == "1" && !factors.is_empty() { "" } else { &magnitude });
        text.push_str(&factors);
    }
    text.push_str(if polynomial.is_zero() { " 0\n\\end{align*}\n" } else { "\n\\end{align*}\n" });
    Ok(())
}

/// Estimated width of a term with its sign, in points.
fn width(monomial: Monomial, c: &Complex<BigRational>, names: &[&str; 3]) -> usize {
    let digits = |value: &BigRational| {
        let [above, below] = [value.numer(), value.denom()].map(|part| part.magnitude().to_string().len());
        if value.is_zero() { 0 } else { above.max(below) * DIGIT }
    };
    let factors = names.iter().enumerate().map(|(slot, name)| match monomial.exponent(slot) {
        0 => 0,
        exponent => LETTER + SMALL_DIGIT * (usize::from(name.ends_with('\'')) + exponent.to_string().len()),
    });
    SIGN + digits(&c.re) + digits(&c.im) + LETTER + factors.sum::<usize>()
}

fn product(monomial: Monomial, names: &[&str; 3]) -> String {
    let mut text = String::new();
    // β stands before u and U, as in the printed tables.
    for slot in [2, 0, 1].into_iter().filter(|&slot| monomial.exponent(slot) > 0) {
        text.push_str(names[slot]);
        match monomial.exponent(slot) {
            1 if names[slot].starts_with('\\') => text.push_str("{}"),
            1 => {}
            exponent => text.push_str(&format!("^{{{exponent}}}")),
        }
    }
    text
}

fn fraction(value: &BigRational) -> String {
    let value = value.abs();
    if value.denom().is_one() {
        value.numer().to_string()
    } else {
        format!("\\frac{{{}}}{{{}}}", value.numer(), value.denom())
    }
}

/// Sign and magnitude of a Gaussian rational.
fn coefficient(c: &Complex<BigRational>) -> (bool, String) {
    let imaginary =
        if c.im.abs().is_one() { "\\mathrm{i}".to_owned() } else { format!("{}\\mathrm{{i}}", fraction(&c.im)) };
    if c.im.is_zero() {
        (c.re.is_negative(), fraction(&c.re))
    } else if c.re.is_zero() {
        (c.im.is_negative(), format!("{imaginary}\\,"))
    } else {
        let signs = [c.re.is_negative(), c.im.is_negative()].map(|negative| if negative { "-" } else { "" });
        let join = if signs[1].is_empty() { "+" } else { "-" };
        (false, format!("\\bigl({}{} {join} {imaginary}\\bigr)", signs[0], fraction(&c.re)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coefficient_has_its_sign_and_both_of_its_parts() {
        let rational = |numerator: i64, denominator: i64| BigRational::new(numerator.into(), denominator.into());
        let written = |re, im| coefficient(&Complex::new(re, im));
        assert_eq!(written(rational(-1, 2), rational(0, 1)), (true, "\\frac{1}{2}".to_owned()));
        assert_eq!(written(rational(0, 1), rational(-1, 1)), (true, "\\mathrm{i}\\,".to_owned()));
        let both = |sign: &str, join: &str| format!("\\bigl({sign}\\frac{{1}}{{2}} {join} 3\\mathrm{{i}}\\bigr)");
        assert_eq!(written(rational(1, 2), rational(3, 1)), (false, both("", "+")));
        assert_eq!(written(rational(-1, 2), rational(-3, 1)), (false, both("-", "-")));
    }
}
