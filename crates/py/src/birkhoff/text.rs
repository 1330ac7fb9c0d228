//! Texts: JSON, LaTeX, SymPy, code, pickle and print.

use std::convert::Infallible;

use andoyer_series::error::Short;
use andoyer_series::print::Part;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use super::{BirkhoffNormalForm, Reduced};
use crate::computing::detached;
use crate::error;
use crate::form::{Form, either};
use crate::progress;
use crate::values::immutable;

immutable!(BirkhoffNormalForm);

#[pymethods]
impl BirkhoffNormalForm {
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
    ///     SymPy is not installed; ``pip install sympy`` installs it.
    ///
    /// Examples
    /// --------
    /// >>> normalize("(x**2 + X**2)/2 + x**3", 2, [("x", "X")]).to_sympy()
    /// -15*I_x**2/4 + I_x
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_sympy<'py>(slf: &Bound<'py, Self>, what: &str) -> PyResult<Bound<'py, PyAny>> {
        let _: Part = what.parse().map_err(error::algebra_as("what"))?;
        slf.py().import("andoyer.interop._symbolic")?.call_method1("birkhoff", (slf, what, &slf.get().symbols))
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
    /// ``from_normal(normal)`` and ``to_normal(state)`` transform arrays q₁, p₁, q₂, …; ``actions(normal)`` returns the actions, and ``frequencies(actions)``
    /// the rates ∂K/∂I. ``frequencies`` is absent if K has resonant terms. Parameters are an array after the first argument. With driven phases the time is the
    /// last argument of ``from_normal`` and ``to_normal``.
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
        let radius = radius.map(|radius| format!(", radius {}", Short::rounded(radius, 4))).unwrap_or_default();
        let names = [space.names(), space.driven()].concat().join(", ");
        format!("<BirkhoffNormalForm of order {} in {names}, {numbers}{radius}>", self.order())
    }

    /// K as text, in the actions: ``I_q`` of a centre, ``(q*p)`` of a saddle, ``(q*p + Q*P)`` and ``(q*P - Q*p)`` of a quartet.
    ///
    /// With resonant terms there are two lines: in the complex variables, and in the actions and the resonant angles. The second line is in the real variables if
    /// there are resonant terms of saddles or quartets, or if ``keep="hyperbolic"``.
    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, |never: Infallible| match never {}, || Ok(either!(&self.form, form => form.to_string())))
    }
}
