//! Every public type is `Send + Sync`, and errors read as one line with their figures.

use andoyer_series::birkhoff::Resonances;
use andoyer_series::forms::Form;
use andoyer_series::lie::{Homological, LieTransform, Normalization, Poisson};
use andoyer_series::rigid_body::separatrix_action;
use andoyer_series::{
    BirkhoffMap, BirkhoffNormalForm, Error, Monomial, NormalForm, PhaseSpace, Polynomial, Truncation,
};
use num_rational::BigRational;

const fn assert_shareable<T: Send + Sync>() {}

#[test]
fn public_types_are_send_and_sync() {
    assert_shareable::<(Monomial, Poisson, Truncation, Error)>();
    assert_shareable::<(Polynomial<BigRational>, Homological<BigRational>, Polynomial<f64>)>();
    assert_shareable::<(BirkhoffNormalForm<BigRational>, BirkhoffNormalForm<f64>, BirkhoffMap, PhaseSpace, Resonances)>(
    );
    assert_shareable::<(LieTransform<BigRational>, Normalization<BigRational>, NormalForm, Form)>();
}

#[test]
fn messages_give_the_argument_its_value_and_the_bound() {
    let message = |error: Option<Error>| error.map(|error| error.to_string());
    assert_eq!(message(separatrix_action(1.5).err()), Some("beta = 1.5 is outside [0, 1]".into()));
    assert_eq!(message(NormalForm::new(20_000).err()), Some("order 20000 exceeds the bound 16381".into()));
    let parsed = Polynomial::<f64>::parse("x +", &["x"]);
    assert_eq!(
        message(parsed.err()),
        Some("at byte 3: the text ends where an operand or a bracket is required".into())
    );
}
