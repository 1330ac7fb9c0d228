//! The frequency of a quartic oscillator by its normal form, exact, and in numbers: H = (p² + q²)/2 + q⁴/4.

#![expect(clippy::print_stdout, reason = "an example prints what it computes")]

use andoyer_series::num_rational::BigRational;
use andoyer_series::{BirkhoffMap, Error, PhaseSpace, normalize};

fn main() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("q", "p")])?;
    let hamiltonian = space.parse::<BigRational>("(p^2 + q^2)/2 + q^4/4")?;
    let form = normalize(&hamiltonian, 6, &space)?;
    println!("K = {form}");
    assert_eq!(form.to_string(), "I_q + 3/8*I_q^2 - 17/64*I_q^3 + 375/1024*I_q^4");

    let map = BirkhoffMap::new(&form, &[])?;
    let start = [0.2, 0.0];
    let action = map.actions(&start)?[0];
    let period = std::f64::consts::TAU / map.frequencies(&[action])?[0];
    let after = &map.trajectory(&start, &[period])?[0];
    println!("amplitude 0.2: period {period:.9}, and after it q = {:.9}, p = {:.1e}", after[0], after[1]);
    assert!((after[0] - start[0]).abs() < 1e-7 && after[1].abs() < 1e-7);
    Ok(())
}
