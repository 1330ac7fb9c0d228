//! A table of the Moon's orientation as a source file: angles of the principal axes from 26 and 34 terms, in C, Rust, Python or JavaScript.
//!
//! ```sh
//! cargo run --release -p andoyer-series --example moon_table -- c < docs/data/nature-moon-terms.csv > docs/data/moon_orientation.c
//! ```
//!
//! The rows are those of `tests/nature/moon_terms.py`. The constants have the digits of the table, in arcseconds; the kernel beside this file adds them up.

use std::io::{Error, Read, Write, stdin, stdout};

use andoyer_series::print::{C, Constant, JavaScript, Numbers, Printer, Python, Rust};

const HEAD: [&str; 11] = [
    "The orientation of the Moon as a table of 60 terms, within LARGEST_DIFFERENCE arcseconds of the",
    "orientation of the ephemeris DE421 over 1950 to 2050. Beyond these years the error grows.",
    "",
    "moon_orientation(time): time in seconds of TDB past J2000 (2000-01-01 12:00 TDB); the result is",
    "phi, theta, psi in radians. They turn the axes of the ICRF into the principal axes of the Moon",
    "of DE421 (MOON_PA_DE421): first by phi about axis 3, then by theta about axis 1, then by psi",
    "about axis 3. A vector with components v in the ICRF has R3(psi) R1(theta) R3(phi) v in these axes,",
    "R1 and R3 turning the frame: R3(a) = [[cos a, sin a, 0], [-sin a, cos a, 0], [0, 0, 1]].",
    "",
    "The terms are for the pole of the ecliptic of date in the axes of the Moon (x, y) and the longitude.",
    "Compile without options that change the order of sums.",
];

/// What a term has, in the order of the columns of its constant.
const POLE: &str = "Rate in rad/s; amplitudes of its sine in x and y, of its cosine in x and y, in arcseconds.";
const LONGITUDE: &str = "Rate in rad/s; amplitudes of its sine and its cosine, in arcseconds.";

/// The constants, and the largest difference after the last term.
struct Table {
    constants: [Constant; 4],
    left: String,
}

/// The numbers of a row, without its dashes.
fn numbers(cells: &[&str]) -> Result<Vec<f64>, Error> {
    cells
        .iter()
        .filter(|cell| **cell != "–")
        .map(|cell| cell.parse().map_err(|_| Error::other(format!("no number: {cell}"))))
        .collect()
}

fn table(text: &str) -> Result<Table, Error> {
    let [mut pole, mut pole_polynomial, mut longitude] = [const { Vec::new() }; 3];
    let mut longitude_polynomial = Vec::new();
    let mut left = "";
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let &[angle, _period, rate, _, _, _, _, after] = cells.as_slice() else {
            return Err(Error::other(format!("eight columns are needed: {line}")));
        };
        let amplitudes = numbers(&cells[3..7])?;
        let row = match rate.strip_prefix("t^") {
            Some(_) => amplitudes,
            None => [numbers(&[rate])?, amplitudes].concat(),
        };
        match (angle, rate.starts_with("t^")) {
            ("pole", true) => pole_polynomial.push(row),
            ("pole", false) => pole.push(row),
            (_, true) => longitude_polynomial.extend(row),
            (_, false) => longitude.push(row),
        }
        left = after;
    }
    let constants = [
        Constant {
            name: "POLE_POLYNOMIAL",
            comment: "x and y in arcseconds, by power of Julian centuries.",
            value: Numbers::Rows(pole_polynomial),
        },
        Constant { name: "POLE", comment: POLE, value: Numbers::Rows(pole) },
        Constant {
            name: "LONGITUDE_POLYNOMIAL",
            comment: "In arcseconds, by power of Julian centuries.",
            value: Numbers::List(longitude_polynomial),
        },
        Constant { name: "LONGITUDE", comment: LONGITUDE, value: Numbers::Rows(longitude) },
    ];
    Ok(Table { constants, left: left.to_owned() })
}

fn main() -> Result<(), Error> {
    let language = std::env::args().nth(1).unwrap_or_default();
    let (printer, opening, kernel): (&dyn Printer, _, _) = match language.as_str() {
        "c" => (&C, "\n#include <math.h>\n\n", include_str!("kernel.c")),
        "rust" => (&Rust, "\n", include_str!("kernel.rs")),
        "python" => (&Python, "\nimport math\n\n", include_str!("kernel.py")),
        "javascript" => (&JavaScript, "\n", include_str!("kernel.js")),
        _ => return Err(Error::other("language: c, rust, python or javascript")),
    };
    let mut text = String::new();
    stdin().read_to_string(&mut text)?;
    let Table { constants, left } = table(&text)?;
    let head = HEAD.map(|line| line.replace("LARGEST_DIFFERENCE", &left));
    let written: String = constants.iter().map(|constant| printer.constant(constant)).collect();
    stdout().write_all([&printer.head(&head), opening, &written, kernel].concat().as_bytes())
}
