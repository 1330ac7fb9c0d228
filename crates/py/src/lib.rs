//! The Python bindings of andoyer: the extension module `andoyer._core`.
//!
//! There is one file for each class of the Python package. Each class is a thin frozen wrapper of the Rust type of the same name. `array`, `expression` and
//! `order` convert arguments, and `error` converts errors. The bindings contain no mathematics; every function of the Python package exists in Rust too. Arrays
//! are float64 in C order: times (n,), attitudes (n, 4) as [x, y, z, w], vectors (n, 3), ensembles (m, n, …). The interpreter lock is released during all
//! computations. Doc comments of `#[pyclass]` and `#[pymethods]` items are the Python docstrings, in the style of NumPy. The stub is
//! `python/andoyer/_core.pyi`; a test compares it with the module.

// Docstrings speak of Python's names and of arrays like [x, y, z, w].
#![allow(rustdoc::broken_intra_doc_links)]

mod array;
mod birkhoff;
mod body;
mod cassini;
mod computing;
mod dissipation;
mod domain;
mod driven;
mod driven_form;
mod ensemble;
mod ephemeris;
mod error;
mod evolution;
mod expression;
mod field;
mod field_torque;
mod foreign;
mod form;
mod gravity;
mod kernel;
mod libration;
mod material;
mod mean;
mod members;
mod motion;
mod normal_form;
mod normalize;
mod orbit;
mod orbital;
mod order;
mod partials;
mod plan;
mod progress;
mod relaxation;
mod samples;
mod scene;
mod scene_class;
mod shape_torque;
mod tabulated;
mod torque;
mod values;
mod verification;

/// The compiled core of the package `andoyer`, which re-exports all its names.
#[pyo3::pymodule]
mod _core {
    #[pymodule_export]
    use super::birkhoff::BirkhoffNormalForm;
    #[pymodule_export]
    use super::body::Body;
    #[pymodule_export]
    use super::cassini::{CassiniState, cassini_states};
    #[pymodule_export]
    use super::computing::_panic;
    #[pymodule_export]
    use super::dissipation::{Dissipation, LoadHarmonic};
    #[pymodule_export]
    use super::domain::Domain;
    #[pymodule_export]
    use super::driven::Driven;
    #[pymodule_export]
    use super::driven_form::DrivenNormalForm;
    #[pymodule_export]
    use super::ensemble::Ensemble;
    #[pymodule_export]
    use super::ephemeris::_read_pck;
    #[pymodule_export]
    use super::error::{
        Error, FileError, InputError, InternalError, RepresentationError, TheoryError, ToleranceWarning,
    };
    #[pymodule_export]
    use super::evolution::{Drift, Evolution, EvolutionEnd, EvolutionPlan, EvolvedStates};
    #[pymodule_export]
    use super::field::Field;
    #[pymodule_export]
    use super::gravity::Gravity;
    #[pymodule_export]
    use super::kernel::{_clock_code, _frame_code, _write_motion, _write_samples};
    #[pymodule_export]
    use super::libration::{Libration, LibrationTerm};
    #[pymodule_export]
    use super::material::Material;
    #[pymodule_export]
    use super::motion::Motion;
    #[pymodule_export]
    use super::normal_form::{NormalForm, separatrix_action};
    #[pymodule_export]
    use super::normalize::normalize;
    #[pymodule_export]
    use super::orbit::Orbit;
    #[pymodule_export]
    use super::orbital::Orbital;
    #[pymodule_export]
    use super::partials::Partials;
    #[pymodule_export]
    use super::plan::Plan;
    #[pymodule_export]
    use super::relaxation::{Relaxation, RelaxedStates};
    #[pymodule_export]
    use super::samples::Samples;
    #[pymodule_export]
    use super::scene_class::Scene;
    #[pymodule_export]
    use super::tabulated::TabulatedOrbit;
    #[pymodule_export]
    use super::torque::Torque;
    #[pymodule_export]
    use super::verification::Verification;

    #[pymodule_init]
    fn init(module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        super::error::with_attributes(module.py())
    }

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
