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

/// The normal form of the free rigid body, exact, symbolic in the triaxiality β, to any order (theory §4, §6).
///
/// Exact numbers are `fractions.Fraction`, Gaussian rationals pairs (re, im) of them.
///
/// Parameters
/// ----------
/// order : int
///     Order in α/(√γ V), ≥ 0.
/// progress : callable, optional
///     Called as ``progress(done, order)`` with the number of orders done, 0 to `order`. An exception in it stops the work and is raised
///     here.
///
/// Raises
/// ------
/// InputError
///     ``-1``, ``2.5``.
/// RepresentationError
///     ``2000`` (more than 8 GiB of memory by its estimate), ``16382`` (exponents that would not fit).
/// KeyboardInterrupt
///     Ctrl-C is noticed while it works.
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

    /// Triaxiality polynomial P_n, real form: K = M²/(2C) [1 + γ Σ P_n κⁿ σⁿ⁺¹] (theory §4).
    ///
    /// Parameters
    /// ----------
    /// n : int
    ///     0 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {int: Fraction}
    ///     Coefficient by power of β.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``-1``, or above the order.
    ///
    /// Examples
    /// --------
    /// >>> NormalForm(3).triaxiality_polynomial(3)
    /// {2: Fraction(-5, 8)}
    fn triaxiality_polynomial<'py>(&self, py: Python<'py>, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let polynomial = self.0.triaxiality_polynomial(order("n", n, 0, self.0.order())?).map_err(error::algebra)?;
        polynomial.into_pyobject(py)
    }

    /// Triaxiality polynomial p_n = (−i)ⁿ⁺¹ P_n in the paper's form (theory §4, and §11 for the misprint).
    ///
    /// Parameters
    /// ----------
    /// n : int
    ///     0 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {int: (Fraction, Fraction)}
    ///     Real and imaginary part by power of β.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``-1``, or above the order.
    fn paper_polynomial<'py>(&self, py: Python<'py>, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let polynomial = self.0.paper_polynomial(order("n", n, 0, self.0.order())?).map_err(error::algebra)?;
        gaussian(py, polynomial)
    }

    /// Generating function S_m · (√γ V/α)ᵐ = Σ c uʲ Uᵏ βˡ, the factor (m−1)! included (theory §4).
    ///
    /// Parameters
    /// ----------
    /// m : int
    ///     1 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {(int, int, int): (Fraction, Fraction)}
    ///     Real and imaginary part of c by exponents (j, k, l).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``0``, or above the order.
    fn generator<'py>(&self, py: Python<'py>, m: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let m = order("m", m, 1, self.0.order())?;
        self.face(py, |_| self.0.generator(m))
    }

    /// Order n of the transformation of a variable to the new ones, 1/n! included (theory §6).
    ///
    /// u = u′ + Σ τⁿ Σ c u′ʲ U′ᵏ βˡ with τ = α/(√γ V), and the same for U; y = y′ + (1/M) Σ τⁿ Σ c u′ʲ U′ᵏ βˡ.
    ///
    /// Parameters
    /// ----------
    /// name : {"u", "U", "y"}
    /// n : int
    ///     1 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {(int, int, int): (Fraction, Fraction)}
    ///     Real and imaginary part of c by exponents (j, k, l).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The name ``"x"``; n ``0``, or above the order.
    fn direct<'py>(&self, py: Python<'py>, name: &str, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let variable = name.parse().map_err(error::algebra_as("name"))?;
        let n = order("n", n, 1, self.0.order())?;
        self.face(py, |tell| self.0.direct_with(variable, n, tell))
    }

    /// Order n of the transformation of a new variable to the old ones, scaled as `direct`.
    ///
    /// Parameters
    /// ----------
    /// name : {"u", "U", "y"}
    /// n : int
    ///     1 to `order`.
    ///
    /// Returns
    /// -------
    /// dict of {(int, int, int): (Fraction, Fraction)}
    ///     Real and imaginary part of c by exponents (j, k, l).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The name ``"x"``; n ``0``, or above the order.
    fn inverse<'py>(&self, py: Python<'py>, name: &str, n: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let variable = name.parse().map_err(error::algebra_as("name"))?;
        let n = order("n", n, 1, self.0.order())?;
        self.face(py, |tell| self.0.inverse_with(variable, n, tell))
    }

    /// This normal form as JSON text: exact, "p/q" strings, with a format version.
    fn to_json(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, error::algebra, || self.0.to_json())
    }

    /// Reads what `to_json` wrote.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///
    /// Raises
    /// ------
    /// FileError
    ///     Not JSON, another format or version, a term that no normal form has, a coefficient that is not that of the rigid body. Each
    ///     order is computed anew and compared.
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

    /// A part of this normal form as LaTeX, for a document that uses amsmath.
    ///
    /// Parameters
    /// ----------
    /// what : {"hamiltonian", "generator", "direct", "inverse"}, optional
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``"lagrangian"``.
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_latex(&self, py: Python<'_>, what: &str) -> PyResult<String> {
        let part = what.parse().map_err(error::algebra_as("what"))?;
        self.prepare(py, part)?;
        detached(py, error::algebra, || self.0.to_latex(part))
    }

    /// A part of this normal form as exact SymPy expressions. SymPy is imported here and nowhere else.
    ///
    /// The symbols are ``u, U, V, y, M, C, sigma, alpha, beta, gamma``, without assumptions. In "direct" u, U and y stand for the new
    /// variables, in "inverse" for the old ones.
    ///
    /// Parameters
    /// ----------
    /// what : {"hamiltonian", "generator", "direct", "inverse"}, optional
    ///
    /// Returns
    /// -------
    /// sympy.Expr, list of sympy.Expr or dict of {str: sympy.Expr}
    ///     "hamiltonian": K in M, C, sigma = L/M, alpha, beta, gamma (theory §4). "generator": S_1 … S_N in u, U, V, the list starting with
    ///     S_1. "direct" and "inverse": the old and the new "u", "U" and "y" (theory §6), sums of all orders.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     ``"lagrangian"``.
    /// ImportError
    ///     SymPy is not installed: the extra ``andoyer[sympy]`` brings it.
    #[pyo3(signature = (what="hamiltonian"))]
    fn to_sympy<'py>(slf: &Bound<'py, Self>, what: &str) -> PyResult<Bound<'py, PyAny>> {
        let _: Part = what.parse().map_err(error::algebra_as("what"))?;
        slf.py().import("andoyer._symbolic")?.call_method1("expressions", (slf, what))
    }

    /// A function that evaluates the direct transformation and the frequencies to this order, as the text of a file of source.
    ///
    /// It needs nothing but its language.
    /// ``short_axis_rotation(sigma, anomaly)``, or ``(beta, sigma, anomaly)`` where `beta` is None, returns ``zeta_real`` = X/√M and
    /// ``zeta_imaginary`` = x/√M, ``longitude_shift`` = y − y′ in rad, ``anomaly_rate`` = dℓ′/dt in units of Mγ/C, and ``longitude_rate`` = g in
    /// dy′/dt = (M/C)(1 + γg) (theory §1, §6, §7): a struct in C and Rust, a tuple in Python. The head of the file says it again, with the cost
    /// and the truncation.
    ///
    /// Parameters
    /// ----------
    /// language : {"c", "rust", "python"}, optional
    ///     C99 with math.h; Rust with its standard library; Python with math.
    /// beta : float, optional
    ///     Triaxiality, 0 ≤ beta < 1, to be a number in the file; an argument of the function if None.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The language ``"fortran"``; β ``-0.1``, ``1.0``, NaN.
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

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
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

    /// Computes the series that `part` is written from, which are kept; Ctrl-C is noticed meanwhile.
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

/// A dictionary of pairs (re, im), in the canonical order of the keys.
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

/// Action σ_sep(β) = (2/π) atan √((1−β)/2β) of the separatrix, in units of M: the radius of convergence of the series (theory §5).
///
/// Parameters
/// ----------
/// beta : float
///     Triaxiality, 0 to 1.
///
/// Raises
/// ------
/// InputError
///     ``-0.1``, ``1.1``, NaN.
///
/// Examples
/// --------
/// >>> round(separatrix_action(0.5), 5)
/// 0.39183
#[pyfunction]
pub(crate) fn separatrix_action(beta: f64) -> PyResult<f64> {
    andoyer_series::rigid_body::separatrix_action(beta).map_err(error::algebra)
}
