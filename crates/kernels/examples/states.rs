//! States of a body at many times, and how long they took: what `benches/rivals/ephemeris.py` sets beside SpiceyPy and jplephem.
//!
//! `states FILE TARGET OBSERVER`: times as little-endian doubles on the standard input, [seconds of TDB past J2000]; states of six doubles [km, km/s] on the
//! standard output, and on the error output the seconds that they took after a first pass, which opens what is read.

use std::io::{Error, Read, Write, stderr, stdin, stdout};
use std::time::Instant;

use andoyer_kernels::Ephemeris;

fn main() -> Result<(), Error> {
    let [file, target, observer] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().map_err(|_| Error::other("FILE TARGET OBSERVER"))?;
    let [target, observer] = [target, observer].map(|code| code.parse::<i32>().expect("a NAIF code"));
    let mut bytes = Vec::new();
    stdin().read_to_end(&mut bytes)?;
    let times: Vec<f64> =
        bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().expect("eight bytes"))).collect();
    let ephemeris = Ephemeris::open(&[&file]).map_err(Error::other)?;
    let mut states = vec![[0.0; 6]; times.len()];
    let mut seconds = 0.0;
    for _ in 0..2 {
        let started = Instant::now();
        for (state, &time) in states.iter_mut().zip(&times) {
            let ([x, y, z], [u, v, w]) = ephemeris.state(target, observer, time).map_err(Error::other)?;
            *state = [x, y, z, u, v, w];
        }
        seconds = started.elapsed().as_secs_f64();
    }
    let written: Vec<u8> = states.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    stdout().write_all(&written)?;
    writeln!(stderr(), "{seconds}")
}
