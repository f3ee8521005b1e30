// Opens every page below a folder in headless Chromium, light and, for its colours, dark, with everything unfolded, and fails where
// - axe-core finds something serious or critical,
// - a script fails or something is requested from anywhere but the file itself,
// - a place for figures is empty, or one of its figures draws nothing,
// - a page is wider than a screen of 360 to 2560 px,
// - the first page of a run, with the figure that leads, does not fit on a sheet of A4.
//
//     node audit.mjs FOLDER [CHROMIUM]
import fs from "node:fs";
import path from "node:path";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [folder, executablePath = "/usr/bin/chromium"] = process.argv.slice(2);
const axe = fs.readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const WIDTHS = [360, 768, 1024, 1300, 1400, 2560];
const CONTRAST = "color-contrast";
const JUDGED = "data-judged";
// A sheet of A4 at 96 px an inch, less the margins of 11 mm that the style sheet sets.
const SHEET = { width: Math.floor(((210 - 22) / 25.4) * 96), height: Math.floor(((297 - 22) / 25.4) * 96) };

const pages = fs.readdirSync(folder).map((n) => path.join(folder, n, "report.html")).filter((f) => fs.existsSync(f));
if (!pages.length) throw new Error(`no pages below ${folder}`);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"] });
const wrong = [];

async function look(file) {
  let colorScheme = "light";
  const context = await browser.newContext({ viewport: { width: 1400, height: 1000 }, colorScheme, bypassCSP: true });
  const page = await context.newPage();
  const say = (what) => wrong.push(`${path.relative(folder, file)}, ${colorScheme}: ${what}`);
  page.on("request", (r) => { if (!/^(file|data|blob):/.test(r.url())) say(`requests ${r.url()}`); });
  page.on("pageerror", (e) => say(`script: ${e.message}`));
  await page.goto(pathToFileURL(file).href);
  await paper(page, say);
  await page.evaluate(() => { for (const d of document.querySelectorAll("details:not(.saving)")) d.open = true; });
  await page.waitForTimeout(100);
  await page.evaluate(axe);
  await audit(page, say, { rules: { [CONTRAST]: { enabled: false } } });
  await contrast(page, say);
  const empty = await page.evaluate(() => [...document.querySelectorAll(".figures, #figures, #plots, #overlay")]
    .filter((f) => !f.querySelector("svg, table")).map((f) => f.id || f.className));
  for (const place of empty) say(`draws nothing in ${place}`);
  for (const width of WIDTHS) {
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(60);
    const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    if (over > 0) say(`${over} px wider than ${width}`);
  }
  // Only colours differ in the dark.
  colorScheme = "dark";
  await page.setViewportSize({ width: 1400, height: 1000 });
  await page.emulateMedia({ colorScheme });
  await page.waitForTimeout(60);
  await contrast(page, say);
  await context.close();
}

// What is right is not listed: that takes as long as finding what is not.
async function audit(page, say, options, context = "html") {
  const found = await page.evaluate(([context, options]) => window.axe.run(context, { ...options, resultTypes: ["violations"] }), [context, options]);
  for (const v of found.violations.filter((v) => ["serious", "critical"].includes(v.impact))) say(`${v.id}: ${v.nodes[0].html.slice(0, 160)}`);
}

// A millisecond a text, of which a page has thousands, most of them cells of tables and numbers along axes: of those that have ink, ground, font and opacity in common one
// is judged, in a figure, where marks may lie below, one for each kind of text.
async function contrast(page, say) {
  await page.evaluate((attribute) => {
    const seen = new Set();
    const figures = [...document.querySelectorAll("svg")];
    // What lies behind an element: that of its parent, and its own.
    const behind = new Map([[null, ""]]);
    const ground = (e) => {
      if (!behind.has(e)) {
        const { backgroundColor, backgroundImage, opacity } = getComputedStyle(e);
        behind.set(e, [ground(e.parentElement), backgroundColor, backgroundImage, opacity].join());
      }
      return behind.get(e);
    };
    for (const e of document.body.querySelectorAll("*")) {
      e.removeAttribute(attribute);
      if (![...e.childNodes].some((n) => n.nodeType === Node.TEXT_NODE && n.data.trim())) continue;
      const { color, fill, fontSize, fontWeight } = getComputedStyle(e);
      const parts = [color, fontSize, fontWeight, ground(e)];
      const figure = e.closest("svg");
      if (figure) parts.push(fill, e.getAttribute("class"), figures.indexOf(figure));
      const key = parts.join();
      if (!seen.has(key)) e.setAttribute(attribute, "");
      seen.add(key);
    }
  }, JUDGED);
  await audit(page, say, { runOnly: [CONTRAST] }, `[${JUDGED}]`);
}

// What is wider than a sheet makes a browser print all pages smaller. On the first sheet the figure that leads takes what the overview leaves.
async function paper(page, say) {
  await page.setViewportSize({ width: SHEET.width, height: SHEET.height });
  await page.emulateMedia({ media: "print" });
  await page.waitForTimeout(60);
  const { end, over } = await page.evaluate(() => {
    const first = document.querySelector(".sheet");
    const ends = first ? [...first.querySelectorAll("section, #lead, #lead svg")].map((e) => e.getBoundingClientRect().bottom + scrollY) : [0];
    return { end: Math.max(...ends), over: document.documentElement.scrollWidth - innerWidth };
  });
  if (end > SHEET.height) say(`its first page takes ${((100 * end) / SHEET.height).toFixed(0)} % of a sheet`);
  if (over > 0) say(`${over} px wider than a sheet`);
  await page.emulateMedia({ media: "screen" });
  await page.setViewportSize({ width: 1400, height: 1000 });
}

for (const file of pages) await look(file);
await browser.close();
for (const w of wrong) console.error(w);
console.log(`${pages.length - new Set(wrong.map((w) => w.split(",")[0])).size} passed, ${new Set(wrong.map((w) => w.split(",")[0])).size} failed`);
process.exit(wrong.length ? 1 : 0);
