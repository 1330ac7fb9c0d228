//! What is wrong with a text or with a term.

use super::facts::{Facts, Kind, facts};
use thiserror::Error;

/// The reason why a text is not a polynomial.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ParseProblem {
    /// The text ends where an operand is required.
    #[error("the text ends where an operand or a bracket is required")]
    UnexpectedEnd,
    /// A character that cannot stand there.
    #[error("unexpected character {0:?}")]
    UnexpectedCharacter(char),
    /// A name that is not a variable.
    #[error("unknown name {0:?}")]
    UnknownName(String),
    /// A name before a bracket: a function.
    #[error(
        "{0:?} is a function, and only polynomials are read, and cosines and sines of named driven phases: expand it as a Taylor polynomial, for a normal form of order N to degree N + 2"
    )]
    Function(String),
    /// A driven phase outside of a cosine or a sine.
    #[error("{0:?} is a driven phase: it stands in cos(j*{0}) and sin(j*{0}) only")]
    PhaseAlone(String),
    /// A cosine or sine whose angle is not a sum of multiples of driven phases.
    #[error(
        "the angle of a cosine or sine is a sum of integer multiples (below 65536) of driven phases; their rates are given apart, as for cos(2*M) with driven={{\"M\": 1.7}} in Python"
    )]
    Angle,
    /// A square root.
    #[error(
        "\"sqrt\" is a square root, and only polynomials are read: write a number in decimals, or, if all frequencies are rational multiples of the root, write a parameter w for the root and scale w away (PhaseSpace::scaled; in Python the argument frequency)"
    )]
    SquareRoot,
    /// A bracket after an operand: a product without its sign.
    #[error("a factor in brackets needs * before it")]
    ProductWithoutSign,
    /// The list of names is longer than the number of slots, contains a name twice, or contains a name that is not an identifier.
    #[error("the list of variable names cannot hold {0:?}")]
    UnusableName(String),
    /// A divisor that contains a variable.
    #[error("the divisor is not a constant")]
    DivisorNotConstant,
    /// A divisor that is zero.
    #[error("the divisor is zero")]
    DivisorZero,
    /// An exponent above the bound.
    #[error("the exponent exceeds {bound}")]
    ExponentTooLarge {
        /// The largest exponent that is read.
        bound: u32,
    },
    /// Brackets or signs nested too deeply.
    #[error("nested deeper than {bound}")]
    TooDeep {
        /// The deepest nesting that is read.
        bound: u32,
    },
    /// The expansion of the polynomial would take too much work.
    #[error("expanding the text takes too much work")]
    TooLarge,
}

impl ParseProblem {
    /// What a caller can do about a text with this problem.
    pub(super) fn kind(&self) -> Kind {
        if matches!(self, Self::ExponentTooLarge { .. } | Self::TooLarge) { Kind::Representation } else { Kind::Input }
    }

    /// The facts of this problem. The value is the offset of the byte if there is no better one.
    pub(super) fn facts<'a>(&self, position: usize) -> Facts<'a> {
        match self {
            Self::UnexpectedCharacter(found) => facts(None, found.to_string(), "a polynomial"),
            Self::UnknownName(name) => facts(None, name, "a variable or parameter"),
            Self::Function(name) => facts(None, name, "a polynomial"),
            Self::PhaseAlone(name) => facts(None, name, "a cosine or sine of the phase"),
            Self::Angle => facts(None, position, "integer multiples of driven phases"),
            Self::SquareRoot => facts(None, "sqrt", "a polynomial"),
            Self::UnusableName(name) => facts(None, name, "an identifier, once"),
            Self::ExponentTooLarge { bound } | Self::TooDeep { bound } => facts(None, position, *bound),
            _ => facts(None, position, "a polynomial"),
        }
    }
}

/// The reason why a term from a file is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TermProblem {
    /// The degree is not that of the order.
    #[error("its degree is not the one of this order")]
    Degree,
    /// The term lies in the kernel of the unperturbed motion.
    #[error("it lies in the kernel of the unperturbed motion")]
    Kernel,
    /// The harmonic k − j does not have this power of β.
    #[error("its power of beta is not |k - j|/2 plus an even number")]
    Harmonic,
    /// The coefficient makes the function complex on real motions.
    #[error("the function would not be real on real motions")]
    NotReal,
    /// The same exponents appear twice.
    #[error("it appears twice")]
    Repeated,
    /// The coefficient is zero.
    #[error("its coefficient is zero")]
    Zero,
}
