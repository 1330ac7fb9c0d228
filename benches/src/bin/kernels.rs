//! One kernel, run so often: what `make gate` counts the instructions of.
//!
//! `kernels NAME REPEATS`. The count of a kernel is the difference between two numbers of repeats, which leaves out the start of the process. One thread, no
//! clock, no random numbers: the same binary always takes the same number of instructions.

use std::hint::black_box;
use std::process::ExitCode;

use andoyer_benches::{bodies, triaxial, wobbling};
use andoyer_propagate::Method;
use andoyer_series::{NormalForm, NumericNormalForm};

const SAMPLES: usize = 10_000;

/// The exact normal form of order 20.
fn normalize() {
    let form = NormalForm::new(black_box(20)).expect("within the bounds");
    assert_eq!(form.order(), 20);
}

/// The forms in doubles at β = ½, order 30, with the direct transformation.
fn numeric() {
    let form = NumericNormalForm::<f64>::new(black_box(0.5), 30).expect("0 ≤ β ≤ 1");
    assert!(!form.direct().is_empty() && !form.direct_longitude().is_empty());
}

/// Setting up 64 motions of as many bodies.
fn solve(method: Method) {
    for body in &bodies() {
        let motion = wobbling(body, 0.3).method(method).tolerance(1e-9).solve().expect("a wobble");
        assert!(motion.plan().error_bound() < 1e-9);
    }
}

/// Attitudes and rates of one motion at 10,000 uneven times.
fn evaluate() {
    let motion = triaxial().solve().expect("a wobble");
    let times: Vec<f64> = (0..SAMPLES).map(|k| 628.0 * (0.618_033_988_749_894_9 * k as f64).fract()).collect();
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    motion.batch().threads(1).samples_into(black_box(&times), &mut attitudes, &mut rates).expect("finite times");
    let norm: f64 = attitudes[SAMPLES - 1].iter().map(|c| c * c).sum();
    assert!((norm - 1.0).abs() < 1e-14);
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let (Some(name), Some(Ok(repeats))) = (arguments.next(), arguments.next().map(|text| text.parse::<usize>())) else {
        return ExitCode::from(2);
    };
    for _ in 0..repeats {
        match name.as_str() {
            "normalize" => normalize(),
            "numeric" => numeric(),
            "solve-closed" => solve(Method::Closed),
            "solve-series" => solve(Method::Series),
            "evaluate" => evaluate(),
            _ => return ExitCode::from(2),
        }
    }
    ExitCode::SUCCESS
}
