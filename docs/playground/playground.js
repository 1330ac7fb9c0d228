// The playground: a scene as TOML is the one state. Presets, sliders and the address write this text; the library, compiled to WebAssembly, reads it.
import { VIEW } from "./view.js";

const element = id => document.getElementById(id);
const TURN = 2 * Math.PI, AXES = ["--first", "--second", "--third"], SHOWN = { rotations: 60, periods: 3, nodes: 192 };

// `unit` is that of time. `shape` is how the body is drawn.
const PRESETS = {
  flip: {
    label: "Dzhanibekov’s flip", unit: "s", shape: "box",
    note: "A box that spins about its middle axis turns over again and again. Moments and rates are chosen; the first ω₃ is a thousandth of ω₂.",
    toml: `name = "Dzhanibekov's flip"

[body]
moments = [0.5, 0.75, 1.0]

[state]
attitude = [0.0, 0.0, 0.0, 1.0]
angular_velocity = [0.0, 5.0, 0.005]
`,
  },
  apophis: {
    label: "Apophis", unit: "s", shape: "ellipsoid",
    note: "The tumbling asteroid from its two published periods, 27.38 h and 263 h (Pravec et al. 2014). The phases at time 0 are chosen.",
    toml: `name = "Apophis"
span = [0.0, 31557600.0]

[body]
moments = [0.61, 0.965, 1.0]

[periods]
precession = 98568.0
rotation = 946800.0
momentum_direction = [-1.4835298641951802, -1.4835298641951802]
`,
  },
  boom: {
    label: "Boom satellite", unit: "s", shape: "ellipsoid",
    note: "The Earth’s gravity gradient holds a long satellite upright. Released 25° in pitch and 20° in yaw from the vertical it swings, over five orbits. All figures are chosen.",
    toml: `name = "Boom satellite"
span = [0.0, 28380.0]
tolerance = 1e-9

[body]
moments = [0.95, 1.0, 0.08]

[state]
frame = "lvlh"
elements_of = "rotating"
sequence = "ZYX"
attitude = [0.349, 0.436, 0.0]
angular_velocity = [0.0, 0.0, 0.0]

[orbit]
mean_motion = 1.107e-3
`,
  },
  moon: {
    label: "The Moon", unit: "d", shape: "ellipsoid",
    note: "Axis 1 follows the Earth, with the optical libration of an ellipse of eccentricity 0.0549. Moments of the catalogue, a fixed orbit in its plane, the relaxed state at the pericentre.",
    toml: `name = "The Moon"
span = [0.0, 1095.75]
tolerance = 1e-6

[body]
named = "Moon"

[state]
attitude = [0.0, 0.0, 1.0, 0.0]
angular_velocity = [0.0, 0.0, 0.22995281676961699]

[orbit]
mean_motion = 0.229970839151382
eccentricity = 0.0549
mass_fraction = 0.9878494
`,
  },
};
const named = name => `name = "${name}"

[body]
named = "${name}"

[state]
attitude = [0.0, 0.0, 0.0, 1.0]
angular_velocity = [0.3, 0.3, 1.0]
`;

let library, solved, scene = "", unit = "s", data = null, samples = null;

// The interval that is shown: as of `plot.page`, three periods of the polhode, at most sixty rotations, within the span.
function interval() {
  const start = solved.epoch(), [precession, rotation] = solved.periods("long-axis"), rate = Math.hypot(...solved.state().slice(4)), span = solved.span();
  const bounded = ["integrated", "libration"].includes(solved.method());
  const most = [SHOWN.rotations * TURN / rate, SHOWN.rotations * precession, bounded ? Infinity : SHOWN.periods * rotation].filter(Number.isFinite);
  const stop = start + (most.length ? Math.min(...most) : 1);
  return [start, span.length ? Math.min(stop, span[1]) : stop];
}

function evenly(start, stop, count) {
  const times = new Float64Array(count);
  for (let k = 0; k < count; k++) times[k] = start + (stop - start) * k / (count - 1);
  times[count - 1] = stop;
  return times;
}

// Attitude (4) and rates (3) at a time.
function evaluate(time) {
  const times = Float64Array.of(Math.max(data.start, Math.min(data.stop, time)));
  return [...solved.attitudes(times), ...solved.rates(times)];
}

// A box with these semi-axes, each face in four, so that the octants show.
function box(semiaxes) {
  const vertices = [], faces = [];
  for (let k = 0; k < 3; k++) for (const side of [-1, 1]) for (const a of [0, 1]) for (const b of [0, 1]) {
    const face = [];
    for (const [i, j] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
      const along = [0, 0, 0];
      along[k] = side;
      along[(k + 1) % 3] = side * (a + i - 1);
      along[(k + 2) % 3] = b + j - 1;
      face.push(vertices.length);
      vertices.push(data.axes.reduce((sum, axis, n) => sum.map((part, m) => part + axis[m] * along[n] * semiaxes[n]), [0, 0, 0]));
    }
    faces.push(face);
  }
  return { vertices, faces };
}

// What the view needs beside evaluate(t): the data of a page of `plot.page`.
function describe() {
  const [start, stop] = interval(), moments = [...solved.moments()], all = [...solved.axes()];
  const order = [0, 1, 2].sort((one, other) => moments[one] - moments[other] || one - other);
  const rates = solved.rates(evenly(start, stop, 512)), rotation = solved.periods("long-axis")[1];
  let largestRate = 0;
  for (let k = 0; k < rates.length; k += 3) largestRate = Math.max(largestRate, Math.hypot(rates[k], rates[k + 1], rates[k + 2]));
  const sum = moments[0] + moments[1] + moments[2], semiaxes = moments.map(moment => Math.sqrt(Math.max(sum - 2 * moment, 1e-4 * Math.max(...moments))));
  data = {
    start, stop, moments, order, unit, semiaxes, largestRate,
    axes: [all.slice(0, 3), all.slice(3, 6), all.slice(6, 9)],
    reversed: [[0, 2, 1], [1, 0, 2], [2, 1, 0]].some(odd => odd.every((axis, k) => axis === order[k])),
    polhodeStop: Number.isFinite(rotation) ? Math.min(stop, start + rotation) : stop,
    rotations: largestRate * (stop - start) / TURN,
    facts: [["mode", solved.mode()], ["method", solved.method()]],
  };
  for (const convention of ["extremal-axis", "long-axis", "short-axis"]) {
    const [precession, spin] = solved.periods(convention), shown = period => Number.isFinite(period) ? `${Number(period.toPrecision(8))} ${unit}` : "–";
    data.facts.push([`P_φ, ${convention}`, shown(precession)], [`P_ψ, ${convention}`, shown(spin)]);
  }
  data.facts.push(["E/E₀", String(Number(solved.energy_ratio().toPrecision(8)))], ["error bound", `${solved.error_bound().toPrecision(2)} rad`]);
  if (element("shape").value === "box") data.mesh = box(semiaxes);
  if (held()) {
    const frames = solved.frames(evenly(start, stop, Math.ceil(data.rotations * SHOWN.nodes) + 64), elementsOf()), rows = [];
    for (let k = 0; k < frames.length; k += 4) {
      const row = [...frames.subarray(k, k + 4)], last = rows[rows.length - 1];
      rows.push(last && row.reduce((product, part, n) => product + part * last[n], 0) < 0 ? row.map(part => -part) : row);
    }
    data.orbit = { frames: rows };
  }
}

// Whether the motion is held by its orbit: then it is seen from there.
const held = () => solved.orbits() > 0 && ["integrated", "libration"].includes(solved.method());
const elementsOf = () => /^\s*elements_of\s*=\s*"disturbing"/m.test(scene) ? "disturbing" : "rotating";

// A number of six digits, with an exponent where that is shorter than its field.
const short = value => {
  const text = String(Number(value.toPrecision(6)));
  return text.length > 9 ? value.toExponential(3) : text;
};

// The angles between the body axes and the angular momentum, or the primary.
function sample() {
  const count = Number(element("samples").value), times = evenly(data.start, data.stop, count);
  const attitudes = solved.attitudes(times), frames = held() ? solved.frames(times, elementsOf()) : null, angles = [new Float32Array(count), new Float32Array(count), new Float32Array(count)];
  const [x, y, z, w, ...rates] = evaluate(data.start), momentum = [0, 0, 0];
  data.axes.forEach((axis, k) => { const part = data.moments[k] * (axis[0] * rates[0] + axis[1] * rates[1] + axis[2] * rates[2]); axis.forEach((component, n) => { momentum[n] += part * component; }); });
  const towards = [0, 0, 0], seen = [0, 0, 0], size = Math.hypot(...momentum) || 1;
  inverted(-x, -y, -z, w, momentum.map(part => part / size), towards);
  for (let k = 0, at = 0; k < count; k++, at += 4) {
    if (frames) inverted(-frames[at], -frames[at + 1], -frames[at + 2], frames[at + 3], DOWN, towards);
    inverted(attitudes[at], attitudes[at + 1], attitudes[at + 2], attitudes[at + 3], towards, seen);
    for (let n = 0; n < 3; n++) angles[n][k] = Math.acos(Math.max(-1, Math.min(1, seen[n]))) * 360 / TURN;
  }
  samples = { times, angles };
}

// Axis 3 of "lvlh" points to the primary.
const DOWN = [0, 0, 1];

// The vector turned by the inverse of a quaternion, into `out`.
function inverted(x, y, z, w, vector, out) {
  const [a, b, c] = vector, u = 2 * (b * z - c * y), v = 2 * (c * x - a * z), s = 2 * (a * y - b * x);
  out[0] = a + w * u + v * z - s * y;
  out[1] = b + w * v + s * x - u * z;
  out[2] = c + w * s + u * y - v * x;
}

const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// A canvas in pixels of the screen, empty.
function prepared(canvas) {
  const ratio = window.devicePixelRatio || 1, room = canvas.getBoundingClientRect(), context = canvas.getContext("2d");
  const [width, height] = [room.width, room.height].map(size => Math.round(size * ratio));
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, room.width, room.height);
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "left";
  context.lineWidth = 1;
  context.fillStyle = css("--pale");
  return [context, room.width, room.height];
}

let captioned = "";
const strip = { left: 38, top: 6, below: 20, right: 8 };
function drawStrip() {
  const canvas = element("strip"), [context, width, height] = prepared(canvas), right = width - strip.right, bottom = height - strip.below;
  const across = right - strip.left, vertical = angle => bottom - angle / 180 * (bottom - strip.top);
  context.strokeStyle = css("--line");
  for (const angle of [0, 90, 180]) {
    context.fillText(`${angle}°`, 4, vertical(angle) + 4);
    context.strokeRect(strip.left, vertical(angle), across, 0);
  }
  context.fillText(`${Number(data.start.toPrecision(4))}`, strip.left, height - 4);
  const end = `${Number(data.stop.toPrecision(4))} ${unit}`;
  context.fillText(end, right - context.measureText(end).width, height - 4);
  const count = samples.times.length, columns = Math.max(1, Math.floor(2 * across));
  samples.angles.forEach((angles, axis) => {
    context.strokeStyle = css(AXES[axis]);
    context.lineWidth = 1.4;
    context.beginPath();
    // Each half pixel has one line from its least to its largest angle, in the order in which they come.
    for (let column = 0; column < columns; column++) {
      const from = Math.floor(column * count / columns), to = Math.max(from + 1, Math.floor((column + 1) * count / columns));
      let least = from, most = from;
      for (let k = from; k < to; k++) {
        if (angles[k] < angles[least]) least = k;
        if (angles[k] > angles[most]) most = k;
      }
      const x = strip.left + across * from / (count - 1);
      context.lineTo(x, vertical(angles[Math.min(least, most)]));
      if (least !== most) context.lineTo(x, vertical(angles[Math.max(least, most)]));
    }
    context.stroke();
  });
  const what = held() ? "the direction to the primary" : "the angular momentum";
  const caption = `Angle between ${what} and body axis ${AXES.map((color, k) => `<b style="color: var(${color})">${k + 1}</b>`).join(", ")}`;
  // A caption that is written anew has the page laid out anew.
  if (caption !== captioned) element("strip-caption").innerHTML = captioned = caption;
}

// The moment that the view shows, in the strip.
let marked = null;
function mark() {
  requestAnimationFrame(mark);
  const now = element("view").contentWindow?.andoyer?.now();
  if (now === undefined || now === marked || !data) return;
  marked = now;
  const share = (now - data.start) / (data.stop - data.start);
  element("moment").style.left = `calc(${strip.left}px + ${share} * (100% - ${strip.left + strip.right}px))`;
}

function drawPlane() {
  const [context, width, height] = prepared(element("plane")), left = 26, right = width - 6, top = 6, bottom = height - 20;
  const place = (angle, ratio) => [left + (right - left) * (angle / TURN + 0.5), bottom - (bottom - top) * (ratio + 1) / 2];
  context.strokeStyle = css("--line");
  context.strokeRect(left, top, right - left, bottom - top);
  for (const [text, ratio] of [["1", 1], ["0", 0], ["−1", -1]]) context.fillText(text, 8, place(0, ratio)[1] + 4);
  for (const [text, angle, align] of [["−180°", -0.5, "left"], ["ν", 0, "center"], ["180°", 0.5, "right"]]) {
    context.textAlign = align;
    context.fillText(text, place(angle * TURN, 0)[0], height - 4);
  }
  const [a, b, c] = data.order.map(k => 1 / data.moments[k]);
  // (1 − x²)(a sin²ν + b cos²ν) + c x² = level, with x = N/M and the inverse moments a ≥ b ≥ c.
  const level = (energy, color, wide) => {
    context.strokeStyle = color;
    context.lineWidth = wide;
    // Around the long axis a level has an arc about ±90° alone, which ends at x = 0.
    const end = energy > b ? Math.asin(Math.sqrt((energy - b) / (a - b))) : null;
    const arcs = end === null ? [[-TURN / 2, TURN / 2]] : [[-TURN / 2 + end, -end], [end, TURN / 2 - end]];
    for (const [from, to] of arcs) for (const sign of [1, -1]) {
      context.beginPath();
      for (let k = 0; k <= 240; k++) {
        // Denser at both ends, where the arc is steep.
        const angle = (from + to) / 2 - (to - from) / 2 * Math.cos(Math.PI * k / 240), flat = a * Math.sin(angle) ** 2 + b * Math.cos(angle) ** 2;
        context.lineTo(...place(angle, sign * Math.sqrt(Math.max(0, Math.min(1, (flat - energy) / (flat - c || 1))))));
      }
      context.stroke();
    }
  };
  for (const part of [0.25, 0.6, 0.9]) { if (b > c) level(c + part * (b - c), css("--line"), 1); if (a > b) level(b + (1 - part) * (a - b), css("--line"), 1); }
  level(b, css("--pale"), 1.6);
  const times = evenly(data.start, data.polhodeStop > data.start ? data.polhodeStop : data.stop, 800), rates = solved.rates(times);
  context.strokeStyle = context.fillStyle = css("--polhode");
  context.lineWidth = 2.4;
  context.beginPath();
  let before = null;
  for (let k = 0; k < rates.length; k += 3) {
    const m = data.order.map(n => data.moments[n] * (data.axes[n][0] * rates[k] + data.axes[n][1] * rates[k + 1] + data.axes[n][2] * rates[k + 2])), size = Math.hypot(...m);
    if (!(size > 0)) continue;
    const angle = Math.atan2(data.reversed ? -m[0] : m[0], m[1]), [x, y] = place(angle, m[2] / size);
    context[before !== null && Math.abs(angle - before) < Math.PI ? "lineTo" : "moveTo"](x, y);
    if (k === 0) context.fillRect(x - 3, y - 3, 6, 6);
    before = angle;
  }
  context.stroke();
}

// What is drawn and written after another motion, the sliders and the cost of a sample apart.
function show() {
  describe();
  sample();
  drawStrip();
  drawPlane();
  marked = null;
  element("plan").replaceChildren(...solved.plan().trim().split("\n").map(line => {
    const row = document.createElement("tr");
    for (const text of [line.slice(0, 14).trim(), line.slice(14)]) row.insertCell().append(text);
    return row;
  }));
  const view = element("view");
  if (view.contentWindow?.andoyer) view.contentWindow.andoyer.load(data);
  else if (!view.srcdoc) view.srcdoc = VIEW;
}

function refuse(message) {
  element("problem").textContent = message;
  element("problem").hidden = message === "";
}

const presetOf = text => Object.values(PRESETS).find(preset => preset.toml === text);

// Solves a text and shows it. One that is refused leaves the last motion, with the refusal above it.
function use(text, note = "A scene of your own.") {
  let next;
  try {
    next = new library.Solved(text);
  } catch (error) {
    refuse(error.message);
    return false;
  }
  refuse("");
  solved?.free();
  solved = next;
  scene = text;
  element("note").textContent = presetOf(scene)?.note ?? note;
  for (const button of element("presets").children) button.setAttribute("aria-pressed", String(PRESETS[button.dataset.preset] === presetOf(scene)));
  show();
  later();
  return true;
}

// Some time after the last change: the address, the text, and what a sample costs.
let waiting;
function later() {
  clearTimeout(waiting);
  waiting = setTimeout(() => {
    if (!element("problem").hidden) return;
    history.replaceState(null, "", `#${unit === "s" ? "" : `${unit};`}${encodeURIComponent(scene)}`);
    if (document.activeElement !== element("text")) element("text").value = scene;
    const cost = measure();
    element("cost").textContent = `${cost < 1e-3 ? `${(1e6 * cost).toFixed(0)} ns` : `${(1e3 * cost).toPrecision(3)} µs`} a sample in this browser`;
  }, 250);
}

// Milliseconds that an attitude takes: the least of five runs.
function measure() {
  let least = Infinity;
  for (let run = 0; run < 5; run++) {
    const start = performance.now();
    solved.attitudes(samples.times);
    least = Math.min(least, performance.now() - start);
  }
  return least / samples.times.length;
}

// The three sliders of a vector: body moments or rates.
const GROUPS = { moments: ["moments", () => [...solved.moments()]], rates: ["angular_velocity", () => [...solved.state()].slice(4)] };
function change(group, axis, value) {
  const [key, values] = GROUPS[group], next = values();
  next[axis] = value;
  const line = new RegExp(`^${key} = .*$`, "m"), text = solved.toml();
  return use(text.replace(line, `${key} = [${next.map(number => Number.isInteger(number) ? number.toFixed(1) : String(number)).join(", ")}]`));
}
function sliders() {
  for (const group in GROUPS) for (let axis = 0; axis < 3; axis++) {
    const row = document.createElement("div"), range = document.createElement("input"), number = document.createElement("input"), label = document.createElement("label");
    row.className = "slider";
    range.type = "range";
    number.type = "number";
    number.step = range.step = "any";
    range.id = `${group}-${axis}`;
    label.htmlFor = range.id;
    label.textContent = `${group === "moments" ? "I" : "ω"}${"₁₂₃"[axis]}`;
    label.style.color = `var(${AXES[axis]})`;
    number.setAttribute("aria-label", `${label.textContent} as a number`);
    for (const input of [range, number]) input.oninput = () => { if (input.value !== "" && change(group, axis, Number(input.value))) settle(input); };
    range.onkeydown = event => {
      const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (!way) return;
      event.preventDefault();
      range.value = String(Number(range.value) + way * (Number(range.max) - Number(range.min)) / 100);
      range.oninput();
    };
    row.append(label, range, number);
    element(group).append(row);
  }
}
// The sliders after a change by one of them, or by something else. A moment stays between the difference and the sum of the others.
function settle(moved = null) {
  const moments = GROUPS.moments[1](), rates = GROUPS.rates[1](), tensor = /^\s*inertia\s*=/m.test(scene);
  const largest = Math.max(...moments), rate = Math.hypot(...rates) || 1;
  [...moments, ...rates].forEach((value, k) => {
    const group = k < 3 ? "moments" : "rates", axis = k % 3, [range, number] = element(group).querySelectorAll(".slider")[axis].querySelectorAll("input");
    range.disabled = number.disabled = k < 3 && tensor;
    if (k < 3) {
      const others = moments.filter((_, n) => n !== axis);
      range.min = String(Math.max(Math.abs(others[0] - others[1]), 1e-3 * largest));
      range.max = String(others[0] + others[1]);
    } else if (!moved) {
      range.min = String(-1.5 * rate);
      range.max = String(1.5 * rate);
    }
    if (range !== moved) range.value = String(value);
    if (number !== moved) number.value = short(value);
  });
}

// A preset, an address or a text that replaces the scene.
function replace(text, options = {}) {
  unit = options.unit ?? "s";
  if (options.shape) element("shape").value = options.shape;
  const done = use(text, options.note);
  if (done) settle();
  return done;
}
// An address that somebody cut is no code of a text.
function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}
// The scene of the address. If it is refused, its text is there to be mended.
function fromAddress() {
  const [, given, text] = /^#(?:([a-z]{1,3});)?([^]*)$/.exec(location.hash) ?? [];
  if (!text) return false;
  const toml = decoded(text);
  const done = replace(toml, { unit: given, shape: presetOf(toml)?.shape });
  if (!done) {
    element("text").value = toml;
    document.querySelector("details").open = true;
  }
  return done;
}

const CODE = {
  toml: () => scene,
  python: () => `from pathlib import Path

import numpy as np

from andoyer import Scene

Path("scene.toml").write_text(r'''
${scene}''', encoding="utf-8")
motion = Scene.from_toml("scene.toml").solve()
print(motion.plan)
print(motion.attitude(np.linspace(${data.start}, ${data.stop}, 5)))  # [x, y, z, w]
`,
  rust: () => `use andoyer_propagate::{Error, Scene};

const SCENE: &str = r##"
${scene}"##;

fn main() -> Result<(), Error> {
    let motion = Scene::parse_toml(SCENE, "scene.toml")?.solve()?;
    println!("{}", motion.plan());
    println!("{}", motion.at(${Number.isInteger(data.stop) ? data.stop.toFixed(1) : data.stop})?.attitude);
    Ok(())
}
`,
};
async function copy(language) {
  const text = CODE[language](), box = element("code");
  box.textContent = text;
  box.hidden = false;
  try {
    await navigator.clipboard.writeText(text);
    element("copied").textContent = "Copied.";
  } catch {
    getSelection().selectAllChildren(box);
    element("copied").textContent = "This browser does not copy by itself: the text below is selected.";
  }
}

function controls() {
  for (const [key, preset] of Object.entries(PRESETS)) {
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.preset = key;
    button.textContent = preset.label;
    button.onclick = () => { element("catalogue").value = ""; replace(preset.toml, preset); };
    element("presets").append(button);
  }
  for (const name of library.catalogue()) element("catalogue").append(new Option(name));
  element("catalogue").onchange = ({ target }) => { if (target.value) replace(named(target.value), { shape: "ellipsoid", note: `${target.value}: ${library.source(target.value)}. The state is chosen.` }); };
  element("shape").onchange = element("samples").onchange = () => { show(); later(); };
  element("text").oninput = ({ target }) => { if (use(target.value)) settle(); };
  for (const button of document.querySelectorAll("[data-code]")) button.onclick = () => copy(button.dataset.code);
  window.addEventListener("hashchange", fromAddress);
  window.addEventListener("resize", () => { drawStrip(); drawPlane(); marked = null; });
  sliders();
}

async function start() {
  try {
    library = await import("./andoyer_playground.js");
    await library.default({ module_or_path: new URL("./andoyer_playground_bg.wasm", import.meta.url) });
  } catch (error) {
    refuse(`The library is not beside this page (${error.message}). "make playground" builds it into target/playground; a browser loads it from a server only: python -m http.server.`);
    throw error;
  }
  controls();
  if (!fromAddress()) {
    const refusal = element("problem").textContent;
    replace(PRESETS.flip.toml, PRESETS.flip);
    refuse(refusal);
  }
  requestAnimationFrame(mark);
}

// For the view, and for scripts.
window.playground = { evaluate, change, code: language => CODE[language](), data: () => data, measure, presets: PRESETS, replace, scene: () => scene, solved: () => solved, ready: null };
window.playground.ready = start();
