//! A driven normal form as source text, with the functions of [`BirkhoffNormalForm::to_code`](crate::BirkhoffNormalForm::to_code) and the time as their last argument.
//!
//! `from_normal` is the direct series. `to_normal` takes the deviation from the periodic motion to Floquet's frame first, then the inverse series.

use super::named::DrivenNormalForm;
use super::row::Periodic;
use crate::birkhoff::code::{Others, RESULT, Slots, actions, foot, frequencies, head, polynomials, routine, waves};
use crate::birkhoff::mode::real_in_complex;
use crate::emit::Language;
use crate::emit::program::name;
use crate::emit::routine::Routine;
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::triangle::quiet;

impl DrivenNormalForm {
    /// The source file of functions in `language` that evaluate this normal form.
    ///
    /// # Errors
    /// - degrees of a transformation that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn to_code(&self, language: Language) -> Result<String, Error> {
        let (printer, routines, form) = (language.printer(), self.routines()?, self.form());
        let title = format!("Normal form of order {} about a periodic motion.", form.order());
        let mut lines = head(&title, "DrivenNormalForm", self.space(), &self.driven(), form.modes());
        lines.extend(foot(&routines));
        let texts: String = routines.iter().map(|routine| printer.routine(routine)).collect();
        Ok(printer.head(&lines) + printer.mathematics() + &texts)
    }

    fn routines(&self) -> Result<Vec<Routine>, Error> {
        let (form, space) = (self.form(), self.space());
        let n = 2 * space.degrees_of_freedom();
        let slots = Slots { parameters: n, driven: space.driven_slots().start };
        let timed = Others { parameters: 0, time: true };
        let program = |images: &[Polynomial<f64>], target: &str| {
            let mut program = waves(space, &self.driven(), images);
            program.statements.extend(polynomials(images, slots, target).statements);
            program
        };
        let direct: Vec<_> = (0..n).map(|slot| self.direct_series(slot)).collect::<Result<_, _>>()?;
        let images = |slot| self.real_in_waves(&form.inverse_rows(&Polynomial::variable(slot)?, &mut quiet)?);
        let inverse: Vec<_> = (0..n).map(images).collect::<Result<_, Error>>()?;
        let mut to_normal = program(&self.deviations()?, "z_");
        for slot in 0..n {
            to_normal.assign(&format!("v_{slot}"), name(&format!("z_{slot}")));
        }
        to_normal.statements.extend(program(&inverse, RESULT).statements);
        let [forth, back] = [("normal", n), ("state", n)];
        let meanings =
            [["from_normal", "The state of normal variables."], ["to_normal", "The normal variables of a state."]];
        Ok(vec![
            routine(meanings[0], forth, timed, back, program(&direct, RESULT)),
            routine(meanings[1], back, timed, forth, to_normal),
            actions(form.modes(), slots)?,
            frequencies(&form.frequencies, Others { parameters: 0, time: false }),
        ])
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
