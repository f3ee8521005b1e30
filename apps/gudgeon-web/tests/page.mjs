// page.mjs CHROMIUM FOLDER GUDGEON [--measure]: the page in a browser. Its results against those of this machine, a slider, a mistake at its line, saved
// files, and that nothing leaves the page.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, existsSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import { Browser } from "./browser.mjs";
import { serve } from "./serve.mjs";

const [chromium, folder, gudgeon, measure] = process.argv.slice(2);
const cases = resolve(import.meta.dirname, "../../../cases");
const scratch = mkdtempSync(join(tmpdir(), "gudgeon-page-"));
let failures = 0;
const check = (holds, what) => { if (!holds) { failures++; console.error("FAILED: " + what); } };

// The four scenes that the playground must run. Both programs have the same elementary functions, so results are the same bits but where compilers sum in
// another order (a shaft line: 2e-15 of the value); a search for a periodic cycle may enlarge that, to far less than this.
const DIESEL = "turbo-diesel-120.toml";
const CASES = ["rigs/ring-face-barrel.toml", "compressor-4-throw.toml", "pin-85-alcohol-optimise.toml", DIESEL];
const TOLERANCE = 1e-7;
// The module of tests is not optimised: the diesel runs there without oil that is carried along the liner, with a coarse tolerance.
const changes = (file) => (file === DIESEL && !measure ? ["models.oil_transport.model=off", "solver.tolerance=3e-3"] : []);

function native(file) {
  const out = join(scratch, "native-" + file.replace(/\W/g, "-"));
  execFileSync(gudgeon, ["run", join(cases, file), "--out", out, "--quiet", ...changes(file).flatMap((c) => ["--set", c])], { stdio: ["ignore", "ignore", "ignore"] });
  return { results: JSON.parse(readFileSync(join(out, "summary.json"), "utf8")).results, report: readFileSync(join(out, "report.html"), "utf8") };
}

// The largest difference, relative to the value; of a difference that nearly vanishes relative to the largest of its family (`ring#.flow`).
function compare(file, here, there) {
  const names = Object.keys(here);
  check(names.length > 0 && names.length === there.length, `${file}: ${there.length} results in the page, ${names.length} on this machine`);
  const family = (name) => name.replace(/\d+/g, "#"), scale = new Map();
  for (const n of names) scale.set(family(n), Math.max(scale.get(family(n)) ?? 0, Math.abs(here[n].value)));
  const all = there.map(({ name, value }) => {
    const own = here[name]?.value;
    return { name, difference: own === value ? 0 : Math.abs(value - own) / (scale.get(family(name)) || 1) };
  });
  return all.sort((a, b) => b.difference - a.difference || 0);
}

const web = await serve(folder), b = await Browser.open(chromium);
const requests = [], complaints = [];
b.on((m) => {
  if (m.method === "Network.requestWillBeSent") requests.push(m.params.request.url);
  if (m.method === "Runtime.exceptionThrown") complaints.push(m.params.exceptionDetails.exception?.description ?? m.params.exceptionDetails.text);
  if (m.method === "Log.entryAdded" && m.params.entry.level === "error") complaints.push(m.params.entry.text);
});
await b.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: scratch });
await b.send("Emulation.setDeviceMetricsOverride", { width: 1400, height: 1000, deviceScaleFactor: 1, mobile: false });

const address = (file) => "#" + new URLSearchParams([["case", file], ...changes(file).map((c) => ["set", c])]);
const full = (file) => `app.log.some((l) => l.kind === "full" && l.file === ${JSON.stringify(file)})`;
async function open(url, file) {
  await b.send("Page.navigate", { url: url + address(file) });
  await b.until(`!!globalThis.app && ${full(file)}`, `the first run of ${file}`, 90);
}
async function load(file) {
  await b.value(`location.hash = ${JSON.stringify(address(file))}`);
  await b.until(full(file), `the first run of ${file}`, 90);
}
const saved = async (name) => {
  const path = join(scratch, name), end = Date.now() + 20000;
  while (!existsSync(path) && Date.now() < end) await new Promise((go) => setTimeout(go, 30));
  check(existsSync(path), `${name} was not saved; there are ${readdirSync(scratch).join(", ")}`);
  return existsSync(path) ? readFileSync(path, "utf8") : "";
};

// The file that holds everything, from a folder; then the page of a web server.
await open(pathToFileURL(join(folder, "gudgeon.html")).href, CASES[0]);
check(requests.every((u) => u.startsWith("file:") || u.startsWith("blob:") || u.startsWith("data:")), `gudgeon.html asked for ${requests.filter((u) => !u.startsWith("file:")).join(", ")}`);
await open(web.base + "/index.html", CASES[0]);

const rows = [];
for (const file of CASES) {
  await load(file);
  const there = await b.value("app.last.results.map(({ name, value }) => ({ name, value }))");
  const [worst] = compare(file, native(file).results, there);
  check(worst.difference <= TOLERANCE, `${file}: ${worst.name} differs by ${worst.difference}`);
  check(await b.value("document.querySelectorAll('#drawing svg').length") > 0, `${file}: nothing is drawn`);
  check(await b.value("document.querySelectorAll('#tiles .tile').length") >= 4, `${file}: no headlines`);
  rows.push({ file, results: there.length, worst });
}

// A slider, while the full run of the diesel takes its time: a preview follows at once, results move, the text has the new value.
const slide = (path, value) => `(() => { const r = document.querySelector('input[type=range][data-path="${path}"]'); r.value = ${value}; r.dispatchEvent(new Event("input", { bubbles: true })); })()`;
await b.until("!!app.factors || app.noPreview || app.fullTime <= 250", "the preview of the start");
const before = await b.value("app.log.length"), peak = await b.value("document.querySelector('[data-result=blow_by] b').textContent");
await b.value(slide("engine.speed", 1800));
await b.until(`app.log.length > ${before}`, "something new after a slider");
const first = await b.value(`app.log[${before}]`);
await b.until(`app.log.slice(${before}).some((l) => l.kind === "full")`, "the full run after a slider", 60);
check(await b.value("app.editor.text.includes('speed = \"1800 rpm\"')"), "the text does not have the value of the slider");
check(await b.value("document.querySelector('[data-result=blow_by] b').textContent") !== peak, "blow-by does not follow the speed");
check(await b.value("document.querySelector('[data-result=blow_by] .change').textContent.includes('%')"), "no change against the start is told");

// A mistake shows at its line, with advice; mended, the case runs on.
await b.value(`(() => { const a = app.editor.area; a.value = a.value.replace('"narrow_channel"', '"narow_channel"'); a.dispatchEvent(new Event("input")); })()`);
await b.until("document.querySelectorAll('.mistake').length === 1", "a mistake that is told");
const line = await b.value("app.editor.text.split('\\n').findIndex((l) => l.includes('narow')) + 1");
check(await b.value("document.querySelector('.gutter .wrong').textContent") === String(line), "the mistake is not marked at its line");
check((await b.value("document.querySelector('.mistake').textContent")).includes("did you mean narrow_channel?"), "the mistake has no advice");
await b.value(`document.getElementById("undo").click()`);
await b.until("document.querySelectorAll('.mistake').length === 0", "the mistake to be gone");

// Help of the schema for the line of the cursor.
await b.value(`(() => { const a = app.editor.area, i = a.value.indexOf("bore ="); a.focus(); a.setSelectionRange(i, i); a.dispatchEvent(new Event("click")); })()`);
await b.until("document.querySelector('.about h3')?.textContent === 'engine.bore'", "help on the bore");

// The case and the report are saved; the report is the file that this machine writes.
await load(CASES[0]);
const here = native(CASES[0]);
await b.value(`document.getElementById("save-case").click()`);
check(await saved("ring-face-barrel.toml") === readFileSync(join(cases, CASES[0]), "utf8"), "the saved case is another text");
await b.value(`document.getElementById("save-report").click()`);
const plain = (report) => report.replace(/<script type="application\/json" id="data">.*?<\/script>/s, "").replace(/<section id="sources">.*?<\/section>/s, "");
const report = await saved("ring-face-barrel-report.html");
check(report.includes("<!DOCTYPE html>") && plain(report) === plain(here.report), "the saved report is another page");

// Every control has a name for a screen reader, and the keyboard moves a slider.
const nameless = await b.value(`[...document.querySelectorAll("input, select, textarea, button")].filter((e) => !e.textContent.trim() && !e.getAttribute("aria-label") && !(e.id && document.querySelector('label[for="' + e.id + '"]'))).map((e) => e.outerHTML.slice(0, 120))`);
check(nameless.length === 0, `controls without a name: ${nameless.join("; ")}`);
await b.value(`document.querySelector('input[type=range][data-path="rig.film"]').focus()`);
const steps = await b.value("app.log.length");
for (const type of ["keyDown", "keyUp"]) await b.send("Input.dispatchKeyEvent", { type, key: "ArrowRight", code: "ArrowRight", windowsVirtualKeyCode: 39 });
await b.until(`app.log.length > ${steps}`, "a run after a key");

const foreign = requests.filter((u) => !/^(file:|blob:|data:|about:)/.test(u) && !u.startsWith(web.base + "/"));
check(foreign.length === 0, `requests that leave the page: ${foreign.join(", ")}`);
check(web.asked.every((p) => ["/index.html", "/gudgeon.wasm", "/favicon.ico"].includes(p)), `the server was asked for ${web.asked.join(", ")}`);
const real = complaints.filter((c) => !c.includes("favicon"));
check(real.length === 0, `the browser complains: ${real.join("; ")}`);

const module = readFileSync(join(folder, "gudgeon.wasm"));
const mb = (n) => (n / 1e6).toFixed(2) + " MB";
console.log(`module ${mb(module.length)}, gzip ${mb(gzipSync(module, { level: 9 }).length)}; gudgeon.html ${mb(statSync(join(folder, "gudgeon.html")).size)}`);
if (measure) console.log(`brotli ${mb(brotliCompressSync(module, { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } }).length)}`);
const told = (r) => `${r.difference.toExponential(1)}${r.difference ? " (" + r.name + ")" : ""}`;
for (const r of rows) console.log(`${r.file}: ${r.results} results; largest difference to this machine ${told(r.worst)}`);
console.log(`${DIESEL}, a slider: ${first.kind} after ${first.shown.toFixed(0)} ms`);
if (measure) await measured();

// Milliseconds from a movement of a slider to what it shows, several times.
async function measured() {
  const moves = [["rigs/ring-face-barrel.toml", "rig.film", [1.8, 2.2, 2.4, 2.6, 1.6]], ["compressor-4-throw.toml", "speed", [990, 980, 970, 1010, 1020]],
    ["pin-85-alcohol-optimise.toml", "engine.bore", [84, 86, 85.5, 84.5, 86.5]], [DIESEL, "engine.speed", [1900, 1950, 2050, 2100, 1850]]];
  for (const [file, path, values] of moves) {
    await load(file);
    await b.until("!!app.factors || app.noPreview || app.fullTime <= 250", "the preview of the start");
    for (const v of values) {
      const from = await b.value("app.log.length");
      await b.value(slide(path, v));
      await b.until(`app.log.slice(${from}).some((l) => l.kind === "full")`, "a full run", 60);
    }
    const log = await b.value(`app.log.filter((l) => l.file === ${JSON.stringify(file)})`);
    const list = (kind, key) => log.filter((l) => l.kind === kind).slice(kind === "full" ? 1 : 0).map((l) => l[key].toFixed(0)).join(" ");
    console.log(`${file}: full ${list("full", "shown")} ms (solver ${list("full", "run")}); preview ${list("preview", "shown")} ms (solver ${list("preview", "run")})`);
  }
}

await b.close();
web.close();
rmSync(scratch, { recursive: true, force: true });
process.exit(failures ? 1 : 0);
