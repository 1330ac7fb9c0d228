//! Any text as the JSON of a normal form: an error, or a form that is written and read back to itself.
#![no_main]

use andoyer_series::NormalForm;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(form) = NormalForm::from_json(text) {
        let written = form.to_json().expect("a form that was read");
        assert_eq!(NormalForm::from_json(&written).expect("what was written"), form);
        if form.order() <= 6 {
            for n in 1..=form.order() {
                form.triaxiality_polynomial(n).expect("an order of the form");
            }
        }
    }
});
