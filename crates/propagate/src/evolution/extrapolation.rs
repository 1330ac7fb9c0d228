//! An explicit method of order 8 with an error of order 6: the modified midpoint rule with 2, 4, 6 and 8 parts of a step, extrapolated in the square of the part
//! (Gragg; Bulirsch and Stoer, Numer. Math. 8, 1, 1966). It needs 17 evaluations a step and no table of coefficients.
//!
//! A time within a step is reached by one shorter step from its start.

use crate::error::Error;

/// Angular momentum over its size at the epoch, inertial, and the excess of energy.
pub(super) type SlowState = [f64; 4];

const PARTS: [u32; 4] = [2, 4, 6, 8];

/// One step of length h from a state with its slope: the new state, and its difference from that of order 6.
pub(super) fn step(
    equations: &mut impl FnMut(f64, &SlowState) -> Result<SlowState, Error>,
    (time, h): (f64, f64),
    (state, slope): (&SlowState, &SlowState),
) -> Result<(SlowState, SlowState), Error> {
    let mut table = [[0.0; 4]; 4];
    let mut before = table;
    for (j, parts) in PARTS.into_iter().enumerate() {
        table[0] = midpoint(equations, (time, h, parts), (state, slope))?;
        for k in 1..=j {
            // T_(j,k) = T_(j,k−1) + (T_(j,k−1) − T_(j−1,k−1))/((n_j/n_(j−k))² − 1)
            let ratio = f64::from(parts) / f64::from(PARTS[j - k]);
            let factor = 1.0 / (ratio * ratio - 1.0);
            table[k] = std::array::from_fn(|i| table[k - 1][i] + (table[k - 1][i] - before[k - 1][i]) * factor);
        }
        before = table;
    }
    Ok((table[3], std::array::from_fn(|i| table[3][i] - table[2][i])))
}

/// The modified midpoint rule without its last smoothing, whose error has even powers of the part alone for an even number of parts.
fn midpoint(
    equations: &mut impl FnMut(f64, &SlowState) -> Result<SlowState, Error>,
    (time, h, parts): (f64, f64, u32),
    (state, slope): (&SlowState, &SlowState),
) -> Result<SlowState, Error> {
    let part = h / f64::from(parts);
    let mut last = *state;
    let mut here: SlowState = std::array::from_fn(|i| state[i] + part * slope[i]);
    for n in 1..parts {
        let slope = equations(time + part * f64::from(n), &here)?;
        let next = std::array::from_fn(|i| last[i] + 2.0 * part * slope[i]);
        (last, here) = (here, next);
    }
    Ok(here)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_eight() {
        // ẏ = −t y: y = exp(−t²/2)
        let error = |h: f64| {
            let mut equations = |t: f64, y: &SlowState| Ok(y.map(|y| -t * y));
            let start = (-0.5_f64).exp();
            let (end, estimate) = step(&mut equations, (1.0, h), (&[start; 4], &[-start; 4])).expect("a step");
            let error = (end[0] - (-0.5 * (1.0 + h) * (1.0 + h)).exp()).abs();
            assert!(error < estimate[0].abs());
            error
        };
        let order = (error(0.4) / error(0.2)).log2();
        assert!((8.7..9.2).contains(&order), "{order}"); // of the error of one step: 9
    }
}
