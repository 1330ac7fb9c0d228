//! The normal form of the free rigid body, exact and symbolic in β, to any order.
//!
//! Scaling: orders are those of τ = α/(√γ V). Every form is given without its power of τ. The public coefficients are those of u^j U^k β^l (Gaussian
//! rationals). The generic triangle computes the transformations of u, U and y when they are first requested.
//!
//! Times by order: docs/speed.md (`make bench`). Order 50 takes 2 MiB, order 100 13 MiB. The triangle in rationals takes a hundred times as long at order 20.
//! An inverse transformation takes a tenth of the time of a direct one. Source: theory §4 and §6; Lara (2017).

use crate::energy::{EnergyNormalization, Generator};
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::rigid_body::{self, MAX_ORDER, PublicForm, Variable};
use crate::triangle::{LieTransform, Progress, quiet};
use num_bigint::BigInt;
use num_complex::Complex;
use num_rational::BigRational;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::OnceLock;

type Series = Vec<Polynomial<BigRational>>;

/// The direction of a transformation. Its number is the position of the series in `NormalForm::series`.
#[derive(Clone, Copy)]
enum Direction {
    Direct = 0,
    Inverse = 2,
}

impl Direction {
    fn name(self) -> &'static str {
        match self {
            Direction::Direct => "direct transformation",
            Direction::Inverse => "inverse transformation",
        }
    }
}

/// The normal form of the free rigid body to a given order in τ.
///
/// ```
/// use andoyer_series::NormalForm;
/// let normal_form = NormalForm::new(3)?;
/// let p3 = normal_form.triaxiality_polynomial(3)?;
/// assert_eq!(p3[&2].to_string(), "-5/8"); // P_3 = -5/8 β²
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct NormalForm {
    triaxiality: Vec<BTreeMap<u32, BigRational>>,
    /// Tables of T_1 … T_N.
    generators: Vec<Generator>,
    transform: OnceLock<LieTransform<BigRational>>,
    /// Direct and inverse series of w̄ and of ŷ, in the order [direct w̄, direct ŷ, inverse w̄, inverse ŷ].
    series: [OnceLock<Series>; 4],
}

impl NormalForm {
    /// The normal form to `order` ≥ 0.
    ///
    /// # Errors
    /// - Order 16382: [`Error::OrderTooLarge`], before any computation;
    /// - order 2000: [`Error::MemoryTooLarge`], before any computation.
    pub fn new(order: usize) -> Result<Self, Error> {
        Self::with_progress(order, quiet)
    }

    /// The normal form to `order`, with a callback that receives (orders done, `order`) and may stop the computation.
    ///
    /// The callback is called before every order, and with (`order`, `order`) at the end.
    ///
    /// # Errors
    /// - Order 16382: [`Error::OrderTooLarge`], before any computation;
    /// - order 2000: [`Error::MemoryTooLarge`], before any computation;
    /// - a callback that returns `Break`: [`Error::Interrupted`].
    pub fn with_progress(
        order: usize,
        mut progress: impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<Self, Error> {
        check_order(order)?;
        check_memory(order)?;
        let progress: &mut Progress<'_> = &mut progress;
        EnergyNormalization::new(order, progress).map(Self::computed)
    }

    pub(crate) fn computed(computed: EnergyNormalization) -> Self {
        let triaxiality =
            computed.kernel().iter().enumerate().map(|(n, row)| rigid_body::triaxiality(n, row)).collect();
        let generators = computed.into_generators();
        NormalForm { triaxiality, generators, transform: OnceLock::new(), series: Default::default() }
    }

    /// The order of this normal form.
    #[must_use]
    pub fn order(&self) -> usize {
        self.triaxiality.len() - 1
    }

    /// The triaxiality polynomial P_n in its real form, as {power of β: coefficient}: K = M²/(2C) [1 + γ Σ P_n κⁿ σ^{n+1}] (theory §4).
    ///
    /// # Errors
    /// - `n` above the order: [`Error::OrderOutOfRange`].
    pub fn triaxiality_polynomial(&self, n: usize) -> Result<&BTreeMap<u32, BigRational>, Error> {
        self.triaxiality.get(n).ok_or_else(|| self.out_of_range("triaxiality polynomial", n, 0))
    }

    /// The paper's form p_n = (−i)^{n+1} P_n as {power of β: coefficient} (theory §4, and §11 for the misprint).
    ///
    /// ```
    /// let p2 = andoyer_series::NormalForm::new(2)?.paper_polynomial(2)?;
    /// assert_eq!(p2[&2].to_string(), "0-1/2i"); // P_2 = -β²/2 = i³ p_2
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `n` above the order: [`Error::OrderOutOfRange`].
    pub fn paper_polynomial(&self, n: usize) -> Result<BTreeMap<u32, Complex<BigRational>>, Error> {
        Ok(rigid_body::paper(n, self.triaxiality_polynomial(n)?))
    }

    /// The generating function S_m · (√γ V/α)^m = Σ c u^j U^k β^l as {(j, k, l): c}; the factor (m−1)! is included.
    ///
    /// ```
    /// let s1 = andoyer_series::NormalForm::new(1)?.generator(1)?; // β (u² + U²) uU/8
    /// assert_eq!(s1.keys().collect::<Vec<_>>(), [&(1, 3, 1), &(3, 1, 1)]);
    /// assert_eq!(s1[&(3, 1, 1)].to_string(), "1/8+0i");
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `m` = 0, or above the order: [`Error::OrderOutOfRange`].
    pub fn generator(&self, m: usize) -> Result<PublicForm, Error> {
        let absent = || self.out_of_range("generating function", m, 1);
        let table = self.generators.get(m.wrapping_sub(1)).ok_or_else(absent)?;
        let scaled = rigid_body::scaled_generator(m, table)?;
        let factorial: BigInt = (1..m).product();
        Ok(rigid_body::public_face(&scaled.scale(&factorial.into())))
    }

    /// Order `n` of the transformation from a variable to the new variables, as {(j, k, l): c}; the factor 1/n! is included.
    ///
    /// For u and U: u = u′ + Σ τⁿ Σ c u′^j U′^k β^l. For y: y = y′ + (1/M) Σ τⁿ Σ c u′^j U′^k β^l. The form of y is M · (order n of y) · (√γ V/α)ⁿ, because
    /// ∂S_m/∂M = −(m/M) S_m (theory §6).
    ///
    /// ```
    /// use andoyer_series::NormalForm;
    /// use andoyer_series::rigid_body::Variable;
    /// let y = NormalForm::new(1)?.direct(Variable::Angle, 1)?; // {y; S_1} = −S_1/M
    /// assert_eq!(y[&(3, 1, 1)].to_string(), "-1/8+0i");
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `n` = 0, or above the order: [`Error::OrderOutOfRange`].
    pub fn direct(&self, variable: Variable, n: usize) -> Result<PublicForm, Error> {
        self.direct_with(variable, n, &mut quiet)
    }

    /// The same as [`direct`](Self::direct), with a callback. It receives (orders done, order) while the series of the variable is computed, and may stop the
    /// computation. The series is computed once for all n.
    ///
    /// # Errors
    /// - The errors of [`direct`](Self::direct); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn direct_with(&self, variable: Variable, n: usize, progress: &mut Progress<'_>) -> Result<PublicForm, Error> {
        self.transformation(variable, n, Direction::Direct, progress)
    }

    /// Order `n` of the transformation from a new variable to the old variables, scaled as in [`direct`](Self::direct).
    ///
    /// ```
    /// use andoyer_series::NormalForm;
    /// use andoyer_series::rigid_body::Variable;
    /// let normal_form = NormalForm::new(1)?;
    /// let [direct, inverse] = [normal_form.direct(Variable::Momentum, 1)?, normal_form.inverse(Variable::Momentum, 1)?];
    /// assert!(direct.iter().all(|(exponents, c)| inverse[exponents] == -c)); // to first order
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - `n` = 0, or above the order: [`Error::OrderOutOfRange`].
    pub fn inverse(&self, variable: Variable, n: usize) -> Result<PublicForm, Error> {
        self.inverse_with(variable, n, &mut quiet)
    }

    /// The same as [`inverse`](Self::inverse), with the callback of [`direct_with`](Self::direct_with).
    ///
    /// # Errors
    /// - The errors of [`inverse`](Self::inverse); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn inverse_with(&self, variable: Variable, n: usize, progress: &mut Progress<'_>) -> Result<PublicForm, Error> {
        self.transformation(variable, n, Direction::Inverse, progress)
    }

    /// The transformation in the rational variables of [`hamiltonian`](crate::rigid_body::hamiltonian), where S = i s.
    ///
    /// # Errors
    /// - None: every order that [`new`](Self::new) accepts has a transformation.
    pub fn transform(&self) -> Result<&LieTransform<BigRational>, Error> {
        if let Some(transform) = self.transform.get() {
            return Ok(transform);
        }
        let tables = (1..).zip(&self.generators);
        let scaled = tables.map(|(m, table)| rigid_body::scaled_generator(m, table)).collect::<Result<_, _>>()?;
        let transform = LieTransform::new(rigid_body::poisson()?, scaled);
        Ok(self.transform.get_or_init(|| transform))
    }

    fn transformation(
        &self,
        variable: Variable,
        n: usize,
        direction: Direction,
        progress: &mut Progress<'_>,
    ) -> Result<PublicForm, Error> {
        if n == 0 || n > self.order() {
            return Err(self.out_of_range(direction.name(), n, 1));
        }
        let cell = &self.series[direction as usize + usize::from(variable == Variable::Angle)];
        let series = match cell.get() {
            Some(series) => series,
            None => {
                let (seed, transform) = (rigid_body::seed(variable), self.transform()?);
                let series = match direction {
                    Direction::Direct => transform.direct_with(&seed, progress),
                    Direction::Inverse => transform.inverse_with(&seed, progress),
                }?;
                cell.get_or_init(|| series)
            }
        };
        if variable == Variable::Momentum {
            rigid_body::public_momentum(&series[n])
        } else {
            Ok(rigid_body::public_face(&series[n]))
        }
    }

    fn out_of_range(&self, what: &'static str, order: usize, minimum: usize) -> Error {
        Error::OrderOutOfRange { what, order, minimum, maximum: self.order() }
    }
}

/// Refuses an order whose exponents do not fit the packed monomials.
pub(crate) fn check_order(order: usize) -> Result<(), Error> {
    if order > MAX_ORDER { Err(Error::OrderTooLarge { order, bound: MAX_ORDER }) } else { Ok(()) }
}

/// Largest estimated memory of a normal form: 8 GiB, which is reached at order 594. Such a computation takes days.
pub const MAX_MEMORY: f64 = 8.0 * GIBIBYTE;
/// One gibibyte in bytes.
const GIBIBYTE: f64 = 1024.0 * 1024.0 * 1024.0;

/// Estimated memory of a normal form to an order, in bytes. Generators and powers hold 5N³/24 integers of N/4 bytes on average, each with 48 bytes of overhead.
/// At order 100 the estimate is 15 MiB and the measured value 13 MiB.
fn estimated_memory(order: usize) -> f64 {
    let order = order as f64;
    5.0 / 24.0 * order.powi(3) * (48.0 + 0.25 * order)
}

/// Refuses an order whose normal form would not fit in memory.
fn check_memory(order: usize) -> Result<(), Error> {
    let estimate = estimated_memory(order);
    let [estimate_gib, bound_gib] = [estimate, MAX_MEMORY].map(|bytes| bytes / GIBIBYTE);
    if estimate > MAX_MEMORY { Err(Error::MemoryTooLarge { order, estimate_gib, bound_gib }) } else { Ok(()) }
}

impl PartialEq for NormalForm {
    /// Compares the polynomials and the generators. The transformations are not compared, since they follow from the generators.
    fn eq(&self, other: &Self) -> bool {
        (&self.triaxiality, &self.generators) == (&other.triaxiality, &other.generators)
    }
}

impl Eq for NormalForm {}

impl std::hash::Hash for NormalForm {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.triaxiality.hash(state);
    }
}
