//! `Motion::verify` measures the error of a motion by an independent integration: it holds for good motions of every kind, and refuses bad input.

use andoyer_propagate::error::{Kind, Value};
use andoyer_propagate::options::Averaging;
use andoyer_propagate::verification::{Verification, VerifyOptions};
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State, TabulatedOrbit};

const ATTITUDE: [f64; 4] = [0.1, 0.2, 0.3, 0.927_361_849_549_570_4];
/// The floor of the integration's bound: rounding errors of its evaluation [rad].
const FLOOR: f64 = 1e-14;

fn rotating(moments: [f64; 3], rates: [f64; 3]) -> Scene {
    scene(Body::new(moments).expect("a body"), rates)
}

fn scene(body: Body, rates: [f64; 3]) -> Scene {
    Scene::new(body, State::new(3.0, ATTITUDE, rates).expect("a state"))
}

fn tumbling() -> Scene {
    rotating([0.5, 0.75, 1.0], [0.2, 0.3, 1.1])
}

fn orbit(mean_motion: f64, eccentricity: f64) -> Orbit {
    Orbit::new(mean_motion, eccentricity).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit")
}

fn table() -> TabulatedOrbit {
    let times: Vec<f64> = (-300..=300).map(f64::from).collect();
    let place = |time: &f64| [100.0 * (0.02 * time).cos(), 100.0 * (0.02 * time).sin(), 5.0];
    let positions = times.iter().map(place).collect();
    TabulatedOrbit::new(times, positions, 400.0).expect("a table")
}

fn solved(scene: Scene) -> Motion {
    scene.solve().expect("a motion")
}

fn verified(motion: &Motion) -> Verification {
    motion.verify(VerifyOptions::default()).expect("a verification")
}

fn refused(motion: &Motion, options: VerifyOptions<'_>) -> Error {
    motion.verify(options).expect_err("bad input")
}

#[test]
fn bounds_of_theory_hold_for_every_kind_of_scene() {
    let disturbed = || tumbling().orbit(orbit(3e-3, 0.2)).tolerance(1e-7);
    let precessing = orbit(2e-3, 0.2).secular_rates(1e-5, -2e-5).expect("rates");
    let tensor = [[0.8, 0.1, 0.05], [0.1, 0.7, -0.1], [0.05, -0.1, 1.0]];
    for (name, scene) in [
        ("after the epoch", disturbed().span(3.0, 3e3)),
        ("before the epoch", disturbed().span(-3e3, -1e3)),
        ("around the epoch", disturbed().span(-1e3, 2e3)),
        ("after a later start", disturbed().span(2e3, 3e3)),
        ("averaged over the orbit", disturbed().averaging(Averaging::Orbit).span(0.0, 3e4)),
        ("several bodies", tumbling().disturbing([orbit(2e-3, 0.2), orbit(3e-3, 0.0)]).tolerance(1e-5).span(0.0, 3e3)),
        ("precessing orbit", tumbling().orbit(precessing).tolerance(1e-5).span(0.0, 3e3)),
        (
            "long axis",
            rotating([0.5, 0.75, 1.0], [1.1, 0.1, 0.1]).orbit(orbit(2e-3, 0.2)).tolerance(1e-7).span(0.0, 3e3),
        ),
        (
            "user axes",
            scene(Body::from_inertia(tensor).expect("a tensor"), [0.1, 0.1, 1.0])
                .orbit(orbit(2e-3, 0.2))
                .tolerance(1e-7)
                .span(0.0, 3e3),
        ),
        ("free, by the series", tumbling().method(Method::Series).tolerance(1e-7).span(0.0, 1e3)),
    ] {
        let motion = solved(scene);
        assert_ne!(motion.plan().method(), Method::Integrated, "{name}");
        let verification = verified(&motion);
        assert!(verification.holds() && !verification.refuted(), "{name}: {verification}");
        assert!(verification.integration_bound() < 0.1 * verification.error_bound(), "{name}: {verification}");
        assert!(verification.error() > 0.0 && verification.error_bound() == motion.plan().error_bound(), "{name}");
    }
}

#[test]
fn free_motions_agree_with_their_integration_in_every_mode() {
    let with_table = || rotating([1.0; 3], [0.1, 0.2, 1.0]).disturbing([table()]);
    for (name, scene) in [
        ("short axis", tumbling().span(-40.0, 60.0)),
        ("long axis", rotating([0.5, 0.75, 1.0], [1.1, 0.1, 0.1]).span(0.0, 60.0)),
        ("separatrix", rotating([1.0, 1.5, 2.0], [0.0, 1.0, 1e-30]).span(0.0, 6.0)),
        ("axisymmetric", rotating([1.0, 1.0, 1.5], [0.3, 0.2, 1.0]).span(0.0, 60.0)),
        ("principal axis", rotating([1.0, 1.5, 2.0], [0.0, 0.0, 1.0]).span(0.0, 60.0)),
        ("sphere", rotating([1.0; 3], [0.1, 0.2, 1.0]).orbit(orbit(0.3, 0.9)).span(0.0, 60.0)),
        ("sphere, span beyond a table", with_table().span(0.0, 1e3)),
        ("at rest", rotating([1.0, 1.5, 2.0], [0.0; 3]).span(-1e3, 1e3)),
        ("at rest, without a span", rotating([1.0, 1.5, 2.0], [0.0; 3])),
        ("sphere at rest", rotating([1.0; 3], [0.0; 3]).orbit(orbit(0.3, 0.9)).span(0.0, 60.0)),
        ("one time", tumbling().span(7.0, 7.0)),
    ] {
        let verification = verified(&solved(scene));
        assert!(verification.error() <= verification.integration_bound(), "{name}: {verification}");
        assert!(verification.integration_bound() < 1e-11 && !verification.refuted(), "{name}: {verification}");
    }
}

#[test]
fn integrated_motions_are_verified_by_other_steps() {
    let precessing = orbit(0.1, 0.4).secular_rates(0.01, -0.02).expect("rates");
    let torque = || tumbling().method(Method::Integrated);
    for (name, scene) in [
        ("one body", torque().orbit(orbit(0.1, 0.4)).span(-50.0, 100.0)),
        ("several bodies", torque().disturbing([precessing, orbit(0.3, 0.1)]).span(0.0, 100.0)),
        ("table", tumbling().disturbing([table()]).span(-50.0, 100.0)),
        ("free", torque().span(-50.0, 100.0)),
        ("at rest under a torque", rotating([0.5, 0.75, 1.0], [0.0; 3]).orbit(orbit(0.1, 0.4)).span(0.0, 30.0)),
    ] {
        for tolerance in [1e-12, 1e-5] {
            let motion = solved(scene.clone().tolerance(tolerance));
            assert_eq!(motion.plan().method(), Method::Integrated, "{name}");
            let verification = verified(&motion);
            // The second integration would repeat the first if it had the same axes: at 1e-12 both have steps of the smallest truncation error.
            assert!(verification.error() > 0.0 && !verification.refuted(), "{name}: {verification}");
            if tolerance > 1e-12 && name != "table" {
                assert!(verification.holds(), "{name}: {verification}");
                assert!(verification.integration_bound() < 0.5 * motion.plan().error_bound(), "{name}: {verification}");
            }
        }
    }
}

#[test]
fn times_are_spread_evenly_over_the_span_with_both_ends() {
    let motion = solved(tumbling().orbit(orbit(2e-3, 0.2)).tolerance(1e-7).span(-1e3, 1e3));
    let whole = verified(&motion);
    assert_eq!((whole.times().len(), whole.errors().len()), (64, 64));
    assert_eq!((whole.times()[0], whole.times()[63]), (-1e3, 1e3));
    let part = motion.verify(VerifyOptions::default().span(3.0, 7.0).samples(5)).expect("a verification");
    assert_eq!(part.times(), [3.0, 4.0, 5.0, 6.0, 7.0]);
    // The epoch is among the times, and the motion has the given state there.
    assert!(part.errors()[0] < FLOOR && part.error() >= part.errors()[4]);
    let coarse = motion.verify(VerifyOptions::default().tolerance(1e-4)).expect("a verification");
    assert!(coarse.integration_bound() > 3.0 * whole.integration_bound());
}

#[test]
fn bad_input_is_refused_with_argument_value_and_bound() {
    let motion = solved(tumbling().orbit(orbit(2e-3, 0.2)).tolerance(1e-7).span(10.0, 1e3));
    let options = VerifyOptions::default;
    for samples in [0, 1, 1_000_001, usize::MAX] {
        let error = refused(&motion, options().samples(samples));
        assert_eq!(error, Error::Samples { value: samples, least: 2, most: 1_000_000 });
        assert_eq!(error.to_string(), format!("samples = {samples}: it must be from 2 to 1000000"));
    }
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(refused(&motion, options().tolerance(tolerance)), Error::Tolerance { .. }), "{tolerance}");
    }
    for (start, stop) in [(20.0, 10.0), (f64::NAN, 20.0), (10.0, f64::INFINITY)] {
        assert!(matches!(refused(&motion, options().span(start, stop)), Error::Span { .. }), "{start} {stop}");
    }
    // The epoch is 3.
    let beyond = refused(&motion, options().span(2.0, 1e3));
    assert_eq!(beyond, Error::VerifiedSpan { start: 2.0, stop: 1e3, first: 3.0, last: 1e3 });
    assert_eq!(beyond.to_string(), "span = [2, 1000]: it must be within [3, 1000], for which the error bound holds");
    assert!(matches!(refused(&motion, options().span(10.0, 1001.0)), Error::VerifiedSpan { .. }));
    let tabulated = solved(tumbling().disturbing([table()]).span(-50.0, 100.0));
    let beyond = refused(&tabulated, options().span(0.0, 301.0));
    assert_eq!((beyond.kind(), beyond.argument()), (Kind::Input, Some("span")));
    assert_eq!(beyond.bound(), Some(Value::from([-50.0, 100.0])));
}

#[test]
fn more_than_a_minute_needs_a_span_and_the_error_says_how_long_it_takes() {
    let free = solved(tumbling());
    let error = refused(&free, VerifyOptions::default());
    let sentence = "span: none is given to verify, and an integration over 1e9 rotations (no span given) takes about 28 hours (2.5e10 steps); at most 60 s \
                    are allowed without a span";
    assert_eq!((error.to_string().as_str(), error.kind(), error.argument()), (sentence, Kind::Input, Some("span")));
    assert!(
        error.bound() == Some(Value::from(60.0)) && matches!(error.value(), Some(Value::Number(time)) if time > 1e5)
    );
    assert!(free.verify(VerifyOptions::default().span(0.0, 100.0)).is_ok());
    // A whole span of 5e7 steps.
    let long = solved(tumbling().orbit(orbit(1e-4, 0.2)).span(0.0, 2e7).tolerance(1e-3));
    assert!(
        matches!(refused(&long, VerifyOptions::default()), Error::LongVerification { seconds, .. } if seconds > 300.0)
    );
    assert!(long.verify(VerifyOptions::default().span(0.0, 100.0)).is_ok());
}

#[test]
fn plans_say_what_a_verification_costs() {
    let line = |scene: Scene| {
        let text = solved(scene).plan().to_string();
        let lines: Vec<_> = text.lines().filter(|line| line.starts_with("verify ")).map(str::to_owned).collect();
        <[String; 1]>::try_from(lines).expect("one line")[0].clone()
    };
    let disturbed = || tumbling().orbit(orbit(3e-3, 0.2)).tolerance(1e-7);
    assert_eq!(line(disturbed().span(3.0, 1003.0)), "verify        takes about 16 ms (2.3e3 steps)");
    assert_eq!(line(disturbed().span(-997.0, 1003.0)), "verify        takes about 33 ms (4.7e3 steps)");
    let whole = "verify        needs a span: about 28 hours (2.5e10 steps) over 1e9 rotations (no span given)";
    assert_eq!(line(tumbling()), whole);
    assert_eq!(line(rotating([1.0, 1.5, 2.0], [0.0; 3])), "verify        takes about 0.0 ms (0.0e0 steps)");
    let motion = solved(disturbed().method(Method::Integrated).span(3.0, 1003.0));
    let steps = motion.plan().steps() as f64;
    assert!(motion.plan().to_string().contains(&format!("ms ({steps:.1e} steps)")), "{}", motion.plan());
}

#[test]
fn a_flag_ends_a_verification() {
    let motion = solved(tumbling().orbit(orbit(2e-3, 0.2)).tolerance(1e-7).span(0.0, 1e3));
    let stop = std::sync::atomic::AtomicBool::new(true);
    assert_eq!(refused(&motion, VerifyOptions::default().until(&stop)), Error::Stopped);
}
