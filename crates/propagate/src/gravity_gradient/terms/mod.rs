//! The terms e^(i(hℓ′+my′)) of the torque: size, frequency, divisors in the harmonics of the orbit, and regime.

pub(crate) mod divisors;
pub(crate) mod regime;
pub(crate) mod term;
