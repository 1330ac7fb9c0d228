//! Times as they are given, and new arrays for what is computed at them.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Error as Propagation;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PySlice, PyTuple};

use super::output::{chunks, output, write};
use super::{numbers, read};
use crate::computing::interruptible;
use crate::error;
use crate::foreign::{self, Calendar};

/// Numbers that fill 128 KiB. From this size on glibc asks the system for memory.
const FEWEST_SHARED: usize = 16_384;
/// From this size on a call of `numpy.empty` takes less time than zeros.
const FEWEST_UNINITIALIZED: usize = 512;
/// Number of times of a motion above which an evaluation counts as a long call, which Ctrl-C can stop.
const LONG: usize = 1 << 19;
/// The same number for derivatives in closed form. With 16,384 times the thread of a long call added a quarter to the time.
const LONG_PARTIALS: usize = 1 << 18;
/// The same number under a gravity gradient.
const LONG_DISTURBED: usize = 1 << 14;
/// Number of members of an ensemble above which solving counts as a long call.
const LONG_MEMBERS: usize = 1 << 12;
/// The same number under a gravity gradient.
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

    /// The exception for an axis of times where one time is required.
    pub(crate) fn scalar(&self, argument: &str) -> PyErr {
        PyTypeError::new_err(format!("{argument} must be one time, not an array of shape {:?}", self.leading))
    }

    /// True if the numbers are seconds since the epoch.
    pub(crate) fn since_epoch(&self) -> bool {
        self.given.is_some()
    }

    /// The times of another package as given.
    pub(crate) fn given(&self) -> Option<Py<PyAny>> {
        self.given.clone().map(Bound::unbind)
    }

    /// True if derivatives at these times may be a long call. Under a torque one time suffices: the way to it from the epoch is integrated.
    pub(crate) fn long_partials(&self) -> bool {
        self.disturbed || self.leading.iter().product::<usize>() >= LONG_PARTIALS || self.long()
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
    /// would take longer than the samples; with one block they take a fraction of that.
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

    /// An array to be filled. A large one is not initialized: writing zeros first would write it twice.
    fn empty(&self, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let py = self.array.py();
        if shape.iter().product::<usize>() < FEWEST_UNINITIALIZED {
            return Ok(PyArrayDyn::zeros(py, shape, false));
        }
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
