//! A run's files and its page.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use gudgeon_core::result::{Difference, Figure, RunResult, Series};
use indexmap::IndexMap;
use serde::Serialize;
use serde_json::json;

use crate::folder::Folder;
use crate::number::{significant, unit};
use crate::page::{self, Kind, esc};
use crate::summary::{EventEntry, Summary};
use crate::{REPORT, ReportError, differences, inputs, overview, results, table};

pub(crate) const SUMMARY: &str = "summary.json";
pub(crate) const SERIES: &str = "series.csv";
const TIMING: &str = "timing.json";

/// Where [`write_run`] put things.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunFiles {
    /// Results, models, balances, solver work.
    pub summary: PathBuf,
    /// Curves, one row per crank angle or per point of what the scene runs along.
    pub series: PathBuf,
    /// The page.
    pub report: PathBuf,
}

/// Writes `summary.json`, `series.csv`, the further tables, `report.html` and `timing.json` of a run into `dir`, which is made when it
/// does not exist. Wall times stand in `timing.json` alone: the other files of two equal runs are equal to the byte.
///
/// # Errors
/// A column of another length than its axis, or a file system that refuses; files already in `dir` are then as
/// they were.
pub fn write_run(run: &RunResult, dir: &Path) -> Result<RunFiles, ReportError> {
    write_run_in(run, Folder::open(dir)?)
}

/// As [`write_run`], into a folder that was opened before the run.
///
/// # Errors
/// As [`write_run`].
pub fn write_run_in(run: &RunResult, mut folder: Folder) -> Result<RunFiles, ReportError> {
    let dir = folder.path().to_owned();
    for (name, bytes) in run_files(run)? {
        folder.add(&name, &bytes)?;
    }
    folder.commit()?;
    Ok(RunFiles { summary: dir.join(SUMMARY), series: dir.join(SERIES), report: dir.join(REPORT) })
}

/// Names and contents of the files that [`write_run`] writes, for a program without a file system.
///
/// # Errors
/// A column of another length than its axis.
pub fn run_files(run: &RunResult) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let summary = Summary::new(run);
    // Half of the work is the digits of the series.
    let (series, others) = side_by_side(|| table::series_csv(&run.series), || others(run, &summary));
    let mut files = vec![(SERIES.to_owned(), series?)];
    files.extend(others?);
    Ok(files)
}

/// The files of a run beside its series.
fn others(run: &RunResult, summary: &Summary) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let tables = run.tables.iter().map(|(name, t)| Ok((file_of(name), table::series_csv(t)?)));
    let mut files = tables.collect::<Result<Vec<_>, ReportError>>()?;
    files.push((REPORT.into(), page(summary, &run.series, &run.tables).into_bytes()));
    files.push((TIMING.into(), timing(run).into_bytes()));
    files.push((SUMMARY.into(), text(summary).into_bytes()));
    Ok(files)
}

/// What both functions answer, the first in a thread of its own where there can be one.
fn side_by_side<A: Send, B>(one: impl Fn() -> A + Sync, other: impl FnOnce() -> B) -> (A, B) {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().spawn_scoped(scope, &one);
        let b = other();
        // A thread that panicked has said so; the same happens here again.
        (thread.ok().and_then(|t| t.join().ok()).unwrap_or_else(&one), b)
    })
}

/// The data that the scripts of a run's page draw from, for a page that draws again while a person changes a case.
#[must_use]
pub fn run_data(run: &RunResult) -> serde_json::Value {
    // Text, numbers, lists and maps with text keys: there is nothing in it that JSON refuses.
    let summary = Summary::new(run);
    let (data, arrays) = data(&summary, &run.series, &run.tables);
    let mut data = serde_json::to_value(data).unwrap_or_default();
    data["arrays"] = arrays.into_texts().into();
    data
}

/// Wall-clock seconds by phase.
fn timing(run: &RunResult) -> String {
    let seconds: serde_json::Map<String, serde_json::Value> =
        run.seconds.iter().map(|(k, v)| (k.clone(), json!(v))).collect();
    format!("{:#}\n", json!({ "seconds": seconds }))
}

/// What [`write_run`] writes to `summary.json`: for standard output.
#[must_use]
pub fn summary_json(run: &RunResult) -> String {
    text(&Summary::new(run))
}

fn text(summary: &Summary) -> String {
    // Text, numbers and maps with text keys: there is nothing in it that JSON refuses.
    serde_json::to_string_pretty(summary).unwrap_or_default() + "\n"
}

/// Rebuilds the page of a run directory.
pub(crate) fn rewrite(dir: &Path) -> Result<PathBuf, ReportError> {
    let path = dir.join(SUMMARY);
    let bytes = std::fs::read(&path).map_err(ReportError::io("read", &path))?;
    let summary: Summary = serde_json::from_slice(&bytes)
        .map_err(|e| ReportError::Malformed { path: path.clone(), why: e.to_string() })?;
    let series = dir.join(SERIES);
    let series = if series.is_file() { table::read_series(&series)? } else { Series::default() };
    let mut tables = IndexMap::new();
    for name in &summary.tables {
        let path = dir.join(file_of(name));
        if path.is_file() {
            tables.insert(name.clone(), table::read_series(&path)?);
        }
    }
    let mut folder = Folder::open(dir)?;
    folder.add(REPORT, page(&summary, &series, &tables).as_bytes())?;
    folder.commit_beside()?;
    Ok(dir.join(REPORT))
}

fn file_of(table: &str) -> String {
    format!("{table}.csv")
}

/// Sections in their order, with their names in the contents at the side.
const CONTENTS: [(&str, &str); 12] = [
    ("overview", "Overview"),
    ("cycle", "Over the cycle"),
    ("curves", "Figures"),
    ("notes", "Notes"),
    ("events", "Events"),
    ("branches", "Periodic solutions"),
    ("results", "All results"),
    ("inputs", "Inputs"),
    ("numerics", "Numerics"),
    ("skipped", "Not computed"),
    ("models", "Models"),
    ("sources", "Sources"),
];

fn page(s: &Summary, series: &Series, tables: &IndexMap<String, Series>) -> String {
    let over_cycle = has_cycle(series);
    let mut main = String::new();
    overview::section(&mut main, s, series);
    curves(&mut main, s, over_cycle);
    main.push_str(&page::notes_section(&s.notes));
    events(&mut main, s);
    branches(&mut main, s);
    results::section(&mut main, s);
    inputs::section(&mut main, &s.provenance.inputs);
    main.push_str(&page::numerics_section(&s.balance, &s.solver, &s.refined));
    main.push_str(&page::skipped_section(&s.skipped));
    main.push_str(&page::models_section(&s.models));
    main.push_str(&page::sources_section(s));
    let body = page::body(&CONTENTS, &main, &s.gudgeon, &[&s.scene]);
    let (data, arrays) = data(s, series, tables);
    page::document(Kind::Run, s.heading(), &body, &data, Some(&arrays))
}

/// Whether there are curves over the crank angle.
fn has_cycle(series: &Series) -> bool {
    series.is_over_cycle() && !series.axis.values.is_empty() && !series.columns.is_empty()
}

/// What the scripts of the page draw.
#[derive(Serialize)]
struct Data<'a> {
    scene: &'a str,
    section: &'a Option<serde_json::Value>,
    events: &'a [EventEntry],
    series: Option<page::Placed>,
    tables: IndexMap<&'a str, page::Placed>,
    figures: &'a [Figure],
    lead: &'a str,
}

fn data<'a>(
    s: &'a Summary,
    series: &Series,
    tables: &'a IndexMap<String, Series>,
) -> (Data<'a>, page::Arrays) {
    let mut arrays = page::Arrays::default();
    let read = |table: &str| -> Vec<&str> {
        s.figures.iter().filter(|f| f.table == table).flat_map(|f| f.kind.columns()).collect()
    };
    let used = |table: &str| s.figures.iter().any(|f| f.table == table);
    let columns = has_cycle(series).then(|| arrays.series(&series.axis, series.columns.iter()));
    let mut data_of: IndexMap<&str, page::Placed> =
        tables.iter().filter(|(n, _)| used(n)).map(|(n, t)| (n.as_str(), arrays.read(t, &read(n)))).collect();
    if used("series") {
        data_of.insert("series", arrays.read(series, &read("series")));
    }
    let data = Data {
        scene: &s.scene,
        section: &s.section,
        events: &s.events,
        series: columns,
        tables: data_of,
        figures: &s.figures,
        lead: &s.lead,
    };
    (data, arrays)
}

/// Places of the curves and figures.
fn curves(out: &mut String, s: &Summary, over_cycle: bool) {
    if !over_cycle && s.figures.is_empty() {
        out.push_str(
            "<section id=\"curves\"><h2>Curves</h2><p class=\"hint\">This run has no curves.</p></section>\n",
        );
    }
    if over_cycle {
        out.push_str("<section id=\"cycle\"><h2>Over the cycle</h2><div id=\"plots\" class=\"figures\"></div></section>\n");
    }
    if !s.figures.is_empty() {
        out.push_str(
            "<section id=\"curves\"><h2>Figures</h2><div id=\"figures\" class=\"figures\"></div></section>\n",
        );
    }
}

/// What happened when, folded.
fn events(out: &mut String, s: &Summary) {
    if s.events.is_empty() {
        return;
    }
    let _ = write!(
        out,
        "<section id=\"events\"><details><summary><h2>{} events</h2></summary><div id=\"event-list\"><ul>",
        s.events.len()
    );
    for e in &s.events {
        let _ = write!(
            out,
            "<li><b>{}°</b> {}: {}</li>",
            significant(Some(e.theta_deg), 4),
            esc(&results::subject(&e.subject)),
            esc(&e.what)
        );
    }
    out.push_str("</ul></div></details></section>\n");
}

fn branches(out: &mut String, s: &Summary) {
    if s.branches.is_empty() {
        return;
    }
    let mut names: Vec<(&str, &str)> = Vec::new();
    for b in &s.branches {
        for (name, v) in &b.results {
            if !names.iter().any(|(n, _)| n == name) {
                names.push((name, &v.unit));
            }
        }
    }
    out.push_str(
        "<section id=\"branches\"><h2>Periodic solutions</h2><p class=\"hint\">The same case settles into another cycle \
         when it starts from another state. Differences are to the first column.</p><div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table \
         class=\"plain\"><thead><tr><th>Start</th>",
    );
    for b in &s.branches {
        let _ = write!(out, "<th class=\"num\">{}</th>", esc(&b.start));
    }
    out.push_str("<td></td></tr></thead><tbody><tr><th scope=\"row\">Period</th>");
    for b in &s.branches {
        let text = match b.period {
            0 => "did not settle".to_owned(),
            1 => "every cycle".to_owned(),
            n => format!("every {n} cycles"),
        };
        let _ = write!(out, "<td class=\"num\">{text}</td>");
    }
    out.push_str("<td></td></tr>");
    for (name, u) in names {
        let _ = write!(out, "<tr><th scope=\"row\"><code>{}</code></th>", esc(name));
        let first = s.branches.first().and_then(|b| b.results.get(name)).and_then(|v| v.value);
        for (i, b) in s.branches.iter().enumerate() {
            let v = b.results.get(name).and_then(|v| v.value);
            let between = |(a, v)| Difference::between((a, None), (v, None), u).filter(|_| i > 0);
            let difference = first.zip(v).and_then(between).map_or_else(String::new, |d| {
                format!(" <span class=\"diff\">{}</span>", differences::short(&d, u))
            });
            let _ = write!(out, "<td class=\"num\">{}{difference}</td>", significant(v, 4));
        }
        let _ = write!(out, "<td class=\"unit\">{}</td></tr>", esc(&unit(u)));
    }
    out.push_str("</tbody></table></div></section>\n");
}
