//! Measures the normal form about a spin–orbit resonance against the integration.
//!
//!     libration cases              the published cases, by order
//!     libration moon               the Moon on its precessing orbit: proper periods, obliquity, error over 18.6 years
//!     libration random COUNT SEED  random locked scenes over 1,000 orbits: estimate, error, order, harmonics, time
//!     libration precessing COUNT SEED  the same on orbits that precess
//!     libration reach COUNT SEED   the share of those scenes served with the tolerance 1e-8, of those that some order reaches: CSV
//!     libration climb MINUTES SEED hill climbing on error over estimate
//!     libration drawn NUMBERS      the scene of numbers that the climb printed, fixed and precessing
//!     libration speed              time of solutions and samples by CPU time of the thread, and memory

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command that prints what it measures")]

use std::time::Instant;

use andoyer_propagate::disturbers::{CassiniState, cassini_states};
use andoyer_propagate::libration_terms::Libration;
use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3};
use andoyer_propagate::{Body, Method, Motion, Orbit, Scene, State};

const TURN: f64 = std::f64::consts::TAU;

/// A state on a unit orbit at its pericentre: angles ψ, θ, φ from the frame of r rotations an orbit, whose rates are those of the frame.
fn state(resonance: f64, [psi, theta, phi]: [f64; 3]) -> State {
    let attitude = UnitQuaternion::from_euler_angles(phi, theta, psi);
    let spin = attitude.inverse() * Vector3::new(0.0, 0.0, resonance);
    State::new(0.0, attitude.coords.into(), spin.into()).expect("a state")
}

/// The largest difference of two motions at 41 times over a span.
fn difference(one: &Motion, two: &Motion, [start, stop]: [f64; 2]) -> f64 {
    let at = |motion: &Motion, k: u32| {
        let time = (start + (stop - start) * f64::from(k) / 40.0).min(stop);
        motion.at(time).expect("a time").attitude
    };
    (0..=40).map(|k| at(one, k).angle_to(&at(two, k))).fold(0.0, f64::max)
}

fn report(name: &str, scene: &Scene) -> Option<[f64; 2]> {
    let start = Instant::now();
    let solved = scene.clone().method(Method::Libration).solve();
    let first = start.elapsed().as_secs_f64();
    let motion = match solved {
        Ok(motion) => motion,
        Err(error) => {
            println!("{name}: {error} ({first:.3} s)");
            return None;
        }
    };
    let start = Instant::now();
    let _ = scene.clone().method(Method::Libration).solve();
    let again = start.elapsed().as_secs_f64();
    let (begin, stop) = scene.asked_span().expect("a span");
    let start = Instant::now();
    let truth = match scene.clone().method(Method::Integrated).tolerance(1e-12).solve() {
        Ok(truth) => truth,
        Err(error) => {
            println!("{name}: {error}");
            return None;
        }
    };
    let integration = start.elapsed().as_secs_f64();
    let times: Vec<f64> = (0..2000).map(|k| begin + (stop - begin) * f64::from(k) / 2000.0).collect();
    let mut out = vec![[0.0; 4]; times.len()];
    let start = Instant::now();
    motion.attitudes_into(&times, &mut out).expect("times");
    let sample = start.elapsed().as_secs_f64() / times.len() as f64;
    let (plan, error) = (motion.plan(), difference(&motion, &truth, [begin, stop]));
    println!(
        "{name}: order {} harmonics {} error {error:.1e} estimate {:.1e} residual {:.1e} (integration {:.0e}) solve {first:.3} again {again:.4} integration {integration:.3} s, sample {:.0} ns",
        plan.order(),
        plan.harmonics(),
        plan.error_bound(),
        motion.libration().map_or(0.0, Libration::residual),
        truth.plan().error_bound(),
        sample * 1e9
    );
    Some([error - truth.plan().error_bound(), plan.error_bound()])
}

fn cases() {
    let circle = |moments: [f64; 3], degrees: [f64; 3], resonance: f64, eccentricity: f64, tolerance: f64| {
        let body = Body::new(moments).expect("a body");
        let angles = degrees.map(f64::to_radians);
        let orbit = Orbit::new(1.0, eccentricity).expect("an orbit");
        Scene::new(body, state(resonance, angles)).orbit(orbit).span(0.0, 1000.0 * TURN).tolerance(tolerance)
    };
    let moon = [0.99948, 0.999772, 1.0];
    for (name, scene) in [
        ("circle 0.1 5 deg", circle([0.85, 0.95, 1.0], [5.0, 0.0, 0.0], 1.0, 0.0, 1e-9)),
        ("circle 2 deg", circle([0.55, 0.8, 1.0], [2.0, 1.2, 1.0], 1.0, 0.0, 1e-9)),
        ("circle 5 deg", circle([0.55, 0.8, 1.0], [5.0, 3.0, 2.5], 1.0, 0.0, 1e-6)),
        ("e 0.01, 2 deg", circle([0.85, 0.95, 1.0], [2.0, 0.0, 0.0], 1.0, 0.01, 1e-6)),
        ("Moon 1 deg", circle(moon, [1.0, 0.0, 0.0], 1.0, 0.0549, 1e-9)),
        ("Moon 0.1 deg", circle(moon, [0.1, 0.06, 0.05], 1.0, 0.0549, 1e-9)),
        ("Mercury 1 deg", circle([0.9998, 0.9999, 1.0], [1.0, 0.0, 0.0], 1.5, 0.2056, 1e-7)),
    ] {
        report(name, &scene);
    }
}

/// A number from `low` to `high`, even in the logarithm.
fn between(low: f64, high: f64, x: f64) -> f64 {
    (low.ln() + (high / low).ln() * x).exp()
}

/// What makes a locked scene: numbers from 0 to 1.
type Draw = [f64; 20];

/// A locked scene: resonance, shape, eccentricity, amplitudes, the longitude at any phase of its swing, a tilted orbit, with node and pericentre that move if
/// `precessing`, and any epoch. None if the forced libration is above 3 degrees.
fn drawn(draw: &Draw, precessing: bool) -> Option<Scene> {
    let mut numbers = draw.iter().copied();
    let mut random = || numbers.next().unwrap_or(0.5);
    let twice = [2.0, 3.0, 4.0][(random() * 3.0) as usize % 3];
    let (difference, first) = (between(1e-5, 0.3, random()), between(1e-5, 0.3, random()));
    let (b, a) = (1.0 - first, 1.0 - first - difference);
    let (circle, e) = (random() < 0.3 && twice == 2.0, between(1e-3, 0.3, random()));
    let e = if circle { 0.0 } else { e };
    let (amplitude, resonance) = (between(0.05, 10.0, random()).to_radians(), twice / 2.0);
    let forced = 2.0 * e * (3.0 * difference) / (1.0 - 3.0 * difference).abs();
    if forced > 3.0_f64.to_radians() || a + b < 1.0 {
        return None;
    }
    let widest = [random(), random(), random()].map(|x| amplitude * (2.0 * x - 1.0) / 1.7);
    let (inclination, node, argument) = (3.0 * random(), 6.0 * random(), 6.0 * random());
    let n = between(1e-7, 1e3, random());
    let epoch = 1e4 * (random() - 0.5) / n;
    let mut orbit = Orbit::new(n, e).ok()?.plane(inclination, node, argument).ok()?;
    let (mut obliquity, mut rates) = (0.0, [0.0; 2]);
    if precessing {
        orbit = orbit.plane(0.3 * inclination, node, argument).ok()?;
        let pericentre = if random() < 0.2 { 0.0 } else { between(1e-6, 1e-2, random()) };
        rates = [-n * between(1e-6, 1e-2, random()), n * pericentre];
        orbit = orbit.secular_rates(rates[0], rates[1]).ok()?;
        let spin = n * resonance + rates[1] + rates[0] * (0.3 * inclination).cos();
        let states = cassini_states(&Body::new([a, b, 1.0]).ok()?, &orbit, spin).ok()?;
        let near = |state: &&CassiniState| state.stable && state.obliquity.abs() < 0.5;
        obliquity = states.iter().find(near)?.obliquity;
    }
    let tolerance = between(1e-10, 1e-4, random());
    // Hansen's coefficient of the resonance to its first order in e.
    let torque = [1.0, 3.5 * e, 8.5 * e * e][twice as usize - 2];
    let (sine, cosine) = (TURN * random()).sin_cos();
    let (angles, swing) =
        ([widest[0] * cosine, widest[1], widest[2]], -(3.0 * difference * torque).sqrt() * widest[0] * sine);
    let inclination = orbit.elements()[3] + obliquity;
    let [z, x] = [Vector3::z_axis(), Vector3::x_axis()]
        .map(|axis| move |angle: f64| UnitQuaternion::from_axis_angle(&axis, angle));
    let turn = argument + rates[1] * epoch + resonance * n * epoch;
    let frame = z(node + rates[0] * epoch) * x(inclination) * z(turn);
    let attitude = frame * UnitQuaternion::from_euler_angles(angles[2], angles[1], angles[0]);
    let rate = (resonance + swing) * n + rates[1] + rates[0] * inclination.cos();
    let spin = attitude.inverse() * (frame * Vector3::new(0.0, 0.0, rate));
    let state = State::new(epoch, attitude.coords.into(), spin.into()).ok()?;
    let scene = Scene::new(Body::new([a, b, 1.0]).ok()?, state).orbit(orbit);
    Some(scene.span(epoch, epoch + 1000.0 * TURN / n).tolerance(tolerance))
}

/// Numbers from 0 to 1, by xorshift.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.max(1);
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Random scenes of the ranges.
fn scenes(count: usize, seed: u64, precessing: bool) -> impl Iterator<Item = (Draw, Scene)> {
    let mut next = random(seed);
    let draw = move || std::array::from_fn(|_| next());
    std::iter::repeat_with(draw).filter_map(move |draw| Some((draw, drawn(&draw, precessing)?))).take(count)
}

fn many(count: usize, seed: u64, precessing: bool) {
    let (mut served, mut above, mut most, mut met) = (0, 0, 0.0_f64, 0);
    for (number, (_, scene)) in scenes(count, seed, precessing).enumerate() {
        let [a, b, _] = scene.body().moments();
        let e = scene.asked_orbit().map_or(0.0, |orbit| orbit.elements()[1]);
        let name = format!("{} B-A {:.1e} C-B {:.1e} e {e:.3}", number + 1, b - a, 1.0 - b);
        if let Some([error, estimate]) = report(&name, &scene) {
            served += 1;
            met += usize::from(estimate <= scene.asked_tolerance());
            most = most.max(error / estimate);
            above += usize::from(error > estimate);
        }
    }
    println!(
        "{served} of {count} served, {met} within the tolerance; {above} above the estimate, at most {most:.2} times"
    );
}

/// The Moon of degree two, in days; i, node and pericentre as observed.
fn moon(tolerance: f64) -> Scene {
    let day = |period: f64| TURN / period;
    let (anomalistic, draconic, node) = (day(27.554_550), day(27.212_221), -day(6798.38));
    let attraction = 398_600.435 / 384_399.014_f64.powi(3) * 86_400.0 * 86_400.0;
    let inclination = 5.145_396_4_f64.to_radians();
    let (beta, gamma) = (6.31687e-4, 2.27873e-4);
    let b = (1.0 + gamma) / (1.0 + beta);
    let orbit = Orbit::new(anomalistic, 0.0549).and_then(|orbit| {
        orbit.plane(inclination, 0.0, 0.0)?.secular_rates(node, draconic - anomalistic)?.attraction(attraction)
    });
    let tilt = -1.54_f64.to_radians();
    let attitude = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt);
    let spin = [0.0, 0.0, draconic + node * tilt.cos()];
    let state = State::new(0.0, attitude.coords.into(), spin).expect("a state");
    let scene = Scene::new(Body::new([b - gamma, b, 1.0]).expect("a body"), state);
    scene.orbit(orbit.expect("an orbit")).span(0.0, 6798.38).tolerance(tolerance)
}

fn moons() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let scene = moon(tolerance);
        report(&format!("Moon {tolerance:.0e}"), &scene);
        let Ok(motion) = scene.method(Method::Libration).solve() else { continue };
        let Some(libration) = motion.libration() else { continue };
        println!("periods {:?} amplitudes {:?}", libration.periods(), libration.amplitudes());
        let node = 1.0 / (1.0 / libration.periods()[1] - 1.0 / 27.212_221);
        println!("relative to the node {node:.1} d");
        for term in libration.terms().iter().take(12) {
            println!("{term:?}");
        }
    }
}

/// The share of scenes served with the tolerance 1e-8, of those that some order from 4 to 12 reaches.
fn reach(count: usize, seed: u64) {
    println!("resonance,difference,eccentricity,amplitude,served,reached");
    let (mut served, mut reached) = (0, 0);
    for (draw, scene) in scenes(count, seed, false) {
        let scene = scene.tolerance(1e-8).method(Method::Libration);
        let Ok(truth) = scene.clone().method(Method::Integrated).tolerance(1e-12).solve() else { continue };
        let (start, stop) = scene.asked_span().expect("a span");
        let error = |motion: &Motion| difference(motion, &truth, [start, stop]);
        let is_served = scene.solve().is_ok_and(|motion| motion.plan().meets_tolerance());
        // A fixed order takes the time of all below it, which grows tenfold from one to the next: none is begun after 5 s.
        let begin = Instant::now();
        let reaches = |order: usize| scene.clone().order(order).solve().is_ok_and(|motion| error(&motion) <= 1e-8);
        let mut orders = (4..=12).step_by(2).take_while(|_| begin.elapsed().as_secs_f64() < 5.0);
        let is_reached = is_served || orders.any(reaches);
        (served, reached) = (served + usize::from(is_served), reached + usize::from(is_reached));
        let [a, b, _] = scene.body().moments();
        let e = scene.asked_orbit().map_or(0.0, |orbit| orbit.elements()[1]);
        let resonance = [1.0, 1.5, 2.0][(draw[0] * 3.0) as usize % 3];
        let amplitude = between(0.05, 10.0, draw[5]);
        println!("{resonance},{:.3e},{e:.4},{amplitude:.3},{},{}", b - a, u8::from(is_served), u8::from(is_reached));
    }
    eprintln!("{served} served of {reached} that some order reaches, of {count}");
}

/// Error over estimate of a scene, with the error counted as at least 1e-11 below the truth's bound.
fn excess(scene: &Scene) -> Option<f64> {
    let motion = scene.clone().method(Method::Libration).solve().ok()?;
    let truth = scene.clone().method(Method::Integrated).tolerance(1e-12).solve().ok()?;
    let (start, stop) = scene.asked_span()?;
    let error = difference(&motion, &truth, [start, stop]) - truth.plan().error_bound();
    Some(error / motion.plan().error_bound())
}

/// Hill climbing on error over estimate: a step of some numbers is kept if the ratio grows; every 12 steps without one a new scene.
fn climb(minutes: f64, seed: u64) {
    let start = Instant::now();
    let (mut next, mut most, mut count) = (random(seed), 0.0_f64, 0);
    while start.elapsed().as_secs_f64() < 60.0 * minutes {
        let precessing = next() < 0.3;
        let mut best: Draw = std::array::from_fn(|_| next());
        let Some(mut ratio) = drawn(&best, precessing).and_then(|scene| excess(&scene)) else { continue };
        let mut idle = 0;
        while idle < 12 && start.elapsed().as_secs_f64() < 60.0 * minutes {
            let size = between(0.003, 0.3, next());
            let step: Draw = std::array::from_fn(|k| {
                if next() < 0.3 { (best[k] + size * (next() - 0.5)).clamp(0.0, 0.999_999) } else { best[k] }
            });
            count += 1;
            match drawn(&step, precessing).and_then(|scene| excess(&scene)) {
                Some(higher) if higher > ratio => (best, ratio, idle) = (step, higher, 0),
                _ => idle += 1,
            }
        }
        if ratio > most {
            most = ratio;
            println!("{ratio:.3} precessing {precessing} {best:?}");
        }
    }
    println!("{count} scenes, at most {most:.3} times the estimate");
}

/// The least time of some runs \[s\], and the last result.
fn least<T>(runs: usize, mut run: impl FnMut() -> T) -> (f64, T) {
    let mut timed = || {
        let start = Instant::now();
        let result = run();
        (start.elapsed().as_secs_f64(), result)
    };
    let first = timed();
    (1..runs).fold(first, |(best, _), _| {
        let (seconds, result) = timed();
        (best.min(seconds), result)
    })
}

/// Times of scenes of 1e5 orbits with amplitudes of 1 degree, of the next state of the same body and orbit, the least of 21, and of samples.
fn speed() {
    let scene = |moments: [f64; 3], degrees: [f64; 3], e: f64, tolerance: f64| {
        let body = Body::new(moments).expect("a body");
        let orbit = Orbit::new(1.0, e).expect("an orbit");
        let scene = Scene::new(body, state(1.0, degrees.map(f64::to_radians))).orbit(orbit);
        scene.span(0.0, 1e5 * TURN).tolerance(tolerance).method(Method::Libration)
    };
    let moon = [0.99948, 0.999772, 1.0];
    for (name, one, next) in [
        (
            "circle",
            scene([0.55, 0.8, 1.0], [1.0, 0.6, 0.5], 0.0, 1e-9),
            scene([0.55, 0.8, 1.0], [0.95, 0.6, 0.5], 0.0, 1e-9),
        ),
        ("Moon", scene(moon, [1.0, 0.0, 0.0], 0.0549, 1e-9), scene(moon, [0.95, 0.0, 0.0], 0.0549, 1e-9)),
        ("Moon, pole", scene(moon, [1.0, 0.6, 0.5], 0.0549, 1e-5), scene(moon, [0.95, 0.6, 0.5], 0.0549, 1e-5)),
    ] {
        let (of_first, first) = least(1, || one.solve());
        let (of_next, second) = least(21, || next.solve());
        let (Ok(first), Ok(_)) = (first, second) else {
            println!("{name}: not served");
            continue;
        };
        let times: Vec<f64> = (0..2000).map(|k| 300.0 * f64::from(k)).collect();
        let mut out = vec![[0.0; 4]; times.len()];
        let (best, ()) = least(50, || first.attitudes_into(&times, &mut out).expect("times"));
        let plan = first.plan();
        println!(
            "{name}: order {} harmonics {} estimate {:.1e}, first {:.3} s, next {:.4} s, sample {:.0} ns",
            plan.order(),
            plan.harmonics(),
            plan.error_bound(),
            of_first,
            of_next,
            best * 1e9 / times.len() as f64
        );
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let number = |k: usize, otherwise: f64| arguments.get(k).and_then(|text| text.parse().ok()).unwrap_or(otherwise);
    let (count, seed) = (number(2, 20.0) as usize, number(3, 1.0) as u64);
    match arguments.get(1).map(String::as_str) {
        Some("cases") => cases(),
        Some("moon") => moons(),
        Some("random") => many(count, seed, false),
        Some("precessing") => many(count, seed, true),
        Some("reach") => reach(count, seed),
        Some("climb") => climb(number(2, 1.0), seed),
        Some("drawn") => {
            let text = arguments[2..].join("");
            let numbers = text.trim_matches(['[', ']']).split(',').map(|text| text.trim().parse().unwrap_or(0.5));
            let draw: Draw = numbers.collect::<Vec<f64>>().try_into().unwrap_or([0.5; 20]);
            for scene in [false, true].iter().filter_map(|&precessing| drawn(&draw, precessing)) {
                println!("{:?} {:?}", scene.body().moments(), scene.asked_orbit());
                report("drawn", &scene);
            }
        }
        Some("speed") => speed(),
        _ => eprintln!("libration cases | moon | random | precessing | reach | climb | drawn | speed"),
    }
}
