//! `andoyer.BirkhoffNormalForm`: what it holds. [`evaluate`] has its numbers, [`text`] its texts.

mod evaluate;
mod text;

use std::sync::{Arc, Mutex};

use andoyer_series::birkhoff::Mode;
use andoyer_series::progress::Progress;
use andoyer_series::real_field::RealField;
use andoyer_series::{BirkhoffMap, PhaseSpace};
use num_complex::Complex;
use num_rational::BigRational;
use numpy::PyArrayDyn;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyComplex, PyDict, PyTuple};

use crate::array::number;
use crate::computing::detached;
use crate::error;
use crate::expression::{Expression, actions, complex, real};
use crate::form::{Form, either, rounded, transformed};
use crate::order::order;
use crate::progress;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
/// The function that pickle calls, and its arguments.
type Reduced<'py> = (Bound<'py, PyAny>, (String, Py<PyDict>));

/// The Birkhoff normal form of a Hamiltonian, from `normalize`: the new Hamiltonian K and the transformation in both directions.
///
/// Polynomials are dictionaries of coefficients by tuple of exponents, in the order q₁, p₁, q₂, p₂, …, parameters: `Fraction` if
/// `exact`, else float. The exponents are followed by an integer j for each driven phase M: cos jM for j ≥ 0, sin ``|j|M`` for j < 0, and e^{ijM} in
/// `in_complex`. The new variables (q, p) of a centre have the action I = (q²/r + r p²)/2 and the complex variables U = r p + i q =
/// √(2rI) e^{iφ} and u = (q + i r p)/(2r), {u; U} = 1, uU = iI. Those of a saddle are real, u = q, U = p, I = q p; q is the unstable direction. The two modes
/// (q, p), (Q, P) of a quartet have I = q p + Q P and q P − Q p, u = (q − iQ)/2 and U = p + iP.
///
/// States are arrays (2n,) or (m, 2n) of q₁, p₁, q₂, p₂, … Methods on states take the parameters as a dict of numbers by name, and with driven phases the time of
/// the states, one number or m numbers, 0 by default. The series are truncated: for a state of amplitude ε the error is of order ε^(N+2).
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

    /// The driven phases: {name: (frequency, phase at time 0)}.
    #[getter]
    fn driven<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let result = PyDict::new(py);
        either!(&self.form, form => for (name, driven) in form.space().driven().into_iter().zip(form.driven().to_vec()) {
            result.set_item(name, driven)?;
        });
        Ok(result)
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

    /// The resonances that were kept: vectors k with k·ω = 0, and with driven phases (k, j) with k·ω + j·n = 0. Their terms depend on the resonant angles k·φ + j·M.
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
        either!(&self.form, form => actions(py, &detached(py, error::algebra, || form.in_actions())?, self.space()))
    }

    /// K in the actions and the resonant angles: the terms of each angle k·φ, by k.
    ///
    /// K = Σ √I₁^n₁ √I₂^n₂ … c^m (a cos k·φ + b sin k·φ). A centre has q = √(2rI) sin φ, p = √(2I/r) cos φ. For k = 0 the terms are those without angles; there
    /// saddles and quartets have the actions of `in_actions`.
    ///
    /// Returns
    /// -------
    /// dict of {tuple of int: dict of {tuple of int: (float, float)}}
    ///     (a, b) by the exponents n₁, n₂, … of the square roots of the actions and the exponents m of the parameters.
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     A resonant term of a saddle or a quartet, which has no angle.
    ///
    /// Examples
    /// --------
    /// >>> spring = normalize("(p^2 + x^2)/2 + (P^2 + 4*y^2)/2 + x^2*y", 1, [("x", "p"), ("y", "P")], resonances=[(2, -1)])
    /// >>> spring.in_angles()
    /// {(0, 0): {(2, 0): (1.0, 0.0), (0, 2): (2.0, 0.0)}, (2, -1): {(2, 1): (0.0, 0.5)}}
    fn in_angles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let result = PyDict::new(py);
        for (multiples, terms) in either!(&self.form, form => detached(py, error::algebra, || form.angle_terms())?) {
            let part = PyDict::new(py);
            for (exponents, [cosine, sine]) in terms {
                part.set_item(PyTuple::new(py, exponents)?, (cosine, sine))?;
            }
            result.set_item(PyTuple::new(py, multiples)?, part)?;
        }
        Ok(result)
    }

    /// K in the complex variables: (re, im) by exponents of u₁, U₁, u₂, U₂, …, parameters.
    fn in_complex<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        match &self.form {
            Form::Exact(form) => {
                complex::<BigRational>(py, &detached(py, error::algebra, || Ok(form.in_complex()))?, self.space())
            }
            Form::Float(form) => {
                complex::<f64>(py, &detached(py, error::algebra, || Ok(form.in_complex()))?, self.space())
            }
        }
    }

    /// K in the new real variables.
    fn in_real<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.in_real())?, self.space()))
    }

    /// The Hamiltonian on the centre manifold: K in the new real variables of the centres, with q = p = 0 for the saddles.
    fn centre_manifold<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.centre_manifold())?, self.space()))
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
        either!(&self.form, form => real(py, &detached(py, error::algebra, || form.generator(m))?, self.space()))
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
}

impl BirkhoffNormalForm {
    pub(crate) fn new(form: Form, symbols: Py<PyDict>) -> Self {
        Self { form, symbols, map: Mutex::new(None) }
    }

    fn space(&self) -> &PhaseSpace {
        either!(&self.form, form => form.space())
    }

    fn transformed<'py>(
        &self,
        py: Python<'py>,
        function: &Bound<'py, PyAny>,
        direct: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let Expression { polynomial, .. } = Expression::new("function", function, self.space())?;
        match &self.form {
            Form::Exact(form) => real(py, &transformed(py, form, &polynomial, direct)?, self.space()),
            Form::Float(form) => real(py, &transformed(py, form, &rounded(&polynomial), direct)?, self.space()),
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
pub(crate) fn frequency<'py, R: RealField + IntoPyObject<'py>>(
    py: Python<'py>,
    omega: &Complex<R>,
) -> PyResult<Bound<'py, PyAny>> {
    if omega.im == R::zero() {
        return omega.re.clone().into_bound_py_any(py);
    }
    Ok(PyComplex::from_doubles(py, omega.re.to_float(), omega.im.to_float()).into_any())
}
