//! Derivatives of attitude and rates against differences of a solution in multiple precision (tests/data/README.md), and what holds of them exactly.

use andoyer_propagate::nalgebra::{SMatrix, UnitQuaternion, Vector3};
use andoyer_propagate::partials::{Derivatives, Partials};
use andoyer_propagate::{Body, Error, Motion, Orbit, Scene, State};
use serde_json::Value;

const REFERENCE: &str = include_str!("../data/partials.json");
/// Rounding of some twenty operations, over what they are divided by: Q1 = cos²J where it is least, and C/B − 1 (A/B − 1 in the long-axis mode).
const ROUNDING: f64 = 4e-15;

type Matrix = SMatrix<f64, 6, 9>;

struct Case {
    name: String,
    moments: [f64; 3],
    attitude: [f64; 4],
    rates: [f64; 3],
    states: Vec<(f64, [Derivatives; 2])>,
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|i| value[i].as_f64().expect("a number"))
}

fn cases() -> Vec<Case> {
    let file: Value = serde_json::from_str(REFERENCE).expect("JSON");
    let rows = |value: &Value| std::array::from_fn(|row| numbers(&value[row]));
    let state = |value: &Value| {
        (value["t"].as_f64().expect("a time"), [rows(&value["attitude"]), rows(&value["angular_velocity"])])
    };
    let case = |value: &Value| Case {
        name: value["name"].as_str().expect("a name").to_owned(),
        moments: numbers(&value["moments"]),
        attitude: numbers(&value["attitude0_xyzw"]),
        rates: numbers(&value["angular_velocity0"]),
        states: value["states"].as_array().expect("states").iter().map(state).collect(),
    };
    file.as_array().expect("cases").iter().map(case).collect()
}

fn motion(moments: [f64; 3], attitude: [f64; 4], rates: [f64; 3]) -> Motion {
    let state = State::new(0.0, attitude, rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state).solve().expect("a motion")
}

/// Q1 and C/B − 1 of a state, with the axes in the order of its mode; 1 where rotation is steady.
fn divisors(moments: [f64; 3], rates: [f64; 3]) -> [f64; 2] {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    let momentum: Vec<f64> = (0..3).map(|i| moments[i] * rates[i]).collect();
    let total: f64 = momentum.iter().map(|g| g * g).sum();
    let place = |order: [usize; 3]| {
        let [a, b, c] = order.map(|axis| moments[axis]);
        let [g1, _, g3] = order.map(|axis| momentum[axis] * momentum[axis] / total);
        let (first, second) = ((c - a) / a, (c - b) / b);
        (second != 0.0).then(|| [g3 - g1 * (first - second) / second, second.abs()])
    };
    let reversed = [order[2], order[1], order[0]];
    let found = [place(order), place(reversed)].into_iter().flatten().find(|[least, _]| *least > 0.0);
    if momentum.iter().filter(|g| **g != 0.0).count() < 2 { [1.0; 2] } else { found.unwrap_or([1.0; 2]) }
}

/// Largest difference, over the largest entry.
fn error(found: &Derivatives, expected: &Derivatives) -> f64 {
    let pairs = found.iter().flatten().zip(expected.iter().flatten());
    let most = pairs.fold(0.0_f64, |most, (a, b)| if a.is_finite() { most.max((a - b).abs()) } else { f64::INFINITY });
    most / expected.iter().flatten().fold(0.0_f64, |most, entry| most.max(entry.abs()))
}

#[test]
fn derivatives_are_those_of_the_solution_in_multiple_precision_for_a_thousand_million_rotations() {
    let cases = cases();
    for case in &cases {
        let motion = motion(case.moments, case.attitude, case.rates);
        let [least, excess] = divisors(case.moments, case.rates);
        let bound = ROUNDING * (1.0 / least).max(1.0 / excess);
        for (time, [attitude, rates]) in &case.states {
            let partials = motion.partials(*time).unwrap_or_else(|problem| panic!("{}: {problem}", case.name));
            let errors = [error(&partials.attitude, attitude), error(&partials.angular_velocity, rates)];
            assert!(errors[0].max(errors[1]) <= bound, "{} at {time}: {errors:?} above {bound}", case.name);
        }
    }
    assert_eq!(cases.len(), 26);
}

/// Rows: attitude, then rates.
fn matrix(partials: &Partials) -> Matrix {
    Matrix::from_fn(|row, column| match row {
        0..3 => partials.attitude[row][column],
        _ => partials.angular_velocity[row - 3][column],
    })
}

/// Moments and rates of both modes and of neither, with no axis in its place.
const BODIES: [([f64; 3], [f64; 3]); 7] = [
    ([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]),
    ([2.1, 1.0, 1.5], [-1.0, 0.5, 0.6]),
    ([1.0, 3.0836, 3.235], [1.3, 0.2, 0.3]),
    ([3.235, 3.0836, 1.0], [0.3, 0.2, -1.3]),
    ([17.09, 71.79, 74.49], [0.02, 0.01, 1.0]),
    ([1.5, 1.0, 1.0], [0.7, 0.3, -0.2]),
    ([1.0, 1.5, 2.0], [0.0, 0.0, 1.0]),
];
const ATTITUDE: [f64; 4] = [0.1, -0.5, 0.7, 0.5];

#[test]
fn the_block_of_the_state_keeps_the_symplectic_form() {
    // −d(G·R⁻¹dR) of two changes: δG2·δθ1 − δG1·δθ2 + G·(δθ1 × δθ2), G = I ω.
    for (moments, rates) in BODIES {
        let inertia = Vector3::from(moments);
        let motion = motion(moments, ATTITUDE, rates);
        let form = |rates: Vector3<f64>, one: &Matrix, columns: [usize; 2]| {
            let [first, second] = columns.map(|column| {
                let change = one.column(column);
                (change.fixed_rows::<3>(0).into_owned(), inertia.component_mul(&change.fixed_rows::<3>(3)))
            });
            second.1.dot(&first.0) - first.1.dot(&second.0)
                + inertia.component_mul(&rates).dot(&first.0.cross(&second.0))
        };
        for time in [0.3, 7.0, -55.0] {
            let now = matrix(&motion.partials(time).expect("a time"));
            let rates_now = motion.at(time).expect("a time").angular_velocity;
            let start = matrix(&motion.partials(0.0).expect("the epoch"));
            let size = now.amax() * now.amax() * inertia.amax();
            for columns in (0..6).flat_map(|i| (0..i).map(move |j| [i, j])) {
                let lost = form(rates_now, &now, columns) - form(Vector3::from(rates), &start, columns);
                assert!(lost.abs() <= 1e-14 * size, "{moments:?} at {time}: {columns:?} {lost:e}");
            }
        }
    }
}

#[test]
fn derivatives_from_a_later_epoch_on_multiply() {
    for (moments, rates) in BODIES {
        let whole = motion(moments, ATTITUDE, rates);
        let middle = whole.at(3.7).expect("a time");
        let state = State { epoch: 3.7, attitude: middle.attitude, angular_velocity: middle.angular_velocity };
        let rest = Scene::new(Body::new(moments).expect("a body"), state).solve().expect("a motion");
        let [first, second, both] = [whole.partials(3.7), rest.partials(41.0), whole.partials(41.0)]
            .map(|partials| matrix(&partials.expect("a time")));
        let mut expected = second.fixed_columns::<6>(0) * first;
        let mut by_moments = expected.fixed_columns_mut::<3>(6);
        by_moments += second.fixed_columns::<3>(6);
        let lost = (expected - both).amax() / (first.amax() * second.amax());
        // The state at the middle is rounded, and its derivatives change with it by as much as the time: 1e-16 times 40 rotations.
        assert!(lost <= 1e-13, "{moments:?}: {lost:e}");
    }
}

#[test]
fn derivatives_at_the_epoch_are_the_unit_matrix() {
    for (moments, rates) in BODIES {
        let start = matrix(&motion(moments, ATTITUDE, rates).partials(0.0).expect("the epoch"));
        let expected = Matrix::from_fn(|row, column| if row == column { 1.0 } else { 0.0 });
        assert!((start - expected).amax() <= 1e-14, "{start}");
    }
}

#[test]
fn a_body_at_rest_turns_by_a_rate_times_the_time() {
    let partials = motion([1.0, 1.5, 2.0], ATTITUDE, [0.0; 3]).partials(5.0).expect("a time");
    let expected = Matrix::from_fn(|row, column| match column {
        _ if row == column => 1.0,
        3..6 if row == column - 3 => 5.0,
        _ => 0.0,
    });
    assert_eq!(matrix(&partials), expected);
}

#[test]
fn units_scale_derivatives_by_powers_of_two_and_change_no_bit() {
    let (moments, rates) = BODIES[0];
    let (mass, clock) = (2.0_f64.powi(300), 2.0_f64.powi(-200));
    let one = motion(moments, ATTITUDE, rates).partials(13.0).expect("a time");
    let other = motion(moments.map(|x| x * mass), ATTITUDE, rates.map(|x| x * clock)).partials(13.0 / clock);
    let other = other.expect("a time");
    for row in 0..3 {
        for column in 0..9 {
            let unit = [1.0, 1.0 / clock, 1.0 / mass][column / 3];
            assert_eq!(other.attitude[row][column], one.attitude[row][column] * unit);
            assert_eq!(other.angular_velocity[row][column], one.angular_velocity[row][column] * unit * clock);
        }
    }
}

#[test]
fn many_times_are_computed_as_one() {
    let motion = motion(BODIES[2].0, ATTITUDE, BODIES[2].1);
    let times: Vec<f64> = (0..101).map(|k| 0.37 * f64::from(k)).collect();
    let mut outputs = [vec![[[0.0; 9]; 3]; times.len()], vec![[[0.0; 9]; 3]; times.len()]];
    let [attitudes, rates] = &mut outputs;
    motion.partials_into(&times, attitudes, rates).expect("times");
    for (index, time) in times.iter().enumerate() {
        let one = motion.partials(*time).expect("a time");
        assert_eq!((one.attitude, one.angular_velocity), (attitudes[index], rates[index]));
    }
}

#[test]
fn the_separatrix_and_the_middle_axis_have_errors_that_say_why() {
    // C (C−B) ω3² = A (B−A) ω1², in doubles without rounding: 12 = 3·2².
    let falling = motion([3.0, 4.0, 6.0], ATTITUDE, [2.0, 0.5, 1.0]);
    assert!(matches!(falling.partials(1.0), Err(Error::SeparatrixPartials)));
    let middle = motion([1.0, 1.5, 2.0], ATTITUDE, [0.0, 1.0, 0.0]);
    let Err(Error::Time { bound, .. }) = middle.partials(1e4) else { panic!("no bound") };
    assert!(middle.partials(0.999 * bound).expect("within the bound").attitude.iter().flatten().all(|x| x.is_finite()));
    let mut short = [[[0.0; 9]; 3]];
    let length = middle.partials_into(&[0.0, 1.0], &mut [[[0.0; 9]; 3]; 2], &mut short);
    assert!(matches!(length, Err(Error::Length { argument: "rates", found: 1, expected: 2 })));
}

fn with_orbit(moments: [f64; 3], attitude: [f64; 4], rates: [f64; 3], mean_motion: f64) -> Motion {
    let orbit = Orbit::new(mean_motion, 0.1).expect("an orbit");
    let state = State::new(0.0, attitude, rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state).orbit(orbit).solve().expect("a motion")
}

#[test]
fn derivatives_under_a_gravity_gradient_become_those_of_free_rotation_with_its_torque() {
    let (moments, rates) = ([1.0, 1.02, 1.05], [0.02, 0.01, 1.0]);
    let free = matrix(&motion(moments, ATTITUDE, rates).partials(100.0).expect("a time"));
    let far = |mean_motion| {
        let disturbed = with_orbit(moments, ATTITUDE, rates, mean_motion).partials(100.0).expect("a time");
        (matrix(&disturbed) - free).amax() / free.amax()
    };
    // The torque goes with the square of the mean motion; without the torque, only the error of the differences remains.
    assert!(far(1e-6) <= 1e-9, "{:e}", far(1e-6));
    assert!((far(2e-3) / far(1e-3) - 4.0).abs() <= 0.4, "{:e} {:e}", far(2e-3), far(1e-3));
}

#[test]
fn derivatives_under_a_gravity_gradient_predict_a_neighbouring_motion() {
    let (moments, rates, time) = ([1.0, 1.02, 1.05], [0.02, 0.01, 1.0], 500.0);
    let base = with_orbit(moments, ATTITUDE, rates, 2e-3);
    let partials = base.partials(time).expect("a time");
    let start = base.at(time).expect("a time").attitude;
    // Sixth-order central difference with steps of its own.
    let stencil = [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)];
    for parameter in 0..9 {
        let step = if parameter < 3 { 3e-2 } else { 2e-5 };
        let turned = |multiple: f64| {
            let (mut attitude, mut rates, mut moments) =
                (UnitQuaternion::new_normalize(ATTITUDE.into()), rates, moments);
            let change = multiple * step;
            match parameter {
                0..3 => attitude *= UnitQuaternion::from_scaled_axis(Vector3::ith(parameter, change)),
                3..6 => rates[parameter - 3] += change,
                _ => moments[parameter - 6] += change,
            }
            let neighbour = with_orbit(moments, attitude.coords.into(), rates, 2e-3).at(time).expect("a time");
            (start.inverse() * neighbour.attitude).scaled_axis()
        };
        let difference = stencil
            .iter()
            .fold(Vector3::zeros(), |sum, (multiple, weight)| sum + (turned(*multiple) - turned(-*multiple)) * *weight)
            / (60.0 * step);
        for row in 0..3 {
            let lost = (difference[row] - partials.attitude[row][parameter]).abs();
            let size = if parameter < 3 { 1.0 } else { time };
            assert!(lost <= 2e-8 * size, "parameter {parameter}: {lost:e}");
        }
    }
}

/// The reference is an integration in 60 digits, differentiated by differences.
#[test]
fn derivatives_after_a_turnover_from_the_middle_axis_keep_their_digits() {
    let body = Body::new([0.5015501476127431, 0.8048640411418888, 1.0]).expect("a body");
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [7.75e-10, 1.33573, -5.70e-10]).expect("a state");
    let motion = Scene::new(body, state).solve().expect("solved");
    // With respect to the rates and the moments, 3.3 time units before the body is at the middle axis again.
    let reference = [
        [
            4.0670475085114495,
            4.688159079641289e-07,
            -3.6176403505655186,
            -6.315891656112353e-07,
            -2.1056370805404282e-07,
            4.862487962251221e-07,
        ],
        [
            -3.5002337303172636e-08,
            -90.1,
            5.068507859141647e-08,
            2.272185836685855,
            -3.616761333386605,
            1.7713860008418942,
        ],
        [
            2.7369140840270965,
            -4.192872317002996e-07,
            -2.5661917932512948,
            -3.487081803200268e-07,
            -1.340480356505971e-07,
            2.82785082994152e-07,
        ],
    ];
    let partials = motion.partials(90.1).expect("partials");
    for (found, reference) in partials.attitude.iter().zip(reference) {
        for (found, reference) in found[3..].iter().zip(reference) {
            assert!((found - reference).abs() <= 1e-9 * reference.abs(), "{found:e} {reference:e}");
        }
    }
}
