//! A solved motion: its trajectory (the formulas that evaluate it), plan, evaluation at times, Andoyer variables and energy.

mod andoyer;
pub(crate) mod batch;
mod energy;
pub(crate) mod forced;
pub(crate) mod plan;
pub(crate) mod solved;
pub(crate) mod trajectory;
pub(crate) mod verification_cost;
