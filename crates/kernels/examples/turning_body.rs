//! A binary PCK of a body that turns once in 8 hours, written, and read back as attitudes.

#![expect(clippy::print_stdout, reason = "an example prints what it computes")]

use andoyer_kernels::{Daf, Head, Orientations};
use std::io::Cursor;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    const DAY: f64 = 86_400.0;
    let head = Head { code: -999_000, frame: 1, name: "TURNING BODY".to_owned() };
    // Chebyshev polynomials of degree 1 on one interval of a day: a pole at right ascension 30° and declination 60°, and three turns.
    let (node, tilt) = (120_f64.to_radians(), 30_f64.to_radians());
    let half = 3.0 * std::f64::consts::PI; // [rad]: the angle is half + half·x, with x from −1 to 1
    let mut daf = Daf::pck(Cursor::new(Vec::new()), &["One turn in 8 hours.".to_owned()])?;
    daf.pck2(&head, [0.0, DAY], DAY, 1, &[node, 0.0, tilt, 0.0, half, half])?;

    let mut kernel = Orientations::open::<&str>(&[])?;
    kernel.load("turning.bpc", daf.finish()?)?;
    println!("data for {:?}", kernel.coverage(head.code));
    for hours in [0.0, 2.0, 4.0, 8.0] {
        let (_, rates) = kernel.angles(head.code, 3600.0 * hours)?;
        let ([x, y, z, w], _) = kernel.attitude(head.code, 3600.0 * hours)?;
        println!("{hours} h: attitude {x:+.6} {y:+.6} {z:+.6} {w:+.6}, {:.6e} rad/s", rates[2]);
        assert!((rates[2] * 8.0 * 3600.0 - std::f64::consts::TAU).abs() < 1e-12);
        assert!((x * x + y * y + z * z + w * w - 1.0).abs() < 1e-14);
    }
    assert!(kernel.attitude(head.code, 2.0 * DAY).is_err()); // no data: a typed error
    Ok(())
}
