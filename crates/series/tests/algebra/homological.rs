//! The homological equation closes, and the kernel is what commutes with the unperturbed motion.

use crate::strategies::{gaussian_polynomial, rational_polynomial};
use andoyer_series::lie::{Homological, Poisson};
use andoyer_series::{Coefficient, Error, Polynomial};
use num_complex::Complex;
use num_rational::BigRational;
use proptest::prelude::*;

fn closes<C: Coefficient>(h: &Polynomial<C>, eigenvalues: [C; 2]) -> Result<(), TestCaseError> {
    let [first, second] = eigenvalues;
    let (homological, poisson) =
        (Homological::new(&[(0, 1, first), (2, 3, second)])?, Poisson::new(&[(0, 1), (2, 3)])?);
    let unperturbed = homological.unperturbed()?;
    let (kernel, image) = homological.split(h);
    prop_assert_eq!(&(&kernel + &image), h);
    prop_assert!(poisson.bracket(&unperturbed, &kernel)?.is_zero());
    let generator = homological.solve(&image)?;
    prop_assert!((&poisson.bracket(&unperturbed, &generator)? + &image).is_zero());
    // L_h0 S = {S; h0} = image, as theory §3 has it.
    prop_assert_eq!(poisson.lie_derivative(&unperturbed, &generator)?, image);
    prop_assert!(homological.split(&generator).0.is_zero());
    Ok(())
}

proptest! {
    #[test]
    fn without_and_with_a_resonance(h in rational_polynomial(), p in -3_i64..4, q in 1_i64..4) {
        let ratio = BigRational::new(p.into(), q.into());
        closes(&h, [BigRational::integer(1), ratio])?; // p/q of small terms: resonances occur, and λ = 0 too
    }

    #[test]
    fn with_imaginary_eigenvalues(h in gaussian_polynomial(), p in -3_i64..4) {
        let i = Complex::new(BigRational::integer(0), BigRational::integer(1));
        closes(&h, [i.clone(), i.times(p)])?;
    }
}

#[test]
fn the_theory_s_divisors_follow_from_the_main_problem() -> Result<(), Error> {
    // Theory §3 in units of √γ V/C: L_Main(u^j U^k) = i (k−j) u^j U^k with Main = −i uU, and W = i q/((j−k)) u^j U^k.
    let parse = |text| Polynomial::<Complex<BigRational>>::parse(text, &["u", "U"]);
    let minus_i = Complex::new(BigRational::integer(0), BigRational::integer(-1));
    let (homological, poisson) = (Homological::new(&[(0, 1, minus_i)])?, Poisson::new(&[(0, 1)])?);
    assert_eq!(homological.unperturbed()?, parse("-i*u*U")?);
    assert_eq!(poisson.lie_derivative(&parse("-i*u*U")?, &parse("u^3*U")?)?, parse("-2*i*u^3*U")?);
    assert_eq!(homological.solve(&parse("u^3*U")?)?, parse("i/2*u^3*U")?);
    Ok(())
}

#[test]
fn a_kernel_term_has_no_solution() -> Result<(), Error> {
    let homological = Homological::new(&[(0, 1, 1.0)])?;
    let resonant = Polynomial::parse("q^2*p^2", &["q", "p"])?;
    assert!(matches!(homological.solve(&resonant), Err(Error::Resonant { exponents: [2, 2, 0, 0, 0, 0, 0, 0] })));
    assert!(matches!(Homological::new(&[(0, 1, 1.0), (1, 2, 1.0)]), Err(Error::SlotRepeated { slot: 1 })));
    assert!(matches!(Homological::new(&[(8, 1, 1.0)]), Err(Error::SlotOutOfRange { slot: 8, .. })));
    Ok(())
}
