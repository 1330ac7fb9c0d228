//! Conversion of array-likes to float64 slices, and results that are written directly into NumPy arrays.
//!
//! Numbers are integers and floats of NumPy, and objects with `__float__`. Strings, booleans and complex numbers are a
//! `TypeError`. A scalar time gives results without the leading axis. An array that is float64, aligned and in C order is not copied.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Error as Propagation;
use numpy::{
    Element, IntoPyArray, PyArray1, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn,
    PyReadwriteArrayDyn, PyUntypedArray, PyUntypedArrayMethods, dtype,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PySlice, PyTuple};

use crate::computing::{detached, interruptible};
use crate::error;
use crate::foreign::{self, Calendar};

/// Number of doubles in 128 KiB. For larger blocks glibc requests memory from the system.
const FEWEST_SHARED: usize = 16_384;

/// `value` as a float64 array, aligned and in C order.
fn numbers<'py>(argument: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
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
        values.push(item?.extract::<f64>().map_err(refused)?);
    }
    values.into_pyarray(array.py()).reshape(array.shape())
}

fn in_use(argument: &str) -> PyErr {
    let message = format!("{argument} shares memory with an array that is in use");
    error::input(argument, "an array in use", "an array that is not in use", message)
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

/// N numbers for each member of an ensemble: an array_like of shape (m, N), or (N,) for all members.
pub(crate) enum MemberRows<const N: usize> {
    One([f64; N]),
    Many(Vec<[f64; N]>),
}

impl<const N: usize> MemberRows<N> {
    pub(crate) fn new(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let array = numbers(argument, value)?;
        let values = read(argument, &array)?;
        match (array.shape(), values.as_slice()?.as_chunks().0) {
            (&[n], &[row]) if n == N => Ok(Self::One(row)),
            (&[_, n], rows) if n == N => Ok(Self::Many(rows.to_vec())),
            (&[0], _) => {
                let text = format!("{argument} is empty: it must be (m, {N}) or ({N},), and for no members (0, {N})");
                Err(error::input(argument, &[0_i64][..], format!("(m, {N}) or ({N},)"), text))
            }
            (shape, _) => Err(error::shape(argument, shape, &format!("(m, {N}) or ({N},)"))),
        }
    }

    /// The number of rows, or None if a single row is used for all members.
    pub(crate) fn members(&self) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Many(rows) => Some(rows.len()),
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

    /// All rows, or the single row repeated `members` times.
    pub(crate) fn repeated(self, members: usize) -> Vec<[f64; N]> {
        match self {
            Self::One(row) => vec![row; members],
            Self::Many(rows) => rows,
        }
    }
}

/// `value` as one number or one axis of numbers.
pub(crate) fn numbers_of(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = numbers(argument, value)?;
    if array.ndim() > 1 {
        return Err(error::shape(argument, array.shape(), "() or (m,)"));
    }
    Ok(read(argument, &array)?.as_slice()?.to_vec())
}

/// `value` as `length` numbers.
pub(crate) fn fixed_length(argument: &str, value: &Bound<'_, PyAny>, length: usize) -> PyResult<Vec<f64>> {
    let array = numbers(argument, value)?;
    if array.shape() != [length] {
        return Err(error::shape(argument, array.shape(), &format!("({length},)")));
    }
    Ok(read(argument, &array)?.as_slice()?.to_vec())
}

/// `value` as N numbers.
pub(crate) fn fixed<const N: usize>(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; N]> {
    let array = numbers(argument, value)?;
    let wrong = || error::shape(argument, array.shape(), &format!("({N},)"));
    if array.shape() != [N] {
        return Err(wrong());
    }
    read(argument, &array)?.as_slice()?.try_into().map_err(|_| wrong())
}

/// First and last time of a span, for a state at an epoch.
pub(crate) fn span(value: &Bound<'_, PyAny>, epoch: f64, calendar: Option<Calendar>) -> PyResult<[f64; 2]> {
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
        (shape, _) => Err(error::shape(argument, shape, "(3,) or (2,)")),
    }
}

/// True if `value` is an array_like of shape (3, 3).
pub(crate) fn is_matrix(value: &Bound<'_, PyAny>) -> bool {
    numbers("moments", value).is_ok_and(|array| array.shape() == [3, 3])
}

/// `value` as a 3 × 3 matrix, row by row.
pub(crate) fn matrix(argument: &str, value: &Bound<'_, PyAny>) -> PyResult<[[f64; 3]; 3]> {
    let array = numbers(argument, value)?;
    let wrong = || error::shape(argument, array.shape(), "(3, 3)");
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
            return Err(error::shape(argument, array.shape(), &format!("({columns},) or (m, {columns})")));
        }
        Ok(Self { array: read(argument, &array)?, columns })
    }

    /// The result of `evaluate` for each row, `columns` numbers, computed without the interpreter lock.
    pub(crate) fn map(
        &self,
        columns: usize,
        evaluate: impl Fn(&[f64]) -> Result<Vec<f64>, andoyer_series::Error> + Sync,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (py, values, width) = (self.array.py(), self.array.as_slice()?, self.columns);
        let rows = row_by_row(py, values, width, |values| values.chunks(width).map(&evaluate).collect())?;
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

/// Number of times of a motion above which an evaluation counts as a long call; it takes 1 to 200 ms.
const LONG: usize = 1 << 19;
/// The same number under a gravity gradient; it takes 3 to 20 ms.
const LONG_DISTURBED: usize = 1 << 14;
/// Number of members of an ensemble above which solving counts as a long call; it takes 20 ms.
const LONG_MEMBERS: usize = 1 << 12;
/// The same number under a gravity gradient, with 0.2 to 0.3 ms for each member.
const LONG_DISTURBED_MEMBERS: usize = 32;

/// Times: a scalar or one axis; for an ensemble also one row for each member.
pub(crate) struct Times<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
    members: Option<usize>,
    /// Axes of the result before its last.
    leading: Vec<usize>,
    /// Times of another package as given; the numbers are then seconds since the epoch.
    given: Option<Bound<'py, PyAny>>,
    disturbed: bool,
}

impl<'py> Times<'py> {
    /// Times of a motion.
    pub(crate) fn new(value: &Bound<'py, PyAny>, epoch: Option<Calendar>, disturbed: bool) -> PyResult<Self> {
        let (array, given, shape) = Self::read(value, epoch.as_slice())?;
        if shape.len() > 1 {
            return Err(error::shape("times", &shape, "() or (n,)"));
        }
        Ok(Self { array: read("times", &array)?, members: None, leading: shape, given, disturbed })
    }

    /// The numbers, the times of another package if such times were given, and the shape as given.
    #[expect(clippy::type_complexity, reason = "taken apart at once")]
    fn read(
        value: &Bound<'py, PyAny>,
        epochs: &[Calendar],
    ) -> PyResult<(Bound<'py, PyArrayDyn<f64>>, Option<Bound<'py, PyAny>>, Vec<usize>)> {
        if let Some((seconds, given, shape)) = foreign::since("times", value, epochs)? {
            return Ok((numbers("times", &seconds)?, Some(given), shape));
        }
        let array = numbers("times", value)?;
        let shape = array.shape().to_vec();
        Ok((array, None, shape))
    }

    /// Times of an ensemble.
    pub(crate) fn of_members(
        value: &Bound<'py, PyAny>,
        members: usize,
        epochs: &[Calendar],
        disturbed: bool,
    ) -> PyResult<Self> {
        let (array, given, shape) = Self::read(value, epochs)?;
        if !matches!(shape[..], [] | [_]) && !matches!(shape[..], [m, _] if m == members) {
            return Err(error::shape("times", &shape, &format!("(), (n,) or ({members}, n)")));
        }
        let leading = if shape.len() < 2 { std::iter::once(members).chain(shape).collect() } else { shape };
        Ok(Self { array: read("times", &array)?, members: Some(members), leading, given, disturbed })
    }

    /// True if the numbers are seconds since the epoch.
    pub(crate) fn since_epoch(&self) -> bool {
        self.given.is_some()
    }

    /// The times of another package as given.
    pub(crate) fn given(&self) -> Option<Py<PyAny>> {
        self.given.clone().map(Bound::unbind)
    }

    /// The same for derivatives, which take some microseconds for each time.
    pub(crate) fn long_partials(&self) -> bool {
        self.array.len() > LONG_DISTURBED
    }

    /// True if the evaluation at these times may be a long call, which Ctrl-C must end.
    pub(crate) fn long(&self) -> bool {
        let (times, members) =
            if self.disturbed { (LONG_DISTURBED, LONG_DISTURBED_MEMBERS) } else { (LONG, LONG_MEMBERS) };
        self.leading.iter().product::<usize>() >= times || self.members.is_some_and(|count| count >= members)
    }

    pub(crate) fn values(&self) -> PyResult<&[f64]> {
        Ok(self.array.as_slice()?)
    }

    /// A copy of the times, and arrays to be filled with four and with three numbers for each.
    pub(crate) fn samples(&self) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 3]> {
        self.with_outputs([&[4], &[3]])
    }

    /// A copy of the times, and two arrays to be filled with three rows of `columns` numbers for each.
    pub(crate) fn matrices(&self, columns: usize) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 3]> {
        self.with_outputs([&[3, columns], &[3, columns]])
    }

    /// A copy of the times, and two arrays to be filled, of these shapes for each time.
    ///
    /// For many times the arrays share one block of memory. Three blocks would be returned to the system after each call, and the page faults of the next call
    /// would take 25 ns a sample for 100,000 samples; with one block it is 1.0 ns.
    fn with_outputs(&self, [first, second]: [&[usize]; 2]) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 3]> {
        let shapes = [self.array.shape().to_vec(), self.shape(first), self.shape(second)];
        let numbers = shapes.iter().map(|shape| shape.iter().product::<usize>()).sum::<usize>();
        let arrays = if numbers < FEWEST_SHARED {
            [self.empty(&shapes[0])?, self.empty(&shapes[1])?, self.empty(&shapes[2])?]
        } else {
            self.shared(&shapes)?
        };
        arrays[0].readwrite().as_slice_mut()?.copy_from_slice(self.values()?);
        Ok(arrays)
    }

    /// Arrays of these shapes in one block.
    fn shared(&self, shapes: &[Vec<usize>; 3]) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 3]> {
        let py = self.array.py();
        let sizes: [usize; 3] = std::array::from_fn(|index| shapes[index].iter().product());
        let block = self.empty(&[sizes.iter().sum::<usize>()])?;
        let part = |start: usize, index: usize| -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
            let range = PySlice::new(py, start as isize, (start + sizes[index]) as isize, 1);
            block.get_item(range)?.cast_into::<PyArrayDyn<f64>>()?.reshape(shapes[index].as_slice())
        };
        Ok([part(0, 0)?, part(sizes[0], 1)?, part(sizes[0] + sizes[1], 2)?])
    }

    /// An uninitialized array to be filled; writing zeros first would write it twice.
    fn empty(&self, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let py = self.array.py();
        let shape = PyTuple::new(py, shape)?;
        Ok(EMPTY.import(py, "numpy", "empty")?.call1((shape,))?.cast_into()?)
    }

    /// An array to be filled with N numbers for each time.
    pub(crate) fn rows(&self, n: usize) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.empty(&self.shape(&[n]))
    }

    fn shape(&self, last: &[usize]) -> Vec<usize> {
        self.leading.iter().chain(last).copied().collect()
    }

    /// N numbers for each time, computed by `evaluate` without the interpreter lock, into `out` or a new array.
    pub(crate) fn evaluate<const N: usize, T: Send>(
        &self,
        out: Option<&Bound<'py, PyAny>>,
        evaluate: impl FnOnce(&[f64], &mut [[f64; N]], &AtomicBool) -> Result<T, Propagation> + Send,
    ) -> PyResult<(Bound<'py, PyArrayDyn<f64>>, T)> {
        let result = match out {
            Some(out) => output(out, &self.shape(&[N]))?,
            None => self.rows(N)?,
        };
        let mut rows = write(&result)?;
        let (times, rows) = (self.values()?, chunks(&mut rows)?);
        let evaluate = |stop: &AtomicBool| evaluate(times, rows, stop);
        let told = interruptible(self.array.py(), self.long(), error::propagation, evaluate)?;
        Ok((result, told))
    }
}

/// `out`, checked to be an array for results of this shape.
fn output<'py>(out: &Bound<'py, PyAny>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let Ok(array) = out.cast::<PyUntypedArray>() else {
        return Err(PyTypeError::new_err(format!("out must be a NumPy array, not {}", out.get_type().name()?)));
    };
    if !array.dtype().is_equiv_to(&f64::get_dtype(out.py())) {
        return Err(PyTypeError::new_err(format!("out has dtype {}: it must be float64", array.dtype())));
    }
    if array.shape() != shape {
        return Err(error::shape("out", array.shape(), &error::shape_text(shape)));
    }
    if !array.is_c_contiguous() {
        let message = "out is strided: it must be C-contiguous".to_owned();
        return Err(error::input("out", "strided", "C-contiguous", message));
    }
    Ok(out.cast::<PyArrayDyn<f64>>()?.clone())
}

/// Borrows an array for writing.
pub(crate) fn write<'py>(array: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<PyReadwriteArrayDyn<'py, f64>> {
    array.try_readwrite().map_err(|problem| match problem {
        numpy::BorrowError::NotWriteable => PyTypeError::new_err("out is read-only: it must be writeable"),
        _ => in_use("out"),
    })
}

/// Matrices of three rows of N numbers.
pub(crate) fn matrices<'a, const N: usize>(
    array: &'a mut PyReadwriteArrayDyn<'_, f64>,
) -> PyResult<&'a mut [[[f64; N]; 3]]> {
    Ok(chunks(array)?.as_chunks_mut().0)
}

/// Rows of N numbers.
pub(crate) fn chunks<'a, const N: usize>(array: &'a mut PyReadwriteArrayDyn<'_, f64>) -> PyResult<&'a mut [[f64; N]]> {
    Ok(array.as_slice_mut()?.as_chunks_mut().0)
}
