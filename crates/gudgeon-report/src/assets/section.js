// The moving section of the ring pack. `get(name)` gives the value of a column at the shown angle, or undefined.
function packSection(host, cycle, geometry, columns) {
  const get = (name) => { const c = columns.get(name); return c ? at(c.x, c.y, cycle.shown) : undefined; };
  const rings = geometry.rings, n = rings.length;
  const landName = (k) => (k === 1 ? "cylinder" : k === n + 1 ? "crankcase" : "land " + k);
  const landP = (k) => (k === 1 && columns.has("cylinder.p") ? get("cylinder.p") : get("land" + k + ".p"));
  const sealed = (i) => rings[i].clearance <= 0;

  // Pressure as colour: one logarithmic scale for all gas spaces over the whole cycle, ever darker upwards.
  const stops = [[236, 244, 251], [190, 217, 240], [139, 180, 225], [113, 136, 207], [125, 90, 182], [147, 48, 144], [150, 16, 94], [112, 0, 44]];
  let pLo = Infinity, pHi = 0;
  for (const [name, c] of columns) if (/^(cylinder|land\d+|ring\d+\.back)\.p$/.test(name)) for (const v of c.y) if (v > 0) { pLo = Math.min(pLo, v); pHi = Math.max(pHi, v); }
  const known = pHi > 0;
  if (known) { pLo /= 1.05; pHi *= 1.02; if (pHi / pLo < 1.5) pHi = pLo * 1.5; }
  const level = (p) => clamp(Math.log(p / pLo) / Math.log(pHi / pLo), 0, 1);
  const shade = (p) => {
    if (!known || !(p > 0)) return "var(--soft)";
    const x = level(p) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(x)), f = x - i;
    return "rgb(" + stops[i].map((a, k) => Math.round(a + f * (stops[i + 1][k] - a))).join(",") + ")";
  };
  const bar = (p) => (isNumber(p) ? sig(p * 1e-5, 4) + " bar" : "");

  // Axial layout. Clearances are magnified; everything else in the axial direction keeps one scale.
  const round = (x) => { const p = 10 ** Math.floor(Math.log10(x)); return [5, 4, 3, 2, 1.5, 1].find((k) => k * p <= x * 1.001) * p; };
  const W = 640, xLeft = 14, xLand = 336, crevice = 42, xLiner = xLand + crevice, linerWidth = 40, xText = xLiner + linerWidth + 12;
  const total = geometry.length || rings[n - 1].groove_bottom * 1.15;
  const k = Math.min(430 / total, 24e3);
  const largest = Math.max(...rings.map((r) => r.clearance), 1e-9);
  const axial = Math.max(1, round(15 / (largest * k)));
  // Radial layout next to the liner: film and face profile on a scale of their own.
  let hTop = 0;
  rings.forEach((r, i) => { const c = columns.get("ring" + (i + 1) + ".h_min"); if (c) hTop = Math.max(hTop, maxAbs(c.y)); });
  if (!hTop) hTop = 1e-5;
  const film = round(25 / (hTop * k)), um = film * k;
  // The exaggerated land clearance is added to the rings, so that they stand in their grooves as far as real ones.
  const radial = (r) => r.width * k + crevice - 6;
  const y0 = 54;
  let y = y0, above = 0;
  const place = rings.map((r) => {
    y += Math.max(6, (r.groove_bottom - r.groove_height - above) * k);
    const top = y;
    y += r.height * k + Math.max(r.clearance, 0) * axial * k;
    above = r.groove_bottom;
    const root = Math.min(xLand - r.groove_depth * k, xLiner - radial(r) - hTop * um - 6);
    return { top, bottom: y, root: Math.max(root, 150) };
  });
  const yEnd = y + Math.max(14, (total - above) * k), H = yEnd + 30;

  const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": "section of the ring pack at the shown crank angle" });
  const hatch = s("pattern", { id: "hatch", width: 7, height: 7, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, s("defs", {}, svg));
  s("rect", { width: 7, height: 7, style: "fill:var(--metal)" }, hatch);
  s("line", { y2: 7, style: "stroke:var(--metal2);stroke-width:1.6" }, hatch);
  // Gas spaces first, metal over them.
  const edge = "stroke:none";
  const gas = [];
  const mid = (p) => (p.top + p.bottom) / 2;
  const chamber = s("rect", { x: xLeft, y: 6, width: xLiner - xLeft, height: y0 - 6, style: edge }, svg);
  for (let j = 0; j <= n; j++) {
    const a = j === 0 ? y0 : mid(place[j - 1]), b = j === n ? H - 4 : mid(place[j]);
    gas.push(s("rect", { x: xLand - 1, y: a, width: crevice + 1, height: b - a, style: edge }, svg));
  }
  const below = s("rect", { x: xLeft, y: yEnd, width: xLiner - xLeft, height: H - 4 - yEnd, style: edge }, svg);
  const back = place.map((p) => s("rect", { x: p.root, y: p.top, width: xLand - p.root, height: p.bottom - p.top, style: edge }, svg));
  let d = `M${xLeft},${y0}H${xLand}`;
  for (const p of place) d += `V${p.top}H${p.root}V${p.bottom}H${xLand}`;
  s("path", { d: d + `V${yEnd}H${xLeft}Z`, style: "fill:var(--metal);stroke:var(--ring);stroke-width:1.2" }, svg);
  s("rect", { x: xLiner, y: 6, width: linerWidth, height: H - 10, style: "fill:url(#hatch)" }, svg);
  s("line", { x1: xLiner, x2: xLiner, y1: 6, y2: H - 4, style: "stroke:var(--ring);stroke-width:1.4" }, svg);
  s("text", { x: xLiner + linerWidth / 2, y: H - 10, "text-anchor": "middle", style: "paint-order:stroke;stroke:var(--metal);stroke-width:5px" }, svg, "liner");
  s("text", { x: xLeft + 8, y: yEnd - 8, class: "dim" }, svg, "piston");

  const films = rings.map(() => s("path", { style: "fill:var(--oil)" }, svg));
  const bodies = rings.map(() => s("path", { style: "fill:var(--ring);stroke:var(--fg);stroke-width:.8;stroke-linejoin:round" }, svg));
  const names = rings.map((r, i) => s("text", { "text-anchor": "middle", style: "fill:var(--bg);pointer-events:none;font-size:11px", class: "strong" }, svg, "ring " + (i + 1)));
  const seats = rings.map(() => s("line", { style: "stroke:var(--c1);stroke-width:2.6;stroke-linecap:round" }, svg));
  const rubs = rings.map(() => s("line", { x1: xLiner, x2: xLiner, style: "stroke:var(--c1);stroke-width:3" }, svg));
  const arrows = rings.map(() => s("path", { style: "fill:var(--accent)" }, svg));

  // Labels: lands and films to the right, spaces behind the rings to the left, never on top of each other.
  const labels = [];
  for (let j = 0; j <= n; j++) {
    const a = j === 0 ? 26 : place[j - 1].bottom, b = j === 0 ? 26 : j === n ? H - 14 : place[j].top;
    labels.push({ y: j === n ? Math.max(a + 14, yEnd + 4) : (a + b) / 2, land: j + 1 });
    if (j < n) labels.push({ y: mid(place[j]), ring: j });
  }
  labels.reduce((last, l) => (l.y = Math.max(l.y, last + 17)), -20);
  for (const l of labels) {
    l.node = s("text", { x: xText, y: l.y + 4 }, svg);
    l.name = s("tspan", { class: l.land ? "" : "strong" }, l.node);
    l.value = s("tspan", { dx: 7, style: "font-weight:600" }, l.node);
    l.more = s("tspan", { dx: 7, style: "fill:var(--muted)" }, l.node);
  }
  const behind = place.map((p, i) => {
    const t = s("text", { x: p.root - 8, y: mid(p) + 4, "text-anchor": "end" }, svg);
    s("tspan", { class: "dim" }, t, "behind ring " + (i + 1));
    return s("tspan", { dx: 7, style: "font-weight:600" }, t);
  });

  // Scale bars.
  const nice = (px, per) => { const v = round(px / per); return [v, v * per]; };
  const [cm, cpx] = nice(26, axial * k), [fm, fpx] = nice(36, um);
  const scales = s("g", {}, svg);
  s("path", { d: `M${xLeft + 12},${y0 + 16}h8m-4,0v${cpx}m-4,0h8`, style: "fill:none;stroke:var(--fg)" }, scales);
  s("text", { x: xLeft + 26, y: y0 + 16 + cpx / 2 + 4 }, scales, sig(cm * 1e3, 1) + " mm clearance");
  s("path", { d: `M${xLeft + 12},${y0 + 30 + cpx}v8m0,-4h${fpx}m0,-4v8`, style: "fill:none;stroke:var(--fg)" }, scales);
  s("text", { x: xLeft + 20 + fpx, y: y0 + 38 + cpx }, scales, sig(fm * 1e6, 1) + " µm film");

  const times = (x) => "×" + tickText(+x.toPrecision(2));
  const caption = h("figcaption", {}, `Rings, grooves and lands to scale. Axial clearance ${times(axial)}, film and face profile ${times(film)}; ` +
    "radial clearances at the lands and behind the rings are not to scale, and a face is cut off where it drops to the land. Orange: a ring on its flank, or rubbing on the liner. Arrows on the liner: gas past each ring." +
    (rings.some((r, i) => !columns.has("ring" + (i + 1) + ".position")) ? " Rings without a computed position are drawn on their lower flank." : ""));
  const side = h("div", { class: "side" });
  const box = h("div", { class: "pack" });
  host.append(box);
  box.append(h("figure", {}, svg, caption), side);
  const crank = crankGlyph(cycle, geometry, columns);
  const table = nowTable(cycle, n, get, columns);
  const scale = known ? colourBar(cycle, { shade, level, pLo, pHi, n, landP, get, landName }) : null;
  side.append(h("div", { class: "top" }, crank, table));
  if (scale) side.append(scale);

  let flowTop = 0;
  rings.forEach((r, i) => { const c = columns.get("ring" + (i + 1) + ".flow"); if (c) flowTop = Math.max(flowTop, maxAbs(c.y)); });

  cycle.on((what) => {
    if (!(what & 1)) return;
    const p = [];
    for (let j = 1; j <= n + 1; j++) { p[j] = landP(j); gas[j - 1].style.fill = shade(p[j]); }
    chamber.style.fill = shade(p[1]);
    below.style.fill = shade(p[n + 1]);
    rings.forEach((r, i) => {
      const id = "ring" + (i + 1), q = place[i];
      const e = clamp(get(id + ".position") || 0, -0.05, 1.05), film = Math.max(0, get(id + ".h_min") || 0);
      const pb = get(id + ".back.p");
      back[i].style.fill = shade(pb);
      behind[i].textContent = bar(pb);
      const low = q.bottom - e * Math.max(r.clearance, 0) * axial * k, top = low - r.height * k;
      const x = (drop) => Math.max(xLand + 3, xLiner - (film + drop) * um);
      const inner = Math.max(q.root + 3, xLiner - film * um - radial(r));
      // Faces from the bottom edge up; a twin-land ring has two with a drained recess between them.
      const twin = r.lands > 1 && 2 * r.face_length < r.height;
      const drops = r.face_drop.length > 1 ? r.face_drop : [0, 0];
      const face = (start) => drops.map((v, j) => [x(v), start - (j / (drops.length - 1)) * r.face_length * k]);
      // The recess of a twin-land ring is drained: it belongs to the space below.
      if (twin) { set(gas[i], { height: top + r.face_length * k - gas[i].y.baseVal.value }); set(gas[i + 1], { y: top + r.face_length * k, height: (i + 1 === n ? H - 4 : mid(place[i + 1])) - top - r.face_length * k }); }
      const single = low - Math.max(0, (r.height - r.face_length) / 2) * k;
      const faces = twin ? [face(low), face(top + r.face_length * k)] : [face(single)];
      const xCorner = (v) => Math.max(xLand + 1, v - 5);
      let body = `M${inner},${low}`;
      if (!twin && single < low - 0.5) body += `L${xCorner(faces[0][0][0])},${low}`;
      faces.forEach((f, j) => {
        if (j) body += `H${xLand + 8}V${f[0][1]}`;
        for (const [a, b] of f) body += `L${a.toFixed(1)},${b.toFixed(1)}`;
      });
      if (!twin && single < low - 0.5) body += `L${xCorner(faces[0][drops.length - 1][0])},${top}`;
      bodies[i].setAttribute("d", body + `L${inner},${top}Z`);
      films[i].setAttribute("d", faces.map((f) => `M${xLiner},${f[0][1]}` + f.map(([a, b]) => `L${a.toFixed(1)},${b.toFixed(1)}`).join("") + `L${xLiner},${f[f.length - 1][1]}Z`).join(""));
      set(names[i], { x: (inner + xLand + 8) / 2, y: (low + top) / 2 + 4, visibility: low - top < 13 ? "hidden" : "visible" });
      const seat = sealed(i) ? null : e < 0.01 ? low : e > 0.99 ? top : null;
      set(seats[i], seat === null || !columns.has(id + ".position") ? { visibility: "hidden" } : { visibility: "visible", x1: inner + 2, x2: xLand - 1, y1: seat, y2: seat });
      const rub = get(id + ".contact_load") > 0;
      set(rubs[i], { visibility: rub ? "visible" : "hidden", y1: faces[0][0][1], y2: faces[faces.length - 1][drops.length - 1][1] });
      const flow = get(id + ".flow"), size = flowTop ? Math.sqrt(Math.abs(flow) / flowTop) : 0;
      if (isNumber(flow) && size > 0.05) {
        const c = mid(q), l = 8 + 26 * size, w = 2 + 3 * size, g = flow > 0 ? 1 : -1, xa = xLiner + linerWidth / 2;
        arrows[i].setAttribute("d", `M${xa - w},${c - (g * l) / 2}H${xa + w}V${c + g * (l / 2 - 8)}H${xa + w + 5}L${xa},${c + (g * l) / 2}L${xa - w - 5},${c + g * (l / 2 - 8)}H${xa - w}Z`);
      } else arrows[i].setAttribute("d", "");
    });
    for (const l of labels) {
      if (l.land) { l.name.textContent = landName(l.land); l.value.textContent = bar(p[l.land]); continue; }
      const id = "ring" + (l.ring + 1), v = get(id + ".h_min"), flow = get(id + ".flow");
      l.name.textContent = "ring " + (l.ring + 1);
      l.value.textContent = isNumber(v) ? sig(v * 1e6, 3) + " µm" : "";
      l.more.textContent = isNumber(flow) ? (flow >= 0 ? "↓ " : "↑ ") + sig(Math.abs(flow) * 1e6, 3) + " mg/s" : "";
    }
  });
}

// Crank, rod and piston, turning clockwise.
function crankGlyph(cycle, geometry, columns) {
  const y = columns.get("piston.y"), stroke = geometry.stroke || (y ? Math.max(...y.y) - Math.min(...y.y) : 0);
  if (!(stroke > 0)) return null;
  const r = stroke / 2, rod = y ? Math.max(...y.y) - r : 3.5 * r, px = 46 / r, W = 150, cx = W / 2;
  const cy = 20 + 30 + (r + rod) * px, H = cy + 46 + 8, bore = Math.min(52, Math.max(30, (geometry.bore_radius || r) * px));
  const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, style: `max-width:${W}px;max-height:320px`, "aria-hidden": "true" });
  for (const g of [-1, 1]) s("line", { x1: cx + g * (bore + 2), x2: cx + g * (bore + 2), y1: 10, y2: cy - 52, style: "stroke:var(--metal2);stroke-width:4" }, svg);
  s("line", { x1: cx - bore - 4, x2: cx + bore + 4, y1: 10, y2: 10, style: "stroke:var(--metal2);stroke-width:4" }, svg);
  s("circle", { cx, cy, r: 46, style: "fill:none;stroke:var(--line)" }, svg);
  const piston = s("g", {}, svg);
  s("rect", { x: cx - bore, y: -30, width: 2 * bore, height: 52, rx: 2, style: "fill:var(--metal);stroke:var(--ring)" }, piston);
  for (let i = 0; i < geometry.rings.length; i++) s("line", { x1: cx - bore, x2: cx + bore, y1: -23 + 7 * i, y2: -23 + 7 * i, style: "stroke:var(--ring);stroke-width:2" }, piston);
  const link = s("line", { style: "stroke:var(--fg);stroke-width:4;stroke-linecap:round" }, svg);
  const throwLine = s("line", { x1: cx, y1: cy, style: "stroke:var(--accent);stroke-width:5;stroke-linecap:round" }, svg);
  for (const [a, b] of [[cx, cy]]) s("circle", { cx: a, cy: b, r: 4, style: "fill:var(--fg)" }, svg);
  cycle.on((what) => {
    if (!(what & 1)) return;
    const t = (cycle.shown * Math.PI) / 180, x = r * Math.sin(t);
    const pin = y ? at(y.x, y.y, cycle.shown) : r * Math.cos(t) + Math.sqrt(rod * rod - x * x);
    const py = cy - pin * px;
    piston.setAttribute("transform", `translate(0,${py})`);
    set(throwLine, { x2: cx + x * px, y2: cy - r * Math.cos(t) * px });
    set(link, { x1: cx, y1: py, x2: cx + x * px, y2: cy - r * Math.cos(t) * px });
  });
  return svg;
}

// Numbers at the shown angle.
function nowTable(cycle, n, get, columns) {
  const rows = [
    ["position in groove", "position", 1, ""], ["film", "h_min", 1e6, "µm"], ["gas past ring", "flow", 1e6, "mg/s"],
    ["gas force", "force_gas", 1, "N"], ["inertia force", "force_inertia", 1, "N"], ["film force", "force_film", 1, "N"], ["damping force", "force_damping", 1, "N"],
    ["flank reaction", "force_flank", 1, "N"], ["radial load", "radial_load", 1, "N"], ["contact load", "contact_load", 1, "N"],
    ["friction", "friction_force", 1, "N"], ["friction power", "friction_power", 1, "W"],
  ].filter(([, key]) => Array.from({ length: n }, (_, i) => columns.has(`ring${i + 1}.${key}`)).some(Boolean));
  const cells = [];
  const body = h("tbody");
  const single = [["piston speed", "piston.v", 1, "m/s"], ["piston accel.", "piston.a", 1, "m/s²"], ["blow-by", "blow_by.rate", 1e6, "mg/s"]].filter(([, name]) => columns.has(name));
  const digits = (v, key) => (key === "position" ? (isNumber(v) ? v.toFixed(3) : "–") : isNumber(v) && Math.abs(v) < 1e-3 ? "0" : sig(v, 3));
  for (const [label, key, f, unit] of rows) {
    const tr = h("tr", {}, h("th", { scope: "row" }, label));
    for (let i = 1; i <= n; i++) { const td = h("td", { class: "num" }); tr.append(td); cells.push(() => { td.textContent = columns.has(`ring${i}.${key}`) ? digits(get(`ring${i}.${key}`) * f, key) : "–"; }); }
    tr.append(h("td", { class: "unit" }, unit));
    body.append(tr);
  }
  for (const [label, name, f, unit] of single) {
    const td = h("td", { class: "num", colspan: n });
    cells.push(() => { td.textContent = digits(get(name) * f); });
    body.append(h("tr", {}, h("th", { scope: "row" }, label), td, h("td", { class: "unit" }, unit)));
  }
  const headRow = h("tr", {}, h("th", {}, "Now"), ...Array.from({ length: n }, (_, i) => h("th", { class: "num" }, "ring " + (i + 1))), h("td"));
  cycle.on((what) => { if (what & 1) for (const f of cells) f(); });
  return h("table", { class: "plain now-table" }, h("thead", {}, headRow), body);
}

// Logarithmic pressure scale with a mark for every gas space.
function colourBar(cycle, o) {
  const W = 560, L = 10, R = 10, top = 62, H = top + 50;
  const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": "pressure scale" });
  const X = (p) => L + o.level(p) * (W - L - R), N = 96;
  for (let i = 0; i < N; i++) {
    const p = o.pLo * (o.pHi / o.pLo) ** ((i + 0.5) / N);
    s("rect", { x: L + (i / N) * (W - L - R), y: top, width: (W - L - R) / N + 0.6, height: 14, style: "fill:" + o.shade(p) }, svg);
  }
  for (const t of logTicks(o.pLo * 1e-5, o.pHi * 1e-5)) {
    const x = X(t * 1e5);
    s("line", { x1: x, x2: x, y1: top + 14, y2: top + 18, style: "stroke:var(--muted)" }, svg);
    s("text", { x, y: top + 30, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
  }
  s("text", { x: W - R, y: H - 1, "text-anchor": "end", class: "dim" }, svg, "bar absolute");
  s("text", { x: L, y: H - 1, class: "dim" }, svg, "Gas pressure: cylinder, L lands, B behind rings, crankcase");
  const marks = [];
  for (let j = 1; j <= o.n + 1; j++) {
    marks.push({ name: j === 1 ? "cyl" : j === o.n + 1 ? "case" : "L" + j, title: o.landName(j), p: () => o.landP(j) });
    if (j <= o.n) marks.push({ name: "B" + j, title: "behind ring " + j, p: () => o.get("ring" + j + ".back.p") });
  }
  for (const m of marks) {
    m.tick = s("path", { style: "fill:none;stroke:var(--fg)" }, svg);
    m.text = s("text", { "text-anchor": "middle" }, svg, m.name);
    s("title", {}, m.text, m.title);
  }
  cycle.on((what) => {
    if (!(what & 1)) return;
    const rows = [[], [], [], []];
    const live = marks.map((m) => ({ m, v: m.p() })).filter((a) => { const ok = a.v > 0; set(a.m.tick, { visibility: ok ? "visible" : "hidden" }); set(a.m.text, { visibility: ok ? "visible" : "hidden" }); return ok; });
    live.sort((a, b) => a.v - b.v);
    for (const { m, v } of live) {
      const x = X(v), half = m.name.length * 3.3 + 3, c = clamp(x, half, W - half);
      let r = rows.findIndex((row) => row.every(([a, b]) => c + half < a || c - half > b));
      if (r < 0) { set(m.text, { visibility: "hidden" }); continue; }
      rows[r].push([c - half, c + half]);
      const ty = top - 8 - r * 15;
      set(m.text, { x: c, y: ty });
      set(m.tick, { d: `M${x},${top + 2}V${top - 5}` });
    }
  });
  return svg;
}
