//! Canonical printing.
//!
//! Terms are printed in canonical order as `coefficient*variable^exponent*…`. Exact coefficients are printed as `p/q`, complex ones as `(p/q + r/s*i)`.
//! [`Polynomial::parse`] with the same names reads the text back. Exact coefficients are read back unchanged. Floats are printed with their shortest decimal,
//! and are read back with a rounding error at most.

use crate::{Coefficient, Polynomial, SLOTS};
use std::fmt::{self, Display, Formatter};

/// A polynomial together with the names of its variables, ready to print.
pub struct Named<'a, C> {
    polynomial: &'a Polynomial<C>,
    names: &'a [&'a str],
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
        Named { polynomial: self, names }
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
                match self.names.get(slot) {
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
