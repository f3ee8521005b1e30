// Line spectra one above the other, each moved up by a second quantity (a speed), the nearer hiding the farther.
//
// spec: { title, hint, wide, abscissas: [{ label, unit, values }], y: { label, unit, values }, spectra: [{ label, unit, values }] }
// One entry of all `values` is one line of a spectrum; lines of one spectrum follow each other. One abscissa and one of `spectra` are shown at a time.
class Waterfall {
  constructor(host, spec) {
    const { abscissas, y, spectra } = spec;
    this.spec = spec;
    this.x = abscissas[0];
    this.z = spectra[0];
    this.rows = [];
    y.values.forEach((v, i) => { if (!i || v !== y.values[i - 1]) this.rows.push({ y: v, from: i, to: i }); this.rows[this.rows.length - 1].to = i + 1; });
    this.rows.sort((a, b) => b.y - a.y);
    this.svg = s("svg", { role: "img", tabindex: "0" });
    const pick = spectra.length < 2 ? null : h("select", { "aria-label": "what is shown", onchange: () => { this.z = spectra[+pick.value]; this.draw(); } }, ...spectra.map((z, i) => h("option", { value: i }, z.label)));
    this.buttons = abscissas.length < 2 ? [] : abscissas.map((x) => {
      const b = h("button", { type: "button", onclick: () => { this.x = x; this.draw(); } }, x.label);
      b.of = x;
      return b;
    });
    const first = abscissas[0];
    this.saving = { title: spec.title, xName: first.label, xUnit: first.unit, columns: [...abscissas.slice(1), y, ...spectra].map((c) => ({ label: c.label, unit: c.unit, x: first.values, y: c.values })) };
    this.here = h("p", { class: "hint" });
    const head = h("div", { class: "head" }, h("h3", {}, spec.title), h("div", { class: "tools" }, pick, ...this.buttons, saveMenu(this.svg, this.saving)));
    this.frame = h("div", { class: "drawn" }, this.svg);
    host.append(h("figure", { class: "plot" + (spec.wide ? " wide" : "") }, head, spec.hint ? h("p", { class: "hint" }, spec.hint) : null, this.here, this.frame));
    this.listen();
    new ResizeObserver(() => { if (this.frame.clientWidth !== this.W) this.draw(); }).observe(this.frame);
    this.draw();
  }

  // Line `i` in words.
  words(i) {
    const { y } = this.spec, part = (c) => `${c.label} ${tickText(+c.values[i].toPrecision(4))}${c.unit ? " " + c.unit : ""}`, u = this.uz;
    return `${[...this.spec.abscissas, y].map(part).join(", ")}: ${sig(this.z.values[i] * u.f, 3)} ${u.label}`;
  }

  draw() {
    const { spec, svg, rows, z } = this, W = (this.W = this.frame.clientWidth);
    if (!W || !rows.length) return;
    const H = spec.wide ? 460 : 420, L = 58, R = 40, T = 12, bottom = H - 42, reach = 0.36 * (bottom - T), top = maxAbs(z.values), far = T + reach + 16;
    this.uz = display(z.unit, top);
    const ends = extent([[this.x.values, 1]]), ys = extent([[rows.map((r) => r.y), 1]]);
    const X = linearScale(Math.min(0, ends.lo), ends.hi * 1.02, L, W - R, 84), Y = linearScale(ys.lo, ys.hi, bottom - 6, far, 42);
    this.largest = z.values.reduce((best, v, i) => (Math.abs(v) > Math.abs(z.values[best]) ? i : best), 0);
    this.saving.title = spec.spectra.length > 1 ? `${spec.title}: ${z.label}` : spec.title;
    svg.replaceChildren();
    set(svg, { viewBox: `0 0 ${W} ${H}`, width: W, height: H, "aria-label": `${this.saving.title}, ${rows.length} spectra over ${this.x.label}, by ${spec.y.label}; the largest line: ${this.words(this.largest)}` });
    for (const b of this.buttons) b.setAttribute("aria-pressed", String(b.of === this.x));
    const unit = (c) => c.label + (c.unit ? ` [${display(c.unit, Infinity).label}]` : "");
    let last = -Infinity;
    for (const t of X.ticks) {
      const px = X.to(t);
      s("line", { x1: px, x2: px, y1: T, y2: bottom, class: "gridline" }, svg);
      if (px - last < 34) continue;
      s("text", { x: px, y: bottom + 15, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
      last = px;
    }
    s("text", { x: (L + W - R) / 2, y: H - 8, "text-anchor": "middle" }, svg, unit(this.x));
    for (const t of Y.ticks) s("text", { x: L - 7, y: Y.to(t) + 4, "text-anchor": "end", class: "dim" }, svg, tickText(t));
    s("text", { x: 2, y: far - 22 }, svg, spec.y.label);
    s("text", { x: 2, y: far - 8, class: "dim" }, svg, spec.y.unit ? `[${display(spec.y.unit, Infinity).label}]` : "");
    this.places = new Array(z.values.length);
    for (const r of rows) this.spectrum(r, X.to, Y.to(r.y), top > 0 ? reach / top : 0, [L, W - R]);
    s("rect", { x: L, y: T, width: W - L - R, height: bottom - T, class: "frame" }, svg);
    this.scale(W - R + 10, far, reach, top);
    this.dot = s("circle", { r: 3.6, class: "seen", visibility: "hidden" }, svg);
    const [px, py] = this.places[this.largest], anchor = px > W - 190 ? "end" : px < L + 90 ? "start" : "middle";
    if (top > 0) s("text", { x: px, y: py - 5, "text-anchor": anchor, class: "over strong" }, svg, `${sig(top * this.uz.f, 3)} ${this.uz.label}`);
    this.point(null);
  }
  // The lines of one spectrum as narrow peaks on its base line.
  spectrum(r, X, base, k, [from, to]) {
    const { x, z } = this, px = Array.from({ length: r.to - r.from }, (_, j) => X(x.values[r.from + j]));
    let d = `M${from},${base.toFixed(1)}`;
    px.forEach((p, j) => {
      const i = r.from + j, near = Math.min(p - (j ? px[j - 1] : from), (j + 1 < px.length ? px[j + 1] : to) - p), w = clamp(0.45 * near, 0.4, 3), py = base - k * Math.abs(z.values[i]);
      this.places[i] = [p, py];
      d += `L${(p - w).toFixed(1)},${base.toFixed(1)}L${p.toFixed(1)},${py.toFixed(1)}L${(p + w).toFixed(1)},${base.toFixed(1)}`;
    });
    s("path", { d: d + `L${to},${base.toFixed(1)}`, class: "spectrum" }, this.svg);
  }
  // A bar as long as a round value.
  scale(x, low, reach, top) {
    if (!(top > 0)) return;
    const value = niceStep(0.5 * top * this.uz.f, 1), length = (reach * value) / (top * this.uz.f);
    s("path", { d: `M${x - 3},${low}h6m-3,0v${-length}m-3,0h6`, class: "cursor", fill: "none" }, this.svg);
    s("text", { x: x + 14, y: low - length / 2, "text-anchor": "middle", class: "dim", transform: `rotate(-90 ${x + 14} ${low - length / 2})` }, this.svg, `${tickText(value)} ${this.uz.label}`);
  }

  // Tells the line `i`, or the largest.
  point(i) {
    this.at = i;
    set(this.dot, i === null ? { visibility: "hidden" } : { cx: this.places[i][0], cy: this.places[i][1], visibility: "visible" });
    this.here.textContent = `${this.z.label}, ${i === null ? "largest line: " : ""}${this.words(i === null ? this.largest : i)}`;
  }
  listen() {
    const { svg } = this;
    svg.addEventListener("pointermove", (e) => {
      if (!this.places) return;
      const box = svg.getBoundingClientRect(), x = e.clientX - box.left, y = e.clientY - box.top;
      let best = 0, least = Infinity;
      this.places.forEach(([px, py], i) => { const d = (px - x) ** 2 + (py - y) ** 2; if (d < least) { least = d; best = i; } });
      this.point(best);
    });
    svg.addEventListener("pointerleave", () => { if (this.places) this.point(null); });
    svg.addEventListener("keydown", (e) => {
      const along = { ArrowLeft: -1, ArrowRight: 1 }[e.key], across = { ArrowUp: -1, ArrowDown: 1 }[e.key];
      if (!(along || across) || !this.places) return;
      const i = this.at === null ? this.largest : this.at, row = this.rows.findIndex((r) => i >= r.from && i < r.to), own = this.rows[row];
      const other = this.rows[clamp(row + (across || 0), 0, this.rows.length - 1)];
      this.point(other.from + clamp(i - own.from + (along || 0), 0, other.to - other.from - 1));
      e.preventDefault();
      e.stopPropagation();
    });
  }
}
