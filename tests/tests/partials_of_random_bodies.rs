//! Derivatives of 300 random bodies, 100 of them next to a limit, and of 48 inertia tensors, against differences of a solution in multiple precision
//! (tests/data/README.md).

use andoyer_propagate::partials::Derivatives;
use andoyer_propagate::{Body, Error, Motion, Orbit, Scene, State};

const BY_MOMENTS: &str = include_str!("../data/partials_moments.txt");
const BY_TENSORS: &str = include_str!("../data/partials_tensors.txt");
const ATTITUDE: [f64; 4] =
    [0.182_574_185_835_055_36, 0.365_148_371_670_110_7, 0.547_722_557_505_166_1, 0.730_296_743_340_221_4];
/// The files have twelve digits, and no error of the derivatives but rounding is expected. A tensor's principal moments are rounded too, which 200 units of time
/// make 1e-13.
const BOUND: f64 = 2e-11;

fn motion(body: Body, rates: &[f64]) -> Motion {
    let state = State::new(0.0, ATTITUDE, [rates[0], rates[1], rates[2]]).expect("a state");
    Scene::new(body, state).solve().expect("a motion")
}

fn tensor(elements: &[f64]) -> [[f64; 3]; 3] {
    let [a, b, c, p, q, r] = elements else { panic!("six elements") };
    [[*a, *p, *q], [*p, *b, *r], [*q, *r, *c]]
}

/// Numbers of a line: those of the body, rates, time, derivatives.
fn lines(text: &str) -> impl Iterator<Item = Vec<f64>> {
    text.lines().map(|line| line.split(' ').map(|number| number.parse().expect("a number")).collect())
}

/// Largest difference in the three blocks of columns: attitude, rates, body. Each is relative to its largest entry, or to 1, the size of rates and moments.
fn error<const N: usize>(found: &[Derivatives<N>; 2], expected: &[f64]) -> f64 {
    let (attitudes, rates) = expected.split_at(3 * N);
    let expected = |matrix: usize, row: usize, column: usize| match (matrix, column) {
        (0, _) => attitudes[N * row + column],
        (_, 0..3) => 0.0,
        _ => rates[(N - 3) * row + column - 3],
    };
    let mut worst = 0.0_f64;
    for (matrix, derivatives) in found.iter().enumerate() {
        for block in [0..3, 3..6, 6..N] {
            let entries = || (0..3).flat_map(|row| block.clone().map(move |column| (row, column)));
            let size = entries().fold(1.0_f64, |size, (row, column)| size.max(expected(matrix, row, column).abs()));
            for (row, column) in entries() {
                let lost = (derivatives[row][column] - expected(matrix, row, column)).abs() / size;
                worst = if lost <= worst { worst } else { lost };
            }
        }
    }
    worst
}

#[test]
fn derivatives_of_300_bodies_are_those_in_multiple_precision_next_to_every_limit() {
    let mut ways = [0, 0];
    for (index, line) in lines(BY_MOMENTS).enumerate() {
        let body = Body::new([line[0], line[1], line[2]]).expect("a body");
        let motion = motion(body, &line[3..6]);
        let partials = motion.partials(line[6]).expect("a time");
        let lost = error(&[partials.attitude, partials.angular_velocity], &line[7..]);
        assert!(lost <= BOUND, "line {}: {lost:e}, {:?}", index + 1, &line[..7]);
        ways[usize::from(motion.plan().partials() == Some("series"))] += 1;
    }
    assert_eq!(ways[0] + ways[1], 300);
    // All bodies next to a sphere or the middle axis, and those next to A = B or B = C whose polhode is slow.
    assert!((50..100).contains(&ways[1]), "{ways:?}");
}

#[test]
fn derivatives_of_tensors_are_those_in_multiple_precision() {
    let mut count = 0;
    for (index, line) in lines(BY_TENSORS).enumerate() {
        let motion = motion(Body::from_inertia(tensor(&line[..6])).expect("a body"), &line[6..9]);
        let partials = motion.inertia_partials(line[9]).expect("a time");
        let lost = error(&[partials.attitude, partials.angular_velocity], &line[10..]);
        assert!(lost <= BOUND, "line {}: {lost:e}, {:?}", index + 1, &line[..10]);
        count += 1;
    }
    assert_eq!(count, 48);
}

#[test]
fn a_common_factor_of_the_moments_has_no_effect_next_to_a_sphere() {
    for moments in [[1.0, 1.0 - f64::EPSILON / 2.0, 1.0], [1.0, 1.0 + 1e-13, 1.0 - 2e-13]] {
        let motion = motion(Body::new(moments).expect("a body"), &[0.5, 0.3, 1.0]);
        assert_eq!(motion.plan().partials(), Some("series"));
        let partials = motion.partials(48.0).expect("a time");
        for row in partials.attitude.iter().chain(&partials.angular_velocity) {
            let common: f64 = (0..3).map(|i| moments[i] * row[6 + i]).sum();
            assert!(common.abs() <= 1e-13, "{moments:?}: {common:e}");
        }
    }
}

#[test]
fn many_times_next_to_a_sphere_are_computed_as_one_from_any_epoch() {
    let body = Body::new([1.0, 1.0 + 1e-6, 1.0 + 3e-6]).expect("a body");
    let state = State::new(1e9, ATTITUDE, [0.5, 0.3, 1.0]).expect("a state");
    let motion = Scene::new(body, state).solve().expect("a motion");
    let times: Vec<f64> = (-40..40).map(|k| 1e9 + 3e5 * f64::from(k)).collect();
    let zero = [[0.0; 9]; 3];
    let (mut attitudes, mut rates) = (vec![zero; times.len()], vec![zero; times.len()]);
    motion.partials_into(&times, &mut attitudes, &mut rates).expect("times");
    let (mut since, mut since_rates) = (vec![zero; times.len()], vec![zero; times.len()]);
    let elapsed: Vec<f64> = times.iter().map(|time| time - 1e9).collect();
    motion.batch().since_epoch().partials_into(&elapsed, &mut since, &mut since_rates).expect("times");
    assert_eq!((&attitudes, &rates), (&since, &since_rates));
    for (index, time) in times.iter().enumerate() {
        let one = motion.partials(*time).expect("a time");
        assert_eq!((one.attitude, one.angular_velocity), (attitudes[index], rates[index]));
    }
}

#[test]
fn elements_of_a_tensor_have_the_derivatives_of_the_principal_moments_along_the_axes() {
    let body = Body::from_inertia([[1.0, 0.1, -0.2], [0.1, 1.5, 0.3], [-0.2, 0.3, 2.0]]).expect("a body");
    let axes = body.principal_axes();
    let motion = motion(body, &[0.3, -0.2, 1.0]);
    let [by_moments, by_tensor] = [motion.partials(30.0).expect("a time").attitude.map(|row| row.to_vec()), {
        motion.inertia_partials(30.0).expect("a time").attitude.map(|row| row.to_vec())
    }];
    for row in 0..3 {
        for moment in 0..3 {
            let a = axes.column(moment);
            let weights = [a[0] * a[0], a[1] * a[1], a[2] * a[2], a[0] * a[1], a[0] * a[2], a[1] * a[2]];
            let along: f64 = (0..6).map(|element| weights[element] * by_tensor[row][6 + element]).sum();
            assert!((along - by_moments[row][6 + moment]).abs() <= 1e-13, "{along:e}");
        }
    }
}

#[test]
fn variational_equations_with_respect_to_a_tensor_are_the_closed_form_where_the_torque_vanishes() {
    let elements = [[1.0, 0.01, -0.02], [0.01, 1.05, 0.015], [-0.02, 0.015, 1.12]];
    let free = motion(Body::from_inertia(elements).expect("a body"), &[0.02, 0.01, 1.0]);
    let expected = free.inertia_partials(100.0).expect("a time");
    let far = Orbit::new(1e-7, 0.1).expect("an orbit");
    let state = *free.scene().state();
    let disturbed = Scene::new(free.scene().body().clone(), state).orbit(far).solve().expect("a motion");
    assert_eq!(disturbed.plan().partials(), Some("variational"));
    let found = disturbed.inertia_partials(100.0).expect("a time");
    let rows = |partials: [[f64; 12]; 3]| partials.into_iter().flatten();
    let size = rows(expected.attitude).fold(0.0_f64, |size, entry| size.max(entry.abs()));
    let lost = rows(found.attitude).zip(rows(expected.attitude)).fold(0.0_f64, |lost, (a, b)| lost.max((a - b).abs()));
    assert!(lost <= 1e-12 * size, "{lost:e} of {size:e}");
}

#[test]
fn a_tensor_has_the_errors_of_the_moments() {
    let turned = |moments: [f64; 3], rates: [f64; 3]| {
        let [a, b, c] = moments;
        motion(Body::from_inertia([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]).expect("a body"), &rates)
    };
    let falling = turned([3.0, 4.0, 6.0], [2.0, 0.5, 1.0]);
    assert!(matches!(falling.inertia_partials(1.0), Err(Error::SeparatrixPartials)));
    let middle = turned([1.0, 1.5, 2.0], [0.0, 1.0, 0.0]);
    assert!(matches!(middle.inertia_partials(1e5), Err(Error::Time { .. })));
    let rest = turned([1.0, 1.5, 2.0], [0.0; 3]).inertia_partials(5.0).expect("a time");
    assert_eq!(rest.attitude[1], [0.0, 1.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
}
