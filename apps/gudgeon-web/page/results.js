// Headlines and the table of all results, each with its change against the start.

const UNITS = { "kg/m3": "kg/m³", "N/m2": "N/m²", "m3": "m³", "mm3": "mm³", "mm2": "mm²", "mm4": "mm⁴", "m2": "m²", "m/s2": "m/s²", deg: "°", um: "µm", "um/s": "µm/s", "N m": "N·m", "kg m2": "kg·m²", degC: "°C" };
const unitText = (u) => UNITS[u] || (u || "").replace(/^[-1]$/, "");

function number(x, n = 4) {
  if (!isFinite(x)) return "–";
  if (x === 0) return "0";
  const e = Math.floor(Math.log10(Math.abs(x)));
  if (e < -4 || e > 6) { const [m, p] = x.toExponential(n - 1).split("e"); return m.replace("-", "−") + "×10" + p.replace("+", "").replace(/[-0-9]/g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻"); }
  const t = Number.isInteger(x) && Math.abs(x) < 1e4 ? String(x) : x.toFixed(Math.max(0, n - 1 - e));
  return t.replace(/-/g, "−");
}
// The change in words: in per cent, or plainly where the start was nothing.
function difference(value, start) {
  if (start === undefined || value === start) return { text: "", size: 0 };
  if (start === 0) return { text: (value > 0 ? "+" : "") + number(value, 3), size: 1 };
  const p = ((value - start) / Math.abs(start)) * 100;
  if (Math.abs(p) < 0.005) return { text: "", size: 0 };
  const t = Math.abs(p) >= 1000 ? "×" + number(value / start, 3) : (p > 0 ? "+" : "−") + number(Math.abs(p), Math.abs(p) < 10 ? 2 : 3) + " %";
  return { text: t, size: Math.sign(p) * Math.min(1, Math.abs(p) / 10) };
}

// What a result is, or its name where that would not fit a tile.
function shortName(r) {
  const text = r.what && r.what.length <= 40 ? r.what : r.name.replace(/[._]/g, " ").replace(/([a-z])(\d)/g, "$1 $2");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

class Results {
  constructor(tiles, table, filter, count) {
    Object.assign(this, { tiles, table, filter, count });
    filter.addEventListener("input", () => this.all());
  }
  // `trust(name, value)`: the value to show and whether it holds, for a preview whose settings do not give every result.
  show(run, start, trust) {
    Object.assign(this, { run, start });
    this.values = new Map(run.results.map((r) => [r.name, trust ? trust(r) : { value: r.value, holds: true }]));
    const by = new Map(run.results.map((r) => [r.name, r]));
    const names = [...new Set(run.headlines)].slice(0, 8);
    for (const r of run.results) { if (names.length >= 6) break; if (!names.includes(r.name) && !/_angle$/.test(r.name)) names.push(r.name); }
    this.tiles.replaceChildren(...names.map((n) => this.tile(by.get(n))));
    this.all();
  }
  tile(r) {
    const { value, holds } = this.values.get(r.name), d = difference(value, this.start?.get(r.name));
    return element("div", { class: "tile" + (holds ? "" : " stale"), title: r.what, "data-result": r.name },
      element("dt", {}, shortName(r)),
      element("dd", {}, element("b", { class: number(value).length > 7 ? "long" : null }, number(value)), " ", element("span", { class: "unit" }, unitText(r.unit)),
        element("span", { class: "change " + (d.size > 0 ? "up" : d.size < 0 ? "down" : "") }, d.text ? (d.size > 0 ? "▲ " : d.size < 0 ? "▼ " : "") + d.text : "")));
  }
  all() {
    if (!this.run) return;
    const wanted = this.filter.value.trim().toLowerCase();
    const rows = this.run.results.filter((r) => !wanted || (r.name + " " + r.what).toLowerCase().includes(wanted));
    this.count.textContent = `${rows.length} of ${this.run.results.length}`;
    if (!this.table.closest("details")?.open) { this.table.replaceChildren(); return; }
    this.table.replaceChildren(...rows.map((r) => {
      const { value, holds } = this.values.get(r.name), d = difference(value, this.start?.get(r.name));
      return element("tr", { class: holds ? null : "stale" }, element("th", { scope: "row" }, element("code", {}, r.name), " ", r.what), element("td", { class: "num" }, number(value)), element("td", { class: "unit" }, unitText(r.unit)), element("td", { class: "num change" }, d.text));
    }));
  }
}
