//! Solving by order; evaluating by harmonics, outputs and kind of times.

use std::hint::black_box;

use andoyer_benches::triaxial;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const ORDERS: [usize; 9] = [1, 2, 4, 8, 12, 16, 20, 30, 40];
const EVALUATED_ORDERS: [usize; 3] = [1, 4, 40];
const SAMPLES: usize = 100_000;

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
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(30);
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    // What no evaluation can beat.
    group.bench_function(BenchmarkId::new("attitudes-and-rates", "store-only"), |b| {
        b.iter(|| {
            attitudes.fill(black_box([1.0; 4]));
            rates.fill(black_box([1.0; 3]));
        });
    });
    group.bench_function(BenchmarkId::new("rates", "store-only"), |b| b.iter(|| rates.fill(black_box([1.0; 3]))));
    let uniform: Vec<f64> = (0..SAMPLES).map(|k| 0.00628 * k as f64).collect();
    // The golden ratio's multiples: spread over the same span, no two steps in a row alike.
    let uneven: Vec<f64> = (0..SAMPLES).map(|k| 628.0 * (0.618_033_988_749_894_9 * k as f64).fract()).collect();
    for order in EVALUATED_ORDERS {
        let motion = triaxial().order(order).solve().expect("short-axis");
        let batch = motion.batch().threads(1);
        for (grid, times) in [("uniform", &uniform), ("uneven", &uneven)] {
            let last = motion.at(times[SAMPLES - 1]).expect("a finite time");
            let size = |outputs: &str| format!("harmonics-{}-{grid}-{outputs}", motion.plan().harmonics());
            group.bench_function(BenchmarkId::new(size("attitudes-and-rates"), "series"), |b| {
                b.iter(|| {
                    batch.samples_into(black_box(times), &mut attitudes, &mut rates).expect("finite times");
                    assert!((attitudes[SAMPLES - 1][0] - last.attitude.i).abs() < 2e-15);
                });
            });
            group.bench_function(BenchmarkId::new(size("attitudes"), "series"), |b| {
                b.iter(|| {
                    batch.attitudes_into(black_box(times), &mut attitudes).expect("finite times");
                    assert!((attitudes[SAMPLES - 1][0] - last.attitude.i).abs() < 2e-15);
                });
            });
            group.bench_function(BenchmarkId::new(size("rates"), "series"), |b| {
                b.iter(|| {
                    batch.angular_velocities_into(black_box(times), &mut rates).expect("finite times");
                    assert!((rates[SAMPLES - 1][0] - last.angular_velocity.x).abs() < 2e-15);
                });
            });
        }
    }
    group.finish();
}

fn evaluate_one(c: &mut Criterion) {
    let motion = triaxial().solve().expect("short-axis");
    let mut group = c.benchmark_group("evaluate");
    group.bench_function(BenchmarkId::new("one-time", "series"), |b| {
        b.iter(|| {
            let sample = motion.at(black_box(0.3)).expect("a finite time");
            assert!(sample.angular_velocity.x < 1.0);
            sample
        });
    });
    group.finish();
}

criterion_group!(benches, solve, evaluate, evaluate_one);
criterion_main!(benches);
