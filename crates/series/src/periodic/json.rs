//! A driven normal form as JSON.
//!
//! ```text
//! { "format": "andoyer-driven", "version": 1, "order": N, "variables": [["q", "p"], …],
//!   "driven": [["M", n, M₀], …], "smallest_divisor": 1e-6,
//!   "start": [q₁, p₁, …],                                      where one was given
//!   "hamiltonian": [[[exponents, j …], c], …],                 cos jM for j ≥ 0 and sin |j|M for j < 0
//!   "actions": [[[exponents], c], …] }                         K in the actions
//! ```
//!
//! Reading computes the form of the Hamiltonian in the text again, and compares K.

use num_complex::Complex;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::named::DrivenNormalForm;
use crate::birkhoff::PhaseSpace;
use crate::birkhoff::json::reals;
use crate::birkhoff::verify::same;
use crate::document::document;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::triangle::Progress;

const FORMAT: &str = "andoyer-driven";
const VERSION: u64 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u64,
    order: usize,
    variables: Vec<(String, String)>,
    driven: Vec<(String, f64, f64)>,
    smallest_divisor: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<Vec<f64>>,
    hamiltonian: Vec<(Vec<i64>, Value)>,
    actions: Vec<(Vec<i64>, Value)>,
}

impl DrivenNormalForm {
    /// This form as JSON text.
    ///
    /// # Errors
    /// - None for an existing form; writing JSON fails only if memory runs out.
    pub fn to_json(&self) -> Result<String, Error> {
        let names = self.space.names();
        let term = |(m, c): (Monomial, &f64)| {
            let powers = m.exponents().into_iter().take(names.len()).map(i64::from);
            (powers.chain(self.space.harmonics(m)).collect(), Value::from(*c))
        };
        let action = |(m, c): (Monomial, &f64)| {
            (m.exponents().into_iter().take(names.len() / 2).map(i64::from).collect(), Value::from(*c))
        };
        let driven = self.space.driven().into_iter().zip(self.driven());
        let document = Document {
            format: FORMAT.to_owned(),
            version: VERSION,
            order: self.form().order(),
            variables: names.chunks(2).map(|pair| (pair[0].to_owned(), pair[1].to_owned())).collect(),
            driven: driven.map(|(name, (rate, start))| (name.to_owned(), rate, start)).collect(),
            smallest_divisor: self.smallest_divisor,
            start: self.start.clone(),
            hamiltonian: self.hamiltonian.terms().map(term).collect(),
            actions: self.form().in_actions()?.terms().map(action).collect(),
        };
        serde_json::to_string(&document).map_err(Error::json)
    }

    /// Reads the text that [`to_json`](Self::to_json) wrote, computes the form again and compares K.
    ///
    /// # Errors
    /// - no JSON, another format or version, terms that do not fit: as of [`BirkhoffNormalForm`](crate::BirkhoffNormalForm::from_json);
    /// - K differs from that of the Hamiltonian by more than 1e-8 of its largest coefficient: [`Error::CoefficientWrong`]; the errors of [`new`](Self::new).
    pub fn from_json(text: &str, progress: &mut Progress<'_>) -> Result<Self, Error> {
        let document: Document = document(text, FORMAT, VERSION)?;
        let pairs: Vec<(&str, &str)> = document.variables.iter().map(|(q, p)| (q.as_str(), p.as_str())).collect();
        let names: Vec<&str> = document.driven.iter().map(|(name, ..)| name.as_str()).collect();
        let space = PhaseSpace::new(&pairs)?.with_driven(&names)?;
        let hamiltonian = reals("original hamiltonian", &document.hamiltonian, &space, |_| true)?;
        let phases: Vec<(f64, f64)> = document.driven.iter().map(|&(_, rate, start)| (rate, start)).collect();
        let (order, bound, start) = (document.order, document.smallest_divisor, document.start.as_deref());
        let form = Self::from_state((&hamiltonian, &space), order, &phases, bound, start, progress)?;
        // Each action has the slot of its number.
        let mut actions = Polynomial::zero();
        for (exponents, c) in &document.actions {
            let exponents: Vec<i64> = exponents.iter().copied().chain(vec![0; pairs.len() + names.len()]).collect();
            actions += &reals("hamiltonian", &[(exponents, c.clone())], &space, |_| true)?;
        }
        let complex = |f: &Polynomial<f64>| f.map(|&c| Complex::from(c));
        same::<f64>(
            "hamiltonian",
            document.order,
            (&complex(&actions), &complex(&form.form().in_actions()?)),
            pairs.len(),
        )?;
        Ok(form)
    }
}
