//! Named numbers of a file.

/// A constant of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// Its name, the same in every language.
    pub name: &'static str,
    /// A line of comment in ASCII, or nothing.
    pub comment: &'static str,
    /// Its value.
    pub value: Numbers,
}

/// The value of a constant.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// A number.
    One(f64),
    /// An array.
    List(Vec<f64>),
    /// An array of arrays of the same length.
    Rows(Vec<Vec<f64>>),
}

impl Numbers {
    /// The lengths of the array, outermost first.
    pub(super) fn lengths(&self) -> Vec<usize> {
        match self {
            Self::One(_) => Vec::new(),
            Self::List(list) => vec![list.len()],
            Self::Rows(rows) => vec![rows.len(), rows.first().map_or(0, Vec::len)],
        }
    }

    /// The value between brackets, one row a line. `last` follows the only entry of an array of one.
    pub(super) fn text(&self, [open, close]: [char; 2], last: &str) -> String {
        let last = |length: usize| if length == 1 { last } else { "" };
        let list = |list: &[f64]| {
            let numbers: Vec<String> = list.iter().map(|number| format!("{number:?}")).collect();
            format!("{open}{}{}{close}", numbers.join(", "), last(list.len()))
        };
        match self {
            Self::One(number) => format!("{number:?}"),
            Self::List(numbers) => list(numbers),
            Self::Rows(rows) => {
                let lines: Vec<String> = rows.iter().map(|row| format!("    {}", list(row))).collect();
                format!("{open}\n{}{}\n{close}", lines.join(",\n"), last(rows.len()))
            }
        }
    }
}
