//! Normal forms about equilibria with gyroscopic terms and saddles: the triangular and the collinear points of the restricted problem.

use andoyer_series::birkhoff::{Mode, Resonances};
use andoyer_series::progress::quiet;
use andoyer_series::{
    BirkhoffMap, BirkhoffNormalForm, Error, Monomial, PhaseSpace, Polynomial, normalize, normalize_with,
};

use crate::hamiltonians::{collinear, distance, space, triangular};

/// Earth and Moon.
const MU: f64 = 0.012150585609624;

/// Frequencies ω₁ > ω₂ > 0 of the planar motion about L4: ω⁴ − ω² + 27 μ(1−μ)/4 = 0.
fn frequencies(mu: f64) -> (f64, f64) {
    let root = (1.0 - 27.0 * mu * (1.0 - mu)).sqrt();
    (((1.0 + root) / 2.0).sqrt(), ((1.0 - root) / 2.0).sqrt())
}

/// A, B, C of K₄ = ½ (A I₁² + 2B I₁ I₂ + C I₂²) for K₂ = ω₁ I₁ − ω₂ I₂, after A. Deprit and A. Deprit-Bartholomé, Astron. J. 72 (1967) 173.
fn published(mu: f64) -> [f64; 3] {
    let (first, second) = frequencies(mu);
    let own = |a: f64, b: f64| {
        let (a, b) = (a * a, b * b);
        b * (81.0 - 696.0 * a + 124.0 * a * a) / (72.0 * (1.0 - 2.0 * a).powi(2) * (1.0 - 5.0 * a))
    };
    let product = (first * second).powi(2);
    let mixed = -first * second * (43.0 + 64.0 * product) / (6.0 * (4.0 * product - 1.0) * (25.0 * product - 4.0));
    [own(first, second), mixed, own(second, first)]
}

/// The planar normal form about L4 to degree 4; I₁ in slot 0, I₂ in slot 1.
fn triangle(mu: f64) -> Result<BirkhoffNormalForm<f64>, Error> {
    let plane = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?;
    let h = triangular(mu, 4)?.filter(|monomial, _| monomial.degree_in(&[4, 5]) == 0);
    normalize(&h, 2, &plane)
}

fn second_order(mu: f64) -> Result<[f64; 3], Error> {
    let k = triangle(mu)?.in_actions()?;
    let c = |i, j| Ok::<_, Error>(k.coefficient(&Monomial::new(&[i, j])?).copied().unwrap_or_default());
    Ok([2.0 * c(2, 0)?, c(1, 1)?, 2.0 * c(0, 2)?])
}

#[test]
fn the_triangular_point_has_the_published_frequencies_and_second_order() -> Result<(), Error> {
    let accurate = [0.015, 0.0215, 0.03, 0.035];
    for mu in [0.001, 0.0025, 0.005, 0.0080, 0.009, MU].into_iter().chain(accurate) {
        let (first, second) = frequencies(mu);
        let normal_form = triangle(mu)?;
        let found: Vec<f64> = normal_form.frequencies().iter().map(|omega| omega.re).collect();
        // The long-period mode has negative energy. Rounding of ω₂² = (1 − root)/2: 1e-16/ω₂.
        assert!(
            (found[0] - first).abs() < 1e-14 && (found[1] + second).abs() < 1e-14,
            "{mu}: {found:?} {first} {second}"
        );
        // K₂ = ω₁I₁ − ω₂I₂, so the mixed coefficient is theirs. Towards μ = 0 terms of the size ω₂⁻⁴ cancel: changing the last bit of the
        // Hamiltonian's coefficients moves the result by 1e-13 ω₂⁻⁴, 2e-9 at μ = 0.001.
        let tolerance = if accurate.contains(&mu) { 1e-12 } else { 1e-13 / second.powi(4) };
        for (found, published) in second_order(mu)?.into_iter().zip(published(mu)) {
            let error = (found - published).abs() / published.abs().max(1.0);
            assert!(error < tolerance, "{mu}: {found} {published} {error:e}");
        }
    }
    Ok(())
}

#[test]
fn the_second_order_at_the_triangular_point_vanishes_where_arnold_s_condition_fails() -> Result<(), Error> {
    // A ω₂² + 2B ω₁ω₂ + C ω₁² = 0 at μ = 0.0109136676…
    let determinant = |mu: f64| {
        let ([a, b, c], (first, second)) = (second_order(mu)?, frequencies(mu));
        Ok::<_, Error>(a * second * second + 2.0 * b * first * second + c * first * first)
    };
    let (mut low, mut high) = (0.0109, 0.01093);
    assert!(determinant(low)? * determinant(high)? < 0.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if determinant(low)? * determinant(middle)? <= 0.0 { high = middle } else { low = middle }
    }
    assert!((low - 0.010_913_667_6).abs() < 1e-10, "{low}");
    Ok(())
}

#[test]
fn routh_s_mass_ratio_is_defective_and_a_larger_one_is_a_quartet() -> Result<(), Error> {
    let routh = (1.0 - 69.0_f64.sqrt() / 9.0) / 2.0;
    let defective = triangle(routh);
    assert!(
        matches!(&defective, Err(Error::Defective { pairs, eigenvalue, .. })
            if pairs == "(x, X), (y, Y)" && eigenvalue.starts_with("±0.70710")),
        "{defective:?}"
    );
    let unstable = triangle(0.1)?;
    let [Mode::Complex { rate, frequency, partner: 1 }, Mode::Complex { partner: 0, .. }] = unstable.modes() else {
        panic!("{:?}", unstable.modes())
    };
    // λ² = (−1 ± √(1 − 27μ(1−μ)))/2 = (σ + iν)²
    let square = (rate * rate - frequency * frequency, 2.0 * rate * frequency);
    assert!((square.0 + 0.5).abs() < 1e-14 && (square.1 - (27.0 * 0.09_f64 - 1.0).sqrt() / 2.0).abs() < 1e-14);
    Ok(())
}

/// The centre manifold of L1 or L2 of Earth and Moon, to a degree.
fn manifold(second: bool, order: usize) -> Result<BirkhoffNormalForm<f64>, Error> {
    let h = collinear(MU, second, order as u32 + 2)?;
    normalize_with(&h, order, &space()?, &Resonances::default().with_centre(), &mut quiet)
}

#[test]
fn the_collinear_points_have_a_saddle_and_two_centres_with_the_known_eigenvalues() -> Result<(), Error> {
    for second in [false, true] {
        let gamma = distance(MU, second);
        let far = if second { 1.0 + gamma } else { 1.0 - gamma };
        let c2 = (MU + (1.0 - MU) * (gamma / far).powi(3)) / gamma.powi(3);
        let root = (9.0 * c2 * c2 - 8.0 * c2).sqrt();
        let (saddle, centre) = (((c2 - 2.0 + root) / 2.0).sqrt(), ((2.0 - c2 + root) / 2.0).sqrt());
        let found = manifold(second, 0)?;
        let [Mode::Hyperbolic { rate }, Mode::Elliptic { frequency, .. }, Mode::Elliptic { frequency: vertical, .. }] =
            found.modes()
        else {
            panic!("{:?}", found.modes())
        };
        for (found, expected) in [(rate, saddle), (frequency, centre), (vertical, c2.sqrt())] {
            assert!((found - expected).abs() < 4e-15 * expected, "{found} {expected}");
        }
    }
    Ok(())
}

/// H in closed form, about the collinear point in units of γ, without the constant.
fn energy(z: &[f64], second: bool) -> f64 {
    let gamma = distance(MU, second);
    let (x, y, height) = (z[0], z[2], z[4]);
    let kinetic = (z[1] * z[1] + z[3] * z[3] + z[5] * z[5]) / 2.0 + y * z[1] - x * z[3];
    let own = if second { -1.0 } else { 1.0 };
    let (near, far) = (own, -(if second { 1.0 + gamma } else { 1.0 - gamma }) / gamma);
    let potential = |mass: f64, at: f64| {
        let distance = ((x - at).powi(2) + y * y + height * height).sqrt();
        // Less the value and the slope at the origin.
        mass * (1.0 / distance - 1.0 / at.abs() - x * at / at.abs().powi(3))
    };
    kinetic - (potential(MU, near) + potential(1.0 - MU, far)) / gamma.powi(3)
}

#[test]
fn the_centre_manifold_carries_the_energy_of_the_full_problem_better_with_every_order() -> Result<(), Error> {
    let normal = [0.0, 0.0, 0.12, 0.0, 0.08, 0.05];
    for second in [false, true] {
        let error = |order: usize| {
            let form = manifold(second, order)?;
            let map = BirkhoffMap::new(&form, &[])?;
            let state = map.from_normal(&normal)?;
            Ok::<_, Error>((energy(&state, second) - form.centre_manifold()?.evaluate(&normal)?).abs())
        };
        let errors: Vec<f64> = [0, 4, 8].into_iter().map(error).collect::<Result<_, _>>()?;
        assert!(errors.windows(2).all(|pair| pair[1] < 0.01 * pair[0]), "{errors:?}");
    }
    Ok(())
}

#[test]
fn the_transformation_about_a_saddle_takes_the_hamiltonian_to_its_normal_form_and_back() -> Result<(), Error> {
    let order = 4;
    let h = collinear(MU, false, order as u32 + 2)?;
    for resonances in [Resonances::default(), Resonances::default().with_centre()] {
        let form = normalize_with(&h, order, &space()?, &resonances, &mut quiet)?;
        let close = |a: &Polynomial<f64>, b: &Polynomial<f64>| {
            let largest = |p: &Polynomial<f64>| p.terms().map(|(_, c)| c.abs()).fold(0.0, f64::max);
            assert!(largest(&(a - b)) < 1e-11 * largest(a), "{:e} {:e}", largest(&(a - b)), largest(a));
        };
        close(&form.direct(&h)?, &form.in_real()?);
        close(&form.inverse(&form.in_real()?)?, &h);
    }
    Ok(())
}

/// The Hamiltonian on the centre manifold to degree 10 by another program, in its own variables (see tests/data/README.md), as exponents and coefficients.
fn other_program(point: &str) -> Result<(f64, Polynomial<f64>), Error> {
    let data: serde_json::Value =
        serde_json::from_str(include_str!("../../../../tests/data/hiten_centre_manifolds.json"))
            .expect("the file of tests/data");
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
    let mut h = Polynomial::zero();
    for term in data[point]["terms"].as_array().into_iter().flatten() {
        let exponents: Vec<u32> = serde_json::from_value(term[0].clone()).expect("exponents");
        h.add_term(Monomial::new(&exponents)?, &number(&term[1]));
    }
    Ok((number(&data["mu"]), h))
}

#[test]
fn the_centre_manifolds_of_another_program_have_the_same_normal_form() -> Result<(), Error> {
    // Coordinates on a centre manifold are no invariants, its normal form in the actions is: K(0, I₂, I₃) to degree 10 from the whole problem here, and from
    // hiten's reduced Hamiltonian.
    let plane = PhaseSpace::new(&[("y", "Y"), ("z", "Z")])?;
    for (point, second) in [("L1", false), ("L2", true)] {
        let (mu, reduced) = other_program(point)?;
        assert!(reduced.degree() == Some(10));
        let theirs = normalize(&reduced, 8, &plane)?.in_actions()?;
        let ours = normalize(&collinear(mu, second, 10)?, 8, &space()?)?.in_actions()?;
        let mut compared = 0;
        for (monomial, c) in ours.terms().filter(|(monomial, _)| monomial.exponent(0) == 0) {
            let their = Monomial::new(&[monomial.exponent(1), monomial.exponent(2)])?;
            let found = theirs.coefficient(&their).copied().unwrap_or_default();
            let largest = ours.homogeneous_part(monomial.total_degree());
            let largest = largest.terms().map(|(_, c)| c.abs()).fold(0.0, f64::max);
            // The frequencies of the centres differ by 3 %: divisors of 0.13 multiply rounding from order to order.
            assert!((found - c).abs() < 1e-8 * largest, "{point} {monomial:?}: {found} {c}");
            compared += 1;
        }
        assert_eq!(compared, 2 + 3 + 4 + 5 + 6);
    }
    Ok(())
}
