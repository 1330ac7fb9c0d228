//! Normal forms about a periodic motion, on a grid of times.

use std::f64::consts::{FRAC_PI_2, TAU};

use andoyer_series::birkhoff::{Mode, PhaseSpace, normalize};
use andoyer_series::periodic::{
    DrivenForm, DrivenHamiltonian, DrivenOptions, Grid, MOST_WORK, SampledHamiltonian, terms_at,
};
use andoyer_series::progress::quiet;
use andoyer_series::{Error, Monomial, Polynomial};
use num_complex::Complex;

fn options(order: usize) -> DrivenOptions {
    DrivenOptions { order, tolerance: 1e-12, harmonics: 252, smallest_divisor: 1e-9, work: MOST_WORK }
}

/// A form from text with the phases M, N, as many as there are rates.
fn form(text: &str, pairs: &[(&str, &str)], rates: &[f64], order: usize) -> Result<DrivenForm, Error> {
    let space = PhaseSpace::new(pairs)?.with_driven(&["M", "N"][..rates.len()])?;
    let hamiltonian: Polynomial<f64> = space.parse(text)?;
    let sampled = SampledHamiltonian::new(pairs.len(), |phases: &[f64]| terms_at(&hamiltonian, &space, phases));
    DrivenForm::new(&sampled, rates, options(order), &mut quiet)
}

fn omega(form: &DrivenForm) -> f64 {
    form.modes()[0].frequency().re
}

/// The largest distance of the motion by a form from an integration, over some periods of the phase, which starts at 0.
fn miss(
    form: &DrivenForm,
    rate: f64,
    start: [f64; 2],
    periods: usize,
    rates: impl Fn(f64, [f64; 2]) -> [f64; 2],
) -> Result<f64, Error> {
    let normal = form.at(&[0.0]).to_normal(&start)?;
    let proper = form.frequencies(&form.actions_of(&normal))?;
    let (steps, mut state, mut most) = (4000, start, 0.0_f64);
    let h = TAU / rate / f64::from(steps);
    for step in 0..steps * periods as i32 {
        let t = f64::from(step) * h;
        let moved = |k: [f64; 2], by: f64| [state[0] + by * k[0], state[1] + by * k[1]];
        let one = rates(t, state);
        let two = rates(t + h / 2.0, moved(one, h / 2.0));
        let three = rates(t + h / 2.0, moved(two, h / 2.0));
        let four = rates(t + h, moved(three, h));
        state = std::array::from_fn(|i| state[i] + h / 6.0 * (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i]));
        if step % 971 == 970 {
            let seen = form.at(&[rate * (t + h)]).from_normal(&form.advanced(&normal, &proper, t + h))?;
            most = most.max((seen[0] - state[0]).abs().max((seen[1] - state[1]).abs()));
        }
    }
    Ok(most)
}

#[test]
fn the_exponent_of_mathieu_is_the_root_of_hills_determinant() -> Result<(), Error> {
    // The root for a = 0.09, q = 0.1 of Hill's determinant with 29 rows, by mpmath with 20 digits.
    for rate in [1.0, -1.0] {
        let form = form("(p^2 + 0.09*x^2)/2 - 0.1*x^2*cos(2*M)", &[("x", "p")], &[rate], 0)?;
        assert!((omega(&form) - 0.309_063_060_648_002_24).abs() < 2e-15, "{}", omega(&form));
    }
    Ok(())
}

/// The planar Hamiltonian of a locked body, p²/2 − (3/4) s (a/ρ)³ cos 2(ψ + r M − f), s = (B − A)/C, about ψ = 0, p = r.
fn planar(e: f64, r: f64, s: f64, degree: u32) -> impl Fn(&[f64]) -> Result<Vec<(Monomial, f64)>, Error> + Sync {
    move |phases: &[f64]| {
        let (cube, angle) = forcing(e, r, phases[0]);
        let mut terms = vec![(Monomial::new(&[0, 2])?, 0.5)];
        let mut factor = 1.0;
        for k in 1..=degree {
            factor *= 2.0 / f64::from(k);
            // The k-th derivative of cos.
            let slope = (angle + f64::from(k) * FRAC_PI_2).cos();
            terms.push((Monomial::new(&[k, 0])?, -0.75 * s * cube * factor * slope));
        }
        Ok(terms)
    }
}

/// (a/ρ)³ and 2(r M − f).
fn forcing(e: f64, r: f64, anomaly: f64) -> (f64, f64) {
    let turn = TAU * (anomaly / TAU).round();
    let mean = anomaly - turn;
    let mut x = mean;
    for _ in 0..60 {
        x -= (x - e * x.sin() - mean) / (1.0 - e * x.cos());
    }
    let f = 2.0 * (((1.0 + e) / (1.0 - e)).sqrt() * (x / 2.0).tan()).atan();
    ((1.0 - e * x.cos()).powi(-3), 2.0 * (r * anomaly - f - turn))
}

#[test]
fn a_planar_libration_from_samples_is_that_of_an_integration() -> Result<(), Error> {
    for (e, r, s, order, bound) in [(0.01, 1.0, 0.1, 8, 1e-9), (0.2056, 1.5, 1e-4, 4, 1e-9), (0.05, 1.0, 0.1, 6, 1e-5)]
    {
        let form =
            DrivenForm::new(&SampledHamiltonian::new(1, planar(e, r, s, 14)), &[1.0], options(order), &mut quiet)?;
        let rates = |t: f64, [psi, p]: [f64; 2]| {
            let (cube, angle) = forcing(e, r, t);
            [p, -1.5 * s * cube * (2.0 * psi + angle).sin()]
        };
        let error = miss(&form, 1.0, [0.02, 0.0], 30, rates)?;
        assert!(error < bound, "{e}: {error:e}");
    }
    Ok(())
}

#[test]
fn a_driven_duffing_oscillator_moves_as_its_integration() -> Result<(), Error> {
    let form = form("(p^2 + x^2)/2 + x^4/4 - 0.05*x*cos(M)", &[("x", "p")], &[0.37], 8)?;
    let rates = |t: f64, [x, p]: [f64; 2]| [p, -x - x.powi(3) + 0.05 * (0.37 * t).cos()];
    let error = miss(&form, 0.37, [0.1, 0.0], 10, rates)?;
    assert!(error < 1e-9, "{error:e}");
    Ok(())
}

#[test]
fn a_linear_oscillator_with_two_forces_has_the_motion_of_the_formula() -> Result<(), Error> {
    let form = form("(p^2 + 4*x^2)/2 - x*cos(M) - 0.5*x*sin(3*N)", &[("x", "p")], &[1.0, 0.7], 2)?;
    for phases in [[0.3, 2.0], [-1.0, 0.1]] {
        let [x, _] = form.periodic(&phases)[..] else { panic!() };
        let exact = phases[0].cos() / 3.0 + 0.5 * (3.0 * phases[1]).sin() / (4.0 - 2.1 * 2.1);
        assert!((x - exact).abs() < 1e-14, "{x} {exact}");
    }
    assert!((omega(&form) - 2.0).abs() < 1e-15);
    Ok(())
}

#[test]
fn functions_are_transported_to_the_variables_of_the_states() -> Result<(), Error> {
    let form = form("(p^2 + x^2)/2 + x^4/4 - 0.05*x*cos(M)", &[("x", "p")], &[0.37], 8)?;
    let (phases, state) = ([1.3], [0.05, -0.03]);
    let normal = form.at(&phases).to_normal(&state)?;
    let x = Polynomial::variable(0)?;
    let seen = form.direct(&x.power(2)?, &phases, &mut quiet)?.evaluate(&normal)?;
    assert!((seen - state[0] * state[0]).abs() < 1e-12, "{seen}");
    let back = form.inverse(&x, &phases, &mut quiet)?.evaluate(&state)?;
    assert!((back - normal[0]).abs() < 1e-10, "{back} {}", normal[0]);
    let moved = form.trajectory(&state, &phases, &[0.0, 2.0])?;
    let later = form.at(&[1.3 + 0.74]);
    let rates = form.frequencies(&form.actions_of(&normal))?;
    let other = later.from_normal(&form.advanced(&normal, &rates, 2.0))?;
    assert!((moved[0][0] - state[0]).abs() < 1e-14 && (moved[1][1] - other[1]).abs() < 1e-13, "{moved:?} {other:?}");
    Ok(())
}

#[test]
fn the_fourier_series_of_a_linear_oscillator_has_its_forced_motion() -> Result<(), Error> {
    let form = form("(p^2 + 4*x^2)/2 - x*cos(M)", &[("x", "p")], &[1.0], 0)?;
    let forced = form.fourier(&[0.0], 1e-13)?;
    let [harmonic] = &forced[..] else { panic!("{forced:?}") };
    assert_eq!(harmonic.multiples, [0, 1]);
    // x = cos(M)/3, p = −sin(M)/3
    let third = Complex::from(1.0 / 3.0);
    assert!((harmonic.amplitudes[0] - third).norm() < 1e-15, "{harmonic:?}");
    assert!((harmonic.amplitudes[1] - third * Complex::i()).norm() < 1e-15, "{harmonic:?}");
    let free = form.fourier(&[0.08], 1e-13)?;
    let free = free.iter().find(|harmonic| harmonic.multiples == [1, 0]).map(|harmonic| harmonic.amplitudes[0].norm());
    // √(2I/ω)
    assert!(free.is_some_and(|size| (size - 0.08_f64.sqrt()).abs() < 1e-15), "{free:?}");
    Ok(())
}

#[test]
fn a_state_whose_linear_part_leaves_a_mode_at_rest_has_its_normal_variables() -> Result<(), Error> {
    let pairs = [("q", "p"), ("Q", "P")];
    let form = form("(p^2 + q^2)/2 + (P^2 + 3*Q^2)/2 + q^2*Q*(1 + 0.1*cos(M))", &pairs, &[0.3], 6)?;
    let (now, state) = (form.at(&[0.4]), [0.05, 0.0, 0.0, 0.0]);
    let normal = now.to_normal(&state)?;
    assert!(normal[3].abs() > 1e-4 && normal[3].abs() < 1e-2, "{normal:?}");
    for (seen, x) in now.from_normal(&normal)?.iter().zip(state) {
        assert!((seen - x).abs() < 1e-16, "{seen} {x}");
    }
    Ok(())
}

#[test]
fn forms_of_other_orders_about_the_same_motion_are_those_made_alone() -> Result<(), Error> {
    let sampled = SampledHamiltonian::new(1, planar(0.05, 1.0, 0.1, 14));
    let alone = |order| DrivenForm::new(&sampled, &[1.0], options(order), &mut quiet);
    let (low, high) = (alone(2)?, alone(6)?);
    for (order, expected) in [(6, &high), (2, &low)] {
        for known in [&low, &high] {
            let form = known.to_order(&sampled, order, &mut quiet)?;
            assert_eq!((form.order(), form.in_complex()), (order, expected.in_complex()));
        }
    }
    Ok(())
}

#[test]
fn the_terms_to_an_order_are_the_form_of_that_order() -> Result<(), Error> {
    let sampled = SampledHamiltonian::new(1, planar(0.05, 1.0, 0.1, 14));
    let high = DrivenForm::new(&sampled, &[1.0], options(6), &mut quiet)?;
    let (state, orders) = ([0.1, 0.02], [0, 2, 4, 6]);
    let found = high.at(&[0.7]).to_normal_by_orders(&state, &orders)?;
    for (order, (normal, missed)) in orders.into_iter().zip(found) {
        let form = high.to_order(&sampled, order, &mut quiet)?;
        let alone = form.at(&[0.7]).to_normal(&state)?;
        let miss = normal.iter().zip(&alone).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(miss < 1e-16 && missed < 1e-16, "{order}: {normal:?} {alone:?}, {missed:e}");
        let actions = form.actions_of(&normal);
        let (one, two) = (high.frequencies_of_order(order, &actions)?, form.frequencies(&actions)?);
        assert!((one[0] - two[0]).abs() < 1e-15, "{order}: {one:?} {two:?}");
    }
    Ok(())
}

#[test]
fn sizes_by_order_are_those_of_what_the_terms_of_an_order_add() -> Result<(), Error> {
    let sampled = SampledHamiltonian::new(1, planar(0.05, 1.0, 0.1, 14));
    let high = DrivenForm::new(&sampled, &[1.0], options(4), &mut quiet)?;
    let low = high.to_order(&sampled, 2, &mut quiet)?;
    let normal = [0.03, 0.1];
    let (sizes, gains) = (high.sizes(&high.actions_of(&normal))?, high.gains()?);
    assert!((sizes[0][0] - gains[0][0] * 0.03_f64.hypot(0.1)).abs() < 1e-15);
    let bound = [0, 1].map(|variable| sizes[3][variable] + sizes[4][variable]);
    let mut most = [0.0_f64; 2];
    for k in 0..40 {
        let turned = high.advanced(&normal, &[1.0], f64::from(k));
        let phases = [0.37 * f64::from(k)];
        let [one, two] = [&high, &low].map(|form| form.at(&phases).from_normal(&turned));
        let (one, two) = (one?, two?);
        most = [0, 1].map(|variable| most[variable].max((one[variable] - two[variable]).abs()));
    }
    for (most, bound) in most.into_iter().zip(bound) {
        assert!(most <= bound && most > bound / 10.0, "{most:e} {bound:e}");
    }
    Ok(())
}

#[test]
fn sizes_add_different_multiples_in_the_square() -> Result<(), Error> {
    // Lindstedt's series of x'' = −x − x²: x = a cos φ − a²/2 + (a²/6) cos 2φ, so that p + ix has the terms −i a²/2, (i a²/4) e^{2iφ} and −(i a²/12) e^{−2iφ}.
    let form = form("(p^2 + x^2)/2 + x^3/3", &[("x", "p")], &[], 1)?;
    let action = 0.005;
    let exact = 2.0 * action * 46.0_f64.sqrt() / 12.0;
    let size = form.sizes(&[action])?[1][0];
    assert!((size - exact).abs() < 1e-15, "{size} {exact}");
    Ok(())
}

#[test]
fn a_saddle_has_its_rate_and_its_forced_motion() -> Result<(), Error> {
    for drive in [2.0, -2.0] {
        let form = form("(p^2 - x^2)/2 - x*cos(M)", &[("x", "p")], &[drive], 2)?;
        let Mode::Hyperbolic { rate } = form.modes()[0] else { panic!("{:?}", form.modes()) };
        assert!((rate - 1.0).abs() < 1e-14, "{rate}");
        assert!((form.periodic(&[0.4])[0] + 0.4_f64.cos() / 5.0).abs() < 1e-14);
    }
    Ok(())
}

#[test]
fn without_a_phase_the_form_is_that_of_the_exact_normalization() -> Result<(), Error> {
    let text = "(p^2 + q^2)/2 + (P^2 + 3*Q^2)/2 + q^2*Q - Q^3/7 + q^4/5";
    let pairs = [("q", "p"), ("Q", "P")];
    let (driven, space) = (form(text, &pairs, &[], 6)?, PhaseSpace::new(&pairs)?);
    let plain = normalize(&space.parse::<f64>(text)?, 6, &space)?.in_actions()?;
    for (monomial, c) in driven.in_actions()?.terms() {
        let other = plain.coefficient(&monomial).copied().unwrap_or(0.0);
        assert!((c - other).abs() < 1e-13 * (1.0 + other.abs()), "{monomial:?}: {c} {other}");
    }
    Ok(())
}

#[test]
fn what_has_no_frame_is_an_error_that_says_why() {
    let pair = [("x", "p")];
    // The first tongue of Mathieu's equation: negative multipliers over π, positive ones over 2π.
    let unstable = form("(p^2 + x^2)/2 - 0.2*x^2*cos(M)", &pair, &[2.0], 0);
    assert!(matches!(unstable, Err(Error::MultiplierUnsupported { .. })), "{unstable:?}");
    let saddle = form("(p^2 + x^2)/2 - 0.2*x^2*cos(2*M)", &pair, &[1.0], 0).map(|form| form.modes().to_vec());
    assert!(matches!(saddle.as_deref(), Ok([Mode::Hyperbolic { .. }])), "{saddle:?}");
    let resonant = form("(p^2 + x^2)/2 - x*cos(M)", &pair, &[1.0], 0);
    assert!(matches!(resonant, Err(Error::NoPeriodicMotion { .. })), "{resonant:?}");
    let small = form("(p^2 + x^2)/2 + x^3*cos(M)", &pair, &[3.0], 2);
    assert!(matches!(small, Err(Error::SmallDivisor { .. })), "{small:?}");
}

#[test]
fn a_harmonic_that_is_rounding_has_no_small_divisor() -> Result<(), Error> {
    // The coefficients have the harmonics 0 and 3; the frequency is that of the phase, so every harmonic j of a term with k = −j has the divisor 0.
    let form = form("(p^2 + x^2)/2 + x^4/4 + 0.1*x^4*cos(3*M)", &[("x", "p")], &[1.0], 2)?;
    // K of the quartic alone: the drive has no mean.
    let actions = form.in_actions()?;
    let [linear, square] = [1, 2].map(|power| actions.coefficient(&Monomial::new(&[power]).unwrap_or(Monomial::ONE)));
    assert!(linear == Some(&1.0) && square.is_some_and(|c| (c - 0.375).abs() < 1e-14), "{actions:?}");
    Ok(())
}

#[test]
fn newtons_iteration_passes_motions_that_have_no_real_frame() -> Result<(), Error> {
    // Nonlinear Mathieu equation with a force. The equilibrium lies in the first tongue. Expected: fixed points of the map of a period and its multipliers, by SciPy's DOP853 and fsolve.
    let forced = |force: f64| {
        form(&format!("(p^2 + 0.25*x^2)/2 + 0.1*x^4 - (0.1*x^2 + {force}*x)*cos(M)"), &[("x", "p")], &[1.0], 0)
    };
    let stable = forced(0.3)?;
    assert!((stable.periodic(&[0.0])[0] + 0.513_282_376).abs() < 1e-8, "{:?}", stable.periodic(&[0.0]));
    assert!(((TAU * omega(&stable)).cos() + 0.821_554_63).abs() < 1e-7, "{}", omega(&stable));
    // The multipliers of an error are those of the periodic motion, not those of a step on the way to it.
    let Err(Error::MultiplierUnsupported { mut multipliers, .. }) = forced(0.2) else { panic!("{:?}", forced(0.2)) };
    multipliers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let far = multipliers.iter().zip([-1.397_326_27, -0.715_652_47]).map(|([re, im], known)| (re - known).hypot(*im));
    assert!(multipliers.len() == 2 && far.fold(0.0, f64::max) < 1e-6, "{multipliers:?}");
    // Frames exist at the start and at the end, and not between them.
    let strong = form("(p^2 + x^2)/2 + x^4/4 - 3*x*cos(M)", &[("x", "p")], &[1.7], 0)?;
    assert!((strong.periodic(&[0.0])[0] - 2.173_003).abs() < 1e-6, "{:?}", strong.periodic(&[0.0]));
    Ok(())
}

#[test]
fn coefficients_that_are_sines_alone_have_the_period_of_the_phase() -> Result<(), Error> {
    // They are 0 at the phase 0 and rounding at 2π.
    let sine = SampledHamiltonian::new(1, |phases: &[f64]| Ok(vec![(Monomial::new(&[2])?, (3.0 * phases[0]).sin())]));
    assert!(sine.between_times(&Grid::new(&[(1.0, 4)]))? < 1e-14);
    let half = SampledHamiltonian::new(1, |phases: &[f64]| Ok(vec![(Monomial::new(&[2])?, (phases[0] / 2.0).sin())]));
    assert!(matches!(half.between_times(&Grid::new(&[(1.0, 4)])), Err(Error::NotPeriodic { phase: 0, .. })));
    Ok(())
}

#[test]
fn a_state_beyond_the_range_of_the_series_has_no_normal_variables() -> Result<(), Error> {
    let form = form("(p^2 + x^2)/2 + x^4/4 - 0.05*x*cos(M)", &[("x", "p")], &[1.7], 6)?;
    assert!(form.at(&[0.0]).to_normal(&[0.3, 0.0]).is_ok());
    // The periodic motion itself, which is at a distance of rounding.
    assert!(form.at(&[0.0]).to_normal(&form.periodic(&[0.0])).is_ok());
    let beyond = form.at(&[0.0]).to_normal(&[3.0, 0.0]);
    assert!(
        matches!(beyond, Err(Error::BeyondSeries { miss, distance }) if miss > 0.03 && (distance - 3.026).abs() < 0.01),
        "{beyond:?}"
    );
    assert!(matches!(form.trajectory(&[3.0, 0.0], &[0.0], &[0.0]), Err(Error::BeyondSeries { .. })));
    // Neither have normal variables and actions a state there.
    assert!(form.at(&[0.0]).from_normal(&[0.3, 0.0]).is_ok() && form.frequency_map(&[0.05], &[0.0]).is_ok());
    assert!(matches!(form.at(&[0.0]).from_normal(&[3.0, 0.0]), Err(Error::BeyondSeries { .. })));
    assert!(matches!(form.frequency_map(&[5.0], &[0.0]), Err(Error::BeyondSeries { .. })));
    Ok(())
}
