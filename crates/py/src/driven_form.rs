//! `andoyer.DrivenNormalForm`.

use std::convert::Infallible;

use andoyer_series::PhaseSpace;
use andoyer_series::birkhoff::Mode;
use andoyer_series::periodic::{Divisor, DrivenForm, DrivenNormalForm as Inner};
use andoyer_series::print::Part;
use numpy::{IntoPyArray, PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::array::{Rows, Times, fixed_length, numbers_of, row_by_row, write};
use crate::birkhoff::frequency;
use crate::computing::detached;
use crate::domain::Domain;
use crate::error;
use crate::expression::{Expression, actions, real};
use crate::form::rounded;
use crate::progress;
use crate::values::immutable;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

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
    pub(crate) fn new(form: Inner) -> Self {
        Self { form }
    }

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

immutable!(DrivenNormalForm);

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

    /// Floquet's exponents on the branch of the rotation number: ω of a centre, the mean rate at which a real solution turns, negative if it turns backwards; iλ of a saddle.
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
    ///
    /// At most 20. Where a saddle takes part the value is the modulus.
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
    ///
    /// Raises
    /// ------
    /// InputError
    ///     Another number of phases; a NaN.
    fn periodic<'py>(&self, phases: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let phases_given = numbers_of("phases", phases)?;
        let expected = self.form().grid().phases();
        if phases_given.len() != expected {
            return Err(error::shape("phases", &[phases_given.len()], &format!("({expected},)")));
        }
        if let Some(phase) = phases_given.iter().find(|phase| !phase.is_finite()) {
            return Err(error::input(
                "phases",
                *phase,
                "finite",
                format!("phases contains {phase}: it must be finite"),
            ));
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
    ///     A polynomial in the variables.
    /// time : float, optional
    ///     [unit of time of the rates]
    ///
    /// Returns
    /// -------
    /// dict
    ///     Coefficients by the exponents of q₁, p₁, q₂, …, of the new variables.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A text that is not a polynomial of the variables; a NaN.
    #[pyo3(signature = (function, time=0.0))]
    fn direct<'py>(&self, function: &Bound<'py, PyAny>, time: f64) -> PyResult<Bound<'py, PyDict>> {
        self.expressed(function, time, true)
    }

    /// Expresses a function of the new variables in the old ones at a time. Arguments, result and errors are as of `direct`, with old and new variables exchanged.
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
    ///     0 by default [unit of time of the rates].
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,) or (m, 2n)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN.
    /// TheoryError
    ///     A state beyond the range of the series: the transformation misses it by more than 1 % of its distance from the periodic motion.
    #[pyo3(signature = (states, time=None))]
    fn to_normal<'py>(&self, states: &Bound<'py, PyAny>, time: Option<&Bound<'py, PyAny>>) -> PyResult<Array<'py>> {
        let n = 2 * self.space().degrees_of_freedom();
        Rows::new("states", states, n)?
            .map_at(n, time, |state, time| self.form().at(&self.phases(time)).to_normal(state))
    }

    /// Transforms new variables to states. Shapes and errors are those of `to_normal`.
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

    /// The actions of states, shape (n,) or (m, n). Along a motion they are almost constant. The errors are those of `to_normal`.
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
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n,) or (m, n)
    ///     [rad per unit of time]
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN; a negative action of a centre; a rate that overflows.
    /// TheoryError
    ///     Actions whose states at time 0 are beyond the range of the series.
    fn frequency_map<'py>(&self, actions: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let n = self.space().degrees_of_freedom();
        Rows::new("actions", actions, n)?.map(n, |actions| self.form().frequency_map(actions, &self.phases(0.0)))
    }

    /// Propagates a state by the normal form to times after it.
    ///
    /// Parameters
    /// ----------
    /// state : array_like, shape (2n,)
    /// times : float or array_like, shape (m,)
    ///     Counted from the time of the state [unit of time of the rates].
    /// time : float, optional
    ///     The time of the state, on which the phases depend.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,) or (m, 2n)
    ///
    /// Raises
    /// ------
    /// InputError, TheoryError
    ///     As of `to_normal`.
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
    /// InputError, TheoryError, RepresentationError
    ///     Names, rates, exponents or a Hamiltonian that `normalize` refuses as well.
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
    /// ``from_normal(normal, time)`` and ``to_normal(state, time)`` transform arrays q₁, p₁, q₂, …, the latter by the inverse series, which ends at the order; ``actions(normal)`` returns the actions, and
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

    fn __repr__(&self) -> String {
        let (names, form) = (self.space().driven().join(", "), self.form());
        format!("<DrivenNormalForm of order {} with {names}, {} times>", form.order(), form.grid().times())
    }

    /// K as text, in the actions: ``I_q`` of a centre, ``(q*p)`` of a saddle.
    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, |never: Infallible| match never {}, || Ok(self.form.to_string()))
    }
}
