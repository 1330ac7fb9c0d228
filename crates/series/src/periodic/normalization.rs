//! The normalization with a generator W = Σ εᵐ W_{m+1} in the new variables.
//!
//! A part H_j of the Hamiltonian has the series F_0 = H_j, F_1, … in the new variables, and K is the sum of those of all parts,
//!
//! ```text
//! i F_i = Σ_{0≤m<i} {F_{i−1−m}; W_{m+1}},    K_n = Σ_j F_{n−j} of H_j
//! ```
//!
//! Nothing follows from the single F of the last order, so that their sum is formed at once, with one bracket for each generator. A function f of the old variables takes
//! N(N+1)/2 brackets by the same recursion.

use super::row::Periodic;
use crate::bracket::Poisson;
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::product::{Accumulator, Pause};
use crate::triangle::{LieTransform, Normalization, Progress, Removal, stop};

/// F_0, F_1, … of the parts of a Hamiltonian, and the generators.
struct Parts<'a> {
    poisson: &'a Poisson,
    generators: Vec<Polynomial<Periodic>>,
    series: Vec<Vec<Polynomial<Periodic>>>,
}

/// Normalizes H = Σ εⁿ `hamiltonian[n]` to an order. `solve` removes what is not kept. The transform is that of −W, from the new variables to the old ones: its `inverse` takes
/// functions of the old variables to the new ones, and `direct` the other way.
///
/// # Errors
/// - Those of `solve`; a callback that returns `Break`: [`Error::Interrupted`].
pub(super) fn normalize(
    hamiltonian: &[Polynomial<Periodic>],
    poisson: &Poisson,
    mut solve: impl FnMut(usize, &Polynomial<Periodic>) -> Result<Removal<Periodic>, Error>,
    progress: &mut Progress<'_>,
) -> Result<Normalization<Periodic>, Error> {
    let order = hamiltonian.len() - 1;
    let series = vec![vec![hamiltonian[0].clone()]];
    let mut parts = Parts { poisson, generators: Vec::new(), series };
    let mut normal = vec![hamiltonian[0].clone()];
    for (n, part) in hamiltonian.iter().enumerate().skip(1) {
        let pause = &mut || stop(progress(n - 1, order), n - 1, order);
        let mut known = part.clone();
        known += &if n < order { parts.extend(pause)? } else { parts.last_sum(pause)? };
        // {h₀; W_n}/n = −image
        let Removal { image, solution } = solve(n, &known)?;
        parts.generators.push(solution.scale(&Periodic::real(n as f64)));
        known -= &image;
        normal.push(known);
        if n < order {
            parts.series[0][n] -= &image;
            parts.series.push(vec![part.clone()]);
        }
    }
    stop(progress(order, order), order, order)?;
    let negative = parts.generators.iter().map(|generator| generator.scale(&Periodic::real(-1.0))).collect();
    Ok(Normalization { hamiltonian: normal, transform: LieTransform::new(poisson.clone(), negative) })
}

impl Parts<'_> {
    /// Adds the next F of each part, and returns their sum. The generator that is not yet known counts as 0.
    fn extend(&mut self, pause: &mut Pause<'_>) -> Result<Polynomial<Periodic>, Error> {
        let mut sum = Polynomial::zero();
        for part in 0..self.series.len() {
            let known = &self.series[part];
            let next = self.brackets(&known.iter().rev().collect::<Vec<_>>(), pause)?.over(known.len() as i64)?;
            sum += &next;
            self.series[part].push(next);
        }
        Ok(sum)
    }

    /// The sum of the next F of all parts.
    fn last_sum(&self, pause: &mut Pause<'_>) -> Result<Polynomial<Periodic>, Error> {
        let factor = |m: usize| {
            let mut sum = Polynomial::zero();
            for known in self.series.iter().filter(|known| known.len() > m) {
                sum += &known[known.len() - 1 - m].over(known.len() as i64)?;
            }
            Ok(sum)
        };
        let factors: Result<Vec<_>, Error> = (0..self.generators.len()).map(factor).collect();
        self.brackets(&factors?.iter().collect::<Vec<_>>(), pause)
    }

    /// The sum of the brackets of `left` with W_1, W_2, …
    fn brackets(&self, left: &[&Polynomial<Periodic>], pause: &mut Pause<'_>) -> Result<Polynomial<Periodic>, Error> {
        let right: Vec<_> = self.generators.iter().take(left.len()).collect();
        let mut sum = Accumulator::new(left, &right);
        (0..right.len()).for_each(|m| self.poisson.accumulate(&mut sum, (m, m)));
        sum.finish(pause)
    }
}
