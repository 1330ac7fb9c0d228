//! Solving by order; evaluating by harmonics, outputs and kind of times.

mod short;

use std::hint::black_box;

use andoyer_benches::{bodies, triaxial, wobbling};
use andoyer_propagate::{Body, Method, Mode, Motion, Scene, State};
use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

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

/// The same by order, and by tolerance with the closed form beside the series.
fn evaluate_by(c: &mut Criterion) {
    let mut group = c.benchmark_group("evaluate");
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(20);
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    let uneven: Vec<f64> = (0..SAMPLES).map(|k| 628.0 * (0.618_033_988_749_894_9 * k as f64).fract()).collect();
    let mut kinds: Vec<_> =
        ORDERS.map(|order| (format!("order-{order}"), "series", triaxial().order(order))).into_iter().collect();
    for digits in [3, 6, 9, 12, 15] {
        let scene = triaxial().tolerance(10_f64.powi(-digits)).span(0.0, 628.0);
        kinds.push((format!("tolerance-1e-{digits}"), "closed", scene.clone().method(Method::Closed)));
        // The series do not hold 1e-15 at this σ/σ_sep: rounding rules.
        if digits < 15 {
            kinds.push((format!("tolerance-1e-{digits}"), "series", scene.method(Method::Series)));
        }
    }
    for (size, engine, scene) in &kinds {
        let motion = scene.solve().expect("short-axis");
        group.bench_function(BenchmarkId::new(size, engine), |b| {
            b.iter(|| {
                motion.batch().threads(1).samples_into(black_box(&uneven), &mut attitudes, &mut rates).expect("finite");
                assert!((norm(&attitudes[SAMPLES - 1]) - 1.0).abs() < 1e-12);
                assert!(momentum(&motion, &rates[SAMPLES - 1]) < 1e-2 || motion.plan().order() < 2);
            });
        });
    }
    group.finish();
}

/// The closed form at one time and at up to a million uneven times.
fn evaluate_counts(c: &mut Criterion) {
    let motion = triaxial().solve().expect("short-axis");
    let mut group = c.benchmark_group("evaluate");
    group.sample_size(20);
    for count in [1, 10, 100, 10_000, 1_000_000] {
        let times: Vec<f64> = (0..count).map(|k| 628.0 * (0.618_033_988_749_894_9 * k as f64).fract()).collect();
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; count], vec![[0.0; 3]; count]);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::new(format!("times-{count}"), "closed"), |b| {
            b.iter(|| {
                motion.batch().threads(1).samples_into(black_box(&times), &mut attitudes, &mut rates).expect("finite");
                assert!((norm(&attitudes[count - 1]) - 1.0).abs() < 1e-12);
            });
        });
    }
    group.finish();
}

/// Solving for a body whose tables of the series are known, and for one that has none.
fn set_up(c: &mut Criterion) {
    let mut group = c.benchmark_group("set-up");
    let bodies = bodies();
    let scenes = |method| -> Vec<_> { bodies.iter().map(|body| wobbling(body, 0.3).method(method)).collect() };
    let ordered = |order: usize| -> Vec<_> { bodies.iter().map(|body| wobbling(body, 0.3).order(order)).collect() };
    let mut kinds = vec![
        ("tolerance-1e-12".to_owned(), "closed", scenes(Method::Closed)),
        ("tolerance-1e-12".to_owned(), "series", scenes(Method::Series)),
    ];
    kinds.extend([8, 20, 40].map(|order| (format!("order-{order}"), "series", ordered(order))));
    for (size, engine, scenes) in &kinds {
        scenes.iter().for_each(|scene| drop(solved(scene)));
        let mut next = scenes.iter().cycle();
        group.bench_function(BenchmarkId::new(format!("body-seen-{size}"), engine), |b| {
            b.iter(|| solved(next.next().expect("a cycle")));
        });
        // The tables belong to all digits of β.
        let (mut next, mut count) = (scenes.iter().cycle(), 0);
        let mut new_body = || {
            count += 1;
            let scene = next.next().expect("a cycle");
            let [least, middle, greatest] = scene.body().moments();
            let body = Body::new([least, middle * (1.0 + 1e-13 * f64::from(count)), greatest]).expect("a body");
            let fresh = Scene::new(body, *scene.state()).method(scene.asked_method());
            scene.asked_order().map_or(fresh.clone(), |order| fresh.order(order))
        };
        group.bench_function(BenchmarkId::new(format!("body-new-{size}"), engine), |b| {
            b.iter_batched(&mut new_body, |scene| solved(&scene), BatchSize::SmallInput);
        });
    }
    group.finish();
}

fn solved(scene: &Scene) -> Motion {
    let motion = black_box(scene).solve().expect("a wobble");
    let plan = motion.plan();
    assert!(plan.mode() == Mode::ShortAxis && (0.1..=0.3).contains(&plan.separatrix_ratio()));
    motion
}

/// What each thing costs that a scene may not need.
fn skip(c: &mut Criterion) {
    let mut group = c.benchmark_group("skip");
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(30);
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    let uneven: Vec<f64> = (0..SAMPLES).map(|k| 628.0 * (0.618_033_988_749_894_9 * k as f64).fract()).collect();
    let uniform: Vec<f64> = (0..SAMPLES).map(|k| 0.00628 * k as f64).collect();
    let whole = triaxial().solve().expect("a wobble");
    let size = whole.angular_momentum();
    group.bench_function("outputs-attitudes/closed", |b| {
        b.iter(|| {
            whole.batch().threads(1).attitudes_into(black_box(&uneven), &mut attitudes).expect("finite times");
            assert!((norm(&attitudes[SAMPLES - 1]) - 1.0).abs() < 1e-14);
        });
    });
    group.bench_function("outputs-rates/closed", |b| {
        b.iter(|| {
            whole.batch().threads(1).angular_velocities_into(black_box(&uneven), &mut rates).expect("finite times");
            assert!(momentum(&whole, &rates[SAMPLES - 1]) < 1e-14);
        });
    });
    group.bench_function("outputs-angular-momenta/closed", |b| {
        b.iter(|| {
            whole.angular_momenta_into(black_box(&uneven), &mut rates).expect("finite times");
            assert_eq!(rates[SAMPLES - 1], <[f64; 3]>::from(size));
        });
    });
    let mut variables = vec![[0.0; 6]; SAMPLES];
    let last = whole.andoyer(uneven[SAMPLES - 1]).expect("a finite time");
    group.bench_function("outputs-andoyer-variables/closed", |b| {
        b.iter(|| {
            whole.andoyer_into(black_box(&uneven), &mut variables).expect("finite times");
            assert!(variables[SAMPLES - 1].iter().zip(last).all(|(one, other)| (one - other).abs() < 1e-12));
        });
    });
    let state = || State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.4, 0.6, 0.9]).expect("a state");
    let of = |moments| Scene::new(Body::new(moments).expect("a body"), state());
    let kinds = [
        ("outputs-attitudes-and-rates", triaxial(), &uneven),
        ("times-uniform", triaxial(), &uniform),
        ("tolerance-1e-6", triaxial().tolerance(1e-6), &uneven),
        ("tolerance-1e-15", triaxial().tolerance(1e-15), &uneven),
        ("body-oblate", of([0.75, 0.75, 1.0]), &uneven),
        ("body-sphere", of([1.0, 1.0, 1.0]), &uneven),
    ];
    for (what, scene, times) in kinds {
        let motion = scene.solve().expect("a motion");
        group.bench_function(BenchmarkId::new(what, "closed"), |b| {
            b.iter(|| {
                let batch = motion.batch().threads(1);
                batch.samples_into(black_box(times), &mut attitudes, &mut rates).expect("finite times");
                assert!((norm(&attitudes[SAMPLES - 1]) - 1.0).abs() < 1e-14);
                assert!(momentum(&motion, &rates[SAMPLES - 1]) < 1e-14);
            });
        });
    }
    group.finish();
}

fn norm<const N: usize>(row: &[f64; N]) -> f64 {
    row.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// How far the angular momentum of these rates is from that of the motion, relative.
fn momentum(motion: &Motion, rates: &[f64; 3]) -> f64 {
    let moments = motion.scene().body().moments();
    let whole = norm(&[0, 1, 2].map(|i| moments[i] * rates[i]));
    (whole / motion.angular_momentum().norm() - 1.0).abs()
}

criterion_group! {
    name = benches;
    config = short::short();
    targets = solve, evaluate, evaluate_by, evaluate_counts, set_up, skip
}
criterion_main!(benches);
