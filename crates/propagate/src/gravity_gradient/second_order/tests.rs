//! K2 in closed form against a numerical average over both angles, its derivatives against differences, and the brackets of the sum over pairs against it.

use nalgebra::{UnitQuaternion, Vector3};

use crate::gravity_gradient::disturbance::series;
use crate::gravity_gradient::disturbance::{Disturbance, whole};
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::mean_variables::{Mean, PeriodicChange};
use crate::gravity_gradient::inertia::{HIGHEST, Inertia};
use crate::gravity_gradient::request::osculating;
use crate::gravity_gradient::second_order::k2::{DisturberLanes, Hamiltonian, in_lanes};
use crate::gravity_gradient::second_order::k2_orbit_mean::OverOrbit;
use crate::gravity_gradient::second_order::pair_terms::{PairTerm, SecondOrderState, tensors};
use crate::gravity_gradient::second_order::pairs::second_actions;
use crate::gravity_gradient::terms::term::{Term, fast_terms, slow_limit};
use crate::numerics::C64;
use crate::orbit::elements::Orbit;
use crate::orbit::kepler::Place;
use crate::orbit::span::Reach;
use crate::orbit::tensor::Deviator;
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::Polhode;
use crate::{Body, State};

mod averages;

/// Where the disturbing body is, as the averaged equations see it.
#[derive(Clone, Copy, Debug)]
struct PlacedBody {
    /// Unit vector to it.
    direction: Vector3<f64>,
    /// Normal of its orbit.
    normal: Vector3<f64>,
    /// (a/r)³.
    cube: f64,
    /// Rate of its true anomaly.
    rate: f64,
}

/// Time derivatives of the mean motion: the rotation of the invariable frame, and what is added to dℓ′/dt and dy′/dt.
#[derive(Debug)]
struct MeanRates {
    turning: Vector3<f64>,
    phases: [f64; 2],
}

impl From<([Lanes<pulp::Scalar>; 3], [Lanes<pulp::Scalar>; 2])> for MeanRates {
    fn from((turning, phases): ([Lanes<pulp::Scalar>; 3], [Lanes<pulp::Scalar>; 2])) -> Self {
        let value = |lanes: Lanes<pulp::Scalar>| lanes.values()[0];
        Self { turning: turning.map(value).into(), phases: phases.map(value) }
    }
}

/// The rates by K̄ for an angular momentum along a unit vector.
fn mean_rates(average: &OverOrbit, axis: &Vector3<f64>) -> MeanRates {
    let [axis] = in_lanes(Lanes::splat(pulp::Scalar, 0.0), &[*axis]);
    average.mean(&axis).into()
}

/// The rates by ⟨D⟩ + K2 for an angular momentum along a unit vector.
fn rates(hamiltonian: &Hamiltonian, axis: &Vector3<f64>, disturber: &PlacedBody) -> MeanRates {
    let one = |value: f64| Lanes::splat(pulp::Scalar, value);
    let PlacedBody { direction, normal, cube, rate } = *disturber;
    let [axis, direction] = in_lanes(one(0.0), &[*axis, direction]);
    hamiltonian.slopes_at(&axis, &DisturberLanes { direction, normal, cube: one(cube), rate: one(rate) }).into()
}

/// ⟨D⟩ and K2.
fn values(hamiltonian: &Hamiltonian, axis: &Vector3<f64>, disturber: &PlacedBody) -> [f64; 2] {
    let square = axis.dot(&disturber.direction).powi(2);
    let [p0, p1, p2, q0, q1] = hamiltonian.second[0];
    let moving = disturber.rate * axis.dot(&disturber.normal) * (q0 + q1 * square);
    let second = disturber.cube.powi(2) * (p0 + square * (p1 + square * p2) + moving);
    [hamiltonian.first[0] * disturber.cube * (square - 1.0 / 3.0), second]
}

/// ½ ⟨{D̃, W}⟩ from the pairs whose phases cancel, with as many time derivatives as the sums have.
fn averaged(state: &SecondOrderState<'_>, terms: &[Term]) -> f64 {
    let rows = terms.iter().map(|term| PairTerm::new(state, term));
    rows.map(|a| state.bracket(&a, &a.torque[0], &a.conjugate(), &a.conjugate().generator[0]).re).sum()
}

/// Of the disturbing body: what the closed form lacks is (n/Ω)² of it.
const MEAN_MOTION: f64 = 1e-4;
const ECCENTRICITY: f64 = 0.3;

#[derive(Clone)]
struct Scene {
    polhode: Polhode,
    orbit: Orbit,
    mean: Mean,
    place: Place<pulp::Scalar>,
}

impl Scene {
    fn all() -> [Self; 3] {
        [
            Self::new([0.7, 0.85, 1.0], [0.1, 0.05, 1.0]),
            Self::new([0.6, 0.9, 1.0], [0.02, 0.1, -1.0]),
            Self::new([0.4, 0.95, 1.0], [1.0, 0.04, 0.03]),
        ]
    }

    fn new(moments: [f64; 3], rates: [f64; 3]) -> Self {
        let state = State::new(0.0, [0.1, -0.2, 0.3, 0.927_361_849_549_570_4], rates).expect("a state");
        let polhode = Polhode::new(&Body::new(moments).expect("a body"), &state).expect("turning");
        let (_, (sigma, [anomaly, longitude])) = osculating(&polhode).expect("no separatrix");
        let orbit =
            Orbit::new(MEAN_MOTION, ECCENTRICITY).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
        let mean = Mean {
            p: C64::from_polar(sigma.sqrt(), anomaly),
            longitude,
            momentum: polhode.invariants.momentum.to_f64(),
            frame: polhode.invariable_frame(state.attitude),
        };
        let place = Place::of(Lanes::splat(pulp::Scalar, 0.8), ECCENTRICITY);
        Self { polhode, orbit, mean, place }
    }

    fn disturbance(&self) -> Disturbance<'_> {
        Disturbance { series: None, ..whole(&self.orbit, self.mean.frame * Vector3::z()) }
    }

    fn disturber(&self) -> PlacedBody {
        let [first, second, normal] = self.orbit.axes();
        let (sine, cosine) = (self.place.sine.values()[0], self.place.cosine.values()[0]);
        let eta = (1.0 - ECCENTRICITY * ECCENTRICITY).sqrt();
        let weight = 1.0 + ECCENTRICITY * cosine;
        PlacedBody {
            direction: first * cosine + second * sine,
            normal,
            cube: (weight / (eta * eta)).powi(3),
            rate: MEAN_MOTION * weight * weight / eta.powi(3),
        }
    }

    /// The state for the sum over pairs.
    fn state<'a>(&'a self, inertia: &'a Inertia, disturbance: &'a Disturbance<'a>) -> SecondOrderState<'a> {
        SecondOrderState::new(inertia, &self.mean, &self.place, disturbance)
    }

    fn closed(&self, inertia: &Inertia, strength: f64) -> Hamiltonian {
        Hamiltonian::new(inertia, &fast_terms(inertia, 0.0, slow_limit(&self.disturbance())), strength)
    }
}

const Q: f64 = 1.5 * MEAN_MOTION * MEAN_MOTION;

/// D less its average at a state whose σ is near that of the tables, over Γ.
fn periodic(inertia: &Inertia, p: C64, longitude: f64, tensor: &Deviator<pulp::Scalar>) -> f64 {
    let beyond = p.norm_sqr() - inertia.sigma;
    let [axial, across, xy, xz, yz] = tensor.map(|part| part.values()[0]);
    let sum = |multiple: usize| -> C64 {
        (-(HIGHEST as i32)..=HIGHEST as i32)
            .filter(|&h| multiple > 0 || h != 0)
            .map(|h| {
                let [value, slope, _] = inertia.tensor[multiple].jet(h);
                let power = if h >= 0 { p.powi(h) } else { p.conj().powi(-h) };
                power * (value + slope * beyond)
            })
            .sum()
    };
    let spin = C64::from_polar(1.0, longitude);
    let first = sum(1) * -C64::i() * spin * C64::new(xz, -yz);
    let second = sum(2) * spin * spin * C64::new(-across, -2.0 * xy);
    sum(0).re * axial + 2.0 * (first + second).re
}

#[test]
fn the_closed_form_is_the_average_of_the_bracket_over_both_angles() {
    for scene in Scene::all() {
        let inertia = Inertia::new(&scene.polhode, scene.mean.p.norm_sqr(), scene.mean.momentum);
        let corrections = Corrections::new(&inertia, &scene.disturbance()).expect("no resonance");
        // The torus is filled at one frame: the change turns the tensor.
        let turned = |rotation: [f64; 2], step: f64| -> Deviator<pulp::Scalar> {
            let [x, y] = rotation.map(|angle| step * angle);
            let turn = UnitQuaternion::new(Vector3::new(x, y, 0.0));
            tensors(&Mean { frame: scene.mean.frame * turn, ..scene.mean }, &scene.disturbance())(&scene.place)[0]
        };
        let (mut sum, count) = (0.0, (48, 10));
        // A change of some 1e-4 makes the quotient good to its square.
        let scale = 1e-4 / corrections.size;
        for k in 0..count.0 {
            for l in 0..count.1 {
                let anomaly = std::f64::consts::TAU * f64::from(k) / f64::from(count.0);
                let longitude = std::f64::consts::TAU * f64::from(l) / f64::from(count.1);
                let p = C64::from_polar(inertia.sigma.sqrt(), anomaly);
                let mean = Mean { p, longitude, ..scene.mean };
                let PeriodicChange { p: by_p, longitude: by_longitude, rotation, .. } =
                    corrections.at(&mean, &scene.place);
                let value = |step: f64| {
                    periodic(&inertia, p + by_p * step, longitude + by_longitude * step, &turned(rotation, step))
                };
                sum += 0.5 * (value(scale) - value(-scale)) / (2.0 * scale);
            }
        }
        let torus = Q * sum / f64::from(count.0 * count.1);
        let axis = scene.mean.frame * Vector3::z();
        let [_, closed] = values(&scene.closed(&inertia, Q), &axis, &scene.disturber());
        // Quotients leave 1e-8; the closed form lacks (n/Ω)² = 1e-7 of it, where its terms with n/Ω are 1e-3.
        assert!((torus / closed - 1.0).abs() <= 1e-6, "{torus:e} {closed:e} {:e}", torus / closed - 1.0);
    }
}

#[test]
fn the_pairs_that_cancel_add_up_to_the_closed_form() {
    for scene in Scene::all() {
        let inertia = Inertia::new(&scene.polhode, scene.mean.p.norm_sqr(), scene.mean.momentum);
        let disturbance = scene.disturbance();
        let state = scene.state(&inertia, &disturbance);
        let pairs = averaged(&state, &fast_terms(&inertia, 0.0, slow_limit(&scene.disturbance())));
        let axis = scene.mean.frame * Vector3::z();
        let [_, closed] = values(&scene.closed(&inertia, Q), &axis, &scene.disturber());
        assert!((pairs / closed - 1.0).abs() <= 1e-6, "{pairs:e} {closed:e} {:e}", pairs / closed - 1.0);
    }
}

#[test]
fn drifts_and_turning_are_the_derivatives_of_the_hamiltonian() {
    // q = 1 makes ⟨D⟩ and K2 alike in size.
    for scene in Scene::all() {
        let Mean { p, momentum, frame, .. } = scene.mean;
        let (sigma, axis, disturber) = (p.norm_sqr(), frame * Vector3::z(), scene.disturber());
        let value = |action: f64, momentum: f64, axis: &Vector3<f64>| {
            let inertia = Inertia::new(&scene.polhode, action / momentum, momentum);
            values(&scene.closed(&inertia, 1.0), axis, &disturber).iter().sum::<f64>()
        };
        let inertia = Inertia::new(&scene.polhode, sigma, momentum);
        let slopes = rates(&scene.closed(&inertia, 1.0), &axis, &disturber);
        let action = sigma * momentum;
        let (small, step) = (1e-3 * action, 1e-4 * momentum);
        let by_action =
            (value(action + small, momentum, &axis) - value(action - small, momentum, &axis)) / (2.0 * small);
        let by_momentum =
            (value(action, momentum + step, &axis) - value(action, momentum - step, &axis)) / (2.0 * step);
        for (exact, difference) in slopes.phases.into_iter().zip([by_action, by_momentum]) {
            // The square of the step, and 1e-9 of the tables over it.
            assert!((exact / difference - 1.0).abs() <= 1e-5, "{exact:e} {difference:e}");
        }
        // dk/dt = (1/M) ∂K/∂k × k.
        let gradient = Vector3::from(std::array::from_fn::<f64, 3, _>(|i| {
            let step = Vector3::ith(i, 1e-5);
            (value(action, momentum, &(axis + step)) - value(action, momentum, &(axis - step))) / 2e-5
        }));
        let expected = gradient.cross(&axis) / momentum;
        let found = slopes.turning.cross(&axis);
        assert!((expected - found).norm() <= 1e-7 * expected.norm(), "{expected:?} {found:?}");
        assert!(slopes.turning.dot(&axis).abs() <= 1e-14 * found.norm());
    }
}

#[test]
fn the_average_over_the_orbit_is_the_mean_over_the_mean_anomaly() {
    const STEPS: usize = 400;
    for scene in Scene::all() {
        let inertia = Inertia::new(&scene.polhode, scene.mean.p.norm_sqr(), scene.mean.momentum);
        let hamiltonian = scene.closed(&inertia, Q);
        // ⟨D⟩ alone would have the effect of its periodic part, which is no mean.
        let second = Hamiltonian { first: [0.0; 3], ..hamiltonian };
        let axes = scene.orbit.axes();
        let average = OverOrbit::new(&second, ECCENTRICITY, MEAN_MOTION, axes);
        for axis in [scene.mean.frame * Vector3::z(), axes[2], Vector3::new(0.48, -0.6, 0.64)] {
            let (mut turning, mut phases) = (Vector3::zeros(), [0.0; 2]);
            for k in 0..STEPS {
                let anomaly = std::f64::consts::TAU * (k as f64 / STEPS as f64 - 0.5);
                let place = Place::of(Lanes::splat(pulp::Scalar, anomaly), ECCENTRICITY);
                let moved = Scene { place, ..scene.clone() };
                let slopes = rates(&second, &axis, &moved.disturber());
                turning += slopes.turning / STEPS as f64;
                phases = std::array::from_fn(|i| phases[i] + slopes.phases[i] / STEPS as f64);
            }
            let closed = mean_rates(&average, &axis);
            let scale = phases.map(f64::abs);
            assert!((closed.turning - turning).norm() <= 1e-12 * average.fastest(), "{closed:?} {turning:?}");
            for i in 0..2 {
                assert!((closed.phases[i] - phases[i]).abs() <= 1e-12 * scale[i], "{closed:?} {phases:?}");
            }
            assert!(turning.norm() <= average.fastest());
        }
    }
}

#[test]
fn pairs_by_the_harmonics_of_the_orbit_are_those_by_time_derivatives() {
    let (mean_motion, eccentricity) = (0.02, 0.1);
    let orbit = Orbit::new(mean_motion, eccentricity).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
    let scene = Scene {
        orbit,
        place: Place::of(Lanes::splat(pulp::Scalar, 0.8), eccentricity),
        ..Scene::new([0.4, 0.7, 1.0], [0.1, 0.3, 1.0])
    };
    let disturbance = scene.disturbance();
    let inertia = Inertia::new(&scene.polhode, scene.mean.p.norm_sqr(), scene.mean.momentum);
    let terms = fast_terms(&inertia, 1e-4, slow_limit(&disturbance));
    let reach = Reach { eccentricity, anomaly: 0.0, sides: [10.0 * std::f64::consts::TAU; 2] };
    let series = series(&reach).expect("a series");
    let [by_sums, by_orbit] = [None, Some(series)].map(|series| {
        let disturbance = Disturbance { series, mean_motion, duration: 1e6, ..scene.disturbance() };
        second_actions(&scene.state(&inertia, &disturbance), &terms, &[], &[])
    });
    // The sums end after two derivatives: the next has a few times (2n/Ω)², where Ω is 30 n and more.
    let scale = by_sums.momentum.abs() + by_sums.action.abs();
    for (one, other) in [(by_sums.momentum, by_orbit.momentum), (by_sums.action, by_orbit.action)] {
        assert!(one != other && (one - other).abs() <= 0.02 * scale, "{one:e} {other:e}");
    }
}
