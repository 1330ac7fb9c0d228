
// Re a, Im a, Re b and Im b by Horner's rule in cos 2l'.
function pair(sine, cosine) {
  const doubleCosine = 1.0 - 2.0 * sine * sine;
  const sums = [0.0, 0.0, 0.0, 0.0];
  for (let k = TERMS.length - 1; k >= 0; k--) {
    for (let n = 0; n < 4; n++) sums[n] = sums[n] * doubleCosine + TERMS[k][n];
  }
  return [sums[0], sums[1] * (2.0 * sine * cosine), sums[2] * cosine, sums[3] * sine];
}
