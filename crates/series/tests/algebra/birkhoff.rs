//! The Birkhoff normal form, exact: published coefficients, independent series, and the laws of the transformation.

use andoyer_series::birkhoff::{Mode, Resonances};
use andoyer_series::progress::quiet;
use andoyer_series::{
    BirkhoffNormalForm, Coefficient, Error, Monomial, NormalForm, PhaseSpace, Polynomial, Truncation, normalize,
    normalize_with,
};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::ToPrimitive;

type Rational = Polynomial<BigRational>;

fn ratio(p: i64, q: i64) -> BigRational {
    BigRational::new(p.into(), q.into())
}

fn plane() -> Result<PhaseSpace, Error> {
    PhaseSpace::new(&[("x", "X"), ("y", "Y")])
}

/// The 1:1 resonant normal form.
fn one_to_one(h: &Rational, order: usize, space: &PhaseSpace) -> Result<BirkhoffNormalForm<BigRational>, Error> {
    normalize_with(h, order, space, &Resonances::new(&[&[1, -1]])?, &mut quiet)
}

fn henon_heiles() -> Result<Rational, Error> {
    plane()?.parse("(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3")
}

/// Σ (−1)ⁿ⁺¹ qⁿ/n! over even n: 1 − cos q, and p²/2.
fn pendulum(degree: u32) -> Result<Rational, Error> {
    let mut sum = Polynomial::parse("p^2/2", &["q", "p"])?;
    let mut factorial = BigRational::integer(1);
    for n in 1..=degree {
        factorial = factorial.times(n.into());
        if n.is_multiple_of(2) {
            let sign = if n.is_multiple_of(4) { -1 } else { 1 };
            sum.add_term(Monomial::new(&[n])?, &(BigRational::integer(sign) / &factorial));
        }
    }
    Ok(sum)
}

#[test]
fn henon_heiles_of_degree_four_follows_from_the_published_toda_lattice() -> Result<(), Error> {
    // Gustavson's Hamiltonian and normal form (Astron. J. 71 (1966) 670, whose own table was not at hand). The Toda lattice below has the
    // same cubic terms, and its published terms of degree 4 are (N² + L²)/3 in the invariants N = I_x + I_y and L = x Y − y X. Its quartic
    // terms (x² + y²)²/2 add their mean, (3 N² − L²)/4; what is left are the cubic terms: −(5/12) N² + (7/12) L².
    let space = plane()?;
    let [n, l]: [Rational; 2] = [space.parse("(x^2 + X^2 + y^2 + Y^2)/2")?, space.parse("x*Y - y*X")?];
    let invariants = |a, b| Ok::<_, Error>(&n.power(2)?.scale(&a) + &l.power(2)?.scale(&b));
    let degree_four = |h: &Rational| Ok::<_, Error>(one_to_one(h, 2, &space)?.in_real()?.homogeneous_part(4));
    let (h, lattice) = (henon_heiles()?, toda(4)?);
    assert_eq!((lattice.homogeneous_part(3), h.degree()), (h.homogeneous_part(3), Some(3)));
    let quartic = &h.homogeneous_part(2) + &lattice.homogeneous_part(4);
    assert_eq!(quartic.homogeneous_part(4), space.parse("(x^2 + y^2)^2/2")?);
    let published = invariants(ratio(1, 3), ratio(1, 3))?;
    assert_eq!(
        (degree_four(&lattice)?, degree_four(&quartic)?),
        (published.clone(), invariants(ratio(3, 4), ratio(-1, 4))?)
    );
    let expected = invariants(ratio(-5, 12), ratio(7, 12))?;
    assert_eq!(&published - &invariants(ratio(3, 4), ratio(-1, 4))?, expected);
    let k = one_to_one(&h, 2, &space)?.in_real()?;
    assert_eq!(
        (k.homogeneous_part(2), k.homogeneous_part(3), k.homogeneous_part(4)),
        (n.clone(), Polynomial::zero(), expected)
    );
    Ok(())
}

#[test]
fn henon_heiles_in_its_invariant_plane_has_the_action_of_the_cubic_oscillator() -> Result<(), Error> {
    // x = X = 0 leaves (y² + Y²)/2 + a y³, a = −1/3. Its action (1/2π) ∮ √(2K − y² − 2ay³) dy, expanded in a, is a sum of beta functions,
    // I = Σ (6k)!/(8^k (3k)! (2k)! (k+1)!) a^2k K^(k+1): so I(K(I)) = I.
    let order = 10;
    let k = one_to_one(&henon_heiles()?, order, &plane()?)?.in_complex();
    let in_plane = k.filter(|monomial, _| monomial.degree_in(&[0, 1]) == 0);
    let i = Complex::new(ratio(0, 1), ratio(1, 1));
    let energy = in_plane.terms().map(|(monomial, c)| {
        let n = monomial.exponent(2);
        assert_eq!(monomial.exponent(3), n);
        let real = c * i.powi(n as i32); // uU = iI
        assert_eq!(real.im, ratio(0, 1));
        Ok((Monomial::new(&[n])?, real.re))
    });
    let energy = Polynomial::from_terms(energy.collect::<Result<Vec<_>, Error>>()?);
    assert_eq!(energy.len(), order / 2 + 1);
    let factorial = |n: u32| (1..=n).fold(BigRational::integer(1), |product, factor| product.times(factor.into()));
    let kept = Truncation::total(order as u32 / 2 + 1);
    let (mut action, mut power) = (Rational::zero(), energy.clone());
    for k in 0..=order as u32 / 2 {
        let divisor =
            BigRational::integer(8 * 9).pow(k as i32) * factorial(3 * k) * factorial(2 * k) * factorial(k + 1);
        action += &power.scale(&(factorial(6 * k) / divisor));
        power = power.multiply_truncated(&energy, &kept)?;
    }
    assert_eq!(action, Polynomial::parse("I", &["I"])?);
    Ok(())
}

#[test]
fn henon_heiles_pulls_its_quadratic_part_back_to_a_third_integral() -> Result<(), Error> {
    // Gustavson's integral: {inverse(H₂); H} starts at degree N + 3, and with the truncated H₂ at degree 3.
    let (space, h, order) = (plane()?, henon_heiles()?, 6);
    let normal_form = one_to_one(&h, order, &space)?;
    let integral = normal_form.inverse(&h.homogeneous_part(2))?;
    let rate = space.poisson()?.bracket(&integral, &h)?;
    let lowest = rate.terms().map(|(monomial, _)| monomial.total_degree()).min();
    assert_eq!(lowest, Some(order as u32 + 3));
    assert!(!integral.homogeneous_part(8).is_zero());
    Ok(())
}

/// The planar Toda lattice to a degree: (e^(2y+2√3x) + e^(2y−2√3x) + e^(−4y))/24 − 1/8, whose cubic terms are those of Hénon–Heiles.
fn toda(degree: u32) -> Result<Rational, Error> {
    let mut sum: Rational = plane()?.parse("(X^2 + Y^2)/2")?;
    let mut factorial = BigRational::integer(1);
    let [x_square, y]: [Rational; 2] = [plane()?.parse("12*x^2")?, plane()?.parse("2*y")?];
    for n in 1..=degree {
        factorial = factorial.times(n.into());
        let mut power = y.scale(&BigRational::integer(-2)).power(n)?;
        let mut binomial = BigRational::integer(1);
        for k in 0..=n {
            if k.is_multiple_of(2) {
                let term = x_square.power(k / 2)?.multiply(&y.power(n - k)?)?;
                power += &term.scale(&binomial.times(2));
            }
            binomial = binomial.times((n - k).into()) / BigRational::integer(i64::from(k) + 1);
        }
        sum += &power.scale(&(ratio(1, 24) / &factorial));
    }
    Ok(sum)
}

#[test]
fn the_toda_lattice_s_normal_form_is_the_published_one_to_degree_eight() -> Result<(), Error> {
    // A. Nikolaev, arXiv:1612.05207, supplement (AndreySNikolaev/demo-kato-nonlinear-classic, symbolic/Toda2d_Deprit3.log at 1ff4f47, lines 1167 to 1181):
    // with his ζ = −i U/√2 and η = −i √2 u a term of degree 2m is (−1)^m times that in u, U. Here E = η, Z = ζ.
    let published = [
        "-1/3*Z2^2*E2^2 + 1/3*E1^2*Z2^2 - 4/3*Z1*E1*Z2*E2 + 1/3*Z1^2*E2^2 - 1/3*Z1^2*E1^2",
        "i*(-5/27*Z2^3*E2^3 - 7/9*E1^2*Z2^3*E2 + Z1*E1*Z2^2*E2^2 - 7/9*Z1*E1^3*Z2^2 - 7/9*Z1^2*Z2*E2^3
            + Z1^2*E1^2*Z2*E2 - 7/9*Z1^3*E1*E2^2 - 5/27*Z1^3*E1^3)",
        "-515/486*Z2^4*E2^4 - 151/81*E1^2*Z2^4*E2^2 + 313/486*E1^4*Z2^4 - 124/243*Z1*E1*Z2^3*E2^3
            - 1532/243*Z1*E1^3*Z2^3*E2 - 151/81*Z1^2*Z2^2*E2^4 + 134/27*Z1^2*E1^2*Z2^2*E2^2
            - 151/81*Z1^2*E1^4*Z2^2 - 1532/243*Z1^3*E1*Z2*E2^3 - 124/243*Z1^3*E1^3*Z2*E2
            + 313/486*Z1^4*E2^4 - 151/81*Z1^4*E1^2*E2^2 - 515/486*Z1^4*E1^4",
    ];
    let k = one_to_one(&toda(8)?, 6, &plane()?)?.in_complex();
    for (m, text) in (2..).zip(published) {
        let published = Polynomial::<Complex<BigRational>>::parse(text, &["E1", "Z1", "E2", "Z2"])?;
        let sign = Complex::integer(if m % 2 == 0 { 1 } else { -1 });
        assert_eq!(k.homogeneous_part(2 * m), published.scale(&sign), "degree {}", 2 * m);
        assert!(k.homogeneous_part(2 * m - 1).is_zero());
    }
    Ok(())
}

#[test]
fn the_pendulum_s_normal_form_is_the_published_one_to_degree_22() -> Result<(), Error> {
    // The same supplement, symbolic/pendulum_explicit.log, lines 268 to 328: the coefficients of (q² + p²)ⁿ = (2I)ⁿ, n = 2 … 11.
    let published: [(i64, i64); 10] = [
        (1, 64),
        (1, 2_048),
        (5, 131_072),
        (33, 8_388_608),
        (63, 134_217_728),
        (527, 8_589_934_592),
        (9_387, 1_099_511_627_776),
        (175_045, 140_737_488_355_328),
        (422_565, 2_251_799_813_685_248),
        (4_194_753, 144_115_188_075_855_872),
    ];
    let k = normalize(&pendulum(22)?, 20, &PhaseSpace::new(&[("q", "p")])?)?.in_actions()?;
    assert_eq!((k.len(), k.coefficient(&Monomial::new(&[1])?)), (11, Some(&BigRational::integer(1))));
    for (n, (p, q)) in (2..).zip(published) {
        let expected = -ratio(p, q) * BigRational::integer(2).pow(n);
        assert_eq!(k.coefficient(&Monomial::new(&[n as u32])?), Some(&expected), "I^{n}");
    }
    Ok(())
}

#[test]
fn the_pendulum_s_normal_form_inverts_the_elliptic_integral() -> Result<(), Error> {
    // With m = (K + 1)/2, K = p²/2 − cos q: dI/dm = (4/π) K_elliptic(m) = 2 Σ (C(2j, j)/4^j)² m^j. So I(m(I)) = I.
    let (order, names) = (30, ["I"]);
    let space = PhaseSpace::new(&[("q", "p")])?;
    let k = normalize(&pendulum(order as u32 + 2)?, order, &space)?.in_actions()?;
    let m = k.over(2)?;
    let kept = Truncation::total(order as u32 / 2 + 1);
    let (mut action, mut power, mut c) = (Rational::zero(), m.clone(), BigRational::integer(1));
    for j in 0..=order as i64 / 2 {
        action += &power.scale(&(&c * &c * ratio(2, j + 1)));
        power = power.multiply_truncated(&m, &kept)?;
        c *= ratio(2 * j + 1, 2 * j + 2);
    }
    assert_eq!(action, Polynomial::parse("I", &names)?);
    assert_eq!(k.len(), 16);
    Ok(())
}

#[test]
fn the_rigid_body_as_any_hamiltonian_has_the_triaxiality_polynomials() -> Result<(), Error> {
    // Theory §2 in x, X with M = 1, in units of γ/(2C) and without the constant: κ [(1+β)x² + (1−β)X²] (1 − (x²+X²)/4).
    // β = 3/5: κ = 5/4, frequency 2. K = Σ P_n κⁿ Lⁿ⁺¹ (theory §4).
    let (order, space) = (8, PhaseSpace::new(&[("x", "X")])?);
    let h: Rational = space.parse("5/4*(8/5*x^2 + 2/5*X^2)*(1 - (x^2 + X^2)/4)")?;
    let normal_form = normalize(&h, 2 * order, &space)?;
    assert_eq!(normal_form.modes(), [Mode::Elliptic { frequency: ratio(2, 1), ratio: ratio(1, 2) }]);
    let (k, rigid) = (normal_form.in_actions()?, NormalForm::new(order)?);
    for n in 0..=order {
        let polynomial = rigid.triaxiality_polynomial(n)?.iter();
        let value: BigRational = polynomial.map(|(&power, c)| c * ratio(3, 5).pow(power as i32)).sum();
        let expected = value * ratio(5, 4).pow(n as i32);
        assert_eq!(k.coefficient(&Monomial::new(&[n as u32 + 1])?), Some(&expected), "P_{n}");
    }
    Ok(())
}

/// Frequencies 3 (a = 9/2, b = 2) and −1 (a = −1/4, b = −4), a parameter, no symmetry.
fn mixed() -> Result<(PhaseSpace, Rational), Error> {
    let space = plane()?.with_parameters(&["c"])?;
    let h = space.parse("7 - c + 9/4*X^2 + x^2 - Y^2/8 - 2*y^2 + c*x^3 + x*X*y - Y^3/2 + c*x^2*Y^2 + y^4")?;
    Ok((space, h))
}

#[test]
fn the_transformation_takes_the_hamiltonian_to_its_normal_form_and_back() -> Result<(), Error> {
    let (order, (space, h)) = (4, mixed()?);
    let resonances = Resonances::new(&[&[1, 3]])?;
    let normal_form = normalize_with(&h, order, &space, &resonances, &mut quiet)?;
    let centre = |frequency, ratio| Mode::Elliptic { frequency, ratio };
    assert_eq!(normal_form.modes(), [centre(ratio(3, 1), ratio(3, 2)), centre(ratio(-1, 1), ratio(1, 4))]);
    assert_eq!(normal_form.offset(), &space.parse("7 - c")?);
    let k = normal_form.in_real()?;
    assert_eq!(normal_form.direct(&h)?, k);
    assert_eq!(normal_form.inverse(&k)?, h);
    // K commutes with the quadratic part, and it has resonant terms: it is not a function of the actions.
    let quadratic = h.filter(|monomial, _| monomial.degree_in(&[0, 1, 2, 3]) == 2);
    assert!(space.poisson()?.bracket(&quadratic, &k)?.is_zero());
    let resonant = normal_form.in_actions().err().map(|error| error.to_string());
    assert_eq!(
        resonant.as_deref(),
        Some("the normal form is not a function of the actions alone: it contains u_x^2*U_x*u_y^3*c")
    );
    Ok(())
}

#[test]
fn the_transformation_is_canonical_and_inverse_undoes_direct() -> Result<(), Error> {
    let (order, (space, h)) = (3, mixed()?);
    let resonances = Resonances::new(&[&[1, 3]])?;
    let normal_form = normalize_with(&h, order, &space, &resonances, &mut quiet)?;
    let poisson = space.poisson()?;
    let phase = [0, 1, 2, 3];
    let images = |direct: bool| {
        let image = |slot| {
            let variable = Polynomial::variable(slot)?;
            if direct { normal_form.direct(&variable) } else { normal_form.inverse(&variable) }
        };
        phase.map(image).into_iter().collect::<Result<Vec<_>, Error>>()
    };
    let (direct, inverse) = (images(true)?, images(false)?);
    let kept = Truncation::partial(&phase, order as u32)?;
    for images in [&direct, &inverse] {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let bracket = poisson.bracket(&images[i], &images[j])?.truncate(&kept);
            let expected = i64::from(i % 2 == 0 && j == i + 1);
            assert_eq!(bracket, Polynomial::constant(BigRational::integer(expected)), "{i}, {j}");
        }
    }
    let kept = Truncation::partial(&phase, order as u32 + 1)?;
    let replacements: Vec<_> = phase.into_iter().zip(&inverse).collect();
    for (slot, image) in direct.iter().enumerate() {
        assert_eq!(image.compose(&replacements, Some(&kept))?, Polynomial::variable(slot)?);
    }
    // The first order is the bracket with the generating function.
    let [x, first] = [Polynomial::variable(0)?, normal_form.generator(1)?];
    let change = normal_form.direct(&x)?.filter(|monomial, _| monomial.degree_in(&phase) == 2);
    assert_eq!(poisson.bracket(&x, &first)?, change);
    Ok(())
}

#[test]
fn a_parameter_is_a_number_put_in_later() -> Result<(), Error> {
    let (space, h) = mixed()?;
    let resonances = Resonances::new(&[&[1, 3]])?;
    let run = |h: &Rational| normalize_with(h, 4, &space, &resonances, &mut quiet);
    let value = ratio(-2, 3);
    let (symbolic, numeric) = (run(&h)?.in_real()?, run(&h.evaluate_partial(4, &value)?)?.in_real()?);
    assert!(symbolic.terms().any(|(monomial, _)| monomial.exponent(4) == 4));
    assert_eq!(symbolic.evaluate_partial(4, &value)?, numeric);
    Ok(())
}

#[test]
fn a_negative_mode_has_the_mirrored_normal_form() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("q", "p")])?;
    let h = pendulum(10)?;
    let (up, down) = (normalize(&h, 8, &space)?, normalize(&-&h, 8, &space)?);
    assert_eq!(down.frequencies(), [Complex::integer(-1)]);
    assert_eq!(down.in_actions()?, -&up.in_actions()?);
    Ok(())
}

#[test]
fn floats_agree_with_the_exact_normal_form() -> Result<(), Error> {
    // Coefficients to order 8 reach some 10³ and sum fewer than 10⁴ rounded products each: 10³ · 10⁴ · 1e-16 = 1e-9 relative
    // to the largest of a degree.
    let (space, h) = (plane()?, henon_heiles()?);
    let exact = one_to_one(&h, 8, &space)?.in_complex();
    let resonances = Resonances::new(&[&[1, -1]])?;
    let float = h.map(|c| c.to_f64().unwrap_or(f64::NAN));
    let float = normalize_with(&float, 8, &space, &resonances, &mut quiet)?.in_complex();
    for (monomial, c) in exact.terms() {
        let found = float.coefficient(&monomial).copied().unwrap_or_default();
        let expected = Complex::new(c.re.to_f64().unwrap_or(f64::NAN), c.im.to_f64().unwrap_or(f64::NAN));
        assert!((found - expected).norm() < 1e-9 * (1.0 + expected.norm()), "{monomial:?}: {found} against {expected}");
    }
    assert!(float.terms().all(|(monomial, c)| exact.coefficient(&monomial).is_some() || c.norm() < 1e-9));
    Ok(())
}

#[test]
fn a_wide_bound_keeps_a_resonance_that_is_not_exact() -> Result<(), Error> {
    // Frequencies 1 and 2.02, as 1:2 within 1 %: the term is kept, and the divisor 0.02 divides nothing.
    let space = plane()?;
    let h = space.parse::<BigRational>("(x^2 + X^2)/2 + 1.01*(y^2 + Y^2) + x^2*y")?;
    let wide = Resonances::new(&[&[2, -1]])?.with_smallest_divisor(0.05)?;
    let kept = normalize_with(&h, 1, &space, &wide, &mut quiet)?.in_complex().homogeneous_part(3);
    assert!(kept.len() == 2 && kept.coefficient(&Monomial::new(&[0, 2, 1])?).is_some());
    let removed = normalize(&h, 2, &space)?.in_actions()?;
    // Perturbation theory by hand: x²y couples with 1/(2ω₁ − ω₂) = −1/0.02 in the term I_x².
    let size = removed.coefficient(&Monomial::new(&[2])?).and_then(ToPrimitive::to_f64).unwrap_or(0.0);
    assert!(size.abs() > 1.0, "{size}");
    Ok(())
}

#[test]
fn order_zero_is_the_quadratic_part_and_higher_terms_do_not_matter() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("q", "p")])?;
    let normal_form = normalize(&pendulum(10)?, 0, &space)?;
    assert_eq!(normal_form.in_actions()?, Polynomial::parse("I", &["I"])?);
    assert_eq!(normal_form.direct(&space.parse("q + q^2")?)?, space.parse("q")?);
    assert_eq!(normalize(&pendulum(10)?, 4, &space)?, normalize(&pendulum(6)?, 4, &space)?);
    Ok(())
}

#[test]
fn four_degrees_of_freedom_fit() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("a", "A"), ("b", "B"), ("c", "C"), ("d", "D")])?;
    let h = space.parse::<BigRational>(
        "(a^2 + A^2)/2 + 7/4*(b^2 + B^2) + 29/6*(c^2 + C^2) + 101/8*(d^2 + D^2) + a*b*c + b^2*d + c^3 + d^4",
    )?;
    let normal_form = normalize(&h, 2, &space)?;
    assert_eq!(normal_form.direct(&h)?, normal_form.in_real()?);
    assert_eq!(normal_form.in_actions()?.homogeneous_part(1).len(), 4);
    Ok(())
}
