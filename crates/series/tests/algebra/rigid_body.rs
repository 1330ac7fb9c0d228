//! The normal form of the rigid body against the formulas of theory §4, parsed as printed.

use andoyer_series::rigid_body::{MAX_ORDER, PublicForm, Variable, separatrix_action};
use andoyer_series::{Coefficient, Error, Monomial, NormalForm, Polynomial};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::Zero;
use std::ops::ControlFlow;

type Gaussian = Complex<BigRational>;

const NAMES: [&str; 3] = ["u", "U", "β"];

/// P_n of theory §4.
const TRIAXIALITY: [&str; 10] = [
    "2",
    "-1",
    "-β^2/2",
    "-5*β^2/8",
    "-(3/32)*β^2*(3*β^2+8)",
    "-(7/32)*β^2*(5*β^2+4)",
    "-(1/128)*β^2*(45*β^4+354*β^2+128)",
    "-(9/1024)*β^2*(265*β^4+650*β^2+128)",
    "-(5/8192)*β^2*(953*β^6+14888*β^4+17120*β^2+2048)",
    "-(11/8192)*β^2*(4075*β^6+20212*β^4+13104*β^2+1024)",
];

/// p_n: the paper's print, for n ≥ 2 with the factor i^{1−n} that it lacks (theory §11).
const PAPER: [&str; 10] = [
    "-2*i",
    "1",
    "-i*β^2/2",
    "-5*β^2/8",
    "i*(3/32)*β^2*(3*β^2+8)",
    "(7/32)*β^2*(5*β^2+4)",
    "-i*(1/128)*β^2*(45*β^4+354*β^2+128)",
    "-(9/1024)*β^2*(265*β^4+650*β^2+128)",
    "i*(5/8192)*β^2*(953*β^6+14888*β^4+17120*β^2+2048)",
    "(11/8192)*β^2*(4075*β^6+20212*β^4+13104*β^2+1024)",
];

/// s_m of theory §4, S_m = (m−1)! (α/(√γ V))^m β (u²+U²) s_m.
const GENERATORS: [&str; 5] = [
    "u*U/8",
    "-(i/4)*u^2*U^2",
    "(1/128)*(-24*(β^2+2)*u*U + 5*i*β*(U^2-u^2))*u^2*U^2",
    "(1/128)*(2*i*(57*β^2+32)*u*U + β*(9*β^2+20)*(U^2-u^2))*u^3*U^3",
    "(1/1536)*(2*(343*β^4+2024*β^2+480)*u^2*U^2 - 11*β^2*(β^2+2)*(u^4+U^4) - 6*i*β*(147*β^2+100)*u*U*(U^2-u^2))*u^3*U^3",
];

fn parse(text: &str) -> Result<Polynomial<Gaussian>, Error> {
    Polynomial::parse(text, &NAMES)
}

fn polynomial(face: &PublicForm) -> Result<Polynomial<Gaussian>, Error> {
    let terms = face.iter().map(|(&(j, k, l), c)| Ok((Monomial::new(&[j, k, l])?, c.clone())));
    Ok(Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?))
}

fn in_beta<'a>(powers: impl IntoIterator<Item = (&'a u32, Gaussian)>) -> Result<Polynomial<Gaussian>, Error> {
    polynomial(&powers.into_iter().map(|(&l, c)| ((0, 0, l), c)).collect())
}

fn real(c: &BigRational) -> Gaussian {
    Complex::new(c.clone(), BigRational::zero())
}

#[test]
fn triaxiality_polynomials_are_those_of_the_theory() -> Result<(), Error> {
    let normal_form = NormalForm::new(9)?;
    for (n, text) in TRIAXIALITY.iter().enumerate() {
        let computed = in_beta(normal_form.triaxiality_polynomial(n)?.iter().map(|(l, c)| (l, real(c))))?;
        assert_eq!(computed, parse(text)?, "P_{n}");
    }
    Ok(())
}

#[test]
fn the_paper_s_polynomials_are_those_with_the_errata_applied() -> Result<(), Error> {
    let normal_form = NormalForm::new(9)?;
    for (n, text) in PAPER.iter().enumerate() {
        let paper = normal_form.paper_polynomial(n)?;
        let computed = in_beta(paper.iter().map(|(l, c)| (l, c.clone())))?;
        assert_eq!(computed, parse(text)?, "p_{n}");
        // P_n = i^{n+1} p_n.
        let turn = parse("i")?.power(n as u32 + 1)?;
        assert_eq!(turn.multiply(&computed)?, parse(TRIAXIALITY[n])?, "P_{n} from p_{n}");
    }
    Ok(())
}

#[test]
fn generating_functions_are_those_of_the_theory() -> Result<(), Error> {
    let normal_form = NormalForm::new(5)?;
    let mut factorial = 1;
    for (m, text) in (1..).zip(GENERATORS) {
        let expected = parse("β*(u^2+U^2)")?.multiply(&parse(text)?)?.scale(&Gaussian::integer(factorial));
        assert_eq!(polynomial(&normal_form.generator(m)?)?, expected, "S_{m}");
        factorial *= m as i64;
    }
    Ok(())
}

#[test]
fn a_higher_order_leaves_the_lower_ones_as_they_are() -> Result<(), Error> {
    let (short, long) = (NormalForm::new(4)?, NormalForm::new(7)?);
    for n in 0..=4 {
        assert_eq!(short.triaxiality_polynomial(n)?, long.triaxiality_polynomial(n)?);
    }
    for n in 1..=4 {
        assert_eq!(short.generator(n)?, long.generator(n)?);
        for variable in [Variable::Coordinate, Variable::Momentum, Variable::Angle] {
            assert_eq!(short.direct(variable, n)?, long.direct(variable, n)?);
            assert_eq!(short.inverse(variable, n)?, long.inverse(variable, n)?);
        }
    }
    assert_ne!(short, long);
    Ok(())
}

#[test]
fn first_order_of_the_transformation_is_the_bracket_with_s_1() -> Result<(), Error> {
    // {u; S_1} = ∂S_1/∂U, {U; S_1} = −∂S_1/∂u, {y; S_1} = ∂S_1/∂M = −S_1/M, with S_1 = β (u²+U²) uU/8 and {u; U} = 1
    // (theory §1, §6).
    let normal_form = NormalForm::new(2)?;
    let generator = parse("β*(u^2+U^2)*u*U/8")?;
    let direct = |variable| polynomial(&normal_form.direct(variable, 1)?);
    assert_eq!(direct(Variable::Coordinate)?, generator.derivative(1)?);
    assert_eq!(direct(Variable::Momentum)?, -&generator.derivative(0)?);
    assert_eq!(direct(Variable::Angle)?, -&generator);
    for variable in [Variable::Coordinate, Variable::Momentum, Variable::Angle] {
        assert_eq!(polynomial(&normal_form.inverse(variable, 1)?)?, -&direct(variable)?);
    }
    Ok(())
}

#[test]
fn second_order_of_the_transformation_is_deprit_s_formula_in_u_and_v() -> Result<(), Error> {
    // f_{0,2}/2! = ({{f; S_1}; S_1} + {f; S_2})/2 in the paper's own variables, over the Gaussian rationals; for y, {y;
    // S} = ∂S/∂M.
    let normal_form = NormalForm::new(2)?;
    let poisson = andoyer_series::lie::Poisson::new(&[(0, 1)])?;
    let [first, second] = [polynomial(&normal_form.generator(1)?)?, polynomial(&normal_form.generator(2)?)?];
    let order_2 = |once: &Polynomial<Gaussian>, by_second: &Polynomial<Gaussian>| {
        (&poisson.bracket(once, &first)? + by_second).over(2)
    };
    for (variable, slot) in [(Variable::Coordinate, 0), (Variable::Momentum, 1)] {
        let f = Polynomial::variable(slot)?;
        let expected = order_2(&poisson.bracket(&f, &first)?, &poisson.bracket(&f, &second)?)?;
        assert_eq!(polynomial(&normal_form.direct(variable, 2)?)?, expected, "{}", variable.name());
    }
    // ∂S_m/∂M = −(m/M) S_m, and the factor 1/M is taken out.
    let expected = order_2(&-&first, &second.scale(&Gaussian::integer(-2)))?;
    assert_eq!(polynomial(&normal_form.direct(Variable::Angle, 2)?)?, expected);
    Ok(())
}

#[test]
fn the_transformation_of_y_is_real_and_odd_in_the_angle() -> Result<(), Error> {
    // On u = i w̄, U = w the term c u^j U^k is c i^j w̄^j w^k: a sum of sines of even multiples of ℓ has purely
    // imaginary coefficients, odd under the exchange of w̄ and w (theory §6).
    let normal_form = NormalForm::new(6)?;
    for n in 1..=6 {
        let face = normal_form.direct(Variable::Angle, n)?;
        let in_w = |(j, k, l): (u32, u32, u32)| {
            let mut turn = Gaussian::integer(1);
            (0..j).for_each(|_| turn *= Complex::new(BigRational::zero(), BigRational::integer(1)));
            face.get(&(j, k, l)).map(|c| c * turn)
        };
        assert!(!face.is_empty());
        for &(j, k, l) in face.keys() {
            assert_eq!(j + k, 2 * n as u32 + 2);
            assert!(in_w((j, k, l)).is_some_and(|c| c.re.is_zero()), "order {n}: {j} {k} {l}");
            assert_eq!(in_w((j, k, l)), in_w((k, j, l)).map(|c| -c), "order {n}: {j} {k} {l}");
        }
    }
    Ok(())
}

#[test]
fn horner_loses_nothing_no_coefficient_of_p_n_is_positive() -> Result<(), Error> {
    let normal_form = NormalForm::new(16)?;
    for n in 1..=16 {
        assert!(normal_form.triaxiality_polynomial(n)?.values().all(|c| *c < BigRational::zero()), "P_{n}");
    }
    Ok(())
}

#[test]
fn separatrix_action_is_the_table_of_the_theory() -> Result<(), Error> {
    // The table has five digits.
    let table = [
        (0.0, 1.0),
        (0.01, 0.91012),
        (0.1, 0.71956),
        (0.3, 0.52451),
        (0.5, 0.39183),
        (0.8, 0.21635),
        (0.95, 0.10238),
        (1.0, 0.0),
    ];
    for (beta, expected) in table {
        assert!((separatrix_action(beta)? - expected).abs() <= 0.5e-5, "β = {beta}");
    }
    for beta in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(separatrix_action(beta), Err(Error::OutsideInterval { argument: "beta", .. })), "β = {beta}");
    }
    Ok(())
}

#[test]
fn an_order_beyond_the_memory_is_refused_with_its_size() {
    for order in [595, MAX_ORDER] {
        let refused = NormalForm::new(order).expect_err("too large");
        let Error::MemoryTooLarge { estimate_gib, bound_gib: 8.0, .. } = refused else { panic!("{refused}") };
        assert!(estimate_gib > 8.0 && refused.to_string().starts_with(&format!("order {order} would take some ")));
    }
}

#[test]
fn orders_out_of_range_are_refused_with_their_bounds() -> Result<(), Error> {
    let normal_form = NormalForm::new(3)?;
    assert_eq!(normal_form.order(), 3);
    let refused = |result: Option<Error>, low, high| {
        assert!(
            matches!(result, Some(Error::OrderOutOfRange { minimum, maximum, .. }) if (minimum, maximum) == (low, high))
        );
    };
    refused(normal_form.triaxiality_polynomial(4).err(), 0, 3);
    refused(normal_form.paper_polynomial(4).err(), 0, 3);
    for n in [0, 4] {
        refused(normal_form.generator(n).err(), 1, 3);
        refused(normal_form.direct(Variable::Angle, n).err(), 1, 3);
        refused(normal_form.inverse(Variable::Momentum, n).err(), 1, 3);
    }
    let trivial = NormalForm::new(0)?;
    assert_eq!(trivial.triaxiality_polynomial(0)?.len(), 1);
    refused(trivial.generator(1).err(), 1, 0);
    for order in [MAX_ORDER + 1, usize::MAX] {
        assert!(matches!(NormalForm::new(order), Err(Error::OrderTooLarge { bound, .. }) if bound == MAX_ORDER));
    }
    Ok(())
}

#[test]
fn progress_is_told_and_may_stop() -> Result<(), Error> {
    let mut told = Vec::new();
    NormalForm::with_progress(4, |done, of| {
        told.push((done, of));
        ControlFlow::Continue(())
    })?;
    assert!(told.is_sorted() && told.iter().all(|&(_, of)| of == 4));
    assert_eq!((told.first(), told.last()), (Some(&(0, 4)), Some(&(4, 4))));
    let stop_at_2 = |done, _| if done == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    assert!(matches!(NormalForm::with_progress(4, stop_at_2), Err(Error::Interrupted { done: 2, of: 4 })));
    let immediately = |_, _| ControlFlow::Break(());
    assert!(matches!(NormalForm::with_progress(594, immediately), Err(Error::Interrupted { done: 0, .. })));
    Ok(())
}

#[test]
fn names_of_variables_are_read_back() -> Result<(), Error> {
    for variable in [Variable::Coordinate, Variable::Momentum, Variable::Angle] {
        assert_eq!(variable.name().parse::<Variable>()?, variable);
    }
    assert!(matches!("Y".parse::<Variable>(), Err(Error::NameUnknown { what: "variable", .. })));
    Ok(())
}

#[test]
fn equality_and_hash_ignore_what_has_been_computed_already() -> Result<(), Error> {
    use std::hash::{BuildHasher, RandomState};
    let (one, other) = (NormalForm::new(3)?, NormalForm::new(3)?);
    one.direct(Variable::Angle, 1)?;
    let state = RandomState::new();
    assert_eq!(one, other);
    assert_eq!(state.hash_one(&one), state.hash_one(other.clone()));
    Ok(())
}
