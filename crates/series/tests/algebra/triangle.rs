//! Deprit's triangle: the transformation is canonical, its inverse undoes it, and it turns the Hamiltonian into the
//! normal form.

use andoyer_series::lie::{Homological, LieTransform, Normalization, Poisson, deprit_triangle};
use andoyer_series::progress::quiet;
use andoyer_series::rigid_body::{TAU, Variable, W, W_BAR, Y_HAT};
use andoyer_series::{Error, NormalForm, Polynomial, Truncation};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use std::ops::ControlFlow;

type Rational = Polynomial<BigRational>;

fn parse(text: &str) -> Result<Rational, Error> {
    Polynomial::parse(text, &["q", "p", "Q", "P", "e"])
}

/// Σ εⁿ f_n with ε in slot 4.
fn with_parameter(series: &[Rational]) -> Result<Rational, Error> {
    let mut sum = Polynomial::zero();
    for (n, part) in (0..).zip(series) {
        sum += &part.multiply(&Polynomial::variable(4)?.power(n)?)?;
    }
    Ok(sum)
}

/// Two degrees of freedom, eigenvalues 1 and √2 replaced by 1 and 7/5; cubic and quartic terms in two orders.
fn two_modes(order: usize) -> Result<(Vec<Rational>, Poisson, Normalization<BigRational>), Error> {
    let seven_fifths = BigRational::new(7.into(), 5.into());
    let homological = Homological::new(&[(0, 1, BigRational::from_integer(1.into())), (2, 3, seven_fifths)])?;
    let poisson = Poisson::new(&[(0, 1), (2, 3)])?;
    let series = vec![
        homological.unperturbed()?,
        parse("q^2*P + 2*Q*p*P - p^3/3 + q*Q^2")?,
        parse("q^4/2 - q*p*Q*P + P^4 + 3*q^2*P^2")?,
    ];
    let normalization = deprit_triangle(&series, &homological, &poisson, order, &mut quiet)?;
    Ok((series, poisson, normalization))
}

#[test]
fn the_direct_transformation_of_the_hamiltonian_is_the_normal_form() -> Result<(), Error> {
    let order = 4;
    let (series, _, normalization) = two_modes(order)?;
    let images = series.iter().map(|part| normalization.transform.direct(part)).collect::<Result<Vec<_>, _>>()?;
    for n in 0..=order {
        let sum = images
            .iter()
            .enumerate()
            .filter(|(k, _)| *k <= n)
            .fold(Rational::zero(), |sum, (k, image)| &sum + &image[n - k]);
        assert_eq!(sum, normalization.hamiltonian[n], "order {n}");
    }
    assert!(!normalization.hamiltonian[order].is_zero());
    Ok(())
}

#[test]
fn the_inverse_transformation_of_the_normal_form_is_the_hamiltonian() -> Result<(), Error> {
    let order = 4;
    let (mut series, _, normalization) = two_modes(order)?;
    series.resize(order + 1, Rational::zero());
    let kernels = &normalization.hamiltonian;
    let images = kernels.iter().map(|part| normalization.transform.inverse(part)).collect::<Result<Vec<_>, _>>()?;
    for n in 0..=order {
        let sum = (0..=n).fold(Rational::zero(), |sum, k| &sum + &images[k][n - k]);
        assert_eq!(sum, series[n], "order {n}");
    }
    Ok(())
}

#[test]
fn the_normal_form_commutes_with_the_unperturbed_motion() -> Result<(), Error> {
    let (series, poisson, normalization) = two_modes(5)?;
    for kernel in &normalization.hamiltonian {
        assert!(poisson.bracket(&series[0], kernel)?.is_zero());
    }
    Ok(())
}

#[test]
fn the_transformed_pairs_are_canonical_to_the_order_kept() -> Result<(), Error> {
    let order = 4;
    let (_, poisson, normalization) = two_modes(order)?;
    let kept = Truncation::partial(&[4], order as u32)?;
    let image = |slot| with_parameter(&normalization.transform.direct(&Polynomial::variable(slot)?)?);
    let images = [image(0)?, image(1)?, image(2)?, image(3)?];
    for (a, b) in [(0, 1), (2, 3), (0, 2), (0, 3), (1, 2), (1, 3)] {
        let bracket = poisson.bracket(&images[a], &images[b])?.truncate(&kept);
        let expected = if matches!((a, b), (0, 1) | (2, 3)) { "1" } else { "0" };
        assert_eq!(bracket, parse(expected)?, "{{{a}; {b}}}");
    }
    Ok(())
}

#[test]
fn a_single_generator_gives_the_exponential_of_its_lie_derivative() -> Result<(), Error> {
    let poisson = Poisson::new(&[(0, 1)])?;
    let generator = parse("q^2*p/2 - p^3")?;
    let mut scaled = vec![Polynomial::zero(); 5];
    scaled[0] = generator.clone();
    let transform = LieTransform::new(poisson.clone(), scaled);
    let f = parse("q + p^2")?;
    let (direct, inverse) = (transform.direct(&f)?, transform.inverse(&f)?);
    let mut term = f;
    for n in 1..=5 {
        term = poisson.lie_derivative(&generator, &term)?.over(n)?;
        let n = n as usize;
        assert_eq!(direct[n], term, "order {n}");
        assert_eq!(inverse[n], if n.is_multiple_of(2) { term.clone() } else { -&term }, "order {n}");
    }
    Ok(())
}

#[test]
fn the_second_order_of_deprit_s_formula() -> Result<(), Error> {
    // f_{0,2} = {{f; S_1}; S_1} + {f; S_2}, theory §4 by hand; S_2 = T_2, f_{0,2}/2! is stored.
    let poisson = Poisson::new(&[(0, 1)])?;
    let (first, second, f) = (parse("q^3 + q*p^2")?, parse("q^2*p^2 - p^4")?, parse("q - p")?);
    let transform = LieTransform::new(poisson.clone(), vec![first.clone(), second.clone()]);
    let nested = poisson.bracket(&poisson.bracket(&f, &first)?, &first)?;
    let expected = (&nested + &poisson.bracket(&f, &second)?).over(2)?;
    assert_eq!(transform.direct(&f)?[2], expected);
    assert_eq!(transform.generator(2), Some(second));
    assert_eq!((transform.generator(0), transform.generator(3), transform.scaled_generator(0)), (None, None, None));
    Ok(())
}

const ORDER: usize = 5;

/// The rigid body's transformation of w̄, w and ŷ, to `ORDER` in τ.
fn rigid_body(direct: bool) -> Result<[Rational; 3], Error> {
    let normal_form = NormalForm::new(ORDER)?;
    let transform = normal_form.transform()?;
    let image = |slot| {
        let variable = Polynomial::variable(slot)?;
        let series = if direct { transform.direct(&variable) } else { transform.inverse(&variable) }?;
        Ok::<_, Error>(series.iter().fold(Rational::zero(), |sum, part| &sum + part))
    };
    Ok([image(W_BAR)?, image(W)?, image(Y_HAT)?])
}

#[test]
fn direct_after_inverse_is_the_identity_for_the_rigid_body() -> Result<(), Error> {
    let (direct, inverse) = (rigid_body(true)?, rigid_body(false)?);
    for (outer, inner) in [(&direct, &inverse), (&inverse, &direct)] {
        let replacements = [(W_BAR, &inner[0]), (W, &inner[1]), (Y_HAT, &inner[2])];
        // Order n of w is τⁿ, order n of ŷ is τ^{n+1}.
        for (position, slot, degree) in [(0, W_BAR, ORDER), (1, W, ORDER), (2, Y_HAT, ORDER + 1)] {
            let kept = Truncation::partial(&[TAU], degree as u32)?;
            assert_eq!(
                outer[position].compose(&replacements, Some(&kept))?,
                Polynomial::variable(slot)?,
                "slot {slot}"
            );
        }
    }
    Ok(())
}

#[test]
fn the_rigid_body_s_transformation_is_canonical_y_included() -> Result<(), Error> {
    let poisson = andoyer_series::rigid_body::poisson()?;
    for [w_bar, w, y_hat] in [rigid_body(true)?, rigid_body(false)?] {
        let kept = |degree| Truncation::partial(&[TAU], degree as u32);
        assert_eq!(
            poisson.bracket(&w_bar, &w)?.truncate(&kept(ORDER)?),
            Polynomial::constant(BigRational::from_integer(1.into()))
        );
        assert!(!poisson.bracket(&w_bar, &w)?.is_empty());
        for partner in [&w_bar, &w] {
            assert!(poisson.bracket(&y_hat, partner)?.truncate(&kept(ORDER + 1)?).is_zero());
        }
    }
    Ok(())
}

#[test]
fn floats_follow_the_exact_triangle() -> Result<(), Error> {
    // A coefficient of order 6 sums fewer than 10² terms below 10² in size, each off by a few 2⁻⁵³: 10⁴ · 1e-16 =
    // 1e-12.
    let exact = NormalForm::new(6)?;
    let float = deprit_triangle(
        &andoyer_series::rigid_body::hamiltonian::<f64>()?,
        &andoyer_series::rigid_body::homological()?,
        &andoyer_series::rigid_body::poisson()?,
        6,
        &mut quiet,
    )?;
    for n in 0..=6 {
        for (power, coefficient) in exact.triaxiality_polynomial(n)? {
            let part = float.hamiltonian[n].part(andoyer_series::rigid_body::BETA, *power)?;
            let value = 2.0 * part.evaluate(&[1.0; 4])?;
            let expected = coefficient.to_f64().unwrap_or(f64::NAN);
            assert!((value - expected).abs() < 1e-12, "P_{n}, β^{power}: {value} against {coefficient}");
        }
    }
    Ok(())
}

#[test]
fn bad_input_to_the_triangle_is_refused() -> Result<(), Error> {
    let homological = Homological::new(&[(0, 1, BigRational::from_integer(1.into()))])?;
    let poisson = Poisson::new(&[(0, 1)])?;
    let run = |series: &[Rational]| deprit_triangle(series, &homological, &poisson, 1, &mut quiet);
    assert!(matches!(run(&[parse("q^2")?]), Err(Error::UnperturbedMismatch { terms: 1 })));
    assert!(matches!(run(&[]), Err(Error::UnperturbedMismatch { terms: 0 })));
    assert!(matches!(parse("q")?.over(0), Err(Error::DivisionByZero)));
    Ok(())
}

#[test]
fn a_callback_hears_of_every_order_of_a_transformation_and_can_stop_it() -> Result<(), Error> {
    let normal_form = NormalForm::new(4)?;
    let stop = &mut |done, _| if done == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    for stopped in
        [normal_form.direct_with(Variable::Angle, 1, stop), normal_form.inverse_with(Variable::Angle, 1, stop)]
    {
        assert!(matches!(stopped, Err(Error::Interrupted { done: 2, of: 4 })));
    }
    let mut told = Vec::new();
    let mut listen = |done, of| {
        told.push((done, of));
        ControlFlow::Continue(())
    };
    // What was stopped is computed anew, and what was computed is kept.
    assert_eq!(normal_form.direct_with(Variable::Angle, 1, &mut listen)?, normal_form.direct(Variable::Angle, 1)?);
    normal_form.direct_with(Variable::Angle, 2, &mut listen)?;
    told.dedup();
    assert_eq!(told, [(0, 4), (1, 4), (2, 4), (3, 4), (4, 4)]);
    Ok(())
}

#[test]
fn a_callback_is_asked_within_a_long_bracket() -> Result<(), Error> {
    // 231 · 231 products in the one bracket of order 1.
    let dense = Polynomial::<f64>::parse("(q + p + Q + 1)^20", &["q", "p", "Q"])?
        .filter(|monomial, _| monomial.exponent(2) == 0);
    assert_eq!(dense.len(), 231);
    let transform = LieTransform::new(Poisson::new(&[(0, 1)])?, vec![dense.clone()]);
    for direct in [true, false] {
        let mut asked = 0;
        let mut listen = |done, _| {
            asked += usize::from(done == 0);
            if asked == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let stopped = if direct {
            transform.direct_with(&dense, &mut listen)
        } else {
            transform.inverse_with(&dense, &mut listen)
        };
        assert!(matches!(stopped, Err(Error::Interrupted { done: 0, of: 1 })), "{asked}");
    }
    Ok(())
}
