//! The text of the file in each language: head, constants, kernel.

use andoyer_series::print::{C, JavaScript, Printer, Python, Rust};

use super::constants::Constants;
use super::language::CodeLanguage;

/// The parts of a file that are the same for all motions.
struct Kernel {
    printer: &'static dyn Printer,
    /// What stands before the constants.
    opening: &'static str,
    kernel: &'static str,
    /// The sums of theory §8 by powers of cos 2ℓ′.
    powers: &'static str,
    /// The same sums by harmonics.
    harmonics: &'static str,
    /// What needs the sums.
    closing: &'static str,
}

const C_KERNEL: Kernel = Kernel {
    printer: &C,
    opening: include_str!("kernel/opening.c"),
    kernel: include_str!("kernel/kernel.c"),
    powers: include_str!("kernel/powers.c"),
    harmonics: include_str!("kernel/harmonics.c"),
    closing: include_str!("kernel/evaluate.c"),
};

const RUST_KERNEL: Kernel = Kernel {
    printer: &Rust,
    opening: "\n",
    kernel: include_str!("kernel/kernel.rs"),
    powers: include_str!("kernel/powers.rs"),
    harmonics: include_str!("kernel/harmonics.rs"),
    closing: include_str!("kernel/rotation.rs"),
};

const PYTHON_KERNEL: Kernel = Kernel {
    printer: &Python,
    opening: "\nimport math\n\n",
    kernel: include_str!("kernel/kernel.py"),
    powers: include_str!("kernel/powers.py"),
    harmonics: include_str!("kernel/harmonics.py"),
    closing: "",
};

const JAVASCRIPT_KERNEL: Kernel = Kernel {
    printer: &JavaScript,
    opening: "\n",
    kernel: include_str!("kernel/kernel.js"),
    powers: include_str!("kernel/powers.js"),
    harmonics: include_str!("kernel/harmonics.js"),
    closing: include_str!("kernel/export.js"),
};

/// The file as text.
pub(super) fn print(language: CodeLanguage, head: &[String], constants: &Constants) -> String {
    let Kernel { printer, opening, kernel, powers, harmonics, closing } = match language {
        CodeLanguage::C => C_KERNEL,
        CodeLanguage::Rust => RUST_KERNEL,
        CodeLanguage::Python => PYTHON_KERNEL,
        CodeLanguage::JavaScript => JAVASCRIPT_KERNEL,
    };
    let sums = if constants.powers { powers } else { harmonics };
    let numbers: String = constants.listed().iter().map(|constant| printer.constant(constant)).collect();
    [&printer.head(head), opening, &numbers, kernel, sums, closing].concat()
}
