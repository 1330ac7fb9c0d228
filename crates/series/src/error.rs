//! The error type of the crate.
//!
//! Each variant has fields for the argument, its value and the bound that it breaks. Valid input never causes an error. Examples of invalid input are an
//! exponent that does not fit its field, an unknown name, a text that is not a polynomial, and a file that is not a normal form.

mod facts;
mod problems;

use thiserror::Error;

pub use facts::{Kind, Short, Value};
pub use problems::{ParseProblem, TermProblem};

/// An error, with the offending value and its bound.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// An exponent does not fit its field of the packed monomial.
    #[error("exponent {exponent} of variable slot {slot} exceeds the bound {bound}")]
    ExponentOverflow {
        /// Slot of the variable.
        slot: usize,
        /// The exponent asked for.
        exponent: u64,
        /// The largest exponent that a field holds.
        bound: u32,
    },
    /// A variable slot beyond the last one.
    #[error("variable slot {slot} does not exist: there are {count}")]
    SlotOutOfRange {
        /// The slot asked for.
        slot: usize,
        /// Number of slots.
        count: usize,
    },
    /// A variable slot appears in two pairs, or twice in one.
    #[error("variable slot {slot} appears more than once")]
    SlotRepeated {
        /// The slot.
        slot: usize,
    },
    /// A division by zero, or by an element without an inverse.
    #[error("division by zero in a coefficient")]
    DivisionByZero,
    /// A point has no value for a variable that occurs in the polynomial.
    #[error("no value for variable slot {slot}: {given} values given")]
    ValueMissing {
        /// The slot of the variable.
        slot: usize,
        /// Number of values given.
        given: usize,
    },
    /// A term that the homological equation cannot remove: it lies in the kernel of the unperturbed motion.
    #[error("the homological equation has no solution: exponents {exponents:?} lie in the kernel")]
    Resonant {
        /// Exponents of the offending term, one for each slot.
        exponents: [u32; 8],
    },
    /// The Hamiltonian of order zero is not the diagonal quadratic form of the homological equation.
    #[error("the Hamiltonian of order 0 ({terms} terms) is not the sum of eigenvalue * q * p")]
    UnperturbedMismatch {
        /// Number of terms in the given Hamiltonian of order zero.
        terms: usize,
    },
    /// A phase space with more variables than the slots of a monomial, or without a pair.
    #[error(
        "{degrees_of_freedom} degrees of freedom and {parameters} parameters: a phase space has at least one pair and at most {slots} variables"
    )]
    PhaseSpaceSize {
        /// Pairs (q, p) given.
        degrees_of_freedom: usize,
        /// Parameters given.
        parameters: usize,
        /// Number of variable slots.
        slots: usize,
    },
    /// A Hamiltonian with a linear term: the origin is not an equilibrium.
    #[error("the origin is not an equilibrium: the linear term {term} has the coefficient {coefficient}")]
    LinearTerm {
        /// The term.
        term: String,
        /// Its coefficient.
        coefficient: String,
    },
    /// A term whose parameters have too low a degree. The term would belong to the quadratic part, whose coefficients must be numbers.
    #[error(
        "the term {term} would be of order 0: give a parameter in it a degree of at least {bound}, to make it a detuning, or a number for its value"
    )]
    ParameterDegree {
        /// The term.
        term: String,
        /// The smallest degree that the parameter may have.
        bound: u32,
    },
    /// A name that is not a parameter of the space.
    #[error("{name:?} is not a parameter: the parameters are [{known}]")]
    ParameterUnknown {
        /// The name given.
        name: String,
        /// The names of the parameters.
        known: String,
    },
    /// A quadratic part with an eigenvalue 0: along one direction the motion neither oscillates nor grows nor decays.
    #[error(
        "the quadratic part in {pairs} has a zero frequency, along the direction with the components {direction}: no normal form of this kind exists there"
    )]
    ZeroFrequency {
        /// The pairs of the coupled block.
        pairs: String,
        /// Magnitudes of the components of the null vector.
        direction: String,
    },
    /// A quadratic part whose frequency is 0 when its parameters are 0.
    #[error(
        "the quadratic part in {pairs} has a zero frequency where its parameters are 0, in the term {term}: write the parameter as a number and a detuning, w = w0 + d, or scale q -> q/sqrt(w), p -> p sqrt(w), t -> t/w, so that the frequency is a number (PhaseSpace::scaled; in Python the argument frequency)"
    )]
    FrequencyParameter {
        /// The pairs of the coupled block.
        pairs: String,
        /// A quadratic term with a parameter.
        term: String,
    },
    /// A parameter that cannot be removed by scaling.
    #[error(
        "in the variables q sqrt({letter}), p/sqrt({letter}) the term {term} has the power {power} of 1/sqrt({letter}): it must be 0 in the quadratic part, so that every frequency is a number times {letter}, and not negative elsewhere"
    )]
    FrequencyLetter {
        /// The parameter.
        letter: String,
        /// The term as given.
        term: String,
        /// The power of 1/√w in the scaled term.
        power: i64,
    },
    /// A quadratic part that cannot be diagonalized.
    #[error(
        "the quadratic part in {pairs} cannot be diagonalized: the eigenvalues {eigenvalue} have a Jordan block, with the eigenvector of components {direction}"
    )]
    Defective {
        /// The pairs of the coupled block.
        pairs: String,
        /// The eigenvalues.
        eigenvalue: String,
        /// Magnitudes of the components of the eigenvector.
        direction: String,
    },
    /// A quadratic part with rational coefficients whose eigenvalues are not rational.
    #[error(
        "the eigenvalues {eigenvalue} of the quadratic part in {pairs} are not rational (with a denominator below 1e7): use floats, or, if all frequencies are rational multiples of one root, write a parameter w for the root and scale w away (PhaseSpace::scaled; in Python the argument frequency)"
    )]
    SpectrumIrrational {
        /// The pairs of the coupled block.
        pairs: String,
        /// The eigenvalues.
        eigenvalue: String,
    },
    /// A frequency √(ab) that is not rational although the coefficients are.
    #[error(
        "the frequency of the mode ({coordinate}, {momentum}) is the square root of {square}, which is not rational: use floats, or, if all frequencies are rational multiples of this root, write w^2 for {square} with a parameter w and scale w away (PhaseSpace::scaled; in Python the argument frequency)"
    )]
    FrequencyIrrational {
        /// Name of q.
        coordinate: String,
        /// Name of p.
        momentum: String,
        /// The square of the frequency.
        square: String,
    },
    /// A number that is infinite or NaN, in the input or after an overflow.
    #[error("the {what} contains a number that is not finite: {term}")]
    NotFinite {
        /// The object that contains the number.
        what: &'static str,
        /// The term or the value.
        term: String,
    },
    /// A term that must be removed, but whose divisor is too small.
    #[error(
        "small divisor at order {order}: the term {term}, k = {k:?}, has |k·ω| = {divisor:?} below the bound {bound:?}; keep it as a resonance, or lower the bound"
    )]
    SmallDivisor {
        /// Order of the term: its degree minus 2.
        order: usize,
        /// The term in the complex variables u, U of the pairs.
        term: String,
        /// k: the exponents of U minus the exponents of u.
        k: Vec<i64>,
        /// |k·ω|.
        divisor: f64,
        /// The bound: the relative smallest divisor times the largest frequency.
        bound: f64,
    },
    /// A requested resonance that the frequencies do not satisfy.
    #[error("k = {vector:?} is not a resonance: k·ω = {divisor:?} is not below the bound {bound:?}")]
    NotResonant {
        /// The vector given.
        vector: Vec<i64>,
        /// k·ω.
        divisor: f64,
        /// The bound: the relative smallest divisor times the largest frequency.
        bound: f64,
    },
    /// A vector that cannot be a resonance.
    #[error(
        "k = {vector:?} is not a resonance vector: it has one integer of at most {bound} for each degree of freedom, and not all are 0"
    )]
    ResonanceMalformed {
        /// The vector given.
        vector: Vec<i64>,
        /// Largest absolute value of an entry.
        bound: u32,
    },
    /// A normal form with a resonant term, where a function of the actions alone is required.
    #[error("the normal form is not a function of the actions alone: it contains {term}")]
    ResonantTerm {
        /// The term in the complex variables.
        term: String,
    },
    /// The progress callback stopped the computation.
    #[error("interrupted after order {done} of {of}")]
    Interrupted {
        /// Number of orders computed.
        done: usize,
        /// Number of orders requested.
        of: usize,
    },
    /// An order that the packed exponents cannot hold.
    #[error("order {order} exceeds the bound {bound}")]
    OrderTooLarge {
        /// The order requested.
        order: usize,
        /// The largest order.
        bound: usize,
    },
    /// An order whose normal form would not fit in memory.
    #[error("order {order} would take some {estimate_gib:.0} GiB of memory: the bound is {bound_gib} GiB")]
    MemoryTooLarge {
        /// The order asked for.
        order: usize,
        /// Estimated memory.
        estimate_gib: f64,
        /// Largest estimate that is accepted.
        bound_gib: f64,
    },
    /// An order outside the computed range.
    #[error("order {order} of the {what} is outside {minimum}..={maximum}")]
    OrderOutOfRange {
        /// The series requested.
        what: &'static str,
        /// The order requested.
        order: usize,
        /// The smallest order available.
        minimum: usize,
        /// The largest order available.
        maximum: usize,
    },
    /// An unknown name.
    #[error("unknown {what} {name:?}; known: {known}")]
    NameUnknown {
        /// The kind of object that the name stands for.
        what: &'static str,
        /// The name given.
        name: String,
        /// The known names.
        known: &'static str,
    },
    /// A number outside its interval (NaN is outside every interval).
    #[error("{argument} = {} is outside [{lower}, {upper}]", Short(*.value))]
    OutsideInterval {
        /// Name of the argument.
        argument: &'static str,
        /// Its value.
        value: f64,
        /// Smallest admissible value.
        lower: f64,
        /// Largest admissible value.
        upper: f64,
    },
    /// A text that is not a polynomial.
    #[error("at byte {position}: {problem}")]
    Parse {
        /// Offset of the offending byte.
        position: usize,
        /// What is wrong there.
        problem: ParseProblem,
    },
    /// A text that is not JSON, or JSON of another shape.
    #[error("not the JSON of a normal form: {message} at line {line} column {column}")]
    Json {
        /// Line of the text, from 1; 0 if the error has no line.
        line: usize,
        /// Column of the line, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// A JSON document of another format or version.
    #[error("format {format:?} version {version} is unknown: {known_format:?} version {known_version} is read")]
    FormatUnknown {
        /// Name of the format found.
        format: String,
        /// Version found.
        version: u64,
        /// The format that is read.
        known_format: &'static str,
        /// The version that is read.
        known_version: u64,
    },
    /// A rational number that is not in canonical form: `p`, or reduced `p/q` with q > 1.
    #[error("{text:?} is not a reduced rational \"p/q\"")]
    RationalMalformed {
        /// The text found.
        text: String,
    },
    /// A list whose length is not the required one.
    #[error("{what} has {found} entries: it must have {expected}")]
    CountMismatch {
        /// Name of the list.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries expected.
        expected: usize,
    },
    /// A matrix from a file that is not symplectic: Mᵀ J M ≠ J.
    #[error("the linear change is not symplectic: entry ({row}, {column}) of MᵀJM − J is {error:?}")]
    NotSymplectic {
        /// Row of MᵀJM − J.
        row: usize,
        /// Column of MᵀJM − J.
        column: usize,
        /// The entry.
        error: f64,
    },
    /// A term that a normal form of this kind cannot contain.
    #[error("term {exponents:?} of the {what} of order {order}: {problem}")]
    TermInconsistent {
        /// The series that contains the term.
        what: &'static str,
        /// Order in the small parameter.
        order: usize,
        /// Exponents (u, U, β), or (β) alone.
        exponents: Vec<u32>,
        /// The reason.
        problem: TermProblem,
    },
    /// A coefficient from a file that differs from that of the rigid body, or from that of the Hamiltonian in the same file.
    #[error(
        "the {what} of order {order} has the coefficient {found} at the exponents {exponents:?}: it must be {expected}"
    )]
    CoefficientWrong {
        /// The series that contains the coefficient.
        what: &'static str,
        /// Order in the small parameter.
        order: usize,
        /// Exponents (u, U, β), or (β) alone. For a Birkhoff normal form they are those of its variables; for its linear change, the column.
        exponents: Vec<u32>,
        /// The coefficient read, or 0 if the file has none.
        found: String,
        /// The coefficient of the normal form, or 0 if there is none.
        expected: String,
    },
}

impl Error {
    /// The error for a text that is not the expected JSON.
    pub(crate) fn json(error: serde_json::Error) -> Self {
        let (line, column, text) = (error.line(), error.column(), error.to_string());
        let place = format!(" at line {line} column {column}");
        Self::Json { line, column, message: text.strip_suffix(&place).unwrap_or(&text).to_owned() }
    }
}
