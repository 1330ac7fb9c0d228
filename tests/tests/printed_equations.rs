//! Every equation that docs/theory.md prints is what the triangle computes.

use andoyer_series::rigid_body::{BETA, TAU, W, W_BAR, hamiltonian};
use andoyer_series::{Monomial, NormalForm, Polynomial};
use andoyer_tests::{equation, equations};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::Zero;

type Gaussian = Complex<BigRational>;
const DOCUMENT: &str = include_str!("../../docs/theory.md");

fn in_beta(text: &str) -> Polynomial<Gaussian> {
    Polynomial::parse(text, &["beta"]).expect("a polynomial in beta")
}

fn gaussian(re: &BigRational) -> Gaussian {
    Complex::new(re.clone(), BigRational::zero())
}

#[test]
fn the_document_prints_ten_polynomials_of_each_kind_and_five_generators() {
    let names: Vec<String> = equations(DOCUMENT).into_iter().map(|(name, _)| name).collect();
    let count = |kind: &str| names.iter().filter(|name| name.starts_with(kind)).count();
    assert_eq!((count("P_"), count("p_"), count("s_")), (10, 10, 5));
}

#[test]
fn triaxiality_polynomials_are_as_printed() {
    let normal_form = NormalForm::new(9).expect("order 9");
    for n in 0..=9 {
        let real = normal_form.triaxiality_polynomial(n).expect("n ≤ 9");
        let terms = real.iter().map(|(&l, c)| (Monomial::new(&[l]).expect("small"), gaussian(c)));
        assert_eq!(in_beta(&equation(DOCUMENT, &format!("P_{n}"))), Polynomial::from_terms(terms), "P_{n}");
        let paper = normal_form.paper_polynomial(n).expect("n ≤ 9");
        let terms = paper.iter().map(|(&l, c)| (Monomial::new(&[l]).expect("small"), c.clone()));
        assert_eq!(in_beta(&equation(DOCUMENT, &format!("p_{n}"))), Polynomial::from_terms(terms), "p_{n}");
    }
}

#[test]
fn generating_functions_are_as_printed() {
    let normal_form = NormalForm::new(5).expect("order 5");
    let mut factorial = 1;
    for m in 1..=5 {
        let text = format!("{factorial}*beta*(u^2 + U^2)*({})", equation(DOCUMENT, &format!("s_{m}")));
        let printed = Polynomial::<Gaussian>::parse(&text, &["u", "U", "beta"]).expect("a polynomial");
        let generator = normal_form.generator(m).expect("m ≤ 5");
        let terms = generator.iter().map(|(&(j, k, l), c)| (Monomial::new(&[j, k, l]).expect("small"), c.clone()));
        assert_eq!(printed, Polynomial::from_terms(terms), "S_{m}");
        factorial *= m;
    }
}

#[test]
fn the_hamiltonian_in_w_is_the_printed_one_in_u_and_its_conjugate() {
    // u = i w̄, U = w: the slots of the rational pair are W_BAR and W.
    let mut names = [""; 4];
    (names[W_BAR], names[W], names[TAU], names[BETA]) = ("v", "w", "tau", "beta");
    let text = equation(DOCUMENT, "H");
    let text = text.replace('u', "(i*v)").replace("ta(i*v)", "tau").replace('U', "w");
    let printed = Polynomial::<Gaussian>::parse(&text, &names).expect("a polynomial");
    let [main, perturbation] = hamiltonian::<Gaussian>().expect("a field");
    assert_eq!(printed, &main + &perturbation);
}
