//! How long each id is measured.

use std::time::Duration;

use criterion::Criterion;

/// Short measurements: some hundred ids, a second each. Their medians repeat within a few per cent on a quiet machine.
pub(crate) fn short() -> Criterion {
    Criterion::default().warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_millis(600))
}
