//! Exact coefficients in machine words: integers of 128 bits over one common denominator.
//!
//! A product of exact polynomials gives such integers, and the next product uses them. Fractions are reduced when the terms are read. Coefficients that do not
//! fit are stored as rationals of big integers.

use num_integer::Integer;

/// Numerators over a common denominator, in the order of the terms.
#[derive(Debug, Clone, PartialEq)]
#[allow(unreachable_pub, reason = "a public trait names it, hidden")]
pub struct Words {
    pub(crate) numerators: Numerators,
    /// The common denominator, greater than 0.
    pub(crate) denominator: i128,
}

/// Real numerators, or complex numerators as (re, im).
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Numerators {
    Real(Vec<i128>),
    Complex(Vec<[i128; 2]>),
}

/// The conversion of a coefficient type to machine words and back.
#[derive(Debug)]
pub struct MachineWords<C> {
    /// The values over their least common denominator, or `None` if they do not fit.
    pub(crate) lift: fn(&[C]) -> Option<Words>,
    /// The reduced values of the words.
    pub(crate) lower: fn(&Words) -> Vec<C>,
}

impl Numerators {
    /// All integers of the numerators.
    fn integers(&mut self) -> &mut [i128] {
        match self {
            Numerators::Real(values) => values,
            Numerators::Complex(values) => values.as_flattened_mut(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Numerators::Real(values) => values.len(),
            Numerators::Complex(values) => values.len(),
        }
    }
}

impl Words {
    /// These words divided by the greatest common divisor of all numerators and the denominator.
    pub(crate) fn reduced(mut self) -> Self {
        let mut shared = self.denominator;
        for &mut numerator in self.numerators.integers() {
            if shared == 1 {
                return self;
            }
            if numerator % shared != 0 {
                shared = shared.gcd(&numerator);
            }
        }
        self.numerators.integers().iter_mut().for_each(|numerator| *numerator /= shared);
        self.denominator /= shared;
        self
    }
}

/// The numerators of several polynomials over one denominator, in 64 bits.
pub(crate) struct Factors {
    pub(crate) lists: Vec<FactorList>,
    pub(crate) denominator: i128,
}

/// The same as [`Numerators`], in 64 bits.
pub(crate) enum FactorList {
    Real(Vec<i64>),
    Complex(Vec<[i64; 2]>),
}

impl Factors {
    pub(crate) fn new(group: &[&Words]) -> Option<Self> {
        let mut denominator = 1_i128;
        for words in group {
            denominator = denominator.checked_mul(words.denominator / denominator.gcd(&words.denominator))?;
        }
        let lists = group.iter().map(|words| {
            let ratio = denominator / words.denominator;
            let narrow = |&numerator: &i128| i64::try_from(numerator.checked_mul(ratio)?).ok();
            Some(match &words.numerators {
                Numerators::Real(values) => FactorList::Real(values.iter().map(narrow).collect::<Option<_>>()?),
                Numerators::Complex(values) => {
                    let pair = |[re, im]: &[i128; 2]| Some([narrow(re)?, narrow(im)?]);
                    FactorList::Complex(values.iter().map(pair).collect::<Option<_>>()?)
                }
            })
        });
        Some(Factors { lists: lists.collect::<Option<_>>()?, denominator })
    }
}

impl FactorList {
    /// Sum and maximum of the magnitudes, rounded upwards. The magnitude of a complex value is |re| + |im|.
    pub(crate) fn norms(&self) -> [f64; 2] {
        let norms = |values: &mut dyn Iterator<Item = u128>| {
            let (sum, most) = values.fold((0_u128, 0), |(sum, most), value| (sum + value, most.max(value)));
            // Rounding changes a value by half a unit of the last place at most.
            [sum as f64, most as f64].map(|norm| norm * (1.0 + f64::EPSILON))
        };
        let magnitude = |value: i64| u128::from(value.unsigned_abs());
        match self {
            FactorList::Real(values) => norms(&mut values.iter().map(|&value| magnitude(value))),
            FactorList::Complex(values) => norms(&mut values.iter().map(|&[re, im]| magnitude(re) + magnitude(im))),
        }
    }
}
