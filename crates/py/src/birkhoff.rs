//! `andoyer.BirkhoffNormalForm`.

use std::convert::Infallible;
use std::sync::{Arc, Mutex};

use andoyer_series::birkhoff::Mode;
use andoyer_series::print::Part;
use andoyer_series::progress::Progress;
use andoyer_series::real_field::RealField;
use andoyer_series::{BirkhoffMap, PhaseSpace};
use num_complex::Complex;
use num_rational::BigRational;
use numpy::PyArrayDyn;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyComplex, PyDict, PyTuple, PyType};

use crate::array::{Rows, Times, fixed_length, number, row_by_row, write};
use crate::computing::detached;
use crate::domain::Domain;
use crate::error;
use crate::expression::{Expression, complex, real};
use crate::form::{Form, either, rounded, transformed};
use crate::order::order;
use crate::progress;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
/// The function that pickle calls, and its arguments.
type Reduced<'py> = (Bound<'py, PyAny>, (String, Py<PyDict>));

/// The Birkhoff normal form of a Hamiltonian, from `normalize`: the new Hamiltonian K and the transformation in both directions.
///
/// Polynomials are dictionaries of coefficients by tuple of exponents, in the order q₁, p₁, q₂, p₂, …, parameters: `Fraction` if
/// `exact`, else float. The new variables (q, p) of a centre have the action I = (q²/r + r p²)/2 and the complex variables U = r p + i q =
/// √(2rI) e^{iφ} and u = (q + i r p)/(2r), {u; U} = 1, uU = iI. Those of a saddle are real, u = q, U = p, I = q p; q is the unstable direction. The two modes
/// (q, p), (Q, P) of a quartet have I = q p + Q P and q P − Q p, u = (q − iQ)/2 and U = p + iP.
///
/// States are arrays (2n,) or (m, 2n) of q₁, p₁, q₂, p₂, … Methods on states take the parameters as a dict of numbers by name. The
/// series are truncated: for a state of amplitude ε the error is of order ε^(N+2).
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
    /// The SymPy symbols of the caller, by name.
    symbols: Py<PyDict>,
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

    /// True if the coefficients are exact (`Fraction`), False if they are floats.
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

    /// The frequencies ω at the origin. A centre has a real frequency, negative if its energy is negative; a saddle has iλ; a quartet has iσ − ν and iσ + ν.
    #[getter]
    fn frequencies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        either!(&self.form, form => {
            let numbers = form.frequencies().iter().map(|omega| frequency(py, omega)).collect::<PyResult<Vec<_>>>();
            PyTuple::new(py, numbers?)
        })
    }

    /// The kind of every mode: "elliptic", "hyperbolic" or "complex".
    #[getter]
    fn kinds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        either!(&self.form, form => PyTuple::new(py, form.modes().iter().map(Mode::kind)))
    }

    /// The ratios r = √(a/b) of the centres, None for other modes.
    #[getter]
    fn ratios<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        either!(&self.form, form => PyTuple::new(py, form.modes().iter().map(|mode| mode.ratio().cloned())))
    }

    /// The symplectic matrix M of the linear change z = M z′ that diagonalizes the quadratic part, by rows. It is the unit matrix if the quadratic part is already diagonal.
    #[getter]
    fn linear_change<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        either!(&self.form, form => {
            let rows = form.linear_change().iter().map(|row| PyTuple::new(py, row.iter().cloned()));
            PyTuple::new(py, rows.collect::<PyResult<Vec<_>>>()?)
        })
    }

    /// The resonances that were kept: vectors k with k·ω = 0. Their terms depend on the resonant angles k·φ.
    #[getter]
    fn resonances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let vectors = either!(&self.form, form => form.resonances().vectors().to_vec());
        PyTuple::new(py, vectors.into_iter().map(|vector| PyTuple::new(py, vector)).collect::<PyResult<Vec<_>>>()?)
    }

    /// K as a function of the actions: coefficients by exponents of I₁, I₂, …, parameters. It includes the constant term of H.
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     K has resonant terms and is not a function of the actions alone.
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

    /// The Hamiltonian on the centre manifold: K in the new real variables of the centres, with q = p = 0 for the saddles.
    fn centre_manifold<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.centre_manifold())?, self.slots()))
    }

    /// The generating function S_m in the real variables, of degree m + 2.
    ///
    /// Parameters
    /// ----------
    /// m : int
    ///     1 to `order`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``0``, or above the order.
    fn generator<'py>(&self, py: Python<'py>, m: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let m = order("m", m, 1, self.order())?;
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.generator(m))?, self.slots()))
    }

    /// Expresses a function of the old variables in the new variables. It is complete to degree d + N, where d is its lowest positive degree.
    ///
    /// Parameters
    /// ----------
    /// function : str, dict or SymPy expression
    ///     A function in the form of the Hamiltonian of `normalize`, or the name of a variable.
    fn direct<'py>(&self, py: Python<'py>, function: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        self.transformed(py, function, true)
    }

    /// Expresses a function of the new variables in the old variables. It is complete to degree d + N, where d is its lowest positive degree.
    ///
    /// Parameters
    /// ----------
    /// function : str, dict or SymPy expression
    ///     A function in the form of the Hamiltonian of `normalize`, or the name of a variable.
    fn inverse<'py>(&self, py: Python<'py>, function: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        self.transformed(py, function, false)
    }

    /// Transforms states to the new variables.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows.
    #[pyo3(signature = (states, parameters=None))]
    fn to_normal<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, n)?.map(n, |state| map.to_normal(state))
    }

    /// Transforms new variables to states. The errors are those of `to_normal`.
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

    /// Transforms points of the centre manifold, given by the new variables of the centres, to states.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2c,) or (m, 2c)
    ///     q, p of the c centres, in their order.
    /// parameters : dict of {str: float}, optional
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,) or (m, 2n)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows.
    #[pyo3(signature = (states, parameters=None))]
    #[expect(
        clippy::wrong_self_convention,
        reason = "the states of a manifold, as from_normal those of normal variables"
    )]
    fn from_centre_manifold<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let map = self.map(states.py(), parameters)?;
        let centres = either!(&self.form, form => form.modes().iter().filter(|mode| mode.is_elliptic()).count());
        let n = 2 * self.space().degrees_of_freedom();
        Rows::new("states", states, 2 * centres)?.map(n, |centre| map.from_centre(centre))
    }

    /// The energy: the value of K at new variables.
    ///
    /// Parameters
    /// ----------
    /// normal : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Returns
    /// -------
    /// ndarray, shape (1,) or (m, 1)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN.
    #[pyo3(signature = (normal, parameters=None))]
    fn energy<'py>(&self, normal: &Bound<'py, PyAny>, parameters: Option<&Bound<'py, PyDict>>) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(normal.py(), parameters)?);
        Rows::new("normal", normal, n)?.map(1, |normal| map.energy(normal).map(|energy| vec![energy]))
    }

    /// The rates of new variables, by Hamilton's equations of K.
    ///
    /// Parameters
    /// ----------
    /// normal : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN.
    #[pyo3(signature = (normal, parameters=None))]
    fn rates<'py>(&self, normal: &Bound<'py, PyAny>, parameters: Option<&Bound<'py, PyDict>>) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(normal.py(), parameters)?);
        Rows::new("normal", normal, n)?.map(n, |normal| map.rates(normal))
    }

    /// Estimates the range of validity of the form: the sizes of its orders, and the best order at an amplitude.
    ///
    /// Parameters
    /// ----------
    /// parameters : dict of {str: float}, optional
    ///
    /// Examples
    /// --------
    /// >>> pendulum = normalize("p**2/2 + q**2/2 - q**4/24 + q**6/720 - q**8/40320", 6, [("q", "p")])
    /// >>> domain = pendulum.domain()
    /// >>> domain.best_order(0.5), domain.best_order(10.0)
    /// (6, 2)
    #[pyo3(signature = (parameters=None))]
    fn domain(&self, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Domain> {
        let values = self.values(parameters)?;
        either!(&self.form, form => form.domain(&values)).map(Domain).map_err(error::algebra)
    }

    /// The actions of states. Along a motion they are almost constant, unless a resonance exchanges them.
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
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows.
    #[pyo3(signature = (states, parameters=None))]
    fn actions<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, 2 * n)?.map(n, |state| map.actions(state))
    }

    /// The frequencies Ω = ∂K/∂I at actions. For a saddle Ω is the rate; for a quartet it is rate and frequency.
    ///
    /// Parameters
    /// ----------
    /// actions : array_like, shape (n,) or (m, n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     K has resonant terms.
    /// InputError
    ///     An array of another length; a NaN, or an action below 0.
    #[pyo3(signature = (actions, parameters=None))]
    fn frequency_map<'py>(
        &self,
        actions: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (self.space().degrees_of_freedom(), self.map(actions.py(), parameters)?);
        Rows::new("actions", actions, n)?.map(n, |actions| map.frequencies(actions))
    }

    /// Propagates a state by the normal form to times after the state.
    ///
    /// If K is a function of the actions, the actions are constant and the angles move uniformly. With resonant terms SciPy's DOP853 integrates
    /// the equations of K in the new variables at a relative tolerance of 1e-12.
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
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows.
    /// ImportError
    ///     K has resonant terms, and SciPy is not installed.
    #[pyo3(signature = (state, times, parameters=None))]
    fn trajectory<'py>(
        slf: &Bound<'py, Self>,
        state: &Bound<'py, PyAny>,
        times: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, form) = (state.py(), slf.get());
        let n = 2 * form.space().degrees_of_freedom();
        let map = form.map(py, parameters)?;
        let (given, shape) = (fixed_length("state", state, n)?, Times::new(times, None, false)?);
        if !map.is_integrable() {
            return py.import("andoyer._flow")?.call_method1("trajectory", (slf, given, times, parameters));
        }
        let result = shape.rows(n)?;
        let states = row_by_row(py, shape.values()?, 1, |times| map.trajectory(&given, times))?;
        write(&result)?.as_slice_mut()?.copy_from_slice(&states.concat());
        Ok(result.into_any())
    }

    /// Converts a part of this normal form to SymPy expressions. This method imports SymPy.
    ///
    /// The symbols are those given to `normalize`, with their assumptions, or have the names of variables and parameters; ``I_q`` is the action of
    /// (q, p). They are the new variables in "direct" and the old variables in "inverse". `sympy.ccode` and `lambdify` accept these expressions.
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
    /// InputError
    ///     ``"lagrangian"``.
    /// ImportError
    ///     SymPy is not installed; the extra ``andoyer[sympy]`` installs it.
    ///
    /// Examples
    /// --------
    /// >>> normalize("(x**2 + X**2)/2 + x**3", 2, [("x", "X")]).to_sympy()
    /// -15*I_x**2/4 + I_x
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_sympy<'py>(slf: &Bound<'py, Self>, what: &str) -> PyResult<Bound<'py, PyAny>> {
        let _: Part = what.parse().map_err(error::algebra_as("what"))?;
        slf.py().import("andoyer._symbolic")?.call_method1("birkhoff", (slf, what, &slf.get().symbols))
    }

    /// Writes this normal form as JSON text with a format version: exact numbers as "p/q" strings, floats with all their digits.
    fn to_json(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, error::algebra, || either!(&self.form, form => form.to_json()))
    }

    /// Reads a normal form from the text of `to_json`, and computes the form again to compare every coefficient.
    ///
    /// Parameters
    /// ----------
    /// text : str
    /// symbols : dict of {str: sympy.Symbol}, optional
    ///     The symbols that `to_sympy` uses for the names.
    ///
    /// Raises
    /// ------
    /// FileError
    ///     A text that is not JSON; another format or version; a term that a normal form cannot have; a coefficient that differs from the computed one (for floats by more than
    ///     1e-8 of the largest of its order).
    ///
    /// Examples
    /// --------
    /// >>> text = normalize("(x**2 + X**2)/2 + x**3", 2, [("x", "X")]).to_json()
    /// >>> BirkhoffNormalForm.from_json(text).to_json() == text
    /// True
    #[classmethod]
    #[pyo3(signature = (text, symbols=None))]
    fn from_json(class: &Bound<'_, PyType>, text: &str, symbols: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let py = class.py();
        let form = progress::reported(py, None, |tell| Form::from_json(text, tell))?;
        Ok(Self::new(form, symbols.unwrap_or_else(|| PyDict::new(py)).unbind()))
    }

    /// Rebuilds a form from a pickle, whose text this program wrote.
    #[staticmethod]
    fn _restored(py: Python<'_>, text: &str, symbols: Bound<'_, PyDict>) -> PyResult<Self> {
        let form = detached(py, error::algebra, || Form::restored(text))?;
        Ok(Self::new(form, symbols.unbind()))
    }

    /// Writes a part of this normal form as LaTeX, for a document that uses amsmath.
    ///
    /// Parameters
    /// ----------
    /// what : {"hamiltonian", "generator", "direct", "inverse"}, optional
    ///     As for `to_sympy`; with resonant terms the Hamiltonian is in u and U. New variables have a prime.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``"lagrangian"``.
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_latex(&self, py: Python<'_>, what: &str) -> PyResult<String> {
        let part = what.parse().map_err(error::algebra_as("what"))?;
        detached(py, error::algebra, || either!(&self.form, form => form.to_latex(part)))
    }

    /// Writes a source file with functions that evaluate this normal form. The file needs only the standard library of its language.
    ///
    /// ``from_normal(normal)`` and ``to_normal(state)`` transform arrays q₁, p₁, q₂, …; ``actions(normal)`` returns the actions, and ``frequencies(actions)`` the rates
    /// ∂K/∂I. ``frequencies`` is absent if K has resonant terms. Parameters are an array after the first argument.
    ///
    /// Parameters
    /// ----------
    /// language : {"c", "rust", "python"}, optional
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``"fortran"``.
    ///
    /// Examples
    /// --------
    /// >>> namespace = {}
    /// >>> exec(normalize("(x**2 + X**2)/2 + x**3", 2, [("x", "X")]).to_code("python"), namespace)
    /// >>> namespace["frequencies"]([0.01])
    /// [0.925]
    #[pyo3(signature = (language="c"))]
    fn to_code(&self, py: Python<'_>, language: &str) -> PyResult<String> {
        let language = language.parse().map_err(error::algebra)?;
        detached(py, error::algebra, || either!(&self.form, form => form.to_code(language)))
    }

    /// Pickled as its JSON text, with the symbols of SymPy.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let (py, form) = (slf.py(), slf.get());
        Ok((slf.get_type().getattr("_restored")?, (form.to_json(py)?, form.symbols.clone_ref(py))))
    }

    /// Order, variables, kind of numbers and, if there are no parameters, the last radius of the domain.
    fn __repr__(&self) -> String {
        let (space, numbers) = (self.space(), if self.exact() { "exact" } else { "float" });
        let radii = either!(&self.form, form => form.domain(&[])).map(|domain| domain.radii()).unwrap_or_default();
        let radius = radii.into_iter().rev().find(|radius| radius.is_finite());
        let radius = radius.map(|radius| format!(", radius {radius:.3}")).unwrap_or_default();
        format!("<BirkhoffNormalForm of order {} in {}, {numbers}{radius}>", self.order(), space.names().join(", "))
    }

    /// K as text, in the actions or, if it has resonant terms, in the complex variables.
    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, |never: Infallible| match never {}, || Ok(either!(&self.form, form => form.to_string())))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

impl BirkhoffNormalForm {
    pub(crate) fn new(form: Form, symbols: Py<PyDict>) -> Self {
        Self { form, symbols, map: Mutex::new(None) }
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

    /// The maps for given numbers of the parameters; the maps last used are kept.
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
            let known = names.join(", ");
            let message = format!("parameters: {name:?} {problem}; they are [{known}]");
            error::input("parameters", name, known, message)
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

/// A frequency as a real number if it is real, otherwise as a complex number.
fn frequency<'py, R: RealField + IntoPyObject<'py>>(
    py: Python<'py>,
    omega: &Complex<R>,
) -> PyResult<Bound<'py, PyAny>> {
    if omega.im == R::zero() {
        return omega.re.clone().into_bound_py_any(py);
    }
    Ok(PyComplex::from_doubles(py, omega.re.to_float(), omega.im.to_float()).into_any())
}
