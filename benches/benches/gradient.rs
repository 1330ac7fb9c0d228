//! Under a gravity gradient: solving, and evaluating one time after another, by level and averaging, on a circle and on an ellipse.

use std::hint::black_box;

use andoyer_benches::disturbed;
use andoyer_propagate::{Averaging, Level};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const LEVELS: [Level; 3] = [Level::Paper, Level::Moving, Level::Full];
/// Twice in each of 1,000 rotations.
const SAMPLES: usize = 2_000;

fn solve(c: &mut Criterion) {
    let mut group = c.benchmark_group("gradient-solve");
    for level in LEVELS {
        let scene = disturbed(0.1).level(level);
        group.bench_function(BenchmarkId::new(level.to_string(), "averaged"), |b| {
            b.iter(|| {
                let motion = black_box(&scene).solve().expect("averaged");
                assert!(motion.plan().torque() > 0.0);
                motion
            });
        });
    }
    group.finish();
}

fn evaluate(c: &mut Criterion) {
    let mut group = c.benchmark_group("gradient-evaluate");
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(30);
    let times: Vec<f64> = (0..SAMPLES).map(|k| 3.1 * k as f64).collect();
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    for (shape, eccentricity) in [("circle", 0.0), ("ellipse", 0.1)] {
        for averaging in [Averaging::Spin, Averaging::Orbit] {
            for level in LEVELS {
                let motion = disturbed(eccentricity).level(level).averaging(averaging).solve().expect("averaged");
                let batch = motion.batch().threads(1);
                let last = motion.at(times[SAMPLES - 1]).expect("a finite time");
                let id = BenchmarkId::new(format!("{shape}-{level}"), averaging);
                group.bench_function(id, |b| {
                    b.iter(|| {
                        batch.samples_into(black_box(&times), &mut attitudes, &mut rates).expect("finite times");
                        assert!((attitudes[SAMPLES - 1][0] - last.attitude.i).abs() < 2e-15);
                    });
                });
            }
        }
    }
    group.finish();
}

criterion_group!(gradient, solve, evaluate);
criterion_main!(gradient);
