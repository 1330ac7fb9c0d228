//! Open files with their segments, in the order of loading.

use std::collections::BTreeMap;
use std::path::Path;

use crate::daf::Kind;
use crate::read::daf::{DafFile, Source};
use crate::read::error::{Gap, ReadError};
use crate::read::segment::{Segment, Stored};

pub(super) struct Files {
    kind: Kind,
    files: Vec<DafFile>,
    segments: Vec<Stored>,
    /// The numbers of the segments of each body.
    bodies: BTreeMap<i32, Vec<usize>>,
}

impl std::fmt::Debug for Files {
    /// The segments: the files are long.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.segments.iter().map(|stored| &stored.segment)).finish()
    }
}

impl Files {
    pub(super) fn open<P: AsRef<Path>>(paths: &[P], kind: Kind) -> Result<Self, ReadError> {
        let mut files = Self { kind, files: Vec::new(), segments: Vec::new(), bodies: BTreeMap::new() };
        for path in paths {
            let (file, summaries) = DafFile::open(path.as_ref(), kind)?;
            files.add(file, summaries)?;
        }
        Ok(files)
    }

    /// Adds a source; its segments come before those of earlier files.
    pub(super) fn load(&mut self, name: &str, source: Box<dyn Source>) -> Result<(), ReadError> {
        let (file, summaries) = DafFile::new(name.to_owned(), source, self.kind)?;
        self.add(file, summaries)
    }

    fn add(&mut self, file: DafFile, summaries: Vec<crate::read::daf::Summary>) -> Result<(), ReadError> {
        let stored = summaries.into_iter().enumerate();
        let stored = stored.map(|(place, summary)| Stored::new(self.files.len(), &file, place + 1, summary));
        for stored in stored.collect::<Result<Vec<_>, _>>()? {
            self.bodies.entry(stored.segment.body).or_default().push(self.segments.len());
            self.segments.push(stored);
        }
        self.files.push(file);
        Ok(())
    }

    pub(super) fn segments(&self) -> impl Iterator<Item = &Segment> {
        self.segments.iter().map(|stored| &stored.segment)
    }

    fn of(&self, body: i32) -> impl DoubleEndedIterator<Item = &Stored> {
        self.bodies.get(&body).into_iter().flatten().map(|&place| &self.segments[place])
    }

    /// The segment for a time: among those that cover it the last one of the file that was loaded last.
    pub(super) fn find(&self, body: i32, et: f64) -> Option<&Stored> {
        self.of(body).rev().find(|stored| stored.covers(et))
    }

    /// Three values and their rates, in the frame of the segment.
    pub(super) fn at(&self, stored: &Stored, et: f64) -> Result<[[f64; 3]; 2], ReadError> {
        stored.at(&self.files[stored.file], et)
    }

    /// Reads the data of a body for a span and keeps them.
    pub(super) fn keep(&self, body: i32, (start, end): (f64, f64)) -> Result<(), ReadError> {
        self.of(body).try_for_each(|stored| {
            let (first, last) = stored.segment.span;
            let span = [start.max(first), end.min(last)];
            if span[0] <= span[1] { stored.keep(&self.files[stored.file], span) } else { Ok(()) }
        })
    }

    /// The intervals that are covered, in order; those that touch are one.
    pub(super) fn coverage(&self, body: i32) -> Vec<(f64, f64)> {
        let mut spans: Vec<(f64, f64)> = self.of(body).map(|stored| stored.segment.span).collect();
        spans.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut merged: Vec<(f64, f64)> = Vec::new();
        for span in spans {
            match merged.last_mut() {
                Some(last) if span.0 <= last.1 => last.1 = last.1.max(span.1),
                _ => merged.push(span),
            }
        }
        merged
    }

    /// What is covered before and after a time that is not.
    pub(super) fn gap(&self, body: i32, et: f64) -> Gap {
        let spans = self.coverage(body);
        let place = spans.partition_point(|span| span.0 < et);
        Gap { body, before: place.checked_sub(1).map(|place| spans[place]), after: spans.get(place).copied() }
    }
}
