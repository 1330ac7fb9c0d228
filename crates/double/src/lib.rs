//! Double-double arithmetic, and two functions for `f64` and double-double: the arithmetic-geometric mean and Carlson's R_F.
//!
//! With u = 2^−53, the relative error of one operation on double-doubles is at most:
//!
//! ```text
//! operation                      bound     source
//! two_sum, two_product           exact     Knuth, TAOCP 2, §4.2.2; fused multiply-add
//! a + b, a − b                   3 u²      Joldes, Muller, Popescu (2017), Algorithm 6
//! a · b                          5 u²      Muller, Rideau (2022) for Algorithm 10
//! a.times_double(x)              3 u²      Joldes, Muller, Popescu (2017), Algorithm 8
//! a.over(x)                      3 u²      Joldes, Muller, Popescu (2017), Algorithm 15
//! a / b                         10 u²      three steps of long division; measured
//! a.sqrt()                       4 u²      Lefèvre et al. (2023); measured
//! ```
//!
//! The bounds hold if no operand, result or product of parts overflows or is subnormal. tests/bounds.rs checks each line against exact arithmetic.
//!
//! The crate has no state and does no I/O. No operation checks for overflow: the caller scales the numbers.

mod carlson;
mod double_double;
mod mean;
mod real;

pub use carlson::carlson_rf;
pub use double_double::{DoubleDouble, two_product, two_sum};
pub use mean::arithmetic_geometric_mean;
pub use real::Real;

/// The README, whose example is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
