//! Figures of the gravity-gradient theory against an integration of the full equations, as CSV on standard output.
//!
//! `cases`: the share of the torque's effect on the attitude that each level leaves in the reference cases.
//! `levels`: the share of the torque's effect on the attitude that each level leaves, against J, n/spin, e and B − A, one of them varied at a time.
//! `climb STARTS STEPS SEED`: the largest error over its bound that hill climbing finds, by family, mode and averaging.
//! `bounds N`: the error of N random scenes over the bound that the plan states, for both averagings.

use std::io::{self, Write};

use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};
use andoyer_tests::climb::{FAMILIES, Summit, Uniform, climb};
use andoyer_tests::disturbed::Disturbed;
use andoyer_tests::integration::Problem;
use andoyer_tests::{attitude_error, cases, orbits};

/// Samples of a run.
const SAMPLES: usize = 61;

/// A body, its tilt, and the orbit; the spin is 1.
#[derive(Clone, Copy)]
struct Setting {
    moments: [f64; 3],
    tilt: f64,
    /// ν at the epoch.
    azimuth: f64,
    inclination: f64,
    mean_motion: f64,
    eccentricity: f64,
    /// Orbits.
    orbits: f64,
}

struct Run {
    scene: Scene,
    orbit: Orbit,
    times: Vec<f64>,
    truth: Vec<([f64; 4], [f64; 3])>,
}

impl Setting {
    fn run(&self) -> Result<Run, Error> {
        let (sine, cosine) = self.tilt.sin_cos();
        let [a, b, c] = self.moments;
        let rates = [c / a * sine * self.azimuth.sin(), c / b * sine * self.azimuth.cos(), cosine];
        let (half_sine, half_cosine) = (0.5 * self.inclination).sin_cos();
        let attitude = [half_sine, 0.0, 0.0, half_cosine];
        let orbit = Orbit::new(self.mean_motion, self.eccentricity)?.plane(0.0, 0.0, 0.7)?;
        let span = self.orbits * std::f64::consts::TAU / self.mean_motion;
        let times: Vec<f64> = (0..SAMPLES).map(|k| span * k as f64 / (SAMPLES - 1) as f64).collect();
        let truth = Problem { moments: self.moments, orbit: Some(orbit) }.integrate(0.0, attitude, rates, &times);
        let scene = Scene::new(Body::new(self.moments)?, State::new(0.0, attitude, rates)?)
            .span(0.0, span)
            .method(Method::Closed);
        Ok(Run { scene, orbit, times, truth })
    }
}

impl Run {
    fn error(&self, motion: &Motion) -> Result<f64, Error> {
        let mut worst = 0.0_f64;
        for (&time, &(attitude, _)) in self.times.iter().zip(&self.truth) {
            worst = worst.max(attitude_error(motion.at(time)?.attitude.coords.into(), attitude));
        }
        Ok(worst)
    }
}

fn reference_cases(out: &mut impl Write) -> Result<(), Box<dyn std::error::Error>> {
    const REFERENCE: &str = include_str!("../../data/gravity_gradient.json");
    writeln!(out, "case,n_over_spin,e,paper,moving,full,effect_rad,full_error_rad,bound_rad")?;
    for (case, orbit) in cases(REFERENCE).iter().zip(orbits(REFERENCE)) {
        let body = Body::new(case.moments)?;
        let span = case.states.iter().map(|&(time, ..)| time).fold(0.0, f64::max);
        let scene = Scene::new(body, State::new(0.0, case.attitude, case.angular_velocity)?)
            .span(0.0, span)
            .method(Method::Closed);
        let error = |motion: &Motion| -> Result<f64, Error> {
            case.states.iter().try_fold(0.0_f64, |worst, &(time, reference, _)| {
                Ok(worst.max(attitude_error(motion.at(time)?.attitude.coords.into(), reference)))
            })
        };
        let effect = error(&scene.solve()?)?;
        let solve = |level| scene.clone().orbit(orbit).level(level).averaging(Averaging::Spin).solve();
        let [n, e, ..] = orbit.elements();
        write!(out, "{},{n},{e}", case.name)?;
        for level in [Level::Paper, Level::Moving, Level::Full] {
            write!(out, ",{:.1e}", error(&solve(level)?)? / effect)?;
        }
        let full = solve(Level::Full)?;
        writeln!(out, ",{effect:.2e},{:.2e},{:.2e}", error(&full)?, full.plan().error_bound())?;
    }
    Ok(())
}

fn levels(out: &mut impl Write) -> Result<(), Box<dyn std::error::Error>> {
    writeln!(out, "varied,value,paper,moving,full,effect_rad,full_error_rad,bound_rad")?;
    let base = Setting {
        moments: [1.0 / 1.05, 1.02 / 1.05, 1.0],
        tilt: 0.02,
        azimuth: 0.3,
        inclination: 0.4,
        mean_motion: 2e-3,
        eccentricity: 0.1,
        orbits: 3.0,
    };
    let logarithmic = |from: f64, to: f64, count: usize| -> Vec<f64> {
        (0..count).map(|k| from * (to / from).powf(k as f64 / (count - 1) as f64)).collect()
    };
    let mut series: Vec<(&str, f64, Setting)> = Vec::new();
    series.extend(logarithmic(1e-4, 0.5, 12).into_iter().map(|v| ("J", v, Setting { tilt: v, ..base })));
    series.extend(logarithmic(1e-4, 2e-2, 11).into_iter().map(|v| ("n/spin", v, Setting { mean_motion: v, ..base })));
    series.extend((0..=10).map(|k| 0.05 * f64::from(k)).map(|v| ("e", v, Setting { eccentricity: v, ..base })));
    // A + B is kept.
    series.extend(logarithmic(1e-5, 0.06, 11).into_iter().map(|v| {
        let mean = 1.01 / 1.05;
        ("(B-A)/C", v, Setting { moments: [mean - 0.5 * v, mean + 0.5 * v, 1.0], ..base })
    }));
    for (varied, value, setting) in series {
        let run = setting.run()?;
        let effect = run.error(&run.scene.solve()?)?;
        let solve = |level| run.scene.clone().orbit(run.orbit).level(level).averaging(Averaging::Spin).solve();
        // A resonance has no line.
        if solve(Level::Full).is_err() {
            continue;
        }
        write!(out, "{varied},{value:.6e}")?;
        for level in [Level::Paper, Level::Moving, Level::Full] {
            write!(out, ",{:.3e}", run.error(&solve(level)?)? / effect)?;
        }
        let full = solve(Level::Full)?;
        writeln!(out, ",{effect:.3e},{:.3e},{:.3e}", run.error(&full)?, full.plan().error_bound())?;
    }
    Ok(())
}

fn setting(random: &mut Uniform) -> Setting {
    // A homogeneous ellipsoid, axes ordered.
    let first = random.between(0.4, 1.0);
    let second = random.between(first, 1.0);
    let third = first * second.max(0.3);
    let mut axes = [1.0, second, third];
    axes.sort_by(f64::total_cmp);
    let [short, middle, long] = axes.map(|axis| axis * axis);
    let scale = middle + long;
    Setting {
        moments: [(short + middle) / scale, (short + long) / scale, 1.0],
        tilt: random.between(0.0, 0.3),
        azimuth: random.between(0.0, std::f64::consts::TAU),
        inclination: random.between(0.0, std::f64::consts::PI),
        mean_motion: 10.0_f64.powf(random.between(-3.5, -1.7)),
        eccentricity: random.between(0.0, 0.5),
        orbits: random.between(3.0, 10.0),
    }
}

fn bounds(out: &mut impl Write, count: usize, seed: u64) -> Result<(), Box<dyn std::error::Error>> {
    writeln!(out, "averaging,n,e,J,A,B,ratio,orbits,torque,kappa,error,bound")?;
    let mut random = Uniform(seed);
    for _ in 0..count {
        let setting = setting(&mut random);
        let run = setting.run()?;
        for averaging in [Averaging::Spin, Averaging::Orbit] {
            // A resonance has no line.
            let Ok(motion) = run.scene.clone().orbit(run.orbit).averaging(averaging).solve() else { continue };
            let plan = motion.plan();
            let [a, b, _] = setting.moments;
            let kappa =
                3.0 * setting.mean_motion * (1.0 - 0.5 * (a + b)) / (1.0 - setting.eccentricity.powi(2)).powf(1.5);
            writeln!(
                out,
                "{averaging},{:.3e},{:.3},{:.3},{a:.3},{b:.3},{:.3},{:.1},{:.3e},{kappa:.3e},{:.3e},{:.3e}",
                setting.mean_motion,
                setting.eccentricity,
                setting.tilt,
                plan.separatrix_ratio(),
                setting.orbits,
                plan.torque(),
                run.error(&motion)?,
                plan.error_bound(),
            )?;
        }
    }
    Ok(())
}

fn climbs(out: &mut impl Write, starts: u64, steps: usize, seed: u64) -> Result<(), Box<dyn std::error::Error>> {
    writeln!(out, "family,mode,averaging,starts,solved,error,bound,ratio,scene")?;
    let mut tasks = Vec::new();
    for family in FAMILIES {
        for long_axis in [false, true] {
            for averaging in [Averaging::Spin, Averaging::Orbit] {
                tasks.push((family, long_axis, averaging));
            }
        }
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(tasks.len());
    let run = |&(family, long_axis, averaging): &(_, _, _)| -> Vec<Summit> {
        let climbs = (0..starts).map(|start| climb(family, long_axis, averaging, steps, &mut Uniform(seed + start)));
        climbs.flatten().collect()
    };
    // Results go in the order of the tasks, whatever thread has them.
    let mut summits: Vec<Vec<Summit>> = vec![Vec::new(); tasks.len()];
    std::thread::scope(|scope| {
        let mut handles = Vec::new();
        for thread in 0..threads {
            let (tasks, run) = (&tasks, &run);
            handles.push(scope.spawn(move || -> Vec<(usize, Vec<Summit>)> {
                (thread..tasks.len()).step_by(threads).map(|k| (k, run(&tasks[k]))).collect()
            }));
        }
        for handle in handles {
            for (k, found) in handle.join().unwrap_or_default() {
                summits[k] = found;
            }
        }
    });
    for ((family, long_axis, averaging), found) in tasks.into_iter().zip(summits) {
        let solved: usize = found.iter().map(|summit| summit.solved).sum();
        let Some(worst) = found.into_iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio())) else { continue };
        let mode = if long_axis { "long" } else { "short" };
        let Disturbed { moments, attitude, rates, orbit, span, .. } = worst.scene;
        writeln!(
            out,
            "{},{mode},{averaging},{starts},{solved},{:.3e},{:.3e},{:.3},\"{moments:?} {attitude:?} {rates:?} {orbit:?} {span}\"",
            family.name(),
            worst.measured.error,
            worst.measured.bound,
            worst.ratio(),
        )?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["cases"] => reference_cases(&mut out),
        ["levels"] => levels(&mut out),
        ["climb", starts, steps, seed] => climbs(&mut out, starts.parse()?, steps.parse()?, seed.parse()?),
        ["bounds", count, seed] => bounds(&mut out, count.parse()?, seed.parse()?),
        _ => Err(
            "usage: gradient cases | gradient levels | gradient bounds COUNT SEED | gradient climb STARTS STEPS SEED"
                .into(),
        ),
    }
}
