
const MOTION: Motion<'static> = Motion {
    epoch: EPOCH,
    bound: BOUND,
    anomaly: ANOMALY,
    half_longitude: HALF_LONGITUDE,
    terms: &TERMS,
    attitude: ATTITUDE,
    rates: RATES,
};

/// Attitude [x, y, z, w] and angular velocity in body components at a time; `None` beyond the bound.
#[must_use]
pub fn rotation(time: f64) -> Option<([f64; 4], [f64; 3])> {
    evaluate(&MOTION, time)
}
