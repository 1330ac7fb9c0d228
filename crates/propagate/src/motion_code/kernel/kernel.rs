
/// The constants of one motion.
struct Motion<'a> {
    epoch: f64,
    /// Largest distance from the epoch.
    bound: f64,
    /// l' and y'/2: turns per unit of time as three doubles, the first two of 27 bits at most; turns at the epoch as two.
    anomaly: [f64; 5],
    half_longitude: [f64; 5],
    /// Coefficients of Re a, Im a, Re b and Im b.
    terms: &'a [[f64; 4]],
    /// Rows x, y, z, w; columns Re b, Im b, Im a, Re a.
    attitude: [[f64; 4]; 4],
    /// Angular velocity of each component of the unit angular momentum.
    rates: [[f64; 3]; 3],
}

/// Attitude and angular velocity; nothing beyond the bound.
fn evaluate(motion: &Motion<'_>, time: f64) -> Option<([f64; 4], [f64; 3])> {
    let high = time - motion.epoch;
    if !(high >= -motion.bound && high <= motion.bound) {
        return None;
    }
    // The rounding error of the difference (Knuth).
    let virtual_epoch = time - high;
    let elapsed = [high, (time - (high + virtual_epoch)) + (virtual_epoch - motion.epoch)];
    let (sine, cosine) = circle(&motion.anomaly, elapsed);
    let [ar, ai, br, bi] = pair(motion.terms, sine, cosine);
    let (upper, lower) = (ar * ar + ai * ai, br * br + bi * bi);
    let norm = upper + lower;
    let momentum = [
        2.0 * (br * ai - bi * ar) / norm,
        2.0 * (br * ar + bi * ai) / norm,
        (upper - lower) / norm,
    ];
    let (sine, cosine) = circle(&motion.half_longitude, elapsed);
    let root = square_root(norm);
    let (sine, cosine) = (sine / root, cosine / root);
    let relative = [
        br * cosine - bi * sine,
        br * sine + bi * cosine,
        ar * sine + ai * cosine,
        ar * cosine - ai * sine,
    ];
    let (mut attitude, mut rates) = ([0.0; 4], [0.0; 3]);
    for (value, row) in attitude.iter_mut().zip(&motion.attitude) {
        *value = row[0] * relative[0] + row[1] * relative[1] + row[2] * relative[2] + row[3] * relative[3];
    }
    for (value, row) in rates.iter_mut().zip(&motion.rates) {
        *value = row[0] * momentum[0] + row[1] * momentum[1] + row[2] * momentum[2];
    }
    Some((attitude, rates))
}

/// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer.
fn nearest(x: f64) -> f64 {
    (x + 6755399441055744.0) - 6755399441055744.0
}

/// Sine and cosine of a phase. Only the reduction in turns is to 32 digits; it is exact where numbers cancel.
fn circle(phase: &[f64; 5], elapsed: [f64; 2]) -> (f64, f64) {
    // The time in two halves (Veltkamp), and the rounding error of the product (Dekker).
    let scaled = 134217729.0 * elapsed[0];
    let upper = scaled - (scaled - elapsed[0]);
    let lower = elapsed[0] - upper;
    let [first, second, third, start, start_low] = *phase;
    let product = (first + second) * elapsed[0];
    let error = ((first * upper - product) + first * lower + second * upper) + second * lower;
    let rest = (first + second) * elapsed[1] + (third * elapsed[0] + (error + start_low));
    let fraction = product - nearest(product);
    let quarters = nearest(4.0 * (start + (fraction + rest)));
    let x = ((start - 0.25 * quarters) + fraction) + rest;
    // Minimax polynomials for |x| <= 1/8.
    let s = x * x;
    let sine = ((((3.7794529249619515 * s - 15.093736267536418) * s + 42.05868379747909) * s
        - 76.70585969420165) * s + 81.60524927591186) * s - 41.3417022403996;
    let sine = x * 6.283185307179586 + x * (s * sine + 2.4492935982947064e-16);
    let cosine = (((((-1.6862683429441374 * s + 7.902528501565459) * s - 26.42623923109041) * s
        + 60.244641210418315) * s - 85.45681720592083) * s + 64.93939402266658) * s - 19.739208802178716;
    let cosine = 1.0 + s * cosine;
    match quarters as i32 & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The square root of a number near 1: Heron's rule from a seed that is right to 6 per cent.
fn square_root(x: f64) -> f64 {
    let mut root = f64::from_bits((x.to_bits() >> 1) + 0x1ff8000000000000);
    for _ in 0..4 {
        root = 0.5 * (root + x / root);
    }
    root
}
