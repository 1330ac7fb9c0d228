//! A segment of a file: what its summary says, and its values.

use std::sync::OnceLock;

use crate::frames;
use crate::read::chebyshev::Pieces;
use crate::read::daf::{DafFile, Summary};
use crate::read::error::ReadError;
use crate::read::states::States;
use crate::read::words::{Kept, Words};

/// What a file says of a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// The file.
    pub file: String,
    /// Its number in the file from 1.
    pub number: usize,
    /// Its name.
    pub name: String,
    /// The body, or the class ID of the body's frame.
    pub body: i32,
    /// The body that positions are measured from; `None` for orientations.
    pub center: Option<i32>,
    /// The code of the inertial frame ([`crate::frames::find`]).
    pub frame: i32,
    /// The type of the data.
    pub data_type: i32,
    /// The time that it covers \[s of TDB past J2000\].
    pub span: (f64, f64),
}

/// A segment with the way to its words.
pub(super) struct Stored {
    pub(super) segment: Segment,
    /// The number of the file.
    pub(super) file: usize,
    /// The matrix from the segment's frame to J2000, unless it is the identity.
    pub(super) turn: Option<[[f64; 3]; 3]>,
    addresses: [i32; 2],
    layout: OnceLock<Layout>,
    kept: Kept,
}

enum Layout {
    Pieces(Pieces),
    States(States),
}

impl Stored {
    /// A segment from its summary. An ephemeris has the centre among its integers, an orientation has not.
    pub(super) fn new(place: usize, file: &DafFile, number: usize, summary: Summary) -> Result<Self, ReadError> {
        let Summary { name, ends: [start, end], integers } = summary;
        let (center, rest) =
            if integers.len() == 6 { (Some(integers[1]), &integers[2..]) } else { (None, &integers[1..]) };
        if !(start <= end && start.is_finite() && end.is_finite()) {
            return Err(file.damaged(
                number,
                "the span",
                format!("{start} to {end}"),
                "finite, from the earlier time on",
            ));
        }
        let frame = rest[0];
        let turn = frames::from_j2000(frame);
        let identity = turn == frames::from_j2000(1);
        Ok(Self {
            segment: Segment {
                file: file.name.clone(),
                number,
                name,
                body: integers[0],
                center,
                frame,
                data_type: rest[1],
                span: (start, end),
            },
            file: place,
            turn: (!identity).then(|| std::array::from_fn(|row| std::array::from_fn(|column| turn[column][row]))),
            addresses: [rest[2], rest[3]],
            layout: OnceLock::new(),
            kept: Kept::default(),
        })
    }

    pub(super) fn covers(&self, et: f64) -> bool {
        self.segment.span.0 <= et && et <= self.segment.span.1
    }

    /// Three values and their rates, in the segment's frame.
    pub(super) fn at(&self, file: &DafFile, et: f64) -> Result<[[f64; 3]; 2], ReadError> {
        let words = self.words(file)?;
        let values = match self.layout(&words)? {
            Layout::Pieces(pieces) => pieces.at(&words, et),
            Layout::States(states) => states.at(&words, et),
        }?;
        if !values.as_flattened().iter().all(|value| value.is_finite()) {
            return Err(words.damaged("the values", format!("{values:?} at {et}"), "finite"));
        }
        Ok(values)
    }

    /// Reads the words for a span inside that of the segment.
    pub(super) fn keep(&self, file: &DafFile, span: [f64; 2]) -> Result<(), ReadError> {
        let words = self.words(file)?;
        match self.layout(&words)? {
            Layout::Pieces(pieces) => pieces.keep(&words, span),
            Layout::States(states) => states.keep(&words, span),
        }
    }

    /// The layout, which is read once.
    fn layout(&self, words: &Words<'_>) -> Result<&Layout, ReadError> {
        match self.layout.get() {
            Some(layout) => Ok(layout),
            None => {
                let layout = self.read_layout(words)?;
                Ok(self.layout.get_or_init(|| layout))
            }
        }
    }

    fn read_layout(&self, words: &Words<'_>) -> Result<Layout, ReadError> {
        let Segment { frame, data_type, center, .. } = self.segment;
        if !frames::is_inertial(frame) {
            return Err(self.unsupported("frame", frame, "an inertial frame of SPICE (1 to 21)"));
        }
        match (data_type, center) {
            (2, _) => Pieces::of(words, 3).map(Layout::Pieces),
            (3, Some(_)) => Pieces::of(words, 6).map(Layout::Pieces),
            (9 | 13, Some(_)) => States::of(words, data_type == 13).map(Layout::States),
            (_, Some(_)) => Err(self.unsupported("data type", data_type, "2, 3, 9 or 13")),
            (_, None) => Err(self.unsupported("data type", data_type, "2")),
        }
    }

    fn unsupported(&self, item: &'static str, code: i32, supported: &'static str) -> ReadError {
        let Segment { file, number, .. } = &self.segment;
        ReadError::Unsupported { file: file.clone(), segment: *number, item, code, supported }
    }

    fn words<'a>(&'a self, file: &'a DafFile) -> Result<Words<'a>, ReadError> {
        Words::new(file, self.segment.number, self.addresses, &self.kept)
    }
}

/// The product of a matrix and a vector.
pub(super) fn turned(matrix: &[[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2])
}
