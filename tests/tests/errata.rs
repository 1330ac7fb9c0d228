//! Each misprint that docs/errata.md lists fails as printed and holds as corrected.

use andoyer_series::lie::{LieTransform, Poisson};
use andoyer_series::{Monomial, NormalForm, Polynomial};
use andoyer_tests::equation;
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::Zero;

type Gaussian = Complex<BigRational>;
const ERRATA: &str = include_str!("../../docs/errata.md");
const THEORY: &str = include_str!("../../docs/theory.md");
/// Slots of u, U, β, τ.
const NAMES: [&str; 4] = ["u", "U", "beta", "tau"];
const ORDER: u32 = 4;

fn parse(text: &str) -> Polynomial<Gaussian> {
    Polynomial::parse(text, &NAMES).expect("a polynomial")
}

/// Whether Σ c u^j U^k … is real where U = i ū: the term u^j U^k is then i^k u^j ū^k, and that of (k, j) must be its conjugate.
fn is_real(f: &Polynomial<Gaussian>) -> bool {
    let power = |k: u32| [(1, 0), (0, 1), (-1, 0), (0, -1)][(k % 4) as usize];
    let turned = |c: &Gaussian, k: u32| {
        let (re, im) = power(k);
        let integer = |n: i32| BigRational::from_integer(n.into());
        c * Complex::new(integer(re), integer(im))
    };
    f.terms().all(|(monomial, c)| {
        let [j, k, beta, tau, ..] = monomial.exponents();
        let mirrored = Monomial::new(&[k, j, beta, tau]).expect("small");
        let other = f.coefficient(&mirrored).cloned().unwrap_or_else(Gaussian::zero);
        turned(c, k) == turned(&other, j).conj()
    })
}

/// β (u² + U²) s_m: S_m/(m−1)! without its power of α/(√γ V), which is τ here.
fn scaled_generator(s: &str, m: u32) -> Polynomial<Gaussian> {
    parse(&format!("beta*(u^2 + U^2)*({s})*tau^{m}"))
}

/// Order n of the Hamiltonian transformed with the generators given: its terms that are no powers of uU.
fn left_outside_the_kernel(generators: Vec<Polynomial<Gaussian>>, n: usize) -> Polynomial<Gaussian> {
    let hamiltonian = parse(&equation(THEORY, "H"));
    let (main, perturbation) = (hamiltonian.part(3, 0).expect("a slot"), hamiltonian.part(3, 1).expect("a slot"));
    let transform = LieTransform::new(Poisson::new(&[(0, 1)]).expect("a pair"), generators);
    let main = transform.direct(&main).expect("no overflow");
    let perturbation = transform.direct(&perturbation).expect("no overflow");
    let whole = &main[n] + &perturbation[n - 1];
    whole.filter(|monomial, _| monomial.exponent(0) != monomial.exponent(1))
}

#[test]
fn printed_triaxiality_polynomials_make_the_normal_form_imaginary_or_wrong() {
    let normal_form = NormalForm::new(4).expect("order 4");
    for n in 2..=4_usize {
        let energy = |kind: &str| {
            let p = equation(ERRATA, &format!("{kind} p_{n}"));
            parse(&format!("({p})*(u*U)^{}", n + 1))
        };
        let exact = normal_form.paper_polynomial(n).expect("n ≤ 4");
        let power = n as u32 + 1;
        let terms = exact.iter().map(|(&l, c)| (Monomial::new(&[power, power, l]).expect("small"), c.clone()));
        let exact = Polynomial::from_terms(terms);
        assert_eq!(energy("correct"), exact, "n = {n}");
        assert!(is_real(&energy("correct")), "n = {n}");
        assert_ne!(energy("printed"), exact, "n = {n}");
        assert_eq!(
            is_real(&energy("printed")),
            n % 2 == 1,
            "n = {n}: imaginary for even n, of the wrong sign for n = 3"
        );
    }
}

#[test]
fn printed_generators_are_not_real_or_leave_the_homological_equation_open() {
    let correct: Vec<_> = (1..=ORDER).map(|m| scaled_generator(&equation(THEORY, &format!("s_{m}")), m)).collect();
    for m in 1..=ORDER {
        let n = m as usize;
        let stated = scaled_generator(&equation(ERRATA, &format!("correct s_{m}")), m);
        assert_eq!(stated, correct[n - 1], "the two documents agree on s_{m}");
        assert!(is_real(&stated), "S_{m}");
        assert!(left_outside_the_kernel(correct[..n].to_vec(), n).is_zero(), "order {m} closes");
        let printed = scaled_generator(&equation(ERRATA, &format!("printed s_{m}")), m);
        // (m − 1)! i^m: imaginary for odd m, of the wrong sign for m = 2, six times too large for m = 4.
        assert_eq!(is_real(&printed), m % 2 == 0, "printed S_{m}");
        let mut generators = correct[..n - 1].to_vec();
        generators.push(printed);
        assert!(!left_outside_the_kernel(generators, n).is_zero(), "order {m} as printed stays open");
    }
}

#[test]
fn printed_lie_derivative_is_not_the_slope_of_the_main_part() {
    let names = ["V", "u", "U", "g"];
    let read = |name: &str| Polynomial::<Gaussian>::parse(&equation(ERRATA, name), &names).expect("a polynomial");
    let slope = read("main").derivative(0).expect("a slot");
    assert_eq!(read("correct slope"), slope);
    assert_ne!(read("printed slope"), slope);
}

#[test]
fn printed_gravity_gradient_generator_leaves_its_homological_equation_open() {
    let names = ["z", "Z", "q"];
    let read = |name: &str| Polynomial::<Gaussian>::parse(&equation(ERRATA, name), &names).expect("a polynomial");
    // ∂/∂y of z = e^(i(2y+φ)) and of its conjugate.
    let slope = |f: &Polynomial<Gaussian>| {
        let times = |slot: usize, factor: &str| {
            let derivative = f.derivative(slot).expect("a slot");
            derivative.multiply(&Polynomial::parse(factor, &names).expect("a factor")).expect("small")
        };
        &times(0, "2*i*z") + &times(1, "-2*i*Z")
    };
    assert_eq!(slope(&read("correct W")), read("harmonic"));
    assert_ne!(slope(&read("printed W")), read("harmonic"));
}
