//! Tests of the corrections with the mean variables, which are not public: the mean M is nearly constant, and the brackets are preserved.

use nalgebra::{UnitQuaternion, Vector3};

use crate::gravity_gradient::disturbance;
use crate::gravity_gradient::disturbance::{Disturbance, whole};
use crate::gravity_gradient::disturbed::chosen;
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::mean_variables::{Mean, PeriodicChange};
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::request::Request;
use crate::input::options::{Averaging, Level};
use crate::numerics::C64;
use crate::orbit::elements::Orbit;
use crate::orbit::hansen::OrbitSeries;
use crate::orbit::kepler::Place;
use crate::orbit::span::Reach;
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::Polhode;
use crate::{Body, State};

const REFERENCE: &str = include_str!("../../../../tests/data/gravity_gradient.json");

fn numbers<const N: usize>(value: &serde_json::Value) -> [f64; N] {
    let number = |v: &serde_json::Value| match v.as_str() {
        Some(text) => text.parse().expect("a decimal"),
        None => v.as_f64().expect("a number"),
    };
    let list: Vec<f64> = value.as_array().expect("a list").iter().map(number).collect();
    list.try_into().expect("the right length")
}

/// A reference case: body, orbit, and its states by time.
struct Case {
    body: Body,
    orbit: Orbit,
    states: Vec<State>,
}

impl Case {
    fn named(name: &str) -> Self {
        let file: serde_json::Value = serde_json::from_str(REFERENCE).expect("JSON");
        let case = file.as_array().expect("cases").iter().find(|case| case["name"] == name).expect("the case");
        let element = |key: &str| case["orbit"][key].as_f64().expect("a number");
        let states = case["states"].as_array().expect("states").iter().map(|state| {
            let time = state["t"].as_f64().expect("t");
            State::new(time, numbers(&state["attitude_xyzw"]), numbers(&state["angular_velocity"])).expect("a state")
        });
        Self {
            body: Body::new(numbers(&case["moments"])).expect("a body"),
            orbit: Orbit::new(element("mean_motion"), element("eccentricity")).expect("an orbit"),
            states: states.collect(),
        }
    }

    /// M of a state, and the mean M of a level.
    fn momenta(&self, state: &State, level: Level) -> [f64; 2] {
        let polhode = Polhode::new(&self.body, state).expect("turning");
        let request = Request {
            orbits: &[self.orbit],
            averaging: Averaging::Spin,
            level,
            tolerance: 1e-12,
            epoch: state.epoch,
            sides: [1.0; 2],
            spanned: true,
        };
        let (_, osculating) = crate::gravity_gradient::request::osculating(&polhode).expect("no separatrix");
        let gradient = chosen(&polhode, state.attitude, osculating, &request).expect("averaged").0;
        [
            polhode.user_momentum(),
            gradient.inertia.momentum * polhode.user_momentum() / polhode.invariants.momentum.to_f64(),
        ]
    }

    /// The range of M over the range of the mean M.
    fn ratio(&self, states: &[State], level: Level) -> f64 {
        let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for state in states {
            let momenta = self.momenta(state, level);
            least = std::array::from_fn(|i| least[i].min(momenta[i]));
            most = std::array::from_fn(|i| most[i].max(momenta[i]));
        }
        (most[0] - least[0]) / (most[1] - least[1])
    }

    /// Many states of the motion at the full level. The reference agrees with them to 3e-7 of the torque's effect.
    fn dense(&self) -> Vec<State> {
        let scene = crate::Scene::new(self.body.clone(), self.states[0]).orbit(self.orbit);
        let polhode = Polhode::new(&self.body, &self.states[0]);
        let motion = crate::solve::averaged(scene, polhode.as_ref(), &[self.orbit]).expect("averaged");
        let states = (0..800).map(|k| motion.at(0.157 * f64::from(k)).expect("finite"));
        states.map(|s| State { epoch: s.time, attitude: s.attitude, angular_velocity: s.angular_velocity }).collect()
    }
}

#[test]
fn mean_momentum_swings_as_little_as_theory_9_says_of_each_level() {
    for (name, ratio) in [("j-zero", 440.0), ("j-0.02", 39.0), ("j-0.2", 7.0)] {
        let case = Case::named(name);
        let dense = case.dense();
        let [paper, moving] = [Level::Paper, Level::Moving].map(|level| case.ratio(&dense, level));
        let full = case.ratio(&case.states, Level::Full);
        // The ratios are for 20 rotations. Over other times the largest variation of M, and so the ratio, differs by up to a third.
        assert!((paper / ratio).ln().abs() <= 0.35, "{name}: {paper}");
        assert!(moving >= 0.99 * paper && full >= 1e6, "{name}: {moving}, {full}");
    }
}

/// Mean motion of the disturbing body, in units of the spin.
const MEAN_MOTION: f64 = 1e-3;

/// A mean state, and the position of the disturbing body.
#[derive(Clone)]
struct SecondOrderState {
    polhode: Polhode,
    orbit: Orbit,
    mean: Mean,
    place: Place<pulp::Scalar>,
}

impl SecondOrderState {
    fn all() -> [Self; 3] {
        [
            Self::new([0.7, 0.85, 1.0], [0.1, 0.05, 1.0]),
            Self::new([0.6, 0.9, 1.0], [0.02, 0.1, 1.0]),
            Self::new([0.4, 0.95, 1.0], [1.0, 0.04, 0.03]),
        ]
    }

    /// The orbit's harmonics.
    fn series() -> OrbitSeries {
        disturbance::series(&Reach { eccentricity: 0.3, anomaly: 0.0, sides: [100.0; 2] }).expect("a series")
    }

    fn new(moments: [f64; 3], rates: [f64; 3]) -> Self {
        let state = State::new(0.0, [0.1, -0.2, 0.3, 0.927_361_849_549_570_4], rates).expect("a state");
        let polhode = Polhode::new(&Body::new(moments).expect("a body"), &state).expect("turning");
        let (_, (sigma, [anomaly, longitude])) =
            crate::gravity_gradient::request::osculating(&polhode).expect("no separatrix");
        let orbit = Orbit::new(MEAN_MOTION, 0.3).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
        let mean = Mean {
            p: C64::from_polar(sigma.sqrt(), anomaly),
            longitude,
            momentum: polhode.invariants.momentum.to_f64(),
            frame: polhode.invariable_frame(state.attitude),
        };
        Self { polhode, orbit, mean, place: Place::of(Lanes::splat(pulp::Scalar, 0.8), orbit.eccentricity()) }
    }

    /// The corrections, with exact divisors if there is a series.
    fn change(&self, mean: &Mean, series: Option<&OrbitSeries>) -> PeriodicChange {
        let inertia = Inertia::new(&self.polhode, mean.p.norm_sqr(), mean.momentum);
        let whole = whole(&self.orbit, self.mean.frame * Vector3::z());
        let disturbance = Disturbance { duration: 1e5, series: series.cloned(), ..whole };
        Corrections::new(&inertia, &disturbance).expect("no resonance").at(mean, &self.place)
    }

    /// Central difference of δp, δM, δy′ and δk along axes 1 and 2 when the mean state changes by ±h.
    fn slope(&self, series: Option<&OrbitSeries>, moved: impl Fn(&Mean, f64) -> Mean) -> [C64; 5] {
        const STEP: f64 = 1e-4;
        let parts = |change: PeriodicChange| {
            let [about_first, about_second] = change.rotation;
            [change.p, change.momentum.into(), change.longitude.into(), about_second.into(), (-about_first).into()]
        };
        let [after, before] = [STEP, -STEP].map(|step| parts(self.change(&moved(&self.mean, step), series)));
        std::array::from_fn(|i| (after[i] - before[i]) / (2.0 * STEP))
    }
}

#[test]
fn corrections_keep_the_poisson_brackets_to_first_order() {
    // {p; p̄} = i/M, {p; y′} = p/2M, {y′; M} = 1, {k1; k2} = k3/M, all others 0. For δf = {f; W}, Jacobi's identity is {δf; g} + {f; δg} = δ{f; g}.
    let series = SecondOrderState::series();
    for (stand, series) in
        SecondOrderState::all().into_iter().flat_map(|stand| [(stand.clone(), None), (stand, Some(&series))])
    {
        let Mean { p, momentum, .. } = stand.mean;
        let change = stand.change(&stand.mean, series);
        let by_x = stand.slope(series, |m, h| Mean { p: m.p + h, ..*m });
        let by_y = stand.slope(series, |m, h| Mean { p: m.p + C64::new(0.0, h), ..*m });
        let by_p: [C64; 5] = std::array::from_fn(|i| (by_x[i] - C64::i() * by_y[i]) * 0.5);
        let by_p_bar: [C64; 5] = std::array::from_fn(|i| (by_x[i] + C64::i() * by_y[i]) * 0.5);
        let by_momentum = stand.slope(series, |m, h| Mean { momentum: m.momentum + h, ..*m });
        let by_longitude = stand.slope(series, |m, h| Mean { longitude: m.longitude + h, ..*m });
        let by_turn = [Vector3::x(), Vector3::y()]
            .map(|axis| stand.slope(series, |m, h| Mean { frame: m.frame * UnitQuaternion::new(axis * h), ..*m }));
        let i = C64::i();
        let half = p / (2.0 * momentum);
        // {f; y′} and {y′; f} of a function f of p, p̄, y′, M.
        let to_longitude = |f: usize| by_p[f] * half + by_p_bar[f] * half.conj() - by_momentum[f];
        // {p; f}.
        let from_p = |f: usize| i / momentum * by_p_bar[f] + half * by_longitude[f];
        let (dp, dm, dy, dk) = (0, 1, 2, [3, 4]);
        // δp̄ is the conjugate of δp: ∂(δp̄)/∂p̄ = conj ∂(δp)/∂p.
        let mut residuals = vec![
            (
                "{p; p̄}",
                (by_p[dp] + by_p[dp].conj()) * i / momentum - half.conj() * by_longitude[dp]
                    + half * by_longitude[dp].conj()
                    + i * change.momentum / momentum.powi(2),
            ),
            ("{p; M}", by_longitude[dp] + from_p(dm)),
            ("{y′; M}", by_longitude[dy] - to_longitude(dm)),
            (
                "{p; y′}",
                to_longitude(dp) + from_p(dy) - change.p / (2.0 * momentum)
                    + p * change.momentum / (2.0 * momentum.powi(2)),
            ),
            ("{k1; k2}", by_turn[1][dk[0]] - by_turn[0][dk[1]] + change.momentum / momentum),
        ];
        for j in 0..2 {
            residuals.push(("{M; k}", by_turn[j][dm] / momentum - by_longitude[dk[j]]));
            residuals.push(("{p; k}", by_turn[j][dp] / momentum + from_p(dk[j])));
        }
        let size = change.p.norm() + change.longitude.abs();
        for (bracket, residual) in residuals {
            let scaled = residual.norm() / size;
            // Error budget: the square of the step, 1e-8, times derivatives that are larger by 1/σ; and 1e-10 for the slopes of the tables.
            assert!(scaled <= 1e-5, "{bracket}: {scaled:e}");
        }
    }
}

#[test]
fn exact_divisors_are_the_limit_of_the_sums_over_time_derivatives() {
    // n/Ω is at most 0.02: the eighth term of the sums, with twice the true anomaly at the pericentre, is 1e-9 of the first.
    let series = SecondOrderState::series();
    for stand in SecondOrderState::all() {
        let [sums, exact] = [None, Some(&series)].map(|series| stand.change(&stand.mean, series));
        let size = sums.p.norm() + sums.longitude.abs();
        let gaps = [
            (exact.p - sums.p).norm(),
            exact.longitude - sums.longitude,
            exact.momentum - sums.momentum,
            exact.rotation[0] - sums.rotation[0],
            exact.rotation[1] - sums.rotation[1],
        ];
        assert!(gaps.iter().all(|gap| gap.abs() <= 1e-8 * size), "{gaps:?} of {size:e}");
    }
}
