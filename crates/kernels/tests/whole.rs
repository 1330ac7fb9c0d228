//! A file has its name when it is complete, and a kernel has the records that NAIF's DAF Required Reading says.

use std::fs;
use std::io::{Cursor, Error, ErrorKind, Write};

use andoyer_kernels::{Daf, Head, Kernel, whole};

#[test]
fn an_error_leaves_the_old_file_and_nothing_else() -> Result<(), Error> {
    let folder = std::env::temp_dir().join(format!("andoyer-whole-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let path = folder.join("a.bc");
    fs::write(&path, b"old")?;
    let failed: Result<(), Error> = whole(
        &path,
        true,
        |error| error,
        |file| {
            file.write_all(b"half a")?;
            Err(ErrorKind::StorageFull.into())
        },
    );
    assert_eq!(failed.map_err(|error| error.kind()), Err(ErrorKind::StorageFull));
    let kept: Result<(), Error> = whole(&path, false, |error| error, |_| Ok(()));
    assert_eq!(kept.map_err(|error| error.kind()), Err(ErrorKind::AlreadyExists));
    assert_eq!((fs::read(&path)?, fs::read_dir(&folder)?.count()), (b"old".to_vec(), 1));
    whole(&path, true, |error: Error| error, |file| file.write_all(b"new"))?;
    assert_eq!((fs::read(&path)?, fs::read_dir(&folder)?.count()), (b"new".to_vec(), 1));
    fs::remove_dir_all(folder)
}

#[test]
fn summaries_are_chained_and_addresses_are_those_of_the_arrays() -> Result<(), Box<dyn std::error::Error>> {
    let head = Head::of(&Kernel::new("TUMBLER", "J2000")?);
    let mut daf = Daf::ck(Cursor::new(Vec::new()), &["one".to_owned(), "x".repeat(2000)])?;
    for segment in 0..60 {
        let ticks = [f64::from(segment), f64::from(segment) + 1.0];
        daf.ck3(&head, &ticks, &[[0.0, 0.0, 0.0, 1.0]; 2], None, &ticks[..1])?;
    }
    let bytes = daf.finish()?.into_inner();
    let double = |place: usize| f64::from_le_bytes(bytes[place..place + 8].try_into().unwrap_or_default());
    let integer = |place: usize| i32::from_le_bytes(bytes[place..place + 4].try_into().unwrap_or_default());
    assert_eq!((bytes.len() % 1024, &bytes[..8], &bytes[88..96]), (0, &b"DAF/CK  "[..], &b"LTL-IEEE"[..]));
    let (mut record, mut counts, mut previous) = (integer(76), Vec::new(), 0.0);
    let mut next = 1;
    while record > 0 {
        let start = (record as usize - 1) * 1024;
        assert_eq!(double(start + 8), previous);
        let count = double(start + 16) as usize;
        for summary in (0..count).map(|summary| start + 24 + 40 * summary) {
            let [code, frame, kind, rates, first, last] =
                [0, 1, 2, 3, 4, 5].map(|place| integer(summary + 16 + 4 * place));
            assert_eq!((code, frame, kind, rates), (head.code, 1, 3, 0));
            // Two quaternions, two ticks, one start, two counts.
            assert_eq!(last - first + 1, 13);
            assert!(first >= next);
            assert_eq!(double((last as usize - 1) * 8), 2.0);
            next = last + 1;
        }
        counts.push(count);
        previous = f64::from(record);
        record = double(start) as i32;
    }
    assert_eq!((counts, integer(80), integer(84)), (vec![25, 25, 10], previous as i32, next));
    Ok(())
}

#[test]
fn lists_that_make_no_segment_are_refused() -> Result<(), Box<dyn std::error::Error>> {
    let head = Head::of(&Kernel::new("TUMBLER", "J2000")?);
    let mut daf = Daf::ck(Cursor::new(Vec::new()), &[])?;
    let unit = [[0.0, 0.0, 0.0, 1.0]; 2];
    for (ticks, starts) in
        [(&[1.0, 1.0][..], &[1.0][..]), (&[1.0], &[1.0]), (&[1.0, 2.0], &[2.0]), (&[1.0, 2.0], &[]), (&[], &[])]
    {
        assert_eq!(
            daf.ck3(&head, ticks, &unit, None, starts).map_err(|error| error.kind()),
            Err(ErrorKind::InvalidInput)
        );
    }
    assert!(
        daf.ck2(&head, &[0.0, 1.0], &unit, &[[0.0; 3]; 2], &[1.0; 2]).is_err()
            && daf.pck2(&head, [0.0, 1.0], 1.0, 1, &[0.0; 5]).is_err()
    );
    Ok(())
}
