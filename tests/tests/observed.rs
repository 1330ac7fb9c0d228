//! Scenes from periods and from Andoyer variables: there and back, published figures, limits, errors.

use andoyer_propagate::nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use andoyer_propagate::options::Convention;
use andoyer_propagate::periods::{ObservedPeriods, Periods};
use andoyer_propagate::{Body, Error, Mode, Motion, Scene};
use andoyer_tests::attitude_error;
use proptest::prelude::*;

const CONVENTIONS: [Convention; 3] = [Convention::ExtremalAxis, Convention::LongAxis, Convention::ShortAxis];

fn periods_of(motion: &Motion, convention: Convention) -> Periods {
    match convention {
        Convention::LongAxis => motion.long_axis_periods(),
        Convention::ShortAxis => motion.short_axis_periods(),
        _ => motion.extremal_axis_periods(),
    }
}

fn scene(body: &Body, periods: &ObservedPeriods) -> Scene {
    Scene::from_periods(body.clone(), periods).expect("periods within reach")
}

/// Moments of a body, in any order, with differences of 1 % at least.
fn moments() -> impl Strategy<Value = [f64; 3]> {
    (0.05..0.98_f64, 0.0..1.0_f64, 0usize..6).prop_filter_map("too nearly round", |(a, part, order)| {
        let least = a.max(1.0 - a + 0.01);
        let b = least + part * (1.0 - least);
        let sorted = [a.min(b), a.max(b), 1.0];
        let apart = sorted[1] - sorted[0] > 0.01 && sorted[2] - sorted[1] > 0.01;
        let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        apart.then(|| orders[order].map(|i| sorted[i]))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_scene_has_the_periods_that_it_was_made_from(moments in moments(), beyond in 1.0001..3.0_f64, long in any::<bool>(), phases in [0.0..1.0_f64, 0.0..1.0]) {
        let body = Body::new(moments).expect("a body");
        let mode = if long { Mode::LongAxis } else { Mode::ShortAxis };
        for convention in CONVENTIONS {
            let [lower, _] = body.period_ratios(mode, convention).expect("a mode");
            let stated = ObservedPeriods { mode, convention, phases, ..ObservedPeriods::new(7.3, 7.3 * lower * beyond) };
            let motion = scene(&body, &stated).solve().expect("a motion");
            // Beyond twice the lowest ratio it may lie so near the separatrix that rounding of the state moves it: 1e-16 over cos²J.
            let found = periods_of(&motion, convention);
            let bound = if motion.plan().separatrix_ratio() < 0.99 { 1e-9 } else { 1e-4 };
            prop_assert!((found.precession / stated.precession - 1.0).abs() < bound, "{convention}: {found:?}");
            prop_assert!((found.rotation / stated.rotation - 1.0).abs() < bound, "{convention}: {found:?}");
            prop_assert!(motion.plan().mode() == mode);
        }
    }

    #[test]
    fn phases_go_by_with_time(moments in moments(), beyond in 1.01..1.3_f64, long in any::<bool>(), time in -20.0..20.0_f64) {
        let body = Body::new(moments).expect("a body");
        let mode = if long { Mode::LongAxis } else { Mode::ShortAxis };
        let [lower, _] = body.period_ratios(mode, Convention::ExtremalAxis).expect("a mode");
        let start = ObservedPeriods { mode, ..ObservedPeriods::new(1.3, 1.3 * lower * beyond).towards(0.7, -0.4).expect("a latitude") };
        let later = ObservedPeriods { phases: [time / start.rotation, time / start.precession], epoch: time, ..start };
        let expected = scene(&body, &start).solve().expect("a motion").at(time).expect("a time");
        let found = *scene(&body, &later).state();
        prop_assert!(attitude_error(found.attitude.coords.into(), expected.attitude.coords.into()) < 1e-9);
        prop_assert!((found.angular_velocity - expected.angular_velocity).amax() < 1e-9 * expected.angular_velocity.amax());
    }

    #[test]
    fn a_sense_of_minus_one_turns_the_axis_of_the_mode_over(moments in moments(), beyond in 1.01..1.3_f64, long in any::<bool>(), phases in [0.0..1.0_f64, 0.0..1.0]) {
        let body = Body::new(moments).expect("a body");
        let mode = if long { Mode::LongAxis } else { Mode::ShortAxis };
        let [lower, _] = body.period_ratios(mode, Convention::ExtremalAxis).expect("a mode");
        let stated = ObservedPeriods { mode, phases, ..ObservedPeriods::new(1.3, 1.3 * lower * beyond).towards(0.7, -0.4).expect("a latitude") };
        let extremal = if long { f64::min } else { f64::max };
        let axis = moments.iter().position(|moment| *moment == moments.into_iter().reduce(extremal).expect("three moments")).expect("an axis");
        for sense in [1.0, -1.0] {
            let motion = scene(&body, &ObservedPeriods { sense: Some(sense), ..stated }).solve().expect("a motion");
            prop_assert!(motion.scene().state().angular_velocity[axis] * sense > 0.0);
            prop_assert!((motion.angular_momentum().normalize() - stated.momentum_direction).amax() < 1e-14);
            prop_assert!((motion.extremal_axis_periods().rotation / stated.rotation - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_state_nearest_to_an_attitude_is_nearer_than_any_phase(moments in moments(), beyond in 1.001..1.5_f64, long in any::<bool>(), turn in [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0]) {
        let body = Body::new(moments).expect("a body");
        let mode = if long { Mode::LongAxis } else { Mode::ShortAxis };
        let [lower, _] = body.period_ratios(mode, Convention::ExtremalAxis).expect("a mode");
        let stated = ObservedPeriods { mode, ..ObservedPeriods::new(1.3, 1.3 * lower * beyond).towards(0.7, -0.4).expect("a latitude") };
        let attitude = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
        let near = ObservedPeriods { attitude: Some(attitude), ..stated };
        let motion = scene(&body, &near).solve().expect("a motion");
        prop_assert!((motion.extremal_axis_periods().rotation / stated.rotation - 1.0).abs() < 1e-6);
        prop_assert!((motion.angular_momentum().normalize() - stated.momentum_direction).amax() < 1e-13);
        let found = motion.scene().state().attitude.angle_to(&attitude);
        let steps = [0.0, 0.2, 0.4, 0.6, 0.8];
        for (sense, rotation) in [1.0, -1.0].into_iter().flat_map(|sense| steps.map(|step| (sense, step))) {
            for precession in steps {
                let other = ObservedPeriods { sense: Some(sense), phases: [rotation, precession], ..stated };
                prop_assert!(found <= scene(&body, &other).state().attitude.angle_to(&attitude) + 1e-7);
            }
        }
        // An attitude of the motion itself leads back to its state.
        let own = ObservedPeriods { sense: Some(-1.0), phases: [0.3, 0.8], ..stated };
        let state = *scene(&body, &own).state();
        let again = *scene(&body, &ObservedPeriods { attitude: Some(state.attitude), ..stated }).state();
        prop_assert!(again.attitude.angle_to(&state.attitude) < 1e-9);
        prop_assert!((again.angular_velocity - state.angular_velocity).amax() < 1e-8 * state.angular_velocity.amax());
    }

    #[test]
    fn andoyer_variables_lead_back_to_the_scene(
        moments in moments(),
        angles in [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0],
        parts in [-0.999..0.999_f64, -0.999..0.999],
        turn in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
    ) {
        let turn = Rotation3::from_scaled_axis(Vector3::from(turn)).into_inner();
        let tensor = turn * Matrix3::from_diagonal(&Vector3::from(moments)) * turn.transpose();
        let tensor = 0.5 * (tensor + tensor.transpose());
        let tilted = Body::from_inertia(std::array::from_fn(|i| std::array::from_fn(|j| tensor[(i, j)]))).expect("a body");
        let variables = [angles[0], angles[1], angles[2], 2.5 * parts[0], 2.5, 2.5 * parts[1]];
        for body in [Body::new(moments).expect("a body"), tilted] {
            let motion = Scene::from_andoyer(body, variables, 4.0).expect("variables").solve().expect("a motion");
            let found = motion.andoyer(4.0).expect("the epoch");
            for (found, given) in found.iter().zip(variables) {
                prop_assert!((found - given).abs() < 2e-13, "{variables:?} {found:?}");
            }
        }
    }
}

#[test]
fn apophis_of_pravec_has_the_published_energy_and_precession_of_its_long_axis() {
    let body = Body::new([0.61, 0.965, 1.0]).expect("a body");
    let motion = scene(&body, &ObservedPeriods::new(27.38, 263.0)).solve().expect("a motion");
    assert!((motion.energy_ratio() - 1.023_64).abs() < 5e-6, "{}", motion.energy_ratio());
    assert!((motion.plan().separatrix_ratio() - 0.567).abs() < 5e-4, "{}", motion.plan().separatrix_ratio());
    assert!((motion.long_axis_periods().precession - 30.56).abs() < 5e-3, "{:?}", motion.long_axis_periods());
    assert!((motion.elliptic_parameter() - 0.638).abs() < 5e-4);
}

#[test]
fn toutatis_of_takahashi_has_the_parameter_of_its_periods() {
    // 1 : 3.0836 : 3.235; 5.38 d and 7.40 d about the long axis: k² = 0.032 (Zhao et al. 2015).
    let body = Body::new([1.0, 3.0836, 3.235]).expect("a body");
    let stated = ObservedPeriods { mode: Mode::LongAxis, ..ObservedPeriods::new(7.40, 5.38) };
    let motion = scene(&body, &stated).solve().expect("a motion");
    assert_eq!(motion.plan().mode(), Mode::LongAxis);
    assert!((motion.elliptic_parameter() - 0.032).abs() < 5e-4, "{}", motion.elliptic_parameter());
}

#[test]
fn the_angular_momentum_points_where_it_is_asked_to() {
    let body = Body::new([0.61, 0.965, 1.0]).expect("a body");
    for direction in [[0.0, 0.0, 1.0], [0.0, 0.0, -2.0], [1.0, -2.0, 0.5], [1e-9, 0.0, 1.0]] {
        let direction = Vector3::from(direction);
        let stated =
            ObservedPeriods { momentum_direction: direction, phases: [0.3, 0.9], ..ObservedPeriods::new(27.38, 263.0) };
        let momentum = scene(&body, &stated).solve().expect("a motion").angular_momentum();
        assert!((momentum.normalize() - direction.normalize()).amax() < 4e-15, "{direction}");
    }
}

#[test]
fn the_lowest_ratio_is_rotation_about_the_axis_and_the_highest_lies_next_to_the_separatrix() {
    let body = Body::new([1.0, 1.5, 2.0]).expect("a body");
    for mode in [Mode::ShortAxis, Mode::LongAxis] {
        for convention in CONVENTIONS {
            let [lower, upper] = body.period_ratios(mode, convention).expect("a mode");
            let stated = |ratio: f64| ObservedPeriods { mode, convention, ..ObservedPeriods::new(2.0, 2.0 * ratio) };
            let motion = scene(&body, &stated(lower)).solve().expect("a motion");
            assert_eq!(motion.plan().mode(), Mode::PrincipalAxis);
            assert!((periods_of(&motion, convention).precession / 2.0 - 1.0).abs() < 1e-14);
            assert!((periods_of(&motion, convention).rotation / (2.0 * lower) - 1.0).abs() < 1e-14);
            let beside = scene(&body, &stated(lower * (1.0 + 1e-9))).solve().expect("a motion");
            assert!((periods_of(&beside, convention).rotation / (2.0 * lower) - 1.0).abs() < 2e-9);
            // The farthest is next to the separatrix, and the state still has its periods.
            let farthest = scene(&body, &stated(upper)).solve().expect("a motion");
            assert!(farthest.plan().mode() == mode && farthest.plan().separatrix_ratio() > 0.9999);
            let found = periods_of(&farthest, convention);
            assert!((found.rotation / (2.0 * upper) - 1.0).abs() < 1e-5 && (found.precession / 2.0 - 1.0).abs() < 1e-5);
            for ratio in [0.999 * lower, 1.001 * upper] {
                let Err(Error::PeriodRatio { ratio: said, lower: least, upper: most, .. }) =
                    Scene::from_periods(body.clone(), &stated(ratio))
                else {
                    panic!("{mode} {convention}: {ratio}")
                };
                assert!((said / ratio - 1.0).abs() < 1e-15 && [least, most] == [lower, upper]);
            }
        }
    }
}

#[test]
fn a_round_body_has_one_mode_and_its_periods_are_those_of_regular_precession() {
    let oblate = Body::new([1.0, 1.0, 1.5]).expect("a body");
    let motion = scene(&oblate, &ObservedPeriods::new(10.0, 45.0)).solve().expect("a motion");
    // μ turns with M/A, ν with M cos J (1/A − 1/C).
    let momentum = motion.angular_momentum().norm();
    assert!((10.0 * momentum / std::f64::consts::TAU - 1.0).abs() < 1e-14);
    assert!((motion.extremal_axis_periods().rotation / 45.0 - 1.0).abs() < 1e-13);
    let long = ObservedPeriods { mode: Mode::LongAxis, ..ObservedPeriods::new(10.0, 45.0) };
    assert!(matches!(Scene::from_periods(oblate, &long), Err(Error::NoSuchMode { .. })));
    let prolate = Body::new([1.0, 1.5, 1.5]).expect("a body");
    assert!(Scene::from_periods(prolate.clone(), &long).is_ok());
    assert!(matches!(Scene::from_periods(prolate, &ObservedPeriods::new(10.0, 45.0)), Err(Error::NoSuchMode { .. })));
}

#[test]
fn bad_periods_are_named() {
    let body = Body::new([0.61, 0.965, 1.0]).expect("a body");
    let good = ObservedPeriods::new(27.38, 263.0);
    let refused = |periods: ObservedPeriods| Scene::from_periods(body.clone(), &periods).expect_err("bad").to_string();
    assert!(refused(ObservedPeriods { precession: -1.0, ..good }).starts_with("precession = -1: "));
    assert!(refused(ObservedPeriods { rotation: f64::NAN, ..good }).starts_with("rotation = NaN: "));
    assert!(
        refused(ObservedPeriods { momentum_direction: Vector3::zeros(), ..good }).starts_with("momentum_direction")
    );
    assert!(refused(ObservedPeriods { phases: [0.0, f64::INFINITY], ..good }).starts_with("phases = "));
    assert!(refused(ObservedPeriods { mode: Mode::Spherical, ..good }).starts_with("mode = \"spherical\""));
    let swapped = refused(ObservedPeriods { precession: 263.0, rotation: 27.38, ..good });
    // The upper end was printed as 5.469655e1.
    let [lower, upper] = body.period_ratios(Mode::ShortAxis, Convention::ExtremalAxis).expect("a mode");
    assert!(
        swapped.contains(&format!("P_ψ/P_φ from {lower} up to {upper}; the two periods fit only if they are swapped")),
        "{swapped}"
    );
}

#[test]
fn a_latitude_beyond_a_quarter_turn_is_refused_and_named() {
    let good = ObservedPeriods::new(27.38, 263.0);
    for latitude in [-std::f64::consts::FRAC_PI_2, 0.0, std::f64::consts::FRAC_PI_2] {
        assert!(good.towards(400.0, latitude).is_ok(), "{latitude}");
    }
    let single = f64::from(std::f32::consts::FRAC_PI_2);
    assert!(good.towards(0.0, single).is_ok() && good.towards(0.0, -single).is_ok());
    for latitude in [1.571, 3.0, -85.0, f64::INFINITY] {
        let error = good.towards(1.0, latitude).expect_err("a latitude");
        assert_eq!((error.argument(), error.value()), (Some("momentum_direction"), Some([1.0, latitude].into())));
        assert!(error.to_string().ends_with("the latitude must be from -π/2 to π/2"), "{error}");
    }
    let file = "[body]\nmoments = [0.61, 0.965, 1]\n[periods]\nprecession = 27.38\nrotation = 263\nmomentum_direction = [275, -85]";
    let error = Scene::parse_toml(file, "f").expect_err("degrees").to_string();
    assert!(
        error.starts_with("f: periods.momentum_direction: momentum_direction = [275, -85]: it is [longitude"),
        "{error}"
    );
}

#[test]
fn bad_andoyer_variables_are_named() {
    let body = Body::new([1.0, 1.5, 2.0]).expect("a body");
    for (index, value) in [(0, f64::NAN), (3, 1.1), (4, 0.0), (4, -1.0), (5, -1.1)] {
        let mut variables = [0.1, 0.2, 0.3, 0.5, 1.0, 0.9];
        variables[index] = value;
        let Err(Error::Andoyer { index: named, bound, .. }) = Scene::from_andoyer(body.clone(), variables, 0.0) else {
            panic!("{index}")
        };
        assert_eq!(named, index);
        assert!(index == 0 || index == 4 || bound == "at most M = 1 in magnitude", "{bound}");
    }
}

#[test]
fn a_scene_file_states_periods_or_a_tensor() {
    let file = "[body]\nmoments = [0.61, 0.965, 1]\n[periods]\nprecession = 27.38\nrotation = 263\nmomentum_direction = [4.36, -1.3]\nphases = [0.25, 0]";
    let read = Scene::parse_toml(file, "apophis.toml").expect("a scene");
    let periods = ObservedPeriods { phases: [0.25, 0.0], ..ObservedPeriods::new(27.38, 263.0) }
        .towards(4.36, -1.3)
        .expect("a latitude");
    assert_eq!(read, scene(&Body::new([0.61, 0.965, 1.0]).expect("a body"), &periods));
    assert_eq!(Scene::parse_toml(&read.to_toml(), "again").expect("a scene"), read);
    let tensor = "[body]\ninertia = [[17.0, 0.4, -2.2], [0.4, 124.8, 0.3], [-2.2, 0.3, 129.1]]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0.01, 0.05]";
    let read = Scene::parse_toml(tensor, "envisat.toml").expect("a scene");
    assert_eq!(Scene::parse_toml(&read.to_toml(), "again").expect("a scene"), read);
    for (broken, key) in [
        (file.replace("263", "2.63"), "periods.rotation: rotation/precession"),
        (
            format!("{file}\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]"),
            "periods: stands beside state",
        ),
        (file.replace("rotation = 263", "mode = \"medium\"\nrotation = 263"), "periods.mode: unknown variant `medium`"),
        (tensor.replace("[0.4, 124.8", "[0.5, 124.8"), "body.inertia: tensor[0][1]"),
        (tensor.replace("inertia", "moments = [1, 1, 1]\ninertia"), "body.inertia: stands beside"),
    ] {
        let problem = Scene::parse_toml(&broken, "f").expect_err("broken").to_string();
        assert!(problem.starts_with(&format!("f: {key}")), "{problem}");
    }
}

#[test]
fn a_bad_sense_and_phases_beside_an_attitude_are_refused() {
    let body = Body::new([0.61, 0.965, 1.0]).expect("a body");
    let periods = ObservedPeriods::new(27.38, 263.0);
    for value in [0.0, 2.0, f64::NAN] {
        let found = Scene::from_periods(body.clone(), &ObservedPeriods { sense: Some(value), ..periods });
        assert!(matches!(found, Err(Error::Sense { .. })), "{found:?}");
    }
    let attitude = Some(UnitQuaternion::identity());
    let both = ObservedPeriods { phases: [0.25, 0.0], attitude, ..periods };
    assert!(matches!(Scene::from_periods(body, &both), Err(Error::PhasesAndAttitude { value: [0.25, 0.0] })));
}
