// A browser driven through its own protocol over pipes: no package is needed for it.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync", "--disable-extensions", "--hide-scrollbars", "--remote-debugging-pipe"];

export class Browser {
  static async open(program) {
    const b = new Browser();
    b.folder = mkdtempSync(join(tmpdir(), "gudgeon-web-"));
    b.process = spawn(program, [...FLAGS, "--user-data-dir=" + join(b.folder, "profile"), "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    b.waiting = new Map();
    b.listeners = [];
    b.next = 1;
    let rest = "";
    b.process.stdio[4].setEncoding("utf8");
    b.process.stdio[4].on("data", (text) => {
      const parts = (rest + text).split("\0");
      rest = parts.pop();
      for (const p of parts) b.hear(JSON.parse(p));
    });
    const { targetInfos } = await b.send("Target.getTargets");
    const page = targetInfos.find((t) => t.type === "page");
    b.session = (await b.send("Target.attachToTarget", { targetId: page.targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Network", "Log"]) await b.send(domain + ".enable");
    return b;
  }
  hear(m) {
    if (m.id) {
      const { take, fail } = this.waiting.get(m.id) ?? {};
      this.waiting.delete(m.id);
      if (m.error) fail?.(new Error(JSON.stringify(m.error))); else take?.(m.result);
    } else for (const f of this.listeners) f(m);
  }
  on(f) { this.listeners.push(f); }
  send(method, params = {}) {
    const id = this.next++, target = method.startsWith("Target.") || method.startsWith("Browser.") ? {} : { sessionId: this.session };
    return new Promise((take, fail) => {
      this.waiting.set(id, { take, fail });
      this.process.stdio[3].write(JSON.stringify({ id, method, params, ...target }) + "\0");
    });
  }
  // The value of an expression, which may be a promise.
  async value(expression) {
    const r = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (r.exceptionDetails) throw new Error(r.exceptionDetails.exception?.description ?? r.exceptionDetails.text);
    return r.result.value;
  }
  async until(expression, what, seconds = 30) {
    const end = Date.now() + seconds * 1000;
    while (Date.now() < end) {
      if (await this.value(expression)) return;
      await new Promise((go) => setTimeout(go, 20));
    }
    throw new Error(`not within ${seconds} s: ${what}`);
  }
  async screenshot(width, height, dark = false) {
    await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await this.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }] });
    await new Promise((go) => setTimeout(go, 400));
    const { data } = await this.send("Page.captureScreenshot", { format: "png" });
    return Buffer.from(data, "base64");
  }
  async close() {
    await this.send("Browser.close").catch(() => {});
    await new Promise((go) => { this.process.on("exit", go); setTimeout(go, 3000); });
    this.process.kill();
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}
