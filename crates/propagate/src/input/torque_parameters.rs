//! The parameters of a torque, in which it is linear, for derivatives with respect to them.

use super::torque::{PolynomialTorque, Torque};
use super::torque_source::SourcePath;
use crate::error::Error;

/// A polynomial with more coefficients has its factor alone.
const MOST_COEFFICIENTS: usize = 60;

impl Torque {
    /// The names of its parameters, each with the torque that it multiplies: the components of a constant torque, of the momentum of rotors and of a dipole, the elements of a damping matrix, and of another polynomial its
    /// factor and, up to 60, its coefficients. Internal friction has none.
    ///
    /// # Errors
    /// Those of [`Torque::polynomial`]: none, for a torque that was made by it.
    pub(crate) fn parameters(&self) -> Result<Vec<(String, Self)>, Error> {
        let unit = |k: usize| std::array::from_fn(|axis| if axis == k { 1.0 } else { 0.0 });
        let vector = |name: &str, make: fn([f64; 3]) -> Self| {
            (0..3).map(|k| (format!("{name}_{}", k + 1), make(unit(k)))).collect()
        };
        Ok(match self {
            Self::Constant(_) => vector("constant", Self::Constant),
            Self::Rotor(_) => vector("rotor", Self::Rotor),
            Self::Damping(_) => {
                let element = |i: usize, k: usize| {
                    let mut matrix = [[0.0; 3]; 3];
                    matrix[i][k] = 1.0;
                    (format!("damping_{}{}", i + 1, k + 1), Self::Damping(matrix))
                };
                (0..9).map(|index| element(index / 3, index % 3)).collect()
            }
            Self::Dissipation(_) => Vec::new(),
            Self::Polynomial(torque) if torque.is_dipole() => {
                let source = &torque.sources()[0];
                let dipole = |k: usize| {
                    let found = Self::dipole(unit(k), source.path().clone())?;
                    Ok::<_, Error>((format!("dipole_{}", k + 1), found))
                };
                (0..3).map(dipole).collect::<Result<_, _>>()?
            }
            Self::Polynomial(torque) => torque.factor_and_coefficients(self)?,
        })
    }
}

impl PolynomialTorque {
    /// Whether it is m × b of one source times its size: that of a field, a table of vectors, or a uniform one.
    fn is_dipole(&self) -> bool {
        let [source] = self.sources() else { return false };
        let in_field = match source.path() {
            SourcePath::Direction(_) => source.distance_power().0 == 0.0,
            SourcePath::Field(_) | SourcePath::Tabulated(_) => source.distance_power() == (-1.0, 1.0),
            SourcePath::Orbit(_) => false,
        };
        let mut rows = [[0.0; 3]; 3];
        for (row, terms) in rows.iter_mut().zip(self.terms()) {
            for (coefficient, exponents) in terms {
                match exponents[..3].iter().position(|power| *power == 1) {
                    Some(axis) if exponents.iter().sum::<u32>() == 1 => row[axis] += coefficient,
                    _ => return false,
                }
            }
        }
        in_field && (0..3).all(|i| (0..3).all(|k| rows[i][k] == -rows[k][i]))
    }

    /// The factor of the whole torque, and the coefficients of its monomials.
    fn factor_and_coefficients(&self, whole: &Torque) -> Result<Vec<(String, Torque)>, Error> {
        let mut found = vec![("factor".to_owned(), whole.clone())];
        let names = self.sources().iter().map(|source| source.name()).chain(["w"]);
        let names: Vec<String> = names.flat_map(|name| (1..=3).map(move |axis| format!("{name}{axis}"))).collect();
        let terms = self.terms();
        if terms.iter().map(Vec::len).sum::<usize>() > MOST_COEFFICIENTS {
            return Ok(found);
        }
        for (axis, terms) in terms.iter().enumerate() {
            for (_, exponents) in terms {
                let powers = names.iter().zip(exponents).filter(|(_, power)| **power > 0);
                let powers =
                    powers.map(|(name, power)| if *power == 1 { name.clone() } else { format!("{name}^{power}") });
                let monomial = powers.collect::<Vec<_>>().join("*");
                let monomial = if monomial.is_empty() { "1".to_owned() } else { monomial };
                let mut texts = ["0"; 3];
                texts[axis] = &monomial;
                let alone = Torque::polynomial(texts, self.sources().to_vec())?;
                found.push((format!("coefficient_{}:{monomial}", axis + 1), alone));
            }
        }
        Ok(found)
    }
}
