//! The part of the orbit within the span, and the sizes of the time derivatives of (a/r)³ r̂r̂ there.

use std::f64::consts::TAU;

use super::derivatives::{ORDERS, Orbital};
use crate::simd::kepler::eccentric_anomaly;

/// Points of a span at which the sizes are taken.
const POINTS: usize = 48;

/// The time derivatives, with the size of each at the epoch, the largest within the span, and the largest at any time.
#[derive(Clone, Debug)]
pub(crate) struct Envelope {
    /// The time derivatives.
    pub(crate) orbital: Orbital,
    /// Largest rate of twice the true anomaly within the span.
    pub(crate) fastest: f64,
    /// Whether the pericentre is within the span.
    pub(crate) passes: bool,
    pub(crate) share: Share,
    pub(crate) epoch: [f64; ORDERS + 1],
    pub(crate) span: [f64; ORDERS + 1],
    pub(crate) most: [f64; ORDERS + 1],
}

/// Means of powers of u = (a/r)³ over the span, over the power where the disturbing body is nearest within the span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    /// The mean of u²: a drift of second order.
    pub(crate) square: f64,
    /// The mean of u³, plus u³ at the epoch for the errors of the mean variables found there: a drift of third order.
    pub(crate) cube: f64,
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

    /// Whether the span has a mean anomaly.
    pub(crate) fn contains(&self, anomaly: f64) -> bool {
        let [before, after] = self.sides;
        let apart = wrapped(anomaly - self.anomaly);
        [apart - TAU, apart, apart + TAU].iter().any(|apart| (-before..=after).contains(apart))
    }

    /// Evenly spaced true anomalies within the span on both sides of the epoch.
    pub(crate) fn places(&self) -> Vec<f64> {
        if self.is_whole() {
            return (0..POINTS).map(|k| TAU * k as f64 / POINTS as f64).collect();
        }
        let [before, after] = self.sides;
        let [first, last] = [-before, after].map(|by| self.true_anomaly(self.anomaly + by));
        let middle = self.true_anomaly(self.anomaly);
        let first = if first > middle { first - TAU } else { first };
        let last = if last < middle { last + TAU } else { last };
        (0..=POINTS).map(|k| first + (last - first) * k as f64 / POINTS as f64).collect()
    }

    /// The shares of the drifts.
    fn share(&self) -> Share {
        // (a/r) over η^(−2), at a true anomaly.
        let near = |f: f64| 1.0 + self.eccentricity * f.cos();
        let places = self.places();
        let whole = self.is_whole();
        let nearest = if self.passes() { near(0.0) } else { places.iter().map(|&f| near(f)).fold(0.0, f64::max) };
        let mean = |power: i32| {
            let sum: f64 = if whole {
                places.iter().map(|&f| (near(f) / nearest).powi(power) / near(f).powi(2)).sum::<f64>() * TAU
            } else {
                let ends = [places[0], places[POINTS]];
                let steps = places.windows(2).map(|pair| near(0.5 * (pair[0] + pair[1])));
                steps.map(|n| (n / nearest).powi(power) / n.powi(2)).sum::<f64>() * (ends[1] - ends[0])
            };
            // dl = η³/(1 + e cos f)² df.
            let eta_square = (1.0 - self.eccentricity) * (1.0 + self.eccentricity);
            let passages = if whole { 1.0 + (self.longest() / TAU).floor() } else { 1.0 };
            (sum / POINTS as f64 * eta_square.powf(1.5) * passages / self.longest().max(f64::MIN_POSITIVE)).min(1.0)
        };
        let epoch = near(self.true_anomaly(self.anomaly)) / nearest;
        Share { square: mean(6), cube: (mean(9) + epoch.powi(9)).min(1.0) }
    }

    /// Whether the span has the pericentre.
    pub(crate) fn passes(&self) -> bool {
        self.contains(0.0)
    }

    pub(crate) fn true_anomaly(&self, mean: f64) -> f64 {
        let e = self.eccentricity;
        let half = 0.5 * eccentric_anomaly(wrapped(mean), e);
        2.0 * ((1.0 + e).sqrt() * half.sin()).atan2((1.0 - e).sqrt() * half.cos())
    }
}

/// An angle from −π to π.
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

impl Envelope {
    /// The derivatives for an orbit, its mean motion, and the rates of its node and pericentre. The sizes are those without these rates.
    pub(crate) fn new(eccentricity: f64, mean_motion: f64, rates: [f64; 2], reach: &Reach) -> Self {
        let orbital = Orbital::new(eccentricity, mean_motion);
        let at = |f: f64| orbital.sizes_at(f);
        let largest = |places: &[f64]| {
            places.iter().map(|&f| at(f)).fold([0.0; ORDERS + 1], |most: [f64; ORDERS + 1], sizes| {
                std::array::from_fn(|j| most[j].max(sizes[j]))
            })
        };
        let whole = Reach { sides: [TAU; 2], ..*reach };
        // The other half is its mirror image.
        let most = largest(&whole.places()[..=POINTS / 2]);
        let span = if reach.is_whole() { most } else { largest(&reach.places()) };
        let epoch = at(reach.true_anomaly(reach.anomaly));
        let passes = reach.passes();
        let eta_square = (1.0 - eccentricity) * (1.0 + eccentricity);
        // ḟ = n η (a/r)², and a/r is the cube root of (a/r)³.
        let nearest = if passes { (1.0 + eccentricity) / eta_square } else { span[0].cbrt() };
        let fastest = 2.0 * mean_motion * eta_square.sqrt() * nearest * nearest;
        let orbital = if rates == [0.0; 2] { orbital } else { Orbital::precessing(eccentricity, mean_motion, rates) };
        Self { orbital, fastest, passes, share: reach.share(), epoch, span, most }
    }
}

/// The sizes for a span of a whole orbit.
#[cfg(test)]
pub(crate) fn whole(eccentricity: f64, mean_motion: f64) -> Envelope {
    Envelope::new(eccentricity, mean_motion, [0.0; 2], &Reach { eccentricity, anomaly: 0.0, sides: [TAU; 2] })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_span_that_is_far_from_the_pericentre_has_little_of_its_strength() {
        let eccentricity = 0.9;
        let at = |anomaly: f64, orbital: f64| {
            Envelope::new(eccentricity, 1e-3, [0.0; 2], &Reach { eccentricity, anomaly, sides: [orbital; 2] })
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
            Envelope::new(eccentricity, 1e-3, [0.0; 2], &Reach { eccentricity, anomaly, sides: [orbital; 2] }).share
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
        let circle =
            Envelope::new(0.0, 1e-3, [0.0; 2], &Reach { eccentricity: 0.0, anomaly: 1.0, sides: [0.1; 2] }).share;
        assert!(circle.cube == 1.0 && circle.square >= 1.0 - 1e-12);
        // Half an orbit past the apocentre sees nothing of the pericentre, and is measured by its own nearest place.
        let far = share(PI, 0.5);
        assert!(far.cube >= 0.9 && far.square <= 1.0);
    }
}
