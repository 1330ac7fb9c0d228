let data = JSON.parse(document.getElementById("data").textContent);
const canvas = document.getElementById("canvas"), context = canvas.getContext("2d");
const slider = document.getElementById("time"), play = document.getElementById("play"), speed = document.getElementById("speed");
const box = document.getElementById("turn");

// Vectors and quaternions [x, y, z, w].
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (s, a) => [s * a[0], s * a[1], s * a[2]];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const size = a => Math.hypot(a[0], a[1], a[2]);
const unit = a => { const n = size(a); return n > 0 ? scaled(1 / n, a) : [0, 0, 1]; };
const rotate = (q, v) => { const t = scaled(2, cross(q, v)); return plus(plus(v, scaled(q[3], t)), cross(q, t)); };

// The state at a time: attitude, rates, momentum in body and inertial components.
function state(t) {
  const values = evaluate(t), q = values.slice(0, 4), rates = values.slice(4, 7);
  const momentum = data.axes.reduce((sum, axis, k) => plus(sum, scaled(data.moments[k] * dot(axis, rates), axis)), [0, 0, 0]);
  return { t, q, rates, momentum, inertialMomentum: rotate(q, momentum), inertialRates: rotate(q, rates) };
}

// Andoyer variables (theory §1): axes sorted by moments, the first reversed where that is left-handed.
function variables(s) {
  const m = data.order.map(k => dot(data.axes[k], s.momentum));
  if (data.reversed) m[0] = -m[0];
  const M = size(m), H = s.inertialMomentum, pole = unit(H);
  const third = rotate(s.q, data.axes[data.order[2]]), turn = 2 * Math.PI, positive = x => x < 0 ? x + turn : x;
  const lambda = Math.hypot(H[0], H[1]) > 0 ? Math.atan2(H[0], -H[1]) : 0;
  const node = [Math.cos(lambda), Math.sin(lambda), 0], across = cross(pole, third);
  const mu = size(across) > 0 ? Math.atan2(dot(cross(node, across), pole), dot(node, across)) : 0;
  return { J: Math.atan2(Math.hypot(m[0], m[1]), m[2]), lambda: positive(lambda), mu: positive(mu), nu: positive(Math.atan2(m[0], m[1])), Lambda: H[2], M, N: m[2] };
}

// The orbital frame, if the page has one: the quaternion to inertial components, and roll, pitch, yaw of the body in it.
function frame(t) {
  const frames = data.orbit.frames, place = Math.max(0, Math.min(1, (t - data.start) / (data.stop - data.start))) * (frames.length - 1);
  const k = Math.min(Math.floor(place), frames.length - 2), mixed = frames[k].map((part, n) => part + (place - k) * (frames[k + 1][n] - part)), length = Math.hypot(...mixed);
  return mixed.map(part => part / length);
}
const inverse = q => [-q[0], -q[1], -q[2], q[3]];
function against(s) {
  const f = inverse(frame(s.t)), [a, b, c] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(axis => rotate(f, rotate(s.q, axis)));
  return { roll: Math.atan2(b[2], c[2]), pitch: Math.asin(Math.max(-1, Math.min(1, -a[2]))), yaw: Math.atan2(a[1], a[0]) };
}

// The view: inertial components with the first angular momentum upwards, then turned by the reader.
let up, east, north;
const home = { yaw: 0.6, pitch: 0.35, zoom: 1 };
let view = { ...home }, turn = null;  // turn: the orbital frame that the view keeps at rest, its axis 3 (to the primary) downwards
function project(v) {
  const w = turn && rotate(inverse(turn), v);
  const [x, y, z] = w ? [w[0], -w[1], -w[2]] : [dot(v, east), dot(v, north), dot(v, up)];
  const c = Math.cos(view.yaw), s = Math.sin(view.yaw), a = Math.cos(view.pitch), b = Math.sin(view.pitch);
  const right = c * x - s * y, away = s * x + c * y;
  return [right, b * away + a * z, b * z - a * away];  // right, up, towards the reader
}

// The body: its faces in body components, coloured by octant so that its rotation is seen.
function ellipsoid(semiaxes) {
  const vertices = [], faces = [], rings = 16, columns = 32;
  for (let i = 0; i <= rings; i++) for (let j = 0; j < columns; j++) {
    const theta = Math.PI * i / rings, phi = 2 * Math.PI * j / columns;
    const along = [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
    vertices.push(data.axes.reduce((sum, axis, k) => plus(sum, scaled(semiaxes[k] * along[k], axis)), [0, 0, 0]));
  }
  for (let i = 0; i < rings; i++) for (let j = 0; j < columns; j++) {
    const next = (j + 1) % columns;
    faces.push([i * columns + j, (i + 1) * columns + j, (i + 1) * columns + next, i * columns + next]);
  }
  return { vertices, faces };
}
let body, radius, octant;

// Curves: the polhode, path of the angular velocity in the body; the herpolhode, its path among the stars, of which the last two rotations are drawn. One rolls on the other.
const trailed = 120;
let reach, polhode, rotation;
function herpolhode(t) {
  const from = Math.max(data.start, t - 2 * rotation), points = [];
  for (let k = 0; k <= trailed; k++) points.push(scaled(reach, state(from + (t - from) * k / trailed).inertialRates));
  return points;
}

const COLORS = { axes: ["#D55E00", "#009E73", "#0072B2"], momentum: "#CC79A7", rate: "#E69F00", polhode: "#56B4E9", herpolhode: "#E69F00" };
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

let scale = 1, centre = [0, 0];
const place = v => { const p = project(v); return [centre[0] + scale * p[0], centre[1] - scale * p[1], p[2]]; };

function curve(points, color, front, width) {
  context.strokeStyle = color;
  context.lineWidth = width;
  context.globalAlpha = front ? 1 : 0.3;
  context.beginPath();
  let joined = false;
  for (let k = 0; k < points.length - 1; k++) {
    const a = points[k], b = points[k + 1];
    if ((a[2] + b[2] >= 0) === front) {
      if (!joined) context.moveTo(a[0], a[1]);
      context.lineTo(b[0], b[1]);
      joined = true;
    } else joined = false;
  }
  context.stroke();
  context.globalAlpha = 1;
}

// An arrow from the surface of the body to a tip beyond it, both in inertial components.
function arrow(tip, foot, color, label, front) {
  const p = place(tip), f = place(foot);
  if ((p[2] >= 0) !== front) return;
  context.globalAlpha = front ? 1 : 0.45;
  context.strokeStyle = context.fillStyle = color;
  context.lineWidth = 2.5;
  context.beginPath();
  context.moveTo(f[0], f[1]);
  context.lineTo(p[0], p[1]);
  context.stroke();
  const angle = Math.atan2(p[1] - centre[1], p[0] - centre[0]);
  context.beginPath();
  context.moveTo(p[0], p[1]);
  for (const side of [-0.4, 0.4]) context.lineTo(p[0] - 11 * Math.cos(angle + side), p[1] - 11 * Math.sin(angle + side));
  context.fill();
  context.font = "15px system-ui, sans-serif";
  context.fillText(label, p[0] + 9 * Math.cos(angle) + 3, p[1] + 9 * Math.sin(angle) + 5);
  context.globalAlpha = 1;
}

// Where a direction from the centre leaves the body: of the ellipsoid exactly, of a mesh at the centre.
function surface(q, v) {
  const inBody = rotate(inverse(q), v);
  const level = data.mesh ? Infinity : Math.hypot(...data.axes.map((axis, k) => dot(axis, inBody) / data.semiaxes[k]));
  return scaled(level > 1 ? 1 / level : level > 0 ? 1 : 0, v);
}

function drawBody(q) {
  const light = unit([-0.4, 0.6, 0.8]), colors = ["--light", "--dark"].map(name => [1, 3, 5].map(at => parseInt(css(name).slice(at, at + 2), 16)));
  const points = body.vertices.map(v => place(rotate(q, v)));
  const drawn = [];
  body.faces.forEach((face, k) => {
    const [a, b, c] = [points[face[0]], points[face[1]], points[face[2]]], d = points[face[face.length - 1]];
    // Screen coordinates point down: the normal is that of (a − c) × (b − d), which no pole of the ellipsoid makes zero.
    const u = [(c[0] - a[0]) / scale, -(c[1] - a[1]) / scale, c[2] - a[2]], w = [(d[0] - b[0]) / scale, -(d[1] - b[1]) / scale, d[2] - b[2]];
    const normal = face.length > 3 ? cross(u, w) : cross([(b[0] - a[0]) / scale, -(b[1] - a[1]) / scale, b[2] - a[2]], u);
    if (normal[2] <= 0) return;
    drawn.push([a[2] + b[2] + c[2], face, k, Math.max(0, dot(unit(normal), light))]);
  });
  drawn.sort((one, other) => one[0] - other[0]);
  for (const [, face, k, bright] of drawn) {
    const shade = colors[octant[k] ? 0 : 1].map(part => Math.round(part * (0.55 + 0.45 * bright)));
    context.fillStyle = context.strokeStyle = `rgb(${shade.join(",")})`;
    context.lineWidth = 1;
    context.beginPath();
    face.forEach((vertex, n) => context[n ? "lineTo" : "moveTo"](points[vertex][0], points[vertex][1]));
    context.closePath();
    context.fill();
    context.stroke();
  }
}

function draw(t) {
  turn = box.checked ? frame(t) : null;
  const s = state(t), ratio = window.devicePixelRatio || 1, room = canvas.getBoundingClientRect();
  if (canvas.width !== Math.round(room.width * ratio) || canvas.height !== Math.round(room.height * ratio)) {
    canvas.width = Math.round(room.width * ratio);
    canvas.height = Math.round(room.height * ratio);
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, room.width, room.height);
  centre = [room.width / 2, room.height / 2];
  scale = view.zoom * Math.min(room.width, room.height) / (3.6 * radius);
  const turning = polhode.map(v => place(rotate(s.q, v))), resting = herpolhode(t).map(place);
  const axes = [0, 1, 2].map(k => { const v = [0, 0, 0]; v[k] = 1.25 * radius; return [rotate(s.q, v), COLORS.axes[k], String(k + 1)]; });
  const arrows = [...axes, [scaled(1.5 * radius, unit(s.inertialMomentum)), COLORS.momentum, "M"], [scaled(reach, s.inertialRates), COLORS.rate, "ω"]];
  if (turn) for (const [axis, label] of [[0, "forward"], [2, "primary"]]) { const v = [0, 0, 0]; v[axis] = 1.5 * radius; arrows.push([rotate(turn, v), css("--pale"), label]); }
  const layer = front => {
    if (!turn) curve(resting, COLORS.herpolhode, front, 1.2);
    curve(turning, COLORS.polhode, front, 2);
    for (const [tip, color, label] of arrows) if (front || label !== "M" || size(s.momentum) > 0) arrow(tip, surface(s.q, tip), color, label, front);
  };
  layer(false);
  drawBody(s.q);
  layer(true);
  numbers(s);
  slider.value = String(t);
}

function rowOf(table, name, value) {
  const row = document.getElementById(table).insertRow();
  row.insertCell().append(name);
  const cell = row.insertCell();
  cell.append(value);
  return cell;
}
const cells = {};
for (const [color, what] of [...COLORS.axes.map((color, k) => [color, `body axis ${k + 1}`]), [COLORS.momentum, "angular momentum M"], [COLORS.rate, "angular velocity ω; herpolhode"], [COLORS.polhode, "polhode"]]) {
  const key = document.createElement("span");
  key.className = "key";
  key.style.borderColor = color;
  const cell = document.getElementById("lines").insertRow().insertCell();
  cell.style.textAlign = "left";
  cell.append(key, what);
}
function numbers(s) {
  const a = variables(s), degrees = x => `${(x * 180 / Math.PI).toFixed(4)}°`;
  const shown = { t: `${Number(s.t.toPrecision(8))} ${data.unit}`, J: degrees(a.J), "λ": degrees(a.lambda), "μ": degrees(a.mu), "ν": degrees(a.nu), "Λ/M": (a.Lambda / a.M).toFixed(6), "N/M": (a.N / a.M).toFixed(6) };
  s.rates.forEach((rate, k) => { shown[["ω₁", "ω₂", "ω₃"][k]] = `${rate.toExponential(6)} rad/${data.unit}`; });
  if (data.orbit) for (const [name, angle] of Object.entries(against(s))) cells[name].textContent = `${(angle * 180 / Math.PI).toFixed(2)}°`;
  for (const name in shown) cells[name].textContent = a.M > 0 || name === "t" || name[0] === "ω" ? shown[name] : "–";
}

// Time runs; everything is a function of it.
let time, playing = true, before = null;
for (const seconds of [10, 30, 60, 120, 300]) speed.add(new Option(`whole in ${seconds} s`, String(seconds), seconds === 60, seconds === 60));
function tick(clock) {
  if (playing && before !== null) {
    time += (data.stop - data.start) / Number(speed.value) * Math.min(0.1, (clock - before) / 1000);
    if (time > data.stop) time = data.start + (time - data.stop) % (data.stop - data.start || 1);
    draw(time);
  }
  before = clock;
  requestAnimationFrame(tick);
}
function run(on) {
  playing = on;
  play.textContent = on ? "pause" : "play";
}
play.onclick = () => run(!playing);
slider.oninput = () => { run(false); time = Number(slider.value); draw(time); };
box.onchange = () => draw(time);
document.getElementById("view").onclick = () => { view = { ...home }; draw(time); };
canvas.onpointerdown = event => canvas.setPointerCapture(event.pointerId);
canvas.onpointermove = event => {
  if (!event.buttons) return;
  view.yaw += event.movementX / 150;
  view.pitch = Math.max(-1.5, Math.min(1.5, view.pitch + event.movementY / 150));
  draw(time);
};
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  view.zoom = Math.max(0.3, Math.min(6, view.zoom * Math.exp(-event.deltaY / 600)));
  draw(time);
}, { passive: false });
canvas.onkeydown = event => {
  const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
  if (!turns) return;
  event.preventDefault();
  view.yaw += turns[0];
  view.pitch = Math.max(-1.5, Math.min(1.5, view.pitch + turns[1]));
  draw(time);
};
window.addEventListener("resize", () => draw(time));

// What depends on the motion: the view, the body, the curves, the rows of the tables, the ends of the slider.
function load(next) {
  data = next;
  document.getElementById("orbit").hidden = !data.orbit;
  box.checked = Boolean(data.orbit);
  up = unit(state(data.start).inertialMomentum);
  east = unit(Math.abs(up[2]) < 0.9 ? cross([0, 0, 1], up) : cross([1, 0, 0], up));
  north = cross(up, east);
  body = data.mesh || ellipsoid(data.semiaxes);
  radius = Math.max(...body.vertices.map(size));
  octant = body.faces.map(face => { const c = face.reduce((sum, k) => plus(sum, body.vertices[k]), [0, 0, 0]); return data.axes.reduce((sign, axis) => sign * Math.sign(dot(axis, c)), 1) > 0; });
  reach = 1.35 * radius / (data.largestRate > 0 ? data.largestRate : 1);
  rotation = (data.stop - data.start) / Math.max(data.rotations, 1);
  polhode = [];
  for (let k = 0; k <= 500; k++) polhode.push(scaled(reach, evaluate(data.start + (data.polhodeStop - data.start) * k / 500).slice(4, 7)));
  for (const table of ["now", "facts"]) for (const row of [...document.getElementById(table).rows]) row.remove();
  for (const name in cells) delete cells[name];
  for (const name of ["t", ...(data.orbit ? ["roll", "pitch", "yaw"] : []), "J", "λ", "μ", "ν", "Λ/M", "N/M", "ω₁", "ω₂", "ω₃"]) cells[name] = rowOf("now", name, "");
  for (const [name, value] of data.facts) rowOf("facts", name, value);
  slider.min = String(data.start);
  slider.max = String(data.stop);
  time = data.start;
  // While time runs, the next frame draws.
  if (!playing || before === null) draw(time);
}

// For scripts: another motion, the state and the Andoyer variables at a time, and a moment that is held.
window.andoyer = { evaluate, load, now: () => time, state, variables: t => variables(state(t)), against: t => against(state(t)), show: t => { run(false); time = t; draw(t); } };
load(data);
requestAnimationFrame(tick);
