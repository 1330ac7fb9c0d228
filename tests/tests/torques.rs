//! Torques beside the gravity gradient: closed forms, integrals, the gravity gradient itself as a polynomial, and bad input.

use andoyer_double::DoubleDouble;
use andoyer_propagate::disturbers::{Orbit, TabulatedOrbit};
use andoyer_propagate::nalgebra::{Matrix3, UnitQuaternion, Vector3};
use andoyer_propagate::torques::{SourcePath, Torque, TorqueSource};
use andoyer_propagate::verification::VerifyOptions;
use andoyer_propagate::{Body, Error, Method, Motion, Scene, State};
use andoyer_tests::climb::Uniform;

const MOMENTS: [f64; 3] = [1.0, 1.5, 2.0];
const RATES: [f64; 3] = [0.1, 0.2, 1.0];

fn scene(moments: [f64; 3], rates: [f64; 3]) -> Result<Scene, Error> {
    let state = State::new(0.0, [0.1, -0.2, 0.3, 0.86_f64.sqrt()], rates)?;
    Ok(Scene::new(Body::new(moments)?, state).span(0.0, 50.0).tolerance(1e-11))
}

fn vector(random: &mut Uniform, size: f64) -> [f64; 3] {
    std::array::from_fn(|_| random.between(-size, size))
}

#[test]
fn a_sphere_under_a_constant_torque_has_a_rate_that_grows_linearly() -> Result<(), Error> {
    let torque = [2e-3, 0.0, 0.0];
    let motion = scene([2.0; 3], [0.3, 0.0, 0.0])?.torques([Torque::constant(torque)?]).solve()?;
    let start = motion.at(0.0)?.attitude;
    for time in [0.0, 10.0, 50.0] {
        let angle = 0.3 * time + 0.5 * (torque[0] / 2.0) * time * time;
        let expected = start * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
        assert!(motion.at(time)?.attitude.angle_to(&expected) <= 1e-13, "{time}");
    }
    assert_eq!(motion.plan().method(), Method::Integrated);
    // From rest, and over a span before the epoch.
    let from_rest = scene([2.0; 3], [0.0; 3])?.span(-30.0, 30.0).torques([Torque::constant(torque)?]).solve()?;
    for time in [-30.0, 30.0] {
        let expected = start * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5 * 1e-3 * time * time);
        assert!(from_rest.at(time)?.attitude.angle_to(&expected) <= 1e-13, "{time}");
    }
    Ok(())
}

#[test]
fn damping_proportional_to_the_inertia_is_the_free_motion_in_a_slower_time() -> Result<(), Error> {
    // dL/dt = −γL: the direction stays, and the attitude is that of the free motion at (1 − e^(−γt))/γ.
    let gamma = 0.02;
    let matrix = std::array::from_fn(|i| std::array::from_fn(|k| if i == k { gamma * MOMENTS[i] } else { 0.0 }));
    let damped = scene(MOMENTS, RATES)?.torques([Torque::damping(matrix)?]).solve()?;
    let free = scene(MOMENTS, RATES)?.solve()?;
    for time in [3.0, 20.0, 50.0] {
        let slower = -f64::exp_m1(-gamma * time) / gamma;
        let (one, other) = (damped.at(time)?, free.at(slower)?);
        assert!(one.attitude.angle_to(&other.attitude) <= 1e-12, "{time}");
        let rates = other.angular_velocity * (-gamma * time).exp();
        assert!((one.angular_velocity - rates).norm() <= 1e-12, "{time}");
    }
    assert!(damped.plan().error_bound() <= 1e-11);
    Ok(())
}

#[test]
fn a_rotor_keeps_energy_and_the_whole_angular_momentum() -> Result<(), Error> {
    let mut random = Uniform(5);
    for _ in 0..10 {
        let rotor = vector(&mut random, 1.0);
        let motion = scene(MOMENTS, vector(&mut random, 1.0))?.torques([Torque::rotor(rotor)?]).solve()?;
        let energy = |time: f64| -> Result<f64, Error> {
            let rates = motion.at(time)?.angular_velocity;
            Ok(0.5 * (0..3).map(|i| MOMENTS[i] * rates[i] * rates[i]).sum::<f64>())
        };
        let mut momenta = [[0.0; 3]; 3];
        motion.angular_momenta_into(&[0.0, 25.0, 50.0], &mut momenta)?;
        let first = Vector3::from(momenta[0]);
        assert!((first - motion.angular_momentum()).norm() <= 1e-14);
        assert!(momenta.iter().all(|momentum| (Vector3::from(*momentum) - first).norm() <= 1e-12), "{momenta:?}");
        assert!((energy(50.0)? - energy(0.0)?).abs() <= 1e-12);
        // M of the Andoyer variables includes the rotor.
        assert!((motion.andoyer(50.0)?[4] - first.norm()).abs() <= 1e-12);
    }
    Ok(())
}

#[test]
fn an_axisymmetric_gyrostat_precesses_in_the_body_with_its_own_rate() -> Result<(), Error> {
    // A ω1′ = −((C − A) ω3 + h) ω2, and ω3 is constant.
    let (a, c, h) = (1.0, 1.4, 0.7);
    let motion = scene([a, a, c], RATES)?.torques([Torque::rotor([0.0, 0.0, h])?]).solve()?;
    let rate = ((c - a) * RATES[2] + h) / a;
    for time in [1.0, 17.0, 50.0] {
        let (sine, cosine) = (rate * time).sin_cos();
        let expected = [RATES[0] * cosine - RATES[1] * sine, RATES[0] * sine + RATES[1] * cosine, RATES[2]];
        assert!((motion.at(time)?.angular_velocity - Vector3::from(expected)).norm() <= 1e-12, "{time}");
    }
    Ok(())
}

/// The gravity gradient with the attraction G m/a³ as a polynomial, for a distance in units of a.
fn gravity_gradient(moments: [f64; 3], attraction: f64, path: SourcePath, reference: f64) -> Result<Torque, Error> {
    let component = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        format!("{:e}*sun{}*sun{}", 3.0 * attraction * (moments[k] - moments[j]), j + 1, k + 1)
    };
    let texts = [component(0), component(1), component(2)];
    let source = TorqueSource::new("sun", path).falling(3.0, reference);
    Torque::polynomial(texts.each_ref().map(String::as_str), vec![source])
}

fn apart(one: &Motion, other: &Motion, times: &[f64]) -> Result<f64, Error> {
    times
        .iter()
        .try_fold(0.0_f64, |most, time| Ok(most.max(one.at(*time)?.attitude.angle_to(&other.at(*time)?.attitude))))
}

#[test]
fn the_gravity_gradient_as_a_polynomial_is_the_gravity_gradient() -> Result<(), Error> {
    let ellipse = Orbit::new(0.3, 0.4)?.plane(0.4, 1.0, 2.0)?.time_of_pericentre(20.0)?;
    let turning = ellipse.secular_rates(0.01, -0.02)?;
    let hyperbola = Orbit::new(0.1, 1.7)?.plane(0.4, 1.0, 2.0)?.time_of_pericentre(25.0)?;
    let times = [5.0, 20.0, 50.0];
    for orbit in [ellipse, turning, hyperbola] {
        let own = scene(MOMENTS, RATES)?.orbit(orbit).method(Method::Integrated).solve()?;
        let polynomial = gravity_gradient(MOMENTS, orbit.strength(), SourcePath::Orbit(orbit), 1.0)?;
        let other = scene(MOMENTS, RATES)?.torques([polynomial]).solve()?;
        let gap = apart(&own, &other, &times)?;
        assert!(gap <= 1e-12 && gap <= own.plan().error_bound() + other.plan().error_bound(), "{gap:e}");
        // With a length the reference distance is in its unit.
        let sized = orbit.semi_major_axis(7.0e6)?;
        let sized = gravity_gradient(MOMENTS, orbit.strength(), SourcePath::Orbit(sized), 7.0e6)?;
        assert!(apart(&own, &scene(MOMENTS, RATES)?.torques([sized]).solve()?, &times)? <= 1e-12);
    }
    let orbit = ellipse.semi_major_axis(2.0)?;
    let knots: Vec<f64> = (0..=400).map(|k| -1.0 + 52.0 * f64::from(k) / 400.0).collect();
    let positions = knots.iter().map(|time| orbit.position(*time)).collect::<Result<Vec<[f64; 3]>, _>>()?;
    let gm = orbit.strength() * 8.0;
    let table = TabulatedOrbit::new(knots, positions, gm)?;
    let polynomial = gravity_gradient(MOMENTS, gm, SourcePath::Tabulated(table.clone().into()), 1.0)?;
    let own = scene(MOMENTS, RATES)?.disturbing([table]).solve()?;
    let other = scene(MOMENTS, RATES)?.torques([polynomial]).solve()?;
    assert!(apart(&own, &other, &times)? <= 1e-11);
    // Both have the error of the interpolation.
    assert!((other.plan().error_bound() / own.plan().error_bound()).ln().abs() <= 1.0);
    Ok(())
}

#[test]
fn a_dipole_in_a_uniform_field_keeps_its_energy() -> Result<(), Error> {
    let (dipole, field) = ([0.02, -0.05, 0.03], [0.3, -0.4, 1.2]);
    let component = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        format!("{:e}*b{} - {:e}*b{}", dipole[j], k + 1, dipole[k], j + 1)
    };
    let texts = [component(0), component(1), component(2)];
    let source = TorqueSource::new("b", SourcePath::Direction(field));
    let torque = Torque::polynomial(texts.each_ref().map(String::as_str), vec![source])?;
    let motion = scene(MOMENTS, RATES)?.torques([torque]).solve()?;
    let unit = Vector3::from(field).normalize();
    let energy = |time: f64| -> Result<f64, Error> {
        let sample = motion.at(time)?;
        let kinetic = 0.5 * (0..3).map(|i| MOMENTS[i] * sample.angular_velocity[i].powi(2)).sum::<f64>();
        Ok(kinetic - Vector3::from(dipole).dot(&(sample.attitude.inverse() * unit)))
    };
    for time in [10.0, 30.0, 50.0] {
        assert!((energy(time)? - energy(0.0)?).abs() <= 1e-12, "{time}");
    }
    // Without the field the energy of rotation alone is kept: the torque acts.
    assert!((motion.at(50.0)?.attitude.angle_to(&scene(MOMENTS, RATES)?.solve()?.at(50.0)?.attitude)) > 0.1);
    Ok(())
}

fn all_kinds() -> Result<[Torque; 4], Error> {
    let orbit = Orbit::new(0.2, 0.3)?.plane(0.4, 1.0, 2.0)?;
    let sources = vec![
        TorqueSource::new("sun", SourcePath::Orbit(orbit)).falling(2.0, 1.0),
        TorqueSource::new("b", SourcePath::Direction([0.0, 0.6, 0.8])),
    ];
    Ok([
        Torque::constant([1e-3, -2e-3, 3e-3])?,
        Torque::damping([[0.01, 0.002, 0.0], [-0.001, 0.02, 0.0], [0.003, 0.0, 0.015]])?,
        Torque::rotor([0.1, -0.2, 0.3])?,
        Torque::polynomial(["0.01*sun1*b2 - 0.02*w1^3", "0.01*b3*w2^2*sun3^2", "0.01 + 0.03*sun2^3*b1*w3"], sources)?,
    ])
}

#[test]
fn torques_turn_with_the_axes_of_the_user() -> Result<(), Error> {
    let turn = UnitQuaternion::from_euler_angles(0.3, -0.7, 1.1);
    let matrix = turn.to_rotation_matrix();
    let tensor = matrix * Matrix3::from_diagonal(&Vector3::from(MOMENTS)) * matrix.transpose();
    let rows = std::array::from_fn(|i| std::array::from_fn(|k| 0.5 * (tensor[(i, k)] + tensor[(k, i)])));
    let [constant, damping, rotor, _] = all_kinds()?;
    let Torque::Damping(rows_of_damping) = damping.clone() else { unreachable!() };
    let principal = scene(MOMENTS, RATES)?.torques([constant, damping, rotor]).solve()?;
    // The same motion about axes that are turned, with torques in components about them.
    let about = |vector: [f64; 3]| <[f64; 3]>::from(turn * Vector3::from(vector));
    let damping = matrix * Matrix3::from_fn(|i, k| rows_of_damping[i][k]) * matrix.transpose();
    let state = State::new(0.0, (principal.at(0.0)?.attitude * turn.inverse()).coords.into(), about(RATES))?;
    let torques = [
        Torque::constant(about([1e-3, -2e-3, 3e-3]))?,
        Torque::damping(std::array::from_fn(|i| std::array::from_fn(|k| damping[(i, k)])))?,
        Torque::rotor(about([0.1, -0.2, 0.3]))?,
    ];
    let turned =
        Scene::new(Body::from_inertia(rows)?, state).span(0.0, 50.0).tolerance(1e-11).torques(torques).solve()?;
    for time in [10.0, 50.0] {
        let expected = principal.at(time)?.attitude * turn.inverse();
        assert!(turned.at(time)?.attitude.angle_to(&expected) <= 1e-11, "{time}");
    }
    Ok(())
}

#[test]
fn every_kind_together_is_verified_and_goes_on_from_a_sample() -> Result<(), Error> {
    // Verified about other axes, so the torques of all kinds are turned.
    let scene = scene(MOMENTS, RATES)?.torques(all_kinds()?);
    let motion = scene.solve()?;
    let verification = motion.verify(VerifyOptions::default())?;
    assert!(!verification.refuted() && verification.error() <= 1e-13, "{verification}");
    assert!(motion.plan().error_bound() <= 1e-11, "{}", motion.plan());
    let later = motion.scene_at(20.0)?;
    assert_eq!(later.asked_torques(), scene.asked_torques());
    assert!(later.solve()?.at(50.0)?.attitude.angle_to(&motion.at(50.0)?.attitude) <= 1e-11);
    assert!(motion.plan().to_string().contains("0 disturbing bodies and 4 other torques"), "{}", motion.plan());
    Ok(())
}

#[test]
fn bad_torques_are_refused_by_name() -> Result<(), Error> {
    let source = |name: &str| TorqueSource::new(name, SourcePath::Direction([0.0, 0.0, 1.0]));
    let orbit = SourcePath::Orbit(Orbit::new(1.0, 0.1)?);
    let refused = |torque: Result<Torque, Error>| match torque {
        Err(Error::Torque { argument, .. }) => argument,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(Torque::constant([f64::NAN, 0.0, 0.0])), "constant");
    assert_eq!(refused(Torque::damping([[0.0, f64::INFINITY, 0.0], [0.0; 3], [0.0; 3]])), "damping");
    assert_eq!(refused(Torque::rotor([0.0, 0.0, f64::NAN])), "rotor");
    let zero = ["0", "0", "0"];
    for name in ["", "w", "1a", "a b", "a-b"] {
        assert_eq!(refused(Torque::polynomial(zero, vec![source(name)])), "sources", "{name}");
    }
    assert_eq!(refused(Torque::polynomial(zero, vec![source("a"), source("a")])), "sources");
    let none = TorqueSource::new("a", SourcePath::Direction([0.0; 3]));
    assert_eq!(refused(Torque::polynomial(zero, vec![none])), "sources");
    assert_eq!(refused(Torque::polynomial(zero, vec![source("a").falling(1.0, 1.0)])), "distance_powers");
    let far = TorqueSource::new("a", orbit.clone()).falling(101.0, 1.0);
    assert_eq!(refused(Torque::polynomial(zero, vec![far])), "distance_powers");
    for reference in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let near = TorqueSource::new("a", orbit.clone()).falling(2.0, reference);
        assert_eq!(refused(Torque::polynomial(zero, vec![near])), "reference_distances");
    }
    assert_eq!(refused(Torque::polynomial(["0", "w1^9", "0"], vec![])), "texts");
    let many = "a1+a2+a3+b1+b2+b3+w1+w2+w3";
    assert_eq!(refused(Torque::polynomial([many, "0", "0"], vec![source("a"), source("b")])), "texts");
    for text in ["w4", "sin(w1)", "w1 +", "1/w1"] {
        assert!(matches!(Torque::polynomial([text, "0", "0"], vec![]), Err(Error::Series(_))), "{text}");
    }
    Ok(())
}

#[test]
fn a_scene_with_a_torque_is_integrated_or_says_what_it_needs() -> Result<(), Error> {
    let scene = scene(MOMENTS, RATES)?.torques([Torque::constant([1e-3; 3])?]);
    assert!(scene.needs_integration());
    for method in [Method::Closed, Method::Series] {
        assert!(matches!(scene.clone().method(method).solve(), Err(Error::OnlyIntegrated { .. })));
    }
    assert!(matches!(scene.clone().method(Method::Libration).solve(), Err(Error::NoLibration { .. })));
    let state = *scene.state();
    let endless = Scene::new(scene.body().clone(), state).torques([Torque::constant([1e-3; 3])?]);
    assert!(matches!(endless.solve(), Err(Error::NoSpan { .. })));
    assert!(matches!(scene.clone().torques([Torque::Constant([f64::NAN; 3])]).solve(), Err(Error::Torque { .. })));
    // (1/1.5e11)^40 is no double.
    let far = Orbit::new(1e-7, 0.1)?.semi_major_axis(1.5e11)?;
    let source = TorqueSource::new("sun", SourcePath::Orbit(far)).falling(40.0, 1.0);
    let lost = scene.clone().torques([Torque::polynomial(["sun2", "0", "0"], vec![source])?]).solve();
    assert!(matches!(lost, Err(Error::Torque { argument: "distance_powers", .. })), "{lost:?}");
    // A table that ends within the span.
    let table = TabulatedOrbit::new((0..8).map(|k| 5.0 * f64::from(k)).collect(), vec![[1.0, 0.0, 0.0]; 8], 1.0)?;
    let source = TorqueSource::new("sun", SourcePath::Tabulated(table.into()));
    let short = scene.torques([Torque::polynomial(["sun2", "0", "0"], vec![source])?]).solve();
    assert!(matches!(short, Err(Error::TableSpan { .. })), "{short:?}");
    Ok(())
}

#[test]
fn a_scene_file_has_every_kind() -> Result<(), Error> {
    let scene = scene(MOMENTS, RATES)?.torques(all_kinds()?);
    assert_eq!(Scene::parse_toml(&scene.to_toml(), "torques.toml")?, scene);
    let file = |table: &str| {
        let text = format!(
            "span = [0.0, 1.0]\n[body]\nmoments = [1.0, 1.5, 2.0]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]\n[[torque]]\n{table}"
        );
        Scene::parse_toml(&text, "torques.toml").map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(file("rotor = [0.0, 0.0, 1.0]"), Ok(()));
    for (table, begins) in [
        ("", "torques.toml: torque: must have one of"),
        ("rotor = [0, 0, 1]\nconstant = [0, 0, 1]", "torques.toml: torque: must have one of"),
        (
            "rotor = [0, 0, 1]\n[[torque.source]]\nname = \"b\"\ndirection = [0, 0, 1]",
            "torques.toml: torque: must have one of",
        ),
        ("rotor = [0, 0, nan]", "torques.toml: torque: torque.rotor = NaN: it must be finite"),
        ("polynomial = [\"b1\", \"0\", \"0\"]", "torques.toml: torque: "),
        (
            "polynomial = [\"0\", \"0\", \"0\"]\n[[torque.source]]\nname = \"b\"",
            "torques.toml: torque.source: must have a direction or an orbit",
        ),
        (
            "polynomial = [\"0\", \"0\", \"0\"]\n[[torque.source]]\nname = \"b\"\norbit = { mean_motion = -1.0 }",
            "torques.toml: torque.source.orbit.mean_motion: ",
        ),
        ("spring = [0, 0, 1]", "torques.toml: torque.spring: "),
    ] {
        let error = file(table).expect_err(table);
        assert!(error.starts_with(begins), "{error}");
    }
    Ok(())
}

#[test]
fn the_bound_holds_the_rounding_of_a_torque_that_spins_a_body_up_from_rest() -> Result<(), Error> {
    // The angle ½ (c/I) t² is 1e6 rad, and c/I is no double.
    let (moment, torque, time) = (7.0, 0.3, (2e6 * 7.0 / 0.3_f64).sqrt());
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0; 3])?;
    let scene = Scene::new(Body::new([moment; 3])?, state).span(0.0, time).tolerance(1e-6);
    let motion = scene.torques([Torque::constant([0.0, 0.0, torque])?]).solve()?;
    let exact = |x: f64| DoubleDouble::from(x);
    let half_angle = exact(0.25) * exact(torque) * exact(time) * exact(time) / exact(moment);
    let turn = DoubleDouble::PI * exact(2.0);
    let half_angle = half_angle - turn * exact((half_angle / turn).to_f64().round());
    let expected = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 2.0 * half_angle.to_f64());
    let error = motion.at(time)?.attitude.angle_to(&expected);
    assert!(error > 1e-12 && error <= motion.plan().error_bound(), "{error:e} {:e}", motion.plan().error_bound());
    // The rate at the end counts in the bound of the rates.
    let rate = torque / moment * time;
    assert!(motion.plan().rate_error_bound() >= 1.99 * rate * motion.plan().error_bound());
    Ok(())
}

#[test]
fn derivatives_of_a_body_that_is_spun_up_are_those_of_the_formula() -> Result<(), Error> {
    // ∂θ/∂ω₀ = t and ∂θ/∂I = −½ (c/I²) t² about the axis of the torque.
    let (moment, torque, time) = (2.0, 0.5, 200.0);
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0; 3])?;
    let scene = Scene::new(Body::new([moment, moment, moment])?, state).span(0.0, time).tolerance(1e-9);
    let partials = scene.torques([Torque::constant([0.0, 0.0, torque])?]).solve()?.partials(time)?;
    assert!((partials.attitude[2][5] / time - 1.0).abs() <= 1e-7, "{}", partials.attitude[2][5]);
    let by_moment = -0.5 * torque / (moment * moment) * time * time;
    assert!((partials.attitude[2][8] / by_moment - 1.0).abs() <= 1e-6, "{} {by_moment}", partials.attitude[2][8]);
    Ok(())
}

#[test]
fn a_polynomial_in_si_units_of_a_distant_sun_and_directions_of_any_length_are_served() -> Result<(), Error> {
    // The coefficient of the gravity gradient of the Sun on an asteroid, in m and s, with r₀ = 1 m.
    let orbit = Orbit::new(1.99e-7, 0.3)?.semi_major_axis(1.5e11)?;
    let moments = [1.0e12, 1.5e12, 2.0e12];
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [1e-5, 2e-5, 2.9e-4])?;
    let scene = Scene::new(Body::new(moments)?, state).span(0.0, 1e6).tolerance(1e-9);
    let gm = 1.327e20;
    let own = scene.clone().orbit(orbit.attraction(gm / 1.5e11_f64.powi(3))?).method(Method::Integrated).solve()?;
    let polynomial = gravity_gradient(moments, gm, SourcePath::Orbit(orbit), 1.0)?;
    let other = scene.clone().torques([polynomial]).solve()?;
    assert!(apart(&own, &other, &[3e5, 1e6])? <= 1e-11);
    let along = |length: f64| {
        let source = TorqueSource::new("b", SourcePath::Direction([0.0, 0.6 * length, 0.8 * length]));
        scene.clone().torques([Torque::polynomial(["1e3*b2", "0", "1e3*b3*b1"], vec![source])?]).solve()
    };
    for length in [1e-170, 1e200] {
        assert!(apart(&along(1.0)?, &along(length)?, &[1e6])? <= 1e-11, "{length:e}");
    }
    Ok(())
}

#[test]
fn an_odd_polynomial_has_the_sign_of_the_vector_to_the_source() -> Result<(), Error> {
    // At the pericentre of these elements the source is along inertial axis 1.
    let source = TorqueSource::new("s", SourcePath::Orbit(Orbit::new(1e-9, 0.0)?));
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0; 3])?;
    let scene = Scene::new(Body::new([1.0; 3])?, state).span(0.0, 1.0).tolerance(1e-9);
    let motion = scene.torques([Torque::polynomial(["0", "0", "0.1*s1"], vec![source])?]).solve()?;
    assert!((motion.at(1.0)?.angular_velocity.z - 0.1).abs() <= 1e-3);
    Ok(())
}

#[test]
fn andoyer_variables_of_a_gyrostat_are_read_back() -> Result<(), Error> {
    let torques = || -> Result<Vec<Torque>, Error> { Ok(vec![Torque::rotor([0.3, -0.2, 0.5])?]) };
    let motion = scene(MOMENTS, RATES)?.torques(torques()?).solve()?;
    let variables = motion.andoyer(0.0)?;
    let again = Scene::from_andoyer_with(Body::new(MOMENTS)?, variables, 0.0, torques()?)?;
    assert!((again.state().angular_velocity - Vector3::from(RATES)).norm() <= 1e-13);
    assert!(again.state().attitude.angle_to(&motion.at(0.0)?.attitude) <= 1e-13);
    Ok(())
}
