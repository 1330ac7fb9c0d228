
/// Re a, Im a, Re b and Im b by a rotation from each multiple of 2l' to the next.
fn pair(terms: &[[f64; 4]], sine: f64, cosine: f64) -> [f64; 4] {
    let (double_sine, double_cosine) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
    let (mut c, mut s) = (1.0, 0.0);
    let mut sums = [0.0; 6];
    for [p, q, u, v] in terms {
        for (sum, product) in sums.iter_mut().zip([p * c, q * s, u * c, u * s, v * c, v * s]) {
            *sum += product;
        }
        (c, s) = (c * double_cosine - s * double_sine, s * double_cosine + c * double_sine);
    }
    let [ar, ai, b_cosine, odd_sine, odd_cosine, b_sine] = sums;
    [ar, ai, b_cosine * cosine - odd_sine * sine, b_sine * cosine + odd_cosine * sine]
}
