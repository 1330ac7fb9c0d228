//! LaTeX: the printed formulas, in canonical order, well formed.

use andoyer_series::{Error, NormalForm, Part};

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
