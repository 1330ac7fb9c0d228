//! Driven phases: normal forms against integrations, Mathieu's equation, resonances with a phase, JSON and refusals.

use andoyer_series::birkhoff::Resonances;
use andoyer_series::error::ParseProblem;
use andoyer_series::print::Language;
use andoyer_series::progress::quiet;
use andoyer_series::{BirkhoffMap, BirkhoffNormalForm, Error, PhaseSpace, normalize_driven, normalize_with};
use num_rational::BigRational;

fn form(h: &str, order: usize, space: &PhaseSpace, driven: &[(f64, f64)]) -> Result<BirkhoffNormalForm<f64>, Error> {
    normalize_driven(&space.parse(h)?, order, space, driven, &Resonances::default(), &mut quiet)
}

/// Hamilton's equations, integrated by the rule of Runge and Kutta with 200 steps a unit of time.
fn integrated(rates: impl Fn(f64, &[f64]) -> Vec<f64>, start: &[f64], from: f64, to: f64) -> Vec<f64> {
    let steps = (200.0 * (to - from)).ceil();
    let h = (to - from) / steps;
    let along =
        |z: &[f64], rate: &[f64], by: f64| -> Vec<f64> { z.iter().zip(rate).map(|(z, r)| z + by * r).collect() };
    let mut z = start.to_vec();
    for step in 0..steps as usize {
        let t = from + h * step as f64;
        let k1 = rates(t, &z);
        let k2 = rates(t + h / 2.0, &along(&z, &k1, h / 2.0));
        let k3 = rates(t + h / 2.0, &along(&z, &k2, h / 2.0));
        let k4 = rates(t + h, &along(&z, &k3, h));
        for i in 0..z.len() {
            z[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    z
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

const DUFFING: &str = "(p^2 + x^2)/2 - x^3/5 + x^4/4 - x*cos(M)/20 - x*sin(-2*M)/50 + x^2*sin(3*M)/100 + p*x*cos(M)/90";

fn duffing(t: f64, z: &[f64]) -> Vec<f64> {
    let (m, x, p) = (0.3 + 0.37 * t, z[0], z[1]);
    let slope = x - 0.6 * x * x + x.powi(3) - m.cos() / 20.0
        + (2.0 * m).sin() / 50.0
        + x * (3.0 * m).sin() / 50.0
        + p * m.cos() / 90.0;
    vec![p + x * m.cos() / 90.0, -slope]
}

#[test]
fn a_driven_duffing_oscillator_moves_as_integrated() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "p")])?.with_driven(&["M"])?;
    let start = [0.05, 0.02];
    let exact = integrated(duffing, &start, 1.0, 21.0);
    let error = |order| {
        let map = BirkhoffMap::new(&form(DUFFING, order, &space, &[(0.37, 0.3)])?, &[])?;
        let there = map.trajectory_from(&start, 1.0, &[20.0])?;
        let actions = [map.actions_at(&start, 1.0)?[0], map.actions_at(&exact, 21.0)?[0]];
        Ok((difference(&there[0], &exact), (actions[0] - actions[1]).abs()))
    };
    let errors = [error(2)?, error(5)?, error(10)?];
    assert!(errors[0].0 > 1e-5 && errors[1].0 < errors[0].0 / 30.0 && errors[2].0 < errors[1].0 / 30.0, "{errors:?}");
    assert!(errors[2].0 < 1e-7 && errors[2].1 < 1e-9, "{errors:?}");
    Ok(())
}

#[test]
fn a_force_on_linear_oscillators_and_a_saddle_is_removed_exactly() -> Result<(), Error> {
    // Gyroscopic coupling, a saddle and two phases: the exact motion is the normal motion plus the forced one.
    let space = PhaseSpace::new(&[("x", "X"), ("y", "Y"), ("z", "Z")])?.with_driven(&["M", "N"])?;
    let h = "(X^2 + Y^2)/2 + 0.9*(y*X - x*Y) + x^2 + 1.3*y^2 + (Z^2 - z^2)/2 + x*z/5
        - x*cos(M)/3 + Y*sin(2*M - N)/4 + z*sin(N)/2 - Z*cos(M)*cos(N)/7";
    let rates = |t: f64, s: &[f64]| {
        let (m, n) = (0.31 * t, 1.0 + 1.7 * t);
        let (x, px, y, py, z, pz) = (s[0], s[1], s[2], s[3], s[4], s[5]);
        vec![
            px + 0.9 * y,
            0.9 * py - 2.0 * x - z / 5.0 + m.cos() / 3.0,
            py - 0.9 * x + (2.0 * m - n).sin() / 4.0,
            -0.9 * px - 2.6 * y,
            pz - m.cos() * n.cos() / 7.0,
            z - x / 5.0 - n.sin() / 2.0,
        ]
    };
    let start = [0.3, -0.1, 0.2, 0.4, -0.01, 0.02];
    let map = BirkhoffMap::new(&form(h, 0, &space, &[(0.31, 0.0), (1.7, 1.0)])?, &[])?;
    let error = difference(&map.trajectory(&start, &[3.0])?[0], &integrated(rates, &start, 0.0, 3.0));
    assert!(error < 1e-9, "{error}");
    Ok(())
}

#[test]
fn the_polynomials_of_the_transformation_are_those_of_the_map() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "p")])?.with_parameters(&["c"])?.with_driven(&["M"])?;
    let form = form(&DUFFING.replace("x^4/4", "c*x^4/4"), 5, &space, &[(0.37, 0.3)])?;
    let map = BirkhoffMap::new(&form, &[0.8])?;
    let (point, time) = ([0.04, -0.03], 2.0);
    let phase: f64 = 0.3 + 0.37 * time;
    let value = |f: &andoyer_series::Polynomial<f64>| {
        f.terms().fold(0.0, |sum, (monomial, c)| {
            let j = space.harmonics(monomial)[0];
            let harmonic = if j < 0 { (-j as f64 * phase).sin() } else { (j as f64 * phase).cos() };
            let powers = [point[0], point[1], 0.8].into_iter().enumerate();
            let powers: f64 = powers.map(|(slot, x): (usize, f64)| x.powi(monomial.exponent(slot) as i32)).product();
            sum + c * powers * harmonic
        })
    };
    for (slot, name) in ["x", "p"].iter().enumerate() {
        let (old, new) = (value(&form.direct(&space.parse(name)?)?), value(&form.inverse(&space.parse(name)?)?));
        assert!((old - map.from_normal_at(&point, time)?[slot]).abs() < 1e-13);
        assert!((new - map.to_normal_at(&point, time)?[slot]).abs() < 1e-13);
    }
    // A function with its own phase is transformed as its factors are.
    let product = value(&form.direct(&space.parse("x*cos(7*M)")?)?);
    assert!((product - map.from_normal_at(&point, time)?[0] * (7.0 * phase).cos()).abs() < 1e-13);
    Ok(())
}

#[test]
fn the_exponent_of_mathieu_is_exact_in_q() -> Result<(), Error> {
    // DLMF 28.15.1, a(ν) = ν² + q²/(2(ν² − 1)) + (5ν² + 7) q⁴/(32 (ν² − 1)³(ν² − 4)), solved for ν at a = 4/9.
    let space = PhaseSpace::new(&[("x", "p")])?.with_parameters(&["q"])?.with_driven(&["M"])?;
    let h = space.parse::<BigRational>("(p^2 + 4/9*x^2)/2 - q*x^2*cos(2*M)")?;
    let exact = |p: i64, q: i64| BigRational::new(p.into(), q.into());
    let form = normalize_driven(&h, 4, &space, &[(exact(1, 1), 0.0)], &Resonances::default(), &mut quiet)?;
    let exponent = |q: f64| {
        let terms = form.in_actions()?;
        let c = |power| {
            terms.coefficient(&andoyer_series::Monomial::new(&[1, power])?).cloned().ok_or(Error::DivisionByZero)
        };
        let float = |c: BigRational| andoyer_series::real_field::RealField::to_float(&c);
        Ok::<f64, Error>(float(c(0)?) + float(c(2)?) * q.powi(2) + float(c(4)?) * q.powi(4))
    };
    let residual = |q: f64| {
        let n = exponent(q)?.powi(2);
        let a = n + q * q / (2.0 * (n - 1.0)) + (5.0 * n + 7.0) * q.powi(4) / (32.0 * (n - 1.0).powi(3) * (n - 4.0));
        Ok::<f64, Error>((a - 4.0 / 9.0).abs())
    };
    assert!(form.to_string().starts_with("2/3*I_x + 27/40*I_x*q^2"), "{form}");
    assert!(residual(0.01)? < 1e-11 && residual(0.02)? < 70.0 * residual(0.01)?);
    Ok(())
}

#[test]
fn half_a_phase_gives_the_same_form_and_the_half_integer_resonance() -> Result<(), Error> {
    let (whole, half) =
        (PhaseSpace::new(&[("x", "p")])?.with_driven(&["M"])?, PhaseSpace::new(&[("x", "p")])?.with_driven(&["N"])?);
    let text = |phase: &str| format!("(p^2 + 0.2*x^2)/2 + x^4/4 - 0.05*x^2*cos({phase}) - x*sin({phase})/30");
    let (a, b) = (form(&text("M"), 6, &whole, &[(2.0, 0.0)])?, form(&text("2*N"), 6, &half, &[(1.0, 0.0)])?);
    for (monomial, c) in a.in_actions()?.terms() {
        let other = b.in_actions()?.coefficient(&monomial).copied().unwrap_or_default();
        assert!((c - other).abs() < 1e-12 * (1.0 + c.abs()), "{a}\n{b}");
    }
    // ω = 1/2: x² cos(M) with M = t is resonant; kept as 2φ − M, or φ − N with N = t/2.
    let text = |phase: &str| format!("(p^2 + x^2/4)/2 - x^2*cos({phase})/40");
    let refused = form(&text("M"), 1, &whole, &[(1.0, 0.0)]);
    assert!(
        matches!(&refused, Err(Error::SmallDivisor { order: 1, term, k, .. }) if term == "U_x^2*exp(-i*M)" && *k == [2, -1]),
        "{refused:?}"
    );
    let kept = |h: &str, space: &PhaseSpace, n, vector: &[i64]| {
        normalize_driven(&space.parse::<f64>(h)?, 2, space, &[(n, 0.0)], &Resonances::new(&[vector])?, &mut quiet)
    };
    let (a, b) = (kept(&text("M"), &whole, 1.0, &[2, -1])?, kept(&text("2*N"), &half, 0.5, &[1, -1])?);
    assert!(a.to_string().ends_with("+ 0.025*I_x*cos(2*phi_x - M)"), "{a}");
    assert!(b.to_string().ends_with("+ 0.025*I_x*cos(2*phi_x - 2*N)"), "{b}");
    assert!(matches!(a.in_actions(), Err(Error::ResonantTerm { .. })));
    assert_eq!(a.angle_terms()?[1].0, [2, -1]);
    // The energy and the rates depend on the time, as K does: dp/dt = −∂K/∂q at φ = 0, I = q²/r … with r = 2.
    let map = BirkhoffMap::new(&a, &[])?;
    let (point, h) = ([0.1, 0.2], 1e-6);
    let slope = (map.energy_at(&[0.1 + h, 0.2], 0.7)? - map.energy_at(&[0.1 - h, 0.2], 0.7)?) / (2.0 * h);
    assert!((map.rates_at(&point, 0.7)?[1] + slope).abs() < 1e-9 && map.rates(&point)? != map.rates_at(&point, 0.7)?);
    Ok(())
}

#[test]
fn a_form_is_read_from_its_json() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "p")])?.with_parameters(&["c"])?.with_driven(&["M", "N"])?;
    let h = "(p^2 + x^2)/2 + c*x^4/4 - x*cos(M)/20 - x^2*sin(-2*M + N)/50 + 1 + cos(M)";
    let exact = |p: i64, q: i64| (BigRational::new(p.into(), q.into()), 0.25);
    let driven = [exact(3, 7), exact(-17, 5)];
    let form = normalize_driven(&space.parse(h)?, 3, &space, &driven, &Resonances::default(), &mut quiet)?;
    assert_eq!(form.offset(), &space.parse("1")?);
    let text = form.to_json()?;
    assert!(
        text.contains("\"driven\":[[\"M\",\"3/7\",0.25],[\"N\",\"-17/5\",0.25]]") && text.contains("-2,1]"),
        "{text}"
    );
    assert_eq!(BirkhoffNormalForm::<BigRational>::from_json(&text)?, form);
    assert_eq!(BirkhoffNormalForm::<BigRational>::from_json_unverified(&text)?, form);
    let changed = text.replacen("\"3/7\"", "\"2/7\"", 1);
    let changed = BirkhoffNormalForm::<BigRational>::from_json(&changed);
    assert!(matches!(changed, Err(Error::CoefficientWrong { .. })), "{changed:?}");
    let shorter = text.replacen(",0.25],[\"N\",\"-17/5\",0.25]]", ",0.25]]", 1);
    assert!(matches!(BirkhoffNormalForm::<BigRational>::from_json(&shorter), Err(Error::TermInconsistent { .. })));
    Ok(())
}

#[test]
fn emitted_code_says_which_argument_nothing_needs() -> Result<(), Error> {
    // K is linear in the action, and the phase does not reach the transformation: its rates need no argument, and no state needs the time.
    let space = PhaseSpace::new(&[("x", "p")])?.with_driven(&["M"])?;
    let form = form("(p^2 + x^2)/2", 2, &space, &[(0.37, 0.0)])?;
    for (language, line, times) in
        [(Language::C, "(void)", 3), (Language::Rust, "let _ = ", 3), (Language::Python, "let _", 0)]
    {
        let code = form.to_code(language)?;
        assert_eq!(code.matches(line).count(), times, "{code}");
        assert_eq!(code.matches(&format!("{line}actions;")).count(), times / 3, "{code}");
        assert_eq!(code.matches(&format!("{line}time;")).count(), times / 3 * 2, "{code}");
    }
    Ok(())
}

#[test]
fn text_that_is_no_driven_hamiltonian_is_refused() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "p")])?.with_driven(&["M"])?;
    for (text, problem) in [
        ("x*M", ParseProblem::PhaseAlone("M".into())),
        ("cos(x)", ParseProblem::Angle),
        ("cos(2)", ParseProblem::Angle),
        ("cos(0.5*M)", ParseProblem::Angle),
        ("cos(M/2)", ParseProblem::Angle),
        ("cos(M*M)", ParseProblem::Angle),
        ("sin(70000*M)", ParseProblem::Angle),
        ("cos(M", ParseProblem::UnexpectedEnd),
        ("tan(M)", ParseProblem::Function("tan".into())),
    ] {
        let found = space.parse::<f64>(text);
        assert!(matches!(&found, Err(Error::Parse { problem: found, .. }) if *found == problem), "{text}: {found:?}");
    }
    assert_eq!(space.parse::<f64>("cos(M)^2 + sin(M)^2")?, space.parse("1")?);
    assert_eq!(space.parse::<f64>("cos(2*M - 3*M)*sin(-M*2)")?, space.parse("-sin(3*M)/2 - sin(M)/2")?);
    for name in ["x", "p", "2M"] {
        assert!(matches!(PhaseSpace::new(&[("x", "p")])?.with_driven(&[name]), Err(Error::Parse { .. })));
    }
    assert!(matches!(space.clone().with_parameters(&["M"]), Err(Error::Parse { .. })));
    let three = PhaseSpace::new(&[("x", "X"), ("y", "Y"), ("z", "Z")])?.with_driven(&["L", "M", "N"]);
    assert!(matches!(three, Err(Error::PhaseSpaceSize { parameters: 3, .. })));
    Ok(())
}

#[test]
fn frequencies_that_give_no_form_are_refused() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "p")])?.with_driven(&["M"])?;
    let h = "(p^2 + x^2)/2 - x*cos(M)";
    let resonant = form(h, 2, &space, &[(1.0, 0.0)]);
    assert!(matches!(&resonant, Err(Error::ResonantForce { term, .. }) if term == "U_x*exp(-i*M)"), "{resonant:?}");
    assert!(matches!(form(h, 2, &space, &[]), Err(Error::CountMismatch { what: "driven", found: 0, expected: 1 })));
    assert!(matches!(form(h, 2, &space, &[(f64::NAN, 0.0)]), Err(Error::NotFinite { what: "driven", .. })));
    assert!(matches!(form(h, 2, &space, &[(2.0, f64::NAN)]), Err(Error::NotFinite { what: "driven", .. })));
    assert!(matches!(form(h, 2, &space, &[(0.0, 0.0)]), Err(Error::DrivenUnsupported { .. })));
    let none = normalize_with(&space.parse::<f64>(h)?, 2, &space, &Resonances::default(), &mut quiet);
    assert!(matches!(none, Err(Error::CountMismatch { .. })));
    let wide = form("(p^2 + x^2)/2 + x^2*cos(9000*M)", 4, &space, &[(0.3, 0.0)]);
    assert!(matches!(wide, Err(Error::ExponentOverflow { slot: 2, .. })), "{wide:?}");
    let short = Resonances::new(&[&[1]])?;
    let short = normalize_driven(&space.parse::<f64>(h)?, 2, &space, &[(0.3, 0.0)], &short, &mut quiet);
    assert!(matches!(short, Err(Error::ResonanceMalformed { .. })));
    let scaled = PhaseSpace::new(&[("x", "p")])?.with_parameters(&["w"])?.with_driven(&["M"])?;
    let scaled = scaled.scaled(&scaled.parse::<f64>("p^2 + w^2*x^2")?, "w", "s");
    assert!(matches!(scaled, Err(Error::DrivenUnsupported { .. })));
    // A force that is a parameter of degree 1 is kept.
    let detuned = space.with_parameters(&["f"])?.with_degree("f", 1)?;
    let h = detuned.parse::<f64>("(p^2 + x^2)/2 + x^4/4 - f*x*cos(M)")?;
    let kept = Resonances::new(&[&[1, -1]])?;
    let kept = normalize_driven(&h, 2, &detuned, &[(1.0, 0.0)], &kept, &mut quiet)?;
    assert!(kept.to_string().contains("I_x^(1/2)*f*sin(phi_x - M)"), "{kept}");
    Ok(())
}

#[test]
fn sizes_of_orders_fall_with_the_amplitude_to_those_of_the_forced_motion() -> Result<(), Error> {
    let space = PhaseSpace::new(&[("x", "p")])?.with_driven(&["M"])?;
    let domain = form(DUFFING, 8, &space, &[(0.37, 0.3)])?.domain(&[])?;
    let (small, large) = (domain.sizes(1e-3)?, domain.sizes(0.5)?);
    assert!(domain.radii().is_empty() && small.iter().zip(&large).all(|(small, large)| 0.0 < *small && small < large));
    assert!(domain.best_order(1e-3)? > domain.best_order(2.0)?, "{domain}");
    Ok(())
}
