// Curves over the crank angle. Drag zooms every plot, a click pins the angle, a double click shows the whole cycle.
//
// spec: { title, hint, unit, lines: [{ label, x, y, color, dash, thin }], modes: ["linear", "log", "±log"], zero, lanes,
//         height, events: [{ t, color, text }] }. y is in SI and is shown in the unit that `display` picks.
function plot(host, cycle, spec) {
  const L = 62, T = 14, B = 36, R = 16;
  const unit = spec.scale || display(spec.unit, Math.max(...spec.lines.map((l) => maxAbs(l.y))));
  let mode = (spec.modes || ["linear"])[0];
  const largest = spec.lines.map((l) => maxAbs(l.y) * unit.f);
  const hidden = new Set();
  const svg = s("svg", { role: "img", "aria-label": spec.title });
  const legend = h("div", { class: "legend" });
  const head = h("div", { class: "head" }, h("h3", {}, spec.title), h("p", { class: "hint" }, spec.hint || ""));
  const modeButtons = (spec.modes || []).length > 1 ? spec.modes.map((m) => h("button", { type: "button", onclick: () => { mode = m; draw(); } }, m)) : [];
  head.append(...modeButtons);
  host.append(h("div", { class: "plot" }, head, h("div", { class: "body" }, h("div", {}, svg), legend)));

  const values = spec.lines.map((line, i) => {
    const swatch = s("svg", { width: 24, height: 10, viewBox: "0 0 24 10" });
    s("line", { x1: 0, x2: 24, y1: 5, y2: 5, style: "stroke:" + line.color + ";stroke-width:2.4", "stroke-dasharray": line.dash || "none" }, swatch);
    const v = h("span", { class: "v" });
    const b = h("button", { type: "button", "aria-pressed": "true", title: "show or hide" + (line.title ? ": " + line.title : ""), onclick: () => {
      if (hidden.has(i)) hidden.delete(i); else hidden.add(i);
      b.setAttribute("aria-pressed", String(!hidden.has(i)));
      draw();
    } }, swatch, h("span", { class: "name" }, line.label), v);
    legend.append(b);
    return v;
  });
  const nearby = h("div", { class: "events" });
  if ((spec.events || []).length) legend.append(nearby);

  // "difference" shows every curve less the first one.
  const shown = (line) => {
    if (mode !== "difference") return line.y;
    const first = spec.lines[0];
    if (!line.less) line.less = line === first ? new Float32Array(line.y.length) : line.y.map((v, i) => v - at(first.x, first.y, line.x[i]));
    return line.less;
  };
  const H = spec.lanes ? T + B + spec.lines.length * 62 : spec.height || 220;
  let W = 0, X, Y = [], drag = null, cursor, dots = [], box;
  const invert = (px) => cycle.view[0] + ((px - L) / (W - L - R)) * (cycle.view[1] - cycle.view[0]);

  function draw() {
    W = svg.parentNode.clientWidth;
    if (!W) return;
    svg.replaceChildren();
    set(svg, { viewBox: `0 0 ${W} ${H}`, height: H });
    for (const b of modeButtons) b.setAttribute("aria-pressed", String(b.textContent === mode));
    const [lo, hi] = cycle.view;
    X = (t) => L + ((t - lo) / (hi - lo)) * (W - L - R);
    const bottom = H - B;
    // Strokes as bands, dead centres as lines.
    for (let k = Math.floor(lo / 180); k * 180 < hi; k++) {
      if (((k % 2) + 2) % 2) continue;
      const a = Math.max(lo, k * 180), b = Math.min(hi, (k + 1) * 180);
      s("rect", { x: X(a), y: T, width: X(b) - X(a), height: bottom - T, class: "band" }, svg);
    }
    const span = hi - lo, step = [1, 2, 5, 10, 15, 30, 45, 90, 180].find((d) => span / d <= Math.max(4, (W - L) / 75)) || 180;
    for (let t = Math.ceil(lo / step - 1e-9) * step; t <= hi + 1e-6; t += step) {
      s("line", { x1: X(t), x2: X(t), y1: T, y2: bottom, class: "gridline" }, svg);
      s("text", { x: X(t), y: bottom + 15, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
    }
    // The firing dead centre is named first, then the others; a name gives way where there is no room.
    const named = [], rank = (d) => ["firing TDC", "gas exchange TDC", "TDC", "BDC"].indexOf(d.name);
    for (const d of deadCentres(lo, hi, cycle.four).sort((a, b) => rank(a) - rank(b))) {
      s("line", { x1: X(d.t), x2: X(d.t), y1: T, y2: bottom, class: d.name === "firing TDC" ? "firing" : "dead" }, svg);
      const anchor = X(d.t) > W - 60 ? "end" : X(d.t) < L + 40 ? "start" : "middle", width = 6.2 * d.name.length;
      const x = anchor === "end" ? W - 2 : anchor === "start" ? Math.max(2, X(d.t) - 12) : X(d.t);
      const left = anchor === "end" ? x - width : anchor === "start" ? x : x - width / 2;
      if (named.some(([a, b]) => left < b + 4 && left + width > a - 4)) continue;
      named.push([left, left + width]);
      s("text", { x, y: bottom + 29, "text-anchor": anchor, class: "dim" }, svg, d.name);
    }
    if (spec.lanes) lanes(bottom); else axis(bottom);
    s("rect", { x: L, y: T, width: W - L - R, height: bottom - T, class: "frame" }, svg);
    // Events as marks along the top edge.
    for (const e of spec.events || []) {
      if (e.t < lo || e.t > hi) continue;
      const g = s("path", { d: `M${X(e.t)},${T}l-4,-7h8z`, style: "fill:" + e.color }, svg);
      s("title", {}, g, e.t.toFixed(1) + "° " + e.text);
    }
    box = s("rect", { y: T, height: bottom - T, width: 0, class: "drag" }, svg);
    cursor = s("line", { y1: T, y2: bottom, class: "cursor" }, svg);
    dots = spec.lines.map((l) => s("circle", { r: 3.2, style: "fill:" + l.color + ";stroke:var(--bg);pointer-events:none" }, svg));
    follow();
  }

  function clip(top, bottom) {
    const id = "clip" + (plot.n = (plot.n || 0) + 1);
    s("rect", { x: L, y: top, width: W - L - R, height: bottom - top }, s("clipPath", { id }, svg));
    return `url(#${id})`;
  }
  function curve(line, y, clipPath, fillTo) {
    const [lo, hi] = cycle.view, n = line.x.length, value = shown(line);
    let d = "", pen = false, first = 0, lastX = 0;
    for (let i = 0; i < n; i++) {
      if ((i + 1 < n && line.x[i + 1] < lo) || (i > 0 && line.x[i - 1] > hi)) continue;
      const v = y(value[i] * unit.f);
      if (!isNumber(v)) { pen = false; continue; }
      const px = X(line.x[i]);
      if (!pen && !d) first = px;
      lastX = px;
      d += (pen ? "L" : "M") + px.toFixed(1) + "," + v.toFixed(1);
      pen = true;
    }
    if (!d) return;
    if (fillTo !== undefined) s("path", { d: d + `L${lastX},${fillTo}L${first},${fillTo}Z`, style: "fill:" + line.color + ";opacity:.16", "clip-path": clipPath }, svg);
    s("path", { d, class: "line", style: "stroke:" + line.color + (line.thin ? ";stroke-width:1.2" : ""), "stroke-dasharray": line.dash || "none", "clip-path": clipPath }, svg);
  }

  function axis(bottom) {
    let lo = Infinity, hi = -Infinity, tiny = Infinity;
    spec.lines.forEach((line, i) => {
      if (hidden.has(i)) return;
      const value = shown(line);
      for (let k = 0; k < line.x.length; k++) {
        if (line.x[k] < cycle.view[0] || line.x[k] > cycle.view[1]) continue;
        const v = value[k] * unit.f;
        if (!isNumber(v)) continue;
        lo = Math.min(lo, v); hi = Math.max(hi, v);
        if (v !== 0) tiny = Math.min(tiny, Math.abs(v));
      }
    });
    if (lo > hi) { lo = 0; hi = 1; }
    let y, ticks, scale = mode;
    if (mode === "log" && hi <= 0) scale = "linear";
    if (scale === "log") {
      if (lo <= 0) lo = Math.max(tiny, hi * 1e-6);
      const pad = Math.max(1.05, (hi / lo) ** 0.04);
      lo /= pad; hi *= pad;
      const k = (bottom - T) / Math.log(hi / lo);
      y = (v) => (v > 0 ? bottom - k * Math.log(v / lo) : NaN);
      ticks = logTicks(lo, hi);
    } else if (scale === "±log") {
      // Straight through zero up to a thousandth of the largest value, by decades beyond.
      const m = Math.max(Math.abs(lo), Math.abs(hi)) || 1, unitPart = 10 ** Math.floor(Math.log10(m) - 2.7);
      const f = (v) => Math.asinh(v / unitPart / 2);
      lo = Math.min(lo, 0); hi = Math.max(hi, 0);
      const a = f(lo) - 0.05 * (f(hi) - f(lo) || 1), k = (bottom - T) / (1.1 * (f(hi) - f(lo) || 1));
      y = (v) => bottom - k * (f(v) - a);
      ticks = [0];
      for (let p = unitPart; p <= m; p *= 10) { if (p <= hi) ticks.push(p); if (-p >= lo) ticks.push(-p); }
    } else {
      if (spec.zero !== false) { lo = Math.min(lo, 0); hi = Math.max(hi, 0); }
      if (hi === lo) { const d = Math.abs(hi) || 1; lo -= d / 2; hi += d / 2; }
      const pad = (hi - lo) * 0.05;
      if (lo !== 0 || spec.zero === false) lo -= pad;
      if (hi !== 0 || spec.zero === false) hi += pad;
      const k = (bottom - T) / (hi - lo);
      y = (v) => bottom - k * (v - lo);
      ticks = linearTicks(lo, hi, (bottom - T) / 42);
    }
    // Zero is labelled first, then the largest: small ticks give way where there is no room.
    const taken = [];
    for (const t of ticks.sort((a, b) => (a === 0 ? -1 : b === 0 ? 1 : Math.abs(b) - Math.abs(a)))) {
      const py = y(t);
      if (py > bottom + 0.5 || py < T - 0.5) continue;
      s("line", { x1: L, x2: W - R, y1: py, y2: py, class: t === 0 ? "zeroline" : "gridline" }, svg);
      if (taken.some((q) => Math.abs(q - py) < 13)) continue;
      s("text", { x: L - 7, y: py + 4, "text-anchor": "end", class: "dim" }, svg, tickText(t));
      taken.push(py);
    }
    s("text", { x: L - 7, y: T - 3, "text-anchor": "end" }, svg, unit.label);
    const c = clip(T, bottom);
    Y = [];
    spec.lines.forEach((line, i) => {
      Y[i] = hidden.has(i) ? null : y;
      if (!hidden.has(i)) curve(line, y, c);
    });
  }

  function lanes(bottom) {
    const n = spec.lines.length - hidden.size, height = (bottom - T) / Math.max(1, n);
    let k = 0;
    spec.lines.forEach((line, i) => {
      if (hidden.has(i)) { Y[i] = null; return; }
      const top = T + k * height + 11, low = T + (k + 1) * height - 9;
      k++;
      Y[i] = (v) => low + (top - low) * v;
      for (const [v, name] of [[0, "lower"], [1, "upper"]]) {
        s("line", { x1: L, x2: W - R, y1: Y[i](v), y2: Y[i](v), class: "gridline", style: "stroke:var(--line)" }, svg);
        s("text", { x: L - 7, y: Y[i](v) + 4, "text-anchor": "end", class: "dim" }, svg, name);
      }
      s("text", { x: 2, y: (top + low) / 2 + 4, style: "fill:" + line.color, class: "strong" }, svg, line.short || line.label);
      curve(line, Y[i], clip(top - 6, low + 6), low);
    });
  }

  function follow() {
    if (!W) return;
    const t = cycle.shown, seen = t >= cycle.view[0] && t <= cycle.view[1];
    set(cursor, { x1: X(t), x2: X(t), visibility: seen ? "visible" : "hidden" });
    spec.lines.forEach((line, i) => {
      const v = at(line.x, shown(line), t) * unit.f, py = Y[i] ? Y[i](v) : NaN;
      set(dots[i], isNumber(py) && seen ? { cx: X(t), cy: clamp(py, T, H - B), visibility: "visible" } : { visibility: "hidden" });
      values[i].textContent = sig(Math.abs(v) < 1e-7 * largest[i] ? 0 : v, 4);
      if (unit.label) values[i].append(h("span", { class: "u" }, " " + unit.label));
    });
    const near = (spec.events || []).filter((e) => Math.abs(e.t - t) <= 4);
    nearby.textContent = near.slice(0, 2).map((e) => e.t.toFixed(1) + "° " + e.text).join("; ");
  }

  const where = (e) => { const r = svg.getBoundingClientRect(); return ((e.clientX - r.left) / r.width) * W; };
  svg.addEventListener("pointermove", (e) => {
    const px = clamp(where(e), L, W - R);
    if (drag !== null) set(box, { x: Math.min(drag, px), width: Math.abs(px - drag) });
    cycle.hover(invert(px));
  });
  svg.addEventListener("pointerleave", () => { if (drag === null) cycle.hover(null); });
  svg.addEventListener("pointerdown", (e) => {
    if (e.button) return;
    drag = clamp(where(e), L, W - R);
    svg.setPointerCapture(e.pointerId);
  });
  svg.addEventListener("pointerup", (e) => {
    if (drag === null) return;
    const px = clamp(where(e), L, W - R), a = invert(Math.min(drag, px)), b = invert(Math.max(drag, px));
    const far = Math.abs(px - drag) > 6;
    drag = null;
    set(box, { width: 0 });
    if (far && b - a > 0.5) cycle.zoom(a, b);
    else { cycle.play(false); cycle.pin(invert(px)); }
  });
  svg.addEventListener("pointercancel", () => { drag = null; set(box, { width: 0 }); });
  svg.addEventListener("dblclick", () => cycle.zoom(cycle.lo, cycle.hi));
  new ResizeObserver(() => { if (svg.parentNode.clientWidth !== W) draw(); }).observe(svg.parentNode);
  addEventListener("beforeprint", draw);
  cycle.on((what) => { if (what & 2) draw(); else follow(); });
}

// Columns that no curated plot took, grouped by unit and by size so that one curve does not flatten another.
function leftovers(columns) {
  const groups = [];
  for (const c of columns) {
    const m = maxAbs(c.y);
    const g = groups.find((g) => g.unit === c.unit && g.columns.length < 8 && (m === 0 || g.max === 0 || (m / g.max < 30 && g.max / m < 30)));
    if (g) { g.columns.push(c); g.max = Math.max(g.max, m); }
    else groups.push({ unit: c.unit, max: m, columns: [c] });
  }
  return groups;
}
