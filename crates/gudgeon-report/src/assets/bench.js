// Run time against error, one chart per result, one curve per method.
(function () {
  const grid = document.getElementById("charts-grid");
  if (!grid) return;
  const good = DATA.points.filter((p) => !p.failure);
  const methods = [...new Set(DATA.points.map((p) => p.method))];
  const marks = ["circle", "square", "triangle", "diamond"];
  let time = "seconds_per_cycle";
  const buttons = [["seconds_per_cycle", "time of one cycle"], ["seconds_total", "time to the periodic state"]].map(([key, text]) =>
    h("button", { type: "button", "data-key": key, onclick: () => { time = key; draw(); } }, text));
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
  const seconds = (v) => (v >= 1 ? sig(v, 3) + " s" : v >= 1e-3 ? sig(v * 1e3, 3) + " ms" : sig(v * 1e6, 3) + " µs");
  const power = (v) => { const e = Math.round(Math.log10(v)); return Math.abs(v / 10 ** e - 1) < 1e-6 ? "10" + String(e).replace(/[-0-9]/g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻") : sig(v, 1); };

  function draw() {
    for (const b of buttons) b.setAttribute("aria-pressed", String(b.dataset.key === time));
    grid.replaceChildren(...DATA.errors.map(chart));
  }
  function chart(name) {
    const points = good.filter((p) => isNumber(p.errors[name]) && p[time] > 0);
    const tip = h("div", { class: "tip" });
    const W = 580, H = 380, L = 62, R = 14, T = 12, B = 44;
    const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": "run time against error of " + name });
    const box = h("div", { class: "chart" }, h("h3", {}, DATA.descriptions[name] || name, " ", DATA.descriptions[name] ? h("code", {}, name) : null), svg, tip);
    if (!points.length) { tip.textContent = "No method gave this result."; return box; }
    const positive = points.map((p) => Math.abs(p.errors[name])).filter((e) => e > 0);
    // An error of exactly zero stands at the left edge.
    const floor = positive.length ? Math.min(...positive) / 2 : 1e-16;
    const err = (p) => Math.max(Math.abs(p.errors[name]), floor);
    const span = (v) => { let lo = Math.min(...v), hi = Math.max(...v); const f = Math.max(1.25, (hi / lo) ** 0.07); return [lo / f, hi * f]; };
    const [x0, x1] = span(points.map(err)), [y0, y1] = span(points.map((p) => p[time]));
    const X = (v) => L + (Math.log(v / x0) / Math.log(x1 / x0)) * (W - L - R), Y = (v) => H - B - (Math.log(v / y0) / Math.log(y1 / y0)) * (H - T - B);
    for (const t of logTicks(x0, x1)) {
      s("line", { x1: X(t), x2: X(t), y1: T, y2: H - B, style: "stroke:var(--grid)" }, svg);
      s("text", { x: X(t), y: H - B + 16, "text-anchor": "middle", class: "dim" }, svg, power(t));
    }
    for (const t of logTicks(y0, y1)) {
      s("line", { x1: L, x2: W - R, y1: Y(t), y2: Y(t), style: "stroke:var(--grid)" }, svg);
      s("text", { x: L - 7, y: Y(t) + 4, "text-anchor": "end", class: "dim" }, svg, seconds(t).replace(/\.0+ /, " "));
    }
    s("rect", { x: L, y: T, width: W - L - R, height: H - T - B, style: "fill:none;stroke:var(--line)" }, svg);
    s("text", { x: (L + W - R) / 2, y: H - 8, "text-anchor": "middle" }, svg, "relative error");
    methods.forEach((m, i) => {
      const own = points.filter((p) => p.method === m);
      if (!own.length) return;
      s("path", { d: own.map((p, k) => (k ? "L" : "M") + X(err(p)).toFixed(1) + "," + Y(p[time]).toFixed(1)).join(""), style: `fill:none;stroke:${color(i)};stroke-width:1.8;opacity:.85` }, svg);
      for (const p of own) {
        const x = X(err(p)), y = Y(p[time]);
        if (p.is_default) {
          s("circle", { cx: x, cy: y, r: 10, style: `fill:none;stroke:${color(i)};stroke-width:2` }, svg);
          const left = x > W - 170;
          s("text", { x: x + (left ? -14 : 14), y: y - 8, "text-anchor": left ? "end" : "start", style: "paint-order:stroke;stroke:var(--bg);stroke-width:4px" }, svg, p.setting);
        }
        const g = mark(svg, marks[i % 4], x, y, 5, color(i));
        s("title", {}, g, text(p));
        g.addEventListener("pointerenter", () => { tip.textContent = text(p); });
      }
    });
    function text(p) { return `${p.method}, ${p.setting}${p.is_default ? " (default)" : ""}: ${seconds(p[time])}, error ${sig(p.errors[name], 2)}`; }
    return box;
  }
  draw();
})();
