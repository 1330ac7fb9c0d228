//! Normal forms of any Hamiltonian as LaTeX.

use super::PhaseSpace;
use crate::display::{Harmonics, significant};
use crate::error::Error;
use crate::harmonics;
use crate::latex::{Part, Series, fragment, symbol};
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;
use crate::real_field::RealField;

/// A part of a form with named variables: `kernel` is K with the names of its slots, `generator` one of a number, `image` the variable of a slot in the new
/// variables or, if not direct, in the old ones. New variables have a prime.
pub(crate) fn part<R: RealField>(
    (what, space, order): (Part, &PhaseSpace, usize),
    kernel: impl FnOnce() -> Result<(Polynomial<R::Complex>, Vec<String>), Error>,
    generator: impl Fn(usize) -> Result<Polynomial<R>, Error>,
    image: impl Fn(usize, bool) -> Result<Polynomial<R>, Error>,
) -> Result<String, Error> {
    let names = space.owned_names();
    let series = |name, f: &Polynomial<R::Complex>, names: &[String], primed| {
        let harmonics = if names == space.complex_names() { Harmonics::Complex } else { Harmonics::Real };
        let rounded = significant::<R>(f, space.driven_slots());
        Series::<R> {
            name,
            terms: rounded.terms().map(|(m, c)| (c.clone(), factors(m, space, names, harmonics, primed))).collect(),
        }
    };
    let real =
        |name, f: &Polynomial<R>, primed| series(name, &f.map(|c| R::complex(c.clone(), R::zero())), &names, primed);
    let all: Result<Vec<_>, Error> = match what {
        Part::Hamiltonian => kernel().map(|(k, names)| vec![series("K".to_owned(), &k, &names, false)]),
        Part::Generator => (1..=order).map(|m| Ok(real(format!("S_{{{m}}}"), &generator(m)?, true))).collect(),
        Part::Direct | Part::Inverse => {
            let direct = what == Part::Direct;
            let left = |slot: usize| symbol(&names[slot], if direct { "" } else { "'" });
            let image = |slot| Ok(real(left(slot), &image(slot, direct)?, direct));
            (0..2 * space.degrees_of_freedom()).map(image).collect()
        }
    };
    Ok(fragment("", &all?))
}

/// The variables of a monomial, those of a space or of the modes by `names`.
fn factors(monomial: Monomial, space: &PhaseSpace, names: &[String], harmonics: Harmonics, primed: bool) -> String {
    let power = |slot: usize, exponent: u32| match names.get(slot) {
        None => harmonics.latex(
            &symbol(space.driven().get(slot - names.len()).copied().unwrap_or_default(), ""),
            harmonics::signed(exponent),
        ),
        Some(name) => match (factor(name, if primed { "'" } else { "" }), exponent) {
            (base, 1) => base,
            (base, _) if primed => format!("{{{base}}}^{{{exponent}}}"),
            (base, _) => format!("{base}^{{{exponent}}}"),
        },
    };
    let powers = (0..SLOTS).map(|slot| (slot, monomial.exponent(slot))).filter(|&(_, exponent)| exponent > 0);
    powers.map(|(slot, exponent)| power(slot, exponent)).collect()
}

/// The action of a saddle or of a quartet in brackets, or a name, as LaTeX.
fn factor(name: &str, prime: &str) -> String {
    let Some(inner) = name.strip_prefix('(').and_then(|name| name.strip_suffix(')')) else {
        return symbol(name, prime);
    };
    let word = |word: &str| {
        if matches!(word, "+" | "-") {
            word.to_owned()
        } else {
            word.split('*').map(|name| symbol(name, prime)).collect()
        }
    };
    format!("({})", inner.split(' ').map(word).collect::<Vec<_>>().join(" "))
}
