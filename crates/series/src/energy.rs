//! The exact normal form from conservation of energy. The result equals that of Deprit's triangle; the cost is that of the powers of one series.
//!
//! In one degree of freedom with H = I + ε I² h(ℓ), every quantity that depends on ε is a function of energy and angle. Let J(H, ε) be the action. It obeys
//! the equation J_ε + {J; S} = 0 (theory §6, the inverse transformation of L′). Then H_ε + {H; S} = R, where R(H, ε) = ∂H/∂ε at fixed J is the slope of the
//! normal form. R is a function of the energy alone: R = Σ c_n ε^(n−1) H^(n+1). Let h = −½(1 + β cos 2ℓ), z = e^(2iℓ), S = i Σ ε^(m−1) I^(m+1) τ_m(z), and D
//! = 2z d/dz. Order m of that equation is
//!
//! ```text
//! D τ_m = Σ_{k≥1} c_{m−k} C(m−k+1, k) h^k + c_m − h [m = 1] + m (D h) τ_{m−1} − 2 h D τ_{m−1}
//! ```
//!
//! The mean of this equation gives c_m. The rest gives τ_m = T_m = S_m/(m−1)!. Each order takes one product of h with a table, and one sum by Horner's rule in
//! h. K = Σ k_n ε^n J^(n+1) then follows from n k_n = Σ c_j [ε^(n−j)] (K/J)^(j+1).
//!
//! All numbers are integers. g = −4h = 2 + β(z + 1/z) has integer coefficients. 4^n c_n and 4^n k_n are integer polynomials in β² (the coefficients of J(H) are
//! Legendre polynomials times binomials, theory §5). The harmonic z^j of τ_m is β^j times a polynomial in β², over 2·4^m times a small divisor.
//!
//! Cost: the forcing and τ take O(N⁴) additions. The powers of K/J take N⁵/480 products of integers of O(N) bits. They take most of the time above order 20,
//! and nine tenths of it at order 100. Times by order: docs/speed.md (`make bench`). tests/algebra/prime_field.rs checks that the divisions are exact.

use num_bigint::BigInt;
use num_integer::{Integer, binomial};
use num_traits::{One, Zero};

use crate::error::Error;
use crate::triangle::Progress;

/// A polynomial in β², lowest power first.
pub(crate) type Row = Vec<BigInt>;
/// Row j holds the polynomial in β² that multiplies β^j (z^j ± z^−j).
type Table = Vec<Row>;

/// τ_m = Σ_j Σ_i N_ji β^(j+2i) (z^j − z^−j)/(2·4^m·divisor), reduced: no prime factor of the divisor divides every N_ji.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Generator {
    /// The integers N_ji: row j, for j = 1 … m, is at index j − 1.
    pub(crate) rows: Table,
    pub(crate) divisor: BigInt,
}

/// Normal form and generators of the quartic Hamiltonian, orders 0 to N, computed one order after the other.
#[derive(Clone, Debug)]
pub(crate) struct EnergyNormalization {
    /// The polynomials 4^n c_n.
    slopes: Vec<Row>,
    /// τ_1 … τ_m, where m is the last order computed.
    generators: Vec<Generator>,
    powers: Powers,
}

impl EnergyNormalization {
    /// Order 0 of a normal form that will be computed up to `order`.
    pub(crate) fn starting(order: usize) -> Self {
        Self { slopes: vec![Vec::new()], generators: Vec::new(), powers: Powers::new(order) }
    }

    /// The normal form to `order`. `progress` is called before each order with the number of orders done, and with (order, order) at the end.
    ///
    /// # Errors
    /// - a callback that returns `Break`: [`Error::Interrupted`].
    pub(crate) fn new(order: usize, progress: &mut Progress<'_>) -> Result<Self, Error> {
        let mut computed = Self::starting(order);
        for m in 1..=order {
            tell(progress, m - 1, order)?;
            computed.extend();
        }
        tell(progress, order, order)?;
        Ok(computed)
    }

    /// Computes the next order, which must not exceed the argument of `starting`.
    pub(crate) fn extend(&mut self) {
        let m = self.slopes.len();
        let (slope, generator) = solve(&forcing(&self.slopes, m), self.generators.last(), m);
        self.slopes.push(slope);
        self.generators.push(generator);
        self.powers.extend(&self.slopes, m);
    }

    /// 4^n k_n for n = 0, 1, …, the last order computed.
    pub(crate) fn kernel(&self) -> &[Row] {
        &self.powers.rows[0]
    }

    /// τ_1, τ_2, … to the last order computed.
    pub(crate) fn generators(&self) -> &[Generator] {
        &self.generators
    }

    pub(crate) fn into_generators(self) -> Vec<Generator> {
        self.generators
    }
}

pub(crate) fn tell(progress: &mut Progress<'_>, done: usize, of: usize) -> Result<(), Error> {
    if progress(done, of).is_break() { Err(Error::Interrupted { done, of }) } else { Ok(()) }
}

/// 4^m Σ_{k≥1} c_{m−k} C(m−k+1, k) h^k, by Horner's rule in g.
fn forcing(slopes: &[Row], m: usize) -> Table {
    let deepest = m.div_ceil(2).min(m - 1); // the binomial is 0 beyond this, and there is no c_0
    let mut table = Table::new();
    for k in (1..=deepest).rev() {
        let weight = binomial(BigInt::from(m - k + 1), BigInt::from(k));
        let weight = if k % 2 == 0 { weight } else { -weight };
        let constant: Row = slopes[m - k].iter().map(|c| c * &weight).collect();
        if table.is_empty() {
            table.push(Row::new());
        }
        add(&mut table[0], &constant);
        table = times_g(&table);
    }
    table
}

fn add(target: &mut Row, row: &Row) {
    if target.len() < row.len() {
        target.resize(row.len(), BigInt::zero());
    }
    for (sum, c) in target.iter_mut().zip(row) {
        *sum += c;
    }
}

fn entry(table: &[Row], j: usize, i: usize) -> Option<&BigInt> {
    table.get(j)?.get(i)
}

/// A symmetric table times g = 2 + β(z + 1/z). The row below contributes with the same power of β², the row above with one power more.
fn times_g(table: &Table) -> Table {
    let length = |j: usize| table.get(j).map_or(0, Vec::len);
    let product = |j: usize, i: usize| {
        let mut sum = entry(table, j, i).map_or_else(BigInt::zero, |c| c << 1u32);
        if j > 0
            && let Some(c) = entry(table, j - 1, i)
        {
            sum += c;
        }
        if i > 0
            && let Some(c) = entry(table, j + 1, i - 1)
        {
            // Row 0 receives both terms of row 1, z and z^−1.
            if j == 0 { sum += c << 1u32 } else { sum += c }
        }
        sum
    };
    let rows = 0..=table.len();
    rows.map(|j| {
        let below = if j == 0 { 0 } else { length(j - 1) };
        let longest = length(j).max(below).max(length(j + 1) + 1);
        (0..longest).map(|i| product(j, i)).collect()
    })
    .collect()
}

/// 4^m c_m from the mean of the equation of order m, and τ_m from the rest.
fn solve(forcing: &Table, last: Option<&Generator>, m: usize) -> (Row, Generator) {
    let Some(last) = last else {
        // For m = 1 only −h remains: c_1 = −½ and τ_1 = (β/8)(z − 1/z).
        let generator = Generator { rows: vec![vec![BigInt::one()]], divisor: BigInt::one() };
        return (vec![BigInt::from(-2)], generator);
    };
    // Rows are multiplied by 4^m and by the last divisor.
    let row = |j: usize| -> Row { (0..=(m - j) / 2).map(|i| order_m(forcing, last, m, (j, i))).collect() };
    let slope = row(0).into_iter().map(|mean| -mean / &last.divisor).collect();
    (slope, integrated((1..=m).map(row).collect(), &last.divisor))
}

/// The coefficient of β^(j+2i) z^j in forcing + m (D h) τ_{m−1} − 2 h D τ_{m−1}, times 4^m and the last divisor.
fn order_m(forcing: &Table, last: &Generator, m: usize, (j, i): (usize, usize)) -> BigInt {
    let tau = |j: usize, i: usize| if j == 0 { None } else { entry(&last.rows, j - 1, i) };
    let mut sum = entry(forcing, j, i).map_or_else(BigInt::zero, |c| c * &last.divisor);
    if let Some(c) = tau(j, i) {
        sum += c * (4 * j);
    }
    if j > 1
        && let Some(c) = tau(j - 1, i)
    {
        sum += c * (2 * (j as i64 - 1) - m as i64);
    }
    if i > 0
        && let Some(c) = tau(j + 1, i - 1)
    {
        // In the mean, the products z·z^−1 and z^−1·z contribute equally, which doubles the weight.
        let weight = m + 2 * (j + 1);
        sum += c * if j == 0 { 2 * weight } else { weight };
    }
    sum
}

/// Divides row j by 2j, and reduces all rows to one common divisor.
fn integrated(mut rows: Table, divisor: &BigInt) -> Generator {
    let common = |j: u64, row: &Row| row.iter().fold(j, |common, c| common.gcd(&small_remainder(c, common)));
    let left: Vec<u64> = (1..).zip(&rows).map(|(j, row)| j / common(j, row)).collect();
    let multiple = left.iter().fold(BigInt::one(), |multiple, &d| multiple.lcm(&BigInt::from(d)));
    for ((j, &left), row) in (1u64..).zip(&left).zip(&mut rows) {
        let factor = &multiple / left;
        for c in row {
            *c /= j / left;
            *c *= &factor;
        }
    }
    let divisor = divisor * multiple;
    let shared = rows.iter().flatten().fold(divisor.clone(), |shared, c| shared.gcd(&(c % &shared)));
    for c in rows.iter_mut().flatten() {
        *c /= &shared;
    }
    Generator { rows, divisor: divisor / shared }
}

/// |c| modulo a small number.
fn small_remainder(c: &BigInt, modulus: u64) -> u64 {
    // The remainder is below the modulus and fits.
    (c.magnitude() % modulus).try_into().unwrap_or(0)
}

/// The powers of E = Σ k_i ε^i J^(i+1) that the recursion for k_n needs. Row p holds, at index i, 4^i times the coefficient i of (E/J)^(p+1), for i + p ≤
/// order.
#[derive(Clone, Debug)]
struct Powers {
    rows: Vec<Vec<Row>>,
    order: usize,
}

impl Powers {
    fn new(order: usize) -> Self {
        Self { rows: vec![vec![vec![BigInt::one()]]; order + 1], order }
    }

    /// Computes k_n from c_1 … c_n, and the coefficient n of every power.
    fn extend(&mut self, slopes: &[Row], n: usize) {
        let mut sum = Row::new();
        for (j, slope) in slopes.iter().enumerate().skip(1) {
            add_product(&mut sum, slope, &self.rows[j][n - j]);
        }
        self.rows[0].push(sum.into_iter().map(|c| c / n).collect());
        for p in 1..=self.order - n {
            let mut sum = Row::new();
            for i in 0..=n {
                add_product(&mut sum, &self.rows[0][i], &self.rows[p - 1][n - i]);
            }
            self.rows[p].push(sum);
        }
    }
}

fn add_product(sum: &mut Row, a: &Row, b: &Row) {
    let length = (a.len() + b.len()).saturating_sub(1);
    if sum.len() < length {
        sum.resize(length, BigInt::zero());
    }
    for (i, x) in a.iter().enumerate() {
        for (sum, y) in sum[i..].iter_mut().zip(b) {
            *sum += x * y;
        }
    }
}
