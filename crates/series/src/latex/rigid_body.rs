//! The normal form of the rigid body as LaTeX: a display that states what is expanded, then its series. Order 20 fills pages; use JSON to exchange normal forms.

use super::{Part, Series, fragment};
use crate::error::Error;
use crate::monomial::Monomial;
use crate::normal_form::NormalForm;
use crate::polynomial::Polynomial;
use crate::rigid_body::{PublicForm, Variable};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::Zero;

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
        match what {
            Part::Hamiltonian => self.hamiltonian_latex(),
            Part::Generator => self.generator_latex(),
            Part::Direct => self.transformation_latex(what, ["u", "U", "y"], ["u'", "U'", "y'"]),
            Part::Inverse => self.transformation_latex(what, ["u'", "U'", "y'"], ["u", "U", "y"]),
        }
    }

    fn hamiltonian_latex(&self) -> Result<String, Error> {
        let order = self.order();
        let head = format!(
            "\\[\nK = \\frac{{M^2}}{{2C}}\\Bigl[1 + \\gamma\\sum_{{n=0}}^{{{order}}} P_n(\\beta)\\,\\kappa^n\\sigma^{{n+1}}\\Bigr]\n\\]\n"
        );
        let polynomial = |n| {
            let real = self.triaxiality_polynomial(n)?.iter();
            let face = real.map(|(&l, c)| ((0, 0, l), Complex::new(c.clone(), BigRational::zero())));
            series(format!("P_{{{n}}}"), &face.collect(), ["", ""])
        };
        Ok(fragment(&head, &(0..=order).map(polynomial).collect::<Result<Vec<_>, Error>>()?))
    }

    fn generator_latex(&self) -> Result<String, Error> {
        let head = format!(
            "\\[\nS = \\sum_{{m=1}}^{{{}}} \\frac{{\\varepsilon^{{m-1}}}}{{(m-1)!}} S_m, \\qquad \\tau = \\frac{{\\alpha}}{{\\sqrt{{\\gamma}}\\,V}}\n\\]\n",
            self.order()
        );
        let generator = |m| series(format!("\\tau^{{-{m}}} S_{{{m}}}"), &self.generator(m)?, ["u", "U"]);
        Ok(fragment(&head, &(1..=self.order()).map(generator).collect::<Result<Vec<_>, Error>>()?))
    }

    fn transformation_latex(&self, what: Part, left: [&str; 3], right: [&str; 3]) -> Result<String, Error> {
        let order = self.order();
        let mut head = "\\begin{align*}\n".to_owned();
        let variables = [Variable::Coordinate, Variable::Momentum, Variable::Angle];
        for (position, variable) in variables.into_iter().enumerate() {
            let factor = if variable == Variable::Angle { "\\frac{1}{M}" } else { "" };
            let (new, old, name) = (left[position], right[position], variable.name());
            head += &format!("{new} &= {old} + {factor}\\sum_{{n=1}}^{{{order}}} \\tau^n\\,{name}_n, \\\\\n");
        }
        head.push_str("\\tau &= \\frac{\\alpha}{\\sqrt{\\gamma}\\,V}\n\\end{align*}\n");
        let mut all = Vec::new();
        for variable in variables {
            for n in 1..=order {
                let direct = what == Part::Direct;
                let face = if direct { self.direct(variable, n) } else { self.inverse(variable, n) }?;
                all.push(series(format!("{}_{{{n}}}", variable.name()), &face, [right[0], right[1]])?);
            }
        }
        Ok(fragment(&head, &all))
    }
}

/// A series in u, U and β. β stands before u and U, as in the printed tables.
fn series(name: String, face: &PublicForm, [u, momentum]: [&str; 2]) -> Result<Series<BigRational>, Error> {
    let terms = face.iter().map(|(&(j, k, l), c)| Ok((Monomial::new(&[j, k, l])?, c.clone())));
    let polynomial = Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?);
    let power = |(letter, exponent): (&str, u32)| match exponent {
        0 => String::new(),
        1 if letter.starts_with('\\') => format!("{letter}{{}}"),
        1 => letter.to_owned(),
        _ => format!("{letter}^{{{exponent}}}"),
    };
    let factors = |monomial: Monomial| {
        let [j, k, l] = [0, 1, 2].map(|slot| monomial.exponent(slot));
        [("\\beta", l), (u, j), (momentum, k)].map(power).concat()
    };
    let terms = polynomial.terms().map(|(monomial, c)| (c.clone(), factors(monomial))).collect();
    Ok(Series { name, terms })
}
