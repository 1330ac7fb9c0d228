//! What can be wrong with an input, and what the series can't serve: each with its argument, its value and the bound.

mod facts;

pub use facts::{Kind, Value};

/// Bytes of a step of an integration.
pub(crate) const STEP_BYTES: f64 = 72.0;

/// The error of this crate: what was given, and what would have been accepted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A moment of inertia that is zero, negative, NaN or infinite.
    #[error("moments[{axis}] = {value}: a moment of inertia must be positive and finite")]
    Moment {
        /// Index of the body axis, 0 to 2.
        axis: usize,
        /// The moment as given.
        value: f64,
    },
    /// An inertia tensor that is not symmetric, or not finite.
    #[error(
        "tensor[{row}][{column}] = {value} and tensor[{column}][{row}] = {mirrored}: an inertia tensor must be finite and symmetric to 1e-12 of its largest entry"
    )]
    InertiaSymmetry {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// The entry.
        value: f64,
        /// The entry across the diagonal.
        mirrored: f64,
    },
    /// An inertia tensor with a principal moment that is not positive.
    #[error("tensor: its principal moments are {moments:?}, and each must be positive")]
    InertiaMoments {
        /// The principal moments.
        moments: [f64; 3],
    },
    /// A length or a mass that is zero, negative, NaN or infinite.
    #[error("{argument} = {value}: it must be positive and finite")]
    Positive {
        /// The argument.
        argument: &'static str,
        /// The value as given.
        value: f64,
    },
    /// Moments that no body has: the largest exceeds the sum of the others.
    #[error(
        "moments = {moments:?}: the largest must not exceed the sum of the other two (it is {ratio} times that sum)"
    )]
    MomentsTriangle {
        /// The moments as given.
        moments: [f64; 3],
        /// Largest moment over the sum of the other two.
        ratio: f64,
    },
    /// Moments so far apart that their differences have no double.
    #[error(
        "moments = {moments:?}: the largest must not exceed {:e} times the smallest (it is {ratio:e} times it)",
        bound
    )]
    MomentsRatio {
        /// The moments as given.
        moments: [f64; 3],
        /// Largest moment over the smallest.
        ratio: f64,
        /// The largest ratio that is accepted.
        bound: f64,
    },
    /// An angular momentum or a rate that has no double.
    #[error(
        "moments and angular_velocity: {quantity}, 2^{exponent}, is no normal double, or too near the largest; choose other units"
    )]
    Units {
        /// What has no double: the angular momentum, or a rate.
        quantity: &'static str,
        /// Its binary exponent, which must be from −1021 to 1021.
        exponent: i32,
    },
    /// An attitude quaternion that is zero, not finite, or too far from unit norm.
    #[error(
        "attitude = {value:?}: a quaternion [x, y, z, w] must be finite with a norm within 1e-6 of 1 (it is {norm}){}", advice(*norm)
    )]
    Attitude {
        /// The quaternion as given, [x, y, z, w].
        value: [f64; 4],
        /// Its norm.
        norm: f64,
    },
    /// A body rate that is not finite.
    #[error("angular_velocity[{axis}] = {value}: a rate must be finite")]
    AngularVelocity {
        /// Index of the body axis, 0 to 2.
        axis: usize,
        /// The rate as given.
        value: f64,
    },
    /// An epoch that is not finite.
    #[error("epoch = {value}: it must be finite")]
    Epoch {
        /// The epoch as given.
        value: f64,
    },
    /// A tolerance that is not positive and finite.
    #[error("tolerance = {value}: it must be positive and finite [rad]")]
    Tolerance {
        /// The tolerance as given.
        value: f64,
    },
    /// A span that is not finite or runs backwards.
    #[error("span = [{start}, {stop}]: it must be finite with start ≤ stop")]
    Span {
        /// Its first time.
        start: f64,
        /// Its last time.
        stop: f64,
    },
    /// An order that is not served.
    #[error("order = {value}: it must be at most {bound}")]
    Order {
        /// The order as given.
        value: usize,
        /// The highest order that is served.
        bound: usize,
    },
    /// A method that is unknown.
    #[error("method = {value:?}: it must be \"auto\", \"series\", \"closed\" or \"integrated\"")]
    Method {
        /// The method as given.
        value: String,
    },
    /// A time that is not finite, or so far from the epoch that the motion is not evaluated there.
    #[error("times[{index}] = {value:e}: a time must be finite and within {bound:.3e} of the epoch{reason}")]
    Time {
        /// Its index among the times given.
        index: usize,
        /// The time as given.
        value: f64,
        /// Largest distance from the epoch that is accepted.
        bound: f64,
        /// What ends there, as the end of a sentence; empty where the number is only the largest that is added without an overflow.
        reason: &'static str,
    },
    /// A slice whose length doesn't fit.
    #[error("{argument} has {found} entries: it must have {expected}")]
    Length {
        /// The argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The length that fits.
        expected: usize,
    },
    /// The series asked for too near the separatrix for the tolerance.
    #[error(
        "too near the separatrix for the series: at σ/σ_sep = {ratio} the highest order, {highest}, is good to {}, and the tolerance is {tolerance:e} rad",
        rounded_up(*attainable)
    )]
    NearSeparatrix {
        /// σ/σ_sep.
        ratio: f64,
        /// The tolerance asked for \[rad\].
        tolerance: f64,
        /// The smallest tolerance that the highest order meets \[rad\].
        attainable: f64,
        /// The highest order.
        highest: usize,
    },
    /// The series asked for on the separatrix.
    #[error(
        "on the separatrix (falling away from rotation about the axis of middle inertia, or towards it): no order of the series serves; the closed form does"
    )]
    Separatrix,
    /// Derivatives asked for on the separatrix.
    #[error(
        "on the separatrix (falling away from rotation about the axis of middle inertia, or towards it) the frequencies have no derivatives: a state beside it has"
    )]
    SeparatrixPartials,
    /// A convention of periods that is unknown.
    #[error("convention = {value:?}: it must be \"extremal-axis\", \"long-axis\" or \"short-axis\"")]
    Convention {
        /// The convention as given.
        value: String,
    },
    /// A mode that is unknown, or has no periods.
    #[error("mode = {value:?}: it must be \"short-axis\" or \"long-axis\"")]
    ModeName {
        /// The mode as given.
        value: String,
    },
    /// A mode that a body does not have: the two moments on its far side are equal.
    #[error("mode = {mode:?}: a body with moments {moments:?} has none, since its {pair} moments are equal")]
    NoSuchMode {
        /// The mode.
        mode: String,
        /// The moments.
        moments: [f64; 3],
        /// Which two of them.
        pair: &'static str,
    },
    /// A pair of periods that a body cannot have in a mode.
    #[error(
        "rotation/precession = {ratio}: in the {mode} mode and the {convention} convention this body has P_ψ/P_φ from {lower} up to {upper}"
    )]
    PeriodRatio {
        /// P_ψ/P_φ as given.
        ratio: f64,
        /// The mode.
        mode: String,
        /// The convention.
        convention: String,
        /// The smallest ratio, that of rotation about the axis itself.
        lower: f64,
        /// The largest, next to the separatrix, that doubles hold.
        upper: f64,
    },
    /// A vector or a number that is not finite, or a direction of length 0.
    #[error("{argument} = {value:?}: it must be finite{}", if value.iter().any(|x| *x != 0.0) { "" } else { " and not 0" })]
    Direction {
        /// The argument.
        argument: &'static str,
        /// The value as given.
        value: Vec<f64>,
    },
    /// An Andoyer variable out of its bounds.
    #[error("andoyer[{index}] = {value}: {bound}")]
    Andoyer {
        /// Its index among (λ, μ, ν, Λ, M, N).
        index: usize,
        /// The value as given.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// An element of an orbit that is none.
    #[error("orbit.{argument} = {value}: it must be {bound}")]
    Orbit {
        /// The element.
        argument: &'static str,
        /// The value as given.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// A level of the gravity-gradient theory that is unknown.
    #[error("level = {value:?}: it must be \"paper\", \"moving\" or \"full\"")]
    Level {
        /// The level as given.
        value: String,
    },
    /// An averaging that is unknown.
    #[error("averaging = {value:?}: it must be \"auto\", \"orbit\" or \"spin\"")]
    Averaging {
        /// The averaging as given.
        value: String,
    },
    /// A rotation so slow, or so near a resonance with its orbit, that no averaging holds.
    #[error(
        "spin resonance (k−j, m) = ({harmonic}, {multiple}): its frequency is {divisor:.3} times the orbital angular rate at pericentre, and averaging needs more than {bound} or a shorter span"
    )]
    Resonance {
        /// k − j: the multiple of dℓ′/dt.
        harmonic: i32,
        /// m: that of dy′/dt.
        multiple: i32,
        /// The frequency over the orbital angular rate at pericentre.
        divisor: f64,
        /// The least that averaging needs.
        bound: f64,
    },
    /// A torque too strong for an expansion in it.
    #[error(
        "the torque, or what it does to the motion, measures {size:.3e} at pericentre, and an expansion in it needs less than {bound:.3e}"
    )]
    TorqueTooStrong {
        /// Its measure: 3n²C(C − A)/2M² times the mass fraction at the pericentre, the sum of the short-period corrections \[rad\], what a step towards the mean variables leaves of
        /// the one before, or the error bound of a span below one orbit \[rad\].
        size: f64,
        /// What that measure must be below; of the error bound, the effect of the torque over the span \[rad\].
        bound: f64,
    },
    /// A span with more orbits than the averaged equations are solved for.
    #[error(
        "averaging = spin: the span has {orbits:.0} orbits on one side of the epoch, and the averaged equations are solved for {bound} at most; averaging over the orbit has no such bound"
    )]
    TooManyOrbits {
        /// Orbits from the epoch to the farther end of the span.
        orbits: f64,
        /// The most that are served.
        bound: f64,
    },
    /// A mode of motion that the gravity gradient theory does not serve.
    #[error(
        "orbit: no averaged theory serves this motion (mode {mode}, σ/σ_sep = {ratio:.6}, which must be at most {bound})"
    )]
    Unaveraged {
        /// The mode.
        mode: String,
        /// σ/σ_sep.
        ratio: f64,
        /// The largest that is served.
        bound: f64,
    },
    /// A table of positions that is none, or does not reach as far as the span.
    #[error("orbit.{argument}[{index}] = {value}: it must be {bound}")]
    Table {
        /// The argument.
        argument: &'static str,
        /// The index in it.
        index: usize,
        /// The value; for too few times how many there are.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// A span that a table of positions does not cover.
    #[error(
        "span: the integration goes from {start} to {stop}, and the table of positions only from {first} to {last}"
    )]
    TableSpan {
        /// The first time that is needed.
        start: f64,
        /// The last time that is needed.
        stop: f64,
        /// The first time of the table.
        first: f64,
        /// The last time of the table.
        last: f64,
    },
    /// An integration without a span.
    #[error("span: none is given, and the integrated method needs one{}", because(reason))]
    NoSpan {
        /// Why the motion is integrated; empty where the method was asked for.
        reason: String,
    },
    /// A scene that only the integrated method serves, with another method.
    #[error("method = \"{method}\": {reason}; use method = \"integrated\" or \"auto\" with a span")]
    OnlyIntegrated {
        /// The method as asked for.
        method: String,
        /// What in the scene needs the integration.
        reason: String,
    },
    /// An integration with too many steps.
    #[error(
        "span: the integration needs about {steps:.1e} steps, which take {:.1} GB; at most {bound} are kept: a span shorter by a factor of {:.1} is served",
        memory(*steps), steps / *bound as f64
    )]
    TooManySteps {
        /// Steps over the span, estimated.
        steps: f64,
        /// The most that are kept.
        bound: usize,
    },
    /// A motion whose nearby states separate so fast that nothing is known at the end of the span.
    #[error(
        "tolerance = {tolerance:e}: nearby states separate so fast that the attitude is unknown at the end of the span; {tolerance:e} rad holds from {start} to {stop}"
    )]
    Unpredictable {
        /// The tolerance \[rad\].
        tolerance: f64,
        /// The earliest time to which it can be had.
        start: f64,
        /// The latest time to which it can be had.
        stop: f64,
    },
    /// A member of an ensemble that is none, or could not be evaluated.
    #[error("member {index}: {problem}{}", and_others(*others))]
    Member {
        /// Its index.
        index: usize,
        /// How many other members are bad, as far as they have been looked at.
        others: usize,
        /// What is wrong with it.
        problem: Box<Error>,
    },
    /// What becomes of bad members of an ensemble, in a word that is unknown.
    #[error("errors = {value:?}: it must be \"raise\" or \"nan\"")]
    OnError {
        /// The word as given.
        value: String,
    },
    /// A computation that was stopped by the flag that it was given.
    #[error("stopped before the end")]
    Stopped,
    /// An index that no member of an ensemble has.
    #[error("index = {index}: the ensemble has {members} members, counted from 0")]
    Index {
        /// The index as given.
        index: usize,
        /// How many members there are.
        members: usize,
    },
    /// A number of threads that the system does not give.
    #[error("threads = {value}: {problem}")]
    Threads {
        /// The number as given.
        value: usize,
        /// What the system said.
        problem: String,
    },
    /// A body that the catalogue doesn't have.
    #[error("body {name:?} is not in the catalogue{}: it has {}", did_you_mean(name, known), known.join(", "))]
    UnknownBody {
        /// The name as given.
        name: String,
        /// The names in the catalogue.
        known: Vec<&'static str>,
    },
    /// What the series crate has to say; no input that passed the checks of this crate is known to raise it.
    #[error(transparent)]
    Series(#[from] andoyer_series::Error),
    /// A scene file that can't be read or says something wrong.
    #[error("{file}: {key}: {problem}")]
    SceneFile {
        /// The file.
        file: String,
        /// The key, dotted, or the line.
        key: String,
        /// What is wrong, with the bound.
        problem: String,
        /// The value of the key, where there is one.
        value: Option<Box<Value>>,
        /// What the value must be.
        bound: Option<Box<Value>>,
    },
}

/// The name most like an unknown one, if one is: up to a third of the letters wrong, missing, added or exchanged.
fn did_you_mean(name: &str, known: &[&str]) -> String {
    let name = name.to_lowercase();
    let likeness = |known: &str| strsim::normalized_damerau_levenshtein(&known.to_lowercase(), &name);
    let best = known.iter().max_by(|one, two| likeness(one).total_cmp(&likeness(two)));
    let near = best.filter(|best| likeness(best) >= 2.0 / 3.0);
    near.map_or_else(String::new, |best| format!("; did you mean {best:?}?"))
}

/// Why a motion is integrated, as the end of a sentence.
fn because(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(", by which this scene is solved: {reason}") }
}

/// Memory that so many steps take, in units of 1e9 bytes.
fn memory(steps: f64) -> f64 {
    steps * STEP_BYTES * 1e-9
}

fn and_others(others: usize) -> String {
    if others == 0 { String::new() } else { format!(" (and {others} more bad members)") }
}

/// What to do with a quaternion that is no attitude.
fn advice(norm: f64) -> &'static str {
    if norm > 0.0 && norm.is_finite() {
        "; to normalize it, divide it by its norm; a quaternion [w, x, y, z] is read with scalar_first=True in Python"
    } else {
        ""
    }
}

impl Error {
    /// The same error of times that begin later in an array.
    #[must_use]
    pub fn later(self, start: usize) -> Self {
        match self {
            Self::Time { index, value, bound, reason } => Self::Time { index: start + index, value, bound, reason },
            other => other,
        }
    }
}

/// A tolerance that can be asked for: two digits, not rounded down.
fn rounded_up(tolerance: f64) -> String {
    if tolerance < 1.0 { format!("{:.1e} rad", tolerance * 1.05) } else { "no tolerance below 1 rad".to_owned() }
}
