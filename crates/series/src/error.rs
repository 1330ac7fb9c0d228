//! The error type of the crate.
//!
//! Each variant stands once, in the table below (`error_table`): its sentence, its fields, its kind, and its facts: argument, value and bound. Valid input
//! never causes an error. Examples of invalid input are an exponent that does not fit its field, an unknown name, a text that is not a polynomial, and a file
//! that is not a normal form.

mod facts;
mod problems;
mod table;

use Kind::{File, Input, Internal, Representation, Theory};

#[doc(hidden)]
pub use facts::{Facts, facts};
pub use facts::{Kind, Short, Value};
pub use problems::{ParseProblem, TermProblem};

crate::error_table! {
    /// An error, with the offending value and its bound.
    #[derive(Debug, Clone, PartialEq, thiserror::Error)]
    #[non_exhaustive]
    pub enum Error {
        /// An exponent does not fit its field of the packed monomial.
        #[error("exponent {exponent} of variable slot {slot} exceeds the bound {bound}")]
        ExponentOverflow {
            slot: usize = "Slot of the variable.",
            exponent: u64 = "The exponent asked for.",
            bound: u32 = "The largest exponent that a field holds.",
        } => Representation, facts(None, *exponent, *bound);

        /// A variable slot beyond the last one.
        #[error("variable slot {slot} does not exist: there are {count}")]
        SlotOutOfRange { slot: usize = "The slot asked for.", count: usize = "Number of slots." }
        => Input, facts("slot", *slot, count.saturating_sub(1));

        /// A variable slot appears in two pairs, or twice in one.
        #[error("variable slot {slot} appears more than once")]
        SlotRepeated { slot: usize = "The slot." } => Input, facts("slot", *slot, "once");

        /// A division by zero, or by an element without an inverse.
        #[error("division by zero in a coefficient")]
        DivisionByZero => Input, facts(None, 0.0, "not 0");

        /// A point has no value for a variable that occurs in the polynomial.
        #[error("no value for variable slot {slot}: {given} values given")]
        ValueMissing { slot: usize = "The slot of the variable.", given: usize = "Number of values given." }
        => Input, facts("values", *given, slot + 1);

        /// A term that the homological equation cannot remove: it lies in the kernel of the unperturbed motion.
        #[error("the homological equation has no solution: exponents {exponents:?} lie in the kernel")]
        Resonant { exponents: [u32; 8] = "Exponents of the offending term, one for each slot." }
        => Theory, facts(None, exponents.as_slice(), "outside the kernel");

        /// The Hamiltonian of order zero is not the diagonal quadratic form of the homological equation.
        #[error("the Hamiltonian of order 0 ({terms} terms) is not the sum of eigenvalue * q * p")]
        UnperturbedMismatch { terms: usize = "Number of terms in the given Hamiltonian of order zero." }
        => Input, facts("hamiltonian", *terms, "the sum of eigenvalue * q * p");

        /// A phase space with more variables than the slots of a monomial, or without a pair.
        #[error("{degrees_of_freedom} degrees of freedom and {parameters} parameters and driven phases: a phase space has at least one pair and at most {slots} variables")]
        PhaseSpaceSize {
            degrees_of_freedom: usize = "Pairs (q, p) given.",
            parameters: usize = "Parameters and driven phases given.",
            slots: usize = "Number of variable slots.",
        } => Input, facts("variables", 2 * degrees_of_freedom + parameters, *slots);

        /// A Hamiltonian with a linear term: the origin is not an equilibrium.
        #[error("the origin is not an equilibrium: the linear term {term} has the coefficient {coefficient}")]
        LinearTerm { term: String = "The term.", coefficient: String = "Its coefficient." } => Input, facts("hamiltonian", term, "no linear term");

        /// A term whose parameters have too low a degree. The term would belong to the quadratic part, whose coefficients must be numbers.
        #[error("the term {term} would be of order 0: give a parameter in it a degree of at least {bound}, to make it a detuning, or a number for its value")]
        ParameterDegree { term: String = "The term.", bound: u32 = "The smallest degree that the parameter may have." }
        => Input, facts("degrees", term, *bound);

        /// A name that is not a parameter of the space.
        #[error("{name:?} is not a parameter: the parameters are [{known}]")]
        ParameterUnknown { name: String = "The name given.", known: String = "The names of the parameters." } => Input, facts("degrees", name, known);

        /// A quadratic part with an eigenvalue 0: along one direction the motion neither oscillates nor grows nor decays.
        #[error("the quadratic part in {pairs} has a zero frequency, along the direction with the components {direction}: no normal form of this kind exists there")]
        ZeroFrequency { pairs: String = "The pairs of the coupled block.", direction: String = "Magnitudes of the components of the null vector." }
        => Theory, facts("hamiltonian", pairs, "no frequency 0");

        /// A quadratic part whose frequency is 0 when its parameters are 0.
        #[error("the quadratic part in {pairs} has a zero frequency where its parameters are 0, in the term {term}: write the parameter as a number and a detuning, w = w0 + d, or scale q -> q/sqrt(w), p -> p sqrt(w), t -> t/w, so that the frequency is a number (PhaseSpace::scaled; in Python the argument frequency)")]
        FrequencyParameter { pairs: String = "The pairs of the coupled block.", term: String = "A quadratic term with a parameter." }
        => Input, facts("hamiltonian", term, "a number for the frequency");

        /// A parameter that cannot be removed by scaling.
        #[error("in the variables q sqrt({letter}), p/sqrt({letter}) the term {term} has the power {power} of 1/sqrt({letter}): it must be 0 in the quadratic part, so that every frequency is a number times {letter}, and not negative elsewhere")]
        FrequencyLetter {
            letter: String = "The parameter.",
            term: String = "The term as given.",
            power: i64 = "The power of 1/√w in the scaled term.",
        } => Input, facts("hamiltonian", term, "1/sqrt(w) to the power 0 in the quadratic part, not negative elsewhere");

        /// A quadratic part that cannot be diagonalized.
        #[error("the quadratic part in {pairs} cannot be diagonalized: the eigenvalues {eigenvalue} have a Jordan block, with the eigenvector of components {direction}")]
        Defective {
            pairs: String = "The pairs of the coupled block.",
            eigenvalue: String = "The eigenvalues.",
            direction: String = "Magnitudes of the components of the eigenvector.",
        } => Theory, facts("hamiltonian", eigenvalue, "no Jordan block");

        /// A quadratic part with rational coefficients whose eigenvalues are not rational.
        #[error("the eigenvalues {eigenvalue} of the quadratic part in {pairs} are not rational: use floats, or, if all frequencies are rational multiples of one root, write a parameter w for the root and scale w away (PhaseSpace::scaled; in Python the argument frequency)")]
        SpectrumIrrational { pairs: String = "The pairs of the coupled block.", eigenvalue: String = "The eigenvalues." }
        => Representation, facts("hamiltonian", eigenvalue, "rational eigenvalues, or floats");

        /// A frequency √(ab) that is not rational although the coefficients are.
        #[error("the frequency of the mode ({coordinate}, {momentum}) is the square root of {square}, which is not rational: use floats, or, if all frequencies are rational multiples of this root, write w^2 for {square} with a parameter w and scale w away (PhaseSpace::scaled; in Python the argument frequency)")]
        FrequencyIrrational { coordinate: String = "Name of q.", momentum: String = "Name of p.", square: String = "The square of the frequency." }
        => Representation, facts("hamiltonian", square, "the square of a rational number, or floats");

        /// A number that is infinite or NaN, in the input or after an overflow.
        #[error("the {what} contains a number that is not finite: {term}")]
        NotFinite { what: &'static str = "The object that contains the number.", term: String = "The term or the value." }
        => Input, facts(argument_of(what), term, "finite");

        /// A term that must be removed, but whose divisor is too small.
        #[error("small divisor at order {order}: the term {term}, k = {k:?}, has |k·ω| = {divisor:?} below the bound {bound:?}, which is smallest_divisor times the largest frequency; keep it as a resonance, or lower smallest_divisor")]
        SmallDivisor {
            order: usize = "Order of the term: its degree minus 2.",
            term: String = "The term in the complex variables u, U of the pairs.",
            k: Vec<i64> = "k: the exponents of U minus the exponents of u, then j of the driven phases.",
            divisor: f64 = "|k·ω|, with the rates of driven phases after the frequencies in ω.",
            bound: f64 = "The bound: the relative smallest divisor times the largest frequency.",
        } => Theory, facts("resonances", *divisor, *bound);

        /// A coefficient of a driven Hamiltonian that does not have the period of a phase.
        #[error("a coefficient changes by {change:.3e} while driven phase {phase} makes a turn; the largest coefficient is {largest:.3e}")]
        NotPeriodic {
            phase: usize = "The number of the phase, from 0.",
            change: f64 = "The change of the coefficient.",
            largest: f64 = "The largest coefficient at these phases.",
        } => Input, facts("driven", *change, "coefficients of the period 2π");

        /// The solutions over a period of a driven phase take too many steps.
        #[error("over the period of the first driven phase, whose rate is {rate:?}, the linear motion takes {steps} steps, more than {bound}; the other rates of the Hamiltonian are too large beside it", steps = Short(.steps.round()))]
        PhaseTooSlow {
            rate: f64 = "The rate of the phase.",
            steps: f64 = "The number of steps.",
            bound: usize = "The most steps.",
        } => Theory, facts("driven", *rate, *bound);

        /// A state that cannot begin the search for a periodic motion.
        #[error("start = {start:?} must be {variables} finite numbers, the state of the periodic motion at the phase 0 of one driven phase; there are {phases} driven phases")]
        StartUnsupported {
            start: Vec<f64> = "The state.",
            variables: usize = "The number of variables.",
            phases: usize = "The number of driven phases.",
        } => Input, facts("start", format!("{start:?}"), *variables);

        /// The solutions next to a periodic motion grow too much over a period of a driven phase.
        #[error("over the period of the first driven phase, whose rate is {rate:?}, the linear motion grows by more than {bound:e}: floats do not hold its multipliers")]
        GrowthTooLarge {
            rate: f64 = "The rate of the phase.",
            bound: f64 = "The largest growth.",
        } => Theory, facts("driven", *rate, *bound);

        /// The periodic motion of a driven Hamiltonian takes too much work.
        #[error("the periodic motion of the drive takes more than {work:e} multiplications, which are up to 2 s of one core: at {times} times of a period there is no solution yet; units in which the variables are of size 1, fewer harmonics or a weaker drive take less")]
        DrivenWorkTooLarge {
            times: usize = "The times of the last grid.",
            work: f64 = "The most multiplications.",
        } => Theory, facts("driven", *times, *work);

        /// Newton's iteration finds no periodic motion of a driven Hamiltonian.
        #[error("no periodic motion continues the equilibrium: {steps} steps end with a step of {miss:?}; the drive is too strong, or in resonance with a mode")]
        NoPeriodicMotion {
            miss: f64 = "The size of the last step, in units of the variables.",
            steps: usize = "The number of steps.",
        } => Theory, facts("driven", *miss, "convergence");

        /// A state that is beyond the range of a normal form.
        #[error("the state is beyond the range of the series: at a distance of {distance:.3e} from the equilibrium or the periodic motion the transformation there and back misses it by {miss:.3e}, more than 1 %; domain().best_order(amplitude) has the range")]
        BeyondSeries {
            miss: f64 = "How far the transformation there and back ends from the state, in units of the variables.",
            distance: f64 = "The distance of the state from the equilibrium or the periodic motion.",
        } => Theory, facts("state", *distance, "distances at which the order converges");

        /// The motion about a periodic solution has multipliers for which no real periodic frame is built.
        #[error("the multipliers e^(λT) of the periodic motion over the period of the first phase, {multipliers:?} as (re, im), {problem}")]
        MultiplierUnsupported {
            multipliers: Vec<[f64; 2]> = "The multipliers over the period of the first phase, as real and imaginary parts.",
            problem: &'static str = "What they are.",
        } => Theory, facts("driven", format!("{multipliers:?}"), "distinct multipliers on the circle, or positive ones");

        /// The coefficients of a driven Hamiltonian have too many harmonics.
        #[error("with {harmonics} harmonics of a driven phase, the most that are held, the last ones are {rest:?}, above the tolerance {tolerance:?}")]
        GridTooFine {
            harmonics: usize = "The most harmonics of a phase.",
            rest: f64 = "The largest of the last harmonics.",
            tolerance: f64 = "The tolerance.",
        } => Theory, facts("driven", *rest, *tolerance);

        /// The harmonics of several driven phases need too many times together.
        #[error("the harmonics of the driven phases need a grid of {times} times, more than {bound}")]
        GridTooLarge { times: usize = "The product over the phases.", bound: usize = "The most times." } => Theory, facts("driven", *times, *bound);

        /// A force in resonance with a mode: its motion grows without bound.
        #[error("the force {term} is in resonance with a mode: its divisor {divisor:?} is below the bound {bound:?}, and no bounded forced motion exists; give its amplitude as a parameter of degree 1 or more to keep the term as a resonance, or lower the bound")]
        ResonantForce {
            term: String = "The linear term in the complex variables u, U of the pairs.",
            divisor: f64 = "|j n ∓ ω|.",
            bound: f64 = "The bound: the relative smallest divisor times the largest frequency.",
        } => Theory, facts("driven", *divisor, *bound);

        /// A request that no form with driven phases answers.
        #[error("a Hamiltonian with driven phases {problem}")]
        DrivenUnsupported { problem: &'static str = "What is not possible, as the end of a sentence." } => Input, facts("driven", *problem, "no driven phases");

        /// A requested resonance that the frequencies do not satisfy.
        #[error("k = {vector:?} is not a resonance: k·ω = {divisor:?} is not below the bound {bound:?}")]
        NotResonant {
            vector: Vec<i64> = "The vector given.",
            divisor: f64 = "k·ω.",
            bound: f64 = "The bound: the relative smallest divisor times the largest frequency.",
        } => Input, facts("resonances", vector.as_slice(), *bound);

        /// A vector that cannot be a resonance.
        #[error("k = {vector:?} is not a resonance vector: it has one integer of at most {bound} for each degree of freedom and each driven phase, and not all are 0")]
        ResonanceMalformed { vector: Vec<i64> = "The vector given.", bound: u32 = "Largest absolute value of an entry." }
        => Input, facts("resonances", vector.as_slice(), *bound);

        /// A normal form with a resonant term, where a function of the actions alone is required.
        #[error("the normal form is not a function of the actions alone: it contains {term}")]
        ResonantTerm { term: String = "The term in the complex variables." } => Theory, facts(None, term, "a function of the actions alone");

        /// The progress callback stopped the computation.
        #[error("interrupted after order {done} of {of}")]
        Interrupted { done: usize = "Number of orders computed.", of: usize = "Number of orders requested." }
        => Internal, facts("progress", *done, *of);

        /// An order that the packed exponents cannot hold.
        #[error("order {order} exceeds the bound {bound}")]
        OrderTooLarge { order: usize = "The order requested.", bound: usize = "The largest order." }
        => Representation, facts("order", *order, *bound);

        /// An order whose normal form would not fit in memory.
        #[error("order {order} would take some {estimate_gib} GiB of memory: the bound is {bound_gib} GiB", estimate_gib = Short(.estimate_gib.round()))]
        MemoryTooLarge {
            order: usize = "The order asked for.",
            estimate_gib: f64 = "Estimated memory.",
            bound_gib: f64 = "Largest estimate that is accepted.",
        } => Representation, facts("order", *order, format!("{bound_gib} GiB of memory"));

        /// An order outside the computed range.
        #[error("order {order} of the {what} is outside {minimum}..={maximum}")]
        OrderOutOfRange {
            what: &'static str = "The series requested.",
            order: usize = "The order requested.",
            minimum: usize = "The smallest order available.",
            maximum: usize = "The largest order available.",
        }
        => Input, facts(
            if *what == "generating function" { "m" } else { "n" },
            *order,
            Value::Integers(vec![*minimum as i64, *maximum as i64]),
        );

        /// An unknown name.
        #[error("unknown {what} {name:?}; known: {known}")]
        NameUnknown {
            what: &'static str = "The kind of object that the name stands for.",
            name: String = "The name given.",
            known: &'static str = "The known names.",
        } => if *what == "mode" { File } else { Input }, facts(*what, name, *known);

        /// A number outside its interval (NaN is outside every interval).
        #[error("{argument} = {} is outside [{lower}, {upper}]", Short(*.value))]
        OutsideInterval {
            argument: &'static str = "Name of the argument.",
            value: f64 = "Its value.",
            lower: f64 = "Smallest admissible value.",
            upper: f64 = "Largest admissible value.",
        } => Input, facts(*argument, *value, [*lower, *upper]);

        /// A text that is not a polynomial.
        #[error("at byte {position}: {problem}")]
        Parse { position: usize = "Offset of the offending byte.", problem: ParseProblem = "What is wrong there." }
        => problem.kind(), problem.facts(*position);

        /// A text that is not JSON, or JSON of another shape.
        #[error("not the JSON of a normal form: {message} at line {line} column {column}")]
        Json {
            line: usize = "Line of the text, from 1; 0 if the error has no line.",
            column: usize = "Column of the line, from 1.",
            message: String = "What is wrong there.",
        } => File, facts("text", format!("line {line} column {column}"), message);

        /// A JSON document of another format or version.
        #[error("format {format:?} version {version} is unknown: {known_format:?} version {known_version} is read")]
        FormatUnknown {
            format: String = "Name of the format found.",
            version: u64 = "Version found.",
            known_format: &'static str = "The format that is read.",
            known_version: u64 = "The version that is read.",
        } => File, facts("text", format!("{format} version {version}"), format!("{known_format} version {known_version}"));

        /// A rational number that is not in canonical form: `p`, or reduced `p/q` with q > 1.
        #[error("{text:?} is not a reduced rational \"p/q\"")]
        RationalMalformed { text: String = "The text found." } => File, facts("text", text, "a reduced rational \"p/q\"");

        /// A list whose length is not the required one.
        #[error("{what} has {found} entries: it must have {expected}")]
        CountMismatch { what: &'static str = "Name of the list.", found: usize = "Entries found.", expected: usize = "Entries expected." }
        => if argument_of(what).is_none() { File } else { Input }, facts(argument_of(what).unwrap_or("text"), *found, *expected);

        /// A matrix from a file that is not symplectic: Mᵀ J M ≠ J.
        #[error("the linear change is not symplectic: entry ({row}, {column}) of MᵀJM − J is {error:?}")]
        NotSymplectic { row: usize = "Row of MᵀJM − J.", column: usize = "Column of MᵀJM − J.", error: f64 = "The entry." }
        => File, facts("text", *error, 0.0);

        /// A term that a normal form of this kind cannot contain.
        #[error("term {exponents:?} of the {what} of order {order}: {problem}")]
        TermInconsistent {
            what: &'static str = "The series that contains the term.",
            order: usize = "Order in the small parameter.",
            exponents: Vec<u32> = "Exponents (u, U, β), or (β) alone.",
            problem: TermProblem = "The reason.",
        } => File, facts("text", exponents.as_slice(), problem.to_string());

        /// A coefficient from a file that differs from that of the rigid body, or from that of the Hamiltonian in the same file.
        #[error("the {what} of order {order} has the coefficient {found} at the exponents {exponents:?}: it must be {expected}")]
        CoefficientWrong {
            what: &'static str = "The series that contains the coefficient.",
            order: usize = "Order in the small parameter.",
            exponents: Vec<u32> = "Exponents (u, U, β), or (β) alone. For a Birkhoff normal form they are those of its variables; for its linear change, the column.",
            found: String = "The coefficient read, or 0 if the file has none.",
            expected: String = "The coefficient of the normal form, or 0 if there is none.",
        } => File, facts("text", found, expected);
    }
}

#[cfg(feature = "serde")]
impl Error {
    /// The error for a text that is not the expected JSON.
    pub(crate) fn json(error: serde_json::Error) -> Self {
        let (line, column, text) = (error.line(), error.column(), error.to_string());
        let place = format!(" at line {line} column {column}");
        Self::Json { line, column, message: text.strip_suffix(&place).unwrap_or(&text).to_owned() }
    }
}

/// The argument that a message calls `what`. It is `None` for a part of a file or of a result.
fn argument_of(what: &str) -> Option<&str> {
    match what {
        "Hamiltonian" | "quadratic part" => Some("hamiltonian"),
        "state" | "actions" | "parameters" | "times" | "time" | "driven" | "exponents" | "harmonics" => Some(what),
        _ => None,
    }
}
