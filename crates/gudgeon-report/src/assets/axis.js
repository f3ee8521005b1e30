"use strict";
// Scales of an axis. Each has `to` (value to pixels), `back` (pixels to value) and `ticks`.

// Ends of some arrays of [values, factor], those that are numbers; `tiny` is the smallest magnitude above zero.
function extent(all, inside) {
  let lo = Infinity, hi = -Infinity, tiny = Infinity;
  for (const [values, f, x] of all) {
    for (let i = 0; i < values.length; i++) {
      if (inside && x && !inside(x[i])) continue;
      const v = values[i] * f;
      if (!isNumber(v)) continue;
      if (v < lo) lo = v;
      if (v > hi) hi = v;
      const m = Math.abs(v);
      if (m > 0 && m < tiny) tiny = m;
    }
  }
  return lo > hi ? { lo: 0, hi: 1, tiny: 1 } : { lo, hi, tiny };
}

function linearScale(lo, hi, a, b, room) {
  if (!(hi > lo)) { const d = Math.abs(hi) || 1; lo -= d / 2; hi += d / 2; }
  const k = (b - a) / (hi - lo);
  return { lo, hi, to: (v) => a + k * (v - lo), back: (p) => lo + (p - a) / k, ticks: linearTicks(lo, hi, Math.max(2, Math.abs(b - a) / room)) };
}

function logScale(lo, hi, a, b) {
  if (hi / lo < 1.1) { lo /= 1.05; hi *= 1.05; }
  const k = (b - a) / Math.log(hi / lo);
  return { lo, hi, to: (v) => (v > 0 ? a + k * Math.log(v / lo) : NaN), back: (p) => lo * Math.exp((p - a) / k), ticks: logTicks(lo, hi) };
}

// Straight through zero up to a thousandth of the largest value, by decades beyond.
function signedLogScale(lo, hi, a, b) {
  const m = Math.max(Math.abs(lo), Math.abs(hi)) || 1, part = 10 ** Math.floor(Math.log10(m) - 2.7);
  const f = (v) => Math.asinh(v / part / 2);
  lo = Math.min(lo, 0); hi = Math.max(hi, 0);
  const range = f(hi) - f(lo) || 1, from = f(lo) - 0.05 * range, k = (b - a) / (1.1 * range), ticks = [0];
  for (let p = part; p <= m; p *= 10) { if (p <= hi) ticks.push(p); if (-p >= lo) ticks.push(-p); }
  return { lo, hi, to: (v) => a + k * (f(v) - from), back: (p) => 2 * part * Math.sinh((p - a) / k + from), ticks };
}

// The ordinate of a chart for the values `e` in the mode "linear", "log", "±log" or "difference", between the pixels `bottom` and `top`.
function ordinate(mode, e, { zero, end, bottom, top }) {
  let { lo, hi } = e;
  if (end !== undefined) { hi = end; lo = Math.min(lo, 0); }
  if (mode === "log" && hi > 0) {
    if (lo <= 0) lo = Math.max(e.tiny, hi * 1e-6);
    const pad = Math.max(1.05, (hi / lo) ** 0.04);
    return logScale(lo / pad, hi * pad, bottom, top);
  }
  if (mode === "±log") return signedLogScale(lo, hi, bottom, top);
  if (zero === "near") {
    // Zero belongs to the picture unless the values vary little beside their size.
    if (lo > 0 && lo < 0.6 * hi) lo = 0;
    if (hi < 0 && hi > 0.6 * lo) hi = 0;
  } else if (zero !== false) { lo = Math.min(lo, 0); hi = Math.max(hi, 0); }
  if (!(hi > lo)) { const d = Math.abs(hi) || 1; lo -= d / 2; hi += d / 2; }
  const pad = end === undefined ? (hi - lo) * 0.05 : 0;
  if (lo !== 0 || zero === false) lo -= pad;
  if (hi !== 0 || zero === false) hi += pad;
  return linearScale(lo, hi, bottom, top, 42);
}
