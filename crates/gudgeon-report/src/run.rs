//! A run's files and its page.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use gudgeon_core::result::{RunResult, Series};
use indexmap::IndexMap;
use serde_json::json;

use crate::folder::Folder;
use crate::number::{capital, certain, percent, significant, unit};
use crate::page::{self, Kind, esc};
use crate::summary::{ResultValue, Summary};
use crate::{REPORT, ReportError, table};

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
    let mut files = vec![(SERIES.to_owned(), table::series_csv(&run.series)?)];
    for (name, t) in &run.tables {
        files.push((file_of(name), table::series_csv(t)?));
    }
    files.push((REPORT.into(), page(&summary, &run.series, &run.tables).into_bytes()));
    files.push((TIMING.into(), timing(run).into_bytes()));
    files.push((SUMMARY.into(), text(&summary).into_bytes()));
    Ok(files)
}

/// The data that the scripts of a run's page draw from, for a page that draws again while a person changes a case.
#[must_use]
pub fn run_data(run: &RunResult) -> serde_json::Value {
    data(&Summary::new(run), &run.series, &run.tables)
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

fn page(s: &Summary, series: &Series, tables: &IndexMap<String, Series>) -> String {
    let mut body = String::new();
    header(&mut body, s);
    body.push_str("<main>\n");
    body.push_str(&page::notes(&s.notes));
    results(&mut body, s);
    if !s.figures.is_empty() {
        body.push_str("<section id=\"curves\"><h2>Figures</h2><div id=\"figures\"></div></section>\n");
    }
    let over_cycle = has_cycle(series);
    if !over_cycle && s.figures.is_empty() {
        body.push_str(
            "<section id=\"curves\"><h2>Curves</h2><p class=\"hint\">This run has no curves.</p></section>\n",
        );
    } else if over_cycle {
        body.push_str("<section id=\"cycle\"><h2>Over the cycle</h2><div id=\"bar\"></div><div id=\"pack\"></div><div id=\"plots\"></div></section>\n");
    }
    if !s.events.is_empty() {
        body.push_str("<section id=\"events\"><h2>Events</h2><div id=\"event-list\"><ul>");
        for e in &s.events {
            let _ = write!(
                body,
                "<li><b>{}°</b> {}: {}</li>",
                significant(Some(e.theta_deg), 4),
                esc(&subject(&e.subject)),
                esc(&e.what)
            );
        }
        body.push_str("</ul></div></section>\n");
    }
    branches(&mut body, s);
    body.push_str("<div class=\"pair\">\n");
    body.push_str(&page::balance_section(&s.balance));
    body.push_str(&page::solver_section(&s.solver));
    body.push_str(&page::refined_section(&s.refined));
    body.push_str("</div>\n");
    body.push_str(&page::skipped_section(&s.skipped));
    body.push_str(&page::models_section(&s.models));
    body.push_str(&page::provenance_section(&s.gudgeon, &s.provenance));
    body.push_str("</main>\n");
    body.push_str(&page::footer(&s.gudgeon));
    page::document(Kind::Run, s.heading(), &body, &data(s, series, tables))
}

/// Whether there are curves over the crank angle.
fn has_cycle(series: &Series) -> bool {
    series.is_over_cycle() && !series.axis.values.is_empty() && !series.columns.is_empty()
}

/// What the scripts of the page draw.
fn data(s: &Summary, series: &Series, tables: &IndexMap<String, Series>) -> serde_json::Value {
    let mut arrays = page::Arrays::default();
    let used = |name: &str| s.figures.iter().any(|f| f.table == name);
    let columns =
        if has_cycle(series) { arrays.series(&series.axis, series.columns.iter()) } else { json!(null) };
    let mut data_of: serde_json::Map<String, serde_json::Value> =
        tables.iter().filter(|(n, _)| used(n)).map(|(n, t)| (n.clone(), arrays.whole(t))).collect();
    if used("series") {
        data_of.insert("series".into(), arrays.whole(series));
    }
    json!({
        "scene": s.scene, "section": s.section, "events": s.events, "series": columns, "tables": data_of,
        "figures": s.figures, "arrays": arrays.into_json(),
    })
}

/// `ring1` as `ring 1`.
fn subject(name: &str) -> String {
    match member(name) {
        Some((family, n)) => format!("{family} {n}"),
        None => name.replace('_', " "),
    }
}

/// `ring12` as `("ring", 12)`.
fn member(name: &str) -> Option<(&str, u32)> {
    let at = name.find(|c: char| c.is_ascii_digit())?;
    let (family, number) = name.split_at(at);
    if family.is_empty() { None } else { Some((family, number.parse().ok()?)) }
}

fn header(out: &mut String, s: &Summary) {
    let _ =
        write!(out, "<header><h1>{}</h1><p class=\"meta\"><code>{}</code>", esc(s.heading()), esc(&s.case));
    if !s.scene.is_empty() {
        let _ = write!(out, " · {}", esc(&s.scene.replace('_', " ")));
    }
    if !s.solver.method.is_empty() {
        let _ = write!(out, " · solver {}", esc(&s.solver.method));
    }
    if !s.gudgeon.is_empty() {
        let _ = write!(out, " · Gudgeon {}", esc(&s.gudgeon));
    }
    out.push_str("</p>");
    if !s.provenance.overrides.is_empty() {
        let set: Vec<String> =
            s.provenance.overrides.iter().map(|o| format!("<code>{}</code>", esc(o))).collect();
        let _ = write!(out, "<p class=\"changed\"><b>Changed</b> {}</p>", set.join(", "));
    }
    if !s.source.is_empty() {
        let _ = write!(out, "<p class=\"source\"><b>Source</b> {}</p>", page::prose(&s.source));
    }
    if !s.assumptions.is_empty() {
        let n = s.assumptions.len();
        let plural = if n == 1 { "" } else { "s" };
        let open = if n <= 4 { " open" } else { "" };
        let _ = write!(
            out,
            "<details class=\"assumptions\"{open}><summary>{n} assumption{plural} where the source is silent</summary><ul>"
        );
        for a in &s.assumptions {
            let _ = write!(out, "<li>{}</li>", page::prose(a));
        }
        out.push_str("</ul></details>");
    }
    out.push_str("</header>\n");
}

/// Parts of a cylinder: what the names of their results begin with, and their titles.
const PARTS: [(&str, &str); 2] = [("rings.", "Rings"), ("skirt.", "Skirt")];

/// Results that make a list too long for one column.
const LONG: usize = 12;

/// Results of one family (`ring`, `land`): by what follows the dot, then by number.
type Family<'a> = IndexMap<&'a str, BTreeMap<u32, (&'a str, &'a ResultValue)>>;

fn results(out: &mut String, s: &Summary) {
    out.push_str("<section id=\"results\"><h2>Results</h2>");
    // A cylinder has the results of its parts behind those of the whole.
    let part = |name: &str| PARTS.iter().find(|(p, _)| name.strip_prefix(p).is_some()).copied();
    for (prefix, title) in std::iter::once(("", "")).chain(PARTS) {
        let own: Vec<(&str, &str, &ResultValue)> = s
            .results
            .iter()
            .filter(|(name, _)| part(name).map_or("", |(p, _)| p) == prefix)
            .map(|(name, v)| (name.as_str(), &name[prefix.len()..], v))
            .collect();
        if own.is_empty() && !(prefix.is_empty() && s.results.is_empty()) {
            continue;
        }
        if !title.is_empty() {
            let _ = write!(out, "<h3>{title}</h3>");
        }
        part_results(out, s, &own);
    }
    out.push_str("</section>\n");
}

/// Results of one part: full name, name within the part, value.
fn part_results(out: &mut String, s: &Summary, own: &[(&str, &str, &ResultValue)]) {
    let mut plain: Vec<(&str, &ResultValue)> = Vec::new();
    let mut families: IndexMap<&str, Family<'_>> = IndexMap::new();
    let mut angles: IndexMap<&str, IndexMap<&str, (&str, &ResultValue)>> = IndexMap::new();
    for &(name, short, v) in own {
        if let Some((what, angle)) = short.split_once('@') {
            angles.entry(angle).or_default().insert(what, (name, v));
            continue;
        }
        match short.split_once('.').and_then(|(head, rest)| Some((member(head)?, rest))) {
            Some(((family, n), rest)) => {
                families.entry(family).or_default().entry(rest).or_default().insert(n, (name, v));
            }
            None => plain.push((name, v)),
        }
    }
    out.push_str("<div class=\"results\">");
    if own.is_empty() {
        out.push_str("<p class=\"hint\">This run computed no results.</p>");
    }
    // A long list stands in two columns, when nothing else stands beside it.
    let column =
        if families.is_empty() && plain.len() > LONG { plain.len().div_ceil(2) } else { plain.len() };
    plain_tables(out, s, &plain, column);
    if !families.is_empty() {
        out.push_str("<div class=\"families\">");
    }
    for (family, rows) in &families {
        family_table(out, s, family, rows);
    }
    out.push_str(if families.is_empty() { "</div>" } else { "</div></div>" });
    at_angles(out, s, &angles);
}

/// Results that stand alone, `column` to a table.
fn plain_tables(out: &mut String, s: &Summary, plain: &[(&str, &ResultValue)], column: usize) {
    for part in plain.chunks(column.max(1)) {
        out.push_str("<table class=\"plain key\"><tbody>");
        for (name, v) in part {
            let what = s.descriptions.get(*name).map_or("", String::as_str);
            let _ = write!(
                out,
                "<tr><th scope=\"row\">{}<code>{}</code></th>{}</tr>",
                if what.is_empty() { String::new() } else { format!("{} ", page::prose(&capital(what))) },
                esc(name),
                page::value_cells(Some(v))
            );
        }
        out.push_str("</tbody></table>");
    }
}

/// Results that every member of a family has: a column a member.
fn family_table(out: &mut String, s: &Summary, family: &str, rows: &Family<'_>) {
    let mut numbers: Vec<u32> = rows.values().flat_map(|r| r.keys().copied()).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let _ = write!(
        out,
        "<div class=\"scroll\"><table class=\"plain\"><thead><tr><th>Per {}</th><th></th>",
        esc(family)
    );
    for n in &numbers {
        let _ = write!(out, "<th class=\"num\">{} {n}</th>", esc(family));
    }
    out.push_str("</tr></thead><tbody>");
    for (rest, row) in rows {
        let first = row.values().next();
        let told: Vec<String> = row
            .iter()
            .filter_map(|(n, (name, _))| Some(without_member(s.descriptions.get(*name)?, family, *n)))
            .collect();
        let what = shared(&told, family);
        let _ = write!(
            out,
            "<tr><th scope=\"row\">{}<code>{}</code></th>",
            if what.is_empty() { String::new() } else { format!("{} ", esc(&capital(&what))) },
            esc(rest)
        );
        // Before the numbers, where it stays in sight when there are many.
        let u = first.map_or("", |(_, v)| v.unit.as_str());
        let _ = write!(out, "<td class=\"unit\">{}</td>", esc(&unit(u)));
        for n in &numbers {
            let text = row.get(n).map_or_else(|| "–".into(), |(_, v)| certain(v.value, v.uncertainty, 4));
            let _ = write!(out, "<td class=\"num\">{text}</td>");
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table></div>");
}

/// Results at crank angles: one row each.
fn at_angles(out: &mut String, s: &Summary, angles: &IndexMap<&str, IndexMap<&str, (&str, &ResultValue)>>) {
    let Some(first) = angles.values().next() else { return };
    out.push_str("<div class=\"scroll\"><table class=\"plain angles\"><thead><tr><th class=\"num\">At crank angle</th>");
    for (what, (name, v)) in first {
        let title = s.descriptions.get(*name).map_or("", String::as_str);
        let _ = write!(
            out,
            "<th class=\"num\" title=\"{}\"><code>{}</code> <span class=\"unit\">{}</span></th>",
            esc(title),
            esc(what),
            esc(&unit(&v.unit))
        );
    }
    out.push_str("</tr></thead><tbody>");
    for (angle, row) in angles {
        let _ = write!(out, "<tr><th class=\"num\" scope=\"row\">{}°</th>", esc(angle));
        for what in first.keys() {
            let text = row.get(what).map_or_else(|| "–".into(), |(_, v)| certain(v.value, v.uncertainty, 4));
            let _ = write!(out, "<td class=\"num\">{text}</td>");
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table></div>");
}

/// One description for all members: what differs between theirs is the name of each.
fn shared(told: &[String], family: &str) -> String {
    let Some((first, rest)) = told.split_first() else { return String::new() };
    let words: Vec<&str> = first.split(' ').collect();
    let (mut lead, mut end) = (words.len(), words.len());
    for other in rest {
        let other: Vec<&str> = other.split(' ').collect();
        lead = lead.min(words.iter().zip(&other).take_while(|(a, b)| a == b).count());
        end = end.min(words.iter().rev().zip(other.iter().rev()).take_while(|(a, b)| a == b).count());
    }
    if lead == words.len() {
        return first.clone();
    }
    let end = end.min(words.len() - lead);
    let name = format!("the {family}");
    let parts = [&words[..lead], &[name.as_str()], &words[words.len() - end..]];
    parts.concat().join(" ")
}

/// A row of a table per ring must not speak of ring 1.
fn without_member(text: &str, family: &str, n: u32) -> String {
    let name = format!("{family} {n}");
    for lead in [", in ", " of ", " on ", " at ", " in ", " past ", " behind ", ", "] {
        if let Some(rest) = text.strip_suffix(&format!("{lead}{name}")) {
            return rest.to_owned();
        }
    }
    text.replace(&name, &format!("the {family}"))
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
         when it starts from another state. Differences are to the first column.</p><div class=\"scroll\"><table \
         class=\"plain\"><thead><tr><th>Start</th>",
    );
    for b in &s.branches {
        let _ = write!(out, "<th class=\"num\">{}</th>", esc(&b.start));
    }
    out.push_str("<th></th></tr></thead><tbody><tr><th scope=\"row\">Period</th>");
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
            let difference = match (first, v) {
                (Some(a), Some(v)) if i > 0 && a != 0.0 => {
                    format!(" <span class=\"diff\">{}</span>", percent((v - a) / a.abs() * 100.0))
                }
                _ => String::new(),
            };
            let _ = write!(out, "<td class=\"num\">{}{difference}</td>", significant(v, 4));
        }
        let _ = write!(out, "<td class=\"unit\">{}</td></tr>", esc(&unit(u)));
    }
    out.push_str("</tbody></table></div></section>\n");
}

#[cfg(test)]
mod tests {
    use super::shared;

    #[test]
    fn descriptions_of_members_are_shared() {
        let told = |t: &[&str]| shared(&t.iter().map(|s| (*s).to_owned()).collect::<Vec<_>>(), "shaft");
        assert_eq!(
            told(&["mean torque of motor shaft", "mean torque of crank 1-2"]),
            "mean torque of the shaft"
        );
        let at_rest = ["torque of order 2 in crank 1-2 at rest", "torque of order 2 in coupling at rest"];
        assert_eq!(told(&at_rest), "torque of order 2 in the shaft at rest");
        assert_eq!(told(&["mean torque", "mean torque"]), "mean torque");
        assert_eq!(told(&["mean torque"]), "mean torque");
        assert_eq!(told(&[]), "");
    }
}
