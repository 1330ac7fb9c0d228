
// [phi, theta, psi] in radians at a time in seconds of TDB past J2000.
function moon_orientation(time) {
  const arcsecond = 4.84813681109536e-06;
  const t = time / 3155760000.0;
  let x = 0.0, y = 0.0, longitude = 0.0;
  for (let i = 2; i >= 0; i--) {
    x = x * t + POLE_POLYNOMIAL[i][0];
    y = y * t + POLE_POLYNOMIAL[i][1];
    longitude = longitude * t + LONGITUDE_POLYNOMIAL[i];
  }
  for (const [rate, sx, sy, cx, cy] of POLE) {
    const s = Math.sin(rate * time), c = Math.cos(rate * time);
    x += sx * s + cx * c;
    y += sy * s + cy * c;
  }
  for (const [rate, sine, cosine] of LONGITUDE) longitude += sine * Math.sin(rate * time) + cosine * Math.cos(rate * time);
  x *= arcsecond;
  y *= arcsecond;
  // Rows 1, 2, 3 of the matrix from the axes of the Moon to the ecliptic of date; of rows 1 and 2 column 3 first.
  const s = Math.sin(longitude * arcsecond), c = Math.cos(longitude * arcsecond), z = Math.sqrt(1.0 - x * x - y * y);
  const d13 = y * s - x * c, d23 = -y * c - x * s;
  const d11 = c + d13 * x / (1.0 + z), d12 = d13 * y / (1.0 + z) - s;
  const d21 = s + d23 * x / (1.0 + z), d22 = c + d23 * y / (1.0 + z);
  // The pole of the ecliptic of date on that of J2000 is (p, -q, r) (IAU 2006); axis 1 is that of J2000 projected.
  const p = (4.199094 + (0.1939873 - 0.00022466 * t) * t) * t * arcsecond;
  const q = (-46.811015 + (0.0510283 + 0.00052413 * t) * t) * t * arcsecond;
  const r = Math.sqrt(1.0 - p * p - q * q), n = Math.sqrt(1.0 - p * p);
  // These three axes in the ICRF, turned by the obliquity 84381.448 arcseconds.
  const se = 0.39777715593191365, ce = 0.9174820620691818;
  const f2 = (ce * p * q + se * p * r) / n, f3 = (se * p * q - ce * p * r) / n;
  const g2 = (ce * r - se * q) / n, g3 = (se * r + ce * q) / n;
  const k2 = -ce * q - se * r, k3 = ce * r - se * q;
  // Axis 3 of the Moon in the ICRF, and axis 3 of the ICRF in the axes of the Moon.
  const a1 = n * d13 + p * z, a2 = f2 * d13 + g2 * d23 + k2 * z, a3 = f3 * d13 + g3 * d23 + k3 * z;
  const b1 = f3 * d11 + g3 * d21 + k3 * x, b2 = f3 * d12 + g3 * d22 + k3 * y;
  return [Math.atan2(a1, -a2), Math.atan2(Math.sqrt(b1 * b1 + b2 * b2), a3), Math.atan2(b1, b2)];
}

if (typeof module !== "undefined") module.exports = { moon_orientation };
