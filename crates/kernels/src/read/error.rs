//! Errors of reading.

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::io;

/// A kernel that cannot be read, or a time that it does not cover.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReadError {
    /// The system cannot open or read a file.
    System {
        /// The file.
        file: String,
        /// The kind of the system's error.
        kind: io::ErrorKind,
        /// Its text.
        message: String,
    },
    /// A file is of another kind.
    OtherKind {
        /// The file.
        file: String,
        /// What its file record says.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// A file contradicts itself: it is cut off or damaged.
    Damaged {
        /// The file.
        file: String,
        /// The segment by its number from 1; 0 for the file itself.
        segment: usize,
        /// What is wrong.
        item: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// A segment has a type or a frame that this reader does not know.
    Unsupported {
        /// The file.
        file: String,
        /// The segment by its number from 1.
        segment: usize,
        /// "data type" or "frame".
        item: &'static str,
        /// Its code.
        code: i32,
        /// What is read.
        supported: &'static str,
    },
    /// No segments cover a time.
    NotCovered {
        /// The body, or the class ID of the body's frame.
        target: i32,
        /// The observer of an ephemeris.
        observer: Option<i32>,
        /// The time \[s of TDB past J2000\].
        et: f64,
        /// Bodies without data at this time, where the chains of centres end: at most one for the target and one for the observer.
        gaps: Vec<Gap>,
    },
    /// A time that is not finite.
    Time {
        /// The time.
        et: String,
    },
}

/// A body without data at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The body.
    pub body: i32,
    /// The last covered interval before the time \[s of TDB past J2000\].
    pub before: Option<(f64, f64)>,
    /// The first covered interval after it.
    pub after: Option<(f64, f64)>,
}

impl Display for Gap {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} has ", self.body)?;
        match (self.before, self.after) {
            (None, None) => write!(f, "no segment"),
            (Some((start, end)), None) | (None, Some((start, end))) => write!(f, "data from {start} to {end} s"),
            (Some((start, end)), Some((next, last))) => {
                write!(f, "data from {start} to {end} s and from {next} to {last} s")
            }
        }
    }
}

impl Display for ReadError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::System { file, message, .. } => write!(f, "{file} cannot be read: {message}"),
            Self::OtherKind { file, found, expected } => write!(f, "{file} must be {expected}: got {found:?}"),
            Self::Damaged { file, segment, item, value, allowed } => {
                write!(f, "{file}{} is damaged: {item} must be {allowed}: got {value}", Number(*segment))
            }
            Self::Unsupported { file, segment, item, code, supported } => {
                write!(f, "{file}{}: {item} must be {supported}: got {code}", Number(*segment))
            }
            Self::NotCovered { target, observer, et, gaps } => {
                write!(f, "no data for {target}")?;
                if let Some(observer) = observer {
                    write!(f, " seen from {observer}")?;
                }
                write!(f, " at {et} s of TDB past J2000: ")?;
                if gaps.is_empty() {
                    return write!(f, "their centres do not meet");
                }
                gaps.iter().enumerate().try_for_each(
                    |(place, gap)| {
                        if place > 0 { write!(f, "; {gap}") } else { write!(f, "{gap}") }
                    },
                )
            }
            Self::Time { et } => write!(f, "et must be finite: got {et}"),
        }
    }
}

/// A segment in a message.
struct Number(usize);

impl Display for Number {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.0 > 0 { write!(f, ", segment {}", self.0) } else { Ok(()) }
    }
}

impl Error for ReadError {}

/// The error for a time that is not finite.
pub(super) fn finite(et: f64) -> Result<(), ReadError> {
    if et.is_finite() { Ok(()) } else { Err(ReadError::Time { et: et.to_string() }) }
}
