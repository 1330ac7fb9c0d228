//! The normal form in numbers against a numerical integration: three coupled modes with incommensurate frequencies.

use andoyer_series::{BirkhoffMap, Error, PhaseSpace, Polynomial, normalize};

/// Frequencies 1, √2 (r = √2) and √7 (r = 1/√7); cubic and quartic coupling without a symmetry.
fn three_modes() -> Result<(PhaseSpace, Polynomial<f64>), Error> {
    let space = PhaseSpace::new(&[("x", "X"), ("y", "Y"), ("z", "Z")])?;
    let h = space.parse(
        "(x^2 + X^2)/2 + (y^2 + 2*Y^2)/2 + (7*z^2 + Z^2)/2
         + 0.3*x^2*y + 0.2*x*y*z - 0.25*z^3 + 0.1*y^2*X*Z + 0.15*x*X*y*Y - 0.1*z^2*x^2",
    )?;
    Ok((space, h))
}

/// Hamilton's equations of a polynomial, integrated by extrapolating the modified midpoint rule (Bulirsch and Stoer).
struct Flow {
    gradient: Vec<Polynomial<f64>>,
}

impl Flow {
    fn new(h: &Polynomial<f64>, dimension: usize) -> Result<Self, Error> {
        Ok(Flow { gradient: (0..dimension).map(|slot| h.derivative(slot)).collect::<Result<_, _>>()? })
    }

    fn rate(&self, state: &[f64]) -> Result<Vec<f64>, Error> {
        let gradient = self.gradient.iter().map(|g| g.evaluate(state)).collect::<Result<Vec<_>, _>>()?;
        Ok(gradient.chunks(2).flat_map(|pair| [pair[1], -pair[0]]).collect())
    }

    fn midpoint(&self, start: &[f64], step: f64, n: usize) -> Result<Vec<f64>, Error> {
        let h = step / n as f64;
        let along = |from: &[f64], rate: &[f64], by: f64| -> Vec<f64> {
            from.iter().zip(rate).map(|(x, r)| x + by * r).collect()
        };
        let (mut before, mut now) = (start.to_vec(), along(start, &self.rate(start)?, h));
        for _ in 1..n {
            let next = along(&before, &self.rate(&now)?, 2.0 * h);
            before = std::mem::replace(&mut now, next);
        }
        let last = along(&before, &self.rate(&now)?, h);
        Ok(now.iter().zip(&last).map(|(a, b)| (a + b) / 2.0).collect())
    }

    /// One step, extrapolated to order 16: at steps of 0.2 the error is that of rounding.
    fn step(&self, start: &[f64], step: f64) -> Result<Vec<f64>, Error> {
        let mut previous: Vec<Vec<f64>> = Vec::new();
        for k in 1..=8 {
            let mut row = vec![self.midpoint(start, step, 2 * k)?];
            for (j, coarser) in (1..).zip(&previous) {
                let ratio = (k as f64 / (k - j) as f64).powi(2) - 1.0;
                row.push(row[j - 1].iter().zip(coarser).map(|(a, b)| a + (a - b) / ratio).collect());
            }
            previous = row;
        }
        Ok(previous.swap_remove(7))
    }
}

/// Largest error of the trajectory and largest drift of the actions over 30 time units, at an amplitude.
fn errors(order: usize, amplitude: f64) -> Result<(f64, f64), Error> {
    let (space, h) = three_modes()?;
    let map = BirkhoffMap::new(&normalize(&h, order, &space)?, &[])?;
    let flow = Flow::new(&h, 6)?;
    let start: Vec<f64> = [0.8, -0.3, 0.5, 0.4, -0.2, 0.9].iter().map(|value| amplitude * value).collect();
    let actions = map.actions(&start)?;
    let times: Vec<f64> = (1..=150).map(|k| 0.2 * f64::from(k)).collect();
    let (mut state, mut trajectory, mut drift) = (start.clone(), 0.0_f64, 0.0_f64);
    for expected in map.trajectory(&start, &times)? {
        state = flow.step(&state, 0.2)?;
        let largest = |sum: f64, (a, b): (&f64, &f64)| sum.max((a - b).abs());
        trajectory = state.iter().zip(&expected).fold(trajectory, largest);
        drift = map.actions(&state)?.iter().zip(&actions).fold(drift, largest);
    }
    Ok((trajectory, drift))
}

#[test]
fn the_integration_conserves_energy_to_rounding() -> Result<(), Error> {
    // 150 steps, each rounded at 1e-16 in energies of 5e-2.
    let (_, h) = three_modes()?;
    let flow = Flow::new(&h, 6)?;
    let mut state = vec![0.16, -0.06, 0.1, 0.08, -0.04, 0.18];
    let energy = h.evaluate(&state)?;
    for _ in 0..150 {
        state = flow.step(&state, 0.2)?;
    }
    assert!((h.evaluate(&state)? - energy).abs() < 2e-15, "{:e}", h.evaluate(&state)? - energy);
    Ok(())
}

#[test]
fn trajectory_and_actions_err_by_the_power_of_the_order() -> Result<(), Error> {
    // Left out at order N: degree N + 2 of the transformation and degree N + 4 of K (odd degrees have no kernel without a
    // resonance). States err by a^(N+2), actions, a product of two states, by a^(N+3). Halved amplitude: less by 2^(N+2) and
    // 2^(N+3), to within 7 % for the next orders.
    for (order, amplitude) in [(1, 0.01), (2, 0.02), (3, 0.03), (4, 0.05), (6, 0.08)] {
        let ((trajectory, drift), (half_trajectory, half_drift)) =
            (errors(order, amplitude)?, errors(order, amplitude / 2.0)?);
        let (state, action) = ((trajectory / half_trajectory).log2(), (drift / half_drift).log2());
        let power = order as f64 + 2.0;
        assert!((state - power).abs() < 0.1, "order {order}: {trajectory:e} falls by 2^{state}");
        assert!((action - power - 1.0).abs() < 0.1, "order {order}: {drift:e} falls by 2^{action}");
    }
    Ok(())
}

#[test]
fn a_higher_order_errs_less() -> Result<(), Error> {
    let by_order: Vec<_> = [0, 2, 4, 6, 8].into_iter().map(|order| errors(order, 0.1)).collect::<Result<_, _>>()?;
    assert!(by_order.windows(2).all(|pair| pair[1].0 < 0.2 * pair[0].0 && pair[1].1 < 0.2 * pair[0].1));
    Ok(())
}

#[test]
fn normal_coordinates_come_back() -> Result<(), Error> {
    // from_normal(to_normal(s)) = s but for degree N + 2: a⁸ = 4e-11 at a = 0.05, times coefficients of some 10².
    let (space, h) = three_modes()?;
    let map = BirkhoffMap::new(&normalize(&h, 6, &space)?, &[])?;
    let state = [0.05, -0.02, 0.03, 0.04, -0.01, 0.02];
    for back in [map.from_normal(&map.to_normal(&state)?)?, map.to_normal(&map.from_normal(&state)?)?] {
        assert!(back.iter().zip(&state).all(|(a, b)| (a - b).abs() < 4e-9), "{back:?}");
    }
    assert!(map.to_normal(&state)?.iter().zip(&state).any(|(a, b)| (a - b).abs() > 1e-5));
    Ok(())
}

#[test]
fn numbers_for_parameters_are_put_into_the_maps() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("q", "p")])?.with_parameters(&["a", "b"])?;
    let normal_form = normalize(&space.parse::<f64>("(q^2 + p^2)/2 + a*q^3 + b*q^4")?, 6, &space)?;
    let fixed = PhaseSpace::new(&[("q", "p")])?;
    let expected = normalize(&fixed.parse::<f64>("(q^2 + p^2)/2 + 0.3*q^3 - 0.2*q^4")?, 6, &fixed)?;
    let (map, expected) = (BirkhoffMap::new(&normal_form, &[0.3, -0.2])?, BirkhoffMap::new(&expected, &[])?);
    let state = [0.1, 0.05];
    for (a, b) in [
        (map.to_normal(&state)?, expected.to_normal(&state)?),
        (map.from_normal(&state)?, expected.from_normal(&state)?),
        (map.frequencies(&[0.01])?, expected.frequencies(&[0.01])?),
    ] {
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-14), "{a:?} {b:?}");
    }
    Ok(())
}
