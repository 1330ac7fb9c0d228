//! Scenes in TOML files.
//!
//! ```toml
//! name = "…"                       # optional, as are source, epoch (0), span, tolerance (1e-12), method ("auto"), order, averaging ("auto"), level ("full")
//! source = "where the figures come from"
//! epoch = 0.0                      # time of the state
//! span = [0.0, 1.0e6]              # times over which the tolerance is asked for
//! tolerance = 1e-12                # \[rad\]
//! [body]
//! moments = [0.5, 0.75, 1.0]       # about body axes 1, 2, 3; or named = "ceres"; or inertia = [[…], […], […]], a tensor about axes of your own
//! [state]
//! attitude = [0.0, 0.0, 0.0, 1.0]  # [x, y, z, w], body components → inertial ones
//! angular_velocity = [0.0, 0.1, 1.0]   # body components
//! # or, instead of a state, the periods of a tumbler:
//! # [periods]
//! # precession = 27.38             # P_φ
//! # rotation = 263.0               # P_ψ
//! # mode = "short-axis"            # or "long-axis"; convention = "extremal-axis", or "long-axis", "short-axis"
//! # momentum_direction = [0, 0, 1] # inertial components, or [longitude, latitude] \[rad\]; phases = [0, 0] \[turns\]
//! [orbit]                          # optional: of the disturbing body, for the gravity gradient
//! mean_motion = 1e-3               # the only element without a default
//! eccentricity = 0.1               # 0, as time_of_pericentre, inclination, node, argument_of_pericentre; mass_fraction is 1
//! node_rate = 0.0                  # 0, as pericentre_rate: secular rates; attraction = 1e-6 instead of mean_motion² × mass_fraction
//! # [[orbit]]                      # instead, once for each of several disturbing bodies; or of one by a table of positions:
//! # times = [0.0, 60.0]            # eight at least
//! # positions = [[…], […]]         # from the rotating body, inertial components
//! # gm = 4.0e14                    # G × mass of the disturbing body
//! ```
//!
//! Any other key is an error. Numbers are written so that they are read back to the same bits.

use std::path::Path;
use std::str::FromStr;

use nalgebra::Vector3;
use toml::{Table, Value};

use crate::error::{Error, Value as Fact};
use crate::input::body::Body;
use crate::input::disturbing_body::DisturbingBody;
use crate::input::options::{Averaging, Level, MAX_ORDER};
use crate::input::orbit::Orbit;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::input::tabulated::TabulatedOrbit;
use crate::observed::periods::ObservedPeriods;

const SCENE_KEYS: &[&str] = &[
    "name",
    "source",
    "epoch",
    "span",
    "tolerance",
    "method",
    "order",
    "averaging",
    "level",
    "body",
    "state",
    "periods",
    "orbit",
];
const BODY_KEYS: &[&str] = &["moments", "named", "inertia", "name"];
const STATE_KEYS: &[&str] = &["attitude", "angular_velocity"];
const PERIODS_KEYS: &[&str] = &["precession", "rotation", "mode", "convention", "momentum_direction", "phases"];
/// In the order of [`Orbit::elements`].
const ORBIT_KEYS: &[&str; 7] = &[
    "mean_motion",
    "eccentricity",
    "time_of_pericentre",
    "inclination",
    "node",
    "argument_of_pericentre",
    "mass_fraction",
];
const MORE_ORBIT_KEYS: &[&str] = &["node_rate", "pericentre_rate", "attraction"];
const TABLE_KEYS: &[&str] = &["times", "positions", "gm"];
const ANY_ORBIT_KEYS: &[&str] = &[
    "mean_motion",
    "eccentricity",
    "time_of_pericentre",
    "inclination",
    "node",
    "argument_of_pericentre",
    "mass_fraction",
    "node_rate",
    "pericentre_rate",
    "attraction",
    "times",
    "positions",
    "gm",
];

impl Scene {
    /// The scene of a TOML file.
    ///
    /// # Errors
    /// - [`Error::SceneFile`] for no such file, no TOML, an unknown or missing key, a value that no scene has: with file, key and bound.
    pub fn from_toml(path: impl AsRef<Path>) -> Result<Self, Error> {
        let file = path.as_ref().display().to_string();
        let unreadable = |error: std::io::Error| {
            let value = Some(Fact::from(&file));
            in_file(&file, "file", error.to_string(), value, Some("a file that can be read".into()))
        };
        let text = std::fs::read_to_string(path.as_ref()).map_err(unreadable)?;
        Self::parse_toml(&text, &file)
    }

    /// The scene of a TOML text, `file` being what errors call it.
    ///
    /// # Errors
    /// As [`Scene::from_toml`].
    ///
    /// ```
    /// use andoyer_propagate::Scene;
    /// let text = "[body]\nmoments = [1.0, 2.0, 3.5]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]";
    /// let error = Scene::parse_toml(text, "flat.toml").unwrap_err();
    /// assert!(error.to_string().starts_with("flat.toml: body.moments: moments = [1.0, 2.0, 3.5]: the largest must not exceed"));
    /// ```
    pub fn parse_toml(text: &str, file: &str) -> Result<Self, Error> {
        let table: Table = text.parse().map_err(|error: toml::de::Error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
            let value = text.lines().nth(line - 1).unwrap_or_default();
            in_file(file, &format!("line {line}"), error.message().to_owned(), Some(value.into()), Some("TOML".into()))
        })?;
        let keys = Keys { file, table: &table, path: "", known: SCENE_KEYS };
        keys.check()?;
        let body_keys = keys.table("body", BODY_KEYS)?;
        let epoch = keys.number("epoch")?.unwrap_or(0.0);
        let body = body_keys.body()?;
        let scene = match (table.contains_key("state"), table.contains_key("periods")) {
            (true, true) => {
                return Err(keys.error("periods", "stands beside state: a scene has one or the other", "alone"));
            }
            (_, false) => Self::new(body, keys.table("state", STATE_KEYS)?.state(epoch)?),
            (false, true) => {
                let periods = keys.table("periods", PERIODS_KEYS)?.periods(epoch)?;
                Self::from_periods(body, &periods).map_err(|error| keys.refused(error))?
            }
        };
        let scene = keys.asked_of(scene)?;
        scene.validate().map_err(|error| keys.refused(error))?;
        Ok(scene)
    }

    /// The scene as TOML, which [`Scene::parse_toml`] reads back to the same scene.
    pub fn to_toml(&self) -> String {
        let mut table = Table::new();
        let texts = [("name", self.asked_name()), ("source", self.asked_source())];
        for (key, text) in texts.into_iter().filter_map(|(key, text)| Some((key, text?))) {
            table.insert(key.to_owned(), Value::from(text));
        }
        table.insert("epoch".to_owned(), Value::from(self.state().epoch));
        if let Some((start, stop)) = self.asked_span() {
            table.insert("span".to_owned(), Value::from(vec![start, stop]));
        }
        table.insert("tolerance".to_owned(), Value::from(self.asked_tolerance()));
        table.insert("method".to_owned(), Value::from(self.asked_method().to_string()));
        if let Some(order) = self.asked_order() {
            // At most 60.
            table.insert("order".to_owned(), Value::from(order as i64));
        }
        // What only a scene with an orbit needs is left out of the others.
        let averaging = (self.asked_averaging(), Averaging::default());
        let disturbed = !self.asked_disturbing().is_empty();
        if disturbed || averaging.0 != averaging.1 {
            table.insert("averaging".to_owned(), Value::from(averaging.0.to_string()));
        }
        if disturbed || self.asked_level() != Level::default() {
            table.insert("level".to_owned(), Value::from(self.asked_level().to_string()));
        }
        table.insert("body".to_owned(), Value::Table(self.body_table()));
        table.insert("state".to_owned(), Value::Table(self.state_table()));
        let mut bodies: Vec<Value> = self.asked_disturbing().iter().map(|body| Value::Table(body_of(body))).collect();
        match bodies.len() {
            0 => None,
            1 => table.insert("orbit".to_owned(), bodies.remove(0)),
            _ => table.insert("orbit".to_owned(), Value::Array(bodies)),
        };
        table.to_string()
    }

    fn body_table(&self) -> Table {
        let mut body = Table::new();
        if self.body().has_tensor() {
            let rows: Vec<Value> = self.body().inertia().map(|row| Value::from(row.to_vec())).into();
            body.insert("inertia".to_owned(), Value::from(rows));
        } else {
            body.insert("moments".to_owned(), Value::from(self.body().moments().to_vec()));
        }
        if let Some(name) = self.body().name() {
            body.insert("name".to_owned(), Value::from(name));
        }
        body
    }

    fn state_table(&self) -> Table {
        let mut state = Table::new();
        let attitude = self.state().attitude.coords;
        state.insert("attitude".to_owned(), Value::from(attitude.as_slice().to_vec()));
        let rates = self.state().angular_velocity;
        state.insert("angular_velocity".to_owned(), Value::from(rates.as_slice().to_vec()));
        state
    }
}

/// A disturbing body as a table.
fn body_of(body: &DisturbingBody) -> Table {
    match body {
        DisturbingBody::Orbit(orbit) => {
            let rates = MORE_ORBIT_KEYS.iter().zip(orbit.rates()).filter(|(_, rate)| *rate != 0.0);
            let attraction = MORE_ORBIT_KEYS.last().zip(orbit.asked_attraction());
            let elements = ORBIT_KEYS.iter().zip(orbit.elements()).chain(rates).chain(attraction);
            elements.map(|(key, element)| ((*key).to_owned(), Value::from(element))).collect()
        }
        DisturbingBody::Tabulated(table) => {
            let rows: Vec<Value> = table.positions().iter().map(|row| Value::from(row.to_vec())).collect();
            let values = [Value::from(table.times().to_vec()), Value::from(rows), Value::from(table.gm())];
            TABLE_KEYS.iter().zip(values).map(|(key, value)| ((*key).to_owned(), value)).collect()
        }
    }
}

/// A table of the file, with what is needed to say where something is wrong.
struct Keys<'a> {
    file: &'a str,
    table: &'a Table,
    path: &'a str,
    known: &'a [&'a str],
}

impl<'a> Keys<'a> {
    fn error(&self, key: &str, problem: impl Into<String>, bound: &str) -> Error {
        let value = self.table.get(key).map(fact);
        let key = if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        in_file(self.file, &key, problem.into(), value, Some(bound.into()))
    }

    /// What a constructor has against a value, under the key that the value came from.
    fn refused(&self, error: Error) -> Error {
        let key = match &error {
            Error::Orbit { argument, .. } | Error::Table { argument, .. } => &format!("orbit.{argument}"),
            Error::Length { argument, .. } => &format!("orbit.{argument}"),
            Error::Averaging { .. } => "averaging",
            Error::Level { .. } => "level",
            Error::Moment { .. } | Error::MomentsTriangle { .. } | Error::MomentsRatio { .. } => "body.moments",
            Error::InertiaSymmetry { .. } | Error::InertiaMoments { .. } => "body.inertia",
            Error::Positive { argument, .. } | Error::Direction { argument, .. } => &format!("periods.{argument}"),
            Error::PeriodRatio { .. } => "periods.rotation",
            Error::ModeName { .. } | Error::NoSuchMode { .. } => "periods.mode",
            Error::Convention { .. } => "periods.convention",
            Error::UnknownBody { .. } => "body.named",
            Error::Attitude { .. } => "state.attitude",
            Error::AngularVelocity { .. } => "state.angular_velocity",
            Error::Epoch { .. } => "epoch",
            Error::Tolerance { .. } => "tolerance",
            Error::Span { .. } => "span",
            Error::Order { .. } => "order",
            Error::Method { .. } => "method",
            _ => "scene",
        };
        in_file(self.file, key, error.to_string(), error.value(), error.bound())
    }

    fn missing(&self, key: &str) -> Error {
        self.error(key, "is missing, and a scene must have it", "present")
    }

    fn check(&self) -> Result<(), Error> {
        match self.table.keys().find(|key| !self.known.contains(&key.as_str())) {
            Some(key) => {
                let known = self.known.join(", ");
                Err(self.error(key, format!("is no key of a scene; known here: {known}"), &known))
            }
            None => Ok(()),
        }
    }

    fn table(&self, key: &'a str, known: &'a [&'a str]) -> Result<Self, Error> {
        let value = self.table.get(key).ok_or_else(|| self.missing(key))?;
        let table = value.as_table().ok_or_else(|| self.wrong(key, value, "a table"))?;
        let keys = Keys { file: self.file, table, path: key, known };
        keys.check()?;
        Ok(keys)
    }

    /// One table, or each of an array of them.
    fn tables(&self, key: &'a str, known: &'a [&'a str]) -> Result<Vec<Self>, Error> {
        let Some(Value::Array(bodies)) = self.table.get(key) else { return Ok(vec![self.table(key, known)?]) };
        let each = |value: &'a Value| {
            let table = value.as_table().ok_or_else(|| self.wrong(key, value, "a table"))?;
            let keys = Keys { file: self.file, table, path: key, known };
            keys.check().map(|()| keys)
        };
        bodies.iter().map(each).collect()
    }

    fn wrong(&self, key: &str, value: &Value, expected: &str) -> Error {
        self.error(key, format!("is {value}: it must be {expected}"), expected)
    }

    fn number(&self, key: &str) -> Result<Option<f64>, Error> {
        let parse = |value| as_number(value).ok_or_else(|| self.wrong(key, value, "a number"));
        self.table.get(key).map(parse).transpose()
    }

    fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>, Error> {
        let parse = |value: &Value| {
            let list: Option<Vec<f64>> = value.as_array()?.iter().map(as_number).collect();
            list?.try_into().ok()
        };
        let Some(value) = self.table.get(key) else { return Ok(None) };
        parse(value).map(Some).ok_or_else(|| self.wrong(key, value, &format!("a list of {N} numbers")))
    }

    fn text(&self, key: &str) -> Result<Option<&str>, Error> {
        let parse = |value: &'a Value| value.as_str().ok_or_else(|| self.wrong(key, value, "a text"));
        self.table.get(key).map(parse).transpose()
    }

    fn order(&self) -> Result<Option<usize>, Error> {
        let expected = format!("a whole number from 0 to {MAX_ORDER}");
        let parse = |value: &Value| {
            let order = value.as_integer().and_then(|order| usize::try_from(order).ok());
            order.filter(|&order| order <= MAX_ORDER).ok_or_else(|| self.wrong("order", value, &expected))
        };
        self.table.get("order").map(parse).transpose()
    }

    /// A scene with what the top of the file and its orbit ask of it.
    fn asked_of(&self, mut scene: Scene) -> Result<Scene, Error> {
        if let Some(tolerance) = self.number("tolerance")? {
            scene = scene.tolerance(tolerance);
        }
        if let Some([start, stop]) = self.numbers("span")? {
            scene = scene.span(start, stop);
        }
        if let Some(method) = self.choice("method")? {
            scene = scene.method(method);
        }
        if let Some(order) = self.order()? {
            scene = scene.order(order);
        }
        if let Some(averaging) = self.choice("averaging")? {
            scene = scene.averaging(averaging);
        }
        if let Some(level) = self.choice("level")? {
            scene = scene.level(level);
        }
        if self.table.contains_key("orbit") {
            let bodies = self.tables("orbit", ANY_ORBIT_KEYS)?;
            scene = scene.disturbing(bodies.iter().map(Keys::disturbing_body).collect::<Result<Vec<_>, _>>()?);
        }
        if let Some(name) = self.text("name")? {
            scene = scene.name(name);
        }
        if let Some(source) = self.text("source")? {
            scene = scene.source(source);
        }
        Ok(scene)
    }

    /// One of the names that a choice has.
    fn choice<T: FromStr<Err = Error>>(&self, key: &str) -> Result<Option<T>, Error> {
        self.text(key)?.map(|text| text.parse().map_err(|error| self.refused(error))).transpose()
    }

    /// An orbit, or a table of positions.
    fn disturbing_body(&self) -> Result<DisturbingBody, Error> {
        if !TABLE_KEYS.iter().any(|key| self.table.contains_key(*key)) {
            return self.orbit().map(DisturbingBody::from);
        }
        if let Some(key) = self.table.keys().find(|key| !TABLE_KEYS.contains(&key.as_str())) {
            return Err(self.error(
                key,
                "stands beside a table of positions, which has times, positions and gm",
                "alone",
            ));
        }
        let expected = "a list of numbers";
        let times = self.table.get("times").ok_or_else(|| self.missing("times"))?;
        let numbers = |list: &Value| list.as_array()?.iter().map(as_number).collect::<Option<Vec<f64>>>();
        let times = numbers(times).ok_or_else(|| self.wrong("times", times, expected))?;
        let rows = self.table.get("positions").ok_or_else(|| self.missing("positions"))?;
        let row = |row: &Value| numbers(row)?.try_into().ok();
        let positions = rows.as_array().and_then(|rows| rows.iter().map(row).collect::<Option<Vec<[f64; 3]>>>());
        let positions = positions
            .ok_or_else(|| self.error("positions", "must be rows of three numbers", "rows of three numbers"))?;
        let gm = self.number("gm")?.ok_or_else(|| self.missing("gm"))?;
        TabulatedOrbit::new(times, positions, gm).map(DisturbingBody::from).map_err(|error| self.refused(error))
    }

    fn orbit(&self) -> Result<Orbit, Error> {
        let or = |key, default| Ok::<f64, Error>(self.number(key)?.unwrap_or(default));
        let mean_motion = self.number("mean_motion")?.ok_or_else(|| self.missing("mean_motion"))?;
        let (time, fraction) = (or("time_of_pericentre", 0.0)?, or("mass_fraction", 1.0)?);
        let plane = [or("inclination", 0.0)?, or("node", 0.0)?, or("argument_of_pericentre", 0.0)?];
        let (rates, attraction) = ([or("node_rate", 0.0)?, or("pericentre_rate", 0.0)?], self.number("attraction")?);
        Orbit::new(mean_motion, or("eccentricity", 0.0)?)
            .and_then(|orbit| orbit.time_of_pericentre(time))
            .and_then(|orbit| orbit.plane(plane[0], plane[1], plane[2]))
            .and_then(|orbit| orbit.mass_fraction(fraction))
            .and_then(|orbit| orbit.secular_rates(rates[0], rates[1]))
            .and_then(|orbit| attraction.map_or(Ok(orbit), |attraction| orbit.attraction(attraction)))
            .map_err(|error| self.refused(error))
    }

    fn state(&self, epoch: f64) -> Result<State, Error> {
        let attitude = self.numbers("attitude")?.ok_or_else(|| self.missing("attitude"))?;
        let rates = self.numbers("angular_velocity")?.ok_or_else(|| self.missing("angular_velocity"))?;
        State::new(epoch, attitude, rates).map_err(|error| self.refused(error))
    }

    fn periods(&self, epoch: f64) -> Result<ObservedPeriods, Error> {
        let needed = |key| self.number(key)?.ok_or_else(|| self.missing(key));
        let mut periods = ObservedPeriods { epoch, ..ObservedPeriods::new(needed("precession")?, needed("rotation")?) };
        periods.mode = self.choice("mode")?.unwrap_or(periods.mode);
        periods.convention = self.choice("convention")?.unwrap_or_default();
        periods.phases = self.numbers("phases")?.unwrap_or_default();
        let key = "momentum_direction";
        match self.table.get(key).and_then(Value::as_array).map(Vec::len) {
            Some(2) => {
                let [longitude, latitude] = self.numbers(key)?.ok_or_else(|| self.missing(key))?;
                Ok(periods.towards(longitude, latitude))
            }
            _ => {
                periods.momentum_direction = self.numbers(key)?.map_or(periods.momentum_direction, Vector3::from);
                Ok(periods)
            }
        }
    }

    fn matrix(&self, key: &str) -> Result<Option<[[f64; 3]; 3]>, Error> {
        let row = |value: &Value| -> Option<[f64; 3]> {
            let list: Option<Vec<f64>> = value.as_array()?.iter().map(as_number).collect();
            list?.try_into().ok()
        };
        let parse = |value: &Value| -> Option<[[f64; 3]; 3]> {
            let rows: Option<Vec<[f64; 3]>> = value.as_array()?.iter().map(row).collect();
            rows?.try_into().ok()
        };
        let Some(value) = self.table.get(key) else { return Ok(None) };
        parse(value).map(Some).ok_or_else(|| self.wrong(key, value, "three lists of three numbers"))
    }

    fn body(&self) -> Result<Body, Error> {
        let body = match (self.numbers("moments")?, self.text("named")?, self.matrix("inertia")?) {
            (Some(moments), None, None) => Body::new(moments),
            (None, Some(name), None) => Body::named(name),
            (None, None, Some(tensor)) => Body::from_inertia(tensor),
            (None, None, None) => {
                return Err(self.error(
                    "moments",
                    "is missing: moments = [A, B, C], or named = \"ceres\" for a body of the catalogue, or inertia for a tensor",
                    "moments, named or inertia",
                ));
            }
            (Some(_), Some(_), _) => {
                return Err(self.error("named", "stands beside moments: a body has one or the other", "alone"));
            }
            _ => return Err(self.error("inertia", "stands beside moments or named: a body has one of them", "alone")),
        };
        let body = body.map_err(|error| self.refused(error))?;
        Ok(match self.text("name")? {
            Some(name) => body.with_name(name),
            None => body,
        })
    }
}

fn in_file(file: &str, key: &str, problem: String, value: Option<Fact>, bound: Option<Fact>) -> Error {
    let (value, bound) = (value.map(Box::new), bound.map(Box::new));
    Error::SceneFile { file: file.to_owned(), key: key.to_owned(), problem, value, bound }
}

/// What a file holds, as an error tells it.
fn fact(value: &Value) -> Fact {
    let list = || value.as_array()?.iter().map(as_number).collect::<Option<Vec<f64>>>();
    match value {
        Value::String(text) => text.into(),
        Value::Integer(whole) => Fact::Integer(*whole),
        Value::Float(number) => Fact::Number(*number),
        _ => list().map_or_else(|| value.to_string().into(), Fact::Numbers),
    }
}

/// A float or a whole number.
fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}
