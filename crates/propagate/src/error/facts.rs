//! The facts of an error as data: its kind, the argument, the given value and the bound that it breaks.
//!
//! `Kind` and `Value` are the types of the series crate. The four methods are inherent ones in both crates, so that a caller needs no trait in scope.

use super::Error;
pub use andoyer_series::error::{Kind, Value};

const POSITIVE: &str = "positive and finite";

/// The argument, the value and the bound of an error.
type Facts<'a> = (Option<&'a str>, Option<Value>, Option<Value>);

fn facts<'a>(argument: &'a str, value: impl Into<Value>, bound: impl Into<Value>) -> Facts<'a> {
    (Some(argument), Some(value.into()), Some(bound.into()))
}

impl Error {
    /// What a caller can do about this error. For a member of an ensemble it is that of the member's error.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::SceneFile { .. } => Kind::File,
            Self::Units { .. } | Self::Order { .. } | Self::NoCode { .. } => Kind::Representation,
            Self::Time { value, .. } if value.is_finite() => Kind::Representation,
            Self::NearSeparatrix { .. }
            | Self::Separatrix
            | Self::SeparatrixPartials
            | Self::Resonance { .. }
            | Self::TorqueTooStrong { .. }
            | Self::TooManyOrbits { .. }
            | Self::SpanOfBodies { .. }
            | Self::OnlyIntegrated { .. }
            | Self::TooManySteps { .. }
            | Self::Unpredictable { .. }
            | Self::Unaveraged { .. } => Kind::Theory,
            Self::Stopped => Kind::Internal,
            Self::Series(error) => error.kind(),
            Self::Member { problem, .. } => problem.kind(),
            Self::Moment { .. }
            | Self::InertiaSymmetry { .. }
            | Self::InertiaMoments { .. }
            | Self::Positive { .. }
            | Self::MomentsTriangle { .. }
            | Self::MomentsRatio { .. }
            | Self::Attitude { .. }
            | Self::AngularVelocity { .. }
            | Self::Epoch { .. }
            | Self::Tolerance { .. }
            | Self::Span { .. }
            | Self::Method { .. }
            | Self::CodeLanguage { .. }
            | Self::Time { .. }
            | Self::Length { .. }
            | Self::TooFew { .. }
            | Self::Convention { .. }
            | Self::ModeName { .. }
            | Self::NoSuchMode { .. }
            | Self::PeriodRatio { .. }
            | Self::Latitude { .. }
            | Self::Direction { .. }
            | Self::Andoyer { .. }
            | Self::Orbit { .. }
            | Self::NoSemiMajorAxis
            | Self::Table { .. }
            | Self::TableSpan { .. }
            | Self::NoSpan { .. }
            | Self::Samples { .. }
            | Self::VerifiedSpan { .. }
            | Self::LongVerification { .. }
            | Self::Level { .. }
            | Self::OneFixedOrbit { .. }
            | Self::Averaging { .. }
            | Self::OnError { .. }
            | Self::Index { .. }
            | Self::Threads { .. }
            | Self::UnknownBody { .. } => Kind::Input,
        }
    }

    /// The argument that is wrong, without an index. For a file it is the key with its table.
    #[must_use]
    pub fn argument(&self) -> Option<&str> {
        self.facts().0
    }

    /// The given value, or the number computed from it that breaks the bound.
    #[must_use]
    pub fn value(&self) -> Option<Value> {
        self.facts().1
    }

    /// The requirement on the value: a number, an interval or words.
    #[must_use]
    pub fn bound(&self) -> Option<Value> {
        self.facts().2
    }

    fn facts(&self) -> Facts<'_> {
        match self {
            Self::Series(error) => (error.argument(), error.value(), error.bound()),
            Self::Member { problem, .. } => problem.facts(),
            Self::SceneFile { key, value, bound, .. } => {
                (Some(key), value.as_deref().cloned(), bound.as_deref().cloned())
            }
            Self::Stopped => (None, None, None),
            other => other
                .facts_of_body()
                .or_else(|| other.facts_of_state())
                .or_else(|| other.facts_of_choice())
                .unwrap_or_else(|| other.facts_of_motion()),
        }
    }

    fn facts_of_body(&self) -> Option<Facts<'_>> {
        Some(match self {
            Self::Moment { value, .. } => facts("moments", *value, POSITIVE),
            Self::InertiaSymmetry { value, .. } => {
                facts("tensor", *value, "finite and symmetric to 1e-12 of its largest entry")
            }
            Self::InertiaMoments { moments } => facts("tensor", *moments, "positive principal moments"),
            Self::Positive { argument, value } => facts(argument, *value, POSITIVE),
            Self::MomentsTriangle { moments, .. } => {
                facts("moments", *moments, "the largest at most the sum of the other two")
            }
            Self::MomentsRatio { ratio, bound, .. } => facts("moments", *ratio, *bound),
            Self::UnknownBody { name, known } => facts("name", name, known.join(", ")),
            _ => return None,
        })
    }

    fn facts_of_state(&self) -> Option<Facts<'_>> {
        Some(match self {
            Self::Units { exponent, .. } => {
                let exponents = Value::Integers(vec![-1021, 1021]);
                facts("moments and angular_velocity", Value::Integer((*exponent).into()), exponents)
            }
            Self::Attitude { value, .. } => facts("attitude", *value, "finite with a norm within 1e-6 of 1"),
            Self::AngularVelocity { value, .. } => facts("angular_velocity", *value, "finite"),
            Self::Epoch { value } => facts("epoch", *value, "finite"),
            Self::PeriodRatio { ratio, lower, upper, .. } => facts("rotation/precession", *ratio, [*lower, *upper]),
            Self::NoSuchMode { mode, .. } => facts("mode", mode, "a mode that the body has"),
            Self::Direction { argument, value } => {
                let zero = value.iter().all(|x| *x == 0.0);
                facts(argument, Value::Numbers(value.clone()), if zero { "finite and not 0" } else { "finite" })
            }
            Self::Latitude { value } => facts("momentum_direction", *value, "a latitude from -pi/2 to pi/2"),
            Self::Andoyer { value, bound, .. } => facts("andoyer", *value, bound),
            Self::Orbit { argument, value, bound } => facts(argument, *value, *bound),
            Self::NoSemiMajorAxis => facts("semi_major_axis", "none", "positive"),
            Self::Table { argument, value, bound, .. } => facts(argument, *value, *bound),
            _ => return None,
        })
    }

    fn facts_of_choice(&self) -> Option<Facts<'_>> {
        Some(match self {
            Self::Tolerance { value } => facts("tolerance", *value, POSITIVE),
            Self::Span { start, stop } => facts("span", [*start, *stop], "finite with start <= stop"),
            Self::Order { value, bound } => facts("order", *value, *bound),
            Self::Method { value } => facts("method", value, "auto, series, closed, integrated"),
            Self::CodeLanguage { value } => facts("language", value, "c, rust, python, javascript"),
            Self::Convention { value } => facts("convention", value, "extremal-axis, long-axis, short-axis"),
            Self::ModeName { value } => facts("mode", value, "short-axis, long-axis"),
            Self::Level { value } => facts("level", value, "auto, paper, moving, full, second-order"),
            Self::OneFixedOrbit { argument, value } => {
                facts(argument, value, if *argument == "level" { "auto, paper, moving, full" } else { "auto, spin" })
            }
            Self::Averaging { value } => facts("averaging", value, "auto, orbit, spin"),
            Self::OnError { value } => facts("errors", value, "raise, nan"),
            Self::Threads { value, problem } => facts("threads", *value, problem),
            Self::Index { index, members } => facts("index", *index, members.saturating_sub(1)),
            Self::Length { argument, found, expected } => facts(argument, *found, *expected),
            Self::TooFew { argument, found, least } => facts(argument, *found, *least),
            Self::Samples { value, least, most } => {
                facts("samples", *value, Value::Integers(vec![*least as i64, *most as i64]))
            }
            _ => return None,
        })
    }

    fn facts_of_motion(&self) -> Facts<'_> {
        match self {
            Self::Time { value, bound, .. } => facts("times", *value, *bound),
            Self::NearSeparatrix { tolerance, attainable, .. } => facts("tolerance", *tolerance, *attainable),
            Self::Separatrix => facts("method", "series", "closed"),
            Self::NoCode { motion } => facts("motion", *motion, "rest, steady rotation or a torque-free wobble"),
            Self::SeparatrixPartials => facts("angular_velocity", 1.0, "sigma/sigma_sep other than 1"),
            Self::Resonance { effect, limit, .. } => facts("orbit", *effect, *limit),
            Self::TorqueTooStrong { size, bound, .. } => facts("orbit", *size, *bound),
            Self::TooManyOrbits { orbits, bound } => facts("span", *orbits, *bound),
            Self::SpanOfBodies { value, bound } => facts("span", *value, *bound),
            Self::Unaveraged { ratio, bound, .. } if ratio > bound => facts("orbit", *ratio, *bound),
            Self::Unaveraged { mode, .. } => facts("orbit", mode, "a body that rotates"),
            Self::TableSpan { start, stop, first, last } => facts("span", [*start, *stop], [*first, *last]),
            Self::VerifiedSpan { start, stop, first, last } => facts("span", [*start, *stop], [*first, *last]),
            Self::LongVerification { seconds, bound, .. } => facts("span", *seconds, *bound),
            Self::NoSpan { .. } => facts("span", "none", "start <= stop"),
            Self::OnlyIntegrated { method, .. } => facts("method", method, "integrated"),
            Self::TooManySteps { steps, bound, .. } => facts("span", *steps, *bound as f64),
            Self::Unpredictable { span, start, stop, .. } => facts("span", *span, [*start, *stop]),
            _ => (None, None, None),
        }
    }
}
