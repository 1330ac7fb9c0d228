//! K2 in closed form against a numerical average over both angles, its derivatives against differences, and the brackets of the sum over pairs against it.

use nalgebra::{UnitQuaternion, Vector3};

use crate::gravity_gradient::body::contraction::SymmetricTensor;
use crate::gravity_gradient::body::inertia::{HIGHEST, Inertia};
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::mean_variables::{Mean, PeriodicChange};
use crate::gravity_gradient::orbit::derivatives::ORDERS;
use crate::gravity_gradient::orbit::elliptic_orbit::Demand;
use crate::gravity_gradient::orbit::span::{Envelope, whole};
use crate::gravity_gradient::request::Ledger;
use crate::gravity_gradient::request::osculating;
use crate::gravity_gradient::second_order::k2::{Hamiltonian, PlacedBody};
use crate::gravity_gradient::second_order::k2_orbit_mean::OrbitAverage;
use crate::gravity_gradient::second_order::mean_elements::{points, tensors};
use crate::gravity_gradient::second_order::pair_terms::Stand;
use crate::gravity_gradient::second_order::pairs::{OrbitParts, averaged, second_actions};
use crate::gravity_gradient::second_order::pairs_around::Around;
use crate::gravity_gradient::terms::term::{fast_terms, slowest};
use crate::input::options::Level;
use crate::input::orbit::Orbit;
use crate::numerics::C64;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::Polhode;
use crate::{Body, State};

mod averages;

/// Of the disturbing body: what the closed form lacks is (n/Ω)² of it.
const MEAN_MOTION: f64 = 1e-4;
const ECCENTRICITY: f64 = 0.3;

#[derive(Clone)]
struct Scene {
    polhode: Polhode,
    orbit: Orbit,
    mean: Mean,
    place: Place<pulp::Scalar>,
    envelope: Envelope,
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
        Self { polhode, orbit, mean, place, envelope: whole(ECCENTRICITY, MEAN_MOTION) }
    }

    fn demand(&self) -> Demand<'_> {
        Demand {
            orbit: &self.orbit,
            mean_motion: MEAN_MOTION,
            rates: [0.0; 2],
            axes: self.orbit.axes(),
            level: Level::Full,
            duration: 0.0,
            ledger: Ledger { of_second_order: 0.0, ..Ledger::new(1e-30, true) },
            series: None,
            envelope: &self.envelope,
            pole: self.mean.frame * Vector3::z(),
        }
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

    /// The state for the sum over pairs, with terms that are faster than `slowest`.
    fn stand<'a>(
        &'a self,
        inertia: &'a Inertia,
        tensors: &'a [SymmetricTensor; ORDERS],
        norms: &'a [f64],
        slowest: f64,
    ) -> Stand<'a> {
        Stand {
            inertia,
            mean: &self.mean,
            strength: Q,
            tensors,
            sizes: &self.envelope.epoch,
            norms,
            slowest,
            orbital_step: MEAN_MOTION,
            duration: 0.0,
            closest: 1.0,
            bend: 0.0,
            enough: 0.0,
        }
    }

    fn closed(&self, inertia: &Inertia, strength: f64) -> Hamiltonian {
        Hamiltonian::new(inertia, &fast_terms(inertia, 0.0, slowest(&self.demand())), strength)
    }
}

const Q: f64 = 1.5 * MEAN_MOTION * MEAN_MOTION;

/// D less its average at a state whose σ is near that of the tables, over q.
fn periodic(inertia: &Inertia, p: C64, longitude: f64, tensor: &SymmetricTensor) -> f64 {
    let beyond = p.norm_sqr() - inertia.sigma;
    let [xx, yy, zz, xy, xz, yz] = *tensor;
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
    let second = sum(2) * spin * spin * C64::new(xx - yy, -2.0 * xy);
    1.5 * sum(0).re * (zz - (xx + yy + zz) / 3.0) + 2.0 * (first + second).re
}

#[test]
fn the_closed_form_is_the_average_of_the_bracket_over_both_angles() {
    for scene in Scene::all() {
        let inertia = Inertia::new(&scene.polhode, scene.mean.p.norm_sqr(), scene.mean.momentum);
        let corrections = Corrections::new(&inertia, &scene.demand()).expect("no resonance");
        let (tensor, _) = tensors(&scene.mean, &scene.place, &scene.demand());
        // The torus is filled at one frame: the change turns the tensor.
        let turned = |rotation: [f64; 2], step: f64| -> SymmetricTensor {
            let [x, y] = rotation.map(|angle| step * angle);
            let turn = UnitQuaternion::new(Vector3::new(x, y, 0.0));
            tensors(&Mean { frame: scene.mean.frame * turn, ..scene.mean }, &scene.place, &scene.demand()).0[0]
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
        let [_, closed] = scene.closed(&inertia, Q).values(&axis, &scene.disturber());
        // Quotients leave 1e-8; the closed form lacks (n/Ω)² = 1e-7 of it, where its terms with n/Ω are 1e-3.
        assert!((torus / closed - 1.0).abs() <= 1e-6, "{torus:e} {closed:e} {:e} {tensor:?}", torus / closed - 1.0);
    }
}

#[test]
fn the_pairs_that_cancel_add_up_to_the_closed_form() {
    for scene in Scene::all() {
        let inertia = Inertia::new(&scene.polhode, scene.mean.p.norm_sqr(), scene.mean.momentum);
        let (tensors, norms) = tensors(&scene.mean, &scene.place, &scene.demand());
        let stand = scene.stand(&inertia, &tensors, norms, 0.0);
        let pairs = averaged(&stand, &fast_terms(&inertia, 0.0, slowest(&scene.demand())));
        let axis = scene.mean.frame * Vector3::z();
        let [_, closed] = scene.closed(&inertia, Q).values(&axis, &scene.disturber());
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
            scene.closed(&inertia, 1.0).values(axis, &disturber).iter().sum::<f64>()
        };
        let inertia = Inertia::new(&scene.polhode, sigma, momentum);
        let slopes = scene.closed(&inertia, 1.0).slopes(&axis, &disturber);
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
        let second = hamiltonian.without_first();
        let axes = scene.orbit.axes();
        let average = OrbitAverage::new(&second, ECCENTRICITY, MEAN_MOTION, axes);
        for axis in [scene.mean.frame * Vector3::z(), axes[2], Vector3::new(0.48, -0.6, 0.64)] {
            let (mut turning, mut phases) = (Vector3::zeros(), [0.0; 2]);
            for k in 0..STEPS {
                let anomaly = std::f64::consts::TAU * (k as f64 / STEPS as f64 - 0.5);
                let place = Place::of(Lanes::splat(pulp::Scalar, anomaly), ECCENTRICITY);
                let moved = Scene { place, ..scene.clone() };
                let slopes = second.slopes(&axis, &moved.disturber());
                turning += slopes.turning / STEPS as f64;
                phases = std::array::from_fn(|i| phases[i] + slopes.phases[i] / STEPS as f64);
            }
            let closed = average.slopes(&axis);
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
    let scene = Scene {
        orbit: Orbit::new(mean_motion, eccentricity).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit"),
        place: Place::of(Lanes::splat(pulp::Scalar, 0.8), eccentricity),
        envelope: whole(eccentricity, mean_motion),
        ..Scene::new([0.4, 0.7, 1.0], [0.1, 0.3, 1.0])
    };
    let demand = Demand { mean_motion, ..scene.demand() };
    let inertia = Inertia::new(&scene.polhode, scene.mean.p.norm_sqr(), scene.mean.momentum);
    let (tensors, norms) = tensors(&scene.mean, &scene.place, &demand);
    let terms = fast_terms(&inertia, 1e-4, slowest(&demand));
    let stand = scene.stand(&inertia, &tensors, norms, slowest(&demand));
    let stand = Stand { duration: 1e6, orbital_step: mean_motion, ..stand };
    let points = |places: &[(f64, f64)]| points(&scene.mean, &scene.place, &demand, places);
    let around = Around { eccentricity, mean_motion, points: &points };
    let by_sums = second_actions(&stand, &terms, &OrbitParts::default());
    let by_orbit = second_actions(&stand, &terms, &OrbitParts { around: Some(around), ..OrbitParts::default() });
    // The sums end after two derivatives: the next has a few times (2n/Ω)², where Ω is 30 n and more.
    let scale = by_sums.momentum.abs() + by_sums.action.abs();
    for (one, other) in [(by_sums.momentum, by_orbit.momentum), (by_sums.action, by_orbit.action)] {
        assert!(one != other && (one - other).abs() <= 0.02 * scale, "{one:e} {other:e}");
    }
}
