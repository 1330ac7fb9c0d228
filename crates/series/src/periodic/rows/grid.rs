//! The times at which periodic functions are held: N even steps of each driven phase, N odd, and the discrete Fourier transform.
//!
//! With N odd no harmonic lies at the border: the multiples of a phase are −(N − 1)/2 … (N − 1)/2, and the derivative of a function is exact to its last harmonic.
//! With several phases the grid is their product. Without a phase it is one time.

use std::f64::consts::TAU;

use num_complex::Complex;

use super::row::Periodic;

/// The times of the driven phases.
#[derive(Clone, Debug)]
pub struct Grid {
    axes: Vec<Axis>,
}

/// One phase.
#[derive(Clone, Debug)]
struct Axis {
    /// The rate of the phase [rad per unit of time].
    rate: f64,
    count: usize,
    /// cos and sin of 2π k j/N, k and j from 1 to (N − 1)/2: row k, column j.
    cosines: Vec<f64>,
    sines: Vec<f64>,
}

impl Axis {
    fn new(rate: f64, half: usize) -> Self {
        let count = 2 * half + 1;
        let products = (1..=half).flat_map(|k| (1..=half).map(move |j| k * j));
        let turns = products.map(|product| (product % count) as f64 / count as f64);
        let (sines, cosines) = turns.map(|turn| (TAU * turn).sin_cos()).unzip();
        Self { rate, count, cosines, sines }
    }

    /// The harmonic at a place of the transform.
    fn multiple(&self, place: usize) -> i64 {
        if 2 * place < self.count { place as i64 } else { place as i64 - self.count as i64 }
    }
}

/// The transform of one line of values. With e_k = x_k + x_{N−k} and o_k = x_k − x_{N−k} the sums at ±j are x₀ + Σ e_k cos ± i Σ o_k sin.
struct Line<'a> {
    axis: &'a Axis,
    sign: f64,
    /// The real and the imaginary parts of x₀, of e and of o, and of the two sums.
    first: [f64; 2],
    even: [Vec<f64>; 2],
    odd: [Vec<f64>; 2],
    cosines: [Vec<f64>; 2],
    sines: [Vec<f64>; 2],
}

impl<'a> Line<'a> {
    fn new(axis: &'a Axis, sign: f64) -> Self {
        let empty = || [vec![0.0; axis.count / 2], vec![0.0; axis.count / 2]];
        Self { axis, sign, first: [0.0; 2], even: empty(), odd: empty(), cosines: empty(), sines: empty() }
    }

    fn transform(&mut self, parts: [&mut [f64]; 2], start: usize, stride: usize) {
        let (count, half) = (self.axis.count, self.axis.count / 2);
        for (part, values) in parts.iter().enumerate() {
            self.first[part] = values[start];
            for k in 1..=half {
                let (one, two) = (values[start + k * stride], values[start + (count - k) * stride]);
                self.even[part][k - 1] = one + two;
                self.odd[part][k - 1] = one - two;
            }
        }
        pulp::Arch::new().dispatch(&mut *self);
        for j in 1..=half {
            let cosines = [self.cosines[0][j - 1], self.cosines[1][j - 1]];
            // ± i times the sum with sines
            let turned = [-self.sign * self.sines[1][j - 1], self.sign * self.sines[0][j - 1]];
            for part in 0..2 {
                parts[part][start + j * stride] = cosines[part] + turned[part];
                parts[part][start + (count - j) * stride] = cosines[part] - turned[part];
            }
        }
        for ((values, first), even) in parts.into_iter().zip(self.first).zip(&self.even) {
            values[start] = first + even.iter().sum::<f64>();
        }
    }
}

impl pulp::NullaryFnOnce for &mut Line<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let half = self.axis.count / 2;
        for part in 0..2 {
            let (cosines, sines) = (&mut self.cosines[part][..half], &mut self.sines[part][..half]);
            cosines.fill(self.first[part]);
            sines.fill(0.0);
            for k in 0..half {
                let (even, odd) = (self.even[part][k], self.odd[part][k]);
                let row = k * half..(k + 1) * half;
                let (along, across) = (&self.axis.cosines[row.clone()], &self.axis.sines[row]);
                for j in 0..half {
                    cosines[j] = even.mul_add(along[j], cosines[j]);
                    sines[j] = odd.mul_add(across[j], sines[j]);
                }
            }
        }
    }
}

impl Grid {
    /// The grid for harmonics up to `half` of each phase, which have these rates [rad per unit of time].
    #[must_use]
    pub fn new(phases: &[(f64, usize)]) -> Self {
        Self { axes: phases.iter().map(|&(rate, half)| Axis::new(rate, half)).collect() }
    }

    /// The number of times.
    #[must_use]
    pub fn times(&self) -> usize {
        self.axes.iter().map(|axis| axis.count).product()
    }

    /// The number of phases.
    #[must_use]
    pub fn phases(&self) -> usize {
        self.axes.len()
    }

    /// The rates of the phases.
    #[must_use]
    pub fn rates(&self) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.rate).collect()
    }

    /// The number of times of a phase.
    pub(crate) fn count(&self, phase: usize) -> usize {
        self.axes[phase].count
    }

    /// The grid of the first phase alone.
    pub(crate) fn first(&self) -> Self {
        Self { axes: self.axes[..1.min(self.axes.len())].to_vec() }
    }

    /// The same times with rates that are larger by a factor.
    pub(crate) fn faster(&self, factor: f64) -> Self {
        Self { axes: self.axes.iter().map(|axis| Axis { rate: axis.rate * factor, ..axis.clone() }).collect() }
    }

    /// The mean of a function over all phases but the first, on the grid of the first.
    pub(crate) fn mean_over_others(&self, function: &Periodic) -> Periodic {
        let others = self.times() / self.first().times();
        match function {
            Periodic::Constant(_) => function.clone(),
            Periodic::Row(row) => {
                Periodic::Row(row.chunks(others).map(|values| values.iter().sum::<f64>() / others as f64).collect())
            }
        }
    }

    /// A function of the first phase as one of all phases.
    pub(crate) fn extended(&self, function: &Periodic) -> Periodic {
        let others = self.times() / self.first().times();
        match function {
            Periodic::Constant(_) => function.clone(),
            Periodic::Row(row) => {
                Periodic::Row(row.iter().flat_map(|&value| std::iter::repeat_n(value, others)).collect())
            }
        }
    }

    /// The place along each axis of an index.
    fn places(&self, mut index: usize) -> Vec<usize> {
        let mut places = vec![0; self.axes.len()];
        for (place, axis) in places.iter_mut().zip(&self.axes).rev() {
            *place = index % axis.count;
            index /= axis.count;
        }
        places
    }

    /// The index of the harmonic with the opposite multiples.
    pub(crate) fn opposite(&self, index: usize) -> usize {
        let places = self.places(index).into_iter().zip(&self.axes);
        places.fold(0, |sum, (place, axis)| sum * axis.count + (axis.count - place) % axis.count)
    }

    /// The phases at a time \[rad\].
    #[must_use]
    pub fn angles(&self, index: usize) -> Vec<f64> {
        let angle = |(place, axis): (usize, &Axis)| TAU * place as f64 / axis.count as f64;
        self.places(index).into_iter().zip(&self.axes).map(angle).collect()
    }

    /// The multiples of the phases of a harmonic.
    #[must_use]
    pub fn multiples(&self, index: usize) -> Vec<i64> {
        self.places(index).into_iter().zip(&self.axes).map(|(place, axis)| axis.multiple(place)).collect()
    }

    /// The rate Σ j n of a harmonic.
    #[must_use]
    pub fn rate(&self, index: usize) -> f64 {
        self.multiples(index).iter().zip(&self.axes).map(|(&j, axis)| j as f64 * axis.rate).sum()
    }

    /// A function from its values at the phases.
    pub fn sampled(&self, mut value: impl FnMut(&[f64]) -> Complex<f64>) -> Periodic {
        if self.axes.is_empty() {
            return Periodic::Constant(value(&[]));
        }
        Periodic::of(&(0..self.times()).map(|index| value(&self.angles(index))).collect::<Vec<_>>())
    }

    /// The harmonics of a function.
    #[must_use]
    pub fn harmonics(&self, function: &Periodic) -> Vec<Complex<f64>> {
        match function {
            Periodic::Constant(c) => {
                let mut harmonics = vec![Complex::default(); self.times()];
                harmonics[0] = *c;
                harmonics
            }
            Periodic::Row(row) => {
                let mut row = row.to_vec();
                self.transform(&mut row, -1.0);
                let scale = 1.0 / self.times() as f64;
                (0..self.times()).map(|at| Complex::new(row[at], row[self.times() + at]) * scale).collect()
            }
        }
    }

    /// Whether a harmonic is solved for: its products with others up to it do not fold back to it. The multiples of each phase are at most a third of its times.
    pub(crate) fn is_solved(&self, index: usize) -> bool {
        self.multiples(index).iter().zip(&self.axes).all(|(j, axis)| 3 * j.unsigned_abs() <= axis.count as u64)
    }

    /// The function with these harmonics.
    #[must_use]
    pub fn function(&self, harmonics: &[Complex<f64>]) -> Periodic {
        if self.axes.is_empty() {
            return Periodic::Constant(harmonics[0]);
        }
        let mut row: Vec<f64> = harmonics.iter().map(|c| c.re).chain(harmonics.iter().map(|c| c.im)).collect();
        self.transform(&mut row, 1.0);
        Periodic::Row(row.into())
    }

    /// A function of another grid of the same phases, with the harmonics that both grids hold.
    pub(crate) fn with_harmonics_of(&self, other: &Self, function: &Periodic) -> Periodic {
        if matches!(function, Periodic::Constant(_)) {
            return function.clone();
        }
        let mut harmonics = vec![Complex::default(); self.times()];
        for (at, c) in other.harmonics(function).into_iter().enumerate() {
            if let Some(at) = self.place(&other.multiples(at)) {
                harmonics[at] = c;
            }
        }
        self.function(&harmonics)
    }

    /// The index of the harmonic with these multiples; none beyond the border.
    fn place(&self, multiples: &[i64]) -> Option<usize> {
        let mut places = multiples.iter().zip(&self.axes);
        places.try_fold(0, |sum, (&j, axis)| {
            let is_held = 2 * j.unsigned_abs() < axis.count as u64;
            is_held.then(|| sum * axis.count + j.rem_euclid(axis.count as i64) as usize)
        })
    }

    /// Σ_j x_j e^{± 2πi kj/N} along each axis.
    fn transform(&self, row: &mut [f64], sign: f64) {
        let times = self.times();
        let (re, im) = row.split_at_mut(times);
        let mut stride = times;
        for axis in &self.axes {
            stride /= axis.count;
            let mut line = Line::new(axis, sign);
            for start in (0..times).filter(|index| (index / stride).is_multiple_of(axis.count)) {
                line.transform([&mut *re, &mut *im], start, stride);
            }
        }
    }

    /// The function with each harmonic times `factor` of its index.
    pub fn filtered(
        &self,
        function: &Periodic,
        mut factor: impl FnMut(usize, Complex<f64>) -> Complex<f64>,
    ) -> Periodic {
        let harmonics: Vec<_> = self.harmonics(function).into_iter().enumerate().map(|(at, c)| factor(at, c)).collect();
        self.function(&harmonics)
    }

    /// The time derivative Σ n ∂/∂M.
    #[must_use]
    pub fn derivative(&self, function: &Periodic) -> Periodic {
        match function {
            Periodic::Constant(_) => Periodic::real(0.0),
            Periodic::Row(_) => self.filtered(function, |at, c| c * Complex::new(0.0, self.rate(at))),
        }
    }

    /// The weights of the times with which a function has its value at any phases.
    #[must_use]
    pub fn weights(&self, phases: &[f64]) -> Vec<f64> {
        let along = |(axis, phase): (&Axis, &f64)| -> Vec<f64> {
            let (count, phase) = (axis.count as f64, phase.rem_euclid(TAU));
            // (1 + 2 Σ cos j x)/N = sin(N x/2)/(N sin(x/2))
            let weight = |place: usize| {
                let angle = phase - TAU * place as f64 / count;
                let half = (angle - TAU * (angle / TAU).round()) / 2.0;
                let below = count * half.sin();
                if below == 0.0 { 1.0 } else { (count * half).sin() / below }
            };
            (0..axis.count).map(weight).collect()
        };
        let mut weights = vec![1.0];
        for axis in self.axes.iter().zip(phases).map(along) {
            weights = weights.iter().flat_map(|before| axis.iter().map(move |next| before * next)).collect();
        }
        weights
    }

    /// For every phase the largest harmonic among those above a quarter of its times.
    #[must_use]
    pub fn tails(&self, function: &Periodic) -> Vec<f64> {
        let mut tails = vec![0.0_f64; self.axes.len()];
        if matches!(function, Periodic::Constant(_)) {
            return tails;
        }
        for (at, c) in self.harmonics(function).into_iter().enumerate() {
            let multiples = self.multiples(at);
            for ((tail, axis), j) in tails.iter_mut().zip(&self.axes).zip(multiples) {
                if 4 * j.unsigned_abs() > axis.count as u64 {
                    *tail = tail.max(c.norm());
                }
            }
        }
        tails
    }
}
