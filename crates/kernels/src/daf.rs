//! Double precision array files (DAF), little-endian: file record, comment area, summaries, arrays.
//!
//! A record has 1024 bytes. Record 1 has the addresses of the first and the last summary record and of the first free word. The comments follow, then the
//! summary records, each with a record of names behind it, among the arrays. A summary has two doubles and five or six integers; here it always takes five words, and
//! 25 of them fill a record. Source: DAF Required Reading.

use std::io::{self, Seek, SeekFrom, Write};

pub(crate) const RECORD: usize = 1024;
pub(crate) const WORD: usize = 8;
/// Words of a summary, two doubles and up to six integers, its number in a record, and the words before the first one.
pub(crate) const SUMMARY: usize = 5;
pub(crate) const MOST: usize = 25;
pub(crate) const CONTROL: usize = 3;
/// Doubles of a summary.
pub(crate) const DOUBLES: u32 = 2;
/// Places in the file record: the name of the file, the number of the first summary record, the byte order.
pub(crate) const FILE_NAME: usize = 16;
pub(crate) const FIRST: usize = FILE_NAME + INTERNAL;
pub(crate) const ORDER: usize = FIRST + 12;
/// The words for the byte order: little-endian, big-endian.
pub(crate) const ORDERS: [&[u8; 8]; 2] = [b"LTL-IEEE", b"BIG-IEEE"];

/// A kind of file: its identity and the number of integers of a summary.
pub(crate) type Kind = (&'static [u8; 8], u32);
pub(crate) const CK: Kind = (b"DAF/CK  ", 6);
pub(crate) const PCK: Kind = (b"DAF/PCK ", 5);
pub(crate) const SPK: Kind = (b"DAF/SPK ", 6);

/// Characters of a comment in a record.
const COMMENT: usize = 1000;
/// Characters of the name of an array, and of the internal name of the file.
pub(crate) const NAME: usize = SUMMARY * WORD;
const INTERNAL: usize = 60;
/// Longest line of the comments.
const LINE: usize = 80;

/// The record of summaries that is filled, and the record of their names.
struct Summaries {
    record: usize,
    previous: usize,
    next: usize,
    words: Vec<u8>,
    names: Vec<u8>,
}

impl Summaries {
    fn new(record: usize, previous: usize) -> Self {
        Self { record, previous, next: 0, words: Vec::with_capacity(RECORD), names: Vec::with_capacity(RECORD) }
    }

    fn count(&self) -> usize {
        self.names.len() / NAME
    }

    /// Both records: the numbers of the next and the previous one and of the summaries, the summaries, and the names.
    fn bytes(&self) -> Vec<u8> {
        let head = [self.next, self.previous, self.count()].map(|number| (number as f64).to_le_bytes());
        let mut bytes = [head.as_flattened(), &self.words].concat();
        bytes.resize(RECORD, 0);
        bytes.extend_from_slice(&self.names);
        bytes.resize(2 * RECORD, b' ');
        bytes
    }
}

/// A double precision array file that is being written: a C-kernel or a binary PCK.
///
/// Arrays go to the stream at once; [`finish`](Self::finish) writes the summaries and the file record. Until then the file is no valid kernel.
pub struct Daf<W> {
    out: W,
    identity: &'static [u8; 8],
    integers: u32,
    /// Bytes that were written, which is the place in the stream.
    place: usize,
    first: usize,
    summaries: Summaries,
}

impl<W> std::fmt::Debug for Daf<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kind = String::from_utf8_lossy(self.identity);
        f.debug_struct("Daf").field("kind", &kind).field("place", &self.place).finish_non_exhaustive()
    }
}

impl<W: Write + Seek> Daf<W> {
    /// A C-kernel with these lines in its comment area. Other characters than printable ASCII become question marks, and long lines are broken.
    ///
    /// # Errors
    /// Those of the stream.
    pub fn ck(out: W, comments: &[String]) -> io::Result<Self> {
        Self::new(out, CK, comments)
    }

    /// A binary PCK with these lines in its comment area, as for [`ck`](Self::ck).
    ///
    /// # Errors
    /// Those of the stream.
    pub fn pck(out: W, comments: &[String]) -> io::Result<Self> {
        Self::new(out, PCK, comments)
    }

    fn new(mut out: W, (identity, integers): Kind, comments: &[String]) -> io::Result<Self> {
        let mut bytes = vec![0; RECORD];
        for part in comment_area(comments).chunks(COMMENT) {
            bytes.extend_from_slice(part);
            bytes.resize(bytes.len().next_multiple_of(RECORD), 0);
        }
        let first = bytes.len() / RECORD + 1;
        bytes.resize(bytes.len() + 2 * RECORD, 0);
        out.write_all(&bytes)?;
        Ok(Self { out, identity, integers, place: bytes.len(), first, summaries: Summaries::new(first, 0) })
    }

    /// Writes an array with its summary: name, two doubles, integers without the addresses.
    pub(crate) fn array(&mut self, name: &str, ends: [f64; 2], integers: &[i32], parts: &[&[f64]]) -> io::Result<()> {
        if self.summaries.count() == MOST {
            self.next_summaries()?;
        }
        let begin = self.place / WORD + 1;
        let words = parts.iter().map(|part| part.len()).sum::<usize>();
        for part in parts {
            // In pieces, so that no copy of the whole array is made.
            for piece in part.chunks(RECORD) {
                self.put(piece.iter().flat_map(|word| word.to_le_bytes()).collect())?;
            }
        }
        let address = |word: usize| i32::try_from(word).map_err(|_| io::Error::from(io::ErrorKind::FileTooLarge));
        let integers = [integers, &[address(begin)?, address(begin + words - 1)?]].concat();
        debug_assert_eq!(integers.len(), self.integers as usize);
        let Summaries { words, names, .. } = &mut self.summaries;
        words.extend(ends.iter().flat_map(|end| end.to_le_bytes()));
        words.extend(integers.iter().flat_map(|integer| integer.to_le_bytes()));
        words.resize(words.len().next_multiple_of(WORD), 0);
        names.extend_from_slice(padded(name, NAME).as_bytes());
        Ok(())
    }

    /// Writes the summary record and the file record and returns the stream.
    ///
    /// # Errors
    /// Those of the stream.
    pub fn finish(mut self) -> io::Result<W> {
        let free = self.place / WORD + 1;
        self.put(vec![0; self.place.next_multiple_of(RECORD) - self.place])?;
        self.put_summaries()?;
        let number = |value: usize| (value as u32).to_le_bytes();
        let mut bytes = self.identity.to_vec();
        bytes.extend([DOUBLES, self.integers].map(u32::to_le_bytes).as_flattened());
        bytes.extend_from_slice(padded("andoyer", INTERNAL).as_bytes());
        bytes.extend([number(self.first), number(self.summaries.record), number(free)].as_flattened());
        bytes.extend_from_slice(ORDERS[0]);
        bytes.resize(699, 0);
        // A transfer in text mode would change these bytes, and CSPICE looks at them.
        bytes.extend_from_slice(b"FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xce:ENDFTP");
        bytes.resize(RECORD, 0);
        self.out.seek(SeekFrom::Start(0))?;
        self.out.write_all(&bytes)?;
        self.out.flush()?;
        Ok(self.out)
    }

    fn put(&mut self, bytes: Vec<u8>) -> io::Result<()> {
        self.place += bytes.len();
        self.out.write_all(&bytes)
    }

    /// Begins a new summary record at the end of the file.
    fn next_summaries(&mut self) -> io::Result<()> {
        self.put(vec![0; self.place.next_multiple_of(RECORD) - self.place])?;
        self.summaries.next = self.place / RECORD + 1;
        self.put_summaries()?;
        self.summaries = Summaries::new(self.summaries.next, self.summaries.record);
        self.put(vec![0; 2 * RECORD])
    }

    /// Writes the summary record to its place, and returns to the end.
    fn put_summaries(&mut self) -> io::Result<()> {
        self.out.seek(SeekFrom::Start(((self.summaries.record - 1) * RECORD) as u64))?;
        self.out.write_all(&self.summaries.bytes())?;
        self.out.seek(SeekFrom::Start(self.place as u64)).map(drop)
    }
}

/// The text of the comment area: each line ends with a null character, the whole with character 4.
fn comment_area(lines: &[String]) -> Vec<u8> {
    let mut text = Vec::new();
    for line in lines {
        let line: Vec<u8> =
            line.chars().map(|letter| if matches!(letter, ' '..='~') { letter as u8 } else { b'?' }).collect();
        let pieces = if line.is_empty() { vec![&b" "[..]] } else { line.chunks(LINE).collect() };
        pieces.iter().for_each(|piece| text.extend([piece, &b"\0"[..]].concat()));
    }
    if !text.is_empty() {
        text.push(4);
    }
    text
}

/// A name with blanks to a length.
fn padded(name: &str, length: usize) -> String {
    format!("{name:<length$.length$}")
}
