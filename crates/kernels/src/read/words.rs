//! The words of a segment, which are read in pieces.

use std::sync::{Mutex, PoisonError};

use crate::read::daf::DafFile;
use crate::read::error::ReadError;

/// Words that are read at least, 4 kB.
const AHEAD: usize = 512;

/// Words that were read last, from a place in the segment on.
#[derive(Default)]
struct Block {
    first: usize,
    words: Vec<f64>,
}

/// The words that were read last: records or states, and times of states.
#[derive(Default)]
pub(super) struct Kept([Mutex<Block>; 2]);

/// The words of a segment, by their places from 0.
pub(super) struct Words<'a> {
    file: &'a DafFile,
    number: usize,
    first: usize,
    count: usize,
    kept: &'a Kept,
}

impl<'a> Words<'a> {
    /// The words between two addresses, which count from 1.
    pub(super) fn new(
        file: &'a DafFile,
        number: usize,
        [first, last]: [i32; 2],
        kept: &'a Kept,
    ) -> Result<Self, ReadError> {
        match (usize::try_from(first), usize::try_from(last)) {
            (Ok(first), Ok(last)) if 1 <= first && first <= last && last as u64 <= file.length() => {
                Ok(Self { file, number, first, count: last + 1 - first, kept })
            }
            _ => {
                let value = format!("{first} to {last}");
                Err(file.damaged(number, "the addresses", value, format!("increasing, 1 to {}", file.length())))
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Words from a place on. The place is inside the segment.
    pub(super) fn read(&self, place: usize, count: usize) -> Result<Vec<f64>, ReadError> {
        self.file.words(self.first + place, count)
    }

    /// N words from a place on.
    pub(super) fn array<const N: usize>(&self, place: usize) -> Result<[f64; N], ReadError> {
        let words = self.read(place, N)?;
        Ok(std::array::from_fn(|word| words[word]))
    }

    /// Calls a function with words, which are read from the file unless they are kept.
    pub(super) fn with<T>(&self, place: usize, count: usize, make: impl FnOnce(&[f64]) -> T) -> Result<T, ReadError> {
        self.with_block(0, place, count, make)
    }

    /// Calls a function with words of a second kept block: that of the times of states.
    pub(super) fn with_second<T>(
        &self,
        place: usize,
        count: usize,
        make: impl FnOnce(&[f64]) -> T,
    ) -> Result<T, ReadError> {
        self.with_block(1, place, count, make)
    }

    fn with_block<T>(
        &self,
        which: usize,
        place: usize,
        count: usize,
        make: impl FnOnce(&[f64]) -> T,
    ) -> Result<T, ReadError> {
        let mut block = self.kept.0[which].lock().unwrap_or_else(PoisonError::into_inner);
        if place < block.first || place + count > block.first + block.words.len() {
            let words = self.read(place, count.max(AHEAD).min(self.count - place))?;
            *block = Block { first: place, words };
        }
        let start = place - block.first;
        Ok(make(&block.words[start..start + count]))
    }

    pub(super) fn damaged(&self, item: &'static str, value: impl ToString, allowed: impl Into<String>) -> ReadError {
        self.file.damaged(self.number, item, value, allowed)
    }
}
