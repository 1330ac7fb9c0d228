//! Many bodies at a few epochs each: set-up, attitudes and rates of all, by members × epochs and threads.

mod short;

use std::hint::black_box;

use andoyer_propagate::Ensemble;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Members and epochs of each.
const SIZES: [(usize, usize); 3] = [(1000, 1), (1000, 10), (100_000, 10)];
const THREADS: [usize; 2] = [1, 2];

/// Bodies and rates spread evenly over all modes.
fn ensemble(members: usize) -> Ensemble {
    let part = |k: usize, step: f64| (k as f64 * step).fract();
    let moments = (0..members).map(|k| [0.55 + 0.4 * part(k, 0.618), 0.55 + 0.4 * part(k, 0.414), 1.0]).collect();
    let rates = (0..members).map(|k| [part(k, 0.732) - 0.5, part(k, 0.236) - 0.5, part(k, 0.141)]).collect();
    Ensemble::new(moments, vec![[0.0, 0.0, 0.0, 1.0]; members], rates).expect("bodies and states")
}

fn evaluate(c: &mut Criterion) {
    let mut group = c.benchmark_group("ensemble");
    group.sample_size(10);
    for (members, epochs) in SIZES {
        group.throughput(Throughput::Elements(members as u64));
        let times: Vec<f64> = (0..epochs).map(|k| 100.0 * k as f64).collect();
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; members * epochs], vec![[0.0; 3]; members * epochs]);
        for threads in THREADS {
            let ensemble = ensemble(members).threads(threads);
            group.bench_function(BenchmarkId::new(format!("{members}x{epochs}"), threads), |b| {
                b.iter(|| {
                    ensemble.samples_into(black_box(&times), &mut attitudes, &mut rates).expect("solved");
                    let norm: f64 = attitudes[members * epochs - 1].iter().map(|c| c * c).sum();
                    assert!((norm - 1.0).abs() < 1e-14);
                });
            });
        }
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = short::short();
    targets = evaluate
}
criterion_main!(benches);
