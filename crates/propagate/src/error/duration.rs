//! A duration as text.

/// Units of time with their lengths in seconds, each with the number of them from which the next one is used.
const UNITS: [(&str, f64, f64); 5] =
    [("ms", 1e-3, 1e3), ("s", 1.0, 90.0), ("minutes", 60.0, 90.0), ("hours", 3600.0, 48.0), ("days", 86400.0, 730.0)];
const YEAR: f64 = 3.156e7;

/// A number of seconds with two digits, in a unit of its size.
pub(crate) fn duration_in_words(seconds: f64) -> String {
    let unit = UNITS.iter().find(|(_, length, most)| seconds < length * most);
    let (name, length) = unit.map_or(("years", YEAR), |(name, length, _)| (*name, *length));
    match seconds / length {
        count if count >= 1e4 => format!("{count:.1e} {name}"),
        count if count >= 9.95 => format!("{count:.0} {name}"),
        count => format!("{count:.1} {name}"),
    }
}
