// Curves. One core for all: over the crank angle, where all charts share angle and range, and over anything else.
//
// spec: { title, hint, lines: [{ label, title, x, y, unit, color, dash, thin }], modes: ["linear", "log", "±log"], zero, height, unit,
//         cycle                      the shared crank angle, or
//         xName, xUnit, logX         what the abscissa is
//         lanes                      each curve in a strip of its own, from 0 to 1
//         events: [{ t, color, text }], rays: [{ label, x, y }], marks: [...], top, yName, scatter }
// x and y are in SI and are shown in the unit that `display` picks. Drag zooms, a double click shows all again; a click pins the angle.
let charts = 0;
class Chart {
  constructor(host, spec) {
    const lines = spec.lines;
    this.spec = spec;
    this.id = "chart" + ++charts;
    this.ux = spec.cycle ? { f: 1, label: "°" } : display(spec.xUnit, Math.max(...lines.map((l) => maxAbs(l.x))));
    this.uy = spec.scale || display(spec.unit || lines[0].unit, Math.max(...lines.map((l) => maxAbs(l.y))));
    this.modes = spec.modes || ["linear"];
    this.mode = this.modes[0];
    this.logX = spec.logX;
    this.hidden = new Set();
    this.view = null;
    // A closed curve has no one value at an abscissa.
    this.readable = lines.every((l) => { for (let i = 1; i < l.x.length; i++) if (l.x[i] < l.x[i - 1]) return false; return true; });
    this.svg = s("svg", { role: "img", tabindex: "0", "aria-label": this.told() });
    const buttons = this.toggles();
    this.legend = h("div", { class: "legend" });
    this.here = h("div", { class: "events" });
    this.values = lines.map((l, i) => this.entry(l, i));
    if (lines.length) this.legend.append(this.here);
    const head = h("div", { class: "head" }, h("h3", { id: this.id }, spec.title), h("div", { class: "tools" }, ...buttons, saveMenu(this.svg, spec)));
    const hint = spec.hint ? h("p", { class: "hint" }, spec.hint) : null;
    this.frame = h("div", { class: "drawn" }, this.svg);
    host.append(h("figure", { class: "plot" + (spec.wide ? " wide" : "") }, head, hint, this.legend, this.frame));
    this.listen();
    new ResizeObserver(() => { if (this.frame.clientWidth !== this.W) this.draw(); }).observe(this.frame);
    if (spec.cycle) spec.cycle.on((d) => { if (d & 2) this.draw(); else this.follow(); });
    else this.draw();
  }

  // What a person hears who does not see the figure.
  told() {
    const { title, lines, xName } = this.spec, u = this.uy;
    const each = lines.slice(0, 12).map((l) => {
      const e = extent([[l.y, u.f]]);
      return `${l.label} from ${sig(e.lo, 3)} to ${sig(e.hi, 3)} ${u.label}`;
    });
    return `${title}, over ${this.spec.cycle ? "the crank angle" : xName}: ${each.join("; ")}`;
  }

  toggles() {
    const out = [];
    const toggle = (text, on, go) => {
      const b = h("button", { type: "button", onclick: () => { go(); this.draw(); } }, text);
      b.pressed = on;
      out.push(b);
    };
    if (this.modes.length > 1) for (const m of this.modes) toggle(m, () => this.mode === m, () => { this.mode = m; });
    if (this.spec.pickX) toggle("log x", () => !!this.logX, () => { this.logX = !this.logX; this.view = null; });
    this.buttons = out;
    return out;
  }

  entry(line, i) {
    const swatch = s("svg", { width: 22, height: 10, viewBox: "0 0 22 10", "aria-hidden": "true" });
    s("line", { x1: 0, x2: 22, y1: 5, y2: 5, style: "stroke:" + line.color + ";stroke-width:2.4", "stroke-dasharray": line.dash || "none" }, swatch);
    const v = h("span", { class: "v" });
    const b = h("button", { type: "button", "aria-pressed": "true", title: "show or hide" + (line.title ? ": " + line.title : ""), onclick: () => {
      if (!this.hidden.delete(i)) this.hidden.add(i);
      b.setAttribute("aria-pressed", String(!this.hidden.has(i)));
      this.draw();
    } }, swatch, h("span", { class: "name" }, line.label), v);
    this.legend.append(b);
    return v;
  }

  // "difference" shows every curve less the first one.
  shown(line) {
    if (this.mode !== "difference") return line.y;
    const first = this.spec.lines[0];
    if (!line.less) line.less = line === first ? new Float32Array(line.y.length) : line.y.map((v, i) => v - at(first.x, first.y, line.x[i]));
    return line.less;
  }
  visible() { return this.spec.lines.filter((_, i) => !this.hidden.has(i)); }
  range() {
    if (this.spec.cycle) return this.spec.cycle.view;
    if (this.view) return this.view;
    const e = extent([...this.spec.lines, ...(this.spec.rays || [])].map((l) => [l.x, this.ux.f]));
    return this.logX && e.hi > 0 ? [e.lo > 0 ? e.lo : Math.max(e.tiny, e.hi * 1e-12), e.hi] : [e.lo, e.hi];
  }

  draw() {
    const { spec, svg } = this, W = (this.W = this.frame.clientWidth);
    if (!W) return;
    const small = W < 480;
    const H = (this.H = spec.lanes ? 50 + spec.lines.length * 58 : spec.height || (spec.wide ? 420 : small ? 230 : 260));
    const L = (this.L = 58), R = (this.R = spec.rays ? 34 : 14), T = (this.T = spec.events && spec.events.length ? 22 : 18), B = (this.B = spec.cycle ? 36 : 42);
    const bottom = (this.bottom = H - B), [lo, hi] = this.range();
    svg.replaceChildren();
    set(svg, { viewBox: `0 0 ${W} ${H}`, width: W, height: H });
    for (const b of this.buttons) b.setAttribute("aria-pressed", String(b.pressed()));
    this.x = this.logX && lo > 0 ? logScale(lo, hi, L, W - R) : linearScale(lo, hi, L, W - R, 84);
    const clip = this.id + "c";
    this.clip = `url(#${clip})`;
    s("rect", { x: L, y: T - 1, width: W - L - R, height: bottom - T + 2 }, s("clipPath", { id: clip }, svg));
    if (spec.cycle) this.strokes(lo, hi); else this.abscissa();
    this.bands();
    this.Y = [];
    if (spec.lanes) this.lanes(); else this.curves();
    s("rect", { x: L, y: T, width: W - L - R, height: bottom - T, class: "frame" }, svg);
    this.points();
    for (const e of spec.events || []) {
      if (e.t < lo || e.t > hi) continue;
      const px = this.x.to(e.t), g = s("path", { d: `M${px},${T}l-4,-7h8z`, style: "fill:" + e.color }, svg);
      s("title", {}, g, e.t.toFixed(1) + "° " + e.text);
    }
    this.box = s("rect", { y: T, height: bottom - T, width: 0, class: "drag" }, svg);
    this.cursor = s("line", { y1: T, y2: bottom, class: "cursor", visibility: "hidden" }, svg);
    this.dots = spec.lines.map((l) => s("circle", { r: 3.2, visibility: "hidden", style: "fill:" + l.color + ";stroke:var(--bg);pointer-events:none" }, svg));
    if (spec.cycle) this.follow();
  }

  // Strokes as bands, dead centres as lines, angles.
  strokes(lo, hi) {
    const { svg, T, L, R, W, bottom } = this, X = this.x.to;
    for (let k = Math.floor(lo / 180); k * 180 < hi; k++) {
      if (((k % 2) + 2) % 2) continue;
      const a = Math.max(lo, k * 180), b = Math.min(hi, (k + 1) * 180);
      s("rect", { x: X(a), y: T, width: X(b) - X(a), height: bottom - T, class: "band" }, svg);
    }
    const span = hi - lo, step = [1, 2, 5, 10, 15, 30, 45, 90, 180].find((d) => span / d <= Math.max(4, (W - L) / 62)) || 180;
    for (let t = Math.ceil(lo / step - 1e-9) * step; t <= hi + 1e-6; t += step) {
      s("line", { x1: X(t), x2: X(t), y1: T, y2: bottom, class: "gridline" }, svg);
      s("text", { x: X(t), y: bottom + 15, "text-anchor": "middle", class: "dim" }, svg, tickText(t) + (t + step > hi + 1e-6 ? "°" : ""));
    }
    // The longest of the names, and half of the one beside it.
    const every = (W - L - R) / Math.max(1, span / 180) < 130;
    for (const d of deadCentres(lo, hi, this.spec.cycle.four)) {
      s("line", { x1: X(d.t), x2: X(d.t), y1: T, y2: bottom, class: d.name === "firing TDC" ? "firing" : "dead" }, svg);
      const anchor = X(d.t) > W - 60 ? "end" : X(d.t) < L + 40 ? "start" : "middle";
      const x = anchor === "end" ? W - 2 : anchor === "start" ? Math.max(2, X(d.t) - 12) : X(d.t);
      if (!every || d.name !== "BDC") s("text", { x, y: bottom + 29, "text-anchor": anchor, class: "dim" }, svg, every ? d.name.replace("gas exchange ", "") : d.name);
    }
  }
  abscissa() {
    const { svg, T, L, R, W, H, bottom } = this;
    let last = -Infinity;
    for (const t of this.x.ticks) {
      const px = this.x.to(t);
      s("line", { x1: px, x2: px, y1: T, y2: bottom, class: "gridline" }, svg);
      if (px - last < 34) continue;
      s("text", { x: px, y: bottom + 15, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
      last = px;
    }
    s("text", { x: (L + W - R) / 2, y: H - 8, "text-anchor": "middle" }, svg, this.spec.xName + (this.ux.label ? " [" + this.ux.label + "]" : ""));
  }

  // Ranges and upright lines that the figure marks.
  bands() {
    const { svg, T, bottom } = this, X = (v) => this.x.to(v * this.ux.f);
    // Spans that words take, by line: the first line with room. Words that would leave the frame stand left of their line.
    const levels = [];
    const put = (x, text) => {
      const width = 6.2 * text.length + 10, left = x + width > this.W - this.R && x - width > this.L;
      const [a, b] = left ? [x - width, x] : [x, x + width];
      let level = levels.findIndex((spans) => spans.every(([from, to]) => b <= from || to <= a));
      if (level < 0) level = levels.push([]) - 1;
      levels[level].push([a, b]);
      s("text", { x: left ? x - 4 : x + 4, y: T + 13 + 15 * level, "text-anchor": left ? "end" : "start", class: "dim over" }, svg, text);
    };
    const within = (px) => clamp(px, this.L, this.W - this.R);
    for (const m of this.spec.marks || []) {
      if (m.band) {
        const a = within(X(m.band.from)), b = within(X(m.band.to));
        if (b > a) s("rect", { x: a, y: T, width: b - a, height: bottom - T, class: m.band.kept_free ? "keepfree" : "operating" }, svg);
      }
    }
    for (const m of this.spec.marks || []) {
      if (m.band && X(m.band.to) > this.L && X(m.band.from) < this.W - this.R) put(within(X(m.band.from)), m.band.label);
      if (m.at && X(m.at.x) >= this.L && X(m.at.x) <= this.W - this.R) {
        s("line", { x1: X(m.at.x), x2: X(m.at.x), y1: T, y2: bottom, class: "upright" }, svg);
        put(X(m.at.x), m.at.label);
      }
    }
  }
  // Marked points, their area by weight.
  points() {
    for (const m of this.spec.marks || []) {
      if (!m.point || !this.y) continue;
      const px = this.x.to(m.point.x * this.ux.f), py = this.y.to(m.point.y * this.uy.f);
      if (!isNumber(px) || !isNumber(py) || px < this.L - 1 || px > this.W - this.R + 1 || py < this.T - 1) continue;
      const g = s("circle", { cx: px, cy: py, r: 3.4 + 7 * Math.sqrt(clamp(m.point.weight, 0, 1)), class: m.point.beyond ? "point beyond" : "point" }, this.svg);
      s("title", {}, g, m.point.label);
    }
  }

  curves() {
    const { spec, svg, T, L, R, W, bottom } = this, [lo, hi] = this.range(), f = this.ux.f;
    const inside = (v) => v * f >= lo - 1e-9 * Math.abs(lo) && v * f <= hi + 1e-9 * Math.abs(hi);
    const limits = (spec.marks || []).filter((m) => m.limit).map((m) => [[m.limit.y], this.uy.f]);
    const e = extent([...this.visible().map((l) => [this.shown(l), this.uy.f, l.x]), ...limits], inside);
    const y = (this.y = ordinate(this.mode, e, { zero: spec.zero === undefined && !spec.cycle ? "near" : spec.zero, end: spec.top === undefined ? undefined : spec.top * this.uy.f, bottom, top: T }));
    // Zero is labelled first, then the largest: small ticks give way where there is no room.
    const taken = [];
    for (const t of [...y.ticks].sort((a, b) => (a === 0 ? -1 : b === 0 ? 1 : Math.abs(b) - Math.abs(a)))) {
      const py = y.to(t);
      if (py > bottom + 0.5 || py < T - 0.5) continue;
      s("line", { x1: L, x2: W - R, y1: py, y2: py, class: t === 0 ? "zeroline" : "gridline" }, svg);
      if (taken.some((q) => Math.abs(q - py) < 13)) continue;
      s("text", { x: L - 7, y: py + 4, "text-anchor": "end", class: "dim" }, svg, tickText(t));
      taken.push(py);
    }
    s("text", { x: 2, y: T - 7 }, svg, (spec.yName ? spec.yName + " " : "") + (this.uy.label ? (spec.yName ? "[" + this.uy.label + "]" : this.uy.label) : ""));
    for (const m of spec.marks || []) if (m.limit) this.limit(m.limit, y);
    this.rays(y);
    spec.lines.forEach((line, i) => {
      this.Y[i] = this.hidden.has(i) ? null : y.to;
      if (this.Y[i]) this.curve(line, y.to);
    });
    this.tell(y.to);
  }
  limit({ y: level, label }, y) {
    const py = y.to(level * this.uy.f);
    if (!isNumber(py) || py < this.T || py > this.bottom) return;
    s("line", { x1: this.L, x2: this.W - this.R, y1: py, y2: py, class: "limitline" }, this.svg);
    s("text", { x: this.W - this.R - 4, y: py - 4, "text-anchor": "end", class: "over limittext" }, this.svg, label);
  }
  // Thin lines with their label where they leave the figure.
  rays(y) {
    for (const r of this.spec.rays || []) {
      const px = Array.from(r.x, (v) => this.x.to(v * this.ux.f)), py = Array.from(r.y, (v) => y.to(v * this.uy.f));
      s("path", { d: "M" + px.map((p, i) => p.toFixed(1) + "," + clamp(py[i], -1e4, 1e4).toFixed(1)).join("L"), class: "ray", "clip-path": this.clip }, this.svg);
      let end = px.length - 1;
      while (end > 0 && (py[end] < this.T || px[end] > this.W - this.R + 0.5)) end--;
      if (end < 1) continue;
      if (end === px.length - 1) { s("text", { x: px[end] + 5, y: py[end] + 4, class: "dim" }, this.svg, r.label); continue; }
      const g = (py[end] - this.T) / (py[end] - py[end + 1] || 1), x = px[end] + g * (px[end + 1] - px[end]);
      if (x <= this.W - this.R && x > this.L + 12) s("text", { x, y: this.T - 5, "text-anchor": "middle", class: "dim" }, this.svg, r.label);
    }
  }

  curve(line, y, fillTo) {
    const value = this.shown(line), n = line.x.length, f = this.ux.f, [lo, hi] = this.range();
    const rising = this.spec.cycle && n > 2;
    let d = "", pen = false, first = 0, last = 0, count = 0;
    const dots = [];
    for (let i = 0; i < n; i++) {
      if (rising && ((i + 1 < n && line.x[i + 1] < lo) || (i > 0 && line.x[i - 1] > hi))) continue;
      const px = this.x.to(line.x[i] * f), py = y(value[i] * this.uy.f);
      if (!isNumber(px) || !isNumber(py)) { pen = false; continue; }
      if (!d) first = px;
      last = px;
      const q = clamp(py, -1e4, 1e4);
      d += (pen ? "L" : "M") + px.toFixed(1) + "," + q.toFixed(1);
      pen = true;
      count++;
      dots.push([px, q]);
    }
    if (!d) return;
    if (this.spec.scatter) {
      s("path", { d: dots.map(([px, py]) => `M${px.toFixed(1)},${py.toFixed(1)}h0`).join(""), class: "scatter", style: "stroke:" + line.color, "clip-path": this.clip }, this.svg);
      return;
    }
    if (fillTo !== undefined) s("path", { d: d + `L${last},${fillTo}L${first},${fillTo}Z`, style: "fill:" + line.color + ";opacity:.16", "clip-path": this.clip }, this.svg);
    s("path", { d, class: "line", style: "stroke:" + line.color + (line.thin ? ";stroke-width:1.2" : ""), "stroke-dasharray": line.dash || "none", "clip-path": this.clip }, this.svg);
    if (!this.spec.cycle && count <= 40) for (const [px, py] of dots) if (py <= this.bottom && py >= this.T - 1) s("circle", { cx: px, cy: py, r: 2.3, style: "fill:" + line.color }, this.svg);
  }

  // Curves that lie on each other get marks of their own, at places of their own.
  tell(y) {
    const all = this.visible();
    if (all.length < 2 || all.length > 8 || this.spec.scatter || !this.readable) return;
    const N = 60, at0 = all.map((l) => Array.from({ length: N }, (_, k) => {
      const px = this.L + ((k + 0.5) / N) * (this.W - this.L - this.R), v = this.x.back(px) / this.ux.f;
      if (v < l.x[0] || v > l.x[l.x.length - 1]) return NaN;
      return y(at(l.x, this.shown(l), v) * this.uy.f);
    }));
    const covered = all.map((_, i) => all.some((_, j) => i !== j && at0[i].filter((p, k) => Math.abs(p - at0[j][k]) < 1.3).length > 0.3 * N));
    all.forEach((line, i) => {
      if (!covered[i]) return;
      for (let k = 2 + ((i * 7) % 12); k < N; k += 12) {
        const px = this.L + ((k + 0.5) / N) * (this.W - this.L - this.R), py = at0[i][k];
        if (!isNumber(py) || py < this.T || py > this.bottom) continue;
        s("path", { d: `M${px.toFixed(1)},${py.toFixed(1)}` + ["m-3.5,0a3.5,3.5 0 1 0 7,0a3.5,3.5 0 1 0 -7,0", "m-3,-3h6v6h-6z", "m0,-4l3.8,6.6h-7.6z", "m0,-4.2l4.2,4.2l-4.2,4.2l-4.2,-4.2z"][i % 4], style: "fill:" + line.color + ";stroke:var(--bg);stroke-width:.8" }, this.svg);
      }
    });
  }

  lanes() {
    const all = this.spec.lines, n = all.length - this.hidden.size, height = (this.bottom - this.T) / Math.max(1, n);
    this.y = null;
    let k = 0;
    all.forEach((line, i) => {
      if (this.hidden.has(i)) { this.Y[i] = null; return; }
      const top = this.T + k * height + 11, low = this.T + (k + 1) * height - 9;
      k++;
      this.Y[i] = (v) => low + (top - low) * v;
      for (const [v, name] of [[0, "lower"], [1, "upper"]]) {
        s("line", { x1: this.L, x2: this.W - this.R, y1: this.Y[i](v), y2: this.Y[i](v), class: "gridline", style: "stroke:var(--line)" }, this.svg);
        s("text", { x: this.L - 7, y: this.Y[i](v) + 4, "text-anchor": "end", class: "dim" }, this.svg, name);
      }
      s("text", { x: 2, y: (top + low) / 2 + 4, style: "fill:" + line.color, class: "strong" }, this.svg, line.short || line.label);
      this.curve(line, this.Y[i], low);
    });
  }

  // The values of all curves at an abscissa, in the legend and as dots.
  read(t) {
    const { spec } = this, [lo, hi] = this.range(), seen = t * this.ux.f >= lo && t * this.ux.f <= hi, px = this.x.to(t * this.ux.f);
    set(this.cursor, seen ? { x1: px, x2: px, visibility: "visible" } : { visibility: "hidden" });
    if (!this.readable) return;
    spec.lines.forEach((line, i) => {
      const v = at(line.x, this.shown(line), t) * this.uy.f, py = this.Y[i] ? this.Y[i](v) : NaN;
      const out = !spec.cycle && (t < line.x[0] || t > line.x[line.x.length - 1]);
      set(this.dots[i], isNumber(py) && seen && !out ? { cx: px, cy: clamp(py, this.T, this.bottom), visibility: "visible" } : { visibility: "hidden" });
      this.values[i].textContent = out ? "" : sig(Math.abs(v) < 1e-7 * maxAbs(line.y) * this.uy.f ? 0 : v, 4);
      if (this.uy.label && !out) this.values[i].append(h("span", { class: "u" }, " " + this.uy.label));
    });
  }
  follow() {
    if (!this.W) return;
    const t = this.spec.cycle.shown;
    this.read(t);
    const near = (this.spec.events || []).filter((e) => Math.abs(e.t - t) <= 4);
    this.here.textContent = near.slice(0, 2).map((e) => e.t.toFixed(1) + "° " + e.text).join("; ");
  }
  point(v) {
    if (!this.W) return;
    if (this.spec.cycle) { this.spec.cycle.hover(v); return; }
    this.at = v;
    if (v === null) {
      set(this.cursor, { visibility: "hidden" });
      for (const d of this.dots) set(d, { visibility: "hidden" });
      for (const e of this.values) e.textContent = "";
      this.here.textContent = "";
      return;
    }
    this.read(v / this.ux.f);
    const near = (this.spec.marks || []).filter((m) => m.point && Math.abs(this.x.to(m.point.x * this.ux.f) - this.x.to(v)) < 4);
    this.here.textContent = `${this.spec.xName} ${sig(v, 4)} ${this.ux.label}` + near.slice(0, 2).map((m) => "; " + m.point.label).join("");
  }
  zoom(a, b) {
    if (this.spec.cycle) { if (b - a > 0.5) this.spec.cycle.zoom(a, b); return; }
    this.view = [a, b];
    this.draw();
  }

  listen() {
    const { svg, spec } = this, where = (e) => { const r = svg.getBoundingClientRect(); return ((e.clientX - r.left) / r.width) * this.W; };
    const inside = (px) => clamp(px, this.L, this.W - this.R);
    let drag = null;
    svg.addEventListener("pointermove", (e) => {
      if (!this.W) return;
      const px = inside(where(e));
      if (drag !== null) set(this.box, { x: Math.min(drag, px), width: Math.abs(px - drag) });
      this.point(this.x.back(px));
    });
    svg.addEventListener("pointerleave", () => { if (drag === null) this.point(null); });
    svg.addEventListener("pointerdown", (e) => {
      if (e.button || !this.W) return;
      drag = inside(where(e));
      svg.setPointerCapture(e.pointerId);
    });
    svg.addEventListener("pointerup", (e) => {
      if (drag === null) return;
      const px = inside(where(e)), far = Math.abs(px - drag) > 6, a = this.x.back(Math.min(drag, px)), b = this.x.back(Math.max(drag, px));
      drag = null;
      set(this.box, { width: 0 });
      if (far) this.zoom(a, b);
      else if (spec.cycle) { spec.cycle.play(false); spec.cycle.pin(this.x.back(px)); }
    });
    svg.addEventListener("pointercancel", () => { drag = null; set(this.box, { width: 0 }); });
    svg.addEventListener("dblclick", () => { if (spec.cycle) spec.cycle.zoom(spec.cycle.lo, spec.cycle.hi); else { this.view = null; this.draw(); } });
    // Charts over the crank angle follow the keys of the whole page.
    svg.addEventListener("keydown", (e) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
      if (!by || spec.cycle || !this.W) return;
      const [lo, hi] = this.range(), from = this.at === undefined || this.at === null ? lo : this.at;
      this.point(clamp(from + (by * (hi - lo)) / 100, lo, hi));
      e.preventDefault();
      e.stopPropagation();
    });
  }
}

// Curves of one unit and of like size together, so that one curve does not flatten another.
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
