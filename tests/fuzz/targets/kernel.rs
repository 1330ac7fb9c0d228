//! Any bytes as an SPK file and as a binary PCK: an error, or finite states.
#![no_main]

use std::io::Cursor;

use andoyer_kernels::{Ephemeris, Orientations};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: Vec<u8>| {
    let times = [0.0, 1e5, 1e6, 2.6e6, -1e9];
    let mut ephemeris = Ephemeris::open::<&str>(&[]).expect("no files");
    if ephemeris.load("fuzz.bsp", Cursor::new(bytes.clone())).is_ok() {
        let bodies: Vec<i32> = ephemeris.segments().take(8).map(|segment| segment.body).collect();
        for (&body, time) in bodies.iter().flat_map(|body| times.map(|time| (body, time))) {
            if let Ok((position, velocity)) = ephemeris.state(body, 399, time) {
                assert!(position.iter().chain(&velocity).all(|value| !value.is_nan()));
            }
        }
    }
    let mut orientations = Orientations::open::<&str>(&[]).expect("no files");
    if orientations.load("fuzz.bpc", Cursor::new(bytes)).is_ok() {
        let bodies: Vec<i32> = orientations.segments().take(8).map(|segment| segment.body).collect();
        for (&body, time) in bodies.iter().flat_map(|body| times.map(|time| (body, time))) {
            if let Ok((attitude, _)) = orientations.attitude(body, time) {
                assert!((attitude.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-12);
            }
        }
    }
});
