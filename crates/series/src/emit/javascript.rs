//! Prints JavaScript.

use super::constant::Numbers;
use super::printer::{Printer, marked};

/// JavaScript of 2015 or later.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct JavaScript;

impl Printer for JavaScript {
    fn head(&self, lines: &[String]) -> String {
        marked(lines, "// ")
    }

    fn comment(&self, text: &str) -> String {
        format!("// {text}")
    }

    fn declaration(&self, name: &str, value: &Numbers) -> String {
        format!("const {name} = {};", value.text(['[', ']'], ""))
    }
}
