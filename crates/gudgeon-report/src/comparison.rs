//! A comparison's files and its page.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use gudgeon_core::result::{
    Assessment, Column, ComparedCase, Comparison, Figure, Grade, Series, ShareTable, Variant, short_value,
};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::folder::Folder;
use crate::number::{capital, certain, count, percent, round_trip, significant, unit};
use crate::over_values::Point;
use crate::page::{self, Arrays, Kind, esc};
use crate::summary::{ModelEntry, ResultValue, Summary};
use crate::{REPORT, ReportError, over_values, overview, shares, table};

pub(crate) const COMPARISON: &str = "comparison.json";
const TABLE: &str = "comparison.csv";
const SERIES: &str = "series.csv";
const TIMING: &str = "timing.json";

/// Where [`write_comparison`] put things.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ComparisonFiles {
    /// Everything but the curves.
    pub comparison: PathBuf,
    /// Results down, variants across.
    pub table: PathBuf,
    /// Curves of all variants in long form, told apart by the column `variant`.
    pub series: PathBuf,
    /// The page.
    pub report: PathBuf,
}

#[derive(Debug, Serialize, Deserialize)]
struct Swap {
    path: String,
    values: Vec<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct VariantEntry {
    /// 1 for the base.
    number: usize,
    label: String,
    /// Number of its case, from 0.
    #[serde(default)]
    case: usize,
    swaps: IndexMap<String, String>,
    /// Why there is no run: the combination was left out, refused, or failed.
    error: Option<String>,
    /// Whether there is no such machine.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    left_out: bool,
    /// The shape of `summary.json`.
    run: Option<Summary>,
}

/// One result over all variants; null where a variant has none.
#[derive(Debug, Serialize, Deserialize)]
struct Row {
    unit: String,
    values: Vec<Option<f64>>,
    /// To the first variant of the same case.
    difference_percent: Vec<Option<f64>>,
}

#[derive(Debug, Serialize, Deserialize)]
struct File {
    case: String,
    title: String,
    #[serde(default)]
    cases: Vec<ComparedCase>,
    swaps: Vec<Swap>,
    #[serde(default)]
    shares: Vec<ShareTable>,
    variants: Vec<VariantEntry>,
    results: IndexMap<String, Row>,
}

impl File {
    fn new(c: &Comparison) -> Self {
        let variants: Vec<VariantEntry> = c
            .variants
            .iter()
            .enumerate()
            .map(|(i, v)| VariantEntry {
                number: i + 1,
                label: v.label.clone(),
                case: v.case,
                swaps: v.swaps.iter().cloned().collect(),
                error: v.why(),
                left_out: v.is_left_out(),
                run: v.outcome.as_ref().ok().map(Summary::new),
            })
            .collect();
        Self {
            case: c.case.clone(),
            title: c.title.clone(),
            cases: c.cases.clone(),
            shares: c.shares.clone(),
            swaps: c
                .swaps
                .iter()
                .map(|(path, values)| Swap { path: path.clone(), values: values.clone() })
                .collect(),
            results: rows(&variants),
            variants,
        }
    }
}

/// The variant that another is compared with: the first one of its case.
fn base_of<'a>(variants: &'a [VariantEntry], v: &'a VariantEntry) -> &'a VariantEntry {
    variants.iter().find(|b| b.case == v.case).unwrap_or(v)
}

fn rows(variants: &[VariantEntry]) -> IndexMap<String, Row> {
    let mut names: IndexMap<&str, &str> = IndexMap::new();
    for run in variants.iter().filter_map(|v| v.run.as_ref()) {
        for (name, v) in &run.results {
            names.entry(name).or_insert(&v.unit);
        }
    }
    let value = |v: &VariantEntry, name: &str, u: &str| -> Option<f64> {
        // Values in different units cannot stand in one row.
        v.run.as_ref()?.results.get(name).filter(|v| v.unit == u)?.value
    };
    names
        .iter()
        .map(|(name, u)| {
            let values: Vec<Option<f64>> = variants.iter().map(|v| value(v, name, u)).collect();
            let difference = |(k, v): (usize, &Option<f64>)| {
                let base = values[base_of(variants, &variants[k]).number - 1].filter(|b| *b != 0.0)?;
                Some(((*v)? - base) / base.abs() * 100.0).filter(|d| d.is_finite())
            };
            let difference_percent = values.iter().enumerate().map(difference).collect();
            ((*name).to_owned(), Row { unit: (*u).to_owned(), values, difference_percent })
        })
        .collect()
}

/// Writes `comparison.json`, `comparison.csv`, `series.csv` and `report.html` of a comparison into `dir`.
///
/// # Errors
/// A column of another length than the crank angles, or a file system that refuses; files already in `dir` are then as
/// they were.
pub fn write_comparison(c: &Comparison, dir: &Path) -> Result<ComparisonFiles, ReportError> {
    write_comparison_in(c, Folder::open(dir)?)
}

/// As [`write_comparison`], into a folder that was opened before the runs.
///
/// # Errors
/// As [`write_comparison`].
pub fn write_comparison_in(c: &Comparison, mut folder: Folder) -> Result<ComparisonFiles, ReportError> {
    let dir = folder.path().to_owned();
    let file = File::new(c);
    let series: Vec<(usize, &Series)> = c
        .variants
        .iter()
        .enumerate()
        .filter_map(|(i, v)| v.outcome.as_ref().ok().map(|r| (i + 1, &r.series)))
        .collect();
    folder.add(SERIES, &table::long_csv(&series)?)?;
    folder.add(TABLE, &csv_table(&file)?)?;
    folder.add(REPORT, page(&file, &series).as_bytes())?;
    folder.add(TIMING, timing(c).as_bytes())?;
    folder.add(COMPARISON, (serde_json::to_string_pretty(&file).unwrap_or_default() + "\n").as_bytes())?;
    folder.commit()?;
    Ok(ComparisonFiles {
        comparison: dir.join(COMPARISON),
        table: dir.join(TABLE),
        series: dir.join(SERIES),
        report: dir.join(REPORT),
    })
}

/// Wall-clock seconds of every variant by phase: apart, so that the other files of two equal comparisons are equal to the byte.
fn timing(c: &Comparison) -> String {
    let of =
        |v: &Variant| json!({ "variant": v.label, "seconds": v.outcome.as_ref().ok().map(|r| &r.seconds) });
    format!("{:#}\n", json!(c.variants.iter().map(of).collect::<Vec<_>>()))
}

/// Whether a difference is smaller than the numerical uncertainties of both values.
fn within_numerics(base: &VariantEntry, v: &VariantEntry, name: &str) -> bool {
    let of = |v: &VariantEntry| {
        let r = v.run.as_ref()?.results.get(name)?;
        Some((r.value?, r.uncertainty?))
    };
    of(base).zip(of(v)).is_some_and(|((a, ua), (b, ub))| (a - b).abs() < ua + ub)
}

/// Rebuilds the page of a comparison.
pub(crate) fn rewrite(dir: &Path) -> Result<PathBuf, ReportError> {
    let path = dir.join(COMPARISON);
    let bytes = std::fs::read(&path).map_err(ReportError::io("read", &path))?;
    let file: File = serde_json::from_slice(&bytes)
        .map_err(|e| ReportError::Malformed { path: path.clone(), why: e.to_string() })?;
    let series = dir.join(SERIES);
    let series = if series.is_file() { table::read_long(&series)? } else { Vec::new() };
    let series: Vec<(usize, &Series)> = series.iter().map(|(n, s)| (*n, s)).collect();
    let mut folder = Folder::open(dir)?;
    folder.add(REPORT, page(&file, &series).as_bytes())?;
    folder.commit_beside()?;
    Ok(dir.join(REPORT))
}

/// Names of the counters or phases that any variant has.
fn union<'a, V>(
    variants: impl Iterator<Item = &'a VariantEntry>,
    of: impl Fn(&'a Summary) -> &'a IndexMap<String, V>,
) -> Vec<&'a str>
where
    V: 'a,
{
    let mut names: Vec<&str> = Vec::new();
    for run in variants.filter_map(|v| v.run.as_ref()) {
        for name in of(run).keys() {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
    }
    names
}

fn csv_table(file: &File) -> Result<Vec<u8>, ReportError> {
    let mut out = vec![
        ["result".to_owned(), "unit".to_owned()]
            .into_iter()
            .chain(file.variants.iter().map(|v| v.label.clone()))
            .collect::<Vec<_>>(),
    ];
    for (name, row) in &file.results {
        let mut line = vec![name.clone(), row.unit.clone()];
        line.extend(row.values.iter().map(|v| v.map_or_else(String::new, round_trip)));
        out.push(line);
    }
    for name in union(file.variants.iter(), |r| &r.solver.counters) {
        let mut line = vec![format!("solver.{name}"), "-".to_owned()];
        line.extend(file.variants.iter().map(|v| {
            let n = v.run.as_ref().and_then(|r| r.solver.counters.get(name));
            n.map_or_else(String::new, u64::to_string)
        }));
        out.push(line);
    }
    table::csv(out)
}

/// Curves worth overlaying; the rest stay in `series.csv`.
fn overlaid(c: &Column) -> bool {
    const LAST: [&str; 11] = [
        "p",
        "position",
        "lift",
        "h_min",
        "cumulative_mass",
        "cumulative",
        "rate",
        "flow",
        "friction_force",
        "friction_power",
        "contact_load",
    ];
    let known = ["ring", "land", "cylinder", "blow_by", "piston"].iter().any(|p| c.name.starts_with(p));
    let last = c.name.rsplit('.').next().unwrap_or("");
    // Other scenes name their curves themselves.
    !known || LAST.contains(&last)
}

fn badge(n: usize) -> String {
    format!("<span class=\"badge c{}\">{n}</span>", (n - 1) % 8)
}

fn page(file: &File, series: &[(usize, &Series)]) -> String {
    let heading = if file.title.trim().is_empty() { &file.case } else { &file.title };
    let ran: Vec<&VariantEntry> = file.variants.iter().filter(|v| v.run.is_some()).collect();
    let drawn = drawn(file, series);
    let over_values = over_values(file, &ran);
    let mut main = String::new();
    overview(&mut main, file, heading, &ran);
    if ran.is_empty() {
        main.push_str(
            "<section id=\"results\"><h2>Results</h2><p class=\"hint\">No variant ran.</p></section>\n",
        );
    } else {
        shares::section(&mut main, &file.shares);
        if !over_values.is_empty() {
            main.push_str("<section id=\"values\"><h2>Over the values</h2><div id=\"figures\" class=\"figures\"></div></section>\n");
        }
    }
    curves(&mut main, &drawn, series.len());
    refused_variants(&mut main, file);
    notes_of_runs(&mut main, &ran);
    if !ran.is_empty() {
        comparison_tables(&mut main, file, &ran);
    }
    models_of_runs(&mut main, &ran);
    let version = ran.first().and_then(|v| v.run.as_ref()).map_or("", |r| r.gudgeon.as_str());
    let scenes: Vec<&str> = ran.iter().filter_map(|v| v.run.as_ref().map(|r| r.scene.as_str())).collect();
    let body = page::body(&CONTENTS, &main, version, &scenes);

    let mut arrays = Arrays::default();
    let tables: serde_json::Map<String, serde_json::Value> =
        over_values.iter().map(|(f, t)| (f.table.clone(), arrays.whole(t))).collect();
    let figures: Vec<&Figure> = over_values.iter().map(|(f, _)| f).collect();
    let variants: Vec<serde_json::Value> = drawn
        .iter()
        .map(|(n, s)| {
            let label = file.variants.iter().find(|v| v.number == *n).map_or("", |v| v.label.as_str());
            let columns = arrays.series(&s.axis, s.columns.iter().filter(|c| overlaid(c)));
            json!({ "number": n, "label": label, "series": columns })
        })
        .collect();
    let data = json!({ "cases": file.cases.len(), "variants": variants, "figures": figures, "tables": tables, "arrays": arrays.into_json() });
    page::document(Kind::Comparison, heading, &body, &data)
}

/// Sections in their order, with their names in the contents at the side.
const CONTENTS: [(&str, &str); 9] = [
    ("overview", "Overview"),
    ("shares", "Which choice matters"),
    ("values", "Over the values"),
    ("cycle", "Over the cycle"),
    ("curves", "Curves"),
    ("refused", "Did not run"),
    ("notes", "Notes"),
    ("results", "All results"),
    ("models", "Models"),
];

/// Headlines over the values of the swaps, of the first case.
fn over_values(file: &File, ran: &[&VariantEntry]) -> Vec<(Figure, Series)> {
    let Some(first) = ran.first().and_then(|v| v.run.as_ref()) else { return Vec::new() };
    let swaps: Vec<(&str, &[String])> =
        file.swaps.iter().map(|s| (s.path.as_str(), s.values.as_slice())).collect();
    let own: Vec<&&VariantEntry> = ran.iter().filter(|v| v.case == 0).collect();
    let results: Vec<_> = own
        .iter()
        .map(|v| {
            move |name: &str| {
                let r = v.run.as_ref()?.results.get(name)?;
                Some((r.value?, r.unit.as_str()))
            }
        })
        .collect();
    let points: Vec<Point<'_>> = own
        .iter()
        .zip(&results)
        .map(|(v, result)| Point {
            choices: v.swaps.iter().map(|(p, x)| (p.as_str(), x.as_str())).collect(),
            result,
        })
        .collect();
    over_values::figures(&swaps, &first.headlines, &points)
}

/// Title, what was swapped, how the runs went, and the headlines of every variant.
fn overview(out: &mut String, file: &File, heading: &str, ran: &[&VariantEntry]) {
    out.push_str("<section id=\"overview\">\n");
    page_header(out, file, heading);
    let graded: Vec<(Grade, &VariantEntry)> =
        ran.iter().filter_map(|v| Some((Assessment::of(&v.run.as_ref()?.notes).grade, *v))).collect();
    let all = file.variants.len();
    let missing = all - ran.len();
    let left_out: Vec<&VariantEntry> = file.variants.iter().filter(|v| v.left_out).collect();
    let count = |g: Grade| graded.iter().filter(|v| v.0 == g).count();
    let own = graded.iter().map(|v| v.0).max().unwrap_or_default();
    let grade = match missing {
        0 => own,
        n if n == left_out.len() => own.max(Grade::Amber),
        _ => Grade::Red,
    };
    let title = match (missing, left_out.len()) {
        (0, _) => format!("All {all} variants ran"),
        (n, 0) => format!("{} of {all} variants ran, {n} failed or were refused", ran.len()),
        (n, out) if n == out => format!(
            "{} of {all} variants ran; {out} cannot be and {} left out",
            ran.len(),
            if out == 1 { "is" } else { "are" }
        ),
        (n, out) => format!(
            "{} of {all} variants ran, {} failed or were refused, {out} cannot be",
            ran.len(),
            n - out
        ),
    };
    let mut reasons: Vec<String> = file
        .variants
        .iter()
        .filter_map(|v| Some(format!("`{}` {}", v.label, v.error.as_deref()?.trim())))
        .take(TOLD_MISSING)
        .collect();
    for (g, what) in [
        (Grade::Red, "with a limit that is not kept, or not what was asked for"),
        (Grade::Amber, "valid with reservations"),
        (Grade::Green, "valid"),
    ] {
        if count(g) > 0 {
            reasons.push(format!("{} {what}", count(g)));
        }
    }
    overview::banner(out, grade, &title, &reasons);
    headline_cards(out, file, ran);
    out.push_str("</section>\n<div id=\"bar\"></div>\n");
}

/// Variants without a run whose reason stands on the first page.
const TOLD_MISSING: usize = 2;

/// Most variants in a card.
const IN_CARD: usize = 8;

/// How much a result differs between variants, over its largest magnitude.
fn spread(ran: &[&VariantEntry], name: &str) -> f64 {
    let values = ran.iter().filter_map(|v| v.run.as_ref()?.results.get(name)?.value);
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let top = lo.abs().max(hi.abs());
    if top > 0.0 && top.is_finite() { (hi - lo) / top } else { 0.0 }
}

/// A card for each headline of the first variant, a row a variant: of several rings or shafts the one that differs most.
fn headline_cards(out: &mut String, file: &File, ran: &[&VariantEntry]) {
    let Some(first) = ran.first().and_then(|v| v.run.as_ref()) else { return };
    out.push_str("<h2 class=\"unseen\">Headline results</h2>\n<div class=\"cards broad\">\n");
    for h in first.headlines.iter().take(overview::CARDS) {
        // A whole with its part is told by the whole.
        let most = h.results.iter().rev().max_by(|a, b| spread(ran, &a.1).total_cmp(&spread(ran, &b.1)));
        let whole = h.results.first().filter(|(label, _)| label == "all");
        let Some((label, name)) = whole.or(most) else { continue };
        let title = if label.is_empty() || h.results.len() == 1 {
            h.title.clone()
        } else {
            format!("{}, {label}", h.title)
        };
        let rows: Vec<(String, usize, &ResultValue)> = ran
            .iter()
            .take(IN_CARD)
            .filter_map(|v| Some((short_label(file, v), v.number - 1, v.run.as_ref()?.results.get(name)?)))
            .collect();
        let _ = write!(out, "<div class=\"card\"><h3>{}</h3>", page::prose(&capital(&title)));
        overview::rows(out, &rows);
        out.push_str("</div>\n");
    }
    out.push_str("</div>\n");
    if ran.len() > IN_CARD {
        let _ = write!(
            out,
            "<p class=\"hint\">The first {IN_CARD} of {} variants; the tables below have all.</p>",
            ran.len()
        );
    }
}

/// The values of a variant without the paths, which stand above.
fn short_label(file: &File, v: &VariantEntry) -> String {
    let values: Vec<String> = v.swaps.values().map(|x| short_value(x)).collect();
    let case = file.cases.get(v.case).filter(|_| file.cases.len() > 1).map(|c| c.name.clone());
    let all: Vec<String> = case.into_iter().chain(values).collect();
    if all.is_empty() { v.label.clone() } else { all.join(", ") }
}

fn page_header(out: &mut String, file: &File, heading: &str) {
    let _ = write!(
        out,
        "<header><h1>{}</h1><p class=\"meta\"><code>{}</code> · comparison of {} variants</p>",
        esc(heading),
        esc(&file.case),
        file.variants.len()
    );
    for s in &file.swaps {
        let values: Vec<String> =
            s.values.iter().map(|v| format!("<code>{}</code>", esc(&short_value(v)))).collect();
        let _ = write!(out, "<p class=\"source\"><b>{}</b> {}</p>", esc(&s.path), values.join(" "));
    }
    out.push_str("</header>\n");
}

/// Variants that did not run, with the reasons.
fn refused_variants(out: &mut String, file: &File) {
    let missing: Vec<&VariantEntry> = file.variants.iter().filter(|v| v.run.is_none()).collect();
    if !missing.is_empty() {
        out.push_str(
            "<section id=\"refused\" class=\"note\"><h2>Did not run</h2><table class=\"plain\"><tbody>",
        );
        for v in missing {
            let _ = write!(
                out,
                "<tr><th scope=\"row\">{} {}</th><td><pre class=\"error\">{}</pre></td></tr>",
                badge(v.number),
                esc(&v.label),
                esc(v.error.as_deref().unwrap_or("no reason is recorded").trim())
            );
        }
        out.push_str("</tbody></table></section>\n");
    }
}

fn notes_of_runs(out: &mut String, ran: &[&VariantEntry]) {
    let noted: Vec<&&VariantEntry> =
        ran.iter().filter(|v| v.run.as_ref().is_some_and(|r| !r.notes.is_empty())).collect();
    if !noted.is_empty() {
        out.push_str("<section id=\"notes\"><h2>Notes of the runs</h2><table class=\"plain\"><tbody>");
        for v in noted {
            let notes: Vec<String> = v
                .run
                .iter()
                .flat_map(|r| &r.notes)
                .map(|n| format!("<p>{}</p>", page::prose(&n.text)))
                .collect();
            let _ = write!(
                out,
                "<tr><th scope=\"row\">{} {}</th><td>{}</td></tr>",
                badge(v.number),
                esc(&v.label),
                notes.concat()
            );
        }
        out.push_str("</tbody></table></section>\n");
    }
}

/// Most variants whose curves can be told apart.
const MAX_DRAWN: usize = 12;

/// The variants whose curves are drawn: all, or of many those that differ from the base of their case in at most one choice, or those of the
/// first case alone.
fn drawn<'a>(file: &File, series: &[(usize, &'a Series)]) -> Vec<(usize, &'a Series)> {
    let variant = |n: usize| file.variants.iter().find(|v| v.number == n);
    let keep = |test: &dyn Fn(&VariantEntry) -> bool| -> Vec<(usize, &'a Series)> {
        series.iter().copied().filter(|(n, _)| variant(*n).is_none_or(test)).collect()
    };
    let near = |v: &VariantEntry| {
        let base = base_of(&file.variants, v);
        v.swaps.iter().filter(|(path, value)| base.swaps.get(*path) != Some(value)).count() <= 1
    };
    let mut drawn = series.to_vec();
    if drawn.len() > MAX_DRAWN {
        drawn = keep(&near);
    }
    if drawn.len() > MAX_DRAWN {
        drawn = keep(&|v| v.case == 0 && near(v));
    }
    drawn.truncate(MAX_DRAWN);
    drawn
}

/// Places for the curves, which the script draws.
fn curves(out: &mut String, series: &[(usize, &Series)], all: usize) {
    let fewer = match all - series.len() {
        0 => String::new(),
        _ => format!(
            "<p class=\"hint\">Drawn are {} variants, which differ from the base in one choice; series.csv holds all {all}.</p>",
            series.len()
        ),
    };
    let drawn: Vec<_> =
        series.iter().filter(|(_, s)| !s.axis.values.is_empty() && !s.columns.is_empty()).collect();
    if drawn.iter().any(|(_, s)| s.is_over_cycle()) {
        let _ = writeln!(
            out,
            "<section id=\"cycle\"><h2>Over the cycle</h2>{fewer}<div id=\"plots\" class=\"figures\"></div></section>"
        );
    } else if !drawn.is_empty() {
        let _ = writeln!(
            out,
            "<section id=\"curves\"><h2>Curves</h2>{fewer}<div id=\"overlay\" class=\"figures\"></div></section>"
        );
    }
}

/// Every model that any variant uses, once.
fn models_of_runs(out: &mut String, ran: &[&VariantEntry]) {
    let mut models: Vec<ModelEntry> = Vec::new();
    for m in ran.iter().filter_map(|v| v.run.as_ref()).flat_map(|r| &r.models) {
        if !models.iter().any(|k| k.kind == m.kind && k.model == m.model) {
            models.push(m.clone());
        }
    }
    if !models.is_empty() {
        models.sort_by(|a, b| (&a.kind, &a.model).cmp(&(&b.kind, &b.model)));
        out.push_str(&page::models_section(&models));
    }
}

/// Results of all variants, a table for each case.
fn comparison_tables(out: &mut String, file: &File, ran: &[&VariantEntry]) {
    out.push_str("<section id=\"results\"><details><summary><h2>All results</h2></summary>");
    if file.cases.len() < 2 {
        comparison_table(out, file, ran);
    } else {
        for (k, case) in file.cases.iter().enumerate() {
            let own: Vec<&VariantEntry> = ran.iter().copied().filter(|v| v.case == k).collect();
            let open = if k == 0 { " open" } else { "" };
            let _ = write!(
                out,
                "<details class=\"more\"{open}><summary>{}</summary><p class=\"meta\">{}</p>",
                esc(&case.name),
                esc(&case.title)
            );
            if own.is_empty() {
                out.push_str("<p class=\"hint\">No variant of this case ran.</p>");
            } else {
                comparison_table(out, file, &own);
            }
            out.push_str("</details>");
        }
    }
    out.push_str("</details></section>\n");
}

/// Results of the variants of one case.
fn comparison_table(out: &mut String, file: &File, ran: &[&VariantEntry]) {
    let base = ran.first().map(|v| base_of(&file.variants, v)).filter(|v| v.run.is_some());
    match base {
        Some(v) => {
            let _ = write!(
                out,
                "<p class=\"hint\">Differences are to variant {} {}.</p>",
                badge(v.number),
                esc(&v.label)
            );
        }
        None => out.push_str(
            "<p class=\"hint\">The first variant did not run: there is nothing to take differences to.</p>",
        ),
    }
    comparison_heads(out, ran);
    comparison_rows(out, file, ran);
    comparison_work(out, ran, base);
    comparison_balances(out, ran);
    out.push_str("</tbody></table></div>");
}

/// The head of the table: a column for every variant that ran, with what it swaps.
fn comparison_heads(out: &mut String, ran: &[&VariantEntry]) {
    out.push_str("<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain compare\"><thead><tr><th>Result</th><td></td>");
    for v in ran {
        let parts: Vec<String> = v
            .swaps
            .iter()
            .map(|(path, value)| {
                let short = path.trim_end_matches(".model").rsplit('.').next().unwrap_or(path);
                format!(
                    "<span title=\"{}\">{} <b>{}</b></span>",
                    esc(path),
                    esc(short),
                    esc(&short_value(value))
                )
            })
            .collect();
        let label = if parts.is_empty() { esc(&v.label) } else { parts.join("<br>") };
        let _ = write!(out, "<th class=\"num variant\">{}<br>{label}</th>", badge(v.number));
    }
    out.push_str("</tr></thead><tbody>");
}

/// A row for every result.
fn comparison_rows(out: &mut String, file: &File, ran: &[&VariantEntry]) {
    for (name, row) in &file.results {
        let what = ran
            .iter()
            .find_map(|v| v.run.as_ref().and_then(|r| r.descriptions.get(name)))
            .map_or("", String::as_str);
        let _ = write!(
            out,
            "<tr><th scope=\"row\">{} <code>{}</code></th><td class=\"unit\">{}</td>",
            page::prose(&capital(what)),
            esc(name),
            esc(&unit(&row.unit))
        );
        let value = |k: usize| row.values.get(k).copied().flatten();
        for v in ran {
            let k = v.number - 1;
            let base = base_of(&file.variants, v);
            let is_other = v.number != base.number;
            let own = v.run.as_ref().and_then(|r| r.results.get(name));
            let text = certain(value(k), own.and_then(|r| r.uncertainty), 4);
            if is_other && within_numerics(base, v, name) {
                let _ = write!(out, "<td class=\"num\">{text} <span class=\"diff\">numerics</span></td>");
            } else if row.unit == "deg" {
                // A percentage of an angle says nothing: it would depend on where zero is.
                let pair = value(base.number - 1).zip(value(k)).filter(|_| is_other);
                let shift = pair.map(|(a, b)| b - a);
                shift_cell(out, &text, shift);
            } else {
                cell(out, &text, row.difference_percent.get(k).copied().flatten().filter(|_| is_other));
            }
        }
        out.push_str("</tr>");
    }
}

/// What the solvers did.
fn comparison_work(out: &mut String, ran: &[&VariantEntry], base: Option<&VariantEntry>) {
    out.push_str("</tbody><tbody class=\"work\">");
    out.push_str("<tr><th scope=\"row\">solver</th><td></td>");
    for v in ran {
        let _ = write!(
            out,
            "<td class=\"num\">{}</td>",
            esc(v.run.as_ref().map_or("", |r| r.solver.method.as_str()))
        );
    }
    out.push_str("</tr>");
    for name in union(ran.iter().copied(), |r| &r.solver.counters) {
        let value = |v: &VariantEntry| v.run.as_ref().and_then(|r| r.solver.counters.get(name)).copied();
        let first = base.and_then(value);
        let _ = write!(out, "<tr><th scope=\"row\">{}</th><td></td>", esc(&name.replace('_', " ")));
        for v in ran {
            let n = value(v);
            let ratio = first
                .zip(n)
                .filter(|(f, _)| *f > 0 && base.is_some_and(|b| b.number != v.number))
                .map(|(f, n)| (n as f64 / f as f64 - 1.0) * 100.0);
            cell(out, &n.map_or_else(|| "–".into(), count), ratio);
        }
        out.push_str("</tr>");
    }
}

/// How well the balances close, where one is known.
fn comparison_balances(out: &mut String, ran: &[&VariantEntry]) {
    type Closure = (&'static str, fn(&Summary) -> Option<f64>);
    let balances: [Closure; 7] = [
        ("gas mass closure", |r| r.balance.gas_mass),
        ("oil mass closure", |r| r.balance.oil_mass),
        ("flank oil closure", |r| r.balance.flank_oil),
        ("skirt oil closure", |r| r.balance.skirt_oil),
        ("energy closure", |r| r.balance.energy),
        ("momentum closure", |r| r.balance.momentum),
        ("gas energy closure", |r| r.balance.gas_energy),
    ];
    for (name, of) in balances {
        if ran.iter().all(|v| v.run.as_ref().and_then(of).is_none()) {
            continue;
        }
        let _ = write!(out, "<tr><th scope=\"row\">{name}</th><td></td>");
        for v in ran {
            cell(out, &significant(v.run.as_ref().and_then(of), 2), None);
        }
        out.push_str("</tr>");
    }
}

/// An angle with its shift.
fn shift_cell(out: &mut String, text: &str, shift: Option<f64>) {
    let Some(shift) = shift else {
        let _ = write!(out, "<td class=\"num\">{text}</td>");
        return;
    };
    let side = if shift < 0.0 { "less" } else { "more" };
    let step = match shift.abs() {
        d if d < 1.0 => 0,
        d if d < 5.0 => 1,
        d if d < 20.0 => 2,
        _ => 3,
    };
    let sign = if shift > 0.0 { "+" } else { "" };
    let _ = write!(
        out,
        "<td class=\"num {side}{step}\">{text} <span class=\"diff\">{sign}{}°</span></td>",
        significant(Some(shift), 2)
    );
}

/// A value with its difference; the larger the difference, the stronger the cell's ground.
fn cell(out: &mut String, text: &str, difference: Option<f64>) {
    let Some(d) = difference else {
        let _ = write!(out, "<td class=\"num\">{text}</td>");
        return;
    };
    let step = match d.abs() {
        d if d < 1.0 => 0,
        d if d < 5.0 => 1,
        d if d < 20.0 => 2,
        _ => 3,
    };
    let side = if d < 0.0 { "less" } else { "more" };
    let _ =
        write!(out, "<td class=\"num {side}{step}\">{text} <span class=\"diff\">{}</span></td>", percent(d));
}
