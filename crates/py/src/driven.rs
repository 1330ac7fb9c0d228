//! `andoyer.Driven`, and the driven phases of `normalize`.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use andoyer_series::periodic::{DrivenNormalForm as Inner, SampledHamiltonian, terms_at};
use andoyer_series::progress::Progress;
use andoyer_series::real_field::RealField;
use andoyer_series::{Error as Algebra, Monomial, PhaseSpace, Polynomial};
use num_rational::BigRational;
use pyo3::exceptions::{PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};

use crate::array::numbers_of;
use crate::driven_form::DrivenNormalForm;
use crate::error;
use crate::expression::{Expression, number};
use crate::form::rounded;
use crate::progress;

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
/// names : str or sequence of str, optional
///     The names of the phases in the text of the Hamiltonian, which may contain ``cos(j*M)`` and ``sin(j*M)``; by default ``M``, with several phases ``M1``, ``M2``, …
///
/// Raises
/// ------
/// InputError
///     A rate that is 0 or not finite; another number of names than of rates.
/// TypeError
///     Samples that cannot be called.
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
    fn new(rate: &Bound<'_, PyAny>, samples: Option<Py<PyAny>>, names: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let rates = numbers_of("rate", rate)?;
        rates.iter().try_for_each(|&rate| valid("rate", "rate", rate))?;
        if rates.is_empty() {
            return Err(error::input(
                "rate",
                0_usize,
                1_usize,
                "rate is empty: a rate of each driven phase".to_owned(),
            ));
        }
        if let Some(samples) = samples.as_ref().map(|samples| samples.bind(rate.py())).filter(|one| !one.is_callable())
        {
            return Err(PyTypeError::new_err(format!(
                "samples must be a callable, not {}",
                samples.get_type().name()?
            )));
        }
        let named = |names: &Bound<'_, PyAny>| match names.cast::<PyString>() {
            Ok(name) => Ok(vec![name.to_string()]),
            Err(_) => names.extract::<Vec<String>>(),
        };
        let names = names.map(named).transpose()?;
        let count = rates.len();
        let known = || if count == 1 { vec!["M".to_owned()] } else { (1..=count).map(|k| format!("M{k}")).collect() };
        let names = names.unwrap_or_else(known);
        if names.len() != count {
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
pub(crate) struct DrivenPhases {
    pub(crate) names: Vec<String>,
    /// The rate of each phase and its value at time 0.
    pub(crate) phases: Vec<(BigRational, f64)>,
    samples: Option<Py<PyAny>>,
    /// Whether they are a [`Driven`].
    sampled: bool,
    /// A state near the periodic motion at the phase 0.
    pub(crate) start: Option<Vec<f64>>,
}

impl DrivenPhases {
    /// Those of a dict or of a [`Driven`], and whether a rate is a float.
    pub(crate) fn of(driven: Option<&Bound<'_, PyAny>>) -> PyResult<(Self, bool)> {
        let mut given = Self { names: Vec::new(), phases: Vec::new(), samples: None, sampled: false, start: None };
        let Some(driven) = driven else { return Ok((given, false)) };
        if let Ok(driven) = driven.cast::<Driven>() {
            let Driven { rates, samples, names } = driven.get();
            // `Driven` has refused what is not finite.
            let exact = rates.iter().filter_map(|&rate| BigRational::from_float(rate));
            let phases = exact.map(|rate| (rate, 0.0)).collect();
            let samples = samples.as_ref().map(|samples| samples.clone_ref(driven.py()));
            return Ok((Self { names: names.clone(), phases, samples, sampled: true, start: None }, true));
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
            valid("driven", &argument, rate.to_float())?;
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

/// Refuses a rate that is 0 or not finite; `name` is the argument or its entry.
fn valid(argument: &str, name: &str, rate: f64) -> PyResult<()> {
    if rate.is_normal() {
        return Ok(());
    }
    let message = format!("{name} = {rate}: the rate of a driven phase must be a finite number other than 0");
    Err(error::input(argument, rate, "finite, not 0", message))
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
    DrivenPhases { names, phases, samples, start, .. }: DrivenPhases,
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
        let system = (&text, &space);
        let compute = |tell: &mut Progress<'_>| {
            Inner::from_state(system, order, &phases, smallest_divisor, start.as_deref(), tell)
        };
        return named(py, progress::reported(py, progress, compute)?);
    };
    let sampler = Sampler { callable, space: &space, text, known: Mutex::default(), failure: Mutex::default() };
    let system =
        SampledHamiltonian::new(space.degrees_of_freedom(), |phases: &[f64]| sampler.terms(phases)).with_start(start);
    let compute = |tell: &mut Progress<'_>| Inner::of(&system, order, &space, &phases, smallest_divisor, tell);
    let form = progress::reported(py, progress, compute);
    if let Some(problem) = sampler.failure.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(problem);
    }
    named(py, form?)
}

/// The form; a warning names a periodic motion that does not continue the response to a weak drive.
fn named(py: Python<'_>, form: Inner) -> PyResult<DrivenNormalForm> {
    if form.form().is_opposite() {
        let said = c"the periodic motion is out of phase with the response to a weak drive: the drive is too strong, or too near a resonance, for one that continues the equilibrium, or the iteration passed it; start= chooses another";
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), said, 1)?;
    }
    Ok(DrivenNormalForm::new(form))
}
