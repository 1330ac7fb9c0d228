//! Figures of the gravity-gradient theory against an integration of the full equations, as CSV on standard output.
//!
//! `cases`: the share of the torque's effect on the attitude that each level leaves in the reference cases. `levels`: the share of the torque's effect on the
//! attitude that each level leaves, against J, n/spin, e and B − A, one of them varied at a time. `climb STARTS STEPS SEED [FAMILY]`: the largest error over its bound
//! that hill climbing finds, by family, mode and averaging. `bounds N SEED`: the error of N random scenes and the bound that the plan states, for both
//! averagings and for second order, and what the integration loses of the free motion over the span. `table N SEED`: by n/spin and e, how many of N random
//! scenes are served, the share of the torque's effect that is left, and the bound over the error. `safety N SEED [FAMILY]`: errors and estimates of N random scenes of all
//! families and of the table, by each theory. `attitudes N SEED`: attitudes of such scenes with all their digits; `compare BEFORE AFTER`: how far two such files of
//! two versions of the code differ, for a change that should not change results.

use std::f64::consts::TAU;
use std::io::{self, Write};

use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};
use andoyer_tests::climb::{FAMILIES, FURTHER_FAMILIES, Summit, THEORIES, Uniform, climb};
use andoyer_tests::disturbed::{Disturbed, Measured};
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
    /// Largest error of the same integration of the free motion.
    lost: f64,
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
        let free = Problem { moments: self.moments, orbit: None }.integrate(0.0, attitude, rates, &times);
        let mut run = Run { scene, orbit, times, truth: free, lost: 0.0 };
        run.lost = run.error(&run.scene.clone().tolerance(1e-15).solve()?)?;
        Ok(Run { truth, ..run })
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
    writeln!(
        out,
        "case,n_over_spin,e,paper,moving,full,second_order,effect_rad,full_error_rad,bound_rad,second_error_rad,second_bound_rad"
    )?;
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
        for level in [Level::Paper, Level::Moving, Level::Full, Level::SecondOrder] {
            write!(out, ",{:.1e}", error(&solve(level)?)? / effect)?;
        }
        write!(out, ",{effect:.2e}")?;
        for level in [Level::Full, Level::SecondOrder] {
            let motion = solve(level)?;
            write!(out, ",{:.2e},{:.2e}", error(&motion)?, motion.plan().error_bound())?;
        }
        writeln!(out)?;
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
    writeln!(out, "averaging,level,n,e,J,A,B,ratio,orbits,torque,kappa,error,bound,lost")?;
    let mut random = Uniform(seed);
    for _ in 0..count {
        let setting = setting(&mut random);
        let run = setting.run()?;
        for (averaging, level) in THEORIES {
            // A resonance has no line.
            let scene = run.scene.clone().orbit(run.orbit).averaging(averaging).level(level);
            let Ok(motion) = scene.solve() else { continue };
            let plan = motion.plan();
            let [a, b, _] = setting.moments;
            let kappa =
                3.0 * setting.mean_motion * (1.0 - 0.5 * (a + b)) / (1.0 - setting.eccentricity.powi(2)).powf(1.5);
            writeln!(
                out,
                "{averaging},{level},{:.3e},{:.3},{:.3},{a:.3},{b:.3},{:.3},{:.1},{:.3e},{kappa:.3e},{:.3e},{:.3e},{:.1e}",
                setting.mean_motion,
                setting.eccentricity,
                setting.tilt,
                plan.separatrix_ratio(),
                setting.orbits,
                plan.torque(),
                run.error(&motion)?,
                plan.error_bound(),
                run.lost,
            )?;
        }
    }
    Ok(())
}

fn climbs(
    out: &mut impl Write,
    (starts, steps, seed): (u64, usize, u64),
    only: Option<&str>,
) -> Result<(), Box<dyn std::error::Error>> {
    writeln!(out, "family,mode,averaging,level,starts,solved,error,bound,ratio,scene")?;
    let mut tasks = Vec::new();
    for family in FAMILIES.into_iter().chain(FURTHER_FAMILIES) {
        for long_axis in [false, true] {
            for &theory in family.theories() {
                tasks.push((family, long_axis, theory));
            }
        }
    }
    tasks.retain(|(family, ..)| only.is_none_or(|name| name == family.name()));
    if tasks.is_empty() {
        return Err("an unknown family".into());
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(tasks.len());
    let run = |&(family, long_axis, theory): &(_, _, _)| -> Vec<Summit> {
        let climbs = (0..starts).map(|start| climb(family, long_axis, theory, steps, &mut Uniform(seed + start)));
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
    for ((family, long_axis, (averaging, level)), found) in tasks.into_iter().zip(summits) {
        let solved: usize = found.iter().map(|summit| summit.solved).sum();
        let Some(worst) = found.into_iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio())) else { continue };
        let mode = if long_axis { "long" } else { "short" };
        let Disturbed { moments, attitude, rates, orbit, attraction, secular, further, from, span, tolerance, .. } =
            worst.scene;
        writeln!(
            out,
            "{},{mode},{averaging},{level},{starts},{solved},{:.3e},{:.3e},{:.3},\"{moments:?} {attitude:?} {rates:?} {orbit:?} {attraction} {secular:?} {further:?} {from} {span} {tolerance}\"",
            family.name(),
            worst.measured.error,
            worst.measured.bound,
            worst.ratio(),
        )?;
    }
    Ok(())
}

/// n/spin of a table.
const MEAN_MOTIONS: [f64; 6] = [1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];
/// Eccentricities of a table.
const ECCENTRICITIES: [f64; 4] = [0.0, 0.3, 0.6, 0.9];
/// Rotations that a scene of a table spans.
const ROTATIONS: f64 = 200.0;

/// What is accepted and what it is worth, by n/spin and e: random ellipsoids with J up to 0.5 over some rotations, tolerance 1e-8.
fn table(out: &mut impl Write, count: usize, seed: u64) -> Result<(), Box<dyn std::error::Error>> {
    writeln!(
        out,
        "level,n,e,scenes,accepted,median_share,median_bound_over_error,q90_bound_over_error,least_bound_over_error"
    )?;
    for mean_motion in MEAN_MOTIONS {
        for eccentricity in ECCENTRICITIES {
            let mut random = Uniform(seed);
            let mut measured = [Vec::new(), Vec::new()];
            for _ in 0..count {
                let scene = tabled(&mut random, mean_motion, eccentricity);
                for (found, level) in measured.iter_mut().zip([Level::Full, Level::SecondOrder]) {
                    found.extend(Disturbed { level, ..scene }.measured());
                }
            }
            for (found, level) in measured.iter().zip([Level::Full, Level::SecondOrder]) {
                let sorted = |part: fn(&Measured) -> f64| -> Vec<f64> {
                    let mut values: Vec<f64> = found.iter().map(part).collect();
                    values.sort_by(f64::total_cmp);
                    values
                };
                let shares = sorted(|m| m.error / m.effect);
                let ratios = sorted(|m| m.bound / m.error.max(1e-12));
                writeln!(
                    out,
                    "{level},{mean_motion},{eccentricity},{count},{},{:.1e},{:.1e},{:.1e},{:.1e}",
                    found.len(),
                    quantile(&shares, 0.5),
                    quantile(&ratios, 0.5),
                    quantile(&ratios, 0.9),
                    quantile(&ratios, 0.0),
                )?;
            }
        }
    }
    Ok(())
}

/// A quantile of sorted values.
fn quantile(values: &[f64], part: f64) -> f64 {
    let place = (part * values.len() as f64) as usize;
    values.get(place.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

/// A scene of a table.
fn tabled(random: &mut Uniform, mean_motion: f64, eccentricity: f64) -> Disturbed {
    let Setting { moments, azimuth, inclination, .. } = setting(random);
    let (sine, cosine) = random.between(0.0, 0.5).sin_cos();
    let [a, b, c] = moments;
    let rates = [c / a * sine * azimuth.sin(), c / b * sine * azimuth.cos(), cosine];
    let (half_sine, half_cosine) = (0.5 * inclination).sin_cos();
    let pericentre = random.between(-0.5, 0.5) * TAU / mean_motion;
    let orbit = [mean_motion, eccentricity, pericentre, 0.0, 0.0, random.between(0.0, TAU)];
    let scene = Disturbed::new(moments, [half_sine, 0.0, 0.0, half_cosine], rates, orbit, ROTATIONS * TAU);
    Disturbed { averaging: Averaging::Spin, ..scene }
}

/// Calls `each` with random scenes of all families and of the table, or of one family: its name, whether the mode is the long-axis mode, and the scene.
fn random_scenes(
    (count, seed): (usize, u64),
    only: Option<&str>,
    mut each: impl FnMut(&str, bool, &Disturbed) -> io::Result<()>,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut families: Vec<_> = FAMILIES.into_iter().chain(FURTHER_FAMILIES).collect();
    families.retain(|family| only.is_none_or(|name| name == family.name()));
    if families.is_empty() {
        return Err("an unknown family".into());
    }
    let mut random = Uniform(seed);
    for k in 0..count {
        let long_axis = random.draw() < 0.5;
        // Every other scene is one of the table.
        let family = (only.is_some() || k % 2 == 0).then(|| families[k / 2 % families.len()]);
        let theories = family.map_or(&THEORIES[..], |family| family.theories());
        let [mean_motion, eccentricity] =
            [10.0_f64.powf(random.between(-3.5, -0.9)), random.between(-0.2, 0.95).max(0.0)];
        let table = tabled(&mut random, mean_motion, eccentricity);
        let draws = random.clone();
        for &theory in theories {
            let (averaging, level) = theory;
            let (name, scene) = match family {
                Some(family) => (family.name(), family.random(long_axis, theory, &mut draws.clone())),
                None => ("table", Disturbed { averaging, level, ..table }),
            };
            each(name, long_axis, &scene)?;
        }
        for _ in 0..20 {
            random.draw();
        }
    }
    Ok(())
}

/// Errors and estimates of random scenes.
fn safety(out: &mut impl Write, numbers: (usize, u64), only: Option<&str>) -> Result<(), Box<dyn std::error::Error>> {
    writeln!(out, "family,mode,averaging,level,n,e,error,bound,effect,lost,scene")?;
    random_scenes(numbers, only, |name, long_axis, scene| {
        let Ok(measured) = scene.measured() else { return Ok(()) };
        let Measured { error, bound, effect, lost } = measured;
        let Disturbed { moments, attitude, rates, orbit, attraction, span, averaging, level, .. } = scene;
        writeln!(
            out,
            "{name},{},{averaging},{level},{:.2e},{:.3},{error:.3e},{bound:.3e},{effect:.2e},{lost:.1e},\"{moments:?} {attitude:?} {rates:?} {orbit:?} {attraction} {span}\"",
            if long_axis { "long" } else { "short" },
            orbit[0],
            orbit[1],
        )
    })
}

/// Attitudes of random scenes with all their digits, for `compare`.
fn attitudes(out: &mut impl Write, numbers: (usize, u64)) -> Result<(), Box<dyn std::error::Error>> {
    random_scenes(numbers, None, |name, _, scene| {
        let span = scene.span;
        let solved = scene.solve().and_then(|motion| {
            let at = |k: u32| motion.at(span * f64::from(k) / 8.0).map(|sample| sample.attitude.coords);
            Ok((motion.plan().error_bound(), (0..=8).map(at).collect::<Result<Vec<_>, _>>()?))
        });
        match solved {
            Ok((bound, attitudes)) => {
                let numbers = attitudes.iter().flat_map(|q| q.iter()).map(|x| format!("{x:e}"));
                writeln!(out, "{name},{},{bound:e},{}", scene.level, numbers.collect::<Vec<_>>().join(","))
            }
            Err(error) => writeln!(out, "{name},{},{error}", scene.level),
        }
    })
}

/// Compares two files of `attitudes`: of versions that should differ by rounding alone.
fn compare(out: &mut impl Write, [one, other]: [&str; 2]) -> Result<(), Box<dyn std::error::Error>> {
    let [one, other] = [std::fs::read_to_string(one)?, std::fs::read_to_string(other)?];
    let (mut shares, mut larger, mut refused, mut worst) = (Vec::new(), Vec::new(), 0, (0.0_f64, String::new()));
    for (one, other) in one.lines().zip(other.lines()) {
        let [before, after] = [one, other].map(|line| line.splitn(4, ',').collect::<Vec<_>>());
        if before.len() < 4 || after.len() < 4 || before[2].parse::<f64>().is_err() || after[2].parse::<f64>().is_err()
        {
            refused += usize::from(before != after);
            continue;
        }
        let bounds: [f64; 2] = [before[2].parse()?, after[2].parse()?];
        let numbers = |text: &str| text.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>();
        let (before, after) = (numbers(before[3])?, numbers(after[3])?);
        let angle = before.chunks(4).zip(after.chunks(4)).map(|(p, q)| {
            let distance = |sign: f64| p.iter().zip(q).map(|(p, q)| (p - sign * q).powi(2)).sum::<f64>().sqrt();
            2.0 * distance(1.0).min(distance(-1.0))
        });
        let angle = angle.fold(0.0, f64::max);
        shares.push(angle);
        larger.push(bounds[1] / bounds[0]);
        if angle / bounds[0] > worst.0 {
            worst = (angle / bounds[0], one.chars().take(60).collect());
        }
    }
    shares.sort_by(f64::total_cmp);
    larger.sort_by(f64::total_cmp);
    writeln!(
        out,
        "{} scenes; angle [rad]: median {:.1e}, 99 % {:.1e}, largest {:.1e}; largest angle over the bound {:.1e} ({}); bound after over before: least {:.9}, \
         largest {:.9}; refused by one alone or with another sentence: {refused}",
        shares.len(),
        quantile(&shares, 0.5),
        quantile(&shares, 0.99),
        quantile(&shares, 1.0),
        worst.0,
        worst.1,
        quantile(&larger, 0.0),
        quantile(&larger, 1.0),
    )?;
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["cases"] => reference_cases(&mut out),
        ["levels"] => levels(&mut out),
        ["safety", count, seed] => safety(&mut out, (count.parse()?, seed.parse()?), None),
        ["safety", count, seed, family] => safety(&mut out, (count.parse()?, seed.parse()?), Some(family)),
        ["attitudes", count, seed] => attitudes(&mut out, (count.parse()?, seed.parse()?)),
        ["compare", one, other] => compare(&mut out, [one, other]),
        ["climb", starts, steps, seed] => climbs(&mut out, (starts.parse()?, steps.parse()?, seed.parse()?), None),
        ["climb", starts, steps, seed, family] => {
            climbs(&mut out, (starts.parse()?, steps.parse()?, seed.parse()?), Some(family))
        }
        ["table", count, seed] => table(&mut out, count.parse()?, seed.parse()?),
        ["bounds", count, seed] => bounds(&mut out, count.parse()?, seed.parse()?),
        _ => Err(
            "usage: gradient cases | gradient levels | gradient safety COUNT SEED [FAMILY] | gradient attitudes COUNT SEED | gradient compare FILE FILE | gradient bounds COUNT SEED | gradient table COUNT SEED | gradient climb STARTS STEPS SEED [FAMILY]"
                .into(),
        ),
    }
}
