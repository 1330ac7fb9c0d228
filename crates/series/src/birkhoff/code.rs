//! A Birkhoff normal form as source text: functions in C, Rust or Python that need only the language itself.
//!
//! `from_normal` and `to_normal` evaluate the truncated transformation in both directions. `actions` gives the actions of normal variables. `frequencies` gives
//! their rates ∂K/∂I, if K is a function of the actions. The code has no branches or loops. Horner's rule in one variable after the other takes about one
//! multiplication and one addition for each term. The linear change comes before or after it. Each coefficient is rounded once and printed with the digits that
//! are read back to the same bits.

use super::BirkhoffNormalForm;
use super::matrix::{Matrix, symplectic_inverse};
use super::mode::Mode;
use super::phase_space::PhaseSpace;
use crate::emit::Language;
use crate::emit::program::{Expression, Function, Program, call, name};
use crate::emit::routine::{Argument, Results, Routine};
use crate::error::Error;
use crate::harmonics;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use crate::triangle::quiet;
use std::collections::{BTreeMap, BTreeSet};

impl<R: RealField> BirkhoffNormalForm<R> {
    /// The source file of functions in `language` that evaluate this normal form.
    ///
    /// `from_normal(normal)` gives the state q₁, p₁, q₂, … of normal variables, and `to_normal(state)` is its inverse. `actions(normal)` and
    /// `frequencies(actions)` describe the motion. `frequencies` is missing if K has resonant terms. Parameters are an array after the first argument. With driven
    /// phases the time is the last argument of `from_normal` and `to_normal`.
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
        let title = format!("Birkhoff normal form of order {}: transformation, actions and frequencies.", self.order());
        let driven: Vec<_> = self.driven().iter().map(|(frequency, start)| (frequency.to_float(), *start)).collect();
        let slopes = match self.in_actions().map(|actions| actions.map(R::to_float)) {
            Ok(actions) => {
                Some((0..self.modes().len()).map(|mode| actions.derivative(mode)).collect::<Result<_, _>>()?)
            }
            Err(Error::ResonantTerm { .. }) => None,
            Err(other) => return Err(other),
        };
        let about =
            About { class: "BirkhoffNormalForm", title, timed: !driven.is_empty(), space: self.space(), driven };
        about.file(language, self.modes(), self.transformations(&about)?, slopes)
    }

    /// The programs from the normal variables to the state and back.
    fn transformations(&self, about: &About<'_>) -> Result<[Program; 2], Error> {
        let floats = |row: &Vec<R>| row.iter().map(R::to_float).collect();
        let forward: Matrix<f64> = self.linear_change().iter().map(floats).collect();
        let images = |direct: bool| {
            let image = |slot| Ok(self.transported(&Polynomial::variable(slot)?, direct, &mut quiet)?.map(R::to_float));
            (0..forward.len()).map(image).collect::<Result<Vec<_>, Error>>()
        };
        let [mut from_normal, mut to_normal] = [Program::default(), Program::default()];
        about.polynomials(&mut from_normal, &images(true)?, "result_image_");
        for (i, row) in forward.iter().enumerate() {
            from_normal.assign(&format!("{RESULT}{i}"), sum(row, "result_image_"));
        }
        let inverse = images(false)?;
        about.waves(&mut to_normal, &inverse);
        for (i, row) in symplectic_inverse(&forward).iter().enumerate() {
            to_normal.assign(&format!("z_{i}"), sum(row, "v_"));
        }
        renamed(&mut to_normal, forward.len());
        polynomials(&mut to_normal, &inverse, about.slots(), RESULT);
        Ok([from_normal, to_normal])
    }
}

/// What a source file is of.
pub(crate) struct About<'a> {
    pub(crate) class: &'static str,
    pub(crate) title: String,
    /// Whether the transformation depends on the time.
    pub(crate) timed: bool,
    pub(crate) space: &'a PhaseSpace,
    /// The rate of each driven phase and its value at time 0.
    pub(crate) driven: Vec<(f64, f64)>,
}

impl About<'_> {
    /// The file of a form with these modes: the programs from normal variables to states and back, the actions and, if K is a function of them, the slopes ∂K/∂I.
    pub(crate) fn file<R: RealField>(
        &self,
        language: Language,
        modes: &[Mode<R>],
        [from_normal, to_normal]: [Program; 2],
        slopes: Option<Vec<Polynomial<f64>>>,
    ) -> Result<String, Error> {
        let parameters = Others { parameters: self.space.parameters(), time: false };
        let all = Others { time: self.timed, ..parameters };
        let (normal, state) = (("normal", 2 * modes.len()), ("state", 2 * modes.len()));
        let mut routines = vec![
            routine(["from_normal", "The state of normal variables."], normal, all, state, from_normal),
            routine(["to_normal", "The normal variables of a state."], state, all, normal, to_normal),
            actions(modes, self.slots())?,
        ];
        let mut lines = self.head(modes);
        match slopes {
            Some(slopes) => routines.push(frequencies(&slopes, parameters)),
            None => lines.push("K has resonant terms: there is no function of the frequencies.".to_owned()),
        }
        let assignments: usize = routines.iter().map(|routine| routine.program.statements.len()).sum();
        lines.push(format!("{assignments} assignments. Arguments are not checked."));
        Ok(language.file(lines, self.timed, &routines))
    }

    /// The first lines of the file: what it has, of which class, in which variables.
    fn head<R: RealField>(&self, modes: &[Mode<R>]) -> Vec<String> {
        let names = self.space.names();
        let (pairs, parameters) = names.split_at(2 * self.space.degrees_of_freedom());
        let mut lines = vec![
            self.title.clone(),
            String::new(),
            format!("generated by andoyer {}, {}.to_code", env!("CARGO_PKG_VERSION"), self.class),
            String::new(),
            format!("States and normal variables: {} (ASCII names of q1, p1, q2, p2 ...).", pairs.join(", ")),
        ];
        if !parameters.is_empty() {
            lines.push(format!("Parameters: {}.", parameters.join(", ")));
        }
        for (name, (frequency, start)) in self.space.driven().into_iter().zip(&self.driven) {
            lines.push(format!("Driven phase: {name} = {start:?} + {frequency:?} time."));
        }
        for (mode, kind) in modes.iter().enumerate() {
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
        lines
    }

    /// Assigns the harmonics of the driven phases in `images` at the time: `h_7_2` is that of the exponent 2 in slot 7.
    fn waves(&self, program: &mut Program, images: &[Polynomial<f64>]) {
        for (slot, &(frequency, start)) in self.space.driven_slots().zip(&self.driven) {
            let turned = Expression::from(frequency) * name("time");
            let phase = if start == 0.0 { turned } else { Expression::from(start) + turned };
            program.assign(&format!("m_{slot}"), phase);
            let exponents = images.iter().flat_map(Polynomial::terms).map(|(monomial, _)| monomial.exponent(slot));
            for exponent in exponents.filter(|&exponent| exponent > 0).collect::<BTreeSet<_>>() {
                let (j, phase) = (harmonics::signed(exponent), name(&format!("m_{slot}")));
                let angle = if j.abs() == 1 { phase } else { Expression::from(j.abs() as f64) * phase };
                let value = call(if j < 0 { Function::Sine } else { Function::Cosine }, angle);
                program.assign(&format!("h_{slot}_{exponent}"), value);
            }
        }
    }

    /// Assigns the harmonics in `images`, and their values to the names `target` with 0, 1, ….
    pub(crate) fn polynomials(&self, program: &mut Program, images: &[Polynomial<f64>], target: &str) {
        self.waves(program, images);
        polynomials(program, images, self.slots(), target);
    }

    fn slots(&self) -> Slots {
        Slots { parameters: 2 * self.space.degrees_of_freedom(), driven: self.space.driven_slots().start }
    }
}

/// Gives the values `z_0`, `z_1`, … to the variables.
pub(crate) fn renamed(program: &mut Program, length: usize) {
    for i in 0..length {
        program.assign(&format!("v_{i}"), name(&format!("z_{i}")));
    }
}

/// The actions of normal variables.
fn actions<R: RealField>(modes: &[Mode<R>], slots: Slots) -> Result<Routine, Error> {
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
    let list = modes.iter().enumerate().map(action).collect::<Result<Vec<_>, Error>>()?;
    let (n, none) = (modes.len(), Others { parameters: 0, time: false });
    let (meaning, mut program) = (["actions", "The actions of normal variables."], Program::default());
    polynomials(&mut program, &list, slots, RESULT);
    Ok(routine(meaning, ("normal", 2 * n), none, ("actions", n), program))
}

/// The rates ∂K/∂I, given in the actions.
fn frequencies(slopes: &[Polynomial<f64>], others: Others) -> Routine {
    let (n, mut program) = (slopes.len(), Program::default());
    polynomials(&mut program, slopes, Slots { parameters: n, driven: SLOTS }, RESULT);
    routine(["frequencies", "The rates dK/dI at actions."], ("actions", n), others, ("rates", n), program)
}

/// Prefix of the results of a program.
pub(crate) const RESULT: &str = "result_";

/// The arguments of a function after its array.
#[derive(Clone, Copy)]
struct Others {
    parameters: usize,
    time: bool,
}

/// The first slots of the parameters and of the driven phases in a polynomial.
#[derive(Clone, Copy)]
struct Slots {
    parameters: usize,
    driven: usize,
}

/// A function of an array and of other arguments. Its program finds the entries in `v_0`, `v_1`, …, the parameters in `c_0`, `c_1`, … and the time in `time`.
fn routine(
    [name, meaning]: [&'static str; 2],
    argument: (&'static str, usize),
    others: Others,
    (result, length): (&'static str, usize),
    body: Program,
) -> Routine {
    let (mut arguments, mut program) = (Vec::new(), Program::default());
    let arrays = [argument, ("parameters", others.parameters)];
    for ((array, length), stem) in arrays.into_iter().zip(["v", "c"]).filter(|((_, length), _)| *length > 0) {
        arguments.push(Argument::Array(array, length));
        for i in 0..length {
            program.assign(&format!("{stem}_{i}"), Expression::Name(format!("{array}[{i}]")));
        }
    }
    if others.time {
        arguments.push(Argument::Number("time"));
    }
    program.statements.extend(body.statements);
    let results = Results::Array(result, length);
    program.keep_what_gives(&results.names().iter().map(String::as_str).collect::<Vec<_>>());
    Routine { name, meaning, arguments, results, program }
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

/// Assigns the names `target` with 0, 1, … from polynomials in `v_0`, `v_1`, …, the parameters and the harmonics of the driven phases.
fn polynomials(program: &mut Program, list: &[Polynomial<f64>], slots: Slots, target: &str) {
    for (number, polynomial) in list.iter().enumerate() {
        let terms: Vec<(Monomial, f64)> = polynomial.terms().map(|(monomial, &c)| (monomial, c)).collect();
        let value = horner(program, &terms, 0, slots);
        program.assign(&format!("{target}{number}"), value);
    }
}

/// The value of a polynomial in the variables from `slot` on. If it takes more than one assignment, its name is `a_slot`.
fn horner(program: &mut Program, terms: &[(Monomial, f64)], slot: usize, slots: Slots) -> Expression {
    let Some(slot) = (slot..SLOTS).find(|&slot| terms.iter().any(|(monomial, _)| monomial.exponent(slot) > 0)) else {
        return terms.iter().map(|(_, c)| c).sum::<f64>().into();
    };
    let mut by_power: BTreeMap<u32, Vec<(Monomial, f64)>> = BTreeMap::new();
    for &(monomial, c) in terms {
        by_power.entry(monomial.exponent(slot)).or_default().push((monomial, c));
    }
    let own = format!("a_{slot}");
    if slot >= slots.driven {
        for (position, (power, part)) in by_power.into_iter().enumerate() {
            let mut value = horner(program, &part, slot + 1, slots);
            if power > 0 {
                value = value * name(&format!("h_{slot}_{power}"));
            }
            program.assign(&own, if position == 0 { value } else { name(&own) + value });
        }
        return name(&own);
    }
    let variable = name(&variable(slot, slots.parameters));
    let highest = by_power.keys().next_back().copied().unwrap_or(0);
    let mut started = false;
    for power in (0..=highest).rev() {
        let part = by_power.remove(&power).map(|part| horner(program, &part, slot + 1, slots));
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
