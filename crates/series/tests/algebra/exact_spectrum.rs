//! The spectrum of a quadratic part over the rationals: modes of known frequencies behind integer shears, and what has no rational form.

use andoyer_series::birkhoff::Mode;
use andoyer_series::num_rational::BigRational;
use andoyer_series::real_field::RealField;
use andoyer_series::{BirkhoffNormalForm, Coefficient, Error, PhaseSpace, Polynomial, normalize};
use proptest::prelude::*;

const PAIRS: [(&str, &str); 4] = [("a", "A"), ("b", "B"), ("c", "C"), ("d", "D")];

/// A shear z → z + c f {z; f} along the form f = zᵢ + zⱼ. It is linear and symplectic.
type Shear = (usize, usize, i64);

type Form = BirkhoffNormalForm<BigRational>;

/// The Hamiltonian `text` in `pairs` pairs behind shears, and its form of order 0.
fn sheared(text: &str, pairs: usize, shears: &[Shear]) -> Result<(Form, Polynomial<BigRational>), Error> {
    let space = PhaseSpace::new(&PAIRS[..pairs])?;
    let mut h = space.parse(text)?;
    for &(i, j, c) in shears {
        let form = &Polynomial::<BigRational>::variable(i)? + &Polynomial::variable(j)?;
        let image = |slot: usize| {
            let z = Polynomial::variable(slot)?;
            let rate = space.poisson()?.bracket(&z, &form)?;
            Ok(&z + &form.multiply(&rate.scale(&BigRational::integer(c)))?)
        };
        let images = (0..2 * pairs).map(image).collect::<Result<Vec<_>, Error>>()?;
        h = h.compose(&images.iter().enumerate().collect::<Vec<_>>(), None)?;
    }
    Ok((normalize(&h, 0, &space)?, h))
}

/// The modes in ascending order: ω of a centre, 100 + λ of a saddle, and 1000 + 10 σ + |ν| for both modes of a quartet.
fn labels(form: &Form) -> Vec<f64> {
    let label = |mode: &Mode<BigRational>| match mode {
        Mode::Elliptic { frequency, .. } => frequency.to_float(),
        Mode::Hyperbolic { rate } => 100.0 + rate.to_float(),
        Mode::Complex { rate, frequency, .. } => 1000.0 + 10.0 * rate.to_float() + frequency.to_float().abs(),
        _ => f64::NAN,
    };
    let mut labels: Vec<f64> = form.modes().iter().map(label).collect();
    labels.sort_by(f64::total_cmp);
    labels
}

/// Three modes of rates n/4 or frequencies n/2, and the labels of their form.
fn three_modes(numerators: [i64; 3], saddle: bool) -> (String, Vec<f64>) {
    let mode = |(mode, n): (usize, i64)| match saddle && mode == 0 {
        true => (format!("{}/4*a*A", n.abs()), 100.0 + n.abs() as f64 / 4.0),
        false => (format!("{n}/4*({}^2 + {}^2)", PAIRS[mode].0, PAIRS[mode].1), n as f64 / 2.0),
    };
    let (texts, mut labels): (Vec<_>, Vec<_>) = numerators.into_iter().enumerate().map(mode).unzip();
    labels.sort_by(f64::total_cmp);
    (texts.join(" + ").replace("+ -", "- "), labels)
}

#[track_caller]
fn assert_found(text: &str, pairs: usize, shears: &[Shear], expected: &[f64]) {
    let (form, h) = sheared(text, pairs, shears).unwrap_or_else(|error| panic!("{text}, {shears:?}: {error}"));
    assert_eq!(labels(&form), expected, "{text}, {shears:?}");
    assert_eq!(form.direct(&h).expect("a change"), form.in_real().expect("a form"), "{text}, {shears:?}");
}

#[test]
fn a_frequency_of_multiplicity_three_is_found_behind_shears() {
    // Floats have such an eigenvalue to the cube root of rounding: "±0.500001914i are not rational", "±0.413088895i have a Jordan block".
    for (numerators, shears, saddle) in [
        ([-1, -1, -1], [(1, 2, -2), (3, 3, 3), (2, 2, 2), (3, 0, 2)], false),
        ([1, 7, -1], [(2, 2, -3), (3, 1, 3), (0, 0, 3), (1, 0, 1)], true),
        ([1, 1, 1], [(0, 1, 3), (2, 5, -3), (4, 1, 2), (3, 3, 3)], false),
    ] {
        let (text, expected) = three_modes(numerators, saddle);
        assert_found(&text, 3, &shears, &expected);
    }
}

#[test]
fn quartets_and_repeated_quartets_are_found() {
    // ±3 ± 2i from 3 (a A + b B) − 2 (a B − b A); two equal ones; one with 5/7 and 1/3, beside a centre and a saddle.
    let shears = [(0, 3, 2), (2, 5, -1), (1, 1, 3), (4, 0, -2), (3, 2, 1)];
    let one = "3*(a*A + b*B) - 2*(a*B - b*A)";
    assert_found(one, 2, &[(0, 3, 2), (1, 1, 3)], &[1032.0, 1032.0]);
    assert_found(&format!("{one} + 3/2*(c^2 + C^2)"), 3, &shears, &[3.0, 1032.0, 1032.0]);
    let two = format!("{one} + 3*(c*C + d*D) - 2*(c*D - d*C)");
    assert_found(&two, 4, &[(0, 5, 1), (2, 7, -1), (3, 3, 2)], &[1032.0; 4]);
    let mixed = "5/7*(a*A + b*B) - 1/3*(a*B - b*A) + 1/2*c*C - 5/6*(d^2 + D^2)";
    let quartet = 1000.0 + 10.0 * (5.0 / 7.0) + 1.0 / 3.0;
    assert_found(mixed, 4, &[(0, 5, 1), (2, 7, -1), (3, 3, 2), (6, 1, 1)], &[-5.0 / 3.0, 100.5, quartet, quartet]);
}

#[test]
fn fractions_with_large_denominators_are_found() {
    let shears = [(0, 1, 3), (2, 0, -2), (3, 1, 1)];
    // 1/1000000007 and its neighbour 1/1000000006 differ by 1e-18.
    let text = "1/2000000014*(a^2 + A^2) + 1/2000000012*(b^2 + B^2)";
    let (form, h) = sheared(text, 2, &shears).expect("a form");
    let mut denominators: Vec<String> = form.frequencies().iter().map(|omega| omega.re.denom().to_string()).collect();
    denominators.sort();
    assert_eq!(denominators, ["1000000006", "1000000007"]);
    assert_eq!(form.direct(&h).expect("a change"), form.in_real().expect("a form"));
}

#[test]
fn what_has_no_rational_form_is_named_with_a_true_figure() {
    let shears = [(0, 1, 3), (2, 0, -2), (3, 1, 1), (2, 3, 3)];
    let refused = |text: &str, pairs: usize| sheared(text, pairs, &shears).err().map(|error| error.to_string());
    // √2 beside 1/2 twice; √2 three times; x⁗ − 2 x″ + 2 x = 0, whose λ² = 1 ± i are rational and whose λ are not; x⁗ − 2 x″ − x = 0 with λ² = 1 ± √2;
    // x⁗ + x = 0 with λ² = ±i.
    let cases = [
        ("(a^2 + 2*A^2)/2 + (b^2 + B^2)/4 + (c^2 + C^2)/4", 3, "±1.414213562i"),
        ("(a^2 + 2*A^2 + b^2 + 2*B^2 + c^2 + 2*C^2)/2", 3, "±1.414213562i"),
        ("A*b + B^2/2 - b^2 - a^2", 2, "±1.098684113 ± 0.455089861i"),
        ("A*b + B^2/2 - b^2 + a^2/2", 2, "±0.643594253i"),
        ("A*b + B^2/2 - a^2/2", 2, "±0.707106781 ± 0.707106781i"),
    ];
    for (text, pairs, eigenvalue) in cases {
        let message = refused(text, pairs).unwrap_or_default();
        assert!(message.starts_with(&format!("the eigenvalues {eigenvalue} of ")), "{text}: {message}");
    }
    // A Jordan block: 1/2 twice with one eigenvector.
    let block = "(a*B - b*A)/2 + (a^2 + b^2)/2";
    let message = refused(block, 2).unwrap_or_default();
    assert!(message.contains("the eigenvalues ±0.500000000i have a Jordan block"), "{message}");
    // An eigenvalue 0 is exact too.
    assert!(matches!(sheared("A^2 + b*B", 2, &shears), Err(Error::ZeroFrequency { .. })));
}

#[test]
fn repeated_frequencies_behind_five_shears_are_found() {
    let mut state = 7_u64;
    let mut random = |below: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    for _ in 0..40 {
        let numerators = [1, -1, 2].map(|n: i64| if random(2) == 0 { n } else { 1 });
        let shear = |_: usize| (random(6) as usize, random(6) as usize, random(7) as i64 - 3);
        let shears: [Shear; 5] = std::array::from_fn(shear);
        let (text, expected) = three_modes(numerators, false);
        assert_found(&text, 3, &shears, &expected);
    }
}

proptest! {
    #[test]
    fn rational_frequencies_behind_a_rational_symplectic_change_are_found_exactly(
        numerators in proptest::array::uniform3((-9_i64..=9).prop_filter("a frequency", |n| *n != 0)),
        shears in proptest::collection::vec((0..6_usize, 0..6_usize, -3_i64..=3), 4),
        saddle in any::<bool>(),
    ) {
        let fail = |error: Error| TestCaseError::fail(error.to_string());
        let (text, expected) = three_modes(numerators, saddle);
        let (form, h) = sheared(&text, 3, &shears).map_err(fail)?;
        prop_assert_eq!(labels(&form), expected);
        prop_assert_eq!(form.direct(&h).map_err(fail)?, form.in_real().map_err(fail)?);
    }
}

#[test]
fn fractions_of_many_digits_are_found_or_refused() -> Result<(), Error> {
    // 36 terms in four pairs with a common denominator of some 400 digits: generic, and so irrational.
    let names: Vec<&str> = PAIRS.iter().flat_map(|(q, p)| [*q, *p]).collect();
    let mut state = 11_u64;
    let mut digits = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 24) + 1
    };
    let mut terms = Vec::new();
    for (i, first) in names.iter().enumerate() {
        for second in &names[i..] {
            terms.push(format!("{}/{}*{first}*{second}", digits(), digits()));
        }
    }
    let space = PhaseSpace::new(&PAIRS)?;
    let refused = normalize(&space.parse::<BigRational>(&terms.join(" + "))?, 0, &space);
    assert!(matches!(refused, Err(Error::SpectrumIrrational { .. })), "{refused:?}");
    Ok(())
}
