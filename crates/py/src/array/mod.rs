//! Conversion of array-likes to float64 slices, and results that are written directly into NumPy arrays.
//!
//! Numbers are integers and floats of NumPy, and objects with `__float__`. Strings, booleans and complex numbers are a
//! `TypeError`. A scalar time gives results without the leading axis. An array that is float64, aligned and in C order is not copied.

use numpy::{
    IntoPyArray, PyArray1, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods, dtype,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;

use crate::computing::detached;
use crate::error;
use crate::foreign::{self, Calendar};

mod output;
mod times;

use output::in_use;
pub(crate) use output::{chunks, matrices, write};
pub(crate) use times::Times;

/// `value` as a float64 array, aligned and in C order.
pub(crate) fn numbers<'py>(argument: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    // The code below would return such an array unchanged, but takes as long as some tens of samples.
    if value.is_exact_instance_of::<PyUntypedArray>()
        && let Ok(array) = value.cast::<PyArrayDyn<f64>>()
        && array.is_c_contiguous()
        && array.data().is_aligned()
    {
        return Ok(array.clone());
    }
    let py = value.py();
    let value = foreign::plain(argument, value)?;
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy.getattr(intern!(py, "asarray"))?.call1((value,)).map_err(|problem| {
        // The error of NumPy for nested lists of unequal length.
        let ragged = problem.is_instance_of::<PyValueError>(py);
        if !ragged {
            return problem;
        }
        let said = problem.value(py).to_string();
        error::input(argument, said.as_str(), "rows of one length", format!("{argument}: {said}"))
    })?;
    let array = array.cast_into::<PyUntypedArray>()?;
    let kind = array.dtype();
    match kind.kind() {
        b'O' => objects(argument, &array),
        b'i' | b'u' | b'f' => {
            let require = numpy.getattr(intern!(py, "require"))?;
            Ok(require.call1((array, dtype::<f64>(py), ["C", "A"]))?.cast_into()?)
        }
        _ => {
            let other = || PyTypeError::new_err(format!("{argument} must hold real numbers, not {kind}"));
            Err(foreign::date(argument, &array).unwrap_or_else(other))
        }
    }
}

/// An array of Python objects as numbers, one by one. NumPy would convert None to NaN, and texts to numbers.
fn objects<'py>(argument: &str, array: &Bound<'py, PyUntypedArray>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let refused = |problem: PyErr| {
        let first = array.getattr("flat").and_then(|flat| flat.get_item(0)).ok();
        if let Some(date) = first.and_then(|first| foreign::date(argument, &first)) {
            return date;
        }
        let problem = problem.into_value(array.py());
        PyTypeError::new_err(format!("{argument} must hold real numbers: {problem}"))
    };
    let mut values = Vec::with_capacity(array.len());
    for item in array.getattr("flat")?.try_iter()? {
        let item = item?;
        // `float` of a quantity drops its unit.
        let item = if foreign::has_units(&item)? { foreign::plain(argument, &item)? } else { item };
        values.push(item.extract::<f64>().map_err(refused)?);
    }
    values.into_pyarray(array.py()).reshape(array.shape())
}

/// The exception for an array of a wrong shape. A single number is shown itself.
fn wrong_shape(argument: &str, array: &Bound<'_, PyArrayDyn<f64>>, bound: &str) -> PyErr {
    let number = read(argument, array).ok().filter(|_| array.ndim() == 0);
    match number.as_ref().and_then(|number| number.as_slice().ok()?.first()) {
        Some(number) => error::input(
            argument,
            *number,
            bound,
            format!("{argument} = {number} is one number: its shape must be {bound}"),
        ),
        None => error::shape(argument, array.shape(), bound),
    }
}

fn read<'py>(argument: &str, array: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    array.try_readonly().map_err(|_| in_use(argument))
}

/// `value` as one number.
pub(crate) fn number(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let refused = |cause: Option<PyErr>| {
        if let Some(date) = foreign::date(argument, value) {
            return date;
        }
        let shown = value.repr().map_or_else(|_| "what cannot be printed".to_owned(), |text| text.to_string());
        let error = PyTypeError::new_err(format!("{argument} must be a real number: got {shown}"));
        error.set_cause(value.py(), cause);
        error
    };
    let value = &foreign::plain(argument, value)?;
    let array = numbers(argument, value).map_err(|problem| refused(Some(problem)))?;
    match (array.ndim(), read(argument, &array)?.as_slice()?) {
        (0, &[number]) => Ok(number),
        _ => Err(refused(None)),
    }
}

/// N numbers for each member of an ensemble: an array_like of shape (m, N), or (N,) for all members. Instead of numbers there may be rows of a matrix.
pub(crate) enum MemberRows<const N: usize, Item = f64> {
    One([Item; N]),
    Many(Vec<[Item; N]>),
}

impl<const N: usize> MemberRows<N> {
    pub(crate) fn new(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::of_shape(argument, value, &format!("(m, {N}) or ({N},)"))
    }

    /// As [`MemberRows::new`], with what the error says that the shape must be.
    pub(crate) fn of_shape(argument: &str, value: &Bound<'_, PyAny>, bound: &str) -> PyResult<Self> {
        let array = numbers(argument, value)?;
        let values = read(argument, &array)?;
        match (array.shape(), values.as_slice()?.as_chunks().0) {
            (&[n], &[row]) if n == N => Ok(Self::One(row)),
            (&[_, n], rows) if n == N => Ok(Self::Many(rows.to_vec())),
            (&[0], _) => {
                let text = format!("{argument} is empty: it must be (m, {N}) or ({N},), and for no members (0, {N})");
                Err(error::input(argument, &[0_i64][..], format!("(m, {N}) or ({N},)"), text))
            }
            _ => Err(wrong_shape(argument, &array, bound)),
        }
    }

    /// Changes every row.
    pub(crate) fn each(&mut self, change: impl FnMut(&mut [f64; N])) {
        match self {
            Self::One(row) => std::slice::from_mut(row),
            Self::Many(rows) => rows.as_mut_slice(),
        }
        .iter_mut()
        .for_each(change);
    }
}

impl<const N: usize, Item: Copy> MemberRows<N, Item> {
    /// The number of rows, or None if a single row is used for all members.
    pub(crate) fn members(&self) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Many(rows) => Some(rows.len()),
        }
    }

    /// The single row, or all.
    pub(crate) fn rows(self) -> Vec<[Item; N]> {
        self.repeated(1)
    }

    /// All rows, or the single row repeated `members` times.
    pub(crate) fn repeated(self, members: usize) -> Vec<[Item; N]> {
        match self {
            Self::One(row) => vec![row; members],
            Self::Many(rows) => rows,
        }
    }
}

/// `value` as 3 × 3 matrices if it is an array_like of shape (m, 3, 3).
pub(crate) fn tensors(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<[[f64; 3]; 3]>>> {
    let array = numbers(argument, value)?;
    match array.shape() {
        &[_, 3, 3] => Ok(Some(read(argument, &array)?.as_slice()?.as_chunks().0.as_chunks().0.to_vec())),
        _ => Ok(None),
    }
}

/// `value` as one number or one axis of numbers.
pub(crate) fn numbers_of(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    shaped(argument, value).map(|(values, _)| values)
}

/// `value` as one number or one axis of numbers, with its shape.
pub(crate) fn shaped(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<usize>)> {
    let array = numbers(argument, value)?;
    if array.ndim() > 1 {
        return Err(error::shape(argument, array.shape(), "() or (m,)"));
    }
    Ok((read(argument, &array)?.as_slice()?.to_vec(), array.shape().to_vec()))
}

/// `value` as vectors: an array_like of shape (n, 3).
pub(crate) fn vectors(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; 3]>> {
    let array = numbers(argument, value)?;
    match array.shape() {
        &[_, 3] => Ok(read(argument, &array)?.as_slice()?.as_chunks().0.to_vec()),
        _ => Err(wrong_shape(argument, &array, "(n, 3)")),
    }
}

/// `value` as three rows of any length.
pub(crate) fn coefficients(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<[Vec<f64>; 3]> {
    let array = numbers(argument, value)?;
    match array.shape() {
        &[3, n] if n > 0 => {
            let values = read(argument, &array)?;
            let row = |axis: usize| -> PyResult<Vec<f64>> { Ok(values.as_slice()?[axis * n..(axis + 1) * n].to_vec()) };
            Ok([row(0)?, row(1)?, row(2)?])
        }
        _ => Err(wrong_shape(argument, &array, "(3, (d + 1)²)")),
    }
}

/// `value` as `length` numbers.
pub(crate) fn fixed_length(argument: &str, value: &Bound<'_, PyAny>, length: usize) -> PyResult<Vec<f64>> {
    let array = numbers(argument, value)?;
    if array.shape() != [length] {
        return Err(wrong_shape(argument, &array, &format!("({length},)")));
    }
    Ok(read(argument, &array)?.as_slice()?.to_vec())
}

/// `value` as N numbers.
pub(crate) fn fixed<const N: usize>(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; N]> {
    let array = numbers(argument, value)?;
    let wrong = || wrong_shape(argument, &array, &format!("({N},)"));
    if array.shape() != [N] {
        return Err(wrong());
    }
    read(argument, &array)?.as_slice()?.try_into().map_err(|_| wrong())
}

/// First and last time of a span, for a state at an epoch.
pub(crate) fn span(value: &Bound<'_, PyAny>, epoch: f64, calendar: Option<Calendar>) -> PyResult<[f64; 2]> {
    if let Some(seconds) = foreign::instants("span", value, calendar)? {
        return fixed("span", &seconds);
    }
    match foreign::since("span", value, calendar.as_slice())? {
        Some((seconds, ..)) => Ok(fixed("span", &seconds)?.map(|seconds: f64| epoch + seconds)),
        None => fixed("span", value),
    }
}

/// Two numbers or three.
pub(crate) enum TwoOrThree {
    Two([f64; 2]),
    Three([f64; 3]),
}

/// `value` as two numbers or three.
pub(crate) fn two_or_three(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<TwoOrThree> {
    let array = numbers(argument, value)?;
    match (array.shape(), read(argument, &array)?.as_slice()?) {
        (&[2], &[x, y]) => Ok(TwoOrThree::Two([x, y])),
        (&[3], &[x, y, z]) => Ok(TwoOrThree::Three([x, y, z])),
        _ => Err(wrong_shape(argument, &array, "(3,) or (2,)")),
    }
}

/// True if `value` is an array_like of shape (3, 3).
pub(crate) fn is_matrix(argument: &str, value: &Bound<'_, PyAny>) -> bool {
    numbers(argument, value).is_ok_and(|array| array.shape() == [3, 3])
}

/// `value` as a 3 × 3 matrix, row by row.
pub(crate) fn matrix(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<[[f64; 3]; 3]> {
    let array = numbers(argument, value)?;
    let wrong = || wrong_shape(argument, &array, "(3, 3)");
    if array.shape() != [3, 3] {
        return Err(wrong());
    }
    read(argument, &array)?.as_slice()?.as_chunks().0.try_into().map_err(|_| wrong())
}

/// Rows of `columns` numbers: an array_like of shape (`columns`,) or (m, `columns`).
pub(crate) struct Rows<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
    columns: usize,
}

impl<'py> Rows<'py> {
    pub(crate) fn new(argument: &str, value: &Bound<'py, PyAny>, columns: usize) -> PyResult<Self> {
        let array = numbers(argument, value)?;
        let fits = matches!(array.shape(), [n] | [_, n] if *n == columns);
        if !fits {
            return Err(wrong_shape(argument, &array, &format!("({columns},) or (m, {columns})")));
        }
        Ok(Self { array: read(argument, &array)?, columns })
    }

    /// The result of `evaluate` for each row, `columns` numbers, computed without the interpreter lock.
    pub(crate) fn map(
        &self,
        columns: usize,
        evaluate: impl Fn(&[f64]) -> Result<Vec<f64>, andoyer_series::Error> + Sync,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.map_at(columns, None, |row, _| evaluate(row))
    }

    /// As [`Rows::map`], with a time for each row: one number for all, as many numbers as rows, or 0.
    pub(crate) fn map_at(
        &self,
        columns: usize,
        time: Option<&Bound<'_, PyAny>>,
        evaluate: impl Fn(&[f64], f64) -> Result<Vec<f64>, andoyer_series::Error> + Sync,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (py, values, width) = (self.array.py(), self.array.as_slice()?, self.columns);
        let times = time.map_or(Ok(vec![0.0]), |time| numbers_of("time", time))?;
        let count = values.len() / width;
        if times.len() != 1 && times.len() != count {
            return Err(error::shape("time", &[times.len()], &format!("() or ({count},)")));
        }
        let timed: Vec<f64> = values
            .chunks(width)
            .zip(times.iter().cycle())
            .flat_map(|(row, &time)| row.iter().copied().chain([time]))
            .collect();
        let one = |row: &[f64]| evaluate(&row[..width], row[width]);
        let rows = row_by_row(py, &timed, width + 1, |rows| rows.chunks(width + 1).map(one).collect())?;
        let mut shape = self.array.shape().to_vec();
        shape[self.array.ndim() - 1] = columns; // one axis at least
        rows.concat().into_pyarray(py).reshape(shape)
    }
}

/// Number of rows between two checks for Ctrl-C; for long series a row takes some milliseconds.
const ROWS_AT_ONCE: usize = 64;

/// The results of `evaluate` for rows of `width` numbers, computed in parts without the interpreter lock. Ctrl-C is checked between the parts.
pub(crate) fn row_by_row(
    py: Python<'_>,
    values: &[f64],
    width: usize,
    evaluate: impl Fn(&[f64]) -> Result<Vec<Vec<f64>>, andoyer_series::Error> + Sync,
) -> PyResult<Vec<Vec<f64>>> {
    let mut rows = detached(py, error::algebra, || evaluate(&[]))?;
    for part in values.chunks(width * ROWS_AT_ONCE) {
        py.check_signals()?;
        rows.extend(detached(py, error::algebra, || evaluate(part))?);
    }
    Ok(rows)
}

/// N numbers as a read-only array.
pub(crate) fn constant<'py>(py: Python<'py>, values: &[f64]) -> Bound<'py, PyArray1<f64>> {
    let array = values.to_vec().into_pyarray(py);
    array.readwrite().make_nonwriteable();
    array
}

/// Rows of N numbers as a read-only array.
pub(crate) fn constant_rows<'py, const N: usize>(
    py: Python<'py>,
    rows: &[[f64; N]],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let array = rows.as_flattened().to_vec().into_pyarray(py).reshape(vec![rows.len(), N])?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}
