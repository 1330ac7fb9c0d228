//! Positions and velocities from SPK files.

use std::path::Path;

use crate::daf::SPK;
use crate::read::daf::Source;
use crate::read::error::{Gap, ReadError, finite};
use crate::read::files::Files;
use crate::read::segment::{Segment, turned};

/// The barycentre of the solar system, where chains of centres end.
const BARYCENTER: i32 = 0;
/// The most bodies of a chain of centres, as in CSPICE.
const LONGEST: usize = 20;

type State = [[f64; 3]; 2];

/// Ephemerides of bodies from SPK files with segments of types 2, 3, 9 and 13, of either byte order.
///
/// A file is opened by its summaries; its data are read when a time needs them. Any number of threads may ask for states at the same time.
pub struct Ephemeris(Files);

impl Ephemeris {
    /// Opens files. Where segments overlap, the last segment of the last file wins, as in CSPICE.
    ///
    /// # Errors
    /// - [`ReadError::System`] for a file that cannot be opened or read.
    /// - [`ReadError::OtherKind`] for a file that is no SPK file.
    /// - [`ReadError::Damaged`] for a file record or summaries that contradict the file.
    pub fn open<P: AsRef<Path>>(paths: &[P]) -> Result<Self, ReadError> {
        Files::open(paths, SPK).map(Self)
    }

    /// Adds an open file, or bytes in a [`std::io::Cursor`]. The name is for messages.
    ///
    /// # Errors
    /// As for [`open`](Self::open).
    pub fn load(&mut self, name: &str, source: impl Source + 'static) -> Result<(), ReadError> {
        self.0.load(name, Box::new(source))
    }

    /// The segments in the order of loading.
    pub fn segments(&self) -> impl Iterator<Item = &Segment> {
        self.0.segments()
    }

    /// The intervals for which there are data of a body against its centre \[s of TDB past J2000\], in order. Intervals that touch are one.
    pub fn coverage(&self, target: i32) -> Vec<(f64, f64)> {
        self.0.coverage(target)
    }

    /// Reads the data of a body for a span \[s of TDB past J2000\] at once and keeps them, for many times in any order. The first time outside the span drops them.
    ///
    /// # Errors
    /// As for [`Self::state`], but for times that are not covered.
    pub fn keep(&self, body: i32, span: (f64, f64)) -> Result<(), ReadError> {
        self.0.keep(body, span)
    }

    /// Position \[km\] and velocity \[km/s\] of a body seen from another one, without light time, in J2000.
    ///
    /// `et`: seconds of TDB past J2000. The chains of centres of both bodies are followed to the first common body.
    ///
    /// # Errors
    /// - [`ReadError::Time`] for a time that is not finite.
    /// - [`ReadError::NotCovered`] if the chains do not meet at this time, with the bodies without data and the intervals around the time.
    /// - [`ReadError::Unsupported`] for a segment of another type or with a frame that is not inertial.
    /// - [`ReadError::Damaged`], [`ReadError::System`] for data that cannot be read.
    pub fn state(&self, target: i32, observer: i32, et: f64) -> Result<([f64; 3], [f64; 3]), ReadError> {
        finite(et)?;
        let mut gaps = Vec::new();
        let mut chain = vec![(target, State::default())];
        while let Some(&link) = chain.last().filter(|link| chain.len() < LONGEST && link.0 != observer) {
            match self.next(link, et, &mut gaps)? {
                Some(next) => chain.push(next),
                None => break,
            }
        }
        let mut link = (observer, State::default());
        for _ in 0..LONGEST {
            if let Some((_, [position, velocity])) = chain.iter().find(|(body, _)| *body == link.0) {
                let difference = |one: &[f64; 3], other: &[f64; 3]| std::array::from_fn(|k| one[k] - other[k]);
                return Ok((difference(position, &link.1[0]), difference(velocity, &link.1[1])));
            }
            match self.next(link, et, &mut gaps)? {
                Some(next) => link = next,
                None => break,
            }
        }
        gaps.dedup();
        Err(ReadError::NotCovered { target, observer: Some(observer), et, gaps })
    }

    /// The next body of a chain of centres, with the sum of the states up to it. The barycentre has none; for a body without data there is one more gap.
    fn next(&self, (body, sum): (i32, State), et: f64, gaps: &mut Vec<Gap>) -> Result<Option<(i32, State)>, ReadError> {
        if body == BARYCENTER {
            return Ok(None);
        }
        let Some(stored) = self.0.find(body, et) else {
            gaps.push(self.0.gap(body, et));
            return Ok(None);
        };
        let mut state = self.0.at(stored, et)?;
        if let Some(turn) = stored.turn {
            state = state.map(|vector| turned(&turn, vector));
        }
        let sum = std::array::from_fn(|part| std::array::from_fn(|k| sum[part][k] + state[part][k]));
        // The files of an ephemeris have six integers in a summary, and the second is the centre.
        Ok(stored.segment.center.map(|center| (center, sum)))
    }
}
