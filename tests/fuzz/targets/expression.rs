//! Any text as a polynomial: an error, or a polynomial that is printed and read back to itself; small ones are normalized too.
#![no_main]

use andoyer_series::{PhaseSpace, Polynomial, normalize};
use andoyer_series::num_complex::Complex;
use andoyer_series::num_rational::BigRational;
use libfuzzer_sys::fuzz_target;

const NAMES: [&str; 4] = ["x", "X", "y", "Y"];
/// Of what is normalized: the bytes of the text, the terms and degree of the polynomial.
const LONGEST: usize = 200;
const TERMS: usize = 12;
const DEGREE: u32 = 6;

fuzz_target!(|text: &str| {
    if let Ok(exact) = Polynomial::<Complex<BigRational>>::parse(text, &NAMES) {
        if exact.terms().count() <= 100 {
            let printed = exact.display(&NAMES).to_string();
            // Printing may exceed the bounds of reading, never change the value.
            if let Ok(again) = Polynomial::parse(&printed, &NAMES) {
                assert_eq!(again, exact);
            }
        }
    }
    let Ok(float) = Polynomial::<f64>::parse(text, &NAMES) else { return };
    assert!(float.terms().all(|(_, c)| c.is_finite()));
    let small = text.len() <= LONGEST && float.terms().count() <= TERMS && float.terms().all(|(m, _)| m.degree_in(&[0, 1, 2, 3]) <= DEGREE);
    if small {
        let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")]).expect("two pairs");
        if let Ok(form) = normalize(&float, 3, &space) {
            assert!(form.in_actions().is_ok_and(|k| k.terms().all(|(_, c)| c.is_finite())));
        }
    }
});
