//! `andoyer.BirkhoffNormalForm`.

use std::sync::{Arc, Mutex};

use andoyer_series::{BirkhoffMap, Part, PhaseSpace, Progress};
use num_rational::BigRational;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::array::{Rows, Times, fixed_length, interruptible, number, write};
use crate::computing::detached;
use crate::error::{self, UnknownNameError};
use crate::expression::{Expression, complex, real};
use crate::form::{Form, either, rounded, transformed};
use crate::order::order;
use crate::progress;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// The Birkhoff normal form of a Hamiltonian, from `normalize`: the new Hamiltonian K, and the transformation both ways.
///
/// Polynomials are dictionaries of coefficients by tuple of exponents, in the order q₁, p₁, q₂, p₂, …, parameters: `Fraction` if
/// `exact`, else float. With r = √(a/b) of a pair, the action is I = (q²/r + r p²)/2, and the complex variables are U = r p + i q =
/// √(2rI) e^{iφ} and u = (q + i r p)/(2r); {u; U} = 1, uU = iI.
///
/// States are arrays (2n,) or (m, 2n) of q₁, p₁, q₂, p₂, …; for those methods parameters are given as a dict of numbers by name. The
/// series are truncated: a state of amplitude ε errs by ε^(N+2).
///
/// Examples
/// --------
/// >>> normal_form = normalize("(x**2 + X**2)/2 + x**3", 2, [("x", "X")])
/// >>> print(normal_form)
/// I_x - 15/4*I_x^2
/// >>> normal_form.direct("x")[2, 0], normal_form.inverse("x")[2, 0]
/// (Fraction(-1, 1), Fraction(1, 1))
/// >>> normal_form.trajectory([0.01, 0.0], [0.0, 1.0]).shape
/// (2, 2)
#[pyclass(frozen, eq, module = "andoyer")]
pub(crate) struct BirkhoffNormalForm {
    form: Form,
    /// The maps for the parameters last used.
    map: Mutex<Option<(Vec<f64>, Arc<BirkhoffMap>)>>,
}

impl PartialEq for BirkhoffNormalForm {
    fn eq(&self, other: &Self) -> bool {
        self.form == other.form
    }
}

#[pymethods]
impl BirkhoffNormalForm {
    /// The order N.
    #[getter]
    fn order(&self) -> usize {
        either!(&self.form, form => form.order())
    }

    /// The degree N + 2.
    #[getter]
    fn degree(&self) -> usize {
        self.order() + 2
    }

    /// Whether the coefficients are exact: `Fraction`, not float.
    #[getter]
    fn exact(&self) -> bool {
        matches!(self.form, Form::Exact(_))
    }

    /// The pairs (q, p).
    #[getter]
    fn variables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let space = self.space();
        let names = &space.names()[..2 * space.degrees_of_freedom()];
        PyTuple::new(py, names.chunks(2).map(|pair| (pair[0], pair[1])))
    }

    /// The parameters.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let space = self.space();
        PyTuple::new(py, &space.names()[2 * space.degrees_of_freedom()..])
    }

    /// The frequencies ω = ±√(ab) at the origin, negative where a and b are.
    #[getter]
    fn frequencies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        either!(&self.form, form => PyTuple::new(py, form.frequencies()))
    }

    /// The ratios r = √(a/b).
    #[getter]
    fn ratios<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        either!(&self.form, form => PyTuple::new(py, form.ratios()))
    }

    /// K in the actions: exponents of I₁, I₂, …, parameters. The constant term of H is in it.
    ///
    /// Raises
    /// ------
    /// ResonanceError
    ///     K has resonant terms, and is no function of the actions alone.
    fn in_actions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let slots = self.space().degrees_of_freedom() + self.space().parameters();
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.in_actions())?, slots))
    }

    /// K in the complex variables: (re, im) by exponents of u₁, U₁, u₂, U₂, …, parameters.
    fn in_complex<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        match &self.form {
            Form::Exact(form) => {
                complex::<BigRational>(py, &detached(py, error::algebra, || Ok(form.in_complex()))?, self.slots())
            }
            Form::Float(form) => {
                complex::<f64>(py, &detached(py, error::algebra, || Ok(form.in_complex()))?, self.slots())
            }
        }
    }

    /// K in the new real variables.
    fn in_real<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.in_real())?, self.slots()))
    }

    /// Generating function S_m in the real variables, of degree m + 2.
    ///
    /// Parameters
    /// ----------
    /// m : int
    ///     1 to `order`.
    ///
    /// Raises
    /// ------
    /// OrderError
    ///     ``0``, or above the order.
    fn generator<'py>(&self, py: Python<'py>, m: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let m = order("m", m, 1, self.order())?;
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.generator(m))?, self.slots()))
    }

    /// A function of the old variables in the new ones, complete to degree d + N, d its lowest positive degree.
    ///
    /// Parameters
    /// ----------
    /// function : str, dict or SymPy expression
    ///     As the Hamiltonian of `normalize`; a variable by its name.
    fn direct<'py>(&self, py: Python<'py>, function: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        self.transformed(py, function, true)
    }

    /// A function of the new variables in the old ones, complete to degree d + N, d its lowest positive degree.
    ///
    /// Parameters
    /// ----------
    /// function : str, dict or SymPy expression
    ///     As the Hamiltonian of `normalize`; a variable by its name.
    fn inverse<'py>(&self, py: Python<'py>, function: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        self.transformed(py, function, false)
    }

    /// The new variables of states.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Raises
    /// ------
    /// ShapeError
    ///     Another length.
    /// IntervalError
    ///     A NaN, or a result that overflows.
    #[pyo3(signature = (states, parameters=None))]
    fn to_normal<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, n)?.map(n, |state| map.to_normal(state))
    }

    /// The states of new variables; errors are those of `to_normal`.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    #[pyo3(signature = (states, parameters=None))]
    #[expect(clippy::wrong_self_convention, reason = "the pair of to_normal")]
    fn from_normal<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, n)?.map(n, |state| map.from_normal(state))
    }

    /// The actions of states, which hardly change along a motion unless a resonance exchanges them.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n,) or (m, n)
    ///
    /// Raises
    /// ------
    /// ShapeError
    ///     Another length.
    /// IntervalError
    ///     A NaN, or a result that overflows.
    #[pyo3(signature = (states, parameters=None))]
    fn actions<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, 2 * n)?.map(n, |state| map.actions(state))
    }

    /// The frequencies Ω = ∂K/∂I at actions.
    ///
    /// Parameters
    /// ----------
    /// actions : array_like, shape (n,) or (m, n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Raises
    /// ------
    /// ResonanceError
    ///     K has resonant terms.
    /// ShapeError
    ///     Another length.
    /// IntervalError
    ///     A NaN, or an action below 0.
    #[pyo3(signature = (actions, parameters=None))]
    fn frequency_map<'py>(
        &self,
        actions: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (self.space().degrees_of_freedom(), self.map(actions.py(), parameters)?);
        Rows::new("actions", actions, n)?.map(n, |actions| map.frequencies(actions))
    }

    /// The states at times after that of `state`: the angles move uniformly with the frequencies at its actions.
    ///
    /// Parameters
    /// ----------
    /// state : array_like, shape (2n,)
    /// times : float or array_like, shape (m,)
    /// parameters : dict of {str: float}, optional
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,) or (m, 2n)
    ///
    /// Raises
    /// ------
    /// ResonanceError
    ///     K has resonant terms.
    /// ShapeError
    ///     Another length.
    /// IntervalError
    ///     A NaN, or a result that overflows.
    #[pyo3(signature = (state, times, parameters=None))]
    fn trajectory<'py>(
        &self,
        state: &Bound<'py, PyAny>,
        times: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (py, n) = (state.py(), 2 * self.space().degrees_of_freedom());
        let map = self.map(py, parameters)?;
        let (state, times) = (fixed_length("state", state, n)?, Times::new(times)?);
        let result = times.rows(n)?;
        let states = interruptible(py, times.values()?, 1, |times| map.trajectory(&state, times))?;
        write(&result)?.as_slice_mut()?.copy_from_slice(&states.concat());
        Ok(result)
    }

    /// A part of this normal form as SymPy expressions. SymPy is imported here and nowhere else.
    ///
    /// Symbols are the names of variables and parameters and ``I_q`` for the action of (q, p), without assumptions: new variables in "direct",
    /// old ones in "inverse". `sympy.latex`, `ccode` and `lambdify` lead on from there.
    ///
    /// Parameters
    /// ----------
    /// what : {"hamiltonian", "generator", "direct", "inverse"}, optional
    ///
    /// Returns
    /// -------
    /// sympy.Expr, list of sympy.Expr or dict of {str: sympy.Expr}
    ///     "hamiltonian": K in the actions, or with resonant terms in the new variables. "generator": S_1 … S_N. "direct", "inverse": every
    ///     old variable in the new ones, every new one in the old ones.
    ///
    /// Raises
    /// ------
    /// UnknownNameError
    ///     ``"lagrangian"``.
    /// ImportError
    ///     SymPy is not installed: the extra ``andoyer[sympy]`` brings it.
    ///
    /// Examples
    /// --------
    /// >>> normalize("(x**2 + X**2)/2 + x**3", 2, [("x", "X")]).to_sympy()
    /// -15*I_x**2/4 + I_x
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_sympy<'py>(slf: &Bound<'py, Self>, what: &str) -> PyResult<Bound<'py, PyAny>> {
        let _: Part = what.parse().map_err(error::algebra)?;
        slf.py().import("andoyer._symbolic")?.call_method1("birkhoff", (slf, what))
    }

    fn __repr__(&self) -> String {
        let (space, numbers) = (self.space(), if self.exact() { "exact" } else { "float" });
        format!("<BirkhoffNormalForm of order {} in {}, {numbers}>", self.order(), space.names().join(", "))
    }

    /// K as text, in the actions or, with resonant terms, in the complex variables.
    fn __str__(&self, py: Python<'_>) -> String {
        py.detach(|| either!(&self.form, form => form.to_string()))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

impl BirkhoffNormalForm {
    pub(crate) fn new(form: Form) -> Self {
        Self { form, map: Mutex::new(None) }
    }

    fn space(&self) -> &PhaseSpace {
        either!(&self.form, form => form.space())
    }

    fn slots(&self) -> usize {
        self.space().names().len()
    }

    fn transformed<'py>(
        &self,
        py: Python<'py>,
        function: &Bound<'py, PyAny>,
        direct: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let Expression { polynomial, .. } = Expression::new("function", function, self.space())?;
        match &self.form {
            Form::Exact(form) => real(py, &transformed(py, form, &polynomial, direct)?, self.slots()),
            Form::Float(form) => real(py, &transformed(py, form, &rounded(&polynomial), direct)?, self.slots()),
        }
    }

    /// The maps at numbers for the parameters, built once for the same numbers in a row.
    fn map(&self, py: Python<'_>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Arc<BirkhoffMap>> {
        let values = self.values(parameters)?;
        let held = || self.map.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some((_, map)) = held().as_ref().filter(|(known, _)| *known == values) {
            return Ok(map.clone());
        }
        let compute =
            |tell: &mut Progress<'_>| either!(&self.form, form => BirkhoffMap::with_progress(form, &values, tell));
        let map = Arc::new(progress::reported(py, None, compute)?);
        *held() = Some((values, map.clone()));
        Ok(map)
    }

    /// The numbers for the parameters in their order.
    fn values(&self, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<f64>> {
        let space = self.space();
        let names = &space.names()[2 * space.degrees_of_freedom()..];
        let unknown = |name: &str, problem: &str| {
            UnknownNameError::new_err(format!("parameters: {name:?} {problem}; they are [{}]", names.join(", ")))
        };
        let mut values = vec![None; names.len()];
        for (name, value) in parameters.into_iter().flatten() {
            let name = name.str()?.to_string();
            let Some(at) = names.iter().position(|known| *known == name) else {
                return Err(unknown(&name, "is unknown"));
            };
            values[at] = Some(number(&name, &value)?);
        }
        values.iter().zip(names).map(|(value, name)| value.ok_or_else(|| unknown(name, "is missing"))).collect()
    }
}
