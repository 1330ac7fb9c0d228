//! DOP853 of `ode_solvers` with dense output on uniform times, as a process that is asked for runs.
//!
//! The first line of the input is the scene: three moments, a unit quaternion, three rates, tolerance, number of times, last time, number of indices, indices.
//! Each further line asks for a run and is answered by a line of JSON: CPU seconds of a run, those of the integration without output, and
//! the rows [x, y, z, w, ω1, ω2, ω3] at the indices. The crate has no continuous output for DOP853: other than uniform times it does not serve.

use std::error::Error;
use std::io::{self, BufRead, Write};

use cpu_time::ProcessTime;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, SVector, System};

type Row = SVector<f64, 7>;

/// Runs of which the median counts.
const RUNS: usize = 7;

/// Euler's equations and q′ = q ω/2.
#[derive(Clone, Copy)]
struct FreeBody {
    /// (B − C)/A and its cyclic permutations.
    factors: [f64; 3],
}

impl System<f64, Row> for FreeBody {
    fn system(&self, _t: f64, row: &Row, slope: &mut Row) {
        let [x, y, z, w, p, q, r] = row.data.0[0];
        slope[0] = 0.5 * (w * p + y * r - z * q);
        slope[1] = 0.5 * (w * q + z * p - x * r);
        slope[2] = 0.5 * (w * r + x * q - y * p);
        slope[3] = -0.5 * (x * p + y * q + z * r);
        slope[4] = self.factors[0] * q * r;
        slope[5] = self.factors[1] * r * p;
        slope[6] = self.factors[2] * p * q;
    }
}

struct Scene {
    body: FreeBody,
    start: Row,
    tolerance: f64,
    count: usize,
    stop: f64,
    indices: Vec<usize>,
}

impl Scene {
    fn parse(line: &str) -> Result<Self, Box<dyn Error>> {
        let numbers = line.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let (Some((&[a, b, c], rest)), true) = (numbers.split_first_chunk(), numbers.len() >= 13) else {
            return Err("a scene has 13 numbers at least".into());
        };
        Ok(Self {
            body: FreeBody { factors: [(b - c) / a, (c - a) / b, (a - b) / c] },
            start: Row::from_row_slice(&rest[..7]),
            tolerance: rest[7],
            count: rest[8] as usize,
            stop: rest[9],
            indices: rest[10..].iter().map(|&index| index as usize).collect(),
        })
    }

    /// CPU seconds, and a row for each time.
    fn integrate(&self, output: OutputType) -> Result<(f64, Vec<Row>), Box<dyn Error>> {
        let start = ProcessTime::now();
        let step = self.stop / (self.count - 1) as f64;
        let mut solver = Dop853::new(self.body, 0.0, self.stop, step, self.start, self.tolerance, self.tolerance);
        solver.set_output(output);
        solver.integrate()?;
        let seconds = start.elapsed().as_secs_f64();
        Ok((seconds, solver.y_out().clone()))
    }

    /// The same with the median seconds of some runs: the first has fresh pages of memory to fill.
    fn median(&self, output: impl Fn() -> OutputType) -> Result<(f64, Vec<Row>), Box<dyn Error>> {
        let (mut seconds, mut rows) = (Vec::new(), Vec::new());
        for _ in 0..RUNS {
            let (run, answer) = self.integrate(output())?;
            seconds.push(run);
            rows = answer;
        }
        seconds.sort_by(f64::total_cmp);
        Ok((seconds[RUNS / 2], rows))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut lines = io::stdin().lock().lines();
    let scene = Scene::parse(&lines.next().ok_or("no scene")??)?;
    for line in lines {
        line?;
        let (integration, _) = scene.median(|| OutputType::Sparse)?;
        let (seconds, rows) = scene.median(|| OutputType::Dense)?;
        // Its own times may end one step early.
        let wanted = scene.indices.iter().filter_map(|&index| rows.get(index));
        let rows: Vec<_> = wanted.map(|row| row.as_slice().to_vec()).collect();
        println!("{{\"seconds\": {seconds:e}, \"set_up\": {integration:e}, \"rows\": {rows:?}}}");
        io::stdout().flush()?;
    }
    Ok(())
}
