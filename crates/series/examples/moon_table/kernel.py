

def moon_orientation(time: float) -> tuple[float, float, float]:
    """Return phi, theta, psi in radians at a time in seconds of TDB past J2000."""
    arcsecond = 4.84813681109536e-06
    t = time / 3155760000.0
    x = y = longitude = 0.0
    for i in (2, 1, 0):
        x = x * t + POLE_POLYNOMIAL[i][0]
        y = y * t + POLE_POLYNOMIAL[i][1]
        longitude = longitude * t + LONGITUDE_POLYNOMIAL[i]
    for rate, sx, sy, cx, cy in POLE:
        s, c = math.sin(rate * time), math.cos(rate * time)
        x += sx * s + cx * c
        y += sy * s + cy * c
    for rate, sine, cosine in LONGITUDE:
        longitude += sine * math.sin(rate * time) + cosine * math.cos(rate * time)
    x *= arcsecond
    y *= arcsecond
    # Rows 1, 2, 3 of the matrix from the axes of the Moon to the ecliptic of date; of rows 1 and 2 column 3 first.
    s, c, z = math.sin(longitude * arcsecond), math.cos(longitude * arcsecond), math.sqrt(1.0 - x * x - y * y)
    d13, d23 = y * s - x * c, -y * c - x * s
    d11, d12 = c + d13 * x / (1.0 + z), d13 * y / (1.0 + z) - s
    d21, d22 = s + d23 * x / (1.0 + z), c + d23 * y / (1.0 + z)
    # The pole of the ecliptic of date on that of J2000 is (p, -q, r) (IAU 2006); axis 1 is that of J2000 projected.
    p = (4.199094 + (0.1939873 - 0.00022466 * t) * t) * t * arcsecond
    q = (-46.811015 + (0.0510283 + 0.00052413 * t) * t) * t * arcsecond
    r, n = math.sqrt(1.0 - p * p - q * q), math.sqrt(1.0 - p * p)
    # These three axes in the ICRF, turned by the obliquity 84381.448 arcseconds.
    se, ce = 0.39777715593191365, 0.9174820620691818
    f2, f3 = (ce * p * q + se * p * r) / n, (se * p * q - ce * p * r) / n
    g2, g3 = (ce * r - se * q) / n, (se * r + ce * q) / n
    k2, k3 = -ce * q - se * r, ce * r - se * q
    # Axis 3 of the Moon in the ICRF, and axis 3 of the ICRF in the axes of the Moon.
    a1, a2, a3 = n * d13 + p * z, f2 * d13 + g2 * d23 + k2 * z, f3 * d13 + g3 * d23 + k3 * z
    b1, b2 = f3 * d11 + g3 * d21 + k3 * x, f3 * d12 + g3 * d22 + k3 * y
    return math.atan2(a1, -a2), math.atan2(math.sqrt(b1 * b1 + b2 * b2), a3), math.atan2(b1, b2)
