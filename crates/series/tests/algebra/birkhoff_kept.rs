//! Normal forms with a detuning, and forms that are written, read and printed.

use andoyer_series::birkhoff::Resonances;
use andoyer_series::num_rational::BigRational;
use andoyer_series::print::{Language, Part};
use andoyer_series::progress::quiet;
use andoyer_series::{BirkhoffMap, BirkhoffNormalForm, Error, PhaseSpace, Polynomial, normalize, normalize_with};

use crate::hamiltonians::{collinear, space, triangular};

fn plane() -> Result<PhaseSpace, Error> {
    PhaseSpace::new(&[("x", "X"), ("y", "Y")])
}

/// The elastic pendulum near its 2:1 resonance: frequencies 1 and 2 + d.
fn elastic(order: usize) -> Result<BirkhoffNormalForm<BigRational>, Error> {
    let space = plane()?.with_parameters(&["d"])?;
    let h = space.parse("(x^2 + X^2)/2 + (2 + d)*(y^2 + Y^2)/2 + x^2*y + x^4/8")?;
    normalize_with(&h, order, &space, &Resonances::new(&[&[2, -1]])?, &mut quiet)
}

#[test]
fn a_detuned_resonance_at_a_number_is_the_resonance_with_another_frequency_to_its_order() -> Result<(), Error> {
    // K(d) at d = 0 is K of the exact resonance, and K commutes with the quadratic part of it.
    let detuned = elastic(4)?;
    assert_eq!(detuned.space().parameter_degrees(), [Some(2)]);
    let exact = plane()?.parse::<BigRational>("(x^2 + X^2)/2 + (y^2 + Y^2) + x^2*y + x^4/8")?;
    let exact = normalize_with(&exact, 4, &plane()?, &Resonances::new(&[&[2, -1]])?, &mut quiet)?.in_real()?;
    let k = detuned.in_real()?;
    assert_eq!(k.evaluate_partial(4, &BigRational::from_integer(0.into()))?, exact);
    let poisson = detuned.space().poisson()?;
    let quadratic = detuned.space().parse("(x^2 + X^2)/2 + y^2 + Y^2")?;
    assert!(poisson.bracket(&quadratic, &k)?.is_zero());
    assert!(k.terms().any(|(m, _)| m.exponent(4) == 1 && m.total_degree() > 3), "the detuning is in higher terms");
    // The transformed Hamiltonian is K.
    let h = detuned.space().parse("(x^2 + X^2)/2 + (2 + d)*(y^2 + Y^2)/2 + x^2*y + x^4/8")?;
    assert_eq!(detuned.direct(&h)?, k);
    Ok(())
}

#[test]
fn a_detuned_form_at_a_number_agrees_with_the_form_of_that_frequency() -> Result<(), Error> {
    // One mode: frequency 1 + d as a detuning of degree 1 against a number, K of both to d⁶ I and d⁴ I².
    let space = PhaseSpace::new(&[("q", "p")])?.with_parameters(&["d"])?.with_degree("d", 1)?;
    let h = space.parse::<f64>("p^2/2 + q^2/2 + d*q^2 + q^4/4")?;
    let detuned = normalize(&h, 12, &space)?.in_actions()?.evaluate_partial(1, &0.01)?;
    let plain = PhaseSpace::new(&[("q", "p")])?;
    let exact = normalize(&plain.parse::<f64>("p^2/2 + 0.51*q^2 + q^4/4")?, 12, &plain)?.in_actions()?;
    let value = |k: &Polynomial<f64>, action: f64| k.evaluate(&[action, 0.0]);
    // Left out: d¹³ and I²d¹¹ …, 1e-22.
    assert!((value(&detuned, 1e-3)? - value(&exact, 1e-3)?).abs() < 1e-17);
    assert!((value(&detuned, 1e-3)? - 1e-3).abs() > 1e-6);
    Ok(())
}

#[test]
fn a_linear_term_with_a_parameter_of_degree_two_moves_the_equilibrium() -> Result<(), Error> {
    // (q² + p²)/2 + c q = ((q + c)² + p²)/2 − c²/2.
    let space = PhaseSpace::new(&[("q", "p")])?.with_parameters(&["c"])?.with_degree("c", 2)?;
    let form = normalize(&space.parse::<BigRational>("(q^2 + p^2)/2 + c*q")?, 4, &space)?;
    assert_eq!(form.in_actions()?, Polynomial::parse("I - c^2/2", &["I", "c"])?);
    assert_eq!(form.inverse(&space.parse("q")?)?, space.parse("q + c")?);
    let refused = space.clone().with_degree("c", 1)?;
    let refused = normalize(&refused.parse::<BigRational>("(q^2 + p^2)/2 + c*q")?, 4, &refused);
    assert!(matches!(refused, Err(Error::ParameterDegree { bound: 2, .. })));
    assert!(matches!(space.with_degree("e", 1), Err(Error::ParameterUnknown { .. })));
    Ok(())
}

#[test]
fn a_letter_that_all_frequencies_are_proportional_to_gives_the_form_at_every_number() -> Result<(), Error> {
    // Coupled by a gyroscopic term: frequencies (5/2 ± 1) w; at w = 4, s = 1/2.
    let letters = plane()?.with_parameters(&["w"])?;
    let text = |w: &str| {
        format!("(X^2 + Y^2)/2 + 25/8*{w}^2*(x^2 + y^2) + {w}*(y*X - x*Y) + {w}*x^3 - x*y^2/3 + {w}*x*X*y + y^4")
    };
    let (scaled, space) = letters.scaled(&letters.parse::<BigRational>(&text("w"))?, "w", "s")?;
    let of_letter = normalize(&scaled, 2, &space)?.in_actions()?;
    let plain = plane()?;
    let of_number = normalize(&plain.parse::<BigRational>(&text("4"))?, 2, &plain)?.in_actions()?;
    let half = BigRational::new(1.into(), 2.into());
    let at_number = of_letter.evaluate_partial(2, &half)?.scale(&BigRational::from_integer(4.into()));
    assert_eq!(at_number, of_number);
    assert!(of_letter.terms().any(|(monomial, _)| monomial.exponent(2) > 0));
    let refused = |text: &str| letters.scaled(&letters.parse::<BigRational>(text)?, "w", "s").map(|_| ());
    let bad = [("(x^2 + X^2)/2 + Y^2/2 + w^2*y^2/2", 4), ("X^2/2 + w^2*x^2/2 + w*X^4", -4)];
    for (text, power) in bad {
        let problem = refused(text);
        assert!(matches!(problem, Err(Error::FrequencyLetter { power: found, .. }) if found == power), "{problem:?}");
    }
    assert!(matches!(letters.scaled(&scaled, "d", "s"), Err(Error::ParameterUnknown { .. })));
    assert!(matches!(letters.scaled(&scaled, "w", "x"), Err(Error::Parse { .. })));
    Ok(())
}

/// Forms of every kind: resonant with a parameter, a quartet, a centre manifold.
fn floats() -> Result<Vec<BirkhoffNormalForm<f64>>, Error> {
    let h = triangular(0.1, 5)?;
    let quartet = normalize(&h, 3, &space()?)?;
    let centre = Resonances::default().with_centre();
    let manifold = normalize_with(&collinear(0.01, false, 5)?, 3, &space()?, &centre, &mut quiet)?;
    Ok(vec![quartet, manifold])
}

#[test]
fn a_form_written_and_read_is_the_same_to_the_bit() -> Result<(), Error> {
    let exact = elastic(3)?;
    assert_eq!(BirkhoffNormalForm::<BigRational>::from_json(&exact.to_json()?)?, exact);
    for form in floats()? {
        assert_eq!(BirkhoffNormalForm::<f64>::from_json(&form.to_json()?)?, form);
    }
    Ok(())
}

#[test]
fn json_that_is_no_normal_form_is_refused() -> Result<(), Error> {
    let text = elastic(2)?.to_json()?;
    let read = |text: &str| BirkhoffNormalForm::<BigRational>::from_json(text).err();
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in {text}");
        read(&text.replacen(from, to, 1))
    };
    assert!(matches!(read("[]"), Some(Error::Json { .. })));
    assert!(matches!(changed("exact", "float"), Some(Error::FormatUnknown { .. })));
    assert!(matches!(changed("\"version\":1", "\"version\":2"), Some(Error::FormatUnknown { version: 2, .. })));
    assert!(matches!(changed("\"order\":2", "\"order\":3"), Some(Error::CountMismatch { .. })));
    assert!(matches!(changed("\"order\":2", "\"order\":99999"), Some(Error::OrderTooLarge { .. })));
    assert!(matches!(changed("[[\"1\",\"0\"", "[[\"2\",\"0\""), Some(Error::NotSymplectic { .. })));
    assert!(matches!(changed("[[\"1\",\"0\"", "[[\"2/2\",\"0\""), Some(Error::RationalMalformed { .. })));
    assert!(matches!(changed("[[2,-1]]", "[[1,-1]]"), Some(Error::NotResonant { .. })));
    assert!(matches!(changed("[[2,-1]]", "[]"), Some(Error::TermInconsistent { what: "hamiltonian", .. })));
    assert!(matches!(
        changed("\"elliptic\",\"1\",\"1\"", "\"elliptic\",\"1\",\"-1\""),
        Some(Error::NameUnknown { .. })
    ));
    assert!(matches!(BirkhoffNormalForm::<f64>::from_json(&text), Err(Error::FormatUnknown { .. })));
    Ok(())
}

#[test]
fn a_coefficient_that_was_changed_by_hand_is_refused_with_what_it_must_be() -> Result<(), Error> {
    // A body in x⁴/8: K_2 has 3/64 of I_x², whose terms are kept, so that only a new computation tells.
    let exact = elastic(2)?;
    let text = exact.to_json()?;
    let document: serde_json::Value = serde_json::from_str(&text).map_err(|_| Error::DivisionByZero)?;
    for part in ["hamiltonian", "generators", "original"] {
        let mut changed = document.clone();
        let order = changed[part].as_array_mut().and_then(|orders| orders.last_mut()).ok_or(Error::DivisionByZero)?;
        let last = if part == "original" { order } else { &mut order[0] };
        let place = if last[1] == "0" { 2 } else { 1 };
        last[place] = "17/3".into();
        let refused = BirkhoffNormalForm::<BigRational>::from_json(&changed.to_string());
        assert!(matches!(refused, Err(Error::CoefficientWrong { .. })), "{part}: {refused:?}");
        // Without the computation it is taken for what it says.
        assert_ne!(BirkhoffNormalForm::<BigRational>::from_json_unverified(&changed.to_string())?, exact);
    }
    for form in floats()? {
        let text = form.to_json()?;
        let mut changed: serde_json::Value = serde_json::from_str(&text).map_err(|_| Error::DivisionByZero)?;
        let c = &mut changed["generators"][1][0][1];
        let value = c.as_f64().filter(|value| *value != 0.0);
        let place = if value.is_some() { 1 } else { 2 };
        let c = &mut changed["generators"][1][0][place];
        *c = (c.as_f64().unwrap_or(0.0) + 1.0).into();
        let refused = BirkhoffNormalForm::<f64>::from_json(&changed.to_string());
        let expected = matches!(&refused, Err(Error::CoefficientWrong { what: "generating function", order: 2, .. }));
        assert!(expected, "{refused:?}");
    }
    Ok(())
}

#[test]
fn maps_about_quartets_and_saddles_come_back_and_move_as_their_equations() -> Result<(), Error> {
    for form in floats()? {
        let map = BirkhoffMap::new(&form, &[])?;
        let normal = [0.01, -0.004, 0.006, 0.01, 0.003, -0.008];
        let back = map.to_normal(&map.from_normal(&normal)?)?;
        // Order 3: left out are terms of degree 5, 1e-10 times coefficients of some 10².
        assert!(back.iter().zip(&normal).all(|(a, b)| (a - b).abs() < 1e-7), "{back:?}");
        // Along the trajectory K is constant, and its slope at the start is that of Hamilton's equations.
        let rates = map.rates(&normal)?;
        let Ok(frequencies) = map.frequencies(&map.actions(&map.from_normal(&normal)?)?) else { continue };
        assert_eq!(frequencies.len(), 3);
        let start = map.from_normal(&normal)?;
        let step = 1e-4;
        let states = map.trajectory(&start, &[-step, step])?;
        let moved: Vec<Vec<f64>> = states.iter().map(|state| map.to_normal(state)).collect::<Result<_, _>>()?;
        for (slot, rate) in rates.iter().enumerate() {
            let slope = (moved[1][slot] - moved[0][slot]) / (2.0 * step);
            assert!((slope - rate).abs() < 1e-6, "{slot}: {slope} {rate}");
        }
        assert!((map.energy(&moved[1])? - map.energy(&normal)?).abs() < 1e-8);
    }
    Ok(())
}

#[test]
fn floats_print_what_is_significant() -> Result<(), Error> {
    let space = plane()?;
    let third = normalize(&space.parse::<f64>("(x^2 + X^2)/2 + (y^2 + Y^2)/6 + 0.1*x^4")?, 2, &space)?;
    assert_eq!(third.to_string(), "I_x + 0.33333333333*I_y + 0.15*I_x^2");
    let coupled = normalize(&space.parse::<f64>("(X^2 + Y^2)/2 + x^2 - x*y + y^2 + x^4/4")?, 2, &space)?;
    assert!(coupled.to_string().starts_with("1.73205080757*I_x + I_y + "), "{coupled}");
    assert!(!coupled.to_string().contains('e'), "{coupled}");
    assert!(third.to_latex(Part::Hamiltonian)?.contains("K &= I_{x} + 0.33333333333I_{y} + 0.15I_{x}^{2}"));
    let text = elastic(2)?.to_latex(Part::Direct)?;
    assert!(text.contains("x &= x'") && text.contains("{x'}^{2}") && text.contains("\\frac{"), "{text}");
    assert!(elastic(2)?.to_latex(Part::Generator)?.contains("S_{2} &="));
    assert!(elastic(2)?.to_latex(Part::Inverse)?.contains("x' &= x"));
    Ok(())
}

// Drivers behind the emitted text: the state, the normal variables again, actions and frequencies, as numbers with all their digits.
const C_DRIVER: &str = r#"
#include <stdio.h>

static void print(const double *numbers, int count)
{
    int i;
    for (i = 0; i < count; i++)
        printf("%.17g ", numbers[i]);
}

int main(void)
{
    const double normal[SIZE] = {NUMBERS};
    double state[SIZE], back[SIZE], action[HALF], rate[HALF];
    from_normal(normal, state);
    to_normal(state, back);
    actions(normal, action);
    frequencies(action, rate);
    print(state, SIZE);
    print(back, SIZE);
    print(action, HALF);
    print(rate, HALF);
    return 0;
}
"#;
const RUST_DRIVER: &str = r#"
fn main() {
    let normal: [f64; SIZE] = [NUMBERS];
    let state = from_normal(&normal);
    let action = actions(&normal);
    for number in state.iter().chain(&to_normal(&state)).chain(&action).chain(&frequencies(&action)) {
        print!("{number:?} ");
    }
}
"#;
const PYTHON_DRIVER: &str = r#"
normal = [NUMBERS]
state = from_normal(normal)
print(*state, *to_normal(state), *actions(normal), *frequencies(actions(normal)))
"#;

/// The emitted text with a driver that prints, of one state of normal variables, what all functions give.
fn run(language: Language, form: &BirkhoffNormalForm<f64>, normal: &[f64]) -> Vec<f64> {
    let n = normal.len();
    let directory = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("birkhoff-{language:?}-{n}"));
    std::fs::create_dir_all(&directory).expect("a directory to build in");
    let text = form.to_code(language).expect("code");
    let numbers = normal.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
    let (source, driver) = match language {
        Language::C => ("main.c", C_DRIVER),
        Language::Rust => ("main.rs", RUST_DRIVER),
        _ => ("main.py", PYTHON_DRIVER),
    };
    let driver =
        driver.replace("SIZE", &n.to_string()).replace("HALF", &(n / 2).to_string()).replace("NUMBERS", &numbers);
    let (driver, program) = (text + &driver, directory.join("main"));
    std::fs::write(directory.join(source), driver).expect("a file in the directory of the tests");
    let mut command = match language {
        Language::C => std::process::Command::new("cc"),
        Language::Rust => std::process::Command::new("rustc"),
        _ => std::process::Command::new(std::env::var("PYTHON").unwrap_or("python3".to_owned())),
    };
    command.current_dir(&directory);
    match language {
        Language::C => command.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o", "main", source, "-lm"]),
        Language::Rust => command.args(["--edition", "2024", "-D", "warnings", "-o", "main", source]),
        _ => command.args(["-B", "-W", "error", source]),
    };
    let mut output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    if !matches!(language, Language::Python) {
        output = std::process::Command::new(program).output().expect("it runs");
    }
    let text = String::from_utf8(output.stdout).expect("text");
    text.split_whitespace().map(|number| number.parse().expect("a number")).collect()
}

#[test]
fn emitted_code_runs_and_is_the_map_in_each_language() -> Result<(), Error> {
    let plane = plane()?;
    let oscillators = normalize(&plane.parse::<f64>("(x^2 + X^2)/2 + (Y^2 + 2*y^2)/2 + x^2*y + y^4/3")?, 4, &plane)?;
    let quartet = normalize(&triangular(0.1, 5)?, 3, &space()?)?;
    for form in [oscillators, quartet] {
        let normal = &[0.01, -0.004, 0.006, 0.01, 0.003, -0.008][..2 * form.modes().len()];
        let map = BirkhoffMap::new(&form, &[])?;
        let state = map.from_normal(normal)?;
        let actions = map.actions(&state)?;
        // What the functions give: the actions there are those of the normal variables themselves.
        for language in [Language::C, Language::Rust, Language::Python] {
            let found = run(language, &form, normal);
            let n = normal.len();
            assert_eq!(found.len(), 3 * n);
            let expected = [&state[..], &map.to_normal(&state)?].concat();
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-15, "{language:?}: {found} for {expected}");
            }
            for (found, expected) in found[2 * n..].iter().zip(&actions) {
                assert!((found - expected).abs() < 1e-8, "{language:?}: {found} for {expected}");
            }
            for (found, expected) in found[2 * n + n / 2..].iter().zip(map.frequencies(&found[2 * n..2 * n + n / 2])?) {
                assert!((found - expected).abs() < 1e-14, "{language:?}: {found} for {expected}");
            }
        }
    }
    Ok(())
}

#[test]
fn code_has_a_function_for_each_task_in_each_language() -> Result<(), Error> {
    for (language, signature) in [
        (Language::C, "void to_normal(const double state[4], const double parameters[1], double normal[4])"),
        (Language::Rust, "pub fn to_normal(state: &[f64; 4], parameters: &[f64; 1]) -> [f64; 4] {"),
        (Language::Python, "def to_normal(state, parameters):"),
    ] {
        let text = elastic(2)?.to_code(language)?;
        assert!(text.contains(signature), "{text}");
        assert!(text.contains("K has resonant terms") && text.is_ascii());
    }
    assert!(floats()?[0].to_code(Language::C)?.contains("void frequencies(const double actions[3], double rates[3])"));
    Ok(())
}

#[test]
fn the_head_of_the_code_counts_its_assignments() -> Result<(), Error> {
    let text = elastic(2)?.to_code(Language::Python)?;
    let assignments = text.lines().filter(|line| line.starts_with("    ") && line.contains(" = ")).count();
    assert!(text.contains(&format!("\n{assignments} assignments.")), "{assignments}: {text}");
    Ok(())
}
