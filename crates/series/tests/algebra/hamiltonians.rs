//! The restricted problem of three bodies about its equilibria, as polynomials.

use andoyer_series::{Error, Monomial, PhaseSpace, Polynomial};

/// x, y, z and their momenta.
#[allow(dead_code, reason = "not every test has it")]
pub(crate) fn space() -> Result<PhaseSpace, Error> {
    PhaseSpace::new(&[("x", "X"), ("y", "Y"), ("z", "Z")])
}

/// Terms in place of x, y, z of ρⁿ P_n((a·r)/ρ), a a unit vector: with t = a·r, n P_n = (2n−1) t P_{n−1} − (n−1) ρ² P_{n−2}.
#[allow(dead_code, reason = "not every test has it")]
pub(crate) fn legendre(direction: [f64; 3], highest: u32) -> Result<Vec<Polynomial<f64>>, Error> {
    let mut along = Polynomial::zero();
    let mut square = Polynomial::zero();
    for (i, c) in direction.into_iter().enumerate() {
        along.add_term(Monomial::ONE.with(2 * i, 1)?, &c);
        square.add_term(Monomial::ONE.with(2 * i, 2)?, &1.0);
    }
    let mut list = vec![Polynomial::constant(1.0), along.clone()];
    for n in 2..=highest as usize {
        let first = along.multiply(&list[n - 1])?.scale(&((2 * n - 1) as f64 / n as f64));
        let second = square.multiply(&list[n - 2])?.scale(&((n - 1) as f64 / n as f64));
        list.push(&first - &second);
    }
    Ok(list)
}

/// (X² + Y² + Z²)/2 + y X − x Y.
fn rotating() -> Result<Polynomial<f64>, Error> {
    space()?.parse("(X^2 + Y^2 + Z^2)/2 + y*X - x*Y")
}

/// About L4: −(1−μ)/r₁ − μ/r₂ with both bodies at distance 1, in the directions (∓1/2, −√3/2, 0), and the linear terms cancelled.
#[allow(dead_code, reason = "not every test has it")]
pub(crate) fn triangular(mu: f64, degree: u32) -> Result<Polynomial<f64>, Error> {
    let mut h = rotating()?;
    let height = 0.75_f64.sqrt();
    for (mass, x) in [(1.0 - mu, -0.5), (mu, 0.5)] {
        for part in legendre([x, -height, 0.0], degree)?.iter().skip(2) {
            h -= &part.scale(&mass);
        }
    }
    Ok(h)
}

/// γ of L1 or L2: the distance to the smaller body, from the quintic equation.
#[allow(dead_code, reason = "not every test has it")]
pub(crate) fn distance(mu: f64, second: bool) -> f64 {
    let sign = if second { 1.0 } else { -1.0 };
    // γ⁵ ∓ (3−μ) γ⁴ + (3−2μ) γ³ − μ γ² ± 2μ γ − μ = 0, upper signs for L1.
    let value = |g: f64| ((((g + sign * (3.0 - mu)) * g + (3.0 - 2.0 * mu)) * g - mu) * g - 2.0 * sign * mu) * g - mu;
    let (mut low, mut high) = (1e-6, 0.9);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if value(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// About L1 or L2, in units of the distance γ to the smaller body, x towards the larger one:
/// (X² + Y² + Z²)/2 + y X − x Y − Σ c_n ρⁿ P_n(x/ρ), as Jorba and Masdemont (1999) have it.
#[allow(dead_code, reason = "not every test has it")]
pub(crate) fn collinear(mu: f64, second: bool, degree: u32) -> Result<Polynomial<f64>, Error> {
    let gamma = distance(mu, second);
    let mut h = rotating()?;
    for (n, part) in (0_i32..).zip(&legendre([1.0, 0.0, 0.0], degree)?).skip(2) {
        let parity = if n % 2 == 0 { 1.0 } else { -1.0 };
        let (own, far) = if second {
            (parity, parity * (1.0 - mu) * gamma.powi(n + 1) / (1.0 + gamma).powi(n + 1))
        } else {
            (1.0, parity * (1.0 - mu) * gamma.powi(n + 1) / (1.0 - gamma).powi(n + 1))
        };
        h -= &part.scale(&((own * mu + far) / gamma.powi(3)));
    }
    Ok(h)
}
