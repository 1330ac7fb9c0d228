//! The tests of the algebra, in one program: each generic function is compiled once.

mod autotrait;
mod birkhoff;
mod birkhoff_kept;
mod birkhoff_motion;
mod birkhoff_range;
mod birkhoff_refusals;
mod bracket;
mod calculus;
mod driven;
mod energy;
mod equilibria;
mod exact_spectrum;
mod hamiltonians;
mod homological;
mod json;
mod latex;
mod monomial;
mod parse;
mod periodic;
mod prime_field;
mod product;
mod rigid_body;
mod ring;
mod strategies;
mod symplectic_change;
mod triangle;
