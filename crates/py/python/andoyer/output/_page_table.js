// A table of the motion with cubic Hermite interpolation of the quaternion by its derivative, q ω / 2, and of the angular velocity by its differences.
const evaluate = (() => {
  const text = atob(TABLE.values), bytes = Uint8Array.from(text, letter => letter.charCodeAt(0));
  const rows = new Float64Array(bytes.buffer), width = 7, last = rows.length / width - 1;
  const step = (TABLE.stop - TABLE.start) / last;
  const row = place => rows.subarray(width * place, width * place + width);
  const derivative = r => [
    (r[3] * r[4] + r[1] * r[6] - r[2] * r[5]) / 2, (r[3] * r[5] + r[2] * r[4] - r[0] * r[6]) / 2,
    (r[3] * r[6] + r[0] * r[5] - r[1] * r[4]) / 2, -(r[0] * r[4] + r[1] * r[5] + r[2] * r[6]) / 2];
  const change = (place, k) => place === 0 ? row(1)[k] - row(0)[k] : place === last ? row(last)[k] - row(last - 1)[k] : (row(place + 1)[k] - row(place - 1)[k]) / 2;
  return t => {
    const place = Math.max(0, Math.min(last - 1, Math.floor((t - TABLE.start) / step)));
    const s = (t - TABLE.start) / step - place, a = row(place), b = row(place + 1), da = derivative(a), db = derivative(b);
    const h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s), h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
    const out = [];
    for (let k = 0; k < 4; k++) out.push(h00 * a[k] + h10 * step * da[k] + h01 * b[k] + h11 * step * db[k]);
    const norm = Math.hypot(...out);
    for (let k = 0; k < 4; k++) out[k] /= norm;
    for (let k = 4; k < 7; k++) out.push(h00 * a[k] + h10 * change(place, k) + h01 * b[k] + h11 * change(place + 1, k));
    return out;
  };
})();
