//! Torques of shapes whose strength is any smooth function of the distance, such as a law of sublimation: the distances at which it must be known, and its series.
//!
//! The series is that of the polynomial through Chebyshev's nodes in x = r₀/r; places between the nodes show what it leaves out.

use std::f64::consts::PI;
use std::sync::Arc;

use super::sphere::SphereRule;
use crate::error::{Error, torque_refused};
use crate::input::distance_law::{DistanceLaw, MOST_COEFFICIENTS};
use crate::input::torque::Torque;
use crate::input::torque_source::{SourcePath, TorqueSource};

/// The largest error of the series, over the largest value of the law.
const TOLERANCE: f64 = 1e-6;
/// Coefficients below this, over the largest, are rounding errors.
const ROUNDING: f64 = 1e-14;
/// Half the interval of x is at least this, over its middle: a circle has one distance.
const NARROW: f64 = 0.01;
/// The part by which a table may come nearer or go farther between the places that are looked at.
const OF_TABLE: f64 = 0.02;

/// The distances of a source at which a law must be known.
#[derive(Clone, Debug)]
pub struct DistanceRule {
    source: TorqueSource,
    /// x at the nodes, and at the places between them.
    nodes: Vec<f64>,
    places: Vec<f64>,
    between: [f64; 2],
}

impl DistanceRule {
    /// The rule for a source with its reference distance, that of the values of the torque; it has the default of [`TorqueSource::falling`].
    ///
    /// # Errors
    /// - [`Error::Torque`] for a direction and a field, which have no distance, and for a reference distance that is missing or not positive.
    pub fn new(name: &str, path: SourcePath, at: Option<f64>) -> Result<Self, Error> {
        let source = TorqueSource::new(name, path).falling(1.0, at);
        let [mut nearest, mut farthest] = source.path().distances()?;
        source.validate()?;
        if matches!(source.path(), SourcePath::Tabulated(_)) {
            (nearest, farthest) = (nearest * (1.0 - OF_TABLE), farthest * (1.0 + OF_TABLE));
        }
        let (_, reference) = source.distance_power();
        let [mut low, mut high] = [reference / farthest, reference / nearest];
        let middle = 0.5 * (low + high);
        if high - middle < NARROW * middle {
            [low, high] = [middle * (1.0 - NARROW), middle * (1.0 + NARROW)];
        }
        if !(low >= 0.0 && low < high && high.is_finite()) {
            let bound = "a length for which r0/r is a double";
            return Err(torque_refused("reference_distances", format!("{}: {reference}", source.name()), bound));
        }
        let at = |k: f64| 0.5 * (high - low).mul_add((PI * k / MOST_COEFFICIENTS as f64).cos(), low + high);
        let nodes = (0..MOST_COEFFICIENTS).map(|k| at(k as f64 + 0.5)).collect();
        let places = (1..MOST_COEFFICIENTS).map(|k| at(k as f64)).collect();
        Ok(Self { source, nodes, places, between: [low, high] })
    }

    /// The distances, in the unit of the path: the last is the reference distance.
    pub fn distances(&self) -> Vec<f64> {
        let (_, reference) = self.source.distance_power();
        self.nodes.iter().chain(&self.places).chain([&1.0]).map(|x| reference / x).collect()
    }

    /// The torque with these values at the directions of a rule, and with a strength proportional to these values at the distances.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a value of the law that is negative or not finite, 0 at the reference distance, or out of the range of doubles over that; for a law whose series leaves out more than 1e-6
    ///   of its largest value.
    /// - As [`SphereRule::torque`].
    pub fn torque(&self, law: &[f64], (rule, values): (&SphereRule, &[[f64; 3]])) -> Result<Torque, Error> {
        let (law, left_out) = self.law(law)?;
        let torque = rule.torque(values, self.source.clone().following(law))?;
        let truncation = torque.truncation().hypot(left_out);
        torque.truncated(truncation)
    }

    /// The series, and its largest error over the largest value.
    fn law(&self, values: &[f64]) -> Result<(Arc<DistanceLaw>, f64), Error> {
        let distances = self.distances();
        if values.len() != distances.len() {
            return Err(Error::Length { argument: "law", found: values.len(), expected: distances.len() });
        }
        let (reference, at) = (values[values.len() - 1], distances[distances.len() - 1]);
        if !(reference > 0.0 && reference.is_finite()) {
            let bound = format!("finite and above 0 at the distance of the torque, {at}");
            return Err(torque_refused("law", reference, &bound));
        }
        for (value, distance) in values.iter().zip(&distances) {
            if !(*value >= 0.0 && (value / reference).is_finite()) {
                let bound = format!("finite and at least 0, over its value at {at} too, at the distance {distance}");
                return Err(torque_refused("law", value, &bound));
            }
        }
        let (known, checked) = values.split_at(self.nodes.len());
        let most = values[..values.len() - 1].iter().fold(0.0_f64, |most, value| most.max(*value)) / reference;
        let coefficients = coefficients(known, reference);
        let last = coefficients.iter().rposition(|c| c.abs() > ROUNDING * most).unwrap_or(0);
        let law = DistanceLaw::new(coefficients[..=last].to_vec(), self.between)?;
        let mut worst = (0.0, self.places[0]);
        for (x, value) in self.places.iter().zip(checked) {
            let error = (law.value(*x) - value / reference).abs() / most;
            if error > worst.0 {
                worst = (error, *x);
            }
        }
        let (error, x) = worst;
        if error > TOLERANCE {
            let (_, reference) = self.source.distance_power();
            let value = format!(
                "a function whose series leaves out {error:.1e} of its largest value at the distance {}",
                reference / x
            );
            let bound = "smooth between the nearest and the farthest distance: its Chebyshev series in 1/r, of 128 terms, may leave out 1e-6";
            return Err(torque_refused("law", value, bound));
        }
        Ok((Arc::new(law), error))
    }
}

/// c_k = (2/n) Σ f_j cos(k θ_j), half of it for k = 0.
fn coefficients(values: &[f64], reference: f64) -> Vec<f64> {
    let n = values.len();
    let coefficient = |k: usize| {
        // Whole multiples of π/2n below 4n keep the cosines exact to rounding.
        let angle = |j: usize| PI * ((k * (2 * j + 1)) % (4 * n)) as f64 / (2 * n) as f64;
        let sum: f64 = values.iter().enumerate().map(|(j, value)| value / reference * angle(j).cos()).sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / n as f64
    };
    (0..n).map(coefficient).collect()
}
