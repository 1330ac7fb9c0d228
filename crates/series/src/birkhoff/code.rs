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
use crate::emit::program::{Expression, Program, Statement, name};
use crate::emit::text::expression;
use crate::real_field::RealField;
use crate::{Error, Monomial, Polynomial};
use std::collections::{BTreeMap, BTreeSet};

/// A function from arrays to an array.
struct Function {
    name: &'static str,
    meaning: String,
    /// Names and lengths of the argument arrays.
    arguments: Vec<(&'static str, usize)>,
    result: (&'static str, usize),
    program: Program,
}

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
        let functions = self.functions()?;
        let mut text = header(&self.head(&functions), language);
        for function in &functions {
            text += &print(function, language);
        }
        Ok(text)
    }

    fn functions(&self) -> Result<Vec<Function>, Error> {
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
        let parameters = self.space().parameters();
        let arguments = |first: (&'static str, usize)| {
            let given = (parameters > 0).then_some(("parameters", parameters));
            std::iter::once(first).chain(given).collect::<Vec<_>>()
        };
        let mut functions = vec![
            Function {
                name: "from_normal",
                meaning: "The state of normal variables.".to_owned(),
                arguments: arguments(("normal", 2 * n)),
                result: ("state", 2 * n),
                program: from_normal(&images(true)?, &forward),
            },
            Function {
                name: "to_normal",
                meaning: "The normal variables of a state.".to_owned(),
                arguments: arguments(("state", 2 * n)),
                result: ("normal", 2 * n),
                program: to_normal(&images(false)?, &symplectic_inverse(&forward)),
            },
            Function {
                name: "actions",
                meaning: "The actions of normal variables.".to_owned(),
                arguments: vec![("normal", 2 * n)],
                result: ("actions", n),
                program: self.actions_program()?,
            },
        ];
        let keep = |function: &mut Function| {
            let results: Vec<String> = (0..function.result.1).map(|i| format!("result_{i}")).collect();
            function.program.keep_what_gives(&results.iter().map(String::as_str).collect::<Vec<_>>());
        };
        match self.in_actions() {
            Ok(actions) => {
                let actions = actions.map(R::to_float);
                let slopes = (0..n).map(|mode| actions.derivative(mode)).collect::<Result<Vec<_>, _>>()?;
                functions.push(Function {
                    name: "frequencies",
                    meaning: "The rates dK/dI at actions.".to_owned(),
                    arguments: arguments(("actions", n)),
                    result: ("rates", n),
                    program: polynomials(&slopes, n, "rate"),
                });
            }
            Err(Error::ResonantTerm { .. }) => {}
            Err(other) => return Err(other),
        }
        functions.iter_mut().for_each(keep);
        Ok(functions)
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
        Ok(polynomials(&list, 2 * self.modes().len(), "action"))
    }

    fn head(&self, functions: &[Function]) -> Vec<String> {
        let space = self.space();
        let names = space.names();
        let (pairs, parameters) = names.split_at(2 * space.degrees_of_freedom());
        let statements: usize = functions.iter().map(|function| function.program.statements.len()).sum();
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
        if functions.len() < 4 {
            lines.push("K has resonant terms: there is no function of the frequencies.".to_owned());
        }
        lines.push(format!("{statements} assignments. Arguments are not checked."));
        lines.push("No rights are claimed in this file: do with it what you like.".to_owned());
        lines
    }
}

fn from_normal(images: &[Polynomial<f64>], forward: &Matrix<f64>) -> Program {
    let mut program = polynomials(images, images.len(), "image");
    for (i, row) in forward.iter().enumerate() {
        program.assign(&format!("result_{i}"), sum(row, "result_image_"));
    }
    rename(program, "image")
}

/// Renames the results of `polynomials` that the linear change uses.
fn rename(mut program: Program, stem: &str) -> Program {
    let last: BTreeMap<String, usize> = program
        .statements
        .iter()
        .enumerate()
        .filter_map(|(at, statement)| match statement {
            Statement::Assignment(target, _) => Some((target.clone(), at)),
            Statement::Comment(_) => None,
        })
        .collect();
    for (at, statement) in program.statements.iter_mut().enumerate() {
        if let Statement::Assignment(target, _) = statement
            && let Some(number) = target.strip_prefix("result_")
            && last.get(target.as_str()).is_some_and(|&last| at < last)
        {
            *target = format!("result_{stem}_{number}");
        }
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
    program.statements.extend(polynomials(images, images.len(), "image").statements);
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

/// Assigns `result_0`, `result_1`, … from polynomials in `v_0`, `v_1`, …; the parameters are in the slots from `first` on.
fn polynomials(list: &[Polynomial<f64>], first: usize, stem: &str) -> Program {
    let mut program = Program::default();
    for (number, polynomial) in list.iter().enumerate() {
        program.comment(&format!("{stem} {number}"));
        let terms: Vec<(Monomial, f64)> = polynomial.terms().map(|(monomial, &c)| (monomial, c)).collect();
        let value = horner(&mut program, &terms, 0, first);
        program.assign(&format!("result_{number}"), value);
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

fn header(lines: &[String], language: Language) -> String {
    let body =
        |mark: &str| lines.iter().map(|line| format!("{mark}{line}").trim_end().to_owned() + "\n").collect::<String>();
    match language {
        Language::C => format!("/*\n{} */\n", body(" * ")),
        Language::Rust => body("// "),
        Language::Python => format!("\"\"\"{}\"\"\"\n", body("").trim_end().to_owned() + "\n"),
    }
}

/// The text of a function in `language`.
fn print(function: &Function, language: Language) -> String {
    let (results, count) = function.result;
    let mut text = opening(function, language);
    let mut assigned = BTreeSet::new();
    let line = |target: &str, value: &str, new: bool| match language {
        Language::C => format!("    {}{target} = {value};\n", if new { "double " } else { "" }),
        Language::Rust => format!("    let {target} = {value};\n"),
        Language::Python => format!("    {target} = {value}\n"),
    };
    let used = used(&function.program);
    for (position, (argument, length)) in function.arguments.iter().enumerate() {
        let stem = if position == 0 { "v" } else { "c" };
        for i in (0..*length).filter(|i| used.contains(&format!("{stem}_{i}"))) {
            let target = format!("{stem}_{i}");
            text += &line(&target, &format!("{argument}[{i}]"), true);
            assigned.insert(target);
        }
    }
    for statement in &function.program.statements {
        if let Statement::Assignment(target, value) = statement {
            let value = expression(value, |_, argument| argument.to_owned());
            text += &line(target, &value, assigned.insert(target.clone()));
        }
    }
    let list = (0..count).map(|i| format!("result_{i}")).collect::<Vec<_>>().join(", ");
    match language {
        Language::C => {
            for i in 0..count {
                text += &format!("    {results}[{i}] = result_{i};\n");
            }
            text + "}\n"
        }
        Language::Rust => text + &format!("    [{list}]\n}}\n"),
        Language::Python => text + &format!("    return [{list}]\n"),
    }
}

fn opening(function: &Function, language: Language) -> String {
    let (name, (results, count)) = (function.name, function.result);
    let join = |argument: &dyn Fn(&(&'static str, usize)) -> String| {
        function.arguments.iter().map(argument).collect::<Vec<_>>().join(", ")
    };
    match language {
        Language::C => {
            let arguments = join(&|(name, length)| format!("const double {name}[{length}]"));
            let signature = format!("void {name}({arguments}, double {results}[{count}])");
            format!("\n/* {} */\n{signature};\n{signature}\n{{\n", function.meaning)
        }
        Language::Rust => {
            let arguments = join(&|(name, length)| format!("{name}: &[f64; {length}]"));
            format!("\n/// {}\n#[must_use]\npub fn {name}({arguments}) -> [f64; {count}] {{\n", function.meaning)
        }
        Language::Python => {
            let arguments = join(&|(name, _)| (*name).to_owned());
            format!("\n\ndef {name}({arguments}):\n    \"\"\"{}\"\"\"\n", function.meaning)
        }
    }
}

/// The names that occur in values of the program.
fn used(program: &Program) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for statement in &program.statements {
        if let Statement::Assignment(_, value) = statement {
            value.walk(&mut |part| {
                if let Expression::Name(name) = part {
                    names.insert(name.clone());
                }
            });
        }
    }
    names
}
