//! The reader has CSPICE's values, in both byte orders, reads no more than it needs, and says where data end.

mod excerpts;

use std::io::{Cursor, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use andoyer_kernels::{Daf, Ephemeris, Gap, Head, Orientations, ReadError};
use excerpts::{ALL, Excerpt, Kernel, MONTH, MOON, STATES, lines};

const DAY: f64 = 86400.0;

/// The operations are those of CSPICE, in its order, so that every bit is the same; a frame is turned by a sine and a cosine of the system, which may differ in the last bit.
#[test]
fn values_are_those_of_cspice() -> Result<(), ReadError> {
    for Excerpt { name, bytes } in ALL {
        let kernel = Kernel::open(name, bytes.to_vec())?;
        assert!(lines(name).len() > 10);
        for line in lines(name) {
            same(&kernel.read(&line)?, &line.values, if line.target == -3 { 2e-16 } else { 0.0 });
        }
    }
    Ok(())
}

/// Both halves are within a tolerance of their lengths.
fn same(found: &[f64; 6], expected: &[f64; 6], tolerance: f64) {
    for (found, expected) in found.chunks(3).zip(expected.chunks(3)) {
        let length = expected.iter().map(|x| x * x).sum::<f64>().sqrt();
        let error = found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(error <= tolerance * length, "{found:?} instead of {expected:?}");
    }
}

#[test]
fn a_big_endian_file_has_the_same_values() -> Result<(), ReadError> {
    for Excerpt { name, bytes } in ALL {
        let [little, big] = [bytes.to_vec(), swapped(bytes)].map(|bytes| Kernel::open(name, bytes));
        let (little, big) = (little?, big?);
        for line in lines(name) {
            assert_eq!(little.read(&line)?, big.read(&line)?);
        }
    }
    Ok(())
}

/// The words of all numbers turned round, by the places that DAF Required Reading gives.
fn swapped(bytes: &[u8]) -> Vec<u8> {
    let integer = |place: usize| i32::from_le_bytes(bytes[place..place + 4].try_into().unwrap_or_default());
    let double = |place: usize| f64::from_le_bytes(bytes[place..place + 8].try_into().unwrap_or_default());
    let mut new = bytes.to_vec();
    let mut turn = |place: usize, size: usize| new[place..place + size].reverse();
    [8, 12, 76, 80, 84].into_iter().for_each(|place| turn(place, 4));
    let mut record = integer(76);
    while record > 0 {
        let start = (record as usize - 1) * 1024;
        [0, 8, 16].into_iter().for_each(|place| turn(start + place, 8));
        for summary in (0..double(start + 16) as usize).map(|summary| start + 24 + 40 * summary) {
            [0, 8].into_iter().for_each(|place| turn(summary + place, 8));
            let integers = integer(12) as usize;
            (0..integers).for_each(|place| turn(summary + 16 + 4 * place, 4));
            let [first, last] = [2, 1].map(|back| integer(summary + 16 + 4 * (integers - back)) as usize);
            (first..=last).for_each(|word| turn((word - 1) * 8, 8));
        }
        record = double(start) as i32;
    }
    new[88..96].copy_from_slice(b"BIG-IEEE");
    new
}

#[test]
fn a_gap_names_the_body_and_the_data_around_it() -> Result<(), ReadError> {
    let mut kernel = Ephemeris::open::<&str>(&[])?;
    kernel.load(MONTH.name, Cursor::new(MONTH.bytes))?;
    let spans = [(0.0, 31.0 * DAY), (40.0 * DAY, 44.0 * DAY)];
    assert_eq!((kernel.coverage(301), kernel.coverage(7)), (spans.to_vec(), Vec::new()));
    let gap = |target, observer, et| match kernel.state(target, observer, et) {
        Err(ReadError::NotCovered { gaps, .. }) => gaps,
        other => panic!("{other:?}"),
    };
    let (before, after) = (Some(spans[0]), Some(spans[1]));
    assert_eq!(gap(301, 3, 35.0 * DAY), [Gap { body: 301, before, after }, Gap { body: 3, before, after: None }]);
    assert_eq!(
        gap(301, 399, 42.0 * DAY),
        [Gap { body: 3, before, after: None }, Gap { body: 399, before, after: None }]
    );
    assert_eq!(gap(10, 7, DAY), [Gap { body: 7, before: None, after: None }]);
    // The chains of centres meet at the Earth-Moon barycentre, which needs no data.
    assert!(kernel.state(301, 3, 42.0 * DAY).is_ok());
    assert_eq!(kernel.state(301, 301, 99.0 * DAY), Ok(([0.0; 3], [0.0; 3])));
    assert_eq!(
        kernel.state(301, 0, 35.0 * DAY).expect_err("a gap").to_string(),
        "no data for 301 seen from 0 at 3024000 s of TDB past J2000: 301 has data from 0 to 2678400 s and from 3456000 to 3801600 s"
    );
    assert!(matches!(kernel.state(301, 3, f64::NAN), Err(ReadError::Time { .. })));
    Ok(())
}

#[test]
fn the_last_segment_of_the_last_file_wins() -> Result<(), ReadError> {
    let Kernel::Ephemeris(mut kernel) = Kernel::open(STATES.name, STATES.bytes.to_vec())? else { unreachable!() };
    let types: Vec<_> = kernel.segments().map(|segment| (segment.body, segment.data_type)).collect();
    assert_eq!(types, [(-3, 3), (-9, 9), (-9, 9), (-13, 13)]);
    // The same file, but the coefficients of the first record of type 3 have the other sign: 62 words, of which the first two are its interval.
    let mut bytes = STATES.bytes.to_vec();
    let before = kernel.state(-3, 399, 0.0)?;
    for word in bytes[3072..].chunks_mut(8).take(62).skip(2) {
        word[7] ^= 0x80;
    }
    kernel.load("other.bsp", Cursor::new(bytes))?;
    let after = kernel.state(-3, 399, 0.0)?;
    assert_eq!((before.0.map(|x| -x), before.1.map(|x| -x)), after);
    Ok(())
}

#[test]
fn a_span_that_is_kept_has_the_same_values() -> Result<(), ReadError> {
    for Excerpt { name, bytes } in [MONTH, STATES] {
        let mut kernel = Ephemeris::open::<&str>(&[])?;
        kernel.load(name, Cursor::new(bytes))?;
        for line in lines(name) {
            kernel.keep(line.target, (0.4 * line.et, line.et))?;
            let (position, _) = kernel.state(line.target, line.observer.unwrap_or_default(), line.et)?;
            same(&std::array::from_fn(|k| position[k % 3]), &std::array::from_fn(|k| line.values[k % 3]), 2e-16);
        }
    }
    Ok(())
}

/// What the writer of this crate writes: one revolution in 1000 s about an axis that leans, with angles that grow linearly.
#[test]
fn attitudes_are_those_of_the_angles_that_were_written() -> Result<(), Box<dyn std::error::Error>> {
    let [phi, delta] = [0.7, 0.4];
    for (frame, lean) in [(1, 0.0), (17, (84381.448_f64 / 3600.0).to_radians())] {
        let head = Head { code: -999_000, frame, name: "A".to_owned() };
        let mut daf = Daf::pck(Cursor::new(Vec::new()), &[])?;
        daf.pck2(&head, [0.0, 1000.0], 1000.0, 1, &[phi, 0.0, delta, 0.0, 500.0, 500.0])?;
        let mut kernel = Orientations::open::<&str>(&[])?;
        kernel.load("a.bpc", daf.finish()?)?;
        let ([_, _, turn], rates) = kernel.angles(-999_000, 300.0)?;
        assert_eq!((turn, rates), (300.0, [0.0, 0.0, 1.0]));
        let (q, rate) = kernel.attitude(-999_000, 300.0)?;
        // The third axis of the body, leaning with the ecliptic, by the matrix of q and by the rate.
        let (y, z) = (-delta.sin() * phi.cos(), delta.cos());
        let axis = [delta.sin() * phi.sin(), y * lean.cos() - z * lean.sin(), y * lean.sin() + z * lean.cos()];
        let [a, b, c, d] = q;
        let third = [2.0 * (a * c + b * d), 2.0 * (b * c - a * d), d * d + c * c - a * a - b * b];
        for k in 0..3 {
            assert!((third[k] - axis[k]).abs() < 1e-15 && (rate[k] - axis[k]).abs() < 1e-15);
        }
        assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
    }
    Ok(())
}

#[test]
fn an_orientation_in_two_segments_has_one_interval() -> Result<(), ReadError> {
    let mut kernel = Orientations::open::<&str>(&[])?;
    kernel.load(MOON.name, Cursor::new(MOON.bytes))?;
    assert_eq!((kernel.segments().count(), kernel.coverage(31006).len()), (2, 1));
    let [start, end] = [0, 1].map(|k| kernel.segments().nth(k).expect("two").span.0);
    assert!(start < end && kernel.angles(31006, end).is_ok() && kernel.angles(31006, start - 1.0).is_err());
    Ok(())
}

/// A file of CSPICE with 25 segments ends with an empty record of summaries, without the record of names.
#[test]
fn the_last_record_of_summaries_may_be_empty() -> Result<(), Box<dyn std::error::Error>> {
    let head = Head { code: -999_000, frame: 1, name: "A".to_owned() };
    let mut daf = Daf::pck(Cursor::new(Vec::new()), &[])?;
    for segment in 0..25 {
        daf.pck2(&head, [0.0, 1.0], 1.0, 0, &[f64::from(segment), 0.0, 0.0])?;
    }
    let mut bytes = daf.finish()?.into_inner();
    let next = (bytes.len() / 1024 + 1) as f64;
    bytes[1024..1032].copy_from_slice(&next.to_le_bytes());
    bytes.extend([0.0, 2.0, 0.0].map(f64::to_le_bytes).as_flattened());
    bytes.resize(bytes.len().next_multiple_of(1024), 0);
    let mut kernel = Orientations::open::<&str>(&[])?;
    kernel.load("a.bpc", Cursor::new(bytes))?;
    assert_eq!((kernel.segments().count(), kernel.angles(-999_000, 0.5)?.0), (25, [24.0, 0.0, 0.0]));
    Ok(())
}

#[test]
fn another_kind_of_file_is_named() {
    let kind = |name, bytes: &[u8]| Kernel::open(name, bytes.to_vec()).err().map(|error| error.to_string());
    assert_eq!(kind("a.bpc", MONTH.bytes).as_deref(), Some("a.bpc must be a binary PCK: got \"DAF/SPK\""));
    assert_eq!(kind("a.bsp", MOON.bytes).as_deref(), Some("a.bsp must be an SPK file: got \"DAF/PCK\""));
    let error = Ephemeris::open(&["no/such/file.bsp"]).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.starts_with("no/such/file.bsp cannot be read: "));
}

#[test]
fn threads_share_kernels() {
    fn shared<T: Send + Sync>() {}
    shared::<Ephemeris>();
    shared::<Orientations>();
    shared::<ReadError>();
}

/// A file of 1 GB with one segment of records of 26 words, which makes its words when they are read and counts them.
struct Large {
    place: u64,
    read: Arc<AtomicU64>,
}

impl Large {
    const RECORDS: u64 = 5_000_000;
    const WORDS: u64 = 26 * Self::RECORDS + 4;
    const BYTES: u64 = 3072 + 8 * Self::WORDS;

    fn word(place: u64) -> u64 {
        let integers = |one: u32, other: u32| u64::from(one) | u64::from(other) << 32;
        let number = |value: u64| (value as f64).to_bits();
        match place {
            0 => u64::from_le_bytes(*b"DAF/SPK "),
            1 => integers(2, 6),
            9 => integers(0, 2),
            10 => integers(2, Self::WORDS as u32 + 385),
            11 => u64::from_le_bytes(*b"LTL-IEEE"),
            130 => number(1),
            132 => number(100 * Self::RECORDS),
            133 => integers(5, 0),
            134 => integers(1, 2),
            135 => integers(385, Self::WORDS as u32 + 384),
            384.. => match ((place - 384) / 26, (place - 384) % 26) {
                (Self::RECORDS, last) => number([0, 100, 26, Self::RECORDS][last as usize]),
                (record, 0) => number(100 * record + 50),
                (_, 1) => number(50),
                (record, 2) => number(record),
                _ => 0,
            },
            _ => 0,
        }
    }
}

impl Read for Large {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = buffer.len().min(Self::BYTES.saturating_sub(self.place) as usize);
        for byte in &mut buffer[..count] {
            *byte = Self::word(self.place / 8).to_le_bytes()[(self.place % 8) as usize];
            self.place += 1;
        }
        self.read.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

impl Seek for Large {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.place = match to {
            SeekFrom::Start(place) => place,
            SeekFrom::End(back) => Self::BYTES.saturating_add_signed(back),
            SeekFrom::Current(step) => self.place.saturating_add_signed(step),
        };
        Ok(self.place)
    }
}

#[test]
fn a_file_of_1_gb_is_read_in_pieces() -> Result<(), ReadError> {
    let read = Arc::new(AtomicU64::new(0));
    let mut kernel = Ephemeris::open::<&str>(&[])?;
    kernel.load("large.bsp", Large { place: 0, read: read.clone() })?;
    assert!(Large::BYTES > 1_000_000_000 && read.load(Ordering::Relaxed) == 3072);
    for record in [0, 4_999_999, 123_456] {
        assert_eq!(kernel.state(5, 0, 100.0 * f64::from(record) + 25.0)?.0, [f64::from(record), 0.0, 0.0]);
    }
    // The last four words once, and some 4 kB for each time.
    assert!(read.load(Ordering::Relaxed) <= 3072 + 32 + 3 * 4096);
    Ok(())
}
