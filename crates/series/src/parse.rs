//! Reads polynomials by recursive descent.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = { "+" | "-" } power
//! power   = atom [ ( "^" | "**" ) integer ]
//! atom    = number | name | "i" | "(" sum ")" | ( "cos" | "sin" ) "(" angle ")"
//! angle   = [ "+" | "-" ] multiple { ( "+" | "-" ) multiple }
//! multiple = phase | integer "*" phase | phase "*" integer
//! number  = digits [ "." [ digits ] ] [ "e" [ "+" | "-" ] digits ]
//! ```
//!
//! A cosine or a sine is read if the variables include driven phases, which occur nowhere else. Decimals are exact if the coefficients are: `0.1` is 1/10. A divisor must be a constant. `i` is the imaginary unit if the coefficients have one and no
//! variable has this name.
//!
//! Hostile text cannot block the parser or overflow the stack. Nesting, exponents and coefficients are bounded, and every operation on coefficients is charged
//! by their sizes before it is done. Products are therefore computed term by term with reduced fractions, because a common denominator could become huge.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::error::ParseProblem;
use crate::harmonics;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;

const DEEPEST: u32 = 100;
const LARGEST_EXPONENT: u32 = 1000;
/// Largest size of a coefficient in bits: 10,000 decimal digits each in numerator and denominator.
const LARGEST_COEFFICIENT: u64 = 1 << 16;
/// Units of work for one text, about a second. An operation on small fractions costs one unit; on large ones it costs a sixteenth of the square of the number
/// of words.
const BUDGET: u64 = 1 << 18;

struct Parser<'a> {
    text: &'a str,
    position: usize,
    names: &'a [&'a str],
    /// The slots of the driven phases, which are the last names.
    phases: std::ops::Range<usize>,
    depth: u32,
    budget: u64,
}

impl<C: Coefficient> Polynomial<C> {
    /// Reads a polynomial in the variables `names`: `names[slot]` is the variable of `slot`.
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// use num_complex::Complex;
    /// use num_rational::BigRational;
    /// let p = Polynomial::<Complex<BigRational>>::parse("(x + i*y)*(x - i*y)/2", &["x", "y"])?;
    /// assert_eq!(p.display(&["x", "y"]).to_string(), "1/2*x^2 + 1/2*y^2");
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::ExponentOverflow`] for `"(x^1000)^100"`. All other errors are [`Error::Parse`] with the byte position:
    /// - `"x +"`, `"x y"`, `"2z"`: a missing operand, an unexpected character, an unknown name;
    /// - `"1/x"`, `"1/(2-2)"`: a divisor that is not constant, or is 0;
    /// - `"x^1001"`, `"1e9999999"`, 101 nested brackets, `"(a+b+c+d+e+f+g+h)^1000"`: too large, too deep, too much work;
    /// - `names` with nine entries, with a name twice, or with a name that is not an identifier.
    pub fn parse(text: &str, names: &[&str]) -> Result<Self, Error> {
        Self::parse_driven(text, names, 0)
    }

    /// The same as [`parse`](Self::parse) if the last `driven` names are driven phases, whose cosines and sines the text may contain.
    pub(crate) fn parse_driven(text: &str, names: &[&str], driven: usize) -> Result<Self, Error> {
        check_names(names)?;
        let phases = names.len() - driven..names.len();
        let mut parser = Parser { text, position: 0, names, phases, depth: 0, budget: BUDGET };
        let value: Self = parser.sum()?;
        match parser.peek() {
            None if value.terms().all(|(_, c)| c.is_finite()) => Ok(value),
            None => Err(parser.fail(ParseProblem::TooLarge)),
            Some(other) => Err(parser.unexpected(other)),
        }
    }
}

pub(crate) fn check_names(names: &[&str]) -> Result<(), Error> {
    let usable = |name: &str| {
        let mut letters = name.chars();
        letters.next().is_some_and(is_name_start) && letters.all(is_name_part)
    };
    let unusable =
        names.iter().enumerate().find(|&(slot, name)| slot >= SLOTS || names[..slot].contains(name) || !usable(name));
    unusable.map_or(Ok(()), |(_, name)| {
        Err(Error::Parse { position: 0, problem: ParseProblem::UnusableName((*name).to_owned()) })
    })
}

fn is_name_start(letter: char) -> bool {
    letter.is_alphabetic() || letter == '_'
}

fn is_name_part(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        &self.text[self.position..]
    }

    /// The next character that is not white space; it is not consumed.
    fn peek(&mut self) -> Option<char> {
        self.position += self.rest().len() - self.rest().trim_start().len();
        self.rest().chars().next()
    }

    fn take(&mut self, letter: char) {
        self.position += letter.len_utf8();
    }

    fn take_while(&mut self, keep: impl Fn(char) -> bool) -> &str {
        let start = self.position;
        let length = self.rest().find(|letter| !keep(letter)).unwrap_or(self.rest().len());
        self.position += length;
        &self.text[start..self.position]
    }

    /// The error for a character where an operator is required.
    fn unexpected(&self, letter: char) -> Error {
        self.fail(if letter == '(' {
            ParseProblem::ProductWithoutSign
        } else {
            ParseProblem::UnexpectedCharacter(letter)
        })
    }

    fn fail(&self, problem: ParseProblem) -> Error {
        Error::Parse { position: self.position, problem }
    }

    /// Charges an operation on coefficients of `bits` bits in total; refuses coefficients that are too large.
    fn charge(&mut self, bits: u64) -> Result<(), Error> {
        let words = bits / 64;
        let left = if bits > LARGEST_COEFFICIENT { None } else { self.budget.checked_sub(1 + words * words / 16) };
        self.budget = left.ok_or_else(|| self.fail(ParseProblem::TooLarge))?;
        Ok(())
    }

    fn add<C: Coefficient>(&mut self, sum: &mut Polynomial<C>, monomial: Monomial, c: &C) -> Result<(), Error> {
        self.charge(c.bits() + sum.coefficient(&monomial).map_or(0, C::bits))?;
        sum.add_term(monomial, c);
        Ok(())
    }

    fn sum<C: Coefficient>(&mut self) -> Result<Polynomial<C>, Error> {
        let mut sum = self.product::<C>()?;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            self.take(sign);
            let term = self.product::<C>()?;
            for (monomial, c) in term.terms() {
                if sign == '+' {
                    self.add(&mut sum, monomial, c)?;
                } else {
                    self.add(&mut sum, monomial, &-c.clone())?;
                }
            }
        }
        Ok(sum)
    }

    fn product<C: Coefficient>(&mut self) -> Result<Polynomial<C>, Error> {
        let mut product = self.signed::<C>()?;
        while let Some(operator @ ('*' | '/')) = self.peek() {
            self.take(operator);
            let position = self.position;
            let mut factor = self.signed::<C>()?;
            if operator == '/' {
                let failure = |problem| Error::Parse { position, problem };
                let divisor = factor.as_constant().ok_or(failure(ParseProblem::DivisorNotConstant))?;
                self.charge(2 * divisor.bits())?; // the denominator of a complex inverse is the squared modulus
                factor = Polynomial::constant(divisor.invert().ok_or(failure(ParseProblem::DivisorZero))?);
            }
            product = self.multiply(&product, &factor)?;
        }
        Ok(product)
    }

    fn signed<C: Coefficient>(&mut self) -> Result<Polynomial<C>, Error> {
        let mut negative = false;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            self.take(sign);
            negative ^= sign == '-';
        }
        let mut value = self.power::<C>()?;
        if negative {
            value = -&value;
        }
        Ok(value)
    }

    fn power<C: Coefficient>(&mut self) -> Result<Polynomial<C>, Error> {
        let base = self.atom::<C>()?;
        self.peek();
        let Some(operator) = ["^", "**"].into_iter().find(|operator| self.rest().starts_with(operator)) else {
            return Ok(base);
        };
        self.position += operator.len();
        match self.peek() {
            Some('0'..='9') => {}
            Some(other) => return Err(self.fail(ParseProblem::UnexpectedCharacter(other))),
            None => return Err(self.fail(ParseProblem::UnexpectedEnd)),
        }
        let position = self.position;
        let too_large = Error::Parse { position, problem: ParseProblem::ExponentTooLarge { bound: LARGEST_EXPONENT } };
        let exponent = self.take_while(|letter| letter.is_ascii_digit()).parse::<u32>().ok();
        let Some(exponent) = exponent.filter(|&exponent| exponent <= LARGEST_EXPONENT) else { return Err(too_large) };
        let mut power = Polynomial::constant(C::one());
        for bit in (0..u32::BITS - exponent.leading_zeros()).rev() {
            power = self.multiply(&power, &power)?;
            if exponent >> bit & 1 == 1 {
                power = self.multiply(&power, &base)?;
            }
        }
        Ok(power)
    }

    fn atom<C: Coefficient>(&mut self) -> Result<Polynomial<C>, Error> {
        match self.peek() {
            None => Err(self.fail(ParseProblem::UnexpectedEnd)),
            Some('0'..='9') => self.number(),
            Some('.') if self.rest()[1..].starts_with(|letter: char| letter.is_ascii_digit()) => self.number(),
            Some('(') => {
                self.depth += 1;
                if self.depth > DEEPEST {
                    return Err(self.fail(ParseProblem::TooDeep { bound: DEEPEST }));
                }
                self.take('(');
                let value = self.sum()?;
                match self.peek() {
                    Some(')') => self.take(')'),
                    Some(other) => return Err(self.unexpected(other)),
                    None => return Err(self.fail(ParseProblem::UnexpectedEnd)),
                }
                self.depth -= 1;
                Ok(value)
            }
            Some(letter) if is_name_start(letter) => {
                let names = self.names;
                let position = self.position;
                let name = self.take_while(is_name_part).to_owned();
                let called = self.peek() == Some('(');
                let polynomial = match (names.iter().position(|known| *known == name), C::imaginary_unit()) {
                    (Some(slot), _) if self.phases.contains(&slot) => {
                        return Err(Error::Parse { position, problem: ParseProblem::PhaseAlone(name) });
                    }
                    (Some(slot), _) => Polynomial::variable(slot)?,
                    (None, Some(unit)) if name == "i" => Polynomial::constant(unit),
                    _ if called && matches!(&*name, "cos" | "sin") && !self.phases.is_empty() => {
                        self.take('(');
                        self.harmonic(name == "sin")?
                    }
                    _ if called && name == "sqrt" => {
                        return Err(Error::Parse { position, problem: ParseProblem::SquareRoot });
                    }
                    _ if called => return Err(Error::Parse { position, problem: ParseProblem::Function(name) }),
                    _ => return Err(Error::Parse { position, problem: ParseProblem::UnknownName(name) }),
                };
                Ok(polynomial)
            }
            Some(other) => Err(self.fail(ParseProblem::UnexpectedCharacter(other))),
        }
    }

    /// The cosine or sine of the angle after an opening bracket, by the theorems of addition.
    fn harmonic<C: Coefficient>(&mut self, sine: bool) -> Result<Polynomial<C>, Error> {
        let mut multiples = vec![0_i64; self.phases.len()];
        loop {
            let sign = self.peek().filter(|letter| matches!(letter, '+' | '-'));
            sign.into_iter().for_each(|sign| self.take(sign));
            let (phase, multiple) = self.multiple()?;
            multiples[phase] += if sign == Some('-') { -multiple } else { multiple };
            match self.peek() {
                Some('+' | '-') => {}
                Some(')') => break self.take(')'),
                Some(_) => return Err(self.fail(ParseProblem::Angle)),
                None => return Err(self.fail(ParseProblem::UnexpectedEnd)),
            }
        }
        let (mut cosine, mut sinus) = (Polynomial::constant(C::one()), Polynomial::zero());
        for (slot, j) in self.phases.clone().zip(multiples) {
            let c = Polynomial::from_terms([(harmonics::with(Monomial::ONE, slot, j.abs())?, C::one())]);
            let s = Polynomial::from_terms([(harmonics::with(Monomial::ONE, slot, -j.abs())?, C::integer(j.signum()))]);
            let mut next = self.multiply(&cosine, &c)?;
            next -= &self.multiply(&sinus, &s)?;
            sinus = self.multiply(&sinus, &c)?;
            sinus += &self.multiply(&cosine, &s)?;
            cosine = next;
        }
        Ok(if sine { sinus } else { cosine })
    }

    /// A multiple of a phase: the number of the phase and the factor.
    fn multiple(&mut self) -> Result<(usize, i64), Error> {
        let (mut phase, mut factor) = (None, None);
        loop {
            let letter = self.peek();
            let position = self.position;
            let fail = || Error::Parse { position, problem: ParseProblem::Angle };
            match letter {
                Some('0'..='9') if factor.is_none() => {
                    let digits = self.take_while(|letter| letter.is_ascii_digit());
                    factor = Some(digits.parse::<u16>().map_err(|_| fail())?);
                }
                Some(letter) if is_name_start(letter) && phase.is_none() => {
                    let name = self.take_while(is_name_part).to_owned();
                    let known = self.names[self.phases.clone()].iter().position(|known| *known == name);
                    phase = Some(known.ok_or_else(fail)?);
                }
                None => return Err(self.fail(ParseProblem::UnexpectedEnd)),
                _ => return Err(fail()),
            }
            if self.peek() != Some('*') {
                let factor = i64::from(factor.unwrap_or(1));
                return phase.map(|phase| (phase, factor)).ok_or_else(fail);
            }
            self.take('*');
        }
    }

    /// A decimal literal: its digits as one integer, multiplied or divided by a power of ten.
    fn number<C: Coefficient>(&mut self) -> Result<Polynomial<C>, Error> {
        let mut digits = self.take_while(|letter| letter.is_ascii_digit()).to_owned();
        let mut scale = 0_i64;
        if self.rest().starts_with('.') {
            self.take('.');
            let decimals = self.take_while(|letter| letter.is_ascii_digit()).to_owned();
            scale = -(decimals.len() as i64);
            digits.push_str(&decimals);
        }
        if let Some(exponent) = self.exponent() {
            // A clamped exponent always exceeds the bound on coefficients, which refuses it below.
            let largest = i64::from(u32::MAX);
            scale += exponent.parse::<i64>().map_or(largest, |power| power.clamp(-largest, largest));
        }
        let length = digits.len() as u64 + scale.unsigned_abs();
        self.charge(length * 10 / 3)?;
        let mut value = self.integer::<C>(&digits);
        let mut ten = C::one();
        for bit in (0..u64::BITS - scale.unsigned_abs().leading_zeros()).rev() {
            ten *= &ten.clone();
            if scale.unsigned_abs() >> bit & 1 == 1 {
                ten = ten.times(10);
            }
        }
        if scale > 0 {
            value *= &ten;
        } else {
            value = value.divide(&ten).ok_or(Error::DivisionByZero)?;
        }
        Ok(Polynomial::constant(value))
    }

    /// The exponent of a decimal; it is consumed only if digits follow the "e".
    fn exponent(&mut self) -> Option<String> {
        let rest = self.rest().strip_prefix(['e', 'E'])?;
        let digits = rest.strip_prefix(['+', '-']).unwrap_or(rest);
        let count = digits.len() - digits.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
        let length = rest.len() - digits.len() + count;
        let exponent = (count > 0).then(|| rest[..length].to_owned())?;
        self.position += 1 + length;
        Some(exponent)
    }

    /// An integer, built from chunks of 18 digits by ring operations only.
    fn integer<C: Coefficient>(&self, digits: &str) -> C {
        let mut value = C::zero();
        for chunk in digits.as_bytes().chunks(18) {
            let (part, base) =
                chunk.iter().fold((0, 1), |(part, base), &digit| (10 * part + i64::from(digit - b'0'), 10 * base));
            value = value.times(base);
            value += &C::integer(part);
        }
        value
    }

    fn multiply<C: Coefficient>(
        &mut self,
        left: &Polynomial<C>,
        right: &Polynomial<C>,
    ) -> Result<Polynomial<C>, Error> {
        let mut sum = Polynomial::zero();
        for (m, a) in left.terms() {
            for (n, b) in right.terms() {
                self.charge(a.bits() + b.bits())?;
                for (monomial, product) in harmonics::multiplied((m, a), (n, b), self.phases.clone())? {
                    self.add(&mut sum, monomial, &product)?;
                }
            }
        }
        Ok(sum)
    }
}
