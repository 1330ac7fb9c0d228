//! The excerpts of tests/data/kernels, with the values that CSPICE reads in them (tests/reference/make_kernels.py).

use std::io::Cursor;

use andoyer_kernels::{Ephemeris, Orientations, ReadError};

/// A kernel in memory.
pub(crate) struct Excerpt {
    pub(crate) name: &'static str,
    pub(crate) bytes: &'static [u8],
}

macro_rules! excerpt {
    ($name:literal) => {
        Excerpt { name: $name, bytes: include_bytes!(concat!("../../../../tests/data/kernels/", $name)) }
    };
}

pub(crate) const MONTH: Excerpt = excerpt!("month.bsp");
pub(crate) const STATES: Excerpt = excerpt!("states.bsp");
pub(crate) const MOON: Excerpt = excerpt!("month.bpc");
pub(crate) const ALL: [Excerpt; 3] = [MONTH, STATES, MOON];

/// A line of values.csv. The observer of an orientation is `None`.
pub(crate) struct Line {
    pub(crate) target: i32,
    pub(crate) observer: Option<i32>,
    pub(crate) et: f64,
    pub(crate) values: [f64; 6],
}

/// The lines of a file.
pub(crate) fn lines(name: &str) -> Vec<Line> {
    let number = |text: &str| text.parse::<f64>().expect("a number");
    include_str!("../../../../tests/data/kernels/values.csv")
        .lines()
        .filter(|line| line.starts_with(name))
        .map(|line| {
            let parts: Vec<&str> = line.split(',').collect();
            Line {
                target: parts[1].parse().expect("a body"),
                observer: parts[2].parse().ok(),
                et: number(parts[3]),
                values: std::array::from_fn(|k| number(parts[4 + k])),
            }
        })
        .collect()
}

/// A kernel of either kind.
pub(crate) enum Kernel {
    Ephemeris(Ephemeris),
    Orientations(Orientations),
}

impl Kernel {
    /// Opens bytes as the kind of this name.
    pub(crate) fn open(name: &str, bytes: Vec<u8>) -> Result<Self, ReadError> {
        if name.ends_with(".bpc") {
            let mut kernel = Orientations::open::<&str>(&[])?;
            kernel.load(name, Cursor::new(bytes)).map(|()| Self::Orientations(kernel))
        } else {
            let mut kernel = Ephemeris::open::<&str>(&[])?;
            kernel.load(name, Cursor::new(bytes)).map(|()| Self::Ephemeris(kernel))
        }
    }

    /// The values of a line.
    pub(crate) fn read(&self, line: &Line) -> Result<[f64; 6], ReadError> {
        let (one, other) = match self {
            Self::Ephemeris(kernel) => kernel.state(line.target, line.observer.expect("an observer"), line.et),
            Self::Orientations(kernel) => kernel.angles(line.target, line.et),
        }?;
        Ok(std::array::from_fn(|k| if k < 3 { one[k] } else { other[k - 3] }))
    }
}
