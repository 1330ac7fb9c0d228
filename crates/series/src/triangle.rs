//! Deprit's triangle: normalization, direct and inverse transformation, to any order.
//!
//! Convention (theory §4): f_{n,q} = f_{n+1,q−1} + Σ_{0≤m≤n} C(n,m) {f_{n−m,q−1}; S_{m+1}}. This module computes g_{n,q} = f_{n,q}/n! with T_m = S_m/(m−1)!,
//! which needs no binomials:
//!
//! ```text
//! g_{n,q} = (n+1) g_{n+1,q−1} + Σ_{0≤m≤n} {g_{n−m,q−1}; T_{m+1}}
//! ```
//!
//! Series are lists of the coefficients of ε⁰, ε¹, …: the Hamiltonian H_{n,0}/n!, the normal form H_{0,n}/n!, a transformed function f_{0,n}/n!. Order N costs
//! N(N+1)(N+2)/6 brackets. Each inner sum is accumulated without reduction of the fractions. The inverse transformation obeys (n+1) G_{n+1} = −Σ {G_{n−m};
//! T_{m+1}}, G_0 = f, and costs N(N+1)/2 brackets.

use crate::bracket::Poisson;
use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::homological::Homological;
use crate::polynomial::Polynomial;
use crate::product::{Accumulator, Pause};
use std::ops::ControlFlow;

/// A progress callback. Its arguments are the number of orders done and the number of orders requested. It stops the computation by returning `Break`.
pub type Progress<'a> = dyn FnMut(usize, usize) -> ControlFlow<()> + 'a;

/// A progress callback that does nothing and never stops the computation.
///
/// ```
/// use andoyer_series::{PhaseSpace, normalize_with};
/// use andoyer_series::birkhoff::Resonances;
/// use andoyer_series::progress::quiet;
/// let space = PhaseSpace::new(&[("q", "p")])?;
/// let h = space.parse::<f64>("(p^2 + q^2)/2 + q^4/4")?;
/// let normal_form = normalize_with(&h, 2, &space, &Resonances::default(), &mut quiet)?;
/// assert_eq!(normal_form.to_string(), "I_q + 0.375*I_q^2");
/// # Ok::<(), andoyer_series::Error>(())
/// ```
pub fn quiet(_done: usize, _of: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A canonical transformation given by its generating function S = Σ εᵐ T_{m+1}, T_m = S_m/(m−1)!.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct LieTransform<C: Coefficient> {
    poisson: Poisson,
    scaled: Vec<Polynomial<C>>,
}

/// A normalized Hamiltonian and the transformation that normalizes it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Normalization<C: Coefficient> {
    /// The coefficients K_n/n! of ε⁰, ε¹, … of the normal form.
    pub hamiltonian: Vec<Polynomial<C>>,
    /// The transformation.
    pub transform: LieTransform<C>,
}

/// Normalizes H = Σ εⁿ `hamiltonian[n]` to order `order`; missing coefficients are 0.
///
/// `hamiltonian[0]` is the quadratic part of `homological`. `progress` is called before every cell of the triangle and during long cells, with the number of
/// orders done, so the same number comes several times. The last call has the arguments (order, order).
///
/// ```
/// use andoyer_series::Polynomial;
/// use andoyer_series::lie::{Homological, Poisson, deprit_triangle};
/// use andoyer_series::progress::quiet;
/// use num_rational::BigRational;
/// let parse = |text| Polynomial::<BigRational>::parse(text, &["q", "p"]);
/// let homological = Homological::new(&[(0, 1, BigRational::from_integer(1.into()))])?;
/// let series = [parse("q*p")?, parse("q^3 + p^3")?];
/// let poisson = Poisson::new(&[(0, 1)])?;
/// let normalization = deprit_triangle(&series, &homological, &poisson, 2, &mut quiet)?;
/// assert_eq!(normalization.hamiltonian[2], parse("-3*q^2*p^2")?);
/// # Ok::<(), andoyer_series::Error>(())
/// ```
///
/// # Errors
/// - `hamiltonian[0]` = q²: [`Error::UnperturbedMismatch`];
/// - a callback that returns `Break`: [`Error::Interrupted`];
/// - degrees that outgrow the packed exponents: [`Error::ExponentOverflow`].
pub fn deprit_triangle<C: Coefficient>(
    hamiltonian: &[Polynomial<C>],
    homological: &Homological<C>,
    poisson: &Poisson,
    order: usize,
    progress: &mut Progress<'_>,
) -> Result<Normalization<C>, Error> {
    let unperturbed = homological.unperturbed()?;
    if hamiltonian.first() != Some(&unperturbed) {
        return Err(Error::UnperturbedMismatch { terms: hamiltonian.first().map_or(0, Polynomial::len) });
    }
    let solve = |_, known: &Polynomial<C>| {
        let (_, image) = homological.split(known);
        let solution = homological.solve(&image)?;
        Ok(Removal { image, solution })
    };
    normalize_by(hamiltonian, poisson, order, &solve, progress)
}

/// The part of a coefficient of the Hamiltonian that is removed (`image`), and the S that removes it: {h₀; S} = −image.
pub(crate) struct Removal<C> {
    pub(crate) image: Polynomial<C>,
    pub(crate) solution: Polynomial<C>,
}

/// Solves the homological equation of one order. The arguments are the order and the known part of its coefficient.
pub(crate) type Solve<'a, C> = dyn Fn(usize, &Polynomial<C>) -> Result<Removal<C>, Error> + 'a;

/// The triangle with a general rule for the part to remove; `hamiltonian[0]` is the h₀ that `solve` uses.
pub(crate) fn normalize_by<C: Coefficient>(
    hamiltonian: &[Polynomial<C>],
    poisson: &Poisson,
    order: usize,
    solve: &Solve<'_, C>,
    progress: &mut Progress<'_>,
) -> Result<Normalization<C>, Error> {
    let unperturbed = hamiltonian.first().cloned().unwrap_or_default();
    let mut transform = LieTransform { poisson: poisson.clone(), scaled: Vec::new() };
    let mut triangle = Triangle::new(unperturbed.clone());
    let mut normal = vec![unperturbed];
    let mut factorial = C::one(); // (n−1)!
    for n in 1..=order {
        let source = hamiltonian.get(n).cloned().unwrap_or_default();
        triangle.extend(source, &transform, &mut || stop(progress(n - 1, order), n - 1, order))?;
        let Removal { image, solution } = solve(n, triangle.corner())?; // S_n
        let inverse = factorial.invert().ok_or(Error::DivisionByZero)?;
        transform.scaled.push(solution.scale(&inverse));
        triangle.subtract(&image)?;
        factorial = factorial.times(n as i64);
        let inverse = factorial.invert().ok_or(Error::DivisionByZero)?;
        normal.push(triangle.corner().scale(&inverse));
    }
    stop(progress(order, order), order, order)?;
    Ok(Normalization { hamiltonian: normal, transform })
}

/// The normal form of [`normalize_by`] with the generator W = Σ εᵐ W_{m+1} in the new variables. A function f of the old variables is then F in the new ones with
///
/// ```text
/// (n+1) F_{n+1} = Σ_{0≤m≤n} {F_{n−m}; W_{m+1}},   F_0 = f
/// ```
///
/// which takes N(N+1)/2 brackets, and so does each part of the Hamiltonian. The last order takes N brackets for all parts, because only the sum of their F is needed.
/// The transform is that of −W, from the new variables to the old ones: its `inverse` takes functions of the old variables to the new ones, and `direct` the other way.
pub(crate) fn normalize_backwards<C: Coefficient>(
    hamiltonian: &[Polynomial<C>],
    poisson: &Poisson,
    order: usize,
    solve: &Solve<'_, C>,
    progress: &mut Progress<'_>,
) -> Result<Normalization<C>, Error> {
    let unperturbed = hamiltonian.first().cloned().unwrap_or_default();
    let mut transform = LieTransform { poisson: poisson.clone(), scaled: Vec::new() };
    // The series F of each part.
    let mut parts = vec![vec![unperturbed.clone()]];
    let mut normal = vec![unperturbed];
    for n in 1..=order {
        let mut known = hamiltonian.get(n).cloned().unwrap_or_default();
        let pause = &mut || stop(progress(n - 1, order), n - 1, order);
        if n == order {
            parts = vec![joined(&parts, n)?];
        }
        for part in &mut parts {
            let next = transform.next_inverse(part, pause)?;
            known += &next;
            part.push(next);
        }
        parts.push(vec![hamiltonian.get(n).cloned().unwrap_or_default()]);
        // {h₀; W_n}/n = −image
        let Removal { image, solution } = solve(n, &known)?;
        transform.scaled.push(solution.scale(&C::integer(-(n as i64))));
        for sum in [&mut known, &mut parts[0][n]] {
            *sum -= &image;
        }
        normal.push(known);
    }
    stop(progress(order, order), order, order)?;
    Ok(Normalization { hamiltonian: normal, transform })
}

/// A series of n coefficients whose next one is the sum of those of all parts: the one of a part of i coefficients is a sum of brackets over i.
fn joined<C: Coefficient>(parts: &[Vec<Polynomial<C>>], n: usize) -> Result<Vec<Polynomial<C>>, Error> {
    let mut series = vec![Polynomial::zero(); n];
    for part in parts {
        let weight = C::integer(n as i64);
        for (sum, coefficient) in series.iter_mut().rev().zip(part.iter().rev()) {
            *sum += &coefficient.scale(&weight).over(part.len() as i64)?;
        }
    }
    Ok(series)
}

pub(crate) fn stop(flow: ControlFlow<()>, done: usize, of: usize) -> Result<(), Error> {
    if flow.is_break() { Err(Error::Interrupted { done, of }) } else { Ok(()) }
}

impl<C: Coefficient> LieTransform<C> {
    /// The transformation with the generating functions T_1, T_2, … (T_m = S_m/(m−1)!).
    #[must_use]
    pub fn new(poisson: Poisson, scaled: Vec<Polynomial<C>>) -> Self {
        LieTransform { poisson, scaled }
    }

    /// The order to which the transformation is known.
    #[must_use]
    pub fn order(&self) -> usize {
        self.scaled.len()
    }

    /// This transformation to a lower order, or a copy of it if `order` is not lower.
    #[must_use]
    pub fn truncated(&self, order: usize) -> Self {
        LieTransform { poisson: self.poisson.clone(), scaled: self.scaled.iter().take(order).cloned().collect() }
    }

    /// This transformation with `function` applied to every coefficient, for example to convert it to floats.
    #[must_use]
    pub fn map<D: Coefficient>(&self, mut function: impl FnMut(&C) -> D) -> LieTransform<D> {
        let scaled = self.scaled.iter().map(|generator| generator.map(&mut function)).collect();
        LieTransform { poisson: self.poisson.clone(), scaled }
    }

    /// T_m = S_m/(m−1)!, or `None` if m is 0 or above the order.
    #[must_use]
    pub fn scaled_generator(&self, m: usize) -> Option<&Polynomial<C>> {
        self.scaled.get(m.checked_sub(1)?)
    }

    /// S_m, or `None` if m is 0 or above the order.
    #[must_use]
    pub fn generator(&self, m: usize) -> Option<Polynomial<C>> {
        let factorial = (1..m as i64).fold(C::one(), |product, factor| product.times(factor));
        self.scaled_generator(m).map(|scaled| scaled.scale(&factorial))
    }

    /// The coefficients f_{0,n}/n! of ε⁰, ε¹, … of f expressed in the new variables.
    ///
    /// # Errors
    /// - degrees that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn direct(&self, f: &Polynomial<C>) -> Result<Vec<Polynomial<C>>, Error> {
        self.direct_with(f, &mut quiet)
    }

    /// The same as [`direct`](Self::direct), with a callback that is called as in [`deprit_triangle`].
    ///
    /// # Errors
    /// - The errors of [`direct`](Self::direct); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn direct_with(&self, f: &Polynomial<C>, progress: &mut Progress<'_>) -> Result<Vec<Polynomial<C>>, Error> {
        let order = self.order();
        let mut triangle = Triangle::new(f.clone());
        let mut series = vec![f.clone()];
        let mut factorial = C::one();
        for n in 1..=order {
            let pause = &mut || stop(progress(n - 1, order), n - 1, order);
            triangle.extend(Polynomial::zero(), self, pause)?;
            factorial = factorial.times(n as i64);
            let inverse = factorial.invert().ok_or(Error::DivisionByZero)?;
            series.push(triangle.corner().scale(&inverse));
        }
        stop(progress(order, order), order, order)?;
        Ok(series)
    }

    /// The coefficients of ε⁰, ε¹, … of f, a function of the new variables, expressed in the old variables.
    ///
    /// # Errors
    /// - degrees that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn inverse(&self, f: &Polynomial<C>) -> Result<Vec<Polynomial<C>>, Error> {
        self.inverse_with(f, &mut quiet)
    }

    /// The same as [`inverse`](Self::inverse), with a callback. It is called before every order, during long orders, and with (order, order) at the end.
    ///
    /// # Errors
    /// - The errors of [`inverse`](Self::inverse); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn inverse_with(&self, f: &Polynomial<C>, progress: &mut Progress<'_>) -> Result<Vec<Polynomial<C>>, Error> {
        let order = self.order();
        let mut series = vec![f.clone()];
        for n in 0..order {
            let pause = &mut || stop(progress(n, order), n, order);
            pause()?;
            series.push(self.next_inverse(&series, pause)?);
        }
        stop(progress(order, order), order, order)?;
        Ok(series)
    }

    /// G_{n+1} after G_0, …, G_n. A generator that is not yet known counts as 0.
    fn next_inverse(&self, series: &[Polynomial<C>], pause: &mut Pause<'_>) -> Result<Polynomial<C>, Error> {
        let left: Vec<_> = series.iter().rev().collect();
        let right: Vec<_> = self.scaled.iter().take(series.len()).collect();
        let mut sum = Accumulator::new(&left, &right);
        for m in 0..right.len() {
            self.poisson.accumulate(&mut sum, (m, m));
        }
        sum.finish(pause)?.over(-(series.len() as i64))
    }
}

/// The triangle, stored by columns: `columns[q][n]` = g_{n,q}.
struct Triangle<C> {
    columns: Vec<Vec<Polynomial<C>>>,
}

impl<C: Coefficient> Triangle<C> {
    /// The triangle of order 0.
    fn new(apex: Polynomial<C>) -> Self {
        Triangle { columns: vec![vec![apex]] }
    }

    /// Adds the next anti-diagonal n + q = N, from the coefficient `source` of ε^N. A generator T_N that is not yet known counts as 0.
    fn extend(
        &mut self,
        source: Polynomial<C>,
        transform: &LieTransform<C>,
        pause: &mut Pause<'_>,
    ) -> Result<(), Error> {
        let order = self.columns.len();
        self.columns[0].push(source);
        self.columns.push(Vec::new());
        for q in 1..=order {
            pause()?;
            let cell = self.cell(order - q, q - 1, transform, pause)?;
            self.columns[q].push(cell);
        }
        Ok(())
    }

    /// g_{n,q+1} = (n+1) g_{n+1,q} + Σ {g_{n−m,q}; T_{m+1}}, accumulated in one sum without reduction.
    fn cell(
        &self,
        n: usize,
        q: usize,
        transform: &LieTransform<C>,
        pause: &mut Pause<'_>,
    ) -> Result<Polynomial<C>, Error> {
        let column = &self.columns[q];
        let one = Polynomial::constant(C::one());
        let known = (n + 1).min(transform.order());
        let pairs: Vec<_> = (0..known)
            .map(|m| (&column[n - m], &transform.scaled[m]))
            .filter(|(f, g)| !f.is_zero() && !g.is_zero())
            .collect();
        let mut left: Vec<_> = pairs.iter().map(|&(f, _)| f).collect();
        let mut right: Vec<_> = pairs.iter().map(|&(_, g)| g).collect();
        left.push(&column[n + 1]);
        right.push(&one);
        let mut sum = Accumulator::new(&left, &right);
        for pair in 0..pairs.len() {
            transform.poisson.accumulate(&mut sum, (pair, pair));
        }
        sum.add_product((pairs.len(), pairs.len()), n as i64 + 1);
        sum.finish(pause)
    }

    /// The last cell computed: g_{0,N} = f_{0,N}.
    fn corner(&self) -> &Polynomial<C> {
        // Columns are never empty: `new` fills the first, `extend` every one that it adds.
        &self.columns[self.columns.len() - 1][0]
    }

    /// Completes the last anti-diagonal once T_N is known. {h₀; T_N} = −image/(N−1)! enters g_{N−1,1} and, by the recursion, g_{n,q} as −image/n!. This needs
    /// no bracket.
    fn subtract(&mut self, image: &Polynomial<C>) -> Result<(), Error> {
        let order = self.columns.len() - 1;
        let one = Polynomial::constant(C::one());
        let mut share = one.clone(); // 1/n!
        for n in 0..order {
            if n > 1 {
                share = share.over(n as i64)?;
            }
            let cell = &mut self.columns[order - n][n];
            let mut sum = Accumulator::new(&[cell, image], &[&one, &share]);
            sum.add_product((0, 0), 1);
            sum.add_product((1, 1), -1);
            *cell = sum.finish(&mut || Ok(()))?;
        }
        Ok(())
    }
}
