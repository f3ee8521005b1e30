// A value over a rectangular grid: colours, contours with their values, the value under the pointer.
//
// spec: { title, hint, x, y, z, xName, yName, xUnit, yUnit, zUnit, marks }, one entry a grid point, x fastest; marks are points of the grid with a label.

// Dark to light, readable without colour vision: points of the map viridis (CC0).
const VIRIDIS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
function viridis(f) {
  const g = clamp(f, 0, 1) * (VIRIDIS.length - 1), k = Math.min(VIRIDIS.length - 2, Math.floor(g)), t = g - k;
  return VIRIDIS[k].map((c, i) => Math.round(c + t * (VIRIDIS[k + 1][i] - c)));
}

// Pieces of the line on which a grid of values has the value `level`, as [x1, y1, x2, y2] in numbers of columns and rows.
function contour(z, nx, ny, level) {
  const out = [];
  for (let j = 0; j + 1 < ny; j++) for (let i = 0; i + 1 < nx; i++) {
    const c = [z[j * nx + i], z[j * nx + i + 1], z[(j + 1) * nx + i + 1], z[(j + 1) * nx + i]];
    if (!c.every(isNumber)) continue;
    const crossed = [];
    for (let k = 0; k < 4; k++) {
      const a = c[k], b = c[(k + 1) % 4];
      if ((a < level) === (b < level)) continue;
      const f = (level - a) / (b - a);
      crossed.push([[i + f, j], [i + 1, j + f], [i + 1 - f, j + 1], [i, j + 1 - f]][k]);
    }
    // A saddle has four crossings: its middle says which belong together.
    if (crossed.length === 4 && ((c[0] + c[1] + c[2] + c[3]) / 4 < level) !== (c[0] < level)) crossed.push(crossed.shift());
    for (let k = 0; k + 1 < crossed.length; k += 2) out.push([...crossed[k], ...crossed[k + 1]]);
  }
  return out;
}

// A sign for each label of the marks: a cross where there is no result, an open sign for each reservation.
const SIGNS = { cross: "M-4,-4L4,4M-4,4L4,-4", all: ["M-4,0a4,4 0 1,0 8,0a4,4 0 1,0 -8,0Z", "M-4,-4H4V4H-4Z", "M0,-5L5,4H-5Z", "M0,-5L5,0L0,5L-5,0Z"] };
function signs(marks) {
  const out = new Map();
  for (const { point: p } of marks || []) {
    if (!p) continue;
    const open = [...out.values()].filter((l) => !l.beyond).length;
    if (!out.has(p.label)) out.set(p.label, { beyond: p.beyond, d: p.beyond ? SIGNS.cross : SIGNS.all[open % SIGNS.all.length], points: [] });
    out.get(p.label).points.push(p);
  }
  return out;
}

function map(host, spec) {
  const { x, y, z } = spec;
  let nx = 1;
  while (nx < y.length && y[nx] === y[0]) nx++;
  const ny = Math.floor(y.length / nx);
  const e = extent([[z, 1]]), lo = e.lo, range = e.hi - e.lo || Math.abs(e.hi) || 1;
  const xs = Array.from({ length: nx }, (_, i) => x[i]), ys = Array.from({ length: ny }, (_, j) => y[j * nx]);
  const ux = display(spec.xUnit, maxAbs(xs)), uy = display(spec.yUnit, maxAbs(ys)), uz = display(spec.zUnit, maxAbs(z));
  const L = 58, T = 10, B = 42, R = 74, W = 620, H = 340, bottom = H - B, right = W - R;
  const told = `${spec.title}: ${spec.zUnit ? "values" : "value"} from ${sig(lo * uz.f, 3)} to ${sig(e.hi * uz.f, 3)} ${uz.label} over ${spec.xName} and ${spec.yName}`;
  const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": told });
  const tip = h("div", { class: "tip" });
  const head = h("div", { class: "head" }, h("h3", {}, spec.title), h("div", { class: "tools" }, saveMenu(svg, { title: spec.title })));
  const marked = signs(spec.marks);
  const legend = [...marked].map(([label, l]) => {
    const sign = s("svg", { viewBox: "-7 -7 14 14", width: 14, height: 14, "aria-hidden": "true" });
    s("path", { d: l.d, class: l.beyond ? "sign none" : "sign" }, sign);
    return h("li", {}, sign, ` ${label} (${l.points.length})`);
  });
  if (marked.size && Array.from(z).some((v) => !isNumber(v))) legend.push(h("li", {}, "grey: beside a point without a result"));
  host.append(h("figure", { class: "plot map" }, head, spec.hint ? h("p", { class: "hint" }, spec.hint) : null, svg, legend.length ? h("ul", { class: "signs" }, ...legend) : null, tip));
  const X = (v) => L + ((v - xs[0]) / (xs[nx - 1] - xs[0] || 1)) * (right - L), Y = (v) => bottom - ((v - ys[0]) / (ys[ny - 1] - ys[0] || 1)) * (bottom - T);
  const canvas = h("canvas", { width: right - L, height: bottom - T }), g = canvas.getContext("2d"), image = g.createImageData(right - L, bottom - T);
  // Each pixel from the four points round it; the grid may be graded.
  const places = (v, n, count) => {
    const out = [];
    for (let i = 0, k = 0; i < n; i++) {
      const at = v[0] + ((i + 0.5) / n) * (v[count - 1] - v[0]);
      while (k < count - 2 && v[k + 1] < at) k++;
      out.push([k, (at - v[k]) / (v[k + 1] - v[k] || 1)]);
    }
    return out;
  };
  const column = places(xs, image.width, nx), row = places(ys, image.height, ny);
  const value = (c, r) => {
    const [i, a] = c, [j, b] = r, i1 = Math.min(i + 1, nx - 1), j1 = Math.min(j + 1, ny - 1);
    return (1 - b) * ((1 - a) * z[j * nx + i] + a * z[j * nx + i1]) + b * ((1 - a) * z[j1 * nx + i] + a * z[j1 * nx + i1]);
  };
  for (let j = 0; j < image.height; j++) for (let i = 0; i < image.width; i++) {
    const v = value(column[i], row[j]), at = 4 * ((image.height - 1 - j) * image.width + i);
    const [r, gr, b] = isNumber(v) ? viridis((v - lo) / range) : [128, 128, 128];
    image.data[at] = r; image.data[at + 1] = gr; image.data[at + 2] = b; image.data[at + 3] = 255;
  }
  g.putImageData(image, 0, 0);
  s("image", { x: L, y: T, width: right - L, height: bottom - T, href: canvas.toDataURL(), preserveAspectRatio: "none" }, svg);
  const levels = linearTicks(lo * uz.f, (lo + range) * uz.f, 6).filter((t) => t > lo * uz.f && t < e.hi * uz.f);
  const place = (v, p) => { const i = Math.min(v.length - 2, Math.floor(p)); return v.length < 2 ? v[0] : v[i] + (p - i) * (v[i + 1] - v[i]); };
  const placed = [];
  for (const t of levels) {
    const pieces = contour(z, nx, ny, t / uz.f).map(([a, b, c, d]) => [X(place(xs, a)), Y(place(ys, b)), X(place(xs, c)), Y(place(ys, d))]);
    if (!pieces.length) continue;
    s("path", { d: pieces.map((p) => `M${p[0].toFixed(1)},${p[1].toFixed(1)}L${p[2].toFixed(1)},${p[3].toFixed(1)}`).join(""), class: "contour" }, svg);
    // Its value stands where the line is nearest to the middle of the picture.
    const far = (p) => Math.hypot(p[0] - (L + right) / 2, p[1] - (T + bottom) / 2);
    const p = pieces.reduce((a, b) => (far(b) < far(a) ? b : a));
    if (placed.some((q) => Math.abs(q[0] - p[0]) < 34 && Math.abs(q[1] - p[1]) < 14)) continue;
    placed.push(p);
    s("text", { x: p[0], y: p[1] + 4, "text-anchor": "middle", class: "contourtext" }, svg, tickText(t));
  }
  for (const [label, l] of marked) for (const p of l.points) {
    const sign = s("path", { d: l.d, transform: `translate(${X(p.x).toFixed(1)},${Y(p.y).toFixed(1)})`, class: l.beyond ? "sign none" : "sign" }, svg);
    s("title", {}, sign, label);
  }
  const ticksOf = (a, b, f, room, unit) => {
    const from = Math.min(a, b) * f, to = Math.max(a, b) * f;
    // Whole turns are read by quarters.
    return unit === "deg" && to - from >= 360 ? linearTicks(from / 90, to / 90, (to - from) / 90).map((t) => 90 * t) : linearTicks(from, to, room);
  };
  for (const t of ticksOf(xs[0], xs[nx - 1], ux.f, 6, spec.xUnit)) s("text", { x: X(t / ux.f), y: bottom + 15, "text-anchor": "middle", class: "dim" }, svg, tickText(t));
  for (const t of ticksOf(ys[0], ys[ny - 1], uy.f, 5, spec.yUnit)) s("text", { x: L - 7, y: Y(t / uy.f) + 4, "text-anchor": "end", class: "dim" }, svg, tickText(t));
  const named = (name, u) => name + (u.label ? " [" + u.label + "]" : "");
  s("text", { x: (L + right) / 2, y: H - 8, "text-anchor": "middle" }, svg, named(spec.xName, ux));
  s("text", { x: 12, y: (T + bottom) / 2, "text-anchor": "middle", transform: `rotate(-90 12 ${(T + bottom) / 2})` }, svg, named(spec.yName, uy));
  for (let k = 0; k < 64; k++) s("rect", { x: right + 12, y: bottom - ((k + 1) / 64) * (bottom - T), width: 12, height: (bottom - T) / 64 + 0.6, style: `fill:rgb(${viridis((k + 0.5) / 64).join(",")})` }, svg);
  for (const t of linearTicks(lo * uz.f, (lo + range) * uz.f, 5)) s("text", { x: right + 28, y: bottom - ((t / uz.f - lo) / range) * (bottom - T) + 4, class: "dim" }, svg, tickText(t));
  s("text", { x: right + 12, y: H - 8 }, svg, uz.label);
  svg.addEventListener("pointermove", (event) => {
    const r = svg.getBoundingClientRect(), i = Math.floor(((event.clientX - r.left) / r.width) * W - L), j = Math.floor(bottom - ((event.clientY - r.top) / r.height) * H);
    if (!column[i] || !row[j]) { tip.textContent = ""; return; }
    const at = (v, p, n) => v[0] + ((p + 0.5) / n) * (v[v.length - 1] - v[0]);
    tip.textContent = `${spec.xName} ${sig(at(xs, i, image.width) * ux.f, 4)} ${ux.label}, ${spec.yName} ${sig(at(ys, j, image.height) * uy.f, 4)} ${uy.label}: ${sig(value(column[i], row[j]) * uz.f, 5)} ${uz.label}`;
  });
  svg.addEventListener("pointerleave", () => { tip.textContent = ""; });
}
