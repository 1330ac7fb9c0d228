//! The error type of the crate: invalid input, and scenes that a method cannot solve. Each error has its argument, its value and the bound.
//!
//! A variant stands in three places: here with its fields, in `message` with its sentence, and in `facts` with its kind, argument, value and bound.

mod duration;
mod facts;
mod message;
mod place;
mod torque_measure;

pub(crate) use duration::duration_in_words;
pub use facts::{Kind, Value};
pub use torque_measure::TorqueMeasure;

/// Memory of one integration step, in bytes.
pub(crate) const STEP_BYTES: f64 = 72.0;

/// An error of this crate, with the given value and the accepted bound.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A moment of inertia that is zero, negative, NaN or infinite.
    Moment {
        /// Index of the body axis, 0 to 2.
        axis: usize,
        /// The moment as given.
        value: f64,
    },
    /// An inertia tensor that is not symmetric, or not finite.
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
    InertiaMoments {
        /// The principal moments.
        moments: [f64; 3],
    },
    /// A length or a mass that is zero, negative, NaN or infinite.
    Positive {
        /// The argument.
        argument: &'static str,
        /// The value as given.
        value: f64,
    },
    /// Moments that no body can have: the largest exceeds the sum of the other two.
    MomentsTriangle {
        /// The moments as given.
        moments: [f64; 3],
        /// Largest moment over the sum of the other two.
        ratio: f64,
    },
    /// Moments so different in size that their differences overflow or underflow.
    MomentsRatio {
        /// The moments as given.
        moments: [f64; 3],
        /// Largest moment over the smallest.
        ratio: f64,
        /// The largest ratio that is accepted.
        bound: f64,
    },
    /// An angular momentum or a rate that overflows or underflows.
    Units {
        /// The quantity that overflows or underflows: the angular momentum, or a rate.
        quantity: &'static str,
        /// Its binary exponent, which must be from −1021 to 1021.
        exponent: i32,
    },
    /// An attitude quaternion that is zero, not finite, or whose norm is too far from 1.
    Attitude {
        /// The quaternion as given, [x, y, z, w].
        value: [f64; 4],
        /// Its norm.
        norm: f64,
    },
    /// A body rate that is not finite.
    AngularVelocity {
        /// Index of the body axis, 0 to 2.
        axis: usize,
        /// The rate as given.
        value: f64,
    },
    /// An epoch that is not finite.
    Epoch {
        /// The epoch as given.
        value: f64,
    },
    /// A tolerance that is not positive and finite.
    Tolerance {
        /// The tolerance as given.
        value: f64,
    },
    /// A span that is not finite or runs backwards.
    Span {
        /// Its first time.
        start: f64,
        /// Its last time.
        stop: f64,
    },
    /// An order above the highest one.
    Order {
        /// The order as given.
        value: usize,
        /// The highest order.
        bound: usize,
    },
    /// An unknown method.
    Method {
        /// The method as given.
        value: String,
    },
    /// A time that is not finite, or too far from the epoch to be evaluated.
    Time {
        /// Its index among the times given.
        index: usize,
        /// The time as given.
        value: f64,
        /// The epoch on the scale of the times: 0 if they count from the epoch.
        epoch: f64,
        /// The span of the scene on the same scale, if it has one.
        span: Option<[f64; 2]>,
        /// Largest accepted time from the epoch.
        bound: f64,
        /// The reason for the bound, as the end of a sentence; empty if the bound only prevents an overflow.
        reason: &'static str,
    },
    /// A slice of the wrong length.
    Length {
        /// The argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The required length.
        expected: usize,
    },
    /// A table that is too short.
    TooFew {
        /// The argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The least length.
        least: usize,
    },
    /// The series is requested too near the separatrix for the tolerance.
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
    Separatrix,
    /// Derivatives are requested on the separatrix.
    SeparatrixPartials,
    /// A language for which no code can be written.
    CodeLanguage {
        /// The language as given.
        value: String,
    },
    /// A motion for which no code can be written.
    NoCode {
        /// The kind of the motion.
        motion: &'static str,
    },
    /// An unknown convention of periods.
    Convention {
        /// The convention as given.
        value: String,
    },
    /// An unknown mode, or a mode that has no periods.
    ModeName {
        /// The mode as given.
        value: String,
    },
    /// A mode that a body does not have, because two of its moments are equal.
    NoSuchMode {
        /// The mode.
        mode: String,
        /// The moments.
        moments: [f64; 3],
        /// The two equal moments, in words.
        pair: &'static str,
    },
    /// A pair of periods that a body cannot have in a mode.
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
        /// The modes and conventions in which the body can have the ratio.
        possible: Vec<[String; 2]>,
        /// If there are none: the modes and conventions in which it can have the periods exchanged with each other.
        swapped: Vec<[String; 2]>,
    },
    /// A direction whose latitude exceeds a quarter turn.
    Latitude {
        /// Longitude and latitude as given \[rad\].
        value: [f64; 2],
    },
    /// A vector or a number that is not finite, or a direction of length 0.
    Direction {
        /// The argument.
        argument: &'static str,
        /// The value as given.
        value: Vec<f64>,
    },
    /// An Andoyer variable that is outside its bounds.
    Andoyer {
        /// Its index among (λ, μ, ν, Λ, M, N).
        index: usize,
        /// The value as given.
        value: f64,
        /// The requirement.
        bound: String,
    },
    /// An invalid orbital element.
    Orbit {
        /// The element.
        argument: &'static str,
        /// The value as given.
        value: f64,
        /// The requirement.
        bound: &'static str,
    },
    /// A position on an orbit whose semi-major axis was not given.
    NoSemiMajorAxis,
    /// An unknown level of the gravity-gradient theory.
    Level {
        /// The level as given.
        value: String,
    },
    /// An option that needs one disturbing body on an orbit that does not precess.
    OneFixedOrbit {
        /// The option.
        argument: &'static str,
        /// Its value.
        value: String,
    },
    /// An unknown averaging.
    Averaging {
        /// The averaging as given.
        value: String,
    },
    /// A rotation that is too slow, or too near a resonance with its orbit, for averaging. The terms of the torque in hℓ′ + my′ have too large an effect.
    Resonance {
        /// h, the multiple of dℓ′/dt.
        harmonic: i32,
        /// m, the multiple of dy′/dt.
        multiple: i32,
        /// The frequency of the terms over the largest angular rate of the orbit within the span.
        divisor: f64,
        /// The smallest value for which a term is corrected by a sum over time derivatives.
        bound: f64,
        /// The largest attitude error over the span \[rad\]: by this term, or by all terms together.
        effect: f64,
        /// Upper limit of the effect \[rad\].
        limit: f64,
    },
    /// A torque that is too strong for an expansion in it.
    TorqueTooStrong {
        /// What is measured.
        measure: TorqueMeasure,
        /// The measured value.
        size: f64,
        /// Its upper limit.
        bound: f64,
    },
    /// A span with more orbits than the averaged equations can be solved for.
    TooManyOrbits {
        /// Orbits from the epoch to the farther end of the span.
        orbits: f64,
        /// The largest number of orbits.
        bound: f64,
    },
    /// A span with more arcs than the averaged equations can be solved for: of several bodies, of an orbit that precesses, or over the orbit in second order.
    SpanOfBodies {
        /// The time from the epoch to the farther end of the span.
        value: f64,
        /// The largest time.
        bound: f64,
    },
    /// A mode of motion for which the gravity-gradient theory is not valid.
    Unaveraged {
        /// The mode.
        mode: String,
        /// σ/σ_sep.
        ratio: f64,
        /// The largest valid ratio.
        bound: f64,
    },
    /// An invalid table of positions, or a time outside the table.
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
    NoSpan {
        /// Why the motion is integrated; empty if the method was requested.
        reason: String,
    },
    /// A scene that only the integrated method can solve, with another method.
    OnlyIntegrated {
        /// The requested method.
        method: String,
        /// The part of the scene that needs the integration.
        reason: String,
    },
    /// An integration with too many steps.
    TooManySteps {
        /// Steps over the span, estimated; infinite if only the bound is known to be exceeded.
        steps: f64,
        /// The largest number of steps.
        bound: usize,
        /// Why the scene is integrated, or empty.
        reason: String,
    },
    /// A motion whose nearby states separate so fast that the attitude at the end of the span is unknown.
    Unpredictable {
        /// The tolerance \[rad\].
        tolerance: f64,
        /// First and last time of the span.
        span: [f64; 2],
        /// The earliest time at which the tolerance holds.
        start: f64,
        /// The latest time at which the tolerance holds.
        stop: f64,
    },
    /// A number of times at which a motion cannot be verified.
    Samples {
        /// The number as given.
        value: usize,
        /// The least number.
        least: usize,
        /// The largest number.
        most: usize,
    },
    /// A span of a verification that goes beyond the times for which the error bound of the motion holds.
    VerifiedSpan {
        /// Its first time.
        start: f64,
        /// Its last time.
        stop: f64,
        /// The first time for which the bound holds.
        first: f64,
        /// The last time for which the bound holds.
        last: f64,
    },
    /// A verification without a span that would take too long.
    LongVerification {
        /// The time that it would take, estimated from the number of steps \[s\].
        seconds: f64,
        /// The number of steps.
        steps: f64,
        /// The longest time without a span \[s\].
        bound: f64,
        /// The times over which the motion would be integrated, in words.
        over: String,
    },
    /// An invalid member of an ensemble, or a member that could not be evaluated.
    Member {
        /// Its index.
        index: usize,
        /// Number of other bad members found so far.
        others: usize,
        /// The error of this member.
        problem: Box<Error>,
    },
    /// An unknown word for the treatment of bad members of an ensemble.
    OnError {
        /// The word as given.
        value: String,
    },
    /// A computation that was stopped by its flag.
    Stopped,
    /// An index that exceeds the number of members of an ensemble.
    Index {
        /// The index as given.
        index: usize,
        /// Number of members.
        members: usize,
    },
    /// A number of threads that the system cannot provide.
    Threads {
        /// The number as given.
        value: usize,
        /// The message of the system.
        problem: String,
    },
    /// A body that is not in the catalogue.
    UnknownBody {
        /// The name as given.
        name: String,
        /// The names in the catalogue.
        known: Vec<&'static str>,
    },
    /// An error of the series crate. No input that passes the checks of this crate is known to cause it.
    Series(andoyer_series::Error),
    /// A scene file that cannot be read or that contains an error.
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

impl std::error::Error for Error {}

impl From<andoyer_series::Error> for Error {
    fn from(error: andoyer_series::Error) -> Self {
        Self::Series(error)
    }
}
