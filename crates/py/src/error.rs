//! The exceptions, and which error of the Rust crates becomes which.
//!
//! `Error` is a `ValueError`; every kind of bad input has one subclass of it. The message is that of the Rust error. What is not an
//! array-like of numbers, no `Body` or no string where one is due, stays Python's own `TypeError`.

use std::ffi::CString;

use andoyer_propagate::Error as Propagation;
use andoyer_series::{Error as Algebra, ParseProblem};
use pyo3::create_exception;
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;

create_exception!(
    andoyer,
    Error,
    PyValueError,
    "Bad input, or a motion that is not served; the base of every error of this package."
);
create_exception!(andoyer, InternalError, Error, "A fault of this package: no input should lead to it.");
create_exception!(andoyer, MomentsError, Error, "Moments of inertia that no body has.");
create_exception!(
    andoyer,
    PeriodsError,
    Error,
    "Periods that a body cannot have in a mode, a mode it does not have, or Andoyer variables that are none."
);
create_exception!(andoyer, AttitudeError, Error, "An attitude that is no unit quaternion.");
create_exception!(andoyer, AngularVelocityError, Error, "An angular velocity that is not finite.");
create_exception!(
    andoyer,
    UnitsError,
    Error,
    "Units in which the angular momentum, or a rate that belongs to it, over- or underflows."
);
create_exception!(andoyer, EpochError, Error, "An epoch that is not finite.");
create_exception!(andoyer, ToleranceError, Error, "A tolerance that is not positive and finite.");
create_exception!(andoyer, SpanError, Error, "A span that is not finite or runs backwards.");
create_exception!(andoyer, OrderError, Error, "An order that is no whole number within its bounds.");
create_exception!(andoyer, MethodError, Error, "A method that is unknown.");
create_exception!(andoyer, ThreadsError, Error, "A number of threads that is none, or that the system does not give.");
create_exception!(andoyer, OrbitError, Error, "An element of an orbit that is none.");
create_exception!(
    andoyer,
    AveragingError,
    Error,
    "An averaging that is unknown, or a motion that has no averaged theory."
);
create_exception!(andoyer, LevelError, Error, "A level of the theory of the gravity gradient that is unknown.");
create_exception!(
    andoyer,
    SpinResonanceError,
    Error,
    "A rotation so slow, or so near a resonance with its orbit, that no averaging holds."
);
create_exception!(andoyer, TorqueError, Error, "A torque too strong for an expansion in it.");
create_exception!(andoyer, TimesError, Error, "A time that is not finite, or too far from the epoch to be evaluated.");
create_exception!(andoyer, ShapeError, Error, "An array of the wrong shape or memory layout.");
create_exception!(
    andoyer,
    SeparatrixError,
    Error,
    "The series asked for on the separatrix, or too near it for the tolerance."
);
create_exception!(andoyer, UnknownBodyError, Error, "A name that the catalogue of bodies does not have.");
create_exception!(andoyer, SceneFileError, Error, "A scene file that cannot be read or says something wrong.");
create_exception!(
    andoyer,
    UnknownNameError,
    Error,
    "A name that is none of the known ones: of a variable, or of a part of the normal form."
);
create_exception!(andoyer, IntervalError, Error, "A number outside its interval.");
create_exception!(
    andoyer,
    HamiltonianError,
    Error,
    "A polynomial that cannot be read, or a Hamiltonian whose quadratic part cannot be diagonalized."
);
create_exception!(
    andoyer,
    ResonanceError,
    Error,
    "A resonance or small divisor not asked for, or one asked for that is none."
);
create_exception!(andoyer, FormatError, Error, "A text that is not the JSON of a normal form.");
create_exception!(andoyer, SeriesError, Error, "Any other error of the exact algebra.");

create_exception!(
    andoyer,
    ToleranceWarning,
    PyUserWarning,
    "A motion, or members of an ensemble, whose error bound exceeds the tolerance over the span."
);

/// Warns with a sentence, if there is one, at the line that called.
pub(crate) fn warn_of_tolerance(py: Python<'_>, said: Option<String>) -> PyResult<()> {
    let Some(said) = said else { return Ok(()) };
    let said = CString::new(said)?;
    PyErr::warn(py, &py.get_type::<ToleranceWarning>(), &said, 1)
}

/// The exception of an error in propagation: of a member of an ensemble that of a single body, with the attribute `index`.
pub(crate) fn propagation(error: Propagation) -> PyErr {
    let message = error.to_string();
    match error {
        Propagation::Member { index, problem, .. } => Python::attach(|py| {
            let exception = of_kind(&problem, message);
            exception.value(py).setattr("index", index).map_or_else(|failure| failure, |()| exception)
        }),
        _ => of_kind(&error, message),
    }
}

fn of_kind(error: &Propagation, message: String) -> PyErr {
    match error {
        Propagation::Moment { .. } | Propagation::MomentsTriangle { .. } | Propagation::MomentsRatio { .. } => {
            MomentsError::new_err(message)
        }
        Propagation::InertiaSymmetry { .. } | Propagation::InertiaMoments { .. } => MomentsError::new_err(message),
        Propagation::Positive { argument: "precession" | "rotation", .. }
        | Propagation::PeriodRatio { .. }
        | Propagation::ModeName { .. }
        | Propagation::NoSuchMode { .. }
        | Propagation::Convention { .. }
        | Propagation::Direction { .. }
        | Propagation::Andoyer { .. } => PeriodsError::new_err(message),
        Propagation::Positive { .. } => MomentsError::new_err(message),
        Propagation::Units { .. } => UnitsError::new_err(message),
        Propagation::Attitude { .. } => AttitudeError::new_err(message),
        Propagation::AngularVelocity { .. } => AngularVelocityError::new_err(message),
        Propagation::Epoch { .. } => EpochError::new_err(message),
        Propagation::Tolerance { .. } => ToleranceError::new_err(message),
        Propagation::Span { .. } => SpanError::new_err(message),
        Propagation::Order { .. } => OrderError::new_err(message),
        Propagation::Method { .. } | Propagation::OnError { .. } => MethodError::new_err(message),
        Propagation::Orbit { .. } => OrbitError::new_err(message),
        Propagation::Averaging { .. } | Propagation::TooManyOrbits { .. } | Propagation::Unaveraged { .. } => {
            AveragingError::new_err(message)
        }
        Propagation::Level { .. } => LevelError::new_err(message),
        Propagation::Resonance { .. } => SpinResonanceError::new_err(message),
        Propagation::TorqueTooStrong { .. } => TorqueError::new_err(message),
        Propagation::Time { .. } => TimesError::new_err(message),
        Propagation::Threads { .. } => ThreadsError::new_err(message),
        Propagation::Index { .. } | Propagation::Length { .. } => ShapeError::new_err(message),
        Propagation::NearSeparatrix { .. } | Propagation::Separatrix | Propagation::SeparatrixPartials => {
            SeparatrixError::new_err(message)
        }
        Propagation::UnknownBody { .. } => UnknownBodyError::new_err(message),
        Propagation::SceneFile { .. } => SceneFileError::new_err(message),
        _ => Error::new_err(message),
    }
}

/// The exception of an error in the exact algebra.
pub(crate) fn algebra(error: Algebra) -> PyErr {
    let message = error.to_string();
    exception(error, message)
}

/// The same where the error is that of one argument and does not name it.
pub(crate) fn algebra_of(argument: &str, error: Algebra) -> PyErr {
    let message = format!("{argument}: {error}");
    exception(error, message)
}

fn exception(error: Algebra, message: String) -> PyErr {
    match error {
        Algebra::OrderTooLarge { .. } | Algebra::MemoryTooLarge { .. } | Algebra::OrderOutOfRange { .. } => {
            OrderError::new_err(message)
        }
        Algebra::NameUnknown { .. }
        | Algebra::ParameterUnknown { .. }
        | Algebra::Parse { problem: ParseProblem::UnknownName(_), .. } => UnknownNameError::new_err(message),
        Algebra::OutsideInterval { .. } | Algebra::NotFinite { .. } => IntervalError::new_err(message),
        Algebra::Parse { .. }
        | Algebra::PhaseSpaceSize { .. }
        | Algebra::LinearTerm { .. }
        | Algebra::ParameterDegree { .. }
        | Algebra::ZeroFrequency { .. }
        | Algebra::FrequencyParameter { .. }
        | Algebra::Defective { .. }
        | Algebra::SpectrumIrrational { .. }
        | Algebra::FrequencyIrrational { .. } => HamiltonianError::new_err(message),
        Algebra::SmallDivisor { .. }
        | Algebra::NotResonant { .. }
        | Algebra::ResonanceMalformed { .. }
        | Algebra::ResonantTerm { .. } => ResonanceError::new_err(message),
        Algebra::Json(_)
        | Algebra::FormatUnknown { .. }
        | Algebra::RationalMalformed { .. }
        | Algebra::CountMismatch { .. }
        | Algebra::NotSymplectic { .. }
        | Algebra::TermInconsistent { .. }
        | Algebra::CoefficientWrong { .. } => FormatError::new_err(message),
        _ => SeriesError::new_err(message),
    }
}
