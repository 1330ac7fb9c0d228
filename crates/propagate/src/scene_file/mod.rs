//! Scenes in TOML files.
//!
//! ```toml
//! name = "…"                       # optional, as are source, epoch (0), span, tolerance (1e-12), method ("auto"), order, averaging ("auto"), level ("auto")
//! source = "where the figures come from"
//! epoch = 0.0                      # time of the state
//! span = [0.0, 1.0e6]              # times over which the tolerance is asked for
//! tolerance = 1e-12                # \[rad\]
//! [body]
//! moments = [0.5, 0.75, 1.0]       # about body axes 1, 2, 3; or named = "ceres"; or inertia = [[…], […], […]], a tensor about axes of your own
//! [state]
//! attitude = [0.0, 0.0, 0.0, 1.0]  # [x, y, z, w], body components → inertial ones
//! angular_velocity = [0.0, 0.1, 1.0]   # body components
//! # frame = "lvlh"                 # the state is against the orbital frame "rtn" or "lvlh" of the orbit; then
//! # elements_of = "rotating"       # or "disturbing": whose orbit it is; relative = true: the rates are those against the frame; of = 0: which of several orbits
//! # sequence = "ZYX"               # if attitude has three angles
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
//! # [[torque]]                     # once for each torque beside the gravity gradient: constant, damping (a matrix), rotor or polynomial
//! # polynomial = ["0", "-2e-3*b3", "2e-3*b2"]   # in unit vectors to sources (b1, b2, b3) and rates (w1, w2, w3), body components
//! # truncation = 0.02              # of the polynomials of a shape: what they leave out, relative to the torque
//! # [[torque.source]]
//! # name = "b"                     # with direction = [0, 0, 1], inertial, or [torque.source.orbit] as above
//! # power = 3                      # with an orbit: the factor (reference_distance/r)^power
//! # reference_distance = 7.0e6     # needed if the orbit has a semi_major_axis or is a table; else 1, in semi-major axes
//! ```
//!
//! Any other key is an error. Numbers are written so that they are read back to the same bits.

mod problem;
mod read;
mod tables;
mod write;

use std::io::Read;
use std::path::Path;

use crate::error::{Error, Value as Fact};
use crate::input::scene::Scene;
use problem::{in_file, located};

/// The longest scene file \[bytes\]: 100,000 positions of a table of a disturbing body take 6 MB.
const MOST_BYTES: u64 = 16 << 20;

impl Scene {
    /// The scene of a TOML file.
    ///
    /// # Errors
    /// - [`Error::SceneFile`] for no such file, a file of more than 16 MiB, no TOML, an unknown or missing key, or a value that no scene can have. The error has
    ///   file, key, value and bound.
    pub fn from_toml(path: impl AsRef<Path>) -> Result<Self, Error> {
        let file = path.as_ref().display().to_string();
        let unreadable = |error: std::io::Error| {
            let value = Some(Fact::from(&file));
            in_file(&file, "file", error.to_string(), value, Some("a file that can be read".into()))
        };
        let opened = std::fs::File::open(path.as_ref()).map_err(unreadable)?;
        let mut bytes = Vec::new();
        // A device such as /dev/zero has no end.
        opened.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        if bytes.len() as u64 > MOST_BYTES {
            let problem = format!("a scene file must have at most {MOST_BYTES} bytes, and this one has more");
            return Err(in_file(
                &file,
                "file",
                problem,
                Some(Fact::from(&file)),
                Some("at most 16777216 bytes".into()),
            ));
        }
        let not_text = |error| unreadable(std::io::Error::new(std::io::ErrorKind::InvalidData, error));
        let text = String::from_utf8(bytes).map_err(not_text)?;
        Self::parse_toml(&text, &file)
    }

    /// The scene of a TOML text. Errors call it `file`.
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
        let document: toml::Table = text.parse().map_err(|error: toml::de::Error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
            let value = text.lines().nth(line - 1).unwrap_or_default();
            in_file(file, &format!("line {line}"), error.message().to_owned(), Some(value.into()), Some("TOML".into()))
        })?;
        let tables = serde_path_to_error::deserialize(document.clone());
        let tables: tables::SceneTable = tables.map_err(|error| located(file, &document, &error))?;
        tables.scene().map_err(|refusal| refusal.in_file(file, &document))
    }

    /// The scene as TOML. [`Scene::parse_toml`] reads it back to the same scene.
    pub fn to_toml(&self) -> String {
        // Every value of a scene has a form in TOML.
        toml::to_string(&tables::SceneTable::of(self)).unwrap_or_default()
    }
}
