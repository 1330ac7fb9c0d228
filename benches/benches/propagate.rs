//! Solving and evaluating by order.

use std::hint::black_box;

use andoyer_benches::triaxial;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const ORDERS: [usize; 9] = [1, 2, 4, 8, 12, 16, 20, 30, 40];
const SAMPLES: usize = 1000;

fn solve(c: &mut Criterion) {
    let mut group = c.benchmark_group("solve");
    for order in ORDERS {
        let scene = triaxial().order(order);
        group.bench_function(BenchmarkId::new(format!("order-{order}"), "series"), |b| {
            b.iter(|| {
                let motion = black_box(&scene).solve().expect("short-axis");
                assert_eq!(motion.plan().order(), order);
                motion
            });
        });
    }
    group.finish();
}

fn evaluate(c: &mut Criterion) {
    let mut group = c.benchmark_group("evaluate");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    let times: Vec<f64> = (0..SAMPLES).map(|k| 0.6283 * k as f64).collect();
    for order in ORDERS {
        let motion = triaxial().order(order).solve().expect("short-axis");
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
        group.bench_function(BenchmarkId::new(format!("order-{order}"), "series"), |b| {
            b.iter(|| {
                motion.samples_into(black_box(&times), &mut attitudes, &mut rates).expect("finite times");
                let norm: f64 = attitudes[SAMPLES - 1].iter().map(|c| c * c).sum();
                assert!((norm - 1.0).abs() < 1e-14);
            });
        });
    }
    group.finish();
}

criterion_group!(benches, solve, evaluate);
criterion_main!(benches);
