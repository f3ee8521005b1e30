// Saving a figure: SVG and PNG as it stands, CSV of its numbers.
const LOOKS = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "stroke-linecap", "opacity", "font-size", "font-weight", "font-family", "text-anchor", "visibility", "paint-order"];

function saveFile(name, type, parts) {
  const url = URL.createObjectURL(new Blob(parts, { type }));
  const a = h("a", { download: name });
  a.href = url;
  a.click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
const fileName = (title, end) => title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") + "." + end;

// A copy of a drawing that looks the same without the style sheet of the page, with its title and a legend.
function standalone(svg, spec) {
  const copy = svg.cloneNode(true), from = svg.querySelectorAll("*"), to = copy.querySelectorAll("*");
  from.forEach((e, i) => {
    const style = getComputedStyle(e);
    to[i].removeAttribute("class");
    to[i].setAttribute("style", LOOKS.map((p) => `${p}:${style.getPropertyValue(p)}`).join(";"));
  });
  const [, , w, high] = svg.getAttribute("viewBox").split(" ").map(Number);
  const page = getComputedStyle(document.body), lines = spec.lines || [], head = 30 + 18 * Math.ceil(lines.length / 4);
  const out = s("svg", { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${w} ${high + head}`, width: w, height: high + head });
  s("rect", { width: w, height: high + head, style: "fill:" + page.backgroundColor }, out);
  const font = `font-family:${page.fontFamily.replace(/"/g, "'")};fill:${page.color}`;
  s("text", { x: 8, y: 20, style: font + ";font-size:15px;font-weight:600" }, out, spec.title);
  lines.forEach((l, i) => {
    const x = 8 + (i % 4) * (w / 4), y = 38 + 18 * Math.floor(i / 4);
    const probe = h("i", { style: "color:" + l.color });
    document.body.append(probe);
    s("line", { x1: x, x2: x + 18, y1: y - 4, y2: y - 4, style: `stroke:${getComputedStyle(probe).color};stroke-width:2.4`, "stroke-dasharray": l.dash || "none" }, out);
    probe.remove();
    s("text", { x: x + 24, y, style: font + ";font-size:12px" }, out, l.label);
  });
  const inner = s("g", { transform: `translate(0,${head})` }, out);
  inner.append(...copy.childNodes);
  return [out, w, high + head];
}

function saveSvg(svg, spec) {
  const [copy] = standalone(svg, spec);
  saveFile(fileName(spec.title, "svg"), "image/svg+xml", [new XMLSerializer().serializeToString(copy)]);
}
function savePng(svg, spec) {
  const [copy, w, high] = standalone(svg, spec), image = new Image();
  image.onload = () => {
    const canvas = h("canvas", { width: 2 * w, height: 2 * high });
    canvas.getContext("2d").drawImage(image, 0, 0, 2 * w, 2 * high);
    canvas.toBlob((blob) => saveFile(fileName(spec.title, "png"), "image/png", [blob]));
  };
  image.src = "data:image/svg+xml," + encodeURIComponent(new XMLSerializer().serializeToString(copy));
}
// Columns of all curves in SI units, or of what `columns` says; curves over other abscissas follow in columns of their own.
function saveCsv(spec) {
  const columns = [], cell = (t) => (/[",\n]/.test(t) ? '"' + t.replace(/"/g, '""') + '"' : t);
  for (const l of spec.columns || spec.lines) {
    if (!columns.some((c) => c.values === l.x)) columns.push({ name: `${spec.xName || "theta"}[${spec.cycle ? "deg" : spec.xUnit || ""}]`, values: l.x });
    columns.push({ name: `${l.label}[${l.unit || ""}]`, values: l.y });
  }
  const rows = Math.max(...columns.map((c) => c.values.length)), out = [columns.map((c) => cell(c.name)).join(",")];
  for (let i = 0; i < rows; i++) out.push(columns.map((c) => (i < c.values.length ? String(c.values[i]) : "")).join(","));
  saveFile(fileName(spec.title, "csv"), "text/csv", [out.join("\n") + "\n"]);
}

// The menu of a figure.
function saveMenu(svg, spec) {
  const item = (name, go) => h("button", { type: "button", onclick: () => { menu.open = false; go(); } }, name);
  const all = [item("SVG", () => saveSvg(svg, spec)), item("PNG", () => savePng(svg, spec))];
  if (spec.lines || spec.columns) all.push(item("CSV", () => saveCsv(spec)));
  const menu = h("details", { class: "saving" }, h("summary", { "aria-label": "save " + spec.title }, "Save"), h("div", {}, ...all));
  return menu;
}
