// The page of one run.
(function () {
  const bar = document.getElementById("bar");
  if (!bar) return;
  const theta = arrays[DATA.series.axis.at];
  const columns = new Map(), order = [];
  for (const c of DATA.series.columns) {
    const entry = { name: c.name, unit: c.unit, at: c.at, x: theta, y: arrays[c.at] };
    columns.set(c.name, entry);
    order.push(entry);
  }
  const lo = theta[0], hi = theta[theta.length - 1];
  const cycle = new Cycle(lo, hi > lo ? hi : lo + 1, 0.5);
  cycleBar(bar, cycle);
  const packHost = document.getElementById("pack");
  if (DATA.section && DATA.section.rings && DATA.section.rings.length) packSection(packHost, cycle, DATA.section, columns);
  else packHost.remove();

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
  const add = (lines, spec, where) => { if (lines.length) plot(where || host, cycle, Object.assign({ lines, unit: lines[0].unit }, spec)); };
  const sum = (lines, label) => {
    if (lines.length < 2) return [];
    const y = new Float32Array(lines[0].y.length);
    for (const l of lines) for (let i = 0; i < y.length; i++) y[i] += l.y[i];
    return [{ label, x: theta, y, unit: lines[0].unit, color: "var(--fg)", dash: "2 3", thin: true }];
  };

  // Pressures: what is below a ring has the ring's colour, what is behind it the same colour dashed.
  const p = [...take("cylinder.p", "cylinder", { color: "var(--fg)" })];
  if (p.length) used.add("land1.p"); else p.push(...take("land1.p", "land 1", { color: "var(--fg)" }));
  for (let k = 2; k <= lands; k++) {
    const crankcase = k === n + 1;
    p.push(...take(`land${k}.p`, crankcase ? "crankcase" : `land ${k}`, { color: crankcase ? "var(--muted)" : color(k - 2) }));
  }
  for (let i = 1; i <= n; i++) p.push(...take(`ring${i}.back.p`, "behind ring " + i, { color: color(i - 1), dash: "5 4" }));
  add(p, { title: "Gas pressures", hint: n > 1 ? "absolute; land 2 is below ring 1; behind the rings dashed" : n ? "absolute; behind the ring dashed" : "absolute", modes: ["log", "linear"], height: 320, events: events(/^(land|cylinder)/) });

  // The piston across its bore.
  const sides = events(/^(thrust side|anti-thrust side|piston)$/);
  const edges = (key, title, hint) => add([...take("skirt.e_top" + key, "upper", { color: color(0) }), ...take("skirt.e_bottom" + key, "lower", { color: color(1) })], { title, hint, events: sides });
  edges("", "Skirt across the bore", "its upper and lower edge, towards the anti-thrust side positive");
  edges("_rate", "Velocity across the bore", "of its upper and lower edge, towards the anti-thrust side positive");
  const both = (key, title, hint, spec) => {
    const lines = [...take("thrust." + key, "thrust", { color: color(0) }), ...take("anti_thrust." + key, "anti-thrust", { color: color(1) })];
    // Surfaces that never touch need no picture of it.
    if (lines.some((l) => l.y.some((v) => v !== 0))) add(lines, Object.assign({ title, hint }, spec));
  };
  add([...take("skirt.side_force", "film and contact", { color: color(0) }), ...take("rod.side_force", "rod", { color: color(1), dash: "5 4" })], { title: "Forces across the bore", hint: "towards the anti-thrust side positive", events: sides });
  both("h_min", "Smallest gap", "of the thrust and the anti-thrust side", { modes: ["linear", "log"] });
  both("p_max", "Highest film pressure", "of the thrust and the anti-thrust side, above that of the crankcase", { modes: ["linear", "log"] });
  both("contact_force", "Force of solid contact", "of the thrust and the anti-thrust side, across the bore");
  add(take("skirt.friction_force", "skirt", { color: color(0) }), { title: "Friction force of the skirt", hint: "on the piston, away from the head positive" });
  add(take("skirt.friction_power", "skirt", { color: color(0) }), { title: "Friction power of the skirt" });

  const position = perRing("position");
  add(position.map((l) => Object.assign(l, { short: l.label.replace("ring ", "R") })), { title: "Rings in their grooves", hint: "0 on the lower flank, 1 on the upper", lanes: true, events: events(/^ring/) });
  if (!position.length) add(perRing("lift"), { title: "Ring lift", hint: "height above the lower flank", events: events(/^ring/) });
  else for (let i = 1; i <= n; i++) if (!columns.has(`ring${i}.position`)) add(take(`ring${i}.lift`, "ring " + i, { color: color(i - 1) }), { title: `Lift of ring ${i}` });

  add(perRing("h_min"), { title: "Film thickness", hint: "smallest over the running face", modes: ["linear", "log"], height: 250 });

  const flow = perRing("flow"), rate = columns.has("blow_by.rate") ? take("blow_by.rate", "blow-by", { color: "var(--fg)", dash: "2 3" }) : [];
  add([...flow, ...rate], { title: "Gas past the rings", hint: "instantaneous, towards the crankcase positive" });
  add([...perRing("cumulative_mass"), ...take("blow_by.cumulative", "blow-by", { color: "var(--fg)", dash: "2 3" })], { title: "Gas past the rings, cumulative", hint: "a falling curve is blow-back" });

  const friction = perRing("friction_force");
  add([...friction, ...sum(friction, "all rings")], { title: "Friction force", hint: "on the rings, towards the head positive" });
  const power = perRing("friction_power");
  add([...power, ...sum(power, "all rings")], { title: "Friction power" });

  const forces = [["gas", 0, ""], ["inertia", 1, ""], ["film", 2, ""], ["damping", 3, ""], ["flank", 7, "5 4"]];
  for (let i = 1; i <= n; i++) {
    const lines = forces.flatMap(([key, c, dash]) => take(`ring${i}.force_${key}`, key === "flank" ? "flank reaction" : key, { color: color(c), dash }));
    add(lines, { title: `Axial forces on ring ${i}`, hint: "towards the head positive", modes: ["±log", "linear"], height: 240, events: events(new RegExp(`^ring${i}$`)) });
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
  if (n || p.length) later.push(...others); else later.unshift(...others);
  if (!n && !p.length) for (const [lines, spec] of later) add(lines, spec);
  else if (later.length) {
    let drawn = false;
    more.addEventListener("toggle", () => {
      if (!more.open || drawn) return;
      drawn = true;
      for (const [lines, spec] of later) add(lines, spec, more);
    });
    addEventListener("beforeprint", () => { more.open = true; });
    host.append(more);
    if (/[#&]more\b/.test(location.hash)) more.open = true;
  }
  if (DATA.series.every > 1) host.append(h("p", { class: "hint" }, `Curves on this page show every ${DATA.series.every}th row of series.csv.`));

  // Events become links to their angle.
  const list = document.getElementById("event-list");
  if (list && DATA.events.length) {
    const ul = h("ul");
    for (const e of DATA.events) {
      const go = () => { cycle.play(false); cycle.pin(e.theta_deg); bar.scrollIntoView({ block: "start" }); };
      ul.append(h("li", {}, h("button", { type: "button", title: "show this angle", onclick: go },
        h("b", { style: "color:" + subjectColor(e.subject) }, e.theta_deg.toFixed(1) + "°"), " " + readable(e.subject) + " " + e.what)));
    }
    list.replaceChildren(ul);
  }
})();
