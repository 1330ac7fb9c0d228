//! `andoyer.Motion`.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::partials::PARAMETERS;
use andoyer_propagate::periods::Convention;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyType};

use crate::array::{Times, chunks, matrices, write};
use crate::computing::{detached, interruptible};
use crate::error;
use crate::foreign::{self, Calendar};
use crate::mean;
use crate::partials::Partials;
use crate::plan::Plan;
use crate::samples::Samples;
use crate::scene_class::Scene;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A solved motion, from `Scene.solve`: immutable, and shared between threads, which run in parallel while they evaluate it.
///
/// Every method that takes `times` takes a scalar or an array_like of shape (n,), of floats or integers; a scalar gives results without
/// the leading axis. Where the epoch of the scene is a Time of astropy, times may be Time too; a TimeDelta is a duration from the epoch. The difference
/// from the epoch is formed in the two doubles of astropy, and `Samples.times` is what was given. Ctrl-C ends every call within a second.
///
/// Raises
/// ------
/// RepresentationError
///     A time more than 1e15 rotations from the epoch, under ``averaging="spin"`` more than 65,534 orbits from it, or of an integrated motion outside the span; the message has its
///     index and says which.
/// InputError
///     A time that is NaN or infinite. A calendar time (a Time) where the epoch is a number; a Quantity where the epoch is a calendar time.
///     Times with two axes.
///
/// Examples
/// --------
/// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
/// >>> motion.attitude(0.0).round(12) + 0.0
/// array([0., 0., 0., 1.])
/// >>> motion.angular_velocity([0, 1, 2]).shape
/// (3, 3)
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Motion(pub(crate) andoyer_propagate::Motion, pub(crate) Option<Calendar>);

#[pymethods]
impl Motion {
    /// Attitudes and angular velocities, in one pass.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    /// scalar_first : bool, optional
    ///     Attitudes as [w, x, y, z].
    ///
    /// Returns
    /// -------
    /// Samples
    #[pyo3(signature = (times, *, scalar_first=false))]
    fn at(&self, py: Python<'_>, times: &Bound<'_, PyAny>, scalar_first: bool) -> PyResult<Samples> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let [copy, attitude, rates] = times.samples()?;
        {
            let (mut attitude, mut rates) = (write(&attitude)?, write(&rates)?);
            let (values, attitude, rates) = (times.values()?, chunks(&mut attitude)?, chunks(&mut rates)?);
            let evaluate = |stop: &AtomicBool| {
                self.batch(since_epoch, stop).samples_into(values, attitude, rates)?;
                foreign::scalar_first(attitude, scalar_first, stop);
                Ok(())
            };
            interruptible(py, times.long(), error::propagation, evaluate)?;
        }
        Ok(Samples::new(copy.unbind(), attitude.unbind(), rates.unbind(), scalar_first).given(times.given()))
    }

    /// Unit quaternions [x, y, z, w] that rotate body components into inertial ones (theory §8).
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    /// out : ndarray, float64, C-contiguous, shape (n, 4), optional
    ///     Where the result is written. After an error it holds what had been computed.
    /// scalar_first : bool, optional
    ///     [w, x, y, z] instead.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 4)
    ///     `out`, if given.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An `out` of another shape, or strided.
    /// TypeError
    ///     An `out` that is no float64 array, or read-only.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    /// >>> out = np.empty((2, 4))
    /// >>> motion.attitude([0, 1], out=out) is out
    /// True
    #[pyo3(signature = (times, out=None, *, scalar_first=false))]
    fn attitude<'py>(
        &self,
        times: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        scalar_first: bool,
    ) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let evaluate = |values: &[f64], rows: &mut [[f64; 4]], stop: &AtomicBool| {
            self.batch(since_epoch, stop).attitudes_into(values, rows)?;
            foreign::scalar_first(rows, scalar_first, stop);
            Ok(())
        };
        times.evaluate(out, evaluate).map(|(rows, ())| rows)
    }

    /// Angular velocities in body components, in rad per unit of time.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    /// out : ndarray, float64, C-contiguous, shape (n, 3), optional
    ///     As in `attitude`.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 3)
    #[pyo3(signature = (times, out=None))]
    fn angular_velocity<'py>(
        &self,
        times: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        times
            .evaluate(out, |values, rows, stop| self.batch(since_epoch, stop).angular_velocities_into(values, rows))
            .map(|(rows, ())| rows)
    }

    /// Angular momenta in inertial components, in the unit of moment × rate: the same at all times unless the scene has an orbit.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 3)
    fn angular_momentum<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        times
            .evaluate(None, |values, rows, stop| self.batch(since_epoch, stop).angular_momenta_into(values, rows))
            .map(|(rows, ())| rows)
    }

    /// Andoyer variables (λ, μ, ν, Λ, M, N) (theory §1).
    ///
    /// Attitude = Rz(λ) Rx(I) Rz(μ) Rx(J) Rz(ν) with cos I = Λ/M, cos J = N/M. Axis 3 is the user's axis of greatest inertia with its
    /// sense, axis 2 that of B, axis 1 that of A, reversed where the user's order A, B, C is left-handed. So N < 0 is a body that turns
    /// backwards about its axis 3. For N > 0, y = μ + ν grows with `frequencies.longitude` and ν at −dℓ′/dt; for N < 0, y = μ − ν
    /// grows with `frequencies.longitude` and ν at +dℓ′/dt; μ grows with the sum of both frequencies in either case. Angles are in
    /// (−π, π]; where a node is not defined (I or J = 0 or π) its angle is 0 and μ carries the sum. Zeros for a body at rest.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 6)
    ///     Angles in rad, momenta in the unit of moment × rate.
    fn andoyer<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        times
            .evaluate(None, |values, rows, stop| self.batch(since_epoch, stop).andoyer_into(values, rows))
            .map(|(rows, ())| rows)
    }

    /// Attitudes as a `scipy.spatial.transform.Rotation`, body to inertial. SciPy is imported here and nowhere else.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///
    /// Returns
    /// -------
    /// scipy.spatial.transform.Rotation
    ///     A single one for a scalar time.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     SciPy is not installed: the extra ``andoyer[scipy]`` brings it.
    fn rotation<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        foreign::rotation(&self.attitude(times, None, false)?)
    }

    /// Derivatives of attitude and angular velocity with respect to the state at the epoch and the moments (theory §12).
    ///
    /// Columns are nine parameters: the initial attitude (a small rotation about body axes 1, 2, 3), the initial angular velocity, the moments as given. A change of attitude,
    /// at the epoch and at the time, is a rotation vector δθ about body axes, R → R exp([δθ]×); rates are body components. Closed form: no differences and no
    /// integration, at any time and in every mode; for a scene with an orbit by differences (`Plan.partials` says which).
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///
    /// Returns
    /// -------
    /// Partials
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     A motion on the separatrix, whose frequencies have no derivatives.
    ///
    /// Examples
    /// --------
    /// Rotation about axis 3 for 10 units of time: the angle grows by 10 for each unit of its rate.
    ///
    /// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 2.0]).solve()
    /// >>> float(motion.partials(10.0).attitude[2, 5])
    /// 10.0
    fn partials(&self, py: Python<'_>, times: &Bound<'_, PyAny>) -> PyResult<Partials> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let [copy, attitude, rates] = times.matrices(PARAMETERS)?;
        {
            let (mut attitude, mut rates) = (write(&attitude)?, write(&rates)?);
            let (values, attitude, rates) = (times.values()?, matrices(&mut attitude)?, matrices(&mut rates)?);
            let evaluate = |stop: &AtomicBool| self.batch(since_epoch, stop).partials_into(values, attitude, rates);
            interruptible(py, times.long_partials(), error::propagation, evaluate)?;
        }
        Ok(Partials::new(copy.unbind(), attitude.unbind(), rates.unbind()))
    }

    /// A self-contained function `rotation(time)` that evaluates this motion, as the text of a file of source (theory §8).
    ///
    /// It returns the attitude [x, y, z, w] and the angular velocity in body components, from the constants in the file and the language alone: C99 with math.h, Rust of `core`,
    /// Python with math, JavaScript. C and Rust allocate nothing. Phases are kept in two doubles, so that they hold after 1e9 rotations. The head of the file names the scene,
    /// the mode, the validity interval and the largest difference from the library. Times count as those of the scene; for an epoch of astropy in TDB seconds since J2000.
    ///
    /// Parameters
    /// ----------
    /// language : {"c", "rust", "python", "javascript"}, optional
    ///
    /// Returns
    /// -------
    /// str
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The language ``"fortran"``.
    /// RepresentationError
    ///     A passage along the separatrix, or a motion under a torque.
    ///
    /// Examples
    /// --------
    /// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    /// >>> namespace = {}
    /// >>> exec(motion.to_code("python"), namespace)
    /// >>> attitude, rates = namespace["rotation"](1e9)
    /// >>> bool(abs(motion.attitude(1e9) - attitude).max() < 1e-14)
    /// True
    #[pyo3(signature = (language="c"))]
    fn to_code(&self, py: Python<'_>, language: &str) -> PyResult<String> {
        let language = language.parse().map_err(error::propagation)?;
        detached(py, error::propagation, || self.0.to_code(language))
    }

    /// The same with the bounds of its differences that its head states: of the attitude [rad], of the angular velocity over its length.
    fn _code(&self, py: Python<'_>, language: &str) -> PyResult<(String, f64, f64)> {
        let language = language.parse().map_err(error::propagation)?;
        let code = detached(py, error::propagation, || self.0.code(language))?;
        Ok((code.text().to_owned(), code.attitude_error(), code.rate_error()))
    }

    /// What is evaluated, and why.
    #[getter]
    fn plan(&self) -> Plan {
        Plan(self.0.plan().clone())
    }

    /// The scene that was solved.
    #[getter]
    fn scene(&self) -> Scene {
        Scene { calendar: self.1, ..self.0.scene().clone().into() }
    }

    /// Mean frequencies dℓ′/dt, dy′/dt (theory §7): a named tuple (anomaly, longitude), in rad per unit of time; 0 where there is none.
    ///
    /// Of an integrated motion they are those of the free motion at the epoch, as `periods`.
    ///
    /// Neither is ever negative. y = μ + ν; for N < 0, where axis 3 points away from the angular momentum, y = μ − ν (see `andoyer`).
    #[getter]
    fn frequencies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        static FREQUENCIES: PyOnceLock<Py<PyType>> = PyOnceLock::new();
        let frequencies = self.0.frequencies();
        FREQUENCIES.import(py, "andoyer.mean", "Frequencies")?.call1((frequencies.anomaly, frequencies.longitude))
    }

    /// Mean periods (P_φ, P_ψ) in three conventions: a dict with the keys "long-axis", "short-axis" and "extremal-axis".
    ///
    /// Values are named tuples (precession, rotation) in units of time, infinite where there is no such period.
    ///
    /// - "short-axis" is the convention of the Andoyer variables. P_φ is the mean precession of the short axis about the angular momentum;
    ///   P_ψ is the rotation about it, in the long-axis mode its oscillation. In the short-axis mode P_φ = 2π/(dy′/dt + dℓ′/dt), with
    ///   which μ turns, and P_ψ = 2π/(dℓ′/dt), with which ν turns: backwards, for N < 0 forwards.
    /// - "long-axis" has the same of the long axis: in the short-axis mode P_φ = 2π/(dy′/dt). Radar papers use it.
    /// - "extremal-axis" is the convention of light-curve papers (Pravec et al. 2014): the short axis in the short-axis mode, the long axis
    ///   in the long-axis mode. It is one of the other two.
    ///
    /// P_ψ is the same in all three.
    ///
    /// Examples
    /// --------
    /// >>> periods = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve().periods
    /// >>> periods["extremal-axis"] == periods["short-axis"]
    /// True
    /// >>> (precession, rotation), long = periods["short-axis"], periods["long-axis"].precession
    /// >>> abs(1 / precession - 1 / rotation - 1 / long) < 1e-15
    /// True
    #[getter]
    fn periods<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        mean::periods(
            py,
            "Periods",
            Convention::ALL.into_iter().map(|convention| {
                let pair = self.0.periods_of(convention);
                (convention, (pair.precession, pair.rotation))
            }),
        )
    }

    /// E/E0: rotational energy over that of rotation about the axis of greatest inertia with the same angular momentum (theory §5).
    ///
    /// 1 on that axis, C/B on the separatrix, C/A on the axis of least inertia; with an orbit, of the state at the epoch.
    #[getter]
    fn energy_ratio(&self) -> f64 {
        self.0.energy_ratio()
    }

    /// k², the parameter of the elliptic functions of the polhode (theory §10): 0 on a principal axis, 1 on the separatrix.
    #[getter]
    fn elliptic_parameter(&self) -> f64 {
        self.0.elliptic_parameter()
    }

    fn __repr__(&self) -> String {
        let plan = self.0.plan();
        let name = self.0.scene().asked_name().map_or_else(String::new, |name| format!(" of {name:?}"));
        format!("<Motion{name}: {}, {}, order {}>", plan.mode(), plan.method(), plan.order())
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// A motion is pickled as its scene, and solved again: without a warning, which was given when it was solved first.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Scene,))> {
        Ok((py.get_type::<Self>().getattr("_restored")?, (self.scene(),)))
    }

    #[staticmethod]
    fn _restored(py: Python<'_>, scene: PyRef<'_, Scene>) -> PyResult<Self> {
        scene.solved(py).map(|motion| Self(motion, scene.calendar))
    }
}

impl Motion {
    fn times<'py>(&self, value: &Bound<'py, PyAny>) -> PyResult<Times<'py>> {
        Times::new(value, self.1, self.0.plan().steps() > 0 || !self.0.scene().asked_disturbing().is_empty())
    }

    /// How these times are evaluated.
    fn batch<'a>(&'a self, since_epoch: bool, stop: &'a AtomicBool) -> andoyer_propagate::batch::Batch<'a> {
        let batch = self.0.batch().until(stop);
        if since_epoch { batch.since_epoch() } else { batch }
    }
}
