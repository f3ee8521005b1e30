// Run time and work against error, one chart per result, one curve per method; achieved against asked errors.
(function () {
  const grid = document.getElementById("charts-grid");
  if (!grid) return;
  const good = DATA.points.filter((p) => !p.failure);
  const methods = [...new Set(DATA.points.map((p) => p.method))];
  const marks = ["circle", "square", "triangle", "diamond"];
  const seconds = (v) => (v >= 1 ? sig(v, 3) + " s" : v >= 1e-3 ? sig(v * 1e3, 3) + " ms" : sig(v * 1e6, 3) + " µs");
  const power = (v) => { const e = Math.round(Math.log10(v)); return Math.abs(v / 10 ** e - 1) < 1e-6 ? powerOfTen(e) : sig(v, 1); };
  // Errors by powers of ten all along an axis, and between them.
  const error = (v) => { const e = Math.floor(Math.log10(v) + 1e-9), m = Math.round(v / 10 ** e); return m === 1 ? powerOfTen(e) : m + "×" + powerOfTen(e); };
  // What a method costs: its time, and every count that tells settings apart.
  const counts = [...new Set(good.flatMap((p) => Object.keys(p.work)))].filter((n) => n !== "cycles" && new Set(good.map((p) => p.work[n]).filter((v) => v > 0)).size > 1);
  const cyclic = good.some((p) => p.cycles > 1);
  const costs = [
    ...(cyclic ? [{ label: "time of one cycle", of: (p) => p.seconds_per_cycle, text: seconds }] : []),
    { label: cyclic ? "time to the periodic state" : "time", of: (p) => p.seconds_total, text: seconds },
    ...counts.map((n) => ({ label: n.replaceAll("_", " "), of: (p) => p.work[n], text: (v) => (v >= 1e4 ? power(v) : sig(v, 3)) })),
  ];
  let cost = costs[0];
  const buttons = costs.map((c) => h("button", { type: "button", onclick: () => { cost = c; draw(); } }, c.label));
  const keys = h("div", { class: "keys" }, ...buttons);
  methods.forEach((m, i) => {
    const sw = s("svg", { width: 34, height: 12, viewBox: "0 0 34 12" });
    s("line", { x1: 0, x2: 34, y1: 6, y2: 6, style: `stroke:${color(i)};stroke-width:2` }, sw);
    mark(sw, marks[i % 4], 17, 6, 4.5, color(i));
    keys.append(h("span", {}, sw, " " + m));
  });
  document.getElementById("bench-bar").append(keys);
  grid.className = "charts";

  function mark(parent, kind, x, y, r, fill) {
    const style = `fill:${fill};stroke:var(--bg);stroke-width:1`;
    if (kind === "circle") return s("circle", { cx: x, cy: y, r, style }, parent);
    const d = { square: `M${x - r * 0.9},${y - r * 0.9}h${r * 1.8}v${r * 1.8}h${-r * 1.8}z`, triangle: `M${x},${y - r * 1.15}l${r * 1.1},${r * 2}h${-r * 2.2}z`, diamond: `M${x},${y - r * 1.3}l${r * 1.3},${r * 1.3}l${-r * 1.3},${r * 1.3}l${-r * 1.3},${-r * 1.3}z` }[kind];
    return s("path", { d, style }, parent);
  }

  function draw() {
    buttons.forEach((b, k) => b.setAttribute("aria-pressed", String(costs[k] === cost)));
    grid.replaceChildren(...DATA.errors.map((name) => {
      const title = h("h3", {}, DATA.descriptions[name] || name, " ", DATA.descriptions[name] ? h("code", {}, name) : null);
      const points = good.filter((p) => isNumber(p.errors[name]) && cost.of(p) > 0);
      const text = (p) => `${p.method}, ${p.setting}${p.is_default ? " (as it stands)" : ""}: ${cost.text(cost.of(p))}, error ${sig(p.errors[name], 2)}`;
      return chart({ title, points, x: (p) => Math.abs(p.errors[name]), y: cost.of, across: "relative error", up: cost.label, tick: cost.text, text, trusted: DATA.trusted_to });
    }));
  }

  // Logarithmic on both axes. Along the abscissa zero, and what is far below what the reference knows, stands at the left edge.
  function chart({ title, points, x, y, across, up, tick, text, trusted, band }) {
    const tip = h("div", { class: "tip" });
    const W = 580, H = 380, L = 66, R = 14, T = 22, B = 44;
    const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": `${up} against ${across}` });
    const box = h("div", { class: "chart" }, title, svg, tip);
    if (!points.length) { tip.textContent = "No method gave this."; return box; }
    const positive = points.map(x).filter((e) => e > 0);
    const floor = Math.max(positive.length ? Math.min(...positive) / 2 : 1e-16, (trusted || 0) / 10);
    const at = (p) => Math.max(x(p), floor);
    const span = (v) => { let lo = Math.min(...v), hi = Math.max(...v); const f = Math.max(1.25, (hi / lo) ** 0.07); return [lo / f, hi * f]; };
    const [x0, x1] = span(points.map(at)), [y0, y1] = span(points.map(y));
    const X = (v) => L + (Math.log(v / x0) / Math.log(x1 / x0)) * (W - L - R), Y = (v) => H - B - (Math.log(v / y0) / Math.log(y1 / y0)) * (H - T - B);
    if (trusted > x0) {
      const edge = Math.min(X(trusted), W - R);
      s("rect", { x: L, y: T, width: edge - L, height: H - T - B, style: "fill:var(--grid);opacity:.6" }, svg);
      s("text", { x: L + 6, y: H - B - 8, class: "dim" }, svg, "within the reference");
    }
    for (const t of logTicks(x0, x1)) {
      s("line", { x1: X(t), x2: X(t), y1: T, y2: H - B, style: "stroke:var(--grid)" }, svg);
      // At the right edge there is no room for half a label.
      const last = X(t) > W - 24;
      s("text", { x: last ? W : X(t), y: H - B + 16, "text-anchor": last ? "end" : "middle", class: "dim" }, svg, error(t));
    }
    for (const t of logTicks(y0, y1)) {
      s("line", { x1: L, x2: W - R, y1: Y(t), y2: Y(t), style: "stroke:var(--grid)" }, svg);
      s("text", { x: L - 7, y: Y(t) + 4, "text-anchor": "end", class: "dim" }, svg, tick(t).replace(/\.0+ /, " "));
    }
    for (const [factor, words] of band || []) {
      // From edge to edge of the part that is shown.
      const from = Math.max(x0, y0 / factor), to = Math.min(x1, y1 / factor);
      if (from >= to) continue;
      s("line", { x1: X(from), y1: Y(from * factor), x2: X(to), y2: Y(to * factor), style: "stroke:var(--muted);stroke-dasharray:5 4" }, svg);
      s("text", { x: X(to) - 6, y: Y(to * factor) + 14, "text-anchor": "end", class: "dim" }, svg, words);
    }
    s("rect", { x: L, y: T, width: W - L - R, height: H - T - B, style: "fill:none;stroke:var(--line)" }, svg);
    s("text", { x: (L + W - R) / 2, y: H - 8, "text-anchor": "middle" }, svg, across);
    s("text", { x: L, y: T - 8, "text-anchor": "start" }, svg, up);
    // Words beside a mark stand below those of another one at the same place.
    const words = [];
    const below = (px, py) => { const n = words.filter(([x, y]) => Math.abs(x - px) < 60 && Math.abs(y - py) < 12).length; words.push([px, py]); return 24 * n; };
    methods.forEach((m, i) => {
      const own = points.filter((p) => p.method === m);
      if (!own.length) return;
      s("path", { d: own.map((p, k) => (k ? "L" : "M") + X(at(p)).toFixed(1) + "," + Y(y(p)).toFixed(1)).join(""), style: `fill:none;stroke:${color(i)};stroke-width:1.8;opacity:.85` }, svg);
      for (const p of own) {
        const px = X(at(p)), py = Y(y(p));
        if (p.is_default) {
          s("circle", { cx: px, cy: py, r: 10, style: `fill:none;stroke:${color(i)};stroke-width:2` }, svg);
          const left = px > W - 170;
          s("text", { x: px + (left ? -14 : 14), y: py - 8 + below(px, py), "text-anchor": left ? "end" : "start", style: "paint-order:stroke;stroke:var(--bg);stroke-width:4px" }, svg, p.setting);
        }
        const g = mark(svg, marks[i % 4], px, py, 5, color(i));
        s("title", {}, g, text(p));
        g.addEventListener("pointerenter", () => { tip.textContent = text(p); });
      }
    });
    return box;
  }

  draw();

  const asked = document.getElementById("asked-grid");
  if (!asked) return;
  asked.className = "charts";
  asked.append(chart({
    title: h("h3", {}, "Achieved error over the one that was asked for"),
    points: good.filter((p) => p.asked > 0 && p.achieved > 0),
    x: (p) => p.asked, y: (p) => p.achieved, across: "asked tolerance", up: "achieved error", tick: error,
    text: (p) => `${p.method}, ${p.setting}: ${sig(p.achieved, 2)}, ${sig(p.achieved / p.asked, 2)} times what was asked`,
    band: [[1, "as asked"], [10, "ten times"]],
  }));
})();
