// The text of the case with the numbers of its lines, its mistakes at their place, and what the schema knows about the line of the cursor.

class Editor {
  // `edited()` is called when a person typed; `help(text, offset)` asks the module.
  constructor(host, edited, help) {
    Object.assign(this, { edited, help, mistakes: [], touched: new Set() });
    this.gutter = element("div", { class: "gutter", "aria-hidden": "true" });
    this.paint = element("pre", { class: "paint", "aria-hidden": "true" });
    this.area = element("textarea", { spellcheck: "false", autocapitalize: "off", autocomplete: "off", wrap: "off", "aria-label": "the case as TOML", "aria-describedby": "mistakes" });
    this.list = element("div", { id: "mistakes", class: "mistakes", role: "status", "aria-live": "polite" });
    this.about = element("div", { class: "about", "aria-live": "polite" });
    host.append(element("div", { class: "sheet" }, this.gutter, element("div", { class: "text" }, this.paint, this.area)), element("aside", { class: "side-help", "aria-label": "help on the case" }, this.list, this.about));
    this.area.addEventListener("input", () => { this.touched.clear(); this.draw(); clearTimeout(this.later); this.later = setTimeout(() => this.edited(), 250); });
    this.area.addEventListener("scroll", () => this.scroll());
    for (const event of ["keyup", "click", "focus"]) this.area.addEventListener(event, () => this.ask());
  }
  get text() { return this.area.value; }
  // A text from elsewhere; lines that differ are marked, and the cursor stays where it is.
  set(text, mark) {
    const before = this.area.value.split("\n"), from = this.area.selectionStart;
    this.touched.clear();
    if (mark) text.split("\n").forEach((line, i) => { if (line !== before[i] && before.length === text.split("\n").length) this.touched.add(i + 1); });
    const { scrollTop, scrollLeft } = this.area;
    this.area.value = text;
    this.area.setSelectionRange(from, from);
    Object.assign(this.area, { scrollTop: mark ? scrollTop : 0, scrollLeft: mark ? scrollLeft : 0 });
    this.draw();
    if (mark && this.touched.size && document.activeElement !== this.area) this.reveal(Math.min(...this.touched));
  }
  scroll() { this.paint.style.transform = `translate(${-this.area.scrollLeft}px, ${-this.area.scrollTop}px)`; this.gutter.firstChild && (this.gutter.firstChild.style.transform = `translateY(${-this.area.scrollTop}px)`); }
  lineHeight() { return parseFloat(getComputedStyle(this.area).lineHeight); }
  reveal(line) {
    const top = (line - 1) * this.lineHeight(), height = this.area.clientHeight;
    if (top < this.area.scrollTop + 20 || top > this.area.scrollTop + height - 40) this.area.scrollTop = Math.max(0, top - height / 2);
    this.scroll();
  }
  show(mistakes) {
    this.mistakes = mistakes;
    const go = (m) => { if (m.line) { this.select(m.line, m.column || 1, m.length || 0); } };
    const one = (m) => element("button", { type: "button", class: "mistake", "data-line": m.line, onclick: () => go(m) },
      element("b", {}, m.line ? `Line ${m.line}` : "The case"), " ", ...prose(m.message), m.help ? element("span", { class: "advice" }, ...prose(m.help)) : null);
    this.list.replaceChildren(...(mistakes.length ? [element("h3", {}, mistakes.length === 1 ? "1 mistake" : mistakes.length + " mistakes"), ...mistakes.map(one)] : []));
    this.draw();
    if (mistakes.length && mistakes[0].line && document.activeElement !== this.area) this.reveal(mistakes[0].line);
  }
  offset(line, column) {
    const lines = this.area.value.split("\n");
    let at = 0;
    for (let i = 0; i < line - 1 && i < lines.length; i++) at += lines[i].length + 1;
    // Columns count characters, the text of a page counts units of UTF-16.
    return at + [...(lines[line - 1] || "")].slice(0, column - 1).join("").length;
  }
  select(line, column, length) {
    const from = this.offset(line, column);
    this.area.focus();
    this.area.setSelectionRange(from, from + length);
    this.reveal(line);
    this.ask();
  }
  // Only lines that look different are made anew: a slider changes one of hundreds.
  draw() {
    const wrong = new Map();
    for (const m of this.mistakes) if (m.line && !wrong.has(m.line)) wrong.set(m.line, m);
    if (!this.gutter.firstChild) this.gutter.append(element("div", {}));
    const numbers = this.gutter.firstChild, looks = this.area.value.split("\n").map((text, i) => ({ text, wrong: wrong.get(i + 1), touched: this.touched.has(i + 1) }));
    const same = (a, b) => a && a.text === b.text && a.wrong === b.wrong && a.touched === b.touched;
    looks.forEach((now, i) => {
      if (same(this.looks?.[i], now)) return;
      const number = element("span", { class: now.wrong ? "wrong" : now.touched ? "touched" : null }, String(i + 1)), line = this.line(now.text, now.wrong, now.touched);
      if (numbers.children[i]) { numbers.children[i].replaceWith(number); this.paint.children[i].replaceWith(line); } else { numbers.append(number); this.paint.append(line); }
    });
    while (numbers.children.length > looks.length) { numbers.lastChild.remove(); this.paint.lastChild.remove(); }
    this.looks = looks;
    this.scroll();
  }
  line(text, wrong, touched) {
    const out = element("div", { class: "line" + (wrong ? " wrong" : touched ? " touched" : "") });
    if (wrong) {
      const chars = [...text], from = Math.max(0, (wrong.column || 1) - 1), to = Math.max(from + 1, from + (wrong.length || 0));
      out.append(chars.slice(0, from).join(""), element("u", {}, chars.slice(from, to).join("") || " "), chars.slice(to).join(""));
      return out;
    }
    // Comments, headers, keys, texts: enough to find one's way.
    const parts = /^(\s*)(#.*|\[.*?\]+)?(?:([\w."-]+)(\s*=\s*))?(.*)$/.exec(text);
    const [, lead, head, key, equals, rest] = parts;
    out.append(lead);
    if (head) out.append(element("span", { class: head.startsWith("#") ? "comment" : "header" }, head));
    if (key) out.append(element("span", { class: "key" }, key), equals);
    for (const m of (rest || "").matchAll(/("(?:[^"\\]|\\.)*"?)|(#.*$)|([^"#]+)/g)) {
      out.append(m[1] ? element("span", { class: "string" }, m[1]) : m[2] ? element("span", { class: "comment" }, m[2]) : m[3]);
    }
    if (!text) out.append("\u200b");
    return out;
  }
  async ask() {
    const at = this.area.selectionStart;
    if (at === this.asked && this.text === this.askedOf) return;
    Object.assign(this, { asked: at, askedOf: this.text });
    const bytes = new TextEncoder().encode(this.text.slice(0, at)).length;
    const help = await this.help(this.text, bytes);
    if (help && !help.failed && at === this.asked) this.tell(help);
  }
  tell(h) {
    const rows = [];
    const row = (name, what) => { if (what) rows.push(element("dt", {}, name), element("dd", {}, what)); };
    row("wants", h.wants); row("units", h.units.join(", ")); row("default", h.default);
    const words = h.words.map(([w, about]) => element("li", {}, element("button", { type: "button", onclick: () => this.put(w) }, w), ...(about ? [" ", ...prose(about)] : [])));
    const missing = h.keys.filter((k) => !k.present && !k.table);
    const keys = missing.map((k) => element("li", {}, element("button", { type: "button", class: k.required ? "required" : null, onclick: () => this.add(k.key) }, k.key), k.required ? element("b", {}, " needed. ") : " ", ...prose(k.about)));
    this.about.replaceChildren(
      element("h3", {}, element("code", {}, h.path || "the case")), element("p", {}, ...prose(h.about || "")),
      ...(rows.length ? [element("dl", {}, ...rows)] : []),
      ...(words.length ? [element("h4", {}, "May be"), element("ul", { class: "words" }, ...words)] : []),
      ...(keys.length ? [element("details", { open: !words.length }, element("summary", {}, `${keys.length} more keys of this table`), element("ul", { class: "words" }, ...keys))] : []));
  }
  current() {
    const before = this.text.slice(0, this.area.selectionStart), start = before.lastIndexOf("\n") + 1;
    const stop = this.text.indexOf("\n", start), end = stop < 0 ? this.text.length : stop;
    return { start, end, line: this.text.slice(start, end) };
  }
  replace(from, to, text) { this.area.setRangeText(text, from, to, "end"); this.area.focus(); this.area.dispatchEvent(new Event("input")); this.ask(); }
  // Puts a word in place of the value of the line.
  put(word) {
    const { start, end, line } = this.current(), m = /^(\s*[\w.]+\s*=\s*)("[^"]*"|[^#]*?)(\s*(?:#.*)?)$/.exec(line);
    if (m) this.replace(start + m[1].length, end - m[3].length, /^(true|false)$/.test(word) ? word : `"${word}"`);
  }
  add(key) { const { end } = this.current(); this.replace(end, end, `\n${key} = `); }
}
