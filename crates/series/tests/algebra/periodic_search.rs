//! Periodic motions and frequencies of driven systems, against own integrations: the branch of the rotation number, rates of the phase, resonances and refusals.

use std::f64::consts::TAU;

use andoyer_series::birkhoff::PhaseSpace;
use andoyer_series::periodic::DrivenNormalForm;
use andoyer_series::progress::quiet;
use andoyer_series::{Error, Polynomial};

fn form(text: &str, pairs: &[(&str, &str)], rates: &[f64], start: Option<&[f64]>) -> Result<DrivenNormalForm, Error> {
    let space = PhaseSpace::new(pairs)?.with_driven(&["M", "L"][..rates.len()])?;
    let hamiltonian: Polynomial<f64> = space.parse(text)?;
    let phases: Vec<_> = rates.iter().map(|&rate| (rate, 0.0)).collect();
    DrivenNormalForm::from_state((&hamiltonian, &space), 0, &phases, 1e-6, start, &mut quiet)
}

fn omegas(form: &DrivenNormalForm) -> Vec<f64> {
    form.form().modes().iter().map(|mode| mode.frequency().re).collect()
}

/// A step of the method of Runge and Kutta.
fn stepped<const N: usize>(
    slope: &dyn Fn(f64, [f64; N]) -> [f64; N],
    time: f64,
    state: [f64; N],
    step: f64,
) -> [f64; N] {
    let moved = |by: [f64; N], part: f64| std::array::from_fn(|k| state[k] + part * step * by[k]);
    let first = slope(time, state);
    let second = slope(time + step / 2.0, moved(first, 0.5));
    let third = slope(time + step / 2.0, moved(second, 0.5));
    let last = slope(time + step, moved(third, 1.0));
    std::array::from_fn(|k| state[k] + step / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + last[k]))
}

/// The mean rate of the angle of (x, x′) of x″ + (a − 2q cos 2t) x = 0 over many periods.
fn rotation_number(a: f64, q: f64) -> f64 {
    let (turns, steps) = (300, 400);
    let step = TAU / 2.0 / f64::from(steps);
    let rate =
        |t: f64, [angle]: [f64; 1]| [angle.cos().powi(2) + (a - 2.0 * q * (2.0 * t).cos()) * angle.sin().powi(2)];
    let end = (0..turns * steps).fold([0.0], |angle, k| stepped(&rate, f64::from(k) * step, angle, step));
    end[0] / (f64::from(turns * steps) * step)
}

const STABLE: [(f64, f64); 8] = [
    (3.0, 1.0),
    (16.848392313201924, 12.0),
    (38.61732689233457, 20.0),
    (1.8823, 5.0),
    (-2.8099, 3.0),
    (1.978823993517208, 5.0),
    (28.031399739857314, 20.0),
    (-0.3, 1.0),
];

#[test]
fn exponents_of_mathieu_are_its_rotation_numbers_at_each_way_to_write_the_drive() -> Result<(), Error> {
    for (a, q) in STABLE {
        let expected = rotation_number(a, q);
        for (waves, rate) in [(1, 2.0), (2, 1.0), (4, 0.5), (1, -2.0), (2, -1.0)] {
            let text = format!("(p^2 + {a}*x^2)/2 - {q}*x^2*cos({waves}*M)");
            let found = omegas(&form(&text, &[("x", "p")], &[rate], None)?)[0];
            assert!(
                (found - expected).abs() < 5e-3,
                "a = {a}, q = {q}, rate {rate}: {found}, rotation number {expected}"
            );
        }
    }
    Ok(())
}

/// a, q, and the exponent: between n and n + 1 by the characteristic values a_n < a < b_{n+1} of SciPy's `mathieu_a` and `mathieu_b`, and a root of Hill's determinant, as two continued
/// fractions, in 40 digits of mpmath. In the last ten the solutions grow by up to 1e8 and fall again within a period, so that rounding errors are far above 1e-12.
const IN_BANDS: [(f64, f64, f64); 20] = [
    (-9.06854852602081, 30.321372995192494, 2.532378254),
    (5.786076866742202, 35.21519833840915, 3.372455109),
    (23.282961690351044, 38.223720797067365, 4.477779570),
    (39.869233526524646, 24.059004375346817, 5.291047684),
    (51.48020460012074, 22.25263844040495, 6.726976196),
    (64.8266369819395, 18.432421440118745, 7.870256632),
    (74.45713409667084, 20.818672051025175, 8.442223503),
    (106.58956453724969, 45.371747411081714, 9.713943225),
    (124.10966742100764, 39.21136977942661, 10.826476793),
    (133.59159683824842, 45.31325197305112, 11.174900015),
    (-27.75115241573261, 29.521105247429354, 1.113964780),
    (-38.3635721897008, 36.70652805750474, 1.747509918),
    (-50.3464125944604, 30.57459692609079, 0.327843997),
    (-56.46057319131988, 33.927111039083876, 0.647885689),
    (-53.17919826316713, 46.37053362268842, 1.849468638),
    (-12.061760355192535, 33.025691048215165, 2.608972601),
    (-10.736673208883765, 17.113360133081077, 1.895466326),
    (-28.89313993659326, 18.63433719613766, 0.278592379),
    (-6.64608927502285, 48.899331184805554, 3.709272042),
    (-11.588440589318054, 32.60417444492933, 2.604453349),
];

#[test]
fn exponents_of_mathieu_between_two_characteristic_values_have_their_order() -> Result<(), Error> {
    for (a, q, expected) in IN_BANDS {
        let found = omegas(&form(&format!("(p^2 + {a}*x^2)/2 - {q}*x^2*cos(M)"), &[("x", "p")], &[2.0], None)?)[0];
        assert!((found - expected).abs() < 2e-6, "a = {a}, q = {q}: {found}, {expected}");
    }
    Ok(())
}

#[test]
fn the_exponent_of_a_slow_drive_is_the_mean_frequency() -> Result<(), Error> {
    // The phase of the solution turns by some 36 turns more and less than the mean one over the period. Expected: the mean of √(1 + 0.6 cos M), the adiabatic limit, whose error is of the square of the rate.
    let mean = (0..1000).map(|k| (1.0 + 0.6 * (TAU * f64::from(k) / 1000.0).cos()).sqrt()).sum::<f64>() / 1000.0;
    let found = omegas(&form("(p^2 + x^2)/2 + 0.3*x^2*cos(M)", &[("x", "p")], &[0.004], None)?)[0];
    assert!((found - mean).abs() < 1e-5, "{found}, {mean}");
    Ok(())
}

#[test]
fn exponents_of_several_pairs_are_the_rotation_numbers_of_each() -> Result<(), Error> {
    // Two equations of Mathieu, the second with a negative energy, in one frame and behind a shear p → p + c y, s → s + c x; the last ones have one frequency without the drive.
    for ((a, q), (b, r), sign) in [
        ((16.848392313201924, 12.0), (3.0, 1.0), 1.0),
        ((-2.8099, 3.0), (38.61732689233457, 20.0), -1.0),
        ((5.3, 1.0), (5.3, 0.2), 1.0),
    ] {
        let expected = [rotation_number(a, q), sign * rotation_number(b, r)];
        for shear in [0.0, 0.4] {
            let text = format!(
                "((p + {shear}*y)^2 + {a}*x^2)/2 - {q}*x^2*cos(M) + {sign}*((s + {shear}*x)^2 + {b}*y^2)/2 - {sign}*{r}*y^2*cos(M)"
            );
            let mut found = omegas(&form(&text, &[("x", "p"), ("y", "s")], &[2.0], None)?);
            if (found[0] - expected[0]).abs() > (found[1] - expected[0]).abs() {
                found.reverse();
            }
            let good = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 5e-3);
            assert!(good, "{text}: {found:?}, {expected:?}");
        }
    }
    Ok(())
}

#[test]
fn a_double_multiplier_with_two_directions_has_a_frame() -> Result<(), Error> {
    // The second pair makes half a turn, a turn and three halves over the period of the drive of the first.
    for omega in [0.5, 1.0, 1.5] {
        let text = format!("(p^2 + 1.7*x^2)/2 - 0.3*x^2*cos(M) + (s^2 + {}*y^2)/2", omega * omega);
        let found = omegas(&form(&text, &[("x", "p"), ("y", "s")], &[1.0], None)?);
        assert!((found[1] - omega).abs() < 1e-12, "{found:?}");
    }
    Ok(())
}

#[test]
fn growth_beyond_floats_is_named() {
    let text = "(p^2 - x^2)/2 + 0.3*p*x + 0.8*x^2*cos(M)";
    let found = form(text, &[("x", "p")], &[0.005], None);
    assert!(matches!(found, Err(Error::GrowthTooLarge { .. })), "{found:?}");
}

/// sin x as a polynomial whose first neglected term is 2e-8 at x = 1.94.
const PENDULUM: &str =
    "p^2/2 + x^2/2 - x^4/24 + x^6/720 - x^8/40320 + x^10/3628800 - x^12/479001600 + x^14/87178291200 - 0.1*x*cos(M)";

/// How far the equation of the pendulum misses a state after a period.
fn missed(rate: f64, start: [f64; 2]) -> f64 {
    let steps = 4000;
    let step = TAU / rate / f64::from(steps);
    let slope = |t: f64, [x, p]: [f64; 2]| [p, -x.sin() + 0.1 * (rate * t).cos()];
    let end = (0..steps).fold(start, |state, k| stepped(&slope, f64::from(k) * step, state, step));
    (end[0] - start[0]).hypot(end[1] - start[1])
}

#[test]
fn a_pendulum_at_resonance_has_its_periodic_motion() -> Result<(), Error> {
    for (rate, opposite) in
        [(1.0, None), (1.0 + 1e-9, None), (1.001, Some(false)), (0.9, Some(true)), (0.7, Some(false))]
    {
        let form = form(PENDULUM, &[("x", "p")], &[rate], None)?;
        let start = form.form().periodic(&[0.0]);
        let miss = missed(rate, [start[0], start[1]]);
        assert!(miss < 1e-7, "rate {rate}: {start:?} misses by {miss:e}");
        assert!(opposite.is_none_or(|opposite| opposite == form.form().is_opposite()), "rate {rate}: {start:?}");
    }
    Ok(())
}

#[test]
fn a_known_state_chooses_the_periodic_motion() -> Result<(), Error> {
    // At the rate 0.8 a motion in phase and one out of phase are stable.
    let near = form(PENDULUM, &[("x", "p")], &[0.8], None)?;
    let far = form(PENDULUM, &[("x", "p")], &[0.8], Some(&[-1.6, 0.0]))?;
    for (form, side) in [(&near, 1.0), (&far, -1.0)] {
        let start = form.form().periodic(&[0.0]);
        assert!(start[0] * side > 0.2 && missed(0.8, [start[0], start[1]]) < 1e-6, "{start:?}");
        assert_eq!(DrivenNormalForm::from_json(&form.to_json()?, &mut quiet)?, *form);
    }
    let short = form(PENDULUM, &[("x", "p")], &[0.8], Some(&[1.0]));
    assert!(matches!(short, Err(Error::StartUnsupported { variables: 2, phases: 1, .. })), "{short:?}");
    Ok(())
}

#[test]
fn the_search_with_two_phases_ends_at_its_work() {
    let text = "0.5792416322014877*(x^2+p^2)/2 + 1.6886280821812463*(y^2+s^2)/2 + 0.2684252858396374*p*s*x*p + 0.07519419111685618*s*cos(1*M) \
        + 0.2666771829262349*s*p*sin(2*M) + 0.24878156140489563*y*p*sin(2*L) - 0.25092159531090646*p*y*cos(2*L)";
    let found = form(text, &[("x", "p"), ("y", "s")], &[0.6692814952874311, 0.4774542856464093], None);
    assert!(matches!(found, Err(Error::DrivenWorkTooLarge { .. })), "{found:?}");
}
