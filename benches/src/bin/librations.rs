//! The cost of one libration, as a line of numbers: `librations ECCENTRICITY ORDER DEGREES` (benches/libration_cost.py has each in a process of its own, for its memory).
//!
//! eccentricity, order, degrees, first solution [s], next state [s], harmonics, sample [ns], memory kept [MiB], peak memory [MiB], error, estimate [rad]. Times are those of
//! the processor, of all threads.

#![expect(clippy::print_stdout, reason = "a command that prints what it measures")]

use andoyer_benches::locked;
use andoyer_propagate::{Method, Motion};

const SAMPLES: u32 = 2_000;
/// A short measurement is repeated for so long.
const LEAST_SECONDS: f64 = 0.2;
const MOST_REPEATS: f64 = 1e5;

/// A value of /proc/self/status in MiB, where there is one.
fn status(name: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_default();
    let number = line.split_whitespace().nth(1).and_then(|kib| kib.parse::<f64>().ok());
    number.map_or(f64::NAN, |kib| kib / 1024.0)
}

/// Processor time of all threads of this process \[s\], where Linux counts it.
fn seconds() -> f64 {
    let folder = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let of = |path: std::path::PathBuf| {
        let text = std::fs::read_to_string(path.join("schedstat")).unwrap_or_default();
        text.split_whitespace().next().and_then(|number| number.parse::<f64>().ok()).unwrap_or_default()
    };
    folder.map(|entry| of(entry.path())).sum::<f64>() * 1e-9
}

/// The mean time of calls \[s\], and the last result. They are repeated because the system counts the time in steps of some milliseconds.
fn timed<T>(mut call: impl FnMut() -> T) -> (f64, T) {
    let start = seconds();
    let mut repeats = 0.0;
    loop {
        let result = call();
        repeats += 1.0;
        let spent = seconds() - start;
        if spent > LEAST_SECONDS || repeats >= MOST_REPEATS {
            return (spent / repeats, result);
        }
    }
}

fn main() {
    let numbers: Vec<f64> = std::env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let [eccentricity, order, degrees] = numbers[..] else {
        println!("librations ECCENTRICITY ORDER DEGREES");
        return;
    };
    let scene = locked(eccentricity, degrees).order(order as usize);
    let before = status("VmRSS");
    let start = seconds();
    let solved = scene.solve();
    let first = seconds() - start;
    let motion = match solved {
        Ok(motion) => motion,
        Err(error) => {
            println!("{eccentricity},{order},{degrees},{first:.4},,,,,,,{error}");
            return;
        }
    };
    let (kept, peak) = (status("VmRSS") - before, status("VmHWM"));
    let state = locked(eccentricity, 0.97 * degrees).order(order as usize);
    let (next, _) = timed(|| state.solve());
    let (_, stop) = scene.asked_span().unwrap_or_default();
    let times: Vec<f64> = (0..SAMPLES).map(|k| stop * f64::from(k) / f64::from(SAMPLES)).collect();
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; times.len()], vec![[0.0; 3]; times.len()]);
    let batch = motion.batch().threads(1);
    let (evaluated, _) = timed(|| batch.samples_into(&times, &mut attitudes, &mut rates));
    let truth = scene.clone().method(Method::Integrated).tolerance(1e-12).solve();
    let error = truth.map_or(f64::NAN, |truth| difference(&motion, &truth, stop));
    println!(
        "{eccentricity},{order},{degrees},{first:.4},{next:.5},{},{:.0},{kept:.1},{peak:.1},{error:.1e},{:.1e}",
        motion.plan().harmonics(),
        evaluated / f64::from(SAMPLES) * 1e9,
        motion.plan().error_bound()
    );
}

/// The largest difference of two motions at 41 times from 0.
fn difference(one: &Motion, two: &Motion, stop: f64) -> f64 {
    let at = |motion: &Motion, time: f64| motion.at(time).map(|sample| sample.attitude);
    let angle = |k: u32| {
        let time = stop * f64::from(k) / 40.0;
        at(one, time).and_then(|one| Ok(one.angle_to(&at(two, time)?))).unwrap_or(f64::NAN)
    };
    (0..=40).map(angle).fold(0.0, f64::max)
}
