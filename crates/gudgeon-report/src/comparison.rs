//! A comparison's files and its page.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use gudgeon_core::result::{
    Assessment, Column, ComparedCase, Comparison, Confidence, Difference, Figure, FigureKind, Grade,
    Headline, Series, ShareTable, Variant, short_value,
};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::differences::difference;
use crate::folder::Folder;
use crate::number::{capital, certain, count, round_trip, significant, unit};
use crate::over_values::Point;
use crate::page::{self, Arrays, Kind, esc};
use crate::summary::{ModelEntry, ResultValue, Summary};
use crate::{REPORT, ReportError, differences, over_values, overview, shares, table};

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
pub(crate) struct VariantEntry {
    /// From 1.
    pub(crate) number: usize,
    pub(crate) label: String,
    /// Number of its case, from 0.
    #[serde(default)]
    pub(crate) case: usize,
    swaps: IndexMap<String, String>,
    /// Number of the variant that its results are compared with; null for that one itself, and where none of its case ran.
    #[serde(default)]
    base: Option<usize>,
    /// Why there is no run: the combination was left out, refused, or failed.
    pub(crate) error: Option<String>,
    /// Whether there is no such machine.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    left_out: bool,
    /// The shape of `summary.json`.
    pub(crate) run: Option<Summary>,
}

impl VariantEntry {
    /// Whether it has results and a base for them.
    const fn is_compared(&self) -> bool {
        self.base.is_some() && self.run.is_some()
    }
}

/// One result over all variants; null where a variant has none. Differences are to the base of each, and null for that.
#[derive(Debug, Default, Serialize)]
struct Row {
    unit: String,
    values: Vec<Option<f64>>,
    difference: Vec<Option<f64>>,
    /// Sum of the numerical uncertainties of both runs.
    difference_uncertainty: Vec<Option<f64>>,
    /// Of the magnitude of the base; null for angles and temperatures, and where the base may be zero.
    difference_percent: Vec<Option<f64>>,
    difference_percent_uncertainty: Vec<Option<f64>>,
    confidence: Vec<Option<Confidence>>,
}

impl Row {
    fn new(variants: &[VariantEntry], name: &str, unit: &str) -> Self {
        let mut row = Self { unit: unit.to_owned(), ..Self::default() };
        for v in variants {
            // Values in different units cannot stand in one row.
            let own = v.run.as_ref().and_then(|r| r.results.get(name)).filter(|v| v.unit == unit);
            let d = own.and_then(|_| difference(variants, v, name));
            row.values.push(own.and_then(|v| v.value));
            row.difference.push(d.map(|d| d.absolute));
            row.difference_uncertainty.push(d.and_then(|d| d.uncertainty));
            row.difference_percent.push(d.and_then(|d| d.percent));
            row.difference_percent_uncertainty.push(d.and_then(|d| d.percent_uncertainty));
            row.confidence.push(d.map(|d| d.confidence()));
        }
        row
    }
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct File {
    case: String,
    title: String,
    #[serde(default)]
    pub(crate) cases: Vec<ComparedCase>,
    /// Whether the uncertainty of the results was looked for.
    #[serde(default)]
    pub(crate) verified: bool,
    swaps: Vec<Swap>,
    #[serde(default)]
    shares: Vec<ShareTable>,
    pub(crate) variants: Vec<VariantEntry>,
    /// Follows from the variants.
    #[serde(skip_deserializing)]
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
                base: c.base(v.case).filter(|b| *b != i).map(|b| b + 1),
                error: v.why(),
                left_out: v.is_left_out(),
                run: v.outcome.as_ref().ok().map(Summary::new),
            })
            .collect();
        Self {
            case: c.case.clone(),
            title: c.title.clone(),
            cases: c.cases.clone(),
            verified: c.is_verified(),
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

/// The variant that those of a case are compared with: the first one of it that ran.
pub(crate) fn base_of<'a>(variants: &'a [VariantEntry], v: &VariantEntry) -> Option<&'a VariantEntry> {
    variants.iter().find(|b| b.case == v.case && b.run.is_some())
}

fn rows(variants: &[VariantEntry]) -> IndexMap<String, Row> {
    let mut names: IndexMap<&str, &str> = IndexMap::new();
    for run in variants.iter().filter_map(|v| v.run.as_ref()) {
        for (name, v) in &run.results {
            names.entry(name).or_insert(&v.unit);
        }
    }
    names.iter().map(|(name, u)| ((*name).to_owned(), Row::new(variants, name, u))).collect()
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
    folder.add(TABLE, &csv_table(&file))?;
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

/// Rebuilds the page of a comparison.
pub(crate) fn rewrite(dir: &Path) -> Result<PathBuf, ReportError> {
    let path = dir.join(COMPARISON);
    let bytes = std::fs::read(&path).map_err(ReportError::io("read", &path))?;
    let mut file: File = serde_json::from_slice(&bytes)
        .map_err(|e| ReportError::Malformed { path: path.clone(), why: e.to_string() })?;
    file.results = rows(&file.variants);
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

/// Results down; across the values of all variants, then of each that has a base its difference with the confidence of that.
fn csv_table(file: &File) -> Vec<u8> {
    const DIFFERENCE: [&str; 5] = [
        "difference",
        "difference uncertainty",
        "difference [%]",
        "difference uncertainty [%]",
        "confidence",
    ];
    let compared: Vec<usize> = (0..file.variants.len()).filter(|k| file.variants[*k].is_compared()).collect();
    let mut head = vec!["result".to_owned(), "unit".to_owned()];
    head.extend(file.variants.iter().map(|v| v.label.clone()));
    head.extend(
        compared.iter().flat_map(|k| DIFFERENCE.map(|what| format!("{}: {what}", file.variants[*k].label))),
    );
    let width = head.len();
    let mut out = vec![head];
    let number = |v: Option<f64>| v.map_or_else(String::new, round_trip);
    for (name, row) in &file.results {
        let mut line = vec![name.clone(), row.unit.clone()];
        line.extend(row.values.iter().copied().map(number));
        for k in &compared {
            let figures = [
                &row.difference,
                &row.difference_uncertainty,
                &row.difference_percent,
                &row.difference_percent_uncertainty,
            ];
            line.extend(figures.map(|f| number(f[*k])));
            line.push(row.confidence[*k].map_or_else(String::new, |c| c.name().to_owned()));
        }
        out.push(line);
    }
    for name in union(file.variants.iter(), |r| &r.solver.counters) {
        let mut line = vec![format!("solver.{name}"), "-".to_owned()];
        line.extend(file.variants.iter().map(|v| {
            let n = v.run.as_ref().and_then(|r| r.solver.counters.get(name));
            n.map_or_else(String::new, u64::to_string)
        }));
        line.resize(width, String::new());
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

pub(crate) fn badge(n: usize) -> String {
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
        differences::section(&mut main, file, &ran);
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
    let tables: IndexMap<String, page::Placed> =
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
    let data = json!({ "cases": file.cases.len(), "variants": variants, "names": names_of_curves(&ran), "figures": figures, "tables": tables });
    page::document(Kind::Comparison, heading, &body, &data, Some(&arrays))
}

/// Sections in their order, with their names in the contents at the side.
const CONTENTS: [(&str, &str); 10] = [
    ("overview", "Overview"),
    ("differences", "Differences"),
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

/// Title and name of a result for each headline of the first variant: of several rings or shafts the one that differs most.
pub(crate) fn headline_results(ran: &[&VariantEntry]) -> Vec<(String, String)> {
    let Some(first) = ran.first().and_then(|v| v.run.as_ref()) else { return Vec::new() };
    let of = |h: &Headline| {
        // A whole with its part is told by the whole.
        let most = h.results.iter().rev().max_by(|a, b| spread(ran, &a.1).total_cmp(&spread(ran, &b.1)));
        let whole = h.results.first().filter(|(label, _)| label == "all");
        let (label, name) = whole.or(most)?;
        let alone = label.is_empty() || h.results.len() == 1;
        let title = if alone { h.title.clone() } else { format!("{}, {label}", h.title) };
        Some((title, name.clone()))
    };
    first.headlines.iter().take(overview::CARDS).filter_map(of).collect()
}

/// A card for each headline, a row a variant.
fn headline_cards(out: &mut String, file: &File, ran: &[&VariantEntry]) {
    if ran.is_empty() {
        return;
    }
    out.push_str("<h2 class=\"unseen\">Headline results</h2>\n<div class=\"cards broad\">\n");
    for (title, name) in headline_results(ran) {
        let rows: Vec<(String, usize, &ResultValue)> = ran
            .iter()
            .take(IN_CARD)
            .filter_map(|v| Some((short_label(file, v), v.number - 1, v.run.as_ref()?.results.get(&name)?)))
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
        let same = |path: &str, value: &String| {
            base_of(&file.variants, v).is_some_and(|base| base.swaps.get(path) == Some(value))
        };
        v.swaps.iter().filter(|(path, value)| !same(path, value)).count() <= 1
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

/// What the figures of the runs call a column of their curves: `Torque in the shafts: crank 1-2`. Columns that stand for one of many (`ring#.h_min`) are named by
/// the script.
fn names_of_curves(ran: &[&VariantEntry]) -> IndexMap<String, String> {
    let mut names = IndexMap::new();
    let mut name = |column: &str, title: &str, label: &str| {
        names.entry(column.to_owned()).or_insert_with(|| format!("{title}: {label}"));
    };
    for f in ran.iter().filter_map(|v| v.run.as_ref()).flat_map(|r| &r.figures) {
        if let (FigureKind::Lines(lines), "series") = (&f.kind, f.table.as_str()) {
            lines.lines.iter().for_each(|(label, column)| name(column, &f.title, label));
        }
    }
    let over_cycle: Vec<serde_json::Value> = serde_json::from_str(page::OVER_CYCLE).unwrap_or_default();
    for f in &over_cycle {
        for c in f["columns"].as_array().into_iter().flatten() {
            if let (Some(column), Some(title), Some(label)) =
                (c[0].as_str(), f["title"].as_str(), c[1].as_str())
            {
                name(column, title, label);
            }
        }
    }
    names.retain(|column, _| !column.contains('#'));
    names
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
    let base = ran.first().and_then(|v| base_of(&file.variants, v));
    if let Some(base) = base {
        let _ = write!(
            out,
            "<p class=\"hint\">{} ≈ marks those that numerical errors alone can make.</p>",
            differences::base_told(file, base)
        );
    }
    comparison_heads(out, ran);
    comparison_rows(out, file, ran);
    comparison_work(out, ran, base);
    comparison_balances(out, ran);
    out.push_str("</tbody></table></div>");
}

/// The head of the table: a column for every variant that ran.
fn comparison_heads(out: &mut String, ran: &[&VariantEntry]) {
    out.push_str("<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain compare\"><thead><tr><th>Result</th><td></td>");
    for v in ran {
        variant_head(out, v);
    }
    out.push_str("</tr></thead><tbody>");
}

/// The head of the column of a variant, with what it swaps.
pub(crate) fn variant_head(out: &mut String, v: &VariantEntry) {
    let parts: Vec<String> = v
        .swaps
        .iter()
        .map(|(path, value)| {
            let short = path.trim_end_matches(".model").rsplit('.').next().unwrap_or(path);
            format!("<span title=\"{}\">{} <b>{}</b></span>", esc(path), esc(short), esc(&short_value(value)))
        })
        .collect();
    let label = if parts.is_empty() { esc(&v.label) } else { parts.join("<br>") };
    let _ = write!(out, "<th class=\"num variant\">{}<br>{label}</th>", badge(v.number));
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
        for v in ran {
            let own = v.run.as_ref().and_then(|r| r.results.get(name)).filter(|r| r.unit == row.unit);
            let text = certain(own.and_then(|r| r.value), own.and_then(|r| r.uncertainty), 4);
            let d = own.and_then(|_| difference(&file.variants, v, name)).filter(|d| d.absolute != 0.0);
            cell(
                out,
                &text,
                d.map(|d| (differences::ground(&d, &row.unit), differences::short(&d, &row.unit))),
            );
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
            let other = base.is_some_and(|b| b.number != v.number);
            let d = first.zip(n).filter(|_| other).and_then(|(f, n)| {
                Difference::between((f as f64, None), (n as f64, None), "").filter(|d| d.absolute != 0.0)
            });
            let ratio = d.map(|d| (differences::ground(&d, ""), differences::short(&d, "")));
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

/// A value with the ground of its cell and its difference.
fn cell(out: &mut String, text: &str, difference: Option<(String, String)>) {
    let _ = match difference {
        None => write!(out, "<td class=\"num\">{text}</td>"),
        Some((ground, d)) => {
            write!(out, "<td class=\"num {ground}\">{text} <span class=\"diff\">{d}</span></td>")
        }
    };
}
