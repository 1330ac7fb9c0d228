//! A Birkhoff normal form with exact numbers or with floats.

use andoyer_series::progress::Progress;
use andoyer_series::real_field::RealField;
use andoyer_series::{BirkhoffNormalForm as Inner, Error as Algebra, Polynomial};
use num_rational::BigRational;
use pyo3::prelude::*;

use crate::progress;

/// A normal form with exact numbers or with floats.
#[derive(PartialEq)]
pub(crate) enum Form {
    Exact(Inner<BigRational>),
    Float(Inner<f64>),
}

impl Form {
    /// Reads the JSON of either kind, and computes it anew.
    pub(crate) fn from_json(text: &str, progress: &mut Progress<'_>) -> Result<Self, Algebra> {
        match Inner::<BigRational>::from_json_with(text, progress) {
            Err(Algebra::FormatUnknown { .. }) => Inner::<f64>::from_json_with(text, progress).map(Form::Float),
            result => result.map(Form::Exact),
        }
    }

    /// Reads the JSON of a pickle.
    pub(crate) fn restored(text: &str) -> Result<Self, Algebra> {
        match Inner::<BigRational>::from_json_unverified(text) {
            Err(Algebra::FormatUnknown { .. }) => Inner::<f64>::from_json_unverified(text).map(Form::Float),
            result => result.map(Form::Exact),
        }
    }
}

/// One expression for both kinds of numbers.
macro_rules! either {
    ($form:expr, $inner:ident => $result:expr) => {
        match $form {
            $crate::form::Form::Exact($inner) => $result,
            $crate::form::Form::Float($inner) => $result,
        }
    };
}
pub(crate) use either;

/// Exact coefficients as floats.
pub(crate) fn rounded(polynomial: &Polynomial<BigRational>) -> Polynomial<f64> {
    polynomial.map(RealField::to_float)
}

/// A function expressed in the variables of the other side.
pub(crate) fn transformed<R: RealField>(
    py: Python<'_>,
    form: &Inner<R>,
    f: &Polynomial<R>,
    direct: bool,
) -> PyResult<Polynomial<R>> {
    progress::reported(py, None, |tell| if direct { form.direct_with(f, tell) } else { form.inverse_with(f, tell) })
}
