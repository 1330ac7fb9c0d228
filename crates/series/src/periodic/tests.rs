use super::*;
use crate::birkhoff::PhaseSpace;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::triangle::quiet;

fn options(order: usize) -> DrivenOptions {
    DrivenOptions { order, tolerance: 1e-12, smallest_divisor: 1e-9 }
}

/// A form from text.
fn form(text: &str, pairs: &[(&str, &str)], rate: f64, order: usize) -> Result<DrivenForm, Error> {
    let space = PhaseSpace::new(pairs)?.with_driven(&["M"])?;
    let hamiltonian: Polynomial<f64> = space.parse(text)?;
    let sampled = SampledHamiltonian::new(pairs.len(), |phases: &[f64]| terms_at(&hamiltonian, &space, phases));
    DrivenForm::new(&sampled, &[rate], options(order), &mut quiet)
}

#[test]
fn the_exponent_of_mathieu_is_the_root_of_hills_determinant() -> Result<(), Error> {
    // The root for a = 0.09, q = 0.1 of Hill's determinant with 29 rows, by mpmath with 20 digits.
    let form = form("(p^2 + 0.09*x^2)/2 - 0.1*x^2*cos(2*M)", &[("x", "p")], 1.0, 0)?;
    let Exponent::Centre(omega) = form.exponents()[0] else { panic!("{:?}", form.exponents()) };
    assert!((omega - 0.309_063_060_648_002_24).abs() < 2e-15, "{omega}");
    Ok(())
}

/// The planar Hamiltonian of a locked body, p²/2 − r p − (3/4) s (a/ρ)³ cos 2(ψ + r M − f), s = (B − A)/C, about ψ = 0, p = r.
fn planar(e: f64, r: f64, s: f64, degree: u32) -> impl Fn(&[f64]) -> Result<Vec<(Monomial, f64)>, Error> + Sync {
    move |phases: &[f64]| {
        let anomaly = phases[0];
        let mut x = anomaly;
        for _ in 0..60 {
            x -= (x - e * x.sin() - anomaly) / (1.0 - e * x.cos());
        }
        let f = 2.0 * (((1.0 + e) / (1.0 - e)).sqrt() * (x / 2.0).tan()).atan();
        let cube = (1.0 - e * x.cos()).powi(-3);
        let angle = 2.0 * (r * anomaly - f);
        let mut terms = vec![(Monomial::new(&[0, 2])?, 0.5)];
        let mut factor = 1.0;
        for k in 1..=degree {
            factor *= 2.0 / f64::from(k);
            // The k-th derivative of cos.
            let slope = (angle + f64::from(k) * std::f64::consts::FRAC_PI_2).cos();
            terms.push((Monomial::new(&[k, 0])?, -0.75 * s * cube * factor * slope));
        }
        Ok(terms)
    }
}

#[test]
fn timing() -> Result<(), Error> {
    for (e, r, s, order) in [(0.01, 1.0, 0.1, 8), (0.0549, 1.0, 2.27e-4, 6), (0.2056, 1.5, 1e-4, 4)] {
        let system = SampledHamiltonian::new(1, planar(e, r, s, 12));
        let start = std::time::Instant::now();
        let form = DrivenForm::new(&system, &[1.0], options(order), &mut quiet)?;
        println!(
            "{e} {order} {:?} {:?} {} {:?}",
            start.elapsed(),
            form.exponents(),
            form.grid().times(),
            form.divisors().first()
        );
        let start = std::time::Instant::now();
        let motion = PeriodicMotion::new(&system, Grid::new(&[(1.0, 15)]), None)?;
        println!("   motion {:?} {:?}", start.elapsed(), motion.tails());
    }
    Ok(())
}
