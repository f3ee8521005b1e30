// The page of one run.
(function () {
  const bar = document.getElementById("bar");
  if (!bar) return;
  if (!DATA.series) { bar.remove(); return; }
  const theta = arrays[DATA.series.axis.at];
  const columns = new Map(), order = [];
  for (const c of DATA.series.columns) {
    const entry = { name: c.name, unit: c.unit, at: c.at, x: theta, y: arrays[c.at] };
    columns.set(c.name, entry);
    order.push(entry);
  }
  const lo = theta[0], hi = theta[theta.length - 1];
  const cycle = (CYCLE = new Cycle(lo, hi > lo ? hi : lo + 1, 0.5, loudest(columns)));
  cycleBar(bar, cycle);
  const lead = document.getElementById("lead");
  if (DATA.section && DATA.section.rings && DATA.section.rings.length) packSection(lead, cycle, DATA.section, columns);

  const host = document.getElementById("plots"), used = new Set();
  let n = 0;
  for (const c of order) { const m = /^ring(\d+)\./.exec(c.name); if (m) n = Math.max(n, +m[1]); }
  let lands = 0;
  for (const c of order) { const m = /^land(\d+)\./.exec(c.name); if (m) lands = Math.max(lands, +m[1]); }
  const take = (name, label, style) => {
    const c = columns.get(name);
    if (!c) return [];
    used.add(name);
    return [Object.assign({ label, title: name, x: c.x, y: c.y, unit: c.unit }, style)];
  };
  const perRing = (key, style) => {
    const out = [];
    for (let i = 1; i <= n; i++) out.push(...take(`ring${i}.${key}`, "ring " + i, Object.assign({ color: color(i - 1) }, style)));
    return out;
  };
  const subjectColor = (name) => {
    const m = /^(ring|land)(\d+)$/.exec(name);
    return m ? color(+m[2] - (m[1] === "ring" ? 1 : 2)) : "var(--fg)";
  };
  const readable = (name) => name.replace(/_/g, " ").replace(/^([a-z]+)(\d+)$/, "$1 $2");
  const events = (test) => DATA.events.filter((e) => test.test(e.subject)).map((e) => ({ t: e.theta_deg, color: subjectColor(e.subject), text: readable(e.subject) + " " + e.what }));
  const add = (lines, spec, where) => { if (lines.length) new Chart(where || host, Object.assign({ lines, unit: lines[0].unit, cycle }, spec)); };
  const sum = (lines, label) => {
    if (lines.length < 2) return [];
    const y = new Float32Array(lines[0].y.length);
    for (const l of lines) for (let i = 0; i < y.length; i++) y[i] += l.y[i];
    return [{ label, x: theta, y, unit: lines[0].unit, color: "var(--fg)", dash: "2 3", thin: true }];
  };

  // Which columns form a figure stands in over_cycle.json, for this page and for Python; here is how they look on it.
  const sides = events(/^(thrust side|anti-thrust side|piston)$/);
  const logarithm = { modes: ["linear", "log"] };
  const looks = {
    pressures: { modes: ["log", "linear"], events: events(/^(land|cylinder)/) },
    skirt: { events: sides }, skirt_velocity: { events: sides }, side_forces: { events: sides },
    skirt_gap: logarithm, skirt_pressure: logarithm, film: { modes: ["linear", "log"] },
    position: { lanes: true, events: events(/^ring/) }, lift: { events: events(/^ring/) },
  };
  const dashes = { dashed: "5 4", dotted: "2 3" };
  // A negative colour counts from the number in the name: what is below a ring has its colour.
  const curves = (g, only) => g.columns.flatMap(([name, label, c, dash]) => {
    const own = (k) => take(name.replace("#", k), label.replace("#", k), { color: c === "text" ? "var(--fg)" : color(c < 0 ? k + c : c), dash: dashes[dash] });
    if (!name.includes("#")) return own(0);
    const last = name.startsWith("land") ? lands : n, out = [];
    for (let k = only || 1; k <= (only || last); k++) out.push(...own(k));
    return out;
  });
  const titled = (g, k) => ({ title: g.title.replace("#", k), hint: g.hint });
  // What needs more than its columns.
  const special = {
    // The space above ring 1 is the cylinder, the one below the last ring the crankcase.
    pressures: (g) => {
      const p = curves(g).filter((l) => l.title !== "land1.p" || !columns.has("cylinder.p"));
      for (const l of p) {
        if (l.title === `land${n + 1}.p` && n) Object.assign(l, { label: "crankcase", color: "var(--muted)" });
        if (l.title === "land1.p") l.color = "var(--fg)";
      }
      add(p, Object.assign(titled(g), { hint: n ? g.hint : "absolute" }, looks.pressures));
    },
    position: (g) => add(curves(g).map((l) => Object.assign(l, { short: l.label.replace("ring ", "R") })), Object.assign(titled(g), looks.position)),
    // Where rings have a position, only those without one.
    lift: (g) => {
      const placed = (k) => columns.has(`ring${k}.position`);
      const rings = Array.from({ length: n }, (_, i) => i + 1);
      if (!rings.some(placed)) return add(curves(g), Object.assign(titled(g), looks.lift));
      for (const k of rings) if (!placed(k)) add(curves(g, k), { title: `Lift of ring ${k}` });
    },
    friction_force: (g) => { const l = curves(g); add([...l, ...sum(l, "all rings")], titled(g)); },
    friction_power: (g) => { const l = curves(g); add([...l, ...sum(l, "all rings")], titled(g)); },
    "ring#_forces": (g) => {
      for (let k = 1; k <= n; k++) add(curves(g, k), Object.assign(titled(g, k), { modes: ["±log", "linear"], events: events(new RegExp(`^ring${k}$`)) }));
    },
  };
  for (const g of OVER_CYCLE) {
    if (special[g.name]) { special[g.name](g); continue; }
    const lines = curves(g);
    // Surfaces that never touch need no picture of it.
    if (!g.unless_zero || lines.some((l) => l.y.some((v) => v !== 0))) add(lines, Object.assign(titled(g), looks[g.name]));
  }

  // The rest, drawn when it is opened.
  const more = h("details", { class: "more" }, h("summary", {}, "More curves"));
  const later = [];
  for (const [key, title, modes] of [["radial_load", "Radial load", ["linear", "log"]], ["contact_load", "Contact load"], ["axial_velocity", "Axial velocity in the groove"], ["h_rate", "Film thickness rate"], ["lift", "Ring lift"]]) {
    const lines = perRing(key).filter((l) => l);
    if (lines.length) later.push([lines, { title, modes }]);
  }
  for (const [name, title] of [["piston.y", "Gudgeon pin height above the crank axis"], ["piston.v", "Piston velocity"], ["piston.a", "Piston acceleration"]]) {
    const lines = take(name, "piston", { color: color(0) });
    if (lines.length) later.push([lines, { title, zero: name !== "piston.y" }]);
  }
  const rest = order.filter((c) => !used.has(c.name));
  const others = leftovers(rest).map((g) => [g.columns.map((c, i) => ({ label: c.name, title: c.name, x: c.x, y: c.y, unit: c.unit, color: color(i) })), {
    title: g.columns.length === 1 ? g.columns[0].name : "Others in " + (display(g.unit, g.max).label || "no unit"), modes: ["linear", "±log"] }]);
  // A scene without rings has its own curves first, and nothing to put them away behind.
  const pressures = columns.has("cylinder.p") || lands;
  if (n || pressures) later.push(...others); else later.unshift(...others);
  if (!n && !pressures) for (const [lines, spec] of later) add(lines, spec);
  else if (later.length) {
    let drawn = false;
    more.addEventListener("toggle", () => {
      if (!more.open || drawn) return;
      drawn = true;
      const inner = h("div", { class: "figures" });
      more.append(inner);
      for (const [lines, spec] of later) add(lines, spec, inner);
    });
    host.after(more);
    if (/[#&]more\b/.test(location.hash)) more.open = true;
  }
  if (DATA.series.every > 1) host.before(h("p", { class: "hint" }, `Curves on this page show every ${DATA.series.every}th row of series.csv.`));

  // The angle at which the page opens: the highest pressure between the rings, or in the cylinder.
  function loudest(all) {
    const c = all.get("land2.p") || all.get("cylinder.p");
    if (!c) return undefined;
    let best = 0;
    for (let i = 1; i < c.y.length; i++) if (c.y[i] > c.y[best]) best = i;
    return Math.round(c.x[best]);
  }

  // Events become links to their angle.
  const list = document.getElementById("event-list");
  if (list && DATA.events.length) {
    const ul = h("ul");
    for (const e of DATA.events) {
      const go = () => { cycle.play(false); cycle.pin(e.theta_deg); bar.scrollIntoView({ block: "start" }); };
      ul.append(h("li", {}, h("button", { type: "button", title: "show this angle", onclick: go },
        h("i", { style: "background:" + subjectColor(e.subject) }), h("b", {}, e.theta_deg.toFixed(1) + "°"), " " + readable(e.subject) + " " + e.what)));
    }
    list.replaceChildren(ul);
  }
})();
