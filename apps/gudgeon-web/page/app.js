// The page: which case, what is changed, what runs when.

const $ = (id) => document.getElementById(id);
// A run that takes longer is shown by a preview first and waits until the sliders rest.
const QUICK = 250;
// What a preview gives within this share of the full run at the start is shown; the rest waits for the full run.
const HOLDS = 0.02;

class App {
  constructor(module) {
    this.quick = new Engine(module);
    this.full = new Engine(module);
    this.controls = new Controls($("sliders"), $("choices"), $("more"), (path, literal) => this.change(path, literal));
    this.editor = new Editor($("editor"), () => this.typed(), (text, offset) => this.quick.ask({ ask: "help", text, offset }));
    this.drawing = new Drawing($("drawing"));
    this.results = new Results($("tiles"), $("all-rows"), $("filter"), $("count"));
    // Changes that are not yet written into the text.
    this.pending = new Map();
    // Counts what was asked for: an answer to an older question is dropped.
    this.turn = 0;
    this.history = [];
    // What was shown of this case so far and how long it took, for whoever measures.
    this.log = [];
  }
  async start() {
    await script((await this.quick.ask({ ask: "drawings" })).script);
    const c = await this.quick.ask({ ask: "catalogue" });
    this.catalogue = c;
    $("version").textContent = c.version + (c.revision ? " · " + c.revision : "");
    const order = ["ring_pack", "power_cylinder", "piston_secondary", "shaft_line", "pin", "rig"];
    const names = [...order, ...c.scenes.map((s) => s.name).filter((n) => !order.includes(n))];
    for (const name of names) {
      const own = c.cases.filter((k) => k.scene === name);
      if (own.length) $("case").append(element("optgroup", { label: name.replace(/_/g, " ") }, ...own.map((k) => element("option", { value: k.file, title: k.title }, k.title))));
    }
    $("case").addEventListener("change", () => this.load($("case").value));
    $("undo").addEventListener("click", () => this.undo());
    $("restart").addEventListener("click", () => this.load(this.file));
    $("baseline").addEventListener("click", () => { this.baseline(this.last); this.results.show(this.last, this.begin); });
    $("save-case").addEventListener("click", () => save(this.file.split("/").at(-1), this.editor.text, "text/plain"));
    for (const [id, file, type] of [["save-report", "report.html", "text/html"], ["save-summary", "summary.json", "application/json"], ["save-series", "series.csv", "text/csv"]]) {
      $(id).addEventListener("click", () => this.keep(file, type));
    }
    $("unfold").addEventListener("click", () => { this.drawing.wide = !this.drawing.wide; this.draw(this.shown); });
    $("all").addEventListener("toggle", () => this.results.all());
    addEventListener("hashchange", () => this.fromAddress());
    this.fromAddress();
  }
  fromAddress() {
    const query = new URLSearchParams(location.hash.slice(1)), wanted = query.get("case");
    const known = this.catalogue.cases.some((c) => c.file === wanted);
    const file = known ? wanted : this.file || "turbo-diesel-120.toml";
    if (file !== this.file) this.load(file, query.getAll("set"));
  }
  // Forgets everything about the case before. `set` are changes that come with the address.
  async load(file, set = []) {
    Object.assign(this, { file, begin: null, last: null, factors: null, noPreview: false, fullTime: 0, history: [], log: [] });
    this.turn++;
    this.pending.clear();
    if (this.full.busy) this.full.stop();
    if (this.quick.busy) this.quick.stop();
    $("case").value = file;
    history.replaceState(null, "", "#" + new URLSearchParams([["case", file], ...set.map((s) => ["set", s])]));
    this.status("work", "reading the case");
    const answer = await this.quick.ask({ ask: "text", file });
    if (!answer || this.file !== file) return;
    this.controls.reset();
    this.controls.settled = false;
    this.controls.layout = null;
    const changed = set.length ? await this.quick.ask({ ask: "change", file, text: answer.text, set }) : answer;
    if (!changed || this.file !== file) return;
    this.editor.set(changed.text ?? answer.text, false);
    $("undo").disabled = true;
    await this.update(performance.now());
  }
  typed() { this.push(); this.update(performance.now()); }
  push() { if (this.history.at(-1) !== this.text) { this.history.push(this.text); this.history.splice(0, Math.max(0, this.history.length - 200)); } $("undo").disabled = !this.history.length; }
  undo() {
    const text = this.history.pop();
    $("undo").disabled = !this.history.length;
    if (text !== undefined) { this.editor.set(text, true); this.update(performance.now()); }
  }
  // A slider or a choice: written into the text, then run. While one change is worked on, later ones of the same input replace each other.
  async change(path, literal) {
    this.pending.set(path, literal);
    if (this.working) return;
    this.working = true;
    while (this.pending.size) {
      const begin = performance.now(), set = [...this.pending].map(([p, v]) => `${p}=${v}`), file = this.file;
      this.pending.clear();
      const answer = await this.quick.ask({ ask: "change", file, text: this.editor.text, set });
      if (!answer || file !== this.file) continue;
      if (answer.text === undefined) { this.editor.show(answer.refused || [{ message: answer.failed }]); continue; }
      this.push();
      this.editor.set(answer.text, true);
      $("added").textContent = answer.added?.length ? "Also set, from the model's example: " + answer.added.join(", ") : "";
      await this.update(begin);
    }
    this.working = false;
  }
  // Checks the text and runs it. Resolves when something new is shown; the full answer of a slow case follows later.
  async update(begin) {
    const turn = ++this.turn, file = this.file, text = this.editor.text;
    this.text = text;
    const opened = await this.quick.ask({ ask: "open", file, text });
    if (!opened || turn !== this.turn) return;
    if (opened.refused || opened.failed) {
      if (this.full.busy) this.full.stop();
      this.editor.show(opened.refused || [{ message: opened.failed }]);
      this.controls.disable(true);
      this.status("wrong", opened.refused ? (opened.refused.length === 1 ? "1 mistake in the case" : opened.refused.length + " mistakes in the case") : "failed");
      $("drawing").classList.add("old");
      return;
    }
    this.editor.show([]);
    this.controls.update(opened);
    this.controls.disable(false);
    $("title").textContent = opened.title || opened.name;
    $("source").replaceChildren(...prose(opened.source || ""));
    if (this.fullTime <= QUICK) return this.exact(turn, begin);
    clearTimeout(this.rest);
    if (this.full.busy) this.full.stop();
    const early = await this.early(turn, begin);
    if (turn !== this.turn) return;
    this.rest = setTimeout(() => { if (turn === this.turn) this.exact(turn, early ? performance.now() : begin); }, this.pending.size ? 300 : 120);
  }
  // The preview of a slow case.
  async early(turn, begin) {
    if (this.noPreview) return false;
    this.status("work", "preview");
    const run = await this.quick.ask({ ask: "run", file: this.file, text: this.text, preview: true });
    if (!run || turn !== this.turn) return false;
    if (run.failed || run.refused) return false;
    this.draw(run);
    this.results.show(run, this.begin, (r) => this.trust(r));
    this.notes(run);
    this.done("preview", begin, run, "preview: " + run.preview.join(", ") + "; the full run follows");
    return true;
  }
  // A preview stands for a result as far as it gave it at the start; what it missed there stays as it was.
  trust(r) {
    const f = this.factors?.get(r.name);
    if (f !== undefined && Math.abs(f - 1) <= HOLDS) return { value: r.value * f, holds: true };
    return { value: this.last?.results.find((o) => o.name === r.name)?.value ?? r.value, holds: false };
  }
  async exact(turn, begin) {
    const early = $("status").classList.contains("preview") ? $("status-text").textContent.replace("follows", "is under way") : "running";
    this.status("work", early);
    if (this.full.busy) this.full.stop();
    const run = await this.full.ask({ ask: "run", file: this.file, text: this.text });
    if (!run || turn !== this.turn) return;
    if (run.failed || run.refused) {
      if (run.refused) this.editor.show(run.refused);
      this.status("wrong", run.failed || "refused");
      $("drawing").classList.add("old");
      this.note([{ level: "failure", text: run.failed || "refused" }]);
      return;
    }
    this.fullTime = run.ms;
    this.last = run;
    const first = !this.begin;
    if (first) this.baseline(run);
    this.draw(run);
    this.results.show(run, this.begin);
    this.notes(run);
    this.done("full", begin, run, "all results at the settings of the case");
    if (first && run.ms > QUICK) await this.calibrate(turn);
  }
  baseline(run) { if (run) this.begin = new Map(run.results.map((r) => [r.name, r.value])); }
  // How far the preview of the start is from its full run.
  async calibrate(turn) {
    const file = this.file, full = this.last, run = await this.quick.ask({ ask: "run", file, text: this.text, preview: true });
    if (!run || file !== this.file) return;
    this.noPreview = !!(run.failed || run.refused);
    if (this.noPreview) return;
    const values = new Map(full.results.map((r) => [r.name, r.value]));
    this.factors = new Map(run.results.map((r) => [r.name, r.value ? values.get(r.name) / r.value : values.get(r.name) === 0 ? 1 : NaN]));
  }
  draw(run) {
    this.shown = run;
    $("drawing").classList.remove("old");
    const { hidden, wide } = this.drawing.show(run.data);
    $("unfold").hidden = !hidden && !wide;
    $("unfold").textContent = wide ? "Fewer drawings" : hidden === 1 ? "One more drawing" : `${hidden} more drawings`;
    $("unfold").setAttribute("aria-expanded", String(wide));
  }
  notes(run) { this.note(run.notes); }
  // Failures stand open, the rest is one line until it is asked for.
  note(all) {
    const of = (level) => all.filter((n) => n.level === level).map((n) => element("p", { class: "note " + level }, ...prose(n.text)));
    const cautions = of("caution"), remarks = of("info");
    const count = (n, word) => (n ? [`${n} ${word}${n === 1 ? "" : "s"}`] : []);
    const open = !!$("notes").querySelector("details[open]");
    const folded = [...cautions, ...remarks];
    $("notes").replaceChildren(...of("failure"), ...(folded.length ? [element("details", { class: cautions.length ? "cautions" : null, open },
      element("summary", {}, [...count(cautions.length, "caution"), ...count(remarks.length, "remark")].join(", ") + " of the run"), ...folded)] : []));
  }
  status(kind, text) { $("status").className = "status " + kind; $("status-text").textContent = text; if (kind !== "done" && kind !== "preview") $("time").textContent = ""; }
  done(kind, begin, run, text) {
    const shown = performance.now() - begin;
    this.status(kind === "full" ? "done" : "preview", text);
    $("time").textContent = number(shown, 3) + " ms";
    $("time").title = `${number(run.ms, 3)} ms of it in the solver`;
    for (const id of ["save-report", "save-summary", "save-series"]) $(id).disabled = kind !== "full";
    this.log.push({ kind, file: this.file, shown, run: run.ms });
  }
  async keep(file, type) {
    const files = await this.full.ask({ ask: "files" });
    if (files && files[file]) save(this.file.split("/").at(-1).replace(/\.toml$/, "") + "-" + file, files[file], type);
  }
}

// Runs a script that the module holds.
function script(text) {
  const src = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  return new Promise((take, fail) => document.head.append(element("script", { src, onload: () => { URL.revokeObjectURL(src); take(); }, onerror: fail })));
}

// Words between backticks are names.
const prose = (text) => text.split("`").map((t, i) => (i % 2 ? element("code", {}, t) : t));

function save(name, text, type) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = element("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

compiled().then((module) => { globalThis.app = new App(module); return app.start(); }).catch((e) => {
  $("status").className = "status wrong";
  $("status-text").textContent = location.protocol === "file:" ? "A browser reads no module from a folder: open gudgeon.html, which holds it." : "The module cannot be read: " + e.message;
});
