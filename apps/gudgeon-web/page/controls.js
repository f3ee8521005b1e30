// The panel of inputs: sliders and choices, as the module names them.

function element(tag, attributes, ...children) {
  const e = document.createElement(tag);
  for (const k in attributes || {}) {
    if (k.startsWith("on")) e.addEventListener(k.slice(2), attributes[k]);
    else if (attributes[k] === true) e.setAttribute(k, "");
    else if (attributes[k] !== undefined && attributes[k] !== null && attributes[k] !== false) e.setAttribute(k, attributes[k]);
  }
  e.append(...children.filter((c) => c !== null && c !== undefined));
  return e;
}

// A number as a case writes it: without the rounding of a slider's steps.
const plainNumber = (x) => String(+x.toPrecision(9));

class Controls {
  // `change(path, literal)` is told what a person moves.
  constructor(sliders, choices, more, change) {
    Object.assign(this, { sliders, choices, more, change, known: new Map(), shown: [] });
    more.addEventListener("change", () => { if (more.value) { this.shown.push(more.value); this.draw(); this.rows.get(this.shown.at(-1))?.range.focus(); } });
  }
  // Another case: what was shown is forgotten.
  reset() { this.known.clear(); this.shown = []; this.last = null; }
  // What the module says of the text. Ends of a slider stay where they were, or it would run away under the pointer.
  update(opened) {
    this.last = opened;
    for (const s of opened.sliders) {
      const k = this.known.get(s.path);
      if (!k || k.unit !== s.unit) {
        this.known.set(s.path, { ...s, start: s.value });
        if (s.first && !k && !this.settled) this.shown.push(s.path);
      } else {
        Object.assign(k, { value: s.value, about: s.about, low: Math.min(k.low, s.value), high: Math.max(k.high, s.value) });
      }
    }
    this.settled = true;
    const now = new Set(opened.sliders.map((s) => s.path));
    const want = this.shown.filter((p) => now.has(p)).join("\n") + "|" + opened.choices.map((c) => c.path + c.words.length).join("\n");
    if (want !== this.layout) { this.layout = want; this.draw(); } else this.refresh();
  }
  literal(s, value) { return s.unit ? `"${plainNumber(value)} ${s.unit}"` : plainNumber(value); }
  draw() {
    const opened = this.last, now = new Map(opened.sliders.map((s) => [s.path, s]));
    this.rows = new Map();
    this.sliders.replaceChildren(...this.shown.filter((p) => now.has(p)).map((p) => this.row(this.known.get(p))));
    if (!opened.sliders.length) this.sliders.append(element("p", { class: "hint" }, "This case names other cases and has no numbers of its own: open those."));
    this.more.replaceChildren(element("option", { value: "" }, "Add a slider…"));
    const groups = new Map();
    for (const s of opened.sliders) {
      if (this.shown.includes(s.path)) continue;
      if (!groups.has(s.of)) groups.set(s.of, element("optgroup", { label: s.of || "case" }));
      groups.get(s.of).append(element("option", { value: s.path }, s.label + (s.unit ? ` [${s.unit}]` : "")));
    }
    this.more.append(...groups.values());
    this.more.hidden = !groups.size;
    this.selects = new Map();
    const models = opened.choices.filter((c) => c.kind), words = opened.choices.filter((c) => !c.kind);
    const other = element("details", {}, element("summary", {}, `${words.length} other choices`), ...words.map((c) => this.select(c)));
    this.choices.replaceChildren(...models.map((c) => this.select(c)), ...(words.length ? [other] : []));
    this.refresh();
  }
  row(s) {
    const name = s.label + (s.of ? " of " + s.of : ""), id = "s-" + s.path.replace(/\W/g, "-");
    const range = element("input", { type: "range", id, min: s.low, max: s.high, step: s.step, "aria-label": name + (s.unit ? " in " + s.unit : ""), "data-path": s.path });
    const number = element("input", { type: "number", step: "any", "aria-label": name + ", typed", value: s.value });
    const back = element("button", { type: "button", class: "back", title: "back to the start value", "aria-label": "back to the start value of " + name }, "↺");
    const move = (v) => { if (!isFinite(v)) return; s.value = v; this.refresh(); this.change(s.path, this.literal(s, v)); };
    range.addEventListener("input", () => move(Math.abs(+range.value - s.start) < s.step * 0.4 ? s.start : +range.value));
    number.addEventListener("change", () => move(+number.value));
    back.addEventListener("click", () => { move(s.start); range.focus(); });
    const row = element("div", { class: "slider", title: s.about },
      element("label", { for: id }, s.label, s.of ? element("small", {}, s.of) : null), back,
      element("span", { class: "value" }, number, element("span", { class: "unit" }, unitText(s.unit))), range);
    this.rows.set(s.path, { s, row, range, number, back });
    return row;
  }
  select(c) {
    const id = "c-" + c.path.replace(/\W/g, "-");
    const list = element("select", { id, "data-path": c.path }, ...c.words.map(([w, about]) => element("option", { value: w, title: about }, w.replace(/_/g, " "))));
    list.addEventListener("change", () => this.change(c.path, list.value === "true" || list.value === "false" ? list.value : `"${list.value}"`));
    this.selects.set(c.path, list);
    return element("div", { class: "choice" }, element("label", { for: id }, c.label, c.of ? element("small", {}, c.of) : null), list);
  }
  refresh() {
    for (const { s, row, range, number, back } of this.rows.values()) {
      if (range !== document.activeElement || Math.abs(+range.value - s.value) > s.step) range.value = s.value;
      range.min = s.low; range.max = s.high;
      if (number !== document.activeElement) number.value = plainNumber(s.value);
      const changed = s.value !== s.start;
      row.classList.toggle("changed", changed);
      back.style.visibility = changed ? "visible" : "hidden";
    }
    for (const c of this.last.choices) {
      const list = this.selects.get(c.path);
      if (list) { list.value = c.value; list.title = (c.words.find(([w]) => w === c.value) || [])[1] || ""; }
    }
  }
  disable(off) { for (const list of this.selects?.values() ?? []) list.disabled = off; for (const r of this.rows?.values() ?? []) r.range.disabled = r.number.disabled = off; }
}
