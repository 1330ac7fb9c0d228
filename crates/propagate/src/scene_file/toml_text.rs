//! Scenes in TOML files.

use std::io::Read;
use std::path::Path;

use super::tables::SceneTable;
use super::toml_problem::{in_file, located, of_refusal};
use crate::error::{Error, Value as Fact};
use crate::input::scene::Scene;

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
        let tables: SceneTable = tables.map_err(|error| located(file, &document, &error))?;
        tables.scene().map_err(|refusal| of_refusal(refusal, file, &document))
    }

    /// The scene as TOML. [`Scene::parse_toml`] reads it back to the same scene.
    pub fn to_toml(&self) -> String {
        // Every value of a scene has a form in TOML.
        toml::to_string(&SceneTable::of(self)).unwrap_or_default()
    }
}
