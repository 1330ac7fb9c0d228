//! Sparse and dense products, the brackets of a normal form, and normal forms about L1: what `make rivals-products` sets beside other algebras.
//!
//! `products` reads the names of tasks from its standard input, a line each, and answers with processor seconds of the main thread, seconds on the clock, the
//! number of terms, seconds on the clock for the first look at a coefficient, and that coefficient. Factors are made before. The caller checks the answer.

use std::hint::black_box;
use std::io::{BufRead, Write};
use std::process::ExitCode;
use std::time::Instant;

use andoyer_series::birkhoff::Resonances;
use andoyer_series::lie::Poisson;
use andoyer_series::num_complex::Complex;
use andoyer_series::num_rational::BigRational;
use andoyer_series::progress::quiet;
use andoyer_series::{Coefficient, Monomial, Polynomial, Truncation, normalize_with};

#[path = "../../../crates/series/tests/algebra/hamiltonians.rs"]
mod hamiltonians;

/// Mass of the Moon over the mass of Earth and Moon.
const EARTH_MOON: f64 = 0.012150585609624;

const NAMES: [&str; 5] = ["x", "y", "z", "t", "u"];

/// M. Monagan and R. Pearce's sparse product: (1 + x + y + 2 z² + 3 t³ + 5 u⁵)ⁿ times the same with the variables reversed.
fn pearce<C: Coefficient>(n: u32) -> [Polynomial<C>; 2] {
    ["1 + x + y + 2*z^2 + 3*t^3 + 5*u^5", "1 + u + t + 2*z^2 + 3*y^3 + 5*x^5"].map(|text| power(text, n))
}

/// R. Fateman's dense product: f (f + 1), f = (1 + x + y + z + t)ⁿ.
fn fateman<C: Coefficient>(n: u32) -> [Polynomial<C>; 2] {
    let f = power("1 + x + y + z + t", n);
    let next = &f + &Polynomial::constant(C::one());
    [f, next]
}

fn power<C: Coefficient>(text: &str, n: u32) -> Polynomial<C> {
    let base = Polynomial::<C>::parse(text, &NAMES).expect("a polynomial");
    base.power(n).expect("small exponents")
}

/// All monomials of one degree in six variables with complex coefficients of order 1.
fn form(degree: u32, seed: u64) -> Polynomial<Complex<f64>> {
    let mut state = seed;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut terms = Vec::new();
    let mut exponents = [0_u32; 6];
    fill(&mut exponents, 0, degree, &mut |exponents| {
        let monomial = Monomial::new(exponents).expect("small exponents");
        terms.push((monomial, Complex::new(random(), random())));
    });
    Polynomial::from_terms(terms)
}

fn fill(exponents: &mut [u32; 6], slot: usize, rest: u32, take: &mut impl FnMut(&[u32])) {
    if slot == 5 {
        exponents[slot] = rest;
        return take(exponents);
    }
    for exponent in 0..=rest {
        exponents[slot] = exponent;
        fill(exponents, slot + 1, rest - exponent, take);
    }
}

/// Processor seconds of the main thread, by Linux's account; elsewhere the clock's.
fn processor_seconds(start: Instant) -> f64 {
    let account = std::fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = account.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| nanoseconds * 1e-9)
}

/// Runs a task and answers with a coefficient of its result.
fn timed<C: Coefficient>(name: &str, exponents: &[u32], task: impl FnOnce() -> Polynomial<C>) {
    let start = Instant::now();
    let before = processor_seconds(start);
    let answer = black_box(task());
    let (processor, clock) = (processor_seconds(start) - before, start.elapsed().as_secs_f64());
    let start = Instant::now();
    let monomial = Monomial::new(exponents).expect("small exponents");
    let literal = answer.coefficient(&monomial).map_or_else(|| "0".to_owned(), |c| c.literal().1);
    let reading = start.elapsed().as_secs_f64();
    let literal = literal.replace(' ', "");
    let mut out = std::io::stdout().lock();
    writeln!(out, "{name} {processor:.6} {clock:.6} {} {reading:.6} {literal}", answer.len())
        .expect("an open standard output");
}

fn product<C: Coefficient>(name: &str, [f, g]: &[Polynomial<C>; 2], exponents: &[u32]) {
    timed(name, exponents, || f.multiply(g).expect("small exponents"));
}

/// The brackets of the last order of a normal form of degree `degree` in three degrees of freedom, and one with a truncation.
fn brackets(name: &str, degree: u32) {
    let poisson = Poisson::new(&[(0, 1), (2, 3), (4, 5)]).expect("three pairs");
    let forms: Vec<_> = (3..degree).map(|d| form(d, d.into())).collect();
    timed(name, &[degree - 2, 1, 1], || {
        let brackets =
            forms.iter().zip(forms.iter().rev()).map(|(f, g)| poisson.bracket(f, g).expect("small exponents"));
        brackets.fold(Polynomial::zero(), |mut sum, bracket| {
            sum += &bracket;
            sum
        })
    });
}

fn truncated(name: &str, degree: u32) {
    let poisson = Poisson::new(&[(0, 1), (2, 3), (4, 5)]).expect("three pairs");
    let mut whole = Polynomial::zero();
    for d in 3..degree {
        whole += &form(d, d.into());
    }
    let kept = Truncation::total(degree);
    timed(name, &[3, 3], || poisson.bracket_truncated(&whole, &whole, &kept).expect("small exponents"));
    timed(name, &[3, 3], || whole.multiply_truncated(&whole, &kept).expect("small exponents"));
}

/// The normal form about L1 of Earth and Moon to a degree, in three degrees of freedom; its answer is a frequency of a centre times i.
fn collinear_point(name: &str, degree: u32, resonances: &Resonances) {
    let h = hamiltonians::collinear(EARTH_MOON, false, degree).expect("small exponents");
    let space = hamiltonians::space().expect("three pairs");
    timed(name, &[0, 0, 1, 1], || {
        let form = normalize_with(&h, degree as usize - 2, &space, resonances, &mut quiet);
        form.expect("no resonance").in_complex()
    });
}

fn main() -> ExitCode {
    let sparse = std::cell::LazyCell::new(|| pearce::<f64>(12));
    let sparse_exact = std::cell::LazyCell::new(|| pearce::<BigRational>(12));
    let dense = std::cell::LazyCell::new(|| fateman::<f64>(20));
    let dense_exact = std::cell::LazyCell::new(|| fateman::<BigRational>(20));
    for line in std::io::stdin().lock().lines() {
        let Ok(name) = line else { return ExitCode::FAILURE };
        match name.as_str() {
            "pearce-f64" => product(&name, &sparse, &[60, 0, 0, 0, 60]),
            "pearce-exact" => product(&name, &sparse_exact, &[60, 0, 0, 0, 60]),
            "fateman-f64" => product(&name, &dense, &[0, 0, 0, 40]),
            "fateman-exact" => product(&name, &dense_exact, &[0, 0, 0, 40]),
            "brackets-12" => brackets(&name, 12),
            "brackets-16" => brackets(&name, 16),
            "truncated-12" => truncated(&name, 12),
            "l1-12" => collinear_point(&name, 12, &Resonances::default()),
            "l1-20" => collinear_point(&name, 20, &Resonances::default()),
            "l1-centre-12" => collinear_point(&name, 12, &Resonances::default().with_centre()),
            "l1-centre-20" => collinear_point(&name, 20, &Resonances::default().with_centre()),
            _ => return ExitCode::FAILURE,
        }
    }
    ExitCode::SUCCESS
}
