// Figures that read no table: drawings to scale, still or moving, and bars.
function drawing(host, spec) {
  if (spec.apart) { apart(host, spec); return; }
  const fixed = spec.all ? spec.fixed.filter((o) => !o.text) : spec.fixed, { frames } = spec, all = [...fixed, ...(spec.all || frames).flatMap((f) => f.shapes)];
  let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity;
  const see = (x, y) => { x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y); };
  for (const o of all) {
    if (o.path) for (const p of o.path.points) see(p[0], p[1]);
    else if (o.circle) { const { centre: [x, y], radius: r } = o.circle; see(x - r, y - r); see(x + r, y + r); }
    else if (o.text) see(o.text.at[0], o.text.at[1]);
    else { const d = ends(o.dimension); for (const p of [d.a, d.b]) see(p[0], p[1]); }
  }
  if (!(x1 > x0) && !(y1 > y0)) return;
  // To scale: the same pixels a length in both directions, as wide as the page or as high as is pleasant.
  const M = 34, W = 620, k = Math.min((W - 2 * M) / (x1 - x0 || 1e-300), (spec.all ? 260 : 420) / (y1 - y0 || 1e-300));
  const H = k * (y1 - y0) + 2 * M, left = (W - k * (x1 - x0)) / 2;
  const X = (x) => (left + k * (x - x0)).toFixed(2), Y = (y) => (H - M - k * (y - y0)).toFixed(2);
  const svg = s("svg", { viewBox: `0 0 ${W} ${H.toFixed(0)}`, role: "img", "aria-label": spec.title + (spec.hint ? ": " + spec.hint : ""), class: "drawing" });
  const id = "d" + Math.random().toString(36).slice(2), defs = s("defs", {}, svg);
  const hatch = s("pattern", { id: id + "h", width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, defs);
  s("rect", { width: 6, height: 6, style: "fill:var(--metal)" }, hatch);
  s("line", { x1: 0, x2: 0, y1: 0, y2: 6, class: "hatch" }, hatch);
  const tip = s("marker", { id: id + "a", viewBox: "0 0 8 6", refX: 8, refY: 3, markerWidth: 8, markerHeight: 6, markerUnits: "userSpaceOnUse", orient: "auto-start-reverse" }, defs);
  s("path", { d: "M0,0L8,3L0,6z", class: "tip" }, tip);
  function ends(d) {
    const [ax, ay] = d.from, [bx, by] = d.to, l = Math.hypot(bx - ax, by - ay) || 1, nx = -(by - ay) / l, ny = (bx - ax) / l;
    return { a: [ax + d.offset * nx, ay + d.offset * ny], b: [bx + d.offset * nx, by + d.offset * ny] };
  }
  function put(o, group) {
    if (o.path) {
      const { points, closed, style } = o.path;
      if (points.length) s("path", { d: "M" + points.map((p) => X(p[0]) + "," + Y(p[1])).join("L") + (closed ? "z" : ""), class: style, ...(style === "cut" ? { style: `fill:url(#${id}h)` } : {}) }, group);
    } else if (o.circle) {
      const { centre, radius, style } = o.circle;
      s("circle", { cx: X(centre[0]), cy: Y(centre[1]), r: (k * radius).toFixed(2), class: style, ...(style === "cut" ? { style: `fill:url(#${id}h)` } : {}) }, group);
    } else if (o.text) {
      s("text", { x: X(o.text.at[0]), y: +Y(o.text.at[1]) + 4, "text-anchor": o.text.anchor }, group, o.text.text);
    } else {
      const d = o.dimension, { a, b } = ends(d), flip = b[0] < a[0] - 1e-12;
      for (const [p, q] of [[d.from, a], [d.to, b]]) s("line", { x1: X(p[0]), y1: Y(p[1]), x2: X(q[0]), y2: Y(q[1]), class: "thin" }, group);
      s("line", { x1: X(a[0]), y1: Y(a[1]), x2: X(b[0]), y2: Y(b[1]), class: "thin", "marker-start": `url(#${id}a)`, "marker-end": `url(#${id}a)` }, group);
      const mx = (+X(a[0]) + +X(b[0])) / 2, my = (+Y(a[1]) + +Y(b[1])) / 2;
      const turn = (Math.atan2(+Y(b[1]) - +Y(a[1]), +X(b[0]) - +X(a[0])) * 180) / Math.PI + (flip ? 180 : 0);
      s("text", { x: mx, y: my - 5, "text-anchor": "middle", transform: `rotate(${turn.toFixed(2)} ${mx.toFixed(2)} ${my.toFixed(2)})`, class: "dim" }, group, d.text);
    }
  }
  for (const o of fixed) put(o, svg);
  const moving = s("g", {}, svg), box = frameOf(host, spec, svg);
  const show = (i) => { moving.replaceChildren(); for (const o of frames[i].shapes) put(o, moving); };
  if (frames.length) show(0);
  // Pictures of a crank angle follow the one that all charts share.
  if (frames.length > 1 && isNumber(frames[0].at) && CYCLE) {
    const label = h("p", { class: "now" }), angles = frames.map((f) => f.at);
    let shown = -1;
    CYCLE.on((what) => {
      if (!(what & 1)) return;
      let i = 0;
      for (let k = 1; k < angles.length; k++) if (Math.abs(angles[k] - CYCLE.shown) < Math.abs(angles[i] - CYCLE.shown)) i = k;
      if (i !== shown) { show(i); label.textContent = frames[i].label; shown = i; }
    });
    box.append(label);
  } else if (frames.length > 1) {
    const slider = h("input", { type: "range", min: 0, max: frames.length - 1, value: 0, "aria-label": spec.title }), label = h("span", { class: "now" }, frames[0].label);
    const go = (i) => { slider.value = i; label.textContent = frames[i].label; show(i); };
    let timer = null;
    const play = h("button", { type: "button", onclick: () => {
      if (timer) { clearInterval(timer); timer = null; } else timer = setInterval(() => go((+slider.value + 1) % frames.length), 60);
      play.textContent = timer ? "Stop" : "Play";
    } }, "Play");
    slider.addEventListener("input", () => go(+slider.value));
    box.append(h("div", { class: "frames" }, play, slider, label));
  } else if (frames.length && frames[0].label) box.append(h("p", { class: "hint" }, frames[0].label));
}

// All frames of a drawing at once, on one scale.
function apart(host, spec) {
  const box = h("div", { class: "apart" });
  for (const f of spec.frames) drawing(box, { title: f.label, fixed: spec.fixed, frames: [{ shapes: f.shapes }], all: spec.frames });
  host.append(h("figure", { class: "plot wide" }, h("div", { class: "head" }, h("h3", {}, spec.title)), spec.hint ? h("p", { class: "hint" }, spec.hint) : null, box));
}

// Numbers in rows and columns with texts behind them; numbers beyond the limit are marked.
function table(host, spec) {
  const unit = (name, u) => { const d = display(u, 0); return d.f === 1 ? d.label : u; };
  const texts = spec.texts || [];
  const head = h("tr", {}, h("th", { scope: "col" }, spec.rows_are), ...spec.columns.map(([name, u]) => h("th", { scope: "col", class: "num" }, name, u ? h("span", { class: "unit" }, " " + unit(name, u)) : "")), ...texts.map(([name]) => h("th", { scope: "col" }, name)));
  const cell = (v) => h("td", { class: "num" + (isNumber(spec.limit) && v > spec.limit * (1 + 1e-9) ? " beyond" : "") }, isNumber(v) ? (Number.isInteger(v) && Math.abs(v) < 1e6 ? String(v).replace("-", "−") : sig(v, 4)) : "–");
  const rows = spec.rows.map(([label, values], k) => h("tr", {}, h("th", { scope: "row" }, label), ...values.map(cell), ...texts.map(([, t]) => h("td", {}, t[k]))));
  const csv = () => saveFile(fileName(spec.title, "csv"), "text/csv", [[[spec.rows_are, ...spec.columns.map(([n, u]) => `${n}[${u}]`), ...texts.map(([n]) => n)], ...spec.rows.map(([l, v], k) => [l, ...v.map((x) => (isNumber(x) ? x : "")), ...texts.map(([, t]) => t[k])])].map((r) => r.map((c) => (/[",]/.test(c) ? `"${String(c).replace(/"/g, '""')}"` : c)).join(",")).join("\n") + "\n"]);
  const top = h("div", { class: "head" }, h("h3", {}, spec.title), h("div", { class: "tools" }, h("button", { type: "button", onclick: csv }, "CSV")));
  host.append(h("figure", { class: "plot numbers" + (spec.columns.length + texts.length > 4 ? " wide" : "") }, top, spec.hint ? h("p", { class: "hint" }, spec.hint) : null, h("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": spec.title }, h("table", { class: "plain" }, h("thead", {}, head), h("tbody", {}, ...rows)))));
}

// A figure that holds all it shows: title, explanation, drawing.
function frameOf(host, spec, svg) {
  const head = h("div", { class: "head" }, h("h3", {}, spec.title), h("div", { class: "tools" }, saveMenu(svg, { title: spec.title })));
  const box = h("figure", { class: "plot still" + (spec.wide ? " wide" : "") }, head, spec.hint ? h("p", { class: "hint" }, spec.hint) : null, svg);
  host.append(box);
  return box;
}

function bars(host, spec) {
  // Room for the longest label, within reason.
  const L = Math.min(330, Math.max(210, 16 + 6.4 * Math.max(0, ...spec.bars.map((b) => b.label.length)))), most = Math.floor((L - 16) / 6.4);
  const W = 620, R = 70, row = 24, H = row * spec.bars.length + 34;
  const values = spec.bars.flatMap((b) => [b.value, b.limit]).filter(isNumber), lo = Math.min(0, ...values), hi = Math.max(0, ...values) || 1;
  const u = display(spec.unit, Math.max(Math.abs(lo), Math.abs(hi))), X = (v) => L + ((v - lo) / (hi - lo)) * (W - L - R);
  const told = spec.bars.map((b) => `${b.label} ${sig(b.value * u.f, 3)} ${u.label}` + (isNumber(b.limit) ? `, limit ${sig(b.limit * u.f, 3)}` : "")).join("; ");
  const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": spec.title + ": " + told, class: "bars" });
  for (const t of linearTicks(lo * u.f, hi * u.f, 6)) {
    s("line", { x1: X(t / u.f), x2: X(t / u.f), y1: 4, y2: H - 26, class: "gridline" }, svg);
    s("text", { x: X(t / u.f), y: H - 12, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
  }
  if (u.label) s("text", { x: W - 4, y: H - 12, "text-anchor": "end", class: "dim" }, svg, u.label);
  spec.bars.forEach((b, i) => {
    const y = 4 + row * i, over = isNumber(b.limit) && b.value > b.limit * (1 + 1e-9);
    const name = s("text", { x: L - 8, y: y + 15, "text-anchor": "end" }, svg, b.label.length > most ? b.label.slice(0, most - 1) + "…" : b.label);
    s("title", {}, name, b.label);
    if (!isNumber(b.value)) return;
    const a = X(Math.min(0, b.value)), e = X(Math.max(0, b.value));
    s("rect", { x: a, y: y + 4, width: Math.max(1, e - a), height: row - 8, class: over ? "over" : "within" }, svg);
    if (isNumber(b.limit)) s("line", { x1: X(b.limit), x2: X(b.limit), y1: y, y2: y + row, class: "limit" }, svg);
    // Beside the largest a small one has the decimals of that: a torque of 0.003 N m is none.
    const size = Math.max(Math.abs(lo), Math.abs(hi)) * u.f, places = Math.max(0, 3 - Math.floor(Math.log10(size)));
    const text = b.value && spec.unit && Math.abs(b.value * u.f) < 1e-3 * size ? (b.value * u.f).toFixed(places).replace("-", "−") : sig(b.value * u.f, 4);
    s("text", { x: Math.max(e, isNumber(b.limit) && b.limit - b.value < 0.2 * (hi - lo) ? X(b.limit) : e) + 6, y: y + 15, class: "strong" }, svg, text);
  });
  frameOf(host, spec, svg);
}
// Ranges: the swings of a tornado plot around a middle, or values with their intervals.
function ranges(host, spec) {
  const W = 620, L = 210, R = 70, row = 24, H = row * spec.ranges.length + 34, centred = isNumber(spec.middle);
  const values = spec.ranges.flatMap((r) => [r.low, r.high, r.value]).concat([spec.middle]).filter(isNumber);
  if (!values.length) return;
  let lo = Math.min(...values), hi = Math.max(...values);
  if (!centred) { lo = Math.min(0, lo); hi = Math.max(0, hi); }
  if (!(hi > lo)) { lo -= Math.abs(lo) || 1; hi += Math.abs(hi) || 1; }
  const u = display(spec.unit, Math.max(Math.abs(lo), Math.abs(hi))), X = (v) => L + ((v - lo) / (hi - lo)) * (W - L - R);
  const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": spec.title, class: "bars" });
  for (const t of linearTicks(lo * u.f, hi * u.f, 6)) {
    s("line", { x1: X(t / u.f), x2: X(t / u.f), y1: 4, y2: H - 26, class: "gridline" }, svg);
    s("text", { x: X(t / u.f), y: H - 12, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
  }
  if (u.label) s("text", { x: W - 4, y: H - 12, "text-anchor": "end", class: "dim" }, svg, u.label);
  const bar = (a, b, y, style) => s("rect", { x: Math.min(X(a), X(b)), y, width: Math.max(1, Math.abs(X(b) - X(a))), height: row - 8, class: style }, svg);
  spec.ranges.forEach((r, i) => {
    const y = 4 + row * i, from = centred ? spec.middle : r.value;
    s("text", { x: L - 8, y: y + 15, "text-anchor": "end" }, svg, r.label);
    const tip = [["low", r.low], ["value", r.value], ["high", r.high]].filter(([, v]) => isNumber(v)).map(([n, v]) => `${n} ${sig(v * u.f, 5)}`).join(", ");
    if (centred) {
      if (isNumber(r.low)) bar(from, r.low, y + 4, "second");
      if (isNumber(r.high)) bar(from, r.high, y + 4, "within");
    } else {
      if (isNumber(r.value)) bar(0, r.value, y + 4, "within");
      if (isNumber(r.low) && isNumber(r.high)) s("line", { x1: X(r.low), x2: X(r.high), y1: y + row / 2, y2: y + row / 2, class: "limit" }, svg);
    }
    s("title", {}, svg.lastChild, `${r.label}: ${tip} ${u.label}`);
  });
  if (centred) s("line", { x1: X(spec.middle), x2: X(spec.middle), y1: 2, y2: H - 28, class: "limit" }, svg);
  frameOf(host, spec, svg);
}
