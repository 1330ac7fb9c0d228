//! Normalization by order: exact and symbolic in β, and in `f64` at one β with the direct transformation.

use std::hint::black_box;

use andoyer_series::{NormalForm, NumericNormalForm};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn normalize(c: &mut Criterion) {
    let mut group = c.benchmark_group("normalize");
    group.sample_size(10);
    for order in [5, 10, 20, 30, 40, 50] {
        group.bench_function(BenchmarkId::new(format!("order-{order}"), "exact"), |b| {
            b.iter(|| {
                let normal_form = NormalForm::new(black_box(order)).expect("within the bounds");
                let third = &normal_form.triaxiality_polynomial(3).expect("order ≥ 5")[&2];
                assert_eq!(third.to_string(), "-5/8");
                normal_form
            });
        });
    }
    for order in [5, 10, 12, 20, 30, 40, 60] {
        group.bench_function(BenchmarkId::new(format!("order-{order}"), "f64"), |b| {
            b.iter(|| {
                let normal_form = NumericNormalForm::new(black_box(0.5), order).expect("0 ≤ β ≤ 1");
                assert_eq!(normal_form.triaxiality_polynomials()[3], -0.15625);
                (normal_form.direct(), normal_form.direct_longitude())
            });
        });
    }
    group.finish();
}

criterion_group!(benches, normalize);
criterion_main!(benches);
