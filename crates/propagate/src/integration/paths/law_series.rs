//! A law of the distance in the series of a motion: Clenshaw's recurrence with series in the place of numbers.

use crate::input::distance_law::DistanceLaw;
use crate::integration::series::{ROWS, Scalars, product};

/// The first `order` coefficients of a law, from those of r₀/r.
pub(crate) fn law_series(law: &DistanceLaw, ratio: &Scalars, order: usize) -> Scalars {
    let [a, b] = law.argument();
    let mut t = ratio.map(|part| a * part);
    t[0] += b;
    let times =
        |one: &Scalars| -> Scalars { std::array::from_fn(|k| if k < order { product(one, &t, k) } else { 0.0 }) };
    let (mut before, mut last) = ([0.0; ROWS], [0.0; ROWS]);
    for coefficient in law.coefficients()[1..].iter().rev() {
        let mut next = times(&before);
        next.iter_mut().zip(&last).for_each(|(next, last)| *next = 2.0 * *next - last);
        next[0] += coefficient;
        (before, last) = (next, before);
    }
    let mut sum = times(&before);
    sum.iter_mut().zip(&last).for_each(|(sum, last)| *sum -= last);
    sum[0] += law.coefficients()[0];
    sum
}
