
// Re a, Im a, Re b and Im b by a rotation from each multiple of 2l' to the next.
function pair(sine, cosine) {
  const doubleSine = 2.0 * sine * cosine, doubleCosine = 1.0 - 2.0 * sine * sine;
  let c = 1.0, s = 0.0, ar = 0.0, ai = 0.0, bCosine = 0.0, bSine = 0.0, oddCosine = 0.0, oddSine = 0.0;
  for (const [p, q, u, v] of TERMS) {
    ar += p * c;
    ai += q * s;
    bCosine += u * c;
    oddSine += u * s;
    oddCosine += v * c;
    bSine += v * s;
    [c, s] = [c * doubleCosine - s * doubleSine, s * doubleCosine + c * doubleSine];
  }
  return [ar, ai, bCosine * cosine - oddSine * sine, bSine * cosine + oddCosine * sine];
}
