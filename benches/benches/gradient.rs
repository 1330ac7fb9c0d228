//! Under a gravity gradient: solving, and evaluating, by level and averaging, on a circle and on an ellipse. The size is orbit and level, the engine the
//! averaging.

mod short;

use std::hint::black_box;

use andoyer_benches::disturbed;
use andoyer_propagate::options::{Averaging, Level};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const LEVELS: [Level; 4] = [Level::Paper, Level::Moving, Level::Full, Level::SecondOrder];
/// Twice in each of 1,000 rotations.
const SAMPLES: usize = 2_000;

const AVERAGINGS: [Averaging; 2] = [Averaging::Spin, Averaging::Orbit];
const ORBITS: [(&str, f64); 2] = [("circle", 0.0), ("ellipse", 0.1)];

fn solve(c: &mut Criterion) {
    let mut group = c.benchmark_group("gradient-solve");
    for (shape, eccentricity) in ORBITS {
        for averaging in AVERAGINGS {
            for level in LEVELS {
                // The average over the orbit is of first order.
                if (averaging, level) == (Averaging::Orbit, Level::SecondOrder) {
                    continue;
                }
                let scene = disturbed(eccentricity).level(level).averaging(averaging);
                group.bench_function(BenchmarkId::new(format!("{shape}-{level}"), averaging), |b| {
                    b.iter(|| {
                        let motion = black_box(&scene).solve().expect("averaged");
                        assert!(motion.plan().torque() > 0.0);
                        motion
                    });
                });
            }
        }
    }
    group.finish();
}

fn evaluate(c: &mut Criterion) {
    let mut group = c.benchmark_group("gradient-evaluate");
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(30);
    let times: Vec<f64> = (0..SAMPLES).map(|k| 3.1 * k as f64).collect();
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    for (shape, eccentricity) in ORBITS {
        for averaging in AVERAGINGS {
            for level in LEVELS {
                // The average over the orbit is of first order.
                if (averaging, level) == (Averaging::Orbit, Level::SecondOrder) {
                    continue;
                }
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

/// The Andoyer variables alone, of the same motions at the highest level.
fn variables(c: &mut Criterion) {
    let mut group = c.benchmark_group("gradient-variables");
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(30);
    let times: Vec<f64> = (0..SAMPLES).map(|k| 3.1 * k as f64).collect();
    let mut variables = vec![[0.0; 6]; SAMPLES];
    for (shape, eccentricity) in ORBITS {
        for averaging in AVERAGINGS {
            let motion = disturbed(eccentricity).averaging(averaging).solve().expect("averaged");
            let last = motion.andoyer(times[SAMPLES - 1]).expect("a finite time");
            group.bench_function(BenchmarkId::new(shape, averaging), |b| {
                b.iter(|| {
                    motion.andoyer_into(black_box(&times), &mut variables).expect("finite times");
                    assert!(variables[SAMPLES - 1].iter().zip(last).all(|(one, other)| (one - other).abs() < 1e-12));
                });
            });
        }
    }
    group.finish();
}

criterion_group! {
    name = gradient;
    config = short::short();
    targets = solve, evaluate, variables
}
criterion_main!(gradient);
