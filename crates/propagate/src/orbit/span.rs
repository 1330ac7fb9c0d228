//! The part of the orbit within the span, and the sizes of the time derivatives of (a/r)³ r̂r̂ there.

use std::f64::consts::TAU;

use super::derivatives::{ORDERS, Orbital};
use super::position::eta;
use crate::orbit::conic::true_anomaly;
use crate::orbit::kepler::eccentric_anomaly;

/// Points of a span at which the sizes are taken.
const POINTS: usize = 48;

/// The time derivatives, with the size of each at the epoch, the largest within the span, and the largest at any time. The sizes are without the rates of node
/// and pericentre.
#[derive(Clone, Debug)]
pub(crate) struct Envelope {
    /// The time derivatives.
    pub(crate) orbital: Orbital,
    /// Largest rate of twice the true anomaly within the span.
    pub(crate) fastest: f64,
    /// Whether the pericentre is within the span.
    pub(crate) passes: bool,
    /// The share of a drift of second order, at most 1. It is the mean of (a/r)⁶ over the span plus (a/r)⁶ at the epoch, where the mean variables are found, both divided
    /// by the largest value within the span.
    pub(crate) square: f64,
    /// The share of a drift of third order, with (a/r)⁹ for (a/r)⁶.
    pub(crate) cube: f64,
    pub(crate) epoch: [f64; ORDERS + 1],
    pub(crate) span: [f64; ORDERS + 1],
    pub(crate) most: [f64; ORDERS + 1],
}

/// The part of the orbit that the disturbing body passes during the span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    pub(crate) eccentricity: f64,
    /// Mean anomaly at the epoch.
    pub(crate) anomaly: f64,
    /// Growth of the mean anomaly before and after the epoch within the span \[rad\].
    pub(crate) sides: [f64; 2],
}

impl Reach {
    /// The larger of both sides.
    pub(crate) fn longest(&self) -> f64 {
        let [before, after] = self.sides;
        before.max(after)
    }

    /// Whether the disturbing body passes every place of the orbit during the span.
    fn is_whole(&self) -> bool {
        self.sides.iter().sum::<f64>() >= TAU
    }

    /// Whether the pericentre is within the span.
    pub(crate) fn passes(&self) -> bool {
        let [before, after] = self.sides;
        let apart = wrapped(-self.anomaly);
        [apart - TAU, apart, apart + TAU].iter().any(|apart| (-before..=after).contains(apart))
    }

    /// Evenly spaced true anomalies from the first to the last of the span; from 0 to 2π for a whole orbit.
    fn places(&self) -> [f64; POINTS + 1] {
        let [before, after] = self.sides;
        let [first, middle, last] = [-before, 0.0, after].map(|by| self.true_anomaly(self.anomaly + by));
        let [first, last] = if self.is_whole() {
            [0.0, TAU]
        } else {
            [if first > middle { first - TAU } else { first }, if last < middle { last + TAU } else { last }]
        };
        std::array::from_fn(|k| first + (last - first) * k as f64 / POINTS as f64)
    }

    /// The mean over the span of a power of a/r plus that power at the epoch, both divided by the power of the largest a/r within the span; at most 1.
    fn share(&self, power: i32) -> f64 {
        // (a/r) η².
        let near = |f: f64| 1.0 + self.eccentricity * f.cos();
        let places = self.places();
        let nearest =
            if self.passes() { 1.0 + self.eccentricity } else { places.iter().map(|&f| near(f)).fold(0.0, f64::max) };
        // dl = η³/(1 + e cos f)² df.
        let part = |pair: &[f64]| {
            let near = near(0.5 * (pair[0] + pair[1]));
            (near / nearest).powi(power) / (near * near) * (pair[1] - pair[0])
        };
        let passages = if self.is_whole() { 1.0 + (self.longest() / TAU).floor() } else { 1.0 };
        let sum = places.windows(2).map(part).sum::<f64>() * eta(self.eccentricity).powi(3) * passages;
        let epoch = near(self.true_anomaly(self.anomaly)) / nearest;
        (sum / self.longest().max(f64::MIN_POSITIVE) + epoch.powi(power)).min(1.0)
    }

    fn true_anomaly(&self, mean: f64) -> f64 {
        true_anomaly(eccentric_anomaly(wrapped(mean), self.eccentricity), self.eccentricity)
    }
}

/// An angle from −π to π.
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

impl Envelope {
    /// The derivatives and sizes for a mean motion, and for rates of node and pericentre.
    pub(crate) fn new(mean_motion: f64, rates: [f64; 2], reach: &Reach) -> Self {
        let eccentricity = reach.eccentricity;
        let orbital = Orbital::new(eccentricity, mean_motion, [0.0; 2]);
        let largest = |places: &[f64]| {
            places
                .iter()
                .map(|&f| orbital.sizes_at(f))
                .fold([0.0_f64; ORDERS + 1], |most, sizes| std::array::from_fn(|j| most[j].max(sizes[j])))
        };
        let whole = Reach { sides: [TAU; 2], ..*reach };
        // The other half is its mirror image.
        let most = largest(&whole.places()[..=POINTS / 2]);
        let span = if reach.is_whole() { most } else { largest(&reach.places()) };
        let epoch = orbital.sizes_at(reach.true_anomaly(reach.anomaly));
        let (passes, eta) = (reach.passes(), eta(eccentricity));
        // ḟ = n η (a/r)², and a/r is the cube root of (a/r)³.
        let nearest = if passes { (1.0 + eccentricity) / (eta * eta) } else { span[0].cbrt() };
        let fastest = 2.0 * mean_motion * eta * nearest * nearest;
        let [square, cube] = [6, 9].map(|power| reach.share(power));
        let orbital = if rates == [0.0; 2] { orbital } else { Orbital::new(eccentricity, mean_motion, rates) };
        Self { orbital, fastest, passes, square, cube, epoch, span, most }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_span_that_is_far_from_the_pericentre_has_little_of_its_strength() {
        let eccentricity = 0.9;
        let at = |anomaly: f64, orbital: f64| {
            Envelope::new(1e-3, [0.0; 2], &Reach { eccentricity, anomaly, sides: [orbital; 2] })
        };
        let far = at(3.0, 0.3);
        assert!(!far.passes && far.span[0] <= 1e-3 * far.most[0] && far.fastest <= 1e-2 * at(3.0, 4.0).fastest);
        // With the pericentre between its ends it has all of it.
        let near = at(-0.2, 0.3);
        assert!(near.passes && near.span[0] >= 0.98 * near.most[0]);
        assert!((near.fastest - 2e-3 * 1.9_f64.powi(2) / 0.19_f64.powf(1.5)).abs() <= 1e-12);
    }

    #[test]
    fn a_span_after_the_pericentre_does_not_have_it() {
        let reach = |anomaly: f64, sides: [f64; 2]| Reach { eccentricity: 0.6, anomaly, sides };
        assert!(!reach(0.2, [0.0, 3.0]).passes() && reach(0.2, [0.3, 3.0]).passes() && reach(0.2, [0.0, 6.1]).passes());
        assert!(!reach(-0.2, [5.0, 0.1]).passes() && reach(-0.2, [6.1, 0.1]).passes());
        let places = reach(0.2, [0.0, 6.0]).places();
        let gained = places[POINTS] - places[0];
        assert!(gained < TAU && gained > 4.9, "{gained}");
    }

    #[test]
    fn drifts_of_an_eccentric_orbit_act_near_the_pericentre_alone() {
        let eccentricity: f64 = 0.6;
        let share = |anomaly: f64, orbital: f64| {
            Envelope::new(1e-3, [0.0; 2], &Reach { eccentricity, anomaly, sides: [orbital; 2] })
        };
        // ⟨(a/r)⁹⟩ = η⁻¹⁵ (1 + 21e²/2 + 105e⁴/8 + 35e⁶/16).
        let square = eccentricity * eccentricity;
        let mean = (1.0 - square).powf(-7.5)
            * (1.0 + 10.5 * square + 13.125 * square.powi(2) + 2.1875 * square.powi(3))
            * (1.0 - eccentricity).powi(9);
        let at_apocentre = 4.0_f64.powi(-9);
        let found = share(PI, TAU * 99.5).cube;
        assert!((found - (mean * 100.0 / 99.5 + at_apocentre)).abs() <= 1e-12, "{found:e} {mean:e}");
        // From the pericentre the mean variables are as far off as they can be. On a circle every place is alike.
        assert_eq!(share(0.0, 1e3).cube, 1.0);
        let circle = Envelope::new(1e-3, [0.0; 2], &Reach { eccentricity: 0.0, anomaly: 1.0, sides: [0.1; 2] });
        assert!(circle.cube == 1.0 && circle.square >= 1.0 - 1e-12);
        // Half an orbit past the apocentre sees nothing of the pericentre, and is measured by its own nearest place.
        let far = share(PI, 0.5);
        assert!(far.cube >= 0.9 && far.square <= 1.0);
    }
}
