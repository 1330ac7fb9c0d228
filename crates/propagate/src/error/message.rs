//! The sentence of each error: the argument, its value, the bound, and what the caller can do.

use std::f64::consts::PI;
use std::fmt;

use andoyer_series::error::Short;

use super::{Error, STEP_BYTES, TorqueMeasure, duration_in_words};

impl fmt::Display for Error {
    // A table: one line for each variant, in the order of the enumeration. rustfmt leaves it, since the sentences are longer than its width.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Moment { axis, value } => write!(f, "moments[{axis}] = {value}: a moment of inertia must be positive and finite", value = Short(*value)),
            Self::InertiaSymmetry { row, column, value, mirrored } => write!(f, "tensor[{row}][{column}] = {value} and tensor[{column}][{row}] = {mirrored}: an inertia tensor must be finite and symmetric to 1e-12 of its largest entry", value = Short(*value), mirrored = Short(*mirrored)),
            Self::InertiaMoments { moments } => write!(f, "tensor: its principal moments are {moments:?}, and each must be positive"),
            Self::Positive { argument, value } => write!(f, "{argument} = {value}: it must be positive and finite", value = Short(*value)),
            Self::MomentsTriangle { moments, ratio } => write!(f, "moments = {moments:?}: the largest must not exceed the sum of the other two (it is {ratio} times that sum)", ratio = Short(*ratio)),
            Self::MomentsRatio { moments, ratio, bound } => write!(f, "moments = {moments:?}: the largest must not exceed {bound:e} times the smallest (it is {ratio:e} times it)"),
            Self::Units { quantity, exponent } => write!(f, "moments and angular_velocity: {quantity}, 2^{exponent}, is not a normal double, or is too near the largest; choose other units"),
            Self::Attitude { value, norm } => write!(f, "attitude = {value:?}: a quaternion [x, y, z, w] must be finite with a norm within 1e-6 of 1 (it is {norm}){}", advice(*norm), norm = Short(*norm)),
            Self::AngularVelocity { axis, value } => write!(f, "angular_velocity[{axis}] = {value}: a rate must be finite", value = Short(*value)),
            Self::Epoch { value } => write!(f, "epoch = {value}: it must be finite", value = Short(*value)),
            Self::Tolerance { value } => write!(f, "tolerance = {value}: it must be positive and finite [rad]", value = Short(*value)),
            Self::Span { start, stop } => write!(f, "span = [{start}, {stop}]: it must be finite with start ≤ stop", start = Short(*start), stop = Short(*stop)),
            Self::Order { value, bound } => write!(f, "order = {value}: it must be at most {bound}"),
            Self::Method { value } => write!(f, "method = {value:?}: it must be \"auto\", \"series\", \"closed\" or \"integrated\""),
            Self::Time { index, value, epoch, span, bound, reason } => write!(f, "times[{index}] = {value}: {}a time must be finite and within {} of the epoch{reason}", setting(*epoch, *span), distance(*bound), value = Short(*value)),
            Self::Length { argument, found, expected } => write!(f, "{argument} has {found} entries: it must have {expected}"),
            Self::TooFew { argument, found, least } => write!(f, "{argument} has {found} entries: it must have {least} or more"),
            Self::NearSeparatrix { ratio, tolerance, attainable, highest } => write!(f, "too near the separatrix for the series: at σ/σ_sep = {ratio} the highest order, {highest}, is good to {}, and the tolerance is {tolerance:e} rad", rounded_up(*attainable), ratio = Short(*ratio)),
            Self::Separatrix => f.write_str("on the separatrix (falling away from rotation about the axis of middle inertia, or towards it): no order of the series is valid; use the closed form"),
            Self::SeparatrixPartials => f.write_str("on the separatrix (falling away from rotation about the axis of middle inertia, or towards it) the frequencies have no derivatives; choose a state beside the separatrix"),
            Self::CodeLanguage { value } => write!(f, "language = {value:?}: it must be \"c\", \"rust\", \"python\" or \"javascript\""),
            Self::NoCode { motion } => write!(f, "no code is written of {motion}: rest, steady rotation and torque-free wobbles of both modes have code; a C-kernel or an attitude file holds any motion"),
            Self::Convention { value } => write!(f, "convention = {value:?}: it must be \"extremal-axis\", \"long-axis\" or \"short-axis\""),
            Self::ModeName { value } => write!(f, "mode = {value:?}: it must be \"short-axis\" or \"long-axis\""),
            Self::NoSuchMode { mode, moments, pair } => write!(f, "mode = {mode:?}: a body with moments {moments:?} does not have this mode, since its {pair} moments are equal"),
            Self::PeriodRatio { ratio, mode, convention, lower, upper, possible, swapped } => write!(f, "rotation/precession = {ratio}: in the {mode} mode and the {convention} convention this body has P_ψ/P_φ from {lower} up to {upper}; {}", elsewhere(possible, swapped), ratio = Short(*ratio), lower = Short(*lower), upper = Short(*upper)),
            Self::Latitude { value: [longitude, latitude] } => write!(f, "momentum_direction = [{longitude}, {latitude}]: it is [longitude, latitude] in radians, and the latitude must be from -π/2 to π/2", longitude = Short(*longitude), latitude = Short(*latitude)),
            Self::Direction { argument, value } => write!(f, "{argument} = {value:?}: it must be finite{}", if value.iter().any(|x| *x != 0.0) { "" } else { " and not 0" }),
            Self::Andoyer { index, value, bound } => write!(f, "andoyer[{index}] = {value}: it must be {bound}", value = Short(*value)),
            Self::Orbit { argument, value, bound } => write!(f, "orbit.{argument} = {value}: it must be {bound}", value = Short(*value)),
            Self::NoSemiMajorAxis => f.write_str("orbit.semi_major_axis: none is given, and a position on the orbit needs it; it must be positive, in the unit of length of the position"),
            Self::Level { value } => write!(f, "level = {value:?}: it must be \"auto\", \"paper\", \"moving\", \"full\" or \"second-order\""),
            Self::OneFixedOrbit { argument, value } => write!(f, "{argument} = \"{value}\" needs one disturbing body on an orbit without node_rate and pericentre_rate"),
            Self::Averaging { value } => write!(f, "averaging = {value:?}: it must be \"auto\", \"orbit\" or \"spin\""),
            Self::Resonance { harmonic, multiple, divisor, bound, effect, limit } => write!(f, "spin resonance (h, m) = ({harmonic}, {multiple}): the terms in h times the angle of the wobble plus m times that of the rotation may turn the attitude by {} over the span (1e9 rotations if none is given); at most {} rad is allowed{}: give a shorter span, or integrate (method = integrated, with a span)", turn(*effect, *limit), four_digits(*limit), slow(*divisor, *bound)),
            Self::TorqueTooStrong { measure, size, bound } => write!(f, "the torque is too strong for an expansion in it: {}", measured(*measure, *size, *bound)),
            Self::TooManyOrbits { orbits, bound } => write!(f, "averaging = spin: the span has {orbits:.0} orbits on one side of the epoch, and the averaged equations are solved for {bound} at most; averaging over the orbit reaches farther"),
            Self::SpanOfBodies { value, bound } => write!(f, "span: it reaches {value} from the epoch, and the averaged equations are solved up to {bound:.6e}", value = Short(*value)),
            Self::Unaveraged { mode, ratio, bound } if ratio > bound => write!(f, "orbit: no averaged theory is valid for this motion (mode {mode}, σ/σ_sep = {ratio:.6}, which must be at most {bound})"),
            Self::Unaveraged { .. } => f.write_str("orbit: a body at rest has no averaged theory"),
            Self::Table { argument, index, value, bound } => write!(f, "orbit.{argument}[{index}] = {value}: it must be {bound}", value = Short(*value)),
            Self::TableSpan { start, stop, first, last } => write!(f, "span: the integration goes from {start} to {stop}, and the table of positions only from {first} to {last}", start = Short(*start), stop = Short(*stop), first = Short(*first), last = Short(*last)),
            Self::NoSpan { reason } => write!(f, "span: none is given, and the integrated method needs one{}", because(reason)),
            Self::OnlyIntegrated { method, reason } => write!(f, "method = \"{method}\": {reason}; use method = \"integrated\" or \"auto\" with a span"),
            Self::TooManySteps { steps, bound, reason } if steps.is_infinite() => write!(f, "span: the integration needs more than {bound} steps, and no more are kept: use a shorter span{}", instead_of(reason)),
            Self::TooManySteps { steps, bound, reason } => write!(f, "span: the integration needs about {steps:.1e} steps, which take {} GB; at most {bound} are kept: use a span shorter by a factor of {}{}", two_digits(memory(*steps)), two_digits(1.05 * steps / *bound as f64), instead_of(reason)),
            Self::Unpredictable { tolerance, span: [first, last], start, stop } => write!(f, "span = [{first}, {last}]: nearby states separate so fast that the attitude is unknown at its end; the tolerance, {tolerance:e} rad, holds from {start} to {stop}", first = Short(*first), last = Short(*last), start = Short(*start), stop = Short(*stop)),
            Self::Samples { value, least, most } => write!(f, "samples = {value}: it must be from {least} to {most}"),
            Self::VerifiedSpan { start, stop, first, last } => write!(f, "span = [{start}, {stop}]: it must be within [{first}, {last}], for which the error bound holds", start = Short(*start), stop = Short(*stop), first = Short(*first), last = Short(*last)),
            Self::LongVerification { seconds, steps, bound, over } => write!(f, "span: none is given to verify, and an integration over {over} takes about {} ({steps:.1e} steps); at most {bound} s are allowed without a span", duration_in_words(*seconds)),
            Self::Member { index, others, problem } => write!(f, "member {index}: {problem}{}", and_others(*others)),
            Self::OnError { value } => write!(f, "errors = {value:?}: it must be \"raise\" or \"nan\""),
            Self::Stopped => f.write_str("stopped before the end"),
            Self::Index { index, members } => write!(f, "index = {index}: the ensemble has {members} members, counted from 0"),
            Self::Threads { value, problem } => write!(f, "threads = {value}: {problem}"),
            Self::UnknownBody { name, known } => write!(f, "body {name:?} is not in the catalogue{}: it has {}", did_you_mean(name, known), known.join(", ")),
            Self::Series(error) => error.fmt(f),
            Self::SceneFile { file, key, problem, .. } => write!(f, "{file}: {key}: {problem}"),
        }
    }
}

/// The modes and conventions in which a pair of periods is possible, as the end of a sentence.
fn elsewhere(possible: &[[String; 2]], swapped: &[[String; 2]]) -> String {
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

/// The known name most similar to an unknown one, if up to a third of its letters are wrong, missing, added or exchanged.
fn did_you_mean(name: &str, known: &[&str]) -> String {
    let name = name.to_lowercase();
    let likeness = |known: &str| strsim::normalized_damerau_levenshtein(&known.to_lowercase(), &name);
    let best = known.iter().max_by(|one, two| likeness(one).total_cmp(&likeness(two)));
    let near = best.filter(|best| likeness(best) >= 2.0 / 3.0);
    near.map_or_else(String::new, |best| format!("; did you mean {best:?}?"))
}

/// The reason why a motion is integrated, as the end of a sentence.
fn because(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(", by which this scene is solved: {reason}") }
}

/// Why the theory does not serve a motion, as a sentence after another.
fn instead_of(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(". The scene is integrated because of the {reason}") }
}

/// The epoch and the span to which the bound of a time belongs.
fn setting(epoch: f64, span: Option<[f64; 2]>) -> String {
    let span = span.map(|[start, stop]| format!(", the span is from {} to {}", Short(start), Short(stop)));
    format!("the epoch is {}{}; ", Short(epoch), span.unwrap_or_default())
}

/// The largest time from the epoch; it is 0 where the span begins or ends at the epoch.
fn distance(bound: f64) -> String {
    if bound == 0.0 { "0".to_owned() } else { format!("{bound:.3e}") }
}

/// An angle by which an attitude may be wrong, and which is too large.
fn turn(angle: f64, limit: f64) -> String {
    if angle < PI || limit >= PI { format!("{} rad", four_digits(angle)) } else { "half a turn or more".to_owned() }
}

/// A number rounded to four digits.
fn four_digits(value: f64) -> Short {
    Short(format!("{value:.3e}").parse().unwrap_or(value))
}

/// A number rounded to two digits, with an exponent if it has more than six of them.
fn two_digits(value: f64) -> String {
    let text = format!("{value:.1e}");
    if value < 1e6 { Short(text.parse().unwrap_or(value)).to_string() } else { text }
}

/// What shows that a torque is too strong, with its value and its limit.
fn measured(measure: TorqueMeasure, size: f64, bound: f64) -> String {
    let [size, bound] = [size, bound].map(four_digits);
    match measure {
        TorqueMeasure::Strength => format!(
            "its strength 3n²C(C−A)/2M², where the disturbing body is nearest, is {size}, and must be at most {bound}"
        ),
        TorqueMeasure::Corrections => {
            format!("the short-period corrections add up to {size} rad, and must add up to at most {bound} rad")
        }
        TorqueMeasure::Contraction => format!(
            "an iteration for the mean variables leaves {size} of the last change, and must leave at most {bound}"
        ),
        TorqueMeasure::Precession => format!(
            "the angular momentum precesses by {size} rad in one radian of the orbit, and must precess by at most {bound} rad"
        ),
        TorqueMeasure::ErrorBound => {
            format!("the error bound over the span, {size} rad, exceeds the effect of the torque, {bound} rad")
        }
    }
}

/// That the terms of a resonance are too slow for a sum over time derivatives, if they are.
fn slow(divisor: f64, bound: f64) -> String {
    if divisor < bound {
        format!(
            "; their frequency is {divisor:.3} times the largest angular rate of the orbit, and a sum over time derivatives needs more than {bound}"
        )
    } else {
        String::new()
    }
}

/// Memory of a number of integration steps, in units of 1e9 bytes.
fn memory(steps: f64) -> f64 {
    steps * STEP_BYTES * 1e-9
}

fn and_others(others: usize) -> String {
    if others == 0 { String::new() } else { format!(" (and {others} more bad members)") }
}

/// Advice for a quaternion that is not an attitude.
fn advice(norm: f64) -> &'static str {
    if norm > 0.0 && norm.is_finite() {
        "; to normalize it, divide it by its norm; a quaternion [w, x, y, z] is read with scalar_first=True in Python"
    } else {
        ""
    }
}

/// The tolerance as text with two digits, not rounded down.
fn rounded_up(tolerance: f64) -> String {
    if tolerance < 1.0 { format!("{:.1e} rad", tolerance * 1.05) } else { "no tolerance below 1 rad".to_owned() }
}
