// The figures of a page, in their order; the one that leads stands on the first page.
(function () {
  const capital = (t) => t.charAt(0).toUpperCase() + t.slice(1);
  const words = (t) => t.replace(/_/g, " ");
  const host = document.getElementById("figures"), lead = document.getElementById("lead");
  const column = (table, name) => [table.axis, ...table.columns].find((c) => c.name === name);

  function lines(f, k, where, wide) {
    const table = DATA.tables[f.table], x = table && column(table, k.x);
    if (!x) return;
    const pair = ([label, name], i) => {
      const c = column(table, name), own = k.own_x && column(table, k.own_x[i]);
      return c && { label, title: name, x: arrays[(own || x).at], y: arrays[c.at], unit: c.unit, color: color(i), dash: i > 7 ? "6 4" : "" };
    };
    const all = k.lines.map(pair).filter(Boolean);
    if (!all.length) return;
    const over = k.over && pair(k.over, 0);
    if (over) all.push({ ...over, color: "var(--fg)", dash: "2 3" });
    const rays = (k.rays || []).map(pair).filter(Boolean);
    new Chart(where, {
      title: capital(f.title), hint: f.hint, xName: words(k.own_x ? x.name.split(".").pop() : x.name), xUnit: x.unit, lines: all, logX: k.log_x, pickX: !rays.length, wide,
      modes: rays.length ? ["linear"] : k.log_y ? ["log", "linear"] : ["linear", "log"],
      rays: rays.length ? rays : undefined, marks: k.marks, top: k.top, yName: k.y_name, scatter: k.scatter,
    });
  }
  function map2(f, k, where) {
    const table = DATA.tables[f.table];
    if (!table) return;
    const [x, y, z] = [k.x, k.y, k.value].map((name) => column(table, name));
    if (x && y && z) map(where, { title: capital(f.title), hint: f.hint, x: arrays[x.at], y: arrays[y.at], z: arrays[z.at], xName: words(x.name), yName: words(y.name), xUnit: x.unit, yUnit: y.unit, zUnit: z.unit, marks: k.marks });
  }
  function spectra(f, k, where, wide) {
    const table = DATA.tables[f.table];
    if (!table) return;
    const found = ([label, name]) => { const c = column(table, name); return c && { label, unit: c.unit, values: arrays[c.at] }; };
    const abscissas = k.x.map((n) => found([words(n), n])).filter(Boolean), y = found([words(k.y), k.y]), all = k.spectra.map(found).filter(Boolean);
    if (abscissas.length && y && all.length) new Waterfall(where, { title: capital(f.title), hint: f.hint, abscissas, y, spectra: all, wide });
  }
  // Units in explanations as they are typeset.
  const typeset = (t) => (t || "").replace(/ um\b/g, " µm").replace(/(\d) deg\b/g, "$1°");
  function draw(f, where, wide) {
    f = { ...f, hint: typeset(f.hint) };
    const [[kind, k]] = Object.entries(f.kind), spec = { title: capital(f.title), hint: f.hint, wide, ...k };
    ({ lines: () => lines(f, k, where, wide), map: () => map2(f, k, where), waterfall: () => spectra(f, k, where, wide), drawing: () => drawing(where, spec), bars: () => bars(where, spec), ranges: () => ranges(where, spec), table: () => table(where, spec) })[kind]();
  }
  // Figures that hold nothing to draw are left out before one is chosen to lead.
  const all = (DATA.figures || []).filter((f) => !(f.kind.lines || f.kind.map || f.kind.waterfall) || DATA.tables[f.table]);
  const first = lead && !lead.childElementCount ? all.find((f) => f.title === DATA.lead) || all[0] : null;
  if (first) draw(first, lead, true);
  if (host) {
    for (const f of all) if (f !== first) draw(f, host);
    if (!host.childElementCount) host.closest("section")?.remove();
  }

  // A comparison of runs that do not go over a cycle: one drawing per column, one curve per variant.
  const overlay = document.getElementById("overlay");
  if (overlay && DATA.variants) {
    overlay.className = "figures";
    const names = new Map();
    for (const v of DATA.variants) for (const c of v.series.columns) names.set(c.name, c.unit);
    for (const name of names.keys()) {
      const curves = [];
      let axis;
      for (const v of DATA.variants) {
        const c = v.series.columns.find((c) => c.name === name);
        if (!c || !arrays[v.series.axis.at].length) continue;
        axis = v.series.axis;
        curves.push({ label: v.number + " " + v.label, x: arrays[axis.at], y: arrays[c.at], unit: c.unit, color: color(v.number - 1), dash: v.number > 8 ? "6 4" : "" });
      }
      if (curves.length) new Chart(overlay, { title: DATA.names[name] || name, xName: axis.name, xUnit: axis.unit, lines: curves, modes: ["linear", "log"], pickX: true });
    }
  }

  // The contents at the side name the figures as well.
  for (const f of document.querySelectorAll("main section > * > figure.plot > .head h3, main .chart h3")) {
    const section = f.closest("section"), link = section && document.querySelector(`nav.contents a[href="#${section.id}"]`);
    if (!link || section.id === "overview") continue;
    f.id = f.id || "f" + ++charts;
    const list = link.parentNode.querySelector("ul") || link.parentNode.appendChild(h("ul"));
    list.append(h("li", {}, h("a", { href: "#" + f.id }, f.textContent)));
  }
})();
