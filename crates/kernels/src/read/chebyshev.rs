//! Segments of Chebyshev polynomials on intervals of one length: SPK types 2 and 3, PCK type 2.
//!
//! A record has the middle of its interval, half its length, and the coefficients of each component. The last four words are the start of the first interval, the length
//! of an interval, the words of a record, the number of records.

use crate::read::error::ReadError;
use crate::read::words::Words;

/// The words of a record before the coefficients, and of the segment after the records.
const HEAD: usize = 2;
const LAST: usize = 4;
/// The argument of the polynomials is from −1 to 1; a time at the border of two records may be beyond it by rounding.
const LARGEST_ARGUMENT: f64 = 1.0 + 1e-6;

/// How the words of a segment are divided.
pub(super) struct Pieces {
    start: f64,
    length: f64,
    record: usize,
    count: usize,
    components: usize,
}

impl Pieces {
    /// Reads the last words. `components`: 3 for types with positions alone, 6 for velocities too.
    pub(super) fn of(words: &Words<'_>, components: usize) -> Result<Self, ReadError> {
        let all = words.count();
        if all < LAST + HEAD + components {
            return Err(words.damaged("the number of words", all, format!("at least {}", LAST + HEAD + components)));
        }
        let [start, length, record, count] = words.array(all - LAST)?;
        if !(start.is_finite() && length.is_finite() && length > 0.0) {
            let value = format!("{start} and {length}");
            return Err(words.damaged("the start and the length of an interval", value, "finite, the length positive"));
        }
        let whole =
            |value: f64| (value.fract() == 0.0 && value >= 1.0 && value <= all as f64).then_some(value as usize);
        let parts =
            whole(record).zip(whole(count)).filter(|(record, count)| record.saturating_mul(*count) == all - LAST);
        let (record, count) = parts
            .filter(|(record, _)| *record > HEAD && (record - HEAD).is_multiple_of(components))
            .ok_or_else(|| {
                let allowed = format!("{} words together, {HEAD} and a multiple of {components} each", all - LAST);
                words.damaged("the size and number of records", format!("{record} and {count}"), allowed)
            })?;
        Ok(Self { start, length, record, count, components })
    }

    /// The number of the record for a time.
    fn number(&self, et: f64) -> usize {
        (((et - self.start) / self.length) as usize).min(self.count - 1)
    }

    /// Reads the records for a span.
    pub(super) fn keep(&self, words: &Words<'_>, span: [f64; 2]) -> Result<(), ReadError> {
        let [first, last] = span.map(|et| self.number(et));
        words.with(first * self.record, (last + 1 - first) * self.record, |_| ())
    }

    /// Three values and their rates at a time.
    pub(super) fn at(&self, words: &Words<'_>, et: f64) -> Result<[[f64; 3]; 2], ReadError> {
        words.with(self.number(et) * self.record, self.record, |record| {
            let (middle, radius) = (record[0], record[1]);
            let argument = (et - middle) / radius;
            if !(argument.abs() <= LARGEST_ARGUMENT && radius > 0.0) {
                let value = format!("{} to {}", middle - radius, middle + radius);
                return Err(words.damaged("the interval of a record", value, format!("around {et}")));
            }
            let coefficients = &record[HEAD..];
            Ok(if self.components == 3 {
                let (values, slopes) = series::<3>(coefficients, argument);
                [values, slopes.map(|slope| slope / radius)]
            } else {
                let ([x, y, z, u, v, w], _) = series::<6>(coefficients, argument);
                [[x, y, z], [u, v, w]]
            })
        })?
    }
}

/// Values of N series and their derivatives with respect to the argument, by Clenshaw's recurrence from the highest term on.
///
/// b_k = c_k + 2s b_{k+1} − b_{k+2}, f = c₀ + s b₁ − b₂; the derivative of each line is the line for f′.
#[inline]
fn series<const N: usize>(coefficients: &[f64], argument: f64) -> ([f64; N], [f64; N]) {
    let terms = coefficients.len() / N;
    let rows: [&[f64]; N] = std::array::from_fn(|row| &coefficients[row * terms..][..terms]);
    let twice = 2.0 * argument;
    let mut b = [[0.0; N]; 2];
    let mut slope = [[0.0; N]; 2];
    for term in (1..terms).rev() {
        for row in 0..N {
            let next = rows[row][term] + (twice * b[0][row] - b[1][row]);
            let steeper = 2.0 * b[0][row] + slope[0][row] * twice - slope[1][row];
            (b[1][row], b[0][row]) = (b[0][row], next);
            (slope[1][row], slope[0][row]) = (slope[0][row], steeper);
        }
    }
    let value = |row: usize| rows[row][0] + (argument * b[0][row] - b[1][row]);
    let derivative = |row: usize| b[0][row] + argument * slope[0][row] - slope[1][row];
    (std::array::from_fn(value), std::array::from_fn(derivative))
}
