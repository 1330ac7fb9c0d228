//! What is no equilibrium with a quadratic part that can be diagonalized, and what no order can normalize, is refused by name.

use andoyer_series::birkhoff::Resonances;
use andoyer_series::error::{Kind, Value};
use andoyer_series::progress::quiet;
use andoyer_series::{BirkhoffMap, Error, Monomial, PhaseSpace, Polynomial, SLOTS, normalize, normalize_with};
use num_rational::BigRational;
use std::ops::ControlFlow;

fn refused(text: &str, order: usize) -> Option<Error> {
    let run = || {
        let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?.with_parameters(&["c"])?;
        normalize(&space.parse::<BigRational>(text)?, order, &space)
    };
    run().err()
}

#[track_caller]
fn assert_message(text: &str, message: &str) {
    assert_eq!(refused(text, 2).map(|error| error.to_string()).as_deref(), Some(message), "{text}");
}

#[test]
fn a_point_without_a_diagonal_form_is_refused_by_term() {
    assert_message(
        "x^2 + X^2 + y^2 + Y^2 - 3/2*Y",
        "the origin is not an equilibrium: the linear term Y has the coefficient -3/2",
    );
    assert_message(
        "x^2 + X^2 + y^2 + Y^2 + c*y",
        "the origin is not an equilibrium: the linear term y*c has the coefficient 1",
    );
    for (text, direction) in
        [("Y^2", "y 1.000"), ("0", "y 1.000"), ("y^2/2", "Y 1.000"), ("(y + Y)^2", "y 1.000, Y 1.000")]
    {
        let message = format!(
            "the quadratic part in (y, Y) has a zero frequency, along the direction with the components {direction}: no normal form of this kind exists there"
        );
        assert_message(&format!("x^2 + X^2 + {text}"), &message);
    }
    assert_message(
        "x^2 + X^2 + Y^2/2 + c^2*y^2/2",
        "the quadratic part in (y, Y) has a zero frequency where its parameters are 0, in the term 1/2*y^2*c^2: write the parameter as a number and a detuning, w = w0 + d, or scale q -> q/sqrt(w), p -> p sqrt(w), t -> t/w, so that the frequency is a number (PhaseSpace::scaled; in Python the argument frequency)",
    );
    assert_message(
        "x*X + y*Y + x*Y",
        "the quadratic part in (x, X), (y, Y) cannot be diagonalized: the eigenvalues ±1.000000000 have a Jordan block, with the eigenvector of components y 1.000",
    );
    assert_message(
        "x^2 + X^2 + y^2 + Y^2 + x*y",
        "the eigenvalues ±2.449489743i of the quadratic part in (x, X), (y, Y) are not rational: use floats, or, if all frequencies are rational multiples of one root, write a parameter w for the root and scale w away (PhaseSpace::scaled; in Python the argument frequency)",
    );
    assert_message(
        "x^2 + X^2 + y^2 + Y^2/2",
        "the frequency of the mode (y, Y) is the square root of 2, which is not rational: use floats, or, if all frequencies are rational multiples of this root, write w^2 for 2 with a parameter w and scale w away (PhaseSpace::scaled; in Python the argument frequency)",
    );
}

#[test]
fn a_resonance_not_asked_for_is_refused_by_its_monomial() {
    let henon_heiles = "(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3";
    match refused(henon_heiles, 6) {
        Some(Error::SmallDivisor { order: 2, term, k, divisor: 0.0, bound }) => {
            assert_eq!((term.as_str(), k, bound), ("u_x^2*U_y^2", vec![-2, 2], 1e-6));
        }
        other => panic!("{other:?}"),
    }
    assert!(refused(henon_heiles, 1).is_none());
    // A divisor that is small but not zero: k = (2, −1), |2·1 − 2.000001| = 1e-6 < 2e-6.
    let near = "(x^2 + X^2)/2 + 1.0000005*(y^2 + Y^2) + x^2*y";
    match refused(near, 1) {
        Some(Error::SmallDivisor { order: 1, k, divisor, bound, .. }) => {
            assert!(k == [-2, 1] && (divisor - 1e-6).abs() < 1e-15 && (bound - 2.000_001e-6).abs() < 1e-15);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn resonances_that_are_none_are_refused() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?;
    let h = space.parse::<f64>("(x^2 + X^2)/2 + y^2 + Y^2 + x^2*y")?;
    let run = |resonances: &Resonances| normalize_with(&h, 2, &space, resonances, &mut quiet).map(drop);
    assert!(run(&Resonances::new(&[&[2, -1]])?).is_ok());
    let wrong = run(&Resonances::new(&[&[1, -1]])?);
    assert!(matches!(wrong, Err(Error::NotResonant { vector, divisor: -1.0, .. }) if vector == [1, -1]));
    assert!(matches!(run(&Resonances::new(&[&[2, -1, 0]])?), Err(Error::ResonanceMalformed { .. })));
    for vectors in [&[&[0, 0][..]][..], &[&[1, -1], &[1]], &[&[32_768, 1]], &[&[]]] {
        assert!(
            matches!(Resonances::new(vectors), Err(Error::ResonanceMalformed { bound: 32_767, .. })),
            "{vectors:?}"
        );
    }
    for divisor in [-1.0, 1.5, f64::NAN] {
        let refused = Resonances::default().with_smallest_divisor(divisor);
        assert!(matches!(refused, Err(Error::OutsideInterval { argument: "smallest_divisor", .. })));
    }
    Ok(())
}

#[test]
fn the_module_of_resonances_is_that_over_the_integers() -> Result<(), Error> {
    // (2, 4, 0) and (0, 6, 3): sums of integer multiples, in any order and sign, and no fractions of them.
    let bases = [
        &[&[2, 4, 0][..], &[0, 6, 3]][..],
        &[&[0, 6, 3], &[-2, 2, 3]],
        &[&[2, 4, 0], &[-2, 2, 3]],
        &[&[4, 8, 0], &[-2, 2, 3], &[6, 12, 0]],
    ];
    for vectors in bases {
        let module = Resonances::new(vectors)?;
        for (a, b) in (-3..=3).flat_map(|a| (-3..=3).map(move |b| (a, b))) {
            assert!(module.keeps(&[2 * a, 4 * a + 6 * b, 3 * b]));
            assert!(!module.keeps(&[2 * a + 1, 4 * a + 6 * b + 2, 3 * b]));
            assert!(!module.keeps(&[2 * a, 4 * a + 6 * b + 2, 3 * b + 1]));
        }
        assert!(!module.keeps(&[2, 4]));
    }
    assert!(Resonances::default().keeps(&[0, 0]) && !Resonances::default().keeps(&[1, 0]));
    Ok(())
}

#[test]
fn an_order_past_the_exponents_or_the_factorials_is_refused() -> Result<(), Error> {
    assert!(matches!(
        refused("x^2 + X^2 + 2*y^2 + 2*Y^2", 32_764),
        Some(Error::OrderTooLarge { order: 32_764, bound: 32_763 })
    ));
    let space = PhaseSpace::new(&[("x", "X")])?;
    let float = normalize(&space.parse::<f64>("x^2 + X^2")?, 171, &space);
    assert!(matches!(float, Err(Error::OrderTooLarge { order: 171, bound: 170 })));
    Ok(())
}

#[test]
fn a_phase_space_beyond_the_slots_or_with_unusable_names_is_refused() -> Result<(), Error> {
    let pairs = [("a", "A"), ("b", "B"), ("c", "C"), ("d", "D"), ("e", "E")];
    let size = |space: Result<PhaseSpace, Error>| match space {
        Err(Error::PhaseSpaceSize { degrees_of_freedom, parameters, slots: SLOTS }) => {
            Some((degrees_of_freedom, parameters))
        }
        _ => None,
    };
    assert_eq!(size(PhaseSpace::new(&pairs)), Some((5, 0)));
    assert_eq!(size(PhaseSpace::new(&[])), Some((0, 0)));
    assert_eq!(size(PhaseSpace::new(&pairs[..3])?.with_parameters(&["s", "t", "w"])), Some((3, 3)));
    assert!(PhaseSpace::new(&pairs[..3])?.with_parameters(&["s", "t"]).is_ok());
    for pair in [("x", "x"), ("x", "2y"), ("", "y")] {
        assert!(matches!(PhaseSpace::new(&[pair]), Err(Error::Parse { .. })), "{pair:?}");
    }
    assert!(matches!(PhaseSpace::new(&pairs[..1])?.parse::<f64>("a*z"), Err(Error::Parse { position: 2, .. })));
    Ok(())
}

#[test]
fn numbers_that_are_none_are_refused() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "X")])?;
    let mut h = space.parse::<f64>("(x^2 + X^2)/2 + x^3")?;
    let map = BirkhoffMap::new(&normalize(&h, 2, &space)?, &[])?;
    for state in [&[0.1][..], &[0.1, 0.0, 0.0]] {
        assert!(matches!(map.to_normal(state), Err(Error::CountMismatch { what: "state", expected: 2, .. })));
    }
    assert!(matches!(map.to_normal(&[f64::NAN, 0.0]), Err(Error::NotFinite { what: "state", .. })));
    assert!(matches!(map.from_normal(&[1e200, 0.0]), Err(Error::NotFinite { what: "transformed state", .. })));
    assert!(matches!(map.trajectory(&[0.1, 0.0], &[f64::INFINITY]), Err(Error::NotFinite { what: "times", .. })));
    assert!(matches!(map.frequencies(&[]), Err(Error::CountMismatch { what: "actions", .. })));
    let parameter = BirkhoffMap::new(&normalize(&h, 2, &space)?, &[1.0]);
    assert!(matches!(parameter, Err(Error::CountMismatch { what: "parameters", found: 1, expected: 0 })));
    h.add_term(Monomial::new(&[4])?, &f64::NAN);
    assert!(matches!(normalize(&h, 2, &space), Err(Error::NotFinite { what: "Hamiltonian", .. })));
    let large = space.parse::<f64>("(x^2 + X^2)/2 + 1e200*x^3")?;
    assert!(matches!(normalize(&large, 2, &space), Err(Error::NotFinite { what: "normal form", .. })));
    let foreign = Polynomial::from_terms([(Monomial::new(&[0, 0, 3])?, 1.0)]);
    assert!(matches!(normalize(&foreign, 2, &space), Err(Error::ValueMissing { slot: 2, given: 2 })));
    Ok(())
}

#[test]
fn a_list_of_the_wrong_length_is_an_input_error_that_names_the_argument() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "X")])?;
    let form = normalize(&space.parse::<f64>("(x^2 + X^2)/2 + x^3")?, 2, &space)?;
    let map = BirkhoffMap::new(&form, &[])?;
    let refused = [
        ("state", map.to_normal(&[0.1]).err(), 1, 2),
        ("actions", map.frequencies(&[0.1, 0.2]).err(), 2, 1),
        ("parameters", BirkhoffMap::new(&form, &[1.0]).err(), 1, 0),
    ];
    for (argument, error, found, expected) in refused {
        let error = error.expect(argument);
        assert_eq!((error.kind(), error.argument()), (Kind::Input, Some(argument)));
        assert_eq!((error.value(), error.bound()), (Some(Value::Integer(found)), Some(Value::Integer(expected))));
    }
    let infinite = map.to_normal(&[f64::INFINITY, 0.0]).expect_err("infinite");
    assert_eq!((infinite.kind(), infinite.argument()), (Kind::Input, Some("state")));
    let overflowing = map.from_normal(&[1e200, 0.0]).expect_err("it overflows");
    assert_eq!((overflowing.kind(), overflowing.argument()), (Kind::Input, None));
    Ok(())
}

#[test]
fn progress_tells_every_order_and_can_stop() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "X")])?;
    let h = space.parse::<BigRational>("(x^2 + X^2)/2 + x^3")?;
    let mut told = Vec::new();
    let mut listen = |done, of| {
        told.push((done, of));
        ControlFlow::Continue(())
    };
    normalize_with(&h, 3, &space, &Resonances::default(), &mut listen)?;
    told.dedup();
    assert_eq!(told, [(0, 3), (1, 3), (2, 3), (3, 3)]);
    let stop = &mut |done, _| if done == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let stopped = normalize_with(&h, 9, &space, &Resonances::default(), stop);
    assert!(matches!(stopped, Err(Error::Interrupted { done: 2, of: 9 })));
    Ok(())
}
