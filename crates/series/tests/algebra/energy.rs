//! The normal form by conservation of energy against Deprit's triangle over rationals: two algorithms, two representations.

use andoyer_series::lie::deprit_triangle;
use andoyer_series::progress::quiet;
use andoyer_series::rigid_body::{BETA, TAU, hamiltonian, homological, poisson};
use andoyer_series::{Error, NormalForm};
use num_rational::BigRational;
use num_traits::Zero;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

const ORDER: usize = 14;

#[test]
fn energy_and_triangle_give_the_same_kernel_and_the_same_generators() -> Result<(), Error> {
    let (homological, poisson) = (homological()?, poisson()?);
    let triangle = deprit_triangle::<BigRational>(&hamiltonian()?, &homological, &poisson, ORDER, &mut quiet)?;
    let normal_form = NormalForm::new(ORDER)?;
    for n in 0..=ORDER {
        let expected: BTreeMap<u32, BigRational> = triangle.hamiltonian[n]
            .terms()
            .map(|(monomial, c)| {
                assert_eq!(monomial.exponent(TAU) as usize, n);
                (monomial.exponent(BETA), c + c)
            })
            .collect();
        assert_eq!(normal_form.triaxiality_polynomial(n)?, &expected, "P_{n}");
    }
    assert_eq!(normal_form.transform()?, &triangle.transform);
    Ok(())
}

#[test]
fn lower_orders_do_not_depend_on_the_order_asked_for() -> Result<(), Error> {
    let (low, high) = (NormalForm::new(7)?, NormalForm::new(23)?);
    for n in 1..=7 {
        assert_eq!(low.triaxiality_polynomial(n)?, high.triaxiality_polynomial(n)?);
        assert_eq!(low.generator(n)?, high.generator(n)?);
    }
    Ok(())
}

#[test]
fn no_coefficient_of_the_kernel_is_positive_and_its_degree_is_even() -> Result<(), Error> {
    // theory §4.
    let normal_form = NormalForm::new(40)?;
    for n in 2..=40 {
        let polynomial = normal_form.triaxiality_polynomial(n)?;
        assert!(!polynomial.contains_key(&0), "P_{n}(0) = 0: the axisymmetric body has P_0 and P_1 only");
        assert!(polynomial.values().all(|c| c < &BigRational::zero()), "P_{n} ≤ 0");
        assert_eq!(polynomial.keys().next_back(), Some(&(2 * (n as u32 / 2))), "degree of P_{n}");
    }
    Ok(())
}

#[test]
fn progress_counts_every_order_once_and_can_stop() -> Result<(), Error> {
    let mut told = Vec::new();
    NormalForm::with_progress(5, |done, of| {
        told.push((done, of));
        ControlFlow::Continue(())
    })?;
    assert_eq!(told, [(0, 5), (1, 5), (2, 5), (3, 5), (4, 5), (5, 5)]);
    let stopped =
        NormalForm::with_progress(
            5,
            |done, _| if done == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) },
        );
    assert!(matches!(stopped, Err(Error::Interrupted { done: 3, of: 5 })));
    Ok(())
}
