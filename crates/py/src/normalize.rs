//! `andoyer.normalize`.

use andoyer_series::birkhoff::Resonances;
use andoyer_series::periodic::MAX_DRIVEN_ORDER;
use andoyer_series::progress::Progress;
use andoyer_series::real_field::RealField;
use andoyer_series::{Error as Algebra, MAX_EXPONENT, PhaseSpace, Polynomial, normalize_driven};
use num_rational::BigRational;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::array::numbers_of;
use crate::birkhoff::BirkhoffNormalForm;
use crate::driven::DrivenPhases;
use crate::error;
use crate::expression::{Expression, number};
use crate::form::{Form, rounded};
use crate::order::order;
use crate::progress;

/// Computes the Birkhoff normal form of a polynomial Hamiltonian about an equilibrium at the origin.
///
/// The quadratic part must be diagonalizable: oscillators, coupled or not, gyroscopic terms, saddles. A linear symplectic change makes it a
/// sum of modes: centres ω (q²/r + r p²)/2, saddles λ q p, and quartets of complex eigenvalues. Order N normalizes the terms up to degree
/// N + 2, by Lie transforms (Deprit's triangle).
///
/// Parameters
/// ----------
/// hamiltonian : str, dict or SymPy expression
///     A text like ``"(x**2 + X**2)/2 + 0.1*x**3"`` (``^`` also means a power, and decimals are exact), a dictionary of coefficients by tuple of
///     exponents in the order of `variables` and `parameters`, or a SymPy polynomial. Coefficients are int, Fraction, text
///     or float.
/// order : int
///     Order N, at least 0. Terms above degree N + 2 have no effect; about a periodic motion x̄ they have one through their derivatives at x̄.
/// variables : sequence of (str, str)
///     Up to four pairs (q, p), as names or SymPy symbols. All lists of exponents and states have the order q₁, p₁, q₂, p₂, …
/// parameters : sequence of str, or dict of {str: number}, optional
///     Symbols in the coefficients, as names or SymPy symbols. Variables and parameters together are at most eight. A parameter in the quadratic part is a
///     detuning, like d in ``(1 + d)*y^2/2``. In a dict the number of a parameter is put in its place, and the form does not contain this parameter; a parameter with None stays a symbol.
/// driven : dict of {str: number or (number, float)}, or Driven, optional
///     Driven phases M = M₀ + n t: the frequency n, or (n, M₀), by name or SymPy symbol. M₀ is 0 by default. The Hamiltonian contains them as ``cos(j*M)`` and ``sin(j*M)`` with
///     integers j; in a dict of coefficients the exponents are followed by j for each phase, which means cos jM for j ≥ 0 and sin ``|j|M`` for j < 0. A phase takes one of the
///     eight places. The form is that about the periodic motion, a `DrivenNormalForm` in floats, so the drive may be strong; a `Driven` has sampled coefficients.
///     With any of `parameters`, `degrees`, `frequency`, `resonances`, `keep` and `exact` it is about the equilibrium, a `BirkhoffNormalForm`, order by order in the drive: a
///     term with a phase counts one order more, and the variables are measured from the motion of a force, which is the terms of order 0.
/// degrees : dict of {str: int}, optional
///     The degree of each parameter in the ordering of the terms; by default 2 for a detuning and 0 for any other parameter.
/// frequency : (str, str), optional
///     A parameter w that all frequencies are proportional to, and a name s for 1/√w. The form is that of H/w in the variables q√w, p/√w, under the names of the old ones, with s
///     in the place of w: K of H is w times it, and its time is wt. Terms without variables are dropped.
/// resonances : sequence of sequences of int, optional
///     Vectors k with k·ω = 0. Terms proportional to e^{i k·φ} are kept, for k and all integer combinations. Example: ``[(1, -1)]`` for equal frequencies. With driven
///     phases the integers j follow those of k, and k·ω + j·n = 0.
/// keep : {"hyperbolic"}, optional
///     "hyperbolic" removes only the terms that couple the centres to the saddles. The normal form can then be restricted to the centre manifold; see `centre_manifold`.
/// smallest_divisor : float, optional
///     Bound of the divisors relative to the largest frequency, 0 to 1. A term with ``|k·ω|`` below it is an error unless the term is kept, and the given resonances must
///     be below it. With 1e-6 a division loses at most six digits. A larger bound admits resonances that are not exact.
/// exact : bool, optional
///     If True, numbers are rational; this needs rational frequencies √(ab), and floats have their exact value. If False, numbers are floats. By default
///     numbers are exact if no coefficient is a float and the eigenvalues are rational.
/// progress : callable, optional
///     Called as ``progress(done, order)`` with the number of completed orders, 0 to `order`. An exception in it stops the computation and is raised
///     to the caller.
/// start : array_like, shape (2n,), optional
///     A state q₁, p₁, … near a periodic motion at the phase 0 of one driven phase, such as `periodic(0.0)` of a form for similar numbers: the search begins at its solution
///     over a period. By default it begins at the equilibrium.
///
/// Raises
/// ------
/// InputError
///     A text that is not a polynomial; a start without one driven phase or of another shape; a linear term; more than four pairs; an unknown variable; a vector that is not a resonance; an unknown `keep`; a negative order; a
///     smallest divisor outside 0 to 1; numbers that overflow.
/// TheoryError
///     A quadratic part with a Jordan block or a zero frequency. A force with the frequency of a mode. A resonant term or a small divisor that was not requested; the message has its monomial.
/// RepresentationError
///     An order whose exponents or factorials do not fit (``32764``; ``171`` in floats); irrational frequencies with ``exact=True``.
///
/// Examples
/// --------
/// >>> pendulum = normalize("p**2/2 + q**2/2 - q**4/24 + q**6/720", 4, [("q", "p")])
/// >>> pendulum.in_actions()
/// {(1,): Fraction(1, 1), (2,): Fraction(-1, 16), (3,): Fraction(-1, 256)}
/// >>> print(normalize("p^2/2 + w^2*q^2/2 + q^4/4", 2, [("q", "p")], parameters=["w"], frequency=("w", "s")))
/// I_q + 3/8*I_q^2*s^6
/// >>> print(normalize("(p^2 + q^2)/2 + c*q^4/4", 2, [("q", "p")], parameters={"c": 2}))
/// I_q + 3/4*I_q^2
/// >>> print(normalize("(p^2 + 4/9*x^2)/2 - q*x^2*cos(2*M)", 2, [("x", "p")], parameters=["q"], driven={"M": 1}))
/// 2/3*I_x + 27/40*I_x*q^2
/// >>> henon_heiles = "(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3"
/// >>> normalize(henon_heiles, 2, [("x", "X"), ("y", "Y")], resonances=[(1, -1)]).in_real()[4, 0, 0, 0]
/// Fraction(-5, 48)
/// >>> saddle = normalize("(X^2 - 4*x^2)/2 + (Y^2 + y^2)/2 + x*y^2", 2, [("x", "X"), ("y", "Y")], keep="hyperbolic")
/// >>> saddle.frequencies
/// (2j, Fraction(1, 1))
#[pyfunction]
#[pyo3(signature = (hamiltonian, order, variables, *, parameters=None, driven=None, degrees=None, frequency=None, resonances=None, keep=None, smallest_divisor=1e-6, exact=None, progress=None, start=None))]
#[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
pub(crate) fn normalize(
    py: Python<'_>,
    hamiltonian: &Bound<'_, PyAny>,
    order: &Bound<'_, PyAny>,
    variables: &Bound<'_, PyAny>,
    parameters: Option<&Bound<'_, PyAny>>,
    driven: Option<&Bound<'_, PyAny>>,
    degrees: Option<&Bound<'_, PyDict>>,
    frequency: Option<(String, String)>,
    resonances: Option<&Bound<'_, PyAny>>,
    keep: Option<&str>,
    smallest_divisor: f64,
    exact: Option<bool>,
    progress: Option<Py<PyAny>>,
    start: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<PyAny>> {
    let space = space(variables, parameters, degrees)?;
    let in_orders = [
        ("parameters", parameters.is_some()),
        ("degrees", degrees.is_some()),
        ("frequency", frequency.is_some()),
        ("resonances", resonances.is_some()),
        ("keep", keep.is_some()),
        ("exact", exact.is_some()),
    ];
    let in_orders = in_orders.into_iter().find(|(_, given)| *given).map(|(name, _)| name);
    let (mut given, driven_float) = DrivenPhases::of(driven)?;
    if given.is_about_the_periodic_motion(in_orders)? {
        let order = self::order("order", order, 0, MAX_DRIVEN_ORDER)?;
        given.start = start.map(|start| numbers_of("start", start)).transpose()?;
        let form = crate::driven::normalized(py, hamiltonian, order, &space, given, smallest_divisor, progress)?;
        return form.into_py_any(py);
    }
    if start.is_some() {
        let message = "start: it belongs to a form about a periodic motion, with driven and without the options of forms in orders";
        return Err(error::input("start", "given", "None", message.to_owned()));
    }
    let names: Vec<&str> = given.names.iter().map(String::as_str).collect();
    let space = space.with_driven(&names).map_err(|problem| error::algebra_of("driven", problem))?;
    let symbols = symbols(py, hamiltonian, variables, parameters)?;
    let order = self::order("order", order, 0, <BigRational as RealField>::MAX_ORDER)?;
    let Expression { polynomial, float } = Expression::new("hamiltonian", hamiltonian, &space)?;
    let (values, given_float) = values(parameters)?;
    let values: Vec<_> = values.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
    let valued = space.with_values(&polynomial, &values);
    let (polynomial, space) = valued.map_err(|problem| error::algebra_of("parameters", problem))?;
    let (polynomial, space) = match frequency {
        None => (polynomial, space),
        Some((letter, root)) => {
            space.scaled(&polynomial, &letter, &root).map_err(|problem| error::algebra_of("frequency", problem))?
        }
    };
    let resonances = kept(resonances, smallest_divisor, keep)?;
    let in_floats = match exact {
        Some(exact) => Some(!exact),
        None => (float || given_float || driven_float).then_some(true),
    };
    let form = progress::reported(py, progress, |tell: &mut Progress<'_>| {
        about_the_equilibrium(&polynomial, order, &space, &given.phases, &resonances, in_floats, tell)
    })?;
    BirkhoffNormalForm::new(form, symbols).into_py_any(py)
}

/// The form in floats or in rational numbers; by default in floats where rational numbers have no frequencies.
fn about_the_equilibrium(
    hamiltonian: &Polynomial<BigRational>,
    order: usize,
    space: &PhaseSpace,
    driven: &[(BigRational, f64)],
    resonances: &Resonances,
    in_floats: Option<bool>,
    tell: &mut Progress<'_>,
) -> Result<Form, Algebra> {
    if in_floats != Some(true) {
        match normalize_driven(hamiltonian, order, space, driven, resonances, tell) {
            Err(Algebra::FrequencyIrrational { .. } | Algebra::SpectrumIrrational { .. }) if in_floats.is_none() => {}
            result => return result.map(Form::Exact),
        }
    }
    let driven: Vec<_> = driven.iter().map(|(frequency, phase)| (frequency.to_float(), *phase)).collect();
    normalize_driven(&rounded(hamiltonian), order, space, &driven, resonances, tell).map(Form::Float)
}

/// The resonances to keep.
fn kept(resonances: Option<&Bound<'_, PyAny>>, smallest_divisor: f64, keep: Option<&str>) -> PyResult<Resonances> {
    let vectors = resonances.map_or(Ok(Vec::new()), vectors)?;
    let resonances = Resonances::new(&vectors.iter().map(Vec::as_slice).collect::<Vec<_>>());
    let resonances =
        resonances.and_then(|some| some.with_smallest_divisor(smallest_divisor)).map_err(error::algebra)?;
    match keep {
        None => Ok(resonances),
        Some("hyperbolic") => Ok(resonances.with_centre()),
        Some(other) => {
            let message = format!("keep = {other:?}: it must be \"hyperbolic\" or None");
            Err(error::input("keep", other, "hyperbolic", message))
        }
    }
}

/// The SymPy symbols among the arguments by their names, with their assumptions.
fn symbols(
    py: Python<'_>,
    hamiltonian: &Bound<'_, PyAny>,
    variables: &Bound<'_, PyAny>,
    parameters: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<PyDict>> {
    let symbols = PyDict::new(py);
    let mut found = Vec::new();
    if hamiltonian.hasattr("free_symbols")? {
        found.extend(items(&hamiltonian.getattr("free_symbols")?).unwrap_or_default());
    }
    found.extend(items(variables).unwrap_or_default().iter().filter_map(items).flatten());
    found.extend(parameters.and_then(items).unwrap_or_default());
    for symbol in found {
        if symbol.hasattr("assumptions0")? {
            symbols.set_item(symbol.str()?, symbol)?;
        }
    }
    Ok(symbols.unbind())
}

/// The phase space of names, or of objects that print as names.
fn space(
    variables: &Bound<'_, PyAny>,
    parameters: Option<&Bound<'_, PyAny>>,
    degrees: Option<&Bound<'_, PyDict>>,
) -> PyResult<PhaseSpace> {
    let wanted = "pairs (q, p), such as [(\"x\", \"p\")]";
    let refused = || refused("variables", wanted, variables);
    let mut pairs = Vec::new();
    for pair in items(variables).ok_or_else(refused)? {
        let pair = items(&pair).filter(|pair| pair.len() == 2).ok_or_else(refused)?;
        pairs.push((pair[0].str()?.to_string(), pair[1].str()?.to_string()));
    }
    let mut names = Vec::new();
    if let Some(list) = parameters {
        for name in items(list).ok_or_else(|| self::refused("parameters", "names, such as [\"a\"]", list))? {
            names.push(name.str()?.to_string());
        }
    }
    let pairs: Vec<_> = pairs.iter().map(|(q, p)| (q.as_str(), p.as_str())).collect();
    let names: Vec<_> = names.iter().map(String::as_str).collect();
    let space = PhaseSpace::new(&pairs).map_err(|problem| error::algebra_of("variables", problem))?;
    let mut space = space.with_parameters(&names).map_err(|problem| error::algebra_of("parameters", problem))?;
    for (name, degree) in degrees.into_iter().flatten() {
        let degree = self::order("degrees", &degree, 0, MAX_EXPONENT as usize)? as u32;
        let name = name.str()?.to_string();
        space = space.with_degree(&name, degree).map_err(|problem| error::algebra_of("degrees", problem))?;
    }
    Ok(space)
}

/// The numbers of the parameters that have one, and whether one of them is a float.
fn values(parameters: Option<&Bound<'_, PyAny>>) -> PyResult<(Vec<(String, BigRational)>, bool)> {
    let (mut values, mut any_float) = (Vec::new(), false);
    let dictionary = parameters.and_then(|parameters| parameters.cast::<PyDict>().ok());
    for (name, value) in dictionary.into_iter().flatten().filter(|(_, value)| !value.is_none()) {
        let name = name.str()?.to_string();
        let (value, float) = number(&format!("parameters[{name:?}]"), &value)?;
        values.push((name, value));
        any_float |= float;
    }
    Ok((values, any_float))
}

/// The resonances as vectors of integers.
fn vectors(resonances: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<i64>>> {
    let refused = || refused("resonances", "vectors of integers, such as [(1, -1)]", resonances);
    let vector = |vector: &Bound<'_, PyAny>| {
        let entries = items(vector).ok_or_else(refused)?;
        entries.iter().map(|entry| entry.extract().map_err(|_| refused())).collect()
    };
    items(resonances).ok_or_else(refused)?.iter().map(vector).collect()
}

/// The items of a sequence; None for a text.
fn items<'py>(sequence: &Bound<'py, PyAny>) -> Option<Vec<Bound<'py, PyAny>>> {
    if sequence.is_instance_of::<PyString>() {
        return None;
    }
    sequence.try_iter().ok()?.collect::<PyResult<_>>().ok()
}

fn refused(argument: &str, wanted: &str, value: &Bound<'_, PyAny>) -> PyErr {
    let shown = value.repr().map_or_else(|_| "(cannot be printed)".to_owned(), |text| text.to_string());
    PyTypeError::new_err(format!("{argument} must be a sequence of {wanted}, not {shown}"))
}
