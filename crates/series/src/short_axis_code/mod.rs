//! The normal form as source text: one function in C, Rust or Python that needs only the standard library of the language.
//!
//! The function evaluates the truncated direct transformation and the frequencies of a short-axis mode. β is either a number in the file or an argument. One
//! description of the computation (`computation`) serves the printers of all languages ([`emit`](crate::emit)); the numbers come from `coefficients`.
//!
//! Size and cost grow with N² if β is given, and with N³ if β is an argument: order 10 takes 11 kB and 23 kB (441 and 970 additions and
//! multiplications), order 30 takes 54 kB and 360 kB. With β as an argument the exact transformation is needed, which takes seconds at order 30. Accuracy:
//! a few rounding errors of the sums of magnitudes (tests/tests/emitted_code.rs). Source: theory §4, §6, §7, §8; Lara (2017).

mod coefficients;
mod computation;

use crate::emit::Language;
use crate::emit::program::Cost;
use crate::emit::routine::{Argument, Results, Routine};
use crate::error::Error;
use crate::normal_form::NormalForm;
use crate::rigid_body::separatrix_action;
use coefficients::Coefficients;

/// Largest order that [`NormalForm::to_code`] accepts. With a number for β it takes half a second and 0.7 MB; with β as an argument it takes much more.
pub const MAX_CODE_ORDER: usize = 100;

const MEANINGS: [&str; 5] = [
    "X/sqrt(M) = sqrt(2 (1 - N/M)) cos(nu)",
    "x/sqrt(M) = -sqrt(2 (1 - N/M)) sin(nu)",
    "y - y' [rad], where y = mu + nu",
    "dl'/dt in units of M gamma/C",
    "g in dy'/dt = (M/C) (1 + gamma g)",
];

impl NormalForm {
    /// The source file of a function in `language` that evaluates the direct transformation and the frequencies to this order.
    ///
    /// The function is `short_axis_rotation(sigma, anomaly)`, or `short_axis_rotation(beta, sigma, anomaly)` if `beta` is `None`. Its arguments are σ = L′/M
    /// and ℓ′ \[rad\]. It returns `zeta_real` = X/√M and `zeta_imaginary` = x/√M (theory §1, §8), `longitude_shift` = y − y′ \[rad\], `anomaly_rate` = dℓ′/dt
    /// in units of Mγ/C and `longitude_rate` = g in dy′/dt = (M/C)(1 + γg) (theory §7). The result is a struct in C and Rust and a tuple in Python. The head of
    /// the file repeats this description and states the cost and the truncation. If `beta` is a number, the coefficients are computed in double-double at that
    /// β, and only the order of this normal form is used.
    ///
    /// ```
    /// use andoyer_series::NormalForm;
    /// use andoyer_series::print::Language;
    /// let text = NormalForm::new(3)?.to_code(Language::C, Some(0.5))?;
    /// assert!(text.contains("struct short_axis_rotation short_axis_rotation(double sigma, double anomaly)"));
    /// assert!(text.contains("rate = (-0.3125 * s - 0.1875) * s - 1.0;")); // P_3 = -5β²/8, 3P_2/2 = -3β²/4
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `beta` = `Some(-0.1)`, `Some(1.0)` or `Some(f64::NAN)`: [`Error::OutsideInterval`]; at β = 1 there is no short-axis mode;
    /// - order 101: [`Error::OrderTooLarge`].
    pub fn to_code(&self, language: Language, beta: Option<f64>) -> Result<String, Error> {
        let beta = beta.map(checked).transpose()?;
        let (order, bound) = (self.order(), MAX_CODE_ORDER);
        if order > bound {
            return Err(Error::OrderTooLarge { order, bound });
        }
        let coefficients = match beta {
            Some(beta) => Coefficients::at(beta, order)?,
            None => Coefficients::symbolic(self)?,
        };
        let program = computation::computation(&coefficients, beta);
        let arguments: &[&str] = if beta.is_some() { &["sigma", "anomaly"] } else { &["beta", "sigma", "anomaly"] };
        let head = head(order, beta, program.cost())?;
        let routine = Routine {
            name: "short_axis_rotation",
            meaning: "The direct transformation and the frequencies; the head of this file says the rest.",
            arguments: arguments.iter().map(|name| Argument::Number(name)).collect(),
            results: Results::Record(computation::RESULTS.into_iter().zip(MEANINGS).collect()),
            program,
        };
        Ok(language.file(head, true, &[routine]))
    }
}

fn checked(beta: f64) -> Result<f64, Error> {
    if (0.0..1.0).contains(&beta) {
        Ok(beta.abs()) // −0 becomes 0
    } else {
        Err(Error::OutsideInterval { argument: "beta", value: beta, lower: 0.0, upper: 1.0_f64.next_down() })
    }
}

/// The lines of the head of the file, in ASCII.
fn head(order: usize, beta: Option<f64>, cost: Cost) -> Result<Vec<String>, Error> {
    let (body, argument, separatrix) = match beta {
        Some(beta) => {
            let action = separatrix_action(beta)?;
            (format!("beta = {beta:?}"), None, format!("sigma_sep = {action:?}"))
        }
        None => (
            "any beta".to_owned(),
            Some("  beta      triaxiality, 0 <= beta < 1"),
            "sigma_sep = (2/pi) atan(sqrt((1 - beta)/(2 beta)))".to_owned(),
        ),
    };
    let mut lines = vec![
        format!(
            "Torque-free rotation in a short-axis mode, order {order}, {body}: direct transformation and frequencies."
        ),
        String::new(),
        format!("generated by andoyer {}, NormalForm.to_code", env!("CARGO_PKG_VERSION")),
        "theory: M. Lara, Short-axis-mode rotation in complex variables (2017), with its errata;".to_owned(),
        "        sections 1 and 6 to 8 of andoyer's docs/theory.md".to_owned(),
        String::new(),
        "Moments of inertia A <= B <= C, angular momentum M with components N on body axis 3:".to_owned(),
        "gamma = sqrt((C/A - 1) (C/B - 1)), beta = (1/A - 1/B)/(1/A + 1/B - 2/C), 0 if A = B.".to_owned(),
        "Angular momentum in the body: M (sin J sin nu, sin J cos nu, cos J), cos J = N/M.".to_owned(),
        String::new(),
        "Arguments (not checked)".to_owned(),
    ];
    lines.extend(argument.map(str::to_owned));
    lines.push(format!("  sigma     action of the normal form L'/M, 0 <= sigma < {separatrix}"));
    lines.push("  anomaly   its angle l' [rad]; l' and y' grow at the rates below".to_owned());
    lines.push("Results, in units in which M = 1, angles in rad".to_owned());
    let results = computation::RESULTS.iter().zip(MEANINGS);
    lines.extend(results.map(|(name, meaning)| format!("  {name:<16} {meaning}")));
    lines.push(format!("Truncation: about (sigma/sigma_sep)^{} of each result.", order + 1));
    lines.push(format!(
        "Cost: {} additions, {} multiplications, {} divisions, {} square roots, {} sine and cosine.",
        cost.additions, cost.multiplications, cost.divisions, cost.square_roots, cost.trigonometric
    ));
    Ok(lines)
}
