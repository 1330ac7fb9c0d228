//! `andoyer.Body`.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::gravity::{Gravity, with_gravity};
use crate::values::immutable;
use crate::{array, error};

/// The arguments of `pickle` for a body with its own axes: a function and its arguments.
type Reduced<'py, 'a> = (Bound<'py, PyAny>, (Rows, Option<&'a str>, bool, Option<Gravity>));

/// A rigid body, given by its principal moments of inertia.
///
/// Parameters
/// ----------
/// moments : array_like, shape (3,)
///     Positive moments of inertia about body axes 1, 2, 3, in any order and any unit. The largest is at most the sum of the other two.
/// name : str, optional
///     Name of the body, for printing.
/// gravity : Gravity, optional
///     The gravity field of degree 3 and 4. Scenes with it and with an orbit are integrated.
///
/// Raises
/// ------
/// InputError
///     A moment that is not positive or not finite (``[0, 1, 1]``, ``[1, nan, 1]``); a largest moment above the sum of the others (``[1, 1, 2.1]``); a ratio of moments
///     above 1e100 (``[1e-101, 1, 1]``); another number of moments (``[1, 2]``).
///
/// Examples
/// --------
/// >>> body = Body([1.0, 1.5, 2.0])
/// >>> body.beta
/// 0.5
/// >>> Body.named("eros").moments
/// array([0.21007832, 0.98310982, 1.        ])
#[pyclass(frozen, eq, module = "andoyer")]
pub(crate) struct Body {
    pub(crate) body: andoyer_propagate::Body,
}

impl From<andoyer_propagate::Body> for Body {
    fn from(body: andoyer_propagate::Body) -> Self {
        Self { body }
    }
}

impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        self.body == other.body
    }
}

immutable!(Body);

#[pymethods]
impl Body {
    #[new]
    #[pyo3(signature = (moments, *, name=None, gravity=None))]
    fn new(moments: &Bound<'_, PyAny>, name: Option<&str>, gravity: Option<&Bound<'_, Gravity>>) -> PyResult<Self> {
        if let Ok(text) = moments.extract::<String>() {
            let hint = format!(
                "moments must hold three numbers: got {text:?}; a body of the catalogue is Body.named({text:?})"
            );
            return Err(PyTypeError::new_err(hint));
        }
        if array::is_matrix("moments", moments) {
            let hint =
                "moments has shape (3, 3): it must be (3,); a body of an inertia tensor is Body.from_inertia(tensor)";
            return Err(error::input("moments", &[3_i64, 3][..], "(3,)", hint.to_owned()));
        }
        let body = named(andoyer_propagate::Body::new(array::fixed("moments", moments)?), name)?;
        with_gravity(moments.py(), body.body, gravity.map(Bound::get)).map(Self::from)
    }

    /// A body from its inertia tensor about axes that you choose. Attitudes, rates, momenta and derivatives of its scenes are about these axes.
    ///
    /// `moments` has the principal moments, and `principal_axes` the principal axes, each nearest to one of your axes. The tensor is taken as exact: it is
    /// what a motion's error bound counts from, and with equal moments on its diagonal the least product of inertia turns two axes by 45°.
    ///
    /// Parameters
    /// ----------
    /// tensor : array_like, shape (3, 3)
    ///     Symmetric to 1e-12 of its largest entry, with positive principal moments. The largest is at most the sum of the other two.
    /// name : str, optional
    ///     Name of the body, for printing.
    /// gravity : Gravity, optional
    ///     The gravity field of degree 3 and 4 about the same axes.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A tensor that is not symmetric or not finite; principal moments that a rigid body cannot have; an array of another shape (``[1, 1.5, 2]``).
    ///
    /// Examples
    /// --------
    /// >>> body = Body.from_inertia([[1.5, 0.5, 0], [0.5, 1.5, 0], [0, 0, 2]])
    /// >>> body.moments.round(12)
    /// array([1., 2., 2.])
    /// >>> body.principal_axes.round(3) + 0.0
    /// array([[ 0.707,  0.707,  0.   ],
    ///        [-0.707,  0.707,  0.   ],
    ///        [ 0.   ,  0.   ,  1.   ]])
    #[staticmethod]
    #[pyo3(signature = (tensor, *, name=None, gravity=None))]
    fn from_inertia(
        tensor: &Bound<'_, PyAny>,
        name: Option<&str>,
        gravity: Option<&Bound<'_, Gravity>>,
    ) -> PyResult<Self> {
        let body = named(andoyer_propagate::Body::from_inertia(array::matrix("tensor", tensor)?), name)?;
        with_gravity(tensor.py(), body.body, gravity.map(Bound::get)).map(Self::from)
    }

    /// A homogeneous ellipsoid with semi-axes a, b, c along body axes 1, 2, 3. Its moments are m (b² + c²)/5, m (a² + c²)/5, m (a² + b²)/5.
    ///
    /// Parameters
    /// ----------
    /// a, b, c : float
    ///     Positive lengths, in any order.
    /// mass : float, optional
    ///     Mass m; by default 1.
    /// name : str, optional
    ///     Name of the body, for printing.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A length or a mass that is zero, negative or not finite.
    ///
    /// Examples
    /// --------
    /// >>> Body.ellipsoid(3, 2, 1, mass=5).moments
    /// array([ 5., 10., 13.])
    #[staticmethod]
    #[pyo3(signature = (a, b, c, *, mass=1.0, name=None))]
    fn ellipsoid(a: f64, b: f64, c: f64, mass: f64, name: Option<&str>) -> PyResult<Self> {
        named(andoyer_propagate::Body::ellipsoid([a, b, c], mass), name)
    }

    /// A homogeneous box with edges x, y, z along body axes 1, 2, 3. Its moments are m (y² + z²)/12, m (x² + z²)/12, m (x² + y²)/12.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float
    ///     Positive lengths, in any order.
    /// mass : float, optional
    ///     Mass m; by default 1.
    /// name : str, optional
    ///     Name of the body, for printing.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A length or a mass that is zero, negative or not finite.
    ///
    /// Examples
    /// --------
    /// >>> Body.box(3, 2, 1, mass=12).moments
    /// array([ 5., 10., 13.])
    #[staticmethod]
    #[pyo3(name = "box", signature = (x, y, z, *, mass=1.0, name=None))]
    fn cuboid(x: f64, y: f64, z: f64, mass: f64, name: Option<&str>) -> PyResult<Self> {
        named(andoyer_propagate::Body::cuboid([x, y, z], mass), name)
    }

    /// The interval of the ratios P_ψ/P_φ that this body can have in a mode. Each ratio in the interval belongs to one motion.
    ///
    /// Parameters
    /// ----------
    /// mode : {"short-axis", "long-axis"}, optional
    ///     The mode, as in `Scene.from_periods`.
    /// convention : {"extremal-axis", "long-axis", "short-axis"}, optional
    ///     The convention of the periods, as in `Scene.from_periods`.
    ///
    /// Returns
    /// -------
    /// (float, float)
    ///     The ratio for rotation about the axis of the mode, and that of the motion nearest to the separatrix whose periods a state in doubles holds to 1e-5. On the separatrix the
    ///     ratio is infinite.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown mode or convention (``mode="separatrix"``, ``convention="L"``); a mode that an axisymmetric body does not have.
    ///
    /// Examples
    /// --------
    /// >>> low, high = Body([0.61, 0.965, 1.0]).period_ratios()
    /// >>> round(low, 3)
    /// 7.567
    #[pyo3(signature = (mode="short-axis", *, convention="extremal-axis"))]
    fn period_ratios(&self, mode: &str, convention: &str) -> PyResult<(f64, f64)> {
        let (mode, convention) =
            (mode.parse().map_err(error::propagation)?, convention.parse().map_err(error::propagation)?);
        self.body.period_ratios(mode, convention).map(Into::into).map_err(error::propagation)
    }

    /// A body of the catalogue.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of `Body.catalogue()`, in lower or upper case.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown name (``"vulcan"``). The message suggests a similar name: Ceres for ``"ceers"``.
    #[staticmethod]
    fn named(name: &str) -> PyResult<Self> {
        andoyer_propagate::Body::named(name).map(Self::from).map_err(error::propagation)
    }

    /// The names of the catalogue, which `Body.named` accepts.
    #[staticmethod]
    fn catalogue() -> Vec<&'static str> {
        andoyer_propagate::Body::catalogue()
    }

    /// The source of the figures of a catalogue body.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of `Body.catalogue()`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown name (``"vulcan"``).
    #[staticmethod]
    fn source(name: &str) -> PyResult<&'static str> {
        andoyer_propagate::Body::source(name).map_err(error::propagation)
    }

    /// The moments of inertia about body axes 1, 2, 3 in the given order: a read-only array, shape (3,).
    #[getter]
    fn moments<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        array::constant(py, &self.body.moments()).into_any()
    }

    /// Whether the body was made by `from_inertia`. `Motion.partials` then has twelve parameters instead of nine.
    #[getter]
    fn has_tensor(&self) -> bool {
        self.body.has_tensor()
    }

    /// The inertia tensor about the user's axes: a read-only array, shape (3, 3). It is diagonal unless the body was made by `from_inertia`.
    #[getter]
    fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(array::constant_rows(py, &self.body.inertia())?.into_any())
    }

    /// The principal axes in the user's components, as the columns of a rotation matrix in the order of `moments`: a read-only array, shape (3, 3).
    ///
    /// It is the unit matrix unless the body was made by `from_inertia` from a tensor about other axes.
    #[getter]
    fn principal_axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let axes = self.body.principal_axes();
        let rows: [[f64; 3]; 3] = std::array::from_fn(|row| std::array::from_fn(|column| axes[(row, column)]));
        Ok(array::constant_rows(py, &rows)?.into_any())
    }

    /// Asphericity α = [(C/A − 1) + (C/B − 1)]/2 of the sorted moments A ≤ B ≤ C (theory §1); 0 for a sphere.
    #[getter]
    fn alpha(&self) -> f64 {
        self.body.alpha()
    }

    /// Triaxiality β, 0 ≤ β ≤ 1 (theory §1); 0 for A = B and for a sphere, 1 for B = C.
    #[getter]
    fn beta(&self) -> f64 {
        self.body.beta()
    }

    /// γ = √((C/A − 1)(C/B − 1)) (theory §1).
    #[getter]
    fn gamma(&self) -> f64 {
        self.body.gamma()
    }

    /// ω = √((1 + β)/(1 − β)) (theory §1); 1 for a sphere, infinite for B = C.
    #[getter]
    fn omega(&self) -> f64 {
        self.body.omega()
    }

    /// The name, or None.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.body.name()
    }

    /// The gravity field of degree 3 and 4, or None.
    #[getter]
    fn gravity(&self) -> Option<Gravity> {
        self.body.gravity().cloned().map(Gravity)
    }

    pub(crate) fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut name = match self.body.name() {
            Some(name) => format!(", name={}", name.into_pyobject(py)?.repr()?),
            None => String::new(),
        };
        if let Some(gravity) = self.gravity() {
            name += &format!(", gravity={}", gravity.__repr__(py)?);
        }
        Ok(if self.body.has_tensor() {
            format!("Body.from_inertia({:?}{name})", self.body.inertia())
        } else {
            format!("Body({:?}{name})", self.body.moments())
        })
    }

    pub(crate) fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let rows = self.body.inertia().map(|row| PyTuple::new(py, row));
        let [first, second, third] = rows;
        ((first?, second?, third?), self.body.name()).into_pyobject(py)?.hash()
    }

    /// Rebuilds a body for `pickle`.
    #[staticmethod]
    #[pyo3(signature = (inertia, name, by_tensor=false, gravity=None))]
    fn _restored(
        inertia: [[f64; 3]; 3],
        name: Option<&str>,
        by_tensor: bool,
        gravity: Option<&Bound<'_, Gravity>>,
    ) -> PyResult<Self> {
        let [[a, p, q], [_, b, r], [_, _, c]] = inertia;
        let by_moments = !by_tensor && [p, q, r] == [0.0; 3];
        let body = if by_moments {
            andoyer_propagate::Body::new([a, b, c])
        } else {
            andoyer_propagate::Body::from_inertia(inertia)
        };
        let Body { body, .. } = named(body, name)?;
        let field = gravity.map(|gravity| gravity.get().0.clone());
        let body = field.map_or_else(|| Ok(body.clone()), |field| body.clone().with_gravity(field));
        body.map(Self::from).map_err(error::propagation)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py, '_>> {
        let body = (self.body.inertia(), self.body.name(), self.body.has_tensor(), self.gravity());
        Ok((py.get_type::<Self>().getattr("_restored")?, body))
    }
}

type Rows = [[f64; 3]; 3];

fn named(body: Result<andoyer_propagate::Body, andoyer_propagate::Error>, name: Option<&str>) -> PyResult<Body> {
    let body = body.map_err(error::propagation)?;
    Ok(Body::from(match name {
        Some(name) => body.with_name(name),
        None => body,
    }))
}
