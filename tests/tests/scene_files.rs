//! Scene files: what is read back, and what is refused with file, key and bound.

use andoyer_propagate::disturbers::TabulatedOrbit;
use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::torques::{SourcePath, Torque, TorqueSource};
use andoyer_propagate::{Error, Orbit, Scene};

const GOOD: &str = "name = \"A body\"
source = \"made up\"
epoch = 5
span = [0, 1e3]
tolerance = 1e-10
method = \"series\"
order = 12
[body]
moments = [0.5, 0.75, 1.0]
[state]
attitude = [0.0, 0.6, 0.0, 0.8]
angular_velocity = [0.1, 0.2, 1.0]
";

fn refused(text: &str) -> (String, String) {
    match Scene::parse_toml(text, "scene.toml").expect_err("no scene") {
        Error::SceneFile { file, key, problem, .. } => {
            assert_eq!(file, "scene.toml");
            (key, problem)
        }
        error => panic!("{error}"),
    }
}

#[test]
fn a_scene_written_and_read_back_is_the_same_scene() {
    let scene = Scene::parse_toml(GOOD, "scene.toml").expect("a scene");
    assert_eq!((scene.asked_order(), scene.asked_span(), scene.state().epoch), (Some(12), Some((0.0, 1e3)), 5.0));
    let again = Scene::parse_toml(&scene.to_toml(), "again.toml").expect("a scene");
    assert_eq!(scene, again);
}

const ORBIT: &str = "[orbit]
mean_motion = 2e-4
eccentricity = 0.1
time_of_pericentre = -3
inclination = 0.4
node = 0.5
argument_of_pericentre = 0.6
mass_fraction = 0.7
";

#[test]
fn node_and_pericentre_have_the_rates_of_their_keys() {
    let text = format!("{GOOD}{ORBIT}node_rate = 1e-8\npericentre_rate = -2e-8\n");
    let scene = Scene::parse_toml(&text, "scene.toml").expect("a scene");
    assert_eq!(scene.asked_orbit().expect("an orbit").rates(), [1e-8, -2e-8]);
    assert_eq!(Scene::parse_toml(&scene.to_toml(), "again.toml").expect("a scene"), scene);
}

/// The scene with an orbit, and with every key.
fn with_orbit() -> String {
    format!("averaging = \"orbit\"\nlevel = \"moving\"\n{GOOD}{ORBIT}")
}

#[test]
fn a_scene_with_an_orbit_survives_writing_and_every_element_has_its_key() {
    let scene = Scene::parse_toml(&with_orbit(), "scene.toml").expect("a scene");
    let elements = scene.asked_orbit().expect("an orbit").elements();
    assert_eq!(elements, [2e-4, 0.1, -3.0, 0.4, 0.5, 0.6, 0.7]);
    assert_eq!((scene.asked_averaging(), scene.asked_level()), (Averaging::Orbit, Level::Moving));
    assert_eq!(Scene::parse_toml(&scene.to_toml(), "again.toml").expect("a scene"), scene);
    // What is not the default is kept without an orbit too.
    let free = Scene::parse_toml(&with_orbit().replace(ORBIT, ""), "scene.toml").expect("a scene");
    assert_eq!(Scene::parse_toml(&free.to_toml(), "again.toml").expect("a scene"), free);
    let least = Scene::parse_toml(&format!("{GOOD}[orbit]\nmean_motion = 1e-3"), "scene.toml").expect("a scene");
    assert_eq!(least.asked_orbit().expect("an orbit").elements(), [1e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn what_is_wrong_with_an_orbit_is_named_with_its_bound() {
    let cases = [
        ("mean_motion = 2e-4", "mean_motion = 0", "orbit.mean_motion", "positive"),
        ("mean_motion = 2e-4\n", "", "orbit.mean_motion", "is missing"),
        ("eccentricity = 0.1", "eccentricity = 1", "orbit.eccentricity", "other than 1"),
        ("time_of_pericentre = -3", "time_of_pericentre = nan", "orbit.time_of_pericentre", "finite"),
        ("inclination = 0.4", "inclination = \"tilted\"", "orbit.inclination", "must be a number"),
        ("node = 0.5", "node = inf", "orbit.node", "finite"),
        ("argument_of_pericentre = 0.6", "argument_of_pericentre = nan", "orbit.argument_of_pericentre", "finite"),
        ("mass_fraction = 0.7", "mass_fraction = 1.1", "orbit.mass_fraction", "at most 1"),
        ("mass_fraction", "mass", "orbit.mass", "expected one of `mean_motion`, `eccentricity`"),
        ("averaging = \"orbit\"", "averaging = \"moon\"", "averaging", "`auto`, `orbit`, `spin`"),
        ("level = \"moving\"", "level = \"still\"", "level", "`paper`, `moving`, `full`"),
    ];
    for (old, new, key, bound) in cases {
        let (found, problem) = refused(&with_orbit().replace(old, new));
        assert_eq!(found, key, "{new}");
        assert!(problem.contains(bound), "{new}: {problem}");
    }
    assert_eq!(refused(&format!("orbit = 3\n{GOOD}")).0, "orbit");
}

#[test]
fn every_example_scene_solves() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/scenes");
    let files = std::fs::read_dir(folder).expect("the folder").map(|entry| entry.expect("an entry").path());
    let files: Vec<_> = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    assert!(files.len() >= 5);
    for file in files {
        let scene = Scene::from_toml(&file).unwrap_or_else(|error| panic!("{error}"));
        assert!(scene.asked_source().is_some(), "{}: figures without a source", file.display());
        scene.solve().unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    }
}

#[test]
fn unknown_and_missing_keys_are_named() {
    let (key, problem) = refused(&GOOD.replace("tolerance", "tolerence"));
    assert_eq!(key, "tolerence");
    assert!(problem.contains("expected one of `name`, `source`, `epoch`"), "{problem}");
    assert_eq!(refused(&GOOD.replace("moments", "moment")).0, "body.moment");
    assert_eq!(refused(&GOOD.replace("attitude", "quaternion")).0, "state.quaternion");
    assert_eq!(refused(&GOOD.replace("attitude = [0.0, 0.6, 0.0, 0.8]", "")).0, "state.attitude");
    assert_eq!(refused("[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]").0, "body");
}

#[test]
fn bad_values_are_named_with_their_bound() {
    let cases = [
        ("tolerance = 1e-10", "tolerance = 0", "tolerance", "must be positive"),
        ("tolerance = 1e-10", "tolerance = \"fine\"", "tolerance", "must be a number"),
        ("order = 12", "order = 61", "order", "at most 60"),
        ("order = 12", "order = -1", "order", "must be a whole number, 0 or more"),
        ("order = 12", "order = 1.5", "order", "must be a whole number, 0 or more"),
        ("\"series\"", "\"magic\"", "method", "`auto`, `series`, `closed`, `integrated`"),
        ("span = [0, 1e3]", "span = [1, 0]", "span", "start ≤ stop"),
        ("span = [0, 1e3]", "span = [1]", "span", "an array of length 2"),
        ("epoch = 5", "epoch = nan", "epoch", "must be finite"),
        ("[0.5, 0.75, 1.0]", "[0.5, 0.75]", "body.moments", "an array of length 3"),
        ("[0.5, 0.75, 1.0]", "[0.5, 0.75, -1.0]", "body.moments", "must be positive"),
        ("[0.5, 0.75, 1.0]", "[0.5, 0.75, 9.0]", "body.moments", "must not exceed"),
        ("0.8]", "0.9]", "state.attitude", "within 1e-6 of 1"),
        ("[0.1, 0.2, 1.0]", "[0.1, nan, 1.0]", "state.angular_velocity", "must be finite"),
        ("name = \"A body\"", "name = 3", "name", "expected a string"),
        ("[body]\n", "[body]\nnamed = \"ceres\"\n", "body.named", "one or the other"),
        ("moments = [0.5, 0.75, 1.0]", "named = \"vulcan\"", "body.named", "not in the catalogue"),
    ];
    for (good, bad, key, bound) in cases {
        assert!(GOOD.contains(good), "{good}");
        let (found, problem) = refused(&GOOD.replacen(good, bad, 1));
        assert_eq!(found, key, "{bad}: {problem}");
        assert!(problem.contains(bound), "{bad}: {problem}");
    }
}

#[test]
fn what_is_no_toml_is_named_by_its_line_and_a_missing_file_by_its_path() {
    assert_eq!(refused("epoch = 0\nspan = [").0, "line 2");
    let error = Scene::from_toml("no/such/scene.toml").expect_err("no file");
    assert!(error.to_string().starts_with("no/such/scene.toml: file: "), "{error}");
}

#[test]
fn a_date_in_the_place_of_a_time_is_refused_in_words() {
    let text = |line: &str| {
        format!("{line}\n[body]\nmoments = [1, 1.5, 2]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]")
    };
    for (line, key, bound, found) in [
        ("epoch = 2013-01-09T12:00:00", "epoch", "a number of time units", "date 2013-01-09T12:00:00"),
        ("span = [0, 2013-01-10]", "span", "a number of time units", "date 2013-01-10"),
        ("span = [\"noon\", 2013-01-10]", "span", "a number of time units", "string \"noon\""),
        ("epoch = \"noon\"", "epoch", "a number of time units", "string \"noon\""),
        ("tolerance = \"small\"", "tolerance", "a number", "string \"small\""),
    ] {
        let error = Scene::parse_toml(&text(line), "f").expect_err("a date");
        assert_eq!(error.to_string(), format!("f: {key}: must be {bound}: invalid type: {found}"));
        assert!(!error.to_string().contains("f64"), "{error}");
        assert_eq!((error.argument(), error.bound()), (Some(key), Some(bound.into())));
    }
}

#[test]
fn an_attraction_stands_without_a_mass_fraction() {
    let text = |line: &str| {
        format!(
            "[body]\nmoments = [1, 1.5, 2]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]\n[orbit]\nmean_motion = 1e-3\nattraction = 2e-6\n{line}"
        )
    };
    assert!(Scene::parse_toml(&text(""), "f").is_ok() && Scene::parse_toml(&text("mass_fraction = 1.0"), "f").is_ok());
    // The fraction was ignored.
    let error = Scene::parse_toml(&text("mass_fraction = 0.5"), "f").expect_err("both").to_string();
    assert!(
        error.starts_with("f: orbit.attraction: ") && error.contains("with no mass_fraction other than 1"),
        "{error}"
    );
    let orbit = Orbit::new(1e-3, 0.0).and_then(|orbit| orbit.attraction(2e-6)).expect("an orbit");
    assert_eq!(orbit.mass_fraction(1.0), Ok(orbit));
    let error = orbit.mass_fraction(0.5).expect_err("both");
    assert_eq!(error.argument(), Some("mass_fraction"));
}

#[test]
fn a_source_with_a_unit_of_length_needs_a_reference_distance() -> Result<(), Error> {
    let bare = Orbit::new(1.0, 0.1)?;
    let table = TabulatedOrbit::new((0..8).map(f64::from).collect(), vec![[7e6, 0.0, 0.0]; 8], 1.0)?;
    let torque = |path: &SourcePath, power: f64, distance: Option<f64>| {
        let source = TorqueSource::new("a", path.clone()).falling(power, distance);
        Torque::polynomial(["a1", "0", "0"], vec![source])
    };
    let hyperbola = Orbit::new(1.0, 1.5)?.semi_major_axis(7e6)?;
    for path in [
        SourcePath::Orbit(bare.semi_major_axis(1.0)?),
        SourcePath::Orbit(hyperbola),
        SourcePath::Tabulated(table.into()),
    ] {
        let refused = torque(&path, -2.0, None);
        assert!(matches!(refused, Err(Error::Torque { argument: "reference_distances", .. })), "{refused:?}");
        assert!(torque(&path, -2.0, Some(7e6)).is_ok() && torque(&path, 0.0, None).is_ok());
    }
    // Semi-major axes are the unit of an orbit that has no other.
    let path = SourcePath::Orbit(bare);
    assert_eq!(torque(&path, 3.0, None)?, torque(&path, 3.0, Some(1.0))?);
    let file = |keys: &str| {
        let head = "span = [0.0, 1.0]\n[body]\nmoments = [1.0, 1.5, 2.0]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]\n[[torque]]";
        let source = format!("polynomial = [\"b1\", \"0\", \"0\"]\n[[torque.source]]\nname = \"b\"\npower = 3\n{keys}");
        Scene::parse_toml(&format!("{head}\n{source}"), "dipole.toml").map_err(|error| error.to_string())
    };
    assert!(file("orbit = { mean_motion = 1.0 }").is_ok());
    assert!(file("reference_distance = 7e6\norbit = { mean_motion = 1.0, semi_major_axis = 7e6 }").is_ok());
    let refused = file("orbit = { mean_motion = 1.0, semi_major_axis = 7e6 }").expect_err("no distance");
    assert!(refused.contains("reference_distances = b: none: it must be given"), "{refused}");
    Ok(())
}
