//! One kernel, run so often: what `make gate` counts the instructions of.
//!
//! `kernels NAME REPEATS`. The count of a kernel is the difference between two numbers of repeats, which leaves out the start of the process. One thread, no
//! clock, no random numbers: the same binary always takes the same number of instructions.

use std::hint::black_box;
use std::process::ExitCode;

use andoyer_benches::{bodies, disturbed, locked, planar, triaxial, wobbling};
use andoyer_propagate::{Body, Ensemble, Method, Orbit};
use andoyer_series::periodic::{DrivenForm, DrivenOptions, MOST_WORK};
use andoyer_series::progress::quiet;
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

/// Setting up 64 motions of as many bodies, which differ in each round: their tables are not kept from the round before.
fn solve(method: Method, round: usize) {
    for body in bodies() {
        let [least, middle, greatest] = body.moments();
        let body = Body::new([least, middle * (1.0 + 1e-13 * round as f64), greatest]).expect("a body");
        let motion = wobbling(&body, 0.3).method(method).tolerance(1e-9).solve().expect("a wobble");
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

/// The full equations over 20 rotations with their error bound, and the attitude at the end.
fn integrate() {
    let scene = disturbed(0.1).method(Method::Integrated).span(0.0, 125.0).tolerance(1e-10);
    let motion = scene.solve().expect("an integration");
    assert!(motion.plan().error_bound() < 1e-10);
    black_box(motion.at(125.0).expect("a time"));
}

/// 16 integrated members of an ensemble with their error bounds, at five times each.
fn member() {
    const MEMBERS: usize = 16;
    let orbit = Orbit::new(2e-3, 0.1).expect("an ellipse");
    let rates = (0..MEMBERS).map(|k| [0.006, 0.02, 0.9 + 0.01 * k as f64]).collect();
    let ensemble = Ensemble::new(vec![[1.0, 1.02, 1.05]; MEMBERS], vec![[0.0, 0.0, 0.0, 1.0]; MEMBERS], rates);
    let ensemble = ensemble.and_then(|members| members.orbits(vec![Some(orbit); MEMBERS])).expect("members");
    let ensemble = ensemble.method(Method::Integrated).span(0.0, 125.0).tolerance(1e-10).threads(1);
    let mut attitudes = [[0.0; 4]; 5 * MEMBERS];
    ensemble.attitudes_into(black_box(&[0.0, 30.0, 60.0, 90.0, 125.0]), &mut attitudes).expect("integrated");
}

/// Derivatives at 20 times: of a free motion in closed form, and of an integrated one by variational equations.
fn derivatives() {
    let times: [f64; 20] = std::array::from_fn(|k| 6.0 * k as f64);
    let (mut attitudes, mut rates) = ([[[0.0; 9]; 3]; 20], [[[0.0; 9]; 3]; 20]);
    for scene in [triaxial(), disturbed(0.1).method(Method::Integrated).span(0.0, 125.0).tolerance(1e-10)] {
        let motion = scene.solve().expect("a motion");
        motion.partials_into(black_box(&times), &mut attitudes, &mut rates).expect("derivatives");
    }
}

/// A libration of 2 degrees on a circle over 1,000 orbits, order 6.
fn libration() {
    let motion = locked(0.0, 2.0).order(6).solve().expect("a libration");
    assert_eq!(motion.plan().method(), Method::Libration);
}

/// The form of order 6 about the periodic planar libration on an orbit of eccentricity 0.05.
fn periodic() {
    let options = DrivenOptions { order: 6, tolerance: 1e-10, harmonics: 252, smallest_divisor: 1e-9, work: MOST_WORK };
    let form = DrivenForm::new(&planar(0.05, 8), &[1.0], black_box(options), &mut quiet).expect("no resonance");
    assert_eq!(form.modes().len(), 1);
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let (Some(name), Some(Ok(repeats))) = (arguments.next(), arguments.next().map(|text| text.parse::<usize>())) else {
        return ExitCode::from(2);
    };
    for round in 0..repeats {
        match name.as_str() {
            "normalize" => normalize(),
            "numeric" => numeric(),
            "solve-closed" => solve(Method::Closed, round),
            "solve-series" => solve(Method::Series, round),
            "evaluate" => evaluate(),
            "integrate" => integrate(),
            "member" => member(),
            "derivatives" => derivatives(),
            "libration" => libration(),
            "periodic" => periodic(),
            _ => return ExitCode::from(2),
        }
    }
    ExitCode::SUCCESS
}
