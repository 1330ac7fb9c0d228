
// Writes [x, y, z, w, w1, w2, w3], the attitude and the angular velocity in body components, into `out`; RangeError beyond the bound.
function rotation(time, out = new Float64Array(7)) {
  const high = time - EPOCH;
  if (!(high >= -BOUND && high <= BOUND)) throw new RangeError(`time must be within ${BOUND} of ${EPOCH}: got ${time}`);
  // The rounding error of the difference (Knuth).
  const virtualEpoch = time - high;
  const low = (time - (high + virtualEpoch)) + (virtualEpoch - EPOCH);
  const [ar, ai, br, bi] = pair(...circle(ANOMALY, high, low));
  const upper = ar * ar + ai * ai, lower = br * br + bi * bi, norm = upper + lower;
  const momentum = [2.0 * (br * ai - bi * ar) / norm, 2.0 * (br * ar + bi * ai) / norm, (upper - lower) / norm];
  const root = Math.sqrt(norm), half = circle(HALF_LONGITUDE, high, low), sine = half[0] / root, cosine = half[1] / root;
  const relative = [br * cosine - bi * sine, br * sine + bi * cosine, ar * sine + ai * cosine, ar * cosine - ai * sine];
  ATTITUDE.forEach((row, n) => { out[n] = row[0] * relative[0] + row[1] * relative[1] + row[2] * relative[2] + row[3] * relative[3]; });
  RATES.forEach((row, n) => { out[4 + n] = row[0] * momentum[0] + row[1] * momentum[1] + row[2] * momentum[2]; });
  return out;
}

// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer.
function nearest(x) {
  return (x + 6755399441055744.0) - 6755399441055744.0;
}

// Sine and cosine of a phase. Only the reduction in turns is to 32 digits; it is exact where numbers cancel.
function circle([first, second, third, start, startLow], high, low) {
  // The time in two halves (Veltkamp), and the rounding error of the product (Dekker).
  const scaled = 134217729.0 * high;
  const upper = scaled - (scaled - high);
  const lower = high - upper;
  const product = (first + second) * high;
  const error = ((first * upper - product) + first * lower + second * upper) + second * lower;
  const rest = (first + second) * low + (third * high + (error + startLow));
  const fraction = product - nearest(product);
  const quarters = nearest(4.0 * (start + (fraction + rest)));
  const x = ((start - 0.25 * quarters) + fraction) + rest;
  // Minimax polynomials for |x| <= 1/8.
  const s = x * x;
  let p = ((((3.7794529249619515 * s - 15.093736267536418) * s + 42.05868379747909) * s
    - 76.70585969420165) * s + 81.60524927591186) * s - 41.3417022403996;
  let q = (((((-1.6862683429441374 * s + 7.902528501565459) * s - 26.42623923109041) * s
    + 60.244641210418315) * s - 85.45681720592083) * s + 64.93939402266658) * s - 19.739208802178716;
  p = x * 6.283185307179586 + x * (s * p + 2.4492935982947064e-16);
  q = 1.0 + s * q;
  switch (quarters & 3) {
    case 0: return [p, q];
    case 1: return [q, -p];
    case 2: return [-p, -q];
    default: return [-q, p];
  }
}
