//! The short-period part of the averaged motion: osculating = mean + W (weak torques (12), (13)).

use nalgebra::{Complex, Rotation3, UnitQuaternion, Vector3};

use super::equations::AveragedTorques;
use super::polhode_means::ExcessPolhode;
use super::torus::{ABOUT, ALONG, Lag, MomentumFrame, TorusTerms, signed, turned_axes};
use crate::error::Error;

/// A term next to a resonance is left out: 2|F ∂Ω/∂ξ| ≥ LIMIT Ω².
const LIMIT: f64 = 0.5;
/// A divisor below this part of the faster rate is the rounding error of 0.
const ROUNDING: f64 = 1e-14;
/// Below this ratio of √ξ to the change of ζ the excess is corrected by ζ: (12) divides by √ξ there.
const SMALL: f64 = 10.0;

/// Solution of first order on the torus at one state.
#[derive(Clone, Debug)]
pub(super) struct ShortPeriod {
    frame: MomentumFrame,
    polhode: ExcessPolhode,
    lag: Lag,
    /// h, m and the coefficients along k, x̂, ẑ and of ξ.
    terms: Vec<([i32; 2], [Complex<f64>; 4])>,
    /// Those of ζ = √α g_cn + iς√α₂ g₂ at ξ = 0, for each m.
    wobble: Vec<(i32, Complex<f64>)>,
}

impl ShortPeriod {
    /// At the mean state of a time.
    pub(super) fn new(
        equations: &AveragedTorques,
        time: f64,
        (momentum, excess): (&Vector3<f64>, f64),
    ) -> Result<Self, Error> {
        let size = momentum.norm();
        let torus = TorusTerms::new(equations, time, (momentum, excess))?;
        let wobble = Self::wobble(equations, time, (&torus.frame, size))?;
        let (rates, slopes) = torus.polhode.rates_and_slopes(size);
        let fastest = rates[0].abs().max(rates[1].abs());
        let mut terms = Vec::new();
        for m in 0..ABOUT {
            for h in 0..ALONG {
                let multiples = [signed(h, ALONG), signed(m, ABOUT)];
                let [divisor, slope] = [rates, slopes]
                    .map(|[wobble, turn]| f64::from(multiples[0]) * wobble + f64::from(multiples[1]) * turn);
                let term = torus.of(multiples);
                let resonant = 2.0 * (term[3] * slope).norm() >= LIMIT * divisor * divisor;
                if multiples != [0, 0] && divisor.abs() > ROUNDING * fastest && !resonant {
                    // W = F/(iΩ)
                    terms.push((multiples, term.map(|c| c / Complex::new(0.0, divisor))));
                }
            }
        }
        let TorusTerms { frame, polhode, lag, .. } = torus;
        Ok(Self { frame, polhode, lag, terms, wobble })
    }

    /// The coefficients of ζ for a rotation about the axis (13).
    fn wobble(
        equations: &AveragedTorques,
        time: f64,
        (frame, size): (&MomentumFrame, f64),
    ) -> Result<Vec<(i32, Complex<f64>)>, Error> {
        let polhode = ExcessPolhode::new(&equations.moments, equations.family, 0.0);
        let (family, sign) = (polhode.family, polhode.family.sign());
        let g = Vector3::ith(family.axis(), sign);
        let [first, second] = turned_axes(&polhode, &g);
        let rates = g.component_div(&polhode.moments) * size;
        let places = equations.places(time)?;
        let roots = [family.across(), 1].map(|axis| polhode.alpha[axis].sqrt());
        let turns = |about: usize| std::f64::consts::TAU * about as f64 / ABOUT as f64;
        let sample = |about: usize| {
            let (sine, cosine) = turns(about).sin_cos();
            let (x, z) = (first * cosine - second * sine, first * sine + second * cosine);
            let body = |v: &Vector3<f64>| g * v.dot(&frame.k) + x * v.dot(&frame.x) + z * v.dot(&frame.z);
            let views = places.iter().map(|view| super::sources::View { direction: body(&view.direction), ..*view });
            let torque = equations.torque(views, &rates) / size;
            Complex::new(roots[0] * torque[family.across()], sign * roots[1] * torque.y)
        };
        let samples: Vec<Complex<f64>> = (0..ABOUT).map(sample).collect();
        let (turn, wobble) = (size * polhode.mean_turn_rate(), size * polhode.wobble_rate());
        let coefficient = |place: usize| {
            let m = signed(place, ABOUT);
            let term =
                |(about, value): (usize, &Complex<f64>)| value * Complex::from_polar(1.0, -f64::from(m) * turns(about));
            let sum: Complex<f64> = samples.iter().enumerate().map(term).sum();
            // ζ̇ = iℓ̇′ζ + F e^(imy′)
            let divisor = f64::from(m) * turn - wobble;
            let resonant = divisor.abs() < 1e-3 * wobble;
            (m, if resonant { Complex::new(0.0, 0.0) } else { sum / ABOUT as f64 / Complex::new(0.0, divisor) })
        };
        Ok((0..ABOUT).map(coefficient).collect())
    }

    /// The mean state of a state with this attitude of the sorted axes: angular momentum and ξ.
    pub(super) fn mean(&self, attitude: &UnitQuaternion<f64>, momentum: &Vector3<f64>) -> (Vector3<f64>, f64) {
        let g = attitude.inverse() * momentum.normalize();
        let (along, turn) = self.angles(attitude, &g);
        self.mean_at((along, turn), &g, momentum)
    }

    /// The mean state of the state on the same polhode with other angles ℓ′ and y′.
    pub(super) fn mean_of_angles(&self, angles: (f64, f64), momentum: &Vector3<f64>) -> (Vector3<f64>, f64) {
        self.mean_at(angles, &self.polhode.direction(angles.0.sin_cos()), momentum)
    }

    fn mean_at(&self, (along, turn): (f64, f64), g: &Vector3<f64>, momentum: &Vector3<f64>) -> (Vector3<f64>, f64) {
        let mut sum = [0.0; 4];
        for ([h, m], term) in &self.terms {
            let wave = Complex::from_polar(1.0, f64::from(*h) * along + f64::from(*m) * turn);
            (0..4).for_each(|function| sum[function] += (term[function] * wave).re);
        }
        let [radial, x, z, excess] = sum;
        let momentum = momentum - (self.frame.k * radial + self.frame.x * x + self.frame.z * z);
        let polhode = &self.polhode;
        let change: Complex<f64> =
            self.wobble.iter().map(|(m, c)| c * Complex::from_polar(1.0, f64::from(*m) * turn)).sum();
        let size = self.wobble.iter().map(|(_, c)| c.norm()).sum::<f64>();
        if polhode.excess.sqrt() < SMALL * size {
            let (across, sign) = (polhode.family.across(), polhode.family.sign());
            let zeta = Complex::new(polhode.alpha[across].sqrt() * g[across], sign * polhode.alpha.y.sqrt() * g.y);
            return (momentum, (zeta - change).norm_sqr());
        }
        (momentum, (polhode.excess - excess).max(0.0))
    }

    /// ℓ′ and y′ of a state.
    fn angles(&self, attitude: &UnitQuaternion<f64>, g: &Vector3<f64>) -> (f64, f64) {
        let along = self.polhode.phase_of(g);
        let [first, second] = turned_axes(&self.polhode, g);
        let x = attitude.inverse() * self.frame.x;
        let turn = (-x.dot(&second)).atan2(x.dot(&first));
        (along, turn - self.lag.at(along))
    }

    /// Root mean square over both angles of the part that the averages leave out: of the angular momentum, and of ξ.
    pub(super) fn band(&self) -> [f64; 2] {
        let squares = |functions: std::ops::Range<usize>| -> f64 {
            self.terms.iter().flat_map(|(_, term)| &term[functions.clone()]).map(Complex::norm_sqr).sum()
        };
        [squares(0..3).sqrt(), squares(3..4).sqrt()]
    }
}

/// The attitude of the sorted axes.
pub(super) fn sorted_attitude(attitude: &UnitQuaternion<f64>, sort: &nalgebra::Matrix3<f64>) -> UnitQuaternion<f64> {
    attitude * UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(sort.transpose()))
}
