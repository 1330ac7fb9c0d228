//! Parts of the sentences of errors that depend on the values.

use std::f64::consts::PI;

use andoyer_series::error::Short;

/// Memory of one integration step, in bytes.
pub(crate) const STEP_BYTES: f64 = 72.0;

/// The modes and conventions in which a pair of periods is possible, as the end of a sentence.
pub(super) fn elsewhere(possible: &[[String; 2]], swapped: &[[String; 2]]) -> String {
    let listed = |pairs: &[[String; 2]]| {
        let named = pairs.iter().map(|[mode, convention]| format!("mode = {mode:?} and convention = {convention:?}"));
        named.collect::<Vec<_>>().join(", or with ")
    };
    match (possible, swapped) {
        ([], []) => "no mode and no convention has this ratio, nor its inverse".to_owned(),
        ([], swapped) => format!("the two periods fit only if they are swapped, with {}", listed(swapped)),
        (possible, _) => format!("the ratio is possible with {}", listed(possible)),
    }
}

/// Where the averages over years are, for a method of that name.
pub(super) fn evolve(method: &str) -> &'static str {
    if method == "averaged" { "; Scene.evolve averages weak torques over the rotation, without attitudes" } else { "" }
}

/// The known name most similar to an unknown one, if up to a third of its letters are wrong, missing, added or exchanged.
pub(super) fn did_you_mean(name: &str, known: &[&str]) -> String {
    let name = name.to_lowercase();
    let likeness = |known: &str| strsim::normalized_damerau_levenshtein(&known.to_lowercase(), &name);
    let best = known.iter().max_by(|one, two| likeness(one).total_cmp(&likeness(two)));
    let near = best.filter(|best| likeness(best) >= 2.0 / 3.0);
    near.map_or_else(String::new, |best| format!("; did you mean {best:?}?"))
}

/// The reason why a motion is integrated, as the end of a sentence.
pub(super) fn because(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(", by which this scene is solved: {reason}") }
}

/// Why the theory does not serve a motion, as a sentence after another.
pub(super) fn instead_of(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(". The scene is integrated because of the {reason}") }
}

/// The epoch and the span to which the bound of a time belongs.
pub(super) fn setting(epoch: f64, span: Option<[f64; 2]>) -> String {
    let span = span.map(|[start, stop]| format!(", the span is from {} to {}", Short(start), Short(stop)));
    format!("the epoch is {}{}; ", Short(epoch), span.unwrap_or_default())
}

/// `[2]` after the name of an array, or nothing after that of a number.
pub(super) fn indexed(index: Option<usize>) -> String {
    index.map(|index| format!("[{index}]")).unwrap_or_default()
}

/// The largest time from the epoch; it is 0 where the span begins or ends at the epoch.
pub(super) fn distance(bound: f64) -> String {
    if bound == 0.0 { "0".to_owned() } else { format!("{bound:.3e}") }
}

/// An angle by which an attitude may be wrong, and which is too large.
pub(super) fn turn(angle: f64, limit: f64) -> String {
    if angle < PI || limit >= PI { format!("{} rad", four_digits(angle)) } else { "half a turn or more".to_owned() }
}

/// A number rounded to four digits.
pub(super) fn four_digits(value: f64) -> Short {
    Short::rounded(value, 4)
}

/// A number rounded to two digits, with an exponent if it has more than six of them.
fn two_digits(value: f64) -> String {
    if value < 1e6 { Short::rounded(value, 2).to_string() } else { format!("{value:.1e}") }
}

/// That the terms of a resonance are too slow for a sum over time derivatives, if they are.
pub(super) fn slow(divisor: f64, bound: f64) -> String {
    if divisor < bound {
        format!(
            "; their frequency is {} times the largest angular rate of the orbit, and a sum over time derivatives needs more than {bound}",
            Short::rounded(divisor, 3)
        )
    } else {
        String::new()
    }
}

/// How many steps an integration needs, and by how much a shorter span helps.
pub(super) fn too_many(steps: f64, bound: usize) -> String {
    if steps.is_infinite() {
        return format!("more than {bound} steps, and no more are kept: use a shorter span");
    }
    let (memory, factor) = (two_digits(memory(steps)), two_digits(1.05 * steps / bound as f64));
    format!(
        "about {steps:.1e} steps, which take {memory} GB; at most {bound} are kept: use a span shorter by a factor of {factor}"
    )
}

/// Memory of a number of integration steps, in units of 1e9 bytes.
fn memory(steps: f64) -> f64 {
    steps * STEP_BYTES * 1e-9
}

/// Why a motion cannot be averaged: it is too near the separatrix, or the body does not rotate.
pub(super) fn unaveraged(mode: &str, ratio: f64, bound: f64) -> String {
    if ratio > bound {
        format!(
            "no averaged theory is valid for this motion (mode {mode}, σ/σ_sep = {ratio:.6}, which must be at most {bound})"
        )
    } else {
        "a body at rest has no averaged theory".to_owned()
    }
}

/// The requirement that a vector does not meet.
pub(super) fn finite(value: &[f64]) -> &'static str {
    if value.iter().any(|x| *x != 0.0) { "finite" } else { "finite and not 0" }
}

pub(super) fn and_others(others: usize) -> String {
    if others == 0 { String::new() } else { format!(" (and {others} more bad members)") }
}

/// Advice for a quaternion that is not an attitude.
pub(super) fn advice(norm: f64) -> &'static str {
    if norm > 0.0 && norm.is_finite() {
        "; to normalize it, divide it by its norm; a quaternion [w, x, y, z] is read with scalar_first=True in Python"
    } else {
        ""
    }
}

/// The tolerance as text with two digits, not rounded down.
pub(super) fn rounded_up(tolerance: f64) -> String {
    if tolerance < 1.0 { format!("{:.1e} rad", tolerance * 1.05) } else { "no tolerance below 1 rad".to_owned() }
}
