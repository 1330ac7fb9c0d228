//! The error type of the crate: invalid input, and scenes that a method cannot solve. Each error has its argument, its value and the bound.

mod facts;

pub use facts::{Kind, Value};

/// Memory of one integration step, in bytes.
pub(crate) const STEP_BYTES: f64 = 72.0;

/// An error of this crate, with the given value and the accepted bound.
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
        /// The opposite entry.
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
    /// Moments that no body can have: the largest exceeds the sum of the other two.
    #[error(
        "moments = {moments:?}: the largest must not exceed the sum of the other two (it is {ratio} times that sum)"
    )]
    MomentsTriangle {
        /// The moments as given.
        moments: [f64; 3],
        /// Largest moment over the sum of the other two.
        ratio: f64,
    },
    /// Moments so different in size that their differences overflow or underflow.
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
    /// An angular momentum or a rate that overflows or underflows.
    #[error(
        "moments and angular_velocity: {quantity}, 2^{exponent}, is not a normal double, or is too near the largest; choose other units"
    )]
    Units {
        /// The quantity that overflows or underflows: the angular momentum, or a rate.
        quantity: &'static str,
        /// Its binary exponent, which must be from −1021 to 1021.
        exponent: i32,
    },
    /// An attitude quaternion that is zero, not finite, or whose norm is too far from 1.
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
    /// An order above the highest one.
    #[error("order = {value}: it must be at most {bound}")]
    Order {
        /// The order as given.
        value: usize,
        /// The highest order.
        bound: usize,
    },
    /// An unknown method.
    #[error("method = {value:?}: it must be \"auto\", \"series\", \"closed\" or \"integrated\"")]
    Method {
        /// The method as given.
        value: String,
    },
    /// A time that is not finite, or too far from the epoch to be evaluated.
    #[error("times[{index}] = {value:e}: a time must be finite and within {bound:.3e} of the epoch{reason}")]
    Time {
        /// Its index among the times given.
        index: usize,
        /// The time as given.
        value: f64,
        /// Largest accepted time from the epoch.
        bound: f64,
        /// The reason for the bound, as the end of a sentence; empty if the bound only prevents an overflow.
        reason: &'static str,
    },
    /// A slice of the wrong length.
    #[error("{argument} has {found} entries: it must have {expected}")]
    Length {
        /// The argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The required length.
        expected: usize,
    },
    /// The series is requested too near the separatrix for the tolerance.
    #[error(
        "too near the separatrix for the series: at σ/σ_sep = {ratio} the highest order, {highest}, is good to {}, and the tolerance is {tolerance:e} rad",
        rounded_up(*attainable)
    )]
    NearSeparatrix {
        /// σ/σ_sep.
        ratio: f64,
        /// The requested tolerance \[rad\].
        tolerance: f64,
        /// The smallest tolerance that the highest order meets \[rad\].
        attainable: f64,
        /// The highest order.
        highest: usize,
    },
    /// The series is requested on the separatrix.
    #[error(
        "on the separatrix (falling away from rotation about the axis of middle inertia, or towards it): no order of the series is valid; use the closed form"
    )]
    Separatrix,
    /// Derivatives are requested on the separatrix.
    #[error(
        "on the separatrix (falling away from rotation about the axis of middle inertia, or towards it) the frequencies have no derivatives; choose a state beside the separatrix"
    )]
    SeparatrixPartials,
    /// A language for which no code can be written.
    #[error("language = {value:?}: it must be \"c\", \"rust\", \"python\" or \"javascript\"")]
    CodeLanguage {
        /// The language as given.
        value: String,
    },
    /// A motion for which no code can be written.
    #[error(
        "no code is written of {motion}: rest, steady rotation and torque-free wobbles of both modes have code; a C-kernel or an attitude file holds any motion"
    )]
    NoCode {
        /// The kind of the motion.
        motion: &'static str,
    },
    /// An unknown convention of periods.
    #[error("convention = {value:?}: it must be \"extremal-axis\", \"long-axis\" or \"short-axis\"")]
    Convention {
        /// The convention as given.
        value: String,
    },
    /// An unknown mode, or a mode that has no periods.
    #[error("mode = {value:?}: it must be \"short-axis\" or \"long-axis\"")]
    ModeName {
        /// The mode as given.
        value: String,
    },
    /// A mode that a body does not have, because two of its moments are equal.
    #[error(
        "mode = {mode:?}: a body with moments {moments:?} does not have this mode, since its {pair} moments are equal"
    )]
    NoSuchMode {
        /// The mode.
        mode: String,
        /// The moments.
        moments: [f64; 3],
        /// The two equal moments, in words.
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
        /// The smallest ratio, which is that of rotation about the axis.
        lower: f64,
        /// The largest ratio near the separatrix that doubles can represent.
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
    /// An Andoyer variable that is outside its bounds.
    #[error("andoyer[{index}] = {value}: {bound}")]
    Andoyer {
        /// Its index among (λ, μ, ν, Λ, M, N).
        index: usize,
        /// The value as given.
        value: f64,
        /// The requirement.
        bound: &'static str,
    },
    /// An invalid orbital element.
    #[error("orbit.{argument} = {value}: it must be {bound}")]
    Orbit {
        /// The element.
        argument: &'static str,
        /// The value as given.
        value: f64,
        /// The requirement.
        bound: &'static str,
    },
    /// An unknown level of the gravity-gradient theory.
    #[error("level = {value:?}: it must be \"auto\", \"paper\", \"moving\", \"full\" or \"second-order\"")]
    Level {
        /// The level as given.
        value: String,
    },
    /// Second order together with the average over the orbit, which is of first order.
    #[error(
        "level = \"second-order\" needs averaging = \"spin\" or \"auto\": the average over the orbit is of first order"
    )]
    LevelOfOrbit,
    /// An option that needs one disturbing body on an orbit that does not precess.
    #[error("{argument} = \"{value}\" needs one disturbing body on an orbit without node_rate and pericentre_rate")]
    OneFixedOrbit {
        /// The option.
        argument: &'static str,
        /// Its value.
        value: String,
    },
    /// An unknown averaging.
    #[error("averaging = {value:?}: it must be \"auto\", \"orbit\" or \"spin\"")]
    Averaging {
        /// The averaging as given.
        value: String,
    },
    /// A rotation that is too slow, or too near a resonance with its orbit, for averaging.
    #[error(
        "spin resonance (k−j, m) = ({harmonic}, {multiple}): its frequency is {divisor:.3} times the orbital angular rate at pericentre, and averaging needs more than {bound} or a shorter span"
    )]
    Resonance {
        /// k − j, the multiple of dℓ′/dt.
        harmonic: i32,
        /// m, the multiple of dy′/dt.
        multiple: i32,
        /// The frequency over the orbital angular rate at pericentre.
        divisor: f64,
        /// The smallest value that averaging allows.
        bound: f64,
    },
    /// A torque that is too strong for an expansion in it.
    #[error(
        "the torque, or its effect on the motion, measures {size:.3e} at pericentre, and an expansion in it needs less than {bound:.3e}"
    )]
    TorqueTooStrong {
        /// A measure of the torque. It is one of: 3n²C(C − A)/2M² times the mass fraction at the pericentre; the sum of the short-period corrections \[rad\];
        /// the ratio of the changes of successive iterations for the mean variables; the error bound of a span below one orbit \[rad\].
        size: f64,
        /// Upper limit of the measure. For the error bound it is the effect of the torque over the span \[rad\].
        bound: f64,
    },
    /// A span with more orbits than the averaged equations can be solved for.
    #[error(
        "averaging = spin: the span has {orbits:.0} orbits on one side of the epoch, and the averaged equations are solved for {bound} at most; averaging over the orbit has no such bound"
    )]
    TooManyOrbits {
        /// Orbits from the epoch to the farther end of the span.
        orbits: f64,
        /// The largest number of orbits.
        bound: f64,
    },
    /// A span with more arcs than the averaged equations of several bodies, or of an orbit that precesses, can be solved for.
    #[error(
        "span: it reaches {value} from the epoch, and the averaged equations of these orbits are solved up to {bound:.6e}"
    )]
    SpanOfBodies {
        /// The time from the epoch to the farther end of the span.
        value: f64,
        /// The largest time.
        bound: f64,
    },
    /// A mode of motion for which the gravity-gradient theory is not valid.
    #[error(
        "orbit: no averaged theory is valid for this motion (mode {mode}, σ/σ_sep = {ratio:.6}, which must be at most {bound})"
    )]
    Unaveraged {
        /// The mode.
        mode: String,
        /// σ/σ_sep.
        ratio: f64,
        /// The largest valid ratio.
        bound: f64,
    },
    /// An invalid table of positions, or a time outside the table.
    #[error("orbit.{argument}[{index}] = {value}: it must be {bound}")]
    Table {
        /// The argument.
        argument: &'static str,
        /// The index in it.
        index: usize,
        /// The value; if there are too few times, their number.
        value: f64,
        /// The requirement.
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
        /// Why the motion is integrated; empty if the method was requested.
        reason: String,
    },
    /// A scene that only the integrated method can solve, with another method.
    #[error("method = \"{method}\": {reason}; use method = \"integrated\" or \"auto\" with a span")]
    OnlyIntegrated {
        /// The requested method.
        method: String,
        /// The part of the scene that needs the integration.
        reason: String,
    },
    /// An integration with too many steps.
    #[error(
        "span: the integration needs about {steps:.1e} steps, which take {:.1} GB; at most {bound} are kept: use a span shorter by a factor of {:.1}",
        memory(*steps), steps / *bound as f64
    )]
    TooManySteps {
        /// Steps over the span, estimated.
        steps: f64,
        /// The largest number of steps.
        bound: usize,
    },
    /// A motion whose nearby states separate so fast that the attitude at the end of the span is unknown.
    #[error(
        "tolerance = {tolerance:e}: nearby states separate so fast that the attitude is unknown at the end of the span; {tolerance:e} rad holds from {start} to {stop}"
    )]
    Unpredictable {
        /// The tolerance \[rad\].
        tolerance: f64,
        /// The earliest time at which the tolerance holds.
        start: f64,
        /// The latest time at which the tolerance holds.
        stop: f64,
    },
    /// An invalid member of an ensemble, or a member that could not be evaluated.
    #[error("member {index}: {problem}{}", and_others(*others))]
    Member {
        /// Its index.
        index: usize,
        /// Number of other bad members found so far.
        others: usize,
        /// The error of this member.
        problem: Box<Error>,
    },
    /// An unknown word for the treatment of bad members of an ensemble.
    #[error("errors = {value:?}: it must be \"raise\" or \"nan\"")]
    OnError {
        /// The word as given.
        value: String,
    },
    /// A computation that was stopped by its flag.
    #[error("stopped before the end")]
    Stopped,
    /// An index that exceeds the number of members of an ensemble.
    #[error("index = {index}: the ensemble has {members} members, counted from 0")]
    Index {
        /// The index as given.
        index: usize,
        /// Number of members.
        members: usize,
    },
    /// A number of threads that the system cannot provide.
    #[error("threads = {value}: {problem}")]
    Threads {
        /// The number as given.
        value: usize,
        /// The message of the system.
        problem: String,
    },
    /// A body that is not in the catalogue.
    #[error("body {name:?} is not in the catalogue{}: it has {}", did_you_mean(name, known), known.join(", "))]
    UnknownBody {
        /// The name as given.
        name: String,
        /// The names in the catalogue.
        known: Vec<&'static str>,
    },
    /// An error of the series crate. No input that passes the checks of this crate is known to cause it.
    #[error(transparent)]
    Series(#[from] andoyer_series::Error),
    /// A scene file that cannot be read or that contains an error.
    #[error("{file}: {key}: {problem}")]
    SceneFile {
        /// The file.
        file: String,
        /// The key, dotted, or the line.
        key: String,
        /// The problem, with the bound.
        problem: String,
        /// The value of the key, if it has one.
        value: Option<Box<Value>>,
        /// The requirement on the value.
        bound: Option<Box<Value>>,
    },
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

impl Error {
    /// The error of one member of an ensemble.
    pub(crate) fn of_member(index: usize, problem: Self) -> Self {
        Self::Member { index, others: 0, problem: Box::new(problem) }
    }

    /// The same error for times that begin at the index `start` of an array.
    #[must_use]
    pub fn later(self, start: usize) -> Self {
        match self {
            Self::Time { index, value, bound, reason } => Self::Time { index: start + index, value, bound, reason },
            other => other,
        }
    }
}

/// The tolerance as text with two digits, not rounded down.
fn rounded_up(tolerance: f64) -> String {
    if tolerance < 1.0 { format!("{:.1e} rad", tolerance * 1.05) } else { "no tolerance below 1 rad".to_owned() }
}
