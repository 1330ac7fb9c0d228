//! Beyond the range of the series every method of a form refuses, and within it the numbers are those of the system.

use andoyer_series::birkhoff::Resonances;
use andoyer_series::progress::quiet;
use andoyer_series::{BirkhoffMap, Error, PhaseSpace, normalize, normalize_with};
use num_rational::BigRational;

/// A name, a form, and the direction in which states are taken.
type Case = (&'static str, BirkhoffMap, Vec<f64>);

/// Forms of each kind.
fn forms() -> Result<Vec<Case>, Error> {
    let (one, two) = (PhaseSpace::new(&[("q", "p")])?, PhaseSpace::new(&[("x", "X"), ("y", "Y")])?);
    let cubic = "(p^2 + q^2)/2 - q^3/3";
    let exact = normalize(&one.parse::<BigRational>(cubic)?, 8, &one)?;
    let float = normalize(&one.parse::<f64>(cubic)?, 8, &one)?;
    let heiles = two.parse::<BigRational>("(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3")?;
    let resonant = normalize_with(&heiles, 6, &two, &Resonances::new(&[&[1, -1]])?, &mut quiet)?;
    let saddle = two.parse::<f64>("x*X/500 + (y^2 + Y^2)/2 + x*y^2/4 + X^2*y/2 - y^3/3")?;
    let kept = normalize_with(&saddle, 6, &two, &Resonances::default().with_centre(), &mut quiet)?;
    let plane = vec![0.8, 0.6];
    let all = vec![0.5, 0.4, 0.6, 0.5];
    Ok(vec![
        ("exact", BirkhoffMap::new(&exact, &[])?, plane.clone()),
        ("float", BirkhoffMap::new(&float, &[])?, plane),
        ("resonant", BirkhoffMap::new(&resonant, &[])?, all.clone()),
        ("saddle", BirkhoffMap::new(&normalize(&saddle, 6, &two)?, &[])?, all.clone()),
        ("centre manifold", BirkhoffMap::new(&kept, &[])?, all),
    ])
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    largest(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

#[test]
fn states_return_to_one_percent_or_are_refused() -> Result<(), Error> {
    for (name, map, direction) in forms()? {
        let mut refused = Vec::new();
        for step in 0..60 {
            let state: Vec<f64> = direction.iter().map(|x| x * 1e-3 * 1.2_f64.powi(step)).collect();
            match map.to_normal(&state) {
                Err(Error::BeyondSeries { miss, distance }) => {
                    assert!(miss > 0.01 * distance, "{name}: {miss} {distance}");
                    refused.push(step);
                }
                Err(other) => return Err(other),
                Ok(normal) => {
                    if let Ok(back) = map.from_normal(&normal) {
                        assert!(difference(&back, &state) <= 0.01 * largest(&state), "{name}: {state:?} {back:?}");
                    }
                }
            }
        }
        // From 1e-3 to 50: small states are allowed, large ones are refused.
        assert!(refused.first().is_some_and(|&first| first > 3), "{name}: {refused:?}");
        assert!((50..60).all(|step| refused.contains(&step)), "{name}: {refused:?}");
    }
    Ok(())
}

#[test]
fn every_method_refuses_what_is_far_outside() -> Result<(), Error> {
    for (name, map, direction) in forms()? {
        let far: Vec<f64> = direction.iter().map(|x| 5.0 * x).collect();
        let mut answers = vec![
            ("to_normal", map.to_normal(&far).map(drop)),
            ("from_normal", map.from_normal(&far).map(drop)),
            ("actions", map.actions(&far).map(drop)),
            (
                "from_centre",
                map.from_centre(&far[far.len() - if name.starts_with(['s', 'c']) { 2 } else { far.len() }..]).map(drop),
            ),
        ];
        if map.is_integrable() {
            let actions: Vec<f64> = direction.chunks(2).map(|pair| 10.0 * pair[0]).collect();
            answers.push(("frequencies", map.frequencies(&actions).map(drop)));
            answers.push(("trajectory", map.trajectory(&far, &[0.0, 1.0]).map(drop)));
        }
        for (method, answer) in answers {
            assert!(matches!(answer, Err(Error::BeyondSeries { .. })), "{name}, {method}: {answer:?}");
        }
    }
    Ok(())
}

/// A saddle leaves the range with time, though its first state is within it.
#[test]
fn a_trajectory_ends_where_it_leaves_the_range() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "X")])?;
    let map = BirkhoffMap::new(&normalize(&space.parse::<f64>("x*X + x^3/3 + x*X^2/2")?, 6, &space)?, &[])?;
    assert!(map.trajectory(&[0.01, 0.01], &[0.0, 1.0]).is_ok());
    let late = map.trajectory(&[0.01, 0.01], &[0.0, 1.0, 8.0]);
    assert!(matches!(late, Err(Error::BeyondSeries { .. })), "{late:?}");
    Ok(())
}

/// A pendulum that swings by a has the frequency agm(1, cos(a/2)).
#[test]
fn amplitudes_with_a_small_defect_stay_allowed() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("q", "p")])?;
    let pendulum = space.parse::<f64>("p^2/2 + q^2/2 - q^4/24 + q^6/720 - q^8/40320 + q^10/3628800")?;
    let map = BirkhoffMap::new(&normalize(&pendulum, 8, &space)?, &[])?;
    for amplitude in [0.2, 0.5, 0.9, 1.2] {
        let (mut a, mut b) = (1.0_f64, (amplitude / 2.0_f64).cos());
        for _ in 0..6 {
            (a, b) = ((a + b) / 2.0, (a * b).sqrt());
        }
        let found = map.frequencies(&map.actions(&[amplitude, 0.0])?)?[0];
        assert!((found - a).abs() < 2e-3 * amplitude, "{amplitude}: {found} {a}");
    }
    Ok(())
}
