//! JSON texts with a format and a version.

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::error::Error;

/// The fields of a text, if it has this format and version.
pub(crate) fn document<D: DeserializeOwned>(
    text: &str,
    known_format: &'static str,
    known_version: u64,
) -> Result<D, Error> {
    #[derive(Deserialize)]
    struct Header {
        format: String,
        version: u64,
    }
    let Header { format, version } = serde_json::from_str(text).map_err(Error::json)?;
    if format != known_format || version != known_version {
        return Err(Error::FormatUnknown { format, version, known_format, known_version });
    }
    serde_json::from_str(text).map_err(Error::json)
}

/// Refuses a list of another length.
pub(crate) fn count(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::CountMismatch { what, found, expected }) }
}
