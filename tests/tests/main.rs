//! The truths of the whole project, in one program: each generic function is compiled and linked once.

mod bad_input;
mod emitted_code;
mod ensemble;
mod errata;
mod gradient_bounds;
mod gradient_limits;
mod gradient_rates;
mod gradient_symmetry;
mod gravity_gradient;
mod invariants;
mod limits;
mod motion_code;
mod numeric;
mod observed;
mod oracle;
mod orders;
mod partials;
mod plans;
mod printed_equations;
mod scene_files;
mod second_order;
mod separatrix;
mod stop;
mod threads;
mod torque_free;
mod user_axes;
