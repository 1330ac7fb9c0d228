
/// Re a, Im a, Re b and Im b by Horner's rule in cos 2l'.
fn pair(terms: &[[f64; 4]], sine: f64, cosine: f64) -> [f64; 4] {
    let double_cosine = 1.0 - 2.0 * sine * sine;
    let mut sums = [0.0; 4];
    for term in terms.iter().rev() {
        for (sum, coefficient) in sums.iter_mut().zip(term) {
            *sum = *sum * double_cosine + coefficient;
        }
    }
    [sums[0], sums[1] * (2.0 * sine * cosine), sums[2] * cosine, sums[3] * sine]
}
