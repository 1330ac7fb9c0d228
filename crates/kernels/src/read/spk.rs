//! Positions and velocities from SPK files.

use std::path::Path;

use crate::daf::SPK;
use crate::read::daf::Source;
use crate::read::error::{Gap, ReadError, finite};
use crate::read::files::Files;
use crate::read::segment::{Segment, Stored, turned};

/// The barycentre of the solar system, where chains of centres end.
const BARYCENTER: i32 = 0;
/// The most bodies of a chain of centres, as in CSPICE.
const LONGEST: usize = 20;

type State = [[f64; 3]; 2];

/// Ephemerides of bodies from SPK files with segments of types 2, 3, 9 and 13, of either byte order.
///
/// A file is opened by its summaries; its data are read when a time needs them. Any number of threads may ask for states at the same time.
#[derive(Debug)]
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
        let one = self.chain(target, observer, et, &mut gaps);
        let other = self.chain(observer, target, et, &mut gaps);
        // The first body of the observer's chain that is in the target's chain too.
        let common = other
            .iter()
            .enumerate()
            .find_map(|(far, (body, _))| one.iter().position(|(other, _)| other == body).map(|near| (near, far)));
        let Some((near, far)) = common else {
            gaps.dedup();
            return Err(ReadError::NotCovered { target, observer: Some(observer), et, gaps });
        };
        let (one, other) = (self.sum(&one[..near], et)?, self.sum(&other[..far], et)?);
        let [position, velocity] = std::array::from_fn(|part| std::array::from_fn(|k| one[part][k] - other[part][k]));
        Ok((position, velocity))
    }

    /// A body and its centres up to `end`, to the barycentre or to a body without data, which is one more gap; each with its segment, but for the last.
    fn chain(&self, body: i32, end: i32, et: f64, gaps: &mut Vec<Gap>) -> Vec<(i32, Option<&Stored>)> {
        let mut chain = Vec::with_capacity(4);
        let mut body = body;
        while chain.len() < LONGEST && ![end, BARYCENTER].contains(&body) {
            let Some(stored) = self.0.find(body, et) else {
                gaps.push(self.0.gap(body, et));
                break;
            };
            chain.push((body, Some(stored)));
            body = stored.segment.center.unwrap_or(BARYCENTER);
        }
        chain.push((body, None));
        chain
    }

    /// The sum of the states of segments, in J2000.
    fn sum(&self, chain: &[(i32, Option<&Stored>)], et: f64) -> Result<State, ReadError> {
        chain.iter().filter_map(|(_, stored)| *stored).try_fold(State::default(), |sum, stored| {
            let mut state = self.0.at(stored, et)?;
            if let Some(turn) = &stored.turn {
                state = state.map(|vector| turned(turn, vector));
            }
            Ok(std::array::from_fn(|part| std::array::from_fn(|k| sum[part][k] + state[part][k])))
        })
    }
}
