use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use pulp::Arch;

use super::dense::Cursor;
use super::expansion::Equations;
use super::integrated::Integrated;
use super::integrator::{Precision, Step};
use super::problem::Problem;
use super::products::NEXT;
use super::prospect::prospect;
use super::series::{Row, norm};
use super::step_errors::moved;
use crate::error::{Error, STEP_BYTES};
use crate::input::options::Served;
use crate::motion::forced::Forced;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch_few};
use crate::{Body, Method, Orbit, Scene, State};

fn scene(moments: [f64; 3], rates: [f64; 3]) -> Scene {
    let state = State::new(3.0, [0.1, -0.2, 0.3, 0.86_f64.sqrt()], rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state)
}

#[test]
fn a_step_takes_the_bytes_that_the_error_says() {
    assert_eq!(size_of::<Step>() as f64, STEP_BYTES);
}

#[test]
fn a_compact_motion_has_the_same_bits_in_a_tenth_of_the_memory() {
    let orbit = Orbit::new(0.3, 0.4).expect("an orbit").secular_rates(0.01, -0.02).expect("rates");
    let scene = scene([0.5, 0.8, 1.0], [0.3, 0.5, 1.0]).orbit(orbit).span(-40.0, 60.0);
    let kept = Integrated::new(&scene, "", (Served::WholeSpan, &AtomicBool::new(false))).expect("a motion");
    let mut compact = kept.clone();
    compact.compact();
    let whole = compact.whole().expect("the coefficients");
    let whole = whole.as_any().downcast_ref::<Integrated>().expect("an integrated motion");
    assert!(10 * compact.memory() < kept.memory() && kept.whole().is_none() && whole.whole().is_none());
    assert!(kept.sides.iter().zip(&whole.sides).all(|(one, other)| one.coefficients == other.coefficients));
    let (mut one, mut other) = (Cursor::new(&kept), Cursor::new(&compact));
    for k in 0..=400 {
        let time = -43.0 + 0.25 * f64::from(k);
        assert_eq!(one.at((time, 0.0)), other.at((time, 0.0)));
    }
}

#[test]
fn an_integration_is_repeated_with_shorter_steps_only_if_truncation_errors_keep_it_from_its_tolerance() {
    // Rounding errors grow to 1e-9 in the first motion; the second turns about its middle axis.
    let chaotic = ([0.9, 0.995, 1.0], [0.05, -0.03, 1.01], 129.0, false);
    let unstable = ([0.5, 0.8, 1.0], [0.01, 1.0, 0.01], 30.0, true);
    for (moments, rates, stop, repeated) in [chaotic, unstable] {
        let orbit = Orbit::new(1.0, 0.05).and_then(|orbit| orbit.plane(0.5, 1.0, 2.0)).expect("an orbit");
        let scene = scene(moments, rates).orbit(orbit).span(3.0, stop).tolerance(1e-10);
        let first = Precision::of(Problem::new(&scene, "").expect("a problem").first_error());
        let motion = Integrated::new(&scene, "", (Served::WholeSpan, &AtomicBool::new(false))).expect("a motion");
        assert_eq!(motion.order() > first.order, repeated, "{moments:?}: {:e}", motion.error);
        assert!(repeated || motion.error > 1e-10, "{:e}", motion.error);
    }
}

#[test]
fn the_integrals_of_the_free_motion_drift_by_twice_the_relative_error_of_the_rates() {
    let free = scene([1.0, 1.5, 2.0], [0.1, 0.2, 1.0]).span(0.0, 500.0).method(Method::Integrated);
    let motion = Integrated::new(&free, "", (Served::WholeSpan, &AtomicBool::new(false))).expect("a motion");
    let [first, last] = [&motion.sides[1].steps[0], &motion.sides[1].steps[motion.sides[1].steps.len() - 1]];
    let equations = Equations::new(&free, 0, 1.0);
    // Along the motion the energy and the angular momentum stay; with rates 1e-9 larger the largest integral, f2 ω1² − f1 ω2² or another, changes by 2e-9 of
    // it.
    assert!(equations.drift(&first.rates, &last.rates) < 1e-14);
    let wrong = last.rates.map(|rate| rate * (1.0 + 1e-9));
    let drift = equations.drift(&first.rates, &wrong);
    assert!(drift > 1e-9 && drift < 2.001e-9, "{drift:e}");
}

/// Fast rotations of random bodies under a weak torque, over 30 to 1,600 radians, as the theory serves them.
fn random_scenes(count: usize) -> impl Iterator<Item = Scene> {
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    let mut uniform = move |from: f64, to: f64| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        from + (to - from) * (random >> 11) as f64 / 2.0_f64.powi(53)
    };
    (0..count).map(move |_| {
        let [middle, span] = [uniform(0.55, 0.99), 10.0_f64.powf(uniform(1.5, 3.2))];
        let least = uniform(1.02 - middle, middle - 0.02);
        let rates = [uniform(-0.2, 0.2), uniform(-0.2, 0.2), 1.0];
        let orbit = Orbit::new(uniform(1e-3, 3e-2), uniform(0.0, 0.3))
            .and_then(|orbit| orbit.plane(uniform(0.0, 3.0), 1.0, 2.0))
            .expect("an orbit");
        scene([least, middle, 1.0], rates).orbit(orbit).span(0.0, span)
    })
}

#[test]
fn the_guess_of_the_bound_is_near_the_bound_and_not_above_it_in_the_median() {
    let mut ratios: Vec<f64> = random_scenes(30)
        .map(|scene| {
            let (guess, steps) = prospect(&scene).expect("a guess");
            let motion = Integrated::new(&scene.tolerance(1e-15), "", (Served::WholeSpan, &AtomicBool::new(false)))
                .expect("a motion");
            assert!(motion.plan(0.0).steps as f64 <= 1.3 * steps, "{} and {steps}", motion.plan(0.0).steps);
            guess / motion.error
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    eprintln!("guess / bound: {:.2} {:.2} {:.2} {:.2} {:.2}", ratios[0], ratios[2], ratios[15], ratios[27], ratios[29]);
    assert!(ratios[15] > 0.4 && ratios[15] <= 1.0, "{}", ratios[15]);
    assert!(ratios[2] > 0.1 && ratios[27] < 3.0, "{} {}", ratios[2], ratios[27]);
}

#[test]
fn the_bound_is_above_the_error_where_the_growing_part_of_two_displacements_cancels() {
    // The error is 2.6e-13 rad, from heyoka in 80-bit reals. With the first two displacements alone the bound was 1.1e-13 rad.
    let body = Body::new([0.6202456483879164, 0.635177999441624, 1.0]).expect("a body");
    let attitude = [-0.5313757539174283, 0.8341287700229608, -0.12382792437491055, -0.08084335664523602];
    let rates = [-0.6601261343167897, -2.513909762957775, 2.0898569550164714];
    let orbit = Orbit::new(1.0, 0.8155727155073406);
    let orbit = orbit.and_then(|orbit| orbit.plane(1.4677893172430838, 3.1874226752304695, 4.598141704624689));
    let scene = Scene::new(body, State::new(0.0, attitude, rates).expect("a state")).orbit(orbit.expect("an orbit"));
    let scene = scene.span(0.0, 10.170380595942394).tolerance(1e-10);
    let motion = Integrated::new(&scene, "", (Served::WholeSpan, &AtomicBool::new(false))).expect("a motion");
    assert!(motion.error > 2.6e-13 && motion.error < 1e-10, "{:e}", motion.error);
}

#[test]
fn the_bound_of_a_locked_rotation_has_the_rounding_errors_of_series_that_cancel() {
    // Matrix and direction turn by a radian in a step, and the direction in the body hardly moves. z and w of the attitude at the epoch and after 6283 rad, from heyoka
    // in 80-bit reals (`Reference` of benches/rivals/integration.py): librations of 1° to 9°.
    for [z, w, last_z, last_w] in [
        [0.008726535498373935, 0.9999619230641713, -0.096957780672375, 0.9952884952450157],
        [0.020069938783589036, 0.9997985784932998, -0.1124065880917924, 0.9936622962322572],
        [0.03489949670250097, 0.9993908270190958, -0.058760842420918925, 0.9982720888605391],
        [0.043619387365336, 0.9990482215818578, -0.11490035624256453, 0.9933770221498642],
        [0.06104853953485687, 0.9981347984218669, -0.12403911920149056, 0.9922773286272938],
        [0.07845909572784494, 0.996917333733128, -0.1300063591603588, 0.9915131600628747],
    ] {
        let state = State::new(0.0, [0.0, 0.0, z, w], [0.0, 0.0, 1.0]).expect("a state");
        let scene = Scene::new(Body::new([0.85, 0.95, 1.0]).expect("a body"), state);
        let scene = scene.orbit(Orbit::new(1.0, 0.0).expect("an orbit")).span(0.0, 6283.0);
        for tolerance in [1e-8, 1e-16] {
            let motion =
                Integrated::new(&scene.clone().tolerance(tolerance), "", (Served::WholeSpan, &AtomicBool::new(false)));
            let motion = motion.expect("a motion");
            let found = Cursor::new(&motion).at((6283.0, 0.0)).0;
            let error = 2.0 * norm(&[found[0], found[1], found[2] - last_z, found[3] - last_w]);
            assert!(error < motion.error && motion.error < 1e-10, "{z}: {error:e} and {:e}", motion.error);
        }
    }
}

/// Two states with their lanes in the order of the next ones.
struct Reordered;

impl Task for Reordered {
    type Output = [f64; 8];

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> [f64; 8] {
        simd.in_order::<NEXT, 8>(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
    }
}

#[test]
fn lanes_have_the_same_order_in_every_instruction_set() {
    for arch in [Arch::Scalar, Arch::new()] {
        assert_eq!(dispatch_few(arch, Reordered), [1.0, 2.0, 0.0, 3.0, 5.0, 6.0, 4.0, 7.0]);
    }
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V4::try_new() {
        assert_eq!(Reordered.run(simd), dispatch_few(Arch::Scalar, Reordered));
    }
}

#[test]
fn states_that_are_moved_to_a_motion_keep_the_direction_of_their_difference_and_their_norm() {
    let (middle, w): ([Row; 2], f64) = ([[0.0, 0.0, 0.6, 0.8], [0.1, 0.2, 1.0, 0.0]], (1.0 - 0.0004 - 0.36_f64).sqrt());
    let states = [[[0.02, 0.0, 0.6, w], [0.1, 0.3, 1.0, 0.0]], [[0.0, -0.02, 0.6, w], [0.1, 0.2, 0.9, 0.0]]];
    let [[one, _], [other, _]] = moved(&states, [&middle[0], &middle[1]], 0.1);
    // Differences of 0.02 are 0.002 now, and the mean is the middle.
    for (found, exact) in one.iter().chain(&other).zip([0.001, 0.001, 0.6, 0.8, -0.001, -0.001, 0.6, 0.8]) {
        assert!((found - exact).abs() < 3e-6, "{one:?} {other:?}");
    }
    for attitude in [one, other] {
        assert!((attitude.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn a_chaotic_motion_ends_soon_after_the_time_from_which_on_nothing_is_known() {
    // Hyperion, wobbling.
    let orbit = Orbit::new(1.0, 0.123).expect("an orbit");
    let chaotic = scene([0.579, 0.875, 1.0], [0.1, 0.2, 1.4]).orbit(orbit).span(3.0, 1e5).tolerance(1e-8);
    let (problem, going) = (Problem::new(&chaotic, "").expect("a problem"), AtomicBool::new(false));
    let precision = Precision::of(problem.first_error());
    let ((side, _), profile) = problem.while_known(1, precision, &going).expect("a motion");
    let profile = profile.expect("half a turn");
    let (known, lost) = (profile.iter().rfind(|(_, bound)| *bound < PI).expect("a known part").0, profile.last());
    let end = side.steps[side.steps.len() - 1].time.0;
    assert!(lost.is_some_and(|(_, bound)| *bound == PI) && known > 50.0 && end < 5e3, "{known} {end}");
    // The whole integration has thirty times as many steps, of which these are the first.
    let (whole, _) = problem.steps(1, precision, &going).expect("a motion");
    assert!(whole.steps.len() > 30 * side.steps.len(), "{} and {}", whole.steps.len(), side.steps.len());
    assert!(side.steps.iter().zip(&whole.steps).all(|(one, other)| same(one, other)));
    // What is refused says this time.
    let refused = Integrated::new(&chaotic, "", (Served::WholeSpan, &going)).expect_err("chaos");
    assert!(matches!(refused, Error::Unpredictable { known: [first, last], .. } if first == 3.0 && last > 50.0));
    // So does a span of 1.8 times the allowed steps: a shorter one would be refused too.
    let refused = Integrated::new(&chaotic.span(3.0, 2.3e6), "", (Served::WholeSpan, &going)).expect_err("chaos");
    assert!(matches!(refused, Error::Unpredictable { known: [_, last], .. } if last > 50.0), "{refused}");
}

#[test]
fn a_motion_of_known_attitude_has_the_steps_that_it_has_without_judgements() {
    let fast = scene([0.5, 0.8, 1.0], [0.1, 0.2, 1.0]).orbit(Orbit::new(0.01, 0.1).expect("an orbit"));
    let problem = Problem::new(&fast.span(3.0, 3e4).tolerance(1e-6), "").expect("a problem");
    let (precision, going) = (Precision::of(problem.first_error()), AtomicBool::new(false));
    let ((judged, _), lost) = problem.while_known(1, precision, &going).expect("a motion");
    let (whole, _) = problem.steps(1, precision, &going).expect("a motion");
    assert!(lost.is_none() && whole.steps.len() > 1 << 15 && judged.steps.len() == whole.steps.len());
    assert!(judged.coefficients == whole.coefficients);
    assert!(judged.steps.iter().zip(&whole.steps).all(|(one, other)| same(one, other)));
}

/// Whether two steps begin with the same bits.
fn same(one: &Step, other: &Step) -> bool {
    (one.time, one.attitude, one.rates) == (other.time, other.attitude, other.rates)
}
