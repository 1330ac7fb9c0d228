//! What `Motion::to_code` writes is compiled and run, in C, Rust, Python and JavaScript, against the library over 1e9 rotations.

use andoyer_propagate::motion_code::CodeLanguage;
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

const TIMES: usize = 400;
const LANGUAGES: [CodeLanguage; 4] =
    [CodeLanguage::C, CodeLanguage::Rust, CodeLanguage::Python, CodeLanguage::JavaScript];

// Drivers: a time in, attitude and rates out, all numbers as their bits in hexadecimal; a line "none" beyond the bound.
const C_DRIVER: &str = r#"
#include "rotation.c"
#include <stdio.h>
#include <string.h>

static void print(double value, char end)
{
    unsigned long long bits;
    memcpy(&bits, &value, sizeof bits);
    printf("%016llx%c", bits, end);
}

int main(void)
{
    unsigned long long bits;
    while (scanf("%llx", &bits) == 1) {
        double time, attitude[4], rates[3];
        int n;
        memcpy(&time, &bits, sizeof time);
        if (!rotation(time, attitude, rates)) {
            puts("none");
            continue;
        }
        for (n = 0; n < 4; n++)
            print(attitude[n], ' ');
        for (n = 0; n < 3; n++)
            print(rates[n], n == 2 ? '\n' : ' ');
    }
    return 0;
}
"#;
const RUST_DRIVER: &str = r#"
mod rotation;

fn main() {
    for line in std::io::stdin().lines() {
        let time = f64::from_bits(u64::from_str_radix(&line.unwrap(), 16).unwrap());
        match rotation::rotation(time) {
            None => println!("none"),
            Some((attitude, rates)) => {
                let texts: Vec<_> = attitude.iter().chain(&rates).map(|value| format!("{:016x}", value.to_bits())).collect();
                println!("{}", texts.join(" "));
            }
        }
    }
}
"#;
const PYTHON_DRIVER: &str = r#"
import struct
import sys

from rotation import rotation

for line in sys.stdin:
    (time,) = struct.unpack(">d", bytes.fromhex(line))
    try:
        attitude, rates = rotation(time)
    except ValueError:
        print("none")
    else:
        print(*(struct.pack(">d", value).hex() for value in (*attitude, *rates)))
"#;
const JAVASCRIPT_DRIVER: &str = r#"
"use strict";
const { rotation } = require("./rotation.js");
const view = new DataView(new ArrayBuffer(8));
const hex = value => { view.setFloat64(0, value); return view.getBigUint64(0).toString(16).padStart(16, "0"); };
for (const line of require("fs").readFileSync(0, "utf8").trim().split("\n")) {
  view.setBigUint64(0, BigInt("0x" + line));
  try {
    console.log(Array.from(rotation(view.getFloat64(0)), hex).join(" "));
  } catch (error) {
    if (!(error instanceof RangeError)) throw error;
    console.log("none");
  }
}
"#;

fn scene(body: Result<Body, Error>, rates: [f64; 3]) -> Result<Scene, Error> {
    Ok(Scene::new(body?, State::new(12.5, [0.1, -0.7, 0.5, 0.5], rates)?))
}

/// One of every kind that has code.
fn motions() -> Result<Vec<(&'static str, Motion)>, Error> {
    let body = || Body::new([1.0, 1.5, 2.0]);
    let tensor = [[1.4, 0.2, -0.1], [0.2, 1.6, 0.15], [-0.1, 0.15, 1.2]];
    let scenes = [
        ("short-axis", scene(body(), [0.1, 0.2, 1.0])?),
        ("short-axis by the series", scene(body(), [0.1, 0.2, 1.0])?.method(Method::Series)),
        ("long-axis", scene(body(), [1.0, 0.1, -0.2])?),
        ("long-axis by the series", scene(body(), [1.0, 0.1, -0.2])?.method(Method::Series)),
        ("near the separatrix", scene(body(), [0.02, 1.0, 0.05])?),
        (
            "33 harmonics",
            scene(Body::new([1.0, 1.9, 2.0]), [0.1, 1.0, 0.4])?.method(Method::Series).order(40).tolerance(1e-15),
        ),
        ("left-handed, upside down", scene(Body::new([2.0, 3.5, 3.0]), [0.3, -1.0, 0.2])?),
        ("needle", scene(Body::new([1e-3, 1.0, 1.0]), [0.4, 0.1, 0.05])?),
        ("round", scene(Body::new([1.0, 1.0, 2.0]), [0.1, 0.2, 1.0])?),
        ("tensor", scene(Body::from_inertia(tensor), [0.3, 0.5, 1.0])?),
        (
            "steady, tensor",
            scene(Body::from_inertia([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]), [0.3, 0.5, 1.0])?,
        ),
        ("sphere", scene(Body::new([2.0, 2.0, 2.0]), [0.3, 0.5, 1.0])?),
        ("principal axis", scene(body(), [0.0, 0.0, -1.0])?),
        ("at rest", scene(body(), [0.0, 0.0, 0.0])?),
        ("slow, a span and a name", scene(body(), [1e-7, 2e-7, 1e-6])?.span(0.0, 1e9).name("*/ \"\"\" \\ ?")),
        ("fast", scene(body(), [1e304, 2e303, 1e305])?),
    ];
    scenes.into_iter().map(|(name, scene)| Ok((name, scene.solve()?))).collect()
}

/// Times up to 1e9 rotations on both sides of the epoch, at all scales.
fn times(motion: &Motion) -> Vec<f64> {
    let rate = motion.frequencies().longitude;
    let far = if rate > 0.0 { 1e9 * std::f64::consts::TAU / rate } else { 1e12 };
    let golden = 0.618_033_988_749_894_9;
    let time = |k: usize| {
        let part = (k as f64 * golden).fract();
        let scale = [1.0, 1e-3, 1e-9, 1e-12][k % 4];
        motion.scene().state().epoch + far * scale * (2.0 * part - 1.0)
    };
    (0..TIMES).map(time).chain([motion.scene().state().epoch]).collect()
}

fn bits(time: f64) -> String {
    format!("{:016x}\n", time.to_bits())
}

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).expect("a file in the directory of the tests");
}

fn compile(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
}

/// The lines that a program writes for these times.
fn run(mut program: Command, times: &[f64]) -> Vec<String> {
    let mut child = program.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it starts");
    let input: String = times.iter().map(|time| bits(*time)).collect();
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "{program:?}");
    String::from_utf8(output.stdout).expect("text").lines().map(str::to_owned).collect()
}

/// Writes the emitted file and its driver, has them compiled, and returns what runs them.
type Build<'a> = &'a dyn Fn(&Path) -> Command;

fn assert_agrees(language: CodeLanguage, file: &str, build: Build<'_>) {
    for (name, motion) in motions().expect("they are solved") {
        let folder: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        let directory =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join("motion_code").join(format!("{language:?}")).join(folder);
        std::fs::create_dir_all(&directory).expect("a directory to build in");
        let code = motion.code(language).expect("it has code");
        write(&directory.join(file), code.text());
        let mut times = times(&motion);
        let beyond = motion.scene().state().epoch + 1e301;
        times.extend([beyond, -beyond, f64::NAN]);
        let lines = run(build(&directory), &times);
        assert_eq!(lines.len(), times.len(), "{name}");
        assert_eq!(lines[times.len() - 3..], ["none", "none", "none"], "{name}");
        for (time, line) in times.iter().zip(&lines).take(TIMES + 1) {
            assert_near(&motion, (code.attitude_error(), code.rate_error()), *time, line, name);
        }
        assert!(code.attitude_error() < 1e-13 && code.rate_error() < 1e-13, "{name}: {code:?}");
    }
}

fn assert_near(motion: &Motion, (attitude_error, rate_error): (f64, f64), time: f64, line: &str, name: &str) {
    let number = |text: &str| f64::from_bits(u64::from_str_radix(text, 16).expect("bits"));
    let found: [f64; 7] = line.split(' ').map(number).collect::<Vec<_>>().try_into().expect("seven numbers");
    let sample = motion.at(time).expect("a time");
    let expected: [f64; 4] = sample.attitude.coords.into();
    let chord = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let angle = 2.0 * chord(&found[..4], &expected);
    assert!(angle <= attitude_error, "{name} at {time:e}: {angle:e} rad, stated {attitude_error:e}");
    let length = sample.angular_velocity.amax().max(f64::MIN_POSITIVE);
    let rates: [f64; 3] = (sample.angular_velocity / length).into();
    let difference = chord(&[4, 5, 6].map(|n| found[n] / length), &rates);
    assert!(difference <= rate_error, "{name} at {time:e}: {difference:e}, stated {rate_error:e}");
}

#[test]
fn c_gives_the_motion_with_and_without_a_fused_product() {
    // Processors of this architecture have fused products or not; elsewhere the compiler knows.
    let fused: &[&str] = if cfg!(target_arch = "x86_64") { &["-O3", "-march=native"] } else { &["-O3"] };
    for options in [&["-O0"][..], fused] {
        assert_agrees(CodeLanguage::C, "rotation.c", &|directory| {
            write(&directory.join("main.c"), C_DRIVER);
            let program = directory.join("main");
            let strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];
            let main = directory.join("main.c");
            compile(Command::new("cc").args(strict).args(options).arg("-o").args([&program, &main]).arg("-lm"));
            Command::new(program)
        });
    }
}

#[test]
fn c_refuses_arithmetic_that_is_not_that_of_doubles() -> Result<(), Error> {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("motion_code").join("fast");
    std::fs::create_dir_all(&directory).expect("a directory to build in");
    write(&directory.join("rotation.c"), &motions()?[0].1.to_code(CodeLanguage::C)?);
    let output = Command::new("cc")
        .args(["-Ofast", "-c", "-o"])
        .args([directory.join("fast.o"), directory.join("rotation.c")])
        .output()
        .expect("cc");
    assert!(!output.status.success() && String::from_utf8_lossy(&output.stderr).contains("-ffast-math"));
    Ok(())
}

#[test]
fn rust_gives_the_motion_and_needs_core_alone() {
    assert_agrees(CodeLanguage::Rust, "rotation.rs", &|directory| {
        write(&directory.join("main.rs"), RUST_DRIVER);
        let text = std::fs::read_to_string(directory.join("rotation.rs")).expect("it was written");
        write(&directory.join("core.rs"), &format!("#![no_std]\n{text}"));
        let strict = ["--edition", "2024", "-D", "warnings"];
        let rustc = || {
            let mut rustc = Command::new("rustc");
            rustc.args(strict);
            rustc
        };
        let library = directory.join("libcore_alone.rlib");
        compile(rustc().args(["--crate-type", "lib", "-o"]).args([&library, &directory.join("core.rs")]));
        let program = directory.join("main");
        compile(rustc().arg("-o").args([&program, &directory.join("main.rs")]));
        Command::new(program)
    });
}

#[test]
fn python_gives_the_motion() {
    assert_agrees(CodeLanguage::Python, "rotation.py", &|directory| {
        write(&directory.join("main.py"), PYTHON_DRIVER);
        let mut python = Command::new(std::env::var("PYTHON").unwrap_or("python3".to_owned()));
        python.arg("-B").args(["-W", "error"]).arg(directory.join("main.py"));
        python
    });
}

#[test]
fn javascript_gives_the_motion() {
    let node = Command::new("node").arg("--version").output();
    if node.is_err() && std::env::var_os("CI").is_none() {
        eprintln!("skipped: no node on this machine");
        return;
    }
    assert_agrees(CodeLanguage::JavaScript, "rotation.js", &|directory| {
        write(&directory.join("main.js"), JAVASCRIPT_DRIVER);
        let mut node = Command::new("node");
        node.arg(directory.join("main.js"));
        node
    });
}

#[test]
fn sums_are_by_powers_and_where_there_are_many_harmonics_by_these() -> Result<(), Error> {
    for (name, motion) in motions()? {
        let text = motion.to_code(CodeLanguage::Python)?;
        let harmonics = text.contains("by a rotation from each multiple of 2l' to the next");
        assert_eq!(harmonics, name == "33 harmonics", "{name}");
        assert_ne!(harmonics, text.contains("by Horner's rule in cos 2l'"), "{name}");
    }
    Ok(())
}

#[test]
fn the_head_names_scene_mode_interval_and_error_in_ascii() -> Result<(), Error> {
    for (name, motion) in motions()? {
        for language in LANGUAGES {
            let code = motion.code(language)?;
            let text = code.text();
            assert!(
                text.is_ascii() && text.ends_with('\n') && !text.contains("NaN") && !text.contains("inf,"),
                "{name}"
            );
            assert_eq!(text, motion.to_code(language)?, "{name}: twice the same");
            for line in [
                format!("Mode {}", motion.plan().mode()),
                "Valid for |time - 12.5| <= ".to_owned(),
                format!("attitude below {:.1e} rad", 1.05 * code.attitude_error()),
                format!("Error bound of the library over the span: {:.1e} rad", motion.plan().error_bound()),
            ] {
                assert!(text.contains(&line), "{line} is not in the head of {name}\n{text}");
            }
        }
    }
    Ok(())
}

#[test]
fn passages_and_disturbed_motions_are_refused_with_what_is_served() -> Result<(), Error> {
    let body = || Body::new([1.0, 1.5, 2.0]);
    let passage = scene(body(), [1e-9, 1.0, 1e-9])?.solve()?;
    let orbit = Orbit::new(1e-3, 0.1)?;
    let disturbed = scene(body(), [0.01, 0.02, 1.0])?.orbit(orbit).tolerance(1e-3).span(0.0, 1e3).solve()?;
    for (motion, words) in [(passage, "a passage along the separatrix"), (disturbed, "a motion under a torque")] {
        let error = motion.to_code(CodeLanguage::C).expect_err("no code");
        assert_eq!(error, Error::NoCode { motion: words });
        assert_eq!(error.kind(), andoyer_propagate::error::Kind::Representation);
        assert!(error.to_string().contains("torque-free wobbles of both modes have code"));
    }
    for name in ["", "C", "fortran"] {
        let refused = name.parse::<CodeLanguage>();
        assert_eq!(refused, Err(Error::CodeLanguage { value: name.to_owned() }));
    }
    Ok(())
}
