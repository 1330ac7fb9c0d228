//! Motion on the separatrix and beside it, and what is next to the axis of middle inertia (theory §5, §10).

use andoyer_propagate::{Body, Method, Mode, Motion, Scene, State};
use andoyer_tests::{attitude_error, cases, difference};

const BESIDE: &str = include_str!("../data/separatrix.json");
const LEVEL: [f64; 4] = [0.0, 0.0, 0.0, 1.0];
/// (C−B) C ω3² = (B−A) A ω1², with ω2 not 0.
const ON_IT: [([f64; 3], [f64; 3]); 3] = [
    ([5.0, 41.0, 45.0], [1.0, 1.0, 1.0]),
    ([252.0, 257.0, 320.0], [4.0, 1.0, 1.0]),
    ([3.0, 53.0, 54.0], [3.0, 1.0, 5.0]),
];

fn scene(moments: [f64; 3], rates: [f64; 3]) -> Scene {
    Scene::new(Body::new(moments).expect("a body"), State::new(0.0, LEVEL, rates).expect("a state"))
}

fn energy(moments: [f64; 3], rates: [f64; 3]) -> f64 {
    moments.iter().zip(rates).map(|(moment, rate)| moment * rate * rate).sum()
}

fn finite_and_as_the_invariants_say(motion: &Motion, time: f64) {
    let (moments, start) = (motion.scene().body().moments(), motion.scene().state().angular_velocity.into());
    let sample = motion.at(time).expect("finite");
    let rates: [f64; 3] = sample.angular_velocity.into();
    assert!((sample.attitude.coords.norm() - 1.0).abs() < 1e-15, "{time}: {sample:?}");
    assert!((energy(moments, rates) / energy(moments, start) - 1.0).abs() < 1e-14, "{time}: {rates:?}");
}

#[test]
fn a_state_on_the_separatrix_is_recognised_as_such_and_has_a_bound_that_time_leaves_alone() {
    // Q1 with its factors divided was off by 1e-32 instead of 0: the passage came back, or was NaN from 1e2 units on, and the bound was π.
    for (moments, rates) in ON_IT {
        for axes in [[0, 1, 2], [1, 2, 0], [2, 1, 0], [0, 2, 1]] {
            let motion = scene(axes.map(|axis| moments[axis]), axes.map(|axis| rates[axis])).solve().expect("served");
            assert_eq!(motion.plan().mode(), Mode::Separatrix, "{moments:?}");
            assert!(motion.plan().error_bound() < 1e-13, "{moments:?}: {}", motion.plan());
            for time in [-1e6, -400.0, 0.0, 3.0, 400.0, 1e6, 1e9] {
                finite_and_as_the_invariants_say(&motion, time);
            }
            let late: [f64; 3] = motion.at(1e6).expect("finite").angular_velocity.into();
            let middle = (moments.iter().zip(rates).map(|(i, w)| (i * w).powi(2)).sum::<f64>()).sqrt() / moments[1];
            let fastest = late.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
            assert!((fastest / middle - 1.0).abs() < 1e-14, "{late:?}");
        }
    }
}

#[test]
fn a_passage_whose_distance_from_the_separatrix_is_rounding_ends_and_says_what_it_does_not_see() {
    // Moments and rates times odd numbers of forty bits: terms of 200 bits, equal, and Q1 a rounding error. An infinite ξ with a nonzero nome gave NaN.
    for (moments, rates) in ON_IT {
        for (large, odd) in [(1_234_567_890_123.0, 987_654_321_987.0), (1_099_511_627_777.0, 1_000_000_000_001.0)] {
            let scene = scene(moments.map(|moment| moment * large), rates.map(|rate| rate * odd / 2.0_f64.powi(40)));
            assert!(scene.clone().span(0.0, 5.0).solve().expect("served").plan().error_bound() < 1e-13);
            let motion = scene.solve().expect("served");
            assert_eq!(motion.plan().mode(), Mode::Separatrix);
            for time in [-1e8, -400.0, 0.0, 40.0, 400.0, 1e6, 1e9] {
                finite_and_as_the_invariants_say(&motion, time);
            }
        }
    }
}

#[test]
fn motions_beside_the_separatrix_are_within_their_bound_up_to_a_thousand_million_rotations() {
    let cases = cases(BESIDE);
    for case in &cases {
        let state = State::new(0.0, case.attitude, case.angular_velocity).expect("a state");
        let motion =
            Scene::new(Body::new(case.moments).expect("a body"), state).tolerance(1e-15).solve().expect("served");
        let mode = if case.name.starts_with("short") { Mode::ShortAxis } else { Mode::LongAxis };
        assert_eq!((motion.plan().mode(), motion.plan().method()), (mode, Method::Closed), "{}", case.name);
        let bound = motion.plan().error_bound();
        for &(time, attitude, rates) in &case.states {
            let sample = motion.at(time).expect("finite");
            let error = attitude_error(sample.attitude.coords.into(), attitude);
            assert!(error <= bound, "{} at {time}: {error}, bound {bound}", case.name);
            // Sums 18 times what is left of them, each of 23 harmonics rounded; conditioning is nothing in a million rotations.
            assert!(time > 1e6 || error <= 2e-14, "{} at {time}: {error}", case.name);
            let size = case.angular_velocity.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
            let off = difference(sample.angular_velocity.into(), rates) / size;
            assert!(off <= 3.0 * bound, "{} at {time}: rates off by {off}", case.name);
        }
        // Conditioning: 1e-31, twice 1/(1−m), and a half turn of the polhode in each of six to fifteen rotations.
        assert!(bound < 3e-13 || case.name.ends_with("-38") || case.name.ends_with("-46"), "{}: {bound}", case.name);
    }
    assert_eq!(cases.len(), 14);
}

#[test]
fn a_passage_that_begins_beside_the_middle_axis_is_on_time_to_rounding() {
    // u = 43 at the epoch, rounded to a double, made the time of the passage wrong by 1.9e-14 rad at −230.6, over a bound of 1.5e-14. By enclosures.py, 40
    // digits.
    let (moments, rates) =
        ([0.986_526_113_702_966_8, 0.094_589_317_586_110_75, 1.0], [0.497_211_080_823_163_6, -1.8566e-18, 6.1004e-20]);
    let states = [
        (
            -230.585_598_721_885_33,
            [-0.418_232_608_989_604_96, 0.593_294_884_149_908_6, -0.540_000_610_575_212_8, 0.426_007_049_000_004_4],
        ),
        (
            -150.0,
            [0.397_032_008_441_973_84, 7.603_286_269_149_862e-7, 3.635_961_890_009_824_5e-7, 0.917_804_763_700_767_8],
        ),
        (
            75.0,
            [
                0.202_725_474_840_862_42,
                1.345_187_728_712_812_8e-12,
                -3.319_329_351_789_316_7e-13,
                -0.979_235_611_000_001_8,
            ],
        ),
        (230.0, [-0.381_223_181_529_113_4, 0.632_706_185_933_704_1, 0.426_224_469_704_186_7, -0.522_191_985_357_330_7]),
        (
            1000000.0,
            [-0.160_863_321_587_161_6, -0.453_973_459_148_792_84, -0.871_565_725_871_926_3, -0.091_674_836_469_812_95],
        ),
    ];
    let motion = scene(moments, rates).tolerance(1e-15).span(-1e6, 1e6).solve().expect("served");
    let bound = motion.plan().error_bound();
    assert!(bound < 1e-14, "{bound}");
    for (time, attitude) in states {
        let error = attitude_error(motion.at(time).expect("finite").attitude.coords.into(), attitude);
        assert!(error <= bound, "at {time}: {error}, bound {bound}");
    }
}

#[test]
fn a_round_body_about_an_axis_across_its_own_turns_steadily_at_the_rate_of_that_axis() {
    // Its Q1 = Q2 = 0 made the bound 0/0, which became π; about axis 2 it was called the middle axis.
    for (moments, axis) in [([1.0, 1.0, 2.0], 0), ([1.0, 1.0, 2.0], 1), ([2.0, 1.0, 1.0], 2), ([0.7, 1.2, 0.7], 0)] {
        let mut rates = [0.0; 3];
        rates[axis] = 1.5;
        let motion = scene(moments, rates).solve().expect("steady");
        assert_eq!(motion.plan().mode(), Mode::PrincipalAxis);
        assert!(motion.plan().error_bound() < 1e-13, "{}", motion.plan());
        assert!(motion.plan().skipped()[0].contains("are equal") || motion.plan().skipped()[0].contains("A = B"));
        let sample = motion.at(1e6).expect("finite");
        assert_eq!(<[f64; 3]>::from(sample.angular_velocity), rates);
        let mut expected = [0.0, 0.0, 0.0, 0.75e6_f64.cos()];
        expected[axis] = 0.75e6_f64.sin();
        assert!(attitude_error(sample.attitude.coords.into(), expected) < 1e-14);
    }
    // With a part along its own axis it goes round, and the bound is no NaN either.
    let motion = scene([1.0, 1.0, 2.0], [1.0, 0.0, 1e-100]).solve().expect("precession");
    assert_eq!(motion.plan().mode(), Mode::Axisymmetric);
    assert!(motion.plan().error_bound() < 1e-13, "{}", motion.plan());
}

#[test]
fn a_rotation_next_to_the_middle_axis_has_the_departure_from_it_in_its_bound() {
    let solved = |tilt: [f64; 2], stop: f64| {
        scene([1.0, 1.5, 2.0], [tilt[0], 1.0, tilt[1]]).span(0.0, stop).solve().expect("steady").plan().error_bound()
    };
    // λ = 1.5 √((1/1 − 1/1.5)(1/1.5 − 1/2)) = 0.354: 1e-160 has grown to 1 after 1042 units.
    for tilt in [[1e-160, 0.0], [0.0, 1e-160], [5e-324, 0.0]] {
        assert!(solved(tilt, 500.0) < 1e-14, "{tilt:?}");
        assert!(solved(tilt, 1e5) > 1.0, "{tilt:?}: {}", solved(tilt, 1e5));
    }
    assert!(solved([1e-160, 0.0], 1010.0) > 1e-6 && solved([1e-160, 0.0], 900.0) < 1e-14);
    assert!(solved([0.0, 0.0], 1e9) < 1e-14);
}

#[test]
fn sigma_over_that_of_the_separatrix_keeps_its_digits_as_beta_approaches_one() {
    // G1 half of its value on the separatrix: then Q = 1 − ¼cos²ℓ and σ/σ_sep = (π/8)⟨1/(1+√Q)⟩ in the limit. From β itself it was off by 1e-16/(1−β).
    let nodes = (0..64).map(|k| (f64::from(k) * std::f64::consts::PI / 64.0).cos());
    let mean = nodes.map(|cosine| 1.0 / (1.0 + (1.0 - 0.25 * cosine * cosine).sqrt())).sum::<f64>() / 64.0;
    let limit = std::f64::consts::FRAC_PI_8 * mean;
    for power in [34, 38, 42, 46, 50, 52] {
        // Differences of moments are exact doubles for such gaps.
        let gap = 2.0_f64.powi(-power);
        let second = gap / (1.0 - gap);
        let first = (1.0 - 0.7) / 0.7;
        let g1 = 0.5 * (second / (first - second)).sqrt();
        // Not 0.5, with which β is a double as it is.
        let motion = scene([0.7, 1.0 - gap, 1.0], [g1 / 0.7, 0.0, 1.0]).solve().expect("short-axis");
        let off = motion.plan().separatrix_ratio() / limit - 1.0;
        assert!(off.abs() < 4.0 * gap + 1e-14, "1−β ≈ 2^-{power}: {off}");
    }
}
