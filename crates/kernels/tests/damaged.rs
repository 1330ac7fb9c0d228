//! A damaged file gives a typed error or the right values: no panic, no memory beyond the size of the file.

mod excerpts;

use andoyer_kernels::ReadError;
use excerpts::{ALL, Excerpt, Kernel, MONTH, MOON, STATES, lines};

/// Reads all lines of a file. Each value is right or an error; returns how many lines are errors.
fn errors(name: &str, bytes: Vec<u8>, damage: &str) -> usize {
    let lines = lines(name);
    let Ok(kernel) = Kernel::open(name, bytes) else { return lines.len() };
    let read = lines.iter().map(|line| match kernel.read(line) {
        Ok(values) => {
            let close = values.iter().zip(&line.values).all(|(x, y)| (x - y).abs() <= 1e-14 * y.abs());
            assert!(close, "{name}, {damage}: {values:?} instead of {:?}", line.values);
            0
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            1
        }
    });
    read.sum()
}

#[test]
fn files_that_are_cut_off() {
    let mut cuts = 0;
    for Excerpt { name, bytes } in ALL {
        let half = |place: usize| place * bytes.len() / 8;
        for length in [0, 1, 7, 8, 95, 1023, 1024, 2047, 2048, 3071].into_iter().chain((2..8).map(half)) {
            let errors = errors(name, bytes[..length].to_vec(), &format!("cut at {length}"));
            assert!(errors > 0 || length > 3072);
            cuts += 1;
        }
    }
    assert_eq!(cuts, 48);
}

/// A file with other bytes from a place on.
fn changed(bytes: &[u8], place: usize, new: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[place..place + new.len()].copy_from_slice(new);
    bytes
}

/// The numbers that replace a number.
const DOUBLES: [f64; 9] = [f64::NAN, f64::INFINITY, -1.0, 0.0, 0.5, 1.0, 26.0, 1e9, -1e300];
const INTEGERS: [i32; 7] = [0, -1, i32::MIN, i32::MAX, 1, 11, 1_000_000];

#[test]
fn a_file_record_with_other_numbers() {
    for Excerpt { name, bytes } in ALL {
        for place in [8, 12, 76] {
            for number in INTEGERS {
                assert!(errors(name, changed(bytes, place, &number.to_le_bytes()), "file record") > 0);
            }
        }
        for (place, new) in
            [(0, b"DAF/CK  "), (0, b"DAFETF N"), (0, b"\0\0\0\0\0\0\0\0"), (88, b"VAX-GFLT"), (88, b"BIG-IEEE")]
        {
            assert!(errors(name, changed(bytes, place, new), "names") > 0);
        }
        // The file of an old toolkit has no kind and no byte order.
        let old = changed(&changed(bytes, 0, b"NAIF/DAF"), 88, &[0; 8]);
        assert_eq!(errors(name, old, "none"), 0);
    }
}

#[test]
fn summaries_with_other_numbers() {
    for Excerpt { name, bytes } in ALL {
        // A chain that comes back to its first record.
        assert!(errors(name, changed(bytes, 1024, &2.0_f64.to_le_bytes()), "loop") > 0);
        for number in DOUBLES.into_iter().filter(|&number| number != 0.0) {
            assert!(errors(name, changed(bytes, 1024, &number.to_le_bytes()), "next record") > 0);
        }
        for number in DOUBLES {
            // 26 summaries do not fit, and one summary leaves out bodies.
            assert!(errors(name, changed(bytes, 1040, &number.to_le_bytes()), "number of summaries") > 0);
        }
        let integers = if name == MOON.name { 5 } else { 6 };
        for summary in 0..if name == MOON.name { 2 } else { 4 } {
            let start = 1048 + 40 * summary;
            // Another body, another centre or another inertial frame (1 to 21) is no damage that shows.
            for place in integers - 4..integers {
                for number in INTEGERS.into_iter().filter(|number| place > integers - 4 || !(1..22).contains(number)) {
                    errors(
                        name,
                        changed(bytes, start + 16 + 4 * place, &number.to_le_bytes()),
                        "integers of a summary",
                    );
                }
            }
            for place in [0, 8] {
                errors(name, changed(bytes, start + place, &f64::NAN.to_le_bytes()), "span");
            }
        }
    }
}

#[test]
fn segments_with_other_numbers() {
    for (Excerpt { name, bytes }, words) in [(MONTH, 4), (STATES, 2), (MOON, 4)] {
        let integer = |place: usize| i32::from_le_bytes(bytes[place..place + 4].try_into().unwrap_or_default());
        let count = f64::from_le_bytes(bytes[1040..1048].try_into().unwrap_or_default()) as usize;
        let integers = if name == MOON.name { 5 } else { 6 };
        for summary in 0..count {
            let place = |integer: usize| 1048 + 40 * summary + 16 + 4 * integer;
            let [first, last] = [2, 1].map(|back| integer(place(integers - back)) as usize);
            for word in last - words..last {
                // Another number of states for a polynomial is no damage that shows.
                let shows = |number: f64| words == 4 || word == last - 1 || !(0.0..=26.0).contains(&number);
                for number in DOUBLES.into_iter().filter(|&number| shows(number)) {
                    errors(name, changed(bytes, 8 * word, &number.to_le_bytes()), "last words of a segment");
                }
            }
            // Not a number: the middle and the radius of the first interval, or parts of a state; then a coefficient, or a time of a state.
            for word in (first - 1..last).step_by(5) {
                errors(name, changed(bytes, 8 * word, &f64::NAN.to_le_bytes()), "a word");
            }
        }
    }
}

#[test]
fn the_error_has_the_file_the_segment_and_the_bound() {
    // The size of a record of the first segment, which ends before the second one begins.
    let last = i32::from_le_bytes(MONTH.bytes[1084..1088].try_into().unwrap_or_default()) as usize;
    let bytes = changed(MONTH.bytes, 8 * (last - 2), &0.0_f64.to_le_bytes());
    let line =
        lines(MONTH.name).into_iter().find(|line| line.target == 10 && line.observer == Some(0)).expect("the Sun");
    let error = Kernel::open(MONTH.name, bytes).and_then(|kernel| kernel.read(&line)).expect_err("no records");
    assert!(matches!(&error, ReadError::Damaged { segment: 1, .. }));
    assert!(error.to_string().starts_with("month.bsp, segment 1 is damaged: the size and number of records must be "));
}
