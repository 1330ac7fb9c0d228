//! Evaluation at several times at once with the best instruction set available. The folder has lanes, instruction sets, sines and cosines, complex numbers,
//! their powers and quaternions in lanes, double-doubles, the arithmetic-geometric mean and Carlson's R_F in lanes, phases in lanes, the
//! table of a uniform grid, and the loop over times for any type of motion.

pub(crate) mod circles;
pub(crate) mod complex_quaternion;
pub(crate) mod double_double_lanes;
pub(crate) mod elliptic;
pub(crate) mod grid;
pub(crate) mod halt;
pub(crate) mod instruction_set;
pub(crate) mod lanes;
pub(crate) mod outputs;
pub(crate) mod phase;
pub(crate) mod run;
pub(crate) mod sincos;
pub(crate) mod unit_powers;
