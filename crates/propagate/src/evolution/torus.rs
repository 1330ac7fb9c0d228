//! A torque at the points of the torus of both angles, and its Fourier coefficients (weak torques §5).
//!
//! ℓ′ runs along the polhode and y′ about the angular momentum. The frame is k along it, x̂ in the plane of k and the first source, ẑ = k × x̂.

use std::f64::consts::TAU;

use nalgebra::{Complex, Vector3};

use super::equations::AveragedTorques;
use super::polhode_means::ExcessPolhode;
use super::sources::View;
use crate::error::Error;

/// Points of ℓ′ and of y′. At ξ/ξ_sep = 0.9 the coefficients have errors of 2e-9 of the torque, at 0.99 of 1e-5.
pub(super) const ALONG: usize = 48;
pub(super) const ABOUT: usize = 24;

/// The inertial frame of the angular momentum.
#[derive(Clone, Copy, Debug)]
pub(super) struct MomentumFrame {
    pub(super) k: Vector3<f64>,
    pub(super) x: Vector3<f64>,
    pub(super) z: Vector3<f64>,
}

impl MomentumFrame {
    pub(super) fn new(momentum: &Vector3<f64>, towards: &Vector3<f64>) -> Self {
        let k = momentum.normalize();
        let across = towards - k * k.dot(towards);
        // Any direction serves a source along the angular momentum.
        let across = if across.norm() > 1e-8 { across } else { k.cross(&Vector3::ith(k.iamin(), 1.0)) };
        let x = across.normalize();
        Self { k, x, z: k.cross(&x) }
    }
}

/// Body vectors across g that the shortest turn from the axis of the mode to g makes of the other axes.
pub(super) fn turned_axes(polhode: &ExcessPolhode, g: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let (axis, sign) = (polhode.family.axis(), polhode.family.sign());
    let half = g + Vector3::ith(axis, sign);
    let turned = |v: Vector3<f64>| v - half * (v.dot(g) / (1.0 + sign * g[axis]));
    [turned(Vector3::ith((axis + 1) % 3, 1.0)), turned(Vector3::ith((axis + 2) % 3, sign))]
}

/// The rates on the torus at a mean state, as Fourier coefficients, and the angles that they belong to.
#[derive(Clone, Debug)]
pub(super) struct TorusTerms {
    pub(super) frame: MomentumFrame,
    pub(super) polhode: ExcessPolhode,
    pub(super) lag: Lag,
    coefficients: Box<TorusGrid<Complex<f64>>>,
}

impl TorusTerms {
    /// At a time, with the sources at their places.
    ///
    /// # Errors
    /// As [`AveragedTorques::places`].
    pub(super) fn new(
        equations: &AveragedTorques,
        time: f64,
        (momentum, excess): (&Vector3<f64>, f64),
    ) -> Result<Self, Error> {
        let polhode = ExcessPolhode::new(&equations.moments, equations.family, excess);
        let towards = equations.places(time)?.first().map_or_else(Vector3::z, |view| view.direction);
        let frame = MomentumFrame::new(momentum, &towards);
        let directions = std::array::from_fn(|point| polhode.direction(phase(point).sin_cos()));
        let lag = Lag::new(&polhode, &directions);
        let grid = torque_grid(equations, time, (&frame, &polhode, momentum.norm()), &directions, &lag)?;
        Ok(Self { frame, polhode, lag, coefficients: fourier(&grid) })
    }

    /// The coefficients of e^(i(hℓ′ + my′)): of the torque along k, x̂ and ẑ, and of ξ̇.
    pub(super) fn of(&self, [h, m]: [i32; 2]) -> [Complex<f64>; 4] {
        let [h, m] = [h.rem_euclid(ALONG as i32), m.rem_euclid(ABOUT as i32)].map(|place| place as usize); // not negative
        [0, 1, 2, 3].map(|function| self.coefficients[function][m][h])
    }
}

/// Four functions on the torus: the torque along k, x̂ and ẑ, and ξ̇, by function, y′ and ℓ′.
type TorusGrid<T> = [[[T; ALONG]; ABOUT]; 4];

/// The phase of a point of ℓ′, which is never 0.
fn phase(point: usize) -> f64 {
    TAU * (point as f64 + 0.5) / ALONG as f64
}

/// y − y′ as a Fourier series in ℓ′: coefficients of e^(ihℓ′) for h = 1, 2, … (those of −h are conjugate).
#[derive(Clone, Debug)]
pub(super) struct Lag(Vec<Complex<f64>>);

impl Lag {
    /// From the rates of y at the points, over M.
    fn new(polhode: &ExcessPolhode, directions: &[Vector3<f64>; ALONG]) -> Self {
        let wobble = polhode.wobble_rate();
        let coefficient = |h: usize| {
            let term = |(point, g): (usize, &Vector3<f64>)| {
                Complex::from_polar(polhode.turn_rate(g), -(h as f64) * phase(point)) / ALONG as f64
            };
            let sum: Complex<f64> = directions.iter().enumerate().map(term).sum();
            if wobble > 0.0 { sum / Complex::new(0.0, h as f64 * wobble) } else { Complex::new(0.0, 0.0) }
        };
        Self((1..ALONG / 2).map(coefficient).collect())
    }

    pub(super) fn at(&self, phase: f64) -> f64 {
        let term = |(h, coefficient): (usize, &Complex<f64>)| {
            2.0 * (coefficient * Complex::from_polar(1.0, (h + 1) as f64 * phase)).re
        };
        self.0.iter().enumerate().map(term).sum()
    }
}

/// The torque on the torus at a state, with the sources at their places.
fn torque_grid(
    equations: &AveragedTorques,
    time: f64,
    (frame, polhode, size): (&MomentumFrame, &ExcessPolhode, f64),
    directions: &[Vector3<f64>; ALONG],
    lag: &Lag,
) -> Result<Box<TorusGrid<f64>>, Error> {
    let views = equations.places(time)?;
    let mut grid: Box<TorusGrid<f64>> = Box::new([[[0.0; ALONG]; ABOUT]; 4]);
    let lever = polhode.alpha.add_scalar(-polhode.excess) * (2.0 / size);
    for (point, g) in directions.iter().enumerate() {
        let [first, second] = turned_axes(polhode, g);
        let (rates, lag) = (g.component_div(&polhode.moments) * size, lag.at(phase(point)));
        for about in 0..ABOUT {
            let (sine, cosine) = (TAU * about as f64 / ABOUT as f64 + lag).sin_cos();
            let (x, z) = (first * cosine - second * sine, first * sine + second * cosine);
            let body = |v: &Vector3<f64>| g * v.dot(&frame.k) + x * v.dot(&frame.x) + z * v.dot(&frame.z);
            let views = views.iter().map(|view| View { direction: body(&view.direction), ..*view });
            let torque = equations.torque(views, &rates);
            let values = [torque.dot(g), torque.dot(&x), torque.dot(&z), g.component_mul(&torque).dot(&lever)];
            values.into_iter().enumerate().for_each(|(function, value)| grid[function][about][point] = value);
        }
    }
    Ok(grid)
}

/// Fourier coefficients of e^(i(hℓ′ + my′)); a negative h or m stands at the end of its axis.
fn fourier(grid: &TorusGrid<f64>) -> Box<TorusGrid<Complex<f64>>> {
    let zero = Complex::new(0.0, 0.0);
    let mut along = Box::new([[[zero; ALONG]; ABOUT]; 4]);
    let mut found = along.clone();
    let root = |turns: f64| Complex::from_polar(1.0, -TAU * turns);
    let roots: [Complex<f64>; 2 * ALONG] = std::array::from_fn(|j| root(j as f64 / (2 * ALONG) as f64));
    let turns: [Complex<f64>; ABOUT] = std::array::from_fn(|j| root(j as f64 / ABOUT as f64));
    for function in 0..4 {
        for about in 0..ABOUT {
            for h in 0..ALONG {
                // Points lie at half steps; e^(−ihℓ′) for the signed h.
                let signed = signed(h, ALONG).rem_euclid(2 * ALONG as i32) as usize;
                let term = |point: usize| roots[signed * (2 * point + 1) % (2 * ALONG)] * grid[function][about][point];
                along[function][about][h] = (0..ALONG).map(term).sum::<Complex<f64>>() / ALONG as f64;
            }
        }
        for m in 0..ABOUT {
            for h in 0..ALONG {
                let term = |about: usize| turns[m * about % ABOUT] * along[function][about][h];
                found[function][m][h] = (0..ABOUT).map(term).sum::<Complex<f64>>() / ABOUT as f64;
            }
        }
    }
    found
}

/// The multiple that a place of a Fourier transform has.
pub(super) fn signed(place: usize, points: usize) -> i32 {
    if place < points / 2 { place as i32 } else { place as i32 - points as i32 }
}
