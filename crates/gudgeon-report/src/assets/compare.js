// The page of a comparison: every curve of every variant, one plot per quantity.
(function () {
  const bar = document.getElementById("bar"), host = document.getElementById("plots");
  if (!bar) return;
  // Runs that go over no cycle are drawn by the script of the figures.
  if (!host) { bar.remove(); return; }
  const variants = DATA.variants.filter((v) => arrays[v.series.axis.at].length);
  if (!variants.length) return;
  const lo = Math.min(...variants.map((v) => arrays[v.series.axis.at][0]));
  const hi = Math.max(...variants.map((v) => arrays[v.series.axis.at].at(-1)));
  const cycle = (CYCLE = new Cycle(lo, hi > lo ? hi : lo + 1, 0.5));
  cycleBar(bar, cycle);
  host.className = "figures";
  const names = new Map();
  for (const v of variants) for (const c of v.series.columns) if (!names.has(c.name)) names.set(c.name, c.unit);
  if (names.has("cylinder.p")) names.delete("land1.p");
  let n = 0;
  for (const name of names.keys()) { const m = /^ring(\d+)\./.exec(name); if (m) n = Math.max(n, +m[1]); }
  const known = [
    [/^cylinder\.p$/, () => "Cylinder pressure", 0, ["log", "linear"]],
    [/^land(\d+)\.p$/, (k) => (+k === n + 1 ? "Crankcase pressure" : `Pressure in land ${k}`), 1, ["linear", "log"]],
    [/^ring(\d+)\.back\.p$/, (k) => `Pressure behind ring ${k}`, 2, ["linear", "log"]],
    [/^blow_by\.cumulative$/, () => "Blow-by, cumulative", 3],
    [/^blow_by\.rate$/, () => "Blow-by, instantaneous", 4],
    [/^ring(\d+)\.position$/, (k) => `Ring ${k} in its groove (0 lower flank, 1 upper)`, 5],
    [/^ring(\d+)\.h_min$/, (k) => `Film thickness of ring ${k}`, 6, ["linear", "log"]],
    [/^ring(\d+)\.friction_force$/, (k) => `Friction force of ring ${k}`, 7],
    [/^ring(\d+)\.friction_power$/, (k) => `Friction power of ring ${k}`, 8],
    [/^ring(\d+)\.contact_load$/, (k) => `Contact load of ring ${k}`, 9],
    [/^ring(\d+)\.flow$/, (k) => `Gas past ring ${k}`, 10],
    [/^ring(\d+)\.cumulative_mass$/, (k) => `Gas past ring ${k}, cumulative`, 11],
    [/^ring(\d+)\.lift$/, (k) => `Lift of ring ${k}`, 12],
  ];
  const list = [];
  for (const [name, unit] of names) {
    let found = null;
    for (const [test, title, rank, modes] of known) {
      const m = test.exec(name);
      if (m) { found = { name, unit, title: title(m[1]), rank, modes, k: +(m[1] || 0) }; break; }
    }
    if (/\.lift$/.test(name) && names.has(name.replace("lift", "position"))) continue;
    list.push(found || { name, unit, title: DATA.names[name] || name, rank: 20, k: 0, modes: ["linear", "±log"] });
  }
  list.sort((a, b) => a.rank - b.rank || a.k - b.k);
  const dashes = ["", "7 4", "2 3", "9 3 2 3"];
  const more = h("details", { class: "more" }, h("summary", {}, "More curves"));
  const later = [];
  for (const q of list) {
    const lines = [];
    for (const v of variants) {
      const c = v.series.columns.find((c) => c.name === q.name);
      if (!c) continue;
      // Variants that share a curve share one line.
      const same = lines.find((l) => l.at === c.at && l.x === arrays[v.series.axis.at]);
      if (same) { same.numbers.push(v.number); continue; }
      lines.push({ numbers: [v.number], at: c.at, x: arrays[v.series.axis.at], y: arrays[c.at], color: color(v.number - 1), dash: dashes[(v.number - 1) % 4] });
    }
    for (const l of lines) {
      l.label = l.numbers.length === variants.length && variants.length > 1 ? "all variants" : l.numbers.join(", ");
      l.title = l.numbers.map((k) => variants.find((v) => v.number === k).label).join("; ");
      if (l.numbers.length === 1) l.label += "  " + values(l.title);
    }
    const spec = { cycle, title: q.title, unit: q.unit, lines, modes: lines.length > 1 ? [...(q.modes || ["linear"]), "difference"] : q.modes };
    if (q.rank >= 9 && q.rank < 20) later.push(spec); else new Chart(host, spec);
  }
  function values(label) {
    const cut = DATA.cases > 1 ? label.indexOf(": ") + 2 : 0;
    return label.slice(0, cut) + label.slice(cut).split(",").map((p) => p.split("=").at(-1).trim()).join(", ");
  }
  if (later.length) {
    let drawn = false;
    more.addEventListener("toggle", () => { if (!more.open || drawn) return;
      drawn = true;
      const inner = h("div", { class: "figures" });
      more.append(inner);
      for (const spec of later) new Chart(inner, spec);
    });
    host.after(more);
  }
})();
