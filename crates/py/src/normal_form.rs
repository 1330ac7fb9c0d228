//! `andoyer.NormalForm` and `andoyer.separatrix_action`.

use std::collections::BTreeMap;

use andoyer_series::print::{MAX_CODE_ORDER, Part};
use andoyer_series::progress::Progress;
use andoyer_series::rigid_body::{MAX_ORDER, PublicForm, Variable};
use num_complex::Complex;
use num_rational::BigRational;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use crate::computing::detached;
use crate::error;
use crate::order::order;
use crate::progress;
use crate::values::immutable;

/// The normal form of the free rigid body to any order: exact, and symbolic in the triaxiality β (theory §4, §6).
///
/// Exact numbers are `fractions.Fraction`; Gaussian rationals are pairs (re, im) of them.
///
/// Parameters
/// ----------
/// order : int
///     Order in α/(√γ V), at least 0.
/// progress : callable, optional
///     Called as ``progress(done, order)`` with the number of completed orders, 0 to `order`. An exception in it stops the computation and is raised
///     to the caller.
///
/// Raises
/// ------
/// InputError
///     An order that is negative or not whole (``-1``, ``2.5``).
/// RepresentationError
///     An order that would need more than 8 GiB of memory by estimate (``2000``), or exponents that do not fit (``16382``).
/// KeyboardInterrupt
///     Ctrl-C during the computation.
///
/// Examples
/// --------
/// >>> normal_form = NormalForm(4)
/// >>> normal_form.triaxiality_polynomial(4)
/// {2: Fraction(-3, 4), 4: Fraction(-9, 32)}
/// >>> normal_form.generator(1)
/// {(1, 3, 1): (Fraction(1, 8), Fraction(0, 1)), (3, 1, 1): (Fraction(1, 8), Fraction(0, 1))}
#[pyclass(frozen, eq, hash, module = "andoyer")]
#[derive(PartialEq, Eq, Hash)]
pub(crate) struct NormalForm(andoyer_series::NormalForm);

immutable!(NormalForm);

#[pymethods]
impl NormalForm {
    #[new]
    #[pyo3(signature = (order, *, progress=None))]
    fn new(py: Python<'_>, order: &Bound<'_, PyAny>, progress: Option<Py<PyAny>>) -> PyResult<Self> {
        let order = self::order("order", order, 0, MAX_ORDER)?;
        let compute = |tell: &mut Progress<'_>| andoyer_series::NormalForm::with_progress(order, tell);
        progress::reported(py, progress, compute).map(Self)
    }

    /// The order.
    #[getter]
    fn order(&self) -> usize {
        self.0.order()
    }

    /// The triaxiality polynomial P_n in real form: K = M²/(2C) [1 + γ Σ P_n κⁿ σⁿ⁺¹] (theory §4).
    ///
    /// Parameters
    /// ----------
    /// n : int
    ///     0 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {int: Fraction}
    ///     The coefficients, by power of β.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An n that is negative or above `order`.
    ///
    /// Examples
    /// --------
    /// >>> NormalForm(3).triaxiality_polynomial(3)
    /// {2: Fraction(-5, 8)}
    fn triaxiality_polynomial<'py>(&self, py: Python<'py>, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let polynomial = self.0.triaxiality_polynomial(order("n", n, 0, self.0.order())?).map_err(error::algebra)?;
        polynomial.into_pyobject(py)
    }

    /// The triaxiality polynomial p_n = (−i)ⁿ⁺¹ P_n in the form of the paper (theory §4; §11 for the misprint).
    ///
    /// Parameters
    /// ----------
    /// n : int
    ///     0 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {int: (Fraction, Fraction)}
    ///     Real and imaginary parts of the coefficients, by power of β.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An n that is negative or above `order`.
    fn paper_polynomial<'py>(&self, py: Python<'py>, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let polynomial = self.0.paper_polynomial(order("n", n, 0, self.0.order())?).map_err(error::algebra)?;
        gaussian(py, polynomial)
    }

    /// The generating function S_m · (√γ V/α)ᵐ = Σ c uʲ Uᵏ βˡ, including the factor (m−1)! (theory §4).
    ///
    /// Parameters
    /// ----------
    /// m : int
    ///     1 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {(int, int, int): (Fraction, Fraction)}
    ///     Real and imaginary parts of c, by exponents (j, k, l).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An m that is 0, negative or above `order`.
    fn generator<'py>(&self, py: Python<'py>, m: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let m = order("m", m, 1, self.0.order())?;
        self.face(py, |_| self.0.generator(m))
    }

    /// Order n of an old variable as a function of the new variables, including the factor 1/n! (theory §6).
    ///
    /// With τ = α/(√γ V), u = u′ + Σ τⁿ Σ c u′ʲ U′ᵏ βˡ and the same for U; y = y′ + (1/M) Σ τⁿ Σ c u′ʲ U′ᵏ βˡ.
    ///
    /// Parameters
    /// ----------
    /// name : {"u", "U", "y"}
    ///     The old variable.
    /// n : int
    ///     1 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {(int, int, int): (Fraction, Fraction)}
    ///     Real and imaginary parts of c, by exponents (j, k, l).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown name (``"x"``); an n that is 0, negative or above `order`.
    fn direct<'py>(&self, py: Python<'py>, name: &str, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let variable = name.parse().map_err(error::algebra_as("name"))?;
        let n = order("n", n, 1, self.0.order())?;
        self.face(py, |tell| self.0.direct_with(variable, n, tell))
    }

    /// Order n of a new variable as a function of the old variables, scaled as in `direct` (theory §6).
    ///
    /// Parameters
    /// ----------
    /// name : {"u", "U", "y"}
    ///     The new variable.
    /// n : int
    ///     1 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {(int, int, int): (Fraction, Fraction)}
    ///     Real and imaginary parts of c, by exponents (j, k, l).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown name (``"x"``); an n that is 0, negative or above `order`.
    fn inverse<'py>(&self, py: Python<'py>, name: &str, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let variable = name.parse().map_err(error::algebra_as("name"))?;
        let n = order("n", n, 1, self.0.order())?;
        self.face(py, |tell| self.0.inverse_with(variable, n, tell))
    }

    /// Writes this normal form as JSON text with a format version; numbers are exact "p/q" strings.
    fn to_json(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, error::algebra, || self.0.to_json())
    }

    /// Reads a normal form from the text of `to_json`. Each order is computed again and compared.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     JSON text.
    ///
    /// Raises
    /// ------
    /// FileError
    ///     A text that is not JSON; another format or version; a term that the normal form cannot have; a coefficient that differs from the computed one.
    ///
    /// Examples
    /// --------
    /// >>> text = NormalForm(2).to_json()
    /// >>> NormalForm.from_json(text.replace('[[2,"-1/2"]]', '[[2,"-3/4"]]'))
    /// Traceback (most recent call last):
    ///     ...
    /// andoyer.FileError: the triaxiality polynomial of order 2 has the coefficient -3/4 at the exponents [2]: it must be -1/2
    #[classmethod]
    fn from_json(class: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        progress::reported(class.py(), None, |tell| andoyer_series::NormalForm::from_json_with(text, tell)).map(Self)
    }

    /// Writes a part of this normal form as LaTeX, for a document that uses amsmath.
    ///
    /// Parameters
    /// ----------
    /// what : {"hamiltonian", "generator", "direct", "inverse"}, optional
    ///     The part.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown part (``"lagrangian"``).
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_latex(&self, py: Python<'_>, what: &str) -> PyResult<String> {
        let part = what.parse().map_err(error::algebra_as("what"))?;
        self.prepare(py, part)?;
        detached(py, error::algebra, || self.0.to_latex(part))
    }

    /// Converts a part of this normal form to exact SymPy expressions. This method imports SymPy.
    ///
    /// The symbols are ``u, U, V, y, M, C, sigma, alpha, beta, gamma``, without assumptions. In "direct" u, U and y are the new
    /// variables, in "inverse" the old ones.
    ///
    /// Parameters
    /// ----------
    /// what : {"hamiltonian", "generator", "direct", "inverse"}, optional
    ///
    /// Returns
    /// -------
    /// sympy.Expr, list of sympy.Expr or dict of {str: sympy.Expr}
    ///     "hamiltonian": K in M, C, sigma = L/M, alpha, beta, gamma (theory §4). "generator": the list S_1 … S_N in u, U, V, alpha, beta, gamma.
    ///     "direct": the old "u", "U" and "y", summed over all orders. "inverse": the new ones (theory §6).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown part (``"lagrangian"``).
    /// ImportError
    ///     SymPy is not installed; ``pip install sympy`` installs it.
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_sympy<'py>(slf: &Bound<'py, Self>, what: &str) -> PyResult<Bound<'py, PyAny>> {
        let _: Part = what.parse().map_err(error::algebra_as("what"))?;
        slf.py().import("andoyer.interop._symbolic")?.call_method1("expressions", (slf, what))
    }

    /// Writes a source file with a function that evaluates the direct transformation and the frequencies to this order.
    ///
    /// The file needs only the standard library of its language. The function is ``short_axis_rotation(sigma, anomaly)``, or
    /// ``short_axis_rotation(beta, sigma, anomaly)`` if `beta` is None. It returns ``zeta_real`` = X/√M and
    /// ``zeta_imaginary`` = x/√M, ``longitude_shift`` = y − y′ in rad, ``anomaly_rate`` = dℓ′/dt in units of Mγ/C, and ``longitude_rate`` = g in
    /// dy′/dt = (M/C)(1 + γg) (theory §1, §6, §7), as a struct in C and Rust and as a tuple in Python. The head of the file repeats this description and states
    /// the number of operations and the truncation error.
    ///
    /// Parameters
    /// ----------
    /// language : {"c", "rust", "python"}, optional
    ///     C99 with math.h, Rust with its standard library, or Python with math.
    /// beta : float, optional
    ///     Triaxiality, 0 ≤ beta < 1, as a number in the file. If None, it is an argument of the function.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown language (``"fortran"``); a `beta` outside 0 ≤ beta < 1 or NaN.
    /// RepresentationError
    ///     An order above 100.
    ///
    /// Examples
    /// --------
    /// >>> namespace = {}
    /// >>> exec(NormalForm(10).to_code("python", beta=0.3), namespace)
    /// >>> round(namespace["short_axis_rotation"](0.1, 0.7)[3], 10)
    /// 0.8942751474
    #[pyo3(signature = (language="c", beta=None))]
    fn to_code(&self, py: Python<'_>, language: &str, beta: Option<f64>) -> PyResult<String> {
        let language = language.parse().map_err(error::algebra)?;
        if beta.is_none() && self.0.order() <= MAX_CODE_ORDER {
            self.prepare(py, Part::Direct)?;
        }
        detached(py, error::algebra, || self.0.to_code(language, beta))
    }

    fn __repr__(&self) -> String {
        format!("NormalForm(order={})", self.0.order())
    }

    /// Pickled as its JSON text.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("from_json")?, (slf.get().to_json(slf.py())?,)))
    }
}

impl NormalForm {
    fn face<'py>(
        &self,
        py: Python<'py>,
        compute: impl FnOnce(&mut Progress<'_>) -> Result<PublicForm, andoyer_series::Error> + Send,
    ) -> PyResult<Bound<'py, PyDict>> {
        gaussian(py, progress::reported(py, None, compute)?)
    }

    /// Computes and keeps the series of `part`. Ctrl-C ends the computation.
    fn prepare(&self, py: Python<'_>, part: Part) -> PyResult<()> {
        let (form, order) = (&self.0, self.0.order());
        for variable in [Variable::Coordinate, Variable::Angle].into_iter().filter(|_| order > 0) {
            progress::reported(py, None, |tell| match part {
                Part::Direct => form.direct_with(variable, order, tell).map(drop),
                Part::Inverse => form.inverse_with(variable, order, tell).map(drop),
                _ => Ok(()),
            })?;
        }
        Ok(())
    }
}

/// A dictionary of pairs (re, im), in the canonical order of its keys.
fn gaussian<'py, K: IntoPyObject<'py>>(
    py: Python<'py>,
    form: BTreeMap<K, Complex<BigRational>>,
) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    for (key, c) in form {
        result.set_item(key, (c.re, c.im))?;
    }
    Ok(result)
}

/// The action σ_sep(β) = (2/π) atan √((1−β)/2β) of the separatrix, in units of M. It is the radius of convergence of the series (theory §5).
///
/// Parameters
/// ----------
/// beta : float
///     Triaxiality, 0 to 1.
///
/// Raises
/// ------
/// InputError
///     A `beta` outside 0 to 1, or NaN.
///
/// Examples
/// --------
/// >>> round(separatrix_action(0.5), 5)
/// 0.39183
#[pyfunction]
pub(crate) fn separatrix_action(beta: f64) -> PyResult<f64> {
    andoyer_series::rigid_body::separatrix_action(beta).map_err(error::algebra)
}
