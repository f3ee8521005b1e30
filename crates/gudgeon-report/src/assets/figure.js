// Figures of a rig: curves over any column, and maps of a value over a plane.
(function () {
  const capital = (t) => t.charAt(0).toUpperCase() + t.slice(1);
  let clips = 0;
  // lines: [{ label, x, y, unit, color, dash }]; x in SI of unit spec.xUnit. Values under the pointer stand in the legend.
  function curves(host, spec) {
    const L = 66, T = 14, B = 40, R = 24, H = 300, clip = "clip" + ++clips;
    const ux = display(spec.xUnit, Math.max(...spec.lines.map((l) => maxAbs(l.x)))), uy = display(spec.lines[0].unit, Math.max(...spec.lines.map((l) => maxAbs(l.y))));
    const hidden = new Set();
    let logX = spec.logX, logY = spec.logY, W = 0, X, Y, invert, cursor, dots;
    const svg = s("svg", { role: "img", "aria-label": spec.title });
    const legend = h("div", { class: "legend" }), head = h("div", { class: "head" }, h("h3", {}, capital(spec.title)), h("p", { class: "hint" }, spec.hint || ""));
    const toggle = (text, get, flip) => {
      const b = h("button", { type: "button", onclick: () => { flip(); b.setAttribute("aria-pressed", String(get())); draw(); } }, text);
      b.setAttribute("aria-pressed", String(get()));
      head.append(b);
    };
    toggle("log x", () => logX, () => { logX = !logX; });
    toggle("log y", () => logY, () => { logY = !logY; });
    host.append(h("div", { class: "plot" }, head, h("div", { class: "body" }, h("div", {}, svg), legend)));
    const here = h("div", { class: "events" });
    const values = spec.lines.map((line, i) => {
      const swatch = s("svg", { width: 24, height: 10, viewBox: "0 0 24 10" });
      s("line", { x1: 0, x2: 24, y1: 5, y2: 5, style: "stroke:" + line.color + ";stroke-width:2.4", "stroke-dasharray": line.dash || "none" }, swatch);
      const v = h("span", { class: "v" });
      const b = h("button", { type: "button", "aria-pressed": "true", title: "show or hide: " + line.label, onclick: () => {
        if (hidden.has(i)) hidden.delete(i); else hidden.add(i);
        b.setAttribute("aria-pressed", String(!hidden.has(i)));
        draw();
      } }, swatch, h("span", { class: "name" }, line.label), v);
      legend.append(b);
      return v;
    });
    legend.append(here);

    // Ends of an axis, its map to pixels and back, and its ticks.
    function scale(arrays, log, a, b, room, zero) {
      let lo = Infinity, hi = -Infinity, tiny = Infinity;
      for (const [values, f] of arrays) for (const v0 of values) {
        const v = v0 * f;
        if (!isNumber(v)) continue;
        lo = Math.min(lo, v); hi = Math.max(hi, v);
        if (v > 0) tiny = Math.min(tiny, v);
      }
      if (lo > hi) { lo = 0; hi = 1; }
      if (log && hi > 0) {
        if (lo <= 0) lo = Math.max(tiny, hi * 1e-12);
        if (hi / lo < 1.1) { lo /= 1.05; hi *= 1.05; }
        if (zero) { const f = (hi / lo) ** 0.04; lo /= f; hi *= f; }
        const k = (b - a) / Math.log(hi / lo);
        return { to: (v) => (v > 0 ? a + k * Math.log(v / lo) : NaN), back: (p) => lo * Math.exp((p - a) / k), ticks: logTicks(lo, hi) };
      }
      if (zero && lo > 0 && lo < 0.6 * hi) lo = 0;
      if (zero && hi < 0 && hi > 0.6 * lo) hi = 0;
      if (hi === lo) { const d = Math.abs(hi) || 1; lo -= d / 2; hi += d / 2; }
      if (zero) { const pad = (hi - lo) * 0.05; if (lo !== 0) lo -= pad; if (hi !== 0) hi += pad; }
      const k = (b - a) / (hi - lo);
      return { to: (v) => a + k * (v - lo), back: (p) => lo + (p - a) / k, ticks: linearTicks(lo, hi, Math.abs(b - a) / room) };
    }
    function draw() {
      W = svg.parentNode.clientWidth;
      if (!W) return;
      svg.replaceChildren();
      set(svg, { viewBox: `0 0 ${W} ${H}`, height: H });
      const shown = spec.lines.filter((_, i) => !hidden.has(i)), bottom = H - B;
      const sx = scale(shown.map((l) => [l.x, ux.f]), logX, L, W - R, 80, false), sy = scale(shown.map((l) => [l.y, uy.f]), logY, bottom, T, 42, true);
      X = sx.to; Y = sy.to; invert = sx.back;
      for (const t of sx.ticks) {
        s("line", { x1: X(t), x2: X(t), y1: T, y2: bottom, class: "gridline" }, svg);
        s("text", { x: X(t), y: bottom + 15, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
      }
      for (const t of sy.ticks) {
        if (Y(t) > bottom + 0.5 || Y(t) < T - 0.5) continue;
        s("line", { x1: L, x2: W - R, y1: Y(t), y2: Y(t), class: t === 0 ? "zeroline" : "gridline" }, svg);
        s("text", { x: L - 7, y: Y(t) + 4, "text-anchor": "end", class: "dim" }, svg, tickText(t));
      }
      s("text", { x: L - 7, y: T - 3, "text-anchor": "end" }, svg, uy.label);
      s("text", { x: (L + W - R) / 2, y: H - 6, "text-anchor": "middle" }, svg, spec.xName + (ux.label ? " [" + ux.label + "]" : ""));
      const frame = { x: L, y: T, width: W - L - R, height: bottom - T };
      s("rect", frame, s("clipPath", { id: clip }, svg));
      s("rect", { ...frame, class: "frame" }, svg);
      spec.lines.forEach((line, i) => {
        if (hidden.has(i)) return;
        let d = "", on = false;
        for (let k = 0; k < line.x.length; k++) {
          const px = X(line.x[k] * ux.f), py = Y(line.y[k] * uy.f);
          if (!isNumber(px) || !isNumber(py)) { on = false; continue; }
          d += (on ? "L" : "M") + px.toFixed(1) + "," + clamp(py, -1e4, 1e4).toFixed(1);
          on = true;
        }
        if (d) s("path", { d, class: "line", "clip-path": `url(#${clip})`, style: "stroke:" + line.color, "stroke-dasharray": line.dash || "none" }, svg);
        if (line.x.length <= 40) for (let k = 0; k < line.x.length; k++) {
          const px = X(line.x[k] * ux.f), py = Y(line.y[k] * uy.f);
          if (isNumber(px) && isNumber(py) && py <= bottom) s("circle", { cx: px, cy: py, r: 2.4, style: "fill:" + line.color }, svg);
        }
      });
      cursor = s("line", { y1: T, y2: bottom, class: "cursor", visibility: "hidden" }, svg);
    }
    function nearest(x, v) {
      let best = 0;
      for (let k = 1; k < x.length; k++) if (Math.abs(x[k] - v) < Math.abs(x[best] - v)) best = k;
      return best;
    }
    svg.addEventListener("pointermove", (e) => {
      if (!W) return;
      const r = svg.getBoundingClientRect(), px = clamp(((e.clientX - r.left) / r.width) * W, L, W - R), v = invert(px) / ux.f;
      set(cursor, { x1: px, x2: px, visibility: "visible" });
      spec.lines.forEach((l, i) => { values[i].textContent = l.x.length ? sig(l.y[nearest(l.x, v)] * uy.f, 5) : ""; });
      here.textContent = spec.xName + " " + sig(v * ux.f, 4) + " " + ux.label;
    });
    svg.addEventListener("pointerleave", () => { set(cursor, { visibility: "hidden" }); for (const v of values) v.textContent = ""; here.textContent = ""; });
    new ResizeObserver(() => { if (svg.parentNode.clientWidth !== W) draw(); }).observe(svg.parentNode);
    addEventListener("beforeprint", draw);
    draw();
  }

  // Dark to light, readable without colour vision: points of the map viridis (CC0).
  const SCALE = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
  function shade(f) {
    const g = clamp(f, 0, 1) * (SCALE.length - 1), k = Math.min(SCALE.length - 2, Math.floor(g)), t = g - k;
    return SCALE[k].map((c, i) => Math.round(c + t * (SCALE[k + 1][i] - c)));
  }
  function map(host, spec) {
    const { x, y, z } = spec;
    let nx = 1;
    while (nx < y.length && y[nx] === y[0]) nx++;
    const ny = Math.floor(y.length / nx);
    let lo = Infinity, hi = -Infinity;
    for (const v of z) if (isNumber(v)) { lo = Math.min(lo, v); hi = Math.max(hi, v); }
    if (lo > hi) { lo = 0; hi = 1; }
    const range = hi - lo || Math.abs(hi) || 1;
    const xs = Array.from({ length: nx }, (_, i) => x[i]), ys = Array.from({ length: ny }, (_, j) => y[j * nx]);
    const ux = display(spec.xUnit, maxAbs(xs)), uy = display(spec.yUnit, maxAbs(ys)), uz = display(spec.zUnit, maxAbs(z));
    const L = 66, T = 12, B = 40, R = 96, W = 620, H = 340, bottom = H - B, right = W - R;
    const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": spec.title });
    const tip = h("div", { class: "tip" });
    host.append(h("div", { class: "chart" }, h("h3", {}, capital(spec.title)), h("p", { class: "hint" }, spec.hint || ""), svg, tip));
    const X = (v) => L + ((v - xs[0]) / (xs[nx - 1] - xs[0] || 1)) * (right - L), Y = (v) => bottom - ((v - ys[0]) / (ys[ny - 1] - ys[0] || 1)) * (bottom - T);
    const canvas = h("canvas", { width: right - L, height: bottom - T }), g = canvas.getContext("2d"), image = g.createImageData(right - L, bottom - T);
    // Each pixel from the four points round it; the grid may be graded.
    const column = [], row = [];
    for (let i = 0, k = 0; i < image.width; i++) { const v = xs[0] + ((i + 0.5) / image.width) * (xs[nx - 1] - xs[0]); while (k < nx - 2 && xs[k + 1] < v) k++; column.push([k, (v - xs[k]) / (xs[k + 1] - xs[k] || 1)]); }
    for (let j = 0, k = 0; j < image.height; j++) { const v = ys[0] + ((j + 0.5) / image.height) * (ys[ny - 1] - ys[0]); while (k < ny - 2 && ys[k + 1] < v) k++; row.push([k, (v - ys[k]) / (ys[k + 1] - ys[k] || 1)]); }
    const value = (c, r) => {
      const [i, a] = c, [j, b] = r, i1 = Math.min(i + 1, nx - 1), j1 = Math.min(j + 1, ny - 1);
      return (1 - b) * ((1 - a) * z[j * nx + i] + a * z[j * nx + i1]) + b * ((1 - a) * z[j1 * nx + i] + a * z[j1 * nx + i1]);
    };
    for (let j = 0; j < image.height; j++) for (let i = 0; i < image.width; i++) {
      const v = value(column[i], row[j]), at = 4 * ((image.height - 1 - j) * image.width + i);
      const [r, gr, b] = isNumber(v) ? shade((v - lo) / range) : [128, 128, 128];
      image.data[at] = r; image.data[at + 1] = gr; image.data[at + 2] = b; image.data[at + 3] = 255;
    }
    g.putImageData(image, 0, 0);
    s("image", { x: L, y: T, width: right - L, height: bottom - T, href: canvas.toDataURL(), preserveAspectRatio: "none" }, svg);
    const ticksOf = (a, b, f, room, unit) => {
      const lo = Math.min(a, b) * f, hi = Math.max(a, b) * f;
      // Whole turns are read by quarters.
      return unit === "deg" && hi - lo >= 360 ? linearTicks(lo / 90, hi / 90, (hi - lo) / 90).map((t) => 90 * t) : linearTicks(lo, hi, room);
    };
    for (const t of ticksOf(xs[0], xs[nx - 1], ux.f, 6, spec.xUnit)) s("text", { x: X(t / ux.f), y: bottom + 15, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
    for (const t of ticksOf(ys[0], ys[ny - 1], uy.f, 5, spec.yUnit)) s("text", { x: L - 7, y: Y(t / uy.f) + 4, "text-anchor": "end", class: "dim" }, svg, tickText(t));
    s("text", { x: (L + right) / 2, y: H - 6, "text-anchor": "middle" }, svg, spec.xName + (ux.label ? " [" + ux.label + "]" : ""));
    s("text", { x: 14, y: (T + bottom) / 2, "text-anchor": "middle", transform: `rotate(-90 14 ${(T + bottom) / 2})` }, svg, spec.yName + (uy.label ? " [" + uy.label + "]" : ""));
    for (let k = 0; k < 64; k++) s("rect", { x: right + 14, y: bottom - ((k + 1) / 64) * (bottom - T), width: 14, height: (bottom - T) / 64 + 0.6, style: `fill:rgb(${shade((k + 0.5) / 64).join(",")})` }, svg);
    for (const t of linearTicks(lo * uz.f, (lo + range) * uz.f, 5)) s("text", { x: right + 32, y: bottom - ((t / uz.f - lo) / range) * (bottom - T) + 4, class: "dim" }, svg, tickText(t));
    s("text", { x: right + 14, y: H - 6 }, svg, uz.label);
    svg.addEventListener("pointermove", (e) => {
      const r = svg.getBoundingClientRect(), px = ((e.clientX - r.left) / r.width) * W - L, py = bottom - ((e.clientY - r.top) / r.height) * H;
      const i = Math.floor(px), j = Math.floor(py);
      if (!column[i] || !row[j]) { tip.textContent = ""; return; }
      const at = (v, p, n) => v[0] + ((p + 0.5) / n) * (v[v.length - 1] - v[0]);
      tip.textContent = `${spec.xName} ${sig(at(xs, i, image.width) * ux.f, 4)} ${ux.label}, ${spec.yName} ${sig(at(ys, j, image.height) * uy.f, 4)} ${uy.label}: ${sig(value(column[i], row[j]) * uz.f, 5)} ${uz.label}`;
    });
    svg.addEventListener("pointerleave", () => { tip.textContent = ""; });
  }

  const host = document.getElementById("figures");
  if (host && DATA.figures) {
    const maps = h("div", { class: "charts" });
    for (const f of DATA.figures) {
      const still = f.kind.drawing || f.kind.bars || f.kind.ranges;
      if (still) {
        if (!maps.isConnected) host.append(maps);
        (f.kind.drawing ? drawing : f.kind.bars ? bars : ranges)(maps, { title: capital(f.title), hint: f.hint, ...still });
        continue;
      }
      const table = DATA.tables[f.table];
      if (!table) continue;
      const column = (name) => [table.axis, ...table.columns].find((c) => c.name === name);
      const k = f.kind.lines || f.kind.map, x = column(k.x);
      if (!x) continue;
      if (f.kind.lines) {
        const lines = k.lines.map(([label, name], i) => [label, column(name), i]).filter(([, c]) => c)
          .map(([label, c, i]) => ({ label, x: arrays[x.at], y: arrays[c.at], unit: c.unit, color: color(i), dash: i > 7 ? "6 4" : "" }));
        if (lines.length) curves(host, { title: f.title, hint: f.hint, xName: x.name.replace(/_/g, " "), xUnit: x.unit, lines, logX: k.log_x, logY: k.log_y });
      } else {
        const y = column(k.y), z = column(k.value);
        // Maps and drawings stand side by side, where the first of them comes.
        if (y && z && !maps.isConnected) host.append(maps);
        if (y && z) map(maps, { title: f.title, hint: f.hint, x: arrays[x.at], y: arrays[y.at], z: arrays[z.at], xName: x.name.replace(/_/g, " "), yName: y.name.replace(/_/g, " "), xUnit: x.unit, yUnit: y.unit, zUnit: z.unit });
      }
    }
  }
  // A comparison of runs that do not go over a cycle: one drawing per column, one curve per variant.
  const overlay = document.getElementById("overlay");
  if (overlay && DATA.variants) {
    overlay.className = "wide";
    const names = new Map();
    for (const v of DATA.variants) for (const c of v.series.columns) names.set(c.name, c.unit);
    for (const name of names.keys()) {
      const lines = [];
      let axis;
      for (const v of DATA.variants) {
        const c = v.series.columns.find((c) => c.name === name);
        if (!c || !arrays[v.series.axis.at].length) continue;
        axis = v.series.axis;
        lines.push({ label: v.number + " " + v.label, x: arrays[axis.at], y: arrays[c.at], unit: c.unit, color: color(v.number - 1), dash: v.number > 8 ? "6 4" : "" });
      }
      if (lines.length) curves(overlay, { title: name, xName: axis.name, xUnit: axis.unit, lines, logX: false, logY: false });
    }
  }
})();
