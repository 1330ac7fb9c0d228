//! The error type of the crate: invalid input, and scenes that a method cannot solve. Each error has its argument, its value and the bound.
//!
//! Each variant stands once, in the table below (`andoyer_series::error_table`): its sentence, its fields, its kind, and its facts: argument, value and bound.

mod duration;
mod place;
mod sentences;
mod torque_measure;
mod torque_refusal;

use Kind::{File, Input, Internal, Representation, Theory};
use andoyer_series::error::{Facts, Short, facts};
pub use andoyer_series::error::{Kind, Value};
pub(crate) use duration::duration_in_words;
#[cfg(all(test, feature = "torques"))]
pub(crate) use sentences::STEP_BYTES;
use sentences::{
    advice, and_others, because, did_you_mean, distance, elsewhere, evolve, finite, four_digits, indexed, instead_of,
    rounded_up, setting, slow, too_many, turn, unaveraged,
};
pub use torque_measure::TorqueMeasure;
pub(crate) use torque_refusal::torque_refused;

const POSITIVE: &str = "positive and finite";

andoyer_series::error_table! {
    /// An error of this crate, with the given value and the accepted bound.
    #[derive(Debug, Clone, PartialEq, thiserror::Error)]
    #[non_exhaustive]
    pub enum Error {
        /// A moment of inertia that is zero, negative, NaN or infinite.
        #[error("moments[{axis}] = {value}: a moment of inertia must be positive and finite", value = Short(*.value))]
        Moment { axis: usize = "Index of the body axis, 0 to 2.", value: f64 = "The moment as given." } => Input, facts("moments", *value, POSITIVE);

        /// An inertia tensor that is not symmetric, or not finite.
        #[error("tensor[{row}][{column}] = {value} and tensor[{column}][{row}] = {mirrored}: an inertia tensor must be finite and symmetric to 1e-12 of its largest entry", value = Short(*.value), mirrored = Short(*.mirrored))]
        InertiaSymmetry { row: usize = "The row.", column: usize = "The column.", value: f64 = "The entry.", mirrored: f64 = "The opposite entry." }
        => Input, facts("tensor", *value, "finite and symmetric to 1e-12 of its largest entry");

        /// An inertia tensor with a principal moment that is not positive.
        #[error("tensor: its principal moments are {moments:?}, and each must be positive")]
        InertiaMoments { moments: [f64; 3] = "The principal moments." } => Input, facts("tensor", *moments, "positive principal moments");

        /// A length or a mass that is zero, negative, NaN or infinite.
        #[error("{argument} = {value}: it must be positive and finite", value = Short(*.value))]
        Positive { argument: &'static str = "The argument.", value: f64 = "The value as given." } => Input, facts(*argument, *value, POSITIVE);

        /// Moments that no body can have: the largest exceeds the sum of the other two.
        #[error("moments = {moments:?}: the largest must not exceed the sum of the other two (it is {ratio} times that sum)", ratio = Short(*.ratio))]
        MomentsTriangle { moments: [f64; 3] = "The moments as given.", ratio: f64 = "Largest moment over the sum of the other two." }
        => Input, facts("moments", *moments, "the largest at most the sum of the other two");

        /// Moments so different in size that their differences overflow or underflow.
        #[error("moments = {moments:?}: the largest must not exceed {bound:e} times the smallest (it is {ratio:e} times it)")]
        MomentsRatio {
            moments: [f64; 3] = "The moments as given.",
            ratio: f64 = "Largest moment over the smallest.",
            bound: f64 = "The largest ratio that is accepted.",
        } => Input, facts("moments", *ratio, *bound);

        /// An angular momentum or a rate that overflows or underflows.
        #[error("moments and angular_velocity: {quantity}, 2^{exponent}, is not a normal double, or is too near the largest; choose other units")]
        Units {
            quantity: &'static str = "The quantity that overflows or underflows: the angular momentum, or a rate.",
            exponent: i32 = "Its binary exponent, which must be from −1021 to 1021.",
        } => Representation, facts("moments and angular_velocity", Value::Integer((*exponent).into()), Value::Integers(vec![-1021, 1021]));

        /// An attitude quaternion that is zero, not finite, or whose norm is too far from 1.
        #[error("attitude = {value:?}: a quaternion [x, y, z, w] must be finite with a norm within 1e-6 of 1 (it is {norm}){}", advice(*.norm), norm = Short(*.norm))]
        Attitude { value: [f64; 4] = "The quaternion as given, [x, y, z, w].", norm: f64 = "Its norm." }
        => Input, facts("attitude", *value, "finite with a norm within 1e-6 of 1");

        /// A body rate that is not finite.
        #[error("angular_velocity[{axis}] = {value}: a rate must be finite", value = Short(*.value))]
        AngularVelocity { axis: usize = "Index of the body axis, 0 to 2.", value: f64 = "The rate as given." }
        => Input, facts("angular_velocity", *value, "finite");

        /// An epoch that is not finite.
        #[error("epoch = {value}: it must be finite", value = Short(*.value))]
        Epoch { value: f64 = "The epoch as given." } => Input, facts("epoch", *value, "finite");

        /// A tolerance that is not positive and finite.
        #[error("tolerance = {value}: it must be positive and finite [rad]", value = Short(*.value))]
        Tolerance { value: f64 = "The tolerance as given." } => Input, facts("tolerance", *value, POSITIVE);

        /// A span that is not finite or runs backwards.
        #[error("span = [{start}, {stop}]: it must be finite with start ≤ stop", start = Short(*.start), stop = Short(*.stop))]
        Span { start: f64 = "Its first time.", stop: f64 = "Its last time." } => Input, facts("span", [*start, *stop], "finite with start <= stop");

        /// An order above the highest one.
        #[error("order = {value}: it must be at most {bound}")]
        Order { value: usize = "The order as given.", bound: usize = "The highest order." } => Representation, facts("order", *value, *bound);

        /// An unknown method.
        #[error("method = {value:?}: it must be \"auto\", \"series\", \"closed\", \"integrated\" or \"libration\"{}", evolve(.value))]
        Method { value: String = "The method as given." } => Input, facts("method", value, "auto, series, closed, integrated, libration");

        /// A scene whose rotation no series about a spin–orbit resonance serves.
        #[error("method = \"libration\": {reason}")]
        NoLibration { reason: String = "The reason." } => Theory, facts("method", "libration", "a body locked to an elliptic orbit");

        /// A number outside its bounds, alone or in an array.
        #[error("{argument}{} = {value}: it must be {bound}", indexed(*.index), value = Short(*.value))]
        Number {
            argument: &'static str = "The argument.",
            index: Option<usize> = "The index in it, if it has several numbers.",
            value: f64 = "The value.",
            bound: &'static str = "The requirement.",
        } => Input, facts(*argument, *value, *bound);

        /// A time that is not finite, or too far from the epoch to be evaluated.
        #[error("times[{index}] = {value}: {}a time must be finite and within {} of the epoch{reason}", setting(*.epoch, *.span), distance(*.bound), value = Short(*.value))]
        Time {
            index: usize = "Its index among the times given.",
            value: f64 = "The time as given.",
            epoch: f64 = "The epoch on the scale of the times: 0 if they count from the epoch.",
            span: Option<[f64; 2]> = "The span of the scene on the same scale, if it has one.",
            bound: f64 = "Largest accepted time from the epoch.",
            reason: &'static str = "The reason for the bound, as the end of a sentence; empty if the bound only prevents an overflow.",
        } => if value.is_finite() { Representation } else { Input }, facts("times", *value, *bound);

        /// A slice of the wrong length.
        #[error("{argument} has {found} entries: it must have {expected}")]
        Length { argument: &'static str = "The argument.", found: usize = "Its length.", expected: usize = "The required length." }
        => Input, facts(*argument, *found, *expected);

        /// A table that is too short.
        #[error("{argument} has {found} entries: it must have {least} or more")]
        TooFew { argument: &'static str = "The argument.", found: usize = "Its length.", least: usize = "The least length." }
        => Input, facts(*argument, *found, *least);

        /// The series is requested too near the separatrix for the tolerance.
        #[error("too near the separatrix for the series: at σ/σ_sep = {ratio} the highest order, {highest}, is good to {}, and the tolerance is {tolerance:e} rad", rounded_up(*.attainable), ratio = Short(*.ratio))]
        NearSeparatrix {
            ratio: f64 = "σ/σ_sep.",
            tolerance: f64 = r"The requested tolerance \[rad\].",
            attainable: f64 = r"The smallest tolerance that the highest order meets \[rad\].",
            highest: usize = "The highest order.",
        } => Theory, facts("tolerance", *tolerance, *attainable);

        /// The series is requested on the separatrix.
        #[error("on the separatrix (falling away from rotation about the axis of middle inertia, or towards it): no order of the series is valid; use the closed form")]
        Separatrix => Theory, facts("method", "series", "closed");

        /// Derivatives are requested on the separatrix.
        #[error("on the separatrix (falling away from rotation about the axis of middle inertia, or towards it) the frequencies have no derivatives; choose a state beside the separatrix")]
        SeparatrixPartials => Theory, facts("angular_velocity", 1.0, "sigma/sigma_sep other than 1");

        /// A language for which no code can be written.
        #[error("language = {value:?}: it must be \"c\", \"rust\", \"python\" or \"javascript\"")]
        CodeLanguage { value: String = "The language as given." } => Input, facts("language", value, "c, rust, python, javascript");

        /// A motion for which no code can be written.
        #[error("no code is written of {motion}: rest, steady rotation and torque-free wobbles of both modes have code; a C-kernel or an attitude file holds any motion")]
        NoCode { motion: &'static str = "The kind of the motion." }
        => Representation, facts("motion", *motion, "rest, steady rotation or a torque-free wobble");

        /// An unknown convention of periods.
        #[error("convention = {value:?}: it must be \"extremal-axis\", \"long-axis\" or \"short-axis\"")]
        Convention { value: String = "The convention as given." } => Input, facts("convention", value, "extremal-axis, long-axis, short-axis");

        /// An unknown mode, or a mode that has no periods.
        #[error("mode = {value:?}: it must be \"short-axis\" or \"long-axis\"")]
        ModeName { value: String = "The mode as given." } => Input, facts("mode", value, "short-axis, long-axis");

        /// A mode that a body does not have, because two of its moments are equal.
        #[error("mode = {mode:?}: a body with moments {moments:?} does not have this mode, since its {pair} moments are equal")]
        NoSuchMode { mode: String = "The mode.", moments: [f64; 3] = "The moments.", pair: &'static str = "The two equal moments, in words." }
        => Input, facts("mode", mode, "a mode that the body has");

        /// A pair of periods that a body cannot have in a mode.
        #[error("rotation/precession = {ratio}: in the {mode} mode and the {convention} convention this body has P_ψ/P_φ from {lower} up to {upper}; {}", elsewhere(.possible, .swapped), ratio = Short(*.ratio), lower = Short(*.lower), upper = Short(*.upper))]
        PeriodRatio {
            ratio: f64 = "P_ψ/P_φ as given.",
            mode: String = "The mode.",
            convention: String = "The convention.",
            lower: f64 = "The smallest ratio, which is that of rotation about the axis.",
            upper: f64 = "The largest ratio near the separatrix that doubles can represent.",
            possible: Vec<[String; 2]> = "The modes and conventions in which the body can have the ratio.",
            swapped: Vec<[String; 2]> = "If there are none: the modes and conventions in which it can have the periods exchanged with each other.",
        } => Input, facts("rotation/precession", *ratio, [*lower, *upper]);

        /// A direction whose latitude exceeds a quarter turn.
        #[error("momentum_direction = [{longitude}, {latitude}]: it is [longitude, latitude] in radians, and the latitude must be from -π/2 to π/2", longitude = Short(.value[0]), latitude = Short(.value[1]))]
        Latitude { value: [f64; 2] = r"Longitude and latitude as given \[rad\]." }
        => Input, facts("momentum_direction", *value, "a latitude from -pi/2 to pi/2");

        /// A sense of the axis of a mode that is not a sign.
        #[error("sense = {value}: it must be 1 or -1, for the positive or the negative axis of the mode along the angular momentum", value = Short(*.value))]
        Sense { value: f64 = "The sense as given." } => Input, facts("sense", *value, "1 or -1");

        /// Phases beside an attitude, which fixes them.
        #[error("phases = {value:?}: the attitude fixes the phases; give one of the two")]
        PhasesAndAttitude { value: [f64; 2] = "The phases as given." } => Input, facts("phases", *value, "absent beside an attitude");

        /// A vector or a number that is not finite, or a direction of length 0.
        #[error("{argument} = {value:?}: it must be {}", finite(.value))]
        Direction { argument: &'static str = "The argument.", value: Vec<f64> = "The value as given." }
        => Input, facts(*argument, Value::Numbers(value.clone()), finite(value));

        /// An Andoyer variable that is outside its bounds.
        #[error("andoyer[{index}] = {value}: it must be {bound}", value = Short(*.value))]
        Andoyer { index: usize = "Its index among (λ, μ, ν, Λ, M, N).", value: f64 = "The value as given.", bound: String = "The requirement." }
        => Input, facts("andoyer", *value, bound);

        /// An invalid orbital element.
        #[error("orbit.{argument} = {value}: it must be {bound}", value = Short(*.value))]
        Orbit { argument: &'static str = "The element.", value: f64 = "The value as given.", bound: &'static str = "The requirement." }
        => Input, facts(*argument, *value, *bound);

        /// A position on an orbit whose semi-major axis was not given.
        #[error("orbit.semi_major_axis: none is given, and a position on the orbit needs it; it must be positive, in the unit of length of the position")]
        NoSemiMajorAxis => Input, facts("semi_major_axis", "none", "positive");

        /// A torque with an invalid number, name, power or polynomial.
        #[error("torque.{argument} = {value}: it must be {bound}")]
        Torque { argument: &'static str = "The argument.", value: String = "The value as given.", bound: String = "The requirement." }
        => Input, facts(*argument, value, bound);

        /// A number of a material, a size, a state or a time that inner dissipation cannot use.
        #[error("{argument} = {value}: it must be {bound}", value = Short(*.value))]
        Dissipation { argument: &'static str = "The argument.", value: f64 = "The value as given.", bound: String = "The requirement." }
        => Input, facts(*argument, *value, bound);

        /// A body, a material or a motion without inner dissipation, or without a relaxation.
        #[error("{argument}: {value}: {reason}")]
        NoDissipation { argument: &'static str = "The argument.", value: String = "What was given.", reason: String = "The reason." }
        => Input, facts(*argument, value, reason);

        /// An unknown level of the gravity-gradient theory.
        #[error("level = {value:?}: it must be \"auto\", \"paper\", \"moving\", \"full\" or \"second-order\"")]
        Level { value: String = "The level as given." } => Input, facts("level", value, "auto, paper, moving, full, second-order");

        /// An option that needs one disturbing body on an orbit that does not precess.
        #[error("{argument} = \"{value}\" needs one disturbing body on an orbit without node_rate and pericentre_rate")]
        OneFixedOrbit { argument: &'static str = "The option.", value: String = "Its value." }
        => Input, facts(*argument, value, if *argument == "level" { "auto, paper, moving, full" } else { "auto, spin" });

        /// An unknown averaging.
        #[error("averaging = {value:?}: it must be \"auto\", \"orbit\" or \"spin\"")]
        Averaging { value: String = "The averaging as given." } => Input, facts("averaging", value, "auto, orbit, spin");

        /// A rotation that is too slow, or too near a resonance with its orbit, for averaging. The terms of the torque in hℓ′ + my′ have too large an effect.
        #[error("spin resonance (h, m) = ({harmonic}, {multiple}): the terms in h times the angle of the wobble plus m times that of the rotation may turn the attitude by {} over the span (1e9 rotations if none is given); at most {} rad is allowed{}: give a shorter span, or integrate (method = integrated, with a span)", turn(*.effect, *.limit), four_digits(*.limit), slow(*.divisor, *.bound))]
        Resonance {
            harmonic: i32 = "h, the multiple of dℓ′/dt.",
            multiple: i32 = "m, the multiple of dy′/dt.",
            divisor: f64 = "The frequency of the terms over the largest angular rate of the orbit within the span.",
            bound: f64 = "The smallest value for which a term is corrected by a sum over time derivatives.",
            effect: f64 = r"The largest attitude error over the span \[rad\]: by this term, or by all terms together.",
            limit: f64 = r"Upper limit of the effect \[rad\].",
        } => Theory, facts("orbit", *effect, *limit);

        /// A torque that is too strong for an expansion in it.
        #[error("the torque is too strong for an expansion in it: {}", .measure.sentence(*.size, *.bound))]
        TorqueTooStrong { measure: TorqueMeasure = "What is measured.", size: f64 = "The measured value.", bound: f64 = "Its upper limit." }
        => Theory, facts("orbit", *size, *bound);

        /// A span with more orbits than the averaged equations can be solved for.
        #[error("averaging = spin: the span has {orbits} orbits on one side of the epoch, and the averaged equations are solved for {bound} at most; averaging over the orbit reaches farther", orbits = Short(.orbits.round()))]
        TooManyOrbits { orbits: f64 = "Orbits from the epoch to the farther end of the span.", bound: f64 = "The largest number of orbits." }
        => Theory, facts("span", *orbits, *bound);

        /// A span with more arcs than the averaged equations can be solved for: of several bodies, of an orbit that precesses, or over the orbit in second order.
        #[error("span: it reaches {value} from the epoch, and the averaged equations are solved up to {bound:.6e}", value = Short(*.value))]
        SpanOfBodies { value: f64 = "The time from the epoch to the farther end of the span.", bound: f64 = "The largest time." }
        => Theory, facts("span", *value, *bound);

        /// A rotation that is not fast against its torques, or that has no average.
        #[error("no average over the rotation holds: {reason} is {}, and must be below {}; integrate (Scene.solve, method = integrated)", four_digits(*.size), four_digits(*.bound))]
        NotAveraged { reason: &'static str = "What is measured.", size: f64 = "The measured value.", bound: f64 = "Its upper limit." }
        => Theory, facts("torques", *size, *bound);

        /// A mode of motion for which the gravity-gradient theory is not valid.
        #[error("orbit: {}", unaveraged(.mode, *.ratio, *.bound))]
        Unaveraged { mode: String = "The mode.", ratio: f64 = "σ/σ_sep.", bound: f64 = "The largest valid ratio." }
        => Theory, if ratio > bound { facts("orbit", *ratio, *bound) } else { facts("orbit", mode, "a body that rotates") };

        /// An invalid table of positions, or a time outside the table.
        #[error("orbit.{argument}[{index}] = {value}: it must be {bound}", value = Short(*.value))]
        Table {
            argument: &'static str = "The argument.",
            index: usize = "The index in it.",
            value: f64 = "The value; if there are too few times, their number.",
            bound: &'static str = "The requirement.",
        } => Input, facts(*argument, *value, *bound);

        /// An orbital frame that does not exist: an unknown name, or an index without a body.
        #[error("{argument} = {value}: it must be {bound}")]
        OrbitalFrame { argument: &'static str = "The argument.", value: String = "Its value.", bound: String = "The requirement." }
        => Input, facts(*argument, value, bound);

        /// A parameter of derivatives that the scene lacks.
        #[error("with_respect_to = {value}: it must be {bound}")]
        Parameter { value: String = "The parameter.", bound: String = "The requirement." } => Input, facts("with_respect_to", value, bound);

        /// A span that a table of positions does not cover.
        #[error("span: the integration goes from {start} to {stop}, and the table of positions only from {first} to {last}", start = Short(*.start), stop = Short(*.stop), first = Short(*.first), last = Short(*.last))]
        TableSpan {
            start: f64 = "The first time that is needed.",
            stop: f64 = "The last time that is needed.",
            first: f64 = "The first time of the table.",
            last: f64 = "The last time of the table.",
        } => Input, facts("span", [*start, *stop], [*first, *last]);

        /// An integration without a span.
        #[error("span: none is given, and the integrated method needs one{}", because(.reason))]
        NoSpan { reason: String = "Why the motion is integrated; empty if the method was requested." }
        => Input, facts("span", "none", "start <= stop");

        /// A scene that only the integrated method can solve, with another method.
        #[error("method = \"{method}\": {reason}; use method = \"integrated\" or \"auto\" with a span")]
        OnlyIntegrated { method: String = "The requested method.", reason: String = "The part of the scene that needs the integration." }
        => Theory, facts("method", method, "integrated");

        /// An integration with too many steps.
        #[error("span: the integration needs {}{}", too_many(*.steps, *.bound), instead_of(.reason))]
        TooManySteps {
            steps: f64 = "Steps over the span, estimated; infinite if only the bound is known to be exceeded.",
            bound: usize = "The largest number of steps.",
            reason: String = "Why the scene is integrated, or empty.",
        } => Theory, facts("span", *steps, *bound as f64);

        /// A passage of a pericentre that leaves the body with a rotation too fast for the rest of the span.
        #[error("span: the passage at {time} leaves the body rotating with {rate:.1e} rad per unit of time, and the rest of the span needs more than {steps:.1e} steps; at most {bound} are kept: end the span before this passage", time = Short(*.time))]
        SpunUp {
            time: f64 = "The time of the passage.",
            rate: f64 = "The rate after it.",
            steps: f64 = "Steps of the rest of the span.",
            bound: usize = "The largest number of steps.",
        } => Theory, facts("span", *time, *bound as f64);

        /// A motion whose nearby states separate so fast that the attitude at the end of the span is unknown.
        #[error("span = [{first}, {last}]: nearby states separate so fast that the attitude is unknown at its end; the tolerance, {tolerance:e} rad, holds from {start} to {stop}, the error bound is below half a turn from {known_first} to {known_last}", first = Short(.span[0]), last = Short(.span[1]), start = Short(*.start), stop = Short(*.stop), known_first = Short(.known[0]), known_last = Short(.known[1]))]
        Unpredictable {
            tolerance: f64 = r"The tolerance \[rad\].",
            span: [f64; 2] = "First and last time of the span.",
            start: f64 = "The earliest time at which the tolerance holds.",
            stop: f64 = "The latest time at which the tolerance holds.",
            known: [f64; 2] = "The earliest and the latest time at which the error bound is below half a turn.",
        } => Theory, facts("span", *span, [*start, *stop]);

        /// A number of times at which a motion cannot be verified.
        #[error("samples = {value}: it must be from {least} to {most}")]
        Samples { value: usize = "The number as given.", least: usize = "The least number.", most: usize = "The largest number." }
        => Input, facts("samples", *value, Value::Integers(vec![*least as i64, *most as i64]));

        /// A span of a verification that goes beyond the times for which the error bound of the motion holds.
        #[error("span = [{start}, {stop}]: it must be within [{first}, {last}], for which the error bound holds", start = Short(*.start), stop = Short(*.stop), first = Short(*.first), last = Short(*.last))]
        VerifiedSpan {
            start: f64 = "Its first time.",
            stop: f64 = "Its last time.",
            first: f64 = "The first time for which the bound holds.",
            last: f64 = "The last time for which the bound holds.",
        } => Input, facts("span", [*start, *stop], [*first, *last]);

        /// A verification without a span that would take too long.
        #[error("span: none is given to verify, and an integration over {over} takes about {} ({steps:.1e} steps); at most {bound} s are allowed without a span", duration_in_words(*.seconds))]
        LongVerification {
            seconds: f64 = r"The time that it would take, estimated from the number of steps \[s\].",
            steps: f64 = "The number of steps.",
            bound: f64 = r"The longest time without a span \[s\].",
            over: String = "The times over which the motion would be integrated, in words.",
        } => Input, facts("span", *seconds, *bound);

        /// An invalid member of an ensemble, or a member that could not be evaluated.
        #[error("member {index}: {problem}{}", and_others(*.others))]
        Member {
            index: usize = "Its index.",
            others: usize = "Number of other bad members found so far.",
            problem: Box<Error> = "The error of this member.",
        } => problem.kind(), problem.facts();

        /// An error of which only the statement is known: that of a refused member of an ensemble that was pickled.
        #[error("{message}")]
        Stated {
            kind: Kind = "Its kind.",
            argument: Option<String> = "The argument.",
            value: Option<Box<Value>> = "The given value.",
            bound: Option<Box<Value>> = "The requirement on the value.",
            message: String = "Its sentence.",
        } => *kind, Facts { argument: argument.as_deref(), value: value.as_deref().cloned(), bound: bound.as_deref().cloned() };

        /// An unknown word for the treatment of bad members of an ensemble.
        #[error("errors = {value:?}: it must be \"raise\" or \"nan\"")]
        OnError { value: String = "The word as given." } => Input, facts("errors", value, "raise, nan");

        /// A computation that was stopped by its flag.
        #[error("stopped before the end")]
        Stopped => Internal, Facts::default();

        /// An index that exceeds the number of members of an ensemble.
        #[error("index = {index}: the ensemble has {members} members, counted from 0")]
        Index { index: usize = "The index as given.", members: usize = "Number of members." }
        => Input, facts("index", *index, members.saturating_sub(1));

        /// A number of threads that the system cannot provide.
        #[error("threads = {value}: {problem}")]
        Threads { value: usize = "The number as given.", problem: String = "The message of the system." } => Input, facts("threads", *value, problem);

        /// A body that is not in the catalogue.
        #[error("body {name:?} is not in the catalogue{}: it has {}", did_you_mean(.name, .known), .known.join(", "))]
        UnknownBody { name: String = "The name as given.", known: Vec<&'static str> = "The names in the catalogue." }
        => Input, facts("name", name, known.join(", "));

        /// An error of the series crate. No input that passes the checks of this crate is known to cause it.
        #[error("{0}")]
        Series(error: andoyer_series::Error) => error.kind(), Facts { argument: error.argument(), value: error.value(), bound: error.bound() };

        /// A scene file that cannot be read or that contains an error.
        #[error("{file}: {key}: {problem}")]
        SceneFile {
            file: String = "The file.",
            key: String = "The key, dotted, or the line.",
            problem: String = "The problem, with the bound.",
            value: Option<Box<Value>> = "The value of the key, if it has one.",
            bound: Option<Box<Value>> = "The requirement on the value.",
        } => File, Facts { argument: Some(key), value: value.as_deref().cloned(), bound: bound.as_deref().cloned() };
    }
}

impl From<andoyer_series::Error> for Error {
    fn from(error: andoyer_series::Error) -> Self {
        Self::Series(error)
    }
}
