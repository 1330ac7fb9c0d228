//! Exact polynomial algebra for perturbation theory, and the normal form of the free rigid body.
//!
//! The algebra: [`Polynomial`]s in up to eight variables over any [`Coefficient`], their Poisson bracket, the homological equation of a diagonal quadratic part
//! and Deprit's triangle ([`lie`]), to any order. [`normalize`] computes the [`BirkhoffNormalForm`] of any Hamiltonian about an equilibrium, and
//! [`BirkhoffMap`] evaluates it. [`NormalForm`] is the normal form of the free rigid body, exact and symbolic in the triaxiality β. [`NumericNormalForm`] is
//! the same in floating point at a given β, for the propagation.
//!
//! Contract: exact input gives exact results. Overflow of an exponent is an error. Iteration, printing and summation follow the canonical order of the
//! monomials, so two runs give the same bits. The crate does no I/O and has no global state except its [`threads`], and every type is `Send + Sync`. Brackets follow {q; p} = 1.
//! Theory: M. Lara, *Short-axis-mode rotation in complex variables* (2017), with its errata.
//!
//! The features are on by default: `birkhoff` has the normal forms of any Hamiltonian, `rayon` computes large products on several threads, `serde` has normal forms as JSON texts, `code` has
//! them as source text.
#![doc = include_str!("../doc/formulas.html")]
// What only normal forms of any Hamiltonian, JSON and source texts use is dead without them.
#![cfg_attr(not(all(feature = "birkhoff", feature = "serde", feature = "code")), allow(dead_code))]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "birkhoff")]
pub mod birkhoff;
mod bracket;
mod calculus;
mod coefficient;
mod display;
#[cfg(feature = "serde")]
mod document;
mod driven;
#[cfg(feature = "code")]
mod emit;
mod energy;
pub mod error;
pub mod forms;
mod harmonics;
mod homological;
#[cfg(feature = "serde")]
mod json;
mod latex;
mod monomial;
mod normal_form;
mod numeric;
mod parse;
#[cfg(feature = "birkhoff")]
pub mod periodic;
mod polynomial;
mod product;
pub mod real_field;
pub mod rigid_body;
mod ring;
#[cfg(feature = "code")]
mod short_axis_code;
mod terms;
pub mod threads;
mod triangle;
mod words;

#[cfg(feature = "birkhoff")]
pub use birkhoff::{BirkhoffMap, BirkhoffNormalForm, PhaseSpace, normalize, normalize_driven, normalize_with};
pub use coefficient::Coefficient;
pub use error::Error;
pub use monomial::{MAX_EXPONENT, Monomial, SLOTS};
pub use normal_form::{MAX_MEMORY, NormalForm};
pub use numeric::NumericNormalForm;
pub use polynomial::{Polynomial, Truncation};

pub mod lie {
    //! Lie transforms: the bracket, the homological equation, Deprit's triangle.
    pub use crate::bracket::Poisson;
    pub use crate::driven::Driven;
    pub use crate::homological::Homological;
    pub use crate::triangle::{LieTransform, Normalization, deprit_triangle};
}

pub mod print {
    //! Output of normal forms: names of the variables, LaTeX, source code.
    pub use crate::display::Named;
    #[cfg(feature = "code")]
    pub use crate::emit::{C, Constant, JavaScript, Language, Numbers, Printer, Python, Rust};
    pub use crate::latex::Part;
    #[cfg(feature = "code")]
    pub use crate::short_axis_code::MAX_CODE_ORDER;
}

pub mod progress {
    //! Callbacks that watch a long computation and can stop it.
    pub use crate::triangle::{Progress, quiet};
}

pub use {num_complex, num_rational};

/// The README, whose examples are compiled and run as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
