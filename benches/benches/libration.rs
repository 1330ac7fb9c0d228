//! Librations by order and amplitude: the first solution of a body and orbit, the next state of both, and evaluating. The size is orbit, amplitude and order.
//!
//! A solution at an order also has the forms of the orders below, from which its error is estimated.

mod short;

use std::hint::black_box;

use andoyer_benches::locked;
use andoyer_propagate::Orbit;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Twice an orbit.
const SAMPLES: usize = 2_000;
/// Orbit, eccentricity, orders.
const ORBITS: [(&str, f64, &[usize]); 2] = [("circle", 0.0, &[4, 6, 8, 10]), ("ellipse", 0.0549, &[2, 4, 6])];
/// In degrees.
const AMPLITUDES: [f64; 2] = [0.1, 1.0];

/// Calls for each orbit, amplitude and order, with the name of the three.
fn each(mut call: impl FnMut(&str, f64, f64, usize)) {
    for (name, eccentricity, orders) in ORBITS {
        for degrees in AMPLITUDES {
            for &order in orders {
                call(&format!("{name}-{degrees}-deg-order-{order}"), eccentricity, degrees, order);
            }
        }
    }
}

fn solve(c: &mut Criterion) {
    let mut group = c.benchmark_group("libration-solve");
    group.sample_size(10);
    each(|name, eccentricity, degrees, order| {
        let scene = locked(eccentricity, degrees).order(order);
        group.bench_function(BenchmarkId::new(name, "first"), |b| {
            // A process keeps the forms of a body and orbit: each solution has another attraction.
            let mut attraction = 1.0;
            b.iter(|| {
                attraction += 1e-9;
                let orbit = Orbit::new(1.0, eccentricity).and_then(|orbit| orbit.attraction(attraction));
                let scene = scene.clone().disturbing([orbit.expect("an orbit")]);
                let motion = black_box(&scene).solve().expect("a libration");
                assert_eq!(motion.plan().order(), order);
                motion
            });
        });
        let _ = scene.solve().expect("a libration");
        let next = locked(eccentricity, 0.9 * degrees).order(order);
        group.bench_function(BenchmarkId::new(name, "next"), |b| {
            b.iter(|| {
                let motion = black_box(&next).solve().expect("a libration");
                assert_eq!(motion.plan().order(), order);
                motion
            });
        });
    });
    group.finish();
}

fn evaluate(c: &mut Criterion) {
    let mut group = c.benchmark_group("libration-evaluate");
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(30);
    let times: Vec<f64> = (0..SAMPLES).map(|k| 3.1 * k as f64).collect();
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    each(|name, eccentricity, degrees, order| {
        let motion = locked(eccentricity, degrees).order(order).solve().expect("a libration");
        let batch = motion.batch().threads(1);
        let last = motion.at(times[SAMPLES - 1]).expect("a finite time");
        let harmonics = motion.plan().harmonics();
        group.bench_function(BenchmarkId::new(name, format!("{harmonics}-harmonics")), |b| {
            b.iter(|| {
                batch.samples_into(black_box(&times), &mut attitudes, &mut rates).expect("finite times");
                assert!((attitudes[SAMPLES - 1][0] - last.attitude.i).abs() < 1e-13);
            });
        });
    });
    group.finish();
}

criterion_group! {
    name = libration;
    config = short::short();
    targets = solve, evaluate
}
criterion_main!(libration);
