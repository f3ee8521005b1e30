//! The shell of every page, and the parts that pages share.

use std::fmt::Write;

use gudgeon_core::Registry;
use gudgeon_core::result::{Column, Note, NoteLevel, Provenance, Refined, Series};
use serde::Serialize;

use crate::number::{capital, certain, count, significant, unit};
use crate::summary::{BalanceSheet, ModelEntry, ResultValue, SkippedEntry, SolverEntry, Summary};

const STYLE: &str = include_str!("assets/style.css");
const CORE: &str = include_str!("assets/core.js");
const AXIS: &str = include_str!("assets/axis.js");
const CHART: &str = include_str!("assets/chart.js");
const EXPORT: &str = include_str!("assets/export.js");
const MAP: &str = include_str!("assets/map.js");
const WATERFALL: &str = include_str!("assets/waterfall.js");
const DRAWING: &str = include_str!("assets/drawing.js");
const FIGURE: &str = include_str!("assets/figure.js");
const SECTION: &str = include_str!("assets/section.js");
const RUN: &str = include_str!("assets/run.js");
/// Which columns of a series form a figure over the cycle, as JSON: a list of figures with `name`, `title`, `hint` and `columns` (name, label, colour, dash).
/// `#` in a name is any number; a negative colour counts from it; `text` is the colour of text.
pub const OVER_CYCLE: &str = include_str!("assets/over_cycle.json");
const COMPARE: &str = include_str!("assets/compare.js");
const BENCH: &str = include_str!("assets/bench.js");

/// The scripts of a run's page, in their order: together they read the element `data` and fill the elements `bar`, `lead`, `plots` and
/// `figures`. They expect a constant `OVER_CYCLE` that holds [`OVER_CYCLE`].
pub const RUN_SCRIPTS: &[&str] = &[CORE, AXIS, EXPORT, CHART, SECTION, RUN, DRAWING, MAP, WATERFALL, FIGURE];

/// Which script draws the page.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    Run,
    Comparison,
    Bench,
    Study,
}

/// Text made safe for HTML content and quoted attributes.
pub(crate) fn esc(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    // All of these are bytes of their own, so what stands between them is text.
    let mut from = 0;
    for (at, byte) in text.bytes().enumerate() {
        let safe = match byte {
            b'&' => "&amp;",
            b'<' => "&lt;",
            b'>' => "&gt;",
            b'"' => "&quot;",
            b'\'' => "&#39;",
            _ => continue,
        };
        out.push_str(&text[from..at]);
        out.push_str(safe);
        from = at + 1;
    }
    out.push_str(&text[from..]);
    out
}

/// Units in prose as they are typeset: `0.3 um` and `um` alone become `0.3 µm` and `µm`, `360 deg` becomes `360°`.
fn typeset(text: &str) -> String {
    // Nearly all texts hold neither; one that is taken to pieces in vain stays as it is.
    if !text.as_bytes().windows(2).any(|two| two == b"um" || two == b"eg") {
        return text.to_owned();
    }
    let mut out = String::with_capacity(text.len());
    for (k, word) in text.split(' ').enumerate() {
        let bare = word.trim_end_matches([',', '.', ';', ':', ')']);
        let rest = &word[bare.len()..];
        match bare {
            "deg" if out.ends_with(|c: char| c.is_ascii_digit()) => out.push('°'),
            _ => {
                if k > 0 {
                    out.push(' ');
                }
                out.push_str(if bare == "um" { "µm" } else { bare });
            }
        }
        out.push_str(rest);
    }
    out
}

/// Prose made safe, with what stands between backticks set as code and units typeset outside of it.
pub(crate) fn prose(text: &str) -> String {
    let ticks = text.bytes().filter(|b| *b == b'`').count();
    if ticks == 0 || ticks % 2 == 1 {
        return esc(&typeset(text));
    }
    let mut out = String::new();
    for (i, part) in text.split('`').enumerate() {
        if i % 2 == 1 {
            out.extend(["<code>", &esc(part), "</code>"]);
        } else {
            out.push_str(&esc(&typeset(part)));
        }
    }
    out
}

/// JSON made safe inside a script element: no `<` (so no `</script>`, no `<!--`) and no line separators.
fn json_for_script(data: &impl Serialize) -> String {
    // Text, numbers, lists and maps with text keys: there is nothing in it that JSON refuses.
    let mut json = serde_json::to_string(data).unwrap_or_default();
    for (sign, safe) in [('<', "\\u003c"), ('\u{2028}', "\\u2028"), ('\u{2029}', "\\u2029")] {
        if json.contains(sign) {
            json = json.replace(sign, safe);
        }
    }
    json
}

/// One whole page. The arrays stand in the data as its last key, `arrays`, where there may be any.
pub(crate) fn document(
    kind: Kind,
    title: &str,
    body: &str,
    data: &impl Serialize,
    arrays: Option<&Arrays>,
) -> String {
    let scripts: &[&str] = match kind {
        Kind::Run => RUN_SCRIPTS,
        Kind::Comparison => &[CORE, AXIS, EXPORT, CHART, COMPARE, DRAWING, MAP, WATERFALL, FIGURE],
        Kind::Bench => &[CORE, BENCH],
        Kind::Study => &[CORE, AXIS, EXPORT, CHART, DRAWING, MAP, WATERFALL, FIGURE],
    };
    let json = json_for_script(data);
    let arrays_size = arrays.map_or(0, |a| a.arrays.iter().map(|a| a.len() + 3).sum::<usize>());
    let scripts_size = scripts.iter().map(|s| s.len()).sum::<usize>();
    let mut out = String::with_capacity(body.len() + json.len() + arrays_size + scripts_size + (1 << 16));
    out.push_str("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    // The page may run what is written in it and load nothing from anywhere.
    out.push_str(
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; \
         script-src 'unsafe-inline'; img-src data:\">\n",
    );
    let _ =
        write!(out, "<title>{} · Gudgeon</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n", esc(title));
    out.push_str(body);
    out.push_str("<noscript><p class=\"note\">The drawings and curves on this page need JavaScript; the tables do not.</p></noscript>\n");
    out.push_str("<script type=\"application/json\" id=\"data\">");
    match arrays {
        // Letters, digits and signs of base64 need no look at what JSON and a script element admit.
        Some(arrays) => {
            out.push_str(json.strip_suffix('}').unwrap_or(&json));
            out.push_str(",\"arrays\":[");
            for (k, array) in arrays.arrays.iter().enumerate() {
                out.extend([if k > 0 { ",\"" } else { "\"" }, array, "\""]);
            }
            out.push_str("]}");
        }
        None => out.push_str(&json),
    }
    out.push_str("</script>\n<script>\n");
    if matches!(kind, Kind::Run) {
        let _ = writeln!(out, "const OVER_CYCLE = {};", OVER_CYCLE.trim_end());
    }
    for script in scripts {
        out.push_str(script);
    }
    out.push_str("</script>\n</body>\n</html>\n");
    out
}

/// What stands in the body of a page: a link past the contents, the contents of the sections that are there, the sections themselves and the
/// last line, with the conventions of the scenes.
pub(crate) fn body(contents: &[(&str, &str)], main: &str, version: &str, scenes: &[&str]) -> String {
    let mut out = String::from(
        "<a class=\"skip\" href=\"#main\">Skip the contents</a>\n<nav class=\"contents\" aria-label=\"Contents\"><ul>",
    );
    let there: Vec<&str> = main.split("<section id=\"").skip(1).filter_map(|s| s.split('"').next()).collect();
    for (id, name) in contents.iter().filter(|(id, _)| there.contains(id)) {
        let _ = write!(out, "<li><a href=\"#{id}\">{name}</a></li>");
    }
    out.push_str("</ul></nav>\n<main id=\"main\">\n");
    out.push_str(main);
    out.push_str("</main>\n");
    out.push_str(&footer(version, scenes));
    out
}

/// The two letters of twelve bits, of all there are.
static LETTERS: [[u8; 2]; 4096] = {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut all = [[0; 2]; 4096];
    let mut bits = 0;
    while bits < all.len() {
        all[bits] = [ALPHABET[bits >> 6], ALPHABET[bits & 63]];
        bits += 1;
    }
    all
};

/// Standard base64.
fn base64(bytes: &[u8]) -> String {
    let letters = |[a, b, c]: [u8; 3]| {
        let group = usize::from(a) << 16 | usize::from(b) << 8 | usize::from(c);
        let ([a, b], [c, d]) = (LETTERS[group >> 12], LETTERS[group & 4095]);
        [a, b, c, d]
    };
    let mut out = vec![b'='; bytes.len().div_ceil(3) * 4];
    let (whole, rest) = bytes.as_chunks::<3>();
    let (places, _) = out.as_chunks_mut::<4>();
    places.iter_mut().zip(whole).for_each(|(place, three)| *place = letters(*three));
    if let ([first, others @ ..], Some(place)) = (rest, places.last_mut()) {
        let [a, b, c, _] = letters([*first, others.first().copied().unwrap_or(0), 0]);
        *place = [a, b, if others.is_empty() { b'=' } else { c }, b'='];
    }
    // Letters, digits and signs of the alphabet are text.
    String::from_utf8(out).unwrap_or_default()
}

/// Numbers as base64 of little-endian 32-bit floats: seven digits, enough for a drawing, at five bytes a number.
fn packed(values: &[f64]) -> String {
    let (threes, rest) = values.as_chunks::<3>();
    let mut out: Vec<[[u8; 2]; 8]> = Vec::with_capacity(threes.len() + 1);
    // Three numbers are 96 bits and so sixteen letters, without a number for each byte in between.
    out.extend(threes.iter().map(|three| {
        let [a, b, c] = three.map(|v| u64::from((v as f32).to_bits().swap_bytes()));
        let (high, low) = (a << 16 | b >> 16, (b & 0xffff) << 32 | c);
        let letters = |bits: u64, shift: u32| LETTERS[(bits >> shift) as usize & 4095];
        let [a, b, c, d] = [36, 24, 12, 0].map(|shift| letters(high, shift));
        let [e, f, g, h] = [36, 24, 12, 0].map(|shift| letters(low, shift));
        [a, b, c, d, e, f, g, h]
    }));
    let mut out = out.into_flattened().into_flattened();
    let bytes: Vec<u8> = rest.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect();
    out.extend_from_slice(base64(&bytes).as_bytes());
    // Letters, digits and signs of the alphabet are text.
    String::from_utf8(out).unwrap_or_default()
}

/// Most rows of a curve that a page carries; two per degree of a four-stroke cycle.
const MAX_ROWS: usize = 1441;

/// A column of a series and the number of its array.
#[derive(Debug, Serialize)]
pub(crate) struct PlacedColumn {
    name: String,
    unit: String,
    at: usize,
}

/// A series, of which every n-th row is in the arrays.
#[derive(Debug, Serialize)]
pub(crate) struct Placed {
    axis: PlacedColumn,
    columns: Vec<PlacedColumn>,
    every: usize,
}

/// Collects arrays for a page; equal arrays are stored once.
#[derive(Default)]
pub(crate) struct Arrays {
    arrays: Vec<String>,
}

impl Arrays {
    fn add(&mut self, text: String) -> usize {
        if let Some(i) = self.arrays.iter().position(|a| *a == text) {
            return i;
        }
        self.arrays.push(text);
        self.arrays.len() - 1
    }

    /// At most [`MAX_ROWS`] rows of some columns.
    pub(crate) fn series<'a>(&mut self, axis: &Column, columns: impl Iterator<Item = &'a Column>) -> Placed {
        self.thinned(axis, columns, axis.values.len().div_ceil(MAX_ROWS).max(1))
    }

    /// As [`Arrays::series`] with every row: a map cannot spare any.
    pub(crate) fn whole(&mut self, table: &Series) -> Placed {
        self.thinned(&table.axis, table.columns.iter(), 1)
    }

    /// As [`Arrays::whole`], but of the columns alone that figures read.
    pub(crate) fn read(&mut self, table: &Series, columns: &[&str]) -> Placed {
        self.thinned(&table.axis, table.columns.iter().filter(|c| columns.contains(&c.name.as_str())), 1)
    }

    fn thinned<'a>(
        &mut self,
        axis: &Column,
        columns: impl Iterator<Item = &'a Column>,
        every: usize,
    ) -> Placed {
        let mut place = |c: &Column| {
            let at = self.add(if every == 1 {
                packed(&c.values)
            } else {
                packed(&c.values.iter().copied().step_by(every).collect::<Vec<_>>())
            });
            PlacedColumn { name: c.name.clone(), unit: c.unit.clone(), at }
        };
        Placed { axis: place(axis), columns: columns.map(place).collect(), every }
    }

    /// The arrays, as text.
    pub(crate) fn into_texts(self) -> Vec<String> {
        self.arrays
    }
}

/// `<td>` with a number and its unit.
pub(crate) fn value_cells(v: Option<&ResultValue>) -> String {
    match v {
        Some(v) => format!(
            "<td class=\"num\">{}</td><td class=\"unit\">{}</td>",
            certain(v.value, v.uncertainty, 4),
            esc(&unit(&v.unit))
        ),
        None => "<td class=\"num\">–</td><td></td>".into(),
    }
}

/// The balance sheet.
fn balance_table(balance: &BalanceSheet) -> String {
    let rows = [
        ("Gas mass", "(in − out − stored) / (throughput or content, whichever is more)", balance.gas_mass),
        ("Oil mass", "(in − out − stored) / throughput", balance.oil_mass),
        (
            "Oil on ring flanks",
            "(in − out − stored) / (throughput or content, whichever is more)",
            balance.flank_oil,
        ),
        ("Oil in the gaps of the skirt", "(in − out − stored) / (in + stored before)", balance.skirt_oil),
        (
            "Energy",
            "work of all forces on the rings less the change of their kinetic energy, by the sum of magnitudes",
            balance.energy,
        ),
        (
            "Momentum",
            "impulse of all forces on the rings less the change of their momentum, by the sum of magnitudes",
            balance.momentum,
        ),
        ("Gas energy", "(brought − heat − work − stored) / most that was held", balance.gas_energy),
    ];
    if rows.iter().all(|(_, _, v)| v.is_none()) {
        return String::new();
    }
    let mut out = String::from(
        "<div><h3>Balance sheet</h3><p class=\"hint\">Relative closure over one cycle: what the \
         numerics lose. It should be small beside the accuracy you need.</p><table class=\"plain\"><tbody>",
    );
    for (name, how, value) in rows {
        let text = match value {
            Some(_) => significant(value, 2),
            None => "<span class=\"muted\">none in this run</span>".into(),
        };
        let _ = write!(
            out,
            "<tr><th scope=\"row\">{name}</th><td class=\"num\">{text}</td><td class=\"what\">{how}</td></tr>"
        );
    }
    out.push_str("</tbody></table></div>\n");
    out
}

/// What the numerics did, folded: balances, work, refinement.
pub(crate) fn numerics_section(balance: &BalanceSheet, solver: &SolverEntry, refined: &[Refined]) -> String {
    let own = [balance_table(balance), solver_table(solver), refined_table(refined)].concat();
    format!(
        "<section id=\"numerics\"><details><summary><h2>Numerics</h2></summary><div class=\"pair\">\n{own}</div></details></section>\n"
    )
}

/// Models with equations, validity and references, as this program knows them.
pub(crate) fn models_section(models: &[ModelEntry]) -> String {
    let registry = Registry::collect();
    let mut out = String::from(
        "<section id=\"models\"><details><summary><h2>Models</h2></summary><p class=\"hint\">What ran, with its equations. References are keys \
         of REFERENCES.bib.</p><div class=\"models\">",
    );
    for m in models {
        let info = registry.model(&m.kind, &m.model);
        let _ = write!(
            out,
            "<article class=\"model\"><h3><span class=\"kind\">{}</span> {}</h3>",
            esc(&m.kind.replace('_', " ")),
            esc(&m.model)
        );
        if let Some(info) = info {
            let _ = write!(out, "<p>{}</p>", prose(info.summary));
            if !info.equations.trim().is_empty() {
                let _ = write!(out, "<pre tabindex=\"0\">{}</pre>", esc(info.equations.trim()));
            }
            if !info.validity.trim().is_empty() {
                let _ = write!(out, "<p class=\"valid\"><b>Valid</b> {}</p>", prose(info.validity.trim()));
            }
        }
        if !m.references.is_empty() {
            let keys: Vec<String> = m.references.iter().map(|r| format!("<code>{}</code>", esc(r))).collect();
            let _ = write!(out, "<p class=\"refs\">{}</p>", keys.join(" "));
        }
        out.push_str("</article>");
    }
    out.push_str("</div></details></section>\n");
    out
}

/// What was not computed.
pub(crate) fn skipped_section(skipped: &[SkippedEntry]) -> String {
    if skipped.is_empty() {
        return String::new();
    }
    let mut out = String::from(
        "<section id=\"skipped\"><details><summary><h2>Not computed</h2></summary><table class=\"plain\"><tbody>",
    );
    for s in skipped {
        let _ = write!(out, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", prose(&s.what), prose(&s.why));
    }
    out.push_str("</tbody></table></details></section>\n");
    out
}

/// Work of the solver.
fn solver_table(solver: &SolverEntry) -> String {
    let mut out = String::from("<div><h3>Solver</h3><table class=\"plain\"><tbody>");
    let _ =
        write!(out, "<tr><th scope=\"row\">method</th><td class=\"num\">{}</td></tr>", esc(&solver.method));
    for (name, n) in &solver.counters {
        let _ = write!(
            out,
            "<tr><th scope=\"row\">{}</th><td class=\"num\">{}</td></tr>",
            esc(&name.replace('_', " ")),
            count(*n)
        );
    }
    out.push_str("</tbody></table></div>\n");
    out
}

/// All notes, the gravest first.
pub(crate) fn notes_section(notes: &[Note]) -> String {
    if notes.is_empty() {
        return String::new();
    }
    format!("<section id=\"notes\"><h2>Notes</h2>{}</section>\n", self::notes(notes))
}

/// Notes by their level.
pub(crate) fn notes(notes: &[Note]) -> String {
    let of = |level: NoteLevel, class: &str| {
        let items: Vec<String> = notes
            .iter()
            .filter(|n| n.level == level)
            .map(|n| format!("<p>{}</p>", prose(&capital(&n.text))))
            .collect();
        if items.is_empty() {
            return String::new();
        }
        format!("<div class=\"note {class}\" role=\"note\">{}</div>\n", items.concat())
    };
    of(NoteLevel::Failure, "failure")
        + &of(NoteLevel::Exceeded, "exceeded")
        + &of(NoteLevel::Caution, "caution")
        + &of(NoteLevel::Info, "info")
}

/// What was refined to know the uncertainties.
fn refined_table(refined: &[Refined]) -> String {
    if refined.is_empty() {
        return String::new();
    }
    let row = |r: &Refined| {
        let levels: Vec<String> = r.levels.iter().map(|l| esc(&l.join(", "))).collect();
        format!(
            "<tr><th scope=\"row\">{}</th><td><code>{}</code></td></tr>",
            esc(&r.what),
            levels.join("<br>")
        )
    };
    let rows: Vec<String> = refined.iter().map(row).collect();
    format!(
        "<div><h3>Refined</h3><p class=\"hint\">The uncertainties beside the results are numerical: the sum, over \
         these groups of settings, of the distance to the finest level and of what is left behind it. They say nothing of the \
         models.</p><table class=\"plain\"><tbody>{}</tbody></table></div>\n",
        rows.concat()
    )
}

/// Where the case comes from, what it assumes, and what the run was made of.
pub(crate) fn sources_section(s: &Summary) -> String {
    let mut out = String::new();
    if !s.source.is_empty() {
        let _ = write!(out, "<p class=\"source\"><b>Source</b> {}</p>", prose(&s.source));
    }
    if !s.assumptions.is_empty() {
        out.push_str("<h3>Assumed where the source is silent</h3><ul class=\"assumptions\">");
        for a in &s.assumptions {
            let _ = write!(out, "<li>{}</li>", prose(a));
        }
        out.push_str("</ul>");
    }
    out.push_str(&provenance_table(&s.gudgeon, &s.provenance));
    if out.is_empty() {
        return out;
    }
    format!(
        "<section id=\"sources\"><details><summary><h2>Sources and assumptions</h2></summary>{out}</details></section>\n"
    )
}

/// What repeats the run.
fn provenance_table(version: &str, p: &Provenance) -> String {
    if p.file.is_empty() {
        return String::new();
    }
    let mut rows = vec![
        ("program", format!("Gudgeon {} {}", esc(version), code(&p.revision))),
        ("case file", format!("{} <span class=\"hash\">{}</span>", code(&p.file), esc(&p.sha256))),
    ];
    for o in &p.overrides {
        rows.push(("changed", code(o)));
    }
    for (name, f) in &p.files {
        rows.push(("file", format!("{} <span class=\"hash\">{}</span>", code(name), esc(&f.sha256))));
    }
    rows.push(("resolved case", format!("<span class=\"hash\">{}</span>", esc(&p.resolved_sha256))));
    let rows: Vec<String> =
        rows.iter().map(|(k, v)| format!("<tr><th scope=\"row\">{k}</th><td>{v}</td></tr>")).collect();
    format!(
        "<h3>Made of</h3><p class=\"hint\"><code>gudgeon run summary.json</code> repeats this run from \
         the file beside this page. Hashes are SHA-256.</p><table class=\"plain\"><tbody>{}</tbody></table>\n",
        rows.concat()
    )
}

fn code(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("<code>{}</code>", esc(text)) }
}

/// Closing line: the program, and what angles and directions count from.
fn footer(version: &str, scenes: &[&str]) -> String {
    let version = if version.is_empty() { String::new() } else { format!(" {}", esc(version)) };
    let conventions = if !scenes.is_empty() && scenes.iter().all(|s| *s == "shaft_line") {
        "Angles are those of the reference shaft; a throw counts its own from the outer dead centre of its cylinder. Amplitudes are \
         half of peak to peak. Pressures are absolute."
    } else {
        "Crank angle 0° is the gas-exchange top dead centre (start of intake), 360° the firing one. Pressures are absolute. Axial \
         direction: positive towards the cylinder head."
    };
    format!("<footer>Made by Gudgeon{version}. {conventions}</footer>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_typeset_outside_of_code() {
        assert_eq!(
            prose("a film of 0.3 um (most at 360 deg), `1 um`"),
            "a film of 0.3 µm (most at 360°), <code>1 um</code>"
        );
        assert_eq!(prose("crank angle in deg"), "crank angle in deg");
        assert_eq!(prose("um, not mm"), "µm, not mm");
    }

    #[test]
    fn base64_matches_the_test_vectors_of_rfc_4648() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn packed_numbers_are_the_letters_of_their_bytes() {
        let values: Vec<f64> = (0..9).map(|k| 1.0 / (f64::from(k) - 3.3)).collect();
        for n in 0..values.len() {
            let bytes: Vec<u8> = values[..n].iter().flat_map(|v| (*v as f32).to_le_bytes()).collect();
            assert_eq!(packed(&values[..n]), base64(&bytes));
        }
    }

    #[test]
    fn nothing_in_the_scripts_closes_their_element() {
        for script in [CORE, AXIS, CHART, EXPORT, MAP, DRAWING, FIGURE, SECTION, RUN, COMPARE, BENCH] {
            assert!(!script.to_lowercase().contains("</script"));
            assert!(!script.contains("<!--"));
            // Text from a case must never be parsed as markup.
            assert!(!script.contains("innerHTML"));
        }
        assert!(!STYLE.to_lowercase().contains("</style"));
    }

    #[test]
    fn long_series_are_thinned_to_a_bounded_size() {
        let theta: Vec<f64> = (0..7201).map(|i| f64::from(i) * 0.1).collect();
        let mut arrays = Arrays::default();
        let axis = Column { values: theta, ..Column::default() };
        let series = arrays.series(&axis, std::iter::empty());
        assert_eq!(series.every, 5);
        let rows = 7201usize.div_ceil(5);
        assert_eq!(arrays.arrays[0].len(), (rows * 4).div_ceil(3) * 4);
    }
}
