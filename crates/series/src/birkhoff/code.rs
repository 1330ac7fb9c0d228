//! A Birkhoff normal form as source text: functions in C, Rust or Python that need only the language itself.
//!
//! `from_normal` and `to_normal` evaluate the truncated transformation in both directions. `actions` gives the actions of normal variables. `frequencies` gives
//! their rates ∂K/∂I, if K is a function of the actions. The code has no branches or loops. Horner's rule in one variable after the other takes about one
//! multiplication and one addition for each term. The linear change comes before or after it. Each coefficient is rounded once and printed with the digits that
//! are read back to the same bits.

use super::BirkhoffNormalForm;
use super::matrix::{Matrix, symplectic_inverse};
use super::mode::Mode;
use crate::emit::Language;
use crate::emit::program::{Expression, Program, name};
use crate::emit::routine::{Argument, Results, Routine};
use crate::real_field::RealField;
use crate::{Error, Monomial, Polynomial};
use std::collections::BTreeMap;

impl<R: RealField> BirkhoffNormalForm<R> {
    /// The source file of functions in `language` that evaluate this normal form.
    ///
    /// `from_normal(normal)` gives the state q₁, p₁, q₂, … of normal variables, and `to_normal(state)` is its inverse. `actions(normal)` and
    /// `frequencies(actions)` describe the motion. `frequencies` is missing if K has resonant terms. Parameters are an array after the first argument.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize};
    /// use andoyer_series::print::Language;
    /// let space = PhaseSpace::new(&[("q", "p")])?;
    /// let form = normalize(&space.parse::<f64>("(p^2 + q^2)/2 + q^4/4")?, 2, &space)?;
    /// let text = form.to_code(Language::Python)?;
    /// assert!(text.contains("def frequencies(actions):") && text.contains("0.75"));
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - degrees of a transformation that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn to_code(&self, language: Language) -> Result<String, Error> {
        let (printer, routines) = (language.printer(), self.routines()?);
        let texts: String = routines.iter().map(|routine| printer.routine(routine)).collect();
        Ok(printer.head(&self.head(&routines)) + &texts)
    }

    fn routines(&self) -> Result<Vec<Routine>, Error> {
        let n = self.space().degrees_of_freedom();
        let forward: Matrix<f64> =
            self.linear_change().iter().map(|row| row.iter().map(R::to_float).collect()).collect();
        let images = |direct: bool| {
            let image = |slot| {
                let image = if direct { self.normal_image(slot, true) } else { self.normal_image(slot, false) };
                Ok(image?.map(R::to_float))
            };
            (0..2 * n).map(image).collect::<Result<Vec<_>, Error>>()
        };
        let parameters = match self.space().parameters() {
            0 => None,
            count => Some(("parameters", count)),
        };
        let mut routines = vec![
            routine(
                ["from_normal", "The state of normal variables."],
                ("normal", 2 * n),
                parameters,
                ("state", 2 * n),
                from_normal(&images(true)?, &forward),
            ),
            routine(
                ["to_normal", "The normal variables of a state."],
                ("state", 2 * n),
                parameters,
                ("normal", 2 * n),
                to_normal(&images(false)?, &symplectic_inverse(&forward)),
            ),
            routine(
                ["actions", "The actions of normal variables."],
                ("normal", 2 * n),
                None,
                ("actions", n),
                self.actions_program()?,
            ),
        ];
        match self.in_actions() {
            Ok(actions) => {
                let actions = actions.map(R::to_float);
                let slopes = (0..n).map(|mode| actions.derivative(mode)).collect::<Result<Vec<_>, _>>()?;
                let meaning = ["frequencies", "The rates dK/dI at actions."];
                routines.push(routine(
                    meaning,
                    ("actions", n),
                    parameters,
                    ("rates", n),
                    polynomials(&slopes, n, RESULT),
                ));
            }
            Err(Error::ResonantTerm { .. }) => {}
            Err(other) => return Err(other),
        }
        Ok(routines)
    }

    /// A real variable of one side in those of the other side, without the linear change.
    fn normal_image(&self, slot: usize, direct: bool) -> Result<Polynomial<R>, Error> {
        let variable = Polynomial::variable(slot)?;
        self.transported(
            &variable,
            |transform, part| if direct { transform.direct(part) } else { transform.inverse(part) },
        )
    }

    fn actions_program(&self) -> Result<Program, Error> {
        let square = |slot: usize, other: usize| {
            let first = Monomial::ONE.with(slot, 1)?;
            first.with(other, first.exponent(other) + 1)
        };
        let action = |(mode, kind): (usize, &Mode<R>)| {
            let (q, p) = (2 * mode, 2 * mode + 1);
            Ok(Polynomial::from_terms(match kind {
                Mode::Elliptic { ratio, .. } => {
                    let ratio = ratio.to_float();
                    vec![(square(q, q)?, 0.5 / ratio), (square(p, p)?, 0.5 * ratio)]
                }
                Mode::Hyperbolic { .. } => vec![(square(q, p)?, 1.0)],
                Mode::Complex { partner, frequency, .. } => {
                    let (other, other_p) = (2 * partner, 2 * partner + 1);
                    if frequency.sign() > 0 {
                        vec![(square(q, p)?, 1.0), (square(other, other_p)?, 1.0)]
                    } else {
                        vec![(square(other, p)?, 1.0), (square(q, other_p)?, -1.0)]
                    }
                }
            }))
        };
        let list = self.modes().iter().enumerate().map(action).collect::<Result<Vec<_>, Error>>()?;
        Ok(polynomials(&list, 2 * self.modes().len(), RESULT))
    }

    fn head(&self, routines: &[Routine]) -> Vec<String> {
        let space = self.space();
        let names = space.names();
        let (pairs, parameters) = names.split_at(2 * space.degrees_of_freedom());
        let assignments: usize = routines.iter().map(|routine| routine.program.statements.len()).sum();
        let mut lines = vec![
            format!("Birkhoff normal form of order {}: transformation, actions and frequencies.", self.order()),
            String::new(),
            format!("generated by andoyer {}, BirkhoffNormalForm.to_code", env!("CARGO_PKG_VERSION")),
            String::new(),
            format!("States and normal variables: {} (ASCII names of q1, p1, q2, p2 ...).", pairs.join(", ")),
        ];
        if !parameters.is_empty() {
            lines.push(format!("Parameters: {}.", parameters.join(", ")));
        }
        for (mode, kind) in self.modes().iter().enumerate() {
            let (q, p) = (pairs[2 * mode], pairs[2 * mode + 1]);
            lines.push(match kind {
                Mode::Elliptic { frequency, ratio } => format!(
                    "({q}, {p}): centre, frequency {:?}, I = ({q}^2/r + r {p}^2)/2, r = {:?}",
                    frequency.to_float(),
                    ratio.to_float()
                ),
                Mode::Hyperbolic { rate } => format!("({q}, {p}): saddle, rate {:?}, I = {q} {p}", rate.to_float()),
                Mode::Complex { rate, frequency, .. } => {
                    format!(
                        "({q}, {p}): of a quartet, rate {:?}, frequency {:?}",
                        rate.to_float(),
                        frequency.to_float()
                    )
                }
            });
        }
        if routines.len() < 4 {
            lines.push("K has resonant terms: there is no function of the frequencies.".to_owned());
        }
        lines.push(format!("{assignments} assignments. Arguments are not checked."));
        lines.push("No rights are claimed in this file: do with it what you like.".to_owned());
        lines
    }
}

/// Prefix of the results of a program.
const RESULT: &str = "result_";

/// A function of an array, and of the parameters if it has them. Its program finds the arguments in `v_0`, `v_1`, … and the parameters in `c_0`, `c_1`, ….
fn routine(
    [name, meaning]: [&'static str; 2],
    argument: (&'static str, usize),
    parameters: Option<(&'static str, usize)>,
    (result, length): (&'static str, usize),
    body: Program,
) -> Routine {
    let (mut arguments, mut program) = (Vec::new(), Program::default());
    for ((array, length), stem) in std::iter::once(argument).chain(parameters).zip(["v", "c"]) {
        arguments.push(Argument::Array(array, length));
        for i in 0..length {
            program.assign(&format!("{stem}_{i}"), Expression::Name(format!("{array}[{i}]")));
        }
    }
    program.statements.extend(body.statements);
    let results = Results::Array(result, length);
    program.keep_what_gives(&results.names().iter().map(String::as_str).collect::<Vec<_>>());
    Routine { name, meaning, arguments, results, program }
}

fn from_normal(images: &[Polynomial<f64>], forward: &Matrix<f64>) -> Program {
    let mut program = polynomials(images, images.len(), "result_image_");
    for (i, row) in forward.iter().enumerate() {
        program.assign(&format!("{RESULT}{i}"), sum(row, "result_image_"));
    }
    program
}

fn to_normal(images: &[Polynomial<f64>], backward: &Matrix<f64>) -> Program {
    let mut program = Program::default();
    for (i, row) in backward.iter().enumerate() {
        program.assign(&format!("z_{i}"), sum(row, "v_"));
    }
    for (i, _) in backward.iter().enumerate() {
        program.assign(&format!("v_{i}"), name(&format!("z_{i}")));
    }
    program.statements.extend(polynomials(images, images.len(), RESULT).statements);
    program
}

/// Σ cⱼ name_j.
fn sum(row: &[f64], stem: &str) -> Expression {
    let mut terms = row.iter().enumerate().filter(|(_, c)| **c != 0.0).map(|(j, &c)| {
        let variable = name(&format!("{stem}{j}"));
        if c == 1.0 { variable } else { Expression::from(c) * variable }
    });
    let first = terms.next().unwrap_or_else(|| 0.0.into());
    terms.fold(first, |sum, term| sum + term)
}

/// Assigns the names `target` with 0, 1, … from polynomials in `v_0`, `v_1`, …; the parameters are in the slots from `first` on.
fn polynomials(list: &[Polynomial<f64>], first: usize, target: &str) -> Program {
    let mut program = Program::default();
    for (number, polynomial) in list.iter().enumerate() {
        let terms: Vec<(Monomial, f64)> = polynomial.terms().map(|(monomial, &c)| (monomial, c)).collect();
        let value = horner(&mut program, &terms, 0, first);
        program.assign(&format!("{target}{number}"), value);
    }
    program
}

/// The value of a polynomial in the variables from `slot` on. If it takes more than one assignment, its name is `a_slot`.
fn horner(program: &mut Program, terms: &[(Monomial, f64)], slot: usize, first: usize) -> Expression {
    let Some(slot) = (slot..crate::SLOTS).find(|&slot| terms.iter().any(|(monomial, _)| monomial.exponent(slot) > 0))
    else {
        return terms.iter().map(|(_, c)| c).sum::<f64>().into();
    };
    let mut by_power: BTreeMap<u32, Vec<(Monomial, f64)>> = BTreeMap::new();
    for &(monomial, c) in terms {
        by_power.entry(monomial.exponent(slot)).or_default().push((monomial, c));
    }
    let (own, variable) = (format!("a_{slot}"), name(&variable(slot, first)));
    let highest = by_power.keys().next_back().copied().unwrap_or(0);
    let mut started = false;
    for power in (0..=highest).rev() {
        let part = by_power.remove(&power).map(|part| horner(program, &part, slot + 1, first));
        let value = match (started, part) {
            (true, Some(part)) => name(&own) * variable.clone() + part,
            (true, None) => name(&own) * variable.clone(),
            (false, Some(part)) => part,
            (false, None) => continue,
        };
        program.assign(&own, value);
        started = true;
    }
    name(&own)
}

fn variable(slot: usize, first: usize) -> String {
    if slot < first { format!("v_{slot}") } else { format!("c_{}", slot - first) }
}
