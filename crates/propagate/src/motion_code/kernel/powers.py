

def _pair(sine: float, cosine: float) -> tuple[float, float, float, float]:
    """Return Re a, Im a, Re b and Im b by Horner's rule in cos 2l'."""
    double_cosine = 1.0 - 2.0 * sine * sine
    ar = ai = br = bi = 0.0
    for p, q, u, v in reversed(TERMS):
        ar, ai = ar * double_cosine + p, ai * double_cosine + q
        br, bi = br * double_cosine + u, bi * double_cosine + v
    return ar, ai * (2.0 * sine * cosine), br * cosine, bi * sine
