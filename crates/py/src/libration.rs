//! `Motion.libration`, `andoyer.Libration` and `andoyer.LibrationTerm`.

use andoyer_propagate::libration_terms as terms;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::array;
use crate::motion::Motion;

#[pymethods]
impl Motion {
    /// The proper modes and the terms of a body locked to its orbit: a `Libration`, or None if the method is not "libration".
    #[getter]
    fn libration(&self) -> Option<Libration> {
        self.0.libration().cloned().map(Libration)
    }
}

/// The libration of a body whose rotation is locked to its orbit, from `Motion.libration`.
///
/// The body's axes of least, middle and greatest moment turn by Rz(ψ) Ry(θ) Rx(φ) from a frame that turns r times an orbit about the orbit's normal and
/// has its first axis along the pericentre at the passage (for r = 1/2 at right angles to it). ψ is the longitude, θ and φ are the angles of the pole.
/// Each angle is a sum of terms.
///
/// Examples
/// --------
/// >>> moon = Body([0.99948, 0.999772, 1.0])
/// >>> motion = Scene(moon, [0, 0, 0, 1], [0, 0, 1], orbit=Orbit(1.0, 0.0549), span=(0, 6e3), tolerance=1e-6, method="libration").solve()
/// >>> motion.plan.resonance, motion.plan.order
/// (Fraction(1, 1), 4)
/// >>> largest = motion.libration.forced()[0]
/// >>> largest.angle, largest.multiples, f"{largest.amplitude:.2e}"
/// ('longitude', (0, 0, 0, 1), '9.57e-05')
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Libration(terms::Libration);

#[pymethods]
impl Libration {
    /// Rates of the proper modes, longitude first and then the two of the pole, in rad per unit of time, shape (3,).
    #[getter]
    fn frequencies<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array::constant(py, &self.0.frequencies())
    }

    /// Proper periods in the unit of time, shape (3,). They are those in the frame that turns with the resonance.
    #[getter]
    fn periods<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array::constant(py, &self.0.periods())
    }

    /// The largest angle of each proper mode, in rad, shape (3,).
    #[getter]
    fn amplitudes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array::constant(py, &self.0.amplitudes())
    }

    /// The phase of this angle at the epoch, in rad, shape (3,); 0 for a mode without amplitude.
    #[getter]
    fn phases<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array::constant(py, &self.0.phases())
    }

    /// The obliquity of a Cassini state, from the orbit's normal to axis 3 of the frame in which the body librates, in rad; 0 if the node is fixed.
    ///
    /// Positive away from inertial axis 3.
    #[getter]
    fn obliquity(&self) -> f64 {
        self.0.obliquity()
    }

    /// What the series leaves in the equations of motion, as an angle in rad; it is part of the error bound.
    #[getter]
    fn residual(&self) -> f64 {
        self.0.residual()
    }

    /// The mean motion of the orbit that locks the body, in rad per unit of time.
    #[getter]
    fn mean_motion(&self) -> f64 {
        self.0.mean_motion()
    }

    /// All terms, the largest first.
    ///
    /// Returns
    /// -------
    /// list of LibrationTerm
    fn terms(&self) -> Vec<LibrationTerm> {
        self.0.terms().into_iter().map(|term| LibrationTerm(term, self.0.phases_of_terms())).collect()
    }

    /// The terms without proper modes, which the orbit forces, the largest first: the table that papers print.
    ///
    /// Returns
    /// -------
    /// list of LibrationTerm
    fn forced(&self) -> Vec<LibrationTerm> {
        self.0.forced().into_iter().map(|term| LibrationTerm(term, self.0.phases_of_terms())).collect()
    }

    fn __repr__(&self) -> String {
        let [longitude, first, second] = self.0.periods();
        format!(
            "<Libration of order {} with {} harmonics, proper periods {longitude:.6e}, {first:.6e}, {second:.6e}>",
            self.0.order(),
            self.0.harmonics()
        )
    }
}

/// A term of a libration: amplitude · sin(phase + 2π (t − epoch)/period).
#[pyclass(frozen, eq, module = "andoyer")]
#[derive(PartialEq)]
pub(crate) struct LibrationTerm(terms::LibrationTerm, usize);

#[pymethods]
impl LibrationTerm {
    /// Multiples of the three proper angles and of the mean anomaly M; if the node moves, a fifth one of the angle r M + ω + ψ₀ from the node.
    ///
    /// If the pericentre is fixed then, this angle goes with r M, and the fifth is 0 or 1.
    #[getter]
    fn multiples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.multiples_of_phases())
    }

    /// The period in the unit of time, positive also where the rate of the multiples is negative; infinite for a constant.
    #[getter]
    fn period(&self) -> f64 {
        self.0.period
    }

    /// The amplitude, in rad.
    #[getter]
    fn amplitude(&self) -> f64 {
        self.0.amplitude
    }

    /// The phase at the epoch, in rad, from −π to π.
    #[getter]
    fn phase(&self) -> f64 {
        self.0.phase
    }

    /// The angle that has this term: "longitude" (ψ), "pole-1" (θ) or "pole-2" (φ).
    #[getter]
    fn angle(&self) -> &'static str {
        self.0.angle.name()
    }

    fn __repr__(&self) -> String {
        let terms::LibrationTerm { period, amplitude, phase, angle, .. } = self.0;
        let multiples = self.multiples_of_phases();
        format!(
            "<LibrationTerm {} {multiples:?}: {amplitude:.6e} rad, period {period:.8e}, phase {phase:.4}>",
            angle.name()
        )
    }
}

impl LibrationTerm {
    fn multiples_of_phases(&self) -> &[i64] {
        &self.0.multiples[..self.1]
    }
}
