//! Double precision array files of both byte orders: file record, summaries, words.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::daf::{CONTROL, DOUBLES, FIRST, Kind, MOST, NAME, ORDER, ORDERS, RECORD, SUMMARY, WORD};
use crate::read::error::ReadError;

/// The identity of files that were written before there were kinds.
const OLD: &[u8; 8] = b"NAIF/DAF";

/// Where the bytes of a kernel come from: a file, or `std::io::Cursor` for bytes in memory.
pub trait Source: Read + Seek + Send {}

impl<T: Read + Seek + Send> Source for T {}

/// The array of a segment: name, ends of its time, integers with the addresses of its first and last word.
pub(super) struct Summary {
    pub(super) name: String,
    pub(super) ends: [f64; 2],
    pub(super) integers: Vec<i32>,
}

/// An open file.
pub(super) struct DafFile {
    pub(super) name: String,
    source: Mutex<Box<dyn Source>>,
    big: bool,
    bytes: u64,
}

impl DafFile {
    /// Opens a file of this kind and reads its summaries.
    pub(super) fn open(path: &Path, kind: Kind) -> Result<(Self, Vec<Summary>), ReadError> {
        let name = path.display().to_string();
        let file = File::open(path).map_err(|error| system(&name, &error))?;
        Self::new(name, Box::new(file), kind)
    }

    /// The same from a source; the name is for messages.
    pub(super) fn new(
        name: String,
        mut source: Box<dyn Source>,
        kind: Kind,
    ) -> Result<(Self, Vec<Summary>), ReadError> {
        let bytes = source.seek(SeekFrom::End(0)).map_err(|error| system(&name, &error))?;
        let mut file = Self { name, source: Mutex::new(source), big: false, bytes };
        let record = file.bytes(0, RECORD)?;
        file.big = file.is_big(&record, kind)?;
        let summaries = file.summaries(file.integer(&record[FIRST..]), kind.1)?;
        Ok((file, summaries))
    }

    /// Whether the file is big-endian. Old files do not say it: there the number of doubles in a summary decides.
    fn is_big(&self, record: &[u8], (identity, integers): Kind) -> Result<bool, ReadError> {
        let counts = [DOUBLES, integers];
        let little = counts.map(u32::to_le_bytes);
        let big = counts.map(u32::to_be_bytes);
        let found = &record[8..16];
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim_end().to_owned();
        let other = |found: String| ReadError::OtherKind {
            file: self.name.clone(),
            found,
            expected: if integers == crate::daf::PCK.1 { "a binary PCK" } else { "an SPK file" },
        };
        if record[..8] != identity[..] && record[..8] != OLD[..] {
            return Err(other(text(&record[..8])));
        }
        let order = &record[ORDER..ORDER + WORD];
        let named = ORDERS.iter().position(|name| order == *name);
        if named.is_none() && record[..8] != OLD[..] {
            return Err(self.damaged(0, "the byte order", format!("{:?}", text(order)), "LTL-IEEE or BIG-IEEE"));
        }
        [little, big]
            .iter()
            .position(|counts| found == counts.as_flattened())
            .filter(|&order| named.is_none_or(|named| named == order))
            .map(|order| order == 1)
            .ok_or_else(|| match (&record[..8] == OLD, named) {
                (true, _) => other(format!("{} with summaries of {found:?}", text(OLD))),
                _ => self.damaged(0, "the size of a summary", format!("{found:?}"), format!("{counts:?}")),
            })
    }

    /// The chain of summaries from a record on, each record once.
    fn summaries(&self, first: i32, integers: u32) -> Result<Vec<Summary>, ReadError> {
        let mut summaries = Vec::new();
        let (mut next, mut visited) = (f64::from(first), BTreeSet::new());
        let records = self.bytes / RECORD as u64;
        while next != 0.0 {
            let inside = next >= 2.0 && next <= records as f64 && next.fract() == 0.0;
            if !inside || !visited.insert(next as u64) {
                let allowed = format!("2 to {records}, each once");
                return Err(self.damaged(0, "the number of a summary record", next, allowed));
            }
            let place = (next as u64 - 1) * RECORD as u64;
            let record = self.bytes(place, RECORD)?;
            let control: Vec<f64> = record[..CONTROL * WORD].chunks(WORD).map(|word| self.double(word)).collect();
            let count = control[2];
            if !(0.0..=MOST as f64).contains(&count) || count.fract() != 0.0 {
                return Err(self.damaged(0, "the number of summaries in a record", count, format!("0 to {MOST}")));
            }
            // After 25 segments CSPICE begins a record of summaries, and the record of names behind it comes with the next segment.
            let names = if count > 0.0 { self.bytes(place + RECORD as u64, RECORD)? } else { Vec::new() };
            let parts = record[CONTROL * WORD..].chunks(SUMMARY * WORD).zip(names.chunks(NAME));
            summaries.extend(parts.take(count as usize).map(|(part, name)| Summary {
                name: String::from_utf8_lossy(name).trim_end_matches([' ', '\0']).to_owned(),
                ends: [0, WORD].map(|place| self.double(&part[place..])),
                integers: part[2 * WORD..].chunks(4).take(integers as usize).map(|part| self.integer(part)).collect(),
            }));
            next = control[0];
        }
        Ok(summaries)
    }

    /// Words from an address on, which counts from 1.
    pub(super) fn words(&self, address: usize, count: usize) -> Result<Vec<f64>, ReadError> {
        let bytes = self.bytes((address as u64 - 1) * WORD as u64, count * WORD)?;
        Ok(bytes.chunks_exact(WORD).map(|word| self.double(word)).collect())
    }

    /// The number of words.
    pub(super) fn length(&self) -> u64 {
        self.bytes / WORD as u64
    }

    /// Bytes from a place on; memory is taken after the place was compared with the length of the file.
    fn bytes(&self, place: u64, count: usize) -> Result<Vec<u8>, ReadError> {
        if place.saturating_add(count as u64) > self.bytes {
            let allowed = format!("at least {} bytes", place.saturating_add(count as u64));
            return Err(self.damaged(0, "the length", format!("{} bytes", self.bytes), allowed));
        }
        let mut bytes = vec![0; count];
        let mut source = self.source.lock().unwrap_or_else(PoisonError::into_inner);
        let read = source.seek(SeekFrom::Start(place)).and_then(|_| source.read_exact(&mut bytes));
        read.map_err(|error| system(&self.name, &error))?;
        Ok(bytes)
    }

    fn double(&self, bytes: &[u8]) -> f64 {
        let word = bytes[..WORD].try_into().unwrap_or_default();
        if self.big { f64::from_be_bytes(word) } else { f64::from_le_bytes(word) }
    }

    fn integer(&self, bytes: &[u8]) -> i32 {
        let word = bytes[..4].try_into().unwrap_or_default();
        if self.big { i32::from_be_bytes(word) } else { i32::from_le_bytes(word) }
    }

    /// The error of a damaged segment, or of the file for number 0.
    pub(super) fn damaged(
        &self,
        segment: usize,
        item: &'static str,
        value: impl ToString,
        allowed: impl Into<String>,
    ) -> ReadError {
        let (file, value, allowed) = (self.name.clone(), value.to_string(), allowed.into());
        ReadError::Damaged { file, segment, item, value, allowed }
    }
}

fn system(name: &str, error: &io::Error) -> ReadError {
    ReadError::System { file: name.to_owned(), kind: error.kind(), message: error.to_string() }
}
