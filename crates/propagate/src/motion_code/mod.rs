//! One motion as source text: an evaluator in C, Rust, Python or JavaScript that needs nothing but the language.
//!
//! The text is a head, the constants of the motion (`constants`) and a kernel that is the same for all motions (`kernel/`). The printers of
//! `andoyer_series::print` write head and constants. The kernel has two phases in turns with products in two doubles by Veltkamp's and Dekker's splitting, one
//! sine and cosine a phase, the sums of theory §8 and the constant frame. The kernel in Rust is compiled here too (`measured`), and its largest difference from
//! the library stands in the head. The text is the same in every run and holds no date.

mod constants;
mod head;
mod language;
mod measured;
mod print;

use crate::error::Error;
use crate::motion::solved::Motion;
use constants::Constants;
pub use language::CodeLanguage;
use measured::Measured;

/// The source text of a motion with what was measured of it.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionCode {
    text: String,
    measured: Measured,
}

impl MotionCode {
    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Bound of the angle between its attitude and that of the library, as its head states it \[rad\].
    pub fn attitude_error(&self) -> f64 {
        self.measured.attitude
    }

    /// Bound of the difference of the angular velocities, over their length.
    pub fn rate_error(&self) -> f64 {
        self.measured.rates
    }
}

impl Motion {
    /// A self-contained function `rotation(time)` that evaluates this motion, as the text of a file (theory §8).
    ///
    /// It returns the attitude [x, y, z, w] and the angular velocity in body components. Phases have products in two doubles, so that they hold after 1e9
    /// rotations, and the sine and the cosine are its own: the same bits in every language, but for the last of a square root. The head of the file names the
    /// scene, the mode, the validity interval and the largest difference from the library. The caller compiles C without `-ffast-math`.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// use andoyer_propagate::motion_code::CodeLanguage;
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// assert!(motion.to_code(CodeLanguage::C)?.contains("int rotation(double time, double attitude[4], double angular_velocity[3])"));
    /// assert!(motion.code(CodeLanguage::C)?.attitude_error() < 1e-14);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::NoCode`] for a passage along the separatrix, and for a motion under a torque.
    pub fn to_code(&self, language: CodeLanguage) -> Result<String, Error> {
        self.code(language).map(|code| code.text)
    }

    /// The same with its error as a number.
    ///
    /// # Errors
    /// As [`Motion::to_code`].
    pub fn code(&self, language: CodeLanguage) -> Result<MotionCode, Error> {
        let constants = Constants::new(self)?;
        let measured = Measured::new(self, &constants)?;
        let text = print::print(language, &head::head(self, &constants, &measured), &constants);
        Ok(MotionCode { text, measured })
    }
}

#[cfg(test)]
mod tests {
    use super::{Constants, Measured};
    use crate::{Motion, State};

    fn motion(moments: [f64; 3], rates: [f64; 3]) -> Motion {
        crate::solve::solved(moments, State::new(7.5, [0.5, -0.5, 0.5, 0.5], rates).expect("a state"))
    }

    #[test]
    fn a_wrong_last_part_of_a_frequency_is_seen_by_the_measure() {
        let motion = motion([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]);
        let mut constants = Constants::new(&motion).expect("code");
        assert!(Measured::new(&motion, &constants).expect("times").attitude < 1e-14);
        constants.anomaly[2] = 0.0;
        assert!(Measured::new(&motion, &constants).expect("times").attitude > 1e-10);
    }

    #[test]
    fn parts_of_a_frequency_have_few_enough_bits_for_exact_products() {
        let constants = Constants::new(&motion([1.0, 1.5, 2.0], [0.1, 0.2, 1.0])).expect("code");
        for [first, second, ..] in [constants.anomaly, constants.half_longitude] {
            assert!(first.to_bits().trailing_zeros() >= 26 && second.to_bits().trailing_zeros() >= 26);
        }
    }
}
