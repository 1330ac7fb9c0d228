//! Normal forms about a periodic motion by order and by the number of times N of a coefficient: the planar libration of a body with (B − A)/C = 0.02 on an orbit of
//! eccentricity e (docs/theory-locked.md). `whole` is the periodic motion, its frame and the form; `form` the form alone about the same motion; `trajectory` a state at 100 times.

mod short;

use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;

use andoyer_propagate::Orbit;
use andoyer_series::periodic::{DrivenForm, DrivenHamiltonian, DrivenOptions, SampledHamiltonian};
use andoyer_series::progress::quiet;
use andoyer_series::{Error, Monomial};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

const SHAPE: f64 = 0.02;

/// p²/2 − (3/4) s (a/ρ)³ cos 2(ψ + M − f) about ψ = 0, p = 1.
fn planar(eccentricity: f64, degree: u32) -> impl DrivenHamiltonian {
    let orbit = Orbit::new(1.0, eccentricity).and_then(|orbit| orbit.semi_major_axis(1.0)).expect("an ellipse");
    SampledHamiltonian::new(1, move |phases: &[f64]| {
        let [x, y, _] = orbit.position(phases[0]).expect("a time");
        let (cube, angle) = (x.hypot(y).powi(-3), 2.0 * (phases[0] - y.atan2(x)));
        let mut factor = 1.0;
        let slopes = (1..=degree).map(|k| {
            factor *= 2.0 / f64::from(k);
            // The k-th derivative of the cosine.
            let slope = (angle + f64::from(k) * FRAC_PI_2).cos();
            Ok((Monomial::new(&[k, 0])?, -0.75 * SHAPE * cube * factor * slope))
        });
        std::iter::once(Ok((Monomial::new(&[0, 2])?, 0.5))).chain(slopes).collect::<Result<Vec<_>, Error>>()
    })
}

fn form(system: &dyn DrivenHamiltonian, order: usize, tolerance: f64) -> DrivenForm {
    let options = DrivenOptions { order, tolerance, harmonics: 252, smallest_divisor: 1e-9 };
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
