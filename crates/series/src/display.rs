//! Canonical printing.
//!
//! Terms are printed in canonical order as `coefficient*variable^exponent*…`. Exact coefficients are printed as `p/q`, complex ones as `(p/q + r/s*i)`.
//! [`Polynomial::parse`] with the same names reads the text back. Exact coefficients are read back unchanged. Floats are printed with their shortest decimal,
//! and are read back with a rounding error at most.
//!
//! Forms in floats are printed with their significant digits only. The rounding error of a sum is relative to its largest term: within each degree,
//! coefficients are printed to the twelfth digit of the largest coefficient, and smaller coefficients are omitted.

use crate::coefficient::Coefficient;
use crate::harmonics;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::ops::Range;

/// Number of digits of the largest coefficient of a degree.
const DIGITS: i32 = 12;

/// A polynomial together with the names of its variables, ready to print.
pub struct Named<'a, C> {
    polynomial: &'a Polynomial<C>,
    names: &'a [&'a str],
    /// The number of driven phases, which are the last names, and what their slots mean.
    driven: (usize, Harmonics),
}

/// What j in the slot of a driven phase means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Harmonics {
    /// cos jM for j ≥ 0, sin |j|M for j < 0.
    Real,
    /// e^{ijM}.
    Complex,
}

impl Harmonics {
    /// A harmonic of the phase `name` as text; `j` is not 0.
    fn text(self, name: &str, j: i64) -> String {
        let (function, j) = match self {
            Harmonics::Real => (if j < 0 { "sin" } else { "cos" }, j.abs()),
            Harmonics::Complex => ("exp", j),
        };
        let multiple = match j {
            1 => String::new(),
            -1 => "-".to_owned(),
            _ => format!("{j}*"),
        };
        let unit = if self == Harmonics::Complex { "i*" } else { "" };
        format!("{function}({multiple}{unit}{name})")
    }

    /// A harmonic of the phase with this symbol as LaTeX; `j` is not 0.
    pub(crate) fn latex(self, symbol: &str, j: i64) -> String {
        let multiple = if j.abs() == 1 { String::new() } else { j.abs().to_string() };
        match self {
            Harmonics::Real => format!("\\{}({multiple}{symbol})", if j < 0 { "sin" } else { "cos" }),
            Harmonics::Complex => {
                let sign = if j < 0 { "-" } else { "" };
                format!("\\mathrm{{e}}^{{{sign}{multiple}\\mathrm{{i}}{symbol}}}")
            }
        }
    }
}

impl<C> Named<'_, C> {
    /// The same where the last `driven` names are driven phases.
    pub(crate) fn with_driven(self, driven: usize, harmonics: Harmonics) -> Self {
        Named { driven: (driven, harmonics), ..self }
    }
}

impl<C: Coefficient> Polynomial<C> {
    /// This polynomial with `names[slot]` for the variable of `slot`. A slot without a name is printed as `x0` … `x7`.
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// use num_rational::BigRational;
    /// let p = Polynomial::<BigRational>::parse("y/2 - x^2*y - 1", &["x", "y"])?;
    /// assert_eq!(p.display(&["x", "y"]).to_string(), "-1 + 1/2*y - x^2*y");
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    #[must_use]
    pub fn display<'a>(&'a self, names: &'a [&'a str]) -> Named<'a, C> {
        Named { polynomial: self, names, driven: (0, Harmonics::Real) }
    }
}

impl<C: Coefficient> fmt::Debug for Named<'_, C> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Named").field("polynomial", self.polynomial).field("names", &self.names).finish_non_exhaustive()
    }
}

impl<C: Coefficient> Display for Named<'_, C> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        if self.polynomial.is_zero() {
            return formatter.write_str("0");
        }
        for (position, (monomial, coefficient)) in self.polynomial.terms().enumerate() {
            let (negative, magnitude) = coefficient.literal();
            formatter.write_str(match (position, negative) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            })?;
            let mut separator = "";
            if magnitude != "1" || monomial.total_degree() == 0 {
                formatter.write_str(&magnitude)?;
                separator = "*";
            }
            for slot in (0..SLOTS).filter(|&slot| monomial.exponent(slot) > 0) {
                let (phases, harmonics) = self.driven;
                match self.names.get(slot) {
                    Some(name) if slot + phases >= self.names.len() => {
                        let j = harmonics::signed(monomial.exponent(slot));
                        write!(formatter, "{separator}{}", harmonics.text(name, j))?;
                        separator = "*";
                        continue;
                    }
                    Some(name) => write!(formatter, "{separator}{name}")?,
                    None => write!(formatter, "{separator}x{slot}")?,
                }
                if monomial.exponent(slot) > 1 {
                    write!(formatter, "^{}", monomial.exponent(slot))?;
                }
                separator = "*";
            }
        }
        Ok(())
    }
}

impl<C: Coefficient> fmt::Debug for Polynomial<C> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        write!(formatter, "Polynomial({})", self.display(&[]))
    }
}

/// Rounds the coefficients of each degree; slots of driven phases do not count.
pub(crate) fn significant<R: RealField>(
    polynomial: &Polynomial<R::Complex>,
    driven: Range<usize>,
) -> Polynomial<R::Complex> {
    if R::EPSILON == 0.0 {
        return polynomial.clone();
    }
    let degree = |monomial: Monomial| monomial.without(driven.clone()).total_degree();
    let mut largest = BTreeMap::<u32, f64>::new();
    for (monomial, c) in polynomial.terms() {
        let (size, (re, im)) = (largest.entry(degree(monomial)).or_default(), R::parts(c));
        *size = size.max(re.to_float().hypot(im.to_float()));
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
pub(crate) fn rounded(value: f64, largest: f64) -> f64 {
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
