//! Normal forms about a periodic motion by order and by the number of times N of a coefficient: the planar libration of a body with (B − A)/C = 0.02 on an orbit of
//! eccentricity e (docs/theory-locked.md). `whole` is the periodic motion, its frame and the form; `form` the form alone about the same motion; `trajectory` a state at 100 times.

mod short;

use std::hint::black_box;

use andoyer_benches::{SHAPE, planar};
use andoyer_series::periodic::{DrivenForm, DrivenHamiltonian, DrivenOptions, MOST_WORK};
use andoyer_series::progress::quiet;
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn form(system: &dyn DrivenHamiltonian, order: usize, tolerance: f64) -> DrivenForm {
    let options = DrivenOptions { order, tolerance, harmonics: 252, smallest_divisor: 1e-9, work: MOST_WORK };
    DrivenForm::new(system, &[1.0], options, &mut quiet).expect("no resonance")
}

fn driven(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("driven");
    for (order, eccentricity, tolerance) in [
        (2, 0.05, 1e-10),
        (4, 0.05, 1e-10),
        (6, 0.05, 1e-10),
        (8, 0.05, 1e-10),
        (10, 0.05, 1e-10),
        (8, 0.01, 1e-10),
        (8, 0.2, 1e-10),
        (8, 0.05, 1e-6),
    ] {
        let system = planar(eccentricity, order as u32 + 2);
        let known = form(&system, order, tolerance);
        let id = |name: &str| {
            BenchmarkId::new(format!("order-{order}-e-{eccentricity}-times-{}", known.grid().times()), name.to_owned())
        };
        // √(3 s) on a circle.
        let near = |form: DrivenForm| {
            let frequency = form.modes()[0].frequency().re;
            assert!((frequency / (3.0 * SHAPE).sqrt() - 1.0).abs() < 0.2, "{frequency}");
            form
        };
        group.bench_function(id("whole"), |b| b.iter(|| near(form(&system, black_box(order), tolerance))));
        group.bench_function(id("form"), |b| {
            b.iter(|| near(known.to_order(&system, black_box(order), &mut quiet).expect("no resonance")));
        });
        let times: Vec<f64> = (0..100).map(f64::from).collect();
        group.bench_function(id("trajectory"), |b| {
            b.iter(|| {
                let states = known.trajectory(black_box(&[0.02, 0.0]), &[0.0], &times).expect("a state");
                assert!((states[0][0] - 0.02).abs() < 1e-4);
                states
            });
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = short::short(); targets = driven }
criterion_main!(benches);
