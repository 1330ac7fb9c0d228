// The orientation of the Moon as a table of 60 terms, within 0.629 arcseconds of the
// orientation of the ephemeris DE421 over 1950 to 2050. Beyond these years the error grows.
//
// moon_orientation(time): time in seconds of TDB past J2000 (2000-01-01 12:00 TDB); the result is
// phi, theta, psi in radians. They turn the axes of the ICRF into the principal axes of the Moon
// of DE421 (MOON_PA_DE421): first by phi about axis 3, then by theta about axis 1, then by psi
// about axis 3. A vector with components v in the ICRF has R3(psi) R1(theta) R3(phi) v in these axes,
// R1 and R3 turning the frame: R3(a) = [[cos a, sin a, 0], [-sin a, cos a, 0], [0, 0, 1]].
//
// The terms are for the pole of the ecliptic of date in the axes of the Moon (x, y) and the longitude.
// Compile without options that change the order of sums.

// x and y in arcseconds, by power of Julian centuries.
const POLE_POLYNOMIAL = [
    [-78.5079, 0.3489],
    [-0.0671, 0.0529],
    [-0.0554, -0.7857]
];
// Rate in rad/s; amplitudes of its sine in x and y, of its cosine in x and y, in arcseconds.
const POLE = [
    [2.672404141434e-6, -319.8382, -5531.9354, 5554.0193, -318.5811],
    [3.320107437918e-8, -92.9626, -50.1977, 82.7477, -56.2647],
    [2.661705374512e-6, -11.9452, -0.2583, 0.2621, -11.9411],
    [2.660561754489e-9, 3.1531, -2.5835, -1.047, -7.8343],
    [2.252797623572e-6, 2.3075, 1.9502, -1.7742, 2.536],
    [3.864055736155e-7, -2.655, -0.2106, 0.3473, -1.5981],
    [2.871499938257e-6, -0.0174, -1.2825, 1.2427, -0.0179],
    [5.311607246623e-6, -1.0485, 0.2236, -1.1753, -0.1986],
    [2.639213414507e-6, 1.0661, -0.0796, 0.076, 1.0779],
    [2.473308412661e-6, 0.103, 1.0532, -1.0153, 0.1069],
    [2.606032959707e-6, -0.3744, -0.0218, 0.0159, -0.4775],
    [4.958402785452e-6, -0.3391, 0.0191, -0.0846, -0.0763],
    [1.078755819479e-8, 0.3157, 0.0238, -0.1143, 0.0201],
    [2.319199910872e-6, -0.1187, 0.1873, -0.1984, -0.1121],
    [2.738766887938e-6, -0.2269, 0.0362, -0.036, -0.228],
    [3.025607648216e-6, -0.0925, -0.1522, 0.1207, -0.1168],
    [1.658922563973e-7, 0.0914, 0.1018, 0.0734, -0.1237],
    [2.322991983761e-7, -0.091, -0.0952, 0.0889, -0.0975],
    [2.451893697479e-6, -0.0904, -0.0813, 0.0758, -0.0971],
    [2.683185849637e-6, -0.1107, -0.0431, 0.0433, -0.1102],
    [2.098155767264e-7, -0.106, -0.0391, 0.0485, -0.086],
    [7.597608050039e-6, 0.1017, 0.0041, -0.0612, 0.0068],
    [2.053702037973e-6, 0.066, 0.0497, -0.0464, 0.0707],
    [2.705562027723e-6, 0.0724, 0.04, -0.0398, 0.0728],
    [5.855033937295e-7, -0.0816, -0.0091, 0.0142, -0.052],
    [2.650316533251e-6, -0.0435, -0.0487, 0.0488, -0.0437]
];
// In arcseconds, by power of Julian centuries.
const LONGITUDE_POLYNOMIAL = [865866021.1592, 1732559332.4379, -44.0427];
// Rate in rad/s; amplitudes of its sine and its cosine, in arcseconds.
const LONGITUDE = [
    [1.99096927232e-7, 90.6129, -3.9108],
    [2.639202999731e-6, 11.8744, -11.8827],
    [6.638127163506e-8, -1.8727, 16.4201],
    [3.532044411945e-7, 8.2183, 5.5888],
    [1.069475477744e-8, 3.9552, 6.8166],
    [3.319878307375e-8, -3.4598, -5.8962],
    [2.285998653337e-6, 0.7709, -4.0585],
    [1.766075661014e-7, 3.3135, 1.0128],
    [6.875783940688e-8, -1.3923, -1.8371],
    [4.196065927395e-7, 1.0773, -1.2437],
    [2.254653034589e-8, -1.1317, 0.3771],
    [2.672408013215e-6, -1.0507, -0.0488],
    [1.54112190969e-7, 0.7656, 0.5701],
    [5.001314833901e-8, 0.6402, -0.3374],
    [4.925201833287e-6, 0.2744, 0.4026],
    [5.278406222665e-6, 0.0002, 0.4453],
    [2.705609034993e-6, 0.2646, 0.3355],
    [4.499904508627e-8, -0.3333, 0.27],
    [1.245214132964e-7, 0.0538, 0.3557],
    [1.225367677142e-8, -0.1658, 0.5064],
    [1.241194870661e-9, -0.8683, -1.2659],
    [7.441242416354e-8, 0.0139, -0.2356],
    [2.086903162e-6, 0.0528, -0.2248],
    [3.981933326032e-7, 0.2245, -0.0201],
    [4.604839224743e-9, -0.0435, 0.2505],
    [2.440104143766e-6, 0.1207, -0.1103],
    [5.522979275332e-7, 0.1315, 0.0819],
    [2.205387106956e-7, -0.0958, 0.104],
    [8.064582926109e-8, 0.1191, -0.0063],
    [1.823829870073e-7, -0.0449, -0.0946],
    [2.838297295582e-6, -0.0689, 0.0755],
    [2.462591103597e-6, 0.0468, -0.0892],
    [1.741142623848e-8, 0.0817, -0.0525],
    [1.974175131102e-8, -0.083, -0.0353]
];

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
