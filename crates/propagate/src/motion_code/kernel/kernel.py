

def rotation(time: float) -> tuple[tuple[float, float, float, float], tuple[float, float, float]]:
    """Return the attitude [x, y, z, w] and the angular velocity in body components; ValueError beyond the bound."""
    high = time - EPOCH
    if not -BOUND <= high <= BOUND:
        raise ValueError(f"time must be within {BOUND!r} of {EPOCH!r}: got {time!r}")
    # The rounding error of the difference (Knuth).
    virtual_epoch = time - high
    low = (time - (high + virtual_epoch)) + (virtual_epoch - EPOCH)
    ar, ai, br, bi = _pair(*_circle(ANOMALY, high, low))
    upper, lower = ar * ar + ai * ai, br * br + bi * bi
    norm = upper + lower
    g1, g2, g3 = 2.0 * (br * ai - bi * ar) / norm, 2.0 * (br * ar + bi * ai) / norm, (upper - lower) / norm
    sine, cosine = _circle(HALF_LONGITUDE, high, low)
    root = math.sqrt(norm)
    sine, cosine = sine / root, cosine / root
    p, q, r, s = br * cosine - bi * sine, br * sine + bi * cosine, ar * sine + ai * cosine, ar * cosine - ai * sine
    x, y, z, w = (row[0] * p + row[1] * q + row[2] * r + row[3] * s for row in ATTITUDE)
    w1, w2, w3 = (row[0] * g1 + row[1] * g2 + row[2] * g3 for row in RATES)
    return (x, y, z, w), (w1, w2, w3)


def _nearest(x: float) -> float:
    """Adding and subtracting 1.5 * 2^52 rounds to the nearest integer."""
    return (x + 6755399441055744.0) - 6755399441055744.0


def _circle(phase: tuple[float, float, float, float, float], high: float, low: float) -> tuple[float, float]:
    """Sine and cosine of a phase. Only the reduction in turns is to 32 digits; it is exact where numbers cancel."""
    first, second, third, start, start_low = phase
    # The time in two halves (Veltkamp), and the rounding error of the product (Dekker).
    scaled = 134217729.0 * high
    upper = scaled - (scaled - high)
    lower = high - upper
    product = (first + second) * high
    error = ((first * upper - product) + first * lower + second * upper) + second * lower
    rest = (first + second) * low + (third * high + (error + start_low))
    fraction = product - _nearest(product)
    quarters = _nearest(4.0 * (start + (fraction + rest)))
    x = ((start - 0.25 * quarters) + fraction) + rest
    # Minimax polynomials for |x| <= 1/8.
    s = x * x
    p = ((((3.7794529249619515 * s - 15.093736267536418) * s + 42.05868379747909) * s - 76.70585969420165) * s + 81.60524927591186) * s
    p = x * 6.283185307179586 + x * (s * (p - 41.3417022403996) + 2.4492935982947064e-16)
    q = ((((-1.6862683429441374 * s + 7.902528501565459) * s - 26.42623923109041) * s + 60.244641210418315) * s - 85.45681720592083) * s
    q = 1.0 + s * ((q + 64.93939402266658) * s - 19.739208802178716)
    return ((p, q), (q, -p), (-p, -q), (-q, p))[int(quarters) & 3]
