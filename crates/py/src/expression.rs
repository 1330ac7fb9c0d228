//! Conversion of texts, dictionaries of exponents or SymPy expressions to polynomials, and of polynomials to dictionaries.
//!
//! This module does not import SymPy; it reads the terms of an expression of the caller by its methods. Numbers have their exact value.
//! A flag tells if one of them was a float.

use andoyer_series::error::ParseProblem;
use andoyer_series::real_field::RealField;
use andoyer_series::{Coefficient, Error as Algebra, Monomial, PhaseSpace, Polynomial};
use num_bigint::BigInt;
use num_rational::BigRational;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString, PyTuple};

use crate::error;

/// A polynomial with the exact values of its coefficients.
pub(crate) struct Expression {
    pub(crate) polynomial: Polynomial<BigRational>,
    /// True if a coefficient was given as a float.
    pub(crate) float: bool,
}

impl Expression {
    /// Reads a text, a dictionary {exponents: number} or a SymPy expression in the variables of `space`.
    pub(crate) fn new(argument: &str, value: &Bound<'_, PyAny>, space: &PhaseSpace) -> PyResult<Self> {
        if let Ok(text) = value.cast::<PyString>() {
            let read = space.parse(text.to_str()?);
            let polynomial = read.map_err(|problem| error::algebra_of(argument, problem))?;
            Ok(Expression { polynomial, float: false })
        } else if let Ok(terms) = value.cast::<PyDict>() {
            Self::from_terms(argument, terms, space)
        } else if value.hasattr("as_poly")? && value.hasattr("free_symbols")? {
            Self::from_sympy(argument, value, space)
        } else {
            let kind = value.get_type().name()?;
            Err(PyTypeError::new_err(format!("{argument} must be a text, a dict or a SymPy expression, not {kind}")))
        }
    }

    fn zero() -> Self {
        Expression { polynomial: Polynomial::zero(), float: false }
    }

    fn add(&mut self, argument: &str, monomial: Result<Monomial, Algebra>, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let (coefficient, float) = number(argument, value)?;
        let monomial = monomial.map_err(|problem| error::algebra_of(argument, problem))?;
        self.polynomial.add_term(monomial, &coefficient);
        self.float |= float;
        Ok(())
    }

    fn from_terms(argument: &str, terms: &Bound<'_, PyDict>, space: &PhaseSpace) -> PyResult<Self> {
        let mut expression = Self::zero();
        let names = [space.names(), space.driven()].concat();
        let powers = space.names().len();
        for (key, value) in terms {
            let exponents: Option<Vec<i64>> = key.cast::<PyTuple>().ok().and_then(|key| key.extract().ok());
            let fits = |exponents: &Vec<i64>| {
                exponents.len() == names.len()
                    && exponents[..powers].iter().all(|&power| (0..=u32::MAX.into()).contains(&power))
            };
            let Some(exponents) = exponents.filter(fits) else {
                let (key, names) = (key.repr()?, names.join(", "));
                let message = format!("{argument} has the key {key}: it must be a tuple of exponents of {names}");
                return Err(error::input(argument, key.to_string(), format!("exponents of {names}"), message));
            };
            let (exponents, harmonics) = exponents.split_at(powers);
            let exponents: Vec<u32> = exponents.iter().map(|&power| power as u32).collect();
            expression.add(argument, space.monomial(&exponents, harmonics), &value)?;
        }
        Ok(expression)
    }

    fn from_sympy(argument: &str, value: &Bound<'_, PyAny>, space: &PhaseSpace) -> PyResult<Self> {
        let names = space.names();
        let mut present = Vec::new();
        for symbol in value.getattr("free_symbols")?.try_iter()? {
            let symbol = symbol?;
            let name = symbol.str()?.to_string();
            if space.driven().contains(&name.as_str()) {
                continue;
            }
            let Some(slot) = names.iter().position(|known| *known == name) else {
                let known = names.join(", ");
                let message = format!("{argument} contains {name:?}, which is not one of {known}");
                return Err(error::input(argument, name, known, message));
            };
            present.push((slot, symbol));
        }
        present.sort_by_key(|(slot, _)| *slot);
        let harmonics = if space.driven().is_empty() { Vec::new() } else { harmonics(value, &space.driven())? };
        let symbols = present.iter().map(|(_, symbol)| symbol).chain(&harmonics);
        let symbols = PyTuple::new(value.py(), symbols.collect::<Vec<_>>())?;
        let polynomial = if symbols.is_empty() { None } else { Some(value.call_method1("as_poly", symbols)?) };
        let Some(polynomial) = polynomial.filter(|polynomial| !polynomial.is_none()) else {
            let shown = value.str()?.to_string();
            let remedy = remedy(value, &names[..2 * space.degrees_of_freedom()])?;
            let message = format!("{argument} is no polynomial: {shown}{remedy}");
            return Err(error::input(argument, shown, "a polynomial", message));
        };
        let mut expression = Self::zero();
        for term in polynomial.call_method0("terms")?.try_iter()? {
            let (powers, coefficient): (Vec<u32>, Bound<'_, PyAny>) = term?.extract()?;
            let mut exponents = vec![0; names.len()];
            for ((slot, _), &power) in present.iter().zip(&powers) {
                exponents[*slot] = power;
            }
            let monomial = space.monomial(&exponents, &vec![0; space.driven().len()]);
            let powers: Vec<_> = harmonics.iter().zip(powers.iter().skip(present.len())).collect();
            if powers.iter().all(|(_, power)| **power == 0) {
                expression.add(argument, monomial, &coefficient)?;
                continue;
            }
            let factors = powers.iter().map(|(harmonic, power)| Ok(format!("({})^{power}", harmonic.str()?)));
            let factors = factors.collect::<PyResult<Vec<_>>>()?.join("*");
            let factors: Polynomial<BigRational> =
                space.parse(&factors).map_err(|problem| error::algebra_of(argument, problem))?;
            let mut term = Self::zero();
            term.add(argument, monomial, &coefficient)?;
            // A term without harmonics times harmonics without variables: exponents add.
            let product = term.polynomial.multiply(&factors).map_err(|problem| error::algebra_of(argument, problem))?;
            expression.polynomial += &product;
            expression.float |= term.float;
        }
        Ok(expression)
    }
}

/// The cosines and sines in an expression whose angles contain driven phases only.
fn harmonics<'py>(expression: &Bound<'py, PyAny>, phases: &[&str]) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let (mut waiting, mut found) = (vec![expression.clone()], Vec::<Bound<'py, PyAny>>::new());
    while let Some(part) = waiting.pop() {
        let function = part.getattr("is_Function")?.extract()? && {
            let name = part.getattr("func")?.str()?.to_string();
            let symbols = part.getattr("free_symbols")?.try_iter()?.map(|symbol| Ok(symbol?.str()?.to_string()));
            let symbols = symbols.collect::<PyResult<Vec<_>>>()?;
            matches!(&*name, "cos" | "sin") && symbols.iter().all(|symbol| phases.contains(&symbol.as_str()))
        };
        if !function {
            waiting.extend(part.getattr("args")?.try_iter()?.collect::<PyResult<Vec<_>>>()?);
            continue;
        }
        let mut known = false;
        for other in &found {
            known |= other.eq(&part)?;
        }
        if !known {
            found.push(part);
        }
    }
    Ok(found)
}

/// What to do about the first function, or power with another exponent than 0, 1, 2, …, in an expression that is no polynomial, as the end of a sentence.
fn remedy(expression: &Bound<'_, PyAny>, variables: &[&str]) -> PyResult<String> {
    let mut waiting = vec![expression.clone()];
    while let Some(part) = waiting.pop() {
        let arguments = part.getattr("args")?.try_iter()?.collect::<PyResult<Vec<_>>>()?;
        let symbols = part.getattr("free_symbols")?.try_iter()?.map(|symbol| Ok(symbol?.str()?.to_string()));
        let symbols = symbols.collect::<PyResult<Vec<_>>>()?;
        let constant = symbols.iter().all(|symbol| !variables.contains(&symbol.as_str()));
        if !symbols.is_empty() && part.getattr("is_Function")?.extract()? {
            let function = ParseProblem::Function(part.getattr("func")?.str()?.to_string());
            return Ok(format!("; {function}"));
        }
        let whole =
            |power: &Bound<'_, PyAny>| Ok::<bool, PyErr>(power.getattr("is_Integer")?.extract()? && power.gt(0)?);
        if !symbols.is_empty() && part.getattr("is_Pow")?.extract()? && !whole(&arguments[1])? {
            let shown = part.str()?;
            return Ok(if constant {
                format!(
                    "; write a parameter w in place of {shown}, and scale w away with frequency = (\"w\", \"s\") if all frequencies are proportional to w"
                )
            } else {
                format!("; expand {shown} as a Taylor polynomial, for a normal form of order N to degree N + 2")
            });
        }
        waiting.extend(arguments.into_iter().rev());
    }
    Ok(String::new())
}

/// The exact value of a number, and true if it is a float. Every number except integers, fractions and texts counts as a float.
pub(crate) fn number(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<(BigRational, bool)> {
    let refused = || -> PyResult<PyErr> {
        Ok(PyTypeError::new_err(format!(
            "{argument}: a coefficient must be a real number or a text, not {}",
            value.repr()?
        )))
    };
    if value.is_instance_of::<PyBool>() {
        return Err(refused()?);
    }
    if let Ok(text) = value.cast::<PyString>() {
        let constant = Polynomial::<BigRational>::parse(text.to_str()?, &[]);
        let constant = constant.map_err(|problem| error::algebra_of(argument, problem))?;
        return Ok((constant.as_constant().unwrap_or_else(|| BigRational::integer(0)), false));
    }
    // Integers and fractions, including those of SymPy and NumPy.
    if let (Ok(numerator), Ok(denominator)) = (value.getattr("numerator"), value.getattr("denominator"))
        && let (Ok(numerator), Ok(denominator)) = (numerator.extract::<BigInt>(), denominator.extract::<BigInt>())
        && denominator != BigInt::ZERO
    {
        return Ok((BigRational::new(numerator, denominator), false));
    }
    let Ok(float) = value.extract::<f64>() else { return Err(refused()?) };
    let exact = BigRational::from_float(float);
    let not_finite = || {
        let message = format!("{argument}: the coefficient {float} is not finite");
        error::input(argument, float, "finite", message)
    };
    Ok((exact.ok_or_else(not_finite)?, true))
}

/// The key of a monomial: the exponents of variables and parameters, then the integers j of the driven phases.
fn key<'py>(py: Python<'py>, monomial: Monomial, space: &PhaseSpace) -> PyResult<Bound<'py, PyTuple>> {
    let powers = monomial.exponents().into_iter().take(space.names().len()).map(i64::from);
    PyTuple::new(py, powers.chain(space.harmonics(monomial)).collect::<Vec<_>>())
}

/// {exponents: coefficient} of a polynomial in the actions and parameters, in canonical order.
pub(crate) fn actions<'py, R: RealField + IntoPyObject<'py>>(
    py: Python<'py>,
    polynomial: &Polynomial<R>,
    space: &PhaseSpace,
) -> PyResult<Bound<'py, PyDict>> {
    let (result, slots) = (PyDict::new(py), space.degrees_of_freedom() + space.parameters());
    for (monomial, c) in polynomial.terms() {
        result.set_item(PyTuple::new(py, &monomial.exponents()[..slots])?, c.clone())?;
    }
    Ok(result)
}

/// {exponents: coefficient}, in canonical order.
pub(crate) fn real<'py, R: RealField + IntoPyObject<'py>>(
    py: Python<'py>,
    polynomial: &Polynomial<R>,
    space: &PhaseSpace,
) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    for (monomial, c) in polynomial.terms() {
        result.set_item(key(py, monomial, space)?, c.clone())?;
    }
    Ok(result)
}

/// {exponents: (re, im)}, in canonical order.
pub(crate) fn complex<'py, R: RealField + IntoPyObject<'py>>(
    py: Python<'py>,
    polynomial: &Polynomial<R::Complex>,
    space: &PhaseSpace,
) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    for (monomial, c) in polynomial.terms() {
        result.set_item(key(py, monomial, space)?, R::parts(c))?;
    }
    Ok(result)
}
