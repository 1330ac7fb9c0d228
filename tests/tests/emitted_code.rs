//! What `to_code` writes is compiled and run, in C, Rust and Python, against the exact polynomials.

use andoyer_series::print::Language;
use andoyer_series::rigid_body::{PublicForm, Variable, separatrix_action};
use andoyer_series::{Error, NormalForm};
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::{FromPrimitive, Signed, ToPrimitive, Zero};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// β as it is in the file, or `None`, and the order.
const CASES: [(Option<f64>, usize); 10] = [
    (Some(0.3), 0),
    (None, 1),
    (Some(0.0), 3),
    (Some(0.0), 10),
    (Some(0.3), 3),
    (Some(0.3), 10),
    (Some(0.9), 3),
    (Some(0.9), 10),
    (None, 3),
    (None, 10),
];

/// Budget of roundings, in units of ε/2 times the magnitudes of the terms: for each power of s two in Horner's rule and one of s itself.
const ROUNDINGS_PER_ORDER: f64 = 3.0;
/// And for each term: one in Clenshaw's rule and the coefficient, two in sine and cosine, four in κ and σ, three in the factors, two in the reference.
const ROUNDINGS: f64 = 12.0;

// Drivers: lines of arguments in, lines of results out, all numbers as their bits in hexadecimal.
const C_DRIVER: &str = r#"
#include "rotation.c"
#include <stdio.h>
#include <string.h>

static void print(double value, char end)
{
    unsigned long long bits;
    memcpy(&bits, &value, sizeof bits);
    printf("%016llx%c", bits, end);
}

int main(void)
{
    unsigned long long bits[3];
    while (scanf("%llx %llx %llx", &bits[0], &bits[1], &bits[2]) == 3) {
        double beta, sigma, anomaly;
        memcpy(&beta, &bits[0], sizeof beta);
        memcpy(&sigma, &bits[1], sizeof sigma);
        memcpy(&anomaly, &bits[2], sizeof anomaly);
        (void)beta;
        struct short_axis_rotation result = short_axis_rotation(ARGUMENTS);
        print(result.zeta_real, ' ');
        print(result.zeta_imaginary, ' ');
        print(result.longitude_shift, ' ');
        print(result.anomaly_rate, ' ');
        print(result.longitude_rate, '\n');
    }
    return 0;
}
"#;
const RUST_DRIVER: &str = r#"
mod rotation;

fn main() {
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let mut arguments = line.split(' ').map(|bits| f64::from_bits(u64::from_str_radix(bits, 16).unwrap()));
        let [_beta, sigma, anomaly] = std::array::from_fn(|_| arguments.next().unwrap());
        let result = rotation::short_axis_rotation(ARGUMENTS);
        let rates = [result.anomaly_rate, result.longitude_rate];
        let results = [result.zeta_real, result.zeta_imaginary, result.longitude_shift, rates[0], rates[1]];
        println!("{}", results.map(|value| format!("{:016x}", value.to_bits())).join(" "));
    }
}
"#;
const PYTHON_DRIVER: &str = r#"
import struct
import sys

from rotation import short_axis_rotation

for line in sys.stdin:
    beta, sigma, anomaly = (struct.unpack(">d", bytes.fromhex(bits))[0] for bits in line.split())
    print(*(struct.pack(">d", value).hex() for value in short_axis_rotation(ARGUMENTS)))
"#;

/// One term of one result: c s^n times cos hℓ′ or sin hℓ′, with Σ |parts of c|.
struct Term {
    result: usize,
    order: usize,
    harmonic: f64,
    coefficient: f64,
    magnitude: f64,
}

/// The exact series at one β: X, x, y − y′ and the two rates of theory §6, §7, without the factors in front.
struct Reference {
    beta: f64,
    terms: Vec<Term>,
}

/// A point and what the exact series give there: results and their budgets.
struct Point {
    arguments: [f64; 3],
    results: [f64; 5],
    budgets: [f64; 5],
}

/// i^j c, for a coefficient of u^j = (i w̄)^j.
fn turned(c: &Complex<BigRational>, j: u32) -> Complex<BigRational> {
    (0..j).fold(c.clone(), |c, _| Complex::new(-c.im, c.re))
}

impl Reference {
    fn new(normal_form: &NormalForm, beta: f64) -> Self {
        let mut reference = Reference { beta, terms: Vec::new() };
        let one = || [(0, BigRational::from_integer(1.into()))];
        reference.add(0, 0, 1, one());
        reference.add(1, 0, 1, one());
        for n in 0..=normal_form.order() {
            let polynomial = normal_form.triaxiality_polynomial(n).expect("n ≤ order");
            for (result, weight) in [(3, n as i64 + 1), (4, 1 - n as i64)] {
                let half = BigRational::new(weight.into(), 2.into());
                reference.add(result, n, 0, polynomial.iter().map(|(&l, c)| (l, c * &half)));
            }
        }
        for n in 1..=normal_form.order() {
            let forms = [Variable::Momentum, Variable::Angle].map(|v| normal_form.direct(v, n).expect("n ≤ order"));
            for (result, form) in [(0, &forms[0]), (1, &forms[0]), (2, &forms[1])] {
                reference.add_form(result, n, form);
            }
        }
        reference
    }

    /// U = w is real in w̄, w: Re and Im are its cosines and sines. y is i times real: the real part is minus the sines.
    fn add_form(&mut self, result: usize, n: usize, form: &PublicForm) {
        let mut harmonics = BTreeMap::<i64, Vec<_>>::new();
        for (&(j, k, l), c) in form {
            let c = turned(c, j);
            let (part, none) = if result == 2 { (-c.im, c.re) } else { (c.re, c.im) };
            assert!(none.is_zero());
            harmonics.entry(i64::from(k) - i64::from(j)).or_default().push((l, part));
        }
        for (harmonic, parts) in harmonics {
            self.add(result, n, harmonic, parts);
        }
    }

    fn add(&mut self, result: usize, n: usize, harmonic: i64, parts: impl IntoIterator<Item = (u32, BigRational)>) {
        let beta = BigRational::from_f64(self.beta).expect("finite");
        let (mut sum, mut magnitude) = (BigRational::zero(), BigRational::zero());
        for (l, c) in parts {
            let part = (0..l).fold(c, |product, _| product * &beta);
            magnitude += part.abs();
            sum += part;
        }
        let [coefficient, magnitude] = [sum, magnitude].map(|sum| sum.to_f64().expect("finite"));
        self.terms.push(Term { result, order: n, harmonic: harmonic as f64, coefficient, magnitude });
    }

    fn at(&self, sigma: f64, anomaly: f64) -> Point {
        let kappa = 1.0 / ((1.0 - self.beta) * (1.0 + self.beta)).sqrt();
        let (s, omega) = (kappa * sigma, (1.0 + self.beta) * kappa);
        let factors = [(2.0 * omega * sigma).sqrt(), (2.0 * sigma / omega).sqrt(), sigma, 1.0, sigma];
        let (mut results, mut carried, mut budgets) = ([0.0; 5], [0.0; 5], [0.0; 5]);
        for &Term { result: i, order, harmonic, coefficient, magnitude } in &self.terms {
            let angle = harmonic * anomaly;
            let wave = [angle.cos(), angle.sin(), angle.sin(), 1.0, 1.0][i];
            let power = s.powi(order as i32);
            let term = coefficient * power * wave;
            // Many terms: the sum is compensated.
            let sum: f64 = results[i] + term;
            let larger = if results[i].abs() > term.abs() { (results[i], term) } else { (term, results[i]) };
            carried[i] += (larger.0 - sum) + larger.1;
            results[i] = sum;
            // The angle of a harmonic is rounded too.
            let roundings = ROUNDINGS + ROUNDINGS_PER_ORDER * order as f64 + angle.abs();
            budgets[i] += roundings * 0.5 * f64::EPSILON * magnitude * power;
        }
        let scaled = |values: [f64; 5]| [0, 1, 2, 3, 4].map(|i| values[i] * factors[i]);
        let sums = [0, 1, 2, 3, 4].map(|i| results[i] + carried[i]);
        Point { arguments: [self.beta, sigma, anomaly], results: scaled(sums), budgets: scaled(budgets) }
    }
}

/// Some dozens of points from the axis to half way to the separatrix, multiples of a quarter turn among the angles.
fn points((baked, order): (Option<f64>, usize)) -> Vec<Point> {
    let normal_form = NormalForm::new(order).expect("within the bounds");
    let mut points = Vec::new();
    for beta in baked.map_or(vec![0.0, 0.3, 0.9], |beta| vec![beta]) {
        let reference = Reference::new(&normal_form, beta);
        let separatrix = separatrix_action(beta).expect("0 ≤ β ≤ 1");
        for ratio in [0.0, 1e-9, 0.1, 0.3, 0.5] {
            for anomaly in [0.0, 0.1, 0.7, 0.25 * PI, 1.3, 0.5 * PI, 2.0, 2.9, PI, -1.0, -2.6, 40.0] {
                points.push(reference.at(ratio * separatrix, anomaly));
            }
        }
    }
    points
}

/// Writes the emitted file and its driver, has them compiled, and returns what runs them.
type Build = fn(&Path, emitted: &str, arguments: &str) -> Command;

fn assert_agrees(language: Language, build: Build) {
    for case in CASES {
        let (beta, order) = case;
        let emitted = NormalForm::new(order).and_then(|n| n.to_code(language, beta)).expect("0 ≤ β < 1");
        let name = format!("{language:?}-{order}-{}", beta.map_or("any".to_owned(), |beta| beta.to_string()));
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("emitted").join(name);
        std::fs::create_dir_all(&directory).expect("a directory to build in");
        let arguments = if beta.is_some() { "sigma, anomaly" } else { "beta, sigma, anomaly" };
        let points = points(case);
        let found = run(build(&directory, &emitted, arguments), &points);
        assert_eq!(found.len(), points.len(), "{case:?}");
        for (point, found) in points.iter().zip(found) {
            for i in 0..5 {
                let error = (found[i] - point.results[i]).abs();
                let (at, budget) = (point.arguments, point.budgets[i]);
                assert!(error <= budget, "{case:?} at {at:?}, result {i}: {found:?} for {:?}", point.results);
            }
        }
    }
}

/// Feeds the points as lines of bits, reads the results as lines of bits.
fn run(mut program: Command, points: &[Point]) -> Vec<[f64; 5]> {
    let mut child = program.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it starts");
    let mut input = String::new();
    for point in points {
        input += &point.arguments.map(|argument| format!("{:016x}", argument.to_bits())).join(" ");
        input.push('\n');
    }
    // All points fit the pipe before anything is read back.
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "{program:?}");
    let lines = String::from_utf8(output.stdout).expect("text");
    let number = |text: &str| f64::from_bits(u64::from_str_radix(text, 16).expect("bits"));
    let row = |line: &str| <[f64; 5]>::try_from(line.split(' ').map(number).collect::<Vec<_>>()).expect("five results");
    lines.lines().map(row).collect()
}

fn write(path: PathBuf, text: &str) {
    std::fs::write(path, text).expect("a file in the directory of the tests");
}

fn compile(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn c_gives_what_the_polynomials_give() {
    assert_agrees(Language::C, |directory, emitted, arguments| {
        write(directory.join("rotation.c"), emitted);
        let driver = C_DRIVER.replace("ARGUMENTS", arguments);
        write(directory.join("main.c"), &driver);
        let program = directory.join("main");
        let strict = ["-std=c99", "-Wall", "-Wextra", "-Werror"];
        compile(Command::new("cc").args(strict).arg("-o").args([&program, &directory.join("main.c")]).arg("-lm"));
        Command::new(program)
    });
}

#[test]
fn rust_gives_what_the_polynomials_give() {
    assert_agrees(Language::Rust, |directory, emitted, arguments| {
        write(directory.join("rotation.rs"), emitted);
        let driver = RUST_DRIVER.replace("ARGUMENTS", &arguments.replace("beta", "_beta"));
        write(directory.join("main.rs"), &driver);
        let program = directory.join("main");
        let strict = ["--edition", "2024", "-D", "warnings"];
        compile(Command::new("rustc").args(strict).arg("-o").args([&program, &directory.join("main.rs")]));
        Command::new(program)
    });
}

#[test]
fn python_gives_what_the_polynomials_give() {
    assert_agrees(Language::Python, |directory, emitted, arguments| {
        write(directory.join("rotation.py"), emitted);
        let driver = PYTHON_DRIVER.replace("ARGUMENTS", arguments);
        write(directory.join("main.py"), &driver);
        let mut python = Command::new(std::env::var("PYTHON").unwrap_or("python3".to_owned()));
        python.arg("-B").args(["-W", "error"]).arg(directory.join("main.py"));
        python
    });
}

/// Operators and calls in the lines of the C function that are no comment.
fn counted(text: &str) -> [usize; 5] {
    let lines = text.lines().skip_while(|line| *line != "{").filter(|line| !line.trim().starts_with("/*"));
    let body: String = lines.collect();
    let count = |tokens: &[&str]| tokens.iter().map(|token| body.matches(token).count()).sum();
    [count(&[" + ", " - "]), count(&[" * "]), count(&[" / "]), count(&["sqrt("]), count(&["sin(", "cos("])]
}

#[test]
fn the_head_states_order_truncation_and_the_cost_that_is_counted_in_the_text() -> Result<(), Error> {
    for (beta, order) in CASES {
        let text = NormalForm::new(order)?.to_code(Language::C, beta)?;
        let [additions, multiplications, divisions, roots, trigonometric] = counted(&text);
        assert!(multiplications > 0 && trigonometric == 2);
        for line in [
            format!(
                "Cost: {additions} additions, {multiplications} multiplications, {divisions} divisions, {roots} square roots, {trigonometric} sine and cosine."
            ),
            format!("order {order}, "),
            format!("about (sigma/sigma_sep)^{} of each result", order + 1),
            beta.map_or("sigma_sep = (2/pi) atan(".to_owned(), |beta| {
                format!("sigma_sep = {:?}\n", separatrix_action(beta).unwrap_or(f64::NAN))
            }),
        ] {
            assert!(text.contains(&line), "{line} is not in\n{text}");
        }
    }
    Ok(())
}

#[test]
fn the_text_is_the_same_each_time_plain_ascii_and_narrow() -> Result<(), Error> {
    for language in [Language::C, Language::Rust, Language::Python] {
        for (beta, order) in CASES {
            let text = NormalForm::new(order)?.to_code(language, beta)?;
            assert_eq!(text, NormalForm::new(order)?.to_code(language, beta)?);
            assert!(text.is_ascii() && text.ends_with('\n'));
            for line in text.lines() {
                assert!(line.len() <= 120 && line == line.trim_end(), "{line}");
            }
        }
    }
    Ok(())
}

#[test]
fn a_body_with_two_equal_moments_takes_no_harmonics_at_any_order() -> Result<(), Error> {
    // β = 0: P_0 and P_1 are all there is, and w is its own transform (theory §4).
    let texts = [2, 10].map(|order| NormalForm::new(order).and_then(|n| n.to_code(Language::Python, Some(0.0))));
    let [low, high] = texts.map(|text| text.map(|text| text.split_once("import").map(|(_, body)| body.to_owned())));
    assert_eq!(low?, high?);
    Ok(())
}

#[test]
fn betas_outside_the_interval_unknown_languages_and_huge_orders_are_refused() -> Result<(), Error> {
    let normal_form = NormalForm::new(2)?;
    for bad in [-0.1, -f64::MIN_POSITIVE, 1.0, 1.1, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for language in [Language::C, Language::Rust, Language::Python] {
            let refused = normal_form.to_code(language, Some(bad));
            assert!(matches!(refused, Err(Error::OutsideInterval { argument: "beta", .. })), "{bad}");
        }
    }
    for beta in [-0.0, 5e-324, 1.0_f64.next_down()] {
        let text = normal_form.to_code(Language::C, Some(beta))?;
        assert!(!text.contains("inf") && !text.contains("NaN"), "{text}");
    }
    for name in ["", "C", "fortran"] {
        let refused = name.parse::<Language>();
        assert!(matches!(refused, Err(Error::NameUnknown { what: "language", .. })), "{name}");
    }
    let refused = NormalForm::new(101)?.to_code(Language::C, Some(0.5));
    assert!(matches!(refused, Err(Error::OrderTooLarge { order: 101, bound: 100 })));
    Ok(())
}
