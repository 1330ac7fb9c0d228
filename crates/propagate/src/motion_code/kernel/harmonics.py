

def _pair(sine: float, cosine: float) -> tuple[float, float, float, float]:
    """Return Re a, Im a, Re b and Im b by a rotation from each multiple of 2l' to the next."""
    double_sine, double_cosine = 2.0 * sine * cosine, 1.0 - 2.0 * sine * sine
    c, s = 1.0, 0.0
    ar = ai = b_cosine = odd_sine = odd_cosine = b_sine = 0.0
    for p, q, u, v in TERMS:
        ar, ai = ar + p * c, ai + q * s
        b_cosine, odd_sine = b_cosine + u * c, odd_sine + u * s
        odd_cosine, b_sine = odd_cosine + v * c, b_sine + v * s
        c, s = c * double_cosine - s * double_sine, s * double_cosine + c * double_sine
    return ar, ai, b_cosine * cosine - odd_sine * sine, b_sine * cosine + odd_cosine * sine
