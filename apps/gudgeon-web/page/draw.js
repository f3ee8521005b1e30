// Draws a run with the scripts of its report, again and again: `reportScripts`, which the module makes of them, takes what they think is the
// document and the address, so that several drawings follow one another in one page.

class Drawing {
  constructor(host) { Object.assign(this, { host, wide: false, kept: null, seen: "" }); }
  // `data` is what the report of the run holds.
  show(data) {
    const parts = {};
    const part = (id, attributes) => (parts[id] = element("div", { ...attributes, "data-part": id }));
    const body = element("div", { class: "drawn" }, part("bar"), element("div", { class: "stage" }, part("lead"), part("plots", { class: "figures" })), part("figures", { class: "figures" }));
    const few = 4, figures = data.figures || [], hidden = this.wide ? 0 : Math.max(0, figures.length - few);
    parts.data = { textContent: JSON.stringify(hidden ? { ...data, figures: figures.slice(0, few) } : data) };
    if (!data.series) { parts.bar.remove(); delete parts.bar; parts.plots.remove(); }
    const old = this.current, memory = this.remember();
    old?.abort.abort();
    const scope = { abort: new AbortController(), cycle: null };
    const page = { getElementById: (id) => parts[id] || null, createElement: (t) => document.createElement(t), createElementNS: (n, t) => document.createElementNS(n, t), querySelectorAll: () => [], body: document.body };
    const listen = (type, f) => globalThis.addEventListener(type, f, { signal: scope.abort.signal });
    const y = scrollY;
    this.host.append(body);
    body.classList.toggle("wide-open", this.wide);
    reportScripts(page, { hash: memory.hash }, listen, scope);
    if (old) old.body.remove();
    this.current = { ...scope, body };
    this.current.cycle = scope.cycle;
    this.recall(body, scope.cycle, memory);
    scrollTo({ top: y, behavior: "instant" });
    // Curves beyond the first stay folded by the style sheet: what is not displayed draws nothing, and costs nothing.
    const folded = [...body.querySelectorAll('[data-part="plots"] > *')].filter((p) => !p.clientHeight).length;
    return { hidden: hidden + folded, wide: this.wide };
  }
  // What a person set on the drawing: angle, range, scales, hidden curves.
  remember() {
    const now = this.current;
    // At first a few degrees behind the firing dead centre, where most is to be seen.
    if (!now) return { hash: "#theta=372", pressed: new Map() };
    const pressed = new Map();
    for (const plot of now.body.querySelectorAll(".plot")) {
      pressed.set(title(plot), [...plot.querySelectorAll("button[aria-pressed]")].map((b) => [b.textContent.replace(/[-–−+.\d×⁰¹²³⁴⁵⁶⁷⁸⁹⁻ ].*$/, ""), b.getAttribute("aria-pressed")]));
    }
    const c = now.cycle, hash = c ? `#theta=${c.pinned}` + (c.zoomed ? `&view=${c.view.join(",")}` : "") : "";
    const playing = !!c?.playing;
    if (c) c.playing = false;
    return { hash, pressed, playing, speed: c?.speed, open: !!now.body.querySelector("details.more[open]") };
  }
  recall(body, cycle, memory) {
    for (const plot of body.querySelectorAll(".plot")) {
      const before = memory.pressed.get(title(plot));
      const buttons = [...plot.querySelectorAll("button[aria-pressed]")];
      if (!before || before.length !== buttons.length) continue;
      const head = buttons.filter((b) => b.closest(".head")).length;
      buttons.forEach((b, i) => {
        const now = b.getAttribute("aria-pressed");
        // Scales are chosen one of several, curves are hidden one by one.
        if (i < head ? before[i][1] === "true" && now !== "true" : before[i][1] !== now) b.click();
      });
    }
    if (cycle && memory.speed) { cycle.speed = memory.speed; const s = body.querySelector('[data-part="bar"] select'); if (s) s.value = memory.speed; }
    if (cycle && memory.playing) cycle.play(true);
    if (memory.open) body.querySelector("details.more")?.setAttribute("open", "");
  }
}
const title = (plot) => plot.querySelector("h3")?.textContent || "";
