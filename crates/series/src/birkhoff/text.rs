//! A Birkhoff normal form as text and as LaTeX. Floats are rounded to their significant digits.

use super::{AnglePart, BirkhoffNormalForm};
use crate::display::{rounded, significant};
use crate::error::Error;
use crate::latex::Part;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;

/// Prints the normal form in the actions: `I_q` of a centre (q, p), `(q*p)` of a saddle, `(q*p + Q*P)` and `(q*P - Q*p)` of a quartet.
///
/// If it has resonant terms, the first line is in the complex variables `u_q`, `U_q` of the modes. The second line is in the actions and the resonant angles, with the
/// angle `phi_q` of a centre. If the terms of saddles or all terms of the centres are kept, the second line is in the real variables.
impl<R: RealField> std::fmt::Display for BirkhoffNormalForm<R> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let space = self.space();
        let complex = significant::<R>(&self.in_complex(), space.driven_slots());
        let real = |polynomial: &Polynomial<R>, names: &[String]| {
            let polynomial =
                significant::<R>(&polynomial.map(|c| R::complex(c.clone(), R::zero())), space.driven_slots());
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
        let kernel = || match self.in_actions() {
            Ok(actions) => Ok((actions.map(|c| R::complex(c.clone(), R::zero())), self.action_texts())),
            Err(Error::ResonantTerm { .. }) => Ok((self.in_complex(), self.space().complex_names())),
            Err(other) => Err(other),
        };
        let image = |slot, direct| {
            let variable = Polynomial::variable(slot)?;
            if direct { self.direct(&variable) } else { self.inverse(&variable) }
        };
        super::latex::part::<R>((what, self.space(), self.order()), kernel, |m| self.generator(m), image)
    }
}
