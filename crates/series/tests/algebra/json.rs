//! JSON: what is written is read back, and what is malformed is refused with its reason.

use andoyer_series::error::{Kind, TermProblem};
use andoyer_series::rigid_body::Variable;
use andoyer_series::{Error, NormalForm};

#[test]
fn what_is_written_is_read_back_to_the_last_digit() -> Result<(), Error> {
    for order in [0, 1, 7] {
        let normal_form = NormalForm::new(order)?;
        let read = NormalForm::from_json(&normal_form.to_json()?)?;
        assert_eq!(read, normal_form);
        assert_eq!(read.to_json()?, normal_form.to_json()?);
        if order > 0 {
            assert_eq!(read.direct(Variable::Coordinate, order)?, normal_form.direct(Variable::Coordinate, order)?);
        }
    }
    Ok(())
}

#[test]
fn the_format_of_version_1_does_not_change() -> Result<(), Error> {
    let expected = concat!(
        r#"{"format":"andoyer-normal-form","version":1,"order":1,"triaxiality":[[[0,"2"]],[[0,"-1"]]],"#,
        r#""generators":[[[1,3,1,"1/8","0"],[3,1,1,"1/8","0"]]]}"#
    );
    assert_eq!(NormalForm::new(1)?.to_json()?, expected);
    Ok(())
}

fn document(order: &str, triaxiality: &str, generators: &str) -> Result<NormalForm, Error> {
    NormalForm::from_json(&format!(
        r#"{{"format":"andoyer-normal-form","version":1,"order":{order},"triaxiality":{triaxiality},"generators":{generators}}}"#
    ))
}

const P: &str = r#"[[[0,"2"]],[[0,"-1"]]]"#;
const S: &str = r#"[[[1,3,1,"1/8","0"],[3,1,1,"1/8","0"]]]"#;

#[test]
fn what_is_not_json_or_has_another_shape_is_refused() {
    assert!(document("1", P, S).is_ok());
    for text in [
        "",
        "[]",
        "{",
        "null",
        r#"{"format":"andoyer-normal-form"}"#,
        r#"{"format":"andoyer-normal-form","version":1}"#,
    ] {
        assert!(matches!(NormalForm::from_json(text), Err(Error::Json { .. })), "{text}");
    }
    assert!(matches!(document("-1", P, S), Err(Error::Json { .. })));
    assert!(matches!(document("1", "{}", S), Err(Error::Json { .. })));
    assert!(matches!(document("1", r#"[[[0,2]],[]]"#, S), Err(Error::Json { .. })));
    assert!(matches!(document("1", P, r#"[[[1,3,"1/8","0"]]]"#), Err(Error::Json { .. })));
    assert!(matches!(document("1,\"extra\":0", P, S), Err(Error::Json { .. })));
    let nested = "[".repeat(100_000);
    assert!(matches!(NormalForm::from_json(&nested), Err(Error::Json { .. })));
}

#[test]
fn other_formats_and_versions_are_refused() {
    for (format, version) in [("andoyer-normal-form", 2), ("andoyer-normal-form", 0), ("something-else", 1)] {
        let text = format!(r#"{{"format":"{format}","version":{version}}}"#);
        let refused = NormalForm::from_json(&text);
        assert!(matches!(refused, Err(Error::FormatUnknown { version: found, .. }) if found == version), "{text}");
    }
}

#[test]
fn orders_that_do_not_fit_or_do_not_match_are_refused() {
    assert!(matches!(document("18446744073709551615", P, S), Err(Error::OrderTooLarge { .. })));
    assert!(matches!(document("16382", P, S), Err(Error::OrderTooLarge { order: 16382, bound: 16381 })));
    let refused = document("2", P, S);
    assert!(matches!(refused, Err(Error::CountMismatch { what: "triaxiality", found: 2, expected: 3 })));
    let refused = document("1", P, "[]");
    assert!(matches!(refused, Err(Error::CountMismatch { what: "generators", found: 0, expected: 1 })));
    let refused = refused.expect_err("no generator");
    assert_eq!((refused.kind(), refused.argument()), (Kind::File, Some("text")));
}

#[test]
fn rationals_that_are_not_reduced_are_refused() {
    let long = "9".repeat(70_000);
    for bad in ["", "2/1", "-2/4", "1/0", "1/-2", "0.5", "+1", " 1", "1/", "x", "1e3", "01", &long] {
        let refused = document("1", &format!(r#"[[[0,"{bad}"]],[[0,"-1"]]]"#), S);
        assert!(matches!(refused, Err(Error::RationalMalformed { ref text }) if text == bad), "{bad:.20}: {refused:?}");
    }
}

#[track_caller]
fn assert_inconsistent(triaxiality: &str, generators: &str, exponents: &[u32], problem: TermProblem) {
    match document("1", triaxiality, generators) {
        Err(Error::TermInconsistent { exponents: at, problem: found, .. }) => {
            assert_eq!((&at[..], found), (exponents, problem))
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn terms_that_no_normal_form_contains_are_refused() {
    assert_inconsistent(r#"[[[0,"2"]],[[2,"1"]]]"#, S, &[2], TermProblem::Degree);
    assert_inconsistent(r#"[[[0,"2"]],[[1,"1"]]]"#, S, &[1], TermProblem::Degree); // odd in β
    assert_inconsistent(r#"[[[0,"0"]],[]]"#, S, &[0], TermProblem::Zero);
    assert_inconsistent(r#"[[[0,"1"],[0,"1"]],[]]"#, S, &[0], TermProblem::Repeated);
    assert_inconsistent(P, r#"[[[1,2,1,"1","0"]]]"#, &[1, 2, 1], TermProblem::Degree);
    assert_inconsistent(P, r#"[[[4294967295,4294967295,1,"1","0"]]]"#, &[u32::MAX, u32::MAX, 1], TermProblem::Degree);
    assert_inconsistent(P, r#"[[[1,3,2,"1","0"]]]"#, &[1, 3, 2], TermProblem::Degree);
    assert_inconsistent(P, r#"[[[2,2,1,"1","0"]]]"#, &[2, 2, 1], TermProblem::Kernel);
    assert_inconsistent(P, r#"[[[1,3,1,"0","0"]]]"#, &[1, 3, 1], TermProblem::Zero);
    assert_inconsistent(P, r#"[[[1,3,0,"1","0"]]]"#, &[1, 3, 0], TermProblem::Harmonic);
    assert_inconsistent(P, r#"[[[0,4,1,"1","0"]]]"#, &[0, 4, 1], TermProblem::Harmonic);
    assert_inconsistent(P, r#"[[[1,3,1,"1","0"],[1,3,1,"1","0"]]]"#, &[1, 3, 1], TermProblem::Repeated);
    assert_inconsistent(P, r#"[[[1,3,1,"0","1"]]]"#, &[1, 3, 1], TermProblem::NotReal);
    assert_inconsistent(P, r#"[[[1,3,1,"1/8","0"],[3,1,1,"-1/8","0"]]]"#, &[1, 3, 1], TermProblem::NotReal);
}

#[test]
fn every_field_that_is_missing_twice_there_or_of_another_type_is_refused() {
    let fields = [
        ("format", r#""andoyer-normal-form""#),
        ("version", "1"),
        ("order", "1"),
        ("triaxiality", P),
        ("generators", S),
    ];
    let written = |fields: &[(&str, &str)]| {
        let pairs: Vec<String> = fields.iter().map(|(name, value)| format!("\"{name}\":{value}")).collect();
        NormalForm::from_json(&format!("{{{}}}", pairs.join(",")))
    };
    assert!(written(&fields).is_ok());
    for at in 0..fields.len() {
        let mut spoilt = fields.to_vec();
        spoilt.remove(at);
        assert!(matches!(written(&spoilt), Err(Error::Json { .. })), "without {}", fields[at].0);
        spoilt.insert(at, fields[at]);
        spoilt.push(fields[at]);
        assert!(matches!(written(&spoilt), Err(Error::Json { .. })), "{} twice", fields[at].0);
        spoilt.pop();
        for wrong in
            ["null", "true", "-1", "1.5", "1e400", "{}", "[1]", "[[1]]", "[[[\"1\"]]]", "[[[-1,\"1\"]]]", "NaN"]
        {
            spoilt[at].1 = wrong;
            assert!(matches!(written(&spoilt), Err(Error::Json { .. })), "{}: {wrong}", fields[at].0);
        }
    }
}

#[test]
fn exponents_are_whole_numbers_that_are_not_negative_and_fit() {
    for bad in ["-2", "0.5", "4294967296", "\"0\"", "null"] {
        let refused = document("1", &format!(r#"[[[{bad},"2"]],[[0,"-1"]]]"#), S);
        assert!(matches!(refused, Err(Error::Json { .. })), "β^{bad}: {refused:?}");
        for [j, k, l] in [[bad, "3", "1"], ["1", bad, "1"], ["1", "3", bad]] {
            let refused = document("1", P, &format!(r#"[[[{j},{k},{l},"1/8","0"]]]"#));
            assert!(matches!(refused, Err(Error::Json { .. })), "({j}, {k}, {l}): {refused:?}");
        }
    }
    for text in [r#"{"order":1"#, "1 1", &format!("{} ", r#"{"format":"#)] {
        assert!(matches!(NormalForm::from_json(text), Err(Error::Json { .. })), "{text}");
    }
}

#[test]
fn rationals_of_generators_are_checked_as_those_of_the_kernel_are() {
    for bad in ["2/16", "1/0", "0/0", "1/-8", "-0", "0.125", "NaN", "1/8/1"] {
        for pair in [format!(r#""{bad}","0""#), format!(r#""0","{bad}""#)] {
            let refused = document("1", P, &format!("[[[1,3,1,{pair}]]]"));
            assert!(
                matches!(refused, Err(Error::RationalMalformed { ref text }) if text == bad),
                "{pair}: {refused:?}"
            );
        }
    }
}

#[test]
fn an_order_that_is_only_claimed_costs_nothing() {
    let refused = document("16381", P, S);
    assert!(matches!(refused, Err(Error::CountMismatch { what: "triaxiality", found: 2, expected: 16382 })));
    let refused = document("18446744073709551616", P, S); // beyond 64 bits
    assert!(matches!(refused, Err(Error::Json { .. })));
}

#[test]
fn order_50_is_written_and_read() -> Result<(), Error> {
    // P_n and the generators are what is written, and what is computed again to verify them; nothing else is.
    let normal_form = NormalForm::new(50)?;
    assert_eq!(NormalForm::from_json(&normal_form.to_json()?)?, normal_form);
    Ok(())
}

/// The document of order 4 with one text replaced by another.
fn tampered(from: &str, to: &str) -> Result<NormalForm, Error> {
    let text = NormalForm::new(4)?.to_json()?;
    assert_eq!(text.matches(from).count(), 1, "{from} in {text}");
    NormalForm::from_json(&text.replace(from, to))
}

#[test]
fn a_coefficient_that_is_not_that_of_the_rigid_body_is_refused_with_its_order() {
    // P_2 = −¾β² with the right generators was accepted, and was then two different normal forms.
    match tampered(r#"[[2,"-1/2"]]"#, r#"[[2,"-3/4"]]"#) {
        Err(error @ Error::CoefficientWrong { what: "triaxiality polynomial", order: 2, .. }) => assert_eq!(
            error.to_string(),
            "the triaxiality polynomial of order 2 has the coefficient -3/4 at the exponents [2]: it must be -1/2"
        ),
        other => panic!("{other:?}"),
    }
    // S_2 = β(u² + U²) (−i/4) u²U²: both terms, so that it stays real.
    match tampered(r#"[[2,4,1,"0","-1/4"],[4,2,1,"0","-1/4"]]"#, r#"[[2,4,1,"0","-1/2"],[4,2,1,"0","-1/2"]]"#) {
        Err(Error::CoefficientWrong { what: "generating function", order: 2, exponents, found, expected }) => {
            assert_eq!((&exponents[..], &found[..], &expected[..]), (&[2, 4, 1][..], "0-1/2i", "0-1/4i"));
        }
        other => panic!("{other:?}"),
    }
    assert!(matches!(
        tampered(r#"[[2,"-5/8"]]"#, "[]"),
        Err(Error::CoefficientWrong { order: 3, found, expected, .. }) if (&found[..], &expected[..]) == ("0", "-5/8")
    ));
    assert!(matches!(document("1", r#"[[[0,"3"]],[[0,"-1"]]]"#, S), Err(Error::CoefficientWrong { order: 0, .. })));
}

#[test]
fn a_document_without_terms_ends_at_its_first_order() {
    let lists = |count: usize| vec!["[]"; count].join(",");
    let refused = document("16381", &format!("[{}]", lists(16382)), &format!("[{}]", lists(16381)));
    assert!(matches!(refused, Err(Error::CoefficientWrong { order: 0, .. })));
    let claimed = format!(r#"[[[0,"2"]],[[0,"-1"]],{}]"#, lists(16380));
    let refused = document("16381", &claimed, &format!("[{},{}]", &S[1..S.len() - 1], lists(16380)));
    assert!(matches!(refused, Err(Error::CoefficientWrong { order: 2, .. })), "{refused:?}");
}
