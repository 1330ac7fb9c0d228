//! Exact polynomial algebra for perturbation theory, and the normal form of the free rigid body.
//!
//! The algebra: [`Polynomial`]s in up to eight variables over any [`Coefficient`], their [`Poisson`] bracket, the [`Homological`] equation
//! of a diagonal quadratic part and Deprit's triangle ([`deprit_triangle`], [`LieTransform`]), to any order. Any Hamiltonian about an
//! equilibrium: [`normalize`] gives its [`BirkhoffNormalForm`], [`BirkhoffMap`] evaluates it. The rigid body: [`NormalForm`],
//! exact and symbolic in the triaxiality β. [`NumericNormalForm`] is the same in floating point at a given β, for the propagation.
//!
//! Contract: what is exact stays exact; overflow of an exponent is an error; iteration, printing and summation follow the canonical
//! order of the monomials, so that two runs give the same bits; no I/O, no global state, and every type is `Send + Sync`.
//! Brackets follow {q; p} = 1. Theory: M. Lara, *Short-axis-mode rotation in complex variables* (2017), with its errata.
//!
#![doc = include_str!("../doc/formulas.html")]

mod birkhoff;
mod bracket;
mod calculus;
mod coefficient;
mod display;
mod emit;
mod energy;
pub mod error;
mod forms;
mod homological;
mod json;
mod latex;
mod monomial;
mod normal_form;
mod numeric;
mod parse;
mod polynomial;
mod product;
mod real_field;
mod rigid_body;
mod ring;
mod terms;
mod triangle;
mod words;

pub use birkhoff::{BirkhoffMap, BirkhoffNormalForm, Domain, Mode, PhaseSpace, Resonances, normalize, normalize_with};
pub use bracket::Poisson;
pub use coefficient::Coefficient;
pub use display::Named;
pub use emit::{Language, MAXIMUM_CODE_ORDER};
pub use error::{Error, ParseProblem, TermProblem};
pub use forms::{Form, Real};
pub use homological::Homological;
pub use latex::Part;
pub use monomial::{MAXIMUM_EXPONENT, Monomial, SLOTS};
pub use normal_form::{MAXIMUM_MEMORY, NormalForm};
pub use numeric::NumericNormalForm;
pub use polynomial::{Polynomial, Truncation};
pub use real_field::RealField;
pub use rigid_body::{
    BETA, MAXIMUM_ORDER, PublicForm, TAU, Variable, W, W_BAR, Y_HAT, hamiltonian, homological, poisson,
    separatrix_action,
};
pub use triangle::{LieTransform, Normalization, Progress, deprit_triangle, quiet};

/// Complex numbers over any of the coefficients, from the crate `num-complex`.
pub use num_complex::Complex;
/// Exact rational numbers, from the crate `num-rational`.
pub use num_rational::BigRational;

/// The README, whose examples are compiled and run as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
