
/* phi, theta, psi in radians at a time in seconds of TDB past J2000. */
void moon_orientation(double time, double angles[3]);

void moon_orientation(double time, double angles[3])
{
    const double arcsecond = 4.84813681109536e-06;
    const double t = time / 3155760000.0;
    double x = 0.0, y = 0.0, longitude = 0.0;
    for (int i = 2; i >= 0; i--) {
        x = x * t + POLE_POLYNOMIAL[i][0];
        y = y * t + POLE_POLYNOMIAL[i][1];
        longitude = longitude * t + LONGITUDE_POLYNOMIAL[i];
    }
    for (unsigned i = 0; i < sizeof POLE / sizeof POLE[0]; i++) {
        const double s = sin(POLE[i][0] * time), c = cos(POLE[i][0] * time);
        x += POLE[i][1] * s + POLE[i][3] * c;
        y += POLE[i][2] * s + POLE[i][4] * c;
    }
    for (unsigned i = 0; i < sizeof LONGITUDE / sizeof LONGITUDE[0]; i++)
        longitude += LONGITUDE[i][1] * sin(LONGITUDE[i][0] * time) + LONGITUDE[i][2] * cos(LONGITUDE[i][0] * time);
    x *= arcsecond;
    y *= arcsecond;
    /* Rows 1, 2, 3 of the matrix from the axes of the Moon to the ecliptic of date; of rows 1 and 2 column 3 first. */
    const double s = sin(longitude * arcsecond), c = cos(longitude * arcsecond), z = sqrt(1.0 - x * x - y * y);
    const double d13 = y * s - x * c, d23 = -y * c - x * s;
    const double d11 = c + d13 * x / (1.0 + z), d12 = d13 * y / (1.0 + z) - s;
    const double d21 = s + d23 * x / (1.0 + z), d22 = c + d23 * y / (1.0 + z);
    /* The pole of the ecliptic of date on that of J2000 is (p, -q, r) (IAU 2006); axis 1 is that of J2000 projected. */
    const double p = (4.199094 + (0.1939873 - 0.00022466 * t) * t) * t * arcsecond;
    const double q = (-46.811015 + (0.0510283 + 0.00052413 * t) * t) * t * arcsecond;
    const double r = sqrt(1.0 - p * p - q * q), n = sqrt(1.0 - p * p);
    /* These three axes in the ICRF, turned by the obliquity 84381.448 arcseconds. */
    const double se = 0.39777715593191365, ce = 0.9174820620691818;
    const double f2 = (ce * p * q + se * p * r) / n, f3 = (se * p * q - ce * p * r) / n;
    const double g2 = (ce * r - se * q) / n, g3 = (se * r + ce * q) / n;
    const double k2 = -ce * q - se * r, k3 = ce * r - se * q;
    /* Axis 3 of the Moon in the ICRF, and axis 3 of the ICRF in the axes of the Moon. */
    const double a1 = n * d13 + p * z, a2 = f2 * d13 + g2 * d23 + k2 * z, a3 = f3 * d13 + g3 * d23 + k3 * z;
    const double b1 = f3 * d11 + g3 * d21 + k3 * x, b2 = f3 * d12 + g3 * d22 + k3 * y;
    angles[0] = atan2(a1, -a2);
    angles[1] = atan2(sqrt(b1 * b1 + b2 * b2), a3);
    angles[2] = atan2(b1, b2);
}
