//! Bodies given by an inertia tensor: everything of their scenes is about the user's axes.

use andoyer_propagate::nalgebra::{Matrix3, Rotation3, SMatrix, UnitQuaternion, Vector3};
use andoyer_propagate::{Body, Error, Orbit, Scene, State};
use andoyer_tests::attitude_error;

const ATTITUDE: [f64; 4] = [0.1, -0.5, 0.7, 0.5];
const RATES: [f64; 3] = [0.3, -0.2, 1.0];

fn turn() -> Rotation3<f64> {
    Rotation3::from_scaled_axis(Vector3::new(0.4, -0.7, 0.2))
}

fn tensor(moments: [f64; 3]) -> Matrix3<f64> {
    let turned = turn() * Matrix3::from_diagonal(&Vector3::from(moments)) * turn().inverse();
    0.5 * (turned + turned.transpose())
}

fn body(moments: [f64; 3]) -> Body {
    let tensor = tensor(moments);
    Body::from_inertia(std::array::from_fn(|i| std::array::from_fn(|j| tensor[(i, j)]))).expect("a body")
}

fn state() -> State {
    State::new(2.0, ATTITUDE, RATES).expect("a state")
}

/// The modes, a round body, a sphere's neighbour, and the separatrix's.
const MOMENTS: [[f64; 3]; 5] =
    [[1.0, 1.5, 2.0], [2.0, 1.0, 1.5], [1.0, 1.0, 1.5], [1.0, 3.0836, 3.235], [1.0, 1.001, 1.002]];

#[test]
fn the_state_is_that_of_the_scene_and_the_angular_momentum_is_constant() {
    for moments in MOMENTS {
        let motion = Scene::new(body(moments), state()).solve().expect("a motion");
        let start = motion.at(2.0).expect("the epoch");
        let lost = attitude_error(start.attitude.coords.into(), state().attitude.coords.into());
        let bound = motion.plan().error_bound() + 4e-15;
        assert!(lost < bound, "{moments:?}: {lost:e}");
        assert!((start.angular_velocity - state().angular_velocity).amax() < bound);
        assert_eq!(*motion.scene().state(), state());
        let expected = state().attitude * (tensor(moments) * state().angular_velocity);
        assert!((motion.angular_momentum() - expected).amax() < 1e-14);
        for time in [-31.0, 2.5, 777.0] {
            let sample = motion.at(time).expect("a time");
            let momentum = sample.attitude * (tensor(moments) * sample.angular_velocity);
            assert!((momentum - expected).amax() < 4.0 * bound, "{moments:?} at {time}");
        }
    }
}

#[test]
fn rates_are_those_of_the_attitude() {
    for moments in MOMENTS {
        let motion = Scene::new(body(moments), state()).solve().expect("a motion");
        let step = 1e-3;
        let at = |time: f64| motion.at(time).expect("a time");
        // [8 (f(h) − f(−h)) − (f(2h) − f(−2h))]/12h of the rotation vector.
        let vector = |multiple: f64| (at(5.0).attitude.inverse() * at(5.0 + multiple * step).attitude).scaled_axis();
        let slope = ((vector(1.0) - vector(-1.0)) * 8.0 - (vector(2.0) - vector(-2.0))) / (12.0 * step);
        assert!((slope - at(5.0).angular_velocity).amax() < 1e-11, "{moments:?}");
    }
}

#[test]
fn one_output_alone_has_the_same_axes() {
    let motion = Scene::new(body(MOMENTS[0]), state()).solve().expect("a motion");
    let times = [0.0, 1.0, 50.0];
    let (mut attitudes, mut rates) = ([[0.0; 4]; 3], [[0.0; 3]; 3]);
    motion.attitudes_into(&times, &mut attitudes).expect("times");
    motion.angular_velocities_into(&times, &mut rates).expect("times");
    for (index, time) in times.iter().enumerate() {
        let sample = motion.at(*time).expect("a time");
        assert_eq!(<[f64; 4]>::from(sample.attitude.coords), attitudes[index]);
        assert_eq!(<[f64; 3]>::from(sample.angular_velocity), rates[index]);
    }
}

#[test]
fn derivatives_are_those_of_the_same_body_about_its_principal_axes() {
    for moments in MOMENTS {
        let body = body(moments);
        let axes = body.principal_axes();
        let user = UnitQuaternion::from_matrix(&axes);
        let State { epoch, attitude, angular_velocity } = state();
        let principal = State { epoch, attitude: attitude * user, angular_velocity: user.inverse() * angular_velocity };
        let of = |moments| {
            let plain = Body::new(moments).expect("a body");
            let partials = Scene::new(plain, principal).solve().expect("a motion").partials(30.0).expect("a time");
            [partials.attitude, partials.angular_velocity].map(matrix)
        };
        // A tensor has moments that are no doubles. Those of the reference are rounded: the next double of each says how much this changes the derivatives.
        let [a, b, c] = body.moments();
        let beside = [[a.next_up(), b, c], [a, b.next_up(), c], [a, b, c.next_up()]].map(of);
        let found = Scene::new(body, state()).solve().expect("a motion").partials(30.0).expect("a time");
        let found = [found.attitude, found.angular_velocity].map(matrix);
        for (part, expected) in of([a, b, c]).iter().enumerate() {
            let (found, rounded) = (found[part], beside.iter().map(|beside| (expected - beside[part]).amax()));
            let bound = 2e-14 * expected.amax() + rounded.sum::<f64>();
            for first in [0, 3] {
                let turned = axes * expected.fixed_columns::<3>(first) * axes.transpose();
                assert!((turned - found.fixed_columns::<3>(first)).amax() < bound);
            }
            let turned = axes * expected.fixed_columns::<3>(6);
            assert!((turned - found.fixed_columns::<3>(6)).amax() < bound);
        }
    }
}

fn matrix(rows: [[f64; 9]; 3]) -> SMatrix<f64, 3, 9> {
    SMatrix::from_fn(|row, column| rows[row][column])
}

#[test]
fn a_gravity_gradient_acts_on_the_tensor_as_on_the_principal_moments() {
    let moments = [1.0, 1.02, 1.05];
    let orbit = Orbit::new(2e-3, 0.1).expect("an orbit");
    let rates = Vector3::from([0.02, 0.01, 1.0]);
    let (body, attitude) = (body(moments), state().attitude);
    let user = UnitQuaternion::from_matrix(&body.principal_axes());
    let plain = Body::new(body.moments()).expect("a body");
    let principal = State { epoch: 0.0, attitude, angular_velocity: rates };
    let expected = Scene::new(plain, principal).orbit(orbit).solve().expect("a motion").at(900.0).expect("a time");
    let given = State { epoch: 0.0, attitude: attitude * user.inverse(), angular_velocity: user * rates };
    let found = Scene::new(body, given).orbit(orbit).solve().expect("a motion").at(900.0).expect("a time");
    assert!(attitude_error((found.attitude * user).coords.into(), expected.attitude.coords.into()) < 1e-12);
    assert!((found.angular_velocity - user * expected.angular_velocity).amax() < 1e-12);
}

#[test]
fn a_diagonal_tensor_is_a_body_about_its_axes() {
    let body = Body::from_inertia([[1.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]).expect("a body");
    assert_eq!(body, Body::new([1.5, 1.0, 2.0]).expect("a body"));
    assert_eq!(body.principal_axes(), Matrix3::identity());
}

#[test]
fn envisat_of_its_tensor_has_the_principal_moments_of_its_maker() {
    // Ixx, Iyy, Izz = 17023.3, 124825.7, 129112.2; Ixy, Ixz, Iyz = 397.1, −2171.4, 344.2 kg m² (ESA).
    let body =
        Body::from_inertia([[17_023.3, 397.1, -2_171.4], [397.1, 124_825.7, 344.2], [-2_171.4, 344.2, 129_112.2]])
            .expect("a body");
    let [a, b, c] = body.moments();
    assert!((a / c - 0.131_442_23).abs() < 1e-8 && (b / c - 0.966_101_28).abs() < 1e-8, "{} {}", a / c, b / c);
}

#[test]
fn tensors_that_no_body_has_are_refused() {
    let refused = |tensor| Body::from_inertia(tensor).expect_err("no body");
    let asymmetric = refused([[1.0, 0.1, 0.0], [0.1 + 1e-11, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert!(matches!(asymmetric, Error::InertiaSymmetry { row: 0, column: 1, .. }), "{asymmetric}");
    assert!(matches!(refused([[f64::NAN; 3]; 3]), Error::InertiaSymmetry { row: 0, column: 0, .. }));
    assert!(matches!(refused([[0.0; 3]; 3]), Error::InertiaMoments { .. }));
    let negative = refused([[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert!(matches!(negative, Error::InertiaMoments { .. }), "{negative}");
    let flat = refused([[1.0, 0.3, 0.0], [0.3, 1.0, 0.0], [0.0, 0.0, 2.5]]);
    assert!(matches!(flat, Error::MomentsTriangle { .. }), "{flat}");
    assert!(matches!(Body::ellipsoid([1.0, 0.0, 1.0], 1.0), Err(Error::Positive { argument: "b", .. })));
    assert!(matches!(Body::cuboid([1.0, 1.0, 1.0], -1.0), Err(Error::Positive { argument: "mass", .. })));
}
