//! LaTeX: the printed formulas, in canonical order, well formed.

use andoyer_series::print::Part;
use andoyer_series::{Error, NormalForm};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

const PARTS: [(&str, Part); 4] = [
    ("hamiltonian", Part::Hamiltonian),
    ("generator", Part::Generator),
    ("direct", Part::Direct),
    ("inverse", Part::Inverse),
];

#[test]
fn the_lines_are_those_of_the_theory() -> Result<(), Error> {
    let normal_form = NormalForm::new(4)?;
    let hamiltonian = normal_form.to_latex(Part::Hamiltonian)?;
    for line in [
        r"P_{0} &= 2",
        r"P_{1} &= -1",
        r"P_{2} &= -\frac{1}{2}\beta^{2}",
        r"P_{4} &= -\frac{3}{4}\beta^{2} - \frac{9}{32}\beta^{4}",
    ] {
        assert!(hamiltonian.lines().any(|found| found == line), "{line} is not in\n{hamiltonian}");
    }
    let generator = normal_form.to_latex(Part::Generator)?;
    for line in [
        r"\tau^{-1} S_{1} &= \frac{1}{8}\beta{}u^{3}U + \frac{1}{8}\beta{}uU^{3}",
        r"\tau^{-2} S_{2} &= -\frac{1}{4}\mathrm{i}\,\beta{}u^{4}U^{2} - \frac{1}{4}\mathrm{i}\,\beta{}u^{2}U^{4}",
    ] {
        assert!(generator.lines().any(|found| found == line), "{line} is not in\n{generator}");
    }
    let direct = normal_form.to_latex(Part::Direct)?;
    assert!(direct.contains(r"u &= u' + \sum_{n=1}^{4} \tau^n\,u_n"));
    assert!(direct.contains(r"u_{1} &= \frac{1}{8}\beta{}u'^{3} + \frac{3}{8}\beta{}u'U'^{2}"));
    let inverse = normal_form.to_latex(Part::Inverse)?;
    assert!(inverse.contains(r"u_{1} &= -\frac{1}{8}\beta{}u^{3} - \frac{3}{8}\beta{}uU^{2}"));
    assert!(inverse.contains(r"y' &= y + \frac{1}{M}\sum_{n=1}^{4} \tau^n\,y_n"));
    Ok(())
}

#[test]
fn braces_environments_and_alignments_balance() -> Result<(), Error> {
    let normal_form = NormalForm::new(8)?;
    for (name, part) in PARTS {
        assert_eq!(name.parse::<Part>()?, part);
        let text = normal_form.to_latex(part)?;
        let depth = text.chars().try_fold(0_usize, |depth, letter| match letter {
            '{' => Some(depth + 1),
            '}' => depth.checked_sub(1),
            _ => Some(depth),
        });
        assert_eq!(depth, Some(0), "{name}");
        assert_eq!(text.matches(r"\begin{align*}").count(), text.matches(r"\end{align*}").count());
        // Every line of an align* has one alignment mark and all but the last of one end in a line break.
        for block in text.split(r"\begin{align*}").skip(1) {
            let lines: Vec<_> = block.split(r"\end{align*}").next().unwrap_or_default().trim().lines().collect();
            for (position, line) in lines.iter().enumerate() {
                assert_eq!(line.matches('&').count(), 1, "{line}");
                assert_eq!(line.ends_with(r"\\"), position + 1 < lines.len(), "{line}");
            }
        }
    }
    Ok(())
}

#[test]
fn an_empty_normal_form_is_written_too() -> Result<(), Error> {
    assert!(NormalForm::new(0)?.to_latex(Part::Hamiltonian)?.contains("P_{0} &= 2"));
    Ok(())
}

#[test]
fn unknown_parts_are_refused() {
    assert!(matches!("Hamiltonian".parse::<Part>(), Err(Error::NameUnknown { what: "part", .. })));
}

/// The commands of a text, without their backslash; a control symbol such as `\,` is one letter.
fn commands(text: &str) -> BTreeSet<String> {
    let ends = |rest: &str| rest.find(|letter: char| !letter.is_ascii_alphabetic()).unwrap_or(rest.len());
    text.split('\\').skip(1).map(|rest| rest[..ends(rest).max(1).min(rest.len())].to_owned()).collect()
}

#[test]
fn commands_are_those_of_latex_and_amsmath_and_environments_are_align() -> Result<(), Error> {
    let known = "begin end begingroup endgroup allowdisplaybreaks frac sum quad qquad sqrt mathrm Bigl Bigr alpha beta gamma kappa sigma \
                 tau varepsilon [ ] , ";
    let known: BTreeSet<String> = known.split_whitespace().map(str::to_owned).collect();
    for order in [0, 1, 9] {
        for (name, part) in PARTS {
            let text = NormalForm::new(order)?.to_latex(part)?;
            assert!(text.is_ascii(), "{name}");
            // A line break is two backslashes: taken out first.
            let found = commands(&text.replace("\\\\", ""));
            assert!(found.is_subset(&known), "{name}: {:?}", found.difference(&known));
            assert_eq!(text.matches(r"\begin{").count(), text.matches(r"\begin{align*}").count(), "{name}");
            assert!(text.starts_with("\\begingroup\\allowdisplaybreaks\n") && text.ends_with("\\endgroup\n"), "{name}");
        }
    }
    Ok(())
}

#[test]
fn long_series_are_broken_and_short_ones_are_not() -> Result<(), Error> {
    let text = NormalForm::new(10)?.to_latex(Part::Generator)?;
    let block = |name: &str| text.split(r"\end{align*}").find(|block| block.contains(name)).unwrap_or_default();
    assert_eq!(block(r"S_{2} &=").matches(r"\\").count(), 0);
    assert!(block(r"S_{10} &=").matches(r"\\").count() > 10);
    // Two terms of twelve digits and nine factors fill a line.
    assert!(text.lines().all(|line| line.matches(r"\frac").count() <= 5));
    Ok(())
}

/// Without a TeX engine this says so, and fails if `CI` is set; the other tests hold the structure in any case.
#[test]
fn an_article_with_it_compiles_without_an_overfull_line() -> Result<(), Error> {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("latex");
    std::fs::create_dir_all(&directory).expect("a directory for the tests");
    if Command::new("pdflatex").arg("--version").output().is_err() {
        assert!(std::env::var_os("CI").is_none(), "CI needs pdflatex: apt-get install texlive-latex-recommended");
        eprintln!("skipped: no pdflatex on this machine (apt-get install texlive-latex-recommended)");
        return Ok(());
    }
    for order in [2, 10] {
        let normal_form = NormalForm::new(order)?;
        let parts = PARTS.map(|(_, part)| normal_form.to_latex(part));
        let body = parts.into_iter().collect::<Result<String, Error>>()?;
        let name = format!("order{order}");
        let document = format!(
            "\\documentclass{{article}}\n\\usepackage{{amsmath}}\n\\begin{{document}}\n{body}\\end{{document}}\n"
        );
        std::fs::write(directory.join(format!("{name}.tex")), document).expect("a file in the directory of the tests");
        let options = ["-interaction=nonstopmode", "-halt-on-error", &name];
        let output = Command::new("pdflatex").args(options).current_dir(&directory).output().expect("it starts");
        let log = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "order {order}: {log}");
        assert!(!log.contains("Overfull") && !log.contains("Warning"), "order {order}: {log}");
    }
    Ok(())
}
