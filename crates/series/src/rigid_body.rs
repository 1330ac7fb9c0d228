//! The free rigid body: its Hamiltonian, and the real and the complex form of its series. The private module `energy` computes them.
//!
//! Convention, with w = √L e^{iℓ}, u = i w̄, U = w, S = i s, τ = α/(√γ V) and the time unit C/(√γ V) (theory §1, §2):
//!
//! ```text
//! H = w w̄ − (τ/4) [ 2 w² w̄² + β (w³ w̄ + w w̄³) ]        (without the constant part in V², which K contains)
//! ```
//!
//! The bracket [f; s] := {f; i s} is canonical for the pair (q, p) = (w̄, w): [f; s] = ∂f/∂w̄ ∂s/∂w − ∂f/∂w ∂s/∂w̄. With y = i ŷ and M in units of κ = α/γ (τ =
//! 1/M), [ŷ; s] = ∂s/∂M, so (ŷ, τ) is a reciprocal pair. All coefficients in w̄, w, ŷ are therefore rational. The public functions give the Gaussian rationals
//! of the paper's variables u, U: w̄^j w^k = (−i)^j u^j U^k. Then K = Σ k_n τⁿ (w w̄)^{n+1}, P_n = 2 k_n and p_n = (−i)^{n+1} P_n (theory §4). Source: Lara
//! (2017) with the errata of theory §11. Cost: see [`NormalForm`](crate::NormalForm).

use crate::bracket::Poisson;
use crate::coefficient::Coefficient;
use crate::energy::Generator;
use crate::error::Error;
use crate::error::TermProblem;
use crate::homological::Homological;
use crate::monomial::{MAX_EXPONENT, Monomial, SLOTS};
use crate::polynomial::Polynomial;
use num_bigint::BigInt;
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::{One, Zero};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::str::FromStr;

/// Slot of w̄ = −i u, the coordinate of the rational pair.
pub const W_BAR: usize = 0;
/// Slot of w = U, the momentum of the rational pair.
pub const W: usize = 1;
/// Slot of τ = α/(√γ V) = κ/M, the small parameter.
pub const TAU: usize = 2;
/// Slot of the triaxiality β.
pub const BETA: usize = 3;
/// Slot of ŷ = −i y.
pub const Y_HAT: usize = 4;

/// Largest order whose exponents fit the packed monomials. A product of two parts of orders a + b = N has degree 2N + 4 at most.
pub const MAX_ORDER: usize = (MAX_EXPONENT as usize - 4) / 2;

/// The coefficients c of a form Σ c u^j U^k β^l, with the exponents (j, k, l) as keys.
pub type PublicForm = BTreeMap<(u32, u32, u32), Complex<BigRational>>;

/// A variable of the paper that the normal form transforms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Variable {
    /// The coordinate u.
    Coordinate,
    /// The momentum U.
    Momentum,
    /// The angle y.
    Angle,
}

impl FromStr for Variable {
    type Err = Error;

    /// Reads "u", "U" or "y".
    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "u" => Ok(Variable::Coordinate),
            "U" => Ok(Variable::Momentum),
            "y" => Ok(Variable::Angle),
            _ => Err(Error::NameUnknown { what: "variable", name: name.to_owned(), known: "\"u\", \"U\", \"y\"" }),
        }
    }
}

impl Variable {
    /// The name that `from_str` reads.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Variable::Coordinate => "u",
            Variable::Momentum => "U",
            Variable::Angle => "y",
        }
    }
}

/// The scaled Hamiltonian of theory §2 as its parts of order 0 and 1 in τ. The variables are in the slots [`W_BAR`], [`W`], [`TAU`], [`BETA`].
///
/// ```
/// let [main, perturbation] = andoyer_series::rigid_body::hamiltonian::<f64>()?;
/// assert_eq!(main.display(&["v", "w"]).to_string(), "v*w");
/// assert_eq!(perturbation.evaluate(&[1.0, 1.0, 1.0, 0.5])?, -0.75);
/// # Ok::<(), andoyer_series::Error>(())
/// ```
///
/// # Errors
/// - Coefficients of characteristic 2, where 4 has no inverse: [`Error::DivisionByZero`].
pub fn hamiltonian<C: Coefficient>() -> Result<[Polynomial<C>; 2], Error> {
    let term = |w_bar, w, tau, beta| Monomial::small([w_bar, w, tau, beta, 0, 0, 0, 0]);
    let ratio = |numerator| C::ratio(numerator, 4).ok_or(Error::DivisionByZero);
    let perturbation = [(term(2, 2, 1, 0), ratio(-2)?), (term(1, 3, 1, 1), ratio(-1)?), (term(3, 1, 1, 1), ratio(-1)?)];
    let main = [(term(1, 1, 0, 0), C::one())];
    Ok([Polynomial::from_terms(main), Polynomial::from_terms(perturbation)])
}

/// The bracket [f; s] = {f; i s} of the rational variables: the pair (w̄, w) and the reciprocal pair (ŷ, τ).
///
/// # Errors
/// - None, since the slots differ.
pub fn poisson() -> Result<Poisson, Error> {
    Poisson::new(&[(W_BAR, W)])?.with_reciprocal(Y_HAT, TAU)
}

/// The homological equation of the main part w w̄.
///
/// # Errors
/// - None, since the slots differ.
pub fn homological<C: Coefficient>() -> Result<Homological<C>, Error> {
    Homological::new(&[(W_BAR, W, C::one())])
}

/// The action σ_sep of the separatrix in units of M. It is the radius of convergence of the series in σ = L/M.
///
/// σ_sep = (2/π) atan2(√(1−β), √(2β)). It is the integral of theory §5 at Eγ/α = 1 − β: the integrand is √(2β) |sin ν| / √(1−β+2β sin²ν) and its primitive is
/// an arcsine of cos ν. σ_sep falls from 1 at `beta` = 0 to 0 at `beta` = 1.
///
/// ```
/// let action = andoyer_series::rigid_body::separatrix_action(0.5)?;
/// assert!((action - 0.39183).abs() < 5e-6); // table of theory §5
/// # Ok::<(), andoyer_series::Error>(())
/// ```
///
/// # Errors
/// - `beta` = −0.1, 1.1 or NaN: [`Error::OutsideInterval`].
pub fn separatrix_action(beta: f64) -> Result<f64, Error> {
    if (0.0..=1.0).contains(&beta) {
        Ok((1.0 - beta).sqrt().atan2((2.0 * beta).sqrt()) / FRAC_PI_2)
    } else {
        Err(Error::OutsideInterval { argument: "beta", value: beta, lower: 0.0, upper: 1.0 })
    }
}

/// P_n = 2 k_n as {power of β: coefficient}, from 4^n k_n, a polynomial in β² with the coefficients `row`.
pub(crate) fn triaxiality(n: usize, row: &[BigInt]) -> BTreeMap<u32, BigRational> {
    let divisor = BigInt::from(4).pow(n as u32); // n ≤ MAX_ORDER
    let terms = (0u32..).zip(row).filter(|(_, c)| !c.is_zero());
    terms.map(|(i, c)| (2 * i, BigRational::new(c * 2, divisor.clone()))).collect()
}

/// T_m in the slots of this file. The power z^j of the table is w^(m+1+j) w̄^(m+1−j).
pub(crate) fn scaled_generator(m: usize, table: &Generator) -> Result<Polynomial<BigRational>, Error> {
    let order = m as u32; // m ≤ MAX_ORDER
    let divisor = (&table.divisor << 1u32) * BigInt::from(4).pow(order);
    let mut form = Polynomial::zero();
    for (j, row) in (1u32..).zip(&table.rows) {
        for (i, c) in (0u32..).zip(row).filter(|(_, c)| !c.is_zero()) {
            let value = BigRational::new(c.clone(), divisor.clone());
            let (more, less, beta) = (order + 1 + j, order + 1 - j, j + 2 * i);
            form.add_term(Monomial::new(&[less, more, order, beta])?, &value);
            form.add_term(Monomial::new(&[more, less, order, beta])?, &-value);
        }
    }
    Ok(form)
}

/// p_n = (−i)^{n+1} P_n.
pub(crate) fn paper(n: usize, real: &BTreeMap<u32, BigRational>) -> BTreeMap<u32, Complex<BigRational>> {
    real.iter().map(|(&power, c)| (power, turned(c, 3 * (n + 1)))).collect()
}

/// The form i · f in the paper's variables u, U, for a form f in w̄, w (a generating function, ŷ, or w̄ itself).
pub(crate) fn public_face(form: &Polynomial<BigRational>) -> PublicForm {
    faces(form, 1)
}

/// The transformation of U in the paper's variables, from that of w̄. The exchange of w̄ and w gives the transformation of w, because s is odd under it.
pub(crate) fn public_momentum(form: &Polynomial<BigRational>) -> Result<PublicForm, Error> {
    Ok(faces(&form.exchange(W_BAR, W)?, 0))
}

fn faces(form: &Polynomial<BigRational>, turns: usize) -> PublicForm {
    let face = |(monomial, c): (Monomial, &BigRational)| {
        let (j, k, l) = (monomial.exponent(W_BAR), monomial.exponent(W), monomial.exponent(BETA));
        ((j, k, l), turned(c, turns + 3 * j as usize))
    };
    form.terms().map(face).collect()
}

/// Refuses a generating function i s that is complex on real motions.
///
/// S is real on real motions if s has real coefficients in w̄, w and changes its sign when w̄ and w are exchanged.
pub(crate) fn check_real(m: usize, face: &PublicForm) -> Result<(), Error> {
    let private = |j: u32, c: &Complex<BigRational>| turned_complex(c, j as usize + 3);
    for (&(j, k, l), c) in face {
        let c = private(j, c);
        let opposite = face.get(&(k, j, l)).map(|c| -private(k, c));
        if !c.im.is_zero() || opposite.as_ref() != Some(&c) {
            let (what, exponents) = ("generating function", vec![j, k, l]);
            return Err(Error::TermInconsistent { what, order: m, exponents, problem: TermProblem::NotReal });
        }
    }
    Ok(())
}

/// iⁿ c.
fn turned(c: &BigRational, n: usize) -> Complex<BigRational> {
    turned_complex(&Complex::new(c.clone(), BigRational::zero()), n)
}

/// iⁿ c. With n = j this turns the coefficient of u^j into that of w̄^j.
pub(crate) fn turned_complex(c: &Complex<BigRational>, n: usize) -> Complex<BigRational> {
    match n % 4 {
        0 => c.clone(),
        1 => Complex::new(-c.im.clone(), c.re.clone()),
        2 => -c.clone(),
        _ => Complex::new(c.im.clone(), -c.re.clone()),
    }
}

/// The variable of the rational pair whose transformation gives that of `variable`.
pub(crate) fn seed(variable: Variable) -> Polynomial<BigRational> {
    let mut exponents = [0; SLOTS];
    exponents[if variable == Variable::Angle { Y_HAT } else { W_BAR }] = 1;
    Polynomial::from_terms([(Monomial::small(exponents), BigRational::one())])
}
