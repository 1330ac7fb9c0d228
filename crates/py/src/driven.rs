//! `andoyer.Driven` and `andoyer.DrivenNormalForm`.

use std::collections::HashMap;
use std::convert::Infallible;
use std::sync::{Mutex, PoisonError};

use andoyer_series::birkhoff::Mode;
use andoyer_series::periodic::{Divisor, DrivenForm, DrivenNormalForm as Inner, SampledHamiltonian, terms_at};
use andoyer_series::print::Part;
use andoyer_series::progress::Progress;
use andoyer_series::real_field::RealField;
use andoyer_series::{Error as Algebra, Monomial, PhaseSpace, Polynomial};
use num_rational::BigRational;
use numpy::{IntoPyArray, PyArray1, PyArrayDyn};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::array::{Rows, Times, fixed_length, numbers_of, row_by_row, write};
use crate::birkhoff::frequency;
use crate::computing::detached;
use crate::domain::Domain;
use crate::error;
use crate::expression::{Expression, actions, number, real};
use crate::form::rounded;
use crate::progress;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
/// The terms of a Hamiltonian at one time.
type Terms = Vec<(Monomial, f64)>;

/// Coefficients that are periodic functions of driven phases M = n t, for `normalize`: the normal form about the periodic motion.
///
/// Parameters
/// ----------
/// rate : float or sequence of float
///     The rate n of each phase [rad per unit of time], not 0.
/// samples : callable, optional
///     A function of the phases [rad], one number for each, that returns {exponents: coefficient} at these phases; the exponents are those of `variables`. Its terms are
///     added to those of the Hamiltonian. It is called at the times of a grid, and must have the period 2π in each phase.
/// names : sequence of str, optional
///     The names of the phases in the text of the Hamiltonian, which may contain ``cos(j*M)`` and ``sin(j*M)``; by default ``M``, with several phases ``M1``, ``M2``, …
///
/// Raises
/// ------
/// InputError
///     A rate that is 0 or not finite; another number of names than of rates.
///
/// Examples
/// --------
/// Mathieu's equation x″ + (a − 2q cos 2t) x = 0 at a = 0.09, q = 0.1: the characteristic exponent.
///
/// >>> form = normalize("(p^2 + 0.09*x^2)/2 - 0.1*x^2*cos(2*M)", 2, [("x", "p")], driven=Driven(1.0))
/// >>> round(form.frequencies[0], 12)
/// 0.309063060648
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Driven {
    rates: Vec<f64>,
    samples: Option<Py<PyAny>>,
    names: Vec<String>,
}

#[pymethods]
impl Driven {
    #[new]
    #[pyo3(signature = (rate, samples=None, names=None))]
    fn new(rate: &Bound<'_, PyAny>, samples: Option<Py<PyAny>>, names: Option<Vec<String>>) -> PyResult<Self> {
        let rates = numbers_of("rate", rate)?;
        if let Some(rate) = rates.iter().find(|rate| !rate.is_normal()) {
            let message = format!("rate = {rate}: the rate of a driven phase must be a finite number other than 0");
            return Err(error::input("rate", *rate, "finite, not 0", message));
        }
        let count = rates.len();
        let known = || if count == 1 { vec!["M".to_owned()] } else { (1..=count).map(|k| format!("M{k}")).collect() };
        let names = names.unwrap_or_else(known);
        if names.len() != count || count == 0 {
            let message = format!("names: {} names for {count} rates", names.len());
            return Err(error::input("names", names.len(), count, message));
        }
        Ok(Self { rates, samples, names })
    }

    /// The rates of the phases [rad per unit of time].
    #[getter]
    fn rates(&self) -> Vec<f64> {
        self.rates.clone()
    }

    /// The names of the phases.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }
}

/// The samples of a callable, each taken once, and the exception that ended them.
struct Sampler<'a> {
    callable: &'a Py<PyAny>,
    space: &'a PhaseSpace,
    text: Polynomial<f64>,
    known: Mutex<HashMap<Vec<u64>, Terms>>,
    failure: Mutex<Option<PyErr>>,
}

impl Sampler<'_> {
    fn terms(&self, phases: &[f64]) -> Result<Terms, Algebra> {
        let key: Vec<u64> = phases.iter().map(|phase| phase.to_bits()).collect();
        let held = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(terms) = held().get(&key) {
            return Ok(terms.clone());
        }
        let mut terms = terms_at(&self.text, self.space, phases)?;
        match Python::attach(|py| self.called(self.callable.bind(py), phases)) {
            Ok(more) => terms.extend(more),
            Err(problem) => {
                *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(problem);
                return Err(Algebra::Interrupted { done: 0, of: 0 });
            }
        }
        held().insert(key, terms.clone());
        Ok(terms)
    }

    fn called(&self, callable: &Bound<'_, PyAny>, phases: &[f64]) -> PyResult<Terms> {
        let result = callable.call1(PyTuple::new(callable.py(), phases)?)?;
        let space = self.space.still();
        let Expression { polynomial, .. } = Expression::new("samples", &result, &space)?;
        Ok(rounded(&polynomial).terms().map(|(monomial, c)| (monomial, *c)).collect())
    }
}

/// The driven phases as they are given.
pub(crate) struct Given {
    pub(crate) names: Vec<String>,
    /// The rate of each phase and its value at time 0.
    pub(crate) phases: Vec<(BigRational, f64)>,
    samples: Option<Py<PyAny>>,
    /// Whether they are a [`Driven`].
    sampled: bool,
}

impl Given {
    /// Those of a dict or of a [`Driven`], and whether a rate is a float.
    pub(crate) fn of(driven: Option<&Bound<'_, PyAny>>) -> PyResult<(Self, bool)> {
        let mut given = Self { names: Vec::new(), phases: Vec::new(), samples: None, sampled: false };
        let Some(driven) = driven else { return Ok((given, false)) };
        if let Ok(driven) = driven.cast::<Driven>() {
            let Driven { rates, samples, names } = driven.get();
            for &rate in rates {
                given.phases.push((number("rate", rate.into_pyobject(driven.py())?.as_any())?.0, 0.0));
            }
            let samples = samples.as_ref().map(|samples| samples.clone_ref(driven.py()));
            return Ok((Self { names: names.clone(), samples, sampled: true, ..given }, true));
        }
        let Ok(dict) = driven.cast::<PyDict>() else { return Err(wrong(driven)) };
        let mut any_float = false;
        for (name, value) in dict {
            let name = name.str()?.to_string();
            let argument = format!("driven[{name:?}]");
            let pair = value.cast::<PyTuple>().ok();
            if let Some(pair) = pair.filter(|pair| pair.len() != 2) {
                let message =
                    format!("{argument} has {} entries: it must be a frequency or (frequency, phase)", pair.len());
                return Err(error::input("driven", pair.len(), 2_usize, message));
            }
            let (rate, start) = match pair {
                Some(pair) => (pair.get_item(0)?, crate::array::number(&argument, &pair.get_item(1)?)?),
                None => (value.clone(), 0.0),
            };
            let (rate, float) = number(&argument, &rate)?;
            given.names.push(name);
            given.phases.push((rate, start));
            any_float |= float;
        }
        Ok((given, any_float))
    }

    /// Whether the form is about the periodic motion: `in_orders` is an option that only the form about the equilibrium has.
    pub(crate) fn is_about_the_periodic_motion(&self, in_orders: Option<&'static str>) -> PyResult<bool> {
        match in_orders {
            Some(name) if self.sampled => {
                let message = format!("{name}: a form with a Driven has none; driven={{name: rate}} takes them");
                Err(error::input(name, "given", "None", message))
            }
            _ => Ok(in_orders.is_none() && !self.phases.is_empty()),
        }
    }
}

fn wrong(driven: &Bound<'_, PyAny>) -> PyErr {
    let kind = driven.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string());
    PyTypeError::new_err(format!("driven must be a dict of rates by name or a Driven, not {kind}"))
}

/// The normal form of `normalize` about a periodic motion.
pub(crate) fn normalized(
    py: Python<'_>,
    hamiltonian: &Bound<'_, PyAny>,
    order: usize,
    space: &PhaseSpace,
    Given { names, phases, samples, .. }: Given,
    smallest_divisor: f64,
    progress: Option<Py<PyAny>>,
) -> PyResult<DrivenNormalForm> {
    let phases: Vec<(f64, f64)> = phases.iter().map(|(rate, start)| (rate.to_float(), *start)).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let space = space.clone().with_driven(&names).map_err(|problem| error::algebra_of("driven", problem))?;
    let text = match hamiltonian.is_none() {
        true => Polynomial::zero(),
        false => rounded(&Expression::new("hamiltonian", hamiltonian, &space)?.polynomial),
    };
    let Some(callable) = &samples else {
        let compute = |tell: &mut Progress<'_>| Inner::new(&text, order, &space, &phases, smallest_divisor, tell);
        return Ok(DrivenNormalForm { form: progress::reported(py, progress, compute)? });
    };
    let sampler = Sampler { callable, space: &space, text, known: Mutex::default(), failure: Mutex::default() };
    let system = SampledHamiltonian::new(space.degrees_of_freedom(), |phases: &[f64]| sampler.terms(phases));
    let compute = |tell: &mut Progress<'_>| Inner::of(&system, order, &space, &phases, smallest_divisor, tell);
    let form = progress::reported(py, progress, compute);
    if let Some(problem) = sampler.failure.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(problem);
    }
    Ok(DrivenNormalForm { form: form? })
}

/// The normal form of a Hamiltonian about a periodic motion, from `normalize` with driven phases.
///
/// The periodic motion x̄(M) and Floquet's symplectic change P(M) are taken out exactly, so the drive may be strong; what remains is graded by degree. The new variables
/// (q, p) of a centre have the action I = (q² + p²)/2, U = p + iq = √(2I) e^{iφ}; those of a saddle q p, with q the unstable direction. Methods on states take a time, or as
/// many times as states; a phase is M₀ + n times the time. All numbers are floats.
///
/// Examples
/// --------
/// >>> form = normalize("(p^2 + x^2)/2 + x^4/4 - 0.3*x*cos(M)", 6, [("x", "p")], driven={"M": 0.4})
/// >>> x, p = form.periodic(0.0)
/// >>> round(float(x), 6)
/// 0.354788
/// >>> form.trajectory([0.4, 0.0], [0.0, 1.0]).shape
/// (2, 2)
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct DrivenNormalForm {
    form: Inner,
}

impl DrivenNormalForm {
    fn form(&self) -> &DrivenForm {
        self.form.form()
    }

    fn space(&self) -> &PhaseSpace {
        self.form.space()
    }

    fn phases(&self, time: f64) -> Vec<f64> {
        self.form.phases(time)
    }

    fn expressed<'py>(&self, function: &Bound<'py, PyAny>, time: f64, direct: bool) -> PyResult<Bound<'py, PyDict>> {
        let py = function.py();
        let space = self.space().still();
        let function = rounded(&Expression::new("function", function, &space)?.polynomial);
        let phases = self.phases(time);
        let image = progress::reported(py, None, |tell| match direct {
            true => self.form().direct(&function, &phases, tell),
            false => self.form().inverse(&function, &phases, tell),
        })?;
        real(py, &image, &space)
    }
}

#[pymethods]
impl DrivenNormalForm {
    /// The order N: terms to degree N + 2.
    #[getter]
    fn order(&self) -> usize {
        self.form().order()
    }

    /// The pairs (q, p).
    #[getter]
    fn variables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let names = &self.space().names()[..2 * self.space().degrees_of_freedom()];
        PyTuple::new(py, names.chunks(2).map(|pair| (pair[0], pair[1])))
    }

    /// The driven phases: {name: (rate, phase at time 0)}.
    #[getter]
    fn driven<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let result = PyDict::new(py);
        for (name, phase) in self.space().driven().into_iter().zip(self.form.driven()) {
            result.set_item(name, phase)?;
        }
        Ok(result)
    }

    /// Floquet's exponents on the branch that continues the frequencies without drive: ω of a centre, negative if its energy is negative; iλ of a saddle.
    #[getter]
    fn frequencies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let number = |mode: &Mode<f64>| frequency(py, &mode.frequency());
        PyTuple::new(py, self.form().modes().iter().map(number).collect::<PyResult<Vec<_>>>()?)
    }

    /// The kind of every mode: "elliptic" or "hyperbolic".
    #[getter]
    fn kinds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.form().modes().iter().map(Mode::kind))
    }

    /// The number of times at which a coefficient is held.
    #[getter]
    fn times(&self) -> usize {
        self.form().grid().times()
    }

    /// The memory of the form [bytes].
    #[getter]
    fn memory(&self) -> usize {
        self.form().memory()
    }

    /// The smallest divisors k·ω + j·n of the transformation: pairs of the integers (k, j) and the value [rad per unit of time], the smallest first.
    #[getter]
    fn divisors<'py>(&self, py: Python<'py>) -> PyResult<Vec<(Bound<'py, PyTuple>, f64)>> {
        let pair = |divisor: &Divisor| Ok((PyTuple::new(py, &divisor.multiples)?, divisor.value));
        self.form().divisors().iter().map(pair).collect()
    }

    /// The periodic motion at phases.
    ///
    /// Parameters
    /// ----------
    /// phases : float or array_like, shape (number of phases,)
    ///     M of each phase [rad].
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,)
    ///     q₁, p₁, q₂, p₂, …
    fn periodic<'py>(&self, phases: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let phases_given = numbers_of("phases", phases)?;
        let expected = self.form().grid().phases();
        if phases_given.len() != expected {
            return Err(error::shape("phases", &[phases_given.len()], &format!("({expected},)")));
        }
        Ok(self.form().periodic(&phases_given).into_pyarray(phases.py()))
    }

    /// K as a function of the actions: coefficients by exponents of I₁, I₂, ….
    fn in_actions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        actions(py, &self.form().in_actions().map_err(error::algebra)?, &self.space().still())
    }

    /// Expresses a function of the old variables in the new ones at a time.
    ///
    /// Parameters
    /// ----------
    /// function : str, dict or SymPy expression
    /// time : float, optional
    #[pyo3(signature = (function, time=0.0))]
    fn direct<'py>(&self, function: &Bound<'py, PyAny>, time: f64) -> PyResult<Bound<'py, PyDict>> {
        self.expressed(function, time, true)
    }

    /// Expresses a function of the new variables in the old ones at a time.
    ///
    /// Parameters
    /// ----------
    /// function : str, dict or SymPy expression
    /// time : float, optional
    #[pyo3(signature = (function, time=0.0))]
    fn inverse<'py>(&self, function: &Bound<'py, PyAny>, time: f64) -> PyResult<Bound<'py, PyDict>> {
        self.expressed(function, time, false)
    }

    /// Transforms states to the new variables, by iteration on the inverse of this transformation.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// time : float or array_like, shape (m,), optional
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN.
    #[pyo3(signature = (states, time=None))]
    fn to_normal<'py>(&self, states: &Bound<'py, PyAny>, time: Option<&Bound<'py, PyAny>>) -> PyResult<Array<'py>> {
        let n = 2 * self.space().degrees_of_freedom();
        Rows::new("states", states, n)?
            .map_at(n, time, |state, time| self.form().at(&self.phases(time)).to_normal(state))
    }

    /// Transforms new variables to states. The errors are those of `to_normal`.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// time : float or array_like, shape (m,), optional
    #[pyo3(signature = (states, time=None))]
    #[expect(clippy::wrong_self_convention, reason = "the pair of to_normal")]
    fn from_normal<'py>(&self, states: &Bound<'py, PyAny>, time: Option<&Bound<'py, PyAny>>) -> PyResult<Array<'py>> {
        let n = 2 * self.space().degrees_of_freedom();
        let rows = Rows::new("states", states, n)?;
        rows.map_at(n, time, |normal, time| self.form().at(&self.phases(time)).from_normal(normal))
    }

    /// The actions of states. Along a motion they are almost constant.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// time : float or array_like, shape (m,), optional
    #[pyo3(signature = (states, time=None))]
    fn actions<'py>(&self, states: &Bound<'py, PyAny>, time: Option<&Bound<'py, PyAny>>) -> PyResult<Array<'py>> {
        let n = self.space().degrees_of_freedom();
        Rows::new("states", states, 2 * n)?.map_at(n, time, |state, time| {
            Ok(self.form().actions_of(&self.form().at(&self.phases(time)).to_normal(state)?))
        })
    }

    /// The rates ∂K/∂I at actions: frequencies of centres, growth rates of saddles.
    ///
    /// Parameters
    /// ----------
    /// actions : array_like, shape (n,) or (m, n)
    fn frequency_map<'py>(&self, actions: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let n = self.space().degrees_of_freedom();
        Rows::new("actions", actions, n)?.map(n, |actions| self.form().frequencies(actions))
    }

    /// Propagates a state by the normal form to times after it.
    ///
    /// Parameters
    /// ----------
    /// state : array_like, shape (2n,)
    /// times : float or array_like, shape (m,)
    ///     Counted from the time of the state.
    /// time : float, optional
    ///     The time of the state, on which the phases depend.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,) or (m, 2n)
    #[pyo3(signature = (state, times, time=0.0))]
    fn trajectory<'py>(&self, state: &Bound<'py, PyAny>, times: &Bound<'py, PyAny>, time: f64) -> PyResult<Array<'py>> {
        let n = 2 * self.space().degrees_of_freedom();
        let (given, shape) = (fixed_length("state", state, n)?, Times::new(times, None, false)?);
        let (result, phases) = (shape.rows(n)?, self.phases(time));
        let states = row_by_row(state.py(), shape.values()?, shape.values()?.len().max(1), |times| {
            if times.is_empty() { Ok(Vec::new()) } else { self.form().trajectory(&given, &phases, times) }
        })?;
        write(&result)?.as_slice_mut()?.copy_from_slice(&states.concat());
        Ok(result)
    }

    /// The sizes of the orders, and the best order at an amplitude.
    fn domain(&self) -> Domain {
        Domain(self.form().domain())
    }

    /// Writes the Hamiltonian and what was asked of its form as JSON text with a format version. Samples are written as cosines and sines.
    fn to_json(&self) -> PyResult<String> {
        self.form.to_json().map_err(error::algebra)
    }

    /// Reads the text of `to_json`, and computes the form again.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///
    /// Raises
    /// ------
    /// FileError
    ///     A text that is not JSON; another format or version; terms that do not fit; an averaged Hamiltonian that differs from the computed one by more than 1e-8 of its
    ///     largest coefficient.
    ///
    /// Examples
    /// --------
    /// >>> form = normalize("(p^2 + x^2)/2 + x^4/4 - 0.3*x*cos(M)", 6, [("x", "p")], driven={"M": 0.4})
    /// >>> DrivenNormalForm.from_json(form.to_json()) == form
    /// True
    #[classmethod]
    fn from_json(class: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        let form = progress::reported(class.py(), None, |tell| Inner::from_json(text, tell))?;
        Ok(Self { form })
    }

    /// Writes a part of this normal form as LaTeX, for a document that uses amsmath.
    ///
    /// Parameters
    /// ----------
    /// what : {"hamiltonian", "generator", "direct", "inverse"}, optional
    ///     As for `BirkhoffNormalForm.to_latex`. Coefficients are sums of cosines and sines of the phases; terms below the twelfth digit are left out.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``"lagrangian"``.
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_latex(&self, py: Python<'_>, what: &str) -> PyResult<String> {
        let part: Part = what.parse().map_err(error::algebra_as("what"))?;
        detached(py, error::algebra, || self.form.to_latex(part))
    }

    /// Writes a source file with functions that evaluate this normal form. The file needs only the standard library of its language.
    ///
    /// ``from_normal(normal, time)`` and ``to_normal(state, time)`` transform arrays q₁, p₁, q₂, …; ``actions(normal)`` returns the actions, and
    /// ``frequencies(actions)`` the rates ∂K/∂I.
    ///
    /// Parameters
    /// ----------
    /// language : {"c", "rust", "python"}, optional
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``"fortran"``.
    #[pyo3(signature = (language="c"))]
    fn to_code(&self, py: Python<'_>, language: &str) -> PyResult<String> {
        let language = language.parse().map_err(error::algebra)?;
        detached(py, error::algebra, || self.form.to_code(language))
    }

    /// Pickled as its JSON text.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("from_json")?, (slf.get().to_json()?,)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        let (names, form) = (self.space().driven().join(", "), self.form());
        format!("<DrivenNormalForm of order {} with {names}, {} times>", form.order(), form.grid().times())
    }

    /// K as text, in the actions: ``I_q`` of a centre, ``(q*p)`` of a saddle.
    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, |never: Infallible| match never {}, || Ok(self.form.to_string()))
    }
}
