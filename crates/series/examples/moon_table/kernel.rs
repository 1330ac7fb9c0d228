
/// phi, theta, psi in radians at a time in seconds of TDB past J2000.
pub fn moon_orientation(time: f64) -> [f64; 3] {
    let arcsecond = 4.84813681109536e-06;
    let t = time / 3155760000.0;
    let (mut x, mut y, mut longitude) = (0.0, 0.0, 0.0);
    for i in (0..3).rev() {
        x = x * t + POLE_POLYNOMIAL[i][0];
        y = y * t + POLE_POLYNOMIAL[i][1];
        longitude = longitude * t + LONGITUDE_POLYNOMIAL[i];
    }
    for [rate, sx, sy, cx, cy] in POLE {
        let (s, c) = ((rate * time).sin(), (rate * time).cos());
        x += sx * s + cx * c;
        y += sy * s + cy * c;
    }
    for [rate, sine, cosine] in LONGITUDE {
        longitude += sine * (rate * time).sin() + cosine * (rate * time).cos();
    }
    x *= arcsecond;
    y *= arcsecond;
    // Rows 1, 2, 3 of the matrix from the axes of the Moon to the ecliptic of date; of rows 1 and 2 column 3 first.
    let (s, c, z) = ((longitude * arcsecond).sin(), (longitude * arcsecond).cos(), (1.0 - x * x - y * y).sqrt());
    let (d13, d23) = (y * s - x * c, -y * c - x * s);
    let (d11, d12) = (c + d13 * x / (1.0 + z), d13 * y / (1.0 + z) - s);
    let (d21, d22) = (s + d23 * x / (1.0 + z), c + d23 * y / (1.0 + z));
    // The pole of the ecliptic of date on that of J2000 is (p, -q, r) (IAU 2006); axis 1 is that of J2000 projected.
    let p = (4.199094 + (0.1939873 - 0.00022466 * t) * t) * t * arcsecond;
    let q = (-46.811015 + (0.0510283 + 0.00052413 * t) * t) * t * arcsecond;
    let (r, n) = ((1.0 - p * p - q * q).sqrt(), (1.0 - p * p).sqrt());
    // These three axes in the ICRF, turned by the obliquity 84381.448 arcseconds.
    let (se, ce) = (0.39777715593191365, 0.9174820620691818);
    let (f2, f3) = ((ce * p * q + se * p * r) / n, (se * p * q - ce * p * r) / n);
    let (g2, g3) = ((ce * r - se * q) / n, (se * r + ce * q) / n);
    let (k2, k3) = (-ce * q - se * r, ce * r - se * q);
    // Axis 3 of the Moon in the ICRF, and axis 3 of the ICRF in the axes of the Moon.
    let (a1, a2, a3) = (n * d13 + p * z, f2 * d13 + g2 * d23 + k2 * z, f3 * d13 + g3 * d23 + k3 * z);
    let (b1, b2) = (f3 * d11 + g3 * d21 + k3 * x, f3 * d12 + g3 * d22 + k3 * y);
    [a1.atan2(-a2), (b1 * b1 + b2 * b2).sqrt().atan2(a3), b1.atan2(b2)]
}
