//! The text of the file in each language: head, constants, kernel.

use super::CodeLanguage;
use super::constants::Constants;

/// How a language writes lists of numbers.
struct Brackets {
    open: char,
    close: char,
    /// What follows the last entry: a tuple of one needs it.
    last: &'static str,
}

const BRACES: Brackets = Brackets { open: '{', close: '}', last: "" };
const SQUARE: Brackets = Brackets { open: '[', close: ']', last: "" };
const ROUND: Brackets = Brackets { open: '(', close: ')', last: "," };

/// The file as text.
pub(super) fn print(language: CodeLanguage, head: &[String], constants: &Constants) -> String {
    match language {
        CodeLanguage::C => c(head, constants),
        CodeLanguage::Rust => rust(head, constants),
        CodeLanguage::Python => python(head, constants),
        CodeLanguage::JavaScript => javascript(head, constants),
    }
}

fn c(head: &[String], constants: &Constants) -> String {
    let sums = if constants.powers { include_str!("kernel/powers.c") } else { include_str!("kernel/harmonics.c") };
    let list = |numbers: &[f64]| list(&BRACES, numbers);
    let phase = |[f, g, h, s, t]: [f64; 5]| format!("{{{}, {}}}", list(&[f, g, h]), list(&[s, t]));
    let mut text = commented("/*\n", " * ", " */\n", head);
    text += "\n#include <math.h>\n\n#ifdef __FAST_MATH__\n#error \"rounding errors are computed here: compile without -ffast-math\"\n#endif\n\n";
    text += "/* Attitude and angular velocity at a time: 1, or 0 beyond the bound, where nothing is written. */\n";
    text += "int rotation(double time, double attitude[4], double angular_velocity[3]);\n";
    text += include_str!("kernel/kernel.c");
    text += &format!("\nstatic const double epoch = {:?};\n", constants.epoch);
    text += &format!("/* Largest distance from the epoch. */\nstatic const double bound = {:?};\n", constants.bound);
    text += "/* l' and y'/2. */\n";
    text += &format!("static const struct phase anomaly = {};\n", phase(constants.anomaly));
    text += &format!("static const struct phase half_longitude = {};\n", phase(constants.half_longitude));
    text += "/* Coefficients of Re a, Im a, Re b and Im b. */\n";
    text += &format!("static const double terms[][4] = {};\n", table(&BRACES, &constants.terms));
    text += "/* Rows x, y, z, w; columns Re b, Im b, Im a, Re a. */\n";
    text += &format!("static const double attitude_map[4][4] = {};\n", table(&BRACES, &constants.attitude));
    text += "/* Angular velocity of each component of the unit angular momentum. */\n";
    text += &format!("static const double rates[3][3] = {};\n", table(&BRACES, &constants.rates));
    text + sums + include_str!("kernel/evaluate.c")
}

fn rust(head: &[String], constants: &Constants) -> String {
    let sums = if constants.powers { include_str!("kernel/powers.rs") } else { include_str!("kernel/harmonics.rs") };
    let list = |numbers: &[f64]| list(&SQUARE, numbers);
    let phase =
        |[f, g, h, s, t]: [f64; 5]| format!("Phase {{ frequency: {}, start: {} }}", list(&[f, g, h]), list(&[s, t]));
    // No inner doc comment: the file can be a module, or be included in one. It needs `core` alone.
    let mut text = commented("", "// ", "", head);
    text += "\nconst MOTION: Motion<'static> = Motion {\n";
    text += &format!("    epoch: {:?},\n    bound: {:?},\n", constants.epoch, constants.bound);
    text += &format!("    anomaly: {},\n", phase(constants.anomaly));
    text += &format!("    half_longitude: {},\n", phase(constants.half_longitude));
    text += &format!("    terms: &{},\n", table(&SQUARE, &constants.terms));
    text += &format!("    attitude: {},\n", table(&SQUARE, &constants.attitude));
    text += &format!("    rates: {},\n}};\n\n", table(&SQUARE, &constants.rates));
    text += "/// Attitude [x, y, z, w] and angular velocity in body components at a time; `None` beyond the bound.\n";
    text +=
        "#[must_use]\npub fn rotation(time: f64) -> Option<([f64; 4], [f64; 3])> {\n    evaluate(&MOTION, time)\n}\n\n";
    text + include_str!("kernel/kernel.rs") + sums
}

fn python(head: &[String], constants: &Constants) -> String {
    let sums = if constants.powers { include_str!("kernel/powers.py") } else { include_str!("kernel/harmonics.py") };
    let mut text = commented("\"\"\"", "", "\"\"\"\n", head);
    text += "\nimport math\n\n";
    text += &format!("EPOCH, BOUND = {:?}, {:?}\n", constants.epoch, constants.bound);
    text += "# Turns per unit of time as three doubles, the first two of 27 bits at most; turns at the epoch as two.\n";
    text += &format!("ANOMALY = {}\n", list(&ROUND, &constants.anomaly));
    text += &format!("HALF_LONGITUDE = {}\n", list(&ROUND, &constants.half_longitude));
    text += "# Coefficients of Re a, Im a, Re b and Im b.\n";
    text += &format!("TERMS = {}\n", table(&ROUND, &constants.terms));
    text += "# Rows x, y, z, w; columns Re b, Im b, Im a, Re a.\n";
    text += &format!("ATTITUDE = {}\n", table(&ROUND, &constants.attitude));
    text += "# Angular velocity of each component of the unit angular momentum.\n";
    text += &format!("RATES = {}\n", table(&ROUND, &constants.rates));
    text + include_str!("kernel/kernel.py") + sums
}

fn javascript(head: &[String], constants: &Constants) -> String {
    let sums = if constants.powers { include_str!("kernel/powers.js") } else { include_str!("kernel/harmonics.js") };
    let mut text = commented("", "// ", "", head);
    text += &format!("\nconst EPOCH = {:?}, BOUND = {:?};\n", constants.epoch, constants.bound);
    text +=
        "// Turns per unit of time as three doubles, the first two of 27 bits at most; turns at the epoch as two.\n";
    text += &format!("const ANOMALY = {};\n", list(&SQUARE, &constants.anomaly));
    text += &format!("const HALF_LONGITUDE = {};\n", list(&SQUARE, &constants.half_longitude));
    text += "// Coefficients of Re a, Im a, Re b and Im b.\n";
    text += &format!("const TERMS = {};\n", table(&SQUARE, &constants.terms));
    text += "// Rows x, y, z, w; columns Re b, Im b, Im a, Re a.\n";
    text += &format!("const ATTITUDE = {};\n", table(&SQUARE, &constants.attitude));
    text += "// Angular velocity of each component of the unit angular momentum.\n";
    text += &format!("const RATES = {};\n", table(&SQUARE, &constants.rates));
    text + include_str!("kernel/kernel.js")
        + sums
        + "\nif (typeof module !== \"undefined\") module.exports = { rotation };\n"
}

fn commented(open: &str, each: &str, close: &str, head: &[String]) -> String {
    let lines: Vec<String> = head.iter().map(|line| format!("{each}{line}").trim_end().to_owned() + "\n").collect();
    format!("{open}{}{close}", lines.concat())
}

/// Numbers with the fewest digits that are read back to the same bits.
fn list(brackets: &Brackets, numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
    format!("{}{}{}", brackets.open, numbers.join(", "), brackets.close)
}

/// One row a line.
fn table<const N: usize>(brackets: &Brackets, rows: &[[f64; N]]) -> String {
    let rows: Vec<String> = rows.iter().map(|row| format!("    {}", list(brackets, row))).collect();
    let last = if rows.len() == 1 { brackets.last } else { "" };
    format!("{}\n{}{last}\n{}", brackets.open, rows.join(",\n"), brackets.close)
}
