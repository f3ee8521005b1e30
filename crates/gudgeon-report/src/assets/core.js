"use strict";
// What every page uses: its data, elements, numbers, units, and the shared crank angle.
const DATA = JSON.parse(document.getElementById("data").textContent);

function unpack(text) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}
const arrays = (DATA.arrays || []).map(unpack);

function h(tag, attributes, ...children) {
  const e = document.createElement(tag);
  for (const k in attributes || {}) {
    if (k.startsWith("on")) e.addEventListener(k.slice(2), attributes[k]);
    else if (attributes[k] !== undefined && attributes[k] !== null) e.setAttribute(k, attributes[k]);
  }
  e.append(...children.filter((c) => c !== null && c !== undefined));
  return e;
}
function s(tag, attributes, parent, text) {
  const e = document.createElementNS("http://www.w3.org/2000/svg", tag);
  set(e, attributes);
  if (text !== undefined) e.textContent = text;
  if (parent) parent.append(e);
  return e;
}
function set(e, attributes) {
  for (const k in attributes || {}) e.setAttribute(k, attributes[k]);
}

const color = (i) => "var(--c" + (((i % 8) + 8) % 8) + ")";
const clamp = (x, lo, hi) => Math.min(hi, Math.max(lo, x));
const isNumber = (x) => typeof x === "number" && isFinite(x);

function powerOfTen(e) {
  return "10" + String(e).replace(/[-0-9]/g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻");
}
// A number with n significant digits, with a true minus sign.
function sig(x, n) {
  n = n || 4;
  if (!isNumber(x)) return "–";
  if (x === 0) return "0";
  const e = Math.floor(Math.log10(Math.abs(x)));
  let t;
  if (e < -4 || e > 6) {
    const [m, p] = x.toExponential(n - 1).split("e");
    t = m + "×" + powerOfTen(+p);
  } else t = x.toFixed(Math.max(0, n - 1 - e));
  return t.replace(/-/g, "−");
}
function tickText(x) {
  const a = Math.abs(x);
  // As many digits as it has: steps of 2.5 are among them.
  if (a !== 0 && (a >= 1e6 || a < 1e-4)) return sig(x, [1, 2, 3].find((n) => Math.abs(x.toPrecision(n) / x - 1) < 1e-6) || 4);
  return String(+x.toPrecision(10)).replace("-", "−");
}

// The unit a person would plot `unit` in, for values up to `max`: {f: factor, label}.
function display(unit, max) {
  const pick = (list) => {
    for (const [limit, f, label] of list) if (max < limit) return { f, label };
    const last = list[list.length - 1];
    return { f: last[1], label: last[2] };
  };
  switch (unit) {
    case "Pa": return { f: 1e-5, label: "bar" };
    case "m": return pick([[2e-3, 1e6, "µm"], [2, 1e3, "mm"], [Infinity, 1, "m"]]);
    case "m/s": return pick([[2e-3, 1e6, "µm/s"], [0.5, 1e3, "mm/s"], [Infinity, 1, "m/s"]]);
    case "m/s2": return { f: 1, label: "m/s²" };
    case "kg/s": return pick([[1e-6, 1e9, "µg/s"], [2e-3, 1e6, "mg/s"], [2, 1e3, "g/s"], [Infinity, 1, "kg/s"]]);
    case "m3/s": return pick([[2e-6, 1e9, "mm³/s"], [2e-3, 1e6, "cm³/s"], [Infinity, 1, "m³/s"]]);
    case "m3": return pick([[2e-6, 1e9, "mm³"], [2e-2, 1e6, "cm³"], [Infinity, 1, "m³"]]);
    case "kg": return pick([[1e-7, 1e9, "µg"], [1e-4, 1e6, "mg"], [1, 1e3, "g"], [Infinity, 1, "kg"]]);
    case "N": return pick([[5e4, 1, "N"], [Infinity, 1e-3, "kN"]]);
    case "N/m": return pick([[5e4, 1, "N/m"], [Infinity, 1e-3, "kN/m"]]);
    case "s": return pick([[2e-3, 1e6, "µs"], [2, 1e3, "ms"], [Infinity, 1, "s"]]);
    case "W": return pick([[5e3, 1, "W"], [Infinity, 1e-3, "kW"]]);
    case "J": return pick([[1e-2, 1e3, "mJ"], [5e3, 1, "J"], [Infinity, 1e-3, "kJ"]]);
    case "N m": case "Nm": return pick([[5e3, 1, "N·m"], [Infinity, 1e-3, "kN·m"]]);
    case "s": return pick([[2e-3, 1e6, "µs"], [2, 1e3, "ms"], [Infinity, 1, "s"]]);
    case "Pa s": return pick([[2, 1e3, "mPa·s"], [Infinity, 1, "Pa·s"]]);
    case "um": return { f: 1, label: "µm" };
    case "K": return { f: 1, label: "K" };
    case "deg": return { f: 1, label: "°" };
    case "rad": return pick([[0.1, 1e3, "mrad"], [Infinity, 1, "rad"]]);
    case "rad/s": return { f: 1, label: "rad/s" };
    case "-": case "1": case "": return { f: 1, label: "" };
    default: return { f: 1, label: unit.replace(/2$/, "²").replace(/3$/, "³") };
  }
}
function maxAbs(y) {
  let m = 0;
  for (const v of y) if (v > m) m = v; else if (-v > m) m = -v;
  return m;
}

function niceStep(range, n) {
  const raw = range / Math.max(1, n), p = 10 ** Math.floor(Math.log10(raw));
  for (const k of [1, 2, 2.5, 5, 10]) if (k * p >= raw * 0.999) return k * p;
  return 10 * p;
}
function linearTicks(lo, hi, n) {
  const step = niceStep(hi - lo, n), out = [];
  for (let k = Math.ceil(lo / step - 1e-9); k * step <= hi + step * 1e-9; k++) out.push(k * step);
  return out;
}
function logTicks(lo, hi) {
  const decades = Math.log10(hi / lo), out = [];
  const steps = decades < 1.2 ? [1, 2, 3, 5, 7] : decades < 3.2 ? [1, 2, 5] : [1];
  const every = Math.max(1, Math.ceil(decades / 8));
  for (let e = Math.floor(Math.log10(lo)); e <= Math.ceil(Math.log10(hi)); e++) {
    if (steps.length === 1 && e % every) continue;
    for (const k of steps) { const t = k * 10 ** e; if (t >= lo * 0.999 && t <= hi * 1.001) out.push(t); }
  }
  return out;
}

// Value of y at angle t on the rising grid x, straight between rows.
function at(x, y, t) {
  let a = 0, b = x.length - 1;
  if (b < 0) return NaN;
  if (t <= x[0]) return y[0];
  if (t >= x[b]) return y[b];
  while (b - a > 1) { const m = (a + b) >> 1; if (x[m] <= t) a = m; else b = m; }
  const f = (t - x[a]) / (x[b] - x[a] || 1);
  return y[a] + f * (y[b] - y[a]);
}

// The dead centres between two angles, by name.
function deadCentres(lo, hi, four) {
  const out = [];
  for (let t = Math.ceil(lo / 180 - 1e-9) * 180; t <= hi + 1e-6; t += 180) {
    const m = ((t % 720) + 720) % 720;
    out.push({ t, name: m % 360 === 180 ? "BDC" : !four ? "TDC" : m === 360 ? "firing TDC" : "gas exchange TDC" });
  }
  return out;
}
function angleName(t, four) {
  const m = ((t % 720) + 720) % 720;
  const near = Math.round(m / 180) * 180, d = m - near;
  const name = near % 360 === 180 ? "BDC" : !four ? "TDC" : near === 360 ? "firing TDC" : "gas exchange TDC";
  const where = Math.abs(d) < 0.05 ? "at " + name : sig(Math.abs(d), Math.abs(d) < 10 ? 2 : 3) + "° " + (d < 0 ? "before " : "after ") + name;
  if (!four) return where;
  return ["intake", "compression", "expansion", "exhaust"][Math.floor(m / 180) % 4] + ", " + where;
}

// The one of this page, where it has one.
let CYCLE = null;
// The crank angle all drawings share. `shown` follows the pointer while it is over a plot, else it is the pinned angle.
class Cycle {
  constructor(lo, hi, step, start) {
    start = start === undefined ? lo : clamp(start, lo, hi);
    Object.assign(this, { lo, hi, step, pinned: start, shown: start, view: [lo, hi], playing: false, speed: 60 });
    // A four-stroke cycle, unless the curves span no more than one turn.
    this.four = hi - lo > 540;
    this.listeners = [];
    this.dirty = 0;
    this.readHash();
    addEventListener("hashchange", () => { this.readHash(); this.changed(3); });
  }
  // Links may name an angle and a range: report.html#theta=380&view=300,480
  readHash() {
    const q = new URLSearchParams(location.hash.slice(1));
    const t = parseFloat(q.get("theta"));
    if (isNumber(t)) this.pinned = this.shown = clamp(t, this.lo, this.hi);
    const [a, b] = (q.get("view") || "").split(",").map(parseFloat);
    if (isNumber(a) && isNumber(b) && b > a) this.view = [clamp(a, this.lo, this.hi), clamp(b, this.lo, this.hi)];
  }
  on(f) { this.listeners.push(f); f(3); }
  // 1: the angle changed, 2: the visible range changed.
  changed(what) {
    if (!this.dirty) requestAnimationFrame(() => { const d = this.dirty; this.dirty = 0; for (const f of this.listeners) f(d); });
    this.dirty |= what;
  }
  pin(t) { this.pinned = this.shown = clamp(t, this.lo, this.hi); this.changed(1); }
  hover(t) { if (this.playing) return; this.shown = t === null ? this.pinned : clamp(t, this.lo, this.hi); this.changed(1); }
  zoom(a, b) { this.view = [Math.max(this.lo, a), Math.min(this.hi, b)]; this.changed(2); }
  get zoomed() { return this.view[0] > this.lo || this.view[1] < this.hi; }
  play(on) {
    this.playing = on;
    let last = null;
    const frame = (now) => {
      if (!this.playing) return;
      if (last !== null) {
        const [a, b] = this.zoomed ? this.view : [this.lo, this.hi];
        let t = this.pinned + (this.speed * Math.min(100, now - last)) / 1000;
        if (t > b || t < a) t = a;
        this.pin(t);
      }
      last = now;
      requestAnimationFrame(frame);
    };
    if (on) requestAnimationFrame(frame);
    this.changed(1);
  }
}

// Play button, slider, angle, zoom reset.
function cycleBar(host, cycle) {
  const range = h("input", { type: "range", min: cycle.lo, max: cycle.hi, step: cycle.step, "aria-label": "crank angle in degrees",
    oninput: () => { cycle.play(false); cycle.pin(+range.value); } });
  const play = h("button", { class: "play", type: "button", title: "play or pause (space)", onclick: () => cycle.play(!cycle.playing) });
  const speed = h("select", { "aria-label": "speed", onchange: () => { cycle.speed = +speed.value; } },
    ...[[10, "10°/s"], [30, "30°/s"], [60, "60°/s"], [180, "180°/s"]].map(([v, t]) => h("option", { value: v }, t)));
  speed.value = "60";
  const reset = h("button", { type: "button", onclick: () => cycle.zoom(cycle.lo, cycle.hi) }, "Reset zoom");
  const angle = h("b"), name = h("small");
  const track = h("div", { class: "track" }, range);
  for (const d of deadCentres(cycle.lo, cycle.hi, cycle.four)) {
    const x = (d.t - cycle.lo) / (cycle.hi - cycle.lo);
    track.append(h("span", { style: "left:calc(8px + (100% - 16px)*" + x + ")" }, d.t + "° " + d.name.replace("gas exchange ", "")));
  }
  host.className = "bar";
  host.append(h("div", { class: "left" }, play, speed, reset), track, h("div", { class: "now" }, angle, name));
  cycle.on(() => {
    range.value = cycle.shown;
    play.textContent = cycle.playing ? "❚❚ Pause" : "▶ Play";
    reset.style.visibility = cycle.zoomed ? "visible" : "hidden";
    angle.textContent = cycle.shown.toFixed(cycle.step < 0.1 ? 2 : 1) + "°";
    name.textContent = angleName(cycle.shown, cycle.four);
  });
  addEventListener("keydown", (e) => {
    if (e.altKey || e.ctrlKey || e.metaKey || /^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName)) return;
    const by = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
    if (by) { cycle.play(false); cycle.pin(Math.round(cycle.pinned + by * (e.shiftKey ? 10 : 1))); e.preventDefault(); }
    else if (e.key === " " && !/^(BUTTON|SUMMARY)$/.test(e.target.tagName)) { cycle.play(!cycle.playing); e.preventDefault(); }
  });
}

// On paper, what a reader must be able to check is unfolded: inputs, models, sources and assumptions.
const printed = "#inputs > details, #skipped > details, #models > details, #sources > details";
addEventListener("beforeprint", () => { for (const d of document.querySelectorAll(printed)) if (!d.open) { d.open = true; d.dataset.printed = ""; } });
addEventListener("afterprint", () => { for (const d of document.querySelectorAll("details[data-printed]")) { d.open = false; delete d.dataset.printed; } });
