//! A driven normal form as source text, with the functions of [`BirkhoffNormalForm::to_code`](crate::BirkhoffNormalForm::to_code) and the time as their last argument.
//!
//! `from_normal` is the direct series. `to_normal` takes the deviation from the periodic motion to Floquet's frame first, then the inverse series.

use super::named::DrivenNormalForm;
use super::rows::row::Periodic;
use crate::birkhoff::code::{About, RESULT, renamed};
use crate::birkhoff::mode::real_in_complex;
use crate::emit::Language;
use crate::emit::program::Program;
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::triangle::quiet;

impl DrivenNormalForm {
    /// The source file of functions in `language` that evaluate this normal form.
    ///
    /// # Errors
    /// - degrees of a transformation that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn to_code(&self, language: Language) -> Result<String, Error> {
        let title = format!("Normal form of order {} about a periodic motion.", self.form().order());
        let (space, driven) = (self.space(), self.driven());
        let about = About { class: "DrivenNormalForm", title, timed: true, space, driven };
        let slots = 0..2 * space.degrees_of_freedom();
        let [mut from_normal, mut to_normal] = [Program::default(), Program::default()];
        let direct: Vec<_> = slots.clone().map(|slot| self.direct_series(slot)).collect::<Result<_, _>>()?;
        about.polynomials(&mut from_normal, &direct, RESULT);
        about.polynomials(&mut to_normal, &self.deviations()?, "z_");
        renamed(&mut to_normal, slots.end);
        let image = |slot| self.real_in_waves(&self.form().inverse_rows(&Polynomial::variable(slot)?, &mut quiet)?);
        let inverse: Vec<_> = slots.map(image).collect::<Result<_, Error>>()?;
        about.polynomials(&mut to_normal, &inverse, RESULT);
        about.file(language, self.form().modes(), [from_normal, to_normal], Some(self.form().frequencies.clone()))
    }

    /// The real variables of the modes in Floquet's frame, as linear forms in the old ones.
    fn deviations(&self) -> Result<Vec<Polynomial<f64>>, Error> {
        let deviations = self.form().motion.deviations()?;
        let replacements: Vec<_> = deviations.iter().enumerate().collect();
        let real =
            |form: &Polynomial<_>| self.in_waves(&form.map(|&c| Periodic::Constant(c)).compose(&replacements, None)?);
        real_in_complex(self.form().modes())?.iter().map(real).collect()
    }
}
