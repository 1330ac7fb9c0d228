//! Normalization by order. Engines: `energy` is the exact normal form as `NormalForm::new` computes it, `triangle` the same through the
//! generic algebra over rationals, `f64` and `double-double` the one at β = ½ with its direct transformation.

mod short;

use std::hint::black_box;

use andoyer_double::DoubleDouble;
use andoyer_series::forms::Real;
use andoyer_series::lie::{Normalization, deprit_triangle};
use andoyer_series::progress::quiet;
use andoyer_series::rigid_body::{hamiltonian, homological, poisson};
use andoyer_series::{Monomial, NormalForm, NumericNormalForm};
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, criterion_group, criterion_main};
use num_rational::BigRational;

fn energy(group: &mut BenchmarkGroup<'_, WallTime>) {
    for order in [5, 10, 15, 20, 30, 40, 50] {
        group.bench_function(BenchmarkId::new(format!("order-{order}"), "energy"), |b| {
            b.iter(|| {
                let normal_form = NormalForm::new(black_box(order)).expect("within the bounds");
                let third = &normal_form.triaxiality_polynomial(3).expect("order ≥ 5")[&2];
                assert_eq!(third.to_string(), "-5/8");
                normal_form
            });
        });
    }
}

fn exact_triangle(order: usize) -> Normalization<BigRational> {
    let hamiltonian = hamiltonian().expect("characteristic 0");
    let (homological, poisson) = (homological().expect("two slots"), poisson().expect("two slots"));
    deprit_triangle(&hamiltonian, &homological, &poisson, order, &mut quiet).expect("within the bounds")
}

fn triangle(group: &mut BenchmarkGroup<'_, WallTime>) {
    // k_3 τ³ (w w̄)⁴ with k_3 = P_3/2.
    let third = Monomial::new(&[4, 4, 3, 2]).expect("small exponents");
    for order in [5, 10, 15, 20] {
        group.bench_function(BenchmarkId::new(format!("order-{order}"), "triangle"), |b| {
            b.iter(|| {
                let normalization = exact_triangle(black_box(order));
                let kernel: Vec<_> = normalization.hamiltonian[3].terms().collect();
                assert_eq!(kernel, [(third, &BigRational::new((-5).into(), 16.into()))]);
                normalization
            });
        });
    }
}

fn numeric<C: Real + From<f64>>(group: &mut BenchmarkGroup<'_, WallTime>, engine: &str, orders: &[usize]) {
    for &order in orders {
        group.bench_function(BenchmarkId::new(format!("order-{order}"), engine), |b| {
            b.iter(|| {
                let normal_form = NumericNormalForm::<C>::new(black_box(0.5).into(), order).expect("0 ≤ β ≤ 1");
                assert_eq!(normal_form.triaxiality_polynomials()[3].to_f64(), -0.15625);
                (normal_form.direct(), normal_form.direct_longitude())
            });
        });
    }
}

fn by_order(c: &mut Criterion) {
    let mut group = c.benchmark_group("normalize");
    group.sample_size(10);
    energy(&mut group);
    triangle(&mut group);
    numeric::<f64>(&mut group, "f64", &[5, 10, 12, 20, 30, 40, 60]);
    numeric::<DoubleDouble>(&mut group, "double-double", &[12, 30, 60]);
    group.finish();
}

criterion_group! {
    name = benches;
    config = short::short();
    targets = by_order
}
criterion_main!(benches);
